//! Elements that the water's surface crosses: fluid forces on their wet pieces, each with its own three points, side by side.

use super::elements::{Wetness, gather};
use super::environment::Environment;
use super::matrices::Matrices;
use super::points::ElementPoint;
use super::{System, Tally};
use crate::cable::shape;
use crate::hydro::line::{Flow, LineInWater, LineLoads, LinePoint, LinePoints};
use crate::hydro::surface::line_share;
use crate::math::jet::Jet;
use crate::math::lanes::{Kernel, Mat3, Vec3, dot, widest};
use crate::math::quadrature::GAUSS3;

/// Points side by side.
const LANES: usize = 8;

/// Points as they are found.
struct Wet<'a> {
    water: &'a LineInWater,
    flow: &'a Flow,
    count: usize,
    at: [Option<(ElementPoint, f64)>; LANES],
    points: LinePoints<LANES>,
}

struct Loads<'a, const TANGENT: bool>(&'a Wet<'a>);

impl<const TANGENT: bool> Kernel for Loads<'_, TANGENT> {
    type Output = LineLoads<LANES>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        self.0.water.loads::<TANGENT, LANES>(&self.0.points, self.0.flow)
    }
}

impl Wet<'_> {
    /// Adds what the points feel to forces and matrices.
    fn flush<const TANGENT: bool>(
        &mut self,
        base: &[Jet; 3],
        forces: &mut [[f64; 12]],
        f: &mut [f64],
        tally: &mut Tally,
        m: &mut Matrices,
    ) {
        if self.count == 0 {
            return;
        }
        // The spare lanes hold older points, whose loads are left.
        let loads = widest(Loads::<TANGENT>(self));
        for (l, (point, wl)) in self.at[..self.count].iter().flatten().enumerate() {
            let (load, at, water) = (loads.at(l), self.points.at(l), self.water);
            let (share, dshare) = line_share(at.z, water.waterline, water.diameter);
            let s = wl * share;
            point.push(&load.f.map(|x| s * x), forces, f);
            let across = |x: &Vec3<f64>| dot(&point.w, x) - dot(&point.w, &point.p) * dot(x, &point.p) / dot(&point.p, &point.p);
            let relative = std::array::from_fn(|c| at.a[c] - base[c].0[2]);
            tally.accelerate(s * water.added_mass * across(&relative));
            let across = across(&point.w);
            tally.kinetic += s * 0.5 * water.added_mass * across;
            tally.turning += s * load.turning + wl * dshare * at.v[2] * 0.5 * water.added_mass * across;
            if TANGENT {
                let mut by_r = [[0.0; 3]; 3];
                for r in 0..3 {
                    by_r[r][2] = s * load.dz[r] + wl * dshare * load.f[r];
                }
                let times = |b: &Mat3<f64>| b.map(|row| row.map(|x| s * x));
                point.couple(Some(&by_r), Some(&times(&load.dp)), Some(&times(&load.dv)), Some(&times(&load.mass)), m);
            }
        }
        self.count = 0;
    }
}

impl System {
    /// Adds the fluid forces on elements that the surface crosses.
    pub(super) fn cut<const TANGENT: bool>(
        &mut self,
        env: &Environment,
        u: &[f64],
        w: &[f64],
        a: Option<&[f64]>,
        f: &mut [f64],
        m: &mut Matrices,
    ) {
        let Some(water) = &self.chain.water else { return };
        self.chain.crossed(water, env, u, &mut self.crossed);
        if self.crossed.is_empty() {
            return;
        }
        let half = 0.5 * water.diameter;
        let (forces, tally) = (&mut self.forces, &mut self.tally);
        let mut wet = Wet { water, flow: &env.flow, count: 0, at: [None; LANES], points: LinePoints::NONE };
        for &e in &self.crossed {
            let (wetness, height) = self.chain.wetness(water, env, u, e);
            debug_assert_eq!(wetness, Wetness::Partial);
            let l = self.chain.lengths[e];
            height.wet_pieces(water.waterline - half, water.waterline + half, |from, to| {
                for (x, weight) in GAUSS3 {
                    let x = from + (to - from) * x;
                    let point = ElementPoint::new(u, w, e, l, x);
                    let ra = a.map_or([0.0; 3], |a| shape::interpolate(&point.s, &gather(a, e)));
                    let at = LinePoint {
                        z: point.u[2] + env.base[2].0[0],
                        v: std::array::from_fn(|c| point.w[c] + env.base[c].0[1]),
                        p: point.p,
                        vp: point.vp,
                        a: std::array::from_fn(|c| ra[c] + env.base[c].0[2]),
                        w: point.w,
                    };
                    if wet.count == LANES {
                        wet.flush::<TANGENT>(&env.base, forces, f, tally, m);
                    }
                    wet.points.set(wet.count, &at);
                    wet.at[wet.count] = Some((point, (to - from) * l * weight));
                    wet.count += 1;
                }
            });
        }
        wet.flush::<TANGENT>(&env.base, forces, f, tally, m);
    }
}
