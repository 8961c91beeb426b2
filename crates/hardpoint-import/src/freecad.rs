//! Documents of FreeCAD's Assembly workbench (`.FCStd`): parts in their current poses, joints, grounded parts, motions
//! of simulations.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{Cursor, Read};

use hardpoint::space::{Pose, Quat, Vec3};
use roxmltree::Node;

use crate::law::{self, Language};
use crate::markers::{
    ElementSource, Marker, MarkerJoint, carrying_joint, coordinate_sign, couple_screw, equals_nominal, join,
    join_by_link, offset, relative_to_nominal,
};
use crate::mechanism::{Coordinate, Drives, GROUND, Joint, Law, Mechanism, Times};
use crate::report::{ImportLog, SourceSpan};
use crate::turn::home;
use crate::xml::{child, children, named};
use crate::{Format, Input, LARGEST, xml};

/// FreeCAD format.
pub const FORMAT: Format = Format {
    name: "freecad",
    about: "FreeCAD Assembly document",
    endings: &["fcstd"],
    recognises: |_| false,
    read,
    binary: true,
};

/// Joint types in the order of their numbers, for documents that list no names.
const TYPES: [&str; 13] = [
    "Fixed",
    "Revolute",
    "Cylindrical",
    "Slider",
    "Ball",
    "Distance",
    "Parallel",
    "Perpendicular",
    "Angle",
    "RackPinion",
    "Screw",
    "Gears",
    "Belt",
];
/// Relative tolerance for a distance that holds in the design configuration: documents are saved solved.
const DRAWN: f64 = 1e-5;
/// Maximum depth of nested groups.
const DEEPEST: usize = 40;

fn read(input: &mut Input<'_>, notes: &mut ImportLog) -> Option<Mechanism> {
    let text = match document(input.bytes) {
        Ok(text) => text,
        Err((why, help)) => {
            notes.problem_with("HP0802", None, why, help);
            return None;
        }
    };
    let number = notes.text("Document.xml", &text);
    let document = xml::parse(&text, number, notes)?;
    let root = document.root_element();
    let mut objects = BTreeMap::new();
    let types: BTreeMap<&str, &str> = child(root, "Objects")
        .into_iter()
        .flat_map(|list| named(list, "Object"))
        .filter_map(|o| Some((o.attribute("name")?, o.attribute("type")?)))
        .collect();
    for node in child(root, "ObjectData").into_iter().flat_map(|list| named(list, "Object")) {
        let Some(name) = node.attribute("name") else { continue };
        let properties: BTreeMap<&str, Node<'_, '_>> = child(node, "Properties")
            .into_iter()
            .flat_map(|list| named(list, "Property"))
            .filter_map(|p| Some((p.attribute("name")?, p)))
            .collect();
        let kind = types.get(name).copied().unwrap_or_default();
        objects.insert(name, Object { name, node, kind, properties, text: number });
    }
    let mut reader = Reader {
        m: Mechanism::new(input.stem, "mm", "rad"),
        notes,
        objects,
        bodies: BTreeMap::new(),
        joints: BTreeMap::new(),
    };
    reader.assembly();
    let m = reader.m;
    (m.bodies.len() > 1).then_some(m)
}

/// Returns the text of the document in the archive.
///
/// # Errors
/// Returns the reason why there is none, and a correction.
fn document(bytes: &[u8]) -> Result<String, (String, &'static str)> {
    let failed = |why: String| {
        (format!("the file is not a FreeCAD document: {why}"), "save the document in FreeCAD again")
    };
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).map_err(|e| failed(e.to_string()))?;
    let file = archive.by_name("Document.xml").map_err(|_| failed("it has no `Document.xml`".into()))?;
    let mut text = Vec::new();
    // The size that the archive states need not be right.
    let size = file.take(LARGEST as u64 + 1).read_to_end(&mut text);
    if size.map_err(|e| failed(format!("`Document.xml`: {e}")))? > LARGEST {
        let message = format!("`Document.xml` is too large: at most {} MiB are read", LARGEST >> 20);
        return Err((message, "save the assembly without parts that need not move"));
    }
    String::from_utf8(text).map_err(|e| failed(format!("`Document.xml`: {e}")))
}

/// Object of the document.
struct Object<'a, 'i> {
    name: &'a str,
    node: Node<'a, 'i>,
    kind: &'a str,
    properties: BTreeMap<&'a str, Node<'a, 'i>>,
    text: usize,
}

impl<'a, 'i> Object<'a, 'i> {
    fn at(&self) -> Option<SourceSpan> {
        xml::attribute_at(self.text, self.node, "name")
    }

    /// Returns the element of a property.
    fn value(&self, property: &str) -> Option<Node<'a, 'i>> {
        children(*self.properties.get(property)?).next()
    }

    fn text_of(&self, property: &str) -> Option<&'a str> {
        self.value(property)?.attribute("value")
    }

    fn label(&self) -> &'a str {
        self.text_of("Label").filter(|l| !l.trim().is_empty()).unwrap_or(self.name)
    }

    fn number(&self, property: &str) -> Option<f64> {
        self.text_of(property)?.parse().ok().filter(|x: &f64| x.is_finite())
    }

    /// Returns the word of an enumeration property.
    fn word(&self, property: &str) -> Option<String> {
        let node = *self.properties.get(property)?;
        let value = child(node, "Integer").and_then(|n| n.attribute("value"));
        let Some(k) = value.and_then(|v| v.parse::<usize>().ok()) else {
            return self.text_of(property).map(str::to_owned);
        };
        let listed = child(node, "CustomEnumList")
            .and_then(|list| children(list).nth(k))
            .and_then(|e| e.attribute("value"));
        listed.or(TYPES.get(k).copied()).map(str::to_owned)
    }

    /// Pose relative to its container.
    fn pose(&self, notes: &mut ImportLog) -> Pose {
        let of_link = self.placement("LinkPlacement", notes);
        self.placement("Placement", notes).or(of_link).unwrap_or_else(home)
    }

    fn placement(&self, property: &str, notes: &mut ImportLog) -> Option<Pose> {
        let node = self.value(property)?;
        let number =
            |key: &str| node.attribute(key).and_then(|v| v.parse().ok()).filter(|x: &f64| x.is_finite());
        let r = [number("Px"), number("Py"), number("Pz")];
        let q = [number("Q3"), number("Q0"), number("Q1"), number("Q2")];
        let (true, true) = (r.iter().all(Option::is_some), q.iter().all(Option::is_some)) else {
            let message = format!("`{property}` of `{}` is not a placement", self.label());
            notes.problem_with(
                "HP0804",
                xml::at(self.text, node),
                message,
                "save the document in FreeCAD again",
            );
            return None;
        };
        let rot = Quat::from_array(q.map(Option::unwrap_or_default))
            .map_or_else(crate::turn::none, |q| q.rotation());
        Some(Pose { rot, r: r.map(Option::unwrap_or_default).into() })
    }

    /// Returns the target of a link: the object, the first path in it, and the file of another document.
    fn link(&self, property: &str) -> Option<(&'a str, String, &'a str)> {
        let node = self.value(property)?;
        let name = node.attribute("name").or_else(|| node.attribute("value"))?;
        let sub = node
            .attribute("sub")
            .or_else(|| children(node).find_map(|s| s.attribute("value")))
            .unwrap_or_default();
        Some((name, sub.to_owned(), node.attribute("file").unwrap_or_default()))
    }

    /// Returns the object that it links to.
    fn linked_object(&self) -> Option<&'a str> {
        self.link("LinkedObject").map(|(name, ..)| name)
    }

    /// Returns true if it links to an object of another document.
    fn is_elsewhere(&self) -> bool {
        self.link("LinkedObject").is_some_and(|(_, _, file)| !file.is_empty())
    }

    /// Returns true if it has a shape, in whose frame its content is drawn.
    fn is_shape(&self) -> bool {
        self.kind.starts_with("PartDesign::Body")
            || (self.kind.starts_with("Part::") && !self.kind.starts_with("Part::Datum"))
    }

    /// Returns true if it is in a body but has its own frame: a sketch or datum.
    fn has_own_frame(&self) -> bool {
        const DATUMS: [&str; 4] = ["Plane", "Line", "Point", "CoordinateSystem"];
        let datum = self.kind.strip_prefix("PartDesign::").is_some_and(|k| DATUMS.contains(&k));
        datum || self.kind.starts_with("Part::Datum") || self.kind.starts_with("Sketcher::")
    }

    /// Returns the objects in a group.
    fn group(&self) -> Vec<&'a str> {
        let list = self.value("Group").into_iter().flat_map(children);
        list.filter_map(|n| n.attribute("value").or_else(|| n.attribute("name"))).collect()
    }
}

/// Properties of joints that are read, are contained in others, or do not concern the motion.
const OF_JOINTS: [&str; 42] = [
    "Activated",
    "Suppressed",
    "JointType",
    "Label",
    "Label2",
    "Placement1",
    "Placement2",
    "Reference1",
    "Reference2",
    "Object1",
    "Object2",
    "Part1",
    "Part2",
    "Element1",
    "Element2",
    "Vertex1",
    "Vertex2",
    "Distance",
    "Distance2",
    "Angle",
    "EnableLengthMin",
    "EnableLengthMax",
    "EnableAngleMin",
    "EnableAngleMax",
    "LengthMin",
    "LengthMax",
    "AngleMin",
    "AngleMax",
    "ObjectToGround",
    // Contained in the placements.
    "Offset1",
    "Offset2",
    "Detach1",
    "Detach2",
    "AttachmentOffset",
    // Properties of every object.
    "Visibility",
    "ExpressionEngine",
    "Proxy",
    "Placement",
    "ShowInTree",
    "Group",
    "Version",
    "Document",
];

struct Reader<'a, 'i, 'n> {
    m: Mechanism,
    notes: &'n mut ImportLog,
    objects: BTreeMap<&'a str, Object<'a, 'i>>,
    bodies: BTreeMap<&'a str, usize>,
    joints: BTreeMap<&'a str, MarkerJoint>,
}

impl<'a, 'i> Reader<'a, 'i, '_> {
    fn assembly(&mut self) {
        let roots: Vec<&'a str> =
            self.objects.values().filter(|o| o.kind == "Assembly::AssemblyObject").map(|o| o.name).collect();
        // The assembly that is in no other one.
        let inner: BTreeSet<&'a str> = roots.iter().flat_map(|r| self.objects[r].group()).collect();
        let mut outermost = roots.iter().copied().filter(|r| !inner.contains(r));
        let Some(root) = outermost.next() else {
            self.notes.problem_with(
                "HP0803",
                None,
                "the document has no assembly",
                "create one with FreeCAD's Assembly workbench",
            );
            return;
        };
        for other in outermost {
            let object = &self.objects[other];
            let why = "only the first assembly of a document is imported";
            self.notes.refused("assembly", object.label(), object.at(), why);
        }
        self.m.name = self.objects[root].label().to_owned();
        let outer = self.objects[root].pose(self.notes);
        let mut joints = Vec::new();
        let mut parts = Vec::new();
        self.sort(root, &mut parts, &mut joints, 0);
        let grounded: BTreeSet<&'a str> = joints
            .iter()
            .filter_map(|j| self.objects[j].link("ObjectToGround"))
            .map(|(name, ..)| name)
            .collect();
        for part in parts {
            let object = &self.objects[part];
            let pose = outer.compose(object.pose(self.notes));
            let object = &self.objects[part];
            let source = ElementSource { kind: "part", name: object.label(), at: object.at() };
            let body = if grounded.contains(part) {
                GROUND
            } else {
                self.m.body(object.label(), source.note(self.notes), Some(pose))
            };
            if object.kind == "Assembly::AssemblyLink" && object.text_of("Rigid") == Some("false") {
                let why = "flexible assembly: imported as one rigid part";
                self.notes.approximated("part", source.name, source.at, why);
            } else {
                self.notes.taken("part", source.name, source.at);
            }
            self.bodies.insert(part, body);
        }
        for joint in &joints {
            self.joint(joint, root, outer);
        }
        for joint in &joints {
            self.relation(joint, root, outer);
        }
        let motions: Vec<&'a str> = self
            .objects
            .values()
            .filter(|o| o.properties.contains_key("Formula") && o.properties.contains_key("MotionType"))
            .map(|o| o.name)
            .collect();
        for motion in motions {
            let (label, at) = (self.objects[motion].label(), self.objects[motion].at());
            if let Err(why) = self.motion(motion) {
                self.notes.refused("motion", label, at, format!("{why}; the motion is not imported"));
                self.m.lost_motions += 1;
            }
        }
        self.times();
    }

    /// Collects the parts and joints of a group and of its nested groups.
    fn sort(&mut self, group: &'a str, parts: &mut Vec<&'a str>, joints: &mut Vec<&'a str>, depth: usize) {
        let Some(object) = self.objects.get(group).filter(|_| depth < DEEPEST) else { return };
        for name in object.group() {
            // An assembly also lists the content of its groups.
            let known = parts.contains(&name) || joints.contains(&name);
            let Some(inner) = self.objects.get(name).filter(|_| !known) else { continue };
            let is_joint =
                inner.properties.contains_key("JointType") || inner.properties.contains_key("ObjectToGround");
            let has_place = ["Placement", "LinkPlacement"].iter().any(|p| inner.properties.contains_key(p));
            let (kind, at) = (inner.kind, inner.at());
            if is_joint {
                joints.push(name);
            } else if [
                "Assembly::JointGroup",
                "App::DocumentObjectGroup",
                "Assembly::ViewGroup",
                "Assembly::SimulationGroup",
            ]
            .contains(&kind)
            {
                self.sort(name, parts, joints, depth + 1);
            } else if has_place
                && !kind.starts_with("App::Origin")
                && !["App::Line", "App::Plane", "App::Point"].contains(&kind)
            {
                parts.push(name);
            } else {
                self.notes.ignored(kind, at);
            }
        }
    }

    /// Returns the marker at one end of a joint.
    fn marker(&mut self, joint: &'a str, k: usize, root: &'a str, outer: Pose) -> Option<Marker> {
        let object = &self.objects[joint];
        let (label, at) = (object.label(), object.at());
        let inner = object.placement(&format!("Placement{k}"), self.notes).unwrap_or_else(home);
        let object = &self.objects[joint];
        let reference = object.link(&format!("Reference{k}")).or_else(|| object.link(&format!("Object{k}")));
        let Some((name, sub, _)) = reference else {
            let message = format!("`{label}` has no `Reference{k}`");
            self.notes.problem_with("HP0803", at, message, "select both ends of the joint in FreeCAD");
            return None;
        };
        // The path from the assembly; its last word is a face, an edge or a vertex.
        let mut path: Vec<&str> = sub.split('.').collect();
        path.pop();
        if name != root {
            path.insert(0, name);
        }
        let first = path.iter().position(|p| self.bodies.contains_key(*p));
        let Some(first) = first else {
            let place = if sub.is_empty() { name } else { sub.as_str() };
            let message = format!("`{label}` refers to `{place}`, which is not a part of the assembly");
            self.notes.problem_with("HP0803", at, message, "select both ends of the joint in FreeCAD");
            return None;
        };
        let body = self.bodies[path[first]];
        let mut pose = outer;
        for (k, part) in path[first..].iter().enumerate() {
            let Some(object) = self.objects.get(part) else { continue };
            pose = pose.compose(object.pose(self.notes));
            let object = &self.objects[part];
            let rest = &path[first + k + 1..];
            if object.is_elsewhere() {
                if !rest.is_empty() {
                    let why = format!(
                        "`{}` is in another document: positions within it are ignored",
                        rest.join(".")
                    );
                    self.notes.approximated("reference", label, at, why);
                }
                break;
            }
            // The content of a body is in the body frame, except for sketches and datums.
            let shape = object.linked_object().and_then(|name| self.objects.get(name)).unwrap_or(object);
            let has_frame = |name: &&str| self.objects.get(name).is_some_and(Object::has_own_frame);
            if shape.is_shape() && !rest.first().is_some_and(has_frame) {
                break;
            }
        }
        Some(Marker { body, pose: pose.compose(inner) })
    }

    fn joint(&mut self, joint: &'a str, root: &'a str, outer: Pose) {
        let object = &self.objects[joint];
        let (label, at) = (object.label(), object.at());
        if object.properties.contains_key("ObjectToGround") {
            self.notes.taken("grounded", label, at);
            return;
        }
        let kind = object.word("JointType").unwrap_or_default();
        if object.text_of("Activated") == Some("false") || object.text_of("Suppressed") == Some("true") {
            self.notes.refused(&kind, label, at, "it is not active");
            return;
        }
        for (property, node) in &object.properties {
            if !OF_JOINTS.contains(property) {
                let at = xml::at(object.text, *node);
                let why = format!("the joint has an unknown property `{property}`");
                self.notes.not_understood("property", label, at, why);
            }
        }
        let distance = object.number("Distance");
        if ["RackPinion", "Gears", "Belt", "Screw"].contains(&kind.as_str()) {
            return;
        }
        let type_name = match kind.as_str() {
            "Fixed" => "fixed",
            "Revolute" => "revolute",
            "Cylindrical" => "cylindrical",
            "Slider" => "translational",
            "Ball" => "spherical",
            "Parallel" => "parallel",
            "Perpendicular" => "dot1",
            "Angle" => "angle",
            "Distance" => "distance",
            _ => {
                let message = format!("`{label}` is of the unknown type `{kind}`");
                self.notes.problem_with("HP0805", at, message, "save the document with FreeCAD 1.0 or later");
                return;
            }
        };
        let ends = [1, 2].map(|k| self.marker(joint, k, root, outer));
        let [Some(i), Some(j)] = ends else { return };
        let source = ElementSource { kind: &kind, name: label, at };
        let note = source.note(self.notes);
        let number = match type_name {
            "distance" => {
                let elements = [1, 2].map(|k| self.element(joint, k));
                return self.distance(source, elements, [i, j], distance.unwrap_or(0.0));
            }
            "angle" if i.z().cross(j.z()).norm() > 1e-6 && i.body != j.body => {
                self.notes.taken(&kind, label, at);
                Some(self.m.joint(
                    Joint::new(label, note, "angle", [i.body, j.body], i.pose.r).with_axes(i.z(), j.z()),
                ))
            }
            "angle" => join(&mut self.m, self.notes, source, "parallel", [i, j]),
            other => join(&mut self.m, self.notes, source, other, [i, j]),
        };
        let Some(number) = number else { return };
        let limits = self.limits(joint, type_name, &i, &j);
        let enabled = ["EnableLengthMin", "EnableLengthMax", "EnableAngleMin", "EnableAngleMax"];
        let object = &self.objects[joint];
        if limits.is_empty() && enabled.iter().any(|key| object.text_of(key) == Some("true")) {
            let why = "it has no number, or its joint has no such coordinate";
            self.notes.refused("limits", label, at, why);
        }
        for (of, range) in limits {
            match self.m.joints[number].limit(of, range) {
                Ok(()) => self.notes.taken("limits", label, at),
                Err(why) => self.notes.refused("limits", label, at, why),
            }
        }
        self.joints.insert(joint, MarkerJoint { number, kind: type_name, markers: [i, j] });
    }

    /// Returns the limits of a hinge or slide, relative to the design configuration.
    fn limits(&self, joint: &'a str, kind: &str, i: &Marker, j: &Marker) -> Vec<(&'static str, [f64; 2])> {
        let object = &self.objects[joint];
        let nominal = offset(i, j);
        let angle = ("angle", "Angle", nominal.angle, 1_f64.to_radians());
        let displacement = ("displacement", "Length", nominal.displacement, 1.0);
        let limited = match kind {
            "revolute" => vec![angle],
            "translational" => vec![displacement],
            "cylindrical" => vec![displacement, angle],
            _ => Vec::new(),
        };
        let range = |(of, what, nominal, per_unit): (&'static str, &str, f64, f64)| {
            let limit = |end: &str| {
                let is_set = object.text_of(&format!("Enable{what}{end}")) == Some("true");
                Some(object.number(&format!("{what}{end}")).filter(|_| is_set)? * per_unit - nominal)
            };
            let ends = [limit("Min"), limit("Max")];
            let open = [f64::NEG_INFINITY, f64::INFINITY];
            (ends != [None, None]).then(|| (of, [0, 1].map(|k| ends[k].unwrap_or(open[k]))))
        };
        limited.into_iter().filter_map(range).collect()
    }

    /// Returns the element at an end of a joint: `Face`, `Edge` or `Vertex`, or an empty text for a whole part.
    fn element(&self, joint: &'a str, k: usize) -> &'static str {
        let reference = self.objects[joint].link(&format!("Reference{k}"));
        let sub = reference.map(|(_, sub, _)| sub).unwrap_or_default();
        let last = sub.rsplit('.').next().unwrap_or_default();
        ["Face", "Edge", "Vertex"].into_iter().find(|e| last.starts_with(e)).unwrap_or_default()
    }

    /// Adds a distance between two surfaces, lines or points. The type of surface of a face is only in its shape. It is
    /// inferred from the frames in the design configuration, where the distance holds.
    fn distance(
        &mut self,
        source: ElementSource<'_>,
        elements: [&str; 2],
        ends: [Marker; 2],
        specified: f64,
    ) {
        // The face, or otherwise the edge, comes first.
        let rank = |e: &str| ["Face", "Edge", "Vertex"].iter().position(|x| *x == e).unwrap_or(3);
        let swapped = rank(elements[1]) < rank(elements[0]);
        let [i, j] = if swapped { [ends[1], ends[0]] } else { ends };
        let elements = if swapped { [elements[1], elements[0]] } else { elements };
        let gap = j.pose.r - i.pose.r;
        let along = gap.dot(i.z());
        let across = (gap - i.z() * along).norm();
        let near = |a: f64, b: f64| (a.abs() - b.abs()).abs() <= DRAWN * self.m.size().max(a.abs());
        let parallel = i.z().cross(j.z()).norm() <= DRAWN;
        let square = i.z().dot(j.z()).abs() <= DRAWN;
        let shifted = Marker { body: i.body, pose: Pose { r: i.pose.r + i.z() * along, ..i.pose } };
        let how = match elements {
            ["Vertex", "Vertex"] if near(specified, 0.0) => "spherical",
            ["Vertex", "Vertex"] => "distance",
            ["Face", "Face"] | ["Face", "Edge"] if parallel && near(along, specified) => "planar",
            ["Face", "Edge"] if square && near(along, specified) => "line in plane",
            ["Face" | "Edge", "Vertex"] if near(along, specified) && !near(across, specified) => "inplane",
            ["Face" | "Edge", "Vertex"] => "point and axis",
            ["Face", "Face"] | ["Edge", "Edge"] if parallel => "axes",
            _ => "",
        };
        if i.body == j.body {
            let why = "its markers are on the same body";
            self.notes.refused(source.kind, source.name, source.at, why);
            return;
        }
        // The entries of the joints are replaced by one entry for the distance.
        let entry_count = self.notes.report.entries.len();
        let name = match how {
            "spherical" => {
                join(&mut self.m, self.notes, source, how, [i, j]);
                return;
            }
            "distance" if across + along.abs() > 0.0 => {
                let rod = Joint::new(source.name, source.note(self.notes), how, [i.body, j.body], i.pose.r);
                let mut rod = rod.between(i.pose.r, j.pose.r);
                rod.length = Some(specified.abs()).filter(|d| !equals_nominal(&self.m, *d, gap.norm()));
                self.m.joint(rod);
                self.notes.taken(source.kind, source.name, source.at);
                return;
            }
            "planar" => {
                join(&mut self.m, self.notes, source, "planar", [shifted, j]);
                "two planes"
            }
            "inplane" => {
                join(&mut self.m, self.notes, source, "inplane", [shifted, j]);
                "a point and a plane"
            }
            "line in plane" => {
                join(&mut self.m, self.notes, source, "dot1", [i, j]);
                join(&mut self.m, self.notes, source, "inplane", [shifted, j]);
                "a line and a plane"
            }
            "point and axis" => {
                join_by_link(&mut self.m, self.notes, source, ["cylindrical", "spherical"], [i, j], None);
                "a point and an axis"
            }
            "axes" => {
                join_by_link(&mut self.m, self.notes, source, ["revolute", "cylindrical"], [i, j], None);
                "two axes"
            }
            _ => {
                let why = "its types of surfaces are not in the file and cannot be inferred: a driver fixes the motion instead";
                self.notes.refused(source.kind, source.name, source.at, why);
                return;
            }
        };
        self.notes.report.entries.truncate(entry_count);
        let why = format!(
            "imported as a distance of {specified} mm between {name}, inferred from the design configuration; the types of surfaces are not in the file"
        );
        self.notes.approximated(source.kind, source.name, source.at, why);
    }

    /// Adds racks, gears, belts and screws as couplers of the joints that carry their parts.
    fn relation(&mut self, joint: &'a str, root: &'a str, outer: Pose) {
        let object = &self.objects[joint];
        let (label, at) = (object.label(), object.at());
        let kind = object.word("JointType").unwrap_or_default();
        let is_off =
            object.text_of("Activated") == Some("false") || object.text_of("Suppressed") == Some("true");
        if is_off || !["RackPinion", "Gears", "Belt", "Screw"].contains(&kind.as_str()) {
            return;
        }
        let [first, second] =
            [object.number("Distance"), object.number("Distance2")].map(|d| d.filter(|d| *d != 0.0));
        let ends = [1, 2].map(|k| self.marker(joint, k, root, outer));
        let [Some(i), Some(j)] = ends else { return };
        if kind == "Screw" {
            return self.screw(joint, [i, j], first);
        }
        let hinges = ["revolute", "cylindrical"];
        let hinge = |m: Marker, axis: Vec3| {
            carrying_joint(self.joints.values(), m.body, &hinges, m.z())
                .map(|k| (k.number, coordinate_sign(k, m.body, axis)))
        };
        let slide = |m: Marker| {
            carrying_joint(self.joints.values(), m.body, &["translational"], m.z())
                .map(|k| (k.number, coordinate_sign(k, m.body, m.z())))
        };
        let angle = |joint: usize| Coordinate { joint, name: "angle" };
        let terms = if kind == "RackPinion" {
            // Either end can be the rack.
            let [a, b] =
                [(i, j), (j, i)].map(|(rack, pinion)| Some((slide(rack)?, hinge(pinion, pinion.z())?)));
            first.zip(a.or(b)).map(|(radius, ((rack, u), (pinion, v)))| {
                vec![(Coordinate { joint: rack, name: "displacement" }, u), (angle(pinion), -radius * v)]
            })
        } else {
            let sign = if kind == "Belt" { -1.0 } else { 1.0 };
            match (first, second, hinge(i, i.z()), hinge(j, i.z())) {
                (Some(ri), Some(rj), Some((a, u)), Some((b, v))) if a != b => {
                    Some(vec![(angle(a), ri * u), (angle(b), sign * rj * v)])
                }
                _ => None,
            }
        };
        match terms {
            Some(terms) => {
                let note = ElementSource { kind: &kind, name: label, at }.note(self.notes);
                self.m.coupler(label, note, terms);
                self.notes.approximated(
                    &kind,
                    label,
                    at,
                    "imported as a coupler of the joints that carry its two parts",
                );
            }
            None => self.notes.refused(
                &kind,
                label,
                at,
                "it has no radii, or no joints along its axes carry its parts",
            ),
        }
    }

    /// Adds a screw as a single relation between slide and rotation, like the solver, or as a joint if no other joints
    /// guide its parts.
    fn screw(&mut self, joint: &'a str, markers: [Marker; 2], lead: Option<f64>) {
        let object = &self.objects[joint];
        let source = ElementSource { kind: "Screw", name: object.label(), at: object.at() };
        let Some(lead) = lead else {
            let message = format!("the screw `{}` has no pitch", source.name);
            self.notes.problem_with("HP0804", source.at, message, "give it a non-zero distance");
            return;
        };
        let joints: Vec<MarkerJoint> = self.joints.values().copied().collect();
        if couple_screw(&mut self.m, self.notes, source, &joints, markers, lead).is_none()
            && let Some(number) = join(&mut self.m, self.notes, source, "screw", markers)
        {
            self.m.joints[number].lead = Some(lead);
            self.joints.insert(joint, MarkerJoint { number, kind: "screw", markers });
        }
    }

    fn motion(&mut self, motion: &'a str) -> Result<(), String> {
        let object = &self.objects[motion];
        let (label, at) = (object.label(), object.at());
        let turns = object.word("MotionType").is_none_or(|t| t != "Linear");
        let name = if turns { "angle" } else { "displacement" };
        let joint = object.link("Joint").map(|(name, ..)| name).unwrap_or_default();
        let function = object.text_of("Formula").unwrap_or_default();
        let Some(joint) = self.joints.get(joint).copied() else {
            return Err(format!("it drives the joint `{joint}`, which does not exist or is not supported"));
        };
        let kind = hardpoint::joint::ALL.iter().find(|k| k.name == joint.kind);
        if !kind.is_some_and(|k| k.coordinates.iter().any(|c| c.name == name)) {
            return Err(format!("a joint of type {} has no {name}", joint.kind));
        }
        let coordinate = Coordinate { joint: joint.number, name };
        if self.m.is_driven(coordinate) {
            return Err("the joint is driven already".into());
        }
        let nominal = offset(&joint.markers[0], &joint.markers[1]);
        let text = relative_to_nominal(
            &law::translate(function, Language::FreeCad)?,
            if turns { nominal.angle } else { nominal.displacement },
            turns,
        );
        let law = if law::constant(&text) == Some(0.0) { Law::Fixed } else { Law::Text(text) };
        let note = ElementSource { kind: "motion", name: label, at }.note(self.notes);
        self.m.driver(label, note, Drives::Coordinate(coordinate), law);
        self.notes.taken("motion", label, at);
        Ok(())
    }

    fn times(&mut self) {
        let Some(simulation) = self.objects.values().find(|o| o.properties.contains_key("bTimeEnd")) else {
            return;
        };
        let [start, end, step] = ["aTimeStart", "bTimeEnd", "cTimeStepOutput"].map(|k| simulation.number(k));
        if let (start, Some(end), Some(step)) = (start.unwrap_or(0.0), end, step) {
            let steps = ((end - start) / step).round();
            if (1.0..=100_000.0).contains(&steps) {
                self.m.times = Some(Times { start, end, steps: steps as usize });
                self.notes.taken("simulation", simulation.label(), simulation.at());
            }
        }
    }
}
