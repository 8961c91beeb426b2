//! Diagnostics of open texts, computed in a thread of its own.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};

use hardpoint_file::{Diagnostic, ModelFile, Severity, TaskFile};
use hardpoint_report::diagnose;
use serde_json::{Value, json};

use crate::rpc::Output;

use super::files::{OpenTexts, path_of, plain, root_of, text_of, uri_of};
use super::position::Lines;

/// Models of the last valid state of each text, by address.
pub type Models = Arc<Mutex<HashMap<String, Arc<ModelFile>>>>;

/// Request to check a text.
struct Check {
    uri: String,
    /// All open texts at that time.
    open: OpenTexts,
}

/// Thread that checks texts.
pub struct Checker {
    requests: Option<Sender<Check>>,
    thread: Option<std::thread::JoinHandle<()>>,
    /// Models that are valid, for hover texts.
    pub models: Models,
}

impl Checker {
    /// Starts the thread.
    pub fn new(output: Output) -> Self {
        let (requests, received) = channel();
        let models = Models::default();
        let known = Arc::clone(&models);
        let thread = std::thread::spawn(move || work(&received, &output, &known));
        Self { requests: Some(requests), thread: Some(thread), models }
    }

    /// Checks a text, or forgets one that is closed.
    pub fn check(&self, uri: &str, open: &OpenTexts) {
        let request = Check { uri: uri.to_owned(), open: open.clone() };
        if let Some(requests) = &self.requests {
            // The thread only ends with the channel.
            let _ = requests.send(request);
        }
    }

    /// Waits until all requests are done.
    pub fn end(mut self) {
        self.requests = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn work(received: &Receiver<Check>, output: &Output, models: &Models) {
    // Addresses of published diagnostics, by the checked text.
    let mut published: HashMap<String, HashSet<String>> = HashMap::new();
    while let Ok(first) = received.recv() {
        // Of several states of a text only the last one is checked.
        let mut waiting = vec![first];
        for next in received.try_iter() {
            waiting.retain(|w| w.uri != next.uri);
            waiting.push(next);
        }
        for Check { uri, open } in waiting {
            let found = catch_unwind(AssertUnwindSafe(|| diagnostics_of(&uri, &open, models)));
            let found = found.unwrap_or_default();
            let before = published.remove(&uri).unwrap_or_default();
            let now: HashSet<String> = found.keys().cloned().collect();
            for gone in before.difference(&now) {
                publish(output, gone, &open, &[]);
            }
            for (address, list) in &found {
                publish(output, address, &open, list);
            }
            published.insert(uri, now);
        }
    }
}

fn publish(output: &Output, uri: &str, open: &OpenTexts, list: &[Value]) {
    let mut params = json!({ "uri": uri, "diagnostics": list });
    if let Some(text) = open.get(uri) {
        params["version"] = text.version.into();
    }
    output.notify("textDocument/publishDiagnostics", &params);
}

/// Diagnostics of an open text and of the files that it includes, by address. A part of another model is checked with
/// that model.
fn diagnostics_of(uri: &str, open: &OpenTexts, models: &Models) -> BTreeMap<String, Vec<Value>> {
    let mut found: BTreeMap<String, Vec<Value>> = BTreeMap::new();
    let Some(text) = open.get(uri) else {
        models.lock().unwrap_or_else(PoisonError::into_inner).remove(uri);
        return found;
    };
    found.insert(uri.to_owned(), Vec::new());
    let own = path_of(uri);
    let root = own.as_ref().and_then(|path| root_of(open, path));
    let (path, content) = match &root {
        Some(root) => (Some(root.clone()), text_of(open, root).unwrap_or_default()),
        None => (own.clone(), text.document.text().to_owned()),
    };
    let name = path.as_ref().map_or(uri.to_owned(), |p| p.display().to_string());
    let list = if text.document.is_task() && root.is_none() {
        let errors = TaskFile::parse(&content, &name).err();
        // A text has no folder: that its files cannot be read is reported by `hardpoint synthesize`.
        let list = errors.map(|e| e.list().to_vec()).unwrap_or_default();
        list.into_iter().filter(|d| d.code != "HP0111").collect()
    } else {
        let folder = path.as_deref().and_then(Path::parent);
        let (file, list) = diagnose::of_text(hardpoint_file::parse_in(folder, &content, &name));
        if let Some(file) = file {
            models.lock().unwrap_or_else(PoisonError::into_inner).insert(uri.to_owned(), Arc::new(file));
        }
        list
    };
    for diagnostic in &list {
        let place = PathBuf::from(&diagnostic.file);
        let here = own.as_ref().is_some_and(|own| plain(own) == plain(&place));
        let address = match (&root, here) {
            // The place of a diagnostic without a file of its own is the text.
            (_, true) => uri.to_owned(),
            (None, false) if diagnostic.file == name => uri.to_owned(),
            _ => open_address(open, &place),
        };
        let content = match open.get(&address) {
            Some(text) => text.document.text().to_owned(),
            None => text_of(open, &place).unwrap_or_default(),
        };
        found.entry(address).or_default().push(message(diagnostic, &content));
    }
    found
}

/// Address of a path, as the editor writes it.
fn open_address(open: &OpenTexts, path: &Path) -> String {
    let is_same = |uri: &&String| path_of(uri).is_some_and(|p| plain(&p) == plain(path));
    open.keys().find(is_same).cloned().unwrap_or_else(|| uri_of(&plain(path)))
}

/// Diagnostic of a text, for an editor.
fn message(d: &Diagnostic, text: &str) -> Value {
    let lines = Lines::of(text);
    let span = match (d.line, d.column, d.length) {
        (Some(line), Some(column), Some(length)) => lines.span(text, line, column, length),
        // The file as a whole: its first line.
        _ => 0..text.find('\n').unwrap_or(text.len()),
    };
    let mut message = d.message.clone();
    if let Some(label) = &d.label {
        message += &format!(" ({label})");
    }
    for note in &d.notes {
        message += &format!("\nnote: {note}");
    }
    if let Some(help) = &d.help {
        message += &format!("\nhelp: {help}");
    }
    let mut out = json!({
        "range": lines.range(text, &span),
        "severity": match d.severity {
            Severity::Error => 1,
            Severity::Warning => 2,
            Severity::Note => 3,
        },
        "code": d.code,
        "source": "hardpoint",
        "message": message,
    });
    if let Some((at, new)) = fix(d, text, span) {
        out["data"] = json!({ "replace": lines.range(text, &at), "by": new });
    }
    out
}

/// Replacement that a diagnostic suggests: the misspelt word in its range, and the correct one.
fn fix(d: &Diagnostic, text: &str, span: std::ops::Range<usize>) -> Option<(std::ops::Range<usize>, String)> {
    let said = [Some(d.message.as_str()), d.help.as_deref()];
    let suggested = said.into_iter().flatten().find_map(|text| {
        let rest = text.split_once("did you mean `")?.1;
        Some(rest.split_once('`')?.0.to_owned())
    })?;
    let written = &text[span.clone()];
    let is_word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.');
    // The misspelt word is one of those that the message quotes.
    let quoted =
        d.message.split('`').skip(1).step_by(2).filter(|word| *word != suggested && !word.is_empty());
    quoted.into_iter().find_map(|word| {
        let whole = |at: &usize| {
            !written[..*at].ends_with(is_word) && !written[at + word.len()..].starts_with(is_word)
        };
        let mut places = written.match_indices(word).map(|(at, _)| at).filter(whole);
        let at = places.next().filter(|_| places.next().is_none())?;
        let start = span.start + at;
        Some((start..start + word.len(), suggested.clone()))
    })
}
