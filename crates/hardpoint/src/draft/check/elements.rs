//! Checks of masses and forces: references and parameters.

use crate::draft::{DraftError, ElementDraft, NumberDraft, Section, TablePointDraft};
use crate::joint::{DIRECTION_NAMES, DIRECTIONS, Quantity};
use crate::linalg::semidefinite::{is_definite, is_semidefinite};
use crate::model::element::{
    CURVES, CoupledStiffness, ElasticLaw, Elasticity, JointFriction, SCALES, StiffnessEntry,
};
use crate::model::{
    BodyId, Direction, Element, ElementKind, GROUND, JointId, Model, NumberId, Plain, PointId, SpringTable,
    elements,
};

use super::field::FieldCheck;
use super::{Checker, Here, PERPENDICULAR_TOLERANCE};

impl Checker<'_> {
    pub(super) fn add_elements(&mut self) {
        let draft = self.draft;
        let masses = draft.masses.iter().enumerate().map(|(k, e)| (Section::Masses, k, e));
        let forces = draft.forces.iter().enumerate().map(|(k, e)| (Section::Forces, k, e));
        for (section, index, element) in masses.chain(forces) {
            let here = Here { section, index };
            if let Some(kind) = self.one_element(element, here) {
                self.model.elements.push(Element { name: element.name.clone(), kind });
            }
        }
        if !draft.gravity.is_finite() {
            let at = Here { section: Section::Model, index: 0 }.key("gravity");
            self.fault("HP0202", at, "a component of `gravity` is not a finite number");
        }
    }

    fn one_element(&mut self, e: &ElementDraft, here: Here) -> Option<ElementKind> {
        let faults = self.faults.len();
        let kind = e.kind.resolve(&mut FieldCheck::new(self, &e.name, here))?;
        let mut check = ElementCheck { check: self, name: &e.name, here };
        kind.check(&mut check);
        if let Some(friction) = kind.friction(check.model()) {
            check.check_friction(&friction);
        }
        if let Some(law) = kind.law(&self.model) {
            let times =
                self.draft.times.iter().chain(self.draft.cases.iter().flat_map(|c| c.times.iter().flatten()));
            if let Some(t) = times.copied().find(|t| !law.at(*t).value().is_finite()) {
                let message = format!("the law of `{}` has no finite value at t = {t} s", e.name);
                self.fault("HP0214", here.key("law"), message).help("change the law, or the output times");
            }
        }
        (self.faults.len() == faults).then_some(kind)
    }

    /// Returns the table of a spring, as tension over extension: of a compression, deflections and forces have the
    /// opposite sign, in the opposite order.
    pub(super) fn spring_table(
        &mut self,
        points: &[TablePointDraft],
        name: &str,
        here: Here,
        key: &'static str,
    ) -> Option<SpringTable> {
        let is_compression = key == "compression";
        let signed = |x: f64| if is_compression { 0.0 - x } else { x };
        let follow_design = points.iter().any(|p| p.force.expression.is_some());
        let (mut resolved, mut numbers) = (Vec::new(), Vec::new());
        for TablePointDraft { deflection, force } in points {
            let mut value = signed(force.value);
            if follow_design {
                let force = NumberDraft { value, per_unit: signed(force.per_unit), ..force.clone() };
                let number = self.element_number(&force, name, key, here.key(key))?;
                value = self.model.numbers[number.0].value;
                numbers.push(number);
            }
            resolved.push([signed(*deflection), value]);
        }
        if is_compression {
            resolved.reverse();
            numbers.reverse();
        }
        let table = SpringTable::new(&resolved);
        if let Err(why) = &table {
            let message = format!("the table of `{name}` {why}");
            let point = match key.contains("about") {
                true => "[angle, moment]",
                false => "[deflection, force]",
            };
            self.fault("HP0252", here.key(key), message)
                .help(format!("give at least two points `{point}`, in increasing order"));
        }
        table.ok().map(|table| table.with_numbers(numbers))
    }

    /// Returns the entries of a stiffness matrix on its diagonal and above. HP0252: a matrix that is not symmetric.
    pub(super) fn coupled_stiffness(
        &mut self,
        rows: &[[NumberDraft; 6]; 6],
        name: &str,
        here: Here,
        key: &'static str,
    ) -> Option<CoupledStiffness> {
        let mut entries = Vec::new();
        for (row, numbers) in rows.iter().enumerate() {
            for (column, number) in numbers.iter().enumerate().skip(row) {
                let below = &rows[column][row];
                if (number.value, &number.expression) != (below.value, &below.expression) {
                    let [r, k] = [row, column].map(|k| DIRECTION_NAMES[k]);
                    let message = format!("the matrix of `{name}` is not symmetric");
                    self.fault("HP0252", here.key(key), message)
                        .note(format!("the entry of row `{r}` and column `{k}` is not that of row `{k}` and column `{r}`"))
                        .help(format!("give both entries of `{r}` and `{k}` the same number or expression"));
                    return None;
                }
                if number.expression.is_some() || number.value != 0.0 {
                    let value = self.element_number(number, name, key, here.key(key))?;
                    entries.push(StiffnessEntry { row, column, value });
                }
            }
        }
        Some(CoupledStiffness { entries })
    }
}

/// Check of a type of elements.
pub(crate) trait CheckElement {
    /// Reports invalid references and parameters.
    fn check(&self, c: &mut ElementCheck<'_, '_>);
}

macro_rules! in_checks {
    ($($(#[$doc:meta])* $variant:ident $name:literal $table:ident { $($fields:tt)* })*) => {
        impl CheckElement for ElementKind {
            fn check(&self, c: &mut ElementCheck<'_, '_>) {
                match self { $(Self::$variant(e) => e.check(c)),* }
            }
        }
    };
}
elements!(in_checks);

/// Rule of the stiffnesses of an elastic law.
#[derive(Clone, Copy)]
pub(crate) enum StiffnessRule {
    /// A direction without a stiffness is rigid, so that one of 0 would hold nothing.
    Positive,
    /// A direction without a stiffness is free: 0 is the same.
    NotNegative,
}

/// Check of one element.
pub(crate) struct ElementCheck<'c, 'd> {
    check: &'c mut Checker<'d>,
    /// The element's name.
    pub name: &'c str,
    here: Here,
}

impl ElementCheck<'_, '_> {
    /// The model as far as it has been built: all but elements, measures and variables.
    pub fn model(&self) -> &Model {
        &self.check.model
    }

    /// Reports an error at a key of the element.
    pub fn fault(
        &mut self,
        code: &'static str,
        key: &'static str,
        message: impl Into<String>,
    ) -> &mut DraftError {
        self.check.fault(code, self.here.key(key), message)
    }

    /// Nominal value of a number.
    pub fn value(&self, number: NumberId) -> f64 {
        self.model().numbers[number.0].value
    }

    /// Body of a point.
    pub fn body_of(&self, point: PointId) -> BodyId {
        self.model().points[point.0].body
    }

    /// True if two points coincide in the design configuration.
    pub fn coincide(&self, a: PointId, b: PointId) -> bool {
        let [a, b] = [a, b].map(|p| self.model().points[p.0].at);
        self.check.separation(a, b) == Some(None)
    }

    /// HP0208, HP0209: a second axis without a first, or parallel to it.
    pub fn check_axes(&mut self, [axis, axis2]: [Option<Direction>; 2]) {
        let model = self.model();
        match (axis, axis2) {
            (None, Some(_)) => {
                let message = format!("`{}` has `axis2`, but no `axis`", self.name);
                self.fault("HP0208", "axis2", message).help("add `axis`, the direction of its z axis");
            }
            (Some(z), Some(x)) => {
                let (Some(z), Some(x)) = (model.vector(z).unit(), model.vector(x).unit()) else { return };
                if z.cross(x).norm() <= PERPENDICULAR_TOLERANCE {
                    let message = format!("the axes of `{}` are parallel to each other", self.name);
                    self.fault("HP0209", "axis2", message).help("give two different directions");
                }
            }
            (Some(_) | None, None) => {}
        }
    }

    /// HP0252: stiffnesses that break the rule, or a matrix that is not positive definite, or semidefinite where the
    /// stiffnesses may be zero.
    pub fn check_stiffness(&mut self, law: &ElasticLaw<'_>, rule: StiffnessRule) {
        let gives = law.gives();
        // Curves may have any slope in the design configuration.
        let is_linear = |k: &usize| gives[*k] && law.directions[*k].curve.is_none();
        let linear: Vec<usize> = (0..DIRECTIONS).filter(is_linear).collect();
        let stiffness = |r: usize, k: usize| law.stiffnesses(r, k).map(|n| self.value(n)).sum();
        let row = |r: &usize| linear.iter().map(|k| stiffness(*r, *k)).collect();
        let matrix: Vec<Vec<f64>> = linear.iter().map(row).collect();
        let keeps = |n: NumberId| match rule {
            StiffnessRule::Positive => self.value(n) > 0.0,
            StiffnessRule::NotNegative => self.value(n) >= 0.0,
        };
        let bad = (0..DIRECTIONS).find(|k| !law.directions[*k].stiffness.is_none_or(keeps));
        let (is_valid, [adjective, of_matrix]) = match rule {
            StiffnessRule::Positive => (is_definite(&matrix), ["not positive", "definite"]),
            StiffnessRule::NotNegative => (is_semidefinite(&matrix), ["negative", "semidefinite"]),
        };
        if let Some(k) = bad {
            let key = DIRECTION_NAMES[k];
            let message = format!("stiffness `{key}` of `{}` is {adjective}", self.name);
            let help = match (rule, law.directions[k].curve) {
                (_, Some(_)) => format!(
                    "give a positive stiffness, or remove `{key}`: the direction then deflects by `{}` alone",
                    CURVES[k]
                ),
                (StiffnessRule::Positive, None) => {
                    format!("give a positive stiffness, or remove `{key}` to make that direction rigid")
                }
                (StiffnessRule::NotNegative, None) => "give a positive stiffness, or 0".to_owned(),
            };
            self.fault("HP0252", key, message).help(help);
        } else if law.coupled.is_some() && !is_valid {
            let message = format!("the stiffness matrix of `{}` is not positive {of_matrix}", self.name);
            self.fault("HP0252", "matrix", message)
                .note("it counts with the stiffnesses along and about single axes on its diagonal")
                .help("increase the diagonal, or reduce the entries beside it");
        }
    }

    /// HP0251, HP0252: factors without a curve, and curves that fall by more than the stiffness at zero deflection.
    pub fn check_curves(&mut self, law: &ElasticLaw<'_>) {
        for (k, of) in law.directions.iter().enumerate() {
            self.check_scale(of.scale.map(Plain), SCALES[k], of, CURVES[k]);
            let Some(curve) = of.curve else { continue };
            let stiffness: f64 = law.stiffnesses(k, k).map(|n| self.value(n)).sum();
            let factor = of.scale.map_or(1.0, |n| self.value(n));
            if stiffness + factor * curve.nominal(0.0)[1] < 0.0 {
                let message = format!("`{}` of `{}` falls at zero deflection", CURVES[k], self.name);
                self.fault("HP0252", CURVES[k], message)
                    .note("the force would push the second body away from where it is without load")
                    .help(format!(
                        "give points whose force grows with the deflection there, or a larger stiffness `{}`",
                        DIRECTION_NAMES[k]
                    ));
            }
        }
    }

    /// HP0251: a factor without the curve that it multiplies.
    pub fn check_scale(
        &mut self,
        scale: Option<Plain>,
        key: &'static str,
        law: &Elasticity<'_>,
        curve: &str,
    ) {
        if scale.is_some() && law.curve.is_none() {
            let message = format!("`{}` has a `{key}`, but no `{curve}`", self.name);
            self.fault("HP0251", key, message).help(format!("add `{curve}`, or remove `{key}`"));
        }
    }

    /// True if a law is the same for all directions of its x and y axes perpendicular to z, in every design.
    pub fn is_even_across(&self, law: &ElasticLaw<'_>) -> bool {
        let formula = |n: NumberId| self.check.expression_of(n);
        let k = |r: usize, c: usize| law.stiffnesses(r, c).map(|n| self.value(n)).sum::<f64>();
        let across = [0, 1, 3, 4];
        // A symmetric matrix that no rotation about z changes.
        let is_round = k(0, 0) == k(1, 1) && k(3, 3) == k(4, 4) && k(0, 3) == k(1, 4) && k(0, 4) == -k(1, 3);
        let is_plain = [(0, 1), (3, 4)].iter().all(|&(r, c)| k(r, c) == 0.0)
            && across.iter().all(|r| k(*r, 2) == 0.0 && k(*r, 5) == 0.0);
        // Numbers that are the same in this design may differ in others.
        let entries = law.coupled.iter().flat_map(|matrix| &matrix.entries);
        let mut entries = entries.filter(|e| across.contains(&e.row) || across.contains(&e.column));
        let own = |k: usize| law.directions[k].stiffness.and_then(formula);
        let are_constant =
            own(0) == own(1) && own(3) == own(4) && entries.all(|e| formula(e.value).is_none());
        // A cubic law along both axes has another force between them.
        let is_zero = |n: NumberId| self.value(n) == 0.0 && formula(n).is_none();
        let is_linear = |k: &usize| {
            let of = &law.directions[*k];
            of.curve.is_none() && [of.cubic, of.preload].into_iter().flatten().all(is_zero)
        };
        is_round && is_plain && are_constant && across.iter().all(is_linear)
    }

    /// Example of the `axis2` of this axis: the global axis that is closest to perpendicular to it.
    pub fn example_of_axis2(&self, axis: Direction) -> String {
        let [x, y, z] = self.model().vector(axis).to_array().map(f64::abs);
        let example = if x <= y && x <= z {
            "x"
        } else if y <= z {
            "y"
        } else {
            "z"
        };
        format!("`axis2 = \"{example}\"`")
    }

    /// HP0251: mass on ground.
    pub fn check_mass_on(&mut self, body: BodyId, key: &'static str) {
        if body == GROUND {
            let message = format!("mass `{}` is on ground, where it has no effect", self.name);
            self.fault("HP0251", key, message).help("put it on the body that it belongs to, or remove it");
        }
    }

    /// HP0252: parameters of a mass, or of the friction, that are not positive.
    pub fn check_positive(&mut self, of: &str, numbers: impl IntoIterator<Item = (NumberId, &'static str)>) {
        for (number, key) in numbers {
            if !(self.value(number) > 0.0) {
                let message = format!("the {key} of `{}` is not positive", self.name);
                self.fault("HP0252", key, message)
                    .help(format!("give a positive number, or remove the {of}"));
            }
        }
    }

    /// HP0251: coordinate of the wrong quantity; `other` is the type of spring for it.
    pub fn check_coordinate(&mut self, at: (JointId, usize), quantity: Quantity, other: &str) {
        let joint = &self.model().joints[at.0.0];
        let found = &joint.kind.coordinates[at.1];
        if found.quantity != quantity {
            let message =
                format!("`{}` cannot act on the {} of joint `{}`", self.name, found.name, joint.name);
            self.fault("HP0251", "joint", message)
                .help(format!("write `type = \"{other}\"`, or name another coordinate"));
        }
    }

    /// HP0251: friction in a joint of the wrong type.
    pub fn report_friction_joint(&mut self, joint: JointId, what: &str, help: &str) {
        let joint = &self.model().joints[joint.0].name;
        let message = format!("`{}` acts in joint `{joint}`, which is not a {what}", self.name);
        self.fault("HP0251", "joint", message).help(help);
    }

    /// HP0252: friction parameters that are not positive, and negative viscous friction, which would drive the motion.
    fn check_friction(&mut self, friction: &JointFriction) {
        let JointFriction { coefficient, radius, length, viscous, transition_velocity, .. } = *friction;
        let others = [(radius, "radius"), (length, "length"), (transition_velocity, "transition_velocity")];
        let others = others.into_iter().filter_map(|(n, key)| Some((n?, key)));
        self.check_positive("friction", [(coefficient, "coefficient")].into_iter().chain(others));
        if viscous.is_some_and(|n| !(self.value(n) >= 0.0)) {
            let message = format!("`viscous` of `{}` is negative", self.name);
            self.fault("HP0252", "viscous", message).help("correct it, or leave it out");
        }
    }
}
