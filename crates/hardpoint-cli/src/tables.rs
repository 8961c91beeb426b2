//! The tables that a run writes while it solves: which, how large, and in which format.

use hardpoint::Solution;
use hardpoint::model::Model;
use hardpoint::sensitivity::Admissibility;
use hardpoint_file::{ModelFile, Units};
use hardpoint_report::columns::Columns;
use hardpoint_report::csv::{MotionCsv, SensitivityCsv, without_variables};
use hardpoint_report::figures::bytes;
use hardpoint_report::npy::{Npy, Sidecar, add_motion, add_sensitivities};

use crate::args::{Format, Run};
use crate::folder::{Folder, NotWritten, Writing};
use crate::session::json_text;

/// The motion of more bodies than this is written only where it is asked for.
const MOST_BODIES: usize = 100;
/// Sensitivities of more bodies times variables than this are written only where they are asked for.
const MOST_MOVED: usize = 200;
/// What is larger than this is announced before the work.
const LARGE: u64 = 100 << 20;
/// Why there is no table of sensitivities.
const INTERRUPTED: &str = "left out: `sensitivity.csv`, because the run was interrupted while the rows of variables were taken out \
    of it that the mechanism cannot follow";
/// A number with all its digits, in CSV.
const CSV_NUMBER: u64 = 19;
const NPY_NUMBER: u64 = 8;

/// Which tables are written.
#[derive(Clone, Copy, Debug)]
pub struct Plan<'m> {
    format: Format,
    steps: u64,
    motion: Option<Columns<'m>>,
    sensitivity: Option<Columns<'m>>,
    left_out: [Option<&'static str>; 2],
}

impl<'m> Plan<'m> {
    /// Those of a model.
    pub fn new(file: &'m ModelFile, options: &Run) -> Self {
        let (model, units): (&Model, Units) = (&file.model, file.units);
        let bodies = model.bodies.len() - 1;
        let has_outputs = !hardpoint::measure::outputs(model).is_empty();
        let columns = |bodies: bool| Columns { model, units, bodies };
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
                // Of a model with measures or points, these are what the user asked for.
                (!sensitivity.bodies && wanted && (!has_outputs || !motion.bodies))
                    .then_some("the sensitivities of the bodies"),
            ],
        }
    }

    /// What is not written, and how to have it.
    pub fn left_out(&self) -> Option<String> {
        let what: Vec<&str> = self.left_out.into_iter().flatten().collect();
        (!what.is_empty()).then(|| format!("left out: {}; `--bodies` writes that", what.join(" and ")))
    }

    /// The names of the tables with about what they take.
    fn sizes(&self) -> Vec<(String, u64)> {
        let number = if self.format == Format::Npy { NPY_NUMBER } else { CSV_NUMBER };
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

    /// What there is to say before the work where much will be written.
    pub fn announcement(&self, folder: &str) -> Option<String> {
        let sizes = self.sizes();
        let all: u64 = sizes.iter().map(|(_, size)| size).sum();
        let each: Vec<String> = sizes.iter().map(|(name, size)| format!("{name} {}", bytes(*size))).collect();
        let mut ways = vec!["fewer `steps`"];
        if self.format == Format::Csv {
            ways.push("`--format npy`, about half of it");
        }
        if self.sensitivity.is_some() {
            ways.push("`--no-sensitivities`");
        }
        (all > LARGE).then(|| {
            let (all, each) = (bytes(all), each.join(", "));
            format!("up to {all} will be written into `{folder}` ({each}); less with {}", ways.join(", "))
        })
    }

    /// Begins the tables.
    pub fn begin(self, folder: &Folder) -> Result<Tables<'m>, NotWritten> {
        let [motion, sensitivity] =
            ["motion", "sensitivity"].map(|name| format!("{name}.{}", self.format.suffix()));
        let mut tables = Tables {
            plan: self,
            motion: None,
            sensitivity: None,
            names: Vec::new(),
            rows: Vec::new(),
            failure: None,
        };
        if let Some(columns) = self.motion {
            let writing = folder.begin(&motion)?;
            let failed = |error: std::io::Error| NotWritten { path: folder.path_of(&motion), error };
            tables.motion = Some(match self.format {
                Format::Csv => {
                    Motion::Csv(Box::new(MotionCsv::new(columns, writing).map_err(|e| failed(e.into()))?))
                }
                Format::Npy => {
                    Motion::Npy(columns, Npy::new(&[1 + columns.of_motion().len()], writing).map_err(failed)?)
                }
            });
            tables.names.push(motion);
        }
        if let Some(columns) = self.sensitivity {
            let writing = folder.begin(&sensitivity)?;
            let failed = |error: std::io::Error| NotWritten { path: folder.path_of(&sensitivity), error };
            let shape = [columns.model.variables.len(), columns.of_sensitivities().len()];
            tables.sensitivity = Some(match self.format {
                Format::Csv => Sensitivity::Csv(Box::new(
                    SensitivityCsv::new(columns, writing).map_err(|e| failed(e.into()))?,
                )),
                Format::Npy => Sensitivity::Npy(columns, Npy::new(&shape, writing).map_err(failed)?),
            });
            tables.names.push(sensitivity);
        }
        Ok(tables)
    }
}

enum Motion<'m> {
    Csv(Box<MotionCsv<'m, Writing>>),
    Npy(Columns<'m>, Npy<Writing>),
}

enum Sensitivity<'m> {
    Csv(Box<SensitivityCsv<'m, Writing>>),
    Npy(Columns<'m>, Npy<Writing>),
}

/// Tables under way.
pub struct Tables<'m> {
    plan: Plan<'m>,
    motion: Option<Motion<'m>>,
    sensitivity: Option<Sensitivity<'m>>,
    names: Vec<String>,
    /// Per variable, how many output times have sensitivities by it.
    rows: Vec<usize>,
    failure: Option<(String, std::io::Error)>,
}

/// What was written.
#[derive(Debug)]
pub struct Written {
    /// The names of the files.
    pub names: Vec<String>,
    /// What is not among them, and why.
    pub left_out: Option<String>,
}

impl Tables<'_> {
    /// Writes the rows of a window; false where that failed, now or before.
    pub fn add(&mut self, window: &Solution) -> bool {
        if self.failure.is_none() {
            self.failure = self.try_add(window).err();
        }
        self.failure.is_none()
    }

    fn try_add(&mut self, window: &Solution) -> Result<(), (String, std::io::Error)> {
        let name = |what: &str| {
            let of = |n: &&String| n.starts_with(what);
            self.names.iter().find(of).cloned().unwrap_or_default()
        };
        let added = match &mut self.motion {
            Some(Motion::Csv(table)) => table.add(window).map_err(Into::into),
            Some(Motion::Npy(columns, table)) => add_motion(table, columns, window),
            None => Ok(()),
        };
        added.map_err(|e| (name("motion"), e))?;
        let added = match &mut self.sensitivity {
            Some(Sensitivity::Csv(table)) => table.add(window).map_err(Into::into),
            Some(Sensitivity::Npy(columns, table)) => add_sensitivities(table, columns, window),
            None => Ok(()),
        };
        added.map_err(|e| (name("sensitivity"), e))?;
        let sensitivities = &window.sensitivities;
        self.rows.resize(sensitivities.variables, 0);
        for (rows, answer) in self.rows.iter_mut().zip(&sensitivities.admissibility) {
            if !cannot(answer) {
                *rows += window.motion.len();
            }
        }
        Ok(())
    }

    /// Ends the tables, without what turned out not to be followed. `go_on` says whether there is time to take that out.
    pub fn end(
        self,
        folder: &mut Folder,
        answers: &[Admissibility],
        go_on: impl FnMut() -> bool,
    ) -> Result<Written, NotWritten> {
        let Self { plan, motion, sensitivity, mut names, rows, failure } = self;
        let mut left_out = None;
        if let Some((name, error)) = failure {
            return Err(NotWritten { path: folder.path_of(&name), error });
        }
        let failed = |what: &str, folder: &Folder, error: std::io::Error| {
            let path = folder.path_of(&format!("{what}.{}", plan.format.suffix()));
            NotWritten { path, error }
        };
        match motion {
            Some(Motion::Csv(table)) => {
                let writing = table.end().map_err(|e| failed("motion", folder, e))?;
                folder.end(writing)?;
            }
            Some(Motion::Npy(_, table)) => {
                let writing = table.end().map_err(|e| failed("motion", folder, e))?;
                folder.end(writing)?;
            }
            None => {}
        }
        let unknown: Vec<usize> = (0..answers.len()).filter(|b| cannot(&answers[*b])).collect();
        match sensitivity {
            // By none of the variables is there anything to say.
            Some(_) if unknown.len() == answers.len() => names.retain(|n| !n.starts_with("sensitivity")),
            Some(Sensitivity::Csv(table)) => {
                let columns = plan.sensitivity.expect("it is under way");
                // Those of all variables, up to the last output time that has any of the unknown.
                let last = unknown.iter().map(|b| rows[*b]).max().unwrap_or(0);
                let rows: usize = rows.iter().map(|n| n.min(&last)).sum();
                let mut writing = table.end().map_err(|e| failed("sensitivity", folder, e))?;
                if rows == 0 {
                    folder.end(writing)?;
                } else {
                    let unknown: Vec<&str> =
                        unknown.iter().map(|b| columns.model.variables[*b].name.as_str()).collect();
                    let before = writing.reopen().map_err(|e| writing.failed(e))?;
                    let mut without = folder.begin("sensitivity.csv")?;
                    let whole = without_variables(before, &unknown, rows as u64, &mut without, go_on)
                        .map_err(|e| without.failed(e))?;
                    if whole {
                        folder.end(without)?;
                    } else {
                        names.retain(|n| !n.starts_with("sensitivity"));
                        left_out = Some(INTERRUPTED.into());
                    }
                }
            }
            Some(Sensitivity::Npy(columns, mut table)) => {
                let width = columns.of_sensitivities().len();
                let none = unknown.iter().try_for_each(|&b| table.forget(rows[b], b * width, width));
                none.map_err(|e| failed("sensitivity", folder, e))?;
                let writing = table.end().map_err(|e| failed("sensitivity", folder, e))?;
                folder.end(writing)?;
            }
            None => {}
        }
        if let (Format::Npy, Some(motion)) = (plan.format, &plan.motion) {
            let sensitivity = plan.sensitivity.filter(|_| names.iter().any(|n| n.starts_with("sensitivity")));
            let json = json_text(&Sidecar::new(motion, sensitivity.as_ref()));
            folder.write("columns.json", |out| std::io::Write::write_all(out, json.as_bytes()))?;
            names.push("columns.json".into());
        }
        Ok(Written { names, left_out })
    }
}

fn cannot(answer: &Admissibility) -> bool {
    matches!(answer, Admissibility::CannotFollow { .. })
}
