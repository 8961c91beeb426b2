//! Text for people: tables, headings, and what goes where.

use std::io::{IsTerminal, Write};

use comfy_table::{Cell, ContentArrangement, LineStyle, TableStyle};
use hardpoint_report::margin::MarginFact;
use hardpoint_report::page::Table;
use hardpoint_report::summary::Summary;

const BOLD: &str = "\x1b[1m";
const RED: &str = "\x1b[1;91m";
const PLAIN: &str = "\x1b[0m";

/// Prints to stdout; escapes are dropped where it is no terminal. A reader that closed the pipe is no error.
pub fn print(text: &str) {
    let _ = anstream::stdout().lock().write_all(text.as_bytes());
}

/// Prints to stderr, likewise.
pub fn complain(text: &str) {
    let _ = anstream::stderr().lock().write_all(text.as_bytes());
}

/// Whether stderr shows colours.
pub fn stderr_in_color() -> bool {
    anstream::AutoStream::choice(&std::io::stderr()) != anstream::ColorChoice::Never
}

/// In bold.
pub fn bold(text: &str) -> String {
    format!("{BOLD}{text}{PLAIN}")
}

/// An error that is not about the model file, in the look of the others.
pub fn error(code: &str, message: &str, note: &str, help: &str) -> String {
    format!(
        "{RED}error[{code}]{PLAIN}{BOLD}: {message}{PLAIN}\n  {BOLD}= note{PLAIN}: {note}\n  {BOLD}= help{PLAIN}: {help}\n"
    )
}

/// Labels and values in two aligned columns.
pub fn pairs(rows: &[(&str, String)]) -> String {
    let width = rows.iter().map(|(label, _)| label.chars().count()).max().unwrap_or(0);
    rows.iter().map(|(label, value)| format!("  {label:width$}  {value}\n")).collect()
}

/// What is worth knowing and no error, a line each, after an empty one.
pub fn notes(summary: &Summary) -> String {
    let ahead = summary.margin.as_ref().and_then(MarginFact::ahead);
    let lines = summary.model.all_notes().into_iter().chain(ahead);
    let lines: String = lines.map(|note| format!("{BOLD}note{PLAIN}: {note}\n")).collect();
    if lines.is_empty() { lines } else { format!("\n{lines}") }
}

/// A table under its title, as wide as the terminal, or as it needs to be where there is none.
pub fn table(table: &Table) -> String {
    let mut grid = comfy_table::Table::new();
    grid.load_style(TableStyle::new().header_separator(LineStyle::none().fill('─').junction('─')));
    if std::io::stdout().is_terminal() {
        grid.set_content_arrangement(ContentArrangement::Dynamic);
    }
    grid.set_header(table.header.iter().map(Cell::new));
    for row in &table.rows {
        grid.add_row(row);
    }
    let lines: String = grid.lines().map(|line| format!(" {}\n", line.trim_end())).collect();
    format!("{}\n{lines}", bold(&table.title))
}
