//! A scene: everything a simulation needs to know before it starts.
//!
//! A scene file is text -> tree held against the table of scene keys (`schema`) and against the rules that involve several keys
//! (`rules`), so that every problem is known at once -> [`Scene`], checked and in SI units, z up, which is all that the physics sees.

pub mod file;
mod leaves;
mod model;
mod problem;
mod rules;
mod schema;
mod start_shape;
mod wheels;

pub use leaves::Leaf;
pub use model::*;
pub use problem::{Problem, SceneErrors};
pub use schema::best_match;

#[cfg(test)]
mod tests;
