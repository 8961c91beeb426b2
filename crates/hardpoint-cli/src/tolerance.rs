//! `hardpoint tolerance`.

use std::io::Write;
use std::num::NonZero;

use hardpoint::Analysis;
use hardpoint::model::{Allocating, AllocationRule, Limited, Model, Tolerancing};
use hardpoint::study::{Examination, Motions, Stage, ToleranceFailure, tolerance};
use hardpoint_file::ModelFile;
use hardpoint_report::course::Course;
use hardpoint_report::diagnose;
use hardpoint_report::figures::some_of;
use hardpoint_report::optimize::case_name;
use hardpoint_report::payload::{Request, report};
use hardpoint_report::summary::Summary;
use hardpoint_report::tolerance::{Studied, ToleranceFacts};

use crate::args::{Allocate, Tolerance};
use crate::folder::{Folder, NotWritten, file_name};
use crate::outcome::Outcome;
use crate::session::{Meter, Session, json_text};
use crate::text;

/// Studies the tolerances of a model, writes, and prints what they come to.
pub fn run(options: &Tolerance) -> Outcome {
    let session = Session::begin(options.common.json);
    tolerance_in(&session, options).unwrap_or_else(|outcome| outcome)
}

fn tolerance_in(session: &Session, options: &Tolerance) -> Result<Outcome, Outcome> {
    let file = session.read(&options.common.model)?;
    let numbers = session.numbers_of(&file, &options.motions)?;
    let asked = asked(session, &file, options)?;
    let models = file.model.motions();
    let models: Vec<Model> = numbers.iter().map(|k| models[*k].clone()).collect();
    let motions = Motions::of(&models, options.common.formulation());
    let motions = motions.map_err(|(_, fault)| session.cannot_be_driven(&file, &fault))?;
    let path = options.output.as_ref();
    let folder = path.map(|path| Folder::open(path)).transpose().map_err(|e| session.not_written(&e))?;

    session.patient(true);
    let found = examine(session, &file, &motions, &numbers, &asked, options)?;
    let studied = Studied { file: &file, numbers: &numbers, asked: &asked, found: &found };
    let mut facts = ToleranceFacts::of(&studied);
    facts.seconds = session.seconds();
    let mut written = None;
    if let Some(mut folder) = folder {
        let results = Results { studied, motions: &motions };
        results.write(&mut folder, &mut facts).map_err(|e| session.not_written(&e))?;
        written = Some(folder.path_of("summary.json"));
        folder.commit(&FILES).map_err(|e| session.not_written(&e))?;
    }
    if session.is_json() {
        session.print_json(&facts);
    } else {
        text::print(&format!("{}\n{}", text::bold(&file.model.name), facts_text(&facts)));
        text::print(&written.map_or(String::new(), |path| format!("\nwritten: {}\n", path.display())));
    }
    Ok(if found.interrupted { Outcome::Interrupted } else { Outcome::Done })
}

/// The tables that are written, and the summary, which vouches for them.
const FILES: [&str; 5] = ["metrics.csv", "contributions.csv", "bands.csv", "samples.csv", "summary.json"];

/// What is asked for, by the file and by the command line.
fn asked(session: &Session, file: &ModelFile, options: &Tolerance) -> Result<Tolerancing, Outcome> {
    let asked = file.model.tolerancing.clone().or_else(|| Tolerancing::of_variables(&file.model));
    let Some(mut asked) = asked else {
        let why = format!(
            "`{}` does not say how far its design variables may be off; add `tolerance = 0.1` to those in `[design]` or \
             `[parameters]` that may (docs/tolerance.md)",
            file.file_name()
        );
        return Err(session.misunderstood(&why));
    };
    asked.samples = options.samples.map_or(asked.samples, |n| n as usize);
    asked.seed = options.seed.map_or(asked.seed, u64::from);
    if let Some(rule) = options.allocate {
        let given = asked.allocation.map(|a| a.rule);
        let rule = match (rule, given) {
            (Allocate::Rss, Some(rule @ AllocationRule::Rss { .. })) => rule,
            (Allocate::Rss, _) => AllocationRule::Rss { sigmas: Tolerancing::SIGMAS },
            (Allocate::WorstCase, _) => AllocationRule::Worst,
        };
        asked.allocation = Some(Allocating { rule });
    }
    if asked.metrics.is_empty() && asked.curves.is_empty() && !has_metric_limits(&asked) {
        let why =
            format!("`{}` has neither metrics nor measures that tolerances could change", file.file_name());
        return Err(session.misunderstood(&why));
    }
    Ok(asked)
}

fn has_metric_limits(asked: &Tolerancing) -> bool {
    asked.limits.iter().any(|limit| matches!(limit.of, Limited::Metric(_)))
}

/// Studies, showing how far it is.
fn examine(
    session: &Session,
    file: &ModelFile,
    motions: &Motions<'_>,
    numbers: &[usize],
    asked: &Tolerancing,
    options: &Tolerance,
) -> Result<Examination, Outcome> {
    let mut derivatives = Meter::new("differentiating", "variables");
    let mut designs = Meter::new("solving", "designs");
    let mut tell = |stage: Stage| {
        match stage {
            Stage::Derivatives(done, of) => derivatives.show(done, of),
            Stage::Designs(done, of) => designs.show(done, of),
        }
        session.go_on()
    };
    let threads = options.threads.or_else(|| std::thread::available_parallelism().ok());
    let threads = threads.unwrap_or(NonZero::<usize>::MIN);
    let more = || session.go_on().is_continue();
    let found = tolerance(&file.model, motions, numbers, asked, threads, &mut tell, &more);
    found.map_err(|failure| match failure {
        ToleranceFailure::Drawn(rejection) if rejection.interrupted() => {
            session.misunderstood("interrupted before the design as drawn was solved");
            Outcome::Interrupted
        }
        ToleranceFailure::Drawn(rejection) => {
            let mut one = file.clone();
            one.model = Model::clone(motions.model(rejection.motion));
            let mut diagnostic = diagnose::stop(&one, &rejection.stop, 0, None);
            if let Some(case) = case_name(&file.model, numbers[rejection.motion]) {
                diagnostic.message = format!("case `{case}`: {}", diagnostic.message);
            }
            session.fail(&one, &[diagnostic]);
            Outcome::Stopped
        }
        ToleranceFailure::NothingVaries => {
            let names: Vec<&str> = asked.tolerances.iter().map(|t| t.name.as_str()).collect();
            session.misunderstood(&format!(
                "the mechanism can follow none of the variables with a tolerance: {}",
                some_of(&names, ", ")
            ))
        }
    })
}

/// What is written.
struct Results<'a> {
    studied: Studied<'a>,
    motions: &'a Motions<'a>,
}

impl Results<'_> {
    /// Tables, a page for each motion, and the summary last.
    fn write(&self, folder: &mut Folder, facts: &mut ToleranceFacts) -> Result<(), NotWritten> {
        let Studied { file, asked, found, numbers } = self.studied;
        for (k, analysis) in self.motions.analyses().iter().enumerate() {
            let name = match case_name(&file.model, numbers[k]) {
                Some(case) => format!("report-{}.html", file_name(&case)),
                None => "report.html".into(),
            };
            let Some(html) = self.page(analysis, k, facts) else { continue };
            folder.write(&name, |out| out.write_all(html.as_bytes()))?;
            facts.files.push(folder.path_of(&name).display().to_string());
        }
        let studied = &self.studied;
        folder.write("metrics.csv", |out| studied.write_metrics(out).map_err(Into::into))?;
        folder.write("contributions.csv", |out| studied.write_contributions(out).map_err(Into::into))?;
        folder.write("bands.csv", |out| studied.write_bands(out).map_err(Into::into))?;
        let mut names = vec!["metrics.csv", "contributions.csv", "bands.csv"];
        if found.sampled.is_some() {
            let deviations = found.deviations(&file.model, asked);
            folder.write("samples.csv", |out| studied.write_samples(deviations, out).map_err(Into::into))?;
            names.push("samples.csv");
        }
        names.push("summary.json");
        facts.files.extend(names.iter().map(|name| folder.path_of(name).display().to_string()));
        let json = json_text(facts);
        folder.write("summary.json", |out| out.write_all(json.as_bytes()))
    }

    /// The page of one motion: the design as drawn, with the bands beside its curves.
    fn page(&self, analysis: &Analysis<'_>, motion: usize, facts: &ToleranceFacts) -> Option<String> {
        let mut file = self.studied.file.clone();
        file.model = Model::clone(analysis.model());
        let today = analysis.run();
        if today.motion.is_empty() {
            return None;
        }
        let course = Course::of(&file.model, &today);
        let mut summary = Summary::new(&file, analysis.topology(), &course);
        summary.diagnostics = diagnose::all(&file, &summary, &course, None);
        let request = Request::of(&file, analysis, &course, &summary);
        let outputs = &today.measured.outputs;
        let finish = |page| self.studied.page(facts, motion, page, outputs);
        Some(report(&request, &finish).expect("a payload is plain data"))
    }
}

fn facts_text(facts: &ToleranceFacts) -> String {
    let mut rows = facts.rows();
    rows.push(("time taken", facts.time_line()));
    let mut out = format!("\n{}", text::pairs(&rows));
    for table in facts.tables() {
        out += &format!("\n{}", text::table(&table));
    }
    out
}
