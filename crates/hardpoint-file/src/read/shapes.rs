//! Shapes of bodies, and the clearances between them.

use hardpoint::draft::{
    BetweenDraft, BodyShapeDraft, BodyShapeKindDraft, ClearanceDraft, EndsDraft, FrameDraft, LocationDraft,
    MeasureDraft, MeasureKindDraft, MetricDraft, MinimumDraft, NumberDraft, PointRef, Section,
};
use hardpoint::expression::Expression;
use hardpoint::model::{ElementUnit, Reduction};
use hardpoint::space::{Pose, Vec3};

use crate::values::{
    BODY, EntryPlace, Field, Fields, Kinds, LENGTH, LINE, Need, PLACE, Reader, Shape, Subject, Table, Value,
    all_read, keys, table,
};

use super::raw::Raw;
use super::{bodies, declared, mesh};

pub(crate) const SHAPE: Kinds = Kinds {
    name: "BodyShape",
    doc: "A shape of a body, for clearances: exactly one of {keys}.",
    typed: false,
    tables: || FORMS.iter().map(|f| &f.0).collect(),
};
type Read = fn(&mut Reader<'_>, &Fields<'_>, &mut EntryPlace, &Raw) -> Option<ReadShape>;
/// A kind of shape, and its rounding.
type ReadShape = (BodyShapeKindDraft, Option<NumberDraft>);

const ENDS: Shape = Shape::Any(
    "Ends",
    "Two ends: hardpoints' names or coordinates in the design configuration, or the name of a rod, leg or spring.",
    &[Shape::exactly(2, &PLACE), Shape::Name("a joint")],
);

/// A form of shape, with the shared keys.
macro_rules! form {
    ($($table:tt)*) => {
        Table {
            shared: keys! {
                /// Name of a group of shapes, which clearances may name.
                may "group": Shape::Text, "\"printed\"";
            },
            ..table! { $($table)* }
        }
    };
}

static FORMS: &[(Table, Read)] = &[
    (
        form! {
            /// A ball.
            "Sphere":
            /// The centre: a hardpoint's name, or coordinates in the design configuration.
            must "sphere": PLACE, "\"outer_ball\"";
            /// The body's name.
            must "body": BODY, "\"knuckle\"";
            /// The radius.
            must "radius": LENGTH, "18";
        },
        |r, fields, place, _| {
            let centre = point(r, fields, "sphere", place);
            let radius = length(r, fields, "radius");
            Some((BodyShapeKindDraft::Sphere { centre: centre? }, Some(radius?)))
        },
    ),
    (
        form! {
            /// A rod, tube or screw: a cylinder with round ends.
            "Capsule":
            /// The centres of its ends.
            must "capsule": ENDS, "[\"B\", \"C\"]";
            /// The body's name; not for the ends of a rod, leg or spring.
            may "body": BODY, "\"coupler\"";
            /// The radius.
            must "radius": LENGTH, "4";
        },
        |r, fields, place, _| {
            let ends = ends(r, fields, "capsule", place);
            let radius = length(r, fields, "radius");
            Some((BodyShapeKindDraft::Capsule { ends: ends? }, Some(radius?)))
        },
    ),
    (
        form! {
            /// A bar that is bent to a circle, like the lip of a rim.
            "Ring":
            /// The centre: a hardpoint's name, or coordinates in the design configuration.
            must "ring": PLACE, "\"wheel_centre\"";
            /// The body's name.
            must "body": BODY, "\"knuckle\"";
            /// Direction perpendicular to its plane in the design configuration.
            must "axis": LINE, "\"y\"";
            /// Radius of the circle in the middle of the bar.
            must "radius": LENGTH, "175";
            /// Radius of the bar. Default: 0.
            may "round": LENGTH, "5";
        },
        |r, fields, place, _| {
            let centre = point(r, fields, "ring", place);
            let axis = r.line_of(fields, "axis", place);
            let radius = length(r, fields, "radius");
            let round = optional_length(r, fields, "round")?;
            Some((BodyShapeKindDraft::Ring { centre: centre?, axis: axis?, radius: radius? }, round))
        },
    ),
    (
        form! {
            /// A solid cylinder with flat ends.
            "Cylinder":
            /// The centres of its ends.
            must "cylinder": ENDS, "[\"flange_a\", \"flange_b\"]";
            /// The body's name; not for the ends of a rod, leg or spring.
            may "body": BODY, "\"spool\"";
            /// The radius.
            must "radius": LENGTH, "60";
            /// Radius of its edges. Default: 0.
            may "round": LENGTH, "1";
        },
        |r, fields, place, _| {
            let ends = ends(r, fields, "cylinder", place);
            let radius = length(r, fields, "radius");
            let round = optional_length(r, fields, "round")?;
            Some((BodyShapeKindDraft::Cylinder { ends: ends?, radius: radius? }, round))
        },
    ),
    (
        form! {
            /// The tyre of a wheel: a cylinder about its spin axis, with the wheel's radius.
            "TyreShape":
            /// The wheel's name.
            must "wheel": Shape::Name("a wheel"), "\"front_left\"";
            /// The width.
            must "width": LENGTH, "190";
            /// Radius of its shoulders. Default: 0.
            may "round": LENGTH, "25";
        },
        |r, fields, _, _| {
            let wheel = r.name_of(fields, "wheel");
            let width = length(r, fields, "width");
            let round = optional_length(r, fields, "round")?;
            Some((BodyShapeKindDraft::Tyre { wheel: wheel?, width: width? }, round))
        },
    ),
    (
        form! {
            /// A wall or a road: all that is behind a plane.
            "PlaneShape":
            /// A point of the plane: a hardpoint's name, or coordinates in the design configuration.
            must "plane": PLACE, "[0, 0, 0]";
            /// The body's name.
            must "body": BODY, "\"ground\"";
            /// Normal of the plane in the design configuration; it points to the free side.
            must "normal": LINE, "\"z\"";
            /// Thickness that is added on the free side. Default: 0.
            may "round": LENGTH, "1";
        },
        |r, fields, place, _| {
            let at = point(r, fields, "plane", place);
            let normal = r.line_of(fields, "normal", place);
            let round = optional_length(r, fields, "round")?;
            Some((BodyShapeKindDraft::Plane { point: at?, normal: normal? }, round))
        },
    ),
    (
        form! {
            /// A box.
            "Box":
            /// The lengths along its axes.
            must "box": Shape::exactly(3, &LENGTH), "[40, 20, 90]";
            /// The body's name.
            must "body": BODY, "\"frame\"";
            /// The centre and axes in the design configuration; the centre follows a hardpoint that is named. Default:
            /// the global origin and axes.
            may "frame": Shape::Kinds(&bodies::FRAME), "{ position = [0, 0, 30] }";
            /// Radius that is added on all sides. Default: 0.
            may "round": LENGTH, "1";
        },
        |r, fields, place, raw| {
            let sides = r.given(fields, "box", |r, f| {
                let subject = fields.subject("box");
                let sides = r.quantities::<3>(f.value, &subject, "three lengths", LENGTH)?;
                if let Some(k) = sides.iter().position(|side| !(*side > 0.0)) {
                    let message = format!("{} is not positive", subject.item(k).name);
                    r.report("HP0263", f.value.span(), message).help =
                        Some("give three positive lengths, in the file's length unit".into());
                    return None;
                }
                Some(sides)
            });
            let frame = match fields.get("frame") {
                Some(_) => r.given(fields, "frame", |r, f| bodies::frame(r, fields, f, place, raw))?,
                None => FrameDraft::Pose(Pose::IDENTITY),
            };
            let body = r.name_of(fields, "body");
            let round = optional_length(r, fields, "round")?;
            let FrameDraft::Pose(pose) = frame else {
                let at = fields.get("frame").map_or(fields.at.clone(), |f| f.value.span());
                r.senseless(at, "the frame of a box is given by three points").help =
                    Some("give its position and orientation, like `{ position = [0, 0, 30] }`".into());
                return None;
            };
            let half = Vec3::from(sides?) * 0.5;
            let body = body?;
            // The name of a hardpoint, which the box follows.
            let position = fields.get("frame").and_then(|f| f.value.get_ref().as_table()?.get("position"));
            let centre = position.and_then(|value| value.get_ref().as_str());
            let per_metre = r.units.length.per_metre();
            let corner = |k: u8| {
                let side = |axis: u8, length: f64| if k >> axis & 1 == 1 { length } else { -length };
                let from_centre = pose.rot * Vec3::new(side(0, half.x), side(1, half.y), side(2, half.z));
                let beside = |name: &str| {
                    let along = |axis: &str, by: f64| {
                        let sum = Expression::sum(&format!("{name}.{axis}"), by * per_metre).ok()?;
                        Some(sum.with_unit(per_metre))
                    };
                    let Vec3 { x, y, z } = from_centre;
                    let coordinates = [along("x", x)?, along("y", y)?, along("z", z)?];
                    Some(LocationDraft::Formula(Box::new(coordinates)))
                };
                let at = centre.and_then(beside).unwrap_or(LocationDraft::At(pose.r + from_centre));
                PointRef::On { body: body.clone(), at }
            };
            Some((BodyShapeKindDraft::Hull { points: (0..8).map(corner).collect() }, round))
        },
    ),
    (
        form! {
            /// The convex hull of points.
            "Hull":
            /// Points: hardpoints' names or coordinates in the design configuration.
            must "hull": Shape::List(&PLACE, [4, MOST_POINTS]), "[\"p1\", \"p2\", [0, 4, 9], [1, 7, 2]]";
            /// The body's name.
            must "body": BODY, "\"frame\"";
            /// Radius that is added on all sides. Default: 0.
            may "round": LENGTH, "2";
        },
        |r, fields, place, _| {
            let subject = fields.subject("hull");
            let points = r.given(fields, "hull", |r, f| {
                let list = r.list(f.value, &subject, "a list of four or more points")?;
                if !(4..=MOST_POINTS).contains(&list.len()) {
                    let message = format!("{} has {} points", subject.name, list.len());
                    r.senseless(f.value.span(), message).help =
                        Some(format!("give 4 to {MOST_POINTS} points, or a `mesh`"));
                    return None;
                }
                place.items("hull", list.iter().map(|v| v.span()).collect());
                all_read(list.into_iter().enumerate().map(|(k, v)| r.place(v, &subject.item(k))))
            });
            let body = r.name_of(fields, "body")?;
            let round = optional_length(r, fields, "round")?;
            let on = |at| PointRef::On { body: body.clone(), at };
            Some((BodyShapeKindDraft::Hull { points: points?.into_iter().map(on).collect() }, round))
        },
    ),
    (
        form! {
            /// A surface of triangles. It does not change with the design.
            "MeshShape":
            /// A file of triangles, or `true` for the body's own `mesh`.
            must "mesh": Shape::Any("MeshOfShape", "", &[Shape::Flag, Shape::File, Shape::Table(&mesh::MESH_TABLE)]),
                "\"arch.stl\"";
            /// The body's name.
            must "body": BODY, "\"ground\"";
            /// Radius that is added on all sides. Default: 0.
            may "round": LENGTH, "0.3";
        },
        |r, fields, _, raw| {
            let body = r.name_of(fields, "body");
            let round = optional_length(r, fields, "round")?;
            let field = fields.get("mesh")?;
            let body = body?;
            let (vertices, triangles, in_body) = mesh::surface(r, &raw.meshes, fields, field, &body)?;
            Some((BodyShapeKindDraft::Mesh { body, vertices, triangles, in_body }, round))
        },
    ),
];

/// Maximum number of points of a hull.
const MOST_POINTS: usize = 40;
const SHAPE_NAME: Shape = Shape::Name("a shape");
const SIDE: Shape = Shape::Any("ClearanceSide", "", &[SHAPE_NAME, Shape::some(&SHAPE_NAME)]);
pub(crate) const CLEARANCE: Table = table! {
    /// Distances between shapes. They are the measure NAME, their least value the metric NAME.min.
    "Clearance":
    /// The shapes on both sides, by name, pattern with `*`, body or group; or `"all"` pairs on different bodies, except
    /// neighbours at a joint.
    must "between": Shape::Any("Between", "", &[Shape::Words(&[("all", "")]), Shape::exactly(2, &SIDE)]),
        "[\"rod\", \"screw*\"]";
    /// Pairs that are not measured.
    or("[]") "ignore": Shape::list(&Shape::exactly(2, &SHAPE_NAME)), "[[\"rod\", \"pin\"]]";
    /// The least distance that is required; or several, by the shapes of a pair, with a `default`.
    may "min": Shape::Any("MinimumDistance", "", &[LENGTH, Shape::Entries("a shape", &LENGTH)]), "1.5";
    /// Pairs that are always farther apart than this are not listed in results. Default: all are listed.
    may "beyond": LENGTH, "50";
};

pub(super) fn shapes(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    for entry in r.entries(model, "shapes", "shape") {
        let fields = r.entry("shape", &entry, SHAPE.keys());
        let mut place = EntryPlace::of(&fields);
        let form = r.led_by(&fields, FORMS, ["form", "the form is given"]);
        let read = form.and_then(|(table, read)| {
            let missing = table.keys.iter().filter(|key| key.need == Need::Required);
            if missing.filter(|key| r.need(&fields, key.key).is_none()).count() > 0 {
                return None;
            }
            read(r, &fields, &mut place, raw)
        });
        let group = r.given(&fields, "group", |r, f| r.text(&fields, f));
        r.unread.clear();
        if read.is_none() {
            r.unread.push("");
        }
        raw.push(r, Section::Shapes, place);
        let (kind, round) = read.unwrap_or((BodyShapeKindDraft::Unread, None));
        raw.draft.shapes.push(BodyShapeDraft { name: entry.0, group, kind, round });
    }
}

/// Reads clearances; each has a measure of its name, unless the file declares one.
pub(super) fn clearances(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    for entry in r.entries(model, "clearances", "clearance") {
        let fields = r.entry("clearance", &entry, CLEARANCE.keys());
        let mut place = EntryPlace::of(&fields);
        let between = r.given(&fields, "between", |r, f| between(r, &fields, f));
        if fields.get("between").is_none() {
            r.need(&fields, "between");
        }
        let ignore = r.given(&fields, "ignore", |r, f| {
            let subject = fields.subject("ignore");
            let pairs = r.list(f.value, &subject, "a list of pairs of shapes")?;
            all_read(pairs.into_iter().enumerate().map(|(k, pair)| two_names(r, pair, &subject.item(k))))
        });
        let min = r.given(&fields, "min", |r, f| minimum(r, &fields, f));
        let beyond =
            r.given(&fields, "beyond", |r, f| r.quantity(f.value, &fields.subject("beyond"), LENGTH));
        let items = |key: &str| {
            let written = fields.get(key).and_then(|f| f.value.get_ref().as_array());
            written.into_iter().flatten().map(|v| v.span()).collect()
        };
        place.items("between", items("between"));
        place.items("ignore", items("ignore"));
        let is_unread = between.is_none() || !r.unread.is_empty();
        r.unread.clear();
        if is_unread {
            r.unread.push("");
        }
        let at = fields.at.clone();
        raw.push(r, Section::Clearances, place);
        if raw.draft.measures.iter().all(|m| m.name != entry.0) {
            raw.places.push(Section::Measures, EntryPlace::at(at));
            let kind = MeasureKindDraft::Clearance { of: entry.0.clone() };
            raw.draft.measures.push(MeasureDraft { name: entry.0.clone(), kind });
            raw.measured_clearances.push(entry.0.clone());
        }
        raw.draft.clearances.push(ClearanceDraft {
            name: entry.0,
            between: between.unwrap_or(BetweenDraft::All),
            ignore: ignore.unwrap_or_default(),
            beyond,
            min: min.unwrap_or_default(),
        });
    }
}

/// Adds the metric NAME.min of every clearance, unless the file declares one of that name.
pub(super) fn least(r: &Reader<'_>, raw: &mut Raw) {
    for k in 0..raw.draft.clearances.len() {
        let of = raw.draft.clearances[k].name.clone();
        let name = format!("{of}.min");
        if !raw.measured_clearances.contains(&of) || raw.draft.metrics.iter().any(|m| m.name == name) {
            continue;
        }
        let at = raw.places.list(Section::Clearances)[k].find("between", None);
        raw.places.push(Section::Metrics, EntryPlace::at(at));
        raw.draft.metrics.push(MetricDraft {
            name,
            of,
            over: None,
            take: Reduction::Least,
            window: None,
            case: None,
            per_metre: r.units.length.per_metre(),
            per_radian: r.units.angle.per_radian(),
        });
    }
}

fn length(r: &mut Reader<'_>, fields: &Fields<'_>, key: &str) -> Option<NumberDraft> {
    r.given(fields, key, |r, f| declared::element_number(r, fields, f, ElementUnit::Length))
}

/// A length that may be left out; `None` if it is there and cannot be read.
fn optional_length(r: &mut Reader<'_>, fields: &Fields<'_>, key: &str) -> Option<Option<NumberDraft>> {
    if fields.get(key).is_none() { Some(None) } else { length(r, fields, key).map(Some) }
}

/// A place on the shape's body.
fn point(
    r: &mut Reader<'_>,
    fields: &Fields<'_>,
    key: &'static str,
    place: &mut EntryPlace,
) -> Option<PointRef> {
    place.items(key, Vec::new());
    let at = r.place_of(fields, key);
    let body = r.name_of(fields, "body");
    Some(PointRef::On { body: body?, at: at? })
}

/// Two places on the shape's body, or what has two ends.
fn ends(
    r: &mut Reader<'_>,
    fields: &Fields<'_>,
    key: &'static str,
    place: &mut EntryPlace,
) -> Option<EndsDraft> {
    let field = fields.get(key)?;
    let subject = fields.subject(key);
    let expected = "two hardpoints or coordinates, or the name of a rod, leg or spring";
    if field.value.get_ref().is_str() {
        let why = "a rod, leg or spring has its ends on its own bodies";
        r.out_of_place(fields, "body", why);
        return r.name(field.value, &subject, expected).map(EndsDraft::Of);
    }
    let list = r.list(field.value, &subject, expected)?;
    let [a, b] = list[..] else {
        r.wrong(field.value, &subject, expected);
        return None;
    };
    place.items(key, vec![a.span(), b.span()]);
    let [p, q] = [(0, a), (1, b)].map(|(k, v)| r.place(v, &subject.item(k)));
    r.need(fields, "body")?;
    let body = r.name_of(fields, "body")?;
    let on = |at| PointRef::On { body: body.clone(), at };
    Some(EndsDraft::Points([on(p?), on(q?)]))
}

fn between(r: &mut Reader<'_>, fields: &Fields<'_>, f: Field<'_>) -> Option<BetweenDraft> {
    let subject = fields.subject(f.key);
    if f.value.get_ref().as_str() == Some("all") {
        return Some(BetweenDraft::All);
    }
    let expected = "`\"all\"`, or the shapes on both sides";
    let list = r.list(f.value, &subject, expected)?;
    let [a, b] = list[..] else {
        r.wrong(f.value, &subject, expected);
        return None;
    };
    let mut side = |k: usize, v: &Value<'_>| {
        let subject = subject.item(k);
        match v.get_ref().as_array() {
            Some(names) => all_read(names.iter().map(|v| r.name(v, &subject, "the name of a shape"))),
            None => r.name(v, &subject, "the name of a shape, or several").map(|name| vec![name]),
        }
    };
    let (first, second) = (side(0, a), side(1, b));
    Some(BetweenDraft::Sides([first?, second?]))
}

fn two_names(r: &mut Reader<'_>, value: &Value<'_>, subject: &Subject) -> Option<[String; 2]> {
    let list = r.list(value, subject, "the names of two shapes")?;
    let [a, b] = list[..] else {
        r.wrong(value, subject, "the names of two shapes");
        return None;
    };
    let [a, b] = [a, b].map(|v| r.name(v, subject, "the name of a shape"));
    Some([a?, b?])
}

fn minimum(r: &mut Reader<'_>, fields: &Fields<'_>, f: Field<'_>) -> Option<MinimumDraft> {
    let subject = fields.subject(f.key);
    let Some(table) = f.value.get_ref().as_table() else {
        let default = r.quantity(f.value, &subject, LENGTH)?;
        return Some(MinimumDraft { default: Some(default), of: Vec::new() });
    };
    let mut min = MinimumDraft::default();
    for (name, value) in table {
        let x = r.quantity(value, &subject, LENGTH)?;
        match &**name.get_ref() {
            "default" => min.default = Some(x),
            name => min.of.push((name.into(), x)),
        }
    }
    Some(min)
}
