//! Polynomials and tables.

use super::jet::Jet;

/// A quintic c0 + c1 τ + … + c5 τ⁵.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quintic(pub [f64; 6]);

impl Quintic {
    /// Through value, slope and second derivative at τ = 0.
    pub fn parabola(from: [f64; 3]) -> Self {
        Self([from[0], from[1], 0.5 * from[2], 0.0, 0.0, 0.0])
    }

    /// Meets value, slope and second derivative `from` at τ = 0 and `to` at τ = `h`.
    pub fn hermite(from: [f64; 3], to: [f64; 3], h: f64) -> Self {
        let [x0, v0, a0] = from;
        // In units of h, so that nothing overflows for tiny steps.
        let (v0h, a0h, v1h, a1h) = (v0 * h, a0 * h * h, to[1] * h, to[2] * h * h);
        let d = to[0] - x0 - v0h - 0.5 * a0h;
        let e = v1h - v0h - a0h;
        let f = a1h - a0h;
        let c3 = 10.0 * d - 4.0 * e + 0.5 * f;
        let c4 = -15.0 * d + 7.0 * e - f;
        let c5 = 6.0 * d - 3.0 * e + 0.5 * f;
        let i = 1.0 / h;
        let i3 = i * i * i;
        Self([x0, v0, 0.5 * a0, c3 * i3, c4 * i3 * i, c5 * i3 * i * i])
    }

    /// Value and three derivatives at τ.
    #[inline(always)]
    pub fn jet(&self, t: f64) -> Jet {
        let c = &self.0;
        Jet([
            c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5])))),
            c[1] + t * (2.0 * c[2] + t * (3.0 * c[3] + t * (4.0 * c[4] + t * 5.0 * c[5]))),
            2.0 * c[2] + t * (6.0 * c[3] + t * (12.0 * c[4] + t * 20.0 * c[5])),
            6.0 * c[3] + t * (24.0 * c[4] + t * 60.0 * c[5]),
        ])
    }

    /// The quintic `s` times as high.
    pub fn times(&self, s: f64) -> Self {
        Self(self.0.map(|c| s * c))
    }

    /// Sum of two quintics in the same variable.
    pub fn plus(&self, o: &Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + o.0[i]))
    }
}

/// Value and slope at `x` of the piecewise linear function through (x, y), constant beyond the ends; `points` ascends in x.
pub fn piecewise_linear(points: impl Fn(usize) -> (f64, f64), count: usize, x: f64) -> (f64, f64) {
    if count == 0 {
        return (0.0, 0.0);
    }
    let (first, last) = (points(0), points(count - 1));
    if x <= first.0 {
        return (first.1, 0.0);
    }
    if x >= last.0 {
        return (last.1, 0.0);
    }
    let (mut lo, mut hi) = (0, count - 1);
    while hi - lo > 1 {
        let mid = (lo + hi) / 2;
        if points(mid).0 <= x { lo = mid } else { hi = mid }
    }
    let (a, b) = (points(lo), points(hi));
    let slope = (b.1 - a.1) / (b.0 - a.0);
    (a.1 + slope * (x - a.0), slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_hermite_quintic_meets_both_ends() {
        let q = Quintic::hermite([1.0, -2.0, 3.0], [0.5, 4.0, -1.0], 0.37);
        let (a, b) = (q.jet(0.0).0, q.jet(0.37).0);
        for (x, y) in a.iter().chain(&b).zip([1.0, -2.0, 3.0, a[3], 0.5, 4.0, -1.0, b[3]]) {
            assert!((x - y).abs() < 1e-11, "{x} against {y}"); // rounding of powers of 1/h
        }
    }

    #[test]
    fn exact_table_is_constant_beyond_its_ends() {
        let t = [(-1.0, 2.0), (1.0, 4.0), (2.0, 0.0)];
        let f = |x| piecewise_linear(|i| t[i], 3, x);
        assert_eq!(f(-5.0), (2.0, 0.0));
        assert_eq!(f(0.0), (3.0, 1.0));
        assert_eq!(f(1.5), (2.0, -4.0));
        assert_eq!(f(9.0), (0.0, 0.0));
    }
}
