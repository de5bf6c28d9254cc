//! Derivatives of the outputs, by time and by the inputs of a step, against differences of runs.

mod bench;

use bench::{Wire, channel, started};
use fairlead::outputs::Outputs;
use fairlead::scene::file::SceneFile;
use fairlead::scene::{Method, Scene};
use fairlead::sim::{Channel, Inputs, Simulation};
use model_description::scenes::SCENES;

type Get = fn(&Outputs) -> f64;
/// Outputs of one physical dimension, whose errors are measured by the greatest of them.
type Group = (&'static str, &'static [Get]);

/// What a scene does not have is zero, and so are its derivatives.
const GROUPS: [Group; 5] = [
    (
        "forces",
        &[
            |o| o.winch.tension,
            |o| o.winch.force.x,
            |o| o.anchor.tension,
            |o| o.anchor.force.x,
            |o| o.sheaves.first().map_or(0.0, |s| s.tension_in),
            |o| o.sheaves.first().map_or(0.0, |s| s.tension_out),
            |o| o.sheaves.first().map_or(0.0, |s| s.normal_force),
            |o| o.cable.tension_max,
            |o| o.ship.force.x,
            |o| o.ship.force_world.z,
            |o| o.body.tension,
            |o| o.load.tension,
            |o| o.far_end.tension,
        ],
    ),
    ("moments", &[|o| o.ship.moment.y, |o| o.ship.moment.z]),
    ("positions", &[|o| o.body.position.x, |o| o.body.position.z, |o| o.load.position.x, |o| o.cable.points[1].z, |o| o.winch.payout]),
    ("velocities", &[|o| o.body.velocity.x, |o| o.body.velocity.z, |o| o.load.velocity.x, |o| o.load.velocity.z]),
    ("angles", &[|o| o.winch.angle, |o| o.winch.rate, |o| o.sheaves.first().map_or(0.0, |s| s.rate)]),
];

/// A scene with what drives it.
struct Case {
    name: &'static str,
    scene: Scene,
    /// Part of the ship's motion of [`Case::inputs`], and radians per second of the winch.
    ship: f64,
    winch: f64,
    /// Change of an input over which runs are differenced: small beside what makes drag and contact nonlinear, large beside the tolerance.
    change: f64,
    /// The same of a force on the body, N.
    force: f64,
}

fn checked(name: &'static str, text: &str, tolerance: f64) -> Scene {
    let mut scene = SceneFile::parse(text, name).and_then(|f| f.check(None)).expect("good");
    scene.solver.tolerance = tolerance;
    // Differences want small errors; a method of order 4 gets there in fewer steps.
    scene.solver.method = Method::Rodas4;
    scene
}

fn built_in(name: &str) -> &'static str {
    SCENES.iter().find(|s| s.name == name).expect("a built-in scene").text
}

/// Between them: winch and anchor, all three far ends, a sheave with a groove, one that turns with the rope, water and none.
fn cases() -> [Case; 4] {
    let turning = built_in("moving_pulley").replace("[[sheave]]\n", "[[sheave]]\ninertia = 1e-4\nfriction = 0.3\n");
    let wire = Wire { length: 30.0, diameter: 0.02, mass_per_length: 1.0, ea: 1e6, ei: 5.0, laws: "damping.axial = 2e3" };
    let water = "[fluid]\ndensity = 1025\nwaterline = -2\ndrag = { law = \"cross_flow\", cd_normal = 1, cd_tangential = 0.01 }\n";
    let mut moored = wire.scene(
        30,
        &format!(
            "{water}[ship]\ninput = \"pose_velocity_acceleration\"\n[anchor]\nposition = [1, 2, 3]\n[far_end]\nposition = [26, 3, -9]\n[outputs]\npoints = 3"
        ),
    );
    moored.solver.tolerance = 1e-7;
    [
        Case {
            name: "overboard",
            scene: checked("overboard", built_in("overboard"), 1e-5),
            ship: 1.0,
            winch: 0.1,
            change: 1e-4,
            force: 1.0,
        },
        Case { name: "flume", scene: checked("flume", built_in("flume"), 1e-7), ship: 0.02, winch: 0.15, change: 1e-6, force: 1e-4 },
        Case { name: "turning", scene: checked("turning", &turning, 1e-6), ship: 0.1, winch: 0.0, change: 1e-6, force: 1e-3 },
        Case { name: "moored", scene: moored, ship: 1.0, winch: 0.0, change: 1e-5, force: 1.0 },
    ]
}

impl Case {
    /// A ship in a seaway, a winch that goes to and fro, a current that grows.
    fn inputs(&self, t: f64) -> Inputs {
        let wave = |amplitude: f64, w: f64, phase: f64| {
            let (sin, cos) = (w * t + phase).sin_cos();
            channel([sin, w * cos, -w * w * sin].map(|x| amplitude * x))
        };
        let s = self.ship;
        let mut winch = wave(self.winch / 3.0, 3.0, 0.0);
        if let Some(scene) = self.scene.winch.as_ref().filter(|w| !w.payout_command) {
            winch.value += scene.angle;
        }
        Inputs {
            ship: [[0.15, 0.73, 0.3], [0.09, 0.88, 1.1], [0.22, 0.75, 2.2], [0.013, 0.7, 0.7], [0.017, 0.73, 5.1], [0.007, 0.8, 3.9]]
                .map(|[a, w, p]| wave(s * a, w, p)),
            winch,
            current: [Channel { value: 0.1 * s, first: Some(0.02 * s), second: None }; 2],
            ..Inputs::default()
        }
    }

    /// What is not smooth enough for differences: forces where a rope sticks and slips by turns on a sheave (friction fades below 1 mm/s), and
    /// the stiff drum's lateral reaction, which has the ship's length for a lever.
    fn rough(&self, group: &str) -> bool {
        match self.name {
            "turning" => group != "positions" && group != "velocities",
            "overboard" => group == "moments",
            _ => false,
        }
    }

    /// A run to `steps` communication steps of `h`.
    fn sailed(&self, h: f64, steps: usize) -> Simulation {
        let mut sim = started(&self.scene, &self.inputs(0.0));
        for i in 0..steps {
            self.step(&mut sim, h, i);
        }
        sim
    }

    fn step(&self, sim: &mut Simulation, h: f64, i: usize) {
        sim.step_to(h * (i + 1) as f64, &self.inputs(h * i as f64)).expect("a step");
    }
}

/// The greatest error within a group over what is tolerable there: a `share` of the greatest derivative, and what four times the solver's tolerance leaves
/// of differences over `width`.
fn error(case: &Case, share: f64, group: &Group, outputs: &Outputs, width: f64, pairs: impl Fn(Get) -> [f64; 2]) -> f64 {
    let greatest = |of: &dyn Fn(&Get) -> f64| group.1.iter().map(of).fold(0.0, f64::max);
    let value = greatest(&|get| get(outputs).abs());
    let size = greatest(&|get| pairs(*get)[1].abs());
    let tolerable = share * size + 4.0 * case.scene.solver.tolerance * value / width;
    greatest(&|get| (pairs(*get)[0] - pairs(*get)[1]).abs()) / tolerable.max(1e-9)
}

/// The rates at a communication point against five-point differences of the outputs around it, from steps of 1 ms.
#[test]
fn exact_rates_match_differences_of_a_fine_run() {
    let h = 1e-3;
    let steps = 300;
    for case in cases() {
        let mut sim = case.sailed(h, steps - 2);
        let (mut outputs, mut slope) = (vec![sim.outputs().clone()], None);
        for i in steps - 2..steps + 2 {
            case.step(&mut sim, h, i);
            outputs.push(sim.outputs().clone());
            if i + 1 == steps {
                slope = Some(sim.rates());
            }
        }
        let slope = slope.expect("the step was done");
        for group in GROUPS.iter().filter(|group| !case.rough(group.0)) {
            let pairs = |get: Get| {
                let o: Vec<f64> = outputs.iter().map(get).collect();
                [slope.of(get), (8.0 * (o[3] - o[1]) - (o[4] - o[0])) / (12.0 * h)]
            };
            // 5 %: differences over milliseconds smooth the waves that the rates contain.
            let e = error(&case, 0.05, group, sim.outputs(), h, pairs);
            println!("{}: rates of {} off by {e:.1e} of what is tolerable", case.name, group.0);
            assert!(e < 1.0, "{}: {} {:?}", case.name, group.0, group.1.iter().map(|get| pairs(*get)).collect::<Vec<_>>());
        }
    }
}

/// A change of one input (channel, derivative).
fn unit(channel: usize, order: usize) -> Inputs {
    let zero = Channel { value: 0.0, first: Some(0.0), second: Some(0.0) };
    let mut d = Inputs { ship: [zero; 6], winch: zero, current: [zero; 2], body_force: [zero; 3] };
    let channels = d.ship.iter_mut().chain([&mut d.winch]).chain(&mut d.current).chain(&mut d.body_force);
    if let Some(c) = channels.into_iter().nth(channel) {
        match order {
            0 => c.value = 1.0,
            1 => c.first = Some(1.0),
            _ => c.second = Some(1.0),
        }
    }
    d
}

/// `a` + `s` `d`, where `a` has a value.
fn moved(a: &Inputs, d: &Inputs, s: f64) -> Inputs {
    let add = |x: Option<f64>, d: Option<f64>| x.map(|x| x + s * d.unwrap_or(0.0));
    let one =
        |a: &Channel, d: &Channel| Channel { value: a.value + s * d.value, first: add(a.first, d.first), second: add(a.second, d.second) };
    Inputs {
        ship: std::array::from_fn(|c| one(&a.ship[c], &d.ship[c])),
        winch: one(&a.winch, &d.winch),
        current: std::array::from_fn(|c| one(&a.current[c], &d.current[c])),
        body_force: std::array::from_fn(|c| one(&a.body_force[c], &d.body_force[c])),
    }
}

/// The tangent of a step against the same step with an input a little more and a little less.
#[test]
fn exact_sensitivities_match_differences_of_the_step() {
    for case in cases() {
        for (h, steps) in [(0.01, 30), (0.05, 6)] {
            let before = case.sailed(h, steps);
            let inputs = case.inputs(before.time());
            let after = |inputs: &Inputs| {
                let mut sim = before.clone();
                sim.step_to(h * (steps + 1) as f64, inputs).expect("a step");
                sim
            };
            let sim = after(&inputs);
            for (channel, order) in [(0, 0), (2, 0), (2, 1), (2, 2), (4, 2), (5, 1), (6, 0), (6, 1), (7, 0), (9, 0), (11, 0)] {
                let direction = unit(channel, order);
                let slope = sim.sensitivity(&direction).expect("there was a step");
                let change = if channel < 9 { case.change * 10f64.powi(order as i32) } else { case.force };
                let [above, below] = [change, -change].map(|s| after(&moved(&inputs, &direction, s)));
                for group in GROUPS.iter().filter(|group| !case.rough(group.0)) {
                    let pairs = |get: Get| [slope.of(get), (get(above.outputs()) - get(below.outputs())) / (2.0 * change)];
                    // 1 %, as documented. 5 % for a jump of the pose, a wave front that few sub-steps carry and each method in its own way; and
                    // for yaw, which moves the wire sideways on the groove's steep flanks.
                    let share = if channel == 5 || channel < 6 && order == 0 { 0.05 } else { 0.01 };
                    let e = error(&case, share, group, sim.outputs(), 2.0 * change, pairs);
                    println!("{} h {h} input {channel} order {order}: {} off by {e:.1e} of what is tolerable", case.name, group.0);
                    assert!(
                        e < 1.0,
                        "{} h {h} input {channel} order {order}: {} {:?}",
                        case.name,
                        group.0,
                        group.1.iter().map(|get| pairs(*get)).collect::<Vec<_>>()
                    );
                }
            }
        }
    }
}
