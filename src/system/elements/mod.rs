//! One pass over the elements, several side by side: internal forces, weight, inertia and, where an element is all under water, fluid forces;
//! with `TANGENT` also M, D and K.

mod batch;
mod tangent;
mod water;

use super::environment::Environment;
use super::matrices::Matrices;
use super::mixed::AxialUnknown;
use super::wetting::{Height, bounds};
use crate::cable::section::{Section, Strains};
use crate::cable::shape;
use crate::hydro::line::LineInWater;
use crate::integrator::Stage;
use crate::math::lanes::{Kernel, Vec3, lane, scale, set_lane, widest};
use crate::math::quadrature::GAUSS3;
use batch::{Batch, LANES, NodalSums, Row, Rows3, STILL, SectionSlopes, Slopes, Station, along, slots, spans};
pub use tangent::{Each, ElementTangents};
use water::immerse;

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
    /// wᵀ M a of the accelerations that were given, and the sum of its sizes element by element, W.
    pub inertial: [f64; 2],
}

impl Tally {
    /// Adds `power`, W, to wᵀ M a.
    pub fn accelerate(&mut self, power: f64) {
        self.inertial[0] += power;
        self.inertial[1] += power.abs();
    }
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
    /// The same side by side, with their inverses.
    rows: Vec<[Row; 2]>,
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

struct Pass<'a, const TANGENT: bool> {
    chain: &'a Chain,
    env: &'a Environment,
    u: &'a [f64],
    w: &'a [f64],
    a: Option<&'a [f64]>,
    axially: Axially<'a>,
    axial: &'a mut [Axial],
    forces: &'a mut [[f64; 12]],
    f: &'a mut [f64],
    matrices: &'a mut Matrices,
}

impl<const TANGENT: bool> Kernel for Pass<'_, TANGENT> {
    type Output = Tally;

    #[inline(always)]
    fn run(self) -> Tally {
        let Self { chain, env, u, w, a, axially, axial, forces, f, matrices } = self;
        let damped = chain.section.bending_damping > 0.0;
        match axially {
            Axially::Iterate { .. } if damped => {
                chain.pass_with::<TANGENT, ITERATE, true>(env, u, w, a, axially, axial, forces, f, matrices)
            }
            Axially::Iterate { .. } => chain.pass_with::<TANGENT, ITERATE, false>(env, u, w, a, axially, axial, forces, f, matrices),
            Axially::Stage(_) if damped => chain.pass_with::<TANGENT, STAGE, true>(env, u, w, a, axially, axial, forces, f, matrices),
            Axially::Stage(_) => chain.pass_with::<TANGENT, STAGE, false>(env, u, w, a, axially, axial, forces, f, matrices),
            _ => chain.pass_with::<TANGENT, LAW, true>(env, u, w, a, axially, axial, forces, f, matrices),
        }
    }
}

/// What becomes of the axial unknowns at (u, w).
#[derive(Clone, Copy)]
enum Ends<'a> {
    /// A stage that Newton's method has solved.
    Solved,
    /// A step, of the stages' increments weighted so.
    Weighted(&'a [f64]),
    /// A step that knew nothing of them.
    Unknown,
}

struct Settle<'a> {
    chain: &'a Chain,
    ends: Ends<'a>,
    u: &'a [f64],
    w: &'a [f64],
    axial: &'a mut [Axial],
}

impl Kernel for Settle<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { chain, ends, u, w, axial } = self;
        let section = chain.section;
        let (stations, count) = (GAUSS3.map(Station::new), chain.lengths.len());
        for (k, (axial, [length, inverse])) in axial.iter_mut().zip(&chain.rows).enumerate() {
            let (u, w) = (slots(u, k * LANES, count, length), slots(w, k * LANES, count, length));
            for (station, axial) in stations.iter().zip(axial) {
                if let Ends::Weighted(weights) = ends {
                    axial.enter(weights);
                }
                // A copy, and a row of its own, since only of these does the compiler know that nothing else changes them.
                let (known, mut now) = (*axial, Row::ZERO);
                let strains = |l: usize| {
                    let (p, vp) = (along(&station.b, &spans(&u, l), inverse.0[l]), along(&station.b, &spans(&w, l), inverse.0[l]));
                    Strains { p, pp: [0.0; 3], vp, vpp: [0.0; 3] }
                };
                match ends {
                    Ends::Solved => {
                        for l in 0..LANES {
                            now.0[l] = known.settled(l, &strains(l));
                        }
                    }
                    Ends::Weighted(_) => {
                        for l in 0..LANES {
                            let strains = strains(l);
                            now.0[l] = known.end(l, &section.tension(&strains), &strains);
                        }
                    }
                    Ends::Unknown => {
                        for l in 0..LANES {
                            now.0[l] = section.tension(&strains(l)).axial;
                        }
                    }
                }
                axial.now = now;
            }
        }
    }
}

/// The least and the greatest of the elements' mean axial forces.
struct Extremes<'a> {
    chain: &'a Chain,
    u: &'a [f64],
    w: &'a [f64],
}

impl Kernel for Extremes<'_> {
    type Output = (f64, f64);

    #[inline(always)]
    fn run(self) -> (f64, f64) {
        let Self { chain, u, w } = self;
        let section = chain.section;
        let (stations, count) = (GAUSS3.map(Station::new), chain.lengths.len());
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for (k, [length, inverse]) in chain.rows.iter().enumerate() {
            let (u, w) = (slots(u, k * LANES, count, length), slots(w, k * LANES, count, length));
            let mut mean = Row::ZERO;
            for Station { weight, b, d, .. } in &stations {
                for l in 0..LANES {
                    let (i, u, w) = (inverse.0[l], spans(&u, l), spans(&w, l));
                    let s = Strains { p: along(b, &u, i), pp: along(d, &u, i * i), vp: along(b, &w, i), vpp: [0.0; 3] };
                    mean.0[l] += weight * section.axial_force(&s);
                }
            }
            for n in &mean.0[..LANES.min(count - k * LANES)] {
                least = least.min(*n);
                most = most.max(*n);
            }
        }
        (least, most)
    }
}

impl Chain {
    /// The least and the greatest axial force, N: means over the elements, since pointwise values carry the cubic's own ripple.
    pub fn extremes(&self, u: &[f64], w: &[f64]) -> (f64, f64) {
        widest(Extremes { chain: self, u, w })
    }

    /// Of elements of these lengths (m), with mass per length (kg/m), section, and water where there is any.
    pub fn new(lengths: Vec<f64>, mass_per_length: f64, section: Section, water: Option<LineInWater>) -> Self {
        let rows = (0..lengths.len()).step_by(LANES).map(|first| {
            let (mut length, mut inverse) = (Row::ZERO, Row::ZERO);
            for l in 0..LANES {
                // Beyond the last element the last one again, whose results are left.
                length.0[l] = lengths[(first + l).min(lengths.len() - 1)];
                inverse.0[l] = 1.0 / length.0[l];
            }
            [length, inverse]
        });
        Self { rows: rows.collect(), lengths, mass_per_length, section, water }
    }

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

    /// Puts the elements that the water's surface crosses into `found`.
    pub fn crossed(&self, water: &LineInWater, env: &Environment, u: &[f64], found: &mut Vec<usize>) {
        found.clear();
        let z = env.base[2].0[0];
        let (full, dry) = (water.full() - z, water.dry() - z);
        for (e, l) in self.lengths.iter().enumerate() {
            let x = &u[6 * e..6 * e + 12];
            let (low, high) = bounds(x[2], x[5] * l, x[8], x[11] * l);
            if high > full && low < dry {
                found.push(e);
            }
        }
    }

    /// Overwrites `f` (what the elements do to the nodes, inertia included), where the forces are the law's also `forces` (12 per element: the same
    /// on its own slots), and, with `TANGENT`, the elements' share of M, D and K of F − M(u) a. `a`: acceleration relative to the first node; without it no inertia relative to the first node. `axially`:
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
        f: &mut [f64],
        matrices: &mut Matrices,
    ) -> Tally {
        widest(Pass::<TANGENT> { chain: self, env, u, w, a, axially, axial, forces, f, matrices })
    }

    /// Sums only of the law's forces: stages and iterates are many, and nobody asks for theirs.
    #[inline(always)]
    fn pass_with<const TANGENT: bool, const OF: u8, const BENDING_RATE: bool>(
        &self,
        env: &Environment,
        u: &[f64],
        w: &[f64],
        a: Option<&[f64]>,
        axially: Axially,
        axial: &mut [Axial],
        forces: &mut [[f64; 12]],
        f: &mut [f64],
        matrices: &mut Matrices,
    ) -> Tally {
        let mut tally = Tally::default();
        let stations = GAUSS3.map(Station::new);
        let mut none = [STILL; 3];
        let mut sums = NodalSums::default();
        if TANGENT {
            matrices.elements.begin(self);
        }
        for first in (0..self.lengths.len()).step_by(LANES) {
            let lanes = LANES.min(self.lengths.len() - first);
            let mut batch = self.gather_batch(env, first, u, w, a);
            let slopes = if TANGENT { matrices.elements.group(first / LANES, &batch) } else { &mut none };
            for ((station, slopes), axial) in stations.iter().zip(&mut *slopes).zip(&mut axial[first / LANES]) {
                self.resist::<TANGENT, OF, BENDING_RATE>(&mut batch, station, slopes, axially, axial);
            }
            let wet = batch.wet.0.iter().any(|x| *x > 0.0);
            if let Some(water) = &self.water
                && wet
            {
                for (station, slopes) in stations.iter().zip(slopes) {
                    match OF {
                        LAW => immerse::<TANGENT, true>(water, env, &mut batch, station, slopes),
                        _ => immerse::<TANGENT, false>(water, env, &mut batch, station, slopes),
                    }
                }
            }
            self.weigh::<OF>(env, &mut batch);
            if OF == LAW {
                for l in 0..lanes {
                    tally.elastic += batch.elastic.0[l];
                    tally.elastic_power += batch.power.0[l];
                    tally.turning += batch.turning.0[l];
                    tally.kinetic += batch.kinetic.0[l];
                    tally.accelerate(batch.inertial.0[l]);
                }
            }
            if OF == LAW {
                for l in 0..lanes {
                    let out = &mut forces[first + l];
                    for i in 0..4 {
                        out[3 * i..3 * i + 3].copy_from_slice(&lane(&batch.f[i], l));
                    }
                }
            }
            f[6 * first..6 * (first + lanes)].copy_from_slice(&sums.begun(&batch.f, lanes)[..6 * lanes]);
        }
        f[6 * self.lengths.len()..6 * self.lengths.len() + 6].copy_from_slice(&sums.last());
        f[6 * self.lengths.len() + 6..].fill(0.0);
        tally
    }

    /// The step that began with the last tangent ends at (u, w), of the stages' increments weighted so.
    pub fn accept(&self, u: &[f64], w: &[f64], weights: &[f64], axial: &mut [Axial]) {
        widest(Settle { chain: self, ends: Ends::Weighted(weights), u, w, axial });
    }

    /// A step that knew nothing of the axial unknowns ends at (u, w).
    pub fn adopt(&self, u: &[f64], w: &[f64], axial: &mut [Axial]) {
        widest(Settle { chain: self, ends: Ends::Unknown, u, w, axial });
    }

    /// Newton's method has ended at (u, w).
    pub fn settle(&self, u: &[f64], w: &[f64], axial: &mut [Axial]) {
        widest(Settle { chain: self, ends: Ends::Solved, u, w, axial });
    }

    /// The elements from `first` on.
    #[inline(always)]
    fn gather_batch(&self, env: &Environment, first: usize, u: &[f64], w: &[f64], a: Option<&[f64]>) -> Batch {
        let (count, [length, inverse]) = (self.lengths.len(), self.rows[first / LANES]);
        let u = slots(u, first, count, &length);
        let mut wet = Row::ZERO;
        if let Some(water) = &self.water {
            let (z, full) = (env.base[2].0[0], water.full());
            for l in 0..LANES {
                let (_, high) = bounds(u[0][2].0[l] + z, u[1][2].0[l], u[2][2].0[l] + z, u[3][2].0[l]);
                wet.0[l] = if high <= full { 1.0 } else { 0.0 };
            }
        }
        Batch {
            length,
            inverse,
            wet,
            u,
            w: slots(w, first, count, &length),
            a: match a {
                Some(a) => slots(a, first, count, &length),
                None => [[Row::ZERO; 3]; 4],
            },
            f: [[Row::ZERO; 3]; 4],
            elastic: Row::ZERO,
            power: Row::ZERO,
            kinetic: Row::ZERO,
            turning: Row::ZERO,
            inertial: Row::ZERO,
        }
    }

    /// Internal forces at a Gauss point.
    #[inline(always)]
    fn resist<const TANGENT: bool, const OF: u8, const BENDING_RATE: bool>(
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
        // Copies, since only of what is its own does the compiler know that nothing else changes it.
        let known = *axial;
        let (mut begun, mut next, mut own) = (known, Row::ZERO, SectionSlopes::NONE);
        for l in 0..LANES {
            let i = batch.inverse.0[l];
            let (u, w) = (spans(&batch.u, l), spans(&batch.w, l));
            let strains = Strains { p: along(&b, &u, i), pp: along(&d, &u, i * i), vp: along(&b, &w, i), vpp: along(&d, &w, i * i) };
            let mut r = section.resistance_carrying::<TANGENT, BENDING_RATE>(
                &strains,
                anew,
                if TANGENT { (1.0 - anew) * known.now.0[l] } else { 0.0 },
            );
            if TANGENT {
                begun.begin(l, &r, &strains, anew);
            }
            if OF == STAGE {
                (r.n, next.0[l]) = known.force(l, &r, &strains);
            } else if OF == ITERATE {
                (r.n, next.0[l]) = known.iterate(l, first, &r, &strains);
            }
            if OF == LAW {
                let wl = weight * batch.length.0[l];
                batch.elastic.0[l] += wl * r.energy;
                batch.power.0[l] += wl * r.power;
            }
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
                set_lane(&mut own.k_pp, l, flat(x, &r.k_pp));
                set_lane(&mut own.k_pq, l, flat(x * i, &r.k_pq));
                set_lane(&mut own.k_qp, l, flat(x * i, &r.k_qp));
                set_lane(&mut own.k_qq, l, flat(x * i * i, &r.k_qq));
                own.c_axial.0[l] = x * r.c_axial;
                set_lane(&mut own.g, l, r.g);
                own.c_bending.0[l] = x * r.c_bending;
                set_lane(&mut own.e2, l, r.e2);
                set_lane(&mut own.e1, l, scale(i, &r.e1));
            }
        }
        if TANGENT {
            slopes.section = own;
            *axial = begun;
        }
        if OF == STAGE {
            axial.remember(stage.index, next);
        } else if OF == ITERATE {
            axial.shift(next);
        }
    }

    /// Weight, the moving frame's and the element's own inertia; then forces on the slots of the true length.
    #[inline(always)]
    fn weigh<const OF: u8>(&self, env: &Environment, batch: &mut Batch) {
        let (total, mass) = (shape::integral(1.0), shape::mass(1.0));
        for c in 0..3 {
            let field = env.gravity[c] - env.base[c].0[2];
            for l in 0..LANES {
                let length = batch.length.0[l];
                let scale = length * self.mass_per_length;
                let (mut twice, mut inertial) = (0.0, 0.0);
                for i in 0..4 {
                    let m = &mass[i];
                    let product = |x: &[Rows3; 4]| m[0] * x[0][c].0[l] + m[1] * x[1][c].0[l] + m[2] * x[2][c].0[l] + m[3] * x[3][c].0[l];
                    let (v, inertia) = (batch.w[i][c].0[l], product(&batch.a));
                    if OF == LAW {
                        twice += product(&batch.w) * v;
                        inertial += inertia * v;
                    }
                    let f = batch.f[i][c].0[l] + scale * (total[i] * field - inertia);
                    batch.f[i][c].0[l] = if i % 2 == 1 { f * length } else { f };
                }
                if OF == LAW {
                    batch.kinetic.0[l] += 0.5 * scale * twice;
                    batch.inertial.0[l] += scale * inertial;
                }
            }
        }
    }
}
