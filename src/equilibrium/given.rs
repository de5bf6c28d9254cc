//! Start shapes from a file.

use crate::cable::shape;
use crate::scene::ShapePoint;
use crate::system::System;
use nalgebra::Vector3;

/// Start from given points: positions and velocities interpolated linearly in between unless tangents make the cubic known.
///
/// # Errors
/// What does not fit.
pub fn take_shape(system: &System, t: f64, points: &[ShapePoint], u: &mut [f64], w: &mut [f64]) -> Result<(), String> {
    let env = system.environment(t);
    let base = Vector3::from(env.base.map(|j| j.0[0]));
    let base_velocity = Vector3::from(env.base.map(|j| j.0[1]));
    let (first, last) = (points.first(), points.last());
    let (Some(first), Some(last)) = (first, last) else { return Err("initial.file has no points".into()) };
    let end = system.arc[system.arc.len() - 1];
    let slack = 1e-6 * end;
    if first.s > slack || last.s < end - slack {
        return Err(format!("initial.file covers arc lengths {} to {} m, the cable 0 to {end} m", first.s, last.s));
    }
    let gap = (first.position - base).norm();
    if gap > 1e-4 * end {
        return Err(format!(
            "initial.file starts {gap:.3e} m away from the cable's first end at ({:.4}, {:.4}, {:.4}) m",
            base.x, base.y, base.z
        ));
    }
    // All but the first node, which its support holds, come to lie where the file says: a shape shifted by micrometres would press a stiff
    // sheave. Tangents not given: central differences over the neighbours.
    let tangent = |i: usize| {
        points[i].tangent.unwrap_or_else(|| {
            let (a, b) = (&points[i.saturating_sub(1)], &points[(i + 1).min(points.len() - 1)]);
            (b.position - a.position) / (b.s - a.s)
        })
    };
    for (node, &s) in system.arc.iter().enumerate() {
        let i = points[1..points.len() - 1].partition_point(|p| p.s <= s);
        let (a, b) = (&points[i], &points[(i + 1).min(points.len() - 1)]);
        let l = b.s - a.s;
        let x = if l > 0.0 { ((s - a.s) / l).clamp(0.0, 1.0) } else { 0.0 };
        let (h, d) = (shape::value(x, l), shape::slope(x, 1.0 / l));
        let (ta, tb) = (tangent(i), tangent((i + 1).min(points.len() - 1)));
        let at = |h: &[f64; 4]| a.position * h[0] + ta * h[1] + b.position * h[2] + tb * h[3];
        let (position, slope) = (at(&h) - base, at(&d));
        let velocity = a.velocity * (1.0 - x) + b.velocity * x - base_velocity;
        let rate = (b.velocity - a.velocity) / l;
        for c in 0..3 {
            (u[6 * node + c], u[6 * node + 3 + c]) = (position[c], slope[c]);
            (w[6 * node + c], w[6 * node + 3 + c]) = (velocity[c], rate[c]);
        }
    }
    if system.load.is_some() {
        // A load is not in the file: it points, and turns, as the cable's end does.
        let (last, end) = (6 * system.arc.len() - 3, 6 * system.arc.len() + 3);
        let slope = Vector3::new(u[last], u[last + 1], u[last + 2]);
        let rate = Vector3::new(w[last], w[last + 1], w[last + 2]);
        if slope.norm() < 1e-9 {
            return Err("initial.file gives no direction at the cable's end, which the load needs; expected tx, ty, tz there".into());
        }
        u[end..end + 3].copy_from_slice((slope / slope.norm()).as_slice());
        w[end..end + 3].copy_from_slice((rate / slope.norm()).as_slice()); // its part along the link goes with the projection
    }
    u[..3].fill(0.0);
    w[..3].fill(0.0);
    Ok(())
}
