//! Checks of driven quantities: a coordinate of a joint, or of an unnamed joint made for the driver.

use crate::constraint::{Radius, Row};
use crate::draft::measure::not_drivable;
use crate::draft::{
    DirectionDraft, DraftLocation, DrivenDraft, DriverDraft, MeasureKindDraft, PointRef, RayDraft, Section,
};
use crate::expression::Expression;
use crate::joint;
use crate::joint::JointType;
use crate::model::{
    BodyId, BodyPoint, Direction, Formula, GROUND, HardpointId, Joint, JointId, Source, Target, WheelMeasure,
};
use crate::space::{Mat3, Vec3};

use super::{Checker, Here, frame_along};

/// Quantity that a driver prescribes, resolved.
#[derive(Clone, Copy)]
pub(super) struct Driven {
    pub joint: JointId,
    pub coordinate: usize,
    /// Source of the nominal value, if the law gives absolute values.
    zero: Zero,
}

/// Source of the nominal value of a driver's coordinate.
#[derive(Clone, Copy)]
enum Zero {
    /// No absolute zero, as for the angle of a revolute joint.
    None,
    /// Zero, because the measure itself counts from the design configuration, like wheel travel.
    Nominal,
    /// Constant of the joint in the design configuration: the length of a rod or leg, the angle of an axis.
    Constant,
    /// Position of the joint's hardpoint along its axis.
    Position,
}

/// Axes of an unnamed joint.
struct Axes {
    axis: Direction,
    axis2: Option<Direction>,
    frames: [Mat3; 2],
}

/// Sine of the angle to the line of sight below which a direction has no angle.
const MIN_SINE: f64 = 1e-6;
/// Name of the fixed body.
const GROUND_NAME: &str = "ground";

/// Nominal value of a driver's coordinate as an expression over hardpoints or joint constants.
pub(super) struct NominalValue {
    expression: Expression,
    sources: Vec<Source>,
}

impl NominalValue {
    /// Returns the formula that defines a number of the model by this value.
    pub fn formula(&self, of: Target) -> Formula {
        let inputs = self.sources.iter().map(|s| (*s, 1.0)).collect();
        Formula { of, expression: self.expression.clone(), inputs, per_unit: 1.0 }
    }
}

impl DriverDraft {
    /// True if the laws give the absolute value of the prescribed quantity.
    pub(super) fn counts_from_zero(&self) -> bool {
        self.from_zero || matches!(self.drives, DrivenDraft::Measure(_))
    }
}

impl Checker<'_> {
    /// Returns the joint coordinate that a driver prescribes. Adds an unnamed joint if no joint has it.
    pub(super) fn driven(&mut self, d: &DriverDraft, here: Here) -> Option<Driven> {
        match &d.drives {
            DrivenDraft::Unread => None,
            DrivenDraft::Coordinate { joint, coordinate } => self.driven_coordinate(
                d,
                joint,
                coordinate.as_deref(),
                [here.key("joint"), here.key("coordinate")],
            ),
            DrivenDraft::Position { point, along } => {
                self.driven_position(d, point, along, [here.key("point"), here.key("along")])
            }
            DrivenDraft::Distance { from, to } => {
                self.driven_distance(d, [from, to], [here.key("from"), here.key("to")])
            }
            DrivenDraft::Orientation { body, relative_to, about, axis2 } => {
                let body = self.body(body, here.key("body"));
                let base = match relative_to {
                    Some(name) => self.body(name, here.key("relative_to")),
                    None => Some(GROUND),
                };
                let axes = self.heading_axes(d, about, axis2.as_ref(), here);
                let (body, base, axes) = (body?, base?, axes?);
                let at = self.hardpoint_on(body)?;
                self.driven_joint(d, &joint::HEADING, [base, body], [at, at], Some(axes), Zero::None)
            }
            DrivenDraft::Measure(name) => self.driven_measure(d, name, here),
            DrivenDraft::Contact(wheel) => self.driven_contact(d, wheel, here),
        }
    }

    /// Returns the axes of the angle of a body seen along `about`. HP0209 if `axis2` has no angle in this view.
    fn heading_axes(
        &mut self,
        d: &DriverDraft,
        about: &DirectionDraft,
        axis2: Option<&DirectionDraft>,
        here: Here,
    ) -> Option<Axes> {
        let about = self.line(about, &d.name, here, "about");
        let axis2 = axis2.map(|line| self.line(line, &d.name, here, "axis2"));
        let (axis, z) = about?;
        let Some(axis2) = axis2 else {
            return Some(Axes { axis, axis2: None, frames: [frame_along(z, z.any_perpendicular()); 2] });
        };
        let (axis2, e) = axis2?;
        let across = e - z * z.dot(e);
        let x = across.unit().filter(|_| across.norm() > MIN_SINE);
        if x.is_none() {
            let message = format!("`about` and `axis2` of driver `{}` are parallel to each other", d.name);
            self.fault("HP0209", here.key("axis2"), message).help("give two different directions");
        }
        Some(Axes { axis, axis2: Some(axis2), frames: [frame_along(z, x?); 2] })
    }

    fn driven_coordinate(
        &mut self,
        d: &DriverDraft,
        name: &str,
        coordinate: Option<&str>,
        at: [DraftLocation; 2],
    ) -> Option<Driven> {
        let joint = self.joint(name, at[0].clone())?;
        let coordinate = self.coordinate_at(joint, coordinate, at.clone())?;
        let row = self.model.joints[joint.0].kind.coordinates[coordinate].row;
        let zero = if row == Row::Distance { Zero::Constant } else { Zero::None };
        self.is_drivable(d, name, joint, coordinate, at[0].clone()).then_some(Driven {
            joint,
            coordinate,
            zero,
        })
    }

    fn driven_position(
        &mut self,
        d: &DriverDraft,
        point: &PointRef,
        along: &DirectionDraft,
        at: [DraftLocation; 2],
    ) -> Option<Driven> {
        let [at_point, at_line] = at;
        let point = self.point(point, &d.name, at_point);
        let along = self.line_at(along, &d.name, at_line);
        let (point, (axis, z)) = (point?, along?);
        let BodyPoint { body, at, .. } = self.model.points[point.0];
        let axes = Axes { axis, axis2: None, frames: [frame_along(z, z.any_perpendicular()); 2] };
        self.driven_joint(d, &joint::TRAVEL, [GROUND, body], [at, at], Some(axes), Zero::Position)
    }

    /// Drives the height of the contact point of a wheel, from the design configuration.
    fn driven_contact(&mut self, d: &DriverDraft, wheel: &str, here: Here) -> Option<Driven> {
        let draft = self.draft;
        let names = draft.wheels.iter().map(|w| w.name.as_str());
        let number = self.find("wheel", wheel, here.key("wheel"), names)?;
        let written = &draft.wheels[number];
        // The check of wheels reports the errors of the wheel itself.
        let faults = self.faults.len();
        let nominal = self.nominal_wheel(written, number);
        self.faults.truncate(faults);
        let (body, centre, _, spin_axis) = nominal?;
        let (up, spin) = (Vec3::AXES[2], self.vector(spin_axis)?.unit()?);
        if !(written.radius > 0.0 && written.radius.is_finite()) || up.cross(spin).norm() < MIN_SINE {
            return None;
        }
        let frames = [up, spin].map(|z| frame_along(z, z.any_perpendicular()));
        let axes = Axes { axis: Direction::Along(up), axis2: Some(spin_axis), frames };
        let kind = joint::pad(Radius::of(written.radius));
        self.driven_joint(d, kind, [GROUND, body], [centre, centre], Some(axes), Zero::None)
    }

    fn driven_distance(
        &mut self,
        d: &DriverDraft,
        points: [&PointRef; 2],
        at: [DraftLocation; 2],
    ) -> Option<Driven> {
        let [from, to] = at;
        let (a, b) = (self.point(points[0], &d.name, from), self.point(points[1], &d.name, to.clone()));
        let [i, j] = [a?, b?].map(|p| self.model.points[p.0].clone());
        if self.separation(i.at, j.at) == Some(None) {
            let message = format!("the two points of driver `{}` coincide", d.name);
            self.fault("HP0211", to, message).help("an actuator needs two different points");
        }
        self.driven_joint(d, &joint::LEG, [i.body, j.body], [i.at, j.at], None, Zero::Constant)
    }

    /// Returns the coordinate that has the value of a measure, absolute or relative to the design configuration like
    /// the measure.
    fn driven_measure(&mut self, d: &DriverDraft, name: &str, here: Here) -> Option<Driven> {
        let draft = self.draft;
        let at = here.key("measure");
        let names = draft.measures.iter().map(|m| m.name.as_str());
        let k = self.find("measure", name, at.clone(), names)?;
        let (up, forward, left) = (Vec3::AXES[2], Vec3::AXES[0], Vec3::AXES[1]);
        match &draft.measures[k].kind {
            MeasureKindDraft::Unread => None,
            MeasureKindDraft::Coordinate { joint, coordinate } => {
                self.driven_coordinate(d, joint, coordinate.as_deref(), [at.clone(), at])
            }
            MeasureKindDraft::Distance { from, to } => self.driven_distance(d, [from, to], [at.clone(), at]),
            MeasureKindDraft::Coordinates { point, along } => {
                self.driven_position(d, point, &DirectionDraft::Along(*along), [at.clone(), at])
            }
            MeasureKindDraft::Angle {
                from: RayDraft::Fixed { body: base, axis: DirectionDraft::Along(from) },
                to,
                about: Some(about),
            } if base == GROUND_NAME => {
                let (body, axis2) = self.ray_of_one_body(d, to, name, &at)?;
                let place = self.hardpoint_on(body)?;
                let z = about.unit()?;
                let x = (*from - z * z.dot(*from)).unit();
                let Some(x) = x else {
                    self.fault(
                        "HP0213",
                        at,
                        format!("measure `{name}` of driver `{}` has no zero angle", d.name),
                    )
                    .help("give the measure a `from` that is not parallel to its `about`");
                    return None;
                };
                self.driven_angle(d, body, place, [z, x], axis2, Zero::Constant, &at)
            }
            MeasureKindDraft::Toe { body, spin_axis } => {
                let body = self.body(body, at.clone())?;
                let (axis2, _) = self.line_at(spin_axis, &d.name, at.clone())?;
                let place = self.hardpoint_on(body)?;
                let s = self.model.side_of_axis(axis2).sign();
                self.driven_angle(d, body, place, [up * -s, left * s], axis2, Zero::Constant, &at)
            }
            MeasureKindDraft::Wheel { wheel, what } => {
                let names = draft.wheels.iter().map(|w| w.name.as_str());
                let number = self.find("wheel", wheel, at.clone(), names)?;
                // The check of wheels reports the errors of the wheel itself.
                let faults = self.faults.len();
                let nominal = self.nominal_wheel(&draft.wheels[number], number);
                self.faults.truncate(faults);
                let (body, centre, side, axis2) = nominal?;
                let s = side.sign();
                let travel = |c: &mut Self, z: Vec3| {
                    let frames = [frame_along(z, z.any_perpendicular()); 2];
                    let axes = Axes { axis: Direction::Along(z), axis2: None, frames };
                    c.driven_joint(
                        d,
                        &joint::TRAVEL,
                        [GROUND, body],
                        [centre, centre],
                        Some(axes),
                        Zero::Nominal,
                    )
                };
                match what {
                    WheelMeasure::WheelTravel => travel(self, up),
                    WheelMeasure::WheelRecession => travel(self, -forward),
                    // toe = atan2(e_x, s e_y): seen from where z is -s z, from s y
                    WheelMeasure::Toe => {
                        self.driven_angle(d, body, centre, [up * -s, left * s], axis2, Zero::Constant, &at)
                    }
                    WheelMeasure::SteerAngle => {
                        self.driven_angle(d, body, centre, [up, left * s], axis2, Zero::Nominal, &at)
                    }
                    _ => self.report_not_drivable(d, name, what.name(), &at),
                }
            }
            MeasureKindDraft::Angle { .. } => self.report_not_drivable(d, name, "angle", &at),
            not_drivable!() => self.report_not_drivable(d, name, "type", &at),
        }
    }

    /// HP0213: a measure that no driver can prescribe.
    fn report_not_drivable(
        &mut self,
        d: &DriverDraft,
        name: &str,
        what: &str,
        at: &DraftLocation,
    ) -> Option<Driven> {
        let message = format!("driver `{}` cannot prescribe measure `{name}`", d.name);
        let fault = self.fault("HP0213", at.clone(), message);
        fault.note(match what {
            "angle" => {
                "an angle can be prescribed from a global direction to one of a body, as seen along `about`"
                    .to_owned()
            }
            "type" => "it is not the value of one coordinate that a driver can prescribe".to_owned(),
            what => {
                format!("`{what}` of a wheel is not the value of one coordinate that a driver can prescribe")
            }
        });
        fault.help("prescribe a `coordinate`, `position`, `distance`, `angle`, `toe`, `steer_angle`, `wheel_travel` or `wheel_recession`, and use this measure as the abscissa");
        None
    }

    /// Returns the body of a ray that is fixed in one body, and its direction. HP0213 otherwise.
    fn ray_of_one_body(
        &mut self,
        d: &DriverDraft,
        ray: &RayDraft,
        measure: &str,
        at: &DraftLocation,
    ) -> Option<(BodyId, Direction)> {
        match ray {
            RayDraft::Fixed { body, axis } => {
                let body = self.body(body, at.clone());
                let (axis, _) = self.line_at(axis, &d.name, at.clone())?;
                Some((body?, axis))
            }
            RayDraft::Between(points) => {
                let [a, b] = [0, 1].map(|k| self.point(&points[k], &d.name, at.clone()));
                let [a, b] = [a?, b?].map(|p| self.model.points[p.0].clone());
                if a.body != b.body {
                    self.report_not_drivable(d, measure, "angle", at);
                    return None;
                }
                Some((a.body, Direction::Through(a.at, b.at)))
            }
        }
    }

    /// Drives the angle of a direction of a body about z of ground, counted from x.
    #[expect(clippy::too_many_arguments, reason = "what a joint is made of")]
    fn driven_angle(
        &mut self,
        d: &DriverDraft,
        body: BodyId,
        place: HardpointId,
        [z, x]: [Vec3; 2],
        axis2: Direction,
        zero: Zero,
        at: &DraftLocation,
    ) -> Option<Driven> {
        let e = self.vector(axis2)?.unit()?;
        if (e - z * z.dot(e)).norm() < MIN_SINE {
            let message = format!("the direction of driver `{}` is parallel to its line of sight", d.name);
            self.fault("HP0213", at.clone(), message).help("give another `about` direction");
            return None;
        }
        let frames = [frame_along(z, x), frame_along(e, e.any_perpendicular())];
        let axes = Axes { axis: Direction::Along(z), axis2: Some(axis2), frames };
        self.driven_joint(d, &joint::COURSE, [GROUND, body], [place, place], Some(axes), zero)
    }

    /// Returns a direction as a vector in the design configuration.
    fn vector(&self, direction: Direction) -> Option<Vec3> {
        match direction {
            Direction::Along(v) => Some(v),
            Direction::Through(a, b) => Some(self.position(b)? - self.position(a)?),
        }
    }

    /// Returns a hardpoint of a joint of a body; of a body without joints that of a point on it, or any.
    fn hardpoint_on(&self, body: BodyId) -> Option<HardpointId> {
        let of_joint = self.model.joints.iter().find(|j| j.bodies.contains(&body)).map(|j| j.at[0]);
        let of_point = || self.model.points.iter().find(|p| p.body == body).map(|p| p.at);
        let any = || (!self.model.hardpoints.is_empty()).then_some(HardpointId(0));
        of_joint.or_else(of_point).or_else(any)
    }

    /// Returns the nominal value of a driver's coordinate, if it is not zero. HP0213 if the law is absolute and the
    /// coordinate has no absolute zero.
    pub(super) fn nominal_value(
        &mut self,
        d: &DriverDraft,
        driven: Driven,
        here: Here,
    ) -> Option<NominalValue> {
        let joint = &self.model.joints[driven.joint.0];
        let mut sources = Vec::new();
        let mut coordinates = |h: HardpointId| {
            [0, 1, 2].map(|axis| {
                sources.push(Source::Coordinate(h, axis));
                format!("n{}", sources.len() - 1)
            })
        };
        let along = |v: Vec3, p: &[String; 3]| {
            let [x, y, z] = p;
            format!("(({:?})*{x} + ({:?})*{y} + ({:?})*{z})", v.x, v.y, v.z)
        };
        let between = |[a, b]: [&[String; 3]; 2]| [0, 1, 2].map(|k| format!("({} - {})", b[k], a[k]));
        let text = match (driven.zero, joint.axis) {
            (Zero::None, ..) if d.from_zero => {
                let message = format!("the coordinate of driver `{}` has no absolute zero", d.name);
                self.fault("HP0213", here.key("counted_from"), message)
                    .note("lengths of rods, distances and positions have one; joint angles and displacements count from the design configuration")
                    .help("remove `counted_from`, or prescribe a measure with `measure = \"NAME\"`");
                return None;
            }
            (Zero::None | Zero::Nominal, ..) => return None,
            // The joint constant changes with `length` and variables of the joint itself, not only with its hardpoints.
            (Zero::Constant, ..) => {
                sources.push(Source::Kept(driven.joint, driven.coordinate));
                "n0".to_owned()
            }
            // n . P
            (Zero::Position, Some(Direction::Through(a, b))) => {
                let p = coordinates(joint.at[1]);
                let n = between([&coordinates(a), &coordinates(b)]);
                let [x, y, z] = &n;
                format!("({x}*{} + {y}*{} + {z}*{})/sqrt({x}^2 + {y}^2 + {z}^2)", p[0], p[1], p[2])
            }
            (Zero::Position, ..) => along(joint.frames[0].cols[2], &coordinates(joint.at[1])),
        };
        let expression = Expression::parse(&text).expect("a text that is written here");
        let sources = expression.names().iter().map(|n| {
            let k: usize = n[1..].parse().expect("a name that is given here");
            sources[k]
        });
        Some(NominalValue { sources: sources.collect(), expression: expression.clone() })
    }

    /// Adds an unnamed joint with the coordinate that a driver prescribes.
    fn driven_joint(
        &mut self,
        d: &DriverDraft,
        kind: &'static JointType,
        bodies: [BodyId; 2],
        at: [HardpointId; 2],
        axes: Option<Axes>,
        zero: Zero,
    ) -> Option<Driven> {
        if bodies[0] == bodies[1] {
            let name = &self.model.bodies[bodies[0].0].name;
            let message = format!("driver `{}` prescribes the motion of `{name}` relative to itself", d.name);
            let index = self.number_of("driver", &d.name).unwrap_or(0);
            let at = Here { section: Section::Drivers, index }.key("name");
            self.fault("HP0213", at, message).help("name two different bodies");
            return None;
        }
        self.model.joints.push(Joint {
            name: d.name.clone(),
            kind,
            bodies,
            at,
            axis: axes.as_ref().map(|a| a.axis),
            axis2: axes.as_ref().and_then(|a| a.axis2),
            frames: axes.map_or([Mat3::IDENTITY; 2], |a| a.frames),
            length: None,
            curve: None,
            cut: false,
            unnamed: true,
        });
        Some(Driven { joint: JointId(self.model.joints.len() - 1), coordinate: 0, zero })
    }

    /// True if a driver may prescribe a joint's coordinate: no other driver does, and no constraint fixes it.
    fn is_drivable(
        &mut self,
        d: &DriverDraft,
        name: &str,
        joint: JointId,
        coordinate: usize,
        at: DraftLocation,
    ) -> bool {
        let kind = self.model.joints[joint.0].kind;
        if let Some(other) = self.driver_of.get(&(joint, coordinate)) {
            let other = &self.model.drivers[other.0];
            let message = format!("drivers `{}` and `{}` prescribe the same coordinate", other.name, d.name);
            let c = kind.coordinates[coordinate].name;
            self.fault("HP0215", at, message)
                .note(format!("the {c} of joint `{name}`"))
                .help("remove one of them");
            return false;
        }
        if kind.rows.contains(&kind.coordinates[coordinate].row) {
            let message = format!("driver `{}` prescribes the length of a rod, which is constant", d.name);
            self.fault("HP0213", at, message)
                .help(format!("make `{name}` a `leg`: a rod whose length a driver prescribes"));
            return false;
        }
        true
    }
}
