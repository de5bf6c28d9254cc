//! Elements side by side, as elements of unit length, and their Gauss points.

use crate::cable::shape;
use crate::math::lanes::{Lanes, Vec3, lane};
use crate::math::transpose::{BLOCK, from_rows, previous, some_to_rows, to_rows};

/// Elements side by side.
pub const LANES: usize = 8;
/// A number of each.
pub type Row = Lanes<LANES>;
/// A vector of each.
pub type Rows3 = [Row; 3];
/// A 3×3 matrix of each, row major.
pub type Rows33 = [Row; 9];

/// Slots of the elements from `first` on, of `count` in all, as elements of unit length. In lanes beyond the last element there is the last again.
#[inline(always)]
pub fn slots(x: &[f64], first: usize, count: usize, length: &Row) -> [Rows3; 4] {
    let (here, beyond) = (&x[6 * first..], &x[6 * first + 6..]);
    let (begin, end) = match (here.first_chunk(), beyond.first_chunk()) {
        (Some(here), Some(beyond)) if first + LANES <= count => (to_rows(here), to_rows(beyond)),
        _ => (some_to_rows(here, count - first), some_to_rows(beyond, count - first)),
    };
    let mut q = [[begin[0], begin[1], begin[2]], [begin[3], begin[4], begin[5]], [end[0], end[1], end[2]], [end[3], end[4], end[5]]];
    for i in [1, 3] {
        for c in 0..3 {
            for l in 0..LANES {
                q[i][c].0[l] *= length.0[l];
            }
        }
    }
    q
}

/// Sums of forces on slots at the nodes, group of elements by group.
#[derive(Default)]
pub struct NodalSums {
    /// What the elements so far do to the node where the next begins.
    carried: [f64; 6],
}

impl NodalSums {
    /// The nodes where `lanes` elements begin, six numbers each.
    #[inline(always)]
    pub fn begun(&mut self, f: &[Rows3; 4], lanes: usize) -> [f64; BLOCK] {
        let mut rows = [f[0][0], f[0][1], f[0][2], f[1][0], f[1][1], f[1][2]];
        for k in 0..6 {
            let ended = &f[2 + k / 3][k % 3];
            let before = previous(ended, self.carried[k]);
            self.carried[k] = ended.0[lanes - 1];
            for l in 0..LANES {
                rows[k].0[l] += before.0[l];
            }
        }
        from_rows(&rows)
    }

    /// The last node.
    #[inline(always)]
    pub fn last(&self) -> [f64; 6] {
        self.carried
    }
}

/// Slots and differences of slots that r_p depends on: r(L) − r(0), L r_p(0), L r_p(L).
pub const SPANS: usize = 3;

/// A Gauss point of the element of unit length, on whose slots (r(0), L r_p(0), r(L), L r_p(L)) the shape functions are pure numbers.
#[derive(Clone, Copy)]
pub struct Station {
    /// Of the quadrature on [0, 1].
    pub weight: f64,
    /// s.
    pub s: [f64; 4],
    /// ds/dξ by span.
    pub b: [f64; SPANS],
    /// d²s/dξ² by span.
    pub d: [f64; SPANS],
}

impl Station {
    #[inline(always)]
    pub fn new((x, weight): (f64, f64)) -> Self {
        let ([_, b1, ba, b3], [_, d1, da, d3]) = (shape::slope(x, 1.0), shape::second(x, 1.0));
        Self { weight, s: shape::value(x, 1.0), b: [ba, b1, b3], d: [da, d1, d3] }
    }
}

/// Elements side by side as elements of unit length.
pub struct Batch {
    /// True length, m, and its inverse.
    pub length: Row,
    pub inverse: Row,
    /// 1 where all under water.
    pub wet: Row,
    /// Slots of u, w, a.
    pub u: [Rows3; 4],
    pub w: [Rows3; 4],
    pub a: [Rows3; 4],
    /// Forces on the slots.
    pub f: [Rows3; 4],
    /// See `Tally`.
    pub elastic: Row,
    pub power: Row,
    pub kinetic: Row,
    pub turning: Row,
    pub inertial: Row,
}

/// What the tangent needs of a Gauss point, of elements side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slopes {
    /// Of the section.
    pub section: SectionSlopes,
    /// Weighted derivatives of the fluid force.
    pub dz: Rows3,
    pub dv: Rows33,
    pub dp: Rows33,
    pub mass: Rows33,
}

/// Derivatives of the section's forces by ξ-derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionSlopes {
    /// Weighted derivatives of the resistance.
    pub k_pp: Rows33,
    pub k_pq: Rows33,
    pub k_qp: Rows33,
    pub k_qq: Rows33,
    /// Weighted dampings and their dyads' vectors, see `Resistance`.
    pub c_axial: Row,
    pub g: Rows3,
    pub c_bending: Row,
    pub e2: Rows3,
    pub e1: Rows3,
}

pub const NONE: Rows33 = [Row::ZERO; 9];
pub const STILL: Slopes = Slopes { section: SectionSlopes::NONE, dz: [Row::ZERO; 3], dv: NONE, dp: NONE, mass: NONE };

impl SectionSlopes {
    pub const NONE: Self = Self {
        k_pp: NONE,
        k_pq: NONE,
        k_qp: NONE,
        k_qq: NONE,
        c_axial: Row::ZERO,
        g: [Row::ZERO; 3],
        c_bending: Row::ZERO,
        e2: [Row::ZERO; 3],
        e1: [Row::ZERO; 3],
    };
}

/// Lane `l` of Σ s_i q_i.
#[inline(always)]
pub fn value(s: &[f64; 4], q: &[Rows3; 4], l: usize) -> Vec3<f64> {
    std::array::from_fn(|c| s[0] * q[0][c].0[l] + s[1] * q[1][c].0[l] + s[2] * q[2][c].0[l] + s[3] * q[3][c].0[l])
}

/// Lane `l` of what r_p depends on.
#[inline(always)]
pub fn spans(q: &[Rows3; 4], l: usize) -> [Vec3<f64>; SPANS] {
    [std::array::from_fn(|c| q[2][c].0[l] - q[0][c].0[l]), lane(&q[1], l), lane(&q[3], l)]
}

/// f Σ b_i x_i.
#[inline(always)]
pub fn along(b: &[f64; SPANS], x: &[Vec3<f64>; SPANS], f: f64) -> Vec3<f64> {
    std::array::from_fn(|c| f * (b[0] * x[0][c] + b[1] * x[1][c] + b[2] * x[2][c]))
}
