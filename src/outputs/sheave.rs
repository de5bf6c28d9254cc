//! What a sheave feels, and where the cable lies on it.

use super::SheaveOutputs;
use super::observe::{span_tension, span_tension_beside};
use crate::contact::arcs::Cubic;
use crate::contact::surface::{Face, Surface};
use crate::math::lanes::{Lanes, Vec3, axpy, dot};
use crate::system::contact::{SurfaceFrame, ball, near, touching};
use crate::system::{Environment, System, gather};
use nalgebra::Vector3;

/// Samples per element along a contact arc.
const SAMPLES: usize = 6;
/// The same where an angle is followed: no element turns by more than a half circle between two.
const TURNS: usize = 2;
/// Bending lengths √(EI/T) from the end of contact to where the cable counts as straight.
const STRAIGHT: f64 = 3.0;
/// The most of a contact arc that counts as run-in at either end.
const RUN_IN: f64 = 0.25;

/// Turns a vector from a surface's axes into ship axes.
pub fn to_ship(surface: &Surface, v: &Vec3<f64>) -> Vector3<f64> {
    Vector3::from_fn(|c, _| (0..3).map(|k| surface.basis[k][c] * v[k]).sum())
}

/// The force per length on a point at rest, and its normal part, N/m.
fn still(surface: &Surface, face: Face, s: &Vec3<f64>) -> (Vec3<f64>, f64) {
    let load = surface.loads::<false, 1>(face, &s.map(|x| Lanes([x])), &[Lanes::ZERO; 3], 0.0).at(0);
    (load.f, load.normal)
}

/// First and last arc length in contact with surface `index`, m.
pub fn contact_arc(system: &System, env: &Environment, u: &[f64], index: usize) -> Option<(f64, f64)> {
    let surface = &system.surfaces[index];
    let frame = SurfaceFrame::new(surface, env, true);
    let mut arc: Option<(f64, f64)> = None;
    for (e, &l) in system.chain.lengths.iter().enumerate() {
        let slots = gather(u, e);
        if !near(surface, &frame, &slots, l) {
            continue;
        }
        let (_, curve) = frame.shape(&slots, l);
        touching(surface, &curve, e, |_, face, a| {
            // A face may be "touched" beyond the groove's extent, where it bears nothing.
            let bears = (0..=SAMPLES).any(|k| {
                let x = a.from + (a.to - a.from) * (k as f64 + 0.5) / (SAMPLES + 1) as f64;
                still(surface, face, &curve.at(x)).1 > 0.0
            });
            if bears {
                let (from, to) = (system.arc[e] + a.from * l, system.arc[e] + a.to * l);
                arc = Some(arc.map_or((from, to), |(f, t)| (f.min(from), t.max(to))));
            }
        });
    }
    arc
}

/// Moment on the ship about the centre of the sheave that is surface `index`: that on the sheave, but about its axis only what the bearing
/// of a turning sheave passes on.
pub fn on_ship(system: &System, index: usize, out: &SheaveOutputs) -> Vector3<f64> {
    let Some(turning) = system.turning.iter().find(|s| s.surface == index) else { return out.moment };
    let axis = Vector3::from(system.surfaces[index].basis[0]);
    out.moment - axis * (out.moment.dot(&axis) + turning.bearing(out.rate).0)
}

/// The cable in a surface's axes, from one arc length to the next.
struct Walk<'a> {
    system: &'a System,
    frame: &'a SurfaceFrame,
    u: &'a [f64],
    /// The element at hand and its shape.
    element: Option<(usize, Cubic)>,
}

impl<'a> Walk<'a> {
    fn new(system: &'a System, frame: &'a SurfaceFrame, u: &'a [f64]) -> Self {
        Self { system, frame, u, element: None }
    }

    /// What `of` an element's shape is at arc length `s`.
    fn at(&mut self, s: f64, of: fn(&Cubic, f64) -> Vec3<f64>) -> Vec3<f64> {
        let (arc, lengths) = (&self.system.arc, &self.system.chain.lengths);
        let (e, curve) = match self.element {
            Some((e, curve)) if s >= arc[e] && s < arc[e + 1] => (e, curve),
            _ => {
                let e = self.system.element_at(s).0;
                (e, self.frame.shape(&gather(self.u, e), lengths[e]).1)
            }
        };
        self.element = Some((e, curve));
        of(&curve, ((s - arc[e]) / lengths[e]).clamp(0.0, 1.0))
    }
}

/// Fills `out` for the sheave that is surface `index` and touched along `arc`; `neighbours` are where contact ends before it and begins after
/// it (or the cable's ends).
pub fn sheave(
    system: &System,
    env: &Environment,
    u: &[f64],
    w: &[f64],
    index: usize,
    arc: Option<(f64, f64)>,
    neighbours: (f64, f64),
    out: &mut SheaveOutputs,
) {
    let surface = &system.surfaces[index];
    let load = &system.surface_loads[index];
    let force = -to_ship(surface, &load.force);
    *out = SheaveOutputs {
        force,
        moment: -to_ship(surface, &load.moment),
        normal_force: force.norm(),
        flank_force: load.faces,
        ..SheaveOutputs::default()
    };
    if let Some(turning) = system.turning.iter().find(|s| s.surface == index) {
        (out.angle, out.rate) = (u[turning.at], w[turning.at]);
    }
    let frame = SurfaceFrame::new(surface, env, true);
    out.out_of_groove = climbed_out(system, surface, &frame, u);
    let Some((begin, end)) = arc else { return };
    out.in_contact = true;
    [out.tension_in, out.tension_out] = match surface.friction {
        None => [begin, end].map(|s| span_tension(system, u, w, s)),
        Some(_) => [(begin, true, neighbours.0), (end, false, neighbours.1)]
            .map(|(s, before, limit)| span_tension_beside(system, u, w, s, before, limit)),
    };
    // Angles, followed along the arc so that more than half a turn is counted right.
    let angle = |p: &Vec3<f64>| p[2].atan2(p[1]);
    let mut walk = Walk::new(system, &frame, u);
    let mut follow = |from: f64, to: f64, direction: fn(&Cubic, f64) -> Vec3<f64>| {
        let elements = system.element_at(to).0 - system.element_at(from).0 + 1;
        let n = TURNS * elements;
        let first = angle(&walk.at(from, direction));
        let (mut sum, mut last) = (0.0, first);
        for k in 1..=n {
            let next = angle(&walk.at(from + (to - from) * k as f64 / n as f64, direction));
            let turn = std::f64::consts::TAU;
            sum += (next - last) - turn * ((next - last) / turn).round();
            last = next;
        }
        (first, sum)
    };
    let (swept_from, swept) = follow(begin, end, Cubic::at);
    out.contact_begin = swept_from;
    out.contact_end = out.contact_begin + swept;
    out.wrap_angle = swept.abs();
    let section = &system.chain.section;
    let straight = |tension: f64| STRAIGHT * (section.ei / tension.abs().max(1e-12 * section.ea)).sqrt();
    // No nearer than the mesh can straighten: the element in which contact ends bends as a whole.
    let beyond = |s: f64, tension: f64| straight(tension).max(system.chain.lengths[system.element_at(s).0]);
    let first = begin - beyond(begin, out.tension_in).min(0.5 * (begin - neighbours.0).max(0.0));
    let last = end + beyond(end, out.tension_out).min(0.5 * (neighbours.1 - end).max(0.0));
    // With no span before it the contact starts at the first node.
    let first = if system.element_at(begin).0 == 0 && begin < 2e-3 * system.chain.lengths[0] { 0.0 } else { first };
    out.turn_angle = follow(first, last, Cubic::slope).1.abs();
    // Line loads: the greatest anywhere, the least away from both ends, where a load begins at nothing: over the length that a straight cable
    // needs to sink in by the present depth, to bend, and that the mesh resolves.
    let sunk = (0..=SAMPLES)
        .map(|k| {
            let p = walk.at(begin + (end - begin) * k as f64 / SAMPLES as f64, Cubic::at);
            surface.radius - p[1].hypot(p[2])
        })
        .fold(0.0, f64::max);
    let sink = 4.0 * (2.0 * surface.radius * sunk).sqrt();
    let run = |s: f64, tension: f64| (straight(tension) + sink + system.chain.lengths[system.element_at(s).0]).min(RUN_IN * (end - begin));
    let (run_in, run_out) = (run(begin, out.tension_in), run(end, out.tension_out));
    let (faces, count) = surface.faces();
    let n = SAMPLES * (system.element_at(end).0 - system.element_at(begin).0 + 1);
    let (mut least, mut most) = (f64::INFINITY, 0.0f64);
    for k in 0..=n {
        let s = begin + (end - begin) * k as f64 / n as f64;
        let p = walk.at(s, Cubic::at);
        let mut f = [0.0; 3];
        for face in &faces[..count] {
            f = axpy(&f, 1.0, &still(surface, *face, &p).0);
        }
        let size = dot(&f, &f).sqrt();
        most = most.max(size);
        if s > begin + run_in && s < end - run_out {
            least = least.min(size);
        }
    }
    out.line_load_max = most;
    out.line_load_min = if least.is_finite() { least } else { 0.0 };
}

/// Whether an element can come so near to the surface's centre.
fn within(frame: &SurfaceFrame, slots: &[Vec3<f64>; 4], l: f64, reach: f64) -> bool {
    let (middle, radius) = ball(slots, l);
    let at = frame.place(&middle);
    dot(&at, &at) < (reach + radius).powi(2)
}

/// Whether some of the cable lies on the rim or beside the groove.
fn climbed_out(system: &System, surface: &Surface, frame: &SurfaceFrame, u: &[f64]) -> bool {
    let Some(groove) = surface.groove.filter(|g| g.depth.is_finite()) else { return false };
    let rim = groove.half_width(groove.depth);
    // Farther from the centre than this no point counts.
    let reach = 2.0 * surface.radius + groove.depth + groove.diameter + rim;
    system.chain.lengths.iter().enumerate().any(|(e, &l)| {
        let slots = gather(u, e);
        if !within(frame, &slots, l, reach) {
            return false;
        }
        let (_, curve) = frame.shape(&slots, l);
        (0..=SAMPLES).any(|k| {
            let s = curve.at(k as f64 / SAMPLES as f64);
            let h = s[1].hypot(s[2]) - surface.radius;
            // How far outside the flank, or its continuation above the rim.
            let outside = s[0].abs() - groove.half_width(h);
            let on_rim = h >= groove.depth && h < groove.depth + groove.diameter && outside > 0.0 && outside < groove.diameter;
            on_rim || h < groove.depth && s[0].abs() > rim + groove.diameter && s[0].abs() < rim + surface.radius
        })
    })
}
