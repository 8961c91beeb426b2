//! `hardpoint synthesize`.

use std::io::Write;
use std::num::NonZero;
use std::path::Path;

use hardpoint::topology::Formulation;
use hardpoint_file::{ModelFile, TaskFile};
use hardpoint_report::gallery::{Card, gallery};
use hardpoint_report::synthesis::{
    AnswerFact, SynthesisFacts, followed_model, model_text, picture, refusal, task_of,
};
use hardpoint_study::synthesis::{Answer, synthesize};

use crate::args::Synthesize;
use crate::folder::{Folder, WriteError};
use crate::outcome::Outcome;
use crate::pages::Page;
use crate::session::{Session, json_text};
use crate::{run, text};

/// Model of an answer, and its page.
const MODEL: &str = "model.toml";
const PAGE: &str = "report.html";
/// Answers of earlier syntheses up to this number are removed.
const MOST: usize = 100;

/// Finds linkages for a task, and writes the models and pages of the answers.
pub fn run(options: &Synthesize) -> Outcome {
    let session = Session::begin(options.json);
    session.end(synthesize_in(&session, options))
}

pub fn synthesize_in(session: &Session, options: &Synthesize) -> Result<Outcome, Outcome> {
    let file = TaskFile::read(&options.task).map_err(|error| {
        session.not_read(error.diagnostics());
        Outcome::BadModel
    })?;
    let folder = session.folder(options.output.as_deref())?;
    session.line(&text::bold(&file.name));
    session.patient(true);
    let mut found = linkages_of(session, &file, options.answers)?;
    if let Some(folder) = folder.filter(|_| !found.facts.is_interrupted()) {
        match write(session, &file, &mut found, folder) {
            Err(Outcome::Interrupted) => found.facts.interrupt(),
            written => written?,
        }
    }
    let mut facts = found.facts;
    facts.seconds = session.seconds();
    if session.is_json() {
        session.print_json(&facts);
    } else {
        text::print(&text::study(facts.rows(), facts.seconds, &facts.tables()));
        if let Some((why, help)) = facts.advice() {
            text::print(&format!("\n{why}\n  {help}\n"));
        }
        let index = facts.files.first().map_or(String::new(), |path| format!("\nwritten: {path}\n"));
        text::print(&index);
    }
    Ok(match (facts.is_interrupted(), facts.answers.is_empty()) {
        (true, _) => Outcome::Interrupted,
        (false, true) => Outcome::FellShort,
        (false, false) => Outcome::Done,
    })
}

/// Linkages of a task that the engine has followed.
pub struct SynthesizedLinkages {
    pub facts: SynthesisFacts,
    answers: Vec<Answer>,
    /// Text and model of each answer.
    models: Vec<(String, ModelFile)>,
}

/// Finds the linkages of a task, and follows each with the engine.
pub fn linkages_of(
    session: &Session,
    file: &TaskFile,
    most: Option<NonZero<usize>>,
) -> Result<SynthesizedLinkages, Outcome> {
    let mut task = task_of(file);
    if let Some(answers) = most {
        task.answers = answers.get().min(MOST);
    }
    let found = {
        let _working = session.working("looking for linkages");
        synthesize(&task, &|| !session.interrupted())
    };
    let found = found.map_err(|error| {
        session.not_read(&refusal(file, &error));
        Outcome::BadModel
    })?;
    let mut facts = SynthesisFacts::of(file, &task, &found);
    let (mut answers, mut models) = (Vec::<Answer>::new(), Vec::<(String, ModelFile)>::new());
    let mut not_reproduced = 0;
    for answer in &found.answers {
        let rank = models.len() + 1;
        let content = model_text(file, answer, rank);
        let read = followed_model(answer, &content, &format!("{rank}/{MODEL}"), found.size);
        let (model, by_engine) = read.map_err(|diagnostics| {
            session.not_read(&diagnostics);
            Outcome::BadModel
        })?;
        match by_engine {
            Some(by_engine) => {
                facts.answers.push(AnswerFact::of(file.units, rank, answer, &by_engine));
                models.push((content, model));
                answers.push(answer.clone());
            }
            None => not_reproduced += 1,
        }
    }
    facts.leave_out(not_reproduced);
    Ok(SynthesizedLinkages { facts, answers, models })
}

impl SynthesizedLinkages {
    /// Pages of the answers, each with its rank and the kind of its linkage.
    pub fn pages(&self, session: &Session) -> Result<Vec<Page>, Outcome> {
        let page = |(fact, (_, model)): (&AnswerFact, &(String, ModelFile))| {
            let page = run::page(session, model, &[], Formulation::Relative)?;
            Ok((Some(format!("{}: {}", fact.rank, fact.kind)), page.html))
        };
        self.facts.answers.iter().zip(&self.models).map(page).collect()
    }
}

/// Writes models, pages, the table, and the summary last.
fn write(
    session: &Session,
    file: &TaskFile,
    found: &mut SynthesizedLinkages,
    mut folder: Folder,
) -> Result<(), Outcome> {
    let SynthesizedLinkages { facts, answers, models } = found;
    let mut meter = session.meter("making pages", "answers");
    let mut cards = Vec::new();
    for (k, (content, model)) in models.iter().enumerate() {
        let page = run::page(session, model, &[], Formulation::Relative)?;
        if session.interrupted() {
            return Err(Outcome::Interrupted);
        }
        let path = folder.path_of(&(k + 1).to_string());
        let parts = [(MODEL, content), (PAGE, &page.html)];
        write_answer(&path, &parts).map_err(|e| session.not_written(&e))?;
        let fact = &mut facts.answers[k];
        fact.model = Some(path.join(MODEL).display().to_string());
        fact.page = Some(path.join(PAGE).display().to_string());
        cards.push(Card {
            title: format!("{}: {}", k + 1, fact.kind),
            description: model.description.clone(),
            file: format!("{}/{MODEL}", k + 1),
            wrong: None,
            link: format!("{}/{PAGE}", k + 1),
            more: Vec::new(),
            picture: Some(picture(file, &answers[k])),
        });
        meter.show(k + 1, models.len());
    }
    drop(meter);
    let wrong = |e: WriteError| session.not_written(&e);
    for k in models.len() + 1..=MOST {
        let path = folder.path_of(&k.to_string());
        if path.join(MODEL).exists() {
            Folder::open(&path).and_then(|old| old.commit(&[MODEL, PAGE])).map_err(wrong)?;
        }
    }
    let lead: Vec<String> = facts.rows().into_iter().map(|(_, line)| line).collect();
    let index = gallery(&file.name, &lead.join(". "), None, &cards);
    folder.write("index.html", |out| out.write_all(index.as_bytes())).map_err(wrong)?;
    folder.write("answers.csv", |out| Ok(facts.write_answers(out, file.units)?)).map_err(wrong)?;
    let names = ["index.html", "answers.csv", "summary.json"];
    facts.files = names.iter().map(|name| folder.path_of(name).display().to_string()).collect();
    facts.seconds = session.seconds();
    let json = json_text(facts);
    folder.write("summary.json", |out| out.write_all(json.as_bytes())).map_err(wrong)?;
    folder.commit(&[]).map_err(wrong)
}

/// Writes the files of an answer into a folder of its own.
fn write_answer(path: &Path, parts: &[(&str, &String)]) -> Result<(), WriteError> {
    let mut folder = Folder::open(path)?;
    for (name, content) in parts {
        folder.write(name, |out| out.write_all(content.as_bytes()))?;
    }
    folder.commit(&[])
}
