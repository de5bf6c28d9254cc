//! From a balanced state to named quantities.

use super::{Outputs, sheave};
use crate::cable::section::Strains;
use crate::cable::shape;
use crate::math::lanes::{Vec3, dot, scale};
use crate::math::quadrature::GAUSS2;
use crate::system::{Environment, FirstEnd, System, gather};
use nalgebra::Vector3;

/// Fills `out` from the state and the forces of the last balance; `f` are its nodal sums (the first node's rows hold what its support must
/// balance).
pub fn observe(system: &System, env: &Environment, u: &[f64], w: &[f64], f: &[f64], out: &mut Outputs) {
    let last = system.chain.lengths.len() - 1;
    cable(system, env, u, w, out);
    let on_support = Vector3::new(f[0], f[1], f[2]);
    let base = Vector3::from(env.base.map(|j| j.0[0]));
    let to_ship = |v: &Vector3<f64>| Vector3::from(env.frame.to_ship(&(*v).into()));
    // Forces on the ship, ship axes, and their moment about its origin.
    let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
    let mut act = |at: &Vec3<f64>, f: &Vector3<f64>, about_it: &Vector3<f64>| {
        force += f;
        moment += Vector3::from(*at).cross(f) + about_it;
    };
    // Where the cable leaves what it touched last.
    let mut leaving = 0.0;
    match &system.first {
        FirstEnd::Winch { geometry, drive, contact, .. } => {
            // The pin's part less the contact on the cable.
            let (mut on_drum, mut about_centre) = (to_ship(&on_support), Vector3::zeros());
            let slope = Vector3::new(u[3], u[4], u[5]);
            let clamp = slope.cross(&Vector3::from(system.clamp_force));
            let arm = Vector3::from(env.frame.locate(&base.into())) - Vector3::from(geometry.centre);
            about_centre += arm.cross(&on_drum) - to_ship(&clamp);
            if *contact {
                let load = &system.surface_loads[0];
                on_drum -= sheave::to_ship(&system.surfaces[0], &load.force);
                about_centre -= sheave::to_ship(&system.surfaces[0], &load.moment);
                leaving = sheave::contact_arc(system, env, u, 0).map_or(0.0, |a| a.1);
            }
            let phi = drive.state();
            out.winch.angle = phi[0];
            out.winch.rate = phi[1];
            out.winch.torque = about_centre.dot(&Vector3::from(geometry.axis));
            out.winch.force = on_drum;
            out.winch.tension = span_tension(system, u, w, leaving);
            act(&geometry.centre, &on_drum, &about_centre);
        }
        FirstEnd::Anchor(at) => {
            out.anchor.force = to_ship(&on_support);
            out.anchor.tension = nodal_tension(system, u, 0);
            act(at, &out.anchor.force, &Vector3::zeros());
        }
    }
    let first = system.surfaces.len() - out.sheaves.len();
    let end = system.arc[last + 1];
    let arc = |k: usize| (k < system.surfaces.len()).then(|| sheave::contact_arc(system, env, u, k)).flatten();
    let mut here = arc(first);
    for (i, sheave) in out.sheaves.iter_mut().enumerate() {
        let next = arc(first + i + 1);
        sheave::sheave(system, env, u, w, first + i, here, (leaving, next.map_or(end, |a| a.0)), sheave);
        act(&system.surfaces[first + i].centre, &sheave.force, &sheave::on_ship(system, first + i, sheave));
        leaving = here.map_or(leaving, |a| a.1);
        here = next;
    }
    out.ship.force = force;
    out.ship.force_world = Vector3::from(env.frame.to_world(&force.into()));
    out.ship.moment = moment;
    let at = 6 * (last + 1);
    out.body.position = Vector3::from_fn(|c, _| u[at + c] + env.base[c].0[0]);
    out.body.velocity = Vector3::from_fn(|c, _| w[at + c] + env.base[c].0[1]);
    out.body.tension = nodal_tension(system, u, last + 1);
    load(system, u, w, out);
    if let Some(turbulence) = &system.turbulence {
        out.current_noise = turbulence.at(env.time)[0].into();
    }
    if system.far_end.is_some() {
        out.far_end.force = Vector3::new(f[at], f[at + 1], f[at + 2]);
        out.far_end.tension = out.body.tension;
    }
}

/// The rigid load, from the attachment's motion and its own direction.
fn load(system: &System, u: &[f64], w: &[f64], out: &mut Outputs) {
    let Some(load) = &system.load else { return };
    let at = 6 * system.arc.len() + 3;
    let tail = |x: &[f64]| Vector3::new(x[at], x[at + 1], x[at + 2]);
    let (n, turning) = (tail(u), tail(w));
    out.load.position = out.body.position + n * load.gravity;
    out.load.velocity = out.body.velocity + turning * load.gravity;
    out.load.tension = out.body.tension;
    out.load.angle = n.x.hypot(n.y).atan2(-n.z);
}

fn cable(system: &System, env: &Environment, u: &[f64], w: &[f64], out: &mut Outputs) {
    let (least, most) = system.chain.extremes(u, w);
    out.cable.tension_max = most;
    out.cable.tension_min = least;
    out.cable.slack = least <= 0.0;
    let length = system.arc[system.arc.len() - 1];
    let count = out.cable.points.len();
    let mut e = 0;
    for (k, point) in out.cable.points.iter_mut().enumerate() {
        let s = if count > 1 { length * k as f64 / (count - 1) as f64 } else { length };
        while e + 1 < system.chain.lengths.len() && s > system.arc[e + 1] {
            e += 1;
        }
        let l = system.chain.lengths[e];
        let r = shape::interpolate(&shape::value(((s - system.arc[e]) / l).clamp(0.0, 1.0), l), &gather(u, e));
        *point = Vector3::from_fn(|c, _| r[c] + env.base[c].0[0]);
    }
}

fn strains(u: &[f64], w: &[f64], e: usize, l: f64, x: f64) -> Strains {
    let (sp, spp) = (shape::slope(x, 1.0 / l), shape::second(x, 1.0 / l));
    let (qu, qw) = (gather(u, e), gather(w, e));
    Strains {
        p: shape::interpolate(&sp, &qu),
        pp: shape::interpolate(&spp, &qu),
        vp: shape::interpolate(&sp, &qw),
        vpp: shape::interpolate(&spp, &qw),
    }
}

/// Axial force at a node from the balance of the element beside it (internal, inertia and loads together), N. Far more accurate than the
/// strain at the node.
fn nodal_tension(system: &System, u: &[f64], node: usize) -> f64 {
    let slope: Vec3<f64> = [u[6 * node + 3], u[6 * node + 4], u[6 * node + 5]];
    let last = system.chain.lengths.len();
    let (e, slot, sign) = if node < last { (node, 0, 1.0) } else { (last - 1, 6, -1.0) };
    let (q, c) = (&system.forces[e], &system.contact_forces[e]);
    let section: Vec3<f64> = std::array::from_fn(|k| sign * (q[slot + k] + c[slot + k]));
    dot(&section, &slope) / dot(&slope, &slope).sqrt()
}

/// κ at a node, extrapolated linearly through the superconvergent two-point Gauss values of element `e`.
fn end_curvature(system: &System, u: &[f64], w: &[f64], e: usize, end: f64) -> f64 {
    let l = system.chain.lengths[e];
    let k: [f64; 2] = std::array::from_fn(|i| {
        let s = strains(u, w, e, l, GAUSS2[i].0);
        system.chain.section.curvature_squared(&s.p, &s.pp).sqrt()
    });
    k[0] + (k[1] - k[0]) * (end - GAUSS2[0].0) / (GAUSS2[1].0 - GAUSS2[0].0)
}

/// N + ½EIκ² at arc length `s`: conserved along a frictionless bend, the pull of the free span.
pub fn span_tension(system: &System, u: &[f64], w: &[f64], s: f64) -> f64 {
    let (e, x) = system.element_at(s);
    nodal_pull(system, u, w, e) * (1.0 - x) + nodal_pull(system, u, w, e + 1) * x
}

/// The same where friction acts on one side of `s`, beyond which it leads nowhere: from the two nodes on the other side, those before `s` or
/// those after it; within `limit` (m of arc length), where the next contact is.
pub fn span_tension_beside(system: &System, u: &[f64], w: &[f64], s: f64, before: bool, limit: f64) -> f64 {
    let e = system.element_at(s).0;
    let (near, far) = if before { (Some(e), e.checked_sub(1)) } else { (Some(e + 1), Some(e + 2)) };
    let free = |j: &usize| system.arc.get(*j).is_some_and(|at| if before { *at >= limit } else { *at <= limit });
    let pull = |j: usize| nodal_pull(system, u, w, j);
    match (near.filter(free), far.filter(free)) {
        (Some(a), Some(b)) => {
            let x = (s - system.arc[a]) / (system.arc[b] - system.arc[a]);
            pull(a) * (1.0 - x) + pull(b) * x
        }
        (Some(a), None) => pull(a),
        _ => span_tension(system, u, w, s),
    }
}

/// N + ½EIκ² at a node.
fn nodal_pull(system: &System, u: &[f64], w: &[f64], j: usize) -> f64 {
    let left = (j > 0).then(|| end_curvature(system, u, w, j - 1, 1.0));
    let right = (j < system.chain.lengths.len()).then(|| end_curvature(system, u, w, j, 0.0));
    let k = match (left, right) {
        (Some(a), Some(b)) => 0.5 * (a + b),
        (a, b) => a.or(b).unwrap_or(0.0),
    };
    nodal_tension(system, u, j) + 0.5 * system.chain.section.ei * k * k
}

/// Unit tangent at arc length `s`, world axes.
pub fn tangent_at(system: &System, u: &[f64], s: f64) -> Vec3<f64> {
    let (e, x) = system.element_at(s);
    let p = shape::interpolate(&shape::slope(x, 1.0 / system.chain.lengths[e]), &gather(u, e));
    scale(1.0 / dot(&p, &p).sqrt(), &p)
}
