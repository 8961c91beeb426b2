//! `hardpoint optimize`.

use std::io::Write;
use std::num::NonZero;
use std::path::Path;

use hardpoint::Solution;
use hardpoint::model::{Model, OptimizationSettings};
use hardpoint::topology::Formulation;
use hardpoint_file::{Diagnostic, Diagnostics, ModelFile};
use hardpoint_report::optimize::{OptimizeFacts, file_of_variant, placed, progress_line, to_save};
use hardpoint_study::optimize::{
    DesignAssessment, FailedDesign, Optimization, Overrides, Request, judge, optimize,
};
use hardpoint_study::{Control, Motions, Progress};

use crate::args::Optimize;
use crate::folder::{Folder, WriteError};
use crate::outcome::Outcome;
use crate::pages::{FoundDesign, Study, page, threads};
use crate::session::{Session, json_text};
use crate::text;

/// Optimises the design, writes the results and prints a summary.
pub fn run(options: &Optimize) -> Outcome {
    let session = Session::begin(options.common.json);
    session.end(optimize_in(&session, options))
}

pub fn optimize_in(session: &Session, options: &Optimize) -> Result<Outcome, Outcome> {
    let mut file = session.read(&options.common.model)?;
    session.keep_case(&mut file, options.motions.case.as_deref())?;
    let [starts, iterations] = [options.starts, options.iterations].map(|n| n.map(NonZero::get));
    let [other_assemblies, both_senses] =
        [options.other_assemblies, options.both_senses].map(|asked| asked.then_some(true));
    let overrides = Overrides { starts, iterations, other_assemblies, both_senses, ..Overrides::default() };
    let request = Request::of(&file.model, overrides).map_err(|e| session.refused(&file, &e))?;
    session.may_save(&options.common.model, options.save.as_deref())?;
    session.can_save(&file, &request.settings.variables, options.save.as_deref())?;
    let models = file.model.motions();
    let motions = Motions::of(&models, options.common.formulation());
    let motions = motions.map_err(|(_, fault)| session.cannot_be_driven(&file, &fault))?;
    let folder = session.folder(options.output.as_deref())?;

    session.patient(true);
    let mut search = Search::run(session, &file, &motions, &request, options.threads);
    if let Some(wanted) = options.optimum {
        search.choose(wanted.get()).map_err(|why| {
            session.remark(&why);
            Outcome::FellShort
        })?;
    }

    let mut saved = Ok(None);
    if let (Some(to), Some(design)) = (&options.save, search.to_save()) {
        match search.file_to_save(&design).and_then(|file| session.save_result(&file, &design, to)) {
            Ok(()) => {
                search.facts.files.push(to.display().to_string());
                let (case, formulation) = (options.motions.case.as_deref(), options.common.formulation());
                let judged = judged_as_written(to, case, formulation, |model, motions| {
                    let wanted = model.optimization.as_ref().unwrap_or(&request.settings);
                    judge(model, motions, wanted, &[])
                });
                search.facts.check_saved(&to.display().to_string(), judged, &request.settings);
                saved = Ok(Some(to));
            }
            Err((diagnostics, why, outcome)) => {
                search.facts.not_saved(&why);
                search.facts.diagnostics.extend(diagnostics);
                saved = Err(outcome);
            }
        }
    }
    let unwritten = search.facts.files.len();
    if let Some(mut folder) = folder.filter(|_| search.best().is_some()) {
        let result = search.write(&mut folder);
        result.and_then(|()| folder.commit(&[])).map_err(|e| session.not_written(&e))?;
    }
    let facts = &search.facts;
    if session.is_json() {
        session.print_json(facts);
    } else {
        text::print(&text::study(facts.rows(), facts.seconds, &facts.tables()));
        text::print(&text::written(&facts.files[unwritten..]));
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
pub fn judged_as_written(
    to: &Path,
    case: Option<&str>,
    formulation: Formulation,
    judge: impl FnOnce(&Model, &Motions<'_>) -> Result<DesignAssessment, FailedDesign>,
) -> Result<DesignAssessment, String> {
    let mut file = hardpoint_file::read(to).map_err(|error| {
        let first = error.diagnostics().list().first().map_or(String::new(), |d| d.message.clone());
        format!("it cannot be read again: {first}")
    })?;
    if let Some(case) = case.and_then(|name| file.model.case(name)) {
        file.model = file.model.with_case_only(case);
    }
    let models = file.model.motions();
    let motions =
        Motions::of(&models, formulation).map_err(|(_, fault)| format!("it cannot be driven: {fault}"))?;
    judge(&file.model, &motions).map_err(|failed| failed.why)
}

/// A finished search.
pub struct Search<'a> {
    file: &'a ModelFile,
    motions: &'a Motions<'a>,
    asked: &'a OptimizationSettings,
    found: Optimization,
    /// The file and its motions in the assembly and sense of the result, if these are not those of the file; or why the
    /// file cannot have them.
    varied: Option<Result<(ModelFile, Motions<'static>), Diagnostics>>,
    /// Facts of the result.
    pub facts: OptimizeFacts,
}

impl<'a> Search<'a> {
    /// Searches and reports every iteration; of several searches, the end of each.
    pub fn run(
        session: &Session,
        file: &'a ModelFile,
        motions: &'a Motions<'a>,
        request: &'a Request,
        most_threads: Option<NonZero<usize>>,
    ) -> Self {
        let (model, units, asked) = (&file.model, file.units, &request.settings);
        session.line(&text::bold(&model.name));
        let mut progress = |progress: Progress<'_>| {
            progress_line(model, units, &progress).iter().for_each(|line| session.line(line));
            session.go_on()
        };
        let more = || session.go_on().is_continue();
        let control = Control { threads: threads(most_threads), progress: &mut progress, more: &more };
        let found = optimize(model, motions, request, control);
        let mut facts = OptimizeFacts::of(file, asked, &found);
        facts.seconds = session.seconds();
        let mut search = Self { file, motions, asked, found, varied: None, facts };
        search.vary();
        search
    }

    /// Prepares the file in the assembly and sense of the result.
    fn vary(&mut self) {
        let variant = self.found.best.map(|k| &self.found.variants[self.found.searches[k].variant]);
        self.varied = variant.filter(|variant| !variant.is_own()).map(|variant| {
            file_of_variant(self.file, variant, self.motions.analyses()[0].topology().formulation)
        });
    }

    /// The file to save a design in: in another assembly with the placements of that design.
    pub fn file_to_save(&self, design: &[f64]) -> Result<ModelFile, (Vec<Diagnostic>, String, Outcome)> {
        let failed = |found: &Diagnostics| {
            let why = found.list().first().map_or(String::new(), |d| d.message.clone());
            (found.list().to_vec(), why, Outcome::Misunderstood)
        };
        match &self.varied {
            None => Ok(self.file.clone()),
            Some(Err(found)) => Err(failed(found)),
            Some(Ok((file, motions))) => placed(file, motions, design).map_err(|found| failed(&found)),
        }
    }

    /// Makes another of the distinct optima the result, counted from 1.
    fn choose(&mut self, wanted: usize) -> Result<(), String> {
        let optima = self.found.optima(&self.file.model, self.asked);
        let Some(searches) = optima.get(wanted - 1) else {
            return Err(match optima.len() {
                0 => "`--optimum`: no start ended in an optimum".into(),
                n => format!(
                    "`--optimum {wanted}`: the starts ended in {n} distinct optima; try more `--starts`"
                ),
            });
        };
        self.found.best = Some(searches[0]);
        self.vary();
        let seconds = self.facts.seconds;
        self.facts = OptimizeFacts { seconds, ..OptimizeFacts::of(self.file, self.asked, &self.found) };
        Ok(())
    }

    /// Best design, if a position of any design could be solved.
    fn best(&self) -> Option<&[f64]> {
        self.found.best.and_then(|k| Some(&*self.found.searches[k].found.as_ref()?.design))
    }

    /// Best design with its variables rounded to few digits in the file's units, as long as the motion stays the same.
    pub fn to_save(&self) -> Option<Vec<f64>> {
        Some(to_save(self.file(), self.motions(), self.asked, self.best()?))
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
        match &self.varied {
            Some(Ok((file, _))) => file,
            Some(Err(_)) | None => self.file,
        }
    }

    fn motions(&self) -> &Motions<'_> {
        match &self.varied {
            Some(Ok((_, motions))) => motions,
            Some(Err(_)) | None => self.motions,
        }
    }

    fn number(&self, motion: usize) -> usize {
        motion
    }

    fn page(&self, motion: usize) -> Option<String> {
        let found = FoundDesign { design: self.best()?, note: "The optimised design." };
        let analysis = &self.motions().analyses()[motion];
        let finish =
            |page, today: &Solution| self.facts.page(page, analysis.model(), &today.measured.outputs);
        page(self.file(), analysis, Some(&found), finish)
    }
}
