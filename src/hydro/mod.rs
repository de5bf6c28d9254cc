//! Water: current, drag, added mass, buoyancy, on a line and on a lump. Knows no cable elements.

pub mod curve;
pub mod line;
pub mod lump;
pub mod surface;
pub mod turbulence;
