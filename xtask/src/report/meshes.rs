//! `cargo xtask bench`: the flume on uniform, hand-made and automatic meshes.

use super::bench::{Bench, Drive, Record, record};
use super::numerics::{pairs, relative_rms};
use super::row::share;
use super::scene::Scene;
use super::section::Section;
use crate::demo;
use crate::error::{Failure, Result};

/// Where the scene's own mesh changes: the cable on and just off the drum, and the rest, m.
const REGIONS: [f64; 2] = [0.0818, 0.955_453_316_269_891_4];
/// How the truth is computed: method, tolerance, elements in each region.
const TRUTH: (&str, f64, [u32; 2]) = ("esdirk4", 1e-3, [96, 96]);

/// The scene's keys without its mesh.
fn without_mesh() -> Result<toml::Table> {
    let flume = Scene::built_in("flume")?.ok_or_else(|| Failure("there is no built-in scene flume".into()))?;
    let mut table: toml::Table = flume.files().0.parse().map_err(|e| Failure(format!("the flume scene: {e}")))?;
    table.remove("mesh");
    Ok(table)
}

fn ride(bench: &Bench, mesh: &str, method: &str, tolerance: f64) -> Result<Record<3>> {
    let scene = Scene::parse(&format!("{}\n[mesh]\n{mesh}\n", without_mesh()?))?;
    let fmu = bench.pack(&scene.with("solver.method", method).with("solver.tolerance", tolerance))?;
    let (sea, waves) = demo::sea_inputs()?;
    record(&fmu, &Drive { inputs: sea, at: &*waves, ..Drive::still(0.01, 20.0) }, ["winch.tension", "body.x", "body.z"])
}

fn regions([first, second]: [u32; 2]) -> String {
    format!("regions = [{{ length = {}, elements = {first} }}, {{ length = {}, elements = {second} }}]", REGIONS[0], REGIONS[1])
}

/// The section.
///
/// # Errors
/// The FMUs' own reasons.
pub fn section(bench: &Bench) -> Result<Section> {
    let (method, tolerance, elements) = TRUTH;
    let truth = ride(bench, &regions(elements), method, tolerance)?;
    let cases = [
        ("24 of equal length", "elements = 24".to_owned()),
        ("the scene's own, 12 on the drum and 12 beyond", regions([12, 12])),
        ("12 on the drum and 4 beyond", regions([12, 4])),
        ("20 on the drum and 4 beyond", regions([20, 4])),
        ("automatic, mesh.error = 0.01", "error = 0.01".to_owned()),
        ("automatic, mesh.error = 0.01, mesh.travel = 0.01 (the winch is held)", "error = 0.01\ntravel = 0.01".to_owned()),
        ("automatic, mesh.error = 0.003, mesh.travel = 0.01", "error = 0.003\ntravel = 0.01".to_owned()),
    ];
    let mut rows = vec![];
    for (what, mesh) in cases {
        let run = ride(bench, &mesh, "tr_bdf2", 1e-2)?;
        let off = relative_rms(&pairs(&run.columns[0][1..], &truth.columns[0][1..]));
        let distance = |k: usize| (run.columns[1][k] - truth.columns[1][k]).hypot(run.columns[2][k] - truth.columns[2][k]);
        let place = (1..run.times.len()).map(|k| distance(k).powi(2)).sum::<f64>() / (run.times.len() - 1) as f64;
        println!(
            "mesh   flume, {what}: tension {}, place {:.1e} m, {:.1} ms, {:.0} times real time",
            share(off),
            place.sqrt(),
            1e3 * run.seconds,
            20.0 / run.seconds
        );
        rows.push(vec![
            what.into(),
            share(off),
            format!("{:.1e}", place.sqrt()),
            format!("{:.1}", 1e3 * run.seconds),
            format!("{:.0}", 20.0 / run.seconds),
            run.sub_steps.to_string(),
        ]);
    }
    Ok(Section::new("Flume: meshes")
        .text(format!(
            "20 s in the demo's seaway, the winch held, tr_bdf2 at 1e-2, steps of 10 ms; errors of mesh and time together, against {method} at \
             {tolerance:.0e} on {} elements on the drum and {} beyond. Elements of equal length cannot lie down on a drum of 35 mm in diameter; the \
             automatic mesh asks where the cable touches during the run.",
            elements[0], elements[1]
        ))
        .table(&["Mesh", "Tension error", "Place error, m", "Run, ms", "Times real time", "Sub-steps"], rows))
}
