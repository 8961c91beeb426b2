//! Result of an optimisation: nominal and optimised goals, limits and variables, in the model's units.

use hardpoint::joint::Quantity;
use hardpoint::measure::Output;
use hardpoint::model::{
    Change, DesignVariable, Dimension, LimitTarget, Model, OptimizationSettings, OutputSource,
};
use hardpoint_file::{Diagnostic, ModelFile, Units};
use hardpoint_study::optimize::{
    ActiveConstraint, DesignAssessment, FailedDesign, Iteration, LIMIT_KEPT, Optimization, SearchResult,
    Status, judge,
};
use hardpoint_study::{Motions, Progress, Step};
use serde::Serialize;

use crate::figures::variable_unit;
use crate::figures::{error, number, seconds, some_of, symbol, unit, with_unit};
use crate::page::{Payload, Table};

/// Multiplier, as a fraction of the objective per range of a variable, below which an active constraint is not
/// reported.
const SLIGHT: f64 = 1e-9;
/// Maximum number of failed designs that are reported.
const REFUSED: usize = 20;

/// Result of an optimisation, in the model's units. Serialised as `summary.json` of `hardpoint optimize`.
#[derive(Clone, Debug, Serialize)]
pub struct OptimizeFacts {
    /// Program and version.
    pub generator: String,
    /// Kind of study.
    pub study: &'static str,
    /// Name of the model.
    pub model: String,
    /// Name of the model file.
    pub file: String,
    /// Outcome of the best search: `optimal`, `stuck`, `limits_not_kept`, `iteration_limit`, `interrupted` or
    /// `no_start`; or `not_reproduced` if the saved design does not move like the optimum, or `not_saved` if it could
    /// not be saved.
    pub status: &'static str,
    /// Status in words, with an instruction.
    pub message: String,
    /// Objective of the nominal and the optimised design: dimensionless sum over the goals.
    pub objective: BeforeAfter,
    /// Largest violation of a limit, as a fraction of its change over the bounds of the most influential variable.
    pub violation: BeforeAfter,
    /// Minimum margin to a singular position over all motions, of the nominal and the optimised design.
    pub margin: BeforeAfter,
    /// Saved design, read back from the file and solved again; `null` if none was saved.
    pub saved: Option<SavedFact>,
    /// Residual of the optimality (KKT) conditions: the part of the gradient that neither bounds nor limits balance,
    /// relative to the scale of the goals; 0 if all misfits vanish.
    pub kkt: Option<f64>,
    /// Number of the start of the best search; 0 is the nominal design.
    pub best_start: Option<usize>,
    /// Cost of the search.
    pub evaluations: Evaluations,
    /// Goals of the optimisation.
    pub goals: Vec<GoalFact>,
    /// Limits of the optimisation.
    pub limits: Vec<LimitFact>,
    /// Searched variables.
    pub variables: Vec<SearchedVariable>,
    /// Hardpoints that the optimised design moves.
    pub hardpoints: Vec<MovedHardpoint>,
    /// Iterations of the best search.
    pub iterations: Vec<IterationFact>,
    /// All searches.
    pub starts: Vec<StartFact>,
    /// The first designs that could not be evaluated.
    pub refused: Vec<RefusedFact>,
    /// Number of designs that could not be evaluated.
    pub refused_count: usize,
    /// Further diagnostics.
    pub diagnostics: Vec<Diagnostic>,
    /// Written files.
    pub files: Vec<String>,
    /// Duration, s.
    pub seconds: f64,
}

/// Value of the nominal design and of the optimised one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BeforeAfter {
    /// Nominal value; `null` if the nominal design cannot be evaluated.
    pub before: Option<f64>,
    /// Optimised value; `null` if no design was found.
    pub after: Option<f64>,
}

/// Saved design, read back from the file and solved again.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SavedFact {
    /// Name of the file.
    pub file: String,
    /// Objective of the saved design.
    pub objective: Option<f64>,
    /// Violation of the saved design, as [`OptimizeFacts::violation`].
    pub violation: Option<f64>,
    /// Minimum margin to a singular position over all motions.
    pub margin: Option<f64>,
    /// Reason why the design is not the optimum; `null` if it is.
    pub why: Option<String>,
}

/// Cost of an optimisation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Evaluations {
    /// Number of evaluated designs.
    pub designs: usize,
    /// Number of solved motions.
    pub motions: usize,
    /// Number of solved output times, each with its sensitivities.
    pub steps: usize,
}

/// Goal in one motion.
#[derive(Clone, Debug, Serialize)]
pub struct GoalFact {
    /// Name.
    pub name: String,
    /// Metric of the goal.
    pub metric: String,
    /// Name of the case; `null` if the model has no cases.
    pub case: Option<String>,
    /// Unit of the metric.
    pub unit: String,
    /// Target; `null` if the metric is minimised.
    pub target: Option<f64>,
    /// Weight per unit.
    pub weight: f64,
    /// Nominal and optimised value.
    #[serde(flatten)]
    pub value: BeforeAfter,
}

/// Limit, in one motion if it is on a metric.
#[derive(Clone, Debug, Serialize)]
pub struct LimitFact {
    /// Name.
    pub name: String,
    /// Limited quantity.
    pub of: String,
    /// Name of the case; `null` if the limit is not on a metric, or the model has no cases.
    pub case: Option<String>,
    /// Unit.
    pub unit: String,
    /// Lower end.
    pub min: Option<f64>,
    /// Upper end.
    pub max: Option<f64>,
    /// Nominal and optimised value.
    #[serde(flatten)]
    pub value: BeforeAfter,
    /// Active end: `min` or `max`.
    pub binds: Option<&'static str>,
    /// Decrease of the objective per unit by which the active end is relaxed.
    pub worth: Option<f64>,
}

/// Searched variable.
#[derive(Clone, Debug, Serialize)]
pub struct SearchedVariable {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Start of the best search, as a change from the nominal design.
    pub start: f64,
    /// End of the best search, as a change from the nominal design.
    pub end: f64,
    /// Bounds of the change.
    pub bounds: [f64; 2],
    /// Nominal value of the number that the variable changes; `null` if it changes more than one number.
    pub nominal: Option<f64>,
    /// Active bound: `lower` or `upper`.
    pub binds: Option<&'static str>,
    /// Decrease of the objective per unit by which the active bound is relaxed.
    pub worth: Option<f64>,
    /// Contribution to the change of the objective along the path of the best search.
    pub work: f64,
}

/// Hardpoint that the optimised design moves, in the length unit.
#[derive(Clone, Debug, Serialize)]
pub struct MovedHardpoint {
    /// Name.
    pub name: String,
    /// Nominal coordinates.
    pub before: [f64; 3],
    /// Optimised coordinates.
    pub after: [f64; 3],
}

/// Iteration of a search.
#[derive(Clone, Debug, Serialize)]
pub struct IterationFact {
    /// Number of the iteration; 0 is the start.
    pub iteration: usize,
    /// Objective at the iteration.
    pub objective: f64,
    /// Violation at the iteration, as [`OptimizeFacts::violation`].
    pub violation: f64,
    /// Step: largest change of a variable as a fraction of its bounds.
    pub step: f64,
    /// Variable with the largest change.
    pub moved: Option<String>,
    /// Change of that variable, in `unit`.
    pub by: Option<f64>,
    /// Unit.
    pub unit: Option<String>,
    /// Number of designs evaluated so far.
    pub designs: usize,
}

/// Search from one start.
#[derive(Clone, Debug, Serialize)]
pub struct StartFact {
    /// Number of the start; 0 is the nominal design.
    pub start: usize,
    /// Status at the end.
    pub status: &'static str,
    /// Objective of its best design.
    pub objective: Option<f64>,
    /// Violation of its best design, as [`OptimizeFacts::violation`].
    pub violation: Option<f64>,
    /// Number of iterations.
    pub iterations: usize,
    /// Number of evaluated designs.
    pub designs: usize,
    /// Number of these that could not be evaluated.
    pub refused: usize,
}

/// Design that could not be evaluated.
#[derive(Clone, Debug, Serialize)]
pub struct RefusedFact {
    /// Number of the search.
    pub start: usize,
    /// Name of the case.
    pub case: Option<String>,
    /// Reason.
    pub why: String,
    /// Values of the searched variables, in their units.
    pub values: Vec<f64>,
}

/// Word for a status in JSON.
pub fn status_word(status: Status) -> &'static str {
    match status {
        Status::Optimal => "optimal",
        Status::Stuck => "stuck",
        Status::LimitsNotKept => "limits_not_kept",
        Status::IterationLimit => "iteration_limit",
        Status::Interrupted => "interrupted",
        Status::NoStart => "no_start",
    }
}

/// SI value of one user unit of a quantity.
fn unit_in_si(units: Units, of: impl Into<Dimension>) -> f64 {
    1.0 / units.from_si(of.into(), 1.0)
}

/// Name of the case of a motion; `None` if the model has no cases.
pub fn case_name(model: &Model, motion: usize) -> Option<String> {
    model.cases.get(motion).map(|case| case.name.clone())
}

/// Line of text on a counted step of an optimisation, shown during the search.
pub fn progress_line(model: &Model, units: Units, progress: &Progress<'_>) -> Option<String> {
    match progress.step {
        Step::Iteration(iteration) if progress.is_counted => Some(iteration_line(model, units, iteration)),
        Step::Search(k, search) if progress.is_counted => Some(start_line(k, search)),
        Step::Iteration(_) | Step::Search(..) | Step::Variable | Step::Designs | Step::Fit(_) => None,
    }
}

/// Iteration as a line of text.
fn iteration_line(model: &Model, units: Units, i: &Iteration) -> String {
    let kept = match exceeded(i.violation) {
        Some(by) => format!("limits exceeded by {by}"),
        None => "limits kept".into(),
    };
    let kept = if model.optimization.as_ref().is_some_and(|o| o.limits.is_empty()) {
        String::new()
    } else {
        format!("  {kept}")
    };
    let moved = i.most.map_or(String::new(), |(v, by)| {
        let variable = &model.variables[v.0];
        let by = units.from_si(variable.quantity, by);
        let sign = if by < 0.0 { "" } else { "+" };
        format!("  {} {sign}{}", variable.name, with_unit(by, &variable_unit(model, units, variable)))
    });
    format!("{:>4}  objective {:<12}{kept}{moved}", i.number, number(i.objective))
}

/// Resolution of a saved design, as a fraction of its variables' bounds: finer digits are artefacts of the search.
const FINEST: f64 = 1e-9;

/// Finer resolutions, as fractions of the bounds, that are tried if a design with fewer digits does not move like the
/// optimum; the last one is full precision.
const FINER: [f64; 3] = [FINEST, 1e-12, 1e-16];
/// Additional violation of limits that a saved design may have due to rounding.
const SAVED: f64 = 1e-7;

/// Violation of limits in words; `None` if it is round-off.
fn exceeded(violation: f64) -> Option<String> {
    (violation > LIMIT_KEPT).then(|| error(violation))
}

/// Design to save: numbers with as few digits as still describe the optimum, checked by solving it.
pub fn to_save(
    file: &ModelFile,
    motions: &Motions<'_>,
    asked: &OptimizationSettings,
    design: &[f64],
) -> Vec<f64> {
    let moves =
        |design: &Vec<f64>| judge(&file.model, motions, asked, design).is_ok_and(|j| j.violation <= SAVED);
    let all = || FINER.iter().map(|finest| rounded_to(file, asked, design, *finest));
    all().find(moves).unwrap_or_else(|| rounded(file, asked, design))
}

/// Design with the searched variables rounded to few digits in the file's units.
pub fn rounded(file: &ModelFile, asked: &OptimizationSettings, design: &[f64]) -> Vec<f64> {
    rounded_to(file, asked, design, FINEST)
}

fn rounded_to(file: &ModelFile, asked: &OptimizationSettings, design: &[f64], finest: f64) -> Vec<f64> {
    let mut design = design.to_vec();
    for v in &asked.variables {
        let variable = &file.model.variables[v.0];
        let Some([low, high]) = variable.bounds else { continue };
        let [value, span] = [design[v.0], high - low].map(|x| file.units.from_si(variable.quantity, x));
        let step = 10.0_f64.powf((finest * span).log10().floor());
        let value = (value / step).round() * step;
        design[v.0] = file.units.to_si(variable.quantity, value).clamp(low, high);
    }
    design
}

/// Line on a search that ended, without header.
fn start_line(k: usize, search: &SearchResult) -> String {
    let from = if k == 0 { "nominal".into() } else { format!("start {k}") };
    let found = search.found.as_ref().map_or("-".into(), |f| number(f.objective));
    let status = in_words(search.status);
    format!("{from:>9}  objective {found:<12}  {status}, {} designs", search.cost.designs)
}

/// A status in a few words.
fn in_words(status: Status) -> &'static str {
    match status {
        Status::Optimal => "an optimum",
        Status::Stuck => "no further progress",
        Status::LimitsNotKept => "limits not kept",
        Status::IterationLimit => "iteration limit reached",
        Status::Interrupted => "interrupted",
        Status::NoStart => "cannot start",
    }
}

impl OptimizeFacts {
    /// Collects the facts of an optimisation.
    pub fn of(file: &ModelFile, asked: &OptimizationSettings, found: &Optimization) -> Self {
        let (model, units) = (&file.model, file.units);
        let best = found.best.map(|k| &found.searches[k]);
        let judged = best.and_then(|b| b.found.as_ref());
        let worst = found.searches.first().map_or(Status::NoStart, |s| s.status);
        let status = best.map_or(worst, |b| b.status);
        let before_after = |of: fn(&DesignAssessment) -> f64| BeforeAfter {
            before: found.nominal.as_ref().map(of),
            after: judged.map(of),
        };
        let refused =
            found.searches.iter().enumerate().flat_map(|(k, s)| s.refused.iter().map(move |r| (k, r)));
        let refused_fact = |(start, refused): (usize, &FailedDesign)| RefusedFact {
            start,
            case: refused.motion.and_then(|m| case_name(model, m)),
            why: refused.why.clone(),
            values: asked
                .variables
                .iter()
                .map(|v| units.from_si(model.variables[v.0].quantity, refused.design[v.0]))
                .collect(),
        };
        let mut facts = Self {
            generator: crate::GENERATOR.into(),
            study: "optimize",
            model: model.name.clone(),
            file: file.file_name().into(),
            status: status_word(status),
            message: String::new(),
            objective: before_after(|j| j.objective),
            violation: before_after(|j| j.violation),
            margin: BeforeAfter {
                before: found.nominal.as_ref().and_then(|j| j.margin),
                after: judged.and_then(|j| j.margin),
            },
            saved: None,
            kkt: best.map(|b| b.optimality.residual).filter(|r| r.is_finite()),
            best_start: found.best,
            evaluations: Evaluations {
                designs: found.cost.designs,
                motions: found.cost.motions,
                steps: found.cost.steps,
            },
            goals: goals(model, units, asked, found, judged),
            limits: limits(model, units, asked, found, best),
            variables: best.map_or(Vec::new(), |b| variables(file, asked, b)),
            hardpoints: judged.map_or(Vec::new(), |j| moved(model, units, &j.design)),
            iterations: best.map_or(Vec::new(), |b| iterations(model, units, b)),
            starts: found.searches.iter().enumerate().map(|(k, s)| start(k, s)).collect(),
            refused_count: refused.clone().count(),
            refused: refused.take(REFUSED).map(refused_fact).collect(),
            diagnostics: Vec::new(),
            files: Vec::new(),
            seconds: 0.0,
        };
        facts.message = facts.sentence(model, status, found);
        let begun = found.searches.iter().filter(|s| s.status != Status::Interrupted).count();
        if begun < found.searches.len() && status != Status::Interrupted {
            let all = found.searches.len();
            facts.message = format!(
                "interrupted with {begun} of {all} starts searched; the best so far: {}",
                facts.message
            );
            facts.status = status_word(Status::Interrupted);
        }
        facts
    }

    /// Sentence about the end of a search, with an instruction.
    fn sentence(&self, model: &Model, status: Status, found: &Optimization) -> String {
        let exceeded = || {
            let missed = |l: &&LimitFact| l.missed().is_some();
            let lines: Vec<String> = self.limits.iter().filter(missed).map(LimitFact::line).collect();
            if lines.is_empty() { String::new() } else { format!(": {}", some_of(&lines, "; ")) }
        };
        let binding: Vec<&str> =
            self.variables.iter().filter(|v| v.binds.is_some()).map(|v| v.name.as_str()).collect();
        match status {
            Status::Optimal if best_is_met(found) => "all goals are met: no improvement is possible".into(),
            Status::Optimal if binding.is_empty() => "an optimum: no small change of the design is better".into(),
            Status::Optimal => format!(
                "optimum found; {} are at their bounds, and wider bounds would improve it",
                some_of(&binding, ", ")
            ),
            Status::Stuck => "no step makes progress, although it is not quite an optimum: try more `starts`, or more output times \
                where a metric jumps"
                .into(),
            Status::LimitsNotKept => format!(
                "no design was found that keeps all limits{}; they contradict each other or the bounds: widen one of them, or \
                 try more `starts`",
                exceeded()
            ),
            Status::IterationLimit => {
                "the iteration limit was reached before an optimum: increase `max_iterations`".into()
            }
            Status::Interrupted => "interrupted: the best design so far".into(),
            Status::NoStart => {
                let drawn = found.nominal_failure.as_ref();
                let case = drawn.and_then(|r| case_name(model, r.motion?));
                let case = case.map_or(String::new(), |case| format!("case `{case}`: "));
                let why = drawn.map_or("", |r| r.why.as_str());
                format!("no design could be evaluated, not even the nominal one: {case}{why}")
            }
        }
    }

    /// Tables for printing: goals, limits, variables.
    pub fn tables(&self) -> Vec<Table> {
        let optional = |x: Option<f64>, unit: &str| x.map_or("-".into(), |x| with_unit(x, unit));
        let header = |names: &[&str]| names.iter().map(|n| (*n).to_owned()).collect::<Vec<_>>();
        let has_cases =
            self.goals.iter().any(|g| g.case.is_some()) || self.limits.iter().any(|l| l.case.is_some());
        let named = |name: &str, case: &Option<String>| match case {
            Some(case) if has_cases => format!("{name} ({case})"),
            _ => name.to_owned(),
        };
        let goal = |g: &GoalFact| {
            let target = g.target.map_or("small".into(), |t| with_unit(t, &g.unit));
            vec![
                named(&g.name, &g.case),
                optional(g.value.before, &g.unit),
                optional(g.value.after, &g.unit),
                target,
            ]
        };
        let mut tables = vec![Table {
            title: "Goals".into(),
            note: String::new(),
            header: header(&["goal", "nominal", "optimised", "target"]),
            rows: self.goals.iter().map(goal).collect(),
        }];
        if !self.limits.is_empty() {
            let limit = |l: &LimitFact| {
                let binds = l.binds.map_or(String::new(), |end| match l.worth {
                    Some(worth) => {
                        format!("{end}; 1 {} more is worth {}", unit_name(&l.unit), self.worth(worth))
                    }
                    None => end.into(),
                });
                vec![
                    named(&l.name, &l.case),
                    optional(l.value.before, &l.unit),
                    optional(l.value.after, &l.unit),
                    l.wanted(),
                    binds,
                ]
            };
            tables.push(Table {
                title: "Limits".into(),
                note: String::new(),
                header: header(&["limit", "nominal", "optimised", "required", "active"]),
                rows: self.limits.iter().map(limit).collect(),
            });
        }
        let total: f64 = self.variables.iter().map(|v| v.work.abs()).sum();
        let variable = |v: &SearchedVariable| {
            let binds = v.binds.map_or(String::new(), |end| match v.worth {
                Some(worth) => format!("{end}; 1 {} more is worth {}", unit_name(&v.unit), self.worth(worth)),
                None => end.into(),
            });
            let work = if total > 0.0 { format!("{:.0} %", 100.0 * -v.work / total) } else { String::new() };
            let [low, high] = v.bounds;
            vec![
                v.name.clone(),
                with_unit(v.value(v.start), &v.unit),
                with_unit(v.value(v.end), &v.unit),
                signed(v.end - v.start, &v.unit),
                format!("{} to {}", number(v.value(low)), number(v.value(high))),
                work,
                binds,
            ]
        };
        if !self.variables.is_empty() {
            tables.push(Table {
                title: "Design".into(),
                note: "Start, optimised value and bounds are values of the number that the variable changes; where it changes several, they are \
                    changes of the design configuration. Work is a variable's share of what was gained, along the way."
                    .into(),
                header: header(&["variable", "start", "optimised", "change", "bounds", "work", "active bound"]),
                rows: self.variables.iter().map(variable).collect(),
            });
        }
        if !self.hardpoints.is_empty() {
            let row = |h: &MovedHardpoint| {
                let place = |p: [f64; 3]| p.map(number).join(", ");
                vec![h.name.clone(), place(h.before), place(h.after)]
            };
            tables.push(Table {
                title: "Moved hardpoints".into(),
                note: String::new(),
                header: header(&["hardpoint", "nominal", "optimised"]),
                rows: self.hardpoints.iter().map(row).collect(),
            });
        }
        tables
    }

    /// Facts of the result, line by line.
    pub fn rows(&self) -> Vec<(&'static str, String)> {
        let BeforeAfter { before, after } = self.objective;
        let shown = |x: Option<f64>| x.map_or("-".into(), number);
        let Evaluations { designs, motions, .. } = self.evaluations;
        let mut rows = vec![
            ("result", self.message.clone()),
            ("objective", format!("{} nominal, {} optimised", shown(before), shown(after))),
        ];
        rows.extend(
            self.kkt
                .map(|kkt| ("optimality", format!("{} of the goals' gradient is unbalanced", error(kkt)))),
        );
        if let Some(after) = self.margin.after {
            let before = self.margin.before.map_or("-".into(), number);
            rows.push((
                "margin",
                format!("{before} nominal, {} optimised, to a singular position", number(after)),
            ));
        }
        if let Some(saved) = &self.saved {
            let is = match (&saved.why, saved.margin, saved.objective) {
                (Some(why), _, _) => {
                    format!("`{}` does not reproduce the optimised design: {why}", saved.file)
                }
                (None, margin, objective) => format!(
                    "`{}` was read and solved again: objective {}, margin {}",
                    saved.file,
                    shown(objective),
                    shown(margin)
                ),
            };
            rows.push(("saved", is));
        }
        if self.starts.len() > 1 {
            let ended = self.starts.iter().filter(|s| s.status == "optimal").count();
            let best = self.best_start.map_or("none".into(), |k| {
                if k == 0 { "the nominal design".into() } else { format!("start {k}") }
            });
            rows.push((
                "starts",
                format!("{}, {ended} of them ended in an optimum; the best is {best}", self.starts.len()),
            ));
        }
        let refused = match self.refused_count {
            0 => String::new(),
            n => format!(", {n} of which could not be evaluated"),
        };
        rows.push(("evaluated", format!("{designs} designs{refused}, {motions} motions")));
        rows
    }

    /// Formatted multiplier in the unit of the only goal, or of the objective.
    fn worth(&self, worth: f64) -> String {
        match &self.goals[..] {
            [goal] => {
                let value = goal.value.after.unwrap_or(f64::NAN);
                let miss = (value - goal.target.unwrap_or(0.0)).abs();
                // f = (w m)^2 or w m:  dm = df / (2 w^2 m) or df / w
                let squares = self.is_square(goal);
                let by = if squares { 2.0 * goal.weight * goal.weight * miss } else { goal.weight };
                if by.abs() > 0.0 { with_unit(worth / by, &goal.unit) } else { number(worth) }
            }
            _ => format!("{} of the objective", number(worth)),
        }
    }

    fn is_square(&self, goal: &GoalFact) -> bool {
        let squares = |value: f64, objective: f64| {
            let miss = goal.weight * (value - goal.target.unwrap_or(0.0));
            (objective - miss * miss).abs() <= (objective - goal.weight * value).abs()
        };
        goal.target.is_some()
            || goal
                .value
                .after
                .zip(self.objective.after)
                .is_some_and(|(value, objective)| squares(value, objective))
    }

    /// Turns the page of the nominal design into that of the search: the result comes first among the checks, and the
    /// page opens on the curve of the first goal of this motion, over its abscissa.
    pub fn page(&self, mut page: Payload, model: &Model, outputs: &[Output]) -> Payload {
        let place = |of: OutputSource| outputs.iter().position(|o| o.source == of);
        let goal = |g: &GoalFact| model.metrics.iter().find(|m| m.name == g.metric);
        if let Some(metric) = self.goals.iter().find_map(goal) {
            page.first = place(metric.of).or(page.first);
            page.over = metric.over.and_then(place);
        }
        let rows = self.rows().into_iter().map(|(what, is)| vec![what.into(), is]).collect();
        let result = Table {
            title: "The search".into(),
            note: String::new(),
            header: ["", "is"].map(String::from).to_vec(),
            rows,
        };
        let mut checks = vec![result];
        checks.extend(self.tables());
        checks.extend([self.iteration_table()]);
        checks.append(&mut page.checks);
        Payload { checks, ..page }
    }

    fn iteration_table(&self) -> Table {
        let row = |i: &IterationFact| {
            let moved = i.moved.as_ref().zip(i.by).map_or(String::new(), |(name, by)| {
                format!("{name} {}", with_unit(by, i.unit.as_deref().unwrap_or_default()))
            });
            vec![
                i.iteration.to_string(),
                number(i.objective),
                exceeded(i.violation).unwrap_or_else(|| "kept".into()),
                moved,
                i.designs.to_string(),
            ]
        };
        Table {
            title: "Iterations".into(),
            note: String::new(),
            header: ["iteration", "objective", "limits exceeded by", "moved most", "designs"]
                .map(String::from)
                .to_vec(),
            rows: self.iterations.iter().map(row).collect(),
        }
    }

    /// Line about the duration.
    pub fn time_line(&self) -> String {
        seconds(self.seconds)
    }
}

/// Name of a unit in a sentence.
fn unit_name(unit: &str) -> &str {
    if unit.is_empty() || unit == "1" { "unit" } else { unit }
}

impl LimitFact {
    /// Violation of the limit, in its unit.
    fn missed(&self) -> Option<f64> {
        let value = self.value.after?;
        let below = self.min.map_or(0.0, |min| min - value);
        let above = self.max.map_or(0.0, |max| value - max);
        Some(below.max(above)).filter(|by| *by > MISSED * value.abs().max(1.0))
    }

    fn wanted(&self) -> String {
        let shown = |x: f64| with_unit(x, &self.unit);
        match (self.min, self.max) {
            (Some(min), Some(max)) if min == max => shown(min),
            (Some(min), Some(max)) => format!("{} to {}", number(min), shown(max)),
            (Some(min), None) => format!("{} at least", shown(min)),
            (None, Some(max)) => format!("{} at most", shown(max)),
            (None, None) => String::new(),
        }
    }

    fn line(&self) -> String {
        let value = self.value.after.map_or("-".into(), |x| with_unit(x, &self.unit));
        let case = self.case.as_ref().map_or(String::new(), |case| format!(" in `{case}`"));
        format!("`{}`{case} is {value} instead of {}", self.name, self.wanted())
    }
}

/// A limit that is exceeded by less than this fraction of its value is reported as satisfied.
const MISSED: f64 = 1e-7;

fn goals(
    model: &Model,
    units: Units,
    asked: &OptimizationSettings,
    found: &Optimization,
    judged: Option<&DesignAssessment>,
) -> Vec<GoalFact> {
    let some = found.nominal.as_ref().or(judged);
    let taken = some.map_or(&[][..], |j| &j.goals[..]);
    let fact = |(k, (goal, motion, _)): (usize, &(usize, usize, f64))| {
        let goal = &asked.goals[*goal];
        let metric = &model.metrics[goal.metric];
        let dimension = model.metric_dimension(metric);
        let shown = |x: f64| units.from_si(dimension, x);
        let value = |j: Option<&DesignAssessment>| j.and_then(|j| j.goals.get(k)).map(|g| shown(g.2));
        GoalFact {
            name: goal.name.clone(),
            metric: metric.name.clone(),
            case: case_name(model, *motion),
            unit: unit(units, dimension),
            target: goal.target.or(metric.take.target().map(|_| 0.0)).map(shown),
            weight: goal.weight * unit_in_si(units, dimension),
            value: BeforeAfter { before: value(found.nominal.as_ref()), after: value(judged) },
        }
    };
    taken.iter().enumerate().map(fact).collect()
}

fn limits(
    model: &Model,
    units: Units,
    asked: &OptimizationSettings,
    found: &Optimization,
    best: Option<&SearchResult>,
) -> Vec<LimitFact> {
    let judged = best.and_then(|b| b.found.as_ref());
    let some = found.nominal.as_ref().or(judged);
    let taken = some.map_or(&[][..], |j| &j.limits[..]);
    let hardpoint = |h: hardpoint::model::HardpointId| model.hardpoints[h.0].name.as_str();
    let fact = |(k, (limit, motion, _)): (usize, &(usize, Option<usize>, f64))| {
        let (place, limit) = (*limit, &asked.limits[*limit]);
        let (dimension, of) = match limit.of {
            LimitTarget::Metric(m) => {
                let metric = &model.metrics[m];
                (model.metric_dimension(metric), format!("metric `{}`", metric.name))
            }
            LimitTarget::Coordinate(h, axis) => {
                (Dimension::LENGTH, format!("`{}.{}`", hardpoint(h), ["x", "y", "z"][axis]))
            }
            LimitTarget::Distance(a, b) => {
                (Dimension::LENGTH, format!("distance of `{}` and `{}`", hardpoint(a), hardpoint(b)))
            }
            LimitTarget::Length(j) => (Dimension::LENGTH, format!("length of `{}`", model.joints[j.0].name)),
        };
        let shown = |x: f64| units.from_si(dimension, x);
        let value = |j: Option<&DesignAssessment>| j.and_then(|j| j.limits.get(k)).map(|l| shown(l.2));
        let binding = best.into_iter().flat_map(|b| &b.optimality.binding);
        let binds = |(what, worth): &(ActiveConstraint, f64)| match *what {
            ActiveConstraint::Least(l, m) if l == place && m == *motion => Some(("min", *worth)),
            ActiveConstraint::Most(l, m) if l == place && m == *motion => Some(("max", *worth)),
            _ => None,
        };
        let binds = binding.filter_map(binds).next();
        LimitFact {
            name: limit.name.clone(),
            of,
            case: motion.and_then(|m| case_name(model, m)),
            unit: unit(units, dimension),
            min: limit.least.map(shown),
            max: limit.most.map(shown),
            value: BeforeAfter { before: value(found.nominal.as_ref()), after: value(judged) },
            binds: binds.map(|b| b.0),
            worth: binds.map(|b| b.1 * unit_in_si(units, dimension)),
        }
    };
    taken.iter().enumerate().map(fact).collect()
}

/// A change below this fraction of the bounds is round-off.
const ROUND_OFF: f64 = 1e-15;

fn without_round_off(x: f64, [low, high]: [f64; 2]) -> f64 {
    if x.abs() <= ROUND_OFF * (high - low) { 0.0 } else { x }
}

/// Nominal value, SI, of the number in the file that a variable changes, if there is exactly one.
fn nominal(file: &ModelFile, variable: &DesignVariable) -> Option<f64> {
    let model = &file.model;
    let number = |change: &Change| match change {
        Change::Move(m) => {
            let along = (0..3).find(|axis| m.velocity[*axis] == 1.0 && m.velocity.norm() == 1.0);
            along.map(|axis| model.hardpoints[m.hardpoint.0].position[axis])
        }
        Change::Length(c) => model.joints[c.joint.0].length.filter(|_| c.rate == 1.0),
        Change::Parameter(c) => Some(model.parameters[c.parameter.0].value).filter(|_| c.rate == 1.0),
        Change::Marker(_) | Change::Law(_) | Change::Field(_) => None,
    };
    let mut parameters = variable.changes.iter().filter(|change| matches!(change, Change::Parameter(_)));
    if let Some(value) = parameters.find_map(number) {
        return Some(value);
    }
    // Mirrored changes are not numbers of the file.
    let is_image = |change: &Change| matches!(change, Change::Move(m) if file.is_image(&model.hardpoints[m.hardpoint.0].name));
    let mut own = variable.changes.iter().filter(|change| !is_image(change));
    match (own.next(), own.next()) {
        (Some(only), None) => number(only),
        (None, _) | (Some(_), Some(_)) => None,
    }
}

/// True if the best search ended where all goals vanish.
fn best_is_met(found: &Optimization) -> bool {
    found.best.is_some_and(|k| found.searches[k].optimality.met)
}

/// Formatted change with its sign.
fn signed(by: f64, unit: &str) -> String {
    format!("{}{}", if by > 0.0 { "+" } else { "" }, with_unit(by, unit))
}

impl SearchedVariable {
    /// Value after a change, or the change itself if there is no nominal value.
    fn value(&self, change: f64) -> f64 {
        self.nominal.map_or(change, |nominal| without_round_off(nominal + change, self.bounds))
    }
}

impl OptimizeFacts {
    /// Enters the result of solving the saved file again. A design that does not reproduce the optimum gets another
    /// status. `margin` is the minimum margin of the search.
    pub fn check_saved(&mut self, to: &str, judged: Result<DesignAssessment, String>, margin: Option<f64>) {
        let mut saved = SavedFact { file: to.into(), ..SavedFact::default() };
        match judged {
            Ok(judged) => {
                saved.objective = Some(judged.objective);
                saved.violation = Some(judged.violation);
                saved.margin = judged.margin;
                if judged.violation > SAVED.max(2.0 * self.violation.after.unwrap_or(0.0)) {
                    saved.why = Some(format!("it exceeds limits by {}", error(judged.violation)));
                }
            }
            Err(why) => saved.why = Some(why),
        }
        if let Some(why) = &saved.why {
            let advice = match margin {
                None => "; if it is too near to a singular position, set `min_margin` in `[optimize]`",
                Some(_) => "",
            };
            self.fall_short(
                "not_reproduced",
                &format!("the saved design differs from the optimised one: {why}{advice}"),
            );
        }
        self.saved = Some(saved);
    }

    /// Enters that the result could not be saved.
    pub fn not_saved(&mut self, why: &str) {
        self.fall_short("not_saved", &format!("the result could not be saved: {why}"));
    }

    fn fall_short(&mut self, status: &'static str, message: &str) {
        if self.status == "optimal" {
            self.status = status;
            self.message = message.into();
        } else {
            self.message = format!("{}; {message}", self.message);
        }
    }
}

fn variables(file: &ModelFile, asked: &OptimizationSettings, best: &SearchResult) -> Vec<SearchedVariable> {
    let (model, units) = (&file.model, file.units);
    let end = best.found.as_ref().map_or(&best.start, |j| &j.design);
    let objective = best.found.as_ref().map_or(0.0, |j| j.objective.abs());
    let fact = |(k, v): (usize, &hardpoint::model::VariableId)| {
        let variable = &model.variables[v.0];
        let shown = |x: f64| units.from_si(variable.quantity, x);
        let bounds = variable.bounds.unwrap_or_default();
        let binds = |(what, worth): &(ActiveConstraint, f64)| match *what {
            ActiveConstraint::Lower(of) if of == k => Some(("lower", *worth)),
            ActiveConstraint::Upper(of) if of == k => Some(("upper", *worth)),
            _ => None,
        };
        let is_relevant = |(_, worth): &(&str, f64)| worth * (bounds[1] - bounds[0]) > SLIGHT * objective;
        let binds = best.optimality.binding.iter().filter_map(binds).find(is_relevant);
        SearchedVariable {
            name: variable.name.clone(),
            unit: variable_unit(model, units, variable),
            start: without_round_off(shown(best.start[v.0]), bounds.map(shown)),
            end: without_round_off(shown(end[v.0]), bounds.map(shown)),
            bounds: bounds.map(shown),
            nominal: nominal(file, variable).map(shown),
            binds: binds.map(|b| b.0),
            worth: binds.map(|b| b.1 * unit_in_si(units, variable.quantity)),
            work: best.work[k],
        }
    };
    asked.variables.iter().enumerate().map(fact).collect()
}

pub(crate) fn moved(model: &Model, units: Units, design: &[f64]) -> Vec<MovedHardpoint> {
    let [before, after] = [&[][..], design].map(|d| model.hardpoint_places(d));
    let named = model.hardpoints.iter().zip(before.iter().zip(&after)).filter(|(h, _)| !h.unnamed);
    let shown = |p: hardpoint::space::Vec3| p.to_array().map(|x| units.from_si(Quantity::Length, x));
    let moved = named.filter(|(_, (a, b))| (**a - **b).norm() > 0.0);
    moved
        .map(|(h, (a, b))| MovedHardpoint { name: h.name.clone(), before: shown(*a), after: shown(*b) })
        .collect()
}

fn iterations(model: &Model, units: Units, search: &SearchResult) -> Vec<IterationFact> {
    let fact = |i: &Iteration| {
        let variable = i.most.map(|(v, by)| (&model.variables[v.0], by));
        IterationFact {
            iteration: i.number,
            objective: i.objective,
            violation: i.violation,
            step: i.step,
            moved: variable.map(|(v, _)| v.name.clone()),
            by: variable.map(|(v, by)| units.from_si(v.quantity, by)),
            unit: variable.map(|(v, _)| symbol(units, v.quantity).to_owned()),
            designs: i.designs,
        }
    };
    search.iterations.iter().map(fact).collect()
}

fn start(k: usize, search: &SearchResult) -> StartFact {
    StartFact {
        start: k,
        status: status_word(search.status),
        objective: search.found.as_ref().map(|f| f.objective),
        violation: search.found.as_ref().map(|f| f.violation),
        iterations: search.iterations.len().saturating_sub(1),
        designs: search.cost.designs,
        refused: search.refused.len(),
    }
}
