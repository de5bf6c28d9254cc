//! What a run tells a naval engineer: a page of loads and detachments, and an animation.

mod animation;
mod episodes;
mod loads;
mod rainflow;
mod scene;

use crate::error::{Result, at};
use crate::results::replace;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

pub use animation::html as animation;
pub use scene::Scene;

/// The ship's pose, as the FMU's inputs name it.
pub const POSE: [&str; 6] = ["ship.x", "ship.y", "ship.z", "ship.roll", "ship.pitch", "ship.yaw"];

/// A run: one value a row for every output with a number and for the ship's pose.
pub struct Record {
    /// The FMU's name.
    pub title: String,
    /// The start and every communication point, s.
    pub times: Vec<f64>,
    /// By the FMU's names, in its units and frames.
    pub columns: BTreeMap<String, Vec<f64>>,
    pub scene: Scene,
    /// Why the run ended early.
    pub failure: Option<String>,
}

impl Record {
    pub fn has(&self, name: &str) -> bool {
        self.columns.contains_key(name)
    }

    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.columns.get(name).map(Vec::as_slice)
    }

    /// `sheave[i].what`, i from 0.
    pub fn of_sheave(&self, i: usize, what: &str) -> Option<&[f64]> {
        self.column(&format!("sheave[{}].{what}", i + 1))
    }

    /// Names of tensions: first those at the cable's ends, then those at the sheaves, then the cable's extremes.
    pub fn tensions(&self) -> Vec<&str> {
        let rank = |name: &str| match name {
            "winch.tension" | "anchor.tension" => 0,
            "body.tension" | "load.tension" => 1,
            name if name.starts_with("sheave[") => 2,
            _ => 3,
        };
        let mut names: Vec<_> = self.columns.keys().map(String::as_str).filter(|name| name.contains(".tension")).collect();
        names.sort_by_key(|name| rank(name));
        names
    }
}

/// Writes `index.html` and, where the FMU has points of the cable, `animation.html` into a folder, which may hold other files.
///
/// # Errors
/// A folder that cannot be written.
pub fn write(record: &Record, folder: &Path) -> Result<()> {
    let animation = animation(record);
    fs::create_dir_all(folder).map_err(|e| at(folder, format!("cannot be made: {e}")))?;
    animation.iter().try_for_each(|html| replace(&folder.join("animation.html"), html))?;
    replace(&folder.join("index.html"), &loads::html(record, animation.is_some()))
}
