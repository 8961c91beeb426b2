// Written by the tests of `crates/hardpoint-report/src/page.rs`; change the structs there.

/**
 * One number per output step, kept as `f32`; NaN means "no value at this step" and is drawn as a gap.
 *
 * In the page it is a list of tracks of the packed block, whose values follow each other in turn: see
 * [`crate::encoding`]. It cannot be serialised before it is packed.
 *
 * ```
 * use hardpoint_report::page::Curve;
 * let curve = Curve::from(&[1.0, -2.0][..]);
 * assert_eq!(curve.values(), [1.0, -2.0]);
 * assert!(serde_json::to_string(&curve).is_err());
 * ```
 */
export type Curve = Array<number>;

/**
 * Everything one report shows. Lengths, angles and times are in [`Payload::units`].
 */
export type Payload = {
/**
 * Headline, usually the model's title.
 */
title: string,
/**
 * Description in the model file; may be empty.
 */
description: string,
/**
 * Name of the model file.
 */
file: string,
/**
 * Program and version that made the report.
 */
generator: string,
/**
 * The user's units.
 */
units: Units,
/**
 * True if the whole motion was solved.
 */
status: Status,
/**
 * A handful of figures for the top of the page.
 */
summary: Array<Fact>,
/**
 * Sentences about the model that are no errors.
 */
notes: Array<string>,
/**
 * Output times, `n` steps, ascending.
 */
times: Curve,
/**
 * Bodies; the first is ground, whose pose is constant.
 */
bodies: Array<BodyTrack>,
/**
 * Joints and constraints that have a place to be drawn at.
 */
joints: Array<JointMark>,
/**
 * Gears, belts, racks, screws and other relations between the joints' coordinates.
 */
couplers: Array<CouplerMark>,
/**
 * Driven coordinates.
 */
drivers: Array<DriverMark>,
/**
 * Road wheels.
 */
wheels: Array<WheelMark>,
/**
 * Distances that are measured between two bodies: springs and dampers are often given so.
 */
distances: Array<DistanceMark>,
/**
 * Forces on bodies, of joints first; of a model in which something has mass or pushes.
 */
loads: Array<LoadMark>,
/**
 * The vehicle's own axes in the world, where the mechanism belongs to one.
 */
vehicle: VehicleAxes | null,
/**
 * Quantities that can be plotted over time.
 */
quantities: Array<Quantity>,
/**
 * Single numbers that the design is judged by: metrics, then the static values of measures.
 */
values: Array<Value>,
/**
 * The quantity that the page opens on, an index into [`Payload::quantities`].
 */
first: number | null,
/**
 * The quantity over which the page draws that one at first, an index into [`Payload::quantities`]; over time where
 * there is none.
 */
over: number | null,
/**
 * Other designs over the same motion, to be compared with this one: changed, predicted, re-solved.
 */
designs: Array<Design>,
/**
 * Measures over grids of two drivers.
 */
maps: Array<GridMap>,
/**
 * Designs that were swept over.
 */
sweep: SweepPlot | null,
/**
 * Margin from singular positions over time, if anything is solved for.
 */
margin: Margin | null,
/**
 * Design variables with their sensitivities.
 */
variables: Array<Variable>,
/**
 * Facts about the model: bodies, joints, constraints, redundancy, admissibility.
 */
checks: Array<Table>,
/**
 * The model's text: from it the page solves what the reader changes.
 */
model: ModelText | null, };

/**
 * The text of a model, with all that is read besides it.
 */
export type ModelText = {
/**
 * Name of the file.
 */
file: string,
/**
 * The text.
 */
text: string,
/**
 * The files that it names, but for meshes.
 */
files: { [key in string]: string },
/**
 * The case whose motion this is, where the model has cases.
 */
case: string | null,
/**
 * Detail of the motion on the page; as much as fits if it is not given.
 */
shown: Detail | null, };

/**
 * Detail of a motion on the page.
 */
export type Detail = {
/**
 * Every that many steps of those that are kept.
 */
stride: number,
/**
 * Curves of body origins.
 */
origins: boolean,
/**
 * Motion of bodies by the variables, and with that the sensitivities of their origins.
 */
bodies: boolean,
/**
 * Sensitivities of the velocities and accelerations of body origins.
 */
body_rates: boolean,
/**
 * Comparison of the sensitivities of body origins with differences.
 */
body_differences: boolean, };

/**
 * Unit symbols as the user writes them.
 */
export type Units = {
/**
 * For example `mm`.
 */
length: string,
/**
 * For example `deg`.
 */
angle: string,
/**
 * For example `s`.
 */
time: string, };

/**
 * Status at the end of the run.
 */
export type Status = {
/**
 * False when the motion, or that of a design beside it, stops before its last step; the page then says so in a
 * banner.
 */
complete: boolean,
/**
 * One sentence.
 */
message: string, };

/**
 * A labelled figure, already formatted with its unit.
 */
export type Fact = {
/**
 * Label of the figure.
 */
label: string,
/**
 * The figure.
 */
value: string, };

/**
 * A body, its hardpoints and where it was.
 */
export type BodyTrack = {
/**
 * The user's name.
 */
name: string,
/**
 * Pose in the world, 7 numbers per step: x y z, then the unit quaternion w x y z (`world_from_body`).
 */
poses: Curve,
/**
 * Hardpoints in the body frame.
 */
skeleton: Array<[number, number, number]>,
/**
 * Names of the hardpoints, in the order of `skeleton`.
 */
labels: Array<string>,
/**
 * Roles of the points, in the order of `skeleton`.
 */
roles: Array<PointRole>,
/**
 * The body's own shape, where the model names a file of it.
 */
mesh: Mesh | null, };

/**
 * Role of a hardpoint of a body; of several roles the first.
 */
export type PointRole = "joint" | "hinge" | "wheel" | "measured";

/**
 * A triangle mesh in the body's frame.
 */
export type Mesh = {
/**
 * Name of the file.
 */
file: string,
/**
 * Three coordinates per vertex.
 */
positions: Curve,
/**
 * Three vertices per triangle: numbers below 2^24, which `f32` holds exactly.
 */
triangles: Curve, };

/**
 * A joint or constraint between two bodies.
 */
export type JointMark = {
/**
 * The user's name.
 */
name: string,
/**
 * `revolute`, `spherical`, `translational`, `distance`, ...; an unknown kind gets a neutral mark.
 */
kind: string,
/**
 * Index into [`Payload::bodies`].
 */
body_i: number,
/**
 * Index into [`Payload::bodies`].
 */
body_j: number,
/**
 * Place on body i, in its frame.
 */
at_i: [number, number, number],
/**
 * Place on body j, in its frame.
 */
at_j: [number, number, number],
/**
 * Unit vector along the joint's axis in the frame of body i, where the kind has one.
 */
axis: [number, number, number] | null,
/**
 * The same in the frame of body j; in the design configuration the two agree, but for kinds with an axis on each
 * body.
 */
axis_j: [number, number, number] | null,
/**
 * Unit vector along the second axis, where there is one: in the frame of body j for `universal`,
 * `constant_velocity`, `dot1` and `angle`, in that of body i for others.
 */
axis2: [number, number, number] | null,
/**
 * The two hardpoints that the axis passes through in the design configuration, in the frame of body i, where it is
 * given so.
 */
hinge: [[number, number, number], [number, number, number]] | null,
/**
 * Travel per turn of a screw.
 */
lead: number | null,
/**
 * The curve that a point of body j follows, as points in the frame of body i.
 */
curve: JointCurve | null,
/**
 * Shape in drawings, if the model gives one: `coilover`, `spring`, `damper`, `cylinder` or `rod`.
 */
draw: string | null,
/**
 * True if the joint closes a loop instead of carrying body j.
 */
cut: boolean, };

/**
 * A planar curve on a body, sampled finely enough to be drawn.
 */
export type JointCurve = {
/**
 * True if its last point is followed by its first.
 */
closed: boolean,
/**
 * Points in the frame of the body.
 */
points: Array<[number, number, number]>,
/**
 * Unit normal of its plane.
 */
normal: [number, number, number], };

/**
 * A linear relation between joint coordinates: `sum of coefficient x coordinate = 0`.
 */
export type CouplerMark = {
/**
 * The user's name.
 */
name: string,
/**
 * `gear`, `bevel`, `rack`, `belt`, `screw`, `linear`: as the model file says.
 */
kind: string,
/**
 * Terms: of a rack first the rack, then the pinion.
 */
terms: Array<CouplerTerm>,
/**
 * Teeth of two gears, radii of two pulleys, radius of a rack's pinion, lead of a screw: as the model file says.
 */
sizes: Array<number>, };

/**
 * A joint coordinate with its factor.
 */
export type CouplerTerm = {
/**
 * Index into [`Payload::joints`].
 */
joint: number,
/**
 * True if the coordinate is an angle; a length otherwise.
 */
turns: boolean,
/**
 * Per length unit or per radian of the coordinate.
 */
coefficient: number, };

/**
 * Coordinate that a driver drives.
 */
export type DriverMark = {
/**
 * The user's name.
 */
name: string,
/**
 * Law in words.
 */
law: string,
/**
 * Index into [`Payload::joints`], where a joint is driven that is drawn.
 */
joint: number | null,
/**
 * True if the driven coordinate is an angle; a length otherwise.
 */
turns: boolean,
/**
 * The body whose point is driven, and the point in its frame, where that is so.
 */
point: BodyPlace | null,
/**
 * Unit vector in the world along which the point is driven, or about which the body is turned at it.
 */
along: [number, number, number] | null,
/**
 * The driven coordinate, `n` steps, in the length unit or in radians, counted from the drawing.
 */
travel: Curve,
/**
 * If several drivers move: rate of each of the first of [`Payload::quantities`] by this driver while the others
 * are at rest, in its unit per length unit or radian; empty for quantities that do not follow from positions
 * alone.
 */
alone: Array<Curve>, };

/**
 * A place on a body.
 */
export type BodyPlace = {
/**
 * Index into [`Payload::bodies`].
 */
body: number,
/**
 * In the body's frame.
 */
at: [number, number, number], };

/**
 * A road wheel.
 */
export type WheelMark = {
/**
 * The user's name.
 */
name: string,
/**
 * Centre, on the body that carries it.
 */
centre: BodyPlace,
/**
 * Unit vector along its spin axis, outboard, in that body's frame.
 */
axis: [number, number, number],
/**
 * From the centre to the ground.
 */
radius: number,
/**
 * Lower and upper point of the axis that it steers about, where there is one.
 */
kingpin: [BodyPlace, BodyPlace] | null, };

/**
 * A distance that is measured between two places.
 */
export type DistanceMark = {
/**
 * Name of the measure.
 */
name: string,
/**
 * From where.
 */
from: BodyPlace,
/**
 * To where.
 */
to: BodyPlace,
/**
 * Shape in drawings, if the model gives one; see [`JointMark::draw`].
 */
draw: string | null, };

/**
 * A force on a body: what a joint puts on its second body, or what a spring or another force puts on a point.
 */
export type LoadMark = {
/**
 * The user's name of the joint or the force.
 */
name: string,
/**
 * Index into [`Payload::joints`], where a joint puts it there.
 */
joint: number | null,
/**
 * Point of action.
 */
at: BodyPlace,
/**
 * Three numbers per step: the force in the world, N. What redundant constraints leave open is left out; not a
 * number where nothing is known.
 */
force: Curve,
/**
 * True if something is left out of it at any time.
 */
is_part: boolean, };

/**
 * Unit vectors in the world.
 */
export type VehicleAxes = {
/**
 * Direction of travel.
 */
forward: [number, number, number],
/**
 * Upwards.
 */
up: [number, number, number], };

/**
 * Something that can be plotted over time, with its two time derivatives.
 */
export type Quantity = {
/**
 * The user's name, for example `toe`.
 */
name: string,
/**
 * Unit of `value`.
 */
unit: string,
/**
 * Unit of `rate`.
 */
rate_unit: string,
/**
 * Unit of `accel`.
 */
accel_unit: string,
/**
 * Heading under which it is offered: `measure`, `point`, `body` or `joint`.
 */
group: string,
/**
 * The quantity, `n` steps.
 */
value: Curve,
/**
 * First time derivative.
 */
rate: Curve,
/**
 * Second time derivative.
 */
accel: Curve,
/**
 * Target curve of a metric, `n` steps; empty without one.
 */
wanted: Curve, };

/**
 * A single number that the design is judged by.
 */
export type Value = {
/**
 * The user's name of the metric or measure.
 */
name: string,
/**
 * Kind of value, in a few words: `design configuration`, `at the start`, `range`, `largest`, ...
 */
what: string,
/**
 * Unit.
 */
unit: string,
/**
 * The number, where the motion reaches it.
 */
value: number | null,
/**
 * When it is taken, where it is taken at one time.
 */
time: number | null,
/**
 * The quantity that it is taken of, an index into [`Payload::quantities`].
 */
quantity: number | null,
/**
 * Least and largest value that is wanted, where the model says so.
 */
target: [number | null, number | null] | null,
/**
 * Derivatives by every design variable, in the order of [`Payload::variables`]; none where one cannot be followed.
 */
sensitivities: Array<number | null>, };

/**
 * Another design over the same output times. What is not known of it is empty.
 */
export type Design = {
/**
 * Name on the page: `changed`, `predicted to first order`, ...
 */
name: string,
/**
 * Source of the design.
 */
kind: DesignKind,
/**
 * By how much each variable is changed, in the order of [`Payload::variables`], in their units.
 */
change: Array<number>,
/**
 * A sentence on how the mechanism follows; may be empty.
 */
note: string,
/**
 * Poses of its bodies, as in [`BodyTrack::poses`].
 */
poses: Array<Curve>,
/**
 * Hardpoints in the bodies' frames, as in [`BodyTrack::skeleton`].
 */
skeletons: Array<Array<[number, number, number]>>,
/**
 * Forces, as in [`LoadMark::force`], in the order of [`Payload::loads`].
 */
loads: Array<Curve>,
/**
 * Quantities, in the order of [`Payload::quantities`].
 */
quantities: Array<DesignCurves | null>,
/**
 * Values, in the order of [`Payload::values`].
 */
values: Array<number | null>,
/**
 * Distance from singular positions.
 */
margin: Curve | null, };

/**
 * Source of another design.
 */
export type DesignKind = "exact" | "first_order" | "second_order" | "band";

/**
 * A quantity of another design with its two time derivatives; what is not known is empty.
 */
export type DesignCurves = {
/**
 * The quantity, `n` steps.
 */
value: Curve,
/**
 * First time derivative.
 */
rate: Curve,
/**
 * Second time derivative.
 */
accel: Curve, };

/**
 * A case that sweeps two drivers over a grid. Tables have a row for each place of the second driver, with a number for
 * each of the first.
 */
export type GridMap = {
/**
 * The case's name.
 */
name: string,
/**
 * The two drivers.
 */
drivers: [GridDriver, GridDriver],
/**
 * Number of positions that were reached, and why others were not.
 */
note: string,
/**
 * Measured quantities.
 */
quantities: Array<GridQuantity>, };

/**
 * A driver of a grid.
 */
export type GridDriver = {
/**
 * Name.
 */
name: string,
/**
 * Unit.
 */
unit: string,
/**
 * Positions, increasing.
 */
places: Array<number>, };

/**
 * A measure over a grid.
 */
export type GridQuantity = {
/**
 * Name.
 */
name: string,
/**
 * Unit.
 */
unit: string,
/**
 * Values, row by row.
 */
values: Curve,
/**
 * Derivatives by design variables; none where they would be too many for a page.
 */
sensitivities: Array<GridSensitivity>, };

/**
 * The derivative of a measure by a design variable over a grid.
 */
export type GridSensitivity = {
/**
 * The variable.
 */
variable: string,
/**
 * The derivative's unit.
 */
unit: string,
/**
 * The derivatives, row by row.
 */
values: Curve, };

/**
 * Designs that were swept over: some of them, each as a point over variables and metrics.
 */
export type SweepPlot = {
/**
 * Meaning of a point: `design`, or `posture`.
 */
what: string,
/**
 * That many were solved.
 */
designs: number,
/**
 * Point k is design `k * step`.
 */
step: number,
/**
 * The swept variables, then the metrics.
 */
axes: Array<SweepAxis>,
/**
 * Sobol's indices, where they were requested.
 */
indices: Array<SweepIndex>, };

/**
 * A variable or a metric of swept designs.
 */
export type SweepAxis = {
/**
 * Name, and the case where there are several.
 */
name: string,
/**
 * Unit.
 */
unit: string,
/**
 * True if it is a metric.
 */
metric: boolean,
/**
 * Value in each point.
 */
values: Curve, };

/**
 * Sobol's indices of a metric by a variable, each with its standard error.
 */
export type SweepIndex = {
/**
 * The metric, an index into [`SweepPlot::axes`].
 */
metric: number,
/**
 * The variable, an index into [`SweepPlot::axes`].
 */
variable: number,
/**
 * First order.
 */
first: [number, number],
/**
 * Total.
 */
total: [number, number], };

/**
 * Margin of the mechanism from singular positions: 1 is best, 0 is a singular position.
 */
export type Margin = {
/**
 * The margin, `n` steps.
 */
value: Curve,
/**
 * Meaning of its minimum.
 */
note: string, };

/**
 * A design variable: what it moves, whether the mechanism can follow, and what follows from it.
 */
export type Variable = {
/**
 * The user's name.
 */
name: string,
/**
 * Meaning in a few words; may be empty.
 */
description: string,
/**
 * Unit of the variable, `1` for a pure number.
 */
unit: string,
/**
 * True if every joint stays intact under this design change.
 */
admissibility: Admissibility,
/**
 * A sentence with the joints concerned and their defect; empty when there is nothing to say.
 */
note: string,
/**
 * The design velocity at the hardpoints it moves.
 */
arrows: Array<Arrow>,
/**
 * By how much it is typically changed, where the model says so.
 */
typical: number | null,
/**
 * By how much it may be made wrong, either way, where the model says so.
 */
tolerance: number | null,
/**
 * Least and largest change that is allowed, counted from the drawing, where the model says so.
 */
bounds: [number | null, number | null] | null,
/**
 * Per body, how it moves with the variable: six numbers per step, dx dy dz in the length unit and a rotation
 * vector in rad, per unit of the variable; empty where that is not shown.
 */
shifts: Array<Curve>,
/**
 * Sensitivities, at most one per quantity; empty when the mechanism cannot follow.
 */
sensitivities: Array<Sensitivity>, };

/**
 * True if a mechanism can follow a design variable.
 */
export type Admissibility = "admissible" | "reassembled" | "cannot_follow";

/**
 * Design velocity of one hardpoint, per unit of the variable, in the frame of its body.
 */
export type Arrow = {
/**
 * Index into [`Payload::bodies`].
 */
body: number,
/**
 * Position of the hardpoint.
 */
at: [number, number, number],
/**
 * Velocity of its location.
 */
v: [number, number, number],
/**
 * Velocity of its orientation.
 */
turn: [number, number, number], };

/**
 * Total derivative of one quantity and of its rates with respect to one design variable.
 */
export type Sensitivity = {
/**
 * Index into [`Payload::quantities`].
 */
quantity: number,
/**
 * Derivative of the quantity, `n` steps.
 */
value: Curve,
/**
 * Derivative of its first time derivative.
 */
rate: Curve,
/**
 * Derivative of its second time derivative.
 */
accel: Curve,
/**
 * The same by re-solving a changed design, when that was requested.
 */
fd: FiniteDifference | null, };

/**
 * Central differences of re-solved designs, to be compared with a [`Sensitivity`].
 */
export type FiniteDifference = {
/**
 * The curves hold every that many of the `n` steps, from the first: they are drawn as a few marks.
 */
stride: number,
/**
 * Difference quotient of the quantity.
 */
value: Curve,
/**
 * Difference quotient of its first time derivative.
 */
rate: Curve,
/**
 * Difference quotient of its second time derivative.
 */
accel: Curve,
/**
 * Change of the variable to either side.
 */
step: number,
/**
 * Unit of `step`.
 */
step_unit: string,
/**
 * Largest relative disagreement over time in value, rate and accel.
 */
worst: [number, number, number], };

/**
 * A table of facts, its cells already formatted.
 */
export type Table = {
/**
 * Heading.
 */
title: string,
/**
 * A sentence under the heading; may be empty.
 */
note: string,
/**
 * Column headings.
 */
header: Array<string>,
/**
 * Rows, each as long as `header`.
 */
rows: Array<Array<string>>, };
