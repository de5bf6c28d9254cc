//! The ship's pose between communication points, with continuous velocity and acceleration, and its rigid-body kinematics.
//!
//! Inputs arrive only at communication points. For each of the six channels the signal of the highest derivative known (pose, velocity or
//! acceleration) is extrapolated by the parabola through its last three samples and integrated up: that is the prediction P. What the cable
//! has seen so far (x, ẋ, ẍ at the step's begin) differs from P a little; the difference dies out along a quintic over one sample interval.
//! So the motion that the cable sees has continuous velocity and acceleration, no delay, and meets the samples within the extrapolation's error:
//! O(h³) of the pose's third derivative when only the pose is known, O(h⁴) and O(h⁵) with velocity and acceleration.

mod pose;

pub use pose::{Frame, ShipDrive};
