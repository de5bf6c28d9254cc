//! `cargo xtask demo`: from the default scene to a report, by way of a packed FMU.

mod heave;

use crate::demo_report::{self, DemoData, Drum};
use crate::error::{Failure, Result, at};
use crate::host::{Fmu, Instance, Variable};
use crate::package::{package, target_folder};
use crate::results::{publish, save, shown};
use crate::ship_motion::{HEADER, Motion, Options, generate};
use crate::voyage::{self, Record, Scene};
use fairlead::variables::VERSION;
use heave::SimplifiedSheave;
use indicatif::{ProgressBar, ProgressStyle};
use model_description::Kind;
use model_description::scenes::SCENES;
use std::collections::BTreeMap;
use std::env::consts::{ARCH, OS};
use std::fmt::Write as _;
use std::io::IsTerminal;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};
use std::{env, fs, thread};

/// Pack the default scene, drive it over a ship motion and report under target/demo
#[derive(clap::Args)]
pub struct Args {}

/// What the winch is told.
const COMMAND: [&str; 2] = ["winch.setpoint", "winch.setpoint_rate"];

/// Communication step, s.
const STEP: f64 = 0.01;

/// The sea and the ship, full-scale. At this scale the ship's speed is that of the flume's current at the surface (0.33 m/s), and the winch
/// moves by a few centimetres as in the thesis's Figure 27.
fn sea() -> Options {
    Options {
        hs: 2.5,
        tp: 9.0,
        heading: 150.0,
        speed: 2.1,
        length: 80.0,
        beam: 14.0,
        draught: 4.5,
        block_coefficient: 0.6,
        scale: 40.0,
        step: STEP,
        ..Options::default()
    }
}

/// Runs the command.
///
/// # Errors
/// A build that fails, an FMU that refuses, a folder that cannot be written.
pub fn run(_args: Args) -> Result<()> {
    let scene = SCENES[0].name;
    println!("packing the scene {scene} (the first build takes a while)");
    let path = package(scene, None)?;
    println!("{}", shown(&path));

    let sea = sea();
    let motion = generate(&sea)?;
    println!("ship motion: {}", in_words(&sea));
    let fmu = Fmu::open(&path)?;
    let compensated = simulate(&fmu, &motion, Winch::Compensates)?;
    let held = simulate(&fmu, &motion, Winch::Held)?;

    let folder = target_folder().join("demo");
    let data = data(&fmu, &sea, &path, compensated, &held)?;
    publish(&folder, |folder| {
        let given = HEADER[1..].iter().chain(&COMMAND).copied();
        save(&folder.join("motion.csv"), &csv(&data.times, &data.columns, given))?;
        save(&folder.join("results.csv"), &csv(&data.times, &data.columns, data.columns.keys().map(String::as_str)))?;
        save(&folder.join("results-winch-held.csv"), &csv(&data.times, &held.columns, held.columns.keys().map(String::as_str)))?;
        demo_report::write(&data, folder)
    })?;
    for (what, value) in demo_report::findings(&data) {
        println!("{what}: {value}");
    }
    println!("{}", shown(&folder.join("index.html")));
    Ok(())
}

/// Inputs over time: their names, and their values at a communication point.
pub type InputsOverTime = (&'static [&'static str], Box<dyn Fn(f64) -> Vec<f64> + Sync>);

/// The demo's ship motion, every 10 ms.
///
/// # Errors
/// None that its fixed options could have.
pub fn sea_inputs() -> Result<InputsOverTime> {
    let motion = generate(&sea())?;
    Ok((&HEADER[1..], Box::new(move |t| motion.row((t / STEP).round() as usize).to_vec())))
}

/// What the winch is told.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Winch {
    /// Heave compensation.
    Compensates,
    /// Its first angle throughout.
    Held,
}

/// A run's record: one value a row for every input and every output with a number.
struct Run {
    times: Vec<f64>,
    columns: BTreeMap<String, Vec<f64>>,
    /// Wall-clock time in the FMU's functions from instantiation to the first step, and from there to the end.
    start: Duration,
    calls: Duration,
    /// Some of the FMU's parameters.
    drum: Drum,
    waterline: f64,
    scene: Scene,
}

/// Drives the FMU as a host with a winch controller would: per step, ship motion and set-point in, one step, outputs out.
fn simulate(fmu: &Fmu, motion: &Motion, winch: Winch) -> Result<Run> {
    let clock = Instant::now();
    let times = &motion.times;
    let end = times[times.len() - 1];
    let mut ship = Inputs::new(fmu, HEADER[1..].iter().copied())?;
    let mut command = Inputs::new(fmu, COMMAND.into_iter())?;
    let instance = fmu.instantiate("demo")?;
    instance.setup(None, times[0], Some(end))?;
    instance.enter_initialization()?;
    ship.send(&instance, &motion.row(0))?;
    instance.exit_initialization()?;
    let controller = SimplifiedSheave::of(&instance, &motion.states[0])?;
    let setpoint = |row: usize| match winch {
        Winch::Compensates => controller.setpoint(&motion.states[row]),
        Winch::Held => [controller.angle, 0.0],
    };
    let drum = Drum {
        x: instance.get("winch.position[1]")?,
        z: instance.get("winch.position[3]")?,
        radius: 1.0 / controller.turn.abs(),
        // Seen from starboard, x to the right: an angle about y (to port) grows clockwise.
        clockwise: controller.turn * instance.get("winch.axis[2]")? > 0.0,
    };
    let waterline = instance.get("fluid.waterline")?;
    let scene = Scene::of(fmu, &instance)?;
    let mut outputs = Outputs::new(fmu);
    outputs.record(&instance)?;
    let start = clock.elapsed();

    let what = match winch {
        Winch::Compensates => "winch compensating",
        Winch::Held => "winch held       ",
    };
    let progress = Progress::new(what, end);
    let mut calls = Duration::ZERO;
    for (row, pair) in times.windows(2).enumerate() {
        let (state, command_now) = (motion.row(row), setpoint(row));
        let clock = Instant::now();
        ship.send(&instance, &state)?;
        command.send(&instance, &command_now)?;
        let step = instance.do_step(pair[0], pair[1] - pair[0]);
        step.map_err(|e| Failure(format!("step from t = {} s to {} s: {e}", pair[0], pair[1])))?;
        outputs.record(&instance)?;
        calls += clock.elapsed();
        progress.at(pair[1]);
    }
    instance.terminate()?;
    progress.finish();

    let mut columns = outputs.columns();
    for (i, name) in HEADER[1..].iter().enumerate() {
        columns.insert((*name).to_owned(), (0..times.len()).map(|row| motion.row(row)[i]).collect());
    }
    for (i, name) in COMMAND.iter().enumerate() {
        columns.insert((*name).to_owned(), (0..times.len()).map(|row| setpoint(row)[i]).collect());
    }
    Ok(Run { times: times.clone(), columns, start, calls, drum, waterline, scene })
}

/// Some Real inputs, set together.
struct Inputs(Vec<u32>);

impl Inputs {
    fn new<'a>(fmu: &Fmu, names: impl Iterator<Item = &'a str>) -> Result<Self> {
        names.map(|name| Ok(fmu.description.variable(name)?.reference)).collect::<Result<_>>().map(Self)
    }

    fn send(&mut self, instance: &Instance, values: &[f64]) -> Result<()> {
        instance.set_reals(&self.0, values)
    }
}

/// Every output with a number, row by row.
struct Outputs {
    /// The Reals first, which are read together.
    variables: Vec<Variable>,
    references: Vec<u32>,
    rows: Vec<f64>,
}

impl Outputs {
    fn new(fmu: &Fmu) -> Self {
        let outputs = || fmu.description.with_causality("output").cloned();
        let mut variables: Vec<_> = outputs().filter(|v| v.kind == Kind::Real).collect();
        let references = variables.iter().map(|v| v.reference).collect();
        variables.extend(outputs().filter(|v| matches!(v.kind, Kind::Integer | Kind::Boolean)));
        Self { variables, references, rows: Vec::new() }
    }

    fn record(&mut self, instance: &Instance) -> Result<()> {
        let first = self.rows.len();
        self.rows.resize(first + self.references.len(), f64::NAN);
        instance.get_reals(&self.references, &mut self.rows[first..])?;
        for variable in &self.variables[self.references.len()..] {
            self.rows.push(instance.read(variable)?);
        }
        Ok(())
    }

    fn columns(&self) -> BTreeMap<String, Vec<f64>> {
        let width = self.variables.len();
        let column = |i: usize| self.rows.iter().skip(i).step_by(width).copied().collect();
        self.variables.iter().enumerate().map(|(i, variable)| (variable.name.clone(), column(i))).collect()
    }
}

/// A bar on a terminal, a line now and then elsewhere.
struct Progress {
    bar: Option<ProgressBar>,
    what: &'static str,
    end: f64,
}

impl Progress {
    fn new(what: &'static str, end: f64) -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new((end / STEP).round() as u64);
            if let Ok(style) = ProgressStyle::with_template("{prefix}  {bar:40} {percent:>3} %  {msg}  {eta} left") {
                bar.set_style(style);
            }
            bar.with_prefix(what)
        });
        Self { bar, what, end }
    }

    fn at(&self, time: f64) {
        let row = (time / STEP).round() as u64;
        match &self.bar {
            Some(bar) => {
                bar.set_message(format!("t = {time:.1} s"));
                bar.set_position(row);
            }
            None if (row as f64 * STEP) % 15.0 < 0.5 * STEP => println!("{}: {time:.0} of {:.0} s", self.what.trim_end(), self.end),
            None => {}
        }
    }

    fn finish(self) {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
            println!("{}: {:.0} s simulated", self.what.trim_end(), self.end);
        }
    }
}

/// What the report is made of.
fn data(fmu: &Fmu, sea: &Options, path: &Path, compensated: Run, held: &Run) -> Result<DemoData> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let size = fs::metadata(path).map_err(|e| at(path, e))?.len() as f64 / 1024.0;
    let description = &fmu.description;
    let facts = [
        ("FMU", format!("{name}, {size:.0} KiB, {} variables, GUID {}", description.variables.len(), description.guid)),
        ("Ship and sea", in_words(sea)),
        ("Scale", format!("1:{} (Froude), full-scale numbers in the line above", sea.scale)),
        ("Winch command", "Δl = −u·Δr (simplified sheave), u taken from the calm cable just beyond the drum".to_owned()),
        ("Communication step", format!("{} ms", STEP * 1e3)),
        ("Wall-clock time to the first step", format!("{:.3} s (instantiation and static equilibrium)", compensated.start.as_secs_f64())),
        ("Program", format!("fairlead {VERSION}{}", compiler().map_or_else(String::new, |c| format!(", {c}")))),
    ];
    let record = Record {
        title: description.model_name.clone(),
        times: compensated.times,
        columns: compensated.columns,
        scene: compensated.scene,
        failure: None,
    };
    Ok(DemoData {
        animation: voyage::animation(&record),
        times: record.times,
        columns: record.columns,
        held: held.columns.clone(),
        drum: Some(compensated.drum),
        waterline: Some(compensated.waterline),
        wall_seconds: compensated.calls.as_secs_f64(),
        facts: facts.into_iter().map(|(what, value)| (what.to_owned(), value)).collect(),
        machine: machine(),
    })
}

/// Ship, sea and seed, full-scale.
fn in_words(o: &Options) -> String {
    format!(
        "ship of {} m × {} m × {} m (block coefficient {}) at {} m/s in a JONSWAP sea with Hs {} m, Tp {} s, γ {}, waves from {}° off the \
         bow, seed {}, scale 1:{}",
        o.length,
        o.beam,
        o.draught,
        o.block_coefficient,
        o.speed,
        o.hs,
        o.tp,
        o.gamma,
        180.0 - o.heading,
        o.seed,
        o.scale
    )
}

/// Processor and system.
pub fn machine() -> String {
    let model = fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| processor(&text)).unwrap_or_else(|| "unknown processor".into());
    let count = thread::available_parallelism().map_or_else(|_| String::new(), |n| format!(", {n} logical processors"));
    format!("{model}{count} (the FMU uses one), {OS} {ARCH}")
}

/// The model's name from the text of /proc/cpuinfo.
fn processor(text: &str) -> Option<String> {
    let line = text.lines().find(|line| line.starts_with("model name"))?;
    let (_, name) = line.split_once(':')?;
    Some(name.split_whitespace().collect::<Vec<_>>().join(" "))
}

fn compiler() -> Option<String> {
    let output = Command::new(env::var_os("RUSTC").unwrap_or_else(|| "rustc".into())).arg("--version").output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    text.lines().next().filter(|line| line.starts_with("rustc")).map(str::to_owned)
}

/// The named columns after `time`; numbers read back to the same bits.
fn csv<'a>(times: &[f64], columns: &BTreeMap<String, Vec<f64>>, names: impl Iterator<Item = &'a str>) -> String {
    let (names, values): (Vec<&str>, Vec<&Vec<f64>>) = names.filter_map(|name| Some((name, columns.get(name)?))).unzip();
    let mut text = format!("time,{}\n", names.join(","));
    for (row, time) in times.iter().enumerate() {
        // Writing to a String cannot fail. `{:?}` is the shortest text that reads back exactly, with an exponent where that is shorter.
        let _ = write!(text, "{time:?}");
        for column in &values {
            let _ = write!(text, ",{:?}", column[row]);
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_csv_has_a_column_a_variable() {
        let columns = BTreeMap::from([("b.x".to_owned(), vec![1.0, 0.1 + 0.2]), ("a".to_owned(), vec![0.0, -1e-20])]);
        let text = csv(&[0.0, 0.01], &columns, ["a", "b.x", "not there"].into_iter());
        let mut lines = text.lines();
        assert_eq!((lines.next(), lines.next()), (Some("time,a,b.x"), Some("0.0,0.0,1.0")));
        let last: Vec<f64> = lines.next().unwrap().split(',').map(|field| field.parse().unwrap()).collect();
        assert_eq!(last, [0.01, -1e-20, 0.1 + 0.2]);
    }

    #[test]
    fn exact_processor_is_found() {
        let text = "processor\t: 0\nmodel name\t: A  Processor @ 2 GHz\n\nmodel name\t: another\n";
        assert_eq!(processor(text).as_deref(), Some("A Processor @ 2 GHz"));
        assert_eq!(processor("Hardware: x"), None);
    }

    /// What the README and the report promise of the ship motion.
    #[test]
    fn frozen_the_winch_moves_a_few_centimetres() {
        let motion = generate(&sea()).unwrap();
        assert_eq!(motion.times.len(), 6001);
        let heave = motion.states.iter().map(|s| s.pose[2].abs()).fold(0.0, f64::max);
        assert!((0.02..0.04).contains(&heave), "{heave}");
        assert_eq!(motion.states[0].pose, [0.0; 6], "the ship starts at rest");
    }

    #[test]
    fn exact_the_readme_s_scene_can_be_packed() {
        let readme = include_str!("../../README.md");
        let scene = readme.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("tow.toml");
        fs::write(&path, scene).unwrap();
        let model = fairlead::variables::Model::read(&path).unwrap();
        assert_eq!(model.initial_scene.name, "tow");
        fairlead::sim::Simulation::new(&model.initial_scene).unwrap();
    }
}
