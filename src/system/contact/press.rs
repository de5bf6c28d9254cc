//! Forces of an arc in contact, its Gauss points side by side.

use super::{Forces, SurfaceLoad};
use crate::cable::shape;
use crate::contact::arcs::{Arc, Cubic};
use crate::contact::surface::{Face, Surface};
use crate::math::lanes::{Kernel, widest};
use crate::math::quadrature::GAUSS5;

/// Gauss points of an arc.
const POINTS: usize = GAUSS5.len();
/// A number at each of them.
type Row = [f64; POINTS];

/// An arc of an element against one face of a surface.
pub struct Press<'a> {
    /// The surface and one of its faces.
    pub surface: &'a Surface,
    /// See above.
    pub side: usize,
    /// See above.
    pub face: Face,
    /// Where.
    pub arc: Arc,
    /// The element's shape in the surface's axes.
    pub curve: &'a Cubic,
    /// Its velocity, if it matters.
    pub velocity: Option<&'a Cubic>,
    /// Of the surface, rad/s.
    pub spin: f64,
    /// Of the element, m.
    pub length: f64,
}

impl Press<'_> {
    /// Adds the forces.
    #[inline]
    pub fn add(self, forces: &mut Forces, total: &mut SurfaceLoad) {
        widest(Sum { press: self, forces, total });
    }
}

struct Sum<'a> {
    press: Press<'a>,
    forces: &'a mut Forces,
    total: &'a mut SurfaceLoad,
}

impl Kernel for Sum<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { press, forces, total } = self;
        let Press { surface, side, face, arc, curve, velocity, spin, length } = press;
        let wide = arc.to - arc.from;
        let x: Row = GAUSS5.map(|(position, _)| arc.from + wide * position);
        let s = places(curve, &x);
        let v = velocity.map_or([[0.0; POINTS]; 3], |v| places(v, &x));
        let (mut f, mut normal) = surface.forces(face, &s, &v, spin);
        let mut shapes = [[0.0; POINTS]; 4];
        for g in 0..POINTS {
            let value = shape::value(x[g], length);
            let weight = GAUSS5[g].1 * wide * length;
            normal[g] *= weight;
            for c in 0..3 {
                f[c][g] *= weight;
            }
            for i in 0..4 {
                shapes[i][g] = value[i];
            }
        }
        total.faces[side] += normal.iter().sum::<f64>();
        for c in 0..3 {
            let (a, b) = ((c + 1) % 3, (c + 2) % 3);
            total.force[c] += f[c].iter().sum::<f64>();
            total.moment[c] += (0..POINTS).map(|g| s[a][g] * f[b][g] - s[b][g] * f[a][g]).sum::<f64>();
            for i in 0..4 {
                forces[i][c] += (0..POINTS).map(|g| shapes[i][g] * f[c][g]).sum::<f64>();
            }
        }
    }
}

/// Points of a curve.
#[inline(always)]
fn places(curve: &Cubic, x: &Row) -> [Row; 3] {
    let k = &curve.0;
    std::array::from_fn(|c| x.map(|x| k[0][c] + x * (k[1][c] + x * (k[2][c] + x * k[3][c]))))
}
