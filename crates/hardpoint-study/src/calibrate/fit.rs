//! Fit by bounded steps of basin's trust region over the directions that the readings determine.

use std::cell::RefCell;

use basin::DenseMatrix;

use crate::evaluation::StudyCost;
use crate::request::RequestError;
use crate::svd::{Singular, singular};
use crate::trust_region::{Recent, TrustRegion};
use hardpoint::measure::Output;
use hardpoint::model::{Model, VariableId};
use hardpoint::run::Analysis;

use super::posture::{ReachedPosture, solve_posture};
use super::{
    Calibration, Certainty, FittedReading, Loss, NextReading, Reading, Request, Status, UnreachedPosture,
};

/// Maximum change of a variable from the nominal design, in natural steps (each about the mechanism's size or a
/// radian).
const FARTHEST: f64 = 10.0;
/// A singular value below this fraction of the largest is round-off: the readings do not determine its direction.
const ROUND_OFF: f64 = 1e-9;
/// The objective has converged if an iteration lowers it by less than this fraction.
const SETTLED: f64 = 1e-12;
/// Median absolute value of normal residuals, as a fraction of their standard deviation.
const MEDIAN_OF_NORMAL: f64 = 0.6745;

/// Data of a fit.
pub(super) struct FitWorkspace<'b> {
    pub model: &'b Model,
    pub analyses: &'b [Analysis<'b>],
    pub request: &'b Request<'b>,
    /// Fitted variables, without those that the mechanism cannot follow.
    pub variables: Vec<VariableId>,
    left_out: Vec<VariableId>,
    /// Natural step of each fitted variable.
    pub steps: Vec<f64>,
    not_reached: Vec<UnreachedPosture>,
    /// Indices of the compared readings.
    pub compared: Vec<usize>,
    /// True if all readings have standard deviations.
    pub has_sigmas: bool,
    nominal: Vec<Option<ReachedPosture>>,
    pub cost: RefCell<StudyCost>,
}

/// State of a search.
pub(super) struct SearchResult {
    pub status: Status,
    /// Changes from the nominal design, in natural steps.
    pub x: Vec<f64>,
    /// Residuals, in the given standard deviations or in SI, and their derivatives by natural steps.
    pub at: Rows,
    /// Weight of each residual.
    pub weights: Vec<f64>,
    /// Estimated standard deviation of the residuals; 1 if standard deviations are given.
    pub scale: f64,
    pub objective: [f64; 2],
    iterations: Vec<f64>,
}

/// Residuals and their derivatives.
#[derive(Clone, Debug, Default)]
pub(super) struct Rows {
    pub r: Vec<f64>,
    pub d: Vec<Vec<f64>>,
}

impl<'b> FitWorkspace<'b> {
    pub fn new(model: &'b Model, analyses: &'b [Analysis<'b>], request: &'b Request<'b>) -> Self {
        Self {
            model,
            analyses,
            request,
            variables: request.variables.to_vec(),
            left_out: Vec::new(),
            steps: Vec::new(),
            not_reached: Vec::new(),
            compared: Vec::new(),
            has_sigmas: request.measured.readings.iter().all(|r| r.sigma.is_some()),
            nominal: Vec::new(),
            cost: RefCell::new(StudyCost { designs: 1, ..StudyCost::default() }),
        }
    }

    fn readings(&self) -> &'b [Reading] {
        &self.request.measured.readings
    }

    /// Determines the reachable postures, and the variables that the mechanism can follow in them.
    pub fn evaluate_nominal(&mut self) -> Result<(), RequestError> {
        for (posture, analysis) in self.analyses.iter().enumerate() {
            let found = solve_posture(analysis, &[], &mut self.cost.borrow_mut());
            if let Err(stop) = &found {
                self.not_reached.push(UnreachedPosture { posture, why: stop.headline(analysis.model()) });
            }
            self.nominal.push(found.ok());
        }
        let reached = || self.nominal.iter().flatten();
        let follows = |v: &VariableId| reached().all(|p| p.follows(*v));
        (self.variables, self.left_out) = self.variables.iter().partition(|v| follows(v));
        if self.variables.is_empty() {
            return Err(RequestError::model(
                "the mechanism can follow none of the fitted variables",
                "fit variables that it can follow",
            ));
        }
        self.steps = self.variables.iter().map(|v| self.model.natural_step(*v)).collect();
        let is_known =
            |r: &Reading| self.nominal[r.posture].as_ref().is_some_and(|s| s.value(r.output).is_finite());
        self.compared = (0..self.readings().len()).filter(|k| is_known(&self.readings()[*k])).collect();
        if self.compared.is_empty() {
            let why = self.not_reached.first().map_or(String::new(), |n| n.why.clone());
            return Err(RequestError::model(
                format!("no posture of the table can be reached; error on the path to the first: {why}"),
                "measure postures that the nominal design reaches",
            ));
        }
        let (readings, variables) = (self.compared.len(), self.variables.len());
        if !self.has_sigmas && readings <= variables {
            return Err(RequestError::model(
                format!(
                    "{readings} readings without standard deviations do not determine {variables} variables and their accuracy"
                ),
                "give standard deviations (`sigma`), fit fewer variables, or measure more",
            ));
        }
        Ok(())
    }

    /// Design at changes from the nominal design in natural steps.
    pub fn design(&self, x: &[f64]) -> Vec<f64> {
        let mut design = vec![0.0; self.model.variables.len()];
        for ((v, step), x) in self.variables.iter().zip(&self.steps).zip(x) {
            design[v.0] = step * x;
        }
        design
    }

    /// Solves a design in all postures that the nominal design reaches; `None` if one is not reached, or the caller
    /// ended the fit.
    fn solve_postures(&self, x: &[f64], more: &dyn Fn() -> bool) -> Option<Vec<Option<ReachedPosture>>> {
        let design = self.design(x);
        self.cost.borrow_mut().designs += 1;
        let of = |(analysis, nominal): (&Analysis<'_>, &Option<ReachedPosture>)| {
            if nominal.is_none() {
                return Some(None);
            }
            if !more() {
                return None;
            }
            solve_posture(analysis, &design, &mut self.cost.borrow_mut()).ok().map(Some)
        };
        self.analyses.iter().zip(&self.nominal).map(of).collect()
    }

    fn rows(&self, postures: &[Option<ReachedPosture>]) -> Rows {
        let mut rows = Rows::default();
        for k in &self.compared {
            let reading = &self.readings()[*k];
            let posture =
                postures[reading.posture].as_ref().expect("only postures that are reached are compared");
            let sigma = self.unit(reading);
            let by = |(v, step): (&VariableId, &f64)| posture.d(reading.output, *v) * step / sigma;
            rows.r.push((posture.value(reading.output) - reading.value) / sigma);
            rows.d.push(self.variables.iter().zip(&self.steps).map(by).collect());
        }
        rows
    }

    /// Unit of a reading's residual: its standard deviation, or one SI unit.
    fn unit(&self, reading: &Reading) -> f64 {
        reading.sigma.filter(|_| self.has_sigmas).unwrap_or(1.0)
    }

    /// Residuals of a design; `None` if a posture is not reached, or the mechanism does not follow all variables.
    fn rows_at(&self, x: &[f64], more: &dyn Fn() -> bool) -> Option<Rows> {
        let rows = self.rows(&self.solve_postures(x, more)?);
        rows.r.iter().chain(rows.d.iter().flatten()).all(|x| x.is_finite()).then_some(rows)
    }

    /// Standard deviation of the residuals, estimated if none are given.
    fn scale_of(&self, r: &[f64], determined: usize) -> f64 {
        if self.has_sigmas {
            return 1.0;
        }
        let found = if self.request.loss == Loss::Squares {
            let free = r.len().saturating_sub(determined).max(1) as f64;
            (r.iter().map(|r| r * r).sum::<f64>() / free).sqrt()
        } else {
            let mut sizes: Vec<f64> = r.iter().map(|r| r.abs()).collect();
            sizes.sort_by(f64::total_cmp);
            sizes[sizes.len() / 2] / MEDIAN_OF_NORMAL
        };
        if found > 0.0 { found } else { 1.0 }
    }

    fn weights(&self, r: &[f64], scale: f64) -> Vec<f64> {
        r.iter().map(|r| self.request.loss.weight(r / scale)).collect()
    }

    /// Fits from the nominal design until no small change improves the fit.
    pub fn search(&self, progress: &mut dyn FnMut(usize, f64), more: &dyn Fn() -> bool) -> SearchResult {
        let n = self.variables.len();
        let mut x = vec![0.0; n];
        let mut at = self.rows(&self.nominal);
        let mut scale = self.scale_of(&at.r, n);
        let mut weights = self.weights(&at.r, scale);
        let squares = |at: &Rows, w: &[f64]| at.r.iter().zip(w).map(|(r, w)| w * r * r).sum::<f64>();
        let mut status = Status::IterationLimit;
        let mut iterations = Vec::new();
        let first = at.clone();
        progress(0, squares(&at, &weights) / (scale * scale));
        while iterations.len() < self.request.iterations {
            let before = squares(&at, &weights);
            let (Singular { mut directions, .. }, determined) = weighed(&at.d, &weights, n);
            directions.truncate(determined);
            let step = self.step(&x, &at, &weights, &directions, more);
            if !more() {
                status = Status::Interrupted;
                break;
            }
            let Some((next, rows)) = step.filter(|(_, rows)| squares(rows, &weights) < before) else {
                status = Status::Found;
                break;
            };
            let after = squares(&rows, &weights);
            (x, at) = (next, rows);
            let scaled_before = scale;
            scale = self.scale_of(&at.r, directions.len());
            let old = std::mem::replace(&mut weights, self.weights(&at.r, scale));
            let settled = weights.iter().zip(&old).all(|(a, b)| (a - b).abs() <= SETTLED.sqrt());
            iterations.push(squares(&at, &weights) / (scale * scale));
            progress(iterations.len(), *iterations.last().expect("it was just put there"));
            if before - after <= SETTLED * before
                && settled
                && (scale - scaled_before).abs() <= SETTLED.sqrt() * scale
            {
                status = Status::Found;
                break;
            }
        }
        let of = |at: &Rows| self.loss_of(&at.r, scale);
        let objective = [of(&first), of(&at)];
        SearchResult { status, x, at, weights, scale, objective, iterations }
    }

    /// Sum of the loss over all residuals.
    fn loss_of(&self, r: &[f64], scale: f64) -> f64 {
        let weight = |r: f64| self.request.loss.weight(r);
        r.iter().map(|r| r / scale).map(|r| weight(r) * r * r).sum()
    }

    /// Best fit with fixed weights over some directions, starting at x; `None` if there is none.
    fn step(
        &self,
        x: &[f64],
        at: &Rows,
        weights: &[f64],
        directions: &[Vec<f64>],
        more: &dyn Fn() -> bool,
    ) -> Option<(Vec<f64>, Rows)> {
        if directions.is_empty() {
            return None;
        }
        let roots: Vec<f64> = weights.iter().map(|w| w.sqrt()).collect();
        let size = at.r.iter().zip(&roots).map(|(r, w)| (w * r).powi(2)).sum::<f64>().sqrt();
        let scale = if size > 0.0 { 1.0 / size } else { 1.0 };
        let n = directions.len();
        let place = |z: &[f64]| along(x, directions, z);
        let recent = Recent::default();
        let find = |z: &[f64]| self.rows_at(&place(z), more);
        let none = vec![0.0; n];
        recent.at(&none, || Some(at.clone()), |_| ());
        let residual = |(r, w): (&f64, &f64)| scale * w * r;
        let residuals = |z: &[f64]| {
            recent.at(
                z,
                || find(z),
                |rows| match rows {
                    Some(rows) => rows.r.iter().zip(&roots).map(residual).collect(),
                    None => vec![f64::NAN; roots.len()],
                },
            )
        };
        let derivatives = |z: &[f64]| {
            recent.at(
                z,
                || find(z),
                |rows| {
                    DenseMatrix::from_fn(roots.len(), n, |i, j| {
                        let by = |rows: &Rows| {
                            rows.d[i].iter().zip(&directions[j]).map(|(d, v)| d * v).sum::<f64>()
                        };
                        rows.as_ref().map_or(f64::NAN, |rows| scale * roots[i] * by(rows))
                    })
                },
            )
        };
        let bounds = [-FARTHEST, FARTHEST];
        let mut solver = TrustRegion::new(none.clone(), bounds, Box::new(residuals), Box::new(derivatives))?;
        // A robust loss needs new weights after every iteration; squares keep theirs.
        let most = if self.request.loss == Loss::Squares { self.request.iterations } else { 1 };
        let z = (0..most).map_while(|_| solver.step()).last().unwrap_or(none);
        let rows = recent.at(&z, || find(&z), Option::clone)?;
        Some((place(&z), rows))
    }

    /// Assembles the result.
    pub fn calibration(
        self,
        search: SearchResult,
        certainty: Certainty,
        next: Vec<NextReading>,
        outputs: Vec<Output>,
    ) -> Calibration {
        let mut fitted = vec![None; self.readings().len()];
        for (row, k) in self.compared.iter().enumerate() {
            let reading = &self.readings()[*k];
            let sigma = self.unit(reading);
            let nominal =
                self.nominal[reading.posture].as_ref().map_or(f64::NAN, |s| s.value(reading.output));
            fitted[*k] = Some(FittedReading {
                before: nominal,
                value: reading.value + sigma * search.at.r[row],
                residual: search.at.r[row] / search.scale,
                weight: search.weights[row],
            });
        }
        Calibration {
            status: search.status,
            design: self.design(&search.x),
            variables: self.variables,
            left_out: self.left_out,
            outputs,
            fitted,
            not_reached: self.not_reached,
            objective: search.objective,
            iterations: search.iterations,
            certainty,
            next,
            cost: self.cost.into_inner(),
        }
    }
}

/// Singular value decomposition of weighted rows: the directions, their singular values, and the number of singular
/// values above round-off.
pub(super) fn weighed(rows: &[Vec<f64>], weights: &[f64], n: usize) -> (Singular, usize) {
    let weighted: Vec<Vec<f64>> =
        rows.iter().zip(weights).map(|(row, w)| row.iter().map(|x| w.sqrt() * x).collect()).collect();
    let found = singular(&weighted, n);
    let least = ROUND_OFF * found.values.first().copied().unwrap_or_default();
    let determined = found.values.iter().filter(|s| **s > least).count();
    (found, determined)
}

fn along(x: &[f64], directions: &[Vec<f64>], z: &[f64]) -> Vec<f64> {
    let by = |k: usize| directions.iter().zip(z).map(|(v, z)| v[k] * z).sum::<f64>();
    x.iter().enumerate().map(|(k, x)| x + by(k)).collect()
}
