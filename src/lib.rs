//! fairlead: cables over winches and sheaves, as an FMI 2.0 co-simulation FMU.

pub mod cable;
pub mod contact;
pub mod equilibrium;
pub mod fmi;
pub mod hydro;
pub mod integrator;
pub mod ledger;
pub mod linalg;
pub mod math;
pub mod mesh;
pub mod outputs;
pub mod scene;
pub mod ship;
pub mod sim;
pub mod system;
pub mod variables;
pub mod winch;
