//! Checks of design variables.

use std::collections::BTreeSet;

use crate::design::{Interpolation, ShapeField};
use crate::draft::{ChangeDraft, DirectionDraft, DraftLocation, Section, ShapeDraft, VariableDraft};
use crate::model::change;
use crate::model::{BodyId, Change, DesignVariable, Direction, End, HardpointId, JointId, ParameterId};
use crate::space::Vec3;

use super::{Checker, Here, SAME_POINT, UNPLACED};

impl Checker<'_> {
    pub(super) fn add_variables(&mut self) {
        let draft = self.draft;
        for (index, v) in draft.design.iter().enumerate() {
            let here = Here { section: Section::Design, index };
            if v.changes.is_empty() && !draft.unread.any(Section::Design, index) {
                let message = format!("design variable `{}` has no effect", v.name);
                self.fault("HP0217", here.key("name"), message)
                    .help("name a hardpoint to move or a joint to tilt, or give a velocity field");
            }
            let mut changes = Vec::new();
            for (k, change) in v.changes.iter().enumerate() {
                changes.extend(self.change(change, &v.name, here, k).unwrap_or_default());
            }
            let parameter = |name: &str| Some(draft.parameters[self.number_of("parameter", name)?].quantity);
            let quantity = ChangeDraft::quantity_of(&v.changes, parameter, |driver| {
                let driver = self.model.drivers.iter().find(|d| d.name == driver)?;
                Some((&driver.law, self.model.driven(driver).quantity))
            });
            self.check_bounds(v, here);
            self.model.variables.push(DesignVariable {
                name: v.name.clone(),
                quantity,
                changes,
                fixed_length: v.fixed_length,
                bounds: v.bounds,
                typical: v.typical,
                tolerance: v.tolerance,
            });
        }
    }

    /// HP0229: bounds that do not enclose the nominal design, or an invalid typical size or tolerance.
    fn check_bounds(&mut self, v: &VariableDraft, here: Here) {
        // Bounds of a parameter are relative to its value.
        if let Some([low, high]) = v.bounds.filter(|_| !self.unread(here, "value")) {
            if !(low < high && low.is_finite() && high.is_finite()) {
                let message =
                    format!("the bounds of design variable `{}` are not in ascending order", v.name);
                self.fault("HP0229", here.key("bounds"), message)
                    .help("give the lower bound first, then the upper");
            } else if !(low <= 0.0 && high >= 0.0) {
                let message = format!("the nominal design is outside the bounds of `{}`", v.name);
                self.fault("HP0229", here.key("bounds"), message).help(
                    "give bounds that enclose the nominal value: the value of a parameter, 0 for other design variables",
                );
            }
        }
        let is_invalid = |size: Option<f64>| size.is_some_and(|size| !(size > 0.0 && size.is_finite()));
        if is_invalid(v.typical) {
            let message = format!("the typical size of design variable `{}` is not positive", v.name);
            self.fault("HP0229", here.key("typical"), message)
                .help("give the size of a typical change, or remove `typical`");
        }
        if is_invalid(v.tolerance) {
            let message = format!("the tolerance of design variable `{}` is not positive", v.name);
            self.fault("HP0229", here.key("tolerance"), message)
                .help("give the half width of the tolerance, or remove `tolerance`");
        }
    }

    /// Resolves a velocity field over whole bodies: hardpoints of joints and points move, axes along vectors rotate,
    /// axes through hardpoints follow their hardpoints.
    fn shape(
        &mut self,
        bodies: &[String],
        field: &ShapeDraft,
        owner: &str,
        here: Here,
        k: usize,
    ) -> Option<Vec<Change>> {
        let at = here.item("changes", k);
        let bodies: Vec<_> = bodies.iter().map(|b| self.body(b, at.clone())).collect();
        let field = self.shape_field(field, owner, here);
        let (bodies, field) = (bodies.into_iter().collect::<Option<Vec<BodyId>>>()?, field?);
        let (mut moved, mut rotated): (BTreeSet<usize>, Vec<JointId>) = Default::default();
        // What carries a driver only names points, which are among those of the bodies below.
        for (j, joint) in self.model.joints.iter().enumerate().filter(|(_, joint)| !joint.unnamed) {
            let mut is_on = joint.bodies.map(|b| bodies.contains(&b));
            // A joint stays closed: both its markers move, unless a rod lies between them.
            if !joint.kind.is_rod() {
                is_on = [is_on[0] || is_on[1]; 2];
            }
            let ends = joint.at.iter().zip(is_on).filter(|(h, is_on)| *is_on && **h != UNPLACED);
            moved.extend(ends.map(|(h, _)| h.0));
            if !is_on[0] {
                continue;
            }
            let axes = [joint.axis, joint.axis2].into_iter().flatten();
            moved.extend(axes.clone().filter_map(Direction::hardpoints).flatten().map(|h| h.0));
            if axes.clone().any(|a| matches!(a, Direction::Along(_))) {
                rotated.push(JointId(j));
            }
        }
        let points = self.model.points.iter().filter(|p| bodies.contains(&p.body) && p.at != UNPLACED);
        moved.extend(points.map(|p| p.at.0));
        let size = self.extent.size();
        let mut changes = Vec::new();
        for h in moved {
            let [velocity, _] = field.at(self.position(HardpointId(h))?);
            if velocity.norm() > SAME_POINT * size.min(1.0) && !self.curve_points.contains(&HardpointId(h)) {
                changes.push(change::Move { hardpoint: HardpointId(h), velocity }.into());
            }
        }
        for joint in rotated {
            let place = self.model.joints[joint.0].at[0];
            let [_, rotation] = field.at(self.position(place)?);
            if rotation.norm() > SAME_POINT {
                let (end, position) = (End::Both, Vec3::ZERO);
                changes.push(change::Marker { joint, end, position, rotation }.into());
            }
        }
        if changes.is_empty() && !self.joint_ids.contains(&None) {
            let message = format!(
                "the velocity field of design variable `{owner}` moves no joint or point of its bodies"
            );
            self.fault("HP0217", at, message).help(
                "give a field that is not zero at a joint or point of these bodies, or name other bodies",
            );
            return None;
        }
        Some(changes)
    }

    /// Resolves a velocity field over whole bodies.
    fn shape_field(&mut self, field: &ShapeDraft, owner: &str, here: Here) -> Option<ShapeField> {
        let key = || here.key("field");
        Some(match field {
            ShapeDraft::Translate(v) => {
                let (_, along) = self.line(&DirectionDraft::Along(*v), owner, here, "field")?;
                ShapeField::Translate(along)
            }
            ShapeDraft::Rotate { about, at } => {
                let through = self.hardpoint(at, key()).and_then(|h| self.position(h));
                let (_, axis) = self.line(about, owner, here, "field")?;
                ShapeField::Rotate { axis, through: through? }
            }
            ShapeDraft::Scale { from, along } => {
                let from = self.hardpoint(from, key()).and_then(|h| self.position(h));
                let along = match along {
                    Some(line) => Some(self.line(line, owner, here, "field")?.1),
                    None => None,
                };
                ShapeField::Scale { from: from?, along }
            }
            ShapeDraft::Bend { from, to, towards } => {
                let ends = [from, to].map(|name| self.hardpoint(name, key()).and_then(|h| self.position(h)));
                let [from, to] = [ends[0]?, ends[1]?];
                let along =
                    (to - from).unit().filter(|_| (to - from).norm() > SAME_POINT * self.extent.size());
                let normal = along.and_then(|e| (*towards - e * e.dot(*towards)).unit());
                let Some(towards) = normal else {
                    let message = format!("the bend of design variable `{owner}` has no direction");
                    self.fault("HP0205", key(), message)
                        .note("its two hardpoints coincide, or `towards` is parallel to the line between them")
                        .help("name two different hardpoints, and a direction that is not parallel to their line");
                    return None;
                };
                ShapeField::Bend { from, to, towards }
            }
            ShapeDraft::Through(moves) => {
                let points: Vec<_> = moves
                    .iter()
                    .map(|(name, _)| self.hardpoint(name, key()).and_then(|h| self.position(h)))
                    .collect();
                let points: Vec<Vec3> = points.into_iter().collect::<Option<_>>()?;
                let velocities: Vec<Vec3> = moves.iter().map(|(_, v)| *v).collect();
                let found = Interpolation::new(&points, &velocities);
                let moves =
                    velocities.iter().any(|v| v.norm() > 0.0) && velocities.iter().all(|v| v.is_finite());
                let Some(found) = found.filter(|_| moves) else {
                    let message = format!("the points of design variable `{owner}` define no velocity field");
                    self.fault("HP0217", key(), message)
                        .note("none of them moves, or two of them coincide and move differently")
                        .help("give different points, each with its displacement per unit");
                    return None;
                };
                ShapeField::Through(found)
            }
        })
    }

    /// Resolves a change. HP0204, HP0218, HP0225 or HP0226 if a reference is unknown or cannot change in this way.
    fn change(&mut self, change: &ChangeDraft, owner: &str, here: Here, k: usize) -> Option<Vec<Change>> {
        // One match: each kind of change has one case, with the checks of its own fields.
        let at = here.item("changes", k);
        let change = match change {
            ChangeDraft::Move { hardpoint: name, velocity } => {
                let hardpoint = self.moved_hardpoint(name, owner, at.clone())?;
                self.check_not_zero(vectors(&[*velocity]), owner, at);
                change::Move { hardpoint, velocity: *velocity }.into()
            }
            ChangeDraft::Tilt { joint, about } => {
                let joint = self.joint(joint, at)?;
                let (_, rotation) = self.line(about, owner, here, "about")?;
                change::Marker { joint, end: End::Both, position: Vec3::ZERO, rotation }.into()
            }
            ChangeDraft::Play { joint, along } => {
                let joint = self.joint_with_play(joint, *along, owner, at)?;
                let position = self.model.joints[joint.0].frames[1].cols[*along];
                change::Marker { joint, end: End::J, position, rotation: Vec3::ZERO }.into()
            }
            ChangeDraft::Marker { joint, end, position, rotation } => {
                let joint = self.joint(joint, at.clone())?;
                self.check_not_zero(vectors(&[*position, *rotation]), owner, at);
                change::Marker { joint, end: *end, position: *position, rotation: *rotation }.into()
            }
            ChangeDraft::Length { joint, rate } => {
                let joint = self.joint(joint, at.clone())?;
                self.check_not_zero(number(*rate), owner, at.clone());
                self.check_has_length(joint, at)?;
                change::Length { joint, rate: *rate }.into()
            }
            ChangeDraft::Parameter { parameter, rate } => {
                let names = self.draft.parameters.iter().map(|p| p.name.as_str());
                let parameter = self.find("parameter", parameter, at.clone(), names).map(ParameterId)?;
                self.check_not_zero(number(*rate), owner, at);
                change::Parameter { parameter, rate: *rate }.into()
            }
            ChangeDraft::Law { driver, parameter, rate } => {
                let [k, parameter] = self.law_parameter(driver, parameter, at.clone(), here)?;
                self.check_not_zero(number(*rate), owner, at);
                // A faulty driver has been reported.
                let driver = self.driver_ids[k]?;
                change::Law { driver, parameter, rate: *rate }.into()
            }
            ChangeDraft::Shape { bodies, field } => return self.shape(bodies, field, owner, here, k),
            ChangeDraft::Field { joint, body, v, u } => {
                let joint = self.joint(joint, at.clone());
                let body = self.body(body, at.clone());
                let (joint, body) = (joint?, body?);
                self.check_not_zero(vectors(&[*v, *u]), owner, at.clone());
                self.check_is_connected(joint, body, at)?;
                change::Field { joint, body, v: *v, u: *u }.into()
            }
        };
        Some(vec![change])
    }

    /// Returns a hardpoint that a variable moves. HP0226 if it is a point of a curve.
    fn moved_hardpoint(&mut self, name: &str, owner: &str, at: DraftLocation) -> Option<HardpointId> {
        let hardpoint = self.hardpoint(name, at.clone())?;
        if self.curve_points.contains(&hardpoint) {
            let message = format!("design variable `{owner}` moves `{name}`, a point of a curve");
            self.fault("HP0226", at, message)
                .note("the shape of a curve cannot be a design variable; its position and direction can")
                .help("write the curve's points as coordinates, and move the hardpoint that carries it");
            return None;
        }
        Some(hardpoint)
    }

    /// Returns a joint with play along an axis of its marker. HP0275 if it has none.
    fn joint_with_play(
        &mut self,
        name: &str,
        along: usize,
        owner: &str,
        at: DraftLocation,
    ) -> Option<JointId> {
        let joint = self.joint(name, at.clone())?;
        let kind = self.model.joints[joint.0].kind;
        if !kind.play().contains(&along) {
            let message = format!("joint `{name}` of design variable `{owner}` has no play");
            let note =
                format!("it is a {} joint; revolute, cylindrical and spherical joints have play", kind.name);
            self.fault("HP0275", at, message)
                .note(note)
                .help("name a joint with a pin or ball, or move a marker with `markers`");
            return None;
        }
        Some(joint)
    }

    /// HP0225: a joint without a given length that could change.
    fn check_has_length(&mut self, joint: JointId, at: DraftLocation) -> Option<()> {
        let j = &self.model.joints[joint.0];
        if j.length.is_none() {
            let (name, kind) = (j.name.clone(), j.kind.name);
            let message = format!("joint `{name}` has no `length` that can change");
            let fault = self.fault("HP0225", at, message);
            fault.note(format!(
                "its type is `{kind}`; without `length`, the length of a rod is the distance between its hardpoints"
            ));
            fault.help(format!("give rod `{name}` a `length`, or move one of its hardpoints"));
            return None;
        }
        Some(())
    }

    /// Returns the numbers of a driver and of a parameter of its law.
    fn law_parameter(
        &mut self,
        driver: &str,
        parameter: &str,
        at: DraftLocation,
        here: Here,
    ) -> Option<[usize; 2]> {
        let draft = self.draft;
        let names = draft.drivers.iter().map(|d| d.name.as_str());
        let k = self.find("driver", driver, at, names)?;
        if draft.unread.has(Section::Drivers, k, "law") {
            return None;
        }
        let parameters = draft.drivers[k].law.parameters();
        let names = parameters.iter().map(|p| p.name.as_str());
        let what = format!("parameter of the law of `{driver}`");
        Some([k, self.find(&what, parameter, here.key("parameter"), names)?])
    }

    /// HP0218: a body that a joint does not connect.
    fn check_is_connected(&mut self, joint: JointId, body: BodyId, at: DraftLocation) -> Option<()> {
        let bodies = self.model.joints[joint.0].bodies;
        if !bodies.contains(&body) {
            let names = bodies.map(|b| format!("`{}`", self.model.bodies[b.0].name)).join(" and ");
            let message = format!(
                "joint `{}` has no marker on body `{}`",
                self.model.joints[joint.0].name, self.model.bodies[body.0].name
            );
            self.fault("HP0218", at, message).note(format!("it connects {names}"));
            return None;
        }
        Some(())
    }

    /// HP0217: a change with zero velocity.
    fn check_not_zero(&mut self, does_something: bool, owner: &str, at: DraftLocation) {
        if !does_something {
            let message = format!("a velocity of design variable `{owner}` is zero or not finite");
            self.fault("HP0217", at, message);
        }
    }
}

/// True if all velocities are finite and one of them is not zero.
fn vectors(velocities: &[Vec3]) -> bool {
    velocities.iter().all(|v| v.is_finite()) && velocities.iter().any(|v| v.norm() >= 1e-12)
}

/// True if a rate is finite and not zero.
fn number(rate: f64) -> bool {
    rate.is_finite() && rate != 0.0
}
