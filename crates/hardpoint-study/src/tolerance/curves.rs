//! Tolerance bands along whole curves, from exact first and second derivatives at every output time.

use hardpoint::model::OutputSource;

use super::deviations::Deviations;
use super::pins::{Pins, SideChange};
use super::{SecondOrder, Study};

/// Maximum size of the second derivatives for bands, in bytes; with more variables or longer motions, bands are of
/// first order.
const MOST_BYTES: usize = 256 << 20;
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
    pub worst: [f64; 2],
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

impl Study<'_> {
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
        let curve = |&(measure, column): &(usize, usize)| {
            let bend = bends.iter().position(|c| *c == column);
            let band = |k: usize| {
                let nominal = measured.value(k, column)[0];
                let g: Vec<f64> =
                    deviations.variables.iter().map(|v| measured.d(k, v.variable, column)[0]).collect();
                let reach = reach(deviations, &g);
                let second =
                    bend.and_then(|m| Some(deviations.second_order(&g, &seconds.as_ref()?.at(k, m))));
                BandPoint {
                    nominal,
                    sigma: deviations.sigma(&g),
                    worst: [nominal - reach, nominal + reach],
                    second,
                    loaded: pins.and_then(|pins| Some(nominal + pins.shift(deviations, k, &g)?)),
                }
            };
            let bands = (0..times.len()).map(band).collect();
            CurveBands { measure, motion, column, times: times.clone(), bands }
        };
        settings.iter().map(curve).collect()
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

/// First-order worst-case deviation: the sum over the tolerances of reach times norm of the gradient.
fn reach(of: &Deviations, g: &[f64]) -> f64 {
    of.blocks.iter().map(|b| b.reach * g[b.range()].iter().map(|x| x * x).sum::<f64>().sqrt()).sum()
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
