//! Checks of masses and forces: references and parameters.

use crate::draft::measure::Field;
use crate::draft::{ElementDraft, FieldDraft, FieldKind, NumberDraft, Section};
use crate::joint::{Freedom, Quantity, Slide};
use crate::law::Law;
use crate::model::{
    Angle, Axes, CubicStiffness, Damping, Density, Element, ElementKind, ElementUnit, Force, GROUND, Inertia,
    JointId, Length, Mass, Moment, NumberId, Plain, PointId, SpringTable, Stiffness, TorsionalDamping,
    TorsionalStiffness, about_centre, each_number,
};
use crate::space::Vec3;

use super::{Checker, Here, MeasureCheck};

/// Minimum sine of the angle between two directions that count as not parallel.
const ACROSS: f64 = 1e-3;

/// Relative tolerance by which a moment of inertia may exceed the sum of the other two: rounding of the typed digits of
/// a flat plate.
const FLAT: f64 = 1e-3;

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
        let kind = e.kind.resolve(&mut MeasureCheck::new(self, &e.name, here))?;
        match &kind {
            ElementKind::Rigid { centre, about, .. } => {
                self.check_on_moving(*centre, &e.name, here, "centre");
                if about.is_some_and(|about| self.body_of(about) != self.body_of(*centre)) {
                    let message = format!("`about` of `{}` is not on the body of its centre", e.name);
                    self.fault("HP0251", here.key("about"), message)
                        .help("put both points on the body that has the mass");
                }
            }
            ElementKind::Block { centre, .. } => self.check_on_moving(*centre, &e.name, here, "centre"),
            ElementKind::Mesh { body, .. } => {
                if *body == GROUND {
                    self.report_mass_on_ground(&e.name, here, "body");
                }
            }
            ElementKind::Bar { from, to, .. } => {
                self.check_on_moving(*from, &e.name, here, "from");
                if self.body_of(*from) != self.body_of(*to) {
                    let message = format!("the ends of `{}` are on different bodies", e.name);
                    self.fault("HP0251", here.key("to"), message)
                        .help("put both ends on the body that has the mass");
                } else if self.coincide(*from, *to) {
                    let message = format!("the ends of `{}` coincide", e.name);
                    self.fault("HP0251", here.key("to"), message).help("give two different ends");
                }
            }
            ElementKind::Spring { from, to, stiffness, free_length, preload, .. } => {
                if self.body_of(*from) == self.body_of(*to) {
                    let message =
                        format!("both ends of `{}` are on the same body, where it has no effect", e.name);
                    self.fault("HP0251", here.key("to"), message)
                        .help("put its ends on two different bodies; `ground` is also a body");
                } else if self.coincide(*from, *to) {
                    let message = format!("the ends of `{}` coincide", e.name);
                    self.fault("HP0251", here.key("to"), message)
                        .note("a spring of zero length has no direction")
                        .help("move its ends apart, or use a `bushing`");
                }
                self.check_spring_keys(&kind, &e.name, here);
                let table = kind.table().is_some();
                if stiffness.is_none() && !table {
                    let message = format!("`{}` has neither a stiffness nor a table", e.name);
                    self.fault("HP0251", here.key("type"), message).help(
                        "give its `stiffness`, or its force over its deflection as `compression` or `extension`",
                    );
                } else if preload.is_some() && table {
                    let message = format!("`{}` has both a table and a `preload`", e.name);
                    self.fault("HP0251", here.key("preload"), message)
                        .note("without a `free_length` the deflection counts from the design configuration, and the table's force at 0 acts there")
                        .help("remove `preload` and shift the table by it, or give the `free_length`");
                } else if free_length.is_some() && preload.is_some() {
                    let message = format!("`{}` has both a `free_length` and a `preload`", e.name);
                    self.fault("HP0251", here.key("preload"), message)
                        .help("remove one of the two: each follows from the other and the stiffness");
                }
            }
            ElementKind::Bushing { from, to, .. } => {
                if self.body_of(*from) == self.body_of(*to) {
                    let message = format!("both sides of `{}` are on the same body", e.name);
                    self.fault("HP0251", here.key("to"), message)
                        .help("put them on two different bodies; `ground` is also a body");
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
                    let message =
                        format!("`{}` cannot act on the {} of joint `{}`", e.name, found.name, joint.name);
                    self.fault("HP0251", here.key("joint"), message)
                        .help(format!("write `type = \"{other}\"`, or name another coordinate"));
                }
            }
            ElementKind::Friction { joint, coefficient, radius, length, viscous, transition_velocity } => {
                let kind = self.model.joints[joint.0].kind;
                if !kind.is_hinge && !kind.is_ball() {
                    let help = match (kind.slide, kind.freedoms) {
                        (Slide::Block, _) => "write `type = \"slide_friction\"` for a slide",
                        (_, Some([Freedom::Turn(_), Freedom::Turn(_)])) => {
                            "replace the universal joint by two revolute joints with a body between them; for viscous friction alone use the `damping` of a `torsion_spring`"
                        }
                        _ => {
                            "name a revolute, cylindrical or spherical joint; for viscous friction of others use the `damping` of a `torsion_spring`"
                        }
                    };
                    self.report_friction_joint(&e.name, *joint, "hinge or ball joint", here, help);
                } else if length.is_some() && kind.is_ball() {
                    let message =
                        format!("`{}` has a `length`, which does not apply to a spherical joint", e.name);
                    self.fault("HP0251", here.key("length"), message).help("remove `length`");
                }
                let numbers = [(coefficient.0, "coefficient"), (radius.0, "radius")];
                let length = length.map(|n| (n.0, "length"));
                let transition_velocity = transition_velocity.map(|n| (n.0, "transition_velocity"));
                self.check_positive(
                    numbers.into_iter().chain(length).chain(transition_velocity),
                    &e.name,
                    here,
                );
                self.check_not_negative(viscous.map(|n| n.0), "viscous", &e.name, here);
            }
            ElementKind::SlideFriction {
                joint,
                coefficient,
                length,
                ignored_direction,
                viscous,
                transition_velocity,
            } => {
                let kind = self.model.joints[joint.0].kind;
                if kind.slide != Slide::Block {
                    let help = if kind.is_hinge || kind.is_ball() {
                        "write `type = \"friction\"` for a hinge or ball joint"
                    } else {
                        "name a translational or cylindrical joint; for viscous friction of others use the `damping` of a `joint_spring`"
                    };
                    self.report_friction_joint(&e.name, *joint, "slide", here, help);
                } else if let Some(normal) = ignored_direction {
                    let z = self.model.joints[joint.0].frames[0].cols[2];
                    if normal.cross(z).norm() < ACROSS {
                        let message =
                            format!("`ignored_direction` of `{}` is parallel to its sliding axis", e.name);
                        self.fault("HP0251", here.key("ignored_direction"), message)
                            .help("give a direction across the sliding axis, or remove `ignored_direction`");
                    }
                }
                let length = length.map(|n| (n.0, "length"));
                let transition_velocity = transition_velocity.map(|n| (n.0, "transition_velocity"));
                self.check_positive(
                    [(coefficient.0, "coefficient")].into_iter().chain(length).chain(transition_velocity),
                    &e.name,
                    here,
                );
                self.check_not_negative(viscous.map(|n| n.0), "viscous", &e.name, here);
            }
            ElementKind::WheelForce { wheel, outboard, forward, up, .. } => {
                if [outboard, forward, up].iter().all(|n| n.is_none()) {
                    let message = format!("`{}` has no force", e.name);
                    self.fault("HP0251", here.key("type"), message)
                        .help("give its force `up`, `outboard` or `forward`, or remove it");
                }
                if self.model.wheels[wheel.0].body == GROUND {
                    let message = format!("`{}` acts on a wheel of ground, which does not move", e.name);
                    self.fault("HP0251", here.key("wheel"), message).help("name a wheel of another body");
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
                    let message = format!("a stiffness of `{}` is not positive", e.name);
                    self.fault("HP0252", here.key("joint"), message)
                        .help("give a positive stiffness, or remove the key to make that direction rigid");
                }
                if self.model.joints[joint.0].kind.places == 0 {
                    let message = format!(
                        "joint `{}` has no location at which it could deflect",
                        self.model.joints[joint.0].name
                    );
                    self.fault("HP0251", here.key("joint"), message).help("name a joint with a location");
                }
            }
            ElementKind::PointForce { at, .. } => {
                if self.body_of(*at) == GROUND.0 {
                    let message = format!("`{}` acts on ground, which does not move", e.name);
                    self.fault("HP0251", here.key("at"), message).help("apply it to a point of another body");
                }
            }
            ElementKind::BodyMoment { body, .. } => {
                if *body == GROUND {
                    let message = format!("`{}` acts on ground, which does not move", e.name);
                    self.fault("HP0251", here.key("body"), message).help("apply it to another body");
                }
            }
        }
        self.check_mass_parameters(&kind, &e.name, here);
        self.check_inertia(&kind, &e.name, here);
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

    fn coincide(&self, a: PointId, b: PointId) -> bool {
        let [a, b] = [a, b].map(|p| self.model.points[p.0].at);
        self.separation(a, b) == Some(None)
    }

    fn check_on_moving(&mut self, point: PointId, name: &str, here: Here, key: &'static str) {
        if self.body_of(point) == GROUND.0 {
            self.report_mass_on_ground(name, here, key);
        }
    }

    fn report_mass_on_ground(&mut self, name: &str, here: Here, key: &'static str) {
        let message = format!("mass `{name}` is on ground, where it has no effect");
        self.fault("HP0251", here.key(key), message)
            .help("put it on the body that it belongs to, or remove it");
    }

    /// HP0251: friction in a joint of the wrong type.
    fn report_friction_joint(&mut self, name: &str, joint: JointId, what: &str, here: Here, help: &str) {
        let message =
            format!("`{name}` acts in joint `{}`, which is not a {what}", self.model.joints[joint.0].name);
        self.fault("HP0251", here.key("joint"), message).help(help);
    }

    /// HP0252: friction parameters that are not positive.
    fn check_positive(
        &mut self,
        numbers: impl Iterator<Item = (NumberId, &'static str)>,
        name: &str,
        here: Here,
    ) {
        for (number, key) in numbers {
            if !(self.value(number) > 0.0) {
                let message = format!("the {key} of `{name}` is not positive");
                self.fault("HP0252", here.key(key), message)
                    .help("give a positive number, or remove the friction");
            }
        }
    }

    /// HP0252: a negative friction parameter, which would drive the motion.
    fn check_not_negative(&mut self, number: Option<NumberId>, key: &'static str, name: &str, here: Here) {
        if number.is_some_and(|n| !(self.value(n) >= 0.0)) {
            let message = format!("`{key}` of `{name}` is negative");
            self.fault("HP0252", here.key(key), message).help("correct it, or leave it out");
        }
    }

    /// Returns the table of a spring, as tension over extension.
    pub(super) fn spring_table(
        &mut self,
        points: &[[f64; 2]],
        name: &str,
        here: Here,
        key: &'static str,
    ) -> Option<SpringTable> {
        let is_compression = key == "compression";
        let table =
            SpringTable::new(&if is_compression { SpringTable::turned(points) } else { points.to_vec() });
        if let Err(why) = &table {
            let message = format!("the table of `{name}` {why}");
            self.fault("HP0252", here.key(key), message)
                .help("give at least two points `[deflection, force]`, with increasing deflections");
        }
        table.ok()
    }

    /// HP0251: contradictory keys of a spring.
    fn check_spring_keys(&mut self, kind: &ElementKind, name: &str, here: Here) {
        let ElementKind::Spring { compression, extension, scale, .. } = kind else { return };
        if compression.is_some() && extension.is_some() {
            let message = format!("`{name}` has both `compression` and `extension`");
            self.fault("HP0251", here.key("extension"), message)
                .note("compression is negative extension, and a compressive force is a negative tension")
                .help("combine the two tables in one");
        }
        if scale.is_some() && compression.is_none() && extension.is_none() {
            let message = format!("`{name}` has a `scale`, but no table");
            self.fault("HP0251", here.key("scale"), message)
                .help("remove `scale`, or change its `stiffness`");
        }
    }

    fn value(&self, number: NumberId) -> f64 {
        self.model.numbers[number.0].value
    }

    /// HP0252: mass parameters that are not positive, or an invalid bore.
    fn check_mass_parameters(&mut self, kind: &ElementKind, name: &str, here: Here) {
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
            ElementKind::Mesh { density, .. } => above.push((density.0, "density")),
            ElementKind::Block { x, y, z, density, .. } => {
                above.extend([(x.0, "x"), (y.0, "y"), (z.0, "z"), (density.0, "density")]);
            }
            _ => {}
        }
        for (number, key) in above {
            if !(self.value(number) > 0.0) {
                let message = format!("the {key} of `{name}` is not positive");
                self.fault("HP0252", here.key(key), message)
                    .help("give a positive number, or remove the mass");
            }
        }
    }

    /// HP0252: moments of inertia about the centre that are physically impossible.
    fn check_inertia(&mut self, kind: &ElementKind, name: &str, here: Here) {
        let ElementKind::Rigid { centre, mass, ixx, iyy, izz, ixy, iyz, izx, about } = kind else { return };
        let given = [ixx, iyy, izz].map(|n| n.map(|n| self.value(n.0)));
        let products = [ixy, iyz, izx].map(|n| n.map(|n| self.value(n.0)));
        let offset = about.map_or(Vec3::ZERO, |about| {
            let [c, p] = [*centre, about].map(|p| self.model.position(self.model.points[p.0].at));
            c - p
        });
        let [moments, [d, e, f]] = about_centre(self.value(mass.0), offset, [given, products]);
        let [a, b, c] = moments;
        let shown = || {
            format!(
                "about its centre they are {a:.4}, {b:.4} and {c:.4} kg m^2, with products {d:.4}, {e:.4} and {f:.4}"
            )
        };
        let moved = about.is_some();
        let below = given.iter().zip(["ixx", "iyy", "izz"]).zip(moments);
        let below = below.filter(|((n, _), i)| n.is_some() && !(*i >= 0.0)).map(|((_, key), _)| key).next();
        if let Some(key) = below {
            let message =
                format!("`{key}` of `{name}` is negative{}", if moved { " about its centre" } else { "" });
            let fault = self.fault("HP0252", here.key(key), message);
            if moved {
                fault.note(shown()).help("check `about`, `centre` and the units: moments of inertia about another point are never less than those about the centre of mass");
            } else {
                fault.help("correct it, or leave it out");
            }
            return;
        }
        // If a planar model gives only some of the moments, the others are unknown.
        if given.iter().any(|n| n.is_none()) {
            return;
        }
        let largest = a.max(b).max(c);
        let slack = largest * FLAT;
        // Principal moments obey I1 + I2 >= I3: the matrix (tr I / 2) 1 - I, the second moments of the mass, has no
        // negative eigenvalue.
        let half = 0.5 * (a + b + c);
        let (x, y, z) = (half - a + slack, half - b + slack, half - c + slack);
        let minors = [x, y, z, x * y - d * d, y * z - e * e, z * x - f * f];
        let determinant = x * (y * z - e * e) - d * (d * z - e * f) + f * (d * e - y * f);
        let cubed = slack * slack * slack;
        if !(minors.iter().all(|m| *m >= 0.0) && determinant >= -cubed) {
            let message = format!("the moments of inertia of `{name}` are physically impossible");
            let fault = self.fault("HP0252", here.key("ixx"), message);
            fault.note("each is at most the sum of the other two, about any axes; products of inertia are the integrals of x y, y z and z x");
            if moved {
                fault.note(shown());
            }
            fault.help("give all three about the centre of mass, or give the point as `about`; if the products are entries of the inertia matrix, change their signs");
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
