//! `cargo xtask report --only hard`: cases that break cable programs, one file a group, all run and judged alike.

mod case;
mod falling;
mod judge;
mod master;
mod momentum;
mod run;
mod sheave;
mod snap;
mod stiffness;
mod water;
mod winch;

use super::bench::Bench;
use super::section::Section;
use crate::error::Result;

/// What makes a section.
type Make = fn(&Bench) -> Result<Section>;

/// What the groups' names begin with.
pub const PREFIX: &str = "hard-";

/// The groups: name for `--only`, and what makes them.
pub const GROUPS: [(&str, Make); 7] = [
    ("hard-snap", snap::section),
    ("hard-sheave", sheave::section),
    ("hard-falling", falling::section),
    ("hard-stiffness", stiffness::section),
    ("hard-water", water::section),
    ("hard-winch", winch::section),
    ("hard-master", master::section),
];

/// Sea water over the whole depth below z = 0, for tables of a scene.
const SEA: &str = "[fluid]\ndensity = 1025\nwaterline = 0\nadded_mass = 1\n\
    drag = { law = \"cross_flow\", cd_normal = 1.2, cd_tangential = 0.01 }\n";

/// Names of a ship's heave, its rate and acceleration as inputs.
const HEAVE: &[&str] = &["ship.z", "ship.vz", "ship.az"];
