//! `hardpoint check`.

use std::time::Instant;

use hardpoint_report::diagnose;
use hardpoint_report::facts::Facts;
use hardpoint_report::summary::{RunStatus, Summary};

use crate::args::Check;
use crate::outcome::Outcome;
use crate::session::Session;
use crate::text;

/// Examines a model and prints what it found.
pub fn check(options: &Check) -> Outcome {
    let session = Session::begin(options.common.json);
    check_in(&session, options).unwrap_or_else(|outcome| outcome)
}

fn check_in(session: &Session, options: &Check) -> Result<Outcome, Outcome> {
    let file = session.read(&options.common.model)?;
    let analysis = session.plan(&file, options.common.formulation())?;
    let read = session.seconds();
    let started = Instant::now();
    let solution = session.solve(&analysis);
    let facts = Facts::new(&file, analysis.topology(), Some(&solution));
    let mut summary = Summary::new(&file, facts, &solution);
    summary.timings.read = read;
    summary.timings.solve = started.elapsed().as_secs_f64();
    summary.timings.total = session.seconds();
    summary.diagnostics = diagnose::variables(&file, &summary.model);
    if let Some(stop) = &solution.stop {
        summary.diagnostics.push(diagnose::stop(&file, stop, solution.motion.len(), None));
    }
    if options.common.json {
        session.print_json(&summary);
    } else {
        text::print(&facts_text(&summary));
        session.tell(&file, &summary.diagnostics);
    }
    Ok(match summary.status {
        RunStatus::Complete => Outcome::Done,
        RunStatus::Stopped => Outcome::Stopped,
        RunStatus::Interrupted => Outcome::Interrupted,
    })
}

fn facts_text(summary: &Summary) -> String {
    let (facts, steps) = (&summary.model, &summary.steps);
    let rows = [
        ("degrees of freedom", facts.freedom_line()),
        ("constraints", facts.constraints_line()),
        ("loops", facts.loops_line()),
        ("motion", format!("{} of {} steps solved", steps.solved, steps.asked)),
        ("design variables", facts.variables_line()),
    ];
    let mut out = format!("{}\n", text::bold(&facts.name));
    out += &facts.description.as_ref().map_or(String::new(), |d| format!("{d}\n"));
    out += &text::pairs(&rows);
    for table in facts.tables() {
        out += &format!("\n{}", text::table(&table));
    }
    out
}
