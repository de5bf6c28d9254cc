//! K. H. Hunt & F. R. E. Crossley, J. Appl. Mech. 42 (1975) 440-445: f = k δⁿ (1 + D δ̇), never adhesive.

use crate::math::lanes::Lanes;
use crate::scene::Contact;

/// Force per length with its derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pressure {
    /// f, N/m.
    pub force: f64,
    /// ∂f/∂δ, N/m².
    pub by_depth: f64,
    /// ∂f/∂δ̇, N·s/m².
    pub by_rate: f64,
}

/// Force per length at penetration `depth` (m, not negative) growing at `rate` (m/s), given δⁿ. Without branches.
#[inline(always)]
pub fn pressure(law: &Contact, depth: f64, rate: f64, power: f64) -> Pressure {
    let elastic = law.stiffness * power;
    let gain = 1.0 + law.damping * rate;
    let (gain, damping) = if gain > 0.0 { (gain, law.damping) } else { (0.0, 0.0) };
    // At δ = 0 the power is 0 too.
    let by_depth = law.exponent * elastic / depth.max(f64::MIN_POSITIVE) * gain;
    Pressure { force: elastic * gain, by_depth, by_rate: elastic * damping }
}

/// δⁿ of several depths, none negative.
#[inline(always)]
pub fn powers<const N: usize>(exponent: f64, depth: &Lanes<N>) -> Lanes<N> {
    let mut out = *depth;
    // The usual exponents without a logarithm.
    if exponent == 1.5 {
        for i in 0..N {
            out.0[i] *= out.0[i].sqrt();
        }
    } else if exponent != 1.0 {
        for i in 0..N {
            out.0[i] = out.0[i].powf(exponent);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_law_is_never_adhesive_and_matches_its_derivatives() {
        let law = Contact { stiffness: 1e6, damping: 0.4, exponent: 1.5 };
        let pressure = |law: &Contact, depth: f64, rate: f64| pressure(law, depth, rate, powers(law.exponent, &Lanes([depth])).0[0]);
        assert_eq!(pressure(&law, 0.0, 5.0), Pressure::default());
        assert_eq!(pressure(&law, 1e-3, -5.0), Pressure::default()); // leaves faster than 1/D
        for exponent in [1.0, 1.5, 2.3] {
            let law = Contact { exponent, ..law };
            let (d, v, h) = (1e-3, 0.7, 1e-7);
            let at = pressure(&law, d, v);
            assert!((at.force - 1e6 * d.powf(exponent) * 1.28).abs() < 1e-12 * at.force);
            let fd = (pressure(&law, d + h, v).force - pressure(&law, d - h, v).force) / (2.0 * h);
            let fv = (pressure(&law, d, v + h).force - pressure(&law, d, v - h).force) / (2.0 * h);
            for (difference, exact) in [(fd, at.by_depth), (fv, at.by_rate)] {
                assert!((difference / exact - 1.0).abs() < 1e-7); // h² truncation, rounding
            }
        }
    }
}
