//! Models of MuJoCo (MJCF): includes, default classes, frames, bodies with several joints, equality constraints. Read with `roxmltree`:
//! `mjcf-rs` knows neither classes of defaults nor places in the text.

use std::collections::{BTreeMap, HashMap};

use hardpoint::space::{Mat3, Pose, Quat, Vec3};
use roxmltree::{Document, Node};

use crate::markers::{Called, Marker, join};
use crate::mechanism::{Coordinate, Drives, GROUND, Joint, Law, Mechanism};
use crate::report::{At, Notes};
use crate::shapes::Solid;
use crate::turn::{from_z_and_x, home, none, sequence};
use crate::xml::{children, exactly};
use crate::{Format, Input, xml};

/// See the module.
pub const FORMAT: Format = Format {
    name: "mjcf",
    about: "MuJoCo model",
    endings: &["xml", "mjcf"],
    looks: |text| text.contains("<mujoco") && !text.contains("<robot"),
    read,
    binary: false,
};

/// Bodies, and classes of defaults, are nested so deep at most.
const DEEPEST: usize = 100;
/// So many files are included at most.
const MOST_INCLUDED: usize = 100;

/// An element, and the number of the text that it is in.
type Element<'d> = (usize, Node<'d, 'd>);

fn read(input: &mut Input<'_>, notes: &mut Notes) -> Option<Mechanism> {
    let texts = included(input, notes);
    let mut documents: Vec<Option<Document<'_>>> = Vec::new();
    for (number, (_, text)) in texts.iter().enumerate() {
        documents.push(xml::parse(text, number, notes));
    }
    let root = documents.first()?.as_ref()?.root_element();
    if !["mujoco", "mujocoinclude"].contains(&root.tag_name().name()) {
        let message = format!("the first element is `{}`, not `mujoco`", root.tag_name().name());
        notes.problem_with("HP0803", xml::at(0, root), message, "name the format, like `--format sdf`");
        return None;
    }
    let paths: Vec<String> = texts.iter().map(|(path, _)| path.clone()).collect();
    let name = root.attribute("model").filter(|n| !n.is_empty()).unwrap_or(input.stem);
    let mut reader = Reader {
        m: Mechanism::new(name, "m", "rad"),
        notes,
        paths,
        documents: &documents,
        compiler: Compiler::default(),
        classes: BTreeMap::new(),
        meshes: BTreeMap::new(),
        bodies: BTreeMap::new(),
        sites: BTreeMap::new(),
        joints: BTreeMap::new(),
        tendons: BTreeMap::new(),
        shapes: Vec::new(),
    };
    let top = reader.contents((0, root), 0);
    reader.settings(&top);
    for (text, node) in &top {
        if node.has_tag_name("worldbody") {
            let world = Inside { body: GROUND, pose: home(), class: None, depth: 0 };
            reader.body((*text, *node), &world, "world");
        }
    }
    for (text, node) in &top {
        match node.tag_name().name() {
            "equality" => reader.equalities((*text, *node)),
            "compiler" | "default" | "asset" | "worldbody" | "tendon" => {}
            other => reader.notes.ignored(other, xml::at(*text, *node)),
        }
    }
    let (m, shapes) = (reader.m, std::mem::take(&mut reader.shapes));
    for shape in shapes {
        shown(input, notes, shape);
    }
    (m.bodies.len() > 1).then_some(m)
}

/// The text itself and those that it includes, by the paths that name them.
fn included(input: &Input<'_>, notes: &mut Notes) -> Vec<(String, String)> {
    let mut texts = vec![(String::new(), input.text.to_owned())];
    let mut k = 0;
    while k < texts.len() && texts.len() < MOST_INCLUDED {
        let paths: Vec<String> = Document::parse(&texts[k].1).map_or(Vec::new(), |d| {
            let files =
                d.descendants().filter(|n| n.has_tag_name("include")).filter_map(|n| n.attribute("file"));
            files.map(str::to_owned).collect()
        });
        for path in paths {
            if texts.iter().any(|(known, _)| *known == path) {
                continue;
            }
            if let Some(text) = input.file(&path).and_then(|b| String::from_utf8(b).ok()) {
                notes.text(&path, &text);
                texts.push((path, text));
            }
        }
        k += 1;
    }
    texts
}

/// What `compiler` says of how the rest is meant.
struct Compiler {
    degrees: bool,
    euler: String,
    mesh_folder: String,
    auto_limits: bool,
}

impl Default for Compiler {
    fn default() -> Self {
        Self { degrees: true, euler: "xyz".into(), mesh_folder: String::new(), auto_limits: true }
    }
}

/// Attributes by element, as a class of defaults gives them.
type Class = HashMap<(String, String), String>;

/// Where in the tree of bodies.
#[derive(Clone)]
struct Inside {
    body: usize,
    pose: Pose,
    class: Option<String>,
    depth: usize,
}

/// A shape to be shown.
struct Shown<'d> {
    element: Element<'d>,
    body: usize,
    link: String,
    /// In the body.
    place: Pose,
    kind: String,
    size: Vec<f64>,
    /// The two ends, where it is given by them.
    ends: Option<[f64; 6]>,
    mesh: Option<(String, [f64; 3])>,
}

struct Reader<'d, 'n> {
    m: Mechanism,
    notes: &'n mut Notes,
    paths: Vec<String>,
    documents: &'d [Option<Document<'d>>],
    compiler: Compiler,
    classes: BTreeMap<String, Class>,
    /// Their files and scales.
    meshes: BTreeMap<String, (String, [f64; 3])>,
    bodies: BTreeMap<String, (usize, Pose)>,
    sites: BTreeMap<String, (usize, Pose)>,
    joints: BTreeMap<String, Coordinate>,
    tendons: BTreeMap<String, Vec<(Coordinate, f64)>>,
    shapes: Vec<Shown<'d>>,
}

impl<'d> Reader<'d, '_> {
    /// The children of an element, with what `include` puts in its place.
    fn contents(&mut self, (text, node): Element<'d>, depth: usize) -> Vec<Element<'d>> {
        let mut out = Vec::new();
        for inner in children(node) {
            if !inner.has_tag_name("include") {
                out.push((text, inner));
                continue;
            }
            let file = inner.attribute("file").unwrap_or_default();
            let number = self.paths.iter().position(|p| p == file).filter(|k| *k > 0);
            let root = number.and_then(|k| Some((k, self.documents[k].as_ref()?.root_element())));
            let at = xml::attribute_at(text, inner, "file").or_else(|| xml::at(text, inner));
            match root {
                Some(_) if depth > DEEPEST => {
                    let help = "look for a file that includes itself";
                    self.notes.problem_with("HP0805", at, "files include each other in a circle", help);
                }
                Some(root) => {
                    self.notes.taken("include", file, at);
                    let below = self.contents(root, depth + 1);
                    out.extend(below);
                }
                None => {
                    let message = format!("the included file `{file}` cannot be read");
                    self.notes.problem_with("HP0803", at, message, "put it beside the file that includes it");
                }
            }
        }
        out
    }

    fn settings(&mut self, top: &[Element<'d>]) {
        for (text, node) in top.iter().filter(|(_, n)| n.has_tag_name("compiler")) {
            if let Some(angle) = node.attribute("angle") {
                self.compiler.degrees = angle != "radian";
            }
            if let Some(sequence) = node.attribute("eulerseq") {
                let fits = sequence.len() == 3 && sequence.chars().all(|c| "xyzXYZ".contains(c));
                if fits {
                    self.compiler.euler = sequence.to_owned();
                } else {
                    let at = xml::attribute_at(*text, *node, "eulerseq");
                    self.notes.problem_with(
                        "HP0804",
                        at,
                        format!("`{sequence}` is no sequence of axes"),
                        "three of x, y, z, X, Y, Z",
                    );
                }
            }
            if let Some(folder) = node.attribute("meshdir").or_else(|| node.attribute("assetdir")) {
                self.compiler.mesh_folder = format!("{}/", folder.trim_end_matches('/'));
            }
            if let Some(auto) = node.attribute("autolimits") {
                self.compiler.auto_limits = auto == "true";
            }
            if node.attribute("coordinate") == Some("global") {
                let at = xml::attribute_at(*text, *node, "coordinate");
                self.notes.problem_with(
                    "HP0805",
                    at,
                    "global coordinates are no part of MJCF any more",
                    "save the model with MuJoCo 2.3.2 in local ones",
                );
            }
            self.notes.taken("compiler", "", xml::at(*text, *node));
        }
        for element in top.iter().filter(|(_, n)| n.has_tag_name("default")) {
            self.class(*element, None, 0);
        }
        for (text, asset) in top.iter().filter(|(_, n)| n.has_tag_name("asset")) {
            for (text, node) in self.contents((*text, *asset), 0) {
                if !node.has_tag_name("mesh") {
                    self.notes.ignored(node.tag_name().name(), xml::at(text, node));
                    continue;
                }
                let class = node.attribute("class").map(str::to_owned);
                let scale = self.numbers::<3>((text, node), "scale", class.as_deref()).unwrap_or([1.0; 3]);
                let file = node.attribute("file").unwrap_or_default();
                let stem =
                    file.rsplit('/').next().and_then(|f| f.rsplit_once('.')).map_or(file, |(stem, _)| stem);
                let name = node.attribute("name").unwrap_or(stem).to_owned();
                let path = format!("{}{file}", self.compiler.mesh_folder);
                self.meshes.insert(name, (path, scale));
            }
        }
    }

    /// A class of defaults and those in it.
    fn class(&mut self, (text, node): Element<'d>, outer: Option<&str>, depth: usize) {
        if depth > DEEPEST {
            return;
        }
        let name = node.attribute("class").unwrap_or(if outer.is_none() { "main" } else { "" });
        let mut class = match outer {
            Some(outer) => self.classes.get(outer).cloned().unwrap_or_default(),
            None => self.classes.get("main").cloned().unwrap_or_default(),
        };
        let inner = self.contents((text, node), 0);
        for (_, element) in inner.iter().filter(|(_, n)| !n.has_tag_name("default")) {
            for a in element.attributes() {
                class.insert(
                    (element.tag_name().name().to_owned(), a.name().to_owned()),
                    a.value().to_owned(),
                );
            }
        }
        self.classes.insert(name.to_owned(), class);
        self.notes.taken("default", name, xml::at(text, node));
        for element in inner.iter().filter(|(_, n)| n.has_tag_name("default")) {
            self.class(*element, Some(name), depth + 1);
        }
    }

    /// An attribute of an element, or what its class gives it, and where that is written.
    fn attribute(
        &self,
        (text, node): Element<'d>,
        key: &str,
        class: Option<&str>,
    ) -> Option<(String, Option<At>)> {
        if let Some(value) = node.attribute(key) {
            return Some((value.to_owned(), xml::attribute_at(text, node, key)));
        }
        let class = node.attribute("class").or(class).unwrap_or("main");
        let defaults = self.classes.get(class)?;
        let value = defaults.get(&(node.tag_name().name().to_owned(), key.to_owned()))?;
        Some((value.clone(), xml::at(text, node)))
    }

    fn numbers<const N: usize>(
        &mut self,
        element: Element<'d>,
        key: &str,
        class: Option<&str>,
    ) -> Option<[f64; N]> {
        let (value, at) = self.attribute(element, key, class)?;
        exactly::<N>(&value, &format!("`{key}`"), at, self.notes)
    }

    fn angle(&self, x: f64) -> f64 {
        if self.compiler.degrees { x.to_radians() } else { x }
    }

    /// The orientation of an element by any of the ways to write it.
    fn orientation(&mut self, element: Element<'d>, class: Option<&str>) -> Mat3 {
        let (text, node) = element;
        let fault = |reader: &mut Self, key| {
            let at = xml::attribute_at(text, node, key);
            reader.notes.problem_with(
                "HP0804",
                at,
                format!("`{key}` gives no orientation"),
                "give vectors that are neither null nor parallel",
            );
            none()
        };
        if let Some(q) = self.numbers::<4>(element, "quat", class) {
            return Quat::from_array(q).map_or_else(|| fault(self, "quat"), |q| q.rotation());
        }
        if let Some([x, y, z, angle]) = self.numbers::<4>(element, "axisangle", class) {
            let angle = self.angle(angle);
            return Vec3::from([x, y, z])
                .unit()
                .map_or_else(|| fault(self, "axisangle"), |axis| Mat3::about(axis, angle));
        }
        if let Some(angles) = self.numbers::<3>(element, "euler", class) {
            return sequence(&self.compiler.euler.clone(), angles.map(|a| self.angle(a)));
        }
        if let Some([a, b, c, d, e, f]) = self.numbers::<6>(element, "xyaxes", class) {
            let (x, y) = (Vec3::from([a, b, c]), Vec3::from([d, e, f]));
            return from_z_and_x(x.cross(y), x).unwrap_or_else(|| fault(self, "xyaxes"));
        }
        if let Some(z) = self.numbers::<3>(element, "zaxis", class) {
            // The least turn that brings z there.
            let up = Vec3::from([0.0, 0.0, 1.0]);
            return match Vec3::from(z).unit() {
                Some(z) if (z + up).norm() < 1e-12 => {
                    Mat3::about([1.0, 0.0, 0.0].into(), std::f64::consts::PI)
                }
                Some(z) => Mat3::between(up, z),
                None => fault(self, "zaxis"),
            };
        }
        none()
    }

    fn pose(&mut self, element: Element<'d>, class: Option<&str>) -> Pose {
        let r = self.numbers::<3>(element, "pos", class).unwrap_or_default();
        Pose { rot: self.orientation(element, class), r: r.into() }
    }

    /// What is in a body, or in a frame in it: `inside` says where its coordinates count from.
    fn body(&mut self, element: Element<'d>, inside: &Inside, name: &str) {
        if inside.depth > DEEPEST {
            self.notes.problem_with(
                "HP0805",
                xml::at(element.0, element.1),
                "bodies are nested too deep",
                "bodies that deep belong to no mechanism",
            );
            return;
        }
        let class = inside.class.clone();
        for (text, node) in self.contents(element, 0) {
            let at = xml::at(text, node);
            match node.tag_name().name() {
                "body" => self.inner_body((text, node), inside),
                "frame" => {
                    let class = node.attribute("childclass").map(str::to_owned).or_else(|| class.clone());
                    let pose = inside.pose.compose(self.pose((text, node), class.as_deref()));
                    self.body(
                        (text, node),
                        &Inside { pose, class, depth: inside.depth + 1, ..inside.clone() },
                        name,
                    );
                }
                "site" => {
                    let pose = inside.pose.compose(self.pose((text, node), class.as_deref()));
                    if let Some(name) = node.attribute("name") {
                        self.sites.insert(name.to_owned(), (inside.body, pose));
                    }
                    self.notes.ignored("site", at);
                }
                "geom" => self.geom((text, node), inside, name),
                "joint" | "freejoint" => {}
                "composite" | "flexcomp" | "replicate" | "attach" => {
                    let why = "it makes bodies by rules: save the model from MuJoCo, which writes them out";
                    self.notes.refused(
                        node.tag_name().name(),
                        node.attribute("name").unwrap_or_default(),
                        at,
                        why,
                    );
                }
                other => self.notes.ignored(other, at),
            }
        }
    }

    fn inner_body(&mut self, element: Element<'d>, outer: &Inside) {
        let (text, node) = element;
        let at = xml::at(text, node);
        let class = node.attribute("childclass").map(str::to_owned).or_else(|| outer.class.clone());
        let pose = outer.pose.compose(self.pose(element, None));
        let own = node.attribute("name").unwrap_or_default();
        let name = if own.is_empty() { format!("body_{}", self.m.bodies.len()) } else { own.to_owned() };
        let contents = self.contents(element, 0);
        let joints: Vec<Element<'d>> = joints_of(&contents);
        let note = Called { kind: "body", name: &name, at }.note(self.notes);
        // Several joints of a body follow each other: bodies without a shape are between them.
        let mut carrier = outer.body;
        let mut done = Vec::new();
        for (k, joint) in joints.iter().enumerate() {
            let is_last = k + 1 == joints.len();
            let body = if is_last {
                self.m.body(&name, note.clone(), Some(pose))
            } else {
                self.m.body(&format!("{name}_{}", k + 1), format!("between two joints of {name}"), Some(pose))
            };
            done.push((*joint, carrier, body));
            carrier = body;
        }
        let body = if joints.is_empty() { self.m.body(&name, note.clone(), Some(pose)) } else { carrier };
        self.notes.taken("body", &name, at);
        for (joint, i, j) in done {
            self.joint(joint, [i, j], pose, class.as_deref(), &name);
        }
        if joints.is_empty() {
            self.m.joint(Joint::new(
                &format!("{name}_fixed"),
                "a body without joints stands on the one that it is in".into(),
                "fixed",
                [outer.body, body],
                pose.r,
            ));
        }
        if self.bodies.insert(name.clone(), (body, pose)).is_some() && !own.is_empty() {
            self.notes.problem_with(
                "HP0803",
                at,
                format!("there are two bodies `{name}`"),
                "rename one of them",
            );
        }
        self.body(element, &Inside { body, pose, class, depth: outer.depth + 1 }, &name);
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
        let called = Called { kind: "joint", name: &name, at };
        let (type_name, coordinate) = match kind.as_str() {
            "hinge" => ("revolute", Some("angle")),
            "slide" => ("translational", Some("displacement")),
            "ball" => ("spherical", None),
            "free" => {
                let why = "nothing holds its six freedoms in the source: it is fixed as drawn";
                self.notes.approximated("joint", &name, at, why);
                self.m.joint(Joint::new(&name, called.note(self.notes), "fixed", [i, j], pose.r));
                return;
            }
            _ => {
                let at = xml::attribute_at(text, node, "type").or(at);
                self.notes.problem_with(
                    "HP0805",
                    at,
                    format!("`{name}` is of the unknown type `{kind}`"),
                    "MJCF knows hinge, slide, ball and free",
                );
                return;
            }
        };
        let place = pose.point(self.numbers::<3>(element, "pos", class).unwrap_or_default().into());
        let axis =
            pose.rot * Vec3::from(self.numbers::<3>(element, "axis", class).unwrap_or([0.0, 0.0, 1.0]));
        let Some(marker) = Marker::along(i, place, axis) else {
            let at = xml::attribute_at(text, node, "axis").or(at);
            self.notes.problem_with(
                "HP0804",
                at,
                "the axis has no direction",
                "give a vector other than zero",
            );
            return;
        };
        let Some(number) =
            join(&mut self.m, self.notes, called, type_name, [marker, Marker { body: j, pose: marker.pose }])
        else {
            return;
        };
        let limited = self.attribute(element, "limited", class).map_or("auto".into(), |(l, _)| l);
        if let Some([low, high]) = self.numbers::<2>(element, "range", class)
            && (limited == "true" || (limited == "auto" && self.compiler.auto_limits))
            && low < high
        {
            // Ranges count from `ref`, which is the value as drawn.
            let [zero] = self.numbers::<1>(element, "ref", class).unwrap_or_default();
            let scaled = |x: f64| if coordinate == Some("angle") { self.angle(x - zero) } else { x - zero };
            self.m.joints[number].limits = Some([scaled(low), scaled(high)]);
        }
        if let Some(coordinate) = coordinate {
            self.joints.insert(name, Coordinate { joint: number, name: coordinate });
        }
    }

    fn geom(&mut self, element: Element<'d>, inside: &Inside, link: &str) {
        let class = inside.class.clone();
        let class = class.as_deref();
        let at = xml::at(element.0, element.1);
        let kind = self.attribute(element, "type", class).map_or("sphere".into(), |(kind, _)| kind);
        let mesh = self.attribute(element, "mesh", class).map(|(mesh, _)| mesh);
        let kind =
            if mesh.is_some() && element.1.attribute("type").is_none() { "mesh".to_owned() } else { kind };
        // Shapes for contact alone stand where the visible ones do.
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
        let size =
            self.attribute(element, "size", class).and_then(|(s, _)| xml::numbers(&s)).unwrap_or_default();
        let ends = self.numbers::<6>(element, "fromto", class);
        let mesh = mesh.and_then(|name| {
            let found = self.meshes.get(&name).cloned();
            if found.is_none() {
                self.notes.refused("geom", link, at, format!("there is no mesh `{name}`"));
            }
            found
        });
        let place = if ends.is_some() { owner.inverse().compose(inside.pose) } else { place };
        self.shapes.push(Shown {
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

    fn end(&mut self, element: Element<'d>, key: &str) -> Option<(usize, Pose)> {
        let (text, node) = element;
        let name = node.attribute(key);
        let found = match name {
            None | Some("world") => Some((GROUND, home())),
            Some(name) => self.bodies.get(name).copied(),
        };
        if found.is_none() {
            let name = name.unwrap_or_default();
            let known = self.bodies.keys().map(String::as_str);
            let near = hardpoint::draft::did_you_mean(name, known);
            let help = near.map_or("name a body of the model".into(), |n| format!("did you mean `{n}`?"));
            let at = xml::attribute_at(text, node, key);
            self.notes.problem_with("HP0803", at, format!("there is no body `{name}`"), &help);
        }
        found
    }

    fn coordinate(&mut self, element: Element<'d>, key: &str) -> Option<Coordinate> {
        let (text, node) = element;
        let name = node.attribute(key)?;
        let found = self.joints.get(name).copied();
        if found.is_none() {
            let known = self.joints.keys().map(String::as_str);
            let near = hardpoint::draft::did_you_mean(name, known);
            let help =
                near.map_or("name a hinge or slide of the model".into(), |n| format!("did you mean `{n}`?"));
            let at = xml::attribute_at(text, node, key);
            self.notes.problem_with(
                "HP0803",
                at,
                format!("there is no joint `{name}` with one coordinate"),
                &help,
            );
        }
        found
    }

    fn equalities(&mut self, list: Element<'d>) {
        self.tendons();
        for (k, element) in self.contents(list, 0).into_iter().enumerate() {
            let (text, node) = element;
            let kind = node.tag_name().name();
            let at = xml::at(text, node);
            let name = node.attribute("name").map_or_else(|| format!("{kind}_{}", k + 1), str::to_owned);
            if self.attribute(element, "active", None).is_some_and(|(a, _)| a == "false") {
                self.notes.refused(kind, &name, at, "it is not active");
                continue;
            }
            match kind {
                "connect" | "weld" => self.closure(element, kind, &name),
                "joint" | "tendon" => self.relation(element, kind, &name),
                other => self.notes.refused(other, &name, at, "a constraint of this kind has no equivalent"),
            }
        }
    }

    /// Two bodies that meet: at a point, or altogether.
    fn closure(&mut self, element: Element<'d>, kind: &str, name: &str) {
        let (text, node) = element;
        let at = xml::at(text, node);
        let called = Called { kind, name, at };
        let sites = ["site1", "site2"].map(|key| node.attribute(key));
        let ends = if let [Some(a), Some(b)] = sites {
            let found = [a, b].map(|s| self.sites.get(s).copied());
            for (site, end) in [a, b].iter().zip(&found) {
                if end.is_none() {
                    self.notes.problem_with(
                        "HP0803",
                        at,
                        format!("there is no site `{site}`"),
                        "name a site of the model",
                    );
                }
            }
            found
        } else {
            let [first, second] = ["body1", "body2"].map(|key| self.end(element, key));
            let anchor = self.numbers::<3>(element, "anchor", None).unwrap_or_default();
            let place = |(_, pose): (usize, Pose)| pose.point(anchor.into());
            // The anchor of a weld is of the second body.
            let place = if kind == "weld" { second.map(place) } else { first.map(place) };
            let put = |end: Option<(usize, Pose)>| Some((end?.0, Pose { rot: none(), r: place? }));
            [put(first), put(second)]
        };
        let [Some(i), Some(j)] = ends else { return };
        let type_name = if kind == "weld" { "fixed" } else { "spherical" };
        let [i, j] = [i, j].map(|(body, pose)| Marker { body, pose });
        if kind == "weld" && self.numbers::<7>(element, "relpose", None).is_some_and(|r| r[3..] != [0.0; 4]) {
            self.notes.approximated(
                kind,
                name,
                at,
                "its `relpose` is left out: the bodies are welded as they are drawn",
            );
        }
        join(&mut self.m, self.notes, called, type_name, [i, j]);
    }

    /// A polynomial between two joints, or two tendons that are sums of joints.
    fn relation(&mut self, element: Element<'d>, kind: &str, name: &str) {
        let (text, node) = element;
        let at = xml::at(text, node);
        let [first, second] = if kind == "joint" {
            ["joint1", "joint2"].map(|key| self.coordinate(element, key).map(|c| vec![(c, 1.0)]))
        } else {
            ["tendon1", "tendon2"].map(|key| node.attribute(key).and_then(|t| self.tendons.get(t).cloned()))
        };
        let has_second = node.attribute(if kind == "joint" { "joint2" } else { "tendon2" }).is_some();
        let Some(first) = first else {
            if kind == "tendon" {
                self.notes.refused(kind, name, at, "only fixed tendons, sums of joints, have an equivalent");
            }
            return;
        };
        if has_second && second.is_none() {
            return;
        }
        let coefficients = self.attribute(element, "polycoef", None).and_then(|(p, _)| xml::numbers(&p));
        let mut a = coefficients.unwrap_or_else(|| vec![0.0, 1.0]);
        a.resize(5, 0.0);
        if has_second && a[2..].iter().any(|x| *x != 0.0) {
            self.notes.refused(kind, name, at, "a relation that is not linear has no equivalent");
            return;
        }
        let called = Called { kind, name, at };
        let note = called.note(self.notes);
        let mut terms = first;
        if let Some(second) = second {
            terms.extend(second.iter().map(|(c, k)| (*c, -a[1] * k)));
        }
        match terms[..] {
            [(only, _)] => {
                self.m.driver(name, note, Drives::Coordinate(only), Law::Held);
            }
            _ => self.m.coupler(name, note, terms),
        }
        match a[0] {
            0.0 => self.notes.taken(kind, name, at),
            _ => self.notes.approximated(
                kind,
                name,
                at,
                "its constant is left out: the relation counts from the drawing",
            ),
        }
    }

    /// Fixed tendons: sums of joints.
    fn tendons(&mut self) {
        let Some(root) = self.documents.first().and_then(|d| d.as_ref()).map(Document::root_element) else {
            return;
        };
        let lists: Vec<Element<'d>> =
            self.contents((0, root), 0).into_iter().filter(|(_, n)| n.has_tag_name("tendon")).collect();
        for list in lists {
            for element in self.contents(list, 0) {
                let (text, node) = element;
                let name = node.attribute("name").unwrap_or_default();
                if !node.has_tag_name("fixed") {
                    self.notes.ignored(node.tag_name().name(), xml::at(text, node));
                    continue;
                }
                let mut terms = Vec::new();
                for inner in self.contents(element, 0) {
                    let factor = self.numbers::<1>(inner, "coef", None).map_or(1.0, |[c]| c);
                    if let Some(c) = self.coordinate(inner, "joint") {
                        terms.push((c, factor));
                    }
                }
                self.tendons.insert(name.to_owned(), terms);
                self.notes.taken("tendon", name, xml::at(text, node));
            }
        }
    }
}

/// The joints of a body.
fn joints_of<'d>(contents: &[Element<'d>]) -> Vec<Element<'d>> {
    contents.iter().copied().filter(|(_, n)| n.has_tag_name("joint") || n.has_tag_name("freejoint")).collect()
}

/// Shows a geom.
fn shown(input: &mut Input<'_>, notes: &mut Notes, shape: Shown<'_>) {
    let (text, node) = shape.element;
    let at = xml::at(text, node);
    let size = |k: usize| shape.size.get(k).copied().unwrap_or(0.0);
    let mut place = shape.place;
    let mut half = size(1);
    if let Some([a, b, c, d, e, f]) = shape.ends {
        let (from, to) = (Vec3::from([a, b, c]), Vec3::from([d, e, f]));
        let axis = to - from;
        half = axis.norm() / 2.0;
        if let Some(rot) = from_z_and_x(axis, axis.any_square()) {
            place = place.compose(Pose { rot, r: (from + to) * 0.5 });
        }
    }
    let solid = match (shape.kind.as_str(), &shape.mesh) {
        ("mesh", Some((path, scale))) => {
            input.mesh(shape.body, place, *scale, path, &shape.link, at, notes);
            return;
        }
        ("mesh", None) => return,
        ("box", _) => Solid::Box([2.0 * size(0), 2.0 * size(1), 2.0 * size(2)]),
        ("cylinder", _) => Solid::Cylinder(size(0), 2.0 * half),
        ("capsule", _) => Solid::Capsule(size(0), 2.0 * half),
        ("sphere", _) => Solid::Ball([size(0); 3]),
        ("ellipsoid", _) => Solid::Ball([size(0), size(1), size(2)]),
        (other, _) => {
            notes.refused("geom", &shape.link, at, format!("a shape `{other}` is not shown"));
            return;
        }
    };
    input.shapes.solid(shape.body, place, solid);
    notes.taken("geom", &shape.link, at);
}
