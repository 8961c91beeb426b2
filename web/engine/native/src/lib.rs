//! Sources of `web/engine`, as they are compiled for WebAssembly.

#[path = "../../src/lib.rs"]
pub mod engine;
#[path = "../../web-time/src/lib.rs"]
pub mod web_time;
