//! Text output: tables, headings, stdout and stderr.

use std::borrow::Cow;
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use comfy_table::{Cell, ColumnConstraint, ContentArrangement, LineStyle, TableStyle, Width};
use hardpoint_report::figures::{is_odd, seconds};
use hardpoint_report::margin::MarginFact;
use hardpoint_report::page::Table;
use hardpoint_report::summary::Summary;

const BOLD: &str = "\x1b[1m";
const RED: &str = "\x1b[1;91m";
const PLAIN: &str = "\x1b[0m";

/// First error of writing to stdout.
static FAILED: Mutex<Option<std::io::Error>> = Mutex::new(None);

/// True if stdout carries the messages of a protocol.
static RESERVED: AtomicBool = AtomicBool::new(false);

/// Reserves stdout for the messages of a protocol: all other text goes to stderr from now on.
pub fn reserve_stdout() {
    RESERVED.store(true, Ordering::SeqCst);
}

/// Prints to stdout, without colours unless it is a terminal. A closed pipe is not an error; any other failure is
/// stored for [`failed`].
pub fn print(text: &str) {
    if RESERVED.load(Ordering::SeqCst) {
        return complain(text);
    }
    let mut out = anstream::stdout().lock();
    if let Err(error) = out.write_all(printable(text).as_bytes()).and_then(|()| out.flush()) {
        note_failure(error);
    }
}

/// Records that stdout could not be written.
pub fn note_failure(error: std::io::Error) {
    if error.kind() != std::io::ErrorKind::BrokenPipe {
        FAILED.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    }
}

/// Error of writing to stdout, if there was one.
pub fn failed() -> Option<std::io::Error> {
    FAILED.lock().unwrap_or_else(PoisonError::into_inner).take()
}

/// Prints to stderr, without colours unless it is a terminal.
pub fn complain(text: &str) {
    let _ = anstream::stderr().lock().write_all(printable(text).as_bytes());
}

/// Escapes control characters and those that change the direction of writing, so that the text is safe on a terminal.
/// Line ends and colour sequences are kept.
fn printable(text: &str) -> Cow<'_, str> {
    if !text.chars().any(|c| c != '\n' && is_odd(c)) {
        return text.into();
    }
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let length = match colour(rest) {
            Some(length) => {
                out.push_str(&rest[..length]);
                length
            }
            None if c != '\n' && is_odd(c) => {
                out.extend(c.escape_unicode());
                c.len_utf8()
            }
            None => {
                out.push(c);
                c.len_utf8()
            }
        };
        rest = &rest[length..];
    }
    out.into()
}

/// Length of the colour sequence at the beginning of the text, if any.
fn colour(text: &str) -> Option<usize> {
    let inside = text.strip_prefix("\x1b[")?;
    let length = inside.find(|c: char| !c.is_ascii_digit() && c != ';')?;
    inside[length..].starts_with('m').then_some(length + 3)
}

/// Escapes a text of the user for display: no control characters for a terminal remain.
pub fn shown(text: &str) -> Cow<'_, str> {
    if text.chars().any(is_odd) {
        text.chars().map(|c| if is_odd(c) { c.escape_unicode().to_string() } else { c.to_string() }).collect()
    } else {
        text.into()
    }
}

/// One argument of a command line, in quotes if a shell would divide or change it.
pub fn argument(text: String) -> String {
    let is_plain =
        |c: char| c.is_alphanumeric() || "_-./+,:@%=\\".contains(c) && (cfg!(windows) || c != '\\');
    match text.chars().all(is_plain) && !text.is_empty() {
        true => text,
        false if cfg!(windows) => format!("\"{text}\""),
        false => format!("'{}'", text.replace('\'', "'\\''")),
    }
}

/// True if stderr shows colours.
pub fn stderr_in_color() -> bool {
    anstream::AutoStream::choice(&std::io::stderr()) != anstream::ColorChoice::Never
}

/// Formats a text in bold.
pub fn bold(text: &str) -> String {
    format!("{BOLD}{}{PLAIN}", shown(text))
}

/// Formats an error that is not about the model file like a diagnostic.
pub fn error(code: &str, message: &str, note: &str, help: &str) -> String {
    format!(
        "{RED}error[{code}]{PLAIN}{BOLD}: {}{PLAIN}\n  {BOLD}= note{PLAIN}: {note}\n  {BOLD}= help{PLAIN}: {help}\n",
        shown(message)
    )
}

/// Labels and values in two aligned columns.
pub fn pairs(rows: &[(&str, String)]) -> String {
    let width = rows.iter().map(|(label, _)| label.chars().count()).max().unwrap_or(0);
    rows.iter().map(|(label, value)| format!("  {label:width$}  {}\n", shown(value))).collect()
}

/// Result of a study: its labelled lines with the duration, s, and its tables.
pub fn study(mut rows: Vec<(&str, String)>, duration: f64, tables: &[Table]) -> String {
    rows.push(("time taken", seconds(duration)));
    format!("\n{}{}", pairs(&rows), tables.iter().map(section).collect::<String>())
}

/// Files that a study wrote, after an empty line: a line for each page, as of a run, then one for all others.
pub fn written(files: &[String]) -> String {
    let (pages, others): (Vec<&String>, Vec<&String>) =
        files.iter().partition(|file| file.ends_with(".html"));
    let pages: String = pages.into_iter().map(|page| format!("report: {page}\n")).collect();
    let others: Vec<&str> = others.into_iter().map(String::as_str).collect();
    if files.is_empty() { pages } else { format!("\n{pages}written: {}\n", others.join(", ")) }
}

/// Notes, one per line, after an empty line.
pub fn notes(summary: &Summary) -> String {
    let ahead = summary.margin.as_ref().and_then(MarginFact::ahead);
    let lines = summary.model.all_notes().into_iter().chain(ahead).chain(summary.left_out.iter().cloned());
    let lines: String = lines.map(|note| format!("{BOLD}note{PLAIN}: {}\n", shown(&note))).collect();
    if lines.is_empty() { lines } else { format!("\n{lines}") }
}

/// Minimum width of a text column in characters, unless all its words are shorter.
const NARROW: usize = 14;
/// Maximum number of characters of a cell.
const LONGEST_CELL: usize = 1000;

/// Formats a table under its title, as wide as the terminal; without a terminal, as wide as its contents.
pub fn table(table: &Table) -> String {
    let mut grid = empty_grid();
    if let Some((terminal_size::Width(width), _)) = terminal_size::terminal_size_of(std::io::stdout()) {
        grid.set_content_arrangement(ContentArrangement::Dynamic).set_width(width);
    }
    laid_out(grid, table)
}

/// Formats a table after an empty line; empty if it has no rows.
pub fn section(of: &Table) -> String {
    if of.rows.is_empty() { String::new() } else { format!("\n{}", table(of)) }
}

fn empty_grid() -> comfy_table::Table {
    let mut grid = comfy_table::Table::new();
    grid.load_style(TableStyle::new().header_separator(LineStyle::none().fill('─').junction('─')));
    grid
}

fn laid_out(mut grid: comfy_table::Table, table: &Table) -> String {
    grid.set_header(table.header.iter().map(|cell| Cell::new(shown(cell))));
    for row in &table.rows {
        grid.add_row(row.iter().map(|cell| shown(&shortened(cell)).into_owned()));
    }
    // Numbers are never broken, and only long words are.
    for (k, column) in grid.column_iter_mut().enumerate() {
        let cells = || table.rows.iter().filter_map(|row| row.get(k)).chain(table.header.get(k));
        let numbers = || table.rows.iter().filter_map(|row| row.get(k)).filter(|cell| !cell.is_empty());
        let constraint = if numbers().next().is_some() && numbers().all(|cell| is_number(cell)) {
            ColumnConstraint::ContentWidth
        } else {
            let words = cells().flat_map(|cell| cell.split_whitespace()).map(|word| word.chars().count());
            let width = words.max().unwrap_or(0).min(NARROW) + 2;
            ColumnConstraint::LowerBoundary(Width::Fixed(width as u16))
        };
        column.set_constraint(constraint);
    }
    let lines: String = grid.lines().map(|line| format!(" {}\n", line.trim_end())).collect();
    format!("{}\n{lines}", bold(&table.title))
}

/// Text of a cell that is not longer than a few lines: to lay out long words takes the square of their length.
fn shortened(cell: &str) -> Cow<'_, str> {
    match cell.char_indices().nth(LONGEST_CELL) {
        Some((end, _)) => format!("{} ...", &cell[..end]).into(),
        None => cell.into(),
    }
}

/// True if a cell is a number with its unit, or a dash in its place.
fn is_number(cell: &str) -> bool {
    let digits = cell.trim_start_matches(['-', '+', '±', '≥', '≤', '<', '>', ' ']);
    matches!(cell, "–" | "-")
        || digits.starts_with(|c: char| c.is_ascii_digit()) && cell.chars().count() <= 24
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_escaped() {
        assert_eq!(printable("a\nb"), "a\nb");
        assert_eq!(printable("\x1b[1;91mred\x1b[0m"), "\x1b[1;91mred\x1b[0m");
        let odd = "\x1b]0;title\x07 \x1b[2J \u{202e}x\u{2066}\r\u{9b}";
        let safe = printable(odd);
        assert!(!safe.chars().any(is_odd), "{safe:?}");
        assert_eq!(shown("a\x1b[31m\n"), "a\\u{1b}[31m\\u{a}");
        assert_eq!(shown("straße, 腕"), "straße, 腕");
    }

    #[test]
    fn a_long_cell_is_shortened() {
        assert_eq!(shortened("a + b"), "a + b");
        let long = shortened(&"é".repeat(LONGEST_CELL + 1)).into_owned();
        assert!(long.ends_with("é ...") && long.chars().count() == LONGEST_CELL + 4);
    }

    #[test]
    fn numbers_of_a_narrow_table_stay_whole() {
        let row = [
            "a_rather_long_name_of_a_measure",
            "another_long_name_of_a_variable",
            "-0.12346 deg/mm",
            "0.35 s",
        ];
        let words = |row: [&str; 4]| row.map(String::from).to_vec();
        let header = words(["measure", "by variable", "largest", "at t"]);
        let table = Table { title: "T".into(), note: String::new(), header, rows: vec![words(row); 2] };
        for width in [80, 60] {
            let mut grid = empty_grid();
            grid.set_content_arrangement(ContentArrangement::Dynamic).set_width(width);
            let text = laid_out(grid, &table);
            assert_eq!(text.matches("-0.12346 deg/mm").count(), 2, "{text}");
            assert_eq!(text.matches("0.35 s").count(), 2, "{text}");
            assert!(text.lines().all(|line| line.chars().count() <= usize::from(width) + 1), "{text}");
        }
    }
}
