//! `cargo xtask scenes`

use crate::error::Result;
use fairlead::variables::Model;
use model_description::scenes::SCENES;

/// Lists the built-in scenes, one line each.
#[derive(clap::Args)]
pub struct Args {}

/// Prints name and description of each.
pub fn run(_args: Args) -> Result<()> {
    let width = SCENES.iter().map(|s| s.name.len()).max().unwrap_or(0);
    for scene in SCENES {
        let model = Model::built_in(scene)?;
        println!("{:width$}  {}", scene.name, model.initial_scene.description);
    }
    Ok(())
}
