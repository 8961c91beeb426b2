//! Design variables.

use std::ops::Range;

use hardpoint::joint::Quantity;
use hardpoint::law::ParameterKind;
use hardpoint::model::{ChangeDraft, End, Section, ShapeDraft, VariableDraft};
use hardpoint::space::Vec3;

use super::Raw;
use crate::places::EntryPlace;
use crate::tree::{Fields, Key, Reader, axis_named};

const DESIGN: &[Key] = &[
    ("move", "\"A\""),
    ("along", "\"z\""),
    ("mirror", "\"y\""),
    ("mirrored", "\"A_right\""),
    ("tilt", "\"J1\""),
    ("about", "\"x\""),
    ("fields", "[{ joint = \"J1\", body = \"crank\", V = [1, 0, 0] }]"),
    ("markers", "[{ joint = \"J1\", on = \"j\", move = [0, 0, 1] }]"),
    ("shape", "\"lca\""),
    ("field", "{ scale = \"A\", along = \"x\" }"),
    ("length", "\"rod\""),
    ("driver", "\"turn\""),
    ("parameter", "\"amplitude\""),
    ("fixed_length", "true"),
    ("bounds", "[-5, 5]"),
    ("typical", "2"),
    ("tolerance", "0.1"),
];
const FIELD: &[Key] = &[("joint", "\"J1\""), ("body", "\"crank\""), ("V", "[1, 0, 0]"), ("U", "[0, 0, 0]")];
const MARKER: &[Key] = &[("joint", "\"J1\""), ("on", "\"j\""), ("move", "[0, 0, 1]"), ("turn", "[0, 0, 0]")];

const SHAPE: &[Key] = &[
    ("translate", "\"z\""),
    ("rotate", "\"z\""),
    ("at", "\"A\""),
    ("scale", "\"A\""),
    ("along", "\"x\""),
    ("bend", "[\"A\", \"B\"]"),
    ("towards", "\"z\""),
    ("through", "[{ at = \"A\", move = [0, 0, 1] }]"),
];
const THROUGH: &[Key] = &[("at", "\"A\""), ("move", "[0, 0, 1]")];

impl Reader<'_> {
    pub(super) fn design(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for entry in self.entries(model, "design", "design variable") {
            let fields = self.entry("design variable", &entry, DESIGN);
            let mut place = EntryPlace::of(&fields);
            let kinds: Vec<_> = ["move", "tilt", "fields", "markers", "shape", "length", "driver"]
                .into_iter()
                .filter(|k| fields.get(k).is_some())
                .collect();
            let fixed_length = fields.get("fixed_length");
            let fixed_length =
                fixed_length.and_then(|f| self.boolean(f.value, &fields.subject("fixed_length")));
            let (first, rest) = match kinds.split_first() {
                Some((first, rest)) => (*first, rest),
                None => {
                    let message = format!("{} does not say what it changes", fields.what);
                    self.report("HP0104", fields.at.clone(), message).help = Some(
                        "give one of `move` (with `along`), `tilt` (with `about`), `fields`, `markers`, `shape` (with \
                         `field`), `length`, `driver` (with `parameter`); for example `move = \"A\"` and `along = \"z\"`"
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
                for key in ["along", "mirror", "mirrored"] {
                    self.out_of_place(&fields, key, format!("`{key}` goes with `move`"));
                }
            }
            if first != "tilt" {
                self.out_of_place(&fields, "about", "`about` goes with `tilt`");
            }
            if first != "shape" {
                self.out_of_place(&fields, "field", "`field` goes with `shape`");
            }
            if first != "driver" {
                self.out_of_place(&fields, "parameter", "`parameter` goes with `driver`");
            }
            let variables = match first {
                "move" => self.moves(&fields, &entry.0, &mut place),
                "tilt" => self.tilt(&fields, &mut place).map(|c| vec![(entry.0.clone(), vec![c])]),
                "fields" => self.velocity_fields(&fields, &mut place).map(|c| vec![(entry.0.clone(), c)]),
                "markers" => self.markers(&fields, &mut place).map(|c| vec![(entry.0.clone(), c)]),
                "shape" => self.shape(&fields, &mut place).map(|c| vec![(entry.0.clone(), vec![c])]),
                "length" => self.rod_length(&fields, &mut place).map(|c| vec![(entry.0.clone(), vec![c])]),
                "driver" => {
                    self.law_parameter(&fields, raw, &mut place).map(|c| vec![(entry.0.clone(), vec![c])])
                }
                _ => None,
            };
            let variables = variables.unwrap_or_else(|| {
                place.unread("name");
                vec![(entry.0.clone(), Vec::new())]
            });
            let quantity = quantity_of(raw, &variables[0].1);
            let (bounds, [typical, tolerance]) = self.range(&fields, quantity, &mut place);
            for (name, changes) in variables {
                raw.places.push(Section::Design, place.clone());
                raw.draft.design.push(VariableDraft {
                    name,
                    changes,
                    fixed_length: fixed_length.unwrap_or(false),
                    bounds,
                    typical,
                    tolerance,
                });
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
        let mut items = Vec::new();
        let hardpoints = self.hardpoint_names(fields, "move", &mut items);
        let mirrored = self.mirrored(fields, &mut items);
        place.items("changes", items);
        let along = self.need(fields, "along").and_then(|f| match f.value.get_ref().as_str() {
            Some("xyz") => {
                Some(["x", "y", "z"].map(|a| (format!("{name}_{a}"), axis_named(a))).into_iter().collect())
            }
            Some(word) if axis_named(word).is_none() => {
                let known = ["x", "y", "z", "-x", "-y", "-z", "xyz"];
                self.unknown_word(f.value.span(), &fields.subject("along"), word, &known);
                None
            }
            _ => {
                let subject = fields.subject("along");
                let unit = self.vector(f.value, &subject)?.unit();
                if unit.is_none() {
                    self.senseless(f.value.span(), format!("{} has no direction", subject.name)).help =
                        Some(subject.example);
                }
                Some(vec![(name.to_owned(), Some(unit?))])
            }
        });
        let (hardpoints, mirrored, along): (_, _, Vec<(String, Option<Vec3>)>) =
            (hardpoints?, mirrored?, along?);
        let changes = |v: Option<Vec3>| {
            let velocity = v.unwrap_or(Vec3::ZERO);
            let one = |h: &String| ChangeDraft::Move { hardpoint: h.clone(), velocity };
            let other = mirrored.iter().flat_map(|(normal, names)| {
                let velocity = velocity - *normal * (2.0 * velocity.dot(*normal));
                names.iter().map(move |h| ChangeDraft::Move { hardpoint: h.clone(), velocity })
            });
            hardpoints.iter().map(one).chain(other).collect()
        };
        Some(along.into_iter().map(|(name, v)| (name, changes(v))).collect())
    }

    /// The names of one hardpoint or several; where each stands goes to `places`.
    fn hardpoint_names(
        &mut self,
        fields: &Fields<'_>,
        key: &str,
        places: &mut Vec<Range<usize>>,
    ) -> Option<Vec<String>> {
        let f = self.need(fields, key)?;
        let (subject, expected) = (fields.subject(key), "a hardpoint's name or a list of names");
        if f.value.get_ref().is_str() {
            places.push(f.value.span());
            return self.name(f.value, &subject, expected).map(|n| vec![n]);
        }
        let list = self.list(f.value, &subject, expected)?;
        places.extend(list.iter().map(|v| v.span()));
        let names: Vec<_> = list.iter().map(|v| self.name(v, &subject, expected)).collect();
        names.into_iter().collect()
    }

    /// The normal of the mirror and the hardpoints behind it, if there is one; their places follow the others.
    fn mirrored(
        &mut self,
        fields: &Fields<'_>,
        items: &mut Vec<Range<usize>>,
    ) -> Option<Option<(Vec3, Vec<String>)>> {
        if fields.get("mirror").is_none() && fields.get("mirrored").is_none() {
            return Some(None);
        }
        let normal = self.need(fields, "mirror").and_then(|f| {
            let subject = fields.subject("mirror");
            let word =
                self.name(f.value, &subject, "the axis square to the mirror: `\"x\"`, `\"y\"` or `\"z\"`")?;
            let axis = ["x", "y", "z"].iter().position(|a| *a == word);
            if axis.is_none() {
                self.unknown_word(f.value.span(), &subject, &word, &["x", "y", "z"]);
            }
            axis.map(|k| Vec3::AXES[k])
        });
        let names = self.hardpoint_names(fields, "mirrored", items);
        Some(Some((normal?, names?)))
    }

    fn tilt(&mut self, fields: &Fields<'_>, place: &mut EntryPlace) -> Option<ChangeDraft> {
        let f = fields.get("tilt")?;
        place.items("changes", vec![f.value.span()]);
        let joint = self.name(f.value, &fields.subject("tilt"), "the name of a joint");
        let about = self.need(fields, "about").and_then(|f| self.line_of(fields, f, place));
        Some(ChangeDraft::Tilt { joint: joint?, about: about? })
    }

    /// A velocity field over whole bodies.
    fn shape(&mut self, fields: &Fields<'_>, place: &mut EntryPlace) -> Option<ChangeDraft> {
        let f = fields.get("shape")?;
        place.items("changes", vec![f.value.span()]);
        let (subject, expected) = (fields.subject("shape"), "a body's name or a list of names");
        let bodies = match f.value.get_ref().as_array() {
            None => self.name(f.value, &subject, expected).map(|n| vec![n]),
            Some(list) => list.iter().map(|v| self.name(v, &subject, expected)).collect(),
        };
        let f = self.need(fields, "field")?;
        let table = self.table(f.value, &fields.subject("field"), "a table that says how points move")?;
        let field = self.fields(format!("`field` of {}", fields.what), f.value.span(), table, SHAPE);
        let kinds: Vec<&str> = ["translate", "rotate", "scale", "bend", "through"]
            .into_iter()
            .filter(|k| field.get(k).is_some())
            .collect();
        let &[kind] = kinds.as_slice() else {
            let message = format!("{} does not say in one way how points move", field.what);
            self.report("HP0104", field.at.clone(), message).help = Some(
                "give one of `translate = \"z\"`, `rotate = \"z\"` with `at = \"A\"`, `scale = \"A\"`, `bend = [\"A\", \"B\"]` with \
                 `towards = \"z\"`, `through = [{ at = \"A\", move = [0, 0, 1] }]`"
                    .into(),
            );
            return None;
        };
        for (key, goes_with) in [("at", "rotate"), ("along", "scale"), ("towards", "bend")] {
            if kind != goes_with {
                self.out_of_place(&field, key, format!("`{key}` goes with `{goes_with}`"));
            }
        }
        let field = self.shape_field(kind, &field, place)?;
        Some(ChangeDraft::Shape { bodies: bodies?, field })
    }

    fn shape_field(&mut self, kind: &str, fields: &Fields<'_>, place: &mut EntryPlace) -> Option<ShapeDraft> {
        let f = fields.get(kind)?;
        let subject = fields.subject(f.key);
        Some(match kind {
            "translate" => ShapeDraft::Translate(self.vector(f.value, &subject)?),
            "rotate" => {
                let about = self.line_of(fields, f, place);
                let at = self.required(fields, "at", "a hardpoint's name");
                ShapeDraft::Rotate { about: about?, at: at? }
            }
            "scale" => {
                let from = self.name(f.value, &subject, "a hardpoint's name");
                let along = match fields.get("along") {
                    Some(f) => Some(self.line_of(fields, f, place)?),
                    None => None,
                };
                ShapeDraft::Scale { from: from?, along }
            }
            "bend" => {
                let expected = "a list of two hardpoints' names";
                let names = self.list(f.value, &subject, expected)?;
                let names: Vec<_> = names.iter().map(|v| self.name(v, &subject, expected)).collect();
                let Ok([from, to]) = <[Option<String>; 2]>::try_from(names) else {
                    self.wrong(f.value, &subject, expected);
                    return None;
                };
                let towards = self.need(fields, "towards");
                let towards = towards.and_then(|f| self.vector(f.value, &fields.subject("towards")));
                ShapeDraft::Bend { from: from?, to: to?, towards: towards? }
            }
            _ => {
                let items = self.tables(fields, "through", THROUGH, &mut EntryPlace::of(fields))?;
                let moves: Vec<_> = items
                    .iter()
                    .map(|f| {
                        let at = self.required(f, "at", "a hardpoint's name");
                        let v = self.optional_vector(f, "move");
                        Some((at?, v?.into()))
                    })
                    .collect();
                ShapeDraft::Through(moves.into_iter().collect::<Option<_>>()?)
            }
        })
    }

    fn rod_length(&mut self, fields: &Fields<'_>, place: &mut EntryPlace) -> Option<ChangeDraft> {
        let f = fields.get("length")?;
        place.items("changes", vec![f.value.span()]);
        let joint = self.name(f.value, &fields.subject("length"), "the name of a joint")?;
        Some(ChangeDraft::Length { joint, rate: 1.0 })
    }

    /// A parameter of a driver's law. The variable is in the file's unit of the parameter: a length or an angle is
    /// converted where the variable is, and a rate of one, which is a plain number to the core, here.
    fn law_parameter(
        &mut self,
        fields: &Fields<'_>,
        raw: &Raw,
        place: &mut EntryPlace,
    ) -> Option<ChangeDraft> {
        let f = fields.get("driver")?;
        place.items("changes", vec![f.value.span()]);
        let driver = self.name(f.value, &fields.subject("driver"), "the name of a driver");
        let parameter = self.required(fields, "parameter", "the name of a parameter");
        let (driver, parameter) = (driver?, parameter?);
        let k = raw.draft.drivers.iter().position(|d| d.name == driver);
        let rate = match k.map(|k| &raw.driver_rates[k]) {
            Some((per_unit, rates, _)) if rates.contains(&parameter) => *per_unit,
            _ => 1.0,
        };
        Some(ChangeDraft::Law { driver, parameter, rate })
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

    pub(super) fn required(&mut self, fields: &Fields<'_>, key: &str, expected: &str) -> Option<String> {
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
}

/// What a variable measures, as far as that is known; the core says the rest.
fn quantity_of(raw: &Raw, changes: &[ChangeDraft]) -> Quantity {
    let of = |change: &ChangeDraft| match change {
        ChangeDraft::Move { .. } | ChangeDraft::Length { .. } => Quantity::Length,
        ChangeDraft::Shape { field, .. } => match field {
            ShapeDraft::Rotate { .. } => Quantity::Angle,
            ShapeDraft::Scale { .. } => Quantity::Number,
            _ => Quantity::Length,
        },
        ChangeDraft::Tilt { .. } => Quantity::Angle,
        ChangeDraft::Marker { position, rotation, .. } => {
            match (*position != Vec3::ZERO, *rotation != Vec3::ZERO) {
                (_, false) => Quantity::Length,
                (false, true) => Quantity::Angle,
                (true, true) => Quantity::Number,
            }
        }
        ChangeDraft::Law { driver, parameter, .. } => {
            let k = raw.draft.drivers.iter().position(|d| d.name == *driver);
            let kind = k.and_then(|k| {
                raw.draft.drivers[k].law.parameters().into_iter().find(|p| p.name == *parameter)
            });
            match (kind.map(|p| p.kind), k) {
                (Some(ParameterKind::Value), Some(k)) => raw.driver_rates[k].2,
                (Some(ParameterKind::Angle), _) => Quantity::Angle,
                _ => Quantity::Number,
            }
        }
        ChangeDraft::Field { .. } | ChangeDraft::Parameter { .. } => Quantity::Number,
    };
    let mut quantities = changes.iter().map(of);
    let first = quantities.next().unwrap_or(Quantity::Number);
    if quantities.all(|q| q == first) { first } else { Quantity::Number }
}
