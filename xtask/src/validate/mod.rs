//! `cargo xtask validate`

mod description;

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

/// The functions of FMI 2.0 that a co-simulation FMU exports.
const EXPORTS: &str = "fmi2GetTypesPlatform fmi2GetVersion fmi2SetDebugLogging fmi2Instantiate fmi2FreeInstance fmi2SetupExperiment \
    fmi2EnterInitializationMode fmi2ExitInitializationMode fmi2Terminate fmi2Reset fmi2GetReal fmi2GetInteger fmi2GetBoolean fmi2GetString \
    fmi2SetReal fmi2SetInteger fmi2SetBoolean fmi2SetString fmi2GetFMUstate fmi2SetFMUstate fmi2FreeFMUstate fmi2SerializedFMUstateSize \
    fmi2SerializeFMUstate fmi2DeSerializeFMUstate fmi2GetDirectionalDerivative fmi2SetRealInputDerivatives fmi2GetRealOutputDerivatives \
    fmi2DoStep fmi2CancelStep fmi2GetStatus fmi2GetRealStatus fmi2GetIntegerStatus fmi2GetBooleanStatus fmi2GetStringStatus";

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
                binary(&mut archive, identifier, &mut problems);
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

/// The binary for this machine, and the names of the exports in it. The names are looked for as bytes, so that the validator need not
/// run foreign code.
fn binary(archive: &mut Archive, identifier: &str, problems: &mut Vec<String>) {
    let path = platform::fmu_library(identifier);
    match read(archive, &path) {
        Ok(library) => {
            let names: std::collections::HashSet<&[u8]> = library.split(|&b| b == 0).collect();
            let missing = |name: &&str| !names.contains(name.as_bytes()) && !names.contains(format!("_{name}").as_bytes());
            problems.extend(EXPORTS.split_whitespace().filter(missing).map(|name| format!("{path}: {name} is not exported")));
        }
        Err(_) => problems.push(format!("{path} is missing: no binary for this platform")),
    }
}

#[cfg(test)]
mod tests;
