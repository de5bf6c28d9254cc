//! Line contact with surfaces that turn about an axis of the ship. Knows no cable elements: a point goes in, a force per length comes out.

pub mod drum;
pub mod hunt_crossley;
