//! `hardpoint mcp`: the engine for agents, over the Model Context Protocol on stdin and stdout.
//!
//! Both eras of the protocol are served: the handshake of `initialize`, and requests that carry their protocol version
//! themselves. Tools run in threads of their own; a cancelled one ends like a command after Ctrl-C.

mod brief;
mod collector;
mod resources;
mod schema;
mod server;
mod tools;

pub(crate) use collector::Collector;
pub use server::run;
