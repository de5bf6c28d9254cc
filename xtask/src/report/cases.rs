//! The scenes of `cargo xtask bench`, how they are driven, and what is true of them.

use super::bench::{Bench, Drive, record};
use super::numerics::table;
use super::scene::{G, HEAVED, HEAVY_WIRE, NYLON, Row as ShapeRow, SHEAR_FLOW, Scene, Wire, heave};
use super::track::Track;
use crate::demo;
use crate::error::{Failure, Result};
use crate::ship_motion::{HEADER, Options, generate};

/// What is compared beside the tension.
#[derive(Clone, Copy, Debug)]
pub enum Place {
    /// Two outputs, a point's x and z, m.
    Point([&'static str; 2]),
    /// The direction, rad below the horizontal, from one point's x and z to another's.
    Chord([&'static str; 4]),
}

/// Where a scene's truth comes from.
pub enum Truth {
    /// A converged run of another program: its file, and how tension and place stand in a row whose first number is the time.
    Reference(&'static str, fn(&[f64]) -> (f64, [f64; 2])),
    /// Ours with Rodas4 at this tolerance, on the case's mesh: what is left is the error in time.
    SameMesh(f64),
    /// Ours with Rodas4 at this tolerance on another mesh: the mesh's error is in the figure too.
    Finer(Box<Scene>, f64),
}

/// A scene and how it is driven.
pub struct Case {
    /// For `--only` and files.
    pub name: &'static str,
    /// The heading.
    pub what: &'static str,
    /// As it is packed, but for method and tolerance.
    pub scene: Scene,
    /// Numbers of elements that it is run with; its own mesh where there are none.
    pub meshes: &'static [usize],
    /// The output that is compared, N.
    pub tension: &'static str,
    /// What else is compared.
    pub place: Place,
    /// Communication step, s.
    pub step: f64,
    /// s.
    pub end: f64,
    /// The comparison starts here, s: later than 0 where the start is a shock that no program on this page resolves.
    pub from: f64,
    /// Names of the inputs.
    pub inputs: &'static [&'static str],
    /// Their values over time.
    pub at: Box<dyn Fn(f64) -> Vec<f64> + Sync>,
    /// What is true.
    pub truth: Truth,
}

/// What a run of a case gave.
pub struct Ran {
    /// At every communication point.
    pub track: Track,
    /// CPU seconds of the communication loop.
    pub seconds: f64,
    /// The solver's sub-steps.
    pub sub_steps: f64,
}

impl Case {
    /// The scene on every mesh that it is run with.
    pub fn scenes(&self) -> Vec<Scene> {
        if self.meshes.is_empty() {
            vec![self.scene.clone()]
        } else {
            self.meshes.iter().map(|n| self.scene.clone().elements(*n)).collect()
        }
    }

    /// Runs the case's scene, or another one in its place.
    ///
    /// # Errors
    /// The FMU's own reasons.
    pub fn run(&self, bench: &Bench, scene: &Scene, method: &str, tolerance: f64, repeats: usize, long: f64) -> Result<Ran> {
        let fmu = bench.pack(&scene.clone().with("solver.method", method).with("solver.tolerance", tolerance))?;
        let drive = Drive { inputs: self.inputs, at: &*self.at, ..Drive::still(self.step, self.end) };
        let names: [&str; 5] = match self.place {
            Place::Point([x, z]) => [self.tension, x, z, x, z],
            Place::Chord([x0, z0, x1, z1]) => [self.tension, x0, z0, x1, z1],
        };
        let mut best: Option<Ran> = None;
        for _ in 0..repeats.max(1) {
            let run = record(&fmu, &drive, names)?;
            let (seconds, sub_steps) = (run.seconds, run.sub_steps);
            if best.as_ref().is_none_or(|b| seconds < b.seconds) {
                let [tension, a, b, c, d] = run.columns;
                let place = match self.place {
                    Place::Point(_) => a.into_iter().zip(b).map(|(x, z)| [x, z]).collect(),
                    Place::Chord(_) => (0..a.len()).map(|i| [(b[i] - d[i]).atan2(c[i] - a[i]), 0.0]).collect(),
                };
                best = Some(Ran { track: Track { times: run.times, tension, place }, seconds, sub_steps });
            }
            if seconds > long {
                break;
            }
        }
        best.ok_or_else(|| Failure("no run".into()))
    }

    /// The truth.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn truth(&self, bench: &Bench) -> Result<Track> {
        match &self.truth {
            Truth::Reference(text, read) => {
                let mut track = Track::default();
                // Those of the reference's samples that are communication points.
                let is_sample = |row: &Vec<f64>| ((row[0] / self.step).round() * self.step - row[0]).abs() < 1e-6;
                for row in table(text).into_iter().filter(is_sample) {
                    let (tension, place) = read(&row);
                    track.times.push(row[0]);
                    track.tension.push(tension);
                    track.place.push(place);
                }
                Ok(track)
            }
            Truth::SameMesh(tolerance) => Ok(self.run(bench, &self.scene, "rodas4", *tolerance, 1, 0.0)?.track),
            Truth::Finer(scene, tolerance) => Ok(self.run(bench, scene, "rodas4", *tolerance, 1, 0.0)?.track),
        }
    }

    /// The truth in words.
    pub fn truth_in_words(&self) -> String {
        let later = if self.from > 0.0 { format!(" Compared from {} s on.", self.from) } else { String::new() };
        let what = match &self.truth {
            Truth::Reference(..) => {
                "Truth: a converged run of another program (fmu-tests/references), so the mesh's error is in the figure.".to_owned()
            }
            Truth::SameMesh(tolerance) => format!("Truth: rodas4 on the same mesh at {tolerance:.0e}, so the figure is the error in time."),
            Truth::Finer(scene, tolerance) => {
                format!("Truth: rodas4 with {} elements at {tolerance:.0e}, so the mesh's error is in the figure.", scene.element_count())
            }
        };
        what + &later
    }
}

/// Without inputs.
fn still() -> Box<dyn Fn(f64) -> Vec<f64> + Sync> {
    Box::new(|_| Vec::new())
}

const BODY: Place = Place::Point(["body.x", "body.z"]);

/// All of them.
///
/// # Errors
/// None that the scenes written here could have.
pub fn cases() -> Result<Vec<Case>> {
    let mut cases = vec![string()?, heaved_wire()?, snapping_wire()?, towed_sphere()?];
    cases.extend([flume()?, pendulum()?]);
    cases.push(overboard("overboard", "overboard in the seaway of its page, the winch held, steps of 100 ms", 0.1)?);
    cases.push(overboard("overboard-20ms", "overboard in steps of 20 ms", 0.02)?);
    Ok(cases)
}

fn string() -> Result<Case> {
    let wire = Wire { laws: "compression = \"linear\"\ndamping.axial = 0.02", ..NYLON };
    let dropped = "[anchor]\nposition = [0, 0, 0]\n[body]\nmass = 1.33e-3\n[initial]\nstate = \"straight\"\ndirection = [1, 0, 0]\n";
    Ok(Case {
        name: "p3",
        what: "P3, a string let go level",
        scene: wire.scene(G, 40, 0, dropped)?,
        meshes: &[24, 28, 40],
        tension: "anchor.tension",
        place: BODY,
        step: 0.01,
        end: 1.15,
        from: 0.0,
        inputs: &[],
        at: still(),
        truth: Truth::Reference(include_str!("../../../fmu-tests/references/p3.csv"), |row| (row[3], [row[1], row[2]])),
    })
}

const HEAVES: &[&str] = &["ship.z", "ship.vz", "ship.az"];

fn heaved_wire() -> Result<Case> {
    // As the reference starts: stretched uniformly, not by its weight.
    let end = 200.11772;
    let stretched: Vec<ShapeRow> = [0.0, 200.0].map(|s| (s, [0.0, 0.0, -s * end / 200.0], [0.0, 0.0, -end / 200.0], [0.0; 3])).into();
    Ok(Case {
        name: "p4a",
        what: "P4a, 200 m of wire heaved without slack",
        scene: HEAVY_WIRE.scene(G, 5, 0, HEAVED)?.start_shape(&stretched),
        meshes: &[2, 5],
        tension: "anchor.tension",
        place: BODY,
        step: 0.05,
        end: 60.0,
        from: 1.0,
        inputs: HEAVES,
        at: Box::new(|t| heave(t, 2.5, 6.0)),
        truth: Truth::Reference(include_str!("../../../fmu-tests/references/p4a.csv"), |row| (row[2], [0.0, row[1]])),
    })
}

fn snapping_wire() -> Result<Case> {
    let scene = |elements| HEAVY_WIRE.scene(G, elements, 0, HEAVED);
    Ok(Case {
        name: "p4b",
        what: "P4b, the same with slack and snaps",
        scene: scene(20)?,
        meshes: &[10, 20],
        tension: "anchor.tension",
        place: BODY,
        step: 0.02,
        end: 24.0,
        from: 0.0,
        inputs: HEAVES,
        at: Box::new(|t| heave(t, 5.0, 4.0)),
        truth: Truth::Finer(Box::new(scene(80)?), 1e-5),
    })
}

fn towed_sphere() -> Result<Case> {
    // MoorDyn cannot start from rest in the current, so all start straight towards the place where the sphere would rest.
    let rest = format!(
        "{SHEAR_FLOW}[ship]\ninput = \"pose_velocity_acceleration\"\n[initial]\nstate = \"straight\"\ndirection = [0.7097202495, 0, -0.6868668200]\n"
    );
    let wire = Wire { length: 1.01, ei: 0.0, laws: "damping.axial = 0.002", ..NYLON };
    let scene = |elements| wire.scene(G, elements, 0, &rest);
    Ok(Case {
        name: "p5",
        what: "P5, a sphere towed in a shear flow, heaved by 1 cm every second",
        scene: scene(40)?,
        meshes: &[16, 20, 40],
        tension: "anchor.tension",
        place: BODY,
        step: 0.01,
        end: 10.0,
        from: 1.0,
        inputs: HEAVES,
        at: Box::new(|t| heave(t, 0.01, 1.0)),
        truth: Truth::Finer(Box::new(scene(101)?), 1e-5),
    })
}

fn built_in(name: &str) -> Result<Scene> {
    Scene::built_in(name)?.ok_or_else(|| Failure(format!("there is no built-in scene {name}")))
}

fn flume() -> Result<Case> {
    let (inputs, at) = demo::sea_inputs()?;
    Ok(Case {
        name: "flume",
        what: "flume in the demo's seaway, the winch held, 24 elements",
        scene: built_in("flume")?,
        meshes: &[],
        tension: "winch.tension",
        place: BODY,
        step: 0.01,
        end: 20.0,
        from: 0.0,
        inputs,
        at,
        truth: Truth::SameMesh(1e-5),
    })
}

fn overboard(name: &'static str, what: &'static str, step: f64) -> Result<Case> {
    let end = 20.0;
    let motion = generate(&Options { step, ..super::pace::sea(end) })?;
    Ok(Case {
        name,
        what,
        scene: built_in("overboard")?,
        meshes: &[],
        tension: "winch.tension",
        place: BODY,
        step,
        end,
        from: 0.0,
        inputs: &HEADER[1..],
        at: Box::new(move |t| motion.row((t / step).round() as usize).to_vec()),
        truth: Truth::SameMesh(1e-5),
    })
}

fn pendulum() -> Result<Case> {
    // The pendulum needs its contact followed: its tolerance comes with it.
    let (rope, rest, rows) = super::wire::pulley_pendulum();
    Ok(Case {
        name: "p1",
        what: "P1, a pendulum over a pulley",
        scene: rope.scene(G, 40, 3, &rest)?.start_shape(&rows),
        meshes: &[20, 32, 40],
        tension: "load.tension",
        place: Place::Chord(["cable.point[2].x", "cable.point[2].z", "cable.point[3].x", "cable.point[3].z"]),
        step: 0.002,
        end: 1.0,
        from: 0.0,
        inputs: &[],
        at: still(),
        truth: Truth::Reference(include_str!("../../../fmu-tests/references/p1.csv"), |row| (row[2], [row[1].to_radians(), 0.0])),
    })
}
