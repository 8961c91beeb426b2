//! Settings of a tolerance study.

use hardpoint::draft::{
    CorrelationDraft, LimitDraft, LimitTargetDraft, ScatterDraft, Section, ToleranceDraft,
    ToleranceSettingsDraft,
};
use hardpoint::model::{AllocationRule, ToleranceSettings};
use toml::de::DeValue;

use crate::values::{
    EntryPlace, Fields, METRIC, NUMBER, OUTPUT, Reader, Shape, Subject, Table, VARIABLE, shown, table,
};

use super::joints;
use super::raw::Raw;

pub(crate) const TOLERANCE: Table = table! {
    /// Tolerances of the design, and the limits that it must keep. All design variables with a `tolerance` are
    /// included.
    "Tolerance":
    /// Tolerances by name of the design variable, in its unit; they override those of the variables. For a point in
    /// `[design]`: the radius of a sphere, or of a disc.
    may "variables": Shape::Entries("a design variable", &ENTRY), "{ B = 0.1, C_x = { tolerance = 0.2, distribution = \"uniform\" } }";
    /// Default distribution of deviations.
    or("\"normal\"") "distribution": DISTRIBUTION, "\"uniform\"";
    /// Number of standard deviations of the normal distribution in a tolerance.
    or("3.0") "sigmas": NUMBER, "2";
    /// Correlations of normal variables.
    may "correlations": Shape::Entries("a correlation", &Shape::Table(&CORRELATION)), "{ jig = { between = [\"left_z\", \"right_z\"], coefficient = 0.9 } }";
    /// Names of the analysed metrics. Default: all.
    may "metrics": Shape::list(&METRIC), "[\"toe_range\"]";
    /// Names of the measures whose curves are analysed. Default: all.
    may "curves": Shape::list(&OUTPUT), "[\"toe\"]";
    /// Limits of metrics.
    may "limits": Shape::Entries("a metric", &Shape::Table(&LIMIT)), "{ toe = { metric = \"toe_range\", max = 0.5 } }";
    /// Number of designs that are drawn and solved exactly.
    or("10000") "samples": Shape::Count(ToleranceSettings::MOST), "100000";
    /// Seed of the random numbers: the same seed gives the same designs.
    or("1") "seed": Shape::Count(u32::MAX), "7";
    /// Allocates the loosest tolerances that keep the limits, for variables with a `cost`.
    may "allocate": Shape::Words(&ALLOCATE), "\"rss\"";
    /// With `allocate = "rss"`: number of standard deviations between the nominal value of a metric and its limit.
    or("3.0") "required_sigmas": NUMBER, "4.5";
};
const DISTRIBUTION: Shape = Shape::Words(&[
    ("uniform", "Evenly within the tolerance, and never beyond."),
    ("normal", "Normal; the tolerance is `sigmas` standard deviations, and a part exceeds it."),
    ("truncated", "The same normal, truncated at the tolerance."),
]);
const ALLOCATE: [(&str, &str); 2] = [
    ("rss", "`required_sigmas` standard deviations (root sum of squares) keep the limits."),
    ("worst_case", "All deviations at once keep the limits, each at its worst."),
];
const ENTRY: Shape = Shape::Any(
    "VariableTolerance",
    "By how much it may be off, or a table with that and more.",
    &[NUMBER, Shape::Table(&ENTRY_TABLE)],
);
pub(super) const ENTRY_TABLE: Table = table! {
    /// Tolerance and distribution of a design variable.
    "VariableToleranceTable":
    /// The tolerance, plus or minus, in the variable's unit. Default: the `tolerance` of the variable itself.
    may "tolerance": NUMBER, "0.1";
    /// Distribution of the deviation. Default: that of `[tolerance]`.
    may "distribution": DISTRIBUTION, "\"uniform\"";
    /// Number of standard deviations in the tolerance. Default: that of `[tolerance]`.
    may "sigmas": NUMBER, "2";
    /// Relative cost of the tolerance: `cost` over the tolerance. Without it `allocate` does not change the tolerance.
    may "cost": NUMBER, "5";
};
pub(super) const CORRELATION: Table = table! {
    /// Correlation of two normal variables, such as those made with one jig.
    "Correlation":
    /// The names of two design variables.
    must "between": Shape::exactly(2, &VARIABLE), "[\"left_z\", \"right_z\"]";
    /// Their coefficient of correlation, from -1 to 1.
    must "coefficient": NUMBER, "0.9";
};
pub(super) const LIMIT: Table = table! {
    /// Limit of a metric: at least one of `min` and `max`; or the limit of a joint.
    "ToleranceLimit":
    /// The metric's name. Default: the limit's own name.
    may "metric": METRIC, "\"toe_range\"";
    /// Instead: the name of the limit of a joint, those of the joint and its coordinate; its own `min` and `max` are
    /// kept.
    may "joint": Shape::Name("a limit of a joint"), "\"slide.displacement\"";
    /// It must not be less than this, in its own unit.
    may "min": NUMBER, "-0.2";
    /// It must not be more than this.
    may "max": NUMBER, "0.2";
};

pub(super) fn tolerance(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    let Some(fields) = r.study(model, "tolerance", "variables", &TOLERANCE) else { return };
    let place = EntryPlace::of(&fields);
    let scatter = scatter(r, &fields);
    let [metrics, curves] = ["metrics", "curves"].map(|key| r.list_of_names(&fields, key, "all"));
    let samples = r.count_of(&fields, "samples", ToleranceSettings::MOST);
    let seed = r.count_of(&fields, "seed", u32::MAX);
    let keep = r.number_of(&fields, "required_sigmas");
    let rule = r.word_of(&fields, "allocate");
    if fields.get("required_sigmas").is_some() && rule != Some(0) {
        r.out_of_place(&fields, "required_sigmas", "only `allocate = \"rss\"` uses standard deviations");
    }
    r.lost_tables(&fields);
    raw.push(r, Section::Tolerance, place);
    let tolerances = tolerances(r, &fields, raw);
    let correlations = correlations(r, &fields, raw);
    let limits = limits_of_tolerances(r, &fields, raw);
    let allocation = rule.map(|rule| match AllocationRule::NAMED[rule] {
        AllocationRule::Rss { sigmas } => AllocationRule::Rss { sigmas: keep.unwrap_or(sigmas) },
        AllocationRule::Worst => AllocationRule::Worst,
    });
    raw.draft.tolerancing = Some(ToleranceSettingsDraft {
        tolerances,
        correlations,
        limits,
        metrics,
        curves,
        scatter,
        samples: samples.unwrap_or(ToleranceSettings::SAMPLES),
        seed: seed.map_or(ToleranceSettings::SEED, |seed| seed as u64),
        allocation,
    });
}

fn scatter(r: &mut Reader<'_>, fields: &Fields<'_>) -> ScatterDraft {
    let kind = fields.get("distribution").and_then(|_| r.word_of(fields, "distribution"));
    ScatterDraft { kind, sigmas: r.number_of(fields, "sigmas") }
}

fn tolerances(r: &mut Reader<'_>, tolerance: &Fields<'_>, raw: &mut Raw) -> Vec<ToleranceDraft> {
    let (per_metre, per_radian) = (r.units.length.per_metre(), r.units.angle.per_radian());
    let mut found = Vec::new();
    for entry in r.entries_below(tolerance, "tolerance.", "variables", "design variable") {
        let (name, at, value) = &entry;
        let (place, reach, scatter, cost) = match value.get_ref() {
            DeValue::Table(_) => {
                let fields = r.entry("the tolerance of", &entry, ENTRY_TABLE.keys());
                let place = EntryPlace::of(&fields);
                let reach = r.number_of(&fields, "tolerance");
                let scatter = scatter(r, &fields);
                (place, reach, scatter, r.number_of(&fields, "cost"))
            }
            _ => {
                r.unread.clear();
                let subject = Subject {
                    name: format!("the tolerance of `{}`", shown(name)),
                    example: format!(
                        "for example `{name} = 0.1`, or `{name} = {{ tolerance = 0.1, cost = 5 }}`"
                    ),
                };
                let mut place = EntryPlace::at(at.clone());
                place.key("tolerance", value);
                let reach = r.number(value, &subject);
                if reach.is_none() {
                    r.unread.push("tolerance");
                }
                (place, reach, ScatterDraft::default(), None)
            }
        };
        if !r.unread.is_empty() {
            r.unread.push("");
        }
        raw.push(r, Section::Tolerances, place);
        found.push(ToleranceDraft { name: entry.0, reach, scatter, cost, per_metre, per_radian });
    }
    found
}

fn correlations(r: &mut Reader<'_>, tolerance: &Fields<'_>, raw: &mut Raw) -> Vec<CorrelationDraft> {
    let mut found = Vec::new();
    for entry in r.entries_below(tolerance, "tolerance.", "correlations", "correlation") {
        let fields = r.entry("correlation", &entry, CORRELATION.keys());
        let place = EntryPlace::of(&fields);
        let between = r.names_of::<2>(&fields, "between");
        r.need(&fields, "coefficient");
        let coefficient = r.number_of(&fields, "coefficient");
        if between.is_none() || coefficient.is_none() {
            r.unread.push("");
        }
        raw.push(r, Section::Correlations, place);
        let (between, coefficient) = (between.unwrap_or_default(), coefficient.unwrap_or_default());
        found.push(CorrelationDraft { name: entry.0, between, coefficient });
    }
    found
}

fn limits_of_tolerances(r: &mut Reader<'_>, tolerance: &Fields<'_>, raw: &mut Raw) -> Vec<LimitDraft> {
    let (per_metre, per_radian) = (r.units.length.per_metre(), r.units.angle.per_radian());
    let mut found = Vec::new();
    for entry in r.entries_below(tolerance, "tolerance.", "limits", "limit") {
        let fields = r.entry("limit", &entry, LIMIT.keys());
        let place = EntryPlace::of(&fields);
        if fields.get("joint").is_some() {
            for key in ["metric", "min", "max"] {
                r.out_of_place(&fields, key, "the limit of the joint has its own metrics, `min` and `max`");
            }
            let ends = joints::ends_of_limit(r, &fields, raw).unwrap_or_else(|| {
                r.unread.push("");
                vec![("", LimitTargetDraft::Unread, [None; 2])]
            });
            let unread = std::mem::take(&mut r.unread);
            for (end, of, [least, most]) in ends {
                r.unread.clone_from(&unread);
                raw.push(r, Section::ToleranceLimits, place.clone());
                let name = if end.is_empty() { entry.0.clone() } else { format!("{}.{end}", entry.0) };
                found.push(LimitDraft { name, of, least, most, per_metre, per_radian });
            }
            continue;
        }
        let metric = r.name_of(&fields, "metric");
        let [least, most] = ["min", "max"].map(|key| r.number_of(&fields, key));
        if !fields.lost && fields.get("min").is_none() && fields.get("max").is_none() {
            let message = format!("{} has no values", fields.what);
            r.report("HP0104", fields.at.clone(), message).help =
                Some("give `min = 50`, `max = 200`, or both of them".into());
            r.unread.push("");
        }
        if !r.unread.is_empty() {
            r.unread.push("");
        }
        raw.push(r, Section::ToleranceLimits, place);
        let of = LimitTargetDraft::Metric(metric.unwrap_or_else(|| entry.0.clone()));
        found.push(LimitDraft { name: entry.0, of, least, most, per_metre, per_radian });
    }
    found
}
