//! `cargo xtask bench`, second part: what things cost. A Newton iteration per element over the number of elements, the parts of a scene, the
//! FMI layer, the start, memory, and many instances.
//!
//! All times are the least of a few runs of one thread. They belong to the machine that the page names; what is to be read are the ratios.

use super::bench::{Bench, Drive, record, start};
use super::scene::{G, HEAVED, HEAVY_WIRE, Scene, heave};
use super::section::{Section, dotted};
use crate::demo;
use crate::error::{Failure, Result};
use crate::host::Fmu;
use crate::plots::{Chart, PALETTE, Panel, Series};
use fairlead::math::lanes::{Kernel, widest};
use model_description::Kind;
use std::fs;
use std::hint::black_box;
use std::time::Instant;

const REPEATS: usize = 3;
const ELEMENTS: [usize; 7] = [10, 30, 50, 100, 300, 1000, 3000];
const INSTANCES: [usize; 3] = [1, 2, 100];
/// Calls that are timed together.
const CALLS: usize = 20_000;

/// The sections.
///
/// # Errors
/// The FMUs' own reasons.
pub fn sections(bench: &Bench) -> Result<Vec<Section>> {
    Ok(vec![super::meshes::section(bench)?, elements(bench)?, parts(bench)?, border(bench)?])
}

fn least(mut of: impl FnMut() -> Result<f64>) -> Result<f64> {
    (0..REPEATS).try_fold(f64::INFINITY, |least, _| Ok(of()?.min(least)))
}

/// Deep water.
fn fluid() -> Result<toml::Table> {
    let text = "density = 1025\nwaterline = 1\ndrag = { law = \"cross_flow\", cd_normal = 1.2, cd_tangential = 0.01 }\n";
    text.parse().map_err(|e| Failure(format!("the table of water: {e}")))
}

/// Cost of an iteration over the number of elements.
fn elements(bench: &Bench) -> Result<Section> {
    let rows = ["in vacuum", "in water"].map(|medium| -> Result<Vec<f64>> {
        ELEMENTS
            .iter()
            .map(|&n| {
                let mut scene = HEAVY_WIRE.scene(G, n, 0, HEAVED)?.with("solver.method", "tr_bdf2").with("solver.tolerance", 1e-2);
                if medium == "in water" {
                    scene = scene
                        .with("fluid", fluid()?)
                        .with("body.volume", 0.06)
                        .with("body.drag_area", 0.2)
                        .with("body.drag_coefficient", 0.5);
                }
                let fmu = bench.pack(&scene)?;
                // Long enough for the clock, short enough for thousands of elements.
                let steps = (60_000 / n).clamp(30, 2000);
                let at = |t: f64| heave(t, 2.5, 6.0);
                let drive = Drive { inputs: &["ship.z", "ship.vz", "ship.az"], at: &at, ..Drive::still(0.01, 0.01 * steps as f64) };
                let mut iterations = 0.0;
                let seconds = least(|| {
                    let run = record(&fmu, &drive, ["anchor.tension"])?;
                    iterations = run.iterations;
                    Ok(run.seconds)
                })?;
                let cost = 1e9 * seconds / (iterations * n as f64);
                println!("cost   {n:5} elements {medium}: {cost:7.1} ns per element and Newton iteration, outputs included");
                Ok(cost)
            })
            .collect()
    });
    let [vacuum, water] = rows;
    let (vacuum, water) = (vacuum?, water?);
    let line = |name: &str, costs: &[f64], colour: usize| Series {
        points: ELEMENTS.iter().zip(costs).map(|(n, c)| ((*n as f64).log10(), *c)).collect(),
        ..Series::new(name, &[], &[], PALETTE[colour])
    };
    let chart = Chart::new(
        "Cost of a Newton iteration",
        "log10 of the number of elements",
        vec![dotted(Panel::new("ns per element", vec![line("in vacuum", &vacuum, 0), line("in water", &water, 1)]).height(260.0))],
    );
    let low = vacuum.iter().copied().fold(f64::INFINITY, f64::min);
    let spread = |costs: &[f64]| {
        let from = ELEMENTS.iter().position(|n| *n >= 50).unwrap_or(0);
        let (low, high) = costs[from..].iter().fold((f64::INFINITY, 0.0f64), |(l, h), c| (l.min(*c), h.max(*c)));
        format!("{:.0} %", 100.0 * (high / low - 1.0))
    };
    let peak = peak();
    println!("cost   the processor's peak: {peak:.1} GFLOP/s");
    let table = ELEMENTS.iter().zip(vacuum.iter().zip(&water)).map(|(n, (v, w))| vec![n.to_string(), format!("{v:.0}"), format!("{w:.0}")]);
    Ok(Section::new("Cost over the number of elements")
        .text(format!(
            "200 m of wire heaved in steps of 10 ms, tr_bdf2: run time over Newton iterations and elements, so with its share of tangents, \
             factorizations and outputs. From 50 to 3000 elements it varies by {} in vacuum and {} in water.",
            spread(&vacuum),
            spread(&water)
        ))
        .text(format!(
            "Beside it the processor: one thread multiplied and added (two roundings, as the kernels do, in the widest registers) {peak:.1} \
             thousand million times a second, the best of a few tries. The force on a dry element with its share of the solve takes some \
             {OPERATIONS} operations (counted by hand), {:.0} ns at that pace; the cheapest iteration above takes {low:.0} ns an element with its \
             share of tangents, factorizations, the ledger's evaluations and outputs, {:.0} % of the peak.",
            OPERATIONS / peak,
            100.0 * OPERATIONS / (peak * low),
        ))
        .chart("cost-elements", chart, "A line that is level: cost grows like the number of elements.")
        .table(&["Elements", "In vacuum, ns", "In water, ns"], table.collect()))
}

/// Independent multiplications and additions in registers.
struct Busy {
    rounds: usize,
}

/// Additions and multiplications of an iteration on a dry element: three Gauss points of 250, weight and inertia of 300, and its node's share
/// of the block solve, two triangular and two coupling products of 6 × 6, with the sums of vectors around it 450.
const OPERATIONS: f64 = 1500.0;

/// Numbers that are busy side by side: enough to hide how long one operation takes.
const BUSY: usize = 96;

impl Kernel for Busy {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let (shrink, push) = (black_box(0.999_999), black_box(1e-9));
        let mut x = [1.0; BUSY];
        for _ in 0..self.rounds {
            for x in &mut x {
                *x = *x * shrink + push;
            }
        }
        x.iter().sum()
    }
}

/// Multiplications and additions of one thread, 1e9/s.
fn peak() -> f64 {
    let rounds = 2_000_000;
    let timed = || {
        let clock = Instant::now();
        black_box(widest(Busy { rounds }));
        clock.elapsed().as_secs_f64()
    };
    let least = (0..2 * REPEATS).map(|_| timed()).fold(f64::INFINITY, f64::min);
    2e-9 * (BUSY * rounds) as f64 / least
}

/// The flume with and without its parts.
fn parts(bench: &Bench) -> Result<Section> {
    let flume = || Scene::built_in("flume")?.ok_or_else(|| Failure("there is no built-in scene flume".into()));
    let without = |tables: &[&str]| -> Result<Scene> {
        let (text, _) = flume()?.files();
        let mut table: toml::Table = text.parse().map_err(|e| Failure(format!("the flume scene: {e}")))?;
        for path in tables {
            match path.split_once('.') {
                Some((outer, inner)) => drop(table.get_mut(outer).and_then(toml::Value::as_table_mut).and_then(|t| t.remove(inner))),
                None => drop(table.remove(*path)),
            }
        }
        Scene::parse(&table.to_string())
    };
    let (sea, waves) = demo::sea_inputs()?;
    let dry = ["fluid", "body.volume", "body.drag_area", "body.drag_coefficient", "body.added_mass"];
    let pressed = ["winch.stiffness", "winch.damping", "winch.exponent"];
    let cases: [(&str, Scene); 5] = [
        ("as it is", flume()?),
        ("without the drum's contact", without(&pressed)?),
        ("without bending stiffness and contact", without(&pressed)?.with("cable.EI", 0.0)),
        ("without water", without(&dry)?),
        ("without water and contact", without(&[&dry[..], &pressed[..]].concat())?),
    ];
    let mut rows: Vec<Vec<String>> = vec![];
    let mut whole = f64::NAN;
    for (what, scene) in cases {
        let fmu = bench.pack(&scene)?;
        let drive = Drive { inputs: sea, at: &*waves, ..Drive::still(0.01, 10.0) };
        let mut work = [0.0; 2];
        let seconds = least(|| {
            let run = record(&fmu, &drive, ["winch.tension"])?;
            work = [run.sub_steps, run.iterations];
            Ok(run.seconds)
        })?;
        let per = 1e6 * seconds / work[1];
        if whole.is_nan() {
            whole = per;
        }
        println!("cost   flume {what}: {per:.1} us per linear solve, {} sub-steps in 10 s", work[0]);
        rows.push(vec![what.into(), format!("{}", work[0]), format!("{}", work[1]), format!("{per:.1}"), format!("{:.2}", per / whole)]);
    }
    Ok(Section::new("What parts of a scene cost")
        .text(
            "The flume in the demo's seaway, the winch held, 10 s; parts that a scene leaves out are not computed. The elements are \
             three-dimensional in every scene: one that stays in a plane costs what it would cost out of it.",
        )
        .table(&["Flume", "Sub-steps", "Linear solves", "µs per solve", "Of the whole"], rows))
}

/// The FMI layer, the start, memory, many instances.
fn border(bench: &Bench) -> Result<Section> {
    let mut rows: Vec<Vec<String>> = vec![];
    let mut row = |what: &str, figure: String| {
        println!("cost   {what}: {figure}");
        rows.push(vec![what.to_owned(), figure]);
    };
    let built_in = |name: &str| -> Result<Fmu> {
        bench.pack(&Scene::built_in(name)?.ok_or_else(|| Failure(format!("there is no built-in scene {name}")))?)
    };
    let (flume, overboard) = (built_in("flume")?, built_in("overboard")?);

    // A hundred outputs, and the inputs.
    let instance = start(&overboard, &[], &[])?;
    let outputs: Vec<_> =
        overboard.description.with_causality("output").filter(|v| v.kind == Kind::Real).map(|v| v.reference).take(100).collect();
    let inputs: Vec<_> = overboard.description.with_causality("input").filter(|v| v.kind == Kind::Real).map(|v| v.reference).collect();
    let (mut values, given) = (vec![0.0; outputs.len()], vec![0.0; inputs.len()]);
    let seconds = least(|| {
        let clock = Instant::now();
        for _ in 0..CALLS {
            instance.set_reals(&inputs, &given)?;
            instance.get_reals(&outputs, &mut values)?;
        }
        Ok(clock.elapsed().as_secs_f64())
    })?;
    row(
        &format!("fmi2SetReal of {} inputs and fmi2GetReal of {} outputs", inputs.len(), outputs.len()),
        format!("{:.2} us", 1e6 * seconds / CALLS as f64),
    );

    for (name, fmu) in [("flume", &flume), ("overboard", &overboard)] {
        let seconds = least(|| {
            let clock = Instant::now();
            let _instance = start(fmu, &[], &[])?;
            Ok(clock.elapsed().as_secs_f64())
        })?;
        row(&format!("instantiate and initialize {name}"), format!("{:.1} ms", 1e3 * seconds));
    }

    for count in INSTANCES {
        let before = resident();
        let instances = (0..count).map(|_| start(&flume, &[], &[])).collect::<Result<Vec<_>>>()?;
        let memory = before.zip(resident()).map(|(a, b)| b.saturating_sub(a) as f64 / count as f64);
        let (steps, step) = (if count > 10 { 20 } else { 200 }, 0.01);
        let clock = Instant::now();
        for k in 0..steps {
            for instance in &instances {
                instance.do_step(f64::from(k) * step, step)?;
            }
        }
        let cost = 1e6 * clock.elapsed().as_secs_f64() / f64::from(steps) / count as f64;
        let memory = memory.filter(|_| count > 10).map_or(String::new(), |bytes| format!(", {:.0} kB of memory each", bytes / 1024.0));
        row(&format!("a step of 10 ms of the flume at rest, {count} instances in turn"), format!("{cost:.1} us each{memory}"));
    }
    Ok(Section::new("FMI layer, start, memory, instances").table(&["What", "Cost"], rows))
}

/// Resident memory of this process, bytes, where the system tells it.
fn resident() -> Option<usize> {
    let pages: usize = fs::read_to_string("/proc/self/statm").ok()?.split_whitespace().nth(1)?.parse().ok()?;
    Some(4096 * pages)
}
