//! `cargo xtask test`: the Rust tests, then the Python tests of the packed FMU in a virtual environment of their own.

use crate::error::{Failure, Result};
use crate::package::root;
use crate::python::{environment, stream};
use std::env;
use std::process::Command;
use std::time::Instant;

/// Run every test: Rust's, then the Python tests of the packed FMU
#[derive(clap::Args)]
pub struct Args {}

/// Runs both suites, the second also when the first fails, and says of each how it ended.
///
/// # Errors
/// Names the suites that failed.
pub fn run(_args: Args) -> Result<()> {
    type Suite = (&'static str, fn() -> Result<()>);
    let suites: [Suite; 2] = [("Rust tests", rust), ("Python tests", python)];
    let mut lines = Vec::new();
    let mut failed = Vec::new();
    for (name, suite) in suites {
        println!("=== {name}");
        let begin = Instant::now();
        let outcome = suite();
        let seconds = begin.elapsed().as_secs_f64();
        if let Err(failure) = &outcome {
            failed.push(format!("{name}: {failure}"));
        }
        lines.push(format!("{name}: {} ({seconds:.0} s)", if outcome.is_ok() { "passed" } else { "FAILED" }));
    }
    println!("===\n{}", lines.join("\n"));
    if failed.is_empty() { Ok(()) } else { Err(Failure(failed.join("\n"))) }
}

fn rust() -> Result<()> {
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    stream(cargo.current_dir(root()).args(["test", "--workspace"]))
}

fn python() -> Result<()> {
    let folder = root().join("fmu-tests");
    let python = environment(&folder.join("requirements.txt"), &folder.join(".venv"))?;
    let xtask = env::current_exe().map_err(|e| Failure(format!("cannot find out where this program is: {e}")))?;
    stream(Command::new(python).current_dir(&folder).args(["-m", "pytest", "-q"]).env("FAIRLEAD_XTASK", xtask))
}
