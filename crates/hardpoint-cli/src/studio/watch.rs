//! Events for a page: a change of its file on disk, progress of a study, a sign of life of the server.

use std::convert::Infallible;
use std::sync::Arc;
use std::time::Duration;

use http_body_util::channel::{Channel, Sender};
use hyper::body::Bytes;
use serde_json::json;
use tokio::sync::broadcast::error::RecvError;
use tokio::time::{Instant, timeout_at};

use super::server::Answer;
use super::state::Studio;

/// Interval of reading a file: reported times of the last change are not reliable on all systems, and models are small.
const POLL: Duration = Duration::from_millis(500);
/// Number of file checks between two signs of life.
const ALIVE: u32 = 4;
/// Maximum number of unsent events of a slow page before the connection waits for it.
const WAITING: usize = 16;

/// Event stream for a page that shows this file.
pub fn events(studio: Arc<Studio>, file: Option<&str>, client: String) -> Answer {
    let (sender, channel) = Channel::new(WAITING);
    tokio::spawn(watch(studio, file.map(Into::into), client, sender));
    Answer::stream("text/event-stream", channel)
}

async fn watch(studio: Arc<Studio>, file: Option<String>, client: String, mut to: Sender<Bytes, Infallible>) {
    let mut studies = studio.studies.events();
    let Look { revision: mut known, .. } = look(&studio, file.as_deref(), &client).await;
    let hello = json!({ "server": studio.id, "file": file, "revision": known });
    if send(&mut to, "hello", &hello.to_string()).await.is_err() {
        return;
    }
    let mut looks = 0;
    let mut next = Instant::now() + POLL;
    loop {
        let sent = match timeout_at(next, studies.recv()).await {
            Ok(Ok(event)) => send(&mut to, "study", &event).await,
            // A page that missed events requests the state of the study.
            Ok(Err(RecvError::Lagged(_))) => send(&mut to, "missed", "{}").await,
            Ok(Err(RecvError::Closed)) => return,
            Err(_) => {
                next = Instant::now() + POLL;
                looks += 1;
                let now = look(&studio, file.as_deref(), &client).await;
                let changed = now.revision != known && !now.is_own;
                known = now.revision;
                if changed {
                    let event = json!({ "file": file, "revision": known });
                    send(&mut to, "changed", &event.to_string()).await
                } else if looks % ALIVE == 0 {
                    send(&mut to, "alive", "{}").await
                } else {
                    Ok(())
                }
            }
        };
        if sent.is_err() {
            return;
        }
    }
}

async fn send(to: &mut Sender<Bytes, Infallible>, name: &str, data: &str) -> Result<(), ()> {
    to.send_data(format!("event: {name}\ndata: {data}\n\n").into()).await.map_err(drop)
}

/// State of the files on disk.
#[derive(Default)]
struct Look {
    /// `None` if there is no such file.
    revision: Option<String>,
    /// True if the page itself saved it.
    is_own: bool,
}

async fn look(studio: &Arc<Studio>, file: Option<&str>, client: &str) -> Look {
    let Some(file) = file.map(str::to_owned) else { return Look::default() };
    let (studio, client) = (Arc::clone(studio), client.to_owned());
    let read = tokio::task::spawn_blocking(move || {
        let revision = studio.models.read(&file).ok().map(|t| t.revision);
        let is_own = revision.as_ref().is_some_and(|r| studio.models.was_saved_by(&file, r, &client));
        Look { revision, is_own }
    });
    read.await.unwrap_or_default()
}
