//! Description and unit of a design variable's change.

use hardpoint::model::{Change, Model};
use hardpoint::space::Vec3;

use crate::figures::{names, number, rounded};

/// Short description of a variable's change.
pub(crate) fn change_text(model: &Model, changes: &[Change], fixed_length: bool) -> String {
    let said = model.describe_changes(changes, &direction_text, &number);
    let said =
        said.iter().map(|c| format!("{} {}{}", c.verb, names(c.names.iter().map(String::as_str)), c.how));
    let mut text = said.collect::<Vec<_>>().join("; ");
    if fixed_length {
        text += "; rods keep their lengths";
    }
    text
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
