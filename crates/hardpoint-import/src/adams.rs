//! Adams/Solver datasets (`.adm`): parts, markers, joints, primitives, motions, couplers, gears.

mod functions;
mod loads;

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

use hardpoint::space::{Mat3, Pose, Vec3};

use crate::adams_keys;
use crate::adams_statement::{SEAM, Statement, dataset, number};
use crate::law::{self, Language};
use crate::markers::{
    Marker, MarkerJoint, carrying_joint, coordinate_sign, join, offset, relative_to_nominal,
};
use crate::mechanism::{Coordinate, Drives, GROUND, Law, Mechanism};
use crate::report::{ImportLog, SourceSpan};
use crate::turn::{from_z_and_x, home, sequence};
use crate::{Format, Input};

/// Adams/Solver format.
pub const FORMAT: Format = Format {
    name: "adams",
    about: "Adams/Solver dataset",
    endings: &["adm"],
    recognises: |text| {
        let statement = |l: &str, word: &str| {
            l.len() > word.len()
                && l.is_char_boundary(word.len())
                && l[..word.len()].eq_ignore_ascii_case(word)
        };
        text.lines().any(|l| statement(l.trim_start(), "PART/"))
            && text.lines().any(|l| statement(l.trim_start(), "MARKER/"))
    },
    read,
    binary: false,
};

fn read(source: &mut Input<'_>, notes: &mut ImportLog) -> Option<Mechanism> {
    let data = dataset(source.text);
    let statements = data.statements;
    report_repeated(&statements, notes);
    let (scale, length, time) = units(&statements, notes);
    let title = source.text.lines().next().unwrap_or_default();
    let title = title.split_once("model name:").map_or(source.stem, |(_, name)| name.trim());
    let m = Mechanism::new(if title.is_empty() { source.stem } else { title }, length, "rad");
    let mut reader = Reader {
        m,
        notes,
        scale,
        time,
        parts: BTreeMap::new(),
        markers: BTreeMap::new(),
        faulty: BTreeSet::new(),
        refused: BTreeSet::new(),
        unplaced: BTreeSet::new(),
        joints: BTreeMap::new(),
        splines: BTreeMap::new(),
        variables: BTreeMap::new(),
        used: BTreeSet::new(),
    };
    reader.parts(&statements);
    reader.markers(&statements);
    reader.constraints(&statements);
    reader.motions(&statements);
    let loads = reader.loads(&statements);
    reader.rest(&statements, &loads);
    for (at, line) in &data.unread {
        let why = format!("`{line}` is not a statement, which begins with its name and a slash");
        reader.notes.not_understood("line", "", Some(*at), why);
    }
    if !data.has_end {
        let at = SourceSpan { text: 0, start: source.text.len(), end: source.text.len() };
        reader.notes.approximated("END", "", Some(at), "the statement is missing: the file may be truncated");
    }
    if data.after_end.is_some() {
        let why = "the dataset ends before this line: it is not read, nor are the lines after it";
        reader.notes.refused("END", "", data.after_end, why);
    }
    let m = reader.m;
    (m.bodies.len() > 1).then_some(m)
}

/// Reports statements of a kind with the same identifier, and statements without one. Each would replace the one before
/// it.
fn report_repeated(statements: &[Statement], notes: &mut ImportLog) {
    /// Statements without an identifier, of which a dataset has one.
    const SINGLE: [&str; 2] = ["UNITS", "ACCGRAV"];
    let mut known = BTreeSet::new();
    for s in statements.iter().filter(|s| adams_keys::is_statement(&s.name)) {
        let is_single = SINGLE.contains(&s.name.as_str());
        if s.id.is_empty() && !is_single {
            if adams_keys::of(&s.name).is_some() {
                let message = format!("the statement {} has no identifier", s.name);
                notes.problem_with(
                    "HP0803",
                    Some(s.at),
                    message,
                    "write it behind the slash, as in `PART/2`",
                );
            }
            continue;
        }
        let id = if is_single { s.name.clone() } else { format!("{}/{}", s.name, s.id) };
        if !known.insert(id.clone()) {
            notes.problem("HP0803", Some(s.at), format!("{id} is defined twice"));
        }
    }
}

/// Returns the factor of lengths, the length unit of the model, and the time of functions in seconds.
fn units(statements: &[Statement], notes: &mut ImportLog) -> (f64, &'static str, &'static str) {
    let mut out = (1.0, "mm", "t");
    let Some(units) = statements.iter().find(|s| s.name == "UNITS") else {
        notes.approximated(
            "UNITS",
            "",
            None,
            "the statement is missing: lengths are assumed to be in millimetres",
        );
        return out;
    };
    let at = Some(units.at);
    match units.text("SYSTEM").map(str::to_ascii_uppercase).as_deref() {
        Some("MKS" | "SI") => out = (1.0, "m", "t"),
        Some("CGS") => out = (1.0, "cm", "t"),
        Some("IPS") => out = (1.0, "in", "t"),
        Some("FPS") => out = (12.0, "in", "t"),
        _ => {}
    }
    if let Some(word) = units.text("LENGTH") {
        let known = match word.to_ascii_uppercase().trim_end_matches('S') {
            "MILLIMETER" | "MILLIMETRE" | "MM" => Some((1.0, "mm")),
            "CENTIMETER" | "CM" => Some((1.0, "cm")),
            "METER" | "METRE" | "M" => Some((1.0, "m")),
            "KILOMETER" | "KM" => Some((1000.0, "m")),
            "MICROMETER" | "UM" => Some((1e-3, "mm")),
            "INCH" | "INCHE" | "IN" => Some((1.0, "in")),
            "FOOT" | "FEET" | "FT" => Some((12.0, "in")),
            "YARD" => Some((36.0, "in")),
            "MILE" => Some((63_360.0, "in")),
            _ => None,
        };
        match known {
            Some((scale, unit)) => (out.0, out.1) = (scale, unit),
            None => notes.problem("HP0804", at, format!("`{word}` is not a known unit of length")),
        }
    }
    match units.text("TIME").unwrap_or("SECOND").to_ascii_uppercase().as_str() {
        "SECOND" | "SEC" | "S" => {}
        "MILLISECOND" | "MS" => out.2 = "(1000*t)",
        "MICROSECOND" => out.2 = "(1000000*t)",
        "MINUTE" | "MIN" => out.2 = "(t/60)",
        "HOUR" => out.2 = "(t/3600)",
        word => notes.problem("HP0804", at, format!("`{word}` is not a known unit of time")),
    }
    notes.taken("UNITS", "", at);
    out
}

/// Integrates a rate of order 1 or 2 over the first second and returns points `[time, displacement]`. Uses Simpson's
/// rule with steps much shorter than the distance of the points.
fn integrate_rate(
    text: &str,
    order: usize,
    scale: f64,
    begin: f64,
    rate: f64,
) -> Result<Vec<[f64; 2]>, String> {
    const POINTS: usize = 200;
    const STEPS: usize = 10;
    let law = hardpoint::law::Law::parse(text).map_err(|_| format!("`{text}` cannot be evaluated"))?;
    let at = |t: f64| scale * law.at(t).0[0];
    let h = 1.0 / (POINTS * STEPS) as f64;
    let (mut x, mut v) = (begin, rate);
    let mut points = vec![[0.0, begin]];
    for k in 0..POINTS * STEPS {
        let t = k as f64 * h;
        let [a, b, c] = [at(t), at(t + h / 2.0), at(t + h)];
        if order == 1 {
            x += h / 6.0 * (a + 4.0 * b + c);
        } else {
            x += h * v + h * h / 6.0 * (a + 2.0 * b);
            v += h / 6.0 * (a + 4.0 * b + c);
        }
        if (k + 1) % STEPS == 0 {
            points.push([(k + 1) as f64 * h, x]);
        }
    }
    if points.iter().all(|p| p[1].is_finite()) {
        Ok(points)
    } else {
        Err("its rate is not finite at some time".into())
    }
}

/// Statements of the mechanism.
const DONE: [&str; 10] =
    ["PART", "POINT_MASS", "FLEX_BODY", "MARKER", "JOINT", "JPRIM", "MOTION", "COUPLER", "GEAR", "UNITS"];
/// Constraints without an equivalent, with their descriptions.
const CONSTRAINTS: [(&str, &str); 5] = [
    ("PTCV", "a point on a curve"),
    ("CVCV", "contact of curves"),
    ("PTSF", "a point on a surface"),
    ("GCON", "a constraint by an expression"),
    ("UCON", "a constraint by a subroutine"),
];
/// Forces without an equivalent: equilibria and loads depend on them, motions that drivers prescribe do not.
const FORCES: [&str; 12] = [
    "VFORCE", "GFORCE", "VTORQUE", "MFORCE", "NFORCE", "BEAM", "FIELD", "CBUSHING", "CONTACT", "TIRE",
    "FRICTION", "FE_LOAD",
];
/// Statements without effect on prescribed motions.
const IRRELEVANT: &[&str] = &[
    "ACCGRAV",
    "ADAMS",
    "GRAPHICS",
    "REQUEST",
    "MREQUEST",
    "OUTPUT",
    "RESULTS",
    "MATRIX",
    "ARRAY",
    "STRING",
    "VARIABLE",
    "SPLINE",
    "SFORCE",
    "SPRINGDAMPER",
    "BUSHING",
    "DIFF",
    "LSE",
    "GSE",
    "TFSISO",
    "SENSOR",
    "INTEGRATOR",
    "EQUILIBRIUM",
    "KINEMATICS",
    "IC",
    "PRINT",
    "DEBUG",
    "LIST",
    "SURFACE",
    "CURVE",
    "PINPUT",
    "POUTPUT",
    "PSTATE",
    "LINEAR",
    "SIMULATE",
    "PREFERENCES",
    "POINT",
    "PLANT_INPUT",
    "PLANT_OUTPUT",
    "CONTROL",
    "VTO",
    "VFO",
    "REQSAVE",
    "DYNAMICS",
    "ROAD",
    "FEMDATA",
    "END",
    "SAVE",
    "MATERIAL",
    "COMMAND",
];

struct Reader<'n> {
    m: Mechanism,
    notes: &'n mut ImportLog,
    scale: f64,
    time: &'static str,
    parts: BTreeMap<String, usize>,
    markers: BTreeMap<String, Marker>,
    /// Identifiers of markers with errors.
    faulty: BTreeSet<String>,
    /// Identifiers of joints that are not supported.
    refused: BTreeSet<String>,
    /// Identifiers of markers without a position in the file.
    unplaced: BTreeSet<String>,
    joints: BTreeMap<String, MarkerJoint>,
    splines: BTreeMap<String, Vec<[f64; 2]>>,
    /// Functions of VARIABLE statements, by identifier.
    variables: BTreeMap<String, String>,
    /// Names and identifiers of the statements that functions use.
    used: BTreeSet<(&'static str, String)>,
}

impl Reader<'_> {
    /// Reads a frame from its origin and its orientation: Euler angles, or points on its z and x axes.
    fn frame(&mut self, s: &Statement, origin: &str, along_z: &str, along_x: &str) -> Pose {
        let r = s.vector(origin, self.notes).unwrap_or_else(|| [0.0; 3].into());
        let by_angles = ["REULER", "EULER"].into_iter().find(|key| s.has(key));
        if let Some(key) = by_angles {
            let why = format!("the orientation of {}/{} is that of `{key}`", s.name, s.id);
            self.report_unread(s, &["EULER", along_z, along_x, "USEXP"], key, &why);
        }
        let angles = by_angles.and_then(|key| s.vector(key, self.notes));
        let rot = match angles {
            Some(a) => sequence("zxz", a.to_array()),
            None => {
                let [z, x] = [along_z, along_x].map(|key| s.vector(key, self.notes).map(|p| p - r));
                self.pointed(s, z, x)
            }
        };
        Pose { rot, r: r * self.scale }
    }

    /// Reports keys of a statement that are not read, since another one has the same meaning.
    fn report_unread(&mut self, s: &Statement, keys: &[&str], read: &str, why: &str) {
        for key in keys.iter().filter(|key| **key != read && s.has(key)) {
            self.notes.not_understood(key, &s.label, Some(s.at), why);
        }
    }

    /// Returns the orientation from a point on the z axis and a point in the xz plane. With `USEXP`, the x axis is
    /// exact instead.
    fn pointed(&mut self, s: &Statement, z: Option<Vec3>, x: Option<Vec3>) -> Mat3 {
        let found = match (z, x) {
            (None, None) => return home().rot,
            (Some(z), None) => {
                from_z_and_x(z, [1.0, 0.0, 0.0].into()).or_else(|| from_z_and_x(z, [0.0, 0.0, 1.0].into()))
            }
            (None, Some(x)) => {
                let away = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]].map(Vec3::from);
                away.iter().find_map(|z| {
                    let x = x.unit()?;
                    from_z_and_x(*z - x * x.dot(*z), x)
                })
            }
            (Some(z), Some(x)) if s.has("USEXP") => x.unit().and_then(|x| from_z_and_x(z - x * x.dot(z), x)),
            (Some(z), Some(x)) => from_z_and_x(z, x),
        };
        found.unwrap_or_else(|| {
            self.notes.problem(
                "HP0804",
                Some(s.at),
                format!("the points of {}/{} define no orientation: they are collinear", s.name, s.id),
            );
            home().rot
        })
    }

    fn parts(&mut self, statements: &[Statement]) {
        for s in statements {
            let kind = s.name.as_str();
            if !["PART", "POINT_MASS", "FLEX_BODY"].contains(&kind) {
                continue;
            }
            let id = format!("{kind}/{}", s.id);
            if s.has("GROUND") {
                self.parts.insert(id, GROUND);
                self.notes.taken(kind, &s.label, Some(s.at));
                continue;
            }
            let pose = self.frame(s, "QG", "ZG", "XG");
            let body = self.m.body(&s.label, s.source().note(self.notes), Some(pose));
            match kind {
                "FLEX_BODY" => self.notes.approximated(
                    kind,
                    &s.label,
                    Some(s.at),
                    "imported as a rigid body in its undeformed shape, without mass",
                ),
                "POINT_MASS" => {
                    self.notes.approximated(
                        kind,
                        &s.label,
                        Some(s.at),
                        "imported as a rigid body that does not rotate",
                    );
                    let never = crate::mechanism::Joint::new(
                        &format!("{}_upright", s.label),
                        "a point mass does not rotate".into(),
                        "orientation",
                        [GROUND, body],
                        pose.r,
                    );
                    self.m.joint(never);
                }
                _ => self.notes.taken(kind, &s.label, Some(s.at)),
            }
            self.parts.insert(id, body);
        }
    }

    fn markers(&mut self, statements: &[Statement]) {
        let mut part = None;
        for s in statements {
            if ["PART", "POINT_MASS", "FLEX_BODY"].contains(&s.name.as_str()) {
                part = self.parts.get(&format!("{}/{}", s.name, s.id)).copied();
            }
            if s.name != "MARKER" {
                continue;
            }
            let elastic = s.has("FE_PART") || (s.has("NODE_ID") && s.has("FLEX_BODY") && !s.has("QP"));
            if s.has("FLOATING") || elastic {
                let why = if s.has("FE_PART") {
                    "it is on an elastic part"
                } else {
                    "its position is not in the file"
                };
                self.notes.refused("MARKER", &s.label, Some(s.at), why);
                self.unplaced.insert(s.id.clone());
                continue;
            }
            let named =
                ["PART", "POINT_MASS", "FLEX_BODY"].iter().find_map(|kind| Some((*kind, s.reference(kind)?)));
            let body = match named {
                Some((kind, id)) => self.parts.get(&format!("{kind}/{id}")).copied(),
                None => part,
            };
            let Some(body) = body else {
                let what = named.map_or("no part precedes it".into(), |(kind, id)| format!("no {kind}/{id}"));
                self.faulty.insert(s.id.clone());
                self.notes.problem(
                    "HP0803",
                    Some(s.at),
                    format!("MARKER/{} is on an unknown part: {what}", s.id),
                );
                continue;
            };
            let inner = self.frame(s, "QP", "ZP", "XP");
            let outer = self.m.bodies[body].pose.unwrap_or_else(home);
            self.markers.insert(s.id.clone(), Marker { body, pose: outer.compose(inner) });
            self.notes.taken("MARKER", &s.label, Some(s.at));
        }
    }

    /// Returns the markers of a statement as bodies i and j: Adams' J first, relative to which Adams' I moves.
    fn pair(&mut self, s: &Statement) -> Option<[Marker; 2]> {
        let unplaced = |key: &&str| s.reference(key).is_some_and(|id| self.unplaced.contains(id));
        if let Some(key) = ["I", "J"].into_iter().find(unplaced) {
            let why = format!(
                "its marker {key}, MARKER/{}, has no position here",
                s.reference(key).unwrap_or_default()
            );
            self.notes.refused(&s.name, &s.label, Some(s.at), why);
            return None;
        }
        let mut found = Vec::new();
        for key in ["J", "I"] {
            let id = s.reference(key);
            match id.and_then(|id| self.markers.get(id)) {
                Some(marker) => found.push(*marker),
                // The marker has been reported.
                None if id.is_some_and(|id| self.faulty.contains(id)) => {}
                None => {
                    let what = id.map_or(format!("has no `{key}`"), |id| {
                        format!("names MARKER/{id} as `{key}`, which does not exist")
                    });
                    self.notes.problem("HP0803", Some(s.at), format!("{}/{} {what}", s.name, s.id));
                }
            }
        }
        <[Marker; 2]>::try_from(found).ok()
    }

    fn constraints(&mut self, statements: &[Statement]) {
        for s in statements {
            match s.name.as_str() {
                "JOINT" => {
                    self.joint(s);
                    if !self.joints.contains_key(&s.id) {
                        self.refused.insert(s.id.clone());
                    }
                }
                "JPRIM" => self.primitive(s),
                _ => {}
            }
        }
        for s in statements.iter().filter(|s| s.name == "JOINT" && s.has("RACKPIN")) {
            self.rack_and_pinion(s);
        }
    }

    fn joint(&mut self, s: &Statement) {
        const KINDS: [(&str, &str); 11] = [
            ("REVOLUTE", "revolute"),
            ("TRANSLATIONAL", "translational"),
            ("CYLINDRICAL", "cylindrical"),
            ("SPHERICAL", "spherical"),
            ("UNIVERSAL", "universal"),
            ("HOOKE", "universal"),
            ("PLANAR", "planar"),
            ("FIXED", "fixed"),
            ("CONVEL", "constant_velocity"),
            ("SCREW", "screw"),
            ("INLINE", "inline"),
        ];
        if s.has("RACKPIN") {
            return;
        }
        let Some((name, kind)) = KINDS.iter().find(|(name, _)| s.has(name)) else {
            self.notes.refused("JOINT", &s.label, Some(s.at), "its type is unknown");
            return;
        };
        let Some(mut markers) = self.pair(s) else { return };
        if *name == "HOOKE" {
            // The pins of the cross are x of I and y of J.
            let [j, i] = markers;
            let turned =
                |m: &Marker, z: Vec3| Pose { rot: from_z_and_x(z, m.z()).unwrap_or(m.pose.rot), r: m.pose.r };
            markers = [
                Marker { body: j.body, pose: turned(&j, j.y()) },
                Marker { body: i.body, pose: turned(&i, i.x()) },
            ];
        }
        let Some(number) = join(&mut self.m, self.notes, s.source(), kind, markers) else { return };
        if *kind == "screw" {
            match s.numbers("PITCH", self.notes).and_then(|p| p.first().copied()) {
                Some(pitch) if pitch != 0.0 => self.m.joints[number].lead = Some(pitch * self.scale),
                _ => self.notes.problem(
                    "HP0804",
                    Some(s.at),
                    format!("JOINT/{} is a screw without `PITCH`", s.id),
                ),
            }
        }
        self.joints.insert(s.id.clone(), MarkerJoint { number, kind, markers });
    }

    fn primitive(&mut self, s: &Statement) {
        const KINDS: [(&str, &str); 6] = [
            ("ATPOINT", "spherical"),
            ("INLINE", "inline"),
            ("INPLANE", "inplane"),
            ("ORIENTATION", "orientation"),
            ("PARALLEL_AXES", "parallel"),
            ("PERPENDICULAR", "dot1"),
        ];
        match KINDS.iter().find(|(name, _)| s.has(name)) {
            Some((_, kind)) => {
                if let Some(markers) = self.pair(s) {
                    join(&mut self.m, self.notes, s.source(), kind, markers);
                }
            }
            None => self.notes.refused("JPRIM", &s.label, Some(s.at), "its type is unknown"),
        }
    }

    /// Couples the slide of the rack with the hinge of the pinion; the contact follows from the positions of the
    /// markers.
    fn rack_and_pinion(&mut self, s: &Statement) {
        let Some([rack, pinion]) = self.pair(s) else { return };
        let diameter =
            s.numbers("PD", self.notes).and_then(|d| d.first().copied()).unwrap_or(0.0) * self.scale;
        let hinge =
            carrying_joint(self.joints.values(), pinion.body, &["revolute", "cylindrical"], pinion.z());
        let slide =
            carrying_joint(self.joints.values(), rack.body, &["translational", "cylindrical"], rack.z());
        let (Some(hinge), Some(slide)) = (hinge, slide) else {
            self.notes.refused("JOINT", &s.label, Some(s.at), "a rack and pinion requires a hinge of the pinion and a slide of the rack, along the z axes of the markers");
            return;
        };
        let arm = rack.pose.r - pinion.pose.r;
        let rolls = pinion.z().cross(arm).dot(rack.z());
        let turn = if rolls.abs() > 1e-9 * arm.norm() { rolls.signum() } else { 1.0 };
        let factor = turn
            * coordinate_sign(hinge, pinion.body, pinion.z())
            * coordinate_sign(slide, rack.body, rack.z())
            * diameter
            / 2.0;
        let terms = vec![
            (Coordinate { joint: slide.number, name: "displacement" }, 1.0),
            (Coordinate { joint: hinge.number, name: "angle" }, -factor),
        ];
        if diameter == 0.0 {
            self.notes.problem(
                "HP0804",
                Some(s.at),
                format!("JOINT/{} is a rack and pinion without a pitch diameter `PD`", s.id),
            );
        }
        self.m.coupler(&s.label, s.source().note(self.notes), terms);
        self.notes.approximated(
            "JOINT",
            &s.label,
            Some(s.at),
            "imported as a coupler of the rack's slide and the pinion's hinge; the markers define the contact",
        );
    }

    fn motions(&mut self, statements: &[Statement]) {
        for s in statements.iter().filter(|s| s.name == "SPLINE") {
            let lists = ["X", "Y"].map(|key| s.numbers(key, self.notes).unwrap_or_default());
            if lists[0].len() != lists[1].len() || s.keys.iter().filter(|(key, _)| key == "Y").count() > 1 {
                let why = "only splines with one y for each x in the file are supported";
                self.notes.refused("SPLINE", &s.label, Some(s.at), why);
                continue;
            }
            self.splines.insert(
                s.id.clone(),
                lists[0].iter().copied().zip(lists[1].iter().copied()).map(|(x, y)| [x, y]).collect(),
            );
        }
        for s in statements.iter().filter(|s| s.name == "VARIABLE") {
            if let Some(function) = s.text("FUNCTION") {
                self.variables.insert(s.id.clone(), function.to_owned());
            }
        }
        for s in statements {
            match s.name.as_str() {
                "MOTION" => self.motion(s),
                "COUPLER" => self.coupler(s),
                "GEAR" => self.gear(s),
                _ => {}
            }
        }
    }

    fn motion(&mut self, s: &Statement) {
        let refuse = |reader: &mut Self, why: &str| {
            reader.notes.refused(
                "MOTION",
                &s.label,
                Some(s.at),
                format!("{why}; the motion is not imported"),
            );
            reader.m.lost_motions += 1;
        };
        let order = if s.has("VELOCITY") { 1 } else { 2 * usize::from(s.has("ACCELERATION")) };
        let Some(function) = s.text("FUNCTION") else { return refuse(self, "it has no FUNCTION") };
        let function = self.expand_variables(function);
        if let Some(id) = s.reference("JOINT") {
            let why = format!("MOTION/{} drives a coordinate of JOINT/{id}", s.id);
            self.report_unread(s, &["I", "J", "X", "Y", "Z", "B1", "B2", "B3"], "JOINT", &why);
            let Some(joint) = self.joints.get(id) else {
                if self.refused.contains(id) {
                    return refuse(self, &format!("JOINT/{id} is not supported"));
                }
                self.notes.problem(
                    "HP0803",
                    Some(s.at),
                    format!("MOTION/{} drives JOINT/{id}, which does not exist", s.id),
                );
                return;
            };
            let nominal = offset(&joint.markers[0], &joint.markers[1]);
            let turns = s.has("ROTATIONAL") || (joint.kind == "revolute" && !s.has("TRANSLATIONAL"));
            let (name, nominal, scale) = if turns {
                ("angle", nominal.angle, 1.0)
            } else {
                ("displacement", nominal.displacement, self.scale)
            };
            let has = hardpoint::joint::ALL
                .iter()
                .find(|k| k.name == joint.kind)
                .is_some_and(|k| k.coordinates.iter().any(|c| c.name == name));
            let coordinate = Coordinate { joint: joint.number, name };
            if !has {
                return refuse(self, &format!("a joint of type {} has no {name}", joint.kind));
            }
            if self.m.is_driven(coordinate) {
                return refuse(self, "the joint is driven already");
            }
            let law = match order {
                0 => self.law(&function, scale, nominal, turns),
                _ => self.integral(s, &function, order, scale, nominal, turns),
            };
            match law {
                Ok(law) => {
                    self.m.driver(&s.label, s.source().note(self.notes), Drives::Coordinate(coordinate), law);
                    self.report_motion(s, order);
                }
                Err(why) => refuse(self, &why),
            }
            return;
        }
        let Some([j, i]) = self.pair(s) else { return };
        let axis = ["X", "Y", "Z"].iter().position(|k| s.has(k)).map(|k| j.pose.rot.cols[k]);
        match axis {
            Some(along) if j.body == GROUND && i.body != GROUND && order == 0 => {
                match self.law(&function, self.scale, along.dot(i.pose.r - j.pose.r), false) {
                    Ok(law) => {
                        self.m.driver(
                            &s.label,
                            s.source().note(self.notes),
                            Drives::Translation { body: i.body, at: i.pose.r, along },
                            law,
                        );
                        self.report_motion(s, order);
                    }
                    Err(why) => refuse(self, &why),
                }
            }
            _ => refuse(
                self,
                "only displacements of a marker relative to ground, prescribed by position, are supported between markers",
            ),
        }
    }

    /// Reports the motion of the last driver, whose function prescribes the derivative of this order.
    fn report_motion(&mut self, s: &Statement, order: usize) {
        let is_table = matches!(self.m.drivers.last().map(|d| &d.law), Some(Law::Table(_)));
        let why = match (is_table, order) {
            (false, _) => {
                self.notes.taken("MOTION", &s.label, Some(s.at));
                return;
            }
            (true, 0) => {
                "the spline of the model passes through the same points, but is another one between them: \
                 its curvature is continuous, and zero at both ends"
            }
            (true, _) => "its rate is integrated over the first second and interpolated by a spline",
        };
        self.notes.approximated("MOTION", &s.label, Some(s.at), why);
    }

    /// Expands references to variables (`VARVAL(3)`) in a function. Recursive references remain.
    fn expand_variables(&mut self, function: &str) -> String {
        const DEEPEST: usize = 8;
        const LONGEST: usize = 100_000;
        let mut text = function.to_owned();
        for _ in 0..DEEPEST {
            // Upper-case forms of non-ASCII letters can differ in length.
            let Some(start) = text.to_ascii_uppercase().find("VARVAL") else { break };
            let inner = text[start..].find('(').zip(text[start..].find(')'));
            let Some((open, close)) = inner.filter(|(open, close)| open < close) else { break };
            let id =
                text[start + open + 1..start + close].trim_matches(|c: char| c.is_whitespace() || c == SEAM);
            let Some(own) = self.variables.get(id).filter(|f| f.len() + text.len() < LONGEST) else { break };
            let own = format!("({own})");
            self.used.insert(("VARIABLE", id.to_owned()));
            text.replace_range(start..=start + close, &own);
        }
        text
    }

    /// Converts a function to the law of a coordinate, relative to the design configuration.
    fn law(&mut self, function: &str, scale: f64, nominal: f64, turns: bool) -> Result<Law, String> {
        let nominal = if nominal.abs() < 1e-12 { 0.0 } else { nominal };
        let time = self.time;
        let translated = |text: &str| {
            let text = text.trim().trim_matches(['\'', '"']);
            law::translate_with(text, Language::Adams, time)
        };
        // The comma at the beginning of a continuation line either marks the continuation or is part of the function.
        let readings = [" ", ","].map(|seam| function.replace(SEAM, seam));
        if let Some(points) = readings.iter().find_map(|text| self.through_spline(text)) {
            return Ok(Law::Table(points.iter().map(|[t, x]| [*t, x * scale - nominal]).collect()));
        }
        let text = translated(&readings[0]).or_else(|why| translated(&readings[1]).map_err(|_| why))?;
        let text = if scale == 1.0 { text } else { format!("{scale}*({text})") };
        let text = relative_to_nominal(&text, nominal, turns);
        if law::constant(&text) == Some(0.0) { Ok(Law::Fixed) } else { Ok(Law::Text(text)) }
    }

    /// Law of a prescribed velocity (order 1) or acceleration (order 2): an expression if the rate is constant,
    /// otherwise a table.
    fn integral(
        &mut self,
        s: &Statement,
        function: &str,
        order: usize,
        scale: f64,
        nominal: f64,
        turns: bool,
    ) -> Result<Law, String> {
        let function = function.replace(SEAM, " ");
        let text =
            law::translate_with(function.trim().trim_matches(['\'', '"']), Language::Adams, self.time)?;
        let mut first = |key: &str| s.numbers(key, self.notes).and_then(|list| list.first().copied());
        // The initial value is that of ICDISP, or otherwise that of the design configuration.
        let [start, rate] = [first("ICDISP"), first("ICVEL")];
        let per_second = self.per_second().powi(order as i32);
        let begin = start.map_or(0.0, |x| x * scale - nominal);
        let rate = if order == 2 { rate.unwrap_or(0.0) * scale * self.per_second() } else { 0.0 };
        let Some(constant) = law::constant(&text).map(|x| x * scale * per_second) else {
            let begin = if turns { begin - (begin / TAU).round() * TAU } else { begin };
            return integrate_rate(&text, order, scale * per_second, begin, rate).map(Law::Table);
        };
        // x = x0 + v t, or x0 + v t + a/2 t^2
        let text =
            if order == 1 { format!("{constant}*t") } else { format!("{rate}*t + {}*t^2", constant / 2.0) };
        Ok(if begin == 0.0 { Law::Text(text) } else { Law::Text(relative_to_nominal(&text, -begin, turns)) })
    }

    /// Number of time units of the source per second.
    fn per_second(&self) -> f64 {
        law::translate_with("time", Language::Adams, self.time)
            .ok()
            .and_then(|t| hardpoint::law::Law::parse(&t).ok())
            .map_or(1.0, |law| law.at(1.0).0[0])
    }

    /// Returns the points of a function that is linear in a spline of the time, such as `a*AKISPL(TIME, 0, id) + b`.
    fn through_spline(&mut self, function: &str) -> Option<Vec<[f64; 2]>> {
        let lower = function.to_ascii_lowercase();
        let start = ["akispl", "cubspl", "intspl"].iter().find_map(|name| lower.find(name))?;
        let open = start + lower[start..].find('(')?;
        let close = open + lower[open..].find(')')?;
        let arguments: Vec<&str> = lower[open + 1..close].split(',').map(str::trim).collect();
        let is_zero = |k: usize| arguments.get(k).is_none_or(|a| number(a) == Some(0.0));
        if arguments.first() != Some(&"time")
            || self.time != "t"
            || arguments.len() < 3
            || !is_zero(1)
            || !is_zero(3)
        {
            return None;
        }
        let points = self.splines.get(arguments[2])?;
        if points.len() < 3 || points.windows(2).any(|w| w[1][0] <= w[0][0]) {
            return None;
        }
        let [at_0, at_1, at_2] = ["(0)", "(1)", "(2)"].map(|x| {
            let text = format!("{}{x}{}", &lower[..start], &lower[close + 1..]);
            law::constant(&law::translate_with(&text, Language::Adams, "t").ok()?)
        });
        let (b, a) = (at_0?, at_1? - at_0?);
        if (at_2? - b - 2.0 * a).abs() > 1e-12 * (a.abs() + b.abs()) {
            return None;
        }
        let points = points.iter().map(|[t, x]| [*t, a * x + b]).collect();
        self.used.insert(("SPLINE", arguments[2].to_owned()));
        Some(points)
    }

    fn coupler(&mut self, s: &Statement) {
        if s.has("FUNCTION") || s.has("ROUTINE") {
            let why = "its subroutine is not in the file";
            self.notes.refused("COUPLER", &s.label, Some(s.at), why);
            return;
        }
        let names: Vec<&str> =
            s.text("JOINTS").unwrap_or_default().split([',', ':', SEAM]).map(str::trim).collect();
        let scales = s.numbers("SCALES", self.notes).unwrap_or_default();
        let kinds: String = s.text("TYPE").unwrap_or_default().to_ascii_uppercase();
        let kinds: Vec<&str> =
            kinds.split([':', ',', SEAM]).map(str::trim).filter(|k| !k.is_empty()).collect();
        for (count, what) in [(scales.len(), "scales"), (kinds.len(), "types")] {
            // Without types, those of the joints apply.
            if count != names.len() && (count > 0 || what == "scales") {
                let message = format!("COUPLER/{} has {} joints and {count} {what}", s.id, names.len());
                self.notes.problem("HP0804", Some(s.at), message);
                return;
            }
        }
        let mut terms = Vec::new();
        for ((k, id), scale) in names.iter().enumerate().zip(scales) {
            let Some(joint) = self.joints.get(*id) else {
                if self.refused.contains(*id) {
                    let why = format!("JOINT/{id} is not supported");
                    self.notes.refused("COUPLER", &s.label, Some(s.at), why);
                    return;
                }
                self.notes.problem(
                    "HP0803",
                    Some(s.at),
                    format!("COUPLER/{} names JOINT/{id}, which does not exist", s.id),
                );
                return;
            };
            let turns = match kinds.get(k) {
                Some(kind) => kind.starts_with('R'),
                None => joint.kind == "revolute",
            };
            let name = if turns { "angle" } else { "displacement" };
            // Scales refer to lengths of the source; angles are in rad on both sides.
            let factor = if turns { scale } else { scale / self.scale };
            terms.push((Coordinate { joint: joint.number, name }, factor));
        }
        self.m.coupler(&s.label, s.source().note(self.notes), terms);
        self.notes.taken("COUPLER", &s.label, Some(s.at));
    }

    /// Adds a gear: both joints have the same velocity of the common point (marker CV) along its z axis.
    fn gear(&mut self, s: &Statement) {
        let names: Vec<&str> =
            s.text("JOINTS").unwrap_or_default().split([',', ':', SEAM]).map(str::trim).collect();
        let cv = s.reference("CV").and_then(|id| self.markers.get(id)).copied();
        let joints: Vec<&MarkerJoint> = names.iter().filter_map(|id| self.joints.get(*id)).collect();
        let (Some(cv), [a, b], 2) = (cv, &joints[..], names.len()) else {
            if names.iter().any(|id| self.refused.contains(*id)) {
                self.notes.refused("GEAR", &s.label, Some(s.at), "one of its joints is not supported");
                return;
            }
            self.notes.problem(
                "HP0803",
                Some(s.at),
                format!("GEAR/{} requires two existing JOINTS and an existing marker CV", s.id),
            );
            return;
        };
        let speed = |k: &MarkerJoint| {
            // Velocity of the gear relative to the carrier.
            let sign = if k.markers[1].body == cv.body { -1.0 } else { 1.0 };
            let z = k.markers[0].z();
            let slides = k.kind == "translational";
            let v = if slides { z } else { z.cross(cv.pose.r - k.markers[0].pose.r) };
            (
                Coordinate { joint: k.number, name: if slides { "displacement" } else { "angle" } },
                sign * v.dot(cv.z()),
            )
        };
        let [(first, u), (second, v)] = [speed(a), speed(b)];
        if u == 0.0 || v == 0.0 {
            self.notes.refused(
                "GEAR",
                &s.label,
                Some(s.at),
                "one of its joints does not move the marker CV along its z axis",
            );
            return;
        }
        self.m.coupler(&s.label, s.source().note(self.notes), vec![(first, u), (second, -v)]);
        self.notes.taken("GEAR", &s.label, Some(s.at));
    }

    /// Reports the keys of a statement that the reader does not know. These may affect the motion. Returns true if
    /// there are any.
    fn unknown_keys(&mut self, s: &Statement) -> bool {
        // The other keys of a flexible body belong to its deformation, which is not imported.
        let Some(known) = adams_keys::of(&s.name).filter(|_| s.name != "FLEX_BODY") else {
            return false;
        };
        for flags in adams_keys::exclusive_flags(&s.name) {
            let own: Vec<&str> = flags.iter().copied().filter(|flag| s.has(flag)).collect();
            if own.len() > 1 {
                let list = own.join(", ");
                let message = format!("{}/{} has flags that exclude each other: {list}", s.name, s.id);
                self.notes.problem_with("HP0805", Some(s.at), message, "remove all but one of them");
            }
        }
        let mut found = false;
        let mut read = BTreeSet::new();
        for (key, value) in &s.keys {
            let key = key.trim_matches(|c: char| !c.is_ascii_alphanumeric() && c != '_');
            // Splines of two variables are refused as such.
            let may_repeat = s.name == "SPLINE" && key == "Y";
            if known.is_value(key) && !value.is_empty() && !read.insert(key) && !may_repeat {
                let why = format!("{}/{} has a second `{key}`, which is not read", s.name, s.id);
                self.notes.not_understood(key, &s.label, Some(s.at), why);
                found = true;
                continue;
            }
            let zero = value.split([',', SEAM]).all(|w| number(w.trim()) == Some(0.0));
            if ["ICTRAN", "ICROT", "IC"].contains(&key) {
                if !zero {
                    let why =
                        "the initial condition is not imported: the model begins in the design configuration";
                    self.notes.refused(key, &s.label, Some(s.at), why);
                }
                continue;
            }
            let is_flag = value.is_empty();
            if key.is_empty() || known.named(key, is_flag).is_some() {
                continue;
            }
            let why = match &known.meant(key, is_flag)[..] {
                [] => format!("`{}` has an unknown key `{key}`", s.name),
                meant => format!("the key `{key}` of `{}` is ambiguous: {}", s.name, meant.join(", ")),
            };
            self.notes.not_understood(key, &s.label, Some(s.at), why);
            found = true;
        }
        found
    }

    /// Reports all statements that are neither part of the mechanism nor forces.
    fn rest(&mut self, statements: &[Statement], loads: &BTreeSet<(String, String)>) {
        let are_unknown: Vec<bool> = statements.iter().map(|s| self.unknown_keys(s)).collect();
        let is_read = |s: &Statement| {
            DONE.contains(&s.name.as_str()) || loads.contains(&(s.name.clone(), s.id.clone()))
        };
        for (s, is_unknown) in statements.iter().zip(are_unknown).filter(|(s, _)| !is_read(s)) {
            if s.name == "FE_PART" {
                let why = "elastic parts are not supported, nor are joints on them";
                self.notes.refused(&s.name, &s.label, Some(s.at), why);
            } else if FORCES.contains(&s.name.as_str()) {
                let why = "the force has no equivalent: motions in which drivers prescribe all positions are the same without it, \
                           but not loads and equilibria";
                self.notes.refused(&s.name, &s.label, Some(s.at), why);
            } else if let Some((_, what)) = CONSTRAINTS.iter().find(|(name, _)| *name == s.name) {
                let why = format!(
                    "{what} has no equivalent and is not imported: motions that nothing else drives or constrains \
                     get drivers, which are listed as `motion`"
                );
                self.notes.refused(&s.name, &s.label, Some(s.at), why);
            } else if IRRELEVANT.contains(&s.name.as_str()) {
                // Unknown keys and unsupported splines have been reported.
                let is_refused = s.name == "SPLINE" && !self.splines.contains_key(&s.id);
                if self.used.iter().any(|(name, id)| *name == s.name && *id == s.id) {
                    self.notes.taken(&s.name, &s.label, Some(s.at));
                } else if !is_unknown && !is_refused {
                    self.notes.ignored(&s.name, Some(s.at));
                }
            } else {
                let why = "unknown statement";
                self.notes.not_understood(&s.name, &s.label, Some(s.at), why);
            }
        }
    }
}
