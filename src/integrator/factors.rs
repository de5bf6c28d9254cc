//! The matrix of all methods, M + g D + g² K, and its factors.

use super::vectors::blend;
use crate::linalg::{Bordered, SingularBlock};
use crate::system::Matrices;

/// Factors of M + g D + g² K.
#[derive(Clone, Debug)]
pub struct Factors(Bordered);

impl Factors {
    /// Room for `size` unknowns, of which those `at` are coupled beyond the band.
    pub fn new(size: usize, at: &[usize]) -> Self {
        Self(Bordered::zeros(size / 6, at))
    }

    /// Forms and factors the matrix; `g` in s.
    ///
    /// # Errors
    /// [`SingularBlock`] names the block row.
    pub fn factor(&mut self, m: &Matrices, g: f64) -> Result<(), SingularBlock> {
        self.0.core.combine(&m.mass, &m.damping, &m.stiffness, g);
        for (k, coupling) in m.couplings.iter().enumerate() {
            let (column, row) = self.0.border(k);
            blend(column, None, g, &[1.0], std::slice::from_ref(&coupling.damping_column));
            blend(row, Some(&coupling.damping_row), 1.0, &[g], std::slice::from_ref(&coupling.stiffness_row));
            row.iter_mut().for_each(|x| *x *= g);
        }
        self.0.factor()
    }

    /// Solves in place.
    pub fn solve(&mut self, b: &mut [f64]) {
        self.0.solve(b);
    }
}
