//! `cargo xtask bench`: what a run costs against how wrong it is, by time integrator and tolerance.
//!
//! One thread, nothing beside it; the wall-clock time of the communication loop (set inputs, step, get outputs), the least of a few runs.
//! Times belong to the machine that the page names: compare them with each other, not with another page's.

use super::bench::{Bench, Drive, record};
use super::cost;
use super::numerics::{pairs, relative_rms, table};
use super::row::share;
use super::scene::{G, HEAVED, HEAVY_WIRE, NYLON, Scene, Wire, heave};
use super::section::{Section, csv, dotted};
use crate::demo;
use crate::error::{Failure, Result};
use crate::package::root;
use crate::plots::{Chart, PALETTE, Panel, Series};

/// Work-precision diagrams of every time integrator, as fmu-tests/bench
#[derive(clap::Args)]
pub struct Args {
    /// Only the scenes whose name contains this, or what things cost (`cost`); prints the tables and writes nothing
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
    /// Instead: how long each communication step of `overboard` takes over so many seconds in a seaway, with and without solver.tries_max;
    /// prints a table and writes nothing
    #[arg(long, value_name = "SECONDS", conflicts_with = "only")]
    pace: Option<f64>,
}

const METHODS: [&str; 4] = ["rodas4", "tr_bdf2", "esdirk3", "esdirk4"];
const TOLERANCES: [f64; 4] = [1e-2, 1e-3, 1e-4, 1e-5];
/// Runs longer than this are not repeated, s.
const LONG: f64 = 0.5;
const REPEATS: usize = 3;

/// Where a scene's truth comes from.
enum Truth {
    /// Tension over the time of every so many samples, of a converged run of another program.
    Reference { text: &'static str, column: usize, every: usize },
    /// Ours on the same mesh, with Rodas4 at this tolerance: what is left is the error in time.
    Ourselves(f64),
}

/// A scene and how it is driven.
struct Case {
    name: &'static str,
    what: &'static str,
    scene: Scene,
    tension: &'static str,
    step: f64,
    end: f64,
    inputs: &'static [&'static str],
    at: Box<dyn Fn(f64) -> Vec<f64> + Sync>,
    truth: Truth,
}

/// What a run came to.
struct Point {
    method: usize,
    tolerance: f64,
    /// Tension rms over the truth's.
    error: f64,
    /// s.
    cost: f64,
    sub_steps: f64,
}

fn cases() -> Result<Vec<Case>> {
    let string = Wire { laws: "compression = \"linear\"\ndamping.axial = 0.02", ..NYLON };
    let dropped = "[anchor]\nposition = [0, 0, 0]\n[body]\nmass = 1.33e-3\n[initial]\nstate = \"straight\"\ndirection = [1, 0, 0]\n";
    let still = || Box::new(|_| Vec::new());
    let ship: &[&str] = &["ship.z", "ship.vz", "ship.az"];
    let built_in = |name: &str| Scene::built_in(name)?.ok_or_else(|| Failure(format!("there is no built-in scene {name}")));
    let (sea, waves) = demo::sea_inputs()?;
    let mut cases = vec![
        Case {
            name: "p3",
            what: "P3, a string let go level, 40 elements",
            scene: string.scene(G, 40, 0, dropped)?,
            tension: "anchor.tension",
            step: 0.002,
            end: 1.15,
            inputs: &[],
            at: still(),
            truth: Truth::Reference { text: include_str!("../../../fmu-tests/references/p3.csv"), column: 3, every: 1 },
        },
        Case {
            name: "p4a",
            what: "P4a, 200 m of wire heaved without slack, 5 elements",
            scene: HEAVY_WIRE.scene(G, 5, 0, HEAVED)?,
            tension: "anchor.tension",
            step: 0.01,
            end: 60.0,
            inputs: ship,
            at: Box::new(|t| heave(t, 2.5, 6.0)),
            truth: Truth::Ourselves(1e-7),
        },
        Case {
            name: "p4b",
            what: "P4b, the same with slack and snaps, 20 elements",
            scene: HEAVY_WIRE.scene(G, 20, 0, HEAVED)?,
            tension: "anchor.tension",
            step: 0.01,
            end: 24.0,
            inputs: ship,
            at: Box::new(|t| heave(t, 5.0, 4.0)),
            truth: Truth::Ourselves(1e-6),
        },
        Case {
            name: "flume",
            what: "flume in the demo's seaway, the winch held, 24 elements",
            scene: built_in("flume")?,
            tension: "winch.tension",
            step: 0.01,
            end: 20.0,
            inputs: sea,
            at: waves,
            truth: Truth::Ourselves(1e-5),
        },
    ];
    // The pulley's pendulum needs its contact followed: its tolerance comes with it.
    let (rope, rest, rows) = super::wire::pulley_pendulum();
    cases.push(Case {
        name: "p1",
        what: "P1, a pendulum over a pulley, 40 elements",
        scene: rope.scene(G, 40, 0, &rest)?.start_shape(&rows),
        tension: "load.tension",
        step: 0.002,
        end: 1.0,
        inputs: &[],
        at: still(),
        truth: Truth::Reference { text: include_str!("../../../fmu-tests/references/p1.csv"), column: 2, every: 1 },
    });
    Ok(cases)
}

/// Tensions at the communication points after the start, the seconds that the loop took, and the sub-steps.
fn run(bench: &Bench, case: &Case, method: &str, tolerance: f64) -> Result<(Vec<f64>, f64, f64)> {
    let fmu = bench.pack(&case.scene.clone().with("solver.method", method).with("solver.tolerance", tolerance))?;
    let drive = Drive { inputs: case.inputs, at: &*case.at, ..Drive::still(case.step, case.end) };
    let mut best: Option<(Vec<f64>, f64, f64)> = None;
    for _ in 0..REPEATS {
        let run = record(&fmu, &drive, [case.tension])?;
        if best.as_ref().is_none_or(|b| run.seconds < b.1) {
            best = Some((run.columns[0][1..].to_vec(), run.seconds, run.sub_steps));
        }
        if run.seconds > LONG {
            break;
        }
    }
    best.ok_or_else(|| Failure("no run".into()))
}

fn measure(bench: &Bench, case: &Case) -> Result<Vec<Point>> {
    let (truth, every) = match case.truth {
        Truth::Reference { text, column, every } => (table(text).iter().skip(1).map(|row| row[column]).collect(), every),
        Truth::Ourselves(tolerance) => (run(bench, case, METHODS[0], tolerance)?.0, 1),
    };
    let mut points = Vec::new();
    for (method, name) in METHODS.iter().enumerate() {
        for tolerance in TOLERANCES {
            let (tension, cost, sub_steps) = run(bench, case, name, tolerance)?;
            let tension: Vec<f64> = tension.into_iter().skip(every - 1).step_by(every).collect();
            let error = relative_rms(&pairs(&tension, &truth));
            println!(
                "{:6} {name:8} {tolerance:7.0e}  error {error:.1e}  {:8.1} ms  {:6.1} x real time  {sub_steps:6} sub-steps",
                case.name,
                1e3 * cost,
                case.end / cost
            );
            points.push(Point { method, tolerance, error, cost, sub_steps });
        }
    }
    Ok(points)
}

/// The case's part of the page.
fn section(case: &Case, points: &[Point]) -> Section {
    let lines = METHODS.iter().enumerate().map(|(m, name)| {
        let of = points.iter().filter(|p| p.method == m && p.error > 0.0);
        Series { points: of.map(|p| (p.error.log10(), (case.end / p.cost).log10())).collect(), ..Series::new(name, &[], &[], PALETTE[m]) }
    });
    let chart = Chart::new(
        case.what,
        "log10 of the tension's rms error over its rms",
        vec![dotted(Panel::new("log10 of simulated time over run time", lines.collect()).height(300.0))],
    );
    let rows = points.iter().map(|p| {
        vec![
            METHODS[p.method].to_owned(),
            format!("{:.0e}", p.tolerance),
            share(p.error),
            format!("{:.1}", 1e3 * p.cost),
            format!("{:.1}", case.end / p.cost),
            p.sub_steps.to_string(),
        ]
    });
    let truth = match case.truth {
        Truth::Reference { .. } => {
            "Truth: a converged run of another program (fmu-tests/references), so the mesh's error is in the figure.".to_owned()
        }
        Truth::Ourselves(tolerance) => format!("Truth: rodas4 on the same mesh at {tolerance:.0e}, so the figure is the error in time."),
    };
    Section::new(case.what)
        .text(format!("{truth} Communication steps of {} ms, {} s.", 1e3 * case.step, case.end))
        .chart(case.name, chart, "Right is worse, up is faster; each line from tolerance 1e-2 to 1e-5.")
        .table(&["Method", "Tolerance", "Tension error", "Run, ms", "Times real time", "Sub-steps"], rows.collect())
}

/// Runs the command.
///
/// # Errors
/// A build that fails, a scene that does not run, a folder that cannot be written.
pub fn bench(args: Args) -> Result<()> {
    if let Some(seconds) = args.pace {
        return super::pace::pace(seconds);
    }
    let all = cases()?;
    let costs = args.only.as_deref().is_none_or(|only| only == "cost");
    let chosen: Vec<&Case> = all.iter().filter(|c| args.only.as_ref().is_none_or(|only| c.name.contains(only.as_str()))).collect();
    if chosen.is_empty() && !costs {
        let names: Vec<_> = all.iter().map(|c| c.name).chain(["cost"]).collect();
        return Err(Failure(format!("--only {}: no such scene; there are {}", args.only.unwrap_or_default(), names.join(", "))));
    }
    println!("building the library (the first build takes a while)");
    let bench = Bench::new()?;
    let machine = demo::machine();
    println!("{machine}; one thread");
    let mut sections = Vec::new();
    let mut numbers: [Vec<f64>; 6] = Default::default();
    for (k, case) in chosen.iter().enumerate() {
        let points = measure(&bench, case)?;
        for p in &points {
            let row = [k as f64, p.method as f64, p.tolerance, p.error, p.cost, p.sub_steps];
            numbers.iter_mut().zip(row).for_each(|(column, x)| column.push(x));
        }
        sections.push(section(case, &points));
    }
    if costs {
        sections.extend(cost::sections(&bench)?);
    }
    if args.only.is_some() {
        return Ok(());
    }
    let folder = root().join("fmu-tests").join("bench");
    let columns: Vec<&[f64]> = numbers.iter().map(Vec::as_slice).collect();
    let names: Vec<_> = chosen.iter().map(|c| c.name).collect();
    let header = format!("scene ({}),method ({}),tolerance,error,seconds,sub_steps", names.join(" "), METHODS.join(" "));
    super::page::write_speed(&sections, &machine, &csv(&header, &columns), &folder)?;
    println!("{}", crate::results::shown(&folder.join("index.html")));
    Ok(())
}
