//! The complex counterpart of [`Bordered`](super::Bordered), for methods whose stages do not separate in real numbers. Plain code: such a method
//! is a reference, not a fast one.

use super::{BLOCK, Block, BlockTridiagonal, SingularBlock};
use nalgebra::{Complex, SMatrix, SVector};

type Number = Complex<f64>;
type Square = SMatrix<Number, BLOCK, BLOCK>;

/// A complex block-tridiagonal matrix with a few bordering rows and columns, and its factors.
#[derive(Clone, Debug, Default)]
pub struct ComplexBordered {
    /// The matrix's real and imaginary part, to be filled before `factor`.
    pub parts: [BlockTridiagonal; 2],
    at: Vec<usize>,
    /// c_k, then A⁻¹ c_k.
    columns: Vec<Vec<Number>>,
    /// r_k.
    rows: Vec<Vec<Number>>,
    /// Inverses of the pivots D, and D⁻¹U.
    inverses: Vec<Square>,
    uppers: Vec<Square>,
    /// The bordering unknowns' own equations and their solution.
    small: Vec<Number>,
    scratch: Vec<Number>,
}

fn whole(re: &Block, im: &Block) -> Square {
    Square::from_fn(|r, c| Complex::new(re[r][c], im[r][c]))
}

impl ComplexBordered {
    /// All zero, `n` block rows, a border for each of the unknowns `at`.
    pub fn zeros(n: usize, at: &[usize]) -> Self {
        let full = || vec![vec![Complex::new(0.0, 0.0); BLOCK * n]; at.len()];
        Self {
            parts: [BlockTridiagonal::zeros(n), BlockTridiagonal::zeros(n)],
            at: at.to_vec(),
            columns: full(),
            rows: full(),
            inverses: vec![Square::zeros(); n],
            uppers: vec![Square::zeros(); n],
            small: vec![Complex::new(0.0, 0.0); at.len() * at.len()],
            scratch: vec![Complex::new(0.0, 0.0); at.len()],
        }
    }

    /// The `k`-th border's column and row, to be filled before `factor`.
    pub fn border(&mut self, k: usize) -> (&mut [Number], &mut [Number]) {
        (&mut self.columns[k], &mut self.rows[k])
    }

    /// Factors the matrix.
    ///
    /// # Errors
    /// [`SingularBlock`] names the block row.
    pub fn factor(&mut self) -> Result<(), SingularBlock> {
        let [re, im] = &self.parts;
        for i in 0..re.len() {
            let mut pivot = whole(&re.diagonal[i], &im.diagonal[i]);
            if i > 0 {
                pivot -= whole(&re.lower[i], &im.lower[i]) * self.uppers[i - 1];
            }
            let inverse = pivot.try_inverse().filter(|m| m.iter().all(|x| x.is_finite())).ok_or(SingularBlock { row: i })?;
            self.uppers[i] = inverse * whole(&re.upper[i], &im.upper[i]);
            self.inverses[i] = inverse;
        }
        let n = self.at.len();
        for k in 0..n {
            let mut column = std::mem::take(&mut self.columns[k]);
            self.solve_core(&mut column);
            self.columns[k] = column;
        }
        // The borders stand outside the band and their diagonal in it: y_k = b_k + r_k·A⁻¹(…) over all, see `solve`.
        for k in 0..n {
            for l in 0..n {
                let product: Number = self.rows[k].iter().zip(&self.columns[l]).map(|(r, c)| r * c).sum();
                let own = if k == l { self.diagonal(self.at[k]) } else { Complex::new(0.0, 0.0) };
                self.small[k * n + l] = own - product;
            }
        }
        let at = &self.at;
        eliminate(n, &mut self.small).map_err(|k| SingularBlock { row: at[k] / BLOCK })
    }

    fn diagonal(&self, at: usize) -> Number {
        let (block, i) = (at / BLOCK, at % BLOCK);
        Complex::new(self.parts[0].diagonal[block][i][i], self.parts[1].diagonal[block][i][i])
    }

    /// Solves in place.
    pub fn solve(&mut self, b: &mut [Number]) {
        let n = self.at.len();
        for k in 0..n {
            self.scratch[k] = b[self.at[k]];
        }
        self.solve_core(b);
        for k in 0..n {
            let row: Number = self.rows[k].iter().zip(b.iter()).map(|(r, x)| r * x).sum();
            self.scratch[k] -= row;
        }
        for k in 0..n {
            let y: Number = (0..n).map(|l| self.small[k * n + l] * self.scratch[l]).sum();
            for (x, c) in b.iter_mut().zip(&self.columns[k]) {
                *x -= y * c;
            }
            b[self.at[k]] = y;
        }
    }

    /// Without the borders.
    fn solve_core(&self, b: &mut [Number]) {
        let part = |b: &[Number], i: usize| SVector::<Number, BLOCK>::from_column_slice(&b[BLOCK * i..BLOCK * (i + 1)]);
        let [re, im] = &self.parts;
        let n = re.len();
        for i in 0..n {
            let mut x = part(b, i);
            if i > 0 {
                x -= whole(&re.lower[i], &im.lower[i]) * part(b, i - 1);
            }
            b[BLOCK * i..BLOCK * (i + 1)].copy_from_slice((self.inverses[i] * x).as_slice());
        }
        for i in (1..n).rev() {
            let x = part(b, i - 1) - self.uppers[i - 1] * part(b, i);
            b[BLOCK * (i - 1)..BLOCK * i].copy_from_slice(x.as_slice());
        }
    }
}

/// Inverse in place by Gauss and Jordan's elimination.
///
/// # Errors
/// The row whose pivot vanishes or is not finite.
fn eliminate(n: usize, a: &mut [Number]) -> Result<(), usize> {
    for k in 0..n {
        let pivot = Complex::new(1.0, 0.0) / a[k * n + k];
        if !pivot.is_finite() {
            return Err(k);
        }
        a[k * n + k] = Complex::new(1.0, 0.0);
        for c in 0..n {
            a[k * n + c] *= pivot;
        }
        for r in (0..n).filter(|r| *r != k) {
            let f = std::mem::replace(&mut a[r * n + k], Complex::new(0.0, 0.0));
            for c in 0..n {
                let x = a[k * n + c];
                a[r * n + c] -= f * x;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::prelude::*;

    /// Against the real matrix of twice the size, [re, −im; im, re], by faer's dense LU.
    #[test]
    fn cross_solution_matches_faers_dense_lu() {
        let (n, at) = (5, [24, 25]);
        let size = BLOCK * n;
        let value =
            |r: usize, c: usize, k: usize| ((7 * r + 13 * c + 5 * k) as f64 * 0.7).sin() + if r == c { 9.0 - 5.0 * k as f64 } else { 0.0 };
        let is_border = |i: usize| at.contains(&i);
        let mut a = ComplexBordered::zeros(n, &at);
        let mut dense = faer::Mat::<f64>::zeros(2 * size, 2 * size);
        for r in 0..size {
            for c in 0..size {
                let near = (r / 6).abs_diff(c / 6) <= 1;
                let (re, im) = (value(r, c, 0), value(r, c, 1));
                if r == c || near && r < 24 && c < 24 {
                    a.parts[0].block(r / 6, c / 6)[r % 6][c % 6] = re;
                    a.parts[1].block(r / 6, c / 6)[r % 6][c % 6] = im;
                } else if is_border(r) && c < 24 {
                    a.border(r - 24).1[c] = Complex::new(re, im);
                } else if is_border(c) && r < 24 {
                    a.border(c - 24).0[r] = Complex::new(re, im);
                } else {
                    continue;
                }
                (dense[(r, c)], dense[(size + r, size + c)]) = (re, re);
                (dense[(r, size + c)], dense[(size + r, c)]) = (-im, im);
            }
        }
        let b: Vec<f64> = (0..2 * size).map(|i| (i as f64 * 0.3).cos()).collect();
        let oracle = dense.partial_piv_lu().solve(faer::Mat::from_fn(2 * size, 1, |r, _| b[r]));
        let mut x: Vec<Number> = (0..size).map(|i| Complex::new(b[i], b[size + i])).collect();
        a.factor().unwrap();
        a.solve(&mut x);
        for i in 0..size {
            let error = (x[i].re - oracle[(i, 0)]).abs().max((x[i].im - oracle[(size + i, 0)]).abs());
            assert!(error < 1e-12, "{i}: {} {} {}", x[i], oracle[(i, 0)], oracle[(size + i, 0)]); // condition number about 10
        }
    }

    #[test]
    fn exact_a_singular_pivot_is_reported_with_its_row() {
        let mut a = ComplexBordered::zeros(3, &[]);
        for i in [0, 2] {
            (0..6).for_each(|r| a.parts[1].diagonal[i][r][r] = 1.0);
        }
        assert_eq!(a.factor(), Err(SingularBlock { row: 1 }));
    }
}
