//! Fit by bounded steps of a trust region over the directions that the readings determine.

use std::cell::{Cell, RefCell};

use crate::evaluation::StudyCost;
use crate::recent::Recent;
use crate::request::RequestError;
use crate::sweep::quantile;
use hardpoint::joint::Quantity;
use hardpoint::measure::outputs;
use hardpoint::model::{Dimension, DriverId, Model, OutputSource, Reading, VariableId};
use hardpoint::run::Analysis;
use hardpoint_difference::Magnitude;

use hardpoint_search::{LeastSquares, bounded_least_squares, dot, singular};

use super::loss::Loss;
use super::parameter::{BoundSide, FittedParameter};
use super::posture::{ReachedPosture, UnreachedPosture, read_outputs, solve_posture};
use super::prior::{PriorRows, parameters_of};
use super::request::Request;

/// Maximum change of a variable from the nominal design, in natural steps (each about the mechanism's size or a
/// radian).
const FARTHEST: f64 = 10.0;
/// Change from the nominal design, in natural steps, beyond which a parameter has run away: no mechanism has links a
/// million times its size, and round-off hides what the readings say about them.
const RUNAWAY: f64 = 1e6;
/// A singular value below this fraction of the largest is round-off: the readings do not determine its direction.
const ROUND_OFF: f64 = 1e-9;
/// A direction with a standard deviation of more natural steps than this (about the mechanism's size) is not
/// determined.
pub(super) const VAGUE: f64 = 1.0;
/// Distance of the nominal design from the best one along such a direction, in standard deviations, above which the
/// readings contradict it.
const CONTRADICTED: f64 = 3.0;
/// The objective has converged if an iteration lowers it by less than this fraction.
const SETTLED: f64 = 1e-12;
/// Round-off of a solved value, as a fraction of it and of the magnitude of its quantity in the mechanism: positions,
/// those of equilibria too, are solved to less.
const ROUND_OFF_OF_VALUE: f64 = 1e-12;
/// Residuals vanish below this fraction of those of the nominal design. Equilibria are solved to about a tenth of it.
const VANISHED: f64 = 1e-11;
/// Median absolute value of normal residuals, as a fraction of their standard deviation.
const MEDIAN_OF_NORMAL: f64 = 0.6745;
/// Two designs whose squares differ by less than this fraction cannot be compared by them: the error of the solved
/// positions counts in standard deviations of the readings, which may be small.
const NEAR: f64 = 1e-8;
/// Number of undamped steps from there.
const MOST_LAST_STEPS: usize = 10;
/// An undamped step counts if the decrease that remains is below this fraction of the one before.
const CLOSER: f64 = 0.25;
/// Damping of a step within bounds that does not improve the fit: first value, as a fraction of the largest column, and
/// factor of the next ones (Levenberg and Marquardt).
const DAMPING: [f64; 2] = [1e-4, 10.0];
/// Number of damped trials before a point counts as the best one: the last step is shorter than round-off.
const MOST_TRIALS: usize = 14;

/// Data of a fit.
pub(super) struct FitWorkspace<'b> {
    pub model: &'b Model,
    pub analyses: &'b [Analysis<'b>],
    pub request: &'b Request<'b>,
    /// Fitted parameters, without those that the mechanism cannot follow.
    pub parameters: Vec<FittedParameter>,
    /// Outputs with readings; others are not solved.
    outputs: Vec<OutputSource>,
    pub left_out: Vec<FittedParameter>,
    /// Drivers with a fitted offset, in the order of their variables in the models of the postures.
    pub offset_drivers: Vec<DriverId>,
    /// Natural step of each fitted parameter.
    pub steps: Vec<f64>,
    /// Bounds of each fitted parameter, in natural steps.
    bounds: Vec<[f64; 2]>,
    /// Rows of the prior knowledge.
    pub priors: PriorRows,
    pub not_reached: Vec<UnreachedPosture>,
    /// Indices of the compared readings.
    pub compared: Vec<usize>,
    /// True if all readings have standard deviations.
    pub has_sigmas: bool,
    pub nominal: Vec<Option<ReachedPosture>>,
    /// Sum of squares that round-off of the solved values leaves: a smaller one, or a smaller decrease of a sum, is
    /// none.
    round_off: f64,
    pub cost: RefCell<StudyCost>,
    /// Number of designs of the current iteration without residuals or without their derivatives.
    refused: Cell<usize>,
}

/// Status of a fit at its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// No small change of the design improves the fit.
    Found,
    /// Better designs cannot be used: the mechanism does not assemble, stops before a posture, or cannot follow a
    /// fitted variable there.
    Stuck,
    /// A parameter has left every sensible range: the readings do not determine it, or do not fit the mechanism.
    Diverged,
    /// The iteration limit was reached.
    IterationLimit,
    /// The caller ended the fit.
    Interrupted,
}

impl Status {
    /// True if the formula of the covariance, that of an optimum, is valid at the end.
    pub(super) fn has_covariance(self) -> bool {
        match self {
            Self::Found | Self::IterationLimit | Self::Interrupted => true,
            Self::Stuck | Self::Diverged => false,
        }
    }
}

/// State between the iterations of a search; its fields are those of [`SearchResult`].
struct SearchState {
    x: Vec<f64>,
    at: Rows,
    weights: Vec<f64>,
    scale: f64,
    iterations: Vec<f64>,
}

/// State at the end of a search.
pub(super) struct SearchResult {
    pub status: Status,
    /// Changes from the nominal design, in natural steps.
    pub x: Vec<f64>,
    /// Residuals, in the given standard deviations or in SI, and their derivatives by natural steps.
    pub at: Rows,
    /// Weight of each residual.
    pub weights: Vec<f64>,
    /// Active bounds.
    pub active: Vec<Option<BoundSide>>,
    /// Estimated standard deviation of the residuals; 1 if standard deviations are given.
    pub scale: f64,
    pub objective: [f64; 2],
    pub iterations: Vec<f64>,
}

/// Residuals of the readings with their derivatives, and residuals of the priors.
#[derive(Clone, Debug, Default)]
pub(super) struct Rows {
    /// Design: changes from the nominal one, in natural steps.
    x: Vec<f64>,
    pub r: Vec<f64>,
    pub d: Vec<Vec<f64>>,
    /// Residuals of the priors, in their standard deviations.
    pub priors: Vec<f64>,
}

/// Directions over the free parameters, in natural steps.
#[derive(Clone, Debug, Default)]
pub(super) struct Determined {
    /// Determined directions, with the singular value of each.
    pub directions: Vec<(Vec<f64>, f64)>,
    /// Directions whose singular values are round-off.
    pub nothing: Vec<Vec<f64>>,
}

/// Step to the optimum of the linearised problem: the sum of `-v (u . r) / s` over the determined directions v, with
/// the residuals r and `u = J v / s`.
struct UndampedStep {
    directions: Vec<(Vec<f64>, f64)>,
    /// `u . r`
    components: Vec<f64>,
    /// Decrease of the squares by the step, as a fraction of them; 0 where it is round-off.
    decrease: f64,
}

impl<'b> FitWorkspace<'b> {
    pub fn new(model: &'b Model, analyses: &'b [Analysis<'b>], request: &'b Request<'b>) -> Self {
        Self {
            model,
            analyses,
            request,
            parameters: parameters_of_request(model, request),
            outputs: read_outputs(model, request.measured),
            left_out: Vec::new(),
            offset_drivers: request.offset_drivers(),
            steps: Vec::new(),
            bounds: Vec::new(),
            priors: PriorRows::default(),
            not_reached: Vec::new(),
            compared: Vec::new(),
            has_sigmas: request.measured.readings.iter().all(|r| r.sigma.is_some()),
            nominal: Vec::new(),
            round_off: 0.0,
            cost: RefCell::new(StudyCost { designs: 1, ..StudyCost::default() }),
            refused: Cell::new(0),
        }
    }

    pub fn readings(&self) -> &'b [Reading] {
        &self.request.measured.readings
    }

    /// Determines the reachable postures, and the variables that the mechanism can follow in them.
    pub fn evaluate_nominal(&mut self) -> Result<(), RequestError> {
        for (posture, analysis) in self.analyses.iter().enumerate() {
            let found = solve_posture(analysis, &[], &self.outputs, &mut self.cost.borrow_mut());
            if let Err(stop) = &found {
                self.not_reached.push(UnreachedPosture::of(posture, stop, analysis.model()));
            }
            self.nominal.push(found.ok());
        }
        let reached = || self.nominal.iter().flatten();
        let follows = |p: &FittedParameter| {
            self.variable_in_postures(*p).is_none_or(|v| reached().all(|posture| posture.follows(v)))
        };
        (self.parameters, self.left_out) = self.parameters.iter().partition(|p| follows(p));
        if self.parameters.is_empty() {
            return Err(RequestError::model(
                "the mechanism can follow none of the fitted variables",
                "fit variables that it can follow",
            ));
        }
        let magnitudes = self.magnitudes();
        self.steps = self.parameters.iter().map(|p| self.natural_step(*p, &magnitudes)).collect();
        let bounds = self.parameters.iter().zip(&self.steps).map(|(p, step)| self.bounds_of(*p, *step));
        self.bounds = bounds.collect();
        self.priors = PriorRows::of(self.model, &self.request.prior, &self.parameters, &self.steps);
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
        // A parameter with a prior takes no reading.
        let with_prior = self.priors.sigmas(self.parameters.len()).iter().flatten().count();
        let (readings, variables) = (self.compared.len(), self.parameters.len());
        if !self.has_sigmas && readings + with_prior <= variables {
            return Err(RequestError::model(
                format!(
                    "{readings} readings without standard deviations do not determine {variables} variables and their accuracy"
                ),
                "give standard deviations (`sigma`), fit fewer variables, or measure more",
            ));
        }
        let round_off = |k: &usize| (ROUND_OFF_OF_VALUE * magnitudes[*k]).powi(2);
        let at_nominal = self.rows(&self.nominal, &vec![0.0; variables]);
        let vanished = at_nominal.r.iter().map(|r| (VANISHED * r).powi(2)).sum::<f64>();
        self.round_off = self.compared.iter().map(round_off).sum::<f64>().max(vanished);
        Ok(())
    }

    /// Magnitude of each reading: that of its quantity in the mechanism or its value, in the unit of its residual.
    fn magnitudes(&self) -> Vec<f64> {
        let (magnitude, outputs) = (Magnitude::at_rest(self.model), outputs(self.model));
        let of = |reading: &Reading| {
            magnitude.of(outputs[reading.output].dimension, 0).max(reading.value.abs()) / self.unit(reading)
        };
        self.readings().iter().map(of).collect()
    }

    /// Variable of a parameter in the models of the postures; `None` for an offset of readings.
    pub fn variable_in_postures(&self, parameter: FittedParameter) -> Option<VariableId> {
        match parameter {
            FittedParameter::Variable(v) => Some(v),
            FittedParameter::Driver(driver) => {
                let place = self.offset_drivers.iter().position(|d| *d == driver);
                place.map(|k| VariableId(self.model.variables.len() + k))
            }
            FittedParameter::Output(_) => None,
        }
    }

    /// Natural step of a parameter: of a variable that moves the mechanism, about its size or a radian; of a stiffness
    /// or another plain number that moves nothing by itself, its typical or nominal value, or if that is zero, as of a
    /// preload, the change that moves the readings by their magnitudes.
    fn natural_step(&self, parameter: FittedParameter, magnitudes: &[f64]) -> f64 {
        let size = self.model.size();
        match parameter {
            FittedParameter::Variable(v) => {
                let (step, variable) = (self.model.natural_step(v), &self.model.variables[v.0]);
                let value = variable.typical.unwrap_or(self.model.nominal_value(v).abs());
                let moves_nothing = variable.quantity == Quantity::Number && step == size;
                match moves_nothing {
                    true if value > 0.0 => value,
                    true => self.moving_step(parameter, magnitudes).unwrap_or(step),
                    false => step,
                }
            }
            FittedParameter::Driver(driver) => {
                match self.model.driven(&self.model.drivers[driver.0]).quantity {
                    Quantity::Length => size,
                    Quantity::Angle | Quantity::Number => 1.0,
                }
            }
            FittedParameter::Output(m) => match outputs(self.model)[m].dimension {
                Dimension::LENGTH => size,
                Dimension::ANGLE => 1.0,
                _ => {
                    let of = self.readings().iter().filter(|r| r.output == m);
                    let largest = of.map(|r| r.value.abs()).fold(0.0, f64::max);
                    if largest > 0.0 { largest } else { 1.0 }
                }
            },
        }
    }

    /// Change of a parameter that moves the readings by their magnitudes, to first order; `None` if none depends on it.
    fn moving_step(&self, parameter: FittedParameter, magnitudes: &[f64]) -> Option<f64> {
        let (mut moved, mut all) = (0.0, 0.0);
        for (reading, magnitude) in self.readings().iter().zip(magnitudes) {
            let Some(posture) = &self.nominal[reading.posture] else { continue };
            let d = self.d(posture, reading.output, parameter) / self.unit(reading);
            if d.is_finite() {
                moved += d * d;
                all += magnitude * magnitude;
            }
        }
        Some((all / moved).sqrt()).filter(|step| step.is_finite() && *step > 0.0)
    }

    /// Bounds of a parameter in natural steps; infinite if it has none, or bounds are not kept.
    fn bounds_of(&self, parameter: FittedParameter, step: f64) -> [f64; 2] {
        let bounds = self.kept_bounds(parameter);
        bounds.map_or([f64::NEG_INFINITY, f64::INFINITY], |b| b.map(|x| x / step))
    }

    /// Bounds of a parameter, SI, if it has any and they are kept.
    pub fn kept_bounds(&self, parameter: FittedParameter) -> Option<[f64; 2]> {
        match parameter {
            FittedParameter::Variable(v) => {
                self.model.variables[v.0].bounds.filter(|_| self.request.keep_bounds)
            }
            FittedParameter::Driver(_) | FittedParameter::Output(_) => None,
        }
    }

    fn is_bounded(&self) -> bool {
        self.bounds.iter().flatten().any(|x| x.is_finite())
    }

    fn active_bounds(&self, x: &[f64]) -> Vec<Option<BoundSide>> {
        let side = |(x, [low, high]): (&f64, &[f64; 2])| match x {
            x if x <= low => Some(BoundSide::Lower),
            x if x >= high => Some(BoundSide::Upper),
            _ => None,
        };
        x.iter().zip(&self.bounds).map(side).collect()
    }

    /// Changes of all variables of the posture models, from changes in natural steps: the design, then the offsets of
    /// drivers.
    pub fn design(&self, x: &[f64]) -> Vec<f64> {
        let mut design = vec![0.0; self.model.variables.len() + self.offset_drivers.len()];
        for ((p, step), x) in self.parameters.iter().zip(&self.steps).zip(x) {
            if let Some(v) = self.variable_in_postures(*p) {
                design[v.0] = step * x;
            }
        }
        design
    }

    /// Offset of the readings of an output.
    pub fn offset_of(&self, output: usize, x: &[f64]) -> f64 {
        let all = self.parameters.iter().zip(&self.steps).zip(x);
        all.map(|((p, step), x)| if *p == FittedParameter::Output(output) { step * x } else { 0.0 }).sum()
    }

    /// Derivative of an output in a reached posture by a fitted parameter.
    pub fn d(&self, posture: &ReachedPosture, output: usize, parameter: FittedParameter) -> f64 {
        match self.variable_in_postures(parameter) {
            Some(v) => posture.d(output, v),
            None => f64::from(u8::from(parameter == FittedParameter::Output(output))),
        }
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
            solve_posture(analysis, &design, &self.outputs, &mut self.cost.borrow_mut()).ok().map(Some)
        };
        self.analyses.iter().zip(&self.nominal).map(of).collect()
    }

    fn rows(&self, postures: &[Option<ReachedPosture>], x: &[f64]) -> Rows {
        let mut rows = Rows { x: x.to_vec(), priors: self.priors.residuals(x), ..Rows::default() };
        for k in &self.compared {
            let reading = &self.readings()[*k];
            let posture =
                postures[reading.posture].as_ref().expect("only postures that are reached are compared");
            let sigma = self.unit(reading);
            let by = |(p, step): (&FittedParameter, &f64)| self.d(posture, reading.output, *p) * step / sigma;
            let value = posture.value(reading.output) + self.offset_of(reading.output, x);
            rows.r.push((value - reading.value) / sigma);
            rows.d.push(self.parameters.iter().zip(&self.steps).map(by).collect());
        }
        rows
    }

    /// Unit of a reading's residual: its standard deviation, or one SI unit.
    pub fn unit(&self, reading: &Reading) -> f64 {
        reading.sigma.filter(|_| self.has_sigmas).unwrap_or(1.0)
    }

    /// Residuals of a design; `None` if a posture is not reached, or the mechanism does not follow all variables.
    fn rows_at(&self, x: &[f64], more: &dyn Fn() -> bool) -> Option<Rows> {
        let rows = self.solve_postures(x, more).map(|postures| self.rows(&postures, x));
        let is_finite = |rows: &Rows| rows.r.iter().chain(rows.d.iter().flatten()).all(|x| x.is_finite());
        let rows = rows.filter(is_finite);
        self.refused.set(self.refused.get() + usize::from(rows.is_none()));
        rows
    }

    /// Standard deviation of the residuals, estimated if none are given, with the number of parameters that the
    /// readings determine.
    fn scale_of(&self, r: &[f64], determined: impl FnOnce() -> f64) -> f64 {
        if self.has_sigmas {
            return 1.0;
        }
        let found = if self.request.loss == Loss::Squares {
            let free = (r.len() as f64 - determined()).max(1.0);
            (r.iter().map(|r| r * r).sum::<f64>() / free).sqrt()
        } else {
            let mut sizes: Vec<f64> = r.iter().map(|r| r.abs()).collect();
            sizes.sort_by(f64::total_cmp);
            quantile(&sizes, 0.5) / MEDIAN_OF_NORMAL
        };
        if found > 0.0 { found } else { 1.0 }
    }

    fn weights(&self, r: &[f64], scale: f64) -> Vec<f64> {
        r.iter().map(|r| self.request.loss.weight(r / scale)).collect()
    }

    /// Directions over the free parameters that the readings and the priors determine.
    pub fn determined(&self, at: &Rows, weights: &[f64], scale: f64, free: &[usize]) -> Determined {
        let n = self.parameters.len();
        let whole = |v: &Vec<f64>, columns: &[Vec<f64>]| {
            let mut whole = vec![0.0; n];
            for (by, column) in v.iter().zip(columns) {
                whole.iter_mut().zip(column).for_each(|(w, c)| *w += by * c);
            }
            whole
        };
        let weighted = |columns: &dyn Fn(&Vec<f64>) -> Vec<f64>| -> Vec<Vec<f64>> {
            let row = |(row, w): (&Vec<f64>, &f64)| columns(row).into_iter().map(|x| w.sqrt() * x).collect();
            at.d.iter().zip(weights).map(row).collect()
        };
        let (found, whitening) = if self.priors.is_empty() {
            (singular(&weighted(&|row| free.iter().map(|k| row[*k]).collect()), free.len()), None)
        } else {
            let columns = self.priors.whitening(free, n);
            let over = |row: &Vec<f64>| columns.iter().map(|c| dot(row, c)).collect::<Vec<f64>>();
            let mut rows = weighted(&over);
            rows.extend(self.priors.a.iter().map(|a| over(a).into_iter().map(|x| scale * x).collect()));
            (singular(&rows, free.len()), Some(columns))
        };
        let least = ROUND_OFF * found.values.first().copied().unwrap_or_default();
        let mut determined = Determined::default();
        for (s, v) in found.values.into_iter().zip(&found.directions) {
            let v = match &whitening {
                Some(columns) => whole(v, columns),
                None => {
                    let mut whole = vec![0.0; n];
                    free.iter().zip(v).for_each(|(k, v)| whole[*k] = *v);
                    whole
                }
            };
            if s > least {
                determined.directions.push((v, s));
            } else {
                determined.nothing.push(v);
            }
        }
        determined
    }

    /// Standard deviation along a direction `(v, |J v|)`, in natural steps, if the direction is not determined.
    pub fn vague_sigma(&self, (v, s): &(Vec<f64>, f64), scale: f64) -> Option<f64> {
        let sigma = scale / s * self.length(v);
        (self.has_sigmas && sigma > VAGUE).then_some(sigma)
    }

    /// Length of a direction; those of a fit with priors are not of unit length.
    pub fn length(&self, v: &[f64]) -> f64 {
        if self.priors.is_empty() { 1.0 } else { dot(v, v).sqrt() }
    }

    /// Component of the residuals along the image of a direction `(v, s)`, with `s = |J v|`: `u . r` with `u = J v
    /// / s`.
    fn component(&self, at: &Rows, weights: &[f64], scale: f64, (v, s): &(Vec<f64>, f64)) -> f64 {
        let of_readings = at.d.iter().zip(&at.r).zip(weights).map(|((row, r), w)| w * r * dot(row, v));
        let of_priors = self.priors.a.iter().zip(&at.priors).map(|(a, r)| scale * scale * r * dot(a, v));
        (of_readings.sum::<f64>() + of_priors.sum::<f64>()) / s
    }

    /// Determined directions over the free parameters that the fit follows, and those that it does not: the design
    /// remains nominal along a direction that is not determined, unless the readings contradict it there.
    fn partitioned(
        &self,
        at: &Rows,
        weights: &[f64],
        scale: f64,
        free: &[usize],
    ) -> [Vec<(Vec<f64>, f64)>; 2] {
        let is_followed = |direction: &(Vec<f64>, f64)| {
            self.vague_sigma(direction, scale).is_none()
                || dot(&direction.0, &at.x).abs() > VAGUE * self.length(&direction.0)
                || self.component(at, weights, scale, direction).abs() > CONTRADICTED * scale
        };
        let (followed, others) =
            self.determined(at, weights, scale, free).directions.into_iter().partition(is_followed);
        [followed, others]
    }

    /// Determined directions over the free parameters that the fit follows.
    fn followed(&self, at: &Rows, weights: &[f64], scale: f64, free: &[usize]) -> Vec<(Vec<f64>, f64)> {
        let [followed, _] = self.partitioned(at, weights, scale, free);
        followed
    }

    /// Number of parameters that the readings determine, as the trace of their part of the information:
    /// `sum |J v|^2 / s^2`; the number of directions without priors. A parameter at its bound is fixed.
    fn effective(&self, x: &[f64], at: &Rows, weights: &[f64], scale: f64) -> f64 {
        let directions = self.determined(at, weights, scale, &free(&self.active_bounds(x))).directions;
        if self.priors.is_empty() {
            return directions.len() as f64;
        }
        directions.iter().map(|(v, s)| information(at, weights, v) / (s * s)).sum()
    }

    /// Undamped step of all parameters at a point.
    fn undamped_step(&self, at: &Rows, weights: &[f64], scale: f64) -> UndampedStep {
        let all: Vec<usize> = (0..self.parameters.len()).collect();
        let directions = self.followed(at, weights, scale, &all);
        let components: Vec<f64> =
            directions.iter().map(|of| self.component(at, weights, scale, of)).collect();
        let by = dot(&components, &components);
        let decrease = if by <= self.round_off { 0.0 } else { by / Self::squares(at, weights, scale) };
        UndampedStep { directions, components, decrease }
    }

    /// Undamped steps from a point whose squares are too inaccurate to be compared with those of its neighbours: the
    /// derivatives determine the steps, and the decrease that they leave is what is compared. True if they end at the
    /// optimum.
    fn last_steps(
        &self,
        (x, at, step): (&mut Vec<f64>, &mut Rows, &mut UndampedStep),
        weights: &[f64],
        scale: f64,
        more: &dyn Fn() -> bool,
    ) -> bool {
        for _ in 0..MOST_LAST_STEPS {
            // Components are sums of numbers as large as the residuals.
            if step.decrease <= SETTLED * SETTLED {
                break;
            }
            let lengths = step.components.iter().zip(&step.directions).map(|(c, (_, s))| -c / s);
            let next = along(x, &step.directions, &lengths.collect::<Vec<f64>>());
            let Some(rows) = self.rows_at(&next, more) else { break };
            let after = self.undamped_step(&rows, weights, scale);
            if after.decrease > CLOSER * step.decrease {
                break;
            }
            (*x, *at, *step) = (next, rows, after);
        }
        step.decrease <= SETTLED
    }

    /// Sum of weighted squares of readings and priors, in squares of the scale.
    fn squares(at: &Rows, weights: &[f64], scale: f64) -> f64 {
        let readings = at.r.iter().zip(weights).map(|(r, w)| w * r * r).sum::<f64>();
        readings + at.priors.iter().map(|r| (scale * r).powi(2)).sum::<f64>()
    }

    /// Fits from the nominal design until no small change improves the fit.
    pub fn search(&self, progress: &mut dyn FnMut(usize, f64), more: &dyn Fn() -> bool) -> SearchResult {
        let n = self.parameters.len();
        let x = vec![0.0; n];
        let at = self.rows(&self.nominal, &x);
        let mut scale = self.scale_of(&at.r, || n as f64);
        let weights = self.weights(&at.r, scale);
        scale = self.scale_of(&at.r, || self.effective(&x, &at, &weights, scale));
        let first = at.clone();
        progress(0, Self::squares(&at, &weights, scale) / (scale * scale));
        let mut state = SearchState { x, at, weights, scale, iterations: Vec::new() };
        let status = self.descend(&mut state, progress, more);
        let SearchState { x, at, weights, scale, iterations } = state;
        let of = |at: &Rows| self.loss_of(&at.r, scale) + at.priors.iter().map(|r| r * r).sum::<f64>();
        let objective = [of(&first), of(&at)];
        let status = match status {
            Status::Found | Status::Stuck | Status::IterationLimit if x.iter().any(|x| x.abs() > RUNAWAY) => {
                Status::Diverged
            }
            Status::Found
            | Status::Stuck
            | Status::IterationLimit
            | Status::Diverged
            | Status::Interrupted => status,
        };
        let active = self.active_bounds(&x);
        SearchResult { status, x, at, weights, active, scale, objective, iterations }
    }

    /// Improves the fit along the directions that it follows until no small change does.
    fn descend(
        &self,
        SearchState { x, at, weights, scale, iterations }: &mut SearchState,
        progress: &mut dyn FnMut(usize, f64),
        more: &dyn Fn() -> bool,
    ) -> Status {
        // Weights of a robust loss follow each step, and bounds limit it.
        let mut near = if self.request.loss == Loss::Squares && !self.is_bounded() { NEAR } else { 0.0 };
        while iterations.len() < self.request.iterations {
            self.refused.set(0);
            let before = Self::squares(at, weights, *scale);
            let mut undamped = self.undamped_step(at, weights, *scale);
            if undamped.decrease <= near {
                if self.last_steps((x, at, &mut undamped), weights, *scale, more) {
                    *scale = self.scale_of(&at.r, || self.effective(x, at, weights, *scale));
                    return Status::Found;
                }
                // Undamped steps do not lead there.
                near = 0.0;
            } else if undamped.decrease <= SETTLED {
                return Status::Found;
            }
            let step = if self.is_bounded() {
                self.bounded_step(x, at, weights, *scale, more)
            } else {
                self.step(x, at, (weights, *scale, near), &undamped.directions, more)
            };
            if !more() {
                return Status::Interrupted;
            }
            let Some((next, rows)) = step.filter(|(_, rows)| Self::squares(rows, weights, *scale) < before)
            else {
                return self.status_at_rest(x, at, weights, *scale);
            };
            let after = Self::squares(&rows, weights, *scale);
            (*x, *at) = (next, rows);
            let scaled_before = *scale;
            *scale = self.scale_of(&at.r, || self.effective(x, at, weights, *scale));
            let old = std::mem::replace(weights, self.weights(&at.r, *scale));
            let settled = weights.iter().zip(&old).all(|(a, b)| (a - b).abs() <= SETTLED.sqrt());
            iterations.push(Self::squares(at, weights, *scale) / (*scale * *scale));
            progress(iterations.len(), *iterations.last().expect("it was just put there"));
            if before - after <= SETTLED * before
                && settled
                && (*scale - scaled_before).abs() <= SETTLED.sqrt() * *scale
            {
                return self.status_at_rest(x, at, weights, *scale);
            }
        }
        Status::IterationLimit
    }

    /// Status of a search without further progress. A design is no optimum if the linearised problem predicts a better
    /// one and designs on the way there were not reached or have no derivatives.
    fn status_at_rest(&self, x: &[f64], at: &Rows, weights: &[f64], scale: f64) -> Status {
        let (rows, right) = self.linearised(at, weights, scale);
        let undamped = |free: &[usize]| self.followed(at, weights, scale, free);
        let best = bounded_least_squares(x, &rows, &right, &self.bounds, &undamped);
        let by: Vec<f64> = best.iter().zip(x).map(|(best, x)| best - x).collect();
        let after: f64 = rows.iter().zip(&right).map(|(row, r)| (dot(row, &by) + r).powi(2)).sum();
        let before = Self::squares(at, weights, scale);
        let is_better = before - after > self.round_off.max(NEAR * before);
        if is_better && self.refused.get() > 0 { Status::Stuck } else { Status::Found }
    }

    /// Weighted derivatives and residuals of readings and priors at a point.
    fn linearised(&self, at: &Rows, weights: &[f64], scale: f64) -> (Vec<Vec<f64>>, Vec<f64>) {
        let mut rows: Vec<Vec<f64>> =
            at.d.iter().zip(weights).map(|(row, w)| row.iter().map(|d| w.sqrt() * d).collect()).collect();
        let mut right: Vec<f64> = at.r.iter().zip(weights).map(|(r, w)| w.sqrt() * r).collect();
        rows.extend(self.priors.a.iter().map(|row| row.iter().map(|a| scale * a).collect()));
        right.extend(at.priors.iter().map(|r| scale * r));
        (rows, right)
    }

    /// Sum of the loss over all residuals.
    fn loss_of(&self, r: &[f64], scale: f64) -> f64 {
        let weight = |r: f64| self.request.loss.weight(r);
        r.iter().map(|r| r / scale).map(|r| weight(r) * r * r).sum()
    }

    /// Better point within the bounds: the solution of the linearised problem, damped until the fit improves; `None` if
    /// it does not.
    fn bounded_step(
        &self,
        x: &[f64],
        at: &Rows,
        weights: &[f64],
        scale: f64,
        more: &dyn Fn() -> bool,
    ) -> Option<(Vec<f64>, Rows)> {
        let before = Self::squares(at, weights, scale);
        let n = x.len();
        let (mut rows, mut right) = self.linearised(at, weights, scale);
        let columns: Vec<f64> =
            (0..n).map(|k| rows.iter().map(|row| row[k] * row[k]).sum::<f64>().sqrt()).collect();
        let undamped = |free: &[usize]| self.followed(at, weights, scale, free);
        let first = bounded_least_squares(x, &rows, &right, &self.bounds, &undamped);
        let better = |x: Vec<f64>| {
            let rows = self.rows_at(&x, more)?;
            (Self::squares(&rows, weights, scale) < before).then_some((x, rows))
        };
        if let Some(found) = better(first) {
            return Some(found);
        }
        let read = rows.len();
        rows.extend((0..n).map(|k| {
            let mut row = vec![0.0; n];
            row[k] = 1.0;
            row
        }));
        right.extend(vec![0.0; n]);
        let mut damping = DAMPING[0];
        for _ in 0..MOST_TRIALS {
            for (k, row) in rows[read..].iter_mut().enumerate() {
                row[k] = damping * if columns[k] > 0.0 { columns[k] } else { 1.0 };
            }
            let damped = |free: &[usize]| {
                let part = |row: &Vec<f64>| free.iter().map(|k| row[*k]).collect::<Vec<f64>>();
                // Without the components along directions that the fit does not follow.
                let [_, others] = self.partitioned(at, weights, scale, free);
                let others: Vec<Vec<f64>> = others.iter().map(|(v, _)| part(v)).collect();
                let span = &singular(&others, free.len()).directions[..others.len()];
                let without = |row: &Vec<f64>| {
                    span.iter().fold(part(row), |row, v| {
                        let by = dot(&row, v);
                        row.iter().zip(v).map(|(x, v)| x - by * v).collect()
                    })
                };
                let found = singular(&rows.iter().map(without).collect::<Vec<_>>(), free.len());
                let whole = |(s, v): (f64, &Vec<f64>)| {
                    let mut whole = vec![0.0; n];
                    free.iter().zip(v).for_each(|(k, v)| whole[*k] = *v);
                    (whole, s)
                };
                let followed = free.len() - others.len();
                found.values.into_iter().zip(&found.directions).take(followed).map(whole).collect()
            };
            let next = bounded_least_squares(x, &rows, &right, &self.bounds, &damped);
            if let Some(found) = better(next) {
                return Some(found);
            }
            if !more() {
                return None;
            }
            damping *= DAMPING[1];
        }
        None
    }

    /// Best fit with fixed weights over some directions, starting at x, or a point whose undamped step decreases the
    /// squares by no more than the fraction `near`; `None` if there is none.
    fn step(
        &self,
        x: &[f64],
        at: &Rows,
        (weights, prior_scale, near): (&[f64], f64, f64),
        directions: &[(Vec<f64>, f64)],
        more: &dyn Fn() -> bool,
    ) -> Option<(Vec<f64>, Rows)> {
        if directions.is_empty() {
            return None;
        }
        let roots: Vec<f64> = weights.iter().map(|w| w.sqrt()).collect();
        let (readings, priors) = (roots.len(), at.priors.len());
        let of_readings = at.r.iter().zip(&roots).map(|(r, w)| (w * r).powi(2)).sum::<f64>();
        let size = (of_readings + at.priors.iter().map(|r| (prior_scale * r).powi(2)).sum::<f64>()).sqrt();
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
                    Some(rows) => {
                        let of_priors = rows.priors.iter().map(|r| scale * prior_scale * r);
                        rows.r.iter().zip(&roots).map(residual).chain(of_priors).collect()
                    }
                    None => vec![f64::NAN; readings + priors],
                },
            )
        };
        let derivatives = |z: &[f64]| {
            recent.at(
                z,
                || find(z),
                |rows| {
                    let entry = |i: usize, j: usize| {
                        if i >= readings {
                            return scale * prior_scale * dot(&self.priors.a[i - readings], &directions[j].0);
                        }
                        let by = |rows: &Rows| dot(&rows.d[i], &directions[j].0);
                        rows.as_ref().map_or(f64::NAN, |rows| scale * roots[i] * by(rows))
                    };
                    let row = |i: usize| (0..n).map(|j| entry(i, j)).collect();
                    (0..readings + priors).map(row).collect()
                },
            )
        };
        // Directions are as long as their priors are narrow.
        let farthest = FARTHEST * self.priors.strongest(self.parameters.len());
        let bounds = [-farthest, farthest];
        let mut solver = LeastSquares::new(&none, bounds, Box::new(residuals), Box::new(derivatives));
        // A robust loss needs new weights after every iteration; squares keep theirs.
        let most = if self.request.loss == Loss::Squares { self.request.iterations } else { 1 };
        let is_near = |rows: &Option<Rows>| {
            rows.as_ref().is_none_or(|rows| self.undamped_step(rows, weights, prior_scale).decrease <= near)
        };
        let mut z = none;
        for iteration in 1..=most {
            let Some(next) = solver.step() else { break };
            z = next;
            if iteration == most || recent.at(&z, || find(&z), is_near) {
                break;
            }
        }
        let rows = recent.at(&z, || find(&z), Option::clone)?;
        Some((place(&z), rows))
    }
}

/// Part of the readings in the information about a direction: `sum w (J v)^2`.
pub(super) fn information(at: &Rows, weights: &[f64], v: &[f64]) -> f64 {
    at.d.iter().zip(weights).map(|(row, w)| w * dot(row, v).powi(2)).sum()
}

/// Indices of the parameters that no bound fixes.
pub(super) fn free(active: &[Option<BoundSide>]) -> Vec<usize> {
    (0..active.len()).filter(|k| active[*k].is_none()).collect()
}

/// Fitted variables of a request, then its offsets.
fn parameters_of_request(model: &Model, request: &Request<'_>) -> Vec<FittedParameter> {
    let variables = request.variables.iter().map(|v| FittedParameter::Variable(*v));
    variables.chain(parameters_of(model, &request.prior.offsets)).collect()
}

fn along(x: &[f64], directions: &[(Vec<f64>, f64)], z: &[f64]) -> Vec<f64> {
    let by = |k: usize| directions.iter().zip(z).map(|((v, _), z)| v[k] * z).sum::<f64>();
    x.iter().enumerate().map(|(k, x)| x + by(k)).collect()
}
