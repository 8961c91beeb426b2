// Written by the tests of `crates/hardpoint-report/src/page.rs`; change the structs there.

/**
 * One number per output step, stored as `f32`; NaN means "no value at this step" and is drawn as a gap.
 *
 * Serialised as base64 of little-endian `f32`: a third of the size of decimal text, and the page
 * shows no more digits than that.
 *
 * ```
 * use hardpoint_report::page::Curve;
 * let curve = Curve::from(&[1.0, -2.0][..]);
 * assert_eq!(serde_json::to_string(&curve).unwrap(), r#""AACAPwAAAMA=""#);
 * ```
 */
export type Curve = string;

/**
 * Everything one report shows. Lengths, angles and times are in [`Payload::units`].
 */
export type Payload = {
/**
 * Headline, usually the model's title.
 */
title: string,
/**
 * What the model file says about itself; may be empty.
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
 * Whether the whole motion was solved.
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
 * What can be plotted over time.
 */
quantities: Array<Quantity>,
/**
 * How far from singular the mechanism is over time, if anything is solved for.
 */
margin: Margin | null,
/**
 * Design variables with their sensitivities.
 */
variables: Array<Variable>,
/**
 * Facts about the model: bodies, joints, constraints, redundancy, admissibility.
 */
checks: Array<Table>, };

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
 * How the run ended.
 */
export type Status = {
/**
 * False when the motion stops before its last step; the page then says so in a banner.
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
 * What it is.
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
labels: Array<string>, };

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
 * Whether the joint closes a loop instead of carrying body j.
 */
cut: boolean, };

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
 * Its first time derivative.
 */
rate: Curve,
/**
 * Its second time derivative.
 */
accel: Curve, };

/**
 * How far the mechanism is from singular: 1 is best, 0 is a singular position.
 */
export type Margin = {
/**
 * The margin, `n` steps.
 */
value: Curve,
/**
 * What its least value means.
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
 * What it means, in a few words; may be empty.
 */
description: string,
/**
 * Unit of the variable, `1` for a pure number.
 */
unit: string,
/**
 * Whether every joint stays intact under this design change.
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
 * Per body, how it moves with the variable: six numbers per step, dx dy dz in the length unit and a rotation vector in rad,
 * per unit of the variable; empty where that is not shown.
 */
shifts: Array<Curve>,
/**
 * Sensitivities, at most one per quantity; empty when the mechanism cannot follow.
 */
sensitivities: Array<Sensitivity>, };

/**
 * Whether a mechanism can follow a design variable.
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
 * Where the hardpoint is.
 */
at: [number, number, number],
/**
 * How its location changes.
 */
v: [number, number, number],
/**
 * How its orientation turns.
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
 * The same by re-solving a changed design, when that was asked for.
 */
fd: FiniteDifference | null, };

/**
 * Central differences of re-solved designs, to be compared with a [`Sensitivity`].
 */
export type FiniteDifference = {
/**
 * Difference quotient of the quantity, `n` steps.
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
