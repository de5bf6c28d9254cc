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
use crate::math::lanes::{Lanes, Mat3, Vec3, add_identity, add_outer, axpy, dot, lane, scale, set_lane, zero_mat};
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
    /// Whether the law is `cross_flow`, else `loading_functions`.
    pub cross_flow: bool,
    cd: Curve,
    /// G.
    gain: f64,
    /// C_dt of `cross_flow`.
    tangential: f64,
    /// Heights of the current's profile.
    heights: Vec<f64>,
    /// The profile below the first height, between each and the next, above the last.
    layers: Vec<Layer>,
}

/// A stretch of the current's profile.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Layer {
    z: f64,
    /// (v_x, v_y) at z.
    v: [f64; 2],
    /// Its derivative by z.
    slope: [f64; 2],
}

/// The fluid's velocity and its derivative by height.
pub type Stream = (Vec3<f64>, Vec3<f64>);

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
pub struct LinePoint {
    /// Height, m.
    pub z: f64,
    /// Velocity, m/s.
    pub v: Vec3<f64>,
    /// r_p.
    pub p: Vec3<f64>,
    /// ṙ_p, 1/s (for the energy ledger).
    pub vp: Vec3<f64>,
    /// Acceleration, m/s².
    pub a: Vec3<f64>,
    /// Velocity relative to the ledger's frame, m/s (for the energy ledger).
    pub w: Vec3<f64>,
}

/// Force per length and its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct LineLoad {
    /// N/m.
    pub f: Vec3<f64>,
    /// ∂f/∂z.
    pub dz: Vec3<f64>,
    /// ∂f/∂ṙ.
    pub dv: Mat3<f64>,
    /// ∂f/∂r_p.
    pub dp: Mat3<f64>,
    /// Added mass, −∂f/∂r̈, kg/m.
    pub mass: Mat3<f64>,
    /// ½ wᵀ Ṁ w, W/m: what a turning added mass does to the kinetic energy.
    pub turning: f64,
}

/// Points side by side; see [`LinePoint`].
#[derive(Clone, Copy, Debug)]
pub struct LinePoints<const N: usize> {
    z: Lanes<N>,
    v: [Lanes<N>; 3],
    p: [Lanes<N>; 3],
    vp: [Lanes<N>; 3],
    a: [Lanes<N>; 3],
    w: [Lanes<N>; 3],
}

impl<const N: usize> LinePoints<N> {
    /// None yet.
    pub const NONE: Self = {
        let none = [Lanes::ZERO; 3];
        Self { z: Lanes::ZERO, v: none, p: none, vp: none, a: none, w: none }
    };

    /// Point `l`.
    #[inline(always)]
    pub fn at(&self, l: usize) -> LinePoint {
        let x = |x: &[Lanes<N>; 3]| lane(x, l);
        LinePoint { z: self.z.0[l], v: x(&self.v), p: x(&self.p), vp: x(&self.vp), a: x(&self.a), w: x(&self.w) }
    }

    /// Sets point `l`.
    #[inline(always)]
    pub fn set(&mut self, l: usize, x: &LinePoint) {
        self.z.0[l] = x.z;
        for (to, from) in [(&mut self.v, x.v), (&mut self.p, x.p), (&mut self.vp, x.vp), (&mut self.a, x.a), (&mut self.w, x.w)] {
            set_lane(to, l, from);
        }
    }
}

/// Loads on points side by side; see [`LineLoad`]. Matrices row by row.
#[derive(Clone, Copy, Debug)]
pub struct LineLoads<const N: usize> {
    pub(crate) f: [Lanes<N>; 3],
    pub(crate) dz: [Lanes<N>; 3],
    pub(crate) dv: [Lanes<N>; 9],
    pub(crate) dp: [Lanes<N>; 9],
    pub(crate) mass: [Lanes<N>; 9],
    pub(crate) turning: Lanes<N>,
}

impl<const N: usize> LineLoads<N> {
    const ZERO: Self = Self {
        f: [Lanes::ZERO; 3],
        dz: [Lanes::ZERO; 3],
        dv: [Lanes::ZERO; 9],
        dp: [Lanes::ZERO; 9],
        mass: [Lanes::ZERO; 9],
        turning: Lanes::ZERO,
    };

    /// That on point `l`.
    #[inline(always)]
    pub fn at(&self, l: usize) -> LineLoad {
        let matrix = |m: &[Lanes<N>; 9]| std::array::from_fn(|r| std::array::from_fn(|c| m[3 * r + c].0[l]));
        LineLoad {
            f: lane(&self.f, l),
            dz: lane(&self.dz, l),
            dv: matrix(&self.dv),
            dp: matrix(&self.dp),
            mass: matrix(&self.mass),
            turning: self.turning.0[l],
        }
    }

    #[inline(always)]
    fn set<const TANGENT: bool>(&mut self, l: usize, load: &LineLoad) {
        set_lane(&mut self.f, l, load.f);
        self.turning.0[l] = load.turning;
        if TANGENT {
            set_lane(&mut self.dz, l, load.dz);
            for (to, from) in [(&mut self.dv, &load.dv), (&mut self.dp, &load.dp), (&mut self.mass, &load.mass)] {
                set_lane(to, l, std::array::from_fn(|k| from[k / 3][k % 3]));
            }
        }
    }
}

impl LineInWater {
    /// From a checked scene.
    pub fn new(fluid: &Fluid, diameter: f64, gravity: f64) -> Self {
        let area = std::f64::consts::PI * diameter * diameter / 4.0;
        let displaced = fluid.density * area;
        let (cross_flow, cd, tangential, gain) = match &fluid.drag {
            Drag::LoadingFunctions { cd, amplification } => (false, cd, 0.0, *amplification),
            Drag::CrossFlow { normal, tangential, amplification } => (true, normal, *tangential, *amplification),
        };
        Self {
            waterline: fluid.waterline,
            diameter,
            buoyancy: displaced * gravity,
            displaced,
            added_mass: displaced * fluid.added_mass,
            c0: 0.5 * fluid.density * diameter,
            reynolds: fluid.viscosity.map_or(0.0, |mu| diameter * fluid.density / mu),
            cross_flow,
            cd: Curve::new(cd),
            gain,
            tangential,
            heights: fluid.current.iter().map(|p| p[0]).collect(),
            layers: layers(&fluid.current),
        }
    }

    /// Height of a horizontal piece of line that is just all under water, m.
    pub fn full(&self) -> f64 {
        self.waterline - 0.5 * self.diameter
    }

    /// Height of a horizontal piece of line that just touches the water, m.
    pub fn dry(&self) -> f64 {
        self.waterline + 0.5 * self.diameter
    }

    /// Velocity of the current's profile at height z and its derivative by z.
    #[inline(always)]
    pub fn profile(&self, z: f64) -> Stream {
        // Profiles have few points: a search that counts is quicker than one that halves.
        let layer = &self.layers[self.heights.iter().filter(|h| **h <= z).count()];
        let d = z - layer.z;
        ([layer.v[0] + layer.slope[0] * d, layer.v[1] + layer.slope[1] * d, 0.0], [layer.slope[0], layer.slope[1], 0.0])
    }

    /// The fluid's velocity at height z.
    #[inline(always)]
    pub fn stream(&self, z: f64, flow: &Flow) -> Stream {
        let (v, dz) = self.profile(z);
        (axpy(&v, 1.0, &flow.velocity), dz)
    }

    /// The Reynolds number that the drag coefficient is a function of.
    #[inline(always)]
    pub fn reynolds<const CROSS_FLOW: bool>(&self, x: &LinePoint, stream: &Stream) -> f64 {
        let v = axpy(&stream.0, -1.0, &x.v);
        let l2 = dot(&x.p, &x.p).max(TINY * TINY);
        let along = if CROSS_FLOW { dot(&v, &x.p) } else { 0.0 };
        let vn = axpy(&v, -along / l2, &x.p);
        dot(&vn, &vn).sqrt() * self.reynolds
    }

    /// The drag coefficient and its derivative by the Reynolds number.
    #[inline(always)]
    pub fn coefficient(&self, reynolds: f64) -> (f64, f64) {
        self.cd.at(reynolds)
    }

    /// Forces at fully submerged points side by side; derivatives only with `TANGENT`. The share of submersion is the caller's factor.
    #[inline(always)]
    pub fn loads<const TANGENT: bool, const N: usize>(&self, points: &LinePoints<N>, flow: &Flow) -> LineLoads<N> {
        if self.cross_flow { self.loads_of::<TANGENT, true, N>(points, flow) } else { self.loads_of::<TANGENT, false, N>(points, flow) }
    }

    #[inline(always)]
    fn loads_of<const TANGENT: bool, const CROSS_FLOW: bool, const N: usize>(&self, points: &LinePoints<N>, flow: &Flow) -> LineLoads<N> {
        // Copies, since only of what is its own does the compiler know that nothing else changes it. Look-ups cannot go side by side, so they
        // have loops of their own.
        let (points, flow) = (*points, *flow);
        let (mut stream, mut re, mut cd) = ([Lanes::<N>::ZERO; 6], Lanes::<N>::ZERO, [Lanes::<N>::ZERO; 2]);
        for l in 0..N {
            let (v, dz) = self.stream(points.z.0[l], &flow);
            set_lane(&mut stream, l, [v[0], v[1], v[2], dz[0], dz[1], dz[2]]);
        }
        let stream_at = |l: usize| {
            let [a, b, c, d, e, f] = lane(&stream, l);
            ([a, b, c], [d, e, f])
        };
        for l in 0..N {
            re.0[l] = self.reynolds::<CROSS_FLOW>(&points.at(l), &stream_at(l));
        }
        for l in 0..N {
            set_lane(&mut cd, l, self.coefficient(re.0[l]).into());
        }
        let mut out = LineLoads::ZERO;
        for l in 0..N {
            out.set::<TANGENT>(l, &self.load_in::<TANGENT, CROSS_FLOW>(&points.at(l), &stream_at(l), lane(&cd, l).into(), &flow));
        }
        out
    }

    /// The same where the fluid's velocity and the drag coefficient (with its derivative by the Reynolds number) are known.
    #[inline(always)]
    pub fn load_in<const TANGENT: bool, const CROSS_FLOW: bool>(
        &self,
        x: &LinePoint,
        stream: &Stream,
        cd: (f64, f64),
        flow: &Flow,
    ) -> LineLoad {
        let v = axpy(&stream.0, -1.0, &x.v);
        let stretch = dot(&x.p, &x.p).sqrt().max(TINY);
        let shrink = 1.0 / stretch;
        let t = scale(shrink, &x.p);
        let vt = dot(&v, &t);
        let vn = axpy(&v, -vt, &t);
        let drag = if CROSS_FLOW { self.cross_flow(cd, &v, vt, &vn, &t) } else { self.loading_functions(cd, &v, vt, &vn, &t) };
        let mut out = LineLoad { f: [0.0; 3], dz: [0.0; 3], dv: zero_mat(), dp: zero_mat(), mass: zero_mat(), turning: 0.0 };
        // b = r̈ − v̇_fluid; added-mass force −μ(b − t (t·b)), and Froude-Krylov's ρA v̇_fluid.
        let b = axpy(&x.a, -1.0, &flow.acceleration);
        let mu = self.added_mass;
        let along = dot(&t, &b);
        let across = axpy(&b, -along, &t);
        for c in 0..3 {
            out.f[c] = drag.alpha * vn[c] + drag.tau * t[c] + self.displaced * flow.acceleration[c] - mu * across[c];
        }
        out.f[2] += self.buoyancy;
        // ½ wᵀṀw with Ṁ = −μ(ṫtᵀ + tṫᵀ).
        let turn = axpy(&x.vp, -dot(&x.vp, &t), &t);
        out.turning = -(mu * dot(&x.w, &t) * dot(&x.w, &turn) * shrink);
        if TANGENT {
            let n = scale(1.0 / dot(&vn, &vn).sqrt().max(TINY * TINY), &vn);
            add_outer(&mut out.dv, -1.0, &n, &drag.n_by_v);
            add_outer(&mut out.dv, -1.0, &t, &drag.t_by_v);
            add_identity(&mut out.dv, -drag.alpha);
            for r in 0..3 {
                out.dz[r] = -dot(&out.dv[r], &stream.1);
            }
            // By t, with δt = (I − t tᵀ) δr_p/‖r_p‖; of the added mass δf = μ(δt (t·b) + t (b·δt)).
            let turned = axpy(&scale(drag.t_by_t, &vn), mu, &across);
            let direct = (drag.by_t + mu * along) * shrink;
            add_outer(&mut out.dp, drag.n_by_t * shrink, &n, &vn);
            add_outer(&mut out.dp, shrink, &t, &turned);
            add_outer(&mut out.dp, -direct, &t, &t);
            add_identity(&mut out.dp, direct);
            add_identity(&mut out.mass, mu);
            add_outer(&mut out.mass, -mu, &t, &t);
        }
        out
    }

    #[inline(always)]
    fn loading_functions(&self, cd: (f64, f64), v: &Vec3<f64>, vt: f64, vn: &Vec3<f64>, t: &Vec3<f64>) -> LineDrag {
        let speed = dot(v, v).sqrt().max(TINY);
        let normal = dot(vn, vn).sqrt().max(TINY * TINY);
        let (sign, i) = (if vt < 0.0 { -1.0 } else { 1.0 }, 1.0 / speed);
        let (c, s) = (vt.abs() * i, normal * i);
        let dcd = cd.1 * self.reynolds; // dC/d‖v‖
        let c1 = 1.0 / (1.0 + c);
        let lift = 0.9 + c * 0.8;
        let phi = s * lift * c1 + 0.1 - c * 0.022;
        let (fq, dfq) = f_q(c, s);
        // f = α v_n + τ t.
        let (an, at) = (cd.0 * (self.c0 * self.gain), cd.0 * self.c0);
        let alpha = an * phi * speed;
        let tau = at * fq * speed * speed * sign;
        // φ by c and s on the circle c² + s² = 1: dφ = (φ_c − φ_s c/s) dc, and c/s·(v_n …) stays finite through n̂.
        let phi_c = s * c1 * (0.8 - lift * c1) - 0.022;
        let bend = an * (phi_c * normal - lift * c1 * c * speed);
        // ∇_v c = g/‖v‖ with g = sign t − c v̂ = s ĝ, and ∇_v η = −g/(s‖v‖).
        let unit = scale(i, v);
        let g: Vec3<f64> = std::array::from_fn(|k| sign * t[k] - c * unit[k]);
        let grow = (an + dcd * (self.c0 * self.gain) * speed) * phi * normal;
        let pull = (at * 2.0 + dcd * self.c0 * speed) * fq * speed * sign;
        let swing = at * dfq * speed / s.max(1e-12);
        // By the tangent's direction, δt ⟂ t: δ(v·t) = v_n·δt, δc = sign v_n·δt/‖v‖, δη = −δc/s.
        LineDrag {
            alpha,
            tau,
            n_by_v: std::array::from_fn(|k| grow * unit[k] + bend * g[k]),
            t_by_v: std::array::from_fn(|k| pull * unit[k] - swing * sign * g[k] - alpha * t[k]),
            n_by_t: bend * sign,
            t_by_t: -alpha - swing,
            by_t: tau - alpha * vt,
        }
    }

    #[inline(always)]
    fn cross_flow(&self, cd: (f64, f64), _: &Vec3<f64>, vt: f64, vn: &Vec3<f64>, t: &Vec3<f64>) -> LineDrag {
        let normal = dot(vn, vn).sqrt().max(TINY);
        let alpha = cd.0 * (self.c0 * self.gain) * normal;
        let ct = self.c0 * std::f64::consts::PI * self.tangential;
        let tau = vt.abs() * vt * ct;
        let grow = (cd.0 + cd.1 * self.reynolds * normal) * (self.c0 * self.gain);
        let slope = vt.abs() * (2.0 * ct);
        // δv_n = −(v_n·δt) t − v_t δt; δ‖v_n‖ = −v_t n̂·δt.
        LineDrag {
            alpha,
            tau,
            n_by_v: scale(grow, vn),
            t_by_v: scale(slope - alpha, t),
            n_by_t: -(grow * vt),
            t_by_t: slope - alpha,
            by_t: tau - alpha * vt,
        }
    }
}

/// Drag α v_n + τ t, v_n = ‖v_n‖ n. Its derivatives are n ⊗ `n_by_v` + t ⊗ `t_by_v` + α I by v and, for δt ⟂ t,
/// (`n_by_t` n + `t_by_t` t) ⊗ v_n + `by_t` I by t.
struct LineDrag {
    alpha: f64,
    tau: f64,
    n_by_v: Vec3<f64>,
    t_by_v: Vec3<f64>,
    n_by_t: f64,
    t_by_t: f64,
    by_t: f64,
}

/// The profile through (z, v_x, v_y), constant beyond its ends.
fn layers(current: &[[f64; 3]]) -> Vec<Layer> {
    let at = |p: &[f64; 3]| Layer { z: p[0], v: [p[1], p[2]], slope: [0.0; 2] };
    let mut out = vec![current.first().map_or(Layer::default(), at)];
    out.extend(current.iter().map(at));
    for (i, pair) in current.windows(2).enumerate() {
        out[i + 1].slope = std::array::from_fn(|c| (pair[1][c + 1] - pair[0][c + 1]) / (pair[1][0] - pair[0][0]));
    }
    out
}

/// The tangential loading function and its derivative, from (cos η, sin η), η in [0, π/2]; cut at 0.
#[inline(always)]
fn f_q(c: f64, s: f64) -> (f64, f64) {
    let e = angle(c, s);
    let f = 0.01 * (2.008 + e * (-0.3858 + e * (1.9159 + e * (-4.16147 + e * (3.5064 - e * 1.187299)))));
    let d = 0.01 * (-0.3858 + e * (3.8318 + e * (-12.48441 + e * (14.0256 - e * 5.936495))));
    (f.max(0.0), if f > 0.0 { d } else { 0.0 })
}

/// atan x = x + x³ Σ a_k x^(2k) on |x| ≤ tan π/8, error 3e-19: interpolation at the Chebyshev nodes in x².
const ATAN: [f64; 11] = [
    -0.333_333_333_333_331_2,
    0.199_999_999_999_408_93,
    -0.142_857_142_792_502_45,
    0.111_111_107_449_196_58,
    -0.090_908_968_090_640_27,
    0.076_920_453_309_022_25,
    -0.066_629_518_136_291_91,
    0.058_468_782_973_308_72,
    -0.050_351_024_566_015_52,
    0.037_965_257_453_865_93,
    -0.017_805_397_205_419_446,
];

/// atan2(s, c) for s, c ≥ 0 on the unit circle, without branches: θ = 2 atan(tan θ/2) of the smaller of η and π/2 − η.
#[inline(always)]
fn angle(c: f64, s: f64) -> f64 {
    let x = s.min(c) / (1.0 + s.max(c));
    let z = x * x;
    let mut sum = 0.0;
    for k in (0..ATAN.len()).rev() {
        sum = sum * z + ATAN[k];
    }
    let theta = 2.0 * (x + x * z * sum);
    if s > c { std::f64::consts::FRAC_PI_2 - theta } else { theta }
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
            noise: None,
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

    fn load<const TANGENT: bool>(water: &LineInWater, x: &LinePoint, flow: &Flow) -> LineLoad {
        let mut points = LinePoints::<1>::NONE;
        points.set(0, x);
        water.loads::<TANGENT, 1>(&points, flow).at(0)
    }

    /// x = (z, v, r_p).
    fn force(water: &LineInWater, x: &[f64; 7]) -> LineLoad {
        let point = LinePoint { z: x[0], v: [x[1], x[2], x[3]], p: [x[4], x[5], x[6]], vp: [0.0; 3], a: [0.5, 0.2, -0.7], w: [0.0; 3] };
        load::<true>(water, &point, &Flow { velocity: [0.05, -0.02, 0.0], acceleration: [0.3, 0.1, 0.0] })
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
    fn exact_angle_is_the_libraries() {
        for i in 0..=1000 {
            let eta = i as f64 * (std::f64::consts::FRAC_PI_2 / 1000.0);
            let (s, c) = eta.sin_cos();
            assert!((angle(c.max(0.0), s) - s.atan2(c)).abs() < 5e-16, "{eta}");
        }
    }

    #[test]
    fn paper_loading_functions_across_along_and_between() {
        let water = &waters()[0];
        let drag = |v: [f64; 3]| {
            let x = LinePoint { z: -9.0, v, p: [0.0, 0.0, 1.0], vp: [0.0; 3], a: [0.0; 3], w: [0.0; 3] };
            let mut f = load::<false>(water, &x, &Flow { velocity: [-0.1, -0.2, 0.0], acceleration: [0.0; 3] }).f;
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
