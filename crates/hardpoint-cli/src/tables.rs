//! Tables that a run writes while it solves: selection, size and format.

use std::io;

use hardpoint::Solution;
use hardpoint::model::Model;
use hardpoint::sensitivity::Admissibility;
use hardpoint_file::{ModelFile, Units};
use hardpoint_report::cells::Cells;
use hardpoint_report::columns::{Column, Columns};
use hardpoint_report::figures::{bytes, variable_unit};
use hardpoint_report::npy::{Npy, Sidecar, add_motion, add_sensitivities};
use hardpoint_report::results::{MotionCsv, SensitivityCsv, without_variables};

use crate::args::{Format, Orientation, Run};
use crate::folder::{Folder, PendingFile, WriteError};
use crate::session::json_text;
use hardpoint_export::long_table::{TableFormat, TableWriter};

/// Maximum number of bodies whose motion is written by default.
const MOST_BODIES: usize = 100;
/// Maximum number of bodies times variables whose sensitivities are written by default.
const MOST_MOVED: usize = 200;
/// Size in bytes above which the output is announced before the run.
const LARGE: u64 = 100 << 20;
/// Size of a number with all its digits, in CSV.
const CSV_NUMBER: u64 = 19;
/// Size of a number in binary formats.
const DOUBLE: u64 = 8;

/// Tables to write.
#[derive(Clone, Copy, Debug)]
pub struct Plan<'m> {
    format: Format,
    steps: u64,
    motion: Option<Columns<'m>>,
    sensitivity: Option<Columns<'m>>,
    left_out: [Option<&'static str>; 2],
}

impl<'m> Plan<'m> {
    /// Plans the tables of a model.
    pub fn new(file: &'m ModelFile, options: &Run) -> Self {
        let (model, units): (&Model, Units) = (&file.model, file.units);
        let bodies = model.bodies.len() - 1;
        let has_outputs = !hardpoint::measure::outputs(model).is_empty();
        let angles = options.angles.map(Orientation::angles);
        let columns = |bodies: bool| Columns { model, units, bodies, angles };
        let some = |c: Columns<'m>| (c.bodies || has_outputs).then_some(c);
        let motion = columns(options.bodies || bodies <= MOST_BODIES);
        let few = !has_outputs && bodies * model.variables.len() <= MOST_MOVED;
        let wanted = !model.variables.is_empty() && !options.no_sensitivities;
        let sensitivity = columns(options.bodies || few);
        Self {
            format: options.format,
            steps: model.times.len() as u64,
            motion: some(motion),
            sensitivity: some(sensitivity).filter(|_| wanted),
            left_out: [
                (!motion.bodies).then_some("the motion of the bodies"),
                // In a model with measures or points, the user requested these.
                (!sensitivity.bodies && wanted && (!has_outputs || !motion.bodies))
                    .then_some("the sensitivities of the bodies"),
            ],
        }
    }

    /// Note on tables that are not written, with the option that writes them.
    pub fn left_out(&self) -> Option<String> {
        let what: Vec<&str> = self.left_out.into_iter().flatten().collect();
        (!what.is_empty()).then(|| format!("left out: {}; `--bodies` writes them", what.join(" and ")))
    }

    /// Names of the tables with their approximate sizes.
    fn sizes(&self) -> Vec<(String, u64)> {
        let number = if self.format == Format::Csv { CSV_NUMBER } else { DOUBLE };
        let table = |name: &str, rows: u64, columns: usize| {
            (format!("{name}.{}", self.format.suffix()), rows * columns as u64 * number)
        };
        let motion = self.motion.map(|c| table("motion", self.steps, 1 + c.of_motion().len()));
        let sensitivity = self.sensitivity.map(|c| {
            let rows = self.steps * c.model.variables.len() as u64;
            table("sensitivity", rows, 1 + c.of_sensitivities().len())
        });
        motion.into_iter().chain(sensitivity).collect()
    }

    /// Announcement of large output before the run.
    pub fn announcement(&self, folder: &str) -> Option<String> {
        let sizes = self.sizes();
        let all: u64 = sizes.iter().map(|(_, size)| size).sum();
        let each: Vec<String> = sizes.iter().map(|(name, size)| format!("{name} {}", bytes(*size))).collect();
        let mut ways = vec!["fewer `steps`"];
        if self.format == Format::Csv {
            ways.push("`--format npy` or `parquet`, about half of it");
        }
        if self.sensitivity.is_some() {
            ways.push("`--no-sensitivities`");
        }
        (all > LARGE).then(|| {
            let (all, each) = (bytes(all), each.join(", "));
            format!("up to {all} will be written into `{folder}` ({each}); less with {}", ways.join(", "))
        })
    }

    /// Creates the tables.
    pub fn begin(self, folder: &Folder) -> Result<Tables<'m>, WriteError> {
        let begun = |name: &str, begin: &dyn Fn(PendingFile) -> io::Result<Table<'m>>| {
            let name = format!("{name}.{}", self.format.suffix());
            let table = begin(folder.begin(&name)?);
            table
                .map_err(|error| WriteError { path: folder.path_of(&name), error })
                .map(|table| (name, table))
        };
        let motion = self.motion.map(|c| begun("motion", &|out| self.motion_table(c, out))).transpose()?;
        let sensitivity = self
            .sensitivity
            .map(|c| begun("sensitivity", &|out| self.sensitivity_table(c, out)))
            .transpose()?;
        Ok(Tables { plan: self, motion, sensitivity, rows: Vec::new(), failure: None })
    }

    fn motion_table(&self, columns: Columns<'m>, out: PendingFile) -> io::Result<Table<'m>> {
        Ok(match self.format {
            Format::Csv => Table::Motion(Box::new(MotionCsv::new(columns, out)?)),
            Format::Npy => Table::MotionNpy(columns, Npy::new(&[1 + columns.of_motion().len()], out)?),
            Format::Parquet => {
                Table::MotionParquet(columns, Box::new(parquet(out, columns, &[], &columns.of_motion())?))
            }
        })
    }

    fn sensitivity_table(&self, columns: Columns<'m>, out: PendingFile) -> io::Result<Table<'m>> {
        let of = columns.of_sensitivities();
        Ok(match self.format {
            Format::Csv => Table::Sensitivity(Box::new(SensitivityCsv::new(columns, out)?)),
            Format::Npy => {
                Table::SensitivityNpy(columns, Npy::new(&[columns.model.variables.len(), of.len()], out)?)
            }
            Format::Parquet => {
                Table::SensitivityParquet(columns, Box::new(parquet(out, columns, &VARIABLE, &of)?))
            }
        })
    }
}

/// Columns after the time: a variable and its unit.
const VARIABLE: [&str; 2] = ["variable", "per"];

/// Creates a Parquet file: time, texts, numbers. The metadata have the model and the unit of each numeric column.
fn parquet(
    out: PendingFile,
    columns: Columns<'_>,
    texts: &[&str],
    numbers: &[Column],
) -> io::Result<TableWriter<PendingFile>> {
    let time = Column { name: "t".into(), unit: "s".into() };
    let number = |c: &Column| (c.header(), Cells::Numbers(Vec::new()));
    let text = |name: &&str| ((*name).to_owned(), Cells::Texts(Vec::new()));
    let kinds = [number(&time)].into_iter().chain(texts.iter().map(text)).chain(numbers.iter().map(number));
    let units: serde_json::Map<String, serde_json::Value> =
        [&time].into_iter().chain(numbers).map(|c| (c.header(), c.unit.as_str().into())).collect();
    let facts =
        [("model", columns.model.name.clone()), ("units", serde_json::Value::Object(units).to_string())];
    TableWriter::new(out, TableFormat::Parquet, kinds.collect(), &facts)
}

/// A table that is being written.
enum Table<'m> {
    Motion(Box<MotionCsv<'m, PendingFile>>),
    MotionNpy(Columns<'m>, Npy<PendingFile>),
    MotionParquet(Columns<'m>, Box<TableWriter<PendingFile>>),
    Sensitivity(Box<SensitivityCsv<'m, PendingFile>>),
    SensitivityNpy(Columns<'m>, Npy<PendingFile>),
    SensitivityParquet(Columns<'m>, Box<TableWriter<PendingFile>>),
}

impl Table<'_> {
    fn add(&mut self, window: &Solution) -> io::Result<()> {
        match self {
            Self::Motion(table) => table.add(window).map_err(Into::into),
            Self::MotionNpy(columns, table) => add_motion(table, columns, window),
            Self::MotionParquet(columns, table) => table.add(motion_cells(columns, window)),
            Self::Sensitivity(table) => table.add(window).map_err(Into::into),
            Self::SensitivityNpy(columns, table) => add_sensitivities(table, columns, window),
            Self::SensitivityParquet(columns, table) => table.add(sensitivity_cells(columns, window)),
        }
    }

    fn end(self) -> io::Result<PendingFile> {
        match self {
            Self::Motion(table) => table.end(),
            Self::Sensitivity(table) => table.end(),
            Self::MotionNpy(_, table) | Self::SensitivityNpy(_, table) => table.end(),
            Self::MotionParquet(_, table) | Self::SensitivityParquet(_, table) => table.end(),
        }
    }
}

fn motion_cells(columns: &Columns<'_>, window: &Solution) -> Vec<Cells> {
    let mut cells = vec![Vec::new(); 1 + columns.of_motion().len()];
    let mut row = Vec::new();
    for (k, &t) in window.motion.times.iter().enumerate() {
        row.clear();
        row.push(t);
        columns.motion(window, k, &mut row);
        cells.iter_mut().zip(&row).for_each(|(cells, x)| cells.push(*x));
    }
    cells.into_iter().map(Cells::Numbers).collect()
}

/// Rows for all variables with sensitivities in the window.
fn sensitivity_cells(columns: &Columns<'_>, window: &Solution) -> Vec<Cells> {
    let (mut times, mut texts) = (Vec::new(), [Vec::new(), Vec::new()]);
    let mut cells = vec![Vec::new(); columns.of_sensitivities().len()];
    let mut row = Vec::new();
    for (k, &t) in window.motion.times.iter().enumerate() {
        for (b, variable) in columns.model.variables.iter().enumerate() {
            row.clear();
            if columns.sensitivities(window, k, b, &mut row).is_some() {
                times.push(t);
                texts[0].push(variable.name.clone());
                texts[1].push(variable_unit(columns.model, columns.units, variable));
                cells.iter_mut().zip(&row).for_each(|(cells, x)| cells.push(*x));
            }
        }
    }
    let numbers = cells.into_iter().map(Cells::Numbers);
    std::iter::once(Cells::Numbers(times)).chain(texts.map(Cells::Texts)).chain(numbers).collect()
}

/// Tables that are being written, by name.
pub struct Tables<'m> {
    plan: Plan<'m>,
    motion: Option<(String, Table<'m>)>,
    sensitivity: Option<(String, Table<'m>)>,
    /// Number of output times with sensitivities, per variable.
    rows: Vec<usize>,
    failure: Option<(String, io::Error)>,
}

/// Tables that were written.
#[derive(Debug)]
pub struct TableSummary {
    /// Names of the files.
    pub names: Vec<String>,
    /// Tables that were left out, with the reason.
    pub left_out: Option<String>,
}

impl Tables<'_> {
    /// Writes the rows of a window; returns false after a failure.
    pub fn add(&mut self, window: &Solution) -> bool {
        if self.failure.is_none() {
            self.failure = self.try_add(window).err();
        }
        self.failure.is_none()
    }

    fn try_add(&mut self, window: &Solution) -> Result<(), (String, io::Error)> {
        for (name, table) in self.motion.iter_mut().chain(&mut self.sensitivity) {
            table.add(window).map_err(|e| (name.clone(), e))?;
        }
        let sensitivities = &window.sensitivities;
        self.rows.resize(sensitivities.variables, 0);
        for (rows, answer) in self.rows.iter_mut().zip(&sensitivities.admissibility) {
            if !cannot(answer) {
                *rows += window.motion.len();
            }
        }
        Ok(())
    }

    /// Completes the tables and removes rows of variables that proved inadmissible, as long as `go_on` returns true.
    pub fn end(
        self,
        folder: &mut Folder,
        answers: &[Admissibility],
        go_on: impl FnMut() -> bool,
    ) -> Result<TableSummary, WriteError> {
        let Self { plan, motion, sensitivity, rows, failure } = self;
        let failed = |name: &str, folder: &Folder, error| WriteError { path: folder.path_of(name), error };
        if let Some((name, error)) = failure {
            return Err(failed(&name, folder, error));
        }
        let (mut names, mut left_out) = (Vec::new(), None);
        if let Some((name, table)) = motion {
            let writing = table.end().map_err(|e| failed(&name, folder, e))?;
            folder.end(writing)?;
            names.push(name);
        }
        let unknown: Vec<usize> = (0..answers.len()).filter(|b| cannot(&answers[*b])).collect();
        // Without an admissible variable, there is no table.
        if let Some((name, mut table)) = sensitivity.filter(|_| unknown.len() < answers.len()) {
            let columns = plan.sensitivity.expect("it is under way");
            if let Table::SensitivityNpy(_, table) = &mut table {
                let width = columns.of_sensitivities().len();
                let none = unknown.iter().try_for_each(|&b| table.forget(rows[b], b * width, width));
                none.map_err(|e| failed(&name, folder, e))?;
            }
            let mut writing = table.end().map_err(|e| failed(&name, folder, e))?;
            // Rows of all variables up to the last output time with rows to be removed.
            let last = unknown.iter().map(|b| rows[*b]).max().unwrap_or(0);
            let rows: usize = rows.iter().map(|n| n.min(&last)).sum();
            let whole = if rows == 0 || plan.format == Format::Npy {
                Some(writing)
            } else {
                let unknown: Vec<&str> =
                    unknown.iter().map(|b| columns.model.variables[*b].name.as_str()).collect();
                let before = writing.reopen().map_err(|e| writing.failed(e))?;
                let mut out = folder.begin(&name)?;
                let whole = match plan.format {
                    Format::Parquet => parquet(out, columns, &VARIABLE, &columns.of_sensitivities())
                        .and_then(|mut table| {
                            let whole = table.add_file(before, 1, |v| !unknown.contains(&v), go_on)?;
                            table.end().map(|out| whole.then_some(out))
                        }),
                    _ => without_variables(before, &unknown, rows as u64, &mut out, go_on)
                        .map(|whole| whole.then_some(out))
                        .map_err(Into::into),
                };
                whole.map_err(|e| failed(&name, folder, e))?
            };
            match whole {
                Some(writing) => {
                    folder.end(writing)?;
                    names.push(name);
                }
                None => left_out = Some(interrupted(&name)),
            }
        }
        if let (Format::Npy, Some(motion)) = (plan.format, &plan.motion) {
            let sensitivity = plan.sensitivity.filter(|_| names.iter().any(|n| n.starts_with("sensitivity")));
            let json = json_text(&Sidecar::new(motion, sensitivity.as_ref()));
            folder.write("columns.json", |out| io::Write::write_all(out, json.as_bytes()))?;
            names.push("columns.json".into());
        }
        Ok(TableSummary { names, left_out })
    }
}

/// Message for a missing table of sensitivities.
fn interrupted(name: &str) -> String {
    format!(
        "left out: `{name}`, because the run was interrupted before the rows of inadmissible variables were removed"
    )
}

fn cannot(answer: &Admissibility) -> bool {
    matches!(answer, Admissibility::CannotFollow { .. })
}
