//! The cable seen from starboard at a few instants.

use super::data::{DemoData, Drum};
use super::figures::Figure;
use crate::plots::{Chart, Mark, Panel, Series, WATER, sequential};

/// The cable seen from starboard at instants through the greatest swing of the ship, with the drum and the water.
pub fn side_view(data: &DemoData) -> Option<Figure> {
    let chart = Chart { equal_aspect: true, ..Chart::new("Side view of the cable", "x, m", vec![cable_panel(data, f64::INFINITY, 1)?]) };
    let caption = "The drum (circle, at the top right), the cable and the body at its end, seen from starboard in the inertial frame and to scale, \
                   but for the dot that marks the body. The first line is the calm, the others lie in the ship's greatest swing from a trough to the \
                   next crest: the drum rises by centimetres, the body hardly moves. The current flows towards \u{2212}x and fades with depth.";
    Some(Figure { file: "side-view", chart, caption: caption.to_owned() })
}

/// The same about the drum.
pub fn drum_view(data: &DemoData) -> Option<Figure> {
    let reach = 5.0 * data.drum?.radius;
    let chart = Chart { equal_aspect: true, ..Chart::new("Side view about the drum", "x, m", vec![cable_panel(data, reach, 2)?]) };
    let caption = "Trough, mean and crest from the figure above, as far as five radii from the drum's axis. The cable is \
                   fixed to the drum at the end of the spoke, lies on it and leaves it where its stiffness against bending lets it. While the \
                   ship rises, the drum turns so as to pay out. Drawn through the FMU's output points, on the drum along its surface.";
    Some(Figure { file: "drum-view", chart, caption: caption.to_owned() })
}

/// Cable, drum, body and water at every `stride`th of the instants, as far as they are within `reach` of the drum's axis. The calm is shown
/// with stride 1 only.
fn cable_panel(data: &DemoData, reach: f64, stride: usize) -> Option<Panel> {
    let points = (1..).take_while(|k| data.columns.contains_key(&format!("cable.point[{k}].x"))).count();
    if points < 2 {
        return None;
    }
    let near = reach.is_finite();
    let mut panel = Panel::new("z, m", Vec::new());
    if let Some(y) = data.waterline.filter(|_| !near) {
        panel.marks.push(Mark::Level { y, label: "water surface".to_owned(), colour: WATER });
    }
    let rows = instants(data);
    let shown = |i: usize| stride == 1 || i % stride == 1;
    for (i, &row) in rows.iter().enumerate().filter(|(i, _)| shown(*i)) {
        let colour = sequential(if rows.len() > 1 { i as f64 / (rows.len() - 1) as f64 } else { 0.0 });
        let cable: Vec<(f64, f64)> = (1..=points)
            .filter_map(|k| Some((data.at(&format!("cable.point[{k}].x"), row)?, data.at(&format!("cable.point[{k}].z"), row)?)))
            .collect();
        let mut line = cable.clone();
        let mut centre = (0.0, 0.0);
        if let Some(drum) = data.drum {
            centre = drum_centre(data, drum, row);
            panel.marks.push(Mark::Circle { centre, radius: drum.radius, colour });
            line = wound(&cable, centre, drum);
            let spoke = Series { points: vec![centre, cable[0]], ..Series::new("", &[], &[], colour) };
            panel.series.push(spoke.width(1.0));
        }
        let end = data.at("body.x", row).zip(data.at("body.z", row)).or(cable.last().copied());
        if let Some(centre) = end.filter(|_| !near) {
            panel.marks.push(Mark::Dot { centre, radius: 4.5, colour });
        }
        let time = format!("{:.2} s", data.times[row]);
        let label = if i == 0 { format!("{time} (calm)") } else { time };
        let mut curve = smoothed(&line);
        curve.retain(|p| (p.0 - centre.0).hypot(p.1 - centre.1) <= reach);
        panel.series.push(Series { points: curve, ..Series::new(&label, &[], &[], colour) }.width(1.7));
    }
    Some(panel)
}

/// Rows for the side view: the start, and five from the deepest trough of the ship's greatest swing to the crest after it (or, without a
/// ship, five at equal intervals).
fn instants(data: &DemoData) -> Vec<usize> {
    let last = data.times.len() - 1;
    let (from, to) = data.column("ship.z").and_then(greatest_rise).unwrap_or((last / 5, last));
    let mut rows: Vec<usize> = std::iter::once(0).chain((0..5).map(|i| from + (to - from) * i / 4)).collect();
    rows.dedup();
    rows
}

/// The trough and the crest after it between which the values rise most.
fn greatest_rise(values: &[f64]) -> Option<(usize, usize)> {
    let (mut best, mut trough) = (None, 0);
    for row in 1..values.len() {
        if values[row] <= values[row - 1] {
            trough = row;
        } else if best.is_none_or(|(a, b): (usize, usize)| values[row] - values[trough] > values[b] - values[a]) {
            best = Some((trough, row));
        }
    }
    best
}

/// The drum's axis in the inertial frame (x, z) at a row; angles z-y-x, y of the axis taken as zero.
fn drum_centre(data: &DemoData, drum: Drum, row: usize) -> (f64, f64) {
    let value = |name: &str| data.at(name, row).unwrap_or(0.0);
    let (roll, pitch, yaw) = (value("ship.roll"), value("ship.pitch"), value("ship.yaw"));
    let x = yaw.cos() * pitch.cos() * drum.x + (yaw.cos() * pitch.sin() * roll.cos() + yaw.sin() * roll.sin()) * drum.z;
    let z = -pitch.sin() * drum.x + pitch.cos() * roll.cos() * drum.z;
    (value("ship.x") + x, value("ship.z") + z)
}

/// The cable's points with the part on the drum filled in: from the first point along the drum to where the tangent to the first point beyond
/// it begins.
fn wound(cable: &[(f64, f64)], centre: (f64, f64), drum: Drum) -> Vec<(f64, f64)> {
    const FINENESS: f64 = 0.08;
    let arm = |p: (f64, f64)| (p.0 - centre.0, p.1 - centre.1);
    let Some(free) = cable.iter().position(|p| arm(*p).0.hypot(arm(*p).1) > 1.02 * drum.radius).filter(|free| *free > 0) else {
        return cable.to_vec();
    };
    let (first, beyond) = (arm(cable[0]), arm(cable[free]));
    let sense = if drum.clockwise { -1.0 } else { 1.0 };
    let leaves = beyond.1.atan2(beyond.0) - sense * (drum.radius / beyond.0.hypot(beyond.1)).acos();
    let begin = first.1.atan2(first.0);
    let turn = (sense * (leaves - begin)).rem_euclid(std::f64::consts::TAU);
    // Nearly a whole turn is a cable that leaves just before its first point.
    let turn = if turn > 6.0 { 0.0 } else { turn };
    let parts = (turn / FINENESS).ceil() as usize;
    let on_drum = (1..=parts).map(|i| {
        let (sin, cos) = (begin + sense * turn * i as f64 / parts as f64).sin_cos();
        (centre.0 + drum.radius * cos, centre.1 + drum.radius * sin)
    });
    std::iter::once(cable[0]).chain(on_drum).chain(cable[free..].iter().copied()).collect()
}

/// A smooth curve through points at uneven distances: cubic pieces over the chord length, slopes from the parabola through three points.
fn smoothed(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    const PARTS: usize = 8;
    let mut p: Vec<(f64, f64)> = points.to_vec();
    p.dedup();
    if p.len() < 3 {
        return p;
    }
    let n = p.len();
    let h: Vec<f64> = p.windows(2).map(|w| (w[1].0 - w[0].0).hypot(w[1].1 - w[0].1)).collect();
    let chord = |i: usize| ((p[i + 1].0 - p[i].0) / h[i], (p[i + 1].1 - p[i].1) / h[i]);
    let mix = |a: (f64, f64), b: (f64, f64), wa: f64, wb: f64| (wa * a.0 + wb * b.0, wa * a.1 + wb * b.1);
    let inner = |i: usize| mix(chord(i - 1), chord(i), h[i] / (h[i - 1] + h[i]), h[i - 1] / (h[i - 1] + h[i]));
    let slope = |i: usize| match i {
        0 => mix(chord(0), inner(1), 2.0, -1.0),
        i if i + 1 == n => mix(chord(n - 2), inner(n - 2), 2.0, -1.0),
        i => inner(i),
    };
    let mut curve = Vec::with_capacity(PARTS * n);
    for i in 0..n - 1 {
        let (a, b) = (slope(i), slope(i + 1));
        for part in 0..PARTS {
            let t = part as f64 / PARTS as f64;
            let (s0, s1) = (t * (1.0 - t) * (1.0 - t) * h[i], t * t * (t - 1.0) * h[i]);
            let w = t * t * (3.0 - 2.0 * t);
            let at = |p: f64, q: f64, a: f64, b: f64| p + w * (q - p) + s0 * a + s1 * b;
            curve.push((at(p[i].0, p[i + 1].0, a.0, b.0), at(p[i].1, p[i + 1].1, a.1, b.1)));
        }
    }
    curve.push(p[n - 1]);
    curve
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_drum_moves_with_the_ship() {
        let mut data = DemoData { times: vec![0.0], ..DemoData::default() };
        data.columns.insert("ship.x".into(), vec![1.0]);
        data.columns.insert("ship.pitch".into(), vec![std::f64::consts::FRAC_PI_2]);
        let (x, z) = drum_centre(&data, Drum { x: 2.0, z: 0.5, radius: 0.1, clockwise: false }, 0);
        // Bow straight down: forward becomes down, up becomes forward.
        assert!((x - 1.5).abs() < 1e-15 && (z + 2.0).abs() < 1e-15);
    }

    #[test]
    fn exact_smoothing_passes_through_the_points() {
        let points = [(0.0, 0.0), (1.0, 2.0), (3.0, 2.5), (4.0, 0.0)];
        let curve = smoothed(&points);
        for (i, p) in points.iter().enumerate() {
            assert_eq!(curve[8 * i], *p);
        }
        // On a circle with points at uneven distances it stays close to the circle.
        let circle: Vec<(f64, f64)> = [0.0, 0.1, 0.2, 0.5, 0.9, 1.0].map(|a: f64| (a.cos(), a.sin())).into();
        let farthest = smoothed(&circle).iter().map(|p| (p.0.hypot(p.1) - 1.0).abs()).fold(0.0, f64::max);
        assert!(farthest < 2e-3, "{farthest}");
        assert_eq!(smoothed(&points[..1]), points[..1]);
    }

    #[test]
    fn exact_the_cable_on_the_drum_follows_it_to_the_tangent() {
        let drum = Drum { x: 0.0, z: 0.0, radius: 1.0, clockwise: false };
        // From the right over the top to the left: a quarter turn, and off along the horizontal tangent.
        let line = wound(&[(1.0, 0.0), (-0.5, 0.75f64.sqrt()), (-3.0, 1.0), (-5.0, 0.5)], (0.0, 0.0), drum);
        let (on_drum, free) = line.split_at(line.len() - 2);
        assert!(on_drum.iter().all(|p| (p.0.hypot(p.1) - 1.0).abs() < 1e-12 && p.0 > -1e-12 && p.1 > -1e-12));
        let leaves = on_drum[on_drum.len() - 1];
        assert!(leaves.0.abs() < 1e-12 && (leaves.1 - 1.0).abs() < 1e-12, "{leaves:?}");
        assert_eq!(free, [(-3.0, 1.0), (-5.0, 0.5)]);
        // The mirror image.
        let mirrored = wound(&[(-1.0, 0.0), (3.0, 1.0)], (0.0, 0.0), Drum { clockwise: true, ..drum });
        let leaves = mirrored[mirrored.len() - 2];
        assert!(leaves.0.abs() < 1e-12 && (leaves.1 - 1.0).abs() < 1e-12);
        // A cable that begins beyond the drum is left alone.
        assert_eq!(wound(&[(2.0, 0.0), (3.0, 1.0)], (0.0, 0.0), drum), [(2.0, 0.0), (3.0, 1.0)]);
    }

    #[test]
    fn exact_the_greatest_rise_is_from_trough_to_crest() {
        assert_eq!(greatest_rise(&[0.0, 1.0, -1.0, 0.5, 1.5, 1.0, 2.0]), Some((2, 4)));
        assert_eq!(greatest_rise(&[0.0, 0.0]), None);
    }
}
