//! Rigid mechanism: a model with equilibrium, solved with all its elastic joints closed over the same drivers.

use hardpoint::model::{Metric, Model, OutputSource};
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run, Solution};
use hardpoint_file::ModelFile;

use crate::diagnose;
use crate::summary::StopFact;

/// Solution of the rigid mechanism at these output times, or a sentence on why there is none; `None` for a model
/// without equilibrium, or without output times: that of a motion of which nothing was solved.
pub(crate) fn solve(
    file: &ModelFile,
    formulation: Formulation,
    times: &[f64],
) -> Option<Result<Solution, String>> {
    solve_at(file, &[], formulation, times)
}

/// Solution of the rigid mechanism of a design with variable k at `design[k]`; see [`values`] for its numbers.
pub fn solve_at(
    file: &ModelFile,
    design: &[f64],
    formulation: Formulation,
    times: &[f64],
) -> Option<Result<Solution, String>> {
    let model = &file.model;
    let equilibrium = model.equilibrium.as_ref().filter(|_| !times.is_empty())?;
    let missing = |why: &str| Err(format!("The rigid mechanism is not shown: {why}."));
    if !equilibrium.released.is_empty() {
        let released = equilibrium.released.iter().map(|d| format!("`{}`", model.drivers[d.0].name));
        let names = released.collect::<Vec<_>>().join(", ");
        return Some(missing(&format!("{names} follows from springs and loads, not from a law")));
    }
    let rigid = rigid(model, times);
    let solved = match Analysis::with(&rigid, formulation) {
        Ok(analysis) => analysis.solve(Run::new().at(design).without_sensitivities()),
        Err(fault) => return Some(missing(&diagnose::topology_fault(file, &fault).message)),
    };
    let stop = StopFact::of(file, &solved).filter(|_| solved.motion.is_empty());
    Some(stop.map_or(Ok(solved), |stop| missing(&stop.message)))
}

fn rigid(model: &Model, times: &[f64]) -> Model {
    Model { equilibrium: None, times: times.to_vec(), ..model.clone() }
}

/// Values of all outputs of the rigid mechanism at time k, SI; NaN for loads and compliances, which it does not have.
pub fn values<'s>(model: &'s Model, solved: &'s Solution, k: usize) -> impl Iterator<Item = f64> + 's {
    let outputs = solved.measured.outputs.iter().enumerate();
    outputs.map(move |(m, output)| match is_kinematic(model, output.source) {
        true => solved.measured.value(k, m)[0],
        false => f64::NAN,
    })
}

/// Values of the metrics of the rigid mechanism, SI; `None` where there is none.
pub(crate) fn metrics(model: &Model, solved: Option<&Solution>) -> Vec<Option<f64>> {
    let Some(solved) = solved else { return vec![None; model.metrics.len()] };
    let values = hardpoint::run::metrics(&rigid(model, &solved.motion.times), solved);
    let known = |(metric, found): (&Metric, hardpoint::run::MetricValue)| {
        found.value.filter(|_| has_metric(model, metric))
    };
    model.metrics.iter().zip(values).map(known).collect()
}

/// True if a metric has a meaning for the rigid mechanism: where no driver moves, nothing changes.
pub(crate) fn has_metric(model: &Model, metric: &Metric) -> bool {
    let outputs = std::iter::once(metric.of).chain(metric.over);
    let moves = model.drivers.iter().any(|driver| model.changes(&driver.law));
    moves && outputs.into_iter().all(|output| is_kinematic(model, output))
}

/// True if an output is a function of positions, which a rigid mechanism has as well. Its loads include no stiffness of
/// joints, and it has no compliance.
pub(crate) fn is_kinematic(model: &Model, output: OutputSource) -> bool {
    let OutputSource::Measure(k) = output else { return true };
    let kind = &model.measures[k].kind;
    !kind.is_load()
        && !kind.is_compliance()
        && kind.sources().into_iter().all(|source| is_kinematic(model, source))
}
