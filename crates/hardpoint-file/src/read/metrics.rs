//! Metrics: numbers of a measure's curve.

use hardpoint::draft::{DraftError, DraftLocation, MetricDraft, Section};
use hardpoint::model::{Dimension, Model, Reduction, ReductionArguments, ReductionKeys};
use hardpoint_table::Units;

use crate::values::{
    CASE, DataError, EntryPlace, Field, Fields, NUMBER, OUTPUT, Reader, Shape, TWO_NUMBERS, Table, table,
};

use super::data;
use super::data::{COLUMN, Title, Titles};
use super::raw::Raw;

pub(super) const METRIC: Table = table! {
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
    /// A CSV file in the model's folder or below it: abscissas and values, in the units of the model file or a title's.
    must "file": Shape::File, "\"target.csv\"";
    /// The file's columns of abscissa and value, by name or by number from 1. Default: the first two.
    may "columns": Shape::exactly(2, &COLUMN), "[1, 2]";
};
const TAKE: Shape = Shape::Any("Take", "What a metric takes.", &[Shape::Words(Reduction::WORDS)]);

pub(super) fn metrics(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    for entry in r.entries(model, "metrics", "metric") {
        let fields = r.entry("metric", &entry, METRIC.keys());
        let place = EntryPlace::of(&fields);
        let of = r.name_of(&fields, "of");
        let over = r.name_of(&fields, "over");
        let (take, titles) = take(r, &fields).unzip();
        let window = r.list_of::<2>(&fields, "window", "the lower and the upper end");
        let case = r.name_of(&fields, "case");
        // An incomplete metric would have another meaning.
        if of.is_none() || take.is_none() || !r.unread.is_empty() {
            r.unread.push("");
        }
        let (per_metre, per_radian) = (r.units.length.per_metre(), r.units.angle.per_radian());
        raw.push(r, Section::Metrics, place);
        raw.target_titles.extend(titles.map(|titles| (raw.draft.metrics.len(), titles)));
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

/// Reduction of a metric, in the file's units, and the titles of its target.
fn take(r: &mut Reader<'_>, fields: &Fields<'_>) -> Option<(Reduction, Titles)> {
    let kind = &Reduction::TYPES[r.word_of(fields, "take")?];
    let [curve, points, place] = [ReductionKeys::Target, ReductionKeys::Points, ReductionKeys::Place];
    if ![curve, points].contains(&kind.keys) {
        let why = format!("only {} compare with a target", names(&[curve, points]));
        r.out_of_place(fields, "target", why);
    }
    if kind.keys != place {
        let why = format!("only {} are taken at one place", names(&[place]));
        r.out_of_place(fields, "at", why);
    }
    let (mut arguments, mut titles) = (ReductionArguments::default(), Titles::default());
    match kind.keys {
        ReductionKeys::Window => {}
        ReductionKeys::Target => {
            if let Some(f) = fields.get("target") {
                (arguments.target, titles) = target(r, fields, f)?;
            }
        }
        ReductionKeys::Points => {
            let field = r.need(fields, "target")?;
            (arguments.target, titles) = target(r, fields, field)?;
        }
        ReductionKeys::Place => {
            r.out_of_place(fields, "window", "it is taken at one place");
            r.need(fields, "at");
            arguments.at = r.number_of(fields, "at")?;
        }
        ReductionKeys::Ends => {
            for key in ["window", "over"] {
                r.out_of_place(fields, key, "a change is that from the first to the last output time");
            }
        }
    }
    Some(((kind.of)(arguments), titles))
}

/// The reductions with these keys, as written: `take = "value"` and `"slope"`.
fn names(keys: &[ReductionKeys]) -> String {
    let all = Reduction::TYPES.iter().filter(|kind| keys.contains(&kind.keys));
    let names: Vec<String> = all.map(|kind| format!("`\"{}\"`", kind.name)).collect();
    names.join(" and ").replacen('`', "`take = ", 1)
}

/// Target curve of an `rms`, given here or in a file, and the titles of the file's columns.
fn target(r: &mut Reader<'_>, fields: &Fields<'_>, f: Field<'_>) -> Option<(Vec<[f64; 2]>, Titles)> {
    data::points_given(r, fields, f, (&TARGET_FILE, &data::TARGET), |r, pair, subject, expected| {
        r.numbers(pair, subject, expected)
    })
}

/// HP0112: targets whose columns have units that are not those of the abscissa and the measure; with the indices of
/// metrics and the titles of their targets.
pub(super) fn wrong_units(model: &Model, units: Units, targets: &[(usize, Titles)]) -> Vec<DraftError> {
    let time = Dimension::NUMBER.rate(-1);
    let of_metric = |(index, titles): &(usize, Titles)| {
        let metric = &model.metrics[*index];
        let columns = [metric.over, Some(metric.of)].map(|output| match output {
            Some(output) => (format!("`{}`", model.output_name(output)), model.dimension(output)),
            None => ("the abscissa".to_owned(), time),
        });
        let error = titles.iter().zip(&columns).find_map(|(title, (of, dimension))| {
            let Title { name, unit } = title.as_ref()?;
            data::other_unit([name, unit.as_deref()?], "the target", units, (of, *dimension))
        })?;
        let at = DraftLocation { section: Section::Metrics, index: *index, key: "target", item: None };
        let DataError { code, message, notes, help, .. } = error;
        Some(DraftError { code, at, message, notes, help })
    };
    targets.iter().filter_map(of_metric).collect()
}
