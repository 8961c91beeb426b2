//! Linear ranges of the sensitivities by each variable.

use hardpoint::Solution;
use hardpoint::model::{Model, OutputSource};
use hardpoint_file::Units;
use hardpoint_study::Validity;
use serde::Serialize;

use crate::figures::{rounded, variable_unit};
use crate::margin::MarginFact;
use crate::page::Table;
use crate::record::Column;

/// Linear range of the sensitivities by one variable.
#[derive(Clone, Debug, Serialize)]
pub struct ValidityFact {
    /// Name of the variable.
    pub variable: String,
    /// Unit of the variable.
    pub unit: String,
    /// Change in either direction up to which the second-order part of every measure is at most 5 % of the first-order
    /// part, over the whole motion; `null` if all measures are exactly linear, or none depends on the variable.
    pub linear_up_to: Option<f64>,
    /// True if all measures that depend on it are exactly linear in it: their second-order parts are round-off.
    pub exactly_linear: bool,
    /// Measure that limits the range.
    pub limited_by: Option<String>,
    /// Linear ranges of the single measures.
    pub measures: Vec<MeasureValidity>,
}

/// Linear range of the sensitivity of one measure by one variable.
#[derive(Clone, Debug, Serialize)]
pub struct MeasureValidity {
    /// Name of the measure.
    pub measure: String,
    /// Linear range of the variable, in its unit; `null` if the measure is exactly linear in it.
    pub linear_up_to: Option<f64>,
    /// True if the measure is exactly linear in the variable: its second-order part is round-off.
    pub exactly_linear: bool,
}

impl ValidityFact {
    /// Linear ranges of a solution: for its measures, or for its points if it has no measures.
    pub fn all(model: &Model, units: Units, solution: &Solution, found: &[Validity]) -> Vec<Self> {
        let outputs = &solution.measured.outputs;
        let counts =
            |m: usize| model.measures.is_empty() || matches!(outputs[m].source, OutputSource::Measure(_));
        let fact = |(variable, validity): (&hardpoint::model::DesignVariable, &Validity)| {
            let shown = |x: f64| units.from_si(variable.quantity, x);
            let known = validity.linear_up_to.iter().enumerate().filter(|(m, _)| counts(*m));
            let known = known.filter_map(|(m, x)| x.filter(|x| !x.is_nan()).map(|x| (m, x)));
            let measures: Vec<_> = known
                .map(|(m, x)| MeasureValidity {
                    measure: outputs[m].name.clone(),
                    linear_up_to: x.is_finite().then(|| shown(x)),
                    exactly_linear: x.is_infinite(),
                })
                .collect();
            let bending = measures.iter().filter_map(|m| Some((m.linear_up_to?, &m.measure)));
            let least = bending.min_by(|a, b| a.0.total_cmp(&b.0));
            Self {
                variable: variable.name.clone(),
                unit: variable_unit(model, units, variable),
                linear_up_to: least.map(|(x, _)| x),
                exactly_linear: least.is_none() && !measures.is_empty(),
                limited_by: least.map(|(_, measure)| measure.clone()),
                measures,
            }
        };
        model.variables.iter().zip(found).map(fact).collect()
    }

    /// Table of the linear ranges, with the numerical quality of the motion.
    pub fn table(facts: &[Self], margin: Option<&MarginFact>, least_pivot_ratio: f64) -> Option<Table> {
        let reach = |v: &Self| match v.linear_up_to {
            Some(x) => Some(format!("{} {}", rounded(x, 2), v.unit)),
            None => v.exactly_linear.then(|| "exactly linear".into()),
        };
        let margin = margin.map_or(String::new(), |m| format!(" Margin: {}.", m.line()));
        let pivots = rounded(least_pivot_ratio, 2);
        let columns: [Column<'_, (&Self, String)>; 3] = [
            ("variable", &|v| v.0.variable.clone()),
            ("linear range", &|v| v.1.clone()),
            ("limited by", &|v| v.0.limited_by.clone().unwrap_or_default()),
        ];
        let note = format!(
            "Prediction: change of the variable in either direction at which the second-order part of the named measure is 5 % of the first-order part. Numerics: the smallest pivot is {pivots} of the largest.{margin}"
        );
        let rows = facts.iter().filter_map(|v| Some((v, reach(v)?)));
        Table::of("Linear range of sensitivities", note, &columns, rows).if_any()
    }
}
