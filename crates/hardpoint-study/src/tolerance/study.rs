//! Tolerance study of a design.

use std::ops::ControlFlow;

use hardpoint::model::{Model, VariableId};

use super::allocation::allocate;
use super::data::{StudyData, deviations};
use super::monte_carlo::SampledQuantities;
use super::request::Request;
use super::result::{Error, ToleranceResult};
use super::spread::MetricSpread;
use crate::evaluation::{Motions, StudyCost};
use crate::progress::{Control, Progress};

/// Studies the tolerances of a design in some motions of the mechanism, given by their numbers in [`Model::motions`].
///
/// # Errors
/// A [`Error`] if there is nothing to study.
pub fn tolerance(
    model: &Model,
    motions: &Motions<'_>,
    numbers: &[usize],
    request: &Request,
    control: Control<'_>,
) -> Result<ToleranceResult, Error> {
    let Request { settings } = request;
    let Control { threads, progress, more } = control;
    let mut cost = StudyCost::default();
    let nominal = motions.evaluate(&[], &mut cost, more).map_err(Error::Nominal)?;
    let (deviations, left_out) = deviations(model, &nominal, settings);
    if deviations.variables.is_empty() {
        return Err(Error::Request(Request::nothing_varies(settings)));
    }
    let study = StudyData { model, motions, numbers, settings, deviations: &deviations, nominal: &nominal };
    let mut interrupted = false;
    let mut tell = |progressed: Progress<'_>| {
        let flow = progress(progressed);
        interrupted |= flow.is_break();
        flow
    };
    let mut found = from_derivatives(&study, left_out, cost, &mut tell, more);
    if settings.samples > 0 {
        let sampled = study.sample(&deviations, sampled_of(&found), threads, &mut tell, more);
        found.cost += sampled.cost;
        // Without samples there are no statistics.
        if sampled.samples > 0 {
            sampled.limits.iter().zip(&mut found.limits).for_each(|(y, limit)| limit.sampled = Some(*y));
            found.sampled = Some(sampled);
        }
    }
    if let Some(rule) = settings.allocation {
        let mut allocation = allocate(&study, rule, &found.metrics, &found.limits);
        if let Some(tolerances) = allocation
            .reaches_of(settings.tolerances.iter().map(|t| t.reach))
            .filter(|_| study.settings.samples > 0)
        {
            let loose = deviations.with_reaches(study.settings, &tolerances);
            let sampled = study.sample(&loose, sampled_of(&found), threads, &mut tell, more);
            found.cost += sampled.cost;
            allocation.sampled = Some(sampled).filter(|s| s.samples > 0);
        }
        found.allocation = Some(allocation);
    }
    found.add_contributions(model, settings);
    found.interrupted = interrupted || !more();
    Ok(found)
}

/// Result without sampled designs and allocation; `cost` is that of the nominal design.
fn from_derivatives(
    study: &StudyData<'_>,
    left_out: Vec<VariableId>,
    mut cost: StudyCost,
    tell: &mut dyn FnMut(Progress<'_>) -> ControlFlow<()>,
    more: &(dyn Fn() -> bool + Sync),
) -> ToleranceResult {
    let (studied, unknown) = study.studied();
    let hessians = study.hessians(&studied, &mut cost, tell, more);
    let metrics: Vec<MetricSpread> = studied
        .iter()
        .zip(hessians)
        .map(|(one, hessian)| study.spread(one, hessian.as_deref(), &mut cost))
        .collect();
    let (curves, side_changes) = study.curves(more);
    let limits = study.limits(&metrics);
    ToleranceResult {
        variables: study.deviations.variables.clone(),
        left_out,
        metrics,
        contributions: Vec::new(),
        unknown,
        curves,
        side_changes,
        limits,
        sampled: None,
        allocation: None,
        cost,
        interrupted: false,
    }
}

/// Quantities of a result that designs are sampled for.
fn sampled_of(found: &ToleranceResult) -> SampledQuantities<'_> {
    SampledQuantities { metrics: &found.metrics, curves: &found.curves, limits: &found.limits }
}
