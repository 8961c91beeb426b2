// Written by the tests of `crates/hardpoint-report/src/page.rs`; change the structs there.

/**
 * Type of a joint.
 */
export type JointKind = 'fixed' | 'revolute' | 'translational' | 'cylindrical' | 'spherical' | 'universal' | 'constant_velocity' | 'planar' | 'pin_in_slot' | 'screw' | 'inline' | 'inplane' | 'orientation' | 'parallel' | 'dot1' | 'dot2' | 'angle' | 'distance' | 'revolute_spherical' | 'point_on_curve' | 'leg' | 'travel' | 'heading';

/**
 * One number per output step, as `f32`; NaN means "no value at this step" and is drawn as a gap.
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
 * All data of a report. Lengths, angles and times are in [`Payload::units`].
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
 * Key figures for the top of the page.
 */
summary: Array<Fact>,
/**
 * Notes on the model that are not errors, each a sentence.
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
 * Joints and constraints that can be drawn at a location.
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
 * Distances between two bodies that are measured: often springs and dampers.
 */
distances: Array<DistanceMark>,
/**
 * Forces on bodies, those of joints first; only for models with masses or applied forces.
 */
loads: Array<LoadMark>,
/**
 * Axes of the vehicle in the world, if the mechanism belongs to one.
 */
vehicle: VehicleAxes | null,
/**
 * Quantities that can be plotted over time.
 */
quantities: Array<Quantity>,
/**
 * Single values that characterise the design: metrics, then the static values of measures.
 */
values: Array<Value>,
/**
 * Metrics with their most influential variables, of this motion or of all cases.
 */
metrics: Table | null,
/**
 * Quantity that the page shows first, an index into [`Payload::quantities`].
 */
first: number | null,
/**
 * Quantity on the abscissa of that first plot, an index into [`Payload::quantities`]; time if there is none.
 */
over: number | null,
/**
 * Plots that the model file asks for; none for those that suit the mechanism.
 */
plots: Array<Plot>,
/**
 * Other designs over the same motion for comparison: changed, predicted, re-solved.
 */
designs: Array<Design>,
/**
 * Named designs of the model file.
 */
named_designs: Array<NamedDesign>,
/**
 * Measures over grids of two drivers.
 */
maps: Array<GridMap>,
/**
 * Designs of a sweep.
 */
sweep: SweepPlot | null,
/**
 * Margin to singular positions over time, if anything is solved for.
 */
margin: Margin | null,
/**
 * Design variables with their sensitivities.
 */
variables: Array<Variable>,
/**
 * Square root R of the covariance matrix of the variables' deviations, in their units, for the page of a tolerance
 * study: a row for each variable. A curve with the derivatives g has the standard deviation |R^T g| to first
 * order.
 */
covariance_root?: Array<Array<number>>,
/**
 * Result of the study of which this is the page.
 */
study?: StudyTables,
/**
 * Facts about the model: bodies, joints, constraints, redundancy, admissibility.
 */
checks: Array<Table>,
/**
 * Shapes and the distances between them; only for models with shapes.
 */
clearance?: ClearanceMarks,
/**
 * Text of the model, from which the page solves changed designs.
 */
model: ModelText | null, };

/**
 * Text of a model with all other files that it needs.
 */
export type ModelText = {
/**
 * Name of the file.
 */
file: string,
/**
 * Contents of the file.
 */
text: string,
/**
 * Contents of the files that it names, except meshes.
 */
files: { [key in string]: string },
/**
 * Case of this motion, if the model has cases.
 */
case: string | null,
/**
 * Detail of the motion on the page; by default the highest that fits.
 */
shown: Detail | null, };

/**
 * Detail of a motion on the page.
 */
export type Detail = {
/**
 * Stride of the shown steps among the stored ones.
 */
stride: number,
/**
 * True if curves of body origins are shown.
 */
origins: boolean,
/**
 * True if the motion of bodies by the variables, and the sensitivities of their origins, are shown.
 */
bodies: boolean,
/**
 * True if sensitivities of the velocities and accelerations of body origins are shown.
 */
body_rates: boolean,
/**
 * True if the sensitivities of body origins are compared with differences.
 */
body_differences: boolean, };

/**
 * Unit symbols of the user.
 */
export type Units = {
/**
 * Length unit, for example `mm`.
 */
length: string,
/**
 * Angle unit, for example `deg`.
 */
angle: string,
/**
 * Time unit, for example `s`.
 */
time: string, };

/**
 * Status at the end of the run.
 */
export type Status = {
/**
 * False if the motion, or that of a design shown alongside, stops before its last step; the page then shows a
 * banner.
 */
complete: boolean,
/**
 * Status in one sentence.
 */
message: string, };

/**
 * Labelled figure, formatted with its unit.
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
 * Body with its hardpoints and its motion.
 */
export type BodyTrack = {
/**
 * Name of the body.
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
 * Shape of the body, if the model names a file of it.
 */
mesh: Mesh | null, };

/**
 * Role of a hardpoint of a body; the first one that applies.
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
 * Three vertices per triangle: integers below 2^24, which `f32` represents exactly.
 */
triangles: Curve, };

/**
 * Joint or constraint between two bodies.
 */
export type JointMark = {
/**
 * Name of the joint.
 */
name: string,
/**
 * Type.
 */
kind: JointKind,
/**
 * Index into [`Payload::bodies`].
 */
body_i: number,
/**
 * Index into [`Payload::bodies`].
 */
body_j: number,
/**
 * Location on body i, in its frame.
 */
at_i: [number, number, number],
/**
 * Location on body j, in its frame.
 */
at_j: [number, number, number],
/**
 * Unit vector along the joint's axis in the frame of body i, if the type has one.
 */
axis: [number, number, number] | null,
/**
 * Unit vector along the joint's axis in the frame of body j. In the design configuration both agree, except for
 * types with an axis on each body.
 */
axis_j: [number, number, number] | null,
/**
 * Unit vector along the second axis, if there is one: in the frame of body j for `universal`, `constant_velocity`,
 * `dot1` and `angle`, in that of body i for others.
 */
axis2: [number, number, number] | null,
/**
 * Straight guide between the bodies, if the type has one.
 */
slide: SlideMark | null,
/**
 * Hardpoints that define the axis in the design configuration, in the frame of body i, if it is defined by two.
 */
hinge: [[number, number, number], [number, number, number]] | null,
/**
 * Travel per revolution of a screw.
 */
lead: number | null,
/**
 * Curve that a point of body j follows, as points in the frame of body i.
 */
curve: JointCurve | null,
/**
 * Shape in drawings, if the model defines one: `coilover`, `spring`, `damper`, `cylinder` or `rod`.
 */
draw: string | null,
/**
 * True if the joint closes a loop (cut joint) instead of carrying body j (tree joint).
 */
cut: boolean, };

/**
 * Straight guide of a joint.
 */
export type SlideMark = {
/**
 * Unit vector along it in the frame of body i; `None` for a plane perpendicular to the joint's axis.
 */
along: [number, number, number] | null,
/**
 * True if either body may be the rail; otherwise it is body i.
 */
either: boolean, };

/**
 * Planar curve on a body, sampled finely enough for drawing.
 */
export type JointCurve = {
/**
 * True if the last point connects to the first.
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
 * Linear relation between joint coordinates: `sum of coefficient x coordinate = 0`.
 */
export type CouplerMark = {
/**
 * Name of the coupler.
 */
name: string,
/**
 * Type in the model file.
 */
kind: CouplerKind,
/**
 * Terms; for a rack the rack first, then the pinion.
 */
terms: Array<CouplerTerm>,
/**
 * Sizes in the model file: teeth of two gears, radii of two pulleys, radius of a rack's pinion, lead of a screw.
 */
sizes: Array<number>, };

/**
 * Type of a coupler in the model file.
 */
export type CouplerKind = "gear" | "bevel" | "rack" | "belt" | "screw" | "linear";

/**
 * Joint coordinate with its factor.
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
 * Factor per length unit or per radian of the coordinate.
 */
coefficient: number, };

/**
 * Driven coordinate.
 */
export type DriverMark = {
/**
 * Name of the driver.
 */
name: string,
/**
 * Law in words.
 */
law: string,
/**
 * Index into [`Payload::joints`], if the driven joint is drawn.
 */
joint: number | null,
/**
 * True if the driven coordinate is an angle; a length otherwise.
 */
turns: boolean,
/**
 * Driven point in the frame of its body, if a point is driven.
 */
point: BodyPlace | null,
/**
 * Unit vector in the world along which the point is driven, or about which the body is rotated.
 */
along: [number, number, number] | null,
/**
 * Driven coordinate, `n` steps, in the length unit or in radians, relative to the design configuration.
 */
travel: Curve,
/**
 * If several drivers move: rate of each of the first [`Payload::quantities`] by this driver with the others at
 * rest, in its unit per length unit or radian; empty for quantities that do not depend on positions alone.
 */
alone: Array<Curve>, };

/**
 * Point on a body.
 */
export type BodyPlace = {
/**
 * Index into [`Payload::bodies`].
 */
body: number,
/**
 * Location in the body's frame.
 */
at: [number, number, number], };

/**
 * A road wheel.
 */
export type WheelMark = {
/**
 * Name of the wheel.
 */
name: string,
/**
 * Centre, on the carrier body.
 */
centre: BodyPlace,
/**
 * Unit vector along the spin axis, outboard, in the frame of the carrier body.
 */
axis: [number, number, number],
/**
 * Distance from the centre to the ground.
 */
radius: number,
/**
 * Lower and upper point of the steering axis, if there is one.
 */
kingpin: [BodyPlace, BodyPlace] | null, };

/**
 * Shapes of bodies, and their distances over the motion.
 */
export type ClearanceMarks = {
/**
 * All shapes.
 */
shapes: Array<ShapeMark>,
/**
 * Clearances of the model.
 */
clearances: Array<ClearanceMark>,
/**
 * Pairs that are the nearest of their clearance at any shown step.
 */
pairs: Array<PairTrack>, };

/**
 * Shape of a body.
 */
export type ShapeMark = {
/**
 * Name of the shape.
 */
name: string,
/**
 * Kind in the model file: `sphere`, `capsule`, `ring`, `cylinder`, `tyre`, `plane`, `hull` or `mesh`.
 */
kind: string,
/**
 * Body that carries it, an index into [`Payload::bodies`]; of a rod without a body that of its first end.
 */
body: number,
/**
 * Centre, both ends, or corners; none of a mesh.
 */
places: Array<BodyPlace>,
/**
 * Unit vector along the axis or normal in the frame of `body`, of a ring, tyre or plane.
 */
axis: [number, number, number] | null,
/**
 * Radius, to the outside; of a ring that of the circle in the middle of its bar; 0 where there is none.
 */
radius: number,
/**
 * Half of a tyre's width; otherwise 0.
 */
half_width: number,
/**
 * Radius of a ring's bar, or of edges; that of a sphere or capsule is its radius.
 */
round: number,
/**
 * Vertices of a mesh in the frame of `body`, three coordinates each; empty otherwise, and of other designs.
 */
vertices: Curve,
/**
 * Three vertices per triangle of a mesh, or corners of a hull: integers below 2^24; empty otherwise.
 */
triangles: Curve, };

/**
 * Clearance of the model.
 */
export type ClearanceMark = {
/**
 * Name of the clearance.
 */
name: string,
/**
 * Measures of it, indices into [`Payload::quantities`].
 */
quantities: Array<number>,
/**
 * Distance that is required of all its pairs, if it is the same for all.
 */
min: number | null,
/**
 * Distance above which its pairs are not shown.
 */
beyond: number | null, };

/**
 * Distance of two shapes over the motion.
 */
export type PairTrack = {
/**
 * Both shapes, indices into [`ClearanceMarks::shapes`].
 */
shapes: [number, number],
/**
 * Clearances with this pair, indices into [`ClearanceMarks::clearances`].
 */
clearances: Array<number>,
/**
 * Distance, `n` steps; negative where the shapes overlap.
 */
distance: Curve,
/**
 * Nearest points of their surfaces in the world, six numbers per step.
 */
points: Curve,
/**
 * Intervals in which they touch, located exactly; `None` if they were not located.
 */
touching: Array<[number, number]> | null,
/**
 * Times and distances of all local minima, located exactly; empty if they were not located.
 */
minima: Array<[number, number]>, };

/**
 * Shapes and distances of another design.
 */
export type DesignShapes = {
/**
 * Shapes as in [`ClearanceMarks::shapes`], without the vertices of meshes, which no design changes.
 */
shapes: Array<ShapeMark>,
/**
 * Pairs as in [`ClearanceMarks::pairs`].
 */
pairs: Array<PairTrack>, };

/**
 * Measured distance between two points.
 */
export type DistanceMark = {
/**
 * Name of the measure.
 */
name: string,
/**
 * First point.
 */
from: BodyPlace,
/**
 * Second point.
 */
to: BodyPlace,
/**
 * Shape in drawings, if the model defines one; see [`JointMark::draw`].
 */
draw: string | null, };

/**
 * Force on a body: the reaction of a joint on body j, or an applied force of a spring or another element at a point.
 */
export type LoadMark = {
/**
 * Name of the joint or the force element.
 */
name: string,
/**
 * Index into [`Payload::joints`], for the reaction of a joint.
 */
joint: number | null,
/**
 * Point of application.
 */
at: BodyPlace,
/**
 * Three numbers per step: force in the world, N. Components that redundant constraints leave undetermined are
 * omitted; NaN if the force is unknown.
 */
force: Curve,
/**
 * True if undetermined components are omitted at any time.
 */
is_part: boolean, };

/**
 * Unit vectors of the vehicle axes in the world.
 */
export type VehicleAxes = {
/**
 * Direction of travel.
 */
forward: [number, number, number],
/**
 * Upward direction.
 */
up: [number, number, number], };

/**
 * Quantity that can be plotted over time, with its two time derivatives.
 */
export type Quantity = {
/**
 * Name of the quantity, for example `toe`.
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
 * Heading in the list of quantities: `measure`, `point`, `body` or `joint`.
 */
group: string,
/**
 * Type of the measure as model files write it, such as `toe`; `position` for a coordinate of a point or body.
 */
kind: string,
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
 * Plot that the page opens with.
 */
export type Plot = {
/**
 * Quantities of one unit on the ordinate, indices into [`Payload::quantities`].
 */
y: Array<number>,
/**
 * Quantity on the abscissa; time if there is none.
 */
over: number | null, };

/**
 * Named design of the model file.
 */
export type NamedDesign = {
/**
 * Name.
 */
name: string,
/**
 * Changes of variables from the nominal design; all others are nominal.
 */
changes: Array<NamedChange>, };

/**
 * Change of a variable.
 */
export type NamedChange = {
/**
 * Name of the variable.
 */
name: string,
/**
 * Change from the nominal design, in its unit.
 */
by: number, };

/**
 * Single value that characterises the design.
 */
export type Value = {
/**
 * Name of the metric or measure.
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
 * Value, if the motion reaches it.
 */
value: number | null,
/**
 * Time of the value, if it is taken at one time.
 */
time: number | null,
/**
 * Quantity that it is evaluated from, an index into [`Payload::quantities`].
 */
quantity: number | null,
/**
 * Required minimum and maximum, if the model defines them.
 */
target: [number | null, number | null] | null,
/**
 * Part of the target that limits the curve of the quantity.
 */
gate: Gate | null,
/**
 * Derivatives by every design variable, in the order of [`Payload::variables`]; empty if the mechanism cannot
 * follow one.
 */
sensitivities: Array<number | null>, };

/**
 * Limits of a curve that follow from the target of a metric.
 */
export type Gate = {
/**
 * Minimum.
 */
low: number | null,
/**
 * Maximum.
 */
high: number | null,
/**
 * Time of the limits; the whole curve if there is none.
 */
at: number | null, };

/**
 * Another design over the same output times. Unknown curves are empty.
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
 * Change of each variable, in the order of [`Payload::variables`], in their units.
 */
change: Array<number>,
/**
 * Sentence on the admissibility of the change; may be empty.
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
 * Margin to singular positions.
 */
margin: Curve | null,
/**
 * Shapes and their distances, if the design was solved and the model has shapes.
 */
clearance?: DesignShapes, };

/**
 * Source of another design.
 */
export type DesignKind = "exact" | "first_order" | "second_order" | "band" | "rigid";

/**
 * Quantity of another design with its two time derivatives; unknown curves are empty.
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
 * Case that sweeps two drivers over a grid. Tables have a row for each position of the second driver and a column for
 * each position of the first.
 */
export type GridMap = {
/**
 * Name of the case.
 */
name: string,
/**
 * Drivers of the grid.
 */
drivers: [GridDriver, GridDriver],
/**
 * Number of positions reached, and reasons for the unreached ones.
 */
note: string,
/**
 * Measured quantities.
 */
quantities: Array<GridQuantity>, };

/**
 * Driver of a grid.
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
 * Measure over a grid.
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
 * Derivatives by design variables; empty if they would be too many for a page.
 */
sensitivities: Array<GridSensitivity>, };

/**
 * Derivative of a measure by a design variable over a grid.
 */
export type GridSensitivity = {
/**
 * Name of the variable.
 */
variable: string,
/**
 * Unit of the derivative.
 */
unit: string,
/**
 * Derivatives, row by row.
 */
values: Curve, };

/**
 * Designs of a sweep, or a part of them, each as a point over variables and metrics.
 */
export type SweepPlot = {
/**
 * Meaning of a point: `design`, `posture`, or `point` of a front.
 */
what: string,
/**
 * Number of solved designs.
 */
designs: number,
/**
 * Point k is design `k * step`.
 */
step: number,
/**
 * Swept variables, then metrics.
 */
axes: Array<SweepAxis>,
/**
 * Sobol indices, if requested.
 */
indices: Array<SweepIndex>, };

/**
 * Variable or metric of a sweep.
 */
export type SweepAxis = {
/**
 * Name, with the case if there are several.
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
 * Value of a design variable in the nominal design; `null` for all else.
 */
nominal: number | null,
/**
 * Target of a metric; `null` without one.
 */
target: number | null,
/**
 * Value in each point.
 */
values: Curve, };

/**
 * Sobol indices of a metric with respect to a variable, each with its standard error.
 */
export type SweepIndex = {
/**
 * Metric, an index into [`SweepPlot::axes`].
 */
metric: number,
/**
 * Variable, an index into [`SweepPlot::axes`].
 */
variable: number,
/**
 * First-order index and its standard error.
 */
first: [number, number],
/**
 * Total index and its standard error.
 */
total: [number, number], };

/**
 * Margin of the mechanism to singular positions: 1 is best, 0 is a singular position.
 */
export type Margin = {
/**
 * Margin, `n` steps.
 */
value: Curve,
/**
 * Meaning of its minimum.
 */
note: string, };

/**
 * Result of a study.
 */
export type StudyTables = {
/**
 * Title of its tab.
 */
title: string,
/**
 * Lines that answer the question of the study, shown above its tables and its plot.
 */
answer: Array<Fact>,
/**
 * Tables of the result.
 */
tables: Array<Table>, };

/**
 * Design variable: its design velocities, admissibility and sensitivities.
 */
export type Variable = {
/**
 * Name of the variable.
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
 * Admissibility of the change.
 */
admissibility: Admissibility,
/**
 * Sentence with the joints concerned and their defects; empty if every joint stays closed.
 */
note: string,
/**
 * Design velocities of the hardpoints that it moves.
 */
arrows: Array<Arrow>,
/**
 * Typical change, if the model defines one.
 */
typical: number | null,
/**
 * Manufacturing tolerance in either direction, if the model defines one.
 */
tolerance: number | null,
/**
 * Lower and upper bound of the change from the nominal design, if the model defines them.
 */
bounds: [number | null, number | null] | null,
/**
 * First-order motion of each body per unit of the variable: six numbers per step, dx dy dz in the length unit and
 * a rotation vector in rad; empty if it is not shown.
 */
shifts: Array<Curve>,
/**
 * Sensitivities, at most one per quantity; empty if the mechanism cannot follow the variable.
 */
sensitivities: Array<Sensitivity>, };

/**
 * Admissibility of a design variable.
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
 * Total derivative of one quantity and its two time derivatives by one design variable.
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
 * Difference quotients of re-solved designs, if requested.
 */
fd: FiniteDifference | null, };

/**
 * Central differences of re-solved designs, for comparison with a [`Sensitivity`].
 */
export type FiniteDifference = {
/**
 * Stride of the curves among the `n` steps, starting with the first: they are drawn as a few marks.
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
 * Table of facts with formatted cells.
 */
export type Table = {
/**
 * Heading.
 */
title: string,
/**
 * Sentence under the heading; may be empty.
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
