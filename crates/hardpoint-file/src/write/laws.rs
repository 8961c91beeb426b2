//! Changed parameters of drivers' laws.

use hardpoint::joint::Quantity;
use hardpoint::law::{Parameter, ParameterKind};
use toml_edit::Item;

use crate::read::LAW_TABLE;

use super::edit::Edit;
use super::text::Step::{self, At, Key};
use super::text::{add, table_at};

impl Edit<'_> {
    /// Changes parameters of laws.
    pub(super) fn laws(&mut self) {
        let model = &self.file.model;
        let laws = model.laws(&self.values);
        let mut changed: Vec<(usize, usize)> = self
            .changes()
            .filter_map(|(_, change, _)| change.law().map(|(driver, parameter, _)| (driver.0, parameter)))
            .collect();
        changed.sort_unstable();
        changed.dedup();
        for (d, p) in changed {
            let driver = &model.drivers[d];
            let [old, new] = [&driver.law, &laws[d]].map(|law| law.parameters().swap_remove(p));
            let quantity = match old.kind {
                ParameterKind::Value | ParameterKind::ValueRate(_) => model.driven(driver).quantity,
                ParameterKind::Angle => Quantity::Angle,
                ParameterKind::Number | ParameterKind::Time | ParameterKind::Frequency => Quantity::Number,
            };
            let by =
                self.of(|c| c.law().is_some_and(|(driver, parameter, _)| [driver.0, parameter] == [d, p]));
            if !self.law_number(&driver.name, quantity, &old, new.value)
                && !self.is_image(&driver.name)
                && !self.is_elsewhere(&by, &driver.name)
            {
                let why = format!(
                    "the law of driver `{}` has no number `{}` of its own in the file",
                    driver.name, old.name
                );
                self.refuse(&by, why, "write the law as a table that names this number");
            }
        }
    }

    /// Writes a parameter of a law; returns false if the law has no place for it.
    fn law_number(&mut self, driver: &str, quantity: Quantity, old: &Parameter, new: f64) -> bool {
        let mut law = vec![Key("drivers"), Key(driver), Key("law")];
        let mut name = old.name.as_str();
        // Pieces of sequences may be sequences: `piece[0].piece[1].speed`.
        while let Some((k, inner)) = name.strip_prefix("piece[").and_then(|rest| rest.split_once("].")) {
            let Ok(k) = k.parse() else { return false };
            law.extend([Key("pieces"), At(k)]);
            if inner != "duration" {
                law.push(Key("law"));
            }
            name = inner;
        }
        let places = places_in_law(name);
        let written =
            places.iter().any(|place| self.write(&[&law, &place[..]].concat(), quantity, old.value, new));
        if written && name == "f[0]" {
            self.close_period(&law, quantity, old.value, new);
        }
        written || self.add_to_law(&law, name, quantity, old.value, new)
    }

    /// Writes the last point of a periodic table, which is its first again.
    fn close_period(&mut self, law: &[Step<'_>], quantity: Quantity, old: f64, new: f64) {
        let Some(table) = table_at(&mut self.document, law) else { return };
        let is_periodic = table.get("ends").and_then(Item::as_str) == Some("periodic");
        let points = table.get("points").and_then(Item::as_array).map_or(0, toml_edit::Array::len);
        if is_periodic && points > 0 {
            self.write(&[law, &[Key("points"), At(points - 1), At(1)]].concat(), quantity, old, new);
        }
    }

    /// Adds a parameter that the law does not give, because it has a default.
    fn add_to_law(&mut self, law: &[Step<'_>], name: &str, quantity: Quantity, old: f64, new: f64) -> bool {
        let text = self.number(quantity, old, new);
        let Some(table) = table_at(&mut self.document, law) else { return false };
        let kind = table.get("type").and_then(Item::as_str).unwrap_or_default();
        let kinds = (LAW_TABLE.tables)();
        let mut keys = kinds.iter().filter(|of| of.name == kind).flat_map(|of| of.keys());
        if table.contains_key(name) || !keys.any(|key| key.key == name) {
            return false;
        }
        text.parse().is_ok_and(|value| {
            add(table, name, value);
            true
        })
    }
}

/// Places below a law where a parameter of this name may stand, by type of law.
fn places_in_law(name: &str) -> Vec<Vec<Step<'_>>> {
    let mut places = vec![vec![Key(name)], vec![Key("parameters"), Key(name)]];
    // c1 of a polynomial is an entry of its `coefficients`
    if let Some(k) = name.strip_prefix('c').and_then(|k| k.parse().ok()) {
        places.push(vec![Key("coefficients"), At(k)]);
    }
    // f[1] of a table is the second number of one of its `points`
    if let Some(k) = name.strip_prefix("f[").and_then(|k| k.strip_suffix(']')?.parse().ok()) {
        places.push(vec![Key("points"), At(k), At(1)]);
    }
    places
}
