//! `hardpoint optimize`.

use std::io::Write;
use std::num::NonZero;
use std::ops::ControlFlow;
use std::path::Path;

use hardpoint::Solution;
use hardpoint::model::OptimizationSettings;
use hardpoint_file::ModelFile;
use hardpoint_report::optimize::{OptimizeFacts, iteration_line, start_line, to_save};
use hardpoint_study::Motions;
use hardpoint_study::optimize::{
    DesignAssessment, OptimizationRequest, OptimizationResult, SearchProgress, judge, optimize,
};

use crate::args::Optimize;
use crate::folder::{Folder, WriteError};
use crate::outcome::Outcome;
use crate::pages::{FoundDesign, Study, page, threads};
use crate::session::{Session, json_text};
use crate::text;

/// Optimises the design, writes the results and prints a summary.
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
    let [starts, iterations] = [options.starts, options.iterations].map(|n| n.map(NonZero::get));
    let asked = asked(session, &file, options.motions.case.as_deref(), [starts, iterations])?;
    session.may_save(&options.common.model, options.save.as_deref())?;
    session.can_save(&file, &asked.variables, options.save.as_deref())?;
    let models = file.model.motions();
    let motions = Motions::of(&models, options.common.formulation());
    let motions = motions.map_err(|(_, fault)| session.cannot_be_driven(&file, &fault))?;
    let folder = session.folder(options.output.as_deref())?;

    session.patient(true);
    let mut search = Search::run(session, &file, &motions, &asked, options.threads);

    let mut saved = Ok(None);
    if let (Some(to), Some(design)) = (&options.save, search.to_save()) {
        match session.save_result(&file, &design, to) {
            Ok(()) => {
                search.facts.files.push(to.display().to_string());
                let judged = judged_as_written(to, options, &asked);
                search.facts.check_saved(&to.display().to_string(), judged, asked.margin);
                saved = Ok(Some(to));
            }
            Err((diagnostics, why, outcome)) => {
                search.facts.not_saved(&why);
                search.facts.diagnostics.extend(diagnostics);
                saved = Err(outcome);
            }
        }
    }
    let mut written = None;
    if let Some(mut folder) = folder.filter(|_| search.best().is_some()) {
        let result = search.write(&mut folder);
        written = Some(folder.path_of("summary.json"));
        result.and_then(|()| folder.commit(&[])).map_err(|e| session.not_written(&e))?;
    }
    let facts = &search.facts;
    if session.is_json() {
        session.print_json(facts);
    } else {
        text::print(&facts_text(facts));
        let written = written.map_or(String::new(), |path| format!("\nwritten: {}\n", path.display()));
        text::print(&written);
        session.tell(&file, &facts.diagnostics);
        text::print(
            &saved.ok().flatten().map_or(String::new(), |path| format!("saved: {}\n", path.display())),
        );
    }
    saved?;
    Ok(match facts.status {
        "interrupted" => Outcome::Interrupted,
        "no_start" => Outcome::Stopped,
        "optimal" => Outcome::Done,
        _ => Outcome::FellShort,
    })
}

/// Reads a saved file and solves its design again.
fn judged_as_written(
    to: &Path,
    options: &Optimize,
    asked: &OptimizationSettings,
) -> Result<DesignAssessment, String> {
    let mut file = hardpoint_file::read(to).map_err(|error| {
        let first = error.diagnostics().list().first().map_or(String::new(), |d| d.message.clone());
        format!("it cannot be read again: {first}")
    })?;
    if let Some(case) = options.motions.case.as_ref().and_then(|name| file.model.case(name)) {
        file.model = file.model.with_case_only(case);
    }
    let models = file.model.motions();
    let motions = Motions::of(&models, options.common.formulation())
        .map_err(|(_, fault)| format!("it cannot be driven: {fault}"))?;
    let wanted = file.model.optimization.as_ref().unwrap_or(asked);
    judge(&file.model, &motions, wanted, &[]).map_err(|refused| refused.why)
}

/// Settings from the file, overridden by options: a single case, the number of starts and iterations.
pub fn asked(
    session: &Session,
    file: &ModelFile,
    case: Option<&str>,
    [starts, iterations]: [Option<usize>; 2],
) -> Result<OptimizationSettings, Outcome> {
    let Some(asked) = &file.model.optimization else {
        let why = format!(
            "`{}` has no `[optimize]` table; add `[optimize.goals]` with the metrics to minimise, and `bounds` to the \
             design variables that may change (docs/file-format.md)",
            file.file_name()
        );
        return Err(session.misunderstood(&why));
    };
    if let Some(case) = case.filter(|_| asked.goals.is_empty()) {
        let why = format!("`--case {case}`: `[optimize]` has no goal in this case; leave `--case` out");
        return Err(session.misunderstood(&why));
    }
    let mut asked = asked.clone();
    asked.starts = starts.unwrap_or(asked.starts);
    asked.iterations = iterations.unwrap_or(asked.iterations);
    Ok(asked)
}

/// A finished search.
pub struct Search<'a> {
    file: &'a ModelFile,
    motions: &'a Motions<'a>,
    asked: &'a OptimizationSettings,
    found: OptimizationResult,
    /// Facts of the result.
    pub facts: OptimizeFacts,
}

impl<'a> Search<'a> {
    /// Searches and reports every iteration; of several searches, the end of each.
    pub fn run(
        session: &Session,
        file: &'a ModelFile,
        motions: &'a Motions<'a>,
        asked: &'a OptimizationSettings,
        most_threads: Option<NonZero<usize>>,
    ) -> Self {
        let (model, units) = (&file.model, file.units);
        let many = asked.starts > 1;
        session.line(&text::bold(&model.name));
        let mut progress = |k: usize, event: SearchProgress<'_>| {
            let line = match event {
                SearchProgress::Iteration(iteration) if !many => {
                    Some(iteration_line(model, units, iteration))
                }
                SearchProgress::End(search) if many => Some(start_line(k, search)),
                _ => None,
            };
            line.iter().for_each(|line| session.line(line));
            session.go_on()
        };
        let searching = OptimizationRequest {
            progress: &mut progress,
            more: &|| session.go_on() == ControlFlow::Continue(()),
            threads: threads(most_threads),
            first: 0,
        };
        let found = optimize(model, motions, asked, searching);
        let mut facts = OptimizeFacts::of(file, asked, &found);
        facts.seconds = session.seconds();
        Self { file, motions, asked, found, facts }
    }

    /// Best design, if a position of any design could be solved.
    fn best(&self) -> Option<&[f64]> {
        self.found.best.and_then(|k| Some(&*self.found.searches[k].found.as_ref()?.design))
    }

    /// Best design with its variables rounded to few digits in the file's units, as long as the motion stays the same.
    pub fn to_save(&self) -> Option<Vec<f64>> {
        Some(to_save(self.file, self.motions, self.asked, self.best()?))
    }

    /// Writes a page for each motion, and the summary last.
    fn write(&mut self, folder: &mut Folder) -> Result<(), WriteError> {
        let pages = self.write_pages(folder)?;
        self.facts.files.extend(pages);
        self.facts.files.push(folder.path_of("summary.json").display().to_string());
        let json = json_text(&self.facts);
        folder.write("summary.json", |out| out.write_all(json.as_bytes()))
    }
}

impl Study for Search<'_> {
    fn file(&self) -> &ModelFile {
        self.file
    }

    fn motions(&self) -> &Motions<'_> {
        self.motions
    }

    fn number(&self, motion: usize) -> usize {
        motion
    }

    fn page(&self, motion: usize) -> Option<String> {
        let found = FoundDesign { design: self.best()?, note: "The optimised design." };
        let analysis = &self.motions.analyses()[motion];
        let finish =
            |page, today: &Solution| self.facts.page(page, analysis.model(), &today.measured.outputs);
        page(self.file, analysis, Some(&found), finish)
    }
}

fn facts_text(facts: &OptimizeFacts) -> String {
    let mut rows = facts.rows();
    rows.push(("time taken", facts.time_line()));
    let mut out = format!("\n{}", text::pairs(&rows));
    for table in facts.tables() {
        out += &text::section(&table);
    }
    out
}
