//! Reads the tables of a model file into a draft, one function per table.

mod cases;
mod couplers;
mod data;
mod design;
mod drivers;
mod elements;
pub(crate) mod include;
mod law;
pub(crate) mod measured;
mod mesh;
pub(crate) mod mirror;
mod optimize;
mod parameters;
pub(crate) mod planar;
mod results;
pub(crate) mod sweep;
mod tolerance;
mod wheels;

use std::collections::HashMap;
use std::ops::Range;

use hardpoint::draft::{
    BodyDraft, CurveDraft, DirectionDraft, Draft, FormulaDraft, FormulaOf, FrameDraft, HardpointDraft,
    JointDraft, LocationDraft, Nominal, Section,
};
use hardpoint::joint::{self, Freedom, JointType, Quantity};
use hardpoint::law::Law;
use hardpoint::model::{ChangePointPolicy, LoadMode};
use hardpoint::space::{Angles, Pose, Quat, Vec3};
use toml::de::{DeTable, DeValue};

use crate::diagnostic::{closest, shown};
use crate::drawing::{Appearance, FORMS, Form};
use crate::format::{self, ANGLE, HARDPOINT, Key, Kinds, LENGTH, NUMBER, Need, Shape, Table, table};
use crate::places::{EntryPlace, Places};
use crate::tree::{Field, Fields, LINE, MOST_ENTRIES, PLACE, Reader, Subject, Value, above_tables, quoted};
use hardpoint_table::{AngleUnit, LengthUnit};

pub(crate) use elements::weightless;
pub(crate) use mesh::BodyMesh;
pub use mesh::triangles;

/// The axis of a marker that a joint's `axis` is.
const ALONG_AXIS: usize = 2;
/// The file as a whole.
pub(crate) const MODEL: Table = table! {
    /// A mechanism for Hardpoint.
    "Hardpoint model":
    /// Name of the mechanism, for headings.
    must "name": Shape::Text, "\"four-bar\"";
    /// Description of the mechanism, and the source of its numbers.
    may "description": Shape::Text, "\"...\"";
    /// The units of all numbers in this file. Time is always in seconds.
    must "units": Shape::Table(&UNITS), "{ length = \"mm\", angle = \"deg\" }";
    /// Named numbers for expressions in quotes, which are possible in place of numbers. Each is a design variable,
    /// unless it has `design = false` or is itself given by an expression.
    may "parameters": Shape::Entries("a parameter", &parameters::PARAMETER), "{ hub = { value = 60, unit = \"length\" } }";
    /// Named points of the design configuration: `name = [x, y, z]`, global, in the length unit. Expressions may use
    /// coordinates of others, like `"-left.y"`.
    may "hardpoints": Shape::Entries("a hardpoint", &Shape::exactly(3, &LENGTH)), "{ A = [0, 0, 0] }";
    /// Rigid bodies. `ground` always exists and is not declared.
    must "bodies": Shape::Entries("a body", &BODY_SHAPE), "{ crank = {} }";
    /// Joints between two bodies.
    may "joints": Shape::Entries("a joint", &Shape::Table(&JOINT)), "{}";
    /// Gears, racks, belts and other linear relations between joint coordinates.
    may "couplers": Shape::Entries("a coupler", &Shape::Kinds(&couplers::COUPLER)), "{}";
    /// Prescribed motions: of joint coordinates, points, distances and orientations.
    may "drivers": Shape::Entries("a driver", &Shape::Kinds(&drivers::DRIVER)), "{}";
    /// Design variables: changes of the design, and their effects on other elements.
    may "design": Shape::Entries("a design variable", &Shape::Kinds(&design::VARIABLE)), "{}";
    /// Points of bodies whose motion is computed.
    may "points": Shape::Entries("a point", &Shape::Table(&results::POINT)), "{}";
    /// Vehicle data, for anti-dive and Ackermann.
    may "vehicle": Shape::Table(&wheels::VEHICLE), "{ wheelbase = 2600 }";
    /// Road wheels, for their measures.
    may "wheels": Shape::Entries("a wheel", &Shape::Table(&wheels::WHEEL)), "{}";
    /// Pairs of wheels, for their measures.
    may "axles": Shape::Entries("an axle", &Shape::Table(&wheels::AXLE)), "{}";
    /// Direction and acceleration of gravity.
    may "gravity": Shape::Table(&elements::GRAVITY), "{ along = \"-z\" }";
    /// Loads with or without the inertia of the masses.
    or("\"dynamic\"") "loads": LOADS, "\"static\"";
    /// Masses, for loads.
    may "masses": Shape::Entries("a mass", &Shape::Kinds(&elements::MASS)), "{}";
    /// Applied forces: springs, dampers, friction, given forces; bushings and elastic joints.
    may "forces": Shape::Entries("a force", &Shape::Kinds(&elements::FORCE)), "{}";
    /// Numbers to compute from the motion, with their sensitivities.
    may "measures": Shape::Entries("a measure", &results::MEASURE), "{}";
    /// Numbers of a measure's curve over the motion, with their sensitivities.
    may "metrics": Shape::Entries("a metric", &Shape::Table(&results::METRIC)), "{}";
    /// The output times. They may be left out if every case has its own.
    may "time": Shape::Kinds(&results::TIME), "{ end = 1.0, steps = 100 }";
    /// Behaviour at a change point, where two motions of the mechanism meet, such as a parallelogram with its bars in
    /// line.
    or("\"stop\"") "at_change_points": CHANGE_POINTS, "\"continue\"";
    /// Several motions of the mechanism, in place of the one by the drivers' own laws.
    may "cases": Shape::Entries("a case", &Shape::Table(&cases::CASE)), "{}";
    /// Plane of the mechanism: points may have two coordinates, and pins need no axis.
    may "planar": planar::PLANAR, "\"xy\"";
    /// Other files; their entries apply unless this file has them itself.
    may "include": include::INCLUDE, "[\"corner.toml\"]";
    /// Applies the entries of one side to the other side as well.
    may "mirror": Shape::Table(&mirror::MIRROR), "{ across = \"y\", names = { left = \"right\" } }";
    /// Goals and limits of the optimisation.
    may "optimize": Shape::Table(&optimize::OPTIMIZE), "{ goals = { toe = { metric = \"toe_error\" } } }";
    /// Tolerances of the design, and the limits that it must keep.
    may "tolerance": Shape::Table(&tolerance::TOLERANCE), "{ variables = { B_x = 0.1 } }";
    /// Designs of a sweep, and the results that are stored.
    may "sweep": Shape::Table(&sweep::SWEEP), "{ variables = { B_x = [-5, 5] } }";
};
/// The values of `loads`, in the order of [`LOAD_MODES`].
pub(crate) const LOADS: Shape = Shape::Words(&[
    ("dynamic", "Masses need forces for their accelerations along the motion."),
    (
        "static",
        "At each output time the mechanism is in equilibrium at rest there: no inertia. Dampers and friction keep the speeds of the motion.",
    ),
]);
pub(crate) const LOAD_MODES: [LoadMode; 2] = [LoadMode::Dynamic, LoadMode::Static];
const CHANGE_POINTS: Shape = Shape::Words(&[
    ("stop", "The motion ends there."),
    (
        "continue",
        "The motion continues smoothly if it can, and stops otherwise. At the change point, sensitivities and loads are undefined.",
    ),
]);
const UNITS: Table = table! {
    /// The units of all numbers in the file.
    "Units":
    /// Unit of every length.
    must "length": Shape::Known("the symbol of a unit", || LengthUnit::ALL.map(|unit| (unit.symbol(), String::new())).into()), "\"mm\"";
    /// Unit of every angle.
    must "angle": Shape::Known("the symbol of a unit", || AngleUnit::ALL.map(|unit| (unit.symbol(), String::new())).into()), "\"deg\"";
};
/// Common other spellings of a unit's symbol.
const UNIT_WORDS: [(&str, &str); 12] = [
    ("millimetre", "mm"),
    ("millimeters", "mm"),
    ("centimetre", "cm"),
    ("centimeters", "cm"),
    ("metre", "m"),
    ("meters", "m"),
    ("inch", "in"),
    ("inches", "in"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("radian", "rad"),
    ("radians", "rad"),
];
const BODY_SHAPE: Shape = Shape::Any(
    "BodyOrPoints",
    "A body; in a planar model also a list of its hardpoints.",
    &[Shape::Table(&BODY), Shape::list(&HARDPOINT)],
);
const BODY: Table = table! {
    /// A body; `{}` is enough.
    "Body":
    /// Reference frame in the design configuration. Default: origin at the mean of the body's joint places, axes
    /// parallel to the global ones. Only results expressed in the frame depend on it.
    may "frame": Shape::Kinds(&FRAME), "{ position = [0, 0, 0] }";
    /// Shape for drawings, and for masses of `type = "mesh"`: a file of triangles in the model's folder or below it
    /// (STL, OBJ or glTF).
    may "mesh": mesh::MESH, "\"knuckle.stl\"";
};
const FRAME: Kinds = Kinds {
    name: "Frame",
    doc: "A reference frame.",
    typed: false,
    tables: || vec![&FRAME_BY_POSITION, &FRAME_BY_POINTS],
};
const FRAME_BY_POSITION: Table = table! {
    /// By position and orientation.
    "Pose":
    /// Origin: coordinates or a hardpoint's name.
    must "position": PLACE, "[0, 0, 0]";
    /// 3-1-3 Euler angles, in the angle unit: turn about z, then the new x, then the new z. Default: zero.
    may "euler": Shape::exactly(3, &ANGLE), "[0, 0, 0]";
    /// Cardan angles instead: turn about x, then the new y, then the new z.
    may "cardan": Shape::exactly(3, &ANGLE), "[0, 0, 0]";
    /// Roll, pitch and yaw instead: turn by the last about z, then by pitch about the new y, then by roll about the new
    /// x.
    may "roll_pitch_yaw": Shape::exactly(3, &ANGLE), "[0, 0, 0]";
    /// Quaternion `[w, x, y, z]` instead, of any length.
    may "quaternion": Shape::exactly(4, &NUMBER), "[1, 0, 0, 0]";
};
/// Keys of orientations as angles, with their meanings and expected values.
const ANGLES: [(&str, Angles, &str); 3] = [
    ("euler", Angles::Euler, "three Euler angles (3-1-3)"),
    ("cardan", Angles::Cardan, "three Cardan angles (about x, y and z)"),
    ("roll_pitch_yaw", Angles::RollPitchYaw, "three angles: roll, pitch and yaw"),
];
const FRAME_BY_POINTS: Table = table! {
    /// By three points.
    "FramePoints":
    /// The origin.
    must "origin": PLACE, "\"A\"";
    /// A point on the x axis.
    must "x": PLACE, "\"B\"";
    /// A point in the xy plane, on the side of +y.
    must "xy": PLACE, "\"C\"";
};
const JOINT: Table = table! {
    /// A joint between bodies i and j.
    "Joint":
    /// The joint type, or one of its other names.
    must "type": JOINT_TYPE, "\"revolute\"";
    /// Names of bodies i and j. Coordinates are those of j relative to i.
    must "bodies": Shape::exactly(2, &format::BODY), "[\"ground\", \"crank\"]";
    /// Location: a hardpoint's name or coordinates; or two of them, one on each body, for rods, legs and open joints.
    /// Default: the first hardpoint of the axis, if it has any.
    may "at": Shape::Any("Places", "", &[PLACE, Shape::exactly(2, &PLACE)]), "\"A\"";
    /// The axis, in the design configuration; required if the joint type has one.
    may "axis": LINE, "\"z\"";
    /// The second axis: perpendicular to the first, or the axis on body j, depending on the joint type.
    may "axis2": LINE, "\"x\"";
    /// For a mirror image of another joint: the global axis perpendicular to the mirror. The default of `axis2` is then
    /// the image of that joint's default.
    may "mirror": Shape::Words(&[("x", ""), ("y", ""), ("z", "")]), "\"y\"";
    /// Length of a rod or leg, or distance of a point from its curve; the mechanism is assembled to it. Default: the
    /// value in the design configuration.
    may "length": LENGTH, "250";
    /// Advance of a screw per turn, in the length unit; negative for a left-hand thread. Required for a `screw`.
    may "lead": LENGTH, "5";
    /// The curve on body i that a point of body j follows, for the joint type `point_on_curve`.
    may "curve": Shape::Table(&CURVE), "{ points = [\"A\", \"B\", \"C\"] }";
    /// True if loops should preferably be cut at this joint. It affects the effort, not the results.
    or("false") "cut": Shape::Flag, "true";
    /// Shape in drawings, for a rod, a leg, or a joint that slides along its axis. It does not affect results. Default:
    /// a leg is a cylinder.
    may "draw": DRAW, "\"coilover\"";
};
/// Shape of a joint with a length in drawings.
pub(crate) const DRAW: Shape = Shape::Any("Draw", "", &[Shape::Words(FORMS)]);
const CURVE: Table = table! {
    /// A smooth curve through points in the design configuration, in the plane perpendicular to the joint's axis.
    "Curve":
    /// Points in order: hardpoints' names or coordinates.
    must "points": Shape::list(&PLACE), "[\"A\", \"B\", \"C\"]";
    /// True for a closed curve, such as that of a cam; the first point is not repeated.
    or("false") "closed": Shape::Flag, "true";
};
const JOINT_TYPE: Shape =
    Shape::Any("JointType", "", &[Shape::Known("the name of a joint type", joint_types)]);
/// A coordinate of a joint, by name.
const COORDINATE: Shape =
    Shape::Any("Coordinate", "", &[Shape::Known("the name of a coordinate", coordinates)]);

/// Joint types with their aliases and descriptions.
fn joint_types() -> Vec<(&'static str, String)> {
    let mut names = Vec::new();
    for t in joint::ALL {
        let coordinates: Vec<_> = t.coordinates.iter().map(|c| format!("`{}`", c.name)).collect();
        let coordinates = match coordinates.as_slice() {
            [] => String::new(),
            [one] => format!(" Coordinate: {one}."),
            several => format!(" Coordinates: {}.", several.join(", ")),
        };
        let mut summary = t.summary.to_owned();
        summary[..1].make_ascii_uppercase();
        let description = format!("{summary}.{coordinates}");
        names.extend(t.aliases.iter().map(|a| (*a, format!("Another name of `{}`. {description}", t.name))));
        names.insert(names.len() - t.aliases.len(), (t.name, description));
    }
    names
}

/// Names of all joint coordinates.
fn coordinates() -> Vec<(&'static str, String)> {
    let mut names: Vec<(&str, String)> = Vec::new();
    for c in joint::ALL.iter().flat_map(|t| t.coordinates) {
        if !names.iter().any(|n| n.0 == c.name) {
            names.push((c.name, String::new()));
        }
    }
    names
}

/// Tables of `docs/file-format.md`, by their names there.
#[cfg(test)]
pub(crate) fn tables() -> [(&'static str, Shape); 39] {
    [
        ("include", Shape::Table(&include::INCLUDE_TABLE)),
        ("mirror", Shape::Table(&mirror::MIRROR)),
        ("parameters", Shape::Table(&parameters::PARAMETER_TABLE)),
        ("frames", Shape::Kinds(&FRAME)),
        ("meshes", Shape::Table(&mesh::MESH_TABLE)),
        ("joints", Shape::Table(&JOINT)),
        ("curves", Shape::Table(&CURVE)),
        ("couplers", Shape::Kinds(&couplers::COUPLER)),
        ("terms", Shape::Table(&couplers::TERM)),
        ("drivers", Shape::Kinds(&drivers::DRIVER)),
        ("laws", Shape::Kinds(&law::LAW_TABLE)),
        ("pieces", Shape::Table(&law::PIECE)),
        ("design variables", Shape::Kinds(&design::VARIABLE)),
        ("shape fields", Shape::Kinds(&design::SHAPE_FIELD)),
        ("fields", Shape::Table(&design::FIELD)),
        ("markers", Shape::Table(&design::MARKER)),
        ("points", Shape::Table(&results::POINT)),
        ("the vehicle", Shape::Table(&wheels::VEHICLE)),
        ("wheels", Shape::Table(&wheels::WHEEL)),
        ("axles", Shape::Table(&wheels::AXLE)),
        ("gravity", Shape::Table(&elements::GRAVITY)),
        ("masses", Shape::Kinds(&elements::MASS)),
        ("forces", Shape::Kinds(&elements::FORCE)),
        ("measures", Shape::Kinds(&results::OWN_MEASURE)),
        ("metrics", Shape::Table(&results::METRIC)),
        ("time", Shape::Kinds(&results::TIME)),
        ("cases", Shape::Table(&cases::CASE)),
        ("grids", Shape::Kinds(&cases::SWEEP)),
        ("targets in files", Shape::Table(&results::TARGET_FILE)),
        ("forces in files", Shape::Table(&results::FORCE_FILE)),
        ("optimize", Shape::Table(&optimize::OPTIMIZE)),
        ("goals", Shape::Table(&optimize::GOAL)),
        ("limits", Shape::Kinds(&optimize::LIMIT)),
        ("tolerance", Shape::Table(&tolerance::TOLERANCE)),
        ("tolerances of variables", Shape::Table(&tolerance::ENTRY_TABLE)),
        ("correlations", Shape::Table(&tolerance::CORRELATION)),
        ("limits of tolerances", Shape::Table(&tolerance::LIMIT)),
        ("sweep", Shape::Table(&sweep::SWEEP)),
        ("ranges of variables", Shape::Table(&sweep::RANGE)),
    ]
}

/// Contents of a file, as far as they could be read.
#[derive(Default)]
pub(crate) struct Raw {
    pub draft: Draft,
    pub description: Option<String>,
    pub drawing: Appearance,
    pub places: Places,
    /// Index of each hardpoint and joint; of equal names, the first. Only used for lookups, never iterated.
    hardpoint_numbers: HashMap<String, usize>,
    joint_numbers: HashMap<String, usize>,
    /// Quantity that each driver of the draft prescribes.
    driven: Vec<Quantity>,
    /// Drivers without a law of their own, whose laws are in the cases, by their indices in the draft.
    without_law: Vec<usize>,
}

impl Raw {
    /// Law of a driver, and the prescribed quantity.
    fn driver(&self, name: &str) -> Option<(&Law, Quantity)> {
        let k = self.draft.drivers.iter().position(|d| d.name == name)?;
        Some((&self.draft.drivers[k].law, self.driven[k]))
    }
}

impl Reader<'_> {
    pub fn model<'a>(&mut self, table: &'a DeTable<'a>, twins: &HashMap<String, Value<'_>>) -> Raw {
        let mut raw = Raw::default();
        let fields = self.fields("the model", 0..0, table, MODEL.keys());
        let place = EntryPlace::of(&fields);
        let is_table = |s: Shape| matches!(s, Shape::Table(_) | Shape::Kinds(_) | Shape::Entries(..));
        for f in fields.iter().filter(|f| is_table(fields.key(f.key).shape)) {
            if f.value.get_ref().as_table().is_none_or(|t| t.len() > MOST_ENTRIES) {
                self.unread.push(f.key);
            }
        }
        self.push(&mut raw, Section::Model, place);
        let name = self.need(&fields, "name");
        raw.draft.name = name.and_then(|f| self.text(&fields, f)).unwrap_or_default();
        raw.description = fields.get("description").and_then(|f| self.text(&fields, f));
        self.units(&fields);
        self.parameters(&fields, &mut raw);
        self.hardpoints(&fields, &mut raw);
        self.settle(&mut raw);
        self.bodies(&fields, &mut raw);
        self.joints(&fields, &mut raw);
        self.couplers(&fields, &mut raw);
        self.measures(&fields, &mut raw);
        self.drivers(&fields, &mut raw);
        self.design(&fields, &mut raw, twins);
        self.points(&fields, &mut raw);
        self.vehicle(&fields, &mut raw);
        self.wheels(&fields, &mut raw);
        self.axles(&fields, &mut raw);
        self.gravity(&fields, &mut raw);
        raw.draft.load_mode = self.word_of(&fields, "loads").map_or(LoadMode::default(), |k| LOAD_MODES[k]);
        self.masses(&fields, &mut raw);
        self.forces(&fields, &mut raw);
        self.metrics(&fields, &mut raw);
        self.time(&fields, &mut raw);
        let word = self.word_of(&fields, "at_change_points");
        raw.draft.at_change_points =
            word.map_or(ChangePointPolicy::default(), |k| ChangePointPolicy::WORDS[k].1);
        self.cases(&fields, &mut raw);
        self.optimize(&fields, &mut raw);
        self.tolerance(&fields, &mut raw);
        self.sweep(&fields, &mut raw);
        raw
    }

    fn text(&mut self, fields: &Fields<'_>, f: Field<'_>) -> Option<String> {
        let text = f.value.get_ref().as_str().map(str::to_owned);
        if text.is_none() {
            self.wrong(f.value, &fields.subject(f.key), "a text in quotes");
        }
        text
    }

    fn units(&mut self, model: &Fields<'_>) {
        let Some(f) = model.get("units") else {
            let message = "the model has no `units`";
            self.report("HP0104", model.at.clone(), message).help = Some(
                "add near the top `units = { length = \"mm\", angle = \"deg\" }`; lengths may be in mm, cm, m or in, \
                 angles in deg or rad"
                    .into(),
            );
            return;
        };
        let subject = model.subject("units");
        let Some(table) = self.table(f.value, &subject, "a table of a length and an angle unit") else {
            return;
        };
        let fields = self.fields("`units`", f.value.span(), table, UNITS.keys());
        let [length, angle] = ["length", "angle"].map(|key| {
            let before = self.found.len();
            let found = self.word_of(&fields, key);
            let written = fields.get(key).and_then(|f| f.value.get_ref().as_str());
            if let (Some(written), Some(d)) = (written, self.found.get_mut(before)) {
                let words =
                    UNIT_WORDS.iter().filter(|(_, symbol)| fields.key(key).shape.words().contains(symbol));
                let meant = closest(written, words.clone().map(|w| w.0));
                let meant = words.clone().find(|w| Some(w.0) == meant);
                d.help = meant.map(|(_, meant)| format!("did you mean `{meant}`?")).or(d.help.take());
            }
            found
        });
        self.units.length = length.map_or(LengthUnit::Metre, |k| LengthUnit::ALL[k]);
        self.units.angle = angle.map_or(AngleUnit::Radian, |k| AngleUnit::ALL[k]);
    }

    /// Named entries of one of the model's tables.
    fn entries<'a>(
        &mut self,
        model: &Fields<'a>,
        key: &'static str,
        one: &str,
    ) -> Vec<(String, Range<usize>, &'a Value<'a>)> {
        self.entries_below(model, "", key, one)
    }

    /// Named entries of a table `below` another, like `optimize.`.
    fn entries_below<'a>(
        &mut self,
        table: &Fields<'a>,
        below: &str,
        key: &'static str,
        one: &str,
    ) -> Vec<(String, Range<usize>, &'a Value<'a>)> {
        let Some(f) = table.get(key) else { return Vec::new() };
        let expected = format!("a table with one entry for each {one}");
        let mut subject = table.subject(key);
        subject.example = format!("write `[{below}{key}.NAME]` above the keys of a {one}");
        let Some(table) = self.table(f.value, &subject, &expected) else { return Vec::new() };
        if table.len() > MOST_ENTRIES {
            self.too_many(f.value.span(), &format!("`{key}`"), table.len());
            return Vec::new();
        }
        let mut entries = Vec::new();
        for (name, value) in table {
            let what = format!("the name of a {one}");
            if let Some(short) = self.short(name.get_ref(), name.span(), &what) {
                entries.push((short, name.span(), value));
            }
        }
        entries
    }

    /// Fields of a named entry, which must be a table.
    fn entry<'a>(
        &mut self,
        one: &str,
        (name, at, value): &(String, Range<usize>, &'a Value<'a>),
        keys: impl IntoIterator<Item = &'static Key>,
    ) -> Fields<'a> {
        self.unread.clear();
        let what = format!("{one} `{}`", shown(name));
        let mut keys = keys.into_iter().peekable();
        if let Some(table) = value.get_ref().as_table() {
            return self.fields(what, at.clone(), table, keys);
        }
        let first = keys.peek().map_or(String::new(), |k| format!("{} = {}", k.key, k.example));
        let example = format!("for example `{name} = {{ {first} }}`");
        self.wrong(value, &Subject { name: what.clone(), example }, "a table of keys");
        self.unread.push("");
        let mut fields = self.fields(what, at.clone(), EMPTY.get_or_init(DeTable::new), keys);
        fields.lost = true;
        fields
    }

    /// Kind of a named entry, from its `type`. Without a known type, the entry is not checked further.
    fn entry_type<T>(
        &mut self,
        one: &str,
        (name, at, value): &(String, Range<usize>, &Value<'_>),
        kinds: &'static [(Table, T)],
    ) -> Option<&'static (Table, T)> {
        let what = format!("{one} `{}`", shown(name));
        match value.get_ref().as_table() {
            Some(table) => self.kind_of(table, &what, at.clone(), &format!("a {one}"), kinds),
            None => {
                let example = format!("for example `{name} = {{ type = \"{}\" }}`", kinds[0].0.name);
                self.wrong(value, &Subject { name: what, example }, "a table of keys");
                None
            }
        }
    }

    /// Kind of a table by its `type`.
    fn kind_of<T>(
        &mut self,
        table: &DeTable<'_>,
        what: &str,
        at: Range<usize>,
        one: &str,
        kinds: &'static [(Table, T)],
    ) -> Option<&'static (Table, T)> {
        let types: Vec<&str> = kinds.iter().map(|k| k.0.name).collect();
        let Some(kind) = table.get("type") else {
            self.report("HP0104", at, format!("{what} has no `type`")).help =
                Some(format!("add it; possible: {}", quoted(&types)));
            return None;
        };
        let subject = Subject {
            name: format!("`type` of {what}"),
            example: format!("for example `type = \"{}\"`", types[0]),
        };
        let word = kind.get_ref().as_str();
        let known = kinds.iter().find(|k| word == Some(k.0.name));
        match (word, known) {
            (Some(word), None) => self.unknown_word(kind.span(), &subject, word, &types),
            (None, _) => self.wrong(kind, &subject, &format!("the name of {one} type")),
            _ => {}
        }
        known
    }

    /// Kind of a table by its keys: the kind that the first key selects, or else one that has some of them. Keys of
    /// other kinds are reported.
    fn led_by<T>(
        &mut self,
        fields: &Fields<'_>,
        kinds: &'static [(Table, T)],
        [missing, given]: [&str; 2],
    ) -> Option<&'static (Table, T)> {
        let has = |key: &Key| fields.get(key.key).is_some();
        let led = kinds.iter().find(|k| has(&k.0.keys[0]));
        let Some(kind) = led.or_else(|| kinds.iter().find(|k| k.0.keys.iter().any(has))) else {
            if fields.lost {
                return None;
            }
            let message = format!("{} has no {missing}", fields.what);
            let ways: Vec<String> = kinds.iter().map(|k| way(&k.0)).collect();
            self.report("HP0104", fields.at.clone(), message).help =
                Some(format!("give one of {}", ways.join(", ")));
            return None;
        };
        let by = kind.0.keys.iter().find(|k| has(k)).expect("just found").key;
        for (table, _) in kinds {
            let lead = &table.keys[0];
            for key in table.keys.iter().filter(|k| has(k) && !kind.0.keys.iter().any(|own| own.key == k.key))
            {
                let why = match has(lead) {
                    true => format!("{given} by `{by}` already"),
                    false => format!("`{}` goes with `{}`; {given} by `{by}`", key.key, lead.key),
                };
                self.out_of_place(fields, key.key, why);
                if let Some(d) = self.found.last_mut() {
                    d.help = Some(format!("give {} or {}", way(&kind.0), way(table)));
                }
            }
        }
        Some(kind)
    }

    /// Fields of each inline table in a list.
    fn tables<'a>(
        &mut self,
        fields: &Fields<'a>,
        key: &'static str,
        of: &'static Table,
    ) -> Option<Vec<Fields<'a>>> {
        self.given(fields, key, |r, f| {
            let subject = fields.subject(key);
            let list = r.list(f.value, &subject, "a list of tables")?;
            let tables: Vec<_> = (1..)
                .zip(list)
                .map(|(k, v)| {
                    let table = r.table(v, &subject, "a list of tables")?;
                    Some(r.fields(
                        format!("entry {k} of `{key}` in {}", fields.what),
                        v.span(),
                        table,
                        of.keys(),
                    ))
                })
                .collect();
            tables.into_iter().collect()
        })
    }

    fn hardpoints(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for (name, at, value) in self.entries(model, "hardpoints", "hardpoint") {
            let subject = Subject {
                name: format!("hardpoint `{name}`"),
                example: above_tables(&name)
                    .unwrap_or_else(|| format!("for example `{} = [100.0, 0, -50.5]`", shown(&name))),
            };
            self.unread.clear();
            let mut place = EntryPlace::at(at);
            place.key("position", value);
            let position = match self.written_place(value, &subject, "three coordinates") {
                Some(LocationDraft::At(position)) => position,
                Some(LocationDraft::Formula(coordinates)) => {
                    for (axis, expression) in coordinates.into_iter().enumerate() {
                        let of = FormulaOf::Coordinate(name.clone(), axis);
                        raw.draft.formulas.push(FormulaDraft { of, expression });
                    }
                    Vec3::ZERO
                }
                _ => {
                    self.unread.push("position");
                    Vec3::ZERO
                }
            };
            self.push(raw, Section::Hardpoints, place);
            raw.hardpoint_numbers.entry(name.clone()).or_insert(raw.draft.hardpoints.len());
            raw.draft.hardpoints.push(HardpointDraft { name, position });
        }
    }

    /// Computes the nominal values of parameters and hardpoints, all at once.
    fn settle(&mut self, raw: &mut Raw) {
        if raw.draft.parameters.is_empty() && raw.draft.formulas.is_empty() {
            return;
        }
        self.nominal = Nominal::of(&raw.draft);
        for (hardpoint, position) in raw.draft.hardpoints.iter_mut().zip(&self.nominal.positions) {
            hardpoint.position = *position;
        }
    }

    fn bodies(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for entry in self.entries(model, "bodies", "body") {
            let fields = self.entry("body", &entry, BODY.keys());
            let mut place = EntryPlace::of(&fields);
            let frame = self.given(&fields, "frame", |r, f| r.frame(&fields, f, &mut place, raw));
            let mut mesh = BodyMesh::None;
            if fields.get("mesh").is_some() {
                let said = self.given(&fields, "mesh", |r, f| r.mesh(&fields, f));
                if let Some(drawn) = said.as_ref().and_then(|said| self.drawn(said)) {
                    // Ground comes first in the model.
                    raw.drawing.bodies.insert(raw.draft.bodies.len() + 1, drawn);
                }
                mesh = said.map_or(BodyMesh::Faulty, BodyMesh::Said);
            }
            self.meshes.insert(entry.0.clone(), mesh);
            self.push(raw, Section::Bodies, place);
            raw.draft.bodies.push(BodyDraft { name: entry.0, frame: frame.unwrap_or_default() });
        }
    }

    fn frame<'a>(
        &mut self,
        body: &Fields<'a>,
        f: Field<'a>,
        place: &mut EntryPlace,
        raw: &Raw,
    ) -> Option<FrameDraft> {
        let subject = body.subject("frame");
        let table = self.table(f.value, &subject, "a table with a position or three points")?;
        let fields = self.fields(format!("the frame of {}", body.what), f.value.span(), table, FRAME.keys());
        if ["origin", "x", "xy"].iter().any(|k| fields.get(k).is_some()) {
            let angles = ANGLES.map(|(key, ..)| key);
            for key in ["position"].into_iter().chain(angles).chain(["quaternion"]) {
                self.out_of_place(
                    &fields,
                    key,
                    "a frame is given either by points or by position and orientation",
                );
            }
            let points = ["origin", "x", "xy"].map(|key| self.need(&fields, key));
            place.items("frame", points.iter().flatten().map(|f| f.value.span()).collect());
            let [origin, x, xy] =
                points.map(|f| f.and_then(|f| self.fixed_place(f.value, &fields.subject(f.key))));
            return Some(FrameDraft::Points(origin?, x?, xy?));
        }
        let position = self.need(&fields, "position");
        let r = position.and_then(|f| match self.fixed_place(f.value, &fields.subject("position"))? {
            LocationDraft::At(r) => Some(r),
            LocationDraft::Hardpoint(name) => self.hardpoint_position(&name, f, raw),
            LocationDraft::Formula(_) => None,
        });
        let angles = ANGLES.into_iter().find(|(key, ..)| fields.get(key).is_some());
        let rot = match (angles, fields.get("quaternion")) {
            (Some((given, angles, expected)), _) => {
                let why = format!("the orientation is given by `{given}` already");
                let others = ANGLES.map(|(key, ..)| key).into_iter().chain(["quaternion"]);
                for other in others.filter(|key| *key != given) {
                    self.out_of_place(&fields, other, &why);
                }
                self.list_of::<3>(&fields, given, expected).map(|list| angles.rotation(list))
            }
            (None, Some(f)) => {
                let subject = fields.subject("quaternion");
                let q = self.numbers::<4>(f.value, &subject, "a quaternion `[w, x, y, z]`")?;
                let unit = Quat::from_array(q);
                if unit.is_none() {
                    self.senseless(f.value.span(), format!("{} has no direction", subject.name)).help =
                        Some("write `[1, 0, 0, 0]` for no rotation".into());
                }
                unit.map(Quat::rotation)
            }
            (None, None) => Some(Pose::IDENTITY.rot),
        };
        Some(FrameDraft::Pose(Pose { r: r?, rot: rot? }))
    }

    /// Reads the position of a frame, which is needed at once, so that its hardpoint is looked up here.
    fn hardpoint_position(&mut self, name: &str, f: Field<'_>, raw: &Raw) -> Option<Vec3> {
        let hardpoints = &raw.draft.hardpoints;
        let found = raw.hardpoint_numbers.get(name).map(|k| &hardpoints[*k]);
        if found.is_none() && !raw.draft.unread.has(Section::Model, 0, "hardpoints") {
            let close = self.guess(name, hardpoints.iter().map(|h| h.name.as_str()));
            self.report("HP0204", f.value.span(), format!("there is no hardpoint named `{name}`")).help =
                close.map(|c| format!("did you mean `{c}`?"));
        }
        Some(found?.position)
    }

    fn joints(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for entry in self.entries(model, "joints", "joint") {
            let fields = self.entry("joint", &entry, JOINT.keys());
            let mut place = EntryPlace::of(&fields);
            let kind = self.name_of(&fields, "type");
            let bodies = self.names_of::<2>(&fields, "bodies");
            let at = self.given(&fields, "at", |r, f| r.joint_places(&fields, f, &mut place, raw));
            let [axis, axis2] = ["axis", "axis2"].map(|key| self.line_of(&fields, key, &mut place));
            let mirror = self.word_of(&fields, "mirror");
            let length = self.given(&fields, "length", |r, f| r.rod_length_of(&fields, f, &entry.0, raw));
            let lead = self.number_of(&fields, "lead");
            let curve = self.given(&fields, "curve", |r, f| r.curve(&fields, f, &mut place));
            let cut = self.flag_of(&fields, "cut");
            if let Some(form) = self.form_of_joint(&fields, kind.as_deref()) {
                raw.drawing.joints.insert(raw.draft.joints.len(), form);
            }
            self.push(raw, Section::Joints, place);
            raw.joint_numbers.entry(entry.0.clone()).or_insert(raw.draft.joints.len());
            raw.draft.joints.push(JointDraft {
                name: entry.0,
                kind: kind.unwrap_or_default(),
                bodies: bodies.unwrap_or_default(),
                at: at.unwrap_or_default(),
                axis,
                axis2,
                mirror,
                length,
                lead,
                curve,
                cut: cut.unwrap_or(false),
            });
        }
    }

    /// Shape in drawings.
    fn form_of(&mut self, fields: &Fields<'_>) -> Option<Form> {
        self.word_of(fields, "draw").map(|k| Form::ALL[k])
    }

    /// Shape of a joint in drawings; HP0107 for a joint without a length.
    fn form_of_joint(&mut self, fields: &Fields<'_>, kind: Option<&str>) -> Option<Form> {
        if let Some(kind) = kind.and_then(joint::named) {
            let slides = kind.freedoms.is_some_and(|f| f.contains(&Freedom::Slide(ALONG_AXIS)));
            if !kind.is_rod() && !slides {
                let why = "it is for what has a length: a rod, a leg, a joint that slides along its axis";
                self.out_of_place(fields, "draw", format!("{why}; this is a {} joint", kind.name));
                return None;
            }
        }
        self.form_of(fields)
    }

    /// Length of a rod: a number, or an expression that the core evaluates.
    fn rod_length_of(
        &mut self,
        fields: &Fields<'_>,
        f: Field<'_>,
        joint: &str,
        raw: &mut Raw,
    ) -> Option<f64> {
        let subject = fields.subject(f.key);
        if !f.value.get_ref().is_str() {
            return self.number(f.value, &subject).map(|x| self.units.length.metres(x));
        }
        let expression = self.expression(f.value, &subject)?;
        raw.draft.formulas.push(FormulaDraft { of: FormulaOf::Length(joint.to_owned()), expression });
        Some(0.0)
    }

    /// One location, or a list of locations: three numbers, or three texts that are not all names of hardpoints, are
    /// the coordinates of one.
    fn joint_places(
        &mut self,
        fields: &Fields<'_>,
        f: Field<'_>,
        place: &mut EntryPlace,
        raw: &Raw,
    ) -> Option<Vec<LocationDraft>> {
        let subject = fields.subject("at");
        let is_number = |v: &Value<'_>| matches!(v.get_ref(), DeValue::Integer(_) | DeValue::Float(_));
        let is_hardpoint =
            |v: &Value<'_>| v.get_ref().as_str().is_none_or(|name| raw.hardpoint_numbers.contains_key(name));
        match f.value.get_ref().as_array() {
            Some(list)
                if !list.iter().any(is_number) && (list.len() != 3 || list.iter().all(is_hardpoint)) =>
            {
                let list = self.list(f.value, &subject, "")?;
                let places: Vec<_> = list.iter().map(|v| self.place(v, &subject)).collect();
                places.into_iter().collect()
            }
            _ => {
                let one = self.place(f.value, &subject)?;
                place.items("at", Vec::new());
                Some(vec![one])
            }
        }
    }

    /// Reads a curve; its points become the items of the key.
    fn curve(&mut self, fields: &Fields<'_>, f: Field<'_>, place: &mut EntryPlace) -> Option<CurveDraft> {
        let table = self.table(f.value, &fields.subject("curve"), "a table with the points of the curve")?;
        let curve = self.fields(format!("the curve of {}", fields.what), f.value.span(), table, CURVE.keys());
        let closed = self.flag_of(&curve, "closed");
        let points = self.given(&curve, "points", |r, f| {
            let subject = curve.subject("points");
            let list = r.list(f.value, &subject, "a list of hardpoints' names or coordinates")?;
            place.items("curve", list.iter().map(|v| v.span()).collect());
            let points: Vec<_> = list.iter().map(|v| r.place(v, &subject)).collect();
            points.into_iter().collect::<Option<Vec<_>>>()
        });
        Some(CurveDraft { points: points?, closed: closed? })
    }

    /// Reads a direction; the names in `through` become the items of the key.
    fn line_of(&mut self, fields: &Fields<'_>, key: &str, place: &mut EntryPlace) -> Option<DirectionDraft> {
        self.given(fields, key, |r, f| {
            let (line, items) = r.line(f.value, &fields.subject(f.key))?;
            place.items(f.key, items);
            Some(line)
        })
    }

    /// Reads a location; coordinates have no items of their own.
    fn place_of(&mut self, fields: &Fields<'_>, key: &str) -> Option<LocationDraft> {
        self.given(fields, key, |r, f| r.place(f.value, &fields.subject(f.key)))
    }

    /// Records the location of the next entry of a list of the draft, and its unread keys.
    fn push(&mut self, raw: &mut Raw, section: Section, place: EntryPlace) {
        let index = raw.places.list(section).len();
        self.unread.drain(..).for_each(|key| raw.draft.unread.note(section, index, key));
        raw.places.push(section, place);
    }
}

/// Example of a table of this kind, for help.
fn way(table: &Table) -> String {
    let needed = table.keys.iter().filter(|k| k.need == Need::Required);
    let needed: Vec<String> = needed.map(|k| format!("`{} = {}`", k.key, k.example)).collect();
    let what = table.doc.split([',', ';', ':', '.']).next().unwrap_or_default();
    format!("{} ({}{})", needed.join(" with "), what[..1].to_lowercase(), &what[1..])
}

static EMPTY: std::sync::OnceLock<DeTable<'static>> = std::sync::OnceLock::new();

/// Type of a joint if it is known; otherwise the core reports it.
fn type_of(raw: &Raw, joint: &str) -> Option<&'static JointType> {
    joint::named(&raw.draft.joints[*raw.joint_numbers.get(joint)?].kind)
}
