//! Weight and water: a rope that floats, bodies of all masses, a body through the surface.

use super::case::{Case, Claim::*, Quantity, Times};
use super::judge::{examine_all, section as table};
use super::{HEAVE, SEA};
use crate::error::Result;
use crate::report::bench::Bench;
use crate::report::scene::{G, HEAVY_WIRE, Wire, heave};
use crate::report::section::Section;

fn floating() -> Result<Case> {
    let rope = Wire { length: 30.0, diameter: 0.02, mass_per_length: 0.2, ea: 1e5, ei: 0.5, laws: "damping.axial = 300" };
    let rest = format!(
        "{SEA}current.profile = [[0, 0.5, 0]]\n[anchor]\nposition = [0, 0, 2]\n[ship]\ninput = \"pose_velocity_acceleration\"\n[solver]\ntolerance = 1e-4\n"
    );
    Ok(Case::new("A light rope that floats", rope.scene(G, 60, 31, &rest)?, Times::Equal(0.02, 30.0), ("anchor.tension", "Tension at the ship, N", 1.0))
        .happens("30 m of polypropylene rope (0.62 of the water's density) from a ship that heaves by 1 m every 6 s, streaming out on the surface in a current.", "")
        .record(&["cable.point[31].z", "cable.point[31].x"])
        .driven(HEAVE, |t| heave(t, 1.0, 6.0))
        .asks(Quantity::new("end's x after 30 s", "m", Amount(2e-2), |run| run.value("cable.point[31].x", 30.0)))
        .asks(Quantity::new("end's z after 30 s", "m", Amount(5e-3), |run| run.value("cable.point[31].z", 30.0)))
        .asks(Quantity::new("greatest tension", "N", Share(2e-2), |run| run.peak("anchor.tension"))))
}

fn mass(mass: f64) -> Result<Case> {
    let rest = format!(
        "[anchor]\nposition = [0, 0, 0]\n[body]\nmass = {mass:?}\n[ship]\ninput = \"pose_velocity_acceleration\"\n[solver]\ntolerance = 1e-4\n"
    );
    Ok(Case::new(
        format!("A body of {mass:e} kg"),
        HEAVY_WIRE.scene(G, 20, 41, &rest)?,
        Times::Equal(0.01, 24.0),
        ("anchor.tension", "Tension at the top, kN", 1e-3),
    )
    .happens("P4's wire, 200 kg of it, heaved by 1 m every 6 s with this body.", "")
    .record(&["body.z"])
    .driven(HEAVE, |t| heave(t, 1.0, 6.0))
    .asks(Quantity::new("greatest tension", "kN", Share(2e-3), |run| 1e-3 * run.peak("anchor.tension")))
    .asks(Quantity::new("body's z after 24 s", "m", Amount(5e-3), |run| run.value("body.z", 24.0)))
    .balanced(5e-3))
}

fn surface() -> Result<Case> {
    let wire = Wire {
        length: 10.0,
        diameter: 0.016,
        mass_per_length: 1.05,
        ea: 1.2e7,
        ei: 10.0,
        laws: "damping = { axial = 2e4, bending = 0.5 }",
    };
    let rest = format!(
        "{SEA}[anchor]\nposition = [0, 0, 10]\n[body]\nmass = 400\nvolume = 0.1\ndrag_area = 0.4\ndrag_coefficient = 1.0\n\
         [ship]\ninput = \"pose_velocity_acceleration\"\n[solver]\ntolerance = 1e-4\n"
    );
    Ok(Case::new(
        "A body through the water's surface",
        wire.scene(G, 20, 0, &rest)?,
        Times::Equal(5e-3, 24.0),
        ("anchor.tension", "Tension at the top, kN", 1e-3),
    )
    .happens("400 kg of 0.1 m³ half in the water, heaved by 2.5 m every 5 s: out of the water and under it.", "")
    .record(&["body.z"])
    .driven(HEAVE, |t| heave(t, 2.5, 5.0))
    .asks(Quantity::new("greatest tension", "kN", Share(5e-3), |run| 1e-3 * run.peak("anchor.tension")))
    .asks(Quantity::new("least tension", "kN", Amount(0.02), |run| 1e-3 * run.least("anchor.tension"))))
}

/// The section.
///
/// # Errors
/// Scenes that are no TOML.
pub fn section(bench: &Bench) -> Result<Section> {
    let mut cases = vec![floating()?];
    for m in [1e-3, 1.0, 1e3, 1e5] {
        cases.push(mass(m)?);
    }
    cases.push(surface()?);
    let found = examine_all(bench, cases);
    Ok(table("Weight and water", "Ropes lighter than water, bodies lighter and heavier than their wire, the surface.", found))
}
