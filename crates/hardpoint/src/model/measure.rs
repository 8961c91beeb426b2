//! Measures: numbers that follow from the motion.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::expression::Expression;
use crate::joint::Quantity;
use crate::model::{
    Axes, AxleId, AxleMeasure, AxleMotion, BodyId, ClearanceId, Dimension, Direction, Driver, DriverId,
    ElementId, HardpointId, JointId, Model, PointId, Side, Wheel, WheelId, WheelMeasure, WheelRequirement,
};
use crate::space::{Angles, Real, Vec3};

/// A number that follows from the motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Measure {
    /// Name.
    pub name: String,
    /// Kind of the measure.
    pub kind: MeasureKind,
}

/// Source of an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputSource {
    /// A measure of the model.
    Measure(usize),
    /// Component 0, 1 or 2 of a point of the model.
    Point(PointId, usize),
}

/// The types of measures: their class, whether a driver can prescribe them, the kind of their direction, if they have
/// one, and whether it is the normal of a planar model by default; their fields, as written and as they mean in a
/// model; their dimension, how much can be known of them, the values at which they have no derivative, the direction in
/// which they are positive, and how to say what they are. With a formula in `measure/formulas.rs` or `load/measures.rs`
/// a type is complete. The model takes its half of each line, the draft (`draft/measure.rs`) the other.
macro_rules! measures {
    ($declare:ident) => { $declare! {
    /// A joint's coordinate, counted from the design configuration; of a rod or leg the whole length.
    Coordinate "coordinate" [Joint, Drivable, Polar, normal: false] {
        /// The joint's name.
        joint: String => JointId,
        /// Coordinate of the joint; may be left out if it has only one.
        coordinate: Option<String> => usize,
    } |m, MeasureWords { model, .. }|
        dimension: m.joints[joint.0].kind.coordinates[*coordinate].quantity.into(),
        known: counted_if(m.joints[joint.0].kind.coordinates[*coordinate].quantity == Quantity::Angle),
        kinks: SMOOTH,
        positive: "",
        words: {
            let joint = &model.joints[joint.0];
            format!("{} of joint `{}`", joint.kind.coordinates[*coordinate].name, joint.name)
        };

    /// Distance between two points.
    Distance "distance" [Pose, Drivable, Polar, normal: false] {
        /// From this point.
        from: PointRef => PointId,
        /// To this one.
        to: PointRef => PointId,
    } |_, w|
        dimension: Dimension::LENGTH,
        known: POSITIONS,
        kinks: AT_ZERO,
        positive: "",
        words: format!("distance from {} to {}", w.point(*from), w.point(*to));

    /// Position of a point along a global direction.
    Coordinates "position" [Pose, Drivable, Polar, normal: false] {
        /// The point.
        point: PointRef => PointId,
        /// The direction, of any length.
        along: Vec3 => Vec3,
    } |_, w|
        dimension: Dimension::LENGTH,
        known: POSITIONS,
        kinks: SMOOTH,
        positive: "",
        words: format!("position of {} along {}", w.point(*point), (w.direction)(*along));

    /// Angle from one direction to another: between them, 0 to 180 deg, or as seen along `about`.
    Angle "angle" [Pose, Drivable, Axial, normal: true] {
        /// From this direction.
        from: RayDraft => Ray,
        /// To this one.
        to: RayDraft => Ray,
        /// The direction, pointing at the viewer, about which the angle is counted, counter-clockwise positive.
        about: Option<Vec3> => Option<Vec3>,
    } |_, w|
        dimension: Dimension::ANGLE,
        known: counted_if(about.is_some()),
        kinks: if about.is_none() { &[0.0, PI] } else { SMOOTH },
        positive: "",
        words: match about {
            None => format!("angle between {} and {}", w.ray(from), w.ray(to)),
            Some(n) => format!("angle from {} to {} about {}", w.ray(from), w.ray(to), (w.direction)(*n)),
        };

    /// Orientation of a body, as one of three angles.
    Orientation "orientation" [Pose, NotDrivable, Axial, normal: false] {
        /// The body's name.
        body: String => BodyId,
        /// The angle.
        angle: OrientationAngle => OrientationAngle,
        /// The body whose frame it is turned against. Default: the global axes.
        relative_to: Option<String> => Option<BodyId>,
    } |_, w|
        dimension: Dimension::ANGLE,
        known: counted_if(angle.is_counted()),
        kinks: SMOOTH,
        positive: "",
        words: match relative_to {
            Some(other) => format!("{} of `{}` relative to `{}`", angle.words(), w.body(*body), w.body(*other)),
            None => format!("{} of `{}`", angle.words(), w.body(*body)),
        };

    /// Angle between two lines, 0 to 90 deg.
    TransmissionAngle "transmission_angle" [Pose, NotDrivable, Polar, normal: false] {
        /// Along this direction.
        from: RayDraft => Ray,
        /// And this one.
        to: RayDraft => Ray,
    } |_, w|
        dimension: Dimension::ANGLE,
        known: POSITIONS,
        kinks: &[0.0, FRAC_PI_2],
        positive: "",
        words: format!("angle between the lines along {} and {}, at most 90 deg", w.ray(from), w.ray(to));

    /// Velocity of a point.
    Velocity "velocity" [Pose, NotDrivable, Polar, normal: false] {
        /// The point.
        point: PointRef => PointId,
        /// The direction of the component, of any length. Default: the magnitude.
        along: Option<Vec3> => Option<Vec3>,
    } |_, w|
        dimension: Dimension::LENGTH.rate(1),
        known: moving(2),
        kinks: magnitude_if(along.is_none()),
        positive: "",
        words: w.component("velocity", *point, *along);

    /// Angular velocity of a body.
    AngularVelocity "angular_velocity" [Pose, NotDrivable, Axial, normal: true] {
        /// The body's name.
        body: String => BodyId,
        /// The direction of the component, of any length. Default: the magnitude.
        along: Option<Vec3> => Option<Vec3>,
    } |_, w|
        dimension: Dimension::ANGLE.rate(1),
        known: moving(2),
        kinks: magnitude_if(along.is_none()),
        positive: "",
        words: match along {
            Some(n) => format!("angular velocity of `{}` about {}", w.body(*body), (w.direction)(*n)),
            None => format!("magnitude of the angular velocity of `{}`", w.body(*body)),
        };

    /// Acceleration of a point.
    Acceleration "acceleration" [Pose, NotDrivable, Polar, normal: false] {
        /// The point.
        point: PointRef => PointId,
        /// The direction of the component, of any length. Default: the magnitude.
        along: Option<Vec3> => Option<Vec3>,
    } |_, w|
        dimension: Dimension::LENGTH.rate(2),
        known: moving(1),
        kinks: magnitude_if(along.is_none()),
        positive: "",
        words: w.component("acceleration", *point, *along);

    /// Curvature of a point's path.
    Curvature "curvature" [Pose, NotDrivable, Axial, normal: false] {
        /// The point.
        point: PointRef => PointId,
        /// The direction, pointing at the viewer, seen along which a turn to the left is positive. Default: all are.
        about: Option<Vec3> => Option<Vec3>,
    } |_, w|
        dimension: Dimension::NUMBER.over(Dimension::LENGTH),
        known: moving(1),
        kinks: magnitude_if(about.is_none()),
        positive: "",
        words: format!("curvature of the path of {}", w.point(*point));

    /// Time derivative of another measure.
    Rate "rate" [Pose, NotDrivable, Polar, normal: false] {
        /// The name of the measure, or `POINT.x`.
        of: String => OutputSource,
    } |m, w|
        dimension: m.dimension(*of).rate(1),
        known: moving(m.known(*of).orders.saturating_sub(1)),
        kinks: SMOOTH,
        positive: "",
        words: format!("rate of {}", w.output(*of));

    /// Derivative of one measure by another while one driver moves, alone or with others, such as a motion ratio.
    Slope "slope" [Slope, NotDrivable, Polar, normal: false] {
        /// The measure, or `POINT.x`, that changes.
        of: String => OutputSource,
        /// Over this one.
        over: String => OutputSource,
        /// The driver that moves. Default: the only one.
        driver: Option<String> => DriverId,
        /// Drivers that move with it, each by the same amount: the other wheel in parallel travel.
        together: Option<Vec<String>> => Option<Vec<DriverId>>,
        /// Drivers that move with it, each by the opposite amount: the other wheel in roll.
        opposed: Option<Vec<String>> => Option<Vec<DriverId>>,
    } |m, w|
        dimension: m.dimension(*of).over(m.dimension(*over)),
        known: OF_STEP,
        kinks: SMOOTH,
        positive: {
            let (direction, travel) = (m.positive(*of), WheelMeasure::WheelTravel);
            let is_in_bump = !direction.is_empty() && m.type_of(*over) == travel.name();
            if is_in_bump { format!("{direction} in {}", travel.positive()) } else { String::new() }
        },
        words: {
            let name = |d: &DriverId| format!("`{}`", w.model.drivers[d.0].name);
            let list = |drivers: &Option<Vec<DriverId>>, sign: &str| -> String {
                drivers.iter().flatten().map(|d| format!(" {sign} {}", name(d))).collect()
            };
            let (with, against) = (list(together, "and"), list(opposed, "against"));
            let moving = if with.is_empty() && against.is_empty() { "alone moves" } else { "move" };
            let drivers = format!("{}{with}{against}", name(driver));
            let word = if moving == "move" { "drivers" } else { "driver" };
            format!("{} over {} while {word} {drivers} {moving}", w.output(*of), w.output(*over))
        };

    /// Dexterity: how the velocities of points on a body follow those of drivers, by the singular values of their
    /// Jacobian.
    Dexterity "dexterity" [Slope, NotDrivable, Polar, normal: false] {
        /// Points of the body: one for its translation, two or three apart for its rotation too.
        points: Vec<PointRef> => Vec<PointId>,
        /// Drivers that move, each alone, all in lengths or all in angles. Default: all.
        drivers: Option<Vec<String>> => Vec<DriverId>,
        /// Quantity taken from the singular values. Default: `inverse_condition`.
        value: Option<JacobianValue> => JacobianValue,
    } |m, w|
        dimension: match (value, drivers.first()) {
            (JacobianValue::LeastGain | JacobianValue::GreatestGain, Some(driver)) => {
                Dimension::LENGTH.over(m.driven(&m.drivers[driver.0]).quantity.into())
            }
            (JacobianValue::LeastGain | JacobianValue::GreatestGain, None)
            | (JacobianValue::InverseCondition, _) => Dimension::NUMBER,
        },
        known: OF_STEP,
        kinks: match value {
            JacobianValue::InverseCondition | JacobianValue::LeastGain => AT_ZERO,
            JacobianValue::GreatestGain => SMOOTH,
        },
        positive: "",
        words: {
            let points: Vec<String> = points.iter().map(|p| w.point(*p)).collect();
            format!("{} of the velocities of {} by the drivers", value.words(), points.join(", "))
        };

    /// A formula over other measures.
    Combination "expression" [Pose, NotDrivable, Polar, normal: false] {
        /// Like `front_left.toe + front_right.toe`; lengths are in the file's unit, angles in rad.
        expression: Expression => Combination,
    } |m, _|
        dimension: expression.dimension,
        known: expression.sources().map(|s| m.known(s)).fold(POSITIONS, |all, one| KnownOrders {
            orders: all.orders.min(one.orders),
            by_position: all.by_position && one.by_position,
            ..all
        }),
        kinks: magnitude_if(expression.expression.is_magnitude()),
        positive: "",
        words: expression.text().into();

    /// Least distance of the pairs of a clearance, negative where shapes overlap.
    Clearance "clearance" [Pose, NotDrivable, Polar, normal: false] {
        /// The clearance's name.
        of: String => ClearanceId,
    } |_, w|
        dimension: Dimension::LENGTH,
        known: POSITIONS,
        kinks: SMOOTH,
        positive: "",
        words: format!("least distance of clearance `{}`", w.model.clearances[of.0].name);

    /// Angle between the axis of a joint on its two bodies, or between its shafts; without an axis the whole rotation.
    Articulation "articulation" [Joint, NotDrivable, Polar, normal: false] {
        /// The joint's name.
        joint: String => JointId,
        /// Direction in the design configuration that is fixed in both bodies, in place of the joint's axis: the stud
        /// of a ball joint.
        axis: Option<DirectionDraft> => Option<Direction>,
    } |_, MeasureWords { model, .. }|
        dimension: Dimension::ANGLE,
        known: POSITIONS,
        kinks: &[0.0, PI],
        positive: "",
        words: format!("articulation of joint `{}`", model.joints[joint.0].name);

    /// Deflection of an elastic joint or bushing: displacement of its second body relative to the first along an axis,
    /// or Cardan angle about it.
    Deflection "deflection" [Pose, NotDrivable, Polar, normal: false] {
        /// Name of the elastic joint or bushing.
        force: String => ElasticId,
        /// Direction: along or about an axis, which turns with the first body.
        direction: ElasticDirection => ElasticDirection,
    } |_, MeasureWords { model, .. }|
        dimension: direction.dimension(),
        known: counted_if(direction.is_counted()),
        kinks: SMOOTH,
        positive: "",
        words: format!("deflection of `{}` {}", model.elements[force.0.0].name, direction.words());

    /// Toe of a wheel, positive for toe-in. It is a left wheel where its spin axis points to +y in the design
    /// configuration, else a right one.
    Toe "toe" [Pose, Drivable, Polar, normal: false] {
        /// The body that the wheel turns on.
        body: String => BodyId,
        /// The wheel's spin axis in the design configuration, pointing outboard.
        spin_axis: DirectionDraft => Direction,
    } |_, w|
        dimension: Dimension::ANGLE,
        known: POSITIONS,
        kinks: SMOOTH,
        positive: WheelMeasure::Toe.positive(),
        words: w.of_axis("toe", *body, spin_axis);

    /// Camber of a wheel, positive where its top leans outboard.
    Camber "camber" [Pose, NotDrivable, Polar, normal: false] {
        /// The body that the wheel turns on.
        body: String => BodyId,
        /// The wheel's spin axis in the design configuration, pointing outboard.
        spin_axis: DirectionDraft => Direction,
    } |_, w|
        dimension: Dimension::ANGLE,
        known: POSITIONS,
        kinks: SMOOTH,
        positive: WheelMeasure::Camber.positive(),
        words: w.of_axis("camber", *body, spin_axis);

    /// Force or moment that a driver needs; positive where it works while what it drives grows.
    DriverForce "driver_force" [Load, NotDrivable, Polar, normal: false] {
        /// The driver. Default: the only one.
        driver: Option<String> => DriverId,
    } |m, w|
        dimension: m.force_on(&m.drivers[driver.0]),
        known: OF_STEP,
        kinks: SMOOTH,
        positive: "",
        words: format!("force of driver `{}`", w.model.drivers[driver.0].name);

    /// Power that a driver gives the mechanism.
    DriverPower "driver_power" [Load, NotDrivable, Polar, normal: false] {
        /// The driver. Default: the only one.
        driver: Option<String> => DriverId,
    } |_, w|
        dimension: Dimension::MOMENT.rate(1),
        known: moving(1),
        kinks: SMOOTH,
        positive: "",
        words: format!("power of driver `{}`", w.model.drivers[driver.0].name);

    /// Force or moment that a joint puts on one of its bodies, with that of drivers on its coordinates.
    Reaction "reaction" [Load, NotDrivable, Polar, normal: false] {
        /// The joint.
        joint: String => JointId,
        /// Component of the reaction.
        part: ReactionPart => ReactionPart,
        /// The body that it pushes. Default: the second of the joint.
        on: Option<String> => Option<BodyId>,
        /// Along which axes components are taken. Default: the global ones.
        axes: Option<Axes> => Option<Axes>,
    } |_, MeasureWords { model, .. }|
        dimension: if part.is_moment() { Dimension::MOMENT } else { Dimension::FORCE },
        known: OF_STEP,
        kinks: magnitude_if(part.is_magnitude()),
        positive: "",
        words: format!("{} of joint `{}`", part.words(), model.joints[joint.0].name);

    /// Tension of a spring, force or moment of one on a joint's coordinate, given force along its direction, otherwise
    /// the size of the force.
    SpringForce "spring_force" [Load, NotDrivable, Polar, normal: false] {
        /// The force's name.
        force: String => ElementId,
    } |m, w|
        dimension: m.elements[force.0].kind.force(m).map_or(Dimension::FORCE, |force| force.dimension),
        known: OF_STEP,
        kinks: AT_ZERO,
        positive: "",
        words: format!("force of `{}`", w.model.elements[force.0].name);

    /// Kinetic energy of a body, or of all.
    KineticEnergy "kinetic_energy" [Load, NotDrivable, Polar, normal: false] {
        /// The body. Default: all.
        body: Option<String> => Option<BodyId>,
    } |_, w|
        dimension: Dimension::MOMENT,
        known: moving(1),
        kinks: SMOOTH,
        positive: "",
        words: match body {
            Some(body) => format!("kinetic energy of `{}`", w.body(*body)),
            None => "kinetic energy".into(),
        };

    /// Force that the mechanism puts on ground.
    ShakingForce "shaking_force" [Load, NotDrivable, Polar, normal: false] {
        /// The direction of the component, of any length. Default: the magnitude.
        along: Option<Vec3> => Option<Vec3>,
    } |_, w|
        dimension: Dimension::FORCE,
        known: OF_STEP,
        kinks: magnitude_if(along.is_none()),
        positive: "",
        words: match along {
            Some(n) => format!("force on ground along {}", (w.direction)(*n)),
            None => "magnitude of the force on ground".into(),
        };

    /// Moment that the mechanism puts on ground.
    ShakingMoment "shaking_moment" [Load, NotDrivable, Axial, normal: true] {
        /// About this point.
        about: PointRef => PointId,
        /// The direction of the component, of any length. Default: the magnitude.
        along: Option<Vec3> => Option<Vec3>,
    } |_, w|
        dimension: Dimension::MOMENT,
        known: OF_STEP,
        kinks: magnitude_if(along.is_none()),
        positive: "",
        words: format!("moment on ground about {}", w.point(*about));

    /// Derivative of a measure by a force on a point, from the compliance of elastic joints, springs and bushings,
    /// linearised at every position.
    Compliance "compliance" [Compliance, NotDrivable, Polar, normal: false] {
        /// The measure, or `POINT.x`.
        of: String => OutputSource,
        /// The point that the force pushes.
        at: Option<PointRef> => Option<PointId>,
        /// Or the wheel that the road pushes, at its contact point.
        wheel: Option<String> => Option<WheelId>,
        /// Or the force that changes in proportion: of type `force`, `wheel_force` or `moment`, with `[equilibrium]`.
        force: Option<String> => Option<ElementId>,
        /// Direction of the force on the point or wheel, of any length.
        along: Option<Vec3> => Option<Vec3>,
        /// A driver that is released: it holds nothing, springs do. Default: all drivers hold.
        released: Option<String> => Option<DriverId>,
    } |m, w|
        dimension: m.dimension(*of).over(force.map_or(Dimension::FORCE, |e| m.force_dimension(e))),
        known: OF_STEP,
        kinks: SMOOTH,
        positive: "",
        words: {
            let of_wheel = |wheel: WheelId| format!("the contact of wheel `{}`", w.model.wheels[wheel.0].name);
            let place = at.map(|p| w.point(p)).or_else(|| wheel.map(of_wheel)).unwrap_or_default();
            match (force, along) {
                (Some(e), _) => format!("{} per force `{}`", w.output(*of), w.model.elements[e.0].name),
                (None, Some(along)) => {
                    format!("{} per force on {place} along {}", w.output(*of), (w.direction)(*along))
                }
                (None, None) => format!("{} per force on {place}", w.output(*of)),
            }
        };
    } };
}
pub(crate) use measures;

/// Measure types with references resolved to ids.
macro_rules! in_models {
    ($(
        $(#[doc = $doc:literal])* $variant:ident $name:literal
        [$class:ident, $drivable:ident, $vector:ident, normal: $normal:literal] {
            $($(#[doc = $field_doc:literal])* $field:ident: $draft:ty => $type:ty),* $(,)?
        } |$model:pat_param, $words:pat_param|
            dimension: $dimension:expr, known: $known:expr, kinks: $kinks:expr, positive: $positive:expr,
            words: $says:expr;
    )*) => {
        /// Kind of a measure. Formulas and signs are in `docs/measures.md`.
        #[derive(Clone, Debug, PartialEq)]
        pub enum MeasureKind {
            $($(#[doc = $doc])* $variant { $($(#[doc = $field_doc])* $field: $type,)* },)*
            /// A measure of a wheel.
            Wheel {
                /// The wheel.
                wheel: WheelId,
                /// Measured quantity.
                what: WheelMeasure,
            },
            /// A measure of both wheels of an axle.
            Axle {
                /// The axle.
                axle: AxleId,
                /// Measured quantity.
                what: AxleMeasure,
            },
        }

        impl MeasureKind {
            /// Values at which the measure has no derivative because the vector that it is the magnitude of is zero,
            /// or two directions are parallel or perpendicular; empty for measures that are no magnitudes. The square
            /// of the distance from such a value is smooth there.
            pub fn kinks(&self) -> &'static [f64] {
                match self {
                    $(#[allow(unused_variables, reason = "kinks follow from some of its fields")]
                    Self::$variant { $($field),* } => $kinks,)*
                    Self::Wheel { .. } | Self::Axle { .. } => SMOOTH,
                }
            }

            /// Elastic joint or bushing whose deflection it is, and in which direction.
            pub fn elastic(&self) -> Option<(ElasticId, ElasticDirection)> {
                match self {
                    $(Self::$variant { $($field),* } => {
                        let parts: [(Option<ElasticId>, Option<ElasticDirection>); _] = [$($field.elastic()),*];
                        parts.iter().find_map(|part| part.0).zip(parts.iter().find_map(|part| part.1))
                    })*
                    Self::Wheel { .. } | Self::Axle { .. } => None,
                }
            }

            /// Outputs that the measure is made of.
            pub fn sources(&self) -> Vec<OutputSource> {
                match self {
                    $(Self::$variant { $($field),* } => [$($field.outputs()),*].concat(),)*
                    Self::Wheel { .. } | Self::Axle { .. } => Vec::new(),
                }
            }
        }

        impl Model {
            /// Dimension of an output's value.
            pub fn dimension(&self, output: OutputSource) -> Dimension {
                let OutputSource::Measure(k) = output else { return Dimension::LENGTH };
                match &self.measures[k].kind {
                    $(#[allow(unused_variables, reason = "what a measure is follows from some of its fields")]
                    MeasureKind::$variant { $($field),* } => { let $model = self; $dimension })*
                    MeasureKind::Wheel { what, .. } => what.dimension(),
                    MeasureKind::Axle { what, .. } => what.dimension(),
                }
            }

            /// Type of an output as model files write it, such as `toe` or `position`; of a wheel or axle that of its
            /// measure.
            pub fn type_of(&self, output: OutputSource) -> &'static str {
                let OutputSource::Measure(k) = output else { return "position" };
                match &self.measures[k].kind {
                    $(MeasureKind::$variant { .. } => $name,)*
                    MeasureKind::Wheel { what, .. } => what.name(),
                    MeasureKind::Axle { what, .. } => what.name(),
                }
            }

            /// Time derivatives that are known of an output: the motion ends at accelerations.
            pub fn known(&self, output: OutputSource) -> KnownOrders {
                let known = self.known_along_motion(output);
                // An equilibrium is at rest: nothing has a rate.
                let orders = if self.equilibrium.is_some() { known.orders.min(1) } else { known.orders };
                KnownOrders { orders, ..known }
            }

            /// The same for a motion.
            fn known_along_motion(&self, output: OutputSource) -> KnownOrders {
                let OutputSource::Measure(k) = output else { return POSITIONS };
                match &self.measures[k].kind {
                    $(#[allow(unused_variables, reason = "how much is known follows from some of its fields")]
                    MeasureKind::$variant { $($field),* } => { let $model = self; $known })*
                    MeasureKind::Wheel { .. } | MeasureKind::Axle { .. } if self.depends_on_driver(k) => OF_STEP,
                    MeasureKind::Wheel { .. } | MeasureKind::Axle { .. } => POSITIONS,
                }
            }

            /// Direction in which an output is positive, in words; empty if there is no fixed one. A slope over wheel
            /// travel has that of its measure in bump.
            pub fn positive(&self, output: OutputSource) -> String {
                match output {
                    OutputSource::Measure(k) => self.positive_of(&self.measures[k].kind),
                    // A model with wheels has vehicle axes, those of ISO 8855.
                    OutputSource::Point(_, axis) if self.wheels.is_empty() => {
                        format!("along +{}", ["x", "y", "z"][axis])
                    }
                    OutputSource::Point(_, axis) => ["forward", "to the left", "up"][axis].to_owned(),
                }
            }

            fn positive_of(&self, kind: &MeasureKind) -> String {
                match kind {
                    $(#[allow(unused_variables, reason = "what is positive follows from some of its fields")]
                    MeasureKind::$variant { $($field),* } => { let $model = self; String::from($positive) })*
                    MeasureKind::Wheel { what, .. } => what.positive().to_owned(),
                    MeasureKind::Axle { what, .. } => what.positive().to_owned(),
                }
            }

            /// The bodies that a measure looks at, by what its fields name; other outputs that it uses have their own.
            pub(crate) fn bodies_of(&self, measure: &Measure) -> Vec<BodyId> {
                match &measure.kind {
                    $(MeasureKind::$variant { $($field),* } => [$($field.bodies(self)),*].concat(),)*
                    MeasureKind::Wheel { wheel, what } => {
                        [wheel.bodies(self), self.moved_with(*wheel, *what).bodies(self)].concat()
                    }
                    MeasureKind::Axle { axle, .. } => self.axles[axle.0].wheels.map(|w| w.bodies(self)).concat(),
                }
            }

            /// The directions fixed in bodies that a measure depends on, in the order of its fields: each is fixed in
            /// the bodies that the measure names.
            pub(crate) fn directions(&self, measure: &Measure) -> [Option<(BodyId, Direction)>; 2] {
                let of_wheel = |wheel: WheelId| {
                    let wheel = &self.wheels[wheel.0];
                    Some((wheel.body, wheel.spin_axis))
                };
                let bodies = || self.bodies_of(measure);
                match &measure.kind {
                    $(MeasureKind::$variant { $($field),* } => {
                        let mut found = [$($field.directions(&bodies)),*].concat().into_iter();
                        [0, 1].map(|_| found.next().flatten())
                    })*
                    MeasureKind::Wheel { wheel, what } => {
                        [of_wheel(*wheel), self.moved_with(*wheel, *what).and_then(of_wheel)]
                    }
                    MeasureKind::Axle { axle, .. } => self.axles[axle.0].wheels.map(of_wheel),
                }
            }

            /// Describes a measure in words; `direction` formats a global direction.
            pub fn describe(&self, measure: &Measure, direction: &dyn Fn(Vec3) -> String) -> String {
                let words = MeasureWords { model: self, direction };
                match &measure.kind {
                    $(#[allow(unused_variables, reason = "not every field is said")]
                    MeasureKind::$variant { $($field),* } => { let $words = words; $says })*
                    MeasureKind::Wheel { wheel, what } => {
                        format!("{} of wheel `{}`", what.name().replace('_', " "), self.wheels[wheel.0].name)
                    }
                    MeasureKind::Axle { axle, what } => {
                        format!("{} of axle `{}`", what.name().replace('_', " "), self.axles[axle.0].name)
                    }
                }
            }
        }
    };
}

measures!(in_models);

/// Patterns of the measures by their classes.
macro_rules! class_patterns {
    ([$($joints:ident)*] [$($poses:ident)*] [$($loads:ident)*] Joint $kind:ident $($rest:tt)*) => {
        class_patterns! { [$($joints)* $kind] [$($poses)*] [$($loads)*] $($rest)* }
    };
    ([$($joints:ident)*] [$($poses:ident)*] [$($loads:ident)*] Pose $kind:ident $($rest:tt)*) => {
        class_patterns! { [$($joints)*] [$($poses)* $kind] [$($loads)*] $($rest)* }
    };
    ([$($joints:ident)*] [$($poses:ident)*] [$($loads:ident)*] Load $kind:ident $($rest:tt)*) => {
        class_patterns! { [$($joints)*] [$($poses)*] [$($loads)* $kind] $($rest)* }
    };
    // Their matches name them.
    ($joints:tt $poses:tt $loads:tt Slope $kind:ident $($rest:tt)*) => {
        class_patterns! { $joints $poses $loads $($rest)* }
    };
    ($joints:tt $poses:tt $loads:tt Compliance $kind:ident $($rest:tt)*) => {
        class_patterns! { $joints $poses $loads $($rest)* }
    };
    ([$($joint:ident)*] [$pose:ident $($poses:ident)*] [$load:ident $($loads:ident)*]) => {
        /// Pattern of the measures that follow from the poses of bodies and their rates, but those of wheels and axles.
        macro_rules! of_bodies {
            () => { $(MeasureKind::$joint { .. } |)* $crate::model::of_bodies_but_joints!() };
        }

        /// Pattern of those of them that are no values of joints.
        macro_rules! of_bodies_but_joints {
            () => { MeasureKind::$pose { .. } $(| MeasureKind::$poses { .. })* };
        }

        /// Pattern of the measures that are loads: what drives the mechanism, or what its parts carry.
        macro_rules! loads {
            () => { MeasureKind::$load { .. } $(| MeasureKind::$loads { .. })* };
        }
    };
}
macro_rules! in_classes {
    ($(
        $(#[doc = $doc:literal])* $variant:ident $name:literal
        [$class:ident, $($attributes:tt)*] { $($fields:tt)* } |$model:pat_param, $words:pat_param|
            dimension: $dimension:expr, known: $known:expr, kinks: $kinks:expr, positive: $positive:expr,
            words: $says:expr;
    )*) => {
        class_patterns! { [] [] [] $($class $variant)* }
    };
}
measures!(in_classes);
pub(crate) use {loads, of_bodies, of_bodies_but_joints};

/// Parts of a model that a field of a measure names.
trait References {
    /// Bodies that it names, or on which the named items are.
    fn bodies(&self, _model: &Model) -> Vec<BodyId> {
        Vec::new()
    }

    /// Elastic joint or bushing that it names, or the direction in one.
    fn elastic(&self) -> (Option<ElasticId>, Option<ElasticDirection>) {
        (None, None)
    }

    /// Outputs that it names.
    fn outputs(&self) -> Vec<OutputSource> {
        Vec::new()
    }

    /// Directions that it fixes in bodies; `bodies` are those of the measure.
    fn directions(&self, _bodies: &dyn Fn() -> Vec<BodyId>) -> Vec<Option<(BodyId, Direction)>> {
        Vec::new()
    }
}

impl References for BodyId {
    fn bodies(&self, _: &Model) -> Vec<BodyId> {
        vec![*self]
    }
}

impl References for JointId {
    fn bodies(&self, model: &Model) -> Vec<BodyId> {
        model.joints[self.0].bodies.to_vec()
    }
}

impl References for PointId {
    fn bodies(&self, model: &Model) -> Vec<BodyId> {
        vec![model.points[self.0].body]
    }
}

impl References for WheelId {
    fn bodies(&self, model: &Model) -> Vec<BodyId> {
        vec![model.wheels[self.0].body]
    }
}

impl References for ElasticId {
    fn bodies(&self, model: &Model) -> Vec<BodyId> {
        let force = model.elements[self.0.0].kind.force(model);
        force.map_or_else(Vec::new, |force| force.acts_on.bodies(model).to_vec())
    }

    fn elastic(&self) -> (Option<ElasticId>, Option<ElasticDirection>) {
        (Some(*self), None)
    }
}

impl References for Vec<PointId> {
    fn bodies(&self, model: &Model) -> Vec<BodyId> {
        self.iter().map(|p| model.points[p.0].body).collect()
    }
}

impl References for Option<PointId> {
    fn bodies(&self, model: &Model) -> Vec<BodyId> {
        self.map_or_else(Vec::new, |p| p.bodies(model))
    }
}

impl References for Option<WheelId> {
    fn bodies(&self, model: &Model) -> Vec<BodyId> {
        self.map_or_else(Vec::new, |w| w.bodies(model))
    }
}

impl References for ClearanceId {
    fn bodies(&self, model: &Model) -> Vec<BodyId> {
        let pairs = &model.clearances[self.0].pairs;
        pairs.iter().flat_map(|pair| pair.shapes).flat_map(|s| model.shapes[s.0].bodies(model)).collect()
    }
}

impl References for Ray {
    fn bodies(&self, model: &Model) -> Vec<BodyId> {
        match self {
            Self::Between(points) => points.map(|p| p.bodies(model)).concat(),
            Self::Fixed { body, .. } => vec![*body],
        }
    }

    fn directions(&self, _: &dyn Fn() -> Vec<BodyId>) -> Vec<Option<(BodyId, Direction)>> {
        match *self {
            Self::Between(_) => vec![None],
            Self::Fixed { body, axis } => vec![Some((body, axis))],
        }
    }
}

impl References for Option<BodyId> {
    fn bodies(&self, _: &Model) -> Vec<BodyId> {
        self.iter().copied().collect()
    }
}

impl References for Direction {
    fn directions(&self, bodies: &dyn Fn() -> Vec<BodyId>) -> Vec<Option<(BodyId, Direction)>> {
        bodies().into_iter().map(|body| Some((body, *self))).collect()
    }
}

impl References for Option<Direction> {
    fn directions(&self, bodies: &dyn Fn() -> Vec<BodyId>) -> Vec<Option<(BodyId, Direction)>> {
        self.map_or_else(Vec::new, |direction| direction.directions(bodies))
    }
}

impl References for OutputSource {
    fn outputs(&self) -> Vec<OutputSource> {
        vec![*self]
    }
}

impl References for Combination {
    fn outputs(&self) -> Vec<OutputSource> {
        self.sources().collect()
    }
}

impl References for usize {}
impl References for ElementId {}
impl References for Option<ElementId> {}
impl References for ReactionPart {}
impl References for Option<Axes> {}
impl References for OrientationAngle {}
impl References for Vec3 {}
impl References for Option<Vec3> {}
impl References for DriverId {}
impl References for Option<DriverId> {}
impl References for Vec<DriverId> {}
impl References for Option<Vec<DriverId>> {}
impl References for JacobianValue {}
impl References for ElasticDirection {
    fn elastic(&self) -> (Option<ElasticId>, Option<ElasticDirection>) {
        (None, Some(*self))
    }
}

/// Values at which a measure without kinks has none.
const SMOOTH: &[f64] = &[];
/// Value at which a magnitude has a kink.
const AT_ZERO: &[f64] = &[0.0];

/// Kinks of a measure that is a magnitude, or is not.
const fn magnitude_if(is_magnitude: bool) -> &'static [f64] {
    if is_magnitude { AT_ZERO } else { SMOOTH }
}

/// All of an output that follows from positions is known.
const POSITIONS: KnownOrders = counted_if(false);

/// The same of an angle that is counted through whole turns, or is not.
const fn counted_if(counted: bool) -> KnownOrders {
    KnownOrders { orders: 3, by_position: true, counted, is_rate: false }
}

/// The value alone is known of loads and of derivatives along drivers and forces: each step is solved for them.
const OF_STEP: KnownOrders = KnownOrders { orders: 1, by_position: false, counted: false, is_rate: false };

/// Known orders of a quantity that follows from velocities or accelerations: the first `orders` of value, rate and
/// acceleration.
fn moving(orders: usize) -> KnownOrders {
    KnownOrders { orders, by_position: false, counted: false, is_rate: true }
}

/// Builder of the descriptions of measures.
#[derive(Clone, Copy)]
struct MeasureWords<'a> {
    model: &'a Model,
    direction: &'a dyn Fn(Vec3) -> String,
}

impl MeasureWords<'_> {
    fn point(&self, p: PointId) -> String {
        let p = &self.model.points[p.0];
        let place = &self.model.hardpoints[p.at.0];
        if !p.unnamed {
            format!("`{}`", p.name)
        } else if !place.unnamed {
            format!("`{}` on `{}`", place.name, self.body(p.body))
        } else {
            format!("a point of `{}`", self.body(p.body))
        }
    }

    fn body(&self, body: BodyId) -> &str {
        &self.model.bodies[body.0].name
    }

    fn output(&self, source: OutputSource) -> String {
        match source {
            OutputSource::Measure(k) => format!("`{}`", self.model.measures[k].name),
            OutputSource::Point(p, axis) => format!("{}.{}", self.point(p), ["x", "y", "z"][axis]),
        }
    }

    fn ray(&self, ray: &Ray) -> String {
        match ray {
            Ray::Between([a, b]) => format!("the line from {} to {}", self.point(*a), self.point(*b)),
            Ray::Fixed { body, axis: Direction::Along(u) } => {
                format!("{} of `{}`", (self.direction)(*u), self.body(*body))
            }
            Ray::Fixed { body, axis: Direction::Through(a, b) } => {
                format!("the line of `{}` {}", self.body(*body), self.through([*a, *b]))
            }
        }
    }

    fn through(&self, ends: [HardpointId; 2]) -> String {
        let [a, b] = ends.map(|h| self.model.hardpoints[h.0].name.as_str());
        format!("from `{a}` to `{b}`")
    }

    fn component(&self, what: &str, point: PointId, along: Option<Vec3>) -> String {
        match along {
            Some(along) => format!("{what} of {} along {}", self.point(point), (self.direction)(along)),
            None => format!("magnitude of the {what} of {}", self.point(point)),
        }
    }

    fn of_axis(&self, what: &str, body: BodyId, axis: &Direction) -> String {
        let axis = match axis {
            Direction::Along(u) => format!("along {}", (self.direction)(*u)),
            Direction::Through(a, b) => self.through([*a, *b]),
        };
        format!("{what} of `{}`, spin axis {axis}", self.body(body))
    }
}

/// A direction that an angle is measured from or to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ray {
    /// From one point to another.
    Between([PointId; 2]),
    /// Fixed in a body, as it points in the design configuration.
    Fixed {
        /// The body; ground for a global direction.
        body: BodyId,
        /// Direction of the ray.
        axis: Direction,
    },
}

impl MeasureKind {
    /// Returns how far a value is from where the measure has no derivative ([`kinks`](Self::kinks)); `None` without
    /// kinks.
    pub fn distance_from_kink(&self, value: f64) -> Option<f64> {
        self.kinks().iter().map(|kink| (value - kink).abs()).reduce(f64::min)
    }

    /// Joint whose coordinate or articulation it is.
    pub fn joint_value(&self) -> Option<JointId> {
        match self {
            Self::Coordinate { joint, .. } | Self::Articulation { joint, .. } => Some(*joint),
            of_bodies_but_joints!()
            | loads!()
            | Self::Slope { .. }
            | Self::Dexterity { .. }
            | Self::Compliance { .. }
            | Self::Wheel { .. }
            | Self::Axle { .. } => None,
        }
    }

    /// Joint whose own axis tilts by the measure.
    pub fn tilting_joint(&self) -> Option<JointId> {
        match self {
            Self::Articulation { joint, axis: None } => Some(*joint),
            Self::Articulation { axis: Some(_), .. }
            | Self::Coordinate { .. }
            | of_bodies_but_joints!()
            | loads!()
            | Self::Slope { .. }
            | Self::Dexterity { .. }
            | Self::Compliance { .. }
            | Self::Wheel { .. }
            | Self::Axle { .. } => None,
        }
    }

    /// True if it is a compliance.
    pub fn is_compliance(&self) -> bool {
        self.compliance().is_some()
    }

    /// Output of a compliance, and the force that changes it.
    pub(crate) fn compliance(&self) -> Option<(OutputSource, UnitForce)> {
        match *self {
            Self::Compliance { of, at, wheel, force, along, released: _ } => {
                let force = match (force, at, wheel, along) {
                    (Some(element), ..) => UnitForce::Element(element),
                    (None, Some(point), _, Some(along)) => UnitForce::Point(point, along),
                    (None, None, Some(wheel), Some(along)) => UnitForce::Wheel(wheel, along),
                    (None, None, None, _) | (None, _, _, None) => return None,
                };
                Some((of, force))
            }
            Self::Slope { .. }
            | Self::Dexterity { .. }
            | Self::Wheel { .. }
            | Self::Axle { .. }
            | of_bodies!()
            | loads!() => None,
        }
    }

    /// True if it is a load: what drives the mechanism, or what its parts carry.
    pub fn is_load(&self) -> bool {
        match self {
            loads!() => true,
            of_bodies!()
            | Self::Slope { .. }
            | Self::Dexterity { .. }
            | Self::Compliance { .. }
            | Self::Wheel { .. }
            | Self::Axle { .. } => false,
        }
    }
}

/// Measured component of a joint's reaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReactionPart {
    /// The size of its force.
    Force,
    /// A component of it: 0 for x, 1 for y, 2 for z.
    ForceAlong(usize),
    /// The force along the joint's axis.
    Axial,
    /// The size of the force across it.
    Radial,
    /// The size of its moment about the joint's place.
    Moment,
    /// A component of it.
    MomentAbout(usize),
    /// The moment about the joint's axis.
    Torque,
    /// The size of the moment across it.
    Bending,
}

impl ReactionPart {
    /// True for the magnitude of a vector, or of the part of it across the joint's axis.
    const fn is_magnitude(self) -> bool {
        match self {
            Self::Force | Self::Radial | Self::Moment | Self::Bending => true,
            Self::ForceAlong(_) | Self::Axial | Self::MomentAbout(_) | Self::Torque => false,
        }
    }

    /// As model files write them, and what they are.
    pub const WORDS: &[(&str, &str)] = &[
        ("force", "The size of its force."),
        ("force_x", "The force along x."),
        ("force_y", "The force along y."),
        ("force_z", "The force along z."),
        ("axial", "The force along the joint's axis."),
        ("radial", "The size of the force across the joint's axis."),
        ("moment", "The size of its moment about the joint's place."),
        ("moment_x", "The moment about x."),
        ("moment_y", "The moment about y."),
        ("moment_z", "The moment about z."),
        ("torque", "The moment about the joint's axis: that of a driver, of friction there."),
        ("bending", "The size of the moment across the joint's axis."),
    ];

    /// That of a place in [`WORDS`](Self::WORDS).
    pub fn at(word: usize) -> Self {
        match word {
            0 => Self::Force,
            1..=3 => Self::ForceAlong(word - 1),
            4 => Self::Axial,
            5 => Self::Radial,
            6 => Self::Moment,
            7..=9 => Self::MomentAbout(word - 7),
            10 => Self::Torque,
            _ => Self::Bending,
        }
    }

    /// True if it is a moment, rather than a force.
    pub fn is_moment(self) -> bool {
        matches!(self, Self::Moment | Self::MomentAbout(_) | Self::Torque | Self::Bending)
    }

    fn words(self) -> String {
        let axis = |k: usize| ["x", "y", "z"][k];
        match self {
            Self::Force => "force".into(),
            Self::ForceAlong(k) => format!("force along {}", axis(k)),
            Self::Axial => "axial force".into(),
            Self::Radial => "radial force".into(),
            Self::Moment => "moment".into(),
            Self::MomentAbout(k) => format!("moment about {}", axis(k)),
            Self::Torque => "torque".into(),
            Self::Bending => "bending moment".into(),
        }
    }
}

/// One of the angles that say how a body is turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OrientationAngle {
    /// Sequence of the three angles.
    pub angles: Angles,
    /// Index of the angle in the sequence, 0 to 2.
    pub place: usize,
}

impl OrientationAngle {
    /// As model files write them, and what they are; all three of each kind in their order.
    pub const WORDS: &[(&str, &str)] = &[
        ("euler_1", "The first 3-1-3 Euler angle, about z."),
        ("euler_2", "The second one, about the new x: 0 to 180 deg between both z axes."),
        ("euler_3", "The third one, about the new z."),
        ("cardan_1", "The first Cardan angle, about x."),
        ("cardan_2", "The second one, about the new y: -90 to 90 deg."),
        ("cardan_3", "The third one, about the new z."),
        ("roll", "About the body's x, after yaw and pitch."),
        ("pitch", "About its y, after yaw: -90 to 90 deg, positive where x points down."),
        ("yaw", "About z."),
    ];

    /// That of a place in [`WORDS`](Self::WORDS).
    pub fn at(word: usize) -> Self {
        let angles = [Angles::Euler, Angles::Cardan, Angles::RollPitchYaw][word / 3];
        Self { angles, place: word % 3 }
    }

    /// As model files write it.
    pub fn name(self) -> &'static str {
        Self::WORDS[3 * self.angles as usize + self.place].0
    }

    /// True if it is counted through whole turns; the middle one of three never makes one.
    pub(crate) fn is_counted(self) -> bool {
        self.place != 1
    }

    fn words(self) -> &'static str {
        match (self.angles, self.place) {
            (Angles::Euler, 0) => "first Euler angle",
            (Angles::Euler, 1) => "second Euler angle",
            (Angles::Euler, _) => "third Euler angle",
            (Angles::Cardan, 0) => "first Cardan angle",
            (Angles::Cardan, 1) => "second Cardan angle",
            (Angles::Cardan, _) => "third Cardan angle",
            (Angles::RollPitchYaw, 0) => "roll",
            (Angles::RollPitchYaw, 1) => "pitch",
            (Angles::RollPitchYaw, _) => "yaw",
        }
    }
}

/// An elastic joint or a bushing: a force that resists displacements along and about the axes of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ElasticId(pub ElementId);

/// Direction of an elastic joint or bushing: 0 to 2 along its axes x, y and z, 3 to 5 about them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ElasticDirection(pub usize);

impl ElasticDirection {
    /// As model files write them, and what they are.
    pub const WORDS: &[(&str, &str)] = &[
        ("x", "The displacement along x."),
        ("y", "The displacement along y."),
        ("z", "The displacement along z, the axis of a joint."),
        ("about_x", "The angle about x, the first of three."),
        ("about_y", "The second one, about the new y: -90 to 90 deg."),
        ("about_z", "The third one, about the new z, the axis of a joint; counted through whole turns."),
    ];

    /// That of a place in [`WORDS`](Self::WORDS).
    pub fn at(word: usize) -> Self {
        Self(word)
    }

    /// As model files write it.
    pub fn name(self) -> &'static str {
        Self::WORDS[self.0].0
    }

    /// Dimension of the deflection.
    pub fn dimension(self) -> Dimension {
        if self.0 < 3 { Dimension::LENGTH } else { Dimension::ANGLE }
    }

    /// True if it is counted through whole turns.
    pub(crate) fn is_counted(self) -> bool {
        self.0 == 5
    }

    fn words(self) -> &'static str {
        ["along x", "along y", "along z", "about x", "about y", "about z"][self.0]
    }
}

/// Quantity that a dexterity takes from the singular values of a Jacobian.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum JacobianValue {
    /// The least over the greatest.
    #[default]
    InverseCondition,
    /// The least.
    LeastGain,
    /// The greatest.
    GreatestGain,
}

impl JacobianValue {
    /// Maximum number of drivers of a dexterity: a body has six freedoms.
    pub(crate) const MOST_DRIVERS: usize = 6;

    /// As model files write them, and what they are.
    pub const WORDS: &[(&str, &str)] = &[
        (
            "inverse_condition",
            "The least over the greatest: 1 where all directions are alike, 0 at a singular position.",
        ),
        ("least_gain", "The least: speed of the points per speed of the drivers in the slowest direction."),
        ("greatest_gain", "The greatest: the same in the fastest direction."),
    ];

    /// That of a place in [`WORDS`](Self::WORDS).
    pub fn at(word: usize) -> Self {
        [Self::InverseCondition, Self::LeastGain, Self::GreatestGain][word]
    }

    fn words(self) -> &'static str {
        match self {
            Self::InverseCondition => "inverse condition number",
            Self::LeastGain => "least singular value",
            Self::GreatestGain => "greatest singular value",
        }
    }
}

/// A formula over other outputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Combination {
    pub(crate) expression: Expression,
    /// Sources of the names, each with the number of units of the text per SI unit.
    pub(crate) inputs: Vec<(OutputSource, f64)>,
    /// Number of units of the text per SI unit of the result.
    pub(crate) per_unit: f64,
    pub(crate) dimension: Dimension,
}

impl Combination {
    /// Text of the expression.
    pub fn text(&self) -> &str {
        self.expression.text()
    }

    /// The outputs that it uses.
    pub fn sources(&self) -> impl Iterator<Item = OutputSource> {
        self.inputs.iter().map(|i| i.0)
    }

    /// Value in SI for these outputs in SI.
    pub(crate) fn at<T: Real>(&self, output: impl Fn(OutputSource) -> T) -> T {
        let number = |k: usize| {
            let (from, per_unit) = self.inputs[k];
            output(from) * T::constant(per_unit)
        };
        self.expression.over(number) / T::constant(self.per_unit)
    }
}

/// Unit force of a compliance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum UnitForce {
    /// On a point, along a direction.
    Point(PointId, Vec3),
    /// On a wheel at its contact, along a direction.
    Wheel(WheelId, Vec3),
    /// A given force that grows in proportion.
    Element(ElementId),
}

/// Time derivatives that are known of an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KnownOrders {
    /// Number of known derivatives, among value, rate and acceleration.
    pub orders: usize,
    /// True if it follows from positions alone: then it has second design derivatives, and slopes.
    pub by_position: bool,
    /// True if it is an angle that is counted through whole turns along the motion.
    pub counted: bool,
    /// True if it follows from velocities or accelerations, so that a mechanism at rest has none.
    pub is_rate: bool,
}

impl Model {
    /// `toe` for a measure, `wheel_centre.z` for a point's component.
    pub fn output_name(&self, output: OutputSource) -> String {
        match output {
            OutputSource::Measure(k) => self.measures[k].name.clone(),
            OutputSource::Point(p, axis) => format!("{}.{}", self.points[p.0].name, ["x", "y", "z"][axis]),
        }
    }

    /// True if a measure is a derivative along the motion of a single driver instead of time.
    pub fn depends_on_driver(&self, measure: usize) -> bool {
        match self.measures[measure].kind {
            MeasureKind::Slope { .. } | MeasureKind::Dexterity { .. } => true,
            MeasureKind::Wheel { what, .. } => what.needs().depends_on_driver(),
            MeasureKind::Axle { what, .. } => what.depends_on_driver(),
            of_bodies!() | loads!() | MeasureKind::Compliance { .. } => false,
        }
    }

    /// True if a measure needs more of a step than where its bodies are: what happens while one driver alone moves, or
    /// loads.
    pub fn depends_on_step(&self, measure: usize) -> bool {
        let kind = &self.measures[measure].kind;
        self.depends_on_driver(measure) || kind.is_load() || matches!(kind, MeasureKind::Compliance { .. })
    }

    /// The drivers along each of which a measure needs a derivative, if it does: of an axle that of each wheel, of a
    /// wheel also that of the wheel that moves with it.
    pub(crate) fn drivers_alone(&self, measure: usize) -> impl Iterator<Item = DriverId> {
        let of_wheel = |wheel: WheelId, need: WheelRequirement| self.wheels[wheel.0].driver(need);
        let list = |drivers: &'_ Option<Vec<DriverId>>| drivers.clone().unwrap_or_default();
        let (one, other, all) = match &self.measures[measure].kind {
            MeasureKind::Slope { driver, together, opposed, .. } => {
                (Some(*driver), None, [list(together), list(opposed)].concat())
            }
            MeasureKind::Dexterity { drivers, .. } => (None, None, drivers.clone()),
            MeasureKind::Wheel { wheel, what } => {
                let other = self.moved_with(*wheel, *what);
                let other = other.and_then(|other| of_wheel(other, WheelRequirement::Bump));
                (of_wheel(*wheel, what.needs()), other, Vec::new())
            }
            MeasureKind::Axle { axle, .. } => {
                let [left, right] =
                    self.axles[axle.0].wheels.map(|wheel| of_wheel(wheel, WheelRequirement::Bump));
                (left, right, Vec::new())
            }
            of_bodies!() | loads!() | MeasureKind::Compliance { .. } => (None, None, Vec::new()),
        };
        let depends = self.depends_on_driver(measure);
        one.into_iter().chain(other).chain(all).filter(move |_| depends)
    }

    /// The other wheel of an axle, if a measure of a wheel is taken while both rise alike or the axle rolls: each must
    /// have a driver of its own that is held. Without an axle, wheels of both sides on one body belong together.
    pub(crate) fn moved_with(&self, wheel: WheelId, what: WheelMeasure) -> Option<WheelId> {
        if what.motion() == AxleMotion::OneWheel {
            return None;
        }
        let held = |wheel: WheelId| {
            let released = self.equilibrium.iter().flat_map(|equilibrium| &equilibrium.released);
            self.wheels[wheel.0].bump.filter(|bump| !released.clone().any(|driver| driver == bump))
        };
        let of_axle = self.axles.iter().map(|axle| axle.wheels).find(|wheels| wheels.contains(&wheel));
        let other = match of_axle {
            Some([left, right]) => Some(if left == wheel { right } else { left }),
            None => {
                let own = &self.wheels[wheel.0];
                let is_other = |w: &Wheel| w.body == own.body && w.side != own.side;
                self.wheels.iter().position(is_other).map(WheelId)
            }
        };
        other.filter(|other| held(*other).is_some_and(|bump| Some(bump) != self.wheels[wheel.0].bump))
    }

    /// Dimension of a driver's force: its product with the driven quantity is work.
    pub fn force_on(&self, driver: &Driver) -> Dimension {
        match self.driven(driver).quantity {
            Quantity::Angle => Dimension::MOMENT,
            Quantity::Length | Quantity::Number => Dimension::FORCE,
        }
    }

    /// True if an output has a number where nothing moves: what follows from positions alone, or from what happens
    /// while one driver alone moves. Velocities, accelerations and what follows from them are those of a motion.
    pub fn is_known_at_rest(&self, output: OutputSource) -> bool {
        let by_driver = matches!(output, OutputSource::Measure(k) if self.depends_on_driver(k));
        by_driver || self.known(output).by_position
    }

    /// The side of the vehicle that a spin axis points to in the design configuration.
    pub(crate) fn side_of_axis(&self, spin_axis: Direction) -> Side {
        if self.vector(spin_axis).y < 0.0 { Side::Right } else { Side::Left }
    }

    /// A direction in the design configuration; of two hardpoints, as long as their distance.
    pub(crate) fn vector(&self, direction: Direction) -> Vec3 {
        match direction {
            Direction::Along(u) => u,
            Direction::Through(a, b) => self.position(b) - self.position(a),
        }
    }
}
