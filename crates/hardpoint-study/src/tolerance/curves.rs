//! Tolerance bands along whole curves, from exact first and second derivatives at every output time.

use std::collections::HashMap;

use hardpoint::Run;
use hardpoint::model::OutputSource;

use super::data::StudyData;
use super::deviations::SecondOrder;
use super::pins::{Pins, SideChange};
use super::worst::{Extreme, extreme};

/// Maximum size of the second derivatives for bands, in bytes; with more variables or longer motions, bands are of
/// first order.
const MOST_BYTES: usize = 256 << 20;
/// Maximum number of designs that are solved for the worst cases of the curves of one motion, a few thousand as for
/// Monte Carlo designs. Beyond, they are predicted by derivatives.
const MOST_DESIGNS: usize = 4000;
/// Maximum size of the second derivatives during their computation, in bytes.
const PART_BYTES: usize = 16 << 20;

/// Effect of tolerances on a measure along one motion.
#[derive(Clone, Debug)]
pub struct CurveBands {
    /// Index in [`Model::measures`](hardpoint::model::Model::measures).
    pub measure: usize,
    /// Index of the motion among those studied.
    pub motion: usize,
    /// Column of [`MeasureResults`](hardpoint::measure::MeasureResults).
    pub column: usize,
    /// Output times, s.
    pub times: Vec<f64>,
    /// Bands at the output times.
    pub bands: Vec<BandPoint>,
}

/// Effect of tolerances on a measure at one output time, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandPoint {
    /// Nominal value.
    pub nominal: f64,
    /// First-order standard deviation.
    pub sigma: f64,
    /// Minimum and maximum to first order.
    pub first: [f64; 2],
    /// Minimum and maximum over the designs that were solved for the worst cases of all output times; where there is
    /// none, predicted to second order if that is known, else to first order.
    pub worst: [f64; 2],
    /// True if the designs of both worst cases of this output time were solved.
    pub solved: bool,
    /// Second-order moments, if second derivatives are known: for outputs that depend on positions alone.
    pub second: Option<SecondOrder>,
    /// First-order value where every pin with play lies on the side to which the loads press it; `None` without loads,
    /// or where that is not known.
    pub loaded: Option<f64>,
}

impl CurveBands {
    /// Mean and standard deviation at output time k, to the highest known order.
    pub fn moments(&self, k: usize) -> [f64; 2] {
        let BandPoint { nominal, sigma, second, .. } = self.bands[k];
        second.map_or([nominal, sigma], |s| [nominal + s.shift, s.sigma])
    }
}

impl StudyData<'_> {
    /// Bands of all requested curves; stops early if `more` returns false. With the pins that change sides under load.
    pub(super) fn curves(&self, more: &(dyn Fn() -> bool + Sync)) -> (Vec<CurveBands>, Vec<SideChange>) {
        let (mut curves, mut changes) = (Vec::new(), Vec::new());
        for motion in 0..self.motions.len() {
            let pins = Pins::of(self, motion);
            curves.extend(self.curves_of(motion, pins.as_ref(), more));
            changes.extend(pins.into_iter().flat_map(|pins| pins.changes));
        }
        (curves, changes)
    }

    fn curves_of(
        &self,
        motion: usize,
        pins: Option<&Pins>,
        more: &(dyn Fn() -> bool + Sync),
    ) -> Vec<CurveBands> {
        let measured = &self.nominal.solutions[motion].measured;
        let column = |measure: &usize| {
            measured
                .outputs
                .iter()
                .position(|o| o.source == OutputSource::Measure(*measure))
                .map(|c| (*measure, c))
        };
        let settings: Vec<(usize, usize)> = self.settings.curves.iter().filter_map(column).collect();
        let bends: Vec<usize> =
            settings.iter().map(|(_, c)| *c).filter(|c| measured.outputs[*c].known.by_position).collect();
        let seconds = self.seconds(motion, &bends, more);
        let deviations = self.deviations;
        let times = self.nominal.solutions[motion].motion.times.clone();
        // By curve and output time: the worst cases in both directions, predicted.
        let mut predicted: Vec<Vec<[Extreme; 2]>> = Vec::new();
        let curve = |&(measure, column): &(usize, usize)| {
            let bend = bends.iter().position(|c| *c == column);
            let mut extremes = Vec::new();
            let band = |k: usize| {
                let nominal = measured.value(k, column)[0];
                let g: Vec<f64> =
                    deviations.variables.iter().map(|v| measured.d(k, v.variable, column)[0]).collect();
                let h = bend.and_then(|m| Some(seconds.as_ref()?.at(k, m)));
                let both = [-1.0, 1.0].map(|sign| extreme(deviations, nominal, &g, h.as_deref(), sign));
                let (first, second) = (both.each_ref().map(|e| e.first), both.each_ref().map(|e| e.second));
                extremes.push(both);
                BandPoint {
                    nominal,
                    sigma: deviations.sigma(&g),
                    first,
                    worst: [0, 1].map(|side| second[side].unwrap_or(first[side])),
                    solved: false,
                    second: h.map(|h| deviations.second_order(&g, &h)),
                    loaded: pins.and_then(|pins| Some(nominal + pins.shift(deviations, k, &g)?)),
                }
            };
            let bands = (0..times.len()).map(band).collect();
            predicted.push(extremes);
            CurveBands { measure, motion, column, times: times.clone(), bands }
        };
        let mut curves: Vec<CurveBands> = settings.iter().map(curve).collect();
        self.solve_worst(motion, &predicted, more, &mut curves);
        curves
    }

    /// Solves the designs of the predicted worst cases, and replaces the predictions by the extremes of all solved
    /// designs: each of them is within the tolerances at every output time.
    fn solve_worst(
        &self,
        motion: usize,
        predicted: &[Vec<[Extreme; 2]>],
        more: &(dyn Fn() -> bool + Sync),
        curves: &mut [CurveBands],
    ) {
        // Most output times share a few designs: the corners of the tolerances.
        let mut designs: Vec<&[f64]> = Vec::new();
        let mut places: HashMap<Vec<u64>, usize> = HashMap::new();
        let place_of =
            |extreme: &Extreme| -> Vec<u64> { extreme.deviations.iter().map(|x| x.to_bits()).collect() };
        for extreme in predicted.iter().flatten().flatten() {
            places.entry(place_of(extreme)).or_insert_with(|| {
                designs.push(&extreme.deviations);
                designs.len() - 1
            });
        }
        if designs.len() > MOST_DESIGNS {
            return;
        }
        let analysis = &self.motions.analyses()[motion];
        let steps = self.nominal.solutions[motion].motion.len();
        // Number of output times that each design reaches.
        let mut reached = Vec::with_capacity(designs.len());
        // By curve and output time: the extremes of all designs.
        let nominal = |curve: &CurveBands| curve.bands.iter().map(|b| [b.nominal; 2]).collect::<Vec<_>>();
        let mut extremes: Vec<Vec<[f64; 2]>> = curves.iter().map(nominal).collect();
        for deviations in &designs {
            if !more() {
                return;
            }
            let design = self.deviations.design(self.model.variables.len(), deviations);
            let solution = analysis.solve(Run::new().at(&design).without_sensitivities());
            let known = solution.motion.len().min(steps);
            reached.push(known);
            for (curve, extremes) in curves.iter().zip(&mut extremes) {
                for (k, [least, greatest]) in extremes.iter_mut().enumerate().take(known) {
                    let value = solution.measured.value(k, curve.column)[0];
                    (*least, *greatest) = (least.min(value), greatest.max(value));
                }
            }
        }
        for ((curve, predicted), extremes) in curves.iter_mut().zip(predicted).zip(&extremes) {
            for (k, band) in curve.bands.iter_mut().enumerate() {
                // Without derivatives, as at a kink, the worst case is not known.
                let is_solved =
                    predicted[k].each_ref().map(|e| e.first.is_finite() && k < reached[places[&place_of(e)]]);
                let sides = band.worst.iter_mut().zip(extremes[k]).zip(is_solved);
                sides.filter(|(_, is_solved)| *is_solved).for_each(|((worst, solved), _)| *worst = solved);
                band.solved = is_solved == [true; 2];
            }
        }
    }

    /// Exact second derivatives of some columns by all pairs of toleranced variables; `None` if they are too large, or
    /// the caller ended the study.
    fn seconds(&self, motion: usize, columns: &[usize], more: &(dyn Fn() -> bool + Sync)) -> Option<Seconds> {
        let (analysis, variables) = (&self.motions.analyses()[motion], &self.deviations.variables);
        let n = variables.len();
        let (steps, pairs) = (self.nominal.solutions[motion].motion.len(), n * (n + 1) / 2);
        if columns.is_empty() || steps * pairs * columns.len() * size_of::<f64>() > MOST_BYTES {
            return None;
        }
        let mut values = vec![0.0; steps * pairs * columns.len()];
        let directions: Vec<Vec<f64>> = variables.iter().map(|v| self.model.alone(v.variable, 1.0)).collect();
        let all: Vec<[usize; 2]> = (0..n).flat_map(|i| (0..=i).map(move |j| [i, j])).collect();
        let outputs = self.nominal.solutions[motion].measured.outputs.len();
        let per_pair = steps * (16 * outputs + 96 * self.model.bodies.len());
        let part = (PART_BYTES / per_pair.max(1)).max(1);
        for (chunk, some) in all.chunks(part).enumerate() {
            if !more() {
                return None;
            }
            let second = analysis.second(&[], &directions, some);
            if second.times.len() < steps {
                return None;
            }
            for k in 0..steps {
                for p in 0..some.len() {
                    for (m, column) in columns.iter().enumerate() {
                        values[(k * columns.len() + m) * pairs + chunk * part + p] =
                            second.value(k, p, *column);
                    }
                }
            }
        }
        Some(Seconds { variables: n, columns: columns.len(), values })
    }
}

/// Lower triangles of second derivatives, by output time and column.
struct Seconds {
    variables: usize,
    columns: usize,
    values: Vec<f64>,
}

impl Seconds {
    fn at(&self, k: usize, m: usize) -> Vec<Vec<f64>> {
        let n = self.variables;
        let pairs = n * (n + 1) / 2;
        let first = (k * self.columns + m) * pairs;
        let of = |i: usize, j: usize| {
            let (low, high) = (i.min(j), i.max(j));
            self.values[first + high * (high + 1) / 2 + low]
        };
        (0..n).map(|i| (0..n).map(|j| of(i, j)).collect()).collect()
    }
}
