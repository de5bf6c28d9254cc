//! What a command reports when it fails: one line a problem, naming file, key or variable and what was expected; no backtrace.

use std::fmt::Display;
use std::path::Path;
use thiserror::Error;

/// Why a command failed; may have several lines, one a problem.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{0}")]
pub struct Failure(pub String);

/// Result of a command.
pub type Result<T> = std::result::Result<T, Failure>;

impl From<String> for Failure {
    fn from(message: String) -> Self {
        Self(message)
    }
}

/// A failure of an operation on a file.
pub fn at(path: &Path, problem: impl Display) -> Failure {
    Failure(format!("{}: {problem}", path.display()))
}
