//! `compare.json`, `compare.csv` and `compare.html`: comparison of two model files and their motions.

use std::collections::BTreeSet;
use std::io::Write;

use hardpoint::Solution;
use hardpoint::model::{Dimension, Model};
use hardpoint::run::metrics;
use hardpoint_file::{Diagnostic, ModelFile, Units};
use hardpoint_study::Magnitude;
use hardpoint_table::series::settled;
use serde::Serialize;

use crate::GENERATOR;
use crate::columns;
use crate::course::RoundOff;
use crate::figures::{number, rounded, unit, with_unit};
use crate::page::{Payload, StudyTables, Table};
use crate::record::{Column, write_curves};

/// Hardpoints with a smaller distance than this, m, coincide: numbers in different units agree only to round-off.
const SAME_PLACE: f64 = 1e-12;

/// Comparison of two designs. Values are in the units of the first file, times in s.
#[derive(Clone, Debug, Serialize)]
pub struct CompareFacts {
    /// Program and version.
    pub generator: &'static str,
    /// Names of both model files, as given.
    pub files: [String; 2],
    /// Names of both mechanisms.
    pub names: [String; 2],
    /// Coordinates of hardpoints that differ.
    pub hardpoints: Vec<Difference>,
    /// Parameters that differ.
    pub parameters: Vec<Difference>,
    /// Differences of the curves of each measure (and component of a point) in both files.
    pub measures: Vec<CurveDifference>,
    /// Metrics in both files.
    pub metrics: Vec<Difference>,
    /// Entries of the first file only, and of the second file only.
    pub only_in: [Vec<String>; 2],
    /// Number of solved output times of each design.
    pub steps: [usize; 2],
    /// Output times, s.
    pub times: Vec<f64>,
    /// Further diagnostics.
    pub diagnostics: Vec<Diagnostic>,
}

/// Number in both files.
#[derive(Clone, Debug, Serialize)]
pub struct Difference {
    /// Name.
    pub name: String,
    /// Unit; `1` for a plain number.
    pub unit: String,
    /// Values in the first and the second file; `null` if a motion does not reach it.
    pub values: [Option<f64>; 2],
}

/// Curves of the same name in both files.
#[derive(Clone, Debug, Serialize)]
pub struct CurveDifference {
    /// Name of the measure.
    pub measure: String,
    /// Unit.
    pub unit: String,
    /// Largest difference, second minus first, with its sign.
    pub difference: Option<f64>,
    /// Time of the largest difference, s; `null` if the curves are equal.
    pub time: Option<f64>,
    /// Curves of the first and the second file over the output times that both solved.
    pub curves: [Vec<f64>; 2],
}

/// Model file with its solution.
#[derive(Clone, Copy, Debug)]
pub struct SolvedModel<'a> {
    /// Model file.
    pub file: &'a ModelFile,
    /// Solution.
    pub solution: &'a Solution,
}

impl CompareFacts {
    /// Compares two models that were solved over the same output times.
    pub fn of(both: [SolvedModel<'_>; 2]) -> Self {
        let [a, b] = both;
        let units = a.file.units;
        let steps = both.map(|s| s.solution.motion.len());
        let common = steps[0].min(steps[1]);
        Self {
            generator: GENERATOR,
            files: both.map(|s| s.file.file_name().into()),
            names: both.map(|s| s.file.model.name.clone()),
            hardpoints: hardpoints(&a.file.model, &b.file.model, units),
            parameters: parameters(&a.file.model, &b.file.model, units),
            measures: curves(both, units, common),
            metrics: of_metrics(both, units),
            only_in: [only_in(&a.file.model, &b.file.model), only_in(&b.file.model, &a.file.model)],
            steps,
            times: a.solution.motion.times[..common].to_vec(),
            diagnostics: a.file.remarks.clone(),
        }
    }

    /// True if nothing that both files contain differs.
    pub fn is_same(&self) -> bool {
        self.hardpoints.is_empty() && self.parameters.is_empty() && self.only_in.iter().all(Vec::is_empty)
    }

    /// Tables of the differences, and of their effect on the requested measures.
    pub fn tables(&self, wanted: &dyn Fn(&str) -> bool) -> Vec<Table> {
        let [first, second] = self.files.each_ref().map(String::as_str);
        let of = |title: &str, what: &str, list: &[Difference]| {
            let columns: [Column<'_, &Difference>; 4] = [
                (what, &|d| d.name.clone()),
                (first, &|d| d.shown(0)),
                (second, &|d| d.shown(1)),
                ("difference", &|d| {
                    shown_difference(d.values[0].zip(d.values[1]).map(|(a, b)| b - a), &d.unit)
                }),
            ];
            Table::of(title, "", &columns, list).if_any()
        };
        let range = |c: &CurveDifference, k: usize| {
            let low = c.curves[k].iter().copied().fold(f64::INFINITY, f64::min);
            let high = c.curves[k].iter().copied().fold(f64::NEG_INFINITY, f64::max);
            if low <= high { format!("{} to {}", number(low), with_unit(high, &c.unit)) } else { "-".into() }
        };
        let measures = Table::of(
            "Measures",
            "",
            &[
                ("measure", &|c: &&CurveDifference| c.measure.clone()),
                (first, &|c| range(c, 0)),
                (second, &|c| range(c, 1)),
                ("largest difference", &|c| shown_difference(c.difference, &c.unit)),
                ("at t", &|c| c.time.map_or("-".into(), |t| format!("{} s", number(t)))),
            ],
            self.measures.iter().filter(|c| wanted(&c.measure)),
        )
        .if_any();
        let lacking = [0, 1].map(|k| {
            let title = format!("Only in {}", self.files[k]);
            Table::of(title, "", &[("what", &|name: &&String| (*name).clone())], &self.only_in[k]).if_any()
        });
        let differ = [
            of("Hardpoints that differ", "hardpoint", &self.hardpoints),
            of("Parameters that differ", "parameter", &self.parameters),
            of("Metrics", "metric", &self.metrics),
            measures,
        ];
        differ.into_iter().chain(lacking).flatten().collect()
    }

    /// Turns the page of the first design into the comparison: with the second design alongside, and a tab for the
    /// differences.
    pub fn page(&self, mut page: Payload, asked: &[String], wanted: &dyn Fn(&str) -> bool) -> Payload {
        let quantity = |name: &str| page.quantities.iter().position(|q| q.name == name);
        page.first = asked.first().and_then(|name| quantity(name)).or(page.first);
        Payload { study: StudyTables::of("Differences", self.tables(wanted)), ..page }
    }

    /// Writes the curves of both files, one row per output time.
    ///
    /// # Errors
    /// If `out` cannot be written.
    pub fn write_csv(&self, out: impl Write) -> csv::Result<()> {
        let column = |c: &CurveDifference, file| columns::Column {
            name: format!("{} {file}", c.measure),
            unit: c.unit.clone(),
        };
        let curves = self.measures.iter().flat_map(|c| {
            ["first", "second"]
                .into_iter()
                .zip(&c.curves)
                .map(move |(file, curve)| (column(c, file).header(), curve.as_slice()))
        });
        write_curves(out, &self.times, &curves.collect::<Vec<_>>())
    }
}

impl Difference {
    fn shown(&self, file: usize) -> String {
        self.values[file].map_or("no value".into(), |x| with_unit(x, &self.unit))
    }
}

/// Formatted difference, to four digits.
fn shown_difference(by: Option<f64>, unit: &str) -> String {
    let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
    by.map_or("-".into(), |by| format!("{}{unit}", rounded(by, 4)))
}

/// True if two mechanisms have the same bodies and outputs in the same order, so that one drawing can show both.
pub fn are_alike(both: [SolvedModel<'_>; 2]) -> bool {
    let bodies = both.map(|s| s.file.model.bodies.iter().map(|b| &b.name).collect::<Vec<_>>());
    let outputs =
        both.map(|s| s.solution.measured.outputs.iter().map(|o| (&o.name, o.dimension)).collect::<Vec<_>>());
    bodies[0] == bodies[1] && outputs[0] == outputs[1]
}

fn hardpoints(a: &Model, b: &Model, units: Units) -> Vec<Difference> {
    let named = a.hardpoints.iter().filter(|h| !h.unnamed);
    let pairs = named.filter_map(|h| {
        let other = b.hardpoints.iter().find(|o| !o.unnamed && o.name == h.name)?;
        Some((h, other))
    });
    let coordinates = pairs.flat_map(|(h, other)| {
        [("x", 0), ("y", 1), ("z", 2)]
            .map(|(axis, k)| (format!("{}.{axis}", h.name), h.position[k], other.position[k]))
    });
    let differ = coordinates.filter(|(_, x, y)| (x - y).abs() > SAME_PLACE);
    differ
        .map(|(name, x, y)| Difference {
            name,
            unit: unit(units, Dimension::LENGTH),
            values: [x, y].map(|v| Some(units.from_si(Dimension::LENGTH, v))),
        })
        .collect()
}

fn parameters(a: &Model, b: &Model, units: Units) -> Vec<Difference> {
    let pairs = a.parameters.iter().filter_map(|p| {
        let other = b.parameters.iter().find(|o| o.name == p.name && o.quantity == p.quantity)?;
        (other.value != p.value).then_some((p, other))
    });
    pairs
        .map(|(p, other)| Difference {
            name: p.name.clone(),
            unit: unit(units, p.quantity),
            values: [p.value, other.value].map(|v| Some(units.from_si(p.quantity, v))),
        })
        .collect()
}

fn curves([a, b]: [SolvedModel<'_>; 2], units: Units, steps: usize) -> Vec<CurveDifference> {
    let outputs = |s: &SolvedModel<'_>| s.solution.measured.outputs.clone();
    let theirs = outputs(&b);
    let round_off = RoundOff::new(&a.file.model, Magnitude::of_motion(&a.file.model, &a.solution.motion));
    let compare = |(m, output): (usize, &hardpoint::measure::Output)| {
        let other = theirs.iter().position(|o| o.name == output.name && o.dimension == output.dimension)?;
        let shown = |x: f64| units.from_si(output.dimension, x);
        let curve = |s: &SolvedModel<'_>, m: usize| -> Vec<f64> {
            (0..steps).map(|k| shown(s.solution.measured.value(k, m)[0])).collect()
        };
        let both = [curve(&a, m), curve(&b, other)];
        let least = shown(round_off.value(output.dimension, 0));
        let differences = both[0].iter().zip(&both[1]).map(|(x, y)| settled(y - x, least)).enumerate();
        let largest =
            differences.filter(|(_, d)| d.is_finite()).max_by(|x, y| x.1.abs().total_cmp(&y.1.abs()));
        Some(CurveDifference {
            measure: output.name.clone(),
            unit: unit(units, output.dimension),
            difference: largest.map(|(_, d)| d),
            time: largest.filter(|(_, d)| *d != 0.0).map(|(k, _)| a.solution.motion.times[k]),
            curves: both,
        })
    };
    outputs(&a).iter().enumerate().filter_map(compare).collect()
}

fn of_metrics([a, b]: [SolvedModel<'_>; 2], units: Units) -> Vec<Difference> {
    let [first, second] = [a, b].map(|s| metrics(&s.file.model, s.solution));
    let compare = |(k, metric): (usize, &hardpoint::model::Metric)| {
        let (model, others) = (&a.file.model, &b.file.model);
        let dimension = model.metric_dimension(metric);
        let other = others.metrics.iter().position(|m| m.name == metric.name)?;
        (others.metric_dimension(&others.metrics[other]) == dimension).then(|| Difference {
            name: metric.name.clone(),
            unit: unit(units, dimension),
            values: [first[k].value, second[other].value].map(|v| v.map(|x| units.from_si(dimension, x))),
        })
    };
    a.file.model.metrics.iter().enumerate().filter_map(compare).collect()
}

/// Names of entries of a model that another one lacks.
fn only_in(model: &Model, other: &Model) -> Vec<String> {
    let names = |m: &Model| -> BTreeSet<(&'static str, String)> {
        let hardpoints = m.hardpoints.iter().filter(|h| !h.unnamed).map(|h| ("hardpoint", h.name.clone()));
        let bodies = m.bodies.iter().map(|b| ("body", b.name.clone()));
        let joints = m.joints.iter().filter(|j| !j.unnamed).map(|j| ("joint", j.name.clone()));
        let drivers = m.drivers.iter().map(|d| ("driver", d.name.clone()));
        let measures = m.measures.iter().map(|x| ("measure", x.name.clone()));
        let metrics = m.metrics.iter().map(|x| ("metric", x.name.clone()));
        hardpoints.chain(bodies).chain(joints).chain(drivers).chain(measures).chain(metrics).collect()
    };
    let (own, theirs) = (names(model), names(other));
    own.difference(&theirs).map(|(what, name)| format!("{what} {name}")).collect()
}
