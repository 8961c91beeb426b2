//! Files of the unit.

use hardpoint_file::ModelFile;
use hardpoint_report::GENERATOR;
use hardpoint_report::figures::unit;
use hardpoint_table::Units;

use super::description::Description;
use super::names::StructuredNames;
use super::variable::{Variable, variables};
use crate::archive::Archive;
use crate::c::{MotionSource, Parts, comment, generate, identifier};
use crate::{ExportError, ExportOptions, ExportedModel, Format, Writer};

/// FMU format.
pub const FORMAT: Format = Format {
    name: "fmu",
    about: "FMI 3.0 unit for Model Exchange and Co-Simulation: motion as a function of the drivers",
    endings: &["fmu"],
    write: Writer::Recorded(write),
};

// Templates, with places as in `@name@`.
const HEADER: &str = include_str!("fmi3.h");
const SOURCE: &str = include_str!("fmi3.c");

fn write(
    file: &ModelFile,
    stem: &str,
    options: ExportOptions,
    out: &mut ExportedModel,
) -> Result<(), ExportError> {
    // Files of the unit and its library are named by the identifier.
    let stem = &identifier(stem);
    let design = options.design || !file.model.variables.is_empty();
    let source = match generate(file, stem, Parts { derivatives: true, design }, out) {
        Err(ExportError::NotRecorded { why }) if design && !options.design => {
            let source = generate(file, stem, Parts { derivatives: true, design: false }, out)?;
            let why = format!("their nominal values are constants: with them as parameters, {why}");
            out.report_unsupported("design variables", &file.model.variables.len().to_string(), why);
            source
        }
        other => other?,
    };
    let names = StructuredNames::of(file, &source);
    for (name, renamed) in names.renamed() {
        out.report_unsupported("name", name, format!("named {renamed} in the unit, where names are ASCII"));
    }
    let variables = variables(file, &source, &names);
    let described = Description { file, source: &source, variables: &variables };
    let token = token(&[&source.header, &source.source, &described.text("")]);
    let name = source.name.clone();
    let places = places(file, &source, &variables, &token);
    let path = |text: &str| format!("sources/{text}");
    out.archive = Some(Archive {
        files: vec![
            ("modelDescription.xml".to_owned(), described.text(&token)),
            (path("buildDescription.xml"), described.build()),
            (path(&format!("{name}.h")), source.header.clone()),
            (path(&format!("{name}.c")), source.source.clone()),
            (path("fmi3.h"), filled(HEADER, &name, &places)),
            (path("fmi3.c"), filled(SOURCE, &name, &places)),
            ("documentation/index.html".to_owned(), described.page(&out.unsupported)),
        ],
        sources: ("sources".to_owned(), vec![format!("{name}.c"), "fmi3.c".to_owned()]),
        library: name,
    });
    Ok(())
}

fn places(
    file: &ModelFile,
    source: &MotionSource,
    variables: &[Variable],
    token: &str,
) -> [(&'static str, String); 7] {
    let rows = variables.iter().enumerate().map(|(reference, variable)| {
        let (kind, at, count) = variable.role.in_source();
        format!("    {{{kind}, {at}, {count}}}, /* {reference}: {} */", comment(&variable.name))
    });
    let drivers = &file.model.drivers;
    let names = drivers.iter().map(|driver| quoted(&driver.name));
    let units = drivers.iter().map(|d| quoted(&unit(Units::default(), file.model.driven(d).quantity)));
    [
        ("title", comment(&file.model.name)),
        ("generator", GENERATOR.to_owned()),
        ("file", source.origin.clone()),
        ("token", token.to_owned()),
        ("variables", rows.collect::<Vec<_>>().join("\n")),
        ("driver_names", names.collect::<Vec<_>>().join(", ")),
        ("driver_units", units.collect::<Vec<_>>().join(", ")),
    ]
}

/// A template with its places filled.
fn filled(template: &str, name: &str, places: &[(&str, String)]) -> String {
    let mut text = template.replace("@name@", name).replace("@NAME@", &name.to_ascii_uppercase());
    for (place, with) in places {
        text = text.replace(&format!("@{place}@"), with);
    }
    text
}

/// String literal in C.
fn quoted(text: &str) -> String {
    let byte = |b: u8| match b {
        b'"' | b'\\' => format!("\\{}", char::from(b)),
        b'?' => "\\?".to_owned(),
        b' '..=b'~' => char::from(b).to_string(),
        // Octal escapes have at most three digits, so the next character does not continue them.
        _ => format!("\\{b:03o}"),
    };
    // `@` begins a place of the template.
    format!("\"{}\"", text.replace('@', "(at)").bytes().map(byte).collect::<String>())
}

/// Token that identifies the sources and the description: the same model has the same token.
fn token(texts: &[&str]) -> String {
    // FNV-1a, 128 bits
    let mut hash: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
    for byte in texts.iter().flat_map(|text| text.bytes()) {
        hash = (hash ^ u128::from(byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b);
    }
    let digits = format!("{hash:032x}");
    let parts = [0..8, 8..12, 12..16, 16..20, 20..32].map(|range| &digits[range]);
    format!("{{{}}}", parts.join("-"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn literals_are_ascii() {
        assert_eq!(quoted("a\"b\\é?"), "\"a\\\"b\\\\\\303\\251\\?\"");
    }

    #[test]
    fn the_token_depends_on_every_byte() {
        assert_eq!(token(&["a"]), token(&["a"]));
        assert_ne!(token(&["a"]), token(&["b"]));
        assert_eq!(token(&["a"]).len(), 38);
    }
}
