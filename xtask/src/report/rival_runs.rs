//! Other programs beside ours: which runs of theirs `cargo xtask bench --peers` makes, and what each gave.
//!
//! Each program comes from PyPI, in the version of fmu-tests/peers/requirements.txt, into a virtual environment of its own under the target
//! folder. A driver in fmu-tests/peers sets up the scene, writes its samples as CSV and prints the CPU seconds of the solver call alone.

use super::track::Track;
use crate::error::{Failure, Result, at};
use crate::package::{root, target_folder};
use crate::python::environment;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Program {
    /// Multibody, ANCF cables, generalized alpha at a fixed step.
    Exudyn,
    /// Lumped masses, explicit Runge-Kutta of second order at a fixed step.
    MoorDyn,
}

impl Program {
    /// All, in the order of their numbers in files.
    pub const ALL: [Self; 2] = [Self::Exudyn, Self::MoorDyn];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Exudyn => "Exudyn",
            Self::MoorDyn => "MoorDyn",
        }
    }

    fn driver(self) -> &'static str {
        match self {
            Self::Exudyn => "exudyn_cable.py",
            Self::MoorDyn => "moordyn_cable.py",
        }
    }
}

/// One run: a program, a case of the bench, a number of elements and a step, s.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Who.
    pub program: Program,
    /// The case's name.
    pub case: &'static str,
    /// Mesh.
    pub elements: u32,
    /// The program's own step.
    pub step: f64,
}

impl Plan {
    const fn new(program: Program, case: &'static str, elements: u32, step: f64) -> Self {
        Self { program, case, elements, step }
    }

    /// Mesh and step in words.
    pub fn mesh(&self) -> String {
        let milli = 1e3 * self.step;
        let step = if milli < 0.1 { format!("{:.0} µs", 1e3 * milli) } else { format!("{milli} ms") };
        format!("{} elements, {step}", self.elements)
    }
}

/// Steps are the greatest that run through and are worth it: an explicit program's is near the limit of its stability.
pub const PLANS: [Plan; 15] = [
    Plan::new(Program::Exudyn, "p1", 10, 2e-4),
    Plan::new(Program::Exudyn, "p1", 20, 2e-4),
    Plan::new(Program::Exudyn, "p1", 40, 1e-4),
    Plan::new(Program::Exudyn, "p3", 10, 1e-3),
    Plan::new(Program::Exudyn, "p3", 20, 5e-4),
    Plan::new(Program::Exudyn, "p3", 40, 2e-4),
    Plan::new(Program::MoorDyn, "p3", 20, 1e-5),
    Plan::new(Program::Exudyn, "p4a", 5, 1e-2),
    Plan::new(Program::MoorDyn, "p4a", 20, 1e-3),
    Plan::new(Program::Exudyn, "p4b", 10, 2e-3),
    Plan::new(Program::MoorDyn, "p4b", 10, 2e-3),
    Plan::new(Program::MoorDyn, "p4b", 20, 1e-3),
    Plan::new(Program::MoorDyn, "p5", 10, 4e-5),
    Plan::new(Program::MoorDyn, "p5", 20, 2e-5),
    Plan::new(Program::MoorDyn, "p5", 40, 1e-5),
];

/// The programs, ready to run.
pub struct Rivals {
    python: PathBuf,
    drivers: PathBuf,
}

impl Rivals {
    /// Installs the programs where they are not there yet.
    ///
    /// # Errors
    /// No Python, or pip could not install something.
    pub fn new() -> Result<Self> {
        let drivers = root().join("fmu-tests").join("peers");
        let python = environment(&drivers.join("requirements.txt"), &target_folder().join("peers").join(".venv"))?;
        Ok(Self { python, drivers })
    }

    /// Makes a run to `end` with samples every `every`, s; gives them and the CPU seconds of the solver call, the least of `repeats` runs or
    /// of one that took longer than `long`, s.
    ///
    /// # Errors
    /// The driver's last words, or samples that are no numbers.
    pub fn run(&self, plan: &Plan, every: f64, end: f64, repeats: usize, long: f64) -> Result<(Track, f64)> {
        let folder = tempfile::Builder::new().prefix("fairlead-peer-").tempdir();
        let folder = folder.map_err(|e| Failure(format!("no folder for a peer's samples: {e}")))?;
        let out = folder.path().join("samples.csv");
        let mut best: Option<(Track, f64)> = None;
        for _ in 0..repeats.max(1) {
            let (track, seconds) = self.once(plan, every, end, &out)?;
            if best.as_ref().is_none_or(|b| seconds < b.1) {
                best = Some((track, seconds));
            }
            if seconds > long {
                break;
            }
        }
        best.ok_or_else(|| Failure("no run".into()))
    }

    fn once(&self, plan: &Plan, every: f64, end: f64, out: &Path) -> Result<(Track, f64)> {
        let driver = self.drivers.join(plan.program.driver());
        let output = Command::new(&self.python)
            .arg(&driver)
            .args([plan.case.to_owned(), plan.elements.to_string(), plan.step.to_string(), every.to_string(), end.to_string()])
            .arg(out)
            .envs(["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"].map(|name| (name, "1")))
            .stdin(Stdio::null())
            .output()
            .map_err(|e| Failure(format!("{} cannot be started: {e}", self.python.display())))?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            let last = said.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("it said nothing");
            return Err(Failure(format!("{} ended with {}: {last}", plan.program.driver(), output.status)));
        }
        let text = fs::read_to_string(out).map_err(|e| at(out, e))?;
        let named = |problem: Failure| Failure(format!("{}: {problem}", plan.program.driver()));
        Ok((samples(&text).map_err(named)?, seconds(&String::from_utf8_lossy(&output.stdout)).map_err(named)?))
    }
}

/// What a driver printed last: `seconds S`.
fn seconds(printed: &str) -> Result<f64> {
    let last = printed.lines().last().unwrap_or_default();
    let number = last.strip_prefix("seconds ").and_then(|s| s.trim().parse::<f64>().ok()).filter(|s| *s > 0.0 && s.is_finite());
    number.ok_or_else(|| Failure(format!("the last line printed is \"{last}\"; expected \"seconds\" and a number above 0")))
}

/// A driver's samples: columns `time`, `tension`, and for a place `x` and `z` or the angle `wrap`.
fn samples(text: &str) -> Result<Track> {
    let mut lines = text.lines();
    let header = lines.next().unwrap_or_default();
    let column = |name: &str| header.split(',').position(|h| h == name);
    let missing = |name: &str| Failure(format!("its columns are \"{header}\"; expected one named {name}"));
    let time = column("time").ok_or_else(|| missing("time"))?;
    let tension = column("tension").ok_or_else(|| missing("tension"))?;
    let place = [column("x").or(column("wrap")), column("z")];
    let mut track = Track::default();
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |k: usize| {
            let cell = cells.get(k).copied().unwrap_or_default();
            let at = cells.get(time).copied().unwrap_or_default();
            let value = cell.trim().parse::<f64>().ok().filter(|x| x.is_finite());
            value.ok_or_else(|| Failure(format!("\"{cell}\" at {at} s; expected a finite number")))
        };
        track.times.push(number(time)?);
        track.tension.push(number(tension)?);
        if let [Some(first), second] = place {
            track.place.push([number(first)?, second.map_or(Ok(0.0), number)?]);
        }
    }
    if track.times.is_empty() { Err(Failure("it wrote no samples".into())) } else { Ok(track) }
}

#[cfg(test)]
mod tests {
    use super::super::cases::cases;
    use super::*;

    #[test]
    fn exact_a_drivers_output_is_read() {
        let track = samples("time,tension,x,z\n0,5.5,1,2\n0.01,6.5,3,-4e-1\n").unwrap();
        assert_eq!(track, Track { times: vec![0.0, 0.01], tension: vec![5.5, 6.5], place: vec![[1.0, 2.0], [3.0, -0.4]] });
        assert_eq!(samples("time,tension,wrap\n0,1,0.6\n").unwrap().place, [[0.6, 0.0]]);
        assert_eq!(samples("tension,time\n1,0\n").unwrap(), Track { times: vec![0.0], tension: vec![1.0], place: vec![] });
        assert_eq!(seconds("MoorDyn says much\nseconds 0.25\n"), Ok(0.25));
    }

    #[test]
    fn exact_wrong_outputs_are_named() {
        let said = |text| samples(text).unwrap_err().0;
        assert_eq!(said("time,x\n0,1\n"), "its columns are \"time,x\"; expected one named tension");
        assert_eq!(said("time,tension\n0,1\n0.5,nan\n"), "\"nan\" at 0.5 s; expected a finite number");
        assert_eq!(said("time,tension\n0\n"), "\"\" at 0 s; expected a finite number");
        assert_eq!(said("time,tension\n"), "it wrote no samples");
        for text in ["", "seconds", "seconds -1", "seconds nan", "seconds 1\nand more"] {
            assert!(seconds(text).unwrap_err().0.contains("expected \"seconds\" and a number above 0"), "{text}");
        }
    }

    #[test]
    fn exact_every_plan_is_of_a_case_and_of_a_driver() {
        let cases = cases().unwrap();
        for plan in PLANS {
            assert!(cases.iter().any(|case| case.name == plan.case), "{plan:?}");
            let driver = root().join("fmu-tests").join("peers").join(plan.program.driver());
            let text = fs::read_to_string(&driver).unwrap();
            assert!(text.contains(&format!("\"{}\":", plan.case)), "{plan:?} is not among the scenes of {}", driver.display());
        }
    }
}
