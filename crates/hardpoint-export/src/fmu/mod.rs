//! FMI 3.0: the step of a mechanism as a functional mock-up unit, for Model Exchange and Co-Simulation.
//!
//! The unit contains the C source of the step (`c`), the interface to it (`fmi3.c`), and the description of its
//! variables. A variable's value reference is its index in [`Variables`].

mod description;

use std::collections::HashSet;

use hardpoint::joint::Quantity;
use hardpoint::model::Dimension;
use hardpoint_file::ModelFile;
use hardpoint_report::GENERATOR;
use hardpoint_report::figures::unit;
use hardpoint_table::Units;

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

/// Variable of the unit.
struct Variable {
    name: String,
    about: String,
    role: Role,
    dimension: Dimension,
}

/// Role of a variable, with the index of its driver, design variable, measure or body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    Time,
    /// Input: position, velocity or acceleration of a driver.
    Driver(usize, usize),
    Design(usize),
    /// Output: value, rate or acceleration of a measure.
    Measure(usize, usize),
    BodyPosition(usize),
    BodyRotation(usize),
}

impl Role {
    /// Kind in `fmi3.c`, index, and number of values.
    fn in_source(self) -> (&'static str, usize, usize) {
        match self {
            Self::Time => ("TIME", 0, 1),
            Self::Driver(k, order) => (["POSITION", "VELOCITY", "ACCELERATION"][order], k, 1),
            Self::Design(k) => ("DESIGN", k, 1),
            Self::Measure(k, order) => (["VALUE", "RATE", "SECOND"][order], k, 1),
            Self::BodyPosition(k) => ("BODY_POSITION", k, 3),
            Self::BodyRotation(k) => ("BODY_ROTATION", k, 9),
        }
    }

    fn is_output(self) -> bool {
        match self {
            Self::Time | Self::Driver(..) | Self::Design(_) => false,
            Self::Measure(..) | Self::BodyPosition(_) | Self::BodyRotation(_) => true,
        }
    }

    /// Order of the highest derivative of the drivers that an output depends on.
    fn order(self) -> usize {
        match self {
            Self::Driver(_, order) | Self::Measure(_, order) => order,
            Self::Time | Self::Design(_) | Self::BodyPosition(_) | Self::BodyRotation(_) => 0,
        }
    }
}

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
    let names = structured_names(file, &source);
    for (name, renamed) in names.renamed() {
        out.report_unsupported("name", name, format!("named {renamed} in the unit, where names are ASCII"));
    }
    let variables = variables(file, &source, &names);
    let described = description::Description { file, source: &source, variables: &variables };
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

/// Names in the unit, in the order of the model: drivers, design variables, measures, and bodies without ground.
struct StructuredNames {
    drivers: Vec<(String, String)>,
    design: Vec<(String, String)>,
    measures: Vec<(String, String)>,
    bodies: Vec<(String, String)>,
}

impl StructuredNames {
    /// Names with characters that names of units do not have, with those in the unit.
    fn renamed(&self) -> impl Iterator<Item = (&str, &str)> {
        let all = [&self.drivers, &self.design, &self.measures, &self.bodies].into_iter().flatten();
        all.filter(|(name, _)| plain(name) != *name).map(|(name, unit)| (name.as_str(), unit.as_str()))
    }
}

fn structured_names(file: &ModelFile, source: &MotionSource) -> StructuredNames {
    let model = &file.model;
    StructuredNames {
        drivers: unique(model.drivers.iter().map(|driver| driver.name.as_str())),
        design: unique(source.design.iter().map(|of| model.variables[*of].name.as_str())),
        measures: unique(source.measures.iter().map(|measure| measure.output.name.as_str())),
        bodies: unique(model.bodies.iter().skip(1).map(|body| body.name.as_str())),
    }
}

/// Names with those in the unit. The grammar of names has ASCII characters only, so `_` replaces others; among equal
/// ones, `_2`, `_3` and so on follow, as in the C source.
fn unique<'n>(names: impl Iterator<Item = &'n str> + Clone) -> Vec<(String, String)> {
    let mut taken: HashSet<String> =
        names.clone().filter(|name| plain(name) == **name).map(str::to_owned).collect();
    let one = |name: &str| {
        let plain = plain(name);
        let mut unit = plain.clone();
        if plain != name {
            let mut count = 1;
            while !taken.insert(unit.clone()) {
                count += 1;
                unit = format!("{plain}_{count}");
            }
        }
        (name.to_owned(), structured(&unit))
    };
    names.map(one).collect()
}

/// Name in the characters that names of units have.
fn plain(name: &str) -> String {
    let plain = |c: char| if (c.is_ascii_graphic() || c == ' ') && c != '`' { c } else { '_' };
    name.chars().map(plain).collect()
}

/// All variables, in the order of their value references.
fn variables(file: &ModelFile, source: &MotionSource, names: &StructuredNames) -> Vec<Variable> {
    let model = &file.model;
    let dimension = |quantity: Quantity| Dimension::from(quantity);
    let mut list = vec![Variable {
        name: "time".to_owned(),
        about: "Independent variable".to_owned(),
        role: Role::Time,
        dimension: Dimension::NUMBER.rate(-1),
    }];
    for (k, driver) in model.drivers.iter().enumerate() {
        let quantity = dimension(model.driven(driver).quantity);
        for (order, of) in ["position", "velocity", "acceleration"].into_iter().enumerate() {
            list.push(Variable {
                name: format!("drivers.{}.{of}", names.drivers[k].1),
                about: match order {
                    0 => format!("Position of driver {} from the design configuration", driver.name),
                    _ => format!("{} of driver {}", ["", "Velocity", "Acceleration"][order], driver.name),
                },
                role: Role::Driver(k, order),
                dimension: quantity.rate(order as i8),
            });
        }
    }
    for (k, of) in source.design.iter().enumerate() {
        let variable = &model.variables[*of];
        list.push(Variable {
            name: format!("design.{}", names.design[k].1),
            about: format!("Change of design variable {} from the value of the model", variable.name),
            role: Role::Design(k),
            dimension: dimension(variable.quantity),
        });
    }
    for (k, measure) in source.measures.iter().enumerate() {
        for (order, of) in ["value", "rate", "acceleration"].into_iter().enumerate().take(measure.orders()) {
            list.push(Variable {
                name: format!("measures.{}.{of}", names.measures[k].1),
                about: match order {
                    0 => format!("Measure {}", measure.output.name),
                    _ => {
                        format!("{} of measure {}", ["", "Rate", "Acceleration"][order], measure.output.name)
                    }
                },
                role: Role::Measure(k, order),
                dimension: measure.output.dimension.rate(order as i8),
            });
        }
    }
    for (k, body) in model.bodies.iter().skip(1).enumerate() {
        list.push(Variable {
            name: format!("bodies.{}.position", names.bodies[k].1),
            about: format!("Origin of body {} in global axes", body.name),
            role: Role::BodyPosition(k),
            dimension: Dimension::LENGTH,
        });
        list.push(Variable {
            name: format!("bodies.{}.rotation", names.bodies[k].1),
            about: format!(
                "Rotation matrix of body {}: its columns are the axes in global components",
                body.name
            ),
            role: Role::BodyRotation(k),
            dimension: Dimension::NUMBER,
        });
    }
    list
}

/// ASCII name by the structured naming convention: identifiers that are separated by dots, and quoted ones.
fn structured(name: &str) -> String {
    let is_identifier = |part: &str| {
        part.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
            && part.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
    };
    if name.split('.').all(is_identifier) {
        return name.to_owned();
    }
    let escape = |c: char| if matches!(c, '\\' | '\'' | '"') { format!("\\{c}") } else { c.to_string() };
    let escaped: String = name.chars().map(escape).collect();
    format!("'{escaped}'")
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
    fn names_follow_the_structured_convention() {
        assert_eq!(structured("front.camber_2"), "front.camber_2");
        assert_eq!(structured("wheel-centre"), "'wheel-centre'");
        assert_eq!(structured("2nd gear's"), "'2nd gear\\'s'");
        assert_eq!(structured("1\"-pin"), "'1\\\"-pin'");
    }

    #[test]
    fn names_outside_ascii_stay_different() {
        let names = ["α", "β", "_", "größe", "gr__e_2", "grüße", "a`b", "α β"];
        let unit: Vec<String> = unique(names.into_iter()).into_iter().map(|(_, unit)| unit).collect();
        let expected = ["__2", "__3", "_", "gr__e", "gr__e_2", "gr__e_3", "a_b", "'_ _'"];
        assert_eq!(unit, expected);
    }

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
