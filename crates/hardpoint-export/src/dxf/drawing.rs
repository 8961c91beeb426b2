//! The part of DXF (AutoCAD 2000) that a skeleton needs: layers, points, texts and lines in model space.
//!
//! A drawing of this version needs its tables, the blocks of model space and paper space, and a root dictionary, each
//! object with a handle of its own; [`HEAD`], [`MIDDLE`] and [`TAIL`] hold those that are the same in every drawing.

use std::fmt::Write;

/// Sections before the layers, up to layer 0.
const HEAD: &str = include_str!("head.dxf");
/// Sections between the layers and the entities.
const MIDDLE: &str = include_str!("middle.dxf");
/// Sections after the entities.
const TAIL: &str = include_str!("tail.dxf");
/// First handle that the fixed sections leave free.
const FIRST_FREE: usize = 0x100;
/// AutoCAD's colours from red to magenta (1 to 6), for the layers of bodies in turn.
const COLOURS: usize = 6;
/// Colour of the first layer: black or white, whichever is seen.
const FOREGROUND: usize = 7;
/// Characters that names of layers must not contain.
const FORBIDDEN: [char; 13] = ['<', '>', '/', '\\', '"', ':', ';', '?', '*', '|', ',', '=', '`'];

/// A drawing under construction.
#[derive(Default)]
pub(super) struct Drawing {
    names: Vec<String>,
    layers: String,
    entities: String,
    handles: usize,
}

impl Drawing {
    /// Adds a layer and returns its name: the given one, with forbidden characters replaced, and numbered where it is
    /// taken.
    pub(super) fn add_layer(&mut self, name: &str) -> String {
        let allowed = |c: char| if FORBIDDEN.contains(&c) || c.is_control() { '_' } else { c };
        let plain = single_line(&name.chars().map(allowed).collect::<String>());
        let mut own = plain.clone();
        let mut k = 1;
        // Layer 0 is in every drawing.
        while own == "0" || own.is_empty() || self.names.iter().any(|n| n.eq_ignore_ascii_case(&own)) {
            k += 1;
            own = format!("{plain}_{k}");
        }
        let colour = self.names.len().checked_sub(1).map_or(FOREGROUND, |k| k % COLOURS + 1);
        let handle = self.next_handle();
        let _ = write!(
            self.layers,
            "  0\nLAYER\n  5\n{handle}\n330\n2\n100\nAcDbSymbolTableRecord\n100\nAcDbLayerTableRecord\n  2\n{own}\n 70\n0\n \
             62\n{colour}\n  6\nContinuous\n370\n-3\n390\n15\n"
        );
        self.names.push(own.clone());
        own
    }

    /// Adds an entity of a class to model space; `groups` are its own group codes and values.
    pub(super) fn add_entity(&mut self, layer: &str, kind: &str, class: &str, groups: &str) {
        let handle = self.next_handle();
        let _ = write!(
            self.entities,
            "  0\n{kind}\n  5\n{handle}\n330\n21\n100\nAcDbEntity\n  8\n{layer}\n100\n{class}\n{groups}"
        );
    }

    /// The whole file, its lengths in the unit of a code of $INSUNITS.
    pub(super) fn to_text(&self, unit: usize) -> String {
        let seed = format!("{:X}", FIRST_FREE + self.handles);
        let head = HEAD.replace("@UNITS@", &unit.to_string()).replace("@SEED@", &seed);
        let head = head.replace("@LAYERS@", &(self.names.len() + 1).to_string());
        [&head, &self.layers, MIDDLE, &self.entities, TAIL].concat().replace('\n', "\r\n")
    }

    fn next_handle(&mut self) -> String {
        self.handles += 1;
        format!("{:X}", FIRST_FREE + self.handles - 1)
    }
}

/// A number with all its digits, in plain notation or with an exponent, and always with a decimal point.
pub(super) fn number(x: f64) -> String {
    format!("{x:?}")
}

/// The group codes of a point whose x coordinate has this code.
pub(super) fn point(code: usize, at: [f64; 3]) -> String {
    let group = |(k, x): (usize, &f64)| format!("{:3}\n{}\n", code + 10 * k, number(*x));
    at.iter().enumerate().map(group).collect()
}

/// A text on one line, with characters outside ASCII as this version of the format encodes them.
pub(super) fn single_line(text: &str) -> String {
    let letter = |c: char| match c {
        c if c.is_control() => " ".to_owned(),
        c if c.is_ascii() => c.to_string(),
        // Four digits are all that the escape has: a character beyond them is two, as UTF-16 encodes it.
        c => c.encode_utf16(&mut [0; 2]).iter().map(|unit| format!("\\U+{unit:04X}")).collect(),
    };
    text.chars().map(letter).collect()
}
