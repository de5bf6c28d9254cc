//! The rigid load's equations (thesis eq. 138): mass matrix, tangent, small swings.

mod bench;

use bench::load::{Hung, THESIS, THREAD};
use bench::{ANCHOR, G, Wire, at_rest, frequencies, ruffled};
use fairlead::integrator::Problem;
use fairlead::system::{Matrices, System};
use nalgebra::{DVector, Vector3};

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
    let [mass, damping, stiffness] = m.whole();
    for (k, matrix) in [&stiffness, &damping, &mass].into_iter().enumerate() {
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
