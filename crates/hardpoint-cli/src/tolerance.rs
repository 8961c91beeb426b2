//! `hardpoint tolerance`.

use std::io::Write;
use std::num::NonZero;

use hardpoint::Solution;
use hardpoint::model::Model;
use hardpoint_file::ModelFile;
use hardpoint_report::tolerance::{ToleranceFacts, ToleranceInputs, nominal_stop};
use hardpoint_study::tolerance::{Error, Overrides, Request, ToleranceResult, tolerance};
use hardpoint_study::{Control, Motions, Progress, Step};

use crate::args::{Allocate, Tolerance};
use crate::folder::{Folder, WriteError};
use crate::outcome::Outcome;
use crate::pages::{Study, page, threads};
use crate::session::{Session, json_text};
use crate::text;

/// Studies the tolerances of a model, writes the results, and prints a summary.
pub fn run(options: &Tolerance) -> Outcome {
    let session = Session::begin(options.common.json);
    session.end(tolerance_in(&session, options))
}

pub fn tolerance_in(session: &Session, options: &Tolerance) -> Result<Outcome, Outcome> {
    let file = session.read(&options.common.model)?;
    let numbers = session.numbers_of(&file, &options.motions)?;
    let overrides = overrides(options.samples, options.seed, options.allocate);
    let request = Request::of(&file.model, &overrides).map_err(|e| session.refused(&file, &e))?;
    let models = file.model.motions();
    let models: Vec<Model> = numbers.iter().map(|k| models[*k].clone()).collect();
    let motions = Motions::of(&models, options.common.formulation());
    let motions = motions.map_err(|(_, fault)| session.cannot_be_driven(&file, &fault))?;
    let folder = session.folder(options.output.as_deref())?;

    session.patient(true);
    let found = examine(session, &file, &motions, &numbers, &request, options.threads)?;
    let studied = ToleranceInputs { file: &file, numbers: &numbers, asked: &request.settings, found: &found };
    let mut results = Results::of(session, studied, &motions);
    if let Some(mut folder) = folder {
        results.write(&mut folder).map_err(|e| session.not_written(&e))?;
        folder.commit(&FILES).map_err(|e| session.not_written(&e))?;
    }
    let facts = &results.facts;
    if session.is_json() {
        session.print_json(facts);
    } else {
        text::print(&format!(
            "{}\n{}",
            text::bold(&file.model.name),
            text::study(facts.rows(), facts.seconds, &facts.tables())
        ));
        text::print(&text::written(&facts.files));
    }
    Ok(if found.interrupted { Outcome::Interrupted } else { Outcome::Done })
}

/// Result files; the summary is written last and marks them as complete.
const FILES: [&str; 5] = ["metrics.csv", "contributions.csv", "bands.csv", "samples.csv", "summary.json"];

/// Options that override those of the file.
pub fn overrides(samples: Option<u32>, seed: Option<u32>, allocate: Option<Allocate>) -> Overrides {
    Overrides {
        samples: samples.map(|n| n as usize),
        seed: seed.map(u64::from),
        allocate: allocate.map(Allocate::rule),
    }
}

/// Runs the study with progress.
pub fn examine(
    session: &Session,
    file: &ModelFile,
    motions: &Motions<'_>,
    numbers: &[usize],
    request: &Request,
    most_threads: Option<NonZero<usize>>,
) -> Result<ToleranceResult, Outcome> {
    let mut derivatives = session.meter("differentiating", "variables");
    let mut designs = session.meter("solving", "designs");
    let mut progress = |Progress { step, done, total, .. }: Progress<'_>| {
        match step {
            Step::Variable => derivatives.show(done, total),
            Step::Designs => designs.show(done, total),
            Step::Iteration(_) | Step::Search(..) | Step::FrontPoint | Step::Fit(_) => {}
        }
        session.go_on()
    };
    let more = || session.go_on().is_continue();
    let control = Control { threads: threads(most_threads), progress: &mut progress, more: &more };
    tolerance(&file.model, motions, numbers, request, control).map_err(|error| match error {
        Error::Nominal(stopped) if stopped.interrupted() => {
            session.misunderstood("interrupted before the nominal design was solved");
            Outcome::Interrupted
        }
        Error::Nominal(stopped) => {
            let (of_motion, diagnostic) = nominal_stop(file, motions, numbers, &stopped);
            session.fail(&of_motion, &[diagnostic]);
            Outcome::Stopped
        }
        Error::Request(error) => session.refused(file, &error),
    })
}

/// A finished study.
pub struct Results<'a> {
    studied: ToleranceInputs<'a>,
    motions: &'a Motions<'a>,
    /// Facts of the result.
    pub facts: ToleranceFacts,
}

impl<'a> Results<'a> {
    /// Creates the result of a finished study.
    pub fn of(session: &Session, studied: ToleranceInputs<'a>, motions: &'a Motions<'a>) -> Self {
        let mut facts = ToleranceFacts::of(&studied);
        facts.seconds = session.seconds();
        Self { studied, motions, facts }
    }

    /// Writes tables, a page for each motion, and the summary last.
    fn write(&mut self, folder: &mut Folder) -> Result<(), WriteError> {
        let pages = self.write_pages(folder)?;
        self.facts.files.extend(pages);
        let studied = &self.studied;
        let ToleranceInputs { file, asked, found, .. } = *studied;
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
        self.facts.files.extend(names.iter().map(|name| folder.path_of(name).display().to_string()));
        let json = json_text(&self.facts);
        folder.write("summary.json", |out| out.write_all(json.as_bytes()))
    }
}

impl Study for Results<'_> {
    fn file(&self) -> &ModelFile {
        self.studied.file
    }

    fn motions(&self) -> &Motions<'_> {
        self.motions
    }

    fn number(&self, motion: usize) -> usize {
        self.studied.numbers[motion]
    }

    /// Page of the nominal design with the bands of its curves.
    fn page(&self, motion: usize) -> Option<String> {
        let finish =
            |page, today: &Solution| self.studied.page(&self.facts, motion, page, &today.measured.outputs);
        page(self.studied.file, &self.motions.analyses()[motion], None, finish)
    }
}
