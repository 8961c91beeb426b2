//! Models and worlds in SDFormat (Gazebo): frames, nested models, joints with their axes, mimic and gearbox.

use std::collections::BTreeMap;

use hardpoint::space::{Pose, Quat, Vec3};
use roxmltree::{Document, Node};

use crate::markers::{Called, Joined, Marker, carrying, join, way};
use crate::mechanism::{Coordinate, GROUND, Mechanism};
use crate::report::{At, Notes};
use crate::shapes::Solid;
use crate::turn::{home, roll_pitch_yaw};
use crate::xml::{child, children, exactly, named};
use crate::{Format, Input, xml};

/// See the module.
pub const FORMAT: Format = Format {
    name: "sdf",
    about: "SDFormat model or world",
    endings: &["sdf", "world"],
    looks: |text| text.contains("<sdf"),
    read,
    binary: false,
};

/// Models contain models, and frames refer to frames, so deep at most.
const DEEPEST: usize = 40;
/// So many files are included at most.
const MOST_INCLUDED: usize = 100;

fn read(input: &mut Input<'_>, notes: &mut Notes) -> Option<Mechanism> {
    // Texts first: what is read of them refers to all of them.
    let texts = included(input, notes);
    let mut documents: Vec<Option<Document<'_>>> = Vec::new();
    for (number, (_, text)) in texts.iter().enumerate() {
        documents.push(xml::parse(text, number, notes));
    }
    let root = documents.first()?.as_ref()?.root_element();
    if root.tag_name().name() != "sdf" {
        let message = format!("the first element is `{}`, not `sdf`", root.tag_name().name());
        notes.problem_with("HP0803", xml::at(0, root), message, "name the format, like `--format urdf`");
        return None;
    }
    let version = root.attribute("version").and_then(|v| v.trim().parse().ok()).unwrap_or(1.7);
    let mut reader = Reader {
        m: Mechanism::new(input.stem, "m", "rad"),
        notes,
        paths: texts.iter().map(|(path, _)| path.clone()).collect(),
        documents: &documents,
        frames: BTreeMap::new(),
        joints: BTreeMap::new(),
        version,
        several: false,
        shapes: Vec::new(),
    };
    let mut worlds = named(root, "world");
    let world = worlds.next();
    for other in worlds {
        let name = other.attribute("name").unwrap_or_default();
        reader.notes.refused("world", name, xml::at(0, other), "only the first world of a file is read");
    }
    let own = |n: &Node<'_, '_>| ["model", "include"].contains(&n.tag_name().name());
    reader.several = world.into_iter().chain([root]).flat_map(children).filter(own).count() > 1;
    for outer in world.into_iter().chain([root]) {
        reader.models(outer, 0, "", home(), 0);
        for node in children(outer) {
            if !["model", "include", "world"].contains(&node.tag_name().name()) {
                reader.notes.ignored(node.tag_name().name(), xml::at(0, node));
            }
        }
    }
    if let Some(name) =
        world.into_iter().chain([root]).flat_map(|w| named(w, "model")).find_map(|m| m.attribute("name"))
    {
        reader.m.name = name.to_owned();
    }
    let (m, shapes) = (reader.m, std::mem::take(&mut reader.shapes));
    for (text, visual, body, link) in shapes {
        shown(input, notes, text, visual, body, &link);
    }
    (m.bodies.len() > 1).then_some(m)
}

/// The text itself and those that it includes, by the paths that name them.
fn included(input: &Input<'_>, notes: &mut Notes) -> Vec<(String, String)> {
    let mut texts = vec![(String::new(), input.text.to_owned())];
    let mut k = 0;
    while k < texts.len() && texts.len() < MOST_INCLUDED {
        let Some(document) = Document::parse(&texts[k].1.clone()).ok().map(|d| {
            let uris =
                d.descendants().filter(|n| n.has_tag_name("include")).filter_map(|n| child(n, "uri")?.text());
            uris.map(|u| u.trim().to_owned()).collect::<Vec<String>>()
        }) else {
            k += 1;
            continue;
        };
        for uri in document {
            if texts.iter().any(|(path, _)| *path == uri) {
                continue;
            }
            let bytes = input.file(&uri).or_else(|| input.file(&format!("{uri}/model.sdf")));
            if let Some(text) = bytes.and_then(|b| String::from_utf8(b).ok()) {
                notes.text(&uri, &text);
                texts.push((uri, text));
            }
        }
        k += 1;
    }
    texts
}

/// A frame that has a name: on which body, and where.
#[derive(Clone, Copy)]
struct Frame {
    body: usize,
    pose: Pose,
}

struct Reader<'d, 'n> {
    m: Mechanism,
    notes: &'n mut Notes,
    paths: Vec<String>,
    documents: &'d [Option<Document<'d>>],
    /// By their names, with those of the models that they are in.
    frames: BTreeMap<String, Frame>,
    joints: BTreeMap<String, Joined>,
    version: f64,
    /// Whether the file has more than one model: then names have their model's before them.
    several: bool,
    shapes: Vec<(usize, Node<'d, 'd>, usize, String)>,
}

impl<'d> Reader<'d, '_> {
    /// The models in an element, and those that it includes.
    fn models(&mut self, parent: Node<'d, 'd>, text: usize, scope: &str, outer: Pose, depth: usize) {
        if depth > DEEPEST {
            self.notes.problem_with(
                "HP0805",
                xml::at(text, parent),
                "models include each other too deep",
                "look for a model that includes itself",
            );
            return;
        }
        for model in named(parent, "model") {
            self.model(model, text, scope, outer, depth, None);
        }
        for include in named(parent, "include") {
            let uri = child(include, "uri").and_then(|u| u.text()).unwrap_or_default().trim();
            let number = self.paths.iter().position(|p| p == uri).filter(|k| *k > 0);
            let document = number.and_then(|k| self.documents[k].as_ref());
            let model = document.and_then(|d| child(d.root_element(), "model"));
            match (number, model) {
                (Some(number), Some(model)) => {
                    self.model(model, number, scope, outer, depth + 1, Some((text, include)))
                }
                _ => self.notes.refused(
                    "include",
                    uri,
                    xml::at(text, include),
                    "there is no such model beside the file",
                ),
            }
        }
    }

    fn name_of(&mut self, text: usize, node: Node<'d, 'd>) -> String {
        let name = node.attribute("name").map(str::trim).filter(|n| !n.is_empty());
        if name.is_none() {
            let message = format!("`{}` has no name", node.tag_name().name());
            self.notes.problem_with("HP0803", xml::at(text, node), message, "give it an attribute `name`");
        }
        name.unwrap_or_default().to_owned()
    }

    fn model(
        &mut self,
        model: Node<'d, 'd>,
        text: usize,
        scope: &str,
        outer: Pose,
        depth: usize,
        include: Option<(usize, Node<'d, 'd>)>,
    ) {
        let renamed = include.and_then(|(_, i)| child(i, "name")?.text());
        let name = renamed.map_or_else(|| self.name_of(text, model), |n| n.trim().to_owned());
        // Names within a model are seen from outside with the model's before them.
        let alone = depth == 0 && scope.is_empty() && !self.several;
        let scope = if alone { String::new() } else { format!("{scope}{name}::") };
        let own = match include.and_then(|(number, i)| Some((number, child(i, "pose")?))) {
            Some((number, p)) => self.written_pose(number, p),
            None => child(model, "pose").map_or_else(home, |p| self.written_pose(text, p)),
        };
        if let Some(at) = model.attribute_node("placement_frame") {
            let at = At { text, start: at.range().start, end: at.range().end };
            self.notes.refused(
                "placement_frame",
                &name,
                Some(at),
                "the model stands as if it were placed by its own frame",
            );
        }
        let place = outer.compose(own);
        let flag = |node: Node<'_, '_>, key: &'static str| {
            child(node, key).and_then(|n| n.text()).is_some_and(|t| ["1", "true"].contains(&t.trim()))
        };
        let is_static = flag(model, "static") || include.is_some_and(|(_, i)| flag(i, "static"));
        self.frames.insert(format!("{scope}__model__"), Frame { body: GROUND, pose: place });
        self.frames.insert(format!("{scope}world"), Frame { body: GROUND, pose: home() });
        self.models(model, text, &scope, place, depth + 1);
        self.place_frames(model, text, &scope, place, is_static);
        let joints: Vec<Node<'d, 'd>> = named(model, "joint").collect();
        for joint in &joints {
            self.joint(*joint, text, &scope, place);
        }
        for joint in &joints {
            self.relation(*joint, text, &scope);
        }
        for node in children(model) {
            let known = ["link", "joint", "frame", "model", "include", "pose", "static"];
            if !known.contains(&node.tag_name().name()) {
                self.notes.ignored(node.tag_name().name(), xml::at(text, node));
            }
        }
    }

    /// Links and frames, as their poses refer to each other.
    fn place_frames(&mut self, model: Node<'d, 'd>, text: usize, scope: &str, place: Pose, is_static: bool) {
        let mut waiting: Vec<Node<'d, 'd>> =
            children(model).filter(|n| ["link", "frame", "joint"].contains(&n.tag_name().name())).collect();
        loop {
            let before = waiting.len();
            let mut rest = Vec::new();
            for node in waiting {
                if !self.place_frame(node, text, scope, place, is_static) {
                    rest.push(node);
                }
            }
            waiting = rest;
            if waiting.is_empty() {
                return;
            }
            if waiting.len() == before {
                break;
            }
        }
        for node in waiting {
            let name = node.attribute("name").unwrap_or_default();
            let message = format!("the pose of `{name}` refers to a frame that is not there, or in a circle");
            let help = "name a link, joint, frame or model of the file";
            self.notes.problem_with("HP0803", xml::at(text, node), message, help);
        }
    }

    /// Whether the frame of a link, joint or `frame` could be placed.
    fn place_frame(
        &mut self,
        node: Node<'d, 'd>,
        text: usize,
        scope: &str,
        place: Pose,
        is_static: bool,
    ) -> bool {
        let name = node.attribute("name").unwrap_or_default().trim().to_owned();
        let written = child(node, "pose");
        let relative = written
            .and_then(|p| p.attribute("relative_to").or_else(|| p.attribute("frame")))
            .filter(|r| !r.is_empty());
        let kind = node.tag_name().name();
        let base = match (relative, kind) {
            (Some(relative), _) => self.frame(scope, relative),
            (None, "joint") => {
                let of = child(node, "child").and_then(|c| c.text()).unwrap_or_default().trim();
                self.frame(scope, of)
            }
            (None, "frame") => match node.attribute("attached_to").filter(|a| !a.is_empty()) {
                Some(to) => self.frame(scope, to),
                None => Some(Frame { body: GROUND, pose: place }),
            },
            _ => Some(Frame { body: GROUND, pose: place }),
        };
        let Some(base) = base else { return false };
        let body = match kind {
            "frame" => match node.attribute("attached_to").filter(|a| !a.is_empty()) {
                Some(to) => match self.frame(scope, to) {
                    Some(frame) => frame.body,
                    None => return false,
                },
                None => base.body,
            },
            _ => base.body,
        };
        let pose = base.pose.compose(written.map_or_else(home, |p| self.written_pose(text, p)));
        let at = xml::at(text, node);
        let body = if kind == "link" {
            let name = self.name_of(text, node);
            if self.frames.contains_key(&format!("{scope}{name}")) {
                self.notes.problem_with(
                    "HP0803",
                    at,
                    format!("there are two links or frames `{name}`"),
                    "rename one of them",
                );
            }
            let note = Called { kind: "link", name: &name, at }.note(self.notes);
            let body = self.m.body(&format!("{scope}{name}"), note, Some(pose));
            self.notes.taken("link", &name, at);
            if is_static {
                self.m.joint(crate::mechanism::Joint::new(
                    &format!("{name}_static"),
                    "its model is static".into(),
                    "fixed",
                    [GROUND, body],
                    pose.r,
                ));
            }
            for part in children(node) {
                match part.tag_name().name() {
                    "visual" => self.shapes.push((text, part, body, name.clone())),
                    "pose" => {}
                    other => self.notes.ignored(other, xml::at(text, part)),
                }
            }
            body
        } else {
            body
        };
        // A joint may have the name of a link.
        self.frames.entry(format!("{scope}{name}")).or_insert(Frame { body, pose });
        if kind == "joint" {
            self.frames.insert(format!("{scope}joint {name}"), Frame { body, pose });
        }
        true
    }

    fn frame(&self, scope: &str, name: &str) -> Option<Frame> {
        if name == "world" {
            return Some(Frame { body: GROUND, pose: home() });
        }
        let own = self.frames.get(&format!("{scope}{name}"));
        // A nested model's name is its frame.
        own.or_else(|| self.frames.get(&format!("{scope}{name}::__model__"))).copied()
    }

    /// A pose as it is written: x y z roll pitch yaw, or with a quaternion.
    fn written_pose(&mut self, text: usize, node: Node<'d, 'd>) -> Pose {
        let words = node.text().unwrap_or_default();
        let at = xml::at(text, node);
        if words.trim().is_empty() {
            return home();
        }
        if node.attribute("rotation_format") == Some("quat_xyzw") {
            let Some([x, y, z, a, b, c, w]) = exactly::<7>(words, "`pose`", at, self.notes) else {
                return home();
            };
            let Some(q) = Quat::from_array([w, a, b, c]) else {
                self.notes.problem_with(
                    "HP0804",
                    at,
                    "the quaternion of the pose is null",
                    "give it a length other than zero",
                );
                return home();
            };
            return Pose { rot: q.rotation(), r: [x, y, z].into() };
        }
        let Some([x, y, z, mut a, mut b, mut c]) = exactly::<6>(words, "`pose`", at, self.notes) else {
            return home();
        };
        if node.attribute("degrees").is_some_and(|d| ["1", "true"].contains(&d)) {
            [a, b, c] = [a, b, c].map(f64::to_radians);
        }
        Pose { rot: roll_pitch_yaw([a, b, c]), r: [x, y, z].into() }
    }

    fn end(&mut self, joint: Node<'d, 'd>, text: usize, scope: &str, end: &'static str) -> Option<Frame> {
        let element = child(joint, end);
        let name = element.and_then(|e| e.text()).unwrap_or_default().trim();
        let frame = self.frame(scope, name);
        if frame.is_none() {
            let at = element.map_or_else(|| xml::at(text, joint), |e| xml::at(text, e));
            let message = match name {
                "" => format!("the joint has no `{end}`"),
                name => format!("there is no link or frame `{name}`"),
            };
            self.notes.problem_with("HP0803", at, message, "name a link, a frame, or `world`");
        }
        frame
    }

    /// The axis of a joint, global.
    fn axis(
        &mut self,
        joint: Node<'d, 'd>,
        text: usize,
        scope: &str,
        frame: Pose,
        place: Pose,
        key: &'static str,
    ) -> Vec3 {
        let axis = child(joint, key);
        let xyz = axis.and_then(|a| child(a, "xyz"));
        let given = xyz
            .and_then(|x| exactly::<3>(x.text().unwrap_or_default(), "`xyz`", xml::at(text, x), self.notes));
        let v = Vec3::from(given.unwrap_or([0.0, 0.0, 1.0]));
        let of_model = axis.and_then(|a| child(a, "use_parent_model_frame")).and_then(|n| n.text());
        let of_model = of_model.map_or(self.version < 1.5, |t| ["1", "true"].contains(&t.trim()));
        let expressed = xyz.and_then(|x| x.attribute("expressed_in")).filter(|e| !e.is_empty());
        let rot = match expressed {
            Some(name) => match self.frame(scope, name) {
                Some(frame) => frame.pose.rot,
                None => {
                    let at = xyz.and_then(|x| xml::at(text, x));
                    self.notes.problem_with(
                        "HP0803",
                        at,
                        format!("there is no frame `{name}`"),
                        "name a link, joint, frame or model of the file",
                    );
                    frame.rot
                }
            },
            None if of_model => place.rot,
            None => frame.rot,
        };
        if v.unit().is_none() {
            let at = xyz.and_then(|x| xml::at(text, x));
            self.notes.problem_with(
                "HP0804",
                at,
                "the axis has no direction",
                "give a vector other than zero",
            );
            return [0.0, 0.0, 1.0].into();
        }
        rot * v
    }

    fn joint(&mut self, joint: Node<'d, 'd>, text: usize, scope: &str, place: Pose) {
        let name = self.name_of(text, joint);
        let at = xml::at(text, joint);
        let ends = ["parent", "child"].map(|end| self.end(joint, text, scope, end));
        let [Some(i), Some(j)] = ends else { return };
        let Some(frame) = self.frames.get(&format!("{scope}joint {name}")).map(|f| f.pose) else { return };
        let full = format!("{scope}{name}");
        let called = Called { kind: "joint", name: &full, at };
        let kind = joint.attribute("type").unwrap_or_default().trim();
        let type_name = match kind {
            "revolute" | "continuous" => "revolute",
            "prismatic" => "translational",
            "ball" => "spherical",
            "fixed" => "fixed",
            "screw" => "screw",
            "universal" | "revolute2" => "universal",
            "gearbox" => return,
            _ => {
                let at = xml::attribute_at(text, joint, "type").or(at);
                let help = "SDF knows revolute, continuous, prismatic, ball, universal, revolute2, screw, gearbox and fixed";
                self.notes.problem_with(
                    "HP0805",
                    at,
                    format!("`{name}` is of the unknown type `{kind}`"),
                    help,
                );
                return;
            }
        };
        let axis = if ["spherical", "fixed"].contains(&type_name) {
            frame.rot.cols[2]
        } else {
            self.axis(joint, text, scope, frame, place, "axis")
        };
        let second = if type_name == "universal" {
            self.axis(joint, text, scope, frame, place, "axis2")
        } else {
            axis
        };
        let ends = [(i.body, axis), (j.body, second)].map(|(body, axis)| Marker::along(body, frame.r, axis));
        let [Some(i), Some(j)] = ends else { return };
        let Some(number) = join(&mut self.m, self.notes, called, type_name, [i, j]) else { return };
        let limit = child(joint, "axis").and_then(|a| child(a, "limit"));
        let value = |key: &'static str| {
            limit.and_then(|l| child(l, key)).and_then(|n| n.text()?.trim().parse::<f64>().ok())
        };
        if let (Some(low), Some(high)) = (value("lower"), value("upper"))
            && low < high
            && low > -1e15
            && high < 1e15
        {
            self.m.joints[number].limits = Some([low, high]);
        }
        if type_name == "screw" {
            let number_of = |reader: &mut Self, key: &'static str| {
                let n = child(joint, key).or_else(|| child(joint, "axis").and_then(|a| child(a, key)))?;
                exactly::<1>(n.text().unwrap_or_default(), key, xml::at(text, n), reader.notes).map(|[x]| x)
            };
            let own = number_of(self, "screw_thread_pitch");
            // The older key is in rad per length, and counts the other way.
            let older =
                number_of(self, "thread_pitch").filter(|p| *p != 0.0).map(|p| -std::f64::consts::TAU / p);
            match own.or(older).filter(|p| *p != 0.0) {
                Some(lead) => self.m.joints[number].lead = Some(lead),
                None => self.notes.problem_with(
                    "HP0804",
                    at,
                    format!("the screw `{name}` has no pitch"),
                    "give it a `screw_thread_pitch` other than zero",
                ),
            }
        }
        self.joints.insert(full, Joined { number, kind: type_name, markers: [i, j] });
    }

    /// What ties a joint to others: `mimic`, and gearboxes.
    fn relation(&mut self, joint: Node<'d, 'd>, text: usize, scope: &str) {
        let name = joint.attribute("name").unwrap_or_default().trim();
        let full = format!("{scope}{name}");
        let number = |reader: &mut Self, node: Node<'d, 'd>, key: &'static str| {
            let n = child(node, key)?;
            exactly::<1>(n.text().unwrap_or_default(), key, xml::at(text, n), reader.notes).map(|[x]| x)
        };
        for mimic in child(joint, "axis").into_iter().flat_map(|a| named(a, "mimic")) {
            let other = mimic.attribute("joint").unwrap_or_default();
            let factor = number(self, mimic, "multiplier").unwrap_or(1.0);
            let drawn = number(self, mimic, "offset").unwrap_or(0.0)
                - factor * number(self, mimic, "reference").unwrap_or(0.0);
            let ends = [full.clone(), format!("{scope}{other}")]
                .map(|n| self.joints.get(&n).and_then(only_coordinate));
            let at = xml::at(text, mimic);
            let [Some(own), Some(master)] = ends else {
                let message = format!(
                    "`{name}` follows the joint `{other}`, which is not there or has no single coordinate"
                );
                self.notes.problem_with("HP0803", at, message, "name a joint that turns or slides");
                continue;
            };
            let note = Called { kind: "mimic of", name: other, at }.note(self.notes);
            self.m.coupler(&format!("{name}_mimic"), note, vec![(own, 1.0), (master, -factor)]);
            match drawn {
                0.0 => self.notes.taken("mimic", name, at),
                _ => self.notes.approximated(
                    "mimic",
                    name,
                    at,
                    "its offset is left out: both joints count from the drawing",
                ),
            }
        }
        if joint.attribute("type").map(str::trim) != Some("gearbox") {
            return;
        }
        let at = xml::at(text, joint);
        let ratio = number(self, joint, "gearbox_ratio").unwrap_or(1.0);
        let reference = child(joint, "gearbox_reference_body")
            .and_then(|n| n.text())
            .unwrap_or_default()
            .trim()
            .to_owned();
        let [parent, driven] = ["parent", "child"].map(|end| self.end(joint, text, scope, end));
        let (Some(parent), Some(driven), Some(carrier)) = (parent, driven, self.frame(scope, &reference))
        else {
            self.notes.refused("joint", &full, at, "a gearbox whose reference body is not there");
            return;
        };
        let Some(frame) = self.frames.get(&format!("{scope}joint {name}")).map(|f| f.pose) else { return };
        let axes = ["axis", "axis2"].map(|key| self.axis(joint, text, scope, frame, frame, key));
        let hinge = |body: usize, axis: Vec3| {
            let on_carrier =
                self.joints.values().filter(|k| k.markers.iter().any(|m| m.body == carrier.body));
            let axis = axis.unit().unwrap_or(axis);
            let k = carrying(on_carrier, body, &["revolute"], axis)?;
            Some((k.number, way(k, body, axis)))
        };
        match (hinge(parent.body, axes[0]), hinge(driven.body, axes[1])) {
            (Some((a, u)), Some((b, v))) => {
                let terms = vec![
                    (Coordinate { joint: b, name: "angle" }, v),
                    (Coordinate { joint: a, name: "angle" }, ratio * u),
                ];
                let note = Called { kind: "joint", name, at }.note(self.notes);
                self.m.coupler(name, note, terms);
                self.notes.taken("gearbox", &full, at);
            }
            _ => self.notes.refused(
                "joint",
                &full,
                at,
                "a gearbox needs hinges of both bodies on the reference body, along its axes",
            ),
        }
    }
}

fn only_coordinate(joint: &Joined) -> Option<Coordinate> {
    let name = match joint.kind {
        "revolute" | "screw" => "angle",
        "translational" => "displacement",
        _ => return None,
    };
    Some(Coordinate { joint: joint.number, name })
}

/// The shape of a link, of one `visual`.
fn shown(
    input: &mut Input<'_>,
    notes: &mut Notes,
    text: usize,
    visual: Node<'_, '_>,
    body: usize,
    link: &str,
) {
    let at = xml::at(text, visual);
    let place = match child(visual, "pose") {
        Some(p) => {
            let n = exactly::<6>(p.text().unwrap_or_default(), "`pose`", xml::at(text, p), notes)
                .unwrap_or_default();
            Pose { rot: roll_pitch_yaw([n[3], n[4], n[5]]), r: [n[0], n[1], n[2]].into() }
        }
        None => home(),
    };
    let Some(shape) = child(visual, "geometry").and_then(|g| children(g).next()) else { return };
    let numbers = |key: &'static str| {
        child(shape, key).and_then(|n| xml::numbers(n.text().unwrap_or_default())).unwrap_or_default()
    };
    let number = |key| numbers(key).first().copied().unwrap_or(0.0);
    let three = |key| <[f64; 3]>::try_from(numbers(key)).ok();
    let solid = match shape.tag_name().name() {
        "mesh" => {
            let path = child(shape, "uri").and_then(|u| u.text()).unwrap_or_default().trim();
            input.mesh(
                body,
                place,
                three("scale").unwrap_or([1.0; 3]),
                path,
                link,
                xml::at(text, shape),
                notes,
            );
            return;
        }
        "box" => Solid::Box(three("size").unwrap_or_default()),
        "cylinder" => Solid::Cylinder(number("radius"), number("length")),
        "capsule" => Solid::Capsule(number("radius"), number("length")),
        "sphere" => Solid::Ball([number("radius"); 3]),
        "ellipsoid" => Solid::Ball(three("radii").unwrap_or_default()),
        "empty" => return,
        other => {
            notes.refused("visual", link, at, format!("a shape `{other}` is not shown"));
            return;
        }
    };
    input.shapes.solid(body, place, solid);
    notes.taken("visual", link, at);
}
