//! Long tasks: the whole page of a model, optimisations, tolerance studies.

use std::num::NonZero;
use std::ops::ControlFlow;

use hardpoint::Analysis;
use hardpoint::model::{Model, ToleranceSettings};
use hardpoint::topology::{Formulation, TopologyError};
use hardpoint_file::ModelFile;
use hardpoint_report::course::Course;
use hardpoint_report::diagnose;
use hardpoint_report::optimize::{OptimizeFacts, iteration_line, rounded, start_line};
use hardpoint_report::page::{ModelText, Payload};
use hardpoint_report::payload::{Request, payload};
use hardpoint_report::summary::Summary;
use hardpoint_report::tolerance::{ToleranceFacts, ToleranceInputs};
use hardpoint_report::validity::ValidityFact;
use hardpoint_study::optimize::{OptimizationRequest, SearchProgress, optimize};
use hardpoint_study::tolerance::{ToleranceError, ToleranceStage, tolerance};
use hardpoint_study::{Motions, validity};

use crate::protocol::{
    DiagnosticMessage, OptimizeRequest, ProgressReply, StudyReply, ToleranceRequest, VariableSetting,
};
use crate::{ProgressListener, RequestError, offer, parse_in_case, parse_model};

/// Returns the whole page of a model.
pub(crate) fn page(model: &ModelText) -> Result<Payload, RequestError> {
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
    let mut summary = Summary::new(&file, analysis.topology(), &course);
    if course.stride == 1 && !solution.measured.outputs.is_empty() {
        let found = validity(&analysis, &solution, |_| true);
        summary.validity = ValidityFact::all(&file.model, file.units, &solution, &found);
    }
    Ok(payload(&Request::of(&file, &analysis, &course, &summary)))
}

/// Creates the analyses of all motions of a file.
fn motions<'m>(
    file: &ModelFile,
    models: &'m [Model],
    model: &ModelText,
) -> Result<Motions<'m>, RequestError> {
    Motions::of(models, Formulation::Relative).map_err(|(_, fault)| {
        vec![DiagnosticMessage::of(&model.text, &diagnose::topology_fault(file, &fault))]
    })
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
) -> Result<StudyReply, RequestError> {
    let mut file = parse_model(model)?;
    let settings = offer::merged_settings(&mut file, request)?;
    let models = file.model.motions();
    let motions = motions(&file, &models, model)?;
    let (units, many, mut done) = (file.units, settings.starts > 1, 0);
    let mut progress = |k: usize, event: SearchProgress<'_>| {
        let reply = match event {
            SearchProgress::Iteration(iteration) if !many => ProgressReply {
                done: iteration.number,
                total: Some(settings.iterations),
                line: iteration_line(&file.model, units, iteration),
                change: Some(changes(&file, &iteration.best)),
            },
            SearchProgress::End(search) if many => {
                done += 1;
                let change = search.found.as_ref().map(|found| changes(&file, &found.design));
                ProgressReply { done, total: Some(settings.starts), line: start_line(k, search), change }
            }
            _ => return ControlFlow::Continue(()),
        };
        listener(&reply)
    };
    let run = OptimizationRequest {
        progress: &mut progress,
        more: &|| true,
        threads: NonZero::<usize>::MIN,
        first: 0,
    };
    let found = optimize(&file.model, &motions, &settings, run);
    let facts = OptimizeFacts::of(&file, &settings, &found);
    let best = found.best.and_then(|k| found.searches[k].found.as_ref());
    let design = best.map(|best| rounded(&file, &settings, &best.design));
    let text = design.as_ref().map(|design| file.edit(design)).transpose();
    let text = text.map_err(|all| -> RequestError {
        all.list().iter().map(|d| DiagnosticMessage::of(&model.text, d)).collect()
    })?;
    Ok(StudyReply {
        message: facts
            .rows()
            .into_iter()
            .map(|(what, how)| format!("{what}: {how}"))
            .collect::<Vec<_>>()
            .join("; "),
        tables: facts.tables(),
        change: design.map(|design| changes(&file, &design)),
        text,
    })
}

/// Runs the tolerance study of a model.
pub(crate) fn run_tolerance(
    model: &ModelText,
    request: &ToleranceRequest,
    listener: &mut ProgressListener<'_>,
) -> Result<StudyReply, RequestError> {
    let file = parse_model(model)?;
    let settings = file.model.tolerancing.clone().or_else(|| ToleranceSettings::of_variables(&file.model));
    let Some(mut settings) = settings else {
        let message = "the design variables have no tolerances".into();
        let help = "add `tolerance = 0.1` to variables in `[design]` or `[parameters]`";
        return Err(vec![DiagnosticMessage::plain("HP0602", message, help)]);
    };
    settings.samples = request.samples;
    settings.seed = request.seed.into();
    let models = file.model.motions();
    let motions = motions(&file, &models, model)?;
    let numbers: Vec<usize> = (0..models.len()).collect();
    let mut on = |stage: ToleranceStage| {
        let (done, of, line) = match stage {
            ToleranceStage::Derivatives(done, of) => (done, of, "differentiating"),
            ToleranceStage::Designs(done, of) => (done, of, "solving designs"),
        };
        listener(&ProgressReply { done, total: Some(of), line: line.into(), change: None })
    };
    let found =
        tolerance(&file.model, &motions, &numbers, &settings, NonZero::<usize>::MIN, &mut on, &|| true);
    let found = found.map_err(|failure| match failure {
        ToleranceError::Nominal(rejection) => {
            vec![DiagnosticMessage::of(&model.text, &diagnose::stop(&file, &rejection.stop, 0, None))]
        }
        ToleranceError::NothingVaries => {
            let message = "none of the variables with a tolerance is admissible".into();
            vec![DiagnosticMessage::plain(
                "HP0602",
                message,
                "give tolerances to variables that the mechanism can follow",
            )]
        }
    })?;
    let facts = ToleranceFacts::of(&ToleranceInputs {
        file: &file,
        numbers: &numbers,
        asked: &settings,
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
