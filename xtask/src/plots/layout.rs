//! Where things go in a chart: ranges, ticks, legends, and paths with no more points than needed.

use super::Series;

/// Points that lie closer than this to the line without them are left out, px.
const TOLERANCE: f64 = 0.12;

/// Smallest and largest of the values.
pub(super) fn bounds(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |range, value| match range {
        None => Some((value, value)),
        Some((low, high)) => Some((f64::min(low, value), f64::max(high, value))),
    })
}

/// The range with 6 % of air on either side; a range of no extent (or of rounding noise) gets a sensible one.
pub(super) fn padded(low: f64, high: f64) -> (f64, f64) {
    let size = low.abs().max(high.abs());
    let extent = high - low;
    if extent <= 1e-9 * size || extent == 0.0 {
        let air = if size > 0.0 { 0.1 * size } else { 1.0 };
        return (low - air, high + air);
    }
    (low - 0.06 * extent, high + 0.06 * extent)
}

/// The range widened about its middle to the given extent.
pub(super) fn widened(range: (f64, f64), extent: f64) -> (f64, f64) {
    let (middle, half) = (0.5 * (range.0 + range.1), 0.5 * extent.max(range.1 - range.0));
    (middle - half, middle + half)
}

/// Round numbers in a range and how to write them.
pub(super) struct Ticks {
    pub(super) values: Vec<f64>,
    decimals: usize,
    exponent: bool,
}

impl Ticks {
    pub(super) fn label(&self, value: f64) -> String {
        let plain = if self.exponent && value != 0.0 { format!("{value:.1e}") } else { format!("{value:.*}", self.decimals) };
        plain.replace('-', "\u{2212}")
    }
}

/// At most about `count` multiples of 1, 2 or 5 times a power of ten.
pub(super) fn ticks(range: (f64, f64), count: f64) -> Ticks {
    let raw = (range.1 - range.0) / count.max(1.0);
    let power = 10f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * power).find(|step| *step >= raw * (1.0 - 1e-9)).unwrap_or(10.0 * power);
    let slack = 1e-6 * step;
    let (first, last) = (((range.0 - slack) / step).ceil() as i64, ((range.1 + slack) / step).floor() as i64);
    let size = range.0.abs().max(range.1.abs());
    Ticks {
        values: (first..=last).map(|i| i as f64 * step).collect(),
        decimals: (-(step * (1.0 + 1e-9)).log10().floor()).clamp(0.0, 12.0) as usize,
        exponent: !(1e-4..1e6).contains(&size),
    }
}

/// Where the legend's entries go: (series, x, row), and the number of rows. Text widths are estimates.
pub(super) fn legend_layout(series: &[Series], width: f64) -> (Vec<(usize, f64, usize)>, usize) {
    let (mut x, mut row) = (0.0, 0);
    let mut places = Vec::new();
    for (i, entry) in series.iter().enumerate().filter(|(_, entry)| !entry.label.is_empty()) {
        let needed = 31.0 + text_width(&entry.label, 12.5) + 22.0;
        if x > 0.0 && x + needed > width {
            (x, row) = (0.0, row + 1);
        }
        places.push((i, x, row));
        x += needed;
    }
    let rows = if places.is_empty() { 0 } else { row + 1 };
    (places, rows)
}

/// Estimated width of a sans-serif text, px; rather too wide than too narrow.
fn text_width(text: &str, size: f64) -> f64 {
    let em = |c: char| match c {
        'i' | 'j' | 'l' | '.' | ',' | ' ' | '\'' | '|' | ':' => 0.33,
        'f' | 't' | 'r' | '(' | ')' | '-' => 0.42,
        'm' | 'w' | 'M' | 'W' => 0.95,
        c if c.is_uppercase() => 0.72,
        _ => 0.62,
    };
    text.chars().map(em).sum::<f64>() * size
}

/// The path without points that lie within [`TOLERANCE`] of the chord that replaces them (Ramer-Douglas-Peucker).
pub(super) fn simplified(path: &[(f64, f64)]) -> Vec<(f64, f64)> {
    if path.len() < 3 {
        return path.to_vec();
    }
    let mut keep = vec![false; path.len()];
    keep[0] = true;
    keep[path.len() - 1] = true;
    let mut open = vec![(0, path.len() - 1)];
    while let Some((from, to)) = open.pop() {
        let (a, b) = (path[from], path[to]);
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let length_squared = dx * dx + dy * dy;
        let distance_squared = |p: (f64, f64)| {
            let t = if length_squared > 0.0 { (((p.0 - a.0) * dx + (p.1 - a.1) * dy) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
            (p.0 - a.0 - t * dx).powi(2) + (p.1 - a.1 - t * dy).powi(2)
        };
        let farthest = (from + 1..to).map(|i| (i, distance_squared(path[i]))).max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((i, _)) = farthest.filter(|(_, d)| *d > TOLERANCE * TOLERANCE) {
            keep[i] = true;
            open.push((from, i));
            open.push((i, to));
        }
    }
    path.iter().zip(keep).filter(|(_, kept)| *kept).map(|(p, _)| *p).collect()
}

/// The path cut into dashes of `on` pixels with gaps of `off`.
pub(super) fn dashes(path: &[(f64, f64)], on: f64, off: f64) -> Vec<Vec<(f64, f64)>> {
    let mut pieces: Vec<Vec<(f64, f64)>> = Vec::new();
    let Some(&first) = path.first() else { return pieces };
    let (mut drawing, mut left) = (true, on);
    let mut current = vec![first];
    for pair in path.windows(2) {
        let (mut a, b) = (pair[0], pair[1]);
        let mut length = (b.0 - a.0).hypot(b.1 - a.1);
        while length > left {
            let t = left / length;
            a = (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1));
            length -= left;
            if drawing {
                current.push(a);
                pieces.push(std::mem::take(&mut current));
            } else {
                current = vec![a];
            }
            drawing = !drawing;
            left = if drawing { on } else { off };
        }
        left -= length;
        if drawing {
            current.push(b);
        }
    }
    if current.len() > 1 {
        pieces.push(current);
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plots::wave;

    #[test]
    fn exact_round_ticks() {
        let t = ticks((0.0, 60.0), 9.0);
        assert_eq!(t.values, [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0]);
        assert_eq!(t.label(-10.0), "\u{2212}10");
        let fine = ticks((-0.0123, 0.031), 5.0);
        assert_eq!(fine.values.iter().map(|v| fine.label(*v)).collect::<Vec<_>>(), ["\u{2212}0.01", "0.00", "0.01", "0.02", "0.03"]);
        assert_eq!(ticks((0.0, 1.0), 5.0).label(0.2), "0.2");
        assert!(ticks((0.0, 3e7), 5.0).label(1e7).contains('e'));
    }

    #[test]
    fn exact_simplification_stays_within_tolerance_and_is_short() {
        let (x, y) = wave();
        let path: Vec<(f64, f64)> = x.iter().zip(&y).map(|(x, y)| (12.0 * x, 80.0 * y)).collect();
        let short = simplified(&path);
        assert!(short.len() < 900, "{}", short.len());
        let at = |t: f64| {
            let i = short.partition_point(|p| p.0 < t).clamp(1, short.len() - 1);
            let (a, b) = (short[i - 1], short[i]);
            (a.1 + (b.1 - a.1) * (t - a.0) / (b.0 - a.0), (b.1 - a.1) / (b.0 - a.0))
        };
        for p in &path {
            let (value, slope) = at(p.0);
            // Vertical distance of a point whose distance to the line is the tolerance.
            assert!((value - p.1).abs() <= TOLERANCE * slope.hypot(1.0) * 1.0001);
        }
    }

    #[test]
    fn exact_dashes_cover_their_share() {
        let pieces = dashes(&[(0.0, 0.0), (35.0, 0.0), (100.0, 0.0)], 6.0, 4.0);
        let drawn: f64 = pieces.iter().map(|p| p.last().unwrap().0 - p[0].0).sum();
        assert!((drawn - 60.0).abs() < 1e-9 && pieces.len() == 10, "{drawn} {}", pieces.len());
    }
}
