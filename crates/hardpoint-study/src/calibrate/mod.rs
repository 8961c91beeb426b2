//! Calibration: fit of the geometry to measured data, with the accuracy of the result, unidentifiable changes, and
//! proposed further readings.
//!
//! Input: a [`Request`] with readings of outputs in postures of the drivers, SI. Output: a [`Calibration`] with the
//! fitted design and its covariance, m, rad or plain.
//!
//! A reading i of an output y in a posture, with standard deviation s_i, has the residual `r_i = (y(b) - m_i) / s_i`.
//! The fit minimises the sum of their squares or of a robust loss. With the exact Jacobian `J = dr/db` of the readings,
//!
//! ```text
//! covariance = (J' W J)^-1,    W = the weights of the loss
//! ```
//!
//! over the directions that the readings determine. Gaussian priors and groups of variables are further rows, so that
//! the same formula is the covariance of the posterior (Tarantola, Inverse Problem Theory, 2005, section 3.2). All
//! other directions are reported and keep their design values (`docs/theory.md`, section 13).

mod certainty;
mod fit;
mod next;
mod posture;
mod prior;
mod request;
mod validate;

use std::cell::Cell;

use hardpoint::measure::{Output, outputs};
use hardpoint::model::{DriverId, Model, OutputSource, Reading, VariableId};
use hardpoint::run::Analysis;
use hardpoint::topology::{Formulation, TopologyError};

use super::evaluation::StudyCost;
use super::progress::{Control, Progress, Step};
use super::request::{RequestError, named};

pub use certainty::{Certainty, UnidentifiableChange};
use posture::path_end;
pub(crate) use posture::posture_model;

pub use next::{Improvement, NextReading};
pub use prior::Prior;
pub use request::{Overrides, Request};
pub use validate::{ValidatedReading, Validation};

/// Loss function of residuals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Loss {
    /// Square of the residual.
    #[default]
    Squares,
    /// Square up to 1.345 standard deviations, linear beyond.
    Huber,
    /// Logarithm of the square: residuals of many standard deviations have next to no influence.
    Cauchy,
}

impl Loss {
    /// Names of all of them.
    pub const NAMES: [&str; 3] = ["squares", "huber", "cauchy"];

    /// Loss function of a name.
    ///
    /// # Errors
    /// A [`RequestError`] if there is none.
    pub fn named(name: &str) -> Result<Self, RequestError> {
        Ok([Self::Squares, Self::Huber, Self::Cauchy][named("loss function", name, Self::NAMES)?])
    }

    /// Weight of a residual relative to least squares, from 0 to 1.
    pub fn weight(self, r: f64) -> f64 {
        // 95 % efficiency for normal residuals (Holland and Welsch 1977)
        const HUBER: f64 = 1.345;
        const CAUCHY: f64 = 2.385;
        match self {
            Self::Squares => 1.0,
            Self::Huber => HUBER / r.abs().max(HUBER),
            Self::Cauchy => 1.0 / (1.0 + (r / CAUCHY).powi(2)),
        }
    }
}

/// Status of a fit at its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// No small change of the design improves the fit.
    Found,
    /// Better designs cannot be used: the mechanism does not assemble, stops before a posture, or cannot follow a
    /// fitted variable there.
    Stuck,
    /// A parameter has left every sensible range: the readings do not determine it, or do not fit the mechanism.
    Diverged,
    /// The iteration limit was reached.
    IterationLimit,
    /// The caller ended the fit.
    Interrupted,
}

impl Status {
    /// True if the formula of the covariance, that of an optimum, is valid at the end.
    pub(super) fn has_covariance(self) -> bool {
        match self {
            Self::Found | Self::IterationLimit | Self::Interrupted => true,
            Self::Stuck | Self::Diverged => false,
        }
    }
}

/// Parameter that is fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FittedParameter {
    /// A design variable.
    Variable(VariableId),
    /// Offset of a driver: its real position minus that of the table.
    Driver(DriverId),
    /// Offset of an output, by its column in [`outputs`]: reading minus value.
    Output(usize),
}

/// Bound that a variable is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoundSide {
    /// Lower bound.
    Lower,
    /// Upper bound.
    Upper,
}

/// Posture that the nominal design does not reach. Its readings are left out.
#[derive(Clone, Debug, PartialEq)]
pub struct UnreachedPosture {
    /// Index of the posture.
    pub posture: usize,
    /// Description of the event.
    pub why: String,
    /// Positions of the drivers at the last solved position on the path to the posture, counted like those of
    /// [`Measurements`](hardpoint::model::Measurements); `None` if the path has none.
    pub last: Option<Vec<f64>>,
}

/// Reading with the values of the nominal and the fitted design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FittedReading {
    /// Value of the nominal design, SI.
    pub before: f64,
    /// Value of the fitted design, SI.
    pub value: f64,
    /// Fitted minus measured value, in standard deviations; in estimated ones if none are given.
    pub residual: f64,
    /// Weight in the fit, from 0 to 1.
    pub weight: f64,
}

/// Result of a calibration, SI.
#[derive(Clone, Debug)]
pub struct Calibration {
    /// Status at the end of the fit.
    pub status: Status,
    /// Fitted parameters.
    pub parameters: Vec<FittedParameter>,
    /// Change of each fitted parameter from the nominal design, SI.
    pub estimates: Vec<f64>,
    /// Bounds of each of these changes, SI, if the fit keeps any.
    pub bounds: Vec<Option<[f64; 2]>>,
    /// Parameters that the mechanism cannot follow. They keep their nominal values.
    pub left_out: Vec<FittedParameter>,
    /// Fitted design: change of every variable of the model.
    pub design: Vec<f64>,
    /// Columns of the outputs.
    pub outputs: Vec<Output>,
    /// Fitted values of every reading; `None` if its posture is not reached.
    pub fitted: Vec<Option<FittedReading>>,
    /// Postures whose readings were left out.
    pub not_reached: Vec<UnreachedPosture>,
    /// Objective of the nominal and the fitted design: sum of squared residuals in standard deviations, or of the loss,
    /// and of squared residuals of the priors.
    /// Without given standard deviations, estimated ones are used.
    pub objective: [f64; 2],
    /// Objective after each iteration.
    pub iterations: Vec<f64>,
    /// Accuracy of the fitted parameters.
    pub certainty: Certainty,
    /// Proposed further readings, the most informative first.
    pub next: Vec<NextReading>,
    /// Residuals of the validation data, if there are any.
    pub validation: Option<Validation>,
    /// Cost of the study.
    pub cost: StudyCost,
}

/// Reason why nothing can be fitted.
#[derive(Clone, Debug)]
pub enum Error {
    /// The mechanism cannot be driven.
    Topology(TopologyError),
    /// The measurements do not determine the variables.
    Request(RequestError),
}

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
    let models = posture::posture_models(model, request.measured, &offsets);
    let analyses = posture::planned(&models, request.formulation).map_err(Error::Topology)?;
    let others = request.validation.map_or(Vec::new(), |data| posture::posture_models(model, data, &offsets));
    let others = posture::planned(&others, request.formulation).map_err(Error::Topology)?;
    let mut workspace = fit::FitWorkspace::new(model, &analyses, request);
    workspace.evaluate_nominal().map_err(Error::Request)?;
    let search = workspace.search(&mut progress, &more);
    let directions = workspace.directions(&search);
    let certainty = workspace.certainty(&search, &directions);
    let next = match search.status {
        Status::Found => workspace.next(&search, &directions, &certainty),
        Status::Stuck | Status::Diverged | Status::IterationLimit | Status::Interrupted => Vec::new(),
    };
    let validation = request.validation.map(|data| workspace.validate(data, &others, &search, &directions));
    Ok(workspace.calibration(search, certainty, next, validation, outputs(model)))
}

/// Values of all outputs of a design in postures of the drivers, SI; the reason for each posture that is not reached.
/// Postures are given as in [`Measurements`](hardpoint::model::Measurements).
///
/// # Errors
/// A [`TopologyError`] if the mechanism cannot be driven.
pub fn values_in_postures(
    model: &Model,
    design: &[f64],
    postures: &[Vec<f64>],
    formulation: Formulation,
) -> Result<Vec<Result<Vec<f64>, String>>, TopologyError> {
    let models: Vec<Model> = postures.iter().map(|p| posture_model(model, p, &[], &[])).collect();
    let sources: Vec<OutputSource> = outputs(model).into_iter().map(|output| output.source).collect();
    let values = |analysis: &Analysis<'_>| {
        let solved = posture::solve_posture(analysis, design, &sources, &mut StudyCost::default());
        let values =
            |posture: posture::ReachedPosture| (0..sources.len()).map(|m| posture.value(m)).collect();
        solved.map(values).map_err(|stop| path_end(&stop, analysis.model()))
    };
    Ok(posture::planned(&models, formulation)?.iter().map(values).collect())
}
