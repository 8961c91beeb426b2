//! `hardpoint check`.

use std::time::Instant;

use hardpoint::Analysis;
use hardpoint::topology::Formulation;
use hardpoint_file::ModelFile;
use hardpoint_report::course::Course;
use hardpoint_report::diagnose;
use hardpoint_report::facts::outline;
use hardpoint_report::summary::{RunStatus, Summary};

use crate::args::Check;
use crate::outcome::Outcome;
use crate::session::Session;
use crate::text;

/// Checks a model and prints the findings.
pub fn check(options: &Check) -> Outcome {
    let session = Session::begin(options.common.json);
    let each = |file: ModelFile, _: Option<&str>| check_in(&session, options, &file);
    session.end(session.for_motions(&options.common.model, &options.motions, each))
}

pub fn check_in(session: &Session, options: &Check, file: &ModelFile) -> Result<Outcome, Outcome> {
    let summary = examine(session, options.common.formulation(), file)?;
    if session.is_json() {
        session.print_json(&summary);
    } else {
        text::print(&facts_text(&summary));
        session.tell(file, &summary.diagnostics);
    }
    Ok(outcome(&summary))
}

/// Solves a model's motion and summarises it with all diagnostics.
pub fn examine(session: &Session, formulation: Formulation, file: &ModelFile) -> Result<Summary, Outcome> {
    solved(session, formulation, file).map(|(summary, _)| summary)
}

/// Solves a model's motion. Returns its summary with all diagnostics, and the motion.
pub fn solved(
    session: &Session,
    formulation: Formulation,
    file: &ModelFile,
) -> Result<(Summary, Course), Outcome> {
    let analysis = Analysis::with(&file.model, formulation).map_err(|fault| {
        if !session.is_json() {
            text::print(&outline_text(file));
        }
        session.cannot_be_driven(file, &fault)
    })?;
    let read = session.seconds();
    let started = Instant::now();
    session.patient(true);
    let course = session.solve_in_windows(&analysis, true, |_| true)?;
    session.patient(false);
    let mut summary = Summary::new(file, &analysis, &course);
    summary.timings.read = read;
    summary.timings.solve = started.elapsed().as_secs_f64();
    summary.timings.total = session.seconds();
    summary.diagnostics = diagnose::all(file, &summary, &course, None);
    Ok((summary, course))
}

/// Outcome of a check with this summary.
pub fn outcome(summary: &Summary) -> Outcome {
    match summary.status {
        RunStatus::Complete => Outcome::Done,
        RunStatus::Stopped => Outcome::Stopped,
        RunStatus::Interrupted => Outcome::Interrupted,
    }
}

/// Text about a mechanism that cannot be driven.
fn outline_text(file: &ModelFile) -> String {
    let mut out = heading(&file.model.name, file.description.as_deref());
    for table in outline(file) {
        out += &text::section(&table);
    }
    out
}

fn heading(name: &str, description: Option<&str>) -> String {
    format!("{}\n{}", text::bold(name), description.map_or(String::new(), |d| format!("{d}\n")))
}

fn facts_text(summary: &Summary) -> String {
    let (facts, steps) = (&summary.model, &summary.steps);
    let mut rows = vec![
        ("degrees of freedom", facts.freedom_line()),
        ("constraints", facts.constraints_line()),
        ("loops", facts.loops_line()),
        ("motion", format!("{} of {} steps solved", steps.solved, steps.asked)),
    ];
    rows.extend(summary.effort.solved_by.clone().map(|by| ("steps solved by", by)));
    rows.extend(summary.margin.as_ref().map(|m| ("margin", m.line_from_start())));
    rows.push(("design variables", facts.variables_line()));
    let mut out = heading(&facts.name, facts.description.as_deref());
    out += &text::pairs(&rows);
    out += &text::notes(summary);
    for table in summary.assembly.iter().flat_map(|a| a.tables()).chain(facts.tables()) {
        out += &text::section(&table);
    }
    out
}
