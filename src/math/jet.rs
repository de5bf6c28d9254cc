//! A number with its first three time derivatives, so that kinematic chains give position, velocity, acceleration and jerk at once.

use std::ops::{Add, Mul, Sub};

/// (x, ẋ, ẍ, x⃛).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jet(pub [f64; 4]);

impl Jet {
    /// A constant.
    #[inline(always)]
    pub fn constant(x: f64) -> Self {
        Self([x, 0.0, 0.0, 0.0])
    }

    /// Sine and cosine (chain rule to the third order).
    #[inline(always)]
    pub fn sin_cos(self) -> (Self, Self) {
        let [x, d1, d2, d3] = self.0;
        let (s, c) = x.sin_cos();
        let q = d1 * d1;
        (
            Self([s, c * d1, c * d2 - s * q, c * d3 - 3.0 * s * d1 * d2 - c * q * d1]),
            Self([c, -s * d1, -s * d2 - c * q, -s * d3 - 3.0 * c * d1 * d2 + s * q * d1]),
        )
    }

    /// The square root of a positive number, from s² = x by Leibniz's rule.
    pub fn sqrt(self) -> Self {
        let [x, d1, d2, d3] = self.0;
        let s = x.sqrt();
        let half = 0.5 / s;
        let s1 = half * d1;
        let s2 = half * (d2 - 2.0 * s1 * s1);
        Self([s, s1, s2, half * (d3 - 6.0 * s1 * s2)])
    }
}

impl Add for Jet {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + o.0[i]))
    }
}

impl Sub for Jet {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] - o.0[i]))
    }
}

impl Mul for Jet {
    type Output = Self;
    /// Leibniz's rule.
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        let (a, b) = (self.0, o.0);
        Self([
            a[0] * b[0],
            a[1] * b[0] + a[0] * b[1],
            a[2] * b[0] + 2.0 * a[1] * b[1] + a[0] * b[2],
            a[3] * b[0] + 3.0 * (a[2] * b[1] + a[1] * b[2]) + a[0] * b[3],
        ])
    }
}

impl Mul<f64> for Jet {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: f64) -> Self {
        Self(self.0.map(|x| s * x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The jet of t ↦ f at t from a polynomial x(t) = 0.3 + 0.7 t − 0.4 t² + 0.2 t³.
    fn x(t: f64) -> Jet {
        Jet([0.3 + 0.7 * t - 0.4 * t * t + 0.2 * t.powi(3), 0.7 - 0.8 * t + 0.6 * t * t, -0.8 + 1.2 * t, 1.2])
    }

    #[test]
    fn exact_jets_of_products_sines_and_roots_match_differences() {
        let f = |t: f64| {
            let (s, c) = x(t).sin_cos();
            s * s * c * x(t) + c - s * 2.0 + (x(t) + Jet::constant(2.0)).sqrt()
        };
        // Central differences of one order give the next: truncation h²/6 f''' ~ 1e-8 with h = 1e-4.
        let h = 1e-4;
        let (m, p, j) = (f(0.4 - h), f(0.4 + h), f(0.4));
        for k in 0..3 {
            let d = (p.0[k] - m.0[k]) / (2.0 * h);
            assert!((d - j.0[k + 1]).abs() < 1e-6, "order {}: {} against {}", k + 1, d, j.0[k + 1]);
        }
    }
}
