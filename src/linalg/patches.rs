//! A block-tridiagonal matrix of which few rows are anything but zero, so that clearing, adding and multiplying it costs no more than what is
//! in it. It is laid out for products: column by column, so that a product is a sum of columns and fills whole registers.

use super::{BLOCK, BlockTridiagonal};
use crate::math::lanes::{Kernel, widest};

/// Columns per block row.
const WIDTH: usize = 3 * BLOCK;

/// Blocks here and there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Patches {
    /// Per block row the columns of its three blocks; zero in all rows that are not used.
    rows: Vec<[[f64; BLOCK]; WIDTH]>,
    used: Vec<bool>,
}

impl Patches {
    /// All zero, `n` block rows.
    pub fn zeros(n: usize) -> Self {
        Self { rows: vec![[[0.0; BLOCK]; WIDTH]; n], used: vec![false; n] }
    }

    /// Sets all entries to zero.
    pub fn clear(&mut self) {
        for (row, used) in self.rows.iter_mut().zip(&mut self.used) {
            if std::mem::take(used) {
                *row = [[0.0; BLOCK]; WIDTH];
            }
        }
    }

    /// Adds `x` at (6 i + a, 6 j + b), |i − j| ≤ 1.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, a: usize, b: usize, x: f64) {
        self.used[i] = true;
        self.rows[i][BLOCK * (j + 1 - i) + b][a] += x;
    }

    /// Adds a matrix of the unknowns of block rows `e` and `e` + 1, so one of element `e`.
    #[inline]
    pub fn add_pair(&mut self, e: usize, m: &[[f64; 2 * BLOCK]; 2 * BLOCK]) {
        for c in 0..2 * BLOCK {
            self.add_pair_column(e, c, 1.0, &m.map(|row| row[c]));
        }
    }

    /// Adds s times column `c` of such a matrix.
    #[inline]
    pub fn add_pair_column(&mut self, e: usize, c: usize, s: f64, x: &[f64; 2 * BLOCK]) {
        for i in 0..2 {
            self.used[e + i] = true;
            let column = &mut self.rows[e + i][BLOCK * (1 - i) + c];
            for r in 0..BLOCK {
                column[r] += s * x[BLOCK * i + r];
            }
        }
    }

    /// out += s A.
    pub fn add_to(&self, s: f64, out: &mut BlockTridiagonal) {
        for (i, row) in self.used_rows() {
            let (columns, _) = row.as_chunks::<BLOCK>();
            for (block, columns) in [&mut out.lower[i], &mut out.diagonal[i], &mut out.upper[i]].into_iter().zip(columns) {
                for r in 0..BLOCK {
                    for c in 0..BLOCK {
                        block[r][c] += s * columns[c][r];
                    }
                }
            }
        }
    }

    /// y += s A x.
    pub fn multiply_add(&self, s: f64, x: &[f64], y: &mut [f64]) {
        widest(Product { of: self, s, x, y });
    }

    #[inline(always)]
    fn used_rows(&self) -> impl Iterator<Item = (usize, &[[f64; BLOCK]; WIDTH])> {
        self.rows.iter().enumerate().filter(|(i, _)| self.used[*i])
    }
}

struct Product<'a> {
    of: &'a Patches,
    s: f64,
    x: &'a [f64],
    y: &'a mut [f64],
}

impl Kernel for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { of, s, x, y } = self;
        let (x, y) = (x.as_chunks::<BLOCK>().0, y.as_chunks_mut::<BLOCK>().0);
        let none = [0.0; BLOCK];
        for (i, a) in of.used_rows() {
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
                y[i][r] += s * (sums[0][r] + sums[1][r] + sums[2][r]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_patches_are_the_matrix_that_was_put_into_them() {
        let n = 5;
        let (mut patches, mut plain) = (Patches::zeros(n), BlockTridiagonal::zeros(n));
        patches.add(0, 1, 1, 1, 9.0);
        patches.clear();
        assert_eq!(patches, Patches::zeros(n));
        let pair: [[f64; 12]; 12] = std::array::from_fn(|r| std::array::from_fn(|c| (7 * r + 5 * c) as f64));
        for e in [2, 3] {
            patches.add_pair(e, &pair);
            for (k, x) in pair.iter().flatten().enumerate() {
                let (r, c) = (k / 12, k % 12);
                plain.block(e + r / 6, e + c / 6)[r % 6][c % 6] += x;
            }
        }
        for (i, j) in [(1, 2), (2, 1)] {
            patches.add(i, j, 3, 4, 2.0);
            plain.block(i, j)[3][4] += 2.0;
        }
        let mut sum = BlockTridiagonal::zeros(n);
        patches.add_to(1.0, &mut sum);
        assert_eq!(sum, plain);
        let x: Vec<f64> = (0..6 * n).map(|k| k as f64).collect();
        let (mut a, mut b) = (vec![1.0; 6 * n], vec![1.0; 6 * n]);
        patches.multiply_add(-2.0, &x, &mut a);
        plain.multiply_add(-2.0, &x, &mut b);
        assert_eq!(a, b); // whole numbers
    }
}
