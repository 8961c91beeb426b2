//! Names of the parts of two sides: one rule for `[mirror]` and for importers that write it.

/// Words of the left and the right side.
pub const WORDS: [&str; 2] = ["left", "right"];

/// Pieces of a name: words and separators.
pub fn pieces(name: &str) -> impl Iterator<Item = &str> {
    let mut rest = name;
    std::iter::from_fn(move || {
        let first = rest.chars().next()?;
        let end = match first.is_alphanumeric() {
            true => rest.find(|c: char| !c.is_alphanumeric()).unwrap_or(rest.len()),
            false => first.len_utf8(),
        };
        let (piece, after) = rest.split_at(end);
        rest = after;
        Some(piece)
    })
}

/// Exchanges every word of a side in a name for its counterpart, if there is any. The exchange is its own inverse, so
/// that different names stay different, unless two words have the same counterpart.
pub fn exchanged<W: AsRef<str>>(name: &str, words: &[(W, W)]) -> Option<String> {
    let counterpart = |piece: &str| {
        let there = words.iter().find(|(one, _)| one.as_ref() == piece).map(|w| w.1.as_ref());
        there.or_else(|| words.iter().find(|(_, other)| other.as_ref() == piece).map(|w| w.0.as_ref()))
    };
    let is_sided = pieces(name).any(|piece| counterpart(piece).is_some());
    is_sided.then(|| pieces(name).map(|piece| counterpart(piece).unwrap_or(piece)).collect())
}

/// Returns whether a name belongs to the written side, by the first word of a side in it; `None` without such a word.
pub fn is_original<W: AsRef<str>>(name: &str, words: &[(W, W)]) -> Option<bool> {
    pieces(name).find_map(|piece| {
        let is_one = words.iter().any(|(one, _)| one.as_ref() == piece);
        (is_one || words.iter().any(|(_, other)| other.as_ref() == piece)).then_some(is_one)
    })
}
