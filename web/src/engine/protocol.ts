// Written by the tests of `crates/hardpoint-studio/src/protocol.rs`; change the structs there.

import type { Design, ModelText, Table } from '../payload'

/**
 * Request to the engine.
 */
export type Request = { "ask": "check",
/**
 * Model text.
 */
model: ModelText, } | { "ask": "open",
/**
 * Model.
 */
model: ModelText, } | { "ask": "design",
/**
 * Changed variables.
 */
change: Array<VariableSetting>,
/**
 * A solved design. If the changed design cannot be reached, the reply is the last design on the path from this
 * one that can be solved.
 */
from: Array<VariableSetting> | null,
/**
 * True if shapes stop the change: the reply is then the last design on the path at which none of the pairs
 * touch that are apart in the design `from`.
 */
solid: boolean, } | { "ask": "text",
/**
 * Changed variables.
 */
change: Array<VariableSetting>, } | { "ask": "page",
/**
 * Model.
 */
model: ModelText, } | { "ask": "beside",
/**
 * Other model.
 */
model: ModelText, } | { "ask": "optimize",
/**
 * Model.
 */
model: ModelText,
/**
 * Options that replace those of the model text.
 */
asked: OptimizeRequest, } | { "ask": "optimize_offer",
/**
 * Model.
 */
model: ModelText, } | { "ask": "tolerance_offer",
/**
 * Model.
 */
model: ModelText, } | { "ask": "tolerance",
/**
 * Model.
 */
model: ModelText,
/**
 * Options that replace those of the model text.
 */
asked: ToleranceRequest, };

/**
 * Options of an optimisation; all other options are those of the model text.
 */
export type OptimizeRequest = {
/**
 * Variables that may change, with their bounds.
 */
variables: Array<VariableChoice>,
/**
 * Goals to minimise.
 */
goals: Array<GoalChoice>,
/**
 * Number of start designs.
 */
starts: number,
/**
 * Maximum number of iterations per start.
 */
iterations: number, };

/**
 * Variable of an optimisation.
 */
export type VariableChoice = {
/**
 * Name.
 */
name: string,
/**
 * Lower and upper bound of the change, or of the value of a parameter.
 */
bounds: [number, number], };

/**
 * Metric to minimise, or to bring to a target.
 */
export type GoalChoice = {
/**
 * Name.
 */
metric: string,
/**
 * Weight per unit of the metric.
 */
weight: number,
/**
 * Target; `null` to minimise.
 */
target: number | null, };

/**
 * Options of an optimisation, with their values in the table `[optimize]` of the model text.
 */
export type OptimizeOffer = {
/**
 * All design variables.
 */
variables: Array<SearchVariable>,
/**
 * All metrics.
 */
goals: Array<SearchGoal>,
/**
 * Limits, one sentence each.
 */
limits: Array<string>,
/**
 * Number of start designs.
 */
starts: number,
/**
 * Maximum number of iterations per start.
 */
iterations: number, };

/**
 * A design variable that an optimisation may change.
 */
export type SearchVariable = {
/**
 * Name.
 */
name: string,
/**
 * Unit.
 */
unit: string,
/**
 * Lower and upper bound of the change, or of the value of a parameter; `null` without bounds in the model text.
 */
bounds: [number, number] | null,
/**
 * True if it is a variable of `[optimize]`.
 */
chosen: boolean, };

/**
 * Metric that an optimisation may minimise or bring to a target.
 */
export type SearchGoal = {
/**
 * Name.
 */
metric: string,
/**
 * Unit.
 */
unit: string,
/**
 * Value of the nominal design in the first case in which the metric is evaluated, if known.
 */
value: number | null,
/**
 * Weight per unit of the metric.
 */
weight: number,
/**
 * Target; `null` to minimise.
 */
target: number | null,
/**
 * True if the target is a curve in the model text; `target` is `null` then.
 */
curve: boolean,
/**
 * True if it is a goal of `[optimize]`.
 */
chosen: boolean, };

/**
 * Options of a tolerance study, with their values in the table `[tolerance]` of the model text.
 */
export type ToleranceOffer = {
/**
 * Tolerances of the variables.
 */
tolerances: Array<ToleranceChoice>,
/**
 * Names of the metrics.
 */
metrics: Array<string>,
/**
 * Number of sampled designs.
 */
samples: number,
/**
 * Seed of the random numbers.
 */
seed: number, };

/**
 * Variable or group of variables with a tolerance.
 */
export type ToleranceChoice = {
/**
 * Name.
 */
name: string,
/**
 * Half width of the tolerance.
 */
tolerance: number,
/**
 * Unit.
 */
unit: string,
/**
 * Distribution of the deviations.
 */
distribution: string, };

/**
 * Options of a tolerance study; all other options are those of the model text.
 */
export type ToleranceRequest = {
/**
 * Number of designs that are sampled and solved exactly.
 */
samples: number,
/**
 * Seed of the random numbers: the same seed gives the same designs.
 */
seed: number,
/**
 * Name of the rule by which the loosest tolerances are allocated; `null` for that of the model text.
 */
allocate?: string | null, };

/**
 * Change of a variable.
 */
export type VariableSetting = {
/**
 * Design variable, or coordinate of a hardpoint such as `tie_rod_outer.z`.
 */
name: string,
/**
 * Change from the nominal value, in the unit of the model.
 */
by: number, };

/**
 * Diagnostic of the model text, worded as on the command line.
 */
export type DiagnosticMessage = {
/**
 * `error`, `warning` or `note`.
 */
severity: 'error' | 'warning' | 'note',
/**
 * Stable code.
 */
code: string,
/**
 * Headline, complete by itself.
 */
message: string,
/**
 * Name of the file; `null` for the displayed text.
 */
file: string | null,
/**
 * Line of the text, from 1; `null` for the text as a whole.
 */
line: number | null,
/**
 * Column of the line in characters, from 1.
 */
column: number | null,
/**
 * Number of underlined characters.
 */
length: number | null,
/**
 * Name of the entry that is underlined.
 */
element: string | null,
/**
 * Label of the underlined characters.
 */
label: string | null,
/**
 * Facts.
 */
notes: Array<string>,
/**
 * Instruction that corrects the problem.
 */
help: string | null, };

/**
 * Diagnostics of a model text.
 */
export type CheckReply = {
/**
 * Errors, warnings and notes, in the order of the text.
 */
messages: Array<DiagnosticMessage>, };

/**
 * Properties of a model that was opened.
 */
export type OpenReply = {
/**
 * Names of the cases of the file, one of which is open.
 */
cases: Array<string>,
/**
 * Hardpoints that can be moved.
 */
grips: Array<MovableHardpoint>,
/**
 * Orientations of the body frames in the design configuration, quaternions w, x, y, z; ground first.
 */
frames: Array<[number, number, number, number]>,
/**
 * Reason why the motion ends early.
 */
stop: DiagnosticMessage | null, };

/**
 * A hardpoint that can be moved.
 */
export type MovableHardpoint = {
/**
 * Name.
 */
name: string,
/**
 * Position in the design configuration, in the unit of the model, global.
 */
place: [number, number, number],
/**
 * Variables of its coordinates.
 */
coordinates: [Coordinate, Coordinate, Coordinate], };

/**
 * Coordinate of a hardpoint, with its variable.
 */
export type Coordinate = {
/**
 * Name of the variable.
 */
variable: string,
/**
 * Derivative of the coordinate with respect to the variable: 1 or -1.
 */
sign: number,
/**
 * Bounds of the variable, in the unit of the model, if the model defines them.
 */
bounds: [number, number] | null, };

/**
 * Solved design.
 */
export type DesignReply = {
/**
 * Fraction of the path to the requested design that was reached, 0 to 1.
 */
part: number,
/**
 * Design; `null` if its motion is empty.
 */
design: Design | null,
/**
 * Reason why the requested design was not reached, or why its motion ends early.
 */
why: DiagnosticMessage | null, };

/**
 * Model text.
 */
export type Text = {
/**
 * Model text.
 */
text: string, };

/**
 * Result of a study.
 */
export type StudyReply = {
/**
 * Summary in one line.
 */
message: string,
/**
 * Tables of the result.
 */
tables: Array<Table>,
/**
 * Optimised design, after an optimisation.
 */
change: Array<VariableSetting> | null,
/**
 * Model text with the optimised design; none where the text cannot have it, for which `message` has the reason.
 */
text: string | null, };

/**
 * Failed request.
 */
export type ErrorReply = {
/**
 * Diagnostics; never empty.
 */
failed: Array<DiagnosticMessage>, };

/**
 * Progress of a study.
 */
export type ProgressReply = {
/**
 * Number of completed steps.
 */
done: number,
/**
 * Total number of steps, if known.
 */
total: number | null,
/**
 * Description of the last step.
 */
line: string,
/**
 * Current design of the study.
 */
change: Array<VariableSetting> | null, };
