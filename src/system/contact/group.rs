//! Elements near a surface, side by side.

use super::{SurfaceFrame, start_of};
use crate::contact::arcs::{Cubic, INTERVALS, Samples};
use crate::contact::surface::{Face, Surface};
use crate::math::lanes::{Kernel, Lanes, Vec3, lane, mat_vec, set_lane, widest};
use crate::system::gather;

/// Elements, or arcs, side by side.
pub const LANES: usize = 8;
/// A number of each.
pub type Row = Lanes<LANES>;
/// A cubic of each: three coordinates of four coefficients.
pub type Cubics = [[Row; 3]; 4];

/// Cubic `l` of those side by side.
#[inline(always)]
pub fn cubic(of: &Cubics, l: usize) -> Cubic {
    Cubic([lane(&of[0], l), lane(&of[1], l), lane(&of[2], l), lane(&of[3], l)])
}

/// Sets cubic `l` of those side by side.
#[inline(always)]
pub fn set_cubic(of: &mut Cubics, l: usize, cubic: &Cubic) {
    for k in 0..4 {
        set_lane(&mut of[k], l, cubic.0[k]);
    }
}

/// Which elements can touch a surface: the gaps are 1-Lipschitz, so a ball around an element's Bézier polygon decides.
pub struct Search<'a> {
    pub surface: &'a Surface,
    pub frame: &'a SurfaceFrame,
    /// Slots of all nodes, and the elements' lengths.
    pub u: &'a [f64],
    pub lengths: &'a [f64],
    /// Their numbers are put here.
    pub found: &'a mut Vec<usize>,
}

impl Search<'_> {
    pub fn run(self) {
        widest(self);
    }
}

impl Kernel for Search<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { surface, frame, u, lengths, found } = self;
        found.clear();
        let (mut middle, mut reach) = ([Row::ZERO; 3], Row::ZERO);
        let mut ends = [[Row::ZERO; 3]; 4];
        for first in (0..lengths.len()).step_by(LANES) {
            let count = LANES.min(lengths.len() - first);
            for l in 0..count {
                let q = gather(u, first + l);
                let third = lengths[first + l] / 3.0;
                for c in 0..3 {
                    ends[0][c].0[l] = q[0][c];
                    ends[1][c].0[l] = q[1][c] * third;
                    ends[2][c].0[l] = q[2][c];
                    ends[3][c].0[l] = q[3][c] * third;
                }
            }
            let rotation = frame.rotation;
            for l in 0..LANES {
                let q: [Vec3<f64>; 4] = std::array::from_fn(|i| lane(&ends[i], l));
                let mut m = [0.0; 3];
                let mut far = [0.0; 3];
                for c in 0..3 {
                    m[c] = 0.5 * (q[0][c] + q[2][c]);
                    let polygon = [q[0][c], q[0][c] + q[1][c], q[2][c] - q[3][c]];
                    for i in 0..3 {
                        far[i] += (polygon[i] - m[c]) * (polygon[i] - m[c]);
                    }
                }
                let at = mat_vec(&rotation, &m);
                for c in 0..3 {
                    middle[c].0[l] = at[c] + frame.base[c];
                }
                reach.0[l] = far[0].max(far[1]).max(far[2]).sqrt();
            }
            for l in 0..count {
                if surface.within(&lane(&middle, l), reach.0[l]) {
                    found.push(first + l);
                }
            }
        }
    }
}

/// Elements side by side in the surface's axes.
pub struct Group {
    /// Their lengths, m.
    pub length: Row,
    /// Shapes.
    pub shape: Cubics,
    /// Velocities relative to the ship, zero unless asked for.
    pub velocity: Cubics,
    /// See [`Samples`].
    start: Row,
    axial: [[Row; INTERVALS + 1]; 2],
    radial: [[Row; INTERVALS + 1]; 2],
}

impl Group {
    pub const EMPTY: Self = Self {
        length: Row::ZERO,
        shape: [[Row::ZERO; 3]; 4],
        velocity: [[Row::ZERO; 3]; 4],
        start: Row::ZERO,
        axial: [[Row::ZERO; INTERVALS + 1]; 2],
        radial: [[Row::ZERO; INTERVALS + 1]; 2],
    };

    /// Takes in `elements`, at most [`LANES`]; their velocities too if `moving`.
    #[inline(always)]
    pub fn fill(
        &mut self,
        surface: &Surface,
        frame: &SurfaceFrame,
        elements: &[usize],
        moving: bool,
        u: &[f64],
        w: &[f64],
        lengths: &[f64],
    ) {
        let (mut slots, mut rates) = ([[Row::ZERO; 3]; 4], [[Row::ZERO; 3]; 4]);
        for l in 0..LANES {
            // In spare lanes the last one again.
            let e = elements[l.min(elements.len() - 1)];
            self.length.0[l] = lengths[e];
            self.start.0[l] = start_of(e);
            set_cubic(&mut slots, l, &Cubic(gather(u, e)));
            if moving {
                set_cubic(&mut rates, l, &Cubic(gather(w, e)));
            }
        }
        let (frame, length) = (*frame, self.length);
        let (mut shape, mut velocity) = ([[Row::ZERO; 3]; 4], [[Row::ZERO; 3]; 4]);
        for l in 0..LANES {
            set_cubic(&mut shape, l, &frame.shape(&cubic(&slots, l).0, length.0[l]).1);
        }
        self.shape = shape;
        if moving {
            for l in 0..LANES {
                let (relative, _) = frame.shape(&cubic(&slots, l).0, length.0[l]);
                set_cubic(&mut velocity, l, &frame.velocity(&relative, &cubic(&rates, l).0, length.0[l]));
            }
            self.velocity = velocity;
        }
        match surface.groove {
            None => self.sample::<true>(surface.radius),
            Some(_) => self.sample::<false>(surface.radius),
        }
    }

    #[inline(always)]
    fn sample<const PLAIN: bool>(&mut self, radius: f64) {
        let (shape, start) = (self.shape, self.start);
        let (mut axial, mut radial) = (self.axial, self.radial);
        for l in 0..LANES {
            let s = Samples::of::<PLAIN>(radius, &cubic(&shape, l), start.0[l]);
            for k in 0..2 {
                set_lane(&mut axial[k], l, s.axial[k]);
                set_lane(&mut radial[k], l, s.radial[k]);
            }
        }
        (self.axial, self.radial) = (axial, radial);
    }

    /// The samples of element `l`.
    #[inline(always)]
    pub fn samples(&self, l: usize) -> Samples {
        let of = |x: &[[Row; INTERVALS + 1]; 2]| [lane(&x[0], l), lane(&x[1], l)];
        Samples { start: self.start.0[l], axial: of(&self.axial), radial: of(&self.radial) }
    }

    /// Which of them may touch a face: not zero.
    #[inline(always)]
    pub fn candidates(&self, face: Face) -> Row {
        let (start, axial, radial) = (self.start, self.axial, self.radial);
        let of = |x: &[[Row; INTERVALS + 1]; 2], l: usize| [lane(&x[0], l), lane(&x[1], l)];
        let mut out = Row::ZERO;
        for l in 0..LANES {
            out.0[l] =
                if (Samples { start: start.0[l], axial: of(&axial, l), radial: of(&radial, l) }).may_touch(face) { 1.0 } else { 0.0 };
        }
        out
    }
}
