//! First shapes: along the drum as far as needed, then straight.

use crate::math::jet::Jet;
use crate::system::{FirstEnd, System};
use crate::winch::DrumGeometry;
use nalgebra::{Matrix3, Vector3};

/// The part of a cable that lies on the drum.
pub(super) struct Winding<'a> {
    drum: Option<(&'a DrumGeometry, f64)>,
    rotation: Matrix3<f64>,
    /// Length on the drum, m.
    pub arc: f64,
}

impl<'a> Winding<'a> {
    /// On the drum in the sense of its winding until the tangent points along `direction` (a world unit vector).
    pub fn new(system: &'a System, t: f64, direction: &Vector3<f64>) -> Self {
        let env = system.environment(t);
        let rotation = Matrix3::from_fn(|i, j| env.frame.rotation[i][j].0[0]);
        let d = rotation.transpose() * direction;
        let mut out = Self { drum: None, rotation, arc: 0.0 };
        // A held slope too: a straight shape across it would stay on the saddle between its two sides, the slope shrunk to nothing.
        if let FirstEnd::Winch { geometry, drive, contact, clamp } = &system.first
            && (contact.is_some() || *clamp > 0.0)
        {
            // Angle over which the tangent turns from the first node to `direction`, in the sense of winding.
            let phi = drive.angle(t).0[0];
            let side = Vector3::from(geometry.side);
            let up = Vector3::from(geometry.up);
            let (x, y) = (side.dot(&d), up.dot(&d));
            // Tangent at angle θ: sense (cos θ side − sin θ up).
            let goal = (-y * geometry.sense).atan2(x * geometry.sense);
            let mut turn = (geometry.sense * (goal - phi)).rem_euclid(std::f64::consts::TAU);
            if turn > 1.75 * std::f64::consts::PI || x.hypot(y) < 1e-9 {
                turn = 0.0; // already a little past it
            }
            out.arc = turn * geometry.radius;
            out.drum = Some((geometry, phi));
        }
        out
    }

    /// Position relative to the first node and slope at `s`, if that lies on the drum.
    pub fn on_drum(&self, s: f64) -> Option<(Vector3<f64>, Vector3<f64>)> {
        (s < self.arc).then(|| self.rim(s)).flatten()
    }

    /// Where the cable leaves the drum, relative to the first node.
    pub fn leaves(&self) -> Vector3<f64> {
        self.rim(self.arc).map_or_else(Vector3::zeros, |(p, _)| p)
    }

    fn rim(&self, s: f64) -> Option<(Vector3<f64>, Vector3<f64>)> {
        let (g, phi) = self.drum?;
        let at = |s: f64| g.rim(Jet::constant(phi + g.sense * s / g.radius));
        let vector = |v: [Jet; 3]| Vector3::from(v.map(|j| j.0[0]));
        let (p, t) = at(s);
        Some((self.rotation * (vector(p) - vector(at(0.0).0)), self.rotation * vector(t)))
    }
}

/// Positions relative to the first node and slopes, six per node: on the drum in the sense of its winding until the tangent points along
/// `direction` (a world unit vector), straight from there; unstretched. A rigid load points along `direction` too.
pub fn lay_out(system: &System, t: f64, direction: &Vector3<f64>) -> Vec<f64> {
    let winding = Winding::new(system, t, direction);
    let leave = winding.leaves();
    let mut out = Vec::with_capacity(6 * system.nodes());
    for &s in &system.arc {
        let (p, t) = winding.on_drum(s).unwrap_or_else(|| (leave + direction * (s - winding.arc), *direction));
        out.extend(p.iter().chain(&t));
    }
    if system.load.is_some() {
        out.extend(Vector3::zeros().iter().chain(direction));
    }
    out[..3].fill(0.0);
    out
}
