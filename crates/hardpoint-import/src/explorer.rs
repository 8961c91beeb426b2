//! Geometry files of suspension-explorer (YAML): corners and axles recognised by the names of their hardpoints.

use hardpoint::model::{Vehicle, VehicleEnd};
use hardpoint::space::Vec3;

use crate::corner::{Corner, Link, Mount, ONLY_LISTED, plain, role_of};
use crate::mechanism::{Mechanism, end_named};
use crate::report::{ImportLog, SourceSpan};
use crate::sides::{self, over};
use crate::tree::{self, Tree};
use crate::{FEW_DIGITS, Format, Input};

/// suspension-explorer format.
pub const FORMAT: Format = Format {
    name: "suspension-explorer",
    about: "suspension-explorer geometry",
    endings: &["yaml", "yml"],
    recognises: |text| text.lines().any(|l| l.starts_with("hardpoints:") || l.starts_with("hard_points:")),
    read,
    binary: false,
};

/// Suspension types whose parts follow from the names of their hardpoints.
const TYPES: [&str; 5] = ["double_wishbone", "macpherson", "macpherson_strut", "multi_link", "trailing_arm"];

fn read(input: &mut Input<'_>, notes: &mut ImportLog) -> Option<Mechanism> {
    let root = tree::yaml(input.text, notes)?;
    let points = root.get("hardpoints").or_else(|| root.get("hard_points"));
    let Some(points) = points.filter(|p| !p.entries().is_empty()) else {
        let help = "write them as `hardpoints:` with entries like `strut_top: {x: 0, y: 700, z: 850}`";
        notes.problem_with("HP0803", Some(root.at), "the file has no `hardpoints`", help);
        return None;
    };
    let name = root.text_of("name").filter(|n| !n.trim().is_empty()).unwrap_or(input.stem);
    let mut m = Mechanism::new(name, units(&root, notes), "deg");
    if let Some(kind) = root
        .get("type")
        .filter(|t| !t.text().is_some_and(|t| TYPES.contains(&plain(t).trim_end_matches("_axle"))))
    {
        let why = "the type is unknown: the topology follows from the names of the hardpoints";
        notes.approximated("type", kind.text().unwrap_or_default(), Some(kind.at), why);
    }
    let sides: Vec<&str> = ["left", "right"].into_iter().filter(|s| points.get(s).is_some()).collect();
    let mut rack = None;
    let mut known = true;
    let mut made = false;
    if sides.is_empty() {
        let mut corner = Corner { at: Some(points.at), ..settings(&root, m.per_mm(), notes) };
        collect(points, "", &mut corner, &mut m, notes, "");
        mount(&root, &mut corner);
        if root.text_of("side").is_some_and(|s| s.eq_ignore_ascii_case("right"))
            && corner.points.values().all(|p| p.y > 0.0)
        {
            notes.approximated(
                "side",
                "right",
                root.get("side").map(|s| s.at),
                "its hardpoints have positive y, which is the left side: they are used as written",
            );
        }
        known &= corner.build(&mut m, notes, &mut rack);
        made = true;
    }
    for side in &sides {
        let Some(list) = points.get(side) else { continue };
        let mut corner =
            Corner { suffix: format!("_{side}"), at: Some(list.at), ..settings(&root, m.per_mm(), notes) };
        collect(list, "", &mut corner, &mut m, notes, &format!("_{side}"));
        mount(&root, &mut corner);
        known &= corner.build(&mut m, notes, &mut rack);
        made = true;
        if sides.len() == 1 {
            let other = if *side == "left" { "_right" } else { "_left" };
            notes.approximated(
                "side",
                other.trim_start_matches('_'),
                Some(list.at),
                "the file defines one side: the other side is its mirror image",
            );
            let images: Vec<(String, Vec3)> =
                m.hardpoints.iter().map(|(name, at)| (sides::other(name), over(*at, -1.0))).collect();
            m.hardpoints.extend(images);
            known &= corner.mirrored(other).build(&mut m, notes, &mut rack);
        }
    }
    if let Some(centre) = points.get("center").or_else(|| points.get("centre")) {
        for (name, at, _) in centre.entries() {
            notes.refused(
                "hardpoint",
                name,
                Some(*at),
                "members between both sides (anti-roll bar, heave link) are not imported",
            );
        }
    }
    vehicle(&root, &mut m, notes);
    account(&root, notes);
    if !known {
        m.bodies.truncate(1);
        m.joints.clear();
        m.drivers.clear();
        m.wheels.clear();
    }
    made.then_some(m)
}

fn units(root: &Tree, notes: &mut ImportLog) -> &'static str {
    let Some(units) = root.get("units") else {
        notes.approximated("units", "", Some(root.at), "the file defines no unit: millimetres are assumed");
        return "mm";
    };
    match units.text().unwrap_or_default().to_ascii_lowercase().as_str() {
        "millimeters" | "millimetres" | "mm" => "mm",
        "meters" | "metres" | "m" => "m",
        "centimeters" | "centimetres" | "cm" => "cm",
        "inches" | "inch" | "in" => "in",
        other => {
            let message = format!("`{other}` is not a known unit of length");
            notes.problem_with(
                "HP0804",
                Some(units.at),
                message,
                "write `millimeters`, `meters` or `inches`",
            );
            "mm"
        }
    }
}

/// Returns the settings of the corner or axle.
fn config(root: &Tree) -> Option<&Tree> {
    ["axle_config", "config", "configuration"].into_iter().find_map(|key| root.get(key))
}

/// Reads the settings of steering and wheel.
fn settings(root: &Tree, per_mm: f64, notes: &mut ImportLog) -> Corner {
    let config = config(root);
    let steering = config.and_then(|c| c.get("steering"));
    let kind = steering.and_then(|s| s.text_of("type").or(s.text())).unwrap_or("rack");
    let steered = config.and_then(|c| c.text_of("steered")).is_none_or(|s| s != "false");
    let tire = config.and_then(|c| c.get("wheel")).and_then(|w| w.get("tire").or_else(|| w.get("tyre")));
    let number = |key: &str| tire.and_then(|t| t.get(key)).and_then(Tree::number);
    // Rims are in inches and tyres in millimetres, independent of the unit of the hardpoints.
    let radius = match (number("aspect_ratio"), number("section_width"), number("rim_diameter")) {
        (Some(aspect), Some(width), Some(rim)) => Some((aspect * width + rim * 25.4 / 2.0) * per_mm),
        _ => number("nominal_radius").or_else(|| number("radius")),
    };
    let offset = config.and_then(|c| c.get("wheel")).and_then(|w| w.get("offset"));
    if let Some(offset) = offset.filter(|o| o.number().is_some_and(|x| x != 0.0)) {
        notes.approximated(
            "wheel",
            "offset",
            Some(offset.at),
            "the wheel centre is placed at the end of the axle, without its offset",
        );
    }
    let own = config.iter().flat_map(|c| c.entries()).filter(|(key, ..)| !key.ends_with("_setup"));
    let setups = ["setup", "left_setup", "right_setup"].into_iter();
    let setups = setups.filter_map(|key| config.and_then(|c| c.get(key)));
    for (key, at, shim) in setups.flat_map(|s| s.entries()).chain(own) {
        let thickness = ["design_thickness", "setup_thickness"].map(|k| shim.get(k).and_then(Tree::number));
        if !key.ends_with("_shim") {
            continue;
        }
        if thickness[0] == thickness[1] {
            notes.ignored(key, Some(*at));
        } else {
            let why = "the parts are imported as designed, without the shim of the setup";
            notes.refused(key, "", Some(*at), why);
        }
    }
    let end = config.and_then(|c| c.text_of("axle_position")).and_then(end_named);
    Corner { rack: steered && !kind.eq_ignore_ascii_case("none"), radius, end, ..Corner::default() }
}

/// Reads the parameters of the vehicle; those of a corner are among its settings.
fn vehicle(root: &Tree, m: &mut Mechanism, notes: &mut ImportLog) {
    let found =
        |key: &str| [root.get("vehicle_config"), config(root)].into_iter().flatten().find_map(|c| c.get(key));
    let mut figure = |key: &str, value: &dyn Fn(&Tree) -> Option<f64>, is_valid: &dyn Fn(f64) -> bool| {
        let tree = found(key)?;
        let figure = value(tree).filter(|x| is_valid(*x));
        match figure {
            Some(_) => notes.taken(key, "", Some(tree.at)),
            None => {
                let why = "the value is not valid for a vehicle";
                notes.refused(key, tree.text().unwrap_or_default(), Some(tree.at), why);
            }
        }
        figure
    };
    let is_length = |x: f64| x > 0.0;
    let is_share = |x: f64| (0.0..=1.0).contains(&x);
    let driven = |tree: &Tree| {
        Some(match end_named(tree.text()?)? {
            VehicleEnd::Front => 1.0,
            VehicleEnd::Rear => 0.0,
        })
    };
    let road = m.wheels.first().map_or(0.0, |wheel| {
        let down = wheel.spin_axis.unit().map_or(1.0, |n| (1.0 - n.z * n.z).max(0.0).sqrt());
        let road = wheel.centre.z - wheel.radius * down;
        // Files have few digits: z = 0 is assumed for a wheel that touches it within these.
        if road.abs() <= FEW_DIGITS * wheel.radius { 0.0 } else { road }
    });
    m.vehicle = Vehicle {
        wheelbase: figure("wheelbase", &Tree::number, &is_length),
        cg_height: figure("cg_position", &|tree| Some(tree.vector()?[2] - road), &is_length),
        front_brake_share: figure("front_brake_bias", &Tree::number, &is_share),
        front_drive_share: figure("driven_axle", &driven, &is_share),
    };
}

/// Accounts for the settings besides the hardpoints.
fn account(root: &Tree, notes: &mut ImportLog) {
    const READ: [&str; 16] = [
        "hardpoints",
        "hard_points",
        "name",
        "units",
        "type",
        "side",
        "scope",
        "actuation",
        "steering",
        "steered",
        "wheel",
        "wheelbase",
        "cg_position",
        "front_brake_bias",
        "driven_axle",
        "axle_position",
    ];
    const GROUPS: [&str; 7] =
        ["config", "configuration", "axle_config", "vehicle_config", "setup", "left_setup", "right_setup"];
    const PARTS: [(&str, &[&str]); 5] = [
        ("steering", &["type"]),
        ("actuation", &["type", "mount"]),
        ("wheel", &["offset", "tire", "tyre"]),
        ("tire", TYRE),
        ("tyre", TYRE),
    ];
    const TYRE: &[&str] = &["aspect_ratio", "section_width", "rim_diameter", "nominal_radius", "radius"];
    let inner = root.entries().iter().filter(|(key, ..)| GROUPS.contains(&key.as_str()));
    let all = inner.flat_map(|(.., group)| group.entries()).chain(root.entries());
    let mut parts: Vec<_> = all.clone().collect();
    while let Some((key, _, tree)) = parts.pop() {
        let Some((_, known)) = PARTS.iter().find(|(part, _)| part == key) else { continue };
        for (inner, at, _) in tree.entries().iter().filter(|(inner, ..)| !known.contains(&inner.as_str())) {
            notes.not_understood(inner, key, Some(*at), format!("`{key}` has an unknown setting `{inner}`"));
        }
        parts.extend(tree.entries());
    }
    for (key, at, tree) in all {
        let kind = tree.text_of("type").or(tree.text()).unwrap_or_default();
        match key.as_str() {
            key if READ.contains(&key) || GROUPS.contains(&key) || key.ends_with("_shim") => {}
            "version" => notes.ignored(key, Some(*at)),
            "spring" | "damper" | "anti_roll" | "heave_link" if kind.eq_ignore_ascii_case("none") => {
                notes.ignored(key, Some(*at));
            }
            "spring" | "damper" if tree.entries().len() > 1 => {
                notes.not_understood(key, kind, Some(*at), "it has unknown values");
            }
            "spring" | "damper" => {
                let why = "the file defines its type only, without stiffness or damping: its length is measured if it has two ends, and it has no force";
                notes.refused(key, kind, Some(*at), why);
            }
            "anti_roll" | "heave_link" => {
                notes.refused(key, kind, Some(*at), "members between both sides are not imported");
            }
            "opposite_axle_axis_height" => {
                notes.refused(key, "", Some(*at), "no measure uses parameters of the other axle");
            }
            _ => notes.not_understood(key, "", Some(*at), "unknown setting"),
        }
    }
}

/// Reads the part that the rod or the coilover is attached to.
fn mount(root: &Tree, corner: &mut Corner) {
    let outer = root.get("axle_config").unwrap_or(root);
    let Some(actuation) = outer.get("actuation") else { return };
    let mount = actuation.text_of("mount").map(|mount| match plain(mount).as_str() {
        "lower_wishbone" | "lower_arm" => Mount::Lower,
        "upper_wishbone" | "upper_arm" => Mount::Upper,
        "upright" | "trailing_arm" => Mount::Upright,
        link if link.ends_with("_link") => Mount::Link(link.to_owned()),
        other => Mount::Nothing(other.to_owned()),
    });
    corner.rod_on = mount.clone();
    corner.spring_on = mount;
}

/// Collects the hardpoints of a corner, including grouped ones.
fn collect(
    list: &Tree,
    before: &str,
    corner: &mut Corner,
    m: &mut Mechanism,
    notes: &mut ImportLog,
    suffix: &str,
) {
    let mut links: Vec<(String, [Option<Vec3>; 2], SourceSpan)> = Vec::new();
    for (key, at, value) in list.entries() {
        let name = if before.is_empty() { key.clone() } else { format!("{before}_{key}") };
        let Some(v) = value.vector() else {
            if value.entries().iter().any(|(.., v)| !v.entries().is_empty() || v.vector().is_some()) {
                collect(value, &name, corner, m, notes, suffix);
            } else {
                let help = "write it as `{x: 0, y: 700, z: 850}`";
                notes.problem_with("HP0804", Some(value.at), format!("`{name}` must be three numbers"), help);
            }
            continue;
        };
        let v = Vec3::from(v);
        m.hardpoints.push((format!("{name}{suffix}"), v));
        notes.taken("hardpoint", &name, Some(*at));
        let ends = [("_link_inboard", 0), ("_link_outboard", 1), ("_link_inner", 0), ("_link_outer", 1)];
        match (role_of(&name), ends.iter().find_map(|(end, k)| Some((name.strip_suffix(end)?, *k)))) {
            (Some(role), _) => {
                corner.points.insert(role, v);
            }
            (None, Some((link, k))) => {
                let link = format!("{link}_link");
                match links.iter_mut().find(|(known, ..)| *known == link) {
                    Some((_, ends, _)) => ends[k] = Some(v),
                    None => {
                        let mut ends = [None; 2];
                        ends[k] = Some(v);
                        links.push((link, ends, *at));
                    }
                }
            }
            _ => {
                notes.approximated("hardpoint", &name, Some(*at), ONLY_LISTED);
            }
        }
    }
    for (name, ends, at) in links {
        match ends {
            [Some(i), Some(j)] => corner.links.push(Link { name, ends: [i, j], pins: None, at: Some(at) }),
            _ => notes.problem_with(
                "HP0803",
                Some(at),
                format!("`{name}` has only one end"),
                "add both `_inboard` and `_outboard`",
            ),
        }
    }
}
