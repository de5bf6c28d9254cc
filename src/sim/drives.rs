//! What is prescribed from outside: laid over a step, kept at its begin, taken back.

use super::{Inputs, Simulation};
use crate::ship::ShipDrive;
use crate::system::{FirstEnd, Ramp};
use crate::winch::Committed;

/// Everything prescribed, as a step finds it.
#[derive(Clone, Debug)]
pub(super) struct Drives {
    begin: f64,
    ship: ShipDrive,
    winch: Option<Committed>,
    current: [Ramp; 2],
    body_force: [Ramp; 3],
}

impl Simulation {
    /// Lays the paths of everything prescribed over the next `h` seconds.
    pub(super) fn drive(&mut self, t: f64, h: f64, inputs: &Inputs) {
        let system = &mut self.system;
        system.begin = t;
        system.ship.advance(t, h, &inputs.ship);
        system.current = std::array::from_fn(|i| Ramp::from(&inputs.current[i]));
        system.body_force = std::array::from_fn(|i| Ramp::from(&inputs.body_force[i]));
        if let (FirstEnd::Winch { drive, geometry, .. }, Some(winch)) = (&mut system.first, &self.scene.winch) {
            let c = &inputs.winch;
            let mut path = [c.value, c.first.unwrap_or(0.0), c.second.unwrap_or(0.0)];
            if winch.payout_command {
                let k = geometry.sense / geometry.radius;
                path = [self.state.first_angle + k * path[0], k * path[1], k * path[2]];
            }
            drive.advance(t, h, &path);
        }
        // Where the first node's acceleration jumps the cable's does not, so that relative to it the whole cable's does.
        let base = system.environment(t).base.map(|b| b.0[2]);
        for a in self.state.a.chunks_exact_mut(6).take(system.arc.len()).skip(1) {
            for c in 0..3 {
                a[c] -= base[c] - self.state.base[c];
            }
        }
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
        (system.current, system.body_force) = (drives.current, drives.body_force);
        if let (FirstEnd::Winch { drive, .. }, Some(winch)) = (&mut system.first, &drives.winch) {
            drive.restore(winch);
        }
    }
}
