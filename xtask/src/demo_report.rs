//! The demo's report: a page with figures of what was simulated, and each figure as an SVG file of its own.

use crate::error::Failure;
use crate::html_report::Page;
use crate::plots::{Chart, INK, Mark, PALETTE, Panel, SOFT, Series, WATER, sequential};
use std::collections::BTreeMap;
use std::path::Path;

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
/// For positions of which the change counts.
const MILLIMETRES: Unit = Unit(&[("mm", 1e3)]);
const FORCE: Unit = Unit(&[("mN", 1e3), ("N", 1.0), ("kN", 1e-3)]);
const ANGLE: Unit = Unit(&[("°", 180.0 / std::f64::consts::PI)]);
const TORQUE: Unit = Unit(&[("mN·m", 1e3), ("N·m", 1.0), ("kN·m", 1e-3)]);

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
    for (name, values) in data.columns.iter().chain(&data.held) {
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

    let mut page = Page::new("fairlead: a towed cable on a heave-compensating winch");
    page.paragraph(
        "A ship moves in an irregular sea and tows a small sphere through a current. The winch on its deck reels cable in and out so that \
         the sphere stays where it is. Every number below was computed by a packed FMU, driven through its FMI 2.0 C interface; a controller \
         outside the FMU made the winch's set-point from the ship's motion.",
    );
    page.tiles(&key_figures(data));
    for (heading, figures) in sections(data) {
        if figures.is_empty() {
            continue;
        }
        page.heading(heading);
        for figure in &figures {
            let svg = figure.chart.svg();
            save(&format!("{}.svg", figure.file), &svg)?;
            page.figure(&svg, &figure.caption);
        }
    }
    page.heading("Extremes").table(&["Variable", "Least", "Mean", "Greatest", "Std. dev.", "Unit"], &extremes(data));
    page.heading("The run").table(&[], &run_table(data));
    page.paragraph(
        "Frames: x forward, y to port, z up, the origin at the drum's top in the calm; roll, pitch and yaw about x, y and z, pitch positive \
         bow down. The drum's angle is right-handed about its axis, which points to port.",
    );
    save("index.html", &page.html())
}

/// What came out in a few lines, (what, value).
pub fn findings(data: &DemoData) -> Vec<(&'static str, String)> {
    let mut lines = Vec::new();
    if let Some(heave) = data.column("body.z") {
        let mut value = format!("{} mm with the winch compensating", rounded(1e3 * deviation(heave)));
        if let Some(held) = data.held.get("body.z") {
            value += &format!(", {} mm with the winch held", rounded(1e3 * deviation(held)));
        }
        lines.push(("body heave, standard deviation", value));
    }
    if data.wall_seconds > 0.0 {
        let factor = data.simulated() / data.wall_seconds;
        let wall = rounded(data.wall_seconds);
        lines.push(("speed", format!("{} s in {wall} s, {} times faster than real time", rounded(data.simulated()), rounded(factor))));
    }
    lines
}

/// A chart with its file name and caption.
struct Figure {
    file: &'static str,
    chart: Chart,
    caption: String,
}

/// Headings, and what stands under them.
fn sections(data: &DemoData) -> [(&'static str, Vec<Figure>); 5] {
    let some = |figures: Vec<Option<Figure>>| figures.into_iter().flatten().collect();
    [
        ("The cable", some(vec![side_view(data), drum_view(data)])),
        ("Ship and winch", some(vec![ship_motion(data), winch(data)])),
        ("What the winch is good for", some(vec![heave(data), body_path(data)])),
        ("Forces", some(vec![tension(data), close_up(data)])),
        ("Body and solver", some(vec![body(data), solver(data)])),
    ]
}

/// A chart over time of the panels that exist.
fn over_time(file: &'static str, title: &str, panels: Vec<Option<Panel>>, caption: &str) -> Option<Figure> {
    let panels: Vec<Panel> = panels.into_iter().flatten().collect();
    (!panels.is_empty()).then(|| Figure { file, chart: Chart::new(title, "Time, s", panels), caption: caption.to_owned() })
}

fn ship_motion(data: &DemoData) -> Option<Figure> {
    let position = data.panel("Position", &LENGTH, &[("ship.x", "surge"), ("ship.y", "sway"), ("ship.z", "heave")]);
    let angles = data.panel("Angle", &ANGLE, &[("ship.roll", "roll"), ("ship.pitch", "pitch"), ("ship.yaw", "yaw")]);
    let caption = "What the FMU is given: the six degrees of freedom of the ship, with their velocities and accelerations, every communication \
                   step. The winch stands at the ship frame's origin. The motion grows from rest so that the run starts from the calm.";
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

/// How far the winch is behind its set-point, m of cable.
fn tracking_error(data: &DemoData) -> Option<Vec<f64>> {
    let (angle, setpoint, radius) = (data.column("winch.angle")?, data.column("winch.setpoint")?, data.drum?.radius);
    Some(setpoint.iter().zip(angle).map(|(s, a)| radius * (s - a)).collect())
}

fn winch(data: &DemoData) -> Option<Figure> {
    let error = tracking_error(data).map(|error| {
        let (symbol, factor) = LENGTH.fitting(error.iter().copied());
        Panel::new(&format!("Error, {symbol}"), vec![Series::new("", &data.times, &times(&error, factor), PALETTE[1])]).height(120.0)
    });
    let deviation = tracking_error(data).map_or_else(String::new, |e| format!(" (standard deviation {} mm)", rounded(1e3 * deviation(&e))));
    let payout = data.panel("Paid out", &LENGTH, &[("winch.payout", "")]).map(|panel| panel.height(120.0));
    let caption = format!(
        "The drum's angle and the set-point that the controller outside the FMU computes from the ship's motion: \u{394}l = \u{2212}u\u{b7}\u{394}r, \
         what the ship would pull the cable along its own direction is paid out. Below, how far the winch's position loop is behind its set-point, \
         as length of cable{deviation}, and the cable paid out."
    );
    over_time("winch", "Winch: drum angle and set-point", vec![followed(data), error, payout], &caption)
}

/// Heave of ship and body, with and without compensation.
fn heave(data: &DemoData) -> Option<Figure> {
    let from_start = |values: &[f64]| values.iter().map(|v| 1e3 * (v - values[0])).collect::<Vec<_>>();
    let line = |label: &str, values: &[f64], colour| Series::new(label, &data.times, &from_start(values), colour);
    let body = data.column("body.z")?;
    let mut series = Vec::new();
    let mut caption = "Vertical motion of the body about its place in the calm.".to_owned();
    if let Some(ship) = data.column("ship.z") {
        series.push(line("ship", ship, SOFT));
    }
    if let Some(held) = data.held.get("body.z") {
        series.push(line("body, winch held", held, PALETTE[1]));
        caption += &format!(
            " The run was made twice, with the same ship motion: with the winch held still the body's heave has a standard deviation of {} mm, \
             with the winch compensating {} mm.",
            rounded(1e3 * deviation(held)),
            rounded(1e3 * deviation(body))
        );
    }
    series.push(line("body, winch compensating", body, PALETTE[0]));
    let panel = Panel::new("z from the calm, mm", series).height(260.0);
    over_time("heave", "Heave with and without compensation", vec![Some(panel)], &caption)
}

fn tensions(data: &DemoData) -> Option<Panel> {
    let lines = [("winch.tension", "at the winch"), ("anchor.tension", "at the anchor"), ("body.tension", "at the body")];
    data.panel("Tension", &FORCE, &lines)
}

fn tension(data: &DemoData) -> Option<Figure> {
    let panel = tensions(data).map(|panel| panel.height(240.0));
    let torque = data.panel("Torque", &TORQUE, &[("winch.torque", "")]).map(|panel| panel.height(120.0));
    let caption = "Tension where the cable leaves the drum and where it holds the body, and the torque about the drum's axis with which the cable \
                   turns it. The difference between the two tensions is the weight in water and the drag of the cable between them.";
    over_time("tension", "Cable tension and winch torque", vec![panel, torque], caption)
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
    over_time("close-up", "Close-up of the greatest tension", panels, caption)
}

fn body(data: &DemoData) -> Option<Figure> {
    let panels = [("body.x", "x"), ("body.y", "y"), ("body.z", "z")]
        .iter()
        .zip(PALETTE)
        .map(|((name, axis), colour)| {
            // Motion across the tow that is only rounding would fill a panel with noise.
            let moved = data.column(name)?.iter().any(|v| v.abs() > 1e-9);
            let mut panel = data.panel(axis, &LENGTH, &[(name, "")]).filter(|_| moved || *axis != "y")?.height(130.0);
            panel.series[0].colour = colour;
            Some(panel)
        })
        .collect();
    over_time("body", "Body position", panels, "Position of the body at the cable's end in the inertial frame, winch compensating.")
}

/// The body's path in the side view's plane.
fn body_path(data: &DemoData) -> Option<Figure> {
    let (x, z) = (data.column("body.x")?, data.column("body.z")?);
    let moved = x.iter().zip(z).any(|(x_i, z_i)| (x_i - x[0]).abs().max((z_i - z[0]).abs()) > 1e-6);
    let label = |text: &'static str| if data.held.is_empty() { "" } else { text };
    let mm = |values: &[f64]| times(values, 1e3);
    let mut panel = Panel::new("z, mm", Vec::new());
    if let (Some(x), Some(z)) = (data.held.get("body.x"), data.held.get("body.z")) {
        panel.series.push(Series::new("winch held", &mm(x), &mm(z), PALETTE[1]).width(1.0));
    }
    panel.series.push(Series::new(label("winch compensating"), &mm(x), &mm(z), PALETTE[0]).width(1.0));
    panel.marks.push(Mark::Dot { centre: (1e3 * x[0], 1e3 * z[0]), radius: 4.5, colour: INK });
    let chart = Chart { equal_aspect: true, ..Chart::new("Path of the body", "x, mm", vec![panel]) };
    let caption = "The body's path in the plane of the side view, to scale. The black dot is its place in the calm.";
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
                   of balance, relative to the work done so far.";
    over_time("solver", "Solver", vec![work, energy], caption)
}

/// The cable seen from starboard at instants through the greatest swing of the ship, with the drum and the water.
fn side_view(data: &DemoData) -> Option<Figure> {
    let chart = Chart { equal_aspect: true, ..Chart::new("Side view of the cable", "x, m", vec![cable_panel(data, f64::INFINITY, 1)?]) };
    let caption = "The drum (circle, at the top right), the cable and the body at its end, seen from starboard in the inertial frame and to scale, \
                   but for the dot that marks the body. The first line is the calm, the others lie in the ship's greatest swing from a trough to the \
                   next crest: the drum rises by centimetres, the body hardly moves. The current flows towards \u{2212}x and fades with depth.";
    Some(Figure { file: "side-view", chart, caption: caption.to_owned() })
}

/// The same about the drum.
fn drum_view(data: &DemoData) -> Option<Figure> {
    let reach = 5.0 * data.drum?.radius;
    let chart = Chart { equal_aspect: true, ..Chart::new("Side view about the drum", "x, m", vec![cable_panel(data, reach, 2)?]) };
    let caption = "Trough, mean and crest from the figure above, about the drum. The cable is fixed to the drum at the end of the spoke, lies on it and leaves it where its \
                   stiffness against bending lets it. While the ship rises, the drum turns so as to pay out. Drawn through the FMU's output \
                   points, on the drum along its surface.";
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

fn key_figures(data: &DemoData) -> Vec<(String, &'static str)> {
    let mut tiles = Vec::new();
    if let Some(heave) = data.column("body.z") {
        tiles.push((format!("{} mm", rounded(1e3 * deviation(heave))), "body heave (std. dev.), winch compensating"));
    }
    if let Some(held) = data.held.get("body.z") {
        tiles.push((format!("{} mm", rounded(1e3 * deviation(held))), "body heave (std. dev.), winch held"));
    }
    if data.wall_seconds > 0.0 {
        tiles.push((format!("{} \u{d7}", rounded(data.simulated() / data.wall_seconds)), "faster than real time"));
        let seconds = format!("{} s", rounded(data.wall_seconds));
        tiles.push((seconds, "in the FMU for the whole run"));
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
        add("Wall-clock time in the FMU", format!("{} s (set inputs, step, get every output)", rounded(data.wall_seconds)));
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
        add("Energy error at the end", format!("{error:.2e} of the work done"));
    }
    if let Some(codes) = data.column("status.code") {
        let degraded = codes.iter().filter(|code| **code != 0.0).count();
        add("Steps with a status other than fine", grouped(degraded as f64));
    }
    if !data.machine.is_empty() {
        add("Machine", data.machine.clone());
    }
    rows
}

fn extremes(data: &DemoData) -> Vec<Vec<String>> {
    let row = |values: &[f64], what: &str, unit: &Unit| {
        let (symbol, factor) = unit.fitting(values.iter().copied());
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let greatest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let write = |value: f64| format!("{:.3}", value * factor + 0.0).replace('-', "\u{2212}");
        vec![what.to_owned(), write(least), write(mean), write(greatest), write(deviation(values)), symbol.to_owned()]
    };
    let mut rows: Vec<Vec<String>> = [
        ("ship.x", "Surge", &LENGTH),
        ("ship.y", "Sway", &LENGTH),
        ("ship.z", "Heave", &LENGTH),
        ("ship.roll", "Roll", &ANGLE),
        ("ship.pitch", "Pitch", &ANGLE),
        ("ship.yaw", "Yaw", &ANGLE),
        ("winch.angle", "Drum angle", &ANGLE),
        ("winch.payout", "Cable paid out", &LENGTH),
        ("winch.tension", "Tension at the winch", &FORCE),
        ("body.tension", "Tension at the body", &FORCE),
        ("winch.torque", "Winch torque", &TORQUE),
        ("body.x", "Body x", &MILLIMETRES),
        ("body.y", "Body y", &MILLIMETRES),
        ("body.z", "Body z", &MILLIMETRES),
    ]
    .into_iter()
    .filter_map(|(name, what, unit)| Some(row(data.column(name)?, what, unit)))
    .collect();
    let of_held = [("body.x", "Body x, winch held"), ("body.z", "Body z, winch held")];
    rows.extend(of_held.into_iter().filter_map(|(name, what)| Some(row(data.held.get(name)?, what, &MILLIMETRES))));
    rows
}

/// Standard deviation about the mean.
fn deviation(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt()
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
        let drum = Drum { x: 0.0, z: -0.01735, radius: 0.01735, clockwise: false };
        let body: Vec<(f64, f64)> = (0..n).map(|i| (columns["body.x"][i], columns["body.z"][i])).collect();
        for k in 1..=25 {
            let s = (k - 1) as f64 / 24.0;
            set(&mut columns, &format!("cable.point[{k}].x"), &|i, _| {
                let x0 = surge(i);
                x0 + (body[i].0 - x0) * (0.35 * s + 0.65 * s.powf(2.2))
            });
            set(&mut columns, &format!("cable.point[{k}].z"), &|i, _| heave(i) + (body[i].1 - heave(i)) * s.powf(0.85));
        }
        let held = BTreeMap::from([
            ("body.x".to_owned(), (0..n).map(|i| -0.708 + 0.9 * surge(i)).collect()),
            ("body.z".to_owned(), (0..n).map(|i| -0.685 + 0.9 * heave(i)).collect()),
        ]);
        DemoData {
            times: motion.times.clone(),
            columns,
            held,
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
        for file in ["side-view", "drum-view", "ship-motion", "winch", "heave", "tension", "close-up", "body", "body-path", "solver"] {
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
        assert_eq!(deviation(&[1.0, 3.0]), 1.0);
    }
}
