//! Features without an element in URDF: extensions for mimic joints, loops, floating links.

use std::collections::BTreeSet;

use hardpoint::space::{Mat3, Pose, Vec3};
use roxmltree::Node;

use super::{IRRELEVANT_IN_GAZEBO, JointDeclaration, Mimic, Reader, WITHOUT_AXIS, nominal_value, pose};
use crate::markers::ElementSource;
use crate::mechanism::Mechanism;
use crate::robot::{self, Follower};
use crate::turn::{Z, home, roll_pitch_yaw};
use crate::xml;
use crate::xml::{Vocabulary, attribute, attribute_at, child, children, local, named};

/// Known content of a joint that closes a loop.
const LOOP: Vocabulary = Vocabulary {
    attributes: &["name", "type"],
    read: &[
        "link1",
        "link2",
        "parent",
        "child",
        "origin",
        "parent_origin",
        "child_origin",
        "pose",
        "axis",
        "limit",
        "dynamics",
    ],
    irrelevant: &["physics", "sensor"],
};
/// Elements with the frames of a joint on both links.
const ORIGINS: [&str; 2] = ["parent_origin", "child_origin"];
/// Body and frame of an end of a joint; `None` if its link is missing.
type End = Option<(usize, Pose)>;
/// Known content of the axis of a joint of SDFormat.
const AXIS: Vocabulary =
    Vocabulary { attributes: &[], read: &["xyz", "limit", "dynamics"], irrelevant: &["physics"] };
/// Known content of an inertial.
const INERTIAL: Vocabulary =
    Vocabulary { attributes: &[], read: &["origin", "mass", "inertia"], irrelevant: &[] };
/// Known content of the elements of an inertial.
const PARTS_OF_INERTIALS: [(&str, &[&str]); 3] = [
    ("origin", &["xyz", "rpy", "quat_xyzw"]),
    ("mass", &["value"]),
    ("inertia", &["ixx", "iyy", "izz", "ixy", "ixz", "iyz"]),
];
/// Mass below which a link is a mere frame, kg.
const LIGHT: f64 = 1e-6;

impl<'a, 'i> Reader<'a, 'i, '_> {
    /// Reads mimic joints of Gazebo plugins and `ros2_control`.
    pub(super) fn followers(&mut self, robot: Node<'a, 'i>, joints: &mut [JointDeclaration<'a, 'i>]) {
        let mut found = Vec::new();
        for node in named(robot, "gazebo").flat_map(|g| named(g, "plugin")).chain(named(robot, "plugin")) {
            found.extend(robot::mimic_plugin(0, node, self.notes));
        }
        for node in named(robot, "ros2_control") {
            found.extend(robot::followers_of_control(0, node, self.notes));
        }
        for Follower { node, own, master, factor, offset } in found {
            let is_there = joints.iter().any(|j| j.name == master);
            match joints.iter_mut().find(|j| j.name == own) {
                Some(j) if is_there => {
                    // Most robots define it twice, for visualisation and for simulation.
                    j.mimic.get_or_insert(Mimic { node, joint: master, factor, offset });
                }
                _ => {
                    let why =
                        format!("it couples the joints `{own}` and `{master}`, which do not both exist");
                    let (kind, name) = (node.tag_name().name(), node.attribute("name").unwrap_or_default());
                    self.notes.refused(kind, name, xml::at(0, node), why);
                }
            }
        }
    }

    /// Adds springs and dampers of joints, including those of Gazebo extensions.
    pub(super) fn springs(&mut self, robot: Node<'a, 'i>, joints: &[JointDeclaration<'a, 'i>]) {
        for (k, j) in joints.iter().enumerate() {
            let [mut stiffness, damping, mut free] = j.spring;
            let mut at = child(j.node, "dynamics").and_then(|d| xml::at(0, d));
            for node in named(robot, "gazebo").filter(|g| g.attribute("reference") == Some(j.name.as_str())) {
                for (key, to) in [("springStiffness", &mut stiffness), ("springReference", &mut free)] {
                    let Some(element) = child(node, key) else { continue };
                    let words = element.text().unwrap_or_default();
                    at = xml::at(0, element);
                    if let Some([x]) = xml::exactly::<1>(words, &format!("`{key}`"), at, self.notes) {
                        *to = x;
                    }
                }
            }
            // Coordinates are relative to the design configuration.
            let free = free - nominal_value(joints, k, 0);
            let source = ElementSource { kind: "spring", name: &j.name, at };
            let coordinate = self.joints.get(&j.name).copied();
            robot::joint_spring(&mut self.m, self.notes, source, coordinate, [stiffness, damping, free]);
        }
    }

    /// Adds the masses of links.
    pub(super) fn masses(&mut self) {
        let links: Vec<(String, Node<'a, 'i>)> = self.links.iter().map(|(n, l)| (n.clone(), *l)).collect();
        for (name, link) in links {
            let (Some(inertial), Some((body, outer))) =
                (child(link, "inertial"), self.poses.get(&name).copied())
            else {
                continue;
            };
            xml::unknown(0, inertial, &name, INERTIAL, self.notes);
            for (part, attributes) in PARTS_OF_INERTIALS {
                let words = Vocabulary { attributes, read: &[], irrelevant: &[] };
                named(inertial, part).for_each(|part| xml::unknown(0, part, &name, words, self.notes));
            }
            let frame = outer.compose(self.origin(inertial));
            let one = |reader: &mut Self, e: Option<Node<'a, 'i>>, key| {
                let [x] = e.and_then(|e| attribute::<1>(0, e, key, reader.notes)).unwrap_or_default();
                x
            };
            let mass = one(self, child(inertial, "mass"), "value");
            let matrix = child(inertial, "inertia");
            let [xx, yy, zz, xy, xz, yz] =
                ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"].map(|k| one(self, matrix, k));
            let matrix = Mat3 { cols: [[xx, xy, xz].into(), [xy, yy, yz].into(), [xz, yz, zz].into()] };
            let source = ElementSource { kind: "inertial", name: &name, at: xml::at(0, inertial) };
            robot::mass(&mut self.m, self.notes, source, body, frame, mass, Some(matrix));
        }
        robot::standard_gravity(&mut self.m, self.notes, "URDF");
    }

    /// Reads equalities of MuJoCo in a URDF file.
    pub(super) fn mujoco(&mut self, robot: Node<'a, 'i>) {
        let blocks: Vec<Node<'a, 'i>> = named(robot, "mujoco").collect();
        if blocks.is_empty() {
            return;
        }
        let m = std::mem::replace(&mut self.m, Mechanism::new("", "m", "rad"));
        self.m = crate::mjcf::extension(m, self.notes, &blocks, 0, &self.poses, &self.joints);
    }

    /// Reads the content of an element for Gazebo.
    pub(super) fn gazebo(&mut self, node: Node<'a, 'i>) {
        const READ: [&str; 2] = ["joint", "springStiffness"];
        let owner = node.attribute("reference").unwrap_or_default();
        let mut is_reported = false;
        for part in children(node) {
            match local(part) {
                name if READ.contains(&name) => is_reported = true,
                name if IRRELEVANT_IN_GAZEBO.contains(&name) => {}
                "gravity" | "turnGravityOff" => {
                    is_reported = true;
                    self.weight(part, owner);
                }
                "dampingFactor" => {
                    is_reported = true;
                    let why = "damping of the velocity of a link has no equivalent";
                    self.notes.refused("dampingFactor", owner, xml::at(0, part), why);
                }
                "plugin" => {
                    is_reported = true;
                    if robot::is_mimic_plugin(part) {
                        continue;
                    }
                    robot::plugin(0, part, self.notes);
                }
                name => {
                    is_reported = true;
                    let why = "unknown element for Gazebo";
                    self.notes.not_understood(name, owner, xml::at(0, part), why);
                }
            }
        }
        if !is_reported {
            self.notes.ignored("gazebo", xml::at(0, node));
        }
    }

    /// Compensates the weight of a link that has none in Gazebo.
    fn weight(&mut self, node: Node<'a, 'i>, link: &str) {
        let word = node.text().unwrap_or_default().trim();
        let is_on = ["1", "true"].contains(&word) == node.has_tag_name("gravity");
        let source = ElementSource { kind: node.tag_name().name(), name: link, at: xml::at(0, node) };
        match self.poses.get(link) {
            Some((body, _)) if !is_on => {
                robot::compensate_gravity(&mut self.m, self.notes, source, *body, 1.0);
            }
            Some(_) => self.notes.ignored(source.kind, source.at),
            None => {
                let why = format!("the link `{link}` does not exist");
                self.notes.refused(source.kind, link, source.at, why);
            }
        }
    }

    /// Reports a transmission, of which Drake reads the inertia of the rotor.
    pub(super) fn transmission(&mut self, node: Node<'a, 'i>) {
        let is_rotor = |n: &Node<'a, 'i>| {
            local(*n) == "rotor_inertia" && n.attribute("value").is_some_and(|x| x.trim().parse() != Ok(0.0))
        };
        match node.descendants().find(is_rotor) {
            Some(rotor) => {
                let name = node.attribute("name").unwrap_or_default();
                self.notes.refused("rotor_inertia", name, xml::at(0, rotor), robot::ROTOR);
            }
            None => self.notes.ignored("transmission", xml::at(0, node)),
        }
    }

    /// Reports limits, springs and dampers of a joint that closes a loop.
    fn unsupported_of_loop(&mut self, node: Node<'a, 'i>, name: &str) {
        let number = |part: Node<'a, 'i>, key: &'static str| {
            let text = part.attribute(key).or_else(|| child(part, key)?.text());
            text.and_then(|text| text.trim().parse::<f64>().ok())
        };
        let axes = child(node, "axis").into_iter().chain([node]);
        for part in axes.flat_map(children) {
            let is_limited = || {
                let [low, high] = ["lower", "upper"].map(|key| number(part, key));
                xml::range(low.unwrap_or(f64::NEG_INFINITY), high.unwrap_or(f64::INFINITY)).is_some()
            };
            let is_loaded = || {
                ["damping", "friction", "spring_stiffness"]
                    .iter()
                    .any(|key| number(part, key).is_some_and(|x| x != 0.0))
            };
            let at = xml::at(0, part);
            match local(part) {
                kind @ "limit" if is_limited() => {
                    let why =
                        "limits of a joint that closes a loop are not imported: add `limits` to the joint";
                    self.notes.refused(kind, name, at, why);
                }
                kind @ "dynamics" if is_loaded() => {
                    let why = "springs, dampers and friction of a joint that closes a loop are not imported";
                    self.notes.refused(kind, name, at, why);
                }
                kind @ ("limit" | "dynamics") => self.notes.ignored(kind, at),
                _ => {}
            }
        }
    }

    /// Reports an unknown element of the robot, which may be a loop closure of another program.
    pub(super) fn unknown(&mut self, kind: &str, node: Node<'a, 'i>) {
        let mut named: Vec<&str> = Vec::new();
        for n in node.descendants() {
            let words = n.attributes().map(|a| a.value()).chain(n.is_text().then(|| n.text()).flatten());
            for word in words.map(str::trim) {
                if self.links.contains_key(word) && !named.contains(&word) && named.len() < 3 {
                    named.push(word);
                }
            }
        }
        let at = xml::at(0, node);
        let why = match named[..] {
            [a, b] => {
                let why = format!(
                    "it names the links `{a}` and `{b}`: if it closes a loop, `--close {a}={b}` does so at their origins, \
                     `--close {a}@X,Y,Z={b}@X,Y,Z` at points in them"
                );
                self.notes.remark(format!("`{kind}` is not understood and may close a loop: {why}"));
                why
            }
            _ => "unknown element of the robot".to_owned(),
        };
        self.notes.not_understood(kind, node.attribute("name").unwrap_or_default(), at, why);
    }

    /// Adds the frames of all links.
    pub(super) fn frames(&mut self, joints: &[JointDeclaration<'a, 'i>]) {
        let parents: BTreeSet<&str> = joints.iter().map(|j| j.parent.as_str()).collect();
        for (name, (body, pose)) in &self.poses {
            let shaped = self.links.get(name).is_none_or(|l| {
                ["visual", "collision"].iter().any(|key| child(*l, key).is_some())
                    || child(*l, "inertial")
                        .and_then(|i| child(i, "mass")?.attribute("value")?.parse().ok())
                        .is_some_and(|m: f64| m > LIGHT)
            });
            self.m.frame(name, *body, *pose, !shaped && !parents.contains(name.as_str()));
        }
    }

    pub(super) fn mimics(&mut self, joints: &[JointDeclaration<'a, 'i>]) {
        for j in joints {
            let Some(mimic) = &j.mimic else { continue };
            let at = attribute_at(0, mimic.node, "joint").or_else(|| xml::at(0, mimic.node));
            match (self.joints.get(&j.name).copied(), self.joints.get(&mimic.joint).copied()) {
                (Some(own), Some(master)) if own != master => {
                    let note = ElementSource { kind: "mimic of", name: &mimic.joint, at }.note(self.notes);
                    let terms = vec![(own, 1.0), (master, -mimic.factor)];
                    self.m.coupler(&format!("{}_mimic", j.name), note, terms);
                    self.notes.taken("mimic", &j.name, at);
                }
                _ if j.name == mimic.joint => {
                    let message = format!("`{}` follows itself", j.name);
                    self.notes.problem_with("HP0803", at, message, "use another joint of the robot");
                }
                _ if self.names.contains(&mimic.joint) => {
                    let why = format!(
                        "`{}` or `{}`, which it follows, has no single coordinate",
                        j.name, mimic.joint
                    );
                    self.notes.refused("mimic", &j.name, at, why);
                }
                _ => {
                    let near =
                        hardpoint::draft::did_you_mean(&mimic.joint, self.names.iter().map(String::as_str));
                    let help = near
                        .map_or("use another joint of the robot".into(), |n| format!("did you mean `{n}`?"));
                    let message =
                        format!("`{}` follows the joint `{}`, which does not exist", j.name, mimic.joint);
                    self.notes.problem_with("HP0803", at, message, &help);
                }
            }
        }
    }

    /// Reads joints that close loops: `loop_joint`, with the points on both links as in Drake and Isaac Sim, or like a
    /// joint; ball constraints of Drake; joints of SDF in a `gazebo` element.
    pub(super) fn loops(&mut self, robot: Node<'a, 'i>) {
        for node in named(robot, "loop_joint") {
            let Some(name) = self.name(node) else { continue };
            let kind = node.attribute("type").unwrap_or("continuous").trim().to_ascii_lowercase();
            let axis = self.axis(node, &kind);
            // The documentation of Isaac Sim names both of them `link1`.
            let links: Vec<_> =
                children(node).filter(|n| ["link1", "link2"].contains(&n.tag_name().name())).collect();
            let ends = match links[..] {
                [a, b] => {
                    let ends = [a, b].map(|end| {
                        let (body, outer) = self.link_frame(end, "link")?;
                        Some((body, outer.compose(pose(end, self.notes))))
                    });
                    self.at_origins(node, ends).unwrap_or(ends)
                }
                _ => self.ends(node),
            };
            xml::unknown(0, node, &name, LOOP, self.notes);
            self.unsupported_of_loop(node, &name);
            if let [Some(i), Some(j)] = ends {
                // Directions are those of the first link, except for fixed joints with both orientations.
                let origins = ORIGINS.map(|key| child(node, key));
                let both = [[0, 1].map(|k| links.get(k).copied()), origins]
                    .iter()
                    .any(|ends| ends.iter().all(|end| end.is_some_and(|end| end.has_attribute("rpy"))));
                let rot = if kind == "fixed" && both { j.1.rot } else { i.1.rot };
                let j = (j.0, Pose { rot, r: j.1.r });
                self.connect(node, &name, &kind, [i, j], axis);
            }
        }
        for (k, node) in named(robot, "ball_constraint").enumerate() {
            xml::unknown(0, node, "", robot::BALL_CONSTRAINT, self.notes);
            let ends = robot::BALL_ENDS.map(|(body, place)| {
                let Some(named) = child(node, body) else {
                    let message = format!("the ball constraint has no `{body}`");
                    self.notes.problem_with(
                        "HP0803",
                        xml::at(0, node),
                        message,
                        "add it with the name of a link",
                    );
                    return None;
                };
                let (body, outer) = self.link_frame(named, "name")?;
                let place = child(node, place).and_then(|p| attribute::<3>(0, p, "value", self.notes));
                Some((body, Pose { rot: home().rot, r: outer.point(place.unwrap_or_default().into()) }))
            });
            if let [Some(i), Some(j)] = ends {
                self.connect(node, &format!("ball_constraint_{}", k + 1), "ball", [i, j], Z.into());
            }
        }
        for node in named(robot, "gazebo").flat_map(|g| named(g, "joint")) {
            let Some(name) = self.name(node) else { continue };
            xml::unknown(0, node, &name, LOOP, self.notes);
            child(node, "axis").into_iter().for_each(|axis| xml::unknown(0, axis, &name, AXIS, self.notes));
            self.unsupported_of_loop(node, &name);
            let kind = node.attribute("type").unwrap_or_default().to_ascii_lowercase();
            let [Some(i), Some(j)] = self.ends(node) else { continue };
            let axis = child(node, "axis").and_then(|a| child(a, "xyz"));
            let at = axis.and_then(|a| xml::at(0, a));
            let given =
                axis.and_then(|a| xml::exactly::<3>(a.text().unwrap_or_default(), "`xyz`", at, self.notes));
            let axis = Vec3::from(given.unwrap_or(Z));
            if axis.unit().is_none() && !WITHOUT_AXIS.contains(&kind.as_str()) {
                let help = "give a non-zero vector";
                self.notes.problem_with("HP0804", at, "the axis has no direction", help);
                continue;
            }
            self.connect(node, &name, &kind, [(i.0, j.1), j], axis);
        }
    }

    /// Handles floating links: those in loops remain free, the others are fixed in the design configuration.
    pub(super) fn floating(&mut self) {
        for (name, node, bodies, place) in std::mem::take(&mut self.floating) {
            let at = xml::at(0, node);
            if self.m.are_connected(bodies) {
                let why =
                    "no joint: loops constrain the link, and drivers fix its remaining degrees of freedom";
                self.notes.approximated("joint", &name, at, why);
                continue;
            }
            let why = "nothing constrains it in the source: it is fixed in the design configuration";
            self.notes.approximated("joint", &name, at, why);
            let note = ElementSource { kind: "joint", name: &name, at }.note(self.notes);
            self.m.joint(crate::mechanism::Joint::new(&name, note, "fixed", bodies, place));
        }
    }

    /// Returns the body and pose of the link that an attribute names.
    fn link_frame(&mut self, node: Node<'a, 'i>, key: &str) -> End {
        let link = node.attribute(key).unwrap_or_default().trim();
        let found = self.poses.get(link).copied();
        if found.is_none() {
            let at = attribute_at(0, node, key).or_else(|| xml::at(0, node));
            let message = format!("the link `{link}` does not exist");
            self.notes.problem_with("HP0803", at, message, "use a link of the robot");
        }
        found
    }

    /// Returns the two ends of a joint with `parent` and `child`: the frame is that of the child, or relative to the
    /// parent if `origin` is given.
    fn ends(&mut self, node: Node<'a, 'i>) -> [End; 2] {
        let [parent, body] = ["parent", "child"]
            .map(|end| self.link_of(node, end).and_then(|link| self.poses.get(&link).copied()));
        let (Some((i, outer)), Some((j, inner))) = (parent, body) else { return [None, None] };
        if let Some(ends) = self.at_origins(node, [parent, body]) {
            return ends;
        }
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

    /// Returns the ends at `parent_origin` and `child_origin` in the frames of both ends; `None` if the joint has
    /// neither. An end without one is at its frame.
    fn at_origins(&mut self, node: Node<'a, 'i>, ends: [End; 2]) -> Option<[End; 2]> {
        let origins = ORIGINS.map(|key| child(node, key));
        origins.iter().any(Option::is_some).then(|| {
            [0, 1].map(|k| {
                let ((body, frame), Some(origin)) = (ends[k]?, origins[k]) else { return ends[k] };
                Some((body, frame.compose(pose(origin, self.notes))))
            })
        })
    }
}
