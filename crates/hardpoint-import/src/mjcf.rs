//! Models of MuJoCo (MJCF): includes, default classes, frames, bodies with several joints, equality constraints. Parsed
//! with `roxmltree`, since `mjcf-rs` supports neither default classes nor positions in the text.

mod defaults;
mod equality;
mod masses;
mod meshes;
mod vocabulary;

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::rc::Rc;

use hardpoint::space::{Pose, Vec3};
use roxmltree::{Document, Node};

use crate::markers::{ElementSource, Marker, join};
use crate::mechanism::{Coordinate, GROUND, Joint, Mechanism};
use crate::report::{ImportLog, SourceSpan};
use crate::shapes::Solid;
use crate::turn::home;
use crate::xml::{children, exactly};
use crate::{Format, Input, robot, xml};

use masses::{MassShape, has_volume};
use meshes::{MeshAsset, MeshGeom};
use vocabulary::{BODY, FRAME, GEOM, IRRELEVANT, JOINT, SITE};

/// MJCF format.
pub const FORMAT: Format = Format {
    name: "mjcf",
    about: "MuJoCo model",
    endings: &["xml", "mjcf"],
    recognises: |text| text.contains("<mujoco") && !text.contains("<robot"),
    read,
    binary: false,
};

/// Maximum depth of nested bodies and default classes.
const DEEPEST: usize = 100;
/// Distance below which points coincide, as a fraction of the mechanism size.
const CLOSED: f64 = 1e-7;
/// Maximum number of included files.
const MOST_INCLUDED: usize = 100;
/// Maximum number of expanded includes.
const MOST_EXPANDED: usize = 20_000;

/// Element with the index of its text.
type Element<'d> = (usize, Node<'d, 'd>);

fn read(input: &mut Input<'_>, notes: &mut ImportLog) -> Option<Mechanism> {
    let texts = included(input, notes);
    let mut documents: Vec<Option<Document<'_>>> = Vec::new();
    for (number, (_, text)) in texts.iter().enumerate() {
        documents.push(xml::parse(text, number, notes));
    }
    let root = documents.first()?.as_ref()?.root_element();
    if !["mujoco", "mujocoinclude"].contains(&root.tag_name().name()) {
        let message = format!("the first element is `{}`, not `mujoco`", root.tag_name().name());
        notes.problem_with("HP0803", xml::at(0, root), message, "specify the format, like `--format sdf`");
        return None;
    }
    let paths: Vec<String> = texts.iter().map(|(path, _)| path.clone()).collect();
    let name = root.attribute("model").filter(|n| !n.is_empty()).unwrap_or(input.stem);
    let mut reader = Reader::new(Mechanism::new(name, "m", "rad"), notes, paths, &documents);
    let top = reader.contents((0, root), 0);
    reader.settings(&top, true);
    for (text, node) in &top {
        if node.has_tag_name("worldbody") {
            let world = TreePosition { body: GROUND, pose: home(), class: None, depth: 0 };
            reader.body((*text, *node), &world, "world");
        }
    }
    reader.tendons(&top);
    for (text, node) in &top {
        match node.tag_name().name() {
            "equality" => reader.equalities((*text, *node)),
            "compiler" | "option" | "default" | "asset" | "worldbody" | "tendon" => {}
            "keyframe" => reader.keys((*text, *node)),
            other => reader.section(other, (*text, *node)),
        }
    }
    reader.join_welds();
    reader.join_connections();
    reader.free_bodies();
    reader.add_masses(input);
    for (list, bare) in [(&reader.bodies, false), (&reader.sites, true)] {
        for (name, (body, pose)) in list {
            reader.m.frame(name, *body, *pose, bare);
        }
    }
    if reader.m.bodies.len() > robot::MOST_PARTS {
        let message = format!("it has more than {} bodies", robot::MOST_PARTS);
        let help = "remove repeated includes, or parts that need not move";
        reader.notes.problem_with("HP0802", None, message, help);
        return None;
    }
    let (m, shapes) = (reader.m, std::mem::take(&mut reader.shapes));
    for shape in shapes {
        add_shape(input, notes, shape);
    }
    (m.bodies.len() > 1).then_some(m)
}

/// Reads equalities of MuJoCo in a file of another format, with its bodies and joints.
pub fn extension<'d>(
    m: Mechanism,
    notes: &mut ImportLog,
    blocks: &[Node<'d, 'd>],
    text: usize,
    bodies: &BTreeMap<String, (usize, Pose)>,
    joints: &BTreeMap<String, Coordinate>,
) -> Mechanism {
    let mut reader = Reader::new(m, notes, vec![String::new(); text + 1], &[]);
    (reader.bodies, reader.joints) = (bodies.clone(), joints.clone());
    let top: Vec<Element<'d>> = blocks.iter().flat_map(|b| children(*b)).map(|n| (text, n)).collect();
    reader.settings(&top, false);
    reader.tendons(&top);
    for (text, node) in &top {
        match node.tag_name().name() {
            "equality" => reader.equalities((*text, *node)),
            "compiler" | "option" | "default" | "asset" | "tendon" => {}
            other => reader.section(other, (*text, *node)),
        }
    }
    reader.join_welds();
    reader.join_connections();
    reader.m
}

/// Returns the text itself and the included texts, by the paths from the main file's folder.
fn included(input: &Input<'_>, notes: &mut ImportLog) -> Vec<(String, String)> {
    let mut texts = vec![(String::new(), xml::lenient(input.text))];
    let mut k = 0;
    while k < texts.len() && texts.len() < MOST_INCLUDED {
        let named: Vec<String> = xml::parse_quietly(&texts[k].1).map_or(Vec::new(), |d| {
            let files =
                d.descendants().filter(|n| n.has_tag_name("include")).filter_map(|n| n.attribute("file"));
            files.map(str::to_owned).collect()
        });
        for path in named {
            let paths = paths_of(&path, &texts[k].0);
            if texts.iter().any(|(known, _)| paths.contains(known)) {
                continue;
            }
            let Some((path, bytes)) = paths.into_iter().find_map(|p| Some((p.clone(), input.file(&p)?)))
            else {
                continue;
            };
            let text = crate::decoded(&bytes);
            notes.text(&path, &text);
            texts.push((path, xml::lenient(&text)));
        }
        k += 1;
    }
    texts
}

/// Returns the possible paths of an included file: from the folder of the main file, or from that of the including
/// file.
fn paths_of(path: &str, from: &str) -> Vec<String> {
    let own = from.rsplit_once('/').map(|(folder, _)| format!("{folder}/{path}"));
    std::iter::once(path.to_owned()).chain(own).collect()
}

/// Settings of `compiler`, which affect the meaning of other elements.
struct Compiler {
    degrees: bool,
    euler: String,
    mesh_folder: String,
    auto_limits: bool,
    /// Default of `inertia` of meshes: `exact` with `exactmeshinertia` of older versions.
    mesh_inertia: &'static str,
}

impl Default for Compiler {
    fn default() -> Self {
        Self {
            degrees: true,
            euler: "xyz".into(),
            mesh_folder: String::new(),
            auto_limits: true,
            mesh_inertia: "legacy",
        }
    }
}

/// Default class: values by element and attribute.
type Class = HashMap<(String, String), String>;

/// Position in the body tree.
#[derive(Clone)]
struct TreePosition {
    body: usize,
    pose: Pose,
    class: Option<String>,
    depth: usize,
}

/// Joint of a body.
struct JointOnBody<'d> {
    element: Element<'d>,
    /// Frame of its coordinates.
    pose: Pose,
    class: Option<String>,
}

/// Constraint between two bodies: a common point (`connect`) or frame (`weld`). Its markers are those of the design
/// configuration of the source.
struct Closure {
    name: String,
    at: Option<SourceSpan>,
    ends: [Marker; 2],
}

/// Free body, which equalities may constrain.
struct FreeBody {
    name: String,
    at: Option<SourceSpan>,
    bodies: [usize; 2],
    place: Vec3,
}

/// Visible shape.
struct VisibleShape<'d> {
    element: Element<'d>,
    body: usize,
    link: String,
    /// Pose in the body frame.
    place: Pose,
    kind: String,
    size: Vec<f64>,
    /// End points of the axis, if the shape is defined by them.
    ends: Option<[f64; 6]>,
    mesh: Option<Rc<MeshAsset>>,
}

struct Reader<'d, 'n> {
    m: Mechanism,
    notes: &'n mut ImportLog,
    paths: Vec<String>,
    documents: &'d [Option<Document<'d>>],
    compiler: Compiler,
    classes: BTreeMap<String, Class>,
    meshes: BTreeMap<String, Rc<MeshAsset>>,
    bodies: BTreeMap<String, (usize, Pose)>,
    sites: BTreeMap<String, (usize, Pose)>,
    joints: BTreeMap<String, Coordinate>,
    tendons: BTreeMap<String, Vec<(Coordinate, f64)>>,
    /// Tendons between two sites.
    rods: BTreeMap<String, [String; 2]>,
    /// Values of joint coordinates in the design configuration, and without force of springs (`springref`), by joint.
    references: BTreeMap<usize, [f64; 2]>,
    connections: Vec<Closure>,
    welds: Vec<Closure>,
    free: Vec<FreeBody>,
    shapes: Vec<VisibleShape<'d>>,
    /// Names of all joints.
    names: BTreeSet<String>,
    /// Positions of the reported includes.
    reported_includes: BTreeSet<(usize, usize)>,
    /// Number of expanded includes.
    expanded: usize,
    /// Effects that flags of `option` disable.
    disabled: BTreeSet<String>,
    masses: masses::Masses,
}

impl<'d, 'n> Reader<'d, 'n> {
    fn new(
        m: Mechanism,
        notes: &'n mut ImportLog,
        paths: Vec<String>,
        documents: &'d [Option<Document<'d>>],
    ) -> Self {
        Self {
            m,
            notes,
            paths,
            documents,
            compiler: Compiler::default(),
            classes: BTreeMap::new(),
            meshes: BTreeMap::new(),
            bodies: BTreeMap::new(),
            sites: BTreeMap::new(),
            joints: BTreeMap::new(),
            tendons: BTreeMap::new(),
            rods: BTreeMap::new(),
            references: BTreeMap::new(),
            connections: Vec::new(),
            welds: Vec::new(),
            free: Vec::new(),
            shapes: Vec::new(),
            names: BTreeSet::new(),
            reported_includes: BTreeSet::new(),
            expanded: 0,
            disabled: BTreeSet::new(),
            masses: masses::Masses::default(),
        }
    }

    /// Returns the children of an element, with includes expanded.
    fn contents(&mut self, (text, node): Element<'d>, depth: usize) -> Vec<Element<'d>> {
        let mut out = Vec::new();
        for inner in children(node) {
            if !inner.has_tag_name("include") {
                out.push((text, inner));
                continue;
            }
            let file = inner.attribute("file").unwrap_or_default();
            let paths = paths_of(file, &self.paths[text]);
            let number = self.paths.iter().position(|p| paths.contains(p)).filter(|k| *k > 0);
            let root = number.and_then(|k| Some((k, self.documents[k].as_ref()?.root_element())));
            let at = xml::attribute_at(text, inner, "file").or_else(|| xml::at(text, inner));
            match root {
                Some(_) if depth > DEEPEST => {
                    let help = "remove the recursive include";
                    self.notes.problem_with("HP0805", at, "files include each other recursively", help);
                }
                Some(_) if self.expanded > MOST_EXPANDED => {}
                Some(root) => {
                    self.expanded += 1;
                    if self.expanded > MOST_EXPANDED {
                        let help = "remove repeated includes";
                        self.notes.problem_with("HP0802", at, "files are included too often", help);
                    }
                    if self.reported_includes.insert((text, inner.range().start)) {
                        self.notes.taken("include", file, at);
                    }
                    let below = self.contents(root, depth + 1);
                    out.extend(below);
                }
                None => {
                    let message = format!("the included file `{file}` cannot be read");
                    self.notes.problem_with(
                        "HP0803",
                        at,
                        message,
                        "place it next to the file that includes it",
                    );
                }
            }
        }
        out
    }

    /// Reports elements beyond the first of a kind of which an object has one, as MuJoCo does.
    fn report_repeated(&mut self, (_, owner): Element<'d>, contents: &[Element<'d>], kinds: &[&str]) {
        let mut found = BTreeSet::new();
        for (text, node) in contents.iter().filter(|(_, n)| kinds.contains(&n.tag_name().name())) {
            let kind = node.tag_name().name();
            if !found.insert(kind) {
                let message = format!("`{}` has more than one `{kind}`", owner.tag_name().name());
                let at = xml::at(*text, *node);
                self.notes.problem_with("HP0803", at, message, "remove all but one of them");
            }
        }
    }

    /// Reads the content of a body or of a frame in it; `inside` is its position in the body tree.
    fn body(&mut self, element: Element<'d>, inside: &TreePosition, name: &str) {
        if inside.depth > DEEPEST {
            self.notes.problem_with(
                "HP0805",
                xml::at(element.0, element.1),
                "bodies are nested too deep",
                "reduce the depth of the bodies",
            );
            return;
        }
        let class = inside.class.clone();
        let contents = self.contents(element, 0);
        self.report_repeated(element, &contents, &["inertial"]);
        for (text, node) in contents {
            let at = xml::at(text, node);
            self.classes_of((text, node));
            match node.tag_name().name() {
                "body" => self.inner_body((text, node), inside),
                "frame" => {
                    xml::unknown_attributes(text, node, name, FRAME, self.notes);
                    let class = node.attribute("childclass").map(str::to_owned).or_else(|| class.clone());
                    let pose = inside.pose.compose(self.pose((text, node), class.as_deref()));
                    self.body(
                        (text, node),
                        &TreePosition { pose, class, depth: inside.depth + 1, ..inside.clone() },
                        name,
                    );
                }
                "site" => {
                    xml::unknown(text, node, name, SITE, self.notes);
                    let pose = inside.pose.compose(self.site((text, node), class.as_deref()));
                    if let Some(name) = node.attribute("name") {
                        self.sites.insert(name.to_owned(), (inside.body, pose));
                    }
                    self.notes.ignored("site", at);
                }
                "geom" => self.geom((text, node), inside, name),
                "inertial" => self.inertial((text, node), inside, name),
                "joint" | "freejoint" => {}
                "camera" | "light" => self.notes.ignored(node.tag_name().name(), at),
                "composite" | "flexcomp" | "replicate" | "attach" => {
                    let why = "it generates bodies: save the model from MuJoCo, which expands it";
                    self.notes.refused(
                        node.tag_name().name(),
                        node.attribute("name").unwrap_or_default(),
                        at,
                        why,
                    );
                }
                other => {
                    let why = "unknown element of a body";
                    self.notes.not_understood(other, name, at, why);
                }
            }
        }
    }

    /// Reports a section of the model that is not read.
    fn section(&mut self, kind: &str, (text, node): Element<'d>) {
        let at = xml::at(text, node);
        if IRRELEVANT.contains(&kind) {
            self.notes.ignored(kind, at);
        } else {
            let name = node.attribute("name").unwrap_or_default();
            self.notes.not_understood(kind, name, at, "unknown section of the model");
        }
    }

    /// Reports the stored configurations of the source.
    fn keys(&mut self, list: Element<'d>) {
        for (text, key) in self.contents(list, 0) {
            let (name, at) = (key.attribute("name").unwrap_or_default(), xml::at(text, key));
            if key.has_attribute("qpos") || key.has_attribute("mpos") || key.has_attribute("mquat") {
                let why = "its configuration is not imported: the model begins in the design configuration, with joints at their reference (`qpos0`)";
                self.notes.refused("key", name, at, why);
            } else {
                self.notes.ignored("key", at);
            }
        }
    }

    fn inner_body(&mut self, element: Element<'d>, outer: &TreePosition) {
        let (text, node) = element;
        let at = xml::at(text, node);
        let class = node.attribute("childclass").map(str::to_owned).or_else(|| outer.class.clone());
        let pose = outer.pose.compose(self.pose(element, None));
        let own = node.attribute("name").unwrap_or_default();
        let name = if own.is_empty() { format!("body_{}", self.m.bodies.len()) } else { own.to_owned() };
        if self.m.bodies.len() > robot::MOST_PARTS {
            // The limit is reported after reading.
            return;
        }
        xml::unknown_attributes(text, node, &name, BODY, self.notes);
        if node.attribute("mocap") == Some("true") {
            let why = "mocap bodies are moved by a program: it is fixed in the design configuration";
            self.notes.approximated("mocap", &name, at, why);
        }
        let mut joints = Vec::new();
        self.joints_of(element, pose, class.as_deref(), 0, &mut joints);
        let note = ElementSource { kind: "body", name: &name, at }.note(self.notes);
        // Several joints of a body form a chain, with bodies without shapes between them.
        let mut carrier = outer.body;
        let mut done = Vec::new();
        for (k, joint) in joints.iter().enumerate() {
            let is_last = k + 1 == joints.len();
            let body = if is_last {
                self.m.body(&name, note.clone(), Some(pose))
            } else {
                self.m.body(&format!("{name}_{}", k + 1), format!("between two joints of {name}"), Some(pose))
            };
            done.push((joint, carrier, body));
            carrier = body;
        }
        let body = if joints.is_empty() { self.m.body(&name, note.clone(), Some(pose)) } else { carrier };
        self.notes.taken("body", &name, at);
        self.compensation(element, body, &name);
        for (joint, i, j) in done {
            self.joint(joint.element, [i, j], joint.pose, joint.class.as_deref(), &name);
        }
        if joints.is_empty() {
            self.m.joint(Joint::new(
                &format!("{name}_fixed"),
                "a body without joints is fixed to its parent".into(),
                "fixed",
                [outer.body, body],
                pose.r,
            ));
        }
        if self.bodies.insert(name.clone(), (body, pose)).is_some() && !own.is_empty() {
            self.notes.problem_with(
                "HP0803",
                at,
                format!("the body `{name}` is defined twice"),
                "rename one of them",
            );
        }
        self.body(element, &TreePosition { body, pose, class, depth: outer.depth + 1 }, &name);
    }

    /// Collects the joints of a body, including those in frames.
    fn joints_of(
        &mut self,
        element: Element<'d>,
        pose: Pose,
        class: Option<&str>,
        depth: usize,
        out: &mut Vec<JointOnBody<'d>>,
    ) {
        for (text, node) in self.contents(element, 0) {
            match node.tag_name().name() {
                "joint" | "freejoint" => {
                    out.push(JointOnBody { element: (text, node), pose, class: class.map(str::to_owned) });
                }
                "frame" if depth < DEEPEST => {
                    let inner = node.attribute("childclass").or(class);
                    let pose = pose.compose(self.pose((text, node), None));
                    self.joints_of((text, node), pose, inner, depth + 1, out);
                }
                _ => {}
            }
        }
    }

    fn joint(&mut self, element: Element<'d>, [i, j]: [usize; 2], pose: Pose, class: Option<&str>, of: &str) {
        let (text, node) = element;
        let at = xml::at(text, node);
        let kind = if node.has_tag_name("freejoint") {
            "free".to_owned()
        } else {
            self.attribute(element, "type", class).map_or("hinge".into(), |(kind, _)| kind)
        };
        let own = node.attribute("name").unwrap_or_default();
        let name = if own.is_empty() { format!("{of}_joint") } else { own.to_owned() };
        if !own.is_empty() && !self.names.insert(name.clone()) {
            let message = format!("the joint `{name}` is defined twice");
            self.notes.problem_with("HP0803", at, message, "rename one of them");
        }
        xml::unknown(text, node, &name, JOINT, self.notes);
        self.unsupported_of_joint(element, class, &name);
        let source = ElementSource { kind: "joint", name: &name, at };
        let (type_name, coordinate) = match kind.as_str() {
            "hinge" => ("revolute", Some("angle")),
            "slide" => ("translational", Some("displacement")),
            "ball" => ("spherical", None),
            "free" => {
                self.spring(element, class, source, None);
                self.free.push(FreeBody { name, at, bodies: [i, j], place: pose.r });
                return;
            }
            _ => {
                let at = xml::attribute_at(text, node, "type").or(at);
                self.notes.problem_with(
                    "HP0805",
                    at,
                    format!("`{name}` is of the unknown type `{kind}`"),
                    "use hinge, slide, ball or free",
                );
                return;
            }
        };
        let place = pose.point(self.numbers::<3>(element, "pos", class).unwrap_or_default().into());
        let axis =
            pose.rot * Vec3::from(self.numbers::<3>(element, "axis", class).unwrap_or([0.0, 0.0, 1.0]));
        let Some(marker) = Marker::along(i, place, axis) else {
            let at = xml::attribute_at(text, node, "axis").or(at);
            self.notes.problem_with("HP0804", at, "the axis has no direction", "give a non-zero vector");
            return;
        };
        let Some(number) =
            join(&mut self.m, self.notes, source, type_name, [marker, Marker { body: j, pose: marker.pose }])
        else {
            return;
        };
        let limited = self.attribute(element, "limited", class).map_or("auto".into(), |(l, _)| l);
        let is_limited = limited == "true" || (limited == "auto" && self.compiler.auto_limits);
        if is_limited && !self.is_disabled("limit") {
            // Ranges are relative to `ref`, the value in the design configuration.
            let [zero] = self.numbers::<1>(element, "ref", class).unwrap_or_default();
            let range = self.range(element, class);
            let scaled = |x: f64| if coordinate == Some("angle") { self.angle(x - zero) } else { x - zero };
            // A range from 0 to 0 is one that is not given, unless `limited` asks for it.
            let range = range.filter(|ends| *ends != [0.0; 2] || limited == "true");
            let limit = match (range, coordinate) {
                (Some(ends), Some(of)) => Some((of, ends.map(scaled))),
                // The range of a ball is that of its rotation from the design configuration, from 0 on.
                (Some([least, most]), None) if least < most => {
                    Some(("articulation", [f64::NEG_INFINITY, self.angle(most)]))
                }
                (Some(empty), None) => Some(("articulation", empty)),
                (None, _) => None,
            };
            let limit = limit.map(|(of, range)| self.m.joints[number].limit(of, range));
            if let Some(Err(why)) = limit {
                self.notes.refused("range", &name, at, why);
            }
        }
        let coordinate = coordinate.map(|name| Coordinate { joint: number, name });
        self.spring(element, class, source, coordinate);
        if let Some(coordinate) = coordinate
            && !own.is_empty()
        {
            self.joints.insert(name, coordinate);
        }
    }

    /// Adds the spring and damper of a joint.
    fn spring(
        &mut self,
        element: Element<'d>,
        class: Option<&str>,
        source: ElementSource<'_>,
        coordinate: Option<Coordinate>,
    ) {
        let mut number = |key: &str| {
            let (value, at) = self.attribute(element, key, class)?;
            let list = xml::numbers(&value);
            match list.as_deref() {
                Some([x]) => Some(*x),
                Some([_, rest @ ..]) if rest.iter().any(|x| *x != 0.0) => {
                    let why = format!("`{key}` that depends on the coordinate is not supported");
                    self.notes.refused(key, source.name, at, why);
                    None
                }
                Some([x, ..]) => Some(*x),
                _ => {
                    let help = "write it with a decimal point";
                    let message = format!("`{key}` must be a number, not `{}`", value.trim());
                    self.notes.problem_with("HP0804", at, message, help);
                    None
                }
            }
        };
        let [stiffness, damping, springref, zero, friction] =
            ["stiffness", "damping", "springref", "ref", "frictionloss"]
                .map(|key| number(key).unwrap_or(0.0));
        let enabled = |x: f64, effect: &str| if self.is_disabled(effect) { 0.0 } else { x };
        let [stiffness, damping, friction] =
            [(stiffness, "spring"), (damping, "damper"), (friction, "frictionloss")]
                .map(|(x, effect)| enabled(x, effect));
        let turns = coordinate.is_some_and(|c| c.name == "angle");
        // Coordinates are relative to the design configuration, where the value is `ref`.
        let free = if turns { self.angle(springref - zero) } else { springref - zero };
        let zero = if turns { self.angle(zero) } else { zero };
        if let Some(coordinate) = coordinate {
            self.references.insert(coordinate.joint, [zero, zero + free]);
        }
        let source = ElementSource { kind: "spring", ..source };
        robot::joint_spring(&mut self.m, self.notes, source, coordinate, [stiffness, damping, free]);
        robot::friction(self.notes, source.name, source.at, friction);
    }

    /// Returns the range of a joint, if it is bounded.
    fn range(&mut self, element: Element<'d>, class: Option<&str>) -> Option<[f64; 2]> {
        let (value, at) = self.attribute(element, "range", class)?;
        let words: Vec<&str> = value.split_whitespace().collect();
        let [low, high] = words[..] else { return exactly::<2>(&value, "`range`", at, self.notes) };
        let [low, high] = [low, high].map(|word| xml::bound(word, "`range`", at, self.notes));
        xml::range(low?, high?)
    }

    fn geom(&mut self, element: Element<'d>, inside: &TreePosition, link: &str) {
        let class = inside.class.clone();
        let class = class.as_deref();
        let at = xml::at(element.0, element.1);
        xml::unknown(element.0, element.1, link, GEOM, self.notes);
        let kind = self.attribute(element, "type", class).map_or("sphere".into(), |(kind, _)| kind);
        let mesh = self.attribute(element, "mesh", class).map(|(mesh, _)| mesh);
        let kind =
            if mesh.is_some() && element.1.attribute("type").is_none() { "mesh".to_owned() } else { kind };
        let size =
            self.attribute(element, "size", class).and_then(|(s, _)| xml::numbers(&s)).unwrap_or_default();
        let ends = self.numbers::<6>(element, "fromto", class);
        let is_fitted = mesh.is_some() && kind != "mesh";
        if is_fitted {
            self.notes.refused(
                "geom",
                link,
                at,
                format!("shapes of type `{kind}` fitted to a mesh are not supported"),
            );
        }
        if inside.body != GROUND && has_volume(&kind) {
            let own = if ends.is_some() { home() } else { self.pose(element, class) };
            let shape = match solid_of(&kind, &size, ends, own).filter(|_| !is_fitted) {
                Some((solid, place)) => MassShape::Solid(solid, place),
                None => MassShape::Mesh(self.mesh_of_mass(mesh.as_deref(), is_fitted), own),
            };
            self.add_geom_mass(element, inside, shape);
        }
        if is_fitted {
            return;
        }
        // Shapes for contact only duplicate the visible ones.
        let group = self
            .attribute(element, "group", class)
            .and_then(|(g, _)| g.trim().parse::<i32>().ok())
            .unwrap_or(0);
        if inside.body == GROUND || group > 2 {
            self.notes.ignored("geom", at);
            return;
        }
        let owner = self.m.bodies[inside.body].pose.unwrap_or_else(home);
        let place = owner.inverse().compose(inside.pose.compose(self.pose(element, class)));
        let mesh = mesh.and_then(|name| {
            let found = self.meshes.get(&name).cloned();
            if found.is_none() {
                self.notes.refused("geom", link, at, format!("the mesh `{name}` does not exist"));
            }
            found
        });
        let place = if ends.is_some() { owner.inverse().compose(inside.pose) } else { place };
        self.shapes.push(VisibleShape {
            element,
            body: inside.body,
            link: link.to_owned(),
            place,
            kind,
            size,
            ends,
            mesh,
        });
    }
}

impl Reader<'_, '_> {
    /// Returns the mesh whose mass a geom has.
    ///
    /// # Errors
    /// Returns the reason why there is none.
    fn mesh_of_mass(&self, name: Option<&str>, is_fitted: bool) -> Result<Rc<MeshAsset>, String> {
        if is_fitted {
            return Err("its shape is fitted to a mesh".into());
        }
        let name = name.ok_or("it has no mesh")?;
        self.meshes.get(name).cloned().ok_or_else(|| format!("the mesh `{name}` does not exist"))
    }
}

/// Adds the shape of a geom.
fn add_shape(input: &mut Input<'_>, notes: &mut ImportLog, shape: VisibleShape<'_>) {
    let (text, node) = shape.element;
    let at = xml::at(text, node);
    match (shape.kind.as_str(), &shape.mesh) {
        ("mesh", Some(mesh)) => {
            let VisibleShape { body, place, ref link, .. } = shape;
            mesh.add(input, notes, MeshGeom { body, place, link, at });
        }
        ("mesh", None) => {}
        (kind, _) => match solid_of(kind, &shape.size, shape.ends, shape.place) {
            Some((solid, place)) => {
                input.shapes.solid(shape.body, place, solid);
                notes.taken("geom", &shape.link, at);
            }
            None => {
                notes.refused("geom", &shape.link, at, format!("shapes of type `{kind}` are not supported"))
            }
        },
    }
}

/// Returns the solid of a geom and its pose, from its size or its two ends.
fn solid_of(kind: &str, size: &[f64], ends: Option<[f64; 6]>, mut place: Pose) -> Option<(Solid, Pose)> {
    let by_ends = ends.is_some();
    let size = |k: usize| size.get(k).copied().unwrap_or(0.0);
    let mut half = size(1);
    if let Some(ends) = ends {
        let (from, to) = ([ends[0], ends[1], ends[2]], [ends[3], ends[4], ends[5]]);
        half = (Vec3::from(to) - Vec3::from(from)).norm() / 2.0;
        if let Some(between) = defaults::between_ends(ends) {
            place = place.compose(between);
        }
    }
    let solid = match kind {
        // A box or ellipsoid with two ends has their distance as its length, and the first size across it.
        "box" if by_ends => Solid::Box([size(0), size(0), half].map(|x| 2.0 * x)),
        "ellipsoid" if by_ends => Solid::Ball([size(0), size(0), half]),
        "box" => Solid::Box([2.0 * size(0), 2.0 * size(1), 2.0 * size(2)]),
        "cylinder" => Solid::Cylinder(size(0), 2.0 * half),
        "capsule" => Solid::Capsule(size(0), 2.0 * half),
        "sphere" => Solid::Ball([size(0); 3]),
        "ellipsoid" => Solid::Ball([size(0), size(1), size(2)]),
        _ => return None,
    };
    Some((solid, place))
}
