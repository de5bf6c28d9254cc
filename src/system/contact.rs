//! Line contact of the elements with the drum.
//!
//! Within an element the arcs in contact are found first (samples, then the roots of the gap), and each is integrated by its own five Gauss
//! points. So the force changes smoothly as the cable is laid on or lifted off, whatever the mesh. The arcs' ends move with the shape; their
//! part of the tangent is exact too.

use super::environment::Environment;
use super::matrices::{Matrices, element_block};
use super::points::ElementPoint;
use super::{FirstEnd, System, gather};
use crate::cable::shape;
use crate::contact::drum::Drum;
use crate::math::lanes::{Mat3, Vec3, axpy, dot, mat_vec};
use crate::math::quadrature::GAUSS5;

/// Intervals per element in the search for arcs in contact.
const SAMPLES: usize = 4;

/// Where the search begins in the first element. Its node lies on the drum's surface whatever the shape, so that ξ = 0 is a root of the gap
/// that says nothing, of a sign that is rounding.
const BEYOND_PIN: f64 = 1e-3;

/// An element and the drum, in one place.
struct Pair<'a> {
    drum: &'a Drum,
    centre: Vec3<f64>,
    env: &'a Environment,
    u: [Vec3<f64>; 4],
    l: f64,
}

/// A stretch [from, to] of ξ in contact; `moving` tells which of its ends are roots of the gap.
#[derive(Clone, Copy, Debug)]
struct Arc {
    from: f64,
    to: f64,
    moving: [bool; 2],
}

impl Pair<'_> {
    /// Position from the drum's centre, ship axes.
    fn locate(&self, r: &Vec3<f64>) -> Vec3<f64> {
        let s = self.env.frame.locate(&std::array::from_fn(|c| r[c] + self.env.base[c].0[0]));
        std::array::from_fn(|c| s[c] - self.centre[c])
    }

    fn gap(&self, x: f64) -> f64 {
        self.drum.gap(&self.locate(&shape::interpolate(&shape::value(x, self.l), &self.u)))
    }

    /// ∂gap/∂r in world axes (the outward unit normal) and dgap/dξ.
    fn normal_and_slope(&self, x: f64) -> (Vec3<f64>, f64) {
        let at = self.locate(&shape::interpolate(&shape::value(x, self.l), &self.u));
        let radial = axpy(&at, -dot(&at, &self.drum.axis), &self.drum.axis);
        let rho = dot(&radial, &radial).sqrt();
        let e = self.env.frame.to_world(&radial.map(|c| c / rho));
        (e, self.l * dot(&e, &shape::interpolate(&shape::slope(x, 1.0 / self.l), &self.u)))
    }

    fn slope(&self, x: f64) -> f64 {
        self.normal_and_slope(x).1
    }

    /// Whether the element can touch the drum: a ball around its Bézier polygon against the cylinder.
    fn near(&self) -> bool {
        let (q, third) = (&self.u, self.l / 3.0);
        let middle: Vec3<f64> = std::array::from_fn(|c| 0.5 * (q[0][c] + q[2][c]));
        let reach = [q[0], axpy(&q[0], third, &q[1]), axpy(&q[2], -third, &q[3])]
            .iter()
            .map(|p| (0..3).map(|c| (p[c] - middle[c]).powi(2)).sum::<f64>())
            .fold(0.0, f64::max)
            .sqrt();
        self.drum.gap(&self.locate(&middle)) < reach
    }

    /// The arcs in contact, in order. Between samples an extremum of the gap is looked for where its slopes promise one, so that the cable's
    /// touching between two samples is not missed.
    fn arcs(&self, start: f64, mut found: impl FnMut(Arc)) {
        let mut open: Option<f64> = None;
        let mut cross = |x: f64| match open.take() {
            Some(from) => found(Arc { from, to: x, moving: [from > start, true] }),
            None => open = Some(x),
        };
        let (mut x0, mut g0, mut d0) = (start, self.gap(start), self.slope(start));
        if g0 < 0.0 {
            cross(start);
        }
        for k in 1..=SAMPLES {
            let x1 = k as f64 / SAMPLES as f64;
            let (g1, d1) = (self.gap(x1), self.slope(x1));
            if (g0 < 0.0) != (g1 < 0.0) {
                cross(root(|x| self.gap(x), (x0, g0), (x1, g1)));
            } else if (d0 < 0.0) != (d1 < 0.0) && (d0 < 0.0) == (g0 >= 0.0) {
                let x = root(|x| self.slope(x), (x0, d0), (x1, d1));
                let g = self.gap(x);
                if (g < 0.0) != (g0 < 0.0) {
                    cross(root(|x| self.gap(x), (x0, g0), (x, g)));
                    cross(root(|x| self.gap(x), (x, g), (x1, g1)));
                }
            }
            (x0, g0, d0) = (x1, g1, d1);
        }
        if let Some(from) = open {
            found(Arc { from, to: 1.0, moving: [from > start, false] });
        }
    }

    /// Derivative of the root at ξ by the element's slots, −∇gap sᵢ / gap′; `None` where the cable only grazes the drum.
    fn root_rate(&self, x: f64) -> Option<[f64; 12]> {
        let s = shape::value(x, self.l);
        let (e, slope) = self.normal_and_slope(x);
        (slope.abs() > 1e-9 * self.l).then(|| std::array::from_fn(|k| -s[k / 3] * e[k % 3] / slope))
    }
}

/// A root of `f` in a bracket of (x, f(x)), by the Illinois form of the false position.
fn root(f: impl Fn(f64) -> f64, (mut a, mut fa): (f64, f64), (mut b, mut fb): (f64, f64)) -> f64 {
    for _ in 0..60 {
        let x = (a * fb - b * fa) / (fb - fa);
        if !(x > a.min(b) && x < a.max(b)) || (b - a).abs() < 1e-15 {
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

impl System {
    /// Overwrites the contact forces; with `TANGENT` adds to the matrices.
    pub(super) fn contact<const TANGENT: bool>(&mut self, env: &Environment, u: &[f64], w: &[f64], m: &mut Matrices) {
        let FirstEnd::Winch { geometry, contact: Some(drum), .. } = &self.first else { return };
        let rotation: Mat3<f64> = std::array::from_fn(|i| std::array::from_fn(|j| env.frame.rotation[i][j].0[0]));
        // ∂ṡ/∂s at fixed world velocity, −[ω]×.
        let turn: Mat3<f64> = if self.frozen {
            [[0.0; 3]; 3]
        } else {
            std::array::from_fn(|i| {
                std::array::from_fn(|j| (0..3).map(|k| env.frame.rotation[k][i].0[1] * env.frame.rotation[k][j].0[0]).sum())
            })
        };
        for (e, &l) in self.chain.lengths.iter().enumerate() {
            let forces = &mut self.contact_forces;
            forces[e] = [0.0; 12];
            let pair = Pair { drum, centre: geometry.centre, env, u: gather(u, e), l };
            if !pair.near() {
                continue;
            }
            pair.arcs(if e == 0 { BEYOND_PIN } else { 0.0 }, |arc| {
                let length = arc.to - arc.from;
                // ∂Q/∂from and ∂Q/∂to of the rule, points moving along.
                let mut by_ends = [[0.0; 12]; 2];
                for (position, weight) in GAUSS5 {
                    let point = ElementPoint::new(u, w, e, l, arc.from + length * position);
                    let s = pair.locate(&point.u);
                    let v = if self.frozen {
                        [0.0; 3]
                    } else {
                        let r: Vec3<f64> = std::array::from_fn(|c| point.u[c] + env.base[c].0[0]);
                        env.frame.relative_velocity(&r, &std::array::from_fn(|c| point.w[c] + env.base[c].0[1]))
                    };
                    let Some(load) = drum.load(&s, &v) else { continue };
                    let wl = weight * length * l;
                    let f = env.frame.to_world(&load.f);
                    point.push(&f.map(|x| wl * x), forces);
                    if TANGENT {
                        let mut ds = load.ds;
                        for (row, dv) in ds.iter_mut().zip(&load.dv) {
                            for j in 0..3 {
                                row[j] += (0..3).map(|k| dv[k] * turn[k][j]).sum::<f64>();
                            }
                        }
                        let by_r = sandwich(&rotation, &ds);
                        let by_v = sandwich(&rotation, &load.dv);
                        let times = |b: &Mat3<f64>| b.map(|row| row.map(|x| wl * x));
                        let damped = drum.law.damping > 0.0;
                        point.couple(Some(&times(&by_r)), None, damped.then(|| times(&by_v)).as_ref(), None, m);
                        if arc.moving != [false, false] {
                            // d/dξ of sᵢ f.
                            let fx = axpy(&mat_vec(&by_r, &point.p), 1.0, &mat_vec(&by_v, &point.vp));
                            for k in 0..12 {
                                let (i, c) = (k / 3, k % 3);
                                let (g, rate) = (point.s[i] * f[c], l * (point.sp[i] * f[c] + point.s[i] * fx[c]));
                                by_ends[0][k] += weight * l * (length * rate * (1.0 - position) - g);
                                by_ends[1][k] += weight * l * (length * rate * position + g);
                            }
                        }
                    }
                }
                if TANGENT {
                    for (end, x) in [arc.from, arc.to].into_iter().enumerate() {
                        if let Some(rate) = arc.moving[end].then(|| pair.root_rate(x)).flatten() {
                            for i in 0..4 {
                                for j in 0..4 {
                                    let block = element_block(&mut m.stiffness, e, i, j);
                                    for r in 0..3 {
                                        for c in 0..3 {
                                            block[3 * (i % 2) + r][3 * (j % 2) + c] -= by_ends[end][3 * i + r] * rate[3 * j + c];
                                        }
                                    }
                                }
                            }
                        }
                    }
                }
            });
        }
    }
}

/// R b Rᵀ.
fn sandwich(rotation: &Mat3<f64>, b: &Mat3<f64>) -> Mat3<f64> {
    let left: Mat3<f64> = std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| rotation[i][k] * b[k][j]).sum::<f64>()));
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| left[i][k] * rotation[j][k]).sum()))
}
