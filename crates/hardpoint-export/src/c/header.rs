//! Names of C sources, their headers, and what they define.

use crate::ExportError;

/// Headers of the C standard library.
const STANDARD_HEADERS: [&str; 31] = [
    "assert",
    "complex",
    "ctype",
    "errno",
    "fenv",
    "float",
    "inttypes",
    "iso646",
    "limits",
    "locale",
    "math",
    "setjmp",
    "signal",
    "stdalign",
    "stdarg",
    "stdatomic",
    "stdbit",
    "stdbool",
    "stdckdint",
    "stddef",
    "stdint",
    "stdio",
    "stdlib",
    "stdnoreturn",
    "string",
    "tgmath",
    "threads",
    "time",
    "uchar",
    "wchar",
    "wctype",
];

/// Checks that an `#include` finds the header of a source file with this name, and hides no other.
pub(super) fn check_header(stem: &str) -> Result<(), ExportError> {
    let unfit = |why: String, name: String| {
        let help = format!("choose another name of the file, for example `{name}`");
        Err(ExportError::UnfitName { why, help })
    };
    if STANDARD_HEADERS.contains(&&*stem.to_ascii_lowercase()) {
        let why = format!("its header `{stem}.h` would hide that of the C standard library");
        return unfit(why, format!("{stem}_motion"));
    }
    // Places of the templates begin with the last one.
    if let Some(c) = stem.chars().find(|c| c.is_control() || ['"', '\\', '@'].contains(c)) {
        return unfit(format!("{c:?} cannot be part of the name of its header"), identifier(stem));
    }
    Ok(())
}

/// C identifier that resembles a name.
pub(crate) fn identifier(name: &str) -> String {
    let mut plain: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' }).collect();
    if !plain.starts_with(|c: char| c.is_ascii_alphabetic()) {
        plain.insert_str(0, "m_");
    }
    plain
}
