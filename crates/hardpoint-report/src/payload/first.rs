//! Quantities and variables that the page shows first.

use hardpoint::model::{OutputSource, VariableId};

use crate::course::Course;

use super::{Compose, Span};

/// Rank of a quantity on the page; the highest is shown first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Rank {
    /// True if the design bends its curve: what only follows a driver, or is shifted as a whole, says little about the
    /// design.
    follows_design: bool,
    /// True if a metric sums it up: then its author asks for it.
    in_metric: bool,
    /// True if it is a measure, rather than a point's coordinate.
    is_measure: bool,
}

impl Compose<'_> {
    /// The quantity that the page opens on: the one of greatest [`Rank`] among those that vary and follow the course of
    /// time (slopes and the like follow one driver alone); of equals the first, for authors begin with what they care
    /// for. None where nothing varies.
    pub(super) fn first(&self, course: &Course) -> Option<usize> {
        let measured = &self.solution.measured;
        let over_time = |value: &dyn Fn(usize) -> f64| Span::of(self.steps.iter().map(|&k| value(k))).range();
        let rank = |m: usize| {
            let output = &measured.outputs[m];
            let range = over_time(&|k| measured.value(k, m)[0]);
            let by_driver =
                matches!(output.source, OutputSource::Measure(k) if self.model.depends_on_driver(k));
            if by_driver || !(range > self.round_off.value(output.dimension, 0)) {
                return None;
            }
            let bends = |b: usize| {
                let bent = || over_time(&|k| measured.d(k, VariableId(b), m)[0]);
                course.follows(b) && bent() > self.round_off.of(b, output.dimension, 0)
            };
            Some(Rank {
                follows_design: (0..self.model.variables.len()).any(bends),
                in_metric: self.model.metrics.iter().any(|metric| metric.of == output.source),
                is_measure: matches!(output.source, OutputSource::Measure(_)),
            })
        };
        let ranked = (0..measured.outputs.len()).filter_map(|m| Some((m, rank(m)?)));
        let best = ranked.reduce(|best, next| if next.1 > best.1 { next } else { best });
        best.map(|(m, _)| m)
    }
}
