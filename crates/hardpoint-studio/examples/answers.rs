//! Replies to requests like the engine of the page: reads one JSON request per line, and writes one base64 block per
//! line.

use std::io::{BufRead, Write};
use std::ops::ControlFlow;

use base64::{Engine as _, prelude::BASE64_STANDARD};
use hardpoint_studio::Engine;

fn main() -> std::io::Result<()> {
    let (mut engine, mut out) = (Engine::default(), std::io::stdout().lock());
    for request in std::io::stdin().lock().lines() {
        let block = engine.answer(request?.as_bytes(), &mut |_| ControlFlow::Continue(()));
        writeln!(out, "{}", BASE64_STANDARD.encode(block))?;
    }
    Ok(())
}
