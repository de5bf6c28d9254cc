//! The winch and the ship: reeled in to the end, a step of the set-point, a pose that jumps.

use super::HEAVE;
use super::case::{Case, Claim::*, Quantity, Times};
use super::judge::{examine_all, section as table};
use crate::error::Result;
use crate::report::bench::Bench;
use crate::report::scene::{G, HEAVY_WIRE, Scene, Wire};
use crate::report::section::Section;
use crate::report::sheaves::regions;

fn winch(limits: &str, length: f64, mesh: &[(f64, i64)]) -> Result<Scene> {
    let wire =
        Wire { length, diameter: 0.016, mass_per_length: 1.05, ea: 1.2e7, ei: 10.0, laws: "damping = { axial = 2e4, bending = 0.5 }" };
    let rest = format!(
        "[winch]\nposition = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 0.25\nangle = 0\ngain_position = 25\ngain_rate = 10\n{limits}stiffness = 1e9\n\
         command = \"payout\"\nend = \"tangent\"\n[body]\nmass = 50\n[solver]\ntolerance = 1e-4\n"
    );
    Ok(wire.scene(G, 1, 0, &rest)?.with("mesh", regions(mesh)))
}

const LIMITS: &str = "max_rate = 4\nmax_acceleration = 8\n";
const SETPOINT: &[&str] = &["winch.setpoint", "winch.setpoint_rate"];

/// Reels in `most` metres at 0.5 m/s.
fn reel_in(name: &str, most: f64) -> Result<Case> {
    Ok(Case::new(name, winch(LIMITS, 3.0, &[(3.0, 48)])?, Times::Equal(0.01, most / 0.5 + 3.0), ("winch.tension", "Tension, N", 1.0))
        .record(&["winch.payout", "body.z"])
        .driven(SETPOINT, move |t| {
            let x = (0.5 * t).min(most);
            vec![-x, if x < most { -0.5 } else { 0.0 }]
        }))
}

fn little_left() -> Result<Case> {
    Ok(reel_in("Reeled in until little is left", 2.3)?
        .happens("A winch reels in 2.3 of 3 m at 0.5 m/s, more than a turn of the drum; the body, which swings wider the shorter its wire gets, is left below its side.", "")
        .asks(Quantity::new("tension after 7 s", "N", Share(1e-2), |run| run.value("winch.tension", 7.0)))
        .asks(Quantity::new("body's z after 7 s", "m", Amount(5e-3), |run| run.value("body.z", 7.0))))
}

fn beyond() -> Result<Case> {
    Ok(reel_in("Reeled in beyond the end", 3.3)?
        .happens("The same winch is told to reel in 3.3 of 3 m: the step that would bring the body onto the drum is refused.", "")
        .asks(Quantity::new("stops at", "s", Amount(2e-2), |run| run.stopped.as_ref().map_or(f64::NAN, |(t, _)| *t)))
        .stops("all of the cable is reeled in"))
}

fn step(limits: &str, name: &str, what: &str) -> Result<Case> {
    Ok(Case::new(name, winch(limits, 20.0, &[(2.0, 50), (18.0, 18)])?, Times::Equal(0.01, 6.0), ("winch.tension", "Tension, kN", 1e-3))
        .happens(what, "MoorDyn: a tension spike on a step in line length.")
        .record(&["winch.payout"])
        .driven(SETPOINT, |t| vec![if t < 0.995 { 0.0 } else { -1.0 }, 0.0])
        .asks(Quantity::new("greatest tension", "kN", Share(1e-2), |run| 1e-3 * run.peak("winch.tension")))
        .asks(Quantity::new("payout after 6 s", "m", Amount(1e-5), |run| run.value("winch.payout", 6.0))))
}

fn jump(height: f64, input: &str) -> Result<Case> {
    let rest = format!("[anchor]\nposition = [0, 0, 0]\n[body]\nmass = 500\n[ship]\ninput = \"{input}\"\n[solver]\ntolerance = 1e-4\n");
    let names: &'static [&'static str] = if input == "pose" { &HEAVE[..1] } else { HEAVE };
    let count = names.len();
    Ok(Case::new(
        format!("The ship's pose jumps by {height} m ({input})"),
        HEAVY_WIRE.scene(G, 20, 41, &rest)?,
        Times::Equal(0.01, 6.0),
        ("anchor.tension", "Tension at the top, kN", 1e-3),
    )
    .happens("P4's wire with 500 kg at rest; from one communication point to the next, 10 ms later, the ship is higher.", "")
    .driven(names, move |t| {
        let mut all = vec![0.0; count];
        all[0] = if t < 0.995 { 0.0 } else { height };
        all
    }))
}

/// The section.
///
/// # Errors
/// Scenes that are no TOML.
pub fn section(bench: &Bench) -> Result<Section> {
    let peak = || Quantity::new("greatest tension", "kN", Share(1e-2), |run| 1e-3 * run.peak("anchor.tension"));
    let cases = vec![
        little_left()?,
        beyond()?,
        step(LIMITS, "Set-point step with limits", "The set-point jumps by 1 m inwards; rate and acceleration of the drum are limited.")?,
        step("", "Set-point step without limits", "The same without limits: the drum takes it with its gains alone, 25 m/s² at first.")?,
        jump(0.1, "pose")?.asks(peak()),
        jump(0.1, "pose_velocity_acceleration")?.asks(peak()),
        jump(1.0, "pose_velocity_acceleration")?.asks(peak()),
        jump(1000.0, "pose_velocity_acceleration")?.stops("step failed"),
    ];
    let found = examine_all(bench, cases);
    Ok(table("Winch and ship", "What a controller or a master may do to the cable.", found))
}
