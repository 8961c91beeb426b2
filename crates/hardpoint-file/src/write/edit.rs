//! Edits of a model file for a changed design: the same text with new numbers.

use hardpoint::constraint::{MarkerPair, Row};
use hardpoint::design::{Geometry, JointConstants};
use hardpoint::joint::{Need, Quantity};
use hardpoint::model::{Change, Direction, Hardpoint, Joint, JointId, Model, VariableId};
use hardpoint::space::{Mat3, Vec3};
use toml_edit::{DocumentMut, Item, Value};

use crate::compose::Plane;
use crate::read::{ModelFile, parsed};
use crate::values::{Diagnostic, Diagnostics, Folder, Severity, quoted};
use hardpoint_table::Units;

use super::split::split;
use super::text::Step::{self, At, Key};
use super::text::{ROUND_OFF, add, number_style, replace, shortest, table_at, value_at};

/// Tolerance of directions and lengths of the saved file, in rad or relative to the mechanism's size: some hundred
/// times the round-off of their roots, far below manufacturing tolerances.
const SAME: f64 = 1e-12;
/// Fraction of the bounds for a trial of saving: small enough that expressions keep their values.
const TRIAL: f64 = 1e-4;

impl ModelFile {
    /// Text of this file with the design changed: variable k of [`model`](Self::model) at `design[k]` (missing
    /// entries are 0) becomes 0, the new nominal design. Comments, order, layout and untouched numbers stay as they
    /// are; expressions keep their dependence on them; bounds, named designs, ranges of sweeps and means of priors stay
    /// at the same values.
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
        edit.given_lengths();
        edit.fixed_lengths();
        edit.laws();
        edit.joints();
        edit.second_axes();
        edit.curves();
        edit.bounds();
        edit.values_of_variables();
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
        let d =
            self.diagnostic(Severity::Error, CODE, "the changed design cannot be saved in this file", None);
        // Positions in the new text are not those of the file.
        let saved = match parsed(Folder::Given(&self.texts), text, self.file_name()) {
            Ok(saved) => saved,
            Err(found) => {
                let errors = found.list().iter().filter(|e| e.severity == Severity::Error);
                let invalid = |e: &Diagnostic| format!("a file with its numbers is invalid: {}", e.message);
                let d = errors.map(invalid).fold(d, Diagnostic::note);
                let d = d.help("leave out the variables that cause this, or change the file by hand");
                return Err(Diagnostics::new(self.source.clone(), vec![d]));
            }
        };
        let Some((what, name)) = difference(&self.model, values, &saved.model) else { return Ok(()) };
        let d = d.note(format!("a file with its numbers would define another {what} `{name}`"));
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
pub(super) const CODE: &str = "HP0505";

/// A file in which a changed design is written.
pub(super) struct Edit<'f> {
    pub file: &'f ModelFile,
    pub values: Vec<f64>,
    pub document: DocumentMut,
    faults: Vec<Diagnostic>,
}

impl Edit<'_> {
    fn units(&self) -> Units {
        self.file.units
    }

    /// Variables that are changed, with their values and changes one by one.
    pub fn changes(&self) -> impl Iterator<Item = (usize, &Change, f64)> {
        let variables = self.file.model.variables.iter().zip(&self.values).enumerate();
        let changed = variables.filter(|(_, (_, value))| **value != 0.0);
        changed.flat_map(|(k, (v, value))| v.changes.iter().map(move |change| (k, change, *value)))
    }

    /// Returns whether this is a mirror image: its numbers are those of the original, and are valid if both change in
    /// the same way.
    pub fn is_image(&self, name: &str) -> bool {
        self.file.origins.names.contains_key(name)
    }

    /// Returns true, with a diagnostic, if a value is written in another file and cannot be saved in this one.
    pub fn is_elsewhere(&mut self, variables: &str, name: &str) -> bool {
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
    pub fn of(&self, does: impl Fn(&Change) -> bool) -> String {
        let mut names: Vec<&str> = Vec::new();
        for (k, _, _) in self.changes().filter(|(_, change, _)| does(change)) {
            let name = self.file.model.variables[k].name.as_str();
            if !names.contains(&name) {
                names.push(name);
            }
        }
        quoted(&names)
    }

    pub fn refuse(&mut self, variables: &str, why: String, help: &str) {
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
                let moved =
                    |c: &Change| c.hardpoint().is_some_and(|(moved, v)| moved.0 == h && v[axis] != 0.0);
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
            let rate = |c: &Change| c.parameter().filter(|(changed, _)| changed.0 == p).map(|(_, rate)| rate);
            let rates = self.changes().filter_map(|(_, change, value)| Some(rate(change)? * value));
            let by: f64 = rates.sum();
            if by == 0.0 {
                continue;
            }
            let (name, old) = (Key(&parameter.name), parameter.value);
            let written = [&[Key("parameters"), name][..], &[Key("parameters"), name, Key("value")]]
                .iter()
                .any(|way| self.write(way, parameter.quantity, old, old + by));
            let by = self.of(|c| rate(c).is_some());
            if !written && !self.is_image(&parameter.name) && !self.is_elsewhere(&by, &parameter.name) {
                let why = format!("parameter `{}` is given by an expression", parameter.name);
                self.refuse(&by, why, "change the parameters that it follows");
            }
        }
    }

    /// Changes directions of joints.
    fn joints(&mut self) {
        let model = &self.file.model;
        let [before, after] = [&[][..], &self.values].map(|design| model.geometry(design));
        let places = model.hardpoint_places(&self.values);
        for (j, joint) in model.joints.iter().enumerate() {
            let by = self.of(|c| c.markers_of() == Some(JointId(j)));
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

    /// Writes the x axes of joints that turn with the design and have the default, which the file with the new places
    /// and directions would give another direction.
    fn second_axes(&mut self) {
        let model = &self.file.model;
        let after = model.geometry(&self.values);
        for (j, joint) in model.joints.iter().enumerate().filter(|(_, joint)| has_default_x(model, joint)) {
            let frame = model.bodies[joint.bodies[0].0].frame.rot * after.markers[j][0].rot;
            // An image has the axes of its original.
            if (frame.cols[0] - frame.cols[2].any_perpendicular()).norm() <= SAME
                || self.is_image(&joint.name)
            {
                continue;
            }
            let texts = [0, 1, 2].map(|n| {
                let x = frame.cols[0].to_array()[n];
                shortest(x, ROUND_OFF, |x| x, x)
            });
            let x: Value = format!("[{}]", texts.join(", ")).parse().expect("a list of numbers is a value");
            let by = self.of(|c| c.law().is_none() && c.parameter().is_none());
            let [section, what] = if joint.unnamed { ["drivers", "driver"] } else { ["joints", "joint"] };
            let table = table_at(&mut self.document, &[Key(section), Key(&joint.name)]);
            if table.map(|table| add(table, "axis2", x)).is_none() && !self.is_elsewhere(&by, &joint.name) {
                let why =
                    format!("it turns the x axis of {what} `{}`, which has no table in the file", joint.name);
                self.refuse(&by, why, &format!("write the {what} in a table of its own, with `axis2`"));
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
    pub fn entry_of(&self, variable: &str) -> Option<String> {
        let has = |name: &str| self.document.get("design").and_then(|d| d.get(name)).is_some();
        let whole = variable.strip_suffix(['x', 'y', 'z']).and_then(|n| n.strip_suffix('_'));
        [Some(variable), whole].into_iter().flatten().find(|name| has(name)).map(str::to_owned)
    }

    /// Values of named designs, ranges of a sweep and means of priors stay the same.
    fn values_of_variables(&mut self) {
        let model = &self.file.model;
        for design in &model.designs {
            for (variable, by) in &design.changes {
                let name = &model.variables[variable.0].name;
                self.shift(*variable, &[Key("designs"), Key(&design.name), Key(name)], *by);
            }
        }
        for range in model.sweeping.iter().flat_map(|sweep| &sweep.ranges) {
            let own = [Key("sweep"), Key("variables"), Key(&model.variables[range.variable.0].name)];
            for (k, (end, by)) in [("from", range.low), ("to", range.high)].into_iter().enumerate() {
                // `{ from = -5, to = 5 }` or `[-5, 5]`
                for step in [Key(end), At(k)] {
                    self.shift(range.variable, &[&own[..], &[step]].concat(), by);
                }
            }
        }
        for prior in model.calibrating.iter().flat_map(|calibration| &calibration.priors) {
            let name = &model.variables[prior.variable.0].name;
            let way = [Key("calibrate"), Key("variables"), Key(name), Key("mean")];
            self.shift(prior.variable, &way, prior.mean);
        }
    }

    /// Keeps a value of a variable: x of a variable whose value v becomes 0 is written as x - v. Those of parameters
    /// are absolute, and variables without a written value are those of the new nominal design.
    fn shift(&mut self, variable: VariableId, way: &[Step<'_>], by: f64) {
        let (of, value) = (&self.file.model.variables[variable.0], self.values[variable.0]);
        let is_parameter = self.document.get("parameters").and_then(|p| p.get(&of.name)).is_some();
        if value == 0.0 || is_parameter {
            return;
        }
        let near = (by - value).abs() <= ROUND_OFF * by.abs().max(value.abs());
        let new = if near { 0.0 } else { by - value };
        self.write(way, of.quantity, by, new);
    }

    /// Replaces a number; returns false if there is none.
    pub fn write(&mut self, way: &[Step<'_>], quantity: Quantity, old: f64, new: f64) -> bool {
        let mut text = self.number(quantity, old, new);
        let way = self.written_way(way);
        let Some(value) = value_at(&mut self.document, &way) else { return false };
        let Some(point) = number_style(value) else { return false };
        if point && !text.contains(['.', 'e']) {
            text += ".0";
        }
        replace(value, &text);
        true
    }

    /// Number in the unit of the file, with round-off relative to the old and the new value.
    pub fn number(&self, quantity: Quantity, old: f64, new: f64) -> String {
        let units = self.units();
        let near = ROUND_OFF * old.abs().max(new.abs());
        shortest(new, near, |x| units.to_si(quantity, x), units.from_si(quantity, new))
    }

    /// Path to a coordinate of a place: of two coordinates, those in the plane are written.
    fn written_way<'w>(&mut self, way: &[Step<'w>]) -> Vec<Step<'w>> {
        let is_place = matches!(way, [Key("hardpoints"), ..] | [Key("joints"), _, Key("curve"), ..]);
        let mut written = way.to_vec();
        if let (true, Some(plane), Some((At(axis), list))) = (is_place, self.file.plane, way.split_last())
            && let Some(last) = written.last_mut()
        {
            let list = value_at(&mut self.document, list).and_then(|value| value.as_array());
            if list.is_some_and(|list| list.len() == 2) {
                *last = At(plane.coordinate(*axis).unwrap_or(usize::MAX));
            }
        }
        written
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

/// True if a joint has the default x axis, which its coordinates count along, or elastic laws and reactions where there
/// are loads. Unnamed joints are those of drivers, named like these.
fn has_default_x(model: &Model, joint: &Joint) -> bool {
    let is_default = joint.axis.is_some() && joint.axis2.is_none();
    is_default
        && match joint.kind.axis2 {
            Need::Optional => true,
            Need::Orienting => !joint.unnamed && !model.elements.is_empty(),
            Need::Required | Need::OnBodyJ | Need::Unused => false,
        }
}

/// Markers that an axis of a joint defines.
fn ends_of(joint: &Joint, which: usize) -> &'static [usize] {
    match (joint.kind.axis2, which) {
        (Need::OnBodyJ, 0) => &[0],
        (Need::OnBodyJ, _) => &[1],
        _ => &[0, 1],
    }
}

fn turns(rotation: &Mat3) -> bool {
    Vec3::AXES.iter().any(|a| (*rotation * *a - *a).norm() > SAME)
}

/// Name of the first difference between a changed design and the nominal design of another model, if there is one.
fn difference(model: &Model, values: &[f64], saved: &Model) -> Option<(String, String)> {
    let found = |what: &str, name: &str| Some((what.to_owned(), name.to_owned()));
    let size = model.size();
    let near = |a: Vec3, b: Vec3, size: f64| (a - b).norm() <= SAME * size;
    let far = model.distance_from_origin() + size;
    for (place, hardpoint) in model.hardpoint_places(values).into_iter().zip(&model.hardpoints) {
        // Places without a name are those of joints and points, below.
        let is_same =
            |other: &&Hardpoint| !hardpoint.unnamed && !other.unnamed && other.name == hardpoint.name;
        let other = saved.hardpoints.iter().find(is_same);
        if other.is_some_and(|other| !near(place, other.position, far)) {
            return found("place of hardpoint", &hardpoint.name);
        }
    }
    let (changed, again) = (model.geometry(values), saved.geometry(&[]));
    for (j, (joint, other)) in model.joints.iter().zip(&saved.joints).enumerate() {
        if let Some(constant) = other_constant(joint, &changed.kept[j], &again.kept[j], size) {
            return found(&format!("{constant} of joint"), &joint.name);
        }
        let world =
            |m: &Model, g: &Geometry, e: usize| m.bodies[joint.bodies[e].0].frame.compose(g.markers[j][e]);
        for e in [0, 1] {
            let [a, b] = [world(model, &changed, e), world(saved, &again, e)];
            // A joint without a place is drawn between others.
            if joint.kind.places > 0 && !near(a.r, b.r, far) {
                return found("place of joint", &joint.name);
            }
            if joint.axis.is_some() && !near(a.rot.cols[2], b.rot.cols[2], 1.0) {
                return found("axis of joint", &joint.name);
            }
            let has_x =
                joint.axis2.is_some() && joint.kind.axis2 != Need::OnBodyJ || has_default_x(model, joint);
            if has_x && !near(a.rot.cols[0], b.rot.cols[0], 1.0) {
                return found("second axis of joint", &joint.name);
            }
        }
        if joint.kind.rows.contains(&Row::ConstantVelocity) {
            // The angle of one shaft relative to the other.
            let [a, b] = [(model, &changed), (saved, &again)].map(|(model, geometry)| {
                let [i, j] = [0, 1].map(|e| world(model, geometry, e));
                Row::ConstantVelocity.residual(&MarkerPair { i, j, axes: Mat3::IDENTITY }, 0.0)
            });
            if !((a - b).abs() <= SAME) {
                return found("relation of the shafts of joint", &joint.name);
            }
        }
        if let (Some(a), Some(b)) = (&joint.curve, &other.curve) {
            let [on_a, on_b] = [(model, &changed, a), (saved, &again, b)].map(|(model, geometry, curve)| {
                let marker = world(model, geometry, 0);
                [0, 1, 2, 3, 4].map(|k| {
                    let [[x, y], ..] = curve.at(curve.length() * 0.25 * f64::from(k));
                    marker.point(Vec3::new(x, y, 0.0))
                })
            });
            if on_a.iter().zip(on_b).any(|(a, b)| !near(*a, b, far)) {
                return found("curve of joint", &joint.name);
            }
        }
    }
    for (k, point) in model.points.iter().enumerate() {
        let [a, b] = [(model, &changed), (saved, &again)]
            .map(|(model, geometry)| model.bodies[point.body.0].frame.point(geometry.points[k]));
        if !near(a, b, far) {
            return found("place of point", &point.name);
        }
    }
    for (w, wheel) in model.wheels.iter().enumerate() {
        let [a, b] = [(model, &changed), (saved, &again)]
            .map(|(model, geometry)| model.bodies[wheel.body.0].frame.rot * geometry.spin_axes[w]);
        if !near(a, b, 1.0) {
            return found("spin axis of wheel", &wheel.name);
        }
    }
    // Axes of forces are in the frames of their bodies, which turn with hardpoints if these define them.
    let mut frames = model.bodies.iter().zip(&saved.bodies);
    let are_alike = frames.all(|(a, b)| a.frame.rot == b.frame.rot);
    for ((a, b), element) in changed.axes.iter().zip(&again.axes).zip(&model.elements) {
        if let (Some([a, _]), Some([b, _]), true) = (a, b, are_alike)
            && !near(a.cols[2], b.cols[2], 1.0)
        {
            return found("axis of force", &element.name);
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

/// Name of the first constant of a joint that differs, of those that its constraints and coordinates use.
fn other_constant(
    joint: &Joint,
    changed: &JointConstants,
    saved: &JointConstants,
    size: f64,
) -> Option<&'static str> {
    let rows = joint.kind.rows.iter().copied().chain(joint.kind.coordinates.iter().map(|c| c.row));
    let differs = |row: &Row| {
        let unit = if row.is_length() { size } else { 1.0 };
        !((changed.by(*row) - saved.by(*row)).abs() <= SAME * unit)
    };
    rows.into_iter().find(differs).map(|row| if row == Row::Distance { "length" } else { "constant" })
}
