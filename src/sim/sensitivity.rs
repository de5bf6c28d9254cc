//! How the outputs at the end of the last step depend on the inputs of that step: its tangent, which a master needs to solve for inputs by
//! Newton's method ("interface Jacobian": S. Sicklinger et al., Int. J. Numer. Meth. Engng 98 (2014) 418-444).
//!
//! The linearized equations of motion along the step,
//!
//! ```text
//! M δẇ = ∂G/∂p δp(t) − D δw − K δu,   δu̇ = δw,   δu = δw = 0 at the step's begin,
//! ```
//!
//! with G = F − M a and M, D, K as the integrator has them, are integrated over the same sub-steps, each by the L-stable, stiffly accurate
//! method SDIRK4 (E. Hairer & G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., table IV.6.5; order 4) with the matrices of
//! every stage's own state, so that a stiff cable's tension answers the shape at the step's end and not at its begin. The step is repeated
//! from its begin for that: nothing is stored or computed while nobody asks.

use super::{Inputs, SimError, Simulation};
use crate::integrator::Problem;
use crate::integrator::vectors::add;
use crate::linalg::Bordered;
use crate::outputs::Slope;
use crate::system::{FarEnd, Matrices, System};

const STAGES: usize = 5;
const GAMMA: f64 = 0.25;
/// Stage times.
const C: [f64; STAGES] = [0.25, 0.75, 11.0 / 20.0, 0.5, 1.0];
/// Weights of the earlier stages. The last stage is the solution.
static A: [&[f64]; STAGES] = [
    &[],
    &[0.5],
    &[17.0 / 50.0, -1.0 / 25.0],
    &[371.0 / 1360.0, -137.0 / 2720.0, 15.0 / 544.0],
    &[25.0 / 24.0, -49.0 / 48.0, 125.0 / 16.0, -85.0 / 12.0],
];
/// An input's change is differenced over this part of its scale.
const PART: f64 = 1e-6;

/// δu, δw, δa per unit of the direction.
struct Tangent {
    u: Vec<f64>,
    w: Vec<f64>,
    a: Vec<f64>,
}

/// The step's prescribed motion with inputs a little above and a little below, and how far these are apart.
struct Sides {
    above: Simulation,
    below: Simulation,
    width: f64,
}

/// One end of a sub-step.
#[derive(Clone)]
struct Node {
    t: f64,
    u: Vec<f64>,
    w: Vec<f64>,
    a: Vec<f64>,
}

impl Simulation {
    /// The derivative of the outputs at the end of the last step along `direction`, a change of the inputs that the step began with. A
    /// derivative (`first`, `second`) in `direction` counts where the step's inputs had one.
    ///
    /// # Errors
    /// [`SimError::State`] where there is no last step: at the start, after a step that failed and after [`Self::read_state`].
    pub fn sensitivity(&self, direction: &Inputs) -> Result<Slope, SimError> {
        let none = "no step leads to the present state; expected a directional derivative after a step";
        let (drives, inputs) = self.last.as_ref().ok_or_else(|| SimError::State(none.into()))?;
        let (begin, end) = (self.backup.time, self.state.time);
        let half = PART / direction.size(end - begin, self.state.tension).max(f64::MIN_POSITIVE);
        let driven = |s: f64| {
            let mut replay = self.clone();
            replay.rewind(drives);
            replay.drive(begin, end - begin, &inputs.moved(s, direction));
            replay
        };
        let mut sides = Sides { above: driven(half), below: driven(-half), width: 2.0 * half };
        let tangent = driven(0.0).tangent(end, &mut sides)?;
        let mut at =
            |side: fn(&mut Sides) -> &mut Self, s: f64| side(&mut sides).outputs_beside(self, [&tangent.u, &tangent.w, &tangent.a], s, 0.0);
        Ok(Slope { above: at(|s| &mut s.above, half), below: at(|s| &mut s.below, -half), width: 2.0 * half })
    }

    /// Repeats the step to `end`, and takes the tangent along.
    fn tangent(mut self, end: f64, sides: &mut Sides) -> Result<Tangent, SimError> {
        let mut linear = Linear::new(&self);
        let mut from = self.node();
        // One sub-step at a time.
        self.scene.solver.steps_max = 1;
        while self.state.time < end {
            let stopped = self.integrate(end);
            if self.state.time == from.t {
                return Err(SimError::Step(stopped.err().unwrap_or_default()));
            }
            let to = self.node();
            linear.advance(&from, &to, sides).map_err(|row| SimError::Step(format!("the tangent of block row {row} is singular")))?;
            from = to;
        }
        Ok(linear.tangent)
    }

    fn node(&self) -> Node {
        let s = &self.state;
        Node { t: s.time, u: s.u.clone(), w: s.w.clone(), a: s.a.clone() }
    }
}

impl Node {
    /// The state at the part `x` of the way to `to`: the cubic through both ends.
    fn between(&self, to: &Self, x: f64) -> Self {
        let h = to.t - self.t;
        let y = 1.0 - x;
        let mut at = self.clone();
        at.t += x * h;
        for i in 0..self.u.len() {
            let ([u0, w0], [u1, w1]) = ([self.u[i], self.w[i]], [to.u[i], to.w[i]]);
            at.u[i] += x * x * (3.0 - 2.0 * x) * (u1 - u0) + h * x * y * (y * w0 - x * w1);
            at.w[i] = 6.0 * x * y * (u1 - u0) / h + y * (1.0 - 3.0 * x) * w0 + x * (3.0 * x - 2.0) * w1;
            at.a[i] += x * (to.a[i] - self.a[i]);
        }
        at
    }
}

/// The linearized equations of motion and their solution so far.
struct Linear {
    system: System,
    matrices: Matrices,
    factors: Bordered,
    tangent: Tangent,
    /// Stages: δw and δa.
    w: Vec<Vec<f64>>,
    a: Vec<Vec<f64>>,
    /// δG of the inputs, then of all.
    rhs: Vec<f64>,
    scratch: [Vec<f64>; 2],
}

impl Linear {
    fn new(simulation: &Simulation) -> Self {
        let mut system = simulation.system.clone();
        // The law's own axial forces: those that the outputs are made of.
        system.keeps_axial = false;
        let zeros = || vec![0.0; simulation.state.u.len()];
        let places: Vec<usize> = system.turning.iter().map(|s| s.at).collect();
        Self {
            matrices: Matrices::zeros(system.nodes()),
            factors: Bordered::zeros(system.nodes(), &places),
            tangent: Tangent { u: zeros(), w: zeros(), a: zeros() },
            w: vec![zeros(); STAGES],
            a: vec![zeros(); STAGES],
            rhs: zeros(),
            scratch: [zeros(), zeros()],
            system,
        }
    }

    /// Over one sub-step.
    ///
    /// # Errors
    /// The block row whose pivot vanishes.
    fn advance(&mut self, from: &Node, to: &Node, sides: &mut Sides) -> Result<(), usize> {
        let h = to.t - from.t;
        let g = GAMMA * h;
        for side in [&mut sides.above, &mut sides.below] {
            side.system.attempt(from.t, h);
        }
        for i in 0..STAGES {
            let at = from.between(to, C[i]);
            self.system.linearize(at.t, &at.u, &at.w, &at.a, &mut self.matrices, &mut self.rhs);
            let m = &self.matrices;
            m.combine(g, &mut self.factors);
            self.factors.factor().map_err(|e| e.row)?;
            sides.force(&at, &mut self.rhs, &mut self.scratch[0]);
            // What the earlier stages make of δw, and of δu with g δw.
            let [w, u] = &mut self.scratch;
            w.copy_from_slice(&self.tangent.w);
            u.copy_from_slice(&self.tangent.u);
            for (j, a) in A[i].iter().enumerate() {
                add(w, h * a, &self.a[j]);
                add(u, h * a, &self.w[j]);
            }
            add(u, g, w);
            m.multiply_add([None, Some((-1.0, w)), Some((-1.0, u))], &mut self.rhs);
            // (M + g D + g² K) δa = δG − D δw − K δu
            self.factors.solve(&mut self.rhs);
            self.a[i].copy_from_slice(&self.rhs);
            add(w, g, &self.a[i]);
            self.w[i].copy_from_slice(w);
            if i + 1 == STAGES {
                add(u, g * g, &self.a[i]);
                self.tangent.u.copy_from_slice(u);
                self.tangent.w.copy_from_slice(w);
                self.tangent.a.copy_from_slice(&self.a[i]);
            }
        }
        sides.far_end(to.t, &mut self.tangent);
        Ok(())
    }
}

impl Sides {
    /// δG at one state.
    fn force(&mut self, at: &Node, g: &mut [f64], scratch: &mut [f64]) {
        self.above.system.force(at.t, &at.u, &at.w, Some(&at.a), g);
        self.below.system.force(at.t, &at.u, &at.w, Some(&at.a), scratch);
        for (above, below) in g.iter_mut().zip(scratch) {
            *above = (*above - *below) / self.width;
        }
    }

    /// A fixed far end is where it is, to the last digit; the sub-step that was attempted is over.
    fn far_end(&mut self, t: f64, tangent: &mut Tangent) {
        let motion = |s: &Simulation| s.system.far_end.map(|end| end.motion(&s.system.environment(t).base));
        let (Some(above), Some(below)) = (motion(&self.above), motion(&self.below)) else { return };
        let at = 6 * (self.above.system.arc.len() - 1);
        for (k, x) in [&mut tangent.u, &mut tangent.w, &mut tangent.a].into_iter().enumerate() {
            for c in 0..3 {
                x[at + c] = (above[k][c] - below[k][c]) / self.width;
            }
        }
        for side in [&mut self.above, &mut self.below] {
            side.system.far_end = side.system.far_end.map(|end| FarEnd::new(end.position));
        }
    }
}
