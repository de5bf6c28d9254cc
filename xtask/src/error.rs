//! What a command reports when it fails: one line a problem, naming file, key and expectation.

use std::path::Path;
use thiserror::Error;

/// Why a command failed; may have several lines, one a problem.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{0}")]
pub struct Error(pub String);

/// The same, as most commands call it.
pub use self::Error as Failure;

/// Result of a command.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// An error about a file.
    pub fn at(path: &Path, what: impl std::fmt::Display) -> Self {
        Self(format!("{}: {what}", path.display()))
    }
}

impl From<String> for Error {
    fn from(message: String) -> Self {
        Self(message)
    }
}

/// A failure of an operation on a file.
pub fn at(path: &Path, problem: impl std::fmt::Display) -> Failure {
    Error::at(path, problem)
}
