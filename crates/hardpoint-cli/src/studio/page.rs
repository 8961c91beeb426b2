//! Pages of models, as written by `run`, and the gallery.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use hardpoint::topology::Formulation;
use hardpoint_report::gallery::{self, Card};
use hardpoint_report::page::served;
use hyper::StatusCode;
use hyper::body::Bytes;
use serde::Serialize;
use serde_json::Value;

use crate::meter::Listener;
use crate::session::Session;
use crate::{maps, run};

use super::Studio;
use super::routes::{blocking, no_page};
use super::server::Answer;

/// Facts about the server for a page.
#[derive(Serialize)]
struct About<'a> {
    token: &'a str,
    /// Model file of the page; `None` for the gallery.
    file: Option<&'a str>,
    /// Revision of the model text.
    revision: Option<&'a str>,
    /// Case of the page, if the model has cases.
    case: Option<&'a str>,
    cases: Vec<&'a str>,
}

/// Page generation: one page at a time; the last page serves all requests that arrived before it was started.
#[derive(Default)]
pub struct Pages {
    clock: AtomicU64,
    last: tokio::sync::Mutex<Option<Made>>,
}

struct Made {
    begun: u64,
    file: String,
    case: Option<String>,
    html: Bytes,
}

impl Pages {
    fn tick(&self) -> u64 {
        self.clock.fetch_add(1, Ordering::SeqCst)
    }
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
    let mut about = About {
        token: studio.address.token(),
        file: Some(name),
        revision: Some(&found.revision),
        case,
        cases: Vec::new(),
    };
    let file = match studio.models.parse(name, &found.text) {
        Ok(file) => file,
        Err(wrong) => {
            let lines: Vec<usize> = wrong.list().iter().filter_map(|d| d.line).collect();
            return Ok(with_facts(
                &gallery::trouble(name, &wrong.render(false), &found.text, &lines),
                &about,
            ));
        }
    };
    about.cases = file.model.cases.iter().map(|c| c.name.as_str()).collect();
    let case = case.or(about.cases.first().copied());
    about.case = case;
    let heard = Arc::new(Heard::default());
    let session = Session::for_page(Arc::clone(&heard) as Arc<dyn Listener>, Arc::clone(&studio.ending));
    let page = case.map(|name| session.case(&file, name)).transpose().and_then(|id| {
        let maps = maps::solved(&session, &file, Formulation::Relative);
        let one = id.map(|id| file.in_case(id));
        run::page(&session, one.as_ref().unwrap_or(&file), &maps, Formulation::Relative)
    });
    Ok(match page {
        Ok(page) => with_facts(&page.html, &about),
        Err(_) => {
            let (diagnostics, text) = heard.refusal();
            let lines = diagnostics
                .as_array()
                .into_iter()
                .flatten()
                .filter_map(|d| Some(d["line"].as_u64()? as usize));
            with_facts(&gallery::trouble(name, &text, &found.text, &lines.collect::<Vec<_>>()), &about)
        }
    })
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
        let link = |pairs: &[(&str, &str)]| {
            format!("/?{}", form_urlencoded::Serializer::new(String::new()).extend_pairs(pairs).finish())
        };
        let card = |e: super::folder::Entry| Card {
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
            picture: None,
        };
        let cards: Vec<Card> = entries.into_iter().map(card).collect();
        let about = About {
            token: studio.address.token(),
            file: None,
            revision: None,
            case: None,
            cases: Vec::new(),
        };
        Ok(with_facts(&gallery::gallery("Models", &lead, &cards), &about))
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
