//! Result of an optimisation: nominal and optimised goals, limits and variables, in the model's units.

use std::sync::Arc;

use hardpoint::joint::Quantity;
use hardpoint::measure::Output;
use hardpoint::model::{Dimension, LimitTarget, Model, OptimizationSettings, StartPlacement, VariableId};
use hardpoint::space::Vec3;
use hardpoint::topology::Formulation;
use hardpoint_file::{Diagnostic, Diagnostics, ModelFile, Units};
use hardpoint_study::optimize::{
    ActiveConstraint, DesignAssessment, FailedDesign, Iteration, LIMIT_KEPT, Optimization, SearchResult,
    Status, Variant, judge,
};
use hardpoint_study::{Motions, Progress, Step};
use serde::Serialize;

use crate::figures::{error, number, some_of, symbol, unit, variable_unit, with_unit};
use crate::page::{Payload, Table};
use crate::record::{Column, record};
use crate::study::{
    BeforeAfter, Evaluations, MovedHardpoint, case_name, nominal_number, range, signed, titled, value_of,
    without_round_off,
};

/// Multiplier, as a fraction of the objective per range of a variable, below which an active constraint is not
/// reported.
const SLIGHT: f64 = 1e-9;
/// Maximum number of failed designs that are reported.
const REFUSED: usize = 20;

/// A finished search, with its inputs.
#[derive(Clone, Copy)]
struct Search<'a> {
    file: &'a ModelFile,
    asked: &'a OptimizationSettings,
    found: &'a Optimization,
}

impl<'a> Search<'a> {
    fn model(&self) -> &'a Model {
        &self.file.model
    }

    fn units(&self) -> Units {
        self.file.units
    }

    fn best(&self) -> Option<&'a SearchResult> {
        self.found.best.map(|k| &self.found.searches[k])
    }

    /// Status of the best search, or else of the first.
    fn status(&self) -> Status {
        self.best().or(self.found.searches.first()).map_or(Status::NoStart, |s| s.status)
    }

    /// The optimised design.
    fn judged(&self) -> Option<&'a DesignAssessment> {
        self.best()?.found.as_ref()
    }

    /// The nominal design, or else the optimised one: both have the same goals and limits.
    fn any(&self) -> Option<&'a DesignAssessment> {
        self.found.nominal.as_ref().or(self.judged())
    }

    /// A value of the nominal and of the optimised design.
    fn before_after(&self, of: impl Fn(&DesignAssessment) -> Option<f64>) -> BeforeAfter {
        BeforeAfter { before: self.found.nominal.as_ref().and_then(&of), after: self.judged().and_then(&of) }
    }

    /// Designs that could not be evaluated, with the numbers of their searches.
    fn refused(&self) -> impl Iterator<Item = (usize, &'a FailedDesign)> {
        let searches = self.found.searches.iter().enumerate();
        searches.flat_map(|(k, s)| s.refused.iter().map(move |r| (k, r)))
    }
}

record! {
    /// Result of an optimisation, in the model's units. Serialised as `summary.json` of `hardpoint optimize`.
    OptimizeFacts::without_message(search: Search<'_>) {
        let Search { file, asked, found } = search;
        let (model, best) = (search.model(), search.best());
        let [goals, limits] = search.any().map_or([0; 2], |j| [j.goals.len(), j.limits.len()]);
        let variable = |b| move |k| SearchedVariable::of(search, b, k);
        let variables = best.into_iter().flat_map(|b| (0..asked.variables.len()).map(variable(b)));
        let hardpoints = search.judged().map(|j| MovedHardpoint::all(model, file.units, &j.design));
        let iterations = best.into_iter().flat_map(|b| &b.iterations);
        let iterations = iterations.map(|i| IterationFact::of(model, file.units, i));
    }
    /// Program and version.
    generator: String = crate::GENERATOR.into();
    /// Kind of study.
    study: &'static str = "optimize";
    /// Name of the model.
    model: String = model.name.clone();
    /// Name of the model file.
    file: String = file.file_name().into();
    /// Outcome of the best search: `optimal`, `no_effect`, `stuck`, `limits_not_kept`, `iteration_limit`, `interrupted`
    /// or `no_start`; or `not_reproduced` if the saved design does not move like the optimum, or `not_saved` if it
    /// could not be saved.
    status: &'static str = status_word(search.status());
    /// Status in words, with an instruction.
    message: String = String::new();
    /// Objective of the nominal and the optimised design: dimensionless sum over the goals.
    objective: BeforeAfter = search.before_after(|j| Some(j.objective));
    /// Largest violation of a limit, as a fraction of its change over the bounds of the most influential variable.
    violation: BeforeAfter = search.before_after(|j| Some(j.violation));
    /// Minimum margin to a singular position over all motions, of the nominal and the optimised design.
    margin: BeforeAfter = search.before_after(|j| j.margin);
    /// Saved design, read back from the file and solved again; `null` if none was saved.
    saved: Option<SavedFact> = None;
    /// Residual of the optimality (KKT) conditions: the part of the gradient that neither bounds nor limits balance,
    /// relative to the scale of the goals; 0 if all misfits vanish.
    kkt: Option<f64> = best.map(|b| b.optimality.residual).filter(|r| r.is_finite());
    /// Number of the start of the best search; 0 is the nominal design.
    best_start: Option<usize> = found.best;
    /// Cost of the search.
    evaluations: Evaluations = Evaluations::of(found.cost);
    /// Goals of the optimisation.
    goals: Vec<GoalFact> = (0..goals).map(|k| GoalFact::of(search, k)).collect();
    /// Limits of the optimisation.
    limits: Vec<LimitFact> = (0..limits).map(|k| LimitFact::of(search, k)).collect();
    /// Searched variables.
    variables: Vec<SearchedVariable> = variables.collect();
    /// Hardpoints that the optimised design moves.
    hardpoints: Vec<MovedHardpoint> = hardpoints.unwrap_or_default();
    /// Iterations of the best search.
    iterations: Vec<IterationFact> = iterations.collect();
    /// Distinct optima, the best first; searches that ended elsewhere are in none of them.
    optima: Vec<OptimumFact> =
        found.optima(model, asked).iter().map(|starts| OptimumFact::of(search, starts)).collect();
    /// Assemblies that were searched, if there are several; the first is that of the model.
    assemblies: Vec<AssemblyFact> = AssemblyFact::all(search);
    /// Unit of angles.
    angle_unit: String = symbol(file.units, Quantity::Angle).to_owned();
    /// All searches.
    starts: Vec<StartFact> = found.searches.iter().enumerate().map(|(k, s)| StartFact::of(search, k, s)).collect();
    /// The first designs that could not be evaluated.
    refused: Vec<RefusedFact> = search.refused().take(REFUSED).map(|(k, r)| RefusedFact::of(search, k, r)).collect();
    /// Number of designs that could not be evaluated.
    refused_count: usize = search.refused().count();
    /// Further diagnostics.
    diagnostics: Vec<Diagnostic> = Vec::new();
    /// Written files.
    files: Vec<String> = Vec::new();
    /// Duration, s.
    seconds: f64 = 0.0;
}

record! {
    /// Goal in one motion.
    GoalFact::of(search: Search<'_>, k: usize) {
        let (model, units) = (search.model(), search.units());
        let (goal, motion, _) = search.any().expect("a goal of a design").goals[k];
        let goal = &search.asked.goals[goal];
        let metric = &model.metrics[goal.metric];
        let dimension = model.metric_dimension(metric);
        let shown = |x: f64| units.from_si(dimension, x);
    }
    /// Name.
    name: String = goal.name.clone();
    /// Metric of the goal.
    metric: String = metric.name.clone();
    /// Name of the case; `null` if the model has no cases.
    case: Option<String> = case_name(model, motion);
    /// Unit of the metric.
    unit: String = unit(units, dimension);
    /// Target; `null` if the metric is minimised.
    target: Option<f64> = goal.target.or(metric.take.target().map(|_| 0.0)).map(shown);
    /// Weight per unit.
    weight: f64 = goal.weight * unit_in_si(units, dimension);
    /// Nominal and optimised value.
    #[serde(flatten)]
    value: BeforeAfter = search.before_after(|j| j.goals.get(k).map(|g| shown(g.2)));
}

record! {
    /// Limit, in one motion if it is on a metric.
    LimitFact::of(search: Search<'_>, k: usize) {
        let (model, units) = (search.model(), search.units());
        let (place, motion, _) = search.any().expect("a limit of a design").limits[k];
        let limit = &search.asked.limits[place];
        let hardpoint = |h: hardpoint::model::HardpointId| model.hardpoints[h.0].name.as_str();
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
            LimitTarget::Margin => (Dimension::NUMBER, "margin to a singular position".into()),
        };
        let shown = |x: f64| units.from_si(dimension, x);
        let binding = search.best().into_iter().flat_map(|b| &b.optimality.binding);
        let binds = |(what, worth): &(ActiveConstraint, f64)| match *what {
            ActiveConstraint::Least(l, m) if l == place && m == motion => Some(("min", *worth)),
            ActiveConstraint::Most(l, m) if l == place && m == motion => Some(("max", *worth)),
            ActiveConstraint::Least(..)
            | ActiveConstraint::Most(..)
            | ActiveConstraint::Lower(_)
            | ActiveConstraint::Upper(_) => None,
        };
        let binds = binding.filter_map(binds).next();
    }
    /// Name.
    name: String = limit.name.clone();
    /// Limited quantity.
    of: String = of;
    /// Name of the case; `null` if the limit is not on a metric, or the model has no cases.
    case: Option<String> = motion.and_then(|m| case_name(model, m));
    /// Unit.
    unit: String = unit(units, dimension);
    /// Lower end.
    min: Option<f64> = limit.least.map(shown);
    /// Upper end.
    max: Option<f64> = limit.most.map(shown);
    /// Nominal and optimised value.
    #[serde(flatten)]
    value: BeforeAfter = search.before_after(|j| j.limits.get(k).map(|l| shown(l.2)));
    /// Active end: `min` or `max`.
    binds: Option<&'static str> = binds.map(|b| b.0);
    /// Decrease of the objective per unit by which the active end is relaxed.
    worth: Option<f64> = binds.map(|b| b.1 * unit_in_si(units, dimension));
}

record! {
    /// Searched variable.
    SearchedVariable::of(search: Search<'_>, best: &SearchResult, k: usize) {
        let (file, model, units) = (search.file, search.model(), search.units());
        let end = best.found.as_ref().map_or(&best.start, |j| &j.design);
        let objective = best.found.as_ref().map_or(0.0, |j| j.objective.abs());
        let v = search.asked.variables[k];
        let variable = &model.variables[v.0];
        let shown = |x: f64| units.from_si(variable.quantity, x);
        let bounds = variable.bounds.unwrap_or_default();
        let binds = |(what, worth): &(ActiveConstraint, f64)| match *what {
            ActiveConstraint::Lower(of) if of == k => Some(("lower", *worth)),
            ActiveConstraint::Upper(of) if of == k => Some(("upper", *worth)),
            ActiveConstraint::Least(..)
            | ActiveConstraint::Most(..)
            | ActiveConstraint::Lower(_)
            | ActiveConstraint::Upper(_) => None,
        };
        let is_relevant = |(_, worth): &(&str, f64)| worth * (bounds[1] - bounds[0]) > SLIGHT * objective;
        let binds = best.optimality.binding.iter().filter_map(binds).find(is_relevant);
    }
    /// Name.
    name: String = variable.name.clone();
    /// Unit.
    unit: String = variable_unit(model, units, variable);
    /// Start of the best search, as a change from the nominal design.
    start: f64 = without_round_off(shown(best.start[v.0]), bounds.map(shown));
    /// End of the best search, as a change from the nominal design.
    end: f64 = without_round_off(shown(end[v.0]), bounds.map(shown));
    /// Bounds of the change.
    bounds: [f64; 2] = bounds.map(shown);
    /// Nominal value of the number that the variable changes; `null` if it changes more than one number.
    nominal: Option<f64> = nominal_number(file, variable).map(shown);
    /// Active bound: `lower` or `upper`.
    binds: Option<&'static str> = binds.map(|b| b.0);
    /// Decrease of the objective per unit by which the active bound is relaxed.
    worth: Option<f64> = binds.map(|b| b.1 * unit_in_si(units, variable.quantity));
    /// Contribution to the change of the objective along the path of the best search.
    work: f64 = best.work[k];
}

record! {
    /// Iteration of a search.
    IterationFact::of(model: &Model, units: Units, i: &Iteration) {
        let variable = i.most.map(|(v, by)| (&model.variables[v.0], by));
    }
    /// Number of the iteration; 0 is the start.
    iteration: usize = i.number;
    /// Objective at the iteration.
    objective: f64 = i.objective;
    /// Violation at the iteration, as [`OptimizeFacts::violation`].
    violation: f64 = i.violation;
    /// Step: largest change of a variable as a fraction of its bounds.
    step: f64 = i.step;
    /// Variable with the largest change.
    moved: Option<String> = variable.map(|(v, _)| v.name.clone());
    /// Change of that variable, in `unit`.
    by: Option<f64> = variable.map(|(v, by)| units.from_si(v.quantity, by));
    /// Unit.
    unit: Option<String> = variable.map(|(v, _)| symbol(units, v.quantity).to_owned());
    /// Number of designs evaluated so far.
    designs: usize = i.designs;
}

record! {
    /// Optimum that one or several searches ended in.
    OptimumFact::of(search: Search<'_>, starts: &[usize]) {
        let (model, units) = (search.model(), search.units());
        let best = &search.found.searches[starts[0]];
        let design = best.found.as_ref().expect("an optimum has a design");
        let goal = |(goal, _, value): &(usize, usize, f64)| {
            units.from_si(model.metric_dimension(&model.metrics[search.asked.goals[*goal].metric]), *value)
        };
        let change = |v: &VariableId| units.from_si(model.variables[v.0].quantity, design.design[v.0]);
        let variant = &search.found.variants[best.variant];
    }
    /// Number of its assembly; 1 is that of the model.
    assembly: usize = variant.assembly + 1;
    /// True if all drivers move in the opposite sense of the model's.
    reversed: bool = variant.reversed;
    /// Numbers of the searches that ended in it.
    starts: Vec<usize> = starts.to_vec();
    /// Objective.
    objective: f64 = design.objective;
    /// Residual of the optimality conditions, as [`OptimizeFacts::kkt`].
    kkt: f64 = best.optimality.residual;
    /// Values of the goals, in their order.
    goals: Vec<f64> = design.goals.iter().map(goal).collect();
    /// Changes of the variables, in their order.
    changes: Vec<f64> = search.asked.variables.iter().map(change).collect();
}

record! {
    /// Search from one start.
    StartFact::of(all: Search<'_>, k: usize, search: &SearchResult) {
        let variant = &all.found.variants[search.variant];
    }
    /// Number of the start; 0 is the nominal design.
    start: usize = k;
    /// Number of its assembly; 1 is that of the model.
    assembly: usize = variant.assembly + 1;
    /// True if all drivers move in the opposite sense of the model's.
    reversed: bool = variant.reversed;
    /// Status at the end.
    status: &'static str = status_word(search.status);
    /// Objective of its best design.
    objective: Option<f64> = search.found.as_ref().map(|f| f.objective);
    /// Violation of its best design, as [`OptimizeFacts::violation`].
    violation: Option<f64> = search.found.as_ref().map(|f| f.violation);
    /// Number of iterations.
    iterations: usize = search.iterations.len().saturating_sub(1);
    /// Number of evaluated designs.
    designs: usize = search.cost.designs;
    /// Number of these that could not be evaluated.
    refused: usize = search.refused.len();
}

record! {
    /// Assembly of the mechanism that was searched.
    AssemblyFact::of(search: Search<'_>, variant: &Variant) {
        let placed = |placement: &StartPlacement| PlacedBody::of(search.model(), search.units(), placement);
    }
    /// Number; 1 is that of the model.
    assembly: usize = variant.assembly + 1;
    /// Bodies that are not in their places in the design configuration, of the nominal design.
    bodies: Vec<PlacedBody> = variant.start.iter().map(placed).collect();
}

record! {
    /// Displacement of a body from the design configuration, as in the table `start` of model files.
    PlacedBody::of(model: &Model, units: Units, placement: &StartPlacement) {
        let shown = |quantity: Quantity, v: Vec3| v.to_array().map(|x| units.from_si(quantity, x));
    }
    /// Name.
    body: String = model.bodies[placement.body.0].name.clone();
    /// Rotation vector about the global origin, in the angle unit.
    turn: [f64; 3] = shown(Quantity::Angle, placement.turn());
    /// Translation after the rotation, in the length unit.
    shift: [f64; 3] = shown(Quantity::Length, placement.shift());
}

impl AssemblyFact {
    /// All assemblies, if there are several.
    fn all(search: Search<'_>) -> Vec<Self> {
        let variants = &search.found.variants;
        let first = variants
            .iter()
            .enumerate()
            .filter(|(k, v)| variants[..*k].iter().all(|before| before.assembly != v.assembly));
        let all: Vec<Self> = first.map(|(_, variant)| Self::of(search, variant)).collect();
        if all.len() > 1 { all } else { Vec::new() }
    }
}

record! {
    /// Design that could not be evaluated.
    RefusedFact::of(search: Search<'_>, start: usize, refused: &FailedDesign) {
        let (model, units) = (search.model(), search.units());
        let value = |v: &VariableId| units.from_si(model.variables[v.0].quantity, refused.design[v.0]);
    }
    /// Number of the search.
    start: usize = start;
    /// Name of the case.
    case: Option<String> = refused.motion.and_then(|m| case_name(model, m));
    /// Reason.
    why: String = refused.why.clone();
    /// Values of the searched variables, in their units.
    values: Vec<f64> = search.asked.variables.iter().map(value).collect();
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

/// Word for a status in JSON.
pub fn status_word(status: Status) -> &'static str {
    match status {
        Status::Optimal => "optimal",
        Status::NoEffect => "no_effect",
        Status::Stuck => "stuck",
        Status::LimitsNotKept => "limits_not_kept",
        Status::IterationLimit => "iteration_limit",
        Status::Interrupted => "interrupted",
        Status::NoStart => "no_start",
    }
}

/// SI value of one user unit of a quantity.
pub(crate) fn unit_in_si(units: Units, of: impl Into<Dimension>) -> f64 {
    1.0 / units.from_si(of.into(), 1.0)
}

/// Line of text on a counted step of an optimisation, shown during the search.
pub fn progress_line(model: &Model, units: Units, progress: &Progress<'_>) -> Option<String> {
    match progress.step {
        Step::Iteration(iteration) if progress.is_counted => Some(iteration_line(model, units, iteration)),
        Step::Search(k, search) if progress.is_counted => Some(start_line(k, search)),
        Step::Iteration(_)
        | Step::Search(..)
        | Step::Variable
        | Step::Designs
        | Step::FrontPoint
        | Step::Fit(_) => None,
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

/// File in the assembly and sense of a variant, with its motions: designs of the variant are judged and saved there.
///
/// # Errors
/// If the file cannot have them.
pub fn file_of_variant(
    file: &ModelFile,
    variant: &Variant,
    formulation: Formulation,
) -> Result<(ModelFile, Motions<'static>), Diagnostics> {
    let file = file.in_assembly(&variant.start, variant.reversed)?;
    let motions = Motions::of(file.model.motions().into_iter().map(Arc::new), formulation);
    // The search has solved these motions.
    let motions = motions.unwrap_or_else(|_| Vec::new().into());
    Ok((file, motions))
}

/// File of a variant to save a design in: with the placements of that design.
///
/// # Errors
/// If the file cannot have them.
pub fn placed(file: &ModelFile, motions: &Motions<'_>, design: &[f64]) -> Result<ModelFile, Diagnostics> {
    let start = motions.analyses().first().and_then(|analysis| analysis.start_placements(design));
    file.in_assembly(&start.unwrap_or_else(|| file.model.start.clone()), false)
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
        Status::NoEffect => "no goal depends on the variables",
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
        let search = Search { file, asked, found };
        let mut facts = Self::without_message(search);
        let status = search.status();
        facts.message = facts.sentence(search);
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
    fn sentence(&self, search: Search<'_>) -> String {
        let Search { found, .. } = search;
        let exceeded = || {
            let missed = |l: &&LimitFact| l.missed().is_some();
            let lines: Vec<String> = self.limits.iter().filter(missed).map(LimitFact::line).collect();
            if lines.is_empty() { String::new() } else { format!(": {}", some_of(&lines, "; ")) }
        };
        let binding: Vec<&str> =
            self.variables.iter().filter(|v| v.binds.is_some()).map(|v| v.name.as_str()).collect();
        match search.status() {
            Status::Optimal if best_is_met(found) => "all goals are met: no improvement is possible".into(),
            Status::Optimal if search.best().is_some_and(|b| b.optimality.is_corner) => {
                "an optimum at a corner of the goals: their gradient jumps there, and no small change of the design is \
                 better"
                    .into()
            }
            Status::Optimal if binding.is_empty() => "an optimum: to first order, no small change of the design is better".into(),
            Status::Optimal if binding.len() == 1 => {
                format!("optimum found; {} is at its bound, and a wider one would improve it", binding[0])
            }
            Status::Optimal => format!(
                "optimum found; {} are at their bounds, and wider bounds would improve it",
                some_of(&binding, ", ")
            ),
            Status::NoEffect => {
                let goals = search.asked.goals.iter().map(|goal| format!("`{}`", goal.name));
                let variables = self.variables.iter().map(|v| format!("`{}`", v.name));
                format!(
                    "no goal ({}) depends on the variables ({}): give `bounds` to variables that change them, or choose \
                     other goals",
                    some_of(&goals.collect::<Vec<_>>(), ", "),
                    some_of(&variables.collect::<Vec<_>>(), ", ")
                )
            }
            Status::Stuck => "no step makes progress, although it is not quite an optimum: try more `starts`, or more output times \
                where a metric jumps"
                .into(),
            Status::LimitsNotKept => {
                let others = self.not_evaluated().map_or(String::new(), |text| {
                    format!(", unless designs that could not be evaluated keep them ({text})")
                });
                let limits = exceeded();
                format!(
                    "no design was found that keeps all limits{limits}; they contradict each other or the bounds{others}: \
                     widen one of them, or try more `starts`"
                )
            }
            Status::IterationLimit => {
                "the iteration limit was reached before an optimum: increase `max_iterations`".into()
            }
            Status::Interrupted => "interrupted: the best design so far".into(),
            Status::NoStart => {
                let drawn = found.nominal_failure.as_ref();
                let case = drawn.and_then(|r| case_name(search.model(), r.motion?));
                let case = case.map_or(String::new(), |case| format!("case `{case}`: "));
                let why = drawn.map_or("", |r| r.why.as_str());
                format!("no design could be evaluated, not even the nominal one: {case}{why}")
            }
        }
    }

    /// Number of designs that could not be evaluated, with the reason of the first one.
    fn not_evaluated(&self) -> Option<String> {
        let first = self.refused.first()?;
        let case = first.case.as_ref().map_or(String::new(), |case| format!("case `{case}`: "));
        let count = self.refused_count;
        Some(format!("{count} could not be evaluated, the first one: {case}{}", first.why))
    }

    /// Tables for printing: goals, limits, variables.
    pub fn tables(&self) -> Vec<Table> {
        let optional = |x: Option<f64>, unit: &str| x.map_or("-".into(), |x| with_unit(x, unit));
        let binds = |end: Option<&'static str>, worth: Option<f64>, unit: &str| match (end, worth) {
            (Some(end), Some(worth)) => {
                format!("{end}; 1 {} more is worth {}", unit_name(unit), self.worth(worth))
            }
            (end, _) => end.unwrap_or_default().into(),
        };
        let goals = Table::of(
            "Goals",
            "",
            &[
                ("goal", &|g: &&GoalFact| titled(&g.name, &g.case)),
                ("nominal", &|g| optional(g.value.before, &g.unit)),
                ("optimised", &|g| optional(g.value.after, &g.unit)),
                ("target", &|g| g.target.map_or("small".into(), |t| with_unit(t, &g.unit))),
            ],
            &self.goals,
        );
        let limits = Table::of(
            "Limits",
            "",
            &[
                ("limit", &|l: &&LimitFact| titled(&l.name, &l.case)),
                ("nominal", &|l| optional(l.value.before, &l.unit)),
                ("optimised", &|l| optional(l.value.after, &l.unit)),
                ("required", &|l| l.wanted()),
                ("active", &|l| binds(l.binds, l.worth, &l.unit)),
            ],
            &self.limits,
        );
        let total: f64 = self.variables.iter().map(|v| v.work.abs()).sum();
        let work = |v: &SearchedVariable| {
            if total > 0.0 { format!("{:.0} %", 100.0 * -v.work / total) } else { String::new() }
        };
        let variables = Table::of(
            "Design",
            "Nominal, optimised value and bounds are values of the number that the variable changes; where it changes several, they are \
             changes of the design configuration. Work is a variable's share of what was gained, along the path of the best search.",
            &[
                ("variable", &|v: &&SearchedVariable| v.name.clone()),
                ("nominal", &|v| with_unit(v.value(0.0), &v.unit)),
                ("optimised", &|v| with_unit(v.value(v.end), &v.unit)),
                ("change", &|v| signed(v.end, &v.unit)),
                ("bounds", &|v| range(v.bounds.map(|b| v.value(b)))),
                ("work", &|v| work(v)),
                ("active bound", &|v| binds(v.binds, v.worth, &v.unit)),
            ],
            &self.variables,
        );
        let more = [
            self.optima_table(),
            self.assembly_table(),
            limits.if_any(),
            variables.if_any(),
            MovedHardpoint::table(&self.hardpoints, "optimised"),
        ];
        std::iter::once(goals).chain(more.into_iter().flatten()).collect()
    }

    /// Distinct optima, if there are several, with the variables in which each differs most from the best.
    fn optima_table(&self) -> Option<Table> {
        if self.optima.len() < 2 {
            return None;
        }
        let best = &self.optima[0];
        let other = |of: &OptimumFact| {
            let change = |k: usize| of.changes[k] - best.changes[k];
            let part = |v: &SearchedVariable, k: usize| change(k).abs() / (v.bounds[1] - v.bounds[0]);
            let mut all: Vec<_> =
                self.variables.iter().enumerate().map(|(k, v)| (part(v, k), k, v)).collect();
            all.sort_by(|a, b| b.0.total_cmp(&a.0));
            let far = all.iter().take(NAMED_CHANGES).filter(|(part, ..)| *part > SLIGHT);
            let named = far.map(|(_, k, v)| format!("{} {}", v.name, signed(change(*k), &v.unit)));
            named.collect::<Vec<_>>().join(", ")
        };
        let goals = |of: &OptimumFact| {
            let values = self.goals.iter().zip(&of.goals).map(|(g, x)| with_unit(*x, &g.unit));
            some_of(&values.collect::<Vec<_>>(), ", ")
        };
        let rows: Vec<(usize, &OptimumFact)> = self.optima.iter().enumerate().collect();
        let note = "Each with the values of the goals, and where its design differs most from the best. `--optimum N` reports and \
                    saves another one.";
        let columns: [Column<'_, &(usize, &OptimumFact)>; 5] = [
            ("optimum", &|o| (o.0 + 1).to_string()),
            ("objective", &|o| number(o.1.objective)),
            ("goals", &|o| goals(o.1)),
            ("starts", &|o| o.1.starts.len().to_string()),
            ("against the best", &|o| if o.0 == 0 { "-".into() } else { other(o.1) }),
        ];
        let mut columns = columns.to_vec();
        if self.has_variants() {
            columns.insert(1, ("assembly and sense", &|o| o.1.variant()));
        }
        Table::of("Optima", note, &columns, &rows).if_any()
    }

    /// True if several assemblies or senses were searched.
    fn has_variants(&self) -> bool {
        self.assemblies.len() > 1 || self.starts.iter().any(|start| start.reversed)
    }

    /// Assemblies that were searched, if there are several.
    fn assembly_table(&self) -> Option<Table> {
        let turned = |assembly: &AssemblyFact| {
            let body = |placed: &PlacedBody| {
                let angle = placed.turn.iter().map(|x| x * x).sum::<f64>().sqrt();
                format!("{} {}", placed.body, with_unit(angle, &self.angle_unit))
            };
            let bodies: Vec<String> = assembly.bodies.iter().map(body).collect();
            if bodies.is_empty() { "-".into() } else { some_of(&bodies, ", ") }
        };
        let ended = |of: usize| {
            let starts = self.starts.iter().filter(|start| start.assembly == of);
            let optimal = starts.clone().filter(|start| start.status == "optimal").count();
            format!("{optimal} of {}", starts.count())
        };
        Table::of(
            "Assemblies",
            "Ways to put the mechanism together with all drivers at zero; assembly 1 is that of the model. Rotations are those of \
             the nominal design against its design configuration.",
            &[
                ("assembly", &|a: &&AssemblyFact| a.assembly.to_string()),
                ("bodies turned by", &|a| turned(a)),
                ("starts that ended in an optimum", &|a| ended(a.assembly)),
            ],
            &self.assemblies,
        )
        .if_any()
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
                format!(
                    "{}, {ended} of them ended in {}; the best is {best}",
                    self.starts.len(),
                    match self.optima.len() {
                        0 | 1 => "an optimum".into(),
                        n => format!("one of {n} optima"),
                    }
                ),
            ));
        }
        let best = self.best_start.and_then(|k| self.starts.get(k));
        if let Some(best) = best.filter(|_| self.has_variants()) {
            let sense =
                if best.reversed { "with all drivers in the opposite sense" } else { "in the model's sense" };
            let assembly = match best.assembly {
                1 => "that of the model".into(),
                n => format!("assembly {n} of {}", self.assemblies.len()),
            };
            rows.push(("assembly", format!("{assembly}, {sense}")));
        }
        let refused = self.not_evaluated().map_or(String::new(), |text| format!("; {text}"));
        rows.push(("evaluated", format!("{designs} designs, {motions} motions{refused}")));
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

    /// Turns the page of the nominal design into that of the search: with a tab for the result, and opened
    /// on the curve of the first goal of this motion, over its abscissa.
    pub fn page(&self, mut page: Payload, model: &Model, outputs: &[Output]) -> Payload {
        let goal = |g: &GoalFact| model.metrics.iter().find(|m| m.name == g.metric);
        page.open_on(self.goals.iter().find_map(goal), outputs);
        let tables = self.tables().into_iter().chain([self.iteration_table()]);
        page.put_study("Search", self.rows(), &["result"], tables);
        page
    }

    fn iteration_table(&self) -> Table {
        let moved = |i: &IterationFact| {
            let by = |by| with_unit(by, i.unit.as_deref().unwrap_or_default());
            i.moved.as_ref().zip(i.by).map_or(String::new(), |(name, x)| format!("{name} {}", by(x)))
        };
        Table::of(
            "Iterations",
            "",
            &[
                ("iteration", &|i: &&IterationFact| i.iteration.to_string()),
                ("objective", &|i| number(i.objective)),
                ("limits exceeded by", &|i| exceeded(i.violation).unwrap_or_else(|| "kept".into())),
                ("moved most", &|i| moved(i)),
                ("designs", &|i| i.designs.to_string()),
            ],
            &self.iterations,
        )
    }
}

impl OptimumFact {
    /// Assembly and sense in a few words.
    fn variant(&self) -> String {
        format!("{}, {}", self.assembly, if self.reversed { "opposite" } else { "as given" })
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

/// Number of variables that an optimum names.
const NAMED_CHANGES: usize = 3;

/// A limit that is exceeded by less than this fraction of its value is reported as satisfied.
const MISSED: f64 = 1e-7;

/// True if the best search ended where all goals vanish.
fn best_is_met(found: &Optimization) -> bool {
    found.best.is_some_and(|k| found.searches[k].optimality.met)
}

impl SearchedVariable {
    /// Value after a change, or the change itself if there is no nominal value.
    fn value(&self, change: f64) -> f64 {
        value_of(self.nominal, change, self.bounds)
    }
}

impl OptimizeFacts {
    /// Enters the result of solving the saved file again. A design that does not reproduce the optimum gets another
    /// status.
    pub fn check_saved(
        &mut self,
        to: &str,
        judged: Result<DesignAssessment, String>,
        asked: &OptimizationSettings,
    ) {
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
            let has_margin = asked.limits.iter().any(|limit| limit.of == LimitTarget::Margin);
            let advice = match has_margin {
                false => "; if it is too near to a singular position, set `min_margin` in `[optimize]`",
                true => "",
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
