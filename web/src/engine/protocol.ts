// Written by the tests of `crates/hardpoint-studio/src/protocol.rs`; change the structs there.

import type { Design, ModelText, Table } from '../payload'

/**
 * What is asked of the engine.
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
 * What is changed.
 */
change: Array<VariableSetting>,
/**
 * A design that is solved already: where the changed one cannot be, what is given is as far on the way from this one to it
 * as can be.
 */
from: Array<VariableSetting> | null, } | { "ask": "text",
/**
 * What is changed.
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
 * What is asked besides what the text says.
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
 * What is asked besides what the text says.
 */
asked: ToleranceRequest, };

/**
 * What is asked of an optimisation; all else is as the text has it.
 */
export type OptimizeRequest = {
/**
 * What may change, and within what.
 */
variables: Array<VariableChoice>,
/**
 * What is to be small.
 */
goals: Array<GoalChoice>,
/**
 * From how many designs it starts.
 */
starts: number,
/**
 * After so many iterations a search ends.
 */
iterations: number, };

/**
 * A variable that is searched over.
 */
export type VariableChoice = {
/**
 * Its name.
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
 * Its name.
 */
metric: string,
/**
 * How much its unit counts.
 */
weight: number,
/**
 * Where it is to be; as small as possible where there is none.
 */
target: number | null, };

/**
 * What an optimisation of a text may choose, and what the text chooses: `[optimize]`, and what could stand there.
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
 * What must hold, a sentence each.
 */
limits: Array<string>,
/**
 * From how many designs it starts.
 */
starts: number,
/**
 * After so many iterations a search ends.
 */
iterations: number, };

/**
 * A design variable that an optimisation may change.
 */
export type SearchVariable = {
/**
 * Its name.
 */
name: string,
/**
 * Its unit.
 */
unit: string,
/**
 * Lowest and highest change, or value of a parameter; none where the text has no bounds.
 */
bounds: [number, number] | null,
/**
 * Whether the search of the text changes it.
 */
chosen: boolean, };

/**
 * A metric that an optimisation may make small, or bring to a target.
 */
export type SearchGoal = {
/**
 * Its name.
 */
metric: string,
/**
 * Its unit.
 */
unit: string,
/**
 * The value of the design of the text, in the first case that it is taken in, where it is known.
 */
value: number | null,
/**
 * How much its unit counts.
 */
weight: number,
/**
 * Where it is to be; as small as possible where there is none.
 */
target: number | null,
/**
 * Whether its target is a curve, which the text has: then it has none of its own.
 */
curve: boolean,
/**
 * Whether it is a goal of the text.
 */
chosen: boolean, };

/**
 * What a tolerance study of a text may choose, and what the text chooses: `[tolerance]`.
 */
export type ToleranceOffer = {
/**
 * What may be off, by how much.
 */
tolerances: Array<ToleranceChoice>,
/**
 * What is looked at.
 */
metrics: Array<string>,
/**
 * So many designs are drawn.
 */
samples: number,
/**
 * What they are drawn from.
 */
seed: number, };

/**
 * Something that may be off.
 */
export type ToleranceChoice = {
/**
 * Its name.
 */
name: string,
/**
 * By so much either way.
 */
tolerance: number,
/**
 * Its unit.
 */
unit: string,
/**
 * How it scatters.
 */
distribution: string, };

/**
 * What is asked of a tolerance study; all else is as the text has it.
 */
export type ToleranceRequest = {
/**
 * So many designs are drawn and solved exactly.
 */
samples: number,
/**
 * What they are drawn from: the same number gives the same designs.
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
 * Its stable code.
 */
code: string,
/**
 * The headline, enough alone.
 */
message: string,
/**
 * Line of the text, from 1; none where the text as a whole is meant.
 */
line: number | null,
/**
 * Column of the line in characters, from 1.
 */
column: number | null,
/**
 * How many characters are meant.
 */
length: number | null,
/**
 * What to write at that place.
 */
label: string | null,
/**
 * Facts.
 */
notes: Array<string>,
/**
 * What to do.
 */
help: string | null, };

/**
 * What is wrong or worth knowing about a text.
 */
export type CheckReply = {
/**
 * Errors, warnings and notes, in the order of the text.
 */
messages: Array<DiagnosticMessage>, };

/**
 * What can be done with a model that was opened.
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
 * How the frames of the bodies are turned in the drawing, quaternions w x y z, ground first.
 */
frames: Array<[number, number, number, number]>,
/**
 * Why its motion ends early, where it does.
 */
stop: DiagnosticMessage | null, };

/**
 * A hardpoint that can be moved.
 */
export type MovableHardpoint = {
/**
 * Its name.
 */
name: string,
/**
 * Where it is in the drawing, in the model's unit.
 */
place: [number, number, number],
/**
 * What its coordinates are varied by.
 */
coordinates: [Coordinate, Coordinate, Coordinate], };

/**
 * What a coordinate of a hardpoint is varied by.
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
 * The part of the way to the design that was asked for, 0 to 1: 1 where it is that one.
 */
part: number,
/**
 * The design; `None` where nothing of its motion could be solved.
 */
design: Design | null,
/**
 * Why it is not the one asked for, or why its motion ends early.
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
 * What a study came to.
 */
export type StudyReply = {
/**
 * How it ended, in a sentence.
 */
message: string,
/**
 * What was found.
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
 * Why there is no answer.
 */
export type ErrorReply = {
/**
 * Never none.
 */
failed: Array<DiagnosticMessage>, };

/**
 * How far a study is.
 */
export type ProgressReply = {
/**
 * So much is done ...
 */
done: number,
/**
 * ... of so much, where that is known.
 */
total: number | null,
/**
 * What has happened, in a line.
 */
line: string,
/**
 * The design that the study stands at.
 */
change: Array<VariableSetting> | null, };
