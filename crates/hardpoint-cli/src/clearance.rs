//! `hardpoint clearance`.

use hardpoint_file::ModelFile;
use hardpoint_report::clearance::{self, ClearanceFact};
use hardpoint_report::diagnose;
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
    session.for_motions(&options.common.model, &options.motions, each).unwrap_or_else(|outcome| outcome)
}

fn clearance_in(
    session: &Session,
    options: &Clearance,
    file: &ModelFile,
    case: Option<&str>,
) -> Result<Outcome, Outcome> {
    if file.model.clearances.is_empty() {
        return Err(session.misunderstood(
            "the model has no clearances; add `[shapes]`, and `[clearances.NAME]` with `between = [\"SHAPE\", \"SHAPE\"]`",
        ));
    }
    let analysis = session.plan(file, options.common.formulation())?;
    let folder = options.output.as_ref().map(|path| Folder::open(&of_case(path, case)));
    let folder = folder.transpose().map_err(|e| session.not_written(&e))?;
    let found = {
        let _working = session.working("locating least distances");
        analysis.clearances(&[])
    };
    let mut prover = if options.no_proof { None } else { analysis.clearance_prover(&[]) };
    let facts = {
        let _working = session.working("proving that nothing is nearer between output times");
        ClearanceFact::proved(&file.model, file.units, &found, &mut |pair| {
            clearance::proof(&file.model, file.units, prover.as_mut()?, pair)
        })
    };
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
        session.print_json(&json!({ "name": file.model.name, "pairs": facts, "diagnostics": stopped }));
    } else {
        text::print(&format!("{}\n", text::bold(&file.model.name)));
        ClearanceFact::sentences(&facts).iter().for_each(|line| text::print(&format!("{line}\n")));
        ClearanceFact::table(&facts).iter().for_each(|table| text::print(&text::section(table)));
        written.iter().for_each(|path| text::print(&format!("\nwritten: {}\n", path.display())));
    }
    let kept = facts.iter().all(|fact| fact.kept);
    let outcome = if kept { Outcome::Done } else { Outcome::FellShort };
    Ok(match stopped {
        Some(stop) => {
            session.tell(file, &[stop]);
            outcome.and(Outcome::Stopped)
        }
        None => outcome,
    })
}
