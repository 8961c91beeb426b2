//! Tasks of synthesis: poses of a body, or points of a path, for which linkages are to be found.

use std::ops::Range;
use std::path::Path;

use hardpoint::joint::Quantity;
use toml::de::DeTable;

use crate::values::{
    ANGLE, DataError, Diagnostic, Diagnostics, Field, Fields, Folder, LENGTH, Reader, Severity, Shape,
    Source, Table, Wanted, all_read, shown, table,
};
use hardpoint_table::Units;
use hardpoint_table::figures::symbol;

use super::data::{Title, no_csv, number, records_of, unquoted};
use super::model::{UNITS, units};
use super::parse::{ReadError, syntax_errors, text_of};

/// Maximum number of points of a path.
const MOST_POINTS: usize = 200;
/// Maximum number of answers.
const MOST_ANSWERS: u32 = 100;
/// Default number of answers.
const ANSWERS: usize = 10;

pub(crate) const TASK: Table = table! {
    /// A task for `hardpoint synthesize`.
    "Hardpoint task":
    /// Name of the task, for headings and the names of models.
    must "name": Shape::Text, "\"gripper\"";
    /// Description of the task.
    may "description": Shape::Text, "\"...\"";
    /// The units of all numbers in this file.
    must "units": Shape::Table(&UNITS), "{ length = \"mm\", angle = \"deg\" }";
    /// Three to five poses `[x, y, angle]` of the guided body in their order, or a CSV file. The angle is
    /// counter-clockwise from x.
    may "poses": POSES, "[[0, 0, 0], [40, 12, 25], [70, 40, 60]]";
    /// Instead of poses: points `[x, y]` of the path of a point in their order, or a CSV file.
    may "points": POINTS, "[[0, 0], [20, 15], [45, 20], [60, 10]]";
    /// With `points`: `true` if the path returns from its last point to its first, once per turn of the crank.
    or("false") "closed": Shape::Flag, "true";
    /// With `points`: angles of the crank at the points, in one direction. Default: free.
    may "crank_angles": Shape::list(&ANGLE), "[0, 30, 60, 90]";
    /// With `points`: distance up to which a point counts as met. Default: linkages that come nearer are better.
    may "tolerance": LENGTH, "0.1";
    /// Types of linkages to look for. Default: both.
    may "linkages": Shape::list(&LINKAGE), "[\"four_bar\"]";
    /// Region of the fixed pivots.
    may "fixed_region": Shape::Table(&REGION), "{ x = [-100, 100], y = [-80, 0] }";
    /// Region of the pins on the guided body in its first pose, or at the first point.
    may "moving_region": Shape::Table(&REGION), "{ x = [-50, 50], y = [-50, 50] }";
    /// With three poses: the fixed pivots of cranks and rockers themselves.
    may "fixed_pivots": Shape::list(&Shape::exactly(2, &LENGTH)), "[[-40, -20], [60, -30]]";
    /// `true` if the crank must turn fully.
    or("false") "full_turn": Shape::Flag, "true";
    /// `true` if the poses may be passed in another order.
    or("false") "any_order": Shape::Flag, "true";
    /// Number of answers.
    or("10") "answers": Shape::Count(MOST_ANSWERS), "5";
};
const REGION: Table = table! {
    /// A rectangle.
    "Region":
    /// Range of x.
    must "x": Shape::exactly(2, &LENGTH), "[-100, 100]";
    /// Range of y.
    must "y": Shape::exactly(2, &LENGTH), "[-80, 0]";
};
const POSES: Shape =
    Shape::Any("", "", &[Shape::list(&Shape::exactly(3, &Shape::Number(Quantity::Number))), Shape::File]);
const POINTS: Shape = Shape::Any("", "", &[Shape::list(&Shape::exactly(2, &LENGTH)), Shape::File]);
const LINKAGE: Shape = Shape::Words(&[("four_bar", ""), ("slider_crank", "")]);
/// Files of poses or points.
const FILE: Wanted<'static> = Wanted {
    purpose: "table",
    kind: "a CSV file",
    ending: "csv",
    example: "path.csv",
    without_folder: "write them as a list",
    too_large: "keep fewer rows",
};

/// Tables of `docs/synthesis.md`, by their names there.
#[cfg(test)]
pub(crate) fn task_tables() -> [(&'static str, Shape); 2] {
    [("the task", Shape::Table(&TASK)), ("regions", Shape::Table(&REGION))]
}

/// Aim of a task, SI.
#[derive(Clone, Debug, PartialEq)]
pub enum TaskAim {
    /// Poses `[x, y, angle]` of a body.
    Poses(Vec<[f64; 3]>),
    /// Points of a path.
    Path {
        /// The points.
        points: Vec<[f64; 2]>,
        /// True if the path returns to its first point.
        is_closed: bool,
        /// Angles of the crank at the points, if they are given.
        crank_angles: Option<Vec<f64>>,
        /// Distance up to which a point counts as met.
        tolerance: Option<f64>,
    },
}

/// A rectangle, m: its ranges of x and y.
pub type TaskRegion = [[f64; 2]; 2];

/// A task of synthesis with its text.
#[derive(Clone, Debug)]
pub struct TaskFile {
    /// Name.
    pub name: String,
    /// Description in the file.
    pub description: Option<String>,
    /// Units of the file, for output.
    pub units: Units,
    /// Poses or path.
    pub aim: TaskAim,
    /// True if four-bars are looked for.
    pub four_bars: bool,
    /// True if slider-cranks are looked for.
    pub slider_cranks: bool,
    /// Region of the fixed pivots.
    pub fixed_region: Option<TaskRegion>,
    /// Region of the pins on the body.
    pub moving_region: Option<TaskRegion>,
    /// Given fixed pivots, m.
    pub fixed_pivots: Vec<[f64; 2]>,
    /// True if the crank must turn fully.
    pub full_turn: bool,
    /// True if the poses may be passed in another order.
    pub any_order: bool,
    /// Number of answers.
    pub answers: usize,
    source: Source,
    /// Place of `poses` or `points`, of its entries if they are in the text, and of other keys by name.
    aim_at: Range<usize>,
    entries: Vec<Range<usize>>,
    keys: Vec<(&'static str, Range<usize>)>,
}

impl TaskFile {
    /// Reads a task file.
    ///
    /// # Errors
    /// Returns the errors of the file.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let (text, name) = text_of(path)?;
        let folder = path.parent().map_or(Folder::None, Folder::On);
        task(folder, &text, &name).map_err(ReadError::Invalid)
    }

    /// Reads the text of a task file; `file_name` is for the diagnostics only.
    ///
    /// # Errors
    /// Returns its errors, in the order of the text.
    ///
    /// ```
    /// use hardpoint_file::{TaskAim, TaskFile};
    /// let text = r#"
    /// name = "lid"
    /// units = { length = "mm", angle = "deg" }
    /// poses = [[0, 0, 0], [40, 12, 25], [70, 40, 60]]
    /// "#;
    /// let task = TaskFile::parse(text, "lid.toml").unwrap();
    /// assert!(matches!(task.aim, TaskAim::Poses(poses) if poses[1][0] == 0.04));
    /// ```
    pub fn parse(text: &str, file_name: &str) -> Result<Self, Diagnostics> {
        task(Folder::None, text, file_name)
    }

    /// Diagnostic at an entry of its poses or points, by number from 0, at a key, or at its list as a whole.
    pub fn error(
        &self,
        code: &'static str,
        message: &str,
        entry: Option<usize>,
        key: Option<&str>,
    ) -> Diagnostic {
        let of_key = key.and_then(|key| self.keys.iter().find(|k| k.0 == key));
        let of_entry = entry.and_then(|k| self.entries.get(k));
        let at = of_key.map(|k| &k.1).or(of_entry).unwrap_or(&self.aim_at);
        self.source.diagnostic(Severity::Error, code, message, Some(at.clone()))
    }

    /// Diagnostics of the file.
    pub fn diagnostics(&self, list: Vec<Diagnostic>) -> Diagnostics {
        Diagnostics::new(self.source.clone(), list)
    }

    /// Name of the file, as given.
    pub fn file_name(&self) -> &str {
        &self.source.file
    }
}

fn task(folder: Folder<'_>, text: &str, file_name: &str) -> Result<TaskFile, Diagnostics> {
    let source = Source::new(file_name, text);
    let (document, errors) = DeTable::parse_recoverable(text);
    let found = syntax_errors(&source, &errors, &(0..text.len()));
    if !found.is_empty() {
        return Err(Diagnostics::new(source, found));
    }
    let mut reader = Reader::new(&source, folder);
    let read = fields_of(&mut reader, document.get_ref());
    let found = std::mem::take(&mut reader.found);
    drop(reader);
    match read {
        Some(task) if found.is_empty() => Ok(TaskFile { source, ..task }),
        _ => Err(Diagnostics::new(source, found)),
    }
}

fn fields_of(r: &mut Reader<'_>, table: &DeTable<'_>) -> Option<TaskFile> {
    let fields = r.fields("the task", 0..0, table, TASK.keys());
    let name = r.need(&fields, "name").and_then(|f| r.text(&fields, f));
    let description = fields.get("description").and_then(|f| r.text(&fields, f));
    units(r, &fields);
    let aim = aim(r, &fields);
    let linkages = linkages(r, &fields);
    let [fixed_region, moving_region] = ["fixed_region", "moving_region"].map(|key| region(r, &fields, key));
    let fixed_pivots = r.given(&fields, "fixed_pivots", |r, f| {
        let subject = fields.subject(f.key);
        let list = r.list(f.value, &subject, "a list of places `[x, y]`")?;
        all_read(list.into_iter().map(|v| r.quantities::<2>(v, &subject, "a place `[x, y]`", LENGTH)))
    });
    let [full_turn, any_order] = ["full_turn", "any_order"].map(|key| r.flag_of(&fields, key));
    let answers = match fields.get("answers") {
        None => Some(ANSWERS),
        Some(_) => r.count_of(&fields, "answers", MOST_ANSWERS),
    };
    let (aim, aim_at, entries) = aim?;
    let [four_bars, slider_cranks] = linkages?;
    Some(TaskFile {
        name: name?,
        description,
        units: r.units,
        aim,
        four_bars,
        slider_cranks,
        fixed_region,
        moving_region,
        fixed_pivots: fixed_pivots.unwrap_or_default(),
        full_turn: full_turn?,
        any_order: any_order?,
        answers: answers?,
        source: r.source.clone(),
        aim_at,
        entries,
        keys: fields.iter().map(|f| (f.key, f.value.span())).collect(),
    })
}

/// Places of the entries of a list in the text.
type Places = Vec<Range<usize>>;
/// Aim with the places of its list and of its entries.
type Aim = (TaskAim, Range<usize>, Places);

fn aim(r: &mut Reader<'_>, fields: &Fields<'_>) -> Option<Aim> {
    const OF_POINTS: [&str; 3] = ["closed", "crank_angles", "tolerance"];
    match (fields.get("poses"), fields.get("points")) {
        (None, None) => {
            let message = "the task has neither `poses` nor `points`";
            r.report("HP0104", fields.at.clone(), message).help = Some(format!(
                "give the poses of a body, for example {}, or the points of a path, for example {}",
                fields.example("poses"),
                fields.example("points")
            ));
            None
        }
        (Some(_), Some(_)) => {
            r.out_of_place(fields, "points", "the task has `poses`, which contain the points");
            None
        }
        (Some(f), None) => {
            for key in OF_POINTS {
                r.out_of_place(fields, key, "it belongs to `points`, and the task has `poses`");
            }
            let [x, y] = POINT;
            let (poses, entries) = rows(r, fields, f, [x, y, ("angle", Quantity::Angle)])?;
            Some((TaskAim::Poses(poses), f.value.span(), entries))
        }
        (None, Some(f)) => {
            let (points, entries) = rows(r, fields, f, POINT)?;
            let is_closed = r.flag_of(fields, "closed")?;
            let crank_angles = r.given(fields, "crank_angles", |r, f| {
                let subject = fields.subject(f.key);
                let list = r.list(f.value, &subject, "a list of angles")?;
                all_read(list.into_iter().map(|v| r.quantity(v, &subject, ANGLE)))
            });
            let tolerance = fields.get("tolerance").and_then(|f| {
                let tolerance = r.number_of(fields, "tolerance")?;
                if tolerance < 0.0 {
                    let message = "`tolerance` of the task is negative";
                    r.senseless(f.value.span(), message).help = Some("give a distance from 0".into());
                }
                Some(tolerance)
            });
            Some((TaskAim::Path { points, is_closed, crank_angles, tolerance }, f.value.span(), entries))
        }
    }
}

/// Name and quantity of a column.
type ColumnOf = (&'static str, Quantity);
/// Columns of points.
const POINT: [ColumnOf; 2] = [("x", Quantity::Length), ("y", Quantity::Length)];

/// Rows of numbers, SI, in a list, or in a CSV file whose first line may name its columns.
fn rows<const N: usize>(
    r: &mut Reader<'_>,
    fields: &Fields<'_>,
    f: Field<'_>,
    columns: [ColumnOf; N],
) -> Option<(Vec<[f64; N]>, Places)> {
    let (subject, units) = (fields.subject(f.key), r.units);
    let one = format!("[{}]", columns.map(|(name, _)| name).join(", "));
    let (rows, places) = if f.value.get_ref().is_str() {
        let file = r.name(f.value, &subject, "the name of a CSV file")?;
        let found = r.text_of_file(&file, &FILE).and_then(|text| rows_in(text, &file, &columns, units));
        (found.map_err(|e| r.data_error(f.value.span(), e)).ok()?, Vec::new())
    } else {
        let list =
            r.list(f.value, &subject, &format!("a list of rows `{one}`, or the name of a CSV file"))?;
        let places = list.iter().map(|v| v.span()).collect();
        let expected = format!("a row `{one}`");
        let in_si = |row: [f64; N]| std::array::from_fn(|k| units.to_si(columns[k].1, row[k]));
        let rows = (0..).zip(&list);
        let rows = rows.map(|(k, v)| r.numbers::<N>(v, &subject.item(k), &expected).map(in_si));
        (all_read(rows)?, places)
    };
    if rows.len() > MOST_POINTS {
        let message = format!("{} has {} rows", subject.name, rows.len());
        r.senseless(f.value.span(), message).help = Some(format!("give at most {MOST_POINTS}"));
        return None;
    }
    Some((rows, places))
}

/// Rows of a CSV text, SI.
fn rows_in<const N: usize>(
    text: &str,
    name: &str,
    columns: &[ColumnOf; N],
    units: Units,
) -> Result<Vec<[f64; N]>, DataError> {
    let name = shown(name);
    let mut reader = records_of(text.strip_prefix('\u{feff}').unwrap_or(text));
    let mut record = csv::StringRecord::new();
    // Index of each column in the file, and the units of its numbers
    let mut places = None;
    let mut rows = Vec::new();
    let write = format!("write the columns {} on each line", columns.map(|(name, _)| name).join(", "));
    while reader.read_record(&mut record).map_err(|e| no_csv(&name, &e))? {
        let line = record.position().map_or(0, csv::Position::line);
        let places: &[(usize, Units); N] = match &places {
            Some(places) => places,
            None if record.iter().all(|cell| unquoted(cell).parse::<f64>().is_err()) => {
                places = Some(header(&record, &name, columns, units)?);
                continue;
            }
            None => places.insert(std::array::from_fn(|k| (k, units))),
        };
        if record.len() > N {
            let message = format!("`{name}`, line {line} has {} columns", record.len());
            return Err(DataError::content(message, &write));
        }
        let mut row = [0.0; N];
        for ((x, (place, units)), (title, quantity)) in row.iter_mut().zip(places).zip(columns) {
            let here = format!("`{name}`, line {line}, column {} (`{title}`)", place + 1);
            *x = units.to_si(*quantity, number(record.get(*place).map(unquoted), &here, &write)?);
        }
        rows.push(row);
    }
    if rows.is_empty() { Err(DataError::content(format!("`{name}` is empty"), &write)) } else { Ok(rows) }
}

/// Index of each column in a file by the titles of its first line, and the units of its numbers.
fn header<const N: usize>(
    record: &csv::StringRecord,
    file: &str,
    columns: &[ColumnOf; N],
    units: Units,
) -> Result<[(usize, Units); N], DataError> {
    const CODE: &str = "HP0112";
    let names = columns.map(|(name, _)| name);
    let mut found = [None; N];
    for (place, cell) in record.iter().enumerate() {
        let title = Title::of(cell);
        let note = format!("it is the title of column {} of `{file}`", place + 1);
        let Some(k) = names.iter().position(|name| title.name.eq_ignore_ascii_case(name)) else {
            let message = format!("`{}` is not a column of the table", shown(&title.name));
            let help = format!(
                "name the columns {}, in any order, or leave the line of names out",
                names.join(", ")
            );
            return Err(DataError::new(CODE, message, help).note(note));
        };
        if found[k].is_some() {
            let message = format!("`{}` is the title of two columns of `{file}`", names[k]);
            return Err(DataError::new(CODE, message, "remove one of the two"));
        }
        let quantity = columns[k].1;
        let own = title.units(units, quantity.into(), symbol(units, quantity), CODE);
        found[k] = Some((place, own.map_err(|error| error.note(note))?));
    }
    let mut all = [(0, units); N];
    for ((one, found), name) in all.iter_mut().zip(found).zip(names) {
        *one = found.ok_or_else(|| {
            let message = format!("`{file}` has no column `{name}`");
            DataError::new(CODE, message, format!("add the column; the table has {}", names.join(", ")))
        })?;
    }
    Ok(all)
}

/// Types of linkages: four-bars, slider-cranks.
fn linkages(r: &mut Reader<'_>, fields: &Fields<'_>) -> Option<[bool; 2]> {
    let Some(f) = fields.get("linkages") else { return Some([true; 2]) };
    let subject = fields.subject(f.key);
    let list = r.list(f.value, &subject, "a list of types of linkages")?;
    let words = LINKAGE.words();
    let mut found = [false; 2];
    for value in list {
        let word = r.name(value, &subject, &LINKAGE.noun())?;
        match words.iter().position(|w| *w == word) {
            Some(k) => found[k] = true,
            None => {
                r.unknown_word(value.span(), &subject, &word, &words);
                return None;
            }
        }
    }
    if found == [false; 2] {
        r.senseless(f.value.span(), "`linkages` of the task is empty").help =
            Some("name at least one type, or leave it out".into());
        return None;
    }
    Some(found)
}

fn region(r: &mut Reader<'_>, fields: &Fields<'_>, key: &str) -> Option<TaskRegion> {
    r.given(fields, key, |r, f| {
        let table = r.table(f.value, &fields.subject(f.key), "a table with `x` and `y`")?;
        let own = r.fields(format!("`{}`", f.key), f.value.span(), table, REGION.keys());
        let sides = ["x", "y"].map(|side| {
            let ends = r.list_of::<2>(&own, side, "its lower and its upper end")?;
            if ends[0] < ends[1] {
                return Some(ends);
            }
            let at = own.get(side).map_or(own.at.clone(), |f| f.value.span());
            r.senseless(at, format!("{} has no width", own.subject(side).name)).help =
                Some("give the lower end first".into());
            None
        });
        let [x, y] = sides;
        Some([x?, y?])
    })
}
