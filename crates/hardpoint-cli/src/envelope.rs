//! `hardpoint envelope`.

use std::path::PathBuf;

use hardpoint::joint::Quantity;
use hardpoint::model::Dimension;
use hardpoint::space::Vec3;
use hardpoint_export::write_stl;
use hardpoint_file::ModelFile;
use hardpoint_report::diagnose;
use hardpoint_report::envelope::EnvelopeFact;
use hardpoint_study::envelope::{EnvelopeError, Overrides, Request, envelope};
use serde_json::json;

use crate::args;
use crate::folder::write_alone;
use crate::outcome::Outcome;
use crate::session::Session;
use crate::text;
use crate::whatif::in_si;

/// Computes the space that a shape sweeps, and writes its surface.
pub fn run(options: &args::Envelope) -> Outcome {
    let session = Session::begin(options.common.json);
    session.end(envelope_of(&session, options))
}

fn envelope_of(session: &Session, options: &args::Envelope) -> Result<Outcome, Outcome> {
    let to =
        options.output.clone().unwrap_or_else(|| PathBuf::from(format!("{}_envelope.stl", options.shape)));
    session.may_save(&options.common.model, Some(&to))?;
    let file = session.read(&options.common.model)?;
    let length = |option: &str, text: &Option<String>| {
        let given = text.as_ref().map(|text| in_si(text, Quantity::Length, file.units));
        given.transpose().map_err(|why| session.misunderstood(&format!("`--{option}`: {why}")))
    };
    let overrides = Overrides {
        shape: options.shape.clone(),
        relative_to: options.relative_to.clone(),
        case: options.motions.case.clone(),
        error: length("error", &options.error)?,
        margin: length("margin", &options.margin)?,
    };
    session.tell(&file, &file.remarks);
    let request = Request::of(&file.model, overrides).map_err(|e| session.refused(&file, &e))?;
    // The mechanism can be driven, or the reasons are given.
    session.plan(&file, options.common.formulation())?;
    session.patient(true);
    let found = {
        let _working = session.working("computing the envelope");
        let more = || !session.interrupted();
        envelope(&file.model, options.common.formulation(), &[], &request, &more)
    };
    let found = found.map_err(|error| refused(session, &file, error))?;
    let scaled = |v: Vec3| v.map(|x| file.units.from_si(Dimension::LENGTH, x));
    let corners = found.surface.corners().map(|corners| corners.map(scaled));
    write_alone(&to, |out| write_stl(corners, out)).map_err(|e| session.not_written(&e))?;
    let fact = EnvelopeFact::of(&file.model, file.units, &request, &found);
    if options.common.json {
        let stops = found.stops.iter().map(|found| diagnose::stop_of_envelope(&file, found));
        session.print_json(&json!({
            "name": file.model.name, "envelope": fact, "file": to, "diagnostics": Vec::from_iter(stops),
        }));
    } else {
        text::print(&format!("{}\n", text::bold(&file.model.name)));
        fact.sentences().iter().for_each(|line| text::print(&format!("{line}\n")));
        text::print(&format!("\nwritten: {}\n", to.display()));
    }
    Ok(match (&found.stops[..], found.is_within_error) {
        (_, _) if found.interrupted => Outcome::Interrupted,
        ([], true) => Outcome::Done,
        ([], false) => Outcome::FellShort,
        (_, _) => Outcome::Stopped,
    })
}

fn refused(session: &Session, file: &ModelFile, error: EnvelopeError) -> Outcome {
    match error {
        EnvelopeError::Topology(_) => Outcome::CannotBeDriven,
        EnvelopeError::Interrupted => Outcome::Interrupted,
        EnvelopeError::TooThin(error) => {
            session.refused(file, &error);
            Outcome::FellShort
        }
        EnvelopeError::NotReached(stop) => {
            let diagnostics: Vec<_> = stop.iter().map(|stop| diagnose::stop(file, stop, 0, None)).collect();
            session.fail(file, &diagnostics);
            Outcome::Stopped
        }
    }
}
