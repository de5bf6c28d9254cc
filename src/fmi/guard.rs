//! The one guard around every exported function.

use super::abi::{Component, Status};
use super::function::{Function, Phase};
use super::instance::Instance;
use super::panics::catch;
use super::trouble::{Outcome, Trouble, error};
use std::cell::UnsafeCell;
use std::ops::{Deref, DerefMut};
use std::ptr;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// "fairlead" tells a live instance from other memory. A registry of instances would not do: hosts reload the library, and
/// thereby empty its statics, under instances that live on.
const MAGIC: u64 = u64::from_le_bytes(*b"fairlead");

/// What an `fmi2Component` points to.
#[repr(C)]
struct Handle {
    magic: AtomicU64,
    busy: AtomicBool,
    instance: UnsafeCell<Instance>,
}

// FMI allows an instance to be created on one thread and used on another.
const _: () = {
    const fn is_send<T: Send>() {}
    is_send::<Instance>();
};

/// The only user of an instance until dropped: neither another thread nor the importer's logger may call into an instance that
/// is at work.
struct Entry<'a>(&'a Handle);

impl Deref for Entry<'_> {
    type Target = Instance;
    fn deref(&self) -> &Instance {
        // SAFETY: `busy` admits one entry at a time.
        unsafe { &*self.0.instance.get() }
    }
}

impl DerefMut for Entry<'_> {
    fn deref_mut(&mut self) -> &mut Instance {
        // SAFETY: `busy` admits one entry at a time.
        unsafe { &mut *self.0.instance.get() }
    }
}

impl Drop for Entry<'_> {
    fn drop(&mut self) {
        self.0.busy.store(false, Ordering::Release);
    }
}

/// The instance behind the pointer, unless it is NULL, no instance, freed or at work.
///
/// # Safety
/// A pointer that is not NULL must be to readable memory of at least a word.
unsafe fn enter<'a>(component: Component) -> Option<Entry<'a>> {
    let handle = component.cast::<Handle>();
    if handle.is_null() || !handle.is_aligned() {
        return None;
    }
    // SAFETY: aligned and readable; the magic word comes first in the handle.
    if unsafe { &*component.cast::<AtomicU64>() }.load(Ordering::Acquire) != MAGIC {
        return None;
    }
    // SAFETY: the magic word says that this is a handle of ours.
    let handle = unsafe { &*handle };
    let free = !handle.busy.swap(true, Ordering::Acquire);
    // Lazily: an entry that is made is also dropped, and would let others in.
    free.then(|| Entry(handle))
}

/// Runs the body of an exported function: checks the pointer, then the table of allowed phases, catches panics, and turns
/// trouble into a status and a message.
///
/// # Safety
/// `component` is NULL or from [`give_out`].
pub(super) unsafe fn guard(component: Component, function: Function, body: impl FnOnce(&mut Instance) -> Outcome) -> Status {
    // SAFETY: as the caller says.
    let Some(mut instance) = (unsafe { enter(component) }) else { return Status::Error };
    let outcome = if function.allowed(instance.phase) {
        catch(|| body(&mut instance)).unwrap_or_else(|panic| {
            instance.phase = Phase::Poisoned;
            Err(error(format!("internal error: {panic}. Please report it. Only fmi2Reset and fmi2FreeInstance will work now")))
        })
    } else {
        Err(not_now(function, instance.phase))
    };
    outcome.map_or_else(|trouble| instance.log.trouble(function.name(), &trouble), |()| Status::Ok)
}

fn not_now(function: Function, phase: Phase) -> Trouble {
    error(format!("not allowed while the instance is {}; expected one that is {}", phase.name(), function.when()))
}

/// A new instance for the importer.
pub(super) fn give_out(instance: Instance) -> Component {
    let handle = Handle { magic: AtomicU64::new(MAGIC), busy: AtomicBool::new(false), instance: UnsafeCell::new(instance) };
    Box::into_raw(Box::new(handle)).cast()
}

/// Frees an instance; anything that is none, or is at work (the logger called us), stays as it is.
///
/// # Safety
/// As [`guard`]; the pointer is dangling afterwards.
pub(super) unsafe fn take_back(component: Component) {
    // SAFETY: as the caller says.
    let Some(entry) = (unsafe { enter(component) }) else { return };
    // The mark goes first, so that freeing twice is noticed as long as the memory is not used again.
    entry.0.magic.store(0, Ordering::Release);
    // The entry would write into freed memory.
    std::mem::forget(entry);
    // SAFETY: from `give_out`, and not freed before, for the mark was there.
    let handle = unsafe { Box::from_raw(component.cast::<Handle>()) };
    // Whatever happens while dropping, the importer has nothing to do with it.
    drop(catch(|| drop(handle)));
}

/// For exports that give a pointer: NULL after a panic.
pub(super) fn or_null<T>(result: Result<*mut T, String>) -> *mut T {
    result.unwrap_or(ptr::null_mut())
}

#[cfg(test)]
mod tests {
    use super::super::logging::Log;
    use super::*;
    use crate::variables::Model;

    fn instance() -> Component {
        give_out(Instance::new(Model::load(None).unwrap(), Log::new(None, c"x".into(), false)))
    }

    #[test]
    fn a_panic_poisons_the_instance_until_it_is_reset() {
        let c = instance();
        // SAFETY: an instance from `give_out`, freed once at the end.
        unsafe {
            assert_eq!(guard(c, Function::SetupExperiment, |_| panic!("broken")), Status::Error);
            assert_eq!(guard(c, Function::SetupExperiment, |_| Ok(())), Status::Error);
            assert_eq!(guard(c, Function::Reset, Instance::reset), Status::Ok);
            assert_eq!(guard(c, Function::SetupExperiment, |_| Ok(())), Status::Ok);
            take_back(c);
        }
    }

    #[test]
    fn an_instance_at_work_admits_nobody() {
        let c = instance();
        // SAFETY: as above.
        unsafe {
            let inner = |_: &mut Instance| {
                take_back(c);
                assert_eq!(guard(c, Function::Reset, Instance::reset), Status::Error);
                Ok(())
            };
            assert_eq!(guard(c, Function::SetupExperiment, inner), Status::Ok);
            take_back(c);
        }
    }
}
