//! M, D and K of elements side by side, from the derivatives at their Gauss points.

use super::super::matrices::element_block;
use super::Chain;
use super::batch::{LANES, Row, SPANS, Slopes, Station};
use crate::cable::shape;
use crate::linalg::BlockTridiagonal;

impl Chain {
    /// D of elements side by side.
    #[inline(always)]
    pub(super) fn damping(
        &self,
        stations: &[Station; 3],
        slopes: &[Slopes; 3],
        wet: bool,
        inverse: &Row,
        to: &Place,
        out: &mut BlockTridiagonal,
    ) {
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
    pub(super) fn inertia(&self, stations: &[Station; 3], slopes: &[Slopes; 3], wet: bool, to: &Place, out: &mut BlockTridiagonal) {
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

/// K of elements side by side.
#[inline(always)]
pub fn stiffness(stations: &[Station; 3], slopes: &[Slopes; 3], wet: bool, to: &Place, out: &mut BlockTridiagonal) {
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
pub struct Place<'a> {
    /// The first, and how many.
    pub first: usize,
    pub lanes: usize,
    /// m.
    pub length: &'a Row,
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
