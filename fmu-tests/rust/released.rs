//! Starts by release: pendulums of a rigid load or a body, let go aside.

mod bench;

use bench::load::{Hung, THREAD, down};
use bench::swing::Crossings;
use bench::{ANCHOR, G, Wire, elliptic_k, run, started, still};
use fairlead::sim::Inputs;
use nalgebra::Vector3;

#[test]
fn exact_compound_pendulum_keeps_its_period() {
    // A short cable, so that the attachment hardly moves, and an angle at which the reaction leaves the link's direction little: from a
    // greater one the cable would whirl.
    let (angle, l) = (0.3, 1e-3);
    let load = Hung { mass: 2.0, inertia: 0.8, gravity: 0.6 };
    let wire = Wire { length: l, ea: 2e4, mass_per_length: 0.5, laws: "damping.axial = 10", ..THREAD };
    let scene = wire.scene(1, &[ANCHOR, &load.table(), &down(angle), "[solver]\ntolerance = 1e-2\n"].concat());
    let mut sim = started(&scene, &Inputs::default());
    let mut crossings = Crossings::default();
    let mut stretch = 0.0f64;
    run(&mut sim, 0.01, 8.0, still, |t, o| {
        crossings.sample([t, o.load.position.x, o.load.velocity.x]);
        stretch = stretch.max(load.stretch(o));
    });
    // What the cable adds to first order in its length l: the slower root of the double pendulum, 1 + L_PG³ l/(2 L_PI⁴).
    let give = 1.0 + load.gravity.powi(3) * l / (2.0 * load.inertia.powi(4));
    let exact = 4.0 * load.inertia / (G * load.gravity).sqrt() * elliptic_k((0.5 * angle).sin()) * give;
    let error = crossings.period() / exact - 1.0;
    println!(
        "compound pendulum from 0.3 rad: period {:.6} s, closed form {exact:.6} s ({error:.1e}); link {stretch:.1e}; {} steps, energy error {:.1e}",
        crossings.period(),
        sim.outputs().solver.steps,
        sim.outputs().solver.energy_error
    );
    // Of `give`'s 2.6e-4 a share of angle² = 0.09 belongs to the amplitude; stretch adds 1e-3 of it.
    assert!(error.abs() < 2.5e-5, "{error:e}");
    assert!(stretch < 1e-14, "{stretch:e}");
}

#[test]
fn exact_point_load_swings_as_one_pendulum_with_its_cable() {
    // a = 1: the load is a point at I, the link massless, and cable and link stay in line.
    let (angle, load) = (80f64.to_radians(), Hung { mass: 2.0, inertia: 0.8, gravity: 0.8 });
    let wire = Wire { length: 1.2, ea: 1e6, mass_per_length: 1e-3, ..THREAD };
    let scene = wire.scene(4, &[ANCHOR, &load.table(), &down(angle), "[solver]\ntolerance = 1e-3\n"].concat());
    let mut sim = started(&scene, &Inputs::default());
    let (mut crossings, mut bend) = (Crossings::default(), 0.0f64);
    // The cable's own weight holds the load a little lower than the released force alone would.
    let from = sim.outputs().load.position;
    let angle = from.x.atan2(-from.z);
    run(&mut sim, 0.01, 12.0, still, |t, o| {
        crossings.sample([t, o.load.position.x, o.load.velocity.x]);
        bend = bend.max(((o.load.position - o.body.position) / load.gravity - o.body.position.normalize()).norm());
    });
    // The cable as a rod: its bending out of line is of first order in its mass, 6e-4 of the load's, and the period's error of second.
    let (m_l, l) = (wire.mass_per_length, wire.length);
    let (inertia, arm) = (load.mass * 4.0 + m_l * l.powi(3) / 3.0, load.mass * 2.0 + m_l * l * l / 2.0);
    let exact = 4.0 * (inertia / (arm * G)).sqrt() * elliptic_k((0.5 * angle).sin());
    let error = crossings.period() / exact - 1.0;
    println!(
        "point load from {:.3} deg: period {:.6} s, closed form {exact:.6} s ({error:.1e}), out of line {bend:.1e}; {} steps",
        angle.to_degrees(),
        crossings.period(),
        sim.outputs().solver.steps
    );
    // Stretch: up to 3e-5 over 1.2 of 2 m, half of it in the period; and the sag at the start, 1.6e-3 of the angle of the cable alone, makes
    // the amplitude uncertain by its share of the inertia.
    assert!(error.abs() < 4e-5, "{error:e}");
    assert!(bend < 1e-2, "{bend:e}");
}

#[test]
fn exact_link_costs_no_steps() {
    let wire = Wire { length: 1.2, ea: 1e6, mass_per_length: 1e-3, ..THREAD };
    let steps = |wire: &Wire, end: &str| {
        let rest = [ANCHOR, end, &down(80f64.to_radians()), "[solver]\ntolerance = 1e-3\n"].concat();
        let mut sim = started(&wire.scene(4, &rest), &Inputs::default());
        run(&mut sim, 0.01, 4.0, still, |_, _| {});
        sim.outputs().solver.steps
    };
    let lump = steps(&Wire { length: 2.0, ..wire }, "[body]\nmass = 2\n");
    for a in [0.5, 0.9, 0.959] {
        let link = steps(&wire, &Hung { mass: 2.0, inertia: 0.8, gravity: 0.8 * a }.table());
        println!("4 s from 80 deg: {link} steps with a link of a = {a}, {lump} with a lump");
        assert!(2 * link < 3 * lump, "{link} {lump}"); // the second pendulum's own motion may cost some
    }
}

#[test]
fn exact_double_pendulum_momentum_and_energy() {
    let load = Hung { mass: 2.0, inertia: 0.8, gravity: 0.6 };
    let wire = Wire { length: 1.0, ea: 2e6, mass_per_length: 1e-5, ..THREAD };
    let angle = 1.0f64;
    let scene = wire.scene(4, &[ANCHOR, &load.table(), &down(angle), "[solver]\ntolerance = 1e-4\n"].concat());
    let mut sim = started(&scene, &Inputs::default());
    // The released start: at rest, in line, T = m g cos θ.
    let o = sim.outputs();
    let tension = load.mass * G * angle.cos();
    println!("released: tension {:.7} N, statics {tension:.7} N; angle {:.9}, asked for {angle}", o.load.tension, o.load.angle);
    // The thread weighs 5e-6 of the load.
    assert!((o.load.tension / tension - 1.0).abs() < 1e-5 && (o.load.angle - angle).abs() < 1e-5);
    assert!((o.body.position.x.atan2(-o.body.position.z) - angle).abs() < 1e-5);
    assert_eq!(o.load.velocity, Vector3::zeros());

    let mut x = [angle, angle, 0.0, 0.0];
    let (h, fine) = (0.005, 20);
    let rate = |x: &[f64; 4]| {
        let a = load.accelerations(1.0, x);
        [x[2], x[3], a[0], a[1]]
    };
    let start = load.energy(sim.outputs());
    let (mut far, mut energy, mut link) = (0.0f64, 0.0f64, 0.0f64);
    let mut impulse = vec![sim.outputs().anchor.force];
    let mut velocity = vec![Vector3::zeros()];
    let mut first = None;
    run(&mut sim, h, 4.0, still, |_, o| {
        // Classical Runge-Kutta, error (h/20)⁴.
        for _ in 0..fine {
            let d = h / f64::from(fine);
            let along = |k: &[f64; 4], s: f64| std::array::from_fn(|i| x[i] + s * k[i]);
            let k1 = rate(&x);
            let k2 = rate(&along(&k1, 0.5 * d));
            let k3 = rate(&along(&k2, 0.5 * d));
            let k4 = rate(&along(&k3, d));
            x = std::array::from_fn(|i| x[i] + d / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        }
        let exact = Vector3::new(x[0].sin() + load.gravity * x[1].sin(), 0.0, -x[0].cos() - load.gravity * x[1].cos());
        far = far.max((o.load.position - exact).norm());
        energy = energy.max((load.energy(o) - start).abs() / (load.mass * G));
        link = link.max(load.stretch(o));
        first.get_or_insert(o.load.velocity / h);
        impulse.push(o.anchor.force);
        velocity.push(o.load.velocity);
    });
    // First motion: G's acceleration from the closed form at rest; it changes by about h² within the first h.
    let a = load.accelerations(1.0, &[angle, angle, 0.0, 0.0]);
    let expected = Vector3::new(angle.cos(), 0.0, angle.sin()) * (a[0] + load.gravity * a[1]);
    let begin = (first.expect("a step") - expected).norm() / expected.norm();
    // m v = ∫ (m g − cable's force on the anchor) dt, by Simpson's rule.
    let mut momentum = 0.0f64;
    let mut sum = Vector3::zeros();
    for k in (2..impulse.len()).step_by(2) {
        sum += (impulse[k - 2] + impulse[k - 1] * 4.0 + impulse[k]) * (h / 3.0);
        let given = -sum - Vector3::z() * (load.mass * G * h * k as f64);
        momentum = momentum.max((velocity[k] * load.mass - given).norm() / (load.mass * G));
    }
    println!(
        "double pendulum over 4 s: G within {far:.1e} m, energy within {energy:.1e} of m g · 1 m, first acceleration within {begin:.1e}, \
         momentum within {momentum:.1e} of m g · 1 s, link {link:.1e}; {} steps, reported energy error {:.1e}",
        sim.outputs().solver.steps,
        sim.outputs().solver.energy_error
    );
    assert!(far < 1e-3, "{far:e}");
    assert!(energy < 1e-4, "{energy:e}");
    assert!(begin < 1e-3, "{begin:e}");
    assert!(momentum < 1e-3, "{momentum:e}");
    assert!(link < 1e-14, "{link:e}");
}

#[test]
fn exact_released_body_starts_as_a_pendulum() {
    let angle = 0.6f64;
    let wire = Wire { length: 2.0, ea: 1e6, mass_per_length: 1e-6, ..THREAD };
    let scene = wire.scene(6, &[ANCHOR, "[body]\nmass = 3\n", &down(angle)].concat());
    let mut sim = started(&scene, &Inputs::default());
    let o = sim.outputs().clone();
    assert!((o.body.tension / (3.0 * G * angle.cos()) - 1.0).abs() < 1e-6); // the thread weighs 7e-7 of the body
    assert!((o.body.position.x.atan2(-o.body.position.z) - angle).abs() < 1e-6);
    run(&mut sim, 0.001, 0.01, still, |_, _| {});
    let v = sim.outputs().body.velocity;
    // v = g sin θ t across the rope, less (g cos θ/L) t²/6 of it: 7e-5 at 0.01 s.
    let expected = -Vector3::new(angle.cos(), 0.0, angle.sin()) * (G * angle.sin() * 0.01);
    assert!((v - expected).norm() < 3e-4 * expected.norm(), "{v} {expected}");
}
