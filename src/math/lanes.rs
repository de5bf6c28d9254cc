//! Small vectors and matrices, and numbers side by side.
//!
//! Kernels are plain functions of one point. A loop over the lanes that calls one, reading and writing [`Lanes`], is what the compiler turns
//! into SIMD; so such a loop must hold no call that is not inlined and no branch on what differs between the lanes but a choice of two numbers.

pub use super::dispatch::{Kernel, widest};

/// `W` numbers side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct Lanes<const W: usize>(pub [f64; W]);

impl<const W: usize> Lanes<W> {
    /// Zeros.
    pub const ZERO: Self = Self([0.0; W]);
}

impl<const W: usize> Default for Lanes<W> {
    fn default() -> Self {
        Self::ZERO
    }
}

/// Lane `l` of each.
#[inline(always)]
pub fn lane<const W: usize, const N: usize>(x: &[Lanes<W>; N], l: usize) -> [f64; N] {
    std::array::from_fn(|c| x[c].0[l])
}

/// Sets lane `l` of each.
#[inline(always)]
pub fn set_lane<const W: usize, const N: usize>(x: &mut [Lanes<W>; N], l: usize, v: [f64; N]) {
    for c in 0..N {
        x[c].0[l] = v[c];
    }
}

/// A 3-vector.
pub type Vec3<T> = [T; 3];
/// A 3×3 matrix, row major.
pub type Mat3<T> = [[T; 3]; 3];

/// a·b.
#[inline(always)]
pub fn dot(a: &Vec3<f64>, b: &Vec3<f64>) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// s a.
#[inline(always)]
pub fn scale(s: f64, a: &Vec3<f64>) -> Vec3<f64> {
    [s * a[0], s * a[1], s * a[2]]
}

/// a + s b.
#[inline(always)]
pub fn axpy(a: &Vec3<f64>, s: f64, b: &Vec3<f64>) -> Vec3<f64> {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// m += s a bᵀ.
#[inline(always)]
pub fn add_outer(m: &mut Mat3<f64>, s: f64, a: &Vec3<f64>, b: &Vec3<f64>) {
    for i in 0..3 {
        let sa = s * a[i];
        for j in 0..3 {
            m[i][j] += sa * b[j];
        }
    }
}

/// m += s I.
#[inline(always)]
pub fn add_identity(m: &mut Mat3<f64>, s: f64) {
    for i in 0..3 {
        m[i][i] += s;
    }
}

/// m a.
#[inline(always)]
pub fn mat_vec(m: &Mat3<f64>, a: &Vec3<f64>) -> Vec3<f64> {
    [dot(&m[0], a), dot(&m[1], a), dot(&m[2], a)]
}

/// The zero matrix.
#[inline(always)]
pub fn zero_mat() -> Mat3<f64> {
    [[0.0; 3]; 3]
}
