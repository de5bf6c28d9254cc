//! Where the report's scenes are packed, and how a packed FMU is driven.

use super::scene::{SHAPE, Scene};
use crate::error::{Failure, Result, at};
use crate::host::{Fmu, Instance};
use crate::package::{Packer, model};
use std::fs;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use tempfile::TempDir;

/// The built library and a folder for scenes and FMUs, which is gone with it.
pub struct Bench {
    packer: Packer,
    folder: TempDir,
    packed: AtomicUsize,
}

impl Bench {
    /// Builds the library.
    ///
    /// # Errors
    /// A build that fails, no folder for temporary files.
    pub fn new() -> Result<Self> {
        let folder = tempfile::Builder::new().prefix("fairlead-report-").tempdir();
        let folder = folder.map_err(|e| Failure(format!("no folder for the report's FMUs: {e}")))?;
        Ok(Self { packer: Packer::new()?, folder, packed: AtomicUsize::new(0) })
    }

    /// Writes the scene to a file, packs it as an FMU and opens that.
    ///
    /// # Errors
    /// A wrong scene, files that cannot be written.
    pub fn pack(&self, scene: &Scene) -> Result<Fmu> {
        let folder = self.folder.path().join(self.packed.fetch_add(1, Ordering::Relaxed).to_string());
        fs::create_dir(&folder).map_err(|e| at(&folder, e))?;
        let (text, shape) = scene.files();
        let path = folder.join("scene.toml");
        fs::write(&path, text).map_err(|e| at(&path, e))?;
        if let Some(shape) = shape {
            fs::write(folder.join(SHAPE), shape).map_err(|e| at(&folder, e))?;
        }
        // A message about the scene names its file by its own name, not by a folder that differs from run to run.
        let model = model(&path.to_string_lossy()).map_err(|e| Failure(e.0.replace(&*path.to_string_lossy(), "scene.toml")))?;
        let fmu = folder.join("scene.fmu");
        self.packer.write(&model, &fmu)?;
        let opened = Fmu::open(&fmu)?;
        // What was unpacked is enough; the archives of a whole report would fill a small /tmp.
        fs::remove_file(&fmu).map_err(|e| at(&fmu, e))?;
        Ok(opened)
    }

    /// How many FMUs were packed so far.
    pub fn count(&self) -> usize {
        self.packed.load(Ordering::Relaxed)
    }

    /// Packs a scene and starts it.
    ///
    /// # Errors
    /// As [`Self::pack`] and [`start`].
    pub fn rest(&self, scene: &Scene) -> Result<Instance> {
        start(&self.pack(scene)?, &[], &[])
    }
}

/// An instance at its first communication point, t = 0.
///
/// # Errors
/// The FMU's own reasons.
pub fn start(fmu: &Fmu, parameters: &[(&str, f64)], inputs: &[(&str, f64)]) -> Result<Instance> {
    let instance = fmu.instantiate("report")?;
    parameters.iter().try_for_each(|(name, value)| instance.set(name, *value))?;
    instance.setup(None, 0.0, None)?;
    instance.enter_initialization()?;
    inputs.iter().try_for_each(|(name, value)| instance.set(name, *value))?;
    instance.exit_initialization()?;
    Ok(instance)
}

/// Position of a drawn point, numbered from 1, m.
///
/// # Errors
/// No such point.
pub fn point(instance: &Instance, number: usize) -> Result<[f64; 3]> {
    let get = |axis: &str| instance.get(&format!("cable.point[{number}].{axis}"));
    Ok([get("x")?, get("y")?, get("z")?])
}

/// A vector of three outputs `NAME.x`, `.y`, `.z`.
///
/// # Errors
/// No such outputs.
pub fn vector(instance: &Instance, name: &str) -> Result<[f64; 3]> {
    let get = |axis: &str| instance.get(&format!("{name}.{axis}"));
    Ok([get("x")?, get("y")?, get("z")?])
}

/// How to drive an FMU: communication step and end, s; parameters; inputs over time, given at the start of each step.
pub struct Drive<'a> {
    /// Communication step.
    pub step: f64,
    /// End of the run.
    pub end: f64,
    /// Parameters to change.
    pub parameters: &'a [(&'a str, f64)],
    /// Names of the inputs.
    pub inputs: &'a [&'a str],
    /// Their values.
    pub at: &'a (dyn Fn(f64) -> Vec<f64> + Sync),
}

impl Drive<'_> {
    /// Without inputs.
    pub fn still(step: f64, end: f64) -> Self {
        Drive { step, end, parameters: &[], inputs: &[], at: &|_| Vec::new() }
    }
}

/// What a run gave: the time and the outputs asked for, at every communication point from the start.
#[derive(Clone, Debug)]
pub struct Record<const N: usize> {
    /// s
    pub times: Vec<f64>,
    /// One column a name.
    pub columns: [Vec<f64>; N],
    /// What the communication loop took of this thread's processor time, s.
    pub seconds: f64,
    /// The solver's sub-steps, and its linear solves.
    pub sub_steps: f64,
    /// See `sub_steps`.
    pub iterations: f64,
}

/// Runs an FMU and records outputs.
///
/// # Errors
/// The FMU's own reasons, with the time.
pub fn record<const N: usize>(fmu: &Fmu, drive: &Drive, outputs: [&str; N]) -> Result<Record<N>> {
    let first: Vec<(&str, f64)> = drive.inputs.iter().copied().zip((drive.at)(0.0)).collect();
    let instance = start(fmu, drive.parameters, &first)?;
    let reference = |name: &&str| Ok(fmu.description.variable(name)?.reference);
    let inputs = drive.inputs.iter().map(reference).collect::<Result<Vec<_>>>()?;
    let references = outputs.iter().map(reference).collect::<Result<Vec<_>>>()?;
    let mut record =
        Record { times: Vec::new(), columns: std::array::from_fn(|_| Vec::new()), seconds: 0.0, sub_steps: 0.0, iterations: 0.0 };
    let mut row = [f64::NAN; N];
    let mut push = |time: f64, instance: &Instance| -> Result<()> {
        instance.get_reals(&references, &mut row)?;
        record.times.push(time);
        record.columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
        Ok(())
    };
    push(0.0, &instance)?;
    let clock = cpu_seconds();
    for k in 0..(drive.end / drive.step).round() as usize {
        let (from, to) = (k as f64 * drive.step, (k + 1) as f64 * drive.step);
        instance.set_reals(&inputs, &(drive.at)(from))?;
        instance.do_step(from, to - from).map_err(|e| Failure(format!("step from t = {from} s to {to} s: {e}")))?;
        push(to, &instance)?;
    }
    record.seconds = cpu_seconds() - clock;
    record.sub_steps = instance.get("solver.steps")?;
    record.iterations = instance.get("solver.iterations")?;
    instance.terminate()?;
    Ok(record)
}

/// Processor time of this thread, s: other programs beside this one do not count. By the clock where the system has none.
fn cpu_seconds() -> f64 {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
    }
    #[cfg(not(unix))]
    {
        use std::{sync::OnceLock, time::Instant};
        static START: OnceLock<Instant> = OnceLock::new();
        START.get_or_init(Instant::now).elapsed().as_secs_f64()
    }
}

/// Every item through `f`, on two threads; results in the items' order.
pub fn side_by_side<T: Sync, R: Send>(items: &[T], f: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let results = Mutex::new(items.iter().map(|_| None).collect::<Vec<Option<R>>>());
    thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some((i, item)) = Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|i| Some((i, items.get(i)?))) {
                    let result = f(item);
                    results.lock().unwrap_or_else(std::sync::PoisonError::into_inner)[i] = Some(result);
                }
            });
        }
    });
    // A panic in `f` has already ended the scope, so every place is filled.
    results.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner).into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_results_keep_the_order_of_the_items() {
        let items: Vec<usize> = (0..100).collect();
        assert_eq!(side_by_side(&items, |i| i * i), items.iter().map(|i| i * i).collect::<Vec<_>>());
    }
}
