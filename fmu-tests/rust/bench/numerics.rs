//! Small numerics of the verification: of the Rust tests, and of `cargo xtask report`, which includes this file by its path.

use std::f64::consts::FRAC_PI_2;

/// Root of a function that changes sign between `a` and `b`, to rounding, by bisection.
pub fn root(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    let fa = f(a);
    for _ in 0..200 {
        let c = 0.5 * (a + b);
        if f(c) * fa > 0.0 { a = c } else { b = c }
    }
    0.5 * (a + b)
}

/// √(mean (a − b)²).
pub fn rms(pairs: &[(f64, f64)]) -> f64 {
    (pairs.iter().map(|(a, b)| (a - b).powi(2)).sum::<f64>() / pairs.len() as f64).sqrt()
}

/// √(Σ (a − b)² / Σ b²); b is the truth.
pub fn relative_rms(pairs: &[(f64, f64)]) -> f64 {
    let (d, s) = pairs.iter().fold((0.0, 0.0), |(d, s), (a, b)| (d + (a - b).powi(2), s + b * b));
    (d / s).sqrt()
}

/// Numbers of a CSV with a header line; lines that begin with # are comments.
///
/// # Panics
/// A cell is no number.
pub fn table(text: &str) -> Vec<Vec<f64>> {
    let rows = text.lines().filter(|l| !l.starts_with('#')).skip(1);
    rows.map(|l| l.split(',').map(|x| x.trim().parse().expect("a number")).collect()).collect()
}

/// K(k), the complete elliptic integral of the first kind, by the arithmetic-geometric mean.
pub fn elliptic_k(k: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - k * k).sqrt());
    for _ in 0..20 {
        (a, b) = (0.5 * (a + b), f64::sqrt(a * b));
    }
    FRAC_PI_2 / a
}
