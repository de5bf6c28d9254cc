//! Element lengths graded from a scene and a target error: short where the cable lies on a drum or sheave or will, longer away from them.
//!
//! What asks for short elements is the bend round a wheel and the contact's edge on it. Where the cable rests or swings on a wheel the tension's
//! error goes like the 2.5th power of the angle that an element spans (a pendulum over a pulley: 0.48 % at 0.43 rad, 0.17 % at 0.31, 0.086 % at
//! 0.22); where a winch reels and nodes run over it, like the third (the flume in a seaway: 3 % at 0.44 rad, 0.6 % at 0.27). In the free spans it
//! is the shape that drag, weight and waves give the cable, of which a span holds a few lengths. In between lengths grow linearly with the
//! distance, so that neighbours differ little. Nodes are then laid so that each element takes an equal share of ∫ ds / h(s).

use crate::equilibrium::{OnWheel, on_wheels};
use crate::scene::{Initial, Scene};
use crate::system::{FirstEnd, System};
use nalgebra::Vector3;

/// An angle that an element may span on a wheel, rad; the tension's error with such elements, and how it goes with the angle: where nodes stay
/// where they are, and where they run over the wheel.
const ANGLE: f64 = 0.43;
const STAYING: [f64; 2] = [0.0096, 2.5];
const RUNNING: [f64; 2] = [0.03, 3.0];
/// An element spans no more.
const WIDEST: f64 = 0.8;
/// Elements of the free spans at an error of 1 %, and how the error goes with their number.
const IN_SPANS: f64 = 10.0;
const POWER_IN_SPANS: f64 = 4.0;
/// Growth of an element's length with the distance from where it must be short.
const GROWTH: f64 = 0.35;
/// How far the place where the cable leaves a wheel may wander with ship and current, rad.
const WANDER: f64 = 0.35;
/// More elements than this are not made.
const MOST: f64 = 20_000.0;

/// A stretch with elements of at most this length.
struct Zone {
    from: f64,
    to: f64,
    length: f64,
}

impl Zone {
    fn length_at(&self, s: f64) -> f64 {
        self.length + GROWTH * (self.from - s).max(s - self.to).max(0.0)
    }
}

/// Unstretched element lengths (m) from the first end for tensions that are off by about `error` (relative). `travel` (m) is how much is paid out or
/// reeled in at most; two drum diameters where it is not given. They sum to the cable's length.
pub fn graded(scene: &Scene, error: f64, travel: Option<f64>) -> Vec<f64> {
    let whole = scene.cable.length;
    let travel = travel.or_else(|| scene.winch.as_ref().map(|w| 4.0 * w.radius)).unwrap_or(0.0);
    let [at_angle, power] = if travel > 0.0 { RUNNING } else { STAYING };
    let angle = (ANGLE * (error / at_angle).powf(1.0 / power)).min(WIDEST);
    let longest = whole / (IN_SPANS * (0.01 / error).powf(1.0 / POWER_IN_SPANS));
    let zones: Vec<Zone> = wheels(scene)
        .iter()
        .map(|w| {
            let beside = travel + WANDER * w.radius;
            Zone { from: w.from - beside, to: w.to + beside, length: angle * w.radius }
        })
        .collect();
    let length_at = |s: f64| zones.iter().map(|z| z.length_at(s)).fold(longest, f64::min).max(whole / MOST);
    equidistributed(whole, length_at)
}

/// Where the cable lies on wheels with the ship at rest in the origin. None if it cannot: the start will say why.
fn wheels(scene: &Scene) -> Vec<OnWheel> {
    let mut system = System::new(&Scene { elements: vec![scene.cable.length], ..scene.clone() });
    if let (FirstEnd::Winch { drive, .. }, Some(winch)) = (&mut system.first, &scene.winch) {
        drive.start(0.0, winch.angle);
    }
    let last = scene.sheaves.last().map(|s| s.position).or(scene.winch.as_ref().map(|w| w.position)).or(scene.anchor).unwrap_or_default();
    let direction = match (&scene.initial, scene.far_end) {
        (Initial::Released(d) | Initial::Straight(d), _) => *d,
        (_, Some(end)) => (end - last).normalize(),
        (Initial::Shape(points), _) if points.len() > 1 => {
            (points[points.len() - 1].position - points[points.len() - 2].position).normalize()
        }
        _ => Vector3::new(0.0, 0.0, -1.0),
    };
    on_wheels(&system, 0.0, &direction).unwrap_or_default()
}

/// Elements of [0, whole] with ∫ ds / h(s) the same in each and at most 1.
fn equidistributed(whole: f64, h: impl Fn(f64) -> f64) -> Vec<f64> {
    // Midpoints of slices a tenth of the local length; h changes by GROWTH/10 of itself over one.
    let mut slices = vec![(0.0, 0.0)];
    let (mut s, mut sum) = (0.0, 0.0);
    while s < whole {
        let d = (0.1 * h(s)).min(whole - s).max(1e-6 * whole);
        sum += d / h(s + 0.5 * d);
        s = (s + d).min(whole);
        slices.push((s, sum));
    }
    // The last slice may be rounding only.
    let count = (sum - 1e-9).ceil().max(1.0);
    let mut at = 0;
    let nodes: Vec<f64> = (1..count as usize)
        .map(|k| {
            let share = sum * k as f64 / count;
            while slices[at + 1].1 < share {
                at += 1;
            }
            let ((s0, n0), (s1, n1)) = (slices[at], slices[at + 1]);
            s0 + (s1 - s0) * (share - n0) / (n1 - n0)
        })
        .chain([whole])
        .collect();
    let mut before = 0.0;
    nodes.into_iter().map(|s| s - std::mem::replace(&mut before, s)).collect()
}
