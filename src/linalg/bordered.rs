//! A block-tridiagonal system in which a few unknowns are coupled with many others: borders (Golub & Van Loan, Matrix Computations, 2.1.4,
//! the block elimination behind the Sherman-Morrison-Woodbury formula).

use super::{BLOCK, BlockTridiagonal, SingularBlock};

/// Factors of A + Σ_k (c_k e_kᵀ + e_k r_kᵀ), where A holds nothing but a diagonal element in the rows and columns of the unknowns `at`, and
/// c_k and r_k vanish there.
#[derive(Clone, Debug, Default)]
pub struct Bordered {
    /// A, then its factors.
    pub core: BlockTridiagonal,
    at: Vec<usize>,
    /// c_k, then A⁻¹ c_k.
    columns: Vec<Vec<f64>>,
    /// r_k, then over its diagonal element.
    rows: Vec<Vec<f64>>,
    /// Inverse of 1 − r_k·A⁻¹c_l, row major.
    inverse: Vec<f64>,
    scratch: Vec<f64>,
}

impl Bordered {
    /// All zero, `n` block rows, a border for each of the unknowns `at`.
    pub fn zeros(n: usize, at: &[usize]) -> Self {
        let full = || vec![vec![0.0; BLOCK * n]; at.len()];
        Self {
            core: BlockTridiagonal::zeros(n),
            at: at.to_vec(),
            columns: full(),
            rows: full(),
            inverse: vec![0.0; at.len() * at.len()],
            scratch: vec![0.0; at.len()],
        }
    }

    /// The `k`-th border's column and row, to be filled before `factor`.
    pub fn border(&mut self, k: usize) -> (&mut [f64], &mut [f64]) {
        (&mut self.columns[k], &mut self.rows[k])
    }

    /// Replaces the matrix by its factors.
    ///
    /// # Errors
    /// [`SingularBlock`] names the block row; the content is then useless.
    pub fn factor(&mut self) -> Result<(), SingularBlock> {
        for (at, row) in self.at.iter().zip(&mut self.rows) {
            let inverse = 1.0 / self.core.diagonal[at / BLOCK][at % BLOCK][at % BLOCK];
            row.iter_mut().for_each(|x| *x *= inverse);
        }
        self.core.factor()?;
        let n = self.at.len();
        for k in 0..n {
            self.core.solve(&mut self.columns[k]);
        }
        for k in 0..n {
            for l in 0..n {
                self.inverse[k * n + l] = f64::from(u8::from(k == l)) - dot(&self.rows[k], &self.columns[l]);
            }
        }
        let at = &self.at;
        invert(n, &mut self.inverse).map_err(|k| SingularBlock { row: at[k] / BLOCK })
    }

    /// Solves in place; `self` holds the factors.
    pub fn solve(&mut self, b: &mut [f64]) {
        self.core.solve(b);
        let n = self.at.len();
        for (k, y) in self.scratch.iter_mut().enumerate() {
            *y = b[self.at[k]] - dot(&self.rows[k], b);
        }
        for k in 0..n {
            let y: f64 = (0..n).map(|l| self.inverse[k * n + l] * self.scratch[l]).sum();
            for (b, x) in b.iter_mut().zip(&self.columns[k]) {
                *b -= y * x;
            }
            b[self.at[k]] = y;
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Inverse in place by Gauss and Jordan's elimination, for a matrix near the identity in size and condition.
///
/// # Errors
/// The row whose pivot vanishes or is not finite.
fn invert(n: usize, a: &mut [f64]) -> Result<(), usize> {
    for k in 0..n {
        let pivot = 1.0 / a[k * n + k];
        if !pivot.is_finite() {
            return Err(k);
        }
        a[k * n + k] = 1.0;
        for c in 0..n {
            a[k * n + c] *= pivot;
        }
        for r in (0..n).filter(|r| *r != k) {
            let f = a[r * n + k];
            a[r * n + k] = 0.0;
            for c in 0..n {
                a[r * n + c] -= f * a[k * n + c];
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::prelude::*;

    #[test]
    fn cross_solution_matches_faers_dense_lu() {
        let (n, at) = (5, [24, 25, 26]);
        let value = |r: usize, c: usize| ((7 * r + 13 * c) as f64 * 0.7).sin() + if r == c { 9.0 } else { 0.0 };
        let is_border = |i: usize| at.contains(&i);
        let mut a = Bordered::zeros(n, &at);
        let mut dense = faer::Mat::<f64>::zeros(6 * n, 6 * n);
        for r in 0..6 * n {
            for c in 0..6 * n {
                let near = (r / 6).abs_diff(c / 6) <= 1;
                let mut put = |x: f64| dense[(r, c)] = x;
                if r == c || near && !is_border(r) && !is_border(c) && r < 24 && c < 24 {
                    a.core.block(r / 6, c / 6)[r % 6][c % 6] += value(r, c);
                    put(value(r, c));
                } else if is_border(r) && c < 24 {
                    a.border(r - 24).1[c] = value(r, c);
                    put(value(r, c));
                } else if is_border(c) && r < 24 {
                    a.border(c - 24).0[r] = value(r, c);
                    put(value(r, c));
                }
            }
        }
        let b: Vec<f64> = (0..6 * n).map(|i| (i as f64 * 0.3).cos()).collect();
        let oracle = dense.partial_piv_lu().solve(faer::Mat::from_fn(6 * n, 1, |r, _| b[r]));
        let mut x = b;
        a.factor().unwrap();
        a.solve(&mut x);
        for i in 0..6 * n {
            assert!((x[i] - oracle[(i, 0)]).abs() < 1e-12, "{i}: {} {}", x[i], oracle[(i, 0)]); // condition number about 10
        }
    }

    #[test]
    fn exact_a_singular_border_names_its_block_row() {
        // x₀ + x₆ = 0 and x₀ + x₆ = 0 again, beside a unit matrix; with 2 x₀ in the second it can be solved.
        for (row, singular) in [(1.0, true), (2.0, false)] {
            let mut a = Bordered::zeros(2, &[6]);
            (0..12).for_each(|i| a.core.block(i / 6, i / 6)[i % 6][i % 6] += 1.0);
            a.border(0).0[0] = 1.0;
            a.border(0).1[0] = row;
            assert_eq!(a.factor().map_err(|e| e.row), if singular { Err(1) } else { Ok(()) });
            if !singular {
                let mut x = [3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0];
                a.solve(&mut x);
                assert_eq!((x[0], x[6]), (1.0, 2.0)); // 1 + 2 = 3, 2 · 1 + 2 = 4
            }
        }
    }
}
