//! Report of an import: the outcome of every element of the source, and the errors.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::fmt;

use hardpoint_file::{Diagnostic, Severity, Source};
use serde::Serialize;

/// Maximum number of entries of one outcome in the text report; further ones are counted.
const LISTED: usize = 40;
/// Maximum number of kinds whose further entries are counted by kind.
const KINDS_COUNTED: usize = 10;
/// Maximum number of errors that are rendered; further ones are counted.
const SHOWN: usize = 50;
/// Maximum number of errors that are recorded; further ones are counted only.
const MOST_PROBLEMS: usize = 200;
/// Distance of the marks in a text, bytes. Each mark stores the number of characters before it.
const MARK: usize = 1024;

/// Outcome of an element of the source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ElementOutcome {
    /// Imported exactly.
    Taken,
    /// Imported approximately, or added.
    Approximated,
    /// Not imported: no effect on the motion.
    Ignored,
    /// Not imported: the model does not support it.
    Refused,
    /// Not imported: unknown to the importer, possibly with an effect on the motion.
    NotUnderstood,
}

/// Position in a source: byte range of one of its texts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct SourceSpan {
    /// Index of the text: 0 is the file itself, included files follow.
    pub text: usize,
    /// First byte.
    pub start: usize,
    /// Byte after the last one.
    pub end: usize,
}

/// Position as file, line and column.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SourceLocation {
    /// Name of the file.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

/// Outcome of one element.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Entry {
    /// Outcome.
    pub fate: ElementOutcome,
    /// Kind in the source: `joint`, `PART`.
    pub kind: String,
    /// Name in the source, or empty.
    pub name: String,
    /// Position in the source.
    pub place: Option<SourceLocation>,
    /// Reason or explanation; may be empty.
    pub why: String,
}

/// Outcomes of every element of a source.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Report {
    /// Description of the source: file name and format.
    pub format: String,
    /// Remarks about the mechanism as a whole, which are printed first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub remarks: Vec<String>,
    /// Entries in the order of the import.
    pub entries: Vec<Entry>,
}

impl Report {
    /// Returns the entries of one outcome.
    pub fn of(&self, fate: ElementOutcome) -> impl Iterator<Item = &Entry> {
        self.entries.iter().filter(move |e| e.fate == fate)
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.format)?;
        for remark in &self.remarks {
            writeln!(f, "  note: {remark}")?;
        }
        self.listed(
            f,
            ElementOutcome::NotUnderstood,
            "not understood and not imported; may affect the motion",
        )?;
        for (fate, title) in
            [(ElementOutcome::Taken, "taken"), (ElementOutcome::Ignored, "no effect on the motion")]
        {
            let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
            for e in self.of(fate) {
                *counts.entry(&e.kind).or_default() += 1;
            }
            if !counts.is_empty() {
                let list: Vec<String> = counts.iter().map(|(kind, n)| format!("{n} {kind}")).collect();
                writeln!(f, "  {title}: {}", list.join(", "))?;
            }
        }
        self.listed(f, ElementOutcome::Approximated, "approximated or added")?;
        self.listed(f, ElementOutcome::Refused, "refused")
    }
}

impl Report {
    /// Writes the entries of one outcome, one per line. Of a long list at least one of each kind is written, as far as
    /// there is room, and the others are counted.
    fn listed(&self, f: &mut fmt::Formatter<'_>, fate: ElementOutcome, title: &str) -> fmt::Result {
        let list: Vec<&Entry> = self.of(fate).collect();
        if list.is_empty() {
            return Ok(());
        }
        writeln!(f, "  {title}:")?;
        let mut kinds = BTreeSet::new();
        let (first, others): (Vec<usize>, Vec<usize>) =
            (0..list.len()).partition(|k| kinds.insert(list[*k].kind.as_str()));
        let mut shown: Vec<usize> = first.iter().chain(&others).copied().take(LISTED).collect();
        shown.sort_unstable();
        for &k in &shown {
            writeln!(f, "    {}", list[k])?;
        }
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for e in first.iter().chain(&others).skip(LISTED).map(|k| list[*k]) {
            *counts.entry(&e.kind).or_default() += 1;
        }
        if !counts.is_empty() {
            let list: Vec<String> =
                counts.iter().take(KINDS_COUNTED).map(|(kind, n)| format!("{n} {kind}")).collect();
            let end = if counts.len() > KINDS_COUNTED { ", ..." } else { "" };
            let count: usize = counts.values().sum();
            writeln!(f, "    ... and {count} more: {}{end}", list.join(", "))?;
        }
        Ok(())
    }
}

impl fmt::Display for SourceLocation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.file, self.line, self.column)
    }
}

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = &self.place {
            write!(f, "{place}: ")?;
        }
        f.write_str(&self.kind)?;
        if !self.name.is_empty() {
            write!(f, " `{}`", self.name)?;
        }
        if !self.why.is_empty() {
            write!(f, ": {}", self.why)?;
        }
        Ok(())
    }
}

/// Errors of a source, in the order of its text.
#[derive(Clone, Debug)]
pub struct ImportErrors {
    sources: Vec<Source>,
    list: Vec<(usize, Diagnostic)>,
    /// Number of errors that were not recorded.
    dropped: usize,
}

impl ImportErrors {
    /// Returns the diagnostics; never empty.
    pub fn list(&self) -> impl Iterator<Item = &Diagnostic> {
        self.list.iter().map(|(_, d)| d)
    }

    /// Renders all errors for a terminal; with `color`, uses ANSI escapes.
    pub fn render(&self, color: bool) -> String {
        let shown = self.list.iter().take(SHOWN);
        let mut list: Vec<String> = shown.map(|(k, d)| self.sources[*k].render(d, color)).collect();
        if self.list.len() > SHOWN {
            list.push(format!("... and {} more like these", self.list.len() - SHOWN + self.dropped));
        }
        list.join("\n\n")
    }
}

impl fmt::Display for ImportErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for ImportErrors {}

/// Log of an import in progress.
#[derive(Debug)]
pub struct ImportLog {
    /// Texts of the source.
    sources: Vec<Source>,
    /// Indexes of the lines and characters of these texts.
    indexes: Vec<Index>,
    /// Outcomes so far.
    pub report: Report,
    /// Errors, each of which prevents the import.
    problems: Vec<(usize, Diagnostic)>,
    /// Text, line, column and message of the recorded errors.
    known: HashSet<(usize, Option<usize>, Option<usize>, String)>,
    /// Number of errors that were not recorded.
    dropped: usize,
}

/// Index of the lines and characters of a text, so that the time to find a position does not depend on its length.
#[derive(Debug)]
struct Index {
    /// First bytes of the lines.
    lines: Vec<usize>,
    /// Number of characters before each multiple of [`MARK`] bytes.
    marks: Vec<usize>,
}

impl Index {
    fn new(text: &str) -> Self {
        let bytes = text.as_bytes();
        let ends = bytes.iter().enumerate().filter(|(_, b)| **b == b'\n').map(|(k, _)| k + 1);
        let lines = std::iter::once(0).chain(ends).collect();
        let (mut marks, mut count) = (vec![0], 0);
        for block in bytes.chunks(MARK) {
            count += begins(block);
            marks.push(count);
        }
        Self { lines, marks }
    }

    /// Returns the number of characters that begin before a byte.
    fn before(&self, text: &str, at: usize) -> usize {
        let block = at / MARK;
        self.marks[block] + begins(&text.as_bytes()[block * MARK..at])
    }

    /// Returns the line and the column in characters of a byte, from 1.
    fn line_column(&self, text: &str, at: usize) -> (usize, usize) {
        let at = at.min(text.len());
        let line = self.lines.partition_point(|start| *start <= at);
        (line, self.before(text, at) - self.before(text, self.lines[line - 1]) + 1)
    }
}

/// Returns the number of characters that begin in these bytes.
fn begins(bytes: &[u8]) -> usize {
    bytes.iter().filter(|b| **b & 0xc0 != 0x80).count()
}

impl ImportLog {
    /// Creates an empty log for a file.
    pub fn new(file: &str, text: &str) -> Self {
        let sources = vec![Source::new(&printable(file), text)];
        let indexes = vec![Index::new(text)];
        let (report, problems) = (Report::default(), Vec::new());
        Self { sources, indexes, report, problems, known: HashSet::new(), dropped: 0 }
    }

    /// Adds an included text and returns its index.
    pub fn text(&mut self, file: &str, text: &str) -> usize {
        self.sources.push(Source::new(&printable(file), text));
        self.indexes.push(Index::new(text));
        self.sources.len() - 1
    }

    /// Converts a position to file, line and column.
    pub fn place(&self, at: SourceSpan) -> Option<SourceLocation> {
        let source = self.sources.get(at.text)?;
        let (line, column) = self.indexes[at.text].line_column(&source.text, at.start);
        Some(SourceLocation { file: source.file.to_string(), line, column })
    }

    /// Creates an error at a position, or for the file as a whole.
    pub fn diagnostic(
        &self,
        code: &'static str,
        at: Option<SourceSpan>,
        message: impl AsRef<str>,
    ) -> Diagnostic {
        let source = &self.sources[at.map_or(0, |at| at.text)];
        let span = at.map(|at| at.start..at.end);
        source.diagnostic(Severity::Error, code, printable(message.as_ref()), span)
    }

    /// Records an error with the default help of its code.
    pub fn problem(&mut self, code: &'static str, at: Option<SourceSpan>, message: impl AsRef<str>) {
        let help = match code {
            "HP0803" => "correct the name, or export the file again",
            "HP0804" => "correct the value, or export the file again",
            _ => "export the file again",
        };
        if self.problems.len() >= MOST_PROBLEMS {
            // The position is not computed, since the error is not shown.
            self.dropped += 1;
            return;
        }
        let diagnostic = self.diagnostic(code, at, message).help(help);
        self.push_problem(at.map_or(0, |at| at.text), diagnostic);
    }

    /// Records an error with its help.
    pub fn problem_with(
        &mut self,
        code: &'static str,
        at: Option<SourceSpan>,
        message: impl AsRef<str>,
        help: &str,
    ) {
        if self.problems.len() >= MOST_PROBLEMS {
            // The position is not computed, since the error is not shown.
            self.dropped += 1;
            return;
        }
        let diagnostic = self.diagnostic(code, at, message).help(help);
        self.push_problem(at.map_or(0, |at| at.text), diagnostic);
    }

    fn push_problem(&mut self, text: usize, diagnostic: Diagnostic) {
        let key = (text, diagnostic.line, diagnostic.column, diagnostic.message.clone());
        if self.known.insert(key) {
            self.problems.push((text, diagnostic));
        }
    }

    /// Number of errors.
    pub fn problem_count(&self) -> usize {
        self.problems.len()
    }

    /// Returns all errors, if there are any.
    pub fn problems(&mut self) -> Option<ImportErrors> {
        if self.problems.is_empty() {
            return None;
        }
        let mut list = std::mem::take(&mut self.problems);
        list.sort_by_key(|(k, d)| (*k, d.line, d.column));
        Some(ImportErrors { sources: self.sources.clone(), list, dropped: self.dropped })
    }

    /// Returns a single error for the file as a whole.
    pub fn single_error(&self, diagnostic: Diagnostic) -> ImportErrors {
        ImportErrors { sources: self.sources.clone(), list: vec![(0, diagnostic)], dropped: 0 }
    }

    fn entry(&mut self, fate: ElementOutcome, kind: &str, name: &str, at: Option<SourceSpan>, why: &str) {
        let [kind, name, why] = [kind, name, why].map(printable);
        let place = at.and_then(|at| self.place(at));
        self.report.entries.push(Entry { fate, kind, name, place, why });
    }

    /// Records an element that is imported exactly.
    pub fn taken(&mut self, kind: &str, name: &str, at: Option<SourceSpan>) {
        self.entry(ElementOutcome::Taken, kind, name, at, "");
    }

    /// Records an element that is imported approximately, or an addition.
    pub fn approximated(&mut self, kind: &str, name: &str, at: Option<SourceSpan>, why: impl AsRef<str>) {
        self.entry(ElementOutcome::Approximated, kind, name, at, why.as_ref());
    }

    /// Records an element without effect on the motion.
    pub fn ignored(&mut self, kind: &str, at: Option<SourceSpan>) {
        self.entry(ElementOutcome::Ignored, kind, "", at, "");
    }

    /// Adds a remark about the mechanism as a whole.
    pub fn remark(&mut self, remark: impl AsRef<str>) {
        self.report
            .remarks
            .push(remark.as_ref().chars().map(|c| if c.is_control() { ' ' } else { c }).collect());
    }

    /// Records an unknown element, which may affect the motion.
    pub fn not_understood(&mut self, kind: &str, name: &str, at: Option<SourceSpan>, why: impl AsRef<str>) {
        self.entry(ElementOutcome::NotUnderstood, kind, name, at, why.as_ref());
    }

    /// Records an element that the model does not support.
    pub fn refused(&mut self, kind: &str, name: &str, at: Option<SourceSpan>, why: impl AsRef<str>) {
        self.entry(ElementOutcome::Refused, kind, name, at, why.as_ref());
    }
}

/// Returns a text of the source on one line, limited in length.
pub fn printable(text: &str) -> String {
    const LONGEST: usize = 300;
    let mut out: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).take(LONGEST).collect();
    if text.chars().count() > LONGEST {
        out.push_str("...");
    }
    out
}
