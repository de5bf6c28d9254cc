//! What a run is compared by: tension and, where a scene has it, a place, over time.

use super::numerics::relative_rms;
use crate::error::{Failure, Result};

/// Two samples are of one time if they are no further apart, s.
const SAME: f64 = 1e-6;

/// A run's samples, or the truth's.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Track {
    /// Ascending, s.
    pub times: Vec<f64>,
    /// N.
    pub tension: Vec<f64>,
    /// A point in the scene's plane, m, or an angle, rad, and zero. Empty where the scene compares none.
    pub place: Vec<[f64; 2]>,
}

/// How far a run is from the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Off {
    /// Tension, rms of the difference over the truth's rms.
    pub tension: f64,
    /// Place, rms of the distance, m or rad.
    pub place: Option<f64>,
}

impl Track {
    /// The error at the truth's times from `from` on, s; the start itself is given, not computed, and does not count.
    ///
    /// # Errors
    /// A time of the truth at which there is no sample.
    pub fn off(&self, truth: &Track, from: f64) -> Result<Off> {
        let (mut tension, mut distance) = (Vec::new(), Vec::new());
        let mut own = 0;
        for (k, time) in truth.times.iter().enumerate().filter(|(_, t)| **t > SAME && **t >= from - SAME) {
            own += self.times[own..].iter().take_while(|t| **t < time - SAME).count();
            if self.times.get(own).is_none_or(|t| (t - time).abs() > SAME) {
                return Err(Failure(format!("no sample at {time} s; expected one at every time of the truth")));
            }
            tension.push((self.tension[own], truth.tension[k]));
            if let (Some(a), Some(b)) = (self.place.get(own), truth.place.get(k)) {
                distance.push((a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2));
            }
        }
        if tension.is_empty() {
            return Err(Failure(format!("the truth has no sample after {from} s")));
        }
        let place = (!distance.is_empty()).then(|| (distance.iter().sum::<f64>() / distance.len() as f64).sqrt());
        Ok(Off { tension: relative_rms(&tension), place })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn track(times: &[f64], tension: &[f64], place: &[[f64; 2]]) -> Track {
        Track { times: times.into(), tension: tension.into(), place: place.into() }
    }

    #[test]
    fn exact_errors_at_the_truths_times() {
        let truth = track(&[0.0, 0.2, 0.4], &[9.0, 3.0, 4.0], &[[0.0; 2], [1.0, 1.0], [2.0, 2.0]]);
        let own = track(&[0.0, 0.1, 0.2, 0.3, 0.4], &[0.0, 7.0, 3.0, 7.0, 4.5], &[[9.0; 2], [9.0; 2], [1.0, 1.0], [9.0; 2], [5.0, 6.0]]);
        // Of the tension 0.5 off in √(9 + 16); of the place 5 m off in one of two. The start and what lies between do not count.
        let off = own.off(&truth, 0.0).unwrap();
        assert!((off.tension - 0.1).abs() < 1e-15 && (off.place.unwrap() - 12.5f64.sqrt()).abs() < 1e-15, "{off:?}"); // rounding
        assert!((own.off(&truth, 0.3).unwrap().tension - 0.125).abs() < 1e-15);
        let without = Track { place: vec![], ..own.clone() };
        assert_eq!(without.off(&truth, 0.0).unwrap().place, None);
        let short = track(&[0.0, 0.2], &[0.0, 3.0], &[]);
        assert_eq!(short.off(&truth, 0.0).unwrap_err().0, "no sample at 0.4 s; expected one at every time of the truth");
        assert!(own.off(&truth, 1.0).is_err());
    }
}
