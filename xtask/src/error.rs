//! The error of every command: one message for the user, no backtrace.

use std::fmt;

/// What went wrong, in words for the user: the file, option or key, the value found and what was expected.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure(pub String);

impl fmt::Display for Failure {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

impl std::error::Error for Failure {}
