//! The winch drum's rotation under its position controller (thesis eq. 136):
//!
//! ```text
//! φ̈ = k1 (φ_SP − φ) + k2 (φ̇_SP − φ̇),   |φ̈| and |φ̇| limited where the scene says so.
//! ```
//!
//! The drum does not feel the cable, so its motion over a communication step is known before the cable's sub-steps begin: it is integrated by
//! the classical Runge-Kutta method in steps so fine that its error (1e-9 of a set-point change) is far below the cable's, and handed on as
//! quintic pieces with continuous φ, φ̇, φ̈.

mod compensation;

pub use compensation::{Compensation, Mean};

use crate::math::interpolation::Quintic;
use crate::math::jet::Jet;
use crate::math::lanes::Vec3;
use crate::scene::Winch;
use nalgebra::Vector3;

/// Fraction of the controller's shortest time scale that one Runge-Kutta step takes; the error per step is about this⁵/120.
const FINENESS: f64 = 0.03;
/// Steps per second below which the motion is too slow to matter.
const LONGEST: f64 = 0.02;
/// No more pieces than this, however absurd the gains or the step are: they would take all memory.
const MOST: f64 = 1e6;

/// Room for this many pieces from the start: communication steps up to a second or so allocate nothing.
const PIECES: usize = 1024;

/// State and present path of the drum.
#[derive(Clone, Debug, PartialEq)]
pub struct WinchDrive {
    /// φ, φ̇ at the step's begin.
    state: [f64; 2],
    gains: [f64; 2],
    limits: [f64; 2],
    begin: f64,
    piece: f64,
    path: Vec<Quintic>,
}

/// Set-point φ_SP over a step, in the time since its begin.
pub type SetpointPath = Quintic;

impl WinchDrive {
    /// At rest at the scene's angle.
    pub fn new(winch: &Winch) -> Self {
        let mut drive = Self {
            state: [winch.angle, 0.0],
            gains: [winch.gain_position, winch.gain_rate],
            limits: [winch.max_rate, winch.max_acceleration],
            begin: 0.0,
            piece: 1.0,
            path: Vec::with_capacity(PIECES),
        };
        drive.hold(0.0);
        drive
    }

    /// Takes over changed gains and limits.
    pub fn retune(&mut self, winch: &Winch) {
        self.gains = [winch.gain_position, winch.gain_rate];
        self.limits = [winch.max_rate, winch.max_acceleration];
    }

    /// At rest at time `t`.
    pub fn start(&mut self, t: f64, angle: f64) {
        self.state = [angle, 0.0];
        self.hold(t);
    }

    fn hold(&mut self, t: f64) {
        self.begin = t;
        self.piece = 1.0;
        self.path.clear();
        self.path.push(Quintic([self.state[0], 0.0, 0.0, 0.0, 0.0, 0.0]));
    }

    fn acceleration(&self, x: &[f64; 2], sp: &SetpointPath, tau: f64, dt: f64) -> f64 {
        let [angle, rate, ..] = sp.jet(tau).0;
        let a = self.gains[0] * (angle - x[0]) + self.gains[1] * (rate - x[1]);
        // No faster than reaches the greatest rate within the step.
        let a = a.clamp(-self.limits[1], self.limits[1]);
        // Not `clamp`: where absurd gains have made the rate infinite the bounds are NaN, and the step fails by itself later.
        a.max((-self.limits[0] - x[1]) / dt).min((self.limits[0] - x[1]) / dt)
    }

    /// Lays the path over the next `h` seconds.
    pub fn advance(&mut self, t: f64, h: f64, sp: &SetpointPath) {
        let fastest = (self.gains[0].sqrt()).max(self.gains[1]).max(FINENESS / LONGEST);
        let n = (h * fastest / FINENESS).ceil().clamp(1.0, MOST) as usize;
        let dt = h / n as f64;
        self.begin = t;
        self.piece = dt;
        self.path.clear();
        let mut x = self.state;
        let mut a = self.acceleration(&x, sp, 0.0, dt);
        for i in 0..n {
            let tau = i as f64 * dt;
            let f = |x: &[f64; 2], tau: f64| [x[1], self.acceleration(x, sp, tau, dt)];
            let along = |k: &[f64; 2], s: f64| [x[0] + s * k[0], x[1] + s * k[1]];
            let k1 = f(&x, tau);
            let k2 = f(&along(&k1, 0.5 * dt), tau + 0.5 * dt);
            let k3 = f(&along(&k2, 0.5 * dt), tau + 0.5 * dt);
            let k4 = f(&along(&k3, dt), tau + dt);
            let next: [f64; 2] = std::array::from_fn(|c| x[c] + dt / 6.0 * (k1[c] + 2.0 * (k2[c] + k3[c]) + k4[c]));
            let end = self.acceleration(&next, sp, tau + dt, dt);
            self.path.push(Quintic::hermite([x[0], x[1], a], [next[0], next[1], end], dt));
            (x, a) = (next, end);
        }
    }

    /// Keeps the state at the step's end, and of the path the piece that leads there.
    pub fn commit(&mut self, t: f64) {
        let j = self.angle(t).0;
        self.state = [j[0], j[1]];
        let last = self.piece_at(t);
        self.begin += last as f64 * self.piece;
        self.path.swap(0, last);
        self.path.truncate(1);
    }

    fn piece_at(&self, t: f64) -> usize {
        let x = ((t - self.begin) / self.piece).max(0.0);
        (x as usize).min(self.path.len() - 1)
    }

    /// φ with its derivatives at `t` within the present step.
    pub fn angle(&self, t: f64) -> Jet {
        let i = self.piece_at(t);
        self.path[i].jet(t - self.begin - i as f64 * self.piece)
    }

    /// φ and φ̇ at the last commit.
    pub fn state(&self) -> [f64; 2] {
        self.state
    }

    /// Whether the drum turns during the present step.
    pub fn is_moving(&self) -> bool {
        self.path.iter().any(|p| p.0[1..].iter().any(|c| *c != 0.0))
    }

    /// What a step begins with.
    pub fn committed(&self) -> Committed {
        Committed { state: self.state, begin: self.begin, path: self.path[0] }
    }

    /// Back to what a step began with.
    pub fn restore(&mut self, from: &Committed) {
        self.state = from.state;
        self.begin = from.begin;
        self.path.clear();
        self.path.push(from.path);
    }

    /// Numbers of what the next step begins with, for snapshots.
    pub fn visit(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        let mut c = self.committed();
        c.state.iter_mut().chain([&mut c.begin]).chain(&mut c.path.0).for_each(&mut *visit);
        self.restore(&c);
    }
}

/// The drum at a communication point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Committed {
    /// φ, φ̇.
    state: [f64; 2],
    /// The path's last piece, and its begin, s: how the drum came here.
    begin: f64,
    path: Quintic,
}

/// The drum's geometry in ship axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrumGeometry {
    /// Centre, m.
    pub centre: Vec3<f64>,
    /// Unit axis.
    pub axis: Vec3<f64>,
    /// "Up" normal to the axis.
    pub up: Vec3<f64>,
    /// axis × up.
    pub side: Vec3<f64>,
    /// Radius to the cable's centreline, m.
    pub radius: f64,
    /// Sense of arc length about the axis: the cable leaves towards growing (+1) or falling (−1) angles.
    pub sense: f64,
}

impl DrumGeometry {
    /// From a checked scene; `diameter` is the cable's.
    pub fn new(winch: &Winch, diameter: f64) -> Self {
        let (up, side) = reference_directions(&winch.axis);
        Self {
            centre: winch.position.into(),
            axis: winch.axis.into(),
            up: up.into(),
            side: side.into(),
            radius: winch.radius + 0.5 * diameter,
            sense: winch.direction,
        }
    }

    /// Position of the drum's centreline surface at angle φ, ship axes, and the unit tangent in the sense of arc length.
    pub fn rim(&self, phi: Jet) -> ([Jet; 3], [Jet; 3]) {
        let (s, c) = phi.sin_cos();
        let r = self.radius;
        (
            std::array::from_fn(|i| Jet::constant(self.centre[i]) + s * (r * self.side[i]) + c * (r * self.up[i])),
            std::array::from_fn(|i| (c * self.side[i] - s * self.up[i]) * self.sense),
        )
    }

    /// Angle about the axis from "up" of a point given in ship axes relative to the centre.
    pub fn angle_of(&self, s: &Vec3<f64>) -> f64 {
        let d = |a: &Vec3<f64>| a[0] * s[0] + a[1] * s[1] + a[2] * s[2];
        d(&self.side).atan2(d(&self.up))
    }
}

/// "Up" (the ship's z made normal to the axis; the ship's x where the axis is along z) and axis × up.
pub fn reference_directions(axis: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
    let z = Vector3::z();
    let normal = z - axis * axis.dot(&z);
    let up = if normal.norm() > 1e-6 { normal.normalize() } else { (Vector3::x() - axis * axis.x).normalize() };
    (up, axis.cross(&up))
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(crate) fn winch() -> Winch {
        Winch {
            position: Vector3::zeros(),
            axis: Vector3::y(),
            radius: 0.5,
            angle: 0.2,
            gain_position: 200.0,
            gain_rate: 20.0,
            max_rate: f64::INFINITY,
            max_acceleration: f64::INFINITY,
            contact: None,
            payout_command: false,
            tangent_end: false,
            direction: -1.0,
            setpoint: crate::scene::Setpoint::External,
        }
    }

    /// Step response of φ̈ = 200(1 − φ) − 20φ̇ from 0: 1 − e^{−10t}(cos 10t + sin 10t).
    fn response(t: f64) -> f64 {
        1.0 - (-10.0 * t).exp() * ((10.0 * t).cos() + (10.0 * t).sin())
    }

    #[test]
    fn exact_step_response_whatever_the_communication_step() {
        for h in [0.003, 0.01, 0.25, 0.5] {
            let mut w = WinchDrive::new(&winch());
            w.start(0.0, 0.0);
            for i in 0..(1.0 / h) as usize {
                let t = i as f64 * h;
                w.advance(t, h, &Quintic::parabola([1.0, 0.0, 0.0]));
                for k in 0..=4 {
                    let s = t + h * f64::from(k) / 4.0;
                    assert!((w.angle(s).0[0] - response(s)).abs() < 2e-7, "{h}: {} at {s}", w.angle(s).0[0] - response(s)); // FINENESS⁴/120 a second
                }
                w.commit(t + h);
            }
        }
    }

    #[test]
    fn paper_rise_time_of_the_flume_winch() {
        // Thesis 4.3: k1 = 200, k2 = 20 give a 90 % rise time of about 0.2 s.
        let mut w = WinchDrive::new(&winch());
        w.start(0.0, 0.0);
        w.advance(0.0, 0.5, &Quintic::parabola([0.5764, 0.0, 0.0]));
        let rise = (0..500).map(|i| 1e-3 * f64::from(i)).find(|t| w.angle(*t).0[0] > 0.9 * 0.5764).unwrap();
        assert!((rise - 0.2).abs() < 0.02, "{rise}");
    }

    #[test]
    fn exact_limits_hold() {
        let mut w = WinchDrive::new(&Winch { max_rate: 2.0, max_acceleration: 15.0, ..winch() });
        w.start(0.0, 0.0);
        let (mut rate, mut acceleration) = (0.0f64, 0.0f64);
        for i in 0..200 {
            let t = 0.01 * f64::from(i);
            w.advance(t, 0.01, &Quintic::parabola([3.0, 0.0, 0.0]));
            for k in 0..10 {
                let j = w.angle(t + 0.001 * f64::from(k)).0;
                rate = rate.max(j[1].abs());
                acceleration = acceleration.max(j[2].abs());
            }
            w.commit(t + 0.01);
        }
        assert!(rate < 2.0 * 1.001 && rate > 1.99, "{rate}");
        assert!(acceleration < 15.0 * 1.05, "{acceleration}"); // quintic pieces overshoot a little where the limit sets in
        assert!((w.angle(2.0).0[0] - 3.0).abs() < 1e-3);
    }

    #[test]
    fn exact_thesis_rim_is_r_y_of_phi_times_k() {
        let g = DrumGeometry::new(&winch(), 0.02);
        let (r, t) = g.rim(Jet([0.7, 1.0, 0.0, 0.0]));
        assert!((r[0].0[0] - 0.51 * 0.7f64.sin()).abs() < 1e-15 && (r[2].0[0] - 0.51 * 0.7f64.cos()).abs() < 1e-15);
        // The cable leaves towards falling φ: its tangent opposes dr/dφ.
        assert!((t[0].0[0] * 0.51 + r[0].0[1]).abs() < 1e-15);
        assert!((g.angle_of(&[0.51 * 0.7f64.sin(), 0.3, 0.51 * 0.7f64.cos()]) - 0.7).abs() < 1e-15);
    }
}
