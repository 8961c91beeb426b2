//! `hardpoint export`.

use std::io::{Cursor, Write};
use std::path::Path;

use hardpoint_export::{ExportError, ExportOptions, FORMATS, Format};
use hardpoint_report::GENERATOR;
use hardpoint_study::RequestError;
use hardpoint_study::request::Fault;
use hardpoint_study::whatif::{add_coordinates, add_tilts};
use serde_json::json;

use crate::args::Export;
use crate::compile::compile;
use crate::folder::{WriteError, write_alone};
use crate::outcome::Outcome;
use crate::session::Session;
use crate::text;

/// Writes a model as a file of another program, and lists its unsupported features.
pub fn export(options: &Export) -> Outcome {
    let session = Session::begin(options.json);
    if options.list {
        let row = |f: &Format| {
            let endings: Vec<String> = f.endings.iter().map(|e| format!(".{e}")).collect();
            (f.name, format!("{} ({})", f.about, endings.join(", ")))
        };
        text::print(&text::pairs(&FORMATS.iter().map(row).collect::<Vec<_>>()));
        return Outcome::Done;
    }
    // Both are required unless the formats are listed.
    let (Some(model), Some(to)) = (&options.model, &options.output) else { return Outcome::Misunderstood };
    session.end(export_to(&session, options, model, to))
}

fn export_to(session: &Session, options: &Export, model: &Path, to: &Path) -> Result<Outcome, Outcome> {
    let known = || FORMATS.iter().map(|f| f.name).collect::<Vec<_>>().join(", ");
    let format = match &options.format {
        Some(name) => Format::named(name).ok_or_else(|| {
            session
                .misunderstood(&format!("`--format {name}`: there is no such format; there are {}", known()))
        })?,
        None => {
            let name = to.to_string_lossy();
            let why = || {
                format!(
                    "`-o {name}`: the file name does not identify a format; give one with `--format`: {}",
                    known()
                )
            };
            Format::of(&name).ok_or_else(|| session.misunderstood(&why()))?
        }
    };
    let with_design =
        [("--design", options.design), ("--coordinates", options.coordinates), ("--tilts", options.tilts)];
    let with_design = with_design.iter().find(|(_, given)| *given).map(|(option, _)| *option);
    if let Some(option) = with_design.filter(|_| !format.has_design()) {
        let with: Vec<&str> = FORMATS.iter().filter(|f| f.has_design()).map(|f| f.name).collect();
        let why = format!(
            "`{option}`: the format {} does not contain the motion; leave it out, or export as {}",
            format.name,
            with.join(" or ")
        );
        return Err(session.misunderstood(&why));
    }
    session.may_save(model, Some(to))?;
    let mut file = session.read(model)?;
    if options.coordinates {
        add_coordinates(&mut file.model);
    }
    if options.tilts {
        add_tilts(&mut file.model);
    }
    let stem = to.file_stem().unwrap_or_default().to_string_lossy();
    let asked = ExportOptions { design: with_design.is_some() };
    let exported = format.export_with(&file, &stem, asked).map_err(|error| match error {
        ExportError::CannotBeDriven(fault) => session.cannot_be_driven(&file, &fault),
        ExportError::NotRecorded { why } => session.refused(&file, &not_recorded(format, &why)),
        ExportError::UnfitName { why, help } => {
            let message = format!("`-o {}`: {why}", to.display());
            session.refused(&file, &RequestError { fault: Fault::Override, message, help })
        }
    })?;
    let write = |to: &Path, text: &[u8]| {
        write_alone(to, |out| out.write_all(text)).map_err(|e| session.not_written(&e))
    };
    let library = exported.archive.as_ref().map(compile);
    match (&exported.archive, &library) {
        (Some(archive), Some(library)) => {
            // A zip file is completed from its end.
            let packed = archive.write(library.as_ref().ok(), Cursor::new(Vec::new()));
            let packed =
                packed.map_err(|error| session.not_written(&WriteError { path: to.into(), error }))?;
            write(to, &packed.into_inner())?;
        }
        _ => write(to, exported.text.as_bytes())?,
    }
    let companion = exported.companion.as_ref().map(|c| (to.with_extension(c.ending), c));
    if let Some((path, companion)) = &companion {
        write(path, companion.text.as_bytes())?;
    }
    if session.is_json() {
        session.print_json(&json!({
            "generator": GENERATOR, "status": "complete", "format": format.name, "file": to,
            "companion": companion.as_ref().map(|(path, _)| path),
            "platform": library.as_ref().and_then(|l| l.as_ref().ok()).map(|l| l.platform),
            "unsaid": exported.unsupported,
        }));
        return Ok(Outcome::Done);
    }
    let mut out = format!("{}: {}\n", to.display(), format.about);
    if let Some((path, _)) = &companion {
        out += &format!("{}: its header\n", path.display());
    }
    match &library {
        Some(Ok(library)) => out += &format!("  compiled for {}\n", library.platform),
        Some(Err(why)) => out += &format!("  sources only, which the importer compiles: {why}\n"),
        None => {}
    }
    if !exported.unsupported.is_empty() {
        out += "  unsupported, or exported with changes:\n";
        out.extend(exported.unsupported.iter().map(|u| format!("    {} `{}`: {}\n", u.kind, u.name, u.why)));
    }
    text::print(&out);
    Ok(Outcome::Done)
}

/// Error for a model whose motion has no formulas in this format.
fn not_recorded(format: &Format, why: &str) -> RequestError {
    RequestError {
        fault: Fault::Model,
        message: format!("`--format {}`: the motion has no formulas: {why}", format.name),
        help: "see `docs/export-c.md` for the models whose motion can be exported".into(),
    }
}
