//! Falling and whipping: P3 beyond 1.15 s, the folded falling chain.

use super::case::{Case, Claim::*, Quantity, Times};
use super::judge::{examine_all, section as table};
use crate::error::Result;
use crate::report::bench::Bench;
use crate::report::scene::{G, NYLON, Row as ShapeRow, Wire};
use crate::report::section::Section;
use std::f64::consts::PI;

fn whip() -> Result<Case> {
    let wire = Wire { laws: "compression = \"linear\"\ndamping.axial = 0.02", ..NYLON };
    let rest = "[anchor]\nposition = [0, 0, 0]\n[body]\nmass = 1.33e-3\n[initial]\nstate = \"straight\"\ndirection = [1, 0, 0]\n[solver]\ntolerance = 1e-4\n";
    Ok(Case::new(
        "P3 beyond 1.15 s: the string whips",
        wire.scene(G, 40, 81, rest)?,
        Times::Equal(1e-3, 2.0),
        ("anchor.tension", "Tension at the pin, mN", 1e3),
    )
    .happens(
        "A string of 1 m with a sphere swings down from level, passes the lowest point, goes slack on the far side after 1.15 s and whips.",
        "their tensions are not comparable after 1.15 s, their positions are until 2 s.",
    )
    .record(&["body.x", "body.z"])
    .asks(Quantity::new("sphere's x at 1.5 s", "m", Amount(2e-3), |run| run.value("body.x", 1.5)))
    .asks(Quantity::new("sphere's z at 1.5 s", "m", Amount(2e-3), |run| run.value("body.z", 1.5)))
    .asks(Quantity::new("sphere's x at 2 s", "m", Amount(1e-2), |run| run.value("body.x", 2.0)))
    .asks(Quantity::new("sphere's z at 2 s", "m", Amount(1e-2), |run| run.value("body.z", 2.0)))
    .balanced(2e-2))
}

const LENGTH: f64 = 1.0;
/// Of the fold.
const FOLD: f64 = 0.01;

/// Time in which the tip of a chain folded without width falls by `x`: ∫ dx/v, v² = g x (2L − x)/(L − x). With x = u² the integrand is smooth.
fn fall_time(x: f64) -> f64 {
    let f = |u: f64| 2.0 * ((LENGTH - u * u) / (G * (2.0 * LENGTH - u * u))).sqrt();
    let (n, end) = (2000, x.sqrt());
    let h = end / f64::from(n);
    (0..n).map(|i| h / 6.0 * (f(f64::from(i) * h) + 4.0 * f((f64::from(i) + 0.5) * h) + f(f64::from(i + 1) * h))).sum()
}

fn chain() -> Result<Case> {
    let wire = Wire { length: LENGTH, diameter: 0.002, mass_per_length: 0.1, ea: 1e4, ei: 1e-8, laws: "damping.axial = 0.5" };
    let half = 0.5 * (LENGTH - PI * FOLD);
    let shape: Vec<ShapeRow> = (0..=1600)
        .map(|i| {
            let s = LENGTH * f64::from(i) / 1600.0;
            let turn = (s - half) / FOLD;
            if s < half {
                (s, [0.0, 0.0, -s], [0.0, 0.0, -1.0], [0.0; 3])
            } else if turn < PI {
                let (sin, cos) = turn.sin_cos();
                (s, [FOLD - FOLD * cos, 0.0, -half - FOLD * sin], [sin, 0.0, -cos], [0.0; 3])
            } else {
                (s, [2.0 * FOLD, 0.0, s - LENGTH], [0.0, 0.0, 1.0], [0.0; 3])
            }
        })
        .collect();
    let scene = wire.scene(G, 200, 401, "[anchor]\nposition = [0, 0, 0]\n[solver]\ntolerance = 3e-4\n")?.start_shape(&shape);
    let tip = "cable.point[401].z";
    let passes = move |x: f64| move |run: &super::run::Run| run.first_crossing(tip, -x, false);
    let source =
        "closed form of the chain folded without width (Calkin & March 1989, Tomaszewski et al. 2006); the fold is 2 % of the length wide";
    Ok(Case::new("Folded chain: its tip outruns gravity", scene, Times::Equal(5e-4, 0.45), (tip, "Tip's z, m", 1.0))
        .happens(
            "A chain of 1 m hangs folded, both ends at the same height; one is let go. The fold keeps the tension at the tip's side, so that the tip falls faster than g and cracks like a whip at the bottom.",
            "",
        )
        .record(&["anchor.tension"])
        .asks(Quantity::new("tip has fallen 0.5 m", "s", Share(5e-3), passes(0.5)).against(fall_time(0.5), 2e-2, source))
        .asks(Quantity::new("tip has fallen 0.9 m (a free body: 0.4283 s)", "s", Share(5e-3), passes(0.9)).against(fall_time(0.9), 2e-2, source))
        .balanced(2e-2))
}

/// The section.
///
/// # Errors
/// Scenes that are no TOML.
pub fn section(bench: &Bench) -> Result<Section> {
    let found = examine_all(bench, vec![whip()?, chain()?]);
    Ok(table(
        "Falling and whipping",
        "Motions whose speed and curvature grow without bound in the limit of a perfectly flexible chain.",
        found,
    ))
}
