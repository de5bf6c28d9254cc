//! The element test ladder on whole systems: mass and weight, rigid motions, energy gradient, tangents.

mod bench;

use bench::{Wire, dense};
use fairlead::integrator::Problem;
use fairlead::math::interpolation::Quintic;
use fairlead::sim::Channel;
use fairlead::system::{FirstEnd, Matrices, System};
use nalgebra::{DMatrix, Rotation3, Vector3};
use std::f64::consts::PI;

/// Numbers near one throughout, so that no effect hides behind another.
const CORD: Wire = Wire { length: 2.0, diameter: 0.05, mass_per_length: 3.0, ea: 1e3, ei: 1.5, laws: "" };
/// Not a multiple of the elements that the kernel takes side by side.
const ELEMENTS: usize = 5;

const ANCHOR: &str = "[anchor]\nposition = [0.3, -0.2, 0.5]\n";
const BODY: &str = "[body]\nmass = 2.5\n";
const WET_BODY: &str = "[body]\nmass = 2.5\nvolume = 1.5e-3\ndrag_area = 0.02\ndrag_coefficient = 0.5\n";

/// Section laws to be tried: both pairs of measures, both axial laws, all damping models.
const LAWS: [&str; 5] = [
    "compression = \"linear\"\ndamping.axial = 4.0\ndamping.bending = 0.3",
    "compression = \"linear\"\nstrain = \"green\"\ndamping.axial = 4.0\ndamping.bending = 0.3",
    "compression = \"none\"\ndamping.axial = 4.0\ndamping.in_slack = false",
    "compression = \"none\"\nstrain = \"green\"\ndamping.axial = 4.0",
    "compression = \"linear\"\nstrain = \"green\"\ndamping = { model = \"gradient_rate\", coefficient = 0.7 }",
];

fn cord(laws: &'static str) -> Wire {
    Wire { laws, ..CORD }
}

/// A smooth curve in space with stretched and compressed parts, and the same with other numbers for rates and accelerations; zero at the
/// first node, whose motion is prescribed.
fn curve(system: &System, seed: f64, straight: f64) -> Vec<f64> {
    let (mut out, k) = (vec![], 1.0 + 0.3 * seed);
    for &s in &system.arc {
        let (a, b, c) = (k * 2.1 * s + seed, k * 1.7 * s, k * 2.9 * s + 0.4 * seed);
        out.extend([
            straight * 1.01 * s + 0.1 * (a.sin() - seed.sin()),
            0.25 * (b.cos() - 1.0),
            0.12 * (c.sin() - (0.4 * seed).sin()) - straight * 0.2 * s,
            straight * 1.01 + 0.1 * k * 2.1 * a.cos(),
            -0.25 * k * 1.7 * b.sin(),
            0.12 * k * 2.9 * c.cos() - straight * 0.2,
        ]);
    }
    out
}

/// Every 3-vector of `x` through `f`.
fn each(x: &[f64], f: impl Fn(Vector3<f64>) -> Vector3<f64>) -> Vec<f64> {
    x.chunks_exact(3).flat_map(|v| <[f64; 3]>::from(f(Vector3::new(v[0], v[1], v[2])))).collect()
}

fn balance(system: &mut System, u: &[f64], w: &[f64], a: &[f64]) -> Vec<f64> {
    let mut f = vec![0.0; u.len()];
    system.balance(0.0, u, w, a, &mut f);
    f
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m, x| m.max(x.abs()))
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |m, (a, b)| m.max((a - b).abs()))
}

/// Resultant force, and moment about the first node: Σ r × f + Σ r_p × (its conjugate).
fn resultant(u: &[f64], f: &[f64]) -> (Vector3<f64>, Vector3<f64>) {
    let v = |x: &[f64], i: usize| Vector3::new(x[i], x[i + 1], x[i + 2]);
    (0..u.len()).step_by(6).fold(Default::default(), |(force, moment), i| {
        (force + v(f, i), moment + v(u, i).cross(&v(f, i)) + v(u, i + 3).cross(&v(f, i + 3)))
    })
}

#[test]
fn exact_mass_weight_and_moments_of_inertia() {
    let fluid = "[fluid]\ndensity = 1000\nwaterline = 50\nadded_mass = 0.8\n\
                 drag = { law = \"cross_flow\", cd_normal = 1.0, cd_tangential = 0.1 }\n";
    let (l, m, body) = (CORD.length, CORD.mass_per_length, 2.5);
    for wet in [false, true] {
        let scene = CORD.scene(ELEMENTS, &[ANCHOR, if wet { WET_BODY } else { BODY }, if wet { fluid } else { "" }].concat());
        let mut system = System::new(&scene);
        let (rho, added) = if wet { (1000.0, 0.8) } else { (0.0, 0.0) };
        let displaced = rho * PI / 4.0 * CORD.diameter.powi(2);
        let n = system.size();
        let (zero, lumped) = (vec![0.0; n], body + 0.5 * rho * 1.5e-3);
        let direction = Vector3::new(0.48, 0.6, -0.64);
        let straight: Vec<f64> = system.arc.iter().flat_map(|s| [direction * *s, direction]).flat_map(<[f64; 3]>::from).collect();
        let rest = balance(&mut system, &straight, &zero, &zero);
        let (weight, moment) = resultant(&straight, &rest);
        let expected = 9.81 * ((m - displaced) * l + body - rho * 1.5e-3);
        // Sums of products of numbers of order 10: rounding.
        assert!((weight + Vector3::z() * expected).norm() < 1e-12 * expected, "{weight} against {expected}");
        let arm = direction * ((m - displaced) * l * l / 2.0 + (body - rho * 1.5e-3) * l);
        assert!((moment - arm.cross(&Vector3::new(0.0, 0.0, -9.81))).norm() < 1e-12 * expected);

        // Inertia forces of a uniform acceleration along and across the cable, by the nodes' accelerations and by the base's.
        let across = direction.cross(&Vector3::z()).normalize();
        for (way, line) in [(direction, m), (across, m + added * displaced)] {
            let total = line * l + lumped;
            let uniform: Vec<f64> = system.arc.iter().flat_map(|_| [way, Vector3::zeros()]).flat_map(<[f64; 3]>::from).collect();
            let (force, _) = resultant(&straight, &balance(&mut system, &straight, &zero, &uniform));
            assert!((force - weight + way * total).norm() < 1e-12 * expected, "{wet}: {} against {total}", (force - weight).norm());
            let ship: [Channel; 6] =
                std::array::from_fn(|i| Channel { value: 0.0, first: Some(0.0), second: Some(if i < 3 { way[i] } else { 0.0 }) });
            system.ship.start(0.0, &ship);
            system.ship.advance(0.0, 0.1, &ship);
            let (force, _) = resultant(&straight, &balance(&mut system, &straight, &zero, &zero));
            system.ship = Default::default();
            assert!((force - weight + way * total).norm() < 1e-12 * expected, "{wet}: moving base");
        }
        // Angular acceleration about the first node: I = m l³/3 + m_body l².
        let turning = each(&straight, |r| across.cross(&r));
        let (_, by_turning) = resultant(&straight, &balance(&mut system, &straight, &zero, &turning));
        let inertia = (m + added * displaced) * l.powi(3) / 3.0 + lumped * l * l;
        // The structural part is exact; three Gauss points integrate the added mass's ξ² exactly too.
        assert!((by_turning - moment + across * inertia).norm() < 1e-12 * inertia, "{} against {inertia}", (by_turning - moment).norm());
    }
}

#[test]
fn exact_straight_unstretched_cable_is_free_of_force_in_any_direction() {
    for laws in LAWS {
        let scene = cord(laws).scene_at(0.0, ELEMENTS, ANCHOR, None);
        let mut system = System::new(&scene);
        let zero = vec![0.0; system.size()];
        for d in [Vector3::x(), Vector3::new(-0.36, 0.48, 0.8), Vector3::new(0.1, -0.7, 0.3).normalize()] {
            let u: Vec<f64> = system.arc.iter().flat_map(|s| [d * *s, d]).flat_map(<[f64; 3]>::from).collect();
            let f = balance(&mut system, &u, &zero, &zero);
            // Rounding of ε = ‖r_p‖ − 1, a few 1e-16, times EA.
            assert!(largest(&f) < 1e-12 * CORD.ea, "{laws}: {:e}", largest(&f));
        }
    }
}

#[test]
fn exact_elastic_and_damping_forces_turn_with_the_cable() {
    let turn = Rotation3::from_euler_angles(0.7, -1.1, 2.3);
    for laws in LAWS {
        let scene = cord(laws).scene_at(0.0, ELEMENTS, ANCHOR, None);
        let mut system = System::new(&scene);
        let zero = vec![0.0; system.size()];
        let (u, w) = (curve(&system, 0.0, 1.0), curve(&system, 1.0, 0.0));
        let f = balance(&mut system, &u, &w, &zero);
        let turned = balance(&mut system, &each(&u, |v| turn * v), &each(&w, |v| turn * v), &zero);
        let worst = difference(&turned, &each(&f, |v| turn * v)) / largest(&f);
        assert!(worst < 1e-12, "{laws}: {worst:e}"); // rounding
        // No net force, no net moment. Not so for the moment of gradient-rate damping, which is not objective.
        let (force, moment) = resultant(&u, &f);
        assert!(force.norm() < 1e-12 * largest(&f), "{laws}");
        assert!(laws.contains("gradient") || moment.norm() < 1e-12 * largest(&f), "{laws}: {}", moment.norm());
    }
}

#[test]
fn exact_rigid_velocities_meet_no_resistance_but_from_gradient_rate_damping() {
    let spin = Vector3::new(0.9, -0.4, 1.3);
    for laws in LAWS {
        let scene = cord(laws).scene_at(0.0, ELEMENTS, ANCHOR, None);
        let mut system = System::new(&scene);
        let zero = vec![0.0; system.size()];
        let u = curve(&system, 0.0, 1.0);
        let still = balance(&mut system, &u, &zero, &zero);
        let glide: Vec<f64> = system.arc.iter().flat_map(|_| [0.7, -0.2, 1.1, 0.0, 0.0, 0.0]).collect();
        let gliding = difference(&balance(&mut system, &u, &glide, &zero), &still) / largest(&still);
        assert!(gliding < 1e-12, "{laws}: {gliding:e}"); // rounding
        let turning = each(&u, |v| spin.cross(&v));
        let f = balance(&mut system, &u, &turning, &zero);
        let resistance = difference(&f, &still) / largest(&still);
        println!("{}: force of a rigid rotation over the elastic force {resistance:.1e}", laws.lines().last().unwrap_or_default());
        if laws.contains("gradient") {
            // Power c ∫ ‖ω × r_p‖² dp, a quartic in ξ: exact under three points. A straight cable turning about a normal loses c ω² L.
            let straight: Vec<f64> = system.arc.iter().flat_map(|s| [*s, 0.0, 0.0, 1.0, 0.0, 0.0]).collect();
            let turning: Vec<f64> = system.arc.iter().flat_map(|s| [0.0, 0.0, 1.3 * s, 0.0, 0.0, 1.3]).collect();
            let f = balance(&mut system, &straight, &turning, &zero);
            let power: f64 = f.iter().zip(&turning).map(|(f, w)| f * w).sum();
            assert!((power + 0.7 * 1.3 * 1.3 * CORD.length).abs() < 1e-12, "{power}");
            assert!(resistance > 1e-4);
        } else {
            assert!(resistance < 1e-12, "{laws}: {resistance:e}"); // rounding
        }
    }
}

#[test]
fn exact_elastic_force_is_the_energy_gradient() {
    for laws in LAWS {
        let scene = cord(laws).scene_at(0.0, ELEMENTS, ANCHOR, None);
        let mut system = System::new(&scene);
        let zero = vec![0.0; system.size()];
        let u = curve(&system, 0.0, 1.0);
        let f = balance(&mut system, &u, &zero, &zero);
        let mut energy = |j: usize, h: f64| {
            let mut x = u.clone();
            x[j] += h;
            balance(&mut system, &x, &zero, &zero);
            system.tally.elastic
        };
        for j in 0..f.len() {
            // Five points: truncation h⁴ f''''/30 ~ 1e-13 f, rounding 1e-16 E/h ~ 1e-12.
            let h = 3e-4;
            let slope = (8.0 * (energy(j, h) - energy(j, -h)) - energy(j, 2.0 * h) + energy(j, -2.0 * h)) / (12.0 * h);
            assert!((slope + f[j]).abs() < 1e-9 * largest(&f), "{laws} {j}: {slope} against {}", -f[j]);
        }
    }
}

/// Worst deviations of M, D, K from central differences of F(t, u, w) − M(u) a, each over its largest entry; and of the linearization's F.
fn tangent_errors(system: &mut System, t: f64, x: [&[f64]; 3], step: f64) -> [f64; 4] {
    let n = system.size();
    let (mut m, mut f) = (Matrices::zeros(n / 6), vec![0.0; n]);
    system.linearize(t, x[0], x[1], x[2], &mut m, &mut f);
    let mut plain = vec![0.0; n];
    system.force(t, x[0], x[1], None, &mut plain);
    let [mass, damping, stiffness] = m.whole().map(|m| dense(&m));
    let exact = [stiffness, damping, mass];
    let mut errors = [0.0; 4];
    errors[3] = difference(&f, &plain) / largest(&plain);
    for (part, exact) in exact.iter().enumerate() {
        // F is linear in a.
        let h = if part == 2 { 1.0 } else { step };
        let mut differences = DMatrix::<f64>::zeros(n, n);
        let mut f = vec![0.0; n];
        for j in 3..n {
            // Five points.
            for (k, weight) in [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)] {
                let mut y = x.map(<[f64]>::to_vec);
                y[part][j] += k * h;
                system.force(t, &y[0], &y[1], Some(&y[2]), &mut f);
                for i in 3..n {
                    differences[(i, j)] -= weight * f[i] / (12.0 * h);
                }
            }
        }
        // The first node's position is prescribed: its rows are trivial, its columns meet increments that are zero.
        let worst = (3..n).flat_map(|i| (3..n).map(move |j| (i, j))).fold(0.0f64, |w, ij| w.max((differences[ij] - exact[ij]).abs()));
        errors[part] = worst / exact.amax().max(1e-300);
    }
    errors
}

fn report(name: &str, e: [f64; 4]) {
    println!("tangent of {name}: K {:.1e}, D {:.1e}, M {:.1e}, F {:.1e}", e[0], e[1], e[2], e[3]);
}

/// Truncation h⁴/30 times the fifth derivative and rounding 1e-16 EA/h, over entries of EA/l, at h = 1e-5: about 1e-10 each.
const SMOOTH: f64 = 3e-9;
/// Sums of a few hundred terms.
const ROUNDING: f64 = 1e-12;

#[test]
fn exact_tangent_in_vacuum() {
    for laws in LAWS {
        let scene = cord(laws).scene(ELEMENTS, &[ANCHOR, BODY].concat());
        let mut system = System::new(&scene);
        let (u, w, a) = (curve(&system, 0.0, 1.0), curve(&system, 1.0, 0.0), curve(&system, 2.0, 0.0));
        let e = tangent_errors(&mut system, 0.0, [&u, &w, &a], 1e-5);
        report(laws.lines().last().unwrap_or_default(), e);
        assert!(e[0] < SMOOTH && e[1] < SMOOTH && e[2] < ROUNDING && e[3] < ROUNDING, "{laws}: {e:?}");
    }
}

/// Water whose drag depends on Reynolds number, height and direction.
fn water(waterline: f64, law: &str) -> String {
    let profile = "[[-6.0, 0.3, 0.4], [0.0, 0.9, -0.3], [8.0, 1.4, 0.5]]";
    format!("[fluid]\ndensity = 1000\nviscosity = 0.05\nwaterline = {waterline:?}\nadded_mass = 0.9\n{law}\ncurrent.profile = {profile}\n")
}

const DRAG: [&str; 2] = [
    "drag = { law = \"loading_functions\", cd = [[10, 3.0], [1000, 1.0], [100000, 0.7]], amplification = 1.6 }",
    "drag = { law = \"cross_flow\", cd_normal = [[10, 3.0], [1000, 1.0], [100000, 0.7]], cd_tangential = 0.05, amplification = 1.3 }",
];

/// Moving ship and rising current, so that the fluid accelerates and the first node does too.
fn stir(system: &mut System) {
    let ship: [Channel; 6] = std::array::from_fn(|i| {
        let k = i as f64;
        Channel { value: 0.1 - 0.05 * k, first: Some(0.3 - 0.1 * k), second: Some(-0.5 + 0.25 * k) }
    });
    system.ship.start(0.0, &ship);
    system.ship.advance(0.0, 0.1, &ship);
    for (i, ramp) in system.current.iter_mut().enumerate() {
        (ramp.value, ramp.rate) = (0.2 - 0.3 * i as f64, 0.4 + 0.2 * i as f64);
    }
    if let FirstEnd::Winch { drive, .. } = &mut system.first {
        let angle = drive.state()[0];
        drive.start(0.0, angle);
        drive.advance(0.0, 0.1, &Quintic::parabola([angle + 0.5, 1.0, 0.0]));
    }
}

#[test]
fn exact_tangent_under_water() {
    for law in DRAG {
        for laws in [LAWS[0], LAWS[3]] {
            let scene = cord(laws).scene(ELEMENTS, &[ANCHOR, WET_BODY, "[ship]\ninput = \"pose\"\n", &water(4.0, law)].concat());
            let mut system = System::new(&scene);
            stir(&mut system);
            let (u, w, a) = (curve(&system, 0.0, 1.0), curve(&system, 1.0, 0.0), curve(&system, 2.0, 0.0));
            let e = tangent_errors(&mut system, 0.04, [&u, &w, &a], 1e-5);
            report(law, e);
            assert!(e[0] < SMOOTH && e[1] < SMOOTH && e[2] < ROUNDING && e[3] < ROUNDING, "{law}: {e:?}");
        }
    }
}

#[test]
fn exact_tangent_where_the_surface_cuts_elements() {
    for law in DRAG {
        let scene = cord(LAWS[0]).scene(ELEMENTS, &[ANCHOR, WET_BODY, "[ship]\ninput = \"pose\"\n", &water(0.47, law)].concat());
        let mut system = System::new(&scene);
        stir(&mut system);
        let (u, w, a) = (curve(&system, 0.0, 1.0), curve(&system, 1.0, 0.0), curve(&system, 2.0, 0.0));
        let e = tangent_errors(&mut system, 0.04, [&u, &w, &a], 1e-5);
        report(law, e);
        // K leaves out how the three points of each wet piece move with its ends, which is of the size of the rule's error on the piece.
        // Nothing else may be missing: D and M are at fixed points and must be exact.
        assert!(e[0] < 2e-5 && e[1] < SMOOTH && e[2] < ROUNDING && e[3] < ROUNDING, "{law}: {e:?}");
    }
}

/// On a drum with a little penetration that grows along the cable, then off it.
fn wound(system: &System) -> Vec<f64> {
    let FirstEnd::Winch { geometry, drive, .. } = &system.first else { panic!("a winch") };
    let frame = system.environment(0.04).frame;
    let phi = drive.angle(0.04).0[0];
    let at = |s: f64, depth: f64| {
        let (p, t) = geometry.rim(fairlead::math::jet::Jet::constant(phi + geometry.sense * s / geometry.radius));
        let p: [f64; 3] = std::array::from_fn(|c| geometry.centre[c] + (p[c].0[0] - geometry.centre[c]) * (1.0 - depth / geometry.radius));
        (Vector3::from(frame.to_world(&p)), Vector3::from(frame.to_world(&t.map(|j| j.0[0]))))
    };
    let origin = at(0.0, 0.0).0;
    let shape = system.arc.iter().flat_map(|s| {
        let (p, t) = at(*s, 0.015 * s - 0.06 * (s - 1.0).max(0.0));
        [p - origin, t * 1.01]
    });
    shape.flat_map(<[f64; 3]>::from).collect()
}

#[test]
fn exact_tangent_of_drum_contact_on_a_moving_rolling_ship() {
    for end in ["pinned", "tangent"] {
        let winch = format!(
            "[winch]\nposition = [0.4, 0.1, 0.6]\naxis = [0.1, 1.0, 0.2]\nradius = 0.6\nangle = 0.4\ngain_position = 200\ngain_rate = 20\n\
             stiffness = 2e5\ndamping = 0.2\nend = \"{end}\"\n[ship]\ninput = \"pose\"\n"
        );
        let scene = cord(LAWS[0]).scene(2 * ELEMENTS, &[&winch, BODY].concat());
        let mut system = System::new(&scene);
        stir(&mut system);
        let u = wound(&system);
        let (w, a) = (curve(&system, 1.0, 0.0), curve(&system, 2.0, 0.0));
        let e = tangent_errors(&mut system, 0.04, [&u, &w, &a], 1e-6);
        report(end, e);
        let touched = system.contact_forces.iter().filter(|f| largest(&f[..]) > 0.0).count();
        assert!((3..2 * ELEMENTS).contains(&touched), "{touched} elements touch the drum");
        // The force's derivatives are unbounded at first touch, but no point is within h of it. A clamp is the largest entry by far, so the
        // loop has a run without one.
        assert!(e[0] < SMOOTH && e[1] < SMOOTH && e[2] < ROUNDING && e[3] < ROUNDING, "{end}: {e:?}");
    }
}

#[test]
fn exact_tangent_end_holds_the_slope_along_the_moving_drum() {
    let winch = "[winch]\nposition = [0.4, 0.1, 0.6]\naxis = [0.1, 1.0, 0.2]\nradius = 0.6\nangle = 0.4\ngain_position = 200\ngain_rate = 20\n\
                 end = \"tangent\"\n[ship]\ninput = \"pose\"\n";
    let scene = cord(LAWS[0]).scene(ELEMENTS, &[winch, BODY].concat());
    let mut system = System::new(&scene);
    stir(&mut system);
    let (u, w, a) = (curve(&system, 0.0, 1.0), curve(&system, 1.0, 0.0), curve(&system, 2.0, 0.0));
    // The clamp's force is large beside what the damping changes, so rounding asks for longer differences.
    let e = tangent_errors(&mut system, 0.04, [&u, &w, &a], 5e-5);
    report("a tangent end", e);
    // The clamp is linear in the slope.
    assert!(e[0] < SMOOTH && e[1] < SMOOTH && e[2] < ROUNDING && e[3] < ROUNDING, "{e:?}");
}
