//! `cargo xtask package`

use crate::attachments::attachments;
use crate::binary::Needs;
use crate::companions;
use crate::error::{Failure, Result, at};
use crate::library::Library;
use crate::platform::{self, GLIBC, Platform};
use crate::scene_pages;
use fairlead::scene::best_match;
use fairlead::variables::Model;
use model_description::scenes::{SCENES, named};
use model_description::{Document, html, xml};
use std::io::{Seek, Write};
use std::path::{Path, PathBuf};
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
    /// Put libraries for these platforms in, each for old systems too: linux64, win64, aarch64-linux, separated by commas. Without
    /// it there is one library, for this machine and others as new.
    #[arg(long, value_delimiter = ',', value_parser = Platform::named)]
    platform: Vec<Platform>,
}

/// Packs, says what each library needs, and prints the path.
pub fn run(args: Args) -> Result<()> {
    let (model, out) = plan(&args.scene, args.out.as_deref())?;
    let packer = Packer::with(&args.platform)?;
    packer.write(&model, &out)?;
    for library in &packer.libraries {
        println!("{}: needs {}", library.folder, library.needs);
        if args.platform.is_empty() && library.needs.glibc > Some(GLIBC) {
            println!("for systems older than this one pack with --platform {}", library.folder);
        }
    }
    let osp = if args.osp { companions::write_osp(&model, &out)? } else { Vec::new() };
    let ssp = if args.ssp { companions::write_ssp(&model, &out)? } else { Vec::new() };
    osp.iter().chain(&ssp).for_each(|file| println!("{}", file.display()));
    println!("{}", out.display());
    Ok(())
}

/// Packs a scene, given as on the command line, and returns the FMU's path.
///
/// # Errors
/// An unknown or wrong scene, a failed build, a file that cannot be read or written.
pub fn package(scene: &str, out: Option<&Path>) -> Result<PathBuf> {
    let (model, out) = plan(scene, out)?;
    Packer::new()?.write(&model, &out)?;
    Ok(out)
}

/// What to pack, and where to.
fn plan(scene: &str, out: Option<&Path>) -> Result<(Model, PathBuf)> {
    let model = model(scene)?;
    let name = &model.initial_scene.name;
    let out = out.map_or_else(|| target_folder().join("fmu").join(format!("{name}.fmu")), Path::to_path_buf);
    if out.is_dir() {
        return Err(at(&out, "is a folder; expected the FMU's file name after --out"));
    }
    Ok((model, out))
}

/// The libraries, built once for many FMUs.
pub struct Packer {
    libraries: Vec<Library>,
}

impl Packer {
    /// Builds the library for this machine.
    ///
    /// # Errors
    /// A failed build.
    pub fn new() -> Result<Self> {
        Self::with(&[])
    }

    /// Builds portable libraries for these platforms; for none, the one for this machine.
    ///
    /// # Errors
    /// Tools that are missing, or a failed build.
    pub fn with(platforms: &[Platform]) -> Result<Self> {
        let libraries = match platforms {
            [] => vec![Library::plain()?],
            some => some.iter().map(Library::portable).collect::<Result<_>>()?,
        };
        Ok(Self { libraries })
    }

    /// What each library asks of its system, with FMI's name of the platform.
    pub fn needs(&self) -> impl Iterator<Item = (&str, &Needs)> {
        self.libraries.iter().map(|library| (library.folder.as_str(), &library.needs))
    }

    /// Writes the FMU of a model.
    ///
    /// # Errors
    /// A file that cannot be read or written.
    pub fn write(&self, model: &Model, out: &Path) -> Result<()> {
        write_archive(out, &contents(model, &self.libraries)?)
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

/// Paths in the archive, with forward slashes, and bytes.
pub type Contents = Vec<(String, Vec<u8>)>;

fn contents(model: &Model, libraries: &[Library]) -> Result<Contents> {
    let picture = picture(model);
    let document = Document { picture: picture.as_ref().map(|_| PICTURE), ..model.document() };
    let description = xml::model_description(&document).map_err(|e| Failure(format!("modelDescription.xml: {e}")))?;
    let mut contents =
        vec![("modelDescription.xml".to_owned(), description), ("documentation/index.html".to_owned(), html::page(&document).into_bytes())];
    contents.extend(picture.map(|svg| (format!("documentation/{PICTURE}"), svg)));
    contents.extend(attachments(&document)?);
    let path = |library: &Library| platform::library_in(&library.folder, document.name, library.suffix);
    contents.extend(libraries.iter().map(|library| (path(library), library.bytes.clone())));
    contents.extend(model.resources().into_iter().map(|(path, text)| (format!("resources/{path}"), text.into())));
    Ok(contents)
}

/// Name of the start shape's picture beside the documentation's page.
const PICTURE: &str = "start.svg";

/// The picture of a built-in scene's start shape, if it has been drawn (`cargo xtask scenes --pages`).
fn picture(model: &Model) -> Option<Vec<u8>> {
    let text = model.resources().first().map(|(_, text)| *text)?;
    let scene = SCENES.iter().find(|s| s.text == text)?;
    fs::read(scene_pages::folder().join(format!("{}.svg", scene.name))).ok()
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
