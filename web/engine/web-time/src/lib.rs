//! A clock for the engine in a page, in place of the crate of the same name, whose imports from JavaScript the page
//! would have to serve (`Cargo.toml`, `[patch]`). No time ever passes, so no time limit is reached.

pub use std::time::Duration;

/// A point in time; that of the standard library on machines with a clock.
#[cfg(not(target_family = "wasm"))]
pub use std::time::Instant;

/// A point in time; all are equal.
#[cfg(target_family = "wasm")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Instant;

#[cfg(target_family = "wasm")]
impl Instant {
    /// This moment.
    pub fn now() -> Self {
        Self
    }

    /// The time since then: none.
    pub fn elapsed(&self) -> Duration {
        Duration::ZERO
    }
}
