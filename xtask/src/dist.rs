//! `cargo xtask dist`: everything that users without Rust need, in one folder.

mod sha256;

use crate::companions;
use crate::error::{Failure, Result, at};
use crate::package::{Packer, root, target_folder};
use crate::platform::Platform;
use fairlead::variables::{Model, VERSION};
use model_description::scenes::SCENES;
use sha256::sha256;
use std::fs;
use std::path::{Path, PathBuf};

/// Gathers the built-in scenes' FMUs, their OSP and SSP files, licences, changes and checksums in target/dist.
#[derive(clap::Args)]
pub struct Args {
    /// Platforms of the FMUs, as for `package`. Without it, this machine's only.
    #[arg(long, value_delimiter = ',', value_parser = Platform::named)]
    platform: Vec<Platform>,
}

/// Files of the repository that go along.
const PAPERS: [&str; 3] = ["CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE"];
/// Drives any of the FMUs.
const EXAMPLE: &str = include_str!("dist/example.py");
const CHECKSUMS: &str = "SHA256SUMS";
const FIRST: &str = "README.txt";

/// Fills a folder of its own and puts it in the place of the old one, so that there is never half a distribution.
///
/// # Errors
/// A failed build, a file that cannot be read or written.
pub fn run(args: Args) -> Result<()> {
    let target = target_folder();
    fs::create_dir_all(&target).map_err(|e| at(&target, e))?;
    let packer = Packer::with(&args.platform)?;
    let staging = tempfile::Builder::new().prefix(".dist-").tempdir_in(&target).map_err(|e| at(&target, e))?;
    let mut scenes = String::new();
    for scene in SCENES {
        let model = Model::built_in(scene)?;
        let fmu = staging.path().join(format!("{}.fmu", scene.name));
        packer.write(&model, &fmu)?;
        companions::write_osp(&model, &fmu)?;
        companions::write_ssp(&model, &fmu)?;
        scenes += &format!("{}\n    {}\n", scene.name, model.initial_scene.description);
        println!("{}", scene.name);
    }
    for name in PAPERS {
        let from = root().join(name);
        fs::copy(&from, staging.path().join(name)).map_err(|e| at(&from, e))?;
    }
    let needs: Vec<_> = packer.needs().map(|(folder, needs)| format!("{folder}: needs {needs}")).collect();
    write(staging.path(), "example.py", EXAMPLE)?;
    write(staging.path(), FIRST, &first_words(&scenes, &needs.join("\n")))?;
    write(staging.path(), CHECKSUMS, &checksums(staging.path())?)?;
    let out = target.join("dist");
    replace(staging, &out)?;
    println!("{}\n{}", needs.join("\n"), out.display());
    Ok(())
}

fn first_words(scenes: &str, needs: &str) -> String {
    format!(
        "fairlead {VERSION}: cables at sea as FMUs (FMI 2.0, co-simulation)\n\n\
         Nothing has to be installed but the program that imports them. For a first look with Python:\n\n\
         \x20   pip install fmpy\n\
         \x20   python example.py flume.fmu\n\n\
         Scenes\n\n{scenes}\n\
         Of each there are here\n\n\
         NAME.fmu                        the unit; it is a zip archive, documentation/index.html in it is its manual\n\
         NAME_OspModelDescription.xml    groups and ports for OSP; libcosim looks for it beside the FMU\n\
         NAME_OspSystemStructure.xml     an example system for libcosim: two cables, one winch following the other\n\
         NAME.ssv                        every number of the scene as an SSP parameter set, to be changed\n\
         NAME.ssp                        the same example system for SSP tools, FMU and numbers in it\n\n\
         Platforms\n\n{needs}\n\n\
         {CHECKSUMS} is for `sha256sum --check {CHECKSUMS}`. Changes are in CHANGELOG.md, licences in LICENSE-MIT and LICENSE-APACHE, and in\n\
         each FMU's documentation/licenses.\n"
    )
}

/// What `sha256sum` would print of all files.
fn checksums(folder: &Path) -> Result<String> {
    let mut lines = String::new();
    for path in files(folder)? {
        let digest = sha256(&fs::read(&path).map_err(|e| at(&path, e))?);
        lines += &format!("{digest}  {}\n", path.file_name().unwrap_or_default().to_string_lossy());
    }
    Ok(lines)
}

fn files(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries = fs::read_dir(folder).map_err(|e| at(folder, e))?;
    let mut paths = entries.map(|entry| entry.map(|e| e.path())).collect::<std::io::Result<Vec<_>>>().map_err(|e| at(folder, e))?;
    paths.sort();
    Ok(paths)
}

fn write(folder: &Path, name: &str, text: &str) -> Result<()> {
    let path = folder.join(name);
    fs::write(&path, text).map_err(|e| at(&path, e))
}

fn replace(staging: tempfile::TempDir, out: &Path) -> Result<()> {
    if out.exists() {
        fs::remove_dir_all(out).map_err(|e| at(out, e))?;
    }
    let staging = staging.keep();
    make_readable(&staging).and_then(|()| fs::rename(&staging, out)).map_err(|e| {
        // The first failure is the one to tell.
        let _ = fs::remove_dir_all(&staging);
        Failure(format!("{}: {e}", out.display()))
    })
}

/// Temporary folders are private to their owner.
#[cfg(unix)]
fn make_readable(folder: &Path) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    fs::set_permissions(folder, fs::Permissions::from_mode(0o755))
}

#[cfg(not(unix))]
fn make_readable(_folder: &Path) -> std::io::Result<()> {
    Ok(())
}
