//! Singly diagonally implicit Runge-Kutta methods with an explicit first stage (E. Hairer & G. Wanner, Solving Ordinary Differential Equations
//! II, section IV.8), in the second-order form: with g = γh the stage i > 0 looks for the accelerations a_i of
//!
//! ```text
//! 0 = F(t_i, u_i, w_i) − M(u_i) a_i,   w_i = w_0 + h Σ_{j<i} a_ij a_j + g a_i,   u_i = u_0 + h Σ_{j<i} a_ij w_j + g w_i
//! ```
//!
//! by Newton's method with the factors of M + g D + g² K, kept from step to step for as long as it converges fast enough.

use super::newton::{Outcome, Progress, SLOW};
use super::tableau::Tableau;
use super::vectors::{add, blend, climb, long_dot};
use super::{Integrator, Problem, Trial};
use crate::linalg::Bordered;
use crate::system::Matrices;
use std::slice::from_mut;

/// A step's length may change so much before the matrix is factored anew.
const SAME_STEP: f64 = 0.02;
/// Tangents that a try may take where Newton's method stalls.
const RENEWALS: usize = 3;

/// Work space, and the factors with all that they came from.
#[derive(Clone, Debug)]
pub struct Esdirk {
    tableau: &'static Tableau,
    /// Of M + g D + g² K.
    factors: Bordered,
    matrices: Matrices,
    /// Where the tangent was taken: u, w, a.
    origin: [Vec<f64>; 3],
    /// g of the factors, s; 0 before the first.
    g: f64,
    /// Newton's rate of convergence with them.
    rate: f64,
    /// w_i, a_i.
    w: Vec<Vec<f64>>,
    a: Vec<Vec<f64>>,
    /// What is known of u_i, w_i before a_i is.
    base: [Vec<f64>; 2],
    stage: [Vec<f64>; 2],
    residual: Vec<f64>,
    change: Vec<f64>,
    error: Vec<f64>,
    /// So many more tangents may be taken within the try.
    renewals: usize,
    /// Solves, tangents and factorizations so far.
    counts: [u64; 3],
}

impl Esdirk {
    /// For `size` unknowns, of which those `at` are coupled beyond the band.
    pub fn new(tableau: &'static Tableau, size: usize, at: &[usize]) -> Self {
        let zeros = || vec![0.0; size];
        let each = || vec![zeros(); tableau.nodes.len()];
        Self {
            tableau,
            factors: Bordered::zeros(size / 6, at),
            matrices: Matrices::zeros(size / 6),
            origin: [zeros(), zeros(), zeros()],
            g: 0.0,
            rate: 0.0,
            w: each(),
            a: each(),
            base: [zeros(), zeros()],
            stage: [zeros(), zeros()],
            residual: zeros(),
            change: zeros(),
            error: zeros(),
            renewals: 0,
            counts: [0; 3],
        }
    }

    /// The tangent where the step begins.
    fn refresh<P: Problem>(&mut self, problem: &mut P, t: f64, from: [&[f64]; 3]) {
        for (origin, from) in self.origin.iter_mut().zip(from) {
            origin.copy_from_slice(from);
        }
        problem.linearize(t, from[0], from[1], from[2], &mut self.matrices, &mut self.residual);
        self.counts[1] += 1;
        (self.g, self.rate) = (0.0, 0.0);
    }

    fn refactor(&mut self, g: f64) -> Result<(), Trial> {
        self.counts[2] += 1;
        self.g = 0.0;
        self.matrices.combine(g, &mut self.factors);
        self.factors.factor().map_err(|e| Trial::Singular(e.row))?;
        self.g = g;
        Ok(())
    }

    /// The tangent where Newton's method stands in stage `i`, because an older one, or one from too far away, leads nowhere. False if it is
    /// singular.
    fn renew<P: Problem>(&mut self, problem: &mut P, i: usize, t: f64, g: f64) -> bool {
        self.renewals -= 1;
        let mut at = std::mem::take(&mut self.origin);
        climb(&mut self.stage, &self.base, &self.a[i], g);
        problem.settle(&self.stage[0], &self.stage[1]);
        for (at, here) in at.iter_mut().zip([&self.stage[0], &self.stage[1], &self.a[i]]) {
            at.copy_from_slice(here);
        }
        problem.linearize(t, &at[0], &at[1], &at[2], &mut self.matrices, &mut self.residual);
        self.counts[1] += 1;
        self.origin = at;
        self.refactor(g).is_ok()
    }

    /// Stage `i` by Newton's method.
    fn solve_stage<P: Problem>(&mut self, problem: &mut P, i: usize, t: f64, g: f64) -> Outcome {
        let (known, rest) = self.a.split_at_mut(i);
        rest[0].copy_from_slice(&known[i - 1]);
        let mut progress = Progress::new(self.rate);
        let outcome = loop {
            let a = &mut self.a[i];
            climb(&mut self.stage, &self.base, a, g);
            problem.iterate(progress.count == 0, t, &self.stage[0], &self.stage[1], a, &mut self.residual);
            self.counts[0] += 1;
            self.change.copy_from_slice(&self.residual);
            self.factors.solve(&mut self.change);
            add(a, 1.0, &self.change);
            // The energy norm of the change of (u, w), so that axial waves and stiff contact count by what they pull.
            let size = problem.size_of(g * g * long_dot(&self.change, &self.residual).abs());
            match progress.judge(size) {
                Some(Outcome::Stalled) if self.renewals > 0 && self.renew(problem, i, t, g) => progress = Progress::new(0.0),
                Some(outcome) => break outcome,
                None => {}
            }
        };
        self.rate = progress.rate;
        climb(&mut self.stage, &self.base, &self.a[i], g);
        self.w[i].copy_from_slice(&self.stage[1]);
        problem.settle(&self.stage[0], &self.stage[1]);
        outcome
    }

    /// All stages; where Newton's method fails its outcome.
    fn stages<P: Problem>(&mut self, problem: &mut P, t: f64, h: f64, from: [&[f64]; 3]) -> Outcome {
        let g = self.tableau.gamma * h;
        self.w[0].copy_from_slice(from[1]);
        self.a[0].copy_from_slice(from[2]);
        for i in 1..self.tableau.nodes.len() {
            let weights = self.tableau.weights[i];
            let [u, w] = &mut self.base;
            blend(u, Some(from[0]), h, weights, &self.w);
            blend(w, Some(from[1]), h, weights, &self.a);
            let outcome = self.solve_stage(problem, i, t + self.tableau.nodes[i] * h, g);
            if outcome != Outcome::Converged {
                return outcome;
            }
        }
        Outcome::Converged
    }
}

impl Integrator for Esdirk {
    fn estimate_order(&self) -> usize {
        self.tableau.estimate_order
    }

    fn strictness(&self, relative: f64) -> f64 {
        self.tableau.strictness(relative)
    }

    fn begin<P: Problem>(&mut self, problem: &mut P, t: f64, from: [&[f64]; 3], force: &mut [f64]) {
        problem.force(t, from[0], from[1], None, force);
    }

    fn attempt<P: Problem>(&mut self, problem: &mut P, t: f64, h: f64, from: [&[f64]; 3], _: &[f64]) -> Trial {
        let g = self.tableau.gamma * h;
        self.renewals = RENEWALS;
        if self.g == 0.0 || self.rate > SLOW {
            self.refresh(problem, t, from);
        }
        let same = self.g > 0.0 && (g / self.g - 1.0).abs() <= SAME_STEP;
        if !same && let Err(trial) = self.refactor(g) {
            return trial;
        }
        let outcome = self.stages(problem, t, h, from);
        if outcome != Outcome::Converged {
            problem.rewind();
            self.g = 0.0;
            return if outcome == Outcome::NotFinite { Trial::Error(f64::NAN) } else { Trial::Stalled };
        }
        // J⁻¹M takes from the estimate what the method damps anyway (Hosea & Shampine, section 4).
        blend(&mut self.residual, None, h, self.tableau.estimate, &self.a);
        self.error.fill(0.0);
        self.matrices.multiply_add([Some((1.0, &self.residual)), None, None], &mut self.error);
        self.factors.solve(&mut self.error);
        self.residual.fill(0.0);
        self.matrices.multiply_add([Some((1.0, &self.error)), None, None], &mut self.residual);
        Trial::Error(problem.error_size(&self.error, &self.residual))
    }

    fn state(&self) -> [&[f64]; 3] {
        [&self.stage[0], &self.stage[1], &self.a[self.a.len() - 1]]
    }

    fn error(&self) -> &[f64] {
        &self.error
    }

    fn accept<P: Problem>(&self, _: &mut P) {}

    fn forget(&mut self) {
        (self.g, self.rate) = (0.0, 0.0);
    }

    fn visit(&mut self, visit: &mut dyn FnMut(&mut [f64])) {
        visit(from_mut(&mut self.g));
        visit(from_mut(&mut self.rate));
        self.origin.iter_mut().for_each(|x| visit(x));
    }

    fn retake<P: Problem>(&mut self, problem: &mut P) {
        if self.g == 0.0 {
            return;
        }
        let [u, w, a] = &self.origin;
        problem.relinearize(u, w, a, &mut self.matrices, &mut self.residual);
        // Only a forged state can be singular here; the next step then finds no factors and begins anew.
        let g = self.g;
        let _ = self.refactor(g);
    }

    fn carries_over(&self) -> bool {
        true
    }

    fn counts(&self) -> [u64; 3] {
        self.counts
    }
}
