//! Goals and limits of one design as functions with derivatives, and the first-order condition of a front.
//!
//! Goals keep their own units: a goal of squares is the norm `|r|` of its residuals, which is the distance from the
//! target or the root of the mean square. That of a single residual is the larger one of `r` and `-r`, or the
//! largest of all candidates for an extremum, which have derivatives where it vanishes. Designs are fractions of the
//! bounds.

use std::rc::Rc;

use crate::optimize::optimality::BINDS;
use crate::optimize::problem::{Extremum, MET, Point, Problem, Rows};
use hardpoint::linalg::folded_rows;
use hardpoint_search::quadratic::non_negative;
use hardpoint_search::{dot, norm};

/// Weight of the sum of the multipliers, relative to the longest gradient, in their least squares.
const HEAVY: f64 = 10.0;

/// A matrix of second derivatives.
pub(crate) type Matrix = Vec<Vec<f64>>;

/// Part that a function has in goals or limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Role {
    /// Smooth part of a goal.
    Goal(usize),
    /// Candidate for the maximum of a group.
    Peak(usize),
    /// Limit: at most 0.
    Limit,
    /// Limit: equal to 0.
    Equal,
    /// Candidate for an end of a limited range; the index counts both ends of all of them.
    End(usize),
}

/// Differentiable function of the design.
#[derive(Clone, Debug)]
pub(crate) struct Function {
    pub role: Role,
    /// Index of the functions that share their second derivatives.
    pub block: usize,
    /// Goals and peaks in SI, limits as fractions of their scales.
    pub value: f64,
    /// Gradient by fractions of the bounds.
    pub d: Vec<f64>,
    /// Residuals of a function that depends on them.
    pub residuals: Option<Residuals>,
}

/// Dependence of a function on its residuals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Form {
    /// Their norm, less a constant.
    Norm,
    /// The sum of their squares, and a remainder.
    Square,
}

/// Residuals of a function, folded into one row for each variable and one more.
#[derive(Clone, Debug)]
pub(crate) struct Residuals {
    pub values: Vec<f64>,
    /// Derivatives by fractions of the bounds, one row for each residual.
    pub d: Vec<Vec<f64>>,
    pub form: Form,
}

/// A design with its functions.
#[derive(Clone, Debug)]
pub(crate) struct State {
    /// Searched variables as fractions of their bounds.
    pub x: Vec<f64>,
    pub point: Rc<Point>,
    pub functions: Vec<Function>,
    /// Second derivatives of the functions of each block; empty where they are not known.
    pub second: Vec<Matrix>,
    /// True for goals of squares, which are met where they vanish.
    pub squares: Vec<bool>,
    /// Goal and value of each group of peaks.
    pub groups: Vec<(usize, f64)>,
    /// Maximum of each limited range, as a fraction of its scale.
    pub ranges: Vec<f64>,
    /// Number of blocks.
    pub blocks: usize,
    /// Goals, SI.
    pub goals: Vec<f64>,
}

/// Distance from the first-order condition of a front.
#[derive(Clone, Debug, Default)]
pub(crate) struct Criticality {
    /// Largest entry of the unbalanced gradient of the weighted goals, relative to their steepest gradients.
    pub residual: f64,
    /// Weights of the goals as fractions of their ranges; their sum is 1.
    pub weights: Vec<f64>,
}

/// Ranges of the goals over a front.
#[derive(Clone, Debug)]
pub(crate) struct Scale {
    /// Minimum of each goal, SI.
    pub zero: Vec<f64>,
    /// Maximum minus minimum, SI.
    pub range: Vec<f64>,
    /// Largest derivative of each goal by a fraction of the bounds, relative to its range.
    pub steepest: Vec<f64>,
}

impl State {
    /// Each goal on its own.
    pub fn new(problem: &Problem<'_>, limit_scales: &[f64], x: Vec<f64>, point: Point) -> Self {
        let point = Rc::new(point);
        let count = problem.settings.goals.len();
        let mut found = FunctionList::new(problem, &point, count);
        for goal in 0..count {
            found.add_goal(goal);
            let shares = problem.goals.iter().zip(&point.shares).filter(|(g, _)| g.of == goal);
            let per_unit = 1.0 / problem.settings.goals[goal].weight;
            found.add_peaks(goal, shares.flat_map(|(_, s)| s.peaks.clone()), per_unit);
        }
        Self::with_limits(found, limit_scales, x, point.clone())
    }

    /// The weighted sum of all goals as the only one, or its root if all of them are squares. Distances from a target
    /// that have corners are not supported.
    pub fn of_sum(problem: &Problem<'_>, limit_scales: &[f64], x: Vec<f64>, point: Point) -> Self {
        let point = Rc::new(point);
        let mut found = FunctionList::new(problem, &point, 1);
        found.add_sum();
        found.add_peaks(0, 0..point.peaks.len(), 1.0);
        Self::with_limits(found, limit_scales, x, point.clone())
    }

    fn with_limits(mut found: FunctionList<'_>, limit_scales: &[f64], x: Vec<f64>, point: Rc<Point>) -> Self {
        let count = found.goals.len();
        let limits = count + found.groups.len();
        found.add_limits(limits, limit_scales);
        let ends = limits + 2 * found.problem.limits.len();
        found.add_ranges(ends, limit_scales);
        let FunctionList { functions, squares, groups, ranges, goals, .. } = found;
        let blocks = ends + 2 * ranges.len();
        Self { x, point, functions, second: vec![Vec::new(); blocks], squares, groups, ranges, blocks, goals }
    }

    /// Values and gradients of the functions with a role.
    pub fn of_role(&self, role: Role) -> impl Iterator<Item = &Function> {
        self.functions.iter().filter(move |f| f.role == role)
    }

    /// Largest value of the functions with a role.
    pub fn greatest(&self, role: Role) -> f64 {
        self.of_role(role).map(|f| f.value).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Goals as fractions of their ranges.
    pub fn scaled(&self, scale: &Scale) -> Vec<f64> {
        let goals = self.goals.iter().zip(scale.zero.iter().zip(&scale.range));
        goals.map(|(value, (zero, range))| (value - zero) / range).collect()
    }

    /// Largest violation of a limit, as a fraction of its scale; 0 if all are satisfied.
    pub fn violation(&self) -> f64 {
        let exceeds = |f: &Function| match f.role {
            Role::Limit => f.value.max(0.0),
            Role::Equal => f.value.abs(),
            Role::Goal(_) | Role::Peak(_) | Role::End(_) => 0.0,
        };
        let spread = |(k, most): (usize, &f64)| {
            [0, 1].map(|end| self.greatest(Role::End(2 * k + end))).iter().sum::<f64>() - most
        };
        let limits = self.functions.iter().map(exceeds).fold(0.0, f64::max);
        self.ranges.iter().enumerate().map(spread).fold(limits, f64::max)
    }

    /// Largest derivative of each goal by a fraction of the bounds, SI.
    pub fn steepest(&self) -> Vec<f64> {
        let mut steepest = vec![0.0; self.goals.len()];
        for f in &self.functions {
            let goal = match f.role {
                Role::Goal(goal) => goal,
                Role::Peak(group) if f.value >= self.groups[group].1 => self.groups[group].0,
                Role::Peak(_) | Role::Limit | Role::Equal | Role::End(_) => continue,
            };
            steepest[goal] = f.d.iter().fold(steepest[goal], |most: f64, d| most.max(d.abs()));
        }
        steepest
    }

    /// Functions with a role that attain their maximum, up to a fraction of their change over the bounds.
    fn at_peak(&self, role: Role) -> Vec<&Function> {
        let steepest = self.of_role(role).flat_map(|f| &f.d).fold(0.0, |most: f64, d| most.max(d.abs()));
        let most = self.greatest(role);
        self.of_role(role).filter(|f| f.value >= most - BINDS * steepest).collect()
    }

    /// Distance from the condition that a design on the front of some goals satisfies:
    ///
    /// ```text
    /// sum w_i grad f_i + sum m_j grad c_j = 0,    w_i >= 0,  sum w_i = 1,    m_j >= 0,  m_j c_j = 0
    /// ```
    ///
    /// for goals as fractions of their ranges. The multipliers are non-negative least squares over the active
    /// constraints, independent of the solver. The candidates that attain a maximum share the weight of their goal. The
    /// `fixed` goals are constraints: their weights do not count in the sum.
    pub fn criticality(&self, scale: &Scale, traded: &[usize], fixed: &[usize]) -> Criticality {
        let n = self.x.len();
        let size = n + 1 + self.groups.len();
        let mut columns: Vec<Vec<f64>> = Vec::new();
        let padded = |d: &[f64], factor: f64| {
            let mut column = vec![0.0; size];
            column.iter_mut().zip(d).for_each(|(c, d)| *c = factor * d);
            column
        };
        let goal = |goal: usize| match self.of_role(Role::Goal(goal)).next() {
            Some(f) => padded(&f.d, 1.0 / scale.range[goal]),
            None => vec![0.0; size],
        };
        let both: Vec<usize> = traded.iter().chain(fixed).copied().collect();
        columns.extend(both.iter().map(|k| goal(*k)));
        let mut peaks = Vec::new();
        for (group, (of, _)) in self.groups.iter().enumerate().filter(|(_, (of, _))| both.contains(of)) {
            for f in self.at_peak(Role::Peak(group)) {
                peaks.push((columns.len(), group));
                columns.push(padded(&f.d, 1.0 / scale.range[*of]));
            }
        }
        for f in &self.functions {
            match f.role {
                Role::Limit if f.value > -BINDS => columns.push(padded(&f.d, 1.0)),
                Role::Equal => columns.extend([1.0, -1.0].map(|sign| padded(&f.d, sign))),
                Role::Limit | Role::Goal(_) | Role::Peak(_) | Role::End(_) => {}
            }
        }
        for (k, most) in self.ranges.iter().enumerate() {
            let [high, low] = [0, 1].map(|end| self.at_peak(Role::End(2 * k + end)));
            // For a range, every pair of a maximum and a minimum.
            for (a, b) in high.iter().flat_map(|a| low.iter().map(move |b| (a, b))) {
                if a.value + b.value - most > -BINDS {
                    let d: Vec<f64> = a.d.iter().zip(&b.d).map(|(a, b)| a + b).collect();
                    columns.push(padded(&d, 1.0));
                }
            }
        }
        for (v, part) in self.x.iter().enumerate() {
            for (is_active, sign) in [(*part < BINDS, -1.0), (*part > 1.0 - BINDS, 1.0)] {
                if is_active {
                    let mut column = vec![0.0; size];
                    column[v] = sign;
                    columns.push(column);
                }
            }
        }
        let longest = columns.iter().map(|c| norm(c)).fold(0.0, f64::max);
        let heavy = HEAVY * if longest > 0.0 { longest } else { 1.0 };
        for (k, (column, of)) in columns.iter_mut().zip(&both).enumerate() {
            column[n] = if k < traded.len() { heavy } else { 0.0 };
            for (group, _) in self.groups.iter().enumerate().filter(|(_, (goal, _))| goal == of) {
                column[n + 1 + group] = -heavy;
            }
        }
        peaks.iter().for_each(|(column, group)| columns[*column][n + 1 + group] = heavy);
        let mut right = vec![0.0; size];
        right[n] = heavy;
        let multipliers = non_negative(&columns, &right);
        let sum: f64 = multipliers[..both.len()].iter().sum();
        let mut weights = vec![0.0; self.goals.len()];
        both.iter().zip(&multipliers).for_each(|(k, m)| weights[*k] = if sum > 0.0 { m / sum } else { 0.0 });
        let left = |row: usize| columns.iter().zip(&multipliers).map(|(c, m)| c[row] * m).sum::<f64>();
        // The rows of the sums count as well, so that no weight is lost.
        let left = (0..size).map(|row| (left(row) - right[row]).abs()).fold(0.0, f64::max);
        let size = dot(&weights, &scale.steepest).max(f64::MIN_POSITIVE);
        let residual = if sum > 0.0 { left / (sum * size) } else { f64::INFINITY };
        Criticality { residual, weights }
    }
}

/// Derivatives by fractions of the bounds, times a factor.
fn by_parts(d: &[f64], factor: f64, spans: &[f64]) -> Vec<f64> {
    d.iter().zip(spans).map(|(d, span)| factor * d * span).collect()
}

/// Functions of a design while they are listed.
struct FunctionList<'p> {
    problem: &'p Problem<'p>,
    point: &'p Point,
    spans: Vec<f64>,
    functions: Vec<Function>,
    squares: Vec<bool>,
    groups: Vec<(usize, f64)>,
    ranges: Vec<f64>,
    goals: Vec<f64>,
}

impl<'p> FunctionList<'p> {
    fn new(problem: &'p Problem<'p>, point: &'p Point, count: usize) -> Self {
        let (functions, groups, ranges) = (Vec::new(), Vec::new(), Vec::new());
        let (squares, goals) = (vec![false; count], vec![0.0; count]);
        Self { problem, point, spans: problem.spans(), functions, squares, groups, ranges, goals }
    }

    /// Lists the smooth part of the weighted sum of all goals.
    fn add_sum(&mut self) {
        let Self { point, spans, functions, squares, goals, .. } = self;
        let Rows { values, d } = &point.misfits;
        let rows = values.iter().zip(d).map(|(r, d)| (*r, by_parts(d, 1.0, spans)));
        let residuals = Residuals::folded(rows.collect(), spans.len());
        squares[0] = point.has_only_squares();
        // The norm of a single residual has a corner where it vanishes.
        let f = if squares[0] && values.len() > 1 {
            Function::of_norm(Role::Goal(0), 0, residuals.norm(), residuals)
        } else {
            let value = values.iter().map(|r| r * r).sum::<f64>() + point.plain.values.iter().sum::<f64>();
            let d = by_parts(&point.smooth().gradient(spans.len()), 1.0, spans);
            let residuals = (!values.is_empty()).then_some(Residuals { form: Form::Square, ..residuals });
            Function { role: Role::Goal(0), block: 0, value, d, residuals }
        };
        goals[0] = f.value;
        functions.push(f);
    }

    /// Lists the functions of a goal, without its peaks.
    fn add_goal(&mut self, goal: usize) {
        let Self { problem, point, spans, functions, squares, groups, goals, .. } = self;
        let (n, count) = (spans.len(), goals.len());
        let by_parts = |d: &[f64], factor: f64| by_parts(d, factor, spans);
        let per_unit = 1.0 / problem.settings.goals[goal].weight;
        let shares = || problem.goals.iter().zip(&point.shares).filter(|(g, _)| g.of == goal);
        let misfits = shares().flat_map(|(_, s)| s.misfits.clone());
        let rows: Vec<(f64, Vec<f64>)> = misfits
            .map(|k| (per_unit * point.misfits.values[k], by_parts(&point.misfits.d[k], per_unit)))
            .collect();
        let plain: Vec<usize> = shares().flat_map(|(_, s)| s.plain.clone()).collect();
        squares[goal] = !rows.is_empty();
        if let [(r, d)] = &rows[..] {
            let group = groups.len();
            let mut push = |value: f64, d: Vec<f64>| {
                functions.push(Function::new(Role::Peak(group), count + group, value, d));
            };
            let mut of_goal = shares().flat_map(|(_, s)| s.misfits.clone());
            let is_own = |k: usize| point.extrema.iter().find(|extremum| extremum.misfit == k);
            match of_goal.next().and_then(is_own) {
                Some(Extremum { rows, .. }) => {
                    let rows = rows.values.iter().zip(&rows.d);
                    rows.for_each(|(value, d)| push(per_unit * value, by_parts(d, per_unit)));
                }
                None => {
                    for sign in [1.0, -1.0] {
                        push(sign * r, d.iter().map(|d| sign * d).collect());
                    }
                }
            }
            // The largest of the pushed numbers, to the last bit.
            let of_group = functions.iter().filter(|f| f.role == Role::Peak(group));
            let greatest = of_group.map(|f| f.value).fold(f64::NEG_INFINITY, f64::max);
            goals[goal] += greatest;
            groups.push((goal, greatest));
        } else if !rows.is_empty() {
            let residuals = Residuals::folded(rows, n);
            let value = residuals.norm();
            functions.push(Function::of_norm(Role::Goal(goal), goal, value, residuals));
            goals[goal] += value;
        } else if !plain.is_empty() {
            let value = plain.iter().map(|k| per_unit * point.plain.values[*k]).sum();
            let mut d = vec![0.0; n];
            for k in plain {
                d.iter_mut().zip(by_parts(&point.plain.d[k], per_unit)).for_each(|(a, b)| *a += b);
            }
            functions.push(Function::new(Role::Goal(goal), goal, value, d));
            goals[goal] += value;
        }
    }

    /// Lists peaks of a goal, times a factor.
    fn add_peaks(&mut self, goal: usize, of_goal: impl Iterator<Item = usize>, per_unit: f64) {
        let Self { point, spans, functions, groups, goals, .. } = self;
        let count = goals.len();
        for k in of_goal {
            let peaks = &point.peaks[k];
            let group = groups.len();
            for (value, d) in peaks.values.iter().zip(&peaks.d) {
                let (value, d) = (per_unit * value, by_parts(d, per_unit, spans));
                functions.push(Function::new(Role::Peak(group), count + group, value, d));
            }
            let greatest = per_unit * peaks.greatest();
            goals[goal] += greatest;
            groups.push((goal, greatest));
        }
    }

    /// Lists the limits; their blocks begin at this one.
    fn add_limits(&mut self, limits: usize, limit_scales: &[f64]) {
        let Self { point, spans, functions, .. } = self;
        let by_parts = |d: &[f64], factor: f64| by_parts(d, factor, spans);
        for row in point.limits.iter().filter(|row| !row.spread) {
            let per_scale = 1.0 / limit_scales[row.of];
            let role = if row.equal { Role::Equal } else { Role::Limit };
            let block = limits + 2 * row.of + usize::from(row.upper);
            let value = per_scale * row.exceeds;
            let residuals = point.limit_residuals.iter().find(|(of, _)| row.upper && *of == row.of);
            functions.push(match residuals {
                Some((_, Rows { values, d })) => {
                    let rows = values.iter().zip(d).map(|(r, d)| (per_scale * r, by_parts(d, per_scale)));
                    Function::of_norm(role, block, value, Residuals::folded(rows.collect(), spans.len()))
                }
                None => Function::new(role, block, value, by_parts(&row.d, per_scale)),
            });
        }
    }

    /// Lists the ends of curves with a limited range; their blocks begin at this one.
    fn add_ranges(&mut self, ends: usize, limit_scales: &[f64]) {
        let Self { point, spans, functions, ranges, .. } = self;
        for (k, spread) in point.spreads.iter().enumerate() {
            let per_scale = 1.0 / limit_scales[spread.of];
            ranges.push(per_scale * spread.most);
            for (end, rows) in spread.ends.iter().enumerate() {
                let end = 2 * k + end;
                for (value, d) in rows.values.iter().zip(&rows.d) {
                    let (value, d) = (per_scale * value, by_parts(d, per_scale, spans));
                    functions.push(Function::new(Role::End(end), ends + end, value, d));
                }
            }
        }
    }
}

impl Function {
    fn new(role: Role, block: usize, value: f64, d: Vec<f64>) -> Self {
        Self { role, block, value, d, residuals: None }
    }

    fn of_norm(role: Role, block: usize, value: f64, residuals: Residuals) -> Self {
        let d = residuals.gradient();
        Self { role, block, value, d, residuals: Some(residuals) }
    }
}

impl Residuals {
    /// Rows with the same squares and products as some residuals with their derivatives.
    fn folded(rows: Vec<(f64, Vec<f64>)>, n: usize) -> Self {
        let mut columns: Vec<Vec<f64>> = (0..n).map(|v| rows.iter().map(|(_, d)| d[v]).collect()).collect();
        columns.push(rows.iter().map(|(r, _)| *r).collect());
        let folded = folded_rows(columns);
        Self {
            values: folded.iter().map(|row| row[n]).collect(),
            d: folded.into_iter().map(|row| row[..n].to_vec()).collect(),
            form: Form::Norm,
        }
    }

    pub fn norm(&self) -> f64 {
        norm(&self.values)
    }

    /// Norm below which the direction of the residuals is round-off.
    pub fn least(&self) -> f64 {
        let n = self.d.first().map_or(0, Vec::len);
        let column = |v: usize| self.d.iter().map(|d| d[v] * d[v]).sum::<f64>();
        (MET * (0..n).map(column).fold(0.0, f64::max).sqrt()).max(f64::MIN_POSITIVE)
    }

    /// The residuals after a step, to first order.
    pub fn moved(&self, p: &[f64]) -> Self {
        let values = self.values.iter().zip(&self.d).map(|(r, d)| r + dot(d, p)).collect();
        Self { values, ..self.clone() }
    }

    /// `J^T r`
    pub fn slope(&self) -> Vec<f64> {
        let n = self.d.first().map_or(0, Vec::len);
        (0..n).map(|v| self.values.iter().zip(&self.d).map(|(r, d)| r * d[v]).sum()).collect()
    }

    /// `J^T J`
    pub fn products(&self) -> Matrix {
        let n = self.d.first().map_or(0, Vec::len);
        let entry = |i: usize, j: usize| self.d.iter().map(|d| d[i] * d[j]).sum();
        (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
    }

    /// Gradient of the norm.
    fn gradient(&self) -> Vec<f64> {
        let (value, least) = (self.norm(), self.least());
        self.slope().into_iter().map(|d| if value > least { d / value } else { 0.0 }).collect()
    }
}
