//! Small mathematics that several rooms share.

pub mod chebyshev2;
pub mod dispatch;
pub mod interpolation;
pub mod jet;
pub mod lanes;
pub mod quadrature;
pub mod ring;
pub mod transpose;
