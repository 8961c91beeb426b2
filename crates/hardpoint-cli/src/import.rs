//! `hardpoint import`.

use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run};
use hardpoint_file::{LARGEST_FILE, ModelFile};
use hardpoint_import::{Closing, Difference, FORMATS, Format, ImportErrors, ImportedModel, Options};
use hardpoint_report::GENERATOR;
use hardpoint_report::summary::Summary;
use serde_json::json;

use crate::args::Import;
use crate::check;
use crate::folder::{Folder, WriteError, folder_of};
use crate::outcome::Outcome;
use crate::session::Session;
use crate::text;

/// Imports another program's mechanism as a model file and checks it.
pub fn import(options: &Import) -> Outcome {
    let session = Session::begin(options.json);
    if options.list {
        list(&session);
        return Outcome::Done;
    }
    // Both are required unless the formats are listed.
    let (Some(source), Some(to)) = (&options.source, &options.output) else { return Outcome::Misunderstood };
    session.end(import_to(&session, options, source, to))
}

fn list(session: &Session) {
    if session.is_json() {
        let formats =
            FORMATS.iter().map(|f| json!({ "name": f.name, "about": f.about, "endings": f.endings }));
        session.print_json(&json!({ "generator": GENERATOR, "formats": formats.collect::<Vec<_>>() }));
        return;
    }
    let row = |f: &Format| {
        let endings: Vec<String> = f.endings.iter().map(|e| format!(".{e}")).collect();
        (f.name, format!("{} ({})", f.about, endings.join(", ")))
    };
    text::print(&text::pairs(&FORMATS.iter().map(row).collect::<Vec<_>>()));
}

pub fn import_to(session: &Session, options: &Import, source: &Path, to: &Path) -> Result<Outcome, Outcome> {
    let format = options.format.as_deref().map(|name| format_named(session, name)).transpose()?;
    let closings: Result<Vec<Closing>, String> = options.close.iter().map(|text| text.parse()).collect();
    let closings = closings.map_err(|why| session.misunderstood(&format!("`--close`: {why}")))?;
    session.may_save(source, Some(to))?;
    let bytes = session.bytes_of(source)?;
    let name = source.display().to_string();
    let folder = source.parent().unwrap_or(Path::new("")).to_owned();
    let resolve = |path: &str| beside(&folder, path);
    let mut options = Options { format: format.copied(), closings, shapes: None };
    let mut imported_to = |shapes: String| {
        options.shapes = Some(shapes);
        let imported = hardpoint_import::import_with(&options, &bytes, &name, &resolve);
        imported.map_err(|problems| refused(session, &problems))
    };
    let shapes = format!("{}_meshes", to.file_stem().unwrap_or_default().to_string_lossy());
    let mut imported = imported_to(shapes.clone())?;
    let mut number = 1;
    while replaces_others(to, &imported) {
        number += 1;
        imported = imported_to(format!("{shapes}_{number}"))?;
    }
    write(to, &imported).map_err(|e| session.not_written(&e))?;
    if !session.is_json() {
        text::print(&format!("{}\n", imported.report));
    }
    if let Some(fault) = &imported.fault {
        refused(session, fault);
        session.remark(&format!("`{}` was written anyway; correct it by hand", to.display()));
        // That of a check of the model
        return Err(match hardpoint_file::read(to) {
            Ok(_) => Outcome::CannotBeDriven,
            Err(_) => Outcome::BadModel,
        });
    }
    let file = session.read(to)?;
    let summary = check::examine(session, Formulation::Relative, &file)?;
    let difference = compared(&file, &imported);
    if session.is_json() {
        let files: Vec<&str> = imported.files.iter().map(|(name, _)| name.as_str()).collect();
        session.print_json(&json!({
            "generator": GENERATOR, "status": summary.status, "model": to, "files": files,
            "report": imported.report, "stored": difference, "check": summary,
        }));
    } else {
        text::print(&report_text(&file, to, &imported, &summary, difference.as_ref()));
        session.tell(&file, &summary.diagnostics);
    }
    Ok(check::outcome(&summary))
}

fn format_named(session: &Session, name: &str) -> Result<&'static Format, Outcome> {
    Format::named(name).ok_or_else(|| {
        let known: Vec<&str> = FORMATS.iter().map(|f| f.name).collect();
        session.misunderstood(&format!(
            "`--format {name}`: there is no such format; there are {}",
            known.join(", ")
        ))
    })
}

/// Reports the errors of a source.
fn refused(session: &Session, problems: &ImportErrors) -> Outcome {
    if session.is_json() {
        let list: Vec<_> = problems.list().collect();
        session.print_json(&json!({ "generator": GENERATOR, "status": "error", "diagnostics": list }));
    } else {
        text::complain(&format!("{}\n\n", problems.render(text::stderr_in_color())));
    }
    Outcome::BadModel
}

/// Reads a file that a source names: from its folder, or the two folders above it, as in robot packages.
fn beside(folder: &Path, path: &str) -> Option<Vec<u8>> {
    let upwards = ["", "..", "../.."].map(|up| folder.join(up).join(path));
    let found = upwards.into_iter().find(|p| p.is_file())?;
    let mut bytes = Vec::new();
    std::fs::File::open(found).ok()?.take(LARGEST_FILE).read_to_end(&mut bytes).ok()?;
    Some(bytes)
}

/// Returns true if a file of the model would replace one with other contents that the previous version of the model
/// does not refer to: a mesh of the source, or of another model.
fn replaces_others(to: &Path, imported: &ImportedModel) -> bool {
    let previous = std::fs::read_to_string(to).unwrap_or_default();
    imported.files.iter().any(|(name, bytes)| {
        let is_own = previous.contains(&format!("\"{name}\""));
        !is_own && std::fs::read(folder_of(to).join(name)).is_ok_and(|other| other != *bytes)
    })
}

/// Writes the model and the files that it refers to; the model comes last, so that it never exists without them.
fn write(to: &Path, imported: &ImportedModel) -> Result<(), WriteError> {
    let parent = folder_of(to);
    for (name, bytes) in &imported.files {
        let path = parent.join(name);
        let (folder, name) = (path.parent().unwrap_or(parent), file_name(&path));
        let mut folder = Folder::open(folder)?;
        folder.write(&name, |out| out.write_all(bytes))?;
        folder.commit(&[])?;
    }
    let mut folder = Folder::open(parent)?;
    folder.write(&file_name(to), |out| out.write_all(imported.text.as_bytes()))?;
    folder.commit(&[])
}

fn file_name(path: &Path) -> String {
    path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Compares the stored motion of the source with that of the model.
fn compared(file: &ModelFile, imported: &ImportedModel) -> Option<Difference> {
    let series = imported.series.as_ref()?;
    let analysis = Analysis::new(&file.model).ok()?;
    Some(series.compare(file, &analysis.solve(Run::new().without_sensitivities())))
}

fn report_text(
    file: &ModelFile,
    to: &Path,
    imported: &ImportedModel,
    summary: &Summary,
    difference: Option<&Difference>,
) -> String {
    let mut rows = vec![
        ("model", to.display().to_string()),
        ("degrees of freedom", summary.model.freedom_line()),
        ("constraints", summary.model.constraints_line()),
        ("motion", format!("{} of {} steps solved", summary.steps.solved, summary.steps.asked)),
    ];
    if !imported.files.is_empty() {
        let folder: PathBuf = imported.files[0].0.split('/').next().unwrap_or_default().into();
        rows.push(("shapes", format!("{} in `{}` next to it", imported.files.len(), folder.display())));
    }
    if let Some(d) = difference {
        let unit = file.units.length.symbol();
        let line =
            format!("differs at {} times by {:.1e} {unit} and {:.1e} rad at most", d.times, d.place, d.turn);
        rows.push(("stored motion", line));
    }
    format!("{}\n", text::pairs(&rows))
}
