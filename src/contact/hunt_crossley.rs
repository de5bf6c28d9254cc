//! K. H. Hunt & F. R. E. Crossley, J. Appl. Mech. 42 (1975) 440-445: f = k δⁿ (1 + D δ̇), never adhesive.

use crate::scene::Contact;

/// Force per length and its derivatives by δ and δ̇; zero without penetration.
#[inline]
pub fn force(law: &Contact, depth: f64, rate: f64) -> (f64, f64, f64) {
    if depth <= 0.0 {
        return (0.0, 0.0, 0.0);
    }
    let gain = 1.0 + law.damping * rate;
    if gain <= 0.0 {
        return (0.0, 0.0, 0.0);
    }
    // The usual exponent without a logarithm.
    let power = if law.exponent == 1.5 { depth * depth.sqrt() } else { depth.powf(law.exponent) };
    let elastic = law.stiffness * power;
    (elastic * gain, law.exponent * elastic / depth * gain, elastic * law.damping)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_law_is_never_adhesive_and_matches_its_derivatives() {
        let law = Contact { stiffness: 1e6, damping: 0.4, exponent: 1.5 };
        assert_eq!(force(&law, -1e-3, 5.0).0, 0.0);
        assert_eq!(force(&law, 1e-3, -5.0).0, 0.0); // leaves faster than 1/D
        let (d, v, h) = (1e-3, 0.7, 1e-7);
        let (f, by_depth, by_rate) = force(&law, d, v);
        assert!((f - 1e6 * d.powf(1.5) * 1.28).abs() < 1e-12 * f);
        let fd = (force(&law, d + h, v).0 - force(&law, d - h, v).0) / (2.0 * h);
        let fv = (force(&law, d, v + h).0 - force(&law, d, v - h).0) / (2.0 * h);
        assert!((fd / by_depth - 1.0).abs() < 1e-7 && (fv / by_rate - 1.0).abs() < 1e-7); // h² truncation, rounding
    }
}
