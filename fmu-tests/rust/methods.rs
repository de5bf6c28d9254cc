//! The time integrators against each other: one physics, five ways through time.

mod bench;

use bench::{HEAVY_WIRE, NYLON, Wire, channel, heaving, relative_rms, run, started};
use fairlead::scene::{Method, Scene};
use fairlead::sim::{Inputs, Simulation};

const METHODS: [Method; 5] = [Method::Rodas4, Method::TrBdf2, Method::Esdirk3, Method::Esdirk4, Method::Radau5];

/// Tension at the first end every `h`, and the finished run.
fn tensions(scene: &Scene, h: f64, end: f64, inputs: impl Fn(f64) -> Inputs) -> (Vec<f64>, Simulation) {
    let mut sim = started(scene, &inputs(0.0));
    let mut out = vec![];
    run(&mut sim, h, end, inputs, |_, o| out.push(o.anchor.tension.max(o.winch.tension)));
    (out, sim)
}

/// A scene with communication step, end and inputs.
struct Case {
    name: &'static str,
    scene: Scene,
    h: f64,
    end: f64,
    inputs: Box<dyn Fn(f64) -> Inputs>,
}

fn cases() -> [Case; 5] {
    let string = Wire { laws: "compression = \"linear\"\ndamping.axial = 0.02", ..NYLON };
    let p3 = "[anchor]\nposition = [0, 0, 0]\n[body]\nmass = 1.33e-3\n[initial]\nstate = \"straight\"\ndirection = [1, 0, 0]\n";
    let p4 = "[anchor]\nposition = [0, 0, 0]\n[body]\nmass = 500\n[ship]\ninput = \"pose_velocity_acceleration\"\n";
    let cord =
        Wire { length: 2.0, diameter: 0.01, mass_per_length: 0.3, ea: 2e4, ei: 0.01, laws: "damping.axial = 2.0\ndamping.bending = 1e-3" };
    let reeled = "[ship]\ninput = \"pose_velocity_acceleration\"\n[winch]\nposition = [0.3, 0, 0.4]\naxis = [0, 1, 0]\nradius = 0.15\nangle = 1.2\n\
                  gain_position = 200\ngain_rate = 20\nstiffness = 1e6\ndamping = 0.1\n[fluid]\ndensity = 1000\nviscosity = 1e-3\nwaterline = -0.5\n\
                  current.profile = [[0, 0.2, 0.1], [-2, 0.1, 0]]\ndrag = { law = \"loading_functions\", cd = \"cylinder\" }\n\
                  [body]\nmass = 0.5\nvolume = 1e-4\ndrag_area = 3e-3\ndrag_coefficient = \"sphere\"\n";
    let turning = "[anchor]\nposition = [-0.3, 0, 0.1]\n[[sheave]]\nposition = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 0.1\nstiffness = 1e7\n\
                   groove_angle = 0.8\nfriction = 0.3\ninertia = 1e-3\nbearing_friction = 0.01\n[ship]\ninput = \"pose_velocity_acceleration\"\n\
                   [body]\nmass = 2\n";
    let winch = |t: f64| {
        let (s, c) = (1.3 * t).sin_cos();
        let mut inputs = heaving(0.05, 1.5)(t);
        inputs.winch = channel([1.2 + 0.5 * s, 0.65 * c, -0.845 * s]);
        inputs
    };
    [
        Case { name: "P3", scene: string.scene(10, p3), h: 0.01, end: 0.6, inputs: Box::new(|_| Inputs::default()) },
        Case { name: "P4a", scene: HEAVY_WIRE.scene(5, p4), h: 0.1, end: 12.0, inputs: Box::new(heaving(2.5, 6.0)) },
        Case { name: "P4b", scene: HEAVY_WIRE.scene(5, p4), h: 0.02, end: 10.0, inputs: Box::new(heaving(5.0, 4.0)) },
        Case { name: "over a turning sheave", scene: cord.scene(24, turning), h: 0.002, end: 0.6, inputs: Box::new(heaving(0.05, 1.0)) },
        Case { name: "reeled in water", scene: cord.scene(12, reeled), h: 0.01, end: 2.0, inputs: Box::new(winch) },
    ]
}

#[test]
fn cross_methods_come_to_one_solution() {
    for Case { name, scene, h, end, inputs } in cases() {
        let at = |method: Method, tolerance: f64| {
            let mut scene = scene.clone();
            (scene.solver.method, scene.solver.tolerance) = (method, tolerance);
            tensions(&scene, h, end, &inputs)
        };
        let (truth, _) = at(Method::Rodas4, 1e-6);
        for method in METHODS {
            let errors = [1e-2, 1e-3, 1e-4].map(|tolerance| {
                let (t, sim) = at(method, tolerance);
                let error = relative_rms(&t.into_iter().zip(truth.iter().copied()).collect::<Vec<_>>());
                let solver = sim.outputs().solver.clone();
                let [solves, tangents, factorizations] = sim.effort();
                println!(
                    "{name}, {method:?} at {tolerance:.0e}: tension {error:.1e} off, {} sub-steps, {} rejected, {solves} solves, {tangents} \
                     tangents, {factorizations} factorizations, energy {:.1e}",
                    solver.steps, solver.rejected, solver.energy_error
                );
                error / tolerance
            });
            // The tolerance is a target, not a bound (convergence.rs): thrice is allowed. A wrong tableau, tangent or start of the stages shows
            // as an error that does not fall.
            assert!(errors.iter().all(|e| *e < 3.0), "{name}, {method:?}: {errors:.2?} times asked for");
        }
    }
}
