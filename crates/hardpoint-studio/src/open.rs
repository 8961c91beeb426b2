//! OpenModel model, with its designs solved as the reader changes them.

use std::sync::Arc;

use hardpoint::model::{HardpointId, Model, ShapeId};
use hardpoint::run::ShapeDistance;
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
use crate::{EngineError, first_case, parse_in_case, parse_model};

/// Maximum number of bisections of the path to a design that cannot be reached; the last step is a thousandth of the
/// path.
const HALVINGS: usize = 10;

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
    /// Values of the last design that shapes could stop, and the pairs that touch in it.
    touching: Option<(Vec<f64>, Vec<[ShapeId; 2]>)>,
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
        let (memory, touching) = (Solution::default(), None);
        Ok((
            Self { all_cases, file, analysis, nominal, bare, summary, shown, memory, pairs, touching },
            opened,
        ))
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
        let apart = match start.as_ref().filter(|_| solid && !self.pairs.is_empty()) {
            Some(start) => self.pairs_apart(start),
            None => Vec::new(),
        };
        let (mut solution, mut why) = self.solve_apart(&target, &apart);
        let mut part = 1.0;
        let mut design = target.clone();
        if let (Some(start), Some(_)) = (start, &why) {
            // Bisects the path for the last admissible design.
            let (mut low, mut high) = (0.0, 1.0);
            let on_path = |part: f64| -> Vec<f64> {
                start.iter().zip(&target).map(|(a, b)| a + part * (b - a)).collect()
            };
            let mut reached = None;
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                self.memory = solution;
                let (found, stop) = self.solve_apart(&on_path(middle), &apart);
                solution = found;
                match stop {
                    None => {
                        low = middle;
                        reached = Some(std::mem::take(&mut solution));
                    }
                    Some(stop) => (high, why) = (middle, Some(stop)),
                }
            }
            (part, design) = (low, on_path(low));
            solution = match reached {
                Some(reached) => reached,
                None => self.solve(&design).0,
            };
        }
        let shown = self.shown(&solution, &design);
        if solid {
            let touching = self.touching(&design, &solution, &self.pairs);
            self.touching = Some((design, touching.into_iter().map(|(pair, _)| pair).collect()));
        }
        self.memory = solution;
        Ok(DesignReply { part, design: shown, why })
    }

    /// Pairs of shapes that are apart in a design at all output times.
    fn pairs_apart(&mut self, design: &[f64]) -> Vec<[ShapeId; 2]> {
        let known = self.touching.take().filter(|(values, _)| values == design);
        let (_, touching) = known.unwrap_or_else(|| {
            let (solution, _) = self.solve(design);
            let touching = self.touching(design, &solution, &self.pairs);
            self.memory = solution;
            (design.to_vec(), touching.into_iter().map(|(pair, _)| pair).collect())
        });
        self.pairs.iter().copied().filter(|pair| !touching.contains(pair)).collect()
    }

    /// Those of some pairs that touch in a solved design, each with the first output time of that, s.
    fn touching(
        &self,
        design: &[f64],
        solution: &Solution,
        pairs: &[[ShapeId; 2]],
    ) -> Vec<([ShapeId; 2], f64)> {
        let motion = &solution.motion;
        let curves = self.analysis.distances(design, motion, pairs, 0..motion.len());
        let first =
            |curve: &Vec<ShapeDistance>| curve.iter().find(|at| at.distance[0] < 0.0).map(|at| at.time);
        pairs.iter().zip(&curves).filter_map(|(pair, curve)| Some((*pair, first(curve)?))).collect()
    }

    /// Solves a design; the diagnostic reports why its motion ends early, or the pair of shapes that touches in it.
    fn solve_apart(
        &mut self,
        values: &[f64],
        apart: &[[ShapeId; 2]],
    ) -> (Solution, Option<DiagnosticMessage>) {
        let (solution, stop) = self.solve(values);
        let touch = || {
            let all = self.touching(values, &solution, apart);
            let ([a, b], time) = all.into_iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
            let [a, b] = [a, b].map(|shape| &self.file.model.shapes[shape.0].name);
            let message = format!("`{a}` touches `{b}` at t = {} s beyond this design", rounded(time, 4));
            Some(DiagnosticMessage::plain("HP0705", message, "hide the shapes to move on"))
        };
        let why = stop.or_else(|| if apart.is_empty() { None } else { touch() });
        (solution, why)
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
