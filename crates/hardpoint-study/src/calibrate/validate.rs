//! Residuals of data that were not fitted.

use hardpoint::model::Measurements;
use hardpoint::run::Analysis;

use super::certainty::Directions;
use super::fit::{FitWorkspace, SearchResult};
use super::parameter::FittedParameter;
use super::posture::{UnreachedPosture, read_outputs, solve_posture};
use hardpoint_search::dot;

/// Residuals of validation data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Validation {
    /// Each reading with its prediction; `None` if its posture is not reached.
    pub readings: Vec<Option<ValidatedReading>>,
    /// Postures that the fitted design does not reach.
    pub not_reached: Vec<UnreachedPosture>,
}

/// Reading that was not fitted, with the value of the fitted design, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValidatedReading {
    /// Value of the fitted design, with the fitted offset.
    pub value: f64,
    /// Predicted standard deviation of the difference: `sqrt(s^2 + g' C g)` with the standard deviation s of the
    /// reading, the derivatives g of its value and the covariance C of the parameters. `None` if the value depends on
    /// changes that the fit does not determine, or the fit has no covariance.
    pub sigma: Option<f64>,
}

impl FitWorkspace<'_> {
    /// Compares the fitted design with further readings. Readings without a standard deviation have that of the fit.
    pub(super) fn validate(
        &self,
        data: &Measurements,
        analyses: &[Analysis<'_>],
        search: &SearchResult,
        directions: &Directions,
    ) -> Validation {
        let design = self.design(&search.x);
        let mut found = Validation::default();
        let mut reached = Vec::new();
        let outputs = read_outputs(self.model, data);
        for (posture, analysis) in analyses.iter().enumerate() {
            let solved = solve_posture(analysis, &design, &outputs, &mut self.cost.borrow_mut());
            if let Err(stop) = &solved {
                found.not_reached.push(UnreachedPosture::of(posture, stop, analysis.model()));
            }
            reached.push(solved.ok());
        }
        for reading in &data.readings {
            let compared = reached[reading.posture].as_ref().and_then(|posture| {
                let value = posture.value(reading.output) + self.offset_of(reading.output, &search.x);
                let by = |(p, step): (&FittedParameter, &f64)| self.d(posture, reading.output, *p) * step;
                let g: Vec<f64> = self.parameters.iter().zip(&self.steps).map(by).collect();
                // g' C g = sum (g . v s)^2
                let of_fit: f64 = directions.reported.iter().map(|(v, s)| (dot(&g, v) * s).powi(2)).sum();
                let own = reading.sigma.unwrap_or(if self.has_sigmas { 0.0 } else { search.scale });
                let sigma = (own * own + of_fit).sqrt();
                let is_known = search.status.has_covariance() && directions.determine(&g);
                let compared = ValidatedReading { value, sigma: is_known.then_some(sigma) };
                (value.is_finite() && sigma.is_finite()).then_some(compared)
            });
            found.readings.push(compared);
        }
        found
    }
}
