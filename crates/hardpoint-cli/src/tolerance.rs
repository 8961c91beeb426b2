//! `hardpoint tolerance`.

use std::io::Write;
use std::num::NonZero;

use hardpoint::Solution;
use hardpoint::model::{AllocationRule, AllocationSettings, LimitTarget, Model, ToleranceSettings};
use hardpoint_file::ModelFile;
use hardpoint_report::diagnose;
use hardpoint_report::figures::some_of;
use hardpoint_report::optimize::case_name;
use hardpoint_report::tolerance::{ToleranceFacts, ToleranceInputs};
use hardpoint_study::Motions;
use hardpoint_study::tolerance::{ToleranceError, ToleranceResult, ToleranceStage, tolerance};

use crate::args::{Allocate, Tolerance};
use crate::folder::{Folder, WriteError};
use crate::outcome::Outcome;
use crate::pages::{Study, page, threads};
use crate::session::{Session, json_text};
use crate::text;

/// Studies the tolerances of a model, writes the results, and prints a summary.
pub fn run(options: &Tolerance) -> Outcome {
    let session = Session::begin(options.common.json);
    tolerance_in(&session, options).unwrap_or_else(|outcome| outcome)
}

fn tolerance_in(session: &Session, options: &Tolerance) -> Result<Outcome, Outcome> {
    let file = session.read(&options.common.model)?;
    let numbers = session.numbers_of(&file, &options.motions)?;
    let asking =
        ToleranceOverrides { samples: options.samples, seed: options.seed, allocate: options.allocate };
    let asked = asked(session, &file, &asking)?;
    let models = file.model.motions();
    let models: Vec<Model> = numbers.iter().map(|k| models[*k].clone()).collect();
    let motions = Motions::of(&models, options.common.formulation());
    let motions = motions.map_err(|(_, fault)| session.cannot_be_driven(&file, &fault))?;
    let folder = session.folder(options.output.as_deref())?;

    session.patient(true);
    let found = examine(session, &file, &motions, &numbers, &asked, options.threads)?;
    let studied = ToleranceInputs { file: &file, numbers: &numbers, asked: &asked, found: &found };
    let mut results = Results::of(session, studied, &motions);
    let mut written = None;
    if let Some(mut folder) = folder {
        results.write(&mut folder).map_err(|e| session.not_written(&e))?;
        written = Some(folder.path_of("summary.json"));
        folder.commit(&FILES).map_err(|e| session.not_written(&e))?;
    }
    let facts = &results.facts;
    if session.is_json() {
        session.print_json(facts);
    } else {
        text::print(&format!("{}\n{}", text::bold(&file.model.name), facts_text(facts)));
        text::print(&written.map_or(String::new(), |path| format!("\nwritten: {}\n", path.display())));
    }
    Ok(if found.interrupted { Outcome::Interrupted } else { Outcome::Done })
}

/// Result files; the summary is written last and marks them as complete.
const FILES: [&str; 5] = ["metrics.csv", "contributions.csv", "bands.csv", "samples.csv", "summary.json"];

/// Options that override the file.
#[derive(Default)]
pub struct ToleranceOverrides {
    /// Number of Monte Carlo designs.
    pub samples: Option<u32>,
    /// Seed of the random numbers.
    pub seed: Option<u32>,
    /// Rule of the allocation of the loosest tolerances.
    pub allocate: Option<Allocate>,
}

/// Settings from the file, overridden by options.
pub fn asked(
    session: &Session,
    file: &ModelFile,
    options: &ToleranceOverrides,
) -> Result<ToleranceSettings, Outcome> {
    let asked = file.model.tolerancing.clone().or_else(|| ToleranceSettings::of_variables(&file.model));
    let Some(mut asked) = asked else {
        let why = format!(
            "the design variables of `{}` have no tolerances; add `tolerance = 0.1` to some in `[design]` or \
             `[parameters]` (docs/tolerance.md)",
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
            (Allocate::Rss, _) => AllocationRule::Rss { sigmas: ToleranceSettings::SIGMAS },
            (Allocate::WorstCase, _) => AllocationRule::Worst,
        };
        asked.allocation = Some(AllocationSettings { rule });
    }
    if asked.metrics.is_empty() && asked.curves.is_empty() && !has_metric_limits(&asked) {
        let why = format!("`{}` has neither metrics nor measures to analyse", file.file_name());
        return Err(session.misunderstood(&why));
    }
    Ok(asked)
}

fn has_metric_limits(asked: &ToleranceSettings) -> bool {
    asked.limits.iter().any(|limit| matches!(limit.of, LimitTarget::Metric(_)))
}

/// Runs the study with progress.
pub fn examine(
    session: &Session,
    file: &ModelFile,
    motions: &Motions<'_>,
    numbers: &[usize],
    asked: &ToleranceSettings,
    most_threads: Option<NonZero<usize>>,
) -> Result<ToleranceResult, Outcome> {
    let mut derivatives = session.meter("differentiating", "variables");
    let mut designs = session.meter("solving", "designs");
    let mut tell = |stage: ToleranceStage| {
        match stage {
            ToleranceStage::Derivatives(done, of) => derivatives.show(done, of),
            ToleranceStage::Designs(done, of) => designs.show(done, of),
        }
        session.go_on()
    };
    let more = || session.go_on().is_continue();
    let found = tolerance(&file.model, motions, numbers, asked, threads(most_threads), &mut tell, &more);
    found.map_err(|failure| match failure {
        ToleranceError::Nominal(rejection) if rejection.interrupted() => {
            session.misunderstood("interrupted before the nominal design was solved");
            Outcome::Interrupted
        }
        ToleranceError::Nominal(rejection) => {
            let mut one = file.clone();
            one.model = Model::clone(motions.model(rejection.motion));
            let mut diagnostic = diagnose::stop(&one, &rejection.stop, 0, None);
            if let Some(case) = case_name(&file.model, numbers[rejection.motion]) {
                diagnostic.message = format!("case `{case}`: {}", diagnostic.message);
            }
            session.fail(&one, &[diagnostic]);
            Outcome::Stopped
        }
        ToleranceError::NothingVaries => {
            let names: Vec<&str> = asked.tolerances.iter().map(|t| t.name.as_str()).collect();
            session.misunderstood(&format!(
                "none of the variables with a tolerance is admissible: {}",
                some_of(&names, ", ")
            ))
        }
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

fn facts_text(facts: &ToleranceFacts) -> String {
    let mut rows = facts.rows();
    rows.push(("time taken", facts.time_line()));
    let mut out = format!("\n{}", text::pairs(&rows));
    for table in facts.tables() {
        out += &text::section(&table);
    }
    out
}
