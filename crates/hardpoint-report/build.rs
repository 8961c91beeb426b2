//! Texts of the contents of every report: the page's style and code, and the engine that solves in it.

use std::{env, error::Error, fs, io::Write, path::Path};

use flate2::{Compression, write::DeflateEncoder};

#[path = "src/base91.rs"]
#[allow(dead_code, reason = "pages are only written here")]
mod base91;

const PAGE: &str = "page";
/// Parts of the code, with a zero between them.
const CODE: [&str; 2] = ["app.css", "app.js"];
/// The engine, which `web/build` has deflated.
const ENGINE: &str = "engine.deflate";

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=src/base91.rs");
    let mut deflated = DeflateEncoder::new(Vec::new(), Compression::best());
    for (k, part) in CODE.iter().enumerate() {
        if k > 0 {
            deflated.write_all(&[0])?;
        }
        deflated.write_all(&read(part)?)?;
    }
    write("code.txt", &deflated.finish()?)?;
    write("engine.txt", &read(ENGINE)?)
}

fn read(name: &str) -> Result<Vec<u8>, Box<dyn Error>> {
    let file = Path::new(PAGE).join(name);
    println!("cargo::rerun-if-changed={}", file.display());
    Ok(fs::read(file)?)
}

fn write(name: &str, deflated: &[u8]) -> Result<(), Box<dyn Error>> {
    Ok(fs::write(Path::new(&env::var("OUT_DIR")?).join(name), base91::encode(deflated))?)
}
