//! What stands still in the drawing, read from the FMU's parameters.

use crate::error::Result;
use crate::host::{Fmu, Instance};
use serde::Serialize;

/// A winch drum or sheave, ship axes with z up.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Wheel {
    pub name: String,
    /// m.
    pub position: [f64; 3],
    pub axis: [f64; 3],
    /// m.
    pub radius: f64,
    /// Sense about the axis in which the cable leaves the drum; 0 for sheaves, which it only passes.
    pub direction: f64,
}

/// The scene's fixed numbers, in frames with z up.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// Still water surface, m.
    pub waterline: Option<f64>,
    pub drum: Option<Wheel>,
    /// Ship axes, m.
    pub anchor: Option<[f64; 3]>,
    pub sheaves: Vec<Wheel>,
    /// The FMU's inertial and ship frames have z down.
    pub ned: bool,
}

/// A vector of the FMU in frames with z up.
pub fn z_up(ned: bool, [x, y, z]: [f64; 3]) -> [f64; 3] {
    if ned { [x, -y, -z] } else { [x, y, z] }
}

impl Scene {
    /// Reads an initialized instance, so that parameters that were set count.
    ///
    /// # Errors
    /// The FMU's own.
    pub fn of(fmu: &Fmu, instance: &Instance) -> Result<Self> {
        // The choice of frame is no FMI variable; the scene file in the archive has it.
        let file = fmu.resource("scene.toml").and_then(|text| text.parse::<toml::Table>().ok()).unwrap_or_default();
        let ned = file.get("ship").and_then(|ship| ship.get("frame")).and_then(toml::Value::as_str) == Some("ned");
        let sheave_name = |i: usize| {
            let name = file.get("sheave").and_then(|list| list.get(i)).and_then(|sheave| sheave.get("name")).and_then(toml::Value::as_str);
            name.map_or_else(|| format!("sheave {}", i + 1), |name| format!("sheave {name}"))
        };
        let get = |name: &str| instance.description.variable(name).ok().map(|variable| instance.read(variable)).transpose();
        let vector = |name: &str| -> Result<Option<[f64; 3]>> {
            let read = |i: usize| get(&format!("{name}[{i}]"));
            Ok(match (read(1)?, read(2)?, read(3)?) {
                (Some(x), Some(y), Some(z)) => Some(z_up(ned, [x, y, z])),
                _ => None,
            })
        };
        let wheel = |key: &str, name: String| -> Result<Option<Wheel>> {
            let direction = get(&format!("{key}.direction"))?.unwrap_or(0.0);
            Ok(match (vector(&format!("{key}.position"))?, vector(&format!("{key}.axis"))?, get(&format!("{key}.radius"))?) {
                (Some(position), Some(axis), Some(radius)) => Some(Wheel { name, position, axis, radius, direction }),
                _ => None,
            })
        };
        let mut sheaves = Vec::new();
        while let Some(sheave) = wheel(&format!("sheave[{}]", sheaves.len() + 1), sheave_name(sheaves.len()))? {
            sheaves.push(sheave);
        }
        Ok(Self {
            waterline: get("fluid.waterline")?.map(|z| z_up(ned, [0.0, 0.0, z])[2]),
            drum: wheel("winch", "winch".to_owned())?,
            anchor: vector("anchor.position")?,
            sheaves,
            ned,
        })
    }
}
