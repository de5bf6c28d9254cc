//! Built-in heave compensation: what the winch is told, what then remains of the body's motion, and that it can be taken back.

mod bench;

use bench::{G, channel, heaving, run, started};
use fairlead::outputs::Outputs;
use fairlead::scene::Scene;
use fairlead::scene::file::SceneFile;
use fairlead::sim::{Inputs, SimError, Simulation};
use nalgebra::{Rotation3, Vector3};
use std::f64::consts::{PI, TAU};

const ALL: [&str; 3] = ["simplified_sheave", "sheave", "waterline"];

/// To the cable's centreline, m: of the drum, of the sheave.
const DRUM: f64 = 0.305;
const WHEEL: f64 = 0.205;
const CENTRE: [f64; 3] = [-4.0, 0.5, 3.0];
/// Where the vertical cable leaves the sheave (abaft of its centre), and its height above the water.
const LEAVES: [f64; 3] = [-4.0 - WHEEL, 0.5, 3.0];
const WATER: f64 = -5.0;
const HEIGHT: f64 = 3.0 - WATER;
/// A body that does not feel the water.
const DRY: &str = "volume = 0\ndrag_area = 0\ndrag_coefficient = 0\n";

/// A body of 50 kg on a thin rope over a sheave, or straight from the drum. The winch follows at once: e = ω²/k1 of the set-point, 1e-4 at
/// a period of 4 s. The rope is stiff: half a millimetre a metre. Water is there, but neither drags nor lifts.
fn text(setpoint: &str, wheel: bool, body: &str) -> String {
    let sheave =
        format!("[[sheave]]\nposition = {CENTRE:?}\naxis = [0, 1, 0]\nradius = {:?}\nside = \"over\"\nstiffness = 1e9\n", WHEEL - 0.005);
    format!(
        "name = \"hang\"\ngravity = {G:?}\n[cable]\nlength = 20.0\ndiameter = 0.01\nmass_per_length = 0.05\nEA = 1e6\nEI = 0.05\n\
         damping.axial = 2e3\n[mesh]\nregions = [{{ length = 8.0, elements = 100 }}, {{ length = 12.0, elements = 6 }}]\n\
         [ship]\ninput = \"pose_velocity_acceleration\"\n[winch]\nposition = [0, 0.5, 0]\naxis = [0, 1, 0]\nradius = {:?}\nangle = {PI:?}\n\
         gain_position = 4e4\ngain_rate = 400\nstiffness = 1e9\nend = \"tangent\"\nsetpoint = \"{setpoint}\"\n{}\
         [fluid]\ndensity = 1e-6\nwaterline = {WATER:?}\ndrag = {{ law = \"cross_flow\", cd_normal = 0, cd_tangential = 0 }}\n\
         [body]\nmass = 50\n{body}[outputs]\npoints = 41\n",
        DRUM - 0.005,
        if wheel { sheave.as_str() } else { "" },
    )
}

fn read(text: &str) -> Scene {
    SceneFile::parse(text, "hang.toml").and_then(|f| f.check(None)).unwrap_or_else(|e| panic!("{e}\nin\n{text}"))
}

fn scene(setpoint: &str) -> Scene {
    read(&text(setpoint, true, DRY))
}

/// Growing out of rest over `ramp` seconds, with two derivatives.
fn growing(t: f64, ramp: f64, m: [f64; 3]) -> [f64; 3] {
    let x = (t / ramp).min(1.0);
    let s = [
        x.powi(3) * (10.0 - 15.0 * x + 6.0 * x * x),
        30.0 * (x * (1.0 - x)).powi(2) / ramp,
        60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) / (ramp * ramp),
    ];
    [s[0] * m[0], s[1] * m[0] + s[0] * m[1], s[2] * m[0] + 2.0 * s[1] * m[1] + s[0] * m[2]]
}

fn sine(amplitude: f64, period: f64, t: f64) -> [f64; 3] {
    let w = TAU / period;
    let (s, c) = (w * t).sin_cos();
    [amplitude * s, amplitude * w * c, -amplitude * w * w * s]
}

/// A motion of one component of the pose.
fn one(component: usize, amplitude: f64, period: f64) -> impl Fn(f64) -> Inputs {
    move |t| {
        let mut inputs = Inputs { ship: [channel([0.0; 3]); 6], ..Inputs::default() };
        inputs.ship[component] = channel(growing(t, period, sine(amplitude, period, t)));
        inputs
    }
}

/// Amplitude and period of the ship's motion in all six ways.
const SEA: [[f64; 2]; 6] = [[0.3, 7.0], [0.2, 6.0], [0.4, 5.0], [0.05, 6.5], [0.04, 5.5], [0.03, 9.0]];

fn sea(t: f64) -> Inputs {
    let mut inputs = Inputs { ship: [channel([0.0; 3]); 6], ..Inputs::default() };
    for (input, [amplitude, period]) in inputs.ship.iter_mut().zip(SEA) {
        *input = channel(growing(t, 3.0, sine(amplitude, period, t)));
    }
    inputs
}

/// Where a point in ship axes is, by another library's rotation.
fn world(t: f64, s: [f64; 3]) -> Vector3<f64> {
    let [x, y, z, roll, pitch, yaw] = sea(t).ship.map(|c| c.value);
    Vector3::new(x, y, z) + Rotation3::from_euler_angles(roll, pitch, yaw) * Vector3::from(s)
}

/// Greatest change of a quantity over a run.
fn range(sim: &mut Simulation, end: f64, inputs: impl Fn(f64) -> Inputs, quantity: impl Fn(&Outputs) -> f64) -> f64 {
    let first = quantity(sim.outputs());
    let mut most = 0.0f64;
    run(sim, 0.02, end, inputs, |_, o| most = most.max((quantity(o) - first).abs()));
    most
}

#[test]
fn exact_a_body_that_hangs_plumb_stays_in_heave() {
    for setpoint in ALL {
        for wheel in [true, false] {
            let heave = one(2, 0.5, 4.0);
            let mut sim = started(&read(&text(setpoint, wheel, DRY)), &heave(0.0));
            let moved = range(&mut sim, 12.0, &heave, |o| o.body.position.z);
            println!("{setpoint}, {}: body moves {:.2} mm of 500 mm", if wheel { "over a sheave" } else { "from the drum" }, 1e3 * moved);
            // The rope paid out stretches (5e-4 of it), the winch lags by 6e-5, the span to the drum turns on its sheave: 1 mm of 500.
            assert!(moved < 1e-3, "{setpoint}: {moved}");
        }
    }
    // With the winch held all of it arrives.
    let mut held = started(&read(&text("external", true, DRY)), &held_inputs(0.0));
    assert!(range(&mut held, 10.0, held_inputs, |o| o.body.position.z) > 0.5);
}

/// The heave above with the drum held where it starts.
fn held_inputs(t: f64) -> Inputs {
    Inputs { winch: channel([PI, 0.0, 0.0]), ..heaving(0.5, 4.0)(t) }
}

#[test]
fn exact_set_points_and_payout_follow_their_definitions_in_all_six_motions() {
    let down = -Vector3::z();
    let start = Vector3::from(LEAVES);
    let water = start + down * HEIGHT;
    for setpoint in ["simplified_sheave", "waterline"] {
        let mut sim = started(&scene(setpoint), &sea(0.0));
        let (mut target, mut paid) = (0.0f64, 0.0f64);
        run(&mut sim, 0.01, 8.0, sea, |t, o| {
            let at = world(t, LEAVES);
            let expected = if setpoint == "waterline" { (at - water).norm() - HEIGHT } else { -down.dot(&(at - start)) };
            target = target.max(((o.winch.target - PI) * -DRUM - expected).abs());
            paid = paid.max((o.winch.payout - expected).abs());
        });
        println!("{setpoint}: set-point off by {target:.1e} m, payout by {paid:.1e} m");
        // Groove depth and weight let the rope leave a little beside the geometric point: R times the angle it hangs off the plumb line, and
        // what it sinks in by (T/(R k))^(2/3) = 1e-4 of a radian's turn.
        assert!(target < 1e-4, "{setpoint}: {target}");
        // The controller lags by ω²/k1 of 0.4 m.
        assert!(paid - target < 1e-4, "{setpoint}: {paid}");
    }
}

#[test]
fn exact_what_the_ship_turns_about_the_sheave_is_let_out_too() {
    // The rope unwinds R β from a sheave that turns with the ship by β; told is R sin β.
    let mut text = text("simplified_sheave", true, DRY);
    for (old, new) in [(format!("{CENTRE:?}"), "[0.0, 0.5, 0.0]"), ("position = [0, 0.5, 0]".into(), "position = [4.0, 0.5, -3.0]")] {
        assert!(text.contains(&old), "{old}");
        text = text.replace(&old, new);
    }
    let pitch = one(4, 0.1, 6.0);
    let mut sim = started(&read(&text), &pitch(0.0));
    let moved = range(&mut sim, 12.0, pitch, |o| o.body.position.z);
    println!("pitch of 0.1 rad about the sheave: body moves {:.3} mm, {:.1} mm without", 1e3 * moved, 1e2 * WHEEL);
    // R (β − sin β) = 0.03 mm, and the change of the span's bend on the sheave.
    assert!(moved < 2e-4, "{moved}");
}

/// A current of 0.7 m/s drags at the body alone: the rope, as heavy as the water it displaces, hangs straight at 26 degrees from the plumb line.
fn towed(setpoint: &str, rope: &str) -> Scene {
    let law = "cd_tangential = 0 }";
    let text = text(setpoint, true, "drag_area = 1.0\ndrag_coefficient = 1.0\nvolume = 1e-6\nadded_mass = 0.0\n")
        .replace("density = 1e-6", "density = 1000")
        .replace(law, &format!("{law}\ncurrent.profile = [[0, -0.7, 0]]"));
    let old = "diameter = 0.01\nmass_per_length = 0.05";
    assert!(text.contains(old));
    read(&text.replace(old, rope))
}

/// The ship rises within 20 s and stays there, m.
fn rise(to: f64) -> impl Fn(f64) -> Inputs {
    move |t| {
        let mut inputs = Inputs { ship: [channel([0.0; 3]); 6], ..Inputs::default() };
        inputs.ship[2] = channel(growing(t, 20.0, [to, 0.0, 0.0]));
        inputs
    }
}

#[test]
fn exact_an_inclined_line_leaves_the_part_across_itself() {
    // In slow heave z the whole rope is shifted by z less what is paid out along it: the body still heaves by z (1 − u_z²) = z sin² θ, and is
    // left behind by z sin θ cos θ. A quarter of what would arrive with the winch held; more than a plumb line has, which is nothing.
    let z = 0.2;
    for setpoint in ALL {
        let inputs = rise(z);
        let mut sim = started(&towed(setpoint, "diameter = 0.001\nmass_per_length = 7.85e-4"), &inputs(0.0));
        let first = sim.outputs().body.position;
        let u = chord(sim.outputs());
        // The drag lets it settle with a time constant of 18 s.
        run(&mut sim, 0.1, 150.0, inputs, |_, _| ());
        let moved = sim.outputs().body.position - first;
        let expected = [z * (1.0 - u.z * u.z), z * u.x * u.z];
        println!(
            "{setpoint}: line at {:.1} deg from the plumb line; body rises {:.4} m of {z} and goes {:.4} m astern, {:.4} and {:.4} by geometry",
            (-u.z).acos().to_degrees(),
            moved.z,
            -moved.x,
            expected[0],
            expected[1]
        );
        // The waterline's length grows by z_⟂²/2d = 5e-4 m more; the rope stretches by 5e-4 of what is paid out.
        assert!((moved.z - expected[0]).abs() < 1e-3 && (-moved.x - expected[1]).abs() < 1e-3, "{setpoint}: {moved:?} {expected:?}");
    }
}

#[test]
fn exact_a_rope_that_nothing_damps_does_not_flutter() {
    // Ten times as heavy a rope has transverse waves of 2 Hz. With the direction unfiltered the winch feeds them until the body flies.
    let inputs = rise(0.2);
    let mut sim = started(&towed("sheave", "diameter = 0.01\nmass_per_length = 0.0785"), &inputs(0.0));
    let mut fastest = 0.0f64;
    run(&mut sim, 0.05, 60.0, inputs, |_, o| fastest = fastest.max(o.body.velocity.norm()));
    // The ship's own is 0.2 m within 20 s, at most 15/8 of their ratio.
    assert!(fastest < 0.03, "{fastest}");
}

#[test]
fn exact_a_drift_in_yaw_moves_no_plumb_line() {
    for setpoint in ALL {
        let yaw = |t: f64| {
            let mut inputs = Inputs { ship: [channel([0.0; 3]); 6], ..Inputs::default() };
            inputs.ship[5] = channel(growing(t, 20.0, [0.5, 0.0, 0.0]));
            inputs
        };
        let mut sim = started(&scene(setpoint), &yaw(0.0));
        run(&mut sim, 0.05, 20.0, yaw, |_, _| ());
        // The chord over which the sheave has gone, 2 r sin(½ 0.5).
        let chord = 2.0 * LEAVES[0].hypot(LEAVES[1]) * 0.25f64.sin();
        let expected = if setpoint == "waterline" { HEIGHT.hypot(chord) - HEIGHT } else { 0.0 };
        let payout = sim.outputs().winch.payout;
        println!("{setpoint}: {payout:.6} m paid out after a drift of {chord:.3} m, {expected:.6} expected");
        // The body follows the sheave within its own swing of centimetres on 15 m, which is all that `sheave` sees.
        let tolerance = if setpoint == "sheave" { 0.02 * chord } else { 1e-3 };
        assert!((payout - expected).abs() < tolerance, "{setpoint}: {payout} {expected}");
    }
}

/// Direction of the cable below the sheave, from the points for drawing, which are half a metre apart.
fn chord(o: &Outputs) -> Vector3<f64> {
    let points = &o.cable.points;
    let top = (0..points.len()).max_by(|a, b| points[*a].z.total_cmp(&points[*b].z)).expect("there are points");
    (points[top + 2] - points[top + 1]).normalize()
}

#[test]
fn exact_sheave_takes_the_present_direction_without_jumps() {
    let surge = one(0, 0.6, 5.0);
    let mut tracks = vec![];
    for h in [0.05, 0.01] {
        let mut sim = started(&scene("sheave"), &surge(0.0));
        let (mut off, mut tilt, mut track) = (0.0f64, 0.0f64, vec![]);
        let mut last = [0.0; 2];
        let mut kink = 0.0f64;
        run(&mut sim, h, 15.0, &surge, |t, o| {
            let x = surge(t).ship[0].value;
            let u = chord(o);
            let told = -DRUM * (o.winch.target - PI);
            off = off.max((told + u.x * x).abs());
            tilt = tilt.max(u.x.abs());
            // The rate at both ends of a step gives what the set-point does over it: trapezoidal rule, h³/12 of the third derivative.
            let rate = -DRUM * o.winch.target_rate;
            kink = kink.max((told - last[0] - 0.5 * h * (rate + last[1])).abs());
            last = [told, rate];
            if ((t / 0.05).round() * 0.05 - t).abs() < 1e-6 {
                track.push(told);
            }
        });
        println!("steps of {h} s: tilt up to {tilt:.3}, set-point off −u·Δr by {:.3} mm, kinks of {:.4} mm", 1e3 * off, 1e3 * kink);
        // The filter lags by 2/(8 √(g/14 m)) = 0.3 s, in which a direction that swings by 0.12 at 1.3 rad/s turns by 0.05: times 0.6 m.
        assert!(off < 0.03 && tilt > 0.1, "{off} {tilt}");
        // Third derivatives up to 20 m/s³ where the next measurement sets in.
        assert!(kink < 2.0 * h.powi(3), "{kink}");
        tracks.push(track);
    }
    // What the step length does to the set-point: O(h²) of the direction's curvature, times 0.6 m.
    let apart = tracks[0].iter().zip(&tracks[1]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!("steps of 50 and 10 ms differ by {:.3} mm", 1e3 * apart);
    assert!(apart < 1e-3, "{apart}");
}

#[test]
fn exact_rate_is_the_set_point_s_derivative_between_steps_too() {
    for setpoint in ALL {
        let mut sim = started(&scene(setpoint), &sea(0.0));
        run(&mut sim, 0.02, 2.0, sea, |_, _| ());
        let slope = sim.rates();
        let (rate, told) = (slope.of(|o| o.winch.target), sim.outputs().winch.target_rate);
        // A central difference over 2 µs of numbers of size 3: rounding.
        assert!((rate - told).abs() < 1e-8, "{setpoint}: {rate} {told}");
        assert!(told.abs() > 1e-3);
    }
}

#[test]
fn exact_payout_commands_and_mirrored_drums_are_told_the_same_metres() {
    let metres = |from: &str, to: &str| -> Vec<f64> {
        let mirrored = text("simplified_sheave", true, DRY).replace(from, to);
        let mut sim = started(&read(&mirrored), &sea(0.0));
        let mut all = vec![sim.outputs().winch.target];
        run(&mut sim, 0.02, 1.0, sea, |_, o| all.push(o.winch.target));
        all
    };
    let payout = metres("end = ", "command = \"payout\"\nend = ");
    let angle = metres("end = ", "end = ");
    assert_eq!((payout[0], angle[0]), (0.0, PI));
    for (a, b) in payout.iter().zip(&angle) {
        assert!((a - (b - PI) * -DRUM).abs() < 1e-12);
    }
    // A drum whose cable leaves from below, the other way round.
    let angle = 0.0;
    let mirrored = metres(&format!("angle = {PI:?}\n"), &format!("angle = {angle:?}\ndirection = 1\n"));
    for (a, b) in payout.iter().zip(&mirrored) {
        // The sheave is the same; how the rope comes to it changes the tension that it sinks in with.
        assert!((a - (b - angle) * DRUM).abs() < 1e-4, "{a} {b}");
    }
}

#[test]
fn exact_states_carry_the_set_point() {
    for setpoint in ALL {
        let mut sim = started(&scene(setpoint), &sea(0.0));
        run(&mut sim, 0.02, 1.0, sea, |_, _| ());
        let mut bytes = vec![];
        sim.write_state(&mut bytes);
        let mut straight = sim.clone();
        run(&mut straight, 0.02, 1.6, sea, |_, _| ());
        // Another start: it must not be remembered.
        let elsewhere = |_| Inputs { ship: [channel([0.3, 0.0, 0.0]); 6], ..Inputs::default() };
        let mut foreign = started(&scene(setpoint), &elsewhere(0.0));
        run(&mut foreign, 0.02, 0.1, elsewhere, |_, _| ());
        run(&mut sim, 0.02, 1.1, sea, |_, _| ());
        for mut other in [foreign, sim] {
            other.read_state(&bytes).expect("of the same scene");
            run(&mut other, 0.02, 1.6, sea, |_, _| ());
            let (mut a, mut b) = (vec![], vec![]);
            straight.write_state(&mut a);
            other.write_state(&mut b);
            assert_eq!(a, b, "{setpoint}");
        }
    }
}

#[test]
fn exact_a_failed_step_takes_the_set_point_back() {
    let mut sim = started(&scene("sheave"), &sea(0.0));
    run(&mut sim, 0.02, 1.0, sea, |_, _| ());
    let mut twin = sim.clone();
    let mut absurd = sea(1.0);
    absurd.ship[2].value = 1e300;
    assert!(matches!(sim.step_to(1.02, &absurd), Err(SimError::Step(_))));
    for sim in [&mut sim, &mut twin] {
        run(sim, 0.02, 1.2, sea, |_, _| ());
    }
    let [mut a, mut b] = [sim, twin].map(|s| s.outputs().clone());
    for o in [&mut a, &mut b] {
        // The failed attempt counts.
        o.solver = Default::default();
    }
    assert_eq!(a, b);
}

#[test]
fn exact_lines_that_never_meet_the_water_are_refused_with_numbers() {
    let start = |text: &str| match Simulation::new(&read(text)).and_then(|mut s| s.initialize(0.0, &sea(0.0))) {
        Err(SimError::Start(message)) => message,
        other => panic!("{other:?}"),
    };
    let flooded = start(&text("waterline", true, DRY).replace(&format!("waterline = {WATER:?}"), "waterline = 4.0"));
    for part in ["winch.setpoint = \"waterline\"", "never meets the water", "m below it and goes down by 1.0000 m in a metre"] {
        assert!(flooded.contains(part), "{flooded}");
    }
    // A balloon on the rope.
    let rising = text("waterline", false, "volume = 0.2\ndrag_area = 0\ndrag_coefficient = 0\n")
        .replace("density = 1e-6", "density = 1000")
        .replace(&format!("waterline = {WATER:?}"), "waterline = 100.0");
    let rising = start(&rising);
    assert!(rising.contains("below it and goes up by"), "{rising}");
}
