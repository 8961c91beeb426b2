//! Facts of a whole run, gathered in windows of output times, so that the run need not fit into memory.

use hardpoint::model::{Dimension, Model, OutputSource, VariableId};
use hardpoint::motion::{Margin, Motion};
use hardpoint::sensitivity::Admissibility;
use hardpoint::{Footprint, SampledResults, Sampling, Solution};
use hardpoint_study::Magnitude;
use hardpoint_table::series;

use crate::shifts::Shifts;

/// Memory limit of the results that are stored for the page and for comparisons, in bytes.
const STORED_BYTES: usize = 64 << 20;
/// Minimum number of output times that must fit for sensitivities of bodies to be stored.
const ENOUGH_ROWS: usize = 512;
/// Memory limit of the curves that metrics use, in bytes.
const METRIC_BYTES: usize = 256 << 20;
/// Relative difference within which a value counts as the largest, so that the first of several equal periods is
/// reported, independent of round-off.
const AS_LARGE: f64 = 1e-9;
/// A value replaces the largest so far only if it exceeds it by this fraction.
const SAME: f64 = 1e-12;

/// Collector of the facts of a run.
#[derive(Clone, Debug)]
pub struct Gathering {
    course: Course,
    orders: Vec<(Dimension, usize)>,
    kept: SampledResults,
    /// Results for metrics, if those stored for the page are too coarse.
    curves: Option<SampledResults>,
    /// Motion of bodies by the variables, if sensitivities of bodies are not stored.
    shifts: Option<Shifts>,
}

/// Facts of a whole run.
#[derive(Clone, Debug, Default)]
pub struct Course {
    /// Number of solved output times.
    pub steps: usize,
    /// Last solved output time, s.
    pub last_time: Option<f64>,
    /// Margins to singular positions.
    pub margins: MarginCourse,
    /// Stored output times, with the facts of all.
    pub kept: Solution,
    /// Interval of stored output times.
    pub stride: usize,
    /// Curves of the metrics, if stored separately.
    curves: Option<Solution>,
    /// Motion of bodies by the variables, if it is stored separately.
    shifts: Option<Shifts>,
    /// Interval of the output times that metrics use.
    pub metric_stride: usize,
    /// Magnitude of the motion.
    magnitude: Magnitude,
    /// `peaks[(m * 3 + order) * variables + b]`: largest derivative of an order of measure m by variable b.
    peaks: Vec<Peak>,
    variables: usize,
}

/// Margins over all output times.
#[derive(Clone, Copy, Debug, Default)]
pub struct MarginCourse {
    /// Margin at the first output time, if any.
    pub start: Option<Margin>,
    /// Minimum margin and its time, s.
    pub least: Option<(Margin, f64)>,
    /// First and last output time, s.
    pub span: [f64; 2],
}

/// Time and value of the largest derivative.
#[derive(Clone, Debug, Default)]
struct Peak {
    /// Values close to the largest, with their times, in ascending order of the values.
    near: Vec<(f64, f64)>,
}

impl Gathering {
    /// Empty collection.
    pub fn new(model: &Model) -> Self {
        let footprint = Footprint::of(model, true);
        let rows = |bytes: usize| STORED_BYTES / bytes.max(1);
        let times = model.times.len();
        let all = rows(footprint.bytes());
        let bodies = all >= usize::min(times, ENOUGH_ROWS);
        let rows = if bodies { all } else { rows(footprint.bytes() - footprint.sensitivities) };
        let mut outputs: Vec<OutputSource> =
            model.metrics.iter().flat_map(|m| std::iter::once(m.of).chain(m.over)).collect();
        outputs.dedup();
        let curve = (outputs.len() * (1 + model.variables.len()) * size_of::<[f64; 3]>()).max(1);
        let keep =
            |rows, motion, outputs| Sampling { rows, motion, sensitivities: motion && bodies, outputs };
        let curves = (!outputs.is_empty() && times > rows)
            .then(|| SampledResults::new(keep(METRIC_BYTES / curve, false, Some(outputs))));
        let measures = hardpoint::measure::outputs(model);
        let measures = measures.iter().filter(|o| matches!(o.source, OutputSource::Measure(_)));
        let orders: Vec<_> = measures.map(|o| (o.dimension, o.known.orders)).collect();
        let variables = model.variables.len();
        let course = Course {
            magnitude: Magnitude::at_rest(model),
            peaks: vec![Peak::default(); orders.len() * 3 * variables],
            variables,
            ..Course::default()
        };
        let shifts = (!bodies && variables > 0).then(|| Shifts::new(STORED_BYTES));
        Self { course, orders, kept: SampledResults::new(keep(rows, true, None)), curves, shifts }
    }

    /// Adds a window that begins with output time `first`.
    pub fn add(&mut self, first: usize, window: &Solution) {
        let course = &mut self.course;
        course.steps += window.motion.len();
        course.last_time = window.motion.times.last().copied().or(course.last_time);
        course.margins.add(&window.motion);
        course.magnitude.add(&window.motion);
        if window.sensitivities.variables == self.course.variables {
            for (k, &t) in window.motion.times.iter().enumerate() {
                self.peaks_at(window, k, t);
            }
        }
        self.kept.add(first, window);
        if let Some(shifts) = self.shifts.as_mut().filter(|_| window.sensitivities.variables > 0) {
            shifts.add(first, window, self.kept.stride());
        }
        if let Some(curves) = &mut self.curves {
            curves.add(first, window);
        }
    }

    fn peaks_at(&mut self, window: &Solution, k: usize, t: f64) {
        let variables = self.course.variables;
        for (m, (_, orders)) in self.orders.iter().enumerate() {
            for b in 0..variables {
                let d = window.measured.d(k, VariableId(b), m);
                for (order, d) in d.into_iter().enumerate().take(*orders) {
                    self.course.peaks[(m * 3 + order) * variables + b].add(d, t);
                }
            }
        }
    }

    /// Completes the facts with those of the whole run.
    pub fn end(self, whole: &Solution) -> Course {
        let mut course = self.course;
        course.stride = self.kept.stride();
        course.metric_stride = self.curves.as_ref().map_or(course.stride, SampledResults::stride);
        course.curves = self.curves.map(|curves| curves.end(whole));
        course.kept = self.kept.end(whole);
        course.shifts = self.shifts;
        course
    }
}

impl Course {
    /// Facts of a complete solution.
    pub fn of(model: &Model, solution: &Solution) -> Self {
        let mut gathering = Gathering::new(model);
        gathering.add(0, solution);
        gathering.end(solution)
    }

    /// Results that metrics use.
    pub fn curves(&self) -> &Solution {
        self.curves.as_ref().unwrap_or(&self.kept)
    }

    /// Stride, among the stored output times, of the motion of bodies by the variables; `None` if it was not stored.
    pub(crate) fn shift_stride(&self) -> Option<usize> {
        if self.has_bodies() {
            return Some(1);
        }
        Some(self.shifts.as_ref()?.stride(self.steps)? / self.stride)
    }

    /// First-order translation and rotation of body i by variable b, which the mechanism can follow, at stored output
    /// times, SI.
    ///
    /// # Panics
    /// If they were not stored at these times ([`shift_stride`](Self::shift_stride)).
    pub(crate) fn shifts(&self, steps: &[usize], b: usize, i: usize) -> Vec<[f64; 6]> {
        match &self.shifts {
            Some(shifts) => steps.iter().map(|k| shifts.at(k * self.stride, b, i)).collect(),
            None => series::shifts(&self.kept, steps, VariableId(b), i),
        }
    }

    /// True if sensitivities of bodies are stored.
    pub fn has_bodies(&self) -> bool {
        let sensitivities = &self.kept.sensitivities;
        sensitivities.variables == 0 || sensitivities.bodies > 0
    }

    /// True if the mechanism can follow a variable over the solved motion.
    pub fn follows(&self, b: usize) -> bool {
        let answers = &self.kept.sensitivities.admissibility;
        self.steps > 0 && answers.get(b).is_some_and(|a| !matches!(a, Admissibility::CannotFollow { .. }))
    }

    /// Largest derivative of an order of measure m by variable b, with its sign, and its time.
    pub(crate) fn largest(&self, m: usize, order: usize, b: usize) -> Option<(f64, f64)> {
        self.peaks[(m * 3 + order) * self.variables + b].near.first().copied()
    }

    /// Thresholds of round-off for values and sensitivities.
    pub(crate) fn round_off(&self, model: &Model) -> RoundOff {
        RoundOff::new(model, self.magnitude)
    }
}

impl MarginCourse {
    /// Margins of a complete motion.
    pub fn of(motion: &Motion) -> Self {
        let mut course = Self::default();
        course.add(motion);
        course
    }

    fn add(&mut self, motion: &Motion) {
        for (&margin, &t) in motion.margins.iter().zip(&motion.times) {
            if self.start.is_none() {
                (self.start, self.span[0]) = (Some(margin), t);
            }
            // Of equal periods the first has the minimum, independent of round-off. NaN is the minimum.
            let stays = |least: f64| least.is_nan() || margin.value >= least * (1.0 - AS_LARGE);
            if !self.least.is_some_and(|(least, _)| stays(least.value)) {
                self.least = Some((margin, t));
            }
            self.span[1] = t;
        }
    }
}

impl Peak {
    fn add(&mut self, d: f64, t: f64) {
        // The first number counts, even if it is zero: without any, the derivative is not known.
        if self.near.last().map_or(!d.is_nan(), |(most, _)| d.abs() > most.abs() * (1.0 + SAME)) {
            self.near.push((d, t));
            self.near.retain(|(near, _)| near.abs() >= d.abs() * (1.0 - AS_LARGE));
        }
    }
}

/// Thresholds below which results are round-off and shown as 0.
pub(crate) struct RoundOff {
    magnitude: Magnitude,
    natural: Vec<f64>,
}

impl RoundOff {
    /// Thresholds for a motion of a magnitude.
    pub fn new(model: &Model, magnitude: Magnitude) -> Self {
        let natural = (0..model.variables.len()).map(|b| model.natural_step(VariableId(b))).collect();
        Self { magnitude, natural }
    }

    /// Threshold for the derivative of a quantity by variable b, SI.
    pub fn of(&self, b: usize, of: Dimension, order: usize) -> f64 {
        self.value(of, order) / self.natural[b]
    }

    /// Threshold for a quantity or its time derivative, and for the difference between two designs, SI.
    pub fn value(&self, of: Dimension, order: usize) -> f64 {
        self.magnitude.round_off(of, order)
    }
}
