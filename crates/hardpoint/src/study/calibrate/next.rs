//! Further readings with the most information.

use crate::measure::outputs;
use crate::model::{DriverId, Model, VariableId};
use crate::run::{Analysis, Run};

use super::Certainty;
use super::certainty::Known;
use super::fit::{FitWorkspace, SearchResult};
use super::posture::derivative;

/// Number of readings that are proposed.
const PROPOSED: usize = 5;
/// Maximum number of postures of a motion that are considered.
const LOOKED_AT: usize = 24;
/// A reading indicates a direction that the others do not tell if it makes its standard deviation less than a natural
/// step, about the mechanism's size.
const TELLS: f64 = 1.0;

/// A further reading, of the standard deviation that readings of its kind have. In SI.
#[derive(Clone, Debug, PartialEq)]
pub struct NextReading {
    /// The column of [`outputs`](crate::measure::outputs).
    pub output: usize,
    /// Values of the drivers, as their laws count.
    pub drivers: Vec<f64>,
    /// The standard deviation that was assumed.
    pub sigma: f64,
    /// Index of the unidentifiable change that it would determine best.
    pub tells: Option<usize>,
    /// The variable whose standard deviation it makes smaller by the largest part, by its place among those sought;
    /// none where it indicates nothing of those that are known.
    pub improves: Option<Improvement>,
}

/// Effect of a further reading on a variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Improvement {
    /// The variable, by its place among those sought.
    pub variable: usize,
    /// Standard deviation now, SI.
    pub before: f64,
    /// With the reading.
    pub after: f64,
}

/// A reading that could be taken: its derivatives by natural steps, in standard deviations.
struct Candidate {
    next: NextReading,
    g: Vec<f64>,
}

impl FitWorkspace<'_> {
    /// The best reading of each output, the best first.
    pub(super) fn next(
        &self,
        search: &SearchResult,
        known: &Known,
        certainty: &Certainty,
    ) -> Vec<NextReading> {
        let covariance = known.covariance(self.variables.len());
        let mut best: Vec<Option<(f64, NextReading)>> = vec![None; outputs(self.model).len()];
        for candidate in self.candidates(search) {
            let (worth, next) = self.judged(candidate, known, &covariance, certainty);
            let best = &mut best[next.output];
            if worth > 0.0 && best.as_ref().is_none_or(|(w, _)| worth > *w) {
                *best = Some((worth, next));
            }
        }
        let mut found: Vec<(f64, NextReading)> = best.into_iter().flatten().collect();
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        found.into_iter().take(PROPOSED).map(|(_, next)| next).collect()
    }

    /// Information of a reading: the change of the logarithm of the determinant, and far more if it determines an
    /// unidentifiable change.
    fn judged(
        &self,
        Candidate { mut next, g }: Candidate,
        known: &Known,
        covariance: &[Vec<f64>],
        certainty: &Certainty,
    ) -> (f64, NextReading) {
        let n = g.len();
        let along = |v: &Vec<f64>| v.iter().zip(&g).map(|(v, g)| v * g).sum::<f64>().abs();
        let new = known.untold.iter().map(|(v, _)| along(v)).enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        next.tells = new.filter(|(_, by)| *by > TELLS).map(|(k, _)| k);
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
        // What a reading of something not reported does to the rest is not known before that is reported.
        next.improves = most.filter(|_| next.tells.is_none() && new.is_none_or(|(_, by)| by <= TELLS));
        let worth = match next.tells {
            Some(_) => 1e6 + new.map_or(0.0, |(_, by)| by.ln()),
            None => gcg.ln_1p(),
        };
        (worth, next)
    }

    /// Possible readings: every output in the measured postures, and along the motions of the model.
    fn candidates(&self, search: &SearchResult) -> Vec<Candidate> {
        let readings = &self.asked.measured.readings;
        let known = outputs(self.model);
        let sigma_of = |output: usize| {
            let of = |k: &usize| {
                let reading = &readings[*k];
                let sigma = if self.has_sigmas { reading.sigma } else { Some(search.scale) };
                sigma.map(|s| (reading.output, s))
            };
            let all: Vec<(usize, f64)> = self.compared.iter().filter_map(of).collect();
            let like = all.iter().find(|(o, _)| known[*o].dimension == known[output].dimension);
            all.iter().find(|(o, _)| *o == output).or(like).map(|(_, s)| *s)
        };
        let sigmas: Vec<Option<f64>> = (0..known.len())
            .map(|m| sigma_of(m).filter(|_| self.model.is_known_at_rest(known[m].source)))
            .collect();
        let mut found = Vec::new();
        let design = self.design(&search.x);
        let mut at = |analysis: &Analysis<'_>, places: &dyn Fn(usize) -> Option<Vec<f64>>| {
            let solution = analysis.solve(Run::new().at(&design));
            for k in 0..solution.motion.len() {
                let Some(drivers) = places(k) else { continue };
                for (output, sigma) in sigmas.iter().enumerate() {
                    let Some(sigma) = *sigma else { continue };
                    let by =
                        |(v, step): (&VariableId, &f64)| derivative(&solution, k, output, *v) * step / sigma;
                    let g: Vec<f64> = self.variables.iter().zip(&self.steps).map(by).collect();
                    if g.iter().all(|g| g.is_finite()) {
                        let next = NextReading {
                            output,
                            drivers: drivers.clone(),
                            sigma,
                            tells: None,
                            improves: None,
                        };
                        found.push(Candidate { next, g });
                    }
                }
            }
        };
        for (analysis, drivers) in self.analyses.iter().zip(&self.asked.measured.postures) {
            at(analysis, &|k| (k > 0).then(|| drivers.clone()));
        }
        for model in self.model.motions() {
            let every = model.times.len().div_ceil(LOOKED_AT).max(1);
            let few = Model { times: model.times.iter().step_by(every).copied().collect(), ..model };
            if let Ok(analysis) = Analysis::with(&few, self.asked.formulation) {
                let stands = |k: usize| {
                    let place =
                        |d: usize| few.drivers[d].law.at(few.times[k]).value() + few.as_drawn(DriverId(d));
                    Some((0..few.drivers.len()).map(place).collect())
                };
                at(&analysis, &stands);
            }
        }
        found
    }
}
