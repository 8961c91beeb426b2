//! `whatif.json`, `whatif.csv` and `whatif.html`: a changed design, predicted and exact, and the most influential
//! variables of each measure.

use std::io::Write;

use hardpoint::Solution;
use hardpoint::measure::Output;
use hardpoint::model::{DesignVariable, Model, OutputSource, VariableId};
use hardpoint::topology::Topology;
use hardpoint_file::{Diagnostic, ModelFile, Units};
use hardpoint_study::Magnitude;
use hardpoint_study::whatif::{WhatIf, repeats_coordinate};
use serde::Serialize;

use crate::GENERATOR;
use crate::columns;
use crate::course::{MarginCourse, RoundOff};
use crate::diagnose::out_of_bounds;
use crate::figures::{names, number, per, rounded, some_of, unit, variable_unit, with_unit};
use crate::margin::MarginFact;
use crate::metric::MetricChange;
use crate::page::{Payload, StudyTables, Table};
use crate::record::{Column, record, write_curves};

/// Contents of `whatif.json`. Values are in the model's units, times in s.
#[derive(Clone, Debug, Serialize)]
pub struct WhatIfFacts {
    /// Program and version.
    pub generator: &'static str,
    /// Name of the mechanism.
    pub name: String,
    /// Name of the model file, as given.
    pub file: String,
    /// Changes of the variables.
    pub change: Vec<ChangeFact>,
    /// Nearest admissible change, which keeps the joints closed, if this one is not admissible.
    pub nearest: Vec<ChangeFact>,
    /// Sentence on the admissibility of the change.
    pub follows: String,
    /// Margins to singular positions, nominal and changed.
    pub margins: [Option<MarginFact>; 2],
    /// Changes of the measures, and the quality of their prediction.
    pub measures: Vec<MeasureFact>,
    /// Changes of the metrics.
    pub metrics: Vec<MetricChange>,
    /// Most influential variables of each measure.
    pub influence: Vec<InfluenceFact>,
    /// Measures without a derivative by some variables.
    pub unknown: Vec<UnknownInfluence>,
    /// Output times, s.
    pub times: Vec<f64>,
    /// Further diagnostics: of the file, and of changes beyond the bounds of their variables.
    pub diagnostics: Vec<Diagnostic>,
}

record! {
    /// Change of a variable.
    ChangeFact::of(model: &Model, units: Units, variable: &DesignVariable, by: f64) {}
    /// Name of the variable.
    variable: String = variable.name.clone();
    /// Change, in `unit`.
    by: f64 = units.from_si(variable.quantity, by);
    /// Unit; `1` for a plain number.
    unit: String = variable_unit(model, units, variable);
}

impl ChangeFact {
    /// Changes of the variables of a model, from a change in SI.
    pub fn all(model: &Model, units: Units, change: &[f64]) -> Vec<Self> {
        let changed = model.variables.iter().zip(change).filter(|(_, by)| **by != 0.0);
        changed.map(|(variable, by)| Self::of(model, units, variable, *by)).collect()
    }

    /// Changes in a line: `A.x by 2 mm, B.y by -1 mm`.
    pub fn line(changes: &[Self]) -> String {
        let one = |c: &Self| format!("{} by {}", c.variable, with_unit(c.by, &c.unit));
        changes.iter().map(one).collect::<Vec<_>>().join(", ")
    }
}

record! {
    /// Curves of a measure.
    MeasureFact::of(units: Units, what_if: &WhatIf, m: usize) {
        let measured = &what_if.today.measured;
        let output = &measured.outputs[m];
        let shown = |x: f64| units.from_si(output.dimension, x);
        let quality = what_if.prediction_quality(m);
        let steps = || 0..what_if.len();
        let prediction = |order: usize| match quality {
            Some(f) if f.errors[order].is_some() => {
                steps().map(|k| shown(what_if.predicted(k, m)[order])).collect()
            }
            _ => Vec::new(),
        };
        let change = steps()
            .map(|k| (what_if.exact_change(k, m), k))
            .filter(|(change, _)| change.is_finite())
            .max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    }
    /// Name of the measure.
    measure: String = output.name.clone();
    /// Unit.
    unit: String = unit(units, output.dimension);
    /// Largest exact change over the motion, with its sign.
    change: Option<f64> = change.map(|(x, _)| shown(x));
    /// Time of the largest change, s.
    time: Option<f64> = change.map(|(_, k)| what_if.today.motion.times[k]);
    /// Largest errors of the first-order and of the second-order prediction; `null` if unknown, for example for a
    /// velocity.
    errors: Option<[Option<f64>; 2]> = quality.map(|f| f.errors.map(|e| e.map(shown)));
    /// Number of output times without a prediction, since the measure has no derivatives there; `errors` are those of
    /// the others.
    unpredicted: Option<usize> = quality.map(|f| f.unpredicted);
    /// Factor by which the change can be scaled before its second-order part reaches 5 % of its first-order part;
    /// `null` if the measure is exactly linear along the change, or does not change to first order.
    linear_up_to: Option<f64> = quality.and_then(|f| f.linear_up_to).filter(|x| x.is_finite());
    /// True if the measure is exactly linear along the change: its second-order part is round-off.
    exactly_linear: bool = quality.and_then(|f| f.linear_up_to).is_some_and(f64::is_infinite);
    /// Nominal curve over the output times.
    today: Vec<f64> = steps().map(|k| shown(measured.value(k, m)[0])).collect();
    /// First-order prediction; empty if nothing is predicted.
    first: Vec<f64> = prediction(0);
    /// Second-order prediction; empty if nothing is predicted.
    second: Vec<f64> = prediction(1);
    /// Exact curve of the re-solved design.
    exact: Vec<f64> = steps().map(|k| shown(what_if.exact(k, m))).collect();
}

record! {
    /// Influence of a variable on a measure.
    InfluenceFact::of(model: &Model, units: Units, output: &Output, variable: &DesignVariable, most: f64, time: f64) {
        let by = variable_unit(model, units, variable);
    }
    /// Name of the measure.
    measure: String = output.name.clone();
    /// Name of the variable.
    variable: String = variable.name.clone();
    /// Largest derivative over the motion, with its sign.
    largest: f64 = units.derivative_from_si(output.dimension, variable.quantity, most);
    /// Time of the largest derivative, s.
    time: f64 = time;
    /// Unit of the derivative.
    unit: String = per(&unit(units, output.dimension), &by);
    /// Unit of the variable.
    per: String = by;
    /// Unit of the measure.
    of: String = unit(units, output.dimension);
    /// First-order change of the measure due to the variable's typical change, in the measure's unit; `null` if the
    /// file gives none.
    typical: Option<f64> = variable.typical.map(|t| units.from_si(output.dimension, t * most));
    /// First-order change of the measure due to the variable's tolerance, in either direction.
    tolerance: Option<f64> = variable.tolerance.map(|t| units.from_si(output.dimension, (t * most).abs()));
}

/// Variables whose influence on a measure is unknown.
#[derive(Clone, Debug, Serialize)]
pub struct UnknownInfluence {
    /// Name of the measure.
    pub measure: String,
    /// Variables by which it has no derivative at any output time.
    pub variables: Vec<String>,
}

impl WhatIfFacts {
    /// Adds the effects of a change on the design.
    pub fn changed(self, file: &ModelFile, topology: &Topology, what_if: &WhatIf) -> Self {
        let (model, units) = (&file.model, file.units);
        let change = ChangeFact::all(model, units, &what_if.change);
        let margin = |s: &Solution| {
            MarginFact::new(model, file.units, topology, &MarginCourse::of(&s.motion), &s.motion)
        };
        Self {
            change,
            follows: follows(model, what_if),
            margins: [margin(&what_if.today), margin(&what_if.exact)],
            measures: (0..what_if.today.measured.outputs.len())
                .map(|m| MeasureFact::of(units, what_if, m))
                .collect(),
            metrics: MetricChange::all(model, units, what_if),
            times: what_if.today.motion.times[..what_if.len()].to_vec(),
            diagnostics: [file.remarks.clone(), out_of_bounds(file, &what_if.change)].concat(),
            ..self
        }
    }

    /// Ranking of the variables only, for a model whose design is not changed.
    pub fn of_today(file: &ModelFile, topology: &Topology, today: &Solution) -> Self {
        let (influence, unknown) = influence(&file.model, file.units, today);
        Self {
            generator: GENERATOR,
            name: file.model.name.clone(),
            file: file.file_name().into(),
            change: Vec::new(),
            nearest: Vec::new(),
            follows: String::new(),
            margins: [
                MarginFact::new(
                    &file.model,
                    file.units,
                    topology,
                    &MarginCourse::of(&today.motion),
                    &today.motion,
                ),
                None,
            ],
            measures: Vec::new(),
            metrics: Vec::new(),
            influence,
            unknown,
            times: today.motion.times.clone(),
            diagnostics: file.remarks.clone(),
        }
    }

    /// Line about the change.
    pub fn change_line(&self) -> String {
        ChangeFact::line(&self.change)
    }

    /// Table of the changes of the measures and the quality of their prediction; of the requested measures, or of all.
    pub fn table(&self, wanted: &dyn Fn(&str) -> bool) -> Table {
        let range = |x: &[f64]| {
            let low = x.iter().copied().fold(f64::INFINITY, f64::min);
            let high = x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            if low <= high { format!("{} to {}", number(low), number(high)) } else { "-".into() }
        };
        let some = |x: Option<f64>| x.map_or("-".into(), |x| format!("{} ", rounded(x, 3)));
        let unpredicted = |m: &MeasureFact| match m.unpredicted {
            Some(times) if times > 0 => format!("at {times} of {} times", m.today.len()),
            Some(_) | None => String::new(),
        };
        let linear = |m: &MeasureFact| match m.linear_up_to {
            Some(x) => format!("{} x", rounded(x, 2)),
            None => if m.exactly_linear { "exactly linear" } else { "-" }.into(),
        };
        Table::of(
            format!("What if {}", self.change_line()),
            "Predictions come from the nominal derivatives, without solving again; the exact curves are re-solved. \
             \"Linear range\": factor on this change at which the second-order part is 5 % of the first-order part.",
            &[
                ("measure", &|m: &&MeasureFact| m.measure.clone()),
                ("unit", &|m| m.unit.clone()),
                ("nominal", &|m| range(&m.today)),
                ("changed", &|m| range(&m.exact)),
                ("largest change", &|m| some(m.change)),
                ("at t", &|m| m.time.map_or("-".into(), |t| format!("{} s", number(t)))),
                ("error of 1st order", &|m| some(m.errors.and_then(|e| e[0]))),
                ("error of 2nd order", &|m| some(m.errors.and_then(|e| e[1]))),
                ("not predicted", &|m| unpredicted(m)),
                ("linear range", &|m| linear(m)),
            ],
            self.measures.iter().filter(|m| wanted(&m.measure)),
        )
        .without_empty_columns()
    }

    /// Most influential variables of a measure, the largest first; at most `shown` of each unit, without those that
    /// have no effect.
    pub fn ranking(&self, measure: &str, shown: usize) -> Table {
        let mut units: Vec<&str> = Vec::new();
        let of_measure = || self.influence.iter().filter(|i| i.measure == measure && i.largest != 0.0);
        of_measure().for_each(|i| {
            if !units.contains(&i.per.as_str()) {
                units.push(&i.per);
            }
        });
        let of_unit = |unit| of_measure().filter(move |i| i.per == unit).take(shown).enumerate();
        let rows: Vec<_> = units.into_iter().flat_map(of_unit).collect();
        let unknown = self.unknown.iter().find(|u| u.measure == measure);
        let unknown = unknown.map_or(&[][..], |u| &u.variables);
        let note = match (rows.is_empty(), unknown.is_empty()) {
            (_, false) => format!("No derivative by {}.", some_of(unknown, ", ")),
            (true, true) => "No variable moves it.".into(),
            (false, true) => String::new(),
        };
        let optional = |x: Option<f64>, sign: &str, unit: &str| {
            x.map_or(String::new(), |x| format!("{sign}{}", with_unit(x, unit)))
        };
        let columns: [Column<'_, (usize, &InfluenceFact)>; 6] = [
            ("rank", &|r| (r.0 + 1).to_string()),
            ("by variable", &|r| r.1.variable.clone()),
            ("largest", &|r| with_unit(r.1.largest, &r.1.unit)),
            ("at t", &|r| format!("{} s", number(r.1.time))),
            ("by a typical change", &|r| optional(r.1.typical, "", &r.1.of)),
            ("by its tolerance", &|r| optional(r.1.tolerance, "±", &r.1.of)),
        ];
        Table::of(format!("Most influential variables of {measure}"), note, &columns, rows)
            .without_empty_columns()
    }

    /// Names of the ranked measures, each once.
    pub fn ranked(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        let known = self.influence.iter().map(|i| i.measure.as_str());
        for measure in known.chain(self.unknown.iter().map(|u| u.measure.as_str())) {
            if !names.contains(&measure) {
                names.push(measure);
            }
        }
        names
    }

    /// Writes the curves of the measures, one row per output time.
    ///
    /// # Errors
    /// If `out` cannot be written.
    pub fn write_csv(&self, out: impl Write) -> csv::Result<()> {
        let column = |m: &MeasureFact, name| columns::Column {
            name: format!("{} {name}", m.measure),
            unit: m.unit.clone(),
        };
        let curves = self.measures.iter().flat_map(|m| m.curves().map(move |(name, curve)| (m, name, curve)));
        let curves = curves.map(|(m, name, curve)| (column(m, name).header(), curve));
        write_curves(out, &self.times, &curves.collect::<Vec<_>>())
    }

    /// Turns the page of the nominal design into that of the changed one: with a tab for the result, and opened
    /// on the first of the `asked` measures, over another one.
    pub fn page(
        &self,
        mut page: Payload,
        asked: &[String],
        over: Option<&str>,
        wanted: &dyn Fn(&str) -> bool,
    ) -> Payload {
        let quantity = |name: &str| page.quantities.iter().position(|q| q.name == name);
        page.first = asked.first().and_then(|name| quantity(name)).or(page.first);
        page.over = over.and_then(quantity);
        let mut tables = self.changed_tables(wanted);
        tables.extend(self.ranked().into_iter().filter(|m| wanted(m)).map(|m| self.ranking(m, MOST_RANKED)));
        Payload { study: StudyTables::of("What-if", tables), ..page }
    }

    /// Tables of the change, of the measures and of the metrics; none if the design is not changed.
    fn changed_tables(&self, wanted: &dyn Fn(&str) -> bool) -> Vec<Table> {
        if self.change.is_empty() {
            return Vec::new();
        }
        let change = Table::of_lines("The change", self.change_rows());
        let metrics = MetricChange::table(&self.metrics)
            .map(|t| Table { title: "Metrics, nominal and changed".into(), ..t });
        [change, self.table(wanted)].into_iter().chain(metrics).collect()
    }

    /// Labelled lines on the change, its admissibility, and the margins to singular positions.
    pub fn change_rows(&self) -> Vec<(&'static str, String)> {
        let margin = |m: &Option<MarginFact>| m.as_ref().map_or("-".into(), |m| number(m.least));
        let [today, changed] = [0, 1].map(|k| margin(&self.margins[k]));
        let mut rows = vec![
            ("change", self.change_line()),
            ("it is", self.follows.clone()),
            ("least margin", format!("{today} nominal, {changed} changed")),
        ];
        if !self.nearest.is_empty() {
            let near = ChangeFact::line(&self.nearest);
            rows.push(("nearest admissible", format!("{near}; `--admissible` makes this change instead")));
        }
        rows
    }
}

impl MeasureFact {
    /// Known curves with their names.
    fn curves(&self) -> impl Iterator<Item = (&'static str, &[f64])> {
        let all = [&self.today, &self.first, &self.second, &self.exact].map(Vec::as_slice);
        CURVES.into_iter().zip(all).filter(|(_, curve)| !curve.is_empty())
    }
}

const CURVES: [&str; 4] = ["today", "first order", "second order", "exact"];

/// Maximum number of variables of each unit in the page's ranking of a measure.
const MOST_RANKED: usize = 10;

/// Sentence on the admissibility of a change.
pub(crate) fn follows(model: &Model, what_if: &WhatIf) -> String {
    if !what_if.cannot_follow.is_empty() {
        let which = what_if.cannot_follow.iter().map(|v| model.variables[v.0].name.as_str());
        return format!("the mechanism cannot follow {}: nothing is predicted", names(which));
    }
    if what_if.opens.is_empty() {
        return "admissible: every joint stays closed, nothing is re-assembled".into();
    }
    let joints = what_if.opens.iter().map(|d| model.joints[d.joint.0].name.as_str());
    format!("re-assembled: {} opens in the design configuration and is closed again by moving", names(joints))
}

/// Influence of every variable on every measure (or every point, if there are no measures), the largest first within
/// each. A variable with two names is ranked once, and effects that are round-off are left out. Then the measures with
/// the variables by which they have no derivative.
fn influence(model: &Model, units: Units, today: &Solution) -> (Vec<InfluenceFact>, Vec<UnknownInfluence>) {
    let measured = &today.measured;
    let (mut facts, mut without) = (Vec::new(), Vec::new());
    let counts =
        |source: &OutputSource| model.measures.is_empty() || matches!(source, OutputSource::Measure(_));
    let measures = measured.outputs.iter().enumerate().filter(|(_, o)| counts(&o.source));
    let variables = || (0..model.variables.len()).map(VariableId);
    let repeated: Vec<bool> = variables().map(|v| repeats_coordinate(model, v)).collect();
    let round_off = RoundOff::new(model, Magnitude::of_motion(model, &today.motion));
    for (m, output) in measures {
        let (first, mut variables) = (facts.len(), Vec::new());
        for (v, variable) in model.variables.iter().enumerate() {
            if measured.is_empty() || today.sensitivities.at(0, v).is_none() || repeated[v] {
                continue;
            }
            let at = |k: &usize| measured.d(*k, VariableId(v), m)[0];
            let known = (0..measured.len()).filter(|k| at(k).is_finite());
            let Some(k) = known.max_by(|a, b| at(a).abs().total_cmp(&at(b).abs())) else {
                variables.push(variable.name.clone());
                continue;
            };
            let moves = at(&k).abs() > round_off.of(v, output.dimension, 0);
            let most = if moves { at(&k) } else { 0.0 };
            facts.push(InfluenceFact::of(model, units, output, variable, most, today.motion.times[k]));
        }
        facts[first..].sort_by(|a, b| b.largest.abs().total_cmp(&a.largest.abs()));
        if !variables.is_empty() {
            without.push(UnknownInfluence { measure: output.name.clone(), variables });
        }
    }
    (facts, without)
}
