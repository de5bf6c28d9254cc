//! What went wrong, in words for the user.

use std::fmt;

/// Names the file, key or variable and says what was expected; `main` prints it and exits with 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure(pub String);

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Failure {}

impl From<String> for Failure {
    fn from(message: String) -> Self {
        Self(message)
    }
}

/// A failure of an operation on a file.
pub fn at(path: &std::path::Path, problem: impl fmt::Display) -> Failure {
    Failure(format!("{}: {problem}", path.display()))
}
