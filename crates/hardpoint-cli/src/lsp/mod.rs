//! `hardpoint lsp`: the language of model files for editors, over the language server protocol on stdin and stdout.
//!
//! Requests are answered in order. Diagnostics are computed in a thread of its own ([`check`]), so that typing never
//! waits for them.

mod check;
mod files;
mod position;
mod server;

pub use server::run;
