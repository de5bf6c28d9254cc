//! Sums of vectors for the methods' stages.

use crate::math::lanes::{Kernel, widest};

/// out = base + s Σ c_j v_j.
pub fn blend(out: &mut [f64], base: Option<&[f64]>, s: f64, c: &[f64], v: &[Vec<f64>]) {
    widest(Blend { out, base, s, c, v });
}

struct Blend<'a> {
    out: &'a mut [f64],
    base: Option<&'a [f64]>,
    s: f64,
    c: &'a [f64],
    v: &'a [Vec<f64>],
}

impl Kernel for Blend<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { out, base, s, c, v } = self;
        match base {
            Some(base) => out.copy_from_slice(base),
            None => out.fill(0.0),
        }
        let n = out.len();
        let mut j = 0;
        while j + 1 < c.len() {
            let (c0, c1, v0, v1) = (s * c[j], s * c[j + 1], &v[j][..n], &v[j + 1][..n]);
            for k in 0..n {
                out[k] += c0 * v0[k] + c1 * v1[k];
            }
            j += 2;
        }
        if j < c.len() {
            let (c0, v0) = (s * c[j], &v[j][..n]);
            for k in 0..n {
                out[k] += c0 * v0[k];
            }
        }
    }
}

/// y += s x.
pub fn add(y: &mut [f64], s: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += s * x;
    }
}

/// Σ x_k y_k.
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}
