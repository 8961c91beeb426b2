//! Settings of an optimisation.

use hardpoint::draft::{GoalDraft, LimitDraft, LimitTargetDraft, OptimizationSettingsDraft, Section};
use hardpoint::model::OptimizationSettings;

use crate::values::{
    EntryPlace, Field, Fields, HARDPOINT, JOINT, Key, Kinds, METRIC, NUMBER, Reader, Shape, TWO_NUMBERS,
    Table, VARIABLE, keys, table,
};

use super::joints;
use super::raw::Raw;

pub(crate) const OPTIMIZE: Table = table! {
    /// Goals and limits of an optimisation.
    "Optimize":
    /// Names of the design variables that may change, each within its `bounds`. Default: all that have bounds.
    may "variables": Shape::some(&VARIABLE), "[\"tie_rod_outer_y\"]";
    /// Goals; the sum of all of them is minimised.
    must "goals": Shape::Entries("a metric", &Shape::Table(&GOAL)), "{ toe = { metric = \"toe_error\" } }";
    /// Names of two or three goals whose best compromises `hardpoint trade-off` finds. Default: all goals.
    may "trade_off": Shape::some(&Shape::Name("a goal")), "[\"bump_steer\", \"camber\"]";
    /// Conditions that the design must satisfy.
    may "limits": Shape::Entries("a metric", &Shape::Kinds(&LIMIT)), "{ rod = { length = \"tie_rod\", max = 300 } }";
    /// Minimum margin of all motions from singular positions at their output times, between 0 and 1: a limit. Default:
    /// none.
    may "min_margin": NUMBER, "0.02";
    /// Number of designs from which the search starts: the nominal design, and others within the bounds.
    or("1") "starts": Shape::Count(OptimizationSettings::MOST), "8";
    /// True if the searches also start from the other assemblies of the mechanism, `starts` times each.
    or("false") "other_assemblies": Shape::Flag, "true";
    /// True if the searches also start with all drivers in the opposite sense, in every assembly.
    or("false") "both_senses": Shape::Flag, "true";
    /// Maximum number of iterations of a search.
    or("1000") "max_iterations": Shape::Count(OptimizationSettings::MOST), "100";
};
pub(super) const GOAL: Table = table! {
    /// A metric to minimise, or to bring to a target.
    "Goal":
    /// The metric's name. Default: the goal's own name.
    may "metric": METRIC, "\"toe_error\"";
    /// Weight of one unit of the metric, in the file's units; above zero.
    or("1.0") "weight": NUMBER, "100";
    /// Target of the metric, in its unit. Default: the metric is minimised. An `rms` has none.
    may "target": NUMBER, "0.2";
};
pub(super) const LIMIT: Kinds = Kinds {
    name: "Limit",
    doc: "A condition on a quantity, given by exactly one of {keys}.",
    typed: false,
    tables: || LIMITS.iter().map(|l| &l.0).collect(),
};
/// Reads the limited quantities; a box has several.
type Read = fn(&mut Reader<'_>, &Fields<'_>, &Raw) -> Option<Vec<One>>;
/// Axis of a box (or none), limited quantity, and its limits.
type One = (&'static str, LimitTargetDraft, Bounds);
/// Minimum and maximum.
type Bounds = [Option<f64>; 2];

/// Declares a kind of limit, with the shared keys.
macro_rules! limit {
    ($($table:tt)*) => { Table { shared: BOUNDS, ..table! { $($table)* } } };
}

static LIMITS: &[(Table, Read)] = &[
    (
        limit! {
            /// A metric, in its own unit.
            "LimitOfMetric":
            /// The metric's name.
            must "metric": METRIC, "\"ackermann_error\"";
        },
        |r, fields, _| {
            let name = r.name_of(fields, "metric");
            let bounds = bounds_of_limit(r, fields);
            Some(vec![("", LimitTargetDraft::Metric(name?), bounds?)])
        },
    ),
    (
        limit! {
            /// The position of a hardpoint in the design configuration: a box, each side in the length unit.
            "LimitOfHardpoint":
            /// The hardpoint's name.
            must "hardpoint": HARDPOINT, "\"A\"";
            /// Range of its x: two numbers, or `{ min = 10 }`, `{ max = 20 }`.
            may "x": SIDE, "[10, 20]";
            /// Range of its y.
            may "y": SIDE, "[-5, 5]";
            /// Range of its z.
            may "z": SIDE, "{ min = 0 }";
        },
        |r, fields, _| boxed(r, fields),
    ),
    (
        limit! {
            /// The distance of two hardpoints in the design configuration, in the length unit.
            "LimitOfDistance":
            /// The hardpoints' names.
            must "between": Shape::exactly(2, &HARDPOINT), "[\"A\", \"B\"]";
        },
        |r, fields, _| {
            let names = r.names_of::<2>(fields, "between");
            let bounds = bounds_of_limit(r, fields);
            Some(vec![("", LimitTargetDraft::Distance(names?), bounds?)])
        },
    ),
    (
        limit! {
            /// The length of a rod or leg in the design configuration, in the length unit.
            "LimitOfLength":
            /// The joint's name.
            must "length": JOINT, "\"rod\"";
        },
        |r, fields, _| {
            let name = r.name_of(fields, "length");
            let bounds = bounds_of_limit(r, fields);
            Some(vec![("", LimitTargetDraft::Length(name?), bounds?)])
        },
    ),
    (
        limit! {
            /// The least distance of the shapes of a clearance; by default its own `min` is kept.
            "LimitOfClearance":
            /// The clearance's name.
            must "clearance": Shape::Name("a clearance"), "\"rod_to_screws\"";
        },
        |r, fields, raw| {
            let name = r.name_of(fields, "clearance")?;
            let of = LimitTargetDraft::Metric(format!("{name}.min"));
            if ["min", "max", "equal"].iter().any(|key| fields.get(key).is_some()) {
                let bounds = bounds_of_limit(r, fields);
                return Some(vec![("", of, bounds?)]);
            }
            let min = raw.draft.clearances.iter().find(|c| c.name == name).map(|c| &c.min);
            let asked = min.filter(|min| min.of.is_empty()).and_then(|min| min.default);
            if asked.is_none() && min.is_some() {
                let message = format!("{} has no values", fields.what);
                r.report("HP0104", fields.at.clone(), message).help =
                    Some(format!("give `min = 2` here, or one `min` in `clearances.{name}`"));
                return None;
            }
            // The core reports an unknown clearance.
            let asked = asked.map(|x| x * r.units.length.per_metre());
            Some(vec![("", of, [asked.or(Some(0.0)), None])])
        },
    ),
    (
        limit! {
            /// The limit of a joint: its own `min` and `max` are kept.
            "LimitOfJoint":
            /// The limit's name: those of the joint and its coordinate.
            must "joint": Shape::Name("a limit of a joint"), "\"slide.displacement\"";
        },
        |r, fields, raw| {
            for key in ["min", "max", "equal"] {
                r.out_of_place(fields, key, "the limit of the joint has its own `min` and `max`");
            }
            joints::ends_of_limit(r, fields, raw)
        },
    ),
];
const BOUNDS: &[Key] = keys! {
    /// Minimum; not for a hardpoint, which has a range for each axis.
    may "min": NUMBER, "50";
    /// Maximum.
    may "max": NUMBER, "200";
    /// Required value, instead of both.
    may "equal": NUMBER, "100";
};
const SIDE: Shape = Shape::Any("Side", "", &[TWO_NUMBERS, Shape::Table(&SIDE_TABLE)]);
const SIDE_TABLE: Table = Table::new("SideTable", "One side of a box, which may be open.", BOUNDS);

pub(super) fn optimize(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    let Some(fields) = r.study(model, "optimize", "goals", &OPTIMIZE) else { return };
    let place = EntryPlace::of(&fields);
    let variables = r.list_of_names(&fields, "variables", "all that have bounds");
    let trade_off = r.list_of_names(&fields, "trade_off", "all goals");
    let margin = r.number_of(&fields, "min_margin");
    let starts = r.count_of(&fields, "starts", OptimizationSettings::MOST);
    let other_assemblies = r.flag_of(&fields, "other_assemblies").unwrap_or(false);
    let both_senses = r.flag_of(&fields, "both_senses").unwrap_or(false);
    let iterations = r.count_of(&fields, "max_iterations", OptimizationSettings::MOST);
    if r.need(&fields, "goals").is_none() {
        r.unread.push("goals");
    }
    r.lost_tables(&fields);
    raw.push(r, Section::Optimize, place);
    let goals = goals(r, &fields, raw);
    let limits = limits(r, &fields, raw);
    raw.draft.optimization = Some(OptimizationSettingsDraft {
        variables,
        goals,
        limits,
        margin,
        starts: starts.unwrap_or(1),
        other_assemblies,
        both_senses,
        iterations: iterations.unwrap_or(1),
        trade_off: trade_off.unwrap_or_default(),
    });
}

fn goals(r: &mut Reader<'_>, optimize: &Fields<'_>, raw: &mut Raw) -> Vec<GoalDraft> {
    let (per_metre, per_radian) = (r.units.length.per_metre(), r.units.angle.per_radian());
    let mut goals = Vec::new();
    for entry in r.entries_below(optimize, "optimize.", "goals", "goal") {
        let fields = r.entry("goal", &entry, GOAL.keys());
        let place = EntryPlace::of(&fields);
        let metric = r.name_of(&fields, "metric");
        let weight = r.number_of(&fields, "weight");
        let target = r.number_of(&fields, "target");
        if !r.unread.is_empty() {
            r.unread.push("");
        }
        raw.push(r, Section::Goals, place);
        let (metric, weight) = (metric.unwrap_or_else(|| entry.0.clone()), weight.unwrap_or(1.0));
        goals.push(GoalDraft { name: entry.0, metric, weight, target, per_metre, per_radian });
    }
    goals
}

fn limits(r: &mut Reader<'_>, optimize: &Fields<'_>, raw: &mut Raw) -> Vec<LimitDraft> {
    let (per_metre, per_radian) = (r.units.length.per_metre(), r.units.angle.per_radian());
    let mut limits = Vec::new();
    for entry in r.entries_below(optimize, "optimize.", "limits", "limit") {
        let fields = r.entry("limit", &entry, LIMIT.keys());
        let place = EntryPlace::of(&fields);
        let before = r.found.len();
        let kind = r.led_by(&fields, LIMITS, ["limited quantity", "the limited quantity is given"]);
        // With keys of several kinds, further errors depend on the intended one.
        let is_clear = r.found.len() == before;
        let read = kind.filter(|_| is_clear).and_then(|(_, read)| read(r, &fields, raw));
        let read = read.unwrap_or_else(|| {
            r.unread.push("");
            vec![("", LimitTargetDraft::Unread, [None; 2])]
        });
        let unread = std::mem::take(&mut r.unread);
        for (axis, of, [least, most]) in read {
            r.unread.clone_from(&unread);
            raw.push(r, Section::Limits, place.clone());
            let name = if axis.is_empty() { entry.0.clone() } else { format!("{}.{axis}", entry.0) };
            limits.push(LimitDraft { name, of, least, most, per_metre, per_radian });
        }
    }
    limits
}

/// Sides of a box.
fn boxed(r: &mut Reader<'_>, fields: &Fields<'_>) -> Option<Vec<One>> {
    let before = r.found.len();
    for key in ["min", "max", "equal"] {
        let why = "a hardpoint is limited along each axis: `x = [10, 20]`, or `z = { min = 0 }`";
        r.out_of_place(fields, key, why);
    }
    let name = r.name_of(fields, "hardpoint");
    if r.found.len() > before {
        return None;
    }
    let axes = ["x", "y", "z"];
    if axes.iter().all(|key| fields.get(key).is_none()) {
        let message = format!("{} has no axis", fields.what);
        r.report("HP0104", fields.at.clone(), message).help =
            Some("give at least one of `x = [10, 20]`, `y = { min = 0 }`, `z = { equal = 5 }`".into());
        return None;
    }
    let sides = axes.map(|key| r.given(fields, key, |r, f| side(r, fields, f)));
    let complete = axes.iter().zip(&sides).all(|(key, side)| side.is_some() || fields.get(key).is_none());
    let name = name.filter(|_| complete)?;
    let sides = (0..3).zip(axes).zip(sides);
    let limit = |((k, axis), side): ((usize, &'static str), Option<Bounds>)| {
        side.map(|side| (axis, LimitTargetDraft::Coordinate(name.clone(), k), side))
    };
    Some(sides.filter_map(limit).collect())
}

/// Two numbers, or a table with one of them.
fn side(r: &mut Reader<'_>, fields: &Fields<'_>, f: Field<'_>) -> Option<Bounds> {
    let subject = fields.subject(f.key);
    let Some(table) = f.value.get_ref().as_table() else {
        let expected = "the least and the most, or a table like `{ min = 10 }`";
        return r.numbers::<2>(f.value, &subject, expected).map(|b| b.map(Some));
    };
    let fields = r.fields(subject.name, f.value.span(), table, SIDE_TABLE.keys());
    bounds_of_limit(r, &fields)
}

/// `min` and `max`, or `equal`. HP0104 where there is none of them.
fn bounds_of_limit(r: &mut Reader<'_>, fields: &Fields<'_>) -> Option<Bounds> {
    let has = |key: &str| fields.get(key).is_some();
    if !has("min") && !has("max") && !has("equal") {
        if !fields.lost {
            let message = format!("{} has no values", fields.what);
            r.report("HP0104", fields.at.clone(), message).help =
                Some("give `min = 50`, `max = 200`, both of them, or `equal = 100`".into());
        }
        return None;
    }
    if has("equal") {
        for key in ["min", "max"] {
            r.out_of_place(fields, key, "`equal` defines both");
        }
    }
    let [min, max, equal] = ["min", "max", "equal"].map(|key| r.number_of(fields, key));
    let read = ["min", "max", "equal"].iter().zip([min, max, equal]);
    if read.clone().any(|(key, x)| x.is_none() && has(key)) {
        return None;
    }
    Some(if equal.is_some() { [equal; 2] } else { [min, max] })
}
