//! The motion between output times, as needed by metrics.
//!
//! A metric is a property of the curve, not of its output times. If these are too few to resolve the curve, the motion
//! is solved again at more times, so close that no driver moves far between two of them and that each law is a
//! polynomial there. Then times are added at which metrics are evaluated, or in the middle of intervals in which an
//! integral is inaccurate: these are solved from the positions on both sides, and inserted. At a solved time a value is
//! exact, and so is its derivative: the time of an extremum depends on the design, but this does not change its value,
//! `dm/db = dy/db` at `t*`.

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::law::Law;
use crate::linalg::{hermite, segment_at};
use crate::model::{CurvePart, Metric, Model, OutputSource};
use crate::motion::StopKind;
use crate::motion::mechanism::driver_units;

use super::analysis::Analysis;
use super::curve::JUST_BEFORE;
use super::metric::{is_among, unresolved_corners, unresolved_extrema, unresolved_times, window_times};
use super::needed::{MetricUse, NeededResults};
use super::request::{Progress, Scope};
use super::solution::Solution;
use super::walk::PreparedDesign;
use super::window::Footprint;

/// Maximum travel of a driver between two times, rad or sizes of its loop: the error of a polynomial of degree five for
/// a sine is then `0.15^6 / 46080 = 2e-10`.
const FINE: f64 = 0.15;
/// Number of parts, at least, into which the range of the law of a load is divided between two times: a mechanism may
/// follow a load in either direction, but not faster than this shows.
const PARTS_OF_LOADS: f64 = 32.0;
/// Maximum difference between a law and its polynomial of degree five, as a fraction of the range of the law.
const LAW_RESOLVED: f64 = 1e-8;
/// Number of parts of an interval, at whose ends this difference is evaluated.
const PLACES: [f64; 3] = [0.25, 0.5, 0.75];
/// Maximum number of bisections of an interval.
const MOST_HALVINGS: u32 = 40;
/// Maximum number of passes; each adds times nearer to those of the metrics ...
const MOST_PASSES: usize = 4;
/// ... and of passes that locate kinks, and sharp extrema without rates.
const MOST_FOR_EXTREMA: usize = 8;
/// Minimum number of times of a motion per added time for which the latter are solved by themselves: all times together
/// are solved eight at once.
const FEWEST_PER_ADDED: usize = 4;
/// Memory for the motion between output times.
const BYTES: usize = 128 << 20;

/// Returns true if a metric may depend on the curve between the output times.
fn is_between_outputs(metric: &Metric, times: &[f64]) -> bool {
    match metric.take.part() {
        CurvePart::Extrema(_) | CurvePart::Path(_) => true,
        CurvePart::Ends => false,
        CurvePart::Place { .. } | CurvePart::Points(_) => {
            metric.over.is_some() || !window_times(metric).iter().all(|t| times.contains(t))
        }
    }
}

/// Returns true if a metric is taken at a time of its own whatever the output times resolve: a distance of shapes may
/// change its features between them, and its least value is a promise.
fn is_exact(model: &Model, metric: &Metric) -> bool {
    model.type_of(metric.of) == "clearance"
}

/// Drops the times to be added that are outside the motion, or those of others within round-off: several metrics may
/// ask for the same time.
fn keep_apart(add: &mut Vec<f64>, times: &[f64]) {
    let [start, end] = [times[0], times[times.len() - 1]];
    add.retain(|t| start < *t && *t < end);
    let is_same = |a: f64, b: f64| (a - b).abs() <= 0.1 * JUST_BEFORE * (end - start);
    add.sort_by(f64::total_cmp);
    add.dedup_by(|b, a| is_same(*a, *b));
    add.retain(|t| {
        let after = times.partition_point(|time| time < t);
        !times[after.saturating_sub(1)..usize::min(after + 1, times.len())]
            .iter()
            .any(|time| is_same(*time, *t))
    });
}

impl Analysis<'_> {
    /// Returns true if metrics need more times than the output times.
    pub(super) fn has_times_between(&self) -> bool {
        self.times_between().len() > self.model().times.len()
    }

    /// Output times, and the times between them that metrics need for the laws of the nominal design.
    fn times_between(&self) -> &[f64] {
        self.between.get_or_init(|| {
            let model = self.model();
            if !model.metrics.iter().any(|m| is_between_outputs(m, &model.times)) {
                return model.times.clone();
            }
            self.times_within()
        })
    }

    /// Output times, and times between them that are so close that no driver moves far between two of them, and no load
    /// changes by a large part of its range.
    pub(super) fn times_within(&self) -> Vec<f64> {
        let model = self.model();
        let units = driver_units(model, self.topology());
        let of_drivers = model.drivers.iter().map(|d| &d.law).zip(units);
        let of_loads = model.elements.iter().filter_map(|element| element.kind.law(model));
        let of_loads = of_loads.filter_map(|law| {
            let (start, end) = (*model.times.first()?, *model.times.last()?);
            // FINE units are a part of the range of the law.
            let range = law.over(start, end).value.reach_from(law.at(start).value());
            (range > 0.0 && range.is_finite()).then_some((law, range / PARTS_OF_LOADS / FINE))
        });
        let laws: Vec<(&Law, f64)> = of_drivers.chain(of_loads).collect();
        let most = Footprint::of(model, true).rows(BYTES);
        (0..6)
            .map(|k| f64::from(1 << k))
            .find_map(|coarser| times_of(model, &laws, coarser, most))
            .unwrap_or_else(|| model.times.clone())
    }

    /// Solves the motion of a design between its output times, if metrics need it. `solution` has the results at all
    /// output times, or at the last ones only; then the whole motion is solved again.
    pub(super) fn solve_between(
        &self,
        design: &PreparedDesign,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
        solution: &mut Solution,
    ) {
        solution.between = None;
        solution.located.clear();
        let model = self.model();
        if !design.scope.measures
            || solution.stop.is_some()
            || !model.metrics.iter().any(|m| is_between_outputs(m, &model.times))
        {
            return;
        }
        let is_whole = solution.motion.len() == model.times.len();
        if !is_whole && model.times.len() > Footprint::of(model, true).rows(BYTES) {
            return;
        }
        // All output times have been reported as solved before.
        let mut go_on =
            |_: Progress| progress(Progress { done: model.times.len() - 1, total: model.times.len() });
        let mut found = None;
        let are_finer = self.times_between().len() > model.times.len();
        if are_finer || !is_whole {
            let of_metrics = model.metrics.iter().filter(|_| are_finer).flat_map(window_times);
            let times = self.times_between().iter().copied().chain(of_metrics).collect();
            // Which times are needed depends on values only; results at times that are inserted have derivatives at
            // once.
            let sensitivities = design.scope.sensitivities && self.records_channels(design);
            found = Some(self.solve_at(times, design, sensitivities, &mut go_on));
        }
        let mut located: Option<Vec<OutputSource>> = None;
        let mut passes = 0;
        loop {
            if let Some(stopped) = found.as_ref().filter(|found| found.stop.is_some()) {
                return self.end_where(stopped, design, &mut go_on, solution);
            }
            let now = found.as_ref().unwrap_or(solution);
            let mut add = Vec::new();
            if located.is_none() {
                let (measures, minima) = self.locate_minima(&design.values, now);
                add = minima;
                add.extend(self.hidden_extrema(&design.values, now));
                located = Some(measures);
            }
            // Minima have a pass of their own.
            passes += usize::from(add.is_empty());
            let is_located = |m: &&Metric| located.as_ref().is_some_and(|located| is_among(located, m));
            let metrics = model.metrics.iter().filter(|m| is_between_outputs(m, &model.times));
            for metric in metrics.filter(|m| !is_located(m)) {
                if passes < MOST_PASSES {
                    let finer = found.is_some() || is_exact(model, metric);
                    add.extend(unresolved_times(now, metric, finer));
                }
                add.extend(unresolved_extrema(now, metric));
                add.extend(unresolved_corners(now, metric));
            }
            keep_apart(&mut add, &now.motion.times);
            if add.is_empty() || passes == MOST_FOR_EXTREMA {
                break;
            }
            found = Some(match self.solve_added(now, &add, design, &mut go_on) {
                Some(added) => {
                    let mut all = found.take().unwrap_or_else(|| solution.clone());
                    all.insert(&added);
                    all
                }
                None => self.solve_at([&now.motion.times, &add[..]].concat(), design, false, &mut go_on),
            });
        }
        solution.located = located.unwrap_or_default();
        if !design.fields.is_empty()
            && let Some(values) = found.as_ref().filter(|found| found.sensitivities.variables == 0)
        {
            let all = self.solve_at(values.motion.times.clone(), design, true, &mut go_on);
            if all.stop.is_some() {
                return self.end_where(&all, design, &mut go_on, solution);
            }
            found = Some(all);
        }
        let finer = found.map(|found| self.with_unlocated_times(found, &solution.located));
        solution.between = finer.map(Arc::new);
    }

    /// Solves the motion of a design at all these times from its start on.
    fn solve_at(
        &self,
        mut times: Vec<f64>,
        design: &PreparedDesign,
        sensitivities: bool,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Solution {
        let [start, end] = [self.model().times[0], self.model().times[self.model().times.len() - 1]];
        times.retain(|t| start <= *t && *t <= end);
        times.sort_by(f64::total_cmp);
        times.dedup();
        let finer = self.at_times(times);
        let design = finer.prepare(&design.values, Scope { sensitivities, ..design.scope });
        let mut found = Solution::default();
        finer.walk(&design, finer.model().times.len(), progress, &mut found, &mut |_, _| ());
        found
    }

    /// Solves the motion of a design at times between those of a solution, from the positions on both sides. `None` if
    /// these do not determine it, or if there are more of them than are solved faster by themselves.
    fn solve_added(
        &self,
        known: &Solution,
        add: &[f64],
        design: &PreparedDesign,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Option<Solution> {
        if known.motion.channels.is_none() || FEWEST_PER_ADDED * add.len() > known.motion.len() {
            return None;
        }
        // The branch is that of the first time.
        let finer = self.at_times(known.motion.times[..1].iter().chain(add).copied().collect());
        let sensitivities = known.sensitivities.variables > 0;
        let design = finer.prepare(&design.values, Scope { sensitivities, ..design.scope });
        let (rows, mut found) = (finer.model().times.len(), Solution::default());
        finer.walk_between(Some(&known.motion), &design, rows, progress, &mut found, &mut |_, _| ());
        found.stop.is_none().then_some(found)
    }

    /// Records which times of the motion at more times depend on the laws of the nominal design alone.
    fn with_unlocated_times(&self, finer: Solution, located: &[OutputSource]) -> Solution {
        Solution { unlocated: self.times_between().to_vec(), located: located.to_vec(), ..finer }
    }

    /// Ends a solution where the same motion at finer times ends: these follow it more closely.
    fn end_where(
        &self,
        finer: &Solution,
        design: &PreparedDesign,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
        solution: &mut Solution,
    ) {
        let is_interrupted = finer.stop.as_ref().is_some_and(|stop| stop.kind == StopKind::Interrupted);
        let last = finer.motion.times.last();
        let times: Vec<f64> =
            self.model().times.iter().copied().filter(|t| last.is_some_and(|last| t <= last)).collect();
        if is_interrupted || times.is_empty() {
            return;
        }
        // The last of several windows is complete as it is.
        if solution.motion.len() == self.model().times.len() {
            *solution = self.solve_at(times, design, design.scope.sensitivities, progress);
        }
        solution.stop.clone_from(&finer.stop);
    }

    /// Solves a prepared design for its metrics: values at all output times, and the derivatives that the metrics
    /// depend on.
    pub(super) fn solve_for_metrics(
        &self,
        design: PreparedDesign,
        uses: &[MetricUse],
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
        solution: &mut Solution,
    ) {
        let model = self.model();
        if let Some(needs) = NeededResults::of_times(model, uses) {
            let design = PreparedDesign { needs: Some(Arc::new(needs)), ..design };
            self.walk(&design, model.times.len(), progress, solution, &mut |_, _| ());
            return;
        }
        let needs = Some(Arc::new(NeededResults::of_values(model, uses)));
        let scope = Scope { sensitivities: false, ..design.scope };
        let values = PreparedDesign { needs, ..self.prepare(&design.values, scope) };
        self.walk(&values, model.times.len(), progress, solution, &mut |_, _| ());
        self.solve_between(&values, progress, solution);
        if solution.stop.is_some() {
            return;
        }
        // All output times have been reported as solved before.
        let end = Progress { done: model.times.len() - 1, total: model.times.len() };
        let mut go_on = |_: Progress| progress(end);
        let needs = NeededResults::of_solution(model, uses, solution);
        if needs.is_of_values() {
            return;
        }
        let needs = Some(Arc::new(needs));
        match &solution.between {
            None => {
                let design = PreparedDesign { needs, ..design };
                self.walk(&design, model.times.len(), &mut go_on, solution, &mut |_, _| ());
            }
            Some(between) => {
                let finer = self.at_times(between.motion.times.clone());
                let design = PreparedDesign { needs, ..finer.prepare(&design.values, design.scope) };
                let mut found = Solution::default();
                finer.walk(&design, between.motion.len(), &mut go_on, &mut found, &mut |_, _| ());
                solution.stop = found.stop.clone();
                let finer = self.with_unlocated_times(found, &solution.located);
                solution.between = Some(Arc::new(finer));
            }
        }
    }
}

/// Returns the output times of a model, and the times between them that its laws need. Steps are `coarser` times the
/// usual length. Returns `None` if there are more than `most` times.
fn times_of(model: &Model, laws: &[(&Law, f64)], coarser: f64, most: usize) -> Option<Vec<f64>> {
    let (start, end) = (*model.times.first()?, *model.times.last()?);
    let ranges: Vec<f64> = laws
        .iter()
        .map(|(law, unit)| law.over(start, end).value.reach_from(law.at(start).value()) / unit)
        .collect();
    let mut ends = model.times.clone();
    for (law, _) in laws {
        let jumps = law.jumps(start, end);
        // Rates differ before and after a jump.
        let sharp = jumps.iter().filter(|jump| jump.time > start);
        ends.extend(sharp.flat_map(|jump| [jump.time - JUST_BEFORE * (end - start), jump.time]));
    }
    ends.retain(|t| start <= *t && *t <= end);
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let mut times = vec![start];
    for pair in ends.windows(2) {
        let mut stretches = vec![(pair[0], pair[1], 0)];
        while let Some((from, to, halvings)) = stretches.pop() {
            let middle = from + 0.5 * (to - from);
            let fine = laws.iter().zip(&ranges).all(|((law, unit), range)| {
                let travel = law.over(from, to).value.reach_from(law.at(from).value()) / unit;
                travel <= FINE * coarser && is_resolved(law, [from, to], LAW_RESOLVED * range * unit)
            });
            if fine || halvings == MOST_HALVINGS || to - from <= 2.0 * JUST_BEFORE * (end - start) {
                times.push(to);
            } else {
                stretches.extend([(middle, to, halvings + 1), (from, middle, halvings + 1)]);
            }
            if times.len() + stretches.len() > most {
                return None;
            }
        }
    }
    Some(times)
}

/// Returns true if the difference is at most `within` between a law and the polynomial of degree five that has its
/// values, rates and accelerations at both ends.
fn is_resolved(law: &Law, [from, to]: [f64; 2], within: f64) -> bool {
    let h = to - from;
    let [a, b] = [from, to].map(|t| law.at(t).derivatives());
    let polynomial = hermite(h, 2, |end, order| [a, b][end][order]);
    // Ignores round-off of the value.
    let within = within.max(8.0 * f64::EPSILON * a[0].abs().max(b[0].abs()));
    PLACES.iter().all(|s| {
        let [there, ..] = segment_at(&polynomial, s * h);
        // More times would not resolve a law whose value is NaN.
        !((law.at(from + s * h).value() - there).abs() > within)
    })
}
