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
    widest(Add { y, s, x });
}

struct Add<'a> {
    y: &'a mut [f64],
    s: f64,
    x: &'a [f64],
}

impl Kernel for Add<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for (y, x) in self.y.iter_mut().zip(self.x) {
            *y += self.s * x;
        }
    }
}

/// Σ x_k y_k.
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// The same in eight sums side by side.
pub fn long_dot(x: &[f64], y: &[f64]) -> f64 {
    widest(LongDot { x, y })
}

struct LongDot<'a> {
    x: &'a [f64],
    y: &'a [f64],
}

impl Kernel for LongDot<'_> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let mut sums = [0.0; 8];
        let (x, y) = (self.x.chunks_exact(8), self.y.chunks_exact(8));
        let rest = dot(x.remainder(), y.remainder());
        for (x, y) in x.zip(y) {
            for l in 0..8 {
                sums[l] += x[l] * y[l];
            }
        }
        sums.iter().sum::<f64>() + rest
    }
}

/// w = base_w + g a, u = base_u + g w.
pub fn climb([u, w]: &mut [Vec<f64>; 2], [base_u, base_w]: &[Vec<f64>; 2], a: &[f64], g: f64) {
    widest(Climb { u, w, base_u, base_w, a, g });
}

struct Climb<'a> {
    u: &'a mut [f64],
    w: &'a mut [f64],
    base_u: &'a [f64],
    base_w: &'a [f64],
    a: &'a [f64],
    g: f64,
}

impl Kernel for Climb<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { u, w, base_u, base_w, a, g } = self;
        for (((u, w), (base_u, base_w)), a) in u.iter_mut().zip(w).zip(base_u.iter().zip(base_w)).zip(a) {
            *w = base_w + g * a;
            *u = base_u + g * *w;
        }
    }
}

/// The state (u, w) halfway through a step of `h`, on the cubic through both ends.
pub fn midway(h: f64, from: [&[f64]; 2], to: [&[f64]; 2], mid: [&mut [f64]; 2]) {
    widest(Midway { h, from, to, mid });
}

struct Midway<'a> {
    h: f64,
    from: [&'a [f64]; 2],
    to: [&'a [f64]; 2],
    mid: [&'a mut [f64]; 2],
}

impl Kernel for Midway<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { h, from: [u0, w0], to: [u1, w1], mid: [u, w] } = self;
        let (eighth, rate) = (h / 8.0, 1.5 / h);
        for (((u, w), (u0, w0)), (u1, w1)) in u.iter_mut().zip(w).zip(u0.iter().zip(w0)).zip(u1.iter().zip(w1)) {
            *u = 0.5 * (u0 + u1) + eighth * (w0 - w1);
            *w = rate * (u1 - u0) - 0.25 * (w0 + w1);
        }
    }
}
