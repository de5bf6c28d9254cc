//! The section's laws: from r_p, r_pp and their rates to the resisting forces conjugate to them, with exact derivatives.
//!
//! | measure | `engineering` | `green` |
//! |---|---|---|
//! | ε | ‖r_p‖ − 1 | ½(r_p·r_p − 1) |
//! | κ | ‖r_p × r_pp‖ / ‖r_p‖² | ‖r_p × r_pp‖ / ‖r_p‖³ |
//!
//! Elastic energy per length ½EA ε² + ½EI κ² (the first with max(ε, 0) for a cable that cannot be pushed). Damping: either
//! `kelvin_voigt`, axial c_a ε̇ and bending c_b β̇ with β = √(κ² + κ0²) (objective: both are scalars of the shape, so a rigid motion gives
//! no force; κ0 only keeps the direction defined where the cable is straight), or the thesis's `gradient_rate`, c ṙ_p.

use crate::math::lanes::{Mat3, Vec3, add_identity, add_outer, axpy, dot, mat_vec, scale, zero_mat};
use crate::scene::{Cable, Compression, Damping, Strain};

/// Constants of a section, ready for the kernel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// EA, N.
    pub ea: f64,
    /// EI, N·m².
    pub ei: f64,
    /// Green strain and geometric curvature instead of the engineering pair.
    pub green: bool,
    /// No axial stiffness in compression.
    pub tension_only: bool,
    /// c_a, N·s.
    pub axial_damping: f64,
    /// Whether c_a acts while ε ≤ 0 in a tension-only section.
    pub damp_in_slack: bool,
    /// c_b, N·m²·s.
    pub bending_damping: f64,
    /// κ0, 1/m.
    pub straight_curvature: f64,
    /// c of the gradient-rate damping, N·s.
    pub gradient_damping: f64,
}

/// κ0 d: the curvature below which bending damping fades, as a fraction of 1/d. Where a cable is all but straight its curvature has no direction to
/// speak of, and turns through a half circle at an inflection; the damping of its magnitude follows, so an integrator must too. At a radius of 50
/// diameters a wire that runs over a sheave needs a tenth of the sub-steps that it needs at 1000, and bent to the usual 20 it keeps 6/7 of its
/// damping.
const STRAIGHT: f64 = 2e-2;

impl Section {
    /// From a checked scene.
    pub fn new(cable: &Cable) -> Self {
        let (axial_damping, bending_damping, damp_in_slack, gradient_damping) = match cable.damping {
            Damping::KelvinVoigt { axial, bending, in_slack } => (axial, bending, in_slack, 0.0),
            Damping::GradientRate { coefficient } => (0.0, 0.0, true, coefficient),
        };
        Self {
            ea: cable.ea,
            ei: cable.ei,
            green: cable.strain == Strain::Green,
            tension_only: cable.compression == Compression::None,
            axial_damping,
            damp_in_slack,
            bending_damping,
            straight_curvature: STRAIGHT / cable.diameter,
            gradient_damping,
        }
    }

    /// Whether any rate enters the forces.
    pub fn is_damped(&self) -> bool {
        self.axial_damping > 0.0 || self.bending_damping > 0.0 || self.gradient_damping > 0.0
    }

    /// Whether r_pp enters the forces.
    pub fn bends(&self) -> bool {
        self.ei > 0.0 || self.bending_damping > 0.0
    }
}

/// Shape and rate of shape at a point of the cable.
#[derive(Clone, Copy, Debug)]
pub struct Strains {
    /// r_p.
    pub p: Vec3<f64>,
    /// r_pp, 1/m.
    pub pp: Vec3<f64>,
    /// ṙ_p, 1/s.
    pub vp: Vec3<f64>,
    /// ṙ_pp, 1/(m·s).
    pub vpp: Vec3<f64>,
}

/// Resisting forces per length and their derivatives. `k` are derivatives by (r_p, r_pp). Those by the rates are sums of dyads,
/// c_a (g, 0) ⊗ (g, 0) + c_b (e2, e1) ⊗ (e2, e1), beside the gradient-rate damping's c I.
#[derive(Clone, Copy, Debug)]
pub struct Resistance {
    /// Conjugate to r_p, N.
    pub n: Vec3<f64>,
    /// Conjugate to r_pp, N·m.
    pub m: Vec3<f64>,
    /// ∂n/∂r_p.
    pub k_pp: Mat3<f64>,
    /// ∂n/∂r_pp.
    pub k_pq: Mat3<f64>,
    /// ∂m/∂r_p.
    pub k_qp: Mat3<f64>,
    /// ∂m/∂r_pp.
    pub k_qq: Mat3<f64>,
    /// c_a where it acts, N·s.
    pub c_axial: f64,
    /// g = ∂ε/∂r_p.
    pub g: Vec3<f64>,
    /// N = σ(ε) + c_a ε̇, N.
    pub axial: f64,
    /// ∂N/∂r_p, N.
    pub by_p: Vec3<f64>,
    /// dσ/dε, N.
    pub ea: f64,
    /// c_b/β², N·m⁴·s.
    pub c_bending: f64,
    /// β ∂β/∂r_p, 1/m².
    pub e2: Vec3<f64>,
    /// β ∂β/∂r_pp, 1/m.
    pub e1: Vec3<f64>,
    /// Elastic energy per length, J/m.
    pub energy: f64,
    /// Rate of the elastic energy per length, W/m.
    pub power: f64,
}

impl Resistance {
    #[inline(always)]
    fn zero() -> Self {
        let (z, o) = ([0.0; 3], zero_mat());
        Self {
            n: z,
            m: z,
            k_pp: o,
            k_pq: o,
            k_qp: o,
            k_qq: o,
            c_axial: 0.0,
            g: z,
            axial: 0.0,
            by_p: z,
            ea: 0.0,
            c_bending: 0.0,
            e2: z,
            e1: z,
            energy: 0.0,
            power: 0.0,
        }
    }
}

impl Section {
    /// Axial strain.
    #[inline(always)]
    pub fn strain(&self, p: &Vec3<f64>) -> f64 {
        let l2 = dot(p, p);
        if self.green { 0.5 * (l2 - 1.0) } else { l2.sqrt() - 1.0 }
    }

    /// κ².
    #[inline(always)]
    pub fn curvature_squared(&self, p: &Vec3<f64>, pp: &Vec3<f64>) -> f64 {
        let (l2, b) = (dot(p, p), dot(p, pp));
        // Rounding may make that of a straight cable negative.
        let g = (l2 * dot(pp, pp) - b * b).max(0.0);
        g / if self.green { l2 * l2 * l2 } else { l2 * l2 }
    }

    /// The section's axial force N (model.md, "Which tension"): EA ε + c_a ε̇, for the Green pair (EA ε + c_a ε̇)‖r_p‖ − EI κ²/‖r_p‖, N.
    #[inline(always)]
    pub fn axial_force(&self, s: &Strains) -> f64 {
        let l = dot(&s.p, &s.p).sqrt();
        let eps = self.strain(&s.p);
        let rate = dot(&s.p, &s.vp) / if self.green { 1.0 } else { l };
        let taut = !self.tension_only || eps > 0.0;
        let n = if taut { self.ea * eps } else { 0.0 } + if taut || self.damp_in_slack { self.axial_damping * rate } else { 0.0 };
        if self.green { n * l - self.ei * self.curvature_squared(&s.p, &s.pp) / l } else { n }
    }

    /// Resisting forces at a point; derivatives only with `TANGENT`.
    #[inline(always)]
    pub fn resistance<const TANGENT: bool>(&self, s: &Strains) -> Resistance {
        self.resistance_carrying::<TANGENT, true>(s, 1.0, 0.0)
    }

    /// The same, but the derivatives are those of a cable whose axial force is `share` of what the law gives and `other` (N). Without
    /// `BENDING_RATE`, for sections without bending damping, what needs the curvature's rate is left out: the bending energy's.
    #[inline(always)]
    pub fn resistance_carrying<const TANGENT: bool, const BENDING_RATE: bool>(&self, s: &Strains, share: f64, other: f64) -> Resistance {
        let mut out = Resistance::zero();
        let inverse = self.axial::<TANGENT>(s, share, other, &mut out);
        if self.bends() {
            self.bending::<TANGENT, BENDING_RATE>(s, inverse, &mut out);
        }
        out.n = axpy(&out.n, self.gradient_damping, &s.vp);
        out
    }

    /// The axial part alone.
    #[inline(always)]
    pub fn tension(&self, s: &Strains) -> Resistance {
        let mut out = Resistance::zero();
        self.axial::<false>(s, 1.0, 0.0, &mut out);
        out
    }

    /// n = N g with g = ∂ε/∂r_p; gives 1/λ².
    #[inline(always)]
    fn axial<const TANGENT: bool>(&self, s: &Strains, share: f64, other: f64, out: &mut Resistance) -> f64 {
        let l2 = dot(&s.p, &s.p);
        // g = r_p/λ or r_p; ∂g/∂r_p = c (I − b g gᵀ).
        let l = l2.sqrt();
        let inverse = 1.0 / l;
        let (eps, c, b) = if self.green { ((l2 - 1.0) * 0.5, 1.0, 0.0) } else { (l - 1.0, inverse, 1.0) };
        let g = scale(c, &s.p);
        let taut = if self.tension_only && eps <= 0.0 { 0.0 } else { 1.0 };
        let damped = if self.damp_in_slack { 1.0 } else { taut };
        let rate = dot(&g, &s.vp);
        let (ea, ca) = (taut * self.ea, damped * self.axial_damping);
        let elastic = ea * eps;
        let n = elastic + ca * rate;
        out.n = scale(n, &g);
        (out.g, out.axial, out.ea, out.c_axial) = (g, n, ea, ca);
        // ∂ε̇/∂r_p = ∂g/∂r_p ṙ_p = c (ṙ_p − b ε̇ g).
        out.by_p = axpy(&scale(ea - ca * c * b * rate, &g), ca * c, &s.vp);
        out.energy += elastic * eps * 0.5;
        out.power += elastic * rate;
        if TANGENT {
            // K = g ⊗ ∂N/∂r_p + N ∂g/∂r_p.
            let turn = (share * n + other) * c;
            add_outer(&mut out.k_pp, 1.0, &g, &axpy(&out.by_p, -turn * b, &g));
            add_identity(&mut out.k_pp, turn);
        }
        inverse * inverse
    }

    /// With κ² = G λ^(−2m), G = ‖r_p × r_pp‖², and (e2, e1) = ½ ∂κ²/∂(r_p, r_pp): n = B e2, m = B e1, B = EI + c_b β̇/β; `i`: 1/λ².
    #[inline(always)]
    fn bending<const TANGENT: bool, const BENDING_RATE: bool>(&self, s: &Strains, i: f64, out: &mut Resistance) {
        let m = if self.green { 3.0 } else { 2.0 };
        let (l, a, b) = (dot(&s.p, &s.p), dot(&s.pp, &s.pp), dot(&s.p, &s.pp));
        let pw = i * i * if self.green { i } else { 1.0 };
        let k2 = (l * a - b * b).max(0.0) * pw; // κ²
        // d1 = l r_pp − b r_p, d2 = a r_p − b r_pp.
        let d1 = axpy(&scale(l, &s.pp), -b, &s.p);
        let d2 = axpy(&scale(a, &s.p), -b, &s.pp);
        let e1 = scale(pw, &d1);
        let e2 = axpy(&scale(pw, &d2), -(k2 * i * m), &s.p);
        out.energy += k2 * (0.5 * self.ei);
        if !BENDING_RATE && !TANGENT {
            out.n = axpy(&out.n, self.ei, &e2);
            out.m = scale(self.ei, &e1);
            return;
        }
        let rate = dot(&e1, &s.vpp) + dot(&e2, &s.vp); // κκ̇ = ββ̇
        let ib2 = 1.0 / (k2 + self.straight_curvature * self.straight_curvature);
        let cb = ib2 * self.bending_damping; // c_b/β²
        let stiffness = self.ei + cb * rate;
        out.n = axpy(&out.n, stiffness, &e2);
        out.m = scale(stiffness, &e1);
        out.power += rate * self.ei;
        if TANGENT {
            // H = ∂(e2, e1)/∂(r_p, r_pp); h12 = ∂e1/∂r_p, its transpose ∂e2/∂r_pp.
            let mut h11 = zero_mat();
            add_identity(&mut h11, pw * l);
            add_outer(&mut h11, -pw, &s.p, &s.p);
            let f = pw * i * (2.0 * m);
            let mut h12 = zero_mat();
            add_identity(&mut h12, -(pw * b));
            add_outer(&mut h12, pw + pw, &s.pp, &s.p);
            add_outer(&mut h12, -pw, &s.p, &s.pp);
            add_outer(&mut h12, -f, &d1, &s.p);
            let mut h22 = zero_mat();
            add_identity(&mut h22, pw * a - k2 * i * m);
            add_outer(&mut h22, -pw, &s.pp, &s.pp);
            add_outer(&mut h22, -f, &d2, &s.p);
            add_outer(&mut h22, -f, &s.p, &d2);
            add_outer(&mut h22, k2 * i * i * (2.0 * m * (m + 1.0)), &s.p, &s.p);
            // ∂B/∂x = c_b (H ẋ/β² − 2 rate e/β⁴),   ∂B/∂ẋ = c_b e/β².
            let h12t_vpp: Vec3<f64> = std::array::from_fn(|c| h12[0][c] * s.vpp[0] + h12[1][c] * s.vpp[1] + h12[2][c] * s.vpp[2]);
            let hv2 = axpy(&mat_vec(&h22, &s.vp), 1.0, &h12t_vpp);
            let hv1 = axpy(&mat_vec(&h12, &s.vp), 1.0, &mat_vec(&h11, &s.vpp));
            let back = -(rate * ib2 * 2.0);
            let b2 = scale(cb, &axpy(&hv2, back, &e2));
            let b1 = scale(cb, &axpy(&hv1, back, &e1));
            for r in 0..3 {
                for c in 0..3 {
                    out.k_pp[r][c] += stiffness * h22[r][c] + e2[r] * b2[c];
                    out.k_pq[r][c] += stiffness * h12[c][r] + e2[r] * b1[c];
                    out.k_qp[r][c] += stiffness * h12[r][c] + e1[r] * b2[c];
                    out.k_qq[r][c] += stiffness * h11[r][c] + e1[r] * b1[c];
                }
            }
            (out.c_bending, out.e2, out.e1) = (cb, e2, e1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sections() -> Vec<Section> {
        let base = Section {
            ea: 3.0e3,
            ei: 0.7,
            green: false,
            tension_only: false,
            axial_damping: 5.0,
            damp_in_slack: true,
            bending_damping: 0.2,
            straight_curvature: 0.05,
            gradient_damping: 0.0,
        };
        vec![
            base,
            Section { green: true, ..base },
            Section { tension_only: true, damp_in_slack: false, ..base },
            Section { axial_damping: 0.0, bending_damping: 0.0, gradient_damping: 0.3, ..base },
        ]
    }

    fn state() -> Strains {
        Strains { p: [0.9, 0.35, -0.4], pp: [1.1, -2.0, 0.7], vp: [0.3, -0.8, 0.5], vpp: [-1.2, 0.4, 2.2] }
    }

    fn forces(s: &Section, x: &[f64; 12]) -> ([f64; 6], f64) {
        let g = |i: usize| [x[i], x[i + 1], x[i + 2]];
        let r = s.resistance::<false>(&Strains { p: g(0), pp: g(3), vp: g(6), vpp: g(9) });
        ([r.n[0], r.n[1], r.n[2], r.m[0], r.m[1], r.m[2]], r.energy)
    }

    fn flat(s: &Strains) -> [f64; 12] {
        let mut x = [0.0; 12];
        for (i, v) in [s.p, s.pp, s.vp, s.vpp].iter().enumerate() {
            x[3 * i..3 * i + 3].copy_from_slice(v);
        }
        x
    }

    #[test]
    fn exact_tangent_matches_central_differences() {
        for s in sections() {
            let x = flat(&state());
            let r = s.resistance::<true>(&state());
            let scale = forces(&s, &x).0.iter().fold(0.0f64, |a, f| a.max(f.abs()));
            for j in 0..12 {
                let h = 1e-6;
                let (mut up, mut down) = (x, x);
                up[j] += h;
                down[j] -= h;
                let (fu, fd) = (forces(&s, &up).0, forces(&s, &down).0);
                for i in 0..6 {
                    let (a, b) = (i % 3, j % 3);
                    let exact = match (i / 3, j / 3) {
                        (0, 0) => r.k_pp[a][b],
                        (0, 1) => r.k_pq[a][b],
                        (1, 0) => r.k_qp[a][b],
                        (1, 1) => r.k_qq[a][b],
                        (0, 2) => {
                            r.c_axial * r.g[a] * r.g[b] + r.c_bending * r.e2[a] * r.e2[b] + if a == b { s.gradient_damping } else { 0.0 }
                        }
                        (0, 3) => r.c_bending * r.e2[a] * r.e1[b],
                        (1, 2) => r.c_bending * r.e1[a] * r.e2[b],
                        _ => r.c_bending * r.e1[a] * r.e1[b],
                    };
                    let d = (fu[i] - fd[i]) / (2.0 * h);
                    // Rounding eps/h times the force, and h² truncation.
                    assert!((d - exact).abs() < 3e-9 * scale, "{s:?} ({i}, {j}): {d} against {exact}");
                }
            }
        }
    }

    #[test]
    fn exact_elastic_force_is_the_energy_gradient() {
        for s in sections() {
            let s = Section { axial_damping: 0.0, bending_damping: 0.0, gradient_damping: 0.0, ..s };
            let x = flat(&state());
            let f = forces(&s, &x).0;
            for j in 0..6 {
                let h = 1e-6;
                let (mut up, mut down) = (x, x);
                up[j] += h;
                down[j] -= h;
                let d = (forces(&s, &up).1 - forces(&s, &down).1) / (2.0 * h);
                assert!((d - f[j]).abs() < 1e-6 * f[j].abs().max(1.0), "{s:?} {j}: {d} against {}", f[j]);
            }
        }
    }

    #[test]
    fn exact_rigid_rotation_meets_no_kelvin_voigt_force() {
        let w = [0.7, -1.9, 0.4];
        let cross = |a: [f64; 3]| [w[1] * a[2] - w[2] * a[1], w[2] * a[0] - w[0] * a[2], w[0] * a[1] - w[1] * a[0]];
        for s in sections().into_iter().take(3) {
            let still = Strains { vp: [0.0; 3], vpp: [0.0; 3], ..state() };
            let turning = Strains { vp: cross(still.p), vpp: cross(still.pp), ..still };
            let (a, b) = (forces(&s, &flat(&still)).0, forces(&s, &flat(&turning)).0);
            for i in 0..6 {
                assert!((a[i] - b[i]).abs() < 1e-12 * a[i].abs().max(1.0), "{s:?} {i}"); // rounding
            }
        }
    }

    #[test]
    fn exact_straight_cables_have_no_curvature() {
        for s in sections() {
            for k in 0..1000 {
                let (x, y, z) = ((f64::from(k)).sin(), (1.7 * f64::from(k)).cos(), 0.3 * (0.2 * f64::from(k)).sin());
                // r_pp along r_p: what rounding leaves may have either sign.
                let (p, stretch) = ([x, y, z], 0.1 * (3.1 * f64::from(k)).sin());
                let k2 = s.curvature_squared(&p, &scale(stretch, &p));
                assert!((0.0..1e-12).contains(&k2), "{s:?} {k}: {k2}");
            }
        }
    }

    #[test]
    fn exact_slack_section_has_no_axial_force() {
        let s = Section { bending_damping: 0.0, ei: 0.0, ..sections()[2] };
        let x = Strains { p: [0.5, 0.2, -0.4], ..state() };
        assert_eq!(forces(&s, &flat(&x)).0, [0.0; 6]);
        assert_eq!(s.axial_force(&x), 0.0);
    }
}
