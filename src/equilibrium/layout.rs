//! First shapes: the shortest way along drum and sheaves, then straight.

use crate::system::{FirstEnd, System};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::TAU;

/// Rounds in which neighbouring tangent points are fitted to each other.
const ROUNDS: usize = 40;
/// A turn that misses a whole one by less than this is none: the cable leaves a little before its first node's tangent, rad.
const ALMOST_ROUND: f64 = 0.25 * std::f64::consts::PI;

/// A circle in ship axes that the cable goes round.
#[derive(Clone, Copy, Debug)]
struct Wheel {
    centre: Vector3<f64>,
    /// Axis, "up", axis × up.
    basis: [Vector3<f64>; 3],
    radius: f64,
    /// Sense of travel about the axis.
    sense: f64,
    /// Angles from "up" where the cable comes and goes; the going one further in the sense of travel.
    from: f64,
    to: f64,
    /// Height along the axis at which it comes.
    axial: f64,
}

impl Wheel {
    fn point(&self, angle: f64) -> Vector3<f64> {
        self.centre + self.basis[0] * self.axial + (self.basis[1] * angle.cos() + self.basis[2] * angle.sin()) * self.radius
    }

    fn tangent(&self, angle: f64) -> Vector3<f64> {
        (self.basis[2] * angle.cos() - self.basis[1] * angle.sin()) * self.sense
    }

    /// Components of a point or direction along "up" and axis × up.
    fn flat(&self, v: &Vector3<f64>) -> (f64, f64) {
        (self.basis[1].dot(v), self.basis[2].dot(v))
    }

    /// Angle at which a line from `p` touches the wheel (coming, or going where `going`); `p`'s own angle where it lies within.
    fn touch(&self, p: &Vector3<f64>, going: bool) -> f64 {
        let (up, side) = self.flat(&(p - self.centre));
        let (distance, angle) = (up.hypot(side), side.atan2(up));
        let open = if distance > self.radius { (self.radius / distance).acos() } else { 0.0 };
        angle + if going { -open } else { open } * self.sense
    }

    /// Angle at which the cable leaves towards a direction.
    fn release(&self, d: &Vector3<f64>) -> f64 {
        let (up, side) = self.flat(d);
        (-up * self.sense).atan2(side * self.sense)
    }

    fn turn(&self) -> f64 {
        let turn = (self.sense * (self.to - self.from)).rem_euclid(TAU);
        if turn > TAU - ALMOST_ROUND { 0.0 } else { turn }
    }

    fn arc(&self) -> f64 {
        self.turn() * self.radius
    }
}

/// One stretch of the way: straight to a wheel, then round it.
#[derive(Clone, Copy, Debug)]
struct Piece {
    /// Arc lengths where the straight part begins and ends, m.
    begin: f64,
    come: f64,
    from: Vector3<f64>,
    wheel: Wheel,
}

/// The part of a cable between its first node and where it leaves the last wheel: along drum and sheaves in their order, in the sense of
/// winding and on the side that the scene says, straight between them.
pub(super) struct Way {
    pieces: Vec<Piece>,
    rotation: Matrix3<f64>,
    /// In ship axes.
    first: Vector3<f64>,
    last: Vector3<f64>,
    /// Its length, m.
    pub arc: f64,
}

impl Way {
    /// Until the tangent points along `direction` (a world unit vector).
    ///
    /// # Errors
    /// When the cable is too short to reach the last sheave, or starts inside one.
    pub fn new(system: &System, t: f64, direction: &Vector3<f64>) -> Result<Self, String> {
        let env = system.environment(t);
        let rotation = Matrix3::from_fn(|i, j| env.frame.rotation[i][j].0[0]);
        let d = rotation.transpose() * direction;
        let first = Vector3::from(env.frame.locate(&env.base.map(|j| j.0[0])));
        let mut wheels: Vec<Wheel> = vec![];
        let mut drum = false;
        // A held slope too: a straight shape across it would stay on the saddle between its two sides, the slope shrunk to nothing.
        if let FirstEnd::Winch { geometry, drive, contact, clamp } = &system.first
            && (*contact || *clamp > 0.0)
        {
            let basis = [geometry.axis, geometry.up, geometry.side].map(Vector3::from);
            let (centre, radius, sense) = (Vector3::from(geometry.centre), geometry.radius, geometry.sense);
            let phi = drive.angle(t).0[0];
            wheels.push(Wheel { centre, basis, radius, sense, from: phi, to: phi, axial: basis[0].dot(&(first - centre)) });
            drum = true;
        }
        let sheaves = &system.surfaces[system.surfaces.len() - system.over.len()..];
        for (k, (surface, &over)) in sheaves.iter().zip(&system.over).enumerate() {
            let basis = surface.basis.map(Vector3::from);
            let centre = Vector3::from(surface.centre);
            let from = wheels.last().map_or(first, |w: &Wheel| w.centre);
            let to = sheaves.get(k + 1).map_or_else(|| centre + d * 10.0 * surface.radius, |s| Vector3::from(s.centre));
            // Over the top from where it comes to where it goes; the other way about for "under".
            let across = basis[2].dot(&(to - from));
            let sense = if (across >= 0.0) == over { 1.0 } else { -1.0 };
            wheels.push(Wheel { centre, basis, radius: surface.radius, sense, from: 0.0, to: 0.0, axial: 0.0 });
            let inside = surface.radius - (first - centre).cross(&basis[0]).norm();
            if inside > 1e-6 * surface.radius
                && surface.groove.is_none_or(|g| g.depth.is_infinite() || surface.beyond(&local(surface, &first)) < 0.0)
            {
                return Err(format!(
                    "the cable's first node at ({:.4}, {:.4}, {:.4}) m (ship axes) lies {inside:.4} m inside sheave \"{}\", whose radius to the \
                     cable's centreline is {:.4} m",
                    first.x, first.y, first.z, system.names[k], surface.radius
                ));
            }
        }
        let count = wheels.len();
        for _ in 0..ROUNDS {
            for k in 0..count {
                let mut w = wheels[k];
                if k > 0 || !drum {
                    let before = if k == 0 { first } else { wheels[k - 1].point(wheels[k - 1].to) };
                    w.from = w.touch(&before, false);
                }
                w.to = if k + 1 < count {
                    let next = wheels[k + 1];
                    w.touch(&next.point(next.from), true)
                } else if w.flat(&d) == (0.0, 0.0) {
                    w.from
                } else {
                    w.release(&d)
                };
                wheels[k] = w;
            }
        }
        // The way as pieces: straight to a wheel, round it, and so on.
        let length = system.arc[system.arc.len() - 1];
        let mut pieces = vec![];
        let (mut s, mut at) = (0.0, first);
        for (k, w) in wheels.iter().enumerate() {
            let come = w.point(w.from);
            let span = if k == 0 && drum { 0.0 } else { (come - at).norm() };
            pieces.push(Piece { begin: s, come: s + span, from: at, wheel: *w });
            s += span + w.arc();
            at = w.point(w.from + w.sense * w.turn());
            // A cable may end on the drum, not before a sheave.
            if let Some(name) = k.checked_sub(usize::from(drum)).map(|i| &system.names[i])
                && s > length
            {
                return Err(format!("the cable of {length} m cannot reach beyond sheave \"{name}\": the way there is {s:.4} m long"));
            }
        }
        Ok(Self { pieces, rotation, first, last: at, arc: s })
    }

    /// Position relative to the first node and slope at arc length `s`, if that lies on the way; world axes.
    pub fn at(&self, s: f64) -> Option<(Vector3<f64>, Vector3<f64>)> {
        if s >= self.arc {
            return None;
        }
        let Piece { begin, come, from, wheel } = self.pieces.iter().rev().find(|p| s >= p.begin)?;
        let (p, t) = if s < *come {
            let way = (wheel.point(wheel.from) - from) / (come - begin);
            (from + way * (s - begin), way)
        } else {
            let angle = wheel.from + wheel.sense * (s - come) / wheel.radius;
            (wheel.point(angle), wheel.tangent(angle))
        };
        Some((self.rotation * (p - self.first), self.rotation * t))
    }

    /// Arc lengths between which the cable lies on each wheel, and the wheel's radius to the cable's centreline, m.
    fn wheels(&self) -> impl Iterator<Item = OnWheel> {
        self.pieces.iter().map(|p| OnWheel { from: p.come, to: p.come + p.wheel.arc(), radius: p.wheel.radius })
    }

    /// Where it ends, relative to the first node, world axes.
    pub fn leaves(&self) -> Vector3<f64> {
        self.rotation * (self.last - self.first)
    }
}

/// Where the cable lies on a drum or sheave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnWheel {
    /// Arc length at which it comes, m.
    pub from: f64,
    /// And goes, m.
    pub to: f64,
    /// Radius to the cable's centreline, m.
    pub radius: f64,
}

/// Where a cable that leaves the last wheel along `direction` (a world unit vector) lies on drum and sheaves.
///
/// # Errors
/// As [`Way::new`].
pub fn on_wheels(system: &System, t: f64, direction: &Vector3<f64>) -> Result<Vec<OnWheel>, String> {
    Ok(Way::new(system, t, direction)?.wheels().collect())
}

/// Positions relative to the first node and slopes, six per node: along drum and sheaves as far as needed, straight from there along
/// `direction` (a world unit vector); unstretched. A rigid load points along `direction` too.
///
/// # Errors
/// As [`Way::new`].
pub fn lay_out(system: &System, t: f64, direction: &Vector3<f64>) -> Result<Vec<f64>, String> {
    let way = Way::new(system, t, direction)?;
    let mut out = Vec::with_capacity(6 * system.nodes());
    for &s in &system.arc {
        let (p, t) = way.at(s).unwrap_or_else(|| (way.leaves() + direction * (s - way.arc), *direction));
        out.extend(p.iter().chain(&t));
    }
    if system.load.is_some() {
        out.extend(Vector3::zeros().iter().chain(direction));
    }
    out.resize(6 * system.nodes(), 0.0);
    out[..3].fill(0.0);
    Ok(out)
}

fn local(surface: &crate::contact::surface::Surface, p: &Vector3<f64>) -> [f64; 3] {
    let s = p - Vector3::from(surface.centre);
    std::array::from_fn(|i| Vector3::from(surface.basis[i]).dot(&s))
}
