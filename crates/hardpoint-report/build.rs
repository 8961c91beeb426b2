//! Deflates what every report carries: the page's code, and the engine that solves in it.

use std::{env, error::Error, fs, io::Write, path::Path};

use base64::{Engine, prelude::BASE64_STANDARD};
use flate2::{Compression, write::DeflateEncoder};

fn main() -> Result<(), Box<dyn Error>> {
    for name in ["app.js", "engine.wasm"] {
        let file = Path::new("page").join(name);
        println!("cargo::rerun-if-changed={}", file.display());
        let mut deflated = DeflateEncoder::new(Vec::new(), Compression::best());
        deflated.write_all(&fs::read(file)?)?;
        let text = BASE64_STANDARD.encode(deflated.finish()?);
        fs::write(Path::new(&env::var("OUT_DIR")?).join(name).with_extension(extension(name)), text)?;
    }
    Ok(())
}

/// `app.js.txt` of `app.js`.
fn extension(name: &str) -> String {
    format!("{}.txt", name.rsplit('.').next().unwrap_or_default())
}
