//! Measures that need more of a step than where the bodies are: their values, as the walk through the motion finds
//! them.

use std::ops::Range;

use hardpoint_tape::{LANES, Lanes, Number};

use crate::blocks::{AlignedLanes, Blocks};
use crate::model::Model;
use crate::order::sort_by_index;

/// A measure that was recorded with a step.
pub(crate) struct RecordedValue {
    /// Index of the measure.
    pub measure: usize,
    /// Condition: if it is positive, the measure is not determined.
    pub excess: Number,
    /// Value, then derivatives variable by variable.
    pub numbers: Vec<Number>,
}

/// Measures that were recorded with a step.
#[derive(Default)]
pub(crate) struct RecordedValues(pub Vec<RecordedValue>);

impl RecordedValues {
    /// With further ones.
    pub fn and(mut self, more: Self) -> Self {
        self.0.extend(more.0);
        self
    }

    /// All numbers in the order of [`StepValues::take_recorded`]: the excess of each measure, values, then derivatives
    /// variable by variable.
    pub fn numbers(mut self) -> Vec<Number> {
        sort_by_index(&mut self.0, |found| found.measure);
        let excess = self.0.iter().map(|found| found.excess);
        let numbers = self.0.first().map_or(0, |found| found.numbers.len());
        let found = (0..numbers).flat_map(|n| self.0.iter().map(move |found| found.numbers[n]));
        excess.chain(found).collect()
    }
}

/// Values of the measures that need more of a step than where the bodies are, over a motion, and their derivatives by
/// the design variables; eight output times side by side.
#[derive(Clone, Debug, Default)]
pub(crate) struct StepValues {
    /// Indices of these measures, ascending; empty if there are none.
    measures: Vec<usize>,
    /// Per measure of the model: which of these it is.
    places: Vec<Option<usize>>,
    /// Derivatives by that many.
    variables: usize,
    /// Output times that were begun.
    steps: usize,
    /// Per output time the values, then variable by variable the derivatives.
    numbers: Blocks,
}

impl StepValues {
    /// Those of a model, with derivatives by that many variables, and memory for that many output times.
    pub fn new(model: &Model, variables: usize, steps: usize) -> Self {
        let count = model.measures.len();
        let measures: Vec<usize> = (0..count).filter(|m| model.depends_on_step(*m)).collect();
        let mut places = vec![None; count];
        measures.iter().enumerate().for_each(|(n, m)| places[*m] = Some(n));
        let mut numbers = Blocks::default();
        numbers.shape(measures.len() * (1 + variables), steps);
        Self { measures, places, variables, steps: 0, numbers }
    }

    /// The measures, ascending.
    pub fn measures(&self) -> &[usize] {
        &self.measures
    }

    /// Clears the values and keeps the memory.
    pub fn restart(&mut self) {
        self.steps = 0;
    }

    /// One more output time, of which nothing is known yet.
    pub fn begin(&mut self) {
        let unknown = std::iter::repeat_n(f64::NAN, self.measures.len() * (1 + self.variables));
        self.numbers.set(self.steps, 0, unknown);
        self.steps += 1;
    }

    /// The value of a measure at that time.
    pub fn set(&mut self, measure: usize, x: f64) {
        if let Some(n) = self.places[measure] {
            self.numbers.set(self.steps - 1, n, [x]);
        }
    }

    /// Derivative by a variable.
    pub fn set_d(&mut self, variable: usize, measure: usize, x: f64) {
        if let Some(n) = self.places[measure] {
            self.numbers.set(self.steps - 1, (1 + variable) * self.measures.len() + n, [x]);
        }
    }

    /// Adds several output times at once, from these lanes of the results ([`RecordedValues::numbers`]).
    pub fn take_recorded(&mut self, found: &[AlignedLanes], lanes: Range<usize>) {
        let (excess, found) = found.split_at(self.measures.len());
        let to = self.numbers.block_mut(self.steps);
        // NaN is not known.
        let all_known = excess.iter().all(|excess| excess.0.iter().fold(true, |all, x| all & (*x <= 0.0)));
        if all_known && lanes.len() == LANES {
            to.copy_from_slice(bytemuck::cast_slice(found));
        } else {
            for (to, found) in to.chunks_exact_mut(excess.len()).zip(found.chunks_exact(excess.len())) {
                for ((to, found), excess) in to.iter_mut().zip(found).zip(excess) {
                    for lane in lanes.clone() {
                        to[lane] = if excess.0[lane] <= 0.0 { found.0[lane] } else { f64::NAN };
                    }
                }
            }
        }
        self.steps += lanes.len();
    }

    /// Values of all measures of the model at time k, NaN for those that are none of these; empty if there are none at
    /// all.
    pub fn at(&self, k: usize) -> impl Iterator<Item = f64> {
        self.all_from(k, 0)
    }

    /// Likewise their derivatives by variable b.
    pub fn d(&self, k: usize, b: usize) -> impl Iterator<Item = f64> {
        self.all_from(k, (1 + b) * self.measures.len())
    }

    fn all_from(&self, k: usize, first: usize) -> impl Iterator<Item = f64> {
        let row = (k < self.steps && !self.measures.is_empty()).then(|| self.numbers.row(k));
        let of = move |place: &Option<usize>| row.zip(*place).map_or(f64::NAN, |(row, n)| row.get(first + n));
        self.places.iter().map(of)
    }

    /// The values of the measures in the block of eight output times that begins with k, and after these their
    /// derivatives, variable by variable; `None` where there are none.
    pub fn block(&self, k: usize) -> Option<&[Lanes]> {
        (k < self.steps && !self.measures.is_empty()).then(|| self.numbers.block(k))
    }
}
