//! Server of the tools: its requests, and its answers.

use super::collector::{Collector, locked};
use super::{resources, tools};
use crate::meter::Listener;
use crate::outcome::Outcome;
use crate::rpc::{Message, MessageFormat, Output, RpcError, params_of, read_message};
use crate::session::Session;
use crate::text;
use hardpoint_report::GENERATOR;
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::io::BufReader;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Protocol revisions with a handshake, the newest first.
const HANDSHAKE_VERSIONS: [&str; 4] = ["2025-11-25", "2025-06-18", "2025-03-26", "2024-11-05"];

/// Protocol revision whose requests carry their version.
const REQUEST_VERSION: &str = "2026-07-28";

/// Keys of such requests.
const VERSION_KEY: &str = "io.modelcontextprotocol/protocolVersion";

const CAPABILITIES_KEY: &str = "io.modelcontextprotocol/clientCapabilities";

const SERVER_KEY: &str = "io.modelcontextprotocol/serverInfo";

/// Error codes of the protocol.
const UNSUPPORTED_VERSION: i64 = -32022;

const NOT_INITIALIZED: i64 = -32002;

const BUSY: i64 = -32000;

/// Time for which clients may store lists, in ms: they are those of the program.
const STORED: u64 = 3_600_000;

/// Maximum number of tools that run at the same time; each study uses all cores.
const AT_ONCE: usize = 4;

/// Duration for which running tools may end by themselves after the end of stdin.
const GRACE: Duration = Duration::from_secs(2);

const INSTRUCTIONS: &str = "Hardpoint solves the motion of mechanisms (suspensions, linkages, parallel robots) and \
differentiates it exactly with respect to the design. A model is a TOML file: give tools its `path`, or its `text`. \
Begin with `new_model` or a model of the user, correct it with `check` until it has no errors, then `run` it. \
`what_if` answers what a change of hardpoints does; `optimize`, `tolerance` and `sweep` use the tables of the same name \
in the model. Every number has its unit next to it, or that of `units`; times are in s. The resource \
`hardpoint://docs/file-format.md` describes every key of a model, `hardpoint://docs/measures.md` all measures, and \
`explain` a diagnostic by its code.";

/// Serves stdin until its end.
pub fn run() -> Outcome {
    text::reserve_stdout();
    let server = Server {
        output: Output::new(std::io::stdout(), MessageFormat::Lines),
        running: Arc::default(),
        phase: Phase::New,
    };
    let outcome = server.serve(&mut BufReader::new(std::io::stdin()));
    Session::not_printed(outcome)
}

/// Phase of the connection.
#[derive(Clone, Copy, PartialEq)]
enum Phase {
    /// Before `initialize`.
    New,
    /// After `initialize`.
    Initialized,
}

/// Tools that run, by their requests, with the flags that cancel them.
type Running = Arc<Mutex<HashMap<String, Arc<AtomicBool>>>>;

struct Server {
    output: Output,
    running: Running,
    phase: Phase,
}

/// Era of a request.
#[derive(Clone, Copy, PartialEq)]
enum Era {
    Handshake,
    PerRequest,
}

impl Server {
    fn serve(mut self, input: &mut impl std::io::BufRead) -> Outcome {
        let outcome = loop {
            match read_message(input, MessageFormat::Lines) {
                Ok(Some(message)) => self.message(message),
                Ok(None) => break Outcome::Done,
                Err(error) => {
                    text::complain(&text::error(
                        "HP0607",
                        "the input cannot be read",
                        &error.to_string(),
                        "write one JSON-RPC message on each line",
                    ));
                    break Outcome::Misunderstood;
                }
            }
        };
        let ended = Instant::now();
        while !locked(&self.running).is_empty() {
            if ended.elapsed() > GRACE {
                locked(&self.running).values().for_each(|flag| flag.store(true, Ordering::SeqCst));
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        outcome
    }

    fn message(&mut self, message: Message) {
        match message {
            Message::Request { id, method, params } => self.request(id, &method, params),
            Message::Notification { method, params } => {
                if method == "notifications/cancelled"
                    && let Some(id) = params.get("requestId")
                    && let Some(flag) = locked(&self.running).get(&id.to_string())
                {
                    flag.store(true, Ordering::SeqCst);
                }
            }
            Message::Answer => {}
            Message::Invalid { id, error } => self.output.answer(&id, Err(error)),
        }
    }

    fn request(&mut self, id: Value, method: &str, params: Value) {
        let era = match era(&params) {
            Ok(era) => era,
            Err(error) => return self.output.answer(&id, Err(error)),
        };
        if method == "tools/call" && (era == Era::PerRequest || self.phase == Phase::Initialized) {
            return self.call(id, era, params);
        }
        let result = self.answer(era, method, params);
        self.output.answer(&id, result.map(|result| in_era(result, era)));
    }

    fn answer(&mut self, era: Era, method: &str, params: Value) -> Result<Value, RpcError> {
        match method {
            "initialize" if self.phase == Phase::New => {
                let result = initialize(params)?;
                self.phase = Phase::Initialized;
                return Ok(result);
            }
            "initialize" => {
                return Err(RpcError::new(
                    RpcError::INVALID_REQUEST,
                    "the connection is initialized already",
                ));
            }
            "ping" => return Ok(json!({})),
            _ => {}
        }
        if era == Era::Handshake && self.phase == Phase::New {
            return Err(RpcError::new(NOT_INITIALIZED, format!("`{method}` comes before `initialize`")));
        }
        match method {
            "server/discover" => Ok(json!({
                "supportedVersions": [REQUEST_VERSION],
                "capabilities": capabilities(),
                "instructions": INSTRUCTIONS,
                "_meta": { SERVER_KEY: server_info() },
            })),
            "tools/list" => Ok(json!({ "tools": tools::list() })),
            "resources/list" => Ok(json!({ "resources": resources::list() })),
            "resources/templates/list" => Ok(json!({ "resourceTemplates": [] })),
            "resources/read" => {
                #[derive(Deserialize)]
                struct Asked {
                    uri: String,
                }
                let Asked { uri } = params_of(params)?;
                let missing = || {
                    let code = match era {
                        Era::Handshake => NOT_INITIALIZED,
                        Era::PerRequest => RpcError::INVALID_PARAMS,
                    };
                    let error = RpcError::new(code, format!("there is no resource `{uri}`"));
                    RpcError { data: Some(json!({ "uri": uri })), ..error }
                };
                resources::read(&uri).map(|content| json!({ "contents": [content] })).ok_or_else(missing)
            }
            _ => Err(RpcError::unknown_method(method)),
        }
    }

    /// Runs a tool in a thread of its own.
    fn call(&self, id: Value, era: Era, params: Value) {
        #[derive(Deserialize)]
        struct Asked {
            name: String,
            #[serde(default)]
            arguments: Value,
            #[serde(rename = "_meta", default)]
            meta: Value,
        }
        let asked: Asked = match params_of(params) {
            Ok(asked) => asked,
            Err(error) => return self.output.answer(&id, Err(error)),
        };
        let tool = match tools::named(&asked.name) {
            Some(tool) => tool,
            None => {
                let names: Vec<&str> = tools::TOOLS.iter().map(|t| t.name).collect();
                let message =
                    format!("there is no tool `{}`; the tools are {}", asked.name, names.join(", "));
                return self.output.answer(&id, Err(RpcError::invalid(message)));
            }
        };
        let key = id.to_string();
        let flag = Arc::new(AtomicBool::new(false));
        {
            let mut running = locked(&self.running);
            if running.len() >= AT_ONCE {
                let message = format!("{AT_ONCE} tools run already; wait for one of them, or cancel it");
                return self.output.answer(&id, Err(RpcError::new(BUSY, message)));
            }
            if running.insert(key.clone(), Arc::clone(&flag)).is_some() {
                let message = "a request with this `id` is running";
                return self.output.answer(&id, Err(RpcError::new(RpcError::INVALID_REQUEST, message)));
            }
        }
        let (output, running) = (self.output.clone(), Arc::clone(&self.running));
        let token = asked.meta.get("progressToken").cloned();
        let work = move || {
            let collector = Arc::new(Collector::new(output.clone(), token));
            let listener = Arc::clone(&collector) as Arc<dyn Listener>;
            let session = Session::for_agent(listener, Arc::clone(&flag));
            let call = || tools::call(tool, &session, &collector, asked.arguments);
            let result = catch_unwind(AssertUnwindSafe(call)).unwrap_or_else(|_| {
                Err(RpcError::new(
                    RpcError::INTERNAL,
                    "an internal error of Hardpoint; stderr has the details",
                ))
            });
            locked(&running).remove(&id.to_string());
            // A cancelled request has no answer.
            if !flag.load(Ordering::SeqCst) {
                output.answer(&id, result.map(|result| in_era(result, era)));
            }
        };
        let begun = std::thread::Builder::new().name(format!("tool {key}")).spawn(work);
        if let Err(error) = begun {
            locked(&self.running).remove(&key);
            text::complain(&format!("the tool could not be started: {error}\n"));
        }
    }
}

/// Era of a request, by its `_meta`.
fn era(params: &Value) -> Result<Era, RpcError> {
    let Some(version) = params.get("_meta").and_then(|meta| meta.get(VERSION_KEY)) else {
        return Ok(Era::Handshake);
    };
    let Some(version) = version.as_str() else {
        return Err(RpcError::invalid(format!("`{VERSION_KEY}` must be a text")));
    };
    if version != REQUEST_VERSION {
        let message = format!("protocol version `{version}` is not supported");
        let data = json!({ "supported": [REQUEST_VERSION], "requested": version });
        return Err(RpcError { data: Some(data), ..RpcError::new(UNSUPPORTED_VERSION, message) });
    }
    if params["_meta"].get(CAPABILITIES_KEY).is_none() {
        return Err(RpcError::invalid(format!("`_meta` has no `{CAPABILITIES_KEY}`")));
    }
    Ok(Era::PerRequest)
}

/// Adds the keys that results have in an era.
fn in_era(mut result: Value, era: Era) -> Value {
    if era == Era::PerRequest {
        result["resultType"] = "complete".into();
        if result.get("content").is_none() {
            result["ttlMs"] = STORED.into();
            result["cacheScope"] = "public".into();
        }
    }
    result
}

fn initialize(params: Value) -> Result<Value, RpcError> {
    #[derive(Deserialize)]
    #[serde(rename_all = "camelCase")]
    struct Asked {
        protocol_version: String,
    }
    let Asked { protocol_version } = params_of(params)?;
    let known = HANDSHAKE_VERSIONS.iter().find(|v| **v == protocol_version);
    Ok(json!({
        "protocolVersion": known.unwrap_or(&HANDSHAKE_VERSIONS[0]),
        "capabilities": capabilities(),
        "serverInfo": server_info(),
        "instructions": INSTRUCTIONS,
    }))
}

fn capabilities() -> Value {
    json!({ "tools": {}, "resources": {} })
}

fn server_info() -> Value {
    let version = GENERATOR.rsplit(' ').next().unwrap_or_default();
    json!({ "name": "hardpoint", "title": "Hardpoint", "version": version })
}
