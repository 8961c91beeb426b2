//! The engine for a page: three functions around one block of memory that goes in and one that comes out.
//!
//! The page asks for room ([`room`]), writes its request there, calls [`answer`], and reads that many bytes at [`answered`]. While a study is
//! under way it is reported how far it is by its own function `tell(place, length)`: JSON. Should the engine ever panic, it says so by
//! `panicked(place, length)`, and ends.

#![allow(
    unsafe_code,
    reason = "functions have names that the page knows, and one comes from the page: nothing else is unsafe here"
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
    /// Number of bytes at a place say how far a study is.
    safe fn tell(place: *const u8, length: usize);
    /// Number of bytes at a place say why the engine ends here.
    safe fn panicked(place: *const u8, length: usize);
}

/// Room for a request of that many bytes.
#[unsafe(no_mangle)]
pub extern "C" fn room(length: usize) -> *mut u8 {
    REQUEST.with_borrow_mut(|request| {
        request.clear();
        request.resize(length, 0);
        request.as_mut_ptr()
    })
}

/// Answers the request; how many bytes the answer has.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> usize {
    std::panic::set_hook(Box::new(|what| {
        let what = what.to_string();
        panicked(what.as_ptr(), what.len());
    }));
    let request = REQUEST.take();
    let mut on = |told: &ProgressReply| {
        if let Ok(json) = serde_json::to_vec(told) {
            tell(json.as_ptr(), json.len());
        }
        ControlFlow::Continue(())
    };
    let answer = ENGINE.with_borrow_mut(|engine| engine.answer(&request, &mut on));
    let length = answer.len();
    ANSWER.set(answer);
    length
}

/// Where the answer is.
#[unsafe(no_mangle)]
pub extern "C" fn answered() -> *const u8 {
    ANSWER.with_borrow(|answer| answer.as_ptr())
}
