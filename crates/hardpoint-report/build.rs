//! Deflates the page's code, which every report carries.

use std::{env, error::Error, fs, io::Write, path::Path};

use base64::{Engine, prelude::BASE64_STANDARD};
use flate2::{Compression, write::DeflateEncoder};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=page/app.js");
    let mut deflated = DeflateEncoder::new(Vec::new(), Compression::best());
    deflated.write_all(&fs::read("page/app.js")?)?;
    let text = BASE64_STANDARD.encode(deflated.finish()?);
    fs::write(Path::new(&env::var("OUT_DIR")?).join("app.js.txt"), text)?;
    Ok(())
}
