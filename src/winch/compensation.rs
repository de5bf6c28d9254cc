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

#[cfg(test)]
mod tests {
    use super::*;

    /// Some motion of the point, with its derivatives.
    fn point(t: f64) -> [Jet; 3] {
        [(0.4, 1.1), (0.3, 0.7), (0.5, 1.3)].map(|(a, w)| {
            let (s, c) = (w * t).sin_cos();
            Jet([a * s, a * w * c, -a * w * w * s, -a * w * w * w * c])
        })
    }

    fn begun(source: Setpoint) -> Compensation {
        let mean = Mean { point: [0.0; 3], place: [0.0; 3], down: [0.6, 0.0, -0.8], arc: 3.0, swing: 0.5 };
        let mut c = Compensation::new(source);
        c.start(0.0, mean, &point(0.0), Some(-4.0)).expect("a line down to the water");
        c
    }

    #[test]
    fn exact_the_filter_solves_its_equation_and_goes_on_from_step_to_step() {
        let begin = Smoothed { corner: 3.0, value: [0.1, 0.2, -0.9], rate: [0.3, -0.1, 0.2], measured: [0.15, 0.1, -0.95] };
        let change = [0.4, -0.3, 0.1];
        for k in 0..20 {
            let tau = 0.1 * f64::from(k);
            for (i, x) in begin.after(tau, &change).iter().enumerate() {
                let u = begin.measured[i] + tau * change[i];
                assert!((x.0[2] - (9.0 * (u - x.0[0]) - 6.0 * x.0[1])).abs() < 1e-14);
                assert!((x.0[3] - (9.0 * (change[i] - x.0[1]) - 6.0 * x.0[2])).abs() < 1e-13);
            }
        }
        let start = begin.after(0.0, &change);
        assert!((0..3).all(|i| (start[i].0[0] - begin.value[i]).abs() < 1e-15 && (start[i].0[1] - begin.rate[i]).abs() < 1e-15));
        let at = |tau: f64| std::array::from_fn(|i| begin.measured[i] + tau * change[i]);
        let [mut once, mut often] = [begin; 2];
        once.take(0.7, &at(0.7));
        [0.1, 0.15, 0.4, 0.7].into_iter().fold(0.0, |from, to| {
            often.take(to - from, &at(to));
            to
        });
        assert!((0..3).all(|i| (once.value[i] - often.value[i]).abs() < 1e-15 && (once.rate[i] - often.rate[i]).abs() < 1e-14));
        // Without gravity nothing swings: the direction stays what it was.
        let mut still = Smoothed { corner: 0.0, value: [0.0, 0.0, -1.0], rate: [0.0; 3], measured: [0.0, 0.0, -1.0] };
        still.take(0.1, &[0.1, 0.0, -0.9]);
        assert_eq!(still.value, [0.0, 0.0, -1.0]);
    }

    #[test]
    fn exact_the_path_meets_its_definition_at_both_ends() {
        for source in [Setpoint::SimplifiedSheave, Setpoint::Waterline] {
            let mut c = begun(source);
            let mut t = 0.0;
            for h in [0.1, 0.02, 1e-9, 0.25, 0.1] {
                c.advance(t, h, |tau| point(t + tau), None);
                for end in [t, t + h] {
                    let r = point(end).map(|j| j.0);
                    let expected = match source {
                        // Down to the water 4 m below: 5 m along (0.6, 0, −0.8).
                        Setpoint::Waterline => (r[0][0] - 3.0).hypot(r[1][0]).hypot(r[2][0] + 4.0) - 5.0,
                        _ => -0.6 * r[0][0] + 0.8 * r[2][0],
                    };
                    assert!((c.at(end).0[0] - expected).abs() < 1e-12, "{source:?} at {end}");
                    let rate = match source {
                        Setpoint::Waterline => {
                            ((r[0][0] - 3.0) * r[0][1] + r[1][0] * r[1][1] + (r[2][0] + 4.0) * r[2][1]) / (expected + 5.0)
                        }
                        _ => -0.6 * r[0][1] + 0.8 * r[2][1],
                    };
                    assert!((c.at(end).0[1] - rate).abs() < 1e-9, "{source:?} at {end}");
                }
                t += h;
            }
        }
    }

    #[test]
    fn exact_nothing_jumps_when_the_direction_does() {
        let mut c = begun(Setpoint::Sheave);
        let mut t = 0.0;
        let steps = [0.05, 0.05, 1e-9, 0.05, 0.001, 0.1, 0.1, 0.1];
        for (i, h) in steps.into_iter().enumerate() {
            let before = c.at(t).0;
            let u = if i < 2 { [0.6, 0.0, -0.8] } else { [0.5, 0.2, -0.84] };
            c.advance(t, h, |tau| point(t + tau), Some(u));
            let after = c.at(t).0;
            // Rounding of coefficients over the shortest span, 1e-16/h².
            for k in 0..3 {
                assert!((before[k] - after[k]).abs() < 1e-9, "derivative {k} at {t}: {} {}", before[k], after[k]);
            }
            assert!(after[2].abs() < 5.0, "{}", after[2]);
            t += h;
        }
        // The filter lets it pass within seconds: corner 4/s.
        for _ in 0..60 {
            c.advance(t, 0.1, |tau| point(t + tau), Some([0.5, 0.2, -0.84]));
            t += 0.1;
        }
        let r = point(t).map(|j| j.0[0]);
        let expected = -(0.5 * r[0] + 0.2 * r[1] - 0.84 * r[2]);
        assert!((c.at(t).0[0] - expected).abs() < 1e-6, "{} {expected}", c.at(t).0[0]);
    }

    #[test]
    fn exact_a_line_that_rises_or_begins_under_water_is_refused() {
        for (down, waterline, part) in [
            ([0.6, 0.0, 0.8], -4.0, "begins 4.0000 m above it and goes up by 0.8000 m"),
            ([0.6, 0.0, -0.8], 1.0, "begins 1.0000 m below it and goes down by 0.8000 m"),
        ] {
            let mean = Mean { down, ..Mean::default() };
            let error = Compensation::new(Setpoint::Waterline).start(0.0, mean, &point(0.0), Some(waterline)).unwrap_err();
            assert!(error.contains(part), "{error}");
            assert!(Compensation::new(Setpoint::Sheave).start(0.0, mean, &point(0.0), None).is_ok());
        }
    }
}
