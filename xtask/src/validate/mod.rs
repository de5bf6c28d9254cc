//! `cargo xtask validate`

mod description;

use crate::binary;
use crate::error::{Failure, Result, at};
use crate::platform;
use crate::xml_tree::Element;
use std::fs;
use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};
use zip::{CompressionMethod, ZipArchive};

/// Says what an importer would complain about; exit status 1 if anything.
#[derive(clap::Args)]
pub struct Args {
    /// The FMU.
    fmu: PathBuf,
}

/// Version 2.0 of the zip format: deflate, folders, no zip64.
const ZIP_VERSION: u16 = 20;

/// Lists all problems.
pub fn run(args: Args) -> Result<()> {
    let problems = problems(&args.fmu)?;
    if problems.is_empty() {
        println!("{}: no problems", args.fmu.display());
        return Ok(());
    }
    let lines: Vec<_> = problems.iter().map(|p| format!("{}: {p}", args.fmu.display())).collect();
    Err(Failure(lines.join("\n")))
}

/// Everything wrong with an FMU.
///
/// # Errors
/// The file cannot be read or is no zip archive.
pub fn problems(path: &Path) -> Result<Vec<String>> {
    let bytes = fs::read(path).map_err(|e| at(path, e))?;
    let mut archive = ZipArchive::new(Cursor::new(&bytes)).map_err(|e| at(path, format!("no zip archive, as an FMU has to be: {e}")))?;
    let mut problems = Vec::new();
    entries(&mut archive, &bytes, &mut problems);
    let text = match read(&mut archive, "modelDescription.xml")
        .and_then(|b| String::from_utf8(b).map_err(|_| "modelDescription.xml: no UTF-8 text".into()))
    {
        Ok(text) => text,
        Err(problem) => {
            problems.push(problem);
            return Ok(problems);
        }
    };
    if !text.starts_with("<?xml version=\"1.0\" encoding=\"UTF-8\"") {
        problems.push("modelDescription.xml: it should begin with an XML declaration that says UTF-8".into());
    }
    match Element::parse(&text) {
        Ok(root) => {
            let found = description::problems(&root);
            problems.extend(found.into_iter().map(|p| format!("modelDescription.xml: {p}")));
            if let Some(identifier) = root.child("CoSimulation").and_then(|c| c.get("modelIdentifier")) {
                binaries(&mut archive, identifier, &mut problems);
            }
        }
        Err(e) => problems.push(format!("modelDescription.xml: no well-formed XML: {e}")),
    }
    Ok(problems)
}

type Archive<'a> = ZipArchive<Cursor<&'a Vec<u8>>>;

fn entries(archive: &mut Archive, bytes: &[u8], problems: &mut Vec<String>) {
    for i in 0..archive.len() {
        let entry = match archive.by_index_raw(i) {
            Ok(entry) => entry,
            Err(e) => {
                problems.push(format!("entry {}: {e}", i + 1));
                continue;
            }
        };
        let Ok(name) = entry.name() else {
            problems.push(format!("entry {}: its path is no UTF-8 text", i + 1));
            continue;
        };
        let mut complain = |what: &str| problems.push(format!("{name}: {what}"));
        if name.contains('\\') || name.starts_with('/') || name.split('/').any(|part| part == "..") {
            complain("its path has to be relative, with forward slashes and without ..");
        }
        if entry.encrypted() {
            complain("it is encrypted");
        }
        if entry.is_symlink() {
            complain("it is a link");
        }
        if !matches!(entry.compression(), CompressionMethod::Stored | CompressionMethod::Deflated) {
            complain("it is neither stored nor deflated");
        }
        let version = usize::try_from(entry.header_start()).ok().and_then(|start| bytes.get(start + 4..start + 6));
        if version.is_some_and(|v| u16::from_le_bytes([v[0], v[1]]) > ZIP_VERSION) {
            complain("it needs a later version of zip than 2.0");
        }
    }
}

fn read(archive: &mut Archive, name: &str) -> std::result::Result<Vec<u8>, String> {
    let mut entry = archive.by_name(name).map_err(|_| format!("{name} is missing"))?;
    let mut bytes = Vec::new();
    entry.read_to_end(&mut bytes).map_err(|e| format!("{name}: {e}"))?;
    Ok(bytes)
}

/// The libraries for all platforms; one for this machine has to be there. Nothing of them is run.
fn binaries(archive: &mut Archive, identifier: &str, problems: &mut Vec<String>) {
    let here = platform::fmu_library(identifier);
    let ends = [".so", ".dll", ".dylib"].map(|suffix| format!("/{identifier}{suffix}"));
    let names = archive.file_names().flatten().map(|name| name.into_owned());
    let paths: Vec<String> = names.filter(|n| n.starts_with("binaries/") && ends.iter().any(|end| n.ends_with(end))).collect();
    if !paths.contains(&here) {
        problems.push(format!("{here} is missing: no binary for this platform"));
    }
    for path in paths {
        match read(archive, &path).and_then(|library| binary::inspect(&library).map_err(|e| format!("{path}: {e}"))) {
            Ok((_, found)) => problems.extend(found.into_iter().map(|p| format!("{path}: {p}"))),
            Err(problem) => problems.push(problem),
        }
    }
}

#[cfg(test)]
mod tests;
