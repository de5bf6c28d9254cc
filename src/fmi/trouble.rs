//! What an FMI function can fail with.

use super::abi::Status;

/// A status other than fmi2OK with its explanation for the log.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Trouble {
    pub status: Status,
    pub message: String,
}

/// What the body of an exported function returns.
pub(super) type Outcome = Result<(), Trouble>;

/// Nothing happened; the instance is as it was.
pub(super) fn error(message: impl Into<String>) -> Trouble {
    Trouble { status: Status::Error, message: message.into() }
}

/// The request was understood but cannot be served.
pub(super) fn discard(message: impl Into<String>) -> Trouble {
    Trouble { status: Status::Discard, message: message.into() }
}

/// It was done, but look at it.
pub(super) fn warning(message: impl Into<String>) -> Trouble {
    Trouble { status: Status::Warning, message: message.into() }
}
