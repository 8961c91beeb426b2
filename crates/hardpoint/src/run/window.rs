//! Runs whose results need not fit into memory: they are processed in windows, and a selection is stored.
//!
//! A window is a [`Solution`] of consecutive output times. The solver and the counted turns continue from one window to
//! the next, so that all numbers are the same as without windows.

use std::ops::{ControlFlow, Range};

use hardpoint_tape::LANES;

use crate::blocks::Blocks;
use crate::equilibrium::{Along, Curvatures};
use crate::load::{Compliances, LoadSolver, load_measures};
use crate::measure::{self, Slopes, StepValues};
use crate::model::{BodyId, DriverId, Model, OutputSource, VariableId};
use crate::motion::margin::Margins;
use crate::motion::tape::Tape;
use crate::motion::turns::TurnCounter;
use crate::motion::{BodyState, Motion};
use crate::sensitivity::{Admissibility, BodySensitivity, Sensitivities, SensitivitySolver};
use crate::topology::CoordinateId;

use super::analysis::Analysis;
use super::request::{Progress, Run};
use super::sink::Sink;
use super::solution::Solution;
use super::walk::{PerPlan, Plan, PreparedDesign, SolvedSteps, Walk};

/// Size of the results of one output time, in bytes.
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
    /// Footprint of a model with this number of outputs, with or without sensitivities.
    pub fn of(model: &Model, sensitivities: bool) -> Self {
        let variables = if sensitivities { model.variables.len() } else { 0 };
        let (bodies, outputs) = (model.bodies.len(), measure::outputs(model).len());
        Self {
            motion: bodies * size_of::<BodyState>(),
            sensitivities: bodies * variables * size_of::<BodySensitivity>(),
            measured: outputs * (1 + variables) * size_of::<[f64; 3]>(),
        }
    }

    /// Total size.
    pub fn bytes(self) -> usize {
        self.motion + self.sensitivities + self.measured
    }

    /// Actual size of a window of about this number of bytes; it has at least one batch.
    pub fn of_window(self, bytes: usize) -> usize {
        self.bytes() * self.rows(bytes)
    }

    pub(super) fn rows(self, bytes: usize) -> usize {
        usize::max(bytes / self.bytes().max(1) / LANES, 1) * LANES
    }
}

impl Analysis<'_> {
    /// Solves like [`Analysis::solve`] in windows of about `bytes` bytes. Calls `each` with the number of a window's
    /// first output time and its solution. Returns the last window with the summary of the whole run (stop, effort,
    /// assembly, admissibility).
    ///
    /// The admissibility of a window covers all output times up to its end. If a variable proves inadmissible later,
    /// its sensitivities in earlier windows are invalid.
    pub fn solve_in_windows(
        &self,
        mut run: Run<'_>,
        bytes: usize,
        mut each: impl FnMut(usize, &Solution),
    ) -> Solution {
        let rows = Footprint::of(self.model(), run.scope.sensitivities).rows(bytes);
        let mut solution = std::mem::take(&mut run.memory);
        let design = self.prepare(run.design, run.scope);
        let first = self.walk(&design, rows, &mut *run.progress, &mut solution, &mut each);
        each(first, &solution);
        self.solve_between(&design, &mut *run.progress, &mut solution);
        solution
    }

    /// Solves all output times, `rows` at a time. The last window remains; returns the number of its first output time.
    pub(super) fn walk(
        &self,
        design: &PreparedDesign,
        rows: usize,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
        solution: &mut Solution,
        each: &mut dyn FnMut(usize, &Solution),
    ) -> usize {
        self.walk_between(None, design, rows, progress, solution, each)
    }

    /// Solves all output times like [`Analysis::walk`]; all but the first one from the positions beside them in a
    /// `known` motion of the design, if there is one.
    pub(super) fn walk_between(
        &self,
        known: Option<&Motion>,
        design: &PreparedDesign,
        rows: usize,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
        solution: &mut Solution,
        each: &mut dyn FnMut(usize, &Solution),
    ) -> usize {
        let (model, topology, measures) = (self.model(), self.topology(), design.scope.measures);
        let sensitive = !design.fields.is_empty();
        solution.between = None;
        let variables = if sensitive { model.variables.len() } else { 0 };
        let of_motion = self.openings().is_none();
        let giving = || Compliances::new(self.design_map(), topology, &design.values, sensitive);
        let mut compliances = (measures && of_motion).then(giving).flatten();
        let loads = measures && (self.asks_for_loads() || compliances.is_some());
        let mut workspaces =
            PerPlan::new(self, design, |plan| Workspaces::of(plan, self, measures, sensitive));
        let mut walk = self.walk_of(known, design, (measures, workspaces.first().slopes.is_some(), loads));
        if loads {
            walk = walk.with_loads(|plan| load_solver(plan, model, sensitive));
        }
        let rows = usize::min(rows, model.times.len());
        let slopes = StepValues::new(model, variables, rows);
        let mut window = Window::begin(self, walk.solver.as_ref(), rows, slopes, solution);
        if rows == model.times.len() && self.records_channels(design) {
            window.motion.channels.insert(Blocks::default()).shape(walk.one.channels().count(), rows);
        }
        let stop = walk.all(&mut window, progress, |window, solved, count, solver| {
            let times = &model.times[window.done..window.done + count];
            let k = window.done - window.first;
            window.done += count;
            match solved {
                SolvedSteps::One(plan, one, loads, mut equilibrium) => {
                    let openings = plan.analysis.openings().map_or(0, |(openings, _)| openings.len());
                    let Workspaces { slopes, curvatures, margins, coordinates } = workspaces.on(plan);
                    if measures && !window.slopes.measures().is_empty() {
                        window.slopes.begin();
                    }
                    if let (Some(found), Some(equilibrium)) = (&mut *slopes, &mut equilibrium) {
                        found.set_openings(openings, &equilibrium.driver_rates(one, times[0]));
                    }
                    let is_curved =
                        design.needs.as_ref().is_none_or(|needs| needs.curved_at(window.done - count));
                    let mut curvatures = curvatures.as_mut().filter(|_| is_curved);
                    let mut along_drivers = Vec::new();
                    if let (Some(solver), true) = (equilibrium, measures) {
                        solver.add_compliances(one, times[0], curvatures.as_deref_mut(), &mut window.slopes);
                        along_drivers = curvatures
                            .map_or(Vec::new(), |curved| solver.poses_along_drivers(one, times[0], curved));
                    }
                    if let Some(found) = slopes {
                        found.add(&mut one.mechanism, times[0], &along_drivers, &mut window.slopes);
                    }
                    if let Some(loads) = loads {
                        loads.enter(&mut window.slopes);
                        if let Some(compliances) = &mut compliances {
                            compliances.add(&mut one.mechanism, times[0], loads.near(), &mut window.slopes);
                        }
                    }
                    window.motion.coordinates.set(k, 0, one.mechanism.coordinates(coordinates));
                    if let Some(channels) = &mut window.motion.channels {
                        channels.set(k, 0, one.channels());
                    }
                    if let Some(turns) = &one.turns {
                        window.motion.counted.extend_from_slice(&turns.values);
                    }
                    if measures {
                        window.motion.margins.push(margins.at(&one.mechanism.topology, &one.mechanism.state));
                    }
                }
                SolvedSteps::Batch(tape, lanes, turns) => {
                    tape.coordinates(topology, window.motion.coordinates.block_mut(k));
                    if let Some(channels) = &mut window.motion.channels {
                        tape.write_channels(channels.block_mut(k));
                    }
                    window.add_batch(tape, lanes, turns, measures);
                }
            }
            if window.done - window.first == rows && window.done < model.times.len() {
                window.sensitivities.admissibility =
                    solver.map_or_else(Vec::new, |s| s.admissibility(&design.opens, window.done));
                window.close(self, design, solution);
                each(window.first, solution);
                window.open(self, rows, solution);
            }
        });
        // Other rows may have been selected on both sides of a position.
        window.motion.channels.take_if(|_| walk.one.mechanism.selections > 0);
        window.motion.effort = walk.one.effort;
        window.motion.solved_by = Some(self.solved_by(measures));
        window.motion.assembly = walk.one.assembly.take();
        window.motion.beyond =
            if measures && of_motion && stop.is_none() && walk.done > 0 { walk.one.beyond() } else { None };
        window.sensitivities.admissibility = walk.admissibility(&design.opens);
        window.close(self, design, solution);
        solution.stop = stop;
        window.first
    }

    /// The walk of a design with all bodies, and with margins, derivatives of measures and loads if requested:
    /// between the times of a known motion, step by step where measures need the kernel, or else by programs.
    fn walk_of<'w>(
        &'w self,
        known: Option<&'w Motion>,
        design: &'w PreparedDesign,
        asked: (bool, bool, bool),
    ) -> Walk<'w> {
        let wanted = vec![true; self.model().bodies.len()];
        match known {
            Some(known) => Walk::new(self, design, wanted).between(known),
            None if asked.0 && self.needs_kernel().is_some() => Walk::new(self, design, wanted),
            None => Walk::by_programs(self, design, wanted, asked),
        }
    }
}

/// Workspaces for the results of an output time, besides the solvers of a walk.
struct Workspaces<'a> {
    slopes: Option<Slopes<'a>>,
    curvatures: Option<Curvatures<'a>>,
    margins: Margins<f64>,
    /// Coordinates in the order of the first plan.
    coordinates: Vec<CoordinateId>,
}

impl<'a> Workspaces<'a> {
    /// Workspaces of a plan in a run of an analysis, whose model is that of the user, and whose plan is the first.
    fn of(
        Plan { analysis, design, .. }: Plan<'a>,
        run: &Analysis<'_>,
        measures: bool,
        sensitive: bool,
    ) -> Self {
        let (model, map, plan) = (run.model(), analysis.design_map(), analysis.topology());
        let slopes = || {
            let asked = (0..model.measures.len()).filter(|m| design.needs_measure(*m));
            let openings = analysis.openings().map_or(&[][..], |(openings, _)| openings);
            Slopes::new(map, plan, (&design.values, asked), sensitive, openings)
        };
        let slopes = measures.then(slopes).flatten();
        let openings = analysis.openings().filter(|_| measures && sensitive);
        let curvatures = openings.and_then(|openings| {
            let directions = derived_along(model, &slopes, design);
            let along = (&design.values[..], &[][..]);
            (!directions.is_empty()).then(|| Curvatures::new(map, plan, along, openings, directions))
        });
        let margins = Margins::new(analysis.solved_model(), plan, &design.geometry);
        Self { slopes, curvatures, margins, coordinates: plan.places(run.topology()).flatten().collect() }
    }
}

/// Solver of the loads of a plan, for the measures of the user's model.
fn load_solver<'a>(
    Plan { analysis, design, .. }: Plan<'a>,
    model: &Model,
    sensitive: bool,
) -> LoadSolver<'a> {
    let measures = load_measures(model);
    let differentiates = sensitive && measures.iter().any(|m| design.needs_measure(*m));
    LoadSolver::new(analysis.design_map(), analysis.topology(), &design.values, measures, differentiates)
}

/// Directions along which compliances and slopes at an equilibrium are derivatives: their derivatives by the variables
/// are curvatures.
fn derived_along(model: &Model, slopes: &Option<Slopes<'_>>, design: &PreparedDesign) -> Vec<Along> {
    let is_needed = |m: usize| design.needs_measure(m);
    let mut directions: Vec<Along> = Vec::new();
    for (_, measure) in model.measures.iter().enumerate().filter(|(m, _)| is_needed(*m)) {
        if let Some((_, force)) = measure.kind.compliance()
            && !directions.contains(&Along::Force(force))
        {
            directions.push(Along::Force(force));
        }
    }
    let drivers = slopes.iter().flat_map(|found| found.drivers());
    let alone = |d: &DriverId| {
        (0..model.measures.len()).any(|m| is_needed(m) && model.drivers_alone(m).any(|of| of == *d))
    };
    directions.extend(drivers.filter(|d| alone(d)).map(|d| Along::Driver(*d)));
    directions
}

/// Window that is being filled with consecutive output times.
struct Window {
    /// Number of its first output time.
    first: usize,
    /// Output times solved, of all windows.
    done: usize,
    motion: Motion,
    sensitivities: Sensitivities,
    slopes: StepValues,
}

impl Sink for Window {
    #[inline(always)]
    fn state(&mut self, k: usize, body: BodyId, state: &BodyState) {
        self.motion.set(k - self.first, body, state);
    }

    #[inline(always)]
    fn sensitivity(&mut self, k: usize, variable: VariableId, body: BodyId, derivatives: &BodySensitivity) {
        self.sensitivities.set(k - self.first, variable, body, derivatives);
    }

    #[inline(always)]
    fn room(&mut self, k: usize) -> Option<[&mut [[f64; 8]]; 2]> {
        let k = k - self.first;
        Some([self.motion.states.block_mut(k), self.sensitivities.derivatives.block_mut(k)])
    }
}

impl Window {
    /// Starts the first window in the memory of a solution.
    fn begin(
        analysis: &Analysis<'_>,
        solver: Option<&SensitivitySolver>,
        rows: usize,
        slopes: StepValues,
        solution: &mut Solution,
    ) -> Self {
        let mut sensitivities = std::mem::take(&mut solution.sensitivities);
        match solver {
            Some(solver) => solver.make_room(&mut sensitivities, rows),
            None => sensitivities = Sensitivities::default(),
        }
        let mut motion = std::mem::take(&mut solution.motion);
        analysis.make_room(&mut motion, rows);
        Self { first: 0, done: 0, motion, sensitivities, slopes }
    }

    /// Completes the window with its measures.
    fn close(&mut self, analysis: &Analysis<'_>, design: &PreparedDesign, solution: &mut Solution) {
        self.motion.times.extend_from_slice(&analysis.model().times[self.first..self.done]);
        solution.motion = std::mem::take(&mut self.motion);
        solution.sensitivities = std::mem::take(&mut self.sensitivities);
        analysis.measure(design, &self.slopes, solution);
    }

    /// Adds the measures, turns and margins of a batch of steps.
    fn add_batch(
        &mut self,
        tape: &Tape,
        lanes: Range<usize>,
        turns: Option<&TurnCounter<'_>>,
        measures: bool,
    ) {
        if !tape.measures().is_empty() {
            self.slopes.take_recorded(tape.measures(), lanes.clone());
        } else if measures && !self.slopes.measures().is_empty() {
            lanes.clone().for_each(|_| self.slopes.begin());
        }
        if let Some(turns) = turns {
            let of_lane = |lane: usize| &turns.lanes[lane * turns.len()..][..turns.len()];
            lanes.clone().for_each(|lane| self.motion.counted.extend_from_slice(of_lane(lane)));
        }
        if measures {
            self.motion.margins.extend(lanes.map(|lane| tape.margin(lane)));
        }
    }

    /// Starts the next window in the memory of the last.
    fn open(&mut self, analysis: &Analysis<'_>, rows: usize, solution: &mut Solution) {
        let Solution { motion, sensitivities, .. } = solution;
        (self.motion, self.sensitivities) = (std::mem::take(motion), std::mem::take(sensitivities));
        analysis.make_room(&mut self.motion, rows);
        self.slopes.restart();
        self.first = self.done;
    }
}

/// Selection of the results of a run that are stored.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sampling {
    /// Maximum number of output times; beyond it every second one is stored, then every fourth, and so on.
    pub rows: usize,
    /// Poses and motion of the bodies.
    pub motion: bool,
    /// Sensitivities of the bodies.
    pub sensitivities: bool,
    /// Measures and points to store, with their sensitivities; all if `None`.
    pub outputs: Option<Vec<OutputSource>>,
}

/// Stores a selection of the results of a run, at uniformly spaced output times.
#[derive(Clone, Debug)]
pub struct SampledResults {
    keep: Sampling,
    stride: usize,
    solution: Solution,
}

impl SampledResults {
    /// An empty selection.
    pub fn new(keep: Sampling) -> Self {
        Self { keep, stride: 1, solution: Solution::default() }
    }

    /// Interval of stored output times: every `stride`-th one.
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// Stores the selected results of a window that begins with output time `first`.
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

    /// Returns the stored results, with the summary of the whole run.
    pub fn end(mut self, whole: &Solution) -> Solution {
        self.solution.motion.effort = whole.motion.effort;
        self.solution.motion.solved_by = whole.motion.solved_by.clone();
        self.solution.motion.assembly = whole.motion.assembly.clone();
        self.solution.motion.beyond = whole.motion.beyond.clone();
        self.solution.sensitivities.admissibility = whole.sensitivities.admissibility.clone();
        self.solution.sensitivities.variables = whole.sensitivities.variables;
        self.solution.measured.variables = whole.sensitivities.variables;
        self.solution.stop = whole.stop.clone();
        self.solution.between = whole.between.clone();
        self.solution.located.clone_from(&whole.located);
        let cannot =
            |v: &usize| matches!(whole.sensitivities.admissibility[*v], Admissibility::CannotFollow { .. });
        self.solution.measured.forget((0..whole.sensitivities.variables).filter(cannot));
        self.solution
    }

    fn push(&mut self, from: &Solution, k: usize) {
        let Solution { motion, sensitivities, measured, .. } = &mut self.solution;
        let row = motion.times.len();
        motion.times.push(from.motion.times[k]);
        motion.margins.extend(from.motion.margins.get(k));
        if self.keep.motion {
            motion.bodies = from.motion.bodies;
            motion.states.copy(row, &from.motion.states, k);
            motion.coordinates.copy(row, &from.motion.coordinates, k);
        }
        if self.keep.sensitivities {
            sensitivities.copy(row, &from.sensitivities, k);
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
        motion.states.thin(rows);
        motion.coordinates.thin(rows);
        sensitivities.derivatives.thin(rows);
        measured.thin();
    }
}

/// Drops every second row; all rows have the same length.
pub(crate) fn thin<X: Copy>(list: &mut Vec<X>, rows: usize) {
    let n = list.len() / rows.max(1);
    for row in (0..rows).step_by(2) {
        list.copy_within(row * n..(row + 1) * n, row / 2 * n);
    }
    list.truncate(rows.div_ceil(2) * n);
}
