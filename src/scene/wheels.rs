//! Geometry of drum and sheaves that cannot be: a groove too narrow for the cable, wheels inside each other.

use super::model::Scene;
use super::problem::Problems;
use nalgebra::Vector3;

/// Cosine of the angle up to which two axes count as parallel.
const PARALLEL: f64 = 0.999;

/// A disc in ship axes.
struct Disc<'a> {
    key: String,
    name: &'a str,
    centre: Vector3<f64>,
    axis: Vector3<f64>,
    radius: f64,
    half_width: f64,
}

/// Finds impossible geometry in a scene.
pub(super) fn check(scene: &Scene, problems: &mut Problems) {
    let d = scene.cable.diameter;
    for (i, s) in scene.sheaves.iter().enumerate() {
        let Some(angle) = s.groove_angle else { continue };
        let opening = 2.0 * s.groove_depth * (0.5 * angle).tan();
        if opening < d {
            problems.add_once(
                &format!("sheave[{}].groove_depth", i + 1),
                format!(
                    "the groove of sheave \"{}\" opens to {opening:.4e} m at its depth of {} m and angle of {angle} rad, narrower than the \
                     cable; expected at least cable.diameter = {d} m",
                    s.name, s.groove_depth
                ),
            );
        }
    }
    // A drum has no known width; it counts as wide as the cable.
    let drum = scene.winch.iter().filter(|w| w.contact.is_some()).map(|w| Disc {
        key: "winch.position".into(),
        name: "the drum",
        centre: w.position,
        axis: w.axis,
        radius: w.radius,
        half_width: 0.5 * d,
    });
    let sheaves = scene.sheaves.iter().enumerate().map(|(i, s)| {
        let opening = s.groove_angle.map_or(0.0, |a| s.groove_depth * (0.5 * a).tan());
        Disc {
            key: format!("sheave[{}].position", i + 1),
            name: &s.name,
            centre: s.position,
            axis: s.axis,
            radius: s.radius,
            half_width: if opening.is_finite() { opening.max(0.5 * d) } else { 0.5 * d },
        }
    });
    let discs: Vec<Disc> = drum.chain(sheaves).collect();
    for (i, a) in discs.iter().enumerate() {
        for b in &discs[..i] {
            let between = a.centre - b.centre;
            let axial = between.dot(&b.axis).abs();
            let across = (between - b.axis * between.dot(&b.axis)).norm();
            let parallel = a.axis.dot(&b.axis).abs() > PARALLEL;
            if parallel && axial < a.half_width + b.half_width && across < a.radius + b.radius {
                problems.add_once(
                    &a.key,
                    format!(
                        "\"{}\" (radius {} m) and \"{}\" (radius {} m) lie inside each other: their axes are {across:.4} m apart; expected at \
                         least {:.4} m",
                        a.name,
                        a.radius,
                        b.name,
                        b.radius,
                        a.radius + b.radius
                    ),
                );
            }
        }
    }
}
