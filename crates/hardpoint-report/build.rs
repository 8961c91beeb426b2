//! Deflates the contents of every report: the page's style and code, and the engine that solves in it.

use std::{env, error::Error, fs, io::Write, path::Path};

use flate2::{Compression, write::DeflateEncoder};

/// Contents, each of some files of the folder `page` with a zero between them.
const CONTENTS: [(&str, &[&str]); 2] =
    [("code.txt", &["app.css", "app.js"]), ("engine.txt", &["engine.wasm"])];

fn main() -> Result<(), Box<dyn Error>> {
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
        fs::write(Path::new(&env::var("OUT_DIR")?).join(name), base85(&deflated.finish()?))?;
    }
    Ok(())
}

/// Digits that mean nothing to HTML, as `page/report.html` and `web/src/unpack.ts` know them.
const DIGITS: &[u8; 85] =
    b"0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.-:+=^!/*?,;_()[]{}@%$#";

/// Four bytes in five characters, a sixteenth less than base64 takes: of engine and code that is 0.17 MB. Of a last few
/// bytes, one more than these.
fn base85(bytes: &[u8]) -> String {
    let digits = bytes.chunks(4).flat_map(|chunk| {
        let mut four = [0; 4];
        four[..chunk.len()].copy_from_slice(chunk);
        let number = u32::from_be_bytes(four);
        let digit = move |place: u32| char::from(DIGITS[(number / 85_u32.pow(4 - place) % 85) as usize]);
        (0..=chunk.len() as u32).map(digit)
    });
    digits.collect()
}
