//! Radau IIA with three stages, order 5, L-stable, stiffly accurate (E. Hairer & G. Wanner, Solving Ordinary Differential Equations II, sections
//! IV.5 and IV.8), in the second-order form: the stages look for the accelerations a_i of
//!
//! ```text
//! 0 = F(t_i, u_i, w_i) − M(u_i) a_i,   w_i = w_0 + h Σ_j A_ij a_j,   u_i = u_0 + h c_i w_0 + h² Σ_j (A²)_ij a_j
//! ```
//!
//! by Newton's method with the tangent of the step's begin. With T⁻¹ A T = diag(γ, [α β; −β α]) and a = T b its corrections separate into a real
//! system of M + g D + g² K, g = hγ, and a complex one, g = h(α − iβ), for b_2 + i b_3.
//!
//! It is the built-in reference: an independent method of a higher order, not a fast one. Every step takes a new tangent, and the axial forces
//! are those of the law at every iterate.

#![allow(clippy::excessive_precision, reason = "the digits as they are published")]

use super::newton::{Outcome, Progress};
use super::vectors::dot;
use super::{Integrator, Problem, Trial};
use crate::linalg::{Bordered, ComplexBordered};
use crate::system::Matrices;
use nalgebra::Complex;

const ROOT: f64 = 2.449_489_742_783_178; // √6

/// c_i.
const NODES: [f64; 3] = [(4.0 - ROOT) / 10.0, (4.0 + ROOT) / 10.0, 1.0];
/// A_ij; its last row are the weights of the solution.
const A: [[f64; 3]; 3] = [
    [(88.0 - 7.0 * ROOT) / 360.0, (296.0 - 169.0 * ROOT) / 1800.0, (-2.0 + 3.0 * ROOT) / 225.0],
    [(296.0 + 169.0 * ROOT) / 1800.0, (88.0 + 7.0 * ROOT) / 360.0, (-2.0 - 3.0 * ROOT) / 225.0],
    [(16.0 - ROOT) / 36.0, (16.0 + ROOT) / 36.0, 1.0 / 9.0],
];
/// γ, α and β: the eigenvalues of A are γ and α ± iβ.
const GAMMA: f64 = 0.274_888_829_595_677_37;
const ALPHA: f64 = 0.162_555_585_202_161_32;
const BETA: f64 = 0.184_949_324_407_140_78;
/// T, of A's eigenvectors (the real one; real and imaginary part of the other), and its inverse.
const T: [[f64; 3]; 3] = [
    [0.094_438_762_488_975_241, -0.141_255_295_020_954_21, -0.030_029_194_105_147_424],
    [0.250_213_122_965_333_31, 0.204_129_352_293_799_93, 0.382_942_112_757_261_94],
    [1.0, 1.0, 0.0],
];
const INVERSE: [[f64; 3]; 3] = [
    [4.178_718_591_551_904_7, 0.327_682_820_761_062_39, 0.523_376_445_499_449_55],
    [-4.178_718_591_551_904_7, -0.327_682_820_761_062_39, 0.476_623_554_500_550_45],
    [-0.502_872_634_945_786_88, 2.571_926_949_855_605_4, -0.596_039_204_828_224_92],
];
/// The embedded formula of order 3 with the begin's derivative for γ h: ŷ − y = γ h f_0 + Σ e_i (y_i − y_0) (section IV.8, (8.19)).
const ESTIMATE: [f64; 3] = [GAMMA * (-13.0 - 7.0 * ROOT) / 3.0, GAMMA * (-13.0 + 7.0 * ROOT) / 3.0, -GAMMA / 3.0];

/// Newton's iterations: it starts from the begin's accelerations in all stages, and with one tangent for all of them.
const ITERATIONS: usize = 12;
/// Tolerable velocity error of a step per tension error asked for. With it P3 in fmu-tests/rust/methods.rs comes out twenty times better than
/// asked; with more the steps get hardly longer, since Newton's method then sets them.
const STRICTNESS: f64 = 0.3;

/// Work space.
#[derive(Clone, Debug)]
pub struct Radau5 {
    matrices: Matrices,
    real: Bordered,
    complex: ComplexBordered,
    /// u_i, w_i, a_i and the residuals there.
    u: [Vec<f64>; 3],
    w: [Vec<f64>; 3],
    a: [Vec<f64>; 3],
    residual: [Vec<f64>; 3],
    /// Of the real system and of the complex one.
    change: Vec<f64>,
    pair: Vec<Complex<f64>>,
    error: Vec<f64>,
    counts: [u64; 3],
}

impl Radau5 {
    /// Order of the solution.
    pub const ORDER: usize = 5;

    /// For `size` unknowns, of which those `at` are coupled beyond the band.
    pub fn new(size: usize, at: &[usize]) -> Self {
        let zeros = || vec![0.0; size];
        let three = || [zeros(), zeros(), zeros()];
        Self {
            matrices: Matrices::zeros(size / 6),
            real: Bordered::zeros(size / 6, at),
            complex: ComplexBordered::zeros(size / 6, at),
            u: three(),
            w: three(),
            a: three(),
            residual: three(),
            change: zeros(),
            pair: vec![Complex::new(0.0, 0.0); size],
            error: zeros(),
            counts: [0; 3],
        }
    }

    /// All stages' u and w from their accelerations.
    fn place(&mut self, h: f64, u0: &[f64], w0: &[f64]) {
        let Self { u, w, a, .. } = self;
        for i in 0..3 {
            let square: [f64; 3] = std::array::from_fn(|j| (0..3).map(|k| A[i][k] * A[k][j]).sum());
            for k in 0..u0.len() {
                let at = [a[0][k], a[1][k], a[2][k]];
                w[i][k] = w0[k] + h * dot(&A[i], &at);
                u[i][k] = u0[k] + h * (NODES[i] * w0[k] + h * dot(&square, &at));
            }
        }
    }

    /// One correction of all stages; its size in tolerable errors.
    fn correct<P: Problem>(&mut self, problem: &P, h: f64) -> f64 {
        let r = &self.residual;
        for k in 0..self.change.len() {
            let transformed: [f64; 3] = std::array::from_fn(|i| dot(&INVERSE[i], &[r[0][k], r[1][k], r[2][k]]));
            self.change[k] = transformed[0];
            self.pair[k] = Complex::new(transformed[1], transformed[2]);
        }
        self.real.solve(&mut self.change);
        self.complex.solve(&mut self.pair);
        let mut energy = 0.0;
        for k in 0..self.change.len() {
            let b = [self.change[k], self.pair[k].re, self.pair[k].im];
            for i in 0..3 {
                let change = dot(&T[i], &b);
                self.a[i][k] += change;
                // The energy of the change of (u, w), as far as it can be told without another product.
                energy += (change * r[i][k]).abs();
            }
        }
        problem.size_of((h * GAMMA).powi(2) * energy)
    }

    fn stages<P: Problem>(&mut self, problem: &mut P, t: f64, h: f64, from: [&[f64]; 3]) -> Outcome {
        for a in &mut self.a {
            a.copy_from_slice(from[2]);
        }
        let mut progress = Progress::new(0.0).of_most(ITERATIONS);
        loop {
            self.place(h, from[0], from[1]);
            for i in 0..3 {
                problem.force(t + NODES[i] * h, &self.u[i], &self.w[i], Some(&self.a[i]), &mut self.residual[i]);
            }
            self.counts[0] += 3;
            let size = self.correct(problem, h);
            if let Some(outcome) = progress.judge(size) {
                self.place(h, from[0], from[1]);
                return outcome;
            }
        }
    }
}

impl Integrator for Radau5 {
    fn estimate_order(&self) -> usize {
        4
    }

    /// By the same rule as that of [`super::Tableau::strictness`]: errors of steps, h⁴, of which the run's are h⁵.
    fn strictness(&self, relative: f64) -> f64 {
        STRICTNESS * relative.powf(4.0 / Self::ORDER as f64 - 1.0)
    }

    fn begin<P: Problem>(&mut self, problem: &mut P, t: f64, from: [&[f64]; 3], force: &mut [f64]) {
        problem.force(t, from[0], from[1], None, force);
    }

    fn attempt<P: Problem>(&mut self, problem: &mut P, t: f64, h: f64, from: [&[f64]; 3], _: &[f64]) -> Trial {
        problem.linearize(t, from[0], from[1], from[2], &mut self.matrices, &mut self.change);
        self.matrices.combine(h * GAMMA, &mut self.real);
        self.matrices.combine_complex([h * ALPHA, -h * BETA], &mut self.complex);
        self.counts[1] += 1;
        self.counts[2] += 2;
        if let Err(e) = self.real.factor().and_then(|()| self.complex.factor()) {
            return Trial::Singular(e.row);
        }
        match self.stages(problem, t, h, from) {
            Outcome::Converged => {}
            Outcome::Stalled => return Trial::Stalled,
            Outcome::NotFinite => return Trial::Error(f64::NAN),
        }
        // (I − γ h J)⁻¹ (ŷ − y), whose velocities e solve (M + g D + g² K) e = M δw − g K δu.
        let g = h * GAMMA;
        let Self { u, w, change, residual: [du, dw, _], .. } = self;
        for k in 0..du.len() {
            let z = |x: &[Vec<f64>; 3], x0: &[f64]| dot(&ESTIMATE, &[x[0][k] - x0[k], x[1][k] - x0[k], x[2][k] - x0[k]]);
            du[k] = g * from[1][k] + z(u, from[0]);
            dw[k] = g * from[2][k] + z(w, from[1]);
        }
        self.error.fill(0.0);
        self.matrices.multiply_add([Some((1.0, dw)), None, Some((-g, du))], &mut self.error);
        self.real.solve(&mut self.error);
        change.fill(0.0);
        self.matrices.multiply_add([Some((1.0, &self.error)), None, None], change);
        Trial::Error(problem.error_size(&self.error, change))
    }

    fn state(&self) -> [&[f64]; 3] {
        [&self.u[2], &self.w[2], &self.a[2]]
    }

    fn error(&self) -> &[f64] {
        &self.error
    }

    fn accept<P: Problem>(&self, problem: &mut P) {
        problem.adopt(&self.u[2], &self.w[2]);
    }

    fn forget(&mut self) {}

    fn visit(&mut self, _: &mut dyn FnMut(&mut [f64])) {}

    fn retake<P: Problem>(&mut self, _: &mut P) {}

    fn carries_over(&self) -> bool {
        true
    }

    fn counts(&self) -> [u64; 3] {
        self.counts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Σ_j A_ij c_j^(k−1) = c_i^k / k for k to 3 (collocation), Σ b_j c_j^(k−1) = 1/k for k to 5, and what A is in T's axes.
    #[test]
    fn exact_coefficients() {
        let moment = |row: &[f64; 3], k: i32| (0..3).map(|j| row[j] * NODES[j].powi(k - 1)).sum::<f64>();
        for k in 1..=3 {
            for i in 0..3 {
                assert!((moment(&A[i], k) - NODES[i].powi(k) / f64::from(k)).abs() < 1e-15, "row {i}, {k}");
            }
        }
        for k in 1..=5 {
            assert!((moment(&A[2], k) - 1.0 / f64::from(k)).abs() < 1e-15, "{k}");
        }
        let product = |a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]| -> [[f64; 3]; 3] {
            std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
        };
        let found = product(&INVERSE, &product(&A, &T));
        let wanted = [[GAMMA, 0.0, 0.0], [0.0, ALPHA, BETA], [0.0, -BETA, ALPHA]];
        for i in 0..3 {
            for j in 0..3 {
                assert!((found[i][j] - wanted[i][j]).abs() < 1e-14, "{i} {j}: {}", found[i][j]);
            }
        }
        // ŷ − y on y = t^k: γ [k = 1] + Σ e_i c_i^k vanishes for k = 1 to 3, the companion's order.
        for k in 1..=3 {
            let sum: f64 = (0..3).map(|i| ESTIMATE[i] * NODES[i].powi(k)).sum::<f64>() + if k == 1 { GAMMA } else { 0.0 };
            assert!(sum.abs() < 1e-14, "{k}: {sum}");
        }
    }
}
