//! Periods of a swing from its samples.

use super::root;

/// Mean period from the zero crossings of samples (t, x, ẋ), each the root of the cubic through both ends of its step.
#[derive(Default)]
pub struct Crossings {
    before: Option<[f64; 3]>,
    times: Vec<f64>,
}

impl Crossings {
    /// The next sample.
    pub fn sample(&mut self, now: [f64; 3]) {
        if let Some(a) = self.before
            && a[1] * now[1] < 0.0
        {
            let (h, b) = (now[0] - a[0], now);
            let cubic = |x: f64| {
                let y = 1.0 - x;
                y * y * ((1.0 + 2.0 * x) * a[1] + x * h * a[2]) + x * x * ((1.0 + 2.0 * y) * b[1] - y * h * b[2])
            };
            self.times.push(a[0] + h * root(cubic, 0.0, 1.0));
        }
        self.before = Some(now);
    }

    /// Twice the mean time from crossing to crossing; needs two.
    pub fn period(&self) -> f64 {
        let swings = self.times.len() - 1;
        2.0 * (self.times[swings] - self.times[0]) / swings as f64
    }
}
