//! M, D, K of the linearized system and how contributions enter them.

use super::elements::{Each, ElementTangents};
use crate::linalg::{BlockTridiagonal, Bordered, ComplexBordered, Patches};
use crate::math::lanes::Mat3;
use nalgebra::Complex;

/// Derivatives of G = F(t, u, w) − M(u) a: M = −∂G/∂a, D = −∂G/∂w, K = −∂G/∂u; each the elements' share and what else there is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Matrices {
    /// The elements' own.
    pub elements: ElementTangents,
    /// What is added to M, kg.
    pub mass: Patches,
    /// To D, N·s/m.
    pub damping: Patches,
    /// To K, N/m.
    pub stiffness: Patches,
    /// What couples single unknowns with all others.
    pub couplings: Vec<Coupling>,
    /// Nodes whose positions are prescribed: their rows of M are rows of the identity, of D and K zero.
    pinned: Vec<usize>,
    nodes: usize,
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
            elements: ElementTangents::with_capacity(n),
            mass: Patches::zeros(n),
            damping: Patches::zeros(n),
            stiffness: Patches::zeros(n),
            couplings: vec![],
            pinned: Vec::with_capacity(2),
            nodes: n,
        }
    }

    /// Sets all entries but the elements' own, which are overwritten, to zero, with couplings of the unknowns `at`.
    pub fn clear(&mut self, at: impl ExactSizeIterator<Item = usize>) {
        for b in [&mut self.mass, &mut self.damping, &mut self.stiffness] {
            b.clear();
        }
        self.pinned.clear();
        let n = 6 * self.nodes;
        self.couplings.resize_with(at.len(), Coupling::default);
        for (c, at) in self.couplings.iter_mut().zip(at) {
            c.at = at;
            for x in [&mut c.damping_column, &mut c.damping_row, &mut c.stiffness_row] {
                x.clear();
                x.resize(n, 0.0);
            }
        }
    }

    /// The positions of a node are prescribed.
    pub fn pin(&mut self, node: usize) {
        self.pinned.push(node);
        for c in &mut self.couplings {
            c.damping_column[6 * node..6 * node + 3].fill(0.0);
        }
    }
}

impl Matrices {
    /// Overwrites `out` by the sum of M, D and K with these factors, without the couplings.
    pub fn sum(&self, factors: Each<f64>, out: &mut BlockTridiagonal) {
        self.elements.sum(factors, out);
        for (factor, patches) in factors.iter().zip([&self.mass, &self.damping, &self.stiffness]) {
            patches.add_to(*factor, out);
        }
        for &node in &self.pinned {
            for r in 0..3 {
                for blocks in [&mut out.lower, &mut out.diagonal, &mut out.upper] {
                    blocks[node][r] = [0.0; 6];
                }
                out.diagonal[node][r][r] = factors[0];
            }
        }
    }

    /// M, D and K, without the couplings.
    pub fn whole(&self) -> [BlockTridiagonal; 3] {
        std::array::from_fn(|k| {
            let mut out = BlockTridiagonal::zeros(self.nodes);
            self.sum(std::array::from_fn(|i| if i == k { 1.0 } else { 0.0 }), &mut out);
            out
        })
    }

    /// M + g D + g² K.
    pub fn combine(&self, g: f64, into: &mut Bordered) {
        self.sum([1.0, g, g * g], &mut into.core);
        for (k, coupling) in self.couplings.iter().enumerate() {
            let (column, row) = into.border(k);
            for i in 0..column.len() {
                column[i] = g * coupling.damping_column[i];
                row[i] = g * (coupling.damping_row[i] + g * coupling.stiffness_row[i]);
            }
        }
    }

    /// The same for a complex g, of this real and imaginary part.
    pub fn combine_complex(&self, g: [f64; 2], into: &mut ComplexBordered) {
        let g = Complex::new(g[0], g[1]);
        let square = g * g;
        self.sum([1.0, g.re, square.re], &mut into.parts[0]);
        self.sum([0.0, g.im, square.im], &mut into.parts[1]);
        for (k, coupling) in self.couplings.iter().enumerate() {
            let (column, row) = into.border(k);
            for i in 0..column.len() {
                column[i] = g * coupling.damping_column[i];
                row[i] = g * (g * coupling.stiffness_row[i] + coupling.damping_row[i]);
            }
        }
    }

    /// y += s_a M a + s_w D w + s_u K u.
    pub fn multiply_add(&self, x: Each<Option<(f64, &[f64])>>, y: &mut [f64]) {
        let kept: [[f64; 3]; 2] = std::array::from_fn(|k| self.pinned.get(k).map_or([0.0; 3], |n| [y[6 * n], y[6 * n + 1], y[6 * n + 2]]));
        self.elements.multiply_add(x, y);
        for (x, patches) in x.iter().zip([&self.mass, &self.damping, &self.stiffness]) {
            if let Some((s, x)) = x {
                patches.multiply_add(*s, x, y);
            }
        }
        for (node, kept) in self.pinned.iter().zip(kept) {
            for (c, kept) in kept.into_iter().enumerate() {
                y[6 * node + c] = kept + x[0].map_or(0.0, |(s, a)| s * a[6 * node + c]);
            }
        }
        let times = |row: &[f64], x: &[f64]| row.iter().zip(x).map(|(r, x)| r * x).sum::<f64>();
        for coupling in &self.couplings {
            if let Some((s, w)) = x[1] {
                y[coupling.at] += s * times(&coupling.damping_row, w);
                for (y, c) in y.iter_mut().zip(&coupling.damping_column) {
                    *y += s * c * w[coupling.at];
                }
            }
            if let Some((s, u)) = x[2] {
                y[coupling.at] += s * times(&coupling.stiffness_row, u);
            }
        }
    }
}

/// m −= Σ_ij row_i col_j b over the 12×12 of element `e`.
#[inline(always)]
pub fn subtract_outer(m: &mut Patches, e: usize, row: &[f64; 4], col: &[f64; 4], b: &Mat3<f64>) {
    // Whole columns at a time.
    for c in 0..3 {
        let column = std::array::from_fn(|k| row[k / 3] * b[k % 3][c]);
        for j in 0..4 {
            m.add_pair_column(e, 3 * j + c, -col[j], &column);
        }
    }
}
