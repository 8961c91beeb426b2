//! Assemblies of OndselSolver (`.asmt`), the solver and export format of FreeCAD's Assembly workbench, with the stored
//! motion.

use std::collections::BTreeMap;

use hardpoint::space::{Mat3, Pose, Vec3};

use crate::chain;
use crate::law::{self, Language};
use crate::markers::{
    ElementSource, Marker, MarkerJoint, carrying_joint, coordinate_sign, couple_screw, equals_nominal, join,
    join_by_link, offset, relative_to_nominal,
};
use crate::mechanism::{Coordinate, Drives, GROUND, Joint, JointLimit, Law, Mechanism, Times};
use crate::report::{ImportLog, SourceSpan};
use crate::series::{Series, StoredPose};
use crate::turn::{home, none, sequence};
use crate::{Format, Input};

/// Ondsel format.
pub const FORMAT: Format = Format {
    name: "asmt",
    about: "Ondsel assembly",
    endings: &["asmt"],
    recognises: |text| {
        let mut lines = text.lines().map(str::trim_end);
        lines.any(|l| l == "Assembly") && lines.any(|l| l.trim() == "RefPoints" || l.trim() == "Parts")
    },
    read,
    binary: false,
};

/// Maximum depth of nested lines.
const DEEPEST: usize = 64;
/// Maximum number of output times.
const MOST_TIMES: f64 = 100_000.0;

/// Parts whose stored pose differs by less than this from the drawn one, in the unit of the file and rad, are not
/// moved.
const OFF: f64 = 1e-12;

/// Lines with their positions.
type Lines<'t> = Vec<(&'t str, SourceSpan)>;

/// Line with the lines indented below it.
#[derive(Debug)]
struct Node<'t> {
    text: &'t str,
    at: SourceSpan,
    children: Vec<Node<'t>>,
}

impl<'t> Node<'t> {
    fn child(&self, name: &str) -> Option<&Self> {
        self.children.iter().find(|c| c.text == name)
    }

    /// Returns the text on the line below a heading.
    fn value(&self, name: &str) -> Option<(&'t str, SourceSpan)> {
        let below = self.child(name)?.children.first()?;
        Some((below.text, below.at))
    }

    fn name(&self) -> &'t str {
        self.value("Name").map_or("", |(name, _)| name)
    }

    /// Returns the numbers on the lines below a heading.
    fn numbers<const N: usize>(&self, name: &str, notes: &mut ImportLog) -> Option<[f64; N]> {
        let list = self.child(name)?;
        let words = list.children.iter().flat_map(|c| c.text.split_whitespace());
        let numbers: Option<Vec<f64>> = words.map(number).collect();
        let exact = numbers.and_then(|n| <[f64; N]>::try_from(n).ok());
        if exact.is_none() {
            let s = if N == 1 { "number" } else { "numbers" };
            let found: Vec<&str> = list.children.iter().map(|c| c.text).collect();
            let message = format!("`{name}` must be {N} {s}, not `{}`", found.join(" "));
            let at = list.children.first().map_or(list.at, |c| c.at);
            notes.problem_with(
                "HP0804",
                Some(at),
                message,
                "export the assembly again, or correct the lines below the heading",
            );
        }
        exact
    }

    /// Returns the frame with its position and rotation matrix; the identity if none is given.
    fn pose(&self, notes: &mut ImportLog) -> Pose {
        let r = self.numbers::<3>("Position3D", notes).unwrap_or_default();
        let rows = self.numbers::<9>("RotationMatrix", notes);
        let rot = rows.map_or_else(none, |[a, b, c, d, e, f, g, h, i]| Mat3 {
            cols: [[a, d, g].into(), [b, e, h].into(), [c, f, i].into()],
        });
        // Matrices with six digits have to be orthonormalised.
        let q = hardpoint::space::Quat::from_rotation(rot).to_array();
        let square = crate::turn::quaternion(q);
        let off = (0..3).map(|k| (rot.cols[k].norm() - 1.0).abs()).fold(0.0, f64::max);
        match square {
            Some(rot) if off < 1e-3 => Pose { rot, r: r.into() },
            _ => {
                let at = self.child("RotationMatrix").map(|c| c.at);
                notes.problem(
                    "HP0804",
                    at,
                    "the matrix is not a rotation matrix: its columns are not of length one",
                );
                home()
            }
        }
    }
}

/// Reads a number; Smalltalk, and some C++ code, writes `1.0d`.
fn number(word: &str) -> Option<f64> {
    let word = word.strip_suffix(['d', 'D']).unwrap_or(word);
    word.parse().ok().filter(|x: &f64| x.is_finite())
}

fn read(input: &mut Input<'_>, notes: &mut ImportLog) -> Option<Mechanism> {
    let (nodes, lines) = tree(input.text, notes)?;
    let Some(assembly) = nodes.iter().find(|n| n.text == "Assembly") else {
        let help = "export the assembly as `.asmt` again";
        notes.problem_with("HP0803", None, "the file has no `Assembly`", help);
        return None;
    };
    for section in ["ConstraintSets", "SimulationParameters"] {
        if assembly.child(section).is_none() {
            let at = assembly.children.last().map_or(assembly.at, |c| c.at);
            let message = format!(
                "the assembly has no `{section}`: the file is truncated, `{}` is its last section",
                assembly.children.last().map_or("", |c| c.text)
            );
            notes.problem_with("HP0802", Some(at), message, "export the assembly again");
            return None;
        }
    }
    // Files of FreeCAD are in mm; the examples of the solver state that they are in SI.
    let by_freecad = input.text.starts_with("OndselSolver");
    let unit = if by_freecad { "mm" } else { "m" };
    notes.approximated(
        "Assembly",
        assembly.name(),
        Some(assembly.at),
        format!("the file defines no unit of length: {unit} is assumed"),
    );
    let mut m =
        Mechanism::new(if assembly.name().is_empty() { input.stem } else { assembly.name() }, unit, "rad");
    m.times = times(assembly, notes);
    let stored = stored(&lines.unwrap_or_default(), notes);
    // The solver assembles open joints before it moves: the first stored poses are the assembled ones.
    let begins = m.times.is_none_or(|t| stored.0.first() == Some(&t.start));
    let first = |t: &StoredPart<'_>| Some((t.path.to_owned(), t.states.as_ref()?.first()?.pose));
    let closed = stored.1.iter().filter(|_| begins).filter_map(first).collect();
    let mut reader = Reader {
        m,
        notes,
        markers: BTreeMap::new(),
        joints: BTreeMap::new(),
        parts: BTreeMap::new(),
        closed,
        moved: 0,
    };
    reader.parts(assembly);
    reader.joints(assembly);
    reader.motions(assembly);
    reader.rest(assembly);
    let (m, parts) = (reader.m, reader.parts);
    input.series = series(stored, &m, &parts, notes);
    (m.bodies.len() > 1).then_some(m)
}

/// Parses the lines by their tabs; returns the stored series separately.
fn tree<'t>(text: &'t str, notes: &mut ImportLog) -> Option<(Vec<Node<'t>>, Option<Lines<'t>>)> {
    let mut open: Vec<Node<'t>> = vec![Node { text: "", at: SourceSpan::default(), children: Vec::new() }];
    let mut series: Option<Lines<'_>> = None;
    let mut start = 0;
    for whole in text.split_inclusive('\n') {
        let line = whole.trim_end();
        let tabs = line.len() - line.trim_start_matches('\t').len();
        let from = start + tabs;
        let at = SourceSpan { text: 0, start: from, end: start + line.len() };
        let code = &line[tabs..];
        start += whole.len();
        if code.trim().is_empty() {
            continue;
        }
        if tabs == 0 && code.trim() == "TimeSeries" {
            series = Some(Vec::new());
        }
        if let Some(series) = &mut series {
            series.push((code, at));
            continue;
        }
        if tabs >= DEEPEST || tabs + 1 > open.len() {
            notes.problem_with(
                "HP0802",
                Some(at),
                "the line is indented too deep",
                "indent it by one tab more than its heading",
            );
            return None;
        }
        fold(&mut open, tabs + 1);
        open.push(Node { text: code.trim(), at, children: Vec::new() });
    }
    fold(&mut open, 1);
    Some((open.pop().map(|root| root.children).unwrap_or_default(), series))
}

fn fold(open: &mut Vec<Node<'_>>, depth: usize) {
    while open.len() > depth {
        if let (Some(last), Some(parent)) = (open.pop(), open.last_mut()) {
            parent.children.push(last);
        }
    }
}

fn times(assembly: &Node<'_>, notes: &mut ImportLog) -> Option<Times> {
    let s = assembly.child("SimulationParameters")?;
    let [start, end, step] = ["tstart", "tend", "hout"].map(|k| s.numbers::<1>(k, notes).map(|[x]| x));
    let (start, end, step) = (start.unwrap_or(0.0), end?, step?);
    let steps = ((end - start) / step).round();
    let fits = (1.0..=MOST_TIMES).contains(&steps) && ((end - start) / step - steps).abs() < 1e-6 * steps;
    if !fits {
        notes.approximated(
            "SimulationParameters",
            "",
            Some(s.at),
            "`hout` does not divide the time into 1 to 100,000 equal intervals: one second in 100 intervals is used",
        );
        return None;
    }
    notes.taken("SimulationParameters", "", Some(s.at));
    Some(Times { start, end, steps: steps as usize })
}

struct Reader<'n> {
    m: Mechanism,
    notes: &'n mut ImportLog,
    /// Markers by their paths.
    markers: BTreeMap<String, Marker>,
    joints: BTreeMap<String, MarkerJoint>,
    parts: BTreeMap<String, usize>,
    /// Poses of the parts at the start of the stored motion, by their paths.
    closed: BTreeMap<String, Pose>,
    /// Number of parts whose stored pose differs from the drawn one.
    moved: usize,
}

impl Reader<'_> {
    fn parts(&mut self, assembly: &Node<'_>) {
        let path = format!("/{}", assembly.name());
        let whole = assembly.pose(self.notes);
        self.markers_of(assembly, &path, GROUND, whole);
        let parts = assembly.child("Parts").map_or(&[][..], |p| &p.children);
        for part in parts {
            if part.text != "Part" {
                self.notes.refused(
                    part.text,
                    part.name(),
                    Some(part.at),
                    "only elements of type `Part` are supported",
                );
                continue;
            }
            let path = format!("{path}/{}", part.name());
            let nominal = whole.compose(part.pose(self.notes));
            let is_fixed = part.value("isFixed").is_some_and(|(v, _)| v == "true");
            let off = |p: &&Pose| {
                (p.r - nominal.r).norm() > OFF * p.r.norm().max(1.0) || p.rot.angle_to(nominal.rot) > OFF
            };
            let closed = self.closed.get(&path).filter(off).filter(|_| !is_fixed).copied();
            self.moved += usize::from(closed.is_some());
            let pose = closed.unwrap_or(nominal);
            let source = ElementSource { kind: "Part", name: part.name(), at: Some(part.at) };
            let body =
                if is_fixed { GROUND } else { self.m.body(part.name(), source.note(self.notes), Some(pose)) };
            if self.parts.insert(path.clone(), body).is_some() {
                self.notes.problem_with(
                    "HP0803",
                    Some(part.at),
                    format!("the part `{path}` is defined twice"),
                    "rename one of them",
                );
            }
            self.markers_of(part, &path, body, pose);
            self.notes.taken("Part", part.name(), Some(part.at));
        }
        if self.moved > 0 {
            let why = format!(
                "{} of them are drawn where their joints do not close: they are placed at the start of the stored motion",
                self.moved
            );
            self.notes.approximated("Parts", "", assembly.child("Parts").map(|p| p.at), why);
        }
        if let Some(list) = assembly.child("Assemblies").filter(|l| !l.children.is_empty()) {
            self.notes.refused(
                "Assemblies",
                "",
                Some(list.at),
                "nested assemblies are not supported: export their parts in one assembly",
            );
        }
    }

    fn markers_of(&mut self, owner: &Node<'_>, path: &str, body: usize, pose: Pose) {
        // Motions and forces may refer to the centre of mass.
        if let Some(mass) = owner.child("PrincipalMassMarker") {
            let pose = pose.compose(mass.pose(self.notes));
            self.markers.insert(format!("{path}/{}", mass.name()), Marker { body, pose });
        }
        let mass = owner.child("PrincipalMassMarker").map(|m| format!("{path}/{}", m.name()));
        let is_mass = |path: &str| mass.as_deref() == Some(path);
        let points = owner.child("RefPoints").map_or(&[][..], |p| &p.children);
        for point in points {
            let place = pose.compose(point.pose(self.notes));
            let markers = point.child("Markers").map_or(&[][..], |p| &p.children);
            for marker in markers {
                let pose = place.compose(marker.pose(self.notes));
                let path = format!("{path}/{}", marker.name());
                if self.markers.insert(path.clone(), Marker { body, pose }).is_some() && !is_mass(&path) {
                    self.notes.problem_with(
                        "HP0803",
                        Some(marker.at),
                        format!("the marker `{path}` is defined twice"),
                        "rename one of them",
                    );
                }
                self.notes.taken("Marker", marker.name(), Some(marker.at));
            }
        }
    }

    fn pair(&mut self, joint: &Node<'_>) -> Option<[Marker; 2]> {
        let found = ["MarkerI", "MarkerJ"].map(|key| {
            let (path, at) = joint.value(key).unwrap_or(("", joint.at));
            let marker = self.markers.get(path).copied();
            if marker.is_none() {
                let message = if path.is_empty() {
                    format!("`{}` has no `{key}`", joint.name())
                } else {
                    format!("`{}` names the marker `{path}`, which does not exist", joint.name())
                };
                self.notes.problem_with(
                    "HP0803",
                    Some(at),
                    message,
                    "name a marker by its path, as in `/Assembly/Part/Marker`",
                );
            }
            marker
        });
        let [Some(i), Some(j)] = found else { return None };
        Some([i, j])
    }

    fn joints(&mut self, assembly: &Node<'_>) {
        let sets = assembly.child("ConstraintSets");
        let joints = sets.and_then(|c| c.child("Joints")).map_or(&[][..], |p| &p.children);
        for joint in joints {
            let of_type: &[&str] = match joint.text {
                "SphericalSphericalJoint" | "SphSphJoint" | "RevRevJoint" | "RevCylJoint" | "CylSphJoint" => {
                    &["distanceIJ"]
                }
                "InPlaneJoint" | "PointInPlaneJoint" | "LineInPlaneJoint" | "PlanarJoint" => &["offset"],
                "AngleJoint" => &["theIzJz"],
                "ScrewJoint" => &["pitch"],
                "GearJoint" => &["radiusI", "radiusJ"],
                "RackPinionJoint" => &["pitchRadius"],
                contact if contact.ends_with("Contact") => continue,
                _ => &[],
            };
            self.unknown(joint, &[&["Name", "MarkerI", "MarkerJ"], of_type].concat());
            self.joint(joint);
        }
        for joint in joints.iter().filter(|j| j.text == "ScrewJoint") {
            self.screw(joint);
        }
        for joint in joints.iter().filter(|j| ["GearJoint", "RackPinionJoint"].contains(&j.text)) {
            self.gear(joint);
        }
    }

    /// Reports unknown lines below a heading. These may affect the motion.
    fn unknown(&mut self, owner: &Node<'_>, known: &[&str]) {
        for part in owner.children.iter().filter(|c| !known.contains(&c.text)) {
            // Other headings of the format may be empty.
            if part.children.is_empty() {
                continue;
            }
            let why = format!("`{}` has `{}`, which is unknown", owner.text, part.text);
            self.notes.not_understood(part.text, owner.name(), Some(part.at), why);
        }
    }

    fn joint(&mut self, joint: &Node<'_>) {
        let source = ElementSource { kind: joint.text, name: joint.name(), at: Some(joint.at) };
        let kind = match joint.text {
            "FixedJoint" => "fixed",
            "RevoluteJoint" => "revolute",
            "CylindricalJoint" => "cylindrical",
            "TranslationalJoint" => "translational",
            "SphericalJoint" | "AtPointJoint" => "spherical",
            "UniversalJoint" => "universal",
            "ConstantVelocityJoint" => "constant_velocity",
            "PlanarJoint" => "planar",
            "NoRotationJoint" => "orientation",
            "ParallelAxesJoint" => "parallel",
            "PerpendicularJoint" => "dot1",
            "InLineJoint" | "PointInLineJoint" => "inline",
            "InPlaneJoint" | "PointInPlaneJoint" => "inplane",
            "SphericalSphericalJoint" | "SphSphJoint" => "distance",
            "AngleJoint" => "angle",
            "LineInPlaneJoint" => "line_in_plane",
            "RevRevJoint" => return self.link(joint, ["revolute", "revolute"]),
            "RevCylJoint" => return self.link(joint, ["revolute", "cylindrical"]),
            "CylSphJoint" => return self.link(joint, ["cylindrical", "spherical"]),
            "GearJoint" | "RackPinionJoint" | "ScrewJoint" => return,
            contact if contact.ends_with("Contact") => {
                let why = "contacts have no equivalent: a driver fixes the motion instead";
                self.notes.refused(contact, joint.name(), Some(joint.at), why);
                return;
            }
            _ => {
                let why = "its type is unknown";
                self.notes.refused(joint.text, joint.name(), Some(joint.at), why);
                return;
            }
        };
        let Some([i, j]) = self.pair(joint) else { return };
        let number = match kind {
            "distance" => self.rod(joint, source, [i, j]),
            "angle" if i.z().cross(j.z()).norm() > 1e-6 && i.body != j.body => {
                Some(self.angle(joint, source, [i, j]))
            }
            "angle" => join(&mut self.m, self.notes, source, "parallel", [i, j]),
            // The origin of marker J stays in a plane perpendicular to z of marker I, at the distance `offset`.
            "planar" | "inplane" | "line_in_plane" => {
                let offset = self.specified(joint, "offset").unwrap_or(0.0);
                let i = Marker { body: i.body, pose: Pose { r: i.pose.r + i.z() * offset, ..i.pose } };
                if kind == "line_in_plane" {
                    join(&mut self.m, self.notes, source, "dot1", [i, j]);
                    join(&mut self.m, self.notes, source, "inplane", [i, j])
                } else {
                    join(&mut self.m, self.notes, source, kind, [i, j])
                }
            }
            _ => join(&mut self.m, self.notes, source, kind, [i, j]),
        };
        let Some(number) = number else { return };
        self.joints.insert(joint.name().to_owned(), MarkerJoint { number, kind, markers: [i, j] });
    }

    /// Number that a joint specifies.
    fn specified(&mut self, joint: &Node<'_>, key: &str) -> Option<f64> {
        joint.child(key).and_then(|_| joint.numbers::<1>(key, self.notes)).map(|[x]| x)
    }

    /// Adds a rod between the origins of two markers.
    fn rod(&mut self, joint: &Node<'_>, source: ElementSource<'_>, [i, j]: [Marker; 2]) -> Option<usize> {
        let note = source.note(self.notes);
        let mut rod = Joint::new(joint.name(), note, "distance", [i.body, j.body], i.pose.r)
            .between(i.pose.r, j.pose.r);
        let nominal = (j.pose.r - i.pose.r).norm();
        let length = self.specified(joint, "distanceIJ").unwrap_or(nominal);
        let why = if nominal == 0.0 || i.body == j.body {
            "its markers coincide, or are on the same body"
        } else if length <= 0.0 {
            "its length is zero: use a ball joint"
        } else {
            ""
        };
        if !why.is_empty() {
            self.notes.refused(joint.text, joint.name(), Some(joint.at), why);
            return None;
        }
        if !equals_nominal(&self.m, length, nominal) {
            rod.length = Some(length);
        }
        self.notes.taken(joint.text, joint.name(), Some(joint.at));
        Some(self.m.joint(rod))
    }

    /// Adds a constant angle between the z axes of two markers.
    fn angle(&mut self, joint: &Node<'_>, source: ElementSource<'_>, [i, j]: [Marker; 2]) -> usize {
        let nominal = i.z().dot(j.z()).clamp(-1.0, 1.0).acos();
        let note = source.note(self.notes);
        let angle =
            Joint::new(joint.name(), note, "angle", [i.body, j.body], i.pose.r).with_axes(i.z(), j.z());
        match self.specified(joint, "theIzJz").filter(|a| (a.cos() - nominal.cos()).abs() > 1e-6) {
            Some(specified) => {
                let why = format!(
                    "specified as {specified} rad, but {nominal} rad in the design configuration, which is used"
                );
                self.notes.approximated(joint.text, joint.name(), Some(joint.at), why);
            }
            None => self.notes.taken(joint.text, joint.name(), Some(joint.at)),
        }
        self.m.joint(angle)
    }

    /// Adds a joint that represents a massless link between two markers.
    fn link(&mut self, joint: &Node<'_>, kinds: [&'static str; 2]) {
        let Some(markers) = self.pair(joint) else { return };
        let source = ElementSource { kind: joint.text, name: joint.name(), at: Some(joint.at) };
        let distance = joint.child("distanceIJ").and_then(|_| joint.numbers::<1>("distanceIJ", self.notes));
        join_by_link(&mut self.m, self.notes, source, kinds, markers, distance.map(|[d]| d));
    }

    /// Adds a screw, a single constraint: 2 pi z = pitch * angle, of marker J relative to marker I. Other joints guide
    /// the parts.
    fn screw(&mut self, joint: &Node<'_>) {
        let Some([i, j]) = self.pair(joint) else { return };
        let source = ElementSource { kind: joint.text, name: joint.name(), at: Some(joint.at) };
        let Some(pitch) = joint.numbers::<1>("pitch", self.notes).map(|[p]| p).filter(|p| *p != 0.0) else {
            let message = format!("the screw `{}` has no pitch", joint.name());
            let help = "give it a non-zero `pitch`";
            self.notes.problem_with("HP0804", Some(joint.at), message, help);
            return;
        };
        let joints: Vec<MarkerJoint> = self.joints.values().copied().collect();
        if couple_screw(&mut self.m, self.notes, source, &joints, [i, j], pitch).is_none()
            && let Some(number) = join(&mut self.m, self.notes, source, "screw", [i, j])
        {
            self.m.joints[number].lead = Some(pitch);
            self.joints
                .insert(joint.name().to_owned(), MarkerJoint { number, kind: "screw", markers: [i, j] });
        }
    }

    /// Adds gears, or a rack and pinion, as couplers of the joints that carry their parts.
    fn gear(&mut self, joint: &Node<'_>) {
        let Some([i, j]) = self.pair(joint) else { return };
        let hinges = ["revolute", "cylindrical"];
        let note =
            ElementSource { kind: joint.text, name: joint.name(), at: Some(joint.at) }.note(self.notes);
        let radius = |reader: &mut Self, key: &str| {
            joint.numbers::<1>(key, reader.notes).map(|[r]| r).filter(|r| *r != 0.0)
        };
        let terms = if joint.text == "GearJoint" {
            let radii = [radius(self, "radiusI"), radius(self, "radiusJ")];
            let [a, b] = [i, j].map(|m| {
                carrying_joint(self.joints.values(), m.body, &hinges, m.z())
                    .map(|k| (k.number, coordinate_sign(k, m.body, i.z())))
            });
            match (radii, a, b) {
                ([Some(ri), Some(rj)], Some((a, u)), Some((b, v))) if a != b => Some(vec![
                    (Coordinate { joint: a, name: "angle" }, ri * u),
                    (Coordinate { joint: b, name: "angle" }, rj * v),
                ]),
                _ => None,
            }
        } else {
            let radius = radius(self, "pitchRadius");
            // The rack moves by s along the x axis of marker I, the pinion turns about the z axis of marker J: s = r
            // angle.
            let slide =
                carrying_joint(self.joints.values(), i.body, &["translational", "cylindrical"], i.x());
            let hinge = carrying_joint(self.joints.values(), j.body, &hinges, j.z());
            match (radius, slide, hinge) {
                (Some(r), Some(slide), Some(hinge)) => Some(vec![
                    (
                        Coordinate { joint: slide.number, name: "displacement" },
                        coordinate_sign(slide, i.body, i.x()),
                    ),
                    (
                        Coordinate { joint: hinge.number, name: "angle" },
                        -r * coordinate_sign(hinge, j.body, j.z()),
                    ),
                ]),
                _ => None,
            }
        };
        match terms {
            Some(terms) => {
                self.m.coupler(joint.name(), note, terms);
                let why = "imported as a coupler of the joints that carry its two parts";
                self.notes.approximated(joint.text, joint.name(), Some(joint.at), why);
            }
            None => {
                let why = "it has no radii, or no joints along the axes of its markers carry its parts";
                self.notes.refused(joint.text, joint.name(), Some(joint.at), why);
            }
        }
    }

    fn motions(&mut self, assembly: &Node<'_>) {
        let sets = assembly.child("ConstraintSets");
        let motions = sets.and_then(|c| c.child("Motions")).map_or(&[][..], |p| &p.children);
        for motion in motions {
            if let Err(why) = self.motion(motion) {
                self.notes.refused(
                    motion.text,
                    motion.name(),
                    Some(motion.at),
                    format!("{why}; the motion is not imported"),
                );
                self.m.lost_motions += 1;
            }
        }
    }

    fn motion(&mut self, motion: &Node<'_>) -> Result<(), String> {
        let (key, name) = match motion.text {
            "RotationalMotion" => ("RotationZ", "angle"),
            "TranslationalMotion" => ("TranslationZ", "displacement"),
            "GeneralMotion" => return self.general(motion),
            _ => return Err("its type is unknown".into()),
        };
        let (path, at) = motion.value("MotionJoint").unwrap_or(("", motion.at));
        let wanted = path.rsplit('/').next().unwrap_or_default();
        let found = if path.is_empty() { self.between(motion)? } else { self.joints.get(wanted).copied() };
        let Some(joint) = found else {
            if path.is_empty() {
                return Ok(());
            }
            if self.notes.report.of(crate::ElementOutcome::Refused).any(|e| e.name == wanted) {
                return Err(format!("the joint `{wanted}` is not supported"));
            }
            let message = format!("`{}` drives the joint `{path}`, which does not exist", motion.name());
            self.notes.problem_with(
                "HP0803",
                Some(at),
                message,
                "name a joint by its path, as in `/Assembly/Joint`",
            );
            return Ok(());
        };
        let Some((function, _)) = motion.value(key) else { return Err(format!("it has no `{key}`")) };
        let kind = hardpoint::joint::ALL.iter().find(|k| k.name == joint.kind);
        if !kind.is_some_and(|k| k.coordinates.iter().any(|c| c.name == name)) {
            return Err(format!("a joint of type {} has no {name}", joint.kind));
        }
        let coordinate = Coordinate { joint: joint.number, name };
        if self.m.is_driven(coordinate) {
            return Err("the joint is driven already".into());
        }
        let turns = name == "angle";
        let nominal = offset(&joint.markers[0], &joint.markers[1]);
        let nominal = if turns { nominal.angle } else { nominal.displacement };
        let text = relative_to_nominal(&law::translate(function, Language::Ondsel)?, nominal, turns);
        let law = if law::constant(&text) == Some(0.0) { Law::Fixed } else { Law::Text(text) };
        let note =
            ElementSource { kind: motion.text, name: motion.name(), at: Some(motion.at) }.note(self.notes);
        self.m.driver(motion.name(), note, Drives::Coordinate(coordinate), law);
        self.notes.taken(motion.text, motion.name(), Some(motion.at));
        Ok(())
    }

    /// Adds a motion that prescribes all six coordinates of marker J relative to marker I.
    fn general(&mut self, motion: &Node<'_>) -> Result<(), String> {
        let text = |key: &str| -> Result<String, String> {
            let (function, _) = motion.value(key).ok_or_else(|| format!("it has no `{key}`"))?;
            law::translate(function, Language::Ondsel)
        };
        let displacements = [text("rIJI1")?, text("rIJI2")?, text("rIJI3")?];
        let angles = [text("angIJJ1")?, text("angIJJ2")?, text("angIJJ3")?];
        let order = match motion.child("RotationOrder") {
            Some(_) => motion.numbers::<3>("RotationOrder", self.notes).unwrap_or([1.0, 2.0, 3.0]),
            None => [1.0, 2.0, 3.0],
        };
        let axis = order.map(|x| [1.0, 2.0, 3.0].iter().position(|k| *k == x));
        let [Some(a), Some(b), Some(c)] = axis else {
            return Err("its `RotationOrder` is not a sequence of axes 1 to 3".into());
        };
        let Some(markers) = self.pair(motion) else { return Ok(()) };
        let [p, q, r] = angles;
        let source = ElementSource { kind: motion.text, name: motion.name(), at: Some(motion.at) };
        chain::drive(&mut self.m, self.notes, source, markers, displacements, [(a, p), (b, q), (c, r)])
    }

    /// Returns the joint between the markers of a motion that names no joint.
    fn between(&mut self, motion: &Node<'_>) -> Result<Option<MarkerJoint>, String> {
        let Some([i, j]) = self.pair(motion) else { return Ok(None) };
        let same = |a: &Marker, b: &Marker| a.body == b.body && a.pose == b.pose;
        let found = self.joints.values().find(|k| same(&k.markers[0], &i) && same(&k.markers[1], &j));
        found.copied().map(Some).ok_or_else(|| "no joint connects its two markers".into())
    }

    /// Reads one end of the range of a joint coordinate.
    fn limit(&mut self, limit: &Node<'_>) -> Result<(), String> {
        let (of, is_angle) = match limit.text {
            "RotationLimit" => ("angle", true),
            "TranslationLimit" => ("displacement", false),
            _ => return Err("its type is unknown".into()),
        };
        let path = limit.value("MotionJoint").map_or("", |(path, _)| path);
        let wanted = path.rsplit('/').next().unwrap_or_default();
        let joint = self.joints.get(wanted).copied();
        let joint = joint.ok_or_else(|| format!("the joint `{path}` does not exist or is not supported"))?;
        let kind = hardpoint::joint::ALL.iter().find(|k| k.name == joint.kind);
        if !kind.is_some_and(|k| k.coordinates.iter().any(|c| c.name == of)) {
            return Err(format!("a joint of type {} has no {of}", joint.kind));
        }
        let bound = limit.value("Limit").and_then(|(word, _)| number(word));
        let bound = bound.ok_or("its `Limit` is not a number")?;
        let nominal = offset(&joint.markers[0], &joint.markers[1]);
        let bound = bound - if is_angle { nominal.angle } else { nominal.displacement };
        let end = match limit.value("Type").map_or("", |(word, _)| word) {
            "=>" | ">=" => 0,
            "=<" | "<=" => 1,
            other => return Err(format!("its type `{other}` is unknown")),
        };
        let limits = &mut self.m.joints[joint.number].limits;
        let k = limits.iter().position(|known| known.of == of).unwrap_or_else(|| {
            limits.push(JointLimit { of, range: [f64::NEG_INFINITY, f64::INFINITY] });
            limits.len() - 1
        });
        limits[k].range[end] = bound;
        Ok(())
    }

    fn rest(&mut self, assembly: &Node<'_>) {
        let sets = assembly.child("ConstraintSets");
        for limit in sets.and_then(|c| c.child("Limits")).map_or(&[][..], |p| &p.children) {
            match self.limit(limit) {
                Ok(()) => self.notes.taken(limit.text, limit.name(), Some(limit.at)),
                Err(why) => self.notes.refused(limit.text, limit.name(), Some(limit.at), why),
            }
        }
        for set in sets.and_then(|c| c.child("GeneralConstraintSets")).map_or(&[][..], |p| &p.children) {
            self.notes.refused(set.text, set.name(), Some(set.at), "general constraints have no equivalent");
        }
        if let Some(sets) = sets {
            self.unknown(sets, &["Joints", "Motions", "Limits", "GeneralConstraintSets"]);
        }
        for motion in sets.and_then(|c| c.child("Motions")).map_or(&[][..], |p| &p.children) {
            const OF_MOTIONS: [&str; 13] = [
                "Name",
                "MarkerI",
                "MarkerJ",
                "MotionJoint",
                "RotationZ",
                "TranslationZ",
                "rIJI1",
                "rIJI2",
                "rIJI3",
                "angIJJ1",
                "angIJJ2",
                "angIJJ3",
                "RotationOrder",
            ];
            self.unknown(motion, &OF_MOTIONS);
        }
        for force in assembly.child("ForceTorques").map_or(&[][..], |p| &p.children) {
            self.notes.ignored(force.text, Some(force.at));
        }
    }
}

/// Stored motion of a part.
struct StoredPart<'t> {
    path: &'t str,
    at: SourceSpan,
    /// Pose at each of the times; `None` if a number is missing.
    states: Option<Vec<StoredPose>>,
}

/// Returns the stored times and the series of the parts. Each line has the column of the input, followed by one column
/// per output time.
fn stored<'t>(lines: &[(&'t str, SourceSpan)], notes: &mut ImportLog) -> (Vec<f64>, Vec<StoredPart<'t>>) {
    let row = |line: &str| -> Vec<Option<f64>> { line.split_whitespace().skip(1).map(number).collect() };
    let nothing = (Vec::new(), Vec::new());
    let is_times = |l: &str| l.starts_with("Time") && !l.starts_with("TimeSeries");
    let Some((line, at)) = lines.iter().find(|(l, _)| is_times(l)) else { return nothing };
    let times = row(line);
    let skipped = times.iter().take_while(|t| t.is_none()).count();
    let times: Option<Vec<f64>> = times[skipped..].iter().copied().collect();
    let Some(times) = times.filter(|t| !t.is_empty()) else {
        notes.refused("TimeSeries", "", Some(*at), "its times are not numbers");
        return nothing;
    };
    let mut stored_parts = Vec::new();
    let mut k = 0;
    while k < lines.len() {
        let (head, at) = lines[k];
        k += 1;
        let Some(path) = head.strip_prefix("PartSeries") else { continue };
        let mut rows: BTreeMap<&str, Vec<Option<f64>>> = BTreeMap::new();
        while let Some((line, _)) = lines.get(k).filter(|(l, _)| !l.contains("Series")) {
            rows.insert(line.split_whitespace().next().unwrap_or_default(), row(line));
            k += 1;
        }
        let vector = |names: [&str; 3], step: usize| -> Option<Vec3> {
            let [x, y, z] = names.map(|n| rows.get(n).and_then(|r| r.get(step + skipped).copied().flatten()));
            Some([x?, y?, z?].into())
        };
        let state = |step| {
            let r = vector(["X", "Y", "Z"], step)?;
            let angles = vector(["Bryantx", "Bryanty", "Bryantz"], step)?;
            let rates = [
                ["VX", "VY", "VZ"],
                ["OmegaX", "OmegaY", "OmegaZ"],
                ["AX", "AY", "AZ"],
                ["AlphaX", "AlphaY", "AlphaZ"],
            ];
            Some(StoredPose {
                pose: Pose { rot: sequence("xyz", angles.to_array()), r },
                rates: rates.map(|names| vector(names, step)),
            })
        };
        stored_parts.push(StoredPart {
            path: path.trim(),
            at,
            states: (0..times.len()).map(state).collect(),
        });
    }
    (times, stored_parts)
}

/// Returns the stored motion of the bodies.
fn series(
    (times, parts_stored): (Vec<f64>, Vec<StoredPart<'_>>),
    m: &Mechanism,
    parts: &BTreeMap<String, usize>,
    notes: &mut ImportLog,
) -> Option<Series> {
    let mut series = Series { times, bodies: Vec::new() };
    for StoredPart { path, at, states } in parts_stored {
        match (parts.get(path).filter(|b| **b != GROUND), states) {
            (Some(body), Some(states)) => {
                series.bodies.push((m.bodies[*body].name.clone(), states));
                notes.taken("PartSeries", path, Some(at));
            }
            (Some(_), None) => notes.refused("PartSeries", path, Some(at), "it has a missing number"),
            (None, _) => notes.ignored("PartSeries", Some(at)),
        }
    }
    (!series.bodies.is_empty()).then_some(series)
}
