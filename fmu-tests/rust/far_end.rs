//! A cable between its first end and one fixed in space: statics, waves, drift, starts, replays.

mod bench;

use bench::load::{Hung, THESIS, THREAD, down};
use bench::{ANCHOR, G, HEAVY_WIRE, Row, Wire, catenary, channel, frequencies, ruffled, run, shape_csv, started, still};
use fairlead::integrator::Problem;
use fairlead::scene::Scene;
use fairlead::sim::{Inputs, Simulation};
use fairlead::system::System;
use nalgebra::Vector3;
use std::f64::consts::PI;

#[test]
fn exact_kinetic_energy_and_its_rate_by_turning_agree() {
    // The ledger's kinetic energy ½ wᵀMw − w_N·(Mw)_N changes at constant w by what the tally calls turning. All under water, and at the surface.
    let wire = Wire { length: 20.0, diameter: 0.1, mass_per_length: 8.0, ..THREAD };
    for (level, bound) in [(50.0, 1e-8), (-6.0, 1e-6)] {
        let water = format!(
            "[fluid]\ndensity = 1025\nwaterline = {level:?}\ndrag = {{ law = \"cross_flow\", cd_normal = 1, cd_tangential = 0 }}\n"
        );
        let scene = wire.scene(3, &[ANCHOR, &water, "[far_end]\nposition = [9, 1, -9]\n"].concat());
        let mut system = System::new(&scene);
        let straight: Vec<f64> = system.arc.iter().flat_map(|s| [0.5 * s, 0.05 * s, -0.5 * s, 0.5, 0.05, -0.5]).collect();
        let (u, w) = (ruffled(&straight, 0.4, 0.1), ruffled(&vec![0.0; straight.len()], 0.9, 1.0));
        let mut f = vec![0.0; u.len()];
        let mut tally = |t: f64| {
            let u: Vec<f64> = u.iter().zip(&w).map(|(u, w)| u + t * w).collect();
            system.force(0.0, &u, &w, None, &mut f);
            system.tally
        };
        let h = 1e-5;
        let (by_difference, turning) = ((tally(h).kinetic - tally(-h).kinetic) / (2.0 * h), tally(0.0).turning);
        let error = by_difference / turning - 1.0;
        println!("waterline {level} m: d(kinetic)/dt {by_difference:.6} W, turning {turning:.6} W ({error:.1e})");
        // Differences: rounding 1e-16/1e-5 of the energy and h². At the surface the quadrature's pieces move as well.
        assert!(error.abs() < bound, "{error:e}");
    }
}

/// The force at the far end that brings it to `end`, by Newton's method with differences from a guess.
fn catenary_to(wire: &Wire, end: Vector3<f64>, mut f: Vector3<f64>) -> Vector3<f64> {
    for _ in 0..200 {
        let miss = catenary(wire, f).0 - end;
        let j = nalgebra::Matrix3::from_fn(|r, c| {
            let mut g = f;
            let d = 1e-6 * f.norm();
            g[c] += d;
            let mut l = f;
            l[c] -= d;
            (catenary(wire, g).0[r] - catenary(wire, l).0[r]) / (2.0 * d)
        });
        let step = j.lu().solve(&miss).expect("regular");
        let scale = (0.3 * f.norm() / step.norm()).min(1.0);
        f -= step * scale;
        if miss.norm() < 1e-13 * wire.length {
            break;
        }
    }
    assert!((catenary(wire, f).0 - end).norm() < 1e-12 * wire.length);
    f
}

#[test]
fn exact_elastic_catenary_between_two_ends() {
    let wire = Wire { length: 10.0, diameter: 0.01, mass_per_length: 1.0, ea: 2e4, ei: 0.0, laws: "" };
    let origin = Vector3::new(1.0, 2.0, 3.0);
    // Slack, slack and sloping, barely slack, pulled 1 % too long.
    let spans = [
        (Vector3::new(8.0, 0.0, 0.0), Vector3::new(40.0, 0.0, 60.0)),
        (Vector3::new(3.0, -4.0, -5.0), Vector3::new(20.0, -25.0, 20.0)),
        (Vector3::new(7.0, 7.0, 0.3), Vector3::new(200.0, 200.0, 50.0)),
        (Vector3::new(10.1, 0.0, 0.0), Vector3::new(200.0, 0.0, 50.0)),
    ];
    for (span, guess) in spans {
        let force = catenary_to(&wire, span, guess);
        let (_, first) = catenary(&wire, force);
        let mut errors = vec![];
        for elements in [16, 32] {
            let end = origin + span;
            let rest = format!(
                "[anchor]\nposition = [1, 2, 3]\n[far_end]\nposition = [{:?}, {:?}, {:?}]\n[outputs]\npoints = 2\n",
                end.x, end.y, end.z
            );
            let sim = started(&wire.scene(elements, &rest), &Inputs::default());
            let o = sim.outputs();
            assert!((o.cable.points[1] - end).norm() < 1e-14 * 10.0);
            let reaction = ((o.anchor.force - first).norm() + (o.far_end.force + force).norm()) / first.norm();
            let tension = (o.far_end.tension / force.norm() - 1.0).abs();
            assert!(tension < 1e-4, "{tension:e}"); // the slope's error squared
            println!(
                "catenary to ({:.1}, {:.1}, {:.1}) m, {elements} elements: reaction off by {reaction:.1e} of {:.3} N",
                span.x,
                span.y,
                span.z,
                first.norm()
            );
            errors.push(reaction);
        }
        assert!(errors[1] < 1e-6, "{errors:?}");
    }
}

#[test]
fn exact_forces_balance_on_a_drum_and_a_fixed_end() {
    let winch =
        "[winch]\nposition = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 0.5\nangle = 0.3\ngain_position = 1\ngain_rate = 1\nstiffness = 1e7\n";
    let wire = Wire { length: 30.0, diameter: 0.02, mass_per_length: 1.0, ea: 1e6, ei: 5.0, laws: "" };
    for end in [[-20.0, 3.0, -8.0], [-25.0, 0.0, 2.0], [-29.9, 0.0, -1.0]] {
        let sim = started(&wire.scene(60, &format!("{winch}[far_end]\nposition = {end:?}\n")), &Inputs::default());
        let o = sim.outputs();
        let rest = o.winch.force + o.far_end.force + Vector3::z() * wire.length * wire.mass_per_length * G;
        println!(
            "drum to {end:?}: tension {:.3} N at the drum, {:.3} N at the far end; unbalanced {:.1e} N",
            o.winch.tension,
            o.far_end.tension,
            rest.norm()
        );
        // The solver's 1e-10 of the weight at each of sixty nodes, or rounding of EA: 1e-7 N each.
        assert!(rest.norm() < 60.0 * 1e-7, "{rest}");
        assert!(o.winch.tension > o.far_end.tension || end[2] > 0.0);
    }
}

#[test]
fn exact_starts_between_close_ends() {
    // A bight straight below, with and without bending stiffness: both legs carry the weight.
    for ei in [0.0, 0.05] {
        let wire = Wire { length: 10.0, diameter: 0.01, mass_per_length: 1.0, ea: 2e5, ei, laws: "" };
        let rest = format!("{ANCHOR}[far_end]\nposition = [0.5, 0, 0]\n");
        let sim = started(&wire.scene(40, &rest), &Inputs::default());
        let f = sim.outputs().anchor.force;
        println!("bight of 10 m over 0.5 m, EI {ei}: anchor force ({:.4}, {:.4}, {:.4}) N", f.x, f.y, f.z);
        // Symmetry: half the weight each; EI = 0.05 N·m² does not break it. To the solver's 1e-10 of the weight per node, forty nodes.
        assert!((f.z + 0.5 * 10.0 * G).abs() < 1e-7, "{f}");
    }
}

#[test]
fn exact_frequencies_of_a_string_between_two_ends() {
    let wire = Wire { length: 2.0, diameter: 0.01, mass_per_length: 0.3, ea: 1e4, ei: 0.0, laws: "" };
    let scene = wire.scene_at(0.0, 24, &[ANCHOR, "[far_end]\nposition = [0, 0, -2.01]\n"].concat(), None);
    let mut system = System::new(&scene);
    let mut u = fairlead::equilibrium::lay_between(&system, 0.0, &-Vector3::z()).expect("in reach");
    fairlead::equilibrium::solve(&mut system, 0.0, &mut u, 50.0).expect("an equilibrium");
    let w = frequencies(&mut system, &u, 0, false);
    let (stretch, tension) = (2.01 / 2.0, wire.ea * 0.005);
    for n in 1..=4 {
        let exact = f64::from(n) * PI / wire.length * (tension / (stretch * wire.mass_per_length)).sqrt();
        let error = w[n as usize - 1] / exact - 1.0;
        println!("string between two ends, mode {n}: {:.6} rad/s, relative error {error:.1e}", w[n as usize - 1]);
        // As in `dynamics.rs`: cubic elements, phase π n/24 per element.
        assert!(error.abs() < 2.5e-5 * (f64::from(n) * PI / 24.0).powi(6) + 1e-10, "{error:e}");
    }
}

/// A ship that moves in all six ways, at several frequencies.
fn tossing(t: f64) -> Inputs {
    let mut inputs = Inputs { ship: [channel([0.0; 3]); 6], ..Inputs::default() };
    for (c, (size, period, phase)) in
        [(1.0, 11.0, 0.3), (0.7, 8.3, 1.0), (2.0, 7.1, 0.0), (0.15, 9.0, 2.0), (0.06, 6.3, 0.7), (0.1, 17.0, 4.0)].into_iter().enumerate()
    {
        let w = 2.0 * PI / period;
        let (s, c_) = (w * t + phase).sin_cos();
        inputs.ship[c] = channel([size * s, size * w * c_, -size * w * w * s]);
    }
    inputs
}

const WATER: &str = "[fluid]\ndensity = 1025\nwaterline = 0\ndrag = { law = \"cross_flow\", cd_normal = 1.2, cd_tangential = 0.02 }\n";
const SHIP: &str = "[ship]\ninput = \"pose_velocity_acceleration\"\n[outputs]\npoints = 2\n[anchor]\nposition = [20, 3, 5]\n";

#[test]
fn exact_fixed_end_does_not_drift() {
    // Slack in air; from above the water down to the bed; stretched.
    let cases = [
        ("slack in air", "", [150.0, 10.0, -60.0], 0.25),
        ("to the bed", WATER, [140.0, 10.0, -80.0], 0.1),
        ("taut in air", "", [218.0, 3.0, 5.0], 0.1),
    ];
    for (name, water, end, h) in cases {
        let rest = format!("{SHIP}{water}[far_end]\nposition = {end:?}\n");
        let wire = Wire { laws: "compression = \"none\"\ndamping = { model = \"kelvin_voigt\", axial = 4e4, bending = 1 }", ..HEAVY_WIRE };
        let scene = wire.scene(40, &rest);
        let mut sim = started(&scene, &tossing(0.0));
        let (mut drift, mut quick, mut most) = (0.0f64, 0.0f64, 0.0f64);
        let mut least = f64::INFINITY;
        run(&mut sim, h, 60.0, tossing, |_, o| {
            drift = drift.max((o.cable.points[1] - Vector3::from(end)).norm());
            quick = quick.max(o.body.velocity.norm());
            most = most.max(o.cable.tension_max);
            least = least.min(o.cable.tension_max);
        });
        let s = &sim.outputs().solver;
        println!(
            "fixed end, {name}: 60 s of ship motion move it by {drift:.1e} m, {quick:.1e} m/s; tension_max {least:.0} to {most:.0} N; \
             {} steps, {} rejected, energy error {:.1e}",
            s.steps, s.rejected, s.energy_error
        );
        // Set to the exact place after every sub-step: what remains is one rounding at 200 m.
        assert!(drift < 1e-12 && quick < 1e-12, "{drift:e} {quick:e}");
        assert!(s.energy_error < 2e-3, "{:e}", s.energy_error);
    }
}

/// A bar between a moving and a fixed end: u = A cos ωt sin k(L − s)/sin kL, k = ω √(m/EA), on top of a uniform pull.
/// (A sine would begin with a jerk that the FMU cannot know of before its second input.)
#[test]
fn exact_driven_bar_between_two_ends() {
    let wire = Wire { length: 10.0, diameter: 0.01, mass_per_length: 0.5, ea: 2e5, ei: 0.0, laws: "" };
    let (stretch, amplitude, frequency) = (5e-3, 0.01, 80.0);
    let k = frequency * (wire.mass_per_length / wire.ea).sqrt();
    let l = wire.length;
    let rows: Vec<Row> = (0..=200)
        .map(|i| {
            let s = l * f64::from(i) / 200.0;
            let (sin, cos) = (k * (l - s)).sin_cos();
            let (u, du) = (amplitude * sin / (k * l).sin(), -amplitude * k * cos / (k * l).sin());
            (s, [s * (1.0 + stretch) + u, 0.0, 0.0], [1.0 + stretch + du, 0.0, 0.0], [0.0; 3])
        })
        .collect();
    let rest = format!(
        "{ANCHOR}[far_end]\nposition = [{:?}, 0, 0]\n[ship]\ninput = \"pose_velocity_acceleration\"\n[initial]\nstate = \"shape\"\n\
         file = \"bar.csv\"\n[solver]\ntolerance = 1e-4\n",
        l * (1.0 + stretch)
    );
    let scene = wire.scene_at(0.0, 40, &rest, Some(&shape_csv(&rows)));
    let inputs = |t: f64| {
        let mut inputs = Inputs { ship: [channel([0.0; 3]); 6], ..Inputs::default() };
        let (s, c) = (frequency * t).sin_cos();
        inputs.ship[0] = channel([amplitude * c, -amplitude * frequency * s, -amplitude * frequency * frequency * c]);
        inputs
    };
    let mut sim = started(&scene, &inputs(0.0));
    let mut worst = 0.0f64;
    let swing = wire.ea * amplitude * k / (k * l).tan();
    run(&mut sim, 0.001, 0.5, inputs, |t, o| {
        let exact = wire.ea * stretch - swing * (frequency * t).cos();
        worst = worst.max((o.anchor.force.x - exact).abs());
    });
    let s = &sim.outputs().solver;
    println!(
        "driven bar: anchor force within {worst:.2e} N of a swing of {:.1} N; {} steps, energy error {:.1e}",
        swing.abs(),
        s.steps,
        s.energy_error
    );
    assert!(worst < 2e-3 * swing.abs(), "{worst:e}");
    assert!(s.energy_error < 1e-4, "{:e}", s.energy_error);
}

/// Saved mid-way, continued; restored into another simulation, continued: the same to the bit.
fn replays(scene: &Scene, inputs: impl Fn(f64) -> Inputs, h: f64) {
    let mut sim = started(scene, &inputs(0.0));
    run(&mut sim, h, 10.0 * h, &inputs, |_, _| {});
    let mut bytes = vec![];
    sim.write_state(&mut bytes);
    run(&mut sim, h, 20.0 * h, &inputs, |_, _| {});
    let mut other = started(scene, &inputs(0.0));
    other.read_state(&bytes).expect("the same scene");
    run(&mut other, h, 20.0 * h, &inputs, |_, _| {});
    assert_eq!(sim.outputs(), other.outputs());
    assert_eq!(sim.shape(), other.shape());
}

#[test]
fn replay_is_bit_identical_with_every_end() {
    let wire = Wire { length: 1.0, ea: 1e5, mass_per_length: 0.05, ei: 1e-3, ..THREAD };
    replays(&wire.scene(6, &[ANCHOR, &THESIS.table(), &down(0.5)].concat()), still, 0.01);
    replays(&HEAVY_WIRE.scene(20, &[SHIP, WATER, &Hung { mass: 500.0, inertia: 2.0, gravity: 1.5 }.table()].concat()), tossing, 0.1);
    let rest = format!("{SHIP}{WATER}[far_end]\nposition = [140, 10, -80]\n");
    replays(&HEAVY_WIRE.scene(20, &rest), tossing, 0.1);
}

fn refusal(scene: &Scene) -> String {
    let mut sim = Simulation::new(scene).expect("supported");
    sim.initialize(0.0, &Inputs::default()).expect_err("no start state").to_string()
}

#[test]
fn impossible_far_ends_are_refused_with_key_and_numbers() {
    let wire = Wire { length: 10.0, ea: 1e5, mass_per_length: 0.5, ..THREAD };
    let far = refusal(&wire.scene(4, &[ANCHOR, "[far_end]\nposition = [30, 0, 0]\n"].concat()));
    assert!(far.contains("far_end.position is 30.000000 m") && far.contains("cable.length = 10 m"), "{far}");
    let aside = [ANCHOR, "[far_end]\nposition = [9, 0, 0]\n[initial]\nstate = \"straight\"\ndirection = [1, 0, 0]\n"].concat();
    let aside = refusal(&wire.scene(4, &aside));
    assert!(aside.contains("(10.000000, 0.000000, 0.000000)") && aside.contains("1.000e0 m from far_end.position"), "{aside}");
    let straight = [ANCHOR, "[far_end]\nposition = [10, 0, 0]\n[initial]\nstate = \"straight\"\ndirection = [1, 0, 0]\n"].concat();
    let sim = started(&wire.scene(4, &straight), &Inputs::default());
    assert_eq!(sim.outputs().body.position, Vector3::new(10.0, 0.0, 0.0));
}

#[test]
fn exact_a_start_under_way_has_no_shock() {
    // The ship moves at 2 m/s as the run begins; the tension follows the static one of the moving end instead of ringing.
    let rest = format!("{SHIP}[far_end]\nposition = [150, 10, -60]\n");
    let inputs = |t: f64| {
        let mut inputs = Inputs { ship: [channel([0.0; 3]); 6], ..Inputs::default() };
        inputs.ship[0] = channel([-2.0 * t, -2.0, 0.0]);
        inputs
    };
    let scene = HEAVY_WIRE.scene(40, &rest);
    let mut sim = started(&scene, &inputs(0.0));
    let first = sim.outputs().cable.tension_max;
    let mut most = 0.0f64;
    run(&mut sim, 0.01, 0.5, inputs, |_, o| most = most.max((o.cable.tension_max / first - 1.0).abs()));
    // By statics, the end a metre further away, over another 0.5 s.
    let mut shifted = Simulation::new(&scene).expect("supported");
    shifted.initialize(0.0, &inputs(0.5)).expect("a start state");
    let by_statics = (shifted.outputs().cable.tension_max / first - 1.0).abs();
    println!("start at 2 m/s: tension changes by {most:.2e} within 0.5 s, by {by_statics:.2e} in statics");
    // In water too the start is that of a ship at rest: nothing is towed.
    let wet = HEAVY_WIRE.scene(20, &[&rest, WATER].concat());
    assert_eq!(started(&wet, &inputs(0.0)).shape(), started(&wet, &Inputs::default()).shape());
    // v √(EA m) = 6 kN would be ten times the tension.
    assert!(most < 3.0 * by_statics + 0.02, "{most:e} {by_statics:e}");
}
