//! Executable memory: first written, then made executable, never both at once.

use std::ffi::c_void;
use std::ptr::NonNull;

use rustix::io::Errno;
use rustix::mm::{MapFlags, MprotectFlags, ProtFlags, mmap_anonymous, mprotect, munmap};

/// Private pages with code, unmapped on drop.
#[derive(Debug)]
pub struct Executable {
    start: NonNull<c_void>,
    length: usize,
}

// SAFETY: nothing writes to the pages once `new` has returned, and they belong to the whole process.
unsafe impl Send for Executable {}
// SAFETY: as above; shared references only read the address.
unsafe impl Sync for Executable {}

impl Executable {
    pub fn new(code: &[u8]) -> Result<Self, Errno> {
        let length = code.len();
        // SAFETY: the address is null and the mapping anonymous and private: the system gives fresh pages, which
        // overlap nothing.
        let start = unsafe {
            mmap_anonymous(
                std::ptr::null_mut(),
                length,
                ProtFlags::READ | ProtFlags::WRITE,
                MapFlags::PRIVATE,
            )?
        };
        // Dropped, and with it unmapped, if the rest fails.
        let new = Self { start: NonNull::new(start).ok_or(Errno::NOMEM)?, length };
        // SAFETY: the pages were mapped for `length` bytes, can be written, and nobody else knows them.
        unsafe { start.cast::<u8>().copy_from_nonoverlapping(code.as_ptr(), length) };
        // SAFETY: these are exactly our pages; no reference into them exists.
        unsafe { mprotect(start, length, MprotectFlags::READ | MprotectFlags::EXEC)? };
        Ok(new)
    }

    /// Returns the address of the first byte of the code.
    pub fn start(&self) -> *const c_void {
        self.start.as_ptr()
    }
}

impl Drop for Executable {
    fn drop(&mut self) {
        // SAFETY: these are exactly our pages; who borrowed the code has returned, since `self` is borrowed mutably.
        let unmapped = unsafe { munmap(self.start.as_ptr(), self.length) };
        assert!(unmapped.is_ok(), "pages that were mapped can be unmapped");
    }
}
