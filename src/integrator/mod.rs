//! Time integration of M(u) ü = F(t, u, u̇) with block-tridiagonal matrices; knows no cable.

mod rodas4;

pub use rodas4::Rodas4;

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

    /// f = F(t, u, w), and M, D, K of F − M(u) a at this state. Prescribed rows of M are rows of the identity, of D and K zero.
    fn linearize(&mut self, t: f64, u: &[f64], w: &[f64], a: &[f64], matrices: &mut Matrices, f: &mut [f64]);

    /// ∂F/∂t at fixed u and w into `f`, given F there; `scale` is the time over which it matters. False if it vanishes.
    fn time_derivative(&mut self, t: f64, scale: f64, u: &[f64], w: &[f64], force: &[f64], f: &mut [f64]) -> bool;

    /// Whether M depends on u.
    fn mass_varies(&self) -> bool;

    /// Size of a velocity error `e`, given M e: 1 is just tolerable. NaN or infinite if `e` is.
    fn error_size(&self, e: &[f64], mass_e: &[f64]) -> f64;
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
}
