//! Common parts of the commands: reading the model, solving with progress and interruption, reporting errors as text or
//! JSON.

use std::cell::Cell;
use std::io::Write;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use hardpoint::model::{CaseId, Grid, VariableId};
use hardpoint::motion::Execution;
use hardpoint::topology::{Formulation, TopologyError};
use hardpoint::{Analysis, Footprint, Run, Solution};
use hardpoint_file::{Diagnostic, Diagnostics, ModelFile, ReadError};
use hardpoint_report::course::{Course, Gathering};
use hardpoint_report::figures::bytes;
use hardpoint_report::{GENERATOR, diagnose};
use hardpoint_study::RequestError;
use hardpoint_study::request::named;
use serde_json::json;

use crate::args::Motions;
use crate::folder::{self, Folder, WriteError, write_alone};
use crate::meter::{Listener, Meter};
use crate::outcome::Outcome;
use crate::text;

/// Receiver of a session's reports.
enum Audience {
    /// A terminal.
    Terminal,
    /// A program, which gets one JSON document.
    Program,
    /// A page.
    Page(Arc<dyn Listener>),
    /// An agent, which gets the JSON documents one by one.
    Agent(Arc<dyn Listener>),
}

/// A running command.
pub struct Session {
    audience: Audience,
    started: Instant,
    interrupted: Arc<AtomicBool>,
    patient: Arc<AtomicBool>,
    /// JSON documents of the finished cases, if there are several.
    cases: Mutex<Option<Vec<serde_json::Value>>>,
    /// Current case.
    case: Mutex<Option<String>>,
    /// True if a JSON document was printed.
    has_printed: AtomicBool,
}

/// Handler of a case that is a grid, with the whole file.
type EachGrid<'a> = &'a mut dyn FnMut(&ModelFile, &Grid) -> Result<Outcome, Outcome>;

/// Size of a window of results in bytes: small enough to be written quickly.
const WINDOW_BYTES: usize = 4 << 20;
/// Maximum size of a window in bytes. A window has at least one output time per lane; if that is larger, nothing is
/// solved.
const MOST_BYTES: usize = 512 << 20;
/// Maximum size in bytes of a motion that is studied as a whole; longer motions are studied with fewer output times.
const STUDY_BYTES: usize = 96 << 20;

impl Session {
    /// Begins a session. From now on Ctrl-C requests a stop, and a second Ctrl-C ends the program at once.
    pub fn begin(json: bool) -> Self {
        // Shells and job runners may send the same signal to a process and to its group.
        const SAME_REQUEST: Duration = Duration::from_millis(500);
        /// Time within which running work notices the request.
        const PATIENCE: Duration = Duration::from_millis(700);
        let interrupted = Arc::new(AtomicBool::new(false));
        let patient = Arc::new(AtomicBool::new(false));
        let (flag, waits) = (Arc::clone(&interrupted), Arc::clone(&patient));
        let mut first = None;
        // Without a handler, Ctrl-C ends the program at once; that is acceptable.
        let _ = ctrlc::set_handler(move || {
            flag.store(true, Ordering::SeqCst);
            let again = first.get_or_insert_with(Instant::now).elapsed() > SAME_REQUEST;
            if !again && !waits.load(Ordering::SeqCst) {
                std::thread::sleep(PATIENCE);
            }
            if again || !waits.load(Ordering::SeqCst) {
                folder::abandon();
                if json {
                    text::print(&json_text(&document_of("interrupted", &[])));
                }
                std::process::exit(Outcome::Interrupted as i32);
            }
        });
        let audience = if json { Audience::Program } else { Audience::Terminal };
        Self::of(audience, interrupted, patient)
    }

    /// Session for a page, which may interrupt it with this flag.
    pub fn for_page(listener: Arc<dyn Listener>, interrupted: Arc<AtomicBool>) -> Self {
        Self::of(Audience::Page(listener), interrupted, Arc::new(AtomicBool::new(true)))
    }

    /// Session for an agent, which may interrupt it with this flag.
    pub fn for_agent(listener: Arc<dyn Listener>, interrupted: Arc<AtomicBool>) -> Self {
        Self::of(Audience::Agent(listener), interrupted, Arc::new(AtomicBool::new(true)))
    }

    fn of(audience: Audience, interrupted: Arc<AtomicBool>, patient: Arc<AtomicBool>) -> Self {
        Self {
            audience,
            started: Instant::now(),
            interrupted,
            patient,
            cases: Mutex::new(None),
            case: Mutex::new(None),
            has_printed: AtomicBool::new(false),
        }
    }

    fn listener(&self) -> Option<&Arc<dyn Listener>> {
        match &self.audience {
            Audience::Page(listener) | Audience::Agent(listener) => Some(listener),
            Audience::Terminal | Audience::Program => None,
        }
    }

    fn is_for_reading(&self) -> bool {
        matches!(self.audience, Audience::Terminal)
    }

    /// Creates a meter for this work.
    pub fn meter(&self, what: &'static str, unit: &'static str) -> Meter {
        Meter::new(what, unit, self.listener().cloned())
    }

    /// Creates a meter for work of unknown length.
    pub fn working(&self, what: &'static str) -> Meter {
        Meter::working(what, self.listener().cloned())
    }

    /// Reports an intermediate result as a line of text.
    pub fn line(&self, line: &str) {
        match &self.audience {
            Audience::Terminal => text::print(&format!("{line}\n")),
            Audience::Page(listener) | Audience::Agent(listener) => listener.line(line),
            Audience::Program => {}
        }
    }

    /// Sets whether the current work ends by itself soon after a request to stop, and has results to save. Other work
    /// is aborted at once.
    pub fn patient(&self, yes: bool) {
        self.patient.store(yes, Ordering::SeqCst);
    }

    /// True if the user asked to stop.
    pub fn interrupted(&self) -> bool {
        self.interrupted.load(Ordering::SeqCst)
    }

    /// Seconds since the beginning.
    pub fn seconds(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }

    /// Reads the model, or reports its errors.
    pub fn read(&self, path: &Path) -> Result<ModelFile, Outcome> {
        hardpoint_file::read(path).map_err(|error: ReadError| {
            self.not_read(error.diagnostics());
            Outcome::BadModel
        })
    }

    /// Reads the bytes of a file of another program.
    pub fn bytes_of(&self, path: &Path) -> Result<Vec<u8>, Outcome> {
        std::fs::read(path).map_err(|error| {
            let message = format!("`{}` cannot be read", path.display());
            self.refuse(
                "HP0809",
                &message,
                Some(path),
                &error.to_string(),
                "check the path and the read permission",
            );
            Outcome::BadModel
        })
    }

    /// Reports the errors of a file.
    pub fn not_read(&self, diagnostics: &Diagnostics) {
        match &self.audience {
            Audience::Program => self.print_error(diagnostics.list()),
            Audience::Terminal => {
                text::complain(&format!("{}\n", diagnostics.render(text::stderr_in_color())));
            }
            Audience::Page(listener) | Audience::Agent(listener) => {
                listener.refused(json!(diagnostics), &diagnostics.render(false));
            }
        }
    }

    /// Reads the model and runs a command for its motion; for a model with cases, for one case or for all in turn.
    /// `each` receives the name of the case if there are several.
    ///
    /// # Errors
    /// Fails if nothing could be started. The outcome of one case does not prevent the others.
    pub fn for_motions(
        &self,
        path: &Path,
        motions: &Motions,
        each: impl FnMut(ModelFile, Option<&str>) -> Result<Outcome, Outcome>,
    ) -> Result<Outcome, Outcome> {
        self.for_motions_of(self.read(path)?, motions, each)
    }

    /// Same as [`Session::for_motions`] for a model that was read.
    ///
    /// # Errors
    /// Same as there.
    pub fn for_motions_of(
        &self,
        file: ModelFile,
        motions: &Motions,
        each: impl FnMut(ModelFile, Option<&str>) -> Result<Outcome, Outcome>,
    ) -> Result<Outcome, Outcome> {
        self.for_cases_of(file, motions, each, None)
    }

    /// Same as [`Session::for_motions_of`], and calls `each_grid` for every case that is a grid, with the whole file.
    ///
    /// # Errors
    /// Same as there.
    pub fn for_cases_of(
        &self,
        file: ModelFile,
        motions: &Motions,
        mut each: impl FnMut(ModelFile, Option<&str>) -> Result<Outcome, Outcome>,
        mut each_grid: Option<EachGrid<'_>>,
    ) -> Result<Outcome, Outcome> {
        let cases: Vec<&str> = file.model.cases.iter().map(|c| c.name.as_str()).collect();
        let grids = if each_grid.is_some() { &file.model.grids[..] } else { &[] };
        if let Some(name) = &motions.case {
            let Some(each_grid) = &mut each_grid else {
                let id = self.case(&file, name)?;
                return each(file.in_case(id), None);
            };
            return match self.case_or_grid(&file, name)? {
                Ok(id) => each(file.in_case(id), None),
                Err(grid) => each_grid(&file, grid),
            };
        }
        if cases.is_empty() && grids.is_empty() {
            return each(file, None);
        }
        *self.documents() = Some(Vec::new());
        let mut outcome = Outcome::Done;
        // The model's own motion has no name.
        let own = cases.is_empty().then_some(None);
        let motions = own.into_iter().chain((0..cases.len()).map(Some)).map(Ok);
        for of in motions.chain(grids.iter().map(Err)) {
            let case = match of {
                Ok(k) => k.map(|k| cases[k]),
                Err(grid) => Some(&*grid.name),
            };
            let before = self.documents().as_ref().map_or(0, Vec::len);
            *self.under_way() = case.map(Into::into);
            let found = match (of, &mut each_grid) {
                (Ok(Some(k)), _) => each(file.in_case(CaseId(k)), case),
                (Ok(None), _) => each(file.clone(), None),
                (Err(grid), Some(each_grid)) => each_grid(&file, grid),
                (Err(_), None) => Ok(Outcome::Done),
            };
            outcome = outcome.and(found.unwrap_or_else(|outcome| outcome));
            for document in self.documents().iter_mut().flatten().skip(before) {
                *document = json!({ "case": case, "result": document });
            }
            if self.interrupted() {
                break;
            }
        }
        *self.under_way() = None;
        let documents = self.documents().take();
        if self.is_json() {
            self.print_json(&json!({ "generator": GENERATOR, "cases": documents }));
        }
        Ok(outcome)
    }

    /// Case that the command line names.
    ///
    /// # Errors
    /// Fails if there is no such case, or if it is not a motion.
    pub fn case(&self, file: &ModelFile, name: &str) -> Result<CaseId, Outcome> {
        let model = &file.model;
        let found = named("case", name, model.cases.iter().map(|c| c.name.as_str())).map(CaseId);
        found.map_err(|error| match model.grids.iter().any(|grid| grid.name == name) {
            true => self.misunderstood(&format!(
                "`--case {name}`: it is a grid of positions, not a motion; `hardpoint run` solves it"
            )),
            false => self.refused(file, &error),
        })
    }

    /// Case that the command line names, or a grid, for commands that take both.
    ///
    /// # Errors
    /// Fails if there is neither.
    pub fn case_or_grid<'f>(
        &self,
        file: &'f ModelFile,
        name: &str,
    ) -> Result<Result<CaseId, &'f Grid>, Outcome> {
        let (cases, grids) = (&file.model.cases, &file.model.grids);
        let known = cases.iter().map(|case| &*case.name).chain(grids.iter().map(|grid| &*grid.name));
        let found = named("case", name, known).map_err(|error| self.refused(file, &error))?;
        Ok(found.checked_sub(cases.len()).map_or(Ok(CaseId(found)), |grid| Err(&grids[grid])))
    }

    /// Restricts a model to the case that the command line names, if it names one.
    ///
    /// # Errors
    /// Fails as [`Session::case`] does.
    pub fn keep_case(&self, file: &mut ModelFile, name: Option<&str>) -> Result<(), Outcome> {
        if let Some(name) = name {
            file.model = file.model.with_case_only(self.case(file, name)?);
        }
        Ok(())
    }

    /// Indices of the motions for a command.
    ///
    /// # Errors
    /// Fails if the case does not exist.
    pub fn numbers_of(&self, file: &ModelFile, motions: &Motions) -> Result<Vec<usize>, Outcome> {
        match &motions.case {
            Some(name) => Ok(vec![self.case(file, name)?.0]),
            None => Ok((0..usize::max(file.model.cases.len(), 1)).collect()),
        }
    }

    fn documents(&self) -> MutexGuard<'_, Option<Vec<serde_json::Value>>> {
        self.cases.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn under_way(&self) -> MutexGuard<'_, Option<String>> {
        self.case.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes the model file with a changed design, whole or not at all.
    ///
    /// # Errors
    /// Fails if the text does not support the changed design, or the file cannot be written.
    pub fn save(&self, file: &ModelFile, design: &[f64], to: &Path) -> Result<(), Outcome> {
        let text = self.edited(file, design)?;
        let text = text_for(file, &text, to).map_err(|diagnostics| {
            self.fail(file, diagnostics.list());
            Outcome::Misunderstood
        })?;
        write_alone(to, |out| out.write_all(text.as_bytes())).map_err(|e| self.not_written(&e))
    }

    /// Checks before the work that changes of some variables can be saved in the model's text, and this in the folder
    /// of `to`.
    ///
    /// # Errors
    /// Fails if the text has no number for one of them, or cannot name its files from there.
    pub fn can_save(
        &self,
        file: &ModelFile,
        variables: &[VariableId],
        to: Option<&Path>,
    ) -> Result<(), Outcome> {
        let Some(to) = to else { return Ok(()) };
        let checked = file.check_savable(variables).and_then(|()| text_for(file, file.text(), to));
        checked.map(drop).map_err(|diagnostics| {
            self.fail(file, diagnostics.list());
            Outcome::Misunderstood
        })
    }

    /// Writes the model file with a changed design after a search. A failure is returned, not printed, so that the
    /// result can still be shown.
    ///
    /// # Errors
    /// Returns the diagnostics, the cause in one line, and the outcome of the command.
    pub fn save_result(
        &self,
        file: &ModelFile,
        design: &[f64],
        to: &Path,
    ) -> Result<(), (Vec<Diagnostic>, String, Outcome)> {
        let text = file.edit(design).and_then(|text| text_for(file, &text, to)).map_err(|found| {
            let why = found.list().first().map_or(String::new(), |d| d.message.clone());
            (found.list().to_vec(), why, Outcome::Misunderstood)
        })?;
        write_alone(to, |out| out.write_all(text.as_bytes())).map_err(|failure| {
            let why = format!("`{}` cannot be written: {}", failure.path.display(), failure.error);
            (Vec::new(), why, Outcome::NotWritten)
        })
    }

    /// Model text with a changed design.
    ///
    /// # Errors
    /// Fails if the text does not support it.
    pub fn edited(&self, file: &ModelFile, design: &[f64]) -> Result<String, Outcome> {
        file.edit(design).map_err(|diagnostics| {
            self.fail(file, diagnostics.list());
            Outcome::Misunderstood
        })
    }

    /// Folder for results, if requested.
    ///
    /// # Errors
    /// Fails if it is not writable.
    pub fn folder(&self, path: Option<&Path>) -> Result<Option<Folder>, Outcome> {
        path.map(Folder::open).transpose().map_err(|e| self.not_written(&e))
    }

    /// Checks that a file to save to is not the model itself.
    ///
    /// # Errors
    /// Fails if it is the model itself.
    pub fn may_save(&self, model: &Path, to: Option<&Path>) -> Result<(), Outcome> {
        let same = |a: &Path, b: &Path| {
            a.canonicalize().ok().is_some_and(|a| b.canonicalize().is_ok_and(|b| a == b))
        };
        match to {
            Some(to) if same(model, to) => {
                let why = format!(
                    "`{}` would overwrite the model file itself, or its source; write under another name",
                    to.display()
                );
                Err(self.misunderstood(&why))
            }
            Some(to) if to.file_name().is_none() => {
                Err(self.misunderstood(&format!("`{}` is not a file name", to.display())))
            }
            _ => Ok(()),
        }
    }

    /// Plans the solution, or reports why the mechanism cannot be driven.
    pub fn plan<'m>(&self, file: &'m ModelFile, formulation: Formulation) -> Result<Analysis<'m>, Outcome> {
        let analysis = Analysis::with(&file.model, formulation);
        let analysis = analysis.map_err(|fault| self.cannot_be_driven(file, &fault))?;
        let Ok(name) = std::env::var("HARDPOINT_PATH") else { return Ok(analysis) };
        Ok(match Execution::named(&name) {
            Some(execution) => analysis.executed(execution),
            None => {
                self.remark("HARDPOINT_PATH must be `scalar`, `tape` or `code`: it is ignored");
                analysis
            }
        })
    }

    /// Analysis whose runs end at their next output time once the user asks to stop.
    pub fn until_interrupted<'m>(&self, analysis: Analysis<'m>) -> Analysis<'m> {
        analysis.ended_by(Arc::clone(&self.interrupted))
    }

    /// Reports why the mechanism cannot be driven.
    pub fn cannot_be_driven(&self, file: &ModelFile, fault: &TopologyError) -> Outcome {
        self.fail(file, &[diagnose::topology_fault(file, fault)]);
        Outcome::CannotBeDriven
    }

    /// True if the result is one JSON document.
    pub fn is_json(&self) -> bool {
        matches!(self.audience, Audience::Program | Audience::Agent(_))
    }

    /// Solves motion and sensitivities with progress, for a motion that is studied as a whole ([`Session::fits`]).
    pub fn solve(&self, analysis: &Analysis<'_>) -> Solution {
        let mut meter = self.meter("solving", "steps");
        analysis.solve(Run::new().progress(|progress| {
            meter.show(progress.done, progress.total);
            self.go_on()
        }))
    }

    /// Solves a motion of any length, with or without sensitivities: `each` receives it window by window, and may stop
    /// it.
    ///
    /// # Errors
    /// Fails before solving if a single window is too large.
    pub fn solve_in_windows(
        &self,
        analysis: &Analysis<'_>,
        sensitivities: bool,
        mut each: impl FnMut(&Solution) -> bool,
    ) -> Result<Course, Outcome> {
        let model = analysis.model();
        let takes = Footprint::of(model, sensitivities).of_window(WINDOW_BYTES);
        if takes > MOST_BYTES {
            let (bodies, variables) = (model.bodies.len() - 1, model.variables.len());
            let message = format!(
                "one window of output times of {bodies} bodies by {variables} variables needs {} of memory",
                bytes(takes as u64)
            );
            let note = format!("the limit is {}; nothing was solved", bytes(MOST_BYTES as u64));
            self.refuse(
                "HP0603",
                &message,
                None,
                &note,
                "leave out variables, or use `run --no-sensitivities`",
            );
            return Err(Outcome::Misunderstood);
        }
        let mut meter = self.meter("solving", "steps");
        let mut gathering = Gathering::new(model);
        let goes_on = Cell::new(true);
        let run = Run::new().progress(|progress| {
            meter.show(progress.done, progress.total);
            if goes_on.get() { self.go_on() } else { ControlFlow::Break(()) }
        });
        let run = if sensitivities { run } else { run.without_sensitivities() };
        // Minima of clearances are located after the last output time.
        let analysis = self.until_interrupted(analysis.clone());
        let whole = analysis.solve_in_windows(run, WINDOW_BYTES, |first, window| {
            gathering.add(first, window);
            goes_on.set(each(window) && goes_on.get());
        });
        Ok(gathering.end(&whole))
    }

    /// Leaves out output times of a motion that is too long to be studied as a whole, and reports it.
    pub fn fits(&self, file: &mut ModelFile) {
        let most = usize::max(STUDY_BYTES / Footprint::of(&file.model, true).bytes().max(1), 2);
        let steps = file.model.times.len();
        if steps > most {
            let every = steps.div_ceil(most);
            let last = file.model.times[steps - 1];
            let mut times: Vec<f64> = file.model.times.iter().copied().step_by(every).collect();
            if times.last() != Some(&last) {
                times.push(last);
            }
            let left = times.len();
            self.remark(&format!(
                "{steps} output times do not fit into memory: every {every}th is used, {left} in all"
            ));
            file.model.times = times;
        }
    }

    /// Condition for the end of an interrupted run: true until shortly after the user requested a stop.
    pub fn for_a_moment(&self) -> impl FnMut() -> bool {
        const MOMENT: Duration = Duration::from_millis(300);
        let mut asked = None;
        move || !self.interrupted() || asked.get_or_insert_with(Instant::now).elapsed() < MOMENT
    }

    /// Condition for loops of the core: continue until the user requests a stop.
    pub fn go_on(&self) -> ControlFlow<()> {
        if self.interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Shows diagnostics of the model file as text; as JSON they are part of the result.
    pub fn tell(&self, file: &ModelFile, diagnostics: &[Diagnostic]) {
        if self.is_for_reading() {
            let color = text::stderr_in_color();
            let case = self.under_way().clone();
            for d in diagnostics {
                let mut d = d.clone();
                if let Some(case) = &case {
                    d.message = format!("case `{case}`: {}", d.message);
                }
                text::complain(&format!("{}\n\n", file.render(&d, color)));
            }
        }
    }

    /// Reports why there is no result.
    pub fn fail(&self, file: &ModelFile, diagnostics: &[Diagnostic]) {
        match &self.audience {
            Audience::Program => self.print_error(diagnostics),
            Audience::Terminal => self.tell(file, diagnostics),
            Audience::Page(listener) | Audience::Agent(listener) => {
                let text: Vec<String> = diagnostics.iter().map(|d| file.render(d, false)).collect();
                listener.refused(json!(diagnostics), &text.join("\n\n"));
            }
        }
    }

    /// Reports an invalid command line for this model.
    pub fn misunderstood(&self, why: &str) -> Outcome {
        self.refuse("HP0602", why, None, "nothing was solved", "see `hardpoint help`");
        Outcome::Misunderstood
    }

    /// Returns an error, which is reported, if the model does not have a measure that a request names.
    pub fn check_measures<'n>(
        &self,
        file: &ModelFile,
        names: impl IntoIterator<Item = &'n String>,
    ) -> Result<(), Outcome> {
        let outputs = hardpoint::measure::outputs(&file.model);
        for name in names {
            named("measure", name, outputs.iter().map(|o| o.name.as_str()))
                .map_err(|e| self.refused(file, &e))?;
        }
        Ok(())
    }

    /// Reports an invalid request of a study.
    pub fn refused(&self, file: &ModelFile, error: &RequestError) -> Outcome {
        let message = format!("`{}`: {}", file.file_name(), error.message);
        self.refuse("HP0602", &message, None, "nothing was solved", &error.help);
        Outcome::Misunderstood
    }

    /// Reports that a map over drivers has no proved error.
    pub fn not_mapped(&self, file: &ModelFile, why: &str, help: &str) {
        self.refuse("HP0606", &format!("`{}`: {why}", file.file_name()), None, "nothing was written", help);
    }

    /// Reports a failure of the server.
    pub fn not_served(&self, what: &str, why: &str, help: &str) -> Outcome {
        self.refuse("HP0604", what, None, why, help);
        Outcome::Misunderstood
    }

    /// Reports that a new model cannot be created.
    pub fn not_begun(&self, what: &str, why: &str, help: &str) -> Outcome {
        self.refuse("HP0605", what, None, why, help);
        Outcome::Misunderstood
    }

    /// Prints a note before the work, unless stdout is a JSON document.
    pub fn remark(&self, what: &str) {
        if self.is_for_reading() {
            text::complain(&format!("note: {what}\n\n"));
        }
    }

    /// Reports that the user interrupted a run while it wrote.
    pub fn ended_while_writing(&self, folder: &Path) {
        let note = format!("nothing in `{}` has changed", folder.display());
        self.refuse("HP0405", "interrupted while the results were written", None, &note, "run it again");
    }

    /// Reports that a result could not be written.
    pub fn not_written(&self, failure: &WriteError) -> Outcome {
        let message = format!("`{}` cannot be written", failure.path.display());
        let help = "select a writable folder with `-o`";
        self.refuse("HP0601", &message, Some(&failure.path), &failure.error.to_string(), help);
        Outcome::NotWritten
    }

    /// Reports a failure to write to stdout, if any; it replaces the outcome of the command.
    pub fn not_printed(outcome: Outcome) -> Outcome {
        match text::failed() {
            None => outcome,
            Some(error) => {
                let help = "write to a disk with free space, or use `-o`";
                let message = "the result could not be written to stdout";
                text::complain(&text::error("HP0601", message, &error.to_string(), help));
                Outcome::NotWritten
            }
        }
    }

    /// Reports an error that is not in the model file.
    fn refuse(&self, code: &str, message: &str, file: Option<&Path>, note: &str, help: &str) {
        let diagnostics = || {
            json!([{
                "severity": "error", "code": code, "message": message, "file": file,
                "line": null, "column": null, "length": null, "element": null, "label": null, "notes": [note], "help": help,
            }])
        };
        let text = || text::error(code, message, note, help);
        match &self.audience {
            Audience::Program => {
                self.print_json(
                    &json!({ "generator": GENERATOR, "status": "error", "diagnostics": diagnostics() }),
                );
            }
            Audience::Terminal => text::complain(&text()),
            Audience::Page(listener) | Audience::Agent(listener) => {
                listener.refused(diagnostics(), &anstream::adapter::strip_str(&text()).to_string());
            }
        }
    }

    /// Outcome of a command. With `--json` a document is also printed if the command was interrupted before it had a
    /// result.
    pub fn end(&self, found: Result<Outcome, Outcome>) -> Outcome {
        let outcome = found.unwrap_or_else(|outcome| outcome);
        if outcome == Outcome::Interrupted && self.is_json() && !self.has_printed.load(Ordering::SeqCst) {
            self.print_json(&document_of("interrupted", &[]));
        }
        outcome
    }

    /// Prints a JSON document.
    pub fn print_json(&self, document: &impl serde::Serialize) {
        self.has_printed.store(true, Ordering::SeqCst);
        if let Some(cases) = self.documents().as_mut() {
            cases.push(serde_json::to_value(document).expect("results are plain data"));
            return;
        }
        if let Audience::Agent(listener) = &self.audience {
            listener.document(serde_json::to_value(document).expect("results are plain data"));
            return;
        }
        text::print(&json_text(document));
    }

    fn print_error(&self, diagnostics: &[Diagnostic]) {
        self.print_json(&document_of("error", diagnostics));
    }
}

/// Text of a model file for the folder of `to`.
fn text_for(file: &ModelFile, text: &str, to: &Path) -> Result<String, Diagnostics> {
    let folder = |path: &Path| path.parent().map(Path::to_owned).unwrap_or_default();
    let from = folder(Path::new(file.file_name()));
    file.spares_its_files(&from, to)?;
    file.text_for(text, Some(&from), &folder(to))
}

/// JSON document of a command without a result.
fn document_of(status: &str, diagnostics: &[Diagnostic]) -> serde_json::Value {
    json!({ "generator": GENERATOR, "status": status, "diagnostics": diagnostics })
}

/// Formats a JSON document for printing and writing.
pub fn json_text(document: &impl serde::Serialize) -> String {
    let mut text = serde_json::to_string_pretty(document).expect("results are plain data");
    text.push('\n');
    text
}
