//! Turbulence of the current: coloured noise, uniform in space, a pure function of seed and time.
//!
//! White Gaussian noise w_k at a sampling rate passes a Chebyshev-II low-pass (thesis 4.3, after Calnan 2016), v_k = σ Σ h_j w_(k−j) with
//! Σ h_j² = 1, so that each sample has exactly the standard deviation σ. Between samples each component follows the quintic that meets
//! values, slopes and second derivatives (fourth-order differences) at both ends: twice continuously differentiable, so the water's
//! acceleration has no kinks. w_k comes from a counter-based hash of (seed, k), for every k from −∞ on: the process is stationary, knows no
//! first sample, and what was asked before changes nothing. From the start of the run on it grows smoothly out of the mean current.

use crate::math::chebyshev2::LowPass;
use crate::math::interpolation::Quintic;
use crate::math::jet::Jet;
use crate::math::lanes::Vec3;
use crate::math::ring::Ring;
use crate::scene::Noise;
use std::cell::RefCell;
use std::f64::consts::PI;

/// Part of the impulse response's sum of squares that is left out at its end.
const TAIL: f64 = 1e-12;

/// Coloured noise in three components.
#[derive(Clone, Debug)]
pub struct Turbulence {
    /// Start of the run, from which the noise grows, s.
    pub start: f64,
    /// In which it grows, s.
    ramp: f64,
    /// Samples per second.
    rate: f64,
    seed: u64,
    deviation: Vec3<f64>,
    /// h_j.
    response: Vec<f64>,
    /// White and coloured samples, remembered: computed anew they come out the same to the last bit.
    memory: RefCell<[Ring; 2]>,
}

impl Turbulence {
    /// From a checked scene.
    pub fn new(noise: &Noise) -> Self {
        let filter = LowPass::new(noise.order, noise.cutoff / noise.sample_rate, noise.attenuation);
        let mut response = filter.impulse_response(TAIL);
        let size = response.iter().map(|x| x * x).sum::<f64>().sqrt();
        response.iter_mut().for_each(|x| *x /= size);
        Self {
            start: 0.0,
            ramp: noise.ramp,
            rate: noise.sample_rate,
            seed: u64::from(noise.seed),
            deviation: noise.std_dev,
            memory: RefCell::new([Ring::new(response.len()), Ring::new(8)]),
            response,
        }
    }

    /// Velocity and acceleration at `t`, m/s and m/s².
    pub fn at(&self, t: f64) -> [Vec3<f64>; 2] {
        let k = (t * self.rate).floor();
        let tau = t - k / self.rate;
        // Wrapping: only a time that nobody means, of a forged state or an absurd start, comes near the last number.
        let near: [Vec3<f64>; 6] = std::array::from_fn(|j| self.sample((k as i64).wrapping_add(j as i64 - 2)));
        let growth = self.growth(t);
        let jets: [Jet; 3] = std::array::from_fn(|c| {
            let ends = [2, 3].map(|j| derivatives(std::array::from_fn(|i| near[j + i - 2][c]), self.rate));
            Quintic::hermite(ends[0], ends[1], 1.0 / self.rate).jet(tau) * growth
        });
        [0, 1].map(|order| std::array::from_fn(|c| jets[c].0[order]))
    }

    /// From 0 at the start to 1 a ramp later, twice continuously differentiable.
    fn growth(&self, t: f64) -> Jet {
        let t = t - self.start;
        if t >= self.ramp || self.ramp == 0.0 {
            Jet::constant(1.0)
        } else if t <= 0.0 {
            Jet::default()
        } else {
            Quintic::hermite([0.0; 3], [1.0, 0.0, 0.0], self.ramp).jet(t)
        }
    }

    /// v_k.
    fn sample(&self, k: i64) -> Vec3<f64> {
        let [white, coloured] = &mut *self.memory.borrow_mut();
        coloured.get(k, || {
            let mut sum = [0.0; 3];
            for (j, h) in self.response.iter().enumerate() {
                let k = k.wrapping_sub(j as i64);
                let w = white.get(k, || white_noise(self.seed, k));
                for c in 0..3 {
                    sum[c] += h * w[c];
                }
            }
            std::array::from_fn(|c| self.deviation[c] * sum[c])
        })
    }
}

/// Value, slope and second derivative at the middle of five samples, to the fourth order.
fn derivatives(y: [f64; 5], rate: f64) -> [f64; 3] {
    let slope = (y[0] - y[4] + 8.0 * (y[3] - y[1])) / 12.0;
    let bend = (16.0 * (y[1] + y[3]) - y[0] - y[4] - 30.0 * y[2]) / 12.0;
    [y[2], slope * rate, bend * rate * rate]
}

/// Three independent standard normal numbers for a seed and a counter (Box and Muller).
fn white_noise(seed: u64, k: i64) -> Vec3<f64> {
    // 2⁻⁵³ … 1, so that the logarithm is finite.
    let uniform = |i: u64| ((scramble(scramble(scramble(seed) ^ k as u64) ^ i) >> 11) + 1) as f64 * 2f64.powi(-53);
    let pair = |i: u64| {
        let (r, (s, c)) = ((-2.0 * uniform(i).ln()).sqrt(), (2.0 * PI * uniform(i + 1)).sin_cos());
        [r * c, r * s]
    };
    let ([x, y], [z, _]) = (pair(0), pair(2));
    [x, y, z]
}

/// Step and finalizer of SplitMix64 (Steele, Lea & Flood 2014): every bit of the result depends on every bit of `x`.
fn scramble(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOISE: Noise =
        Noise { std_dev: [0.03, 0.0262, 0.0152], seed: 7, sample_rate: 100.0, order: 8, cutoff: 2.0, attenuation: 80.0, ramp: 0.0 };

    #[test]
    fn exact_value_depends_on_seed_and_time_only() {
        let (a, b) = (Turbulence::new(&NOISE), Turbulence::new(&NOISE));
        let times: Vec<f64> = (0..2000).map(|i| 0.0137 * f64::from(i) - 3.0).collect();
        let forward: Vec<_> = times.iter().map(|t| a.at(*t)).collect();
        // Backwards, and by one who asks for the first time.
        let backward: Vec<_> = times.iter().rev().map(|t| b.at(*t)).collect();
        assert!(forward.iter().eq(backward.iter().rev()));
        assert_eq!(Turbulence::new(&NOISE).at(times[700]), forward[700]);
        assert_ne!(Turbulence::new(&Noise { seed: 8, ..NOISE }).at(times[700]), forward[700]);
    }

    #[test]
    fn exact_acceleration_is_continuous_and_the_velocitys_derivative() {
        let noise = Turbulence::new(&Noise { ramp: 2.0, ..NOISE });
        for i in 0..400 {
            let (t, h) = (0.00937 * f64::from(i), 1e-5);
            let [_, a] = noise.at(t);
            let ([after, _], [before, _]) = (noise.at(t + h), noise.at(t - h));
            for c in 0..3 {
                // h² v'''/6: what passes the stop band, 1e-4 of white noise up to 50 Hz, has v''' up to some 1e3 m/s⁴.
                let difference = (after[c] - before[c]) / (2.0 * h);
                assert!((difference - a[c]).abs() < 1e-7, "t = {t}: {difference} {}", a[c]);
            }
            // At a sample, from both sides: v'' of about 1 m/s³ over 2e-9 s.
            let k = f64::from(i) / 100.0;
            let (left, right) = (noise.at(k - 1e-9), noise.at(k + 1e-9));
            assert!((0..3).all(|c| (left[1][c] - right[1][c]).abs() < 3e-8), "sample {i}");
        }
        assert_eq!(noise.at(0.0), [[0.0; 3]; 2]);
    }

    #[test]
    fn exact_derivatives_at_a_sample_are_a_quartics() {
        // y = x^n at x = −2 … 2: only y = x has a slope at 0 and only y = x² is bent there; at 10 samples a second lengths are tenths.
        for (n, slope, bend) in [(0, 0.0, 0.0), (1, 1.0, 0.0), (2, 0.0, 2.0), (3, 0.0, 0.0), (4, 0.0, 0.0)] {
            let y = [-2.0f64, -1.0, 0.0, 1.0, 2.0].map(|x| x.powi(n));
            let [_, first, second] = derivatives(y, 10.0);
            // Rounding of sums up to 32, times 100.
            assert!((first - 10.0 * slope).abs() < 1e-12 && (second - 100.0 * bend).abs() < 1e-12, "x^{n}: {first} {second}");
        }
    }

    #[test]
    fn exact_samples_are_filtered_white_noise_of_unit_power() {
        let noise = Turbulence::new(&NOISE);
        let power: f64 = noise.response.iter().map(|h| h * h).sum();
        assert!((power - 1.0).abs() < 1e-13, "{power}"); // rounding of some hundred squares
        for k in [-40, 0, 12345] {
            let v = noise.sample(k);
            for c in 0..3 {
                let sum: f64 = noise.response.iter().enumerate().map(|(j, h)| h * white_noise(NOISE.seed.into(), k - j as i64)[c]).sum();
                assert!((v[c] - NOISE.std_dev[c] * sum).abs() < 1e-15, "sample {k}: {v:?}"); // the same sum, of numbers near 1e-2
            }
        }
        // From the cut-off on the filter stops: 80 dB, and what the cut end of the response leaves, √(1e-12 n) of H(0) ≥ 1.
        let gain = |f: f64| {
            let (mut re, mut im) = (0.0, 0.0);
            for (j, h) in noise.response.iter().enumerate() {
                let (sine, cosine) = (2.0 * PI * f / NOISE.sample_rate * j as f64).sin_cos();
                (re, im) = (re + h * cosine, im + h * sine);
            }
            re.hypot(im)
        };
        for i in 0..=480 {
            let f = NOISE.cutoff + 0.1 * f64::from(i);
            assert!(gain(f) < 1.1e-4 * gain(0.0), "{f} Hz: {:e}", gain(f) / gain(0.0));
        }
    }

    #[test]
    fn exact_deviations_are_those_asked_for() {
        let noise = Turbulence::new(&NOISE);
        // Samples 0.7 s apart are nearly independent (half the power lies below 1.07 Hz); a variance from n of them has a relative standard
        // deviation √(2/n) = 0.7 %: four of these.
        let n = 40_000;
        let mut sums = [[0.0; 3]; 2];
        let mut crossed = [0.0; 3];
        for i in 0..n {
            let [v, _] = noise.at(0.7 * f64::from(i));
            for c in 0..3 {
                sums[0][c] += v[c] / f64::from(n);
                sums[1][c] += (v[c] / NOISE.std_dev[c]).powi(2) / f64::from(n);
                crossed[c] += v[c] * v[(c + 1) % 3] / (NOISE.std_dev[c] * NOISE.std_dev[(c + 1) % 3]) / f64::from(n);
            }
        }
        for c in 0..3 {
            assert!((sums[1][c] - 1.0).abs() < 0.028, "variance {c}: {}", sums[1][c]);
            // Means and covariances: 1/√n = 0.5 %.
            assert!(sums[0][c].abs() < 0.02 * NOISE.std_dev[c] && crossed[c].abs() < 0.02, "{sums:?} {crossed:?}");
        }
    }
}
