// Written by the tests of `crates/hardpoint-studio/src/protocol.rs`; change the structs there.

import type { Design, ModelText, Table } from '../payload'

/**
 * Request to the engine.
 */
export type Request = { "ask": "check",
/**
 * The text.
 */
model: ModelText, } | { "ask": "open",
/**
 * The model.
 */
model: ModelText, } | { "ask": "design",
/**
 * Changed variables.
 */
change: Array<VariableSetting>,
/**
 * A design that is solved already: where the changed one cannot be, what is given is as far on the way from
 * this one to it as can be.
 */
from: Array<VariableSetting> | null, } | { "ask": "text",
/**
 * Changed variables.
 */
change: Array<VariableSetting>, } | { "ask": "page",
/**
 * The model.
 */
model: ModelText, } | { "ask": "beside",
/**
 * The other model.
 */
model: ModelText, } | { "ask": "optimize",
/**
 * The model.
 */
model: ModelText,
/**
 * Options besides those of the text.
 */
asked: OptimizeRequest, } | { "ask": "optimize_offer",
/**
 * The model.
 */
model: ModelText, } | { "ask": "tolerance_offer",
/**
 * The model.
 */
model: ModelText, } | { "ask": "tolerance",
/**
 * The model.
 */
model: ModelText,
/**
 * Options besides those of the text.
 */
asked: ToleranceRequest, };

/**
 * Options of an optimisation; all others are those of the text.
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
 * From how many designs it starts.
 */
starts: number,
/**
 * After that many iterations a search ends.
 */
iterations: number, };

/**
 * A variable that is searched over.
 */
export type VariableChoice = {
/**
 * Name.
 */
name: string,
/**
 * Lowest and highest change, or value of a parameter.
 */
bounds: [number, number], };

/**
 * A metric that is made small.
 */
export type GoalChoice = {
/**
 * Name.
 */
metric: string,
/**
 * Weight of one unit.
 */
weight: number,
/**
 * Target; `null` to minimise.
 */
target: number | null, };

/**
 * Options of an optimisation, with their values in the text: `[optimize]` and its possible entries.
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
 * Limits, a sentence each.
 */
limits: Array<string>,
/**
 * From how many designs it starts.
 */
starts: number,
/**
 * After that many iterations a search ends.
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
 * Lowest and highest change, or value of a parameter; none where the text has no bounds.
 */
bounds: [number, number] | null,
/**
 * True if the search of the text changes it.
 */
chosen: boolean, };

/**
 * A metric that an optimisation may make small, or bring to a target.
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
 * The value of the design of the text, in the first case that it is taken in, where it is known.
 */
value: number | null,
/**
 * Weight of one unit.
 */
weight: number,
/**
 * Target; `null` to minimise.
 */
target: number | null,
/**
 * True if its target is a curve, which the text has: then it has none of its own.
 */
curve: boolean,
/**
 * True if it is a goal of the text.
 */
chosen: boolean, };

/**
 * Options of a tolerance study, with their values in the text: `[tolerance]`.
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
 * Number of designs that are drawn.
 */
samples: number,
/**
 * Seed of the random numbers.
 */
seed: number, };

/**
 * Something that may be off.
 */
export type ToleranceChoice = {
/**
 * Name.
 */
name: string,
/**
 * By so much either way.
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
 * Options of a tolerance study; all others are those of the text.
 */
export type ToleranceRequest = {
/**
 * Number of designs that are drawn and solved exactly.
 */
samples: number,
/**
 * Seed of the random numbers: the same seed gives the same designs.
 */
seed: number, };

/**
 * A variable and its change.
 */
export type VariableSetting = {
/**
 * A design variable of the model, or a coordinate of a hardpoint like `tie_rod_outer.z`.
 */
name: string,
/**
 * By how much it is changed, in the model's unit.
 */
by: number, };

/**
 * A diagnostic of the text, in the words of the command line.
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
 * The headline, enough alone.
 */
message: string,
/**
 * Name of the file; none for the text that the page shows.
 */
file: string | null,
/**
 * Line of the text, from 1; none where the text as a whole is meant.
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
 * Text at that place.
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
 * Diagnostics of a text.
 */
export type CheckReply = {
/**
 * Errors, warnings and notes, in the order of the text.
 */
messages: Array<DiagnosticMessage>, };

/**
 * Abilities of a model that was opened.
 */
export type OpenReply = {
/**
 * The cases of the file, of which one is open.
 */
cases: Array<string>,
/**
 * The hardpoints that can be taken hold of.
 */
grips: Array<MovableHardpoint>,
/**
 * Orientations of the bodies' frames in the design configuration, quaternions w x y z, ground first.
 */
frames: Array<[number, number, number, number]>,
/**
 * Reason of an early end of its motion.
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
 * Position in the design configuration, in the model's unit.
 */
place: [number, number, number],
/**
 * Variables of its coordinates.
 */
coordinates: [Coordinate, Coordinate, Coordinate], };

/**
 * Variable of a coordinate of a hardpoint.
 */
export type Coordinate = {
/**
 * The variable.
 */
variable: string,
/**
 * By how much the coordinate goes with one unit of it: 1 or -1.
 */
sign: number,
/**
 * The bounds of the variable, where the model has it and gives them.
 */
bounds: [number, number] | null, };

/**
 * A design that was solved.
 */
export type DesignReply = {
/**
 * The part of the way to the design that was requested, 0 to 1: 1 where it is that one.
 */
part: number,
/**
 * The design; `None` where nothing of its motion could be solved.
 */
design: Design | null,
/**
 * Reason why it is not the requested design, or of an early end of its motion.
 */
why: DiagnosticMessage | null, };

/**
 * A text.
 */
export type Text = {
/**
 * The text.
 */
text: string, };

/**
 * Result of a study.
 */
export type StudyReply = {
/**
 * Sentence about its end.
 */
message: string,
/**
 * Tables of the result.
 */
tables: Array<Table>,
/**
 * The design found, where one was searched for.
 */
change: Array<VariableSetting> | null,
/**
 * The model's text with it.
 */
text: string | null, };

/**
 * Reason why there is no answer.
 */
export type ErrorReply = {
/**
 * Never none.
 */
failed: Array<DiagnosticMessage>, };

/**
 * Progress of a study.
 */
export type ProgressReply = {
/**
 * Amount that is done ...
 */
done: number,
/**
 * ... of so much, where that is known.
 */
total: number | null,
/**
 * Line about the last event.
 */
line: string,
/**
 * The design that the study is at.
 */
change: Array<VariableSetting> | null, };
