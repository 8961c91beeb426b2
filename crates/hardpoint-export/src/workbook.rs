//! `motion.xlsx`: a run as an Excel workbook.
//!
//! The first sheet lists data that do not fit into a sheet, or are too long for one, with the file that has them.

use std::io::Write;

use hardpoint::Solution;
use hardpoint::measure::Output;
use hardpoint::model::{OutputSource, VariableId};
use hardpoint_file::ModelFile;
use hardpoint_report::GENERATOR;
use hardpoint_report::columns::{Column, Columns};
use hardpoint_report::course::Course;
use hardpoint_report::facts::VariableFact;
use hardpoint_report::figures::{count, number, order_unit, per};
use hardpoint_report::metric::MetricFact;
use hardpoint_report::summary::{RankedVariable, Ranking, RunStatus, Summary};
use rust_xlsxwriter::{
    Chart, ChartAxisLabelPosition, ChartFormat, ChartLine, ChartMarker, ChartType, DocProperties, Format,
    FormatAlign, Workbook, Worksheet, XlsxError,
};

/// The limits of a sheet.
const MOST_ROWS: usize = 1_048_576;
const MOST_COLUMNS: usize = 16_384;
const MOST_LETTERS: usize = 32_767;
/// Maximum number of cells of a sheet over time, which is in memory until it is complete.
const MOST_CELLS: usize = 1_000_000;
/// Maximum number of charts.
const MOST_CHARTS: usize = 100;
/// A chart, in pixels; rows of sheets are 20 high.
const CHART: (u32, u32) = (560, 300);
const CHART_ROWS: u32 = 16;
const CHART_COLUMNS: u16 = 9;
/// Number of significant digits that are shown; the cells have all of them.
const SHOWN_DIGITS: i32 = 6;

/// Names of the sheets.
const MOTION: &str = "Motion";
const CHARTS: &str = "Charts";
const LARGEST: &str = "Largest sensitivities";
const SENSITIVITIES: &str = "Sensitivities";
const HARDPOINTS: &str = "Hardpoints";

/// A run to be written as an Excel workbook or a PDF document.
pub struct RunDocument<'a> {
    /// The model.
    pub file: &'a ModelFile,
    /// Motion.
    pub course: &'a Course,
    /// Summary of the run.
    pub summary: &'a Summary,
    /// Ending of the names of its tables.
    pub suffix: &'a str,
}

/// A sheet with its description.
struct Sheet {
    worksheet: Worksheet,
    name: &'static str,
    about: String,
    /// RunDocument that were left out, and where they are.
    left_out: Option<String>,
}

/// A column of numbers.
struct Series {
    header: String,
    cells: Vec<f64>,
}

impl RunDocument<'_> {
    /// Writes the workbook and returns notes on omitted data.
    ///
    /// # Errors
    /// Where `out` cannot be written.
    pub fn write(&self, out: &mut (impl Write + Send)) -> std::io::Result<Vec<String>> {
        self.try_write(out).map_err(|e| match e {
            XlsxError::IoError(error) => error,
            other => std::io::Error::other(other),
        })
    }

    fn try_write(&self, out: &mut (impl Write + Send)) -> Result<Vec<String>, XlsxError> {
        let mut sheets = vec![self.motion()?];
        sheets.extend(self.charts()?);
        sheets.extend(self.largest()?);
        sheets.extend(self.sensitivities()?);
        sheets.push(self.hardpoints()?);
        let mut workbook = Workbook::new();
        let title = text(&self.summary.model.name);
        workbook.set_properties(&DocProperties::new().set_title(title).set_comment(GENERATOR));
        workbook.push_worksheet(self.about(&sheets)?);
        let notes =
            sheets.iter().filter_map(|s| s.left_out.clone()).map(|s| format!("not in `motion.xlsx`: {s}"));
        let notes = notes.collect();
        sheets.into_iter().for_each(|sheet| workbook.push_worksheet(sheet.worksheet));
        workbook.save_to_writer(out)?;
        Ok(notes)
    }

    /// Facts about the run.
    pub fn facts(&self) -> Vec<(&'static str, String)> {
        let summary = self.summary;
        let steps = &summary.steps;
        let span = steps
            .last_solved
            .map_or("none".into(), |t| format!("t = {} to {} s", number(steps.start), number(t)));
        let ended = match (&summary.stop, summary.status) {
            (_, RunStatus::Complete) => "at its last output time".into(),
            (Some(stop), RunStatus::Stopped) => format!("early, {}: {}", stop.code, stop.message),
            (None, RunStatus::Stopped) | (_, RunStatus::Interrupted) => {
                "early: interrupted by the user; the part before it is included".into()
            }
        };
        let units = format!("{}, {}, s", self.file.units.length.symbol(), self.file.units.angle.symbol());
        let mut facts = vec![("model file", summary.model.file.clone())];
        facts.extend(self.file.case.iter().map(|case| ("case", case.clone())));
        facts.extend([
            ("units", units),
            ("output times", format!("{} of {}, {span}", steps.solved, steps.asked)),
            ("the motion ended", ended),
            ("written by", GENERATOR.into()),
        ]);
        facts
    }

    fn about(&self, sheets: &[Sheet]) -> Result<Worksheet, XlsxError> {
        let summary = self.summary;
        let mut page = Page::new("About")?;
        page.heading(&summary.model.name)?;
        for line in summary.model.description.iter().flat_map(|d| d.lines()) {
            page.row(&[line.into()])?;
        }
        page.row(&[])?;
        for (what, said) in self.facts() {
            page.row(&[what.into(), said.into()])?;
        }
        page.table(
            "Sheets",
            &["sheet", "what"],
            sheets.iter().map(|s| vec![s.name.into(), s.about.as_str().into()]),
        )?;
        let left_out = sheets.iter().filter_map(|s| s.left_out.as_ref()).chain(&summary.left_out);
        page.table("Not in this workbook", &[], left_out.map(|said| vec![said.as_str().into()]))?;
        let notes = summary.diagnostics.iter().map(|d| vec![d.code.into(), d.message.as_str().into()]);
        page.table("Warnings", &[], notes)?;
        let variable = |(k, v): (usize, &VariableFact)| {
            let value = self.file.value_of(VariableId(k), 0.0);
            let unit = if v.unit == "1" { "" } else { &v.unit };
            vec![
                v.name.as_str().into(),
                value.into(),
                unit.into(),
                v.change.as_str().into(),
                v.admissibility_text().into(),
            ]
        };
        page.table(
            "Design variables (of a parameter its value, of all others the change of the nominal design)",
            &["variable", "value", "unit", "change", "over the motion"],
            summary.model.variables.iter().enumerate().map(variable),
        )?;
        let metric = |m: &MetricFact| {
            let unit = if m.unit == "1" { "" } else { &m.unit };
            let optional = |x: Option<f64>| x.map_or(Cell::Text("-".into()), Cell::Number);
            vec![
                m.name.as_str().into(),
                optional(m.value),
                unit.into(),
                optional(m.time),
                m.what.as_str().into(),
            ]
        };
        page.table(
            "Metrics",
            &["metric", "value", "unit", "at t [s]", "what"],
            summary.metrics.iter().map(metric),
        )?;
        page.sheet.set_column_width(0, 24)?.set_column_width(1, 24)?.set_column_width(2, 14)?;
        page.sheet.set_column_width(3, 48)?.set_column_width(4, 32)?;
        Ok(page.sheet)
    }

    /// Stride over the stored output times for a sheet with this number of columns, and a note if times are left out.
    fn every(&self, columns: usize) -> (usize, Option<String>) {
        let rows = usize::min(MOST_ROWS - 1, MOST_CELLS / columns.max(1)).max(1);
        let every = self.solution().motion.len().div_ceil(rows).max(1);
        let of_all = every * self.course.stride;
        (every, (of_all > 1).then(|| format!("only one output time in {of_all} is here")))
    }

    fn solution(&self) -> &Solution {
        &self.course.kept
    }

    /// Columns of the motion; those of bodies only if there are no outputs.
    fn columns(&self) -> Columns<'_> {
        let bodies = self.solution().measured.outputs.is_empty();
        Columns { model: &self.file.model, units: self.file.units, bodies, angles: None }
    }

    fn motion(&self) -> Result<Sheet, XlsxError> {
        let columns = self.columns();
        let mut headers = vec!["t [s]".to_owned()];
        headers.extend(columns.of_motion().iter().map(Column::header));
        let all = headers.len();
        headers.truncate(MOST_COLUMNS);
        let (every, thinned) = self.every(headers.len());
        let mut series: Vec<Series> =
            headers.into_iter().map(|header| Series { header, cells: Vec::new() }).collect();
        let mut row = Vec::new();
        for (k, &t) in self.solution().motion.times.iter().enumerate().step_by(every) {
            row.clear();
            row.push(t);
            columns.motion(self.solution(), k, &mut row);
            series.iter_mut().zip(&row).for_each(|(s, x)| s.cells.push(*x));
        }
        let what = if columns.bodies { "bodies" } else { "measures and points" };
        let wide = (all > series.len())
            .then(|| format!("only {} of {all} columns are here, the limit of a sheet", series.len()));
        let said: Vec<String> = thinned.into_iter().chain(wide).collect();
        Ok(Sheet {
            worksheet: over_time(MOTION, &series)?,
            name: MOTION,
            about: format!("{what} over time, with rates and accelerations"),
            left_out: (!said.is_empty())
                .then(|| format!("sheet `{MOTION}`: {}; `motion.{}` has all", said.join(", "), self.suffix)),
        })
    }

    /// Curves of each chart, as columns of the motion sheet: measures, or else points, or bodies.
    fn curves(&self) -> Vec<(String, Vec<usize>)> {
        let columns: Vec<String> = self.columns().of_motion().into_iter().map(|c| c.name).collect();
        let column = |name: &str| columns.iter().position(|c| c == name).map(|k| k + 1);
        let outputs = self.shown();
        let mut curves: Vec<(String, Vec<usize>)> = Vec::new();
        let places: Vec<String> = if outputs.is_empty() {
            let bodies = self.file.model.bodies.iter().skip(1);
            bodies.flat_map(|b| ["x", "y", "z"].map(|c| format!("{}.{c}", b.name))).collect()
        } else {
            outputs.iter().map(|(_, o)| o.name.clone()).collect()
        };
        let is_measure =
            |k: usize| outputs.get(k).is_some_and(|(_, o)| matches!(o.source, OutputSource::Measure(_)));
        for (k, name) in places.iter().enumerate() {
            let Some(at) = column(name).filter(|at| *at < MOST_COLUMNS) else { continue };
            let group =
                if is_measure(k) { name } else { name.rsplit_once('.').map_or(name.as_str(), |(of, _)| of) };
            match curves.last_mut() {
                Some((last, list)) if last == group && !is_measure(k) => list.push(at),
                _ => curves.push((group.to_owned(), vec![at])),
            }
        }
        curves
    }

    fn charts(&self) -> Result<Option<Sheet>, XlsxError> {
        let (curves, mut sheet) = (self.curves(), Worksheet::new());
        if curves.is_empty() {
            return Ok(None);
        }
        sheet.set_name(CHARTS)?;
        let headers: Vec<String> = self.columns().of_motion().iter().map(|c| c.unit.clone()).collect();
        let (every, _) = self.every(usize::min(headers.len() + 1, MOST_COLUMNS));
        let last = self.solution().motion.len().div_ceil(every) as u32;
        for (n, (name, columns)) in curves.iter().take(MOST_CHARTS).enumerate() {
            let mut chart = Chart::new(ChartType::ScatterStraight);
            for &column in columns {
                let at = column as u16;
                let mut line = ChartFormat::new();
                line.set_line(ChartLine::new().set_width(1.5));
                chart
                    .add_series()
                    .set_name((MOTION, 0, at))
                    .set_categories((MOTION, 1, 0, last, 0))
                    .set_values((MOTION, 1, at, last, at))
                    .set_format(&mut line)
                    .set_marker(ChartMarker::new().set_none());
            }
            let unit = &headers[columns[0] - 1];
            // Text that begins with `=` would be read as a cell reference.
            match columns[..] {
                [column] => chart.title().set_name((MOTION, 0, column as u16)),
                _ => chart.title().set_name(&text(&format!("place of {name}"))),
            };
            chart.x_axis().set_name("t [s]");
            chart.x_axis().set_label_position(ChartAxisLabelPosition::Low);
            if unit != "1" {
                chart.y_axis().set_name(unit);
            }
            if columns.len() == 1 {
                chart.legend().set_hidden();
            }
            chart.set_width(CHART.0).set_height(CHART.1);
            let (row, column) = ((n / 2) as u32 * CHART_ROWS, (n % 2) as u16 * CHART_COLUMNS);
            sheet.insert_chart(row, column, &chart)?;
        }
        let more = curves.len().saturating_sub(MOST_CHARTS);
        let left_out =
            format!("sheet `{CHARTS}`: {}; the curves are in sheet `{MOTION}`", count(more, "more chart"));
        Ok(Some(Sheet {
            worksheet: sheet,
            name: CHARTS,
            about: "the same as curves".into(),
            left_out: (more > 0).then_some(left_out),
        }))
    }

    /// Outputs with charts and sensitivities: measures, or points if there are none.
    pub fn shown(&self) -> Vec<(usize, &Output)> {
        let outputs = || self.solution().measured.outputs.iter().enumerate();
        let measures: Vec<_> =
            outputs().filter(|(_, o)| matches!(o.source, OutputSource::Measure(_))).collect();
        if measures.is_empty() { outputs().collect() } else { measures }
    }

    fn largest(&self) -> Result<Option<Sheet>, XlsxError> {
        let rankings = &self.summary.sensitivities;
        if rankings.is_empty() {
            return Ok(None);
        }
        let mut page = Page::new(LARGEST)?;
        page.header(&["measure", "order", "by variable", "largest", "unit", "at t [s]"])?;
        page.sheet.set_freeze_panes(1, 0)?;
        let row = |of: &Ranking, r: &RankedVariable| -> Vec<Cell> {
            let unit = if r.unit == "1" { "" } else { &r.unit };
            vec![
                of.measure.as_str().into(),
                of.order.into(),
                r.variable.as_str().into(),
                r.value.into(),
                unit.into(),
                r.time.into(),
            ]
        };
        let (mut rows, mut more) = (0, 0);
        for (of, ranked) in rankings.iter().flat_map(|of| of.largest.iter().map(move |r| (of, r))) {
            if rows + 1 < MOST_ROWS {
                page.row(&row(of, ranked))?;
                rows += 1;
            } else {
                more += 1;
            }
        }
        if rows == 0 {
            page.row(&["no variable moves a measure".into()])?;
        }
        page.sheet.set_column_width(0, 24)?.set_column_width(1, 14)?.set_column_width(2, 24)?;
        page.sheet.set_column_range_width(3, 5, 14)?;
        let left_out = format!("sheet `{LARGEST}`: {}; `summary.json` has all", count(more, "more row"));
        Ok(Some(Sheet {
            worksheet: page.sheet,
            name: LARGEST,
            about: "of each measure and its rates over the motion, the largest by each variable; within a unit the largest first".into(),
            left_out: (more > 0).then_some(left_out),
        }))
    }

    fn sensitivities(&self) -> Result<Option<Sheet>, XlsxError> {
        let (model, units, solution) = (&self.file.model, self.file.units, self.solution());
        let follows: Vec<usize> = (0..model.variables.len()).filter(|b| self.course.follows(*b)).collect();
        let outputs = self.shown();
        if solution.measured.variables == 0 || follows.is_empty() || outputs.is_empty() {
            return Ok(None);
        }
        // If a sheet has no room for all variables, the most influential ones remain.
        let all = outputs.len();
        let each = usize::min(follows.len(), (MOST_COLUMNS - 1) / all).max(1);
        let outputs = &outputs[..usize::min(all, MOST_COLUMNS - 1)];
        let (every, thinned) = self.every(1 + each * outputs.len());
        let times: Vec<usize> = (0..solution.motion.len()).step_by(every).collect();
        let time = times.iter().map(|k| solution.motion.times[*k]).collect();
        let mut series = vec![Series { header: "t [s]".into(), cells: time }];
        for &(m, output) in outputs {
            for b in self.strongest(output, &follows).into_iter().take(each) {
                let (variable, fact) = (&model.variables[b], &self.summary.model.variables[b]);
                let unit = per(&order_unit(units, output.dimension, 0), &fact.unit);
                let unit = if unit == "1" { String::new() } else { format!(" [{unit}]") };
                let value = |k: &usize| {
                    let d = solution.measured.d(*k, VariableId(b), m)[0];
                    units.derivative_from_si(output.dimension, variable.quantity, d)
                };
                series.push(Series {
                    header: format!("d {} / d {}{unit}", output.name, variable.name),
                    cells: times.iter().map(value).collect(),
                });
            }
        }
        let few = (each < follows.len())
            .then(|| format!("only the {each} most influential of {} variables are here", follows.len()));
        let wide = (all > outputs.len()).then(|| format!("only {} of {all} curves are here", outputs.len()));
        let said: Vec<String> = thinned.into_iter().chain(few).chain(wide).collect();
        let what =
            if matches!(outputs[0].1.source, OutputSource::Measure(_)) { "measures" } else { "points" };
        let more = format!("`sensitivity.{}` has all", self.suffix);
        Ok(Some(Sheet {
            worksheet: over_time(SENSITIVITIES, &series)?,
            name: SENSITIVITIES,
            about: format!(
                "derivatives of the {what} by the design variables over time, without those of rates and accelerations: {more}"
            ),
            left_out: (!said.is_empty())
                .then(|| format!("sheet `{SENSITIVITIES}`: {}; {more}", said.join(", "))),
        }))
    }

    /// Variables, the most influential ones of an output first.
    fn strongest(&self, output: &Output, follows: &[usize]) -> Vec<usize> {
        let ranking =
            self.summary.sensitivities.iter().find(|r| r.measure == output.name && r.order == "value");
        let rank = |b: usize| {
            let name = &self.file.model.variables[b].name;
            ranking.and_then(|r| r.largest.iter().position(|r| r.variable == *name)).unwrap_or(usize::MAX)
        };
        let mut list = follows.to_vec();
        list.sort_by_cached_key(|b| rank(*b));
        list
    }

    fn hardpoints(&self) -> Result<Sheet, XlsxError> {
        let unit = self.file.units.length.symbol();
        let mut page = Page::new(HARDPOINTS)?;
        let header = ["x", "y", "z"].map(|c| format!("{c} [{unit}]"));
        page.header(&["hardpoint", &header[0], &header[1], &header[2]])?;
        page.sheet.set_freeze_panes(1, 1)?;
        for (name, at) in crate::hardpoints(self.file) {
            page.row(&std::iter::once(name.into()).chain(at.map(Cell::Number)).collect::<Vec<_>>())?;
        }
        page.sheet.set_column_width(0, 24)?.set_column_range_width(1, 3, 14)?;
        Ok(Sheet {
            worksheet: page.sheet,
            name: HARDPOINTS,
            about: "the coordinates of the hardpoints in the design configuration".into(),
            left_out: None,
        })
    }
}

/// Columns of numbers under frozen headers.
fn over_time(name: &str, series: &[Series]) -> Result<Worksheet, XlsxError> {
    let mut sheet = Worksheet::new();
    sheet.set_name(name)?.set_freeze_panes(1, 1)?.set_row_height(0, 48)?;
    let header = bold().set_text_wrap().set_align(FormatAlign::Top);
    for (column, series) in series.iter().enumerate() {
        let column = column as u16;
        sheet.write_string_with_format(0, column, text(&series.header), &header)?;
        sheet.set_column_width(column, 14)?;
        let shown = Format::new().set_num_format(number_format(&series.cells));
        for (row, x) in series.cells.iter().enumerate().filter(|(_, x)| x.is_finite()) {
            sheet.write_number_with_format(row as u32 + 1, column, *x, &shown)?;
        }
    }
    Ok(sheet)
}

/// Number format with the decimals that the largest number of a column needs.
fn number_format(cells: &[f64]) -> String {
    let largest = cells.iter().map(|x| x.abs()).filter(|x| x.is_finite()).fold(0.0, f64::max);
    let whole = if largest > 0.0 { largest.log10().floor() as i32 + 1 } else { 1 };
    match SHOWN_DIGITS - whole.max(1) {
        _ if !(-2..=9).contains(&whole) => "0.00000E+00".into(),
        decimals @ 1.. => format!("0.{}", "0".repeat(decimals as usize)),
        _ => "0".into(),
    }
}

fn bold() -> Format {
    Format::new().set_bold()
}

/// Truncates a text to the limit of a cell.
fn text(text: &str) -> String {
    let mut room = MOST_LETTERS;
    let fits = |c: &char| {
        let size = c.len_utf16();
        room.checked_sub(size).is_some_and(|left| {
            room = left;
            true
        })
    };
    text.chars().take_while(fits).collect()
}

enum Cell {
    Text(String),
    Number(f64),
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.into())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<f64> for Cell {
    fn from(x: f64) -> Self {
        Self::Number(x)
    }
}

/// A sheet that is written row by row.
struct Page {
    sheet: Worksheet,
    next: u32,
}

impl Page {
    fn new(name: &str) -> Result<Self, XlsxError> {
        let mut sheet = Worksheet::new();
        sheet.set_name(name)?;
        Ok(Self { sheet, next: 0 })
    }

    fn heading(&mut self, said: &str) -> Result<(), XlsxError> {
        self.sheet.write_string_with_format(self.next, 0, text(said), &bold().set_font_size(14))?;
        self.next += 1;
        Ok(())
    }

    fn header(&mut self, names: &[&str]) -> Result<(), XlsxError> {
        for (column, name) in names.iter().enumerate() {
            self.sheet.write_string_with_format(self.next, column as u16, text(name), &bold())?;
        }
        self.next += u32::from(!names.is_empty());
        Ok(())
    }

    fn row(&mut self, cells: &[Cell]) -> Result<(), XlsxError> {
        for (column, cell) in cells.iter().enumerate() {
            match cell {
                Cell::Text(said) => {
                    self.sheet.write_string(self.next, column as u16, text(said))?;
                }
                // A value that is not a number leaves an empty cell.
                Cell::Number(x) if x.is_finite() => {
                    self.sheet.write_number(self.next, column as u16, *x)?;
                }
                Cell::Number(_) => {}
            }
        }
        self.next += 1;
        Ok(())
    }

    /// Writes a table with a heading; writes nothing if it has no rows.
    fn table(
        &mut self,
        title: &str,
        header: &[&str],
        rows: impl Iterator<Item = Vec<Cell>>,
    ) -> Result<(), XlsxError> {
        let mut rows = rows.peekable();
        if rows.peek().is_none() {
            return Ok(());
        }
        self.next += 1;
        self.heading(title)?;
        self.header(header)?;
        rows.try_for_each(|row| self.row(&row))
    }
}
