//! Small mathematics that several rooms share.

pub mod interpolation;
pub mod jet;
pub mod lanes;
pub mod quadrature;
