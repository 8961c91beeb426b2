//! Rigid mechanism alongside the elastic one: the same drivers and cases, with all elastic joints closed.

use hardpoint::model::{MeasureKind, Metric, Model, OutputSource};
use hardpoint::{Analysis, Run, Solution};

use crate::diagnose;
use crate::page::{BodyTrack, Design, DesignKind, Value};
use crate::summary::StopFact;

use super::designs::ChangedDesign;
use super::{Compose, Request, Span};

/// Name of the rigid mechanism on the page.
const NAME: &str = "rigid";

/// Solution of the rigid mechanism at the stored output times, or a sentence on why there is none; `None` for a model
/// without equilibrium.
pub(super) fn solve(request: &Request<'_>) -> Option<Result<Solution, String>> {
    let (model, times) = (&request.file.model, &request.course.kept.motion.times);
    let equilibrium = model.equilibrium.as_ref()?;
    let missing = |why: &str| Err(format!("The rigid mechanism is not shown: {why}."));
    if !equilibrium.released.is_empty() {
        let released = equilibrium.released.iter().map(|d| format!("`{}`", model.drivers[d.0].name));
        let names = released.collect::<Vec<_>>().join(", ");
        return Some(missing(&format!("{names} follows from springs and loads, not from a law")));
    }
    let rigid = Model { equilibrium: None, times: times.clone(), ..model.clone() };
    let solved = match Analysis::with(&rigid, request.analysis.topology().formulation) {
        Ok(analysis) => analysis.solve(Run::new().without_sensitivities()),
        Err(fault) => return Some(missing(&diagnose::topology_fault(request.file, &fault).message)),
    };
    let stop = StopFact::of(request.file, &solved).filter(|_| solved.motion.is_empty());
    Some(stop.map_or(Ok(solved), |stop| missing(&stop.message)))
}

/// True if an output is a function of positions, which a rigid mechanism has as well. Its loads include no stiffness of
/// joints, and it has no compliance.
pub(super) fn is_kinematic(model: &Model, output: OutputSource) -> bool {
    let OutputSource::Measure(k) = output else { return true };
    let kind: &MeasureKind = &model.measures[k].kind;
    let is_load = kind.is_load() || matches!(kind, MeasureKind::Compliance { .. });
    !is_load && kind.sources().into_iter().all(|source| is_kinematic(model, source))
}

impl Compose<'_> {
    /// Rigid mechanism as a design to be compared with.
    pub(super) fn rigid(&self, solved: &Solution, bodies: &[BodyTrack], values: &[Value]) -> Design {
        let rigid = ChangedDesign {
            name: NAME.into(),
            note: "The mechanism with rigid joints, over the same motion of the drivers.".into(),
            change: &[],
            today: self.solution,
            exact: solved,
            prediction: None,
        };
        let mut design = self.unloaded(&rigid, bodies, values);
        let outputs = &self.solution.measured.outputs;
        for (output, curves) in outputs.iter().zip(&mut design.quantities) {
            curves.take_if(|_| !is_kinematic(self.model, output.source));
        }
        let moves = self.moves();
        let metric = |metric: &Metric| moves && is_kinematic(self.model, metric.of);
        let of_measure = |value: &Value| {
            let source = value.quantity.and_then(|q| outputs.get(q)).map(|o| o.source);
            source.is_some_and(|source| is_kinematic(self.model, source))
        };
        for (k, (of, value)) in values.iter().zip(&mut design.values).enumerate() {
            value.take_if(|_| !self.model.metrics.get(k).map_or_else(|| of_measure(of), metric));
        }
        Design { kind: DesignKind::Rigid, change: vec![0.0; self.model.variables.len()], ..design }
    }

    /// True if any driver moves.
    fn moves(&self) -> bool {
        let times = &self.solution.motion.times;
        let range = |law: &hardpoint::law::Law| Span::of(times.iter().map(|t| law.at(*t).value())).range();
        self.model.drivers.iter().any(|driver| range(&driver.law) > 0.0)
    }
}
