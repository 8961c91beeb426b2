//! An entry of a model in a few lines, for editors: values with units, and descriptions in words.

use hardpoint::joint::Quantity;
use hardpoint::model::VariableId;
use hardpoint_file::ModelFile;

use crate::facts::{change_text, couplers, drivers, joints_on, measures};
use crate::figures::{names, number, variable_unit, with_unit};
use crate::metric;

/// Lines that describe the entry of a section, such as `hardpoints`; empty for an unknown one.
///
/// ```
/// # let text = r#"
/// # name = "pendulum"
/// # units = { length = "mm", angle = "deg" }
/// # hardpoints = { pivot = [0, 0, 500] }
/// # bodies = { arm = {} }
/// # joints.hinge = { type = "revolute", bodies = ["ground", "arm"], at = "pivot", axis = "y" }
/// # time = { end = 1.0, steps = 100 }
/// # "#;
/// let file = hardpoint_file::parse(text, "pendulum.toml").unwrap();
/// assert_eq!(hardpoint_report::entry::lines(&file, "hardpoints", "pivot"), ["at (0, 0, 500) mm"]);
/// ```
pub fn lines(file: &ModelFile, section: &str, name: &str) -> Vec<String> {
    let (model, units) = (&file.model, file.units);
    let variable = || {
        let (k, v) = model.variables.iter().enumerate().find(|(_, v)| v.name == name)?;
        let id = VariableId(k);
        let unit = variable_unit(model, units, v);
        let mut lines = vec![change_text(model, &v.changes, v.fixed_length)];
        if model.nominal_value(id) != 0.0 {
            lines.push(format!("nominal value {}", with_unit(file.value_of(id, 0.0), &unit)));
        }
        if let Some([least, most]) = v.bounds {
            let [least, most] = [least, most].map(|x| file.value_of(id, x));
            lines.push(format!("between {} and {}", number(least), with_unit(most, &unit)));
        }
        let tolerance = v.tolerance.map(|t| with_unit(units.from_si(v.quantity, t), &unit));
        lines.extend(tolerance.map(|t| format!("tolerance ±{t}")));
        Some(lines)
    };
    let found = match section {
        "hardpoints" => model.hardpoints.iter().find(|h| !h.unnamed && h.name == name).map(|h| {
            let place = h.position.to_array().map(|x| number(units.from_si(Quantity::Length, x)));
            vec![format!("at ({}) {}", place.join(", "), units.length.symbol())]
        }),
        "bodies" => {
            let body = model.bodies.iter().position(|b| b.name == name);
            body.map(|b| {
                let joints = &joints_on(model)[b];
                vec![format!("joints on it: {}", names(joints.iter().map(String::as_str)))]
            })
        }
        "joints" => model.joints.iter().find(|j| !j.unnamed && j.name == name).map(|j| {
            let [i, k] = j.bodies.map(|b| model.bodies[b.0].name.as_str());
            let coordinates: Vec<&str> = j.kind.coordinates.iter().map(|c| c.name).collect();
            let mut lines = vec![format!("{} between `{i}` and `{k}`", j.kind.name)];
            if !coordinates.is_empty() {
                lines.push(format!("coordinates: {}", names(coordinates)));
            }
            lines
        }),
        "couplers" => couplers(model, units).into_iter().find(|c| c.name == name).map(|c| vec![c.relation]),
        "drivers" => drivers(model, units)
            .into_iter()
            .find(|d| d.name == name)
            .map(|d| vec![format!("drives {}", d.drives), format!("law {}, in {}", d.law, d.unit)]),
        "measures" => measures(model, units)
            .into_iter()
            .find(|m| m.name == name)
            .map(|m| vec![m.what, format!("in {}", m.unit)]),
        "metrics" => {
            let metric = model.metrics.iter().find(|m| m.name == name);
            metric.map(|m| vec![metric::what(model, units, m)])
        }
        "design" | "parameters" => variable(),
        "points" => model
            .points
            .iter()
            .find(|p| !p.unnamed && p.name == name)
            .map(|p| vec![format!("on `{}`", model.bodies[p.body.0].name)]),
        _ => None,
    };
    found.unwrap_or_default()
}
