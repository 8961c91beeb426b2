//! Statements of Adams/Solver datasets: names, numbers, keys with values, and flags, on any number of lines.

use hardpoint::space::Vec3;

use crate::adams_keys::{self, Keys};
use crate::markers::ElementSource;
use crate::report::{ImportLog, SourceSpan};

/// Mark at the beginning of a continuation line: a blank, or within a function possibly a comma.
pub const SEAM: char = '\u{1}';

/// Statement: `NAME/id, KEY = values, FLAG, ...`.
#[derive(Debug, Default)]
pub struct Statement {
    /// Name in capital letters, not abbreviated.
    pub name: String,
    /// Number after the slash.
    pub id: String,
    /// Position in the source.
    pub at: SourceSpan,
    /// Name in Adams/View, from the comment before the statement.
    pub label: String,
    /// Keys in capital letters, with the text after the equals sign; the text of flags is empty. Known keys are not
    /// abbreviated.
    pub keys: Vec<(String, String)>,
}

impl Statement {
    /// Value of a key.
    pub fn text(&self, key: &str) -> Option<&str> {
        self.keys.iter().find(|(k, _)| k == key).map(|(_, v)| v.as_str())
    }

    /// Returns true if the statement has a key or a flag.
    pub fn has(&self, key: &str) -> bool {
        self.text(key).is_some()
    }

    /// Name and position for reports.
    pub fn source(&self) -> ElementSource<'_> {
        ElementSource { kind: &self.name, name: &self.label, at: Some(self.at) }
    }

    /// Returns the numbers of a key; angles in rad. Errors are reported.
    pub fn numbers(&self, key: &str, notes: &mut ImportLog) -> Option<Vec<f64>> {
        let text = self.text(key)?;
        let words =
            text.split(|c: char| c == ',' || c == SEAM || c.is_whitespace()).filter(|w| !w.is_empty());
        let list: Option<Vec<f64>> = words.map(number).collect();
        if list.is_none() {
            let text = text.replace(SEAM, " ");
            notes.problem(
                "HP0804",
                Some(self.at),
                format!("`{key}` of {}/{} is not a list of numbers: `{}`", self.name, self.id, text.trim()),
            );
        }
        list
    }

    /// Returns the three numbers of a key.
    pub fn vector(&self, key: &str, notes: &mut ImportLog) -> Option<Vec3> {
        let list = self.numbers(key, notes)?;
        match <[f64; 3]>::try_from(list) {
            Ok(v) => Some(v.into()),
            Err(list) => {
                notes.problem(
                    "HP0804",
                    Some(self.at),
                    format!("`{key}` of {}/{} must be three numbers, not {}", self.name, self.id, list.len()),
                );
                None
            }
        }
    }

    /// Returns the identifier that a key refers to.
    pub fn reference<'s>(&'s self, key: &str) -> Option<&'s str> {
        self.text(key).map(str::trim)
    }
}

/// Reads a number. `30D` is an angle in degrees; exponents are those of Fortran.
pub fn number(word: &str) -> Option<f64> {
    let lower = word.to_ascii_lowercase();
    let degrees = lower.strip_suffix('d');
    let value: f64 = degrees.unwrap_or(&lower).replace('d', "e").parse().ok()?;
    let value = if degrees.is_some() { value.to_radians() } else { value };
    value.is_finite().then_some(value)
}

/// Dataset, without comments.
#[derive(Debug, Default)]
pub struct Dataset {
    /// Statements up to `END`.
    pub statements: Vec<Statement>,
    /// Lines up to `END` that are not statements, with their positions.
    pub unread: Vec<(SourceSpan, String)>,
    /// True if the dataset has the statement `END`.
    pub has_end: bool,
    /// First line after `END` that is not a comment.
    pub after_end: Option<SourceSpan>,
}

/// Reads a dataset; continuation lines are joined.
pub fn dataset(text: &str) -> Dataset {
    let mut out = Dataset::default();
    let mut lines: Vec<(SourceSpan, String, String)> = Vec::new();
    let mut label = String::new();
    let (mut start, mut is_first) = (0, true);
    for whole in text.split_inclusive('\n') {
        let line = whole.trim_end_matches(['\n', '\r']);
        let from = start + line.len() - line.trim_start().len();
        let at = SourceSpan { text: 0, start: from, end: start + line.trim_end().len() };
        start += whole.len();
        let (code, remark) = line.split_once('!').unwrap_or((line, ""));
        if let Some((_, name)) = remark.split_once("adams_view_name=") {
            label = name.trim().trim_matches(['\'', '"']).to_owned();
        }
        let code = code.trim();
        // The first line is a title, unless the title is missing.
        let is_title = is_first && (code.to_ascii_uppercase().starts_with("ADAMS") || head(code).is_none());
        is_first &= line.trim().is_empty();
        if code.is_empty() || is_title {
            continue;
        }
        if out.has_end {
            out.after_end.get_or_insert(at);
            continue;
        }
        if code.trim_end_matches([';', ' ']).eq_ignore_ascii_case("END") {
            out.has_end = true;
            continue;
        }
        // A statement continues if the next line begins with a comma or `&`, or if its line ends with one.
        let goes_on = lines.last().is_some_and(|l| l.1.ends_with([',', '&']));
        let rest = code.strip_prefix([',', '&']).or(goes_on.then_some(code));
        match (rest, lines.last_mut()) {
            (Some(rest), Some(last)) => {
                let kept = last.1.trim_end_matches('&').len();
                last.1.truncate(kept);
                last.1.push(SEAM);
                last.1.push_str(rest);
            }
            _ => lines.push((at, code.to_owned(), std::mem::take(&mut label))),
        }
    }
    for (at, code, label) in lines {
        match statement(at, &code, &label) {
            Some(statement) => out.statements.push(statement),
            None => out.unread.push((at, code)),
        }
    }
    out
}

/// Splits a statement into its name and the text after the slash; `None` for other lines.
fn head(code: &str) -> Option<(&str, &str)> {
    let end = code.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(code.len());
    let (name, rest) = code.split_at(end);
    rest.trim_start().strip_prefix('/').filter(|_| !name.is_empty()).map(|rest| (name, rest))
}

fn statement(at: SourceSpan, code: &str, label: &str) -> Option<Statement> {
    let (name, rest) = head(code.trim_end_matches([';', ' ']))?;
    let name = name.to_ascii_uppercase();
    let name = adams_keys::statement_name(&name);
    let known = adams_keys::of(&name);
    let mut out = Statement { name, at, ..Statement::default() };
    for part in parts_of(rest, known) {
        let part = part.trim_matches(|c: char| c.is_whitespace() || c == SEAM);
        let keyed = part.split_once('=').filter(|(key, _)| {
            let key = key.trim_matches(|c: char| c.is_whitespace() || c == SEAM);
            !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '\\')
        });
        if let Some((key, text)) = keyed {
            let key = key.trim_matches(|c: char| c.is_whitespace() || c == SEAM);
            out.keys.push((full(key, known, false), text.trim().to_owned()));
        } else if out.keys.is_empty() && out.id.is_empty() && part.chars().all(|c| c.is_ascii_digit()) {
            out.id = part.to_owned();
        } else {
            // A further value of the previous key, or a flag.
            let is_value = part.chars().next().is_some_and(|c| c.is_ascii_digit() || "+-.(".contains(c));
            match out.keys.last_mut() {
                Some((key, text))
                    if !text.is_empty() && (is_value || key == FUNCTION) && !is_flag(part, known) =>
                {
                    text.push(',');
                    text.push_str(part);
                }
                _ if part.is_empty() => {}
                _ => out.keys.push((full(part, known, true), String::new())),
            }
        }
    }
    out.label = if label.is_empty() { format!("{}_{}", out.name, out.id) } else { label.to_owned() };
    Some(out)
}

/// Key of a function, which may contain commas.
const FUNCTION: &str = "FUNCTION";

/// Returns the full name of a key, in capital letters.
fn full(written: &str, known: Option<&Keys>, is_flag: bool) -> String {
    let upper = written.to_ascii_uppercase();
    known.and_then(|keys| keys.named(&upper, is_flag)).map_or(upper, str::to_owned)
}

/// Returns true for a flag of the statement.
fn is_flag(word: &str, known: Option<&Keys>) -> bool {
    known.is_some_and(|keys| keys.flag_after_function(&word.to_ascii_uppercase()).is_some())
}

/// Splits a text at commas outside parentheses, at backslashes, and at seams before a key or flag. Within a list or a
/// function, the comma at the beginning of a continuation line only marks the continuation.
fn parts_of(text: &str, known: Option<&Keys>) -> Vec<String> {
    let (mut out, mut depth) = (vec![String::new()], 0_i32);
    let chars: Vec<char> = text.chars().collect();
    for (k, c) in chars.iter().enumerate() {
        depth += i32::from(*c == '(') - i32::from(*c == ')');
        let is_function = || {
            out.last().is_some_and(|part| {
                let key = part.split('=').next().unwrap_or_default().trim_matches([' ', '\t', SEAM]);
                part.contains('=') && full(key, known, false) == FUNCTION
            })
        };
        let begins = || {
            let rest: String = chars[k + 1..].iter().take(60).collect();
            let rest = rest.trim_start();
            let word =
                rest.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).next().unwrap_or_default();
            let behind = rest[word.len()..].trim_start_matches([' ', '\t']).chars().next();
            let ends = behind.is_none_or(|c| [',', SEAM, '\\'].contains(&c));
            let is_flag = is_flag(word, known);
            let is_word = word.starts_with(|c: char| c.is_ascii_alphabetic());
            is_word && (behind == Some('=') || (ends && (is_flag || !is_function())))
        };
        let parts = (*c == ',' && depth <= 0) || *c == '\\' || (*c == SEAM && depth <= 0 && begins());
        match out.last_mut() {
            Some(last) if !parts => last.push(*c),
            _ => out.push(String::new()),
        }
    }
    out
}
