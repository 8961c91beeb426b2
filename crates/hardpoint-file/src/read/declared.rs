//! Fields of measures, masses and forces, as the core declares them.

use hardpoint::draft::{
    DirectionDraft, FieldDraft, FieldKind, MeasureField, NumberDraft, RayDraft, TablePointDraft,
};
use hardpoint::joint::Quantity;
use hardpoint::law::Law;
use hardpoint::model::{
    Axes, CoupledStiffness, ElasticDirection, ElementUnit, JacobianValue, OrientationAngle, ReactionPart,
    WheelPoint,
};

use crate::values::{
    ANGLE, BODY, DIRECTION, DRIVER, EntryPlace, Field, Fields, JOINT, Key, LENGTH, LINE, NUMBER, Need,
    OUTPUT, Reader, Shape, Subject, TWO_NUMBERS, Table, Value, table,
};

use super::data::COLUMN;
use super::joints::COORDINATE;
use super::law::LAW;
use super::mesh::MESH;
use super::points::POINT_REF;
use super::raw::Raw;
use super::{data, law, mesh, points};

const RAY: Shape = Shape::Any(
    "Ray",
    "A direction that an angle is measured from or to.",
    &[Shape::exactly(2, &POINT_REF), Shape::Table(&FIXED_RAY), DIRECTION],
);
const FIXED_RAY: Table = table! {
    /// A direction that is fixed in a body.
    "FixedRay":
    /// The body's name.
    must "body": BODY, "\"rocker\"";
    /// Direction in the design configuration.
    must "axis": LINE, "\"x\"";
};
const FORCE_TABLE: Shape = Shape::Any(
    "ForceTable",
    "A force in N, or an expression over parameters, over a way in the length unit.",
    &[Shape::list(&TWO_NUMBERS), Shape::File, Shape::Table(&FORCE_FILE)],
);
const MOMENT_TABLE: Shape = Shape::Any(
    "MomentTable",
    "A moment in N m, or an expression over parameters, over an angle in the angle unit.",
    &[Shape::list(&TWO_NUMBERS), Shape::File, Shape::Table(&MOMENT_FILE)],
);
const MATRIX_ROW: Shape = Shape::exactly(6, &NUMBER);
const MATRIX: Shape =
    Shape::Any("StiffnessMatrix", "Six rows of six numbers.", &[Shape::exactly(6, &MATRIX_ROW)]);
pub(super) const FORCE_FILE: Table = table! {
    /// A force over deflection in a CSV file.
    "ForceFile":
    /// A CSV file in the model's folder or below it: deflections, in the length unit or a title's, and forces in N.
    must "file": Shape::File, "\"bump_stop.csv\"";
    /// The file's columns of deflection and force, by name or by number from 1. Default: the first two.
    may "columns": Shape::exactly(2, &COLUMN), "[1, 2]";
};
pub(super) const MOMENT_FILE: Table = table! {
    /// A moment over an angle in a CSV file.
    "MomentFile":
    /// A CSV file in the model's folder or below it: angles, in the angle unit or a title's, and moments in N m.
    must "file": Shape::File, "\"bush_about_z.csv\"";
    /// The file's columns of angle and moment, by name or by number from 1. Default: the first two.
    may "columns": Shape::exactly(2, &COLUMN), "[1, 2]";
};
const REACTION_PART: Shape = Shape::Any(
    "ReactionPart",
    "What of a joint's reaction is measured.",
    &[Shape::Words(ReactionPart::WORDS)],
);
const JACOBIAN_VALUE: Shape = Shape::Any(
    "JacobianValue",
    "Quantity that a dexterity takes from the singular values.",
    &[Shape::Words(JacobianValue::WORDS)],
);
const ELASTIC_DIRECTION: Shape = Shape::Any(
    "ElasticDirection",
    "A direction of an elastic joint or bushing.",
    &[Shape::Words(ElasticDirection::WORDS)],
);
const POINTS: Shape = Shape::list(&POINT_REF);
const DRIVERS: Shape = Shape::list(&DRIVER);
const AXES: Shape = Shape::Any("Axes", "Along which axes something is given.", &[Shape::Words(Axes::WORDS)]);
const WHEEL_POINT: Shape =
    Shape::Any("WheelPoint", "Point of a wheel at which a force acts.", &[Shape::Words(WheelPoint::WORDS)]);
const ORIENTATION_ANGLE: Shape = Shape::Any(
    "OrientationAngle",
    "One of three angles of a body's orientation.",
    &[Shape::Words(OrientationAngle::WORDS)],
);

/// The key of a field of a measure, a mass or a force.
pub(super) fn key(field: &MeasureField) -> Key {
    let (shape, example) = match field.kind {
        FieldKind::Joint => (JOINT, "\"J1\""),
        FieldKind::Coordinate => (COORDINATE, "\"angle\""),
        FieldKind::Point => (POINT_REF, "\"P\""),
        FieldKind::Points => (POINTS, "[\"P\", \"Q\"]"),
        FieldKind::Drivers => (DRIVERS, "[\"bump\", \"steer\"]"),
        FieldKind::JacobianValue => (JACOBIAN_VALUE, "\"least_gain\""),
        FieldKind::Direction => (DIRECTION, "\"z\""),
        FieldKind::Line => (LINE, "[0, 1, 0]"),
        FieldKind::Ray => (RAY, "[\"P\", \"Q\"]"),
        FieldKind::Output => (OUTPUT, "\"toe\""),
        FieldKind::Driver => (DRIVER, "\"bump\""),
        FieldKind::Body => (BODY, "\"knuckle\""),
        FieldKind::OrientationAngle => (ORIENTATION_ANGLE, "\"yaw\""),
        FieldKind::Expression => (Shape::Expression, "\"left.toe + right.toe\""),
        FieldKind::ReactionPart => (REACTION_PART, "\"radial\""),
        FieldKind::ElasticDirection => (ELASTIC_DIRECTION, "\"z\""),
        FieldKind::Axes => (AXES, "\"body\""),
        FieldKind::WheelPoint => (WHEEL_POINT, "\"centre\""),
        FieldKind::Force => (Shape::Name("a force"), "\"spring\""),
        FieldKind::Number(ElementUnit::Length) => (LENGTH, "20"),
        FieldKind::Number(ElementUnit::Angle) => (ANGLE, "5"),
        FieldKind::Number(ElementUnit::Density) => (NUMBER, "7850"),
        FieldKind::Number(_) => (NUMBER, "2.5"),
        FieldKind::Law => (LAW, "\"sin(2*pi*t)\""),
        FieldKind::Wheel => (Shape::Name("a wheel"), "\"front_left\""),
        FieldKind::Clearance => (Shape::Name("a clearance"), "\"rod_to_screws\""),
        FieldKind::Table => (FORCE_TABLE, "[[0, 0], [20, 400], [35, 1500]]"),
        FieldKind::MomentTable => (MOMENT_TABLE, "[[-20, -30], [0, 0], [20, 30]]"),
        FieldKind::Matrix => (
            MATRIX,
            "[[4000, 0, 0, 0, 120, 0], [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [120, 0, 0, 0, 35, 0], [0, 0, 0, 0, 0, 0]]",
        ),
        FieldKind::Mesh => (MESH, "\"knuckle.stl\""),
    };
    // Where no surface is named, the body has one.
    let is_needed = field.required && field.kind != FieldKind::Mesh;
    let need = if is_needed { Need::Required } else { Need::Optional };
    Key { key: field.key, shape, need, example, doc: with_unit(field) }
}

/// Meaning of a field, with the unit of its number unless it consists of lengths and angles alone.
fn with_unit(field: &MeasureField) -> &'static str {
    let FieldKind::Number(unit) = field.kind else { return field.summary };
    let unit = match unit {
        ElementUnit::Mass => "kg",
        ElementUnit::Inertia => "kg m^2",
        ElementUnit::Force => "N",
        ElementUnit::Moment => "N m",
        ElementUnit::Stiffness => "N per unit of length",
        ElementUnit::CubicStiffness => "N per cube of it",
        ElementUnit::Damping => "N s per unit of length",
        ElementUnit::TorsionalStiffness => "N m per unit of angle",
        ElementUnit::CubicTorsionalStiffness => "N m per cube of the angle",
        ElementUnit::TorsionalDamping => "N m s per unit of angle",
        ElementUnit::Coupling => "N per unit of angle",
        // Their sentences say it, or the shape does.
        ElementUnit::Density | ElementUnit::Plain | ElementUnit::Length | ElementUnit::Angle => {
            return field.summary;
        }
    };
    format!("{} In {unit}.", field.summary).leak()
}

/// A field of a measure, a mass or a force; `unread` where it is there and cannot be read.
pub(super) fn own_field(
    r: &mut Reader<'_>,
    raw: &Raw,
    field: &MeasureField,
    fields: &Fields<'_>,
    place: &mut EntryPlace,
    unread: &mut bool,
) -> Option<FieldDraft> {
    let key = field.key;
    let value = match field.kind {
        FieldKind::Joint
        | FieldKind::Coordinate
        | FieldKind::Output
        | FieldKind::Driver
        | FieldKind::Force
        | FieldKind::Wheel
        | FieldKind::Clearance
        | FieldKind::Body => r.name_of(fields, key).map(FieldDraft::Name),
        FieldKind::OrientationAngle => {
            r.word_of(fields, key).map(|k| FieldDraft::Angle(OrientationAngle::at(k)))
        }
        FieldKind::ReactionPart => r.word_of(fields, key).map(|k| FieldDraft::Part(ReactionPart::at(k))),
        FieldKind::JacobianValue => {
            r.word_of(fields, key).map(|k| FieldDraft::Jacobian(JacobianValue::at(k)))
        }
        FieldKind::Drivers => r.list_of_names(fields, key, "all").map(FieldDraft::Names),
        FieldKind::ElasticDirection => {
            r.word_of(fields, key).map(|k| FieldDraft::Elastic(ElasticDirection::at(k)))
        }
        FieldKind::Axes => r.word_of(fields, key).map(|k| FieldDraft::Axes(Axes::at(k))),
        FieldKind::WheelPoint => r.word_of(fields, key).map(|k| FieldDraft::WheelPoint(WheelPoint::at(k))),
        FieldKind::Number(unit) => {
            r.given(fields, key, |r, f| element_number(r, fields, f, unit)).map(FieldDraft::Number)
        }
        FieldKind::Law => r.given(fields, key, |r, f| factor_law(r, fields, f)).map(FieldDraft::Law),
        FieldKind::Table => {
            let (files, of) = ((&FORCE_FILE, &data::FORCE), (Quantity::Length, ElementUnit::Force));
            r.given(fields, key, |r, f| force_table(r, fields, f, files, of)).map(FieldDraft::Table)
        }
        FieldKind::MomentTable => {
            let (files, of) = ((&MOMENT_FILE, &data::MOMENT), (Quantity::Angle, ElementUnit::Moment));
            r.given(fields, key, |r, f| force_table(r, fields, f, files, of)).map(FieldDraft::Table)
        }
        FieldKind::Matrix => r.given(fields, key, |r, f| matrix(r, fields, f)).map(FieldDraft::Matrix),
        FieldKind::Mesh => {
            let solid = mesh::solid(r, &raw.meshes, fields, key);
            // It has been reported why there is none.
            *unread |= solid.is_none();
            solid.map(FieldDraft::Solid)
        }
        FieldKind::Point => points::point_of(r, fields, key).map(FieldDraft::Point),
        FieldKind::Points => points::points_of(r, fields, key).map(FieldDraft::Points),
        FieldKind::Direction => r.vector_of(fields, key).map(FieldDraft::Direction),
        FieldKind::Line => r.line_of(fields, key, place).map(FieldDraft::Line),
        FieldKind::Ray => r.given(fields, key, |r, f| ray(r, fields, f, place)).map(FieldDraft::Ray),
        FieldKind::Expression => r.given(fields, key, |r, f| {
            let subject = fields.subject(key);
            if f.value.get_ref().as_str().is_none() {
                r.wrong(f.value, &subject, "an expression in quotes");
            }
            r.expression(f.value, &subject).map(FieldDraft::Expression)
        }),
    };
    *unread |= value.is_none() && fields.get(key).is_some();
    value
}

/// A direction to measure an angle from or to: `["P", "Q"]`, a global vector, or `{ body = ..., axis = ... }`.
fn ray(r: &mut Reader<'_>, fields: &Fields<'_>, f: Field<'_>, place: &mut EntryPlace) -> Option<RayDraft> {
    let subject = fields.subject(f.key);
    if let Some(table) = f.value.get_ref().as_table() {
        let fields = r.fields(subject.name.clone(), f.value.span(), table, FIXED_RAY.keys());
        let body = r.name_of(&fields, "body");
        let axis = r.line_of(&fields, "axis", place);
        return Some(RayDraft::Fixed { body: body?, axis: axis? });
    }
    let is_number = |v: &Value<'_>| v.get_ref().as_integer().is_some() || v.get_ref().as_float().is_some();
    match f.value.get_ref().as_array() {
        Some(list) if list.len() == 2 && !list.iter().any(is_number) => {
            let [a, b] = [0, 1].map(|k| points::point_ref(r, fields, Field { value: &list[k], ..f }));
            Some(RayDraft::Between([a?, b?]))
        }
        _ => {
            let axis = r.vector(f.value, &subject)?;
            Some(RayDraft::Fixed { body: "ground".into(), axis: DirectionDraft::Along(axis) })
        }
    }
}

/// Force or moment over a deflection, given here or in a file.
fn force_table(
    r: &mut Reader<'_>,
    fields: &Fields<'_>,
    f: Field<'_>,
    files: (&'static Table, &data::Curve),
    (deflection, force): (Quantity, ElementUnit),
) -> Option<Vec<TablePointDraft>> {
    let (points, _) = data::points_given(r, fields, f, files, |r, pair, subject, expected| {
        table_point(r, pair, subject, expected, force)
    })?;
    let in_si =
        |p: TablePointDraft| TablePointDraft { deflection: r.units.to_si(deflection, p.deflection), ..p };
    Some(points.into_iter().map(in_si).collect())
}

/// Point of a table: a deflection as written, the same in every design, and a force or moment, by itself or by an
/// expression.
fn table_point(
    r: &mut Reader<'_>,
    value: &Value<'_>,
    subject: &Subject,
    expected: &str,
    unit: ElementUnit,
) -> Option<TablePointDraft> {
    let list = r.exactly(value, subject, [expected, "2"], 2)?;
    let deflection = r.number(&list[0], &subject.item(0));
    let force = number_of(r, &list[1], &subject.item(1), unit);
    Some(TablePointDraft { deflection: deflection?, force: force? })
}

/// Symmetric stiffness matrix.
fn matrix(r: &mut Reader<'_>, fields: &Fields<'_>, f: Field<'_>) -> Option<Box<[[NumberDraft; 6]; 6]>> {
    let subject = fields.subject(f.key);
    let list = |r: &mut Reader<'_>, value: &Value<'_>, subject: &Subject, expected: &str| {
        let found = value.get_ref().as_array().filter(|list| list.len() == 6);
        if found.is_none() {
            r.wrong(value, subject, expected);
        }
        found.is_some()
    };
    if !list(r, f.value, &subject, "six rows of six numbers") {
        return None;
    }
    let mut rows = Vec::new();
    for (row, values) in f.value.get_ref().as_array()?.iter().enumerate() {
        let subject = subject.item(row);
        if !list(r, values, &subject, "six numbers") {
            return None;
        }
        let numbers = values.get_ref().as_array()?.iter().enumerate().map(|(column, value)| {
            number_of(r, value, &subject.item(column), CoupledStiffness::unit(row, column))
        });
        rows.push(numbers.collect::<Option<Vec<_>>>()?.try_into().ok()?);
    }
    rows.try_into().ok()
}

/// A number of a mass or force: by itself, or by an expression that the core evaluates.
pub(super) fn element_number(
    r: &mut Reader<'_>,
    fields: &Fields<'_>,
    f: Field<'_>,
    unit: ElementUnit,
) -> Option<NumberDraft> {
    number_of(r, f.value, &fields.subject(f.key), unit)
}

fn number_of(
    r: &mut Reader<'_>,
    value: &Value<'_>,
    subject: &Subject,
    unit: ElementUnit,
) -> Option<NumberDraft> {
    let per_unit = r.units.per_si_of(unit);
    if value.get_ref().is_str() {
        let expression = r.expression(value, subject)?;
        return Some(NumberDraft { value: 0.0, expression: Some(expression), per_unit });
    }
    let value = r.number(value, subject)?;
    Some(NumberDraft { value: r.units.to_si_of(unit, value), expression: None, per_unit })
}

/// Law that scales a force over time.
fn factor_law(r: &mut Reader<'_>, fields: &Fields<'_>, f: Field<'_>) -> Option<Law> {
    let law = law::law(r, fields, f);
    law::of_force(r, &fields.subject(f.key), f.value).and(law)
}
