//! Forces at single points of an element: where the water's surface crosses it, and in contact.

use super::elements::gather;
use super::matrices::{Matrices, subtract_outer};
use crate::cable::shape::{self, Shape};
use crate::math::lanes::{Mat3, Vec3};

/// A point of element `e` and its motion relative to the first node.
#[derive(Clone, Copy, Debug)]
pub struct ElementPoint {
    /// The element.
    pub e: usize,
    /// Shape functions and their slopes.
    pub s: Shape,
    /// ds/dp.
    pub sp: Shape,
    /// u.
    pub u: Vec3<f64>,
    /// w.
    pub w: Vec3<f64>,
    /// r_p.
    pub p: Vec3<f64>,
    /// ṙ_p.
    pub vp: Vec3<f64>,
}

impl ElementPoint {
    /// At ξ of element `e` of length `l`.
    #[inline]
    pub fn new(u: &[f64], w: &[f64], e: usize, l: f64, x: f64) -> Self {
        let (s, sp) = (shape::value(x, l), shape::slope(x, 1.0 / l));
        let (qu, qw) = (gather(u, e), gather(w, e));
        Self {
            e,
            s,
            sp,
            u: shape::interpolate(&s, &qu),
            w: shape::interpolate(&s, &qw),
            p: shape::interpolate(&sp, &qu),
            vp: shape::interpolate(&sp, &qw),
        }
    }

    /// Adds a force (per length times length) to the element's slots and to its nodes.
    #[inline]
    pub fn push(&self, force: &Vec3<f64>, forces: &mut [[f64; 12]], f: &mut [f64]) {
        let (slots, nodes) = (&mut forces[self.e], &mut f[6 * self.e..6 * self.e + 12]);
        for i in 0..4 {
            for c in 0..3 {
                let share = self.s[i] * force[c];
                slots[3 * i + c] += share;
                nodes[3 * i + c] += share;
            }
        }
    }

    /// Adds the derivatives of such a force by position, r_p, velocity, and its mass, where there are any.
    #[inline]
    pub fn couple(
        &self,
        by_r: Option<&Mat3<f64>>,
        by_p: Option<&Mat3<f64>>,
        by_v: Option<&Mat3<f64>>,
        mass: Option<&Mat3<f64>>,
        m: &mut Matrices,
    ) {
        let (s, sp) = (&self.s, &self.sp);
        if let Some(b) = by_r {
            subtract_outer(&mut m.stiffness, self.e, s, s, b);
        }
        if let Some(b) = by_p {
            subtract_outer(&mut m.stiffness, self.e, s, sp, b);
        }
        if let Some(b) = by_v {
            subtract_outer(&mut m.damping, self.e, s, s, b);
        }
        if let Some(b) = mass {
            let minus = b.map(|row| row.map(|x| -x));
            subtract_outer(&mut m.mass, self.e, s, s, &minus);
        }
    }
}
