//! Joints and their curves.

use hardpoint::draft::{
    CurveDraft, FormulaDraft, FormulaOf, JointDraft, JointLimitDraft, LimitTargetDraft, LocationDraft,
    MetricDraft, Section, some_of,
};
use hardpoint::joint;
use hardpoint::joint::{Freedom, Quantity};
use hardpoint::model::Reduction;
use toml::de::DeValue;

use crate::values::{
    BODY, EntryPlace, Field, Fields, LENGTH, LINE, NUMBER, PLACE, Reader, Shape, Table, Value, all_read,
    closest, shown, table,
};

use super::drawing;
use super::drawing::{DRAW, Form};
use super::raw::Raw;

/// Maximum number of limits that a message lists.
const MOST_LISTED: usize = 12;
/// The axis of a marker that a joint's `axis` is.
const ALONG_AXIS: usize = 2;
pub(super) const JOINT: Table = table! {
    /// A joint between bodies i and j.
    "Joint":
    /// The joint type, or one of its other names.
    must "type": JOINT_TYPE, "\"revolute\"";
    /// Names of bodies i and j. Coordinates are those of j relative to i.
    must "bodies": Shape::exactly(2, &BODY), "[\"ground\", \"crank\"]";
    /// Location: a hardpoint's name or coordinates; or two of them, one on each body, for rods, legs and open joints.
    /// Default: the first hardpoint of the axis, if it has any.
    may "at": Shape::Any("Places", "", &[PLACE, Shape::exactly(2, &PLACE)]), "\"A\"";
    /// The axis, in the design configuration; required if the joint type moves along or about one.
    may "axis": LINE, "\"z\"";
    /// The second axis: perpendicular to the first, or the axis on body j, by joint type; of a type with one axis, the
    /// x direction of elastic joints and reactions.
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
    /// Limits of its coordinates, by name, and of its `articulation`. Each has a measure `JOINT.COORDINATE`.
    may "limits": Shape::Entries("a coordinate", &Shape::Table(&LIMIT)), "{ displacement = { min = -40, max = 60 } }";
    /// Shape in drawings, for a rod, a leg, or a joint that slides along its axis. It does not affect results. Default:
    /// a leg is a cylinder.
    may "draw": DRAW, "\"coilover\"";
};
pub(super) const CURVE: Table = table! {
    /// A smooth curve through points in the design configuration, in the plane perpendicular to the joint's axis.
    "Curve":
    /// Points in order: hardpoints' names or coordinates.
    must "points": Shape::list(&PLACE), "[\"A\", \"B\", \"C\"]";
    /// True for a closed curve, such as that of a cam; the first point is not repeated.
    or("false") "closed": Shape::Flag, "true";
};
pub(super) const LIMIT: Table = table! {
    /// Range of a coordinate of a joint or of its articulation: `min`, `max` or both, in the unit of the value. Numbers
    /// are those of the measure `JOINT.COORDINATE`: a coordinate counts from the design configuration, that of a rod or
    /// leg is its length.
    "JointLimit":
    /// The lower end. Its metric is `JOINT.COORDINATE.min`.
    may "min": NUMBER, "-40";
    /// The upper end. Its metric is `JOINT.COORDINATE.max`.
    may "max": NUMBER, "60";
    /// True for an end stop: the motion ends where the limit is reached.
    or("false") "stop": Shape::Flag, "true";
    /// Direction of an articulation in the design configuration, such as a stud. Default: the joint's axis, or the
    /// whole rotation.
    may "axis": LINE, "\"z\"";
};
const JOINT_TYPE: Shape =
    Shape::Any("JointType", "", &[Shape::Known("the name of a joint type", joint_types)]);
/// A coordinate of a joint, by name.
pub(super) const COORDINATE: Shape =
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

pub(super) fn joints(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    for entry in r.entries(model, "joints", "joint") {
        let fields = r.entry("joint", &entry, JOINT.keys());
        let mut place = EntryPlace::of(&fields);
        let kind = r.name_of(&fields, "type");
        let bodies = r.names_of::<2>(&fields, "bodies");
        let at = r.given(&fields, "at", |r, f| joint_places(r, &fields, f, &mut place, raw));
        let [axis, axis2] = ["axis", "axis2"].map(|key| r.line_of(&fields, key, &mut place));
        let mirror = r.word_of(&fields, "mirror");
        let length = r.given(&fields, "length", |r, f| rod_length_of(r, &fields, f, &entry.0, raw));
        let lead = r.number_of(&fields, "lead");
        let curve = r.given(&fields, "curve", |r, f| curve(r, &fields, f, &mut place));
        let cut = r.flag_of(&fields, "cut");
        if let Some(form) = form_of_joint(r, &fields, kind.as_deref()) {
            raw.drawing.joints.insert(raw.draft.joints.len(), form);
        }
        raw.push(r, Section::Joints, place);
        raw.joint_numbers.entry(entry.0.clone()).or_insert(raw.draft.joints.len());
        limits(r, &fields, &entry.0, kind.as_deref(), raw);
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

/// Limits of a joint.
fn limits(r: &mut Reader<'_>, joint: &Fields<'_>, name: &str, kind: Option<&str>, raw: &mut Raw) {
    let kind = kind.and_then(joint::named);
    for entry in r.entries_below(joint, &format!("joints.{name}."), "limits", "coordinate") {
        let mut limit = JointLimitDraft {
            joint: name.to_owned(),
            of: entry.0.clone(),
            min: None,
            max: None,
            stop: false,
        };
        let before = r.found.len();
        let fields = r.entry("limit", &(limit.name(), entry.1.clone(), entry.2), LIMIT.keys());
        // An unknown key may be meant as one of its ends.
        let has_unknown_keys = r.found.len() > before;
        let mut place = EntryPlace::of(&fields);
        let is_articulation = limit.of == JointLimitDraft::ARTICULATION;
        let own = kind.and_then(|kind| kind.quantity_of(Some(&limit.of)));
        let quantity = if is_articulation { Quantity::Angle } else { own.unwrap_or(Quantity::Number) };
        [limit.min, limit.max] = ["min", "max"].map(|key| {
            r.given(&fields, key, |r, f| r.quantity(f.value, &fields.subject(key), Shape::Number(quantity)))
        });
        limit.stop = r.flag_of(&fields, "stop").unwrap_or(false);
        if !is_articulation {
            r.out_of_place(&fields, "axis", "only an articulation is the angle of a direction");
        }
        let axis = r.line_of(&fields, "axis", &mut place);
        let is_unread = has_unknown_keys || !r.unread.is_empty();
        if is_unread {
            r.unread.push("");
        }
        raw.push(r, Section::JointLimits, place.clone());
        // The core reports a coordinate that the joint does not have.
        if is_articulation || own.is_some() {
            raw.limit_measures.push((limit.measure(axis), place, is_unread));
        }
        raw.draft.joint_limits.push(limit);
    }
}

/// Adds the measures of limits of joints after those of the file.
pub(super) fn limit_measures(raw: &mut Raw) {
    for (measure, place, is_unread) in std::mem::take(&mut raw.limit_measures) {
        if is_unread {
            raw.draft.unread.note(Section::Measures, raw.draft.measures.len(), "");
        }
        raw.places.push(Section::Measures, place);
        raw.draft.measures.push(measure);
    }
}

/// Adds the metric of each end of the limits of joints, unless the file declares one of that name.
pub(super) fn limit_metrics(r: &Reader<'_>, raw: &mut Raw) {
    for k in 0..raw.draft.joint_limits.len() {
        let limit = &raw.draft.joint_limits[k];
        let (of, has_measure) = (limit.name(), raw.draft.measures.iter().any(|m| m.name == limit.name()));
        let ends = [("min", limit.min, Reduction::Least), ("max", limit.max, Reduction::Greatest)];
        for (end, _, take) in ends.into_iter().filter(|(_, bound, _)| has_measure && bound.is_some()) {
            let name = format!("{of}.{end}");
            if raw.draft.metrics.iter().any(|m| m.name == name) {
                continue;
            }
            let at = raw.places.list(Section::JointLimits)[k].find(end, None);
            raw.places.push(Section::Metrics, EntryPlace::at(at));
            raw.draft.metrics.push(MetricDraft {
                name,
                of: of.clone(),
                over: None,
                take,
                window: None,
                case: None,
                per_metre: r.units.length.per_metre(),
                per_radian: r.units.angle.per_radian(),
            });
        }
    }
}

/// End of the limit of a joint (or an empty name if it has one only), its metric and the bounds of that.
pub(super) type LimitedEnd = (&'static str, LimitTargetDraft, [Option<f64>; 2]);

/// Ends of the limit of a joint with the names of their metrics, in the units of the file, for limits of studies.
/// HP0204 if there is no such limit.
pub(super) fn ends_of_limit(r: &mut Reader<'_>, fields: &Fields<'_>, raw: &Raw) -> Option<Vec<LimitedEnd>> {
    let name = r.name_of(fields, "joint")?;
    let limits = &raw.draft.joint_limits;
    let Some(limit) = limits.iter().find(|limit| limit.name() == name) else {
        let known: Vec<String> = limits.iter().map(JointLimitDraft::name).collect();
        let at = fields.get("joint").map_or(fields.at.clone(), |f| f.value.span());
        let close = closest(&name, known.iter().map(String::as_str)).map(|c| format!("did you mean `{c}`?"));
        let help =
            close.unwrap_or("name a limit of `[joints.JOINT.limits]`, like `slide.displacement`".into());
        let listed = known.iter().map(|k| format!("`{k}`")).collect::<Vec<_>>();
        let d = r.report("HP0204", at, format!("no joint has a limit named `{}`", shown(&name)));
        d.help = Some(help);
        if !listed.is_empty() {
            d.notes.push(format!("limits of joints: {}", some_of(&listed, ", ", MOST_LISTED)));
        }
        return None;
    };
    let own = raw.type_of(&limit.joint).and_then(|kind| kind.quantity_of(Some(&limit.of)));
    let per_si = match own {
        Some(Quantity::Length) => r.units.length.per_metre(),
        Some(Quantity::Angle) | None => r.units.angle.per_radian(),
        Some(Quantity::Number) => 1.0,
    };
    let of = |end: &str| LimitTargetDraft::Metric(format!("{name}.{end}"));
    Some(match (limit.min.map(|x| x * per_si), limit.max.map(|x| x * per_si)) {
        (Some(min), Some(max)) => {
            vec![("min", of("min"), [Some(min), None]), ("max", of("max"), [None, Some(max)])]
        }
        (min, None) => vec![("", of("min"), [min, None])],
        (None, max) => vec![("", of("max"), [None, max])],
    })
}

/// Shape of a joint in drawings; HP0107 for a joint without a length.
fn form_of_joint(r: &mut Reader<'_>, fields: &Fields<'_>, kind: Option<&str>) -> Option<Form> {
    if let Some(kind) = kind.and_then(joint::named) {
        let slides = kind.freedoms.is_some_and(|f| f.contains(&Freedom::Slide(ALONG_AXIS)));
        if !kind.is_rod() && !slides {
            let why = "it is for what has a length: a rod, a leg, a joint that slides along its axis";
            r.out_of_place(fields, "draw", format!("{why}; this is a {} joint", kind.name));
            return None;
        }
    }
    drawing::form_of(r, fields)
}

/// Length of a rod: a number, or an expression that the core evaluates.
fn rod_length_of(
    r: &mut Reader<'_>,
    fields: &Fields<'_>,
    f: Field<'_>,
    joint: &str,
    raw: &mut Raw,
) -> Option<f64> {
    let subject = fields.subject(f.key);
    if !f.value.get_ref().is_str() {
        return r.number(f.value, &subject).map(|x| r.units.length.metres(x));
    }
    let expression = r.expression(f.value, &subject)?;
    raw.draft.formulas.push(FormulaDraft { of: FormulaOf::Length(joint.to_owned()), expression });
    Some(0.0)
}

/// One location, or a list of locations: three numbers, or three texts that are not all names of hardpoints, are
/// the coordinates of one.
fn joint_places(
    r: &mut Reader<'_>,
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
        Some(list) if !list.iter().any(is_number) && (list.len() != 3 || list.iter().all(is_hardpoint)) => {
            let list = r.list(f.value, &subject, "")?;
            all_read(list.iter().map(|v| r.place(v, &subject)))
        }
        _ => {
            let one = r.place(f.value, &subject)?;
            place.items("at", Vec::new());
            Some(vec![one])
        }
    }
}

/// Reads a curve; its points become the items of the key.
fn curve(
    r: &mut Reader<'_>,
    fields: &Fields<'_>,
    f: Field<'_>,
    place: &mut EntryPlace,
) -> Option<CurveDraft> {
    let table = r.table(f.value, &fields.subject("curve"), "a table with the points of the curve")?;
    let curve = r.fields(format!("the curve of {}", fields.what), f.value.span(), table, CURVE.keys());
    let closed = r.flag_of(&curve, "closed");
    let points = r.given(&curve, "points", |r, f| {
        let subject = curve.subject("points");
        let list = r.list(f.value, &subject, "a list of hardpoints' names or coordinates")?;
        place.items("curve", list.iter().map(|v| v.span()).collect());
        all_read(list.iter().map(|v| r.place(v, &subject)))
    });
    Some(CurveDraft { points: points?, closed: closed? })
}
