//! Where the cable is laid before its equilibrium is sought.

use crate::scene::Scene;
use crate::system::System;
use nalgebra::Vector3;
use std::f64::consts::PI;

/// A current slower than this carries nothing away, m/s.
const STILL: f64 = 1e-6;

/// Weight less buoyancy of cable and body when all is under water, N over gravity.
fn net_mass(scene: &Scene) -> f64 {
    let (cable, body) = (&scene.cable, scene.body.as_ref());
    let mass = cable.mass_per_length * cable.length + body.map_or(0.0, |b| b.mass) + scene.load.map_or(0.0, |l| l.mass);
    let volume = PI * cable.diameter.powi(2) / 4.0 * cable.length + body.map_or(0.0, |b| b.volume);
    mass - scene.fluid.as_ref().map_or(0.0, |f| f.density * volume)
}

/// The direction down the free cable, world: down what sinks, up what floats from a first end under water, and from one above it straight to
/// where the far end floats on the surface, with the current.
pub(super) fn direction(scene: &Scene, system: &System, t: f64) -> Vector3<f64> {
    if net_mass(scene) >= 0.0 {
        return -Vector3::z();
    }
    let env = system.environment(t);
    let height = system.chain.water.as_ref().map_or(0.0, |w| env.base[2].0[0] - w.waterline);
    let Some(water) = system.chain.water.as_ref().filter(|_| height > 0.0) else { return Vector3::z() };
    let (stream, _) = water.stream(water.full(), &env.flow);
    let past = Vector3::new(stream[0] - env.base[0].0[1], stream[1] - env.base[1].0[1], 0.0);
    let along = past.try_normalize(STILL).unwrap_or_else(Vector3::x);
    let drop = (height / scene.cable.length).min(1.0);
    along * (1.0 - drop * drop).sqrt() - Vector3::z() * drop
}
