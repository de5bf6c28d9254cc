//! What differs from platform to platform.

use std::env::consts::{ARCH, DLL_PREFIX, DLL_SUFFIX, OS};

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

/// File name of the library as cargo builds it.
pub fn cargo_library() -> String {
    format!("{DLL_PREFIX}fairlead{DLL_SUFFIX}")
}

/// Path of the library in the FMU.
pub fn fmu_library(model_identifier: &str) -> String {
    format!("binaries/{}/{model_identifier}{DLL_SUFFIX}", folder())
}
