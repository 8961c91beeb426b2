//! Proposed further readings.

use hardpoint::measure::outputs;
use hardpoint::model::{DriverId, ElementId, Model, OutputSource};
use hardpoint::run::{Analysis, Run};

use super::certainty::{Certainty, Directions};
use super::fit::{FitWorkspace, SearchResult};
use super::parameter::FittedParameter;
use super::posture::derivative;

/// Maximum number of proposed readings.
const PROPOSED: usize = 5;
/// Maximum number of postures of a motion that are considered.
const MAX_POSTURES: usize = 24;
/// A reading determines an unidentifiable direction if it reduces its standard deviation below this number of natural
/// steps (about the mechanism's size).
const DETERMINES: f64 = 1.0;

/// Proposed reading, with the standard deviation of readings of its kind, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct NextReading {
    /// Column of [`outputs`](hardpoint::measure::outputs).
    pub output: usize,
    /// Values of the drivers, in the coordinate of their laws, m or rad.
    pub drivers: Vec<f64>,
    /// Values of the laws of given forces; all others keep their own.
    pub forces: Vec<(ElementId, f64)>,
    /// Assumed standard deviation.
    pub sigma: f64,
    /// Index of the unidentifiable change that the reading determines best; `None` if it determines none.
    pub determines: Option<usize>,
    /// Variable whose standard deviation the reading reduces by the largest fraction; `None` if it improves no known
    /// variable.
    pub improves: Option<Improvement>,
}

/// Effect of a further reading on a variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Improvement {
    /// Index among the fitted parameters.
    pub variable: usize,
    /// Standard deviation without the reading, SI.
    pub before: f64,
    /// Standard deviation with the reading, SI.
    pub after: f64,
}

/// Values of the drivers and of the laws of forces.
type Place = (Vec<f64>, Vec<(ElementId, f64)>);

/// Possible reading: its derivatives by natural steps, in standard deviations.
struct Candidate {
    next: NextReading,
    g: Vec<f64>,
}

impl FitWorkspace<'_> {
    /// Best reading of each output, the most informative first.
    pub(super) fn next(
        &self,
        search: &SearchResult,
        directions: &Directions,
        certainty: &Certainty,
    ) -> Vec<NextReading> {
        let covariance = directions.covariance(self.parameters.len());
        let mut best: Vec<Option<(f64, NextReading)>> = vec![None; outputs(self.model).len()];
        for candidate in self.candidates(search) {
            let (worth, next) = self.rate(candidate, directions, &covariance, certainty);
            let best = &mut best[next.output];
            if worth > 0.0 && best.as_ref().is_none_or(|(w, _)| worth > *w) {
                *best = Some((worth, next));
            }
        }
        let mut found: Vec<(f64, NextReading)> = best.into_iter().flatten().collect();
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        found.into_iter().take(PROPOSED).map(|(_, next)| next).collect()
    }

    /// Information gain of a reading: change of the logarithm of the determinant, with a large bonus if it determines
    /// an unidentifiable change.
    fn rate(
        &self,
        Candidate { mut next, g }: Candidate,
        directions: &Directions,
        covariance: &[Vec<f64>],
        certainty: &Certainty,
    ) -> (f64, NextReading) {
        let n = g.len();
        let along = |v: &Vec<f64>| v.iter().zip(&g).map(|(v, g)| v * g).sum::<f64>().abs();
        let new = directions
            .unidentifiable
            .iter()
            .map(|(v, _)| along(v))
            .enumerate()
            .max_by(|a, b| a.1.total_cmp(&b.1));
        next.determines = new.filter(|(_, by)| *by > DETERMINES).map(|(k, _)| k);
        // C - C g g' C / (1 + g' C g)
        let cg: Vec<f64> =
            covariance.iter().map(|row| row.iter().zip(&g).map(|(c, g)| c * g).sum()).collect();
        let gcg: f64 = cg.iter().zip(&g).map(|(c, g)| c * g).sum();
        let improved = |k: usize| {
            let before = certainty.sigmas[k].filter(|s| *s > 0.0)?;
            let variance = (covariance[k][k] - cg[k] * cg[k] / (1.0 + gcg)) * self.steps[k] * self.steps[k];
            Some(Improvement { variable: k, before, after: variance.max(0.0).sqrt() })
        };
        let part = |i: &Improvement| i.after / i.before;
        let most = (0..n).filter_map(improved).min_by(|a, b| part(a).total_cmp(&part(b)));
        // The effect on the other variables is unknown until the unidentifiable change is determined.
        next.improves =
            most.filter(|_| next.determines.is_none() && new.is_none_or(|(_, by)| by <= DETERMINES));
        let worth = match next.determines {
            Some(_) => 1e6 + new.map_or(0.0, |(_, by)| by.ln()),
            None => gcg.ln_1p(),
        };
        (worth, next)
    }

    /// Possible readings: every output in the measured postures, and along the motions of the model.
    fn candidates(&self, search: &SearchResult) -> Vec<Candidate> {
        let readings = &self.request.measured.readings;
        let directions = outputs(self.model);
        let sigma_of = |output: usize| {
            let of = |k: &usize| {
                let reading = &readings[*k];
                let sigma = if self.has_sigmas { reading.sigma } else { Some(search.scale) };
                sigma.map(|s| (reading.output, s))
            };
            let all: Vec<(usize, f64)> = self.compared.iter().filter_map(of).collect();
            let like = all.iter().find(|(o, _)| directions[*o].dimension == directions[output].dimension);
            all.iter().find(|(o, _)| *o == output).or(like).map(|(_, s)| *s)
        };
        let sigmas: Vec<Option<f64>> = (0..directions.len())
            .map(|m| sigma_of(m).filter(|_| self.model.is_known_at_rest(directions[m].source)))
            .collect();
        let possible = directions.iter().zip(&sigmas).filter(|(_, sigma)| sigma.is_some());
        let possible: Vec<OutputSource> = possible.map(|(output, _)| output.source).collect();
        let mut found = Vec::new();
        let design = self.design(&search.x);
        let mut at = |analysis: &Analysis<'_>, places: &dyn Fn(usize) -> Option<Place>| {
            let run = Run::new().at(&design[..analysis.model().variables.len()]);
            let solution = analysis.solve(run.for_outputs(&possible));
            for k in 0..solution.motion.len() {
                let Some((drivers, forces)) = places(k) else { continue };
                for (output, sigma) in sigmas.iter().enumerate() {
                    let Some(sigma) = *sigma else { continue };
                    let d = |p: FittedParameter| match self.variable_in_postures(p) {
                        Some(v) => derivative(&solution, k, output, v),
                        None => f64::from(u8::from(p == FittedParameter::Output(output))),
                    };
                    let by = |(p, step): (&FittedParameter, &f64)| d(*p) * step / sigma;
                    let g: Vec<f64> = self.parameters.iter().zip(&self.steps).map(by).collect();
                    if g.iter().all(|g| g.is_finite()) {
                        let next = NextReading {
                            output,
                            drivers: drivers.clone(),
                            forces: forces.clone(),
                            sigma,
                            determines: None,
                            improves: None,
                        };
                        found.push(Candidate { next, g });
                    }
                }
            }
        };
        let measured = self.request.measured;
        for (posture, (analysis, drivers)) in self.analyses.iter().zip(&measured.postures).enumerate() {
            let forces = measured.forces_in(posture);
            at(analysis, &|k| (k > 0).then(|| (drivers.clone(), forces.to_vec())));
        }
        // The motions of the model have no offsets of drivers.
        let motions = if self.offset_drivers.is_empty() { self.model.motions() } else { Vec::new() };
        for (case, model) in motions.into_iter().enumerate() {
            let every = model.times.len().div_ceil(MAX_POSTURES).max(1);
            let few = Model { times: model.times.iter().step_by(every).copied().collect(), ..model };
            if let Ok(analysis) = Analysis::with(&few, self.request.formulation) {
                let force_laws = self.model.cases.get(case).map_or(&[][..], |c| &c.force_laws[..]);
                let drivers_at = |k: usize| {
                    let place =
                        |d: usize| few.drivers[d].law.at(few.times[k]).value() + few.as_drawn(DriverId(d));
                    let forces = force_laws.iter().map(|(e, law)| (*e, law.at(few.times[k]).value()));
                    Some(((0..few.drivers.len()).map(place).collect(), forces.collect()))
                };
                at(&analysis, &drivers_at);
            }
        }
        found
    }
}
