//! Time derivatives of the outputs.
//!
//! The outputs are functions O(t, u, w, a) of the state, and the state moves along u̇ = w, ẇ = a and ȧ, which the equations of motion give:
//!
//! ```text
//! 0 = G(t, u, w, a) = F(t, u, w) − M(u) a   ⇒   M ȧ = ∂G/∂t + ∂G/∂u w + ∂G/∂w a.
//! ```
//!
//! So dO/dt = ∂O/∂t + ∂O/∂u w + ∂O/∂w a + ∂O/∂a ȧ is exact for the semi-discrete cable; no past step enters. Both directional derivatives are
//! taken as central differences of one evaluation each, over a time in which nothing curves. Everything prescribed goes on as it came: the
//! rates are those on arrival, before new inputs.

use super::Simulation;
use crate::integrator::Problem;
use crate::outputs::Slope;
use crate::system::FirstEnd;

/// Half the width of the differences, s: a cable's fastest wave needs a hundred times as long through an element. Rounding leaves about
/// 1e-16 EA / `HALF` of a tension's rate.
const HALF: f64 = 1e-6;

impl Simulation {
    /// Time derivatives of the outputs at the present time, as the outputs on both sides of it.
    pub fn rates(&self) -> Slope {
        let mut moved = self.clone();
        let jerk = moved.jerk();
        let s = &self.state;
        let mut at = |dt: f64| moved.outputs_beside(self, [&s.w, &s.a, &jerk], dt, dt);
        Slope { above: at(HALF), below: at(-HALF), width: 2.0 * HALF }
    }

    /// The outputs where the state is that of `from` plus `s` times the direction (u, w, a), and the time is later by `dt`, with everything
    /// prescribed as it is here.
    pub(super) fn outputs_beside(&mut self, from: &Self, direction: [&[f64]; 3], s: f64, dt: f64) -> crate::outputs::Outputs {
        let time = from.state.time + dt;
        let state = &mut self.state;
        state.time = time;
        let (to, from) = ([&mut state.u, &mut state.w, &mut state.a], [&from.state.u, &from.state.w, &from.state.a]);
        for ((to, from), direction) in to.into_iter().zip(from).zip(direction) {
            for ((to, from), d) in to.iter_mut().zip(from).zip(direction) {
                *to = from + s * d;
            }
        }
        if let FirstEnd::Winch { drive, .. } = &mut self.system.first {
            drive.commit(time);
        }
        self.observe();
        self.outputs.clone()
    }

    /// ȧ, m/s³.
    fn jerk(&mut self) -> Vec<f64> {
        let moved = |x: &[f64], rate: &[f64], dt: f64| -> Vec<f64> { x.iter().zip(rate).map(|(x, r)| x + dt * r).collect() };
        let [mut jerk, mut below] = [HALF, -HALF].map(|dt| {
            let s = &self.state;
            let mut g = vec![0.0; s.u.len()];
            self.system.force(s.time + dt, &moved(&s.u, &s.w, dt), &moved(&s.w, &s.a, dt), Some(&s.a), &mut g);
            g
        });
        for (above, below) in jerk.iter_mut().zip(&below) {
            *above = (*above - below) / (2.0 * HALF);
        }
        let (s, k) = (&self.state, &mut self.work);
        self.system.keeps_axial = false;
        self.system.linearize(s.time, &s.u, &s.w, &s.a, &mut k.matrices, &mut below);
        let [mut mass, ..] = k.matrices.whole();
        // The mass matrix is positive definite, so this cannot fail.
        if mass.factor().is_ok() {
            mass.solve(&mut jerk);
        }
        jerk
    }
}
