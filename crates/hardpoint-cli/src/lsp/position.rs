//! Positions of an editor, as lines and UTF-16 code units, and bytes of a text.

use std::ops::Range;

use serde::{Deserialize, Serialize};

/// Position in a text: line from 0, UTF-16 code units from the start of the line.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
pub struct Position {
    /// Line, from 0.
    pub line: usize,
    /// UTF-16 code units, from 0.
    pub character: usize,
}

/// Range between two positions.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
pub struct TextRange {
    /// First position.
    pub start: Position,
    /// Position after the last.
    pub end: Position,
}

/// Starts of the lines of a text. Lines end with `\n`, `\r\n` or `\r`.
#[derive(Clone, Debug)]
pub struct Lines(Vec<usize>);

impl Lines {
    /// Lines of a text.
    pub fn of(text: &str) -> Self {
        let bytes = text.as_bytes();
        let ends = |at: usize| match bytes[at] {
            b'\n' => true,
            b'\r' => bytes.get(at + 1) != Some(&b'\n'),
            _ => false,
        };
        Self(std::iter::once(0).chain((0..bytes.len()).filter(|at| ends(*at)).map(|at| at + 1)).collect())
    }

    /// Position of a byte; that of the character which contains it.
    pub fn position(&self, text: &str, at: usize) -> Position {
        let at = text.floor_char_boundary(at.min(text.len()));
        let line = self.0.partition_point(|start| *start <= at) - 1;
        let before = &text[self.0[line]..at];
        Position { line, character: before.chars().map(char::len_utf16).sum() }
    }

    /// Byte of a position. A position beyond the end of its line is the end of the line.
    pub fn byte(&self, text: &str, at: Position) -> usize {
        let Some(&start) = self.0.get(at.line) else { return text.len() };
        let end = self.0.get(at.line + 1).copied().unwrap_or(text.len());
        let line = text[start..end].trim_end_matches(['\n', '\r']);
        let mut units = 0;
        for (byte, c) in line.char_indices() {
            if units + c.len_utf16() > at.character {
                return start + byte;
            }
            units += c.len_utf16();
        }
        start + line.len()
    }

    /// Range of bytes as positions.
    pub fn range(&self, text: &str, range: &Range<usize>) -> TextRange {
        TextRange { start: self.position(text, range.start), end: self.position(text, range.end) }
    }

    /// Range of bytes of a diagnostic: line and column in characters from 1, and a number of characters.
    pub fn span(&self, text: &str, line: usize, column: usize, length: usize) -> Range<usize> {
        let start = self.0.get(line.saturating_sub(1)).copied().unwrap_or(text.len());
        let byte = |from: usize, characters: usize| {
            text[from..].char_indices().nth(characters).map_or(text.len(), |(byte, _)| from + byte)
        };
        let first = byte(start, column.saturating_sub(1));
        first..byte(first, length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "a = \"Lenkhebel\"\r\nö = \"🚗x\"\nlast";

    #[test]
    fn characters_count_in_utf_16() {
        let lines = Lines::of(TEXT);
        let at = |needle: &str| lines.position(TEXT, TEXT.find(needle).unwrap());
        assert_eq!(at("ö"), Position { line: 1, character: 0 });
        assert_eq!(at("= \"🚗"), Position { line: 1, character: 2 });
        // A car has two units.
        assert_eq!(at("x"), Position { line: 1, character: 7 });
        assert_eq!(at("last"), Position { line: 2, character: 0 });
    }

    #[test]
    fn positions_and_bytes_agree_at_every_character() {
        for text in [TEXT, "", "\n\n", "\r\r\n\u{feff}é\n", "🚗🚗", "a\rb"] {
            let lines = Lines::of(text);
            for (byte, c) in text.char_indices().filter(|(_, c)| !matches!(c, '\n' | '\r')) {
                let position = lines.position(text, byte);
                assert_eq!(lines.byte(text, position), byte, "{text:?} {c:?}");
            }
            assert_eq!(lines.byte(text, lines.position(text, text.len())), text.len());
        }
    }

    #[test]
    fn invalid_positions_are_moved_into_the_text() {
        let lines = Lines::of(TEXT);
        let byte = |line: usize, character: usize| lines.byte(TEXT, Position { line, character });
        // Beyond the end of a line: before its line end.
        assert_eq!(byte(0, 1000), TEXT.find('\r').unwrap());
        assert_eq!(byte(9, 0), TEXT.len());
        // Within a pair of surrogates: before the character.
        assert_eq!(byte(1, 6), TEXT.find('🚗').unwrap());
    }

    #[test]
    fn diagnostics_count_characters() {
        let lines = Lines::of(TEXT);
        let span = lines.span(TEXT, 2, 5, 4);
        assert_eq!(&TEXT[span.clone()], "\"🚗x\"");
        let range = lines.range(TEXT, &span);
        assert_eq!(range.start, Position { line: 1, character: 4 });
        assert_eq!(range.end, Position { line: 1, character: 9 });
    }
}
