//! `cargo xtask scenes`

use crate::error::Result;
use crate::scene_pages;
use fairlead::variables::Model;
use model_description::scenes::SCENES;

/// Lists the built-in scenes, one line each.
#[derive(clap::Args)]
pub struct Args {
    /// Write a page for each into modelDescription/pages/scenes instead, with its start shape drawn from the packed FMU
    #[arg(long)]
    pages: bool,
}

/// Prints name and description of each, or writes their pages.
pub fn run(args: Args) -> Result<()> {
    if args.pages {
        return scene_pages::write_all();
    }
    let width = SCENES.iter().map(|s| s.name.len()).max().unwrap_or(0);
    for scene in SCENES {
        let model = Model::built_in(scene)?;
        println!("{:width$}  {}", scene.name, model.initial_scene.description);
    }
    Ok(())
}
