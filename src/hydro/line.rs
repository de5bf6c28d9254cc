//! Fluid force per unstretched length of a thin line, with exact derivatives.
//!
//! v is the fluid's velocity minus the line's, t the unit tangent, c0 = ½ρd.
//!
//! - `loading_functions` (Driscoll & Nahon's, as in Buckham, Driscoll & Nahon, J. Appl. Mech. 71 (2004) 476-485), η the angle between v and t:
//!   f_n = c0 C_d G f_p(η) ‖v‖² along v_n, f_t = c0 C_d f_q(η) ‖v‖² along ±t, Re of ‖v‖. With c = |cos η|, s = sin η the published
//!   f_p = 0.5 − 0.1c + 0.1s − 0.4 cos 2η − 0.011 sin 2η equals s·φ, φ = s(0.9 + 0.8c)/(1 + c) + 0.1 − 0.022c, regular at s = 0.
//!   The published f_q ends at −6.7e-5 at η = π/2, where its sign changes sides: it is cut at 0 there, so that the force has no jump.
//! - `cross_flow`: f_n = c0 C_dn(Re of ‖v_n‖) G ‖v_n‖ v_n, f_t = c0 π C_dt |v_t| v_t.
//! - added mass: −ρA C_m (I − t tᵀ)(r̈ − v̇_fluid) + ρA v̇_fluid; buoyancy ρA g upwards.

use super::curve::Curve;
use crate::math::interpolation::piecewise_linear;
use crate::math::lanes::{Mat3, Real, Vec3, add_identity, add_outer, axpy, dot, scale, zero_mat};
use crate::scene::{Drag, Fluid};

/// Still keeps directions defined where a velocity vanishes, m/s.
const TINY: f64 = 1e-30;

/// Constants of water and line, ready for the kernel.
#[derive(Clone, Debug, PartialEq)]
pub struct LineInWater {
    /// Height of the still surface, m.
    pub waterline: f64,
    /// d, m.
    pub diameter: f64,
    /// ρA g, N/m.
    buoyancy: f64,
    /// ρA, kg/m.
    displaced: f64,
    /// ρA C_m, kg/m.
    pub added_mass: f64,
    /// ½ρd, kg/m².
    c0: f64,
    /// d ρ/μ, s/m.
    reynolds: f64,
    law: Law,
    /// (z, v_x, v_y).
    current: Vec<[f64; 3]>,
}

#[derive(Clone, Debug, PartialEq)]
enum Law {
    LoadingFunctions { cd: Curve, gain: f64 },
    CrossFlow { cd: Curve, tangential: f64, gain: f64 },
}

/// The flow at the time of evaluation, beside the profile.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Flow {
    /// Uniform current, m/s.
    pub velocity: Vec3<f64>,
    /// Its rate, m/s².
    pub acceleration: Vec3<f64>,
}

/// A point of the line.
#[derive(Clone, Copy, Debug)]
pub struct LinePoint<T> {
    /// Height, m.
    pub z: T,
    /// Velocity, m/s.
    pub v: Vec3<T>,
    /// r_p.
    pub p: Vec3<T>,
    /// ṙ_p, 1/s (for the energy ledger).
    pub vp: Vec3<T>,
    /// Acceleration, m/s².
    pub a: Vec3<T>,
    /// Velocity relative to the ledger's frame, m/s (for the energy ledger).
    pub w: Vec3<T>,
}

/// Force per length and its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct LineLoad<T> {
    /// N/m.
    pub f: Vec3<T>,
    /// ∂f/∂z.
    pub dz: Vec3<T>,
    /// ∂f/∂ṙ.
    pub dv: Mat3<T>,
    /// ∂f/∂r_p.
    pub dp: Mat3<T>,
    /// Added mass, −∂f/∂r̈, kg/m.
    pub mass: Mat3<T>,
    /// ½ wᵀ Ṁ w, W/m: what a turning added mass does to the kinetic energy.
    pub turning: T,
}

impl LineInWater {
    /// From a checked scene.
    pub fn new(fluid: &Fluid, diameter: f64, gravity: f64) -> Self {
        let area = std::f64::consts::PI * diameter * diameter / 4.0;
        let displaced = fluid.density * area;
        let law = match &fluid.drag {
            Drag::LoadingFunctions { cd, amplification } => Law::LoadingFunctions { cd: Curve::new(cd), gain: *amplification },
            Drag::CrossFlow { normal, tangential, amplification } => {
                Law::CrossFlow { cd: Curve::new(normal), tangential: *tangential, gain: *amplification }
            }
        };
        Self {
            waterline: fluid.waterline,
            diameter,
            buoyancy: displaced * gravity,
            displaced,
            added_mass: displaced * fluid.added_mass,
            c0: 0.5 * fluid.density * diameter,
            reynolds: fluid.viscosity.map_or(0.0, |mu| diameter * fluid.density / mu),
            law,
            current: fluid.current.clone(),
        }
    }

    /// Profile velocity at height z and its derivative by z.
    #[inline(always)]
    pub fn profile<T: Real>(&self, z: T) -> (Vec3<T>, Vec3<T>) {
        let o = T::splat(0.0);
        if self.current.is_empty() {
            return ([o; 3], [o; 3]);
        }
        let n = self.current.len();
        let (vx, dx) = z.map2(|z| piecewise_linear(|i| (self.current[i][0], self.current[i][1]), n, z));
        let (vy, dy) = z.map2(|z| piecewise_linear(|i| (self.current[i][0], self.current[i][2]), n, z));
        ([vx, vy, o], [dx, dy, o])
    }

    /// Force at a fully submerged point; derivatives only with `TANGENT`. The share of submersion is the caller's factor.
    #[inline(always)]
    pub fn load<T: Real, const TANGENT: bool>(&self, x: &LinePoint<T>, flow: &Flow) -> LineLoad<T> {
        let one = T::splat(1.0);
        let (mut vf, dvf) = self.profile(x.z);
        for c in 0..3 {
            vf[c] += T::splat(flow.velocity[c]);
        }
        let v = [vf[0] - x.v[0], vf[1] - x.v[1], vf[2] - x.v[2]];
        let stretch = dot(&x.p, &x.p).sqrt().at_least(TINY);
        let t = scale(one / stretch, &x.p);
        let mut out = LineLoad {
            f: [T::splat(0.0); 3],
            dz: [T::splat(0.0); 3],
            dv: zero_mat(),
            dp: zero_mat(),
            mass: zero_mat(),
            turning: T::splat(0.0),
        };
        // Derivatives by v and by t first; the chain rule follows.
        let (mut dv, mut dt) = (zero_mat(), zero_mat());
        match &self.law {
            Law::LoadingFunctions { cd, gain } => self.loading_functions::<T, TANGENT>(cd, *gain, &v, &t, &mut out.f, &mut dv, &mut dt),
            Law::CrossFlow { cd, tangential, gain } => {
                self.cross_flow::<T, TANGENT>(cd, *tangential, *gain, &v, &t, &mut out.f, &mut dv, &mut dt);
            }
        }
        out.f[2] += T::splat(self.buoyancy);
        // b = r̈ − v̇_fluid; added-mass force −μ(b − t (t·b)), and Froude-Krylov's ρA v̇_fluid.
        let b: Vec3<T> = std::array::from_fn(|c| x.a[c] - T::splat(flow.acceleration[c]));
        let mu = T::splat(self.added_mass);
        let along = dot(&t, &b);
        for c in 0..3 {
            out.f[c] += T::splat(self.displaced * flow.acceleration[c]) - mu * (b[c] - along * t[c]);
        }
        // ½ wᵀṀw with Ṁ = −μ(ṫtᵀ + tṫᵀ).
        let wt = dot(&x.w, &t);
        let turn = axpy(&x.vp, -dot(&x.vp, &t), &t);
        out.turning = -(mu * wt * dot(&x.w, &turn) * (one / stretch));
        if TANGENT {
            add_identity(&mut out.mass, mu);
            add_outer(&mut out.mass, -mu, &t, &t);
            // δf = μ(δt (t·b) + t (b·δt)).
            add_identity(&mut dt, mu * along);
            add_outer(&mut dt, mu, &t, &b);
            for r in 0..3 {
                let on_t = dot(&dt[r], &t);
                for c in 0..3 {
                    out.dv[r][c] = -dv[r][c];
                    out.dp[r][c] = (dt[r][c] - on_t * t[c]) * (one / stretch);
                }
                out.dz[r] = dot(&dv[r], &dvf);
            }
        }
        out
    }

    #[inline(always)]
    fn loading_functions<T: Real, const TANGENT: bool>(
        &self,
        cd: &Curve,
        gain: f64,
        v: &Vec3<T>,
        t: &Vec3<T>,
        f: &mut Vec3<T>,
        dv: &mut Mat3<T>,
        dt: &mut Mat3<T>,
    ) {
        let one = T::splat(1.0);
        let vt = dot(v, t);
        let vn = axpy(v, -vt, t);
        let speed = dot(v, v).sqrt().at_least(TINY);
        let normal = dot(&vn, &vn).sqrt().at_least(TINY * TINY);
        let (sign, i) = (vt.sign(), one / speed);
        let (c, s) = (vt.abs() * i, normal * i);
        let (cd, dcd) = (speed * self.reynolds).map2(|re| cd.at(re));
        let dcd = dcd * self.reynolds; // dC/d‖v‖
        let c1 = one / (one + c);
        let lift = T::splat(0.9) + c * 0.8;
        let phi = s * lift * c1 + T::splat(0.1) - c * 0.022;
        let (fq, dfq) = c.zip2(s, f_q);
        // f = α v_n + τ sign t.
        let an = cd * (self.c0 * gain);
        let at = cd * self.c0;
        let alpha = an * phi * speed;
        let tau = at * fq * speed * speed;
        for k in 0..3 {
            f[k] += alpha * vn[k] + tau * sign * t[k];
        }
        if TANGENT {
            let unit = scale(i, v);
            let nhat = scale(one / normal, &vn);
            // φ by c and s on the circle c² + s² = 1: dφ = (φ_c − φ_s c/s) dc, and c/s·(v_n …) stays finite through n̂.
            let phi_c = s * (T::splat(0.8) * c1 - lift * c1 * c1) - T::splat(0.022);
            let phi_s = lift * c1;
            // ∇_v c = g/‖v‖ with g = sign t − c v̂ = s ĝ.
            let g: Vec3<T> = std::array::from_fn(|k| sign * t[k] - c * unit[k]);
            // ∂(α v_n)/∂v.
            let grow = an * phi + dcd * (self.c0 * gain) * phi * speed;
            add_outer(dv, grow, &vn, &unit);
            add_outer(dv, an * phi_c, &vn, &g);
            add_outer(dv, -(an * phi_s * c * speed), &nhat, &g);
            add_identity(dv, alpha);
            add_outer(dv, -alpha, t, t);
            // ∂(τ sign t)/∂v, ∇_v η = −ĝ/‖v‖ = −g/(s‖v‖).
            let tv = (at * fq * (speed + speed) + dcd * self.c0 * fq * speed * speed) * sign;
            add_outer(dv, tv, t, &unit);
            add_outer(dv, -(at * dfq * speed * sign / s.at_least(1e-12)), t, &g);
            // By the tangent's direction, δt ⟂ t: δ(v·t) = v_n·δt, δc = sign v_n·δt/‖v‖, δη = −δc/s.
            add_outer(dt, an * phi_c * sign, &vn, &vn);
            add_outer(dt, -(an * phi_s * c * sign * speed), &nhat, &vn);
            add_outer(dt, -alpha, t, &vn);
            add_identity(dt, -(alpha * vt));
            add_outer(dt, -(at * dfq * speed), t, &scale(one / s.at_least(1e-12), &vn));
            add_identity(dt, tau * sign);
        }
    }

    #[inline(always)]
    fn cross_flow<T: Real, const TANGENT: bool>(
        &self,
        cd: &Curve,
        tangential: f64,
        gain: f64,
        v: &Vec3<T>,
        t: &Vec3<T>,
        f: &mut Vec3<T>,
        dv: &mut Mat3<T>,
        dt: &mut Mat3<T>,
    ) {
        let one = T::splat(1.0);
        let vt = dot(v, t);
        let vn = axpy(v, -vt, t);
        let normal = dot(&vn, &vn).sqrt().at_least(TINY);
        let (cd, dcd) = (normal * self.reynolds).map2(|re| cd.at(re));
        let alpha = cd * (self.c0 * gain) * normal;
        let ct = self.c0 * std::f64::consts::PI * tangential;
        let tau = vt.abs() * vt * ct;
        for k in 0..3 {
            f[k] += alpha * vn[k] + tau * t[k];
        }
        if TANGENT {
            let nhat = scale(one / normal, &vn);
            let grow = (cd + dcd * self.reynolds * normal) * (self.c0 * gain);
            let slope = vt.abs() * (2.0 * ct);
            add_outer(dv, grow, &vn, &nhat);
            add_identity(dv, alpha);
            add_outer(dv, slope - alpha, t, t);
            // δv_n = −(v_n·δt) t − v_t δt; δ‖v_n‖ = −v_t n̂·δt.
            add_outer(dt, -(grow * vt), &vn, &nhat);
            add_outer(dt, -alpha, t, &vn);
            add_identity(dt, tau - alpha * vt);
            add_outer(dt, slope, t, &vn);
        }
    }
}

/// The tangential loading function and its derivative, from (cos η, sin η), η in [0, π/2]; cut at 0.
fn f_q(c: f64, s: f64) -> (f64, f64) {
    let e = s.atan2(c);
    let f = 0.01 * (2.008 + e * (-0.3858 + e * (1.9159 + e * (-4.16147 + e * (3.5064 - e * 1.187299)))));
    if f <= 0.0 {
        return (0.0, 0.0);
    }
    (f, 0.01 * (-0.3858 + e * (3.8318 + e * (-12.48441 + e * (14.0256 - e * 5.936495)))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Coefficient;

    fn waters() -> Vec<LineInWater> {
        let fluid = |drag| Fluid {
            density: 1026.0,
            viscosity: Some(1.2e-3),
            waterline: 10.0,
            drag,
            added_mass: 1.0,
            current: vec![[-5.0, 0.1, 0.2], [0.0, 0.4, -0.1], [3.0, 0.5, 0.3]],
        };
        [
            Drag::LoadingFunctions { cd: Coefficient::Constant(1.2), amplification: 1.7 },
            Drag::LoadingFunctions { cd: Coefficient::Cylinder, amplification: 1.7 },
            Drag::CrossFlow { normal: Coefficient::Cylinder, tangential: 0.05, amplification: 1.3 },
        ]
        .into_iter()
        .map(|d| LineInWater::new(&fluid(d), 4.5e-4, 9.81))
        .collect()
    }

    /// x = (z, v, r_p).
    fn force(water: &LineInWater, x: &[f64; 7]) -> LineLoad<f64> {
        let point = LinePoint { z: x[0], v: [x[1], x[2], x[3]], p: [x[4], x[5], x[6]], vp: [0.0; 3], a: [0.5, 0.2, -0.7], w: [0.0; 3] };
        water.load::<f64, true>(&point, &Flow { velocity: [0.05, -0.02, 0.0], acceleration: [0.3, 0.1, 0.0] })
    }

    #[test]
    fn exact_tangent_matches_central_differences() {
        for water in waters() {
            for x in [[-2.0, 0.3, -0.4, 0.2, 0.5, 0.6, -0.7], [1.0, -0.9, 0.1, 0.4, -0.2, 0.1, 1.1], [-4.0, 0.1, 0.2, 0.5, 0.02, 0.9, 0.01]]
            {
                let load = force(&water, &x);
                let scale = load.f.iter().fold(0.0f64, |a, f| a.max(f.abs()));
                for j in 0..7 {
                    let h = 1e-6;
                    let (mut up, mut down) = (x, x);
                    up[j] += h;
                    down[j] -= h;
                    let (fu, fd) = (force(&water, &up).f, force(&water, &down).f);
                    for i in 0..3 {
                        let exact = match j {
                            0 => load.dz[i],
                            1..=3 => load.dv[i][j - 1],
                            _ => load.dp[i][j - 4],
                        };
                        let d = (fu[i] - fd[i]) / (2.0 * h);
                        // Truncation and rounding of the difference.
                        assert!((d - exact).abs() < 1e-6 * scale, "({i}, {j}): {d} against {exact}");
                    }
                }
            }
        }
    }

    #[test]
    fn paper_loading_functions_across_along_and_between() {
        let water = &waters()[0];
        let drag = |v: [f64; 3]| {
            let x = LinePoint { z: -9.0, v, p: [0.0, 0.0, 1.0], vp: [0.0; 3], a: [0.0; 3], w: [0.0; 3] };
            let mut f = water.load::<f64, false>(&x, &Flow { velocity: [-0.1, -0.2, 0.0], acceleration: [0.0; 3] }).f;
            f[2] -= water.buoyancy;
            f
        };
        let c = water.c0 * 1.2;
        // Across: f_p(π/2) = 0.5 + 0.1 + 0.4 = 1; along: f_q(0) = 0.02008.
        let across = drag([-2.0, 0.0, 0.0]);
        assert!((across[0] - c * 1.7 * 4.0).abs() < 1e-12 * across[0] && across[2].abs() < 1e-12);
        let along = drag([0.0, 0.0, -2.0]);
        assert!((along[2] - c * 0.02008 * 4.0).abs() < 1e-12 && along[0].abs() < 1e-12);
        // At 45 degrees, from the published formula.
        let (eta, v2) = (std::f64::consts::FRAC_PI_4, 2.0);
        let fp = 0.5 - 0.1 * eta.cos() + 0.1 * eta.sin() - 0.4 * (2.0 * eta).cos() - 0.011 * (2.0 * eta).sin();
        let both = drag([-1.0, 0.0, -1.0]);
        assert!((both[0] - c * 1.7 * fp * v2).abs() < 1e-12);
    }

    #[test]
    fn exact_drag_does_not_jump_where_the_flow_changes_sides() {
        for water in waters() {
            let f = |vz: f64| force(&water, &[-9.0, 1.0, 0.0, vz, 0.0, 0.0, 1.0]).f[2];
            let (up, down) = (f(1e-9), f(-1e-9));
            assert!((up - down).abs() < 1e-6 * f(1.0).abs(), "{up} {down}");
        }
    }
}
