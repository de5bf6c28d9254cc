//! Arcs in contact with a face, side by side: their forces, and with `TANGENT` their stiffness and damping, in world axes.
//!
//! An arc's forces are Q_i = ∫ s_i f dp over [from, to] by Gauss's rule, whose points move with the ends where these are roots of the gap:
//!
//! ```text
//! ∂Q/∂u = Σ w ∂(s f)/∂u + Σ_ends ∂Q/∂(end) ∂(end)/∂u,   ∂(end)/∂u_i = −s_i n / gap′
//! ```

use super::SurfaceLoad;
use super::group::{Cubics, Group, LANES, Row, cubic, set_cubic};
use crate::cable::shape;
use crate::contact::arcs::Arc;
use crate::contact::surface::{Face, Surface};
use crate::linalg::Patches;
use crate::math::lanes::{Mat3, Vec3, dot, lane, mat_vec, set_lane};
use crate::math::quadrature::GAUSS5;

/// Pairs of slots (i, j), i ≤ j, and for each pair its place among them.
const PAIRS: [(usize, usize); 10] = [(0, 0), (0, 1), (0, 2), (0, 3), (1, 1), (1, 2), (1, 3), (2, 2), (2, 3), (3, 3)];
const PAIR: [[usize; 4]; 4] = [[0, 1, 2, 3], [1, 4, 5, 6], [2, 5, 7, 8], [3, 6, 8, 9]];

/// Arcs of elements against one face of a surface.
pub struct Arcs {
    pub count: usize,
    /// Their elements.
    pub element: [usize; LANES],
    length: Row,
    from: Row,
    to: Row,
    /// 1 where an end moves with the shape.
    moving: [Row; 2],
    shape: Cubics,
    velocity: Cubics,
}

impl Arcs {
    pub const NONE: Self = Self {
        count: 0,
        element: [0; LANES],
        length: Row::ZERO,
        from: Row::ZERO,
        to: Row::ZERO,
        moving: [Row::ZERO; 2],
        shape: [[Row::ZERO; 3]; 4],
        velocity: [[Row::ZERO; 3]; 4],
    };

    /// Adds an arc of the group's element `l`, which is element `e` of the cable.
    #[inline(always)]
    pub fn push(&mut self, group: &Group, l: usize, e: usize, arc: Arc) {
        let k = self.count;
        self.element[k] = e;
        self.length.0[k] = group.length.0[l];
        (self.from.0[k], self.to.0[k]) = (arc.from, arc.to);
        set_lane(&mut self.moving, k, arc.moving.map(f64::from));
        set_cubic(&mut self.shape, k, &cubic(&group.shape, l));
        set_cubic(&mut self.velocity, k, &cubic(&group.velocity, l));
        self.count += 1;
    }

    /// Fills the spare lanes with arcs of no length.
    #[inline(always)]
    fn pad(&mut self) {
        for k in self.count..LANES {
            self.length.0[k] = self.length.0[0];
            (self.from.0[k], self.to.0[k]) = (self.from.0[0], self.from.0[0]);
            set_lane(&mut self.moving, k, [0.0; 2]);
            let (shape, velocity) = (cubic(&self.shape, 0), cubic(&self.velocity, 0));
            set_cubic(&mut self.shape, k, &shape);
            set_cubic(&mut self.velocity, k, &velocity);
        }
    }
}

impl Arcs {
    /// Adds blocks of the slots to the elements' matrices.
    #[inline(always)]
    fn scatter(&self, all: &Blocks, to: &mut Patches) {
        for l in 0..self.count {
            for c in 0..12 {
                let column = std::array::from_fn(|r| all[r / 3][c / 3][3 * (r % 3) + c % 3].0[l]);
                to.add_pair_column(self.element[l], c, 1.0, &column);
            }
        }
    }
}

/// A surface and how it moves.
#[derive(Clone, Copy)]
pub struct Pressed<'a> {
    pub surface: &'a Surface,
    /// World components into the surface's axes.
    pub rotation: Mat3<f64>,
    /// ∂(relative velocity)/∂(position) at fixed world velocity.
    pub turn: Mat3<f64>,
    /// rad/s relative to the ship.
    pub spin: f64,
}

/// A vector on each slot of each arc's element.
pub type Slots = [[Row; 3]; 4];
const NOTHING: Slots = [[Row::ZERO; 3]; 4];

/// Derivatives of the forces of arcs side by side.
#[derive(Clone, Copy)]
pub struct Slopes {
    /// K and D by pair of slots, entry (r, c) at 3 r + c; K without the part of moving ends.
    stiffness: [[Row; 9]; 10],
    damping: [[Row; 9]; 10],
    /// ∂Q/∂(end) and −∂(end)/∂u of both ends.
    by_end: [Slots; 2],
    end_rate: [Slots; 2],
}

impl Slopes {
    const ZERO: Self =
        Self { stiffness: [[Row::ZERO; 9]; 10], damping: [[Row::ZERO; 9]; 10], by_end: [NOTHING; 2], end_rate: [NOTHING; 2] };

    /// Adds K of the arcs to a matrix.
    #[inline(always)]
    pub fn add_stiffness(&self, arcs: &Arcs, to: &mut Patches) {
        let mut all = spread(&self.stiffness);
        for end in 0..2 {
            let (q, x) = (self.by_end[end], self.end_rate[end]);
            for i in 0..4 {
                for j in 0..4 {
                    for l in 0..LANES {
                        for k in 0..9 {
                            all[i][j][k].0[l] += q[i][k / 3].0[l] * x[j][k % 3].0[l];
                        }
                    }
                }
            }
        }
        arcs.scatter(&all, to);
    }

    /// Adds D of the arcs to a matrix.
    #[inline(always)]
    pub fn add_damping(&self, arcs: &Arcs, to: &mut Patches) {
        arcs.scatter(&spread(&self.damping), to);
    }
}

/// 3×3 blocks of every two slots, entry (r, c) at 3 r + c.
type Blocks = [[[Row; 9]; 4]; 4];

/// From pairs to every two slots.
#[inline(always)]
fn spread(pairs: &[[Row; 9]; 10]) -> Blocks {
    std::array::from_fn(|i| std::array::from_fn(|j| pairs[PAIR[i][j]]))
}

/// Derivatives of the moment T that turns the surface, and of the forces by its spin.
#[derive(Clone, Copy)]
pub struct Twist {
    /// Rows of K and D.
    pub stiffness: Slots,
    pub damping: Slots,
    /// Column and corner of D.
    pub spin_column: Slots,
    pub spin_corner: Row,
    by_end: [Row; 2],
}

impl Twist {
    const ZERO: Self = Self { stiffness: NOTHING, damping: NOTHING, spin_column: NOTHING, spin_corner: Row::ZERO, by_end: [Row::ZERO; 2] };
}

/// What arcs do to their elements.
pub struct Sums {
    pub forces: Slots,
    /// With `TANGENT` only.
    pub slopes: Option<(Slopes, Twist)>,
}

/// Row `l` by slot and component.
pub fn flat(of: &Slots, l: usize) -> [f64; 12] {
    std::array::from_fn(|k| of[k / 3][k % 3].0[l])
}

/// Matrix `l` of those side by side.
#[inline(always)]
fn matrix(of: &[Row; 9], l: usize) -> Mat3<f64> {
    std::array::from_fn(|r| std::array::from_fn(|c| of[3 * r + c].0[l]))
}

/// A matrix row by row.
#[inline(always)]
fn rows(m: &Mat3<f64>) -> [f64; 9] {
    std::array::from_fn(|k| m[k / 3][k % 3])
}

/// to_i += f w sᵢ x.
#[inline(always)]
fn add_to_slots(to: &mut Slots, f: f64, w: &Row, s: &[Row; 4], x: &[Row; 3]) {
    for l in 0..LANES {
        for i in 0..4 {
            let by = f * w.0[l] * s[i].0[l];
            for c in 0..3 {
                to[i][c].0[l] += by * x[c].0[l];
            }
        }
    }
}

/// to_ij −= w sᵢ sⱼ m.
#[inline(always)]
fn add_to_pairs(to: &mut [[Row; 9]; 10], w: &Row, s: &[Row; 4], m: &[Row; 9]) {
    for (to, (i, j)) in to.iter_mut().zip(PAIRS) {
        let mut by = Row::ZERO;
        for l in 0..LANES {
            by.0[l] = w.0[l] * s[i].0[l] * s[j].0[l];
        }
        for l in 0..LANES {
            for k in 0..9 {
                to[k].0[l] -= by.0[l] * m[k].0[l];
            }
        }
    }
}

/// rᵀ v.
#[inline(always)]
fn back(r: &Mat3<f64>, v: &Vec3<f64>) -> Vec3<f64> {
    std::array::from_fn(|c| r[0][c] * v[0] + r[1][c] * v[1] + r[2][c] * v[2])
}

/// rᵀ m r.
#[inline(always)]
fn turned(r: &Mat3<f64>, m: &Mat3<f64>) -> Mat3<f64> {
    let left: Mat3<f64> = std::array::from_fn(|a| std::array::from_fn(|c| m[a][0] * r[0][c] + m[a][1] * r[1][c] + m[a][2] * r[2][c]));
    std::array::from_fn(|a| std::array::from_fn(|c| r[0][a] * left[0][c] + r[1][a] * left[1][c] + r[2][a] * left[2][c]))
}

/// a b.
#[inline(always)]
fn product(a: &Mat3<f64>, b: &Mat3<f64>) -> Mat3<f64> {
    std::array::from_fn(|r| std::array::from_fn(|c| a[r][0] * b[0][c] + a[r][1] * b[1][c] + a[r][2] * b[2][c]))
}

/// What the arcs against face `side` do; what the surface feels is added to `total`. `TURNS`: the surface's rotation is an unknown, with
/// derivatives of its own.
#[inline(always)]
pub fn press<const TANGENT: bool, const TURNS: bool>(
    on: &Pressed,
    side: usize,
    face: Face,
    arcs: &mut Arcs,
    total: &mut SurfaceLoad,
) -> Sums {
    arcs.pad();
    let Pressed { surface, rotation, turn, spin } = *on;
    let moves = surface.is_damped();
    // Copies, since only of what is its own does the compiler know that nothing else changes it.
    let (length, from, to, moving) = (arcs.length, arcs.from, arcs.to, arcs.moving);
    let (curves, velocity) = (arcs.shape, arcs.velocity);
    let (mut force, mut moment, mut pressure) = ([Row::ZERO; 3], [Row::ZERO; 3], Row::ZERO);
    let (mut forces, mut slopes, mut twist) = (NOTHING, Slopes::ZERO, Twist::ZERO);
    for (position, weight) in GAUSS5 {
        let (mut x, mut s, mut v) = (Row::ZERO, [Row::ZERO; 3], [Row::ZERO; 3]);
        for l in 0..LANES {
            x.0[l] = from.0[l] + (to.0[l] - from.0[l]) * position;
            set_lane(&mut s, l, cubic(&curves, l).at(x.0[l]));
        }
        if moves {
            for l in 0..LANES {
                set_lane(&mut v, l, cubic(&velocity, l).at(x.0[l]));
            }
        }
        let loads = surface.loads::<TANGENT, LANES>(face, &s, &v, spin);
        let (mut wl, mut shapes, mut fw) = (Row::ZERO, [Row::ZERO; 4], [Row::ZERO; 3]);
        for l in 0..LANES {
            let (f, s) = (lane(&loads.f, l), lane(&s, l));
            let by = weight * (to.0[l] - from.0[l]) * length.0[l];
            wl.0[l] = by;
            set_lane(&mut shapes, l, shape::value(x.0[l], length.0[l]));
            set_lane(&mut fw, l, back(&rotation, &f));
            pressure.0[l] += by * loads.normal.0[l];
            for c in 0..3 {
                let (a, b) = ((c + 1) % 3, (c + 2) % 3);
                force[c].0[l] += by * f[c];
                moment[c].0[l] += by * (s[a] * f[b] - s[b] * f[a]);
            }
        }
        add_to_slots(&mut forces, 1.0, &wl, &shapes, &fw);
        if !TANGENT {
            continue;
        }
        // Derivatives along the arc, and by place at fixed absolute velocity.
        let (mut fx, mut fxw, mut along, mut steep) = ([Row::ZERO; 3], [Row::ZERO; 3], [Row::ZERO; 3], [Row::ZERO; 4]);
        let mut ds = loads.ds;
        for l in 0..LANES {
            let load = loads.at(l);
            let slope = cubic(&curves, l).slope(x.0[l]);
            set_lane(&mut along, l, slope);
            set_lane(&mut fx, l, mat_vec(&load.ds, &slope));
            set_lane(&mut steep, l, shape::slope(x.0[l], 1.0 / length.0[l]));
        }
        if moves {
            let mut by_v = [Row::ZERO; 9];
            for l in 0..LANES {
                let load = loads.at(l);
                let more = mat_vec(&load.dv, &cubic(&velocity, l).slope(x.0[l]));
                for c in 0..3 {
                    fx[c].0[l] += more[c];
                }
                set_lane(&mut by_v, l, rows(&turned(&rotation, &load.dv)));
                let more = rows(&product(&load.dv, &turn));
                for k in 0..9 {
                    ds[k].0[l] += more[k];
                }
            }
            add_to_pairs(&mut slopes.damping, &wl, &shapes, &by_v);
        }
        let mut by_s = [Row::ZERO; 9];
        for l in 0..LANES {
            set_lane(&mut by_s, l, rows(&turned(&rotation, &matrix(&ds, l))));
            set_lane(&mut fxw, l, back(&rotation, &lane(&fx, l)));
        }
        add_to_pairs(&mut slopes.stiffness, &wl, &shapes, &by_s);
        // d/dξ of sᵢ f; the ends carry the points along.
        for l in 0..LANES {
            let (len, wide) = (length.0[l], to.0[l] - from.0[l]);
            for i in 0..4 {
                for c in 0..3 {
                    let g = shapes[i].0[l] * fw[c].0[l];
                    let rate = len * steep[i].0[l] * fw[c].0[l] + shapes[i].0[l] * fxw[c].0[l];
                    slopes.by_end[0][i][c].0[l] += weight * len * (wide * rate * (1.0 - position) - g);
                    slopes.by_end[1][i][c].0[l] += weight * len * (wide * rate * position + g);
                }
            }
        }
        if !TURNS {
            continue;
        }
        // T = s₂ f₁ − s₁ f₂ per length, with its derivatives.
        let (mut by_place, mut by_rate, mut by_spin) = ([Row::ZERO; 3], [Row::ZERO; 3], [Row::ZERO; 3]);
        for l in 0..LANES {
            let (load, ds, s) = (loads.at(l), matrix(&ds, l), lane(&s, l));
            let (f, along, fx, dspin) = (load.f, lane(&along, l), lane(&fx, l), load.dspin);
            let mut place: Vec3<f64> = std::array::from_fn(|c| s[2] * ds[1][c] - s[1] * ds[2][c]);
            place[2] += f[1];
            place[1] -= f[2];
            let rate: Vec3<f64> = std::array::from_fn(|c| s[2] * load.dv[1][c] - s[1] * load.dv[2][c]);
            set_lane(&mut by_place, l, back(&rotation, &place));
            set_lane(&mut by_rate, l, back(&rotation, &rate));
            set_lane(&mut by_spin, l, back(&rotation, &dspin));
            twist.spin_corner.0[l] -= wl.0[l] * (s[2] * dspin[1] - s[1] * dspin[2]);
            let t = s[2] * f[1] - s[1] * f[2];
            let tx = (to.0[l] - from.0[l]) * (along[2] * f[1] + s[2] * fx[1] - along[1] * f[2] - s[1] * fx[2]);
            twist.by_end[0].0[l] += weight * length.0[l] * (tx * (1.0 - position) - t);
            twist.by_end[1].0[l] += weight * length.0[l] * (tx * position + t);
        }
        add_to_slots(&mut twist.stiffness, -1.0, &wl, &shapes, &by_place);
        add_to_slots(&mut twist.damping, -1.0, &wl, &shapes, &by_rate);
        add_to_slots(&mut twist.spin_column, -1.0, &wl, &shapes, &by_spin);
    }
    for l in 0..arcs.count {
        total.faces[side] += pressure.0[l];
        for c in 0..3 {
            total.force[c] += force[c].0[l];
            total.moment[c] += moment[c].0[l];
        }
    }
    if !TANGENT {
        return Sums { forces, slopes: None };
    }
    for (end, x) in [from, to].into_iter().enumerate() {
        let (mut rate, mut shapes, mut normal) = (Row::ZERO, [Row::ZERO; 4], [Row::ZERO; 3]);
        for l in 0..LANES {
            let (curve, len) = (cubic(&curves, l), length.0[l]);
            let (s, along) = (curve.at(x.0[l]), curve.slope(x.0[l]));
            let rho = (s[1] * s[1] + s[2] * s[2]).sqrt();
            let n = [face.axial, face.radial * s[1] / rho, face.radial * s[2] / rho];
            let slope = dot(&n, &along);
            // None where the cable only grazes the surface.
            rate.0[l] = if slope.abs() > 1e-9 * len { moving[end].0[l] / slope } else { 0.0 };
            set_lane(&mut shapes, l, shape::value(x.0[l], len));
            set_lane(&mut normal, l, back(&rotation, &n));
        }
        add_to_slots(&mut slopes.end_rate[end], 1.0, &rate, &shapes, &normal);
        if TURNS {
            for l in 0..LANES {
                rate.0[l] *= twist.by_end[end].0[l];
            }
            add_to_slots(&mut twist.stiffness, 1.0, &rate, &shapes, &normal);
        }
    }
    Sums { forces, slopes: Some((slopes, twist)) }
}
