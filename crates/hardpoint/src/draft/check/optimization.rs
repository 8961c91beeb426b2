//! Checks of the optimisation: variables, goals and limits.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use crate::draft::{
    ChangeDraft, DraftLocation, GoalDraft, LimitDraft, LimitTargetDraft, OptimizationSettingsDraft, Section,
    VariableDraft,
};
use crate::model::{
    Dimension, Goal, JointId, Limit, LimitTarget, OptimizationSettings, Source, Target, VariableId,
};

use super::formulas::AXES;
use super::{Checker, Here, LISTED_NAMES};

/// Highest lower and lowest upper limit of each limited quantity: its value as written, and the name of its limit.
type Tightest<'d> = HashMap<Key, [Option<(f64, f64, &'d str)>; 2]>;
/// Identity of a limited quantity.
type Key = (u8, usize, usize);

impl Checker<'_> {
    pub(super) fn add_optimization(&mut self) {
        let draft = self.draft;
        let Some(o) = &draft.optimization else { return };
        let here = Here { section: Section::Optimize, index: 0 };
        let variables = self.optimized_variables(o, here);
        // The check of ineffective limits needs a valid model.
        let sound = self.faults.is_empty() && draft.unread.is_empty();
        if o.goals.is_empty() {
            self.fault("HP0236", here.key("goals"), "invalid optimisation: there are no goals")
                .help("add a metric to minimise, like `goals.toe = { metric = \"toe_error\" }`");
        }
        if let Some(margin) = o.margin
            && !(margin > 0.0 && margin < 1.0)
        {
            let message = format!("invalid `min_margin` of the optimisation: {margin}");
            self.fault("HP0237", here.key("min_margin"), message)
                .note("the margin is 0 at a singular position and 1 far from any")
                .help("give a number between 0 and 1, like `min_margin = 0.02`, or remove it");
        }
        for (key, count) in [("starts", o.starts), ("max_iterations", o.iterations)] {
            if count == 0 {
                let message = format!("`{key}` of the optimisation is 0");
                self.fault("HP0237", here.key(key), message).help("give a whole number from 1");
            }
        }
        let trade_off = self.traded_goals(o, here);
        let goals: Vec<_> = o.goals.iter().enumerate().map(|(index, g)| self.goal(g, index)).collect();
        let mut tightest = Tightest::new();
        let mut limits = Vec::new();
        for (index, limit) in o.limits.iter().enumerate() {
            let here = Here { section: Section::Limits, index };
            let found = if self.unread(here, "") { None } else { self.limit(limit, here) };
            if let Some(limit) = &found {
                self.check_contradiction(&o.limits[index], limit, &mut tightest, here);
            }
            limits.extend(found.map(|limit| (here, limit)));
        }
        let Some(variables) = variables else { return };
        if sound {
            self.check_ineffective_limits(&variables, &limits);
        }
        let margin =
            Limit { name: "min_margin".into(), of: LimitTarget::Margin, least: o.margin, most: None };
        let limits = limits.into_iter().map(|(_, limit)| limit);
        let limits = limits.chain(o.margin.map(|_| margin)).collect();
        let goals = goals.into_iter().flatten().collect();
        self.model.optimization = Some(OptimizationSettings {
            variables,
            goals,
            limits,
            starts: o.starts,
            other_assemblies: o.other_assemblies,
            both_senses: o.both_senses,
            iterations: o.iterations,
            trade_off,
        });
    }

    /// Returns the names of the goals of the trade-off. HP0237 unless they are two or three different ones.
    fn traded_goals(&mut self, o: &OptimizationSettingsDraft, here: Here) -> Vec<String> {
        let mut found: Vec<String> = Vec::new();
        let mut sound = true;
        for (k, name) in o.trade_off.iter().enumerate() {
            let at = here.item("trade_off", k);
            if found.contains(name) {
                let message = format!("goal `{name}` is listed twice in `trade_off`");
                self.fault("HP0237", at, message).help("name two or three different goals");
                sound = false;
                continue;
            }
            if !self.draft.unread.any_of(Section::Goals) {
                self.find("goal", name, at, o.goals.iter().map(|g| g.name.as_str()));
            }
            found.push(name.clone());
        }
        if sound && !matches!(found.len(), 0 | 2 | 3) {
            let message = format!("`trade_off` of the optimisation names {}", number_of_goals(found.len()));
            self.fault("HP0237", here.key("trade_off"), message)
                .note("a trade-off is between two or three goals")
                .help("name two or three goals, and turn others into limits");
        }
        found
    }

    /// Returns the optimised variables. HP0236 unless each has bounds and is listed once.
    fn optimized_variables(&mut self, o: &OptimizationSettingsDraft, here: Here) -> Option<Vec<VariableId>> {
        let draft = self.draft;
        if self.unread(here, "variables") {
            return None;
        }
        let Some(names) = &o.variables else {
            let with_bounds = (0..draft.design.len()).filter(|k| draft.design[*k].bounds.is_some());
            let found: Vec<VariableId> = with_bounds.map(VariableId).collect();
            let unknown = draft.unread.anywhere(Section::Design, "bounds")
                || self.is_table_unread("design variable")
                || self.is_table_unread("parameter");
            if found.is_empty() && !unknown {
                self.fault("HP0236", here.key(""), "invalid optimisation: no design variable has bounds").help(
                    "give bounds to the variables to optimise, like `bounds = [-5, 5]` in `[design.NAME]`, or `NAME = { value = 60, bounds = [50, 70] }` in `[parameters]`",
                );
            }
            return Some(found);
        };
        if names.is_empty() {
            self.fault(
                "HP0236",
                here.key("variables"),
                "invalid optimisation: the list of variables is empty",
            )
            .help("name the variables to optimise, or remove `variables` to use all that have bounds");
        }
        let mut first_of: BTreeMap<&str, usize> = BTreeMap::new();
        let mut found = Vec::new();
        for (k, name) in names.iter().enumerate() {
            let at = here.item("variables", k);
            let first = *first_of.entry(name).or_insert(k);
            if first < k {
                let message = format!("design variable `{name}` is listed twice");
                self.fault("HP0236", at, message)
                    .note(format!("it is number {} and number {} of the list", first + 1, k + 1))
                    .help("remove one of the two");
                continue;
            }
            let Some(index) = self.variable_index(name, at.clone()) else { continue };
            let v = &draft.design[index];
            if v.bounds.is_none() && !draft.unread.any(Section::Design, index) {
                let message = format!("design variable `{name}` has no bounds");
                self.fault("HP0236", at, message).help(bounds_of(v));
            }
            found.push(VariableId(index));
        }
        Some(found)
    }

    /// Returns the index of a design variable in the draft.
    pub(super) fn variable_index(&mut self, name: &str, at: DraftLocation) -> Option<usize> {
        let draft = self.draft;
        let known = self.number_of("design variable", name);
        // An unread entry may be this variable.
        if known.is_some() || self.is_table_unread("parameter") || draft.unread.any_of(Section::Design) {
            return known;
        }
        self.find("design variable", name, at, draft.design.iter().map(|v| v.name.as_str()));
        let parts: Vec<String> = AXES
            .iter()
            .map(|axis| format!("{name}_{axis}"))
            .filter(|part| self.number_of("design variable", part).is_some())
            .map(|part| format!("`{part}`"))
            .collect();
        let derived = self.number_of("parameter", name).is_some();
        if let Some(fault) = self.faults.last_mut()
            && !self.draft.unread.has(Section::Model, 0, "design")
        {
            if !parts.is_empty() {
                fault.help(format!("name one of the variables of `[design.{name}]`: {}", parts.join(", ")));
            } else if derived {
                fault.help(format!(
                    "name a variable on which parameter `{name}` depends: it is not a design variable itself, because it is defined by an expression or has `design = false`"
                ));
            }
        }
        None
    }

    /// Returns the index of a metric in the model; `None`, without a second error, if the metric itself is faulty.
    pub(super) fn metric(&mut self, name: &str, at: DraftLocation) -> Option<usize> {
        let draft = self.draft;
        let known = self.find("metric", name, at, draft.metrics.iter().map(|m| m.name.as_str()));
        if known.is_none() && !self.is_table_unread("metric") {
            let is_measure = self.number_of("measure", name).is_some();
            let fault = self.faults.last_mut().expect("just reported");
            if is_measure {
                fault.help(format!(
                    "declare a metric of measure `{name}`, like `[metrics.{name}_range]` with `of = \"{name}\"` and `take = \"range\"`"
                ));
            } else if draft.metrics.is_empty() {
                fault.help("declare it in `[metrics.NAME]`");
            }
        }
        self.metric_ids.get(known?).copied().flatten()
    }

    /// Resolves a goal. HP0237 if its weight or target is invalid.
    fn goal(&mut self, g: &GoalDraft, index: usize) -> Option<Goal> {
        let here = Here { section: Section::Goals, index };
        if self.unread(here, "") {
            return None;
        }
        if !Goal::is_weight(g.weight) {
            let message = format!("invalid weight of goal `{}`: {:?}", g.name, g.weight);
            self.fault("HP0237", here.key("weight"), message).help(
                "give a positive number, from 1e-50 to 1e50, or remove the goal; to maximise a metric, give it a large \
                 `target`",
            );
        }
        if g.target.is_some_and(|target| !target.is_finite()) {
            let message = format!("the target of goal `{}` is not a finite number", g.name);
            self.fault("HP0237", here.key("target"), message).help("give the target value of its metric");
        }
        let metric = self.metric(&g.metric, here.key("metric"))?;
        let m = &self.model.metrics[metric];
        if m.take.target().is_some() && g.target.is_some() {
            let message =
                format!("goal `{}` cannot have a target: its metric `{}` is an `rms`", g.name, g.metric);
            let help = format!(
                "remove `target`, and give the curve to follow as `target` of `[metrics.{}]`",
                g.metric
            );
            self.fault("HP0237", here.key("target"), message)
                .note("an `rms` is the distance of a curve from its own target, and is minimised")
                .help(help);
            return None;
        }
        let unit = per_si(self.model.metric_dimension(m), g.per_metre, g.per_radian);
        let target = g.target.map(|target| target / unit);
        Some(Goal { name: g.name.clone(), metric, target, weight: g.weight * unit })
    }

    /// Resolves a limit to its quantity and its bounds in SI. HP0238 if no number can satisfy it.
    pub(super) fn limit(&mut self, l: &LimitDraft, here: Here) -> Option<Limit> {
        let of = self.limit_target(l, here);
        for (key, bound) in [("min", l.least), ("max", l.most)] {
            if bound.is_some_and(|x| !x.is_finite()) {
                let message = format!("the `{key}` of limit `{}` is not a finite number", l.name);
                self.fault("HP0238", here.key(key), message).help("give a finite number, or remove the key");
                return None;
            }
        }
        match (l.least, l.most) {
            (None, None) => {
                let message = format!("limit `{}` has no bound", l.name);
                self.fault("HP0238", here.key("name"), message)
                    .help("give `min`, `max` or both, or give `equal`");
                return None;
            }
            (Some(least), Some(most)) if least > most => {
                let message = format!("the bounds of limit `{}` contradict each other", l.name);
                self.fault("HP0238", here.key(side_of(&l.of)), message)
                    .note(format!("its minimum is {least} and its maximum is {most}"))
                    .help("give the lower bound first, or as `min`");
                return None;
            }
            _ => {}
        }
        let is_length = matches!(l.of, LimitTargetDraft::Distance(_) | LimitTargetDraft::Length(_));
        if let Some(most) = l.most.filter(|most| is_length && *most < 0.0) {
            let message = format!("limit `{}` is impossible: a length cannot be negative", l.name);
            self.fault("HP0238", here.key("max"), message)
                .note(format!("its maximum is {most}"))
                .help("give a positive length");
            return None;
        }
        let of = of?;
        let dimension = match of {
            LimitTarget::Metric(metric) => self.model.metric_dimension(&self.model.metrics[metric]),
            LimitTarget::Coordinate(..) | LimitTarget::Distance(..) | LimitTarget::Length(_) => {
                Dimension::LENGTH
            }
            LimitTarget::Margin => Dimension::NUMBER,
        };
        let unit = per_si(dimension, l.per_metre, l.per_radian);
        let [least, most] = [l.least, l.most].map(|bound| bound.map(|x| x / unit));
        Some(Limit { name: l.name.clone(), of, least, most })
    }

    fn limit_target(&mut self, l: &LimitDraft, here: Here) -> Option<LimitTarget> {
        Some(match &l.of {
            LimitTargetDraft::Unread => return None,
            LimitTargetDraft::Metric(name) => LimitTarget::Metric(self.metric(name, here.key("metric"))?),
            LimitTargetDraft::Coordinate(name, axis) => {
                LimitTarget::Coordinate(self.hardpoint(name, here.key("hardpoint"))?, *axis % 3)
            }
            LimitTargetDraft::Distance(names) => {
                let found = [0, 1].map(|k| self.hardpoint(&names[k], here.item("between", k)));
                let [a, b] = [found[0]?, found[1]?];
                if a == b {
                    let message =
                        format!("limit `{}` applies to the distance of `{}` from itself", l.name, names[0]);
                    self.fault("HP0216", here.key("between"), message).help("name two different hardpoints");
                    return None;
                }
                LimitTarget::Distance(a, b)
            }
            LimitTargetDraft::Length(name) => {
                let joint = self.joint(name, here.key("length"))?;
                let kind = self.model.joints[joint.0].kind;
                if !kind.is_rod() {
                    let message = format!("joint `{name}` has no length for limit `{}`", l.name);
                    self.fault("HP0225", here.key("length"), message)
                        .note(format!("its type is `{}`", kind.name))
                        .help("name a rod or a leg; for two hardpoints write `between = [\"A\", \"B\"]`");
                    return None;
                }
                LimitTarget::Length(joint)
            }
        })
    }

    /// HP0238: contradictory limits of one quantity.
    fn check_contradiction<'d>(
        &mut self,
        written: &'d LimitDraft,
        limit: &Limit,
        tightest: &mut Tightest<'d>,
        here: Here,
    ) {
        let [least, most] = tightest.entry(key(limit.of)).or_default();
        let lower = limit.least.zip(written.least).map(|(x, w)| (x, w, written.name.as_str()));
        let upper = limit.most.zip(written.most).map(|(x, w)| (x, w, written.name.as_str()));
        let apart = match (lower, *most, upper, *least) {
            (Some(low), Some(high), ..) if low.0 > high.0 => Some((low, high)),
            (_, _, Some(high), Some(low)) if low.0 > high.0 => Some((low, high)),
            _ => None,
        };
        if lower.is_some_and(|l| least.is_none_or(|known| l.0 > known.0)) {
            *least = lower;
        }
        if upper.is_some_and(|u| most.is_none_or(|known| u.0 < known.0)) {
            *most = upper;
        }
        if let Some(((_, low, of_low), (_, high, of_high))) = apart {
            let other = if of_low == limit.name { of_high } else { of_low };
            let message = format!("limits `{other}` and `{}` contradict each other", limit.name);
            self.fault("HP0238", here.key(side_of(&written.of)), message)
                .note(format!("the minimum of `{of_low}` is {low}, and the maximum of `{of_high}` is {high}"))
                .help("widen one of the two, or remove it");
        }
    }

    /// HP0239: limits of quantities that no variable changes.
    fn check_ineffective_limits(&mut self, variables: &[VariableId], limits: &[(Here, Limit)]) {
        let (mut moved, mut joints): (BTreeSet<Source>, BTreeSet<JointId>) = Default::default();
        let model = &self.model;
        for change in variables.iter().flat_map(|v| &model.variables[v.0].changes) {
            moved.extend(change.parameter().map(|(p, _)| Source::Parameter(p)));
            joints.extend(change.joint());
            if let Some((h, velocity)) = change.hardpoint() {
                let axes = (0..3).filter(|axis| velocity[*axis] != 0.0);
                moved.extend(axes.map(|axis| Source::Coordinate(h, axis)));
            }
        }
        for formula in &model.formulas {
            if formula.sources().any(|s| moved.contains(&s)) {
                moved.extend(formula.gives());
                if let Target::Length(joint) = formula.of {
                    joints.insert(joint);
                }
            }
        }
        let moves = |h| (0..3).any(|axis| moved.contains(&Source::Coordinate(h, axis)));
        let name = |h: crate::model::HardpointId| format!("`{}`", model.hardpoints[h.0].name);
        let mut fixed = Vec::new();
        for (here, limit) in limits {
            let (what, key) = match limit.of {
                LimitTarget::Coordinate(h, axis) if !moved.contains(&Source::Coordinate(h, axis)) => {
                    (format!("{} of {}", AXES[axis], name(h)), AXES[axis])
                }
                LimitTarget::Distance(a, b) if !moves(a) && !moves(b) => {
                    (format!("the distance of {} and {}", name(a), name(b)), "between")
                }
                LimitTarget::Length(j) => {
                    let joint = &model.joints[j.0];
                    let by_ends = joint.length.is_none() && joint.at.iter().any(|h| moves(*h));
                    if by_ends || joints.contains(&j) {
                        continue;
                    }
                    (format!("the length of `{}`", joint.name), "length")
                }
                _ => continue,
            };
            fixed.push((here.key(key), limit.name.clone(), what));
        }
        let names: Vec<String> =
            variables.iter().map(|v| format!("`{}`", model.variables[v.0].name)).collect();
        let names = crate::draft::some_of(&names, ", ", LISTED_NAMES);
        for (at, limit, what) in fixed {
            let message = format!("limit `{limit}` applies to {what}, which no variable changes");
            self.fault("HP0239", at, message)
                .note(format!("optimised variables: {names}"))
                .help("add a variable with bounds that changes it, or remove the limit");
        }
    }
}

/// Field of the bounds of a coordinate limit; the name for other limits.
fn side_of(of: &LimitTargetDraft) -> &'static str {
    if let LimitTargetDraft::Coordinate(_, axis) = of { AXES[axis % 3] } else { "name" }
}

fn key(of: LimitTarget) -> Key {
    match of {
        LimitTarget::Metric(m) => (0, m, 0),
        LimitTarget::Coordinate(h, axis) => (1, h.0, axis),
        LimitTarget::Distance(a, b) => (2, a.0.min(b.0), a.0.max(b.0)),
        LimitTarget::Length(j) => (3, j.0, 0),
        LimitTarget::Margin => (4, 0, 0),
    }
}

/// Number of user units per SI unit.
pub(super) fn per_si(of: Dimension, per_metre: f64, per_radian: f64) -> f64 {
    per_metre.powi(of.length_in_units().into()) * per_radian.powi(of.angle.into())
}

/// Returns a help text that shows the bounds of a variable.
fn bounds_of(v: &VariableDraft) -> String {
    match v.changes.as_slice() {
        [ChangeDraft::Parameter { parameter, .. }] if *parameter == v.name => format!(
            "write it in `[parameters]` as `{parameter} = {{ value = ..., bounds = [LOWEST, HIGHEST] }}`, with its value between them"
        ),
        _ => format!("give `{}` bounds in `[design]`, like `bounds = [-5, 5]`", v.name),
    }
}

fn number_of_goals(n: usize) -> String {
    if n == 1 { "one goal".into() } else { format!("{n} goals") }
}
