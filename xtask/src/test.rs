//! `cargo xtask test`: the Rust tests, then the Python tests of the packed FMU in a virtual environment of their own.

use crate::error::{Failure, Result, at};
use crate::package::root;
use model_description::guid::Fnv;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;
use std::{env, fs};

/// Run every test: Rust's, then the Python tests of the packed FMU
#[derive(clap::Args)]
pub struct Args {}

/// The oldest Python that the tests run on.
const PYTHON: (u32, u32) = (3, 11);
/// Asks an interpreter for its version and whether it can make virtual environments.
const PROBE: &str = "import sys\nprint(*sys.version_info[:2])\nimport venv, ensurepip";

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
    let python = environment(&folder)?;
    let xtask = env::current_exe().map_err(|e| Failure(format!("cannot find out where this program is: {e}")))?;
    stream(Command::new(python).current_dir(&folder).args(["-m", "pytest", "-q"]).env("FAIRLEAD_XTASK", xtask))
}

/// The interpreter of a virtual environment that has what `requirements.txt` asks for; made anew whenever that file or the Python
/// behind it changes.
fn environment(folder: &Path) -> Result<PathBuf> {
    let requirements = folder.join("requirements.txt");
    let text = fs::read(&requirements).map_err(|e| at(&requirements, e))?;
    let (base, version) = interpreter()?;
    let wanted = Fnv::default().part(&text).part(version.as_bytes()).hex();

    let environment = folder.join(".venv");
    let python = environment.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    // Written last, so that an interrupted installation counts as none.
    let stamp = environment.join("requirements.hash");
    if fs::read_to_string(&stamp).is_ok_and(|found| found == wanted) && python.is_file() {
        return Ok(python);
    }
    println!("making {} with Python {version}", environment.display());
    if environment.exists() {
        fs::remove_dir_all(&environment).map_err(|e| at(&environment, e))?;
    }
    stream(Command::new(&base).args(["-m", "venv"]).arg(&environment))
        .map_err(|e| Failure(format!("{e}; expected `python3 -m venv` to work (Debian and Ubuntu: apt install python3-venv)")))?;
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement"];
    stream(Command::new(&python).args(pip).arg(&requirements))
        .map_err(|e| Failure(format!("{e}; pip could not install {}, see above", requirements.display())))?;
    fs::write(&stamp, wanted).map_err(|e| at(&stamp, e))?;
    Ok(python)
}

/// A Python that is new enough and has venv, with its version.
fn interpreter() -> Result<(OsString, String)> {
    let mut found = Vec::new();
    for name in ["python3", "python"] {
        // The text of a missing module is no news to the user.
        let Ok(output) = Command::new(name).args(["-c", PROBE]).stdin(Stdio::null()).output() else { continue };
        let text = String::from_utf8_lossy(&output.stdout);
        let numbers: Vec<u32> = text.split_whitespace().filter_map(|n| n.parse().ok()).collect();
        let &[major, minor] = numbers.as_slice() else { continue };
        let version = format!("{major}.{minor}");
        if (major, minor) < PYTHON {
            found.push(format!("{name} is {version}"));
        } else if !output.status.success() {
            found.push(format!("{name} {version} has no venv (Debian and Ubuntu: apt install python3-venv)"));
        } else {
            return Ok((name.into(), version));
        }
    }
    let found = if found.is_empty() { "there is no python3 on the PATH".into() } else { found.join(", ") };
    Err(Failure(format!("{found}; expected Python {}.{} or newer with venv", PYTHON.0, PYTHON.1)))
}

/// Runs a program whose output goes where ours does.
fn stream(command: &mut Command) -> Result<()> {
    let name = Path::new(command.get_program()).file_name().unwrap_or_default().to_string_lossy().into_owned();
    let status = command.stdin(Stdio::null()).status().map_err(|e| Failure(format!("{name} cannot be started: {e}")))?;
    if status.success() { Ok(()) } else { Err(Failure(format!("{name} ended with {status}"))) }
}
