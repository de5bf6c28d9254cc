//! What is wrong with a scene file: everything at once, each problem with the key that it is about.

use std::fmt;

/// One thing wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Dotted key, such as `sheave[1].radius`; empty for the file as a whole.
    pub key: String,
    /// What was found and what was expected.
    pub message: String,
}

/// Everything wrong with a scene file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneErrors {
    /// The file, or what stands for it.
    pub source: String,
    /// At least one.
    pub problems: Vec<Problem>,
}

impl fmt::Display for SceneErrors {
    /// One line a problem, without a newline at the end.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, problem) in self.problems.iter().enumerate() {
            let newline = if i == 0 { "" } else { "\n" };
            let colon = if problem.key.is_empty() { "" } else { ": " };
            write!(f, "{newline}{}: {}{colon}{}", self.source, problem.key, problem.message)?;
        }
        Ok(())
    }
}

impl std::error::Error for SceneErrors {}

/// Collects problems.
#[derive(Debug, Default)]
pub(super) struct Problems(Vec<Problem>);

impl Problems {
    pub fn add(&mut self, key: impl Into<String>, message: impl Into<String>) {
        self.0.push(Problem { key: key.into(), message: message.into() });
    }

    /// Adds a problem unless something is already known to be wrong with the same key.
    pub fn add_once(&mut self, key: &str, message: impl Into<String>) {
        if !self.has(key) {
            self.add(key, message);
        }
    }

    /// Whether something is known to be wrong with a key.
    pub fn has(&self, key: &str) -> bool {
        self.0.iter().any(|p| p.key == key)
    }

    /// `value` if nothing was found.
    pub fn into_result<T>(self, source: &str, value: T) -> Result<T, SceneErrors> {
        if self.0.is_empty() { Ok(value) } else { Err(self.into_errors(source)) }
    }

    /// What was found.
    pub fn into_errors(self, source: &str) -> SceneErrors {
        SceneErrors { source: source.to_owned(), problems: self.0 }
    }
}
