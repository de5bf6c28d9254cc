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
use crate::math::lanes::{Mat3, Vec3, add_identity, add_outer, axpy, dot, scale, zero_mat};
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

    /// ω with its derivatives by h and |y|.
    #[inline]
    fn extent(&self, h: f64, y: f64) -> (f64, f64, f64) {
        if self.depth.is_infinite() {
            return (1.0, 0.0, 0.0);
        }
        let (a, da) = fall((h - (1.0 - FADE) * self.depth) / (FADE * self.depth));
        let half = 0.5 * self.diameter;
        let (b, db) = fall((y - self.half_width(self.depth) - half) / half);
        (a * b, da * b / (FADE * self.depth), a * db / half)
    }
}

/// From 1 at x ≤ 0 to 0 at x ≥ 1 with two continuous derivatives, and its slope.
#[inline]
fn fall(x: f64) -> (f64, f64) {
    if x <= 0.0 {
        (1.0, 0.0)
    } else if x >= 1.0 {
        (0.0, 0.0)
    } else {
        (1.0 - x * x * x * (10.0 + x * (6.0 * x - 15.0)), -30.0 * x * x * (1.0 - x) * (1.0 - x))
    }
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

    /// Forces on points side by side at `s` that move with `v` relative to the ship while the surface turns at `spin` (rad/s), and their parts
    /// normal to the face, N/m; zero without contact.
    #[inline(always)]
    pub fn forces<const N: usize>(&self, face: Face, s: &[[f64; N]; 3], v: &[[f64; N]; 3], spin: f64) -> ([[f64; N]; 3], [f64; N]) {
        let (mut rho, mut depth, mut gain) = ([0.0; N], [0.0; N], [0.0; N]);
        // Radial unit vector and normal.
        let (mut e, mut n) = ([[0.0; N]; 2], [[face.axial; N]; 3]);
        let mut rate = [0.0; N];
        for i in 0..N {
            rho[i] = (s[1][i] * s[1][i] + s[2][i] * s[2][i]).sqrt();
            depth[i] = (-(face.axial * s[0][i] + face.radial * (rho[i] - self.radius))).max(0.0);
            for c in 0..2 {
                e[c][i] = s[c + 1][i] / rho[i];
                n[c + 1][i] = face.radial * e[c][i];
            }
            rate[i] = n[0][i] * v[0][i] + n[1][i] * v[1][i] + n[2][i] * v[2][i];
            gain[i] = (1.0 - self.law.damping * rate[i]).max(0.0);
        }
        let mut normal = hunt_crossley::powers(self.law.exponent, &depth);
        for i in 0..N {
            normal[i] *= self.law.stiffness * gain[i];
        }
        if let Some(g) = &self.groove
            && g.depth.is_finite()
        {
            for i in 0..N {
                normal[i] *= g.extent(rho[i] - self.radius, s[0][i].abs()).0;
            }
        }
        for i in 0..N {
            // On the axis itself there is no direction, and no load.
            normal[i] = if rho[i] > 0.0 { normal[i] } else { 0.0 };
        }
        let mut f = [[0.0; N]; 3];
        for c in 0..3 {
            for i in 0..N {
                f[c][i] = if normal[i] > 0.0 { normal[i] * n[c][i] } else { 0.0 };
            }
        }
        if let Some(Friction { coefficient, slip_speed }) = self.friction {
            for i in 0..N {
                let t = [0.0, -e[1][i], e[0][i]];
                let slip: Vec3<f64> = std::array::from_fn(|c| v[c][i] - rate[i] * n[c][i] - spin * rho[i] * t[c]);
                let speed = (dot(&slip, &slip) + slip_speed * slip_speed).sqrt();
                for c in 0..3 {
                    f[c][i] -= if normal[i] > 0.0 { coefficient * normal[i] / speed * slip[c] } else { 0.0 };
                }
            }
        }
        (f, normal)
    }

    /// The force on one point with its derivatives, as in [`Surface::forces`]; `None` without contact.
    #[inline(always)]
    pub fn load(&self, face: Face, s: &Vec3<f64>, v: &Vec3<f64>, spin: f64) -> Option<PointLoad> {
        let rho = (s[1] * s[1] + s[2] * s[2]).sqrt();
        let h = rho - self.radius;
        let depth = -(face.axial * s[0] + face.radial * h);
        if depth <= 0.0 || rho == 0.0 {
            return None;
        }
        let (weight, by_h, by_y) = self.groove.as_ref().map_or((1.0, 0.0, 0.0), |g| g.extent(h, s[0].abs()));
        if weight == 0.0 {
            return None;
        }
        let by_y = by_y * if s[0] < 0.0 { -1.0 } else { 1.0 };
        let (e1, e2) = (s[1] / rho, s[2] / rho);
        let (e, t): (Vec3<f64>, Vec3<f64>) = ([0.0, e1, e2], [0.0, -e2, e1]);
        let n = [face.axial, face.radial * e1, face.radial * e2];
        let vn = dot(&n, v);
        let Pressure { force, by_depth, by_rate } = hunt_crossley::pressure(&self.law, depth, -vn);
        let normal = weight * force;
        let mut load = PointLoad { f: scale(normal, &n), normal, ds: zero_mat(), dv: zero_mat(), dspin: [0.0; 3] };
        let vt = dot(&t, v);
        // ∂n/∂s = (n_r/ρ) t tᵀ, so ∂δ̇/∂s = −(n_r/ρ) v_t t.
        let hoop = face.radial / rho;
        let mut grad = axpy(&scale(-weight * by_depth, &n), -weight * by_rate * hoop * vt, &t);
        grad = axpy(&grad, force * by_h, &e);
        grad[0] += force * by_y;
        add_outer(&mut load.ds, 1.0, &n, &grad);
        add_outer(&mut load.ds, normal * hoop, &t, &t);
        add_outer(&mut load.dv, -weight * by_rate, &n, &n);
        if let Some(Friction { coefficient, slip_speed }) = self.friction {
            let slip = axpy(&axpy(v, -vn, &n), -spin * rho, &t);
            let speed = (dot(&slip, &slip) + slip_speed * slip_speed).sqrt();
            let d = scale(1.0 / speed, &slip);
            load.f = axpy(&load.f, -coefficient * normal, &d);
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
                let along: Vec3<f64> = std::array::from_fn(|c| (0..3).map(|r| d[r] * by[r][c]).sum());
                for r in 0..3 {
                    for c in 0..3 {
                        m[r][c] += mu * (by[r][c] - d[r] * along[c]);
                    }
                }
            }
        }
        Some(load)
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

    #[test]
    fn exact_tangent_matches_central_differences() {
        // In the open, in the fading part of the groove's depth, and beside its rim.
        let places = [[0.03, -0.31, 0.38, 0.4, -0.7, 0.2], [0.06, -0.43, 0.413, -0.4, 0.7, 0.2], [0.11, 0.33, 0.4, 0.4, -0.3, 0.2]];
        let mut touched = 0;
        for surface in surfaces() {
            let (faces, n) = surface.faces();
            for face in &faces[..n] {
                for x in places {
                    let f = |x: &[f64; 6]| surface.load(*face, &[x[0], x[1], x[2]], &[x[3], x[4], x[5]], 0.7);
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
                    let at = |spin: f64| surface.load(*face, &[x[0], x[1], x[2]], &[x[3], x[4], x[5]], spin).unwrap().f;
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
        let (s, v) = ([0, 1, 2].map(|c| places.map(|p| p[c])), [[0.4, -0.4, 9.0, 0.1, 9.0, 0.1]; 3]);
        for surface in surfaces() {
            for exponent in [1.0, 1.5, 2.2] {
                let surface = Surface { law: Contact { exponent, ..surface.law }, ..surface.clone() };
                let (faces, n) = surface.faces();
                for face in &faces[..n] {
                    let (f, normal) = surface.forces(*face, &s, &v, 0.7);
                    for (i, place) in places.iter().enumerate() {
                        let one = surface.load(*face, place, &[v[0][i], v[1][i], v[2][i]], 0.7);
                        let (of, on) = one.map_or(([0.0; 3], 0.0), |l| (l.f, l.normal));
                        // Rounding of forces up to 1e5 N/m.
                        assert!((normal[i] - on).abs() < 1e-9 && (0..3).all(|c| (f[c][i] - of[c]).abs() < 1e-9), "{face:?} {place:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn exact_forces_end_at_the_rim_and_beside_it() {
        let grooved = &surfaces()[3];
        let (faces, _) = grooved.faces();
        let at = |y: f64, h: f64| faces.map(|f| grooved.load(f, &[y, 0.5 + h, 0.0], &[0.0; 3], 0.0).map_or(0.0, |l| l.normal));
        assert_eq!(at(0.0, 0.01), [0.0, 0.0]); // in the open between the flanks
        assert!(at(-0.03, 0.05)[0] > 0.0 && at(-0.03, 0.05)[1] == 0.0); // on the first flank
        assert_eq!(at(-0.06, 0.1001), [0.0, 0.0]); // over the rim
        assert_eq!(at(0.049 + 0.081, 0.05), [0.0, 0.0]); // beside it
        assert!(grooved.beyond(&[0.13, 0.55, 0.0]) > 0.0 && grooved.beyond(&[0.0, 0.55, 0.0]) < 0.0);
    }
}
