//! Scenes, reference tables and small numerics shared by the verification tests.
#![allow(dead_code, unused_imports)] // every test binary uses its own part

pub mod load;
mod numerics;
pub mod swing;
mod wire;

pub use numerics::{elliptic_k, relative_rms, rms, root, table};
pub use wire::{G, NYLON, Row, Wire, catenary, pulley_pendulum, shape_csv};

use fairlead::equilibrium;
use fairlead::outputs::Outputs;
use fairlead::scene::Scene;
use fairlead::scene::file::SceneFile;
use fairlead::sim::{Channel, Inputs, Simulation};
use fairlead::system::{Matrices, Ramp, System};
use nalgebra::{DMatrix, Vector3};
use std::f64::consts::PI;

/// An anchor at the origin.
pub const ANCHOR: &str = "[anchor]\nposition = [0, 0, 0]\n";

/// P4's wire.
pub const HEAVY_WIRE: Wire =
    Wire { length: 200.0, diameter: 0.02, mass_per_length: 1.0, ea: 1e7, ei: 20.0, laws: "compression = \"none\"\ndamping.axial = 4e4" };

impl Wire {
    /// The scene with `rest` (further tables) and an equal mesh; `gravity` in m/s².
    pub fn scene_at(&self, gravity: f64, elements: usize, rest: &str, shape: Option<&str>) -> Scene {
        let text = self.text(gravity, elements, rest);
        match SceneFile::parse(&text, "bench.toml").and_then(|f| f.check(shape)) {
            Ok(scene) => scene,
            Err(e) => panic!("{e}\nin\n{text}"),
        }
    }

    /// On earth.
    pub fn scene(&self, elements: usize, rest: &str) -> Scene {
        self.scene_at(G, elements, rest, None)
    }
}

/// A simulation started under `inputs`.
pub fn started(scene: &Scene, inputs: &Inputs) -> Simulation {
    let mut sim = Simulation::new(scene).expect("supported");
    sim.initialize(0.0, inputs).expect("a start state");
    sim
}

/// Steps of `h` up to `end`, inputs and observer called with the time.
pub fn run(sim: &mut Simulation, h: f64, end: f64, inputs: impl Fn(f64) -> Inputs, mut observe: impl FnMut(f64, &Outputs)) {
    let first = (sim.time() / h).round() as usize;
    let last = (end / h).round() as usize;
    for i in first..last {
        let t = h * (i + 1) as f64;
        sim.step_to(t, &inputs(h * i as f64)).expect("a completed step");
        observe(t, sim.outputs());
    }
}

/// Inputs that never change.
pub fn still(_: f64) -> Inputs {
    Inputs::default()
}

/// A value with its first two derivatives.
pub fn channel(x: [f64; 3]) -> Channel {
    Channel { value: x[0], first: Some(x[1]), second: Some(x[2]) }
}

/// A constant force on the body.
pub fn pull(force: [f64; 3]) -> Inputs {
    Inputs { body_force: force.map(|value| Channel { value, ..Channel::default() }), ..Inputs::default() }
}

/// s(t) A sin(2πt/T), s a half-cosine ramp over `ramp` seconds, with two derivatives.
fn heave(t: f64, amplitude: f64, period: f64, ramp: f64) -> [f64; 3] {
    let k = PI / ramp;
    let s = if t < ramp { [0.5 * (1.0 - (k * t).cos()), 0.5 * k * (k * t).sin(), 0.5 * k * k * (k * t).cos()] } else { [1.0, 0.0, 0.0] };
    let w = 2.0 * PI / period;
    let h = [(w * t).sin(), w * (w * t).cos(), -w * w * (w * t).sin()].map(|x| amplitude * x);
    [s[0] * h[0], s[1] * h[0] + s[0] * h[1], s[2] * h[0] + 2.0 * s[1] * h[1] + s[0] * h[2]]
}

/// The ship heaves; the ramp takes two periods.
pub fn heaving(amplitude: f64, period: f64) -> impl Fn(f64) -> Inputs {
    move |t| {
        let mut inputs = Inputs { ship: [channel([0.0; 3]); 6], ..Inputs::default() };
        inputs.ship[2] = channel(heave(t, amplitude, period, 2.0 * period));
        inputs
    }
}

/// The system of a scene in equilibrium under a constant force on the body, and its shape.
pub fn at_rest(scene: &Scene, force: [f64; 3]) -> (System, Vec<f64>) {
    let mut system = System::new(scene);
    let u = settled(&mut system, scene, force);
    (system, u)
}

/// The equilibrium of a system that has been changed by hand.
pub fn settled(system: &mut System, scene: &Scene, force: [f64; 3]) -> Vec<f64> {
    system.body_force = force.map(|value| Ramp { value, rate: 0.0 });
    let load = (system.cable_mass() + system.end_mass()) * scene.gravity + Vector3::from(force).norm();
    let mut u = equilibrium::lay_out(system, 0.0, &-Vector3::z()).expect("a shape");
    equilibrium::solve(system, 0.0, &mut u, load).expect("an equilibrium");
    u
}

/// Position of the last node.
pub fn tip(u: &[f64]) -> Vector3<f64> {
    let n = u.len();
    Vector3::new(u[n - 6], u[n - 5], u[n - 4])
}

/// A square block-tridiagonal matrix as a dense one.
pub fn dense(m: &fairlead::linalg::BlockTridiagonal) -> DMatrix<f64> {
    let n = m.len();
    let mut out = DMatrix::zeros(6 * n, 6 * n);
    for i in 0..n {
        for r in 0..6 {
            for c in 0..6 {
                out[(6 * i + r, 6 * i + c)] = m.diagonal[i][r][c];
                if i > 0 {
                    out[(6 * i + r, 6 * i - 6 + c)] = m.lower[i][r][c];
                }
                if i + 1 < n {
                    out[(6 * i + r, 6 * i + 6 + c)] = m.upper[i][r][c];
                }
            }
        }
    }
    out
}

/// Angular frequencies, ascending, of small motions in world component `axis` about a shape at rest in which that component is decoupled
/// from the others. From the eigenvalues of L⁻¹ M L⁻ᵀ with K = L Lᵀ: these are 1/ω², of which the greatest, so the lowest ω, come out to
/// rounding.
pub fn frequencies(system: &mut System, u: &[f64], axis: usize, held_end: bool) -> Vec<f64> {
    use fairlead::integrator::Problem;
    let n = u.len();
    let zero = vec![0.0; n];
    let (mut m, mut f) = (Matrices::zeros(n / 6), zero.clone());
    system.linearize(0.0, u, &zero, &zero, &mut m, &mut f);
    let [mass, _, stiffness] = m.whole().map(|m| dense(&m));
    // Prescribed rows, and the slots of a load without use, have no stiffness.
    let held = |i: usize| held_end && i == n - 6 + axis;
    let rows: Vec<usize> = (0..n).filter(|i| i % 3 == axis && stiffness[(*i, *i)] != 0.0 && !held(*i)).collect();
    let pick = |m: &DMatrix<f64>| DMatrix::from_fn(rows.len(), rows.len(), |i, j| m[(rows[i], rows[j])]);
    let (k, m) = (pick(&stiffness), pick(&mass));
    let l = k.cholesky().expect("a stable shape").l();
    let half = l.solve_lower_triangular(&m).expect("regular");
    let whole = l.solve_lower_triangular(&half.transpose()).expect("regular");
    let mut w: Vec<f64> = whole.symmetric_eigenvalues().iter().map(|x| x.abs().sqrt().recip()).collect();
    w.sort_unstable_by(f64::total_cmp);
    w
}

/// Unknowns moved by up to `size` in a manner that follows from `seed` alone; the first node's position stays.
pub fn ruffled(u: &[f64], seed: f64, size: f64) -> Vec<f64> {
    u.iter().enumerate().map(|(i, x)| if i < 3 { *x } else { x + size * (seed + 1.7 * i as f64).sin() }).collect()
}
