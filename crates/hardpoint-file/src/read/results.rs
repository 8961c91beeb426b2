//! Requested results: points to follow, measures, output times.

use std::sync::LazyLock;

use hardpoint::draft::{
    DirectionDraft, FieldDraft, FieldKind, LocationDraft, MeasureDraft, MeasureField, MeasureKindDraft,
    MeasureType, MetricDraft, PointDraft, PointRef, RayDraft, Section,
};
use hardpoint::model::{
    Axes, AxleMeasure, ElementUnit, OrientationAngle, ReactionPart, Reduction, WheelMeasure, WheelRequirement,
};
use hardpoint::space::Vec3;

use toml::de::DeValue;

use crate::format::{
    ANGLE, BODY, CASE, DRIVER, JOINT, Key, Kinds, LENGTH, NUMBER, Need, OUTPUT, Shape, TWO_NUMBERS, Table,
    keys, table,
};
use crate::places::EntryPlace;
use crate::tree::{DIRECTION, Field, Fields, LINE, PLACE, Reader, Subject, Value};

use super::law::{COLUMN, LAW};
use super::mesh::MESH;
use super::{COORDINATE, DRAW, Raw, data};

/// Maximum number of output times.
pub(super) const MOST_TIMES: u32 = 1_000_000;
pub(crate) const POINT: Table = table! {
    /// A point of a body.
    "BodyPoint":
    /// The body's name.
    must "body": BODY, "\"crank\"";
    /// Location in the design configuration: a hardpoint's name (the point then follows the hardpoint), or coordinates.
    must "at": PLACE, "\"A\"";
};
pub(crate) const POINT_REF: Shape = Shape::Any(
    "Point",
    "A point: by name, or a place on a body.",
    &[Shape::Name("a point"), Shape::Table(&POINT)],
);
pub(crate) const TIME: Kinds = Kinds {
    name: "Time",
    doc: "The output times, in seconds.",
    typed: false,
    tables: || vec![&STEPS, &TIMES],
};
const STEPS: Table = table! {
    /// Evenly spaced.
    "Steps":
    /// The first output time.
    or("0.0") "start": NUMBER, "0";
    /// The last output time.
    must "end": NUMBER, "1.0";
    /// Number of intervals: there is one output time more.
    must "steps": Shape::Count(MOST_TIMES), "100";
};
const TIMES: Table = table! {
    /// One by one.
    "Times":
    /// The output times, increasing.
    must "at": Shape::some(&NUMBER), "[0, 0.5, 1]";
};
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
pub(crate) const METRIC: Table = table! {
    /// One number of a curve.
    "Metric":
    /// The name of the measure, or `POINT.x`.
    must "of": OUTPUT, "\"toe\"";
    /// Reduction of the curve to one number.
    must "take": TAKE, "\"max\"";
    /// The abscissa: the name of a measure, or `POINT.x`. Default: time.
    may "over": OUTPUT, "\"wheel_travel\"";
    /// For a value or slope: the position, in the unit of the abscissa.
    may "at": NUMBER, "0";
    /// Window: the range of the abscissa that is used. Default: the whole curve.
    may "window": TWO_NUMBERS, "[-20, 20]";
    /// Points `[abscissa, value]`, or the name of a CSV file of them; for `rms` a polyline. Default: zero.
    may "target": TARGET, "[[-50, 0.1], [50, -0.1]]";
    /// Case of the motion. Default: all cases, with one number for each.
    may "case": CASE, "\"bump\"";
};
const TARGET: Shape =
    Shape::Any("Target", "", &[Shape::list(&TWO_NUMBERS), Shape::File, Shape::Table(&TARGET_FILE)]);
pub(super) const TARGET_FILE: Table = table! {
    /// A curve in a CSV file.
    "TargetFile":
    /// A CSV file in the model's folder or below it: abscissas and values, in the units of the model file.
    must "file": Shape::File, "\"target.csv\"";
    /// The file's columns of abscissa and value, by name or by number from 1. Default: the first two.
    may "columns": Shape::exactly(2, &COLUMN), "[1, 2]";
};
const FORCE_TABLE: Shape = Shape::Any(
    "ForceTable",
    "A force in N over a way in the length unit.",
    &[Shape::list(&TWO_NUMBERS), Shape::File, Shape::Table(&FORCE_FILE)],
);
pub(super) const FORCE_FILE: Table = table! {
    /// A force over deflection in a CSV file.
    "ForceFile":
    /// A CSV file in the model's folder or below it: deflections in the length unit, and forces in N.
    must "file": Shape::File, "\"bump_stop.csv\"";
    /// The file's columns of deflection and force, by name or by number from 1. Default: the first two.
    may "columns": Shape::exactly(2, &COLUMN), "[1, 2]";
};
const TAKE: Shape = Shape::Any(
    "Take",
    "What a metric takes.",
    &[Shape::Words(&[
        ("min", "The least value."),
        ("max", "The greatest value."),
        ("range", "The greatest less the least value."),
        ("mean", "The mean over time, or over the travel of the abscissa to and fro."),
        (
            "integral",
            "The integral over the abscissa: of a power over time the work in J, and of a force or a moment over its way or angle.",
        ),
        ("rms", "The root of the mean, as for `mean`, of the squared deviation from the target."),
        (
            "rms_at_points",
            "The root mean square of the deviation from the target's points, each where the abscissa first has its value.",
        ),
        ("value", "The value where the abscissa first is `at`."),
        ("slope", "The change per change of the abscissa where that first is `at`."),
    ])],
);
pub(crate) const MEASURE: Shape = Shape::Any(
    "Measure",
    "A measure.",
    &[Shape::Kinds(&OWN_MEASURE), Shape::Table(&OF_WHEEL), Shape::Table(&OF_AXLE)],
);
pub(super) const OWN_MEASURE: Kinds = Kinds {
    name: "OwnMeasure",
    doc: "A measure of anything else.",
    typed: true,
    tables: || MEASURES.iter().filter_map(|(table, kind)| kind.own().map(|_| table)).collect(),
};
const OF_WHEEL: Table = Table {
    shared: WHEEL,
    ..table! {
        /// A measure of a wheel.
        "MeasureOfWheel":
        /// Measured quantity.
        must "type": WHEEL_MEASURE, "\"caster\"";
    }
};
const OF_AXLE: Table = Table {
    shared: AXLE,
    ..table! {
        /// A measure of an axle.
        "MeasureOfAxle":
        /// Measured quantity.
        must "type": AXLE_MEASURE, "\"track\"";
    }
};
const WHEEL: &[Key] = keys! {
    /// The wheel's name.
    must "wheel": Shape::Name("a wheel"), "\"front_left\"";
};
const AXLE: &[Key] = keys! {
    /// The axle's name.
    must "axle": Shape::Name("an axle"), "\"front\"";
};
/// Measures with a shape in drawings.
const DISTANCE: &str = "distance";
const DRAWN: &[Key] = keys! {
    /// Shape in drawings, for springs and dampers as measured distances. It does not affect results.
    may "draw": DRAW, "\"coilover\"";
};
pub(super) const WHEEL_MEASURE: Shape = Shape::Any(
    "WheelMeasure",
    "",
    &[Shape::Known("the name of a measure", || {
        let needs = |m: &WheelMeasure| match m.needs() {
            WheelRequirement::Nothing => "",
            WheelRequirement::Kingpin => " Needs a kingpin.",
            WheelRequirement::Planes => " Needs `arm_planes`.",
            WheelRequirement::Bump => " Needs `bump`.",
            WheelRequirement::Spring => " Needs `bump` and `spring`.",
            WheelRequirement::Steer => " Needs `steer`.",
            WheelRequirement::Braking(_) => " Needs `bump`, and the vehicle's `front_brake_share`.",
            WheelRequirement::Driving(_) => " Needs `bump`, and the vehicle's `front_drive_share`.",
        };
        WheelMeasure::ALL.iter().map(|m| (m.name(), format!("{}{}", m.summary(), needs(m)))).collect()
    })],
);
const REACTION_PART: Shape = Shape::Any(
    "ReactionPart",
    "What of a joint's reaction is measured.",
    &[Shape::Words(ReactionPart::WORDS)],
);
const AXES: Shape = Shape::Any("Axes", "Along which axes something is given.", &[Shape::Words(Axes::WORDS)]);
const ORIENTATION_ANGLE: Shape = Shape::Any(
    "OrientationAngle",
    "One of three angles of a body's orientation.",
    &[Shape::Words(OrientationAngle::WORDS)],
);
pub(super) const AXLE_MEASURE: Shape = Shape::Any(
    "AxleMeasure",
    "",
    &[Shape::Known("the name of a measure", || {
        AxleMeasure::ALL.iter().map(|m| (m.name(), m.summary().to_owned())).collect()
    })],
);

/// Meaning of the `type` of a measure: `toe` applies to a wheel, or to a body with a spin axis.
#[derive(Clone, Copy)]
enum MeasureOf {
    Own(&'static MeasureType),
    Wheel(WheelMeasure),
    Axle(AxleMeasure),
    Either(&'static MeasureType, WheelMeasure),
}

impl MeasureOf {
    fn own(self) -> Option<&'static MeasureType> {
        if let Self::Own(own) | Self::Either(own, _) = self { Some(own) } else { None }
    }
}

/// The types of measures, as the core declares them.
static MEASURES: LazyLock<Vec<(Table, MeasureOf)>> = LazyLock::new(|| {
    let own = MeasureType::ALL.iter().map(|own| {
        let keys: Vec<Key> = own.fields.iter().map(key).collect();
        let shared = if own.name == DISTANCE { DRAWN } else { &[] };
        let table = Table { shared, ..Table::new(own.name, own.summary, keys.leak()) };
        match WheelMeasure::named(own.name) {
            Some(what) => (Table { instead: WHEEL, ..table }, MeasureOf::Either(own, what)),
            None => (table, MeasureOf::Own(own)),
        }
    });
    let has_own = |name: &str| MeasureType::ALL.iter().any(|own| own.name == name);
    let of_wheels = WheelMeasure::ALL.iter().filter(|what| !has_own(what.name()));
    let of_wheels =
        of_wheels.map(|what| (Table::new(what.name(), what.summary(), WHEEL), MeasureOf::Wheel(*what)));
    let of_axles = AxleMeasure::ALL
        .iter()
        .map(|what| (Table::new(what.name(), what.summary(), AXLE), MeasureOf::Axle(*what)));
    own.chain(of_wheels).chain(of_axles).collect()
});

/// The key of a field of a measure, a mass or a force.
pub(super) fn key(field: &MeasureField) -> Key {
    let (shape, example) = match field.kind {
        FieldKind::Joint => (JOINT, "\"J1\""),
        FieldKind::Coordinate => (COORDINATE, "\"angle\""),
        FieldKind::Point => (POINT_REF, "\"P\""),
        FieldKind::Direction => (DIRECTION, "\"z\""),
        FieldKind::Line => (LINE, "[0, 1, 0]"),
        FieldKind::Ray => (RAY, "[\"P\", \"Q\"]"),
        FieldKind::Output => (OUTPUT, "\"toe\""),
        FieldKind::Driver => (DRIVER, "\"bump\""),
        FieldKind::Body => (BODY, "\"knuckle\""),
        FieldKind::OrientationAngle => (ORIENTATION_ANGLE, "\"yaw\""),
        FieldKind::Expression => (Shape::Expression, "\"left.toe + right.toe\""),
        FieldKind::ReactionPart => (REACTION_PART, "\"radial\""),
        FieldKind::Axes => (AXES, "\"body\""),
        FieldKind::Force => (Shape::Name("a force"), "\"spring\""),
        FieldKind::Number(ElementUnit::Length) => (LENGTH, "20"),
        FieldKind::Number(ElementUnit::Angle) => (ANGLE, "5"),
        FieldKind::Number(ElementUnit::Density) => (NUMBER, "7850"),
        FieldKind::Number(_) => (NUMBER, "2.5"),
        FieldKind::Law => (LAW, "\"sin(2*pi*t)\""),
        FieldKind::Wheel => (Shape::Name("a wheel"), "\"front_left\""),
        FieldKind::Table => (FORCE_TABLE, "[[0, 0], [20, 400], [35, 1500]]"),
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
        ElementUnit::TorsionalDamping => "N m s per unit of angle",
        // Their sentences say it, or the shape does.
        ElementUnit::Density | ElementUnit::Plain | ElementUnit::Length | ElementUnit::Angle => {
            return field.summary;
        }
    };
    format!("{} In {unit}.", field.summary).leak()
}

impl Reader<'_> {
    pub(super) fn points(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for entry in self.entries(model, "points", "point") {
            let fields = self.entry("point", &entry, POINT.keys());
            let mut place = EntryPlace::of(&fields);
            let body = self.name_of(&fields, "body").unwrap_or_default();
            let at = self.place_of(&fields, "at");
            place.items("at", Vec::new());
            let at = at.unwrap_or(LocationDraft::At(Vec3::ZERO));
            self.push(raw, Section::Points, place);
            raw.draft.points.push(PointDraft { name: entry.0, body, at });
        }
    }

    pub(super) fn measures(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for entry in self.entries(model, "measures", "measure") {
            let (place, kind) = match self.entry_type("measure", &entry, &MEASURES) {
                Some((table, of)) => {
                    let fields = self.entry("measure", &entry, table.typed_keys());
                    let mut place = EntryPlace::of(&fields);
                    let kind = self.measure(*of, &fields, &mut place);
                    if table.name == DISTANCE
                        && let Some(form) = self.form_of(&fields)
                    {
                        raw.drawing.measures.insert(raw.draft.measures.len(), form);
                    }
                    (place, kind)
                }
                None => (EntryPlace::at(entry.1.clone()), None),
            };
            self.unread.clear();
            if kind.is_none() {
                self.unread.push("");
            }
            self.push(raw, Section::Measures, place);
            let kind = kind.unwrap_or(MeasureKindDraft::Unread);
            raw.draft.measures.push(MeasureDraft { name: entry.0, kind });
        }
    }

    fn measure(
        &mut self,
        of: MeasureOf,
        fields: &Fields<'_>,
        place: &mut EntryPlace,
    ) -> Option<MeasureKindDraft> {
        match of {
            MeasureOf::Either(own, _) if own.fields.iter().any(|f| fields.get(f.key).is_some()) => {
                self.out_of_place(fields, "wheel", "`body` and `spin_axis` define the wheel already");
                self.own_measure(own, fields, place)
            }
            MeasureOf::Own(own) => self.own_measure(own, fields, place),
            MeasureOf::Wheel(what) | MeasureOf::Either(_, what) => {
                self.name_of(fields, "wheel").map(|wheel| MeasureKindDraft::Wheel { wheel, what })
            }
            MeasureOf::Axle(what) => {
                self.name_of(fields, "axle").map(|axle| MeasureKindDraft::Axle { axle, what })
            }
        }
    }

    fn own_measure(
        &mut self,
        own: &MeasureType,
        fields: &Fields<'_>,
        place: &mut EntryPlace,
    ) -> Option<MeasureKindDraft> {
        let mut unread = false;
        let draft = own.draft(|field| self.own_field(field, fields, place, &mut unread));
        draft.filter(|_| !unread)
    }

    /// A field of a measure, a mass or a force; `unread` where it is there and cannot be read.
    pub(super) fn own_field(
        &mut self,
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
            | FieldKind::Body => self.name_of(fields, key).map(FieldDraft::Name),
            FieldKind::OrientationAngle => {
                self.word_of(fields, key).map(|k| FieldDraft::Angle(OrientationAngle::at(k)))
            }
            FieldKind::ReactionPart => {
                self.word_of(fields, key).map(|k| FieldDraft::Part(ReactionPart::at(k)))
            }
            FieldKind::Axes => self.word_of(fields, key).map(|k| FieldDraft::Axes(Axes::at(k))),
            FieldKind::Number(unit) => {
                self.given(fields, key, |r, f| r.element_number(fields, f, unit)).map(FieldDraft::Number)
            }
            FieldKind::Law => self.given(fields, key, |r, f| r.factor_law(fields, f)).map(FieldDraft::Law),
            FieldKind::Table => {
                self.given(fields, key, |r, f| r.force_table(fields, f)).map(FieldDraft::Table)
            }
            FieldKind::Mesh => {
                let solid = self.solid(fields, key);
                // It has been reported why there is none.
                *unread |= solid.is_none();
                solid.map(FieldDraft::Solid)
            }
            FieldKind::Point => self.point_of(fields, key).map(FieldDraft::Point),
            FieldKind::Direction => self.vector_of(fields, key).map(FieldDraft::Direction),
            FieldKind::Line => self.line_of(fields, key, place).map(FieldDraft::Line),
            FieldKind::Ray => self.given(fields, key, |r, f| r.ray(fields, f, place)).map(FieldDraft::Ray),
            FieldKind::Expression => self.given(fields, key, |r, f| {
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
    fn ray(&mut self, fields: &Fields<'_>, f: Field<'_>, place: &mut EntryPlace) -> Option<RayDraft> {
        let subject = fields.subject(f.key);
        if let Some(table) = f.value.get_ref().as_table() {
            let fields = self.fields(subject.name.clone(), f.value.span(), table, FIXED_RAY.keys());
            let body = self.name_of(&fields, "body");
            let axis = self.line_of(&fields, "axis", place);
            return Some(RayDraft::Fixed { body: body?, axis: axis? });
        }
        let is_number =
            |v: &Value<'_>| v.get_ref().as_integer().is_some() || v.get_ref().as_float().is_some();
        match f.value.get_ref().as_array() {
            Some(list) if list.len() == 2 && !list.iter().any(is_number) => {
                let [a, b] = [0, 1].map(|k| self.point_ref(fields, Field { value: &list[k], ..f }));
                Some(RayDraft::Between([a?, b?]))
            }
            _ => {
                let axis = self.vector(f.value, &subject)?;
                Some(RayDraft::Fixed { body: "ground".into(), axis: DirectionDraft::Along(axis) })
            }
        }
    }

    pub(super) fn metrics(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for entry in self.entries(model, "metrics", "metric") {
            let fields = self.entry("metric", &entry, METRIC.keys());
            let place = EntryPlace::of(&fields);
            let of = self.name_of(&fields, "of");
            let over = self.name_of(&fields, "over");
            let take = self.take(&fields);
            let window = self.list_of::<2>(&fields, "window", "the lower and the upper end");
            let case = self.name_of(&fields, "case");
            // An incomplete metric would have another meaning.
            if of.is_none() || take.is_none() || !self.unread.is_empty() {
                self.unread.push("");
            }
            let (per_metre, per_radian) = (self.units.length.per_metre(), self.units.angle.per_radian());
            self.push(raw, Section::Metrics, place);
            raw.draft.metrics.push(MetricDraft {
                name: entry.0,
                of: of.unwrap_or_default(),
                over,
                take: take.unwrap_or(Reduction::Least),
                window,
                case,
                per_metre,
                per_radian,
            });
        }
    }

    /// Reduction of a metric, in the file's units.
    fn take(&mut self, fields: &Fields<'_>) -> Option<Reduction> {
        let word = Reduction::NAMES[self.word_of(fields, "take")?];
        if word != "rms" && word != "rms_at_points" {
            let why = "only `take = \"rms\"` and `\"rms_at_points\"` compare with a target";
            self.out_of_place(fields, "target", why);
        }
        if word != "value" && word != "slope" {
            self.out_of_place(fields, "at", "only `take = \"value\"` and `\"slope\"` are taken at one place");
        } else {
            self.out_of_place(fields, "window", "it is taken at one place");
            self.need(fields, "at");
        }
        Some(match word {
            "min" => Reduction::Least,
            "max" => Reduction::Greatest,
            "range" => Reduction::Range,
            "mean" => Reduction::Mean,
            "integral" => Reduction::Integral,
            "rms" => Reduction::Rms(match fields.get("target") {
                Some(f) => self.target(fields, f)?,
                None => Vec::new(),
            }),
            "rms_at_points" => {
                let field = self.need(fields, "target")?;
                Reduction::RmsAtPoints(self.target(fields, field)?)
            }
            "value" => Reduction::Value(self.number_of(fields, "at")?),
            _ => Reduction::Slope(self.number_of(fields, "at")?),
        })
    }

    /// Target curve of an `rms`, given here or in a file.
    fn target(&mut self, fields: &Fields<'_>, f: Field<'_>) -> Option<Vec<[f64; 2]>> {
        self.points_given(fields, f, &TARGET_FILE, &data::TARGET)
    }

    /// Force over deflection, given here or in a file.
    fn force_table(&mut self, fields: &Fields<'_>, f: Field<'_>) -> Option<Vec<[f64; 2]>> {
        let points = self.points_given(fields, f, &FORCE_FILE, &data::FORCE)?;
        Some(points.into_iter().map(|[way, force]| [self.units.length.metres(way), force]).collect())
    }

    /// Points, the name of a file that holds them, or a table with it.
    fn points_given(
        &mut self,
        fields: &Fields<'_>,
        f: Field<'_>,
        table_of_file: &'static Table,
        of: &data::Curve,
    ) -> Option<Vec<[f64; 2]>> {
        let subject = fields.subject(f.key);
        match f.value.get_ref() {
            DeValue::Table(table) => {
                let fields = self.fields(subject.name, f.value.span(), table, table_of_file.keys());
                let file = self.need(&fields, "file")?;
                self.points_in_file(&fields, file, of)
            }
            DeValue::String(name) => match self.points_of_text(name, &data::FIRST_TWO, of) {
                Ok(points) => Some(points),
                Err(e) => {
                    self.data_error(f.value.span(), e);
                    None
                }
            },
            _ => self.pairs(f.value, &subject, of.abscissa),
        }
    }

    /// A list of pairs of numbers.
    fn pairs(&mut self, value: &Value<'_>, subject: &Subject, abscissa: &str) -> Option<Vec<[f64; 2]>> {
        let expected = format!("points `[{abscissa}, value]`, or the name of a CSV file");
        let list = self.list(value, subject, &expected)?;
        list.iter().map(|pair| self.numbers::<2>(pair, subject, &expected)).collect()
    }

    /// A point that a key names.
    pub(super) fn point_of(&mut self, fields: &Fields<'_>, key: &str) -> Option<PointRef> {
        self.given(fields, key, |r, f| r.point_ref(fields, f))
    }

    pub(super) fn point_ref(&mut self, fields: &Fields<'_>, f: Field<'_>) -> Option<PointRef> {
        let subject = fields.subject(f.key);
        let Some(table) = f.value.get_ref().as_table() else {
            return self
                .name(f.value, &subject, "a point's name or `{ body = ..., at = ... }`")
                .map(PointRef::Named);
        };
        let fields = self.fields(subject.name.clone(), f.value.span(), table, POINT.keys());
        let body = self.name_of(&fields, "body");
        let at = self.place_of(&fields, "at");
        Some(PointRef::On { body: body?, at: at? })
    }

    pub(super) fn time(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        let Some(f) = model.get("time") else { return };
        self.unread.clear();
        let place = EntryPlace::at(f.value.span());
        let times = self.times("`time`", &model.subject("time"), f);
        if times.is_none() {
            self.unread.push("");
        }
        raw.draft.times = times.unwrap_or_default();
        self.push(raw, Section::Time, place);
    }

    /// Reads output times; `what` names their owner.
    pub(super) fn times(&mut self, what: &str, subject: &Subject, f: Field<'_>) -> Option<Vec<f64>> {
        let table = self.table(f.value, subject, "a table with `end` and `steps`")?;
        let fields = self.fields(what, f.value.span(), table, TIME.keys());
        if let Some(f) = fields.get("at") {
            for key in ["start", "end", "steps"] {
                self.out_of_place(&fields, key, "the output times are listed in `at` already");
            }
            let subject = fields.subject("at");
            let Some(list) = f.value.get_ref().as_array().filter(|list| !list.is_empty()) else {
                self.wrong(f.value, &subject, "a list of times in s");
                return None;
            };
            if list.len() > MOST_TIMES as usize {
                self.senseless(f.value.span(), format!("there are more than {MOST_TIMES} output times"));
                return None;
            }
            let times: Vec<_> = list.iter().map(|v| self.number(v, &subject)).collect();
            let times: Vec<f64> = times.into_iter().collect::<Option<_>>()?;
            if let Some(k) = (1..times.len()).find(|&k| times[k] <= times[k - 1]) {
                let message = format!("the output time {} s comes after {} s", times[k], times[k - 1]);
                self.senseless(list[k].span(), message).help =
                    Some("list the times in increasing order".into());
                return None;
            }
            return Some(times);
        }
        let start = self.number_of(&fields, "start");
        let end = self.number_of(&fields, "end");
        let steps = self.given(&fields, "steps", |r, f| {
            let steps = r.number(f.value, &fields.subject("steps"))?;
            if !(steps >= 1.0 && steps <= f64::from(MOST_TIMES) && steps.fract() == 0.0) {
                let message = format!("`steps` of {what} cannot be {steps}");
                r.senseless(f.value.span(), message).help =
                    Some(format!("give the number of intervals, a whole number from 1 to {MOST_TIMES}"));
                return None;
            }
            Some(steps as usize)
        });
        let (start, end, steps) = (start?, end?, steps?);
        if end <= start {
            let at = fields.get("end").map_or(fields.at.clone(), |f| f.value.span());
            let message = format!("the motion ends at {end} s, before it starts at {start} s");
            self.senseless(at, message).help =
                Some("give an `end` after `start` (which is 0 if it is left out)".into());
            return None;
        }
        Some((0..=steps).map(|k| start + (end - start) * k as f64 / steps as f64).collect())
    }
}
