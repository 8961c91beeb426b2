//! Tools for agents. Each runs a command and returns its JSON document in brief.

use std::collections::BTreeMap;
use std::num::NonZero;
use std::path::{Path, PathBuf};

use hardpoint::model::OptimizationSettings;
use hardpoint::topology::Formulation;
use hardpoint_file::ModelFile;
use hardpoint_report::ranges::RangeFact;
use serde::Deserialize;
use serde_json::{Value, json};

use crate::args::{
    Allocate, Common, Import, Method, Motions, Optimize, Sweep, Synthesize, Tolerance, Whatif,
};
use crate::folder::write_new;
use crate::new::{TEMPLATES, template_named};
use crate::outcome::Outcome;
use crate::rpc::{RpcError, params_of};
use crate::session::Session;
use crate::{check, import, optimize, sweep, synthesize, tolerance, whatif};

use super::Collector;
use super::brief::{brief, largest, only};
use super::resources::document;
use super::schema::{any_object, arguments, count, flag, list as list_of, may, must, object, one_of, text};

/// Code of a design that the text of the model does not support.
const NOT_SAVED: &str = "HP0505";
/// Variables of each unit in a ranking, by default.
const MOST: usize = 5;

/// A tool.
pub struct Tool {
    pub name: &'static str,
    title: &'static str,
    about: &'static str,
    /// True if it writes no file.
    is_read_only: bool,
    arguments: fn() -> Value,
    result: fn() -> Value,
    call: fn(&Session, &Collector, Value) -> Result<Reply, RpcError>,
}

/// Result of a tool: its structure, or errors as text for the agent.
type Reply = Result<Value, String>;

/// All tools.
pub static TOOLS: &[Tool] = &[
    Tool {
        name: "check",
        title: "Check a model",
        about: "Check a model: errors with their positions and fixes, degrees of freedom, joints, redundant \
                constraints, admissibility of the design variables, margin to singular positions, warnings. Use it after \
                every change of a model's text.",
        is_read_only: true,
        arguments: || arguments(model_keys(vec![])),
        result: || {
            cases_result(
                "Facts of the mechanism in each case: counts, bodies, joints, drivers, variables, measures",
            )
        },
        call: |session, collector, given| {
            let Asked { model, case, .. } = params_of(given)?;
            of_model(model, |path| {
                let options = crate::args::Check { common: common(path), motions: Motions { case } };
                let each = |file: ModelFile, _: Option<&str>| check::check_in(session, &options, &file);
                let outcome = session.for_motions(path, &options.motions, each);
                in_cases(collector, outcome, |document| facts_of(document).into())
            })
        },
    },
    Tool {
        name: "run",
        title: "Solve the motion",
        about: "Solve the motion with exact sensitivities: range of every measure, metrics with their most influential \
                variables, largest sensitivities of every measure, joint limits, margin to singular positions, warnings.",
        is_read_only: true,
        arguments: || {
            arguments(model_keys(vec![
                may("measures", list_of(text()), "Names of the measures to report. Default: all"),
                may("variables", count(0), "Number of variables of each unit in every ranking. Default: 5"),
                may(
                    "rates",
                    flag(),
                    "True for sensitivities of rates and accelerations, too. Default: false",
                ),
            ]))
        },
        result: || cases_result("Ranges, metrics and sensitivities of each case"),
        call: |session, collector, given| {
            let Asked { model, case, measures, variables, rates, .. } = params_of(given)?;
            of_model(model, |path| {
                let each = |file: ModelFile, _: Option<&str>| {
                    session.check_measures(&file, &measures)?;
                    solve(session, &file)
                };
                let outcome = session.for_motions(path, &Motions { case }, each);
                let most = variables.unwrap_or(MOST);
                in_cases(collector, outcome, |document| results_of(document, &measures, most, rates))
            })
        },
    },
    Tool {
        name: "what_if",
        title: "Change the design",
        about: "Change hardpoints, parameters or other design variables and solve again: range of every measure before and \
                after, largest change, quality of the linear prediction, metrics before and after. Without changes it \
                ranks the variables by their influence on each measure.",
        is_read_only: false,
        arguments: || {
            let change = json!({ "type": ["number", "string"] });
            arguments(model_keys(vec![
                may(
                    "changes",
                    json!({ "type": "object", "additionalProperties": change }),
                    "Changes by name of a design variable, of a hardpoint coordinate (`tie_rod_outer.z`) or of a joint's \
                     tilt (`hinge.tilt_x`): a number in the unit of the model, or a text with its unit, like `\"+2 mm\"`",
                ),
                may("measures", list_of(text()), "Names of the measures to report. Default: all"),
                may("variables", count(0), "Number of variables of each unit in every ranking. Default: 5"),
                may(
                    "admissible",
                    flag(),
                    "True for the nearest change that keeps all joints closed. Default: false",
                ),
                may(
                    "save",
                    text(),
                    "File for the changed model; comments and layout are kept. Default: not saved",
                ),
            ]))
        },
        result: || cases_result("Measures and metrics of each case, nominal (`today`) and changed (`exact`)"),
        call: |session, collector, given| {
            let Asked { model, case, measures, variables, changes, admissible, save, .. } = params_of(given)?;
            let set: Vec<String> = changes.iter().map(|(name, by)| format!("{name}={by}")).collect();
            of_model(model, |path| {
                let options = Whatif {
                    common: common(path),
                    motions: Motions { case },
                    set,
                    admissible,
                    measure: measures.clone(),
                    save,
                    ..Whatif::default()
                };
                let each =
                    |file: ModelFile, case: Option<&str>| whatif::whatif_in(session, &options, file, case);
                let outcome = session.for_motions(path, &options.motions, each);
                let most = variables.unwrap_or(MOST);
                in_cases(collector, outcome, |document| changes_of(document, &measures, most))
            })
        },
    },
    Tool {
        name: "optimize",
        title: "Optimise the design",
        about: "Optimise the design for the goals in `[optimize]` of the model, within the bounds of its variables and its \
                limits. Reports goals, limits and variables before and after, and whether the optimum is proven to first \
                order.",
        is_read_only: false,
        arguments: || {
            arguments(model_keys(vec![
                may("starts", count(1), "Number of start designs. Default: that of the model, or 1"),
                may(
                    "other_assemblies",
                    flag(),
                    "True to start from the other assemblies of the mechanism too",
                ),
                may("both_senses", flag(), "True to start with all drivers in the opposite sense too"),
                may(
                    "iterations",
                    count(1),
                    &format!(
                        "Maximum number of iterations of a search. Default: that of the model, or {}",
                        OptimizationSettings::ITERATIONS
                    ),
                ),
                may(
                    "save",
                    text(),
                    "File for the optimised model; comments and layout are kept. Default: not saved",
                ),
            ]))
        },
        result: || {
            study_result(
                "goals, limits, variables and hardpoints before and after; `optimised_text` for a model given as text",
            )
        },
        call: |session, collector, given| {
            let asked: Asked = params_of(given)?;
            let Asked { model, case, starts, iterations, save, other_assemblies, both_senses, .. } = asked;
            let is_text = model.text.is_some();
            of_model(model, |path| {
                let mut options = Optimize {
                    common: common(path),
                    motions: Motions { case },
                    save,
                    starts,
                    other_assemblies,
                    both_senses,
                    iterations,
                    ..Optimize::default()
                };
                let run = |options: &Optimize| {
                    study(collector, optimize::optimize_in(session, options), &["iterations"])
                };
                if !is_text || options.save.is_some() {
                    return run(&options);
                }
                // An agent that gave a text gets the text of the optimised model, if the text supports it.
                let found = path.with_file_name("optimised.toml");
                options.save = Some(found.clone());
                match run(&options) {
                    Ok(mut reply) => {
                        if let Ok(text) = std::fs::read_to_string(&found) {
                            reply["optimised_text"] = text.into();
                        }
                        Ok(reply)
                    }
                    Err(why) if why.contains(NOT_SAVED) => {
                        options.save = None;
                        let mut reply = run(&options)?;
                        reply["not_saved"] = why.into();
                        Ok(reply)
                    }
                    Err(why) => Err(why),
                }
            })
        },
    },
    Tool {
        name: "tolerance",
        title: "Analyse tolerances",
        about: "Analyse how tolerances of the design variables (`[tolerance]` of the model, or their `tolerance`) affect the \
                metrics: worst case, standard deviation, yield, contributions, loosest tolerances.",
        is_read_only: true,
        arguments: || {
            arguments(model_keys(vec![
                may(
                    "samples",
                    count(0),
                    "Number of designs that are drawn and solved exactly, 0 for none. Default: 10000",
                ),
                may("seed", count(1), "Seed of the random numbers. Default: 1"),
                may(
                    "allocate",
                    one_of(&["rss", "worst_case"]),
                    "Allocates the loosest tolerances that keep the limits",
                ),
            ]))
        },
        result: || study_result("metrics with their spread, contributions and yield"),
        call: |session, collector, given| {
            let Asked { model, case, samples, seed, allocate, .. } = params_of(given)?;
            of_model(model, |path| {
                let options = Tolerance {
                    common: common(path),
                    motions: Motions { case },
                    samples,
                    seed,
                    allocate,
                    ..Tolerance::default()
                };
                study(collector, tolerance::tolerance_in(session, &options), &[])
            })
        },
    },
    Tool {
        name: "sweep",
        title: "Sweep over designs",
        about: "Solve many designs within the ranges of the variables (`[sweep]` of the model, their `bounds`, or `ranges`): \
                distribution of the metrics, best designs, influence of each variable. The model needs metrics.",
        is_read_only: true,
        arguments: || {
            let range =
                json!({ "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 });
            arguments(model_keys(vec![
                may("samples", count(1), "Number of designs. Default: that of the model, or 1000"),
                may("seed", count(1), "Seed of the random numbers. Default: 1"),
                may(
                    "method",
                    one_of(&["factorial", "latin_hypercube", "sobol", "sobol_indices"]),
                    "Choice of the designs. Default: that of the model, or sobol",
                ),
                may(
                    "ranges",
                    json!({ "type": "object", "additionalProperties": range }),
                    "Range of each variable, [from, to]: values of parameters, changes of all others, in the unit of the model",
                ),
            ]))
        },
        result: || {
            study_result("metrics over all designs, the best designs, and the influence of each variable")
        },
        call: |session, collector, given| {
            let Asked { model, case, samples, seed, method, ranges, .. } = params_of(given)?;
            let range = ranges.iter().map(|(name, [from, to])| format!("{name}={from}..{to}")).collect();
            of_model(model, |path| {
                let options = Sweep {
                    common: common(path),
                    motions: Motions { case },
                    samples,
                    seed,
                    method,
                    range,
                    ..Sweep::default()
                };
                study(collector, sweep::sweep_in(session, &options), &[])
            })
        },
    },
    Tool {
        name: "synthesize",
        title: "Find linkages",
        about: "Find planar four-bars and slider-cranks for a task: three to five poses of a body, or points of a path \
                (`hardpoint://docs/synthesis.md` describes the task file). With `output`, writes a model of each.",
        is_read_only: false,
        arguments: || {
            arguments(vec![
                may("path", text(), "Task file (TOML)"),
                may("text", text(), "Task file as text, in place of `path`"),
                may("answers", count(1), "Number of answers. Default: that of the task, or 10"),
                may(
                    "output",
                    text(),
                    "Folder for the models and pages of the answers. Default: none are written",
                ),
            ])
        },
        result: || study_result("answers, the best first"),
        call: |session, collector, given| {
            let Asked { model, answers, output, .. } = params_of(given)?;
            of_source(model, hardpoint_file::TaskFile::parse, |path| {
                let options = Synthesize { task: path.to_owned(), output, answers, json: true };
                study(collector, synthesize::synthesize_in(session, &options), &[])
            })
        },
    },
    Tool {
        name: "explain",
        title: "Explain a diagnostic",
        about: "Explain a diagnostic by its code, such as HP0204: meaning, and remedy.",
        is_read_only: true,
        arguments: || arguments(vec![must("code", text(), "Code of the diagnostic, such as `HP0204`")]),
        result: || {
            object(vec![
                must("code", text(), "Code"),
                must("area", text(), "Area of the code"),
                must("meaning", text(), "Meaning, in Markdown"),
                must("remedy", text(), "Remedy, in Markdown"),
            ])
        },
        call: |_, _, given| {
            #[derive(Deserialize)]
            #[serde(deny_unknown_fields)]
            struct Code {
                code: String,
            }
            let Code { code } = params_of(given)?;
            Ok(explain(&code))
        },
    },
    Tool {
        name: "new_model",
        title: "Create a model from a template",
        about: "Return the text of a model from a template, with cases, measures, targets and variables; or, without \
                `template`, the list of templates. Change its hardpoints, and check it.",
        is_read_only: false,
        arguments: || {
            let names: Vec<&str> = TEMPLATES.iter().map(|t| t.name).collect();
            arguments(vec![
                may("template", one_of(&names), "Template. Default: the templates are listed"),
                may("name", text(), "Name of the model. Default: that of the template"),
                may("save", text(), "File for the model, which must not exist. Default: not saved"),
            ])
        },
        result: || {
            object(vec![
                may("templates", list_of(any_object()), "Names and descriptions of the templates"),
                may("name", text(), "Name of the model"),
                may("text", text(), "Text of the model"),
                may("saved", text(), "File of the model"),
            ])
        },
        call: |session, collector, given| {
            #[derive(Deserialize)]
            #[serde(deny_unknown_fields)]
            struct New {
                template: Option<String>,
                name: Option<String>,
                save: Option<PathBuf>,
            }
            let New { template, name, save } = params_of(given)?;
            Ok(new_model(session, collector, template.as_deref(), name, save.as_deref()))
        },
    },
    Tool {
        name: "import_model",
        title: "Import from another program",
        about: "Import a mechanism of another program (URDF, MJCF, SDF, Adams, Lotus, FreeCAD and others; \
                `hardpoint://docs/import.md` lists them) as a model file, and check it.",
        is_read_only: false,
        arguments: || {
            arguments(vec![
                must("source", text(), "File of the other program"),
                must("output", text(), "Model file to write (TOML)"),
                may("format", text(), "Format. Default: from the contents"),
            ])
        },
        result: || {
            object(vec![
                must("status", text(), "`complete`, or `stopped` if the motion of the model ends early"),
                must("model", text(), "Model file"),
                must("report", json!({}), "Unsupported elements of the source"),
                may("check", any_object(), "Facts of the model"),
            ])
        },
        call: |session, collector, given| {
            #[derive(Deserialize)]
            #[serde(deny_unknown_fields)]
            struct Source {
                source: PathBuf,
                output: PathBuf,
                format: Option<String>,
            }
            let Source { source, output, format } = params_of(given)?;
            let options = Import { format, json: true, ..Import::default() };
            let outcome = import::import_to(session, &options, &source, &output);
            let mut document = match documents(collector, outcome) {
                Ok(mut documents) => documents.remove(0),
                Err(why) => return Ok(Err(why)),
            };
            document["check"] = facts_of(&document["check"]).into();
            Ok(Ok(brief(&document)))
        },
    },
];

/// Tool of that name.
pub fn named(name: &str) -> Option<&'static Tool> {
    TOOLS.iter().find(|tool| tool.name == name)
}

/// Descriptions of the tools.
pub fn list() -> Vec<Value> {
    let one = |tool: &Tool| {
        json!({
            "name": tool.name,
            "title": tool.title,
            "description": tool.about,
            "inputSchema": (tool.arguments)(),
            "outputSchema": (tool.result)(),
            "annotations": {
                "title": tool.title, "readOnlyHint": tool.is_read_only, "destructiveHint": false,
                "idempotentHint": true, "openWorldHint": false,
            },
        })
    };
    TOOLS.iter().map(one).collect()
}

/// Calls a tool.
///
/// # Errors
/// Fails if the arguments have other keys or types than declared. Errors of a model are results.
pub fn call(tool: &Tool, session: &Session, collector: &Collector, given: Value) -> Result<Value, RpcError> {
    let given = if given.is_null() { json!({}) } else { given };
    let known = (tool.arguments)();
    let unknown = given.as_object().into_iter().flatten().map(|(key, _)| key);
    let mut unknown = unknown.filter(|key| known["properties"].get(key.as_str()).is_none());
    if let Some(key) = unknown.next() {
        let names: Vec<&String> =
            known["properties"].as_object().into_iter().flatten().map(|k| k.0).collect();
        let list: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        let message = format!("tool `{}` has no argument `{key}`; it has {}", tool.name, list.join(", "));
        return Err(RpcError::invalid(message));
    }
    Ok(match (tool.call)(session, collector, given)? {
        Ok(result) => json!({
            "content": [{ "type": "text", "text": result.to_string() }], "structuredContent": result, "isError": false,
        }),
        Err(why) => json!({ "content": [{ "type": "text", "text": why }], "isError": true }),
    })
}

/// Model that an agent gives: a file, or a text.
#[derive(Default, Deserialize)]
struct Model {
    path: Option<PathBuf>,
    text: Option<String>,
}

/// Arguments of the tools that have a model.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Asked {
    #[serde(flatten)]
    model: Model,
    case: Option<String>,
    measures: Vec<String>,
    variables: Option<usize>,
    rates: bool,
    changes: BTreeMap<String, Change>,
    admissible: bool,
    save: Option<PathBuf>,
    starts: Option<NonZero<usize>>,
    other_assemblies: bool,
    both_senses: bool,
    iterations: Option<NonZero<usize>>,
    samples: Option<u32>,
    seed: Option<u32>,
    allocate: Option<Allocate>,
    method: Option<Method>,
    ranges: BTreeMap<String, [f64; 2]>,
    answers: Option<NonZero<usize>>,
    output: Option<PathBuf>,
}

/// Change of a variable, in the unit of the model or with its unit.
#[derive(Deserialize)]
#[serde(untagged)]
enum Change {
    Number(f64),
    Text(String),
}

impl std::fmt::Display for Change {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(x) => x.fmt(f),
            Self::Text(text) => f.write_str(text),
        }
    }
}

fn common(path: &Path) -> Common {
    Common { model: path.to_owned(), json: true, ..Common::default() }
}

/// Keys of a model, before others.
fn model_keys(others: Vec<super::schema::Field>) -> Vec<super::schema::Field> {
    let mut fields = vec![
        may("path", text(), "Model file (TOML)"),
        may("text", text(), "Model as text, in place of `path`; it cannot name other files"),
        may("case", text(), "Case of the model. Default: all cases"),
    ];
    fields.extend(others);
    fields
}

/// Schema of a result for each case.
fn cases_result(about: &str) -> Value {
    let case = object(vec![
        may("case", text(), "Name of the case; absent for a model without cases"),
        may("name", text(), "Name of the mechanism"),
        may("status", text(), "`complete`, or `stopped` if the motion ends early: `stop` has the reason"),
        may("diagnostics", list_of(any_object()), "Warnings and notes, with `code`, `line` and `help`"),
    ]);
    object(vec![
        must("cases", list_of(case), about),
        may("problems", list_of(text()), "Cases without a result, with the reason"),
    ])
}

/// Schema of the result of a study.
fn study_result(about: &str) -> Value {
    object(vec![
        must("status", text(), "End of the study in a word"),
        must("study", text(), "Kind of study"),
        may("message", text(), &format!("Result in a sentence. Further keys: {about}")),
    ])
}

/// Calls a function with the file of a model.
fn of_model(model: Model, work: impl FnOnce(&Path) -> Reply) -> Result<Reply, RpcError> {
    of_source(model, hardpoint_file::parse, work)
}

/// Calls a function with a file. A text is read first, so that its errors have no file name of their own.
fn of_source<T>(
    model: Model,
    read: impl FnOnce(&str, &str) -> Result<T, hardpoint_file::Diagnostics>,
    work: impl FnOnce(&Path) -> Reply,
) -> Result<Reply, RpcError> {
    let text = match (model.path, model.text) {
        (Some(path), None) => return Ok(work(&path)),
        (None, Some(text)) => text,
        (None, None) => return Err(RpcError::invalid("give the model as `path` or as `text`")),
        (Some(_), Some(_)) => {
            return Err(RpcError::invalid("give the model as `path` or as `text`, not both"));
        }
    };
    if let Err(problems) = read(&text, "model.toml") {
        return Ok(Err(problems.render(false)));
    }
    let failed = |error: std::io::Error| {
        RpcError::new(RpcError::INTERNAL, format!("a temporary file cannot be written: {error}"))
    };
    let folder = tempfile::tempdir().map_err(failed)?;
    let path = folder.path().join("model.toml");
    std::fs::write(&path, text).map_err(failed)?;
    // The agent knows the model as `model.toml`.
    let own = folder.path().join("").display().to_string();
    Ok(match work(&path) {
        Ok(result) => Ok(without(&result, &own)),
        Err(why) => Err(why.replace(&own, "")),
    })
}

/// Removes a path from all texts of a result.
fn without(value: &Value, path: &str) -> Value {
    match value {
        Value::String(text) => text.replace(path, "").into(),
        Value::Array(list) => list.iter().map(|value| without(value, path)).collect(),
        Value::Object(map) => {
            let pairs = map.iter().map(|(key, value)| (key.clone(), without(value, path)));
            Value::Object(pairs.collect())
        }
        Value::Null | Value::Bool(_) | Value::Number(_) => value.clone(),
    }
}

/// Documents of a command, or its errors as text.
fn documents(collector: &Collector, outcome: Result<Outcome, Outcome>) -> Result<Vec<Value>, String> {
    let (documents, refusals) = (collector.documents(), collector.refusals());
    let errors = documents.iter().filter(|d| d["status"] == "error");
    let mut texts: Vec<String> = errors.filter_map(|d| d.get("diagnostics").map(diagnostics_text)).collect();
    texts.extend(refusals);
    let good: Vec<Value> = documents.into_iter().filter(|d| d["status"] != "error").collect();
    if good.is_empty() {
        if texts.is_empty() {
            let (Ok(outcome) | Err(outcome)) = outcome;
            texts.push(format!("the command ended without a result (exit code {})", outcome as u8));
        }
        return Err(texts.join("\n\n"));
    }
    Ok(good)
}

/// Diagnostics as lines of text.
fn diagnostics_text(list: &Value) -> String {
    let one = |d: &Value| {
        let text = |key: &str| d.get(key).and_then(Value::as_str).unwrap_or_default().to_owned();
        let place = match (d["line"].as_u64(), d["column"].as_u64()) {
            (Some(line), Some(column)) => format!(":{line}:{column}"),
            _ => String::new(),
        };
        let mut out = format!(
            "{}[{}]: {}\n --> {}{place}",
            text("severity"),
            text("code"),
            text("message"),
            text("file")
        );
        for note in d["notes"].as_array().into_iter().flatten().filter_map(Value::as_str) {
            out += &format!("\n = note: {note}");
        }
        if let Some(help) = d["help"].as_str() {
            out += &format!("\n = help: {help}");
        }
        out
    };
    list.as_array().into_iter().flatten().map(one).collect::<Vec<_>>().join("\n\n")
}

/// Result for each case of a model.
fn in_cases(collector: &Collector, outcome: Result<Outcome, Outcome>, of: impl Fn(&Value) -> Value) -> Reply {
    let problems = collector.refusals();
    let mut documents = match documents(collector, outcome) {
        Ok(documents) => documents,
        Err(_) if !problems.is_empty() => return Err(problems.join("\n\n")),
        Err(why) => return Err(why),
    };
    let document = documents.remove(0);
    let cases: Vec<Value> = match document.get("cases").and_then(Value::as_array) {
        Some(cases) if document.get("status").is_none() => {
            let one = |case: &Value| {
                let mut result = of(&case["result"]);
                result["case"] = case["case"].clone();
                brief(&result)
            };
            cases.iter().map(one).collect()
        }
        _ => vec![brief(&of(&document))],
    };
    let mut reply = json!({ "cases": cases });
    if !problems.is_empty() {
        reply["problems"] = json!(problems);
    }
    if cases.is_empty() {
        return Err(if problems.is_empty() {
            "the model has no motion".into()
        } else {
            problems.join("\n\n")
        });
    }
    Ok(reply)
}

/// Result of a study, without some keys.
fn study(collector: &Collector, outcome: Result<Outcome, Outcome>, left_out: &[&str]) -> Reply {
    let mut document = documents(collector, outcome)?.remove(0);
    if let Some(map) = document.as_object_mut() {
        left_out.iter().for_each(|key| drop(map.remove(*key)));
    }
    let mut document = brief(&document);
    if document.get("study").is_none() {
        document["study"] = "synthesize".into();
    }
    if document.get("status").is_none() {
        document["status"] = "complete".into();
    }
    Ok(document)
}

/// Facts of a mechanism from the summary of a check.
fn facts_of(summary: &Value) -> serde_json::Map<String, Value> {
    let mut facts = only(
        &summary["model"],
        &["name", "description", "units", "counts", "drivers", "redundancy", "measures", "notes"],
    );
    let rows = |table: &str, keys: &[&str]| -> Value {
        let list = summary["model"][table].as_array().into_iter().flatten();
        list.map(|row| Value::Object(only(row, keys))).collect()
    };
    facts.insert("bodies".into(), rows("bodies", &["name", "placed_by"]));
    facts.insert("joints".into(), rows("joints", &["name", "type", "bodies", "role"]));
    facts.insert("variables".into(), rows("variables", &["name", "unit", "change", "answer"]));
    facts.extend(only(summary, &["status", "steps", "stop", "assembly", "joint_limits", "diagnostics"]));
    facts.insert("margin".into(), margin_of(&summary["margin"]));
    facts
}

/// Margin without its curve.
fn margin_of(margin: &Value) -> Value {
    let keys = [
        "least",
        "time",
        "joints",
        "digits_lost",
        "start",
        "singular_after",
        "drivers_until",
        "singular_kind",
    ];
    if margin.is_null() { Value::Null } else { only(margin, &keys).into() }
}

/// Solves a motion, and adds the ranges of the measures to its summary.
fn solve(session: &Session, file: &ModelFile) -> Result<Outcome, Outcome> {
    let (summary, course) = check::solved(session, Formulation::Relative, file)?;
    let mut document = json!(summary);
    document["ranges"] = json!(RangeFact::all(file.units, &course));
    session.print_json(&document);
    Ok(check::outcome(&summary))
}

fn is_shown(row: &Value, names: &[String]) -> bool {
    names.is_empty() || names.iter().any(|name| row["measure"] == name.as_str())
}

/// Ranges, metrics and sensitivities from the summary of a run.
fn results_of(summary: &Value, measures: &[String], most: usize, rates: bool) -> Value {
    let mut result = only(&summary["model"], &["name", "units"]);
    result.extend(only(summary, &["status", "steps", "stop", "joint_limits", "left_out", "diagnostics"]));
    result.insert("margin".into(), margin_of(&summary["margin"]));
    let list = |key: &str| summary[key].as_array().into_iter().flatten();
    let ranges = list("ranges").filter(|row| is_shown(row, measures));
    result.insert("measures".into(), ranges.cloned().collect());
    let metric = |metric: &Value| {
        let mut metric = metric.clone();
        metric["sensitivities"] = largest(&metric["sensitivities"], "value", most);
        metric
    };
    result.insert("metrics".into(), list("metrics").map(metric).collect());
    let rankings = list("sensitivities").filter(|row| is_shown(row, measures));
    let rankings = rankings.filter(|row| rates || row["order"] == "value").map(|ranking| {
        let mut ranking = ranking.clone();
        ranking["largest"] = largest(&ranking["largest"], "value", most);
        ranking
    });
    result.insert("sensitivities".into(), rankings.collect());
    result.into()
}

/// Measures and metrics of a changed design.
fn changes_of(facts: &Value, measures: &[String], most: usize) -> Value {
    let mut result = only(facts, &["name", "change", "nearest", "follows", "metrics", "diagnostics"]);
    let list = |key: &str| facts[key].as_array().into_iter().flatten();
    let shown = |row: &&Value| is_shown(row, measures);
    result.insert("unknown".into(), list("unknown").filter(shown).cloned().collect());
    result.insert("measures".into(), list("measures").filter(shown).cloned().collect());
    let influence: Value = list("influence").filter(shown).cloned().collect();
    result.insert("influence".into(), largest(&influence, "largest", most));
    let margins: Vec<Value> = list("margins").map(margin_of).collect();
    result.insert("margins".into(), margins.into());
    result.into()
}

/// Row of a code in the documents.
fn explain(code: &str) -> Reply {
    let code = code.trim().to_uppercase();
    let text = document("diagnostics").unwrap_or_default();
    let mut area = "";
    for line in text.lines() {
        if let Some(heading) = line.strip_prefix("## ") {
            area = heading;
        }
        // A bar within a cell is escaped.
        let row = line.replace("\\|", "\u{0}");
        let cells: Vec<String> =
            row.split('|').map(|cell| cell.replace('\u{0}', "|").trim().to_owned()).collect();
        if let [_, first, meaning, remedy, _] = &cells[..]
            && *first == code
        {
            return Ok(json!({ "code": code, "area": area, "meaning": meaning, "remedy": remedy }));
        }
    }
    Err(format!("there is no diagnostic `{code}`; codes are HP and four digits, such as HP0204"))
}

fn new_model(
    session: &Session,
    collector: &Collector,
    template: Option<&str>,
    name: Option<String>,
    save: Option<&Path>,
) -> Reply {
    let Some(template) = template else {
        let all: Vec<Value> =
            TEMPLATES.iter().map(|t| json!({ "name": t.name, "description": t.what })).collect();
        return Ok(json!({ "templates": all }));
    };
    let failed = |_: Outcome| collector.refusals().join("\n\n");
    let template = template_named(session, template).map_err(failed)?;
    let name = name.unwrap_or_else(|| template.name.to_owned());
    let model = hardpoint_file::placed(template.text, &name, &[]);
    let mut reply = json!({ "name": name, "text": model });
    if let Some(path) = save {
        if path.exists() {
            return Err(format!("the file `{}` exists already; choose another name", path.display()));
        }
        write_new(path, model.as_bytes()).map_err(|error| failed(session.not_written(&error)))?;
        reply["saved"] = path.display().to_string().into();
    }
    Ok(reply)
}
