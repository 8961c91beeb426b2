//! `hardpoint site`: the gallery as a static site.

use std::collections::HashSet;
use std::io::Write;
use std::path::{Path, PathBuf};

use hardpoint::topology::Formulation;
use hardpoint_file::ModelFile;
use hardpoint_report::gallery::{Card, gallery};
use hardpoint_report::page::{SHARED, shared_script, sharing};
use hardpoint_report::sketch::svg;

use crate::args::Site;
use crate::folder::{Folder, file_name};
use crate::outcome::Outcome;
use crate::session::Session;
use crate::{maps, run, text};

/// Default folder of models.
const MODELS: &str = "models";
/// Page of all models.
const INDEX: &str = "index.html";

/// Writes the site; models that cannot be shown are left out and reported.
pub fn run(options: &Site) -> Outcome {
    let session = Session::begin(false);
    session.end(site_in(&session, options))
}

fn site_in(session: &Session, options: &Site) -> Result<Outcome, Outcome> {
    let models = if options.models.is_empty() { all_models() } else { options.models.clone() };
    if models.is_empty() {
        let why = format!("there are no model files in `{MODELS}`; name the models to show");
        return Err(session.misunderstood(&why));
    }
    let mut taken = HashSet::from(["index".to_owned()]);
    for model in &models {
        if !taken.insert(stem(model)) {
            let why = format!("`{}` would be the second `{}.html`; rename it", model.display(), stem(model));
            return Err(session.misunderstood(&why));
        }
    }
    let mut folder = Folder::open(&options.folder).map_err(|e| session.not_written(&e))?;
    session.patient(true);
    let mut meter = session.meter("making pages", "models");
    let (mut cards, mut outcome) = (Vec::new(), Outcome::Done);
    for (k, model) in models.iter().enumerate() {
        match card(session, model, &mut folder) {
            Ok(card) => cards.push(card),
            Err(failed) => outcome = outcome.and(failed),
        }
        if session.interrupted() {
            session.ended_while_writing(&options.folder);
            return Err(Outcome::Interrupted);
        }
        meter.show(k + 1, models.len());
    }
    drop(meter);
    if cards.is_empty() {
        return Err(outcome);
    }
    let lead = "Mechanisms with their motion and exact design sensitivities. Each page is the report of one model: open one and play.";
    let index = gallery("Hardpoint", lead, None, &cards);
    let shared = folder.write(SHARED, |out| out.write_all(shared_script().as_bytes()));
    let written = shared.and_then(|()| folder.write(INDEX, |out| out.write_all(index.as_bytes())));
    written.and_then(|()| folder.commit(&[])).map_err(|e| session.not_written(&e))?;
    text::print(&format!("{} models: {}\n", cards.len(), options.folder.join(INDEX).display()));
    Ok(outcome)
}

/// All model files of the default folder, sorted by name.
fn all_models() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(MODELS).into_iter().flatten().flatten().map(|e| e.path());
    let mut models: Vec<PathBuf> = entries.filter(|p| p.extension().is_some_and(|e| e == "toml")).collect();
    models.sort();
    models
}

fn stem(model: &Path) -> String {
    model.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// Pages of a model, and its card in the gallery.
fn card(session: &Session, model: &Path, folder: &mut Folder) -> Result<Card, Outcome> {
    let file = session.read(model)?;
    let maps = maps::solved(session, &file, Formulation::Relative);
    let mut picture = None;
    let mut write = |name: &str, one: &ModelFile| {
        let page = run::page(session, one, &maps, Formulation::Relative)?;
        let html = sharing(&page.html, INDEX);
        picture.get_or_insert(svg(&page.picture));
        folder.write(name, |out| out.write_all(html.as_bytes())).map_err(|e| session.not_written(&e))
    };
    let stem = file_name(&stem(model));
    let mut pages: Vec<(String, String)> = Vec::new();
    for (k, case) in file.model.cases.iter().enumerate() {
        let name =
            if k == 0 { format!("{stem}.html") } else { format!("{stem}-{}.html", file_name(&case.name)) };
        write(&name, &file.in_case(hardpoint::model::CaseId(k)))?;
        pages.push((case.name.clone(), link(&name)));
    }
    let name = format!("{stem}.html");
    if pages.is_empty() {
        write(&name, &file)?;
    }
    Ok(Card {
        title: file.model.name.clone(),
        description: file.description.clone(),
        file: model.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        wrong: None,
        link: link(&name),
        more: pages,
        picture,
    })
}

/// Relative address of a file next to the page; `%` in its name is escaped.
fn link(name: &str) -> String {
    name.replace('%', "%25")
}
