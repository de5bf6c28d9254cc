//! A block-tridiagonal matrix laid out for products: column by column, so that a product is a sum of columns and fills whole registers.

use super::{BLOCK, BlockTridiagonal};
use crate::math::lanes::{Kernel, widest};

/// Columns per block row.
const WIDTH: usize = 3 * BLOCK;

/// A copy for many products with the same matrix.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns {
    /// Per block row the columns of its three blocks; zero beyond the ends.
    rows: Vec<[[f64; BLOCK]; WIDTH]>,
}

impl Columns {
    /// All zero, `n` block rows.
    pub fn zeros(n: usize) -> Self {
        Self { rows: vec![[[0.0; BLOCK]; WIDTH]; n] }
    }

    /// Takes over a matrix of the same size.
    pub fn take(&mut self, a: &BlockTridiagonal) {
        let n = self.rows.len();
        for (i, row) in self.rows.iter_mut().enumerate() {
            for r in 0..BLOCK {
                for c in 0..BLOCK {
                    if i > 0 {
                        row[c][r] = a.lower[i][r][c];
                    }
                    row[BLOCK + c][r] = a.diagonal[i][r][c];
                    if i + 1 < n {
                        row[2 * BLOCK + c][r] = a.upper[i][r][c];
                    }
                }
            }
        }
    }

    /// y += s A x.
    pub fn multiply_add(&self, s: f64, x: &[f64], y: &mut [f64]) {
        widest(Product { a: &self.rows, s, x, y });
    }
}

struct Product<'a> {
    a: &'a [[[f64; BLOCK]; WIDTH]],
    s: f64,
    x: &'a [f64],
    y: &'a mut [f64],
}

impl Kernel for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { a, s, x, y } = self;
        let (x, y) = (x.as_chunks::<BLOCK>().0, y.as_chunks_mut::<BLOCK>().0);
        let none = [0.0; BLOCK];
        for (i, (a, y)) in a.iter().zip(y).enumerate() {
            let near = [if i > 0 { &x[i - 1] } else { &none }, &x[i], x.get(i + 1).unwrap_or(&none)];
            // Three sums, so that none waits for another.
            let mut sums = [[0.0; BLOCK]; 3];
            for c in 0..BLOCK {
                for b in 0..3 {
                    for r in 0..BLOCK {
                        sums[b][r] += a[BLOCK * b + c][r] * near[b][c];
                    }
                }
            }
            for r in 0..BLOCK {
                y[r] += s * (sums[0][r] + sums[1][r] + sums[2][r]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_product_is_that_of_the_rows() {
        let n = 4;
        let mut a = BlockTridiagonal::zeros(n);
        for i in 0..n {
            for r in 0..BLOCK {
                for c in 0..BLOCK {
                    let x = |k: usize| ((7 * i + 3 * r + 5 * c + 11 * k) as f64).sin();
                    // What the ends store beyond the matrix must not count.
                    (a.lower[i][r][c], a.diagonal[i][r][c], a.upper[i][r][c]) = (x(1), x(2), x(3));
                }
            }
        }
        let x: Vec<f64> = (0..6 * n).map(|k| (k as f64).cos()).collect();
        let (mut rows, mut columns) = (vec![1.0; 6 * n], vec![1.0; 6 * n]);
        let mut copy = Columns::zeros(n);
        copy.take(&a);
        a.multiply_add(-0.7, &x, &mut rows);
        copy.multiply_add(-0.7, &x, &mut columns);
        assert!(rows.iter().zip(&columns).all(|(a, b)| (a - b).abs() < 1e-14)); // rounding of 18 products
    }
}
