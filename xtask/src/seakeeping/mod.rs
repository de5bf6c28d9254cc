//! An irregular long-crested sea and a ship's linear response to it.
//!
//! # Conventions
//!
//! Axes: x forward, y to port, z up, fixed to the ship's mean position, which itself advances with the forward speed U.
//! Heading β is the angle from the ship's x axis to the direction in which the waves *travel*: 180° is head seas, 0° following
//! seas, 90° waves travelling to port (they meet the starboard side first). A component of circular frequency ω raises the
//! surface by
//!
//! ```text
//! ζ(x, y, t) = a cos(ω_e t − k (x cos β + y sin β) + ε),    k = ω²/g (deep water),    ω_e = ω − k U cos β
//! ```
//!
//! and a response of amplitude H and phase φ to it is the motion `a H cos(ω_e t + ε + φ)`. Angles are the z-y-x (yaw, pitch,
//! roll) angles of interface.md: with z up, positive pitch is bow *down* and positive roll is port side *up*.

pub mod motion;
pub mod rao;
pub mod spectrum;
