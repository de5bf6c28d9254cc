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

use super::{MOST_STAGES, Problem, Stage, Trial};
use crate::linalg::{Bordered, Columns};
use crate::math::lanes::{Kernel, widest};
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
#[derive(Clone, Debug, Default)]
pub struct Rodas4 {
    factors: Bordered,
    /// K and M for the stages' products.
    stiffness: Columns,
    mass: Columns,
    /// P_i, W_i, A_i.
    p: Vec<Vec<f64>>,
    w: Vec<Vec<f64>>,
    a: Vec<Vec<f64>>,
    rhs: Vec<f64>,
    rate: Vec<f64>,
    shift: Vec<f64>,
    scratch: Vec<f64>,
    stage: [Vec<f64>; 3],
}

impl Rodas4 {
    /// Order of the solution.
    pub const ORDER: usize = 4;
    /// Of the increments in the solution.
    pub const WEIGHTS: &[f64] = &WEIGHTS;
    /// Order of the error estimate plus one: error ~ h^this.
    pub const ESTIMATE_ORDER: usize = 4;

    /// For `size` unknowns, of which those `at` are coupled beyond the band.
    pub fn new(size: usize, at: &[usize]) -> Self {
        let zeros = || vec![vec![0.0; size]; STAGES];
        Self {
            factors: Bordered::zeros(size / 6, at),
            stiffness: Columns::zeros(size / 6),
            mass: Columns::zeros(size / 6),
            p: zeros(),
            w: zeros(),
            a: zeros(),
            rhs: vec![0.0; size],
            rate: vec![0.0; size],
            shift: vec![0.0; size],
            scratch: vec![0.0; size],
            stage: std::array::from_fn(|_| vec![0.0; size]),
        }
    }

    /// Tries a step of `h` from (t, u, w, a); `m` and `force` are the linearization there. The new state is in `state()` afterwards.
    pub fn attempt<P: Problem>(&mut self, problem: &mut P, t: f64, h: f64, from: [&[f64]; 3], m: &Matrices, force: &[f64]) -> Trial {
        let g = GAMMA * h;
        let (u0, w0, a0) = (from[0], from[1], from[2]);
        self.factors.core.combine(&m.mass, &m.damping, &m.stiffness, g);
        for (k, coupling) in m.couplings.iter().enumerate() {
            let (column, row) = self.factors.border(k);
            blend(column, None, g, &[1.0], std::slice::from_ref(&coupling.damping_column));
            blend(row, Some(&coupling.damping_row), 1.0, &[g], std::slice::from_ref(&coupling.stiffness_row));
            row.iter_mut().for_each(|x| *x *= g);
        }
        if let Err(e) = self.factors.factor() {
            return Trial::Singular(e.row);
        }
        self.stiffness.take(&m.stiffness);
        self.mass.take(&m.mass);
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
            // s_i, then −g K s_i.
            blend(&mut self.shift, Some(&self.stage[1]), 1.0 / h, C[i], &self.p);
            blend(&mut self.scratch, None, 1.0 / h, C[i], &self.w);
            self.stiffness.multiply_add(-g, &self.shift, &mut self.rhs);
            for coupling in &m.couplings {
                let product: f64 = coupling.stiffness_row.iter().zip(&self.shift).map(|(k, s)| k * s).sum();
                self.rhs[coupling.at] -= g * product;
            }
            // M (Σ c_ij W_j / h + a_i).
            if varies {
                add(&mut self.scratch, 1.0, &self.stage[2]);
            }
            if i > 0 {
                self.mass.multiply_add(1.0, &self.scratch, &mut self.rhs);
            }
            let w = &mut self.w[i];
            for (w, r) in w.iter_mut().zip(&self.rhs) {
                *w = g * r;
            }
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
        self.mass.multiply_add(1.0, &self.w[STAGES - 1], &mut self.scratch);
        let finite = self.stage[0].iter().chain(&self.stage[1]).all(|x| x.is_finite());
        Trial::Error(if finite { problem.error_size(&self.w[STAGES - 1], &self.scratch) } else { f64::NAN })
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

    /// u, w, a after a successful attempt (a only where M varies).
    pub fn state(&self) -> [&[f64]; 3] {
        [&self.stage[0], &self.stage[1], &self.stage[2]]
    }

    /// The velocity error estimate of the last attempt.
    pub fn error(&self) -> &[f64] {
        &self.w[STAGES - 1]
    }
}

/// out = base + s Σ c_j v_j.
fn blend(out: &mut [f64], base: Option<&[f64]>, s: f64, c: &[f64], v: &[Vec<f64>]) {
    widest(Blend { out, base, s, c, v });
}

struct Blend<'a> {
    out: &'a mut [f64],
    base: Option<&'a [f64]>,
    s: f64,
    c: &'a [f64],
    v: &'a [Vec<f64>],
}

impl Kernel for Blend<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { out, base, s, c, v } = self;
        match base {
            Some(base) => out.copy_from_slice(base),
            None => out.fill(0.0),
        }
        let n = out.len();
        let mut j = 0;
        while j + 1 < c.len() {
            let (c0, c1, v0, v1) = (s * c[j], s * c[j + 1], &v[j][..n], &v[j + 1][..n]);
            for k in 0..n {
                out[k] += c0 * v0[k] + c1 * v1[k];
            }
            j += 2;
        }
        if j < c.len() {
            let (c0, v0) = (s * c[j], &v[j][..n]);
            for k in 0..n {
                out[k] += c0 * v0[k];
            }
        }
    }
}

/// y += s x.
fn add(y: &mut [f64], s: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += s * x;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (1 + u²) ü = −4u − 0.3u̇ − u³ + cos 3t + …, one node whose six unknowns are the same oscillator six times, the forcing chosen so that
    /// u = sin t + 0.2 solves it exactly.
    struct Oscillator {
        varying: bool,
    }

    impl Oscillator {
        fn exact(t: f64) -> [f64; 3] {
            [t.sin() + 0.2, t.cos(), -t.sin()]
        }
        fn mass(&self, u: f64) -> f64 {
            if self.varying { 1.0 + u * u } else { 1.5 }
        }
        fn spring(u: f64, w: f64) -> f64 {
            -4.0 * u - 0.3 * w - u * u * u - 0.2 * w * u
        }
        fn f(&self, t: f64, u: f64, w: f64) -> f64 {
            let [x, v, a] = Self::exact(t);
            Self::spring(u, w) + self.mass(x) * a - Self::spring(x, v)
        }
    }

    impl Problem for Oscillator {
        fn size(&self) -> usize {
            6
        }
        fn force(&mut self, t: f64, u: &[f64], w: &[f64], a: Option<&[f64]>, f: &mut [f64]) {
            for i in 0..6 {
                f[i] = self.f(t, u[i], w[i]) - a.map_or(0.0, |a| self.mass(u[i]) * a[i]);
            }
        }
        fn stage_force(&mut self, _: Stage, t: f64, u: &[f64], w: &[f64], a: Option<&[f64]>, f: &mut [f64]) {
            self.force(t, u, w, a, f);
        }
        fn linearize(&mut self, t: f64, u: &[f64], w: &[f64], a: &[f64], m: &mut Matrices, f: &mut [f64]) {
            self.force(t, u, w, None, f);
            for i in 0..6 {
                m.mass.diagonal[0][i][i] = self.mass(u[i]);
                m.damping.diagonal[0][i][i] = 0.3 + 0.2 * u[i];
                let turn = if self.varying { 2.0 * u[i] * a[i] } else { 0.0 };
                m.stiffness.diagonal[0][i][i] = 4.0 + 3.0 * u[i] * u[i] + 0.2 * w[i] + turn;
            }
        }
        fn time_derivative(&mut self, t: f64, _: f64, u: &[f64], w: &[f64], force: &[f64], f: &mut [f64]) -> bool {
            let d = 1e-6;
            for i in 0..6 {
                f[i] = (self.f(t + d, u[i], w[i]) - force[i]) / d;
            }
            true
        }
        fn mass_varies(&self) -> bool {
            self.varying
        }
        fn error_size(&self, e: &[f64], _: &[f64]) -> f64 {
            e[0].abs()
        }
    }

    fn error(varying: bool, steps: usize) -> f64 {
        let mut problem = Oscillator { varying };
        let mut method = Rodas4::new(6, &[]);
        let mut m = Matrices::zeros(1);
        let mut f = vec![0.0; 6];
        let [x, v, a] = Oscillator::exact(0.0);
        let mut y = [vec![x; 6], vec![v; 6], vec![a; 6]];
        let h = 2.0 / steps as f64;
        for i in 0..steps {
            let t = i as f64 * h;
            problem.linearize(t, &y[0], &y[1], &y[2], &mut m, &mut f);
            assert!(matches!(method.attempt(&mut problem, t, h, [&y[0], &y[1], &y[2]], &m, &f), Trial::Error(e) if e.is_finite()));
            let new = method.state();
            y = [new[0].to_vec(), new[1].to_vec(), new[2].to_vec()];
        }
        let [x, v, a] = Oscillator::exact(2.0);
        let acceleration = if varying { (y[2][3] - a).abs() } else { 0.0 };
        (y[0][3] - x).abs().max((y[1][3] - v).abs()).max(acceleration)
    }

    #[test]
    fn exact_order_is_the_declared_one() {
        for varying in [false, true] {
            let (coarse, fine) = (error(varying, 20), error(varying, 40));
            let order = (coarse / fine).log2();
            assert!(order > Rodas4::ORDER as f64 - 0.3, "varying {varying}: order {order}, errors {coarse} {fine}");
        }
    }
}
