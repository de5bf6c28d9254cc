//! Orders of all methods on a nonlinear oscillator whose solution is known.

use super::*;
use crate::scene;

/// (1 + u²) ü = −4u − 0.3u̇ − u³ + cos 3t + …, one node whose six unknowns are the same oscillator six times, the forcing chosen so that
/// u = sin t + 0.2 solves it exactly.
struct Oscillator {
    varying: bool,
}

impl Oscillator {
    fn exact(t: f64) -> [f64; 3] {
        [t.sin() + 0.2, t.cos(), -t.sin()]
    }
    fn mass(&self, u: f64) -> f64 {
        if self.varying { 1.0 + u * u } else { 1.5 }
    }
    fn spring(u: f64, w: f64) -> f64 {
        -4.0 * u - 0.3 * w - u * u * u - 0.2 * w * u
    }
    fn f(&self, t: f64, u: f64, w: f64) -> f64 {
        let [x, v, a] = Self::exact(t);
        Self::spring(u, w) + self.mass(x) * a - Self::spring(x, v)
    }
}

impl Problem for Oscillator {
    fn size(&self) -> usize {
        6
    }
    fn force(&mut self, t: f64, u: &[f64], w: &[f64], a: Option<&[f64]>, f: &mut [f64]) {
        for i in 0..6 {
            f[i] = self.f(t, u[i], w[i]) - a.map_or(0.0, |a| self.mass(u[i]) * a[i]);
        }
    }
    fn stage_force(&mut self, _: Stage, t: f64, u: &[f64], w: &[f64], a: Option<&[f64]>, f: &mut [f64]) {
        self.force(t, u, w, a, f);
    }
    fn linearize(&mut self, t: f64, u: &[f64], w: &[f64], a: &[f64], m: &mut Matrices, f: &mut [f64]) {
        self.force(t, u, w, None, f);
        m.clear(std::iter::empty());
        for i in 0..6 {
            m.mass.add(0, 0, i, i, self.mass(u[i]));
            m.damping.add(0, 0, i, i, 0.3 + 0.2 * u[i]);
            let turn = if self.varying { 2.0 * u[i] * a[i] } else { 0.0 };
            m.stiffness.add(0, 0, i, i, 4.0 + 3.0 * u[i] * u[i] + 0.2 * w[i] + turn);
        }
    }
    fn time_derivative(&mut self, t: f64, _: f64, u: &[f64], w: &[f64], force: &[f64], f: &mut [f64]) -> bool {
        let d = 1e-6;
        for i in 0..6 {
            f[i] = (self.f(t + d, u[i], w[i]) - force[i]) / d;
        }
        true
    }
    fn mass_varies(&self) -> bool {
        self.varying
    }
    fn relinearize(&mut self, _: &[f64], _: &[f64], _: &[f64], _: &mut Matrices, _: &mut [f64]) {}
    fn accept(&mut self, _: &[f64], _: &[f64], _: &[f64]) {}
    fn iterate(&mut self, _: bool, t: f64, u: &[f64], w: &[f64], a: &[f64], f: &mut [f64]) {
        self.force(t, u, w, Some(a), f);
    }
    fn settle(&mut self, _: &[f64], _: &[f64]) {}
    fn adopt(&mut self, _: &[f64], _: &[f64]) {}
    fn rewind(&mut self) {}
    fn size_of(&self, energy: f64) -> f64 {
        // Newton's method is to leave next to nothing.
        energy.sqrt() * 1e9
    }
    fn error_size(&self, e: &[f64], _: &[f64]) -> f64 {
        e[0].abs()
    }
}

/// Greatest error at t = 2 of position, velocity and, if the method has it, acceleration.
fn error(which: scene::Method, varying: bool, steps: usize) -> f64 {
    let mut problem = Oscillator { varying };
    let mut method = Method::new(which, 6, &[]);
    let mut f = vec![0.0; 6];
    let [x, v, a] = Oscillator::exact(0.0);
    let mut y = [vec![x; 6], vec![v; 6], vec![a; 6]];
    let h = 2.0 / steps as f64;
    for i in 0..steps {
        let t = i as f64 * h;
        let from = [&y[0][..], &y[1], &y[2]];
        method.begin(&mut problem, t, from, &mut f);
        assert!(matches!(method.attempt(&mut problem, t, h, from, &f), Trial::Error(e) if e.is_finite()));
        y = method.state().map(<[f64]>::to_vec);
    }
    let [x, v, a] = Oscillator::exact(2.0);
    let acceleration = if varying || method.carries_over() { (y[2][3] - a).abs() } else { 0.0 };
    (y[0][3] - x).abs().max((y[1][3] - v).abs()).max(acceleration)
}

#[test]
fn exact_orders_are_the_declared_ones() {
    use scene::Method::{Esdirk3, Esdirk4, Radau5, Rodas4, TrBdf2};
    let all = [
        (Rodas4, super::Rodas4::ORDER),
        (TrBdf2, TR_BDF2.order),
        (Esdirk3, ESDIRK3.order),
        (Esdirk4, ESDIRK4.order),
        (Radau5, super::Radau5::ORDER),
    ];
    for (which, order) in all {
        for varying in [false, true] {
            let (coarse, fine) = (error(which, varying, 20), error(which, varying, 40));
            let found = (coarse / fine).log2();
            println!("{which:?}, mass varies {varying}: order {found:.2}, errors {coarse:.1e} {fine:.1e}");
            // The next order's share at these steps.
            assert!(found > order as f64 - 0.3, "{which:?}, varying {varying}: order {found}, errors {coarse} {fine}");
        }
    }
}

#[test]
fn exact_kept_factors_serve_many_steps() {
    let mut problem = Oscillator { varying: true };
    let mut method = Method::new(scene::Method::Esdirk4, 6, &[]);
    let mut f = vec![0.0; 6];
    let [x, v, a] = Oscillator::exact(0.0);
    let mut y = [vec![x; 6], vec![v; 6], vec![a; 6]];
    for i in 0..100 {
        let (t, h) = (0.02 * f64::from(i), 0.02);
        let from = [&y[0][..], &y[1], &y[2]];
        method.begin(&mut problem, t, from, &mut f);
        assert!(matches!(method.attempt(&mut problem, t, h, from, &f), Trial::Error(_)));
        y = method.state().map(<[f64]>::to_vec);
    }
    let [solves, tangents, factorizations] = method.counts();
    println!("{solves} solves, {tangents} tangents, {factorizations} factorizations in 100 steps of 5 stages");
    // Steps of 0.02 change the tangent little; a factorization at every step would be 100, one iteration a stage 500 solves.
    assert!(tangents < 10 && factorizations < 10 && solves < 500 * 7);
}
