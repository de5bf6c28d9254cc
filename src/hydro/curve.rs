//! Drag coefficients as functions of the Reynolds number.

use crate::math::interpolation::piecewise_linear;
use crate::scene::Coefficient;

/// Circular cylinder in cross-flow, 1e-4 < Re < 2e5.
///
/// D. Sucker & H. Brauer, Fluiddynamik bei quer angeströmten Zylindern, Wärme- und Stoffübertragung 8 (1975) 149-158.
pub fn cylinder(re: f64) -> f64 {
    let re = re.clamp(1e-4, 2e5);
    1.18 + 6.8 / re.powf(0.89) + 1.96 / re.sqrt() - 4e-4 * re / (1.0 + 3.64e-7 * re * re)
}

/// Smooth sphere, Re < 3e5.
///
/// R. Clift & W. H. Gauvin, Motion of entrained particles in gas streams, Can. J. Chem. Eng. 49 (1971) 439-448.
pub fn sphere(re: f64) -> f64 {
    let re = re.clamp(1e-4, 3e5);
    24.0 / re * (1.0 + 0.15 * re.powf(0.687)) + 0.42 / (1.0 + 42500.0 * re.powf(-1.16))
}

/// Interpolation in ln Re, ln C, constant beyond the ends.
fn table(points: &[[f64; 2]], re: f64) -> f64 {
    piecewise_linear(|i| (points[i][0].ln(), points[i][1].ln()), points.len(), re.ln()).0.exp()
}

const LOWEST: i64 = -14;
const HIGHEST: i64 = 24;
const BITS: u32 = 4;
const PER_OCTAVE: usize = 1 << BITS;

/// A coefficient, ready for the kernel: constant, or cubic Hermite pieces, sixteen to the octave from Re = 2^−14 to 2^24 (found from the
/// number's own bits, without a logarithm; within 1e-5 of the curve).
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    constant: f64,
    /// Cubic in (Re − a)/(b − a) for each piece [a, b]; empty for a constant.
    pieces: Vec<[f64; 4]>,
}

impl Curve {
    /// Tabulates a scene's coefficient.
    pub fn new(coefficient: &Coefficient) -> Self {
        match coefficient {
            Coefficient::Constant(c) => Self { constant: *c, pieces: Vec::new() },
            Coefficient::Table(points) => Self::sample(|re| table(points, re)),
            Coefficient::Cylinder => Self::sample(cylinder),
            Coefficient::Sphere => Self::sample(sphere),
        }
    }

    fn sample(f: impl Fn(f64) -> f64) -> Self {
        let slope = |x: f64| (f(x * 1.0001) - f(x * 0.9999)) / (2e-4 * x);
        let mut pieces = Vec::new();
        for octave in LOWEST..HIGHEST {
            let base = (octave as f64).exp2();
            for k in 0..PER_OCTAVE {
                let (a, w) = (base * (1.0 + k as f64 / PER_OCTAVE as f64), base / PER_OCTAVE as f64);
                let (fa, fb, sa, sb) = (f(a), f(a + w), slope(a) * w, slope(a + w) * w);
                pieces.push([fa, sa, 3.0 * (fb - fa) - 2.0 * sa - sb, 2.0 * (fa - fb) + sa + sb]);
            }
        }
        Self { constant: 0.0, pieces }
    }

    /// Whether the Reynolds number matters.
    pub fn is_constant(&self) -> bool {
        self.pieces.is_empty()
    }

    /// (C, dC/dRe); constant beyond the range.
    #[inline]
    pub fn at(&self, re: f64) -> (f64, f64) {
        if self.pieces.is_empty() {
            return (self.constant, 0.0);
        }
        let bits = re.to_bits();
        let index = (bits >> (52 - BITS)) as i64 - ((1023 + LOWEST) << BITS);
        if index < 0 || re.is_nan() {
            return (self.pieces[0][0], 0.0);
        }
        let Some(c) = self.pieces.get(index as usize) else {
            return (self.pieces[self.pieces.len() - 1].iter().sum(), 0.0);
        };
        let a = f64::from_bits(bits >> (52 - BITS) << (52 - BITS));
        let inverse = PER_OCTAVE as f64 / f64::from_bits(bits & (0x7ff << 52));
        let x = (re - a) * inverse;
        (c[0] + x * (c[1] + x * (c[2] + x * c[3])), (c[1] + x * (2.0 * c[2] + x * 3.0 * c[3])) * inverse)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paper_standard_drag_values() {
        // Measured circular cylinder (Wieselsberger; Tritton 1959): 1.3 to 1.5 at Re = 100, 1.0 to 1.2 at Re = 1e4.
        assert!((1.3..1.5).contains(&cylinder(100.0)));
        assert!((0.95..1.25).contains(&cylinder(1e4)));
        // Standard sphere curve (Clift, Grace & Weber 1978): 1.09 at Re = 100, 0.47 at 1000, 0.40 at 1e4; both within 5 %.
        for (re, cd) in [(100.0, 1.09), (1000.0, 0.47), (1e4, 0.405)] {
            assert!((sphere(re) / cd - 1.0).abs() < 0.05, "{re}: {}", sphere(re));
        }
    }

    #[test]
    fn exact_pieces_follow_the_curve_and_its_slope() {
        for (curve, f) in [(Curve::new(&Coefficient::Cylinder), cylinder as fn(f64) -> f64), (Curve::new(&Coefficient::Sphere), sphere)] {
            let mut re = 1e-3;
            while re < 1e5 {
                let (c, d) = curve.at(re);
                let slope = (f(re * 1.0001) - f(re * 0.9999)) / (2e-4 * re);
                assert!((c / f(re) - 1.0).abs() < 1e-5, "{re}: {c} against {}", f(re));
                assert!((d - slope).abs() * re < 2e-3 * f(re), "{re}: slope {d} against {slope}");
                re *= 1.037;
            }
        }
        let t = Curve::new(&Coefficient::Table(vec![[10.0, 2.0], [1000.0, 1.0]]));
        assert!((t.at(1.0).0 - 2.0).abs() < 1e-12 && (t.at(1e9).0 - 1.0).abs() < 1e-12);
        assert!((t.at(100.0).0 - 2f64.sqrt()).abs() < 1e-5);
    }
}
