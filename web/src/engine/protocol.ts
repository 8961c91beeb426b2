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
change: Array<Setting>,
/**
 * A design that is solved already: where the changed one cannot be, what is given is as far on the way from this one to it
 * as can be.
 */
from: Array<Setting> | null, } | { "ask": "text",
/**
 * What is changed.
 */
change: Array<Setting>, } | { "ask": "page",
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
 * Searches from so many starts; as many as the model says where there is no number.
 */
starts: number | null,
/**
 * Iterations of each at most; as many as the model says where there is no number.
 */
iterations: number | null, } | { "ask": "tolerance",
/**
 * The model.
 */
model: ModelText,
/**
 * Designs that are drawn; as many as the model says where there is no number.
 */
samples: number | null,
/**
 * The seed of these.
 */
seed: number | null, };

/**
 * A variable and its change.
 */
export type Setting = {
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
export type Message = {
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
export type Checked = {
/**
 * Errors, warnings and notes, in the order of the text.
 */
messages: Array<Message>, };

/**
 * What can be done with a model that was opened.
 */
export type Opened = {
/**
 * The cases of the file, of which one is open.
 */
cases: Array<string>,
/**
 * The hardpoints that can be taken hold of.
 */
grips: Array<Grip>,
/**
 * How the frames of the bodies are turned in the drawing, quaternions w x y z, ground first.
 */
frames: Array<[number, number, number, number]>,
/**
 * Why its motion ends early, where it does.
 */
stop: Message | null, };

/**
 * A hardpoint that can be moved.
 */
export type Grip = {
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
export type Solved = {
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
why: Message | null, };

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
export type Studied = {
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
change: Array<Setting> | null,
/**
 * The model's text with it.
 */
text: string | null, };

/**
 * Why there is no answer.
 */
export type Failed = {
/**
 * Never none.
 */
failed: Array<Message>, };

/**
 * How far a study is.
 */
export type Told = {
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
change: Array<Setting> | null, };
