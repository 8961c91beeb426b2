//! Requests and their answers.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use hardpoint_file::Diagnostics;
use hardpoint_report::gallery;
use hyper::body::Incoming;
use hyper::header;
use hyper::{Method, Request, StatusCode};
use serde_json::json;

use super::folder::FileError;
use super::server::{Answer, body};
use super::state::Studio;
use super::studies::StudyRequest;
use super::{page, watch};

/// Query of an address; of repeated keys, the last one counts.
struct Query(HashMap<String, String>);

impl Query {
    fn of(uri: &hyper::Uri) -> Self {
        let pairs = form_urlencoded::parse(uri.query().unwrap_or_default().as_bytes());
        Self(pairs.map(|(key, value)| (key.into_owned(), value.into_owned())).collect())
    }

    fn get(&self, key: &str) -> Option<&str> {
        self.0.get(key).map(String::as_str)
    }

    fn file(&self) -> Result<String, Answer> {
        let why = "the address names no model: add `?file=NAME.toml`";
        self.get("file").map(Into::into).ok_or_else(|| Answer::refusal(StatusCode::BAD_REQUEST, why))
    }

    /// Identity of the requesting page; changes by one page are reported to the others.
    fn client(&self) -> String {
        self.get("client").unwrap_or_default().into()
    }
}

/// Answers an authorised request.
pub async fn answer(studio: Arc<Studio>, request: Request<Incoming>) -> Answer {
    let (method, query) = (request.method().clone(), Query::of(request.uri()));
    let path = request.uri().path().to_owned();
    let parts: Vec<&str> = path.strip_prefix('/').unwrap_or(&path).split('/').collect();
    let answer = match (&parts[..], &method) {
        ([""], &Method::GET) => front(studio, &query).await,
        (["gallery"], &Method::GET) => Ok(page::gallery(studio).await),
        (["new"], &Method::GET) => Ok(page::new(studio).await),
        (["api", "models"], &Method::GET) => blocking(move || Ok(list(&studio))).await,
        (["api", "drawing"], &Method::GET) => drawing(studio, &query).await,
        (["api", "model"], &Method::GET) => text(studio, &query).await,
        (["api", "model"], &Method::PUT) => save(studio, &query, request).await,
        (["api", "model"], &Method::POST) => save_new(studio, &query, request).await,
        (["api", "events"], &Method::GET) => Ok(watch::events(studio, query.get("file"), query.client())),
        (["api", "study"], &Method::POST) => begin(studio, request).await,
        (["api", "study", id], &Method::GET) => {
            of_study(&studio, id, |s| Answer::json(StatusCode::OK, &s.document()))
        }
        (["api", "study", id], &Method::DELETE) => of_study(&studio, id, |s| {
            s.cancel();
            Answer::json(StatusCode::ACCEPTED, &s.document())
        }),
        (["api", "study", id, "report.html"], &Method::GET) => {
            of_study(&studio, id, |s| match s.report(query.get("case")) {
                Some(html) => Answer::page(StatusCode::OK, html),
                None => Answer::refusal(StatusCode::NOT_FOUND, "the study has no report yet"),
            })
        }
        (parts, _) => Err(match allowed(parts) {
            Some(methods) => {
                let why = format!("{path} takes {methods} only");
                Answer::refusal(StatusCode::METHOD_NOT_ALLOWED, &why).with(header::ALLOW, methods)
            }
            None => Answer::refusal(StatusCode::NOT_FOUND, "there is no resource at this address"),
        }),
    };
    let (Ok(answer) | Err(answer)) = answer;
    answer
}

/// Methods of an existing address.
fn allowed(parts: &[&str]) -> Option<&'static str> {
    match parts {
        [""]
        | ["gallery" | "new"]
        | ["api", "models" | "events" | "drawing"]
        | ["api", "study", _, "report.html"] => Some("GET"),
        ["api", "model"] => Some("GET, POST, PUT"),
        ["api", "study"] => Some("POST"),
        ["api", "study", _] => Some("DELETE, GET"),
        _ => None,
    }
}

/// Runs blocking work, such as file access or solving, in a thread of its own.
pub async fn blocking<X: Send + 'static>(
    what: impl FnOnce() -> Result<X, Answer> + Send + 'static,
) -> Result<X, Answer> {
    match tokio::task::spawn_blocking(what).await {
        Ok(done) => done,
        Err(_) => Err(Answer::refusal(StatusCode::INTERNAL_SERVER_ERROR, "internal error of the program")),
    }
}

async fn front(studio: Arc<Studio>, query: &Query) -> Result<Answer, Answer> {
    let file = query.get("file").map(Into::into).or_else(|| studio.opened.clone());
    match file {
        Some(file) => Ok(page::model(studio, file, query.get("case").map(Into::into)).await),
        None => Ok(page::gallery(studio).await),
    }
}

async fn drawing(studio: Arc<Studio>, query: &Query) -> Result<Answer, Answer> {
    Ok(page::drawing(studio, query.file()?).await)
}

fn list(studio: &Studio) -> Answer {
    let folder = studio.models.whole_path().display().to_string();
    Answer::json(StatusCode::OK, &json!({ "folder": folder, "models": studio.models.list() }))
}

async fn text(studio: Arc<Studio>, query: &Query) -> Result<Answer, Answer> {
    let file = query.file()?;
    blocking(move || {
        let found = studio.models.read(&file).map_err(|why| no_file(&file, why))?;
        Ok(Answer::json(
            StatusCode::OK,
            &json!({ "file": file, "text": found.text, "revision": found.revision }),
        ))
    })
    .await
}

async fn save(studio: Arc<Studio>, query: &Query, request: Request<Incoming>) -> Result<Answer, Answer> {
    let (file, client, anyway) = (query.file()?, query.client(), query.get("anyway") == Some("1"));
    let Some(before) = request.headers().get(header::IF_MATCH).and_then(|v| v.to_str().ok()) else {
        let why = "name the revision to be replaced in `If-Match`";
        return Err(Answer::refusal(StatusCode::PRECONDITION_REQUIRED, why));
    };
    let before = before.trim_matches('"').to_owned();
    let text = text_of(request).await?;
    blocking(move || {
        let models = &studio.models;
        // A conflict on disk is reported before errors of the text.
        let now = models.read(&file).map_err(|why| no_file(&file, why))?;
        if now.revision != before {
            return Err(no_file(&file, FileError::Changed(now)));
        }
        is_model(&studio, &file, &text, anyway)?;
        let saved = models.save(&file, &text, &before, &client).map_err(|why| no_file(&file, why))?;
        Ok(Answer::json(StatusCode::OK, &json!({ "file": file, "revision": saved })))
    })
    .await
}

async fn save_new(studio: Arc<Studio>, query: &Query, request: Request<Incoming>) -> Result<Answer, Answer> {
    let (file, client, anyway) = (query.file()?, query.client(), query.get("anyway") == Some("1"));
    let text = text_of(request).await?;
    blocking(move || {
        is_model(&studio, &file, &text, anyway)?;
        let saved = studio.models.save_new(&file, &text, &client).map_err(|why| no_file(&file, why))?;
        Ok(Answer::json(StatusCode::CREATED, &json!({ "file": file, "revision": saved })))
    })
    .await
}

async fn text_of(request: Request<Incoming>) -> Result<String, Answer> {
    let bytes = body(request).await?;
    String::from_utf8(bytes).map_err(|_| Answer::refusal(StatusCode::BAD_REQUEST, "the text is not UTF-8"))
}

/// Checks that a text is a model, if that matters.
fn is_model(studio: &Studio, file: &str, text: &str, anyway: bool) -> Result<(), Answer> {
    if anyway {
        return Ok(());
    }
    studio.models.parse(file, text).map(drop).map_err(|found| no_model(&found))
}

async fn begin(studio: Arc<Studio>, request: Request<Incoming>) -> Result<Answer, Answer> {
    let bytes = body(request).await?;
    let asked: StudyRequest = serde_json::from_slice(&bytes)
        .map_err(|e| Answer::refusal(StatusCode::BAD_REQUEST, &format!("invalid study request: {e}")))?;
    blocking(move || {
        if !studio.models.is_name(&asked.file) {
            return Err(no_file(&asked.file, FileError::Name));
        }
        let file = studio.models.parse(&asked.file, &asked.text).map_err(|found| no_model(&found))?;
        match studio.studies.begin(file, asked) {
            Some(study) => Ok(Answer::json(StatusCode::ACCEPTED, &study.document())),
            None => {
                let why = "two studies are running already: wait until one ends, or cancel it";
                Err(Answer::refusal(StatusCode::TOO_MANY_REQUESTS, why))
            }
        }
    })
    .await
}

fn of_study(
    studio: &Studio,
    id: &str,
    what: impl FnOnce(&super::studies::Study) -> Answer,
) -> Result<Answer, Answer> {
    let study = studio.studies.get(id);
    let absent = || Answer::refusal(StatusCode::NOT_FOUND, "there is no such study any more");
    study.map(|s| what(&s)).ok_or_else(absent)
}

fn no_model(found: &Diagnostics) -> Answer {
    let document =
        json!({ "error": "the text is no valid model", "diagnostics": found, "text": found.render(false) });
    Answer::json(StatusCode::UNPROCESSABLE_ENTITY, &document)
}

/// Answer for a file that does not exist or was not written.
pub fn no_file(name: &str, why: FileError) -> Answer {
    match reason(name, why) {
        Ok((status, sentence)) => Answer::refusal(status, &sentence),
        Err(conflict) => conflict,
    }
}

/// The same as a page for a person, with a link to the models of the folder.
pub fn no_page(name: &str, why: FileError) -> Answer {
    match reason(name, why) {
        Ok((status, sentence)) => Answer::page(status, gallery::missing(name, &sentence, "/gallery")),
        Err(conflict) => conflict,
    }
}

/// Status and reason why there is no such file; the answer itself if the file was changed meanwhile.
fn reason(name: &str, why: FileError) -> Result<(StatusCode, Cow<'static, str>), Answer> {
    Ok(match why {
        FileError::Name => {
            let why = format!(
                "`{name}` is not a valid name of a model in this folder: use a plain name that ends with `.toml`"
            );
            (StatusCode::BAD_REQUEST, why.into())
        }
        FileError::Absent => (StatusCode::NOT_FOUND, format!("there is no `{name}` in this folder").into()),
        FileError::Exists => (StatusCode::CONFLICT, format!("there is a `{name}` already").into()),
        FileError::TooLarge => {
            (StatusCode::PAYLOAD_TOO_LARGE, format!("`{name}` is too large for a model").into())
        }
        FileError::Failed(why) => (StatusCode::INTERNAL_SERVER_ERROR, why.into()),
        FileError::Changed(now) => {
            let error = format!("`{name}` was changed on disk meanwhile");
            let document =
                json!({ "error": error, "file": name, "text": now.text, "revision": now.revision });
            return Err(Answer::json(StatusCode::CONFLICT, &document));
        }
    })
}
