//! Compilation of exported sources with the C compiler of the machine, `CC` or `cc`.

use std::env::consts::{ARCH, OS};
use std::ffi::OsString;
use std::fs;
use std::io;
use std::process::Command;

use hardpoint_export::{Archive, Library};

/// Platforms whose compilers are called: architecture and system in Rust, name in FMI, extension of libraries, and the
/// option that makes one.
const PLATFORMS: [(&str, &str, &str, &str, &str); 4] = [
    ("x86_64", "linux", "x86_64-linux", "so", "-shared"),
    ("aarch64", "linux", "aarch64-linux", "so", "-shared"),
    ("x86_64", "macos", "x86_64-darwin", "dylib", "-dynamiclib"),
    ("aarch64", "macos", "aarch64-darwin", "dylib", "-dynamiclib"),
];

/// Compiles the sources of an archive as a shared library for this machine; returns the reason if that is not possible.
pub fn compile(archive: &Archive) -> Result<Library, String> {
    let here = PLATFORMS.iter().find(|(arch, os, ..)| (*arch, *os) == (ARCH, OS));
    let Some(&(.., platform, ending, shared)) = here else {
        return Err(format!("no library is compiled on {ARCH}-{OS}"));
    };
    let folder = tempfile::tempdir().map_err(|e| format!("no temporary folder: {e}"))?;
    let (prefix, sources) = &archive.sources;
    for (path, text) in &archive.files {
        if let Some(name) = path.strip_prefix(prefix).and_then(|rest| rest.strip_prefix('/')) {
            fs::write(folder.path().join(name), text)
                .map_err(|e| format!("`{name}` cannot be written: {e}"))?;
        }
    }
    let compiler = std::env::var_os("CC").filter(|cc| !cc.is_empty()).unwrap_or_else(|| OsString::from("cc"));
    let library = format!("{}.{ending}", archive.library);
    let done = Command::new(&compiler)
        .current_dir(folder.path())
        .args(["-std=c99", "-O2", "-fPIC", "-fvisibility=hidden", shared, "-o", &library])
        .args(sources)
        .arg("-lm")
        .output();
    let compiler = compiler.to_string_lossy().into_owned();
    let done = done.map_err(|e| match e.kind() {
        io::ErrorKind::NotFound => {
            format!(
                "there is no C compiler `{compiler}`; install one, or name it in the environment variable CC"
            )
        }
        _ => format!("the C compiler `{compiler}` cannot be started: {e}"),
    })?;
    if !done.status.success() {
        let errors = String::from_utf8_lossy(&done.stderr).into_owned();
        let first =
            errors.lines().find(|line| line.contains("error")).or(errors.lines().next()).unwrap_or("");
        return Err(format!("the C compiler `{compiler}` failed: {first}"));
    }
    let bytes =
        fs::read(folder.path().join(&library)).map_err(|e| format!("the library cannot be read: {e}"))?;
    Ok(Library { platform, ending, bytes })
}
