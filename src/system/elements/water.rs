//! Fluid forces on elements that are all under water.

use super::super::environment::Environment;
use super::batch::{Batch, LANES, NONE, Row, Rows3, Slopes, Station, along, spans, value};
use crate::hydro::line::{LineInWater, LinePoint, Stream};
use crate::math::lanes::{dot, lane, scale, set_lane};

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

#[inline(always)]
fn stream_lane(x: &[Rows3; 2], l: usize) -> Stream {
    (lane(&x[0], l), lane(&x[1], l))
}

/// Fluid forces at a Gauss point.
#[inline(always)]
pub fn immerse<const TANGENT: bool, const CROSS_FLOW: bool>(
    water: &LineInWater,
    env: &Environment,
    batch: &mut Batch,
    station: &Station,
    slopes: &mut Slopes,
) {
    let Station { weight, s, .. } = *station;
    // Look-ups cannot go side by side, so they have loops of their own.
    let (mut z, mut re, mut cd) = (Row::ZERO, Row::ZERO, [Row::ZERO; 2]);
    let mut stream = [[Row::ZERO; 3]; 2];
    for l in 0..LANES {
        z.0[l] = fluid_point(env, batch, station, l).z;
    }
    for l in 0..LANES {
        let (v, dz) = water.stream(z.0[l], &env.flow);
        set_lane(&mut stream[0], l, v);
        set_lane(&mut stream[1], l, dz);
    }
    for l in 0..LANES {
        re.0[l] = water.reynolds::<CROSS_FLOW>(&fluid_point(env, batch, station, l), &stream_lane(&stream, l));
    }
    for l in 0..LANES {
        set_lane(&mut cd, l, water.coefficient(re.0[l]).into());
    }
    // Rows of the loop's own, since only of these does the compiler know that nothing else changes them.
    let (mut dz, mut dv, mut dp, mut mass) = ([Row::ZERO; 3], NONE, NONE, NONE);
    for l in 0..LANES {
        let x = fluid_point(env, batch, station, l);
        let load = water.load_in::<TANGENT, CROSS_FLOW>(&x, &stream_lane(&stream, l), lane(&cd, l).into(), &env.flow);
        let wl = weight * batch.length.0[l] * batch.wet.0[l];
        let (w2, wp, p2) = (dot(&x.w, &x.w), dot(&x.w, &x.p), dot(&x.p, &x.p));
        batch.turning.0[l] += wl * load.turning;
        let a: [f64; 3] = std::array::from_fn(|c| x.a[c] - env.base[c].0[2]);
        batch.kinetic.0[l] += wl * (w2 - wp * wp / p2) * (0.5 * water.added_mass);
        batch.inertial.0[l] += wl * (dot(&x.w, &a) - wp * dot(&a, &x.p) / p2) * water.added_mass;
        for c in 0..3 {
            let f = wl * load.f[c];
            for i in 0..4 {
                batch.f[i][c].0[l] += s[i] * f;
            }
        }
        if TANGENT {
            let flat = |s: f64, m: &[[f64; 3]; 3]| -> [f64; 9] { std::array::from_fn(|k| s * m[k / 3][k % 3]) };
            set_lane(&mut dz, l, scale(wl, &load.dz));
            set_lane(&mut dv, l, flat(wl, &load.dv));
            set_lane(&mut dp, l, flat(wl * batch.inverse.0[l], &load.dp));
            set_lane(&mut mass, l, flat(wl, &load.mass));
        }
    }
    if TANGENT {
        (slopes.dz, slopes.dv, slopes.dp, slopes.mass) = (dz, dv, dp, mass);
    }
}
