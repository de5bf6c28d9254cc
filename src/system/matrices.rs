//! M, D, K of the linearized system and how element contributions enter them.

use crate::linalg::{BlockTridiagonal, Bordered};
use crate::math::lanes::Mat3;

/// Derivatives of G = F(t, u, w) − M(u) a: M = −∂G/∂a, D = −∂G/∂w, K = −∂G/∂u.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Matrices {
    /// kg.
    pub mass: BlockTridiagonal,
    /// N·s/m.
    pub damping: BlockTridiagonal,
    /// N/m.
    pub stiffness: BlockTridiagonal,
    /// What couples single unknowns with all others.
    pub couplings: Vec<Coupling>,
}

/// Entries of D and K that couple one unknown with the cable's.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coupling {
    /// Its place.
    pub at: usize,
    /// Its column of D.
    pub damping_column: Vec<f64>,
    /// Its row of D.
    pub damping_row: Vec<f64>,
    /// Its row of K.
    pub stiffness_row: Vec<f64>,
}

impl Matrices {
    /// All zero, for `n` nodes.
    pub fn zeros(n: usize) -> Self {
        Self {
            mass: BlockTridiagonal::zeros(n),
            damping: BlockTridiagonal::zeros(n),
            stiffness: BlockTridiagonal::zeros(n),
            couplings: vec![],
        }
    }

    /// Sets all entries to zero, with couplings of the unknowns `at`.
    pub fn clear(&mut self, at: impl ExactSizeIterator<Item = usize>) {
        for b in [&mut self.mass, &mut self.damping, &mut self.stiffness] {
            b.clear();
        }
        let n = 6 * self.mass.len();
        self.couplings.resize_with(at.len(), Coupling::default);
        for (c, at) in self.couplings.iter_mut().zip(at) {
            c.at = at;
            for x in [&mut c.damping_column, &mut c.damping_row, &mut c.stiffness_row] {
                x.clear();
                x.resize(n, 0.0);
            }
        }
    }
}

impl Matrices {
    /// M + g D + g² K.
    pub fn combine(&self, g: f64, into: &mut Bordered) {
        into.core.combine(&self.mass, &self.damping, &self.stiffness, g);
        for (k, coupling) in self.couplings.iter().enumerate() {
            let (column, row) = into.border(k);
            for i in 0..column.len() {
                column[i] = g * coupling.damping_column[i];
                row[i] = g * (coupling.damping_row[i] + g * coupling.stiffness_row[i]);
            }
        }
    }

    /// f −= D w + K u.
    pub fn resist(&self, u: &[f64], w: &[f64], f: &mut [f64]) {
        self.damping.multiply_add(-1.0, w, f);
        self.stiffness.multiply_add(-1.0, u, f);
        for coupling in &self.couplings {
            let times = |row: &[f64], x: &[f64]| row.iter().zip(x).map(|(r, x)| r * x).sum::<f64>();
            f[coupling.at] -= times(&coupling.damping_row, w) + times(&coupling.stiffness_row, u);
            for (f, c) in f.iter_mut().zip(&coupling.damping_column) {
                *f -= c * w[coupling.at];
            }
        }
    }
}

/// m −= Σ_ij row_i col_j b over the 12×12 of element `e`.
#[inline(always)]
pub fn subtract_outer(m: &mut BlockTridiagonal, e: usize, row: &[f64; 4], col: &[f64; 4], b: &Mat3<f64>) {
    for i in 0..4 {
        for j in 0..4 {
            let f = row[i] * col[j];
            let block = element_block(m, e, i, j);
            for r in 0..3 {
                for c in 0..3 {
                    block[3 * (i % 2) + r][3 * (j % 2) + c] -= f * b[r][c];
                }
            }
        }
    }
}

/// The 6×6 block that couples slots `i` and `j` (0: r(0), 1: r_p(0), 2: r(L), 3: r_p(L)) of element `e`.
#[inline(always)]
pub fn element_block(m: &mut BlockTridiagonal, e: usize, i: usize, j: usize) -> &mut crate::linalg::Block {
    match (i / 2, j / 2) {
        (0, 0) => &mut m.diagonal[e],
        (0, 1) => &mut m.upper[e],
        (1, 0) => &mut m.lower[e + 1],
        _ => &mut m.diagonal[e + 1],
    }
}
