//! fairlead: cables over winches and sheaves, as an FMI 2.0 co-simulation FMU.

pub mod fmi;
pub mod outputs;
pub mod scene;
pub mod sim;
pub mod variables;
