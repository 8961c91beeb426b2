//! Laws of motion: an expression, a number, or a table that selects the kind of law.

use std::ops::Range;

use hardpoint::draft::ConstantError;
use hardpoint::expression::Expression;
use hardpoint::joint::Quantity;
use hardpoint::law::{self, Law, LawError, SplineDegree, SplineEndRates, SplineEnds};
use toml::de::{DeTable, DeValue};

use crate::values::{
    ANGLE, Field, Fields, Kinds, NUMBER, Reader, Severity, Shape, Subject, TWO_NUMBERS, Table, Value,
    all_read, closest, shown, table,
};
use hardpoint_table::AngleUnit;

use super::data;
use super::data::{COLUMN, Title};

/// Maximum number of pieces of a sequence, whose cost grows with their square.
const MOST_PIECES: usize = 500;
/// A law of motion.
pub(crate) const LAW: Shape = Shape::Any(
    "Law",
    "A law of motion: an expression in `t` (seconds) such as `30*sin(2*pi*t)`, a number, or a table with a `type`; in the file's \
     unit of what is driven.",
    &[Shape::Expression, Shape::Plain(Quantity::Number), Shape::Kinds(&LAW_TABLE)],
);
pub(crate) const LAW_TABLE: Kinds =
    Kinds { name: "LawTable", doc: "", typed: true, tables: || TYPES.iter().map(|t| &t.0).collect() };

/// Reads a law from its fields; the text names its owner.
type Read = fn(&mut Reader<'_>, &str, &Fields<'_>) -> Option<Law>;

static TYPES: &[(Table, Read)] = &[
    (
        table! {
            /// `offset + amplitude sin(2 pi frequency t + phase)`.
            "harmonic":
            /// In the driver's unit.
            must "amplitude": NUMBER, "25";
            /// In Hz.
            must "frequency": NUMBER, "1.5";
            /// In the angle unit.
            or("0.0") "phase": ANGLE, "90";
            /// The mean, in the driver's unit.
            or("0.0") "offset": NUMBER, "10";
        },
        |r, _, fields| {
            let numbers = r.numbers_of(fields, ["amplitude", "frequency", "phase", "offset"]);
            let [amplitude, frequency, phase, offset] = numbers?;
            let law = Law::harmonic(law::Harmonic { amplitude, frequency, phase, offset });
            made(r, fields, fields.at.clone(), law)
        },
    ),
    (
        table! {
            /// `offset + speed t`.
            "constant_speed":
            /// In the driver's unit per s.
            must "speed": NUMBER, "10";
            /// At t = 0, in the driver's unit.
            or("0.0") "offset": NUMBER, "5";
        },
        |r, _, fields| {
            let [speed, offset] = r.numbers_of(fields, ["speed", "offset"])?;
            made(r, fields, fields.at.clone(), Law::constant_speed(law::ConstantSpeed { speed, offset }))
        },
    ),
    (
        table! {
            /// `c0 + c1 t + c2 t^2 + ...`.
            "polynomial":
            /// c0, c1, c2, ..., in the driver's unit per s to the power of the number.
            must "coefficients": Shape::some(&NUMBER), "[0, 1, 2]";
        },
        |r, _, fields| polynomial(r, fields),
    ),
    (
        table! {
            /// A smooth step from one value to another; at rest before and after.
            "smooth_step":
            /// The value before, in the driver's unit.
            or("0.0") "from": NUMBER, "0";
            /// The value after, in the driver's unit.
            must "to": NUMBER, "40";
            /// Start time, in s.
            must "start": NUMBER, "0.5";
            /// End time, in s.
            must "end": NUMBER, "1.5";
            /// 3 (the acceleration jumps at both ends), 5 (the jerk does) or 7 (neither).
            or("5") "degree": Shape::OneOf(&[3, 5, 7]), "5";
        },
        |r, _, fields| smooth_step(r, fields),
    ),
    (
        table! {
            /// From one value to another with constant acceleration, constant speed, constant deceleration; at rest
            /// before and after.
            "trapezoid":
            /// The value before, in the driver's unit.
            or("0.0") "from": NUMBER, "0";
            /// The value after, in the driver's unit.
            must "to": NUMBER, "40";
            /// Start time, in s.
            must "start": NUMBER, "0.5";
            /// End time, in s.
            must "end": NUMBER, "1.5";
            /// Duration of acceleration and of deceleration, in s; at most half of that time.
            must "ramp": NUMBER, "0.2";
        },
        |r, _, fields| {
            let [from, to, start, end, ramp] =
                r.numbers_of(fields, ["from", "to", "start", "end", "ramp"])?;
            let at = fields.get("ramp").map_or(fields.at.clone(), |f| f.value.span());
            made(r, fields, at, Law::trapezoid(law::Trapezoid { from, to, start, end, ramp }))
        },
    ),
    (
        table! {
            /// A spline through points, given here or in a CSV file.
            "table":
            /// Pairs of time in s and value in the driver's unit, in the order of time. Either these or `file`.
            may "points": Shape::list(&TWO_NUMBERS), "[[0, 0], [1, 5], [2, 0]]";
            /// A CSV file in the model's folder or below it: times in s and values in the driver's unit.
            may "file": Shape::File, "\"travel.csv\"";
            /// The file's columns of time and value, by name or by number from 1. Default: the first two.
            may "columns": Shape::exactly(2, &COLUMN), "[1, 2]";
            /// The degree of the spline.
            or("\"cubic\"") "spline": Shape::Words(&[("cubic", "The acceleration is continuous."), ("quintic", "The jerk is continuous too.")]), "\"cubic\"";
            /// Boundary conditions at the first and last point.
            or("\"clamped\"") "ends": ENDS, "\"clamped\"";
            /// Speed at the first point, for clamped ends, in the driver's unit per s.
            or("0.0") "start_speed": NUMBER, "0";
            /// Speed at the last point, for clamped ends, in the driver's unit per s.
            or("0.0") "end_speed": NUMBER, "0";
            /// Acceleration at the first point, of a quintic with clamped ends, in the driver's unit per s^2.
            or("0.0") "start_acceleration": NUMBER, "0";
            /// Acceleration at the last point, of a quintic with clamped ends, in the driver's unit per s^2.
            or("0.0") "end_acceleration": NUMBER, "0";
        },
        |r, _, fields| table_law(r, fields),
    ),
    (
        table! {
            /// Laws one after the other, from t = 0 on.
            "sequence":
            /// The pieces, in order.
            must "pieces": Shape::List(&Shape::Table(&PIECE), [1, MOST_PIECES]), "[{ duration = 1, law = \"10*t\" }, { law = 0 }]";
        },
        sequence,
    ),
    (
        table! {
            /// An expression with named parameters.
            "expression":
            /// The expression, in `t` and the parameters.
            must "law": Shape::Expression, "\"a*sin(w*t)\"";
            /// Names and values of the parameters.
            or("{}") "parameters": Shape::Entries("a parameter of the law", &NUMBER), "{ a = 25, w = 6.28 }";
        },
        expression_with_parameters,
    ),
];

const ENDS: Shape = Shape::Words(&[
    (
        "clamped",
        "With the given speeds (and accelerations of a quintic); by default zero: from rest to rest.",
    ),
    ("natural", "The curve ends as a thin beam does."),
    ("periodic", "The last point is the first again, and the curve repeats for ever."),
]);
pub(super) const PIECE: Table = table! {
    /// A piece of a sequence.
    "Piece":
    /// Duration, in s. The last piece may omit it, and then has no end.
    may "duration": NUMBER, "1";
    /// Law; `t` counts from the start of the piece.
    must "law": LAW, "\"10*t\"";
    /// True if its values are relative to the end of the previous piece.
    or("true") "continued": Shape::Flag, "true";
};
const EXPECTED: &str = "an expression in `t` in quotes, a number, or a table with a `type`";

/// The law of a driver, in the file's units.
pub(super) fn law(r: &mut Reader<'_>, fields: &Fields<'_>, f: Field<'_>) -> Option<Law> {
    law_in(r, &fields.what, &fields.subject(f.key), f.value)
}

/// Reads a law; `of` names its owner.
pub(super) fn law_in(r: &mut Reader<'_>, of: &str, subject: &Subject, value: &Value<'_>) -> Option<Law> {
    match value.get_ref() {
        DeValue::String(_) => law_text(r, of, value, &[]),
        DeValue::Integer(_) | DeValue::Float(_) => r.number(value, subject).map(Law::constant),
        DeValue::Table(table) => law_table(r, of, subject, value, table),
        _ => {
            r.wrong(value, subject, EXPECTED);
            None
        }
    }
}

fn law_text(r: &mut Reader<'_>, of: &str, value: &Value<'_>, parameters: &[(&str, f64)]) -> Option<Law> {
    let text = value.get_ref().as_str()?;
    let mut parameters = parameters.to_vec();
    for name in Law::names(text) {
        if !parameters.iter().any(|p| p.0 == name)
            && let Some(value) = named_in_law(r, of, value, name)?
        {
            parameters.push((name, value));
        }
    }
    match Law::parse_with(text, &parameters) {
        Ok(law) => {
            degrees_in_functions(r, of, value, text, &parameters);
            Some(law)
        }
        Err(error) => {
            let unknown = text.get(error.span.clone()).filter(|_| error.message.starts_with("unknown name"));
            let close = unknown.and_then(|name| closest(name, r.nominal.names()));
            let close = close.map(|c| format!("did you mean the parameter `{c}`?"));
            let at = r.inside(value, text, error.span);
            let message = format!("invalid law of {of}: {}", error.message);
            r.report("HP0108", at, message).help = close.or(error.help);
            None
        }
    }
}

/// HP0112: units in the tables of the law that was read last that are not those of its values, if it is known what they
/// are.
pub(super) fn check_units(r: &mut Reader<'_>, quantity: Option<Quantity>) {
    let units = std::mem::take(&mut r.law_units);
    let Some(quantity) = quantity else { return };
    for (at, [name, unit]) in units {
        let of = ("the law", quantity.into());
        if let Some(error) = data::other_unit([&name, &unit], "the table", r.units, of) {
            r.data_error(at, error);
        }
    }
}

/// Makes the law that was read last one of a force, which is the same in every design: `None` if it is not. HP0230: a
/// parameter in it that the design changes.
pub(super) fn of_force(r: &mut Reader<'_>, subject: &Subject, value: &Value<'_>) -> Option<()> {
    check_units(r, Some(Quantity::Number));
    let mut is_same = Some(());
    for (_, expression) in std::mem::take(&mut r.law_formulas) {
        let Err(why) = r.nominal.constant(&expression) else { continue };
        is_same = None;
        let ConstantError::Follows(name, what) = why else {
            r.no_constant(value, subject, why);
            continue;
        };
        let message = format!("{} cannot follow parameter `{name}`", subject.name);
        let d = r.report("HP0230", value.span(), message);
        d.notes.push(format!("{what} changes `{name}`, and the law of a force is the same in every design"));
        d.help = Some(format!(
            "let what the law multiplies depend on it, like `force = \"50*{name}\"`; or write `design = false` for the parameter"
        ));
    }
    is_same
}

/// HP0114: the argument of a trigonometric function looks like degrees, but it is in rad.
fn degrees_in_functions(
    r: &mut Reader<'_>,
    of: &str,
    value: &Value<'_>,
    text: &str,
    parameters: &[(&str, f64)],
) {
    if r.units.angle != AngleUnit::Degree {
        return;
    }
    for (function, argument) in trigonometric(text) {
        let Some(inside) = text.get(argument.clone()) else { continue };
        let Some([offset, rate]) = linear(inside, parameters) else { continue };
        if !looks_like_degrees(rate) && !looks_like_degrees(offset) {
            continue;
        }
        let call = format!("{function}({})", shown(inside));
        let at = r.inside(value, text, argument);
        let message = format!("`{call}` in the law of {of} is not in degrees: functions take radians");
        let right = in_radians(function, [offset, rate]);
        let d = r.remark(Severity::Warning, "HP0114", at, message);
        d.notes.push("the file's unit for angles, deg, applies to values only".into());
        d.help = Some(format!("write `{right}` for degrees"));
    }
}

/// The value of a parameter of the file that the text of a law names; `Some(None)` if there is none of that name.
fn named_in_law(r: &mut Reader<'_>, of: &str, value: &Value<'_>, name: &str) -> Option<Option<f64>> {
    let Some((number, quantity)) = r.nominal.parameter(name) else { return Some(None) };
    if quantity == Quantity::Angle {
        let message = format!("the law of {of} cannot be read: parameter `{name}` is an angle");
        let d = r.report("HP0108", value.span(), message);
        d.notes.push(
            "in a law, values of the driver are in the file's unit and arguments of functions in rad".into(),
        );
        d.help = Some(format!("declare `{name}` as a plain number, in the unit in which the law takes it"));
        return None;
    }
    let expression = Expression::parse(name).ok()?.with_unit(r.units.length.per_metre());
    // Further errors of an invalid parameter are not reported.
    let number = number.map_or(1.0, |x| r.units.from_si(quantity, x));
    r.law_formulas.push((name.to_owned(), expression));
    Some(Some(number))
}

fn law_table<'a>(
    r: &mut Reader<'_>,
    of: &str,
    subject: &Subject,
    value: &'a Value<'a>,
    table: &'a DeTable<'a>,
) -> Option<Law> {
    let at = value.span();
    let (declared, read) = r.kind_of(table, &subject.name, at.clone(), "a law", TYPES)?;
    let fields = r.fields(format!("the law of {of}"), at, table, declared.typed_keys());
    read(r, of, &fields)
}

/// HP0110: parameters that do not define a law.
fn made(
    r: &mut Reader<'_>,
    fields: &Fields<'_>,
    at: Range<usize>,
    law: Result<Law, LawError>,
) -> Option<Law> {
    match law {
        Ok(law) => Some(law),
        Err(error) => {
            let message = format!("{} is invalid: {}", fields.what, error.message);
            r.report("HP0110", at, message).help = error.help;
            None
        }
    }
}

fn polynomial(r: &mut Reader<'_>, fields: &Fields<'_>) -> Option<Law> {
    let f = r.need(fields, "coefficients")?;
    let subject = fields.subject(f.key);
    let list = r.list(f.value, &subject, "a list of numbers: of 1, t, t^2, ...")?;
    let numbers = all_read(list.iter().enumerate().map(|(k, v)| {
        let name = format!("coefficient {k} of {}", fields.what);
        r.number(v, &Subject { name, example: subject.example.clone() })
    }))?;
    made(r, fields, f.value.span(), Law::polynomial(&numbers))
}

fn smooth_step(r: &mut Reader<'_>, fields: &Fields<'_>) -> Option<Law> {
    let numbers = r.numbers_of(fields, ["from", "to", "start", "end", "degree"]);
    let [from, to, start, end, degree] = numbers?;
    let known = [3.0, 5.0, 7.0].contains(&degree);
    // A degree that is no whole number is none of the three either.
    let degree = if known { degree as u32 } else { 0 };
    let at = fields.get(if known { "end" } else { "degree" }).map_or(fields.at.clone(), |f| f.value.span());
    if !known {
        let written = r.source.text.get(at.clone()).unwrap_or_default().to_owned();
        let message = format!("{} is invalid: a smooth step has no degree {written}", fields.what);
        r.report("HP0110", at, message).help = Some(
            "give 3, 5 or 7: with 3 the acceleration jumps at both ends, with 5 the jerk, with 7 neither"
                .into(),
        );
        return None;
    }
    made(r, fields, at, Law::smooth_step(law::SmoothStep { from, to, start, end, degree }))
}

fn sequence(r: &mut Reader<'_>, of: &str, fields: &Fields<'_>) -> Option<Law> {
    let f = r.need(fields, "pieces")?;
    let subject = fields.subject(f.key);
    let list = r.list(f.value, &subject, "a list of tables")?;
    if list.len() > MOST_PIECES {
        r.senseless(f.value.span(), format!("{} has {} entries", subject.name, list.len()))
            .notes
            .push(format!("a sequence has at most {MOST_PIECES} pieces"));
        return None;
    }
    let count = list.len();
    let mut pieces = Vec::new();
    for (k, v) in list.into_iter().enumerate() {
        let what = format!("piece {k} of the law of {of}");
        let Some(table) = r.table(v, &subject, "a list of tables") else { continue };
        let piece = r.fields(what.clone(), v.span(), table, PIECE.keys());
        let is_last = k + 1 == count;
        let duration = match (is_last, piece.get("duration")) {
            (true, None) => Some(None),
            (_, None) => r.need(&piece, "duration").and(None),
            _ => r.number_of(&piece, "duration").map(Some),
        };
        if let (Some(Some(seconds)), Some(f)) = (duration, piece.get("duration"))
            && seconds <= 0.0
        {
            let message = format!("{what} lasts {seconds} s");
            r.report("HP0110", f.value.span(), message).help =
                Some("give a duration greater than zero, in s".into());
            continue;
        }
        let before = r.law_formulas.len();
        let law = r.need(&piece, "law").and_then(|f| law_in(r, &what, &piece.subject("law"), f.value));
        for (name, _) in &mut r.law_formulas[before..] {
            *name = format!("piece[{k}].{name}");
        }
        let continued = r.flag_of(&piece, "continued");
        if let (Some(duration), Some(law), Some(continued)) = (duration, law, continued) {
            pieces.push(law::Piece { duration, law, continued });
        }
    }
    if pieces.len() < count {
        return None;
    }
    made(r, fields, f.value.span(), Law::sequence(pieces))
}

fn expression_with_parameters(r: &mut Reader<'_>, of: &str, fields: &Fields<'_>) -> Option<Law> {
    let text = r.need(fields, "law");
    if let Some(f) = text
        && f.value.get_ref().as_str().is_none()
    {
        r.wrong(f.value, &fields.subject("law"), "an expression in `t`, in quotes");
        return None;
    }
    let mut parameters: Vec<(String, f64)> = Vec::new();
    if let Some(f) = fields.get("parameters") {
        let subject = fields.subject("parameters");
        let table = r.table_of_names(f.value, &subject, "a table of names and numbers")?;
        for (name, value) in table {
            let subject = Subject {
                name: format!("parameter `{}` of {}", shown(name.get_ref()), fields.what),
                example: "for example `parameters = { a = 25 }`".into(),
            };
            let name = r.short(name.get_ref(), name.span(), "the name of a parameter");
            let number = match value.get_ref().is_str() {
                true => law_parameter_formula(r, name.as_deref(), value, &subject),
                false => r.number(value, &subject),
            };
            parameters.push((name?, number?));
        }
    }
    let text = text?;
    let parameters: Vec<(&str, f64)> = parameters.iter().map(|(n, x)| (n.as_str(), *x)).collect();
    law_text(r, of, text.value, &parameters)
}

/// The value of an expression for a parameter of a law, which follows the design.
fn law_parameter_formula(
    r: &mut Reader<'_>,
    name: Option<&str>,
    value: &Value<'_>,
    subject: &Subject,
) -> Option<f64> {
    let expression = r.expression(value, subject)?;
    match r.nominal.value(&expression) {
        Ok(number) => {
            r.law_formulas.push((name?.to_owned(), expression));
            Some(number)
        }
        Err(why) => {
            r.no_constant(value, subject, why);
            None
        }
    }
}

fn table_law(r: &mut Reader<'_>, fields: &Fields<'_>) -> Option<Law> {
    let degree = r.word_of(fields, "spline").map(|k| [SplineDegree::Cubic, SplineDegree::Quintic][k]);
    let ends = ends(r, fields, degree);
    let points = match (fields.get("points"), fields.get("file")) {
        (Some(f), file) => {
            if file.is_some() {
                r.out_of_place(fields, "file", "the points of this table are given by `points` already");
            }
            r.out_of_place(fields, "columns", "`columns` goes with `file`");
            points_of_table(r, fields, f).map(|p| (p, f))
        }
        (None, Some(f)) => data::points_in_file(r, fields, f, &data::TABLE).map(|found| {
            if let [_, Some(Title { name, unit: Some(unit) })] = found.titles {
                r.law_units.push((f.value.span(), [name, unit]));
            }
            (found.points, f)
        }),
        (None, None) => {
            let message = format!("{} has no `points`", fields.what);
            r.report("HP0104", fields.at.clone(), message).help = Some(
                "give `points = [[0, 0], [1, 5], [2, 0]]`, or `file = \"travel.csv\"` next to the model file"
                    .into(),
            );
            None
        }
    };
    let (degree, ends, (points, f)) = (degree?, ends?, points?);
    let (times, values) = points.into_iter().map(|[t, x]| (t, x)).unzip();
    made(r, fields, f.value.span(), Law::table(&law::Table { times, values, degree, ends }))
}

fn ends(r: &mut Reader<'_>, fields: &Fields<'_>, degree: Option<SplineDegree>) -> Option<SplineEnds> {
    let kind = r.word_of(fields, "ends")?;
    let keys = ["start_speed", "start_acceleration", "end_speed", "end_acceleration"];
    if kind > 0 {
        for key in keys {
            r.out_of_place(fields, key, "speeds and accelerations go with `ends = \"clamped\"`");
        }
        return Some(if kind == 1 { SplineEnds::Natural } else { SplineEnds::Periodic });
    }
    if degree == Some(SplineDegree::Cubic) {
        for key in [keys[1], keys[3]] {
            let why = "the acceleration at the ends of a cubic spline follows from its points; \
                       with `spline = \"quintic\"` it can be given";
            r.out_of_place(fields, key, why);
        }
    }
    let [start, start_rate, end, end_rate] = r.numbers_of(fields, keys)?;
    let start = SplineEndRates { speed: start, acceleration: start_rate };
    let end = SplineEndRates { speed: end, acceleration: end_rate };
    match degree {
        // Reported above.
        Some(SplineDegree::Cubic) if start.acceleration != 0.0 || end.acceleration != 0.0 => None,
        _ => Some(SplineEnds::Clamped { start, end }),
    }
}

fn points_of_table(r: &mut Reader<'_>, fields: &Fields<'_>, f: Field<'_>) -> Option<Vec<[f64; 2]>> {
    let subject = fields.subject(f.key);
    let list = r.list(f.value, &subject, "a list of pairs of time and value")?;
    let points = all_read(list.iter().enumerate().map(|(k, v)| {
        let subject =
            Subject { name: format!("point {k} of {}", fields.what), example: subject.example.clone() };
        r.numbers::<2>(v, &subject, "a pair of time and value, `[t, x]`")
    }))?;
    if let Some(k) = (1..points.len()).find(|&k| points[k][0] <= points[k - 1][0]) {
        let (before, after) = (points[k - 1][0], points[k][0]);
        let message = format!("the times of a table must increase, but {after} s follows {before} s");
        r.report("HP0110", list[k].span(), message).help = Some(
            if before == after { "remove one of the two points" } else { "sort the points by time" }.into(),
        );
        return None;
    }
    Some(points)
}

/// The arguments of `sin`, `cos` and `tan` in the text of a law.
fn trigonometric(text: &str) -> Vec<(&'static str, Range<usize>)> {
    let mut found = Vec::new();
    for function in ["sin", "cos", "tan"] {
        for (at, _) in text.match_indices(function) {
            // `asin` is another function.
            let named = text[..at].chars().next_back().is_some_and(|c| c.is_alphanumeric() || c == '_');
            let rest = &text[at + function.len()..];
            let open = at + function.len() + (rest.len() - rest.trim_start().len());
            if named || !text[open..].starts_with('(') {
                continue;
            }
            let mut depth = 0;
            let end = text[open..].char_indices().find(|(_, c)| {
                depth += i32::from(*c == '(') - i32::from(*c == ')');
                depth == 0
            });
            found.extend(end.map(|(end, _)| (function, open + 1..open + end)));
        }
    }
    found.sort_by_key(|(_, at)| at.start);
    found
}

/// Offset and rate of an expression that is linear in t.
fn linear(text: &str, parameters: &[(&str, f64)]) -> Option<[f64; 2]> {
    const ROUND_OFF: f64 = 1e-12;
    let names = Law::names(text);
    let used: Vec<_> = parameters.iter().copied().filter(|p| names.contains(&p.0)).collect();
    let law = Law::parse_with(text.trim(), &used).ok()?;
    let [offset, one, more] = [0.0, 1.0, 3.7].map(|t| law.at(t).value());
    let rate = one - offset;
    let is_linear = (offset + 3.7 * rate - more).abs() <= ROUND_OFF * (offset.abs() + rate.abs());
    is_linear.then_some([offset, rate])
}

/// Returns whether a number is a multiple of 30, which is typical of degrees and never of rad written with `pi`.
fn looks_like_degrees(x: f64) -> bool {
    const USUAL: f64 = 30.0;
    x.abs() >= USUAL && x % USUAL == 0.0
}

/// Rewrites the degrees in the argument as fractions of pi.
fn in_radians(function: &str, [offset, rate]: [f64; 2]) -> String {
    let part = |x: f64, of: &str| match x.abs() / 180.0 {
        1.0 => format!("pi{of}"),
        k if k < 1.0 && (1.0 / k).fract() == 0.0 => format!("pi/{}{of}", 1.0 / k),
        k => format!("{k}*pi{of}"),
    };
    let sign = |x: f64| if x < 0.0 { "-" } else { "" };
    let argument = match (rate == 0.0, offset == 0.0) {
        (true, _) => format!("{}{}", sign(offset), part(offset, "")),
        (_, true) => format!("{}{}", sign(rate), part(rate, "*t")),
        _ => {
            let join = if offset < 0.0 { "-" } else { "+" };
            let rate = if looks_like_degrees(rate) {
                format!("{}{}", sign(rate), part(rate, "*t"))
            } else {
                // It is in rad already.
                format!("{rate}*t")
            };
            let offset = if looks_like_degrees(offset) { part(offset, "") } else { offset.abs().to_string() };
            format!("{rate} {join} {offset}")
        }
    };
    format!("{function}({argument})")
}
