//! Meshes and masters: 3 and 3000 elements, communication steps of all sizes, eight hours.

use super::HEAVE;
use super::case::{Case, Claim::*, Quantity, Times};
use super::judge::{Findings, examine_all, section as table};
use crate::error::Result;
use crate::report::bench::Bench;
use crate::report::row::{Row, Truth};
use crate::report::scene::{G, HEAVED, HEAVY_WIRE, Wire, heave};
use crate::report::section::Section;

fn mesh(elements: usize, end: f64, claim: f64) -> Result<Case> {
    let scene = HEAVY_WIRE.scene(G, elements, 0, &format!("{HEAVED}[solver]\ntolerance = 1e-4\n"))?;
    Ok(Case::new(format!("{elements} elements"), scene, Times::Equal(0.02, end), ("anchor.tension", "Tension at the top, kN", 1e-3))
        .happens(format!("P4a's wire, heaved by 2.5 m every 6 s without slack, in {elements} elements."), "")
        .driven(HEAVE, |t| heave(t, 2.5, 6.0))
        .asks(Quantity::new("greatest tension", "kN", Share(claim), |run| 1e-3 * run.peak("anchor.tension"))))
}

/// The same motion, which has no inputs, over other communication points.
fn steps(name: &str, times: Times) -> Result<Case> {
    let rope =
        Wire { length: 5.0, diameter: 0.01, mass_per_length: 0.2, ea: 1e5, ei: 0.05, laws: "damping = { axial = 50, bending = 0.01 }" };
    let rest = "[anchor]\nposition = [0, 0, 0]\n[body]\nmass = 10\n[initial]\nstate = \"released\"\ndirection = [0.8, 0, -0.6]\n[solver]\ntolerance = 1e-4\n";
    Ok(Case::new(name, rope.scene(G, 16, 0, rest)?, times, ("body.x", "Body's x, m", 1.0))
        .happens("10 kg swing on 5 m of rope, let go 53° aside; nothing but the communication points differs.", "")
        .record(&["body.z", "anchor.tension"])
        .asks(Quantity::new("body's x after 3 s", "m", Amount(1e-4), |run| run.value("body.x", 3.0)))
        .asks(Quantity::new("tension after 3 s", "N", Share(1e-3), |run| run.value("anchor.tension", 3.0))))
}

/// Communication steps between 0.1 ms and 0.3 s, evenly spread in their logarithm by a linear congruence, up to 3 s.
fn irregular() -> Times {
    let (mut points, mut seed) = (vec![0.0], 12345u64);
    let mut t = 0.0;
    while t < 2.999 {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let x = (seed >> 11) as f64 / (1u64 << 53) as f64;
        t = (t + 1e-4 * 3000f64.powf(x)).min(3.0);
        points.push(t);
    }
    if t < 3.0 {
        points.push(3.0);
    }
    Times::Listed(points)
}

const HOURS: f64 = 8.0 * 3600.0;

fn eight_hours() -> Result<Case> {
    let rest = format!("{HEAVED}[solver]\ntolerance = 1e-3\n");
    let window = |run: &super::run::Run, from: f64| {
        let inside = run.times.iter().zip(run.of("anchor.tension")).filter(|(t, _)| **t >= from && **t < from + 600.0);
        inside.map(|(_, v)| *v).fold(f64::NAN, f64::max)
    };
    Ok(Case::new(
        "Eight hours",
        HEAVY_WIRE.scene(G, 3, 0, &rest)?,
        Times::Equal(0.2, HOURS),
        ("anchor.tension", "Tension at the top, kN", 1e-3),
    )
    .happens("P4's wire in 3 elements, heaved by 1 m every 10 s for eight hours, in 144000 communication steps.", "")
    .record(&["body.z"])
    .driven(HEAVE, |t| heave(t, 1.0, 10.0))
    .asks(Quantity::new("greatest tension in the last ten minutes", "kN", Share(2e-3), move |run| 1e-3 * window(run, HOURS - 600.0)))
    .asks(Quantity::new("the same less that after ten minutes: drift", "N", Amount(1.0), move |run| {
        window(run, HOURS - 600.0) - window(run, 600.0)
    })))
}

/// The swing over other communication points against that over steps of 10 ms.
fn alike(found: &[std::result::Result<Findings, Row>]) -> Vec<Row> {
    let all: Vec<&Findings> =
        found.iter().flatten().filter(|f| f.case.name.contains("teps of") || f.case.name.contains("steps,")).collect();
    let Some(first) = all.iter().find(|f| f.case.name == "Steps of 10 ms") else { return Vec::new() };
    let rows = all.iter().filter(|f| f.case.name != first.case.name).flat_map(|f| {
        let [x, tension] = ["body.x", "anchor.tension"].map(|name| [f, first].map(|f| f.shipped.value(name, 3.0)));
        [
            Row::absolute(Truth::Own, format!("{}: body's x after 3 s", f.case.name), x[0], x[1], "m")
                .within(1e-4)
                .because("what both claim"),
            Row::relative(Truth::Own, format!("{}: tension after 3 s", f.case.name), tension[0], tension[1], "N")
                .within(1e-3)
                .because("what both claim"),
        ]
    });
    rows.collect()
}

/// The section.
///
/// # Errors
/// Scenes that are no TOML.
pub fn section(bench: &Bench) -> Result<Section> {
    let cases = vec![
        eight_hours()?,
        mesh(3, 24.0, 5e-3)?,
        mesh(3000, 4.0, 1e-3)?,
        steps("Steps of 0.1 ms", Times::Equal(1e-4, 3.0))?,
        steps("Steps of 10 ms", Times::Equal(0.01, 3.0))?,
        steps("Steps of 0.5 s", Times::Equal(0.5, 3.0))?,
        steps("Irregular steps, 0.1 ms to 0.3 s", irregular())?,
    ];
    let found = examine_all(bench, cases);
    let rows = alike(&found);
    Ok(table("Meshes and masters", "Few and many elements; communication steps of all sizes; a long run.", found)
        .text("The same motion over different communication points, against steps of 10 ms:")
        .rows(rows))
}
