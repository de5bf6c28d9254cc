//! `cargo xtask bench`: what a run costs against how wrong it is, by time integrator and tolerance.
//!
//! One thread; its processor time in the communication loop (set inputs, step, get outputs), the least of a few runs.
//! Times belong to the machine that the page names: compare them with each other, not with another page's.

use super::bench::Bench;
use super::cases::{Case, Place, cases};
use super::cost;
use super::rival_runs::{Program, Rivals};
use super::rivals::{self, OwnRun, RivalPoint, Work};
use super::row::share;
use super::section::{Section, csv, dotted};
use super::targets::{self, Runs};
use super::track::Off;
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
    /// Also run other programs on the scenes that they can compute: Exudyn and MoorDyn from PyPI, in an environment of their own in the target
    /// folder
    #[arg(long)]
    peers: bool,
    /// Instead: how long each communication step of `overboard` takes over so many seconds in a seaway, with and without solver.tries_max;
    /// prints a table and writes fmu-tests/pace
    #[arg(long, value_name = "SECONDS", conflicts_with_all = ["only", "peers"])]
    pace: Option<f64>,
}

const METHODS: [&str; 4] = ["rodas4", "tr_bdf2", "esdirk3", "esdirk4"];
const TOLERANCES: [f64; 5] = [3e-2, 1e-2, 3e-3, 1e-3, 1e-4];
/// Runs longer than this are not repeated, s.
const LONG: f64 = 0.5;
const REPEATS: usize = 3;

/// What a case came to, ours and theirs.
struct Measured {
    own: Vec<OwnRun>,
    theirs: Vec<RivalPoint>,
}

fn measure(bench: &Bench, case: &Case, rivals: Option<&Rivals>) -> Result<Measured> {
    let truth = case.truth(bench)?;
    let mut own = Vec::new();
    for scene in case.scenes() {
        for method in METHODS {
            for tolerance in TOLERANCES {
                let run = case.run(bench, &scene, method, tolerance, REPEATS, LONG)?;
                let off = run.track.off(&truth, case.from)?;
                let work = Work { off, cost: run.seconds };
                let point = OwnRun { method, elements: scene.element_count(), tolerance, work, sub_steps: run.sub_steps };
                println!(
                    "{:6} {}  error {:.1e}{}  {:8.1} ms  {:6.1} x real time  {:6} sub-steps",
                    case.name,
                    point.name(),
                    off.tension,
                    off.place.map_or(String::new(), |p| format!(", place {p:.1e}")),
                    1e3 * run.seconds,
                    case.end / run.seconds,
                    run.sub_steps
                );
                own.push(point);
            }
        }
    }
    let theirs = rivals.map_or(Vec::new(), |rivals| rivals::measure(rivals, case, &truth, &own, REPEATS, LONG));
    Ok(Measured { own, theirs })
}

/// Work over an error: a line a method and mesh, the finest mesh's drawn through, and one a program.
fn chart(case: &Case, measured: &Measured, label: &str, error: fn(&Off) -> Option<f64>) -> Chart {
    let mut meshes: Vec<usize> = measured.own.iter().map(|run| run.elements).collect();
    meshes.sort_unstable();
    meshes.dedup();
    let mut lines = Vec::new();
    for n in &meshes {
        for (m, method) in METHODS.iter().enumerate() {
            let of = measured.own.iter().filter(|run| run.method == *method && run.elements == *n);
            let errors = of.filter_map(|run| Some((error(&run.work.off).filter(|e| *e > 0.0)?, run.work.cost)));
            let points = errors.map(|(e, cost)| (e.log10(), (case.end / cost).log10())).collect();
            let line = Series { points, ..Series::new(&format!("{method}, {n}"), &[], &[], PALETTE[m]) };
            lines.push(if meshes.last() == Some(n) { line } else { line.dashed().width(1.0) });
        }
    }
    lines.extend(rivals::series(case, &measured.theirs, error));
    Chart::new(case.what, label, vec![dotted(Panel::new("log10 of simulated time over run time", lines).height(300.0))])
}

/// The case's part of the page.
fn section(case: &Case, measured: &Measured) -> Section {
    let rows = measured.own.iter().map(|p| {
        vec![
            p.method.to_owned(),
            p.mesh_and_tolerance(),
            share(p.work.off.tension),
            rivals::place(p.work.off.place),
            format!("{:.1}", 1e3 * p.work.cost),
            format!("{:.1}", case.end / p.work.cost),
            p.sub_steps.to_string(),
        ]
    });
    let rows = rows.chain(rivals::rows(case, &measured.theirs)).collect();
    let (place, axis) = match case.place {
        Place::Point(_) => ("Place error, m", "log10 of the body's rms distance from its true place, m"),
        Place::Chord(_) => ("Wrap error, rad", "log10 of the wrap angle's rms error, rad"),
    };
    let tension = chart(case, measured, "log10 of the tension's rms error over its rms", |off| Some(off.tension));
    Section::new(case.what)
        .text(format!("{} Communication steps of {} ms, {} s.", case.truth_in_words(), 1e3 * case.step, case.end))
        .chart(
            case.name,
            tension,
            "Right is worse, up is faster; each line from tolerance 3e-2 to 1e-4 (dashed on the coarser meshes), other programs' from coarse to \
             fine.",
        )
        .chart(&format!("{}-place", case.name), chart(case, measured, axis, |off| off.place), "The same over the error of place.")
        .table(&["Method", "Mesh, tolerance or step", "Tension error", place, "Run, ms", "Times real time", "Sub-steps"], rows)
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
    let rivals = args.peers.then(Rivals::new).transpose()?;
    println!("building the library (the first build takes a while)");
    let bench = Bench::new()?;
    let machine = demo::machine();
    println!("{machine}; one thread");
    let mut sections = Vec::new();
    let mut all_measured = Vec::new();
    for case in &chosen {
        let measured = measure(&bench, case, rivals.as_ref())?;
        sections.push(section(case, &measured));
        all_measured.push(measured);
    }
    let names: Vec<_> = chosen.iter().map(|c| c.name).collect();
    let work = work(&all_measured);
    let runs: Vec<Runs> =
        chosen.iter().zip(&all_measured).map(|(c, m)| Runs { case: c.name, end: c.end, own: &m.own, theirs: &m.theirs }).collect();
    let mut first = vec![targets::section(&runs)];
    drop(runs);
    if rivals.is_some() {
        let theirs: Vec<RivalPoint> = all_measured.into_iter().flat_map(|m| m.theirs).collect();
        let programs = Program::ALL.map(Program::name).join(" ");
        let header = format!("scene ({}),program ({programs}),elements,step,tension_error,place_error,seconds", names.join(" "));
        let columns = rivals::numbers(&theirs, &names);
        first.push(rivals::section(&theirs).csv("peers", &header, &columns.each_ref().map(Vec::as_slice), "every run of theirs"));
    }
    sections.splice(0..0, first);
    if costs {
        sections.extend(cost::sections(&bench)?);
    }
    if args.only.is_some() {
        return Ok(());
    }
    let folder = root().join("fmu-tests").join("bench");
    let columns: Vec<&[f64]> = work.iter().map(Vec::as_slice).collect();
    let header = format!(
        "scene ({}),method ({}),elements,tolerance,tension_error,place_error,seconds,sub_steps",
        names.join(" "),
        METHODS.join(" ")
    );
    super::page::write_speed(&sections, &machine, rivals.is_some(), &csv(&header, &columns), &folder)?;
    println!("{}", crate::results::shown(&folder.join("index.html")));
    Ok(())
}

/// Numbers for work.csv: every run of ours, scene and method by their places in the header.
fn work(all: &[Measured]) -> [Vec<f64>; 8] {
    let mut columns: [Vec<f64>; 8] = Default::default();
    for (k, run) in all.iter().enumerate().flat_map(|(k, m)| m.own.iter().map(move |run| (k, run))) {
        let method = METHODS.iter().position(|m| *m == run.method).unwrap_or_default();
        let Off { tension, place } = run.work.off;
        let place = place.unwrap_or(f64::NAN);
        let row = [k as f64, method as f64, run.elements as f64, run.tolerance, tension, place, run.work.cost, run.sub_steps];
        columns.iter_mut().zip(row).for_each(|(column, x)| column.push(x));
    }
    columns
}
