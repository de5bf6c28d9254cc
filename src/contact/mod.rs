//! Line contact with surfaces that turn about an axis of the ship: winch drums, plain and grooved sheaves. Knows no cable elements: cubic
//! curves and points go in, arcs in contact and forces per length come out, in the surface's own axes (along its axis, "up", "side").

pub mod arcs;
pub mod hunt_crossley;
pub mod surface;
