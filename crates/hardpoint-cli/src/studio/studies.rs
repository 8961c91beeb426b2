//! Long studies, each in a thread of its own: started, watched, cancelled; the results are stored until newer studies
//! replace them.

use std::collections::VecDeque;
use std::num::NonZero;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use hardpoint::model::Model;
use hardpoint::topology::Formulation;
use hardpoint_file::{ModelFile, TaskFile};
use hardpoint_report::page::Table;
use hardpoint_report::tolerance::ToleranceInputs;
use hardpoint_study::Motions;
use hardpoint_study::optimize::{Overrides, Request};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use tokio::sync::broadcast;

use crate::args::Allocate;
use crate::meter::Listener;
use crate::outcome::Outcome;
use crate::pages::{Page, Study as _};
use crate::session::Session;
use crate::{args, optimize, sweep, synthesize, tolerance};

/// Maximum number of running studies. Each uses all cores; further requests are rejected, not queued.
const AT_ONCE: usize = 2;
/// Number of finished studies that are stored with their pages.
const KEPT: usize = 8;
/// Minimum interval between two progress events.
const PACE: Duration = Duration::from_millis(100);
/// Maximum number of pending events; a page that is further behind loses some and requests the state.
const EVENTS: usize = 256;

/// Request of a page for a study.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudyRequest {
    /// The kind of study.
    pub what: StudyKind,
    /// Name of the model file, to resolve relative file names.
    pub file: String,
    /// The model as the page has it.
    pub text: String,
    /// Single case to study.
    #[serde(default)]
    pub case: Option<String>,
    /// Options that override the text.
    #[serde(default)]
    pub options: Options,
}

/// The kinds of studies.
#[derive(Clone, Copy, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum StudyKind {
    /// `hardpoint optimize`.
    Optimize,
    /// `hardpoint tolerance`.
    Tolerance,
    /// `hardpoint sweep`.
    Sweep,
    /// `hardpoint synthesize`, of the task of the options.
    Synthesize,
}

/// Options, as those of the command line with the same names.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Options {
    starts: Option<NonZero<u16>>,
    iterations: Option<NonZero<u16>>,
    samples: Option<u32>,
    seed: Option<u32>,
    allocate: Option<Allocate>,
    /// Text of a task file.
    task: Option<String>,
}

/// A running or finished study.
pub struct Study {
    id: u64,
    what: StudyKind,
    cancelled: Arc<AtomicBool>,
    state: Mutex<State>,
    events: broadcast::Sender<Arc<str>>,
}

#[derive(Default)]
struct State {
    progress: Value,
    last_report: Option<Instant>,
    lines: Vec<String>,
    end: Option<End>,
}

/// Result of a study.
struct End {
    /// `done`, `cancelled` or `failed`.
    state: &'static str,
    message: String,
    diagnostics: Value,
    /// Model text with the optimised design.
    text: Option<String>,
    tables: Vec<Table>,
    pages: Vec<Page>,
}

impl End {
    fn failed(message: impl Into<String>) -> Self {
        let nothing = (None, Vec::new(), Vec::new());
        Self {
            state: "failed",
            message: message.into(),
            diagnostics: json!([]),
            text: nothing.0,
            tables: nothing.1,
            pages: nothing.2,
        }
    }
}

/// All studies of a server.
pub struct Studies {
    last: AtomicU64,
    list: Mutex<VecDeque<Arc<Study>>>,
    events: broadcast::Sender<Arc<str>>,
}

impl Default for Studies {
    fn default() -> Self {
        Self { last: AtomicU64::new(0), list: Mutex::default(), events: broadcast::channel(EVENTS).0 }
    }
}

impl Studies {
    /// Receiver of all further events.
    pub fn events(&self) -> broadcast::Receiver<Arc<str>> {
        self.events.subscribe()
    }

    /// Study with this number.
    pub fn get(&self, id: &str) -> Option<Arc<Study>> {
        let id: u64 = id.parse().ok()?;
        self.list().iter().find(|s| s.id == id).cloned()
    }

    /// Starts a study; `None` if too many are running.
    pub fn begin(&self, file: ModelFile, asked: StudyRequest) -> Option<Arc<Study>> {
        let study = {
            let mut list = self.list();
            if list.iter().filter(|s| !s.has_ended()).count() >= AT_ONCE {
                return None;
            }
            while list.len() >= KEPT {
                let oldest = list.iter().position(|s| s.has_ended())?;
                list.remove(oldest);
            }
            let study = Arc::new(Study {
                id: 1 + self.last.fetch_add(1, Ordering::SeqCst),
                what: asked.what,
                cancelled: Arc::default(),
                state: Mutex::default(),
                events: self.events.clone(),
            });
            list.push_back(Arc::clone(&study));
            study
        };
        let working = Arc::clone(&study);
        let begun = std::thread::Builder::new()
            .name(format!("study {}", study.id))
            .spawn(move || working.work(&file, &asked));
        if let Err(error) = begun {
            study.end(End::failed(format!("the study could not be started: {error}")));
        }
        Some(study)
    }

    /// Cancels all studies.
    pub fn cancel_all(&self) {
        self.list().iter().for_each(|s| s.cancel());
    }

    fn list(&self) -> MutexGuard<'_, VecDeque<Arc<Study>>> {
        self.list.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Study {
    /// Cancels the study: it ends soon, with the results so far.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::SeqCst);
    }

    fn has_ended(&self) -> bool {
        self.state().end.is_some()
    }

    /// State of the study as JSON, with the names of its pages but not their contents.
    pub fn document(&self) -> Value {
        let state = self.state();
        let Some(end) = &state.end else {
            return json!({ "id": self.id, "what": self.what, "state": "running", "progress": state.progress, "lines": state.lines });
        };
        let page = |case: &Option<String>| {
            let query = form_urlencoded::Serializer::new(String::new())
                .extend_pairs(case.iter().map(|c| ("case", c)))
                .finish();
            json!({ "case": case, "link": format!("/api/study/{}/report.html?{query}", self.id).trim_end_matches('?') })
        };
        json!({
            "id": self.id,
            "what": self.what,
            "state": end.state,
            "message": end.message,
            "diagnostics": end.diagnostics,
            "lines": state.lines,
            "text": end.text,
            "tables": end.tables,
            "reports": end.pages.iter().map(|(case, _)| page(case)).collect::<Vec<_>>(),
        })
    }

    /// Page of a case, or the first page.
    pub fn report(&self, case: Option<&str>) -> Option<String> {
        let state = self.state();
        let pages = &state.end.as_ref()?.pages;
        let page = match case {
            None => pages.first(),
            Some(case) => pages.iter().find(|(of, _)| of.as_deref() == Some(case)),
        };
        page.map(|(_, html)| html.clone())
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn tell(&self, mut event: Value) {
        event["id"] = self.id.into();
        // There may be no receiver.
        let _ = self.events.send(event.to_string().into());
    }

    fn end(&self, end: End) {
        self.state().end.get_or_insert(end);
        let mut document = self.document();
        // Pages fetch the complete state themselves.
        for heavy in ["text", "tables", "lines"] {
            document.as_object_mut().map(|d| d.remove(heavy));
        }
        self.tell(document);
    }

    fn work(self: &Arc<Self>, file: &ModelFile, asked: &StudyRequest) {
        let heard = Arc::new(Heard { study: Arc::clone(self), refusal: Mutex::default() });
        let session = Session::for_page(Arc::clone(&heard) as Arc<dyn Listener>, Arc::clone(&self.cancelled));
        let done = catch_unwind(AssertUnwindSafe(|| match asked.what {
            StudyKind::Optimize => optimized(&session, file, asked),
            StudyKind::Tolerance => examined(&session, file, asked),
            StudyKind::Sweep => swept(&session, file, asked),
            StudyKind::Synthesize => synthesized(&session, asked),
        }));
        self.end(match done {
            Ok(Ok(end)) => end,
            Ok(Err(outcome)) => {
                let (diagnostics, message) =
                    heard.refusal.lock().unwrap_or_else(PoisonError::into_inner).take().unwrap_or_default();
                let state = if outcome == Outcome::Interrupted { "cancelled" } else { "failed" };
                End { state, diagnostics, ..End::failed(message) }
            }
            Err(_) => End::failed("the study ended with an internal error; the terminal shows the details"),
        });
    }
}

/// Progress reports of a running study.
struct Heard {
    study: Arc<Study>,
    refusal: Mutex<Option<(Value, String)>>,
}

impl Listener for Heard {
    fn progress(&self, what: &'static str, unit: &'static str, done: usize, of: usize) {
        let progress = json!({ "what": what, "unit": unit, "done": done, "of": of });
        let mut state = self.study.state();
        state.progress = progress.clone();
        if state.last_report.is_some_and(|at| at.elapsed() < PACE) && done < of {
            return;
        }
        state.last_report = Some(Instant::now());
        drop(state);
        self.study.tell(json!({ "state": "running", "progress": progress }));
    }

    fn line(&self, line: &str) {
        let line = anstream::adapter::strip_str(line).to_string();
        self.study.state().lines.push(line.clone());
        self.study.tell(json!({ "state": "running", "line": line }));
    }

    fn refused(&self, diagnostics: Value, text: &str) {
        *self.refusal.lock().unwrap_or_else(PoisonError::into_inner) = Some((diagnostics, text.into()));
    }
}

fn optimized(session: &Session, file: &ModelFile, asked: &StudyRequest) -> Result<End, Outcome> {
    let mut file = file.clone();
    session.keep_case(&mut file, asked.case.as_deref())?;
    let [starts, iterations] =
        [asked.options.starts, asked.options.iterations].map(|n| n.map(|n| usize::from(n.get())));
    let overrides = Overrides { starts, iterations, ..Overrides::default() };
    let request = Request::of(&file.model, overrides).map_err(|e| session.refused(&file, &e))?;
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative);
    let motions = motions.map_err(|(_, fault)| session.cannot_be_driven(&file, &fault))?;
    let mut search = optimize::Search::run(session, &file, &motions, &request, None);
    let edited = search.to_save().map(|design| {
        let file = search.file_to_save(&design).map_err(|(found, ..)| found)?;
        file.edit(&design).map_err(|found| found.list().to_vec())
    });
    let mut diagnostics = Vec::new();
    // A result that cannot be written into the text is still shown.
    let text = edited.transpose().unwrap_or_else(|found| {
        diagnostics = found;
        search.facts.not_saved(diagnostics.first().map_or("", |d| d.message.as_str()));
        None
    });
    Ok(End {
        state: if search.facts.status == "interrupted" { "cancelled" } else { "done" },
        message: search.facts.message.clone(),
        diagnostics: json!(diagnostics),
        text,
        tables: search.facts.tables(),
        pages: search.pages().collect(),
    })
}

fn examined(session: &Session, file: &ModelFile, asked: &StudyRequest) -> Result<End, Outcome> {
    let numbers = session.numbers_of(file, &args::Motions { case: asked.case.clone() })?;
    let Options { samples, seed, allocate, .. } = asked.options;
    let overrides = tolerance::overrides(samples, seed, allocate);
    let request = hardpoint_study::tolerance::Request::of(&file.model, &overrides)
        .map_err(|error| session.refused(file, &error))?;
    let models = file.model.motions();
    let models: Vec<Model> = numbers.iter().map(|k| models[*k].clone()).collect();
    let motions = Motions::of(&models, Formulation::Relative);
    let motions = motions.map_err(|(_, fault)| session.cannot_be_driven(file, &fault))?;
    let found = tolerance::examine(session, file, &motions, &numbers, &request, None)?;
    let studied = ToleranceInputs { file, numbers: &numbers, asked: &request.settings, found: &found };
    let results = tolerance::Results::of(session, studied, &motions);
    Ok(End {
        state: if found.interrupted { "cancelled" } else { "done" },
        message: results.facts.message.clone(),
        diagnostics: json!([]),
        text: None,
        tables: results.facts.tables(),
        pages: results.pages().collect(),
    })
}

fn swept(session: &Session, file: &ModelFile, asked: &StudyRequest) -> Result<End, Outcome> {
    let Options { samples, seed, .. } = asked.options;
    let motions = args::Motions { case: asked.case.clone() };
    let (facts, pages) =
        sweep::for_page(session, file, &args::Sweep { motions, samples, seed, ..args::Sweep::default() })?;
    Ok(End {
        state: if facts.status == "interrupted" { "cancelled" } else { "done" },
        message: facts.message.clone(),
        diagnostics: json!([]),
        text: None,
        tables: facts.tables(),
        pages,
    })
}

fn synthesized(session: &Session, asked: &StudyRequest) -> Result<End, Outcome> {
    let text = asked.options.task.as_deref().unwrap_or_default();
    let task = TaskFile::parse(text, "task.toml").map_err(|diagnostics| {
        session.not_read(&diagnostics);
        Outcome::BadModel
    })?;
    let found = synthesize::linkages_of(session, &task, None)?;
    let pages = if found.facts.is_interrupted() { Vec::new() } else { found.pages(session)? };
    let message = match found.facts.advice() {
        Some((why, help)) => format!("{why}; {help}"),
        None => found.facts.rows().into_iter().map(|(_, line)| line).collect::<Vec<_>>().join(". "),
    };
    Ok(End {
        state: if session.interrupted() { "cancelled" } else { "done" },
        message,
        diagnostics: json!([]),
        text: None,
        tables: found.facts.tables(),
        pages,
    })
}
