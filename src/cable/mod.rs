//! The gradient-deficient ANCF cable element: shape functions and the section's laws.
//! Knows neither water nor sheaves.

pub mod section;
pub mod shape;
