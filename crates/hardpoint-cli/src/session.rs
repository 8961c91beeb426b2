//! What the commands share: reading the model, solving with progress and interruption, and telling what
//! went wrong, as text or as JSON.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use hardpoint::topology::{Formulation, TopologyFault};
use hardpoint::{Analysis, Solution};
use hardpoint_file::{Diagnostic, ModelFile, ReadError};
use hardpoint_report::{GENERATOR, diagnose};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::json;

use crate::folder::NotWritten;
use crate::outcome::Outcome;
use crate::text;

/// A command under way.
pub struct Session {
    json: bool,
    started: Instant,
    interrupted: Arc<AtomicBool>,
}

impl Session {
    /// Begins; from now on Ctrl-C asks to stop, and another Ctrl-C later ends the program at once.
    pub fn begin(json: bool) -> Self {
        // Shells and job runners may send the same signal to a process and to its group.
        const SAME_REQUEST: Duration = Duration::from_millis(500);
        let interrupted = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&interrupted);
        let mut first = None;
        // Without a handler Ctrl-C just ends the program, which is no reason not to run.
        let _ = ctrlc::set_handler(move || {
            flag.store(true, Ordering::SeqCst);
            if first.get_or_insert_with(Instant::now).elapsed() > SAME_REQUEST {
                std::process::exit(Outcome::Interrupted as i32);
            }
        });
        Self { json, started: Instant::now(), interrupted }
    }

    /// Whether the user asked to stop.
    pub fn interrupted(&self) -> bool {
        self.interrupted.load(Ordering::SeqCst)
    }

    /// Seconds since the beginning.
    pub fn seconds(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }

    /// Reads the model, or tells what is wrong with it.
    pub fn read(&self, path: &Path) -> Result<ModelFile, Outcome> {
        hardpoint_file::read(path).map_err(|error: ReadError| {
            let diagnostics = error.diagnostics();
            if self.json {
                self.print_error(diagnostics.list());
            } else {
                text::complain(&format!("{}\n", diagnostics.render(text::stderr_in_color())));
            }
            Outcome::BadModel
        })
    }

    /// Plans the solution, or tells why the mechanism cannot be driven.
    pub fn plan<'m>(&self, file: &'m ModelFile, formulation: Formulation) -> Result<Analysis<'m>, Outcome> {
        Analysis::with(&file.model, formulation).map_err(|fault| self.cannot_be_driven(file, &fault))
    }

    /// Tells why the mechanism cannot be driven.
    pub fn cannot_be_driven(&self, file: &ModelFile, fault: &TopologyFault) -> Outcome {
        self.fail(file, &[diagnose::topology_fault(file, fault)]);
        Outcome::CannotBeDriven
    }

    /// Whether the result is one JSON document.
    pub fn is_json(&self) -> bool {
        self.json
    }

    /// Solves motion and sensitivities, showing progress.
    pub fn solve(&self, analysis: &Analysis<'_>) -> Solution {
        let mut meter = Meter::new("solving", "steps");
        analysis.run_with(|progress| {
            meter.show(progress.done, progress.total);
            self.go_on()
        })
    }

    /// For the core's loops: go on unless the user asked to stop.
    pub fn go_on(&self) -> ControlFlow<()> {
        if self.interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Shows diagnostics of the model file as text; as JSON they are part of the result.
    pub fn tell(&self, file: &ModelFile, diagnostics: &[Diagnostic]) {
        if !self.json {
            let color = text::stderr_in_color();
            for d in diagnostics {
                text::complain(&format!("{}\n\n", file.render(d, color)));
            }
        }
    }

    /// Tells why there is no result.
    pub fn fail(&self, file: &ModelFile, diagnostics: &[Diagnostic]) {
        if self.json {
            self.print_error(diagnostics);
        } else {
            self.tell(file, diagnostics);
        }
    }

    /// Tells that the command line asks for something that the model does not have.
    pub fn misunderstood(&self, why: &str) -> Outcome {
        self.refuse("HP0602", why, None, "nothing was solved", "see `hardpoint help`");
        Outcome::Misunderstood
    }

    /// Tells that a result could not be written.
    pub fn not_written(&self, failure: &NotWritten) -> Outcome {
        let message = format!("`{}` cannot be written", failure.path.display());
        let help = "name a folder that you may write to with `-o`";
        self.refuse("HP0601", &message, Some(&failure.path), &failure.error.to_string(), help);
        Outcome::NotWritten
    }

    /// Tells what is wrong but not in the model's file.
    fn refuse(&self, code: &str, message: &str, file: Option<&Path>, note: &str, help: &str) {
        if self.json {
            let d = json!({
                "severity": "error", "code": code, "message": message, "file": file,
                "line": null, "column": null, "label": null, "notes": [note], "help": help,
            });
            self.print_json(&json!({ "generator": GENERATOR, "status": "error", "diagnostics": [d] }));
        } else {
            text::complain(&text::error(code, message, note, help));
        }
    }

    /// Prints a JSON document.
    pub fn print_json(&self, document: &impl serde::Serialize) {
        text::print(&json_text(document));
    }

    fn print_error(&self, diagnostics: &[Diagnostic]) {
        self.print_json(&json!({ "generator": GENERATOR, "status": "error", "diagnostics": diagnostics }));
    }
}

/// A JSON document as it is printed and written.
pub fn json_text(document: &impl serde::Serialize) -> String {
    let mut text = serde_json::to_string_pretty(document).expect("results are plain data");
    text.push('\n');
    text
}

/// A progress bar that appears only where something takes its time, and only on a terminal.
pub struct Meter {
    what: &'static str,
    unit: &'static str,
    started: Instant,
    bar: Option<ProgressBar>,
}

impl Meter {
    /// A meter of this work.
    pub fn new(what: &'static str, unit: &'static str) -> Self {
        Self { what, unit, started: Instant::now(), bar: None }
    }

    /// A sign that work of unknown length goes on.
    pub fn working(what: &'static str) -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr()).with_message(what);
        bar.enable_steady_tick(Duration::from_millis(200));
        Self { what, unit: "", started: Instant::now(), bar: Some(bar) }
    }

    /// Shows how far the work is.
    pub fn show(&mut self, done: usize, total: usize) {
        const PATIENCE: Duration = Duration::from_millis(300);
        if self.bar.is_none() && self.started.elapsed() > PATIENCE {
            let bar = ProgressBar::with_draw_target(Some(total as u64), ProgressDrawTarget::stderr());
            let template = format!("{} {{bar:32}} {{pos}} of {{len}} {}, {{eta}} left", self.what, self.unit);
            if let Ok(style) = ProgressStyle::with_template(&template) {
                bar.set_style(style);
            }
            self.bar = Some(bar);
        }
        if let Some(bar) = &self.bar {
            bar.set_position(done as u64);
        }
    }
}

impl Drop for Meter {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
