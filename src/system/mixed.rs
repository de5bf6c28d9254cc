//! Axial forces as unknowns of their own within a step.
//!
//! A working cable is strained by 1e-4 or so. Where an element turns by Δθ within a step, the stages of a Rosenbrock method, which lie on
//! straight lines, stretch it by ½Δθ²: at a hundredth of a radian half the tension, along a direction that is off by Δθ too. The error of
//! the step then grows like its fifth power and more, whatever the order. The cure is that of mixed finite elements (D. Magisano,
//! L. Leonetti & G. Garcea, Int. J. Numer. Meth. Engng 109 (2017) 1237-1262, there for Newton's method): the axial force N of each Gauss
//! point is an algebraic unknown,
//!
//! ```text
//! M(u) ü = F(t, u, u̇, N),   0 = σ(ε) + c_a ε̇ − N =: Σ(u, u̇) − N,
//! ```
//!
//! integrated by the same method, which keeps its order for such systems of index 1 (E. Hairer & G. Wanner, Solving Ordinary Differential
//! Equations II, VI.4). Each N is eliminated where it stands: the step's matrix stays what it was, and the force at stage i becomes
//!
//! ```text
//! N_i g_i + (Σ_i − N_i) g_0  in place of  Σ_i g_i,   N_i = N_0 + Σ'·(y_i − y_0) + Σ_{j<i} a_ij (Σ_j − N_j),
//!
//! g = ∂ε/∂r_p, and Σ'·y the derivative at the step's begin along the change of (r_p, ṙ_p).
//! ```
//!
//! Newton's method in an implicit stage has the same trouble, and the same cure: iterate k knows N_k, its residual has N_k g_k + (Σ_k − N_k) g_0
//! in place of Σ_k g_k, and the next N is Σ_k + Σ'·(y_{k+1} − y_k), with Σ' and g_0 those of the kept tangent. It then converges at a rate of
//! about Δθ instead of EA Δθ²/N, so that the factors can be kept.
//!
//! N is part of the state, so that a strain's error, EA times which may be many times the tension, is not taken for a force; each step brings
//! it nearer to Σ again.

use crate::cable::section::{Resistance, Strains};
use crate::integrator::MOST_STAGES;
use crate::math::lanes::{Lanes, Vec3, axpy, dot, lane, set_lane};

/// N of one Gauss point of `W` elements side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxialUnknown<const W: usize> {
    /// N_0; in a Newton method's step that of the stage at hand, N.
    pub now: Lanes<W>,
    /// g_0.
    g: [Lanes<W>; 3],
    /// ∂Σ/∂r_p and c_a; dσ/dε, N.
    by_p: [Lanes<W>; 3],
    damping: Lanes<W>,
    ea: Lanes<W>,
    /// N_0 − Σ'·y_0, in Newton's method Σ_k − Σ'·y_k, N.
    offset: Lanes<W>,
    /// N where the step began, N.
    kept: Lanes<W>,
    /// N where the tangent was taken, N.
    pub origin: Lanes<W>,
    /// Σ_j − N_j, N.
    gaps: [Lanes<W>; MOST_STAGES],
    /// Σ_{j<i} a_ij (Σ_j − N_j) of the stage at hand, N.
    drift: Lanes<W>,
}

impl<const W: usize> AxialUnknown<W> {
    /// Before any step.
    pub const NONE: Self = Self {
        now: Lanes::ZERO,
        g: [Lanes::ZERO; 3],
        by_p: [Lanes::ZERO; 3],
        damping: Lanes::ZERO,
        ea: Lanes::ZERO,
        offset: Lanes::ZERO,
        kept: Lanes::ZERO,
        origin: Lanes::ZERO,
        gaps: [Lanes::ZERO; MOST_STAGES],
        drift: Lanes::ZERO,
    };

    /// A step begins with element `l` in the shape `s`, where the law gives `r`: with N = Σ if `anew` is 1, as it is if 0.
    #[inline(always)]
    pub fn begin(&mut self, l: usize, r: &Resistance, s: &Strains, anew: f64) {
        let now = anew * r.axial + (1.0 - anew) * self.now.0[l];
        self.now.0[l] = now;
        self.origin.0[l] = now;
        self.gaps[0].0[l] = r.axial - now;
        set_lane(&mut self.g, l, r.g);
        set_lane(&mut self.by_p, l, r.by_p);
        self.damping.0[l] = r.c_axial;
        self.ea.0[l] = r.ea;
        self.offset.0[l] = now - dot(&r.by_p, &s.p) - r.c_axial * dot(&r.g, &s.vp);
    }

    /// A stage begins, of these weights.
    #[inline(always)]
    pub fn enter(&mut self, weights: &[f64]) {
        self.drift = Lanes::ZERO;
        for (weight, gap) in weights.iter().zip(&self.gaps) {
            for l in 0..W {
                self.drift.0[l] += weight * gap.0[l];
            }
        }
    }

    /// Σ'·y, N.
    #[inline(always)]
    fn slope(&self, l: usize, s: &Strains) -> f64 {
        dot(&lane(&self.by_p, l), &s.p) + self.damping.0[l] * dot(&lane(&self.g, l), &s.vp)
    }

    /// N of element `l` at a stage.
    #[inline(always)]
    fn carried(&self, l: usize, s: &Strains) -> f64 {
        self.offset.0[l] + self.slope(l, s) + self.drift.0[l]
    }

    /// The force of element `l` at a stage, given that of the law, and its gap Σ_i − N_i.
    #[inline(always)]
    pub fn force(&self, l: usize, r: &Resistance, s: &Strains) -> (Vec3<f64>, f64) {
        let gap = self.same(l, r) * (r.axial - self.carried(l, s));
        (self.turned(l, r, gap), gap)
    }

    /// The gaps of a stage.
    #[inline(always)]
    pub fn remember(&mut self, stage: usize, gap: Lanes<W>) {
        self.gaps[stage] = gap;
    }

    /// 1, or 0 where the law has switched between taut and slack, so that its slope at the step's begin says nothing.
    #[inline(always)]
    fn same(&self, l: usize, r: &Resistance) -> f64 {
        if r.ea == self.ea.0[l] { 1.0 } else { 0.0 }
    }

    /// The law's force with a part of N, `gap`, along g_0.
    #[inline(always)]
    fn turned(&self, l: usize, r: &Resistance, gap: f64) -> Vec3<f64> {
        axpy(&axpy(&r.n, -gap, &r.g), gap, &lane(&self.g, l))
    }

    /// The force of element `l` at an iterate of Newton's method, given that of the law, and the next offset; `first` is 1 at a stage's first
    /// and 0 later.
    #[inline(always)]
    pub fn iterate(&self, l: usize, first: f64, r: &Resistance, s: &Strains) -> (Vec3<f64>, f64) {
        let slope = self.slope(l, s);
        let n = first * self.now.0[l] + (1.0 - first) * (self.offset.0[l] + slope);
        (self.turned(l, r, self.same(l, r) * (r.axial - n)), r.axial - slope)
    }

    /// The offsets of an iterate.
    #[inline(always)]
    pub fn shift(&mut self, offset: Lanes<W>) {
        self.offset = offset;
    }

    /// N of element `l` where Newton's method has ended in this shape.
    #[inline(always)]
    pub fn settled(&self, l: usize, s: &Strains) -> f64 {
        self.offset.0[l] + self.slope(l, s)
    }

    /// A step begins here.
    pub fn keep(&mut self) {
        self.kept = self.now;
    }

    /// As where the tangent was taken.
    pub fn back_to_origin(&mut self) {
        self.now = self.origin;
    }

    /// The step is tried again.
    pub fn rewind(&mut self) {
        self.now = self.kept;
    }

    /// N at the step's end with element `l` in the shape `s`, where the law gives `r`; its weights were entered as a stage's.
    #[inline(always)]
    pub fn end(&self, l: usize, r: &Resistance, s: &Strains) -> f64 {
        if r.ea == self.ea.0[l] && r.ea > 0.0 { self.carried(l, s) } else { r.axial }
    }
}
