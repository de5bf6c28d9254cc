//! `cargo xtask package`

use crate::attachments::attachments;
use crate::companions;
use crate::error::{Failure, Result, at};
use crate::platform;
use fairlead::scene::best_match;
use fairlead::variables::Model;
use model_description::scenes::{SCENES, named};
use model_description::{html, xml};
use std::io::{Seek, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::{env, fs};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Packs a scene as an FMU, target/fmu/NAME.fmu; prints its path last.
#[derive(clap::Args)]
pub struct Args {
    /// A built-in scene's name (see `cargo xtask scenes`) or the path of a scene file.
    scene: String,
    /// Where to write the FMU.
    #[arg(long)]
    out: Option<PathBuf>,
    /// Write NAME_OspModelDescription.xml and an example NAME_OspSystemStructure.xml for libcosim beside the FMU.
    #[arg(long)]
    osp: bool,
    /// Write a parameter set NAME.ssv and an example system NAME.ssp beside the FMU.
    #[arg(long)]
    ssp: bool,
}

/// Packs and prints the path.
pub fn run(args: Args) -> Result<()> {
    let path = package(&args.scene, args.out.as_deref())?;
    if args.osp || args.ssp {
        let model = model(&args.scene)?;
        let osp = if args.osp { companions::write_osp(&model, &path)? } else { Vec::new() };
        let ssp = if args.ssp { companions::write_ssp(&model, &path)? } else { Vec::new() };
        osp.iter().chain(&ssp).for_each(|file| println!("{}", file.display()));
    }
    println!("{}", path.display());
    Ok(())
}

/// Packs a scene, given as on the command line, and returns the FMU's path.
///
/// # Errors
/// An unknown or wrong scene, a failed build, a file that cannot be read or written.
pub fn package(scene: &str, out: Option<&Path>) -> Result<PathBuf> {
    let model = model(scene)?;
    let name = &model.initial_scene.name;
    let out = out.map_or_else(|| target_folder().join("fmu").join(format!("{name}.fmu")), Path::to_path_buf);
    if out.is_dir() {
        return Err(at(&out, "is a folder; expected the FMU's file name after --out"));
    }
    Packer::new()?.write(&model, &out)?;
    Ok(out)
}

/// The library, built once for many FMUs.
pub struct Packer {
    library: Vec<u8>,
}

impl Packer {
    /// Builds the library.
    ///
    /// # Errors
    /// A failed build.
    pub fn new() -> Result<Self> {
        let library = build_library()?;
        Ok(Self { library: fs::read(&library).map_err(|e| at(&library, e))? })
    }

    /// Writes the FMU of a model.
    ///
    /// # Errors
    /// A file that cannot be read or written.
    pub fn write(&self, model: &Model, out: &Path) -> Result<()> {
        write_archive(out, &contents(model, &self.library)?)
    }
}

/// The model of a scene, given as on the command line.
///
/// # Errors
/// Neither a built-in scene nor a file, or a wrong scene.
pub fn model(scene: &str) -> Result<Model> {
    if let Some(built_in) = named(scene) {
        return Ok(Model::built_in(built_in)?);
    }
    let path = Path::new(scene);
    if path.is_file() {
        return Ok(Model::read(path)?);
    }
    let names: Vec<_> = SCENES.iter().map(|s| s.name).collect();
    let hint = best_match(scene, names.iter().copied()).map_or(String::new(), |m| format!("; did you mean {m}?"));
    Err(Failure(format!("{scene}: neither a file nor a built-in scene{hint}; built-in scenes: {}", names.join(", "))))
}

/// The repository's root.
pub fn root() -> PathBuf {
    // Cargo tells where the package lies now; the path at build time serves when the tool is run by hand.
    let xtask = env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")), PathBuf::from);
    xtask.parent().map_or_else(|| PathBuf::from("."), Path::to_path_buf)
}

/// Where cargo builds, and where the commands leave what they make.
pub fn target_folder() -> PathBuf {
    env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), |folder| root().join(folder))
}

/// Builds the library alone: together with the rlib it would silently lose link-time optimization.
fn build_library() -> Result<PathBuf> {
    let target = target_folder();
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(root()).env_remove("CARGO_BUILD_TARGET").arg("rustc");
    cargo.args(["--quiet", "--lib", "--release", "--crate-type", "cdylib", "--package", "fairlead", "--target-dir"]).arg(&target);
    cargo.args(["--", "-C", "strip=symbols"]).stdout(Stdio::null());
    let status = cargo.status().map_err(|e| Failure(format!("cargo cannot be started: {e}")))?;
    if !status.success() {
        return Err(Failure("the library did not build; cargo's messages are above".into()));
    }
    Ok(target.join("release").join(platform::cargo_library()))
}

/// Paths in the archive, with forward slashes, and bytes.
pub type Contents = Vec<(String, Vec<u8>)>;

fn contents(model: &Model, library: &[u8]) -> Result<Contents> {
    let document = model.document();
    let description = xml::model_description(&document).map_err(|e| Failure(format!("modelDescription.xml: {e}")))?;
    let mut contents = vec![
        ("modelDescription.xml".to_owned(), description),
        (platform::fmu_library(document.name), library.to_vec()),
        ("documentation/index.html".to_owned(), html::page(&document).into_bytes()),
    ];
    contents.extend(attachments(&document)?);
    contents.extend(model.resources().into_iter().map(|(path, text)| (format!("resources/{path}"), text.into())));
    Ok(contents)
}

/// Writes beside the goal and renames, so that there is never half an archive.
///
/// # Errors
/// A file that cannot be written.
pub fn write_archive(path: &Path, contents: &Contents) -> Result<()> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::create_dir_all(folder).map_err(|e| at(folder, e))?;
    let mut file = tempfile::Builder::new().prefix(".packing-").tempfile_in(folder).map_err(|e| at(folder, e))?;
    zip_into(file.as_file_mut(), contents).map_err(|e| at(path, e))?;
    make_readable(file.path()).map_err(|e| at(path, e))?;
    file.persist(path).map_err(|e| at(path, e.error))?;
    Ok(())
}

/// Temporary files are private to their owner; an FMU is not.
#[cfg(unix)]
fn make_readable(path: &Path) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    fs::set_permissions(path, fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn make_readable(_path: &Path) -> std::io::Result<()> {
    Ok(())
}

/// Deflate, version 2.0, and the same date in every entry: equal contents give equal bytes.
fn zip_into(file: impl Write + Seek, contents: &Contents) -> zip::result::ZipResult<()> {
    let mut zip = ZipWriter::new(file);
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated).last_modified_time(DateTime::default());
    for (path, bytes) in contents {
        let mode = if path.starts_with("binaries/") { 0o755 } else { 0o644 };
        zip.start_file(path.as_str(), options.unix_permissions(mode))?;
        zip.write_all(bytes)?;
    }
    zip.finish()?.flush()?;
    Ok(())
}
