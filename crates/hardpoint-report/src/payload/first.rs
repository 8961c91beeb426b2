//! What the page opens on.

use hardpoint::model::{OutputSource, VariableId};

use crate::course::Course;

use super::{Compose, Span};

/// A usual change of a variable that says none itself, as a part of its natural step: 1 mm in a mechanism of 1 m.
const USUAL: f64 = 1e-3;

/// How much a quantity deserves to be looked at first: the greatest does.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Rank {
    /// Whether the design changes it: what only follows a driver says nothing about the design.
    follows_design: bool,
    /// Whether a metric sums it up: then its author asks for it.
    in_metric: bool,
    /// Whether it is a measure, rather than a point's coordinate.
    is_measure: bool,
    /// How much its curve is bent by a usual change of the variable that bends it most, as a part of the way that it goes through. A
    /// curve that is shifted as a whole is not bent.
    effect: f64,
}

impl Compose<'_> {
    /// The quantity that the page opens on: the one of greatest [`Rank`] among those that vary and follow the course of time (slopes
    /// and the like follow one driver alone); of equals the first. None where nothing varies.
    pub(super) fn first(&self, course: &Course) -> Option<usize> {
        let measured = &self.solution.measured;
        let over_time = |value: &dyn Fn(usize) -> f64| Span::of(self.steps.iter().map(|&k| value(k))).range();
        let rank = |m: usize| {
            let output = &measured.outputs[m];
            let range = over_time(&|k| measured.value(k, m)[0]);
            let by_driver = matches!(output.source, OutputSource::Measure(k) if self.model.goes_by_driver(k));
            if by_driver || !(range > self.round_off.value(output.dimension, 0)) {
                return None;
            }
            let change = |b: usize| {
                let usual = self.model.variables[b].typical;
                let usual = usual.unwrap_or_else(|| USUAL * self.model.natural_step(VariableId(b)));
                let least = self.round_off.of(b, output.dimension, 0);
                let bent = over_time(&|k| measured.d(k, VariableId(b), m)[0]);
                if bent <= least { 0.0 } else { bent * usual / range }
            };
            let followed = (0..self.model.variables.len()).filter(|b| course.follows(*b));
            let effect = followed.map(change).fold(0.0, f64::max);
            Some(Rank {
                follows_design: effect > 0.0,
                in_metric: self.model.metrics.iter().any(|metric| metric.of == output.source),
                is_measure: matches!(output.source, OutputSource::Measure(_)),
                effect,
            })
        };
        let ranked = (0..measured.outputs.len()).filter_map(|m| Some((m, rank(m)?)));
        let best = ranked.reduce(|best, next| if next.1 > best.1 { next } else { best });
        best.map(|(m, _)| m)
    }
}
