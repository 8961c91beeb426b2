//! Suspension templates of Project Chrono's vehicle module (JSON): one side as in the file, or both sides with the
//! right one as mirror image.

use hardpoint::space::Vec3;

use crate::chrono_part::{self, Masses};
use crate::corner::{Corner, LOWER_ARM, Link, Mount, Role, TIE_ROD, UPPER_ARM, plain, spin_axis};
use crate::mechanism::Mechanism;
use crate::report::ImportLog;
use crate::tree::{self, Tree};
use crate::{Format, Input, chrono_axle, chrono_generic, robot};

/// Chrono format.
pub const FORMAT: Format = Format {
    name: "chrono",
    about: "Chrono suspension",
    endings: &["json"],
    recognises: |text| text.contains("\"Template\"") && text.contains("\"Type\""),
    read,
    binary: false,
};

/// Templates with a known topology.
const TEMPLATES: [&str; 8] = [
    "DoubleWishbone",
    "DoubleWishboneReduced",
    "SAEToeBarDoubleWishbone",
    "MacPhersonStrut",
    "MultiLink",
    "SemiTrailingArm",
    "ThreeLinkIRS",
    GENERIC,
];
/// Template whose file lists its bodies and joints.
const GENERIC: &str = "GenericWheeledSuspension";

/// Keys of the static wheel angles.
const ANGLES: [&str; 2] = ["Camber Angle (deg)", "Toe Angle (deg)"];

/// Locations of an arm.
const ARM: [&str; 3] = ["Location Chassis Front", "Location Chassis Back", "Location Upright"];
/// Ends of a strut, damper and spring, chassis first.
const STRUT: [Role; 2] = [Role::StrutTop, Role::StrutBottom];
const DAMPER: [Role; 2] = [Role::DamperChassis, Role::DamperMoving];
const SPRING: [Role; 2] = [Role::SpringChassis, Role::SpringMoving];

/// Returns the static camber and toe, rad; 0 by default.
fn angles(root: &Tree) -> [f64; 2] {
    ANGLES.map(|key| root.get(key).and_then(Tree::number).unwrap_or(0.0).to_radians())
}

fn read(input: &mut Input<'_>, notes: &mut ImportLog) -> Option<Mechanism> {
    let root = tree::json(input.text, notes)?;
    let kind = root.text_of("Type").unwrap_or_default();
    let template = root.get("Template");
    let name = template.and_then(Tree::text).unwrap_or_default();
    let at = template.map(|t| t.at).or(Some(root.at));
    if !kind.eq_ignore_ascii_case("suspension") {
        let at = root.get("Type").map_or(root.at, |t| t.at);
        notes.problem_with(
            "HP0805",
            Some(at),
            format!("the file is of type `{kind}`, not `Suspension`"),
            "import the file of the suspension",
        );
        return None;
    }
    let all = || TEMPLATES.iter().chain(&chrono_axle::TEMPLATES);
    let Some(known) = all().find(|t| t.eq_ignore_ascii_case(name)) else {
        let help = format!("the known templates are {}", all().copied().collect::<Vec<_>>().join(", "));
        notes.problem_with("HP0805", at, format!("the template `{name}` is unknown"), &help);
        return None;
    };
    let title = root.text_of("Name").filter(|n| !n.trim().is_empty()).unwrap_or(input.stem);
    let mut m = Mechanism::new(title, "m", "deg");
    if *known == GENERIC {
        return chrono_generic::read(&root, m, angles(&root), notes);
    }
    if chrono_axle::TEMPLATES.contains(known) {
        return chrono_axle::read(&root, m, known, angles(&root), notes);
    }
    let mut reader = Reader {
        root: &root,
        m: &mut m,
        notes,
        corner: Corner { at: Some(root.at), rack: true, ..Corner::default() },
    };
    reader.members(known);
    let mut corner = reader.corner;
    let is = |role| corner.points.contains_key(&role);
    let members = match (is(Role::StrutTop), root.get("Spring").is_some()) {
        (true, true) => [("Spring", "coilover"), ("Shock", "damper")],
        (true, false) => [("Spring", "spring"), ("Shock", "coilover")],
        (false, _) => [("Spring", "spring"), ("Shock", "damper")],
    };
    corner.springs = chrono_part::springs(&root, &members, notes);
    let arms = ELASTIC.map(|(part, _)| part);
    chrono_part::account(&root, PARTS, &arms, notes);
    let mut rack = None;
    if notes.problem_count() == 0 && !corner.build(&mut m, notes, &mut rack) {
        let message = format!("points of the template `{name}` are missing");
        notes.problem_with("HP0803", at, message, "add the locations of its arms and links");
    }
    if notes.problem_count() == 0 {
        masses(&root, &mut m, known, &corner, notes);
        bushings(&root, &mut m, notes);
    }
    Some(m)
}

/// Parts that may have a bushing at their hinge on the chassis, with the name of the hinge in the model.
const ELASTIC: [(&str, &str); 5] = [
    ("Upper Control Arm", "upper_arm_pivot"),
    ("Upper Arm", "upper_arm_pivot"),
    ("Lower Control Arm", "lower_arm_pivot"),
    ("Control Arm", "lower_arm_pivot"),
    ("Trailing Arm", "trailing_arm_pivot"),
];
/// Parts of the templates that are read.
const PARTS: &[&str] = &[
    "Spindle",
    "Upright",
    "Upper Control Arm",
    "Lower Control Arm",
    "Control Arm",
    "Strut",
    "Upper Arm",
    "Lateral",
    "Trailing Link",
    "Trailing Arm",
    "Upper Link",
    "Lower Link",
    "Tierod",
    "Spring",
    "Shock",
];

/// Adds the masses of the parts to their bodies, or to the ends of rods, along the axes that Chrono uses for each part.
fn masses(root: &Tree, m: &mut Mechanism, template: &str, corner: &Corner, notes: &mut ImportLog) {
    let point = |part: &str, key: &str| root.get(part).and_then(|p| p.get(key)?.vector()).map(Vec3::from);
    let outer = |part: &str| point(part, "Location Upright").or_else(|| point(part, "Location Arm"));
    let ends = |part: &str| point(part, "Location Chassis").zip(outer(part)).map(<[Vec3; 2]>::from);
    let between = |[a, b]: [Vec3; 2]| (a + b) * 0.5;
    let mut masses = Masses { root, m, notes, side: 1.0, suffix: "" };
    masses.on("Spindle", "upright", None, corner.spin_axis.and_then(chrono_part::spindle_axes));
    masses.on("Upright", "upright", None, None);
    for (part, body) in [
        ("Upper Control Arm", "upper_arm"),
        ("Upper Arm", "upper_arm"),
        ("Lower Control Arm", "lower_arm"),
        ("Control Arm", "lower_arm"),
    ] {
        masses.arm(part, body, ARM);
    }
    masses.on("Strut", "strut", ends("Spring").or_else(|| ends("Shock")).map(between), None);
    if template == "SemiTrailingArm" {
        let places = ["Location Chassis Outer", "Location Chassis Inner", "Location Spindle"];
        masses.arm("Trailing Arm", "upright", places);
    } else if let Some((chassis, spindle)) =
        point("Trailing Arm", "Location Chassis").zip(point("Trailing Arm", "Location Spindle"))
    {
        masses.on("Trailing Arm", "upright", None, chrono_part::level_axes(chassis - spindle));
    }
    for part in ["Lateral", "Trailing Link", "Upper Link", "Lower Link"] {
        let Some(places) = ends(part) else { continue };
        let body = plain(part);
        if masses.m.bodies.iter().any(|b| b.name == body) {
            // z along the link, y perpendicular to its plane with the spring.
            let seat = point("Spring", "Location Link").or_else(|| outer("Spring"));
            let [chassis, upright] = places;
            let axes = seat
                .and_then(|s| chrono_part::link_axes(chassis - upright, (upright - s).cross(chassis - s)));
            masses.on(part, &body, Some(between(places)), axes);
        } else {
            masses.rod(part, ["ground", "upright"], places);
        }
    }
    if let Some(places) = ends("Tierod") {
        masses.rod("Tierod", ["rack", "upright"], places);
    }
    robot::standard_gravity(m, notes, "a Chrono suspension");
}

/// Adds the stiffness of bushings to the hinges of arms.
fn bushings(root: &Tree, m: &mut Mechanism, notes: &mut ImportLog) {
    for (part, pivot) in ELASTIC {
        let Some(data) = root.get(part).and_then(|p| p.get(chrono_part::BUSHING)) else { continue };
        let joint = m.joints.iter().position(|j| j.name == pivot);
        let found = joint.and_then(|k| Some((k, m.joints[k].through?)));
        let Some((joint, [from, to])) = found else {
            let why = "the part has no hinge on the chassis in the model";
            notes.refused(chrono_part::BUSHING, part, Some(data.at), why);
            continue;
        };
        // Chrono has the bushing of an arm halfway between its pivots.
        let offset = (to - from).norm() / 2.0;
        chrono_part::bushing(m, notes, data, joint, [false, false, true], offset);
    }
}

struct Reader<'r> {
    root: &'r Tree,
    m: &'r mut Mechanism,
    notes: &'r mut ImportLog,
    corner: Corner,
}

impl Reader<'_> {
    /// Returns a location of a part, by the first of some keys that is present.
    fn location(&mut self, part: &str, names: &[&str]) -> Option<Vec3> {
        let Some(tree) = self.root.get(part) else {
            self.notes.problem_with(
                "HP0803",
                Some(self.root.at),
                format!("the part `{part}` is missing"),
                "add the part, or export the template again",
            );
            return None;
        };
        let Some(found) = names.iter().find_map(|n| tree.get(n)) else {
            let message = format!("`{part}` has no `{}`", names[0]);
            self.notes.problem_with("HP0803", Some(tree.at), message, "add it as a list of three numbers");
            return None;
        };
        let v = found.vector();
        if v.is_none() {
            let message = format!("`{}` of `{part}` must be three numbers", names[0]);
            self.notes.problem_with(
                "HP0804",
                Some(found.at),
                message,
                "write it as a list like `[0, 0.7, 0.2]`",
            );
        }
        v.map(Vec3::from)
    }

    fn point(&mut self, part: &str, names: &[&str], role: Role) {
        if let Some(v) = self.location(part, names) {
            let short = names[0].trim_start_matches("Location ");
            self.m.hardpoints.push((plain(&format!("{part} {short}")), v));
            let at = self.root.get(part).map(|t| t.at);
            self.notes.taken("location", &format!("{part}, {short}"), at);
            self.corner.points.insert(role, v);
        }
    }

    fn arm(&mut self, part: &str, roles: [Role; 3], names: &[&str; 3]) {
        for (role, name) in roles.into_iter().zip(names) {
            self.point(part, &[name], role);
        }
    }

    /// Reads both ends of a tie rod, spring or shock, chassis first; springs and shocks are optional.
    fn pair(&mut self, part: &str, [chassis, moving]: [Role; 2], ends: &[&str]) {
        if self.root.get(part).is_none() && part != "Tierod" {
            return;
        }
        self.point(part, &["Location Chassis", "Location Chassis Front"], chassis);
        self.point(part, ends, moving);
    }

    fn link(&mut self, part: &str) {
        let outer = ["Location Upright", "Location Arm"];
        let ends = [self.location(part, &["Location Chassis"]), self.location(part, &outer)];
        if let [Some(i), Some(j)] = ends {
            let name = plain(part);
            let pin = |key: &str| self.root.get(part)?.get(key)?.vector().map(Vec3::from);
            let pins = pin("Universal Joint Axis Chassis").zip(pin("Universal Joint Axis Link"));
            for (end, v) in [("chassis", i), ("upright", j)] {
                self.m.hardpoints.push((format!("{name}_{end}"), v));
            }
            self.corner.links.push(Link {
                name,
                ends: [i, j],
                pins: pins.map(Into::into),
                at: self.root.get(part).map(|t| t.at),
            });
        }
    }

    /// Reads the points of a template by the roles they have in a corner.
    fn members(&mut self, template: &str) {
        match template {
            "MacPhersonStrut" => {
                self.arm("Control Arm", LOWER_ARM, &ARM);
                // The strut of Chrono slides along its spring.
                let strut = if self.root.get("Spring").is_some() { "Spring" } else { "Shock" };
                self.pair(strut, STRUT, &["Location Upright"]);
                if strut != "Shock" {
                    self.pair("Shock", DAMPER, &["Location Upright"]);
                    self.corner.damper_on = Some(Mount::Upright);
                }
            }
            "MultiLink" => {
                self.arm("Upper Arm", UPPER_ARM, &ARM);
                for link in ["Lateral", "Trailing Link"] {
                    self.link(link);
                }
                // Spring and shock act on the trailing link.
                let ends = ["Location Link", "Location Upright"];
                self.pair("Shock", DAMPER, &ends);
                self.pair("Spring", SPRING, &ends);
                self.corner.spring_on = Some(Mount::Link("trailing_link".into()));
            }
            "ThreeLinkIRS" => {
                self.point("Trailing Arm", &["Location Chassis"], Role::TrailingBall);
                for link in ["Upper Link", "Lower Link"] {
                    self.link(link);
                }
                self.pair("Shock", DAMPER, &["Location Arm"]);
                self.pair("Spring", SPRING, &["Location Arm"]);
                self.corner.spring_on = Some(Mount::Upright);
            }
            "SemiTrailingArm" => {
                self.arm(
                    "Trailing Arm",
                    [Role::TrailingA, Role::TrailingB, Role::Spindle],
                    &["Location Chassis Inner", "Location Chassis Outer", "Location Spindle"],
                );
                self.corner.points.remove(&Role::Spindle);
                self.pair("Shock", DAMPER, &["Location Arm"]);
                self.pair("Spring", SPRING, &["Location Arm"]);
                self.corner.spring_on = Some(Mount::Upright);
            }
            _ => {
                self.arm("Upper Control Arm", UPPER_ARM, &ARM);
                self.arm("Lower Control Arm", LOWER_ARM, &ARM);
                let ends = ["Location Arm", "Location Upright"];
                // In the reduced template, one element is both spring and shock.
                let is_both = self.root.get("Spring").is_none() && self.root.get("Shock").is_some();
                self.pair("Shock", if is_both { STRUT } else { DAMPER }, &ends);
                self.pair("Spring", SPRING, &ends);
                let reduced = template.ends_with("Reduced");
                self.corner.spring_on = Some(if reduced { Mount::Upright } else { Mount::Lower });
            }
        }
        if !["SemiTrailingArm", "ThreeLinkIRS"].contains(&template) {
            self.pair("Tierod", TIE_ROD, &["Location Upright"]);
        }
        self.wheel();
    }

    /// Reads the wheel centre and the spin axis: that of the spindle, along y except for the static angles.
    fn wheel(&mut self) {
        if let Some(centre) = self.location("Spindle", &["COM", "Location"]) {
            self.m.hardpoints.push(("spindle".into(), centre));
            self.corner.points.insert(Role::WheelCentre, centre);
            let [camber, toe] = angles(self.root);
            let side = if centre.y < 0.0 { -1.0 } else { 1.0 };
            // Toe-in turns the outboard axis forward, camber tilts it down.
            self.corner.spin_axis = Some(spin_axis(side, camber, toe));
        }
    }
}
