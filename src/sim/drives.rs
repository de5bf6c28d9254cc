//! What is prescribed from outside: laid over a step, kept at its begin, taken back.

use super::{Channel, Inputs, Simulation};
use crate::math::interpolation::Quintic;
use crate::ship::ShipDrive;
use crate::system::{FirstEnd, Ramp};
use crate::winch::{Committed, Compensation};

/// Everything prescribed, as a step finds it.
#[derive(Clone, Debug)]
pub(super) struct Drives {
    begin: f64,
    ship: ShipDrive,
    winch: Option<Committed>,
    compensation: Option<Compensation>,
    current: [Ramp; 2],
    body_force: [Ramp; 3],
}

/// Whether a prescribed quantity goes on as it was, but for what a ledger would not notice.
fn same(old: f64, new: f64, scale: f64) -> bool {
    (new - old).abs() <= 1e-6 * scale
}

impl Simulation {
    /// Lays the paths of everything prescribed over the next `h` seconds.
    pub(super) fn drive(&mut self, t: f64, h: f64, inputs: &Inputs) {
        self.system.ship.advance(t, h, &inputs.ship);
        self.compensate(t, h);
        let system = &mut self.system;
        let continued = |old: &[Ramp], new: &[Channel]| {
            old.iter().zip(new).all(|(old, new)| same(old.value + old.rate * (t - system.begin), new.value, new.value.abs()))
        };
        let continued = continued(&system.current, &inputs.current) && continued(&system.body_force, &inputs.body_force);
        system.begin = t;
        system.current = std::array::from_fn(|i| Ramp::from(&inputs.current[i]));
        system.body_force = std::array::from_fn(|i| Ramp::from(&inputs.body_force[i]));
        if let (FirstEnd::Winch { drive, geometry, .. }, Some(winch)) = (&mut system.first, &self.scene.winch) {
            let c = &inputs.winch;
            let given = Quintic::parabola([c.value, c.first.unwrap_or(0.0), c.second.unwrap_or(0.0)]);
            let path = match &self.compensation {
                None if !winch.payout_command => given,
                built_in => {
                    let metres = built_in.as_ref().map_or(&given, Compensation::path);
                    let start = Quintic::parabola([self.state.first_angle, 0.0, 0.0]);
                    start.plus(&metres.times(geometry.sense / geometry.radius))
                }
            };
            drive.advance(t, h, &path);
        }
        // Where the first node's acceleration jumps the cable's does not, so that relative to it the whole cable's does.
        let base = system.environment(t).base.map(|b| b.0[2]);
        for a in self.state.a.chunks_exact_mut(6).take(system.arc.len()).skip(1) {
            for c in 0..3 {
                a[c] -= base[c] - self.state.base[c];
            }
        }
        let gravity = self.scene.gravity;
        self.work.jumped = !continued || base.iter().zip(&self.state.base).any(|(new, old)| !same(*old, *new, gravity + new.abs()));
        self.state.base = base;
    }

    pub(super) fn drives(&self) -> Drives {
        let system = &self.system;
        Drives {
            begin: system.begin,
            ship: system.ship.clone(),
            winch: match &system.first {
                FirstEnd::Winch { drive, .. } => Some(drive.committed()),
                FirstEnd::Anchor(_) => None,
            },
            compensation: self.compensation,
            current: system.current,
            body_force: system.body_force,
        }
    }

    /// Back to the begin of the step that was tried last, which found these drives.
    pub(super) fn rewind(&mut self, drives: &Drives) {
        self.state.copy(&self.backup);
        let system = &mut self.system;
        system.restore_axial(&self.state.n);
        system.begin = drives.begin;
        system.ship = drives.ship.clone();
        self.compensation = drives.compensation;
        (system.current, system.body_force) = (drives.current, drives.body_force);
        if let (FirstEnd::Winch { drive, .. }, Some(winch)) = (&mut system.first, &drives.winch) {
            drive.restore(winch);
        }
    }
}
