//! What the ship's motion costs in tension, by what is known of it between communication points.

use super::bench::{Bench, side_by_side, start};
use super::row::{Row, Truth::Exact, share};
use super::scene::Scene;
use super::section::{Section, dotted};
use crate::error::{Failure, Result};
use crate::host::Fmu;
use crate::plots::{Chart, PALETTE, Panel, Series};
use std::f64::consts::TAU;

/// Communication steps, s.
const STEPS: [f64; 8] = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2];
/// Tensions are compared every so often, where all runs have a communication point; s. The motion grows out of rest before.
const SAMPLE: f64 = 0.2;
const FIRST: f64 = 2.0;
const END: f64 = 5.0;
/// Of the reference. The runs keep the scene's 1e-4.
const TIGHT: f64 = 5e-5;

/// Amplitude (m or rad), period (s), phase (rad) of surge, sway, heave, roll, pitch and yaw: an 80 m ship in bow quartering seas of 2.5 m.
const MOTIONS: [[f64; 3]; 6] =
    [[0.15, 8.6, 0.3], [0.09, 8.6, 1.1], [0.22, 7.1, 2.2], [0.016, 11.3, 1.0], [0.017, 8.6, 5.1], [0.007, 7.1, 3.9]];
/// The pose and its first and second derivatives, by their names as inputs.
const NAMES: [[&str; 6]; 3] = [
    ["ship.x", "ship.y", "ship.z", "ship.roll", "ship.pitch", "ship.yaw"],
    ["ship.vx", "ship.vy", "ship.vz", "ship.roll_rate", "ship.pitch_rate", "ship.yaw_rate"],
    ["ship.ax", "ship.ay", "ship.az", "ship.roll_acceleration", "ship.pitch_acceleration", "ship.yaw_acceleration"],
];

/// What a master gives at each communication point.
struct Form {
    name: &'static str,
    /// The scene's `ship.input`.
    input: &'static str,
    /// Derivatives that come as inputs.
    inputs: usize,
    /// Order up to which they come by fmi2SetRealInputDerivatives.
    derivatives: usize,
}

const FORMS: [Form; 5] = [
    Form { name: "pose", input: "pose", inputs: 0, derivatives: 0 },
    Form { name: "pose_velocity", input: "pose_velocity", inputs: 1, derivatives: 0 },
    Form { name: "pose_velocity_acceleration", input: "pose_velocity_acceleration", inputs: 2, derivatives: 0 },
    Form { name: "pose, derivatives of order 1", input: "pose", inputs: 0, derivatives: 1 },
    Form { name: "pose, derivatives of order 1 and 2", input: "pose", inputs: 0, derivatives: 2 },
];

/// Pose, velocity and acceleration of the ship, which comes out of rest within [`FIRST`].
fn motion(t: f64) -> [[f64; 6]; 3] {
    let x = (t / FIRST).min(1.0);
    let ramp = [
        x.powi(3) * (10.0 - 15.0 * x + 6.0 * x * x),
        30.0 * (x * (1.0 - x)).powi(2) / FIRST,
        60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) / FIRST.powi(2),
    ];
    let mut all = [[0.0; 6]; 3];
    for (c, [amplitude, period, phase]) in MOTIONS.into_iter().enumerate() {
        let w = TAU / period;
        let (sin, cos) = (w * t + phase).sin_cos();
        let m = [sin, w * cos, -w * w * sin].map(|x| amplitude * x);
        all[0][c] = ramp[0] * m[0];
        all[1][c] = ramp[1] * m[0] + ramp[0] * m[1];
        all[2][c] = ramp[2] * m[0] + 2.0 * ramp[1] * m[1] + ramp[0] * m[2];
    }
    all
}

/// Input derivatives give the motion that the inputs for them give, so that few steps are enough to see it.
const TWINS_FROM: f64 = 0.02;

/// The winch tension every [`SAMPLE`] from [`FIRST`] on, N.
fn tensions(fmu: &Fmu, form: &Form, step: f64, tolerance: Option<f64>) -> Result<Vec<f64>> {
    let references =
        |order: usize| NAMES[order].iter().map(|name| Ok(fmu.description.variable(name)?.reference)).collect::<Result<Vec<_>>>();
    let inputs = (0..=form.inputs).map(references).collect::<Result<Vec<_>>>()?;
    let parameters: Vec<(&str, f64)> = tolerance.map(|t| ("solver.tolerance", t)).into_iter().collect();
    let instance = start(fmu, &parameters, &[])?;
    let every = (SAMPLE / step).round() as usize;
    let mut tensions = Vec::new();
    for k in 0..(END / step).round() as usize {
        let t = k as f64 * step;
        let motion = motion(t);
        for (references, values) in inputs.iter().zip(&motion) {
            instance.set_reals(references, values)?;
        }
        for order in 1..=form.derivatives {
            instance.set_input_derivatives(&inputs[0], order as i32, &motion[order])?;
        }
        instance.do_step(t, step).map_err(|e| Failure(format!("{} at t = {t} s, steps of {step} s: {e}", form.name)))?;
        if (k + 1).is_multiple_of(every) && t + step >= FIRST {
            tensions.push(instance.get("winch.tension")?);
        }
    }
    Ok(tensions)
}

/// The section.
///
/// # Errors
/// The FMU's.
pub fn section(bench: &Bench) -> Result<Section> {
    let scene = || Scene::built_in("overboard")?.ok_or_else(|| Failure("there is no built-in scene overboard".into()));
    let pack = |form: &Form| bench.pack(&scene()?.with("solver.method", "rodas4").with("ship.input", form.input));
    let fmus = FORMS.iter().map(pack).collect::<Result<Vec<_>>>()?;
    let (pose, velocity, full) = (0, 1, 2);
    // The reference takes longest, so it comes first.
    let mut jobs = vec![(full, STEPS[0], Some(TIGHT))];
    jobs.extend(STEPS.iter().flat_map(|step| (0..FORMS.len()).map(|form| (form, *step, None))));
    let runs = side_by_side(&jobs, |(form, step, tolerance)| match FORMS[*form].derivatives {
        1.. if *step < TWINS_FROM => Ok(None),
        // That is the reference.
        _ if *form == full && *step == STEPS[0] && tolerance.is_none() => Ok(None),
        _ => tensions(&fmus[*form], &FORMS[*form], *step, *tolerance).map(Some),
    });
    let mut runs = runs.into_iter();
    let reference = runs.next().transpose()?.flatten().unwrap_or_default();
    let mean = reference.iter().sum::<f64>() / reference.len() as f64;
    // Greatest error over the mean tension; a run that could not be done has none.
    let greatest = |run: &[f64]| run.iter().zip(&reference).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / mean;
    // A run whose step was refused has no error either.
    let errors: Vec<Option<f64>> = runs.map(|run| Some(greatest(&run.ok()??))).collect();
    let error = |step: usize, form: usize| errors[step * FORMS.len() + form];

    let table = STEPS.iter().enumerate().map(|(s, step)| {
        let cells = (0..FORMS.len()).map(|f| error(s, f).map_or_else(String::new, share));
        std::iter::once(format!("{:.0} ms", 1e3 * step)).chain(cells).collect()
    });
    let header: Vec<&str> = std::iter::once("Communication step").chain(FORMS.iter().map(|f| f.name)).collect();
    let series = FORMS.iter().enumerate().map(|(f, form)| {
        let points = (0..STEPS.len()).filter_map(|s| Some(((1e3 * STEPS[s]).log10(), error(s, f)?.max(1e-9).log10()))).collect();
        let line = Series { points, ..Series::new(form.name, &[], &[], PALETTE[f]) };
        // The same figures as another form's: both shall be seen.
        if form.derivatives > 0 { line.dashed() } else { line }
    });
    let chart = Chart::new(
        "Tension error by communication step and kind of input",
        "log10 of the communication step in ms",
        vec![dotted(Panel::new("log10 of the greatest error over the mean tension", series.collect()).height(320.0))],
    );
    let at = |ms: f64| STEPS.iter().position(|s| (1e3 * s - ms).abs() < 1e-6).unwrap_or(0);
    let row = |form: usize, ms: f64, bound: f64, why: &str| match error(at(ms), form) {
        Some(e) => Row::error(Exact, format!("{} every {ms:.0} ms", FORMS[form].name), e, "").within(bound).because(why),
        None => Row::failed(Exact, format!("{} every {ms:.0} ms", FORMS[form].name), "a step was refused"),
    };
    let steps: Vec<f64> = STEPS.iter().map(|s| 1e3 * s).collect();
    let column = |f: usize| -> Vec<f64> { (0..STEPS.len()).map(|s| error(s, f).unwrap_or(f64::NAN)).collect() };
    let columns: Vec<Vec<f64>> = (0..FORMS.len()).map(column).collect();
    let all: Vec<&[f64]> = std::iter::once(&steps[..]).chain(columns.iter().map(|c| &c[..])).collect();
    Ok(Section::new("What the ship's motion costs in tension")
        .text(format!(
            "The scene overboard in a seaway, its ship given at communication points of 1 to 200 ms in five ways. The figure is the greatest error \
             of winch.tension at the multiples of {SAMPLE} s from {FIRST} to {END} s, over its mean of {mean:.0} N; the reference has accelerations \
             every millisecond and a solver tolerance of {TIGHT:.0e} in place of 1e-3. Between communication points the FMU continues the highest \
             derivative that it knows by the parabola through its last three values, so that no form is a staircase."
        ))
        .rows(vec![
            row(full, 100.0, 1e-2, "what the FMU's documentation promises of pose_velocity_acceleration"),
            row(velocity, 50.0, 1e-2, "what it promises of pose_velocity"),
            row(pose, 10.0, 1e-2, "what it promises of a pose alone"),
        ])
        .table(&header, table.collect())
        .chart("inputs", chart, "Input derivatives (dashed) and the inputs for the same derivatives give the same motion, and the same error.")
        .csv("inputs", "step_ms,pose,pose_velocity,pose_velocity_acceleration,pose_d1,pose_d2", &all, "greatest error over the mean tension"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_the_derivatives_are_those_of_the_motion() {
        let h = 1e-5;
        for t in [1.3, 2.9, 5.0] {
            let (below, at, above) = (motion(t - h), motion(t), motion(t + h));
            for order in 1..3 {
                for c in 0..6 {
                    let difference = (above[order - 1][c] - below[order - 1][c]) / (2.0 * h);
                    // h²/6 of the third derivative, and rounding 1e-16/h.
                    assert!((at[order][c] - difference).abs() < 1e-9, "{order} {c}");
                }
            }
        }
    }
}
