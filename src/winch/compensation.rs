//! Built-in heave compensation: how much cable the winch is told to pay out while the ship moves. After C. Calnan, Set-point algorithms for
//! active heave compensation of towed bodies, Dalhousie University, 2016, as C. Westin (2018) uses them; rebuilt from what they do
//! (model.md 5), since neither text's formulas were at hand.
//!
//! With r_s the point that the cable hangs from (moving with the ship) and u the unit vector down the cable there, the length to be paid out
//! since the start is
//!
//! ```text
//! simplified sheave   Δl = −u₀·(r_s − r_s0)         u₀ the direction at the start
//! sheave              Δl = −u·(r_s − r_s0)          u the present direction
//! waterline           Δl = ‖r_s − r_w‖ − ‖r_s0 − r_w‖,   r_w where the line from r_s0 along u₀ meets the still water
//! ```
//!
//! The last keeps the cable below r_w where it is, and so the body's depth, which is a constant in it. Index 0 is the start of the run: that
//! is what these algorithms take for the mean. A ship that sails on takes r_s away from r_s0 for good; let the water flow past instead.
//!
//! Over a communication step the set-point is the quintic that meets Δl, Δl̇ and Δl̈ of the ship's own path at both ends: so the controller
//! gets the rate without lag, and nothing jumps.
//!
//! The present direction is measured at communication points and passes a low-pass filter, critically damped and of second order. Without one
//! the set-point would answer the cable's own transverse waves, pull at the cable in their time and so feed them: a rope without drag flutters.
//! The filter's corner lies above the swing of what hangs there ([`Smoothed`]); only the direction passes it, and the ship's motion r_s does
//! not, so that its lag costs what the direction turns in that time, times Δr_s, and no more. Until the next measurement the direction is
//! continued as the filter would with the last one held; the small difference that the next one makes dies out over one step, like the ship's
//! (`ship`).

use crate::math::interpolation::Quintic;
use crate::math::jet::Jet;
use crate::math::lanes::{Vec3, axpy};
use crate::scene::Setpoint;

/// A step shorter than this is laid as a piece of one that is as long, s: polynomials over less hold nothing but rounding.
const SHORTEST: f64 = 1e-3;

/// The filter's corner over the swing's frequency: a heavy body on a light rope swings at 1, a chain alone at 1.2 and then at 2.8.
const CORNER: f64 = 8.0;

/// What the algorithms remember of the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mean {
    /// The point that the cable hangs from, ship axes, m.
    pub point: Vec3<f64>,
    /// Where it was at the start: r_s0, world, m.
    pub place: Vec3<f64>,
    /// u₀, world.
    pub down: Vec3<f64>,
    /// Arc length at which the direction was taken, m. A metre of payout later it is taken a metre nearer to the cable's first end.
    pub arc: f64,
    /// √(g/L) of what hangs from the point by the length L, rad/s: the order of its swing.
    pub swing: f64,
}

/// A measured direction behind its filter, x'' = ω² (u − x) − 2 ω x'.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Smoothed {
    /// ω, rad/s.
    corner: f64,
    /// x and x'.
    value: Vec3<f64>,
    rate: Vec3<f64>,
    /// The last measurement.
    measured: Vec3<f64>,
}

impl Smoothed {
    /// x with its derivatives after `tau` seconds of a measurement that changes by `change` in every second.
    fn after(&self, tau: f64, change: &Vec3<f64>) -> [Jet; 3] {
        let w = self.corner;
        let decay = (-w * tau).exp();
        std::array::from_fn(|i| {
            // x follows u + b τ − 2 b/ω, where b is the change; what it is off from there dies out as (A + B τ) e^{−ωτ}.
            let b = change[i];
            let behind = if w > 0.0 { 2.0 * b / w } else { 0.0 };
            let off = self.value[i] - (self.measured[i] - behind);
            let slope = self.rate[i] - b + w * off;
            let now = off + slope * tau;
            if w == 0.0 {
                return Jet::constant(self.value[i]);
            }
            Jet([
                self.measured[i] + b * tau - behind + now * decay,
                b + (slope - w * now) * decay,
                w * (w * now - 2.0 * slope) * decay,
                w * w * (3.0 * slope - w * now) * decay,
            ])
        })
    }

    /// Takes the next measurement, `h` seconds after the last.
    fn take(&mut self, h: f64, measured: &Vec3<f64>) {
        if h > 0.0 {
            let change = std::array::from_fn(|i| (measured[i] - self.measured[i]) / h);
            let after = self.after(h, &change);
            (self.value, self.rate) = (after.map(|j| j.0[0]), after.map(|j| j.0[1]));
        }
        self.measured = *measured;
    }
}

/// One of the algorithms, with its path over the present step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compensation {
    source: Setpoint,
    mean: Mean,
    /// r_w, world, and its distance from r_s0, m; of `waterline` only.
    water: Vec3<f64>,
    length: f64,
    down: Smoothed,
    /// When the present step began, s, and Δl over it, m.
    begin: f64,
    path: Quintic,
}

impl Compensation {
    /// Before the start.
    pub fn new(source: Setpoint) -> Self {
        Self {
            source,
            mean: Mean::default(),
            water: [0.0; 3],
            length: 0.0,
            down: Smoothed::default(),
            begin: 0.0,
            path: Quintic::default(),
        }
    }

    /// Begins at time `t` (s) with the point `mean.point` moving like `point`. `waterline` is the still water's z, m.
    ///
    /// # Errors
    /// When the algorithm needs the water and the cable's mean line does not meet it from above.
    pub fn start(&mut self, t: f64, mean: Mean, point: &[Jet; 3], waterline: Option<f64>) -> Result<(), String> {
        let down = Smoothed { corner: CORNER * mean.swing, value: mean.down, rate: [0.0; 3], measured: mean.down };
        *self = Self { mean, down, begin: t, ..Self::new(self.source) };
        if self.source == Setpoint::Waterline {
            let waterline = waterline.ok_or("winch.setpoint = \"waterline\" needs a table [fluid]")?;
            let height = mean.place[2] - waterline;
            let slope = -mean.down[2];
            if height <= 0.0 || slope <= 0.0 {
                return Err(format!(
                    "winch.setpoint = \"waterline\": the cable's mean line never meets the water: it begins {:.4} m {} it and goes {} by {:.4} m in a \
                     metre; expected one that goes down to the water from above, or another winch.setpoint",
                    height.abs(),
                    if height > 0.0 { "above" } else { "below" },
                    if slope > 0.0 { "down" } else { "up" },
                    slope.abs(),
                ));
            }
            self.length = height / slope;
            self.water = axpy(&mean.place, self.length, &mean.down);
        }
        let [x, v, a, _] = self.payout(point, &mean.down.map(Jet::constant)).0;
        self.path = Quintic::parabola([x, v, a]);
        Ok(())
    }

    /// Where the direction is taken after `payout` metres, arc length in m; `None` where it does not matter.
    pub fn looks_at(&self, payout: f64) -> Option<f64> {
        (self.source == Setpoint::Sheave).then_some(self.mean.arc - payout)
    }

    /// The point that the cable hangs from, ship axes, m.
    pub fn point(&self) -> Vec3<f64> {
        self.mean.point
    }

    /// Lays the path from `t` over the next `h` seconds. `point` gives the motion of [`Self::point`] a time later, `down` the cable's present
    /// direction, where [`Self::looks_at`] asks for it.
    pub fn advance(&mut self, t: f64, h: f64, point: impl Fn(f64) -> [Jet; 3], down: Option<Vec3<f64>>) {
        self.down.take(t - self.begin, &down.unwrap_or(self.mean.down));
        let at = |tau: f64| {
            let [x, v, a, _] = self.payout(&point(tau), &self.down.after(tau, &[0.0; 3])).0;
            [x, v, a]
        };
        let span = h.max(SHORTEST);
        let from = at(0.0);
        let path = Quintic::hermite(from, at(span), span);
        let told = self.at(t).0;
        let gap = [told[0] - from[0], told[1] - from[1], told[2] - from[2]];
        self.path = path.plus(&Quintic::hermite(gap, [0.0; 3], span.max(t - self.begin)));
        self.begin = t;
    }

    /// Δl over the present step in the time since its begin, m.
    pub fn path(&self) -> &Quintic {
        &self.path
    }

    /// Δl with its derivatives at `t` within the present step.
    pub fn at(&self, t: f64) -> Jet {
        self.path.jet(t - self.begin)
    }

    fn payout(&self, point: &[Jet; 3], down: &[Jet; 3]) -> Jet {
        let from = |origin: &Vec3<f64>| -> [Jet; 3] { std::array::from_fn(|i| point[i] - Jet::constant(origin[i])) };
        let product = |a: &[Jet; 3], b: &[Jet; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        if self.source == Setpoint::Waterline {
            let way = from(&self.water);
            product(&way, &way).sqrt() - Jet::constant(self.length)
        } else {
            product(down, &from(&self.mean.place)) * -1.0
        }
    }

    /// Numbers of what the next step begins with, for snapshots.
    pub fn visit(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        let Self { source: _, mean, water, length, down, begin, path } = self;
        let measured = [&mut down.value, &mut down.rate, &mut down.measured];
        let vectors = [&mut mean.point, &mut mean.place, &mut mean.down, water].into_iter().chain(measured);
        vectors.flatten().chain([&mut mean.arc, &mut mean.swing, &mut down.corner, length, begin]).chain(&mut path.0).for_each(visit);
    }
}
