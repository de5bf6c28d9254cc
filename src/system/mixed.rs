//! Axial forces as unknowns of their own within a step.
//!
//! A working cable is strained by 1e-4 or so. Where an element turns by Δθ within a step, the stages of a Rosenbrock method, which lie on
//! straight lines, stretch it by ½Δθ²: at a hundredth of a radian half the tension, along a direction that is off by Δθ too. The error of
//! the step then grows like its fifth power and more, whatever the order. The cure is that of mixed finite elements (D. Magisano,
//! L. Leonetti & G. Garcea, Int. J. Numer. Meth. Engng 109 (2017) 1237-1262, there for Newton's method): the axial force N of each Gauss
//! point is an algebraic unknown,
//!
//! ```text
//! M(u) ü = F(t, u, u̇, N),   0 = σ(ε(u)) − N,
//! ```
//!
//! integrated by the same method, which keeps its order for such systems of index 1 (E. Hairer & G. Wanner, Solving Ordinary Differential
//! Equations II, VI.4). Each N is eliminated where it stands: the step's matrix stays what it was, and the force at stage i becomes
//!
//! ```text
//! N_i g_i + (σ_i − N_i) g_0  in place of  σ_i g_i,   N_i = N_0 + EA g_0·(r_p,i − r_p,0) + Σ_{j<i} a_ij (σ_j − N_j),   g = ∂ε/∂r_p.
//! ```
//!
//! N begins each step at σ, so nothing is kept between steps.

use crate::cable::section::Resistance;
use crate::integrator::Stage;
use crate::math::lanes::{Lanes, Vec3, axpy, dot, lane, set_lane};

/// Most stages that a method may have.
const STAGES: usize = 6;

/// N of one Gauss point of `W` elements side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxialUnknown<const W: usize> {
    /// g_0.
    g: [Lanes<W>; 3],
    /// σ_0 − EA g_0·r_p,0 and EA, N.
    offset: Lanes<W>,
    ea: Lanes<W>,
    /// σ_j − N_j, N.
    gaps: [Lanes<W>; STAGES],
    /// Σ_{j<i} a_ij (σ_j − N_j) of the stage at hand, N.
    drift: Lanes<W>,
}

impl<const W: usize> AxialUnknown<W> {
    /// Before any step.
    pub const NONE: Self = Self { g: [Lanes::ZERO; 3], offset: Lanes::ZERO, ea: Lanes::ZERO, gaps: [Lanes::ZERO; STAGES], drift: Lanes::ZERO };

    /// A step begins with element `l` at r_p = `p`.
    #[inline(always)]
    pub fn begin(&mut self, l: usize, r: &Resistance, p: &Vec3<f64>) {
        set_lane(&mut self.g, l, r.g);
        self.offset.0[l] = r.elastic - r.ea * dot(&r.g, p);
        self.ea.0[l] = r.ea;
        self.gaps[0].0[l] = 0.0;
    }

    /// A stage begins.
    #[inline(always)]
    pub fn enter(&mut self, stage: &Stage) {
        self.drift = Lanes::ZERO;
        for (weight, gap) in stage.weights.iter().zip(&self.gaps) {
            for l in 0..W {
                self.drift.0[l] += weight * gap.0[l];
            }
        }
    }

    /// The force of element `l` at a stage, given that of the law.
    #[inline(always)]
    pub fn force(&mut self, l: usize, stage: usize, r: &Resistance, p: &Vec3<f64>) -> Vec3<f64> {
        let g = lane(&self.g, l);
        // Where the law has switched between taut and slack its slope at the step's begin says nothing.
        let same = if r.ea == self.ea.0[l] { 1.0 } else { 0.0 };
        let gap = same * (r.elastic - (self.offset.0[l] + self.ea.0[l] * dot(&g, p) + self.drift.0[l]));
        self.gaps[stage].0[l] = gap;
        axpy(&axpy(&r.n, -gap, &r.g), gap, &g)
    }
}
