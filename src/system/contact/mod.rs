//! Contact of the elements with drum and sheaves.
//!
//! Within an element the arcs in contact are found first, face by face, and each is integrated by its own Gauss points. So the force changes
//! smoothly as the cable is laid on or lifted off, whatever the mesh. The arcs' ends move with the shape; their part of the tangent is exact
//! too. All of an element's work is done in the surface's axes and turned into world axes once.

mod press;

use super::environment::Environment;
use super::matrices::Matrices;
use super::{System, gather};
use crate::cable::shape;
use crate::contact::arcs::{Arc, Cubic, Samples, Touch};
use crate::contact::surface::{Face, Surface};
use crate::math::lanes::{Mat3, Vec3, axpy, dot, mat_vec};
use crate::math::quadrature::GAUSS5;
use press::Press;

/// Where the search begins in the first element. Where its node lies on the surface whatever the shape, ξ = 0 is a root of the gap that says
/// nothing, of a sign that is rounding.
const BEYOND_PIN: f64 = 1e-3;

/// What the cable does to a surface, in the surface's axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceLoad {
    /// Force on the cable, N.
    pub force: Vec3<f64>,
    /// Its moment about the centre, N·m.
    pub moment: Vec3<f64>,
    /// Force normal to each face, N.
    pub faces: [f64; 2],
}

/// How a surface's axes move against the world and the first node.
pub struct SurfaceFrame {
    /// World components into the surface's axes.
    pub rotation: Mat3<f64>,
    /// The first node's position.
    pub base: Vec3<f64>,
    /// Its velocity.
    base_velocity: Vec3<f64>,
    /// ∂(relative velocity)/∂(position) at fixed world velocity, −[ω]×; zero in a static evaluation.
    turn: Mat3<f64>,
    frozen: bool,
}

impl SurfaceFrame {
    /// Of `surface` at one instant.
    pub fn new(surface: &Surface, env: &Environment, frozen: bool) -> Self {
        let frame = &env.frame;
        let b = &surface.basis;
        let rotation = std::array::from_fn(|i| frame.to_world(&b[i]));
        let place = env.base.map(|j| j.0[0]);
        let at = frame.locate(&place);
        let base = mat_vec(b, &axpy(&at, -1.0, &surface.centre));
        let (mut base_velocity, mut turn) = ([0.0; 3], [[0.0; 3]; 3]);
        if !frozen {
            base_velocity = mat_vec(b, &frame.relative_velocity(&place, &env.base.map(|j| j.0[1])));
            let rate: Mat3<f64> = std::array::from_fn(|i| {
                std::array::from_fn(|j| (0..3).map(|k| frame.rotation[k][i].0[1] * frame.rotation[k][j].0[0]).sum())
            });
            turn = std::array::from_fn(|i| std::array::from_fn(|j| dot(&b[i], &mat_vec(&rate, &b[j]))));
        }
        Self { rotation, base, base_velocity, turn, frozen }
    }

    /// An element's shape from its slots (relative to the first node, world axes).
    #[inline]
    pub fn shape(&self, u: &[Vec3<f64>; 4], l: f64) -> ([Vec3<f64>; 4], Cubic) {
        let mut q = u.map(|x| mat_vec(&self.rotation, &x));
        let relative = q;
        for i in [0, 2] {
            q[i] = axpy(&q[i], 1.0, &self.base);
        }
        (relative, Cubic::hermite(&q, l))
    }

    /// The element's velocity relative to the ship, from its relative slots in the surface's axes.
    #[inline]
    fn velocity(&self, relative: &[Vec3<f64>; 4], w: &[Vec3<f64>; 4], l: f64) -> Cubic {
        if self.frozen {
            return Cubic([[0.0; 3]; 4]);
        }
        let mut q: [Vec3<f64>; 4] = std::array::from_fn(|i| axpy(&mat_vec(&self.rotation, &w[i]), 1.0, &mat_vec(&self.turn, &relative[i])));
        for i in [0, 2] {
            q[i] = axpy(&q[i], 1.0, &self.base_velocity);
        }
        Cubic::hermite(&q, l)
    }
}

/// Whether an element can touch the surface: the gaps are 1-Lipschitz, so a ball around its Bézier polygon decides.
#[inline]
pub fn near(surface: &Surface, frame: &SurfaceFrame, u: &[Vec3<f64>; 4], l: f64) -> bool {
    let third = l / 3.0;
    let middle: Vec3<f64> = std::array::from_fn(|c| 0.5 * (u[0][c] + u[2][c]));
    let reach = [u[0], axpy(&u[0], third, &u[1]), axpy(&u[2], -third, &u[3])]
        .iter()
        .map(|p| (0..3).map(|c| (p[c] - middle[c]).powi(2)).sum::<f64>())
        .fold(0.0, f64::max)
        .sqrt();
    surface.within(&axpy(&mat_vec(&frame.rotation, &middle), 1.0, &frame.base), reach)
}

/// Calls `found` with every arc of element `e` in contact with a face (its index first).
pub fn touching(surface: &Surface, curve: &Cubic, e: usize, mut found: impl FnMut(usize, Face, Arc)) {
    let (faces, count) = surface.faces();
    let samples = Samples::new(surface, curve, if e == 0 { BEYOND_PIN } else { 0.0 });
    for (i, &face) in faces[..count].iter().enumerate() {
        Touch { surface, face, curve }.arcs(&samples, |arc| found(i, face, arc));
    }
}

/// Forces of one element in the surface's axes.
type Forces = [[f64; 3]; 4];

/// Stiffness and damping of one element in the surface's axes.
struct Tangent {
    stiffness: [[f64; 12]; 12],
    damping: [[f64; 12]; 12],
    /// The same of the moment T that turns the surface: rows of K and D, column and corner of D.
    moment_stiffness: [f64; 12],
    moment_damping: [f64; 12],
    spin_column: [f64; 12],
    spin_corner: f64,
}

impl Tangent {
    const NONE: Self = Self {
        stiffness: [[0.0; 12]; 12],
        damping: [[0.0; 12]; 12],
        moment_stiffness: [0.0; 12],
        moment_damping: [0.0; 12],
        spin_column: [0.0; 12],
        spin_corner: 0.0,
    };
}

/// How a surface turns.
#[derive(Clone, Copy, Default)]
struct Turning {
    /// rad/s relative to the ship.
    spin: f64,
    /// Which of the couplings.
    coupling: Option<usize>,
}

impl System {
    /// Overwrites the contact forces; with `TANGENT` adds to the matrices.
    pub(super) fn contact<const TANGENT: bool>(&mut self, env: &Environment, u: &[f64], w: &[f64], m: &mut Matrices) {
        self.contact_forces.fill([0.0; 12]);
        for index in 0..self.surfaces.len() {
            let turning = Turning {
                spin: self.spin(index, w),
                coupling: if self.frozen { None } else { self.turning.iter().position(|s| s.surface == index) },
            };
            let (surface, total) = (&self.surfaces[index], &mut self.surface_loads[index]);
            *total = SurfaceLoad::default();
            let frame = SurfaceFrame::new(surface, env, self.frozen);
            for (e, &l) in self.chain.lengths.iter().enumerate() {
                let slots = gather(u, e);
                if !near(surface, &frame, &slots, l) {
                    continue;
                }
                let (relative, curve) = frame.shape(&slots, l);
                let velocity = surface.is_damped().then(|| frame.velocity(&relative, &gather(w, e), l));
                let velocity = velocity.as_ref();
                let mut forces: Forces = [[0.0; 3]; 4];
                let mut tangent: Option<Tangent> = None;
                let mut touched = false;
                touching(surface, &curve, e, |side, face, arc| {
                    touched = true;
                    Press { surface, side, face, arc, curve: &curve, velocity, spin: turning.spin, length: l }.add(&mut forces, total);
                    if TANGENT {
                        tangent.get_or_insert(Tangent::NONE).arc(surface, face, &arc, &curve, velocity, &turning, &frame.turn, l);
                    }
                });
                if touched {
                    let (r, out) = (&frame.rotation, &mut self.contact_forces[e]);
                    for i in 0..4 {
                        for c in 0..3 {
                            out[3 * i + c] += (0..3).map(|k| r[k][c] * forces[i][k]).sum::<f64>();
                        }
                    }
                }
                if let Some(tangent) = tangent {
                    add_turned(&mut m.stiffness, e, &frame.rotation, &tangent.stiffness);
                    if surface.is_damped() {
                        add_turned(&mut m.damping, e, &frame.rotation, &tangent.damping);
                    }
                    if let Some(k) = turning.coupling {
                        let coupling = &mut m.couplings[k];
                        m.damping.add(coupling.at / 6, coupling.at / 6, coupling.at % 6, coupling.at % 6, tangent.spin_corner);
                        for (to, from) in [
                            (&mut coupling.damping_column, &tangent.spin_column),
                            (&mut coupling.damping_row, &tangent.moment_damping),
                            (&mut coupling.stiffness_row, &tangent.moment_stiffness),
                        ] {
                            for i in 0..4 {
                                for c in 0..3 {
                                    to[6 * e + 3 * i + c] += (0..3).map(|r| frame.rotation[r][c] * from[3 * i + r]).sum::<f64>();
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

impl Tangent {
    /// Adds an arc.
    fn arc(
        &mut self,
        surface: &Surface,
        face: Face,
        arc: &Arc,
        curve: &Cubic,
        velocity: Option<&Cubic>,
        turning: &Turning,
        turn: &Mat3<f64>,
        l: f64,
    ) {
        let length = arc.to - arc.from;
        let damped = surface.is_damped();
        // ∂Q/∂from and ∂Q/∂to of the rule, points moving along.
        let mut by_ends = [[0.0; 12]; 2];
        let mut moment_by_ends = [0.0; 2];
        for (position, weight) in GAUSS5 {
            let x = arc.from + length * position;
            let s = curve.at(x);
            let Some(load) = surface.load(face, &s, &velocity.map_or([0.0; 3], |v| v.at(x)), turning.spin) else { continue };
            let shape = shape::value(x, l);
            let wl = weight * length * l;
            let mut ds = load.ds;
            if damped {
                for r in 0..3 {
                    for c in 0..3 {
                        ds[r][c] += (0..3).map(|k| load.dv[r][k] * turn[k][c]).sum::<f64>();
                    }
                }
            }
            subtract_products(&mut self.stiffness, wl, &shape, &ds);
            if damped {
                subtract_products(&mut self.damping, wl, &shape, &load.dv);
            }
            // T = s₂ f₁ − s₁ f₂ per length, with its derivatives.
            let moment = s[2] * load.f[1] - s[1] * load.f[2];
            let mut moment_by_s: Vec3<f64> = std::array::from_fn(|c| s[2] * ds[1][c] - s[1] * ds[2][c]);
            moment_by_s[2] += load.f[1];
            moment_by_s[1] -= load.f[2];
            let moment_by_v: Vec3<f64> = std::array::from_fn(|c| s[2] * load.dv[1][c] - s[1] * load.dv[2][c]);
            if turning.coupling.is_some() {
                self.spin_corner -= wl * (s[2] * load.dspin[1] - s[1] * load.dspin[2]);
                for i in 0..4 {
                    for c in 0..3 {
                        self.moment_stiffness[3 * i + c] -= wl * shape[i] * moment_by_s[c];
                        self.moment_damping[3 * i + c] -= wl * shape[i] * moment_by_v[c];
                        self.spin_column[3 * i + c] -= wl * shape[i] * load.dspin[c];
                    }
                }
            }
            if arc.moving != [false, false] {
                // d/dξ of sᵢ f.
                let mut fx = mat_vec(&load.ds, &curve.slope(x));
                if let Some(v) = velocity {
                    fx = axpy(&fx, 1.0, &mat_vec(&load.dv, &v.slope(x)));
                }
                let slope = shape::slope(x, 1.0 / l);
                let along = curve.slope(x);
                let moment_x = along[2] * load.f[1] + s[2] * fx[1] - along[1] * load.f[2] - s[1] * fx[2];
                moment_by_ends[0] += weight * l * (length * moment_x * (1.0 - position) - moment);
                moment_by_ends[1] += weight * l * (length * moment_x * position + moment);
                for k in 0..12 {
                    let (i, c) = (k / 3, k % 3);
                    let (g, rate) = (shape[i] * load.f[c], l * slope[i] * load.f[c] + shape[i] * fx[c]);
                    by_ends[0][k] += weight * l * (length * rate * (1.0 - position) - g);
                    by_ends[1][k] += weight * l * (length * rate * position + g);
                }
            }
        }
        for (end, x) in [arc.from, arc.to].into_iter().enumerate() {
            if !arc.moving[end] {
                continue;
            }
            // The root's rate by the slots, −∇gap sᵢ / gap′; none where the cable only grazes the surface.
            let s = curve.at(x);
            let rho = (s[1] * s[1] + s[2] * s[2]).sqrt();
            let n = [face.axial, face.radial * s[1] / rho, face.radial * s[2] / rho];
            let slope = dot(&n, &curve.slope(x));
            if slope.abs() <= 1e-9 * l {
                continue;
            }
            let shape = shape::value(x, l);
            for j in 0..12 {
                let rate = -shape[j / 3] * n[j % 3] / slope;
                self.moment_stiffness[j] -= moment_by_ends[end] * rate;
                for i in 0..12 {
                    self.stiffness[i][j] -= by_ends[end][i] * rate;
                }
            }
        }
    }
}

/// m −= w sᵢ sⱼ b for every pair of slots.
#[inline(always)]
fn subtract_products(m: &mut [[f64; 12]; 12], w: f64, s: &[f64; 4], b: &Mat3<f64>) {
    // Whole rows at a time.
    let rows: [[f64; 12]; 3] = std::array::from_fn(|r| std::array::from_fn(|k| s[k / 3] * b[r][k % 3]));
    for i in 0..4 {
        let f = w * s[i];
        for r in 0..3 {
            for k in 0..12 {
                m[3 * i + r][k] -= f * rows[r][k];
            }
        }
    }
}

/// m += rᵀ k r, block by block of three.
fn add_turned(m: &mut crate::linalg::Patches, e: usize, r: &Mat3<f64>, k: &[[f64; 12]; 12]) {
    let mut turned = [[0.0; 12]; 12];
    for i in 0..4 {
        for j in 0..4 {
            let left: Mat3<f64> =
                std::array::from_fn(|a| std::array::from_fn(|c| (0..3).map(|b| k[3 * i + a][3 * j + b] * r[b][c]).sum::<f64>()));
            for a in 0..3 {
                for c in 0..3 {
                    turned[3 * i + a][3 * j + c] = (0..3).map(|b| r[b][a] * left[b][c]).sum::<f64>();
                }
            }
        }
    }
    m.add_pair(e, &turned);
}
