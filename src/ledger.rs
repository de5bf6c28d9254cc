//! Work and energy in the frame that moves with the cable's first node, where its support does no work:
//!
//! ```text
//! d/dt (½ wᵀMw + U_elastic) = w·F + dU_elastic/dt + ½ wᵀṀw
//! ```
//!
//! with F all forces, the elastic ones and the frame's inertia included. What remains of the difference is the integrator's doing.

use crate::system::Tally;

/// Sums since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ledger {
    /// Energy at the start and at the last reached state, J.
    first: f64,
    energy: f64,
    /// Work and the sum of its sizes node by node, J.
    work: f64,
    effort: f64,
    /// Least effort that counts as one, J.
    floor: f64,
    /// Power and its size at the last reached state, W.
    power: [f64; 2],
    /// A step under way: its length, and power and size at its middle.
    pending: [f64; 3],
}

/// Power of all but the elastic forces, W, and its size, of an evaluation that gave `f` = F − M a, with a or without.
fn powers(tally: &Tally, w: &[f64], f: &[f64]) -> [f64; 2] {
    let [mut sum, mut size] = tally.inertial;
    for (w, f) in w.chunks_exact(6).zip(f.chunks_exact(6)) {
        let p: f64 = w.iter().zip(f).map(|(a, b)| a * b).sum();
        sum += p;
        size += p.abs();
    }
    [sum + tally.elastic_power + tally.turning, size]
}

impl Ledger {
    /// At the start, which is balanced by `f`.
    pub fn start(tally: &Tally, w: &[f64], f: &[f64], floor: f64) -> Self {
        let energy = tally.elastic + tally.kinetic;
        Self { first: energy, energy, floor, power: powers(tally, w, f), ..Self::default() }
    }

    /// A state is reached; `f` are the forces there, with M a or without.
    pub fn reach(&mut self, tally: &Tally, w: &[f64], f: &[f64]) {
        let now = powers(tally, w, f);
        let [h, mid, mid_size] = self.pending;
        if h > 0.0 {
            self.work += h / 6.0 * (self.power[0] + 4.0 * mid + now[0]);
            self.effort += h / 6.0 * (self.power[1] + 4.0 * mid_size + now[1]);
            self.pending = [0.0; 3];
            self.energy = tally.elastic + tally.kinetic;
        }
        self.power = now;
    }

    /// A step of `h` with this at its middle.
    pub fn pass(&mut self, h: f64, tally: &Tally, w: &[f64], f: &[f64]) {
        let mid = powers(tally, w, f);
        self.pending = [h, mid[0], mid[1]];
    }

    /// Defect over the work done.
    pub fn error(&self) -> f64 {
        (self.energy - self.first - self.work).abs() / (self.effort + self.floor)
    }

    /// Every number, for snapshots.
    pub fn visit(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        for x in [&mut self.first, &mut self.energy, &mut self.work, &mut self.effort, &mut self.floor] {
            visit(x);
        }
        self.power.iter_mut().chain(&mut self.pending).for_each(visit);
    }
}
