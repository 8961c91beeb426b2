//! The published JSON Schema of model files.
//!
//! The types here mirror the format for editors: their doc comments are the hover texts. The reader in
//! `read.rs` gives better messages than a schema can and does not use them; tests hold both together.
#![expect(dead_code, reason = "the types are only ever described, never made")]

use std::collections::BTreeMap;

use schemars::JsonSchema;

/// The JSON Schema of model files, as `models/hardpoint.schema.json` has it.
///
/// ```
/// assert!(hardpoint_file::schema().contains("\"hardpoints\""));
/// ```
pub fn schema() -> String {
    let schema = schemars::schema_for!(ModelSchema);
    let mut text = serde_json::to_string_pretty(&schema).expect("a schema is plain JSON");
    text.push('\n');
    text
}

/// A mechanism for Hardpoint.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields, rename = "Hardpoint model")]
struct ModelSchema {
    /// The mechanism's name, for headings.
    name: String,
    /// What it is and where its numbers come from.
    description: Option<String>,
    /// The units of all numbers in this file. Time is always in seconds.
    units: UnitsSchema,
    /// Named points of the design configuration: `name = [x, y, z]`, global, in the length unit.
    #[schemars(default)]
    hardpoints: BTreeMap<Name, [f64; 3]>,
    /// Rigid bodies. `ground` is always there and is not declared.
    bodies: BTreeMap<Name, BodySchema>,
    /// Joints between two bodies.
    #[schemars(default)]
    joints: BTreeMap<Name, JointSchema>,
    /// Prescribed motions of joint coordinates.
    #[schemars(default)]
    drivers: BTreeMap<Name, DriverSchema>,
    /// Design variables: what may change in the design, and how everything else follows.
    #[schemars(default)]
    design: BTreeMap<Name, VariableSchema>,
    /// Points of bodies to follow.
    #[schemars(default)]
    points: BTreeMap<Name, PointSchema>,
    /// Numbers to compute from the motion, with their sensitivities.
    #[schemars(default)]
    measures: BTreeMap<Name, MeasureSchema>,
    /// The output times.
    time: TimeSchema,
}

/// A name of at most 100 characters.
type Name = String;

/// The units of all numbers in the file.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct UnitsSchema {
    /// Unit of every length.
    length: LengthSchema,
    /// Unit of every angle.
    angle: AngleSchema,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum LengthSchema {
    Mm,
    Cm,
    M,
    In,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum AngleSchema {
    Deg,
    Rad,
}

/// A body; `{}` is enough.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct BodySchema {
    /// Its reference frame in the design configuration. Default: origin at the mean of the body's joint
    /// places, axes parallel to the global ones. Only results expressed in the frame depend on it.
    frame: Option<FrameSchema>,
}

/// A reference frame.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum FrameSchema {
    Pose(PoseSchema),
    Points(FramePointsSchema),
}

/// By position and orientation.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct PoseSchema {
    /// Origin: coordinates or a hardpoint's name.
    position: PlaceSchema,
    /// 3-1-3 Euler angles, in the angle unit.
    euler: Option<[f64; 3]>,
    /// Quaternion `[w, x, y, z]`, of any length, instead of `euler`.
    quaternion: Option<[f64; 4]>,
}

/// By three points.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct FramePointsSchema {
    /// The origin.
    origin: PlaceSchema,
    /// A point on the x axis.
    x: PlaceSchema,
    /// A point in the xy plane, on the side of +y.
    xy: PlaceSchema,
}

/// A hardpoint's name, or global coordinates in the design configuration.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum PlaceSchema {
    Hardpoint(Name),
    At([f64; 3]),
}

/// A joint between bodies i and j.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct JointSchema {
    /// The joint type.
    #[schemars(rename = "type")]
    kind: JointTypeSchema,
    /// Names of bodies i and j. Coordinates are those of j relative to i.
    bodies: [Name; 2],
    /// Where it is: a hardpoint's name or coordinates; for `distance` and `leg` a list of two, one on each
    /// body. May be left out where the axis goes through hardpoints: then it is the first of them.
    at: Option<PlacesSchema>,
    /// The axis, in the design configuration.
    axis: Option<LineSchema>,
    /// The second axis of a universal joint, square to the first.
    axis2: Option<LineSchema>,
    /// Whether loops should be cut at this joint. Results do not depend on it.
    #[schemars(default)]
    cut: bool,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum JointTypeSchema {
    /// No relative motion.
    Fixed,
    /// Turns about `axis`. Coordinate: `angle`.
    Revolute,
    /// Slides along `axis`. Coordinate: `displacement`.
    Translational,
    /// Turns about and slides along `axis`. Coordinates: `angle`, `displacement`.
    Cylindrical,
    /// A ball joint.
    Spherical,
    /// A cross: its pin `axis` turns in body i, its pin `axis2` in body j.
    Universal,
    /// A rod of constant length between two points.
    Distance,
    /// A length between two points that a driver prescribes or a measure reads. Coordinate: `length`.
    Leg,
}

#[derive(JsonSchema)]
#[schemars(untagged)]
enum PlacesSchema {
    One(PlaceSchema),
    Two([PlaceSchema; 2]),
}

/// A direction: a global axis, a vector of any length, or through two hardpoints.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum LineSchema {
    Axis(AxisSchema),
    Vector([f64; 3]),
    Through(ThroughSchema),
}

/// From the first hardpoint to the second. It follows them when the design moves them.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct ThroughSchema {
    /// Names of two hardpoints.
    through: [Name; 2],
}

/// A global axis.
#[derive(JsonSchema)]
enum AxisSchema {
    #[schemars(rename = "x")]
    X,
    #[schemars(rename = "y")]
    Y,
    #[schemars(rename = "z")]
    Z,
    #[schemars(rename = "-x")]
    MinusX,
    #[schemars(rename = "-y")]
    MinusY,
    #[schemars(rename = "-z")]
    MinusZ,
}

/// A fixed direction: a global axis or a vector of any length.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum DirectionSchema {
    Axis(AxisSchema),
    Vector([f64; 3]),
}

/// A driver: one joint coordinate as a function of the time.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct DriverSchema {
    /// The joint's name.
    joint: Name,
    /// Which of its coordinates; may be left out where it has only one.
    coordinate: Option<CoordinateSchema>,
    /// An expression in `t` (seconds), such as `30*sin(2*pi*t)`, or a number; in the file's unit of the coordinate.
    law: LawSchema,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum CoordinateSchema {
    Angle,
    Displacement,
    Length,
}

#[derive(JsonSchema)]
#[schemars(untagged)]
enum LawSchema {
    Expression(String),
    Constant(f64),
}

/// A design variable, given by exactly one of `move`, `tilt`, `fields`, `markers`.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum VariableSchema {
    Move(MoveSchema),
    Tilt(TiltSchema),
    Fields(FieldsSchema),
    Markers(MarkersSchema),
}

/// Hardpoints move; all joints, axes and points on them follow. A length.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct MoveSchema {
    /// A hardpoint's name, or a list of names that move together.
    #[schemars(rename = "move")]
    moves: NamesSchema,
    /// The direction; `"xyz"` makes three variables, NAME_x, NAME_y and NAME_z.
    along: AlongSchema,
    /// Whether rods and legs keep their lengths while it moves their ends.
    #[schemars(default)]
    fixed_length: bool,
}

#[derive(JsonSchema)]
#[schemars(untagged)]
enum NamesSchema {
    One(Name),
    Several(Vec<Name>),
}

#[derive(JsonSchema)]
#[schemars(untagged)]
enum AlongSchema {
    Axis(AxisSchema),
    All(AllAxesSchema),
    Vector([f64; 3]),
}

#[derive(JsonSchema)]
enum AllAxesSchema {
    #[schemars(rename = "xyz")]
    Xyz,
}

/// Both markers of a joint turn about a direction through their place. An angle.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct TiltSchema {
    /// The joint's name.
    tilt: Name,
    /// The direction to turn about.
    about: LineSchema,
    /// Whether rods and legs keep their lengths while it moves their ends.
    #[schemars(default)]
    fixed_length: bool,
}

/// Design velocities V and U of single markers, under one parameter. A plain number.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct FieldsSchema {
    /// The markers.
    fields: Vec<FieldSchema>,
    /// Whether rods and legs keep their lengths while it moves their ends.
    #[schemars(default)]
    fixed_length: bool,
}

/// The design velocity of one joint's marker on one body, in that body's frame.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct FieldSchema {
    /// The joint's name.
    joint: Name,
    /// The body whose marker it is.
    body: Name,
    /// Location velocity, length unit per unit of the parameter. Default: zero.
    #[schemars(rename = "V")]
    v: Option<[f64; 3]>,
    /// Rates of the marker's 3-1-3 Euler angles, angle unit per unit of the parameter. Default: zero.
    #[schemars(rename = "U")]
    u: Option<[f64; 3]>,
}

/// Markers of joints move and turn by themselves; hardpoints stay.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct MarkersSchema {
    /// The markers.
    markers: Vec<MarkerSchema>,
    /// Whether rods and legs keep their lengths while it moves their ends.
    #[schemars(default)]
    fixed_length: bool,
}

/// A global velocity of a joint's markers.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct MarkerSchema {
    /// The joint's name.
    joint: Name,
    /// The marker on body i, on body j, or both. Default: both.
    on: Option<OnSchema>,
    /// Displacement per unit of the variable. Default: zero.
    #[schemars(rename = "move")]
    moves: Option<[f64; 3]>,
    /// Rotation vector per unit of the variable. Default: zero.
    turn: Option<[f64; 3]>,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum OnSchema {
    I,
    J,
    Both,
}

/// A point of a body.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct PointSchema {
    /// The body's name.
    body: Name,
    /// Where it is in the design configuration: a hardpoint's name (and it follows the hardpoint when the
    /// design moves that), or coordinates.
    at: PlaceSchema,
}

/// A point: by name, or a place on a body.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum PointRefSchema {
    Named(Name),
    On(PointSchema),
}

/// A measure.
#[derive(JsonSchema)]
#[schemars(tag = "type", rename_all = "lowercase", deny_unknown_fields)]
enum MeasureSchema {
    /// A joint's coordinate, counted from the design configuration; of a rod or leg the whole length.
    Coordinate {
        /// The joint's name.
        joint: Name,
        /// Which of its coordinates; may be left out where it has only one.
        coordinate: Option<CoordinateSchema>,
    },
    /// Distance between two points.
    Distance {
        /// From this point.
        from: PointRefSchema,
        /// To this one.
        to: PointRefSchema,
    },
    /// Position of a point along a global direction.
    Position {
        /// The point.
        point: PointRefSchema,
        /// The direction, of any length.
        along: DirectionSchema,
    },
    /// Toe of a left wheel, positive for toe-in.
    Toe {
        /// The body that the wheel turns on.
        body: Name,
        /// The wheel's spin axis in the design configuration, pointing outboard.
        spin_axis: LineSchema,
    },
    /// Camber of a left wheel, positive where its top leans outboard.
    Camber {
        /// The body that the wheel turns on.
        body: Name,
        /// The wheel's spin axis in the design configuration, pointing outboard.
        spin_axis: LineSchema,
    },
}

/// The output times, in seconds.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum TimeSchema {
    Steps(StepsSchema),
    At(TimesSchema),
}

/// Evenly spaced.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct StepsSchema {
    /// The first output time. Default: 0.
    #[schemars(default)]
    start: f64,
    /// The last output time.
    end: f64,
    /// How many intervals: there is one output time more.
    #[schemars(range(min = 1, max = 1_000_000))]
    steps: u32,
}

/// One by one.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct TimesSchema {
    /// The output times, increasing.
    #[schemars(length(min = 1))]
    at: Vec<f64>,
}
