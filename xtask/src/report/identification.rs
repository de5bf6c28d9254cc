//! The thesis's parameters identified anew: bending stiffness from the elastica, damping ratio over the damping coefficient.

use super::bench::{Bench, Drive, record, side_by_side, start, vector};
use super::numerics::{damping_ratio, golden_section, table};
use super::row::{Row, Truth::Paper, figure};
use super::scene::{G, NYLON, Wire};
use super::section::{Section, dotted, scaled};
use super::statics::{CANTILEVER, CLAMPED, ELASTICA};
use crate::error::{Failure, Result};
use crate::plots::{Chart, INK, PALETTE, Panel, Series};

/// Of the nylon, from the photograph, N·m² (thesis 4.3).
const THESIS_EI: f64 = 2.82e-6;
/// ζ = 112.72 c for the 1.01 m pendulum (thesis 4.3), 1/(N·s).
const THESIS_SLOPE: f64 = 112.72;
/// The thesis's damping coefficient, N·s.
const THESIS_C: f64 = 5.4e-4;

/// The section.
///
/// # Errors
/// The FMU's.
pub fn section(bench: &Bench) -> Result<Section> {
    let ei = bending_stiffness(bench)?;
    let (mut rows, chart, decays) = damping(bench)?;
    rows.insert(0, ei);
    Ok(Section::new("Thesis 4.3: parameters identified anew")
        .text(
            "EI: the photograph of the 46.4 mm cantilever is not at hand, only the stiffness that the thesis takes from it. So the tip of the \
             elastica with that stiffness stands for the photograph, and golden-section search over cable.EI of the packed FMU has to find it \
             again. ζ: the 1.01 m cable with its 1.33 g sphere swings from 0.02 rad in vacuum with the thesis's damping model (gradient_rate), and \
             the logarithmic decrement gives ζ for four coefficients c. G is in the section before.",
        )
        .rows(rows)
        .chart("damping", chart, "Damping ratio of the pendulum over the coefficient: ours as dots, the thesis's line."
        )
        .chart("decay", decays, "The swing at the thesis's coefficient."))
}

fn bending_stiffness(bench: &Bench) -> Result<Row> {
    let tip = table(ELASTICA).pop().ok_or_else(|| Failure("the elastica's reference is empty".into()))?;
    let fmu = bench.pack(&CANTILEVER.scene(G, 32, 0, CLAMPED)?)?;
    let far = |log: f64| {
        let body = vector(&start(&fmu, &[("cable.EI", log.exp())], &[])?, "body")?;
        Ok::<_, Failure>((body[0] - tip[1]).hypot(body[2] - tip[2]))
    };
    let (log, tried) = golden_section(far, (1e-6f64.ln(), 1e-5f64.ln()), 1e-6)?;
    let what = format!("EI from the elastica's tip, {} starts, 32 elements", tried.len());
    Ok(Row::relative(Paper, what, log.exp(), THESIS_EI, "N·m²")
        .within(1e-3)
        .because("thesis 4.3; the clamp and the mesh move the tip by 3.4e-6 of the length, whose share of EI is below 1e-4"))
}

fn damping(bench: &Bench) -> Result<(Vec<Row>, Chart, Chart)> {
    let coefficients = [1e-4, 3e-4, THESIS_C, 1e-3];
    let wire = Wire { length: 1.01, laws: "damping = { model = \"gradient_rate\", coefficient = 5.4e-4 }", ..NYLON };
    let (sine, cosine) = 0.02f64.sin_cos();
    let rest = format!(
        "[anchor]\nposition = [0, 0, 0]\n[body]\nmass = 1.33e-3\n[initial]\nstate = \"released\"\ndirection = [{sine:?}, 0, {:?}]\n\
         [solver]\ntolerance = 1e-4\n",
        -cosine
    );
    let fmu = bench.pack(&wire.scene(G, 12, 0, &rest)?)?;
    let runs = side_by_side(&coefficients, |c| {
        let drive = Drive { parameters: &[("cable.damping.coefficient", *c)], ..Drive::still(0.01, 12.0) };
        record(&fmu, &drive, ["body.x"])
    });
    let (mut rows, mut zetas, mut decay) = (Vec::new(), Vec::new(), None);
    for (c, run) in coefficients.into_iter().zip(runs) {
        let run = run?;
        let zeta = damping_ratio(&run.columns[0]).ok_or_else(|| Failure("the pendulum does not swing".into()))?;
        rows.push(
            Row::relative(Paper, format!("ζ/c of the 1.01 m pendulum, c = {} N·s", figure(c)), zeta / c, THESIS_SLOPE, "1/(N·s)")
                .within(0.02)
                .because(
                    "thesis: ζ = 112.72 c; a rigid rotation gives c L/(2 I ω) = 112.4 c; the swing's own bending and amplitude the rest",
                ),
        );
        zetas.push(zeta);
        if c == THESIS_C {
            decay = Some(run);
        }
    }
    let line = [0.0, 1.05e-3];
    let ours = Series::new("fairlead", &scaled(&coefficients, 1e3), &zetas, PALETTE[0]);
    let panel = dotted(Panel::new("ζ", vec![Series { width: 0.1, ..ours }]));
    let mut panel = panel.height(230.0);
    panel.series.push(Series::new("thesis, ζ = 112.72 c", &scaled(&line, 1e3), &scaled(&line, THESIS_SLOPE), INK).dashed().width(1.3));
    let decay = decay.ok_or_else(|| Failure("no run at the thesis's coefficient".into()))?;
    let swing = Series::new("", &decay.times, &scaled(&decay.columns[0], 1e3), PALETTE[0]);
    Ok((
        rows,
        Chart::new("4.3: damping ratio", "c, mN·s", vec![panel]),
        Chart::new("4.3: decay of the swing", "Time, s", vec![Panel::new("Body's x, mm", vec![swing])]),
    ))
}
