//! Long tasks: the whole page of a model, optimisations, tolerance studies.

use std::num::NonZero;
use std::ops::ControlFlow;

use hardpoint::Analysis;
use hardpoint::model::Model;
use hardpoint::topology::{Formulation, TopologyError};
use hardpoint_file::ModelFile;
use hardpoint_report::course::Course;
use hardpoint_report::diagnose;
use hardpoint_report::optimize::{OptimizeFacts, progress_line, rounded};
use hardpoint_report::page::{ModelText, Payload};
use hardpoint_report::payload::{Request, payload};
use hardpoint_report::summary::Summary;
use hardpoint_report::tolerance::{ToleranceFacts, ToleranceInputs, nominal_stop};
use hardpoint_report::validity::ValidityFact;
use hardpoint_study::optimize::optimize;
use hardpoint_study::tolerance::{self, Overrides, tolerance};
use hardpoint_study::{Control, Motions, Progress, Step, validity};

use crate::protocol::{
    DiagnosticMessage, OptimizeRequest, ProgressReply, StudyReply, ToleranceRequest, VariableSetting,
};
use crate::{EngineError, ProgressListener, offer, parse_in_case, parse_model};

/// Returns the whole page of a model.
pub(crate) fn page(model: &ModelText) -> Result<Payload, EngineError> {
    let file = parse_in_case(model)?;
    let fault = |fault: TopologyError| {
        vec![DiagnosticMessage::of(&model.text, &diagnose::topology_fault(&file, &fault))]
    };
    let analysis = Analysis::new(&file.model).map_err(fault)?;
    let solution = analysis.run();
    if let Some(stop) = solution.stop.as_ref().filter(|_| solution.motion.is_empty()) {
        return Err(vec![DiagnosticMessage::of(&model.text, &diagnose::stop(&file, stop, 0, None))]);
    }
    let course = Course::of(&file.model, &solution);
    let mut summary = Summary::new(&file, &analysis, &course);
    if course.stride == 1 && !solution.measured.outputs.is_empty() {
        let found = validity(&analysis, &solution, |_| true);
        summary.validity = ValidityFact::all(&file.model, file.units, &solution, &found);
    }
    Ok(payload(&Request::of(&file, &analysis, &course, &summary)))
}

/// Creates the analyses of all motions of a file.
fn motions<'m>(file: &ModelFile, models: &'m [Model], model: &ModelText) -> Result<Motions<'m>, EngineError> {
    Motions::of(models, Formulation::Relative).map_err(|(_, fault)| {
        vec![DiagnosticMessage::of(&model.text, &diagnose::topology_fault(file, &fault))]
    })
}

/// Diagnostic of a study that cannot be requested.
fn refused(error: hardpoint_study::RequestError) -> EngineError {
    vec![DiagnosticMessage::plain("HP0602", error.message, &error.help)]
}

fn changes(file: &ModelFile, design: &[f64]) -> Vec<VariableSetting> {
    let changed = file.model.variables.iter().zip(design).filter(|(_, by)| **by != 0.0);
    changed
        .map(|(v, by)| VariableSetting { name: v.name.clone(), by: file.units.from_si(v.quantity, *by) })
        .collect()
}

/// Runs the optimisation of a model.
pub(crate) fn run_optimization(
    model: &ModelText,
    request: &OptimizeRequest,
    listener: &mut ProgressListener<'_>,
) -> Result<StudyReply, EngineError> {
    let mut file = parse_model(model)?;
    let request = offer::requested(&mut file, request).map_err(refused)?;
    let settings = &request.settings;
    let models = file.model.motions();
    let motions = motions(&file, &models, model)?;
    let mut progress = |progress: Progress<'_>| {
        let design = match progress.step {
            Step::Iteration(iteration) => Some(&iteration.best),
            Step::Search(_, search) => search.found.as_ref().map(|found| &found.design),
            Step::Variable | Step::Designs | Step::FrontPoint | Step::Fit(_) => None,
        };
        let line = progress_line(&file.model, file.units, &progress);
        if line.is_none() && design.is_none() {
            return ControlFlow::Continue(());
        }
        listener(&ProgressReply {
            done: progress.done,
            total: Some(progress.total),
            // Iterations of one of several searches have a design to draw, but no line.
            line: line.unwrap_or_default(),
            change: design.map(|design| changes(&file, design)),
        })
    };
    let control = Control { threads: NonZero::<usize>::MIN, progress: &mut progress, more: &|| true };
    let found = optimize(&file.model, &motions, &request, control);
    let facts = OptimizeFacts::of(&file, settings, &found);
    let best = found.best.and_then(|k| found.searches[k].found.as_ref());
    let design = best.map(|best| rounded(&file, settings, &best.design));
    let text = design.as_ref().map(|design| file.edit(design));
    let mut message: Vec<String> =
        facts.rows().into_iter().map(|(what, how)| format!("{what}: {how}")).collect();
    if let Some(Err(refusal)) = &text {
        let reasons: Vec<_> = refusal.list().iter().map(|d| d.message.as_str()).collect();
        message.push(format!("not saved: {}", reasons.join("; ")));
    }
    Ok(StudyReply {
        message: message.join("; "),
        tables: facts.tables(),
        change: design.map(|design| changes(&file, &design)),
        text: text.and_then(Result::ok),
    })
}

/// Runs the tolerance study of a model.
pub(crate) fn run_tolerance(
    model: &ModelText,
    request: &ToleranceRequest,
    listener: &mut ProgressListener<'_>,
) -> Result<StudyReply, EngineError> {
    let file = parse_model(model)?;
    let allocate = request.allocate.as_deref().map(tolerance::allocation_rule);
    let overrides = Overrides {
        samples: Some(request.samples),
        seed: Some(request.seed.into()),
        allocate: allocate.transpose().map_err(refused)?,
    };
    let request = tolerance::Request::of(&file.model, &overrides).map_err(refused)?;
    let models = file.model.motions();
    let motions = motions(&file, &models, model)?;
    let numbers: Vec<usize> = (0..models.len()).collect();
    let mut progress = |Progress { step, done, total, .. }: Progress<'_>| {
        let line = match step {
            Step::Variable => "differentiating",
            Step::Designs => "solving designs",
            Step::Iteration(_) | Step::Search(..) | Step::FrontPoint | Step::Fit(_) => {
                return ControlFlow::Continue(());
            }
        };
        listener(&ProgressReply { done, total: Some(total), line: line.into(), change: None })
    };
    let control = Control { threads: NonZero::<usize>::MIN, progress: &mut progress, more: &|| true };
    let found =
        tolerance(&file.model, &motions, &numbers, &request, control).map_err(|error| match error {
            tolerance::Error::Nominal(stopped) => {
                let (_, diagnostic) = nominal_stop(&file, &motions, &numbers, &stopped);
                vec![DiagnosticMessage::of(&model.text, &diagnostic)]
            }
            tolerance::Error::Request(error) => refused(error),
        })?;
    let facts = ToleranceFacts::of(&ToleranceInputs {
        file: &file,
        numbers: &numbers,
        asked: &request.settings,
        found: &found,
    });
    let rows = facts.rows().into_iter().map(|(what, how)| format!("{what}: {how}"));
    Ok(StudyReply {
        message: rows.collect::<Vec<_>>().join("; "),
        tables: facts.tables(),
        change: None,
        text: None,
    })
}
