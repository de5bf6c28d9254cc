//! Changes of the inputs.

use super::{Channel, Inputs};

impl Inputs {
    /// These inputs and `s` times the change `direction`, which counts only for derivatives that are known here.
    pub(super) fn moved(&self, s: f64, direction: &Self) -> Self {
        let mut moved = self.clone();
        for (to, by) in moved.channels().into_iter().zip(direction.clone().channels()) {
            let add = |x: Option<f64>, d: Option<f64>| x.map(|x| x + s * d.unwrap_or(0.0));
            *to = Channel { value: to.value + s * by.value, first: add(to.first, by.first), second: add(to.second, by.second) };
        }
        moved
    }

    /// How large a change is: 1 for a metre, a radian, a metre per second of current or `force` (N), and for a derivative that comes to as
    /// much within the time `h` (s).
    pub(super) fn size(&self, h: f64, force: f64) -> f64 {
        let mut copy = self.clone();
        let forces = copy.body_force.len();
        let channels = copy.channels();
        let scales = (0..channels.len()).rev().map(|left| if left < forces { force } else { 1.0 });
        let size = |c: &Channel| c.value.abs() + h * c.first.unwrap_or(0.0).abs() + h * h * c.second.unwrap_or(0.0).abs();
        channels.iter().zip(scales).map(|(c, scale)| size(c) / scale).fold(0.0, f64::max)
    }

    /// All channels; the forces come last.
    fn channels(&mut self) -> Vec<&mut Channel> {
        let Self { ship, winch, current, body_force } = self;
        ship.iter_mut().chain([winch]).chain(current).chain(body_force).collect()
    }
}
