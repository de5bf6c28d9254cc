//! `cargo xtask example`: a Python program of `fmu-tests/examples` in the virtual environment that the tests have.

use crate::error::{Failure, Result, at};
use crate::package::root;
use crate::python::{environment, stream};
use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Run an example in Python of fmu-tests/examples
#[derive(clap::Args)]
// --help behind an example's name is the example's.
#[command(disable_help_flag = true)]
pub struct Args {
    /// Its name; without one they are listed
    #[arg(allow_hyphen_values = true)]
    name: Option<String>,
    /// Options of the example itself; --help lists them
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    options: Vec<OsString>,
}

/// Runs the example, or lists them.
///
/// # Errors
/// There is no such example, there is no Python, or the example ends badly.
pub fn run(args: Args) -> Result<()> {
    let tests = root().join("fmu-tests");
    let folder = tests.join("examples");
    let examples = examples(&folder)?;
    let Some(name) = args.name.filter(|name| !name.starts_with('-')) else {
        println!("cargo xtask example NAME [OPTIONS]; --help behind a name lists its options\n");
        for (name, description) in examples {
            println!("{name:20} {description}");
        }
        return Ok(());
    };
    if !examples.iter().any(|(known, _)| *known == name) {
        let names: Vec<String> = examples.into_iter().map(|(name, _)| name).collect();
        return Err(Failure(format!("example {name}: expected one of {}", names.join(", "))));
    }
    let python = environment(&tests.join("requirements.txt"), &tests.join(".venv"))?;
    let xtask = env::current_exe().map_err(|e| Failure(format!("cannot find out where this program is: {e}")))?;
    // Unbuffered: a run of minutes shows how far it is.
    stream(Command::new(python).arg("-u").arg(folder.join(name + ".py")).args(args.options).env("FAIRLEAD_XTASK", xtask))
}

/// Names of the programs in a folder (the files that can be run, not those they share), with the first lines of their descriptions.
fn examples(folder: &Path) -> Result<Vec<(String, String)>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(|e| at(folder, e))? {
        let path = entry.map_err(|e| at(folder, e))?.path();
        if path.extension().is_none_or(|end| end != "py") {
            continue;
        }
        let text = fs::read_to_string(&path).map_err(|e| at(&path, e))?;
        if text.contains("\nif __name__ == \"__main__\":") {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            found.push((name, text.lines().next().unwrap_or_default().trim_matches('"').to_owned()));
        }
    }
    found.sort();
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_programs_are_listed_and_what_they_share_is_not() {
        let found = examples(&root().join("fmu-tests/examples")).unwrap();
        let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["heave_compensation", "vessel_coupling"]);
        assert!(found.iter().all(|(_, description)| description.ends_with('.')), "{found:?}");
    }
}
