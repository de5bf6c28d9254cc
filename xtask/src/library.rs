//! Builds the library, for this machine as it is or for others of its kind and age.

use crate::binary::{Needs, inspect};
use crate::error::{Failure, Result, at};
use crate::package::{root, target_folder};
use crate::platform::{self, GLIBC, Platform};
use crate::toolchain::Toolchain;
use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::Path;
use std::process::{Command, Stdio};
use std::{env, fs};

/// Alone: together with the rlib it would silently lose link-time optimization.
const ARGUMENTS: [&str; 7] = ["--quiet", "--lib", "--release", "--crate-type", "cdylib", "--package", "fairlead"];
const STRIP: [&str; 3] = ["--", "-C", "strip=symbols"];

/// A library that can go into an FMU.
pub struct Library {
    /// FMI's name of its platform.
    pub folder: String,
    /// How its file name ends.
    pub suffix: &'static str,
    /// The file.
    pub bytes: Vec<u8>,
    /// What it asks of the system.
    pub needs: Needs,
}

impl Library {
    /// For this machine, with its own linker: quickly built, but not for systems older than this one.
    ///
    /// # Errors
    /// A failed build, or a library that an importer would complain about.
    pub fn plain() -> Result<Self> {
        let target = target_folder();
        let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.current_dir(root()).env_remove("CARGO_BUILD_TARGET").arg("rustc").args(ARGUMENTS);
        build(cargo.arg("--target-dir").arg(&target).args(STRIP))?;
        let path = target.join("release").join(format!("{DLL_PREFIX}fairlead{DLL_SUFFIX}"));
        let library = Self::read(&path, platform::folder(), DLL_SUFFIX)?;
        Ok(library)
    }

    /// For any system of a kind, GLIBC's included that are ten years old.
    ///
    /// # Errors
    /// The tools for it are not here (says which), a failed build, or a library that would not load everywhere.
    pub fn portable(platform: &Platform) -> Result<Self> {
        let toolchain = Toolchain::find(platform)?;
        let target = target_folder().join(toolchain.folder());
        let mut cargo = toolchain.cargo(platform)?;
        build(cargo.current_dir(root()).args(ARGUMENTS).arg("--target-dir").arg(&target).args(STRIP))?;
        let path = target.join(platform.target).join("release").join(platform.cargo_library());
        let library = Self::read(&path, platform.folder.into(), platform.suffix)?;
        if platform.has_glibc() && (library.needs.glibc > Some(GLIBC) || library.needs.libraries.contains("libgcc_s.so.1")) {
            return Err(at(&path, format!("needs {}; expected no more than GLIBC {}.{}", library.needs, GLIBC.0, GLIBC.1)));
        }
        Ok(library)
    }

    fn read(path: &Path, folder: String, suffix: &'static str) -> Result<Self> {
        let bytes = fs::read(path).map_err(|e| at(path, e))?;
        let (needs, problems) = inspect(&bytes).map_err(|e| at(path, e))?;
        match problems.as_slice() {
            [] => Ok(Self { folder, suffix, bytes, needs }),
            problems => Err(Failure(problems.iter().map(|p| at(path, p).0).collect::<Vec<_>>().join("\n"))),
        }
    }
}

fn build(cargo: &mut Command) -> Result<()> {
    let status = cargo.stdout(Stdio::null()).status().map_err(|e| Failure(format!("cargo cannot be started: {e}")))?;
    if status.success() { Ok(()) } else { Err(Failure("the library did not build; cargo's messages are above".into())) }
}
