//! Common parts of the commands: reading the model, solving with progress and interruption, reporting errors as text or
//! JSON.

use std::cell::Cell;
use std::io::Write;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use hardpoint::model::{CaseId, VariableId};
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
use crate::folder::{self, Folder, WriteError};
use crate::meter::{Listener, Meter};
use crate::outcome::Outcome;
use crate::text;

/// Receiver of a session's reports.
enum Audience {
    /// Somebody who reads.
    Terminal,
    /// A program, which gets one JSON document.
    Program,
    /// A page.
    Page(Arc<dyn Listener>),
}

/// A command under way.
pub struct Session {
    audience: Audience,
    started: Instant,
    interrupted: Arc<AtomicBool>,
    patient: Arc<AtomicBool>,
    /// The documents of the cases that were done, while there are several.
    cases: Mutex<Option<Vec<serde_json::Value>>>,
    /// The one that is being done.
    case: Mutex<Option<String>>,
}

/// Results of that many bytes are held at once while a motion is solved: little enough to be written in no time.
const WINDOW_BYTES: usize = 4 << 20;
/// A window holds one output time per lane at least; where that takes more than this, the work is not begun.
const MOST_BYTES: usize = 512 << 20;
/// Motions that are studied as a whole may take that many bytes; longer ones are looked at every that many output
/// times.
const STUDY_BYTES: usize = 96 << 20;

impl Session {
    /// Begins; from now on Ctrl-C asks to stop, and another Ctrl-C later ends the program at once.
    pub fn begin(json: bool) -> Self {
        // Shells and job runners may send the same signal to a process and to its group.
        const SAME_REQUEST: Duration = Duration::from_millis(500);
        /// Whoever looks at the request does so within this time.
        const PATIENCE: Duration = Duration::from_millis(700);
        let interrupted = Arc::new(AtomicBool::new(false));
        let patient = Arc::new(AtomicBool::new(false));
        let (flag, waits) = (Arc::clone(&interrupted), Arc::clone(&patient));
        let mut first = None;
        // Without a handler Ctrl-C just ends the program, which is no reason not to run.
        let _ = ctrlc::set_handler(move || {
            flag.store(true, Ordering::SeqCst);
            let again = first.get_or_insert_with(Instant::now).elapsed() > SAME_REQUEST;
            if !again && !waits.load(Ordering::SeqCst) {
                std::thread::sleep(PATIENCE);
            }
            if again || !waits.load(Ordering::SeqCst) {
                folder::abandon();
                if json {
                    text::print(&json_text(&error_document(&[])));
                }
                std::process::exit(Outcome::Interrupted as i32);
            }
        });
        let audience = if json { Audience::Program } else { Audience::Terminal };
        Self::of(audience, interrupted, patient)
    }

    /// Session for a page, which may end it by this flag.
    pub fn for_page(listener: Arc<dyn Listener>, interrupted: Arc<AtomicBool>) -> Self {
        Self::of(Audience::Page(listener), interrupted, Arc::new(AtomicBool::new(true)))
    }

    fn of(audience: Audience, interrupted: Arc<AtomicBool>, patient: Arc<AtomicBool>) -> Self {
        Self {
            audience,
            started: Instant::now(),
            interrupted,
            patient,
            cases: Mutex::new(None),
            case: Mutex::new(None),
        }
    }

    fn listener(&self) -> Option<&Arc<dyn Listener>> {
        match &self.audience {
            Audience::Page(listener) => Some(listener),
            Audience::Terminal | Audience::Program => None,
        }
    }

    fn is_for_reading(&self) -> bool {
        matches!(self.audience, Audience::Terminal)
    }

    /// A meter of this work.
    pub fn meter(&self, what: &'static str, unit: &'static str) -> Meter {
        Meter::new(what, unit, self.listener().cloned())
    }

    /// A sign that work of unknown length goes on.
    pub fn working(&self, what: &'static str) -> Meter {
        Meter::working(what, self.listener().cloned())
    }

    /// A line on what the work came to on its way.
    pub fn line(&self, line: &str) {
        match &self.audience {
            Audience::Terminal => text::print(&format!("{line}\n")),
            Audience::Page(listener) => listener.line(line),
            Audience::Program => {}
        }
    }

    /// True if what is done now ends by itself soon after a request to stop, and has something to save. What is not
    /// patient is ended where it is.
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

    /// Reads the model, or reports what is wrong with it.
    pub fn read(&self, path: &Path) -> Result<ModelFile, Outcome> {
        hardpoint_file::read(path).map_err(|error: ReadError| {
            self.not_read(error.diagnostics());
            Outcome::BadModel
        })
    }

    /// The bytes of a file of another program.
    pub fn bytes_of(&self, path: &Path) -> Result<Vec<u8>, Outcome> {
        std::fs::read(path).map_err(|error| {
            let message = format!("`{}` cannot be read", path.display());
            self.refuse(
                "HP0809",
                &message,
                Some(path),
                &error.to_string(),
                "check the path, and that you may read it",
            );
            Outcome::BadModel
        })
    }

    /// Indicates what is wrong with a file that was read.
    pub fn not_read(&self, diagnostics: &Diagnostics) {
        match &self.audience {
            Audience::Program => self.print_error(diagnostics.list()),
            Audience::Terminal => {
                text::complain(&format!("{}\n", diagnostics.render(text::stderr_in_color())));
            }
            Audience::Page(listener) => listener.refused(json!(diagnostics), &diagnostics.render(false)),
        }
    }

    /// Reads the model and does a command for its motion; of a model with cases, for one case or for each of them, one
    /// after the other. `each` is reported the case where there are several.
    ///
    /// # Errors
    /// Error if nothing could be started. The outcome of one case does not prevent the others.
    pub fn for_motions(
        &self,
        path: &Path,
        motions: &Motions,
        each: impl FnMut(ModelFile, Option<&str>) -> Result<Outcome, Outcome>,
    ) -> Result<Outcome, Outcome> {
        self.for_motions_of(self.read(path)?, motions, each)
    }

    /// The same for a model that was read.
    ///
    /// # Errors
    /// As there.
    pub fn for_motions_of(
        &self,
        file: ModelFile,
        motions: &Motions,
        mut each: impl FnMut(ModelFile, Option<&str>) -> Result<Outcome, Outcome>,
    ) -> Result<Outcome, Outcome> {
        let cases: Vec<&str> = file.model.cases.iter().map(|c| c.name.as_str()).collect();
        if let Some(name) = &motions.case {
            let id = self.case(&file, name)?;
            return each(file.in_case(id), None);
        }
        if cases.is_empty() {
            return each(file, None);
        }
        *self.documents() = Some(Vec::new());
        let mut outcome = Outcome::Done;
        for (k, case) in cases.iter().enumerate() {
            let before = self.documents().as_ref().map_or(0, Vec::len);
            *self.under_way() = Some((*case).into());
            outcome =
                outcome.and(each(file.in_case(CaseId(k)), Some(case)).unwrap_or_else(|outcome| outcome));
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

    /// The case of a file that the command line names.
    ///
    /// # Errors
    /// Where it has none of that name, or where that is no motion.
    pub fn case(&self, file: &ModelFile, name: &str) -> Result<CaseId, Outcome> {
        let model = &file.model;
        let found = named("case", name, model.cases.iter().map(|c| c.name.as_str())).map(CaseId);
        found.map_err(|error| match model.grids.iter().any(|grid| grid.name == name) {
            true => self.misunderstood(&format!(
                "`--case {name}`: it is a grid of positions and no motion, which `hardpoint run` solves"
            )),
            false => self.refused(file, &error),
        })
    }

    /// The motions of a model that a command is done for, by their numbers.
    ///
    /// # Errors
    /// Error for a case that does not exist.
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
    /// Where the text does not support the changed design, or the file cannot be written.
    pub fn save(&self, file: &ModelFile, design: &[f64], to: &Path) -> Result<(), Outcome> {
        let text = self.edited(file, design)?;
        write_text(to, &text).map_err(|e| self.not_written(&e))
    }

    /// Checks before the work that changes of some variables can be saved in the model's text.
    ///
    /// # Errors
    /// Fails where the text has no number for one of them.
    pub fn can_save(
        &self,
        file: &ModelFile,
        variables: &[VariableId],
        to: Option<&Path>,
    ) -> Result<(), Outcome> {
        let checked = if to.is_some() { file.check_savable(variables) } else { Ok(()) };
        checked.map_err(|diagnostics| {
            self.fail(file, diagnostics.list());
            Outcome::Misunderstood
        })
    }

    /// Writes the model file with a changed design after a search: a failure is returned, so that the result can still
    /// be shown.
    ///
    /// # Errors
    /// The diagnostics, the cause in one line, and how the command ends.
    pub fn save_result(
        &self,
        file: &ModelFile,
        design: &[f64],
        to: &Path,
    ) -> Result<(), (Vec<Diagnostic>, String, Outcome)> {
        let text = file.edit(design).map_err(|found| {
            let why = found.list().first().map_or(String::new(), |d| d.message.clone());
            (found.list().to_vec(), why, Outcome::Misunderstood)
        })?;
        write_text(to, &text).map_err(|failure| {
            let why = format!("`{}` cannot be written: {}", failure.path.display(), failure.error);
            (Vec::new(), why, Outcome::NotWritten)
        })
    }

    /// The model's text with a changed design.
    ///
    /// # Errors
    /// Where the text does not support it.
    pub fn edited(&self, file: &ModelFile, design: &[f64]) -> Result<String, Outcome> {
        file.edit(design).map_err(|diagnostics| {
            self.fail(file, diagnostics.list());
            Outcome::Misunderstood
        })
    }

    /// The folder for results, where one is requested.
    ///
    /// # Errors
    /// Where nothing can be written there.
    pub fn folder(&self, path: Option<&Path>) -> Result<Option<Folder>, Outcome> {
        path.map(Folder::open).transpose().map_err(|e| self.not_written(&e))
    }

    /// Checks that a file to save to is not the model itself.
    ///
    /// # Errors
    /// Where it is.
    pub fn may_save(&self, model: &Path, to: Option<&Path>) -> Result<(), Outcome> {
        let same = |a: &Path, b: &Path| {
            a.canonicalize().ok().is_some_and(|a| b.canonicalize().is_ok_and(|b| a == b))
        };
        match to {
            Some(to) if same(model, to) => {
                let why = format!(
                    "`{}` would overwrite what is read: the model file itself, or its source; write under another name",
                    to.display()
                );
                Err(self.misunderstood(&why))
            }
            Some(to) if to.file_name().is_none() => {
                Err(self.misunderstood(&format!("`{}` names no file", to.display())))
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
                self.remark("HARDPOINT_PATH is none of `scalar`, `tape` and `code`: it is not heeded");
                analysis
            }
        })
    }

    /// Indicates why the mechanism cannot be driven.
    pub fn cannot_be_driven(&self, file: &ModelFile, fault: &TopologyError) -> Outcome {
        self.fail(file, &[diagnose::topology_fault(file, fault)]);
        Outcome::CannotBeDriven
    }

    /// True if the result is one JSON document.
    pub fn is_json(&self) -> bool {
        matches!(self.audience, Audience::Program)
    }

    /// Solves motion and sensitivities, showing progress; a motion that is studied as a whole ([`Session::fits`]).
    pub fn solve(&self, analysis: &Analysis<'_>) -> Solution {
        let mut meter = self.meter("solving", "steps");
        analysis.solve(Run::new().progress(|progress| {
            meter.show(progress.done, progress.total);
            self.go_on()
        }))
    }

    /// Solves the motion, with sensitivities or without, however long it is: `each` sees it window by window, and may
    /// end it.
    ///
    /// # Errors
    /// Where a single window is too large, before anything is solved.
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
                "a few output times of {bodies} bodies by {variables} variables take {} of memory",
                bytes(takes as u64)
            );
            let note = format!("at most {} are used for that; nothing was solved", bytes(MOST_BYTES as u64));
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
        let whole = analysis.solve_in_windows(run, WINDOW_BYTES, |first, window| {
            gathering.add(first, window);
            goes_on.set(each(window) && goes_on.get());
        });
        Ok(gathering.end(&whole))
    }

    /// Makes the motion of a model short enough to be studied as a whole, by leaving out output times, and reports
    /// that.
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

    /// For what ends a run that was interrupted: go on unless the user asked to stop, and then for a moment still.
    pub fn for_a_moment(&self) -> impl FnMut() -> bool {
        const MOMENT: Duration = Duration::from_millis(300);
        let mut asked = None;
        move || !self.interrupted() || asked.get_or_insert_with(Instant::now).elapsed() < MOMENT
    }

    /// For the core's loops: go on unless the user asked to stop.
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

    /// Indicates why there is no result.
    pub fn fail(&self, file: &ModelFile, diagnostics: &[Diagnostic]) {
        match &self.audience {
            Audience::Program => self.print_error(diagnostics),
            Audience::Terminal => self.tell(file, diagnostics),
            Audience::Page(listener) => {
                let text: Vec<String> = diagnostics.iter().map(|d| file.render(d, false)).collect();
                listener.refused(json!(diagnostics), &text.join("\n\n"));
            }
        }
    }

    /// Indicates that the command line asks for something that the model does not have.
    pub fn misunderstood(&self, why: &str) -> Outcome {
        self.refuse("HP0602", why, None, "nothing was solved", "see `hardpoint help`");
        Outcome::Misunderstood
    }

    /// Indicates that a study cannot be requested.
    pub fn refused(&self, file: &ModelFile, error: &RequestError) -> Outcome {
        let message = format!("`{}`: {}", file.file_name(), error.message);
        self.refuse("HP0602", &message, None, "nothing was solved", &error.help);
        Outcome::Misunderstood
    }

    /// Indicates that a server cannot do its work.
    pub fn not_served(&self, what: &str, why: &str, help: &str) -> Outcome {
        self.refuse("HP0604", what, None, why, help);
        Outcome::Misunderstood
    }

    /// Indicates that a model cannot be begun.
    pub fn not_begun(&self, what: &str, why: &str, help: &str) -> Outcome {
        self.refuse("HP0605", what, None, why, help);
        Outcome::Misunderstood
    }

    /// Says what is worth knowing before the work; not where stdout is a document for machines.
    pub fn remark(&self, what: &str) {
        if self.is_for_reading() {
            text::complain(&format!("note: {what}\n\n"));
        }
    }

    /// Indicates that the user ended a run while it wrote.
    pub fn ended_while_writing(&self, folder: &Path) {
        let note = format!("nothing in `{}` has changed", folder.display());
        self.refuse("HP0405", "interrupted while the results were written", None, &note, "run it again");
    }

    /// Indicates that a result could not be written.
    pub fn not_written(&self, failure: &WriteError) -> Outcome {
        let message = format!("`{}` cannot be written", failure.path.display());
        let help = "name a folder that you may write to with `-o`";
        self.refuse("HP0601", &message, Some(&failure.path), &failure.error.to_string(), help);
        Outcome::NotWritten
    }

    /// Indicates that stdout could not be written, if it could not; then that is how the command ends.
    pub fn not_printed(outcome: Outcome) -> Outcome {
        match text::failed() {
            None => outcome,
            Some(error) => {
                let help = "write somewhere with room, or use `-o`";
                let message = "the result could not be written to stdout";
                text::complain(&text::error("HP0601", message, &error.to_string(), help));
                Outcome::NotWritten
            }
        }
    }

    /// Indicates what is wrong but not in the model's file.
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
            Audience::Page(listener) => {
                listener.refused(diagnostics(), &anstream::adapter::strip_str(&text()).to_string());
            }
        }
    }

    /// Prints a JSON document.
    pub fn print_json(&self, document: &impl serde::Serialize) {
        if let Some(cases) = self.documents().as_mut() {
            cases.push(serde_json::to_value(document).expect("results are plain data"));
            return;
        }
        text::print(&json_text(document));
    }

    fn print_error(&self, diagnostics: &[Diagnostic]) {
        self.print_json(&error_document(diagnostics));
    }
}

/// The document where there is no result.
fn error_document(diagnostics: &[Diagnostic]) -> serde_json::Value {
    json!({ "generator": GENERATOR, "status": "error", "diagnostics": diagnostics })
}

/// A JSON document as it is printed and written.
pub fn json_text(document: &impl serde::Serialize) -> String {
    let mut text = serde_json::to_string_pretty(document).expect("results are plain data");
    text.push('\n');
    text
}

/// Writes a text, whole or not at all.
fn write_text(to: &Path, text: &str) -> Result<(), WriteError> {
    let parent = to.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let name = to.file_name().map(|n| n.to_string_lossy().into_owned());
    let mut folder = Folder::open(parent)?;
    folder.write(&name.unwrap_or_default(), |out| out.write_all(text.as_bytes()))?;
    folder.commit(&[])
}
