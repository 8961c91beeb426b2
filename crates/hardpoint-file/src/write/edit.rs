//! Edits of a model file for a changed design: the same text with new numbers.

use hardpoint::joint::Quantity;
use hardpoint::law::ParameterKind;
use hardpoint::model::{Change, Direction, Model, VariableId};
use hardpoint::space::{Mat3, Vec3};
use toml_edit::{DocumentMut, Item, Value};

use crate::compose::Plane;
use crate::read::{ModelFile, parsed};
use crate::values::{Diagnostic, Diagnostics, Folder, Severity, quoted};
use hardpoint_table::Units;

use super::split::split;

/// Tolerance of written numbers in units of round-off, which covers the sums, products and roots between a number of
/// the file and of the changed design: 5.200000000000001 is written as 5.2.
const ROUND_OFF: f64 = 8.0 * f64::EPSILON;
/// Tolerance of directions and lengths of the saved file, in rad or relative to the mechanism's size: some hundred
/// times the round-off of their roots, far below manufacturing tolerances.
const SAME: f64 = 1e-12;
/// Fraction of the bounds for a trial of saving: small enough that expressions keep their values.
const TRIAL: f64 = 1e-4;

impl ModelFile {
    /// Text of this file with the design changed: variable k of [`model`](Self::model) at `design[k]` (missing
    /// entries are 0) becomes 0, the new nominal design. Comments, order, layout and untouched numbers stay as they
    /// are; expressions keep their dependence on them; bounds and named designs stay at the same values.
    ///
    /// The new text is read back and verified to describe the changed design to round-off.
    ///
    /// # Errors
    /// Lists the parts of the change that the text has no number for, variable by variable.
    ///
    /// ```
    /// let text = r#"
    /// name = "pendulum"
    /// units = { length = "mm", angle = "deg" }
    /// hardpoints = { pivot = [0, 0, 500], bob = [0, 0, 200] } # as measured
    /// bodies = { arm = {} }
    /// joints.hinge = { type = "revolute", bodies = ["ground", "arm"], at = "pivot", axis = "y" }
    /// drivers.swing = { joint = "hinge", law = "30*sin(2*pi*t)" }
    /// design.bob_z = { move = "bob", along = "z", bounds = [-5, 5] }
    /// points.bob = { body = "arm", at = "bob" }
    /// time = { end = 1.0, steps = 100 }
    /// "#;
    /// let file = hardpoint_file::parse(text, "pendulum.toml").unwrap();
    /// let lower = file.edit(&[-0.0025]).unwrap();
    /// let expected = text.replace("[0, 0, 200]", "[0, 0, 197.5]").replace("[-5, 5]", "[-2.5, 7.5]");
    /// assert_eq!(lower, expected);
    /// ```
    pub fn edit(&self, design: &[f64]) -> Result<String, Diagnostics> {
        let count = self.model.variables.len();
        let values: Vec<f64> = design.iter().copied().chain(std::iter::repeat(0.0)).take(count).collect();
        if values.iter().all(|v| *v == 0.0) {
            return Ok(self.text().to_owned());
        }
        // The reader has parsed the text, so the editor can.
        let document = self.text().parse().expect("the text has been read as TOML");
        let mut edit = Edit { file: self, values, document, faults: Vec::new() };
        edit.hardpoints();
        edit.parameters();
        edit.lengths();
        edit.laws();
        edit.joints();
        edit.bounds();
        edit.designs();
        if !edit.faults.is_empty() {
            return Err(Diagnostics::new(self.source.clone(), edit.faults));
        }
        let mut text = edit.document.to_string();
        if self.text().contains("\r\n") {
            text = text.replace("\r\n", "\n").replace('\n', "\r\n");
        }
        self.read_back(&text, &edit.values)?;
        Ok(text)
    }

    /// Checks that changes of some design variables can be saved in this file, before any work is done for them.
    ///
    /// # Errors
    /// Lists the parts of a small change of all of them that the text has no number for.
    pub fn check_savable(&self, variables: &[VariableId]) -> Result<(), Diagnostics> {
        let mut design = vec![0.0; self.model.variables.len()];
        for (k, v) in variables.iter().enumerate() {
            let [low, high] = self.model.variables[v.0].bounds.unwrap_or([-1.0, 1.0]);
            let room = if high > -low { high } else { low };
            // Each variable changes by a different part of its range.
            design[v.0] = TRIAL * room * (1.0 + k as f64 / variables.len() as f64);
        }
        match self.edit(&design) {
            Err(found) if found.list().iter().any(|d| d.code == CODE) => Err(found),
            _ => Ok(()),
        }
    }

    /// Returns whether the hardpoint, joint or parameter of this name is a mirror image.
    pub fn is_image(&self, name: &str) -> bool {
        self.origins.names.contains_key(name)
    }

    /// Returns whether the new text describes the changed design.
    fn read_back(&self, text: &str, values: &[f64]) -> Result<(), Diagnostics> {
        let saved = parsed(Folder::Given(&self.texts), text, self.file_name())?;
        let Some((what, name)) = difference(&self.model, values, &saved.model) else { return Ok(()) };
        let message = "the changed design cannot be saved in this file";
        let d = self
            .diagnostic(Severity::Error, CODE, message, None)
            .note(format!("a file with its numbers would define another {what} `{name}`"));
        let d = match self.origins.names.get(&name) {
            Some(original) => d
                .note(format!("`{name}` is the mirror image of `{original}`, and has no numbers of its own"))
                .help(format!("change both in the same way, or write the differences of `{name}` by hand")),
            None => d.help("change the defining numbers in the file itself"),
        };
        Err(Diagnostics::new(self.source.clone(), vec![d]))
    }
}

/// Hardpoints of a model's text whose coordinates are plain numbers, in their order.
pub fn hardpoints_in(text: &str) -> Vec<String> {
    let document: DocumentMut = text.parse().unwrap_or_default();
    let entries = document.get("hardpoints").and_then(Item::as_table_like);
    let is_plain =
        |item: &Item| item.as_array().is_some_and(|list| list.iter().all(|v| v.is_integer() || v.is_float()));
    let entries = entries.into_iter().flat_map(toml_edit::TableLike::iter);
    entries.filter(|(_, item)| is_plain(item)).map(|(name, _)| name.to_owned()).collect()
}

/// Text of a model with another name and other hardpoints, in the text's unit of length. Comments and layout are
/// preserved; for points with two coordinates, those in the plane are written.
///
/// ```
/// let text = "name = \"x\"\nplanar = \"zx\"\n[hardpoints]\nA = [0, 0] # here\n";
/// let placed = hardpoint_file::placed(text, "y", &[("A".to_owned(), [1.0, 2.0, 3.5])]);
/// assert_eq!(placed, "name = \"y\"\nplanar = \"zx\"\n[hardpoints]\nA = [3.5, 1] # here\n");
/// ```
pub fn placed(text: &str, name: &str, places: &[(String, [f64; 3])]) -> String {
    let mut document: DocumentMut = text.parse().unwrap_or_default();
    let plane = document.get("planar").and_then(Item::as_str).and_then(Plane::named);
    if let Some(value) = value_at(&mut document, &[Key("name")]) {
        let decor = value.decor().clone();
        *value = name.into();
        *value.decor_mut() = decor;
    }
    for (hardpoint, place) in places {
        for (axis, x) in place.iter().enumerate() {
            let list = document.get("hardpoints").and_then(|t| t.get(hardpoint)?.as_array());
            let k = match (list.map(toml_edit::Array::len), plane) {
                (Some(2), Some(plane)) => plane.coordinate(axis),
                _ => Some(axis),
            };
            let Some(k) = k else { continue };
            if let Some(value) = value_at(&mut document, &[Key("hardpoints"), Key(hardpoint), At(k)]) {
                replace(value, &format!("{}", if *x == 0.0 { 0.0 } else { *x }));
            }
        }
    }
    document.to_string()
}

/// Value at a path of keys, as written.
pub fn at_keys(text: &str, keys: &[&str]) -> Option<String> {
    let mut document: DocumentMut = text.parse().ok()?;
    let keys: Vec<Step<'_>> = keys.iter().map(|key| Key(key)).collect();
    value_at(&mut document, &keys).map(|value| value.clone().decorated("", "").to_string())
}

/// Text with another value at a path of keys; unchanged if there is no such path, or the value is not TOML.
pub fn with_keys(text: &str, keys: &[&str], value: &str) -> String {
    let (Ok(mut document), Ok(_)) = (text.parse::<DocumentMut>(), value.parse::<Value>()) else {
        return text.to_owned();
    };
    let keys: Vec<Step<'_>> = keys.iter().map(|key| Key(key)).collect();
    match value_at(&mut document, &keys) {
        Some(old) => replace(old, value),
        None => return text.to_owned(),
    }
    document.to_string()
}

/// Coordinates of a hardpoint as plain numbers of a model's text, in its unit of length.
pub fn hardpoint_in(text: &str, name: &str) -> Option<[f64; 3]> {
    let list: Value = at_keys(text, &["hardpoints", name])?.parse().ok()?;
    let numbers: Option<Vec<f64>> = (list.as_array()?.iter())
        .map(|v| v.as_float().or_else(|| v.as_integer().map(|i| i as f64)))
        .collect();
    numbers?.try_into().ok()
}

/// A change that the file has no number for.
const CODE: &str = "HP0505";

struct Edit<'f> {
    file: &'f ModelFile,
    values: Vec<f64>,
    document: DocumentMut,
    faults: Vec<Diagnostic>,
}

/// A step of a path to a value: a key of a table, or an index of a list.
#[derive(Clone, Copy)]
enum Step<'s> {
    Key(&'s str),
    At(usize),
}

use Step::{At, Key};

impl Edit<'_> {
    fn units(&self) -> Units {
        self.file.units
    }

    /// Variables that are changed, with their values and changes one by one.
    fn changes(&self) -> impl Iterator<Item = (usize, &Change, f64)> {
        let variables = self.file.model.variables.iter().zip(&self.values).enumerate();
        let changed = variables.filter(|(_, (_, value))| **value != 0.0);
        changed.flat_map(|(k, (v, value))| v.changes.iter().map(move |change| (k, change, *value)))
    }

    /// Returns whether this is a mirror image: its numbers are those of the original, and are valid if both change in
    /// the same way.
    fn is_image(&self, name: &str) -> bool {
        self.file.origins.names.contains_key(name)
    }

    /// Returns true, with a diagnostic, if a value is written in another file and cannot be saved in this one.
    fn is_elsewhere(&mut self, variables: &str, name: &str) -> bool {
        let Some(file) = self.file.origins.included.get(name) else { return false };
        let why = format!("`{name}` is in the included file `{file}`");
        self.refuse(
            variables,
            why,
            "change it there, or write it in this file as well, which takes precedence",
        );
        true
    }

    /// Names of the variables with such a change, for messages.
    fn of(&self, does: impl Fn(&Change) -> bool) -> String {
        let mut names: Vec<&str> = Vec::new();
        for (k, _, _) in self.changes().filter(|(_, change, _)| does(change)) {
            let name = self.file.model.variables[k].name.as_str();
            if !names.contains(&name) {
                names.push(name);
            }
        }
        quoted(&names)
    }

    fn refuse(&mut self, variables: &str, why: String, help: &str) {
        let message = format!("the change of {variables} cannot be saved: {why}");
        self.faults.push(self.file.diagnostic(Severity::Error, CODE, message, None).help(help));
    }

    /// P = P_o + sum_k v_k b_k, for every coordinate that is a number of the file.
    fn hardpoints(&mut self) {
        let (file, units) = (self.file, self.units());
        let places = file.model.hardpoint_places(&self.values);
        for (h, hardpoint) in file.model.hardpoints.iter().enumerate() {
            for axis in 0..3 {
                let (old, new) = (hardpoint.position[axis], places[h][axis]);
                let moved = |c: &Change| matches!(c, Change::Move(m) if m.hardpoint.0 == h && m.velocity[axis] != 0.0);
                let by = self.of(moved);
                if by.is_empty() || old == new {
                    continue;
                }
                if hardpoint.unnamed {
                    let at = hardpoint.position * units.of(Quantity::Length).1;
                    let why = format!(
                        "it moves the place [{:.6}, {:.6}, {:.6}] {}, which has no name in the file",
                        at.x,
                        at.y,
                        at.z,
                        units.of(Quantity::Length).0
                    );
                    self.refuse(
                        &by,
                        why,
                        "make this place a hardpoint of the file, and name it where it is used",
                    );
                    break;
                }
                let way = [Key("hardpoints"), Key(&hardpoint.name), At(axis)];
                if !self.write(&way, Quantity::Length, old, new)
                    && !self.is_image(&hardpoint.name)
                    && !self.is_elsewhere(&by, &hardpoint.name)
                {
                    let coordinate = format!("{}.{}", hardpoint.name, ["x", "y", "z"][axis]);
                    let why = format!("`{coordinate}` is given by an expression, which it does not move");
                    self.refuse(
                        &by,
                        why,
                        "change the parameters that the expression uses, or write a number there",
                    );
                }
            }
        }
    }

    /// p = p_o + sum_k (dp/db_k) b_k
    fn parameters(&mut self) {
        let model = &self.file.model;
        for (p, parameter) in model.parameters.iter().enumerate() {
            let rates = self.changes().filter_map(|(_, change, value)| match change {
                Change::Parameter(c) if c.parameter.0 == p => Some(c.rate * value),
                _ => None,
            });
            let by: f64 = rates.sum();
            if by == 0.0 {
                continue;
            }
            let (name, old) = (Key(&parameter.name), parameter.value);
            let written = [&[Key("parameters"), name][..], &[Key("parameters"), name, Key("value")]]
                .iter()
                .any(|way| self.write(way, parameter.quantity, old, old + by));
            let by = self.of(|c| matches!(c, Change::Parameter(c) if c.parameter.0 == p));
            if !written && !self.is_image(&parameter.name) && !self.is_elsewhere(&by, &parameter.name) {
                let why = format!("parameter `{}` is given by an expression", parameter.name);
                self.refuse(&by, why, "change the parameters that it follows");
            }
        }
    }

    /// Changes given lengths of rods; a length that follows from hardpoints is written if these move and the rod keeps
    /// its length.
    fn lengths(&mut self) {
        let model = &self.file.model;
        let kept = model.geometry(&self.values).kept;
        let places = model.hardpoint_places(&self.values);
        let keeping = |v: &hardpoint::model::DesignVariable| v.fixed_length;
        let keeps = model.variables.iter().zip(&self.values).any(|(v, value)| keeping(v) && *value != 0.0);
        for (j, joint) in model.joints.iter().enumerate() {
            let way = [Key("joints"), Key(&joint.name), Key("length")];
            let grown = |c: &Change| matches!(c, Change::Length(c) if c.joint.0 == j);
            let by = self.of(grown);
            if let (Some(old), false) = (joint.length, by.is_empty()) {
                let grows: f64 = self
                    .changes()
                    .filter_map(|(_, c, value)| match c {
                        Change::Length(c) if c.joint.0 == j => Some(c.rate * value),
                        _ => None,
                    })
                    .sum();
                if !self.write(&way, Quantity::Length, old, old + grows)
                    && !self.is_image(&joint.name)
                    && !self.is_elsewhere(&by, &joint.name)
                {
                    let why = format!("the `length` of `{}` is given by an expression", joint.name);
                    self.refuse(&by, why, "change the parameters that the expression uses");
                }
            }
            let [i, k] = joint.at.map(|h| places[h.0]);
            let (length, drawn) = (kept[j].distance, (k - i).norm());
            if keeps
                && joint.length.is_none()
                && joint.kind.is_rod()
                && (length - drawn).abs() > ROUND_OFF * drawn
            {
                let number = shortest(
                    length,
                    ROUND_OFF * length,
                    |x| self.units().to_si(Quantity::Length, x),
                    self.units().from_si(Quantity::Length, length),
                );
                let added = joint_table(&mut self.document, &joint.name, &number);
                if !added && !self.is_image(&joint.name) {
                    let by = model
                        .variables
                        .iter()
                        .zip(&self.values)
                        .find(|(v, value)| keeping(v) && **value != 0.0);
                    let by = by.map_or(String::new(), |(v, _)| format!("`{}`", v.name));
                    let why = format!(
                        "`{}` keeps its length, and has no table in the file to write that to",
                        joint.name
                    );
                    self.refuse(&by, why, "write the rod as a joint of its own, with a `length`");
                }
            }
        }
    }

    /// Changes parameters of laws.
    fn laws(&mut self) {
        let model = &self.file.model;
        let laws = model.laws(&self.values);
        let changed: Vec<(usize, usize)> = {
            let all = self.changes().filter_map(|(_, c, _)| match c {
                Change::Law(c) => Some((c.driver.0, c.parameter)),
                _ => None,
            });
            let mut all: Vec<_> = all.collect();
            all.sort_unstable();
            all.dedup();
            all
        };
        for (d, p) in changed {
            let driver = &model.drivers[d];
            let [old, new] = [&driver.law, &laws[d]].map(|law| law.parameters().swap_remove(p));
            let quantity = match old.kind {
                ParameterKind::Value | ParameterKind::ValueRate(_) => model.driven(driver).quantity,
                ParameterKind::Angle => Quantity::Angle,
                _ => Quantity::Number,
            };
            let name = old.name.replace(']', "").replace('[', ".");
            let steps: Vec<Step<'_>> = name.split('.').map(|s| s.parse().map_or(Key(s), At)).collect();
            let start = [Key("drivers"), Key(&driver.name)];
            // Values of a table are the second numbers of its `points`.
            let steps = match &steps[..] {
                [Key("f"), At(k)] => vec![Key("points"), At(*k), At(1)],
                _ => steps,
            };
            let ways = [[&start[..], &steps].concat(), [&start[..], &[Key("law")], &steps].concat()];
            let written = ways.iter().any(|way| self.write(way, quantity, old.value, new.value));
            let by = self.of(|c| matches!(c, Change::Law(c) if c.driver.0 == d && c.parameter == p));
            if !written && !self.is_image(&driver.name) && !self.is_elsewhere(&by, &driver.name) {
                let why = format!(
                    "the law of driver `{}` has no number `{}` of its own in the file",
                    driver.name, old.name
                );
                self.refuse(&by, why, "write the law as a table that names this number");
            }
        }
    }

    /// Changes directions of joints.
    fn joints(&mut self) {
        let model = &self.file.model;
        let [before, after] = [&[][..], &self.values].map(|design| model.geometry(design));
        let places = model.hardpoint_places(&self.values);
        for (j, joint) in model.joints.iter().enumerate() {
            let own = |c: &Change| match c {
                Change::Marker(c) => c.joint.0 == j,
                Change::Field(c) => c.joint.0 == j,
                _ => false,
            };
            let by = self.of(own);
            if by.is_empty() {
                continue;
            }
            let frames = joint.bodies.map(|b| model.bodies[b.0].frame);
            let shift = |e: usize| frames[e].compose(after.markers[j][e]).r - places[joint.at[e].0];
            let size = model.size();
            if [0, 1].into_iter().any(|e| shift(e).norm() > SAME * size) {
                let why = format!("it moves a marker of joint `{}` away from its hardpoint", joint.name);
                self.refuse(
                    &by,
                    why,
                    "move a hardpoint instead; files define locations of joints by hardpoints only",
                );
                continue;
            }
            // R = C C_o^T of each marker in the world
            let turned = [0, 1].map(|e| {
                let [old, new] = [&before, &after].map(|g| frames[e].rot * g.markers[j][e].rot);
                new * old.transpose()
            });
            for (which, key) in ["axis", "axis2"].into_iter().enumerate() {
                let written = if which == 0 { joint.axis } else { joint.axis2 };
                let Some(direction) = written else { continue };
                let on = ends_of(joint, which);
                let Direction::Along(old) = direction else {
                    if on.iter().any(|&e| turns(&turned[e])) {
                        let why = format!("`{key}` of joint `{}` passes through hardpoints", joint.name);
                        self.refuse(
                            &by,
                            why,
                            "move these hardpoints, or give the joint's direction by three numbers",
                        );
                    }
                    continue;
                };
                let new: Vec<Vec3> = on.iter().map(|&e| turned[e] * old).collect();
                if new.windows(2).any(|w| (w[0] - w[1]).norm() > SAME) {
                    let why = format!("it turns the two markers of joint `{}` differently", joint.name);
                    self.refuse(&by, why, "a file defines one direction for both markers of a joint");
                    continue;
                }
                let Some(new) = new.first().filter(|n| (**n - old).norm() > ROUND_OFF) else { continue };
                let way = [Key("joints"), Key(&joint.name), Key(key)];
                if !self.direction(&way, *new)
                    && !self.is_image(&joint.name)
                    && !self.is_elsewhere(&by, &joint.name)
                {
                    let why = format!("joint `{}` has no `{key}` in the file", joint.name);
                    self.refuse(&by, why, "write the joint with its direction in a table of its own");
                }
            }
        }
    }

    /// Bounds stay at the same values: [a, b] becomes [a - x, b - x] for a variable whose value x becomes 0. Bounds of
    /// parameters are absolute.
    fn bounds(&mut self) {
        let model = &self.file.model;
        self.split_entries();
        let mut done: Vec<String> = Vec::new();
        for (variable, value) in model.variables.iter().zip(self.values.clone()) {
            let Some([low, high]) = variable.bounds else { continue };
            let Some(entry) = self.entry_of(&variable.name) else { continue };
            // Variables of one entry move alike.
            if done.contains(&entry) {
                continue;
            }
            done.push(entry.clone());
            if value == 0.0 {
                continue;
            }
            for (k, bound) in [low, high].into_iter().enumerate() {
                // A design at its bound must not exceed it by round-off.
                let near = (bound - value).abs() <= ROUND_OFF * bound.abs().max(value.abs());
                let new = if near { 0.0 } else { bound - value };
                if near || (new < 0.0) == (k == 0) {
                    self.write(
                        &[Key("design"), Key(&entry), Key("bounds"), At(k)],
                        variable.quantity,
                        bound,
                        new,
                    );
                } else {
                    let name = format!("`{}`", variable.name);
                    self.refuse(
                        &name,
                        "the changed design is beyond its bounds".into(),
                        "widen its bounds first, or change it less",
                    );
                    break;
                }
            }
        }
    }

    /// Splits entries of several variables, if these have bounds and move differently.
    fn split_entries(&mut self) {
        let model = &self.file.model;
        let mut shared: Vec<(String, Vec<usize>)> = Vec::new();
        for (k, variable) in model.variables.iter().enumerate().filter(|(_, v)| v.bounds.is_some()) {
            let Some(entry) = self.entry_of(&variable.name) else { continue };
            match shared.iter_mut().find(|(name, _)| *name == entry) {
                Some((_, variables)) => variables.push(k),
                None => shared.push((entry, vec![k])),
            }
        }
        for (entry, variables) in shared {
            let names: Vec<&str> = variables.iter().map(|k| model.variables[*k].name.as_str()).collect();
            if variables.iter().all(|k| self.values[*k] == self.values[variables[0]]) {
                continue;
            }
            let axes: Vec<&str> = names.iter().map(|name| &name[entry.len() + 1..]).collect();
            if !split(&mut self.document, &entry, &axes) {
                let count = names.len();
                let why = format!("`{entry}` makes {count} variables with one pair of bounds");
                let help = "write one variable for each coordinate, with bounds of its own";
                self.refuse(&quoted(&names), why, help);
            }
        }
    }

    /// Entry of `[design]` that makes a variable: its own, or the one of the point `P` for `P_x`; `None` if it is not
    /// in this file.
    fn entry_of(&self, variable: &str) -> Option<String> {
        let has = |name: &str| self.document.get("design").and_then(|d| d.get(name)).is_some();
        let whole = variable.strip_suffix(['x', 'y', 'z']).and_then(|n| n.strip_suffix('_'));
        [Some(variable), whole].into_iter().flatten().find(|name| has(name)).map(str::to_owned)
    }

    /// Values of named designs stay the same: x of a variable whose value v becomes 0 is written as x - v. Those of
    /// parameters are absolute, and variables that a design does not name are those of the new nominal design.
    fn designs(&mut self) {
        let model = &self.file.model;
        for design in &model.designs {
            for (variable, by) in &design.changes {
                let of = &model.variables[variable.0];
                let value = self.values[variable.0];
                if value == 0.0 || self.document.get("parameters").and_then(|p| p.get(&of.name)).is_some() {
                    continue;
                }
                let near = (by - value).abs() <= ROUND_OFF * by.abs().max(value.abs());
                let new = if near { 0.0 } else { by - value };
                self.write(&[Key("designs"), Key(&design.name), Key(&of.name)], of.quantity, *by, new);
            }
        }
    }

    /// Replaces a number; returns false if there is none.
    fn write(&mut self, way: &[Step<'_>], quantity: Quantity, old: f64, new: f64) -> bool {
        let units = self.units();
        let way = self.written_way(way);
        let Some(value) = value_at(&mut self.document, &way) else { return false };
        let Some(point) = number_style(value) else { return false };
        let near = ROUND_OFF * old.abs().max(new.abs());
        let mut text = shortest(new, near, |x| units.to_si(quantity, x), units.from_si(quantity, new));
        if point && !text.contains(['.', 'e']) {
            text += ".0";
        }
        replace(value, &text);
        true
    }

    /// Path to a coordinate of a hardpoint with two coordinates.
    fn written_way<'w>(&self, way: &[Step<'w>]) -> Vec<Step<'w>> {
        let mut way = way.to_vec();
        if let ([Key("hardpoints"), Key(name), At(axis)], Some(plane)) = (&mut way[..], self.file.plane) {
            let list = self.document.get("hardpoints").and_then(|t| t.get(*name)?.as_array());
            if list.is_some_and(|list| list.len() == 2) {
                *axis = plane.coordinate(*axis).unwrap_or(usize::MAX);
            }
        }
        way
    }

    /// Replaces a direction and keeps the length of the written vector.
    fn direction(&mut self, way: &[Step<'_>], unit: Vec3) -> bool {
        let Some(value) = value_at(&mut self.document, way) else { return false };
        let numbers = |value: &Value| -> Option<Vec<f64>> {
            value.as_array()?.iter().map(|v| v.as_float().or(v.as_integer().map(|x| x as f64))).collect()
        };
        let length = match numbers(value) {
            Some(list) => list.iter().map(|x| x * x).sum::<f64>().sqrt(),
            None if value.is_str() => 1.0,
            None => return false,
        };
        // Components of a unit vector have the round-off of its length.
        let texts =
            [0, 1, 2].map(|n| shortest(unit[n] * length, ROUND_OFF * length, |x| x, unit[n] * length));
        match value.as_array_mut().filter(|list| list.len() == 3) {
            Some(list) => texts.iter().zip(list.iter_mut()).for_each(|(text, value)| replace(value, text)),
            None => replace(value, &format!("[{}]", texts.join(", "))),
        }
        true
    }
}

/// Markers that an axis of a joint defines.
fn ends_of(joint: &hardpoint::model::Joint, which: usize) -> &'static [usize] {
    match (joint.kind.axis2, which) {
        (hardpoint::joint::Need::OnBodyJ, 0) => &[0],
        (hardpoint::joint::Need::OnBodyJ, _) => &[1],
        _ => &[0, 1],
    }
}

fn turns(rotation: &Mat3) -> bool {
    Vec3::AXES.iter().any(|a| (*rotation * *a - *a).norm() > SAME)
}

fn value_at<'d>(document: &'d mut DocumentMut, way: &[Step<'_>]) -> Option<&'d mut Value> {
    let mut item: &mut Item = document.as_item_mut();
    for (k, step) in way.iter().enumerate() {
        match step {
            Key(key) => item = item.as_table_like_mut()?.get_mut(key)?,
            // Tables of a list continue below their header; a list of values has values only.
            At(n) if item.is_array_of_tables() => {
                let table = item.as_array_of_tables_mut()?.get_mut(*n)?;
                let Some(Key(key)) = way.get(k + 1) else { return None };
                return table.get_mut(key)?.as_value_mut().filter(|_| way.len() == k + 2);
            }
            At(n) => {
                let value = item.as_array_mut()?.get_mut(*n)?;
                return match way.get(k + 1..)? {
                    [] => Some(value),
                    [At(m)] => value.as_array_mut()?.get_mut(*m),
                    [Key(key)] => value.as_inline_table_mut()?.get_mut(key),
                    [Key(key), At(m)] => {
                        value.as_inline_table_mut()?.get_mut(key)?.as_array_mut()?.get_mut(*m)
                    }
                    _ => None,
                };
            }
        }
    }
    item.as_value_mut()
}

/// Returns whether a number is written with a decimal point; `None` for other values.
fn number_style(value: &Value) -> Option<bool> {
    match value {
        Value::Integer(_) => Some(false),
        Value::Float(f) => {
            Some(f.as_repr().and_then(|r| r.as_raw().as_str()).is_some_and(|t| t.contains('.')))
        }
        _ => None,
    }
}

/// Replaces a value and preserves the space and comments around it.
fn replace(value: &mut Value, text: &str) {
    let decor = value.decor().clone();
    *value = text.parse().expect("a number or a list of numbers is TOML");
    *value.decor_mut() = decor;
}

/// Adds the length to the table of a rod.
fn joint_table(document: &mut DocumentMut, joint: &str, length: &str) -> bool {
    let table = document.get_mut("joints").and_then(|j| j.as_table_like_mut()?.get_mut(joint));
    let Some(table) = table.and_then(Item::as_table_like_mut) else { return false };
    let value: Value = length.parse().expect("a number is TOML");
    table.insert("length", Item::Value(value));
    true
}

/// Number with the fewest digits that is read as `target`, or within `near` of it; `exact` is the same in the unit of
/// the text.
fn shortest(target: f64, near: f64, to_si: impl Fn(f64) -> f64, exact: f64) -> String {
    let tried = (0..17).map(|digits| format!("{exact:.digits$e}"));
    let found = tried
        .filter_map(|text| text.parse::<f64>().ok())
        .find(|x| (to_si(*x) - target).abs() <= near)
        .unwrap_or(exact);
    // No -0 in a file.
    format!("{}", if found == 0.0 { 0.0 } else { found })
}

/// Name of the first difference between a changed design and the nominal design of another model, if there is one.
fn difference(model: &Model, values: &[f64], saved: &Model) -> Option<(String, String)> {
    let found = |what: &str, name: &str| Some((what.to_owned(), name.to_owned()));
    let size = model.size();
    let near = |a: Vec3, b: Vec3, size: f64| (a - b).norm() <= SAME * size;
    let far = model.distance_from_origin() + size;
    for (place, hardpoint) in model.hardpoint_places(values).into_iter().zip(&model.hardpoints) {
        let other = saved.hardpoints.iter().find(|h| h.name == hardpoint.name);
        if other.is_some_and(|other| !near(place, other.position, far)) {
            return found("place of hardpoint", &hardpoint.name);
        }
    }
    let (changed, again) = (model.geometry(values), saved.geometry(&[]));
    for (j, joint) in model.joints.iter().enumerate() {
        let [a, b] = [&changed, &again].map(|g| g.kept[j].distance);
        if !((a - b).abs() <= SAME * size) {
            return found("length of joint", &joint.name);
        }
        let world = |m: &Model, g: &hardpoint::design::Geometry, e: usize| {
            m.bodies[joint.bodies[e].0].frame.compose(g.markers[j][e])
        };
        for e in [0, 1] {
            let [a, b] = [world(model, &changed, e), world(saved, &again, e)];
            if !near(a.r, b.r, far) {
                return found("place of joint", &joint.name);
            }
            if joint.axis.is_some() && !near(a.rot.cols[2], b.rot.cols[2], 1.0) {
                return found("axis of joint", &joint.name);
            }
        }
    }
    for ((a, b), driver) in model.laws(values).iter().zip(saved.laws(&[])).zip(&model.drivers) {
        for (a, b) in a.parameters().iter().zip(b.parameters()) {
            if !((a.value - b.value).abs() <= SAME * a.value.abs().max(1.0)) {
                return found(&format!("`{}` of driver", a.name), &driver.name);
            }
        }
    }
    None
}
