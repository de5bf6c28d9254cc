//! Panics end at the C border: caught, never printed, their message kept for the log.

use std::any::Any;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::ptr;
use std::sync::Once;

thread_local! {
    // Where the panic hook writes while this thread is inside the border. A plain pointer needs no destructor at thread exit,
    // which would be fatal after the library is unloaded.
    static REPORT: Cell<*mut String> = const { Cell::new(ptr::null_mut()) };
}

/// Runs `body`; a panic becomes its message with the place where it happened.
pub(super) fn catch<T>(body: impl FnOnce() -> T) -> Result<T, String> {
    install_hook();
    let mut report = String::new();
    let outer = REPORT.replace(&raw mut report);
    let result = catch_unwind(AssertUnwindSafe(body));
    REPORT.set(outer);
    result.map_err(|_| report)
}

/// In the FMU the hook belongs to the library's own copy of std. In a Rust program that links fairlead, panics outside of FMI
/// calls still go where they went before.
fn install_hook() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let previous = take_hook();
        set_hook(Box::new(move |info| match REPORT.get() {
            report if report.is_null() => previous(info),
            // SAFETY: the pointer is to a live local of `catch` further up this thread's stack, and nobody else uses it now.
            report => unsafe {
                let place = info.location().map_or_else(String::new, |at| format!(" ({}:{})", at.file(), at.line()));
                *report = format!("{}{place}", text(info.payload()));
            },
        }));
    });
}

/// What `panic!` was given.
fn text(payload: &dyn Any) -> &str {
    let text = payload.downcast_ref::<&str>().copied().or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("panic without a message")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_message() {
        assert_eq!(catch(|| 3), Ok(3));
        let message = catch(|| -> i32 { panic!("rope number {} broke", 7) }).unwrap_err();
        assert!(message.starts_with("rope number 7 broke (") && message.contains("panics.rs:"), "{message}");
    }

    #[test]
    fn nested_calls_keep_their_own_messages() {
        let outer = catch(|| {
            assert!(catch(|| panic!("inner")).unwrap_err().starts_with("inner"));
            panic!("outer")
        });
        assert!(outer.unwrap_err().starts_with("outer"));
    }
}
