//! Digital low-pass filters with Chebyshev's ripple in the stop band (type II, "inverse Chebyshev"), as second-order sections.
//!
//! Analog prototype |H|² = 1/(1 + 1/(ε² T_n²(Ω_s/Ω))), ε² = 1/(10^(A/10) − 1): flat at rest, attenuation A from the edge Ω_s on. Bilinear
//! transform with the edge pre-warped, Ω = tan(π f/f_s), so that the edge is met exactly (Oppenheim & Schafer, Discrete-Time Signal
//! Processing, chapter 7 and appendix B).

use std::f64::consts::PI;

/// (b0 + b1 z⁻¹ + b2 z⁻²)/(1 + a1 z⁻¹ + a2 z⁻²).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// b0, b1, b2.
    pub b: [f64; 3],
    /// a1, a2.
    pub a: [f64; 2],
}

/// A low-pass filter.
#[derive(Clone, Debug, PartialEq)]
pub struct LowPass {
    /// In the order in which the signal passes them; each has unit gain at rest.
    pub sections: Vec<Section>,
    /// Magnitude of the pole next to the unit circle.
    slowest: f64,
}

impl LowPass {
    /// `order` ≥ 1, stop-band `edge` as a fraction of the sampling rate (between 0 and ½), `attenuation` there in dB (> 0).
    pub fn new(order: usize, edge: f64, attenuation: f64) -> Self {
        let warped = (PI * edge).tan();
        let n = order as f64;
        // 1/ε = √(10^(A/10) − 1).
        let spread = (10f64.powf(0.1 * attenuation) - 1.0).sqrt().asinh() / n;
        let (sinh, cosh) = (spread.sinh(), spread.cosh());
        let mut slowest = 0.0f64;
        let pairs = (0..order / 2).map(|k| {
            let angle = (2 * k + 1) as f64 * PI / (2.0 * n);
            // Poles are the reciprocals of those of type I, zeros lie on the imaginary axis where T_n vanishes.
            let (re, im) = (-sinh * angle.sin(), cosh * angle.cos());
            let scale = warped / (re * re + im * im);
            let zero = warped / angle.cos();
            // s = (1 − z⁻¹)/(1 + z⁻¹) in s² + c1 s + c0.
            let bilinear = |c1: f64, c0: f64| [1.0 + c1 + c0, 2.0 * (c0 - 1.0), 1.0 - c1 + c0];
            let (re, im) = (re * scale, im * scale);
            let below = bilinear(-2.0 * re, re * re + im * im);
            let above = bilinear(0.0, zero * zero);
            slowest = slowest.max((below[2] / below[0]).sqrt());
            section(above, below)
        });
        let mut sections: Vec<Section> = pairs.collect();
        if order % 2 == 1 {
            let pole = warped / sinh;
            slowest = slowest.max(((1.0 - pole) / (1.0 + pole)).abs());
            sections.push(section([1.0, 1.0, 0.0], [1.0 + pole, pole - 1.0, 0.0]));
        }
        Self { sections, slowest }
    }

    /// The response to 1, 0, 0, … up to where no more than `tail` of its sum of squares is to come.
    pub fn impulse_response(&self, tail: f64) -> Vec<f64> {
        // Long enough whatever the constant before the slowest pole's decay: down to rounding, squared.
        let long = (2.0 * f64::EPSILON.ln() / self.slowest.ln()).ceil() as usize + 2 * self.sections.len();
        let mut delays = vec![[0.0; 2]; self.sections.len()];
        let mut response: Vec<f64> = (0..long)
            .map(|k| {
                let mut x = if k == 0 { 1.0 } else { 0.0 };
                for (s, d) in self.sections.iter().zip(&mut delays) {
                    // Direct form II, transposed.
                    let y = s.b[0] * x + d[0];
                    *d = [s.b[1] * x - s.a[0] * y + d[1], s.b[2] * x - s.a[1] * y];
                    x = y;
                }
                x
            })
            .collect();
        let enough = tail * response.iter().map(|x| x * x).sum::<f64>();
        let mut rest = 0.0;
        while let Some(x) = response.last() {
            rest += x * x;
            if rest > enough {
                break;
            }
            response.pop();
        }
        response
    }
}

/// Of these polynomials in z⁻¹, scaled to unit gain at z = 1.
fn section(above: [f64; 3], below: [f64; 3]) -> Section {
    let gain = below.iter().sum::<f64>() / above.iter().sum::<f64>();
    Section { b: above.map(|x| gain * x / below[0]), a: [below[1] / below[0], below[2] / below[0]] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// |H|² at a fraction of the sampling rate.
    fn power(filter: &LowPass, f: f64) -> f64 {
        let (s, c) = (2.0 * PI * f).sin_cos();
        let (s2, c2) = (4.0 * PI * f).sin_cos();
        let size = |p: [f64; 3]| (p[0] + p[1] * c + p[2] * c2).powi(2) + (p[1] * s + p[2] * s2).powi(2);
        filter.sections.iter().map(|x| size(x.b) / size([1.0, x.a[0], x.a[1]])).product()
    }

    /// T_n outside and inside of [−1, 1].
    fn chebyshev(n: usize, x: f64) -> f64 {
        let n = n as f64;
        if x.abs() > 1.0 { (n * x.acosh()).cosh() } else { (n * x.acos()).cos() }
    }

    #[test]
    fn exact_power_is_chebyshevs_formula_on_the_warped_axis() {
        for (order, edge, attenuation) in [(1, 0.1, 80.0), (2, 0.3, 40.0), (5, 0.02, 80.0), (8, 0.02, 80.0), (12, 0.2, 60.0)] {
            let filter = LowPass::new(order, edge, attenuation);
            let excess = 10f64.powf(0.1 * attenuation) - 1.0;
            for k in 1..500 {
                let f = 0.001 * f64::from(k);
                let t = chebyshev(order, (PI * edge).tan() / (PI * f).tan());
                let expected = t * t / (t * t + excess);
                // Near a zero both vanish: rounding there is measured by the stop band's level.
                let floor = 1e-9 * 10f64.powf(-0.1 * attenuation);
                assert!((power(&filter, f) - expected).abs() < 1e-9 * expected + floor, "order {order}, f = {f}");
            }
        }
    }

    #[test]
    fn exact_edge_rest_and_pass_band() {
        let filter = LowPass::new(8, 0.02, 80.0);
        let decibel = |f: f64| 10.0 * power(&filter, f).log10();
        // Rounding of 16 coefficients.
        assert!((decibel(0.02) + 80.0).abs() < 1e-7 && decibel(0.0).abs() < 1e-9, "{} {}", decibel(0.02), decibel(0.0));
        let levels: Vec<f64> = (0..=2000).map(|k| decibel(1e-5 * f64::from(k))).collect();
        assert!(levels.windows(2).all(|w| w[1] < w[0] + 1e-9), "the level falls up to the edge");
        assert!((0..=480).all(|k| decibel(0.02 + 1e-3 * f64::from(k)) < -80.0 + 1e-7), "and stays down beyond it");
    }

    #[test]
    fn exact_impulse_response_has_the_filters_gain_and_power() {
        for order in [3, 8] {
            let filter = LowPass::new(order, 0.02, 80.0);
            let h = filter.impulse_response(1e-12);
            // The cut-off tail is up to 1e-6 of the root of the sum of squares, some hundred numbers long.
            assert!((h.iter().sum::<f64>() - 1.0).abs() < 1e-5, "{}", h.iter().sum::<f64>());
            // Parseval: Σh² = ∫|H|² df, by the midpoint rule, which converges at once on a period of an analytic function.
            let n = 20_000;
            let mean = (0..n).map(|k| power(&filter, (f64::from(k) + 0.5) / f64::from(n))).sum::<f64>() / f64::from(n);
            let sum: f64 = h.iter().map(|x| x * x).sum();
            assert!((sum / mean - 1.0).abs() < 1e-10, "{sum} {mean}");
        }
    }
}
