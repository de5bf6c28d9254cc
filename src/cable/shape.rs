//! Shape functions of the two-node, 12-coordinate cable element (Gerstmayr & Shabana, Nonlinear Dynamics 45 (2006) 109-130):
//!
//! ```text
//! r(p) = s1 r(0) + s2 r_p(0) + s3 r(L) + s4 r_p(L),   ξ = p/L
//! s1 = 1 − 3ξ² + 2ξ³,  s2 = L(ξ − 2ξ² + ξ³),  s3 = 3ξ² − 2ξ³,  s4 = L(ξ³ − ξ²)
//! ```

use crate::math::lanes::Vec3;

/// Values of the four shape functions, or of one of their derivatives with respect to p.
pub type Shape = [f64; 4];

/// s at ξ of an element of length `l` (m).
#[inline(always)]
pub fn value(x: f64, l: f64) -> Shape {
    let (x2, x3) = (x * x, x * x * x);
    [1.0 - 3.0 * x2 + 2.0 * x3, l * (x - 2.0 * x2 + x3), 3.0 * x2 - 2.0 * x3, l * (x3 - x2)]
}

/// ds/dp at ξ; `i` = 1/L.
#[inline(always)]
pub fn slope(x: f64, i: f64) -> Shape {
    let x2 = x * x;
    let d = 6.0 * (x2 - x);
    [i * d, 1.0 - 4.0 * x + 3.0 * x2, i * (-d), 3.0 * x2 - 2.0 * x]
}

/// d²s/dp² at ξ; `i` = 1/L.
#[inline(always)]
pub fn second(x: f64, i: f64) -> Shape {
    let i2 = i * i;
    let d = 12.0 * x - 6.0;
    [i2 * d, i * (6.0 * x - 4.0), i2 * (-d), i * (6.0 * x - 2.0)]
}

/// Σ s_i q_i.
#[inline(always)]
pub fn interpolate(s: &Shape, q: &[Vec3<f64>; 4]) -> Vec3<f64> {
    std::array::from_fn(|c| s[0] * q[0][c] + s[1] * q[1][c] + s[2] * q[2][c] + s[3] * q[3][c])
}

/// ∫ s dp of an element of length `l`.
#[inline(always)]
pub fn integral(l: f64) -> Shape {
    let l2 = l * l;
    [l * 0.5, l2 * (1.0 / 12.0), l * 0.5, l2 * (-1.0 / 12.0)]
}

/// ∫ sᵢ sⱼ dp of an element of length `l`: the mass matrix per mass per length, one number per pair (times the 3×3 identity).
#[inline(always)]
pub fn mass(l: f64) -> [[f64; 4]; 4] {
    let (l2, l3) = (l * l, l * l * l);
    let (a, b, c, d, e, f) =
        (l * (13.0 / 35.0), l2 * (11.0 / 210.0), l * (9.0 / 70.0), l2 * (13.0 / 420.0), l3 * (1.0 / 105.0), l3 * (-1.0 / 140.0));
    [[a, b, c, -d], [b, e, d, f], [c, d, a, -b], [-d, f, -b, e]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::quadrature::GAUSS5;

    #[test]
    fn exact_closed_forms_equal_quadrature() {
        let l = 0.73;
        let (mut i1, mut m1) = ([0.0; 4], [[0.0; 4]; 4]);
        for (x, w) in GAUSS5 {
            let s = value(x, l);
            for i in 0..4 {
                i1[i] += w * l * s[i];
                for j in 0..4 {
                    m1[i][j] += w * l * s[i] * s[j];
                }
            }
        }
        for i in 0..4 {
            assert!((i1[i] - integral(l)[i]).abs() < 1e-15);
            for j in 0..4 {
                assert!((m1[i][j] - mass(l)[i][j]).abs() < 1e-15); // degree 6 under a rule exact to degree 9
            }
        }
    }

    #[test]
    fn exact_derivatives_match_differences() {
        let (x, l, h) = (0.31, 0.73, 1e-5);
        for i in 0..4 {
            let d1 = (value(x + h, l)[i] - value(x - h, l)[i]) / (2.0 * h * l);
            let d2 = (slope(x + h, 1.0 / l)[i] - slope(x - h, 1.0 / l)[i]) / (2.0 * h * l);
            assert!((d1 - slope(x, 1.0 / l)[i]).abs() < 1e-9);
            assert!((d2 - second(x, 1.0 / l)[i]).abs() < 1e-9);
        }
    }
}
