//! A derivative of the outputs by one number, as the outputs on both sides of it.

use super::Outputs;

/// The outputs at s = +h and s = −h beside the committed state, and 2 h.
#[derive(Clone, Debug)]
pub struct Slope {
    /// At +h.
    pub above: Outputs,
    /// At −h.
    pub below: Outputs,
    /// 2 h, in the unit of s.
    pub width: f64,
}

impl Slope {
    /// The central difference of one quantity: its derivative by s.
    pub fn of(&self, quantity: impl Fn(&Outputs) -> f64) -> f64 {
        (quantity(&self.above) - quantity(&self.below)) / self.width
    }
}
