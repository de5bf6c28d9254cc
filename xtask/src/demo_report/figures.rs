//! The report's figures over time, and their order on the page.

use super::cable::{drum_view, side_view};
use super::data::{DemoData, deviation, mean_increments};
use super::units::{ANGLE, FORCE, LENGTH, TORQUE, Unit, rounded, times};
use crate::plots::{Chart, INK, Mark, PALETTE, Panel, SOFT, Series};

/// A chart with its file name and caption.
pub struct Figure {
    pub file: &'static str,
    pub chart: Chart,
    pub caption: String,
}

/// Headings, and what stands under them.
pub fn sections(data: &DemoData) -> [(&'static str, Vec<Figure>); 5] {
    let some = |figures: Vec<Option<Figure>>| figures.into_iter().flatten().collect();
    [
        ("The cable", some(vec![side_view(data), drum_view(data)])),
        ("Ship and winch", some(vec![ship_motion(data), winch(data)])),
        ("What the winch is good for", some(vec![heave(data), body_path(data)])),
        ("Forces", some(vec![tension(data), close_up(data)])),
        ("Body and solver", some(vec![body(data), solver(data)])),
    ]
}

impl DemoData {
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
    let moved = |(axis, name)| {
        let values = data.column(name)?;
        let way: Vec<f64> = values.iter().map(|v| v - values[0]).collect();
        // Motion across the tow that is only rounding would fill a panel with noise.
        (axis != "y" || values.iter().any(|v| v.abs() > 1e-9)).then_some((axis, way))
    };
    let ways = [("x", "body.x"), ("y", "body.y"), ("z", "body.z")].map(moved);
    let (symbol, factor) = LENGTH.fitting(ways.iter().flatten().flat_map(|(_, way)| way.iter().copied()));
    let panels = ways.into_iter().zip(PALETTE).map(|(way, colour)| {
        let (axis, way) = way?;
        Some(Panel::new(&format!("{axis}, {symbol}"), vec![Series::new("", &data.times, &times(&way, factor), colour)]).height(130.0))
    });
    let caption = "How far the body at the cable's end is from its place in the calm, in the inertial frame, winch compensating.";
    over_time("body", "Body position", panels.collect(), caption)
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
