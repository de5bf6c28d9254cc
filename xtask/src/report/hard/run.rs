//! One run of a case through the FMU's C interface.

use super::case::{Case, Ends};
use super::momentum::Momentum;
use crate::error::{Failure, Result};
use crate::host::{Fmu, Instance};
use crate::report::bench::start;
use model_description::Kind;
use std::time::{Duration, Instant};

/// A run that takes longer counts as hung.
const PATIENCE: Duration = Duration::from_secs(600);

/// What a run gave.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// Communication points, s.
    pub times: Vec<f64>,
    names: Vec<&'static str>,
    columns: Vec<Vec<f64>>,
    /// `solver.steps`, `.rejected`, `.iterations` at the end.
    pub counts: [f64; 3],
    /// `solver.energy_error` at the end.
    pub energy_error: f64,
    /// The greatest `status.code` on the way.
    pub status: f64,
    /// The message of the step that was refused, with its begin, s.
    pub stopped: Option<(f64, String)>,
    /// Momentum defect, where it was asked for.
    pub momentum: Option<f64>,
    /// By the clock, s.
    pub seconds: f64,
}

impl Run {
    /// A recorded output; empty if it was not recorded.
    pub fn of(&self, name: &str) -> &[f64] {
        self.names.iter().position(|n| *n == name).map_or(&[], |i| &self.columns[i])
    }

    /// Greatest value, NaN without any.
    pub fn peak(&self, name: &str) -> f64 {
        self.of(name).iter().copied().fold(f64::NAN, f64::max)
    }

    /// Least value.
    pub fn least(&self, name: &str) -> f64 {
        self.of(name).iter().copied().fold(f64::NAN, f64::min)
    }

    /// Value at a time, linear between communication points.
    pub fn value(&self, name: &str, t: f64) -> f64 {
        let (x, y) = (&self.times, self.of(name));
        let i = x.partition_point(|x| *x < t - 1e-9);
        match (i, x.get(i), y.get(i)) {
            (_, None, _) | (_, _, None) => f64::NAN,
            (0, ..) => y[0],
            (i, Some(b), Some(v)) => y[i - 1] + (v - y[i - 1]) * ((t - x[i - 1]) / (b - x[i - 1])).min(1.0),
        }
    }

    /// Where an output passes a level, upwards or downwards, linear between communication points, s.
    pub fn crossings(&self, name: &str, level: f64, upwards: bool) -> Vec<f64> {
        let (x, y) = (&self.times, self.of(name));
        let sign = if upwards { 1.0 } else { -1.0 };
        (1..y.len())
            .filter(|i| sign * (y[i - 1] - level) < 0.0 && sign * (y[*i] - level) >= 0.0)
            .map(|i| x[i - 1] + (x[i] - x[i - 1]) * (level - y[i - 1]) / (y[i] - y[i - 1]))
            .collect()
    }

    /// The first of them; NaN if there is none.
    pub fn first_crossing(&self, name: &str, level: f64, upwards: bool) -> f64 {
        self.crossings(name, level, upwards).first().copied().unwrap_or(f64::NAN)
    }

    /// How a run ended, in a word or two.
    pub fn end(&self) -> String {
        match &self.stopped {
            None if self.status > 0.0 => "completes, status 1".into(),
            None => "completes".into(),
            Some((t, _)) => format!("stops at {t:.4} s"),
        }
    }
}

/// Runs the case's drive on a packed scene.
///
/// # Errors
/// No start, a value that is not finite, a run that takes forever, a refused step that did not leave the instance as it was.
pub fn run(fmu: &Fmu, case: &Case, parameters: &[(&str, f64)], balance: bool) -> Result<Run> {
    let (inputs, at) = &case.drive;
    let first: Vec<(&str, f64)> = inputs.iter().copied().zip(at(0.0)).collect();
    let instance = start(fmu, parameters, &first)?;
    let find = |name: &&str| fmu.description.variable(name).cloned();
    let references = inputs.iter().map(|n| Ok(find(n)?.reference)).collect::<Result<Vec<_>>>()?;
    let outputs = case.record.iter().map(find).collect::<Result<Vec<_>>>()?;
    let status = find(&"status.code")?;
    let mut momentum = balance.then(|| Momentum::new(&instance, &case.scene, inputs)).transpose()?;
    let mut run = Run { names: case.record.clone(), columns: vec![Vec::new(); outputs.len()], ..Run::default() };
    let clock = Instant::now();
    let points = case.times.points();
    let mut observe = |run: &mut Run, t: f64, given: &[f64]| -> Result<()> {
        run.times.push(t);
        for (column, variable) in run.columns.iter_mut().zip(&outputs) {
            let value = instance.read(variable)?;
            if !value.is_finite() {
                return Err(Failure(format!("{} is {value} at t = {t} s", variable.name)));
            }
            column.push(value);
        }
        if let Some(momentum) = &mut momentum {
            momentum.sample(&instance, t, given)?;
        }
        run.status = run.status.max(instance.read(&status)?);
        Ok(())
    };
    observe(&mut run, 0.0, &at(0.0))?;
    for pair in points.windows(2) {
        let given = at(pair[0]);
        instance.set_reals(&references, &given)?;
        let before = matches!(case.ends, Ends::Stops(_)).then(|| everything(&instance)).transpose()?;
        if let Err(e) = instance.do_step(pair[0], pair[1] - pair[0]) {
            if before.is_some_and(|before| Ok(before) != everything(&instance)) {
                return Err(Failure(format!("a refused step at t = {} s has changed outputs: {e}", pair[0])));
            }
            run.status = instance.get("status.code")?;
            run.stopped = Some((pair[0], e.0));
            break;
        }
        observe(&mut run, pair[1], &at(pair[1]))?;
        if clock.elapsed() > PATIENCE {
            return Err(Failure(format!("at t = {} s after {} s by the clock", pair[1], PATIENCE.as_secs())));
        }
    }
    run.seconds = clock.elapsed().as_secs_f64();
    for (count, name) in run.counts.iter_mut().zip(["solver.steps", "solver.rejected", "solver.iterations"]) {
        *count = instance.get(name)?;
    }
    run.energy_error = instance.get("solver.energy_error")?;
    run.momentum = momentum.map(|m| m.defect());
    Ok(run)
}

/// Every Real output, of which a refused step must change none. Its counts and its status tell of the step.
fn everything(instance: &Instance) -> Result<Vec<f64>> {
    let outputs = instance.description.variables.iter().filter(|v| v.causality == "output" && v.kind == Kind::Real);
    outputs.filter(|v| !v.name.starts_with("solver.")).map(|v| instance.read(v)).collect()
}
