//! The elements' share of M, D and K, kept as what it comes from: derivatives at the Gauss points. They are fewer numbers than the three
//! matrices, products with them cost no more than with matrices, and the sum M + g D + g² K is assembled only once.

use super::Chain;
use super::batch::{Batch, LANES, NodalSums, Row, Rows3, SPANS, STILL, Slopes, Station, slots, spans, value};
use crate::cable::shape;
use crate::linalg::BlockTridiagonal;
use crate::math::lanes::{Kernel, Vec3, dot, lane, widest};
use crate::math::quadrature::GAUSS3;

/// Factors of M, D and K, or vectors that they are multiplied with (each with a factor).
pub type Each<T> = [T; 3];

/// Derivatives of all elements.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ElementTangents {
    /// Number of elements.
    count: usize,
    groups: Vec<Group>,
    /// kg/m.
    mass_per_length: f64,
    /// c of the gradient-rate damping, N·s.
    gradient_damping: f64,
}

/// Elements side by side.
#[derive(Clone, Debug, PartialEq)]
struct Group {
    /// m.
    length: Row,
    inverse: Row,
    /// Whether any is all under water; otherwise what the fluid adds is not set.
    wet: bool,
    points: [Slopes; 3],
}

impl Group {
    const NONE: Self = Self { length: Row::ZERO, inverse: Row::ZERO, wet: false, points: [STILL; 3] };
}

impl ElementTangents {
    /// No elements, with room for so many.
    pub fn with_capacity(elements: usize) -> Self {
        Self { groups: Vec::with_capacity(elements.div_ceil(LANES)), ..Self::default() }
    }

    /// A new tangent begins.
    pub(super) fn begin(&mut self, chain: &Chain) {
        self.count = chain.lengths.len();
        self.groups.resize(self.count.div_ceil(LANES), Group::NONE);
        (self.mass_per_length, self.gradient_damping) = (chain.mass_per_length, chain.section.gradient_damping);
    }

    /// The Gauss points of a group, to be set.
    #[inline(always)]
    pub(super) fn group(&mut self, k: usize, batch: &Batch) -> &mut [Slopes; 3] {
        let group = &mut self.groups[k];
        (group.length, group.inverse) = (batch.length, batch.inverse);
        group.wet = batch.wet.0.iter().any(|x| *x > 0.0);
        &mut group.points
    }

    /// Overwrites `out` by the sum of M, D and K with these factors.
    pub fn sum(&self, factors: Each<f64>, out: &mut BlockTridiagonal) {
        widest(Sum { of: self, factors, out });
    }

    /// y += s_a M a + s_w D w + s_u K u.
    pub fn multiply_add(&self, x: Each<Option<(f64, &[f64])>>, y: &mut [f64]) {
        widest(Product { of: self, x, y });
    }
}

struct Sum<'a> {
    of: &'a ElementTangents,
    factors: Each<f64>,
    out: &'a mut BlockTridiagonal,
}

impl Kernel for Sum<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { of, factors, out } = self;
        let stations = GAUSS3.map(Station::new);
        let ends = of.count;
        // What no element sets, or adds to.
        out.clear_row(0);
        for i in ends..out.len() {
            out.clear_row(i);
        }
        let mut t = [[Row::ZERO; 12]; 12];
        for (k, group) in of.groups.iter().enumerate() {
            let damping = factors[1] * of.gradient_damping;
            for r in 0..3 {
                for c in 0..3 {
                    let mut entry = group.resistance(&stations, factors, if r == c { damping } else { 0.0 }, r, c);
                    if group.wet {
                        group.fluid(&stations, factors, r, c, &mut entry);
                    }
                    if r == c {
                        group.inertia(factors[0] * of.mass_per_length, &mut entry);
                    }
                    group.enter(&entry, r, c, &mut t);
                }
            }
            let first = k * LANES;
            for l in 0..LANES.min(of.count - first) {
                place(&t, l, first + l, out);
            }
        }
    }
}

/// One entry of the 3×3 blocks of all pairs of slots, of elements of unit length.
type Entry = [[Row; 4]; 4];

impl Group {
    /// From the resistance of the section; `direct`: damping of the slope's rate, N·s.
    #[inline(always)]
    fn resistance(&self, stations: &[Station; 3], factors: Each<f64>, direct: f64, r: usize, c: usize) -> Entry {
        let [_, wd, wk] = factors;
        let rc = 3 * r + c;
        let mut on = [[Row::ZERO; SPANS]; SPANS];
        for (Slopes { section: at, .. }, Station { b, d, weight, .. }) in self.points.iter().zip(stations) {
            for l in 0..LANES {
                let axial = wd * at.c_axial.0[l] * at.g[r].0[l];
                let bending = wd * at.c_bending.0[l];
                let (e2, e1) = (bending * at.e2[r].0[l], bending * at.e1[r].0[l]);
                let pp = wk * at.k_pp[rc].0[l] + axial * at.g[c].0[l] + e2 * at.e2[c].0[l] + direct * weight * self.inverse.0[l];
                let pq = wk * at.k_pq[rc].0[l] + e2 * at.e1[c].0[l];
                let qp = wk * at.k_qp[rc].0[l] + e1 * at.e2[c].0[l];
                let qq = wk * at.k_qq[rc].0[l] + e1 * at.e1[c].0[l];
                for j in 0..SPANS {
                    let (n, m) = (pp * b[j] + pq * d[j], qp * b[j] + qq * d[j]);
                    for i in 0..SPANS {
                        on[i][j].0[l] += b[i] * n + d[i] * m;
                    }
                }
            }
        }
        // From spans to slots: slot 2 is slot 0 with the other sign.
        const OF: [(usize, f64); 4] = [(0, -1.0), (1, 1.0), (0, 1.0), (2, 1.0)];
        let mut out = [[Row::ZERO; 4]; 4];
        for (i, (k, x)) in OF.into_iter().enumerate() {
            for (j, (m, y)) in OF.into_iter().enumerate() {
                for l in 0..LANES {
                    out[i][j].0[l] = x * y * on[k][m].0[l];
                }
            }
        }
        out
    }

    /// Adds what the fluid does.
    #[inline(always)]
    fn fluid(&self, stations: &[Station; 3], factors: Each<f64>, r: usize, c: usize, out: &mut Entry) {
        let [wm, wd, wk] = factors;
        let rc = 3 * r + c;
        let by_height = if c == 2 { wk } else { 0.0 };
        let mut t = *out;
        for (at, Station { s, b, .. }) in self.points.iter().zip(stations) {
            let by_slope = [-b[0], b[1], b[0], b[2]];
            for l in 0..LANES {
                let here = wm * at.mass[rc].0[l] - wd * at.dv[rc].0[l] - by_height * at.dz[r].0[l];
                let turned = -(wk * at.dp[rc].0[l]);
                for j in 0..4 {
                    let f = s[j] * here + by_slope[j] * turned;
                    for i in 0..4 {
                        t[i][j].0[l] += s[i] * f;
                    }
                }
            }
        }
        *out = t;
    }

    /// Adds the element's own mass per length.
    #[inline(always)]
    fn inertia(&self, mass_per_length: f64, out: &mut Entry) {
        let mass = shape::mass(1.0);
        for l in 0..LANES {
            let scale = self.length.0[l] * mass_per_length;
            for i in 0..4 {
                for j in 0..4 {
                    out[i][j].0[l] += scale * mass[i][j];
                }
            }
        }
    }

    /// Puts an entry where it belongs, for slots of the true length.
    #[inline(always)]
    fn enter(&self, entry: &Entry, r: usize, c: usize, t: &mut [[Row; 12]; 12]) {
        for l in 0..LANES {
            let length = self.length.0[l];
            let square = length * length;
            for i in 0..4 {
                for j in 0..4 {
                    let x = entry[i][j].0[l];
                    t[3 * i + r][3 * j + c].0[l] = match i % 2 + j % 2 {
                        0 => x,
                        1 => x * length,
                        _ => x * square,
                    };
                }
            }
        }
    }
}

/// Lane `l` into the blocks of element `e`, whose first diagonal block the element before it has begun.
#[inline(always)]
fn place(t: &[[Row; 12]; 12], l: usize, e: usize, out: &mut BlockTridiagonal) {
    let (here, next) = out.diagonal[e..e + 2].split_at_mut(1);
    let (here, next, upper, lower) = (&mut here[0], &mut next[0], &mut out.upper[e], &mut out.lower[e + 1]);
    for r in 0..6 {
        for c in 0..6 {
            here[r][c] += t[r][c].0[l];
            upper[r][c] = t[r][6 + c].0[l];
            lower[r][c] = t[6 + r][c].0[l];
            next[r][c] = t[6 + r][6 + c].0[l];
        }
    }
}

struct Product<'a> {
    of: &'a ElementTangents,
    x: Each<Option<(f64, &'a [f64])>>,
    y: &'a mut [f64],
}

impl Kernel for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { of, x: [a, w, u], y } = self;
        let stations = GAUSS3.map(Station::new);
        let mut sums = NodalSums::default();
        for (k, group) in of.groups.iter().enumerate() {
            let first = k * LANES;
            let mut f = [[Row::ZERO; 3]; 4];
            if let Some(a) = a {
                group.accelerate(&stations, of.mass_per_length, &of.slots(k, a), &mut f);
            }
            if let Some(w) = w {
                group.damp(&stations, of.gradient_damping, &of.slots(k, w), &mut f);
            }
            if let Some(u) = u {
                group.stretch(&stations, &of.slots(k, u), &mut f);
            }
            for l in 0..LANES {
                for c in 0..3 {
                    f[1][c].0[l] *= group.length.0[l];
                    f[3][c].0[l] *= group.length.0[l];
                }
            }
            let lanes = LANES.min(of.count - first);
            for (y, f) in y[6 * first..6 * (first + lanes)].iter_mut().zip(sums.begun(&f, lanes)) {
                *y += f;
            }
        }
        for (y, f) in y[6 * of.count..].iter_mut().zip(sums.last()) {
            *y += f;
        }
    }
}

impl ElementTangents {
    /// The slots of a group, as elements of unit length, times a factor.
    #[inline(always)]
    fn slots(&self, k: usize, (s, x): (f64, &[f64])) -> [Rows3; 4] {
        let mut q = slots(x, k * LANES, self.count, &self.groups[k].length);
        for i in 0..4 {
            for c in 0..3 {
                for l in 0..LANES {
                    q[i][c].0[l] *= s;
                }
            }
        }
        q
    }
}

/// Adds lane `l` of forces: `h` on the place, `n` and `m` conjugate to the first and second derivatives by ξ.
#[inline(always)]
fn push(station: &Station, h: &Vec3<f64>, n: &Vec3<f64>, m: &Vec3<f64>, l: usize, f: &mut [Rows3; 4]) {
    let Station { s, b, d, .. } = station;
    for c in 0..3 {
        let on: [f64; SPANS] = std::array::from_fn(|i| b[i] * n[c] + d[i] * m[c]);
        f[0][c].0[l] += s[0] * h[c] - on[0];
        f[1][c].0[l] += s[1] * h[c] + on[1];
        f[2][c].0[l] += s[2] * h[c] + on[0];
        f[3][c].0[l] += s[3] * h[c] + on[2];
    }
}

/// Lane `l` of Σ b_i x_i.
#[inline(always)]
fn derivative(b: &[f64; SPANS], q: &[Rows3; 4], l: usize) -> Vec3<f64> {
    super::batch::along(b, &spans(q, l), 1.0)
}

/// Lane `l` of a matrix times a vector.
#[inline(always)]
fn times(m: &[Row; 9], x: &Vec3<f64>, l: usize) -> Vec3<f64> {
    std::array::from_fn(|r| m[3 * r].0[l] * x[0] + m[3 * r + 1].0[l] * x[1] + m[3 * r + 2].0[l] * x[2])
}

const NONE: Vec3<f64> = [0.0; 3];

impl Group {
    /// f += M a.
    #[inline(always)]
    fn accelerate(&self, stations: &[Station; 3], mass_per_length: f64, a: &[Rows3; 4], f: &mut [Rows3; 4]) {
        let (mut sum, mass) = (*f, shape::mass(1.0));
        for l in 0..LANES {
            let scale = self.length.0[l] * mass_per_length;
            for c in 0..3 {
                for i in 0..4 {
                    sum[i][c].0[l] += scale * (0..4).map(|j| mass[i][j] * a[j][c].0[l]).sum::<f64>();
                }
            }
        }
        if self.wet {
            for (at, station) in self.points.iter().zip(stations) {
                for l in 0..LANES {
                    push(station, &times(&at.mass, &value(&station.s, a, l), l), &NONE, &NONE, l, &mut sum);
                }
            }
        }
        *f = sum;
    }

    /// f += D w.
    #[inline(always)]
    fn damp(&self, stations: &[Station; 3], gradient_damping: f64, w: &[Rows3; 4], f: &mut [Rows3; 4]) {
        let mut sum = *f;
        for (Slopes { section: at, .. }, station) in self.points.iter().zip(stations) {
            for l in 0..LANES {
                let (vp, vpp) = (derivative(&station.b, w, l), derivative(&station.d, w, l));
                let (g, e2, e1) = (lane(&at.g, l), lane(&at.e2, l), lane(&at.e1, l));
                let axial = at.c_axial.0[l] * dot(&g, &vp);
                let bending = at.c_bending.0[l] * (dot(&e2, &vp) + dot(&e1, &vpp));
                let direct = gradient_damping * station.weight * self.inverse.0[l];
                let n = std::array::from_fn(|c| axial * g[c] + bending * e2[c] + direct * vp[c]);
                let m = std::array::from_fn(|c| bending * e1[c]);
                push(station, &NONE, &n, &m, l, &mut sum);
            }
        }
        if self.wet {
            for (at, station) in self.points.iter().zip(stations) {
                for l in 0..LANES {
                    let h = times(&at.dv, &value(&station.s, w, l), l).map(|x| -x);
                    push(station, &h, &NONE, &NONE, l, &mut sum);
                }
            }
        }
        *f = sum;
    }

    /// f += K u.
    #[inline(always)]
    fn stretch(&self, stations: &[Station; 3], u: &[Rows3; 4], f: &mut [Rows3; 4]) {
        let mut sum = *f;
        for (Slopes { section: at, .. }, station) in self.points.iter().zip(stations) {
            for l in 0..LANES {
                let (p, pp) = (derivative(&station.b, u, l), derivative(&station.d, u, l));
                let (np, nq) = (times(&at.k_pp, &p, l), times(&at.k_pq, &pp, l));
                let (mp, mq) = (times(&at.k_qp, &p, l), times(&at.k_qq, &pp, l));
                let (n, m) = (std::array::from_fn(|c| np[c] + nq[c]), std::array::from_fn(|c| mp[c] + mq[c]));
                push(station, &NONE, &n, &m, l, &mut sum);
            }
        }
        if self.wet {
            for (at, station) in self.points.iter().zip(stations) {
                for l in 0..LANES {
                    let turned = times(&at.dp, &derivative(&station.b, u, l), l);
                    let z = value(&station.s, u, l)[2];
                    let h = std::array::from_fn(|c| -(turned[c] + at.dz[c].0[l] * z));
                    push(station, &h, &NONE, &NONE, l, &mut sum);
                }
            }
        }
        *f = sum;
    }
}
