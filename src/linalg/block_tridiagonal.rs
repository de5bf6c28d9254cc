//! Storage, products and LU solution of a block-tridiagonal system (Golub & Van Loan, Matrix Computations, 4.5.1).

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
        let gg = g * g;
        let merge = |o: &mut [Block], m: &[Block], d: &[Block], k: &[Block]| {
            for (((o, m), d), k) in o.iter_mut().zip(m).zip(d).zip(k) {
                for r in 0..BLOCK {
                    for c in 0..BLOCK {
                        o[r][c] = m[r][c] + g * d[r][c] + gg * k[r][c];
                    }
                }
            }
        };
        merge(&mut self.lower, &m.lower, &d.lower, &k.lower);
        merge(&mut self.diagonal, &m.diagonal, &d.diagonal, &k.diagonal);
        merge(&mut self.upper, &m.upper, &d.upper, &k.upper);
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

    /// Replaces the matrix by its block LU factors: `lower` by L, `diagonal` by the LU factors of the pivots, `upper` unchanged.
    /// No pivoting: mass keeps the pivots away from zero at the step sizes in use, and a vanishing one is reported.
    ///
    /// # Errors
    /// [`SingularBlock`] names the block row; the content is then useless.
    pub fn factor(&mut self) -> Result<(), SingularBlock> {
        let n = self.len();
        for i in 0..n {
            if i > 0 {
                // L_i = lower_i D⁻¹_{i−1}, then D_i −= L_i upper_{i−1}.
                let (l, d) = (&mut self.lower[i], &self.diagonal[i - 1]);
                right_solve(d, l);
                let u = &self.upper[i - 1];
                let l = &self.lower[i];
                let d = &mut self.diagonal[i];
                for r in 0..BLOCK {
                    for k in 0..BLOCK {
                        let f = l[r][k];
                        for c in 0..BLOCK {
                            d[r][c] -= f * u[k][c];
                        }
                    }
                }
            }
            lu(&mut self.diagonal[i]).map_err(|()| SingularBlock { row: i })?;
        }
        Ok(())
    }

    /// Solves A x = b in place; `self` holds the factors.
    pub fn solve(&self, b: &mut [f64]) {
        let n = self.len();
        for i in 1..n {
            let (done, rest) = b.split_at_mut(BLOCK * i);
            let mut acc = [0.0; BLOCK];
            block_vec(&self.lower[i], &done[BLOCK * (i - 1)..], &mut acc);
            for (y, a) in rest[..BLOCK].iter_mut().zip(acc) {
                *y -= a;
            }
        }
        for i in (0..n).rev() {
            let (head, tail) = b.split_at_mut(BLOCK * (i + 1));
            let x = &mut head[BLOCK * i..];
            if i + 1 < n {
                let mut acc = [0.0; BLOCK];
                block_vec(&self.upper[i], &tail[..BLOCK], &mut acc);
                for (y, a) in x.iter_mut().zip(acc) {
                    *y -= a;
                }
            }
            lu_solve(&self.diagonal[i], x);
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

#[inline(always)]
fn lu_solve(a: &Block, x: &mut [f64]) {
    for r in 1..BLOCK {
        let mut s = x[r];
        for c in 0..r {
            s -= a[r][c] * x[c];
        }
        x[r] = s;
    }
    for r in (0..BLOCK).rev() {
        let mut s = x[r];
        for c in r + 1..BLOCK {
            s -= a[r][c] * x[c];
        }
        x[r] = s * a[r][r];
    }
}

/// l = l (LU)⁻¹, row by row: y U = l, then x L = y.
#[inline(always)]
fn right_solve(a: &Block, l: &mut Block) {
    for row in l.iter_mut() {
        for c in 0..BLOCK {
            let mut s = row[c];
            for k in 0..c {
                s -= row[k] * a[k][c];
            }
            row[c] = s * a[c][c];
        }
        for c in (0..BLOCK).rev() {
            let mut s = row[c];
            for k in c + 1..BLOCK {
                s -= row[k] * a[k][c];
            }
            row[c] = s;
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
