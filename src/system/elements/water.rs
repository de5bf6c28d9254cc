//! Fluid forces on elements that are all under water.

use super::super::environment::Environment;
use super::batch::{Batch, LANES, NONE, Row, Slopes, Station, along, spans, value};
use crate::hydro::line::{LineInWater, LinePoint, LinePoints};
use crate::math::lanes::dot;

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

/// Fluid forces at a Gauss point; sums only with `TALLY`.
#[inline(always)]
pub fn immerse<const TANGENT: bool, const TALLY: bool>(
    water: &LineInWater,
    env: &Environment,
    batch: &mut Batch,
    station: &Station,
    slopes: &mut Slopes,
) {
    let Station { weight, s, .. } = *station;
    let mut points = LinePoints::<LANES>::NONE;
    for l in 0..LANES {
        points.set(l, &fluid_point(env, batch, station, l));
    }
    let loads = water.loads::<TANGENT, LANES>(&points, &env.flow);
    // Rows of the loops' own, since only of these does the compiler know that nothing else changes them.
    let (length, wet, mut f) = (batch.length, batch.wet, batch.f);
    let mut wl = Row::ZERO;
    for l in 0..LANES {
        wl.0[l] = weight * length.0[l] * wet.0[l];
        for c in 0..3 {
            let force = wl.0[l] * loads.f[c].0[l];
            for i in 0..4 {
                f[i][c].0[l] += s[i] * force;
            }
        }
    }
    batch.f = f;
    if TALLY {
        let base = env.base.map(|j| j.0[2]);
        let (mut turning, mut kinetic, mut inertial) = (batch.turning, batch.kinetic, batch.inertial);
        for l in 0..LANES {
            let x = points.at(l);
            let (w2, wp, p2) = (dot(&x.w, &x.w), dot(&x.w, &x.p), dot(&x.p, &x.p));
            turning.0[l] += wl.0[l] * loads.turning.0[l];
            let a = [x.a[0] - base[0], x.a[1] - base[1], x.a[2] - base[2]];
            kinetic.0[l] += wl.0[l] * (w2 - wp * wp / p2) * (0.5 * water.added_mass);
            inertial.0[l] += wl.0[l] * (dot(&x.w, &a) - wp * dot(&a, &x.p) / p2) * water.added_mass;
        }
        (batch.turning, batch.kinetic, batch.inertial) = (turning, kinetic, inertial);
    }
    if TANGENT {
        let inverse = batch.inverse;
        let (mut dz, mut dv, mut dp, mut mass) = ([Row::ZERO; 3], NONE, NONE, NONE);
        for l in 0..LANES {
            for c in 0..3 {
                dz[c].0[l] = wl.0[l] * loads.dz[c].0[l];
            }
            for k in 0..9 {
                dv[k].0[l] = wl.0[l] * loads.dv[k].0[l];
                dp[k].0[l] = wl.0[l] * inverse.0[l] * loads.dp[k].0[l];
                mass[k].0[l] = wl.0[l] * loads.mass[k].0[l];
            }
        }
        (slopes.dz, slopes.dv, slopes.dp, slopes.mass) = (dz, dv, dp, mass);
    }
}
