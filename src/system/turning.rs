//! Sheaves that turn: each has an angle φ and a spin Ω relative to the ship as unknowns,
//!
//! ```text
//! I (Ω̇ + α) = T_cable − T_b Ω / √(Ω² + Ω_ε²) − c_b Ω,
//! ```
//!
//! α the ship's own angular acceleration about the axis, T_cable the moment of the cable's friction, T_b and c_b of the bearing. They stand in
//! blocks of their own behind the nodes', six sheaves to a block; what couples them with the cable is a border of the band.

use super::{Environment, Matrices, SLIP_SPEED, System};
use crate::scene::Scene;
use crate::ship::Frame;

/// A turning sheave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurningSheave {
    /// Which of the surfaces.
    pub surface: usize,
    /// Where φ, Ω stand in u, w.
    pub at: usize,
    /// kg·m².
    inertia: f64,
    /// T_b, N·m.
    friction: f64,
    /// c_b, N·m·s.
    damping: f64,
    /// Ω_ε, rad/s.
    slow: f64,
}

impl TurningSheave {
    /// Those of a scene with `surfaces` of which the last are the sheaves, behind `nodes` blocks.
    pub fn all(scene: &Scene, surfaces: usize, nodes: usize) -> Vec<Self> {
        let first = surfaces - scene.sheaves.len();
        let turning = scene.sheaves.iter().enumerate().filter_map(|(i, s)| Some((i, s, s.inertia?)));
        let all = turning.enumerate().map(|(k, (i, s, inertia))| Self {
            surface: first + i,
            at: 6 * nodes + k,
            inertia,
            friction: s.bearing_friction,
            damping: s.bearing_damping,
            slow: SLIP_SPEED / s.radius,
        });
        all.collect()
    }

    /// The bearing's moment on the sheave, N·m, and its derivative by Ω.
    pub fn bearing(&self, spin: f64) -> (f64, f64) {
        let size = (spin * spin + self.slow * self.slow).sqrt();
        let slope = self.friction * self.slow * self.slow / (size * size * size);
        (-self.friction * spin / size - self.damping * spin, -slope - self.damping)
    }
}

/// Angular acceleration of the ship about a ship axis, rad/s².
fn turning_of_ship(frame: &Frame, axis: &[f64; 3]) -> f64 {
    // d/dt (RᵀṘ) = RᵀR̈ + ṘᵀṘ, the second symmetric.
    let r = &frame.rotation;
    let product = |i: usize, j: usize| -> f64 { (0..3).map(|k| r[k][i].0[0] * r[k][j].0[2]).sum() };
    (0..3).map(|c| 0.5 * axis[c] * (product((c + 2) % 3, (c + 1) % 3) - product((c + 1) % 3, (c + 2) % 3))).sum()
}

impl System {
    /// Spin of a surface relative to the ship, rad/s.
    pub fn spin(&self, surface: usize, w: &[f64]) -> f64 {
        if self.frozen {
            return 0.0;
        }
        self.turning.iter().find(|s| s.surface == surface).map_or(0.0, |s| w[s.at])
    }

    /// Moments and inertia of the sheaves; the contact's are known.
    pub(super) fn turn<const TANGENT: bool>(&mut self, env: &Environment, w: &[f64], a: Option<&[f64]>, f: &mut [f64], m: &mut Matrices) {
        let Some(first) = self.turning.first().map(|s| s.at) else { return };
        // The slots without a sheave: M = 1, no force.
        for at in first..f.len() {
            let inertia = self.turning.get(at - first).map_or(1.0, |s| s.inertia);
            f[at] -= a.map_or(0.0, |a| inertia * a[at]);
            if TANGENT {
                m.mass.add(at / 6, at / 6, at % 6, at % 6, inertia);
            }
        }
        if self.frozen {
            return;
        }
        for s in &self.turning {
            let spin = w[s.at];
            let (moment, slope) = s.bearing(spin);
            let surface = &self.surfaces[s.surface];
            f[s.at] += moment - self.surface_loads[s.surface].moment[0] - s.inertia * turning_of_ship(&env.frame, &surface.basis[0]);
            self.tally.kinetic += 0.5 * s.inertia * spin * spin;
            self.tally.accelerate(a.map_or(0.0, |a| s.inertia * spin * a[s.at]));
            if TANGENT {
                m.damping.add(s.at / 6, s.at / 6, s.at % 6, s.at % 6, -slope);
            }
        }
    }
}
