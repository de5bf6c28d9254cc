//! `cargo xtask bench --pace SECONDS`: how long each communication step takes by the clock, for controllers in the loop.

use super::bench::{Bench, start};
use super::scene::Scene;
use super::section::Section;
use crate::demo;
use crate::error::{Failure, Result};
use crate::package::root;
use crate::plots::{Chart, PALETTE, Panel, Series};
use crate::ship_motion::{HEADER, Options, generate};
use std::time::Instant;

/// Communication step, s.
const STEP: f64 = 0.02;
/// Methods, and bounds on the sub-steps tried in one communication step; 0 is none. The first is what the others are compared with; the second
/// is the scene's own.
const RIDES: [(&str, u32); 5] = [("rodas4", 0), ("tr_bdf2", 0), ("rodas4", 8), ("rodas4", 4), ("rodas4", 2)];

/// The sea of the scene's own page, for so many seconds.
pub(super) fn sea(duration: f64) -> Options {
    Options { heading: 150.0, duration, step: STEP, ..Options::default() }
}

/// What the steps of a run took.
struct Pace {
    /// Ascending, ms.
    times: Vec<f64>,
    /// The greatest number of sub-steps tried in one, how many steps tried as many as they might, and how many were told as degraded.
    most: f64,
    bounded: usize,
    degraded: usize,
    /// Tension, N.
    tension: Vec<f64>,
}

fn ride(bench: &Bench, method: &str, tries: u32, seconds: f64) -> Result<Pace> {
    let scene = Scene::built_in("overboard")?.ok_or_else(|| Failure("there is no built-in scene overboard".into()))?;
    let fmu = bench.pack(&scene.with("solver.method", method).with("solver.tries_max", tries))?;
    let motion = generate(&sea(seconds))?;
    let first: Vec<(&str, f64)> = HEADER[1..].iter().copied().zip(motion.row(0)).collect();
    let instance = start(&fmu, &[], &first)?;
    let inputs = HEADER[1..].iter().map(|name| Ok(fmu.description.variable(name)?.reference)).collect::<Result<Vec<_>>>()?;
    let outputs = ["winch.tension", "solver.steps", "solver.rejected"]
        .iter()
        .map(|name| Ok(fmu.description.variable(name)?.reference))
        .collect::<Result<Vec<_>>>()?;
    let mut pace = Pace { times: vec![], most: 0.0, bounded: 0, degraded: 0, tension: vec![] };
    let mut before = 0.0;
    for k in 0..(seconds / STEP).round() as usize {
        let row = motion.row(k);
        let clock = Instant::now();
        instance.set_reals(&inputs, &row)?;
        instance.do_step(k as f64 * STEP, STEP)?;
        let mut tension = [0.0];
        instance.get_reals(&outputs[..1], &mut tension)?;
        pace.times.push(1e3 * clock.elapsed().as_secs_f64());
        pace.tension.push(tension[0]);
        let tried = instance.get("solver.steps")? + instance.get("solver.rejected")?;
        pace.most = pace.most.max(tried - before);
        pace.bounded += usize::from(tries > 0 && tried - before >= f64::from(tries));
        before = tried;
        pace.degraded += usize::from(instance.get("status.code")? == 1.0);
    }
    pace.times.sort_unstable_by(f64::total_cmp);
    Ok(pace)
}

/// How many steps took longer than so many ms, as a share: log10 against log10, over a run's ascending times.
fn tail(times: &[f64]) -> Vec<(f64, f64)> {
    let n = times.len();
    let mut points: Vec<(f64, f64)> = vec![];
    // Shares evenly spaced in their logarithm, so that a million steps make no more of a line than a hundred.
    for k in 0..=200 {
        let longer = ((n as f64).powf(1.0 - f64::from(k) / 200.0)).round().max(1.0) as usize;
        points.push((times[n - longer].log10(), (longer as f64 / n as f64).log10()));
    }
    points.dedup();
    points
}

/// Runs `overboard` in its sea, winch held, prints the distribution of the steps' times with and without bounds on the sub-steps, and writes a
/// page of it.
///
/// # Errors
/// A build that fails, an FMU that refuses, a folder that cannot be written.
pub fn pace(seconds: f64) -> Result<()> {
    if !(1.0..=1e5).contains(&seconds) {
        return Err(Failure(format!("--pace {seconds}: expected 1 to 100000 s")));
    }
    println!("building the library (the first build takes a while)");
    let bench = Bench::new()?;
    let machine = demo::machine();
    println!("{machine}; one thread; overboard, {seconds} s in communication steps of {} ms", 1e3 * STEP);
    let mut truth: Vec<f64> = vec![];
    let (mut rows, mut lines) = (vec![], vec![]);
    for (k, (method, tries)) in RIDES.into_iter().enumerate() {
        let run = ride(&bench, method, tries, seconds)?;
        let at = |share: f64| run.times[((run.times.len() - 1) as f64 * share) as usize];
        if k == 0 {
            truth.clone_from(&run.tension);
        }
        let percent = |count: usize| format!("{:.2} %", 100.0 * count as f64 / run.times.len() as f64);
        let (bounded, degraded) = (percent(run.bounded), percent(run.degraded));
        let off = super::numerics::relative_rms(&super::numerics::pairs(&run.tension, &truth));
        let speed = 1e3 * seconds / run.times.iter().sum::<f64>();
        println!(
            "{method}, solver.tries_max {tries}: median {:.2} ms, 99.9 % {:.2} ms, max {:.2} ms; at most {} sub-steps tried in a step; {bounded} \
             of the steps at the bound, {degraded} told as degraded; tension {off:.1e} from the first; {speed:.1} x real time",
            at(0.5),
            at(0.999),
            at(1.0),
            run.most,
        );
        let name = if tries == 0 { "none".to_owned() } else { tries.to_string() };
        rows.push(vec![
            method.into(),
            name.clone(),
            format!("{:.3}", at(0.5)),
            format!("{:.3}", at(0.999)),
            format!("{:.3}", at(1.0)),
            run.most.to_string(),
            bounded,
            degraded,
            if k == 0 { "0".into() } else { format!("{off:.1e}") },
            format!("{speed:.0}"),
        ]);
        lines.push(Series { points: tail(&run.times), ..Series::new(&format!("{method}, bound: {name}"), &[], &[], PALETTE[k]) });
    }
    let chart =
        Chart::new("Steps that take longer", "log10 of a step's time, ms", vec![Panel::new("log10 of their share", lines).height(320.0)]);
    let section = Section::new(&format!("overboard, {seconds} s in a seaway"))
        .text(format!(
            "Communication steps of {} ms, the winch held, inputs and one output included; times by the clock, so with whatever the \
             operating system does in between. With solver.tries_max (rodas4 only) a step tries no more sub-steps than that; where they do not \
             suffice the last is accepted with the error that it has, and status.code is 1. So it is where energy and work disagree by more than \
             1 %, as they do here with rodas4 in sub-steps of 20 ms; the scene's own method is in the second line. The error is the \
             tension's rms distance from the first line's run.",
            1e3 * STEP
        ))
        .table(
            &[
                "Method",
                "Bound",
                "Median, ms",
                "99.9 %, ms",
                "Greatest, ms",
                "Sub-steps tried, at most",
                "At the bound",
                "Degraded",
                "Tension error",
                "Times real time",
            ],
            rows,
        )
        .chart("pace", chart, "Left is better: the share of the steps that take longer than the time below.");
    let folder = root().join("fmu-tests").join("pace");
    super::page::write_pace(&[section], &machine, &folder)?;
    println!("{}", crate::results::shown(&folder.join("index.html")));
    Ok(())
}
