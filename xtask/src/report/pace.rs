//! `cargo xtask bench --pace SECONDS`: how long each communication step takes by the clock, for controllers in the loop.

use super::bench::{Bench, start};
use super::scene::Scene;
use crate::demo;
use crate::error::{Failure, Result};
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

/// Runs `overboard` in its sea, winch held, and prints the distribution of the steps' times with and without bounds on the sub-steps.
///
/// # Errors
/// A build that fails, an FMU that refuses.
pub fn pace(seconds: f64) -> Result<()> {
    if !(1.0..=1e5).contains(&seconds) {
        return Err(Failure(format!("--pace {seconds}: expected 1 to 100000 s")));
    }
    println!("building the library (the first build takes a while)");
    let bench = Bench::new()?;
    println!("{}; one thread; overboard, {seconds} s in communication steps of {} ms", demo::machine(), 1e3 * STEP);
    let mut truth: Vec<f64> = vec![];
    for tries in TRIES {
        let run = ride(&bench, tries, seconds)?;
        let at = |share: f64| run.times[((run.times.len() - 1) as f64 * share) as usize];
        if tries == 0 {
            truth.clone_from(&run.tension);
        }
        println!(
            "solver.tries_max {tries}: median {:.2} ms, 99.9 % {:.2} ms, max {:.2} ms; at most {} sub-steps tried in a step; {:.2} % of the \
             steps told as degraded; tension {:.1e} from that without a bound; {:.1} x real time",
            at(0.5),
            at(0.999),
            at(1.0),
            run.most,
            100.0 * run.degraded as f64 / run.times.len() as f64,
            super::numerics::relative_rms(&super::numerics::pairs(&run.tension, &truth)),
            1e3 * seconds / run.times.iter().sum::<f64>(),
        );
    }
    Ok(())
}
