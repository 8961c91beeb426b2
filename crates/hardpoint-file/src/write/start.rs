//! A model file in another assembly, or with its drivers in the opposite sense.

use hardpoint::joint::Quantity;
use hardpoint::model::{Driver, GROUND, StartPlacement};
use hardpoint::space::Vec3;

use crate::read::{ModelFile, parsed};
use crate::values::{Diagnostics, Folder, Severity};

use super::merge::{Contents, merged};

/// Digits of written placements: the assembly closes the rest.
const DIGITS: usize = 9;
/// Components below this part of their vector are round-off of those digits.
const ROUND_OFF: f64 = 1e-10;

impl ModelFile {
    /// This file with other placements at which the assembly starts, and with all drivers in the opposite sense if
    /// `reversed`: the same text with the table `start` and the keys `reversed`, read again.
    ///
    /// # Errors
    /// The reasons why the text cannot be changed so.
    ///
    /// ```
    /// use hardpoint::{model::{BodyId, StartPlacement}, space::Vec3};
    /// let text = r#"
    /// name = "pendulum"
    /// units = { length = "mm", angle = "deg" }
    /// hardpoints = { pivot = [0, 0, 500] }
    /// bodies = { arm = {} }
    /// joints.hinge = { type = "revolute", bodies = ["ground", "arm"], at = "pivot", axis = "y" }
    /// time = { end = 1.0, steps = 100 }
    ///
    /// [drivers.swing]
    /// joint = "hinge"
    /// law = "30*sin(2*pi*t)"
    /// "#;
    /// let file = hardpoint_file::parse(text, "pendulum.toml").unwrap();
    /// let turned = StartPlacement::new(BodyId(1), Vec3::ZERO, Vec3::new(0.0, 0.001, 0.0));
    /// let back = file.in_assembly(&[turned], true).unwrap();
    /// assert!(back.text().ends_with("reversed = true\n\n[start.arm]\nshift = [0.0, 1.0, 0.0]\n"));
    /// assert!(back.model.drivers[0].is_reversed);
    /// ```
    pub fn in_assembly(&self, start: &[StartPlacement], reversed: bool) -> Result<Self, Diagnostics> {
        let name = |placement: &StartPlacement| self.model.bodies[placement.body.0].name.clone();
        let vector = |v: Vec3, quantity: Quantity| {
            let least = ROUND_OFF * v.norm();
            let number =
                |x: f64| if x.abs() <= least { 0.0 } else { rounded(self.units.from_si(quantity, x)) };
            let list = v.to_array().map(|x| Contents::Number(number(x)));
            (v != Vec3::ZERO).then(|| Contents::List(list.to_vec()))
        };
        let mut entries: Vec<(String, Contents)> = Vec::new();
        for old in self.model.start.iter().filter(|old| start.iter().all(|new| new.body != old.body)) {
            entries.push((name(old), Contents::None));
        }
        for placement in start.iter().filter(|placement| placement.body != GROUND) {
            let fields = [
                ("turn", vector(placement.turn(), Quantity::Angle)),
                ("shift", vector(placement.shift(), Quantity::Length)),
            ];
            let fields = fields.map(|(key, value)| (key.to_owned(), value.unwrap_or(Contents::None)));
            entries.push((name(placement), Contents::Table(fields.to_vec())));
        }
        let mut changes = Vec::new();
        if reversed {
            let sense = |driver: &Driver| {
                let flag = if driver.is_reversed { Contents::None } else { Contents::Flag(true) };
                (driver.name.clone(), Contents::Table(vec![("reversed".to_owned(), flag)]))
            };
            changes.push((
                "drivers".to_owned(),
                Contents::Table(self.model.drivers.iter().map(sense).collect()),
            ));
        }
        if !entries.is_empty() {
            changes.push(("start".to_owned(), Contents::Table(entries)));
        }
        let text = merged(self.text(), &Contents::Table(changes));
        let text = text.map_err(|why| self.cannot_be_assembled(why))?;
        let mut file = parsed(Folder::Given(&self.texts), &text, self.file_name())?;
        let is_wrong = |old: &Driver, new: &Driver| (old.is_reversed != reversed) != new.is_reversed;
        let mut drivers = self.model.drivers.iter().zip(&file.model.drivers);
        if let Some((_, driver)) = drivers.find(|(old, new)| is_wrong(old, new)) {
            let why = format!("driver `{}` cannot get another sense in this file", driver.name);
            return Err(self.cannot_be_assembled(why));
        }
        if let Some(case) = self.case.as_deref().and_then(|name| file.model.case(name)) {
            file = file.in_case(case);
        } else if let [only] = &self.model.cases[..]
            && file.model.cases.len() > 1
            && let Some(case) = file.model.case(&only.name)
        {
            file.model = file.model.with_case_only(case);
        }
        Ok(file)
    }

    fn cannot_be_assembled(&self, why: String) -> Diagnostics {
        let message = "another assembly or sense cannot be written into this file";
        let diagnostic = self.diagnostic(Severity::Error, "HP0505", message, None).note(why);
        let diagnostic = diagnostic.help("write `[start.BODY]` and `reversed` of the drivers by hand");
        Diagnostics::new(self.source.clone(), vec![diagnostic])
    }
}

/// Number with few digits.
fn rounded(x: f64) -> f64 {
    format!("{x:.DIGITS$e}").parse().unwrap_or(x)
}
