//! Server of the language: its requests, and its answers.

use super::check::Checker;
use super::files::{self, OpenText, OpenTexts, path_of, text_of, uri_of};
use super::position::{Lines, Position, TextRange};
use crate::outcome::Outcome;
use crate::rpc::{Message, MessageFormat, Output, RpcError, params_of, read_message};
use crate::session::Session;
use crate::text;
use hardpoint_file::{CompletionKind, Document, NameAt};
use hardpoint_report::{GENERATOR, entry};
use serde::Deserialize;
use serde_json::{Value, json};
use std::io::BufReader;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::{Arc, PoisonError};

/// Error codes of the protocol.
const NOT_INITIALIZED: i64 = -32002;

const REQUEST_FAILED: i64 = -32803;

/// Synchronisation of texts by their changes.
const INCREMENTAL: u8 = 2;

/// Serves stdin until `exit`.
pub fn run() -> Outcome {
    text::reserve_stdout();
    let output = Output::new(std::io::stdout(), MessageFormat::Headers);
    let checker = Checker::new(output.clone());
    let server = Server { output, open: OpenTexts::new(), checker, phase: Phase::New };
    Session::not_printed(server.serve(&mut BufReader::new(std::io::stdin())))
}

/// Phase of the connection.
#[derive(Clone, Copy, PartialEq)]
enum Phase {
    /// Before `initialize`.
    New,
    Initialized,
    /// After `shutdown`.
    ShutDown,
}

struct Server {
    output: Output,
    open: OpenTexts,
    checker: Checker,
    phase: Phase,
}

/// Text that a request is about.
#[derive(Deserialize)]
struct TextId {
    uri: String,
}

/// Position in a text.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct At {
    text_document: TextId,
    position: Position,
}

/// A text without a position.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct OfText {
    text_document: TextId,
}

type Reply = Result<Value, RpcError>;

impl Server {
    fn serve(mut self, input: &mut impl std::io::BufRead) -> Outcome {
        let outcome = loop {
            match read_message(input, MessageFormat::Headers) {
                Ok(Some(Message::Notification { method, .. })) if method == "exit" => {
                    // `exit` without `shutdown` is an error of the editor.
                    break if self.phase == Phase::ShutDown { Outcome::Done } else { Outcome::FellShort };
                }
                Ok(Some(message)) => self.message(message),
                Ok(None) => {
                    break if self.phase == Phase::ShutDown { Outcome::Done } else { Outcome::FellShort };
                }
                Err(error) => {
                    text::complain(&text::error(
                        "HP0607",
                        "the input cannot be read",
                        &error.to_string(),
                        "write messages with `Content-Length`, as editors do",
                    ));
                    break Outcome::Misunderstood;
                }
            }
        };
        self.checker.end();
        outcome
    }

    fn message(&mut self, message: Message) {
        match message {
            Message::Request { id, method, params } => {
                let reply = catch_unwind(AssertUnwindSafe(|| self.request(&method, params)));
                let reply = reply.unwrap_or_else(|_| {
                    let message = "an internal error of Hardpoint; stderr has the details";
                    Err(RpcError::new(RpcError::INTERNAL, message))
                });
                self.output.answer(&id, reply);
            }
            Message::Notification { method, params } => {
                if self.phase == Phase::Initialized
                    && let Err(error) = self.notification(&method, params)
                {
                    let message = format!("{method}: {}", error.message);
                    self.output.notify("window/logMessage", &json!({ "type": 1, "message": message }));
                }
            }
            Message::Answer => {}
            Message::Invalid { id, error } => self.output.answer(&id, Err(error)),
        }
    }

    fn request(&mut self, method: &str, params: Value) -> Reply {
        match (self.phase, method) {
            (Phase::New, "initialize") => {
                self.phase = Phase::Initialized;
                return Ok(initialize());
            }
            (Phase::New, _) => {
                let message = format!("`{method}` comes before `initialize`");
                return Err(RpcError::new(NOT_INITIALIZED, message));
            }
            (Phase::Initialized, "initialize") => {
                let message = "the server is initialized already";
                return Err(RpcError::new(RpcError::INVALID_REQUEST, message));
            }
            (Phase::ShutDown, _) => {
                return Err(RpcError::new(RpcError::INVALID_REQUEST, "the server is shut down"));
            }
            (Phase::Initialized, "shutdown") => {
                self.phase = Phase::ShutDown;
                return Ok(Value::Null);
            }
            (Phase::Initialized, _) => {}
        }
        match method {
            "textDocument/completion" => self.completion(params_of(params)?),
            "textDocument/hover" => self.hover(params_of(params)?),
            "textDocument/definition" => self.definition(params_of(params)?),
            "textDocument/references" => self.references(params),
            "textDocument/documentHighlight" => self.highlights(params_of(params)?),
            "textDocument/prepareRename" => self.prepare_rename(params_of(params)?),
            "textDocument/rename" => self.rename(params),
            "textDocument/documentSymbol" => self.symbols(params_of(params)?),
            "textDocument/codeAction" => self.code_actions(params),
            _ => Err(RpcError::unknown_method(method)),
        }
    }

    fn notification(&mut self, method: &str, params: Value) -> Result<(), RpcError> {
        match method {
            "textDocument/didOpen" => {
                #[derive(Deserialize)]
                #[serde(rename_all = "camelCase")]
                struct Opened {
                    text_document: Item,
                }
                #[derive(Deserialize)]
                struct Item {
                    uri: String,
                    version: i64,
                    text: String,
                }
                let Opened { text_document: Item { uri, version, text } } = params_of(params)?;
                self.set(&uri, &text, version);
            }
            "textDocument/didChange" => {
                #[derive(Deserialize)]
                #[serde(rename_all = "camelCase")]
                struct Changed {
                    text_document: Versioned,
                    content_changes: Vec<Change>,
                }
                #[derive(Deserialize)]
                struct Versioned {
                    uri: String,
                    version: i64,
                }
                #[derive(Deserialize)]
                struct Change {
                    range: Option<TextRange>,
                    text: String,
                }
                let Changed { text_document: Versioned { uri, version }, content_changes } =
                    params_of(params)?;
                let mut text = self.text(&uri)?.document.text().to_owned();
                for Change { range, text: new } in content_changes {
                    match range {
                        None => text = new,
                        Some(TextRange { start, end }) => {
                            let lines = Lines::of(&text);
                            let [start, end] = [start, end].map(|at| lines.byte(&text, at));
                            text.replace_range(start..end.max(start), &new);
                        }
                    }
                }
                self.set(&uri, &text, version);
            }
            "textDocument/didClose" => {
                let OfText { text_document } = params_of(params)?;
                self.open.remove(&text_document.uri);
                self.checker.check(&text_document.uri, &self.open);
            }
            "textDocument/didSave" | "workspace/didChangeWatchedFiles" => {
                // Other files may be parts of the open ones.
                for uri in self.open.keys() {
                    self.checker.check(uri, &self.open);
                }
            }
            // `initialized`, settings, traces, cancellation of requests that are answered at once.
            _ => {}
        }
        Ok(())
    }

    fn set(&mut self, uri: &str, text: &str, version: i64) {
        if OpenText::is_too_large(text) {
            self.open.remove(uri);
            let message = format!("{uri} is too large for the editor; use `hardpoint check`");
            self.output.notify("window/showMessage", &json!({ "type": 2, "message": message }));
            return;
        }
        self.open.insert(uri.to_owned(), Arc::new(OpenText::new(text, version)));
        self.checker.check(uri, &self.open);
    }

    fn text(&self, uri: &str) -> Result<Arc<OpenText>, RpcError> {
        let found = self.open.get(uri).cloned();
        found.ok_or_else(|| RpcError::invalid(format!("the text `{uri}` is not open")))
    }

    /// Text of a request, and the byte of its position.
    fn at(&self, at: &At) -> Result<(Arc<OpenText>, usize), RpcError> {
        let text = self.text(&at.text_document.uri)?;
        let byte = text.lines.byte(text.document.text(), at.position);
        Ok((text, byte))
    }

    fn completion(&self, asked: At) -> Reply {
        let (text, byte) = self.at(&asked)?;
        let (document, lines) = (&text.document, &text.lines);
        let models = self.checker.models.lock().unwrap_or_else(PoisonError::into_inner);
        let model = models.get(&asked.text_document.uri).map(|file| &file.model);
        let items = document.completions(byte, model).into_iter().enumerate().map(|(k, c)| {
            let range = lines.range(document.text(), &c.replaces);
            json!({
                "label": c.label,
                "kind": match c.kind {
                    CompletionKind::Table => 9,
                    CompletionKind::Key => 10,
                    CompletionKind::Name => 6,
                    CompletionKind::Word => 12,
                },
                "detail": c.detail,
                "documentation": { "kind": "markdown", "value": c.meaning },
                // In the order of the format, or of the text.
                "sortText": format!("{k:05}"),
                "filterText": document.text()[c.replaces.clone()].strip_prefix('"').map_or(c.label.clone(), |_| format!("\"{}", c.label)),
                "textEdit": { "range": range, "newText": c.insert },
            })
        });
        Ok(json!({ "isIncomplete": false, "items": items.collect::<Vec<_>>() }))
    }

    fn hover(&self, asked: At) -> Reply {
        let (text, byte) = self.at(&asked)?;
        let document = &text.document;
        let shown = |at: &Range<usize>, value: String| {
            json!({
                "contents": { "kind": "markdown", "value": value },
                "range": text.lines.range(document.text(), at),
            })
        };
        if let Some(name) = document.name_at(byte) {
            let mut value = format!("**{}** — `[{}]`", name.name, name.section);
            let models = self.checker.models.lock().unwrap_or_else(PoisonError::into_inner);
            if let Some(file) = models.get(&asked.text_document.uri) {
                // The variables of a point have names of their own.
                let written = &document.text()[name.at.clone()];
                let own = entry::lines(file, name.section, &name.name);
                let lines = if own.is_empty() { entry::lines(file, name.section, written) } else { own };
                lines.iter().for_each(|line| value += &format!("\n\n{line}"));
            }
            return Ok(shown(&name.at, value));
        }
        let Some(key) = document.meaning_at(byte) else { return Ok(Value::Null) };
        let mut value = format!("**{}**", key.name);
        if key.is_required {
            value += " (required)";
        }
        value += &format!("\n\n{}", key.meaning);
        if let Some(default) = &key.default {
            value += &format!("\n\nDefault: `{default}`");
        }
        if let Some(example) = &key.example {
            value += &format!("\n\nExample: `{example}`");
        }
        Ok(shown(&key.at, value))
    }

    fn definition(&self, asked: At) -> Reply {
        let (text, byte) = self.at(&asked)?;
        let uri = &asked.text_document.uri;
        if let Some(name) = text.document.name_at(byte) {
            let all = text.document.references(&name);
            let declared = all.into_iter().filter(|r| r.is_declaration);
            let places = declared.map(|r| location(uri, &text.lines, text.document.text(), &r.at));
            return Ok(places.collect());
        }
        let path = path_of(uri);
        let folder = path.as_deref().and_then(Path::parent).unwrap_or(Path::new(""));
        // A file that is included.
        let included = text.document.includes();
        if let Some(file) = included.iter().find(|i| i.at.contains(&byte)) {
            let start = Position { line: 0, character: 0 };
            let address = uri_of(&files::plain(&folder.join(&file.file)));
            return Ok(json!([{ "uri": address, "range": TextRange { start, end: start } }]));
        }
        // An entry of such a file.
        let Some((name, _)) = text.document.foreign_name_at(byte) else { return Ok(json!([])) };
        let mut places = Vec::new();
        for file in &included {
            let path = files::plain(&folder.join(&file.file));
            let Some(content) = text_of(&self.open, &path) else { continue };
            let there = Document::new(&content);
            let base = name.split('.').next().unwrap_or(name);
            for name in [name, base] {
                let own = name.strip_prefix(&file.prefix).filter(|own| !file.shared.iter().any(|s| s == own));
                let Some(own) = own.or_else(|| file.shared.iter().any(|s| s == name).then_some(name)) else {
                    continue;
                };
                let lines = Lines::of(&content);
                for (_, at) in there.declarations(own) {
                    places.push(location(&uri_of(&path), &lines, &content, &at));
                }
                if !places.is_empty() {
                    break;
                }
            }
        }
        Ok(places.into())
    }

    fn references(&self, params: Value) -> Reply {
        #[derive(Deserialize)]
        #[serde(rename_all = "camelCase")]
        struct Context {
            include_declaration: bool,
        }
        #[derive(Deserialize)]
        struct Asked {
            context: Context,
            #[serde(flatten)]
            at: At,
        }
        let Asked { context, at } = params_of(params)?;
        let (text, byte) = self.at(&at)?;
        let Some(name) = text.document.name_at(byte) else { return Ok(json!([])) };
        let found = text.document.references(&name);
        let found = found.into_iter().filter(|r| context.include_declaration || !r.is_declaration);
        let uri = &at.text_document.uri;
        Ok(found.map(|r| location(uri, &text.lines, text.document.text(), &r.at)).collect())
    }

    fn highlights(&self, asked: At) -> Reply {
        let (text, byte) = self.at(&asked)?;
        let Some(name) = text.document.name_at(byte) else { return Ok(Value::Null) };
        let one =
            |at: &Range<usize>| json!({ "range": text.lines.range(text.document.text(), at), "kind": 1 });
        Ok(text.document.references(&name).iter().map(|r| one(&r.at)).collect())
    }

    fn prepare_rename(&self, asked: At) -> Reply {
        let (text, byte) = self.at(&asked)?;
        let found = text.document.renameable_at(byte);
        let NameAt { name, at, .. } = found.map_err(|why| RpcError::new(REQUEST_FAILED, why.0))?;
        Ok(json!({ "range": text.lines.range(text.document.text(), &at), "placeholder": name }))
    }

    fn rename(&self, params: Value) -> Reply {
        #[derive(Deserialize)]
        #[serde(rename_all = "camelCase")]
        struct Asked {
            new_name: String,
            #[serde(flatten)]
            at: At,
        }
        let Asked { new_name, at } = params_of(params)?;
        let (text, byte) = self.at(&at)?;
        let uri = &at.text_document.uri;
        let path = path_of(uri);
        let edits = text.document.rename(byte, &new_name, path.as_deref().and_then(Path::parent));
        let edits = edits.map_err(|why| RpcError::new(REQUEST_FAILED, why.0))?;
        let one = |(at, new): (Range<usize>, String)| json!({ "range": text.lines.range(text.document.text(), &at), "newText": new });
        let edits: Vec<Value> = edits.into_iter().map(one).collect();
        Ok(json!({ "changes": { uri: edits } }))
    }

    fn symbols(&self, asked: OfText) -> Reply {
        let text = self.text(&asked.text_document.uri)?;
        let (lines, content) = (&text.lines, text.document.text());
        fn one(symbol: &hardpoint_file::Symbol, lines: &Lines, content: &str) -> Value {
            json!({
                "name": symbol.name,
                "detail": symbol.detail,
                "kind": kind_of(symbol.section, symbol.children.is_empty()),
                "range": lines.range(content, &symbol.whole),
                "selectionRange": lines.range(content, &symbol.at),
                "children": symbol.children.iter().map(|s| one(s, lines, content)).collect::<Vec<_>>(),
            })
        }
        Ok(text.document.symbols().iter().map(|s| one(s, lines, content)).collect())
    }

    fn code_actions(&self, params: Value) -> Reply {
        #[derive(Deserialize)]
        struct Context {
            diagnostics: Vec<Value>,
        }
        #[derive(Deserialize)]
        #[serde(rename_all = "camelCase")]
        struct Asked {
            text_document: TextId,
            context: Context,
        }
        let Asked { text_document, context } = params_of(params)?;
        let action = |diagnostic: &Value| {
            let data = diagnostic.get("data")?;
            let by = data.get("by")?.as_str()?;
            let edit = json!({ "range": data.get("replace")?, "newText": by });
            Some(json!({
                "title": format!("Replace by `{by}`"),
                "kind": "quickfix",
                "diagnostics": [diagnostic],
                "isPreferred": true,
                "edit": { "changes": { text_document.uri.clone(): [edit] } },
            }))
        };
        Ok(context.diagnostics.iter().filter_map(action).collect())
    }
}

fn initialize() -> Value {
    let version = GENERATOR.rsplit(' ').next().unwrap_or_default();
    json!({
        "capabilities": {
            "positionEncoding": "utf-16",
            "textDocumentSync": { "openClose": true, "change": INCREMENTAL, "save": {} },
            "completionProvider": { "triggerCharacters": ["\"", "[", ".", "{", ",", "=", " "] },
            "hoverProvider": true,
            "definitionProvider": true,
            "referencesProvider": true,
            "documentHighlightProvider": true,
            "documentSymbolProvider": true,
            "renameProvider": { "prepareProvider": true },
            "codeActionProvider": { "codeActionKinds": ["quickfix"] },
        },
        "serverInfo": { "name": "hardpoint", "version": version },
    })
}

fn location(uri: &str, lines: &Lines, text: &str, at: &Range<usize>) -> Value {
    json!({ "uri": uri, "range": lines.range(text, at) })
}

/// Kind of a symbol, by the section of an entry.
fn kind_of(section: Option<&str>, is_leaf: bool) -> u8 {
    let [module, class, property, function, constant, object, event] = [2, 5, 7, 12, 14, 19, 24];
    match section {
        Some("bodies") => class,
        Some("hardpoints" | "parameters" | "points") => constant,
        Some("measures" | "metrics") => function,
        Some("cases") => event,
        Some(_) => object,
        None if is_leaf => property,
        None => module,
    }
}
