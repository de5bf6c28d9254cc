//! Virtual environments for what comes from PyPI: each is made from a requirements file, and made anew when that file or the
//! Python behind it changes.

use crate::error::{Failure, Result, at};
use model_description::guid::Fnv;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The oldest Python that will do.
const PYTHON: (u32, u32) = (3, 11);
/// Asks an interpreter for its version and whether it can make virtual environments.
const PROBE: &str = "import sys\nprint(*sys.version_info[:2])\nimport venv, ensurepip";

/// The interpreter of a virtual environment in `folder` that has what the file asks for.
///
/// # Errors
/// No Python that is new enough, or pip could not install something; pip's own words are on the terminal by then.
pub fn environment(requirements: &Path, folder: &Path) -> Result<PathBuf> {
    let text = fs::read(requirements).map_err(|e| at(requirements, e))?;
    let (base, version) = interpreter()?;
    let wanted = Fnv::default().part(&text).part(version.as_bytes()).hex();

    let python = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    // Written last, so that an interrupted installation counts as none.
    let stamp = folder.join("requirements.hash");
    if fs::read_to_string(&stamp).is_ok_and(|found| found == wanted) && python.is_file() {
        return Ok(python);
    }
    println!("making {} with Python {version}", folder.display());
    if folder.exists() {
        fs::remove_dir_all(folder).map_err(|e| at(folder, e))?;
    }
    stream(Command::new(&base).args(["-m", "venv"]).arg(folder))
        .map_err(|e| Failure(format!("{e}; expected `python3 -m venv` to work (Debian and Ubuntu: apt install python3-venv)")))?;
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement"];
    stream(Command::new(&python).args(pip).arg(requirements))
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
///
/// # Errors
/// It cannot be started or ends badly.
pub fn stream(command: &mut Command) -> Result<()> {
    let name = Path::new(command.get_program()).file_name().unwrap_or_default().to_string_lossy().into_owned();
    let status = command.stdin(Stdio::null()).status().map_err(|e| Failure(format!("{name} cannot be started: {e}")))?;
    if status.success() { Ok(()) } else { Err(Failure(format!("{name} ended with {status}"))) }
}
