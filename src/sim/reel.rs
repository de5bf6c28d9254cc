//! The limit of reeling in.

use crate::system::contact::SurfaceFrame;
use crate::system::{FirstEnd, System};

/// How near the far end may come to the drum's surface, over the drum's radius: a body has a size, and the last bit of a stiff cable stands off
/// the drum on which it is wound.
const NEAR: f64 = 0.125;

/// Whether the cable's far end has come to the drum: no cable is left to reel in, and what hangs at the end would be drawn over the drum and paid
/// out on its other side. A drum without contact winds no cable up and has no such limit.
pub(super) fn is_wound_up(system: &System, t: f64, u: &[f64]) -> bool {
    if !matches!(system.first, FirstEnd::Winch { contact: true, .. }) {
        return false;
    }
    let Some(drum) = system.surfaces.first() else { return false };
    let frame = SurfaceFrame::new(drum, &system.environment(t), true);
    let at = 6 * (system.arc.len() - 1);
    let end = frame.place(&[u[at], u[at + 1], u[at + 2]]);
    drum.least_gap(&end) < NEAR * drum.radius
}

/// What is said then.
pub(super) fn message(t: f64) -> String {
    format!(
        "at t = {t:.6} s the cable's far end has come to the winch's drum, nearer than {NEAR} of its radius: all of the cable is reeled in. \
         Expected a set-point that leaves some of it out, or a longer cable"
    )
}
