//! Motions with a known answer: frequencies, a pendulum, a falling body, a snap, the thesis's damping, scenes P3 and P4.

mod bench;

use bench::swing::Crossings;
use bench::{
    ANCHOR, HEAVY_WIRE, NYLON, Row, Wire, at_rest, elliptic_k, frequencies, heaving, pull, relative_rms, rms, root, run, shape_csv,
    started, still, table,
};
use fairlead::outputs::Outputs;
use fairlead::sim::Inputs;
use fairlead::system::{FirstEnd, System};
use std::f64::consts::{FRAC_PI_2, PI};

/// What cubic elements add to the frequency of a wave that advances by `phase` per element, measured at 1.4e-5 to 1.9e-5 phase⁶ below,
/// with a third more.
fn mesh_error(phase: f64) -> f64 {
    2.5e-5 * phase.powi(6) + 2e-12
}

#[test]
fn exact_frequencies_of_a_taut_string() {
    let wire = Wire { length: 2.0, diameter: 0.01, mass_per_length: 0.3, ea: 1e4, ei: 0.0, laws: "" };
    // A body too heavy to follow holds the far end; its pull alone stretches the string.
    let scene = wire.scene_at(0.0, 24, &[ANCHOR, "[body]\nmass = 1e9\n"].concat(), None);
    let tension = 40.0;
    let (mut system, u) = at_rest(&scene, [0.0, 0.0, -tension]);
    let w = frequencies(&mut system, &u, 0, true);
    let stretch = 1.0 + tension / wire.ea;
    for n in 1..=4 {
        // m ü = (T/λ) u'' over the unstretched length.
        let exact = f64::from(n) * PI / wire.length * (tension / (stretch * wire.mass_per_length)).sqrt();
        let error = w[n as usize - 1] / exact - 1.0;
        println!("taut string, mode {n}: {:.6} rad/s, relative error {error:.1e}", w[n as usize - 1]);
        // The mesh, and the rounding of the tension.
        assert!(error.abs() < mesh_error(f64::from(n) * PI / 24.0) + 2e-9, "{error:e}");
    }
}

#[test]
fn exact_frequencies_of_a_hanging_chain() {
    // A chain that hardly stretches has digits of its tension lost to rounding; two that stretch more lead to one that does not stretch.
    let stretched = |ea: f64| {
        let wire = Wire { length: 5.0, diameter: 0.01, mass_per_length: 0.8, ea, ei: 0.0, laws: "" };
        let (mut system, u) = at_rest(&wire.scene(24, ANCHOR), [0.0; 3]);
        frequencies(&mut system, &u, 0, false)
    };
    let (soft, stiff) = (stretched(1e7), stretched(2e7));
    // Zeros of the Bessel function J0 (Abramowitz & Stegun, table 9.5).
    for (n, zero) in [2.404_825_557_7, 5.520_078_110_3, 8.653_727_912_9, 11.791_534_439_0].into_iter().enumerate() {
        let exact = zero / 2.0 * (9.81f64 / 5.0).sqrt();
        let w = 2.0 * stiff[n] - soft[n];
        let error = w / exact - 1.0;
        println!("hanging chain, mode {}: {w:.6} rad/s, relative error {error:.1e}", n + 1);
        // The mesh near the free end, where the waves are shortest: measured up to 5.8e-7.
        assert!(error.abs() < [5e-8, 5e-8, 8e-8, 7e-7][n], "{error:e}");
    }
}

#[test]
fn exact_frequencies_of_a_bar_with_a_tip_mass() {
    let wire = Wire { length: 50.0, diameter: 0.02, mass_per_length: 1.2, ea: 5e6, ei: 0.0, laws: "" };
    let tip = 90.0;
    let scene = wire.scene(24, &[ANCHOR, &format!("[body]\nmass = {tip:?}\n")].concat());
    let (mut system, u) = at_rest(&scene, [0.0; 3]);
    let w = frequencies(&mut system, &u, 2, false);
    let ratio = wire.mass_per_length * wire.length / tip;
    for n in 0..4 {
        let beta = root(|b| b * b.tan() - ratio, f64::from(n) * PI + 1e-9, f64::from(n) * PI + FRAC_PI_2 - 1e-9);
        let exact = beta / wire.length * (wire.ea / wire.mass_per_length).sqrt();
        let error = w[n as usize] / exact - 1.0;
        println!("bar with tip mass, mode {}: {:.4} rad/s, relative error {error:.1e}", n + 1, w[n as usize]);
        assert!(error.abs() < mesh_error(beta / 24.0), "{error:e}");
    }
}

#[test]
fn exact_frequencies_of_a_cantilever() {
    let wire = Wire { length: 1.0, diameter: 0.01, mass_per_length: 0.5, ea: 1e5, ei: 2.0, laws: "compression = \"linear\"" };
    let winch = "[winch]\nposition = [0, 0, -0.105]\naxis = [0, 1, 0]\nradius = 0.1\ngain_position = 1\ngain_rate = 1\ndirection = 1\nend = \"tangent\"\n";
    let scene = wire.scene_at(0.0, 16, winch, None);
    let mut system = System::new(&scene);
    if let FirstEnd::Winch { clamp, .. } = &mut system.first {
        *clamp *= 1e4; // the scene's own gives way by 1e-4 of the first element's turn
    }
    let straight: Vec<f64> = system.arc.iter().flat_map(|s| [*s, 0.0, 0.0, 1.0, 0.0, 0.0]).collect();
    let w = frequencies(&mut system, &straight, 2, false);
    // cos β cosh β = −1.
    for (n, beta) in [1.875_104_068_7, 4.694_091_133_0, 7.854_757_438_2].into_iter().enumerate() {
        let exact = f64::powi(beta, 2) * (wire.ei / wire.mass_per_length).sqrt();
        let error = w[n] / exact - 1.0;
        println!("cantilever, mode {}: {:.4} rad/s, relative error {error:.1e}", n + 1, w[n]);
        // Cubic elements in bending add (β h)⁴/1440 to ω.
        let mesh = f64::powi(beta / 16.0, 4) / 1440.0;
        assert!(error > 0.0 && error < 1.05 * mesh, "{error:e} against {mesh:e}");
    }
}

#[test]
fn exact_large_pendulum_keeps_its_period_and_its_energy() {
    // Light and stiff beside the body's weight: the cable adds −m_l L/(12 m) = 2e-6 to the period, its stretch about 5e-6.
    let wire = Wire { length: 2.0, diameter: 1e-3, mass_per_length: 1e-5, ea: 1e6, ei: 0.0, laws: "" };
    let (mass, g, angle) = (1.0, 9.81, 80f64.to_radians());
    let scene = wire.scene(4, &format!("{ANCHOR}[body]\nmass = {mass:?}\n[solver]\ntolerance = 1e-4\n"));
    // Held aside by a force across the cable, so that the tension does not jump when it is let go.
    let held = mass * g * angle.sin();
    let mut sim = started(&scene, &pull([held * angle.cos(), 0.0, held * angle.sin()]));
    let energy = |o: &Outputs| {
        let stretch = 0.5 * o.body.tension.powi(2) * wire.length / wire.ea;
        0.5 * mass * o.body.velocity.norm_squared() + mass * g * o.body.position.z + stretch
    };
    let start = energy(sim.outputs());
    let (mut crossings, mut worst) = (Crossings::default(), 0.0f64);
    run(&mut sim, 0.01, 12.0, still, |t, o| {
        crossings.sample([t, o.body.position.x, o.body.velocity.x]);
        worst = worst.max((energy(o) - start).abs() / (mass * g * wire.length));
    });
    let period = crossings.period();
    let exact = 4.0 * (wire.length / g).sqrt() * elliptic_k((0.5 * angle).sin());
    println!(
        "pendulum from 80 deg: period {period:.6} s, closed form {exact:.6} s ({:.1e}); energy within {worst:.1e} of m g L; reported energy error {:.1e}",
        period / exact - 1.0,
        sim.outputs().solver.energy_error
    );
    assert!((period / exact - 1.0).abs() < 1e-5, "{:e}", period / exact - 1.0); // cable's mass and stretch, above
    assert!(worst < 2e-5, "{worst:e}"); // the cable's own 1e-5 of energy
}

/// A pendulum on a damped cable strained by 1e-3 is smooth: what turns must not cost steps (src/system/mixed.rs).
#[test]
fn frozen_turning_costs_few_steps() {
    let laws = "damping = { model = \"kelvin_voigt\", axial = 10, bending = 0 }";
    let wire = Wire { length: 2.0, diameter: 1e-3, mass_per_length: 1e-2, ea: 1e4, ei: 0.0, laws };
    let scene = wire.scene(4, &format!("{ANCHOR}[body]\nmass = 1.0\n[solver]\nstep_max = 0.1\n"));
    let mut sim = started(&scene, &pull([9.81 * 0.5, 0.0, 9.81 * 0.75f64.sqrt()]));
    run(&mut sim, 0.1, 20.0, still, |_, _| ());
    let steps = sim.outputs().solver.steps + sim.outputs().solver.rejected;
    println!("pendulum of 20 s: {steps} sub-steps");
    assert!(steps < 3000, "{steps}"); // 2610; 6887 with the axial force taken from the strain at every stage
}

#[test]
fn exact_dropped_body_reaches_its_terminal_velocity() {
    // A cable that weighs nothing in water and meets no drag, in a bight beside the body.
    let (rho, g, half) = (1000.0, 9.81, 10.0);
    let d: f64 = 5e-4;
    let m_l = rho * PI / 4.0 * d * d;
    let wire = Wire { length: 2.0 * half, diameter: d, mass_per_length: m_l, ea: 100.0, ei: 1e-7, laws: "damping.axial = 0.01" };
    let r = 0.05;
    let rows: Vec<Row> = (0..=400)
        .map(|i| {
            let s = wire.length * f64::from(i) / 400.0;
            let (straight, turn) = (half - 0.5 * PI * r, (s - half + 0.5 * PI * r) / r);
            if s < straight {
                (s, [0.0, 0.0, -s], [0.0, 0.0, -1.0], [0.0; 3])
            } else if turn < PI {
                (s, [r - r * turn.cos(), 0.0, -straight - r * turn.sin()], [turn.sin(), 0.0, -turn.cos()], [0.0; 3])
            } else {
                (s, [2.0 * r, 0.0, -straight + (s - straight - PI * r)], [0.0, 0.0, 1.0], [0.0; 3])
            }
        })
        .collect();
    let (mass, volume, area, cd, added) = (8.0, 1e-3, 0.012, 0.5, 0.5);
    let rest = format!(
        "{ANCHOR}[fluid]\ndensity = {rho:?}\nwaterline = 10\nadded_mass = 0\ndrag = {{ law = \"cross_flow\", cd_normal = 0, cd_tangential = 0 }}\n\
         [body]\nmass = {mass:?}\nvolume = {volume:?}\ndrag_area = {area:?}\ndrag_coefficient = {cd:?}\nadded_mass = {added:?}\n\
         [initial]\nstate = \"shape\"\nfile = \"bight.csv\"\n[solver]\ntolerance = 1e-4\n"
    );
    let scene = wire.scene_at(g, 80, &rest, Some(&shape_csv(&rows)));
    let mut sim = started(&scene, &Inputs::default());
    let terminal = (2.0 * (mass - rho * volume) * g / (rho * cd * area)).sqrt();
    let tau = (mass + added * rho * volume) * terminal / ((mass - rho * volume) * g);
    let (mut speed, mut depth) = (0.0f64, 0.0f64);
    run(&mut sim, 0.05, 3.0, still, |t, o| {
        speed = speed.max((o.body.velocity.z / terminal + (t / tau).tanh()).abs());
        depth = depth.max((o.body.position.z + terminal * tau * (t / tau).cosh().ln()).abs() / (terminal * tau));
    });
    println!("dropped body: terminal velocity {terminal:.4} m/s; v within {speed:.1e} of it, depth within {depth:.1e} of v τ");
    // The cable's 2e-4 kg/m: up to 4e-3 kg of it move with the body's 8.5 kg, 2e-4 of the inertia after half the approach.
    assert!(speed < 2.5e-4 && depth < 2.5e-4, "{speed:e} {depth:e}");
}

#[test]
fn exact_snap_of_a_moving_bar_at_a_stop() {
    let wire =
        Wire { length: 10.0, diameter: 0.01, mass_per_length: 0.5, ea: 2e5, ei: 0.0, laws: "compression = \"linear\"\ndamping.axial = 20" };
    let v = 0.8;
    let rows: Vec<Row> = vec![(0.0, [0.0; 3], [1.0, 0.0, 0.0], [v, 0.0, 0.0]), (10.0, [10.0, 0.0, 0.0], [1.0, 0.0, 0.0], [v, 0.0, 0.0])];
    let rest = [ANCHOR, "[initial]\nstate = \"shape\"\nfile = \"bar.csv\"\n[solver]\ntolerance = 1e-3\n"].concat();
    let scene = wire.scene_at(0.0, 100, &rest, Some(&shape_csv(&rows)));
    let mut sim = started(&scene, &Inputs::default());
    let speed = (wire.ea / wire.mass_per_length).sqrt();
    let transit = wire.length / speed;
    let exact = v * (wire.ea * wire.mass_per_length).sqrt();
    let (mut sum, mut count, mut least, mut most) = (0.0, 0, f64::INFINITY, 0.0f64);
    run(&mut sim, transit / 200.0, 2.4 * transit, still, |t, o| {
        if (0.3..1.7).contains(&(t / transit)) {
            (sum, count) = (sum + o.anchor.force.x, count + 1);
            (least, most) = (least.min(o.anchor.force.x), most.max(o.anchor.force.x));
        }
    });
    let mean = sum / f64::from(count);
    println!("snap: mean {mean:.3} N, least {least:.3}, most {most:.3}, v √(EA m) = {exact:.3} N");
    // Strains of 1e-3 change the wave's speed by nothing in the engineering measure; the front, widened by damping, fades by 0.3 and 1.7.
    assert!((mean / exact - 1.0).abs() < 2e-4, "{mean}");
    assert!(least > 0.99 * exact && most < 1.001 * exact, "{least} {most}");
}

#[test]
fn paper_pendulum_damping_of_the_thesis() {
    let c = 5.4e-4;
    let laws = "damping = { model = \"gradient_rate\", coefficient = 5.4e-4 }";
    let wire = Wire { length: 1.01, laws, ..NYLON };
    let scene = wire.scene(12, &[ANCHOR, "[body]\nmass = 1.33e-3\n[solver]\ntolerance = 1e-4\n"].concat());
    // Held aside by 0.02 rad, let go.
    let mut sim = started(&scene, &pull([0.02 * 1.33e-3 * 9.81, 0.0, 0.0]));
    let mut x = vec![sim.outputs().body.position.x];
    run(&mut sim, 0.01, 12.0, still, |_, o| x.push(o.body.position.x));
    // Greatest excursions to one side, by the parabola through three samples.
    let peaks: Vec<f64> = (1..x.len() - 1)
        .filter(|i| x[*i] > x[i - 1] && x[*i] >= x[i + 1] && x[*i] > 0.0)
        .map(|i| x[i] + (x[i + 1] - x[i - 1]).powi(2) / (16.0 * (x[i] - 0.5 * (x[i + 1] + x[i - 1]))))
        .collect();
    let decrement = (peaks[0] / peaks[peaks.len() - 1]).ln() / (peaks.len() - 1) as f64;
    let zeta = decrement / (4.0 * PI * PI + decrement * decrement).sqrt();
    println!("damping: ζ = {:.2} c over {} periods", zeta / c, peaks.len() - 1);
    // The thesis's 112.72 c; a rigid rotation would give c L/(2 I ω) = 112.4 c.
    assert!((zeta / c / 112.72 - 1.0).abs() < 0.02, "{}", zeta / c);
}

const P3: &str = "[anchor]\nposition = [0, 0, 0]\n[body]\nmass = 1.33e-3\n[initial]\nstate = \"straight\"\ndirection = [1, 0, 0]\n";

#[test]
fn cross_swinging_string_of_p3() {
    let rows = table(include_str!("../references/p3.csv"));
    // Tension and position: the mesh's share (prototype, exact in time: 1.4 % and 0.055 % in tension) and the integrator's at this tolerance,
    // with 10 % room.
    for (elements, tolerance, bounds) in [(20, 1e-4, [1.65e-2, 2e-6]), (40, 1e-4, [8.5e-4, 1.4e-7]), (40, 1e-3, [2.8e-3, 1e-6])] {
        let wire = Wire { laws: "compression = \"linear\"\ndamping.axial = 0.02", ..NYLON };
        let scene = wire.scene(elements, &format!("{P3}[solver]\ntolerance = {tolerance:?}\n"));
        let mut sim = started(&scene, &Inputs::default());
        let (mut tension, mut reaction, mut distance) = (vec![], vec![], vec![]);
        let mut row = rows.iter().skip(1);
        run(&mut sim, 0.002, 1.15, still, |t, o| {
            let r = row.next().expect("as many rows as steps");
            assert!((r[0] - t).abs() < 1e-9);
            tension.push((o.anchor.tension, r[3]));
            reaction.push((o.anchor.force.norm(), r[3]));
            distance.push(((o.body.position.x - r[1]).hypot(o.body.position.z - r[2]), 0.0));
        });
        let (tension, reaction, position) = (relative_rms(&tension), relative_rms(&reaction), rms(&distance));
        println!(
            "P3, {elements} elements, tolerance {tolerance:.0e}: tension rms {:.3} % (reaction {:.3} %), position rms {position:.1e} of the length, {} steps",
            100.0 * tension,
            100.0 * reaction,
            sim.outputs().solver.steps
        );
        assert!(tension < bounds[0] && position < bounds[1], "{tension:e} {position:e}");
    }
}

const P4: &str = "[anchor]\nposition = [0, 0, 0]\n[body]\nmass = 500\n[ship]\ninput = \"pose_velocity_acceleration\"\n";

#[test]
fn cross_heaved_wire_of_p4a() {
    let rows = table(include_str!("../references/p4a.csv"));
    let end = 200.11772;
    let stretched: Vec<Row> = [0.0, 200.0].map(|s| (s, [0.0, 0.0, -s * end / 200.0], [0.0, 0.0, -end / 200.0], [0.0; 3])).into();
    let rest = [P4, "[initial]\nstate = \"shape\"\nfile = \"wire.csv\"\n"].concat();
    let scene = HEAVY_WIRE.scene_at(9.81, 5, &rest, Some(&shape_csv(&stretched)));
    let inputs = heaving(2.5, 6.0);
    let mut sim = started(&scene, &inputs(0.0));
    let (mut tension, mut tip) = (vec![], vec![]);
    run(&mut sim, 0.01, 60.0, inputs, |t, o| {
        let i = (t / 0.05).round();
        if (t / 0.05 - i).abs() < 1e-6 {
            let row = &rows[i as usize];
            assert!((row[0] - t).abs() < 1e-9);
            tension.push((o.anchor.tension, row[2]));
            tip.push((o.body.position.z, row[1]));
        }
    });
    let (whole, later, tip) = (relative_rms(&tension), relative_rms(&tension[20..]), rms(&tip));
    println!(
        "P4a, 5 elements, 10 ms: tension rms {whole:.1e}, after the first second {later:.1e}, tip {tip:.1e} m, {} steps",
        sim.outputs().solver.steps
    );
    // Five elements do not follow the uneven start's waves; they die out within a second, and what is left is the reference's eighth digit.
    assert!(whole < 2e-6 && later < 1e-7, "{whole:e} {later:e}");
    assert!(tip < 5e-6, "{tip:e}"); // its five decimals
}

#[test]
fn cross_slack_and_snapping_wire_of_p4b() {
    let inputs = heaving(5.0, 4.0);
    let runs: Vec<Vec<f64>> = [10, 20, 40]
        .into_iter()
        .map(|elements| {
            let scene = HEAVY_WIRE.scene(elements, &[P4, "[solver]\ntolerance = 1e-4\n"].concat());
            let mut sim = started(&scene, &inputs(0.0));
            let mut tension = vec![];
            run(&mut sim, 0.01, 24.0, &inputs, |_, o| tension.push(o.anchor.tension));
            let peak = tension.iter().copied().fold(0.0, f64::max);
            let slack = tension.iter().copied().fold(f64::INFINITY, f64::min);
            println!(
                "P4b, {elements} elements: peak {:.2} kN, least {:.3} kN, {} steps",
                peak / 1e3,
                slack / 1e3,
                sim.outputs().solver.steps
            );
            // The published peak has three digits; sampled every 10 ms here it is 97.55 kN, every 1 ms 97.9.
            assert!((peak / 97.7e3 - 1.0).abs() < 2.5e-3, "{peak}");
            tension
        })
        .collect();
    let distance = |i: usize| relative_rms(&runs[i].iter().copied().zip(runs[2].iter().copied()).collect::<Vec<_>>());
    println!("P4b against 40 elements: 10 {:.3} %, 20 {:.3} %", 100.0 * distance(0), 100.0 * distance(1));
    // The prototype's mesh errors: 0.36 % and 0.11 %.
    assert!(distance(0) < 4e-3 && distance(1) < 1.2e-3, "{:e} {:e}", distance(0), distance(1));
}
