//! `cargo xtask ship-motion`: a ship's motion in an irregular sea, written as the CSV that `cargo xtask run --input` reads.

use crate::error::Failure;
use crate::seakeeping::motion::{ShipMotion, State};
use crate::seakeeping::rao::{Course, Hull, natural_roll_period};
use crate::seakeeping::spectrum::SeaState;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// The CSV's header: pose, velocities and accelerations under their FMU names.
pub const HEADER: [&str; 19] = [
    "time",
    "ship.x",
    "ship.y",
    "ship.z",
    "ship.roll",
    "ship.pitch",
    "ship.yaw",
    "ship.vx",
    "ship.vy",
    "ship.vz",
    "ship.roll_rate",
    "ship.pitch_rate",
    "ship.yaw_rate",
    "ship.ax",
    "ship.ay",
    "ship.az",
    "ship.roll_acceleration",
    "ship.pitch_acceleration",
    "ship.yaw_acceleration",
];

/// More rows than this are taken for a mistyped step.
const MAX_ROWS: f64 = 2e7;

/// Command line of `ship-motion`.
#[derive(Debug, Clone, clap::Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "The sea is a long-crested JONSWAP sea in deep water; heave, pitch and roll follow Jensen, Mansour & Olsen, Ocean \
    Engineering 31 (2004) 61-85; surge, sway and yaw follow the undisturbed wave. Axes: x forward, y to port, z up; positive pitch is \
    bow down. The motion is that of the centre of gravity about its mean position: the way made at forward speed is not in it. Sea, ship \
    and speed are full-scale; duration, step, ramp and origin belong to the written motion, at model scale if --scale is given."
)]
pub struct Args {
    /// Everything about sea, ship and sampling.
    #[command(flatten)]
    pub options: Options,
    /// File to write
    #[arg(long, value_name = "FILE", default_value = "target/ship-motion.csv")]
    pub out: PathBuf,
}

/// Sea, ship, and how the motion is sampled. [`Options::default`] is the command's default.
#[derive(Debug, Clone, PartialEq, clap::Args)]
pub struct Options {
    /// Significant wave height, m
    #[arg(long, value_name = "M", default_value_t = Options::default().hs)]
    pub hs: f64,
    /// Peak period, s
    #[arg(long, value_name = "S", default_value_t = Options::default().tp)]
    pub tp: f64,
    /// Peak enhancement of the JONSWAP spectrum
    #[arg(long, value_name = "GAMMA", default_value_t = Options::default().gamma)]
    pub gamma: f64,
    /// Direction in which the waves travel, from the ship's x axis towards port, degrees: 180 is head seas
    #[arg(long, value_name = "DEG", default_value_t = Options::default().heading)]
    pub heading: f64,
    /// Forward speed, m/s
    #[arg(long, value_name = "M/S", default_value_t = Options::default().speed)]
    pub speed: f64,
    /// Ship's length, m
    #[arg(long, value_name = "M", default_value_t = Options::default().length)]
    pub length: f64,
    /// Ship's breadth, m
    #[arg(long, value_name = "M", default_value_t = Options::default().beam)]
    pub beam: f64,
    /// Ship's draught, m
    #[arg(long, value_name = "M", default_value_t = Options::default().draught)]
    pub draught: f64,
    /// Block coefficient
    #[arg(long, value_name = "CB", default_value_t = Options::default().block_coefficient)]
    pub block_coefficient: f64,
    /// Waterplane area coefficient [default: (1 + 2 CB)/3]
    #[arg(long, value_name = "CWP")]
    pub waterplane_coefficient: Option<f64>,
    /// Transverse metacentric height, m [default: 0.06 of the breadth]
    #[arg(long, value_name = "M")]
    pub metacentric_height: Option<f64>,
    /// Natural roll period, s [default: 2 pi 0.40 B / sqrt(g GM)]
    #[arg(long, value_name = "S")]
    pub roll_period: Option<f64>,
    /// Viscous roll damping added to that of the waves made, as a fraction of the critical one
    #[arg(long, value_name = "FRACTION", default_value_t = Options::default().roll_damping)]
    pub roll_damping: f64,
    /// Froude length scale: lengths are divided by it, times by its root
    #[arg(long, value_name = "LAMBDA", default_value_t = Options::default().scale)]
    pub scale: f64,
    /// Seed of the random phases and frequencies
    #[arg(long, value_name = "N", default_value_t = Options::default().seed)]
    pub seed: u64,
    /// Number of wave components
    #[arg(long, value_name = "N", default_value_t = Options::default().components)]
    pub components: usize,
    /// Length of the record, s
    #[arg(long, value_name = "S", default_value_t = Options::default().duration)]
    pub duration: f64,
    /// Sampling step, s
    #[arg(long, value_name = "S", default_value_t = Options::default().step)]
    pub step: f64,
    /// Time in which the motion grows smoothly from rest, s; 0 for none
    #[arg(long, value_name = "S", default_value_t = Options::default().ramp)]
    pub ramp: f64,
    /// Added to ship.x, m
    #[arg(long, value_name = "M", default_value_t = 0.0)]
    pub origin_x: f64,
    /// Added to ship.y, m
    #[arg(long, value_name = "M", default_value_t = 0.0)]
    pub origin_y: f64,
    /// Added to ship.z, m
    #[arg(long, value_name = "M", default_value_t = 0.0)]
    pub origin_z: f64,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            hs: 2.5,
            tp: 8.0,
            gamma: 3.3,
            heading: 180.0,
            speed: 0.0,
            length: 80.0,
            beam: 18.0,
            draught: 5.0,
            block_coefficient: 0.7,
            waterplane_coefficient: None,
            metacentric_height: None,
            roll_period: None,
            roll_damping: 0.10,
            scale: 1.0,
            seed: 1,
            components: 200,
            duration: 60.0,
            step: 0.01,
            ramp: 5.0,
            origin_x: 0.0,
            origin_y: 0.0,
            origin_z: 0.0,
        }
    }
}

impl Options {
    /// Checks every value.
    ///
    /// # Errors
    /// Names the option, its value and what was expected.
    pub fn check(&self) -> Result<(), Failure> {
        let within = |option: &str, value: f64, low: f64, high: f64, expected: &str| {
            if value.is_finite() && value >= low && value <= high {
                Ok(())
            } else {
                Err(Failure(format!("--{option} {value}: expected {expected}")))
            }
        };
        let positive = |option: &str, value: f64, unit: &str| {
            if value.is_finite() && value > 0.0 {
                Ok(())
            } else {
                Err(Failure(format!("--{option} {value}: expected a number greater than zero ({unit})")))
            }
        };
        within("hs", self.hs, 0.0, f64::MAX, "a height in metres, zero or more")?;
        positive("tp", self.tp, "s")?;
        within("gamma", self.gamma, 1.0, 20.0, "a number from 1 (Pierson-Moskowitz) to 20")?;
        within("heading", self.heading, -360.0, 360.0, "an angle from -360 to 360 degrees")?;
        within("speed", self.speed, 0.0, f64::MAX, "a speed in m/s, zero or more")?;
        positive("length", self.length, "m")?;
        positive("beam", self.beam, "m")?;
        positive("draught", self.draught, "m")?;
        within("block-coefficient", self.block_coefficient, 0.2, 1.0, "a number from 0.2 to 1")?;
        if let Some(value) = self.waterplane_coefficient {
            within("waterplane-coefficient", value, 0.2, 1.0, "a number from 0.2 to 1")?;
        }
        if let Some(value) = self.metacentric_height {
            positive("metacentric-height", value, "m")?;
        }
        if let Some(value) = self.roll_period {
            positive("roll-period", value, "s")?;
        }
        within("roll-damping", self.roll_damping, 0.0, 2.0, "a fraction of the critical damping from 0 to 2")?;
        positive("scale", self.scale, "full-scale length over model length")?;
        if !(1..=100_000).contains(&self.components) {
            return Err(Failure(format!("--components {}: expected a whole number from 1 to 100000", self.components)));
        }
        positive("duration", self.duration, "s")?;
        positive("step", self.step, "s")?;
        if self.step > self.duration {
            return Err(Failure(format!("--step {}: expected a step no longer than the duration of {} s", self.step, self.duration)));
        }
        if self.duration / self.step > MAX_ROWS {
            return Err(Failure(format!("--step {}: expected at most {MAX_ROWS} steps in the duration of {} s", self.step, self.duration)));
        }
        within("ramp", self.ramp, 0.0, f64::MAX, "a time in seconds, zero or more")?;
        within("origin-x", self.origin_x, f64::MIN, f64::MAX, "a finite number of metres")?;
        within("origin-y", self.origin_y, f64::MIN, f64::MAX, "a finite number of metres")?;
        within("origin-z", self.origin_z, f64::MIN, f64::MAX, "a finite number of metres")
    }

    /// The hull these options describe, with defaults filled in.
    pub fn hull(&self) -> Hull {
        let plain = Hull::from_dimensions(self.length, self.beam, self.draught, self.block_coefficient);
        let metacentric_height = self.metacentric_height.unwrap_or(plain.metacentric_height);
        Hull {
            waterplane_coefficient: self.waterplane_coefficient.unwrap_or(plain.waterplane_coefficient),
            metacentric_height,
            roll_period: self.roll_period.unwrap_or_else(|| natural_roll_period(self.beam, metacentric_height)),
            roll_damping: self.roll_damping,
            ..plain
        }
    }

    /// The motion as a function of time, for callers that sample it themselves.
    ///
    /// # Errors
    /// As [`Options::check`].
    pub fn motion(&self) -> Result<ShipMotion, Failure> {
        self.check()?;
        let sea = SeaState { significant_height: self.hs, peak_period: self.tp, gamma: self.gamma };
        let waves = sea.components(self.components, self.seed);
        let course = Course::new(self.heading, self.speed);
        let origin = [self.origin_x, self.origin_y, self.origin_z];
        Ok(ShipMotion::new(&self.hull(), &course, &waves, self.scale, self.ramp, origin))
    }
}

/// A sampled motion: `states[i]` at `times[i] = i · step`.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Times, s.
    pub times: Vec<f64>,
    /// Pose, velocity and acceleration at these times.
    pub states: Vec<State>,
}

impl Motion {
    /// The 18 values of row `i` in the order of [`HEADER`] after `time`.
    pub fn row(&self, i: usize) -> [f64; 18] {
        let mut row = [0.0; 18];
        row[..6].copy_from_slice(&self.states[i].pose);
        row[6..12].copy_from_slice(&self.states[i].velocity);
        row[12..].copy_from_slice(&self.states[i].acceleration);
        row
    }

    /// The motion as CSV under [`HEADER`]; every number is written so that it reads back to the same bits.
    pub fn to_csv(&self) -> String {
        let mut text = HEADER.join(",");
        text.push('\n');
        for (i, time) in self.times.iter().enumerate() {
            // Writing to a String cannot fail. `{:?}` is the shortest text that reads back exactly, with an exponent where that is shorter.
            let _ = write!(text, "{time:?}");
            for value in self.row(i) {
                let _ = write!(text, ",{value:?}");
            }
            text.push('\n');
        }
        text
    }

    /// Standard deviation of each of the six motions over the record (about their means).
    pub fn deviations(&self) -> [f64; 6] {
        let n = self.states.len() as f64;
        std::array::from_fn(|mode| {
            let mean = self.states.iter().map(|s| s.pose[mode]).sum::<f64>() / n;
            (self.states.iter().map(|s| (s.pose[mode] - mean).powi(2)).sum::<f64>() / n).sqrt()
        })
    }
}

/// The motion that `options` describe, sampled at i · step from 0 up to and including the duration (to rounding).
///
/// The same options and seed give the same motion; another step samples the same motion. (Across platforms the last bit may differ
/// with the mathematics library's sine and exponential.)
///
/// # Errors
/// As [`Options::check`].
pub fn generate(options: &Options) -> Result<Motion, Failure> {
    let motion = options.motion()?;
    let steps = (options.duration / options.step * (1.0 + 1e-12)).floor() as usize;
    let times: Vec<f64> = (0..=steps).map(|i| i as f64 * options.step).collect();
    let states = times.iter().map(|&t| motion.state(t)).collect();
    Ok(Motion { times, states })
}

/// Runs the command.
///
/// # Errors
/// A bad option, or a file that cannot be written.
pub fn run(args: &Args) -> Result<(), Failure> {
    let motion = generate(&args.options)?;
    write_whole(&args.out, &motion.to_csv())?;
    let [x, y, z, roll, pitch, yaw] = motion.deviations();
    println!("standard deviations: surge {x:.4} m, sway {y:.4} m, heave {z:.4} m");
    println!("                     roll {:.3}°, pitch {:.3}°, yaw {:.3}°", roll.to_degrees(), pitch.to_degrees(), yaw.to_degrees());
    println!("{} rows to {} s", motion.times.len(), motion.times.last().copied().unwrap_or_default());
    println!("{}", args.out.display());
    Ok(())
}

/// Writes `text` to a temporary file beside `path` and renames it, so that `path` is never half-written.
fn write_whole(path: &Path, text: &str) -> Result<(), Failure> {
    let failed = |error: std::io::Error| Failure(format!("{}: cannot be written: {error}", path.display()));
    let Some(name) = path.file_name() else {
        return Err(Failure(format!("{}: expected the name of a file to write", path.display())));
    };
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder).map_err(failed)?;
    let temporary = folder.join(format!(".{}.{}.partial", name.to_string_lossy(), std::process::id()));
    let outcome = std::fs::write(&temporary, text).and_then(|()| std::fs::rename(&temporary, path));
    if outcome.is_err() {
        // The first error is the one to report.
        let _ = std::fs::remove_file(&temporary);
    }
    outcome.map_err(failed)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn short() -> Options {
        Options { duration: 12.0, step: 0.25, heading: 140.0, speed: 3.0, ..Options::default() }
    }

    #[test]
    fn exact_seed_reproduces_and_another_seed_differs() {
        assert_eq!(generate(&short()).unwrap(), generate(&short()).unwrap());
        assert_ne!(generate(&short()).unwrap(), generate(&Options { seed: 2, ..short() }).unwrap());
    }

    #[test]
    fn exact_another_step_samples_the_same_motion() {
        let (coarse, fine) = (generate(&short()).unwrap(), generate(&Options { step: 0.125, ..short() }).unwrap());
        assert_eq!(fine.times.len(), 97);
        for (i, state) in coarse.states.iter().enumerate() {
            assert_eq!(coarse.times[i], fine.times[2 * i]);
            assert_eq!(*state, fine.states[2 * i]);
        }
    }

    #[test]
    fn exact_rows_reach_the_duration() {
        let motion = generate(&Options { duration: 60.0, step: 0.01, ..Options::default() }).unwrap();
        assert_eq!(motion.times.len(), 6001);
        assert!(motion.times.iter().enumerate().all(|(i, &t)| t == i as f64 * 0.01));
        let short = generate(&Options { duration: 1.0, step: 0.3, ..Options::default() }).unwrap();
        assert_eq!(short.times.len(), 4);
    }

    #[test]
    fn exact_csv_reads_back_bit_for_bit() {
        let motion = generate(&short()).unwrap();
        let text = motion.to_csv();
        let mut lines = text.lines();
        assert_eq!(
            lines.next().unwrap(),
            "time,ship.x,ship.y,ship.z,ship.roll,ship.pitch,ship.yaw,ship.vx,ship.vy,ship.vz,ship.roll_rate,ship.pitch_rate,\
             ship.yaw_rate,ship.ax,ship.ay,ship.az,ship.roll_acceleration,ship.pitch_acceleration,ship.yaw_acceleration"
        );
        for (i, line) in lines.enumerate() {
            let values: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
            assert_eq!(values[0], motion.times[i]);
            assert_eq!(values[1..], motion.row(i));
        }
    }

    #[test]
    fn exact_origin_shifts_the_position_only() {
        let plain = generate(&short()).unwrap();
        let moved = generate(&Options { origin_x: 2.0, origin_z: -1.0, ..short() }).unwrap();
        assert_eq!(moved.states[0].pose, [2.0, 0.0, -1.0, 0.0, 0.0, 0.0]);
        for (a, b) in plain.states.iter().zip(&moved.states) {
            assert!((a.pose[0] + 2.0 - b.pose[0]).abs() < 1e-15 && a.velocity == b.velocity && a.acceleration == b.acceleration);
        }
    }

    #[test]
    fn exact_calm_sea_is_still() {
        let motion = generate(&Options { hs: 0.0, ..short() }).unwrap();
        assert!(motion.states.iter().all(|s| s.pose.iter().chain(&s.velocity).chain(&s.acceleration).all(|v| *v == 0.0)));
    }

    #[test]
    fn exact_bad_values_name_option_value_and_expectation() {
        let cases: [(Options, &str, &str); 9] = [
            (Options { hs: -1.0, ..short() }, "--hs -1", "zero or more"),
            (Options { tp: 0.0, ..short() }, "--tp 0", "greater than zero"),
            (Options { gamma: f64::NAN, ..short() }, "--gamma NaN", "from 1"),
            (Options { heading: 1e3, ..short() }, "--heading 1000", "degrees"),
            (Options { block_coefficient: 1.2, ..short() }, "--block-coefficient 1.2", "0.2 to 1"),
            (Options { components: 0, ..short() }, "--components 0", "1 to 100000"),
            (Options { step: 13.0, ..short() }, "--step 13", "duration of 12 s"),
            (Options { step: 1e-9, ..short() }, "--step 0.000000001", "at most"),
            (Options { scale: f64::INFINITY, ..short() }, "--scale inf", "greater than zero"),
        ];
        for (options, option, expected) in cases {
            let Failure(message) = generate(&options).unwrap_err();
            assert!(message.contains(option) && message.contains(expected), "{message}");
        }
    }

    #[test]
    fn exact_file_is_whole_or_untouched() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("new").join("motion.csv");
        write_whole(&file, "one").unwrap();
        write_whole(&file, "two").unwrap();
        assert_eq!(std::fs::read_to_string(&file).unwrap(), "two");
        // A folder cannot be overwritten, and no temporary file stays behind.
        let Failure(message) = write_whole(&folder.path().join("new"), "three").unwrap_err();
        assert!(message.contains("cannot be written"), "{message}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
