//! Cache of pages and of the drawings of the gallery.

use std::collections::HashMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use hyper::body::Bytes;

use super::folder::Revision;

/// Page generation: one page at a time; the last page serves all requests that arrived before it was started.
#[derive(Default)]
pub(super) struct Pages {
    clock: AtomicU64,
    pub last: tokio::sync::Mutex<Option<Made>>,
    /// Drawings of the gallery, with the revision of their model.
    pub drawings: Mutex<HashMap<String, (Revision, String)>>,
}

/// A page that was made.
pub(super) struct Made {
    pub begun: u64,
    pub file: String,
    pub case: Option<String>,
    pub html: Bytes,
}

impl Pages {
    /// Next instant of its clock, which orders requests and pages.
    pub fn tick(&self) -> u64 {
        self.clock.fetch_add(1, Ordering::SeqCst)
    }
}
