//! Hardpoints in the TeimOrbit format of Adams/Car (`[HARDPOINT]` blocks of subsystems), left, right or single.

use std::collections::BTreeMap;

use hardpoint::space::Vec3;

use crate::corner::{Corner, Link, role_of, spin_axis};
use crate::lotus::half_round;
use crate::mechanism::Mechanism;
use crate::report::{At, Notes};
use crate::{Format, Input};

/// See the module.
pub const FORMAT: Format = Format {
    name: "teimorbit",
    about: "TeimOrbit hardpoints",
    endings: &["sub", "hpt", "txt", "teim"],
    looks: |text| text.lines().any(|l| l.trim().eq_ignore_ascii_case("[HARDPOINT]")),
    read,
    binary: false,
};

/// The columns of parameters.
const PARAMETERS: [&str; 4] = ["parameter_name", "symmetry", "type", "value"];
/// What a row's columns are, where the block does not say.
const COLUMNS: [&str; 5] = ["hardpoint_name", "symmetry", "x_value", "y_value", "z_value"];

fn read(input: &mut Input<'_>, notes: &mut Notes) -> Option<Mechanism> {
    let mut m = Mechanism::new(input.stem, "mm", "deg");
    let mut sides = [Side::default(), Side::default(), Side::default()];
    let (mut section, mut columns) = (String::new(), COLUMNS.map(str::to_owned).to_vec());
    let (mut start, mut block, mut has_units) = (0, None, false);
    // Camber and toe, of both sides.
    let mut static_angles = [[0.0; 2]; 2];
    for whole in input.text.split_inclusive('\n') {
        let line = whole.split(['$', '!']).next().unwrap_or_default().trim();
        let from = start + whole.len() - whole.trim_start().len();
        let at = At { text: 0, start: from, end: from + line.len() };
        start += whole.len();
        if line.is_empty() {
            continue;
        }
        if let Some(name) = line.strip_prefix('[').and_then(|l| l.split(']').next()) {
            section = name.trim().to_ascii_uppercase();
            match section.as_str() {
                "HARDPOINT" => {
                    columns = COLUMNS.map(str::to_owned).to_vec();
                    block = block.or(Some(at));
                }
                "UNITS" | "MDI_HEADER" => {}
                "PARAMETER" => columns = PARAMETERS.map(str::to_owned).to_vec(),
                other => notes.ignored(other, Some(at)),
            }
            continue;
        }
        // `(COMMENTS)`, or `(VARIANTS)`, whose rows are those of other designs.
        if line.starts_with('(') {
            if ["HARDPOINT", "PARAMETER"].contains(&section.as_str()) {
                notes.ignored(line, Some(at));
            }
            section = line.to_owned();
            continue;
        }
        match section.as_str() {
            "UNITS" => has_units |= unit(&mut m, line, at, notes),
            "PARAMETER" | "HARDPOINT" => match line.strip_prefix('{') {
                Some(header) => {
                    let names = header.trim_end_matches('}').split_whitespace();
                    columns = names.map(|n| n.to_ascii_lowercase()).collect();
                }
                None if section == "PARAMETER" => parameter(&mut static_angles, &columns, line, at, notes),
                None => row(&mut m, &mut sides, &columns, line, at, notes),
            },
            _ => {}
        }
    }
    let Some(block) = block else {
        notes.problem_with(
            "HP0803",
            None,
            "there is no block `[HARDPOINT]`",
            "import the subsystem file (.sub) that holds the hardpoints; an assembly (.asy) names its subsystems",
        );
        return None;
    };
    if !has_units {
        notes.approximated("UNITS", "", None, "the file names no unit of length: millimetres are taken");
    }
    notes.approximated(
        "axes",
        "",
        Some(block),
        "turned half round about z, so that x points forward and y left",
    );
    let [left, right, single] = sides.map(Side::corner);
    let mut rack = None;
    let mut known = false;
    for (corner, suffix) in [(left, "_left"), (right, "_right")] {
        if !corner.points.is_empty() || !corner.links.is_empty() {
            let mut corner = Corner { suffix: suffix.into(), at: Some(block), rack: true, ..corner };
            let side = if suffix == "_left" { 0 } else { 1 };
            let [camber, toe] = static_angles[side];
            if [camber, toe] != [0.0; 2] {
                corner.spin_axis = Some(spin_axis(1.0 - 2.0 * side as f64, camber, toe));
            }
            for (role, place) in &single.points {
                corner.points.entry(*role).or_insert(*place);
            }
            known |= corner.build(&mut m, notes, &mut rack);
        }
    }
    if !(known || single.points.is_empty() && single.links.is_empty()) {
        let corner = Corner { at: Some(block), rack: true, ..single };
        corner.build(&mut m, notes, &mut rack);
    }
    (!m.hardpoints.is_empty()).then_some(m)
}

/// The hardpoints of one side, or those without a side.
#[derive(Default)]
struct Side {
    corner: Corner,
    /// Ends of rods by their names, inboard first, of names that mean nothing else.
    rods: BTreeMap<String, [Option<Vec3>; 2]>,
}

impl Side {
    /// The corner. Pairs of inner and outer points are its rods where it is a multi-link suspension by their number.
    fn corner(self) -> Corner {
        let mut corner = self.corner;
        let rods: Vec<Link> = (self.rods.into_iter())
            .filter_map(|(name, [inner, outer])| {
                Some(Link { name, ends: [inner?, outer?], pins: None, at: corner.at })
            })
            .collect();
        if corner.is_held_by(rods.len()) {
            corner.links = rods;
        }
        corner
    }
}

/// Endings of the names of a rod's ends.
const ENDS: [[&str; 3]; 2] = [["_inner", "_inboard", "_chassis"], ["_outer", "_outboard", "_upright"]];

/// A row of a parameter: of static camber and toe, which the wheel's axis follows. Others do not concern the motion.
fn parameter(angles: &mut [[f64; 2]; 2], columns: &[String], line: &str, at: At, notes: &mut Notes) {
    let words = words(line);
    let column = |name: &str| columns.iter().position(|c| c == name).and_then(|k| words.get(k));
    let name = column("parameter_name").map_or("", String::as_str);
    let short = ["pvl_", "pvr_", "pvs_"].iter().find_map(|p| name.strip_prefix(p)).unwrap_or(name);
    let Some(k) = ["camber_angle", "toe_angle"].iter().position(|angle| *angle == short) else {
        notes.ignored("PARAMETER", Some(at));
        return;
    };
    let Some(value) = column("value").and_then(|v| v.parse::<f64>().ok()).filter(|v| v.is_finite()) else {
        let help = format!("its columns are {}", columns.join(", "));
        notes.problem_with("HP0804", Some(at), format!("`{name}` is no number"), &help);
        return;
    };
    let symmetry = column("symmetry").map_or("", String::as_str).to_ascii_lowercase();
    for (side, own) in ["left", "right"].into_iter().enumerate() {
        if symmetry == own || symmetry != ["right", "left"][side] {
            angles[side][k] = value.to_radians();
        }
    }
    notes.taken("PARAMETER", name, Some(at));
}

/// Whether the line says the unit of length.
fn unit(m: &mut Mechanism, line: &str, at: At, notes: &mut Notes) -> bool {
    let Some((key, value)) = line.split_once('=') else { return false };
    if !key.trim().eq_ignore_ascii_case("LENGTH") {
        return false;
    }
    let word = value.trim().trim_matches(['\'', '"']).to_ascii_lowercase();
    m.length = match word.as_str() {
        "mm" | "millimeter" | "millimetre" => "mm",
        "m" | "meter" | "metre" => "m",
        "cm" | "centimeter" => "cm",
        "inch" | "in" => "in",
        _ => {
            let help = "write 'mm', 'cm', 'meter' or 'inch'";
            notes.problem_with("HP0804", Some(at), format!("`{word}` is no unit of length"), help);
            "mm"
        }
    };
    notes.taken("UNITS", "", Some(at));
    true
}

/// The words of a row; those in quotes may have blanks in them.
fn words(line: &str) -> Vec<String> {
    let (mut out, mut quote, mut word) = (Vec::new(), None, String::new());
    for c in line.chars() {
        match (quote, c) {
            (Some(q), c) if c == q => {
                quote = None;
                out.push(std::mem::take(&mut word));
            }
            (None, '\'' | '"') => quote = Some(c),
            (None, c) if c.is_whitespace() || c == ',' => {
                if !word.is_empty() {
                    out.push(std::mem::take(&mut word));
                }
            }
            (_, c) => word.push(c),
        }
    }
    if !word.is_empty() {
        out.push(word);
    }
    out
}

fn row(m: &mut Mechanism, sides: &mut [Side; 3], columns: &[String], line: &str, at: At, notes: &mut Notes) {
    let words = words(line);
    let column = |names: [&str; 2]| {
        columns.iter().position(|c| names.contains(&c.as_str())).and_then(|k| words.get(k))
    };
    let name = column(["hardpoint_name", "name"]);
    let value = |axis: [&str; 2]| {
        column(axis)
            .and_then(|w| w.to_ascii_lowercase().replace('d', "e").parse::<f64>().ok())
            .filter(|x| x.is_finite())
    };
    let place = [value(["x_value", "x"]), value(["y_value", "y"]), value(["z_value", "z"])];
    let (Some(name), [Some(x), Some(y), Some(z)]) = (name, place) else {
        let help = format!("its columns are {}", columns.join(", "));
        notes.problem_with("HP0804", Some(at), "the row is no hardpoint: a name and three numbers", &help);
        return;
    };
    let symmetry = column(["symmetry", "symmetry"]).map_or("", String::as_str).to_ascii_lowercase();
    let place = half_round([x, y, z]);
    let mirrored = Vec3::from([place.x, -place.y, place.z]);
    let (short, prefix) =
        match ["hpl_", "hpr_", "hps_"].iter().find_map(|p| Some((name.strip_prefix(p)?, *p))) {
            Some((short, prefix)) => (short, prefix),
            None => (name.as_str(), ""),
        };
    // A side that is a word of the name is not named once more.
    let mut put = |k: usize, suffix: &str, place: Vec3| {
        let word = suffix.trim_start_matches('_');
        let own = short.strip_prefix(word).and_then(|s| s.strip_prefix('_')).filter(|_| !word.is_empty());
        let plain = crate::corner::plain(own.unwrap_or(short));
        m.hardpoints.push((if own.is_some() { short.to_owned() } else { format!("{short}{suffix}") }, place));
        if let Some(role) = role_of(&plain) {
            sides[k].corner.points.insert(role, place);
        }
        for (end, words) in ENDS.iter().enumerate() {
            if let (Some(rod), None) =
                (words.iter().find_map(|word| plain.strip_suffix(word)), role_of(&plain))
            {
                sides[k].rods.entry(rod.to_owned()).or_default()[end] = Some(place);
            }
        }
    };
    match (symmetry.as_str(), prefix) {
        ("left/right" | "symmetric", _) => {
            // Written is the left one, in Adams/Car at negative y.
            put(0, "_left", place);
            put(1, "_right", mirrored);
        }
        ("left", _) | ("", "hpl_") => put(0, "_left", place),
        ("right", _) | ("", "hpr_") => put(1, "_right", place),
        _ => put(2, "", place),
    }
    notes.taken("hardpoint", name, Some(at));
}
