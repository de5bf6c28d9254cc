//! The C interface: the 34 functions of FMI 2.0 co-simulation. The only room with unsafe code.
//!
//! Every exported function is a few lines around [`guard`], which checks the instance and its state, catches panics and turns
//! what went wrong into a status and a log message. Instances share nothing; there is no mutable global state.

#![allow(unsafe_code)]

pub mod abi;
mod derivatives;
pub mod exports;
mod function;
mod guard;
mod instance;
mod logging;
mod panics;
mod pointers;
mod snapshot;
mod states;
mod table;
mod trouble;
pub mod uri;

pub use logging::Category;
