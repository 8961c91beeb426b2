//! Designs as Python passes them.

use hardpoint::model::VariableId;
use hardpoint_file::ModelFile;

use crate::failure::Failure;

/// Changes of a design in SI. A design has a value for every variable, NaN for nominal values, or no value at all.
pub(crate) fn changes(file: &ModelFile, values: &[f64]) -> Result<Vec<f64>, Failure> {
    let model = &file.model;
    if !values.is_empty() && values.len() != model.variables.len() {
        return Err(Failure::Misunderstood(format!(
            "a design of this model has {} values, one for each design variable; {} were given",
            model.variables.len(),
            values.len()
        )));
    }
    let change = |(k, value): (usize, &f64)| {
        let variable = VariableId(k);
        if value.is_nan() || *value == drawn(file, variable) {
            return Ok(0.0);
        }
        if value.is_infinite() {
            let name = &model.variables[k].name;
            return Err(Failure::Misunderstood(format!("the value of `{name}` is infinite")));
        }
        Ok(file.units.to_si(model.variables[k].quantity, *value) - model.nominal_value(variable))
    };
    values.iter().enumerate().map(change).collect()
}

/// Nominal value of a variable.
pub(crate) fn drawn(file: &ModelFile, variable: VariableId) -> f64 {
    shown(file, variable, 0.0)
}

/// Value of a variable after a change.
pub(crate) fn shown(file: &ModelFile, variable: VariableId, change: f64) -> f64 {
    let quantity = file.model.variables[variable.0].quantity;
    file.units.from_si(quantity, change + file.model.nominal_value(variable))
}
