//! The thesis's section 4.2: a load on a rope over a pulley on a swinging arm. It appears as soon as there is a scene of that name.

use super::bench::{Bench, Drive, record};
use super::numerics::extremes;
use super::row::{Row, Truth::Paper};
use super::scene::{G, Scene};
use super::section::{Section, level, scaled};
use crate::error::{Failure, Result};
use crate::plots::{Chart, INK, PALETTE, Panel, SOFT, Series};
use std::f64::consts::PI;

const NAME: &str = "moving_pulley";
/// Measured tension, N, and the thesis's own greatest error there.
const MEASURED: [f64; 2] = [36.9, 51.5];
const THESIS_ERROR: f64 = 6.40;
/// Of the arm, Hz.
const FREQUENCY: f64 = 1.0;
/// Periods in which the motion grows from rest, then those that settle it, then those that are measured.
const PERIODS: [f64; 3] = [2.0, 4.0, 4.0];

/// The arm's angle (positive up), its rate and its acceleration: a sinusoid that grows over the first periods by a half-cosine.
fn arm(t: f64, amplitude: f64) -> [f64; 3] {
    let (w, k) = (2.0 * PI * FREQUENCY, PI * FREQUENCY / PERIODS[0]);
    let grows = t * FREQUENCY < PERIODS[0];
    let s = if grows { [0.5 * (1.0 - (k * t).cos()), 0.5 * k * (k * t).sin(), 0.5 * k * k * (k * t).cos()] } else { [1.0, 0.0, 0.0] };
    let h = [(w * t).sin(), w * (w * t).cos(), -w * w * (w * t).sin()].map(|x| amplitude * x);
    [s[0] * h[0], s[1] * h[0] + s[0] * h[1], s[2] * h[0] + 2.0 * s[1] * h[1] + s[0] * h[2]]
}

/// The section.
///
/// # Errors
/// The FMU's.
pub fn section(bench: &Bench) -> Result<Section> {
    let title = "Thesis 4.2: moving pulley";
    let Some(scene) = Scene::built_in(NAME)? else {
        let row = Row::absent(Paper, "Tension range of the moving pulley", format!("there is no built-in scene {NAME} yet"));
        return Ok(Section::new(title)
            .text("The scene is not there yet; when it is, this section shows its tension beside the measured range.")
            .rows(vec![row]));
    };
    let fmu = bench.pack(&scene)?;
    // The arm is the ship, its hinge the ship frame's origin: pitch, positive bow down, with as many derivatives as the scene asks for.
    let names: Vec<&str> = ["ship.pitch", "ship.pitch_rate", "ship.pitch_acceleration"]
        .into_iter()
        .filter(|name| fmu.description.variable(name).is_ok())
        .collect();
    let count = names.len();
    let end = PERIODS.iter().sum::<f64>() / FREQUENCY;
    let run = |amplitude: f64| {
        let at = move |t: f64| arm(t, amplitude).iter().take(count).map(|x| -x).collect();
        let drive = Drive { inputs: &names, at: &at, ..Drive::still(0.005, end) };
        record(&fmu, &drive, ["load.tension", "sheave[1].turn_angle"])
    };
    let first = ((PERIODS[0] + PERIODS[1]) / FREQUENCY / 0.005).round() as usize;
    let range = |amplitude: f64| Ok::<_, Failure>(extremes(&run(amplitude)?.columns[0][first..]));
    // The amplitude is in a figure that we do not have: the one that gives the measured width of the range, by the secant rule.
    let width = |amplitude: f64| range(amplitude).map(|r| r[1] - r[0] - (MEASURED[1] - MEASURED[0]));
    let (mut a, mut b) = (0.04, 0.08);
    let (mut fa, mut fb) = (width(a)?, width(b)?);
    for _ in 0..8 {
        if fb.abs() < 1e-3 || fa == fb {
            break;
        }
        let next = (b - fb * (b - a) / (fb - fa)).clamp(0.25 * b, 2.0 * b);
        (a, fa) = (b, fb);
        b = next;
        fb = width(b)?;
    }
    let record = run(b)?;
    let found = extremes(&record.columns[0][first..]);
    let amplitude = b.to_degrees();
    let weight = scene.number("load.mass").unwrap_or(f64::NAN) * scene.number("gravity").unwrap_or(G);
    let because = "measured, thesis 4.2; the bound is the thesis's own greatest error. The amplitude was fitted to the width of this range, so that \
                   only the range's place is a test";
    let rows = vec![
        Row::absolute(Paper, "Moving pulley: least tension", found[0], MEASURED[0], "N").within(THESIS_ERROR).because(because),
        Row::absolute(Paper, "Moving pulley: greatest tension", found[1], MEASURED[1], "N").within(THESIS_ERROR).because(because),
        Row::absolute(Paper, "Moving pulley: middle of the range", 0.5 * (found[0] + found[1]), 0.5 * (MEASURED[0] + MEASURED[1]), "N")
            .because(format!(
                "no bound. It is further off than the thesis's standard deviation of 1.79 N. The load weighs {:.2} N, and a swing that is as good as \
                 sinusoidal has its middle there whatever the amplitude",
                weight
            )),
    ];
    let angle: Vec<f64> = record.times.iter().map(|t| arm(*t, b)[0].to_degrees()).collect();
    let mut tension =
        Panel::new("Tension at the load, N", vec![Series::new("", &record.times, &record.columns[0], PALETTE[0])]).height(240.0);
    tension.series.extend([level("measured range", [0.0, end], MEASURED[0], INK), level("", [0.0, end], MEASURED[1], INK)]);
    let panels = vec![
        Panel::new("Arm's angle, °", vec![Series::new("", &record.times, &angle, SOFT)]).height(120.0),
        tension,
        Panel::new("Rope's angle, °", vec![Series::new("", &record.times, &scaled(&record.columns[1], 1f64.to_degrees()), PALETTE[2])])
            .height(150.0),
    ];
    Ok(Section::new(title)
        .text(format!(
            "The arm swings at {FREQUENCY} Hz. Its amplitude is in a figure of the thesis that we do not have; {amplitude:.2}° was fitted here, to the \
             width of the measured tension range. The measured run begins after {} periods.",
            PERIODS[0] + PERIODS[1]
        ))
        .rows(rows)
        .chart("moving-pulley", Chart::new("4.2: moving pulley", "Time, s", panels), "Arm, tension and rope's angle from rest."))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_rates_of_the_arm_are_its_derivatives() {
        for t in [0.3, 1.1, 1.99, 3.2] {
            let (h, now) = (1e-5, arm(t, 0.05));
            let slope = |k: usize| (arm(t + h, 0.05)[k] - arm(t - h, 0.05)[k]) / (2.0 * h);
            // Central differences: h² of the third derivative, 250 times the amplitude.
            assert!((slope(0) - now[1]).abs() < 1e-8 && (slope(1) - now[2]).abs() < 1e-7, "{t}");
        }
    }
}
