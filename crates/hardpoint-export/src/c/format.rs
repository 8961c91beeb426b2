//! The format `c`, and what it reports.

use hardpoint_file::ModelFile;

use crate::{Companion, ExportError, ExportOptions, ExportedModel, Format, Writer};

use super::source::{Parts, generate};

/// C format.
pub const FORMAT: Format = Format {
    name: "c",
    about: "C99 source with its header: motion as a function of the drivers",
    endings: &["c"],
    write: Writer::Recorded(write),
};

fn write(
    file: &ModelFile,
    stem: &str,
    options: ExportOptions,
    out: &mut ExportedModel,
) -> Result<(), ExportError> {
    if options.design && file.model.variables.is_empty() {
        let why = "the model has no design variables; export it without `--design`, or declare `variables`";
        return Err(ExportError::NotRecorded { why: why.to_owned() });
    }
    let parts = Parts { derivatives: options.design, design: options.design };
    let motion = generate(file, stem, parts, out)?;
    if motion.name != stem {
        out.report_unsupported("name", stem, format!("the prefix of all names is `{}`", motion.name));
    }
    if !options.design && !file.model.variables.is_empty() {
        let why = "their nominal values are constants of the formulas; `--design` makes them arguments";
        out.report_unsupported("design variables", &file.model.variables.len().to_string(), why);
    }
    out.text = motion.source;
    out.companion = Some(Companion { ending: "h", text: motion.header });
    Ok(())
}
