//! Design variables.

use std::collections::HashMap;
use std::ops::Range;

use hardpoint::draft::{ChangeDraft, Section, ShapeDraft, VariableDraft};
use hardpoint::joint::Quantity;
use hardpoint::law::ParameterKind;
use hardpoint::model::End;
use hardpoint::space::Vec3;

use crate::values::{
    ANGLE, AXES, BODY, DIRECTION, DRIVER, EntryPlace, Fields, HARDPOINT, JOINT, Key, Kinds, LENGTH, LINE,
    NUMBER, Reader, Shape, TWO_NUMBERS, Table, Value, all_read, axis_named, keys, table,
};

use super::parameters;
use super::raw::Raw;

pub(crate) const VARIABLE: Kinds = Kinds {
    name: "Variable",
    doc: "A design variable, given by exactly one of {keys}.",
    typed: false,
    tables: || KINDS.iter().map(|k| &k.0).collect(),
};
/// Reads the changes of a variable with this name.
type Read = fn(&mut Reader<'_>, &Fields<'_>, &str, &Raw, &mut EntryPlace) -> Option<Changes>;
/// Changes of one or several variables, by name.
type Changes = Vec<(String, Vec<ChangeDraft>)>;

/// Declares a kind of design variable, with the shared keys.
macro_rules! variable {
    ($($table:tt)*) => { Table { shared: RANGE, ..table! { $($table)* } } };
}

static KINDS: &[(Table, Read)] = &[
    (
        variable! {
            /// Hardpoints move; all joints, axes and points on them follow. A length.
            "Move":
            /// A hardpoint's name, or a list of names that move together.
            must "move": HARDPOINTS, "\"A\"";
            /// The direction; `"xyz"` makes three variables, NAME_x, NAME_y and NAME_z.
            must "along": Shape::Any("Along", "", &[AXES, Shape::Any("AllAxes", "", &[Shape::Words(&[("xyz", "")])]), THREE]), "\"z\"";
            /// The global axis perpendicular to a mirror through the origin, behind which `mirrored` hardpoints move:
            /// `"y"` between left and right.
            may "mirror": Shape::Words(&[("x", ""), ("y", ""), ("z", "")]), "\"y\"";
            /// A hardpoint's name, or a list of names, that move as the mirror image of `move`.
            may "mirrored": HARDPOINTS, "\"A_right\"";
        },
        |r, fields, name, _, place| moves(r, fields, name, place),
    ),
    (
        variable! {
            /// Both markers of a joint rotate about a direction through their location. An angle.
            "Tilt":
            /// The joint's name.
            must "tilt": JOINT, "\"J1\"";
            /// The rotation axis.
            must "about": LINE, "\"x\"";
        },
        |r, fields, name, _, place| {
            place.changes(fields, "tilt");
            let joint = r.name_of(fields, "tilt");
            let about = r.line_of(fields, "about", place);
            one(name, ChangeDraft::Tilt { joint: joint?, about: about? })
        },
    ),
    (
        variable! {
            /// Play of a joint: its pin is off the centre of its hole by NAME_x and NAME_y, perpendicular to its axis;
            /// a ball by NAME_x, NAME_y and NAME_z. Lengths.
            "Play":
            /// The joint's name: revolute, cylindrical or spherical.
            must "play": JOINT, "\"J1\"";
        },
        |r, fields, name, raw, place| {
            place.changes(fields, "play");
            let joint = r.name_of(fields, "play")?;
            let kind = raw
                .draft
                .joints
                .iter()
                .find(|j| j.name == joint)
                .and_then(|j| hardpoint::joint::named(&j.kind));
            // A joint that is not known, or has no play, is reported by the core.
            let along = kind.map(|kind| kind.play()).filter(|along| !along.is_empty()).unwrap_or(&[0]);
            let one = |along: &usize| {
                let change = ChangeDraft::Play { joint: joint.clone(), along: *along };
                (format!("{name}_{}", ["x", "y", "z"][*along]), vec![change])
            };
            Some(along.iter().map(one).collect())
        },
    ),
    (
        variable! {
            /// Design velocities V and U of single markers, under one parameter. A plain number.
            "Fields":
            /// The markers.
            must "fields": Shape::list(&Shape::Table(&FIELD)), "[{ joint = \"J1\", body = \"crank\", V = [1, 0, 0] }]";
        },
        |r, fields, name, _, place| {
            place.changes(fields, "fields");
            Some(vec![(name.to_owned(), velocity_fields(r, fields)?)])
        },
    ),
    (
        variable! {
            /// Markers of joints move and rotate; hardpoints stay.
            "Markers":
            /// The markers.
            must "markers": Shape::list(&Shape::Table(&MARKER)), "[{ joint = \"J1\", on = \"j\", move = [0, 0, 1] }]";
        },
        |r, fields, name, _, place| {
            place.changes(fields, "markers");
            Some(vec![(name.to_owned(), markers(r, fields)?)])
        },
    ),
    (
        variable! {
            /// Whole bodies change their shape, and everything on them follows. The unit is that of the `field`.
            "Shape":
            /// A body's name, or a list of names.
            must "shape": BODIES, "\"lca\"";
            /// Velocity field of the points.
            must "field": Shape::Kinds(&SHAPE_FIELD), "{ scale = \"A\", along = \"x\" }";
        },
        |r, fields, name, _, place| {
            place.changes(fields, "shape");
            let bodies = several(r, fields, "shape", &mut Vec::new());
            let field = r.given(fields, "field", |r, f| {
                let table =
                    r.table(f.value, &fields.subject("field"), "a table with the motion of the points")?;
                let what = format!("`field` of {}", fields.what);
                let field = r.fields(what, f.value.span(), table, SHAPE_FIELD.keys());
                let (_, read) = r.led_by(&field, FIELDS, ["motion of its points", "this field is given"])?;
                read(r, &field, place)
            });
            one(name, ChangeDraft::Shape { bodies: bodies?, field: field? })
        },
    ),
    (
        variable! {
            /// The `length` that a rod is given grows. A length.
            "RodLength":
            /// The rod's name.
            must "length": JOINT, "\"rod\"";
        },
        |r, fields, name, _, place| {
            place.changes(fields, "length");
            one(name, ChangeDraft::Length { joint: r.name_of(fields, "length")?, rate: 1.0 })
        },
    ),
    (
        variable! {
            /// A parameter of a driver's law grows; the variable has the parameter's unit.
            "LawParameter":
            /// The driver's name.
            must "driver": DRIVER, "\"turn\"";
            /// The parameter's name, such as `amplitude`, `c1`, `f[3]` or `piece[0].speed`.
            must "parameter": Shape::Name("a parameter"), "\"amplitude\"";
        },
        |r, fields, name, raw, place| {
            place.changes(fields, "driver");
            one(name, law_parameter(r, fields, raw)?)
        },
    ),
];

const RANGE: &[Key] = keys! {
    /// True if rods and legs keep their lengths when their ends move, so that the mechanism is re-assembled; else the
    /// lengths follow the design configuration.
    or("false") "fixed_length": Shape::Flag, "true";
    /// Lower and upper bound, in the variable's unit; the nominal value is 0.
    may "bounds": TWO_NUMBERS, "[-5, 5]";
    /// Typical size of a change, in the variable's unit, used to compare variables.
    may "typical": NUMBER, "2";
    /// Manufacturing tolerance, plus or minus, in the variable's unit; `whatif` also ranks by it.
    may "tolerance": NUMBER, "0.1";
};
const HARDPOINTS: Shape = Shape::Any("Names", "", &[HARDPOINT, Shape::list(&HARDPOINT)]);
const BODIES: Shape = Shape::Any("Names", "", &[BODY, Shape::list(&BODY)]);
const THREE: Shape = Shape::exactly(3, &NUMBER);
pub(super) const FIELD: Table = table! {
    /// The design velocity of one joint's marker on one body, in that body's frame.
    "Field":
    /// The joint's name.
    must "joint": JOINT, "\"J1\"";
    /// The body of the marker.
    must "body": BODY, "\"crank\"";
    /// Location velocity, length unit per unit of the parameter. Default: zero.
    may "V": Shape::exactly(3, &LENGTH), "[1, 0, 0]";
    /// Rates of the marker's 3-1-3 Euler angles, angle unit per unit of the parameter. Default: zero.
    may "U": Shape::exactly(3, &ANGLE), "[0, 0, 0]";
};
pub(super) const MARKER: Table = table! {
    /// A global velocity of a joint's markers.
    "Marker":
    /// The joint's name.
    must "joint": JOINT, "\"J1\"";
    /// The marker on body i, on body j, or both.
    or("\"both\"") "on": Shape::Words(&[("i", ""), ("j", ""), ("both", "")]), "\"j\"";
    /// Global displacement per unit of the variable. Default: zero.
    may "move": THREE, "[0, 0, 1]";
    /// Global rotation vector per unit of the variable, about the marker's place. Default: zero.
    may "turn": THREE, "[0, 0, 0]";
};

pub(super) const SHAPE_FIELD: Kinds = Kinds {
    name: "ShapeField",
    doc: "The motion of the points of a body.",
    typed: false,
    tables: || FIELDS.iter().map(|f| &f.0).collect(),
};
type ReadField = fn(&mut Reader<'_>, &Fields<'_>, &mut EntryPlace) -> Option<ShapeDraft>;

static FIELDS: &[(Table, ReadField)] = &[
    (
        table! {
            /// A translation. A length.
            "Translate":
            /// The direction, of any length.
            must "translate": DIRECTION, "\"z\"";
        },
        |r, fields, _| r.vector_of(fields, "translate").map(ShapeDraft::Translate),
    ),
    (
        table! {
            /// A rotation about a line. An angle.
            "Rotate":
            /// The line's direction.
            must "rotate": LINE, "\"z\"";
            /// A hardpoint on it.
            must "at": HARDPOINT, "\"A\"";
        },
        |r, fields, place| {
            let about = r.line_of(fields, "rotate", place);
            let at = r.name_of(fields, "at");
            Some(ShapeDraft::Rotate { about: about?, at: at? })
        },
    ),
    (
        table! {
            /// A scaling from a point. A plain number; 1 doubles the size.
            "Scale":
            /// The fixed hardpoint.
            must "scale": HARDPOINT, "\"A\"";
            /// The only direction of scaling. Default: all directions.
            may "along": LINE, "\"x\"";
        },
        |r, fields, place| {
            let from = r.name_of(fields, "scale");
            let along = r.line_of(fields, "along", place);
            (along.is_some() || fields.get("along").is_none()).then_some(())?;
            Some(ShapeDraft::Scale { from: from?, along })
        },
    ),
    (
        table! {
            /// A bending like a beam. The deflection of its free end, a length.
            "Bend":
            /// The hardpoints of the clamped and of the free end.
            must "bend": Shape::exactly(2, &HARDPOINT), "[\"A\", \"B\"]";
            /// The direction, of any length; only its part perpendicular to the beam is used.
            must "towards": DIRECTION, "\"z\"";
        },
        |r, fields, _| {
            let ends = r.names_of::<2>(fields, "bend");
            let towards = r.vector_of(fields, "towards");
            let [from, to] = ends?;
            Some(ShapeDraft::Bend { from, to, towards: towards? })
        },
    ),
    (
        table! {
            /// A smooth interpolation of displacements of some hardpoints. A length.
            "ThroughPoints":
            /// The hardpoints.
            must "through": Shape::list(&Shape::Table(&THROUGH)), "[{ at = \"A\", move = [0, 0, 1] }]";
        },
        |r, fields, _| {
            let points = r.tables(fields, "through", &THROUGH)?;
            let moves = all_read(points.iter().map(|f| {
                let at = r.name_of(f, "at");
                let v = optional_vector(r, f, "move");
                Some((at?, v?))
            }));
            moves.map(ShapeDraft::Through)
        },
    ),
];
const THROUGH: Table = table! {
    /// Motion of a hardpoint.
    "ThroughPoint":
    /// Name.
    must "at": HARDPOINT, "\"A\"";
    /// Displacement per unit of the variable; zero if left out.
    may "move": Shape::exactly(3, &Shape::Plain(Quantity::Number)), "[0, 0, 1]";
};

/// The single change of a variable.
fn one(name: &str, change: ChangeDraft) -> Option<Changes> {
    Some(vec![(name.to_owned(), vec![change])])
}

/// `twins` are further changes of variables, by name.
pub(super) fn design(
    r: &mut Reader<'_>,
    model: &Fields<'_>,
    raw: &mut Raw,
    twins: &HashMap<String, Value<'_>>,
) {
    for entry in r.entries(model, "design", "design variable") {
        let fields = r.entry("design variable", &entry, VARIABLE.keys());
        let mut place = EntryPlace::of(&fields);
        let fixed_length = r.flag_of(&fields, "fixed_length");
        let kind = r.led_by(&fields, KINDS, ["change", "this variable is given"]);
        let mut variables = kind.and_then(|(_, read)| read(r, &fields, &entry.0, raw, &mut place));
        if let (Some((_, read)), Some(all), Some(twin)) = (kind, &mut variables, twins.get(&entry.0)) {
            let twin = (entry.0.clone(), entry.1.clone(), twin);
            let fields = r.entry("design variable", &twin, VARIABLE.keys());
            let others = read(r, &fields, &twin.0, raw, &mut EntryPlace::of(&fields));
            for (one, other) in all.iter_mut().zip(others.into_iter().flatten()) {
                one.1.extend(other.1);
            }
        }
        if variables.is_none() {
            r.unread.push("name");
        }
        let variables = variables.unwrap_or_else(|| vec![(entry.0.clone(), Vec::new())]);
        let quantity = ChangeDraft::quantity_of(&variables[0].1, |_| None, |driver| raw.driver(driver));
        let (bounds, [typical, tolerance]) = parameters::range(r, &fields, quantity);
        let fixed_length = fixed_length.unwrap_or(false);
        let unread = std::mem::take(&mut r.unread);
        for (name, changes) in variables {
            r.unread.clone_from(&unread);
            raw.push(r, Section::Design, place.clone());
            raw.draft.design.push(VariableDraft { name, changes, fixed_length, bounds, typical, tolerance });
        }
    }
}

/// Hardpoints that move together along one direction, or along each of the three axes.
fn moves(
    r: &mut Reader<'_>,
    fields: &Fields<'_>,
    name: &str,
    place: &mut EntryPlace,
) -> Option<Vec<(String, Vec<ChangeDraft>)>> {
    let mut items = Vec::new();
    let hardpoints = several(r, fields, "move", &mut items);
    let mirrored = mirrored(r, fields, &mut items);
    place.items("changes", items);
    let along = r.given(fields, "along", |r, f| match f.value.get_ref().as_str() {
        Some("xyz") => {
            Some(["x", "y", "z"].map(|a| (format!("{name}_{a}"), axis_named(a))).into_iter().collect())
        }
        Some(word) if axis_named(word).is_none() => {
            let plane = r.plane;
            let all = plane.unwrap_or("xyz");
            let known = ["x", "y", "z", "-x", "-y", "-z", all];
            let d = r.unknown_word(f.value.span(), &fields.subject("along"), word, &known);
            // Two coordinates, as in a plane.
            if word.len() == 2 && word.chars().all(|c| ('x'..='z').contains(&c)) {
                let why = match plane {
                    Some(_) => "It is the plane of the model",
                    None => "Only a model with `planar` has points of two coordinates",
                };
                d.help = Some(format!("did you mean `{all}`? {why}"));
            }
            None
        }
        _ => {
            let subject = fields.subject("along");
            let unit = r.vector(f.value, &subject)?.unit();
            if unit.is_none() {
                r.senseless(f.value.span(), format!("{} has no direction", subject.name)).help =
                    Some(subject.example);
            }
            Some(vec![(name.to_owned(), Some(unit?))])
        }
    });
    let (hardpoints, mirrored, along): (_, _, Vec<(String, Option<Vec3>)>) = (hardpoints?, mirrored?, along?);
    let changes = |v: Option<Vec3>| {
        let velocity = v.unwrap_or(Vec3::ZERO);
        let one = |h: &String| ChangeDraft::Move { hardpoint: h.clone(), velocity };
        let other = mirrored.iter().flat_map(|(normal, names)| {
            let velocity = velocity.mirrored(*normal);
            names.iter().map(move |h| ChangeDraft::Move { hardpoint: h.clone(), velocity })
        });
        hardpoints.iter().map(one).chain(other).collect()
    };
    Some(along.into_iter().map(|(name, v)| (name, changes(v))).collect())
}

/// Reads one name or several; their locations are added to `places`.
fn several(
    r: &mut Reader<'_>,
    fields: &Fields<'_>,
    key: &str,
    places: &mut Vec<Range<usize>>,
) -> Option<Vec<String>> {
    let Shape::Any(_, _, [one, _]) = fields.key(key).shape else { return None };
    let (subject, expected) = (fields.subject(key), format!("{} or a list of names", one.noun()));
    r.given(fields, key, |r, f| {
        if f.value.get_ref().is_str() {
            places.push(f.value.span());
            return r.name(f.value, &subject, &expected).map(|n| vec![n]);
        }
        let list = r.list(f.value, &subject, &expected)?;
        places.extend(list.iter().map(|v| v.span()));
        all_read(list.iter().map(|v| r.name(v, &subject, &expected)))
    })
}

/// Normal of the mirror and the mirrored hardpoints, if any; their locations follow the others.
fn mirrored(
    r: &mut Reader<'_>,
    fields: &Fields<'_>,
    items: &mut Vec<Range<usize>>,
) -> Option<Option<(Vec3, Vec<String>)>> {
    let both = ["mirror", "mirrored"];
    if both.iter().all(|key| fields.get(key).is_none()) {
        return Some(None);
    }
    for key in both {
        r.need(fields, key);
    }
    let normal = r.word_of(fields, "mirror").map(|k| Vec3::AXES[k]);
    let names = several(r, fields, "mirrored", items);
    Some(Some((normal?, names?)))
}

/// A parameter of a driver's law. The variable is in the file's unit of the parameter: a length or an angle is
/// converted where the variable is, and a rate of one, which is a plain number to the core, here.
fn law_parameter(r: &mut Reader<'_>, fields: &Fields<'_>, raw: &Raw) -> Option<ChangeDraft> {
    let [driver, parameter] = ["driver", "parameter"].map(|key| r.name_of(fields, key));
    let (driver, parameter) = (driver?, parameter?);
    let kind = raw.driver(&driver).and_then(|(law, driven)| {
        let parameter = law.parameters().into_iter().find(|p| p.name == parameter)?;
        Some((parameter.kind, driven))
    });
    let rate = match kind {
        Some((ParameterKind::ValueRate(_), driven)) => r.units.to_si(driven, 1.0),
        _ => 1.0,
    };
    Some(ChangeDraft::Law { driver, parameter, rate })
}

fn velocity_fields(r: &mut Reader<'_>, fields: &Fields<'_>) -> Option<Vec<ChangeDraft>> {
    let tables = r.tables(fields, "fields", &FIELD)?;
    all_read(tables.iter().map(|f| {
        let [joint, body] = ["joint", "body"].map(|key| r.name_of(f, key));
        let [v, u] = ["V", "U"].map(|key| optional_vector(r, f, key));
        Some(ChangeDraft::Field { joint: joint?, body: body?, v: v?, u: u? })
    }))
}

fn markers(r: &mut Reader<'_>, fields: &Fields<'_>) -> Option<Vec<ChangeDraft>> {
    let tables = r.tables(fields, "markers", &MARKER)?;
    let mut changes = all_read(tables.iter().map(|f| {
        let joint = r.name_of(f, "joint");
        let end = r.word_of(f, "on").map(|k| [End::I, End::J, End::Both][k]);
        let [position, rotation] = ["move", "turn"].map(|key| optional_vector(r, f, key));
        Some(ChangeDraft::Marker { joint: joint?, end: end?, position: position?, rotation: rotation? })
    }))?;
    // Per unit of a length or an angle the numbers are directions; those of a plain number have units.
    if ChangeDraft::quantity_of(&changes, |_| None, |_| None) == Quantity::Number {
        let [length, angle] = [Quantity::Length, Quantity::Angle].map(|q| r.units.to_si(q, 1.0));
        for change in &mut changes {
            if let ChangeDraft::Marker { position, rotation, .. } = change {
                (*position, *rotation) = (*position * length, *rotation * angle);
            }
        }
    }
    Some(changes)
}

/// Three numbers, converted to SI as declared; zeros if left out.
fn optional_vector(r: &mut Reader<'_>, fields: &Fields<'_>, key: &str) -> Option<Vec3> {
    let numbers = r.list_of::<3>(fields, key, "three numbers");
    if fields.get(key).is_none() { Some(Vec3::ZERO) } else { numbers.map(Vec3::from) }
}
