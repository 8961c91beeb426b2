//! The engine of a page: three functions, with one block of memory for the request and one for the answer.
//!
//! The page requests memory ([`room`]), writes its request there, calls [`answer`], and reads that many bytes at
//! [`answered`]. During a study the engine reports progress as JSON by the page's function `tell(place, length)`. A
//! panic ends the engine, without words: they would be a hundredth of it.

#![allow(
    unsafe_code,
    reason = "exports functions by name and imports one from the page; nothing else is unsafe here"
)]

use std::cell::RefCell;
use std::ops::ControlFlow;

use hardpoint_studio::{Engine, ProgressReply};

thread_local! {
    static ENGINE: RefCell<Engine> = RefCell::default();
    static REQUEST: RefCell<Vec<u8>> = RefCell::default();
    static ANSWER: RefCell<Vec<u8>> = RefCell::default();
}

#[link(wasm_import_module = "page")]
unsafe extern "C" {
    /// Reports the progress of a study, as JSON.
    safe fn tell(place: *const u8, length: usize);
}

/// Reserves memory for a request of `length` bytes.
#[unsafe(no_mangle)]
pub extern "C" fn room(length: usize) -> *mut u8 {
    REQUEST.with_borrow_mut(|request| {
        request.clear();
        request.resize(length, 0);
        request.as_mut_ptr()
    })
}

/// Answers the request, and returns the length of the answer in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> usize {
    let request = REQUEST.take();
    let mut on = |progress: &ProgressReply| {
        if let Ok(json) = serde_json::to_vec(progress) {
            tell(json.as_ptr(), json.len());
        }
        ControlFlow::Continue(())
    };
    let answer = ENGINE.with_borrow_mut(|engine| engine.answer(&request, &mut on));
    let length = answer.len();
    ANSWER.set(answer);
    length
}

/// Address of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn answered() -> *const u8 {
    ANSWER.with_borrow(|answer| answer.as_ptr())
}
