//! Facts that several studies have: costs, values before and after, values of variables, moved hardpoints, failed
//! designs.

use hardpoint::joint::Quantity;
use hardpoint::measure::Output;
use hardpoint::model::change::ChangeTarget;
use hardpoint::model::{Change, DesignVariable, Metric, Model, OutputSource};
use hardpoint_file::{ModelFile, Units};
use hardpoint_study::StudyCost;
use serde::Serialize;

use crate::figures::{number, rounded, with_unit};
use crate::page::{Fact, Payload, StudyTables, Table};
use crate::record::{Column, record};

impl Payload {
    /// Opens the page on the curve of a metric, over its abscissa.
    pub(crate) fn open_on(&mut self, metric: Option<&Metric>, outputs: &[Output]) {
        let place = |of: OutputSource| outputs.iter().position(|o| o.source == of);
        if let Some(metric) = metric {
            self.first = place(metric.of).or(self.first);
            self.over = metric.over.and_then(place);
        }
    }

    /// Makes this the page of a study: with a tab that shows the lines that `answer` names, the first table, all lines
    /// as a summary, and the other tables.
    pub(crate) fn put_study(
        &mut self,
        title: &str,
        lines: Vec<(&'static str, String)>,
        answer: &[&str],
        tables: impl IntoIterator<Item = Table>,
    ) {
        let shown = lines.iter().filter(|(what, _)| answer.contains(what));
        let shown = shown.map(|(what, is)| Fact { label: (*what).into(), value: is.clone() });
        let answer = shown.collect();
        let mut tables: Vec<Table> = tables.into_iter().collect();
        tables.insert(tables.len().min(1), Table::of_lines("Summary", lines));
        self.study = Some(StudyTables { title: title.into(), answer, tables });
    }
}

impl StudyTables {
    /// Tables of a study under a title, if there are any.
    pub(crate) fn of(title: &str, tables: Vec<Table>) -> Option<Self> {
        (!tables.is_empty()).then(|| Self { title: title.into(), answer: Vec::new(), tables })
    }
}

/// Number of marks in a full bar of a table.
const BAR: f64 = 40.0;

/// Value of the nominal design and of the optimised one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BeforeAfter {
    /// Nominal value; `null` if the nominal design cannot be evaluated.
    pub before: Option<f64>,
    /// Optimised value; `null` if no design was found.
    pub after: Option<f64>,
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

impl Evaluations {
    /// Cost of a study.
    pub(crate) fn of(cost: StudyCost) -> Self {
        let StudyCost { designs, motions, steps } = cost;
        Self { designs, motions, steps }
    }
}

record! {
    /// Hardpoint that the optimised design moves, in the length unit.
    MovedHardpoint::of(name: &str, before: [f64; 3], after: [f64; 3]) {}
    /// Name.
    name: String = name.to_owned();
    /// Nominal coordinates.
    before: [f64; 3] = before;
    /// Optimised coordinates.
    after: [f64; 3] = after;
}

impl MovedHardpoint {
    /// Hardpoints that a design moves.
    pub(crate) fn all(model: &Model, units: Units, design: &[f64]) -> Vec<Self> {
        let [before, after] = [&[][..], design].map(|d| model.hardpoint_places(d));
        let named = model.hardpoints.iter().zip(before.iter().zip(&after)).filter(|(h, _)| !h.unnamed);
        let shown = |p: &hardpoint::space::Vec3| p.to_array().map(|x| units.from_si(Quantity::Length, x));
        let moved = named.filter(|(_, (a, b))| (**a - **b).norm() > 0.0);
        moved.map(|(h, (a, b))| Self::of(&h.name, shown(a), shown(b))).collect()
    }

    /// Table of the moved hardpoints, if there are any; `to` names the new design.
    pub(crate) fn table(moved: &[Self], to: &str) -> Option<Table> {
        let place = |p: [f64; 3]| p.map(number).join(", ");
        let columns: [Column<'_, &Self>; 3] = [
            ("hardpoint", &|h| h.name.clone()),
            ("nominal", &|h| place(h.before)),
            (to, &|h| place(h.after)),
        ];
        Table::of("Moved hardpoints", "", &columns, moved).if_any()
    }
}

record! {
    /// Designs that failed for the same reason.
    pub(crate) FailureFact::of(case: Option<String>, why: &str, first: usize, count: usize) {}
    /// Name of the case; `null` if the model has no cases.
    case: Option<String> = case;
    /// Description of the first failure.
    why: String = why.to_owned();
    /// Number of the first failed design.
    first: usize = first;
    /// Number of failed designs.
    count: usize = count;
}

impl FailureFact {
    /// Table of the failed designs, if there are any.
    pub(crate) fn table(failures: &[Self], note: &str) -> Option<Table> {
        let columns: [Column<'_, &Self>; 4] = [
            ("case", &|f| f.case.clone().unwrap_or_default()),
            ("first failure", &|f| f.why.clone()),
            ("designs", &|f| f.count.to_string()),
            ("first", &|f| f.first.to_string()),
        ];
        Table::of("Failed designs", note, &columns, failures).if_any().map(Table::without_empty_columns)
    }
}

/// Name of the case of a motion; `None` if the model has no cases.
pub fn case_name(model: &Model, motion: usize) -> Option<String> {
    model.cases.get(motion).map(|case| case.name.clone())
}

/// Name with its case, if it has one.
pub(crate) fn titled(name: &str, case: &Option<String>) -> String {
    case.as_ref().map_or(name.to_owned(), |case| format!("{name} ({case})"))
}

/// A change below this fraction of the bounds is round-off.
const ROUND_OFF: f64 = 1e-15;

/// Number without round-off next to its bounds.
pub(crate) fn without_round_off(x: f64, [low, high]: [f64; 2]) -> f64 {
    if x.abs() <= ROUND_OFF * (high - low) { 0.0 } else { x }
}

/// Nominal value, SI, of the number in the file that a variable changes, if there is exactly one.
pub(crate) fn nominal_number(file: &ModelFile, variable: &DesignVariable) -> Option<f64> {
    let model = &file.model;
    let number = |change: &Change| match change.target() {
        ChangeTarget::Hardpoint(hardpoint, velocity) => {
            let along = (0..3).find(|axis| velocity[*axis] == 1.0 && velocity.norm() == 1.0);
            along.map(|axis| model.hardpoints[hardpoint.0].position[axis])
        }
        ChangeTarget::Length(joint, rate) => model.joints[joint.0].length.filter(|_| rate == 1.0),
        ChangeTarget::Parameter(p, rate) => Some(model.parameters[p.0].value).filter(|_| rate == 1.0),
        ChangeTarget::Marker(_) | ChangeTarget::Law(..) => None,
    };
    let mut parameters = variable.changes.iter().filter(|change| change.parameter().is_some());
    if let Some(value) = parameters.find_map(number) {
        return Some(value);
    }
    // Mirrored changes are not numbers of the file.
    let is_image = |change: &Change| {
        change.hardpoint().is_some_and(|(moved, _)| file.is_image(&model.hardpoints[moved.0].name))
    };
    let mut own = variable.changes.iter().filter(|change| !is_image(change));
    match (own.next(), own.next()) {
        (Some(only), None) => number(only),
        (None, _) | (Some(_), Some(_)) => None,
    }
}

/// Value of a variable after a change, or the change itself if it changes no single number.
pub(crate) fn value_of(nominal: Option<f64>, change: f64, bounds: [f64; 2]) -> f64 {
    nominal.map_or(change, |nominal| without_round_off(nominal + change, bounds))
}

/// Formatted change with its sign.
pub(crate) fn signed(by: f64, unit: &str) -> String {
    format!("{}{}", if by > 0.0 { "+" } else { "" }, with_unit(by, unit))
}

/// Note below tables with values of variables.
pub(crate) const VALUES: &str = "Values of the number that a variable changes; where it changes several, changes of the design configuration.";

/// Formatted bounds.
pub(crate) fn range([low, high]: [f64; 2]) -> String {
    format!("{} to {}", number(low), number(high))
}

/// Bar of a table as text, with a length proportional to a fraction.
pub(crate) fn bar(part: f64) -> String {
    "▇".repeat((BAR * part.clamp(0.0, 1.0)).round() as usize)
}

/// Fraction as a percentage.
pub(crate) fn percent(part: f64) -> String {
    format!("{} %", rounded(100.0 * part, 4))
}

/// Name of a column with its unit in brackets; no brackets for a plain number.
pub(crate) fn with_brackets(name: &str, unit: &str) -> String {
    if unit.is_empty() || unit == "1" { name.into() } else { format!("{name} [{unit}]") }
}
