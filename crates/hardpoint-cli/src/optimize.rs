//! `hardpoint optimize`.

use std::io::Write;
use std::num::NonZero;
use std::ops::ControlFlow;

use hardpoint::model::{Model, Optimization};
use hardpoint::study::{Motions, Optimized, Progress, Searching, optimize};
use hardpoint::{Analysis, Run};
use hardpoint_file::ModelFile;
use hardpoint_report::course::Course;
use hardpoint_report::diagnose;
use hardpoint_report::optimize::{OptimizeFacts, case_name, iteration_line, rounded, start_line};
use hardpoint_report::payload::{Changed, Request, report};
use hardpoint_report::summary::Summary;

use crate::args::Optimize;
use crate::folder::{Folder, NotWritten, file_name};
use crate::outcome::Outcome;
use crate::session::{Session, json_text};
use crate::text;

/// Searches for the best design, writes, and prints what was found.
pub fn run(options: &Optimize) -> Outcome {
    let session = Session::begin(options.common.json);
    optimize_in(&session, options).unwrap_or_else(|outcome| outcome)
}

fn optimize_in(session: &Session, options: &Optimize) -> Result<Outcome, Outcome> {
    let mut file = session.read(&options.common.model)?;
    if let Some(name) = &options.motions.case {
        let case = session.case(&file, name)?;
        file.model = file.model.with_case_only(case);
    }
    let asked = asked(session, &file, options)?;
    session.may_save(&options.common.model, options.save.as_deref())?;
    let models = file.model.motions();
    let motions = Motions::of(&models, options.common.formulation());
    let motions = motions.map_err(|(_, fault)| session.cannot_be_driven(&file, &fault))?;
    let path = options.output.as_ref();
    let folder = path.map(|path| Folder::open(path)).transpose().map_err(|e| session.not_written(&e))?;

    session.patient(true);
    let found = search(session, &file, &motions, &asked, options);
    let mut facts = OptimizeFacts::of(&file, &asked, &found);
    facts.seconds = session.seconds();
    let best = found.best.and_then(|k| found.searches[k].found.as_ref());

    let mut saved = None;
    if let (Some(to), Some(best)) = (&options.save, best) {
        session.save(&file, &rounded(&file, &asked, &best.design), to)?;
        facts.files.push(to.display().to_string());
        saved = Some(to);
    }
    let mut written = None;
    if let (Some(mut folder), Some(best)) = (folder, best) {
        let study = Study { file: &file, motions: &motions, design: &best.design };
        let result = study.write(&mut folder, &mut facts);
        written = Some(folder.path_of("summary.json"));
        result.and_then(|()| folder.commit(&[])).map_err(|e| session.not_written(&e))?;
    }
    if session.is_json() {
        session.print_json(&facts);
    } else {
        text::print(&facts_text(&facts));
        let written = written.map_or(String::new(), |path| format!("\nwritten: {}\n", path.display()));
        text::print(&written);
        text::print(&saved.map_or(String::new(), |path| format!("saved: {}\n", path.display())));
    }
    Ok(match facts.status {
        "interrupted" => Outcome::Interrupted,
        "no_start" => Outcome::Stopped,
        "optimal" => Outcome::Done,
        _ => Outcome::FellShort,
    })
}

/// What is asked for, by the file and by the command line.
fn asked(session: &Session, file: &ModelFile, options: &Optimize) -> Result<Optimization, Outcome> {
    let Some(asked) = &file.model.optimization else {
        let why = format!(
            "`{}` does not say what to optimise; add `[optimize.goals]` with the metrics that are to be small, and `bounds` to the \
             design variables that may change (docs/file-format.md)",
            file.file_name()
        );
        return Err(session.misunderstood(&why));
    };
    if let Some(case) = options.motions.case.as_ref().filter(|_| asked.goals.is_empty()) {
        let why = format!("`--case {case}`: no goal of `[optimize]` is of this case; leave `--case` out");
        return Err(session.misunderstood(&why));
    }
    let mut asked = asked.clone();
    asked.starts = options.starts.map_or(asked.starts, NonZero::get);
    asked.iterations = options.iterations.map_or(asked.iterations, NonZero::get);
    Ok(asked)
}

/// Searches, telling of every iteration; of several searches, of the end of each.
fn search(
    session: &Session,
    file: &ModelFile,
    motions: &Motions<'_>,
    asked: &Optimization,
    options: &Optimize,
) -> Optimized {
    let (model, units) = (&file.model, file.units);
    let many = asked.starts > 1;
    if !session.is_json() {
        text::print(&format!("{}\n", text::bold(&model.name)));
    }
    let mut progress = |k: usize, told: Progress<'_>| {
        let line = match told {
            Progress::Iteration(iteration) if !many => Some(iteration_line(model, units, iteration)),
            Progress::End(search) if many => Some(start_line(k, search)),
            _ => None,
        };
        if let Some(line) = line.filter(|_| !session.is_json()) {
            text::print(&format!("{line}\n"));
        }
        session.go_on()
    };
    let threads = options.threads.or_else(|| std::thread::available_parallelism().ok());
    let searching = Searching {
        progress: &mut progress,
        more: &|| session.go_on() == ControlFlow::Continue(()),
        threads: threads.unwrap_or(NonZero::<usize>::MIN),
    };
    optimize(model, motions, asked, searching)
}

/// What is written.
struct Study<'a> {
    file: &'a ModelFile,
    motions: &'a Motions<'a>,
    design: &'a [f64],
}

impl Study<'_> {
    /// A page for each motion, and the summary last.
    fn write(&self, folder: &mut Folder, facts: &mut OptimizeFacts) -> Result<(), NotWritten> {
        for (k, analysis) in self.motions.analyses().iter().enumerate() {
            let name = match case_name(&self.file.model, k) {
                Some(case) => format!("report-{}.html", file_name(&case)),
                None => "report.html".into(),
            };
            let Some(html) = self.page(analysis, facts) else { continue };
            folder.write(&name, |out| out.write_all(html.as_bytes()))?;
            facts.files.push(folder.path_of(&name).display().to_string());
        }
        facts.files.push(folder.path_of("summary.json").display().to_string());
        let json = json_text(facts);
        folder.write("summary.json", |out| out.write_all(json.as_bytes()))
    }

    /// The page of one motion: the design found beside the one as drawn; `None` where that does not move at all.
    fn page(&self, analysis: &Analysis<'_>, facts: &OptimizeFacts) -> Option<String> {
        let mut file = self.file.clone();
        file.model = Model::clone(analysis.model());
        let today = analysis.run();
        if today.motion.is_empty() {
            return None;
        }
        let exact = analysis.solve(Run::new().at(self.design).without_sensitivities());
        let course = Course::of(&file.model, &today);
        let mut summary = Summary::new(&file, analysis.topology(), &course);
        summary.diagnostics = diagnose::all(&file, &summary, &course, None);
        let changed = Changed {
            name: "found".into(),
            note: "The design that the search found.".into(),
            change: self.design,
            today: &today,
            exact: &exact,
            foreseen: None,
        };
        let request = Request { changed: Some(changed), ..Request::of(&file, analysis, &course, &summary) };
        Some(
            report(&request, &|page| facts.page(page, &file.model, &today.measured.outputs))
                .expect("a payload is plain data"),
        )
    }
}

fn facts_text(facts: &OptimizeFacts) -> String {
    let mut rows = facts.rows();
    rows.push(("time taken", facts.time_line()));
    let mut out = format!("\n{}", text::pairs(&rows));
    for table in facts.tables() {
        out += &format!("\n{}", text::table(&table));
    }
    out
}
