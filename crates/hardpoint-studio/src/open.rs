//! OpenModel model, with its designs solved as the reader changes them.

use std::sync::Arc;

use hardpoint::model::{HardpointId, Model, ShapeId};
use hardpoint::space::Quat;
use hardpoint::topology::TopologyError;
use hardpoint::{Analysis, Run, Solution};
use hardpoint_file::ModelFile;
use hardpoint_report::course::Course;
use hardpoint_report::diagnose;
use hardpoint_report::figures::rounded;
use hardpoint_report::page::{Design, Detail, ModelText};
use hardpoint_report::payload::{self, ChangedDesign, Request};
use hardpoint_report::summary::Summary;
use hardpoint_study::whatif::{add_coordinates, coordinate, variable_named};

use crate::protocol::{
    Coordinate, DesignReply, DiagnosticMessage, MovableHardpoint, OpenReply, VariableSetting,
};
use crate::shapes::ShapesOfDesign;
use crate::{EngineError, first_case, parse_in_case, parse_model};

/// Part of the path to which the last design before one that cannot be reached is found.
const NEAREST: f64 = 1.0 / 1024.0;
/// Part of the path below which designs are no longer solved in search of shapes that pass through each other: a slow
/// drag has far shorter paths than a mouse that jumps.
const SHORTEST: f64 = 1.0 / 32.0;

/// OpenModel model.
#[derive(Debug)]
pub(crate) struct OpenModel {
    /// The file with all its cases, and a variable for every hardpoint coordinate.
    all_cases: ModelFile,
    /// The file in the displayed case, with the same variables.
    file: ModelFile,
    analysis: Analysis<'static>,
    /// Motion of the nominal design, as in the text.
    nominal: Course,
    /// The file as displayed, without variables.
    bare: ModelFile,
    summary: Summary,
    shown: Detail,
    /// Solution of the last design, whose memory is reused.
    memory: Solution,
    /// Pairs of shapes of all clearances.
    pairs: Vec<[ShapeId; 2]>,
    /// Shapes of the last design that they could stop.
    shapes: Option<ShapesOfDesign>,
}

/// Solved design on the path to another one.
struct Step {
    /// Part of the path.
    part: f64,
    /// Values of the variables, SI.
    design: Vec<f64>,
    solution: Solution,
    /// Shapes, if they are solid.
    shapes: Option<ShapesOfDesign>,
    /// Reason why it cannot be reached.
    why: Option<DiagnosticMessage>,
}

impl OpenModel {
    /// Opens a model, and returns its cases, hardpoints and frames.
    pub fn new(model: &ModelText) -> Result<(Self, OpenReply), EngineError> {
        let mut all_cases = parse_model(model)?;
        add_coordinates(&mut all_cases.model);
        let file = match all_cases.model.cases.iter().position(|c| Some(&c.name) == model.case.as_ref()) {
            Some(case) => all_cases.in_case(hardpoint::model::CaseId(case)),
            None => first_case(all_cases.clone()),
        };
        let analysis = owned_analysis(&file, model)?;
        let solution = analysis.solve(Run::new().without_sensitivities());
        let mut bare = file.clone();
        bare.model.variables.clear();
        let stop = solution.stop.as_ref();
        let stop = stop.map(|stop| diagnose::stop(&bare, stop, solution.motion.len(), None));
        let stop = stop.map(|d| DiagnosticMessage::of(&model.text, &d));
        if let Some(stop) = stop.as_ref().filter(|_| solution.motion.is_empty()) {
            return Err(vec![stop.clone()]);
        }
        let nominal = Course::of(&bare.model, &solution);
        let summary = Summary::new(&bare, &analysis, &nominal);
        let shown = model.shown.unwrap_or_else(|| {
            let request = Request::of(&bare, &analysis, &nominal, &summary);
            payload::payload(&request).model.and_then(|m| m.shown).unwrap_or(Detail {
                stride: 1,
                origins: true,
                bodies: true,
                body_rates: true,
                body_differences: true,
            })
        });
        let opened = OpenReply {
            cases: all_cases.model.cases.iter().map(|case| case.name.clone()).collect(),
            grips: movable_hardpoints(&file),
            frames: file
                .model
                .bodies
                .iter()
                .map(|body| Quat::from_rotation(body.frame.rot).to_array())
                .collect(),
            stop,
        };
        let pairs = file.model.shape_pairs();
        let (memory, shapes) = (Solution::default(), None);
        Ok((Self { all_cases, file, analysis, nominal, bare, summary, shown, memory, pairs, shapes }, opened))
    }

    /// Solves the design with some changes. If it cannot be reached from the solved design `from`, returns the last
    /// design on the path between both that can be solved; if shapes are solid, the last one before a pair touches that
    /// is apart in `from`.
    pub fn design(
        &mut self,
        change: &[VariableSetting],
        from: Option<&[VariableSetting]>,
        solid: bool,
    ) -> Result<DesignReply, EngineError> {
        let target = self.values(change)?;
        let start = from.map(|from| self.values(from)).transpose()?;
        let solid = solid && !self.pairs.is_empty();
        let Some(start) = start else {
            let mut end = self.step(1.0, target, solid, &[]);
            let why = end.why.take();
            return Ok(self.reply(end, why));
        };
        let first = solid.then(|| self.shapes_of(&start));
        let apart = first.as_ref().map_or_else(Vec::new, ShapesOfDesign::pairs_apart);
        let may_pass = |from: Option<&ShapesOfDesign>, to: Option<&ShapesOfDesign>| {
            from.zip(to).is_some_and(|(from, to)| apart.iter().any(|pair| from.may_pass(to, *pair)))
        };
        let on_path =
            |part: f64| -> Vec<f64> { start.iter().zip(&target).map(|(a, b)| a + part * (b - a)).collect() };
        // Designs ahead, the next one last: one that cannot be reached, or may only be reached through a shape, is
        // approached by halves.
        let mut ahead = vec![self.step(1.0, target.clone(), solid, &apart)];
        let mut reached: Option<Step> = None;
        let mut why = None;
        while let Some(mut next) = ahead.pop() {
            let at = reached.as_ref().map_or(0.0, |reached| reached.part);
            let from = reached.as_ref().map_or(first.as_ref(), |reached| reached.shapes.as_ref());
            let way = next.part - at;
            if next.why.is_none() && (way <= SHORTEST || !may_pass(from, next.shapes.as_ref())) {
                if let Some(former) = reached.replace(next) {
                    self.memory = former.solution;
                }
                continue;
            }
            if next.why.is_some() {
                self.memory = std::mem::take(&mut next.solution);
                if way <= NEAREST {
                    why = next.why;
                    break;
                }
            }
            let middle = at + 0.5 * way;
            let between = self.step(middle, on_path(middle), solid, &apart);
            ahead.extend([next, between]);
        }
        let end = match reached {
            Some(reached) => reached,
            None => self.step(0.0, start, solid, &[]),
        };
        Ok(self.reply(end, why))
    }

    /// Reply with a step; its shapes and memory are kept for the next one.
    fn reply(&mut self, end: Step, why: Option<DiagnosticMessage>) -> DesignReply {
        let design = self.shown(&end.solution, &end.design);
        self.memory = end.solution;
        self.shapes = end.shapes;
        DesignReply { part: end.part, design, why }
    }

    /// Solves a design on the path; `apart` are the pairs that must not touch, by number.
    fn step(&mut self, part: f64, design: Vec<f64>, solid: bool, apart: &[usize]) -> Step {
        let (solution, stop) = self.solve(&design);
        let shapes = solid.then(|| self.shapes_with(&design, &solution));
        let touch = || {
            let shapes = shapes.as_ref()?;
            let all = apart.iter().filter_map(|pair| Some((*pair, shapes.first_contact(*pair)?)));
            let (pair, time) = all.min_by(|a, b| a.1.total_cmp(&b.1))?;
            let [a, b] = self.pairs[pair].map(|shape| &self.file.model.shapes[shape.0].name);
            let message = format!("`{a}` touches `{b}` at t = {} s beyond this design", rounded(time, 4));
            Some(DiagnosticMessage::plain("HP0705", message, "hide the shapes to move on"))
        };
        let why = stop.or_else(touch);
        Step { part, design, solution, shapes, why }
    }

    /// Shapes of a design, which is solved unless they are known.
    fn shapes_of(&mut self, design: &[f64]) -> ShapesOfDesign {
        let known = self.shapes.take().filter(|shapes| shapes.design == design);
        known.unwrap_or_else(|| {
            let (solution, _) = self.solve(design);
            let shapes = self.shapes_with(design, &solution);
            self.memory = solution;
            shapes
        })
    }

    fn shapes_with(&self, design: &[f64], solution: &Solution) -> ShapesOfDesign {
        ShapesOfDesign::new(&self.analysis, &self.pairs, design, &solution.motion)
    }

    /// Solves another model for comparison. Both models must have the same bodies, measures, metrics and output times.
    pub fn compare(&mut self, model: &ModelText) -> Result<DesignReply, EngineError> {
        let other = parse_in_case(model)?;
        let same = |a: &Model, b: &Model| {
            let bodies = |m: &Model| m.bodies.iter().map(|b| b.name.clone()).collect::<Vec<_>>();
            let outputs = |m: &Model| {
                let outputs = hardpoint::measure::outputs(m);
                outputs.into_iter().map(|o| (o.name, o.dimension)).collect::<Vec<_>>()
            };
            bodies(a) == bodies(b)
                && outputs(a) == outputs(b)
                && a.times == b.times
                && a.metrics.len() == b.metrics.len()
        };
        if !same(&other.model, &self.file.model) {
            let help = "compare designs of the same mechanism over the same output times";
            let message = "the two models have different bodies, measures, metrics or output times".into();
            return Err(vec![DiagnosticMessage::plain("HP0703", message, help)]);
        }
        let analysis = owned_analysis(&other, model)?;
        let solution = analysis.solve(Run::new().without_sensitivities());
        let stop = solution.stop.as_ref();
        let why = stop.map(|stop| diagnose::stop(&other, stop, solution.motion.len(), None));
        let why = why.map(|d| DiagnosticMessage::of(&model.text, &d));
        Ok(DesignReply { part: 1.0, design: self.shown(&solution, &[]), why })
    }

    /// Returns the model text with some changes.
    pub fn text(&self, change: &[VariableSetting]) -> Result<String, EngineError> {
        let values = self.values(change)?;
        self.all_cases.edit(&values).map_err(|all| {
            all.list().iter().map(|d| DiagnosticMessage::of(self.all_cases.text(), d)).collect()
        })
    }

    /// Returns the values of all variables, SI.
    fn values(&self, change: &[VariableSetting]) -> Result<Vec<f64>, EngineError> {
        let model = &self.file.model;
        let mut values = vec![0.0; model.variables.len()];
        for VariableSetting { name, by } in change {
            let Some(v) = model.variable(name).or_else(|| variable_named(&mut model.clone(), name)) else {
                let message =
                    format!("`{name}` is not a design variable or hardpoint coordinate of the model");
                return Err(vec![DiagnosticMessage::plain("HP0704", message, "open the model again")]);
            };
            let Some(value) = values.get_mut(v.0) else {
                let message = format!("`{name}` is the tilt of a joint, which the page does not vary");
                return Err(vec![DiagnosticMessage::plain(
                    "HP0704",
                    message,
                    "add it to `[design]` in the model's text",
                )]);
            };
            *value += self.file.units.to_si(model.variables[v.0].quantity, *by);
        }
        Ok(values)
    }

    /// Solves a design. The diagnostic reports why its motion ends earlier than that of the nominal design.
    fn solve(&mut self, values: &[f64]) -> (Solution, Option<DiagnosticMessage>) {
        let memory = std::mem::take(&mut self.memory);
        let run = Run::new().at(values).without_sensitivities().reusing(memory);
        let solution = self.analysis.solve(run);
        let stop = solution.stop.as_ref().filter(|_| solution.motion.len() < self.nominal.steps);
        let stop = stop.map(|stop| diagnose::stop_of_changed(&self.bare, stop, solution.motion.len()));
        let stop = stop.map(|d| DiagnosticMessage::of(self.all_cases.text(), &d));
        (solution, stop)
    }

    /// Returns a design for the page; `None` if its motion is empty.
    fn shown(&self, exact: &Solution, values: &[f64]) -> Option<Design> {
        if exact.motion.is_empty() {
            return None;
        }
        let request = Request::of(&self.bare, &self.analysis, &self.nominal, &self.summary);
        let changed = ChangedDesign {
            name: "changed".into(),
            note: String::new(),
            change: values,
            today: &self.nominal.kept,
            exact,
            prediction: None,
        };
        Some(payload::design(&request, &changed, self.shown))
    }
}

/// Creates an analysis that owns its model.
fn owned_analysis(file: &ModelFile, model: &ModelText) -> Result<Analysis<'static>, EngineError> {
    Analysis::new(Arc::new(file.model.clone())).map_err(|fault: TopologyError| {
        vec![DiagnosticMessage::of(&model.text, &diagnose::topology_fault(file, &fault))]
    })
}

/// Returns the named hardpoints, with the variables of their coordinates.
fn movable_hardpoints(file: &ModelFile) -> Vec<MovableHardpoint> {
    let (model, units) = (&file.model, file.units);
    let grip = |(h, hardpoint): (usize, &hardpoint::model::Hardpoint)| {
        let of = |axis: usize| -> Option<Coordinate> {
            let (v, sign) = coordinate(model, HardpointId(h), axis)?;
            let variable = &model.variables[v.0];
            let bounds = variable.bounds.map(|b| b.map(|x| units.from_si(variable.quantity, x)));
            Some(Coordinate { variable: variable.name.clone(), sign, bounds })
        };
        let place =
            hardpoint.position.to_array().map(|x| units.from_si(hardpoint::joint::Quantity::Length, x));
        Some(MovableHardpoint { name: hardpoint.name.clone(), place, coordinates: [of(0)?, of(1)?, of(2)?] })
    };
    model.hardpoints.iter().enumerate().filter(|(_, h)| !h.unnamed).filter_map(grip).collect()
}
