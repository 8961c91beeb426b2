//! Checks of parameters and formulas: references, order of evaluation, and dependence on design variables.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use crate::draft::{ChangeDraft, Draft, DraftLocation, FormulaOf, NumberDraft, Section};
use crate::expression::Expression;
use crate::joint::Quantity;
use crate::law::Law;
use crate::model::Change;
use crate::model::{
    CaseId, DriverId, ElementNumber, Formula, Hardpoint, HardpointId, JointId, NamedNumber, NumberId,
    ParameterId, Source, Target,
};
use crate::number::Dual;
use crate::space::Vec3;

use super::{Checker, Here, LISTED_NAMES, extent_of_joints};

/// Formula with its location in the draft.
pub(super) struct LocatedFormula {
    formula: Formula,
    at: DraftLocation,
    /// Name of the defined number in messages.
    name: String,
    /// Case whose laws it defines.
    case: Option<CaseId>,
}

impl<'a> Checker<'a> {
    /// Adds the parameters, and resolves the formulas of parameters and of coordinates of named hardpoints.
    pub(super) fn add_formulas(&mut self) {
        let draft = self.draft;
        for (index, p) in draft.parameters.iter().enumerate() {
            let at = Here { section: Section::Parameters, index };
            if !p.name.trim().is_empty() && !Expression::can_name(&p.name) {
                let message = format!("invalid parameter name: `{}`", p.name);
                self.fault("HP0201", at.key("name"), message).help(
                    "use letters, digits and `_`, and no name that is built into expressions, such as `t` or `sin`",
                );
            }
            if !p.value.is_finite() {
                let message = format!("the value of parameter `{}` is not a finite number", p.name);
                self.fault("HP0202", at.key("value"), message);
            }
            if self.unread(at, "value") {
                self.unknown_sources.insert(Source::Parameter(ParameterId(index)));
            }
            let (name, value, quantity) = (p.name.clone(), p.value, p.quantity);
            self.model.parameters.push(NamedNumber { name, value, quantity });
        }
        for index in 0..draft.hardpoints.len() {
            if self.unread(Here { section: Section::Hardpoints, index }, "position") {
                let coordinates = (0..3).map(|axis| Source::Coordinate(HardpointId(index), axis));
                self.unknown_sources.extend(coordinates);
            }
        }
        let mut written: Vec<LocatedFormula> = Vec::new();
        for f in &draft.formulas {
            let (found, at, name) = match &f.of {
                FormulaOf::Parameter(parameter) => {
                    let k = self.number_of("parameter", parameter);
                    let at = Here { section: Section::Parameters, index: k.unwrap_or(0) }.key("value");
                    (k.map(|k| Target::Parameter(ParameterId(k))), at, parameter.clone())
                }
                FormulaOf::Coordinate(hardpoint, axis) => {
                    let k = self.number_of("hardpoint", hardpoint);
                    let here = Here { section: Section::Hardpoints, index: k.unwrap_or(0) };
                    let name = format!("{hardpoint}.{}", AXES[*axis % 3]);
                    let target = k.map(|k| Target::Coordinate(HardpointId(k), *axis % 3));
                    (target, here.item("position", *axis % 3), name)
                }
                // Joints and drivers resolve their own formulas.
                FormulaOf::Length(_) | FormulaOf::Law(..) | FormulaOf::CaseLaw(..) => continue,
            };
            let Some(of) = found else {
                let message = format!("a formula defines `{name}`, which is not in the model");
                self.fault("HP0204", at, message);
                continue;
            };
            match self.formula(of, &f.expression, &at) {
                Some(formula) => written.push(LocatedFormula { formula, at, name, case: None }),
                None => self.mark_unknown(of),
            }
        }
        self.evaluate_in_order(written);
        self.extent = extent_of_joints(self.draft, &self.model.hardpoints, &self.unknown_sources);
    }

    pub(super) fn number_of(&self, what: &str, name: &str) -> Option<usize> {
        self.numbers.get(what).and_then(|numbers| numbers.get(name)).copied()
    }

    /// Returns the formula of an expression, with its names resolved.
    fn formula(&mut self, of: Target, expression: &Expression, at: &DraftLocation) -> Option<Formula> {
        let per_metre = expression.per_metre();
        let inputs: Vec<_> = expression.names().iter().map(|name| self.source(name, per_metre, at)).collect();
        let quantity = match of {
            Target::Parameter(p) => self.model.parameters[p.0].quantity,
            Target::Coordinate(..) | Target::Length(_) => Quantity::Length,
            Target::Law(..) | Target::Number(_) => Quantity::Number,
        };
        let inputs = inputs.into_iter().collect::<Option<_>>()?;
        let per_unit = match of {
            Target::Number(n) => self.model.numbers[n.0].per_unit,
            _ if quantity == Quantity::Length => per_metre,
            _ => 1.0,
        };
        Some(Formula { of, expression: expression.clone(), inputs, per_unit })
    }

    /// Returns the source that a name in an expression refers to, with the number of units of the text per SI unit.
    fn source(&mut self, name: &str, per_metre: f64, at: &DraftLocation) -> Option<(Source, f64)> {
        let draft = self.draft;
        if let Some((hardpoint, axis)) = name.split_once('.') {
            let h = self.hardpoint(hardpoint, at.clone())?;
            let Some(axis) = AXES.iter().position(|a| *a == axis) else {
                let message = format!("hardpoint `{hardpoint}` has no coordinate `{axis}`");
                let help = format!("write `{hardpoint}.x`, `{hardpoint}.y` or `{hardpoint}.z`");
                self.fault("HP0204", at.clone(), message).help(help);
                return None;
            };
            return Some((Source::Coordinate(h, axis), per_metre));
        }
        let names = draft.parameters.iter().map(|p| p.name.as_str());
        let found = self.find("parameter", name, at.clone(), names).map(ParameterId);
        if found.is_none() && self.number_of("hardpoint", name).is_some() {
            let fault = self.faults.last_mut().expect("just reported");
            fault.help(format!(
                "for a coordinate of hardpoint `{name}` write `{name}.x`, `{name}.y` or `{name}.z`"
            ));
        }
        let parameter = found?;
        let of_length = self.model.parameters[parameter.0].quantity == Quantity::Length;
        Some((Source::Parameter(parameter), if of_length { per_metre } else { 1.0 }))
    }

    /// Evaluates formulas in an order in which each comes after those whose results it uses. HP0227 for circular ones.
    fn evaluate_in_order(&mut self, written: Vec<LocatedFormula>) {
        let definition: HashMap<Source, usize> =
            written.iter().enumerate().filter_map(|(k, w)| Some((w.formula.gives()?, k))).collect();
        let uses = |k: usize| written[k].formula.sources().filter_map(|s| definition.get(&s).copied());
        let mut users = vec![Vec::new(); written.len()];
        let mut open_inputs: Vec<usize> = vec![0; written.len()];
        for k in 0..written.len() {
            for other in uses(k) {
                users[other].push(k);
                open_inputs[k] += 1;
            }
        }
        let mut order: Vec<usize> = (0..written.len()).filter(|k| open_inputs[*k] == 0).collect();
        let mut next = 0;
        while let Some(&k) = order.get(next) {
            next += 1;
            for &user in &users[k] {
                open_inputs[user] -= 1;
                if open_inputs[user] == 0 {
                    order.push(user);
                }
            }
        }
        // From each remaining formula, the path along unresolved formulas ends in a new cycle or in a known one.
        let mut path_of: Vec<Option<usize>> = vec![None; written.len()];
        let mut cycles = Vec::new();
        for start in (0..written.len()).filter(|k| open_inputs[*k] > 0) {
            let (mut k, mut path) = (start, Vec::new());
            while path_of[k].is_none() {
                path_of[k] = Some(start);
                path.push(k);
                k = uses(k).find(|other| open_inputs[*other] > 0).unwrap_or(k);
            }
            if path_of[k] == Some(start) {
                let first = path.iter().position(|w| *w == k).unwrap_or(0);
                cycles.push(path.split_off(first));
            }
        }
        for cycle in cycles {
            let shown = |k: &usize| format!("`{}`", written[*k].name);
            let first = &written[cycle[0]];
            let message = match cycle.as_slice() {
                [one] => format!("the formula of {} refers to itself", shown(one)),
                _ => format!("the formula of {} is circular", shown(&cycle[0])),
            };
            let chain = cycle.iter().take(LISTED_NAMES).chain([&cycle[0]]).map(shown).collect::<Vec<_>>();
            let fault = self.fault("HP0227", first.at.clone(), message);
            if cycle.len() > 1 {
                fault.note(chain.join(" uses "));
            }
            fault.help("define one of them by a number, or by an expression of other names");
        }
        for k in (0..written.len()).filter(|k| open_inputs[*k] > 0) {
            self.mark_unknown(written[k].formula.of);
        }
        let mut by_number: Vec<Option<LocatedFormula>> = written.into_iter().map(Some).collect();
        for k in order {
            let w = by_number[k].take().expect("each comes once");
            self.evaluate(w);
        }
    }

    /// Sets the result of a formula in the nominal design. HP0228 if it is not finite.
    fn evaluate(&mut self, w: LocatedFormula) -> Option<f64> {
        if w.formula.sources().any(|s| self.is_unknown(s)) {
            self.mark_unknown(w.formula.of);
            return None;
        }
        let value = w.formula.at(|s| self.model.nominal(s));
        if !value.is_finite() {
            let message = format!("the expression for `{}` has no finite value", w.name);
            let numbers = w.formula.inputs.iter().zip(w.formula.expression.names());
            let numbers: Vec<String> = numbers
                .take(LISTED_NAMES)
                .map(|((source, per_unit), name)| {
                    format!("`{name}` = {}", self.model.nominal(*source) * per_unit)
                })
                .collect();
            let of = w.formula.of;
            let fault = self.fault("HP0228", w.at, message);
            if !numbers.is_empty() {
                fault.note(format!("with {}", numbers.join(", ")));
            }
            fault.help("change the expression or its parameters: it divides by zero or takes a root of a negative number there");
            self.mark_unknown(of);
            return None;
        }
        let is_coordinate = matches!(w.formula.of, Target::Coordinate(..));
        if is_coordinate && !self.check_lengths(&format!("`{}`", w.name), [value, 0.0, 0.0], w.at.clone()) {
            self.mark_unknown(w.formula.of);
            return None;
        }
        match w.formula.of {
            Target::Parameter(p) => self.model.parameters[p.0].value = value,
            Target::Coordinate(h, axis) => self.set(h, axis, value),
            Target::Number(n) => self.model.numbers[n.0].value = value,
            Target::Length(_) | Target::Law(..) => {}
        }
        self.written.push(w);
        Some(value)
    }

    fn is_unknown(&self, source: Source) -> bool {
        match source {
            Source::Parameter(_) | Source::Coordinate(..) => self.unknown_sources.contains(&source),
            Source::Kept(j, _) => {
                let coordinates = |h| (0..3).map(move |axis| Source::Coordinate(h, axis));
                self.model.joints[j.0]
                    .hardpoints()
                    .flat_map(coordinates)
                    .any(|s| self.unknown_sources.contains(&s))
            }
        }
    }

    fn set(&mut self, h: HardpointId, axis: usize, value: f64) {
        let position = &mut self.model.hardpoints[h.0].position;
        let mut coordinates = position.to_array();
        coordinates[axis] = value;
        *position = coordinates.into();
    }

    /// Marks the result of a faulty formula as unknown.
    fn mark_unknown(&mut self, of: Target) {
        match of {
            Target::Parameter(p) => drop(self.unknown_sources.insert(Source::Parameter(p))),
            Target::Coordinate(h, axis) => drop(self.unknown_sources.insert(Source::Coordinate(h, axis))),
            Target::Length(_) | Target::Law(..) | Target::Number(_) => {}
        }
    }

    /// Returns the nominal value of an expression, and adds its formula to the model.
    fn add_formula(
        &mut self,
        of: Target,
        expression: &Expression,
        at: DraftLocation,
        name: String,
    ) -> Option<f64> {
        self.add_formula_in(None, of, expression, at, name)
    }

    /// [`Checker::given`] for a number of a case.
    fn add_formula_in(
        &mut self,
        case: Option<CaseId>,
        of: Target,
        expression: &Expression,
        at: DraftLocation,
        name: String,
    ) -> Option<f64> {
        let formula = self.formula(of, expression, &at)?;
        self.evaluate(LocatedFormula { formula, at, name, case })
    }

    /// Adds an unnamed hardpoint at coordinates defined by expressions.
    pub(super) fn formula_place(
        &mut self,
        coordinates: &[Expression; 3],
        owner: &str,
        at: DraftLocation,
    ) -> Option<HardpointId> {
        let h = HardpointId(self.model.hardpoints.len());
        self.model.hardpoints.push(Hardpoint { name: owner.into(), position: Vec3::ZERO, unnamed: true });
        let given = [0, 1, 2].map(|axis| {
            let name = format!("{} of {owner}", AXES[axis]);
            self.add_formula(Target::Coordinate(h, axis), &coordinates[axis], at.clone(), name)
        });
        given.iter().all(Option::is_some).then(|| {
            self.extent.include(self.model.hardpoints[h.0].position);
            h
        })
    }

    /// Text of the expression of a number of a mass or force; `None` if it is a plain number.
    pub(super) fn expression_of(&self, number: NumberId) -> Option<&str> {
        let of = |written: &&LocatedFormula| written.formula.of == Target::Number(number);
        self.written.iter().find(of).map(|written| written.formula.text())
    }

    /// Adds a number of a mass or force, given as a value or an expression.
    pub(super) fn element_number(
        &mut self,
        number: &NumberDraft,
        owner: &str,
        key: &'static str,
        at: DraftLocation,
    ) -> Option<NumberId> {
        let id = NumberId(self.model.numbers.len());
        let (value, per_unit) = (number.value, number.per_unit);
        self.model.numbers.push(ElementNumber { owner: owner.into(), key, value, per_unit });
        match &number.expression {
            Some(expression) => {
                self.add_formula(Target::Number(id), expression, at, format!("{key} of {owner}"))?;
            }
            None if !value.is_finite() => {
                self.fault("HP0202", at, format!("`{key}` of `{owner}` is not a finite number"));
                return None;
            }
            None => {}
        }
        Some(id)
    }

    /// Returns the length of a rod that is defined by an expression, if any.
    pub(super) fn formula_length(&mut self, name: &str, at: DraftLocation) -> Option<Option<f64>> {
        let expression = self.length_formulas.get(name).copied()?;
        let joint = JointId(self.model.joints.len());
        Some(self.add_formula(Target::Length(joint), expression, at, format!("length of {name}")))
    }

    /// Returns a driver's law with the parameters that are defined by expressions.
    pub(super) fn formula_law(&mut self, name: &str, law: &Law, at: &DraftLocation) -> Option<Law> {
        let driver = DriverId(self.model.drivers.len());
        let given = self.law_formulas.get(name).cloned().unwrap_or_default();
        self.law_with(&given, None, (driver, name), law, at)
    }

    /// Removes the formulas of the law of a faulty driver, whose number the next driver gets.
    pub(super) fn remove_law_formulas(&mut self, driver: DriverId) {
        self.zeros.remove(&driver);
        self.written.retain(|w| !matches!(w.formula.of, Target::Law(of, _) if of == driver));
    }

    /// Returns the law of a driver in a case, with the parameters that are defined by expressions.
    pub(super) fn formula_law_in(
        &mut self,
        (case, case_name): (CaseId, &str),
        driver: (DriverId, &str),
        law: &Law,
        at: &DraftLocation,
    ) -> Option<Law> {
        let given = self.case_formulas.get(&(case_name, driver.1)).cloned().unwrap_or_default();
        self.law_with(&given, Some(case), driver, law, at)
    }

    /// Returns a law with the parameters that are defined by expressions, absolute or relative like its driver.
    fn law_with(
        &mut self,
        given: &[(&str, &Expression)],
        case: Option<CaseId>,
        (driver, name): (DriverId, &str),
        law: &Law,
        at: &DraftLocation,
    ) -> Option<Law> {
        let mut law = law.clone();
        for &(parameter, expression) in given {
            let Some(p) = law.parameters().iter().position(|p| p.name == parameter) else {
                let message =
                    format!("a formula defines `{parameter}`, which the law of `{name}` does not have");
                self.fault("HP0204", at.clone(), message);
                continue;
            };
            let of = Target::Law(driver, p);
            let value = self.add_formula_in(case, of, expression, at.clone(), parameter.to_owned())?;
            law = law.with_parameter(p, value);
        }
        let Some(zero) = self.zeros.get(&driver) else { return Some(law) };
        let parameters = law.parameters().len();
        let formula = zero.formula(Target::Law(driver, parameters));
        let value = self.evaluate(LocatedFormula { formula, at: at.clone(), name: name.to_owned(), case })?;
        Some(law.from_zero(value))
    }

    /// Stores the formulas that depend on design variables. HP0228 for those without a derivative, HP0226 for those
    /// that would change the shape of a curve.
    pub(super) fn add_varying_formulas(&mut self) {
        let mut varying: BTreeSet<Source> = BTreeSet::new();
        for change in self.model.variables.iter().flat_map(|v| &v.changes) {
            varying.extend(change.parameter().map(|(parameter, _)| Source::Parameter(parameter)));
            if let Some((hardpoint, velocity)) = change.hardpoint() {
                let moved = (0..3).filter(|axis| velocity[*axis] != 0.0);
                varying.extend(moved.map(|axis| Source::Coordinate(hardpoint, axis)));
            }
        }
        let changed: BTreeSet<JointId> =
            self.model.variables.iter().flat_map(|v| &v.changes).filter_map(Change::joint).collect();
        let mut lengths: BTreeSet<JointId> = BTreeSet::new();
        for LocatedFormula { mut formula, at, name, case } in std::mem::take(&mut self.written) {
            let model = &self.model;
            let varies = |s: &Source| match *s {
                Source::Parameter(_) | Source::Coordinate(..) => varying.contains(s),
                Source::Kept(j, _) => {
                    let coordinates = |h| (0..3).map(move |axis| Source::Coordinate(h, axis));
                    let mut by = model.joints[j.0].hardpoints().flat_map(coordinates);
                    changed.contains(&j) || lengths.contains(&j) || by.any(|s| varying.contains(&s))
                }
            };
            let fixed: Vec<Option<f64>> = formula
                .inputs
                .iter()
                .map(|(s, per_unit)| (!varies(s)).then(|| model.nominal(*s) * per_unit))
                .collect();
            if fixed.iter().all(Option::is_some) {
                continue;
            }
            formula.expression = formula.expression.with_some(|k| fixed[k]);
            formula.inputs.retain(|(s, _)| varies(s));
            // The derivative along all inputs at once is finite only if all partial derivatives are.
            let along = |s: Source| Dual { v: model.nominal(s), d: 1.0 };
            let slope = formula.at(along).d;
            if !slope.is_finite() {
                let message = format!("the expression for `{name}` has no derivative in the nominal design");
                let names: Vec<_> = formula.expression.names().iter().map(|n| format!("`{n}`")).collect();
                self.fault("HP0228", at.clone(), message)
                    .note(format!("it cannot be differentiated with respect to {}", names.join(", ")))
                    .help("change the expression or its numbers: the square root at 0 and the arcsine at 1 have no derivative");
            }
            if let Target::Coordinate(h, _) = formula.of
                && self.curve_points.contains(&h)
            {
                let message = format!("the expression for `{name}` moves a point of a curve");
                self.fault("HP0226", at, message)
                    .note("the shape of a curve cannot be a design variable; its position and direction can")
                    .help(
                        "write `design = false` for the parameters in it, or the curve's points as numbers",
                    );
            }
            if let Target::Length(j) = formula.of {
                lengths.insert(j);
            }
            varying.extend(formula.gives());
            match case {
                Some(case) => self.model.cases[case.0].formulas.push(formula),
                None => self.model.formulas.push(formula),
            }
        }
    }
}

/// Names of the coordinates of a hardpoint in expressions.
pub(super) const AXES: [&str; 3] = ["x", "y", "z"];

impl Formula {
    /// Returns the source that other formulas can use.
    pub(super) fn gives(&self) -> Option<Source> {
        match self.of {
            Target::Parameter(p) => Some(Source::Parameter(p)),
            Target::Coordinate(h, axis) => Some(Source::Coordinate(h, axis)),
            Target::Length(_) | Target::Law(..) | Target::Number(_) => None,
        }
    }
}

/// Nominal values of the parameters and formulas of a draft, for numbers that do not change with the design.
#[derive(Clone, Debug, Default)]
pub struct Nominal {
    /// Position of each hardpoint of the draft, m; zero if one of its formulas is faulty.
    pub positions: Vec<Vec3>,
    /// Value in SI if known, quantity, and a design variable or hardpoint on which it depends, by name.
    parameters: BTreeMap<String, (Option<f64>, Quantity, Option<String>)>,
}

/// Reason why an expression is not a constant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ConstantError {
    /// It uses a name that is not a parameter.
    Unknown(String),
    /// It uses this parameter, which depends on this variable or entry (`design variable `b``, or `hardpoint `A``).
    Follows(String, String),
    /// It uses a parameter that is faulty, which is reported elsewhere.
    Faulty,
    /// Value is not finite.
    NotFinite,
}

impl Nominal {
    /// Evaluates the parameters and hardpoints of a draft with all design variables at zero. Faulty entries have no
    /// value; [`Model::from_draft`](crate::model::Model::from_draft) reports them.
    pub fn of(draft: &Draft) -> Self {
        let mut c = Checker::new(draft);
        c.add_formulas();
        let mut followed: HashMap<&str, String> = HashMap::new();
        for v in &draft.design {
            for change in &v.changes {
                if let ChangeDraft::Parameter { parameter, .. } = change {
                    followed.entry(parameter).or_insert_with(|| format!("design variable `{}`", v.name));
                }
            }
        }
        let mut follows: Vec<Option<String>> =
            draft.parameters.iter().map(|p| followed.remove(p.name.as_str())).collect();
        for w in &c.written {
            if let Target::Parameter(p) = w.formula.of {
                let of = w.formula.sources().find_map(|s| match s {
                    Source::Parameter(q) => follows[q.0].clone(),
                    Source::Coordinate(h, _) => Some(format!("hardpoint `{}`", c.model.hardpoints[h.0].name)),
                    Source::Kept(j, _) => Some(format!("joint `{}`", c.model.joints[j.0].name)),
                });
                follows[p.0] = follows[p.0].take().or(of);
            }
        }
        let parameters = c.model.parameters.iter().zip(follows).enumerate().map(|(k, (p, follows))| {
            let is_known = !c.unknown_sources.contains(&Source::Parameter(ParameterId(k)));
            (p.name.clone(), (is_known.then_some(p.value), p.quantity, follows))
        });
        let parameters = parameters.collect();
        Self { positions: c.model.hardpoints.iter().map(|h| h.position).collect(), parameters }
    }

    /// Returns the names of all parameters.
    pub fn names(&self) -> impl Iterator<Item = &str> + Clone {
        self.parameters.keys().map(String::as_str)
    }

    /// Returns the value in SI and the quantity of a parameter; no value if it is faulty.
    pub fn parameter(&self, name: &str) -> Option<(Option<f64>, Quantity)> {
        self.parameters.get(name).map(|p| (p.0, p.1))
    }

    /// Returns the value of an expression over parameters, in the units of its text.
    ///
    /// # Errors
    /// A [`ConstantError`] if it has no value. A dependence on the design is allowed.
    pub fn value(&self, expression: &Expression) -> Result<f64, ConstantError> {
        self.evaluated(expression, true)
    }

    /// Returns the value of an expression over parameters that do not depend on the design, in the units of its text.
    ///
    /// # Errors
    /// A [`ConstantError`] if it is not a constant.
    pub fn constant(&self, expression: &Expression) -> Result<f64, ConstantError> {
        self.evaluated(expression, false)
    }

    fn evaluated(&self, expression: &Expression, may_follow: bool) -> Result<f64, ConstantError> {
        let numbers = expression.names().iter().map(|name| {
            let unknown = || ConstantError::Unknown(name.clone());
            let (value, quantity, follows) = self.parameters.get(name).ok_or_else(unknown)?;
            if let (Some(follows), false) = (follows, may_follow) {
                return Err(ConstantError::Follows(name.clone(), follows.clone()));
            }
            let per_unit = if *quantity == Quantity::Length { expression.per_metre() } else { 1.0 };
            value.map(|value| value * per_unit).ok_or(ConstantError::Faulty)
        });
        let value = expression.at(&numbers.collect::<Result<Vec<f64>, _>>()?);
        if value.is_finite() { Ok(value) } else { Err(ConstantError::NotFinite) }
    }
}
