//! Robots in URDF: tree joints, mimic joints, loops by common extensions. Parsed with `roxmltree`, since `urdf-rs`
//! provides no positions in the text and drops unknown content.

mod loops;

use std::collections::{BTreeMap, BTreeSet};

use hardpoint::space::{Pose, Vec3};
use roxmltree::Node;

use crate::markers::{ElementSource, Marker, join};
use crate::mechanism::{Coordinate, GROUND, Mechanism};
use crate::report::{ImportLog, SourceSpan};
use crate::shapes::Solid;
use crate::turn::{X, Y, diagonal, home, roll_pitch_yaw};
use crate::xml::{Vocabulary, attribute, attribute_at, child, children, local, named};
use crate::{Format, Input, robot, xml};

/// URDF format.
pub const FORMAT: Format = Format {
    name: "urdf",
    about: "URDF robot description",
    endings: &["urdf"],
    recognises: |text| text.contains("<robot") && (text.contains("<link") || text.contains("<joint")),
    read,
    binary: false,
};

/// Joint types without an axis.
const WITHOUT_AXIS: [&str; 5] = ["fixed", "floating", "ball", "spherical", "universal"];
/// Known content of a joint.
const JOINT: Vocabulary = Vocabulary {
    attributes: &["name", "type"],
    read: &["parent", "child", "origin", "axis", "limit", "mimic", "screw_thread_pitch", "dynamics"],
    irrelevant: &["safety_controller", "calibration", "hardwareInterface", "visual", "material"],
};
/// Known content of the elements of a joint.
const PARTS_OF_JOINTS: [(&str, &[&str]); 8] = [
    ("parent", &["link"]),
    ("child", &["link"]),
    ("origin", &["xyz", "rpy", "quat_xyzw"]),
    ("axis", &["xyz"]),
    (
        "limit",
        &[
            "lower",
            "upper",
            "effort",
            "velocity",
            "acceleration",
            "drake_acceleration",
            "deceleration",
            "jerk",
        ],
    ),
    ("mimic", &["joint", "multiplier", "offset"]),
    ("screw_thread_pitch", &["value"]),
    ("dynamics", &["damping", "friction", "spring_reference", "spring_stiffness"]),
];
/// Known content of a link.
const LINK: Vocabulary = Vocabulary {
    attributes: &["name", "type"],
    read: &["visual", "inertial"],
    irrelevant: &[
        "collision",
        "contact",
        "material",
        "sensor",
        "self_collision_checking",
        "verbose",
        "origin",
    ],
};
/// Elements of a robot without effect on its motion.
const IRRELEVANT: [&str; 7] =
    ["material", "sensor", "ros2_control", "camera", "collision_filter_group", "disable_collisions", "light"];
/// Elements for Gazebo without effect on the motion of links and joints.
const IRRELEVANT_IN_GAZEBO: [&str; 33] = [
    "material",
    "mu1",
    "mu2",
    "mu",
    "kp",
    "kd",
    "selfCollide",
    "self_collide",
    "sensor",
    "visual",
    "collision",
    "maxVel",
    "minDepth",
    "laserRetro",
    "maxContacts",
    "fdir1",
    "provideFeedback",
    "stopKd",
    "stopKp",
    "stopCfm",
    "stopErp",
    "cfmDamping",
    "implicitSpringDamper",
    "fudgeFactor",
    "preserveFixedJoint",
    "disableFixedJointLumping",
    "disableJointLumping",
    "physics",
    "light",
    "always_on",
    "update_rate",
    "maxSpeed",
    "springReference",
];
/// Maximum length of a chain of mimic joints.
const DEEPEST: usize = 100;

/// Declaration of a joint.
struct JointDeclaration<'a, 'i> {
    node: Node<'a, 'i>,
    name: String,
    kind: String,
    parent: String,
    child: String,
    origin: Pose,
    axis: Vec3,
    limits: Option<[f64; 2]>,
    /// Lead of a screw, m per turn.
    pitch: Option<f64>,
    mimic: Option<Mimic<'a, 'i>>,
    /// Stiffness, damping, and coordinate at which the spring has no force.
    spring: [f64; 3],
}

/// Independent joint of a mimic joint, with factor and offset.
struct Mimic<'a, 'i> {
    node: Node<'a, 'i>,
    joint: String,
    factor: f64,
    offset: f64,
}

fn read(input: &mut Input<'_>, notes: &mut ImportLog) -> Option<Mechanism> {
    let text = xml::lenient(input.text);
    let document = xml::parse(&text, 0, notes)?;
    let robot = document.root_element();
    if robot.tag_name().name() != "robot" {
        let message = format!("the first element is `{}`, not `robot`", robot.tag_name().name());
        notes.problem_with("HP0803", xml::at(0, robot), message, "specify the format, like `--format sdf`");
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
        floating: Vec::new(),
        names: BTreeSet::new(),
    };
    for link in named(robot, "link") {
        let Some(name) = reader.name(link) else { continue };
        if reader.links.insert(name.clone(), link).is_some() {
            let message = format!("the link `{name}` is defined twice");
            reader.notes.problem_with("HP0803", xml::at(0, link), message, "rename one of them");
        }
    }
    let count = reader.links.len().max(named(robot, "joint").count());
    if count > robot::MOST_PARTS {
        let message = format!("the robot has {count} links or joints; the maximum is {}", robot::MOST_PARTS);
        reader.notes.problem_with("HP0802", None, message, "remove parts that need not move from the source");
        return None;
    }
    let mut joints: Vec<JointDeclaration<'_, '_>> =
        named(robot, "joint").filter_map(|j| reader.declaration(j)).collect();
    reader.followers(robot, &mut joints);
    reader.tree(&joints);
    reader.mimics(&joints);
    reader.springs(robot, &joints);
    reader.loops(robot);
    reader.mujoco(robot);
    reader.floating();
    reader.masses();
    for node in children(robot) {
        match local(node) {
            "link" | "joint" | "loop_joint" | "ball_constraint" | "mujoco" => {}
            "gazebo" => reader.gazebo(node),
            "linear_bushing_rpy" => {
                let why = "bushings are forces: if it closes a loop, use a `loop_joint` instead";
                reader.notes.refused("linear_bushing_rpy", "", xml::at(0, node), why);
            }
            "transmission" => reader.transmission(node),
            other if IRRELEVANT.contains(&other) => reader.notes.ignored(other, xml::at(0, node)),
            other => reader.unknown(other, node),
        }
    }
    reader.frames(&joints);
    let (m, poses, links) = (reader.m, reader.poses, reader.links);
    for (name, (body, _)) in poses {
        if let Some(link) = links.get(&name) {
            shapes(input, notes, *link, body, &name);
        }
    }
    (m.bodies.len() > 1).then_some(m)
}

/// Reports a file with unexpanded xacro macros. Returns true for such a file.
fn xml_macros(robot: Node<'_, '_>, notes: &mut ImportLog) -> bool {
    let is_macro = |n: &Node<'_, '_>| {
        let declared = n.tag_name().namespace().is_some_and(|s| s.contains("xacro"));
        // Without a declaration, the prefix is part of the name.
        declared || n.tag_name().name().starts_with("xacro_")
    };
    let Some(first) = robot.descendants().find(is_macro) else { return false };
    let message = "the file is a xacro with unexpanded macros";
    notes.problem_with("HP0805", xml::at(0, first), message, "run `xacro FILE > robot.urdf` and import that");
    true
}

struct Reader<'a, 'i, 'n> {
    m: Mechanism,
    notes: &'n mut ImportLog,
    links: BTreeMap<String, Node<'a, 'i>>,
    /// Bodies of the links, and their poses in the design configuration.
    poses: BTreeMap<String, (usize, Pose)>,
    /// Coordinates of the joints with a single coordinate.
    joints: BTreeMap<String, Coordinate>,
    /// Floating joints: name, element, bodies, location.
    floating: Vec<(String, Node<'a, 'i>, [usize; 2], Vec3)>,
    /// Names of all joints.
    names: BTreeSet<String>,
}

impl<'a, 'i> Reader<'a, 'i, '_> {
    fn name(&mut self, node: Node<'a, 'i>) -> Option<String> {
        let name = node.attribute("name").map(str::trim).filter(|n| !n.is_empty());
        if name.is_none() {
            let message = format!("`{}` has no name", node.tag_name().name());
            self.notes.problem_with("HP0803", xml::at(0, node), message, "add an attribute `name`");
        }
        name.map(str::to_owned)
    }

    fn origin(&mut self, node: Node<'a, 'i>) -> Pose {
        child(node, "origin").map_or_else(home, |origin| pose(origin, self.notes))
    }

    /// Returns the axis of a joint; exporters write a null axis for types without one.
    fn axis(&mut self, node: Node<'a, 'i>, kind: &str) -> Vec3 {
        if WITHOUT_AXIS.contains(&kind) {
            return [0.0, 0.0, 1.0].into();
        }
        let axis = child(node, "axis");
        let given = axis.and_then(|axis| attribute::<3>(0, axis, "xyz", self.notes));
        let v: Vec3 = given.unwrap_or([1.0, 0.0, 0.0]).into();
        if v.unit().is_none() {
            let at = axis.and_then(|axis| attribute_at(0, axis, "xyz"));
            self.notes.problem_with("HP0804", at, "the axis has no direction", "give a non-zero vector");
        }
        v
    }

    fn link_of(&mut self, node: Node<'a, 'i>, end: &'static str) -> Option<String> {
        let element = child(node, end);
        let name = element.and_then(|e| e.attribute("link").or_else(|| e.text()).map(str::trim));
        let Some(name) = name else {
            let message = format!("the joint has no `{end}`");
            self.notes.problem_with(
                "HP0803",
                xml::at(0, node),
                message,
                "add it with the name of a link, as in `<parent link=\"base\"/>`",
            );
            return None;
        };
        if !self.links.contains_key(name) && name != "world" {
            let at = element.and_then(|e| attribute_at(0, e, "link").or_else(|| xml::at(0, e)));
            let known = self.links.keys().map(String::as_str);
            let near = hardpoint::draft::did_you_mean(name, known);
            let help = near.map_or("define the link".into(), |n| format!("did you mean `{n}`?"));
            self.notes.problem_with("HP0803", at, format!("the link `{name}` does not exist"), &help);
            return None;
        }
        Some(name.to_owned())
    }

    fn declaration(&mut self, node: Node<'a, 'i>) -> Option<JointDeclaration<'a, 'i>> {
        let name = self.name(node)?;
        let (parent, child_link) = (self.link_of(node, "parent"), self.link_of(node, "child"));
        let origin = self.origin(node);
        let kind = node.attribute("type").unwrap_or_default().trim().to_ascii_lowercase();
        let axis = self.axis(node, &kind);
        let number =
            |reader: &mut Self, e: Node<'a, 'i>, key| attribute::<1>(0, e, key, reader.notes).map(|[x]| x);
        let limits = child(node, "limit").and_then(|l| {
            let bound = |key| {
                let text = l.attribute(key)?;
                xml::bound(text, &format!("`{key}` of `limit`"), attribute_at(0, l, key), self.notes)
            };
            let ends = ["lower", "upper"].map(bound);
            // A missing limit is 0.
            if ends == [None, None] {
                None
            } else {
                xml::range(ends[0].unwrap_or(0.0), ends[1].unwrap_or(0.0))
            }
        });
        let mimic = child(node, "mimic").map(|m| {
            let factor = number(self, m, "multiplier").unwrap_or(1.0);
            let offset = number(self, m, "offset").unwrap_or(0.0);
            Mimic {
                node: m,
                joint: m.attribute("joint").unwrap_or_default().trim().to_owned(),
                factor,
                offset,
            }
        });
        let pitch = child(node, "screw_thread_pitch").and_then(|p| number(self, p, "value"));
        xml::unknown(0, node, &name, JOINT, self.notes);
        for (part, attributes) in PARTS_OF_JOINTS {
            let words = Vocabulary { attributes, read: &[], irrelevant: &[] };
            named(node, part).for_each(|part| xml::unknown(0, part, &name, words, self.notes));
        }
        let dynamics = child(node, "dynamics");
        let spring = ["spring_stiffness", "damping", "spring_reference"]
            .map(|key| dynamics.and_then(|d| number(self, d, key)).unwrap_or(0.0));
        if let Some(friction) = dynamics.and_then(|d| number(self, d, "friction")) {
            robot::friction(self.notes, &name, dynamics.and_then(|d| xml::at(0, d)), friction);
        }
        if !self.names.insert(name.clone()) {
            let message = format!("the joint `{name}` is defined twice");
            self.notes.problem_with("HP0803", xml::at(0, node), message, "rename one of them");
        }
        Some(JointDeclaration {
            node,
            name,
            kind,
            parent: parent?,
            child: child_link?,
            origin,
            axis,
            limits,
            pitch,
            mimic,
            spring,
        })
    }

    /// Adds bodies and joints, from the roots outward.
    fn tree(&mut self, joints: &[JointDeclaration<'a, 'i>]) {
        let is_child = |name: &str| joints.iter().any(|j| j.child == name);
        let names: Vec<String> = self.links.keys().cloned().collect();
        self.poses.insert("world".into(), (GROUND, home()));
        if let Some(world) = self.links.get("world") {
            self.notes.taken("link", "world", xml::at(0, *world));
        }
        for name in names.iter().filter(|n| !is_child(n) && *n != "world") {
            let body = self.body(name, home());
            self.poses.insert(name.clone(), (body, home()));
        }
        // The first joint to a link carries it; further ones close loops.
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
                let at = nominal_value(joints, k, 0);
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
            let message = format!("the links `{}` and `{}` are parents of each other", j.parent, j.child);
            let help = "connect one of them to the tree; close loops with `loop_joint`";
            self.notes.problem_with("HP0803", xml::at(0, j.node), message, help);
            return;
        }
        for (k, j) in joints.iter().enumerate() {
            self.joint(j, nominal_value(joints, k, 0));
        }
    }

    fn body(&mut self, name: &str, pose: Pose) -> usize {
        let at = self.links.get(name).and_then(|n| xml::at(0, *n));
        self.notes.taken("link", name, at);
        let note = ElementSource { kind: "link", name, at }.note(self.notes);
        self.m.body(name, note, Some(pose))
    }

    /// Adds a tree joint whose coordinate has the value `nominal` in the design configuration.
    fn joint(&mut self, j: &JointDeclaration<'a, 'i>, nominal: f64) {
        let (Some(&(parent, outer)), Some(&(body, inner))) =
            (self.poses.get(&j.parent), self.poses.get(&j.child))
        else {
            return;
        };
        let frame = outer.compose(j.origin);
        let Some(number) = self.connect(j.node, &j.name, &j.kind, [(parent, frame), (body, inner)], j.axis)
        else {
            return;
        };
        let coordinate = self.joints.get(&j.name).filter(|c| c.joint == number && j.kind != "continuous");
        if let (Some(coordinate), Some(ends)) = (coordinate, j.limits) {
            let of = coordinate.name;
            if let Err(why) = self.m.joints[number].limit(of, ends.map(|x| x - nominal)) {
                let at = child(j.node, "limit").and_then(|limit| xml::at(0, limit));
                self.notes.refused("limit", &j.name, at, why);
            }
        }
        if j.kind == "screw" {
            self.m.joints[number].lead = j.pitch.filter(|p| *p != 0.0);
            if self.m.joints[number].lead.is_none() {
                let help = "give it a non-zero `screw_thread_pitch`";
                let message = format!("the screw `{}` has no pitch", j.name);
                self.notes.problem_with("HP0804", xml::at(0, j.node), message, help);
            }
        }
    }

    /// Adds a joint of a URDF type between two frames; the axis has the same components in both. Returns the index of
    /// the joint, unless it is floating or unknown.
    fn connect(
        &mut self,
        node: Node<'a, 'i>,
        name: &str,
        kind: &str,
        [(i, at_i), (j, at_j)]: [(usize, Pose); 2],
        axis: Vec3,
    ) -> Option<usize> {
        let at = xml::at(0, node);
        let (type_name, coordinate) = match kind {
            "revolute" | "continuous" | "hinge" => ("revolute", Some("angle")),
            "prismatic" => ("translational", Some("displacement")),
            "fixed" => ("fixed", None),
            "planar" => ("planar", None),
            // Drake's extensions.
            "ball" | "spherical" => ("spherical", None),
            "universal" => ("universal", None),
            "screw" => ("screw", Some("angle")),
            "floating" => {
                self.floating.push((name.to_owned(), node, [i, j], at_j.r));
                return None;
            }
            _ => {
                let at = attribute_at(0, node, "type").or(at);
                let help = "use revolute, continuous, prismatic, fixed, planar or floating";
                let message = format!("`{name}` is of the unknown type `{kind}`");
                self.notes.problem_with("HP0805", at, message, help);
                return None;
            }
        };
        if type_name == "fixed" {
            let ends = [(i, at_i), (j, at_j)].map(|(body, pose)| Marker { body, pose });
            return robot::weld(
                &mut self.m,
                self.notes,
                ElementSource { kind: "joint", name, at },
                "fixed",
                ends,
            );
        }
        // The axes of a universal joint are x of the first frame and y of the second.
        let axes = if kind == "universal" { [X, Y].map(Vec3::from) } else { [axis; 2] };
        let end = |body, pose: Pose, axis| Marker::along(body, pose.r, pose.rot * axis);
        let ends = [end(i, at_i, axes[0])?, end(j, at_j, axes[1])?];
        let number =
            join(&mut self.m, self.notes, ElementSource { kind: "joint", name, at }, type_name, ends)?;
        if let Some(coordinate) = coordinate {
            self.joints.insert(name.to_owned(), Coordinate { joint: number, name: coordinate });
        }
        Some(number)
    }
}

/// Coordinate of a joint in the design configuration: zero, or the value of a mimic joint.
fn nominal_value(joints: &[JointDeclaration<'_, '_>], k: usize, depth: usize) -> f64 {
    let Some(mimic) = &joints[k].mimic else { return 0.0 };
    let master = joints.iter().position(|j| j.name == mimic.joint).filter(|_| depth < DEEPEST);
    mimic.offset + mimic.factor * master.map_or(0.0, |m| nominal_value(joints, m, depth + 1))
}

/// Returns a frame displaced by a joint coordinate.
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

fn pose(origin: Node<'_, '_>, notes: &mut ImportLog) -> Pose {
    let [r, angles] = ["xyz", "rpy"].map(|key| attribute::<3>(0, origin, key, notes).unwrap_or_default());
    if origin.has_attribute("rpy") && origin.has_attribute("quat_xyzw") {
        let at = attribute_at(0, origin, "quat_xyzw");
        let message = format!("`{}` has two orientations", origin.tag_name().name());
        notes.problem_with("HP0804", at, message, "remove `rpy` or `quat_xyzw`");
    }
    let rot = match attribute::<4>(0, origin, "quat_xyzw", notes) {
        Some([x, y, z, w]) => crate::turn::quaternion([w, x, y, z]).unwrap_or_else(|| {
            let at = attribute_at(0, origin, "quat_xyzw");
            notes.problem_with("HP0804", at, "the quaternion is null", "give a non-zero quaternion");
            home().rot
        }),
        None => roll_pitch_yaw(angles),
    };
    Pose { rot, r: r.into() }
}

/// Adds the shapes of a link.
fn shapes(input: &mut Input<'_>, notes: &mut ImportLog, link: Node<'_, '_>, body: usize, name: &str) {
    xml::unknown(0, link, name, LINK, notes);
    for part in named(link, "visual") {
        let at: Option<SourceSpan> = xml::at(0, part);
        let place = child(part, "origin").map_or_else(home, |o| pose(o, notes));
        xml::repeated(0, part, name, &["origin", "geometry"], notes);
        let Some(shape) = xml::shape(0, part, name, notes) else {
            notes.refused("visual", name, at, "it has no shape");
            continue;
        };
        // Errors in shapes do not prevent the import.
        let numbers = |key: &str| shape.attribute(key).and_then(xml::numbers).unwrap_or_default();
        let three = |key: &str| <[f64; 3]>::try_from(numbers(key)).ok();
        let one = |key: &str| numbers(key).first().copied();
        let solid = match shape.tag_name().name() {
            "mesh" => {
                let scale = if shape.has_attribute("scale") { three("scale") } else { Some([1.0; 3]) };
                let Some(scale) = scale else {
                    notes.refused(
                        "mesh",
                        name,
                        attribute_at(0, shape, "scale"),
                        "its scale must be three numbers",
                    );
                    continue;
                };
                let path = shape.attribute("filename").unwrap_or_default();
                input.mesh(body, place, diagonal(scale), path, name, xml::at(0, shape), notes);
                continue;
            }
            "box" => three("size").map(Solid::Box),
            "cylinder" => one("radius").zip(one("length")).map(|(r, l)| Solid::Cylinder(r, l)),
            "capsule" => one("radius").zip(one("length")).map(|(r, l)| Solid::Capsule(r, l)),
            "sphere" => one("radius").map(|r| Solid::Ball([r; 3])),
            other => {
                notes.refused(
                    "visual",
                    name,
                    xml::at(0, shape),
                    format!("shapes of type `{other}` are not supported"),
                );
                continue;
            }
        };
        let Some(solid) = solid else {
            notes.refused("visual", name, xml::at(0, shape), "its size is not numeric");
            continue;
        };
        input.shapes.solid(body, place, solid);
        notes.taken("visual", name, at);
    }
}
