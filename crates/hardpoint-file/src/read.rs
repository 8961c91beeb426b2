//! The tables of a model file, one function each, into a draft.

mod couplers;
mod data;
mod design;
mod drivers;
mod law;
mod parameters;
mod results;
mod wheels;

use std::collections::HashMap;
use std::ops::Range;

use hardpoint::joint::{self, Quantity};
use hardpoint::model::{
    BodyDraft, CurveDraft, Draft, FormulaDraft, FormulaOf, FrameDraft, HardpointDraft, JointDraft, Line,
    Nominal, Place, Section,
};
use hardpoint::space::{Pose, Quat, Vec3, rotation_from_euler_313};
use toml::de::{DeTable, DeValue};

use crate::diagnostic::{closest, shown};
use crate::places::{EntryPlace, Places};
use crate::tree::{Field, Fields, Key, MOST_ENTRIES, Reader, Subject, Value, above_tables, quoted};
use crate::units::{AngleUnit, LengthUnit};

const MODEL: &[Key] = &[
    ("name", "\"four-bar\""),
    ("description", "\"...\""),
    ("units", "{ length = \"mm\", angle = \"deg\" }"),
    ("parameters", "{ hub = { value = 60, unit = \"length\" } }"),
    ("hardpoints", "{ A = [0, 0, 0] }"),
    ("bodies", "{ crank = {} }"),
    ("joints", "{}"),
    ("couplers", "{}"),
    ("drivers", "{}"),
    ("design", "{}"),
    ("points", "{}"),
    ("vehicle", "{ wheelbase = 2600 }"),
    ("wheels", "{}"),
    ("axles", "{}"),
    ("measures", "{}"),
    ("metrics", "{}"),
    ("time", "{ end = 1.0, steps = 100 }"),
];
const UNITS: &[Key] = &[("length", "\"mm\""), ("angle", "\"deg\"")];
/// What people write for a unit's symbol.
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
const BODY: &[Key] = &[("frame", "{ position = [0, 0, 0] }")];
const FRAME: &[Key] = &[
    ("position", "[0, 0, 0]"),
    ("euler", "[0, 0, 0]"),
    ("quaternion", "[1, 0, 0, 0]"),
    ("origin", "\"A\""),
    ("x", "\"B\""),
    ("xy", "\"C\""),
];
const JOINT: &[Key] = &[
    ("type", "\"revolute\""),
    ("bodies", "[\"ground\", \"crank\"]"),
    ("at", "\"A\""),
    ("axis", "\"z\""),
    ("axis2", "\"x\""),
    ("length", "250"),
    ("lead", "5"),
    ("curve", "{ points = [\"A\", \"B\", \"C\"] }"),
    ("cut", "true"),
];
const CURVE: &[Key] = &[("points", "[\"A\", \"B\", \"C\"]"), ("closed", "true")];

/// What a file says, as far as it could be read.
#[derive(Default)]
pub(crate) struct Raw {
    pub draft: Draft,
    pub description: Option<String>,
    pub places: Places,
    /// Which number a hardpoint and a joint have; of equal names, the first. Only looked up, never walked.
    hardpoint_numbers: HashMap<String, usize>,
    joint_numbers: HashMap<String, usize>,
    /// Of each driver of the draft, what one unit of its law is in SI, the parameters that are rates in that unit, and
    /// what it measures.
    pub driver_rates: Vec<(f64, Vec<String>, Quantity)>,
}

impl Reader<'_> {
    pub fn model<'a>(&mut self, table: &'a DeTable<'a>) -> Raw {
        let mut raw = Raw::default();
        let fields = self.fields("the model", 0..0, table, MODEL);
        let mut place = EntryPlace::of(&fields);
        for f in fields.iter() {
            let readable = f.value.get_ref().as_table().is_some_and(|t| t.len() <= MOST_ENTRIES);
            if !readable {
                place.unread(f.key);
            }
        }
        raw.places.push(Section::Model, place);
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
        self.drivers(&fields, &mut raw);
        self.design(&fields, &mut raw);
        self.points(&fields, &mut raw);
        self.measures(&fields, &mut raw);
        self.vehicle(&fields, &mut raw);
        self.wheels(&fields, &mut raw);
        self.axles(&fields, &mut raw);
        self.metrics(&fields, &mut raw);
        self.time(&fields, &mut raw);
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
            let message = "the model does not say in which units its numbers are";
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
        let fields = self.fields("`units`", f.value.span(), table, UNITS);
        let mut pick = |key: &str, symbols: &[&str]| -> Option<usize> {
            let f = self.need(&fields, key)?;
            let subject = fields.subject(key);
            let symbol = self.name(f.value, &subject, "the symbol of a unit")?;
            let k = symbols.iter().position(|s| *s == symbol);
            if k.is_none() {
                self.unknown_word(f.value.span(), &subject, &symbol, symbols);
                let words = UNIT_WORDS.iter().filter(|(_, s)| symbols.contains(s));
                let meant = closest(&symbol, words.clone().map(|w| w.0));
                let meant = words.clone().find(|w| Some(w.0) == meant);
                if let (Some((_, meant)), Some(d)) = (meant, self.found.last_mut()) {
                    d.help = Some(format!("did you mean `{meant}`?"));
                }
            }
            k
        };
        let length = pick("length", &LengthUnit::ALL.map(LengthUnit::symbol));
        let angle = pick("angle", &AngleUnit::ALL.map(AngleUnit::symbol));
        self.units.length = length.map_or(LengthUnit::Metre, |k| LengthUnit::ALL[k]);
        self.units.angle = angle.map_or(AngleUnit::Radian, |k| AngleUnit::ALL[k]);
    }

    /// The named entries of one of the model's tables.
    fn entries<'a>(
        &mut self,
        model: &Fields<'a>,
        key: &'static str,
        one: &str,
    ) -> Vec<(String, Range<usize>, &'a Value<'a>)> {
        let Some(f) = model.get(key) else { return Vec::new() };
        let expected = format!("a table with one entry for each {one}");
        let mut subject = model.subject(key);
        subject.example = format!("write `[{key}.NAME]` above the keys of a {one}");
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

    /// The fields of a named entry, which must be a table.
    fn entry<'a>(
        &mut self,
        one: &str,
        (name, at, value): &(String, Range<usize>, &'a Value<'a>),
        keys: &'static [Key],
    ) -> Fields<'a> {
        let what = format!("{one} `{}`", shown(name));
        match value.get_ref().as_table() {
            Some(table) => self.fields(what, at.clone(), table, keys),
            None => {
                let (key, example) = keys[0];
                let subject = Subject {
                    name: what.clone(),
                    example: format!("for example `{name} = {{ {key} = {example} }}`"),
                };
                self.wrong(value, &subject, "a table of keys");
                self.fields(what, at.clone(), EMPTY.get_or_init(DeTable::new), keys)
            }
        }
    }

    /// The type of a named entry whose keys depend on it. Without a known type, nothing more is said of the entry.
    fn entry_type(
        &mut self,
        one: &str,
        entry: &(String, Range<usize>, &Value<'_>),
        types: &[&'static str],
        keys: &'static [Key],
    ) -> Option<&'static str> {
        let (name, at, value) = entry;
        match value.get_ref().as_table() {
            Some(table) => self.type_of(
                table,
                &format!("{one} `{}`", shown(name)),
                at.clone(),
                &format!("a {one}"),
                types,
            ),
            None => {
                self.entry(one, entry, keys);
                None
            }
        }
    }

    /// The `type` of a table: one of some words.
    fn type_of(
        &mut self,
        table: &DeTable<'_>,
        what: &str,
        at: Range<usize>,
        one: &str,
        types: &[&'static str],
    ) -> Option<&'static str> {
        let Some(kind) = table.get("type") else {
            self.report("HP0104", at, format!("{what} has no `type`")).help =
                Some(format!("add it; possible: {}", quoted(types)));
            return None;
        };
        let subject = Subject {
            name: format!("`type` of {what}"),
            example: format!("for example `type = \"{}\"`", types[0]),
        };
        let word = kind.get_ref().as_str();
        let known = types.iter().copied().find(|t| word == Some(*t));
        match (word, known) {
            (Some(word), None) => self.unknown_word(kind.span(), &subject, word, types),
            (None, _) => self.wrong(kind, &subject, &format!("the name of {one} type")),
            _ => {}
        }
        known
    }

    fn hardpoints(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for (index, (name, at, value)) in
            self.entries(model, "hardpoints", "hardpoint").into_iter().enumerate()
        {
            let subject = Subject {
                name: format!("hardpoint `{name}`"),
                example: above_tables(&name)
                    .unwrap_or_else(|| format!("for example `{} = [100.0, 0, -50.5]`", shown(&name))),
            };
            let mut place = EntryPlace::at(at);
            place.key("position", value);
            let position = match self.written_place(value, &subject, "three coordinates") {
                Some(Place::At(position)) => position,
                Some(Place::Formula(coordinates)) => {
                    for (axis, expression) in coordinates.into_iter().enumerate() {
                        let of = FormulaOf::Coordinate(name.clone(), axis);
                        raw.draft.formulas.push(FormulaDraft { of, expression });
                    }
                    Vec3::ZERO
                }
                _ => {
                    place.unread("position");
                    // No two of these, and none of the others, should be at the same place.
                    let k = index as f64;
                    Vec3::new(0.317 + k, 0.1 + 1.7 * k, 0.7 - 0.9 * k * k)
                }
            };
            raw.places.push(Section::Hardpoints, place);
            raw.hardpoint_numbers.entry(name.clone()).or_insert(index);
            raw.draft.hardpoints.push(HardpointDraft { name, position });
        }
    }

    /// What parameters and hardpoints are in the nominal design, for all that the reader wants to know at once.
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
            let fields = self.entry("body", &entry, BODY);
            let mut place = EntryPlace::of(&fields);
            let frame = match fields.get("frame") {
                None => FrameDraft::Default,
                Some(f) => self.frame(&fields, f, &mut place, raw).unwrap_or_else(|| {
                    place.unread("frame");
                    FrameDraft::Default
                }),
            };
            raw.places.push(Section::Bodies, place);
            raw.draft.bodies.push(BodyDraft { name: entry.0, frame });
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
        let fields = self.fields(format!("the frame of {}", body.what), f.value.span(), table, FRAME);
        if ["origin", "x", "xy"].iter().any(|k| fields.get(k).is_some()) {
            for key in ["position", "euler", "quaternion"] {
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
            Place::At(r) => Some(r),
            Place::Hardpoint(name) => self.hardpoint_position(&name, f, raw),
            Place::Formula(_) => None,
        });
        let rot = match (fields.get("euler"), fields.get("quaternion")) {
            (Some(f), other) => {
                if other.is_some() {
                    self.out_of_place(&fields, "quaternion", "the orientation is given by `euler` already");
                }
                let theta =
                    self.numbers::<3>(f.value, &fields.subject("euler"), "three Euler angles (3-1-3)");
                let list = f.value.get_ref().as_array();
                let angle = |k: usize, x: f64| list.and_then(|l| l.get(k)).map_or(x, |v| self.angle_of(v, x));
                theta.map(|[a, b, c]| rotation_from_euler_313([angle(0, a), angle(1, b), angle(2, c)]))
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

    /// A frame's position is wanted at once, so its hardpoint is looked up here.
    fn hardpoint_position(&mut self, name: &str, f: Field<'_>, raw: &Raw) -> Option<Vec3> {
        let hardpoints = &raw.draft.hardpoints;
        let found = raw.hardpoint_numbers.get(name).map(|k| &hardpoints[*k]);
        if found.is_none() {
            // Past the problems that anybody reads, and among more names than that, a guess would only cost time.
            let names = hardpoints.iter().map(|h| h.name.as_str());
            let guess = self.found.len() < 50 && hardpoints.len() <= 5000;
            let close = if guess { closest(name, names) } else { None };
            self.report("HP0204", f.value.span(), format!("there is no hardpoint named `{name}`")).help =
                close.map(|c| format!("did you mean `{c}`?"));
        }
        Some(found?.position)
    }

    fn joints(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for entry in self.entries(model, "joints", "joint") {
            let fields = self.entry("joint", &entry, JOINT);
            let mut place = EntryPlace::of(&fields);
            let kind = self.named(&fields, "type", "the name of a joint type", &mut place);
            let bodies = self.need(&fields, "bodies").and_then(|f| {
                let subject = fields.subject("bodies");
                let expected = "the names of two bodies";
                match f.value.get_ref().as_array() {
                    Some(list) if list.len() == 2 => {
                        let [i, j] = [0, 1].map(|k| self.name(&list[k], &subject, expected));
                        Some([i?, j?])
                    }
                    _ => {
                        self.wrong(f.value, &subject, expected);
                        None
                    }
                }
            });
            if bodies.is_none() {
                place.unread("bodies");
            }
            let at = match fields.get("at") {
                None => Vec::new(),
                Some(f) => self.joint_places(&fields, f, &mut place, raw).unwrap_or_else(|| {
                    place.unread("at");
                    Vec::new()
                }),
            };
            let [axis, axis2] = ["axis", "axis2"].map(|key| {
                let f = fields.get(key)?;
                let line = self.line_of(&fields, f, &mut place);
                if line.is_none() {
                    place.unread(f.key);
                }
                line
            });
            let length = fields.get("length").and_then(|f| self.rod_length_of(&fields, f, &entry.0, raw));
            if length.is_none() && fields.get("length").is_some() {
                place.unread("length");
            }
            let lead = fields.get("lead").and_then(|f| {
                let number = self.number(f.value, &fields.subject(f.key));
                if number.is_none() {
                    place.unread(f.key);
                }
                number.map(|x| self.units.length.metres(x))
            });
            let curve = fields.get("curve").and_then(|f| {
                let curve = self.curve(&fields, f, &mut place);
                if curve.is_none() {
                    place.unread("curve");
                }
                curve
            });
            let cut = fields.get("cut").and_then(|f| self.boolean(f.value, &fields.subject("cut")));
            raw.places.push(Section::Joints, place);
            raw.joint_numbers.entry(entry.0.clone()).or_insert(raw.draft.joints.len());
            raw.draft.joints.push(JointDraft {
                name: entry.0,
                kind: kind.unwrap_or_default(),
                bodies: bodies.unwrap_or_default(),
                at,
                axis,
                axis2,
                length,
                lead,
                curve,
                cut: cut.unwrap_or(false),
            });
        }
    }

    /// The length of a rod: a number, or an expression that the core evaluates.
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

    /// One place, or a list of places: three numbers, or three texts that are not all names of hardpoints, are the
    /// coordinates of one.
    fn joint_places(
        &mut self,
        fields: &Fields<'_>,
        f: Field<'_>,
        place: &mut EntryPlace,
        raw: &Raw,
    ) -> Option<Vec<Place>> {
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

    /// A curve; its points become the items of the key.
    fn curve(&mut self, fields: &Fields<'_>, f: Field<'_>, place: &mut EntryPlace) -> Option<CurveDraft> {
        let table = self.table(f.value, &fields.subject("curve"), "a table with the points of the curve")?;
        let curve = self.fields(format!("the curve of {}", fields.what), f.value.span(), table, CURVE);
        let closed = match curve.get("closed") {
            Some(f) => self.boolean(f.value, &curve.subject("closed")),
            None => Some(false),
        };
        let points = self.need(&curve, "points").and_then(|f| {
            let subject = curve.subject("points");
            let list = self.list(f.value, &subject, "a list of hardpoints' names or coordinates")?;
            place.items("curve", list.iter().map(|v| v.span()).collect());
            let points: Vec<_> = list.iter().map(|v| self.place(v, &subject)).collect();
            points.into_iter().collect::<Option<Vec<_>>>()
        });
        Some(CurveDraft { points: points?, closed: closed? })
    }

    /// A direction; the names in `through` become the items of the key.
    fn line_of(&mut self, fields: &Fields<'_>, f: Field<'_>, place: &mut EntryPlace) -> Option<Line> {
        let (line, items) = self.line(f.value, &fields.subject(f.key))?;
        place.items(f.key, items);
        Some(line)
    }

    /// A required name; noted as unread where it is missing.
    fn named(
        &mut self,
        fields: &Fields<'_>,
        key: &'static str,
        expected: &str,
        place: &mut EntryPlace,
    ) -> Option<String> {
        if self.need(fields, key).is_none() {
            place.unread(key);
        }
        self.optional_name(fields, key, expected, place)
    }

    /// A name that may be left out; noted as unread where it is there and no name.
    fn optional_name(
        &mut self,
        fields: &Fields<'_>,
        key: &'static str,
        expected: &str,
        place: &mut EntryPlace,
    ) -> Option<String> {
        let f = fields.get(key)?;
        let name = self.name(f.value, &fields.subject(key), expected);
        if name.is_none() {
            place.unread(key);
        }
        name
    }
}

static EMPTY: std::sync::OnceLock<DeTable<'static>> = std::sync::OnceLock::new();

/// What a joint's coordinate measures, as far as joint and coordinate are known; the core reports the rest.
fn coordinate_quantity(raw: &Raw, joint: &str, coordinate: Option<&str>) -> Option<Quantity> {
    let kind = joint::named(&raw.draft.joints[*raw.joint_numbers.get(joint)?].kind)?;
    let coordinate = match coordinate {
        Some(name) => kind.coordinate(name).map(|c| c.1),
        None => kind.coordinates.first(),
    };
    Some(coordinate?.quantity)
}
