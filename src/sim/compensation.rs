//! What a built-in heave compensation knows of ship and cable: the point that the cable hangs from, and the cable's direction there.

use super::{SimError, Simulation};
use crate::cable::shape;
use crate::contact::surface::Surface;
use crate::math::jet::Jet;
use crate::math::lanes::{Vec3, axpy, dot};
use crate::outputs::{contact_arc, tangent_at};
use crate::system::{Environment, FirstEnd, System, gather};
use crate::winch::{DrumGeometry, Mean};

/// Bending lengths √(EI/T) from a wheel to where the cable counts as straight.
const STRAIGHT: f64 = 3.0;
/// And parts of the wheel's radius: the place where the cable leaves wanders that far when it swings by half a radian.
const WANDERS: f64 = 0.5;

impl Simulation {
    /// Remembers the start state, whose outputs are known, as the mean.
    ///
    /// # Errors
    /// [`SimError::Start`] when the algorithm cannot begin there.
    pub(super) fn begin_compensation(&mut self) -> Result<(), SimError> {
        let (Some(compensation), FirstEnd::Winch { geometry, .. }) = (&mut self.compensation, &self.system.first) else { return Ok(()) };
        let (system, time) = (&self.system, self.state.time);
        let env = system.environment(time);
        let tension = self.outputs.sheaves.last().map_or(self.outputs.winch.tension, |s| s.tension_out);
        let mean = mean(system, &env, &self.state.u, geometry, tension);
        let point = env.frame.point(&mean.point.map(Jet::constant));
        let waterline = self.scene.fluid.as_ref().map(|f| f.waterline);
        compensation.start(time, mean, &point, waterline).map_err(SimError::Start)
    }

    /// Lays the set-point's path over a step of `h` seconds from `t` on, over which the ship's is known.
    pub(super) fn compensate(&mut self, t: f64, h: f64) {
        let (Some(compensation), FirstEnd::Winch { geometry, drive, .. }) = (&mut self.compensation, &self.system.first) else { return };
        let angle = drive.state()[0];
        let metres = geometry.sense * geometry.radius;
        let down = compensation.looks_at(metres * (angle - self.state.first_angle)).map(|s| tangent_at(&self.system, &self.state.u, s));
        let point = compensation.point().map(Jet::constant);
        let ship = &self.system.ship;
        compensation.advance(t, h, |tau| ship.frame(t + tau).point(&point), down);
    }

    /// The set-point in use, among the outputs.
    pub(super) fn observe_setpoint(&mut self) {
        let (Some(compensation), FirstEnd::Winch { geometry, .. }, Some(winch)) =
            (&self.compensation, &self.system.first, &self.scene.winch)
        else {
            return;
        };
        let [metres, speed, ..] = compensation.at(self.state.time).0;
        let turn = geometry.sense / geometry.radius;
        let out = &mut self.outputs.winch;
        [out.target, out.target_rate] =
            if winch.payout_command { [metres, speed] } else { [self.state.first_angle + turn * metres, turn * speed] };
    }
}

/// The point that the cable hangs from, and its direction there, in a start state. `tension` is that of the free span, N.
///
/// The point is where the straight cable leaves the last sheave: of all points of the sheave this one alone gives the exact length, to first
/// order, when the ship turns about the sheave's axis. Without a sheave it is the drum's top, as in the thesis. The direction is taken where
/// the cable is straight, as an arm would find it that rides on the cable a little way off.
fn mean(system: &System, env: &Environment, u: &[f64], drum: &DrumGeometry, tension: f64) -> Mean {
    let last = system.surfaces.len().checked_sub(1);
    let sheave = last.filter(|_| !system.over.is_empty()).map(|index| &system.surfaces[index]);
    let (centre, radius) = sheave.map_or((drum.centre, drum.radius), |s| (s.centre, s.radius));
    // Where the cable leaves it: where contact ends, or (it may be laid on without any load) where it comes nearest.
    let leaves = last.and_then(|index| contact_arc(system, env, u, index)).map_or_else(|| nearest(system, env, u, sheave), |arc| arc.1);
    let section = &system.chain.section;
    let bend = (section.ei / tension.max(1e-12 * section.ea)).sqrt();
    let element = system.chain.lengths[system.element_at(leaves).0];
    let end = system.arc[system.arc.len() - 1];
    let arc = leaves + (STRAIGHT * bend + WANDERS * radius).max(element).min(0.5 * (end - leaves));
    let down = tangent_at(system, u, arc);
    let swing = (dot(&env.gravity, &env.gravity).sqrt() / (end - arc)).sqrt();
    let point = match sheave {
        Some(sheave) => leaving(sheave, &env.frame.to_ship(&down), &axpy(&place(system, env, u, leaves), -1.0, &centre)),
        None => axpy(&drum.centre, drum.radius, &drum.up),
    };
    Mean { point, place: env.frame.point(&point.map(Jet::constant)).map(|j| j.0[0]), down, arc, swing }
}

/// Position at arc length `s`, ship axes.
fn place(system: &System, env: &Environment, u: &[f64], s: f64) -> Vec3<f64> {
    let (e, x) = system.element_at(s);
    let r = shape::interpolate(&shape::value(x, system.chain.lengths[e]), &gather(u, e));
    env.frame.locate(&std::array::from_fn(|c| r[c] + env.base[c].0[0]))
}

/// Arc length of the node that is nearest to a sheave's axis; the cable's first end without a sheave.
fn nearest(system: &System, env: &Environment, u: &[f64], sheave: Option<&Surface>) -> f64 {
    let Some(sheave) = sheave else { return 0.0 };
    let distance = |s: f64| {
        let arm = axpy(&place(system, env, u, s), -1.0, &sheave.centre);
        let axial = dot(&arm, &sheave.basis[0]);
        dot(&arm, &arm) - axial * axial
    };
    system.arc.iter().copied().min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap_or(0.0)
}

/// The point of a sheave's circle whose tangent is `down`, on the side of the cable's point `arm` (from the centre); ship axes.
fn leaving(sheave: &Surface, down: &Vec3<f64>, arm: &Vec3<f64>) -> Vec3<f64> {
    let axis = &sheave.basis[0];
    let outwards: Vec3<f64> = std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        down[j] * axis[k] - down[k] * axis[j]
    });
    let axial = dot(arm, axis);
    let size = dot(&outwards, &outwards).sqrt();
    if size < 1e-6 {
        // Along the axis: there is no such point.
        return axpy(&sheave.centre, 1.0, arm);
    }
    let radius = (dot(arm, arm) - axial * axial).max(0.0).sqrt();
    let side = if dot(&outwards, arm) < 0.0 { -radius } else { radius };
    axpy(&axpy(&sheave.centre, axial, axis), side / size, &outwards)
}
