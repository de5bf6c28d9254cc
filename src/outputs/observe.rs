//! From a balanced state to named quantities.

use super::Outputs;
use crate::cable::section::Strains;
use crate::cable::shape;
use crate::math::lanes::{Vec3, dot};
use crate::math::quadrature::{GAUSS2, GAUSS3};
use crate::system::{Environment, FirstEnd, System, gather};
use nalgebra::Vector3;

/// Samples per element in the search for the end of the contact arc.
const SAMPLES: usize = 12;

/// Fills `out` from the state and the forces of the last balance; `f` are its nodal sums (the first node's rows hold what its support must
/// balance).
pub fn observe(system: &System, env: &Environment, u: &[f64], w: &[f64], f: &[f64], out: &mut Outputs) {
    let last = system.chain.lengths.len() - 1;
    cable(system, env, u, w, out);
    let on_support = Vector3::new(f[0], f[1], f[2]);
    let origin = Vector3::from(env.frame.origin.map(|j| j.0[0]));
    let base = Vector3::from(env.base.map(|j| j.0[0]));
    let to_ship = |v: &Vector3<f64>| Vector3::from(env.frame.to_ship(&(*v).into()));
    let (force, moment) = match &system.first {
        FirstEnd::Winch { geometry, drive, contact, .. } => {
            // On the drum: the pin's part f0 less the contact on the cable; moments of the generalized forces are Σ q × Q.
            let (mut on_cable, mut turning) = (Vector3::zeros(), Vector3::zeros());
            if contact.is_some() {
                for (e, q) in system.contact_forces.iter().enumerate() {
                    let x = gather(u, e);
                    for i in 0..4 {
                        let force = Vector3::new(q[3 * i], q[3 * i + 1], q[3 * i + 2]);
                        let mut arm = Vector3::from(x[i]);
                        if i % 2 == 0 {
                            on_cable += force;
                            arm += base;
                        }
                        turning += arm.cross(&force);
                    }
                }
            }
            let slope = Vector3::new(u[3], u[4], u[5]);
            let clamp = slope.cross(&Vector3::from(system.clamp_force));
            let force = on_support - on_cable;
            // World moment about the world's origin.
            let moment = base.cross(&on_support) - turning - clamp;
            let centre = origin + Vector3::from(env.frame.to_world(&geometry.centre));
            let about_centre = to_ship(&(moment - centre.cross(&force)));
            let phi = drive.state();
            out.winch.angle = phi[0];
            out.winch.rate = phi[1];
            out.winch.torque = about_centre.dot(&Vector3::from(geometry.axis));
            out.winch.force = to_ship(&force);
            out.winch.tension = span_tension(system, u, w, leaving_point(system, env, u));
            (force, moment)
        }
        FirstEnd::Anchor(_) => {
            out.anchor.force = to_ship(&on_support);
            out.anchor.tension = nodal_tension(system, u, 0);
            (on_support, base.cross(&on_support))
        }
    };
    out.ship.force_world = force;
    out.ship.force = to_ship(&force);
    out.ship.moment = to_ship(&(moment - origin.cross(&force)));
    let at = 6 * (last + 1);
    out.body.position = Vector3::from_fn(|c, _| u[at + c] + env.base[c].0[0]);
    out.body.velocity = Vector3::from_fn(|c, _| w[at + c] + env.base[c].0[1]);
    out.body.tension = nodal_tension(system, u, last + 1);
    load(system, u, w, out);
    if system.far_end.is_some() {
        out.far_end.force = Vector3::new(f[at], f[at + 1], f[at + 2]);
        out.far_end.tension = out.body.tension;
    }
}

/// The rigid load, from the attachment's motion and its own direction.
fn load(system: &System, u: &[f64], w: &[f64], out: &mut Outputs) {
    let Some(load) = &system.load else { return };
    let tail = |x: &[f64]| Vector3::new(x[x.len() - 3], x[x.len() - 2], x[x.len() - 1]);
    let (n, turning) = (tail(u), tail(w));
    out.load.position = out.body.position + n * load.gravity;
    out.load.velocity = out.body.velocity + turning * load.gravity;
    out.load.tension = out.body.tension;
    out.load.angle = n.x.hypot(n.y).atan2(-n.z);
}

fn cable(system: &System, env: &Environment, u: &[f64], w: &[f64], out: &mut Outputs) {
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for (e, &l) in system.chain.lengths.iter().enumerate() {
        // The element's mean axial force: pointwise values carry the cubic's own ripple.
        let mean: f64 = GAUSS3.iter().map(|(x, weight)| weight * system.chain.section.axial_force(&strains(u, w, e, l, *x))).sum();
        least = least.min(mean);
        most = most.max(mean);
    }
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

fn strains(u: &[f64], w: &[f64], e: usize, l: f64, x: f64) -> Strains<f64> {
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
fn span_tension(system: &System, u: &[f64], w: &[f64], s: f64) -> f64 {
    let count = system.chain.lengths.len();
    let at_node = |j: usize| {
        let left = (j > 0).then(|| end_curvature(system, u, w, j - 1, 1.0));
        let right = (j < count).then(|| end_curvature(system, u, w, j, 0.0));
        let k = match (left, right) {
            (Some(a), Some(b)) => 0.5 * (a + b),
            (a, b) => a.or(b).unwrap_or(0.0),
        };
        nodal_tension(system, u, j) + 0.5 * system.chain.section.ei * k * k
    };
    let e = system.arc[1..count].partition_point(|x| *x <= s).min(count - 1);
    let x = ((s - system.arc[e]) / system.chain.lengths[e]).clamp(0.0, 1.0);
    at_node(e) * (1.0 - x) + at_node(e + 1) * x
}

/// Arc length where the cable leaves the drum: the far end of the last penetrating stretch, 0 without any.
fn leaving_point(system: &System, env: &Environment, u: &[f64]) -> f64 {
    let FirstEnd::Winch { geometry, contact: Some(drum), .. } = &system.first else { return 0.0 };
    let gap = |e: usize, x: f64| {
        let l = system.chain.lengths[e];
        let r = shape::interpolate(&shape::value(x, l), &gather(u, e));
        let s = env.frame.locate(&std::array::from_fn(|c| r[c] + env.base[c].0[0]));
        drum.gap(&std::array::from_fn(|c| s[c] - geometry.centre[c]))
    };
    for e in (0..system.chain.lengths.len()).rev() {
        if system.contact_forces[e] == [0.0; 12] {
            continue;
        }
        for k in (0..SAMPLES).rev() {
            let (mut lo, mut hi) = (k as f64 / SAMPLES as f64, (k + 1) as f64 / SAMPLES as f64);
            if gap(e, lo) < 0.0 {
                if gap(e, hi) >= 0.0 {
                    for _ in 0..40 {
                        let mid = 0.5 * (lo + hi);
                        if gap(e, mid) < 0.0 { lo = mid } else { hi = mid }
                    }
                }
                return system.arc[e] + hi * system.chain.lengths[e];
            }
        }
    }
    0.0
}
