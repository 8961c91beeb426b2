//! Quantities and variables that the page shows first.

use hardpoint::model::{OutputSource, VariableId};

use crate::course::Course;

use super::{Compose, Span};

/// Rank of a quantity on the page; the highest is shown first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Rank {
    /// True if the design affects the shape of its curve. A curve that only follows a driver, or is shifted as a whole,
    /// is of little interest.
    follows_design: bool,
    /// True if a metric uses it, which shows the author's interest.
    in_metric: bool,
    /// True if it is a measure, not a coordinate of a point.
    is_measure: bool,
}

impl Compose<'_> {
    /// Quantity that the page shows first: the one of highest [`Rank`] among those that vary and are defined over time
    /// (slopes and similar measures are over one driver alone). Among equals it is the first, since authors list
    /// important ones first. `None` if nothing varies.
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
