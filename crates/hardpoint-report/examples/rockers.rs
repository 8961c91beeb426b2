//! Writes the file of a model as large as a page has to bear, 81 bodies and 240 design variables:
//! `cargo run --example rockers -- rockers.toml`.

use std::{env, error::Error, fs};

#[path = "../tests/it/rockers.rs"]
mod rockers;

/// Two bodies and six design variables each.
const STAGES: usize = 40;

fn main() -> Result<(), Box<dyn Error>> {
    let path = env::args().nth(1).ok_or("name the file to write")?;
    fs::write(path, rockers::rockers(STAGES))?;
    Ok(())
}
