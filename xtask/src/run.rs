//! `cargo xtask run`: drives a packed FMU.

use crate::error::{Failure, at};
use crate::host::{Description, Fmu, Instance, Variable};
use crate::series::Series;
use crate::voyage::{self, POSE, Record, Scene};
use indicatif::{ProgressBar, ProgressStyle};
use model_description::Kind;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Drive a packed FMU and write its outputs
#[derive(clap::Args, Debug)]
pub struct Args {
    /// The packed FMU
    fmu: PathBuf,
    /// Inputs over time: headers are variable names, the first column is `time`; linear between rows
    #[arg(long, value_name = "CSV")]
    input: Option<PathBuf>,
    /// Where the outputs go [default: target/run/NAME.csv]
    #[arg(long, value_name = "CSV")]
    output: Option<PathBuf>,
    /// End of the run, s [default: end of the input, else the FMU's default experiment]
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    stop: Option<f64>,
    /// Communication step, s [default: the FMU's preferred step]
    #[arg(long, value_name = "H", allow_negative_numbers = true)]
    step: Option<f64>,
    /// A parameter or an input's start value; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// A folder for a page of loads and detachments, index.html, and animation.html
    #[arg(long, value_name = "FOLDER")]
    page: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// Names the file, option or variable and what was expected. A run that fails on its way leaves what it has in `NAME.partial.csv`.
pub fn run(args: Args) -> Result<(), Failure> {
    let fmu = Fmu::open(&args.fmu)?;
    let description = &fmu.description;
    let inputs = args.input.as_deref().map(|path| Inputs::read(path, description)).transpose()?;
    let plan = Plan::new(&args, description, inputs.as_ref())?;
    let output = args.output.unwrap_or_else(|| PathBuf::from(format!("target/run/{}.csv", description.identifier)));

    // Before the run, so that a folder that cannot be made costs no run.
    args.page.iter().try_for_each(|folder| fs::create_dir_all(folder).map_err(|e| at(folder, format!("cannot be made: {e}"))))?;

    let instance = fmu.instantiate(&description.model_name)?;
    for assignment in &args.set {
        let (name, value) =
            assignment.split_once('=').ok_or_else(|| Failure(format!("--set {assignment}: expected NAME=VALUE, such as cable.EA=4000")))?;
        instance.set_text(name.trim(), value).map_err(|e| Failure(format!("--set {assignment}: {e}")))?;
    }
    instance.setup(None, plan.start, Some(plan.stop))?;
    instance.enter_initialization()?;
    inputs.iter().try_for_each(|inputs| inputs.send(&instance, plan.start))?;
    instance.exit_initialization()?;

    let mut table = OutputTable::create(&output, description)?;
    if args.page.is_some() {
        table.record = Some(Recorder::new(&instance, inputs.as_ref())?);
    }
    let outcome = drive(&instance, &plan, inputs.as_ref(), &mut table);
    let page = args.page.zip(table.record.take());
    let failure = outcome.as_ref().err().map(ToString::to_string);
    let written = match &outcome {
        Ok(()) => {
            instance.terminate()?;
            output
        }
        Err(_) => output.with_extension("partial.csv"),
    };
    let names: Vec<_> = table.variables.iter().map(|variable| variable.name.clone()).collect();
    table.finish(&written)?;
    let mut pages = None;
    if let Some((folder, recorder)) = page {
        let scene = Scene::of(&fmu, &instance)?;
        voyage::write(&recorder.record(&description.model_name, &names, scene, failure), &folder)?;
        pages = Some(folder.join("index.html"));
    }
    let shown: Vec<_> = [Some(written), pages].into_iter().flatten().map(|path| path.display().to_string()).collect();
    outcome.map_err(|failure| Failure(format!("{failure}\nresults up to there are in {}", shown.join(" and "))))?;
    println!("{}", shown.join("\n"));
    Ok(())
}

/// The rows of a run, kept for its page.
struct Recorder {
    /// The pose at the start, for what the inputs do not give.
    pose: [f64; 6],
    /// Columns of the inputs.
    columns: [Option<usize>; 6],
    times: Vec<f64>,
    poses: Vec<[f64; 6]>,
    rows: Vec<Vec<f64>>,
}

impl Recorder {
    fn new(instance: &Instance, inputs: Option<&Inputs>) -> Result<Self, Failure> {
        let (mut pose, mut columns) = ([0.0; 6], [None; 6]);
        for (k, name) in POSE.into_iter().enumerate() {
            if let Ok(variable) = instance.description.variable(name) {
                pose[k] = instance.read(variable)?;
                columns[k] = inputs.and_then(|inputs| inputs.series.names.iter().position(|column| column == name));
            }
        }
        Ok(Self { pose, columns, times: Vec::new(), poses: Vec::new(), rows: Vec::new() })
    }

    /// A row of outputs; the ship is where the inputs say that it is then, not where it was when the step began.
    fn row(&mut self, time: f64, inputs: Option<&Inputs>, row: Vec<f64>) {
        let now = |k: usize| self.columns[k].zip(inputs).map_or(self.pose[k], |(column, inputs)| inputs.series.at(column, time));
        self.poses.push(std::array::from_fn(now));
        self.times.push(time);
        self.rows.push(row);
    }

    fn record(self, title: &str, names: &[String], scene: Scene, failure: Option<String>) -> Record {
        let outputs = names.iter().enumerate().map(|(k, name)| (name.clone(), self.rows.iter().map(|row| row[k]).collect()));
        let poses = POSE.into_iter().enumerate().map(|(k, name)| (name.to_owned(), self.poses.iter().map(|pose| pose[k]).collect()));
        let columns: BTreeMap<_, _> = outputs.chain(poses).collect();
        Record { title: title.to_owned(), times: self.times, columns, scene, failure }
    }
}

/// The communication points: whole steps from the start, the last one shortened.
struct Plan {
    start: f64,
    stop: f64,
    step: f64,
}

impl Plan {
    fn new(args: &Args, description: &Description, inputs: Option<&Inputs>) -> Result<Self, Failure> {
        let span = inputs.map(|inputs| inputs.series.span());
        let start = span.map(|(first, _)| first).or(description.start).unwrap_or(0.0);
        let stop = args.stop.or(span.map(|(_, last)| last)).or(description.stop);
        let stop = stop.ok_or_else(|| Failure("--stop: the FMU has no default stop time; expected one".into()))?;
        let step = args.step.or(description.step);
        let step = step.ok_or_else(|| Failure("--step: the FMU has no preferred step; expected one".into()))?;
        if !(stop.is_finite() && stop > start) {
            return Err(Failure(format!("--stop {stop}: expected a time after the start at {start} s")));
        }
        if !(step.is_finite() && step > 0.0) {
            return Err(Failure(format!("--step {step}: expected a positive number of seconds")));
        }
        if let Some((inputs, (_, last))) = inputs.zip(span).filter(|(_, (_, last))| stop > last + 1e-9 * (1.0 + last.abs())) {
            let problem = format!("the input ends at {last} s; expected it to reach --stop {stop}");
            return Err(at(&inputs.path, problem));
        }
        Ok(Self { start, stop, step })
    }

    /// Number of steps. A rest of less than a millionth of a step is rounding.
    fn steps(&self) -> u64 {
        ((self.stop - self.start) / self.step - 1e-6).ceil().max(1.0) as u64
    }

    /// Computed from its number, so that rounding does not add up.
    fn point(&self, k: u64) -> f64 {
        if k >= self.steps() { self.stop } else { self.start + k as f64 * self.step }
    }
}

/// The columns of the input file, bound to input variables.
struct Inputs {
    path: PathBuf,
    series: Series,
    references: Vec<u32>,
    /// Column of the series for each reference.
    columns: Vec<usize>,
}

impl Inputs {
    fn read(path: &Path, description: &Description) -> Result<Self, Failure> {
        let series = Series::read(path)?;
        let (mut references, mut columns) = (Vec::new(), Vec::new());
        for (column, name) in series.names.iter().enumerate() {
            let variable = match description.variable(name) {
                Ok(variable) => variable,
                // A file of ship motion may know more derivatives than the FMU asks for.
                Err(_) if is_ship_motion(name) => continue,
                Err(failure) => return Err(at(path, format!("column '{name}': {failure}"))),
            };
            if variable.causality != "input" || variable.kind != Kind::Real {
                let problem = format!("column '{name}' is no input but {} {:?}", variable.causality, variable.kind);
                return Err(at(path, format!("{problem}; expected inputs such as {}", some_inputs(description))));
            }
            references.push(variable.reference);
            columns.push(column);
        }
        // A pose without one of its components, or a position without its velocity, is no motion.
        let has = |variable: &&Variable| series.names.contains(&variable.name);
        let ship: Vec<_> = description.with_causality("input").filter(|variable| is_ship_motion(&variable.name)).collect();
        if let Some(missing) = ship.iter().find(|variable| !has(variable)).filter(|_| ship.iter().any(has)) {
            let names: Vec<_> = ship.iter().map(|variable| variable.name.as_str()).collect();
            let problem = format!("column '{}' is missing; the FMU takes all of {}", missing.name, names.join(", "));
            return Err(at(path, problem));
        }
        Ok(Self { path: path.to_owned(), series, references, columns })
    }

    fn send(&self, instance: &Instance, time: f64) -> Result<(), Failure> {
        let values: Vec<_> = self.columns.iter().map(|&column| self.series.at(column, time)).collect();
        instance.set_reals(&self.references, &values)
    }
}

fn is_ship_motion(name: &str) -> bool {
    name.starts_with("ship.")
}

fn some_inputs(description: &Description) -> String {
    let names: Vec<_> = description.with_causality("input").map(|variable| variable.name.as_str()).take(3).collect();
    names.join(", ")
}

fn drive(instance: &Instance, plan: &Plan, inputs: Option<&Inputs>, table: &mut OutputTable) -> Result<(), Failure> {
    // Hidden unless stderr is a terminal.
    let progress = ProgressBar::new(plan.steps());
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent:>3} %  {msg}  {eta} left") {
        progress.set_style(style);
    }
    table.row(instance, plan.start, inputs)?;
    for k in 0..plan.steps() {
        let (time, next) = (plan.point(k), plan.point(k + 1));
        inputs.iter().try_for_each(|inputs| inputs.send(instance, time))?;
        instance.do_step(time, next - time).map_err(|e| Failure(format!("step from t = {time} s to {next} s: {e}")))?;
        table.row(instance, next, inputs)?;
        progress.set_message(format!("t = {next:.2} s"));
        progress.inc(1);
    }
    progress.finish_and_clear();
    Ok(())
}

/// A CSV file that takes its name only when it is whole.
struct OutputTable {
    file: BufWriter<NamedTempFile>,
    variables: Vec<Variable>,
    /// Takes the rows too, where a page is wanted.
    record: Option<Recorder>,
}

impl OutputTable {
    fn create(path: &Path, description: &Description) -> Result<Self, Failure> {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        fs::create_dir_all(folder).map_err(|e| at(folder, e))?;
        let mut prefix = OsString::from(".");
        prefix.push(path.file_name().ok_or_else(|| at(path, "expected the name of a CSV file"))?);
        let mut builder = tempfile::Builder::new();
        // Temporary files are private, results are not.
        #[cfg(unix)]
        let builder = builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let file = builder.prefix(&prefix).tempfile_in(folder).map_err(|e| at(folder, e))?;
        let numbers = |variable: &&Variable| variable.kind != Kind::String;
        let variables: Vec<_> = description.with_causality("output").filter(numbers).cloned().collect();
        let mut table = Self { file: BufWriter::new(file), variables, record: None };
        let names: Vec<_> = table.variables.iter().map(|variable| variable.name.as_str()).collect();
        let header = format!("time,{}", names.join(","));
        table.line(&header)?;
        Ok(table)
    }

    fn row(&mut self, instance: &Instance, time: f64, inputs: Option<&Inputs>) -> Result<(), Failure> {
        let values = self.variables.iter().map(|variable| instance.read(variable)).collect::<Result<Vec<_>, _>>()?;
        let mut line = time.to_string();
        values.iter().for_each(|value| line.push_str(&format!(",{value}")));
        self.line(&line)?;
        self.record.iter_mut().for_each(|record| record.row(time, inputs, values.clone()));
        Ok(())
    }

    fn line(&mut self, line: &str) -> Result<(), Failure> {
        writeln!(self.file, "{line}").map_err(|e| Failure(format!("cannot write the output: {e}")))
    }

    fn finish(self, path: &Path) -> Result<(), Failure> {
        let file = self.file.into_inner().map_err(|e| at(path, e.error()))?;
        file.persist(path).map(drop).map_err(|e| at(path, e.error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_end_exactly_at_the_stop_time() {
        let plan = Plan { start: -1.0, stop: 0.05, step: 0.1 };
        assert_eq!(plan.steps(), 11);
        assert_eq!((plan.point(0), plan.point(1), plan.point(11)), (-1.0, -0.9, 0.05));
        assert_eq!(Plan { start: 0.0, stop: 0.3, step: 0.1 }.steps(), 3);
        assert_eq!(Plan { start: 0.0, stop: 1.0, step: 9.0 }.steps(), 1);
    }
}
