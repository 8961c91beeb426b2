//! Diagnostics with message, position in the text and suggested fix, in the style of `rustc`.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use serde::Serialize;

/// Maximum number of diagnostics that are shown; the others are counted.
const SHOWN: usize = 50;
/// Lines longer than this are not shown, only named.
const LONG_LINE: usize = 2000;
/// Texts from the file are cut to this many characters inside messages.
const SHOWN_NAME: usize = 60;

/// Severity of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The model cannot be solved before it is corrected.
    Error,
    /// The result may not be what the user intends.
    Warning,
    /// Information without a problem.
    Note,
}

/// A diagnostic of a model file.
///
/// The JSON form is the same for the command (`--json`), the page and Python: `{severity, code, message, file, line,
/// column, length, element, label, notes, help}`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Diagnostic {
    /// Severity.
    pub severity: Severity,
    /// Stable code; `docs/diagnostics.md` lists them.
    pub code: &'static str,
    /// Message, understandable by itself.
    pub message: String,
    /// File name as given.
    pub file: String,
    /// Line of the file, from 1; `None` for the file as a whole.
    pub line: Option<usize>,
    /// Column of the line in characters, from 1.
    pub column: Option<usize>,
    /// Number of underlined characters.
    pub length: Option<usize>,
    /// Name of the underlined entry: the last part of a key, or a name in quotes.
    pub element: Option<String>,
    /// Underlined range of the text, in bytes.
    #[serde(skip)]
    pub span: Option<Range<usize>>,
    /// Text at the underlined position.
    pub label: Option<String>,
    /// Notes: facts with units.
    pub notes: Vec<String>,
    /// Suggested fix.
    pub help: Option<String>,
}

impl Diagnostic {
    /// Adds a note.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(printable(note.into()));
        self
    }

    /// Sets the suggested fix.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(printable(help.into()));
        self
    }

    /// Sets the text at the underlined position.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = Some(printable(label.into()));
        self
    }
}

/// All diagnostics of a file, in the order of the text.
#[derive(Clone, Debug)]
pub struct Diagnostics {
    source: Source,
    list: Vec<Diagnostic>,
}

/// Sorts diagnostics in the order of the text and removes duplicates; those of the file as a whole come first.
pub(crate) fn in_order(mut list: Vec<Diagnostic>) -> Vec<Diagnostic> {
    list.sort_by_key(|d| d.span.as_ref().map(|s| (s.start, s.end)));
    for d in &mut list {
        d.help = d.help.take().or_else(|| remedy(d.code).map(Into::into));
        let texts = d.notes.iter_mut().chain(&mut d.help).chain(&mut d.label);
        texts.for_each(|text| *text = printable(std::mem::take(text)));
    }
    list.dedup_by(|a, b| (a.code, &a.span, &a.message) == (b.code, &b.span, &b.message));
    list
}

impl Diagnostics {
    pub(crate) fn new(source: Source, list: Vec<Diagnostic>) -> Self {
        Self { source, list: in_order(list) }
    }

    /// Diagnostics, at least one.
    pub fn list(&self) -> &[Diagnostic] {
        &self.list
    }

    /// Renders all diagnostics for a terminal; with `color`, with ANSI escapes.
    pub fn render(&self, color: bool) -> String {
        let mut text = String::new();
        for d in self.list.iter().take(SHOWN) {
            text.push_str(&self.source.render(d, color));
            text.push_str("\n\n");
        }
        if self.list.len() > SHOWN {
            text.push_str(&format!("... and {} more like these\n\n", self.list.len() - SHOWN));
        }
        text.push_str(&match self.list.len() {
            1 => format!("{}: 1 problem", self.source.file),
            n => format!("{}: {n} problems", self.source.file),
        });
        text
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Diagnostics {}

impl Serialize for Diagnostics {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.list.serialize(serializer)
    }
}

/// Name and text of a file with its line starts, followed by the included files, so that a position in the text
/// identifies the file.
#[derive(Clone, Debug)]
pub struct Source {
    /// Name as given.
    pub file: Arc<str>,
    /// Text.
    pub text: Arc<str>,
    /// Start of each line.
    lines: Arc<[usize]>,
    /// Names of all files, with their ranges.
    files: Arc<[(String, Range<usize>)]>,
}

impl Source {
    /// Source of a file with this name and text.
    pub fn new(file: &str, text: &str) -> Self {
        Self::of_files(file, text, std::iter::empty())
    }

    /// Source of a file with its included files, by name and text.
    pub fn of_files<'t>(file: &str, text: &str, others: impl Iterator<Item = (String, &'t str)>) -> Self {
        let file = printable(file.to_owned());
        let (mut all, mut files) = (text.to_owned(), vec![(file.clone(), 0..text.len())]);
        for (name, text) in others {
            all.push('\n');
            files.push((printable(name), all.len()..all.len() + text.len()));
            all += text;
        }
        let lines = std::iter::once(0).chain(all.match_indices('\n').map(|(k, _)| k + 1)).collect();
        Self { file: file.into(), text: all.into(), lines, files: files.into() }
    }

    /// Range of a file in the joint text; file 0 is the requested one.
    pub fn range(&self, file: usize) -> Range<usize> {
        self.files[file].1.clone()
    }

    /// Name and start of the file that contains a byte.
    fn file_at(&self, at: usize) -> (&str, usize) {
        let k = self.files.partition_point(|(_, range)| range.start <= at).saturating_sub(1);
        (&self.files[k].0, self.files[k].1.start)
    }

    /// Line and column of a byte in its file, both from 1, the column in characters.
    pub fn line_column(&self, at: usize) -> (usize, usize) {
        let at = self.boundary(at);
        let line = self.lines.partition_point(|&start| start <= at) - 1;
        let first = self.lines.partition_point(|&start| start <= self.file_at(at).1) - 1;
        (line - first + 1, self.text[self.lines[line]..at].chars().count() + 1)
    }

    /// Creates a diagnostic at a range of the text, or for the file as a whole.
    pub fn diagnostic(
        &self,
        severity: Severity,
        code: &'static str,
        message: impl Into<String>,
        span: Option<Range<usize>>,
    ) -> Diagnostic {
        let span = span.map(|s| {
            let start = self.boundary(s.start);
            start..self.boundary(s.end).max(start)
        });
        let (line, column) = span.as_ref().map(|s| self.line_column(s.start)).unzip();
        let underlined = span.as_ref().map(|s| &self.text[s.clone()]);
        // The name of `[joints.hinge]` is its last part.
        let name = underlined.map(|text| text.rsplit('.').next().unwrap_or(text).trim_matches('"'));
        Diagnostic {
            severity,
            code,
            message: printable(message.into()),
            file: span.as_ref().map_or(&*self.file, |s| self.file_at(s.start).0).to_owned(),
            line,
            column,
            length: underlined.map(|text| text.chars().count()),
            element: name.filter(|name| !name.contains(['\n', '='])).map(str::to_owned),
            span,
            label: None,
            notes: Vec::new(),
            help: None,
        }
    }

    /// Renders one diagnostic. Only the lines around it are passed to the renderer, so that the cost does not depend on
    /// the size of the file.
    pub fn render(&self, d: &Diagnostic, color: bool) -> String {
        let level = match d.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
            Severity::Note => Level::NOTE,
        };
        let mut group: Group<'_> = Group::with_title(level.primary_title(d.message.as_str()).id(d.code));
        let window = d.span.as_ref().map(|s| (s, self.window(s)));
        group = match (window, d.line, d.column) {
            (Some((span, window)), Some(line), Some(column)) => {
                if window.len() > LONG_LINE {
                    group.element(Origin::path(d.file.as_str()).line(line).char_column(column))
                } else {
                    let inside = span.start - window.start..span.end.min(window.end) - window.start;
                    let annotation = AnnotationKind::Primary.span(inside).label(d.label.as_deref());
                    group.element(
                        Snippet::source(&self.text[window])
                            .path(d.file.as_str())
                            .line_start(line)
                            .annotation(annotation),
                    )
                }
            }
            _ => group.element(Origin::path(d.file.as_str())),
        };
        group = group.elements(d.notes.iter().map(|n| Level::NOTE.message(n.as_str())));
        group = group.elements(d.help.iter().map(|h| Level::HELP.message(h.as_str())));
        let renderer = if color { Renderer::styled() } else { Renderer::plain() };
        renderer.render(&[group])
    }

    /// Complete lines of a span; for a long span, the first line only.
    fn window(&self, span: &Range<usize>) -> Range<usize> {
        let first = self.lines.partition_point(|&start| start <= span.start) - 1;
        let last = self.lines.partition_point(|&start| start < span.end.max(span.start + 1)) - 1;
        let last = if last - first > 4 { first } else { last };
        let end = self.lines.get(last + 1).map_or(self.text.len(), |next| next - 1);
        self.lines[first]..end
    }

    fn boundary(&self, at: usize) -> usize {
        self.text.floor_char_boundary(at.min(self.text.len()))
    }
}

/// General instruction for an error without a more specific one; `docs/diagnostics.md` has details. Every error of a
/// model file has one.
fn remedy(code: &str) -> Option<&'static str> {
    Some(match code {
        "HP0101" => "check the path, and that the file is a text of at most 64 MiB that you may read",
        "HP0102" => {
            "check this place and the text before it: mostly a quote, a bracket, a comma or `=` is missing or superfluous"
        }
        "HP0103" => "correct the spelling, or remove the key",
        "HP0104" => "add the key; `docs/file-format.md` shows an example of each table",
        "HP0105" => "write the value as `docs/file-format.md` describes it",
        "HP0106" => "write one of the words listed",
        "HP0107" => "remove one of the two keys",
        "HP0108" => "correct the underlined part; `docs/file-format.md` lists the functions",
        "HP0109" => "correct the number",
        "HP0110" => "correct the underlined part; `docs/file-format.md` describes each kind of law",
        "HP0111" => "put the file into the folder of the model file, and name it from there",
        "HP0112" => "correct that line of the file, or choose other `columns`",
        "HP0113" => "correct the underlined part; `docs/file-format.md` lists the names in expressions",
        "HP0115" => "export the body again as STL, OBJ or GLB, as triangles",
        "HP0116" => "correct `mirror`; `docs/file-format.md` describes it",
        "HP0117" => "include each file where it is needed, and none in itself",
        "HP0201" => "choose another name",
        "HP0202" => "give finite numbers",
        "HP0203" => "declare a body besides `ground`, like `[bodies]` with `crank = {}`",
        "HP0204" => "correct the name, or declare what it names",
        "HP0205" => "give a non-zero vector, or two different hardpoints",
        "HP0206" => "choose a third point off the x axis",
        "HP0207" => "name two different bodies",
        "HP0208" => "add the axis if the joint's type needs it, else remove it",
        "HP0209" => "correct one of the two axes",
        "HP0210" => {
            "give the number of locations that the joint's type needs; `docs/file-format.md` lists them"
        }
        "HP0211" => "move one end, or use a spherical joint",
        "HP0212" => "connect the body with a joint, or remove it",
        "HP0213" => "name one of the joint's coordinates",
        "HP0214" => "change the law or the output times",
        "HP0215" => "remove one of the two drivers",
        "HP0216" => "name another point",
        "HP0217" => "give it a non-zero velocity, or remove it",
        "HP0218" => "name one of the bodies that the joint connects",
        "HP0219" => "give a `[time]` table with times that increase, like `end = 1.0` and `steps = 100`",
        "HP0223" => "remove it, or give a length above zero, a lead other than zero",
        "HP0224" => "give every joint a number other than zero, and name two coordinates",
        "HP0225" => "give the rod a `length`, or move one of its hardpoints",
        "HP0226" => "give three points or more (four, if closed) in one plane perpendicular to `axis`",
        _ if code.starts_with("HP02") => {
            "correct the underlined part; `docs/diagnostics.md` describes this code"
        }
        _ => return None,
    })
}

/// Shortens a text of the file for a message.
pub(crate) fn shown(name: &str) -> String {
    match name.char_indices().nth(SHOWN_NAME) {
        Some((end, _)) => format!("{}...", &name[..end]),
        None => name.to_owned(),
    }
}

/// Control characters in a file must not reach the terminal.
fn printable(text: String) -> String {
    if text.chars().any(char::is_control) {
        text.chars()
            .map(|c| if c.is_control() { c.escape_debug().to_string() } else { c.to_string() })
            .collect()
    } else {
        text
    }
}

/// Most similar candidate; `None` for texts that are too long for a name.
pub(crate) fn closest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if name.len() > 2 * SHOWN_NAME { None } else { hardpoint::draft::did_you_mean(name, candidates) }
}
