//! The licences of fairlead and of every crate that is compiled into its library.

use crate::error::{Failure, Result, at};
use crate::package::root;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// How the files begin that hold a licence, and those that have to go with it.
const NAMES: [&str; 5] = ["LICENSE", "LICENCE", "COPYING", "NOTICE", "UNLICENSE"];

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    version: String,
    license: Option<String>,
    repository: Option<String>,
    manifest_path: PathBuf,
    /// Nothing for the workspace's own.
    source: Option<String>,
}

/// Files under `documentation/licenses`: name, text. The same for equal Cargo.lock files.
///
/// # Errors
/// Cargo does not answer, or a crate has no licence.
pub fn all() -> Result<Vec<(String, String)>> {
    Ok(vec![("license.txt".into(), own()?), ("third-party.txt".into(), third_party()?)])
}

fn own() -> Result<String> {
    let mut text = String::from("fairlead is licensed under either of the Apache License 2.0 or the MIT license, at your option.\n");
    text += "What it is compiled from besides has its own licenses; they are in third-party.txt.\n";
    for file in ["LICENSE-MIT", "LICENSE-APACHE"] {
        let path = root().join(file);
        text += &format!("\n{}\n\n{}", "=".repeat(72), fs::read_to_string(&path).map_err(|e| at(&path, e))?);
    }
    Ok(text)
}

/// Each text once, under all the crates that have it to the letter.
fn third_party() -> Result<String> {
    let wanted = compiled_in()?;
    let metadata: Metadata =
        serde_json::from_str(&cargo(&["metadata", "--format-version", "1"])?).map_err(|e| Failure(format!("cargo metadata: {e}")))?;
    let mut crates = BTreeSet::new();
    let mut texts: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for package in metadata.packages.iter().filter(|p| p.source.is_some()) {
        let name = format!("{} {}", package.name, package.version);
        if !wanted.contains(&name) {
            continue;
        }
        let license = package.license.as_deref().ok_or_else(|| at(&package.manifest_path, "says no license"))?;
        crates.insert(format!("{name}: {license}; {}", package.repository.as_deref().unwrap_or("no repository given")));
        for text in texts_beside(&package.manifest_path)? {
            texts.entry(text).or_default().insert(name.clone());
        }
    }
    if crates.len() != wanted.len() {
        return Err(Failure(format!("cargo metadata describes {} of the {} crates of the library", crates.len(), wanted.len())));
    }
    let line = "=".repeat(72);
    let list = crates.into_iter().collect::<Vec<_>>().join("\n");
    let mut page =
        format!("The library is compiled from fairlead, Rust's standard library (MIT OR Apache-2.0) and these crates:\n\n{list}\n");
    let mut texts: Vec<_> = texts.into_iter().map(|(text, names)| (names.into_iter().collect::<Vec<_>>().join(", "), text)).collect();
    texts.sort();
    for (names, text) in texts {
        page += &format!("\n{line}\n{names}\n{line}\n\n{}\n", text.trim_end());
    }
    Ok(page)
}

/// "name version" of every crate whose code is in the library, on any platform; not those that only run while it is built.
fn compiled_in() -> Result<BTreeSet<String>> {
    let tree = ["tree", "--package", "fairlead", "--edges", "normal,no-proc-macro", "--target", "all", "--prefix", "none"];
    let text = cargo(&[&tree[..], &["--format", "{p}"]].concat())?;
    let word = |line: &str| {
        let mut words = line.split_whitespace();
        let (name, version) = (words.next()?, words.next()?.strip_prefix('v')?);
        // Crates of this workspace have their folder behind.
        let local = words.next().is_some_and(|rest| rest.starts_with('(') && rest != "(*)");
        (!local).then(|| format!("{name} {version}"))
    };
    Ok(text.lines().filter_map(word).collect())
}

fn texts_beside(manifest: &Path) -> Result<Vec<String>> {
    let folder = manifest.parent().unwrap_or(Path::new("."));
    let mut files: Vec<_> = fs::read_dir(folder).map_err(|e| at(folder, e))?.flatten().map(|entry| entry.path()).collect();
    files.sort();
    files.retain(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_uppercase();
        path.is_file() && NAMES.iter().any(|begin| name.starts_with(begin))
    });
    let read = |path: &PathBuf| fs::read_to_string(path).map(|text| text.replace("\r\n", "\n")).map_err(|e| at(path, e));
    files.iter().map(read).collect()
}

fn cargo(arguments: &[&str]) -> Result<String> {
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    let done = cargo.current_dir(root()).args(arguments).output().map_err(|e| Failure(format!("cargo cannot be started: {e}")))?;
    if !done.status.success() {
        return Err(Failure(format!("cargo {}: {}", arguments[0], String::from_utf8_lossy(&done.stderr).trim())));
    }
    String::from_utf8(done.stdout).map_err(|_| Failure(format!("cargo {}: no UTF-8 text", arguments[0])))
}
