//! A drum or sheave as the cable feels it (model.md 4; thesis eqs. 94-105): a cylinder, or the two flanks of a V groove.
//!
//! In the half-plane through the axis, y along it and h = ρ − R outwards, a face has the unit normal n = (n_a, n_r) and the penetration
//! δ = −(n_a y + n_r h): a cylinder (0, 1), the flanks (±cos ½θ, sin ½θ). Per length
//!
//! ```text
//! f = N n − μ N v_s / √(v_s² + v_ε²),   N = ω k δⁿ (1 + D δ̇)
//! ```
//!
//! with v_s the slip velocity in the face's tangent plane, and ω the groove's extent: 1 inside, falling smoothly to 0 over the last tenth of the
//! groove's depth, and from half a cable diameter to a whole one beside the rim (a cable that hangs beside the sheave is not pushed back).

use super::hunt_crossley::{self, Pressure};
use crate::math::lanes::{Lanes, Mat3, Vec3, add_identity, add_outer, axpy, dot, lane, scale, set_lane, zero_mat};
use crate::scene::Contact;

/// The last part of a groove's depth, over which its force fades.
const FADE: f64 = 0.1;

/// A surface of revolution in ship axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Centre, ship axes, m.
    pub centre: Vec3<f64>,
    /// Rows: unit axis, "up", axis × up; ship axes.
    pub basis: Mat3<f64>,
    /// To the cable's centreline, m.
    pub radius: f64,
    /// Contact law.
    pub law: Contact,
    /// A V groove; without it a plain cylinder.
    pub groove: Option<Groove>,
    /// Coulomb coefficient and the slip speed (m/s) below which friction fades.
    pub friction: Option<Friction>,
}

/// Regularized Coulomb friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// μ.
    pub coefficient: f64,
    /// v_ε, m/s.
    pub slip_speed: f64,
}

impl Friction {
    const NONE: Self = Self { coefficient: 0.0, slip_speed: 1.0 };
}

/// A V groove.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Groove {
    /// cos ½θ and sin ½θ.
    pub half: (f64, f64),
    /// Depth, m; may be infinite.
    pub depth: f64,
    /// Cable diameter, m.
    pub diameter: f64,
}

impl Groove {
    /// Throat angle `angle` (rad) and `depth` (m) for a cable of `diameter` (m).
    pub fn new(angle: f64, depth: f64, diameter: f64) -> Self {
        let (s, c) = (0.5 * angle).sin_cos();
        Self { half: (c, s), depth, diameter }
    }

    /// |y| of the flanks at height `h` over the root, m.
    pub fn half_width(&self, h: f64) -> f64 {
        h * self.half.1 / self.half.0
    }

    /// ω with its derivatives by h and |y|; the depth must be finite.
    #[inline(always)]
    fn extent(&self, h: f64, y: f64) -> (f64, f64, f64) {
        let (a, da) = fall((h - (1.0 - FADE) * self.depth) / (FADE * self.depth));
        let half = 0.5 * self.diameter;
        let (b, db) = fall((y - self.half_width(self.depth) - half) / half);
        (a * b, da * b / (FADE * self.depth), a * db / half)
    }
}

/// From 1 at x ≤ 0 to 0 at x ≥ 1 with two continuous derivatives, and its slope.
#[inline(always)]
fn fall(x: f64) -> (f64, f64) {
    let x = x.clamp(0.0, 1.0);
    (1.0 - x * x * x * (10.0 + x * (6.0 * x - 15.0)), -30.0 * x * x * (1.0 - x) * (1.0 - x))
}

/// One face of a surface: its normal in the half-plane through the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    /// Component along the axis.
    pub axial: f64,
    /// Component away from the axis.
    pub radial: f64,
}

/// Load on a point of the cable, in the surface's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLoad {
    /// On the cable, N/m.
    pub f: Vec3<f64>,
    /// Its part normal to the face, N/m.
    pub normal: f64,
    /// ∂f/∂s at fixed relative velocity.
    pub ds: Mat3<f64>,
    /// ∂f/∂v.
    pub dv: Mat3<f64>,
    /// ∂f/∂(spin).
    pub dspin: Vec3<f64>,
}

impl Surface {
    /// Its faces: one of a cylinder, two of a groove (the first with its normal along the axis).
    #[inline]
    pub fn faces(&self) -> ([Face; 2], usize) {
        match self.groove {
            None => ([Face { axial: 0.0, radial: 1.0 }; 2], 1),
            Some(g) => ([Face { axial: g.half.0, radial: g.half.1 }, Face { axial: -g.half.0, radial: g.half.1 }], 2),
        }
    }

    /// Whether forces depend on velocity.
    pub fn is_damped(&self) -> bool {
        self.law.damping > 0.0 || self.friction.is_some()
    }

    /// −δ: distance from a face of a point in the surface's axes, m; negative when penetrating. Its gradient is a unit vector.
    #[inline]
    pub fn gap(&self, face: Face, s: &Vec3<f64>) -> f64 {
        face.axial * s[0] + face.radial * ((s[1] * s[1] + s[2] * s[2]).sqrt() - self.radius)
    }

    /// The least gap of a point over the faces.
    pub fn least_gap(&self, s: &Vec3<f64>) -> f64 {
        let (faces, n) = self.faces();
        faces[..n].iter().map(|f| self.gap(*f, s)).fold(f64::INFINITY, f64::min)
    }

    /// Whether a face is nearer than `reach` (m) to a point, and the groove's extent too.
    #[inline]
    pub fn within(&self, s: &Vec3<f64>, reach: f64) -> bool {
        let (limit, square) = (self.radius + reach, s[1] * s[1] + s[2] * s[2]);
        match self.groove {
            None => square < limit * limit,
            Some(_) => self.least_gap(s) < reach && self.beyond(s) < reach,
        }
    }

    /// How far (m) a point is beyond the reach of the groove's flanks; negative within.
    #[inline]
    pub fn beyond(&self, s: &Vec3<f64>) -> f64 {
        match self.groove {
            Some(g) if g.depth.is_finite() => {
                let h = (s[1] * s[1] + s[2] * s[2]).sqrt() - self.radius;
                (h - g.depth).max(s[0].abs() - g.half_width(g.depth) - g.diameter)
            }
            _ => f64::NEG_INFINITY,
        }
    }

    /// The groove's extent at points side by side, with its derivatives by h and |y|; 1 where nothing ends it.
    #[inline(always)]
    fn extents<const N: usize>(&self, s: &[Lanes<N>; 3]) -> [Lanes<N>; 3] {
        let mut out = [Lanes([1.0; N]), Lanes::ZERO, Lanes::ZERO];
        if let Some(g) = self.groove.filter(|g| g.depth.is_finite()) {
            for i in 0..N {
                let rho = (s[1].0[i] * s[1].0[i] + s[2].0[i] * s[2].0[i]).sqrt();
                let (extent, by_h, by_y) = g.extent(rho - self.radius, s[0].0[i].abs());
                set_lane(&mut out, i, [extent, by_h, by_y]);
            }
        }
        out
    }

    /// Penetrations of points side by side, not negative, m. On the axis itself there is no direction, and no load.
    #[inline(always)]
    fn depths<const N: usize>(&self, face: Face, s: &[Lanes<N>; 3]) -> Lanes<N> {
        let mut depth = Lanes::ZERO;
        for i in 0..N {
            let rho = (s[1].0[i] * s[1].0[i] + s[2].0[i] * s[2].0[i]).sqrt();
            let d = -(face.axial * s[0].0[i] + face.radial * (rho - self.radius));
            depth.0[i] = if rho > 0.0 { d.max(0.0) } else { 0.0 };
        }
        depth
    }

    /// Loads on points side by side at `s` that move with `v` relative to the ship while the surface turns at `spin` (rad/s); derivatives only
    /// with `TANGENT`. Zeros without contact.
    #[inline(always)]
    pub fn loads<const TANGENT: bool, const N: usize>(&self, face: Face, s: &[Lanes<N>; 3], v: &[Lanes<N>; 3], spin: f64) -> Loads<N> {
        let press = [self.depths(face, s), Lanes::ZERO];
        let press = [press[0], hunt_crossley::powers(self.law.exponent, &press[0])];
        let extent = self.extents(s);
        let law = self.law;
        let mut out = Loads::ZERO;
        // A loop for each kind: a choice within would keep its points from going side by side.
        match self.friction {
            None => {
                for i in 0..N {
                    let at = Point { s: lane(s, i), v: lane(v, i), press: lane(&press, i), extent: lane(&extent, i) };
                    out.set::<TANGENT>(i, &at.load::<TANGENT, false>(&law, face, spin, &Friction::NONE));
                }
            }
            Some(friction) => {
                for i in 0..N {
                    let at = Point { s: lane(s, i), v: lane(v, i), press: lane(&press, i), extent: lane(&extent, i) };
                    out.set::<TANGENT>(i, &at.load::<TANGENT, true>(&law, face, spin, &friction));
                }
            }
        }
        out
    }
}

/// Loads on points side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loads<const N: usize> {
    /// See [`PointLoad`]; matrices row by row.
    pub f: [Lanes<N>; 3],
    /// See above.
    pub normal: Lanes<N>,
    /// See above.
    pub ds: [Lanes<N>; 9],
    /// See above.
    pub dv: [Lanes<N>; 9],
    /// See above.
    pub dspin: [Lanes<N>; 3],
}

impl<const N: usize> Loads<N> {
    const ZERO: Self =
        Self { f: [Lanes::ZERO; 3], normal: Lanes::ZERO, ds: [Lanes::ZERO; 9], dv: [Lanes::ZERO; 9], dspin: [Lanes::ZERO; 3] };

    /// That on point `i`.
    #[inline(always)]
    pub fn at(&self, i: usize) -> PointLoad {
        let matrix = |m: &[Lanes<N>; 9]| std::array::from_fn(|r| std::array::from_fn(|c| m[3 * r + c].0[i]));
        PointLoad { f: lane(&self.f, i), normal: self.normal.0[i], ds: matrix(&self.ds), dv: matrix(&self.dv), dspin: lane(&self.dspin, i) }
    }

    #[inline(always)]
    fn set<const TANGENT: bool>(&mut self, i: usize, load: &PointLoad) {
        set_lane(&mut self.f, i, load.f);
        self.normal.0[i] = load.normal;
        if TANGENT {
            set_lane(&mut self.ds, i, std::array::from_fn(|k| load.ds[k / 3][k % 3]));
            set_lane(&mut self.dv, i, std::array::from_fn(|k| load.dv[k / 3][k % 3]));
            set_lane(&mut self.dspin, i, load.dspin);
        }
    }
}

/// A point of the cable on a face.
struct Point {
    s: Vec3<f64>,
    v: Vec3<f64>,
    /// δ and δⁿ.
    press: [f64; 2],
    /// The groove's extent with its derivatives by h and |y|.
    extent: Vec3<f64>,
}

impl Point {
    /// The load here; see [`Surface::loads`].
    #[inline(always)]
    fn load<const TANGENT: bool, const ROUGH: bool>(&self, law: &Contact, face: Face, spin: f64, friction: &Friction) -> PointLoad {
        let Self { s, v, press: [depth, power], extent: [weight, by_h, by_y] } = *self;
        let rho = (s[1] * s[1] + s[2] * s[2]).sqrt();
        // Without contact everything is finite and multiplied by zero.
        let by_rho = if depth > 0.0 { 1.0 / rho } else { 0.0 };
        let by_y = by_y * if s[0] < 0.0 { -1.0 } else { 1.0 };
        let (e1, e2) = (s[1] * by_rho, s[2] * by_rho);
        let (e, t): (Vec3<f64>, Vec3<f64>) = ([0.0, e1, e2], [0.0, -e2, e1]);
        let n = [face.axial, face.radial * e1, face.radial * e2];
        let vn = dot(&n, &v);
        let Pressure { force, by_depth, by_rate } = hunt_crossley::pressure(law, depth, -vn, power);
        let normal = weight * force;
        let mut load = PointLoad { f: scale(normal, &n), normal, ds: zero_mat(), dv: zero_mat(), dspin: [0.0; 3] };
        let vt = dot(&t, &v);
        // ∂n/∂s = (n_r/ρ) t tᵀ, so ∂δ̇/∂s = −(n_r/ρ) v_t t.
        let hoop = face.radial * by_rho;
        let mut grad = axpy(&scale(-weight * by_depth, &n), -weight * by_rate * hoop * vt, &t);
        grad = axpy(&grad, force * by_h, &e);
        grad[0] += force * by_y;
        if TANGENT {
            add_outer(&mut load.ds, 1.0, &n, &grad);
            add_outer(&mut load.ds, normal * hoop, &t, &t);
            add_outer(&mut load.dv, -weight * by_rate, &n, &n);
        }
        if ROUGH {
            let Friction { coefficient, slip_speed } = *friction;
            let slip = axpy(&axpy(&v, -vn, &n), -spin * rho, &t);
            let speed = (dot(&slip, &slip) + slip_speed * slip_speed).sqrt();
            let d = scale(1.0 / speed, &slip);
            load.f = axpy(&load.f, -coefficient * normal, &d);
            if TANGENT {
                add_outer(&mut load.ds, -coefficient, &d, &grad);
                add_outer(&mut load.dv, coefficient * weight * by_rate, &d, &n);
                // ∂(slip)/∂s and ∂(slip)/∂v, then through d = slip/√(slip² + v_ε²).
                let (mut by_s, mut by_v) = (zero_mat(), zero_mat());
                add_outer(&mut by_s, -hoop * vn, &t, &t);
                add_outer(&mut by_s, -hoop * vt, &n, &t);
                add_outer(&mut by_s, -spin, &t, &e);
                add_outer(&mut by_s, spin, &e, &t);
                add_identity(&mut by_v, 1.0);
                add_outer(&mut by_v, -1.0, &n, &n);
                let mu = -coefficient * normal / speed;
                let by_spin = scale(-rho, &t);
                load.dspin = scale(mu, &axpy(&by_spin, -dot(&d, &by_spin), &d));
                for (m, by) in [(&mut load.ds, &by_s), (&mut load.dv, &by_v)] {
                    let along: Vec3<f64> = std::array::from_fn(|c| d[0] * by[0][c] + d[1] * by[1][c] + d[2] * by[2][c]);
                    for r in 0..3 {
                        for c in 0..3 {
                            m[r][c] += mu * (by[r][c] - d[r] * along[c]);
                        }
                    }
                }
            }
        }
        load
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surfaces() -> Vec<Surface> {
        let plain = Surface {
            centre: [0.0; 3],
            basis: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            radius: 0.5,
            law: Contact { stiffness: 1e5, damping: 0.3, exponent: 1.5 },
            groove: None,
            friction: None,
        };
        let grooved = Surface { groove: Some(Groove::new(0.9, 0.1, 0.08)), ..plain.clone() };
        let rough = Some(Friction { coefficient: 0.4, slip_speed: 0.05 });
        vec![Surface { friction: rough, ..plain.clone() }, Surface { friction: rough, ..grooved.clone() }, plain, grooved]
    }

    /// The load on one point, if any.
    fn load(surface: &Surface, face: Face, s: &Vec3<f64>, v: &Vec3<f64>, spin: f64) -> Option<PointLoad> {
        let load = surface.loads::<true, 1>(face, &s.map(|x| Lanes([x])), &v.map(|x| Lanes([x])), spin).at(0);
        (load.normal > 0.0).then_some(load)
    }

    #[test]
    fn exact_tangent_matches_central_differences() {
        // In the open, in the fading part of the groove's depth, and beside its rim.
        let places = [[0.03, -0.31, 0.38, 0.4, -0.7, 0.2], [0.06, -0.43, 0.413, -0.4, 0.7, 0.2], [0.11, 0.33, 0.4, 0.4, -0.3, 0.2]];
        let mut touched = 0;
        for surface in surfaces() {
            let (faces, n) = surface.faces();
            for face in &faces[..n] {
                for x in places {
                    let f = |x: &[f64; 6]| load(&surface, *face, &[x[0], x[1], x[2]], &[x[3], x[4], x[5]], 0.7);
                    let Some(l) = f(&x) else { continue };
                    touched += 1;
                    for j in 0..6 {
                        let h = 1e-7;
                        let (mut up, mut down) = (x, x);
                        up[j] += h;
                        down[j] -= h;
                        let (up, down) = (f(&up).unwrap(), f(&down).unwrap());
                        for i in 0..3 {
                            let d = (up.f[i] - down.f[i]) / (2.0 * h);
                            let exact = if j < 3 { l.ds[i][j] } else { l.dv[i][j - 3] };
                            assert!((d - exact).abs() < 1e-6 * 1e5, "{surface:?} {face:?} ({i}, {j}): {d} against {exact}"); // 1e-6 of k
                        }
                    }
                    let at = |spin: f64| load(&surface, *face, &[x[0], x[1], x[2]], &[x[3], x[4], x[5]], spin).unwrap().f;
                    let (up, down) = (at(0.7 + 1e-7), at(0.7 - 1e-7));
                    for i in 0..3 {
                        assert!(((up[i] - down[i]) / 2e-7 - l.dspin[i]).abs() < 1e-6 * 1e5, "{surface:?} {face:?} spin {i}");
                    }
                }
            }
        }
        assert!(touched >= 8, "{touched}");
    }

    #[test]
    fn exact_points_side_by_side_feel_what_one_feels() {
        // The last but one leaves faster than 1/D, the last has no direction.
        let places = [[0.03, -0.31, 0.38], [0.06, -0.43, 0.413], [0.11, 0.33, 0.4], [0.0, 0.6, 0.0], [0.03, 0.33, 0.36], [0.0; 3]];
        let (s, v) = ([0, 1, 2].map(|c| Lanes(places.map(|p| p[c]))), [Lanes([0.4, -0.4, 9.0, 0.1, 9.0, 0.1]); 3]);
        for surface in surfaces() {
            for exponent in [1.0, 1.5, 2.2] {
                let surface = Surface { law: Contact { exponent, ..surface.law }, ..surface.clone() };
                let (faces, n) = surface.faces();
                for face in &faces[..n] {
                    let (bare, whole) = (surface.loads::<false, 6>(*face, &s, &v, 0.7), surface.loads::<true, 6>(*face, &s, &v, 0.7));
                    for (i, place) in places.iter().enumerate() {
                        let (bare, l, one) = (bare.at(i), whole.at(i), load(&surface, *face, place, &lane(&v, i), 0.7));
                        assert_eq!(one.map_or([0.0; 3], |l| l.f), l.f, "{face:?} {place:?}");
                        assert_eq!((bare.f, bare.normal), (l.f, l.normal));
                        let all = l.ds.iter().chain(&l.dv).flatten().chain(&l.dspin);
                        assert!(if one.is_some() { all.clone().all(|x| x.is_finite()) } else { all.clone().all(|x| *x == 0.0) }, "{l:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn exact_forces_end_at_the_rim_and_beside_it() {
        let grooved = &surfaces()[3];
        let (faces, _) = grooved.faces();
        let at = |y: f64, h: f64| faces.map(|f| load(grooved, f, &[y, 0.5 + h, 0.0], &[0.0; 3], 0.0).map_or(0.0, |l| l.normal));
        assert_eq!(at(0.0, 0.01), [0.0, 0.0]); // in the open between the flanks
        assert!(at(-0.03, 0.05)[0] > 0.0 && at(-0.03, 0.05)[1] == 0.0); // on the first flank
        assert_eq!(at(-0.06, 0.1001), [0.0, 0.0]); // over the rim
        assert_eq!(at(0.049 + 0.081, 0.05), [0.0, 0.0]); // beside it
        assert!(grooved.beyond(&[0.13, 0.55, 0.0]) > 0.0 && grooved.beyond(&[0.0, 0.55, 0.0]) < 0.0);
    }
}
