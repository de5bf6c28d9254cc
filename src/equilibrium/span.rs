//! Start shapes between two fixed ends.

use super::layout::Way;
use crate::integrator::Problem;
use crate::linalg::BlockTridiagonal;
use crate::system::{Matrices, System};
use nalgebra::Vector3;

/// How far, over the cable's length, a given start shape may end from the far end; what there is, is spread over the whole length.
const GAP: f64 = 1e-5;
/// A span this many times the cable's length is a mistake.
const STRETCH: f64 = 2.0;
/// Least width of the first shape over the length of cable: a bight must not be a fold.
const WIDTH: f64 = 0.02;
/// Time (s) over which the quasi-static velocity's inertia counts for nothing.
const SLOWLY: f64 = 1e3;

fn target(system: &System, t: f64) -> Option<[Vector3<f64>; 2]> {
    let motion = system.far_end?.motion(&system.environment(t).base);
    Some([motion[0].into(), motion[1].into()])
}

/// A rope of given length between the origin and another point: catenary in the plane of `down`, straight (and stretched) if it is too short.
struct Rope {
    end: Vector3<f64>,
    length: f64,
    /// Horizontal unit vector, down, parameter a (0: straight), arc length from the lowest point at the origin, shear.
    across: Vector3<f64>,
    down: Vector3<f64>,
    a: f64,
    s0: f64,
    shear: f64,
}

impl Rope {
    fn new(end: Vector3<f64>, length: f64, down: Vector3<f64>) -> Self {
        let fall = end.dot(&down);
        let flat = end - down * fall;
        let (width, across) = match flat.norm() {
            h if h > 1e-12 * length => (h, flat / h),
            _ => (0.0, Vector3::x()),
        };
        let mut rope = Self { end, length, across, down, a: 0.0, s0: 0.0, shear: 0.0 };
        let slack = length * length - fall * fall;
        if slack > width * width * (1.0 + 1e-9) {
            // sinh(y)/y = √(L² − v²)/h, y = h/(2a); by Newton's method on the logarithm, monotone from above.
            let wide = width.max(WIDTH * length).min(0.999_999 * slack.sqrt());
            let ratio = slack.sqrt() / wide;
            let mut y = (6.0 * (ratio - 1.0)).sqrt().max(1e-4).min(1.0 + 2.0 * ratio.ln());
            for _ in 0..100 {
                let f = (y.sinh() / y).ln() - ratio.ln();
                let next = y - f / (1.0 / y.tanh() - 1.0 / y);
                let done = (next - y).abs() < 1e-12 * y;
                y = next.max(0.1 * y);
                if done {
                    break;
                }
            }
            rope.a = wide / (2.0 * y);
            // Depth below the level of the lowest point: tanh of the mid parameter is −v/L.
            let mid = (-fall / length).clamp(-1.0 + 1e-15, 1.0 - 1e-15).atanh();
            rope.s0 = rope.a * (mid - y).sinh();
            rope.shear = (width - wide) / length;
        }
        rope
    }

    /// Position and slope at `s`.
    fn at(&self, s: f64) -> (Vector3<f64>, Vector3<f64>) {
        if self.a == 0.0 {
            return (self.end * (s / self.length), self.end / self.length);
        }
        // From the lowest point: x = a asinh(σ/a), height √(a² + σ²).
        let (from, to) = (self.s0, self.s0 + s);
        let h = |x: f64| x.hypot(self.a);
        let x = self.a * ((to / self.a).asinh() - (from / self.a).asinh()) + self.shear * s;
        let fall = h(from) - h(to);
        (self.across * x + self.down * fall, self.across * (self.a / h(to) + self.shear) - self.down * (to / h(to)))
    }
}

/// Positions relative to the first node and slopes, six per node: around the drum as far as needed, then a catenary to the far end.
///
/// # Errors
/// When the far end is out of the cable's reach.
pub fn lay_between(system: &System, t: f64, down: &Vector3<f64>) -> Result<Vec<f64>, String> {
    let Some([far, _]) = target(system, t) else { return Err("the scene has no [far_end]".into()) };
    let length = system.arc_of(system.nodes());
    if far.norm() > STRETCH * length {
        return Err(format!(
            "far_end.position is {:.6} m from the cable's first end, more than {STRETCH} times cable.length = {length} m",
            far.norm()
        ));
    }
    // Where the cable leaves the last wheel depends on its direction there, and that on where it leaves.
    let mut direction = if far.norm() > 0.0 { far.normalize() } else { *down };
    let mut way = Way::new(system, t, &direction)?;
    let mut rope = Rope::new(far, length, *down);
    for _ in 0..20 {
        let left = way.leaves();
        rope = Rope::new(far - left, (length - way.arc).max(1e-3 * length), *down);
        direction = rope.at(0.0).1.normalize();
        way = Way::new(system, t, &direction)?;
        if way.arc == 0.0 {
            break;
        }
    }
    let left = way.leaves();
    let mut out = Vec::with_capacity(6 * system.nodes());
    for &s in &system.arc {
        let (p, slope) = way.at(s).unwrap_or_else(|| {
            let (p, slope) = rope.at(s - way.arc);
            (left + p, slope)
        });
        out.extend(p.iter().chain(&slope));
    }
    let n = out.len() - 6;
    out[n..n + 3].copy_from_slice(far.as_slice());
    out.resize(6 * system.nodes(), 0.0);
    Ok(out)
}

/// Joins a given shape to the far end.
///
/// # Errors
/// When it ends elsewhere.
pub fn meet(system: &System, t: f64, u: &mut [f64]) -> Result<(), String> {
    let Some([far, _]) = target(system, t) else { return Ok(()) };
    let (length, at) = (system.arc_of(system.nodes()), 6 * (system.arc.len() - 1));
    let gap = far - Vector3::new(u[at], u[at + 1], u[at + 2]);
    if gap.norm() > GAP * length {
        let base = system.environment(t).base.map(|j| j.0[0]);
        let [x, y, z]: [f64; 3] = std::array::from_fn(|c| u[at + c] + base[c]);
        return Err(format!(
            "the start shape ends at ({x:.6}, {y:.6}, {z:.6}) m, {:.3e} m from far_end.position; expected at most {:.1e} m; change [initial] \
             direction or file, or take state = \"equilibrium\"",
            gap.norm(),
            GAP * length
        ));
    }
    for (x, s) in u.chunks_exact_mut(6).zip(&system.arc) {
        for c in 0..3 {
            x[c] += gap[c] * s / length;
            x[3 + c] += gap[c] / length;
        }
    }
    Ok(())
}

/// Velocities relative to the first node with which the cable follows its ends: linear along it.
pub fn glide(system: &System, t: f64, w: &mut [f64]) {
    let Some([_, velocity]) = target(system, t) else { return };
    let length = system.arc_of(system.nodes());
    for (x, s) in w.chunks_exact_mut(6).zip(&system.arc) {
        for c in 0..3 {
            (x[c], x[3 + c]) = (velocity[c] * s / length, velocity[c] / length);
        }
    }
}

/// The same in equilibrium: the rate of change of the equilibrium itself as the far end moves, K w = 0 off the prescribed rows. So a run
/// that begins with a ship under way begins without a shock.
pub fn follow(system: &mut System, t: f64, u: &[f64], w: &mut [f64]) {
    let Some([_, velocity]) = target(system, t) else { return };
    w.fill(0.0);
    if velocity == Vector3::zeros() {
        return;
    }
    let at = 6 * (system.arc.len() - 1);
    w[at..at + 3].copy_from_slice(velocity.as_slice());
    let zero = vec![0.0; u.len()];
    let (mut m, mut rest) = (Matrices::zeros(u.len() / 6), zero.clone());
    system.frozen = true;
    system.linearize(t, u, &zero, &zero, &mut m, &mut rest);
    system.frozen = false;
    rest.fill(0.0);
    m.multiply_add([None, None, Some((-SLOWLY * SLOWLY, w))], &mut rest);
    let mut a = BlockTridiagonal::zeros(u.len() / 6);
    m.sum([1.0, SLOWLY, SLOWLY * SLOWLY], &mut a);
    if a.factor().is_ok() {
        a.solve(&mut rest);
        w.iter_mut().zip(&rest).for_each(|(w, r)| *w += r);
    }
    if !w.iter().all(|x| x.is_finite()) {
        glide(system, t, w);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_ropes_reach_their_end_with_their_length() {
        let down = -Vector3::z();
        for end in [[3.0, 1.0, 2.0], [0.5, 0.0, -3.9], [0.0, 0.0, -1.0], [4.0, 0.0, 0.0], [0.0, 0.0, 0.0], [3.9999, 0.0, 0.1]] {
            let end = Vector3::from(end);
            let rope = Rope::new(end, 4.0, down);
            assert!((rope.at(4.0).0 - end).norm() < 1e-9, "{end}: {}", rope.at(4.0).0); // Newton's end, times the length
            assert!(rope.at(0.0).0.norm() < 1e-15);
            for s in [0.3, 1.9, 3.6] {
                let d = (rope.at(s + 1e-6).0 - rope.at(s - 1e-6).0) / 2e-6;
                assert!((d - rope.at(s).1).norm() < 1e-6, "{end} at {s}"); // curvature of the bight, 1e4/m², times h²
            }
        }
    }
}
