//! Storage, products and LU solution of a block-tridiagonal system (Golub & Van Loan, Matrix Computations, 4.5.1).

use crate::math::lanes::{Kernel, widest};

/// Unknowns per block.
pub const BLOCK: usize = 6;
/// A block, row major.
pub type Block = [[f64; BLOCK]; BLOCK];

const ZERO: Block = [[0.0; BLOCK]; BLOCK];

/// A block-tridiagonal matrix; row i holds `lower[i]` (column i−1), `diagonal[i]`, `upper[i]` (column i+1).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BlockTridiagonal {
    /// Column i − 1; `lower[0]` is unused.
    pub lower: Vec<Block>,
    /// Column i.
    pub diagonal: Vec<Block>,
    /// Column i + 1; the last is unused.
    pub upper: Vec<Block>,
}

/// A pivot vanished or was not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SingularBlock {
    /// The block row.
    pub row: usize,
}

impl BlockTridiagonal {
    /// All zero, `n` block rows.
    pub fn zeros(n: usize) -> Self {
        Self { lower: vec![ZERO; n], diagonal: vec![ZERO; n], upper: vec![ZERO; n] }
    }

    /// Number of block rows.
    pub fn len(&self) -> usize {
        self.diagonal.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.diagonal.is_empty()
    }

    /// Sets all entries to zero.
    pub fn clear(&mut self) {
        self.lower.fill(ZERO);
        self.diagonal.fill(ZERO);
        self.upper.fill(ZERO);
    }

    /// Adds `x` at (6 i + a, 6 j + b), |i − j| ≤ 1.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, a: usize, b: usize, x: f64) {
        let block = match j as isize - i as isize {
            -1 => &mut self.lower[i],
            0 => &mut self.diagonal[i],
            1 => &mut self.upper[i],
            _ => return debug_assert!(false, "outside the band"),
        };
        block[a][b] += x;
    }

    /// self = m + g d + g² k.
    pub fn combine(&mut self, m: &Self, d: &Self, k: &Self, g: f64) {
        for (o, [m, d, k]) in [
            (&mut self.lower, [&m.lower, &d.lower, &k.lower]),
            (&mut self.diagonal, [&m.diagonal, &d.diagonal, &k.diagonal]),
            (&mut self.upper, [&m.upper, &d.upper, &k.upper]),
        ] {
            widest(Combination { o, m, d, k, g });
        }
    }

    /// y += s A x.
    pub fn multiply_add(&self, s: f64, x: &[f64], y: &mut [f64]) {
        let n = self.len();
        for i in 0..n {
            let mut acc = [0.0; BLOCK];
            if i > 0 {
                block_vec(&self.lower[i], &x[BLOCK * (i - 1)..BLOCK * i], &mut acc);
            }
            block_vec(&self.diagonal[i], &x[BLOCK * i..BLOCK * (i + 1)], &mut acc);
            if i + 1 < n {
                block_vec(&self.upper[i], &x[BLOCK * (i + 1)..BLOCK * (i + 2)], &mut acc);
            }
            for (y, a) in y[BLOCK * i..BLOCK * (i + 1)].iter_mut().zip(acc) {
                *y += s * a;
            }
        }
    }

    /// Replaces the matrix A by factors of A = (D + L) (1 + D⁻¹U), block by block: `diagonal` by the LU factors of the pivots D,
    /// `lower` and `upper` by the transposes of D⁻¹L and D⁻¹U. So a solution's chain from node to node holds one product per node and no
    /// triangular solution.
    /// No pivoting: mass keeps the pivots away from zero at the step sizes in use, and a vanishing one is reported.
    ///
    /// # Errors
    /// [`SingularBlock`] names the block row; the content is then useless.
    pub fn factor(&mut self) -> Result<(), SingularBlock> {
        widest(Elimination(self))
    }

    /// Solves A x = b in place; `self` holds the factors.
    pub fn solve(&self, b: &mut [f64]) {
        widest(Substitution { factors: self, b });
    }
}

struct Combination<'a> {
    o: &'a mut [Block],
    m: &'a [Block],
    d: &'a [Block],
    k: &'a [Block],
    g: f64,
}

impl Kernel for Combination<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let (g, gg) = (self.g, self.g * self.g);
        let (m, d, k) = (self.m.as_flattened().as_flattened(), self.d.as_flattened().as_flattened(), self.k.as_flattened().as_flattened());
        let o = self.o.as_flattened_mut().as_flattened_mut();
        for (((o, m), d), k) in o.iter_mut().zip(m).zip(d).zip(k) {
            *o = m + g * d + gg * k;
        }
    }
}

struct Elimination<'a>(&'a mut BlockTridiagonal);

impl Kernel for Elimination<'_> {
    type Output = Result<(), SingularBlock>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let BlockTridiagonal { lower, diagonal, upper } = self.0;
        // D⁻¹ (L | U).
        let mut both = [[0.0; 2 * BLOCK]; BLOCK];
        for i in 0..diagonal.len() {
            let d = &mut diagonal[i];
            if i > 0 {
                let l = &lower[i];
                for r in 0..BLOCK {
                    let mut row = d[r];
                    for k in 0..BLOCK {
                        let f = l[r][k];
                        for c in 0..BLOCK {
                            row[c] -= f * both[k][BLOCK + c];
                        }
                    }
                    d[r] = row;
                }
            }
            lu(d).map_err(|()| SingularBlock { row: i })?;
            for r in 0..BLOCK {
                both[r][..BLOCK].copy_from_slice(&lower[i][r]);
                both[r][BLOCK..].copy_from_slice(&upper[i][r]);
            }
            lu_solve(d, &mut both);
            for r in 0..BLOCK {
                for c in 0..BLOCK {
                    lower[i][c][r] = both[r][c];
                    upper[i][c][r] = both[r][BLOCK + c];
                }
            }
        }
        Ok(())
    }
}

struct Substitution<'a> {
    factors: &'a BlockTridiagonal,
    b: &'a mut [f64],
}

impl Kernel for Substitution<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { factors, b } = self;
        let (b, _) = b.as_chunks_mut::<BLOCK>();
        for i in 0..b.len() {
            lu_solve(&factors.diagonal[i], b[i].as_chunks_mut::<1>().0);
            if i > 0 {
                b[i] = minus_product(&b[i], &factors.lower[i], &b[i - 1]);
            }
        }
        for i in (1..b.len()).rev() {
            b[i - 1] = minus_product(&b[i - 1], &factors.upper[i - 1], &b[i]);
        }
    }
}

/// y += A x.
#[inline(always)]
fn block_vec(a: &Block, x: &[f64], y: &mut [f64; BLOCK]) {
    for r in 0..BLOCK {
        let mut s = 0.0;
        for c in 0..BLOCK {
            s += a[r][c] * x[c];
        }
        y[r] += s;
    }
}

/// y − Aᵀ x.
#[inline(always)]
fn minus_product(y: &[f64; BLOCK], a: &Block, x: &[f64; BLOCK]) -> [f64; BLOCK] {
    let mut out = *y;
    for r in 0..BLOCK {
        let (p, q, s) = (a[0][r] * x[0] + a[1][r] * x[1], a[2][r] * x[2] + a[3][r] * x[3], a[4][r] * x[4] + a[5][r] * x[5]);
        out[r] -= (p + q) + s;
    }
    out
}

/// y −= f x.
#[inline(always)]
fn subtract<const N: usize>(y: &mut [f64; N], f: f64, x: &[f64; N]) {
    for c in 0..N {
        y[c] -= f * x[c];
    }
}

/// In place LU, unit lower triangle; the diagonal keeps the pivots' reciprocals.
#[inline(always)]
fn lu(a: &mut Block) -> Result<(), ()> {
    for k in 0..BLOCK {
        let p = a[k][k];
        let inverse = 1.0 / p;
        if !(inverse.is_finite() && p != 0.0) {
            return Err(());
        }
        a[k][k] = inverse;
        for r in k + 1..BLOCK {
            let f = a[r][k] * inverse;
            a[r][k] = f;
            for c in k + 1..BLOCK {
                a[r][c] -= f * a[k][c];
            }
        }
    }
    Ok(())
}

/// x = (LU)⁻¹ x of `N` right-hand sides.
#[inline(always)]
fn lu_solve<const N: usize>(a: &Block, x: &mut [[f64; N]]) {
    for r in 1..BLOCK {
        let mut y = x[r];
        for c in 0..r {
            subtract(&mut y, a[r][c], &x[c]);
        }
        x[r] = y;
    }
    for r in (0..BLOCK).rev() {
        let mut y = x[r];
        for c in r + 1..BLOCK {
            subtract(&mut y, a[r][c], &x[c]);
        }
        for c in 0..N {
            x[r][c] = y[c] * a[r][r];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::prelude::*;

    /// A reproducible, diagonally dominant, unsymmetric example.
    fn example(n: usize) -> BlockTridiagonal {
        let mut seed = 1u64;
        let mut random = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let mut a = BlockTridiagonal::zeros(n);
        for i in 0..n {
            for r in 0..BLOCK {
                for c in 0..BLOCK {
                    a.lower[i][r][c] = random();
                    a.upper[i][r][c] = random();
                    a.diagonal[i][r][c] = random() + if r == c { 8.0 } else { 0.0 };
                }
            }
        }
        a
    }

    #[test]
    fn cross_solution_matches_faers_dense_lu() {
        let n = 7;
        let a = example(n);
        let dense = faer::Mat::from_fn(6 * n, 6 * n, |r, c| match (c / 6) as isize - (r / 6) as isize {
            -1 => a.lower[r / 6][r % 6][c % 6],
            0 => a.diagonal[r / 6][r % 6][c % 6],
            1 => a.upper[r / 6][r % 6][c % 6],
            _ => 0.0,
        });
        let b: Vec<f64> = (0..6 * n).map(|i| (i as f64 * 0.7).sin()).collect();
        let oracle = dense.partial_piv_lu().solve(faer::Mat::from_fn(6 * n, 1, |r, _| b[r]));
        let mut x = b.clone();
        let mut f = a.clone();
        f.factor().unwrap();
        f.solve(&mut x);
        let mut residual = b.clone();
        a.multiply_add(-1.0, &x, &mut residual);
        for i in 0..6 * n {
            assert!((x[i] - oracle[(i, 0)]).abs() < 1e-13, "{i}"); // condition number about 10
            assert!(residual[i].abs() < 1e-13, "{i}");
        }
    }

    #[test]
    fn exact_singular_pivot_is_reported_with_its_row() {
        let mut a = example(4);
        a.upper[1] = [[0.0; 6]; 6];
        a.lower[2] = [[0.0; 6]; 6];
        a.diagonal[2] = [[0.0; 6]; 6];
        assert_eq!(a.factor(), Err(SingularBlock { row: 2 }));
    }
}
