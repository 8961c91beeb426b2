//! Result of a trade-off: the designs on the front with their goals, in the model's units.

use std::io::Write;

use hardpoint::measure::Output;
use hardpoint::model::{Dimension, Goal, Metric, Model, OptimizationSettings, VariableId};
use hardpoint_file::{Diagnostic, ModelFile, Units};
use hardpoint_study::optimize::Status;
use hardpoint_study::trade_off::{FrontPoint, ON_FRONT, Outcome, TradeOff};
use serde::Serialize;

use crate::figures::{count, error, number, some_of, unit, variable_unit, with_unit};
use crate::optimize::unit_in_si;
use crate::page::{Payload, SweepAxis, SweepPlot, Table};
use crate::record::{Column, record, write_rows};
use crate::study::{
    Evaluations, VALUES, case_name, nominal_number, range, signed, titled, value_of, with_brackets,
};

/// A finished trade-off, with its inputs.
#[derive(Clone, Copy)]
pub struct TradeOffInputs<'a> {
    /// Model file.
    pub file: &'a ModelFile,
    /// Settings of the searches; their goals are the traded ones.
    pub asked: &'a OptimizationSettings,
    /// Result.
    pub found: &'a TradeOff,
}

impl<'a> TradeOffInputs<'a> {
    fn model(&self) -> &'a Model {
        &self.file.model
    }

    fn units(&self) -> Units {
        self.file.units
    }

    fn metric(&self, goal: &Goal) -> &'a Metric {
        &self.model().metrics[goal.metric]
    }

    fn dimension(&self, goal: usize) -> Dimension {
        self.model().metric_dimension(self.metric(&self.asked.goals[goal]))
    }

    /// Goal in its unit.
    fn shown(&self, goal: usize, value: f64) -> f64 {
        self.units().from_si(self.dimension(goal), value)
    }

    /// Values of a goal at all points.
    fn values(&self, goal: usize) -> impl Iterator<Item = f64> {
        self.found.points.iter().map(move |p| self.shown(goal, p.values[goal]))
    }

    /// Value of a variable in a design, in its unit.
    fn value_of(&self, v: VariableId, design: &[f64]) -> f64 {
        self.file.value_of(v, design[v.0])
    }

    fn searched(&self) -> &'a [VariableId] {
        &self.asked.variables
    }
}

record! {
    /// Result of a trade-off, in the model's units. Serialised as `summary.json` of `hardpoint trade-off`.
    TradeOffFacts::without_message(inputs: &TradeOffInputs<'_>) {
        let TradeOffInputs { file, asked, found } = *inputs;
        let points = found.points.iter().enumerate();
    }
    /// Program and version.
    generator: String = crate::GENERATOR.into();
    /// Kind of study.
    study: &'static str = "trade_off";
    /// Name of the model.
    model: String = file.model.name.clone();
    /// Name of the model file.
    file: String = file.file_name().into();
    /// Outcome: `front`, `no_conflict`, `no_optimum` if the optimum of a goal was not found, or `interrupted`; or
    /// `not_reproduced` or `not_saved`, as for an optimisation.
    status: &'static str = status_word(found.outcome);
    /// Status in words, with an instruction.
    message: String = String::new();
    /// Cost of the study.
    evaluations: Evaluations = Evaluations::of(found.cost);
    /// Number of designs evaluated for the optimum of each goal.
    optimum_designs: usize = found.anchor_designs;
    /// Traded goals.
    goals: Vec<TradedGoal> = (0..asked.goals.len()).map(|k| TradedGoal::of(inputs, k)).collect();
    /// Searched variables.
    variables: Vec<TradedVariable> = asked.variables.iter().map(|v| TradedVariable::of(inputs, *v)).collect();
    /// Designs on the front, in ascending order of the first goal.
    points: Vec<PointFact> = points.map(|(k, p)| PointFact::of(inputs, k, p)).collect();
    /// Number of the balanced compromise: the point with the smallest largest loss in a goal, as a fraction of the
    /// range of the goal over the front.
    balanced: Option<usize> = found.balanced();
    /// Largest residual of the first-order (KKT) condition over all points, theory (76).
    kkt: Option<f64> = found.points.iter().map(|p| p.residual).reduce(f64::max);
    /// Pairs of neighbours between which the front has a jump.
    jumps: Vec<[usize; 2]> = found.jumps.clone();
    /// Number of points that were not found to the required residual.
    failed: usize = found.failed;
    /// Number of points that were found, but are worse than others in all goals.
    dominated: usize = found.dominated;
    /// Saved design; `null` if none was saved.
    saved: Option<SavedPoint> = None;
    /// Further diagnostics.
    diagnostics: Vec<Diagnostic> = Vec::new();
    /// Written files.
    files: Vec<String> = Vec::new();
    /// Duration, s.
    seconds: f64 = 0.0;
}

record! {
    /// Traded goal.
    TradedGoal::of(inputs: &TradeOffInputs<'_>, k: usize) {
        let goal = &inputs.asked.goals[k];
        let metric = inputs.metric(goal);
        let dimension = inputs.dimension(k);
        let ends = || inputs.values(k);
    }
    /// Name.
    name: String = goal.name.clone();
    /// Metric of the goal.
    metric: String = metric.name.clone();
    /// Quantity that is traded, in words.
    quantity: String = quantity(inputs, goal, metric);
    /// Unit.
    unit: String = unit(inputs.units(), dimension);
    /// Target; `null` if the metric is minimised.
    target: Option<f64> = goal.target.map(|t| inputs.shown(k, t));
    /// Nominal value; `null` if the nominal design cannot be evaluated.
    nominal: Option<f64> = inputs.found.nominal_values.as_ref().map(|v| inputs.shown(k, v[k]));
    /// Minimum over the points.
    best: Option<f64> = ends().reduce(f64::min);
    /// Maximum over the points.
    worst: Option<f64> = ends().reduce(f64::max);
}

record! {
    /// Searched variable.
    TradedVariable::of(inputs: &TradeOffInputs<'_>, v: VariableId) {
        let variable = &inputs.model().variables[v.0];
        let bounds = variable.bounds.unwrap_or_default();
    }
    /// Name.
    name: String = variable.name.clone();
    /// Unit.
    unit: String = variable_unit(inputs.model(), inputs.units(), variable);
    /// Nominal value: that of a parameter, or 0 for a change.
    nominal: f64 = inputs.file.value_of(v, 0.0);
    /// Bounds of the value.
    bounds: [f64; 2] = bounds.map(|b| inputs.file.value_of(v, b));
    /// Nominal value of the number that the variable changes; `null` if it changes none or several.
    number: Option<f64> =
        nominal_number(inputs.file, variable).map(|x| inputs.units().from_si(variable.quantity, x));
}

impl TradedVariable {
    /// Change that leads to a value of [`PointFact::variables`].
    fn change(&self, value: f64) -> f64 {
        value - self.nominal
    }

    /// Value of the number that the variable changes, or the change itself if there is none.
    fn value(&self, value: f64) -> f64 {
        value_of(self.number.map(|number| number - self.nominal), value, self.bounds)
    }
}

record! {
    /// Design on the front.
    PointFact::of(inputs: &TradeOffInputs<'_>, k: usize, point: &FrontPoint) {
        let goal_units: Vec<f64> =
            (0..point.values.len()).map(|g| unit_in_si(inputs.units(), inputs.dimension(g))).collect();
        let rate = |(g, rate): (usize, &Option<f64>)| rate.map(|r| r * goal_units[0] / goal_units[g]);
        let assessment = &point.assessment;
        let metric = |(goal, motion, value): &(usize, usize, f64)| MetricFact::of(inputs, *goal, *motion, *value);
    }
    /// Number of the point.
    point: usize = k;
    /// Goal that has its optimum here; `null` between the ends of the front.
    optimum_of: Option<String> = point.anchor.map(|g| inputs.asked.goals[g].name.clone());
    /// Goals, in the order of [`TradeOffFacts::goals`].
    goals: Vec<f64> = point.values.iter().enumerate().map(|(g, x)| inputs.shown(g, *x)).collect();
    /// Weights of the goals as fractions of their ranges, for which the design is stationary; their sum is 1.
    weights: Vec<f64> = point.weights.clone();
    /// Change of each goal per unit of the first along the front, if all others are constant; `null` if a weight
    /// vanishes.
    rates: Vec<Option<f64>> = point.rates.iter().enumerate().map(rate).collect();
    /// Values of the variables, in the order of [`TradeOffFacts::variables`].
    variables: Vec<f64> = inputs.searched().iter().map(|v| inputs.value_of(*v, &assessment.design)).collect();
    /// Metrics of the goals, in each case.
    metrics: Vec<MetricFact> = assessment.goals.iter().map(metric).collect();
    /// Residual of the first-order (KKT) condition, theory (76).
    kkt: f64 = point.residual;
    /// Largest violation of a limit, as a fraction of its change over the bounds of the most influential variable.
    violation: f64 = assessment.violation;
    /// Minimum margin to a singular position over all motions.
    margin: Option<f64> = assessment.margin;
    /// Number of designs evaluated for this point, without the searches for the optimum of single goals.
    designs: usize = point.designs;
}

record! {
    /// Metric of a goal in one motion.
    MetricFact::of(inputs: &TradeOffInputs<'_>, goal: usize, motion: usize, value: f64) {}
    /// Name of the metric.
    name: String = inputs.metric(&inputs.asked.goals[goal]).name.clone();
    /// Name of the case; `null` if the model has no cases.
    case: Option<String> = case_name(inputs.model(), motion);
    /// Unit.
    unit: String = unit(inputs.units(), inputs.dimension(goal));
    /// Value.
    value: f64 = inputs.shown(goal, value);
}

/// Saved design of a point, read back from the file and solved again.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SavedPoint {
    /// Name of the file.
    pub file: String,
    /// Number of the point.
    pub point: usize,
    /// Minimum margin to a singular position over all motions.
    pub margin: Option<f64>,
    /// Reason why the design is not the point; `null` if it is.
    pub why: Option<String>,
}

fn status_word(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Front => "front",
        Outcome::NoConflict => "no_conflict",
        Outcome::Interrupted => "interrupted",
        Outcome::NoAnchor(..) => "no_optimum",
        Outcome::NoEnd(_) => "no_end",
    }
}

/// Reason why the search for the optimum of a goal failed, with an instruction.
fn status_sentence(status: Status) -> &'static str {
    match status {
        Status::LimitsNotKept => {
            "no design was found that keeps all limits; they contradict each other or the bounds: widen one of them, or try more \
             `starts`"
        }
        Status::NoStart => "no design could be evaluated; `hardpoint optimize` lists the reasons",
        Status::IterationLimit => "the iteration limit was reached: increase `max_iterations`",
        Status::NoEffect => {
            "it does not depend on the variables: give `bounds` to variables that change it, or trade other goals"
        }
        Status::Stuck | Status::Optimal => "no step makes progress: try more `starts`",
        Status::Interrupted => "interrupted",
    }
}

/// The quantity of a goal in words.
fn quantity(inputs: &TradeOffInputs<'_>, goal: &Goal, metric: &Metric) -> String {
    let k = inputs.asked.goals.iter().position(|g| g.name == goal.name).expect("it is a goal");
    let unit = unit(inputs.units(), inputs.dimension(k));
    let of = match goal.target {
        Some(target) => {
            format!("distance of metric `{}` from {}", metric.name, with_unit(inputs.shown(k, target), &unit))
        }
        None => format!("metric `{}`", metric.name),
    };
    let cases = inputs
        .found
        .points
        .first()
        .map_or(1, |p| p.assessment.goals.iter().filter(|(of, ..)| *of == k).count());
    let is_square = goal.target.is_some() || metric.take.target().is_some();
    match cases {
        0 | 1 => of,
        n if is_square => format!("{of}, root of the sum of squares over {n} cases"),
        n => format!("{of}, sum over {n} cases"),
    }
}

impl TradeOffFacts {
    /// Collects the facts of a trade-off.
    pub fn of(inputs: &TradeOffInputs<'_>) -> Self {
        let mut facts = Self::without_message(inputs);
        facts.message = facts.sentence(inputs);
        facts
    }

    fn names(&self) -> Vec<String> {
        self.goals.iter().map(|g| format!("`{}`", g.name)).collect()
    }

    /// Sentence about the result, with an instruction.
    fn sentence(&self, inputs: &TradeOffInputs<'_>) -> String {
        let names = self.names();
        let between = match &names[..] {
            [a, b] => format!("{a} and {b}"),
            _ => names.join(", "),
        };
        let designs = count(self.points.len(), "design");
        match inputs.found.outcome {
            Outcome::Front if self.points.len() < 2 && self.failed == 0 => format!(
                "no compromise between {between} was found: the searches for their optima end in one design; where the \
                 optimum of a goal is not unique, others are hidden: change the nominal design, or limit a goal"
            ),
            Outcome::Front if self.points.len() < 2 => format!(
                "no compromise between {between} was found: {} could not be found to a residual of {ON_FRONT:e}; a goal \
                 that is not smooth, like a distance that vanishes, has none",
                count(self.failed, "point")
            ),
            Outcome::Front => format!(
                "trade-off between {between}: {designs}, none of which is better than another in all goals"
            ),
            Outcome::NoConflict => format!(
                "{between} do not conflict: one design is within a thousandth of the optimum of each; save it, or trade \
                 other goals"
            ),
            Outcome::Interrupted if self.points.is_empty() => "interrupted before a design was found".into(),
            Outcome::Interrupted => format!("interrupted: {designs} of the front between {between} so far"),
            Outcome::NoAnchor(goal, status) => format!(
                "the optimum of goal `{}` alone was not found: {}",
                self.goals[goal].name,
                status_sentence(status)
            ),
            Outcome::NoEnd(goal) => format!(
                "at the optimum of goal `{}` another goal or a limit has no value or no derivative, so that the front has no end: \
                 change the bounds so that this design is outside of them",
                self.goals[goal].name
            ),
        }
    }

    /// Goals of a point in words.
    fn goals_of(&self, point: &PointFact) -> String {
        let goal = |(goal, x): (&TradedGoal, &f64)| format!("`{}` {}", goal.name, with_unit(*x, &goal.unit));
        self.goals.iter().zip(&point.goals).map(goal).collect::<Vec<_>>().join(", ")
    }

    /// Facts of the result, line by line.
    pub fn rows(&self) -> Vec<(&'static str, String)> {
        let mut rows = vec![("result", self.message.clone())];
        let range = |g: &TradedGoal| {
            let (best, worst) = (g.best?, g.worst?);
            Some(format!("`{}` {} to {}", g.name, number(best), with_unit(worst, &g.unit)))
        };
        let ranges: Vec<String> = self.goals.iter().filter_map(range).collect();
        if self.points.len() > 1 {
            rows.push(("ranges", ranges.join(", ")));
        }
        if let Some(balanced) = self.balanced.map(|k| &self.points[k]).filter(|_| self.points.len() > 1) {
            rows.push(("balanced", format!("point {}: {}", balanced.point, self.goals_of(balanced))));
            let rate = |(goal, rate): (&TradedGoal, &Option<f64>)| {
                let rate = rate.filter(|r| *r != 0.0)?;
                let first = &self.goals[0];
                Some(format!(
                    "1 {} less of `{}` costs {} of `{}`",
                    if first.unit.is_empty() { "unit" } else { &first.unit },
                    first.name,
                    with_unit(-rate, &goal.unit),
                    goal.name
                ))
            };
            let rates: Vec<String> =
                self.goals.iter().zip(&balanced.rates).skip(1).filter_map(rate).collect();
            if !rates.is_empty() {
                rows.push(("exchange", format!("at point {}, {}", balanced.point, rates.join(", or "))));
            }
        }
        rows.extend(self.nominal_row());
        if let Some(kkt) = self.kkt {
            rows.push((
                "optimality",
                format!("residual of the first-order condition at most {}", error(kkt)),
            ));
        }
        if !self.jumps.is_empty() {
            let jump = |[a, b]: &[usize; 2]| format!("{a} and {b}");
            let jumps: Vec<String> = self.jumps.iter().map(jump).collect();
            rows.push(("jumps", format!("no compromise was found between points {}", some_of(&jumps, "; "))));
        }
        if self.failed > 0 && self.points.len() > 1 {
            let failed = count(self.failed, "point");
            rows.push((
                "missing",
                format!("{failed} not found to a residual of {ON_FRONT:e}: use more output times where a metric jumps"),
            ));
        }
        if let Some(saved) = &self.saved {
            rows.push((
                "saved",
                saved.why.as_ref().map_or_else(
                    || {
                        format!(
                            "`{}` with the design of point {} was read and solved again",
                            saved.file, saved.point
                        )
                    },
                    |why| format!("`{}` does not reproduce point {}: {why}", saved.file, saved.point),
                ),
            ));
        }
        let Evaluations { designs, motions, .. } = self.evaluations;
        rows.push((
            "evaluated",
            format!("{designs} designs with derivatives, {} of them for the optimum of each goal; {motions} motions", self.optimum_designs),
        ));
        rows
    }

    /// Nominal design, and the points that are better in all goals.
    fn nominal_row(&self) -> Option<(&'static str, String)> {
        let nominal: Vec<f64> = self.goals.iter().map(|g| g.nominal).collect::<Option<_>>()?;
        let is_better = |p: &&PointFact| p.goals.iter().zip(&nominal).all(|(x, nominal)| x < nominal);
        let better: Vec<String> = self.points.iter().filter(is_better).map(|p| p.point.to_string()).collect();
        let shown = |(g, x): (&TradedGoal, &f64)| format!("`{}` {}", g.name, with_unit(*x, &g.unit));
        let values = self.goals.iter().zip(&nominal).map(shown).collect::<Vec<_>>().join(", ");
        let better = match better.len() {
            0 => String::new(),
            1 => format!("; better in all goals: point {}", better[0]),
            _ => format!("; better in all goals: points {}", some_of(&better, ", ")),
        };
        Some(("nominal", format!("{values}{better}")))
    }

    /// Tables for printing: the points with their goals, and with their variables.
    pub fn tables(&self) -> Vec<Table> {
        let goal = |k: usize| move |p: &&PointFact| number(p.goals[k]);
        let goals: Vec<_> = (0..self.goals.len()).map(goal).collect();
        let titles: Vec<String> = self.goals.iter().map(|g| with_brackets(&g.name, &g.unit)).collect();
        let rate_titles: Vec<String> = self.goals.iter().skip(1).map(|g| format!("d {}", g.name)).collect();
        let rate = |k: usize| {
            move |p: &&PointFact| p.rates[k].map_or(String::new(), |r| number(if r == 0.0 { 0.0 } else { r }))
        };
        let rates: Vec<_> = (1..self.goals.len()).map(rate).collect();
        let mut columns: Vec<Column<'_, &PointFact>> = vec![("point", &|p| p.point.to_string())];
        columns.extend(titles.iter().zip(&goals).map(|(title, cell)| (title.as_str(), cell as _)));
        columns.extend(rate_titles.iter().zip(&rates).map(|(title, cell)| (title.as_str(), cell as _)));
        let last: [Column<'_, &PointFact>; 4] = [
            ("optimum of", &|p| p.optimum_of.clone().unwrap_or_default()),
            ("residual", &|p| error(p.kkt)),
            ("margin", &|p| p.margin.map_or(String::new(), number)),
            ("designs", &|p| p.designs.to_string()),
        ];
        columns.extend(last);
        let note = format!(
            "Each design is better than its neighbours in one goal and worse in another. `d` is the change of a goal per unit \
             of `{}` along the front.",
            self.goals[0].name
        );
        let front = Table::of("Front", note, &columns, &self.points);
        if self.points.is_empty() {
            return Vec::new();
        }
        vec![front, self.value_table(), self.change_table()]
    }

    /// Variables of all points, below those of the nominal design and their bounds.
    fn value_table(&self) -> Table {
        type Row = (String, Vec<String>);
        let row = |label: String, cell: &dyn Fn(usize, &TradedVariable) -> String| {
            (label, self.variables.iter().enumerate().map(|(k, v)| cell(k, v)).collect::<Vec<_>>())
        };
        let mut rows = vec![
            row("bounds".into(), &|_, v| range(v.bounds.map(|b| v.value(b)))),
            row("nominal".into(), &|_, v| number(v.value(v.nominal))),
        ];
        let point = |p: &PointFact| row(p.point.to_string(), &|k, v| number(v.value(p.variables[k])));
        rows.extend(self.points.iter().map(point));
        let titles: Vec<String> = self.variables.iter().map(|v| with_brackets(&v.name, &v.unit)).collect();
        let cells: Vec<_> = (0..titles.len()).map(|k| move |row: &Row| row.1[k].clone()).collect();
        let mut columns: Vec<Column<'_, Row>> = vec![("point", &|row| row.0.clone())];
        columns.extend(titles.iter().zip(&cells).map(|(title, cell)| (title.as_str(), cell as _)));
        Table::of("Designs of the front", VALUES, &columns, rows)
    }

    /// Changes of all points from the nominal design.
    fn change_table(&self) -> Table {
        let titles: Vec<String> = self.variables.iter().map(|v| with_brackets(&v.name, &v.unit)).collect();
        let change = |(k, v)| move |p: &&PointFact| signed(TradedVariable::change(v, p.variables[k]), "");
        let changes: Vec<_> = self.variables.iter().enumerate().map(change).collect();
        let mut columns: Vec<Column<'_, &PointFact>> = vec![("point", &|p| p.point.to_string())];
        columns.extend(titles.iter().zip(&changes).map(|(title, cell)| (title.as_str(), cell as _)));
        Table::of("Changes from the nominal design", "", &columns, &self.points)
    }

    /// Writes a row for each point: goals, their metrics in each case, weights, value and change of each variable,
    /// residual, violation, margin. A variable that changes several numbers has no value.
    ///
    /// # Errors
    /// If `out` cannot be written.
    pub fn write_points(&self, out: impl Write) -> csv::Result<()> {
        type Cell<'a> = Box<dyn Fn(&&PointFact) -> String + 'a>;
        let mut columns: Vec<(String, Cell<'_>)> =
            vec![("point".into(), Box::new(|p: &&PointFact| p.point.to_string()))];
        for (k, goal) in self.goals.iter().enumerate() {
            columns.push((with_brackets(&goal.name, &goal.unit), Box::new(move |p| p.goals[k].to_string())));
        }
        for (k, metric) in self.points.first().iter().flat_map(|p| &p.metrics).enumerate() {
            let name = format!("metric {}", titled(&metric.name, &metric.case));
            columns.push((
                with_brackets(&name, &metric.unit),
                Box::new(move |p| p.metrics[k].value.to_string()),
            ));
        }
        for (k, goal) in self.goals.iter().enumerate() {
            columns.push((format!("weight {}", goal.name), Box::new(move |p| p.weights[k].to_string())));
        }
        for (k, variable) in self.variables.iter().enumerate() {
            let title = |of: &str| with_brackets(&format!("{of} {}", variable.name), &variable.unit);
            let value = move |x| variable.number.map_or(String::new(), |_| variable.value(x).to_string());
            columns.push((title("value"), Box::new(move |p| value(p.variables[k]))));
            columns.push((title("change"), Box::new(move |p| variable.change(p.variables[k]).to_string())));
        }
        let last: [(&str, Cell<'_>); 5] = [
            ("residual", Box::new(|p| p.kkt.to_string())),
            ("violation", Box::new(|p| p.violation.to_string())),
            ("margin", Box::new(|p| p.margin.map_or(String::new(), |m| m.to_string()))),
            ("designs", Box::new(|p| p.designs.to_string())),
            ("optimum of", Box::new(|p| p.optimum_of.clone().unwrap_or_default())),
        ];
        columns.extend(last.map(|(title, cell)| (title.to_owned(), cell)));
        let columns: Vec<Column<'_, &PointFact>> =
            columns.iter().map(|(title, cell)| (title.as_str(), &**cell as _)).collect();
        write_rows(out, &columns, &self.points)
    }

    /// Plot of the front: the goals first, over which it opens, then the variables. Of a goal with a target it shows
    /// the metric instead of the distance, unless it has several cases.
    fn plot(&self) -> SweepPlot {
        let metric_of = |g: &TradedGoal, p: &PointFact| {
            let mut own = p.metrics.iter().filter(|m| m.name == g.metric);
            let value = own.next().map(|m| m.value);
            value.filter(|_| g.target.is_some() && own.next().is_none())
        };
        let goal = |(k, g): (usize, &TradedGoal)| {
            let metric: Option<Vec<f64>> = self.points.iter().map(|p| metric_of(g, p)).collect();
            SweepAxis {
                name: if metric.is_some() { g.metric.clone() } else { g.name.clone() },
                unit: g.unit.clone(),
                // The first goal is the abscissa.
                metric: k > 0,
                nominal: None,
                target: g.target.filter(|_| metric.is_some()),
                values: metric
                    .unwrap_or_else(|| self.points.iter().map(|p| p.goals[k]).collect())
                    .into_iter()
                    .collect(),
            }
        };
        let variable = |(k, v): (usize, &TradedVariable)| SweepAxis {
            name: v.name.clone(),
            unit: v.unit.clone(),
            metric: false,
            nominal: Some(v.nominal),
            target: None,
            values: self.points.iter().map(|p| p.variables[k]).collect(),
        };
        let goals = self.goals.iter().enumerate().map(goal);
        SweepPlot {
            what: "point".into(),
            designs: self.points.len(),
            step: 1,
            axes: goals.chain(self.variables.iter().enumerate().map(variable)).collect(),
            indices: Vec::new(),
        }
    }

    /// Turns the page of the nominal design into that of the trade-off: the result comes first among the checks, with
    /// the plot of the front, and the page opens on the curve of the first goal.
    pub fn page(&self, page: Payload, model: &Model, outputs: &[Output]) -> Payload {
        let mut page = page;
        let goal = |g: &TradedGoal| model.metrics.iter().find(|m| m.name == g.metric);
        page.open_on(self.goals.iter().find_map(goal), outputs);
        page.put_study("Trade-off", self.rows(), &["result", "balanced"], self.tables());
        let sweep = (self.points.len() > 1).then(|| self.plot());
        Payload { sweep, ..page }
    }

    /// Enters the result of solving the saved file again.
    pub fn check_saved(&mut self, saved: SavedPoint) {
        if let Some(why) = &saved.why {
            self.fall_short("not_reproduced", &format!("the saved design differs from the point: {why}"));
        }
        self.saved = Some(saved);
    }

    /// Enters that the design could not be saved.
    pub fn not_saved(&mut self, why: &str) {
        self.fall_short("not_saved", &format!("the design could not be saved: {why}"));
    }

    fn fall_short(&mut self, status: &'static str, message: &str) {
        if matches!(self.status, "front" | "no_conflict") {
            self.status = status;
        }
        self.message = format!("{}; {message}", self.message);
    }
}
