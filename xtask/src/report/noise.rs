//! The flume under turbulence: the ellipsoid of the body's trace. It appears as soon as there is a scene `flume_noise`.

use super::bench::{Bench, Drive, record};
use super::flume::MEASURED;
use super::numerics::Ellipsoid;
use super::row::{Row, Truth::Paper, figure};
use super::scene::Scene;
use super::section::{Section, thinned};
use crate::error::Result;
use crate::plots::{Chart, Colour, INK, Mark, PALETTE, Panel, SOFT, Series};
use nalgebra::Vector3;

const NAME: &str = "flume_noise";
/// s; the record begins after the settling time.
const END: f64 = 140.0;
const SETTLING: f64 = 20.0;
const STEP: f64 = 0.01;

/// The section.
///
/// # Errors
/// The FMU's.
pub fn section(bench: &Bench) -> Result<Section> {
    let title = "Thesis 4.3: the flume under turbulence";
    let Some(scene) = Scene::built_in(NAME)? else {
        let row = Row::absent(Paper, "Ellipsoid of the body's trace", format!("there is no built-in scene {NAME} yet"));
        return Ok(Section::new(title)
            .text("The scene is not there yet; when it is, this section shows the ellipsoid of the body's trace over two minutes.")
            .rows(vec![row]));
    };
    let run = record(&bench.pack(&scene)?, &Drive::still(STEP, END), ["body.x", "body.y", "body.z"])?;
    let first = (SETTLING / STEP).round() as usize;
    let [x, y, z] = [0, 1, 2].map(|k| &run.columns[k][first..]);
    let trace: Vec<Vector3<f64>> = (0..x.len()).map(|i| Vector3::new(x[i], y[i], z[i])).collect();
    let whole = Ellipsoid::of(&trace);
    let halves = [Ellipsoid::of(&trace[..trace.len() / 2]), Ellipsoid::of(&trace[trace.len() / 2..])];

    let rows: Vec<Row> = ["x", "y", "z"]
        .into_iter()
        .enumerate()
        .map(|(k, axis)| {
            Row::absolute(Paper, format!("Centre of the trace: {axis}"), whole.centre[k], MEASURED[k], "m")
                .because("measured centroid without motion, thesis 4.3.1; no bound: the mean flow alone is held against it in the section on the flume at rest")
        })
        .collect();
    let table = (0..3)
        .map(|k| {
            let a = whole.axes[k];
            vec![
                (k + 1).to_string(),
                figure(1e3 * whole.deviations[k]),
                figure(2e3 * whole.deviations[k]),
                format!("({:.3}, {:.3}, {:.3})", a.x, a.y, a.z),
                format!("{}, {}", figure(1e3 * halves[0].deviations[k]), figure(1e3 * halves[1].deviations[k])),
            ]
        })
        .collect();
    let planes = [([0, 2], "x, m", "z, m"), ([0, 1], "x, m", "y, m"), ([1, 2], "y, m", "z, m")];
    let mut section = Section::new(title)
        .text(format!(
            "The flow of the flume with seeded, filtered noise of the measured standard deviations (0.0300, 0.0262 and 0.0152 m/s along x, y, z). \
             The body's trace over {:.0} s, after {SETTLING:.0} s of settling, and the ellipsoid of its covariance: centre, semi-axes at one and \
             two standard deviations, directions. The last column tells how far two minutes determine it: each half of the record alone.",
            END - SETTLING
        ))
        .rows(rows)
        .table(&["Axis", "1 σ, mm", "2 σ, mm", "Direction (x, y, z)", "1 σ of the halves, mm"], table);
    for (plane, x_label, y_label) in planes {
        let chart = projection(&trace, &whole, plane, x_label, y_label);
        let file = format!("noise-{}{}", ["x", "y", "z"][plane[0]], ["x", "y", "z"][plane[1]]);
        section = section.chart(
            &file,
            chart,
            "The body's trace (every 50 ms) with its ellipsoid at 1 and 2 σ; the black dot is the measured centroid without motion.",
        );
    }
    let every = 10;
    let [x, y, z] = [x, y, z].map(|v| thinned(v, every));
    let t = thinned(&run.times[first..], every);
    Ok(section.csv("flume_noise", "t_s,x_m,y_m,z_m", &[&t, &x, &y, &z], "the trace, every 0.1 s"))
}

fn projection(trace: &[Vector3<f64>], ellipsoid: &Ellipsoid, plane: [usize; 2], x_label: &str, y_label: &str) -> Chart {
    let line =
        |label: &str, points: Vec<(f64, f64)>, colour: Colour, width: f64| Series { points, width, ..Series::new(label, &[], &[], colour) };
    let [i, j] = plane;
    let series = vec![
        line("trace", trace.iter().step_by(5).map(|p| (p[i], p[j])).collect(), SOFT, 0.7),
        line("1 σ", ellipsoid.outline(1.0, plane), PALETTE[0], 2.0),
        line("2 σ", ellipsoid.outline(2.0, plane), PALETTE[1], 2.0),
    ];
    let mut panel = Panel::new(y_label, series);
    panel.marks.push(Mark::Dot { centre: (ellipsoid.centre[i], ellipsoid.centre[j]), radius: 3.5, colour: PALETTE[0] });
    panel.marks.push(Mark::Dot { centre: (MEASURED[i], MEASURED[j]), radius: 3.5, colour: INK });
    Chart {
        equal_aspect: true,
        width: 640.0,
        ..Chart::new(&format!("Trace in the {}-{} plane", ["x", "y", "z"][i], ["x", "y", "z"][j]), x_label, vec![panel])
    }
}
