//! Curves of cams and slots: tables of their polynomial pieces, and the functions that look them up.

use std::fmt::Write;

use hardpoint::model::CURVE_PIECE;
use hardpoint::motion::{DrivenCurve, DrivenStep};

use super::emit::literal;

const PIECES: &str = include_str!("pieces.c");

/// Template of the pieces of all curves and the functions that copy them behind the coordinates; empty without curves.
pub fn pieces(step: &DrivenStep) -> String {
    if step.curves.is_empty() {
        return String::new();
    }
    let (mut tables, mut calls) = (String::new(), String::new());
    for (k, DrivenCurve { coordinate, curve }) in step.curves.iter().enumerate() {
        // A curve and its foot in the design configuration have one table.
        let table = step.curves.iter().position(|other| other.curve == *curve).unwrap_or(k);
        if table == k {
            let _ = writeln!(tables, "static const double @name@_curve_{k}[][{CURVE_PIECE}] = {{");
            for piece in curve.pieces() {
                let _ = writeln!(tables, "    {{{}}},", piece.map(literal).join(", "));
            }
            let _ = writeln!(tables, "}};\n");
        }
        let _ = writeln!(
            calls,
            "    @name@_piece(@name@_curve_{table}, {}, {}, {}, x[{coordinate}], x + {});",
            curve.pieces().count(),
            literal(curve.length()),
            u8::from(curve.is_closed()),
            step.coordinates.len() + k * CURVE_PIECE
        );
    }
    tables + &PIECES.replace("@piece@", &CURVE_PIECE.to_string()).replace("@calls@", &calls)
}

/// Template of the statement that copies the pieces at these coordinates; empty without curves.
pub fn place_pieces(step: &DrivenStep, indent: &str, coordinates: &str) -> String {
    match step.curves.is_empty() {
        true => String::new(),
        false => format!("{indent}@name@_place_pieces({coordinates});\n"),
    }
}
