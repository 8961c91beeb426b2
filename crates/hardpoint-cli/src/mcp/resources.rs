//! Resources for agents: the documents, the JSON Schema of model files, and the templates.

use serde_json::{Value, json};

use crate::new::TEMPLATES;

/// A document: name, title, and text. All are served but those for contributors.
struct Document {
    name: &'static str,
    what: &'static str,
    text: &'static str,
}

macro_rules! documents {
    ($($name:literal: $what:literal;)*) => {
        &[$(Document { name: $name, what: $what, text: include_str!(concat!("../../docs/", $name, ".md")) }),*]
    };
}

static DOCUMENTS: &[Document] = documents! {
    "file-format": "Every table and key of a model file, with units, defaults and examples";
    "measures": "All measures, with signs and units";
    "diagnostics": "All diagnostics, by code, with remedies";
    "tutorial": "A first model, step by step";
    "new": "Models from templates";
    "loads": "Masses, forces, reactions and equilibrium";
    "results": "Files and JSON documents of results";
    "optimisation": "Optimisation: goals, limits, variables";
    "trade-off": "Trade-offs of several goals";
    "tolerance": "Tolerance studies";
    "sweep": "Sweeps over design variables";
    "calibration": "Fits to measured data";
    "synthesis": "Synthesis of linkages for poses or paths";
    "maps": "Tables over drivers with a proved error";
    "import": "Formats of other programs that can be imported";
    "export": "Formats of models and results that can be exported";
    "export-c": "Export as C code";
    "export-fmi": "Export as an FMU (FMI 3.0)";
    "machine-code": "Safety of the machine code that solves steps";
    "performance": "Run times and instruction counts";
    "scaling": "Sweeps on several machines";
    "studio": "The page that shows and changes a model";
    "python": "The Python package, in ten minutes";
    "python-api": "Reference of the Python package";
    "theory": "Equations, with their numbers and sources";
    "glossary": "Terms, with those of other programs";
    "agents": "The server for agents: tools, resources, clients";
    "editors": "The language server: features, editors";
};

const SCHEMA: &str = "hardpoint://schema/model.json";

/// Text of a document.
pub fn document(name: &str) -> Option<&'static str> {
    DOCUMENTS.iter().find(|d| d.name == name).map(|d| d.text)
}

/// All resources.
pub fn list() -> Vec<Value> {
    let mut all: Vec<Value> = DOCUMENTS
        .iter()
        .map(|d| {
            json!({
                "uri": format!("hardpoint://docs/{}.md", d.name), "name": format!("{}.md", d.name),
                "description": d.what, "mimeType": "text/markdown", "size": d.text.len(),
            })
        })
        .collect();
    all.push(json!({
        "uri": SCHEMA, "name": "model.json", "description": "JSON Schema of model files", "mimeType": "application/schema+json",
    }));
    all.extend(TEMPLATES.iter().map(|t| {
        json!({
            "uri": format!("hardpoint://templates/{}.toml", t.name), "name": format!("{}.toml", t.name),
            "description": format!("Model: {}", t.what), "mimeType": "application/toml", "size": t.text.len(),
        })
    }));
    all
}

/// Contents of a resource.
pub fn read(uri: &str) -> Option<Value> {
    let content = |kind: &str, text: &str| json!({ "uri": uri, "mimeType": kind, "text": text });
    if uri == SCHEMA {
        return Some(content("application/schema+json", &hardpoint_file::schema()));
    }
    if let Some(name) = uri.strip_prefix("hardpoint://docs/") {
        return document(name.strip_suffix(".md")?).map(|text| content("text/markdown", text));
    }
    let name = uri.strip_prefix("hardpoint://templates/")?.strip_suffix(".toml")?;
    let template = TEMPLATES.iter().find(|t| t.name == name)?;
    Some(content("application/toml", template.text))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    /// Documents for contributors.
    const OTHERS: [&str; 3] = ["development.md", "page-review.md", "release.md"];

    #[test]
    fn all_documents_are_served_but_those_for_contributors() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
        let names = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
        let names: Vec<String> = names.filter(|name| name.ends_with(".md")).collect();
        assert!(names.len() > 20, "{names:?}");
        for name in names {
            let served = read(&format!("hardpoint://docs/{name}"));
            assert_eq!(served.is_none(), OTHERS.contains(&name.as_str()), "{name}");
        }
    }
}
