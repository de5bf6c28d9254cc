//! `fmi2FMUstate` pointers: boxes with a magic word, owned by the importer until it frees them.

use super::abi::FmuState;
use super::snapshot::Snapshot;
use super::trouble::{Outcome, Trouble, error};
use std::ptr;
use std::sync::atomic::{AtomicU64, Ordering};

/// "flstate\0" tells a saved state from other memory.
const MAGIC: u64 = u64::from_le_bytes(*b"flstate\0");

#[repr(C)]
struct Handle {
    magic: AtomicU64,
    snapshot: Snapshot,
}

/// The state behind the pointer.
///
/// # Safety
/// A pointer that is not NULL must be to readable memory of at least a word, and to nothing that is used meanwhile.
unsafe fn handle<'a>(state: FmuState) -> Result<&'a mut Handle, Trouble> {
    let pointer = state.cast::<Handle>();
    // SAFETY: readable as the caller says; the magic word comes first in the handle.
    let ours = !pointer.is_null() && pointer.is_aligned() && unsafe { &*state.cast::<AtomicU64>() }.load(Ordering::Acquire) == MAGIC;
    if !ours {
        return Err(error("the FMU state is NULL, freed or not from this FMU"));
    }
    // SAFETY: the magic word says that this is a handle of ours.
    Ok(unsafe { &mut *pointer })
}

/// The snapshot behind the pointer.
///
/// # Safety
/// As [`handle`].
pub(super) unsafe fn get<'a>(state: FmuState) -> Result<&'a Snapshot, Trouble> {
    // SAFETY: passed on.
    unsafe { handle(state) }.map(|handle| &handle.snapshot)
}

/// Saves into the state that the slot points to, or into a new one if the slot is NULL.
///
/// # Safety
/// As [`handle`] for what the slot holds.
pub(super) unsafe fn put(slot: &mut FmuState, snapshot: Snapshot) -> Outcome {
    if slot.is_null() {
        *slot = Box::into_raw(Box::new(Handle { magic: AtomicU64::new(MAGIC), snapshot })).cast();
    } else {
        // SAFETY: passed on.
        unsafe { handle(*slot) }?.snapshot = snapshot;
    }
    Ok(())
}

/// Frees the state, if there is one, and sets the slot to NULL.
///
/// # Safety
/// As [`handle`] for what the slot holds.
pub(super) unsafe fn free(slot: &mut FmuState) -> Outcome {
    if slot.is_null() {
        return Ok(());
    }
    // SAFETY: passed on.
    unsafe { handle(*slot) }?.magic.store(0, Ordering::Release);
    // SAFETY: from `put`, and not freed before, for the mark was there.
    drop(unsafe { Box::from_raw(slot.cast::<Handle>()) });
    *slot = ptr::null_mut();
    Ok(())
}
