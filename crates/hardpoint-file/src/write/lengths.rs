//! Changed lengths of rods.

use std::collections::BTreeSet;

use hardpoint::joint::Quantity;
use hardpoint::model::{Change, DesignVariable, HardpointId, Joint, Model, Source, Target};
use hardpoint::space::Vec3;
use toml_edit::{Array, Item, Value};

use crate::values::quoted;

use super::edit::Edit;
use super::text::Step::{At, Key};
use super::text::{ROUND_OFF, add, table_at, value_at};

const AXES: [&str; 3] = ["x", "y", "z"];

impl Edit<'_> {
    /// Changes given lengths of rods.
    pub(super) fn given_lengths(&mut self) {
        let model = &self.file.model;
        for (j, joint) in model.joints.iter().enumerate() {
            let rate = |c: &Change| c.length_of().filter(|(changed, _)| changed.0 == j).map(|(_, rate)| rate);
            let by = self.of(|c| rate(c).is_some());
            let (Some(old), false) = (joint.length, by.is_empty()) else { continue };
            let grows: f64 = self.changes().filter_map(|(_, c, value)| Some(rate(c)? * value)).sum();
            let way = [Key("joints"), Key(&joint.name), Key("length")];
            if !self.write(&way, Quantity::Length, old, old + grows)
                && !self.is_image(&joint.name)
                && !self.is_elsewhere(&by, &joint.name)
            {
                let why = format!("the `length` of `{}` is given by an expression", joint.name);
                self.refuse(&by, why, "change the parameters that the expression uses");
            }
        }
    }

    /// Writes the lengths of rods that keep them while variables move their ends: they no longer follow from the
    /// hardpoints.
    pub(super) fn fixed_lengths(&mut self) {
        let model = &self.file.model;
        let keeps = |v: &DesignVariable, value: f64| v.fixed_length && value != 0.0;
        let by = model.variables.iter().zip(&self.values).filter(|(v, value)| keeps(v, **value));
        let by: Vec<&str> = by.map(|(v, _)| v.name.as_str()).collect();
        if by.is_empty() {
            return;
        }
        let kept = model.geometry(&self.values).kept;
        let places = model.hardpoint_places(&self.values);
        for (joint, kept) in model.joints.iter().zip(kept) {
            let [i, k] = joint.at.map(|h| places[h.0]);
            let drawn = (k - i).norm();
            // An image has the length of its original.
            if joint.length.is_some()
                || !joint.kind.is_rod()
                || self.is_image(&joint.name)
                || (kept.distance - drawn).abs() <= ROUND_OFF * drawn
            {
                continue;
            }
            let length = match self.followed_length(joint) {
                Ok(Some(expression)) => Value::from(expression),
                Ok(None) => number_value(&self.number(Quantity::Length, kept.distance, kept.distance)),
                Err(end) => {
                    let why = format!(
                        "`{}` keeps its length under some variables that move `{end}`, and follows others",
                        joint.name
                    );
                    self.refuse(
                        &quoted(&by),
                        why,
                        "give the rod a `length`, or leave out one of the variables",
                    );
                    continue;
                }
            };
            let table = table_at(&mut self.document, &[Key("joints"), Key(&joint.name)]);
            let is_written = table.map(|table| add(table, "length", length)).is_some();
            if !is_written && !self.is_elsewhere(&quoted(&by), &joint.name) {
                let why = format!(
                    "`{}` keeps its length, and has no table in the file to write that to",
                    joint.name
                );
                self.refuse(&quoted(&by), why, "write the rod as a joint of its own, with a `length`");
            }
        }
    }

    /// Expression of the length of a rod that keeps it under some variables and follows the hardpoints under others
    /// of the file: the distance of its ends without the former. A coordinate that the latter do not move is a number.
    /// `None` if they move none.
    ///
    /// # Errors
    /// Returns the name of an end that variables of both kinds move in a way that the file cannot express.
    fn followed_length(&mut self, joint: &Joint) -> Result<Option<String>, String> {
        let model = &self.file.model;
        let own = self.file.own_variables();
        let [fixed, followed] = [true, false].map(|fixed| moved_by(model, own, |v| v.fixed_length == fixed));
        let coordinates = |h: HardpointId| [0, 1, 2].map(|axis| Source::Coordinate(h, axis));
        let is_followed = |h: &HardpointId| coordinates(*h).iter().any(|c| followed.contains(c));
        if !joint.at.iter().any(is_followed) {
            return Ok(None);
        }
        let values = model.variables.iter().zip(&self.values);
        let values: Vec<f64> = values.map(|(v, value)| if v.fixed_length { 0.0 } else { *value }).collect();
        let places = model.hardpoint_places(&values);
        let mut names = Vec::new();
        for h in joint.at {
            let is_both = |c: &Source| fixed.contains(c) && followed.contains(c);
            names.push(match coordinates(h).iter().any(is_both) {
                true => self.add_unmoved_end(joint, h, places[h.0])?,
                false => model.hardpoints[h.0].name.clone(),
            });
        }
        let side = |end: usize, axis: usize| {
            let is_followed = followed.contains(&Source::Coordinate(joint.at[end], axis));
            is_followed.then(|| format!("{}.{}", names[end], AXES[axis]))
        };
        let number = |x: f64| self.number(Quantity::Length, x, x);
        // (P_j - P_i)^2 along an axis
        let term = |axis: usize| {
            let [p, q] = joint.at.map(|h| places[h.0][axis]);
            Some(match [side(0, axis), side(1, axis)] {
                [None, None] if p == q => return None,
                [None, None] => format!("{}^2", number((q - p).abs())),
                [Some(i), None] => format!("({} - {i})^2", number(q)),
                [None, Some(j)] if p == 0.0 => format!("{j}^2"),
                [None, Some(j)] if p < 0.0 => format!("({j} + {})^2", number(-p)),
                [None, Some(j)] => format!("({j} - {})^2", number(p)),
                [Some(i), Some(j)] => format!("({j} - {i})^2"),
            })
        };
        let terms: Vec<String> = (0..3).filter_map(term).collect();
        Ok(Some(format!("sqrt({})", terms.join(" + "))))
    }

    /// Adds a hardpoint that is where an end of a rod is without the variables under which the rod keeps its length,
    /// and that all others move with the end. Returns its name.
    ///
    /// # Errors
    /// Returns the name of the end if the file does not move it by its name alone.
    fn add_unmoved_end(&mut self, joint: &Joint, end: HardpointId, place: Vec3) -> Result<String, String> {
        let model = &self.file.model;
        let of = &model.hardpoints[end.0].name;
        let name = format!("{of}_of_{}", joint.name);
        let hardpoints = table_at(&mut self.document, &[Key("hardpoints")]).ok_or(of)?;
        let written = hardpoints.get(of).and_then(Item::as_value).cloned();
        let is_plain = |value: &Value| {
            value.as_array().is_some_and(|list| list.iter().all(|x| x.is_integer() || x.is_float()))
        };
        let written = written.filter(|value| is_plain(value) && !hardpoints.contains_key(&name)).ok_or(of)?;
        add(hardpoints, &name, written.decorated(" ", ""));
        for axis in 0..3 {
            self.write(
                &[Key("hardpoints"), Key(&name), At(axis)],
                Quantity::Length,
                place[axis],
                place[axis],
            );
        }
        let moves = |v: &DesignVariable| {
            v.changes.iter().any(|c| c.hardpoint().is_some_and(|(moved, _)| moved == end))
        };
        for variable in self.file.own_variables().iter().filter(|v| !v.fixed_length && moves(v)) {
            let entry = self.entry_of(&variable.name).ok_or(of)?;
            let is_listed = ["move", "mirrored"].into_iter().any(|key| {
                let list = value_at(&mut self.document, &[Key("design"), Key(&entry), Key(key)]);
                list.is_some_and(|list| list_with(list, of, &name))
            });
            if !is_listed {
                return Err(of.clone());
            }
        }
        Ok(name)
    }
}

/// Adds a name to a list of names, or to a single name, with this one. Returns false if this one is not there.
fn list_with(names: &mut Value, of: &str, name: &str) -> bool {
    let has = |list: &Array, name: &str| list.iter().any(|x| x.as_str() == Some(name));
    if names.as_str() == Some(of) {
        let decor = names.decor().clone();
        *names = Value::from_iter([of, name]);
        *names.decor_mut() = decor;
        return true;
    }
    let Some(list) = names.as_array_mut().filter(|list| has(list, of)) else { return false };
    // Several variables may be of one entry.
    if !has(list, name) {
        list.push(name);
    }
    true
}

/// A number as a value.
fn number_value(text: &str) -> Value {
    text.parse().expect("a number is TOML")
}

/// Parameters and coordinates that some variables change, directly or through formulas.
fn moved_by(
    model: &Model,
    variables: &[DesignVariable],
    is_meant: impl Fn(&DesignVariable) -> bool,
) -> BTreeSet<Source> {
    let mut moved = BTreeSet::new();
    for change in variables.iter().filter(|v| is_meant(v)).flat_map(|v| &v.changes) {
        if let Some((hardpoint, velocity)) = change.hardpoint() {
            let axes = (0..3).filter(|axis| velocity[*axis] != 0.0);
            moved.extend(axes.map(|axis| Source::Coordinate(hardpoint, axis)));
        }
        moved.extend(change.parameter().map(|(parameter, _)| Source::Parameter(parameter)));
    }
    // A formula comes after those that it uses.
    for formula in &model.formulas {
        if formula.sources().any(|source| moved.contains(&source)) {
            match formula.of {
                Target::Parameter(p) => drop(moved.insert(Source::Parameter(p))),
                Target::Coordinate(h, axis) => drop(moved.insert(Source::Coordinate(h, axis))),
                Target::Length(_) | Target::Law(..) | Target::Number(_) => {}
            }
        }
    }
    moved
}
