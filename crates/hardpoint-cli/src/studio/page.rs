//! Pages of models, as written by `run`, the gallery with its drawings, and the page of a new linkage.

use std::sync::{Arc, Mutex, PoisonError};

use hardpoint::topology::Formulation;
use hardpoint_file::ModelFile;
use hardpoint_report::gallery::{self, Card};
use hardpoint_report::maps::MapFact;
use hardpoint_report::page::served;
use hardpoint_report::sketch::svg;
use hyper::StatusCode;
use hyper::body::Bytes;
use serde::Serialize;
use serde_json::{Value, json};

use crate::meter::Listener;
use crate::session::Session;
use crate::{maps, run};

use super::folder::FileError;
use super::pages::Made;
use super::routes::{blocking, no_file, no_page};
use super::server::Answer;
use super::state::Studio;

/// Address of the page of a new linkage.
pub const NEW: &str = "/new";
/// Number of names of new files that are tried.
const MOST_NEW: usize = 1000;
/// Model behind the sheet of a new linkage: a crank that turns.
const CRANK: &str = r#"# A crank that turns: the smallest linkage.

name = "linkage"
units = { length = "mm", angle = "deg" }
planar = "xy"

[hardpoints]
A = [0, 0]
B = [100, 0]

[bodies]
ground = ["A"]
bar_1 = ["A", "B"]

[drivers]
A_motor = { joint = "A", law = "360*t" }

[time]
end = 1
steps = 60
"#;

/// Facts about the server for a page.
#[derive(Serialize)]
struct About<'a> {
    token: &'a str,
    /// Model file of the page; `None` for the gallery.
    file: Option<&'a str>,
    /// Revision of the model text; `None` if it has no file yet.
    revision: Option<&'a str>,
    /// Case of the page, if the model has cases.
    case: Option<&'a str>,
    cases: Vec<&'a str>,
}

/// Page of a model in its current state on disk.
pub async fn model(studio: Arc<Studio>, file: String, case: Option<String>) -> Answer {
    let asked = studio.pages.tick();
    let mut last = studio.pages.last.lock().await;
    let fits = |m: &&Made| m.begun > asked && m.file == file && m.case == case;
    if let Some(made) = last.as_ref().filter(fits) {
        return Answer::page(StatusCode::OK, made.html.clone());
    }
    let begun = studio.pages.tick();
    let (for_studio, for_file, for_case) = (Arc::clone(&studio), file.clone(), case.clone());
    match blocking(move || made(&for_studio, &for_file, for_case.as_deref())).await {
        Ok(html) => {
            let html = Bytes::from(html);
            *last = Some(Made { begun, file, case, html: html.clone() });
            Answer::page(StatusCode::OK, html)
        }
        Err(answer) => answer,
    }
}

fn made(studio: &Studio, name: &str, case: Option<&str>) -> Result<String, Answer> {
    let found = studio.models.read(name).map_err(|why| no_page(name, why))?;
    Ok(page_of(studio, name, &found.text, Some(&found.revision), case))
}

/// Page on which a linkage is drawn; its file is written when it is saved.
pub async fn new(studio: Arc<Studio>) -> Answer {
    let made = blocking(move || {
        let names = (1..).map(|k| if k == 1 { "linkage.toml".into() } else { format!("linkage-{k}.toml") });
        let is_free = |name: &String| matches!(studio.models.read(name), Err(FileError::Absent));
        let name = names.take(MOST_NEW).find(is_free).unwrap_or_else(|| "linkage.toml".into());
        Ok(page_of(&studio, &name, CRANK, None, None))
    });
    match made.await {
        Ok(html) => Answer::page(StatusCode::OK, html),
        Err(answer) => answer,
    }
}

/// Drawing of a model in its current state on disk, empty if the model cannot be shown.
pub async fn drawing(studio: Arc<Studio>, name: String) -> Answer {
    let drawn = blocking(move || {
        let found = studio.models.read(&name).map_err(|why| no_file(&name, why))?;
        let drawings = || studio.pages.drawings.lock().unwrap_or_else(PoisonError::into_inner);
        let known = drawings().get(&name).filter(|(revision, _)| *revision == found.revision).cloned();
        let svg = known.map_or_else(|| drawn(&studio, &name, &found.text), |(_, svg)| svg);
        let answer = Answer::json(StatusCode::OK, &json!({ "file": name, "svg": svg }));
        drawings().insert(name, (found.revision, svg));
        Ok(answer)
    });
    drawn.await.unwrap_or_else(|answer| answer)
}

fn drawn(studio: &Studio, name: &str, text: &str) -> String {
    let file = studio.models.parse(name, text).ok();
    let page = file.and_then(|file| {
        let case = file.model.cases.first().map(|c| c.name.clone());
        solved(studio, &file, case.as_deref(), |_| Vec::new()).ok()
    });
    page.map_or_else(String::new, |page| svg(&page.picture))
}

fn page_of(studio: &Studio, name: &str, text: &str, revision: Option<&str>, case: Option<&str>) -> String {
    let mut about =
        About { token: studio.address.token(), file: Some(name), revision, case, cases: Vec::new() };
    let file = match studio.models.parse(name, text) {
        Ok(file) => file,
        Err(wrong) => {
            let lines: Vec<usize> = wrong.list().iter().filter_map(|d| d.line).collect();
            return with_facts(&gallery::trouble(name, &wrong.render(false), text, &lines), &about);
        }
    };
    about.cases = file.model.cases.iter().map(|c| c.name.as_str()).collect();
    let case = case.or(about.cases.first().copied());
    about.case = case;
    match solved(studio, &file, case, |session| maps::solved(session, &file, Formulation::Relative)) {
        Ok(page) => with_facts(&page.html, &about),
        Err((diagnostics, why)) => {
            let lines = diagnostics
                .as_array()
                .into_iter()
                .flatten()
                .filter_map(|d| Some(d["line"].as_u64()? as usize));
            with_facts(&gallery::trouble(name, &why, text, &lines.collect::<Vec<_>>()), &about)
        }
    }
}

/// Report of a case, or the diagnostics why there is none, also as text.
fn solved(
    studio: &Studio,
    file: &ModelFile,
    case: Option<&str>,
    maps: impl FnOnce(&Session) -> Vec<MapFact>,
) -> Result<run::Page, (Value, String)> {
    let heard = Arc::new(Heard::default());
    let session = Session::for_page(Arc::clone(&heard) as Arc<dyn Listener>, Arc::clone(&studio.ending));
    let page = case.map(|name| session.case(file, name)).transpose().and_then(|id| {
        let one = id.map(|id| file.in_case(id));
        run::page(&session, one.as_ref().unwrap_or(file), &maps(&session), Formulation::Relative)
    });
    page.map_err(|_| heard.refusal())
}

/// Adds the facts about the server to a page.
fn with_facts(page: &str, about: &About<'_>) -> String {
    served(page, about).expect("names are plain data")
}

/// The gallery.
pub async fn gallery(studio: Arc<Studio>) -> Answer {
    let made = blocking(move || {
        let path = studio.models.whole_path().display().to_string();
        let entries = studio.models.list();
        let lead = match entries.len() {
            0 => format!("There are no model files in {path}."),
            1 => format!("One model in {path}."),
            n => format!("{n} models in {path}."),
        };
        let address = |path: &str, pairs: &[(&str, &str)]| {
            let query = form_urlencoded::Serializer::new(String::new()).extend_pairs(pairs).finish();
            format!("{path}?{query}")
        };
        let link = |pairs: &[(&str, &str)]| address("/", pairs);
        let drawing = |file: &str| gallery::pending(&address("/api/drawing", &[("file", file)]));
        let card = |e: super::folder::Entry| Card {
            picture: (e.problems == 0).then(|| drawing(&e.file)),
            link: link(&[("file", &e.file)]),
            more: e.cases.iter().map(|c| (c.clone(), link(&[("file", &e.file), ("case", c)]))).collect(),
            wrong: match e.problems {
                0 => None,
                1 => Some("1 problem".into()),
                n => Some(format!("{n} problems")),
            },
            title: e.title,
            description: e.description,
            file: e.file,
        };
        let cards: Vec<Card> = entries.into_iter().map(card).collect();
        let about = About {
            token: studio.address.token(),
            file: None,
            revision: None,
            case: None,
            cases: Vec::new(),
        };
        Ok(with_facts(&gallery::gallery("Models", &lead, Some(NEW), &cards), &about))
    });
    match made.await {
        Ok(html) => Answer::page(StatusCode::OK, html),
        Err(answer) => answer,
    }
}

/// Reason why there is no page.
#[derive(Default)]
struct Heard(Mutex<(Value, String)>);

impl Heard {
    fn refusal(&self) -> (Value, String) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Listener for Heard {
    fn progress(&self, _: &'static str, _: &'static str, _: usize, _: usize) {}

    fn line(&self, _: &str) {}

    fn refused(&self, diagnostics: Value, text: &str) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = (diagnostics, text.into());
    }
}
