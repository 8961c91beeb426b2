//! Checks of the tolerance study: tolerances, correlations, limits and allocation.

use std::collections::BTreeMap;

use crate::draft::{
    ChangeDraft, CorrelationDraft, ScatterDraft, Section, ToleranceDraft, ToleranceSettingsDraft,
};
use crate::linalg::semidefinite;
use crate::model::{
    AllocationRule, AllocationSettings, Correlation, Dimension, JointId, Scatter, Tolerance,
    ToleranceSettings, VariableId,
};

use super::formulas::AXES;
use super::optimization::per_si;
use super::{Checker, Here};

/// Uniform distribution, in [`Scatter::NAMES`].
const UNIFORM: usize = 0;
const HERE: Here = Here { section: Section::Tolerance, index: 0 };

/// Play of a joint, whose coordinates have one tolerance: the pin is anywhere in its hole.
#[derive(Clone, Copy, PartialEq)]
struct Play<'d> {
    /// Name of its entry in `[design]`.
    entry: &'d str,
    /// The joint, if it is of one alone.
    joint: Option<JointId>,
}

impl<'d> Checker<'d> {
    pub(super) fn add_tolerancing(&mut self) {
        let draft = self.draft;
        // The coordinates of a play have one tolerance.
        let is_loose = |k: usize| draft.design[k].tolerance.is_some() && self.play(k).is_some();
        let implied = (0..draft.design.len()).any(is_loose);
        let default = ToleranceSettingsDraft::default();
        let Some(t) = draft.tolerancing.as_ref().or_else(|| implied.then_some(&default)) else { return };
        let default = self.scatter(t.scatter, ScatterDraft::default(), HERE, "the tolerances");
        let tolerances = self.tolerances(t);
        let correlations = self.correlations(t, &tolerances);
        let mut limits = Vec::new();
        for (index, limit) in t.limits.iter().enumerate() {
            let here = Here { section: Section::ToleranceLimits, index };
            if !self.unread(here, "") {
                limits.extend(self.limit(limit, here));
            }
        }
        let metrics = match &t.metrics {
            None => (0..self.model.metrics.len()).collect(),
            Some(names) => {
                let found =
                    names.iter().enumerate().map(|(k, name)| self.metric(name, HERE.item("metrics", k)));
                found.collect::<Vec<_>>().into_iter().flatten().collect()
            }
        };
        let curves = match &t.curves {
            None => (0..self.model.measures.len()).collect(),
            Some(names) => names
                .iter()
                .enumerate()
                .filter_map(|(k, name)| self.measure_index(name, HERE.item("curves", k)))
                .collect(),
        };
        self.check_allocation(t);
        if default.is_none() {
            return;
        }
        let (samples, seed) = (t.samples, t.seed);
        let allocation = t.allocation.map(|rule| AllocationSettings { rule });
        self.model.tolerancing = Some(ToleranceSettings {
            tolerances,
            correlations,
            metrics,
            curves,
            limits,
            samples,
            seed,
            allocation,
        });
    }

    /// Resolves the tolerances. HP0241 unless each is positive and each variable has at most one.
    fn tolerances(&mut self, t: &ToleranceSettingsDraft) -> Vec<Tolerance> {
        let draft = self.draft;
        let mut of: BTreeMap<usize, &str> = BTreeMap::new();
        let mut found = Vec::new();
        for (index, one) in t.tolerances.iter().enumerate() {
            let here = Here { section: Section::Tolerances, index };
            if self.unread(here, "") {
                continue;
            }
            let variables = self.variables_of_tolerance(one, here);
            if let Some((v, other)) = variables.iter().find_map(|v| Some((*v, *of.get(v)?))) {
                let message = format!("design variable `{}` has two tolerances", draft.design[v].name);
                self.fault("HP0241", here.key("name"), message)
                    .note(format!("its tolerances are `{other}` and `{}`", one.name))
                    .help(
                        "remove one of the two: the tolerance of a point is a sphere, those of its coordinates are a box",
                    );
                continue;
            }
            of.extend(variables.iter().map(|v| (*v, one.name.as_str())));
            found.extend(self.tolerance(t, one, variables, here));
        }
        let others: Vec<usize> = (0..draft.design.len()).filter(|k| !of.contains_key(k)).collect();
        for all in others.chunk_by(|a, b| self.play(*a).is_some_and(|play| self.play(*b) == Some(play))) {
            let variable = &draft.design[all[0]];
            let Some(reach) = variable.tolerance.filter(|reach| *reach > 0.0) else { continue };
            let play = self.play(all[0]);
            let own = ScatterDraft { kind: play.map(|_| UNIFORM), ..ScatterDraft::default() };
            let scatter = self.scatter_of(own, t.scatter);
            let variables = all.iter().map(|k| VariableId(*k)).collect();
            let name = play.map_or(variable.name.as_str(), |play| play.entry).to_owned();
            let play = play.and_then(|play| play.joint);
            found.push(Tolerance { name, variables, play, reach, scatter, cost: None });
        }
        let unknown = !draft.unread.is_empty() || !self.faults.is_empty();
        if found.is_empty() && !unknown {
            self.fault("HP0241", HERE.key(""), "invalid tolerance study: no design variable has a tolerance").help(
                "add tolerances, as `tolerance = 0.1` in `[design.NAME]` or as `NAME = 0.1` in `[tolerance.variables]`",
            );
        }
        found
    }

    /// Play that a variable with this index is a coordinate of, if it is one.
    fn play(&self, variable: usize) -> Option<Play<'d>> {
        let variable = &self.draft.design[variable];
        let Some(ChangeDraft::Play { joint, .. }) = variable.changes.first() else { return None };
        let (entry, _) = variable.name.rsplit_once('_')?;
        // A variable that changes both sides alike is of two joints.
        let joint = self.number_of("joint", joint).filter(|_| variable.changes.len() == 1);
        Some(Play { entry, joint: joint.and_then(|k| self.joint_ids[k]) })
    }

    /// Returns the variables of a tolerance: the one with its name, or the coordinates of the entry with its name.
    fn variables_of_tolerance(&mut self, one: &ToleranceDraft, here: Here) -> Vec<usize> {
        if let Some(known) = self.number_of("design variable", &one.name) {
            return vec![known];
        }
        let parts =
            AXES.iter().filter_map(|axis| self.number_of("design variable", &format!("{}_{axis}", one.name)));
        let parts: Vec<usize> = parts.collect();
        if parts.is_empty() {
            self.variable_index(&one.name, here.key("name"));
        }
        parts
    }

    fn tolerance(
        &mut self,
        t: &ToleranceSettingsDraft,
        one: &ToleranceDraft,
        variables: Vec<usize>,
        here: Here,
    ) -> Option<Tolerance> {
        let draft = self.draft;
        let first = &draft.design[*variables.first()?];
        let name = &one.name;
        let own = draft.unread.any(Section::Design, variables[0]);
        let quantity = self.model.variables.get(variables[0]).map(|v| v.quantity);
        let play = self.play(variables[0]);
        let scatter = ScatterDraft { kind: one.scatter.kind.or(play.map(|_| UNIFORM)), ..one.scatter };
        let scatter = self.scatter(scatter, t.scatter, here, &format!("the tolerance of `{name}`"));
        if one.cost.is_some_and(|cost| !(cost > 0.0 && cost.is_finite())) {
            let message =
                format!("invalid cost of the tolerance of `{name}`: {}", one.cost.unwrap_or_default());
            self.fault("HP0241", here.key("cost"), message)
                .note("a tolerance t costs `cost / t`, relative to the others")
                .help("give a positive number, or remove `cost` for a fixed tolerance");
        }
        let units_per_si = quantity.map(|q| per_si(Dimension::from(q), one.per_metre, one.per_radian));
        let reach = match one.reach {
            Some(reach) if !(reach > 0.0 && reach.is_finite()) => {
                let message = format!("invalid tolerance of `{name}`: {reach}");
                self.fault("HP0241", here.key("tolerance"), message)
                    .note("a tolerance is the half width of the deviations")
                    .help("give a positive number, or remove the variable if it is exact");
                return None;
            }
            Some(reach) => reach / units_per_si?,
            None => {
                let Some(reach) = first.tolerance else {
                    if !own {
                        let message = format!("the tolerance of `{name}` has no value");
                        self.fault("HP0241", here.key("name"), message).help(
                            "add `tolerance = 0.1` to it, or to the variable in `[design]` or `[parameters]`",
                        );
                    }
                    return None;
                };
                reach
            }
        };
        let play = play.and_then(|play| play.joint);
        let variables = variables.into_iter().map(VariableId).collect();
        // `cost / reach` is a number in the variables' unit, so that the cost has this unit as well.
        let cost = one.cost.zip(units_per_si).map(|(cost, units)| cost / units);
        Some(Tolerance { name: name.clone(), variables, play, reach, scatter: scatter?, cost })
    }

    /// Distribution of a tolerance, with the defaults of the study. HP0241 if it is invalid.
    fn scatter(&mut self, own: ScatterDraft, all: ScatterDraft, here: Here, what: &str) -> Option<Scatter> {
        if let Some(sigmas) = own.sigmas {
            let even = own.kind.or(all.kind) == Some(UNIFORM) && here.section == Section::Tolerances;
            if even {
                let message = format!("{what} is uniform, which takes no `sigmas`");
                self.fault("HP0241", here.key("sigmas"), message)
                    .help("remove `sigmas`, or write `distribution = \"truncated\"`");
                return None;
            }
            if !(sigmas > 0.0 && sigmas <= MOST_SIGMAS) {
                let message = format!("invalid `sigmas` of {what}: {sigmas}");
                self.fault("HP0241", here.key("sigmas"), message)
                    .note("`sigmas` is the number of standard deviations in a tolerance")
                    .help(format!("give a positive number up to {MOST_SIGMAS}, like `sigmas = 3`"));
                return None;
            }
        }
        Some(self.scatter_of(own, all))
    }

    fn scatter_of(&self, own: ScatterDraft, all: ScatterDraft) -> Scatter {
        let sigmas = own.sigmas.or(all.sigmas).unwrap_or(ToleranceSettings::SIGMAS);
        match own.kind.or(all.kind) {
            Some(UNIFORM) => Scatter::Uniform,
            Some(2) => Scatter::Truncated { sigmas },
            _ => Scatter::Normal { sigmas },
        }
    }

    /// Resolves the correlations. HP0242 unless they relate normal variables, one for each pair, without contradiction.
    fn correlations(&mut self, t: &ToleranceSettingsDraft, tolerances: &[Tolerance]) -> Vec<Correlation> {
        let mut pairs: BTreeMap<[usize; 2], &str> = BTreeMap::new();
        let mut found = Vec::new();
        if t.correlations.len() > MOST_CORRELATIONS {
            let message = format!("too many correlations: {}", t.correlations.len());
            self.fault("HP0242", HERE.key("correlations"), message).help(format!(
                "give at most {MOST_CORRELATIONS}, or use one design variable that moves all correlated dimensions"
            ));
            return found;
        }
        for (index, one) in t.correlations.iter().enumerate() {
            let here = Here { section: Section::Correlations, index };
            if self.unread(here, "") {
                continue;
            }
            let between = [0, 1].map(|k| self.variable_index(&one.between[k], here.item("between", k)));
            let [Some(a), Some(b)] = between else { continue };
            if !(one.coefficient.abs() <= 1.0) {
                let message =
                    format!("invalid coefficient of correlation `{}`: {}", one.name, one.coefficient);
                self.fault("HP0242", here.key("coefficient"), message)
                    .help("give a number from -1 to 1: 1 if both deviations are always equal, 0 if they are independent");
                continue;
            }
            let name = &one.name;
            if a == b {
                let message = format!("correlation `{name}` relates `{}` to itself", one.between[0]);
                self.fault("HP0242", here.key("between"), message)
                    .help("name two different design variables");
                continue;
            }
            if let Some(other) = pairs.insert([a.min(b), a.max(b)], name) {
                let message = format!("correlations `{other}` and `{name}` relate the same two variables");
                self.fault("HP0242", here.key("between"), message).help("remove one of the two");
                continue;
            }
            if self.faults.is_empty() && self.can_correlate(one, [a, b], tolerances, here) {
                let between = [VariableId(a), VariableId(b)];
                found.push(Correlation { name: name.clone(), between, coefficient: one.coefficient });
            }
        }
        if !found.is_empty() && semidefinite::root(&matrix(&found)).is_none() {
            let names: Vec<String> = found.iter().map(|c| format!("`{}`", c.name)).collect();
            let message = "the correlations contradict each other";
            self.fault("HP0242", HERE.key("correlations"), message)
                .note(format!("their matrix is not positive semidefinite: {}", super::super::some_of(&names, ", ", super::LISTED_NAMES)))
                .help("reduce one of them, or correlate the third pair too: if a is correlated with b and b with c, a is correlated with c by at least `r_ab r_bc - sqrt((1 - r_ab^2) (1 - r_bc^2))`");
        }
        found
    }

    /// True if both variables have a normal tolerance.
    fn can_correlate(
        &mut self,
        one: &CorrelationDraft,
        of: [usize; 2],
        tolerances: &[Tolerance],
        here: Here,
    ) -> bool {
        for (k, v) in of.into_iter().enumerate() {
            let name = &one.between[k];
            let tolerance = tolerances.iter().find(|t| t.variables.contains(&VariableId(v)));
            let at = here.item("between", k);
            let Some(tolerance) = tolerance else {
                // The tolerance may be an unread entry.
                if self.draft.unread.any_of(Section::Tolerances) || self.draft.unread.any_of(Section::Design)
                {
                    return false;
                }
                let message = format!("`{name}` of correlation `{}` has no tolerance", one.name);
                self.fault("HP0242", at, message).help("give it one in `[tolerance.variables]`");
                return false;
            };
            if !matches!(tolerance.scatter, Scatter::Normal { .. }) {
                let message =
                    format!("`{name}` of correlation `{}` is {}", one.name, tolerance.scatter.name());
                self.fault("HP0242", at, message)
                    .note("only normal distributions can be correlated")
                    .help("give it `distribution = \"normal\"`, or move both by one design variable");
                return false;
            }
        }
        true
    }

    /// HP0243: an allocation without a limit or a cost, or with invalid `required_sigmas`.
    fn check_allocation(&mut self, t: &ToleranceSettingsDraft) {
        let Some(rule) = t.allocation else { return };
        if let AllocationRule::Rss { sigmas } = rule
            && !(sigmas > 0.0 && sigmas <= MOST_SIGMAS)
        {
            let message = format!("invalid `required_sigmas`: {sigmas}");
            self.fault("HP0243", HERE.key("required_sigmas"), message)
                .note("`required_sigmas` is the number of standard deviations between the nominal value of a metric and its limit")
                .help(format!("give a positive number up to {MOST_SIGMAS}, like `required_sigmas = 3`"));
        }
        if t.limits.is_empty() && !self.unread(HERE, "limits") {
            self.fault("HP0243", HERE.key("allocate"), "invalid allocation: there is no limit").help(
                "add a limit, like `[tolerance.limits]` with `toe = { metric = \"toe_range\", max = 0.5 }`",
            );
        }
        if t.tolerances.iter().all(|one| one.cost.is_none()) && !self.draft.unread.any_of(Section::Tolerances)
        {
            self.fault("HP0243", HERE.key("allocate"), "invalid allocation: no tolerance has a cost")
                .note("tolerances without a cost are fixed")
                .help("give a cost to the tolerances to allocate, like `A_x = { tolerance = 0.1, cost = 1 }` in `[tolerance.variables]`");
        }
    }
}

/// Maximum number of standard deviations; a larger value is surely a slip.
const MOST_SIGMAS: f64 = 30.0;
/// Maximum number of correlations; the check for contradictions is cubic in their number.
const MOST_CORRELATIONS: usize = 300;

/// Correlation matrix of the correlated variables.
fn matrix(of: &[Correlation]) -> Vec<Vec<f64>> {
    let mut variables: Vec<VariableId> = of.iter().flat_map(|c| c.between).collect();
    variables.sort_unstable();
    variables.dedup();
    let entry = |a: VariableId, b: VariableId| {
        let given = of.iter().find(|c| c.between == [a, b] || c.between == [b, a]);
        if a == b { 1.0 } else { given.map_or(0.0, |c| c.coefficient) }
    };
    variables.iter().map(|a| variables.iter().map(|b| entry(*a, *b)).collect()).collect()
}
