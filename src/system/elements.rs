//! One pass over the elements, several side by side: internal forces, weight, inertia and, where an element is all under water, fluid forces;
//! with `TANGENT` also M, D and K.

use super::environment::Environment;
use super::matrices::{Matrices, element_block};
use super::mixed::AxialUnknown;
use super::wetting::{Height, bounds};
use crate::cable::section::{Section, Strains};
use crate::cable::shape;
use crate::hydro::line::{LineInWater, LinePoint, Stream};
use crate::integrator::Stage;
use crate::linalg::BlockTridiagonal;
use crate::math::lanes::{Kernel, Lanes, Vec3, axpy, dot, lane, scale, set_lane, widest};
use crate::math::quadrature::GAUSS3;

/// Elements side by side.
const LANES: usize = 8;
type Row = Lanes<LANES>;
/// Vectors and matrices of each.
type Rows3 = [Row; 3];
type Rows33 = [Row; 9];

/// Sums over the cable that the energy ledger and the integrator want.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// Elastic energy, J.
    pub elastic: f64,
    /// Its rate, W.
    pub elastic_power: f64,
    /// ½ wᵀ M w, J.
    pub kinetic: f64,
    /// ½ wᵀ Ṁ w, W.
    pub turning: f64,
}

/// How much of an element is under water.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wetness {
    /// Not at all.
    Dry,
    /// The surface crosses it.
    Partial,
    /// Entirely.
    Full,
}

/// The chain of elements.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    /// Unstretched lengths, m.
    pub lengths: Vec<f64>,
    /// Mass per length, kg/m.
    pub mass_per_length: f64,
    /// Laws of the section.
    pub section: Section,
    /// Fluid forces.
    pub water: Option<LineInWater>,
}

/// u, w of the four slots of an element.
#[inline(always)]
pub fn gather(x: &[f64], e: usize) -> [Vec3<f64>; 4] {
    let x = &x[6 * e..6 * e + 12];
    [[x[0], x[1], x[2]], [x[3], x[4], x[5]], [x[6], x[7], x[8]], [x[9], x[10], x[11]]]
}

#[inline(always)]
fn gather_lane(x: &[f64], e: usize, length: f64, l: usize, to: &mut [Rows3; 4]) {
    let q = gather(x, e);
    for c in 0..3 {
        to[0][c].0[l] = q[0][c];
        to[1][c].0[l] = q[1][c] * length;
        to[2][c].0[l] = q[2][c];
        to[3][c].0[l] = q[3][c] * length;
    }
}

/// Slots and differences of slots that r_p depends on: r(L) − r(0), L r_p(0), L r_p(L).
const SPANS: usize = 3;

/// Where the axial forces come from.
#[derive(Clone, Copy, Debug)]
pub enum Axially<'a> {
    /// From the strains; with a tangent the unknowns begin anew from there.
    Law,
    /// A step begins with the unknowns as they are (tangents only; the forces themselves are those of the law).
    Begin,
    /// From the unknowns, at a stage of the step that has begun.
    Stage(Stage<'a>),
    /// From the unknowns, at an iterate of Newton's method.
    Iterate {
        /// Whether it is the stage's first.
        first: bool,
    },
}

/// Which of these a pass is compiled for: the law's forces, those of a stage, those of an iterate.
const LAW: u8 = 0;
const STAGE: u8 = 1;
const ITERATE: u8 = 2;

/// Axial unknowns at the Gauss points of elements side by side.
pub type Axial = [AxialUnknown<LANES>; 3];

/// N of every Gauss point, element by element.
pub fn axial_forces(axial: &[Axial]) -> impl Iterator<Item = &f64> {
    axial.iter().flat_map(|points| (0..LANES).flat_map(move |l| points.iter().map(move |p| &p.now.0[l])))
}

/// The same, to be set.
pub fn axial_forces_mut(axial: &mut [Axial]) -> impl Iterator<Item = &mut f64> {
    axial.iter_mut().flat_map(|[a, b, c]| {
        let points = a.now.0.iter_mut().zip(&mut b.now.0).zip(&mut c.now.0);
        points.flat_map(|((a, b), c)| [a, b, c])
    })
}

/// A Gauss point of the element of unit length, on whose slots (r(0), L r_p(0), r(L), L r_p(L)) the shape functions are pure numbers.
#[derive(Clone, Copy)]
struct Station {
    weight: f64,
    /// s.
    s: [f64; 4],
    /// ds/dξ by span.
    b: [f64; SPANS],
    /// d²s/dξ² by span.
    d: [f64; SPANS],
}

impl Station {
    #[inline(always)]
    fn new((x, weight): (f64, f64)) -> Self {
        let ([_, b1, ba, b3], [_, d1, da, d3]) = (shape::slope(x, 1.0), shape::second(x, 1.0));
        Self { weight, s: shape::value(x, 1.0), b: [ba, b1, b3], d: [da, d1, d3] }
    }
}

/// Elements side by side as elements of unit length.
#[derive(Default)]
struct Batch {
    length: Row,
    inverse: Row,
    /// 1 where all under water.
    wet: Row,
    /// Slots of u, w, a.
    u: [Rows3; 4],
    w: [Rows3; 4],
    a: [Rows3; 4],
    /// Forces on the slots.
    f: [Rows3; 4],
    elastic: Row,
    power: Row,
    kinetic: Row,
    turning: Row,
}

/// What the tangent needs of a Gauss point, of elements side by side.
#[derive(Clone, Copy)]
struct Slopes {
    /// Weighted derivatives of the resistance by ξ-derivatives.
    k_pp: Rows33,
    k_pq: Rows33,
    k_qp: Rows33,
    k_qq: Rows33,
    /// Weighted dampings and their dyads' vectors, see `Resistance`.
    c_axial: Row,
    g: Rows3,
    c_bending: Row,
    e: [Rows3; SPANS],
    /// Weighted derivatives of the fluid force.
    dz: Rows3,
    dv: Rows33,
    dp: Rows33,
    mass: Rows33,
}

const NONE: Rows33 = [Row::ZERO; 9];
const STILL: Slopes = Slopes {
    k_pp: NONE,
    k_pq: NONE,
    k_qp: NONE,
    k_qq: NONE,
    c_axial: Row::ZERO,
    g: [Row::ZERO; 3],
    c_bending: Row::ZERO,
    e: [[Row::ZERO; 3]; SPANS],
    dz: [Row::ZERO; 3],
    dv: NONE,
    dp: NONE,
    mass: NONE,
};

struct Pass<'a, const TANGENT: bool> {
    chain: &'a Chain,
    env: &'a Environment,
    u: &'a [f64],
    w: &'a [f64],
    a: Option<&'a [f64]>,
    axially: Axially<'a>,
    axial: &'a mut [Axial],
    forces: &'a mut [[f64; 12]],
    matrices: &'a mut Matrices,
}

impl<const TANGENT: bool> Kernel for Pass<'_, TANGENT> {
    type Output = Tally;

    #[inline(always)]
    fn run(self) -> Tally {
        let Self { chain, env, u, w, a, axially, axial, forces, matrices } = self;
        match axially {
            Axially::Iterate { .. } => chain.pass_with::<TANGENT, ITERATE>(env, u, w, a, axially, axial, forces, matrices),
            Axially::Stage(_) => chain.pass_with::<TANGENT, STAGE>(env, u, w, a, axially, axial, forces, matrices),
            _ => chain.pass_with::<TANGENT, LAW>(env, u, w, a, axially, axial, forces, matrices),
        }
    }
}

impl Chain {
    /// Room for the axial forces of all elements.
    pub fn axial(&self) -> Vec<Axial> {
        vec![[AxialUnknown::NONE; 3]; self.lengths.len().div_ceil(LANES)]
    }

    /// How much of element `e` is under water.
    pub fn wetness(&self, water: &LineInWater, env: &Environment, u: &[f64], e: usize) -> (Wetness, Height) {
        let q = gather(u, e);
        let z = env.base[2].0[0];
        let height = Height::new(q[0][2] + z, q[1][2], q[2][2] + z, q[3][2], self.lengths[e]);
        let w = if height.bounds.1 <= water.full() {
            Wetness::Full
        } else if height.bounds.0 >= water.dry() {
            Wetness::Dry
        } else {
            Wetness::Partial
        };
        (w, height)
    }

    /// Overwrites `forces` (12 per element: all that acts on the element's own slots, inertia included) and, with `TANGENT`, adds M, D and K of
    /// F − M(u) a to `matrices`. `a`: acceleration relative to the first node; without it no inertia relative to the first node. `axially`:
    /// see there.
    pub fn pass<const TANGENT: bool>(
        &self,
        env: &Environment,
        u: &[f64],
        w: &[f64],
        a: Option<&[f64]>,
        axially: Axially,
        axial: &mut [Axial],
        forces: &mut [[f64; 12]],
        matrices: &mut Matrices,
    ) -> Tally {
        widest(Pass::<TANGENT> { chain: self, env, u, w, a, axially, axial, forces, matrices })
    }

    #[inline(always)]
    fn pass_with<const TANGENT: bool, const OF: u8>(
        &self,
        env: &Environment,
        u: &[f64],
        w: &[f64],
        a: Option<&[f64]>,
        axially: Axially,
        axial: &mut [Axial],
        forces: &mut [[f64; 12]],
        matrices: &mut Matrices,
    ) -> Tally {
        let mut tally = Tally::default();
        let stations = GAUSS3.map(Station::new);
        let mut slopes = [STILL; 3];
        let mut batch = Batch::default();
        for first in (0..self.lengths.len()).step_by(LANES) {
            let lanes = LANES.min(self.lengths.len() - first);
            self.gather_batch(env, first, u, w, a, &mut batch);
            for ((station, slopes), axial) in stations.iter().zip(&mut slopes).zip(&mut axial[first / LANES]) {
                self.resist::<TANGENT, OF>(&mut batch, station, slopes, axially, axial);
            }
            let wet = batch.wet.0.iter().any(|x| *x > 0.0);
            if let Some(water) = &self.water
                && wet
            {
                for (station, slopes) in stations.iter().zip(&mut slopes) {
                    if water.cross_flow {
                        immerse::<TANGENT, true>(water, env, &mut batch, station, slopes);
                    } else {
                        immerse::<TANGENT, false>(water, env, &mut batch, station, slopes);
                    }
                }
            }
            self.weigh(env, &mut batch);
            for l in 0..lanes {
                tally.elastic += batch.elastic.0[l];
                tally.elastic_power += batch.power.0[l];
                tally.turning += batch.turning.0[l];
                tally.kinetic += batch.kinetic.0[l];
                let out = &mut forces[first + l];
                for i in 0..4 {
                    out[3 * i..3 * i + 3].copy_from_slice(&lane(&batch.f[i], l));
                }
            }
            if TANGENT {
                let to = Place { first, lanes, length: &batch.length };
                stiffness(&stations, &slopes, wet, &to, &mut matrices.stiffness);
                self.damping(&stations, &slopes, wet, &batch.inverse, &to, &mut matrices.damping);
                self.inertia(&stations, &slopes, wet, &to, &mut matrices.mass);
            }
        }
        tally
    }

    /// The step that began with the last tangent ends at (u, w), of the stages' increments weighted so.
    pub fn accept(&self, u: &[f64], w: &[f64], weights: &[f64], axial: &mut [Axial]) {
        axial.iter_mut().flatten().for_each(|a| a.enter(weights));
        self.at_stations(u, w, axial, |axial, l, strains| axial.end(l, &self.section.resistance::<false>(strains), strains));
    }

    /// Newton's method has ended at (u, w).
    pub fn settle(&self, u: &[f64], w: &[f64], axial: &mut [Axial]) {
        self.at_stations(u, w, axial, |axial, l, strains| axial.settle(l, strains));
    }

    /// Calls `each` with every axial unknown and the slopes there.
    fn at_stations(&self, u: &[f64], w: &[f64], axial: &mut [Axial], each: impl Fn(&mut AxialUnknown<LANES>, usize, &Strains)) {
        let stations = GAUSS3.map(Station::new);
        for (k, axial) in axial.iter_mut().enumerate() {
            for (station, axial) in stations.iter().zip(axial) {
                for l in 0..LANES.min(self.lengths.len() - k * LANES) {
                    let e = k * LANES + l;
                    let length = self.lengths[e];
                    let slope = |x: &[f64]| {
                        let q = gather(x, e);
                        along(&station.b, &[axpy(&q[2], -1.0, &q[0]), scale(length, &q[1]), scale(length, &q[3])], 1.0 / length)
                    };
                    each(axial, l, &Strains { p: slope(u), pp: [0.0; 3], vp: slope(w), vpp: [0.0; 3] });
                }
            }
        }
    }

    /// Fills a batch with the elements from `first` on.
    #[inline(always)]
    fn gather_batch(&self, env: &Environment, first: usize, u: &[f64], w: &[f64], a: Option<&[f64]>, batch: &mut Batch) {
        for l in 0..LANES {
            // Beyond the last element the last one again, whose results are left.
            let e = (first + l).min(self.lengths.len() - 1);
            let length = self.lengths[e];
            batch.length.0[l] = length;
            gather_lane(u, e, length, l, &mut batch.u);
            gather_lane(w, e, length, l, &mut batch.w);
            if let Some(a) = a {
                gather_lane(a, e, length, l, &mut batch.a);
            }
        }
        let z = env.base[2].0[0];
        let full = self.water.as_ref().map_or(f64::NEG_INFINITY, LineInWater::full);
        for l in 0..LANES {
            batch.inverse.0[l] = 1.0 / batch.length.0[l];
            let u = &batch.u;
            let (_, high) = bounds(u[0][2].0[l] + z, u[1][2].0[l], u[2][2].0[l] + z, u[3][2].0[l]);
            batch.wet.0[l] = if high <= full { 1.0 } else { 0.0 };
        }
        batch.f = [[Row::ZERO; 3]; 4];
        for sum in [&mut batch.elastic, &mut batch.power, &mut batch.kinetic, &mut batch.turning] {
            *sum = Row::ZERO;
        }
    }

    /// Internal forces at a Gauss point.
    #[inline(always)]
    fn resist<const TANGENT: bool, const OF: u8>(
        &self,
        batch: &mut Batch,
        station: &Station,
        slopes: &mut Slopes,
        axially: Axially,
        axial: &mut AxialUnknown<LANES>,
    ) {
        let section = self.section;
        let Station { weight, b, d, .. } = *station;
        let stage = match axially {
            Axially::Stage(stage) => stage,
            _ => Stage { index: 0, weights: &[] },
        };
        if OF == STAGE {
            axial.enter(stage.weights);
        }
        let first = if matches!(axially, Axially::Iterate { first: true }) { 1.0 } else { 0.0 };
        let anew = if matches!(axially, Axially::Law) { 1.0 } else { 0.0 };
        for l in 0..LANES {
            let i = batch.inverse.0[l];
            let (u, w) = (spans(&batch.u, l), spans(&batch.w, l));
            let strains = Strains { p: along(&b, &u, i), pp: along(&d, &u, i * i), vp: along(&b, &w, i), vpp: along(&d, &w, i * i) };
            let mut r = section.resistance_carrying::<TANGENT>(&strains, anew, if TANGENT { (1.0 - anew) * axial.now.0[l] } else { 0.0 });
            if TANGENT {
                axial.begin(l, &r, &strains, anew);
            }
            if OF == STAGE {
                r.n = axial.force(l, stage.index, &r, &strains);
            } else if OF == ITERATE {
                r.n = axial.iterate(l, first, &r, &strains);
            }
            let wl = weight * batch.length.0[l];
            batch.elastic.0[l] += wl * r.energy;
            batch.power.0[l] += wl * r.power;
            for c in 0..3 {
                let (n, m) = (weight * r.n[c], weight * i * r.m[c]);
                let a = b[0] * n + d[0] * m;
                batch.f[0][c].0[l] += a;
                batch.f[1][c].0[l] -= b[1] * n + d[1] * m;
                batch.f[2][c].0[l] -= a;
                batch.f[3][c].0[l] -= b[2] * n + d[2] * m;
            }
            if TANGENT {
                let x = weight * i;
                let flat = |s: f64, m: &[[f64; 3]; 3]| -> [f64; 9] { std::array::from_fn(|k| s * m[k / 3][k % 3]) };
                set_lane(&mut slopes.k_pp, l, flat(x, &r.k_pp));
                set_lane(&mut slopes.k_pq, l, flat(x * i, &r.k_pq));
                set_lane(&mut slopes.k_qp, l, flat(x * i, &r.k_qp));
                set_lane(&mut slopes.k_qq, l, flat(x * i * i, &r.k_qq));
                slopes.c_axial.0[l] = x * r.c_axial;
                set_lane(&mut slopes.g, l, r.g);
                slopes.c_bending.0[l] = x * r.c_bending;
                for k in 0..SPANS {
                    for c in 0..3 {
                        slopes.e[k][c].0[l] = b[k] * r.e2[c] + d[k] * i * r.e1[c];
                    }
                }
            }
        }
    }

    /// Weight, the moving frame's and the element's own inertia; then forces on the slots of the true length.
    #[inline(always)]
    fn weigh(&self, env: &Environment, batch: &mut Batch) {
        let (total, mass) = (shape::integral(1.0), shape::mass(1.0));
        for c in 0..3 {
            let field = env.gravity[c] - env.base[c].0[2];
            for l in 0..LANES {
                let length = batch.length.0[l];
                let scale = length * self.mass_per_length;
                let mut twice = 0.0;
                for i in 0..4 {
                    let m = &mass[i];
                    let product = |x: &[Rows3; 4]| m[0] * x[0][c].0[l] + m[1] * x[1][c].0[l] + m[2] * x[2][c].0[l] + m[3] * x[3][c].0[l];
                    twice += product(&batch.w) * batch.w[i][c].0[l];
                    let f = batch.f[i][c].0[l] + scale * (total[i] * field - product(&batch.a));
                    batch.f[i][c].0[l] = if i % 2 == 1 { f * length } else { f };
                }
                batch.kinetic.0[l] += 0.5 * scale * twice;
            }
        }
    }

    /// D of elements side by side.
    #[inline(always)]
    fn damping(&self, stations: &[Station; 3], slopes: &[Slopes; 3], wet: bool, inverse: &Row, to: &Place, out: &mut BlockTridiagonal) {
        if !(wet || self.section.is_damped()) {
            return;
        }
        let c = self.section.gradient_damping;
        let across = moments(stations, |x| (x.s, x.s.map(|s| -s)));
        let mut t = [[Row::ZERO; 4]; 4];
        for r in 0..3 {
            for col in 0..3 {
                if self.section.is_damped() {
                    let mut on = [[Row::ZERO; SPANS]; SPANS];
                    for (station, at) in stations.iter().zip(slopes) {
                        let b = &station.b;
                        let direct = if r == col { c * station.weight } else { 0.0 };
                        for l in 0..LANES {
                            let axial = at.c_axial.0[l] * at.g[r].0[l] * at.g[col].0[l] + direct * inverse.0[l];
                            for j in 0..SPANS {
                                let (x, e) = (axial * b[j], at.c_bending.0[l] * at.e[j][col].0[l]);
                                for i in 0..SPANS {
                                    on[i][j].0[l] += b[i] * x + at.e[i][r].0[l] * e;
                                }
                            }
                        }
                    }
                    spread(&on, &mut t);
                } else {
                    t = [[Row::ZERO; 4]; 4];
                }
                if wet {
                    let rc = 3 * r + col;
                    add_moments(&across, [&slopes[0].dv[rc], &slopes[1].dv[rc], &slopes[2].dv[rc]], &mut t);
                }
                to.scatter(&mut t, r, col, out);
            }
        }
    }

    /// M of elements side by side.
    #[inline(always)]
    fn inertia(&self, stations: &[Station; 3], slopes: &[Slopes; 3], wet: bool, to: &Place, out: &mut BlockTridiagonal) {
        for l in 0..to.lanes {
            let (e, mass) = (to.first + l, shape::mass(to.length.0[l]));
            for i in 0..4 {
                for j in 0..4 {
                    let block = element_block(out, e, i, j);
                    for c in 0..3 {
                        block[3 * (i % 2) + c][3 * (j % 2) + c] += mass[i][j] * self.mass_per_length;
                    }
                }
            }
        }
        if !wet {
            return;
        }
        let across = moments(stations, |x| (x.s, x.s));
        for r in 0..3 {
            for c in 0..3 {
                let mut t = [[Row::ZERO; 4]; 4];
                let rc = 3 * r + c;
                add_moments(&across, [&slopes[0].mass[rc], &slopes[1].mass[rc], &slopes[2].mass[rc]], &mut t);
                to.scatter(&mut t, r, c, out);
            }
        }
    }
}

/// Lane `l` of a Gauss point as the water sees it.
#[inline(always)]
fn fluid_point(env: &Environment, batch: &Batch, station: &Station, l: usize) -> LinePoint {
    let (s, b, i) = (&station.s, &station.b, batch.inverse.0[l]);
    let (u, w, a) = (value(s, &batch.u, l), value(s, &batch.w, l), value(s, &batch.a, l));
    let base = &env.base;
    LinePoint {
        z: u[2] + base[2].0[0],
        v: [w[0] + base[0].0[1], w[1] + base[1].0[1], w[2] + base[2].0[1]],
        p: along(b, &spans(&batch.u, l), i),
        vp: along(b, &spans(&batch.w, l), i),
        a: [a[0] + base[0].0[2], a[1] + base[1].0[2], a[2] + base[2].0[2]],
        w,
    }
}

#[inline(always)]
fn stream_lane(x: &[Rows3; 2], l: usize) -> Stream {
    (lane(&x[0], l), lane(&x[1], l))
}

/// Lane `l` of Σ s_i q_i.
#[inline(always)]
fn value(s: &[f64; 4], q: &[Rows3; 4], l: usize) -> Vec3<f64> {
    std::array::from_fn(|c| s[0] * q[0][c].0[l] + s[1] * q[1][c].0[l] + s[2] * q[2][c].0[l] + s[3] * q[3][c].0[l])
}

/// Fluid forces at a Gauss point.
#[inline(always)]
fn immerse<const TANGENT: bool, const CROSS_FLOW: bool>(
    water: &LineInWater,
    env: &Environment,
    batch: &mut Batch,
    station: &Station,
    slopes: &mut Slopes,
) {
    let Station { weight, s, .. } = *station;
    // Look-ups cannot go side by side, so they have loops of their own.
    let (mut z, mut re, mut cd) = (Row::ZERO, Row::ZERO, [Row::ZERO; 2]);
    let mut stream = [[Row::ZERO; 3]; 2];
    for l in 0..LANES {
        z.0[l] = fluid_point(env, batch, station, l).z;
    }
    for l in 0..LANES {
        let (v, dz) = water.stream(z.0[l], &env.flow);
        set_lane(&mut stream[0], l, v);
        set_lane(&mut stream[1], l, dz);
    }
    for l in 0..LANES {
        re.0[l] = water.reynolds::<CROSS_FLOW>(&fluid_point(env, batch, station, l), &stream_lane(&stream, l));
    }
    for l in 0..LANES {
        set_lane(&mut cd, l, water.coefficient(re.0[l]).into());
    }
    for l in 0..LANES {
        let x = fluid_point(env, batch, station, l);
        let load = water.load_in::<TANGENT, CROSS_FLOW>(&x, &stream_lane(&stream, l), lane(&cd, l).into(), &env.flow);
        let wl = weight * batch.length.0[l] * batch.wet.0[l];
        let (w2, wp, p2) = (dot(&x.w, &x.w), dot(&x.w, &x.p), dot(&x.p, &x.p));
        batch.turning.0[l] += wl * load.turning;
        batch.kinetic.0[l] += wl * (w2 - wp * wp / p2) * (0.5 * water.added_mass);
        for c in 0..3 {
            let f = wl * load.f[c];
            for i in 0..4 {
                batch.f[i][c].0[l] += s[i] * f;
            }
        }
        if TANGENT {
            let flat = |s: f64, m: &[[f64; 3]; 3]| -> [f64; 9] { std::array::from_fn(|k| s * m[k / 3][k % 3]) };
            set_lane(&mut slopes.dz, l, scale(wl, &load.dz));
            set_lane(&mut slopes.dv, l, flat(wl, &load.dv));
            set_lane(&mut slopes.dp, l, flat(wl * batch.inverse.0[l], &load.dp));
            set_lane(&mut slopes.mass, l, flat(wl, &load.mass));
        }
    }
}

/// K of elements side by side.
#[inline(always)]
fn stiffness(stations: &[Station; 3], slopes: &[Slopes; 3], wet: bool, to: &Place, out: &mut BlockTridiagonal) {
    let by_p = moments(stations, |x| (x.s, [x.b[0], -x.b[1], -x.b[0], -x.b[2]]));
    let by_z = moments(stations, |x| (x.s, x.s.map(|s| -s)));
    let mut t = [[Row::ZERO; 4]; 4];
    for r in 0..3 {
        for c in 0..3 {
            let rc = 3 * r + c;
            let mut on = [[Row::ZERO; SPANS]; SPANS];
            for (station, at) in stations.iter().zip(slopes) {
                let Station { b, d, .. } = station;
                for l in 0..LANES {
                    let (pp, pq, qp, qq) = (at.k_pp[rc].0[l], at.k_pq[rc].0[l], at.k_qp[rc].0[l], at.k_qq[rc].0[l]);
                    for j in 0..SPANS {
                        let (n, m) = (pp * b[j] + pq * d[j], qp * b[j] + qq * d[j]);
                        for i in 0..SPANS {
                            on[i][j].0[l] += b[i] * n + d[i] * m;
                        }
                    }
                }
            }
            spread(&on, &mut t);
            if wet {
                add_moments(&by_p, [&slopes[0].dp[rc], &slopes[1].dp[rc], &slopes[2].dp[rc]], &mut t);
                if c == 2 {
                    add_moments(&by_z, [&slopes[0].dz[r], &slopes[1].dz[r], &slopes[2].dz[r]], &mut t);
                }
            }
            to.scatter(&mut t, r, c, out);
        }
    }
}

/// For each pair of slots a number for each Gauss point.
type Moments = [[[f64; 3]; 4]; 4];

/// a_i b_j at each Gauss point.
#[inline(always)]
fn moments(stations: &[Station; 3], of: impl Fn(&Station) -> ([f64; 4], [f64; 4])) -> Moments {
    let mut out = [[[0.0; 3]; 4]; 4];
    for (g, station) in stations.iter().enumerate() {
        let (a, b) = of(station);
        for i in 0..4 {
            for j in 0..4 {
                out[i][j][g] = a[i] * b[j];
            }
        }
    }
    out
}

/// t_ij += Σ_g m_ijg x_g.
#[inline(always)]
fn add_moments(m: &Moments, x: [&Row; 3], t: &mut [[Row; 4]; 4]) {
    for l in 0..LANES {
        let (x0, x1, x2) = (x[0].0[l], x[1].0[l], x[2].0[l]);
        for i in 0..4 {
            for j in 0..4 {
                t[i][j].0[l] += m[i][j][0] * x0 + m[i][j][1] * x1 + m[i][j][2] * x2;
            }
        }
    }
}

/// From spans to slots.
#[inline(always)]
fn spread(on: &[[Row; SPANS]; SPANS], t: &mut [[Row; 4]; 4]) {
    // Slot 2 is slot 0 with the other sign.
    const OF: [(usize, f64); 4] = [(0, -1.0), (1, 1.0), (0, 1.0), (2, 1.0)];
    for (i, (k, x)) in OF.into_iter().enumerate() {
        for (j, (m, y)) in OF.into_iter().enumerate() {
            for l in 0..LANES {
                t[i][j].0[l] = x * y * on[k][m].0[l];
            }
        }
    }
}

/// Which elements lie side by side.
struct Place<'a> {
    first: usize,
    lanes: usize,
    length: &'a Row,
}

impl Place<'_> {
    /// Adds entry (r, c) of each pair of slots, given for unit length, to the matrix.
    #[inline(always)]
    fn scatter(&self, t: &mut [[Row; 4]; 4], r: usize, c: usize, m: &mut BlockTridiagonal) {
        for l in 0..LANES {
            let length = self.length.0[l];
            for i in 0..2 {
                for j in 0..2 {
                    t[2 * i + 1][2 * j].0[l] *= length;
                    t[2 * i][2 * j + 1].0[l] *= length;
                    t[2 * i + 1][2 * j + 1].0[l] *= length * length;
                }
            }
        }
        for l in 0..self.lanes {
            let e = self.first + l;
            for i in 0..2 {
                for j in 0..2 {
                    m.diagonal[e][3 * i + r][3 * j + c] += t[i][j].0[l];
                    m.upper[e][3 * i + r][3 * j + c] += t[i][j + 2].0[l];
                    m.lower[e + 1][3 * i + r][3 * j + c] += t[i + 2][j].0[l];
                    m.diagonal[e + 1][3 * i + r][3 * j + c] += t[i + 2][j + 2].0[l];
                }
            }
        }
    }
}

/// Lane `l` of what r_p depends on.
#[inline(always)]
fn spans(q: &[Rows3; 4], l: usize) -> [Vec3<f64>; SPANS] {
    [std::array::from_fn(|c| q[2][c].0[l] - q[0][c].0[l]), lane(&q[1], l), lane(&q[3], l)]
}

/// f Σ b_i x_i.
#[inline(always)]
fn along(b: &[f64; SPANS], x: &[Vec3<f64>; SPANS], f: f64) -> Vec3<f64> {
    std::array::from_fn(|c| f * (b[0] * x[0][c] + b[1] * x[1][c] + b[2] * x[2][c]))
}
