//! Checks of cases: laws, output times, and motion in each case.

use std::collections::BTreeSet;

use crate::draft::{CaseDraft, DraftLocation, OtherDrivers, Section};
use crate::law::Law;
use crate::model::{Case, CaseId, ElementId};

use super::{Checker, Here, LISTED_NAMES};

impl Checker<'_> {
    pub(super) fn add_cases(&mut self) {
        let draft = self.draft;
        // The own law of a driver is reported once, however many cases use it.
        let mut reported = BTreeSet::new();
        for (index, c) in draft.cases.iter().enumerate() {
            let here = Here { section: Section::Cases, index };
            let times = c.times.as_ref().unwrap_or(&draft.times);
            if let Some(times) = &c.times {
                self.check_output_times(times, here.key("time"));
            }
            let mut laws =
                vec![(c.rest == OtherDrivers::Held).then(|| Law::constant(0.0)); self.model.drivers.len()];
            // The case stores the formulas of its laws.
            let case = CaseId(self.model.cases.len());
            let times_of_case = times.clone();
            let (name, formulas) = (c.name.clone(), Vec::new());
            self.model.cases.push(Case {
                name,
                laws: Vec::new(),
                force_laws: Vec::new(),
                formulas,
                times: times_of_case,
                load_mode: c.load_mode,
            });
            for (k, (driver, law)) in c.laws.iter().enumerate() {
                let forces = draft.forces.iter().map(|f| f.name.as_str());
                let names = draft.drivers.iter().map(|d| d.name.as_str());
                let at = here.item("law", k);
                if self.number_of("driver", driver).is_none() && forces.clone().any(|f| f == driver) {
                    self.add_force_law(case, driver, law, times, here.item("laws", k));
                    continue;
                }
                let names = names.chain(forces);
                let Some(index) = self.find("driver", driver, here.item("laws", k), names) else { continue };
                // A faulty driver has been reported.
                let Some(d) = self.driver_ids[index] else { continue };
                let given = self.formula_law_in((case, &c.name), (d, driver), law, &at);
                let Some(law) = given else { continue };
                let unit = draft.drivers[index].unit;
                let of = format!("driver `{driver}` in case `{}`", c.name);
                self.check_law(&of, (&law, unit), times, at);
                laws[d.0] = Some(law);
            }
            for d in (0..laws.len()).filter(|d| laws[*d].is_none()) {
                let (name, law) = (self.model.drivers[d].name.clone(), self.model.drivers[d].law.clone());
                let index = self.number_of("driver", &name).unwrap_or(d);
                let faults = self.faults.len();
                if !reported.contains(&d) {
                    let at = Here { section: Section::Drivers, index }.key("law");
                    let unit = draft.drivers.get(index).map_or("", |driver| driver.unit);
                    self.check_law(&format!("driver `{name}`"), (&law, unit), times, at);
                }
                if self.faults.len() > faults {
                    reported.insert(d);
                }
            }
            self.check_motion(c, &laws, times, here);
            self.model.cases[case.0].laws = laws;
        }
    }

    /// Law of a force in a case. HP0262: a force that no law multiplies.
    fn add_force_law(&mut self, case: CaseId, name: &str, law: &Law, times: &[f64], at: DraftLocation) {
        let found = self.model.elements.iter().position(|e| e.name == name);
        // A faulty force has been reported.
        let Some(e) = found else { return };
        let case_name = self.model.cases[case.0].name.clone();
        if self.model.elements[e].kind.law_mut().is_none() {
            let message = format!("`{name}` has no law that case `{case_name}` could replace");
            self.fault("HP0262", at, message)
                .help("name a driver, or a force of type `force`, `wheel_force`, `moment` or `tyre`");
            return;
        }
        if self.case_formulas.contains_key(&(case_name.as_str(), name)) {
            let message =
                format!("a formula defines a parameter of the law of `{name}` in case `{case_name}`");
            self.fault("HP0262", at, message)
                .note("the law of a force is the same in every design")
                .help("let what the law multiplies depend on the parameter");
            return;
        }
        if let Some(t) = times.iter().find(|t| !law.at(**t).value().is_finite()) {
            let message =
                format!("the law of `{name}` in case `{case_name}` has no finite value at t = {t} s");
            self.fault("HP0214", at, message).help("change the law, or the output times");
            return;
        }
        self.model.cases[case.0].force_laws.push((ElementId(e), law.clone()));
    }

    /// HP0235: a case with several output times in which nothing moves: no driver, and no force of an equilibrium.
    fn check_motion(&mut self, c: &CaseDraft, laws: &[Option<Law>], times: &[f64], here: Here) {
        let draft = self.draft;
        let [first, .., _] = times else { return };
        let is_constant = |law: &Law| {
            let start = law.at(*first).value();
            times.iter().all(|t| law.at(*t).value() == start)
        };
        let faulty = self.model.drivers.len() < draft.drivers.len()
            || self.is_table_unread("driver")
            || self.unread(here, "laws")
            || c.laws.iter().any(|(name, _)| self.number_of("driver", name).is_none())
            || self.draft.equilibrium.is_some()
                && (self
                    .model
                    .elements
                    .iter()
                    .any(|e| e.kind.law(&self.model).is_some_and(|law| !is_constant(law)))
                    || self
                        .model
                        .cases
                        .iter()
                        .any(|case| case.force_laws.iter().any(|(_, law)| !is_constant(law))))
            || (0..draft.drivers.len())
                .any(|index| self.unread(Here { section: Section::Drivers, index }, "law"));
        let laws = laws.iter().zip(&self.model.drivers);
        if faulty || !laws.map(|(law, driver)| law.as_ref().unwrap_or(&driver.law)).all(is_constant) {
            return;
        }
        let message = format!("case `{}` has no motion", c.name);
        let named: BTreeSet<&str> = c.laws.iter().map(|law| law.0.as_str()).collect();
        let fixed: Vec<String> = draft
            .drivers
            .iter()
            .filter(|d| !named.contains(d.name.as_str()))
            .take(LISTED_NAMES)
            .map(|d| format!("`{}`", d.name))
            .collect();
        let fault = self.fault("HP0235", here.key("name"), message);
        if !fixed.is_empty() && c.rest == OtherDrivers::Held {
            let [are, them] = if fixed.len() == 1 { ["is", "it"] } else { ["are", "them"] };
            fault.note(format!(
                "{} {are} fixed in the design configuration, because the case has no law for {them}",
                fixed.join(", ")
            ));
        }
        let example = draft.drivers.first().map_or("DRIVER", |d| d.name.as_str());
        fault.help(format!(
            "give a driver a law in this case, like `laws = {{ {example} = \"10*t\" }}`, or write `other_drivers = \"as_in_model\"` to use the laws of `[drivers]`"
        ));
    }
}
