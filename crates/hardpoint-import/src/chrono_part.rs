//! Masses, springs and dampers of the parts in Project Chrono's suspension templates.

use std::collections::BTreeMap;

use hardpoint::space::{Mat3, Pose, Vec3};

use crate::corner::plain;
use crate::markers::ElementSource;
use crate::mechanism::{Force, ForceOn, GROUND, JointElasticity, Mechanism, Spring};
use crate::report::{ImportLog, SourceSpan};
use crate::robot;
use crate::sides::{over, with_word};
use crate::tree::{Tree, Value};
use crate::turn::{Z, from_z_and_x, none};

/// Keys of a part that are read.
const READ: &[&str] = &[
    "Name",
    "Attachment Body",
    "Mass",
    "COM",
    "Inertia",
    "Moments of Inertia",
    "Products of Inertia",
    "Inertia Moments",
    "Inertia Products",
    "Free Length",
    "Spring Coefficient",
    "Damping Coefficient",
    "Preload",
    "Curve Data",
    "Spring Curve Data",
    "Damping Curve Data",
    "Map Data",
    "Deformation",
    "Degressivity Compression",
    "Degressivity Expansion",
    "Position",
    "Rotation",
    "Coordinate System",
    "Type",
    "Mirrored",
    "Body1",
    "Body2",
    "Point1",
    "Point2",
];
/// Keys of a part for visualisation.
const DRAWN: [&str; 3] = ["Radius", "Width", "Visualization"];
/// Keys of the stops of a spring.
const STOPS: [&str; 2] = ["Minimum Length", "Maximum Length"];

/// Key of the bushing of a joint or part.
pub const BUSHING: &str = "Bushing Data";

/// Adds a bushing to the joint with this index. `free` are the rotations that the joint leaves free, about its axes in
/// the model. The bushing is at a distance along z from the joint's location.
pub fn bushing(
    m: &mut Mechanism,
    notes: &mut ImportLog,
    data: &Tree,
    joint: usize,
    free: [bool; 3],
    offset: f64,
) {
    let at = Some(data.at);
    let name = m.joints[joint].name.clone();
    let of = |tree: Option<&Tree>, key: &str| tree.and_then(|t| t.get(key)?.number());
    let [slide, turn] = ["Stiffness Linear", "Stiffness Rotational"].map(|key| of(Some(data), key));
    let free_turn = of(data.get("DOF"), "Stiffness Rotational").unwrap_or(0.0);
    let (Some(slide), Some(turn)) = (slide, turn) else {
        notes.refused(BUSHING, &name, at, "it has no `Stiffness Linear` or no `Stiffness Rotational`");
        return;
    };
    let is_held = free.contains(&false);
    if !(slide > 0.0 && slide.is_finite() && turn.is_finite() && (turn > 0.0 || !is_held) && free_turn >= 0.0)
    {
        let why = "a bushing without stiffness in a direction of its joint has no equivalent";
        notes.refused(BUSHING, &name, at, why);
        return;
    }
    // `DOF` has the same keys, for the directions that the joint leaves free: of these it has rotations only.
    const KEYS: [&str; 4] =
        ["Stiffness Linear", "Stiffness Rotational", "Damping Linear", "Damping Rotational"];
    for (key, at, _) in data.entries() {
        if !KEYS.contains(&key.as_str()) && key != "DOF" {
            notes.not_understood(key, &name, Some(*at), "unknown key of a bushing");
        }
    }
    for (key, at, _) in data.get("DOF").into_iter().flat_map(Tree::entries) {
        if !KEYS.contains(&key.as_str()) {
            notes.not_understood(key, &name, Some(*at), "unknown key of the `DOF` of a bushing");
        }
    }
    let per_angle = m.per_angle();
    let turns = free.map(|is_free| if is_free { free_turn } else { turn } * per_angle);
    let stiffness = [slide, slide, slide, turns[0], turns[1], turns[2]];
    let source = ElementSource { kind: BUSHING, name: &name, at };
    m.force(Force {
        name: with_word(&name, "bushing"),
        note: source.note(notes),
        on: ForceOn::Joint(joint, JointElasticity { stiffness, offset }),
        spring: Spring::default(),
    });
    let damping = [Some(data), data.get("DOF")]
        .into_iter()
        .flat_map(|tree| ["Damping Linear", "Damping Rotational"].map(|key| of(tree, key).unwrap_or(0.0)));
    if damping.into_iter().any(|c| c != 0.0) {
        let why = "its damping is not imported: elastic joints of the model deflect at rest";
        notes.approximated(BUSHING, &name, at, why);
    } else {
        notes.taken(BUSHING, &name, at);
    }
}

/// Mass and inertia of a part about its centre of mass, along its own axes.
pub struct Inertial {
    /// Mass, kg.
    pub mass: f64,
    /// Inertia matrix, kg m^2.
    pub inertia: Option<Mat3>,
}

impl Inertial {
    /// Reads the inertia of a part that has a mass.
    pub fn of(part: &Tree) -> Option<Self> {
        let mass = part.get("Mass")?.number()?;
        let vector = |keys: [&str; 3]| keys.iter().find_map(|key| part.get(key)?.vector());
        let moments = vector(["Inertia", "Moments of Inertia", "Inertia Moments"]);
        // In Chrono, products of inertia are the entries xy, xz, yz of the matrix.
        let [xy, xz, yz] = vector(["Products of Inertia", "Inertia Products", ""]).unwrap_or_default();
        let matrix =
            |[x, y, z]: [f64; 3]| Mat3 { cols: [[x, xy, xz], [xy, y, yz], [xz, yz, z]].map(Vec3::from) };
        Some(Self { mass, inertia: moments.map(matrix) })
    }
}

/// Transfer of the masses of parts to the bodies of a mechanism.
pub struct Masses<'r> {
    /// File.
    pub root: &'r Tree,
    /// Mechanism that receives the masses.
    pub m: &'r mut Mechanism,
    /// Log of the import.
    pub notes: &'r mut ImportLog,
    /// 1 on the left, the side in the file, and -1 on the right.
    pub side: f64,
    /// Suffix of names of that side.
    pub suffix: &'static str,
}

impl Masses<'_> {
    /// Reborrows it for another side.
    pub fn again(&mut self) -> Masses<'_> {
        Masses { root: self.root, m: self.m, notes: self.notes, side: self.side, suffix: self.suffix }
    }

    fn body(&self, name: &str) -> Option<usize> {
        self.m.bodies.iter().position(|b| b.name == name)
    }

    fn at(&self, part: &str) -> Option<SourceSpan> {
        self.root.get(part).map(|t| t.at)
    }

    /// Adds the mass of a part to a body. `centre` is the centre on the left if the part has none of its own; `axes`
    /// are the axes on this side if they are not the global ones.
    pub fn on(&mut self, part: &str, body: &str, centre: Option<Vec3>, axes: Option<Mat3>) {
        let Some(tree) = self.root.get(part) else { return };
        let Some(Inertial { mass, inertia }) = Inertial::of(tree) else { return };
        let name = format!("{}{}", plain(part), self.suffix);
        let own = tree.get("COM").and_then(Tree::vector).map(Vec3::from);
        let (Some(centre), Some(body)) = (own.or(centre), self.body(body)) else {
            let why = "the part has no centre in the file, or no body in the model: its mass is not imported";
            self.notes.refused("mass", &name, Some(tree.at), why);
            return;
        };
        let is_global = self.root.text_of("Vehicle-Frame Inertia") == Some("true");
        let rot = axes.filter(|_| !is_global).unwrap_or_else(none);
        let frame = Pose { rot, r: over(centre, self.side) };
        let source = ElementSource { kind: "mass", name: &name, at: Some(tree.at) };
        robot::mass(self.m, self.notes, source, body, frame, mass, inertia);
    }

    /// Adds the mass of an arm, whose axes are in the plane of three locations: x from the second to the first, z
    /// perpendicular to the plane.
    pub fn arm(&mut self, part: &str, body: &str, places: [&str; 3]) {
        let place = |key: &str| self.root.get(part).and_then(|p| p.get(key)?.vector()).map(Vec3::from);
        let [Some(f), Some(b), Some(u)] = places.map(place) else { return };
        self.on(part, body, None, from_z_and_x((b - u).cross(f - u), f - b));
    }

    /// Adds the mass of a rod, which has no body, to its ends in proportion to the position of its centre.
    pub fn rod(&mut self, part: &str, carriers: [&str; 2], ends: [Vec3; 2]) {
        let Some(tree) = self.root.get(part) else { return };
        let Some(Inertial { mass, .. }) = Inertial::of(tree).filter(|i| i.mass != 0.0) else { return };
        let name = format!("{}{}", plain(part), self.suffix);
        if !(mass > 0.0 && mass.is_finite()) {
            self.notes.refused("mass", &name, Some(tree.at), format!("invalid mass of {mass} kg"));
            return;
        }
        let along = ends[1] - ends[0];
        let own = tree.get("COM").and_then(Tree::vector).map(Vec3::from);
        let outer = own.map_or(0.5, |c| ((c - ends[0]).dot(along) / along.dot(along)).clamp(0.0, 1.0));
        for (k, share) in [1.0 - outer, outer].into_iter().enumerate() {
            let body = self.body(carriers[k]).filter(|b| *b != GROUND && share > 0.0);
            if let Some(body) = body {
                self.m.mass(crate::mechanism::Mass {
                    name: with_word(&name, ["inner", "outer"][k]),
                    body,
                    centre: over(ends[k], self.side),
                    mass: share * mass,
                    inertia: None,
                });
            }
        }
        let why = "the rod has no body in the model: its mass is divided between its ends to preserve the centre, its inertia is not imported";
        self.notes.approximated("mass", &name, self.at(part), why);
    }
}

/// Axes of a spindle: y along the spin axis, x horizontal.
pub fn spindle_axes(axis: Vec3) -> Option<Mat3> {
    // The same direction on both sides.
    let y = if axis.y < 0.0 { -axis } else { axis };
    let x = y.cross(Z.into()).unit()?;
    Some(Mat3 { cols: [x, y, x.cross(y)] })
}

/// Axes of a link: z along the link, y as near as possible to another direction.
pub fn link_axes(along: Vec3, y: Vec3) -> Option<Mat3> {
    from_z_and_x(along, y.cross(along))
}

/// Axes of an arm along x, with y horizontal.
pub fn level_axes(along: Vec3) -> Option<Mat3> {
    let z = along.cross(Vec3::from(Z).cross(along));
    from_z_and_x(z, along)
}

/// Returns the characteristics and positions of the springs and dampers among the parts, by the names of their members.
pub fn springs(
    root: &Tree,
    parts: &[(&str, &'static str)],
    notes: &mut ImportLog,
) -> BTreeMap<&'static str, (Spring, SourceSpan)> {
    let mut found = BTreeMap::new();
    for (part, member) in parts {
        let Some(tree) = root.get(part) else { continue };
        found.extend(spring(tree, part, notes).map(|spring| (*member, (spring, tree.at))));
    }
    found
}

/// Returns the characteristic of a spring or damper, if the model supports it. The force that separates its ends is
/// `Preload - Coefficient (length - Free Length)`.
pub fn spring(part: &Tree, name: &str, notes: &mut ImportLog) -> Option<Spring> {
    let number = |key: &str| part.get(key).and_then(Tree::number);
    let at = |key: &str| part.get(key).map(|t| t.at);
    let [stiffness, damping, preload] =
        ["Spring Coefficient", "Damping Coefficient", "Preload"].map(|key| number(key).unwrap_or(0.0));
    if !(stiffness >= 0.0 && damping >= 0.0) {
        let why = format!("invalid stiffness {stiffness} or damping {damping}");
        notes.refused("force", name, Some(part.at), why);
        return None;
    }
    for key in STOPS.into_iter().filter(|key| part.get(key).is_some()) {
        notes.refused(key, name, at(key), "its stop is not imported: the force is not in the file");
    }
    let length = number("Free Length");
    let is_spring = length.is_some();
    for (key, is_damping) in [("Damping Curve Data", true), ("Curve Data", !is_spring), ("Map Data", true)] {
        if is_damping && part.get(key).is_some() {
            let why = "nonlinear damping has no equivalent";
            notes.refused(key, name, at(key), why);
        }
    }
    if let Some(key) =
        ["Degressivity Compression", "Degressivity Expansion"].into_iter().find(|k| part.get(k).is_some())
    {
        notes.approximated(
            key,
            name,
            at(key),
            "its damping is linear in the model, with the coefficient at low speeds",
        );
    }
    let curve =
        ["Spring Curve Data", "Curve Data"].into_iter().find(|key| is_spring && part.get(key).is_some());
    let points = curve.and_then(|key| Some((key, points(part.get(key)?))));
    let extension: Vec<[f64; 2]> = match points {
        Some((key, Some(points))) => {
            let why = "piecewise linear in the source, a smooth curve through the points in the model";
            notes.approximated(key, name, at(key), why);
            points.into_iter().map(|[x, force]| [x, force - preload]).collect()
        }
        Some((key, None)) => {
            notes.refused(key, name, at(key), "it is not a list of two or more points in increasing order");
            Vec::new()
        }
        None => Vec::new(),
    };
    if stiffness == 0.0 && damping == 0.0 && extension.is_empty() {
        return None;
    }
    if stiffness > 0.0 && length.is_none() {
        notes.approximated(
            "force",
            name,
            Some(part.at),
            "it has no `Free Length`: the length in the design configuration is used",
        );
    }
    let is_curve = !extension.is_empty();
    let free =
        if is_curve { length } else { length.filter(|_| stiffness > 0.0).map(|l| l + preload / stiffness) };
    let preload = (free.is_none() && preload != 0.0).then_some(-preload);
    let stiffness = if is_curve { 0.0 } else { stiffness };
    Some(Spring { stiffness, damping, free, preload, extension })
}

/// Returns two or more points in increasing order.
fn points(list: &Tree) -> Option<Vec<[f64; 2]>> {
    let Value::List(rows) = &list.value else { return None };
    let point = |row: &Tree| match &row.value {
        Value::List(pair) => {
            <[f64; 2]>::try_from(pair.iter().map(Tree::number).collect::<Option<Vec<_>>>()?).ok()
        }
        Value::Map(_) | Value::Scalar(..) => None,
    };
    let points = rows.iter().map(point).collect::<Option<Vec<_>>>()?;
    (points.len() >= 2 && points.windows(2).all(|w| w[0][0] < w[1][0])).then_some(points)
}

/// Accounts for all keys of the file besides the parts that were read: those with other content, and unknown keys.
/// Bushings of elastic parts have been read as well.
pub fn account(root: &Tree, read: &[&str], elastic: &[&str], notes: &mut ImportLog) {
    for (key, at, value) in root.entries() {
        match key.as_str() {
            "Name" | "Type" | "Template" | "Vehicle-Frame Inertia" | "Independent" | "Steerable" => {}
            _ if key.ends_with("Angle (deg)") => {
                notes.taken(key, value.text().unwrap_or_default(), Some(*at))
            }
            "Axle" => {
                let why = "the wheel does not spin in the model: the inertia of its shaft is not imported";
                notes.refused(key, "", Some(*at), why);
            }
            "Anti Roll Bar" => {
                let why = "anti-roll bars are not imported";
                notes.refused(key, "", Some(*at), why);
            }
            "Antiroll Body" => notes.ignored(key, Some(*at)),
            _ if read.contains(&key.as_str()) => part(key, value, elastic.contains(&key.as_str()), notes),
            _ => notes.not_understood(key, "", Some(*at), "unknown part of this template"),
        }
    }
}

/// Accounts for the keys of a part, whose bushing may have been read.
pub fn part(name: &str, part: &Tree, is_elastic: bool, notes: &mut ImportLog) {
    for (key, at, _) in part.entries() {
        let known = |list: &[&str]| list.contains(&key.as_str());
        if key.starts_with("Location")
            || key.starts_with("Universal Joint Axis")
            || known(READ)
            || known(&STOPS)
        {
            continue;
        }
        if known(&DRAWN) {
            notes.ignored(key, Some(*at));
        } else if key.starts_with("Bushing") && !(key == BUSHING && is_elastic) {
            notes.refused(
                key,
                name,
                Some(*at),
                "this bushing is not imported: the joint is rigid in the model",
            );
        } else if key != BUSHING {
            notes.not_understood(key, name, Some(*at), "unknown key of the part");
        }
    }
}
