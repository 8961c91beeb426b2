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
        if value.is_nan() {
            return Ok(0.0);
        }
        if value.is_infinite() {
            let name = &model.variables[k].name;
            return Err(Failure::Misunderstood(format!("the value of `{name}` is infinite")));
        }
        Ok(file.change_to(variable, *value))
    };
    values.iter().enumerate().map(change).collect()
}
