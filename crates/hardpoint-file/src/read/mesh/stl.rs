//! STL, as text and binary.

use std::io::Cursor;

use super::Triangles;

/// First word of a text file, and sometimes of binary files too.
const SOLID: &[u8] = b"solid";
/// Bytes before the triangles of a binary file: a remark, and their number.
const HEADER: usize = 84;
/// Bytes of one of them.
const TRIANGLE: usize = 50;

pub(super) fn load(bytes: &[u8], into: &mut Triangles) -> Result<(), String> {
    // The remark of a binary file may begin like a text; a text need not give its solid a name.
    let count = bytes.get(80..HEADER).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes);
    let is_binary = count.is_some_and(|n| (n as usize).checked_mul(TRIANGLE) == Some(bytes.len() - HEADER));
    let (begin, rest) = match bytes.strip_prefix(SOLID) {
        Some(rest) if is_binary => (&b"     "[..], rest),
        Some(rest) => (&b"solid "[..], rest),
        None => (&b""[..], bytes),
    };
    let mut read = Cursor::new([begin, rest].concat());
    for triangle in stl_io::create_stl_reader(&mut read).map_err(|e| e.to_string())? {
        let triangle = triangle.map_err(|e| e.to_string())?;
        into.push(triangle.vertices.map(|v| v.0.map(f64::from)))?;
    }
    Ok(())
}
