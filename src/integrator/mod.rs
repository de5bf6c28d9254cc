//! Time integration of M(u) ü = F(t, u, u̇) with block-tridiagonal matrices; knows no cable.

mod esdirk;
mod method;
mod newton;
mod radau5;
mod rodas4;
mod tableau;
#[cfg(test)]
mod tests;
pub mod vectors;

pub use esdirk::Esdirk;
pub use method::Method;
pub use radau5::Radau5;
pub use rodas4::Rodas4;
pub use tableau::{ESDIRK3, ESDIRK4, TR_BDF2, Tableau};

use crate::system::Matrices;

/// A second-order system.
pub trait Problem {
    /// Number of unknowns, six per node.
    fn size(&self) -> usize;

    /// f = F(t, u, w) − M(u) a; without `a` just F. Zero in prescribed rows.
    fn force(&mut self, t: f64, u: &[f64], w: &[f64], a: Option<&[f64]>, f: &mut [f64]);

    /// The same at a stage of the step that began where `linearize` was last called. A problem may hold fast unknowns of its own, 0 = G(u, N),
    /// and eliminate them here; they need no more than the stage's weights.
    fn stage_force(&mut self, stage: Stage, t: f64, u: &[f64], w: &[f64], a: Option<&[f64]>, f: &mut [f64]);

    /// The step that began with the last tangent ends at (u, w), of the stages' increments weighted so.
    fn accept(&mut self, u: &[f64], w: &[f64], weights: &[f64]);

    /// f = F(t, u, w) − M(u) a at an iterate of Newton's method in a stage, `first` or later, whose tangent is that of the last `linearize`.
    /// The problem's fast unknowns are iterates too.
    fn iterate(&mut self, first: bool, t: f64, u: &[f64], w: &[f64], a: &[f64], f: &mut [f64]);

    /// A step ends at (u, w) whose stages knew no fast unknowns: these are what the state makes them.
    fn adopt(&mut self, u: &[f64], w: &[f64]);

    /// Newton's method has ended at (u, w); the next stage begins with the fast unknowns as they are there.
    fn settle(&mut self, u: &[f64], w: &[f64]);

    /// The fast unknowns go back to where the step began.
    fn rewind(&mut self);

    /// f = F(t, u, w), and M, D, K of F − M(u) a at this state. Prescribed rows of M are rows of the identity, of D and K zero.
    fn linearize(&mut self, t: f64, u: &[f64], w: &[f64], a: &[f64], matrices: &mut Matrices, f: &mut [f64]);

    /// The last `linearize` again, at the same time and under the same inputs.
    fn relinearize(&mut self, u: &[f64], w: &[f64], a: &[f64], matrices: &mut Matrices, f: &mut [f64]);

    /// ∂F/∂t at fixed u and w into `f`, given F there; `scale` is the time over which it matters. False if it vanishes.
    fn time_derivative(&mut self, t: f64, scale: f64, u: &[f64], w: &[f64], force: &[f64], f: &mut [f64]) -> bool;

    /// Whether M depends on u.
    fn mass_varies(&self) -> bool;

    /// Size of an error of twice this energy, J: 1 is just tolerable. NaN or infinite if the energy is.
    fn size_of(&self, energy: f64) -> f64;

    /// Size of a velocity error `e`, given M e.
    fn error_size(&self, e: &[f64], mass_e: &[f64]) -> f64 {
        let energy: f64 = e.iter().zip(mass_e).map(|(a, b)| a * b).sum();
        // Rounding may make a very small one negative.
        self.size_of(if energy < 0.0 { 0.0 } else { energy })
    }
}

/// A one-step method with error estimate.
pub trait Integrator {
    /// Order of the error estimate plus one: error ~ h^this.
    fn estimate_order(&self) -> usize;

    /// Tolerable error estimate per relative error asked for: the estimate is of the lower-order formula, so the solution is better than it
    /// says; and the errors of many steps add up. With this the true error is about what was asked for (fmu-tests/rust/convergence.rs).
    fn strictness(&self, relative: f64) -> f64;

    /// What the tries of a step from (t, u, w, a) share; F there into `force`.
    fn begin<P: Problem>(&mut self, problem: &mut P, t: f64, from: [&[f64]; 3], force: &mut [f64]);

    /// Tries a step of `h` after `begin`.
    fn attempt<P: Problem>(&mut self, problem: &mut P, t: f64, h: f64, from: [&[f64]; 3], force: &[f64]) -> Trial;

    /// u, w, a at the end of the last try; a only if the method carries it or M varies.
    fn state(&self) -> [&[f64]; 3];

    /// The last try's estimated velocity error.
    fn error(&self) -> &[f64];

    /// The last try is the step; the problem's fast unknowns follow.
    fn accept<P: Problem>(&self, problem: &mut P);

    /// The next step begins with a new tangent.
    fn forget(&mut self);

    /// Every number that says where the kept tangent was taken, run by run, for snapshots; none if the method keeps none from step to step.
    fn visit(&mut self, visit: &mut dyn FnMut(&mut [f64]));

    /// Takes that tangent again and factors it, after a snapshot was read.
    fn retake<P: Problem>(&mut self, problem: &mut P);

    /// Whether accelerations (M constant or not) and the tangent are carried over from step to step.
    fn carries_over(&self) -> bool;

    /// Linear solves of the stages, tangents and factorizations so far.
    fn counts(&self) -> [u64; 3];
}

/// The most stages that a method may have.
pub const MOST_STAGES: usize = 6;

/// A stage of a Rosenbrock method: its value is y_0 + Σ a_ij U_j.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a> {
    /// i, from 0.
    pub index: usize,
    /// a_ij, j < i.
    pub weights: &'a [f64],
}

/// What one try of a step came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trial {
    /// Size of the estimated error; 1 is just tolerable.
    Error(f64),
    /// The matrix could not be factored; the block row.
    Singular(usize),
    /// Newton's method did not converge.
    Stalled,
}
