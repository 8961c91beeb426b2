//! `hardpoint map`.

use std::io::Write;
use std::num::NonZero;
use std::path::Path;

use hardpoint::joint::Quantity;
use hardpoint::model::Dimension;
use hardpoint_file::ModelFile;
use hardpoint_report::map_table::{MapTableFact, reason};
use hardpoint_study::RequestError;
use hardpoint_study::map::{ErrorScope, Interpolation, MapError, Overrides, Request, solve};
use hardpoint_table::{AngleUnit, LengthUnit, Units};
use serde_json::json;

use crate::args;
use crate::folder::write_alone;
use crate::outcome::Outcome;
use crate::session::{Session, json_text};
use crate::text;
use crate::whatif::amount;

/// Format of a table.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Format {
    Csv,
    Json,
    /// Tables of the Modelica Standard Library.
    Modelica,
    /// Splines of Adams Solver.
    Adams,
}

impl Format {
    fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "csv" => Some(Self::Csv),
            "json" => Some(Self::Json),
            "txt" => Some(Self::Modelica),
            "adm" => Some(Self::Adams),
            _ => None,
        }
    }

    /// Program that reads values without derivatives, over one or two drivers.
    fn reader(self) -> Option<&'static str> {
        match self {
            Self::Csv | Self::Json => None,
            Self::Modelica => Some("tables of Modelica"),
            Self::Adams => Some("splines of Adams"),
        }
    }

    /// Units of the numbers: those of a model file, or those of the other program.
    fn units(self, own: Units) -> Units {
        match self {
            Self::Csv | Self::Json => own,
            Self::Modelica => Units { length: LengthUnit::Metre, angle: AngleUnit::Radian },
            // Functions of Adams are in the length unit of the dataset, and in rad.
            Self::Adams => Units { angle: AngleUnit::Radian, ..own },
        }
    }

    /// Minimum number of intervals of each range, if there is one. A spline of Adams has at least four points.
    fn intervals(self) -> Option<NonZero<usize>> {
        match self {
            Self::Csv | Self::Json | Self::Modelica => None,
            Self::Adams => NonZero::new(4),
        }
    }
}

/// Builds a table of measures over drivers, and writes it.
pub fn run(options: &args::Map) -> Outcome {
    let session = Session::begin(options.common.json);
    session.end(map_of(&session, options))
}

fn map_of(session: &Session, options: &args::Map) -> Result<Outcome, Outcome> {
    let to = &options.output;
    session.may_save(&options.common.model, Some(to))?;
    let Some(format) = Format::of(to) else {
        let why = format!(
            "`{}` is no table: name a .csv, .json, .txt (Modelica) or .adm (Adams) file with `-o`",
            to.display()
        );
        return Err(session.misunderstood(&why));
    };
    let interpolation = match (options.interpolation, format.reader()) {
        (Some(args::Interpolation::Hermite), Some(reader)) => {
            let why =
                format!("{reader} have no given derivatives: use `--interpolation linear`, or a .json file");
            return Err(session.misunderstood(&why));
        }
        (Some(args::Interpolation::Linear), _) | (None, Some(_)) => Interpolation::Linear,
        (Some(args::Interpolation::Hermite) | None, None) => Interpolation::Hermite,
    };
    if let Some(reader) = format.reader().filter(|_| options.over.len() > 2) {
        let why = format!("{reader} have one or two inputs: fix a driver, or write a .json file");
        return Err(session.misunderstood(&why));
    }
    let file = session.read(&options.common.model)?;
    let refused = |error: RequestError| session.refused(&file, &error);
    let over = options.over.iter().map(|text| range(session, &file, text)).collect::<Result<_, _>>()?;
    let outputs = Request::outputs(&file.model, &options.of).map_err(refused)?;
    let dimensions: Vec<(String, Dimension)> = outputs.into_iter().map(|(name, _, d)| (name, d)).collect();
    let error = |text: &String| {
        error_of(&dimensions, file.units, text)
            .map_err(|why| session.misunderstood(&format!("`--error {text}`: {why}")))
    };
    let errors = options.error.iter().map(error).collect::<Result<Vec<_>, _>>()?.concat();
    let overrides =
        Overrides { over, of: options.of.clone(), errors, interpolation, intervals: format.intervals() };
    let request = Request::of(&file.model, overrides).map_err(refused)?;
    // The mechanism can be driven, or the reasons are given.
    session.plan(&file, options.common.formulation())?;
    let found = {
        let mut meter = session.meter("proving", "cells");
        let mut more = |proved: usize, cells: usize| {
            meter.show(proved, cells);
            !session.interrupted()
        };
        solve(&file.model, options.common.formulation(), &request, &mut more)
    };
    let table = found.map_err(|error| failed(session, &file, &request, &error))?;
    let fact = MapTableFact::of(&file.model, format.units(file.units), &request, &table);
    let written = write_alone(to, |out| match format {
        Format::Csv => fact.write_csv(out),
        Format::Json => out.write_all(json_text(&fact).as_bytes()),
        Format::Modelica => fact.write_modelica(out),
        Format::Adams => fact.write_adams(out),
    });
    written.map_err(|e| session.not_written(&e))?;
    if options.common.json {
        session.print_json(&json!({ "name": file.model.name, "map": fact, "file": to }));
    } else {
        text::print(&format!("{}\n", text::bold(&file.model.name)));
        let fact = MapTableFact::of(&file.model, file.units, &request, &table);
        fact.sentences().iter().for_each(|line| text::print(&format!("{line}\n")));
        text::print(&format!("\nwritten: {}\n", to.display()));
    }
    Ok(Outcome::Done)
}

fn failed(session: &Session, file: &ModelFile, request: &Request, error: &MapError) -> Outcome {
    let outcome = match error {
        MapError::Topology(_) => return Outcome::CannotBeDriven,
        MapError::Interrupted => return Outcome::Interrupted,
        MapError::Equilibrium => Outcome::Misunderstood,
        MapError::Start(_) | MapError::NotReached { .. } => Outcome::Stopped,
        MapError::NotProved { .. } | MapError::TooLarge { .. } => Outcome::FellShort,
    };
    if let Some((message, help)) = reason(&file.model, file.units, request, error) {
        session.not_mapped(file, &message, &help);
    }
    outcome
}

/// `NAME=FROM..TO`, in the unit of the driver unless another one is given; a unit at the end is that of both ends.
fn range(session: &Session, file: &ModelFile, text: &str) -> Result<(String, [f64; 2]), Outcome> {
    let refuse = |why: &str| session.misunderstood(&format!("`--over {text}`: {why}"));
    let parts = text.split_once('=').and_then(|(name, ends)| Some((name.trim(), ends.split_once("..")?)));
    let Some((name, (from, to))) = parts else {
        return Err(refuse("write it as `DRIVER=FROM..TO`, for example `bump=-80..80`"));
    };
    let driver = Request::driver(&file.model, name).map_err(|error| session.refused(file, &error))?;
    let quantity = file.model.driven(&file.model.drivers[driver.0]).quantity;
    let ends = crate::whatif::range_in_si([from, to], quantity, file.units).map_err(|why| refuse(&why))?;
    Ok((name.to_owned(), ends))
}

/// `[NAME=]NUMBER[UNIT]`; without a name it is that of all outputs with this unit, and without a unit that of all
/// outputs, each in its own unit.
fn error_of(
    outputs: &[(String, Dimension)],
    units: Units,
    text: &str,
) -> Result<Vec<(ErrorScope, f64)>, String> {
    let (name, value) = match text.split_once('=') {
        Some((name, value)) => (Some(name.trim()), value.trim()),
        None => (None, text.trim()),
    };
    let (number, written) = amount(value).ok_or_else(|| format!("`{value}` is not a number with a unit"))?;
    let of_dimension = |dimension: Dimension| match dimension {
        Dimension::LENGTH => crate::whatif::in_si(value, Quantity::Length, units),
        Dimension::ANGLE => crate::whatif::in_si(value, Quantity::Angle, units),
        _ if written.is_empty() => Ok(number / units.per_si(dimension)),
        _ => Err("the output is neither a length nor an angle: leave out the unit".to_owned()),
    };
    if let Some(name) = name {
        let dimension = outputs.iter().find(|(output, _)| output == name).map(|(_, dimension)| *dimension);
        let scope = ErrorScope::Output(name.to_owned());
        let dimension = dimension.ok_or_else(|| scope.describe_missing())?;
        return Ok(vec![(scope, of_dimension(dimension)?)]);
    }
    if written.is_empty() {
        let mut all = Vec::new();
        for (_, dimension) in outputs {
            let scope = ErrorScope::Dimension(*dimension);
            if !all.iter().any(|(other, _)| *other == scope) {
                all.push((scope, of_dimension(*dimension)?));
            }
        }
        return Ok(all);
    }
    let length = of_dimension(Dimension::LENGTH).map(|x| (ErrorScope::Dimension(Dimension::LENGTH), x));
    let angle = of_dimension(Dimension::ANGLE).map(|x| (ErrorScope::Dimension(Dimension::ANGLE), x));
    length.or(angle).map(|one| vec![one])
}
