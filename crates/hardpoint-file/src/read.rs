//! The tables of a model file, one function each, into a draft.

use std::ops::Range;

use hardpoint::joint::{self, Quantity};
use hardpoint::law::Law;
use hardpoint::model::{
    BodyDraft, ChangeDraft, Draft, DriverDraft, End, FrameDraft, HardpointDraft, JointDraft, Line, MeasureDraft,
    MeasureKindDraft, Place, PointDraft, PointRef, Section, VariableDraft,
};
use hardpoint::space::{Pose, Quat, Vec3, rotation_from_euler_313};
use toml::de::{DeTable, DeValue};

use crate::diagnostic::{closest, shown};
use crate::places::{EntryPlace, Places};
use crate::tree::{Field, Fields, Key, MOST_ENTRIES, Reader, Value, axis_named};
use crate::units::{AngleUnit, LengthUnit};

/// More output times than this are surely a slip.
const MOST_TIMES: usize = 1_000_000;

const MODEL: &[Key] = &[
    ("name", "\"four-bar\""),
    ("description", "\"...\""),
    ("units", "{ length = \"mm\", angle = \"deg\" }"),
    ("hardpoints", "{ A = [0, 0, 0] }"),
    ("bodies", "{ crank = {} }"),
    ("joints", "{}"),
    ("drivers", "{}"),
    ("design", "{}"),
    ("points", "{}"),
    ("measures", "{}"),
    ("time", "{ end = 1.0, steps = 100 }"),
];
const UNITS: &[Key] = &[("length", "\"mm\""), ("angle", "\"deg\"")];
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
    ("cut", "true"),
];
const DRIVER: &[Key] = &[("joint", "\"J1\""), ("coordinate", "\"angle\""), ("law", "\"30*sin(2*pi*t)\"")];
const DESIGN: &[Key] = &[
    ("move", "\"A\""),
    ("along", "\"z\""),
    ("tilt", "\"J1\""),
    ("about", "\"x\""),
    ("fields", "[{ joint = \"J1\", body = \"crank\", V = [1, 0, 0] }]"),
    ("markers", "[{ joint = \"J1\", on = \"j\", move = [0, 0, 1] }]"),
    ("fixed_length", "true"),
];
const FIELD: &[Key] = &[("joint", "\"J1\""), ("body", "\"crank\""), ("V", "[1, 0, 0]"), ("U", "[0, 0, 0]")];
const MARKER: &[Key] = &[("joint", "\"J1\""), ("on", "\"j\""), ("move", "[0, 0, 1]"), ("turn", "[0, 0, 0]")];
const POINT: &[Key] = &[("body", "\"crank\""), ("at", "\"A\"")];
const TIME: &[Key] = &[("start", "0"), ("end", "1.0"), ("steps", "100"), ("at", "[0, 0.5, 1]")];

const MEASURE_TYPES: [&str; 5] = ["coordinate", "distance", "position", "toe", "camber"];
const COORDINATE: &[Key] = &[("type", "\"coordinate\""), ("joint", "\"J1\""), ("coordinate", "\"angle\"")];
const DISTANCE: &[Key] = &[("type", "\"distance\""), ("from", "\"P\""), ("to", "\"Q\"")];
const POSITION: &[Key] = &[("type", "\"position\""), ("point", "\"P\""), ("along", "\"z\"")];
const WHEEL: &[Key] = &[("type", "\"toe\""), ("body", "\"knuckle\""), ("spin_axis", "[0, 1, 0]")];
const MEASURE: &[Key] = &[("type", "\"coordinate\"")];

/// What a file says, as far as it could be read.
#[derive(Default)]
pub(crate) struct Raw {
    pub draft: Draft,
    pub description: Option<String>,
    pub places: Places,
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
        self.hardpoints(&fields, &mut raw);
        self.bodies(&fields, &mut raw);
        self.joints(&fields, &mut raw);
        self.drivers(&fields, &mut raw);
        self.design(&fields, &mut raw);
        self.points(&fields, &mut raw);
        self.measures(&fields, &mut raw);
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
        let Some(table) = self.table(f.value, &subject, "a table of a length and an angle unit") else { return };
        let fields = self.fields("`units`", f.value.span(), table, UNITS);
        let mut pick = |key: &str, symbols: &[&str]| -> Option<usize> {
            let f = self.need(&fields, key)?;
            let subject = fields.subject(key);
            let symbol = self.name(f.value, &subject, "the symbol of a unit")?;
            let k = symbols.iter().position(|s| *s == symbol);
            if k.is_none() {
                self.unknown_word(f.value.span(), &subject, &symbol, symbols);
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
                let subject = crate::tree::Subject {
                    name: what.clone(),
                    example: format!("for example `{name} = {{ {key} = {example} }}`"),
                };
                self.wrong(value, &subject, "a table of keys");
                self.fields(what, at.clone(), EMPTY.get_or_init(DeTable::new), keys)
            }
        }
    }

    fn hardpoints(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for (index, (name, at, value)) in self.entries(model, "hardpoints", "hardpoint").into_iter().enumerate() {
            let subject = crate::tree::Subject {
                name: format!("hardpoint `{name}`"),
                example: format!("for example `{} = [100.0, 0, -50.5]`", shown(&name)),
            };
            let mut place = EntryPlace::at(at);
            place.key("position", value);
            let position = self.coordinates(value, &subject, "three coordinates").unwrap_or_else(|| {
                place.unread("position");
                // No two of these, and none of the others, should be at the same place.
                let k = index as f64;
                Vec3::new(0.317 + k, 0.1 + 1.7 * k, 0.7 - 0.9 * k * k)
            });
            raw.places.push(Section::Hardpoints, place);
            raw.draft.hardpoints.push(HardpointDraft { name, position });
        }
    }

    fn bodies(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for entry in self.entries(model, "bodies", "body") {
            let fields = self.entry("body", &entry, BODY);
            let mut place = EntryPlace::of(&fields);
            let frame = match fields.get("frame") {
                None => FrameDraft::Default,
                Some(f) => self.frame(&fields, f, &mut place, &raw.draft.hardpoints).unwrap_or_else(|| {
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
        hardpoints: &[HardpointDraft],
    ) -> Option<FrameDraft> {
        let subject = body.subject("frame");
        let table = self.table(f.value, &subject, "a table with a position or three points")?;
        let fields = self.fields(format!("the frame of {}", body.what), f.value.span(), table, FRAME);
        if ["origin", "x", "xy"].iter().any(|k| fields.get(k).is_some()) {
            for key in ["position", "euler", "quaternion"] {
                self.out_of_place(&fields, key, "a frame is given either by points or by position and orientation");
            }
            let points = ["origin", "x", "xy"].map(|key| self.need(&fields, key));
            place.items("frame", points.iter().flatten().map(|f| f.value.span()).collect());
            let [origin, x, xy] = points.map(|f| f.and_then(|f| self.place(f.value, &fields.subject(f.key))));
            return Some(FrameDraft::Points(origin?, x?, xy?));
        }
        let position = self.need(&fields, "position");
        let r = position.and_then(|f| match self.place(f.value, &fields.subject("position"))? {
            Place::At(r) => Some(r),
            Place::Hardpoint(name) => self.hardpoint_position(&name, f, hardpoints),
        });
        let rot = match (fields.get("euler"), fields.get("quaternion")) {
            (Some(f), other) => {
                if other.is_some() {
                    self.out_of_place(&fields, "quaternion", "the orientation is given by `euler` already");
                }
                let theta = self.numbers::<3>(f.value, &fields.subject("euler"), "three Euler angles (3-1-3)");
                theta.map(|t| rotation_from_euler_313(t.map(|a| self.units.angle.radians(a))))
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
    fn hardpoint_position(&mut self, name: &str, f: Field<'_>, hardpoints: &[HardpointDraft]) -> Option<Vec3> {
        let found = hardpoints.iter().find(|h| h.name == name);
        if found.is_none() {
            let close = closest(name, hardpoints.iter().map(|h| h.name.as_str()));
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
                Some(f) => self.joint_places(&fields, f, &mut place).unwrap_or_else(|| {
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
            let cut = fields.get("cut").and_then(|f| self.boolean(f.value, &fields.subject("cut")));
            raw.places.push(Section::Joints, place);
            raw.draft.joints.push(JointDraft {
                name: entry.0,
                kind: kind.unwrap_or_default(),
                bodies: bodies.unwrap_or_default(),
                at,
                axis,
                axis2,
                cut: cut.unwrap_or(false),
            });
        }
    }

    /// One place, or a list of places: three numbers are the coordinates of one.
    fn joint_places(&mut self, fields: &Fields<'_>, f: Field<'_>, place: &mut EntryPlace) -> Option<Vec<Place>> {
        let subject = fields.subject("at");
        let is_number = |v: &Value<'_>| matches!(v.get_ref(), DeValue::Integer(_) | DeValue::Float(_));
        match f.value.get_ref().as_array() {
            Some(list) if !list.iter().any(is_number) => {
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
        let name = self.need(fields, key).and_then(|f| self.name(f.value, &fields.subject(key), expected));
        if name.is_none() {
            place.unread(key);
        }
        name
    }

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

    fn drivers(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for entry in self.entries(model, "drivers", "driver") {
            let fields = self.entry("driver", &entry, DRIVER);
            let mut place = EntryPlace::of(&fields);
            let joint = self.named(&fields, "joint", "the name of a joint", &mut place).unwrap_or_default();
            let coordinate = self.optional_name(&fields, "coordinate", "the name of a coordinate", &mut place);
            let law = self.need(&fields, "law").and_then(|f| self.law(&fields, f));
            if law.is_none() {
                place.unread("law");
            }
            let quantity = driven_quantity(&raw.draft.joints, &joint, coordinate.as_deref());
            let law = law.unwrap_or_else(|| Law::constant(0.0)).scaled(self.units.to_si(quantity, 1.0));
            raw.places.push(Section::Drivers, place);
            raw.draft.drivers.push(DriverDraft { name: entry.0, joint, coordinate, law });
        }
    }

    fn law(&mut self, fields: &Fields<'_>, f: Field<'_>) -> Option<Law> {
        let subject = fields.subject("law");
        let text = match f.value.get_ref() {
            DeValue::String(text) => text,
            DeValue::Integer(_) | DeValue::Float(_) => return self.number(f.value, &subject).map(Law::constant),
            _ => {
                self.wrong(f.value, &subject, "an expression in `t`, in quotes");
                return None;
            }
        };
        match Law::parse(text) {
            Ok(law) => Some(law),
            Err(error) => {
                let at = self.inside(f.value, text, error.span);
                let message = format!("the law of {} cannot be read: {}", fields.what, error.message);
                self.report("HP0108", at, message).help = error.help;
                None
            }
        }
    }

    /// Where a part of a text stands in the file; the whole text where escapes make that unclear.
    fn inside(&self, value: &Value<'_>, text: &str, part: Range<usize>) -> Range<usize> {
        let whole = value.span();
        let written = self.source.text.get(whole.clone()).unwrap_or_default();
        for quote in ["\"\"\"", "'''", "\"", "'"] {
            let bare = written.strip_prefix(quote).and_then(|w| w.strip_suffix(quote));
            if bare == Some(text) {
                let start = whole.start + quote.len();
                return start + part.start..start + part.end;
            }
        }
        whole
    }

    fn design(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for entry in self.entries(model, "design", "design variable") {
            let fields = self.entry("design variable", &entry, DESIGN);
            let mut place = EntryPlace::of(&fields);
            let kinds: Vec<_> =
                ["move", "tilt", "fields", "markers"].into_iter().filter(|k| fields.get(k).is_some()).collect();
            let fixed_length = fields.get("fixed_length");
            let fixed_length = fixed_length.and_then(|f| self.boolean(f.value, &fields.subject("fixed_length")));
            let (first, rest) = match kinds.split_first() {
                Some((first, rest)) => (*first, rest),
                None => {
                    let message = format!("{} does not say what it changes", fields.what);
                    self.report("HP0104", fields.at.clone(), message).help = Some(
                        "give one of `move` (with `along`), `tilt` (with `about`), `fields`, `markers`; \
                         for example `move = \"A\"` and `along = \"z\"`"
                            .into(),
                    );
                    place.unread("name");
                    ("", &[][..])
                }
            };
            for key in rest {
                self.out_of_place(&fields, key, format!("this variable is given by `{first}` already"));
            }
            if first != "move" {
                self.out_of_place(&fields, "along", "`along` goes with `move`");
            }
            if first != "tilt" {
                self.out_of_place(&fields, "about", "`about` goes with `tilt`");
            }
            let variables = match first {
                "move" => self.moves(&fields, &entry.0, &mut place),
                "tilt" => self.tilt(&fields, &mut place).map(|c| vec![(entry.0.clone(), vec![c])]),
                "fields" => self.velocity_fields(&fields, &mut place).map(|c| vec![(entry.0.clone(), c)]),
                "markers" => self.markers(&fields, &mut place).map(|c| vec![(entry.0.clone(), c)]),
                _ => None,
            };
            let variables = variables.unwrap_or_else(|| {
                place.unread("name");
                vec![(entry.0.clone(), Vec::new())]
            });
            for (name, changes) in variables {
                raw.places.push(Section::Design, place.clone());
                raw.draft.design.push(VariableDraft { name, changes, fixed_length: fixed_length.unwrap_or(false) });
            }
        }
    }

    /// Hardpoints that move together along one direction, or along each of the three axes.
    fn moves(
        &mut self,
        fields: &Fields<'_>,
        name: &str,
        place: &mut EntryPlace,
    ) -> Option<Vec<(String, Vec<ChangeDraft>)>> {
        let f = fields.get("move")?;
        let subject = fields.subject("move");
        let expected = "a hardpoint's name or a list of names";
        let hardpoints: Option<Vec<String>> = match f.value.get_ref() {
            DeValue::String(_) => {
                place.items("changes", vec![f.value.span()]);
                self.name(f.value, &subject, expected).map(|n| vec![n])
            }
            _ => self.list(f.value, &subject, expected).and_then(|list| {
                place.items("changes", list.iter().map(|v| v.span()).collect());
                let names: Vec<_> = list.iter().map(|v| self.name(v, &subject, expected)).collect();
                names.into_iter().collect()
            }),
        };
        let along = self.need(fields, "along").and_then(|f| match f.value.get_ref().as_str() {
            Some("xyz") => Some(["x", "y", "z"].map(|a| (format!("{name}_{a}"), axis_named(a))).into_iter().collect()),
            Some(word) if axis_named(word).is_none() => {
                let known = ["x", "y", "z", "-x", "-y", "-z", "xyz"];
                self.unknown_word(f.value.span(), &fields.subject("along"), word, &known);
                None
            }
            _ => {
                let v = self.vector(f.value, &fields.subject("along"))?;
                Some(vec![(name.to_owned(), Some(v))])
            }
        });
        let (hardpoints, along): (_, Vec<(String, Option<Vec3>)>) = (hardpoints?, along?);
        let changes = |v: Option<Vec3>| {
            let velocity = v.and_then(Vec3::unit).unwrap_or(Vec3::ZERO);
            hardpoints.iter().map(|h| ChangeDraft::Move { hardpoint: h.clone(), velocity }).collect()
        };
        Some(along.into_iter().map(|(name, v)| (name, changes(v))).collect())
    }

    fn tilt(&mut self, fields: &Fields<'_>, place: &mut EntryPlace) -> Option<ChangeDraft> {
        let f = fields.get("tilt")?;
        place.items("changes", vec![f.value.span()]);
        let joint = self.name(f.value, &fields.subject("tilt"), "the name of a joint");
        let about = self.need(fields, "about").and_then(|f| self.line_of(fields, f, place));
        Some(ChangeDraft::Tilt { joint: joint?, about: about? })
    }

    fn velocity_fields(&mut self, fields: &Fields<'_>, place: &mut EntryPlace) -> Option<Vec<ChangeDraft>> {
        let items = self.tables(fields, "fields", FIELD, place)?;
        let units = self.units;
        let changes: Vec<_> = items
            .iter()
            .map(|f| {
                let joint = self.required(f, "joint", "the name of a joint");
                let body = self.required(f, "body", "the name of a body");
                let v = self.optional_vector(f, "V")?;
                let u = self.optional_vector(f, "U")?;
                let (v, u) = (v.map(|x| units.length.metres(x)), u.map(|x| units.angle.radians(x)));
                Some(ChangeDraft::Field { joint: joint?, body: body?, v: v.into(), u: u.into() })
            })
            .collect();
        changes.into_iter().collect()
    }

    fn markers(&mut self, fields: &Fields<'_>, place: &mut EntryPlace) -> Option<Vec<ChangeDraft>> {
        let items = self.tables(fields, "markers", MARKER, place)?;
        let read: Vec<_> = items
            .iter()
            .map(|f| {
                let joint = self.required(f, "joint", "the name of a joint");
                let end = match f.get("on") {
                    None => Some(End::Both),
                    Some(on) => {
                        let subject = f.subject("on");
                        match self.name(on.value, &subject, "`\"i\"`, `\"j\"` or `\"both\"`")?.as_str() {
                            "i" => Some(End::I),
                            "j" => Some(End::J),
                            "both" => Some(End::Both),
                            word => {
                                self.unknown_word(on.value.span(), &subject, word, &["i", "j", "both"]);
                                None
                            }
                        }
                    }
                };
                let position = self.optional_vector(f, "move")?;
                let rotation = self.optional_vector(f, "turn")?;
                Some((joint?, end?, position, rotation))
            })
            .collect();
        let read: Vec<_> = read.into_iter().collect::<Option<_>>()?;
        // A variable that only moves is a length and one that only turns is an angle: per unit of it the
        // numbers are directions. One that does both is a plain number, so its velocities have units.
        let moves = read.iter().any(|m| m.2 != [0.0; 3]);
        let turns = read.iter().any(|m| m.3 != [0.0; 3]);
        let (length, angle) = match moves && turns {
            true => (self.units.to_si(Quantity::Length, 1.0), self.units.to_si(Quantity::Angle, 1.0)),
            false => (1.0, 1.0),
        };
        Some(
            read.into_iter()
                .map(|(joint, end, position, rotation)| ChangeDraft::Marker {
                    joint,
                    end,
                    position: Vec3::from(position) * length,
                    rotation: Vec3::from(rotation) * angle,
                })
                .collect(),
        )
    }

    /// A list of inline tables.
    fn tables<'a>(
        &mut self,
        fields: &Fields<'a>,
        key: &'static str,
        keys: &'static [Key],
        place: &mut EntryPlace,
    ) -> Option<Vec<Fields<'a>>> {
        let f = fields.get(key)?;
        let subject = fields.subject(key);
        let list = self.list(f.value, &subject, "a list of tables")?;
        place.items("changes", list.iter().map(|v| v.span()).collect());
        let tables: Vec<_> = list
            .into_iter()
            .enumerate()
            .map(|(k, v)| {
                let table = self.table(v, &subject, "a list of tables")?;
                let what = format!("entry {} of `{key}` in {}", k + 1, fields.what);
                Some(self.fields(what, v.span(), table, keys))
            })
            .collect();
        tables.into_iter().collect()
    }

    fn required(&mut self, fields: &Fields<'_>, key: &str, expected: &str) -> Option<String> {
        let f = self.need(fields, key)?;
        self.name(f.value, &fields.subject(key), expected)
    }

    /// Three numbers as written; zeros where they are left out.
    fn optional_vector(&mut self, fields: &Fields<'_>, key: &str) -> Option<[f64; 3]> {
        match fields.get(key) {
            None => Some([0.0; 3]),
            Some(f) => self.numbers::<3>(f.value, &fields.subject(key), "three numbers"),
        }
    }

    fn points(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for entry in self.entries(model, "points", "point") {
            let fields = self.entry("point", &entry, POINT);
            let mut place = EntryPlace::of(&fields);
            let body = self.named(&fields, "body", "the name of a body", &mut place).unwrap_or_default();
            let at = self.need(&fields, "at").and_then(|f| self.place(f.value, &fields.subject("at")));
            place.items("at", Vec::new());
            let at = at.unwrap_or_else(|| {
                place.unread("at");
                Place::At(Vec3::ZERO)
            });
            raw.places.push(Section::Points, place);
            raw.draft.points.push(PointDraft { name: entry.0, body, at });
        }
    }

    fn measures(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for entry in self.entries(model, "measures", "measure") {
            let kind = entry.2.get_ref().as_table().and_then(|t| t.get("type")).and_then(|v| v.get_ref().as_str());
            let keys = match kind {
                Some("coordinate") => COORDINATE,
                Some("distance") => DISTANCE,
                Some("position") => POSITION,
                Some("toe" | "camber") => WHEEL,
                _ => {
                    self.unknown_measure(&entry);
                    continue;
                }
            };
            let fields = self.entry("measure", &entry, keys);
            let mut place = EntryPlace::of(&fields);
            if let Some(kind) = self.measure(kind.unwrap_or_default(), &fields, &mut place) {
                raw.places.push(Section::Measures, place);
                raw.draft.measures.push(MeasureDraft { name: entry.0, kind });
            }
        }
    }

    /// A measure without a known type: which keys it may have is not known either.
    fn unknown_measure(&mut self, entry: &(String, Range<usize>, &Value<'_>)) {
        let (name, at, value) = entry;
        let Some(table) = value.get_ref().as_table() else {
            self.entry("measure", entry, MEASURE);
            return;
        };
        let what = format!("measure `{}`", shown(name));
        let subject = crate::tree::Subject {
            name: format!("`type` of {what}"),
            example: "for example `type = \"coordinate\"`".into(),
        };
        match table.get("type") {
            Some(kind) => match kind.get_ref().as_str() {
                Some(word) => self.unknown_word(kind.span(), &subject, word, &MEASURE_TYPES),
                None => self.wrong(kind, &subject, "the name of a measure type"),
            },
            None => {
                let message = format!("{what} has no `type`");
                self.report("HP0104", at.clone(), message).help =
                    Some(format!("add it; possible: {}", crate::tree::quoted(&MEASURE_TYPES)));
            }
        }
    }

    fn measure(&mut self, kind: &str, fields: &Fields<'_>, place: &mut EntryPlace) -> Option<MeasureKindDraft> {
        match kind {
            "coordinate" => {
                let joint = self.named(fields, "joint", "the name of a joint", place);
                let coordinate = self.optional_name(fields, "coordinate", "the name of a coordinate", place);
                Some(MeasureKindDraft::Coordinate { joint: joint?, coordinate })
            }
            "distance" => {
                let [from, to] =
                    ["from", "to"].map(|key| self.need(fields, key).and_then(|f| self.point_ref(fields, f)));
                Some(MeasureKindDraft::Distance { from: from?, to: to? })
            }
            "position" => {
                let point = self.need(fields, "point").and_then(|f| self.point_ref(fields, f));
                let along = self.need(fields, "along").and_then(|f| self.vector(f.value, &fields.subject("along")));
                Some(MeasureKindDraft::Coordinates { point: point?, along: along? })
            }
            _ => {
                let body = self.named(fields, "body", "the name of a body", place);
                let spin_axis = self.need(fields, "spin_axis").and_then(|f| self.line_of(fields, f, place));
                let (body, spin_axis) = (body?, spin_axis?);
                Some(match kind {
                    "toe" => MeasureKindDraft::Toe { body, spin_axis },
                    _ => MeasureKindDraft::Camber { body, spin_axis },
                })
            }
        }
    }

    fn point_ref(&mut self, fields: &Fields<'_>, f: Field<'_>) -> Option<PointRef> {
        let subject = fields.subject(f.key);
        let Some(table) = f.value.get_ref().as_table() else {
            return self.name(f.value, &subject, "a point's name or `{ body = ..., at = ... }`").map(PointRef::Named);
        };
        let fields = self.fields(subject.name.clone(), f.value.span(), table, POINT);
        let body = self.required(&fields, "body", "the name of a body");
        let at = self.need(&fields, "at").and_then(|f| self.place(f.value, &fields.subject("at")));
        Some(PointRef::On { body: body?, at: at? })
    }

    fn time(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        let Some(f) = model.get("time") else { return };
        let mut place = EntryPlace::at(f.value.span());
        let times = self.times(model, f);
        if times.is_none() {
            place.unread("");
        }
        raw.draft.times = times.unwrap_or_default();
        raw.places.push(Section::Time, place);
    }

    fn times(&mut self, model: &Fields<'_>, f: Field<'_>) -> Option<Vec<f64>> {
        let table = self.table(f.value, &model.subject("time"), "a table with `end` and `steps`")?;
        let fields = self.fields("`time`", f.value.span(), table, TIME);
        if let Some(f) = fields.get("at") {
            for key in ["start", "end", "steps"] {
                self.out_of_place(&fields, key, "the output times are listed in `at` already");
            }
            let subject = fields.subject("at");
            let Some(list) = f.value.get_ref().as_array().filter(|list| !list.is_empty()) else {
                self.wrong(f.value, &subject, "a list of times in s");
                return None;
            };
            if list.len() > MOST_TIMES {
                self.senseless(f.value.span(), format!("there are more than {MOST_TIMES} output times"));
                return None;
            }
            let times: Vec<_> = list.iter().map(|v| self.number(v, &subject)).collect();
            let times: Vec<f64> = times.into_iter().collect::<Option<_>>()?;
            if let Some(k) = (1..times.len()).find(|&k| times[k] <= times[k - 1]) {
                let message = format!("the output time {} s comes after {} s", times[k], times[k - 1]);
                self.senseless(list[k].span(), message).help = Some("list the times in increasing order".into());
                return None;
            }
            return Some(times);
        }
        let start = match fields.get("start") {
            Some(f) => self.number(f.value, &fields.subject("start")),
            None => Some(0.0),
        };
        let end_field = self.need(&fields, "end");
        let end = end_field.and_then(|f| self.number(f.value, &fields.subject("end")));
        let steps_field = self.need(&fields, "steps");
        let steps = steps_field.and_then(|f| {
            let steps = self.number(f.value, &fields.subject("steps"))?;
            if !(steps >= 1.0 && steps <= MOST_TIMES as f64 && steps.fract() == 0.0) {
                let message = format!("`steps` of `time` cannot be {steps}");
                self.senseless(f.value.span(), message).help =
                    Some(format!("give the number of intervals, a whole number from 1 to {MOST_TIMES}"));
                return None;
            }
            Some(steps as usize)
        });
        let (start, end, steps) = (start?, end?, steps?);
        if end <= start {
            let at = end_field.map_or(fields.at.clone(), |f| f.value.span());
            let message = format!("the motion ends at {end} s, before it starts at {start} s");
            self.senseless(at, message).help = Some("give an `end` after `start` (which is 0 if it is left out)".into());
            return None;
        }
        Some((0..=steps).map(|k| start + (end - start) * k as f64 / steps as f64).collect())
    }
}

static EMPTY: std::sync::OnceLock<DeTable<'static>> = std::sync::OnceLock::new();

/// What the law's value is, as far as joint and coordinate are known; the core reports the rest.
fn driven_quantity(joints: &[JointDraft], joint: &str, coordinate: Option<&str>) -> Quantity {
    let kind = joints.iter().find(|j| j.name == joint).and_then(|j| joint::named(&j.kind));
    let coordinate = kind.and_then(|kind| match coordinate {
        Some(name) => kind.coordinate(name).map(|c| c.1),
        None => kind.coordinates.first(),
    });
    coordinate.map_or(Quantity::Number, |c| c.quantity)
}
