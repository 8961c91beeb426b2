//! `hardpoint verify`.

use std::io::Write;
use std::time::Instant;

use hardpoint_file::ModelFile;
use hardpoint_report::diagnose;
use hardpoint_report::facts::Facts;
use hardpoint_report::figures::{count, error, seconds};
use hardpoint_report::verdict::{Differences, Outcome as Agrees, Verdict};
use hardpoint_study::verify::{self, verify as verify_designs};

use crate::args::Verify;
use crate::folder::{Folder, of_case};
use crate::outcome::Outcome;
use crate::session::{Session, json_text};
use crate::text;

/// Compares the sensitivities with re-solved designs and prints their agreement.
pub fn verify(options: &Verify) -> Outcome {
    let session = Session::begin(options.common.json);
    let each = |file: ModelFile, case: Option<&str>| verify_in(&session, options, file, case);
    session.end(session.for_motions(&options.common.model, &options.motions, each))
}

fn verify_in(
    session: &Session,
    options: &Verify,
    mut file: ModelFile,
    case: Option<&str>,
) -> Result<Outcome, Outcome> {
    session.fits(&mut file);
    let analysis = session.plan(&file, options.common.formulation())?;
    let folder = options.output.as_ref().map(|path| Folder::open(&of_case(path, case)));
    let folder = folder.transpose().map_err(|e| session.not_written(&e))?;

    let solution = session.solve(&analysis);
    if let Some(stop) = &solution.stop {
        let d = diagnose::stop(&file, stop, solution.motion.len(), None);
        session.fail(&file, &[d]);
        return Err(if session.interrupted() { Outcome::Interrupted } else { Outcome::Stopped });
    }
    session.tell(&file, &file.remarks);
    session.tell(&file, &diagnose::variables(&file, &Facts::new(&file, &analysis, Some(&solution))));

    let started = Instant::now();
    let mut sweep = verify::Options::new(options.differences.scheme());
    if let Some(steps) = &options.steps {
        sweep.steps.clone_from(steps);
    }
    let mut meter = session.meter("re-solving designs", "variables");
    let verification = verify_designs(&analysis, &solution, &sweep, |progress| {
        meter.show(progress.done, progress.total);
        session.go_on()
    });
    drop(meter);
    let verdict = Verdict::new(&file, &analysis, &verification, started.elapsed().as_secs_f64());

    let mut written = None;
    if let Some(mut folder) = folder {
        let json = json_text(&verdict);
        written = Some(folder.path_of("verify.json"));
        let result = folder
            .write("verify.json", |out| out.write_all(json.as_bytes()))
            .and_then(|()| folder.commit(&[]));
        result.map_err(|e| session.not_written(&e))?;
    }
    if options.common.json {
        session.print_json(&verdict);
    } else {
        text::print(&verdict_text(&verdict, options.sweep));
        text::print(&written.map_or(String::new(), |path| format!("\nwritten: {}\n", path.display())));
    }
    Ok(match (verdict.passed, verdict.interrupted) {
        (_, true) => Outcome::Interrupted,
        (true, _) => Outcome::Done,
        (false, _) => Outcome::FellShort,
    })
}

fn verdict_text(verdict: &Verdict, sweep: bool) -> String {
    let mut out = format!("{}\n", text::bold(&verdict.name));
    if verdict.checks.is_empty() {
        return out + "The model has no design variables: there is nothing to verify.\n";
    }
    if sweep {
        let table = verdict.sweep_table();
        out += &format!("{}  {}\n\n", text::table(&table), table.note);
    }
    out += &text::table(&verdict.table());
    for (variable, note) in verdict.checks.iter().filter_map(|c| c.note.map(|n| (&c.variable, n))) {
        out += &format!("\nnote: `{variable}`: {note}\n");
    }
    if let Some(worst) = &verdict.worst {
        let (variable, quantity) = (&worst.variable, &worst.quantity);
        out += &format!("\nworst of all: {} in {quantity} by {variable}\n", error(worst.error));
    }
    let result = match (verdict.passed, verdict.interrupted) {
        (_, true) => "interrupted",
        (true, _) => "passed",
        (false, _) => "FAILED",
    };
    let of = |outcome| verdict.checks.iter().filter(|c| c.outcome == outcome).count();
    let mut parts =
        vec![format!("{} of {} agree", of(Agrees::Passed), count(verdict.checks.len(), "variable"))];
    let others = [
        (Agrees::Failed, "disagree"),
        (Agrees::NotSolved, "could not be re-solved"),
        (Agrees::CannotFollow, "cannot be followed, so there is nothing to compare"),
    ];
    parts.extend(others.iter().filter(|(o, _)| of(*o) > 0).map(|(o, words)| format!("{} {words}", of(*o))));
    let differences = match verdict.differences {
        Differences::Central => "central",
        Differences::Forward => "forward",
        Differences::Backward => "backward",
    };
    out + &format!(
        "{result}: {}\nA variable agrees if every quantity deviates from {differences} differences by {} at most, at its best step; \
         took {}\n",
        parts.join(", "),
        error(verdict.tolerance),
        seconds(verdict.seconds)
    )
}
