//! Robots in URDF: the tree, mimic joints, loops by the usual extensions. Read with `roxmltree`: `urdf-rs` gives no places in the text
//! and leaves out what it does not know.

use std::collections::BTreeMap;

use hardpoint::space::{Pose, Vec3};
use roxmltree::Node;

use crate::markers::{Called, Marker, join};
use crate::mechanism::{Coordinate, GROUND, Mechanism};
use crate::report::{At, Notes};
use crate::shapes::Solid;
use crate::turn::{home, roll_pitch_yaw};
use crate::xml::{attribute, attribute_at, child, children, named};
use crate::{Format, Input, xml};

/// See the module.
pub const FORMAT: Format = Format {
    name: "urdf",
    about: "URDF robot description",
    endings: &["urdf"],
    looks: |text| text.contains("<robot") && (text.contains("<link") || text.contains("<joint")),
    read,
    binary: false,
};

/// Mimic joints follow each other so deep at most.
const DEEPEST: usize = 100;

/// A joint as it is written.
struct Written<'a, 'i> {
    node: Node<'a, 'i>,
    name: String,
    kind: String,
    parent: String,
    child: String,
    origin: Pose,
    axis: Vec3,
    limits: Option<[f64; 2]>,
    /// The joint that it follows, by what factor and offset.
    mimic: Option<(String, f64, f64)>,
}

fn read(input: &mut Input<'_>, notes: &mut Notes) -> Option<Mechanism> {
    let document = xml::parse(input.text, 0, notes)?;
    let robot = document.root_element();
    if robot.tag_name().name() != "robot" {
        let message = format!("the first element is `{}`, not `robot`", robot.tag_name().name());
        notes.problem_with("HP0803", xml::at(0, robot), message, "name the format, like `--format sdf`");
        return None;
    }
    if xml_macros(robot, notes) {
        return None;
    }
    let name = robot.attribute("name").unwrap_or(input.stem);
    let mut reader = Reader {
        m: Mechanism::new(name, "m", "rad"),
        notes,
        links: BTreeMap::new(),
        poses: BTreeMap::new(),
        joints: BTreeMap::new(),
    };
    for link in named(robot, "link") {
        let Some(name) = reader.name(link) else { continue };
        if reader.links.insert(name.clone(), link).is_some() {
            let message = format!("there are two links `{name}`");
            reader.notes.problem_with("HP0803", xml::at(0, link), message, "rename one of them");
        }
    }
    let joints: Vec<Written<'_, '_>> = named(robot, "joint").filter_map(|j| reader.written(j)).collect();
    reader.tree(&joints);
    reader.mimics(&joints);
    reader.loops(robot);
    for node in children(robot) {
        match node.tag_name().name() {
            "link" | "joint" | "loop_joint" => {}
            "gazebo" if named(node, "joint").next().is_some() => {}
            other => reader.notes.ignored(other, xml::at(0, node)),
        }
    }
    let (m, poses, links) = (reader.m, reader.poses, reader.links);
    for (name, (body, _)) in poses {
        if let Some(link) = links.get(&name) {
            shapes(input, notes, *link, body, &name);
        }
    }
    (m.bodies.len() > 1).then_some(m)
}

/// Whether the file has yet to be expanded by xacro.
fn xml_macros(robot: Node<'_, '_>, notes: &mut Notes) -> bool {
    let is_macro = |n: &Node<'_, '_>| n.tag_name().namespace().is_some_and(|s| s.contains("xacro"));
    let Some(first) = robot.descendants().find(is_macro) else { return false };
    let message = "the file is a xacro, whose macros have yet to be expanded";
    notes.problem_with("HP0805", xml::at(0, first), message, "run `xacro FILE > robot.urdf` and import that");
    true
}

struct Reader<'a, 'i, 'n> {
    m: Mechanism,
    notes: &'n mut Notes,
    links: BTreeMap<String, Node<'a, 'i>>,
    /// Bodies and poses of the links as drawn.
    poses: BTreeMap<String, (usize, Pose)>,
    /// The numbers of joints with one coordinate, and which.
    joints: BTreeMap<String, Coordinate>,
}

impl<'a, 'i> Reader<'a, 'i, '_> {
    fn name(&mut self, node: Node<'a, 'i>) -> Option<String> {
        let name = node.attribute("name").map(str::trim).filter(|n| !n.is_empty());
        if name.is_none() {
            let message = format!("`{}` has no name", node.tag_name().name());
            self.notes.problem_with("HP0803", xml::at(0, node), message, "give it an attribute `name`");
        }
        name.map(str::to_owned)
    }

    fn origin(&mut self, node: Node<'a, 'i>) -> Pose {
        child(node, "origin").map_or_else(home, |origin| pose(origin, self.notes))
    }

    fn axis(&mut self, node: Node<'a, 'i>) -> Vec3 {
        let axis = child(node, "axis");
        let given = axis.and_then(|axis| attribute::<3>(0, axis, "xyz", self.notes));
        let v: Vec3 = given.unwrap_or([1.0, 0.0, 0.0]).into();
        if v.unit().is_none() {
            let at = axis.and_then(|axis| attribute_at(0, axis, "xyz"));
            self.notes.problem_with(
                "HP0804",
                at,
                "the axis has no direction",
                "give a vector other than zero",
            );
        }
        v
    }

    fn linked(&mut self, node: Node<'a, 'i>, end: &'static str) -> Option<String> {
        let element = child(node, end);
        let name = element.and_then(|e| e.attribute("link").or_else(|| e.text()).map(str::trim));
        let Some(name) = name else {
            let message = format!("the joint has no `{end}`");
            self.notes.problem_with(
                "HP0803",
                xml::at(0, node),
                message,
                "name a link in it, as in `<parent link=\"base\"/>`",
            );
            return None;
        };
        if !self.links.contains_key(name) && name != "world" {
            let at = element.and_then(|e| attribute_at(0, e, "link").or_else(|| xml::at(0, e)));
            let known = self.links.keys().map(String::as_str);
            let near = hardpoint::draft::did_you_mean(name, known);
            let help = near.map_or("declare the link".into(), |n| format!("did you mean `{n}`?"));
            self.notes.problem_with("HP0803", at, format!("there is no link `{name}`"), &help);
            return None;
        }
        Some(name.to_owned())
    }

    fn written(&mut self, node: Node<'a, 'i>) -> Option<Written<'a, 'i>> {
        let name = self.name(node)?;
        let (parent, child_link) = (self.linked(node, "parent"), self.linked(node, "child"));
        let origin = self.origin(node);
        let axis = self.axis(node);
        let number =
            |reader: &mut Self, e: Node<'a, 'i>, key| attribute::<1>(0, e, key, reader.notes).map(|[x]| x);
        let limits = child(node, "limit").and_then(|l| {
            let ends = ["lower", "upper"].map(|k| number(self, l, k));
            (ends != [None, None]).then(|| ends.map(|x| x.unwrap_or(0.0)))
        });
        let mimic = child(node, "mimic").and_then(|m| {
            let factor = number(self, m, "multiplier").unwrap_or(1.0);
            let offset = number(self, m, "offset").unwrap_or(0.0);
            Some((m.attribute("joint")?.trim().to_owned(), factor, offset))
        });
        let kind = node.attribute("type").unwrap_or_default().trim().to_ascii_lowercase();
        Some(Written { node, name, kind, parent: parent?, child: child_link?, origin, axis, limits, mimic })
    }

    /// Bodies and joints, from the roots outward.
    fn tree(&mut self, joints: &[Written<'a, 'i>]) {
        let is_child = |name: &str| joints.iter().any(|j| j.child == name);
        let names: Vec<String> = self.links.keys().cloned().collect();
        self.poses.insert("world".into(), (GROUND, home()));
        for name in names.iter().filter(|n| !is_child(n) && *n != "world") {
            let body = self.body(name, home());
            self.poses.insert(name.clone(), (body, home()));
        }
        // The first joint to a link carries it; any further one closes a loop.
        let mut carrier: BTreeMap<&str, usize> = BTreeMap::new();
        for (k, joint) in joints.iter().enumerate() {
            carrier.entry(&joint.child).or_insert(k);
        }
        let mut waiting: Vec<usize> =
            (0..joints.len()).filter(|k| carrier.get(joints[*k].child.as_str()) == Some(k)).collect();
        loop {
            let (ready, rest): (Vec<usize>, Vec<usize>) =
                waiting.iter().partition(|k| self.poses.contains_key(&joints[**k].parent));
            for &k in &ready {
                let j = &joints[k];
                let (_, outer) = self.poses[&j.parent];
                let at = value_as_drawn(joints, k, 0);
                let frame = outer.compose(j.origin);
                let pose = moved(frame, &j.kind, j.axis, at);
                let body = self.body(&j.child, pose);
                self.poses.insert(j.child.clone(), (body, pose));
            }
            waiting = rest;
            if ready.is_empty() {
                break;
            }
        }
        if let Some(j) = waiting.first().map(|k| &joints[*k]) {
            let message = format!("the links `{}` and `{}` carry each other in a circle", j.parent, j.child);
            let help =
                "one of them has to be carried by a link that stands; loops are closed by `loop_joint`";
            self.notes.problem_with("HP0803", xml::at(0, j.node), message, help);
            return;
        }
        for j in joints {
            self.joint(j);
        }
    }

    fn body(&mut self, name: &str, pose: Pose) -> usize {
        let at = self.links.get(name).and_then(|n| xml::at(0, *n));
        self.notes.taken("link", name, at);
        let note = Called { kind: "link", name, at }.note(self.notes);
        self.m.body(name, note, Some(pose))
    }

    fn joint(&mut self, j: &Written<'a, 'i>) {
        let (Some(&(parent, outer)), Some(&(body, inner))) =
            (self.poses.get(&j.parent), self.poses.get(&j.child))
        else {
            return;
        };
        let frame = outer.compose(j.origin);
        self.connect(j.node, &j.name, &j.kind, j.limits, [(parent, frame), (body, inner)], j.axis);
    }

    /// A joint of a type of URDF between two frames, whose axis is the same in both.
    fn connect(
        &mut self,
        node: Node<'a, 'i>,
        name: &str,
        kind: &str,
        limits: Option<[f64; 2]>,
        [(i, at_i), (j, at_j)]: [(usize, Pose); 2],
        axis: Vec3,
    ) {
        let at = xml::at(0, node);
        let (type_name, coordinate) = match kind {
            "revolute" | "continuous" | "hinge" => ("revolute", Some("angle")),
            "prismatic" => ("translational", Some("displacement")),
            "fixed" => ("fixed", None),
            "planar" => ("planar", None),
            "ball" | "spherical" => ("spherical", None),
            "floating" => {
                let why = "nothing holds its six freedoms in the source: it is fixed as drawn";
                self.notes.approximated("joint", name, at, why);
                let note = Called { kind: "joint", name, at }.note(self.notes);
                self.m.joint(crate::mechanism::Joint::new(name, note, "fixed", [i, j], at_j.r));
                return;
            }
            _ => {
                let at = attribute_at(0, node, "type").or(at);
                let help = "URDF knows revolute, continuous, prismatic, fixed, planar and floating";
                self.notes.problem_with(
                    "HP0805",
                    at,
                    format!("`{name}` is of the unknown type `{kind}`"),
                    help,
                );
                return;
            }
        };
        let axis = if ["fixed", "spherical"].contains(&type_name) { [0.0, 0.0, 1.0].into() } else { axis };
        let ends = [(i, at_i), (j, at_j)].map(|(body, pose)| Marker::along(body, pose.r, pose.rot * axis));
        let [Some(i), Some(j)] = ends else { return };
        let called = Called { kind: "joint", name, at };
        let Some(number) = join(&mut self.m, self.notes, called, type_name, [i, j]) else { return };
        self.m.joints[number].limits = limits.filter(|[low, high]| low < high);
        if let Some(coordinate) = coordinate {
            self.joints.insert(name.to_owned(), Coordinate { joint: number, name: coordinate });
        }
    }

    fn mimics(&mut self, joints: &[Written<'a, 'i>]) {
        for j in joints {
            let Some((other, factor, _)) = &j.mimic else { continue };
            let node = child(j.node, "mimic").unwrap_or(j.node);
            let at = attribute_at(0, node, "joint").or_else(|| xml::at(0, node));
            match (self.joints.get(&j.name).copied(), self.joints.get(other).copied()) {
                (Some(own), Some(master)) if own != master => {
                    let note = Called { kind: "mimic of", name: other, at }.note(self.notes);
                    self.m.coupler(&format!("{}_mimic", j.name), note, vec![(own, 1.0), (master, -factor)]);
                    self.notes.taken("mimic", &j.name, at);
                }
                _ => {
                    let message = format!(
                        "`{}` follows the joint `{other}`, which is not there or has no coordinate",
                        j.name
                    );
                    self.notes.problem_with("HP0803", at, message, "name a joint that turns or slides");
                }
            }
        }
    }

    /// Joints that close loops: `loop_joint`, as Drake has it or like a joint, and joints of SDF in a `gazebo` element.
    fn loops(&mut self, robot: Node<'a, 'i>) {
        for node in named(robot, "loop_joint") {
            let Some(name) = self.name(node) else { continue };
            let kind = node.attribute("type").unwrap_or("continuous").to_ascii_lowercase();
            let axis = self.axis(node);
            let ends = match (child(node, "link1"), child(node, "link2")) {
                (Some(a), Some(b)) => [a, b].map(|end| {
                    let link = end.attribute("link").unwrap_or_default().trim();
                    let found = self.poses.get(link).copied();
                    if found.is_none() {
                        let at = attribute_at(0, end, "link").or_else(|| xml::at(0, end));
                        self.notes.problem_with(
                            "HP0803",
                            at,
                            format!("there is no link `{link}`"),
                            "name a link of the robot",
                        );
                    }
                    found.map(|(body, outer)| (body, outer.compose(pose(end, self.notes))))
                }),
                _ => self.ends(node),
            };
            if let [Some(i), Some(j)] = ends {
                // Directions are those of the first link.
                let j = (j.0, Pose { rot: i.1.rot, r: j.1.r });
                self.connect(node, &name, &kind, None, [i, j], axis);
            }
        }
        for node in named(robot, "gazebo").flat_map(|g| named(g, "joint")) {
            let Some(name) = self.name(node) else { continue };
            let kind = node.attribute("type").unwrap_or_default().to_ascii_lowercase();
            let [Some(i), Some(j)] = self.ends(node) else { continue };
            let axis = child(node, "axis").and_then(|a| child(a, "xyz"));
            let given = axis.and_then(|a| {
                xml::exactly::<3>(a.text().unwrap_or_default(), "`xyz`", xml::at(0, a), self.notes)
            });
            let frame = (i.0, j.1);
            self.connect(node, &name, &kind, None, [frame, j], given.unwrap_or([0.0, 0.0, 1.0]).into());
        }
    }

    /// The two ends of a joint that is written like others: on the child, or on the parent where `origin` is given.
    fn ends(&mut self, node: Node<'a, 'i>) -> [Option<(usize, Pose)>; 2] {
        let [parent, body] = ["parent", "child"]
            .map(|end| self.linked(node, end).and_then(|link| self.poses.get(&link).copied()));
        let (Some((i, outer)), Some((j, inner))) = (parent, body) else { return [None, None] };
        let frame = match (child(node, "origin"), child(node, "pose")) {
            (Some(_), _) => outer.compose(self.origin(node)),
            (None, Some(p)) => {
                let text = p.text().unwrap_or_default();
                let n = xml::exactly::<6>(text, "`pose`", xml::at(0, p), self.notes).unwrap_or_default();
                inner.compose(Pose { rot: roll_pitch_yaw([n[3], n[4], n[5]]), r: [n[0], n[1], n[2]].into() })
            }
            _ => inner,
        };
        [Some((i, frame)), Some((j, frame))]
    }
}

/// Where a joint stands as drawn: at zero, or where the joint that it follows puts it.
fn value_as_drawn(joints: &[Written<'_, '_>], k: usize, depth: usize) -> f64 {
    let Some((other, factor, offset)) = &joints[k].mimic else { return 0.0 };
    let master = joints.iter().position(|j| j.name == *other).filter(|_| depth < DEEPEST);
    offset + factor * master.map_or(0.0, |m| value_as_drawn(joints, m, depth + 1))
}

/// A frame moved by a joint's coordinate.
fn moved(frame: Pose, kind: &str, axis: Vec3, by: f64) -> Pose {
    let Some(axis) = axis.unit().filter(|_| by != 0.0) else { return frame };
    match kind {
        "prismatic" => frame.compose(Pose { rot: home().rot, r: axis * by }),
        "revolute" | "continuous" => {
            frame.compose(Pose { rot: hardpoint::space::Mat3::about(axis, by), r: Vec3::zero() })
        }
        _ => frame,
    }
}

fn pose(origin: Node<'_, '_>, notes: &mut Notes) -> Pose {
    let [r, angles] = ["xyz", "rpy"].map(|key| attribute::<3>(0, origin, key, notes).unwrap_or_default());
    Pose { rot: roll_pitch_yaw(angles), r: r.into() }
}

/// The shapes of a link.
fn shapes(input: &mut Input<'_>, notes: &mut Notes, link: Node<'_, '_>, body: usize, name: &str) {
    for part in children(link) {
        let at: Option<At> = xml::at(0, part);
        if part.tag_name().name() != "visual" {
            notes.ignored(part.tag_name().name(), at);
            continue;
        }
        let place = child(part, "origin").map_or_else(home, |o| pose(o, notes));
        let Some(shape) = child(part, "geometry").and_then(|g| children(g).next()) else { continue };
        let number = |notes: &mut Notes, key| attribute::<1>(0, shape, key, notes).map_or(0.0, |[x]| x);
        let solid = match shape.tag_name().name() {
            "mesh" => {
                let scale = attribute::<3>(0, shape, "scale", notes).unwrap_or([1.0; 3]);
                let path = shape.attribute("filename").unwrap_or_default();
                input.mesh(body, place, scale, path, name, xml::at(0, shape), notes);
                continue;
            }
            "box" => Solid::Box(attribute::<3>(0, shape, "size", notes).unwrap_or_default()),
            "cylinder" => Solid::Cylinder(number(notes, "radius"), number(notes, "length")),
            "capsule" => Solid::Capsule(number(notes, "radius"), number(notes, "length")),
            "sphere" => Solid::Ball([number(notes, "radius"); 3]),
            other => {
                notes.refused("visual", name, xml::at(0, shape), format!("a shape `{other}` is not shown"));
                continue;
            }
        };
        input.shapes.solid(body, place, solid);
        notes.taken("visual", name, at);
    }
}
