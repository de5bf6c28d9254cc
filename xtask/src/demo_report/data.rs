//! What a demo's run recorded, and what is computed from such a record.

use std::collections::BTreeMap;

/// The winch drum, in ship axes; its axis lies athwart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drum {
    /// Axis' position forward, m.
    pub x: f64,
    /// Axis' position upward, m.
    pub z: f64,
    /// Radius to the cable's centreline, m.
    pub radius: f64,
    /// Whether the cable runs clockwise over the drum on its way out, seen from starboard (x to the right).
    pub clockwise: bool,
}

/// Everything the report shows.
#[derive(Debug, Clone, Default)]
pub struct DemoData {
    /// Times of the rows, s: the start and every communication point.
    pub times: Vec<f64>,
    /// All recorded variables by their FMU names, SI units, one value a row. What is missing is left out of the report.
    pub columns: BTreeMap<String, Vec<f64>>,
    /// The same of a second run with the winch held still, for comparison; may be empty.
    pub held: BTreeMap<String, Vec<f64>>,
    /// The winch drum, where the scene has one.
    pub drum: Option<Drum>,
    /// Height of the water surface, where the scene has a fluid, m.
    pub waterline: Option<f64>,
    /// Wall-clock time spent in the FMU's functions for inputs, steps and outputs, s.
    pub wall_seconds: f64,
    /// Further facts about the run for the table, in order: scene, ship, sea, seed, communication step, ... as (what, value).
    pub facts: Vec<(String, String)>,
    /// A page that shows the cable moving.
    pub animation: Option<String>,
    /// Processor and system on which it ran.
    pub machine: String,
}

impl DemoData {
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.columns.get(name).map(Vec::as_slice)
    }

    /// One value of a column.
    pub fn at(&self, name: &str, row: usize) -> Option<f64> {
        self.column(name).map(|values| values[row])
    }

    pub fn simulated(&self) -> f64 {
        match (self.times.first(), self.times.last()) {
            (Some(first), Some(last)) => last - first,
            _ => 0.0,
        }
    }

    /// The final value of a running count.
    pub fn total(&self, name: &str) -> Option<f64> {
        self.column(name)?.last().copied()
    }
}

/// Standard deviation about the mean.
pub fn deviation(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt()
}

/// Mean increment from row to row of a running count, over about a hundred stretches of the record: their middles and the means.
pub fn mean_increments(times: &[f64], running: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let rows = running.len() - 1;
    let stretches = rows.min(100);
    (0..stretches)
        .map(|i| {
            let (from, to) = (i * rows / stretches, (i + 1) * rows / stretches);
            (0.5 * (times[from] + times[to]), (running[to] - running[from]) / (to - from) as f64)
        })
        .unzip()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_statistics_of_a_record() {
        assert_eq!(deviation(&[1.0, 3.0]), 1.0);
        assert_eq!(mean_increments(&[0.0, 1.0, 2.0], &[0.0, 2.0, 5.0]), (vec![0.5, 1.5], vec![2.0, 3.0]));
        assert_eq!(mean_increments(&[0.0], &[3.0]), (vec![], vec![]));
        let count: Vec<f64> = (0..1001).map(|i| 2.0 * i as f64).collect();
        assert_eq!(mean_increments(&count, &count).1, vec![2.0; 100]);
    }
}
