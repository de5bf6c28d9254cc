//! When Newton's method with kept factors has converged, and when it will not (E. Hairer & G. Wanner, Solving Ordinary Differential
//! Equations II, section IV.8).

/// What is left may be this share of the tolerable error.
const KAPPA: f64 = 0.05;
/// Iterations of a stage, unless more are allowed.
const MOST: usize = 8;
/// A method that converges slower does not converge.
const HOPELESS: f64 = 0.9;
/// A slower rate of convergence asks for a new tangent.
pub const SLOW: f64 = 0.1;

/// How a stage ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Well.
    Converged,
    /// It would take too long.
    Stalled,
    /// Numbers overflowed.
    NotFinite,
}

/// Iterations of a stage.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// So many are done.
    pub count: usize,
    /// Rate of convergence: of this stage, or guessed from those before; 0 is unknown.
    pub rate: f64,
    /// So many may be done.
    most: usize,
    last: f64,
}

impl Progress {
    /// A stage begins; earlier ones converged at `rate`, 0 if there were none with these factors.
    pub fn new(rate: f64) -> Self {
        // An old rate is worth less than a new one; once it is worth nothing it is measured anew.
        let guess = rate.powf(0.8);
        let rate = if rate <= SLOW && guess > SLOW { 0.0 } else { guess };
        Self { count: 0, rate, most: MOST, last: f64::INFINITY }
    }

    /// With another limit.
    pub fn of_most(self, most: usize) -> Self {
        Self { most, ..self }
    }

    /// An iteration has changed the stage by `size` tolerable errors.
    pub fn judge(&mut self, size: f64) -> Option<Outcome> {
        self.count += 1;
        if !size.is_finite() {
            return Some(Outcome::NotFinite);
        }
        if self.count > 1 {
            let rate = size / self.last;
            self.rate = if self.count == 2 { rate } else { rate.max(self.rate) };
        }
        self.last = size;
        // So little cannot be told from rounding, so says nothing of the rate.
        if size < 1e-3 * KAPPA {
            return Some(Outcome::Converged);
        }
        if self.count > 1 && self.rate > HOPELESS || self.count == self.most {
            return Some(Outcome::Stalled);
        }
        (self.rate > 0.0 && self.rate < 1.0 && size * self.rate / (1.0 - self.rate) < KAPPA).then_some(Outcome::Converged)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(rate: f64, sizes: impl IntoIterator<Item = f64>) -> (Outcome, usize, f64) {
        let mut progress = Progress::new(rate);
        for size in sizes {
            if let Some(outcome) = progress.judge(size) {
                return (outcome, progress.count, progress.rate);
            }
        }
        panic!("no outcome");
    }

    /// Each stage that one iteration solves tells nothing of the rate. It grows older, is measured again by a second iteration, and never grows
    /// into a slow one, which would cost a tangent.
    #[test]
    fn exact_old_rates_are_measured_anew() {
        let (mut rate, mut counts) = (1e-6, vec![]);
        for _ in 0..60 {
            let (outcome, count, now) = run(rate, (0..20).map(|k| 1e-2 * 1e-6f64.powi(k)));
            assert_eq!(outcome, Outcome::Converged);
            assert!(now <= SLOW, "{now}");
            rate = now;
            counts.push(count);
        }
        let seconds = counts.iter().filter(|c| **c == 2).count();
        assert!((2..=10).contains(&seconds) && counts.iter().all(|c| *c <= 2), "{counts:?}");
        // A rate that was measured to be slow stays so.
        assert!(Progress::new(0.2).rate > SLOW);
    }

    #[test]
    fn exact_stages_end_when_what_is_left_is_small() {
        let falling = |from: f64, rate: f64| (0..20).map(move |k| from * rate.powi(k));
        // Nothing is known of the rate: two iterations at least.
        assert_eq!(run(0.0, falling(1.0, 0.01)), (Outcome::Converged, 2, 0.01));
        // 0.5^k / (1 − 0.5) · 0.5 < 0.05 from k = 5 on.
        let (outcome, count, rate) = run(0.0, falling(1.0, 0.5));
        assert_eq!((outcome, count), (Outcome::Converged, 6));
        assert!((rate - 0.5).abs() < 1e-12);
        // A known rate may do with one.
        assert_eq!(run(1e-3, falling(1.0, 1e-3)).1, 1);
        assert_eq!(run(0.0, falling(1.0, 0.95)).0, Outcome::Stalled);
        assert_eq!((run(0.0, falling(1e6, 0.7)).0, run(0.0, falling(1e6, 0.7)).1), (Outcome::Stalled, 8));
        assert_eq!(run(0.1, [1.0, f64::NAN]).0, Outcome::NotFinite);
    }
}
