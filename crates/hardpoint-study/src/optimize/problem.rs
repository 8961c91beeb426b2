//! Optimisation problem of a search: goals and limits as numbers, with their exact derivatives.

use std::ops::Range;

use crate::evaluation::{DesignEvaluation, Motions, StudyCost};
use hardpoint::model::{CurvePart, Limit, LimitTarget, Metric, Model, OptimizationSettings, VariableId};
use hardpoint::motion::{Motion, StopKind};
use hardpoint::number::Dual;
use hardpoint::run::{MarginDerivatives, MetricParts, MetricUse, Solution, misfits, peaks};
use hardpoint::sensitivity::Admissibility;
use hardpoint_difference::Magnitude;

/// Misfits below this fraction of their change over the bounds of the most influential variable are round-off: motions
/// are solved to about 1e-14.
pub(crate) const MET: f64 = 1e-12;

/// Goals and limits of an optimisation, and the motions that they are evaluated in.
#[derive(Clone, Debug)]
pub(crate) struct Problem<'m> {
    /// Model with all of its cases.
    pub model: &'m Model,
    pub motions: &'m Motions<'m>,
    pub settings: &'m OptimizationSettings,
    /// Bounds of each searched variable, in its unit.
    pub bounds: Vec<[f64; 2]>,
    /// Goals in each motion.
    pub goals: Vec<MotionMetric>,
    /// Index of each limit, and what it applies to.
    pub limits: Vec<(usize, Limited)>,
    /// Uses of the metrics of each motion.
    pub uses: Vec<Vec<MetricUse>>,
}

/// A metric in one motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MotionMetric {
    /// Index of the goal or limit.
    pub of: usize,
    pub motion: usize,
    /// Index among the metrics of that motion.
    pub metric: usize,
}

/// Subject of a limit.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Limited {
    /// The design itself.
    Design,
    Metric(MotionMetric),
    /// The margin of this motion to a singular position.
    Margin(usize),
}

impl Limited {
    pub fn motion(self) -> Option<usize> {
        match self {
            Self::Design => None,
            Self::Metric(metric) => Some(metric.motion),
            Self::Margin(motion) => Some(motion),
        }
    }
}

/// A margin has derivatives if it is not more than this above its limit; elsewhere the limit is out of reach of a step.
const NEAR_LIMIT: f64 = 0.1;

/// Numbers with their derivatives by the searched variables, SI and per unit of each.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rows {
    pub values: Vec<f64>,
    pub d: Vec<Vec<f64>>,
}

impl Rows {
    pub fn push(&mut self, value: f64, d: Vec<f64>) {
        self.values.push(value);
        self.d.push(d);
    }

    pub fn greatest(&self) -> f64 {
        self.values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }
}

/// Evaluated design of a search.
#[derive(Clone, Debug, Default)]
pub(crate) struct Point {
    /// Values of all variables of the model.
    pub design: Vec<f64>,
    /// Weighted residuals of squared goals.
    pub misfits: Rows,
    /// Misfits that have corners.
    pub extrema: Vec<Extremum>,
    /// Weighted values of linear goals that depend smoothly on the design.
    pub plain: Rows,
    /// Weighted candidates for the maximum, for goals on a maximum.
    pub peaks: Vec<Rows>,
    /// Rows of each goal in each motion, in the order of [`Problem::goals`].
    pub shares: Vec<GoalShare>,
    /// Rows of the limits: index of the limit, and excess in its unit.
    pub limits: Vec<LimitRow>,
    /// Candidates for both ends of curves with a limited range.
    pub spreads: Vec<Spread>,
    /// Residuals of limits on the root of a sum of squares, by the index in [`Problem::limits`].
    pub limit_residuals: Vec<(usize, Rows)>,
    /// Values of the goals, in the order of [`Problem::goals`].
    pub goal_values: Vec<f64>,
    /// Values of the limits, in the order of [`Problem::limits`].
    pub limit_values: Vec<f64>,
    /// Minimum margin to a singular position over all motions, if known.
    pub margin: Option<f64>,
}

/// Rows of one goal in one motion: ranges of [`Point::misfits`], [`Point::plain`] and [`Point::peaks`].
#[derive(Clone, Debug)]
pub(crate) struct GoalShare {
    pub misfits: Range<usize>,
    pub plain: Range<usize>,
    pub peaks: Range<usize>,
    /// Largest change of their numbers that is still round-off.
    pub round_off: f64,
}

/// Distance of a maximum or minimum of a curve from its target: the largest of several smooth numbers.
#[derive(Clone, Debug)]
pub(crate) struct Extremum {
    /// Index of its residual in [`Point::misfits`].
    pub misfit: usize,
    /// Weighted distances of all candidates beyond the target, and that of the extremum which falls short of it.
    pub rows: Rows,
}

/// Limit, or one of several numbers that it applies to.
#[derive(Clone, Debug)]
pub(crate) struct LimitRow {
    /// Index in [`Problem::limits`].
    pub of: usize,
    /// Excess over the limit, at most 0 if it is satisfied; for an equality, its deviation.
    pub exceeds: f64,
    pub d: Vec<f64>,
    pub equal: bool,
    /// True for the upper end.
    pub upper: bool,
    /// True if a [`Spread`] describes its dependence on the design in more detail.
    pub spread: bool,
}

/// Range of a curve with a limit: maximum minus minimum.
#[derive(Clone, Debug)]
pub(crate) struct Spread {
    /// Index in [`Problem::limits`].
    pub of: usize,
    pub most: f64,
    /// Candidates for the maximum, and candidates for the minimum with negative sign.
    pub ends: [Rows; 2],
}

/// Reason why a design cannot be evaluated.
#[derive(Clone, Debug)]
pub(crate) struct Refusal {
    /// Index of the motion, if one failed.
    pub motion: Option<usize>,
    pub why: String,
    /// True if the caller ended the evaluation.
    pub interrupted: bool,
}

impl Point {
    /// Value of the objective.
    pub fn objective(&self) -> f64 {
        let squares: f64 = self.misfits.values.iter().map(|r| r * r).sum();
        let plain: f64 = self.plain.values.iter().sum();
        squares + plain + self.peaks.iter().map(Rows::greatest).sum::<f64>()
    }

    /// True if all goals are squares.
    pub fn has_only_squares(&self) -> bool {
        self.plain.values.is_empty() && self.peaks.is_empty()
    }

    /// True if all goals are squares and only bounds limit the design.
    pub fn is_squares(&self) -> bool {
        self.has_only_squares() && self.limits.is_empty()
    }

    /// The misfits without corners.
    pub fn smooth_misfits(&self) -> Rows {
        let is_smooth = |k: &usize| self.extrema.iter().all(|extremum| extremum.misfit != *k);
        let smooth = || (0..self.misfits.values.len()).filter(is_smooth);
        Rows {
            values: smooth().map(|k| self.misfits.values[k]).collect(),
            d: smooth().map(|k| self.misfits.d[k].clone()).collect(),
        }
    }

    /// The smooth part of the goals: without maxima, and without distances from a target that have corners.
    pub fn smooth(&self) -> Self {
        let (peaks, extrema) = (Vec::new(), Vec::new());
        Self { misfits: self.smooth_misfits(), peaks, extrema, ..self.clone() }
    }

    /// Effect of every searched variable on the goals: the largest change of a number over its bounds, to first order,
    /// as a multiple of what is round-off.
    pub fn effects(&self, problem: &Problem<'_>) -> Vec<f64> {
        let rows = || [&self.misfits, &self.plain].into_iter().chain(&self.peaks);
        let size = rows().flat_map(|rows| &rows.values).fold(0.0, |most: f64, value| most.max(value.abs()));
        let mut effects = vec![0.0_f64; problem.bounds.len()];
        for share in &self.shares {
            let round_off = share.round_off.max(MET * size);
            let extrema = self.extrema.iter().filter(|e| share.misfits.contains(&e.misfit));
            let candidates = self.peaks[share.peaks.clone()].iter().chain(extrema.map(|e| &e.rows));
            let own = [&self.misfits.d[share.misfits.clone()], &self.plain.d[share.plain.clone()]];
            for d in own.into_iter().chain(candidates.map(|rows| &rows.d[..])).flatten() {
                for (effect, (d, [low, high])) in effects.iter_mut().zip(d.iter().zip(&problem.bounds)) {
                    *effect = effect.max((d * (high - low)).abs() / round_off);
                }
            }
        }
        effects
    }

    /// True if all goals are constant to first order, up to round-off.
    pub fn is_constant(&self, problem: &Problem<'_>) -> bool {
        self.effects(problem).iter().all(|effect| *effect <= 1.0)
    }

    /// True if all goals are squares of numbers that are round-off.
    pub fn is_round_off(&self) -> bool {
        let size = |share: &GoalShare| {
            self.misfits.values[share.misfits.clone()].iter().map(|r| r * r).sum::<f64>().sqrt()
        };
        self.has_only_squares() && self.shares.iter().all(|share| size(share) <= share.round_off)
    }

    /// Norm of the misfits.
    pub fn misfit(&self) -> f64 {
        self.misfits.values.iter().map(|r| r * r).sum::<f64>().sqrt()
    }

    /// Gradient of the objective by the searched variables. For a goal on a maximum, it is that of the first candidate
    /// that attains the maximum.
    pub fn gradient(&self, variables: usize) -> Vec<f64> {
        let mut g = vec![0.0; variables];
        let mut add = |by: f64, d: &[f64]| g.iter_mut().zip(d).for_each(|(g, d)| *g += by * d);
        for (r, d) in self.misfits.values.iter().zip(&self.misfits.d) {
            add(2.0 * r, d);
        }
        self.plain.d.iter().for_each(|d| add(1.0, d));
        for rows in &self.peaks {
            let most = rows.greatest();
            if let Some(k) = rows.values.iter().position(|v| *v == most) {
                add(1.0, &rows.d[k]);
            }
        }
        g
    }

    /// Largest violation of a limit as a fraction of its scale; 0 if all are satisfied.
    pub fn violation(&self, scale: impl Fn(usize) -> f64) -> f64 {
        let exceeds = |row: &LimitRow| if row.equal { row.exceeds.abs() } else { row.exceeds.max(0.0) };
        self.limits.iter().map(|row| exceeds(row) / scale(row.of)).fold(0.0, f64::max)
    }
}

impl<'m> Problem<'m> {
    pub fn new(model: &'m Model, motions: &'m Motions<'m>, settings: &'m OptimizationSettings) -> Self {
        let entry = |of: usize, metric: usize| {
            let Model { metrics, .. } = model;
            let wanted = &metrics[metric];
            let motion = move |motion: usize| {
                let metric = motions.model(motion).metrics.iter().position(|m| m.name == wanted.name)?;
                Some(MotionMetric { of, motion, metric })
            };
            (0..motions.len()).filter_map(motion)
        };
        let goals: Vec<MotionMetric> =
            settings.goals.iter().enumerate().flat_map(|(k, goal)| entry(k, goal.metric)).collect();
        let limit = |(k, limit): (usize, &Limit)| match limit.of {
            LimitTarget::Metric(metric) => {
                entry(k, metric).map(|t| (k, Limited::Metric(t))).collect::<Vec<_>>()
            }
            LimitTarget::Margin => (0..motions.len()).map(|motion| (k, Limited::Margin(motion))).collect(),
            LimitTarget::Coordinate(..) | LimitTarget::Distance(..) | LimitTarget::Length(_) => {
                vec![(k, Limited::Design)]
            }
        };
        let limits: Vec<(usize, Limited)> = settings.limits.iter().enumerate().flat_map(limit).collect();
        let unused = |motion: usize| vec![MetricUse::Unused; motions.model(motion).metrics.len()];
        let mut uses: Vec<Vec<MetricUse>> = (0..motions.len()).map(unused).collect();
        // Of a value at a target, and of the range of a curve there, the derivative is enough.
        let has_candidates = |entry: &&MotionMetric| {
            let take = &motions.model(entry.motion).metrics[entry.metric].take;
            settings.goals[entry.of].target.is_none() || take.extrema().len() == 1
        };
        let by_value = goals.iter().filter(|entry| !has_candidates(entry));
        let by_candidates = goals.iter().filter(has_candidates);
        for entry in by_value {
            uses[entry.motion][entry.metric] = MetricUse::Derivative;
        }
        let limited = limits.iter().filter_map(|(_, of)| match of {
            Limited::Metric(entry) => Some(entry),
            Limited::Design | Limited::Margin(_) => None,
        });
        for entry in by_candidates.chain(limited) {
            uses[entry.motion][entry.metric] = MetricUse::Candidates;
        }
        let bounds = |v: &VariableId| model.variables[v.0].bounds.unwrap_or([0.0; 2]);
        Self {
            bounds: settings.variables.iter().map(bounds).collect(),
            model,
            motions,
            settings,
            goals,
            limits,
            uses,
        }
    }

    /// Values of all variables, with the searched ones given as fractions of their bounds: 0 at the lower and 1 at the
    /// upper bound.
    pub fn design(&self, parts: &[f64]) -> Vec<f64> {
        let mut design = vec![0.0; self.model.variables.len()];
        for ((v, [low, high]), part) in self.settings.variables.iter().zip(&self.bounds).zip(parts) {
            design[v.0] = (low + (high - low) * part).clamp(*low, *high);
        }
        design
    }

    /// Lengths of the bounds of the searched variables.
    pub fn spans(&self) -> Vec<f64> {
        self.bounds.iter().map(|[low, high]| high - low).collect()
    }

    /// Searched variables as fractions of their bounds.
    pub fn parts(&self, design: &[f64]) -> Vec<f64> {
        let part = |(v, [low, high]): (&VariableId, &[f64; 2])| (design[v.0] - low) / (high - low);
        self.settings.variables.iter().zip(&self.bounds).map(part).collect()
    }

    /// Values and gradients of the limits on the design itself, in the order of [`Problem::limits`].
    fn of_design(&self, design: &[f64]) -> Vec<(f64, Vec<f64>)> {
        let limits = self.limits.iter().filter(|(_, of)| matches!(of, Limited::Design));
        let targets: Vec<LimitTarget> = limits.map(|(k, _)| self.settings.limits[*k].of).collect();
        let has_lengths = targets.iter().any(|of| matches!(of, LimitTarget::Length(_)));
        let has_places = targets.iter().any(|of| !matches!(of, LimitTarget::Length(_)));
        let map = self.motions.analyses()[0].design_map();
        let mut found = vec![(f64::NAN, Vec::new()); targets.len()];
        // The geometry by a variable is that of all limits.
        for v in self.settings.variables.iter().filter(|_| !targets.is_empty()) {
            let mut values: Vec<Dual> = design.iter().map(|b| Dual::constant(*b)).collect();
            values[v.0] = Dual::variable(design[v.0]);
            let places = if has_places { map.places(&values) } else { Vec::new() };
            let kept = if has_lengths { map.geometry(&values).kept } else { Vec::new() };
            for ((value, d), of) in found.iter_mut().zip(&targets) {
                let x = match *of {
                    LimitTarget::Coordinate(h, axis) => places[h.0][axis],
                    LimitTarget::Distance(a, b) => (places[a.0] - places[b.0]).norm(),
                    LimitTarget::Length(joint) => kept[joint.0].distance,
                    LimitTarget::Metric(_) | LimitTarget::Margin => {
                        unreachable!("it is taken of a motion")
                    }
                };
                *value = x.v;
                d.push(x.d);
            }
        }
        found
    }

    /// Evaluates a design.
    pub fn at(
        &self,
        design: Vec<f64>,
        cost: &mut StudyCost,
        more: &(dyn Fn() -> bool + Sync),
    ) -> Result<Point, Refusal> {
        let found = self.motions.evaluate_metrics(&design, &self.uses, cost, more).map_err(|rejected| {
            Refusal { motion: Some(rejected.motion), interrupted: rejected.interrupted(), why: rejected.why }
        })?;
        let margins = found.solutions.iter().filter_map(|s| Some(s.motion.least_margin()?.1.value));
        let mut point = Point { design, margin: margins.reduce(f64::min), ..Point::default() };
        let magnitude = |(motion, solution): (usize, &Solution)| {
            Magnitude::of_settled_motion(self.motions.model(motion), &solution.motion)
        };
        let magnitudes: Vec<Magnitude> = found.solutions.iter().enumerate().map(magnitude).collect();
        for entry in &self.goals {
            let counts = |p: &Point| [p.misfits.values.len(), p.plain.values.len(), p.peaks.len()];
            let before = counts(&point);
            self.add_goal(*entry, &found, &mut point)?;
            let after = counts(&point);
            let [misfits, plain, peaks] = [0, 1, 2].map(|k| before[k]..after[k]);
            let model = self.motions.model(entry.motion);
            let (metric, value) = (&model.metrics[entry.metric], point.goal_values.last().copied());
            let round_off = magnitudes[entry.motion].metric_round_off(model, metric, value);
            let round_off = self.settings.goals[entry.of].weight.abs() * round_off;
            point.shares.push(GoalShare { misfits, plain, peaks, round_off });
        }
        let mut of_design = self.of_design(&point.design).into_iter();
        for (place, (limit, of)) in self.limits.iter().enumerate() {
            match *of {
                Limited::Design => {
                    let value = of_design.next().expect("every limit on the design has a value");
                    self.add_limit(place, *limit, value, None, &found, &mut point);
                }
                Limited::Metric(entry) => {
                    let value = self.metric(entry, &found)?;
                    self.add_limit(place, *limit, value, Some(entry), &found, &mut point);
                    self.check_limit(place, entry, &found, &mut point)?;
                }
                Limited::Margin(motion) => self.add_margins(place, *limit, motion, &found, &mut point)?,
            }
        }
        Ok(point)
    }

    /// Adds the margin of a motion to a singular position at every output time.
    fn add_margins(
        &self,
        place: usize,
        limit: usize,
        motion: usize,
        found: &DesignEvaluation,
        point: &mut Point,
    ) -> Result<(), Refusal> {
        let least = self.settings.limits[limit].least.unwrap_or(0.0);
        let of_motion = &found.solutions[motion].motion.margins;
        let below = least + NEAR_LIMIT;
        let mut derived = MarginDerivatives::default();
        if of_motion.iter().any(|margin| !(margin.value >= below)) {
            let analysis = &self.motions.analyses()[motion];
            derived = analysis.margin_derivatives(&point.design, &self.settings.variables, below);
        }
        if let Some(stop) = &derived.stop {
            let why = stop.headline(self.motions.model(motion));
            let interrupted = matches!(stop.kind, StopKind::Interrupted);
            return Err(Refusal { motion: Some(motion), why, interrupted });
        }
        let margins = if derived.margins.is_empty() { of_motion } else { &derived.margins };
        for (k, margin) in margins.iter().enumerate() {
            let d = derived.d.get(k).filter(|d| !d.is_empty());
            let d = d.map_or(vec![0.0; self.bounds.len()], |d| d.iter().map(|d| -d).collect());
            let exceeds = least - margin.value;
            point.limits.push(LimitRow { of: place, exceeds, d, equal: false, upper: false, spread: false });
        }
        point.limit_values.push(margins.iter().map(|m| m.value).fold(1.0, f64::min));
        Ok(())
    }

    fn add_goal(
        &self,
        entry: MotionMetric,
        found: &DesignEvaluation,
        point: &mut Point,
    ) -> Result<(), Refusal> {
        let goal = &self.settings.goals[entry.of];
        let (value, d) = self.metric(entry, found)?;
        point.goal_values.push(value);
        let metric = &self.motions.model(entry.motion).metrics[entry.metric];
        let by = |x: f64, d: &[f64]| (goal.weight * x, d.iter().map(|d| goal.weight * d).collect::<Vec<_>>());
        let parts = |parts: Option<MetricParts>, sign: f64| {
            let mut rows = Rows::default();
            for (x, d) in parts.iter().flat_map(|p| p.values.iter().zip(&p.d)) {
                let (x, d) = by(sign * x, &self.searched(d).iter().map(|d| sign * d).collect::<Vec<_>>());
                rows.push(x, d);
            }
            rows
        };
        let (model, solution) = (self.motions.model(entry.motion), &found.solutions[entry.motion]);
        let peaks = |sign: f64| parts(peaks(model, solution, metric, sign), sign);
        let signs = if solution.motion.len() > 1 { metric.take.extrema() } else { &[] };
        if metric.take.target().is_some() {
            let Rows { values, d } = parts(misfits(model, solution, metric), 1.0);
            point.misfits.values.extend(values);
            point.misfits.d.extend(d);
        } else if let Some(target) = goal.target {
            let (x, row) = by(value - target, &d);
            if let [sign] = signs {
                let mut rows = peaks(*sign);
                rows.values.iter_mut().for_each(|value| *value -= sign * goal.weight * target);
                rows.push(-sign * x, row.iter().map(|d| -sign * d).collect());
                point.extrema.push(Extremum { misfit: point.misfits.values.len(), rows });
            }
            point.misfits.push(x, row);
        } else if signs.contains(&1.0) {
            point.peaks.extend(signs.iter().map(|sign| peaks(*sign)));
        } else {
            let (x, d) = by(value, &d);
            point.plain.push(x, d);
        }
        self.finite(entry.motion, &metric.name, point)
    }

    fn add_limit(
        &self,
        place: usize,
        limit: usize,
        (value, d): (f64, Vec<f64>),
        entry: Option<MotionMetric>,
        found: &DesignEvaluation,
        point: &mut Point,
    ) {
        let settings = &self.settings.limits[limit];
        point.limit_values.push(value);
        let negative = |d: &[f64]| d.iter().map(|d| -d).collect::<Vec<_>>();
        let mut push = |exceeds: f64, d: Vec<f64>, equal: bool, upper: bool| {
            point.limits.push(LimitRow { of: place, exceeds, d, equal, upper, spread: false });
        };
        if let (Some(least), Some(most)) = (settings.least, settings.most)
            && least == most
        {
            push(value - most, d, true, true);
            return;
        }
        if let Some(entry) = entry {
            let (model, solution) = (self.motions.model(entry.motion), &found.solutions[entry.motion]);
            let residuals = misfits(model, solution, &model.metrics[entry.metric]);
            point.limit_residuals.extend(residuals.map(|parts| (place, self.rows(&parts, 1.0))));
        }
        // The time of a maximum varies with the design, so all candidates are kept within the limit.
        let parts = |extrema: &[f64], sign: f64| {
            let entry = entry?;
            let (model, solution) = (self.motions.model(entry.motion), &found.solutions[entry.motion]);
            let metric = &model.metrics[entry.metric];
            let has = metric.take.extrema() == extrema && solution.motion.len() > 1;
            if has { peaks(model, solution, metric, sign) } else { None }
        };
        let all = |sign: f64| parts(&[sign], sign);
        for (end, sign) in [(settings.most, 1.0), (settings.least, -1.0)] {
            let Some(end) = end else { continue };
            match all(sign) {
                Some(parts) => {
                    for (x, d) in parts.values.iter().zip(&parts.d) {
                        let d = self.searched(d);
                        let d = if sign < 0.0 { negative(&d) } else { d };
                        push(sign * (x - end), d, false, sign > 0.0);
                    }
                }
                None => {
                    let d = if sign < 0.0 { negative(&d) } else { d.clone() };
                    push(sign * (value - end), d, false, sign > 0.0);
                }
            }
        }
        let ends = parts(&[1.0, -1.0], 1.0).zip(parts(&[1.0, -1.0], -1.0));
        if let (Some(most), Some((high, low))) = (settings.most, ends) {
            let ends = [self.rows(&high, 1.0), self.rows(&low, -1.0)];
            point.spreads.push(Spread { of: place, most, ends });
            if let Some(row) = point.limits.iter_mut().rfind(|row| row.of == place && row.upper) {
                row.spread = true;
            }
        }
    }

    /// Parts of a metric with their derivatives by the searched variables, times a sign.
    fn rows(&self, parts: &MetricParts, sign: f64) -> Rows {
        Rows {
            values: parts.values.iter().map(|x| sign * x).collect(),
            d: parts.d.iter().map(|d| self.searched(d).iter().map(|d| sign * d).collect()).collect(),
        }
    }

    /// A metric with its derivatives by the searched variables.
    fn metric(&self, entry: MotionMetric, found: &DesignEvaluation) -> Result<(f64, Vec<f64>), Refusal> {
        let value = &found.metrics[entry.motion][entry.metric];
        let (model, solution) = (self.motions.model(entry.motion), &found.solutions[entry.motion]);
        let Some(x) = value.value else {
            let why = without_value(&model.metrics[entry.metric], &solution.motion);
            return Err(Refusal { motion: Some(entry.motion), why, interrupted: false });
        };
        let d = self.searched(&value.d);
        match d.iter().position(|d| !d.is_finite()) {
            Some(v) => Err(self.without_derivative(entry, v, solution)),
            None => Ok((x, d)),
        }
    }

    /// Rejects a design that exceeds a limit at a place without derivatives, from which no direction is known.
    /// Elsewhere such a place keeps the limit, and is constant to first order.
    fn check_limit(
        &self,
        place: usize,
        entry: MotionMetric,
        found: &DesignEvaluation,
        point: &mut Point,
    ) -> Result<(), Refusal> {
        for row in point.limits.iter_mut().filter(|row| row.of == place) {
            let Some(v) = row.d.iter().position(|d| !d.is_finite()) else { continue };
            if row.equal || row.exceeds > 0.0 {
                return Err(self.without_derivative(entry, v, &found.solutions[entry.motion]));
            }
            row.d.fill(0.0);
        }
        Ok(())
    }

    /// Reason why a metric has no derivative by a searched variable.
    fn without_derivative(&self, entry: MotionMetric, searched: usize, solution: &Solution) -> Refusal {
        let model = self.motions.model(entry.motion);
        let Metric { name, of, over, .. } = &model.metrics[entry.metric];
        let searched = self.settings.variables[searched];
        let variable = &self.model.variables[searched.0].name;
        let known = solution.sensitivities.admissibility.get(searched.0);
        let why = if matches!(known, Some(Admissibility::CannotFollow { .. })) {
            "which the mechanism cannot follow".to_owned()
        } else {
            let over = over.map_or(String::new(), |over| format!(" or `{}`", model.output_name(over)));
            format!("since `{}`{over} has none there", model.output_name(*of))
        };
        let why = format!("metric `{name}` has no derivative by `{variable}`, {why}");
        Refusal { motion: Some(entry.motion), why, interrupted: false }
    }

    fn searched(&self, d: &[f64]) -> Vec<f64> {
        self.settings.variables.iter().map(|v| d[v.0]).collect()
    }

    /// Rejects points with a number that is not finite.
    fn finite(&self, motion: usize, metric: &str, point: &Point) -> Result<(), Refusal> {
        let Point { misfits, plain, peaks, .. } = point;
        let mut all = [misfits, plain].into_iter().chain(peaks);
        let finite = all.all(|rows| rows.values.iter().chain(rows.d.iter().flatten()).all(|x| x.is_finite()));
        let why = match finite {
            true if point.objective().is_finite() => return Ok(()),
            true => format!("the square of metric `{metric}` with its weight is too large for a number"),
            false => format!("metric `{metric}` has parts without value or derivative"),
        };
        Err(Refusal { motion: Some(motion), why, interrupted: false })
    }
}

/// Reason why a metric has no value in a motion.
fn without_value(metric: &Metric, motion: &Motion) -> String {
    let name = &metric.name;
    match metric.take.part() {
        CurvePart::Path(_) if motion.len() == 1 => format!(
            "metric `{name}` is taken along a path, and the motion has a single output time: give it more in \
             `[time]`, or take its value or `rms_at_points`"
        ),
        CurvePart::Path(_) if metric.over.is_some() => {
            format!("the abscissa of metric `{name}` does not move, or not within its window")
        }
        CurvePart::Path(_) | CurvePart::Extrema(_) | CurvePart::Ends => {
            format!("the motion does not reach the window of metric `{name}`")
        }
        CurvePart::Place { .. } => {
            format!("the motion does not reach the place where metric `{name}` is taken")
        }
        CurvePart::Points(_) => {
            format!("the motion does not reach all points of the target of metric `{name}`")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_models::crank_rocker;
    use hardpoint::law::Law;
    use hardpoint::model::{CaseId, Goal, HardpointId, JointId, Metric, OutputSource, PointId, Reduction};
    use hardpoint::topology::Formulation;

    /// Step of central differences, as a fraction of the bounds. For a smooth function they are accurate to this
    /// fraction of the largest number: truncation by `step^2` times the third derivative, and round-off divided by the
    /// step.
    const STEP: f64 = 1e-5;
    const AGREES: f64 = 1e-7;

    /// A crank-rocker in two cases: its coupler with a point, its rod a distance joint, and metrics of every kind.
    fn four_bar() -> Model {
        let mut draft = crank_rocker().times((0..=40).map(|k| 0.05 * f64::from(k)));
        for (k, name) in ["A", "B", "C", "D"].into_iter().enumerate() {
            draft = draft.variable_moving(name, name, [1.0, 0.3 * k as f64, 0.0]);
        }
        let mut model = Model::from_draft(&draft).unwrap();
        model.variables.iter_mut().for_each(|v| v.bounds = Some([-0.02, 0.03]));
        let of = |k: usize| OutputSource::Point(PointId(0), k);
        let metric = |name: &str, take: Reduction, over: Option<usize>| Metric {
            name: name.into(),
            of: of(0),
            over: over.map(of),
            take,
            window: None,
            case: None,
        };
        model.metrics = vec![
            metric("fit", Reduction::Rms(vec![[0.0, 0.2], [2.0, 0.4]]), None),
            metric("path", Reduction::Rms(vec![[0.3, 0.2], [0.6, 0.4]]), Some(1)),
            metric("most", Reduction::Greatest, None),
            metric("least", Reduction::Least, None),
            metric("range", Reduction::Range, None),
            metric("mean", Reduction::Mean, None),
            metric("work", Reduction::Integral, Some(1)),
            metric("at", Reduction::Value(0.73), None),
            metric("slope", Reduction::Slope(0.31), None),
        ];
        let case = |name: &str, law: &str| hardpoint::model::Case {
            formulas: Vec::new(),
            name: name.into(),
            laws: vec![Some(Law::parse(law).unwrap())],
            force_laws: Vec::new(),
            times: model.times.clone(),
            load_mode: None,
        };
        model.cases = vec![case("slow", "t"), case("fast", "3*t")];
        model.metrics[6].case = Some(CaseId(1));
        model
    }

    fn everything() -> OptimizationSettings {
        let goal =
            |metric: usize, target: Option<f64>| Goal { name: String::new(), metric, target, weight: 1.7 };
        let limit = |of: LimitTarget, least: f64, most: f64| Limit {
            name: String::new(),
            of,
            least: Some(least),
            most: Some(most),
        };
        OptimizationSettings {
            variables: (0..4).map(VariableId).collect(),
            goals: (0..8)
                .map(|k| goal(k, None))
                .chain([goal(2, Some(0.1)), goal(3, Some(0.2)), goal(4, Some(0.2)), goal(7, Some(0.3))])
                .collect(),
            limits: (2..8)
                .map(|k| limit(LimitTarget::Metric(k), -0.4, 0.7))
                .chain([
                    limit(LimitTarget::Coordinate(HardpointId(1), 0), 0.0, 0.1),
                    limit(LimitTarget::Distance(HardpointId(1), HardpointId(3)), 0.1, 0.2),
                    limit(LimitTarget::Length(JointId(2)), 0.4, 0.4),
                ])
                .collect(),
            starts: 1,
            other_assemblies: false,
            both_senses: false,
            iterations: 1,
            trade_off: Vec::new(),
        }
    }

    /// All numbers of a point with their derivatives; for the misfits the sum of their squares, since their nodes are
    /// the turning points of each design's own path.
    fn numbers(point: &Point) -> Vec<(f64, Vec<f64>)> {
        let rows = |rows: &Rows| rows.values.iter().copied().zip(rows.d.iter().cloned()).collect::<Vec<_>>();
        let squares = Point { misfits: point.misfits.clone(), ..Point::default() };
        let mut all = vec![(squares.misfit().powi(2), squares.gradient(point.misfits.d[0].len()))];
        all.extend(rows(&point.plain));
        all.extend(point.peaks.iter().flat_map(rows));
        all.extend(point.extrema.iter().flat_map(|extremum| rows(&extremum.rows)));
        all.extend(point.limits.iter().map(|l| (l.exceeds, l.d.clone())));
        all.extend(point.spreads.iter().flat_map(|s| &s.ends).flat_map(rows));
        all
    }

    #[test]
    fn a_path_with_one_output_time_is_named_as_the_reason() {
        let mut model = Model::from_draft(&crank_rocker().times([0.5])).unwrap();
        model.metrics = vec![four_bar().metrics.swap_remove(0)];
        let goal = Goal { name: String::new(), metric: 0, target: None, weight: 1.0 };
        let settings = OptimizationSettings { goals: vec![goal], ..OptimizationSettings::default() };
        let models = model.motions();
        let motions = Motions::of(&models, Formulation::Relative).unwrap();
        let problem = Problem::new(&model, &motions, &settings);
        let refusal = problem.at(Vec::new(), &mut StudyCost::default(), &|| true).unwrap_err();
        assert!(refusal.why.contains("has a single output time"), "{}", refusal.why);
    }

    #[test]
    fn every_kind_of_goal_and_limit_has_the_derivatives_of_differences() {
        let (model, settings) = (four_bar(), everything());
        let models = model.motions();
        let motions = Motions::of(&models, Formulation::Relative).unwrap();
        let problem = Problem::new(&model, &motions, &settings);
        let at =
            |parts: &[f64]| problem.at(problem.design(parts), &mut StudyCost::default(), &|| true).unwrap();
        let parts = [0.37, 0.52, 0.61, 0.44];
        let here = numbers(&at(&parts));
        assert!(here.len() > 300, "{} numbers", here.len());
        for v in 0..4 {
            let moved = |sign: f64| {
                let mut parts = parts;
                parts[v] += sign * STEP;
                numbers(&at(&parts))
            };
            let (more, less) = (moved(1.0), moved(-1.0));
            assert_eq!(
                [more.len(), less.len()],
                [here.len(); 2],
                "the same number of values for every design"
            );
            let span = 0.05;
            let largest = here.iter().map(|(_, d)| (d[v] * span).abs()).fold(0.0, f64::max);
            for (k, (_, d)) in here.iter().enumerate() {
                let difference = (more[k].0 - less[k].0) / (2.0 * STEP);
                let error = (d[v] * span - difference).abs();
                assert!(
                    error <= AGREES * largest.max(1.0),
                    "number {k} by variable {v}: {} and {difference}",
                    d[v] * span
                );
            }
        }
    }

    #[test]
    fn the_parts_of_a_metric_are_all_of_it() {
        let (model, settings) = (four_bar(), everything());
        let models = model.motions();
        let motions = Motions::of(&models, Formulation::Relative).unwrap();
        let found = motions.evaluate(&[], &mut StudyCost::default(), &|| true).unwrap();
        let (solution, one) = (&found.solutions[0], motions.model(0));
        let value = |name: &str| {
            let k = one.metrics.iter().position(|m| m.name == name).unwrap();
            (&one.metrics[k], found.metrics[0][k].value.unwrap())
        };
        for name in ["fit", "path"] {
            let (metric, rms) = value(name);
            let parts = misfits(one, solution, metric).unwrap();
            let sum: f64 = parts.values.iter().map(|r| r * r).sum();
            assert!((sum.sqrt() - rms).abs() <= 4.0 * f64::EPSILON * rms, "{name}");
        }
        let (most, greatest) = value("most");
        let parts = peaks(one, solution, most, 1.0).unwrap();
        assert_eq!(parts.values.iter().copied().fold(f64::NEG_INFINITY, f64::max), greatest);
        let (least, lowest) = value("least");
        let parts = peaks(one, solution, least, -1.0).unwrap();
        assert_eq!(parts.values.iter().copied().fold(f64::INFINITY, f64::min), lowest);
        // The distance from a target is the largest number of its group.
        let problem = Problem::new(&model, &motions, &settings);
        let at = problem.at(vec![0.0; 4], &mut StudyCost::default(), &|| true).unwrap();
        assert_eq!(at.extrema.len(), 4);
        for Extremum { misfit, rows } in &at.extrema {
            let distance = at.misfits.values[*misfit].abs();
            assert!(
                (rows.greatest() - distance).abs() <= 4.0 * f64::EPSILON,
                "{} {distance}",
                rows.greatest()
            );
        }
        // A metric of one case is evaluated in that case only, any other metric in each case.
        let entry =
            |goal: usize| problem.goals.iter().filter(|t| t.of == goal).map(|t| t.motion).collect::<Vec<_>>();
        assert_eq!((entry(0), entry(6)), (vec![0, 1], vec![1]));
    }
}
