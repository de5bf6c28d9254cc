//! First shapes: along the drum as far as needed, then straight.

use crate::math::jet::Jet;
use crate::system::{FirstEnd, System};
use nalgebra::Vector3;

/// Positions relative to the first node and slopes, six per node: on the drum in the sense of its winding until the tangent points along
/// `direction` (a world unit vector), straight from there; unstretched.
pub fn lay_out(system: &System, t: f64, direction: &Vector3<f64>) -> Vec<f64> {
    let env = system.environment(t);
    let rotation = nalgebra::Matrix3::from_fn(|i, j| env.frame.rotation[i][j].0[0]);
    let d = rotation.transpose() * direction;
    let mut out = Vec::with_capacity(6 * system.nodes());
    let (mut arc, mut radius, mut wound) = (0.0, 1.0, None);
    // A held slope too: a straight shape across it would stay on the saddle between its two sides, the slope shrunk to nothing.
    if let FirstEnd::Winch { geometry, drive, contact, clamp } = &system.first
        && (*contact || *clamp > 0.0)
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
        arc = turn * geometry.radius;
        radius = geometry.radius;
        wound = Some((geometry, phi));
    }
    let on_drum = |s: f64| {
        wound.map(|(g, phi)| {
            let (p, t) = g.rim(Jet::constant(phi + g.sense * s / radius));
            (Vector3::from(p.map(|j| j.0[0])), Vector3::from(t.map(|j| j.0[0])))
        })
    };
    let origin = on_drum(0.0).map_or_else(Vector3::zeros, |(p, _)| p);
    let (leave, _) = on_drum(arc).unwrap_or((Vector3::zeros(), d));
    for &s in &system.arc {
        let (p, t) = match on_drum(s) {
            Some(pt) if s < arc => pt,
            _ => (leave + d * (s - arc), d),
        };
        let (p, t) = (rotation * (p - origin), rotation * t);
        out.extend_from_slice(&[p.x, p.y, p.z, t.x, t.y, t.z]);
    }
    out[..3].fill(0.0);
    out
}
