//! The balance of momentum from outputs alone: what the forces on all supports, the weight and the input force have added to the momentum
//! must be the momentum that the drawn points and the body show.
//!
//! The centre of mass comes from the points by Simpson's rule, which is exact for cubic elements of which each has an even number of
//! intervals. Its motion over a communication step, Δ(M r)/h, is the mean momentum there; the forces' share of it is the twofold integral of
//! their line through both ends, so that the defect is of second order in the step and knows nothing of the solver's own work.

use crate::error::{Failure, Result};
use crate::host::{Instance, Variable};
use crate::report::scene::Scene;

/// Samples of first moment and force.
pub struct Momentum {
    points: Vec<[Variable; 3]>,
    body: Option<[Variable; 3]>,
    supports: Vec<[Variable; 3]>,
    pushes: [Option<usize>; 3],
    line_mass: f64,
    spacing: f64,
    body_mass: f64,
    weight: f64,
    samples: Vec<(f64, [f64; 3], [f64; 3])>,
}

impl Momentum {
    /// For a scene without water that starts from rest, whose ship, if any, does not turn; its points must be an odd number.
    ///
    /// # Errors
    /// A scene whose momentum cannot be seen from outside.
    pub fn new(instance: &Instance, scene: &Scene, inputs: &[&str]) -> Result<Self> {
        let number = |key: &str| scene.number(key);
        let count = number("outputs.points").unwrap_or(0.0) as usize;
        if count < 3 || count.is_multiple_of(2) || number("fluid.density").is_some() {
            return Err(Failure("the balance of momentum needs an odd number of points and no water".into()));
        }
        let known = |name: &str| instance.description.variable(name).cloned().ok();
        let three = |name: &str| Some([known(&format!("{name}.x"))?, known(&format!("{name}.y"))?, known(&format!("{name}.z"))?]);
        let supports = match three("ship.force_world") {
            Some(ship) => vec![Some(ship), three("far_end.force")],
            None => {
                let sheaves = (1..10).map(|i| three(&format!("sheave[{i}].force")));
                [three("winch.force"), three("anchor.force"), three("far_end.force")].into_iter().chain(sheaves).collect()
            }
        };
        let line_mass = number("cable.mass_per_length").unwrap_or(f64::NAN);
        let length = number("cable.length").unwrap_or(f64::NAN);
        let body_mass = number("body.mass").unwrap_or(0.0);
        Ok(Self {
            points: (1..=count).filter_map(|k| three(&format!("cable.point[{k}]"))).collect(),
            body: three("body"),
            supports: supports.into_iter().flatten().collect(),
            pushes: ["x", "y", "z"].map(|c| inputs.iter().position(|name| *name == format!("body.force.{c}"))),
            line_mass,
            spacing: length / (count - 1) as f64,
            body_mass,
            weight: (line_mass * length + body_mass) * number("gravity").unwrap_or(9.81),
            samples: Vec::new(),
        })
    }

    /// Takes a communication point with the inputs given there.
    ///
    /// # Errors
    /// The FMU's.
    pub fn sample(&mut self, instance: &Instance, t: f64, given: &[f64]) -> Result<()> {
        let read = |v: &[Variable; 3]| -> Result<[f64; 3]> { Ok([instance.read(&v[0])?, instance.read(&v[1])?, instance.read(&v[2])?]) };
        let (mut moment, mut force) = ([0.0; 3], [0.0, 0.0, -self.weight]);
        let last = self.points.len() - 1;
        for (k, point) in self.points.iter().enumerate() {
            let share = if k == 0 || k == last {
                1.0
            } else if k % 2 == 1 {
                4.0
            } else {
                2.0
            };
            let place = read(point)?;
            (0..3).for_each(|c| moment[c] += self.line_mass * self.spacing * share / 3.0 * place[c]);
        }
        if let Some(body) = &self.body {
            let place = read(body)?;
            (0..3).for_each(|c| moment[c] += self.body_mass * place[c]);
        }
        for support in &self.supports {
            let on_it = read(support)?;
            (0..3).for_each(|c| force[c] -= on_it[c]);
        }
        for c in 0..3 {
            force[c] += self.pushes[c].map_or(0.0, |i| given[i]);
        }
        self.samples.push((t, moment, force));
        Ok(())
    }

    /// Greatest defect of momentum over its greatest size; NaN if nothing moved.
    pub fn defect(&self) -> f64 {
        let mut gained = [0.0; 3];
        let (mut worst, mut size) = (0.0f64, 0.0f64);
        for pair in self.samples.windows(2) {
            let ((t0, m0, f0), (t1, m1, f1)) = (&pair[0], &pair[1]);
            let h = t1 - t0;
            let seen: [f64; 3] = std::array::from_fn(|c| (m1[c] - m0[c]) / h);
            let off: [f64; 3] = std::array::from_fn(|c| gained[c] + h / 6.0 * (2.0 * f0[c] + f1[c]) - seen[c]);
            let norm = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
            (worst, size) = (worst.max(norm(off)), size.max(norm(seen)));
            (0..3).for_each(|c| gained[c] += 0.5 * h * (f0[c] + f1[c]));
        }
        worst / size
    }
}
