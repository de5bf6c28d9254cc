//! Finds what can build for another platform: a Rust that has the platform's standard library or its sources, and a linker.

use crate::error::{Failure, Result};
use crate::package::{root, target_folder};
use crate::platform::{GLIBC, Platform};
use crate::python;
use std::env;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A Rust for one platform.
#[derive(Debug)]
pub struct Toolchain {
    cargo: PathBuf,
    rustc: PathBuf,
    /// The standard library has to be built too.
    build_std: bool,
}

impl Toolchain {
    /// The Rust that runs this command if it can build for the platform, else the system's.
    ///
    /// # Errors
    /// Says what is missing and how to get it.
    pub fn find(platform: &Platform) -> Result<Self> {
        let own = |name: &str, fallback: &str| PathBuf::from(env::var_os(name).unwrap_or_else(|| fallback.into()));
        Self::among([(own("CARGO", "cargo"), own("RUSTC", "rustc")), ("/usr/bin/cargo".into(), "/usr/bin/rustc".into())], platform)
    }

    fn among(candidates: impl IntoIterator<Item = (PathBuf, PathBuf)>, platform: &Platform) -> Result<Self> {
        for (cargo, rustc) in candidates {
            if has_std(&rustc, platform) {
                return Ok(Self { cargo, rustc, build_std: false });
            }
            if has_sources(&rustc) {
                return Ok(Self { cargo, rustc, build_std: true });
            }
        }
        Err(Failure(format!(
            "{}: this Rust has no standard library for {}; expected it (rustup target add {}) or its sources (rustup component add \
             rust-src; Debian: apt install cargo-web rustc-web rust-web-src)",
            platform.folder, platform.target, platform.target
        )))
    }

    /// Where it builds, under the target folder; compilers that share a folder would build everything anew in turn.
    pub fn folder(&self) -> &'static str {
        if self.build_std { "portable-with-std" } else { "portable" }
    }

    /// `cargo rustc` for the platform.
    ///
    /// # Errors
    /// No linker.
    pub fn cargo(&self, platform: &Platform) -> Result<Command> {
        let mut command = if platform.has_glibc() { self.with_zig(platform)? } else { self.with_mingw(platform)? };
        command.env("RUSTC", &self.rustc).env("CARGO_ENCODED_RUSTFLAGS", self.remap().join(OsStr::new("\x1f")));
        command.env_remove("CARGO_BUILD_TARGET").env_remove("RUSTFLAGS");
        if self.build_std {
            // Building std is the nightly compiler's privilege; this is how distributions get it from a stable one.
            command.env("RUSTC_BOOTSTRAP", "1").arg("-Zbuild-std=std,panic_unwind");
        }
        Ok(command)
    }

    /// zig links against GLIBC as old as one likes.
    fn with_zig(&self, platform: &Platform) -> Result<Command> {
        let python = python::environment(&root().join("xtask/zig-requirements.txt"), &target_folder().join("zig"))?;
        let bin = python.parent().unwrap_or(Path::new(".")).to_path_buf();
        // cargo-zigbuild finds zig through the first python3 on the path.
        let others = env::var_os("PATH").unwrap_or_default();
        let path = env::join_paths([bin.clone()].into_iter().chain(env::split_paths(&others)))
            .map_err(|e| Failure(format!("{}: {e}", bin.display())))?;
        let mut command = Command::new(bin.join("cargo-zigbuild"));
        command.env("PATH", path).env("CARGO", &self.cargo).env("CARGO_ZIGBUILD_CACHE_DIR", target_folder().join("zig-cache"));
        command.arg("rustc").arg("--target").arg(format!("{}.{}.{}", platform.target, GLIBC.0, GLIBC.1));
        Ok(command)
    }

    fn with_mingw(&self, platform: &Platform) -> Result<Command> {
        const LINKERS: [&str; 2] = ["x86_64-w64-mingw32-gcc-posix", "x86_64-w64-mingw32-gcc"];
        let linker = LINKERS.into_iter().find(|name| output(Path::new(name), &["--version"]).is_some()).ok_or_else(|| {
            let missing = LINKERS.join(" nor ");
            Failure(format!(
                "{}: neither {missing} can be started (Debian and Ubuntu: apt install gcc-mingw-w64-x86-64-posix)",
                platform.folder
            ))
        })?;
        let mut command = Command::new(&self.cargo);
        command.env("CARGO_TARGET_X86_64_PC_WINDOWS_GNU_LINKER", linker).args(["rustc", "--target", platform.target]);
        Ok(command)
    }

    /// Panic messages name source files. Without the folders of this machine in them the bytes are the same wherever it is built.
    fn remap(&self) -> Vec<OsString> {
        let home = env::var_os("CARGO_HOME").map(PathBuf::from).or_else(|| Some(env::home_dir()?.join(".cargo")));
        // One folder for each registry, named after where it was reached.
        let sources = home.as_ref().and_then(|home| std::fs::read_dir(home.join("registry/src")).ok());
        let registries: Vec<_> = sources.into_iter().flatten().flatten().map(|entry| (Some(entry.path()), "crates")).collect();
        let sysroot = output(&self.rustc, &["--print", "sysroot"]).map(|text| PathBuf::from(text).join("lib/rustlib/src/rust"));
        let folders = [(home, "cargo"), (sysroot, "rust"), (Some(root()), "fairlead")];
        let flag = |(folder, name): (Option<PathBuf>, &str)| {
            let mut flag = OsString::from("--remap-path-prefix=");
            flag.push(folder?);
            flag.push(format!("=/{name}"));
            Some(flag)
        };
        // Of several that fit, rustc takes the last.
        folders.into_iter().chain(registries).filter_map(flag).collect()
    }
}

/// Whether the compiler's own folder has the platform's standard library.
fn has_std(rustc: &Path, platform: &Platform) -> bool {
    let Some(folder) = output(rustc, &["--print", "target-libdir", "--target", platform.target]) else { return false };
    let Ok(files) = std::fs::read_dir(folder) else { return false };
    files.flatten().any(|file| file.file_name().to_string_lossy().starts_with("libstd-"))
}

fn has_sources(rustc: &Path) -> bool {
    let sysroot = output(rustc, &["--print", "sysroot"]);
    sysroot.is_some_and(|sysroot| Path::new(&sysroot).join("lib/rustlib/src/rust/library/Cargo.lock").is_file())
}

/// What a program prints, without the line's end; `None` if it cannot be started or fails.
fn output(program: &Path, arguments: &[&str]) -> Option<String> {
    let done = Command::new(program).args(arguments).stdin(Stdio::null()).output().ok()?;
    done.status.success().then(|| String::from_utf8_lossy(&done.stdout).trim_end().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::platform::PLATFORMS;

    #[test]
    fn exact_a_rust_without_the_platform_is_told_what_it_lacks() {
        let message = Toolchain::among([("no cargo".into(), "no rustc".into())], &PLATFORMS[1]).expect_err("no compiler").to_string();
        for word in ["win64", "rustup target add x86_64-pc-windows-gnu", "rust-src", "apt install"] {
            assert!(message.contains(word), "{word}: {message}");
        }
    }

    #[test]
    fn exact_the_flags_name_folders_that_hold_sources() {
        let toolchain = Toolchain { cargo: "cargo".into(), rustc: "rustc".into(), build_std: false };
        let flags: Vec<String> = toolchain.remap().iter().map(|flag| flag.to_string_lossy().into_owned()).collect();
        assert!(flags.iter().any(|flag| *flag == format!("--remap-path-prefix={}=/fairlead", root().display())), "{flags:?}");
    }
}
