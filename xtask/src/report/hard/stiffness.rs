//! Stiffness: none in bending, much along the cable, six decades in contact.

use super::HEAVE;
use super::case::{Case, Claim::*, Quantity, Times};
use super::judge::{examine_all, section as table};
use crate::error::{Failure, Result};
use crate::report::bench::Bench;
use crate::report::scene::{G, HEAVED, HEAVY_WIRE, Scene, Wire, heave};
use crate::report::section::Section;

fn bending(ei: f64) -> Result<Case> {
    let wire = Wire { length: 10.0, diameter: 0.01, mass_per_length: 0.1, ea: 1e5, ei, laws: "damping.axial = 50" };
    let rest = "[anchor]\nposition = [0, 0, 0]\n[body]\nmass = 1\n[initial]\nstate = \"straight\"\ndirection = [1, 0, 0]\n[solver]\ntolerance = 1e-4\n";
    Ok(Case::new(
        format!("EI = {ei:e} N·m²: a rope swings"),
        wire.scene(G, 40, 81, rest)?,
        Times::Equal(0.01, 3.0),
        ("anchor.tension", "Tension at the pin, N", 1.0),
    )
    .happens("10 m of rope with 1 kg swing down from level and on, into the slack on the far side.", "")
    .record(&["body.x", "body.z"])
    .asks(Quantity::new("body's x at 2 s", "m", Amount(5e-3), |run| run.value("body.x", 2.0)))
    .asks(Quantity::new("greatest tension", "N", Share(2e-2), |run| run.peak("anchor.tension")))
    .balanced(2e-2))
}

fn slack_without_bending() -> Result<Case> {
    let wire = Wire { ei: 0.0, ..HEAVY_WIRE };
    Ok(Case::new(
        "EI = 0: slack and snap",
        wire.scene(G, 20, 41, &format!("{HEAVED}[solver]\ntolerance = 1e-4\n"))?,
        Times::Equal(0.01, 24.0),
        ("anchor.tension", "Tension at the top, kN", 1e-3),
    )
    .happens("P4b without bending stiffness: while slack, the wire has no stiffness at all.", "")
    .driven(HEAVE, |t| heave(t, 5.0, 4.0))
    .asks(Quantity::new("greatest tension", "kN", Share(5e-3), |run| 1e-3 * run.peak("anchor.tension")))
    .balanced(1e-2))
}

fn axial(ea: f64, amplitude: f64, period: f64) -> Result<Case> {
    let wire = Wire { ea, ..HEAVY_WIRE };
    let slack = if amplitude > 4.0 { ", slack and snap" } else { "" };
    let scene = wire.scene(G, 20, 41, &format!("{HEAVED}[solver]\ntolerance = 1e-4\n"))?;
    Ok(Case::new(
        format!("EA = {ea:e} N{slack}"),
        scene,
        Times::Equal(if slack.is_empty() { 5e-3 } else { 1e-3 }, 12.0),
        ("anchor.tension", "Tension at the top, kN", 1e-3),
    )
    .happens(format!("P4's wire, heaved by {amplitude} m every {period} s."), "")
    .driven(HEAVE, move |t| heave(t, amplitude, period))
    .asks(Quantity::new("greatest tension", "kN", Share(if amplitude > 4.0 { 2e-2 } else { 2e-3 }), |run| {
        1e-3 * run.peak("anchor.tension")
    }))
    .balanced(1e-2))
}

fn contact(stiffness: f64) -> Result<Case> {
    let text = model_description::scenes::named("pulley_1").ok_or_else(|| Failure("there is no built-in scene pulley_1".into()))?.text;
    let scene = Scene::parse(&text.replace("stiffness = 1e13", &format!("stiffness = {stiffness:e}")))?;
    Ok(Case::new(
        format!("Contact stiffness {stiffness:e} N/m^2.5"),
        scene,
        Times::Equal(2e-3, 1.0),
        ("load.tension", "Tension at the load, N", 1.0),
    )
    .happens("The load of pulley_1 swings on its rope over the pulley.", "")
    .record(&["sheave[1].turn_angle"])
    .asks(Quantity::new("greatest tension", "N", Share(5e-3), |run| run.peak("load.tension")))
    .asks(Quantity::new("greatest turn", "rad", Share(5e-3), |run| run.peak("sheave[1].turn_angle"))))
}

/// The section.
///
/// # Errors
/// Scenes that are no TOML.
pub fn section(bench: &Bench) -> Result<Section> {
    let mut cases = vec![slack_without_bending()?];
    for ei in [0.0, 1e-12, 1e-6, 1e-2] {
        cases.push(bending(ei)?);
    }
    for ea in [1e7, 1e8, 1e9] {
        cases.push(axial(ea, 2.5, 6.0)?);
    }
    cases.push(axial(1e9, 5.0, 4.0)?);
    for stiffness in [1e7, 1e9, 1e11, 1e13] {
        cases.push(contact(stiffness)?);
    }
    let found = examine_all(bench, cases);
    Ok(table("Stiffness: none, much, six decades", "One scene each with its stiffness changed, nothing else.", found))
}
