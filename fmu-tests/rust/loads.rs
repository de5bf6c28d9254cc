//! The far end: the rigid load (thesis eq. 138), a fixed end, the start by release.

mod bench;

use bench::{HEAVY_WIRE, Row, Wire, at_rest, channel, frequencies, root, run, shape_csv, started};
use fairlead::integrator::Problem;
use fairlead::outputs::Outputs;
use fairlead::scene::Scene;
use fairlead::sim::{Inputs, Simulation};
use fairlead::system::{Matrices, System};
use nalgebra::{DVector, Matrix2, Vector2, Vector3};
use std::f64::consts::{FRAC_PI_2, PI};

const G: f64 = 9.81;
const ANCHOR: &str = "[anchor]\nposition = [0, 0, 0]\n";

fn still(_: f64) -> Inputs {
    Inputs::default()
}

#[derive(Clone, Copy)]
struct Hung {
    mass: f64,
    inertia: f64,
    gravity: f64,
}

/// Configuration 1 of the thesis's section 4.1.
const THESIS: Hung = Hung { mass: 9.43, inertia: 0.269, gravity: 0.258 };

impl Hung {
    fn table(&self) -> String {
        format!("[load]\nmass = {:?}\nlength_inertia = {:?}\nlength_gravity = {:?}\n", self.mass, self.inertia, self.gravity)
    }

    /// Kinetic and potential energy; the attachment is where the body would be.
    fn energy(&self, o: &Outputs) -> f64 {
        let turning = (o.load.velocity - o.body.velocity) / self.gravity;
        let about_g = self.mass * (self.inertia.powi(2) - self.gravity.powi(2));
        0.5 * self.mass * o.load.velocity.norm_squared() + 0.5 * about_g * turning.norm_squared() + self.mass * G * o.load.position.z
    }

    fn stretch(&self, o: &Outputs) -> f64 {
        ((o.load.position - o.body.position).norm() / self.gravity - 1.0).abs()
    }

    /// θ̈ of cable (massless, rigid, length `l`) and link, angles from the vertical: M(θ) θ̈ = forces, by Lagrange.
    fn accelerations(&self, l: f64, x: &[f64; 4]) -> Vector2<f64> {
        let (c, s) = ((x[0] - x[1]).cos(), (x[0] - x[1]).sin());
        let m = Matrix2::new(l * l, l * self.gravity * c, l * self.gravity * c, self.inertia.powi(2));
        let f = Vector2::new(
            -l * self.gravity * s * x[3] * x[3] - G * l * x[0].sin(),
            l * self.gravity * s * x[2] * x[2] - G * self.gravity * x[1].sin(),
        );
        m.lu().solve(&f).expect("regular")
    }
}

fn down(angle: f64) -> String {
    format!("[initial]\nstate = \"released\"\ndirection = [{:?}, 0, {:?}]\n", angle.sin(), -angle.cos())
}

/// K(k) by the arithmetic-geometric mean.
fn elliptic_k(k: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - k * k).sqrt());
    for _ in 0..20 {
        (a, b) = (0.5 * (a + b), f64::sqrt(a * b));
    }
    FRAC_PI_2 / a
}

/// Mean period from the zero crossings of samples (t, x, ẋ).
#[derive(Default)]
struct Crossings {
    before: Option<[f64; 3]>,
    times: Vec<f64>,
}

impl Crossings {
    fn sample(&mut self, now: [f64; 3]) {
        if let Some(a) = self.before
            && a[1] * now[1] < 0.0
        {
            let (h, b) = (now[0] - a[0], now);
            let cubic = |x: f64| {
                let y = 1.0 - x;
                y * y * ((1.0 + 2.0 * x) * a[1] + x * h * a[2]) + x * x * ((1.0 + 2.0 * y) * b[1] - y * h * b[2])
            };
            self.times.push(a[0] + h * root(cubic, 0.0, 1.0));
        }
        self.before = Some(now);
    }

    fn period(&self) -> f64 {
        let swings = self.times.len() - 1;
        2.0 * (self.times[swings] - self.times[0]) / swings as f64
    }
}

/// Light and stiff: 1e-9 of the load's mass, 1e-8 of stretch.
const THREAD: Wire = Wire { length: 0.5, diameter: 1e-3, mass_per_length: 1e-8, ea: 1e9, ei: 0.0, laws: "" };

#[test]
fn paper_mass_matrix_is_eq_138() {
    let wire = Wire { mass_per_length: 0.1, ea: 1e5, ..THREAD };
    for load in [THESIS, Hung { gravity: 0.269, ..THESIS }, Hung { gravity: 0.05, ..THESIS }] {
        let (mut with, u) = at_rest(&wire.scene(2, &[ANCHOR, &load.table()].concat()), [0.0; 3]);
        let mut without = System::new(&wire.scene(2, ANCHOR));
        let n = u.len();
        let a = load.gravity / load.inertia;
        let m = load.mass;
        // Velocities of P and, across the link, of I.
        let (p, i) = (Vector3::new(0.3, -1.1, 0.7), Vector3::new(1.9, 0.4, 0.7));
        let mut w = vec![0.0; n];
        w[12..15].copy_from_slice(p.as_slice());
        w[n - 3..].copy_from_slice(((i - p) / load.inertia).as_slice());
        let mut f = vec![0.0; n];
        with.force(0.0, &u, &w, None, &mut f);
        without.force(0.0, &u[..n - 6], &w[..n - 6], None, &mut f[..n - 6]);
        let kinetic = with.tally.kinetic - without.tally.kinetic;
        let thesis = 0.5 * m * (2.0 * (1.0 - a) * p.dot(&p) + 2.0 * (a - 1.0) * p.dot(&i) + i.dot(&i));
        println!("eq. 138, a = {a:.4}: kinetic energy {kinetic:.12} J, thesis {thesis:.12} J");
        assert!((kinetic / thesis - 1.0).abs() < 1e-13, "{kinetic} {thesis}"); // rounding of a dozen products
    }
}

/// Greatest difference between M, D, K and central differences of F − M a, over the matrix's size; and whether F − M a is what linearize says.
fn tangent_defects(system: &mut System, t: f64, x: [&[f64]; 3]) -> [f64; 4] {
    let n = x[0].len();
    let (mut m, mut f) = (Matrices::zeros(n / 6), vec![0.0; n]);
    system.linearize(t, x[0], x[1], x[2], &mut m, &mut f);
    let mut plain = vec![0.0; n];
    system.force(t, x[0], x[1], None, &mut plain);
    let size = plain.iter().fold(0.0f64, |s, x| s.max(x.abs()));
    let same = f.iter().zip(&plain).fold(0.0f64, |s, (a, b)| s.max((a - b).abs())) / size;
    let mut out = [0.0; 4];
    out[3] = same;
    for (k, matrix) in [&m.stiffness, &m.damping, &m.mass].into_iter().enumerate() {
        let exact = bench::dense(matrix);
        let h = 1e-6;
        let mut worst = 0.0f64;
        for j in 0..n {
            let side = |s: f64| {
                let mut y = x.map(<[f64]>::to_vec);
                y[k][j] += s * h;
                let mut f = vec![0.0; n];
                system.clone().force(t, &y[0], &y[1], Some(&y[2]), &mut f);
                DVector::from_vec(f)
            };
            let column = (side(-1.0) - side(1.0)) / (2.0 * h);
            // Pinned rows of K and D are zero, of M the identity; the first node's own rows are zero in F.
            for i in 3..n {
                worst = worst.max((column[i] - exact[(i, j)]).abs());
            }
        }
        out[k] = worst / exact.amax().max(f64::MIN_POSITIVE);
    }
    out
}

fn ruffled(u: &[f64], seed: f64, size: f64) -> Vec<f64> {
    u.iter().enumerate().map(|(i, x)| if i < 3 { *x } else { x + size * (seed + 1.7 * i as f64).sin() }).collect()
}

#[test]
fn exact_tangents_of_the_load_and_the_fixed_end() {
    let wire = Wire { ea: 1e3, mass_per_length: 0.1, ei: 0.01, laws: "damping.axial = 2", ..THREAD };
    let ends = [THESIS.table(), "[far_end]\nposition = [0.4, 0.1, -0.2]\n".into()];
    for end in ends {
        let scene = wire.scene(3, &[ANCHOR, &end].concat());
        let (mut system, mut u) = (System::new(&scene), vec![]);
        for s in &system.arc {
            u.extend([0.3 * s, 0.2 * s, -0.9 * s, 0.3, 0.2, -0.9]);
        }
        if system.load.is_some() {
            u.extend([0.0, 0.0, 0.0, 0.6, 0.0, -0.8]);
        }
        let zero = vec![0.0; u.len()];
        let (u, w, a) = (ruffled(&u, 0.3, 0.02), ruffled(&zero, 1.1, 0.8), ruffled(&zero, 2.3, 3.0));
        let d = tangent_defects(&mut system, 0.0, [&u, &w, &a]);
        println!("tangent defects K {:.1e}, D {:.1e}, M {:.1e}, F {:.1e}", d[0], d[1], d[2], d[3]);
        // Differences over 2e-6 of forces around 1e3 N: rounding of 1e-7 N, over matrices of size 1e4, 1 and 1.
        assert!(d[0] < 1e-9 && d[1] < 2e-7 && d[2] < 2e-7 && d[3] < 1e-14, "{d:?}");
    }
}

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

#[test]
fn exact_small_swings_are_those_of_the_double_pendulum() {
    for (load, l) in [(THESIS, 0.5), (THESIS, 0.02), (Hung { gravity: 0.1, ..THESIS }, 0.5), (Hung { gravity: 0.269, ..THESIS }, 0.5)] {
        let wire = Wire { length: l, ..THREAD };
        let (mut system, u) = at_rest(&wire.scene(2, &[ANCHOR, &load.table()].concat()), [0.0; 3]);
        let w = frequencies(&mut system, &u, 0, false);
        // ω⁴ (1 − a²)... : det(g diag(l, L_PG) − ω² [[l², l L_PG], [l L_PG, L_PI²]]) = 0.
        let (i2, c) = (load.inertia.powi(2), load.gravity);
        let (p, q, r) = (i2 - c * c, -G * (i2 / l + c), G * G * c / l);
        let slow = 2.0 * r / (-q + (q * q - 4.0 * p * r).sqrt());
        let fast = if p > 1e-12 { r / p / slow } else { f64::NAN };
        let errors = [w[0] / slow.sqrt() - 1.0, w[1] / fast.sqrt() - 1.0];
        println!(
            "double pendulum, cable {l} m, a = {:.3}: slow {:.7} rad/s ({:.1e}), fast {:.4} ({:.1e})",
            c / load.inertia,
            w[0],
            errors[0],
            w[1],
            errors[1]
        );
        // Stretch 1e-7 (92 N over 1e9 N), thread 1e-9 of the mass; in the fast swing it counts (1 − a²) times as much.
        assert!(errors[0].abs() < 3e-7, "{errors:?}");
        assert!(fast.is_nan() || errors[1].abs() < 3e-7, "{errors:?}");
        if l < 0.1 {
            // Nearly the compound pendulum 2π √(L_PI²/(g L_PG)): the attachment gives by l (1 − a²)... of the pendulum's length at most.
            let compound = (G * c).sqrt() / load.inertia;
            assert!((w[0] / compound - 1.0).abs() < l / load.inertia, "{} {compound}", w[0]);
        }
    }
}

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

/// r(L) of an elastic catenary from its force at the far end, as in `statics.rs`.
fn catenary(wire: &Wire, f: Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
    let (l, w, ea) = (wire.length, wire.mass_per_length * G, wire.ea);
    let h = f.xy().norm();
    let first = f - Vector3::z() * w * l;
    let reach = ((f.z / h).asinh() - (first.z / h).asinh()) / w + l / ea;
    let z = (f.norm() - first.norm()) / w + (f.z * l - 0.5 * w * l * l) / ea;
    (Vector3::new(f.x * reach, f.y * reach, z), first)
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
