//! Checks of masses and forces: what they name, and whether such a thing can be.

use crate::draft::measure::Field;
use crate::draft::{ElementDraft, FieldDraft, FieldKind, NumberDraft, Section};
use crate::joint::Quantity;
use crate::law::Law;
use crate::model::{
    Angle, Axes, CubicStiffness, Damping, Density, Element, ElementKind, ElementUnit, Force, GROUND, Inertia,
    Length, Mass, Moment, NumberId, Plain, PointId, Stiffness, TorsionalDamping, TorsionalStiffness,
    each_number,
};

use super::{Checker, Here, MeasureCheck};

/// By so much may a moment of inertia exceed the sum of the other two: what typed digits leave of a flat plate.
const FLAT: f64 = 1e-3;

impl Checker<'_> {
    pub(super) fn elements(&mut self) {
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
        let kind = e.kind.resolve(&mut MeasureCheck::new(self, &e.name, here))?;
        match &kind {
            ElementKind::Rigid { centre, .. } | ElementKind::Block { centre, .. } => {
                self.on_moving(*centre, &e.name, here, "centre");
            }
            ElementKind::Bar { from, to, .. } => {
                self.on_moving(*from, &e.name, here, "from");
                if self.body_of(*from) != self.body_of(*to) {
                    let message = format!("the ends of `{}` are on two bodies", e.name);
                    self.fault("HP0251", here.key("to"), message)
                        .help("give both ends on the body that it belongs to");
                } else if self.at_one_place(*from, *to) {
                    let message = format!("the ends of `{}` are drawn at the same place", e.name);
                    self.fault("HP0251", here.key("to"), message).help("give ends that lie apart");
                }
            }
            ElementKind::Spring { from, to, free_length, preload, .. } => {
                if self.body_of(*from) == self.body_of(*to) {
                    let message = format!("both ends of `{}` are on one body, which it cannot move", e.name);
                    self.fault("HP0251", here.key("to"), message)
                        .help("put its ends on two bodies; `ground` is one");
                } else if self.at_one_place(*from, *to) {
                    let message = format!("the ends of `{}` are drawn at the same place", e.name);
                    self.fault("HP0251", here.key("to"), message)
                        .note("a spring of no length pulls nowhere")
                        .help("put its ends apart, or use a `bushing`");
                }
                if free_length.is_some() && preload.is_some() {
                    let message = format!("`{}` has both a `free_length` and a `preload`", e.name);
                    self.fault("HP0251", here.key("preload"), message)
                        .help("leave one of them out: with the stiffness each follows from the other");
                }
            }
            ElementKind::Bushing { from, to, .. } => {
                if self.body_of(*from) == self.body_of(*to) {
                    let message = format!("both sides of `{}` are on one body", e.name);
                    self.fault("HP0251", here.key("to"), message)
                        .help("put them on two bodies; `ground` is one");
                }
            }
            ElementKind::JointSpring { joint, coordinate, .. }
            | ElementKind::TorsionSpring { joint, coordinate, .. } => {
                let joint = &self.model.joints[joint.0];
                let found = &joint.kind.coordinates[*coordinate];
                let (wanted, other) = match &kind {
                    ElementKind::JointSpring { .. } => (Quantity::Length, "torsion_spring"),
                    _ => (Quantity::Angle, "joint_spring"),
                };
                if found.quantity != wanted {
                    let message = format!(
                        "the {} of joint `{}` is not what `{}` acts on",
                        found.name, joint.name, e.name
                    );
                    self.fault("HP0251", here.key("joint"), message)
                        .help(format!("write `type = \"{other}\"`, or name another coordinate"));
                }
            }
            ElementKind::Friction { joint, coefficient, radius, fades } => {
                let joint = &self.model.joints[joint.0];
                if joint.kind.name != "revolute" {
                    let message = format!("`{}` is in joint `{}`, which is no revolute", e.name, joint.name);
                    self.fault("HP0251", here.key("joint"), message).help(
                        "name a revolute; for viscous friction of others use the `damping` of a spring",
                    );
                }
                let numbers = [(coefficient.0, "coefficient"), (radius.0, "radius")].into_iter();
                for (number, key) in numbers.chain(fades.map(|n| (n.0, "fades"))) {
                    if !(self.value(number) > 0.0) {
                        let message = format!("the {key} of `{}` is not above zero", e.name);
                        self.fault("HP0252", here.key(key), message)
                            .help("correct it, or remove the friction");
                    }
                }
            }
            ElementKind::ElasticJoint { joint, x, y, z, about_x, about_y, about_z } => {
                let numbers = [x, y, z].map(|n| n.map(|n| n.0)).into_iter();
                let numbers = numbers.chain([about_x, about_y, about_z].map(|n| n.map(|n| n.0)));
                let given: Vec<NumberId> = numbers.flatten().collect();
                if given.is_empty() {
                    let message = format!("`{}` is rigid in all directions", e.name);
                    self.fault("HP0251", here.key("type"), message)
                        .help("give it a stiffness along or about one of its axes, or remove it");
                } else if given.iter().any(|n| !(self.value(*n) > 0.0)) {
                    let message = format!("a stiffness of `{}` is not above zero", e.name);
                    self.fault("HP0252", here.key("joint"), message)
                        .help("correct it, or leave that direction out: then it is rigid");
                }
                if self.model.joints[joint.0].kind.places == 0 {
                    let message = format!(
                        "joint `{}` has no place where it could give",
                        self.model.joints[joint.0].name
                    );
                    self.fault("HP0251", here.key("joint"), message)
                        .help("name a joint that stands somewhere");
                }
            }
            ElementKind::PointForce { at, .. } => {
                if self.body_of(*at) == GROUND.0 {
                    let message = format!("`{}` pushes on ground, which does not move", e.name);
                    self.fault("HP0251", here.key("at"), message).help("let it push a point of another body");
                }
            }
            ElementKind::BodyMoment { body, .. } => {
                if *body == GROUND {
                    let message = format!("`{}` turns ground, which does not move", e.name);
                    self.fault("HP0251", here.key("body"), message).help("let it turn another body");
                }
            }
        }
        self.sizes(&kind, &e.name, here);
        self.inertia(&kind, &e.name, here);
        if let Some(law) = kind.law() {
            let times =
                self.draft.times.iter().chain(self.draft.cases.iter().flat_map(|c| c.times.iter().flatten()));
            if let Some(t) = times.copied().find(|t| !law.at(*t).value().is_finite()) {
                let message = format!("the law of `{}` has no finite value at t = {t} s", e.name);
                self.fault("HP0214", here.key("law"), message).help("change the law, or the output times");
            }
        }
        (self.faults.len() == faults).then_some(kind)
    }

    fn body_of(&self, point: PointId) -> usize {
        self.model.points[point.0].body.0
    }

    fn at_one_place(&self, a: PointId, b: PointId) -> bool {
        let [a, b] = [a, b].map(|p| self.model.points[p.0].at);
        self.apart(a, b) == Some(None)
    }

    fn on_moving(&mut self, point: PointId, name: &str, here: Here, key: &'static str) {
        if self.body_of(point) == GROUND.0 {
            let message = format!("mass `{name}` is on ground, where it moves nothing");
            self.fault("HP0251", here.key(key), message)
                .help("put it on the body that it belongs to, or remove it");
        }
    }

    fn value(&self, number: NumberId) -> f64 {
        self.model.numbers[number.0].value
    }

    /// HP0252: numbers that no such thing can have.
    fn sizes(&mut self, kind: &ElementKind, name: &str, here: Here) {
        let mut above = Vec::new();
        match kind {
            ElementKind::Rigid { mass, .. } => above.push((mass.0, "mass")),
            ElementKind::Bar { diameter, density, bore, .. } => {
                above.extend([(diameter.0, "diameter"), (density.0, "density")]);
                if let Some(bore) = bore {
                    let (bore, outer) = (self.value(bore.0), self.value(diameter.0));
                    if !(bore >= 0.0 && bore < outer) {
                        let message = format!("the bore of `{name}` is not less than its diameter");
                        self.fault("HP0252", here.key("bore"), message)
                            .help("give a bore between 0 and the diameter");
                    }
                }
            }
            ElementKind::Block { x, y, z, density, .. } => {
                above.extend([(x.0, "x"), (y.0, "y"), (z.0, "z"), (density.0, "density")]);
            }
            _ => {}
        }
        for (number, key) in above {
            if !(self.value(number) > 0.0) {
                let message = format!("the {key} of `{name}` is not above zero");
                self.fault("HP0252", here.key(key), message).help("correct it, or remove the mass");
            }
        }
    }

    /// HP0252: moments of inertia that no body can have.
    fn inertia(&mut self, kind: &ElementKind, name: &str, here: Here) {
        let ElementKind::Rigid { ixx, iyy, izz, ixy, iyz, izx, .. } = kind else { return };
        // Who gives only those that a plane asks for says nothing of the others.
        if [ixx, iyy, izz].iter().any(|n| n.is_none()) {
            return;
        }
        let of = |n: &Option<Inertia>| n.map_or(0.0, |n| self.value(n.0));
        let [a, b, c, d, e, f] = [ixx, iyy, izz, ixy, iyz, izx].map(of);
        let largest = a.max(b).max(c);
        let slack = largest * FLAT;
        // Principal moments obey I1 + I2 >= I3: the matrix (tr I / 2) 1 - I, the second moments of the mass, has no negative eigenvalue.
        let half = 0.5 * (a + b + c);
        let (x, y, z) = (half - a + slack, half - b + slack, half - c + slack);
        let minors = [x, y, z, x * y - d * d, y * z - e * e, z * x - f * f];
        let determinant = x * (y * z - e * e) - d * (d * z - e * f) + f * (d * e - y * f);
        let cubed = slack * slack * slack;
        if !(minors.iter().all(|m| *m >= 0.0) && determinant >= -cubed) {
            let message = format!("no body can have the moments of inertia of `{name}`");
            self.fault("HP0252", here.key("ixx"), message)
                .note("none is above the sum of the other two, in any axes; products are the integrals of x y, y z and z x")
                .help("take all three about the centre of mass; where the products come as entries of the inertia matrix, change their signs");
        }
    }
}

macro_rules! number_field {
    ($type:ident) => {
        impl Field for $type {
            type Draft = NumberDraft;
            const KIND: FieldKind = FieldKind::Number(ElementUnit::$type);

            fn draft(written: Option<FieldDraft>) -> Option<NumberDraft> {
                if let Some(FieldDraft::Number(draft)) = written { Some(draft) } else { None }
            }

            fn resolve(
                number: &NumberDraft,
                key: &'static str,
                c: &mut MeasureCheck<'_, '_>,
            ) -> Option<Self> {
                c.number(number, key).map(Self)
            }
        }

        impl Field for Option<$type> {
            type Draft = Option<NumberDraft>;
            const KIND: FieldKind = FieldKind::Number(ElementUnit::$type);
            const REQUIRED: bool = false;

            fn draft(written: Option<FieldDraft>) -> Option<Self::Draft> {
                match written {
                    None => Some(None),
                    Some(FieldDraft::Number(draft)) => Some(Some(draft)),
                    Some(_) => None,
                }
            }

            fn resolve(
                number: &Self::Draft,
                key: &'static str,
                c: &mut MeasureCheck<'_, '_>,
            ) -> Option<Self> {
                match number {
                    Some(number) => c.number(number, key).map(|n| Some($type(n))),
                    None => Some(None),
                }
            }
        }
    };
}
each_number!(number_field);

impl Field for Option<Axes> {
    type Draft = Self;
    const KIND: FieldKind = FieldKind::Axes;
    const REQUIRED: bool = false;

    fn draft(written: Option<FieldDraft>) -> Option<Self> {
        match written {
            None => Some(None),
            Some(FieldDraft::Axes(axes)) => Some(Some(axes)),
            Some(_) => None,
        }
    }

    fn resolve(axes: &Self, _: &'static str, _: &mut MeasureCheck<'_, '_>) -> Option<Self> {
        Some(*axes)
    }
}

impl Field for Option<Law> {
    type Draft = Self;
    const KIND: FieldKind = FieldKind::Law;
    const REQUIRED: bool = false;

    fn draft(written: Option<FieldDraft>) -> Option<Self> {
        match written {
            None => Some(None),
            Some(FieldDraft::Law(law)) => Some(Some(law)),
            Some(_) => None,
        }
    }

    fn resolve(law: &Self, _: &'static str, _: &mut MeasureCheck<'_, '_>) -> Option<Self> {
        Some(law.clone())
    }
}
