//! The report's key figures and tables, and the lines that the command prints.

use super::data::{DemoData, deviation};
use super::units::{ANGLE, FORCE, LENGTH, MILLIMETRES, TORQUE, Unit, grouped, rounded};

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

pub fn key_figures(data: &DemoData) -> Vec<(String, &'static str)> {
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
    if let Some(steps) = data.total("solver.steps") {
        tiles.push((grouped(steps), "sub-steps"));
    }
    tiles
}

pub fn run_table(data: &DemoData) -> Vec<Vec<String>> {
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
        if let Some(count) = data.total(name) {
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

pub fn extremes(data: &DemoData) -> Vec<Vec<String>> {
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
