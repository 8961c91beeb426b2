//! What takes its time: the whole page of a model, a search, tolerances.

use std::num::NonZero;
use std::ops::ControlFlow;

use hardpoint::Analysis;
use hardpoint::model::{Model, Tolerancing};
use hardpoint::study::{
    Motions, Progress, Searching, Stage, ToleranceFailure, optimize, tolerance, validity,
};
use hardpoint::topology::{Formulation, TopologyFault};
use hardpoint_file::ModelFile;
use hardpoint_report::course::Course;
use hardpoint_report::diagnose;
use hardpoint_report::optimize::{OptimizeFacts, iteration_line, rounded, start_line};
use hardpoint_report::page::{ModelText, Payload};
use hardpoint_report::payload::{Request, payload};
use hardpoint_report::summary::Summary;
use hardpoint_report::tolerance::{Studied as Toleranced, ToleranceFacts};
use hardpoint_report::validity::ValidityFact;

use crate::protocol::{Message, OptimizeRequest, Setting, Studied, Told, ToleranceRequest};
use crate::{Refusal, Tell, offer, read, whole};

/// Everything that the page of a model shows.
pub(crate) fn page(model: &ModelText) -> Result<Payload, Refusal> {
    let file = read(model)?;
    let fault =
        |fault: TopologyFault| vec![Message::of(&model.text, &diagnose::topology_fault(&file, &fault))];
    let analysis = Analysis::new(&file.model).map_err(fault)?;
    let solution = analysis.run();
    if let Some(stop) = solution.stop.as_ref().filter(|_| solution.motion.is_empty()) {
        return Err(vec![Message::of(&model.text, &diagnose::stop(&file, stop, 0, None))]);
    }
    let course = Course::of(&file.model, &solution);
    let mut summary = Summary::new(&file, analysis.topology(), &course);
    if course.stride == 1 && !solution.measured.outputs.is_empty() {
        let found = validity(&analysis, &solution, |_| true);
        summary.validity = ValidityFact::all(&file.model, file.units, &solution, &found);
    }
    Ok(payload(&Request::of(&file, &analysis, &course, &summary)))
}

/// The plans of all motions of a file.
fn motions<'m>(file: &ModelFile, models: &'m [Model], model: &ModelText) -> Result<Motions<'m>, Refusal> {
    Motions::of(models, Formulation::Relative)
        .map_err(|(_, fault)| vec![Message::of(&model.text, &diagnose::topology_fault(file, &fault))])
}

fn changes(file: &ModelFile, design: &[f64]) -> Vec<Setting> {
    let changed = file.model.variables.iter().zip(design).filter(|(_, by)| **by != 0.0);
    changed.map(|(v, by)| Setting { name: v.name.clone(), by: file.units.from_si(v.quantity, *by) }).collect()
}

/// A search for the best design.
pub(crate) fn optimized(
    model: &ModelText,
    request: &OptimizeRequest,
    tell: &mut Tell<'_>,
) -> Result<Studied, Refusal> {
    let mut file = whole(model)?;
    let asked = offer::asked(&mut file, request)?;
    let models = file.model.motions();
    let motions = motions(&file, &models, model)?;
    let (units, many, mut done) = (file.units, asked.starts > 1, 0);
    let mut progress = |k: usize, told: Progress<'_>| {
        let told = match told {
            Progress::Iteration(iteration) if !many => Told {
                done: iteration.number,
                total: Some(asked.iterations),
                line: iteration_line(&file.model, units, iteration),
                change: Some(changes(&file, &iteration.best)),
            },
            Progress::End(search) if many => {
                done += 1;
                let change = search.found.as_ref().map(|found| changes(&file, &found.design));
                Told { done, total: Some(asked.starts), line: start_line(k, search), change }
            }
            _ => return ControlFlow::Continue(()),
        };
        tell(&told)
    };
    let searching =
        Searching { progress: &mut progress, more: &|| true, threads: NonZero::<usize>::MIN, first: 0 };
    let found = optimize(&file.model, &motions, &asked, searching);
    let facts = OptimizeFacts::of(&file, &asked, &found);
    let best = found.best.and_then(|k| found.searches[k].found.as_ref());
    let design = best.map(|best| rounded(&file, &asked, &best.design));
    let text = design.as_ref().map(|design| file.edit(design)).transpose();
    let text =
        text.map_err(|all| -> Refusal { all.list().iter().map(|d| Message::of(&model.text, d)).collect() })?;
    Ok(Studied {
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

/// What the tolerances of a model come to.
pub(crate) fn toleranced(
    model: &ModelText,
    request: &ToleranceRequest,
    tell: &mut Tell<'_>,
) -> Result<Studied, Refusal> {
    let file = whole(model)?;
    let asked = file.model.tolerancing.clone().or_else(|| Tolerancing::of_variables(&file.model));
    let Some(mut asked) = asked else {
        let message = "the model does not say how far its design variables may be off".into();
        let help = "add `tolerance = 0.1` to those in `[design]` or `[parameters]` that may";
        return Err(vec![Message::plain("HP0602", message, help)]);
    };
    asked.samples = request.samples;
    asked.seed = request.seed.into();
    let models = file.model.motions();
    let motions = motions(&file, &models, model)?;
    let numbers: Vec<usize> = (0..models.len()).collect();
    let mut on = |stage: Stage| {
        let (done, of, line) = match stage {
            Stage::Derivatives(done, of) => (done, of, "differentiating"),
            Stage::Designs(done, of) => (done, of, "solving designs"),
        };
        tell(&Told { done, total: Some(of), line: line.into(), change: None })
    };
    let found = tolerance(&file.model, &motions, &numbers, &asked, NonZero::<usize>::MIN, &mut on, &|| true);
    let found = found.map_err(|failure| match failure {
        ToleranceFailure::Drawn(rejection) => {
            vec![Message::of(&model.text, &diagnose::stop(&file, &rejection.stop, 0, None))]
        }
        ToleranceFailure::NothingVaries => {
            let message = "the mechanism can follow none of the variables with a tolerance".into();
            vec![Message::plain("HP0602", message, "give tolerances to variables that it can follow")]
        }
    })?;
    let facts =
        ToleranceFacts::of(&Toleranced { file: &file, numbers: &numbers, asked: &asked, found: &found });
    let rows = facts.rows().into_iter().map(|(what, how)| format!("{what}: {how}"));
    Ok(Studied {
        message: rows.collect::<Vec<_>>().join("; "),
        tables: facts.tables(),
        change: None,
        text: None,
    })
}
