//! Rain-flow counting of load cycles and of the levels that a load exceeds.
//!
//! Written here: no counter was found in Rust that is released, kept and used; the rule is thirty lines, and the standard brings its own example
//! to test it by.

/// One closed loop or half of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle {
    /// Greatest less least.
    pub range: f64,
    /// Middle of greatest and least.
    pub mean: f64,
    /// 1, or 0.5 for a half cycle.
    pub count: f64,
}

impl Cycle {
    fn new(from: f64, to: f64, count: f64) -> Self {
        Self { range: (to - from).abs(), mean: 0.5 * (from + to), count }
    }
}

/// Cycles of a load history after ASTM E1049-85, section 5.4.4, in the order in which they close; what stays open counts half.
pub fn cycles(history: &[f64]) -> Vec<Cycle> {
    let mut open: Vec<f64> = Vec::new();
    let mut counted = Vec::new();
    for point in reversals(history) {
        open.push(point);
        while let [.., a, b, c] = open[..] {
            if (c - b).abs() < (b - a).abs() {
                break;
            }
            // A range that holds the history's starting point is half a cycle.
            let starts = open.len() == 3;
            counted.push(Cycle::new(a, b, if starts { 0.5 } else { 1.0 }));
            if starts {
                open.remove(0);
            } else {
                open.truncate(open.len() - 3);
                open.push(c);
            }
        }
    }
    counted.extend(open.windows(2).map(|pair| Cycle::new(pair[0], pair[1], 0.5)));
    counted
}

/// First point, peaks and valleys, last point; a plateau is one point.
fn reversals(history: &[f64]) -> Vec<f64> {
    let mut points: Vec<f64> = Vec::new();
    for &value in history.iter().filter(|value| value.is_finite()) {
        match points[..] {
            [.., last] if last == value => {}
            [.., before, last] if (last > before) == (value > last) => *points.last_mut().unwrap_or(&mut 0.0) = value,
            _ => points.push(value),
        }
    }
    points
}

/// Ranges from `from` up to `to`: how many cycles, and the mean of their means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    pub from: f64,
    pub to: f64,
    pub count: f64,
    pub mean: f64,
}

/// Cycles in `n` equal bins from nothing to the greatest range.
pub fn binned(cycles: &[Cycle], n: usize) -> Vec<Bin> {
    let greatest = cycles.iter().map(|cycle| cycle.range).fold(0.0, f64::max);
    let width = greatest / n as f64;
    let bin = |cycle: &Cycle| ((cycle.range / width) as usize).min(n - 1);
    (0..n)
        .map(|i| {
            let (mut count, mut sum) = (0.0, 0.0);
            for cycle in cycles.iter().filter(|cycle| bin(cycle) == i) {
                count += cycle.count;
                sum += cycle.count * cycle.mean;
            }
            Bin { from: i as f64 * width, to: (i + 1) as f64 * width, count, mean: if count > 0.0 { sum / count } else { 0.0 } }
        })
        .collect()
}

/// How often the values rise through a level, and how long they are above it, s, linear between rows.
pub fn exceedance(times: &[f64], values: &[f64], level: f64) -> (usize, f64) {
    let (mut crossings, mut above) = (0, 0.0);
    for (t, v) in times.windows(2).zip(values.windows(2)) {
        let (a, b) = (v[0] - level, v[1] - level);
        crossings += usize::from(a <= 0.0 && b > 0.0);
        let share = match (a > 0.0, b > 0.0) {
            (true, true) => 1.0,
            (false, false) => 0.0,
            _ => a.max(b) / (a - b).abs(),
        };
        above += share * (t[1] - t[0]);
    }
    (crossings, above)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ASTM E1049-85, figure 6 and its table: reversals A to I.
    const STANDARD: [f64; 9] = [-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0];

    #[test]
    fn exact_the_standard_s_example() {
        let found: Vec<_> = cycles(&STANDARD).iter().map(|c| (c.range, c.mean, c.count)).collect();
        let wanted =
            [(3.0, -0.5, 0.5), (4.0, -1.0, 0.5), (4.0, 1.0, 1.0), (8.0, 1.0, 0.5), (9.0, 0.5, 0.5), (8.0, 0.0, 0.5), (6.0, 1.0, 0.5)];
        assert_eq!(found, wanted);
        let per_range = |range: f64| cycles(&STANDARD).iter().filter(|c| c.range == range).map(|c| c.count).sum::<f64>();
        assert_eq!([3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0].map(per_range), [0.5, 1.5, 0.0, 0.5, 0.0, 1.0, 0.5, 0.0]);
    }

    #[test]
    fn exact_points_between_reversals_change_nothing() {
        let fine: Vec<f64> =
            STANDARD.windows(2).flat_map(|p| (0..4).map(move |k| p[0] + 0.25 * f64::from(k) * (p[1] - p[0]))).chain([-2.0]).collect();
        let plateaus: Vec<f64> = STANDARD.iter().flat_map(|&x| [x, x]).collect();
        assert_eq!(cycles(&fine), cycles(&STANDARD));
        assert_eq!(cycles(&plateaus), cycles(&STANDARD));
        assert!(cycles(&[7.0, 7.0]).is_empty() && cycles(&[]).is_empty());
    }

    #[test]
    fn exact_bins_keep_every_cycle() {
        let bins = binned(&cycles(&STANDARD), 3);
        assert_eq!(bins.iter().map(|b| b.count).collect::<Vec<_>>(), [0.0, 2.0, 2.0]);
        assert_eq!((bins[2].from, bins[2].to, bins[2].mean), (6.0, 9.0, 0.5 * (1.0 + 0.5 + 0.0 + 1.0) / 2.0));
    }

    #[test]
    fn exact_a_triangle_is_above_its_middle_for_half_the_time() {
        let (times, values) = ([0.0, 1.0, 2.0, 3.0, 4.0], [0.0, 2.0, 0.0, 2.0, 0.0]);
        assert_eq!(exceedance(&times, &values, 1.0), (2, 2.0));
        assert_eq!(exceedance(&times, &values, 1.5), (2, 1.0));
        assert_eq!(exceedance(&times, &values, 2.0), (0, 0.0));
    }
}
