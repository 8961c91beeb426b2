//! `hardpoint clearance`.

use hardpoint::model::Grid;
use hardpoint::motion::StopKind;
use hardpoint_file::ModelFile;
use hardpoint_report::clearance::{self, ClearanceFact, GridClearanceFact};
use hardpoint_report::diagnose;
use hardpoint_report::figures::number;
use hardpoint_study::grid::GridClearances;
use serde_json::json;

use crate::args::Clearance;
use crate::folder::{Folder, of_case};
use crate::outcome::Outcome;
use crate::session::Session;
use crate::text;

/// Locates the least distances of all pairs of shapes, and prints them.
pub fn run(options: &Clearance) -> Outcome {
    let session = Session::begin(options.common.json);
    let each = |file: ModelFile, case: Option<&str>| clearance_in(&session, options, &file, case);
    let mut each_grid = |file: &ModelFile, grid: &Grid| clearance_over(&session, options, file, grid);
    let of = |file: ModelFile| {
        session.tell(&file, &file.remarks);
        session.for_cases_of(file, &options.motions, each, Some(&mut each_grid))
    };
    session.end(session.read(&options.common.model).and_then(of))
}

fn clearance_over(
    session: &Session,
    options: &Clearance,
    file: &ModelFile,
    grid: &Grid,
) -> Result<Outcome, Outcome> {
    has_clearances(session, file)?;
    // The mechanism can be driven, or the reasons are given.
    session.plan(file, options.common.formulation())?;
    session.patient(true);
    let found = {
        let _working = session.working("locating least distances");
        let more = || !session.interrupted();
        GridClearances::solve(&file.model, grid, options.common.formulation(), &[], &more)
    };
    let Ok(found) = found else { return Err(Outcome::CannotBeDriven) };
    let fact = GridClearanceFact::of(&file.model, file.units, &found);
    if options.common.json {
        session.print_json(&json!({ "name": file.model.name, "map": fact }));
    } else {
        text::print(&format!("{}\n", text::bold(&format!("{}, map `{}`", file.model.name, grid.name))));
        fact.sentences().iter().for_each(|line| text::print(&format!("{line}\n")));
        fact.table().iter().for_each(|table| text::print(&text::section(table)));
    }
    let kept = if fact.kept() { Outcome::Done } else { Outcome::FellShort };
    Ok(if found.interrupted { Outcome::Interrupted } else { kept })
}

fn has_clearances(session: &Session, file: &ModelFile) -> Result<(), Outcome> {
    if file.model.clearances.is_empty() {
        return Err(session.misunderstood(
            "the model has no clearances; add `[shapes]`, and `[clearances.NAME]` with `between = [\"SHAPE\", \"SHAPE\"]`",
        ));
    }
    Ok(())
}

fn clearance_in(
    session: &Session,
    options: &Clearance,
    file: &ModelFile,
    case: Option<&str>,
) -> Result<Outcome, Outcome> {
    has_clearances(session, file)?;
    let analysis = session.until_interrupted(session.plan(file, options.common.formulation())?);
    let folder = options.output.as_ref().map(|path| Folder::open(&of_case(path, case)));
    let folder = folder.transpose().map_err(|e| session.not_written(&e))?;
    session.patient(true);
    let found = {
        let _working = session.working("locating least distances");
        analysis.clearances(&[])
    };
    let is_cut = found.stop.as_ref().is_some_and(|stop| stop.kind == StopKind::Interrupted);
    let mut prover = if options.no_proof || is_cut { None } else { analysis.clearance_prover(&[]) };
    let facts = {
        let _working = session.working("proving that nothing is nearer between output times");
        ClearanceFact::proved(&file.model, file.units, &found, &mut |pair| {
            clearance::proof(&file.model, file.units, prover.as_mut()?, pair)
        })
    };
    let is_interrupted = session.interrupted();
    let mut written = None;
    if let Some(mut folder) = folder {
        written = Some(folder.path_of("clearances.csv"));
        let result = folder
            .write("clearances.csv", |out| Ok(clearance::write(&file.model, file.units, &found, out)?))
            .and_then(|()| folder.commit(&["clearances.csv"]));
        result.map_err(|e| session.not_written(&e))?;
    }
    let stopped = found.stop.as_ref().map(|stop| {
        let solved = found.pairs.first().map_or(0, |pair| pair.curve.len());
        diagnose::stop(file, stop, solved, None)
    });
    if options.common.json {
        session.print_json(&json!({
            "name": file.model.name, "pairs": facts, "interrupted": is_interrupted,
            "diagnostics": Vec::from_iter(stopped.as_ref()),
        }));
    } else {
        text::print(&format!("{}\n", text::bold(&file.model.name)));
        ClearanceFact::sentences(&facts).iter().for_each(|line| text::print(&format!("{line}\n")));
        if is_cut {
            text::print(
                "Interrupted: minima and contacts that were not located yet are at times that were solved, \
                 without derivatives.\n",
            );
        } else if let Some(end) = found.stop.as_ref().and_then(|stop| stop.last_time) {
            text::print(&format!("All of this is until the motion ends, at t = {} s.\n", number(end)));
        }
        ClearanceFact::table(&facts).iter().for_each(|table| text::print(&text::section(table)));
        written.iter().for_each(|path| text::print(&format!("\nwritten: {}\n", path.display())));
    }
    let kept = facts.iter().all(|fact| fact.kept);
    let outcome = if kept { Outcome::Done } else { Outcome::FellShort };
    let outcome = match stopped {
        Some(stop) => {
            session.tell(file, &[stop]);
            outcome.and(Outcome::Stopped)
        }
        None => outcome,
    };
    Ok(if is_interrupted { Outcome::Interrupted } else { outcome })
}
