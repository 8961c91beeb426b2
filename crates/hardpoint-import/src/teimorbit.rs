//! Hardpoints in the TeimOrbit format of Adams/Car (`[HARDPOINT]` blocks of subsystems), left, right or single.

use std::collections::{BTreeMap, BTreeSet};

use hardpoint::space::Vec3;

use crate::corner::{Corner, Link, ONLY_LISTED, plain, role_of, spin_axis};
use crate::live_axle::{self, SideHardpoints};
use crate::lotus::half_round;
use crate::mechanism::{Mechanism, end_named};
use crate::report::{ImportLog, SourceSpan};
use crate::sides::SIDES;
use crate::{Format, Input, teimorbit_blocks};

/// TeimOrbit format.
pub const FORMAT: Format = Format {
    name: "teimorbit",
    about: "TeimOrbit hardpoints",
    endings: &["sub", "hpt", "txt", "teim"],
    recognises: |text| text.lines().any(|l| l.trim().eq_ignore_ascii_case("[HARDPOINT]")),
    read,
    binary: false,
};

/// Columns of parameters.
const PARAMETERS: [&str; 4] = ["parameter_name", "symmetry", "type", "value"];
/// Default columns of hardpoints.
const COLUMNS: [&str; 5] = ["hardpoint_name", "symmetry", "x_value", "y_value", "z_value"];

fn read(input: &mut Input<'_>, notes: &mut ImportLog) -> Option<Mechanism> {
    let mut m = Mechanism::new(input.stem, "mm", "deg");
    let Subsystem { sides, rows, parameters, blocks, hardpoints, has_units } =
        Subsystem::parse(input.text, &mut m, notes);
    let Some(block) = hardpoints else {
        notes.problem_with(
            "HP0803",
            None,
            "the block `[HARDPOINT]` is missing",
            "import the subsystem file (.sub) with the hardpoints; an assembly (.asy) names its subsystems",
        );
        return None;
    };
    if !has_units {
        notes.approximated("UNITS", "", None, "the file defines no unit of length: millimetres are assumed");
    }
    notes.approximated(
        "axes",
        "",
        Some(block),
        "rotated by 180 deg about z, so that x points forward and y left",
    );
    let end = blocks.iter().find_map(|b| end_named(b.value("MINOR_ROLE")?));
    let places = sides.each_ref().map(|side| side.places.clone());
    let corner =
        |side: Side| Corner { at: Some(block), rack: true, radius: parameters.radius, end, ..side.corner() };
    let [left, right, single] = sides.map(corner);
    let links = [&left, &right, &single].into_iter().flat_map(|corner| &corner.links);
    let links: BTreeSet<String> = links.map(|link| link.name.clone()).collect();
    let mut corners = [left, right];
    for (side, corner) in corners.iter_mut().enumerate() {
        let [camber, toe] = parameters.angles[side];
        if [camber, toe] != [0.0; 2] {
            corner.spin_axis = Some(spin_axis(SIDES[side].0, camber, toe));
        }
        corner.suffix = SIDES[side].1.into();
    }
    let topology = build(&mut m, notes, &places, &corners, &single);
    let is_on_link = |name: &str| rod_end(name).is_some_and(|(rod, _)| links.contains(rod));
    let has_role = |name: &str| role_of(name).is_some();
    let unplaced: BTreeSet<String> = match topology {
        // The names are part of the error.
        None => BTreeSet::new(),
        Some(Topology::LiveAxle) => live_axle::unplaced(&places, has_role).into_iter().collect(),
        Some(Topology::Corners) => {
            let names = places.iter().flat_map(|side| &side.named).map(|(name, _)| name);
            names.filter(|name| !has_role(name) && !is_on_link(name)).cloned().collect()
        }
    };
    for Row { name, plain, at } in rows {
        if unplaced.contains(&plain) {
            notes.approximated("hardpoint", &name, Some(at), ONLY_LISTED);
        } else {
            notes.taken("hardpoint", &name, Some(at));
        }
    }
    if topology.is_none() {
        m.unplaced = Some(live_axle::unplaced(&places, has_role));
        if live_axle::has_leaf_springs(&places) {
            let why = "leaf springs guide the axle by bending, which the model does not support";
            notes.refused("hardpoint", "leaf spring", Some(block), why);
        }
    }
    teimorbit_blocks::read_blocks(&blocks, &mut m, parameters.mass_is_kg, notes);
    (!m.hardpoints.is_empty()).then_some(m)
}

/// Suspension that the hardpoints belong to.
enum Topology {
    LiveAxle,
    Corners,
}

/// Adds a live axle or the corners, of which a single one lists hardpoints without a side. Returns `None` if the
/// topology is unknown.
fn build(
    m: &mut Mechanism,
    notes: &mut ImportLog,
    places: &[SideHardpoints; 3],
    corners: &[Corner; 2],
    single: &Corner,
) -> Option<Topology> {
    if live_axle::names_one(places) && live_axle::build(m, notes, places, corners, single.at) {
        return Some(Topology::LiveAxle);
    }
    let mut rack = None;
    let mut is_known = false;
    for corner in corners.iter().filter(|c| !c.points.is_empty() || !c.links.is_empty()) {
        let mut corner = corner.clone();
        for (role, place) in &single.points {
            corner.points.entry(*role).or_insert(*place);
        }
        is_known |= corner.build(m, notes, &mut rack);
    }
    if !(is_known || single.points.is_empty() && single.links.is_empty()) {
        is_known = single.build(m, notes, &mut rack);
    }
    if is_known {
        return Some(Topology::Corners);
    }
    // Arms without ball joints are not links of an axle.
    let has_arms = corners.iter().flat_map(|c| c.points.keys()).any(|role| role.is_of_an_arm());
    (!has_arms && live_axle::build(m, notes, places, corners, single.at)).then_some(Topology::LiveAxle)
}

/// Contents of a subsystem file.
#[derive(Default)]
struct Subsystem {
    /// Left, right and without a side.
    sides: [Side; 3],
    /// All rows of hardpoints.
    rows: Vec<Row>,
    parameters: Parameters,
    /// Blocks other than those of hardpoints, parameters and units.
    blocks: Vec<Block>,
    /// Position of the first block of hardpoints.
    hardpoints: Option<SourceSpan>,
    /// True if the file defines the unit of length.
    has_units: bool,
}

impl Subsystem {
    /// Reads the blocks of a file line by line; hardpoints, variables and units are added to the mechanism.
    fn parse(text: &str, m: &mut Mechanism, notes: &mut ImportLog) -> Self {
        let mut subsystem = Self::default();
        let Self { sides, rows, parameters, blocks, hardpoints, has_units } = &mut subsystem;
        let (mut section, mut columns) = (String::new(), COLUMNS.map(str::to_owned).to_vec());
        let mut start = 0;
        for whole in text.split_inclusive('\n') {
            let line = whole.split(['$', '!']).next().unwrap_or_default().trim();
            let from = start + whole.len() - whole.trim_start().len();
            let at = SourceSpan { text: 0, start: from, end: from + line.len() };
            start += whole.len();
            if line.is_empty() {
                continue;
            }
            if let Some(name) = line.strip_prefix('[').and_then(|l| l.split(']').next()) {
                section = name.trim().to_ascii_uppercase();
                match section.as_str() {
                    "HARDPOINT" => {
                        columns = COLUMNS.map(str::to_owned).to_vec();
                        *hardpoints = hardpoints.or(Some(at));
                    }
                    "UNITS" | "MDI_HEADER" => {}
                    "PARAMETER" => columns = PARAMETERS.map(str::to_owned).to_vec(),
                    other => blocks.push(Block { name: other.to_owned(), at, values: Vec::new() }),
                }
                continue;
            }
            // `(COMMENTS)`, or `(VARIANTS)`, whose rows belong to other designs.
            if line.starts_with('(') {
                if ["HARDPOINT", "PARAMETER"].contains(&section.as_str()) {
                    notes.ignored(line, Some(at));
                }
                section = line.to_owned();
                continue;
            }
            match section.as_str() {
                "UNITS" => {
                    *has_units |= unit(m, line, at, notes);
                    parameters.mass_is_kg &= !is_other_mass(line);
                }
                "PARAMETER" | "HARDPOINT" => match line.strip_prefix('{') {
                    Some(header) => {
                        let names = header.trim_end_matches('}').split_whitespace();
                        columns = names.map(|n| n.to_ascii_lowercase()).collect();
                    }
                    None if section == "PARAMETER" => parameters.row(m, &columns, line, at, notes),
                    None => rows.extend(row(m, sides, &columns, line, at, notes)),
                },
                _ => {
                    let value = line.split_once('=').map(|(key, value)| {
                        (key.trim().to_ascii_uppercase(), value.trim().trim_matches(['\'', '"']).to_owned())
                    });
                    if let (Some(block), Some(value)) =
                        (blocks.last_mut().filter(|b| b.name == section), value)
                    {
                        block.values.push(value);
                    }
                }
            }
        }
        subsystem
    }
}

/// Block of keys and values.
pub struct Block {
    /// Name, in capital letters.
    pub name: String,
    /// Position of its heading.
    pub at: SourceSpan,
    /// Keys in capital letters, with their values.
    pub values: Vec<(String, String)>,
}

impl Block {
    /// Returns the value of a key.
    pub fn value(&self, key: &str) -> Option<&str> {
        self.values.iter().find(|(k, _)| k == key).map(|(_, value)| value.as_str())
    }

    /// Returns the number of a key.
    pub fn number(&self, key: &str) -> Option<f64> {
        number(self.value(key)?)
    }
}

/// Reads a finite number; its exponent may begin with D.
fn number(word: &str) -> Option<f64> {
    word.to_ascii_lowercase().replace('d', "e").parse().ok().filter(|x: &f64| x.is_finite())
}

/// Returns true if a line of units defines another unit of mass than kilograms.
fn is_other_mass(line: &str) -> bool {
    let Some((key, value)) = line.split_once('=') else { return false };
    let unit = value.trim().trim_matches(['\'', '"']).to_ascii_lowercase();
    key.trim().eq_ignore_ascii_case("MASS") && !["kg", "kilogram"].contains(&unit.as_str())
}

/// Hardpoints of one side, or those without a side.
#[derive(Default)]
struct Side {
    corner: Corner,
    /// Ends of rods by their names, inboard first, for names without another role.
    rods: BTreeMap<String, [Option<Vec3>; 2]>,
    /// All hardpoints, for a live axle.
    places: SideHardpoints,
}

impl Side {
    /// Returns the corner. Pairs of inner and outer points are links if their number makes it a multi-link suspension.
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

/// Suffixes of the names of a rod's ends.
const ENDS: [[&str; 3]; 2] = [["_inner", "_inboard", "_chassis"], ["_outer", "_outboard", "_upright"]];

/// Returns the rod whose end has this name, and the number of the end.
fn rod_end(name: &str) -> Option<(&str, usize)> {
    let rods = ENDS.iter().enumerate();
    rods.flat_map(|(end, words)| words.iter().map(move |word| (word, end)))
        .find_map(|(word, end)| Some((name.strip_suffix(word)?, end)))
}

/// Row of a hardpoint.
struct Row {
    name: String,
    /// Name in lower case without the side.
    plain: String,
    at: SourceSpan,
}

/// Parameters of the subsystem that are imported.
#[derive(Debug)]
struct Parameters {
    /// Static camber and toe of both sides, rad.
    angles: [[f64; 2]; 2],
    /// Radius of the wheel, from its centre to the road.
    radius: Option<f64>,
    /// True if masses are in kg.
    mass_is_kg: bool,
}

impl Default for Parameters {
    fn default() -> Self {
        Self { angles: [[0.0; 2]; 2], radius: None, mass_is_kg: true }
    }
}

/// Names of parameters: static angles, vehicle parameters, and wheel radii with the loaded radius first.
const ANGLES: [&str; 2] = ["camber_angle", "toe_angle"];
const WHEELBASE: [&str; 1] = ["wheelbase"];
const HEIGHT: [&str; 3] = ["cg_height", "cog_height", "centre_of_gravity_height"];
const RADII: [&str; 6] = [
    "tire_loaded_radius",
    "loaded_radius",
    "rolling_radius",
    "wheel_radius",
    "tire_radius",
    "tire_unloaded_radius",
];

impl Parameters {
    /// Reads a row: static camber and toe, which define the spin axis, or parameters of the vehicle.
    fn row(
        &mut self,
        m: &mut Mechanism,
        columns: &[String],
        line: &str,
        at: SourceSpan,
        notes: &mut ImportLog,
    ) {
        let words = words(line);
        let column = |name: &str| columns.iter().position(|c| c == name).and_then(|k| words.get(k));
        let name = column("parameter_name").map_or("", String::as_str);
        let short = ["pvl_", "pvr_", "pvs_"].iter().find_map(|p| name.strip_prefix(p)).unwrap_or(name);
        let is = |list: &[&str]| list.contains(&short);
        if !(is(&ANGLES) || is(&WHEELBASE) || is(&HEIGHT) || is(&RADII)) {
            if column("type").is_some_and(|kind| kind.eq_ignore_ascii_case("real")) {
                notes.not_understood("PARAMETER", name, Some(at), "unknown parameter");
            } else {
                notes.ignored("PARAMETER", Some(at));
            }
            return;
        }
        let Some(value) = column("value").and_then(|v| number(v)) else {
            let help = format!("write a value for each of the columns {}", columns.join(", "));
            notes.problem_with("HP0804", Some(at), format!("`{name}` is not a number"), &help);
            return;
        };
        if let Some(k) = ANGLES.iter().position(|angle| *angle == short) {
            let symmetry = column("symmetry").map_or("", String::as_str).to_ascii_lowercase();
            for (side, own) in ["left", "right"].into_iter().enumerate() {
                if symmetry == own || symmetry != ["right", "left"][side] {
                    self.angles[side][k] = value.to_radians();
                }
            }
        } else if !(value > 0.0) {
            notes.refused("PARAMETER", name, Some(at), format!("{value} is not a valid length"));
            return;
        } else if is(&WHEELBASE) {
            m.vehicle.wheelbase = Some(value);
        } else if is(&HEIGHT) {
            m.vehicle.cg_height = Some(value);
        } else if self.radius.is_none() || short != RADII[RADII.len() - 1] {
            self.radius = Some(value);
        }
        notes.taken("PARAMETER", name, Some(at));
    }
}

/// Reads the unit of length. Returns true if the line defines it.
fn unit(m: &mut Mechanism, line: &str, at: SourceSpan, notes: &mut ImportLog) -> bool {
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
            notes.problem_with("HP0804", Some(at), format!("`{word}` is not a known unit of length"), help);
            "mm"
        }
    };
    notes.taken("UNITS", "", Some(at));
    true
}

/// Returns the words of a row; quoted words may contain blanks.
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

fn row(
    m: &mut Mechanism,
    sides: &mut [Side; 3],
    columns: &[String],
    line: &str,
    at: SourceSpan,
    notes: &mut ImportLog,
) -> Option<Row> {
    let words = words(line);
    let column = |names: [&str; 2]| {
        columns.iter().position(|c| names.contains(&c.as_str())).and_then(|k| words.get(k))
    };
    let name = column(["hardpoint_name", "name"]);
    let value = |axis: [&str; 2]| column(axis).and_then(|w| number(w));
    let place = [value(["x_value", "x"]), value(["y_value", "y"]), value(["z_value", "z"])];
    let (Some(name), [Some(x), Some(y), Some(z)]) = (name, place) else {
        let help = format!("write a value for each of the columns {}", columns.join(", "));
        notes.problem_with(
            "HP0804",
            Some(at),
            "the row is not a hardpoint with a name and three numbers",
            &help,
        );
        return None;
    };
    let symmetry = column(["symmetry", "symmetry"]).map_or("", String::as_str).to_ascii_lowercase();
    let place = half_round([x, y, z]);
    let mirrored = Vec3::from([place.x, -place.y, place.z]);
    let (short, prefix) =
        match ["hpl_", "hpr_", "hps_"].iter().find_map(|p| Some((name.strip_prefix(p)?, *p))) {
            Some((short, prefix)) => (short, prefix),
            None => (name.as_str(), ""),
        };
    // The side is not appended if it is already the first or last word of the name.
    let mut put = |k: usize, suffix: &str, place: Vec3| {
        let word = suffix.trim_start_matches('_');
        let in_front = short.strip_prefix(word).and_then(|s| s.strip_prefix('_'));
        let own = in_front.or_else(|| short.strip_suffix(suffix)).filter(|_| !word.is_empty());
        let plain = plain(own.unwrap_or(short));
        m.hardpoints.push((if own.is_some() { short.to_owned() } else { format!("{short}{suffix}") }, place));
        sides[k].places.named.push((plain.clone(), place));
        if let Some(role) = role_of(&plain) {
            sides[k].corner.points.insert(role, place);
        } else if let Some((rod, end)) = rod_end(&plain) {
            sides[k].rods.entry(rod.to_owned()).or_default()[end] = Some(place);
        }
        plain
    };
    let plain = match (symmetry.as_str(), prefix) {
        ("left/right" | "symmetric", _) => {
            // The row defines the left point, at negative y in Adams/Car.
            let plain = put(0, "_left", place);
            put(1, "_right", mirrored);
            plain
        }
        ("left", _) | ("", "hpl_") => put(0, "_left", place),
        ("right", _) | ("", "hpr_") => put(1, "_right", place),
        _ => put(2, "", place),
    };
    Some(Row { name: name.clone(), plain, at })
}
