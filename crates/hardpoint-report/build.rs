//! Deflates the contents of every report: the page's style and code, and the engine that solves in it.

use std::{env, error::Error, fs, io::Write, path::Path};

use flate2::{Compression, write::DeflateEncoder};

#[path = "src/base85.rs"]
#[allow(dead_code, reason = "pages are only written here")]
mod base85;

/// Contents, each of some files of the folder `page` with a zero between them.
const CONTENTS: [(&str, &[&str]); 2] =
    [("code.txt", &["app.css", "app.js"]), ("engine.txt", &["engine.wasm"])];

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=src/base85.rs");
    for (name, parts) in CONTENTS {
        let mut deflated = DeflateEncoder::new(Vec::new(), Compression::best());
        for (k, part) in parts.iter().enumerate() {
            let file = Path::new("page").join(part);
            println!("cargo::rerun-if-changed={}", file.display());
            if k > 0 {
                deflated.write_all(&[0])?;
            }
            deflated.write_all(&fs::read(file)?)?;
        }
        fs::write(Path::new(&env::var("OUT_DIR")?).join(name), base85::encode(&deflated.finish()?))?;
    }
    Ok(())
}
