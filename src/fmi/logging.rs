//! Messages to the importer's logger.

use super::abi::{CallbackFunctions, ComponentEnvironment, LoggerCallback, Status};
use super::trouble::Trouble;
use std::ffi::{CStr, CString};
use std::ptr;

/// The log categories of the model description.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Category {
    /// Something to look at.
    StatusWarning = 1,
    /// A step that could not be done.
    StatusDiscard = 2,
    /// A call that was refused.
    StatusError = 4,
    /// Not used for messages: no trouble of one instance condemns the others.
    StatusFatal = 8,
    /// Stands for all the others.
    All = 16,
    /// Life cycle and parameter changes.
    Events = 32,
    /// What the solver did in each step.
    Solver = 64,
}

impl Category {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::StatusWarning, Self::StatusDiscard, Self::StatusError, Self::StatusFatal, Self::All, Self::Events, Self::Solver];

    /// As in the model description.
    pub fn name(self) -> &'static CStr {
        match self {
            Self::StatusWarning => c"logStatusWarning",
            Self::StatusDiscard => c"logStatusDiscard",
            Self::StatusError => c"logStatusError",
            Self::StatusFatal => c"logStatusFatal",
            Self::All => c"logAll",
            Self::Events => c"logEvents",
            Self::Solver => c"logSolver",
        }
    }

    fn of(status: Status) -> Self {
        match status {
            Status::Ok | Status::Pending => Self::Events,
            Status::Warning => Self::StatusWarning,
            Status::Discard => Self::StatusDiscard,
            Status::Error => Self::StatusError,
            Status::Fatal => Self::StatusFatal,
        }
    }
}

/// Without debug logging the importer still hears of trouble: a bare status helps nobody.
const TROUBLE: u8 =
    Category::StatusWarning as u8 | Category::StatusDiscard as u8 | Category::StatusError as u8 | Category::StatusFatal as u8;

/// One instance's way to the importer's logger.
pub(super) struct Log {
    logger: Option<LoggerCallback>,
    environment: ComponentEnvironment,
    instance: CString,
    on: u8,
}

// SAFETY: the environment is only handed back to the importer, in calls that the importer itself makes, on its threads.
unsafe impl Send for Log {}

impl Log {
    /// Copies what it needs from the importer's struct.
    pub fn new(callbacks: Option<&CallbackFunctions>, instance: CString, debug: bool) -> Self {
        Self {
            logger: callbacks.and_then(|callbacks| callbacks.logger),
            environment: callbacks.map_or(ptr::null_mut(), |callbacks| callbacks.component_environment),
            instance,
            on: if debug { Category::All as u8 } else { TROUBLE },
        }
    }

    /// fmi2SetDebugLogging: no names stand for all categories.
    ///
    /// # Errors
    /// The name that is no category; nothing is changed then.
    pub fn select(&mut self, debug: bool, names: &[&CStr]) -> Result<(), String> {
        let mut chosen = if names.is_empty() { Category::All as u8 } else { 0 };
        for &name in names {
            let category = Category::ALL.into_iter().find(|category| category.name() == name).ok_or_else(|| {
                let known: Vec<_> = Category::ALL.iter().map(|category| category.name().to_string_lossy()).collect();
                format!("no log category {}; expected one of {}", name.to_string_lossy(), known.join(", "))
            })?;
            chosen |= category as u8;
        }
        self.on = if debug { chosen } else { 0 };
        Ok(())
    }

    /// Reports trouble in an FMI function and gives the status to return.
    pub fn trouble(&self, function: &str, trouble: &Trouble) -> Status {
        self.message(trouble.status, Category::of(trouble.status), || format!("{function}: {}", trouble.message));
        trouble.status
    }

    /// Reports why there will be no instance, whatever categories are on.
    pub fn refusal(&self, message: &str) {
        self.send(Status::Error, Category::StatusError, &format!("fmi2Instantiate: {message}"));
    }

    /// Something happened in the instance's life.
    pub fn event(&self, text: impl FnOnce() -> String) {
        self.message(Status::Ok, Category::Events, text);
    }

    /// The solver did something.
    pub fn solver(&self, text: impl FnOnce() -> String) {
        self.message(Status::Ok, Category::Solver, text);
    }

    fn message(&self, status: Status, category: Category, text: impl FnOnce() -> String) {
        if self.on & (category as u8 | Category::All as u8) != 0 {
            self.send(status, category, &text());
        }
    }

    /// One call per line. The text itself is the format, free of everything that printf or FMI's `#r1#` would interpret: a
    /// logger that ignores its arguments would show nothing of a text passed behind "%s".
    fn send(&self, status: Status, category: Category, text: &str) {
        let Some(logger) = self.logger else { return };
        for line in text.lines().filter(|line| !line.trim().is_empty()) {
            let line = CString::new(plain(line)).unwrap_or_default();
            // SAFETY: the importer's own function, in a call from the importer, with strings that outlive it.
            unsafe { logger(self.environment, self.instance.as_ptr(), status, category.name().as_ptr(), line.as_ptr()) };
        }
    }
}

/// Without percent and number signs and control characters.
fn plain(line: &str) -> String {
    let mut plain = String::with_capacity(line.len());
    for c in line.trim_end().chars() {
        match c {
            '%' => plain.push_str("percent"),
            '#' => plain.push_str("no."),
            c if c.is_control() => plain.push(' '),
            c => plain.push(c),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_left_to_format() {
        assert_eq!(plain("5 % of #r12# at\tt\0 = 1\r"), "5 percent of no.r12no. at t  = 1");
    }

    #[test]
    fn categories_are_chosen_by_name() {
        let mut log = Log::new(None, c"x".into(), false);
        assert_eq!(log.on, TROUBLE);
        assert_eq!(log.select(true, &[c"logEvents", c"logSolver"]), Ok(()));
        assert_eq!(log.on, 96);
        assert!(log.select(true, &[c"logEvents", c"logWeather"]).unwrap_err().contains("logWeather"));
        assert_eq!(log.on, 96);
        assert_eq!(log.select(true, &[]), Ok(()));
        assert_eq!(log.on, Category::All as u8);
        assert_eq!(log.select(false, &[]), Ok(()));
        assert_eq!(log.on, 0);
    }
}
