//! One pass over the elements, several side by side: internal forces, weight, inertia and, where an element is all under water, fluid forces;
//! with `TANGENT` also M, D and K.

use super::environment::Environment;
use super::matrices::{Matrices, element_block};
use super::wetting::Height;
use crate::cable::section::{Section, Strains};
use crate::cable::shape;
use crate::hydro::line::{LineInWater, LinePoint};
use crate::math::lanes::{Lanes, Mat3, Real, Vec3, dot};
use crate::math::quadrature::GAUSS3;

/// Elements side by side.
const LANES: usize = 4;
type Batch = Lanes<LANES>;

/// Sums over the cable that the energy ledger and the integrator want.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// Elastic energy, J.
    pub elastic: f64,
    /// Its rate, W.
    pub elastic_power: f64,
    /// ½ wᵀ M w, J.
    pub kinetic: f64,
    /// ½ wᵀ Ṁ w, W.
    pub turning: f64,
}

/// How much of an element is under water.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wetness {
    /// Not at all.
    Dry,
    /// The surface crosses it.
    Partial,
    /// Entirely.
    Full,
}

/// The chain of elements.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    /// Unstretched lengths, m.
    pub lengths: Vec<f64>,
    /// Mass per length, kg/m.
    pub mass_per_length: f64,
    /// Laws of the section.
    pub section: Section,
    /// Fluid forces.
    pub water: Option<LineInWater>,
}

/// u, w of the four slots of an element.
#[inline(always)]
pub fn gather(x: &[f64], e: usize) -> [Vec3<f64>; 4] {
    let x = &x[6 * e..6 * e + 12];
    [[x[0], x[1], x[2]], [x[3], x[4], x[5]], [x[6], x[7], x[8]], [x[9], x[10], x[11]]]
}

#[inline(always)]
fn gather_batch(x: &[f64], e: usize, last: usize) -> [Vec3<Batch>; 4] {
    let mut out = [[Batch::splat(0.0); 3]; 4];
    for l in 0..LANES {
        let x = &x[6 * (e + l).min(last)..6 * (e + l).min(last) + 12];
        for i in 0..4 {
            for c in 0..3 {
                out[i][c].0[l] = x[3 * i + c];
            }
        }
    }
    out
}

impl Chain {
    /// How much of element `e` is under water.
    pub fn wetness(&self, water: &LineInWater, env: &Environment, u: &[f64], e: usize) -> (Wetness, Height) {
        let q = gather(u, e);
        let z = env.base[2].0[0];
        let height = Height::new(q[0][2] + z, q[1][2], q[2][2] + z, q[3][2], self.lengths[e]);
        let half = 0.5 * water.diameter;
        let w = if height.bounds.1 <= water.waterline - half {
            Wetness::Full
        } else if height.bounds.0 >= water.waterline + half {
            Wetness::Dry
        } else {
            Wetness::Partial
        };
        (w, height)
    }

    /// Overwrites `forces` (12 per element: all that acts on the element's own slots, inertia included) and, with `TANGENT`, adds M, D and K of
    /// F − M(u) a to `matrices`. `a`: acceleration relative to the first node; without it no inertia relative to the first node.
    pub fn pass<const TANGENT: bool>(
        &self,
        env: &Environment,
        u: &[f64],
        w: &[f64],
        a: Option<&[f64]>,
        forces: &mut [[f64; 12]],
        matrices: &mut Matrices,
    ) -> Tally {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
            // SAFETY: the features that the function is compiled for were just detected.
            #[allow(unsafe_code)]
            return unsafe { self.pass_avx2::<TANGENT>(env, u, w, a, forces, matrices) };
        }
        self.pass_with::<TANGENT>(env, u, w, a, forces, matrices)
    }

    /// The same code for processors with AVX2.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn pass_avx2<const TANGENT: bool>(
        &self,
        env: &Environment,
        u: &[f64],
        w: &[f64],
        a: Option<&[f64]>,
        forces: &mut [[f64; 12]],
        matrices: &mut Matrices,
    ) -> Tally {
        self.pass_with::<TANGENT>(env, u, w, a, forces, matrices)
    }

    #[inline(always)]
    fn pass_with<const TANGENT: bool>(
        &self,
        env: &Environment,
        u: &[f64],
        w: &[f64],
        a: Option<&[f64]>,
        forces: &mut [[f64; 12]],
        matrices: &mut Matrices,
    ) -> Tally {
        let count = self.lengths.len();
        let last = count - 1;
        let mut tally = Tally::default();
        let damped = self.section.is_damped();
        let mut e0 = 0;
        while e0 < count {
            let lanes = LANES.min(count - e0);
            let (mut length, mut wet, mut live) = (Batch::splat(1.0), Batch::splat(0.0), Batch::splat(0.0));
            for l in 0..LANES {
                let e = (e0 + l).min(last);
                length.0[l] = self.lengths[e];
                live.0[l] = if l < lanes { 1.0 } else { 0.0 };
                if let Some(water) = &self.water
                    && self.wetness(water, env, u, e).0 == Wetness::Full
                {
                    wet.0[l] = 1.0;
                }
            }
            let water = self.water.as_ref().filter(|_| wet.0.iter().any(|x| *x > 0.0));
            let inverse = Batch::splat(1.0) / length;
            let (qu, qw) = (gather_batch(u, e0, last), gather_batch(w, e0, last));
            let qa = a.map(|a| gather_batch(a, e0, last));
            let zero = Batch::splat(0.0);
            let mut f = [[zero; 3]; 4];
            let mut k = [[[[zero; 3]; 3]; 4]; 4];
            let mut d = k;
            let mut m = k;
            let (mut elastic, mut power, mut turning, mut kinetic) = (zero, zero, zero, zero);
            for (x, weight) in GAUSS3 {
                let wl = length * weight;
                let (sp, spp) = (shape::slope(x, inverse), shape::second(x, inverse));
                let strains = Strains {
                    p: shape::interpolate(&sp, &qu),
                    pp: shape::interpolate(&spp, &qu),
                    vp: shape::interpolate(&sp, &qw),
                    vpp: shape::interpolate(&spp, &qw),
                };
                let r = self.section.resistance::<Batch, TANGENT>(&strains);
                elastic += wl * r.energy;
                power += wl * r.power;
                for i in 0..4 {
                    for c in 0..3 {
                        f[i][c] -= wl * (sp[i] * r.n[c] + spp[i] * r.m[c]);
                    }
                }
                if TANGENT {
                    for j in 0..4 {
                        let (a1, a2) = (wl * sp[j], wl * spp[j]);
                        let mut on_n = [[zero; 3]; 3];
                        let mut on_m = on_n;
                        for r3 in 0..3 {
                            for c in 0..3 {
                                on_n[r3][c] = a1 * r.k_pp[r3][c] + a2 * r.k_pq[r3][c];
                                on_m[r3][c] = a1 * r.k_qp[r3][c] + a2 * r.k_qq[r3][c];
                            }
                        }
                        for i in 0..4 {
                            add_pair(&mut k[i][j], sp[i], &on_n, spp[i], &on_m);
                        }
                        if damped {
                            for r3 in 0..3 {
                                for c in 0..3 {
                                    on_n[r3][c] = a1 * r.d_pp[r3][c] + a2 * r.d_pq[r3][c];
                                    on_m[r3][c] = a1 * r.d_pq[c][r3] + a2 * r.d_qq[r3][c];
                                }
                            }
                            for i in 0..4 {
                                add_pair(&mut d[i][j], sp[i], &on_n, spp[i], &on_m);
                            }
                        }
                    }
                }
                if let Some(water) = water {
                    let s = shape::value(x, length);
                    let base = |k: usize| -> Vec3<Batch> { std::array::from_fn(|c| Batch::splat(env.base[c].0[k])) };
                    let (r, rel) = (shape::interpolate(&s, &qu), shape::interpolate(&s, &qw));
                    let (v0, mut acc) = (base(1), base(2));
                    if let Some(qa) = &qa {
                        let ra = shape::interpolate(&s, qa);
                        for c in 0..3 {
                            acc[c] += ra[c];
                        }
                    }
                    let point = LinePoint {
                        z: r[2] + Batch::splat(env.base[2].0[0]),
                        v: std::array::from_fn(|c| rel[c] + v0[c]),
                        p: strains.p,
                        vp: strains.vp,
                        a: acc,
                        w: rel,
                    };
                    let load = water.load::<Batch, TANGENT>(&point, &env.flow);
                    let wl = wl * wet;
                    turning += wl * load.turning;
                    let along = dot(&rel, &strains.p);
                    kinetic += wl * (dot(&rel, &rel) - along * along / dot(&strains.p, &strains.p)) * (0.5 * water.added_mass);
                    for i in 0..4 {
                        for c in 0..3 {
                            f[i][c] += wl * s[i] * load.f[c];
                        }
                    }
                    if TANGENT {
                        for j in 0..4 {
                            let (a0, a1) = (wl * s[j], wl * sp[j]);
                            for i in 0..4 {
                                for r3 in 0..3 {
                                    let row = s[i];
                                    k[i][j][r3][2] -= row * a0 * load.dz[r3];
                                    for c in 0..3 {
                                        k[i][j][r3][c] -= row * a1 * load.dp[r3][c];
                                        d[i][j][r3][c] -= row * a0 * load.dv[r3][c];
                                        m[i][j][r3][c] += row * a0 * load.mass[r3][c];
                                    }
                                }
                            }
                        }
                    }
                }
            }
            // Weight, the moving frame's and the element's own inertia.
            let (total, mass) = (shape::integral(length), shape::mass(length));
            for i in 0..4 {
                for c in 0..3 {
                    let mut inertia = total[i] * (env.gravity[c] - env.base[c].0[2]);
                    if let Some(qa) = &qa {
                        for j in 0..4 {
                            inertia -= mass[i][j] * qa[j][c];
                        }
                    }
                    f[i][c] += inertia * self.mass_per_length;
                    for j in 0..4 {
                        kinetic += mass[i][j] * qw[i][c] * qw[j][c] * (0.5 * self.mass_per_length);
                    }
                }
            }
            tally.elastic += (elastic * live).sum();
            tally.elastic_power += (power * live).sum();
            tally.turning += (turning * live).sum();
            tally.kinetic += (kinetic * live).sum();
            for l in 0..lanes {
                let out = &mut forces[e0 + l];
                for i in 0..4 {
                    for c in 0..3 {
                        out[3 * i + c] = f[i][c].0[l];
                    }
                }
            }
            if TANGENT {
                let structural = mass;
                for i in 0..4 {
                    for j in 0..4 {
                        for c in 0..3 {
                            m[i][j][c][c] += structural[i][j] * self.mass_per_length;
                        }
                    }
                }
                scatter(&mut matrices.stiffness, e0, lanes, &k);
                scatter(&mut matrices.mass, e0, lanes, &m);
                if damped || water.is_some() {
                    scatter(&mut matrices.damping, e0, lanes, &d);
                }
            }
            e0 += LANES;
        }
        tally
    }
}

#[inline(always)]
fn add_pair(k: &mut Mat3<Batch>, a: Batch, x: &Mat3<Batch>, b: Batch, y: &Mat3<Batch>) {
    for r in 0..3 {
        for c in 0..3 {
            k[r][c] += a * x[r][c] + b * y[r][c];
        }
    }
}

#[inline(always)]
fn scatter(m: &mut crate::linalg::BlockTridiagonal, e0: usize, lanes: usize, k: &[[Mat3<Batch>; 4]; 4]) {
    for l in 0..lanes {
        for i in 0..4 {
            for j in 0..4 {
                let block = element_block(m, e0 + l, i, j);
                for r in 0..3 {
                    for c in 0..3 {
                        block[3 * (i % 2) + r][3 * (j % 2) + c] += k[i][j][r][c].0[l];
                    }
                }
            }
        }
    }
}
