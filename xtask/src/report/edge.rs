//! The edge of contact: the force on a sheave while a cable is slowly laid onto it and lifted off, or goes over a groove's rim.

use super::bench::{Bench, Drive, record, side_by_side, start};
use super::must_hold::Must;
use super::row::{Row, Truth::Exact};
use super::scene::{G, Wire};
use super::section::{Section, scaled};
use super::sheaves::{R, ROPE, sheave};
use crate::error::Result;
use crate::plots::{Chart, PALETTE, Panel, Series};
use std::f64::consts::FRAC_PI_4;

/// A force along a sweep, at equal steps of the position.
struct Sweep {
    position: Vec<f64>,
    force: Vec<f64>,
}

impl Sweep {
    /// Differences of neighbours.
    fn steps(&self) -> Vec<f64> {
        self.force.windows(2).map(|f| (f[1] - f[0]).abs()).collect()
    }

    /// A jump is a step that stands out from both of its neighbours; the steps of a continuous curve go over into each other.
    fn row(&self, what: &str) -> Row {
        let steps = self.steps();
        let greatest = steps.iter().fold(0.0, |m: f64, s| m.max(*s));
        let needle = steps.windows(3).map(|s| s[1] - s[0].max(s[2])).fold(0.0, f64::max);
        Row::error(Exact, format!("{what}: by how much a step stands out from both neighbours, over the greatest step"), needle / greatest, "")
            .within(0.01)
            .must(Must::Sweep)
            .because(format!(
                "a jump of J stands out by J; where a smooth slope has its summit, by its curvature: below 1 %. Greatest step {greatest:.2e} N of {:.3e} N",
                self.force.iter().fold(0.0, |m: f64, f| m.max(*f))
            ))
    }

    /// The curve and its slope.
    fn chart(&self, title: &str, x_label: &str, units: &Units) -> Chart {
        let x = scaled(&self.position, units.position);
        let slope: Vec<f64> = self.force.windows(2).zip(self.position.windows(2)).map(|(f, x)| (f[1] - f[0]) / (x[1] - x[0])).collect();
        let panels = vec![
            Panel::new(
                &format!("Resultant, {}", units.force.0),
                vec![Series::new("", &x, &scaled(&self.force, units.force.1), PALETTE[0])],
            ),
            Panel::new(
                &format!("Step by spacing, {}", units.slope.0),
                vec![Series::new("", &x[1..], &scaled(&slope, units.slope.1), PALETTE[1])],
            ),
        ];
        Chart::new(title, x_label, panels)
    }
}

/// How many of a unit make an SI unit, with the unit's sign where the label needs it.
struct Units {
    position: f64,
    force: (&'static str, f64),
    slope: (&'static str, f64),
}

const MILLIMETRES: Units = Units { position: 1e3, force: ("N", 1.0), slope: ("N/mm", 1e-3) };
const MICROMETRES: Units = Units { position: 1e6, force: ("mN", 1e3), slope: ("N/m", 1.0) };

/// A taut rope over a plain cylinder, its anchor lowered from start to start: each sample is an equilibrium.
fn laid_on(bench: &Bench, span: f64, count: usize) -> Result<Sweep> {
    let text = [format!("[anchor]\nposition = [-0.3, 0, {R}]\n[far_end]\nposition = [0.3, 0, {R}]\n"), sheave(1e8, None, "")];
    // Fourteen elements, so that contact begins and ends inside elements and passes over nodes as the arc grows.
    let fmu = bench.pack(&Wire { length: 0.599, ..ROPE }.scene(G, 14, 0, &text.concat())?)?;
    let position: Vec<f64> = (0..=count).map(|i| span * (i as f64 / count as f64 - 0.25)).collect();
    let rest = |dip: &f64| start(&fmu, &[("anchor.position[3]", R - dip)], &[])?.get("sheave[1].normal_force");
    let force = side_by_side(&position, rest).into_iter().collect::<Result<Vec<_>>>()?;
    Ok(Sweep { position, force })
}

/// A taut rope beside the middle of a groove, lowered at 1 mm/s past the rim against a flank, in one run.
fn over_the_rim(bench: &Bench) -> Result<Sweep> {
    let (depth, press, angle) = (0.012, 1e-3, FRAC_PI_4);
    // Where the flank would be touched with this penetration at the rim's height.
    let aside = depth * (0.5 * angle).tan() + press / (0.5 * angle).cos();
    let (from, reach) = (R + depth + 0.001, 0.5 / 0.6);
    let groove = format!("groove_angle = {angle:?}\ngroove_depth = {depth:?}\n");
    let text = format!(
        "[ship]\ninput = \"pose_velocity\"\n[anchor]\nposition = [-0.5, {aside:?}, {from:?}]\n[far_end]\nposition = [0.1, {aside:?}, {from:?}]\n{}\
         [solver]\ntolerance = 1e-4\n",
        sheave(1e6, None, &groove)
    );
    let fmu = bench.pack(&Wire { length: 0.599, mass_per_length: 1e-2, ..ROPE }.scene(G, 30, 0, &text)?)?;
    // The ship rises, the far end does not; in ship axes the rope sinks at the sheave by `reach` of that.
    let speed = 1e-3;
    let at = |t: f64| vec![speed * t, speed];
    let drive = Drive { inputs: &["ship.z", "ship.vz"], at: &at, ..Drive::still(0.01, 4.0) };
    let run = record(&fmu, &drive, ["sheave[1].normal_force"])?;
    let position = run.times.iter().map(|t| from - R - reach * speed * t).collect();
    let [force] = run.columns;
    Ok(Sweep { position, force })
}

/// The section.
///
/// # Errors
/// The FMU's.
pub fn section(bench: &Bench) -> Result<Section> {
    let coarse = laid_on(bench, 0.016, 320)?;
    let fine = laid_on(bench, 4e-5, 200)?;
    let rim = over_the_rim(bench)?;
    let rows = vec![
        coarse.row("Rope laid on, 16 mm in 320 starts"),
        fine.row("Rope laid on, 40 µm in 200 starts"),
        rim.row("Rope lowered past a groove's rim, 400 steps"),
    ];
    Ok(Section::new("The edge of contact")
        .text(
            "A taut rope of 14 elements is lowered onto a plain cylinder: each sample is a start of the FMU with another height of the anchor, its \
             greatest step and its slope are shown beside the curve. Then a rope beside the middle of a groove is lowered at 1 mm/s past the rim \
             against a flank, in one run: the flank's force sets in over the last tenth of the groove's depth (12 mm). A jump would be a needle in \
             the lower panels.",
        )
        .rows(rows)
        .chart("edge-laid-on", coarse.chart("Laid on and lifted off", "Anchor lowered by, mm", &MILLIMETRES), "Resultant on the sheave and its slope. The kink is where contact begins: a taut rope on a nearly rigid cylinder.")
        .chart("edge-close-up", fine.chart("The kink, magnified 400 times", "Anchor lowered by, µm", &MICROMETRES), "The same over 40 µm: what looks like a kink is the Hunt-Crossley force setting in with its power 1.5.")
        .chart("edge-rim", rim.chart("Past a groove's rim", "Rope's height over the groove's root, mm", &MILLIMETRES), "Resultant and slope while the rope comes down past the rim at 12 mm (to be read from right to left).")
        .csv("edge-laid-on", "anchor_lowered_m,resultant_N", &[&coarse.position, &coarse.force], "the first sweep"))
}

#[cfg(test)]
mod tests {
    use super::super::row::Verdict;
    use super::*;

    #[test]
    fn exact_a_jump_is_found_and_a_kink_is_none() {
        let position: Vec<f64> = (0..200).map(|i| f64::from(i) * 1e-3).collect();
        let sweep = |jump: f64| {
            let force = position.iter().map(|x| (x - 0.05).max(0.0).powf(1.5) + if *x > 0.12 { jump } else { 0.0 }).collect();
            Sweep { position: position.clone(), force }
        };
        assert_eq!(sweep(0.0).row("x").verdict(), Verdict::Holds);
        let greatest = sweep(0.0).steps().into_iter().fold(0.0, f64::max);
        assert_eq!(sweep(0.02 * greatest).row("x").verdict(), Verdict::Missed);
    }
}
