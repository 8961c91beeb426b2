//! Subset of DXF (AutoCAD 2000) for a skeleton: layers, points, texts and lines in model space.
//!
//! A drawing of this version requires its tables, the blocks of model space and paper space, and a root dictionary,
//! each object with its own handle. [`HEAD`], [`MIDDLE`] and [`TAIL`] contain the objects that are the same in every
//! drawing.

use std::fmt::Write;

/// Sections before the layers, up to layer 0.
const HEAD: &str = include_str!("head.dxf");
/// Sections between the layers and the entities.
const MIDDLE: &str = include_str!("middle.dxf");
/// Sections after the entities.
const TAIL: &str = include_str!("tail.dxf");
/// First handle that the fixed sections do not use.
const FIRST_FREE: usize = 0x100;
/// AutoCAD's colours from red to magenta (1 to 6), which the layers of bodies cycle through.
const COLOURS: usize = 6;
/// Colour of the first layer: black or white, depending on the background.
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
    /// Adds a layer and returns its name: the given one with forbidden characters replaced, and numbered if it is in
    /// use.
    pub(super) fn add_layer(&mut self, name: &str) -> String {
        let allowed = |c: char| if FORBIDDEN.contains(&c) || c.is_control() { '_' } else { c };
        let plain = single_line(&name.chars().map(allowed).collect::<String>());
        let mut own = plain.clone();
        let mut k = 1;
        // Layer 0 exists in every drawing.
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

    /// Returns the whole file; `unit` is the code of $INSUNITS for its lengths.
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

/// Formats a number with all digits, in plain or exponent notation, always with a decimal point.
pub(super) fn number(x: f64) -> String {
    format!("{x:?}")
}

/// Group codes of a point; `code` is that of its x coordinate.
pub(super) fn point(code: usize, at: [f64; 3]) -> String {
    let group = |(k, x): (usize, &f64)| format!("{:3}\n{}\n", code + 10 * k, number(*x));
    at.iter().enumerate().map(group).collect()
}

/// Returns a text on one line, with characters outside ASCII encoded as this version of the format requires.
pub(super) fn single_line(text: &str) -> String {
    let letter = |c: char| match c {
        c if c.is_control() => " ".to_owned(),
        c if c.is_ascii() => c.to_string(),
        // The escape has four digits: a character beyond them takes two, as in UTF-16.
        c => c.encode_utf16(&mut [0; 2]).iter().map(|unit| format!("\\U+{unit:04X}")).collect(),
    };
    text.chars().map(letter).collect()
}
