//! Fingerprints the sources that decide what a model does, and keeps the library mapped once it is loaded.

use model_description::guid::Fnv;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// Folders and files that a model's behaviour and description come from.
const SOURCES: [&str; 3] = ["src", "modelDescription/src", "modelDescription/scenes"];

fn main() -> io::Result<()> {
    let mut files = Vec::new();
    for folder in SOURCES {
        println!("cargo::rerun-if-changed={folder}");
        collect(Path::new(folder), &mut files)?;
    }
    files.sort();
    let version = env::var("CARGO_PKG_VERSION").unwrap_or_default();
    let mut hash = Fnv::default().part(version.as_bytes());
    for file in files {
        // Line ends and separators of the checkout must not matter.
        let name = file.iter().map(|part| part.to_string_lossy()).collect::<Vec<_>>().join("/");
        let text = fs::read_to_string(&file)?.replace("\r\n", "\n");
        hash = hash.part(name.as_bytes()).part(text.as_bytes());
    }
    println!("cargo::rustc-env=FAIRLEAD_FINGERPRINT={version}-{}", hash.hex());

    // Importers may unload the library under live instances and load it again; it then has to stay where it was.
    if env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "linux") {
        println!("cargo::rustc-cdylib-link-arg=-Wl,-z,nodelete");
    }
    Ok(())
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            collect(&path, files)?;
        } else if path.extension().is_some_and(|e| e == "rs" || e == "toml") {
            files.push(path);
        }
    }
    Ok(())
}
