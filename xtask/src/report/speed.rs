//! `cargo xtask bench`: what a run costs against how wrong it is, by time integrator and tolerance.
//!
//! One thread; its processor time in the communication loop (set inputs, step, get outputs), the least of a few runs.
//! Times belong to the machine that the page names: compare them with each other, not with another page's.

use super::bench::Bench;
use super::cases::{Case, Place, cases};
use super::cost;
use super::rival_runs::{Program, Rivals};
use super::rivals::{self, RivalPoint, Work};
use super::row::share;
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
    /// Also run other programs on the scenes that they can compute: Exudyn and MoorDyn from PyPI, in an environment of their own in the target
    /// folder
    #[arg(long)]
    peers: bool,
    /// Instead: how long each communication step of `overboard` takes over so many seconds in a seaway, with and without solver.tries_max;
    /// prints a table and writes nothing
    #[arg(long, value_name = "SECONDS", conflicts_with_all = ["only", "peers"])]
    pace: Option<f64>,
}

const METHODS: [&str; 4] = ["rodas4", "tr_bdf2", "esdirk3", "esdirk4"];
const TOLERANCES: [f64; 4] = [1e-2, 1e-3, 1e-4, 1e-5];
/// Runs longer than this are not repeated, s.
const LONG: f64 = 0.5;
const REPEATS: usize = 3;

/// What a run came to.
struct Point {
    method: usize,
    tolerance: f64,
    work: Work,
    sub_steps: f64,
}

/// What a case came to, ours and theirs.
struct Measured {
    points: Vec<Point>,
    theirs: Vec<RivalPoint>,
}

fn measure(bench: &Bench, case: &Case, rivals: Option<&Rivals>) -> Result<Measured> {
    let truth = case.truth(bench)?;
    let mut points = Vec::new();
    for (method, name) in METHODS.iter().enumerate() {
        for tolerance in TOLERANCES {
            let run = case.run(bench, &case.scene, name, tolerance, REPEATS, LONG)?;
            let off = run.track.off(&truth, case.from)?;
            println!(
                "{:6} {name:8} {tolerance:7.0e}  error {:.1e}{}  {:8.1} ms  {:6.1} x real time  {:6} sub-steps",
                case.name,
                off.tension,
                off.place.map_or(String::new(), |p| format!(", place {p:.1e}")),
                1e3 * run.seconds,
                case.end / run.seconds,
                run.sub_steps
            );
            points.push(Point { method, tolerance, work: Work { off, cost: run.seconds }, sub_steps: run.sub_steps });
        }
    }
    let curve = |m: usize| points.iter().filter(|p| p.method == m).map(|p| p.work).collect();
    let curves: Vec<_> = METHODS.iter().enumerate().map(|(m, name)| (*name, curve(m))).collect();
    let theirs = rivals.map_or(Vec::new(), |rivals| rivals::measure(rivals, case, &truth, &curves, REPEATS, LONG));
    Ok(Measured { points, theirs })
}

/// The case's part of the page.
fn section(case: &Case, measured: &Measured) -> Section {
    let Measured { points, theirs } = measured;
    let lines = METHODS.iter().enumerate().map(|(m, name)| {
        let of = points.iter().filter(|p| p.method == m && p.work.off.tension > 0.0);
        let points = of.map(|p| (p.work.off.tension.log10(), (case.end / p.work.cost).log10())).collect();
        Series { points, ..Series::new(name, &[], &[], PALETTE[m]) }
    });
    let lines = lines.chain(rivals::series(case, theirs)).collect();
    let chart = Chart::new(
        case.what,
        "log10 of the tension's rms error over its rms",
        vec![dotted(Panel::new("log10 of simulated time over run time", lines).height(300.0))],
    );
    let rows = points.iter().map(|p| {
        vec![
            METHODS[p.method].to_owned(),
            format!("{:.0e}", p.tolerance),
            share(p.work.off.tension),
            rivals::place(p.work.off.place),
            format!("{:.1}", 1e3 * p.work.cost),
            format!("{:.1}", case.end / p.work.cost),
            p.sub_steps.to_string(),
        ]
    });
    let rows = rows.chain(rivals::rows(case, theirs)).collect();
    let place = match case.place {
        Place::Nothing => "Place error",
        Place::Point(_) => "Place error, m",
        Place::Chord(_) => "Wrap error, rad",
    };
    Section::new(case.what)
        .text(format!("{} Communication steps of {} ms, {} s.", case.truth_in_words(), 1e3 * case.step, case.end))
        .chart(case.name, chart, "Right is worse, up is faster; each line from tolerance 1e-2 to 1e-5, other programs' from coarse to fine.")
        .table(&["Method", "Tolerance", "Tension error", place, "Run, ms", "Times real time", "Sub-steps"], rows)
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
    let mut theirs = Vec::new();
    let mut numbers: [Vec<f64>; 7] = Default::default();
    for (k, case) in chosen.iter().enumerate() {
        let measured = measure(&bench, case, rivals.as_ref())?;
        for p in &measured.points {
            let place = p.work.off.place.unwrap_or(f64::NAN);
            let row = [k as f64, p.method as f64, p.tolerance, p.work.off.tension, place, p.work.cost, p.sub_steps];
            numbers.iter_mut().zip(row).for_each(|(column, x)| column.push(x));
        }
        sections.push(section(case, &measured));
        theirs.extend(measured.theirs);
    }
    let names: Vec<_> = chosen.iter().map(|c| c.name).collect();
    if rivals.is_some() {
        let (section, [held, of]) = rivals::section(&theirs);
        println!("{held} of {of} targets against other programs held");
        let header =
            format!("scene ({}),program ({}),elements,step,tension_error,place_error,seconds", names.join(" "), Program::ALL.map(Program::name).join(" "));
        let columns = rivals::numbers(&theirs, &names);
        sections.insert(0, section.csv("peers", &header, &columns.each_ref().map(Vec::as_slice), "every run of theirs"));
    }
    if costs {
        sections.extend(cost::sections(&bench)?);
    }
    if args.only.is_some() {
        return Ok(());
    }
    let folder = root().join("fmu-tests").join("bench");
    let columns: Vec<&[f64]> = numbers.iter().map(Vec::as_slice).collect();
    let header = format!("scene ({}),method ({}),tolerance,tension_error,place_error,seconds,sub_steps", names.join(" "), METHODS.join(" "));
    super::page::write_speed(&sections, &machine, rivals.is_some(), &csv(&header, &columns), &folder)?;
    println!("{}", crate::results::shown(&folder.join("index.html")));
    Ok(())
}
