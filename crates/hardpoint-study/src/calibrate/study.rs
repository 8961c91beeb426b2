//! Fit of a design to measurements, with its accuracy.

use std::cell::Cell;

use hardpoint::measure::outputs;
use hardpoint::model::Model;

use super::fit::{FitWorkspace, Status};
use super::posture::{planned, posture_models};
use super::request::Request;
use super::result::{Calibration, Error};
use crate::progress::{Control, Progress, Step};

/// Fits the design to measurements, on one thread. Reports the objective after every iteration. `more` is called at
/// every posture.
///
/// # Errors
/// An [`Error`] if nothing can be fitted.
pub fn calibrate(model: &Model, request: &Request<'_>, control: Control<'_>) -> Result<Calibration, Error> {
    let Control { progress, more, .. } = control;
    let ended = Cell::new(false);
    let mut progress = |done: usize, objective: f64| {
        let progressed = Progress::counted(Step::Fit(objective), done, request.iterations);
        ended.set(ended.get() || progress(progressed).is_break());
    };
    let more = || !ended.get() && more();
    let offsets = request.offset_drivers();
    let models = posture_models(model, request.measured, &offsets);
    let analyses = planned(&models, request.formulation).map_err(Error::Topology)?;
    let others = request.validation.map_or(Vec::new(), |data| posture_models(model, data, &offsets));
    let others = planned(&others, request.formulation).map_err(Error::Topology)?;
    let mut workspace = FitWorkspace::new(model, &analyses, request);
    workspace.evaluate_nominal().map_err(Error::Request)?;
    let search = workspace.search(&mut progress, &more);
    let directions = workspace.directions(&search);
    let certainty = workspace.certainty(&search, &directions);
    let next = match search.status {
        Status::Found => workspace.next(&search, &directions, &certainty),
        Status::Stuck | Status::Diverged | Status::IterationLimit | Status::Interrupted => Vec::new(),
    };
    let validation = request.validation.map(|data| workspace.validate(data, &others, &search, &directions));
    Ok(Calibration::of(workspace, search, certainty, next, validation, outputs(model)))
}
