//! The static start: pseudo-transient continuation from a laid-out shape.
//!
//! Each iteration is one linearly implicit Euler step from rest, (M + Δ D + Δ² K) δ = Δ² F(u): a heavily damped motion for small Δ, Newton's
//! method for large Δ (C. T. Kelley & D. E. Keyes, SIAM J. Numer. Anal. 35 (1998) 508-523). Δ grows as the residual falls. The mass term keeps
//! slack and unbent parts regular.
//!
//! A cable much stiffer than its load can hardly turn without a glimpse of enormous tension, so the first rounds are made with one that yields
//! by percents; its shape is nearly right, and each stiffer one starts from the last.

mod given;
mod layout;
mod span;

pub use given::take_shape;
pub use layout::{OnWheel, lay_out, on_wheels};
pub use span::{follow, glide, lay_between, meet};

use crate::integrator::Problem;
use crate::linalg::BlockTridiagonal;
use crate::math::lanes::{axpy, mat_vec};
use crate::system::contact::SurfaceFrame;
use crate::system::{Matrices, System};

/// Iterations before giving up.
const ITERATIONS: usize = 4000;
/// And before passing on from a soft round.
const ROUND: usize = 300;
/// Greatest change of a slope per iteration; larger ones are scaled back.
const TURN: f64 = 0.25;
/// Greatest move near a drum or sheave per iteration, over its radius.
const NEAR: f64 = 0.2;
/// Residual over the load at which the state counts as an equilibrium.
const TOLERANCE: f64 = 1e-10;
/// Rounding of a slope over the ratio of cable to element length, with room for sums of several terms.
const ROUNDING: f64 = 2e-15;
/// Iterations from a balanced state on.
const POLISH: usize = 8;
/// Factor by which the residual may grow in an accepted iteration.
const GROWTH: f64 = 2.0;
/// EA over all that acts in the first round, and the factor between rounds.
const SOFT: f64 = 10.0;
const STIFFEN: f64 = 10.0;
/// Residual over the load that is good enough before the last round.
const COARSE: f64 = 1e-3;

/// Moves `u` (relative to the first node) to the equilibrium at time `t` under the boundary's present velocity.
///
/// # Errors
/// What remained unbalanced, where, and what to try.
pub fn solve(system: &mut System, t: f64, u: &mut [f64], load: f64) -> Result<usize, String> {
    system.frozen = true;
    let section = system.chain.section;
    // Soft rounds may push: a slack stretch would have no axial stiffness at all.
    system.chain.section.tension_only = false;
    // What acts on the unstretched shape: weight, flow, forces on the body.
    let mut f = vec![0.0; u.len()];
    system.force(t, u, &vec![0.0; u.len()], None, &mut f);
    let acting: f64 = f.chunks_exact(6).map(|r| r[..3].iter().map(|x| x * x).sum::<f64>().sqrt()).sum();
    let mut soft = SOFT * load.max(acting);
    let mut count = 0;
    while 3.0 * soft < section.ea {
        system.chain.section.ea = soft;
        // What a soft round misses the stiffer ones must find.
        count += iterate(system, t, u, load, COARSE, ROUND).unwrap_or(ROUND);
        soft *= STIFFEN;
    }
    system.chain.section = section;
    let outcome = iterate(system, t, u, load, TOLERANCE, ITERATIONS);
    system.frozen = false;
    outcome.map(|n| n + count)
}

/// The share of `step` after which no node has jumped through drum or sheave.
fn careful(system: &System, t: f64, u: &[f64], step: &[f64]) -> f64 {
    let mut share = 1.0f64;
    if system.surfaces.is_empty() {
        return share;
    }
    let env = system.environment(t);
    for surface in &system.surfaces {
        let frame = SurfaceFrame::new(surface, &env, true);
        for (u, s) in u.chunks_exact(6).zip(step.chunks_exact(6)) {
            let moved = (s[0] * s[0] + s[1] * s[1] + s[2] * s[2]).sqrt();
            let at = axpy(&mat_vec(&frame.rotation, &[u[0], u[1], u[2]]), 1.0, &frame.base);
            let allowed = (NEAR * surface.radius).max(0.5 * surface.least_gap(&at).abs());
            if moved > allowed {
                share = share.min(allowed / moved);
            }
        }
    }
    share
}

fn iterate(system: &mut System, t: f64, u: &mut [f64], load: f64, tolerance: f64, iterations: usize) -> Result<usize, String> {
    let n = u.len();
    let zero = vec![0.0; n];
    let mut m = Matrices::zeros(n / 6);
    let (mut f, mut trial, mut trial_f, mut step) = (zero.clone(), zero.clone(), zero.clone(), zero.clone());
    let mut a = BlockTridiagonal::zeros(n / 6);
    let shortest = system.chain.lengths.iter().copied().fold(f64::INFINITY, f64::min);
    // Slope rows are moments: over an element length they are forces.
    let size = |f: &[f64]| {
        f.chunks_exact(6)
            .map(|r| (r[..3].iter().map(|x| x * x).sum::<f64>() + r[3..].iter().map(|x| x * x).sum::<f64>() / (shortest * shortest)).sqrt())
            .fold(0.0, f64::max)
    };
    // Rounding of the internal forces bounds what can be asked for: slopes from positions lose the digits of length over element length.
    let finest = system.arc[system.arc.len() - 1] / shortest;
    let small = (tolerance * load).max(ROUNDING * finest * system.chain.section.ea);
    let mut delta = 1e-2;
    let mut worst = f64::INFINITY;
    let (mut best, mut least, mut polished) = (zero.clone(), f64::INFINITY, 0);
    for iteration in 0..iterations {
        system.linearize(t, u, &zero, &zero, &mut m, &mut f);
        worst = size(&f);
        if !worst.is_finite() {
            return Err("the forces of the start shape are not finite".into());
        }
        let mut accepted = false;
        for _ in 0..40 {
            m.sum([1.0, delta, delta * delta], &mut a);
            let good = a.factor().is_ok();
            if good {
                for (s, f) in step.iter_mut().zip(&f) {
                    *s = delta * delta * f;
                }
                a.solve(&mut step);
                let turn = step.chunks_exact(6).flat_map(|s| &s[3..]).fold(0.0f64, |m, x| m.max(x.abs()));
                let scale = (TURN / turn).min(careful(system, t, u, &step)).min(1.0);
                if turn.is_finite() {
                    for ((t, u), s) in trial.iter_mut().zip(&*u).zip(&step) {
                        *t = u + scale * s;
                    }
                    system.force(t, &trial, &zero, None, &mut trial_f);
                    let after = size(&trial_f);
                    if after <= small || after <= GROWTH * worst {
                        u.copy_from_slice(&trial);
                        let ratio = (worst / after).clamp(0.7, 2.0);
                        delta = (delta * if scale < 1.0 { 1.05 } else { 2.0 * ratio }).min(1e7);
                        if after <= small {
                            // A few more give the last digits of what little force moves; rounding decides which is the best of them.
                            if after < least {
                                least = after;
                                best.copy_from_slice(u);
                            }
                            polished += 1;
                            if tolerance >= COARSE || polished > POLISH {
                                u.copy_from_slice(&best);
                                return Ok(iteration + 1);
                            }
                        }
                        accepted = true;
                        break;
                    }
                }
            }
            delta *= 0.2;
            if delta < 1e-12 {
                break;
            }
        }
        if !accepted {
            break;
        }
    }
    let (node, _) = f.chunks_exact(6).enumerate().fold((0, 0.0), |best, (i, r)| {
        let s: f64 = r[..3].iter().map(|x| x * x).sum();
        if s > best.1 { (i, s) } else { best }
    });
    Err(format!(
        "no static equilibrium found: {worst:.3e} N remain unbalanced (tolerated: {small:.1e} N), most at {:.4} m along the cable; \
         try [initial] state = \"straight\" or \"shape\", more elements there, or a softer contact stiffness",
        system.arc_of(node)
    ))
}
