//! A far end fixed in the inertial frame. In coordinates relative to the first node it moves: u_N(t) = x − r_b(t).
//!
//! Its rows are ü_N = ã(τ), τ since the sub-step's begin, with the parabola ã that starts at −r̈_b and ends the sub-step at u_N and u̇_N
//! exactly; it differs from −r̈_b by O(h³). A method of order 4 integrates u̇ = w, ẇ = ã without error, so after each accepted sub-step u_N
//! and w_N are set to their true values and that moves them by rounding only: no drift, and no jump that the cable would answer with a wave.
//! (Stage values forced to the true ones would be at odds with those of the neighbours, whose stages are of order one: a stiff cable would
//! be stretched by the difference.)

use super::wetting::Height;
use super::{Environment, System, Wetness, gather};
use crate::cable::shape;
use crate::hydro::surface::line_share;
use crate::math::jet::Jet;
use crate::math::lanes::{Vec3, axpy, dot};
use crate::math::quadrature::GAUSS3;

/// Sub-steps below this (s) take ã's slope from the jerk: the difference of positions would lose it to rounding, and what ã then misses,
/// h⁵/120 of the fifth derivative, is rounding too.
const SHORT: f64 = 1e-3;

/// A fixed far end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FarEnd {
    /// World, m.
    pub position: Vec3<f64>,
    /// During the attempt of a sub-step: its begin and ã's coefficients.
    attempt: Option<(f64, [Vec3<f64>; 3])>,
}

impl FarEnd {
    /// At a place.
    pub fn new(position: Vec3<f64>) -> Self {
        Self { position, attempt: None }
    }

    /// u_N, u̇_N and ü_N where the first node moves by `base`.
    pub fn motion(&self, base: &[Jet; 3]) -> [Vec3<f64>; 3] {
        std::array::from_fn(|k| std::array::from_fn(|c| if k == 0 { self.position[c] } else { 0.0 } - base[c].0[k]))
    }

    /// ã during the attempt of a sub-step, else ü_N.
    pub(super) fn acceleration(&self, t: f64, base: &[Jet; 3]) -> Vec3<f64> {
        match &self.attempt {
            Some((begin, p)) => {
                let tau = t - begin;
                std::array::from_fn(|c| p[0][c] + tau * (p[1][c] + tau * p[2][c]))
            }
            None => self.motion(base)[2],
        }
    }
}

impl System {
    /// Before a sub-step from `t` to `t + h` is tried.
    pub fn attempt(&mut self, t: f64, h: f64) {
        let Some(end) = self.far_end else { return };
        let (from, to) = (self.environment(t), self.environment(t + h));
        let ([u0, w0, a0], [u1, w1, _]) = (end.motion(&from.base), end.motion(&to.base));
        let mut p = [a0, [0.0; 3], [0.0; 3]];
        for c in 0..3 {
            // w1 = w0 + a0 h + p1 h²/2 + p2 h³/3, u1 = u0 + w0 h + a0 h²/2 + p1 h³/6 + p2 h⁴/12.
            let dw = (w1[c] - w0[c] - a0[c] * h) / h;
            if h > SHORT {
                let du = ((u1[c] - u0[c]) / h - w0[c] - 0.5 * a0[c] * h) / h;
                // p1 h/2 + p2 h²/3 = dw, p1 h/6 + p2 h²/12 = du.
                p[1][c] = (24.0 * du - 6.0 * dw) / h;
                p[2][c] = (12.0 * dw - 36.0 * du) / (h * h);
            } else {
                p[1][c] = -from.base[c].0[3];
                p[2][c] = 3.0 * (dw - 0.5 * p[1][c] * h) / (h * h);
            }
        }
        self.far_end = Some(FarEnd { attempt: Some((t, p)), ..end });
    }

    /// The state reached at `t`, brought onto everything that is prescribed; no sub-step is under way any more.
    pub fn reach(&mut self, t: f64, u: &mut [f64], w: &mut [f64], a: &mut [f64]) {
        if self.load.is_some() {
            super::load::RigidLoad::project(6 * self.arc.len() + 3, u, w, a);
        }
        if let Some(end) = self.far_end {
            self.far_end = Some(FarEnd::new(end.position));
            let at = 6 * (self.arc.len() - 1);
            let motion = end.motion(&self.environment(t).base);
            for (x, exact) in [u, w, a].into_iter().zip(motion) {
                x[at..at + 3].copy_from_slice(&exact);
            }
        }
    }

    /// Replaces the far end's rows of F − M(u) a.
    pub(super) fn drive_far_end(&self, env: &Environment, a: Option<&[f64]>, f: &mut [f64]) {
        if self.far_end.is_some() {
            let at = 6 * (self.arc.len() - 1);
            for c in 0..3 {
                f[at + c] = env.far_end_acceleration[c] - a.map_or(0.0, |a| a[at + c]);
            }
        }
    }

    /// ∂F/∂t of the far end's rows.
    pub(super) fn far_end_rate(&self, t: f64, f: &mut [f64]) {
        let Some(end) = &self.far_end else { return };
        let at = 6 * (self.arc.len() - 1);
        let jerk = |c: usize| -self.environment(t).base[c].0[3];
        for c in 0..3 {
            f[at + c] = end.attempt.map_or_else(|| jerk(c), |(_, p)| p[1][c]);
        }
    }

    /// The support's force on the far end does work, and is known only with the accelerations. Without them: with p = (M w)_N, the momentum
    /// that belongs to the far end's velocity w_N, and M a = F + (reaction on N),
    ///
    /// ```text
    /// d/dt (½ wᵀMw + U − w_N·p) = Σ_{i≠N} w_i·F_i − ẇ_N·p − w_N·(Ṁw)_N + ½ wᵀṀw + dU/dt.
    /// ```
    ///
    /// So the ledger is given ½ wᵀMw − w_N·p for the kinetic energy. It adds w_N·f_N of the prescribed row too, which is taken back here.
    pub(super) fn account_for_far_end(&mut self, env: &Environment, u: &[f64], w: &[f64]) {
        if self.far_end.is_none() {
            return;
        }
        let acceleration = &env.far_end_acceleration;
        let e = self.chain.lengths.len() - 1;
        let l = self.chain.lengths[e];
        let q = gather(w, e);
        let wn = q[2];
        let mut p = [0.0; 3];
        let mut rate = [0.0; 3];
        for (j, m) in shape::mass(l)[2].iter().enumerate() {
            p = axpy(&p, m * self.chain.mass_per_length, &q[j]);
        }
        if let Some(water) = &self.chain.water
            && (wn != [0.0; 3] || *acceleration != [0.0; 3])
        {
            let (wetness, height) = self.chain.wetness(water, env, u, e);
            let all = |from: f64, to: f64| {
                for (x, weight) in GAUSS3 {
                    let x = from + (to - from) * x;
                    let (s, sp) = (shape::value(x, l), shape::slope(x, 1.0 / l));
                    let qu = gather(u, e);
                    let (r, v) = (shape::interpolate(&s, &qu), shape::interpolate(&s, &q));
                    let (slope, turn) = (shape::interpolate(&sp, &qu), shape::interpolate(&sp, &q));
                    let i = 1.0 / dot(&slope, &slope).sqrt();
                    let t = slope.map(|c| c * i);
                    let turn = axpy(&turn, -dot(&turn, &t), &t).map(|c| c * i);
                    let (share, dshare) = match wetness {
                        Wetness::Partial => line_share(r[2] + env.base[2].0[0], water.waterline, water.diameter),
                        _ => (1.0, 0.0),
                    };
                    let k = (to - from) * l * weight * s[2] * water.added_mass;
                    let across = axpy(&v, -dot(&v, &t), &t);
                    p = axpy(&p, k * share, &across);
                    rate = axpy(&rate, k * dshare * (v[2] + env.base[2].0[1]), &across);
                    rate = axpy(&rate, -k * share * dot(&v, &t), &turn);
                    rate = axpy(&rate, -k * share * dot(&v, &turn), &t);
                }
            };
            wet_parts(wetness, &height, water.waterline, 0.5 * water.diameter, all);
        }
        self.tally.kinetic -= dot(&wn, &p);
        self.tally.turning -= dot(acceleration, &p) + dot(&wn, &rate) + dot(&wn, acceleration);
    }
}

fn wet_parts(wetness: Wetness, height: &Height, level: f64, half: f64, mut part: impl FnMut(f64, f64)) {
    match wetness {
        Wetness::Dry => {}
        Wetness::Full => part(0.0, 1.0),
        Wetness::Partial => height.wet_pieces(level - half, level + half, part),
    }
}
