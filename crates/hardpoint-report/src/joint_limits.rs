//! Limits of joints over a motion: facts, sentences and a table.

use hardpoint::Analysis;
use hardpoint::draft::Section;
use hardpoint::model::{Dimension, JointLimit, LimitEnd, Model, OutputSource};
use hardpoint::run::{LimitCrossing, LimitExtremum, LimitRange};
use hardpoint::topology::Formulation;
use hardpoint_file::{Diagnostic, ModelFile, Severity, Units};

use crate::clearance::{ClearanceSensitivity, drivers, sensitivities};
use crate::figures::{number, rounded, unit, with_unit};
use crate::page::Table;
use crate::record::{Column, record};

/// Digits of values and times in sentences.
const DIGITS: usize = 7;

record! {
    /// Least or greatest value of a limited coordinate.
    LimitExtremumFact::of(model: &Model, units: Units, of: Dimension, margin: Option<f64>, found: &LimitExtremum) {}
    /// Value.
    value: f64 = units.from_si(of, found.value);
    /// Distance from the end of the range, negative beyond it; `null` where the range has no end.
    margin: Option<f64> = margin.map(|x| units.from_si(of, x));
    /// Time, s.
    time: f64 = found.time;
    /// Values of the drivers there, in words.
    drivers: String = drivers(model, units, found.time);
    /// Derivatives of the value by the design variables, the strongest first; empty where the motion ends early at a
    /// time without known derivatives.
    sensitivities: Vec<ClearanceSensitivity> = sensitivities(model, units, of, &found.d);
}

record! {
    /// Time at which a limit is reached, or at which the value returns into its range.
    LimitCrossingFact::of(model: &Model, units: Units, found: &LimitCrossing) {}
    /// Time, s.
    time: f64 = found.time;
    /// Values of the drivers there, in words.
    drivers: String = drivers(model, units, found.time);
    /// End of the range: `min` or `max`.
    end: &'static str = match found.end {
        LimitEnd::Min => "min",
        LimitEnd::Max => "max",
    };
    /// True if the value leaves its range there, false if it returns.
    leaves: bool = found.leaves;
    /// Derivatives of the time by the design variables, the strongest first; empty at a grazing crossing.
    sensitivities: Vec<ClearanceSensitivity> =
        sensitivities(model, units, Dimension::NUMBER.rate(-1), &found.d);
}

record! {
    /// Limit of a joint over a motion.
    JointLimitFact::of(model: &Model, units: Units, limit: &JointLimit, found: &LimitRange) {
        let of = model.dimension(OutputSource::Measure(limit.measure));
        let shown = |x: f64| units.from_si(of, x);
        let extremum = |end: LimitEnd| {
            let extremum = found.extremum(end);
            let margin = limit.margin(model, end, extremum.value);
            LimitExtremumFact::of(model, units, of, margin, extremum)
        };
        let is_exceeded = |end: LimitEnd| limit.exceeded(model, found.extremum(end).value).is_some();
    }
    /// Name: those of the joint and of its coordinate.
    name: String = limit.name.clone();
    /// Name of the joint.
    joint: String = model.joints[limit.joint.0].name.clone();
    /// Unit of the values.
    unit: String = unit(units, of);
    /// Lower end of the range.
    min: Option<f64> = limit.min.map(shown);
    /// Upper end of the range.
    max: Option<f64> = limit.max.map(shown);
    /// True if the motion ends where the limit is reached.
    stop: bool = limit.stop;
    /// The least value over the motion.
    least: LimitExtremumFact = extremum(LimitEnd::Min);
    /// The greatest value over the motion.
    greatest: LimitExtremumFact = extremum(LimitEnd::Max);
    /// False if the value leaves its range.
    kept: bool = !LimitEnd::ALL.into_iter().any(is_exceeded);
    /// End of the range that the motion begins beyond: `min` or `max`.
    begins_beyond: Option<&'static str> = found.begins_beyond.map(|end| match end {
        LimitEnd::Min => "min",
        LimitEnd::Max => "max",
    });
    /// Times at which the value leaves its range and returns, in order of time.
    crossings: Vec<LimitCrossingFact> =
        found.crossings.iter().map(|c| LimitCrossingFact::of(model, units, c)).collect();
}

/// Noun of an end of a range, by its key.
fn noun(end: &str) -> &'static str {
    if end == "min" { LimitEnd::Min.noun() } else { LimitEnd::Max.noun() }
}

impl JointLimitFact {
    /// All limits of a model over its motion; empty if it has none, or if no output time is solved.
    pub fn all(file: &ModelFile, formulation: Formulation) -> Vec<Self> {
        let model = &file.model;
        if model.joint_limits.is_empty() {
            return Vec::new();
        }
        let Ok(analysis) = Analysis::with(model, formulation) else { return Vec::new() };
        let found = analysis.joint_limits(&[]);
        let of = |(limit, found)| Self::of(model, file.units, limit, found);
        model.joint_limits.iter().zip(&found).map(of).collect()
    }

    /// End of the range by its key.
    fn bound(&self, end: &str) -> String {
        let bound = if end == "min" { self.min } else { self.max };
        with_unit(bound.unwrap_or(f64::NAN), &self.unit)
    }

    /// One sentence for each time at which the value leaves its range: `slide.displacement reaches its maximum of 60 mm
    /// at t = 0.412 s (crank 51.2 deg)`.
    pub fn sentences(&self) -> Vec<String> {
        let at = |time: f64, drivers: &str| {
            let drivers = if drivers.is_empty() { String::new() } else { format!(" ({drivers})") };
            format!("t = {} s{drivers}", rounded(time, DIGITS))
        };
        let begins = self.begins_beyond.map(|end| {
            format!("{} is beyond its {} of {} from the start", self.name, noun(end), self.bound(end))
        });
        let reaches = self.crossings.iter().filter(|c| c.leaves).map(|c| {
            let bound = self.bound(c.end);
            format!("{} reaches its {} of {bound} at {}", self.name, noun(c.end), at(c.time, &c.drivers))
        });
        begins.into_iter().chain(reaches).collect()
    }

    /// Warnings of the limits that are exceeded; those that end the motion are reported by its stop.
    pub(crate) fn warnings(facts: &[Self], file: &ModelFile) -> Vec<Diagnostic> {
        let warn = |(k, fact): (usize, &Self)| {
            let mut sentences = fact.sentences().into_iter();
            let message = sentences.next().filter(|_| !fact.kept && !fact.stop)?;
            let place = Some((Section::JointLimits, k));
            let mut d = file.diagnostic(Severity::Warning, "HP0269", message, place);
            for other in sentences {
                d = d.note(other);
            }
            for (end, extremum) in [("min", &fact.least), ("max", &fact.greatest)] {
                if let Some(by) = extremum.margin.filter(|margin| *margin < 0.0) {
                    d = d.note(format!(
                        "it exceeds its {} by up to {}, at t = {} s",
                        noun(end),
                        with_unit(-by, &fact.unit),
                        rounded(extremum.time, DIGITS)
                    ));
                }
            }
            Some(d.help(
                "shorten the sweep of the drivers, or change the design; with `stop = true` the motion ends there",
            ))
        };
        facts.iter().enumerate().filter_map(warn).collect()
    }

    /// Table of all limits.
    pub fn table(facts: &[Self]) -> Option<Table> {
        let shown = |x: Option<f64>, fact: &Self| x.map_or("-".into(), |x| with_unit(x, &fact.unit));
        let columns: [Column<'_, &Self>; 7] = [
            ("limit", &|f| f.name.clone()),
            ("range over the motion", &|f| {
                format!("{} to {}", number(f.least.value), with_unit(f.greatest.value, &f.unit))
            }),
            ("minimum", &|f| shown(f.min, f)),
            ("margin", &|f| shown(f.least.margin, f)),
            ("maximum", &|f| shown(f.max, f)),
            ("margin", &|f| shown(f.greatest.margin, f)),
            ("reached at t", &|f| {
                let times = f.crossings.iter().filter(|c| c.leaves).map(|c| format!("{} s", number(c.time)));
                let start = f.begins_beyond.map(|_| "the start".to_owned());
                let times: Vec<String> = start.into_iter().chain(times).collect();
                if times.is_empty() { "-".into() } else { times.join(", ") }
            }),
        ];
        let note = "Ranges of coordinates of joints, located exactly; margins are negative beyond a limit.";
        Table::of("Limits of joints", note, &columns, facts).if_any()
    }
}
