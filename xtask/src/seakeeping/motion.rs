//! The ship's motion in time: a sum of cosines under a ramp, with analytic derivatives.

use super::rao::{Course, Hull, responses};
use super::spectrum::WaveComponent;

/// Pose, velocity and acceleration at one instant. Order: x, y, z (m), roll, pitch, yaw (rad); derivatives with respect to time of
/// these six numbers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct State {
    /// Position and angles.
    pub pose: [f64; 6],
    /// First derivatives.
    pub velocity: [f64; 6],
    /// Second derivatives.
    pub acceleration: [f64; 6],
}

/// One wave's contribution to the six motions.
#[derive(Debug, Clone, Copy)]
struct Term {
    /// Encounter frequency, rad/s.
    omega: f64,
    /// The six motions are `cosine · cos(ωt) + sine · sin(ωt)`.
    cosine: [f64; 6],
    sine: [f64; 6],
}

/// A ship's motion as a function of time: evaluate it anywhere, the same for every sampling step.
#[derive(Debug, Clone)]
pub struct ShipMotion {
    terms: Vec<Term>,
    ramp: f64,
    origin: [f64; 3],
}

impl ShipMotion {
    /// The motion of `hull` on `course` in a sea of `waves`, about the ship's mean position.
    ///
    /// The sea and the ship are full-scale. `scale` is Froude's length scale λ: lengths are divided by λ, times by √λ, angles and
    /// accelerations stay. `ramp` (s) and `origin` (m) are those of the result, at model scale.
    pub fn new(hull: &Hull, course: &Course, waves: &[WaveComponent], scale: f64, ramp: f64, origin: [f64; 3]) -> ShipMotion {
        let terms = waves
            .iter()
            .map(|wave| {
                let mut term = Term { omega: course.encounter(wave.omega) * scale.sqrt(), cosine: [0.0; 6], sine: [0.0; 6] };
                for (mode, response) in responses(hull, course, wave.omega).iter().enumerate() {
                    let amplitude = wave.amplitude * response.amplitude / if mode < 3 { scale } else { 1.0 };
                    let (sin, cos) = (wave.phase + response.phase).sin_cos();
                    term.cosine[mode] = amplitude * cos;
                    term.sine[mode] = -amplitude * sin;
                }
                term
            })
            .collect();
        ShipMotion { terms, ramp, origin }
    }

    /// Pose, velocity and acceleration at time `t` ≥ 0, s.
    pub fn state(&self, t: f64) -> State {
        let mut free = State::default();
        for term in &self.terms {
            let (sin, cos) = (term.omega * t).sin_cos();
            for mode in 0..6 {
                let value = term.cosine[mode] * cos + term.sine[mode] * sin;
                free.pose[mode] += value;
                free.velocity[mode] += term.omega * (term.sine[mode] * cos - term.cosine[mode] * sin);
                free.acceleration[mode] -= term.omega * term.omega * value;
            }
        }
        let [r, r1, r2] = smooth_ramp(t, self.ramp);
        let mut state = State::default();
        for mode in 0..6 {
            let [p, v, a] = [free.pose[mode], free.velocity[mode], free.acceleration[mode]];
            state.pose[mode] = r * p + if mode < 3 { self.origin[mode] } else { 0.0 };
            state.velocity[mode] = r1 * p + r * v;
            state.acceleration[mode] = r2 * p + 2.0 * r1 * v + r * a;
        }
        state
    }
}

/// The septic smoothstep 35u⁴ − 84u⁵ + 70u⁶ − 20u⁷ in u = t/duration and its first two time derivatives: three continuous derivatives, so
/// pose, velocity, acceleration and jerk all start at zero. A duration of zero means no ramp.
fn smooth_ramp(t: f64, duration: f64) -> [f64; 3] {
    if duration <= 0.0 || t >= duration {
        return [1.0, 0.0, 0.0];
    }
    let u = t / duration;
    let w = 1.0 - u;
    let value = u.powi(4) * (35.0 + u * (-84.0 + u * (70.0 - 20.0 * u)));
    let first = 140.0 * (u * w).powi(3) / duration;
    let second = 420.0 * (u * w).powi(2) * (1.0 - 2.0 * u) / (duration * duration);
    [value, first, second]
}

#[cfg(test)]
mod tests {
    use super::super::spectrum::SeaState;
    use super::*;

    fn sample(scale: f64, ramp: f64) -> ShipMotion {
        let sea = SeaState { significant_height: 2.0, peak_period: 8.0, gamma: 3.3 };
        let hull = Hull::from_dimensions(80.0, 18.0, 5.0, 0.7);
        ShipMotion::new(&hull, &Course::new(130.0, 4.0), &sea.components(120, 9), scale, ramp, [0.0; 3])
    }

    /// Largest absolute value of each channel over the record, to measure errors against.
    fn peaks(motion: &ShipMotion) -> State {
        let mut peak = State::default();
        for i in 0..2000 {
            let s = motion.state(0.1 * i as f64);
            for m in 0..6 {
                peak.pose[m] = peak.pose[m].max(s.pose[m].abs());
                peak.velocity[m] = peak.velocity[m].max(s.velocity[m].abs());
                peak.acceleration[m] = peak.acceleration[m].max(s.acceleration[m].abs());
            }
        }
        peak
    }

    #[test]
    fn exact_velocity_and_acceleration_are_derivatives() {
        let motion = sample(1.0, 20.0);
        let peak = peaks(&motion);
        // Fourth-order central differences: truncation h⁴ω⁵/30 and rounding ε/h are both below 1e-9 of the peak.
        let h = 2e-3;
        for i in 1..400 {
            let t = 0.213 * i as f64;
            let s: Vec<State> = [-2.0, -1.0, 1.0, 2.0].iter().map(|j| motion.state(t + j * h)).collect();
            let here = motion.state(t);
            let d = |f: fn(&State) -> &[f64; 6], m: usize| (f(&s[0])[m] - 8.0 * f(&s[1])[m] + 8.0 * f(&s[2])[m] - f(&s[3])[m]) / (12.0 * h);
            for m in 0..6 {
                assert!((d(|s| &s.pose, m) - here.velocity[m]).abs() < 1e-6 * peak.velocity[m], "mode {m} at {t}");
                assert!((d(|s| &s.velocity, m) - here.acceleration[m]).abs() < 1e-6 * peak.acceleration[m], "mode {m} at {t}");
            }
        }
    }

    #[test]
    fn exact_start_from_rest() {
        let start = sample(1.0, 5.0).state(0.0);
        assert_eq!(start.pose, [0.0; 6]);
        assert_eq!(start.velocity, [0.0; 6]);
        assert_eq!(start.acceleration, [0.0; 6]);
        // Without a ramp the ship is in full swing at once.
        assert_ne!(sample(1.0, 0.0).state(0.0), State::default());
    }

    #[test]
    fn exact_ramp_joins_smoothly() {
        for [value, first, second] in [smooth_ramp(5.0 - 1e-9, 5.0), smooth_ramp(5.0, 5.0)] {
            assert!((value - 1.0).abs() < 1e-12 && first.abs() < 1e-12 && second.abs() < 1e-12);
        }
        assert_eq!(smooth_ramp(2.5, 5.0)[0], 0.5);
        assert_eq!(sample(1.0, 5.0).state(7.0), sample(1.0, 0.0).state(7.0));
    }

    /// λ = 4 scales lengths by 4 and times by 2; both are powers of two, so equality holds bit for bit.
    #[test]
    fn exact_froude_scaling() {
        let (full, model) = (sample(1.0, 20.0), sample(4.0, 10.0));
        for i in 0..300 {
            let t = 0.37 * i as f64;
            let (ship, small) = (full.state(t), model.state(t / 2.0));
            for m in 0..6 {
                let length = if m < 3 { 4.0 } else { 1.0 };
                assert_eq!(small.pose[m] * length, ship.pose[m]);
                assert_eq!(small.velocity[m] * length / 2.0, ship.velocity[m]);
                assert_eq!(small.acceleration[m] * length / 4.0, ship.acceleration[m]);
            }
        }
    }

    /// Over a long record the heave variance is that of the components.
    #[test]
    fn exact_variance_of_the_record() {
        let motion = sample(1.0, 0.0);
        let n = 200_000;
        let mean_square = (0..n).map(|i| motion.state(0.5 * i as f64).pose[2].powi(2)).sum::<f64>() / n as f64;
        let spectral: f64 = motion.terms.iter().map(|t| 0.5 * (t.cosine[2].powi(2) + t.sine[2].powi(2))).sum();
        // Neighbouring components beat slowly; a day of record averages that to about a percent.
        assert!((mean_square / spectral - 1.0).abs() < 0.02, "{mean_square} {spectral}");
    }
}
