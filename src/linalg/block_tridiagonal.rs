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

    /// Sets a block row to zero.
    pub fn clear_row(&mut self, i: usize) {
        (self.lower[i], self.diagonal[i], self.upper[i]) = (ZERO, ZERO, ZERO);
    }

    /// The block at (i, j).
    ///
    /// # Panics
    /// Outside the band, |i − j| > 1.
    #[inline]
    pub fn block(&mut self, i: usize, j: usize) -> &mut Block {
        match j as isize - i as isize {
            -1 => &mut self.lower[i],
            0 => &mut self.diagonal[i],
            1 => &mut self.upper[i],
            _ => panic!("({i}, {j}) is outside the band"),
        }
    }

    /// y += s A x.
    pub fn multiply_add(&self, s: f64, x: &[f64], y: &mut [f64]) {
        let (x, y) = (x.as_chunks::<BLOCK>().0, y.as_chunks_mut::<BLOCK>().0);
        let none = [0.0; BLOCK];
        for i in 0..self.len() {
            let (before, after) = (if i > 0 { &x[i - 1] } else { &none }, x.get(i + 1).unwrap_or(&none));
            let (l, d, u) = (&self.lower[i], &self.diagonal[i], &self.upper[i]);
            for r in 0..BLOCK {
                y[i][r] += s * (0..BLOCK).map(|c| l[r][c] * before[c] + d[r][c] * x[i][c] + u[r][c] * after[c]).sum::<f64>();
            }
        }
    }

    /// Replaces the matrix A by factors of A = (D + L) (1 + D⁻¹U), block by block: `diagonal` by the transposed inverses of the pivots D,
    /// `lower` and `upper` by the transposes of D⁻¹L and D⁻¹U. So a solution is nothing but products, of which its chain from node to node
    /// holds one per node.
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

struct Elimination<'a>(&'a mut BlockTridiagonal);

impl Kernel for Elimination<'_> {
    type Output = Result<(), SingularBlock>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let BlockTridiagonal { lower, diagonal, upper } = self.0;
        // D⁻¹ (L | U), and (L | U).
        let (mut both, mut blocks) = ([[0.0; 2 * BLOCK]; BLOCK], [[0.0; 2 * BLOCK]; BLOCK]);
        for i in 0..diagonal.len() {
            let d = &mut diagonal[i];
            for r in 0..BLOCK {
                blocks[r][..BLOCK].copy_from_slice(&lower[i][r]);
                blocks[r][BLOCK..].copy_from_slice(&upper[i][r]);
            }
            if i > 0 {
                for r in 0..BLOCK {
                    let mut row = d[r];
                    for k in 0..BLOCK {
                        let f = blocks[r][k];
                        for c in 0..BLOCK {
                            row[c] -= f * both[k][BLOCK + c];
                        }
                    }
                    d[r] = row;
                }
            }
            invert(d).map_err(|()| SingularBlock { row: i })?;
            for r in 0..BLOCK {
                let mut row = [0.0; 2 * BLOCK];
                for k in 0..BLOCK {
                    let f = d[r][k];
                    for c in 0..2 * BLOCK {
                        row[c] += f * blocks[k][c];
                    }
                }
                both[r] = row;
            }
            let inverse = *d;
            for r in 0..BLOCK {
                for c in 0..BLOCK {
                    d[c][r] = inverse[r][c];
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
            let own = transposed_times(&factors.diagonal[i], &b[i]);
            b[i] = if i > 0 { difference(&own, &transposed_times(&factors.lower[i], &b[i - 1])) } else { own };
        }
        for i in (1..b.len()).rev() {
            b[i - 1] = difference(&b[i - 1], &transposed_times(&factors.upper[i - 1], &b[i]));
        }
    }
}

/// Aᵀ x.
#[inline(always)]
fn transposed_times(a: &Block, x: &[f64; BLOCK]) -> [f64; BLOCK] {
    let mut out = [0.0; BLOCK];
    for r in 0..BLOCK {
        // Three sums, so that none waits long for another.
        let (p, q, s) = (a[0][r] * x[0] + a[1][r] * x[1], a[2][r] * x[2] + a[3][r] * x[3], a[4][r] * x[4] + a[5][r] * x[5]);
        out[r] = (p + q) + s;
    }
    out
}

/// x − y.
#[inline(always)]
fn difference(x: &[f64; BLOCK], y: &[f64; BLOCK]) -> [f64; BLOCK] {
    std::array::from_fn(|r| x[r] - y[r])
}

/// Inverse in place by Gauss and Jordan's elimination.
#[inline(always)]
fn invert(a: &mut Block) -> Result<(), ()> {
    let mut x = *a;
    // Written out, since the compiler does not unroll a loop of this size; and judged at the end, so that nothing waits for it.
    let pivots = [eliminate::<0>(&mut x), eliminate::<1>(&mut x), eliminate::<2>(&mut x)];
    let more = [eliminate::<3>(&mut x), eliminate::<4>(&mut x), eliminate::<5>(&mut x)];
    *a = x;
    if pivots.iter().chain(&more).all(|p| p.is_finite()) { Ok(()) } else { Err(()) }
}

/// Step `K` of it; returns the pivot's reciprocal, which is not finite where the matrix is singular.
#[inline(always)]
fn eliminate<const K: usize>(a: &mut Block) -> f64 {
    let inverse = 1.0 / a[K][K];
    a[K][K] = 1.0;
    for c in 0..BLOCK {
        a[K][c] *= inverse;
    }
    let row = a[K];
    for r in 0..BLOCK {
        if r != K {
            let f = a[r][K];
            a[r][K] = 0.0;
            for c in 0..BLOCK {
                a[r][c] -= f * row[c];
            }
        }
    }
    inverse
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
