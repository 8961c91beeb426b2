//! Template of Project Chrono whose file lists its bodies and joints (`GenericWheeledSuspension`): the left side, and
//! the right side as its mirror image if a body connects both.

use std::collections::BTreeMap;

use hardpoint::space::{Mat3, Vec3};

use crate::chrono_part::{self, Inertial, Masses};
use crate::corner::{Corner, spin_axis};
use crate::markers::ElementSource;
use crate::mechanism::{Force, ForceOn, GROUND, Joint, Mechanism, Spring};
use crate::report::{ImportLog, SourceSpan};
use crate::robot;
use crate::sides::{SIDES, over};
use crate::tree::{Tree, Value};

/// Bodies of the vehicle that are ground here.
const CHASSIS: [&str; 2] = ["Chassis", "Subchassis"];
/// Body of the vehicle that carries the tie rods.
const STEERING: &str = "Steering";

/// Keys of the lists of elements.
const LISTS: [&str; 4] = ["Bodies", "Joints", "Distance Constraints", "TSDAs"];

/// Reads a generic suspension; the angles are the static camber and toe of the wheels, rad.
pub fn read(
    root: &Tree,
    mut m: Mechanism,
    [camber, toe]: [f64; 2],
    notes: &mut ImportLog,
) -> Option<Mechanism> {
    let bodies = list(root, "Bodies");
    let between = bodies.iter().any(|b| !is_mirrored(b));
    let mut rack = None;
    let springs: BTreeMap<&str, Spring> = list(root, "TSDAs")
        .iter()
        .filter_map(|tree| {
            let name = tree.text_of("Name").unwrap_or_default();
            Some((name, chrono_part::spring(tree, name, notes)?))
        })
        .collect();
    for (side, suffix) in SIDES.into_iter().take(1 + usize::from(between)) {
        let suffix = if between { suffix } else { "" };
        let mut reader = Side {
            root,
            m: &mut m,
            notes,
            side,
            suffix,
            names: BTreeMap::new(),
            rack: &mut rack,
            springs: &springs,
        };
        reader.bodies(bodies);
        reader.joints();
        reader.rods();
        let spring = reader.springs();
        reader.wheel(spin_axis(side, camber, toe), spring);
    }
    for tree in LISTS.into_iter().flat_map(|key| list(root, key)) {
        // Bushings belong to joints.
        chrono_part::part(tree.text_of("Name").unwrap_or_default(), tree, tree.get("Type").is_some(), notes);
    }
    for tree in list(root, "RSDAs") {
        let why = "rotational springs between bodies have no equivalent";
        notes.refused("RSDA", tree.text_of("Name").unwrap_or_default(), Some(tree.at), why);
    }
    let read: Vec<&str> = LISTS.into_iter().chain(["RSDAs", "Spindle"]).collect();
    chrono_part::account(root, &read, &[], notes);
    robot::standard_gravity(&mut m, notes, "a Chrono suspension");
    Some(m)
}

struct Side<'r> {
    root: &'r Tree,
    m: &'r mut Mechanism,
    notes: &'r mut ImportLog,
    /// 1 on the left, -1 on the right.
    side: f64,
    suffix: &'static str,
    /// Bodies by their names in the file.
    names: BTreeMap<String, usize>,
    rack: &'r mut Option<usize>,
    /// Characteristics of springs and dampers by their names in the file.
    springs: &'r BTreeMap<&'r str, Spring>,
}

impl Side<'_> {
    /// Returns true for elements of this side: all mirrored ones, and on the left those between both sides.
    fn is_here(&self, tree: &Tree) -> bool {
        self.side > 0.0 || is_mirrored(tree)
    }

    fn named(&self, tree: &Tree) -> String {
        let own = tree.text_of("Name").unwrap_or_default();
        format!("{own}{}", if is_mirrored(tree) { self.suffix } else { "" })
    }

    fn over(&self, v: Vec3) -> Vec3 {
        over(v, self.side)
    }

    /// Axes of an element on this side: x and z are mirrored, y follows, as in Chrono.
    fn axes(&self, tree: &Tree, rotation: Mat3) -> Mat3 {
        let [x, _, z] = rotation.cols.map(|axis| if is_mirrored(tree) { self.over(axis) } else { axis });
        Mat3 { cols: [x, z.cross(x), z] }
    }

    /// Returns a location of an element on this side.
    fn place(&mut self, tree: &Tree, key: &str) -> Option<Vec3> {
        let found = tree.get(key);
        let v = found.and_then(Tree::vector);
        if v.is_none() {
            let at = found.map_or(tree.at, |t| t.at);
            let message =
                format!("`{key}` of `{}` must be three numbers", tree.text_of("Name").unwrap_or_default());
            self.notes.problem_with("HP0804", Some(at), message, "write it as a list like `[0, 0.7, 0.2]`");
        }
        v.map(|v| if is_mirrored(tree) { self.over(v.into()) } else { v.into() })
    }

    fn bodies(&mut self, bodies: &[Tree]) {
        for tree in bodies {
            let name = self.named(tree);
            let own = tree.text_of("Name").unwrap_or_default().to_owned();
            let known = self.m.bodies.iter().position(|b| b.name == name);
            if let Some(body) = known.filter(|_| !self.is_here(tree)) {
                self.names.insert(own, body);
                continue;
            }
            let Some(r) = self.place(tree, "Position") else { continue };
            let frame = hardpoint::space::Pose { rot: crate::turn::none(), r };
            let body = self.m.body(&name, note("body", &own, tree.at, self.notes), Some(frame));
            if self.names.insert(own.clone(), body).is_some() {
                let message = format!("the body `{own}` is defined twice");
                self.notes.problem_with("HP0803", Some(tree.at), message, "rename one of them");
            }
            self.notes.taken("body", &name, Some(tree.at));
            if let Some(Inertial { mass, inertia }) = Inertial::of(tree) {
                let rotation = tree.get("Rotation").and_then(quaternion).unwrap_or_else(crate::turn::none);
                let frame = hardpoint::space::Pose { rot: self.axes(tree, rotation), r };
                let source = ElementSource { kind: "mass", name: &name, at: Some(tree.at) };
                robot::mass(self.m, self.notes, source, body, frame, mass, inertia);
            }
        }
    }

    /// Returns the two bodies of an element; `at` is its location on body i.
    fn pair(&mut self, tree: &Tree, at: Vec3) -> Option<[usize; 2]> {
        let found = ["Body1", "Body2"].map(|key| {
            let name = tree.text_of(key).unwrap_or_default();
            if CHASSIS.contains(&name) {
                return Some(GROUND);
            }
            if name == STEERING {
                let corner = Corner { at: Some(self.root.at), ..Corner::default() };
                return Some(corner.rack_of(self.m, self.notes, self.rack, at));
            }
            let body = self.names.get(name).copied();
            if body.is_none() {
                let message = format!(
                    "`{key}` of `{}` is `{name}`, which is not a body",
                    tree.text_of("Name").unwrap_or_default()
                );
                let help = "use one of the `Bodies`, or `Chassis`, `Subchassis`, `Steering`";
                self.notes.problem_with(
                    "HP0803",
                    Some(tree.get(key).map_or(tree.at, |t| t.at)),
                    message,
                    help,
                );
            }
            body
        });
        let [Some(i), Some(j)] = found else { return None };
        Some([i, j])
    }

    fn joints(&mut self) {
        for tree in list(self.root, "Joints").iter().filter(|t| self.is_here(t)).collect::<Vec<_>>() {
            let name = self.named(tree);
            let written = tree.text_of("Type").unwrap_or_default();
            let kind = match crate::corner::plain(written).replace('_', "").as_str() {
                "lock" => "fixed",
                "revolute" => "revolute",
                "spherical" => "spherical",
                "universal" => "universal",
                "pointline" => "inline",
                "pointplane" => "inplane",
                _ => {
                    let why =
                        format!("its type `{written}` has no equivalent: a driver fixes the motion instead");
                    self.notes.refused("joint", &name, Some(tree.at), why);
                    self.bushing(tree, None, "");
                    continue;
                }
            };
            let Some(frame) = tree.get("Coordinate System") else {
                let message = format!("`{name}` has no `Coordinate System`");
                self.notes.problem_with(
                    "HP0803",
                    Some(tree.at),
                    message,
                    "give it a `Position` and a `Rotation`",
                );
                continue;
            };
            let rotation = frame.get("Rotation").map_or(Some(crate::turn::none()), quaternion);
            let (Some(at), Some(rotation)) = (frame.get("Position").and_then(Tree::vector), rotation) else {
                let message =
                    format!("the `Coordinate System` of `{name}` is not a position with a quaternion");
                self.notes.problem_with(
                    "HP0804",
                    Some(frame.at),
                    message,
                    "give a `Position` of three numbers and a `Rotation` of four",
                );
                continue;
            };
            let at = Vec3::from(at);
            let at = if is_mirrored(tree) { self.over(at) } else { at };
            let [x, y, z] = self.axes(tree, rotation).cols;
            let Some(bodies) = self.pair(tree, at) else { continue };
            let joint = Joint::new(&name, note("joint", &name, tree.at, self.notes), kind, bodies, at);
            let number = self.m.joint(match kind {
                "revolute" => joint.along(z),
                "universal" => joint.with_axes(x, y),
                "inline" => joint.along(x),
                "inplane" => joint.with_axes(z, x),
                _ => joint,
            });
            self.notes.taken("joint", &name, Some(tree.at));
            self.bushing(tree, Some(number), kind);
        }
    }

    /// Adds the bushing of a joint of this type.
    fn bushing(&mut self, tree: &Tree, joint: Option<usize>, kind: &str) {
        let Some(data) = tree.get(chrono_part::BUSHING) else { return };
        // The pins of a cross are its z and x axes in the model, and x and y in Chrono.
        let free = match kind {
            "fixed" => Some([false; 3]),
            "revolute" => Some([false, false, true]),
            "universal" => Some([true, false, true]),
            "spherical" => Some([true; 3]),
            _ => None,
        };
        match joint.zip(free) {
            Some((joint, free)) => chrono_part::bushing(self.m, self.notes, data, joint, free, 0.0),
            None => {
                let why = "joints of this type have no bushing";
                self.notes.refused(chrono_part::BUSHING, &self.named(tree), Some(data.at), why);
            }
        }
    }

    fn rods(&mut self) {
        for tree in
            list(self.root, "Distance Constraints").iter().filter(|t| self.is_here(t)).collect::<Vec<_>>()
        {
            self.between(tree, "rod", "distance", None);
        }
    }

    /// Adds springs and dampers as legs, whose lengths are measured. Returns the ends of the first spring.
    fn springs(&mut self) -> Option<[(usize, Vec3); 2]> {
        let mut first = None;
        for tree in list(self.root, "TSDAs").iter().filter(|t| self.is_here(t)).collect::<Vec<_>>() {
            let is_damper =
                tree.entries().iter().all(|(key, ..)| !key.contains("Spring") && key != "Free Length");
            let member = if is_damper { "damper" } else { "spring" };
            let Some(ends) = self.between(tree, "spring", "leg", Some(member)) else { continue };
            let (name, own) = (self.named(tree), tree.text_of("Name").unwrap_or_default());
            if let Some(spring) = self.springs.get(own) {
                let note = note(member, own, tree.at, self.notes);
                self.m.force(Force {
                    name: name.clone(),
                    note,
                    on: ForceOn::Points(ends),
                    spring: spring.clone(),
                });
                self.notes.taken("force", &name, Some(tree.at));
            }
            first = first.or((!is_damper).then_some(ends));
        }
        first
    }

    fn between(
        &mut self,
        tree: &Tree,
        what: &str,
        kind: &'static str,
        draw: Option<&'static str>,
    ) -> Option<[(usize, Vec3); 2]> {
        let name = self.named(tree);
        let ends = ["Point1", "Point2"].map(|key| self.place(tree, key));
        let [Some(i), Some(j)] = ends else { return None };
        let bodies = self.pair(tree, i)?;
        if i == j {
            let message = format!("both ends of `{name}` coincide");
            self.notes.problem_with("HP0804", Some(tree.at), message, "correct one of them");
            return None;
        }
        let mut rod =
            Joint::new(&name, note(what, &name, tree.at, self.notes), kind, bodies, i).between(i, j);
        rod.draw = draw;
        self.m.joint(rod);
        self.notes.taken(what, &name, Some(tree.at));
        Some([(bodies[0], i), (bodies[1], j)])
    }

    fn wheel(&mut self, axis: Vec3, spring: Option<[(usize, Vec3); 2]>) {
        let Some(spindle) = self.root.get("Spindle") else {
            let help = "add it with `Attachment Body` and `COM`";
            self.notes.problem_with("HP0803", Some(self.root.at), "the part `Spindle` is missing", help);
            return;
        };
        let centre = spindle.get("COM").or_else(|| spindle.get("Location")).and_then(Tree::vector);
        let carrier = spindle.text_of("Attachment Body").and_then(|name| self.names.get(name)).copied();
        let (Some(centre), Some(carrier)) = (centre, carrier) else {
            let help = "give its `COM` as three numbers and one of the `Bodies` as its `Attachment Body`";
            self.notes.problem_with(
                "HP0804",
                Some(spindle.at),
                "the `Spindle` has no attachment body, or no position",
                help,
            );
            return;
        };
        let corner = Corner {
            suffix: self.suffix.into(),
            spin_axis: Some(axis),
            rack: self.rack.is_some(),
            at: Some(spindle.at),
            ..Corner::default()
        };
        let centre = Vec3::from(centre);
        self.m.hardpoints.push((format!("spindle{}", self.suffix), self.over(centre)));
        corner.wheel(self.m, self.notes, carrier, self.over(centre), spring);
        let carrier = self.m.bodies[carrier].name.clone();
        let mut masses =
            Masses { root: self.root, m: self.m, notes: self.notes, side: self.side, suffix: self.suffix };
        masses.on("Spindle", &carrier, None, chrono_part::spindle_axes(axis));
    }
}

fn list<'t>(root: &'t Tree, key: &str) -> &'t [Tree] {
    match root.get(key).map(|t| &t.value) {
        Some(Value::List(list)) => list,
        _ => &[],
    }
}

fn is_mirrored(tree: &Tree) -> bool {
    tree.text_of("Mirrored") != Some("false")
}

fn quaternion(tree: &Tree) -> Option<Mat3> {
    let Value::List(list) = &tree.value else { return None };
    let numbers: Option<Vec<f64>> = list.iter().map(Tree::number).collect();
    crate::turn::quaternion(numbers?.try_into().ok()?)
}

fn note(kind: &str, name: &str, at: SourceSpan, notes: &ImportLog) -> String {
    ElementSource { kind, name, at: Some(at) }.note(notes)
}
