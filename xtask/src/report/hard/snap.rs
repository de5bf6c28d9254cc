//! Slack and snap: P4b of the comparison with other programs, and the same wire in water.

use super::case::{Case, Claim::*, Quantity, Times};
use super::judge::{Findings, examine_all, section as table};
use super::run::Run;
use super::{HEAVE, SEA};
use crate::error::Result;
use crate::report::bench::Bench;
use crate::report::numerics::{pairs, relative_rms};
use crate::report::row::{Row, Truth, figure};
use crate::report::scene::{G, HEAVED, HEAVY_WIRE, Scene, heave};
use crate::report::section::Section;

/// Below this the wire counts as slack at its top, N.
const SLACK: f64 = 100.0;
const STEP: f64 = 0.002;
const REFERENCES: [&str; 2] = ["rodas4, 80 elements, tolerance 2e-5", "esdirk4, 80 elements, tolerance 2e-5"];

fn transition(n: usize, upwards: bool) -> impl Fn(&Run) -> f64 {
    move |run| run.crossings("anchor.tension", SLACK, upwards).get(n).copied().unwrap_or(f64::NAN)
}

fn p4b() -> Result<Case> {
    let scene =
        |elements: usize, solver: &str| -> Result<Scene> { HEAVY_WIRE.scene(G, elements, 81, &format!("{HEAVED}[solver]\n{solver}\n")) };
    Ok(Case::new("P4b: slack and snap", scene(40, "tolerance = 1e-4")?, Times::Equal(STEP, 24.0), ("anchor.tension", "Tension at the top, kN", 1e-3))
        .happens(
            "200 m of steel wire with 500 kg in vacuum, its top heaved by 5 m every 4 s: the top falls faster than the body can, the wire goes slack, and snaps taut.",
            "MoorDyn, 20 elements, 1 ms: 0.6 % rms over 24 s; Exudyn, 10 elements, 2 ms, with a Python law: 0.27 %. Who lets the wire carry compression gets 15.8 kN.",
        )
        .driven(HEAVE, |t| heave(t, 5.0, 4.0))
        .asks(Quantity::new("greatest tension", "kN", Share(2e-3), |run| 1e-3 * run.peak("anchor.tension")).against(97.7, 5e-3, "peers' converged peak, three digits; asked for 0.5 %"))
        .asks(Quantity::signal("tension over 24 s, rms", "anchor.tension", 6e-3))
        .asks(Quantity::new("first goes slack", "s", Amount(2e-3), transition(0, false)))
        .asks(Quantity::new("first taut again", "s", Amount(2e-3), transition(0, true)))
        .balanced(2e-3)
        .beside(REFERENCES[0], scene(80, "tolerance = 2e-5")?)
        .beside(REFERENCES[1], scene(80, "tolerance = 2e-5\nmethod = \"esdirk4\"")?))
}

fn in_water() -> Result<Case> {
    let body = "[anchor]\nposition = [0, 0, 5]\n[body]\nmass = 500\nvolume = 0.1\ndrag_area = 0.5\ndrag_coefficient = 1.0\n\
        [ship]\ninput = \"pose_velocity_acceleration\"\n[solver]\ntolerance = 1e-4\n";
    let sea = format!("{SEA}current.profile = [[0, 0.5, 0], [-100, 0.2, 0]]\n{body}");
    Ok(Case::new("Slack and snap in water", HEAVY_WIRE.scene(G, 80, 0, &sea)?, Times::Equal(0.005, 12.0), ("anchor.tension", "Tension at the top, kN", 1e-3))
        .happens(
            "The same heave over 195 m of water with a current: the body sinks at 4 m/s at most, the top falls at 8 m/s, the slack wire bends aside in the water and snaps.",
            "",
        )
        .driven(HEAVE, |t| heave(t, 5.0, 4.0))
        .record(&["body.tension"])
        .asks(Quantity::new("greatest tension", "kN", Share(3e-2), |run| 1e-3 * run.peak("anchor.tension")))
        .asks(Quantity::new("body first slack", "s", Amount(5e-3), |run| run.first_crossing("body.tension", SLACK, false)))
        .asks(Quantity::new("body first taut again (1 kN)", "s", Amount(2e-2), |run| {
            let slack = run.first_crossing("body.tension", SLACK, false);
            run.crossings("body.tension", 1e3, true).into_iter().find(|t| *t > slack).unwrap_or(f64::NAN)
        })))
}

/// P4b against its references, and every slack and taut instant.
fn confirmed(found: &Findings) -> (Vec<Row>, Vec<Vec<String>>) {
    let [rodas, esdirk] = [&found.others[0], &found.others[1]];
    let tension = |run: &Run| run.of("anchor.tension").to_vec();
    let distance = |a: &Run, b: &Run| relative_rms(&pairs(&tension(a), &tension(b)));
    let rows = vec![
        Row::error(Truth::Own, "P4b: rms over 24 s from the reference", distance(&found.shipped, rodas), "")
            .within(6e-3)
            .because("rodas4 with 80 elements at tolerance 2e-5; asked for 0.6 %"),
        Row::error(Truth::Own, "P4b: the reference by rodas4 from that by esdirk4, rms over 24 s", distance(esdirk, rodas), "")
            .within(2e-3)
            .because("an independent integrator: another formula, other sub-steps, Newton's method; a third of what is asked"),
        Row::relative(
            Truth::Own,
            "P4b: greatest tension, rodas4 against esdirk4",
            1e-3 * rodas.peak("anchor.tension"),
            1e-3 * esdirk.peak("anchor.tension"),
            "kN",
        )
        .within(1e-3)
        .because("the same"),
    ];
    let runs = [Some(&found.shipped), found.finer.as_ref(), Some(rodas), Some(esdirk)];
    let mut lines = Vec::new();
    let count = rodas.crossings("anchor.tension", SLACK, false).len().min(8);
    for n in 0..count {
        for (upwards, what) in [(false, "slack"), (true, "taut")] {
            let cells = runs.iter().map(|run| run.map_or(String::new(), |run| figure(transition(n, upwards)(run))));
            lines.push(std::iter::once(format!("{what} {}", n + 1)).chain(cells).collect());
        }
    }
    (rows, lines)
}

/// The section.
///
/// # Errors
/// Scenes that are no TOML.
pub fn section(bench: &Bench) -> Result<Section> {
    let found = examine_all(bench, vec![p4b()?, in_water()?]);
    let extra = found.first().and_then(|f| f.as_ref().ok()).map(confirmed);
    let mut section = table("Slack and snap", "A cable that bears no compression, heaved faster than its body can fall.", found);
    if let Some((rows, lines)) = extra {
        section = section
            .text(
                "P4b's reference is our own, made twice: by the Rosenbrock method rodas4, which takes a new tangent every sub-step, and by esdirk4, \
                 an implicit Runge-Kutta method that solves its stages by Newton's method with kept factors. The table has the instants (s) at which \
                 the tension at the top passes 100 N.",
            )
            .rows(rows)
            .table(&["Instant, s", "shipped: 40 elements, 1e-4", "80 elements, 1e-4", REFERENCES[0], REFERENCES[1]], lines);
    }
    Ok(section)
}
