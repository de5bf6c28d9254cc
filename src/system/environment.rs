//! What acts on the cable from outside at one instant.

use crate::hydro::line::Flow;
use crate::math::jet::Jet;
use crate::math::lanes::Vec3;
use crate::ship::Frame;

/// Boundary motion, ship's frame, flow and forces at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Environment {
    /// The instant, s.
    pub time: f64,
    /// World motion of the cable's first node.
    pub base: [Jet; 3],
    /// ü of a fixed far end, m/s².
    pub far_end_acceleration: Vec3<f64>,
    /// World direction along which a `tangent` end holds the slope.
    pub tangent: Vec3<f64>,
    /// The ship.
    pub frame: Frame,
    /// Uniform current.
    pub flow: Flow,
    /// Gravitational acceleration, m/s².
    pub gravity: Vec3<f64>,
    /// External force on the body, N.
    pub body_force: Vec3<f64>,
}

impl Environment {
    /// Every number, run by run, for snapshots.
    pub fn visit(&mut self, visit: &mut dyn FnMut(&mut [f64])) {
        visit(std::slice::from_mut(&mut self.time));
        let frame = &mut self.frame;
        let jets = self.base.iter_mut().chain(&mut frame.origin).chain(frame.rotation.iter_mut().flatten());
        let vectors = [&mut self.far_end_acceleration, &mut self.tangent, &mut self.flow.velocity, &mut self.flow.acceleration];
        let others = vectors.into_iter().chain([&mut self.gravity, &mut self.body_force]);
        jets.for_each(|j| visit(&mut j.0));
        others.for_each(|x| visit(x));
    }
}
