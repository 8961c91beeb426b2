//! Range of every measure over the motion, in the model's units.

use hardpoint::Solution;
use hardpoint::model::OutputSource;
use hardpoint_file::Units;

use crate::course::Course;
use crate::figures::unit;
use crate::record::record;

record! {
    /// Range of a measure over the motion.
    RangeFact::of(units: Units, solution: &Solution, m: usize) {
        let output = &solution.measured.outputs[m];
        let times = &solution.motion.times;
        let shown = |k: usize| units.from_si(output.dimension, solution.measured.value(k, m)[0]);
        let known: Vec<(usize, f64)> =
            (0..times.len()).map(|k| (k, shown(k))).filter(|(_, x)| x.is_finite()).collect();
        let least = known.iter().min_by(|a, b| a.1.total_cmp(&b.1));
        let most = known.iter().max_by(|a, b| a.1.total_cmp(&b.1));
    }
    /// Name of the measure.
    measure: String = output.name.clone();
    /// Unit.
    unit: String = unit(units, output.dimension);
    /// Value at the first output time with a value; `null` if there is none.
    start: Option<f64> = known.first().map(|(_, x)| *x);
    /// Value at the last output time with a value.
    end: Option<f64> = known.last().map(|(_, x)| *x);
    /// Minimum.
    min: Option<f64> = least.map(|(_, x)| *x);
    /// Time of the minimum, s.
    min_time: Option<f64> = least.map(|(k, _)| times[*k]);
    /// Maximum.
    max: Option<f64> = most.map(|(_, x)| *x);
    /// Time of the maximum, s.
    max_time: Option<f64> = most.map(|(k, _)| times[*k]);
}

impl RangeFact {
    /// Ranges of all measures at the output times that metrics use. A model without measures has those of the
    /// components of its points.
    pub fn all(units: Units, course: &Course) -> Vec<Self> {
        let solution = course.curves();
        let outputs = &solution.measured.outputs;
        let is_measure = |m: &usize| matches!(outputs[*m].source, OutputSource::Measure(_));
        let measures: Vec<usize> = (0..outputs.len()).filter(is_measure).collect();
        let shown = if measures.is_empty() { (0..outputs.len()).collect() } else { measures };
        shown.into_iter().map(|m| Self::of(units, solution, m)).collect()
    }
}
