//! Sheaves that turn: moments, spin and inertia against closed forms; the tangent's borders against differences.

mod bench;

use bench::{Wire, run, started};
use fairlead::integrator::Problem;
use fairlead::sim::{Channel, Inputs};
use fairlead::system::{Matrices, System};

const ROPE: Wire = Wire { length: 1.5, diameter: 0.008, mass_per_length: 0.05, ea: 1e5, ei: 1e-4, laws: "damping.axial = 60.0" };
/// Of the sheave, to the rope's centreline, m.
const R: f64 = 0.054;
const MASS: f64 = 10.0;

/// A winch far away, so great that its rim hardly turns aside, a sheave that turns, a body below; `bearing`: further keys of the sheave.
fn hoist(bearing: &str) -> String {
    format!(
        "[mesh]\nregions = [{{ length = 0.84, elements = 16 }}, {{ length = 0.56, elements = 93 }}, {{ length = 0.1, elements = 2 }}]\n\
         [winch]\nposition = [-1.0, 0, {}]\naxis = [0, 1, 0]\nradius = 19.996\ngain_position = 400\ngain_rate = 40\ndirection = 1\n\
         [[sheave]]\nname = \"block\"\nposition = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 0.05\nstiffness = 5e10\nfriction = 0.5\n{bearing}\n\
         [body]\nmass = {MASS}\nforce_input = true\n[solver]\ntolerance = 1e-5\n[outputs]\npoints = 2\n",
        R - 20.0
    )
}

fn scene(bearing: &str) -> fairlead::scene::Scene {
    let text = hoist(bearing);
    let (mesh, rest) = text.split_at(text.find("[winch]").unwrap_or(0));
    let full = format!(
        "name = \"hoist\"\n[cable]\nlength = {:?}\ndiameter = {:?}\nmass_per_length = {:?}\nEA = {:?}\nEI = {:?}\n{}\n{mesh}{rest}",
        ROPE.length, ROPE.diameter, ROPE.mass_per_length, ROPE.ea, ROPE.ei, ROPE.laws
    );
    fairlead::scene::file::SceneFile::parse(&full, "hoist.toml").and_then(|f| f.check(None)).unwrap_or_else(|e| panic!("{e}"))
}

/// The drum turns from rest, smoothly to a steady rate within half a second.
fn hoisting(speed: f64) -> impl Fn(f64) -> Inputs {
    move |t: f64| {
        let (value, rate) = if t < 0.5 {
            let x = t / 0.5;
            (0.5 * (x * x * x - 0.5 * x * x * x * x), x * x * (3.0 - 2.0 * x))
        } else {
            (0.25 + t - 0.5, 1.0)
        };
        Inputs { winch: Channel { value: speed * value, first: Some(speed * rate), second: None }, ..Inputs::default() }
    }
}

#[test]
fn exact_bearing_moments_are_the_difference_of_tensions() {
    let (friction, damping) = (0.4, 0.1);
    let mut sim =
        started(&scene(&format!("inertia = 1e-3\nbearing_friction = {friction}\nbearing_damping = {damping}")), &Inputs::default());
    let (mut difference, mut spin, mut count, mut about) = (0.0, 0.0, 0.0, 0.0);
    run(&mut sim, 0.01, 1.5, hoisting(-0.01), |t, o| {
        if t > 0.9 {
            difference += o.sheaves[0].tension_in - o.sheaves[0].tension_out;
            spin += o.sheaves[0].rate;
            about += o.ship.moment.y - o.winch.force.z * 1.0 - o.winch.force.x * (R - 20.0) - o.winch.torque;
            count += 1.0;
        }
    });
    let (difference, spin, about): (f64, f64, f64) = (difference / count, spin / count, about / count);
    let expected = friction + damping * spin.abs();
    println!(
        "hoisting: spin {spin:.5} rad/s, of a rope that does not slip {:.5}; difference of tensions {difference:.4} N, the bearing's moment over R {:.4} N; \
         on the ship about the axis {about:.4} N m, the bearing's {expected:.4} N m; energy error {:.1e}",
        -0.2 / R,
        expected / R,
        sim.outputs().solver.energy_error
    );
    // The rope stretches by T/EA = 1e-3 and creeps by that much; regularized friction slips at 1 mm/s of 200.
    assert!((spin / (-0.2 / R) - 1.0).abs() < 5e-3, "{spin}");
    // The weight of the wrapped rope adds 0.05 · 9.81 · R = 0.026 N; the pressed-in centreline takes 2e-4, the tension's reading the rest.
    assert!((difference - expected / R - 0.026).abs() < 1e-3 * difference, "{difference}");
    assert!((about.abs() - expected).abs() < 2e-5 * expected, "{about}"); // at 185 times its slip speed friction is 1.5e-5 short
    // Where rope runs onto a rough sheave the ledger's state at mid-step, between two velocities, sees a friction that is not there.
    assert!(sim.outputs().solver.energy_error < 1e-2);
}

#[test]
fn exact_tensions_are_equal_at_rest_without_bearing_friction() {
    // A pull on the body comes and stays: the rope stretches and turns the sheave until both sides pull alike.
    let pull = |t: f64| {
        let x = (t / 0.3).min(1.0);
        Inputs {
            body_force: [0.0, 0.0, -200.0 * x * x * (3.0 - 2.0 * x)].map(|value| Channel { value, ..Channel::default() }),
            ..Inputs::default()
        }
    };
    let ratio = |bearing: &str| {
        let mut sim = started(&scene(bearing), &Inputs::default());
        run(&mut sim, 0.01, 3.0, pull, |_, _| ());
        let o = &sim.outputs().sheaves[0];
        println!("{bearing:?}: tensions {:.4} and {:.4} N, turned by {:.3e} rad", o.tension_in, o.tension_out, o.angle);
        o.tension_in / o.tension_out - 1.0
    };
    let (free, stuck) = (ratio("inertia = 1e-3"), ratio(""));
    // Rope at rest on the sheave weighs 0.05 · 9.81 · R = 0.026 N of 298.
    assert!(free.abs() < 2e-4, "{free:e}");
    assert!(stuck.abs() > 0.02, "{stuck:e}"); // a sheave that stands still keeps the difference
}

#[test]
fn exact_inertia_takes_the_difference_of_tensions() {
    // A heavy sheave while the winch speeds up: (T_in − T_out) R = I Ω̇.
    let inertia = 0.05;
    let mut sim = started(&scene(&format!("inertia = {inertia}")), &Inputs::default());
    let mut last = 0.0;
    let (mut impulse, mut worst) = (0.0, 0.0f64);
    run(&mut sim, 0.01, 0.8, hoisting(-0.01), |_, o| {
        let now = o.sheaves[0].tension_in - o.sheaves[0].tension_out;
        impulse += 0.5 * 0.01 * (last + now) * R;
        last = now;
        worst = worst.max((impulse + inertia * o.sheaves[0].rate).abs());
    });
    let gained = inertia * sim.outputs().sheaves[0].rate.abs();
    println!("angular momentum {gained:.5} N m s, off the tensions' impulse by at most {worst:.1e}");
    // The trapezoidal rule over 10 ms, and the rope's own weight on the sheave, 0.026 N R over 0.8 s = 1.1e-3.
    assert!(worst < 0.01 * gained, "{worst:e}");
}

#[test]
fn exact_borders_match_central_differences() {
    let scene = scene("damping = 0.2\ninertia = 2e-3\nbearing_friction = 0.3\nbearing_damping = 0.05");
    let mut system = System::new(&scene);
    system.ship.start(0.0, &Inputs::default().ship);
    system.ship.advance(0.0, 1.0, &Inputs::default().ship);
    if let fairlead::system::FirstEnd::Winch { drive, .. } = &mut system.first {
        drive.start(0.0, 0.0);
    }
    let mut u = fairlead::equilibrium::lay_out(&system, 0.0, &-nalgebra::Vector3::z()).expect("a way");
    fairlead::equilibrium::solve(&mut system, 0.0, &mut u, MASS * 9.81).expect("a rest");
    let n = u.len();
    let at = system.turning[0].at;
    let mut w: Vec<f64> = (0..n).map(|i| 0.05 * (1.7 * i as f64).sin()).collect();
    w[..3].fill(0.0);
    w[at] = 1.3;
    let zero = vec![0.0; n];
    let (mut m, mut f) = (Matrices::zeros(n / 6), zero.clone());
    system.linearize(0.0, &u, &w, &zero, &mut m, &mut f);
    let coupling = m.couplings[0].clone();
    let [_, damping, _] = m.whole();
    let mut force = |u: &[f64], w: &[f64]| {
        let mut f = vec![0.0; n];
        system.force(0.0, u, w, None, &mut f);
        f
    };
    // The column of the spin.
    let shifted = |w: &[f64], k: usize, h: f64| {
        let mut w = w.to_vec();
        w[k] += h;
        w
    };
    let size = coupling.damping_column.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let (up, down) = (force(&u, &shifted(&w, at, 1e-5)), force(&u, &shifted(&w, at, -1e-5)));
    let mut worst = 0.0f64;
    for i in 0..n {
        let exact = -coupling.damping_column[i] - if i == at { damping.diagonal[at / 6][at % 6][at % 6] } else { 0.0 };
        worst = worst.max(((up[i] - down[i]) / 2e-5 - exact).abs() / size);
    }
    // The rows of the moment.
    for (which, row) in [&coupling.stiffness_row, &coupling.damping_row].into_iter().enumerate() {
        let size = row.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        assert!(size > 0.0);
        for k in 3..at {
            let h = [if k % 6 < 3 { 1e-10 } else { 1e-8 }, 1e-5][which];
            let at_shift = |h: f64| if which == 0 { (shifted(&u, k, h), w.clone()) } else { (u.clone(), shifted(&w, k, h)) };
            let ((u1, w1), (u2, w2)) = (at_shift(h), at_shift(-h));
            let difference = (force(&u1, &w1)[at] - force(&u2, &w2)[at]) / (2.0 * h);
            worst = worst.max((difference + row[k]).abs() / size);
        }
    }
    println!("borders against central differences: {worst:.1e} of the largest entry");
    assert!(worst < 1e-5, "{worst:e}"); // rounding of the moment over h, h² truncation at 1e-6 m of penetration
}

#[test]
fn exact_a_ship_that_begins_to_pitch_leaves_the_sheave_behind() {
    // Ω is relative to the ship: at the same motion, an acceleration α of the ship about the axis is felt as −I α and as nothing else.
    let inertia = 2e-3;
    let scene = scene(&format!("inertia = {inertia}\n[ship]\ninput = \"pose_velocity_acceleration\""));
    let moment = |alpha: f64| {
        let mut ship = [Channel { value: 0.0, first: Some(0.0), second: Some(0.0) }; 6];
        ship[4].second = Some(alpha);
        let mut system = System::new(&scene);
        system.ship.start(0.0, &ship);
        system.ship.advance(0.0, 1.0, &ship);
        if let fairlead::system::FirstEnd::Winch { drive, .. } = &mut system.first {
            drive.start(0.0, 0.0);
        }
        let u = fairlead::equilibrium::lay_out(&system, 0.0, &-nalgebra::Vector3::z()).expect("a way");
        let (at, mut w, mut f) = (system.turning[0].at, vec![0.0; u.len()], vec![0.0; u.len()]);
        w[at] = 1.3;
        system.force(0.0, &u, &w, None, &mut f);
        f[at]
    };
    let felt = moment(3.0) - moment(0.0);
    println!("a pitch acceleration of 3 rad/s² is felt as {felt:.9} N m");
    assert!((felt / (-3.0 * inertia) - 1.0).abs() < 1e-9, "{felt}"); // rounding of the contact's moment, about 1 N m
}
