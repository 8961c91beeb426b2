//! Further blocks of Adams/Car subsystems: masses of parts, and elements whose characteristics are in property files.

use hardpoint::space::{Mat3, Pose, Vec3};

use crate::lotus::half_round;
use crate::markers::ElementSource;
use crate::mechanism::Mechanism;
use crate::report::ImportLog;
use crate::robot;
use crate::sides::{SIDES, over};
use crate::teimorbit::Block;
use crate::turn::none;

/// Words in the names of parts, by their body. The first match is used.
const PARTS: [(&str, &[&str]); 6] = [
    ("lower_arm", &["lower_control_arm", "lower_arm", "lca", "control_arm"]),
    ("upper_arm", &["upper_control_arm", "upper_arm", "uca"]),
    ("upright", &["upright", "knuckle", "hub", "spindle", "wheel_carrier"]),
    ("rocker", &["bellcrank", "rocker"]),
    ("strut", &["strut"]),
    ("axle", &["axle"]),
];

/// Reads the masses of parts, and reports the other blocks.
pub fn read_blocks(blocks: &[Block], m: &mut Mechanism, is_kg: bool, notes: &mut ImportLog) {
    for block in blocks {
        let usage = block.value("USAGE").unwrap_or_default();
        match block.name.as_str() {
            "PART_ASSEMBLY" if is_kg => part(block, usage, m, notes),
            "PART_ASSEMBLY" => {
                notes.refused("mass", usage, Some(block.at), "masses are supported in kilograms only");
            }
            name if name.ends_with("_ASSEMBLY") => {
                let file =
                    ["PROPERTY_FILE", "PROPERTY_FILE_LIST"].into_iter().find_map(|key| block.value(key));
                let why = match file {
                    Some(file) => {
                        format!("its characteristic is in the property file `{file}`, which is not imported")
                    }
                    None => "its characteristic is not in the file".into(),
                };
                notes.refused(name, usage, Some(block.at), why);
            }
            other => notes.ignored(other, Some(block.at)),
        }
    }
    robot::standard_gravity(m, notes, "an Adams/Car subsystem");
}

/// Adds the mass of a part on each side that has its body.
fn part(block: &Block, usage: &str, m: &mut Mechanism, notes: &mut ImportLog) {
    let Some(mass) = block.number("MASS").filter(|mass| *mass != 0.0) else {
        notes.ignored(&block.name, Some(block.at));
        return;
    };
    let name = crate::corner::plain(usage);
    let found = PARTS.iter().find(|(_, words)| words.iter().any(|word| name.contains(word)));
    let place = ["X", "Y", "Z"].map(|axis| block.number(&format!("PART_LOC_{axis}")));
    let (Some((body, _)), [Some(x), Some(y), Some(z)]) = (found, place) else {
        notes.refused(
            "mass",
            usage,
            Some(block.at),
            "it has no body in the model, or no position in the file",
        );
        return;
    };
    // From the square of the length unit to m^2.
    let unit = (1e-3 / m.per_mm()).powi(2);
    let numbers =
        ["IXX", "IYY", "IZZ", "IXY", "IYZ", "IZX"].map(|key| unit * block.number(key).unwrap_or(0.0));
    let [xx, yy, zz, xy, yz, zx] = numbers;
    // Half a turn about z: x and y change sign. Products of inertia are integrals: the entries of the matrix have the
    // opposite sign.
    let rows = [[xx, -xy, zx], [-xy, yy, yz], [zx, yz, zz]];
    let has_side = |suffix: &str| m.bodies.iter().position(|b| b.name == format!("{body}{suffix}"));
    let symmetry = block.value("SYMMETRY").unwrap_or_default().to_ascii_lowercase();
    let carriers: Vec<(f64, &str, usize)> = match symmetry.as_str() {
        "left/right" => SIDES.iter().filter_map(|(side, s)| Some((*side, *s, has_side(s)?))).collect(),
        "left" => has_side("_left").map(|b| (1.0, "_left", b)).into_iter().collect(),
        "right" => has_side("_right").map(|b| (1.0, "_right", b)).into_iter().collect(),
        _ => has_side("").map(|b| (1.0, "", b)).into_iter().collect(),
    };
    if carriers.is_empty() {
        notes.refused("mass", usage, Some(block.at), "it has no body in the model");
        return;
    }
    for (side, suffix, carrier) in carriers {
        let mut cols = rows.map(Vec3::from);
        if side < 0.0 {
            cols = cols.map(|c| over(c, -1.0));
            cols[1] = -cols[1];
        }
        let frame = Pose { rot: none(), r: over(half_round([x, y, z]), side) };
        let name = format!("{name}{suffix}");
        let source = ElementSource { kind: "mass", name: &name, at: Some(block.at) };
        robot::mass(m, notes, source, carrier, frame, mass, Some(Mat3 { cols }));
    }
    if numbers.iter().any(|x| *x != 0.0) {
        let why = "its moments of inertia are assumed to refer to the axes of the vehicle";
        notes.approximated("inertia", usage, Some(block.at), why);
    }
}
