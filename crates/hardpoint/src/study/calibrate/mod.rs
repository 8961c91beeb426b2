//! Fit of the geometry to measured data: best fit, accuracy, unidentifiable changes, readings to add.
//!
//! A reading i of an output y in a posture with standard deviation s_i has the residual `r_i = (y(b) - m_i) / s_i`; the
//! fit makes the sum of their squares least, or that of a robust loss. With the exact Jacobian `J = dr/db` of what was
//! read,
//!
//! ```text
//! covariance = (J' W J)^-1,    W = the weights of the loss
//! ```
//!
//! over the directions that the readings tell anything of; the others are named and stay in the design configuration
//! (`docs/theory.md`, section 13).

mod certainty;
mod fit;
mod next;
mod posture;

use crate::measure::{Output, outputs};
use crate::model::{Model, VariableId};
use crate::run::Analysis;
use crate::topology::{Formulation, TopologyError};

use super::evaluation::StudyCost;

pub use certainty::{Certainty, UnidentifiableChange};
pub use next::{Improvement, NextReading};

/// One value that was read in a posture. In SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// The posture, by its place in [`Measurements::postures`].
    pub posture: usize,
    /// The column of [`outputs`](crate::measure::outputs).
    pub output: usize,
    /// Measured value.
    pub value: f64,
    /// Standard deviation; none where that is to be found from the residuals, the same for all.
    pub sigma: Option<f64>,
}

/// Measurements of a mechanism.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measurements {
    /// Values of the drivers in each posture, as their laws count, m or rad.
    pub postures: Vec<Vec<f64>>,
    /// Readings in the postures.
    pub readings: Vec<Reading>,
}

/// Loss function of residuals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Loss {
    /// Square.
    #[default]
    Squares,
    /// Square up to 1.345 standard deviations, beyond that its size.
    Huber,
    /// The logarithm of its square: beyond some standard deviations next to nothing.
    Cauchy,
}

impl Loss {
    /// By how much a residual counts less than its square would, from 0 to 1.
    pub fn weight(self, r: f64) -> f64 {
        // 95 % efficient where all is normal (Holland and Welsch 1977)
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
pub enum FitStatus {
    /// No small change of the design fits better.
    Found,
    /// The iterations were used up.
    IterationLimit,
    /// The caller ended it.
    Interrupted,
}

/// A posture that the mechanism in the design configuration does not reach, whose readings are left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnreachedPosture {
    /// The posture.
    pub posture: usize,
    /// Description of the event.
    pub why: String,
}

/// A reading beside what the design found gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FittedReading {
    /// In the design configuration, SI.
    pub before: f64,
    /// Value of the fitted design.
    pub value: f64,
    /// Fitted minus measured value, in standard deviations; in estimated ones if none are given.
    pub residual: f64,
    /// Weight in the fit, from 0 to 1.
    pub weight: f64,
}

/// Result of a calibration, SI.
#[derive(Clone, Debug)]
pub struct Calibration {
    /// Status at the end.
    pub status: FitStatus,
    /// The variables that were sought.
    pub variables: Vec<VariableId>,
    /// Those that the mechanism cannot follow, and that were left as they are.
    pub left_out: Vec<VariableId>,
    /// The design found: the change of every variable of the model.
    pub design: Vec<f64>,
    /// The columns.
    pub outputs: Vec<Output>,
    /// Fitted values of every reading; `None` if its posture is not reached.
    pub fitted: Vec<Option<FittedReading>>,
    /// Postures whose readings were left out.
    pub not_reached: Vec<UnreachedPosture>,
    /// The sum that was made least, of the nominal design and of the one found: of squared residuals in standard
    /// deviations, or of the loss. Where no standard deviations were given, in those that were found.
    pub objective: [f64; 2],
    /// Objective after each iteration.
    pub iterations: Vec<f64>,
    /// Accuracy of the variables.
    pub certainty: Certainty,
    /// Further readings with the most information, the best first.
    pub next: Vec<NextReading>,
    /// Cost of the study.
    pub cost: StudyCost,
}

/// Reason why nothing can be fitted.
#[derive(Clone, Debug)]
pub enum CalibrationError {
    /// The mechanism cannot be driven.
    Topology(TopologyError),
    /// The mechanism in the design configuration reaches none of the postures; what happens on the way to the first.
    NothingReached(String),
    /// The mechanism can follow none of the variables.
    NothingVaries,
    /// No more readings than variables that they tell of, and no standard deviations: how sure anything is cannot be
    /// known.
    TooFewReadings {
        /// Readings that were reached.
        readings: usize,
        /// Variables.
        variables: usize,
    },
}

/// The request.
#[derive(Clone, Copy, Debug)]
pub struct CalibrationRequest<'a> {
    /// Measurements to fit.
    pub measured: &'a Measurements,
    /// The variables that are sought.
    pub variables: &'a [VariableId],
    /// Loss function of the residuals.
    pub loss: Loss,
    /// In which formulation the mechanism is solved.
    pub formulation: Formulation,
    /// At most that many iterations.
    pub iterations: usize,
}

/// Finds the design that explains measurements best. `progress` is reported the objective after every iteration, and
/// `more` is asked at every posture whether to go on.
///
/// # Errors
/// Where nothing can be fitted.
pub fn calibrate(
    model: &Model,
    asked: &CalibrationRequest<'_>,
    progress: &mut dyn FnMut(usize, f64),
    more: &dyn Fn() -> bool,
) -> Result<Calibration, CalibrationError> {
    let models: Vec<Model> = asked.measured.postures.iter().map(|p| posture::standing(model, p)).collect();
    let analyses = posture::planned(&models, asked.formulation).map_err(CalibrationError::Topology)?;
    let mut bench = fit::FitWorkspace::new(model, &analyses, asked);
    bench.look_at_drawing()?;
    let search = bench.search(progress, more);
    let known = bench.known(&search);
    let certainty = bench.certainty(&search, &known);
    let next = match search.status {
        FitStatus::Found => bench.next(&search, &known, &certainty),
        _ => Vec::new(),
    };
    Ok(bench.calibration(search, certainty, next, outputs(model)))
}

/// Values of all outputs of a design in some postures of the drivers, as [`Measurements::postures`]; or the reason why
/// one is not reached. SI.
///
/// # Errors
/// A [`TopologyError`] where the mechanism cannot be driven.
pub fn values_in_postures(
    model: &Model,
    design: &[f64],
    postures: &[Vec<f64>],
    formulation: Formulation,
) -> Result<Vec<Result<Vec<f64>, String>>, TopologyError> {
    let models: Vec<Model> = postures.iter().map(|p| posture::standing(model, p)).collect();
    let values = |analysis: &Analysis<'_>| {
        let stand = posture::stand(analysis, design, &mut StudyCost::default());
        let values =
            |stand: posture::ReachedPosture| (0..outputs(model).len()).map(|m| stand.value(m)).collect();
        stand.map(values).map_err(|stop| stop.headline(analysis.model()))
    };
    Ok(posture::planned(&models, formulation)?.iter().map(values).collect())
}
