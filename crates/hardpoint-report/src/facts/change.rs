//! Description and unit of a design variable's change.

use hardpoint::joint::Quantity;
use hardpoint::law::ParameterKind;
use hardpoint::model::{Change, DesignVariable, Model};
use hardpoint::space::Vec3;
use hardpoint_file::Units;

use crate::figures::{names, number, order_unit, rounded, symbol};

/// Short description of a variable's change.
pub(super) fn change_text(model: &Model, changes: &[Change], fixed_length: bool) -> String {
    let said = model.describe_changes(changes, &direction_text, &number);
    let said =
        said.iter().map(|c| format!("{} {}{}", c.verb, names(c.names.iter().map(String::as_str)), c.how));
    let mut text = said.collect::<Vec<_>>().join("; ");
    if fixed_length {
        text += "; rods keep their lengths";
    }
    text
}

/// Unit of a design variable; `1` for a plain number.
///
/// To the core, a parameter of a law that is neither a length nor an angle is a plain number. The rate of change of the
/// parameter per unit of the variable then decides whether the variable is in the user's unit or in SI.
pub fn variable_unit(model: &Model, units: Units, variable: &DesignVariable) -> String {
    if variable.quantity != Quantity::Number {
        return symbol(units, variable.quantity).into();
    }
    let mut found = variable.changes.iter().map(|change| match change {
        Change::Law(change) => {
            let driver = &model.drivers[change.driver.0];
            let quantity = model.driven(driver).quantity;
            let kind = driver.law.parameters()[change.parameter].kind;
            parameter_unit(units, quantity, kind, change.rate.abs())
        }
        _ => None,
    });
    let first = found.next().flatten();
    match first {
        Some(unit) if found.all(|other| other.as_ref() == Some(&unit)) => unit,
        _ => "1".into(),
    }
}

/// Unit in which a parameter changes by one, if it changes by `rate` internally.
fn parameter_unit(units: Units, driven: Quantity, kind: ParameterKind, rate: f64) -> Option<String> {
    let is = |size: f64| (rate - size).abs() <= 1e-12 * size;
    match kind {
        ParameterKind::Time if is(1.0) => Some("s".into()),
        ParameterKind::Frequency if is(1.0) => Some("Hz".into()),
        ParameterKind::ValueRate(power) => {
            let per = match power {
                1 | 2 => return in_either(units, driven, is, |u| order_unit(u, driven, power as usize)),
                n => format!("/s^{n}"),
            };
            in_either(units, driven, is, |u| format!("{}{per}", symbol(u, driven)))
        }
        _ => None,
    }
}

/// Text for the user's units if the rate corresponds to them, otherwise for SI units.
fn in_either(
    units: Units,
    driven: Quantity,
    is: impl Fn(f64) -> bool,
    text: impl Fn(Units) -> String,
) -> Option<String> {
    let meant = [units, Units::default()].into_iter().find(|u| is(u.to_si(driven, 1.0)));
    meant.map(text)
}

/// Formatted direction: `x`, `-z`, `(0.6, 0.8, 0)`.
pub(super) fn direction_text(v: Vec3) -> String {
    let Some(u) = v.unit() else { return "nothing".into() };
    const AXES: [(&str, [f64; 3]); 6] = [
        ("x", [1.0, 0.0, 0.0]),
        ("y", [0.0, 1.0, 0.0]),
        ("z", [0.0, 0.0, 1.0]),
        ("-x", [-1.0, 0.0, 0.0]),
        ("-y", [0.0, -1.0, 0.0]),
        ("-z", [0.0, 0.0, -1.0]),
    ];
    let near = |a: &[f64; 3]| u.to_array().iter().zip(a).all(|(p, q)| (p - q).abs() < 1e-12);
    match AXES.iter().find(|(_, a)| near(a)) {
        Some((name, _)) => (*name).into(),
        None => format!("({})", u.to_array().map(|x| rounded(x, 3)).join(", ")),
    }
}
