//! Tables of hardpoints.

use std::fmt::Write;
use std::io;

use hardpoint::joint::Quantity;
use hardpoint_file::{LengthUnit, ModelFile};
use hardpoint_table::csv::CsvWriter;

use crate::contents::Target;
use crate::{ExportedModel, Format, Writer, number};

/// CSV format, a table for spreadsheets.
pub const CSV: Format = Format {
    name: "csv",
    about: "hardpoints as a CSV table",
    endings: &["csv"],
    write: Writer::Described(Target::Table, csv),
};

/// TeimOrbit format, a block for Adams/Car.
pub const TEIMORBIT: Format = Format {
    name: "teimorbit",
    about: "hardpoints as a TeimOrbit block",
    endings: &["sub", "hpt"],
    write: Writer::Described(Target::Table, teimorbit),
};

/// Names and positions of the hardpoints, in the unit of the file, with the fewest digits that reproduce the positions.
pub fn hardpoints(file: &ModelFile) -> impl Iterator<Item = (&str, [f64; 3])> {
    let own = file.model.hardpoints.iter().filter(|h| !h.unnamed);
    own.map(|h| {
        (h.name.as_str(), h.position.to_array().map(|x| file.units.shortest_from_si(Quantity::Length, x)))
    })
}

fn csv(file: &ModelFile, out: &mut ExportedModel) {
    let unit = file.units.length.symbol();
    let mut table = CsvWriter::new(Vec::new());
    let header = ["x", "y", "z"].map(|axis| format!("{axis} ({unit})"));
    let mut written = table.row(["name".to_owned()].into_iter().chain(header));
    for (name, at) in hardpoints(file) {
        written = written.and_then(|()| table.row([name.to_owned()].into_iter().chain(at.map(number))));
    }
    match written.map_err(io::Error::from).and_then(|()| table.end()) {
        Ok(bytes) => out.text = String::from_utf8_lossy(&bytes).into_owned(),
        Err(error) => out.report_unsupported("table", &file.model.name, error.to_string()),
    }
}

/// Returns the name without its side if this is the last word, and the symmetry of Adams/Car. A name that begins with
/// its side keeps the word.
fn side_of(name: &str) -> (&str, &'static str) {
    // A name that the importer would change keeps all its words, and has no side.
    let is_free = |short: &&str| {
        !short.is_empty() && !["left_", "right_", "hpl_", "hpr_", "hps_"].iter().any(|p| short.starts_with(p))
    };
    for side in ["left", "right"] {
        let last = name.strip_suffix(side).and_then(|n| n.strip_suffix('_')).filter(is_free);
        if let Some(short) = last {
            return (short, side);
        }
        if name.strip_prefix(side).and_then(|n| n.strip_prefix('_')).filter(is_free).is_some() {
            return (name, side);
        }
    }
    (name, "single")
}

/// Writes the block in Adams/Car's axes: x forward, y left become x back, y right.
fn teimorbit(file: &ModelFile, out: &mut ExportedModel) {
    let unit = match file.units.length {
        LengthUnit::Metre => "meter",
        LengthUnit::Inch => "inch",
        other => other.symbol(),
    };
    let head = "$---------------------------------------------------------------------MDI_HEADER\n[MDI_HEADER]\n FILE_TYPE     =  'sub'\n FILE_VERSION  =  4.0\n FILE_FORMAT   =  'ASCII'\n";
    let _ = writeln!(
        out.text,
        "{head}$--------------------------------------------------------------------------UNITS\n[UNITS]\n LENGTH  =  '{unit}'\n ANGLE   =  'degrees'"
    );
    out.text += "$----------------------------------------------------------------------HARDPOINT\n[HARDPOINT]\n{hardpoint_name              symmetry        x_value      y_value      z_value}\n";
    for (name, [x, y, z]) in hardpoints(file) {
        let (short, side) = side_of(name);
        // `$` and `!` begin comments.
        if name.contains(['\'', '$', '!']) || name.contains(char::is_control) {
            out.report_unsupported(
                "hardpoint",
                name,
                "names must not contain `'`, `$`, `!` or control characters",
            );
            continue;
        }
        let place = [-x, -y, z].map(number);
        let _ = writeln!(out.text, " '{short}'  '{side}'  {}", place.join("  "));
    }
}
