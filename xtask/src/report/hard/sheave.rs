//! On the sheave: lifting off and landing, slack over it, climbing out of the groove, the margin against detachment through zero.

use super::HEAVE;
use super::case::{Case, Claim::*, Quantity, Times};
use super::judge::{examine_all, section as table};
use crate::error::Result;
use crate::report::bench::Bench;
use crate::report::scene::{G, Scene, Wire, heave};
use crate::report::section::Section;
use crate::report::sheaves::regions;
use std::f64::consts::{FRAC_PI_4, PI};

/// A rope of 8 mm.
const ROPE: Wire =
    Wire { length: 0.7, diameter: 0.008, mass_per_length: 0.06, ea: 2e5, ei: 1e-3, laws: "damping = { axial = 60, bending = 1e-4 }" };
const RADIUS: f64 = 0.046;
/// To the centreline.
const R: f64 = RADIUS + 0.004;

fn sheave(rest: &str) -> String {
    let stiffness = if rest.contains("stiffness") { "" } else { "stiffness = 1e9\n" };
    format!("[[sheave]]\nposition = [0, 0, 0]\naxis = [0, 1, 0]\nradius = {RADIUS}\n{stiffness}{rest}")
}

/// Between an anchor and a far end, just taut over the sheave, which the ship lowers and raises.
fn lift_off() -> Result<Case> {
    let low = R - 0.01;
    let rest = format!(
        "[ship]\ninput = \"pose_velocity_acceleration\"\n[anchor]\nposition = [-0.3, 0, {low}]\n[far_end]\nposition = [0.3, 0, {low}]\n{}\
         [solver]\ntolerance = 1e-4\n",
        sheave("groove_angle = 0.7853981633974483\ngroove_depth = 0.012\n")
    );
    let scene = Wire { length: 0.5997, ..ROPE }.scene(G, 60, 121, &rest)?;
    Ok(Case::new("Lifting off the sheave and landing", scene, Times::Equal(5e-4, 2.0), ("sheave[1].normal_force", "Force on the sheave, N", 1.0))
        .happens(
            "A rope between the ship and a fixed point passes a grooved sheave on the ship, which heaves by 30 mm every half second: the rope leaves the groove and lands in it again.",
            "",
        )
        .driven(HEAVE, |t| heave(t, 0.03, 0.5))
        .asks(Quantity::new("first lift-off", "s", Amount(1e-3), |run| run.first_crossing("sheave[1].normal_force", 0.1, false)))
        .asks(Quantity::new("first landing", "s", Amount(1e-3), |run| {
            let off = run.first_crossing("sheave[1].normal_force", 0.1, false);
            run.crossings("sheave[1].normal_force", 0.1, true).into_iter().find(|t| *t > off).unwrap_or(f64::NAN)
        }))
        .asks(Quantity::new("greatest force on the sheave", "N", Share(1e-2), |run| run.peak("sheave[1].normal_force")))
        .balanced(2e-2))
}

/// A body that falls slower than the ship, over a sheave.
fn slack() -> Result<Case> {
    let r = 0.25 + 0.008;
    let wire = Wire {
        length: 12.0,
        diameter: 0.016,
        mass_per_length: 1.05,
        ea: 1.2e7,
        ei: 10.0,
        laws: "damping = { axial = 2e4, bending = 0.5 }",
    };
    let rest = format!(
        "[ship]\ninput = \"pose_velocity_acceleration\"\n[anchor]\nposition = [-2, 0, {r}]\n[body]\nmass = 100\n\
         [[sheave]]\nposition = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 0.25\nstiffness = 1e9\ngroove_angle = {FRAC_PI_4:?}\ngroove_depth = 0.03\n\
         [solver]\ntolerance = 1e-3\n"
    );
    let scene = wire.scene(G, 1, 0, &rest)?.with("mesh", regions(&[(1.8, 14), (0.9, 28), (9.3, 18)]));
    Ok(Case::new("Slack over the sheave", scene, Times::Equal(5e-3, 7.0), ("sheave[1].normal_force", "Force on the sheave, kN", 1e-3))
        .happens(
            "A ship heaves so hard that 100 kg on its wire float: the wire goes slack in the groove of the sheave and snaps into it again.",
            "",
        )
        .driven(HEAVE, |t| heave(t, 5.0, 3.5))
        .asks(Quantity::new("first off the sheave", "s", Amount(5e-3), |run| run.first_crossing("sheave[1].normal_force", 10.0, false)))
        .asks(Quantity::new("greatest force on the sheave", "kN", Share(2e-2), |run| 1e-3 * run.peak("sheave[1].normal_force"))))
}

/// From an anchor at the height of the top over the sheave straight down to a body with a force on it.
fn hang(surface: &str, mass_per_length: f64, tolerance: f64, mesh: [i64; 3]) -> Result<Scene> {
    let rest = format!(
        "[anchor]\nposition = [-0.3, 0, {R}]\n{}[body]\nmass = 10\nforce_input = true\n[solver]\ntolerance = {tolerance:?}\n",
        sheave(surface)
    );
    let [before, over, below] = mesh;
    Ok(Wire { mass_per_length, ..ROPE }.scene(G, 1, 0, &rest)?.with("mesh", regions(&[(0.28, before), (0.12, over), (0.3, below)])))
}

fn climbing() -> Result<Case> {
    Ok(Case::new("Climbing out of the groove", hang("stiffness = 1e8\ndamping = 5\ngroove_angle = 1.5707963267948966\ngroove_depth = 0.008\n", 0.06, 5e-4, [5, 20, 4])?, Times::Equal(2e-3, 2.5), ("sheave[1].out_of_groove", "Out of the groove", 1.0))
        .happens(
            "A growing force along the sheave's axis pulls the body aside; the rope runs up a flank of the groove at a growing fleet angle, passes the rim, slips off the sheave's side, and the body falls until the rope is straight.",
            "",
        )
        .record(&["body.y", "body.z", "sheave[1].normal_force", "anchor.tension"])
        .driven(&["body.force.y"], |t| vec![60.0 * t])
        .asks(Quantity::new("first out of the groove", "s", Amount(5e-2), |run| run.first_crossing("sheave[1].out_of_groove", 0.5, true)))
        .asks(Quantity::new("off the sheave", "s", Amount(1e-2), |run| run.first_crossing("sheave[1].normal_force", 1.0, false)))
        .asks(Quantity::new("greatest tension at the anchor", "N", Share(5e-2), |run| run.peak("anchor.tension"))))
}

fn margin() -> Result<Case> {
    let push = |t: f64| 100.0 * (PI * t / 6.0).sin().powi(2);
    Ok(Case::new("Detachment margin through zero", hang("", 0.01, 1e-4, [14, 60, 10])?, Times::Equal(5e-3, 6.0), ("sheave[1].line_load_min", "Least line load, N/m", 1.0))
        .happens(
            "A force lifts the body until the rope is slack and lets it down again: the least line load in the contact arc, T/R while the rope is taut, goes to zero and comes back.",
            "",
        )
        .record(&["sheave[1].normal_force", "body.tension"])
        .driven(&["body.force.z"], move |t| vec![push(t)])
        .asks(
            Quantity::new("margin at 1.5 s", "N/m", Share(5e-3), |run| run.value("sheave[1].line_load_min", 1.5))
                .against((10.0 * G - 50.0) / R, 1e-2, "closed form T/R; the rope's own weight and its bending 1 %"),
        )
        .asks(Quantity::new("margin is lost (5 N/m)", "s", Amount(5e-3), |run| run.first_crossing("sheave[1].line_load_min", 5.0, false)))
        .asks(Quantity::new("margin is back (5 N/m)", "s", Amount(2e-2), |run| {
            run.crossings("sheave[1].line_load_min", 5.0, true).last().copied().unwrap_or(f64::NAN)
        })))
}

/// The section.
///
/// # Errors
/// Scenes that are no TOML.
pub fn section(bench: &Bench) -> Result<Section> {
    let found = examine_all(bench, vec![lift_off()?, slack()?, climbing()?, margin()?]);
    Ok(table("Hard cases on the sheave", "Contact that begins, ends and moves over an edge.", found))
}
