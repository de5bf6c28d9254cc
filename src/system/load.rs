//! The rigid load: a rigid link from the attachment P, the cable's last node, to the point I at the radius of gyration about P (thesis 4.1,
//! eq. 138, after García de Jalón & Bayo, Kinematic and Dynamic Simulation of Multibody Systems, 1994, section 4.2).
//!
//! Eq. 138 in (r_P, r_I), a = L_PG/L_PI: m [[2(1 − a), a − 1], [a − 1, 1]] ⊗ I. With r_I = r_P + L_PI n it reads, in (r_P, n),
//!
//! ```text
//! M = m [[1, L_PG], [L_PG, L_PI²]] ⊗ I,   G = r_P + L_PG n,
//! ```
//!
//! so that n is a slope like the cable's own and no length cancels. ‖n‖ = 1 is held exactly, not by the thesis's spring: the rows of n are the
//! equations of motion along the sphere, the row along n is the constraint's second derivative, n·n̈ = −ṅ·ṅ (index reduction; E. Hairer &
//! G. Wanner, Solving Ordinary Differential Equations II, VII.1), and each accepted step is projected back onto ‖n‖ = 1, n·ṅ = 0, which keeps
//! the method's order (E. Hairer, C. Lubich & G. Wanner, Geometric Numerical Integration, IV.4). No stiffness enters, so no step gets shorter.
//!
//! The block of the load stands after the last node's: three slots without use, then n.

use super::{Environment, Matrices, System};
use crate::math::lanes::{Mat3, Vec3, add_identity, add_outer, dot};
use crate::scene::Load;

/// A rigid load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidLoad {
    /// kg.
    pub mass: f64,
    /// L_PI, m.
    pub inertia: f64,
    /// L_PG, m.
    pub gravity: f64,
}

impl From<&Load> for RigidLoad {
    fn from(l: &Load) -> Self {
        Self { mass: l.mass, inertia: l.length_inertia, gravity: l.length_gravity }
    }
}

impl RigidLoad {
    /// Brings n, ṅ, n̈, which stand at `at`, back onto the constraint.
    pub fn project(at: usize, u: &mut [f64], w: &mut [f64], a: &mut [f64]) {
        let (n, v, a) = (&mut u[at..at + 3], &mut w[at..at + 3], &mut a[at..at + 3]);
        let i = 1.0 / n.iter().map(|x| x * x).sum::<f64>().sqrt();
        n.iter_mut().for_each(|x| *x *= i);
        let along: f64 = n.iter().zip(&*v).map(|(n, v)| n * v).sum();
        v.iter_mut().zip(&*n).for_each(|(v, n)| *v -= along * n);
        let along: f64 = n.iter().zip(&*a).map(|(n, a)| n * a).sum();
        let wanted = -v.iter().map(|v| v * v).sum::<f64>();
        a.iter_mut().zip(&*n).for_each(|(a, n)| *a += (wanted - along) * n);
    }
}

impl System {
    /// Inertia and weight of the load, with whatever force acts on the body (at the load's centre of gravity).
    pub(super) fn hang<const TANGENT: bool>(
        &mut self,
        env: &Environment,
        u: &[f64],
        w: &[f64],
        a: Option<&[f64]>,
        f: &mut [f64],
        m: &mut Matrices,
    ) {
        let Some(load) = &self.load else { return };
        let node = self.arc.len() - 1;
        let at = 6 * node;
        let direction = |x: &[f64]| [x[at + 9], x[at + 10], x[at + 11]];
        let (n, v) = (direction(u), direction(w));
        let (mass, arm, spin) = (load.mass, load.mass * load.gravity, load.mass * load.inertia * load.inertia);
        let vp = [w[at], w[at + 1], w[at + 2]];
        let (ap, an) = a.map_or(([0.0; 3], [0.0; 3]), |a| ([a[at], a[at + 1], a[at + 2]], direction(a)));
        // What acts at G, without and with the attachment's acceleration.
        let force: Vec3<f64> = std::array::from_fn(|c| mass * (env.gravity[c] - env.base[c].0[2]) + env.body_force[c]);
        let x: Vec3<f64> = std::array::from_fn(|c| load.gravity * force[c] - arm * ap[c]);
        let n2 = dot(&n, &n);
        let nx = dot(&n, &x);
        // Statics need a row along n as well: there a spring of the pendulum's own size holds ‖n‖ = 1. In motion the projection does.
        let spring = if self.frozen { 1.0 + dot(&env.gravity, &env.gravity).sqrt() / load.inertia } else { 0.0 };
        let radial = (dot(&v, &v) + 0.5 * spring * (n2 - 1.0)) / n2;
        for c in 0..3 {
            self.lump_force[c] = force[c] - mass * ap[c] - arm * an[c];
            f[at + c] += self.lump_force[c];
            f[at + 6 + c] -= a.map_or(0.0, |a| a[at + 6 + c]); // the slots without use: M = 1, no force
            f[at + 9 + c] += x[c] - n[c] * nx / n2 - spin * (an[c] + radial * n[c]);
        }
        let across: Vec3<f64> = std::array::from_fn(|c| ap[c] - n[c] * dot(&n, &ap) / n2);
        self.tally.accelerate(mass * dot(&vp, &ap) + arm * (dot(&vp, &an) + dot(&v, &across)) + spin * dot(&v, &an));
        self.tally.kinetic += 0.5 * mass * dot(&vp, &vp) + arm * dot(&vp, &v) + 0.5 * spin * dot(&v, &v);
        if TANGENT {
            let mut along = [[0.0; 3]; 3];
            add_identity(&mut along, 1.0);
            add_outer(&mut along, -1.0 / n2, &n, &n);
            // −∂/∂n of x − n (n·x)/n² − spin radial n.
            let mut k: Mat3<f64> = [[0.0; 3]; 3];
            add_identity(&mut k, nx / n2 + spin * radial);
            add_outer(&mut k, 1.0 / n2, &n, &x);
            add_outer(&mut k, -2.0 * nx / (n2 * n2) + spin * (spring - 2.0 * radial) / n2, &n, &n);
            for r in 0..3 {
                m.mass.add(node, node, r, r, mass);
                m.mass.add(node, node + 1, r, 3 + r, arm);
                m.mass.add(node + 1, node + 1, r, r, 1.0);
                m.mass.add(node + 1, node + 1, 3 + r, 3 + r, spin);
                for c in 0..3 {
                    m.mass.add(node + 1, node, 3 + r, c, arm * along[r][c]);
                    m.stiffness.add(node + 1, node + 1, 3 + r, 3 + c, k[r][c]);
                    m.damping.add(node + 1, node + 1, 3 + r, 3 + c, 2.0 * spin / n2 * n[r] * v[c]);
                }
            }
        }
    }
}
