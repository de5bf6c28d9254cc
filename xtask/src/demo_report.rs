//! The demo's report: a page with figures of what was simulated, and each figure as an SVG file of its own.

use crate::error::Failure;
use crate::html_report::Page;
use crate::plots::{Chart, INK, Mark, PALETTE, Panel, Series, WATER, sequential};
use std::collections::BTreeMap;
use std::path::Path;

/// Instants shown in the side view.
const INSTANTS: usize = 6;

/// The winch drum, in ship axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drum {
    /// Axis' position forward, m.
    pub x: f64,
    /// Axis' position upward, m.
    pub z: f64,
    /// Radius, m.
    pub radius: f64,
}

/// Everything the report shows.
#[derive(Debug, Clone, Default)]
pub struct DemoData {
    /// Times of the rows, s: the start and every communication point.
    pub times: Vec<f64>,
    /// All recorded variables by their FMU names, SI units, one value a row. What is missing is left out of the report.
    pub columns: BTreeMap<String, Vec<f64>>,
    /// The winch drum, where the scene has one.
    pub drum: Option<Drum>,
    /// Height of the water surface, where the scene has a fluid, m.
    pub waterline: Option<f64>,
    /// Wall-clock time spent in fmi2DoStep, s.
    pub wall_seconds: f64,
    /// Further facts about the run for the table, in order: scene, ship, sea, seed, communication step, ... as (what, value).
    pub facts: Vec<(String, String)>,
    /// Processor and system on which it ran.
    pub machine: String,
}

impl DemoData {
    fn column(&self, name: &str) -> Option<&[f64]> {
        self.columns.get(name).map(Vec::as_slice)
    }

    /// One value of a column.
    fn at(&self, name: &str, row: usize) -> Option<f64> {
        self.column(name).map(|values| values[row])
    }

    fn simulated(&self) -> f64 {
        match (self.times.first(), self.times.last()) {
            (Some(first), Some(last)) => last - first,
            _ => 0.0,
        }
    }

    /// A panel of those of the named variables that exist, `(variable, label)`, in a unit that suits their size.
    fn panel(&self, quantity: &str, unit: &Unit, lines: &[(&str, &str)]) -> Option<Panel> {
        let found: Vec<(&str, &[f64])> = lines.iter().filter_map(|(name, label)| Some((*label, self.column(name)?))).collect();
        let (symbol, factor) = unit.fitting(found.iter().flat_map(|(_, values)| values.iter().copied()));
        let series: Vec<Series> = found
            .iter()
            .zip(PALETTE)
            .map(|((label, values), colour)| Series::new(label, &self.times, &times(values, factor), colour))
            .collect();
        (!series.is_empty()).then(|| Panel::new(&format!("{quantity}, {symbol}"), series))
    }
}

/// A unit and its smaller or larger relatives: (symbol, how many of it make one SI unit), smallest first.
struct Unit(&'static [(&'static str, f64)]);

const LENGTH: Unit = Unit(&[("mm", 1e3), ("m", 1.0)]);
const FORCE: Unit = Unit(&[("mN", 1e3), ("N", 1.0), ("kN", 1e-3)]);
const ANGLE: Unit = Unit(&[("°", 180.0 / std::f64::consts::PI)]);
const ANGULAR_RATE: Unit = Unit(&[("rad/s", 1.0)]);

impl Unit {
    /// The smallest unit in which the values stay below 300.
    fn fitting(&self, values: impl Iterator<Item = f64>) -> (&'static str, f64) {
        let largest = values.filter(|v| v.is_finite()).fold(0.0, |m: f64, v| m.max(v.abs()));
        *self.0.iter().find(|(_, factor)| largest * factor < 300.0).unwrap_or(&self.0[self.0.len() - 1])
    }
}

/// Writes `index.html` and one SVG file a figure into `dir`, which is made if it does not exist.
///
/// # Errors
/// Columns of a wrong length, and files that cannot be written.
pub fn write(data: &DemoData, dir: &Path) -> Result<(), Failure> {
    for (name, values) in &data.columns {
        if values.len() != data.times.len() {
            return Err(Failure(format!("{name}: {} values, expected {}, one a time", values.len(), data.times.len())));
        }
    }
    if data.times.is_empty() {
        return Err(Failure("the demo's results: no rows, expected at least one".to_owned()));
    }
    let save = |name: &str, text: &str| {
        let path = dir.join(name);
        std::fs::write(&path, text).map_err(|error| Failure(format!("{}: cannot be written: {error}", path.display())))
    };
    std::fs::create_dir_all(dir).map_err(|error| Failure(format!("{}: cannot be made: {error}", dir.display())))?;

    let mut page = Page::new("fairlead: a towed cable, reeled by a winch on a moving ship");
    page.paragraph(
        "A packed FMU was driven through its FMI 2.0 interface over the motion of a ship in an irregular sea. The winch follows \
         its set-point; the cable hangs from the drum into the water, where a current carries the body at its end.",
    );
    page.tiles(&key_figures(data));
    let figures = figures(data);
    for figure in &figures {
        let svg = figure.chart.svg();
        save(&format!("{}.svg", figure.file), &svg)?;
        page.figure(&svg, &figure.caption);
    }
    page.heading("Extremes").table(&["Variable", "Least", "Mean", "Greatest", "Unit"], &extremes(data));
    page.heading("The run").table(&[], &run_table(data));
    save("index.html", &page.html())
}

/// A chart with its file name and caption.
struct Figure {
    file: &'static str,
    chart: Chart,
    caption: String,
}

fn figures(data: &DemoData) -> Vec<Figure> {
    [side_view(data), ship_motion(data), winch(data), tension(data), close_up(data), body(data), body_path(data), solver(data)]
        .into_iter()
        .flatten()
        .collect()
}

/// A chart over time of the panels that exist.
fn over_time(file: &'static str, title: &str, panels: Vec<Option<Panel>>, caption: &str) -> Option<Figure> {
    let panels: Vec<Panel> = panels.into_iter().flatten().collect();
    (!panels.is_empty()).then(|| Figure { file, chart: Chart::new(title, "Time, s", panels), caption: caption.to_owned() })
}

fn ship_motion(data: &DemoData) -> Option<Figure> {
    let position = data.panel("Position", &LENGTH, &[("ship.x", "surge"), ("ship.y", "sway"), ("ship.z", "heave")]);
    let angles = data.panel("Angle", &ANGLE, &[("ship.roll", "roll"), ("ship.pitch", "pitch"), ("ship.yaw", "yaw")]);
    let caption = "Six degrees of freedom of the ship frame. x points forward, y to port, z up; positive pitch is bow down.";
    over_time("ship-motion", "Ship motion", vec![position, angles], caption)
}

/// Drum angle and set-point. They lie on each other when the winch does its work: the one dashed on top of the other shows both.
fn followed(data: &DemoData) -> Option<Panel> {
    let degrees = |values: &[f64]| times(values, 180.0 / std::f64::consts::PI);
    let mut series = vec![Series::new("drum angle", &data.times, &degrees(data.column("winch.angle")?), PALETTE[5]).width(3.4)];
    if let Some(setpoint) = data.column("winch.setpoint") {
        series.push(Series::new("set-point", &data.times, &degrees(setpoint), INK).dashed().width(1.3));
    }
    Some(Panel::new("Drum angle, °", series))
}

fn winch(data: &DemoData) -> Option<Figure> {
    let error = data.column("winch.angle").zip(data.column("winch.setpoint")).map(|(angle, setpoint)| {
        let error: Vec<f64> = setpoint.iter().zip(angle).map(|(s, a)| (s - a).to_degrees()).collect();
        Panel::new("Error, °", vec![Series::new("", &data.times, &error, PALETTE[1])]).height(120.0)
    });
    let rate = data.panel("Drum rate", &ANGULAR_RATE, &[("winch.rate", "")]).map(|panel| panel.height(120.0));
    over_time(
        "winch",
        "Winch angle and set-point",
        vec![followed(data), error, rate],
        "How the drum follows the set-point it is given. Error: set-point minus drum angle.",
    )
}

fn tensions(data: &DemoData) -> Option<Panel> {
    let lines = [("winch.tension", "at the winch"), ("anchor.tension", "at the anchor"), ("body.tension", "at the body")];
    data.panel("Tension", &FORCE, &lines)
}

fn tension(data: &DemoData) -> Option<Figure> {
    let panel = tensions(data).map(|panel| panel.height(260.0));
    over_time("tension", "Cable tension", vec![panel], "Tension where the cable leaves the drum, and where it holds the body.")
}

/// A tenth of the record about the instant of the greatest tension at the winch.
fn close_up(data: &DemoData) -> Option<Figure> {
    let tension = data.column("winch.tension")?;
    let row = (0..tension.len()).max_by(|a, b| tension[*a].total_cmp(&tension[*b]))?;
    let (first, last) = (data.times[0], data.times[data.times.len() - 1]);
    let half = 0.05 * (last - first);
    let middle = data.times[row].max(first + half).min(last - half);
    let mut panels = vec![
        data.panel("Position", &LENGTH, &[("ship.x", "surge"), ("ship.y", "sway"), ("ship.z", "heave")]),
        followed(data),
        tensions(data),
    ];
    for series in panels.iter_mut().flatten().flat_map(|panel| &mut panel.series) {
        series.points.retain(|(t, _)| (t - middle).abs() <= half);
    }
    let caption = "Ship, winch and tension about the instant of the greatest tension at the winch.";
    over_time("close-up", "Close-up", panels, caption)
}

fn body(data: &DemoData) -> Option<Figure> {
    let panels = [("body.x", "x"), ("body.y", "y"), ("body.z", "z")]
        .iter()
        .zip(PALETTE)
        .map(|((name, axis), colour)| {
            // Motion across the tow that is only rounding would fill a panel with noise.
            let moved = data.column(name)?.iter().any(|v| v.abs() > 1e-9);
            let mut panel = data.panel(axis, &LENGTH, &[(name, "")]).filter(|_| moved || *axis != "y")?.height(150.0);
            panel.series[0].colour = colour;
            Some(panel)
        })
        .collect();
    over_time("body", "Body position", panels, "Position of the body at the cable's end in the inertial frame.")
}

/// The body's path in the side view's plane.
fn body_path(data: &DemoData) -> Option<Figure> {
    let (x, z) = (data.column("body.x")?, data.column("body.z")?);
    let moved = x.iter().zip(z).any(|(x_i, z_i)| (x_i - x[0]).abs().max((z_i - z[0]).abs()) > 1e-6);
    let last = x.len() - 1;
    let mut panel = Panel::new("z, m", vec![Series::new("", x, z, PALETTE[0]).width(1.2)]);
    for (row, fraction) in [(0, 0.0), (last, 1.0)] {
        panel.marks.push(Mark::Dot { centre: (x[row], z[row]), radius: 5.0, colour: sequential(fraction) });
    }
    let chart = Chart { equal_aspect: true, ..Chart::new("Path of the body", "x, m", vec![panel]) };
    let caption = "The body's path in the plane of the side view, from the dark dot to the light one, to scale.";
    moved.then(|| Figure { file: "body-path", chart, caption: caption.to_owned() })
}

fn solver(data: &DemoData) -> Option<Figure> {
    let counts = |lines: &[(&str, &str)]| {
        let series: Vec<Series> = lines
            .iter()
            .zip(PALETTE)
            .filter_map(|((name, label), colour)| {
                let (middles, rates) = mean_increments(&data.times, data.column(name)?);
                Some(Series::new(label, &middles, &rates, colour))
            })
            .collect();
        (!series.is_empty()).then(|| Panel::new("Per communication step", series))
    };
    let work = counts(&[("solver.iterations", "iterations"), ("solver.steps", "sub-steps"), ("solver.rejected", "rejected sub-steps")]);
    let energy = data.column("solver.energy_error").map(|error| {
        let largest = error.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        let (symbol, factor) = if largest > 0.0 && largest < 1e-3 { ("10⁻⁶", 1e6) } else { ("", 1.0) };
        let label = if symbol.is_empty() { "Energy error".to_owned() } else { format!("Energy error, {symbol}") };
        Panel::new(&label, vec![Series::new("", &data.times, &times(error, factor), PALETTE[3])]).height(120.0)
    });
    let caption = "What the integrator did in a communication step, averaged over hundredths of the run, and how far work and energy are out \
                   of balance, relative to the work done.";
    over_time("solver", "Solver", vec![work, energy], caption)
}

/// The cable seen from starboard at some instants, with the drum and the water.
fn side_view(data: &DemoData) -> Option<Figure> {
    let points = (1..).take_while(|k| data.columns.contains_key(&format!("cable.point[{k}].x"))).count();
    if points < 2 {
        return None;
    }
    let last = data.times.len() - 1;
    let mut panel = Panel::new("z, m", Vec::new());
    if let Some(y) = data.waterline {
        panel.marks.push(Mark::Level { y, label: "water surface".to_owned(), colour: WATER });
    }
    let instants = INSTANTS.min(last + 1);
    for i in 0..instants {
        // The nearest row to i/(n-1) of the record.
        let fraction = if instants > 1 { i as f64 / (instants - 1) as f64 } else { 0.0 };
        let row = (fraction * last as f64).round() as usize;
        let colour = sequential(fraction);
        let cable: Vec<(f64, f64)> = (1..=points)
            .filter_map(|k| Some((data.at(&format!("cable.point[{k}].x"), row)?, data.at(&format!("cable.point[{k}].z"), row)?)))
            .collect();
        if let Some(drum) = data.drum {
            let centre = drum_centre(data, drum, row);
            panel.marks.push(Mark::Circle { centre, radius: drum.radius, colour });
        }
        let end = data.at("body.x", row).zip(data.at("body.z", row)).or(cable.last().copied());
        if let Some(centre) = end {
            panel.marks.push(Mark::Dot { centre, radius: 4.5, colour });
        }
        let label = format!("{} s", rounded(data.times[row]));
        panel.series.push(Series { points: smoothed(&cable), ..Series::new(&label, &[], &[], colour) }.width(2.0));
    }
    let chart = Chart { equal_aspect: true, ..Chart::new("Side view of the cable", "x, m", vec![panel]) };
    let caption = "The cable, the drum it is wound on and the body at its end, at equal intervals of the run, in the inertial frame and to \
                   scale (the dot that marks the body is not). Smoothed between the output points.";
    Some(Figure { file: "side-view", chart, caption: caption.to_owned() })
}

/// The drum's axis in the inertial frame (x, z) at a row; angles z-y-x, y of the axis taken as zero.
fn drum_centre(data: &DemoData, drum: Drum, row: usize) -> (f64, f64) {
    let value = |name: &str| data.at(name, row).unwrap_or(0.0);
    let (roll, pitch, yaw) = (value("ship.roll"), value("ship.pitch"), value("ship.yaw"));
    let x = yaw.cos() * pitch.cos() * drum.x + (yaw.cos() * pitch.sin() * roll.cos() + yaw.sin() * roll.sin()) * drum.z;
    let z = -pitch.sin() * drum.x + pitch.cos() * roll.cos() * drum.z;
    (value("ship.x") + x, value("ship.z") + z)
}

/// A Catmull-Rom curve through the points.
fn smoothed(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    const PARTS: usize = 8;
    let Some(&end) = points.last() else { return Vec::new() };
    let at = |i: isize| points[i.clamp(0, points.len() as isize - 1) as usize];
    let mut curve = Vec::new();
    for i in 0..points.len() as isize - 1 {
        let (a, b, c, d) = (at(i - 1), at(i), at(i + 1), at(i + 2));
        for part in 0..PARTS {
            let t = part as f64 / PARTS as f64;
            let mix = |a: f64, b: f64, c: f64, d: f64| {
                b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)))
            };
            curve.push((mix(a.0, b.0, c.0, d.0), mix(a.1, b.1, c.1, d.1)));
        }
    }
    curve.push(end);
    curve
}

fn key_figures(data: &DemoData) -> Vec<(String, &'static str)> {
    let mut tiles = vec![(format!("{} s", rounded(data.simulated())), "simulated")];
    if data.wall_seconds > 0.0 {
        tiles.push((format!("{} s", rounded(data.wall_seconds)), "computing time"));
        tiles.push((format!("{} \u{d7}", rounded(data.simulated() / data.wall_seconds)), "faster than real time"));
    }
    if let Some(steps) = total(data, "solver.steps") {
        tiles.push((grouped(steps), "sub-steps"));
    }
    tiles
}

fn run_table(data: &DemoData) -> Vec<Vec<String>> {
    let mut rows: Vec<Vec<String>> = data.facts.iter().map(|(what, value)| vec![what.clone(), value.clone()]).collect();
    let mut add = |what: &str, value: String| rows.push(vec![what.to_owned(), value]);
    add("Simulated time", format!("{} s", rounded(data.simulated())));
    add("Communication steps", grouped((data.times.len() - 1) as f64));
    if data.wall_seconds > 0.0 {
        add("Wall-clock time in fmi2DoStep", format!("{} s", rounded(data.wall_seconds)));
        add("Real-time factor", format!("{} times faster than real time", rounded(data.simulated() / data.wall_seconds)));
    }
    let names = [
        ("solver.steps", "Sub-steps"),
        ("solver.rejected", "Rejected sub-steps"),
        ("solver.iterations", "Iterations"),
        ("solver.factorizations", "Factorizations"),
    ];
    for (name, what) in names {
        if let Some(count) = total(data, name) {
            add(what, grouped(count));
        }
    }
    if let Some(error) = data.column("solver.energy_error").and_then(|e| e.last()) {
        add("Energy error at the end", format!("{error:.2e}"));
    }
    if !data.machine.is_empty() {
        add("Machine", data.machine.clone());
    }
    rows
}

fn extremes(data: &DemoData) -> Vec<Vec<String>> {
    let length = &LENGTH;
    [
        ("ship.x", "Surge", length),
        ("ship.z", "Heave", length),
        ("ship.roll", "Roll", &ANGLE),
        ("ship.pitch", "Pitch", &ANGLE),
        ("winch.tension", "Tension at the winch", &FORCE),
        ("body.tension", "Tension at the body", &FORCE),
        ("winch.torque", "Winch torque", &Unit(&[("mN·m", 1e3), ("N·m", 1.0), ("kN·m", 1e-3)])),
        ("body.x", "Body x", &Unit(&[("m", 1.0)])),
        ("body.z", "Body z", &Unit(&[("m", 1.0)])),
    ]
    .into_iter()
    .filter_map(|(name, what, unit)| {
        let values = data.column(name)?;
        let (symbol, factor) = unit.fitting(values.iter().copied());
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let greatest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let write = |value: f64| format!("{:.3}", value * factor + 0.0).replace('-', "\u{2212}");
        Some(vec![what.to_owned(), write(least), write(mean), write(greatest), symbol.to_owned()])
    })
    .collect()
}

/// Mean increment from row to row of a running count, over about a hundred stretches of the record: their middles and the means.
fn mean_increments(times: &[f64], running: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let rows = running.len() - 1;
    let stretches = rows.min(100);
    (0..stretches)
        .map(|i| {
            let (from, to) = (i * rows / stretches, (i + 1) * rows / stretches);
            (0.5 * (times[from] + times[to]), (running[to] - running[from]) / (to - from) as f64)
        })
        .unzip()
}

/// The final value of a running count.
fn total(data: &DemoData, name: &str) -> Option<f64> {
    data.column(name)?.last().copied()
}

fn times(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|v| v * factor).collect()
}

/// Three significant figures, without an exponent.
fn rounded(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let decimals = (2 - value.abs().log10().floor() as i32).max(0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A whole number with narrow spaces between thousands.
fn grouped(count: f64) -> String {
    let digits = format!("{count:.0}");
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) && digits.as_bytes()[i - 1].is_ascii_digit() {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ship_motion::{HEADER, Options, generate};

    /// A made-up run that looks like the flume demo: 60 s, a ship in waves, a cable that swings like a string with a current.
    fn synthetic() -> DemoData {
        let options = Options { scale: 60.0, heading: 160.0, step: 0.02, seed: 7, ..Options::default() };
        let motion = generate(&options).unwrap();
        let n = motion.times.len();
        let mut columns: BTreeMap<String, Vec<f64>> = BTreeMap::new();
        for i in 0..n {
            for (name, value) in HEADER[1..].iter().zip(motion.row(i)) {
                columns.entry((*name).to_owned()).or_default().push(value);
            }
        }
        let set = |columns: &mut BTreeMap<String, Vec<f64>>, name: &str, f: &dyn Fn(usize, f64) -> f64| {
            let values = (0..n).map(|i| f(i, motion.times[i])).collect();
            columns.insert(name.to_owned(), values);
        };
        let heave = |i: usize| motion.states[i].pose[2];
        let surge = |i: usize| motion.states[i].pose[0];
        let pitch = |i: usize| motion.states[i].pose[4];
        set(&mut columns, "winch.setpoint", &|i, _| 1.57 + 12.0 * heave(i) + 3.0 * pitch(i));
        set(&mut columns, "winch.angle", &|i, t| 1.57 + 12.0 * heave(i.saturating_sub(2)) + 3.0 * pitch(i) + 1e-3 * (9.0 * t).sin());
        set(&mut columns, "winch.rate", &|i, _| 12.0 * motion.states[i].velocity[2]);
        set(&mut columns, "winch.torque", &|i, _| 1.4e-4 + 2e-3 * heave(i));
        set(&mut columns, "winch.tension", &|i, t| 8.3e-3 + 2e-3 * motion.states[i].acceleration[2] + 2e-4 * (31.0 * t).sin());
        set(&mut columns, "body.tension", &|i, _| 7.6e-3 + 1.2e-3 * motion.states[i].acceleration[2]);
        set(&mut columns, "body.x", &|i, t| -0.708 + 0.4 * surge(i) + 0.004 * (0.9 * t).sin());
        set(&mut columns, "body.y", &|i, _| 0.2 * motion.states[i].pose[1]);
        set(&mut columns, "body.z", &|i, t| -0.685 + 0.3 * heave(i) + 0.003 * (1.1 * t).sin());
        set(&mut columns, "solver.steps", &|i, _| (2 * i + i / 9) as f64);
        set(&mut columns, "solver.iterations", &|i, _| (7 * i + i / 3) as f64);
        set(&mut columns, "solver.rejected", &|i, _| (i / 40) as f64);
        set(&mut columns, "solver.energy_error", &|_, t| 1e-5 * (1.0 - (-t / 20.0).exp()));
        let drum = Drum { x: 0.0, z: -0.01735, radius: 0.01735 };
        let body: Vec<(f64, f64)> = (0..n).map(|i| (columns["body.x"][i], columns["body.z"][i])).collect();
        for k in 1..=25 {
            let s = (k - 1) as f64 / 24.0;
            set(&mut columns, &format!("cable.point[{k}].x"), &|i, _| {
                let x0 = surge(i);
                x0 + (body[i].0 - x0) * (0.35 * s + 0.65 * s.powf(2.2))
            });
            set(&mut columns, &format!("cable.point[{k}].z"), &|i, _| heave(i) + (body[i].1 - heave(i)) * s.powf(0.85));
        }
        DemoData {
            times: motion.times.clone(),
            columns,
            drum: Some(drum),
            waterline: Some(-0.46),
            wall_seconds: 1.234,
            facts: vec![
                ("Scene".into(), "flume".into()),
                ("Sea".into(), "JONSWAP, Hs 2.5 m, Tp 8 s, γ 3.3, heading 160°, scale 1:60".into()),
                ("Communication step".into(), "0.02 s".into()),
            ],
            machine: "made-up numbers, no machine".into(),
        }
    }

    #[test]
    fn exact_report_is_complete_and_self_contained() {
        let folder = tempfile::tempdir().unwrap();
        // `FAIRLEAD_REPORT_TEST` keeps the report for a look at it.
        let dir = std::env::var_os("FAIRLEAD_REPORT_TEST").map_or(folder.path().join("demo"), Into::into);
        write(&synthetic(), &dir).unwrap();
        let html = std::fs::read_to_string(dir.join("index.html")).unwrap();
        assert!(!html.contains("NaN") && !html.contains("src=") && !html.contains("href="));
        assert!(html.contains("48.6 \u{d7}"), "60 s in 1.234 s");
        for file in ["side-view", "ship-motion", "winch", "tension", "close-up", "body", "body-path", "solver"] {
            let svg = std::fs::read_to_string(dir.join(format!("{file}.svg"))).unwrap();
            assert!(html.contains(&svg), "{file}");
            assert!(svg.len() < 400_000, "{file}: {} bytes", svg.len());
        }
    }

    #[test]
    fn exact_missing_columns_are_left_out_and_wrong_lengths_refused() {
        let folder = tempfile::tempdir().unwrap();
        let mut data = DemoData { times: vec![0.0, 1.0], ..DemoData::default() };
        data.columns.insert("body.x".into(), vec![0.0, 1.0]);
        write(&data, folder.path()).unwrap();
        assert!(folder.path().join("body.svg").exists() && !folder.path().join("winch.svg").exists());
        data.columns.insert("body.z".into(), vec![0.0]);
        let Failure(message) = write(&data, folder.path()).unwrap_err();
        assert!(message.contains("body.z: 1 values, expected 2"), "{message}");
        assert!(write(&DemoData::default(), folder.path()).is_err());
    }

    #[test]
    fn exact_numbers_read_well() {
        assert_eq!(rounded(48.6224), "48.6");
        assert_eq!(rounded(60.0), "60");
        assert_eq!(rounded(1234.5), "1234");
        assert_eq!(rounded(0.012345), "0.0123");
        assert_eq!(grouped(1_234_567.0), "1\u{202f}234\u{202f}567");
        assert_eq!(grouped(999.0), "999");
        assert_eq!(mean_increments(&[0.0, 1.0, 2.0], &[0.0, 2.0, 5.0]), (vec![0.5, 1.5], vec![2.0, 3.0]));
        assert_eq!(mean_increments(&[0.0], &[3.0]), (vec![], vec![]));
        let count: Vec<f64> = (0..1001).map(|i| 2.0 * i as f64).collect();
        assert_eq!(mean_increments(&count, &count).1, vec![2.0; 100]);
    }

    #[test]
    fn exact_drum_moves_with_the_ship() {
        let mut data = DemoData { times: vec![0.0], ..DemoData::default() };
        data.columns.insert("ship.x".into(), vec![1.0]);
        data.columns.insert("ship.pitch".into(), vec![std::f64::consts::FRAC_PI_2]);
        let (x, z) = drum_centre(&data, Drum { x: 2.0, z: 0.5, radius: 0.1 }, 0);
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
    }
}
