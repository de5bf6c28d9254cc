//! Folders of results that commands write: whole or not at all.

use crate::error::{Result, at};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// Writes a text file.
pub fn save(path: &Path, text: &str) -> Result<()> {
    fs::write(path, text).map_err(|e| at(path, format!("cannot be written: {e}")))
}

/// Writes a text file that takes its name, and the place of what had it, only when it is whole.
pub fn replace(path: &Path, text: &str) -> Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let failed = |e: std::io::Error| at(path, format!("cannot be written: {e}"));
    let mut builder = tempfile::Builder::new();
    // Temporary files are private, results are not.
    #[cfg(unix)]
    let builder = builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.prefix(".making-").tempfile_in(folder).map_err(failed)?;
    file.write_all(text.as_bytes()).map_err(failed)?;
    file.persist(path).map(drop).map_err(|e| failed(e.error))
}

/// Fills a new folder beside `folder` and puts it in its place when it is whole. What was there before is gone only then.
pub fn publish(folder: &Path, fill: impl FnOnce(&Path) -> Result<()>) -> Result<()> {
    let parent = folder.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(parent).map_err(|e| at(parent, format!("cannot be made: {e}")))?;
    let mut builder = tempfile::Builder::new();
    // Temporary folders are private, results are not.
    #[cfg(unix)]
    let builder = builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o755));
    let temporary = builder.prefix(".making-").tempdir_in(parent).map_err(|e| at(parent, format!("cannot be written: {e}")))?;
    let (new, old) = (temporary.path().join("new"), temporary.path().join("old"));
    fs::create_dir(&new).map_err(|e| at(&new, e))?;
    fill(&new)?;
    let failed = |e: std::io::Error| at(folder, format!("cannot be replaced: {e}"));
    let existed = folder.symlink_metadata().is_ok();
    if existed {
        fs::rename(folder, &old).map_err(failed)?;
    }
    fs::rename(&new, folder).map_err(|e| {
        if existed {
            // The first error is the one to report.
            let _ = fs::rename(&old, folder);
        }
        failed(e)
    })
}

/// A path as short as the user would type it.
pub fn shown(path: &Path) -> String {
    let here = env::current_dir().ok();
    let inside = here.and_then(|here| path.strip_prefix(here).map(PathBuf::from).ok());
    inside.as_deref().unwrap_or(path).display().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Failure;

    #[test]
    fn exact_a_report_replaces_the_last_one_only_when_whole() {
        let parent = tempfile::tempdir().unwrap();
        let folder = parent.path().join("deep").join("demo");
        publish(&folder, |new| save(&new.join("a"), "1")).unwrap();
        let failure = publish(&folder, |new| save(&new.join("a"), "2").and(Err(Failure("no".into()))));
        assert_eq!(failure, Err(Failure("no".into())));
        assert_eq!(fs::read_to_string(folder.join("a")).unwrap(), "1");
        publish(&folder, |new| save(&new.join("b"), "3")).unwrap();
        assert!(!folder.join("a").exists() && folder.join("b").exists());
        assert_eq!(fs::read_dir(folder.parent().unwrap()).unwrap().count(), 1, "nothing temporary is left");
    }
}
