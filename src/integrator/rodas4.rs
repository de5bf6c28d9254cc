//! RODAS: a Rosenbrock method of order 4(3), six stages, L-stable, stiffly accurate (E. Hairer & G. Wanner, Solving Ordinary Differential
//! Equations II, 2nd ed., section IV.7 and VI.4; coefficients of their code RODAS).
//!
//! In the second-order form. With y = (u, w), stage increments (P_i, W_i), g = γh, s_i = w_i + Σ c_ij P_j / h:
//!
//! ```text
//! (M + g D + g² K) W_i = g [ F(t_i, u_i, w_i) + M Σ c_ij W_j / h + γ_i h ∂F/∂t − g K s_i ],   P_i = g (W_i + s_i)
//! ```
//!
//! Where M depends on u, the accelerations a join as algebraic unknowns of 0 = F − M(u) a; eliminating them leaves the same matrix and the
//! extra terms −(M(u_i) − M) a_i, with increments A_i = W_i/g − a_i − Σ c_ij W_j / h.

use super::vectors::{add, blend};
use super::{Integrator, MOST_STAGES, Problem, Stage, Trial};
use crate::linalg::Bordered;
use crate::system::Matrices;

const STAGES: usize = 6;
const _: () = assert!(STAGES <= MOST_STAGES);
const GAMMA: f64 = 0.25;
/// Stage times.
const ALPHA: [f64; STAGES] = [0.0, 0.386, 0.21, 0.63, 1.0, 1.0];
/// Factors of ∂F/∂t.
const GAMMA_I: [f64; STAGES] = [0.25, -0.1043, 0.1035, -0.036_200_000_000_000_23, 0.0, 0.0];
/// Stage values: y + Σ a_ij U_j.
static A: [&[f64]; STAGES] = [
    &[],
    &[1.544],
    &[0.946_678_528_081_582_6, 0.255_701_169_898_328_4],
    &[3.314_825_187_068_521, 2.896_124_015_972_201, 0.998_641_913_997_781_7],
    WEIGHTS.split_at(4).0,
    WEIGHTS.split_at(5).0,
];
/// The solution: y + Σ m_j U_j. The last two stages are its beginning.
static WEIGHTS: [f64; STAGES] = [1.221_224_509_226_641, 6.019_134_481_288_629, 12.537_083_329_320_87, -0.687_886_036_105_895, 1.0, 1.0];
/// Σ c_ij U_j / h.
const C: [&[f64]; STAGES] = [
    &[],
    &[-5.6688],
    &[-2.430_093_356_833_875, -0.206_359_915_709_191_5],
    &[-0.107_352_905_815_137_5, -9.594_562_251_023_355, -20.470_286_148_096_16],
    &[7.496_443_313_967_647, -10.246_804_314_641_7, -33.999_903_528_199_05, 11.708_908_932_061_6],
    &[8.083_246_795_921_522, -7.981_132_988_064_893, -31.521_594_328_743_71, 16.319_305_431_231_36, -6.058_818_238_834_054],
];

/// Work space and the factors of the present step.
#[derive(Clone, Debug)]
pub struct Rodas4 {
    /// Of M + g D + g² K.
    factors: Bordered,
    /// The tangent where the step begins.
    matrices: Matrices,
    /// P_i, W_i, A_i.
    p: Vec<Vec<f64>>,
    w: Vec<Vec<f64>>,
    a: Vec<Vec<f64>>,
    rhs: Vec<f64>,
    rate: Vec<f64>,
    shift: Vec<f64>,
    scratch: Vec<f64>,
    stage: [Vec<f64>; 3],
    /// Solves, tangents and factorizations so far.
    counts: [u64; 3],
}

impl Rodas4 {
    /// Order of the solution.
    pub const ORDER: usize = 4;

    /// For `size` unknowns, of which those `at` are coupled beyond the band.
    pub fn new(size: usize, at: &[usize]) -> Self {
        let zeros = || vec![vec![0.0; size]; STAGES];
        Self {
            factors: Bordered::zeros(size / 6, at),
            matrices: Matrices::zeros(size / 6),
            p: zeros(),
            w: zeros(),
            a: zeros(),
            rhs: vec![0.0; size],
            rate: vec![0.0; size],
            shift: vec![0.0; size],
            scratch: vec![0.0; size],
            stage: std::array::from_fn(|_| vec![0.0; size]),
            counts: [0; 3],
        }
    }

    fn stage_values(&mut self, i: usize, u0: &[f64], w0: &[f64], a0: &[f64], varies: bool) {
        let [u, w, a] = &mut self.stage;
        if i + 1 == STAGES {
            // The last row of a_ij is the one before it and a one.
            add(u, 1.0, &self.p[i - 1]);
            add(w, 1.0, &self.w[i - 1]);
            if varies {
                add(a, 1.0, &self.a[i - 1]);
            }
            return;
        }
        blend(u, Some(u0), 1.0, A[i], &self.p);
        blend(w, Some(w0), 1.0, A[i], &self.w);
        if varies {
            blend(a, Some(a0), 1.0, A[i], &self.a);
        }
    }
}

impl Integrator for Rodas4 {
    fn estimate_order(&self) -> usize {
        4
    }

    fn strictness(&self, _: f64) -> f64 {
        1.5
    }

    fn begin<P: Problem>(&mut self, problem: &mut P, t: f64, from: [&[f64]; 3], force: &mut [f64]) {
        problem.linearize(t, from[0], from[1], from[2], &mut self.matrices, force);
        self.counts[1] += 1;
    }

    fn attempt<P: Problem>(&mut self, problem: &mut P, t: f64, h: f64, from: [&[f64]; 3], force: &[f64]) -> Trial {
        let g = GAMMA * h;
        let (u0, w0, a0) = (from[0], from[1], from[2]);
        self.counts[2] += 1;
        self.matrices.combine(g, &mut self.factors);
        if let Err(e) = self.factors.factor() {
            return Trial::Singular(e.row);
        }
        let varies = problem.mass_varies();
        let driven = problem.time_derivative(t, h, u0, w0, force, &mut self.rate);
        for i in 0..STAGES {
            self.stage_values(i, u0, w0, a0, varies);
            if i == 0 {
                self.rhs.copy_from_slice(force);
            } else {
                let a = varies.then_some(&self.stage[2][..]);
                let stage = Stage { index: i, weights: A[i] };
                problem.stage_force(stage, t + ALPHA[i] * h, &self.stage[0], &self.stage[1], a, &mut self.rhs);
            }
            if driven && GAMMA_I[i] != 0.0 {
                add(&mut self.rhs, GAMMA_I[i] * h, &self.rate);
            }
            // s_i, then M (Σ c_ij W_j / h + a_i) − g K s_i.
            blend(&mut self.shift, Some(&self.stage[1]), 1.0 / h, C[i], &self.p);
            blend(&mut self.scratch, None, 1.0 / h, C[i], &self.w);
            if varies {
                add(&mut self.scratch, 1.0, &self.stage[2]);
            }
            let inertia = (i > 0).then_some((1.0, &self.scratch[..]));
            self.matrices.multiply_add([inertia, None, Some((-g, &self.shift))], &mut self.rhs);
            let w = &mut self.w[i];
            for (w, r) in w.iter_mut().zip(&self.rhs) {
                *w = g * r;
            }
            self.counts[0] += 1;
            self.factors.solve(w);
            for ((p, w), s) in self.p[i].iter_mut().zip(&*w).zip(&self.shift) {
                *p = g * (w + s);
            }
            if varies {
                let by_g = 1.0 / g;
                for ((a, w), b) in self.a[i].iter_mut().zip(&*w).zip(&self.scratch) {
                    *a = w * by_g - b;
                }
            }
        }
        // y_new = last stage value + U_6; the error estimate is U_6.
        add(&mut self.stage[0], 1.0, &self.p[STAGES - 1]);
        add(&mut self.stage[1], 1.0, &self.w[STAGES - 1]);
        if varies {
            add(&mut self.stage[2], 1.0, &self.a[STAGES - 1]);
        }
        self.scratch.fill(0.0);
        self.matrices.multiply_add([Some((1.0, &self.w[STAGES - 1])), None, None], &mut self.scratch);
        let finite = self.stage[0].iter().chain(&self.stage[1]).all(|x| x.is_finite());
        Trial::Error(if finite { problem.error_size(&self.w[STAGES - 1], &self.scratch) } else { f64::NAN })
    }

    fn state(&self) -> [&[f64]; 3] {
        [&self.stage[0], &self.stage[1], &self.stage[2]]
    }

    fn error(&self) -> &[f64] {
        &self.w[STAGES - 1]
    }

    fn accept<P: Problem>(&self, problem: &mut P) {
        problem.accept(&self.stage[0], &self.stage[1], &WEIGHTS);
    }

    fn forget(&mut self) {}

    fn visit(&mut self, _: &mut dyn FnMut(&mut [f64])) {}

    fn retake<P: Problem>(&mut self, _: &mut P) {}

    fn carries_over(&self) -> bool {
        false
    }

    fn counts(&self) -> [u64; 3] {
        self.counts
    }
}
