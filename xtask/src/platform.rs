//! What differs from platform to platform.

use std::env::consts::{ARCH, DLL_SUFFIX, OS};

/// The newest GLIBC that a portable Linux binary may ask for, as (major, minor): RHEL 7's.
pub const GLIBC: (u32, u32) = (2, 17);

/// A platform that an FMU can have a binary for, whatever machine packs it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Platform {
    /// FMI's name of the folder under `binaries/`.
    pub folder: &'static str,
    /// Rust's name.
    pub target: &'static str,
    /// How the library's file name ends.
    pub suffix: &'static str,
    /// What cargo puts before the library's name.
    prefix: &'static str,
}

/// All that `--platform` knows.
pub const PLATFORMS: [Platform; 3] = [
    Platform { folder: "linux64", target: "x86_64-unknown-linux-gnu", suffix: ".so", prefix: "lib" },
    Platform { folder: "win64", target: "x86_64-pc-windows-gnu", suffix: ".dll", prefix: "" },
    Platform { folder: "aarch64-linux", target: "aarch64-unknown-linux-gnu", suffix: ".so", prefix: "lib" },
];

impl Platform {
    /// The platform with this folder name, for the command line.
    ///
    /// # Errors
    /// Lists the known ones.
    pub fn named(name: &str) -> Result<Self, String> {
        let known = || PLATFORMS.map(|p| p.folder).join(", ");
        PLATFORMS.into_iter().find(|p| p.folder == name).ok_or_else(|| format!("expected one of {}", known()))
    }

    /// File name of the library as cargo builds it.
    pub fn cargo_library(&self) -> String {
        format!("{}fairlead{}", self.prefix, self.suffix)
    }

    /// Whether it has GLIBC, whose versions decide on how old a system the library loads.
    pub fn has_glibc(&self) -> bool {
        self.target.ends_with("-linux-gnu")
    }
}

/// FMI's name of the folder under `binaries/` for this machine.
pub fn folder() -> String {
    match (ARCH, OS) {
        ("x86_64", "linux") => "linux64".into(),
        ("x86_64", "windows") => "win64".into(),
        ("x86_64", "macos") => "darwin64".into(),
        (arch, "macos") => format!("{arch}-darwin"),
        (arch, os) => format!("{arch}-{os}"),
    }
}

/// Path of this machine's library in the FMU.
pub fn fmu_library(model_identifier: &str) -> String {
    library_in(&folder(), model_identifier, DLL_SUFFIX)
}

/// Path of a library in the FMU.
pub fn library_in(folder: &str, model_identifier: &str, suffix: &str) -> String {
    format!("binaries/{folder}/{model_identifier}{suffix}")
}
