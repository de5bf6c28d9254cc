//! What the model description and the documentation of one FMU are written from.

use crate::{Shape, Variable};

/// One FMU.
#[derive(Clone, Copy, Debug)]
pub struct Document<'a> {
    /// The scene's name: a C identifier.
    pub name: &'a str,
    /// The scene's description.
    pub description: &'a str,
    /// Fingerprint in braces.
    pub guid: &'a str,
    /// Version of fairlead.
    pub version: &'a str,
    /// The solver's tolerance.
    pub tolerance: f64,
    /// What the scene consists of.
    pub shape: &'a Shape,
    /// The scene file's text.
    pub text: &'a str,
    /// File beside the page that shows the start shape, if there is one.
    pub picture: Option<&'a str>,
    /// All variables in declaration order.
    pub variables: &'a [Variable],
}

/// Log categories: name and description.
pub static LOG_CATEGORIES: &[(&str, &str)] = &[
    ("logStatusWarning", "The model goes on, but results may be degraded"),
    ("logStatusDiscard", "A step could not be completed or a request could not be granted; the state is as before"),
    ("logStatusError", "A call was refused or has failed: when, where along the cable, why, and what to try"),
    ("logStatusFatal", "Reserved by FMI; fairlead never makes other instances unusable"),
    ("logAll", "Everything"),
    ("logEvents", "Life cycle: initialization, start state, changed parameters, end"),
    ("logSolver", "Sub-steps, rejections and their reasons"),
];

/// Values of `status.code`: code, name, meaning.
pub static STATUS_CODES: &[(i32, &str, &str)] = &[
    (0, "fine", "All went well."),
    (1, "degraded", "Results are usable but less accurate than asked for; status.message says why."),
    (2, "stopped", "The last step could not be done. Outputs keep the last good values; status.message says why and what to try."),
];
