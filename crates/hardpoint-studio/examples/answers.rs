//! Answers requests as the page's engine does: a request of JSON on each line of its input, a block in base64 on each
//! line of its output.

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
