//! `hardpoint compare`.

use std::io::Write;
use std::path::PathBuf;

use hardpoint::model::Model;
use hardpoint::{Analysis, Run};
use hardpoint_file::ModelFile;
use hardpoint_report::compare::{CompareFacts, SolvedModel, are_alike};
use hardpoint_report::course::Course;
use hardpoint_report::diagnose;
use hardpoint_report::payload::{ChangedDesign, Request, report};
use hardpoint_report::summary::Summary;
use hardpoint_study::request::named;
use hardpoint_study::whatif::{add_coordinates, variable_named};

use crate::args::Compare;
use crate::folder::{Folder, of_case};
use crate::outcome::Outcome;
use crate::session::{Session, json_text};
use crate::text;
use crate::whatif::is_wanted;

/// All files of a comparison; the last one marks them as complete.
const FILES: [&str; 3] = ["compare.html", "compare.csv", "compare.json"];

/// Solves both models and prints their differences.
pub fn compare(options: &Compare) -> Outcome {
    let session = Session::begin(options.common.json);
    let each = |file: ModelFile, case: Option<&str>| compare_in(&session, options, file, case);
    session.end(session.for_motions(&options.common.model, &options.motions, each))
}

/// Second model of the comparison: the first one with a design of its `[designs]`, or another file.
fn second(session: &Session, options: &Compare) -> Result<ModelFile, Outcome> {
    let path = &options.other;
    let name = path.to_string_lossy();
    let first = session.read(&options.common.model)?;
    let designs = &first.model.designs;
    let is_design = designs.iter().any(|design| design.name == name);
    if !is_design && (designs.is_empty() || path.extension().is_some() || path.exists()) {
        return session.read(path);
    }
    let k = named("design", &name, designs.iter().map(|design| design.name.as_str()))
        .map_err(|error| session.refused(&first, &error))?;
    let text = session.edited(&first, &designs[k].changes_of(first.model.variables.len()))?;
    hardpoint_file::parse_in(options.common.model.parent(), &text, &name).map_err(|diagnostics| {
        session.not_read(&diagnostics);
        Outcome::BadModel
    })
}

/// Motion of the second model: that of the case, or its only one.
fn motion_of(
    session: &Session,
    other: &ModelFile,
    case: Option<&str>,
    first: &ModelFile,
) -> Result<Model, Outcome> {
    match case {
        Some(name) => Ok(other.model.in_case(session.case(other, name)?)),
        None if other.model.cases.is_empty() => Ok(other.model.clone()),
        None => {
            let why = format!(
                "`{}` has cases and `{}` has none: there is no motion to compare",
                other.file_name(),
                first.file_name()
            );
            Err(session.misunderstood(&why))
        }
    }
}

fn compare_in(
    session: &Session,
    options: &Compare,
    mut file: ModelFile,
    case: Option<&str>,
) -> Result<Outcome, Outcome> {
    let mut other = second(session, options)?;
    other.model = motion_of(session, &other, options.motions.case.as_deref().or(case), &file)?;
    add_coordinates(&mut file.model);
    session.fits(&mut file);
    other.model.times.clone_from(&file.model.times);
    let folder = options.output.as_ref().map(|path| Folder::open(&of_case(path, case)));
    let folder = folder.transpose().map_err(|e| session.not_written(&e))?;

    let formulation = options.common.formulation();
    let (analysis, of_other) = (session.plan(&file, formulation)?, session.plan(&other, formulation)?);
    let today = session.solve(&analysis);
    let exact = of_other.solve(Run::new().without_sensitivities().progress(|_| session.go_on()));
    let (mut outcome, mut stops) = (Outcome::Done, Vec::new());
    for (file, solution) in [(&file, &today), (&other, &exact)] {
        if let Some(stop) = &solution.stop {
            let diagnostic = diagnose::stop(file, stop, solution.motion.len(), None);
            if solution.motion.is_empty() || session.interrupted() {
                session.fail(file, &[diagnostic]);
                return Err(if session.interrupted() { Outcome::Interrupted } else { Outcome::Stopped });
            }
            session.tell(file, std::slice::from_ref(&diagnostic));
            stops.push(diagnostic);
            outcome = Outcome::Stopped;
        }
    }
    let both =
        [SolvedModel { file: &file, solution: &today }, SolvedModel { file: &other, solution: &exact }];
    let mut facts = CompareFacts::of(both);
    facts.diagnostics.splice(0..0, stops);
    let names: Vec<&str> = facts.measures.iter().map(|c| c.measure.as_str()).collect();
    for name in &options.measure {
        named("common measure", name, names.iter().copied())
            .map_err(|error| session.refused(&file, &error))?;
    }
    let measures = &options.measure;
    let wanted = |name: &str| is_wanted(&file.model, measures, name);

    let mut written = Vec::new();
    if let Some(mut folder) = folder {
        let page = are_alike(both).then(|| page_of_both(both, &analysis, &facts, measures, &wanted));
        let json = json_text(&facts);
        let result = page
            .map_or(Ok(()), |html| folder.write(FILES[0], |out| out.write_all(html.as_bytes())))
            .and_then(|()| folder.write(FILES[1], |out| facts.write_csv(out).map_err(Into::into)))
            .and_then(|()| folder.write(FILES[2], |out| out.write_all(json.as_bytes())));
        let page_is_there = are_alike(both);
        written.extend(FILES[usize::from(!page_is_there)..].iter().map(|name| folder.path_of(name)));
        result.and_then(|()| folder.commit(&FILES)).map_err(|e| session.not_written(&e))?;
        if !page_is_there {
            session.remark("the models have different bodies or measures: no page was written, because it cannot show them together");
        }
    }
    if session.is_json() {
        session.print_json(&facts);
    } else {
        print(&facts, &wanted, &written);
    }
    Ok(outcome)
}

/// Page of two models with the same bodies and outputs.
fn page_of_both(
    both: [SolvedModel<'_>; 2],
    analysis: &Analysis<'_>,
    facts: &CompareFacts,
    measures: &[String],
    wanted: &dyn Fn(&str) -> bool,
) -> String {
    let [SolvedModel { file, solution: today }, SolvedModel { file: other, solution: exact }] = both;
    // Hardpoints of the other file, as changes of this one.
    let mut change = vec![0.0; file.model.variables.len()];
    let mut known = file.model.clone();
    for h in &facts.hardpoints {
        let moved = h.values[1].zip(h.values[0]).map_or(0.0, |(b, a)| b - a);
        if let Some(v) = variable_named(&mut known, &h.name).filter(|v| v.0 < change.len()) {
            change[v.0] = file.units.to_si(known.variables[v.0].quantity, moved);
        }
    }
    let course = Course::of(&file.model, today);
    let mut summary = Summary::new(file, analysis, &course);
    summary.diagnostics = diagnose::all(file, &summary, &course, None);
    let changed = ChangedDesign {
        name: other.file_name().into(),
        note: format!("The design of {}.", other.file_name()),
        change: &change,
        today,
        exact,
        prediction: None,
    };
    let request = Request { changed: Some(changed), ..Request::of(file, analysis, &course, &summary) };
    let finish = |payload| facts.page(payload, measures, wanted);
    report(&request, &finish).expect("a payload is plain data")
}

/// Prints the tables of differences and the written files.
fn print(facts: &CompareFacts, wanted: &dyn Fn(&str) -> bool, written: &[PathBuf]) {
    let [a, b] = &facts.names;
    text::print(&format!("{}\n", text::bold(&format!("{a} - {b}"))));
    if facts.is_same() {
        text::print("  the hardpoints and parameters of both are the same\n");
    }
    for table in facts.tables(wanted) {
        text::print(&text::section(&table));
    }
    for path in written {
        text::print(&format!("\nwritten: {}\n", path.display()));
    }
}
