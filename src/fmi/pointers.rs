//! Arguments from C: checked once, then ordinary slices and strings.

use super::trouble::{Trouble, error};
use std::ffi::{CStr, c_char};
use std::slice;

fn check<T>(pointer: *const T, count: usize) -> Result<(), Trouble> {
    if pointer.is_null() {
        return Err(error(format!("an array of {count} elements is NULL")));
    }
    if !pointer.is_aligned() || count > isize::MAX as usize / size_of::<T>().max(1) {
        return Err(error(format!("an array of {count} elements is misaligned or impossibly long")));
    }
    Ok(())
}

/// An array to read; NULL will do when it has no elements.
///
/// # Safety
/// A pointer that is not NULL must be to `count` elements that live for `'a`.
pub(super) unsafe fn input<'a, T>(pointer: *const T, count: usize) -> Result<&'a [T], Trouble> {
    if count == 0 {
        return Ok(&[]);
    }
    check(pointer, count)?;
    // SAFETY: not NULL, aligned, and the caller vouches for the length.
    Ok(unsafe { slice::from_raw_parts(pointer, count) })
}

/// An array to write; NULL will do when it has no elements.
///
/// # Safety
/// A pointer that is not NULL must be to `count` elements that live for `'a` and that nothing else uses meanwhile.
pub(super) unsafe fn output<'a, T>(pointer: *mut T, count: usize) -> Result<&'a mut [T], Trouble> {
    if count == 0 {
        return Ok(&mut []);
    }
    check(pointer, count)?;
    // SAFETY: not NULL, aligned, and the caller vouches for the length.
    Ok(unsafe { slice::from_raw_parts_mut(pointer, count) })
}

/// A single value to write.
///
/// # Safety
/// As [`output`] with one element.
pub(super) unsafe fn single<'a, T>(pointer: *mut T) -> Result<&'a mut T, Trouble> {
    // SAFETY: passed on.
    unsafe { output(pointer, 1) }.map(|one| &mut one[0])
}

/// A string; `None` for NULL.
///
/// # Safety
/// A pointer that is not NULL must be to a NUL-terminated string that lives for `'a`.
pub(super) unsafe fn text<'a>(pointer: *const c_char) -> Option<&'a CStr> {
    // SAFETY: not NULL, and the caller vouches for the NUL at the end.
    (!pointer.is_null()).then(|| unsafe { CStr::from_ptr(pointer) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ptr;

    #[test]
    fn null_is_an_array_only_without_elements() {
        let words = [1_u32, 2, 3];
        // SAFETY: the pointers are NULL, misaligned on purpose (and refused) or to `words`.
        unsafe {
            assert_eq!(input::<f64>(ptr::null(), 0), Ok(&[][..]));
            assert!(input::<f64>(ptr::null(), 1).is_err());
            assert!(single::<f64>(ptr::null_mut()).is_err());
            assert!(input(words.as_ptr().byte_add(1), 1).is_err());
            assert!(input(words.as_ptr(), usize::MAX).is_err());
            assert_eq!(input(words.as_ptr(), 3), Ok(&words[..]));
            assert_eq!(text(ptr::null()), None);
        }
    }
}
