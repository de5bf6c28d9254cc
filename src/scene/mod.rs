//! A scene: everything a simulation needs to know before it starts.
//!
//! [`Scene`] is checked and in SI units, z up; the TOML file's own structs live in `file`.

mod model;

pub use model::*;
