//! The published JSON Schema of model files.
//!
//! The types here mirror the format for editors: their doc comments are the hover texts. The reader in
//! `read.rs` gives better messages than a schema can and does not use them; tests hold both together.
#![expect(dead_code, reason = "the types are only ever described, never made")]

use std::borrow::Cow;
use std::collections::BTreeMap;

use hardpoint::joint;
use hardpoint::model::{AxleMeasure, WheelMeasure, WheelNeed};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Serialize;

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
    /// Named numbers, which expressions in quotes may use wherever a number stands. Each is a design variable, unless it
    /// says otherwise or is itself given by an expression.
    #[schemars(default)]
    parameters: BTreeMap<Name, ParameterSchema>,
    /// Named points of the design configuration: `name = [x, y, z]`, global, in the length unit. Expressions may use
    /// coordinates of others, like `"-left.y"`.
    #[schemars(default)]
    hardpoints: BTreeMap<Name, [NumberSchema; 3]>,
    /// Rigid bodies. `ground` is always there and is not declared.
    bodies: BTreeMap<Name, BodySchema>,
    /// Joints between two bodies.
    #[schemars(default)]
    joints: BTreeMap<Name, JointSchema>,
    /// Gears, racks, belts and other linear relations between joint coordinates.
    #[schemars(default)]
    couplers: BTreeMap<Name, CouplerSchema>,
    /// Prescribed motions: of joint coordinates, points, distances and orientations.
    #[schemars(default)]
    drivers: BTreeMap<Name, DriverSchema>,
    /// Design variables: what may change in the design, and how everything else follows.
    #[schemars(default)]
    design: BTreeMap<Name, VariableSchema>,
    /// Points of bodies to follow.
    #[schemars(default)]
    points: BTreeMap<Name, PointSchema>,
    /// Road wheels, for what is measured at them.
    #[schemars(default)]
    wheels: BTreeMap<Name, WheelSchema>,
    /// What is known of the vehicle, for anti-dive and Ackermann.
    vehicle: Option<VehicleSchema>,
    /// Pairs of wheels, for what is measured at both.
    #[schemars(default)]
    axles: BTreeMap<Name, AxleSchema>,
    /// Numbers that sum measures up over the motion, with their sensitivities.
    #[schemars(default)]
    metrics: BTreeMap<Name, MetricSchema>,
    /// Numbers to compute from the motion, with their sensitivities.
    #[schemars(default)]
    measures: BTreeMap<Name, MeasureSchema>,
    /// The output times.
    time: TimeSchema,
}

/// A name of at most 100 characters.
type Name = String;

/// A number, or an expression over parameters, in quotes.
#[derive(Default, Serialize)]
struct NumberSchema(f64);

impl JsonSchema for NumberSchema {
    fn schema_name() -> Cow<'static, str> {
        "NumberSchema".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "type": ["number", "string"],
            // No mere number in quotes, nor one with its unit.
            "pattern": r"^(?!\s*[-+]?[0-9.,]+([eE][-+]?[0-9]+)?\s*([A-DF-Za-df-z].*)?$)",
            "description": "A number, or an expression over parameters, in quotes."
        })
    }
}

/// A plain number, or a table with its value and more.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum ParameterSchema {
    Plain(NumberSchema),
    Table(ParameterTableSchema),
}

/// A named number.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct ParameterTableSchema {
    /// Its value; an expression makes it follow others.
    value: NumberSchema,
    /// What it measures, and so its unit. Default: a plain number.
    unit: Option<ParameterUnitSchema>,
    /// The lowest and the highest value that it may have in other designs.
    bounds: Option<[NumberSchema; 2]>,
    /// How large a change of it is usual.
    typical: Option<NumberSchema>,
    /// By how much it may be off when it is made, either way.
    tolerance: Option<NumberSchema>,
    /// Whether it is a design variable. Default: true.
    design: Option<bool>,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum ParameterUnitSchema {
    /// In the file's unit of length.
    Length,
    /// In the file's unit of angle; in expressions in rad.
    Angle,
    /// A plain number.
    Number,
}

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
    euler: Option<[NumberSchema; 3]>,
    /// Quaternion `[w, x, y, z]`, of any length, instead of `euler`.
    quaternion: Option<[NumberSchema; 4]>,
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
    At([NumberSchema; 3]),
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
    /// Where it is: a hardpoint's name or coordinates; or a list of two, one on each body: for rods and legs, and for other
    /// joints that are drawn apart and have to be assembled. May be left out where the axis goes through hardpoints (then
    /// it is the first of them), and where only directions matter.
    at: Option<PlacesSchema>,
    /// The axis, in the design configuration.
    axis: Option<LineSchema>,
    /// The second axis: square to the first, or the axis on body j, as the joint type has it.
    axis2: Option<LineSchema>,
    /// Length of a rod, in the length unit. Default: the distance between its places. Where it differs from that, the
    /// mechanism is assembled to it.
    length: Option<NumberSchema>,
    /// Advance of a screw per turn, in the length unit; negative for a left-hand thread.
    lead: Option<NumberSchema>,
    /// The curve on body i that a point of body j follows, for the joint type `point_on_curve`.
    curve: Option<CurveSchema>,
    /// Whether loops should be cut at this joint. Results do not depend on it.
    #[schemars(default)]
    cut: bool,
}

/// A smooth curve through points in the design configuration, in the plane square to the joint's axis.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct CurveSchema {
    /// Its points in order: hardpoints' names or coordinates.
    points: Vec<PlaceSchema>,
    /// Whether it returns to its first point, as the curve of a cam does; that point is not repeated.
    #[schemars(default)]
    closed: bool,
}

/// The joint types, with their aliases.
struct JointTypeSchema;

impl JsonSchema for JointTypeSchema {
    fn schema_name() -> Cow<'static, str> {
        "JointTypeSchema".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let mut names = Vec::new();
        for t in joint::ALL {
            let coordinates: Vec<_> = t.coordinates.iter().map(|c| format!("`{}`", c.name)).collect();
            let coordinates = match coordinates.as_slice() {
                [] => String::new(),
                [one] => format!(" Coordinate: {one}."),
                several => format!(" Coordinates: {}.", several.join(", ")),
            };
            let mut summary = t.summary.to_owned();
            summary[..1].make_ascii_uppercase();
            let description = format!("{summary}.{coordinates}");
            names.push(json_schema!({ "type": "string", "const": t.name, "description": description }));
            for alias in t.aliases {
                let description = format!("Another name of `{}`. {description}", t.name);
                names.push(json_schema!({ "type": "string", "const": alias, "description": description }));
            }
        }
        json_schema!({ "oneOf": names })
    }
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
    Vector([NumberSchema; 3]),
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
    Vector([NumberSchema; 3]),
}

/// A coupler: it holds a linear relation between joint coordinates, each counted about or along its own joint's axis, of
/// body j relative to body i.
#[derive(JsonSchema)]
#[schemars(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
enum CouplerSchema {
    /// Two gears: `teeth[0] angle[0] + teeth[1] angle[1] = 0`, or minus for an internal gear.
    Gear {
        /// Names of the two joints that carry the gears.
        joints: [Name; 2],
        /// Numbers of teeth, or any two numbers in their ratio.
        teeth: [NumberSchema; 2],
        /// Whether one of them is an internal gear, so that both turn the same way.
        #[schemars(default)]
        internal: bool,
    },
    /// Two bevel gears, with the same relation as `gear`.
    Bevel {
        /// Names of the two joints that carry the gears.
        joints: [Name; 2],
        /// Numbers of teeth, or any two numbers in their ratio.
        teeth: [NumberSchema; 2],
        /// Whether one of them is an internal gear, so that both turn the same way.
        #[schemars(default)]
        internal: bool,
    },
    /// A rack and its pinion: `displacement = radius x angle`.
    Rack {
        /// Name of the joint on which the rack slides.
        rack: Name,
        /// Name of the joint on which the pinion turns.
        pinion: Name,
        /// Pitch radius, in the length unit; negative where the rack passes the pinion's other side.
        radius: NumberSchema,
    },
    /// Another name of `rack`.
    RackAndPinion {
        /// Name of the joint on which the rack slides.
        rack: Name,
        /// Name of the joint on which the pinion turns.
        pinion: Name,
        /// Pitch radius, in the length unit; negative where the rack passes the pinion's other side.
        radius: NumberSchema,
    },
    /// A belt or chain: `radii[0] angle[0] = radii[1] angle[1]`, or minus for a crossed one.
    Belt {
        /// Names of the two joints that carry the pulleys.
        joints: [Name; 2],
        /// Radii of the pulleys, in the length unit.
        radii: [NumberSchema; 2],
        /// Whether the belt crosses between them.
        #[schemars(default)]
        crossed: bool,
    },
    /// Any linear relation: the sum of `coefficient x coordinate` is zero.
    Linear {
        /// Two terms or more.
        terms: Vec<TermSchema>,
    },
}

/// A joint coordinate times a number.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct TermSchema {
    /// The joint's name.
    joint: Name,
    /// Which of its coordinates; may be left out where it has only one.
    coordinate: Option<CoordinateSchema>,
    /// The factor, per unit of the coordinate in this file.
    coefficient: NumberSchema,
}

/// A driver: what it prescribes, and its law over the time.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum DriverSchema {
    Coordinate(DrivenCoordinateSchema),
    Position(DrivenPositionSchema),
    Distance(DrivenDistanceSchema),
    Orientation(DrivenOrientationSchema),
}

/// A joint's coordinate.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct DrivenCoordinateSchema {
    /// The joint's name.
    joint: Name,
    /// Which of its coordinates; may be left out where it has only one.
    coordinate: Option<CoordinateSchema>,
    /// The coordinate over time, in the file's unit of it, counted from the design configuration.
    law: LawSchema,
}

/// The way of a point along a global direction, like wheel travel.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct DrivenPositionSchema {
    /// The point.
    point: PointRefSchema,
    /// The direction.
    along: LineSchema,
    /// The way over time, in the length unit, counted from the design configuration.
    law: LawSchema,
}

/// The change of the distance between two points, like the stroke of an actuator.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct DrivenDistanceSchema {
    /// From this point.
    from: PointRefSchema,
    /// To this one.
    to: PointRefSchema,
    /// The change of their distance over time, in the length unit, counted from the design configuration.
    law: LawSchema,
}

/// The angle by which a body has turned, seen along a direction.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct DrivenOrientationSchema {
    /// The body's name.
    body: Name,
    /// The direction, fixed in the body `relative_to`.
    about: LineSchema,
    /// The body that carries the direction. Default: `ground`.
    relative_to: Option<Name>,
    /// The angle over time, in the angle unit, counted from the design configuration.
    law: LawSchema,
}

/// The names of all joint coordinates.
struct CoordinateSchema;

impl JsonSchema for CoordinateSchema {
    fn schema_name() -> Cow<'static, str> {
        "CoordinateSchema".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let mut names: Vec<&str> = Vec::new();
        for c in joint::ALL.iter().flat_map(|t| t.coordinates) {
            if !names.contains(&c.name) {
                names.push(c.name);
            }
        }
        json_schema!({ "type": "string", "enum": names })
    }
}

/// A law of motion: an expression in `t` (seconds) such as `30*sin(2*pi*t)`, a number, or a table with a `type`; in the
/// file's unit of what is driven.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum LawSchema {
    Expression(String),
    Constant(f64),
    Kind(LawTableSchema),
}

#[derive(JsonSchema)]
#[schemars(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
enum LawTableSchema {
    /// `offset + amplitude sin(2 pi frequency t + phase)`.
    Harmonic {
        /// In the driver's unit.
        amplitude: NumberSchema,
        /// In Hz.
        frequency: NumberSchema,
        /// In the angle unit.
        #[schemars(default)]
        phase: NumberSchema,
        /// The mean, in the driver's unit.
        #[schemars(default)]
        offset: NumberSchema,
    },
    /// `offset + speed t`.
    ConstantSpeed {
        /// In the driver's unit per s.
        speed: NumberSchema,
        /// At t = 0, in the driver's unit.
        #[schemars(default)]
        offset: NumberSchema,
    },
    /// `c0 + c1 t + c2 t^2 + ...`.
    Polynomial {
        /// c0, c1, c2, ..., in the driver's unit per s to the power of the number.
        #[schemars(length(min = 1))]
        coefficients: Vec<NumberSchema>,
    },
    /// From one value smoothly to another, and at rest before and after.
    SmoothStep {
        /// The value before, in the driver's unit. Default: 0.
        #[schemars(default)]
        from: NumberSchema,
        /// The value after, in the driver's unit.
        to: NumberSchema,
        /// When it begins, in s.
        start: NumberSchema,
        /// When it ends, in s.
        end: NumberSchema,
        /// 3 (the acceleration jumps at both ends), 5 (the jerk does) or 7 (neither). Default: 5.
        degree: Option<DegreeSchema>,
    },
    /// A spline through points, given here or in a CSV file.
    Table {
        /// Pairs of time in s and value in the driver's unit, in the order of time. Either these or `file`.
        points: Option<Vec<[NumberSchema; 2]>>,
        /// A CSV file in the model's folder or below it: times in s and values in the driver's unit.
        file: Option<String>,
        /// The file's columns of time and value, by name or by number from 1. Default: the first two.
        columns: Option<[ColumnSchema; 2]>,
        /// The degree of the spline. Default: `cubic`.
        spline: Option<SplineSchema>,
        /// What is known at the first and last point. Default: `clamped`.
        ends: Option<EndsSchema>,
        /// Speed at the first point, where the ends are clamped, in the driver's unit per s.
        #[schemars(default)]
        start_speed: NumberSchema,
        /// Speed at the last point, where the ends are clamped, in the driver's unit per s.
        #[schemars(default)]
        end_speed: NumberSchema,
        /// Acceleration at the first point, of a quintic with clamped ends, in the driver's unit per s^2.
        #[schemars(default)]
        start_acceleration: NumberSchema,
        /// Acceleration at the last point, of a quintic with clamped ends, in the driver's unit per s^2.
        #[schemars(default)]
        end_acceleration: NumberSchema,
    },
    /// Laws one after the other, from t = 0 on.
    Sequence {
        /// The pieces, in order.
        #[schemars(length(min = 1, max = 500))]
        pieces: Vec<PieceSchema>,
    },
    /// An expression with named parameters.
    Expression {
        /// The expression, in `t` and the parameters.
        law: String,
        /// Names and values of the parameters.
        #[schemars(default)]
        parameters: BTreeMap<Name, NumberSchema>,
    },
}

/// A piece of a sequence.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct PieceSchema {
    /// How long it lasts, in s. The last piece may leave it out, and then has no end.
    duration: Option<NumberSchema>,
    /// Its law; `t` counts from the start of the piece.
    law: LawSchema,
    /// Whether its values count from where the piece before ended. Default: true.
    continued: Option<bool>,
}

/// 3, 5 or 7.
struct DegreeSchema;

impl JsonSchema for DegreeSchema {
    fn schema_name() -> Cow<'static, str> {
        "DegreeSchema".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "integer", "enum": [3, 5, 7] })
    }
}

/// A column's name, or its number from 1.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum ColumnSchema {
    Named(Name),
    Number(std::num::NonZeroU32),
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum SplineSchema {
    /// The acceleration is continuous.
    Cubic,
    /// The jerk is continuous too.
    Quintic,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum EndsSchema {
    /// With the speeds (and, of a quintic, accelerations) that are given; zero where they are not: from rest to rest.
    Clamped,
    /// The curve ends as a thin beam does.
    Natural,
    /// The last point is the first again, and the curve repeats for ever.
    Periodic,
}

/// A design variable, given by exactly one of `move`, `tilt`, `fields`, `markers`, `length`, `driver`.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum VariableSchema {
    Move(MoveSchema),
    Tilt(TiltSchema),
    Fields(FieldsSchema),
    Markers(MarkersSchema),
    Shape(ShapeSchema),
    Length(RodLengthSchema),
    Law(LawParameterSchema),
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
    /// The global axis square to a mirror through the origin, behind which `mirrored` hardpoints move.
    mirror: Option<MirrorSchema>,
    /// A hardpoint's name, or a list of names, that move as the mirror image of `move`.
    mirrored: Option<NamesSchema>,
    /// Whether rods and legs keep their lengths while it moves their ends.
    #[schemars(default)]
    fixed_length: bool,
    /// The lowest and the highest value that it may have; it is 0 in the file.
    bounds: Option<[NumberSchema; 2]>,
    /// How large a change of it is usual.
    typical: Option<NumberSchema>,
    /// By how much it may be off when it is made, either way.
    tolerance: Option<NumberSchema>,
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
    Vector([NumberSchema; 3]),
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum MirrorSchema {
    X,
    Y,
    Z,
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
    /// The lowest and the highest value that it may have; it is 0 in the file.
    bounds: Option<[NumberSchema; 2]>,
    /// How large a change of it is usual.
    typical: Option<NumberSchema>,
    /// By how much it may be off when it is made, either way.
    tolerance: Option<NumberSchema>,
}

/// Whole bodies change their shape, and everything on them follows.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct ShapeSchema {
    /// A body's name, or a list of names.
    shape: NamesSchema,
    /// How their points move.
    field: ShapeFieldSchema,
    /// Whether rods and legs keep their lengths while it moves their ends.
    #[schemars(default)]
    fixed_length: bool,
    /// The lowest and the highest value that it may have; it is 0 in the file.
    bounds: Option<[NumberSchema; 2]>,
    /// How large a change of it is usual.
    typical: Option<NumberSchema>,
    /// By how much it may be off when it is made, either way.
    tolerance: Option<NumberSchema>,
}

/// How the points of a body move.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum ShapeFieldSchema {
    Translate(TranslateSchema),
    Rotate(RotateSchema),
    Scale(ScaleSchema),
    Bend(BendSchema),
    Through(ThroughPointsSchema),
}

/// All the same way. A length.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct TranslateSchema {
    /// The direction, of any length.
    translate: DirectionSchema,
}

/// About a line. An angle.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct RotateSchema {
    /// The line's direction.
    rotate: LineSchema,
    /// A hardpoint on it.
    at: Name,
}

/// Away from a point. A plain number, 1 being twice the size.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct ScaleSchema {
    /// The hardpoint that stays.
    scale: Name,
    /// The only direction that grows. Default: all do.
    along: Option<LineSchema>,
}

/// Like a beam. The length by which its free end goes aside.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct BendSchema {
    /// The hardpoint where it is held, and the one where it is pushed.
    bend: [Name; 2],
    /// In which direction, of any length; only what is square to the beam counts.
    towards: DirectionSchema,
}

/// As some hardpoints move, and smoothly between them. A length.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct ThroughPointsSchema {
    /// The hardpoints.
    through: Vec<ThroughPointSchema>,
}

/// How a hardpoint moves.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct ThroughPointSchema {
    /// Its name.
    at: Name,
    /// How far, per unit of the variable; it stays where this is left out.
    #[schemars(rename = "move")]
    moves: Option<[f64; 3]>,
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
    /// The lowest and the highest value that it may have; it is 0 in the file.
    bounds: Option<[NumberSchema; 2]>,
    /// How large a change of it is usual.
    typical: Option<NumberSchema>,
    /// By how much it may be off when it is made, either way.
    tolerance: Option<NumberSchema>,
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
    v: Option<[NumberSchema; 3]>,
    /// Rates of the marker's 3-1-3 Euler angles, angle unit per unit of the parameter. Default: zero.
    #[schemars(rename = "U")]
    u: Option<[NumberSchema; 3]>,
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
    /// The lowest and the highest value that it may have; it is 0 in the file.
    bounds: Option<[NumberSchema; 2]>,
    /// How large a change of it is usual.
    typical: Option<NumberSchema>,
    /// By how much it may be off when it is made, either way.
    tolerance: Option<NumberSchema>,
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
    moves: Option<[NumberSchema; 3]>,
    /// Rotation vector per unit of the variable. Default: zero.
    turn: Option<[NumberSchema; 3]>,
}

/// The `length` that a rod is given grows. A length.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct RodLengthSchema {
    /// The rod's name.
    length: Name,
    /// Whether rods and legs keep their lengths while it moves their ends.
    #[schemars(default)]
    fixed_length: bool,
    /// The lowest and the highest value that it may have; it is 0 in the file.
    bounds: Option<[NumberSchema; 2]>,
    /// How large a change of it is usual.
    typical: Option<NumberSchema>,
    /// By how much it may be off when it is made, either way.
    tolerance: Option<NumberSchema>,
}

/// A parameter of a driver's law grows; the variable has the parameter's unit.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct LawParameterSchema {
    /// The driver's name.
    driver: Name,
    /// The parameter's name, such as `amplitude`, `c1`, `f[3]` or `piece[0].speed`.
    parameter: String,
    /// Whether rods and legs keep their lengths while it moves their ends.
    #[schemars(default)]
    fixed_length: bool,
    /// The lowest and the highest value that it may have; it is 0 in the file.
    bounds: Option<[NumberSchema; 2]>,
    /// How large a change of it is usual.
    typical: Option<NumberSchema>,
    /// By how much it may be off when it is made, either way.
    tolerance: Option<NumberSchema>,
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

/// A road wheel. Axes are x forward, y left, z up.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct WheelSchema {
    /// The body that it turns on: the knuckle.
    body: Name,
    /// Its centre in the design configuration: a hardpoint's name (and it follows the hardpoint when the design moves
    /// that), or coordinates.
    centre: PlaceSchema,
    /// Its spin axis in the design configuration, pointing outboard. Or give `toe` and `camber`.
    spin_axis: Option<LineSchema>,
    /// Toe in the design configuration, instead of a spin axis; positive for toe-in, in the angle unit.
    toe: Option<f64>,
    /// Camber in the design configuration, instead of a spin axis; positive where the wheel's top leans outboard, in the
    /// angle unit.
    camber: Option<f64>,
    /// From the centre to the ground in the wheel's plane: the loaded or rolling radius, in the length unit.
    radius: f64,
    /// On which side of the vehicle it is. Default: left where the y of its centre is positive, else right.
    side: Option<SideSchema>,
    /// A lower and an upper point of the axis that it steers about; they may be on different bodies.
    kingpin: Option<[PointRefSchema; 2]>,
    /// The driver that moves it up and down, for roll centres, bump steer and the like. Default: the only driver.
    bump: Option<Name>,
    /// At which end of the vehicle it is, for anti-dive and the like.
    end: Option<EndSchema>,
    /// What to measure, as NAME.toe and so on: `"all"` that is possible, or a list.
    measures: Option<WheelMeasuresSchema>,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum EndSchema {
    Front,
    Rear,
}

/// What is known of the vehicle besides its suspension.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct VehicleSchema {
    /// Distance of the axles, in the length unit.
    wheelbase: Option<f64>,
    /// Height of the centre of gravity above the ground, in the length unit.
    centre_of_gravity: Option<f64>,
    /// Part of the braking force that the front wheels take, 0 to 1.
    front_brake_share: Option<f64>,
    /// Part of the driving force that the front wheels give, 0 to 1.
    front_drive_share: Option<f64>,
}

/// Two wheels side by side.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct AxleSchema {
    /// The name of the left wheel.
    left: Name,
    /// The name of the right wheel.
    right: Name,
    /// What to measure, as NAME.track and so on: `"all"` that is possible, or a list.
    measures: Option<AxleMeasuresSchema>,
}

#[derive(JsonSchema)]
#[schemars(untagged)]
enum AxleMeasuresSchema {
    All(AllMeasuresSchema),
    Several(Vec<AxleMeasureSchema>),
}

/// The names of what can be measured at an axle, with their descriptions as hover texts.
struct AxleMeasureSchema;

impl JsonSchema for AxleMeasureSchema {
    fn schema_name() -> Cow<'static, str> {
        "AxleMeasureSchema".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let name = |m: &AxleMeasure| json_schema!({ "type": "string", "const": m.name(), "description": m.summary() });
        json_schema!({ "oneOf": AxleMeasure::ALL.iter().map(name).collect::<Vec<_>>() })
    }
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum SideSchema {
    Left,
    Right,
}

#[derive(JsonSchema)]
#[schemars(untagged)]
enum WheelMeasuresSchema {
    All(AllMeasuresSchema),
    Several(Vec<WheelMeasureSchema>),
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum AllMeasuresSchema {
    All,
}

/// The names of what can be measured at a wheel, with their descriptions as hover texts.
struct WheelMeasureSchema;

impl JsonSchema for WheelMeasureSchema {
    fn schema_name() -> Cow<'static, str> {
        "WheelMeasureSchema".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let name = |m: &WheelMeasure| {
            let needs = match m.needs() {
                WheelNeed::Nothing => "",
                WheelNeed::Kingpin => " Needs a kingpin.",
                WheelNeed::Bump => " Needs `bump`.",
                WheelNeed::Braking(_) => " Needs `bump`, and the vehicle's `front_brake_share`.",
                WheelNeed::Driving(_) => " Needs `bump`, and the vehicle's `front_drive_share`.",
            };
            let description = format!("{}{needs}", m.summary());
            json_schema!({ "type": "string", "const": m.name(), "description": description })
        };
        json_schema!({ "oneOf": WheelMeasure::ALL.iter().map(name).collect::<Vec<_>>() })
    }
}

/// A measure.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(clippy::large_enum_variant, reason = "no value of it is ever made")]
enum MeasureSchema {
    Own(OwnMeasureSchema),
    OfWheel(MeasureOfWheelSchema),
    OfAxle(MeasureOfAxleSchema),
}

/// A measure of an axle.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct MeasureOfAxleSchema {
    /// What to measure.
    #[schemars(rename = "type")]
    kind: AxleMeasureSchema,
    /// The axle's name.
    axle: Name,
}

/// A direction that an angle is measured from or to.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum RaySchema {
    /// From one point to another.
    Between([PointRefSchema; 2]),
    /// Fixed in a body.
    Fixed(FixedRaySchema),
    /// A global direction.
    Global(DirectionSchema),
}

/// A direction that is fixed in a body.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct FixedRaySchema {
    /// The body's name.
    body: Name,
    /// Where it points in the design configuration.
    axis: LineSchema,
}

/// A measure of a wheel.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct MeasureOfWheelSchema {
    /// What to measure.
    #[schemars(rename = "type")]
    kind: WheelMeasureSchema,
    /// The wheel's name.
    wheel: Name,
}

/// A measure of anything else.
#[derive(JsonSchema)]
#[schemars(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
enum OwnMeasureSchema {
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
    /// Angle from one direction to another: between them, 0 to 180 deg, or as seen along `about`.
    Angle {
        /// From this direction.
        from: RaySchema,
        /// To this one.
        to: RaySchema,
        /// The direction, pointing at the viewer, about which the angle is counted, counter-clockwise positive.
        about: Option<DirectionSchema>,
    },
    /// Angle between two lines, 0 to 90 deg.
    TransmissionAngle {
        /// Along this direction.
        from: RaySchema,
        /// And this one.
        to: RaySchema,
    },
    /// Velocity of a point.
    Velocity {
        /// The point.
        point: PointRefSchema,
        /// The direction of the component, of any length. Default: the magnitude.
        along: Option<DirectionSchema>,
    },
    /// Acceleration of a point.
    Acceleration {
        /// The point.
        point: PointRefSchema,
        /// The direction of the component, of any length. Default: the magnitude.
        along: Option<DirectionSchema>,
    },
    /// Curvature of a point's path.
    Curvature {
        /// The point.
        point: PointRefSchema,
        /// The direction, pointing at the viewer, seen along which a turn to the left is positive. Default: all are.
        about: Option<DirectionSchema>,
    },
    /// Time derivative of another measure.
    Rate {
        /// The name of the measure, or `POINT.x`.
        of: Name,
    },
    /// How much one measure changes per change of another while one driver alone moves, like a motion ratio.
    Slope {
        /// Of this measure, or `POINT.x`.
        of: Name,
        /// Over this one.
        over: Name,
        /// The driver that moves. Default: the only one.
        driver: Option<Name>,
    },
    /// A formula over other measures.
    Expression {
        /// Like `front_left.toe + front_right.toe`; lengths are in the file's unit, angles in rad.
        expression: String,
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

/// One number for a whole curve.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct MetricSchema {
    /// The name of the measure, or `POINT.x`.
    of: Name,
    /// What to take of its curve.
    take: TakeSchema,
    /// The abscissa: the name of a measure, or `POINT.x`. Default: time.
    over: Option<Name>,
    /// For a value or slope: where, in the unit of the abscissa.
    at: Option<f64>,
    /// The part of the curve that counts, from where to where its abscissa goes. Default: all of it.
    window: Option<[f64; 2]>,
    /// For `rms`: points `[abscissa, value]` of the curve to compare with, straight lines between them. Default: zero.
    target: Option<Vec<[f64; 2]>>,
}

/// What a metric takes.
#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum TakeSchema {
    /// The least value.
    Min,
    /// The greatest value.
    Max,
    /// The greatest less the least value.
    Range,
    /// The mean over the output times.
    Mean,
    /// The root of the mean square of what is left beyond the target.
    Rms,
    /// The value where the abscissa first is `at`.
    Value,
    /// The change per change of the abscissa where that first is `at`.
    Slope,
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
    start: NumberSchema,
    /// The last output time.
    end: NumberSchema,
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
    at: Vec<NumberSchema>,
}
