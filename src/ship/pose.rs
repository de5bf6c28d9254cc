//! Channels and frames.

use crate::math::interpolation::Quintic;
use crate::math::jet::Jet;
use crate::math::lanes::Vec3;
use crate::sim::Channel;

/// Samples kept per channel.
const HISTORY: usize = 3;
/// A sample closer to the last than this share of their interval replaces it instead of joining it: shortened last steps and repeated
/// communication points must not make difference quotients of rounding errors.
const CLOSE: f64 = 0.2;

/// One of the six channels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Track {
    /// Past samples of the highest known derivative, (time, value), newest last; the first `count` are valid.
    samples: [(f64, f64); HISTORY],
    count: usize,
    /// What the cable has seen at the step's begin: x, ẋ, ẍ.
    seen: [f64; 3],
    /// Over the present step, in time since its begin.
    path: Quintic,
    /// Last raw value, for unwrapping.
    raw: f64,
}

impl Track {
    fn start(&mut self, t: f64, c: &Channel) {
        let (first, second) = (c.first.unwrap_or(0.0), c.second.unwrap_or(0.0));
        *self = Self { seen: [c.value, first, second], raw: c.value, ..Self::default() };
        self.path = Quintic([c.value, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let highest = c.second.or(c.first).unwrap_or(c.value);
        self.samples[0] = (t, highest);
        self.count = 1;
    }

    /// Takes a sample at `t` and lays the path over the next `h`.
    fn advance(&mut self, t: f64, h: f64, c: &Channel, angle: bool) {
        let mut value = c.value;
        if angle {
            // A host may wrap angles; follow the nearest turn.
            let turn = std::f64::consts::TAU;
            value -= turn * ((value - self.raw) / turn).round();
        }
        self.raw = value;
        let w = c.second.or(c.first).unwrap_or(value);
        self.record(t, w);
        // w(τ) ≈ w + w1 τ + w2 τ²/2.
        let (w1, w2) = self.slopes();
        let p = match (c.first, c.second) {
            (Some(v), Some(_)) => [value, v, w / 2.0, w1 / 6.0, w2 / 24.0, 0.0],
            (Some(_), None) => [value, w, w1 / 2.0, w2 / 6.0, 0.0, 0.0],
            _ => [value, w1, w2 / 2.0, 0.0, 0.0, 0.0],
        };
        let horizon = if self.count > 1 { h.max(t - self.samples[self.count - 2].0) } else { h };
        let gap = [self.seen[0] - p[0], self.seen[1] - p[1], self.seen[2] - 2.0 * p[2]];
        self.path = Quintic(p).plus(&Quintic::hermite(gap, [0.0; 3], horizon));
    }

    fn record(&mut self, t: f64, w: f64) {
        let n = self.count;
        if n >= 1 && t <= self.samples[n - 1].0
            || n >= 2 && t - self.samples[n - 1].0 < CLOSE * (self.samples[n - 1].0 - self.samples[n - 2].0)
        {
            self.samples[n - 1] = (t.max(self.samples[n - 1].0), w);
        } else if n < HISTORY {
            self.samples[n] = (t, w);
            self.count = n + 1;
        } else {
            self.samples.rotate_left(1);
            self.samples[HISTORY - 1] = (t, w);
        }
    }

    /// First and second derivative at the newest sample of the polynomial through the samples.
    fn slopes(&self) -> (f64, f64) {
        let s = &self.samples;
        let d = |i: usize, j: usize| (s[j].1 - s[i].1) / (s[j].0 - s[i].0);
        match self.count {
            0 | 1 => (0.0, 0.0),
            2 => (d(0, 1), 0.0),
            _ => {
                let c = (d(1, 2) - d(0, 1)) / (s[2].0 - s[0].0);
                (d(1, 2) + c * (s[2].0 - s[1].0), 2.0 * c)
            }
        }
    }
}

/// The ship's motion: state at communication points, paths between them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShipDrive {
    tracks: [Track; 6],
    begin: f64,
    moving: bool,
}

/// The ship's frame at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Frame {
    /// Origin with three time derivatives.
    pub origin: [Jet; 3],
    /// R_IB = R_z(γ) R_y(β) R_x(α) with three time derivatives.
    pub rotation: [[Jet; 3]; 3],
}

impl ShipDrive {
    /// At rest or under way at the first inputs.
    pub fn start(&mut self, t: f64, channels: &[Channel; 6]) {
        self.begin = t;
        self.moving = false;
        for (track, c) in self.tracks.iter_mut().zip(channels) {
            track.start(t, c);
        }
    }

    /// Takes the inputs at `t` for the step to `t + h`.
    pub fn advance(&mut self, t: f64, h: f64, channels: &[Channel; 6]) {
        self.begin = t;
        self.moving = false;
        for (i, (track, c)) in self.tracks.iter_mut().zip(channels).enumerate() {
            track.advance(t, h, c, i >= 3);
            self.moving |= track.path.0[1..].iter().any(|c| *c != 0.0);
        }
    }

    /// Keeps what has been seen at the step's end.
    pub fn commit(&mut self, t: f64) {
        for track in &mut self.tracks {
            let j = track.path.jet(t - self.begin).0;
            track.seen = [j[0], j[1], j[2]];
        }
    }

    /// Whether the frame moves during the present step.
    pub fn is_moving(&self) -> bool {
        self.moving
    }

    /// The frame at `t`.
    #[inline(always)]
    pub fn frame(&self, t: f64) -> Frame {
        let tau = t - self.begin;
        let [x, y, z, roll, pitch, yaw] = &self.tracks;
        Frame::new([x.path.jet(tau), y.path.jet(tau), z.path.jet(tau)], [roll.path.jet(tau), pitch.path.jet(tau), yaw.path.jet(tau)])
    }

    /// Numbers of the state, for snapshots; `visit` is called with each in a fixed order.
    pub fn visit(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        visit(&mut self.begin);
        for track in &mut self.tracks {
            for (t, w) in &mut track.samples {
                visit(t);
                visit(w);
            }
            let mut count = track.count as f64;
            visit(&mut count);
            // A saved state may be forged.
            track.count = (count as usize).min(HISTORY);
            track.seen.iter_mut().chain(&mut track.path.0).for_each(&mut *visit);
            visit(&mut track.raw);
        }
        let mut moving = f64::from(u8::from(self.moving));
        visit(&mut moving);
        self.moving = moving != 0.0;
    }
}

impl Frame {
    /// From position and roll, pitch, yaw.
    #[inline(always)]
    pub fn new(origin: [Jet; 3], angles: [Jet; 3]) -> Self {
        if angles == [Jet::default(); 3] {
            let (zero, one) = (Jet::default(), Jet::constant(1.0));
            return Self { origin, rotation: [[one, zero, zero], [zero, one, zero], [zero, zero, one]] };
        }
        let (sa, ca) = angles[0].sin_cos();
        let (sb, cb) = angles[1].sin_cos();
        let (sg, cg) = angles[2].sin_cos();
        let zero = Jet::default();
        let rotation = [
            [cg * cb, cg * sb * sa - sg * ca, cg * sb * ca + sg * sa],
            [sg * cb, sg * sb * sa + cg * ca, sg * sb * ca - cg * sa],
            [zero - sb, cb * sa, cb * ca],
        ];
        Self { origin, rotation }
    }

    /// World motion of a point given in ship axes.
    #[inline(always)]
    pub fn point(&self, s: &[Jet; 3]) -> [Jet; 3] {
        let [x, y, z] = self.direction(s);
        [self.origin[0] + x, self.origin[1] + y, self.origin[2] + z]
    }

    /// World motion of a direction given in ship axes.
    #[inline(always)]
    pub fn direction(&self, s: &[Jet; 3]) -> [Jet; 3] {
        let [a, b, c] = &self.rotation;
        [a[0] * s[0] + a[1] * s[1] + a[2] * s[2], b[0] * s[0] + b[1] * s[1] + b[2] * s[2], c[0] * s[0] + c[1] * s[1] + c[2] * s[2]]
    }

    /// Rᵀ v: world components into ship axes.
    pub fn to_ship(&self, v: &Vec3<f64>) -> Vec3<f64> {
        std::array::from_fn(|i| (0..3).map(|k| self.rotation[k][i].0[0] * v[k]).sum())
    }

    /// R v: ship axes into world components.
    pub fn to_world(&self, v: &Vec3<f64>) -> Vec3<f64> {
        std::array::from_fn(|i| (0..3).map(|k| self.rotation[i][k].0[0] * v[k]).sum())
    }

    /// Ship-axes position of a world point.
    pub fn locate(&self, r: &Vec3<f64>) -> Vec3<f64> {
        self.to_ship(&std::array::from_fn(|i| r[i] - self.origin[i].0[0]))
    }

    /// Ship-axes velocity relative to the ship of a world point: d/dt Rᵀ(r − o) = Rᵀ(v − ȯ) + Ṙᵀ(r − o).
    pub fn relative_velocity(&self, r: &Vec3<f64>, v: &Vec3<f64>) -> Vec3<f64> {
        std::array::from_fn(|i| {
            (0..3)
                .map(|k| {
                    let (o, m) = (&self.origin[k].0, &self.rotation[k][i].0);
                    m[0] * (v[k] - o[1]) + m[1] * (r[k] - o[0])
                })
                .sum()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn signal(t: f64) -> [f64; 3] {
        let w = 1.3;
        [0.4 * (w * t).sin() + 0.1 * t, 0.4 * w * (w * t).cos() + 0.1, -0.4 * w * w * (w * t).sin()]
    }

    fn channels(t: f64, known: usize) -> [Channel; 6] {
        let [x, v, a] = signal(t);
        let c = Channel { value: x, first: (known > 0).then_some(v), second: (known > 1).then_some(a) };
        [c; 6]
    }

    /// Greatest position error over the second half of `n` steps of `h`.
    fn error(known: usize, h: f64) -> f64 {
        let mut ship = ShipDrive::default();
        ship.start(0.0, &channels(0.0, known));
        let n = (4.0 / h) as usize;
        let mut worst = 0.0f64;
        let mut last: Option<Jet> = None;
        for i in 0..n {
            let t = i as f64 * h;
            ship.advance(t, h, &channels(t, known));
            let begin = ship.frame(t).origin[0];
            if let Some(end) = last {
                for k in 0..3 {
                    let unit = h.powi(-(k as i32));
                    assert!((begin.0[k] - end.0[k]).abs() < 1e-12 * unit.max(1.0), "derivative {k} jumps at {t}");
                }
            }
            for j in 0..5 {
                let s = t + h * f64::from(j) / 4.0;
                if i > n / 2 {
                    worst = worst.max((ship.frame(s).origin[0].0[0] - signal(s)[0]).abs());
                }
            }
            last = Some(ship.frame(t + h).origin[0]);
            ship.commit(t + h);
        }
        worst
    }

    #[test]
    fn exact_reconstruction_is_smooth_and_of_the_stated_order() {
        for (known, order) in [(0, 3.0), (1, 4.0), (2, 5.0)] {
            let (coarse, fine) = (error(known, 0.1), error(known, 0.05));
            let measured = (coarse / fine).log2();
            assert!(measured > order - 0.3, "{known}: order {measured}, errors {coarse} {fine}");
        }
    }

    #[test]
    fn exact_shortened_steps_and_wrapped_angles_do_no_harm() {
        let mut ship = ShipDrive::default();
        let mut t = 0.0;
        let at = |t: f64| {
            let mut c = channels(t, 0);
            // Yaw turns steadily and is wrapped into ±π by its sender.
            c[5].value = (2.0 * t + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI;
            c
        };
        ship.start(0.0, &at(0.0));
        for i in 0..400 {
            let h = if i % 7 == 3 { 1e-13 } else { 0.01 };
            ship.advance(t, h, &at(t));
            if i > 5 {
                let x = ship.frame(t + h);
                assert!((x.origin[0].0[1] - signal(t + h)[1]).abs() < 0.01, "velocity {} at {t}", x.origin[0].0[1]);
                let yaw_rate = x.rotation[1][0].0[1].hypot(x.rotation[0][0].0[1]);
                assert!((yaw_rate / (ship.tracks[4].path.jet(h).0[0].cos()) - 2.0).abs() < 0.6, "yaw rate {yaw_rate} at {t}");
            }
            t += h;
            ship.commit(t);
        }
    }

    #[test]
    fn exact_rotation_follows_the_stated_order_of_angles() {
        let j = |x: f64| Jet::constant(x);
        let f = Frame::new([j(1.0), j(2.0), j(3.0)], [j(0.3), j(-0.5), j(1.1)]);
        let r = nalgebra::Rotation3::from_euler_angles(0.3, -0.5, 1.1); // roll, pitch, yaw: R_z R_y R_x
        let p = r * nalgebra::Vector3::new(0.2, -0.7, 0.4);
        let q = f.to_world(&[0.2, -0.7, 0.4]);
        for i in 0..3 {
            assert!((p[i] - q[i]).abs() < 1e-15);
        }
        assert!(f.to_ship(&q).iter().zip([0.2, -0.7, 0.4]).all(|(a, b)| (a - b).abs() < 1e-15));
    }
}
