//! Which stretches of a cubic curve penetrate a face.
//!
//! The gap is sampled, an extremum is looked for where the slopes of two samples promise one (so that touching between samples is not missed),
//! and the ends of each stretch are found as roots.

use super::surface::{Face, Surface};
use crate::math::lanes::Vec3;

/// Intervals of the search.
pub const INTERVALS: usize = 4;

/// The most arcs that a search finds: one to an interval and one between.
pub const MOST_ARCS: usize = INTERVALS + 2;

/// A curve in the surface's axes, cubic in ξ on [0, 1]: coefficients of 1, ξ, ξ², ξ³.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cubic(pub [Vec3<f64>; 4]);

impl Cubic {
    /// From end points and end slopes times the length, as (point, slope, point, slope).
    #[inline(always)]
    pub fn hermite(q: &[Vec3<f64>; 4], length: f64) -> Self {
        let mut k = [[0.0; 3]; 4];
        for c in 0..3 {
            let (a, b, step) = (length * q[1][c], length * q[3][c], q[2][c] - q[0][c]);
            k[0][c] = q[0][c];
            k[1][c] = a;
            k[2][c] = 3.0 * step - 2.0 * a - b;
            k[3][c] = a + b - 2.0 * step;
        }
        Self(k)
    }

    /// Value at ξ.
    #[inline(always)]
    pub fn at(&self, x: f64) -> Vec3<f64> {
        let k = &self.0;
        std::array::from_fn(|c| k[0][c] + x * (k[1][c] + x * (k[2][c] + x * k[3][c])))
    }

    /// Derivative by ξ.
    #[inline(always)]
    pub fn slope(&self, x: f64) -> Vec3<f64> {
        let k = &self.0;
        std::array::from_fn(|c| k[1][c] + x * (2.0 * k[2][c] + x * 3.0 * k[3][c]))
    }
}

/// A stretch [from, to] of ξ in contact; `moving` tells which of its ends are roots of the gap.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Arc {
    /// Its begin.
    pub from: f64,
    /// Its end.
    pub to: f64,
    /// Whether begin and end move with the shape.
    pub moving: [bool; 2],
}

/// A curve at the ends of the search's intervals, from `start` on: what the gaps to all faces of a surface need, computed side by side.
#[derive(Clone, Copy, Debug)]
pub struct Samples {
    /// ξ of the first.
    pub start: f64,
    /// Along the axis, with its derivative by ξ; zero if the surface is a cylinder.
    pub axial: [[f64; INTERVALS + 1]; 2],
    /// ρ² − R² of a cylinder, ρ − R of a groove, with its derivative by ξ.
    pub radial: [[f64; INTERVALS + 1]; 2],
}

impl Samples {
    /// Of a curve in the surface's axes.
    pub fn new(surface: &Surface, curve: &Cubic, start: f64) -> Self {
        match surface.groove {
            None => Self::of::<true>(surface.radius, curve, start),
            Some(_) => Self::of::<false>(surface.radius, curve, start),
        }
    }

    /// The same of a surface of this radius, `PLAIN` if it is a cylinder.
    #[inline(always)]
    pub fn of<const PLAIN: bool>(radius: f64, curve: &Cubic, start: f64) -> Self {
        let mut out = Self { start, axial: [[0.0; INTERVALS + 1]; 2], radial: [[0.0; INTERVALS + 1]; 2] };
        for i in 0..=INTERVALS {
            let x = if i == 0 { start } else { i as f64 / INTERVALS as f64 };
            let (s, d) = (curve.at(x), curve.slope(x));
            let (square, rate) = (s[1] * s[1] + s[2] * s[2], s[1] * d[1] + s[2] * d[2]);
            if PLAIN {
                (out.radial[0][i], out.radial[1][i]) = (square - radius * radius, rate + rate);
            } else {
                let rho = square.sqrt();
                (out.radial[0][i], out.radial[1][i]) = (rho - radius, rate / rho);
                (out.axial[0][i], out.axial[1][i]) = (s[0], d[0]);
            }
        }
        out
    }

    /// Whether a gap is negative somewhere or may have a least value between two samples.
    #[inline(always)]
    pub fn may_touch(&self, face: Face) -> bool {
        let (mut below, mut turns) = (false, false);
        let mut before = 0.0;
        for i in 0..=INTERVALS {
            let (_, (gap, slope)) = self.gap(i, face);
            below |= gap < 0.0;
            turns |= (before < 0.0) & (slope >= 0.0);
            before = slope;
        }
        below | turns
    }

    /// ξ, the gap to a face and its derivative.
    #[inline(always)]
    fn gap(&self, i: usize, face: Face) -> (f64, (f64, f64)) {
        let x = if i == 0 { self.start } else { i as f64 / INTERVALS as f64 };
        let of = |k: usize| face.axial * self.axial[k][i] + face.radial * self.radial[k][i];
        (x, (of(0), of(1)))
    }
}

/// A curve against one face.
#[derive(Clone, Copy, Debug)]
pub struct Touch<'a> {
    /// The surface.
    pub surface: &'a Surface,
    /// Its face.
    pub face: Face,
    /// The curve.
    pub curve: &'a Cubic,
}

impl Touch<'_> {
    /// A measure of the gap at ξ, and its derivative by ξ: the gap itself, of a cylinder ρ² − R², which has the same sign and roots and needs
    /// no square root.
    #[inline(always)]
    fn gap(&self, x: f64) -> (f64, f64) {
        let (s, d) = (self.curve.at(x), self.curve.slope(x));
        let Face { axial, radial } = self.face;
        let (square, rate) = (s[1] * s[1] + s[2] * s[2], s[1] * d[1] + s[2] * d[2]);
        let radius = self.surface.radius;
        if axial == 0.0 {
            return (square - radius * radius, rate + rate);
        }
        let rho = square.sqrt();
        (axial * s[0] + radial * (rho - radius), axial * d[0] + radial * rate / rho)
    }

    /// A root of the gap in a bracket of (ξ, gap): Newton's method, halving where it leaves the bracket.
    fn root(&self, (mut a, mut fa): (f64, f64), (mut b, fb): (f64, f64)) -> f64 {
        let mut x = (a * fb - b * fa) / (fb - fa);
        for _ in 0..60 {
            let (f, slope) = self.gap(x);
            if (f < 0.0) == (fa < 0.0) {
                (a, fa) = (x, f);
            } else {
                b = x;
            }
            let step = f / slope;
            if step.abs() < 1e-9 {
                // Converging quadratically: this step leaves its square.
                return (x - step).clamp(a.min(b) - 1e-9, a.max(b) + 1e-9);
            }
            let newton = x - step;
            x = if newton > a.min(b) && newton < a.max(b) { newton } else { 0.5 * (a + b) };
            if (b - a).abs() < 1e-15 {
                break;
            }
        }
        x
    }

    /// Calls `found` with the arcs in contact, in order.
    #[inline(always)]
    pub fn arcs(&self, samples: &Samples, mut found: impl FnMut(Arc)) {
        let start = samples.start;
        let mut open: Option<f64> = None;
        let mut cross = |x: f64| match open.take() {
            Some(from) => found(Arc { from, to: x, moving: [from > start, true] }),
            None => open = Some(x),
        };
        let (mut x0, (mut g0, mut d0)) = samples.gap(0, self.face);
        if g0 < 0.0 {
            cross(start);
        }
        for k in 1..=INTERVALS {
            let (x1, (g1, d1)) = samples.gap(k, self.face);
            if (g0 < 0.0) != (g1 < 0.0) {
                cross(self.root((x0, g0), (x1, g1)));
            } else if (d0 < 0.0) != (d1 < 0.0) && (d0 < 0.0) == (g0 >= 0.0) && may_cross((g0, d0), (g1, d1), x1 - x0) {
                // An extremum towards the other side.
                let x = turning_point(|x| self.gap(x).1, (x0, d0), (x1, d1));
                let g = self.gap(x).0;
                if (g < 0.0) != (g0 < 0.0) {
                    cross(self.root((x0, g0), (x, g)));
                    cross(self.root((x, g), (x1, g1)));
                }
            }
            (x0, g0, d0) = (x1, g1, d1);
        }
        if let Some(from) = open {
            found(Arc { from, to: 1.0, moving: [from > start, false] });
        }
    }
}

/// Whether a gap of one sign and with these slopes at the ends of an interval may have the other sign between. It dips no deeper than the
/// tangents' meeting point, if it is as smooth as its samples let one think; twice as deep is allowed for.
#[inline(always)]
fn may_cross((g0, d0): (f64, f64), (g1, d1): (f64, f64), length: f64) -> bool {
    let x = ((g1 - g0 - d1 * length) / (d0 - d1)).clamp(0.0, length);
    let dip = (d0 * x).abs().max((d1 * (length - x)).abs());
    2.0 * dip >= g0.abs().min(g1.abs())
}

/// A root of the slope `f` in a bracket of (x, f(x)), by the Illinois form of the false position.
fn turning_point(f: impl Fn(f64) -> f64, (mut a, mut fa): (f64, f64), (mut b, mut fb): (f64, f64)) -> f64 {
    for _ in 0..60 {
        let x = (a * fb - b * fa) / (fb - fa);
        // What lies within a millionth of an element around an extremum differs from it by a millionth of a millionth.
        if !(x > a.min(b) && x < a.max(b)) || (b - a).abs() < 1e-6 {
            break;
        }
        let fx = f(x);
        if fx == 0.0 {
            return x;
        }
        if (fx < 0.0) != (fb < 0.0) {
            (a, fa) = (b, fb);
        } else {
            fa *= 0.5;
        }
        (b, fb) = (x, fx);
    }
    b
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Contact;

    #[test]
    fn exact_arcs_end_on_the_surface() {
        let surface = Surface {
            centre: [0.0; 3],
            basis: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            radius: 1.0,
            law: Contact { stiffness: 1.0, damping: 0.0, exponent: 1.5 },
            groove: None,
            friction: None,
        };
        // A straight line dipping `depth` below the top between two samples.
        for depth in [1e-9, 1e-3, 0.1] {
            let up = 1.0 - depth;
            let line = [[0.0, up, -0.88], [0.0, 0.0, 2.0], [0.0, up, 1.12], [0.0, 0.0, 2.0]];
            let curve = Cubic::hermite(&line, 1.0);
            let touch = Touch { surface: &surface, face: surface.faces().0[0], curve: &curve };
            let mut arcs = vec![];
            touch.arcs(&Samples::new(&surface, &curve, 0.0), |a| arcs.push(a));
            assert_eq!(arcs.len(), 1, "{depth}");
            let half = 0.5 * (1.0 - up * up).sqrt();
            assert!((arcs[0].from - (0.44 - half)).abs() < 1e-12 && (arcs[0].to - (0.44 + half)).abs() < 1e-12, "{depth}: {arcs:?}");
            assert_eq!(arcs[0].moving, [true, true]);
        }
    }
}
