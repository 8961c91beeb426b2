//! Checks of the calibration: fitted variables, priors, groups and offsets.

use crate::draft::{
    CalibrationSettingsDraft, OffsetDraft, PriorDraft, PriorGroupDraft, Section, did_you_mean, some_of,
};
use crate::joint::Quantity;
use crate::model::{
    CalibrationSettings, Dimension, Offset, OffsetSource, PriorGroup, VariableId, VariablePrior,
};

use super::optimization::per_si;
use super::{Checker, Here, LISTED_NAMES};

const HERE: Here = Here { section: Section::Calibrate, index: 0 };

impl Checker<'_> {
    pub(super) fn add_calibrating(&mut self) {
        let draft = self.draft;
        let Some(c) = &draft.calibrating else { return };
        let fitted = self.fitted_variables(c);
        let mut priors = Vec::new();
        for (index, one) in c.priors.iter().enumerate() {
            let here = Here { section: Section::Priors, index };
            let found = if self.unread(here, "") { None } else { self.prior(one, &fitted, here) };
            priors.extend(found);
        }
        let mut groups = Vec::new();
        for (index, one) in c.groups.iter().enumerate() {
            let here = Here { section: Section::PriorGroups, index };
            let found = if self.unread(here, "") { None } else { self.prior_group(one, &fitted, here) };
            groups.extend(found);
        }
        let mut offsets: Vec<Offset> = Vec::new();
        for (index, one) in c.offsets.iter().enumerate() {
            let here = Here { section: Section::Offsets, index };
            let Some(found) = (if self.unread(here, "") { None } else { self.offset(one, here) }) else {
                continue;
            };
            if offsets.iter().any(|o| o.of == found.of) {
                self.fault("HP0273", here.key("of"), format!("`{}` has two offsets", one.name))
                    .help("remove one of the two");
                continue;
            }
            offsets.push(found);
        }
        let has_tolerance =
            self.model.tolerancing.is_some() || draft.design.iter().any(|v| v.tolerance.is_some());
        if c.tolerance_priors && !has_tolerance && draft.unread.is_empty() && self.faults.is_empty() {
            self.fault("HP0270", HERE.key("priors"), "no design variable has a tolerance to make a prior of")
                .help("add `tolerance = 0.1` to the variables, or remove `priors` and give `sigma` in `[calibrate.variables]`");
        }
        self.model.calibrating = Some(CalibrationSettings {
            variables: fitted,
            priors,
            tolerance_priors: c.tolerance_priors,
            groups,
            offsets,
        });
    }

    /// Fitted variables: those of the list, or all.
    fn fitted_variables(&mut self, c: &CalibrationSettingsDraft) -> Vec<VariableId> {
        let Some(names) = c.fitted.as_ref().filter(|_| !self.unread(HERE, "fit")) else {
            return (0..self.draft.design.len()).map(VariableId).collect();
        };
        let mut found = Vec::new();
        for (k, name) in names.iter().enumerate() {
            let at = HERE.item("fit", k);
            let Some(v) = self.variable_index(name, at.clone()).map(VariableId) else { continue };
            if found.contains(&v) {
                self.fault("HP0271", at, format!("`{name}` is listed twice in `fit`"))
                    .help("remove one of the two");
                continue;
            }
            found.push(v);
        }
        found
    }

    /// Resolves a prior. HP0270 unless its numbers are possible, HP0271 if its variable is not fitted.
    fn prior(&mut self, one: &PriorDraft, fitted: &[VariableId], here: Here) -> Option<VariablePrior> {
        let name = &one.name;
        let k = self.variable_index(name, here.key("name"))?;
        let variable = VariableId(k);
        if !fitted.contains(&variable) && !self.draft.unread.any_of(Section::Calibrate) {
            self.fault("HP0271", here.key("name"), format!("`{name}` has a prior but is not fitted"))
                .note("`fit` lists the fitted variables; all others keep their nominal values exactly")
                .help(format!("add `{name}` to `fit`, or remove its prior"));
            return None;
        }
        let sigma = self.deviation(one.sigma, &format!("the prior of `{name}`"), "sigma", here)?;
        let quantity = self.model.variables.get(k)?.quantity;
        let per = [one.per_metre, one.per_radian];
        let mean = one.mean.map_or(0.0, |mean| self.in_si(variable, quantity, mean, per));
        if let Some([low, high]) = self.draft.design[k].bounds
            && !(low <= mean && mean <= high)
            && one.mean.is_some()
        {
            self.fault(
                "HP0270",
                here.key("mean"),
                format!("the mean of the prior of `{name}` is outside its bounds"),
            )
            .note("bounds are kept: the fit could not reach the mean")
            .help("change the mean, or the `bounds` of the variable");
            return None;
        }
        let sigma = sigma / per_si(Dimension::from(quantity), one.per_metre, one.per_radian);
        Some(VariablePrior { variable, mean, sigma })
    }

    /// Positive standard deviation. HP0270 (or HP0272 of a group) otherwise.
    fn deviation(&mut self, given: f64, what: &str, key: &'static str, here: Here) -> Option<f64> {
        if given > 0.0 && given.is_finite() {
            return Some(given);
        }
        let code = if here.section == Section::PriorGroups { "HP0272" } else { "HP0270" };
        let help = if here.section == Section::Priors {
            "give a number above zero; to fix the variable, leave it out of `fit`"
        } else {
            "give a number above zero"
        };
        self.fault(code, here.key(key), format!("`{key}` of {what} cannot be {given}"))
            .note(format!("`{key}` is a standard deviation"))
            .help(help);
        None
    }

    /// Resolves a group. HP0272 unless it has several different fitted members of one quantity.
    fn prior_group(
        &mut self,
        one: &PriorGroupDraft,
        fitted: &[VariableId],
        here: Here,
    ) -> Option<PriorGroup> {
        let name = &one.name;
        if one.variables.len() < 2 {
            let count = if one.variables.is_empty() { "no members" } else { "one member only" };
            self.fault("HP0272", here.key("variables"), format!("group `{name}` has {count}"))
                .note("a group relates the deviations of several variables")
                .help("name at least two design variables, or give the single one a `sigma` in `[calibrate.variables]`");
            return None;
        }
        let mut members = Vec::new();
        let mut quantities: Vec<(Quantity, usize)> = Vec::new();
        for (k, of) in one.variables.iter().enumerate() {
            let at = here.item("variables", k);
            let v = self.variable_index(of, at.clone())?;
            if members.contains(&VariableId(v)) {
                self.fault("HP0272", at, format!("`{of}` is listed twice in group `{name}`"))
                    .help("remove one of the two");
                return None;
            }
            if !fitted.contains(&VariableId(v)) && !self.draft.unread.any_of(Section::Calibrate) {
                self.fault("HP0272", at, format!("`{of}` of group `{name}` is not fitted"))
                    .note("`fit` lists the fitted variables; all others keep their nominal values exactly")
                    .help(format!("add `{of}` to `fit`, or remove it from the group"));
                return None;
            }
            members.push(VariableId(v));
            quantities.push((self.model.variables.get(v)?.quantity, k));
        }
        if let Some((_, k)) = quantities.iter().find(|(q, _)| *q != quantities[0].0) {
            let (first, other) = (&one.variables[0], &one.variables[*k]);
            let unit = |q: Quantity| match q {
                Quantity::Length => "a length",
                Quantity::Angle => "an angle",
                Quantity::Number => "a plain number",
            };
            let (a, b) = (unit(quantities[0].0), unit(quantities[*k].0));
            let message = format!("`{first}` and `{other}` of group `{name}` have different units");
            self.fault("HP0272", here.item("variables", *k), message)
                .note(format!("`{first}` is {a}, `{other}` is {b}; the members of a group deviate alike"))
                .help("make a group of each quantity");
            return None;
        }
        let within = self.deviation(one.within, &format!("group `{name}`"), "within", here)?;
        let within = within / per_si(Dimension::from(quantities[0].0), one.per_metre, one.per_radian);
        Some(PriorGroup { name: name.clone(), variables: members, within })
    }

    /// Resolves an offset: of a driver, or of an output with a value at rest. HP0273 otherwise.
    fn offset(&mut self, one: &OffsetDraft, here: Here) -> Option<Offset> {
        let name = &one.name;
        let driver = self.number_of("driver", name).map(|k| self.driver_ids[k]);
        let (of, dimension) = match driver {
            Some(Some(d)) => {
                let quantity = self.model.driven(&self.model.drivers[d.0]).quantity;
                (OffsetSource::Driver(d), Dimension::from(quantity))
            }
            // A faulty driver has been reported.
            Some(None) => return None,
            None => {
                let faults = self.faults.len();
                let found = self.output(name, here.key("of"));
                let drivers: Vec<&str> = self.draft.drivers.iter().map(|d| d.name.as_str()).collect();
                let near = did_you_mean(name, drivers.iter().copied());
                if let Some(fault) = self.faults.get_mut(faults) {
                    if !drivers.is_empty() {
                        let drivers: Vec<String> = drivers.iter().map(|d| format!("`{d}`")).collect();
                        fault.note(format!("drivers: {}", some_of(&drivers, ", ", LISTED_NAMES)));
                    }
                    fault.message = format!("there is no driver, measure or point component named `{name}`");
                    if let Some(near) = near {
                        fault.help(format!("did you mean `{near}`?"));
                    }
                }
                let source = found?;
                if self.model.measures.len() < self.draft.measures.len() {
                    return None;
                }
                if !self.model.is_known_at_rest(source) {
                    self.fault(
                        "HP0273",
                        here.key("of"),
                        format!("`{name}` can have no offset: it has no value at rest"),
                    )
                    .note("measured postures are at rest")
                    .help("name a measure that depends on positions only");
                    return None;
                }
                (OffsetSource::Output(source), self.model.dimension(source))
            }
        };
        let per = per_si(dimension, one.per_metre, one.per_radian);
        let sigma = match one.sigma {
            Some(sigma) => {
                Some(self.deviation(sigma, &format!("the offset of `{name}`"), "sigma", here)? / per)
            }
            None => None,
        };
        Some(Offset { of, sigma })
    }
}
