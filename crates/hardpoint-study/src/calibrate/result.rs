//! Result of a calibration.

use hardpoint::measure::Output;
use hardpoint::topology::TopologyError;

use super::certainty::Certainty;
use super::fit::{FitWorkspace, SearchResult, Status};
use super::next::NextReading;
use super::parameter::FittedParameter;
use super::posture::UnreachedPosture;
use super::validate::Validation;
use crate::evaluation::StudyCost;
use crate::request::RequestError;

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

/// Reason why nothing can be fitted.
#[derive(Clone, Debug)]
pub enum Error {
    /// The mechanism cannot be driven.
    Topology(TopologyError),
    /// The measurements do not determine the variables.
    Request(RequestError),
}

impl Calibration {
    /// Assembles the result of a fit.
    pub(super) fn of(
        fit: FitWorkspace<'_>,
        search: SearchResult,
        certainty: Certainty,
        next: Vec<NextReading>,
        validation: Option<Validation>,
        outputs: Vec<Output>,
    ) -> Self {
        let mut fitted = vec![None; fit.readings().len()];
        for (row, k) in fit.compared.iter().enumerate() {
            let reading = &fit.readings()[*k];
            let sigma = fit.unit(reading);
            let nominal = fit.nominal[reading.posture].as_ref().map_or(f64::NAN, |s| s.value(reading.output));
            fitted[*k] = Some(FittedReading {
                before: nominal,
                value: reading.value + sigma * search.at.r[row],
                residual: search.at.r[row] / search.scale,
                weight: search.weights[row],
            });
        }
        let mut design = fit.design(&search.x);
        design.truncate(fit.model.variables.len());
        Self {
            status: search.status,
            design,
            estimates: search.x.iter().zip(&fit.steps).map(|(x, step)| x * step).collect(),
            bounds: fit.parameters.iter().map(|p| fit.kept_bounds(*p)).collect(),
            parameters: fit.parameters,
            validation,
            left_out: fit.left_out,
            outputs,
            fitted,
            not_reached: fit.not_reached,
            objective: search.objective,
            iterations: search.iterations,
            certainty,
            next,
            cost: fit.cost.into_inner(),
        }
    }
}
