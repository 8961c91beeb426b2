//! Runs that need not fit into memory: their results come window by window, and some of them are kept.
//!
//! A window is a [`Solution`] of consecutive output times. What goes on from one to the next (turns that are counted by
//! rates, the walk itself) is carried over, so that all numbers are those of a run in one piece.

use std::ops::ControlFlow;

use fearless_simd::{Level, dispatch};

use crate::analysis::{Analysis, Design, Progress, Solution, Solved, Walk};
use crate::measure::{self, Before, Measured, SlopeValues, Slopes};
use crate::model::{BodyId, Model, OutputSource, VariableId};
use crate::motion::margin::Margins;
use crate::motion::{BodyState, Motion};
use crate::sensitivity::{Admissibility, BodySensitivity, Sensitivities};
use crate::sink::Sink;
use crate::space::{LANES, Real, lanes};

/// What the results of one output time take, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Footprint {
    /// States of the bodies.
    pub motion: usize,
    /// Sensitivities of the bodies.
    pub sensitivities: usize,
    /// Measures and points, with their sensitivities.
    pub measured: usize,
}

impl Footprint {
    /// That of a model with so many outputs, with or without sensitivities.
    pub fn of(model: &Model, sensitivities: bool) -> Self {
        let variables = if sensitivities { model.variables.len() } else { 0 };
        let (bodies, outputs) = (model.bodies.len(), measure::outputs(model).len());
        Self {
            motion: bodies * size_of::<BodyState>(),
            sensitivities: bodies * variables * size_of::<BodySensitivity>(),
            measured: outputs * (1 + variables) * size_of::<[f64; 3]>(),
        }
    }

    /// All of it.
    pub fn bytes(self) -> usize {
        self.motion + self.sensitivities + self.measured
    }

    /// What a window of about so many bytes really takes: it holds one round of the lanes at least.
    pub fn of_window(self, bytes: usize) -> usize {
        self.bytes() * self.rows(bytes)
    }

    fn rows(self, bytes: usize) -> usize {
        usize::max(bytes / self.bytes().max(1), LANES)
    }
}

impl Analysis<'_> {
    /// As [`Analysis::run_with`], window by window, each of about so many bytes: `each` sees the window's solution, and the
    /// number of its first output time. What comes back are the facts of the whole run (stop, effort, assembly,
    /// admissibility), with the last window.
    ///
    /// A window knows which variables the mechanism could not follow up to its end. One that resists later has numbers in the
    /// windows before, which mean nothing.
    pub fn run_in_windows(
        &self,
        bytes: usize,
        sensitivities: bool,
        mut progress: impl FnMut(Progress) -> ControlFlow<()>,
        mut each: impl FnMut(usize, &Solution),
    ) -> Solution {
        let design = self.design(&[], sensitivities);
        let rows = Footprint::of(self.model(), sensitivities).rows(bytes);
        let mut solution = Solution::default();
        let first = self.walk(&design, rows, &mut progress, &mut solution, &mut each);
        each(first, &solution);
        solution
    }

    /// Solves all output times, so many at a time; the last ones remain. Gives the number of the first of these.
    pub(crate) fn walk(
        &self,
        design: &Design,
        rows: usize,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
        solution: &mut Solution,
        each: &mut dyn FnMut(usize, &Solution),
    ) -> usize {
        dispatch!(Level::new(), simd => self.walk_in(design, rows, progress, solution, each, lanes(simd)))
    }

    fn walk_in<T: Real>(
        &self,
        design: &Design,
        rows: usize,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
        solution: &mut Solution,
        each: &mut dyn FnMut(usize, &Solution),
        witness: T,
    ) -> usize {
        let (model, topology) = (self.model(), self.topology());
        let mut walk = Walk::new(self, design, vec![true; model.bodies.len()], witness);
        if self.measures {
            walk.one.watched = measure::watched(model, topology);
        }
        let rows = usize::min(rows, model.times.len());
        let sensitivities = std::mem::take(&mut solution.sensitivities);
        let mut window = Window {
            first: 0,
            done: 0,
            motion: std::mem::take(&mut solution.motion),
            sensitivities: match &walk.sensing {
                Some(sensing) => sensing.room(rows, sensitivities),
                None => Sensitivities::default(),
            },
            slopes: SlopeValues::default(),
            before: None,
        };
        self.make_room(&mut window.motion, rows);
        let variables = window.sensitivities.variables;
        let mut margins = (Margins::new(topology, 0.0), Margins::new(topology, witness));
        let sensitive = variables > 0;
        let (measures, effects) = (self.measures, self.effects());
        let mut one_slopes =
            measures.then(|| Slopes::new(effects, topology, &design.values, sensitive, 0.0)).flatten();
        let mut all_slopes =
            measures.then(|| Slopes::new(effects, topology, &design.values, sensitive, witness)).flatten();
        let stop = walk.all(self, &mut window, progress, |window, solved, count, sensing| {
            let times = &model.times[window.done..window.done + count];
            window.done += count;
            match solved {
                Solved::One(one) => {
                    if let Some(found) = &mut one_slopes {
                        found.add(one, times, &mut window.slopes);
                    }
                    window.motion.coordinates.extend(one.coordinates());
                    let k = window.done - window.first - 1;
                    window.motion.passed.extend(one.passed.drain(..).map(|place| (k, place)));
                    if measures {
                        window.motion.margins.push(margins.0.at(&one.topology, &one.state)[0]);
                    }
                }
                Solved::Abreast(all) => {
                    if let Some(found) = &mut all_slopes {
                        found.add(all, times, &mut window.slopes);
                    }
                    for lane in 0..count {
                        window.motion.coordinates.extend(all.state.q.iter().map(|q| q.lane(lane)));
                    }
                    if measures {
                        let margins = margins.1.at(&all.topology, &all.state);
                        window.motion.margins.extend_from_slice(&margins[..count]);
                    }
                }
            }
            // The next round may need a place for every lane.
            let full = window.done - window.first + LANES > rows;
            if full && rows < model.times.len() && window.done < model.times.len() {
                window.sensitivities.admissibility =
                    sensing.map_or_else(Vec::new, |s| s.admissibility(&design.opens, window.done));
                window.close(self, design, solution);
                each(window.first, solution);
                window.open(self, rows, solution);
            }
        });
        window.motion.effort = walk.one.effort;
        window.motion.assembly = walk.one.assembly.take();
        window.motion.beyond =
            if self.measures && stop.is_none() && walk.done > 0 { walk.one.beyond() } else { None };
        window.sensitivities.admissibility =
            walk.sensing.map_or_else(Vec::new, |s| s.admissibility(&design.opens, walk.done));
        window.close(self, design, solution);
        solution.stop = stop;
        window.first
    }
}

/// The results that are under way, of consecutive output times.
struct Window {
    /// The number of the first.
    first: usize,
    /// Output times solved, of all windows.
    done: usize,
    motion: Motion,
    sensitivities: Sensitivities,
    slopes: SlopeValues,
    /// The end of the window before.
    before: Option<Before>,
}

impl Sink for Window {
    #[inline(always)]
    fn state(&mut self, k: usize, body: BodyId, state: &BodyState) {
        self.motion.states[(k - self.first) * self.motion.bodies + body.0] = *state;
    }

    #[inline(always)]
    fn sensitivity(&mut self, k: usize, variable: VariableId, body: BodyId, derivatives: &BodySensitivity) {
        let row = (k - self.first) * self.sensitivities.variables + variable.0;
        self.sensitivities.states[row * self.motion.bodies + body.0] = *derivatives;
    }
}

impl Window {
    /// Hands over what there is, measured.
    fn close(&mut self, analysis: &Analysis<'_>, design: &Design, solution: &mut Solution) {
        let steps = self.done - self.first;
        let motion = &mut self.motion;
        motion.times.extend_from_slice(&analysis.model().times[self.first..self.done]);
        motion.states.truncate(steps * motion.bodies);
        let sensitivities = &mut self.sensitivities;
        sensitivities.states.truncate(steps * sensitivities.variables * motion.bodies);
        solution.motion = std::mem::take(motion);
        solution.sensitivities = std::mem::take(sensitivities);
        analysis.measure(design, &self.slopes, self.before.as_ref(), solution);
    }

    /// Goes on behind a window that was handed over, in its memory.
    fn open(&mut self, analysis: &Analysis<'_>, rows: usize, solution: &mut Solution) {
        let Solution { motion, sensitivities, measured, .. } = solution;
        let last = motion.len() - 1;
        self.before = Some(Before {
            time: motion.times[last],
            values: (0..measured.outputs.len()).map(|m| measured.value(last, m)).collect(),
        });
        (self.motion, self.sensitivities) = (std::mem::take(motion), std::mem::take(sensitivities));
        let room = rows * self.sensitivities.variables * self.motion.bodies;
        self.sensitivities.states.resize(room, BodySensitivity::ZERO);
        analysis.make_room(&mut self.motion, rows);
        self.slopes = SlopeValues::default();
        self.first = self.done;
    }
}

/// What to keep of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Keep {
    /// At most so many output times: of more, every second, then every fourth, and so on.
    pub rows: usize,
    /// Poses and motion of the bodies.
    pub motion: bool,
    /// Sensitivities of the bodies.
    pub sensitivities: bool,
    /// Measures and points, with their sensitivities: these, or all.
    pub outputs: Option<Vec<OutputSource>>,
}

/// Keeps some of the results of a run, at evenly chosen output times.
#[derive(Clone, Debug)]
pub struct Kept {
    keep: Keep,
    stride: usize,
    solution: Solution,
}

impl Kept {
    /// Nothing as yet.
    pub fn new(keep: Keep) -> Self {
        Self { keep, stride: 1, solution: Solution::default() }
    }

    /// Of so many output times, each is kept.
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// Takes what it keeps of a window that begins with output time `first`.
    pub fn add(&mut self, first: usize, window: &Solution) {
        for k in 0..window.motion.len() {
            if (first + k).is_multiple_of(self.stride) {
                if self.solution.motion.len() >= self.keep.rows.max(2) {
                    self.halve();
                    if !(first + k).is_multiple_of(self.stride) {
                        continue;
                    }
                }
                self.push(window, k);
            }
        }
    }

    /// What was kept, with the facts of the whole run.
    pub fn end(mut self, whole: &Solution) -> Solution {
        self.solution.motion.effort = whole.motion.effort;
        self.solution.motion.assembly = whole.motion.assembly.clone();
        self.solution.motion.beyond = whole.motion.beyond.clone();
        self.solution.sensitivities.admissibility = whole.sensitivities.admissibility.clone();
        self.solution.sensitivities.variables = whole.sensitivities.variables;
        self.solution.measured.variables = whole.sensitivities.variables;
        self.solution.stop = whole.stop.clone();
        let cannot =
            |v: &usize| matches!(whole.sensitivities.admissibility[*v], Admissibility::CannotFollow { .. });
        let unknown: Vec<usize> = (0..whole.sensitivities.variables).filter(cannot).collect();
        self.solution.measured.forget(&unknown);
        self.solution
    }

    fn push(&mut self, from: &Solution, k: usize) {
        let Solution { motion, sensitivities, measured, .. } = &mut self.solution;
        motion.times.push(from.motion.times[k]);
        motion.margins.extend(from.motion.margins.get(k));
        if self.keep.motion {
            motion.bodies = from.motion.bodies;
            motion.states.extend_from_slice(from.motion.at(k));
            let n = from.motion.coordinates.len() / from.motion.len();
            motion.coordinates.extend_from_slice(&from.motion.coordinates[k * n..(k + 1) * n]);
        }
        if self.keep.sensitivities {
            sensitivities.bodies = from.sensitivities.bodies;
            let n = from.sensitivities.bodies * from.sensitivities.variables;
            sensitivities.states.extend_from_slice(&from.sensitivities.states[k * n..(k + 1) * n]);
        }
        measured.take_over(&from.measured, k, self.keep.outputs.as_deref());
    }

    /// Drops every second output time.
    fn halve(&mut self) {
        self.stride *= 2;
        let Solution { motion, sensitivities, measured, .. } = &mut self.solution;
        let rows = motion.times.len();
        thin(&mut motion.times, rows);
        thin(&mut motion.margins, rows);
        thin(&mut motion.states, rows);
        thin(&mut motion.coordinates, rows);
        thin(&mut sensitivities.states, rows);
        measured.thin(rows);
    }
}

/// Of rows of equal length, every second is dropped.
pub(crate) fn thin<X: Copy>(list: &mut Vec<X>, rows: usize) {
    let n = list.len() / rows.max(1);
    for row in (0..rows).step_by(2) {
        list.copy_within(row * n..(row + 1) * n, row / 2 * n);
    }
    list.truncate(rows.div_ceil(2) * n);
}

impl Measured {
    /// Appends output time k of another one, all outputs or those named.
    fn take_over(&mut self, from: &Self, k: usize, outputs: Option<&[OutputSource]>) {
        let wanted = |m: &usize| outputs.is_none_or(|list| list.contains(&from.outputs[*m].source));
        let columns: Vec<usize> = (0..from.outputs.len()).filter(wanted).collect();
        if self.outputs.is_empty() {
            self.outputs = columns.iter().map(|m| from.outputs[*m].clone()).collect();
        }
        self.variables = from.variables;
        self.values.extend(columns.iter().map(|m| from.value(k, *m)));
        for b in 0..from.variables {
            self.d.extend(columns.iter().map(|m| from.d(k, VariableId(b), *m)));
        }
    }

    fn thin(&mut self, rows: usize) {
        thin(&mut self.values, rows);
        thin(&mut self.d, rows);
    }

    /// There are no derivatives by these variables.
    fn forget(&mut self, variables: &[usize]) {
        let (outputs, row) = (self.outputs.len(), self.outputs.len() * self.variables);
        if row > 0 {
            for d in self.d.chunks_mut(row) {
                for v in variables {
                    d[v * outputs..(v + 1) * outputs].fill([f64::NAN; 3]);
                }
            }
        }
    }
}
