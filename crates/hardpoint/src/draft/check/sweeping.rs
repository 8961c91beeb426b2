//! Checks of the sweep: variables, ranges and lists of designs.

use std::collections::BTreeMap;

use crate::draft::{DesignListDraft, Section, SweepRangeDraft, SweepSettingsDraft};
use crate::joint::Quantity;
use crate::model::{Dimension, SweepMethod, SweepRange, SweepSettings, VariableId};

use super::optimization::per_si;
use super::{Checker, Here};

const HERE: Here = Here { section: Section::Sweep, index: 0 };

impl Checker<'_> {
    pub(super) fn add_sweeping(&mut self) {
        let draft = self.draft;
        let Some(s) = &draft.sweeping else { return };
        let metrics = match &s.metrics {
            None => (0..self.model.metrics.len()).collect(),
            Some(names) => {
                let found =
                    names.iter().enumerate().map(|(k, name)| self.metric(name, HERE.item("metrics", k)));
                found.collect::<Vec<_>>().into_iter().flatten().collect()
            }
        };
        let curves = s.curves.iter().enumerate();
        let curves =
            curves.filter_map(|(k, name)| self.measure_index(name, HERE.item("curves", k))).collect();
        let mut sweeping = SweepSettings {
            metrics,
            curves,
            samples: s.samples,
            seed: s.seed,
            ..SweepSettings::of_bounds(&self.model)
        };
        if self.unread(HERE, "designs") {
            return;
        }
        if let Some(list) = &s.designs {
            let Some((ranges, listed)) = self.design_list(list) else { return };
            self.model.sweeping =
                Some(SweepSettings { method: SweepMethod::Listed, ranges, listed, ..sweeping });
            return;
        }
        sweeping.method = s.method.unwrap_or(SweepMethod::Sobol);
        if let Some(ranges) = &s.ranges {
            sweeping.ranges = self.ranges(s, ranges);
        } else {
            sweeping.ranges.iter_mut().for_each(|r| r.levels = s.levels);
            self.check_levels(s.levels, HERE);
        }
        let unknown = !draft.unread.is_empty() || !self.faults.is_empty();
        if sweeping.ranges.is_empty() && !unknown {
            self.fault("HP0246", HERE.key(""), "invalid sweep: no design variable has a range").help(
                "name the variables to change, like `NAME = { from = -5, to = 5 }` in `[sweep.variables]`, or give them `bounds`",
            );
        }
        if sweeping.count().is_none() && !unknown {
            let message = format!("the sweep has more than {} designs", SweepSettings::MOST);
            self.fault("HP0246", HERE.key("method"), message)
                .note("the number of designs is the product of the `levels` of all variables")
                .help("use fewer `levels`, or use `method = \"sobol\"` with a smaller number of `samples`");
        }
        self.model.sweeping = Some(sweeping);
    }

    /// Resolves the ranges of the variables. HP0246 unless each is in ascending order.
    fn ranges(&mut self, s: &SweepSettingsDraft, ranges: &[SweepRangeDraft]) -> Vec<SweepRange> {
        let draft = self.draft;
        let mut found = Vec::new();
        for (index, one) in ranges.iter().enumerate() {
            let here = Here { section: Section::SweepRanges, index };
            if self.unread(here, "") {
                continue;
            }
            let name = &one.name;
            let Some(k) = self.variable_index(name, here.key("name")) else { continue };
            let levels = one.levels.unwrap_or(s.levels);
            self.check_levels(levels, if one.levels.is_some() { here } else { HERE });
            let Some(quantity) = self.model.variables.get(k).map(|v| v.quantity) else { continue };
            let variable = VariableId(k);
            let in_si = |x: f64| self.in_si(variable, quantity, x, [one.per_metre, one.per_radian]);
            let [from, to] = [one.low, one.high].map(|x| x.map(in_si));
            let bounds = draft.design[k].bounds;
            let [low, high] = [from.or(bounds.map(|b| b[0])), to.or(bounds.map(|b| b[1]))];
            let (Some(low), Some(high)) = (low, high) else {
                if !draft.unread.any(Section::Design, k) {
                    let missing = if low.is_none() { "from" } else { "to" };
                    let message = format!("the range of `{name}` has no `{missing}`");
                    self.fault("HP0246", here.key("name"), message)
                        .help("write `{ from = -5, to = 5 }`, or give the variable `bounds`");
                }
                continue;
            };
            if !(low < high && low.is_finite() && high.is_finite()) {
                let message = format!("the range of `{name}` is not in ascending order");
                let key = if one.low.is_some() { "from" } else { "to" };
                self.fault("HP0246", here.key(key), message)
                    .note("`from` is the lower end and `to` the upper end; the bounds of the variable are their defaults")
                    .help("give the lower end as `from`; remove variables that are constant");
                continue;
            }
            found.push(SweepRange { variable, low, high, levels });
        }
        found
    }

    fn check_levels(&mut self, levels: usize, here: Here) {
        if levels < 2 {
            self.fault(
                "HP0246",
                here.key("levels"),
                format!("a factorial sweep needs at least 2 levels, not {levels}"),
            )
            .help(
                "give a whole number from 2: levels are evenly spaced from one end of the range to the other",
            );
        }
    }

    /// Resolves a list of designs. HP0247 unless each column is a different design variable.
    fn design_list(&mut self, list: &DesignListDraft) -> Option<(Vec<SweepRange>, Vec<Vec<f64>>)> {
        let at = HERE.key("designs");
        let mut first_of: BTreeMap<&str, usize> = BTreeMap::new();
        let mut variables = Vec::new();
        for (column, name) in list.names.iter().enumerate() {
            let first = *first_of.entry(name).or_insert(column);
            if first < column {
                let message = format!("`{}`, line 1: `{name}` is the title of two columns", list.file);
                self.fault("HP0247", at.clone(), message)
                    .note(format!("columns {} and {}", first + 1, column + 1))
                    .help("remove one of the two");
                return None;
            }
            let faults = self.faults.len();
            let found = self.variable_index(name, at.clone());
            if let Some(fault) = self.faults.get_mut(faults) {
                fault.note(format!("it is the title of column {} of `{}`", column + 1, list.file));
            }
            variables.push(VariableId(found?));
        }
        let quantities: Option<Vec<Quantity>> =
            variables.iter().map(|v| Some(self.model.variables.get(v.0)?.quantity)).collect();
        let quantities = quantities?;
        let units = [list.per_metre, list.per_radian];
        let in_si = |row: &Vec<f64>| {
            let of = variables.iter().zip(&quantities).zip(row);
            of.map(|((v, q), x)| self.in_si(*v, *q, *x, units)).collect()
        };
        let rows: Vec<Vec<f64>> = list.rows.iter().map(in_si).collect();
        Some((SweepSettings::spanned(&variables, &rows), rows))
    }

    /// Converts a value of a variable from user units to a change in SI; values of a parameter are relative to its
    /// nominal value.
    pub(super) fn in_si(&self, variable: VariableId, quantity: Quantity, x: f64, per: [f64; 2]) -> f64 {
        x / per_si(Dimension::from(quantity), per[0], per[1]) - self.model.nominal_value(variable)
    }

    /// Returns the index of a measure in the model.
    pub(super) fn measure_index(&mut self, name: &str, at: crate::draft::DraftLocation) -> Option<usize> {
        let draft = self.draft;
        self.find("measure", name, at, draft.measures.iter().map(|m| m.name.as_str()))?;
        self.model.measures.iter().position(|m| m.name == name)
    }
}
