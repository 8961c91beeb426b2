//! Models and worlds in SDFormat (Gazebo): frames, nested and included models, joints with their axes, mimic joints and
//! gearboxes.

mod joints;
mod masses;

use std::collections::{BTreeMap, BTreeSet};

use hardpoint::space::{Pose, Quat};
use roxmltree::{Document, Node};

use crate::markers::{ElementSource, MarkerJoint};
use crate::mechanism::{GROUND, Joint, Mechanism};
use crate::report::ImportLog;
use crate::shapes::Solid;
use crate::turn::{diagonal, home, roll_pitch_yaw};
use crate::xml::{Vocabulary, child, children, exactly, local, named};
use crate::{Format, Input, robot, xml};

/// SDFormat format.
pub const FORMAT: Format = Format {
    name: "sdf",
    about: "SDFormat model or world",
    endings: &["sdf", "world"],
    recognises: |text| text.contains("<sdf"),
    read,
    binary: false,
};

/// Maximum depth of nested models and of frames that refer to each other.
const DEEPEST: usize = 40;
/// Maximum number of included files.
const MOST_INCLUDED: usize = 100;
/// Maximum number of placements of models; nested models count more than once.
const MOST_PLACED: usize = 20_000;
/// Known content of a link.
const LINK: Vocabulary = Vocabulary {
    attributes: &["name", "type"],
    read: &["visual", "pose", "inertial", "collision", "gravity", "velocity_decay", "damping", "enable_wind"],
    irrelevant: &[
        "sensor",
        "light",
        "audio_source",
        "audio_sink",
        "projector",
        "particle_emitter",
        "battery",
        "self_collide",
        "must_be_base_link",
        "material",
    ],
};
/// Elements of models and worlds without effect on the motion of links and joints.
const IRRELEVANT: [&str; 22] = [
    "self_collide",
    "allow_auto_disable",
    "enable_wind",
    "light",
    "physics",
    "scene",
    "magnetic_field",
    "atmosphere",
    "audio",
    "wind",
    "spherical_coordinates",
    "gui",
    "road",
    "gripper",
    "material",
    "collision_filter_group",
    "proximity_properties",
    "camera",
    "sensor",
    "uri",
    "name",
    "placement_frame",
];
/// Frame of the world.
const WORLD: &str = "world";
/// Frame of the model that contains the reference.
const OWN_MODEL: &str = "__model__";
/// Elements with a pose in a model or world.
const PLACED: [&str; 5] = ["link", "frame", "joint", "model", "include"];

fn read(input: &mut Input<'_>, notes: &mut ImportLog) -> Option<Mechanism> {
    // All texts are read first, since they refer to each other.
    let texts = included(input, notes);
    let mut documents: Vec<Option<Document<'_>>> = Vec::new();
    for (number, (_, text)) in texts.iter().enumerate() {
        documents.push(xml::parse(text, number, notes));
    }
    let root = documents.first()?.as_ref()?.root_element();
    if root.tag_name().name() != "sdf" {
        let message = format!("the first element is `{}`, not `sdf`", root.tag_name().name());
        notes.problem_with("HP0803", xml::at(0, root), message, "specify the format, like `--format urdf`");
        return None;
    }
    let world_frame = Frame { body: GROUND, pose: home() };
    let mut reader = Reader {
        m: Mechanism::new(input.stem, "m", "rad"),
        notes,
        paths: texts.iter().map(|(path, _)| path.clone()).collect(),
        documents: &documents,
        models: Vec::new(),
        bodies: BTreeMap::new(),
        frames: BTreeMap::from([(WORLD.to_owned(), world_frame)]),
        carriers: BTreeMap::from([(WORLD.to_owned(), Carrier::Body(GROUND))]),
        scopes: BTreeSet::new(),
        names: BTreeSet::new(),
        joints: BTreeMap::new(),
        several: false,
        only: String::new(),
        shapes: Vec::new(),
        declared: 0,
        bare: BTreeSet::new(),
        placed: 0,
    };
    let mut worlds = named(root, "world");
    let world = worlds.next();
    for other in worlds {
        let name = other.attribute("name").unwrap_or_default();
        reader.notes.refused("world", name, xml::at(0, other), "only the first world of a file is imported");
    }
    let outer: Vec<Node<'_, '_>> = world.into_iter().chain([root]).collect();
    // Elements of the world refer to its models by their names.
    let own = |n: &Node<'_, '_>| PLACED.contains(&n.tag_name().name());
    reader.several = outer.iter().copied().flat_map(children).filter(own).count() > 1;
    for node in &outer {
        let outermost = Model {
            node: *node,
            text: 0,
            scope: String::new(),
            frame: OWN_MODEL.to_owned(),
            include: None,
            is_static: false,
            inner: Vec::new(),
            canonical: None,
            place: home(),
        };
        let k = reader.declare(outermost, 0);
        reader.place(k, home());
    }
    if reader.placed > MOST_PLACED || reader.declared > robot::MOST_PARTS {
        return None;
    }
    reader.connect();
    reader.masses(&outer);
    if let Some(name) = outer.iter().flat_map(|w| named(*w, "model")).find_map(|m| m.attribute("name")) {
        reader.m.name = name.to_owned();
    }
    let (m, shapes) = (reader.m, std::mem::take(&mut reader.shapes));
    for shape in shapes {
        add_shape(input, notes, shape);
    }
    (m.bodies.len() > 1).then_some(m)
}

/// Returns the text itself and the included texts, by the paths that name them.
fn included(input: &Input<'_>, notes: &mut ImportLog) -> Vec<(String, String)> {
    let mut texts = vec![(String::new(), xml::lenient(input.text))];
    let mut k = 0;
    while k < texts.len() && texts.len() < MOST_INCLUDED {
        let uris: Vec<String> = xml::parse_quietly(&texts[k].1).map_or(Vec::new(), |d| {
            let uris =
                d.descendants().filter(|n| n.has_tag_name("include")).filter_map(|n| child(n, "uri")?.text());
            uris.map(|u| u.trim().to_owned()).collect()
        });
        for uri in uris {
            if texts.iter().any(|(path, _)| *path == uri) {
                continue;
            }
            let named = || input.file(&format!("{uri}/{}", newest_file(input, &uri)?));
            let bytes = input.file(&uri).or_else(|| input.file(&format!("{uri}/model.sdf"))).or_else(named);
            if let Some(text) = bytes.map(|b| crate::decoded(&b)) {
                notes.text(&uri, &text);
                texts.push((uri, xml::lenient(&text)));
            }
        }
        k += 1;
    }
    texts
}

/// Returns the file that a model's description names last, usually the newest version.
fn newest_file(input: &Input<'_>, uri: &str) -> Option<String> {
    let text = xml::lenient(&crate::decoded(&input.file(&format!("{uri}/model.config"))?));
    let document = xml::parse_quietly(&text).ok()?;
    let name = named(document.root_element(), "sdf").last()?.text()?.trim().to_owned();
    Some(name)
}

/// Returns the SDFormat version of a text; 1.10 is later than 1.9.
fn version(root: Node<'_, '_>) -> Option<(u32, u32)> {
    let (major, minor) = root.attribute("version")?.trim().split_once('.')?;
    Some((major.parse().ok()?, minor.parse().ok()?))
}

/// Named frame: its body and pose.
#[derive(Clone, Copy)]
struct Frame {
    body: usize,
    pose: Pose,
}

/// Object that carries a frame.
#[derive(Clone)]
enum Carrier {
    Body(usize),
    /// Another frame, by its full name.
    Frame(String),
}

/// Model, or the world that contains the models.
#[derive(Clone)]
struct Model<'d> {
    node: Node<'d, 'd>,
    /// Index of its text.
    text: usize,
    /// Prefix of the names in it: if its content is merged into the including model, that of this model.
    scope: String,
    /// Full name of its frame.
    frame: String,
    /// Index of the text with the including element, and that element.
    include: Option<(usize, Node<'d, 'd>)>,
    is_static: bool,
    /// Indices of the models in it.
    inner: Vec<usize>,
    /// Body that carries its frame; `None` for the world and for a model without links.
    canonical: Option<usize>,
    place: Pose,
}

impl Model<'_> {
    /// Returns the full name of a frame that is named in the model.
    fn full_name(&self, name: &str) -> String {
        match name {
            WORLD => WORLD.to_owned(),
            OWN_MODEL => self.frame.clone(),
            _ => format!("{}{name}", self.scope),
        }
    }
}

/// Element or model that is not placed yet.
#[derive(Clone, Copy)]
enum UnplacedItem<'d> {
    Element(Node<'d, 'd>),
    Model(usize),
}

/// Shape of a link.
struct VisibleShape<'d> {
    text: usize,
    visual: Node<'d, 'd>,
    body: usize,
    link: String,
    place: Pose,
}

struct Reader<'d, 'n> {
    m: Mechanism,
    notes: &'n mut ImportLog,
    paths: Vec<String>,
    documents: &'d [Option<Document<'d>>],
    /// Models; a model follows the models in it.
    models: Vec<Model<'d>>,
    /// Bodies of the links, by their names with the names of the models that contain them.
    bodies: BTreeMap<String, usize>,
    /// Frames by their names, likewise.
    frames: BTreeMap<String, Frame>,
    /// Carriers of all links, frames, joints and models by their names, likewise.
    carriers: BTreeMap<String, Carrier>,
    /// Prefixes of the names in each model.
    scopes: BTreeSet<String>,
    /// Names of all joints, likewise.
    names: BTreeSet<String>,
    joints: BTreeMap<String, MarkerJoint>,
    /// True if the file has several models, whose names then precede the names in them.
    several: bool,
    /// Prefix of the names in the only model of the file, which the mechanism omits.
    only: String,
    shapes: Vec<VisibleShape<'d>>,
    /// Number of models, links, frames and joints.
    declared: usize,
    /// Frames that are neither links nor joints.
    bare: BTreeSet<String>,
    /// Number of placements of models.
    placed: usize,
}

impl<'d> Reader<'d, '_> {
    /// Adds the bodies of a model and of the models in it. Returns the index of the model.
    fn declare(&mut self, mut model: Model<'d>, depth: usize) -> usize {
        if depth > DEEPEST {
            let help = "remove the recursive include";
            let at = xml::at(model.text, model.node);
            self.notes.problem_with("HP0805", at, "models are nested too deep", help);
            self.models.push(model);
            return self.models.len() - 1;
        }
        self.declared +=
            1 + children(model.node).filter(|n| ["link", "joint", "frame"].contains(&local(*n))).count();
        if self.declared > robot::MOST_PARTS {
            let message = format!("it has more than {} models, links, frames and joints", robot::MOST_PARTS);
            let help = "remove repeated includes, or parts that need not move";
            self.notes.problem_with("HP0802", None, message, help);
            self.models.push(model);
            return self.models.len() - 1;
        }
        for inner in children(model.node) {
            let found = match inner.tag_name().name() {
                "model" => Some((model.text, inner, None)),
                "include" => {
                    self.included(model.text, inner).map(|(k, node)| (k, node, Some((model.text, inner))))
                }
                _ => None,
            };
            let Some((text, node, include)) = found else { continue };
            let inner = self.inner(&model, text, node, include, depth);
            let k = self.declare(inner, depth + 1);
            model.inner.push(k);
        }
        for link in named(model.node, "link") {
            let name = self.name_of(model.text, link);
            let at = xml::at(model.text, link);
            let note = ElementSource { kind: "link", name: &name, at }.note(self.notes);
            let full = format!("{}{name}", model.scope);
            let shown = self.shown(&full).to_owned();
            let body = self.m.body(&shown, note, None);
            self.notes.taken("link", &name, at);
            if self.bodies.insert(full, body).is_some() {
                let message = format!("the link `{name}` is defined twice");
                self.notes.problem_with("HP0803", at, message, "rename one of them");
            }
            xml::unknown(model.text, link, &name, LINK, self.notes);
            self.poses_of(model.text, link, &name);
            let is_auto = child(link, "inertial").is_some_and(|i| i.has_attribute("auto"));
            for collision in named(link, "collision").filter(|_| !is_auto) {
                self.notes.ignored("collision", xml::at(model.text, collision));
            }
        }
        let first = named(model.node, "link").next().and_then(|l| l.attribute("name"));
        let wanted = model.node.attribute("canonical_link").filter(|l| !l.is_empty()).or(first);
        let of = wanted.and_then(|link| self.bodies.get(&format!("{}{}", model.scope, link.trim())).copied());
        // The world is no model: its frame is that of ground.
        model.canonical = of.or_else(|| model.inner.iter().find_map(|k| self.models[*k].canonical));
        model.canonical = model.canonical.filter(|_| depth > 0);
        self.declare_carriers(&model);
        let owner = model.node.attribute("name").unwrap_or_default();
        xml::repeated(model.text, model.node, owner, &["pose", "static", "gravity"], self.notes);
        for node in children(model.node) {
            let (name, at) = (local(node), xml::at(model.text, node));
            let single: &[&str] = match name {
                "frame" => &["pose"],
                "include" => &["uri", "name", "pose", "static", "placement_frame"],
                _ => &[],
            };
            let owner = node.attribute("name").unwrap_or_default();
            xml::repeated(model.text, node, owner, single, self.notes);
            match name {
                "pose" | "static" | "world" | "ball_constraint" | "linear_bushing_rpy" | "loop_joint"
                | "mujoco" | "gravity" => {}
                name if PLACED.contains(&name) => {}
                "plugin" if robot::is_mimic_plugin(node) => {}
                "plugin" => robot::plugin(model.text, node, self.notes),
                name if IRRELEVANT.contains(&name) => self.notes.ignored(name, at),
                name => {
                    let why = "unknown element of a model or world";
                    self.notes.not_understood(name, node.attribute("name").unwrap_or_default(), at, why);
                }
            }
        }
        self.models.push(model);
        self.models.len() - 1
    }

    /// Records the carriers of the frames of a model, of which the poses may not be known yet.
    fn declare_carriers(&mut self, model: &Model<'d>) {
        let scope = &model.scope;
        let of_model = Carrier::Body(model.canonical.unwrap_or(GROUND));
        self.carriers.insert(model.frame.clone(), of_model.clone());
        for link in named(model.node, "link") {
            let full = format!("{scope}{}", link.attribute("name").unwrap_or_default().trim());
            if let Some(body) = self.bodies.get(&full) {
                self.carriers.insert(full, Carrier::Body(*body));
            }
        }
        for node in children(model.node).filter(|n| ["frame", "joint"].contains(&n.tag_name().name())) {
            let name = node.attribute("name").unwrap_or_default().trim();
            let carrier = carrier_of(node);
            let carrier =
                carrier.map_or_else(|| of_model.clone(), |name| Carrier::Frame(model.full_name(name)));
            // A joint and a link may have the same name.
            self.carriers.entry(format!("{scope}{name}")).or_insert(carrier);
        }
    }

    /// Returns the body that carries a frame; its pose need not be known yet.
    fn body_of(&self, model: &Model<'_>, name: &str) -> Option<usize> {
        let mut name = &model.full_name(name);
        // A longer path returns to a frame that it has passed.
        for _ in 0..=self.carriers.len() {
            match of_frame(&self.carriers, name)? {
                Carrier::Body(body) => return Some(*body),
                Carrier::Frame(next) => name = next,
            }
        }
        None
    }

    /// Returns a full name as the mechanism shows it.
    fn shown<'a>(&self, full: &'a str) -> &'a str {
        full.strip_prefix(&self.only).unwrap_or(full)
    }

    /// Creates a nested model.
    fn inner(
        &mut self,
        outer: &Model<'d>,
        text: usize,
        node: Node<'d, 'd>,
        include: Option<(usize, Node<'d, 'd>)>,
        depth: usize,
    ) -> Model<'d> {
        let renamed = include.and_then(|(_, i)| child(i, "name")?.text());
        let name = renamed.map_or_else(|| self.name_of(text, node), |n| n.trim().to_owned());
        let flag = |node: Node<'_, '_>, key: &'static str| {
            child(node, key).and_then(|n| n.text()).is_some_and(|t| ["1", "true"].contains(&t.trim()))
        };
        let is_merged = include
            .is_some_and(|(_, i)| i.attribute("merge").is_some_and(|m| ["1", "true"].contains(&m.trim())));
        let is_static =
            outer.is_static || flag(node, "static") || include.is_some_and(|(_, i)| flag(i, "static"));
        // From outside, the names in a model have its name as a prefix.
        let scope = if is_merged {
            outer.scope.clone()
        } else {
            let own = (1..).map(|k| if k == 1 { name.clone() } else { format!("{name}_{k}") });
            let mut scopes = own.map(|name| format!("{}{name}::", outer.scope));
            // Models may have the same name.
            scopes.find(|scope| self.scopes.insert(scope.clone())).unwrap_or_default()
        };
        if depth == 0 && !self.several {
            self.only.clone_from(&scope);
        }
        // SDFormat replaces the frame of a merged model by one of the including model.
        let frame = match is_merged {
            true => format!("{scope}_merged__{name}{OWN_MODEL}"),
            false => format!("{scope}{OWN_MODEL}"),
        };
        Model {
            node,
            text,
            scope,
            frame,
            include,
            is_static,
            inner: Vec::new(),
            canonical: None,
            place: home(),
        }
    }

    /// Returns the model that an element includes, with the index of its text.
    fn included(&mut self, text: usize, include: Node<'d, 'd>) -> Option<(usize, Node<'d, 'd>)> {
        let uri = child(include, "uri").and_then(|u| u.text()).unwrap_or_default().trim();
        let number = self.paths.iter().position(|p| p == uri).filter(|k| *k > 0);
        let document = number.and_then(|k| self.documents[k].as_ref());
        let found = number.zip(document.and_then(|d| child(d.root_element(), "model")));
        let at = xml::at(text, include);
        match found {
            Some(_) => self.notes.taken("include", uri, at),
            None => self.notes.refused("include", uri, at, "the model does not exist next to the file"),
        }
        found
    }

    fn name_of(&mut self, text: usize, node: Node<'d, 'd>) -> String {
        let name = node.attribute("name").map(str::trim).filter(|n| !n.is_empty());
        if name.is_none() {
            let message = format!("`{}` has no name", node.tag_name().name());
            self.notes.problem_with("HP0803", xml::at(text, node), message, "add an attribute `name`");
        }
        name.unwrap_or_default().to_owned()
    }

    /// Places the content of a model in the order in which its poses refer to each other. A model may be placed more
    /// than once: its frame may depend on a frame in it.
    fn place(&mut self, k: usize, place: Pose) {
        self.placed += 1;
        if self.placed > MOST_PLACED {
            let help = "remove `placement_frame` from nested models";
            self.notes.problem_with(
                "HP0802",
                None,
                "its models depend on each other's placement too often",
                help,
            );
            return;
        }
        self.models[k].place = place;
        let model = self.models[k].clone();
        let of_model = Frame { body: model.canonical.unwrap_or(GROUND), pose: place };
        self.frames.insert(model.frame.clone(), of_model);
        let elements =
            children(model.node).filter(|n| ["link", "frame", "joint"].contains(&n.tag_name().name()));
        let mut waiting: Vec<UnplacedItem<'d>> =
            model.inner.iter().map(|k| UnplacedItem::Model(*k)).collect();
        waiting.extend(elements.map(UnplacedItem::Element));
        loop {
            let before = waiting.len();
            waiting.retain(|w| match *w {
                UnplacedItem::Model(inner) => !self.place_inner(inner, &model, of_model),
                UnplacedItem::Element(node) => !self.place_frame(node, &model, of_model),
            });
            if waiting.is_empty() {
                return;
            }
            if waiting.len() == before {
                break;
            }
        }
        for w in waiting {
            let (text, node) = match w {
                UnplacedItem::Element(node) => (model.text, node),
                UnplacedItem::Model(inner) => (self.models[inner].text, self.models[inner].node),
            };
            let held = child(node, "child").and_then(|c| c.text()).unwrap_or_default().trim();
            if node.has_tag_name("joint") && self.frame(&model, held).is_none() {
                // The joint reports the error.
                continue;
            }
            let name = node.attribute("name").unwrap_or_default();
            let message = format!("the pose of `{name}` refers to a frame that does not exist, or to itself");
            let help = "use a link, joint, frame or model of the file";
            self.notes.problem_with("HP0803", xml::at(text, node), message, help);
        }
    }

    /// Places a nested model. Returns true on success.
    fn place_inner(&mut self, k: usize, outer: &Model<'d>, of_outer: Frame) -> bool {
        let inner = self.models[k].clone();
        // The pose of the including element takes precedence.
        let by_include = inner.include.and_then(|(text, i)| Some((text, child(i, "pose")?)));
        let written = by_include.or_else(|| Some((inner.text, child(inner.node, "pose")?)));
        let base = match written.and_then(|(_, p)| relative_to(p)) {
            Some(relative) => self.frame(outer, relative),
            None => Some(of_outer),
        };
        let Some(base) = base else { return false };
        let pose = base.pose.compose(written.map_or_else(home, |(text, p)| self.written_pose(text, p)));
        let by_include = inner.include.and_then(|(_, i)| child(i, "placement_frame")?.text());
        let placement_frame = by_include.or_else(|| inner.node.attribute("placement_frame")).map(str::trim);
        match placement_frame.filter(|f| !f.is_empty()) {
            None => self.place(k, pose),
            Some(frame) => {
                // The frames of the first placement are removed: a pose that is read before the frame it is relative
                // to would be relative to the old one.
                let others = self.frames.clone();
                self.place(k, home());
                let own = self.frame(&inner, frame);
                self.frames = others;
                let Some(own) = own else { return false };
                self.place(k, pose.compose(own.pose.inverse()));
            }
        }
        true
    }

    /// Places the frame of a link, joint or `frame`. Returns true on success.
    fn place_frame(&mut self, node: Node<'d, 'd>, model: &Model<'d>, of_model: Frame) -> bool {
        let (text, scope) = (model.text, &model.scope);
        let name = node.attribute("name").unwrap_or_default().trim();
        let written = child(node, "pose");
        let kind = node.tag_name().name();
        let carrier = carrier_of(node);
        // A pose relative to a named frame does not depend on the pose of the carrier.
        let base = match written.and_then(relative_to).or(carrier) {
            Some(name) => self.frame(model, name),
            None => Some(of_model),
        };
        let Some(base) = base else { return false };
        let on = match carrier {
            Some(name) => self.body_of(model, name),
            None => Some(of_model.body),
        };
        let Some(on) = on else { return false };
        let pose = base.pose.compose(written.map_or_else(home, |p| self.written_pose(text, p)));
        let full = format!("{scope}{name}");
        match kind {
            "link" => {
                let body = self.bodies.get(&full).copied().unwrap_or(GROUND);
                if body != GROUND {
                    self.m.bodies[body].pose = Some(pose);
                }
                self.frames.insert(full, Frame { body, pose });
            }
            "joint" => {
                // A joint and a link may have the same name.
                if !self.bodies.contains_key(&full) {
                    self.frames.insert(full, Frame { body: on, pose });
                }
                self.frames.insert(format!("{scope}joint {name}"), Frame { body: on, pose });
            }
            _ => {
                if self.bodies.contains_key(&full) {
                    let message = format!("a link and a frame are named `{name}`");
                    self.notes.problem_with("HP0803", xml::at(text, node), message, "rename one of them");
                }
                self.bare.insert(full.clone());
                self.frames.insert(full, Frame { body: on, pose });
            }
        }
        true
    }

    fn frame(&self, model: &Model<'_>, name: &str) -> Option<Frame> {
        of_frame(&self.frames, &model.full_name(name)).copied()
    }

    /// Reads a pose: x y z roll pitch yaw, or with a quaternion.
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
                    "give a non-zero quaternion",
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

    /// Adds joints, their relations, and shapes.
    fn connect(&mut self) {
        let models = self.models.clone();
        for model in &models {
            for link in named(model.node, "link") {
                self.add_link(link, model);
            }
            for joint in named(model.node, "joint") {
                self.joint(joint, model);
            }
            for frame in named(model.node, "frame") {
                let name = frame.attribute("name").unwrap_or_default();
                self.notes.taken("frame", name, xml::at(model.text, frame));
            }
        }
        for model in &models {
            for joint in named(model.node, "joint") {
                self.relation(joint, model);
            }
            self.constraints(model);
            self.extensions(model);
        }
        let frames: Vec<(String, Frame)> = self.frames.iter().map(|(name, f)| (name.clone(), *f)).collect();
        for (name, Frame { body, pose }) in frames {
            if name == WORLD || name.contains("joint ") || name.ends_with(OWN_MODEL) {
                continue;
            }
            let bare = self.bare.contains(&name);
            let shown = self.shown(&name).to_owned();
            self.m.frame(&shown, body, pose, bare);
        }
    }

    /// Reports unknown content of poses.
    fn poses_of(&mut self, text: usize, node: Node<'d, 'd>, owner: &str) {
        const POSE: Vocabulary = Vocabulary {
            attributes: &["relative_to", "frame", "degrees", "rotation_format"],
            read: &[],
            irrelevant: &[],
        };
        for pose in named(node, "pose") {
            xml::unknown(text, pose, owner, POSE, self.notes);
        }
    }

    /// Fixes a link of a static model, and adds the shapes of the link.
    fn add_link(&mut self, link: Node<'d, 'd>, model: &Model<'d>) {
        let name = link.attribute("name").unwrap_or_default().trim();
        let Some(Frame { body, pose }) = self.frame(model, name) else { return };
        if model.is_static {
            let why = "its model is static".to_owned();
            let joint = Joint::new(&format!("{name}_static"), why, "fixed", [GROUND, body], pose.r);
            self.m.joint(joint);
        }
        for visual in named(link, "visual") {
            let written = child(visual, "pose");
            xml::repeated(model.text, visual, name, &["pose", "geometry"], self.notes);
            let base = written.and_then(relative_to).and_then(|frame| self.frame(model, frame));
            let base = base.map_or_else(home, |frame| pose.inverse().compose(frame.pose));
            let place = base.compose(written.map_or_else(home, |p| self.written_pose(model.text, p)));
            self.shapes.push(VisibleShape { text: model.text, visual, body, link: name.to_owned(), place });
        }
    }
}

/// Returns the value of a frame by its full name; the name of a model means its frame.
fn of_frame<'a, T>(list: &'a BTreeMap<String, T>, full: &str) -> Option<&'a T> {
    list.get(full).or_else(|| list.get(&format!("{full}::{OWN_MODEL}")))
}

/// Returns the name of the frame that carries a joint or a frame; `None` if it is that of the model.
fn carrier_of<'a>(node: Node<'a, '_>) -> Option<&'a str> {
    match node.tag_name().name() {
        "joint" => Some(child(node, "child").and_then(|c| c.text()).unwrap_or_default().trim()),
        "frame" => node.attribute("attached_to").map(str::trim).filter(|a| !a.is_empty()),
        _ => None,
    }
}

/// Returns the frame that a pose is relative to, if it names one; versions before 1.7 use another attribute.
fn relative_to<'a>(pose: Node<'a, '_>) -> Option<&'a str> {
    let named = pose.attribute("relative_to").or_else(|| pose.attribute("frame")).map(str::trim);
    named.filter(|r| !r.is_empty())
}

/// Adds the shape of a `visual`.
fn add_shape(input: &mut Input<'_>, notes: &mut ImportLog, shape: VisibleShape<'_>) {
    let VisibleShape { text, visual, body, link, place } = shape;
    let at = xml::at(text, visual);
    let Some(shape) = xml::shape(text, visual, &link, notes) else {
        notes.refused("visual", &link, at, "it has no shape");
        return;
    };
    match (shape.tag_name().name(), solid_of(shape)) {
        ("mesh", _) => {
            let path = child(shape, "uri").and_then(|u| u.text()).unwrap_or_default().trim();
            let scale = diagonal(numbers(shape, "scale").unwrap_or([1.0; 3]));
            input.mesh(body, place, scale, path, &link, xml::at(text, shape), notes);
        }
        ("empty", _) => notes.ignored("visual", at),
        (_, Some(Ok(solid))) => {
            input.shapes.solid(body, place, solid);
            notes.taken("visual", &link, at);
        }
        (_, Some(Err(why))) => notes.refused("visual", &link, xml::at(text, shape), why),
        (kind, None) => {
            notes.refused("visual", &link, at, format!("shapes of type `{kind}` are not supported"));
        }
    }
}

/// Returns the first N numbers of an element of a shape.
fn numbers<const N: usize>(shape: Node<'_, '_>, key: &'static str) -> Option<[f64; N]> {
    let list = xml::numbers(child(shape, key)?.text()?)?;
    list.get(..N)?.try_into().ok()
}

/// Returns the solid of a simple shape, or an error if its size is missing; `None` for other shapes.
fn solid_of(shape: Node<'_, '_>) -> Option<Result<Solid, &'static str>> {
    let round = |of: fn(f64, f64) -> Solid| {
        Some(of(numbers::<1>(shape, "radius")?[0], numbers::<1>(shape, "length")?[0]))
    };
    let solid = match shape.tag_name().name() {
        "box" => numbers(shape, "size").map(Solid::Box),
        "cylinder" => round(Solid::Cylinder),
        "capsule" => round(Solid::Capsule),
        "sphere" => numbers::<1>(shape, "radius").map(|[r]| Solid::Ball([r; 3])),
        "ellipsoid" => numbers(shape, "radii").map(Solid::Ball),
        _ => return None,
    };
    Some(solid.ok_or("its size is not numeric"))
}
