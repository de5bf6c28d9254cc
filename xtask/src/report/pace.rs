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
/// Bounds on the sub-steps tried in one; 0 is none.
const TRIES: [u32; 4] = [0, 8, 4, 2];

/// The sea of the scene's own page, for so many seconds.
pub(super) fn sea(duration: f64) -> Options {
    Options { heading: 150.0, duration, step: STEP, ..Options::default() }
}

/// What the steps of a run took.
struct Pace {
    /// Ascending, ms.
    times: Vec<f64>,
    /// The greatest number of sub-steps tried in one, and how many steps were told as degraded.
    most: f64,
    degraded: usize,
    /// Tension, N.
    tension: Vec<f64>,
}

fn ride(bench: &Bench, tries: u32, seconds: f64) -> Result<Pace> {
    let scene = Scene::built_in("overboard")?.ok_or_else(|| Failure("there is no built-in scene overboard".into()))?;
    let fmu = bench.pack(&scene.with("solver.method", "rodas4").with("solver.tries_max", tries))?;
    let motion = generate(&sea(seconds))?;
    let first: Vec<(&str, f64)> = HEADER[1..].iter().copied().zip(motion.row(0)).collect();
    let instance = start(&fmu, &[], &first)?;
    let inputs = HEADER[1..].iter().map(|name| Ok(fmu.description.variable(name)?.reference)).collect::<Result<Vec<_>>>()?;
    let outputs = ["winch.tension", "solver.steps", "solver.rejected"]
        .iter()
        .map(|name| Ok(fmu.description.variable(name)?.reference))
        .collect::<Result<Vec<_>>>()?;
    let mut pace = Pace { times: vec![], most: 0.0, degraded: 0, tension: vec![] };
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
    for (k, tries) in TRIES.into_iter().enumerate() {
        let run = ride(&bench, tries, seconds)?;
        let at = |share: f64| run.times[((run.times.len() - 1) as f64 * share) as usize];
        if tries == 0 {
            truth.clone_from(&run.tension);
        }
        let degraded = 100.0 * run.degraded as f64 / run.times.len() as f64;
        let off = super::numerics::relative_rms(&super::numerics::pairs(&run.tension, &truth));
        let speed = 1e3 * seconds / run.times.iter().sum::<f64>();
        println!(
            "solver.tries_max {tries}: median {:.2} ms, 99.9 % {:.2} ms, max {:.2} ms; at most {} sub-steps tried in a step; {degraded:.2} % of \
             the steps told as degraded; tension {off:.1e} from that without a bound; {speed:.1} x real time",
            at(0.5),
            at(0.999),
            at(1.0),
            run.most,
        );
        let name = if tries == 0 { "none".to_owned() } else { tries.to_string() };
        rows.push(vec![
            name.clone(),
            format!("{:.3}", at(0.5)),
            format!("{:.3}", at(0.999)),
            format!("{:.3}", at(1.0)),
            run.most.to_string(),
            format!("{degraded:.2} %"),
            if tries == 0 { "0".into() } else { format!("{off:.1e}") },
            format!("{speed:.0}"),
        ]);
        lines.push(Series { points: tail(&run.times), ..Series::new(&format!("bound: {name}"), &[], &[], PALETTE[k]) });
    }
    let chart =
        Chart::new("Steps that take longer", "log10 of a step's time, ms", vec![Panel::new("log10 of their share", lines).height(320.0)]);
    let section = Section::new(&format!("overboard, {seconds} s in a seaway"))
        .text(format!(
            "Communication steps of {} ms, rodas4, the winch held, inputs and one output included; times by the clock, so with whatever the \
             operating system does in between. With solver.tries_max a step tries no more sub-steps than that; where they do not suffice the last \
             is accepted with the error that it has, and status.code is 1. The error is the tension's rms distance from the run without a bound.",
            1e3 * STEP
        ))
        .table(
            &["Bound", "Median, ms", "99.9 %, ms", "Greatest, ms", "Sub-steps tried, at most", "Degraded", "Tension error", "Times real time"],
            rows,
        )
        .chart("pace", chart, "Left is better: the share of the steps that take longer than the time below.");
    let folder = root().join("fmu-tests").join("pace");
    super::page::write_pace(&[section], &machine, &folder)?;
    println!("{}", crate::results::shown(&folder.join("index.html")));
    Ok(())
}
