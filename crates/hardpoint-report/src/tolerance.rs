//! Result of a tolerance study: spread, yield, contributions and allocated tolerances, in the model's units.

use std::io::Write;

use hardpoint::measure::Output;
use hardpoint::model::{AllocationRule, Dimension, LimitTarget, Model, OutputSource, ToleranceSettings};
use hardpoint_file::{Diagnostic, ModelFile, Units};
use hardpoint_study::tolerance::{
    Allocation, AllocationError, Extreme, MetricSpread, MonteCarlo, NONLINEAR, SampledMetric, SpreadModel,
    ToleranceResult, Yield,
};
use hardpoint_study::{EvaluationError, Motions};
use hardpoint_table::csv::CsvWriter;
use serde::{Serialize, Serializer};

use crate::diagnose;
use crate::figures::variable_unit;
use crate::figures::{count, number, rounded, seconds, some_of, unit, with_unit};
use crate::optimize::{BeforeAfter, Evaluations, case_name};
use crate::page::{Curve, Design, DesignCurves, DesignKind, Fact, Payload, Table};

/// Half width of a band in standard deviations: 99.73 % of a normal distribution.
const BAND: f64 = 3.0;
/// Contributions below this fraction are not listed.
const SLIGHT: f64 = 1e-3;
/// Number of standard errors above which Monte Carlo and derivatives differ.
const ERRORS: f64 = 3.0;
/// Number of marks in a full bar of a table.
const BAR: f64 = 40.0;
/// Number of bars in a histogram.
const BARS: usize = 24;

/// Result of a tolerance study, in the model's units. Serialised as `summary.json` of `hardpoint tolerance`.
#[derive(Clone, Debug, Serialize)]
pub struct ToleranceFacts {
    /// Program and version.
    pub generator: String,
    /// Kind of study.
    pub study: &'static str,
    /// Name of the model.
    pub model: String,
    /// Name of the model file.
    pub file: String,
    /// Status: `complete`, `interrupted`, or `nonlinear` if second derivatives show that the linear result is
    /// inaccurate.
    pub status: &'static str,
    /// Status in words, with an instruction.
    pub message: String,
    /// Yield of all limits, 0 to 1: with the original and with the allocated tolerances.
    pub objective: BeforeAfter,
    /// Cost of the study.
    pub evaluations: Evaluations,
    /// Number of sampled designs.
    pub samples: usize,
    /// Random seed.
    pub seed: u64,
    /// Toleranced variables.
    pub variables: Vec<ToleratedFact>,
    /// Toleranced variables that the mechanism cannot follow.
    pub left_out: Vec<String>,
    /// Spread per metric and case.
    pub metrics: Vec<SpreadFact>,
    /// Metrics without a nominal value.
    pub unknown: Vec<String>,
    /// Yield per limit and case.
    pub limits: Vec<YieldFact>,
    /// Number of sampled designs that do not reach the end of a motion.
    pub failed: usize,
    /// Failed designs, grouped by cause.
    pub failures: Vec<FailureFact>,
    /// Allocated tolerances, if requested.
    pub allocation: Option<AllocationFact>,
    /// Written files.
    pub files: Vec<String>,
    /// Duration, s.
    pub seconds: f64,
}

/// Toleranced variable.
#[derive(Clone, Debug, Serialize)]
pub struct ToleratedFact {
    /// Name.
    pub name: String,
    /// Tolerance that it belongs to: its own name, or that of a point.
    pub tolerance: String,
    /// Unit.
    pub unit: String,
    /// Distribution: `uniform`, `normal` or `truncated`.
    pub distribution: &'static str,
    /// Original tolerance (reach of the deviation).
    pub start: f64,
    /// Allocated tolerance; the original one if none were allocated; `null` if no limit constrains it.
    pub end: Option<f64>,
    /// Standard deviation of the deviation.
    pub sigma: f64,
    /// Relative cost of its tolerance.
    pub cost: Option<f64>,
}

/// Metric in one motion.
#[derive(Clone, Debug, Serialize)]
pub struct SpreadFact {
    /// Name.
    pub name: String,
    /// Name of the case; `null` if the model has no cases.
    pub case: Option<String>,
    /// Unit.
    pub unit: String,
    /// Nominal value.
    pub nominal: f64,
    /// Second-order mean.
    pub mean: Option<f64>,
    /// First-order standard deviation: root sum square.
    pub rss: f64,
    /// Second-order standard deviation.
    pub sigma: Option<f64>,
    /// Second-order part relative to the first-order standard deviation.
    pub nonlinearity: Option<f64>,
    /// Worst-case minimum.
    pub least: ExtremeFact,
    /// Worst-case maximum.
    pub greatest: ExtremeFact,
    /// Model of the spread and the contributions: `linear`, `second_order` or `drawn`.
    #[serde(serialize_with = "as_word")]
    pub told_by: SpreadModel,
    /// Reason why linear statistics are inaccurate; `null` if they are valid.
    pub nonlinear: Option<String>,
    /// Contributions of the variables to the variance, the largest first.
    pub contributions: Vec<Contribution>,
    /// Fraction due to interactions of several variables; `null` if it is distributed among them.
    pub together: Option<f64>,
    /// Monte Carlo statistics.
    pub sampled: Option<SampledFact>,
}

/// Worst-case minimum or maximum.
#[derive(Clone, Debug, Serialize)]
pub struct ExtremeFact {
    /// First-order value.
    pub first: f64,
    /// Second-order value.
    pub second: Option<f64>,
    /// Exact value, with the deviations of the second-order worst case.
    pub exact: Option<f64>,
    /// Reason why the exact value is missing.
    pub why: Option<String>,
}

/// Contribution of a variable to a variance.
#[derive(Clone, Debug, Serialize)]
pub struct Contribution {
    /// Name.
    pub variable: String,
    /// Fraction of the variance; may be negative for correlated variables.
    pub share: f64,
    /// Derivative of the metric by the variable, in its unit per the variable's.
    pub d: f64,
}

/// Statistics of a metric over the sampled designs.
#[derive(Clone, Debug, Serialize)]
pub struct SampledFact {
    /// Number of designs with a value.
    pub known: usize,
    /// Mean value.
    pub mean: f64,
    /// Standard error of the mean.
    pub mean_error: f64,
    /// Standard deviation.
    pub sigma: f64,
    /// Standard error of `sigma`.
    pub sigma_error: f64,
    /// Skewness: 0 for a normal distribution.
    pub skewness: f64,
    /// Kurtosis: 3 for a normal distribution.
    pub kurtosis: f64,
    /// Minimum, 0.135 % quantile, median, 99.865 % quantile, maximum.
    pub quantiles: [f64; 5],
    /// Relative error of the first-order standard deviation; `null` if it is less than three standard errors.
    pub rss_off: Option<f64>,
}

/// Limit in one motion.
#[derive(Clone, Debug, Serialize)]
pub struct YieldFact {
    /// Name.
    pub name: String,
    /// Metric of the limit.
    pub metric: String,
    /// Name of the case; `null` if the model has no cases.
    pub case: Option<String>,
    /// Unit.
    pub unit: String,
    /// Lower end.
    pub min: Option<f64>,
    /// Upper end.
    pub max: Option<f64>,
    /// Yield of a normal distribution with the moments from derivatives, 0 to 1.
    pub by_moments: f64,
    /// Yield of the sampled designs, 0 to 1.
    pub sampled: Option<f64>,
    /// Standard error of `sampled`.
    pub error: Option<f64>,
    /// Lagrange multiplier in an allocation: the cost saved if the limit were relaxed by one unit.
    pub worth: Option<f64>,
}

/// Designs that failed for the same reason.
#[derive(Clone, Debug, Serialize)]
pub struct FailureFact {
    /// Name of the case; `null` if the model has no cases.
    pub case: Option<String>,
    /// Description of the first failure.
    pub why: String,
    /// Number of the first failed design.
    pub first: usize,
    /// Number of failed designs.
    pub count: usize,
}

/// Allocated tolerances.
#[derive(Clone, Debug, Serialize)]
pub struct AllocationFact {
    /// Rule: `rss` or `worst_case`.
    pub rule: &'static str,
    /// Number of standard deviations that have to fit between the limits.
    pub sigmas: Option<f64>,
    /// Status: `found`, or the reason why there are none.
    pub status: String,
    /// Sum of `cost / tolerance` over all tolerances with a cost, in the file's units.
    pub cost: BeforeAfter,
    /// Residual of the optimality (KKT) conditions.
    pub kkt: Option<f64>,
    /// Yield of designs sampled from these tolerances, 0 to 1.
    pub sampled: Option<f64>,
    /// Standard error of `sampled`.
    pub error: Option<f64>,
}

/// Inputs of [`ToleranceFacts`].
#[derive(Clone, Copy, Debug)]
pub struct ToleranceInputs<'a> {
    /// Model file.
    pub file: &'a ModelFile,
    /// Number of each motion among those of the model.
    pub numbers: &'a [usize],
    /// Settings of the study.
    pub asked: &'a ToleranceSettings,
    /// Result of the study.
    pub found: &'a ToleranceResult,
}

/// Diagnostic of a nominal design that does not reach the end of a motion, and the file with the model of that motion.
pub fn nominal_stop(
    file: &ModelFile,
    motions: &Motions<'_>,
    numbers: &[usize],
    stopped: &EvaluationError,
) -> (ModelFile, Diagnostic) {
    let mut of_motion = file.clone();
    of_motion.model = motions.model(stopped.motion).clone();
    let mut diagnostic = diagnose::stop(&of_motion, &stopped.stop, 0, None);
    if let Some(case) = case_name(&file.model, numbers[stopped.motion]) {
        diagnostic.message = format!("case `{case}`: {}", diagnostic.message);
    }
    (of_motion, diagnostic)
}

impl ToleranceInputs<'_> {
    fn model(&self) -> &Model {
        &self.file.model
    }

    fn units(&self) -> Units {
        self.file.units
    }

    fn case(&self, motion: usize) -> Option<String> {
        case_name(self.model(), self.numbers[motion])
    }

    fn dimension(&self, of: &MetricSpread) -> Dimension {
        self.model().metric_dimension(&self.model().metrics[of.metric])
    }

    fn variable_name(&self, k: usize) -> &str {
        &self.model().variables[self.found.variables[k].variable.0].name
    }

    /// Column name of a metric in its motion.
    fn column(&self, of: &MetricSpread) -> String {
        let name = &self.model().metrics[of.metric].name;
        let case = self.case(of.motion).map_or(String::new(), |case| format!("{case}."));
        format!("{case}{name} [{}]", unit(self.units(), self.dimension(of)))
    }

    /// Writes `metrics.csv`: a row for each metric and motion.
    pub fn write_metrics(&self, out: impl Write) -> csv::Result<()> {
        let facts = ToleranceFacts::of(self);
        let mut csv = CsvWriter::new(out);
        csv.row([
            "metric",
            "case",
            "unit",
            "nominal",
            "rss",
            "mean",
            "sigma",
            "nonlinearity",
            "least",
            "greatest",
            "least_exact",
            "greatest_exact",
            "drawn_mean",
            "drawn_sigma",
        ])?;
        for m in &facts.metrics {
            let optional = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
            csv.row([
                m.name.clone(),
                m.case.clone().unwrap_or_default(),
                m.unit.clone(),
                m.nominal.to_string(),
                m.rss.to_string(),
                optional(m.mean),
                optional(m.sigma),
                optional(m.nonlinearity),
                m.least.second.unwrap_or(m.least.first).to_string(),
                m.greatest.second.unwrap_or(m.greatest.first).to_string(),
                optional(m.least.exact),
                optional(m.greatest.exact),
                optional(m.sampled.as_ref().map(|s| s.mean)),
                optional(m.sampled.as_ref().map(|s| s.sigma)),
            ])?;
        }
        csv.end()?;
        Ok(())
    }

    /// Writes `contributions.csv`: a row for each metric, motion and variable.
    pub fn write_contributions(&self, out: impl Write) -> csv::Result<()> {
        let facts = ToleranceFacts::of(self);
        let mut csv = CsvWriter::new(out);
        csv.row(["metric", "case", "variable", "share", "derivative"])?;
        for m in &facts.metrics {
            for c in &m.contributions {
                let case = m.case.clone().unwrap_or_default();
                csv.row([&m.name, &case, &c.variable, &c.share.to_string(), &c.d.to_string()])?;
            }
        }
        csv.end()?;
        Ok(())
    }

    /// Writes `bands.csv`: a row for each measure, motion and output time.
    pub fn write_bands(&self, out: impl Write) -> csv::Result<()> {
        let mut csv = CsvWriter::new(out);
        csv.row([
            "measure",
            "case",
            "unit",
            "time",
            "nominal",
            "rss",
            "mean",
            "sigma",
            "least",
            "greatest",
            "drawn_mean",
            "drawn_sigma",
            "drawn_least",
            "drawn_greatest",
        ])?;
        for (c, curve) in self.found.curves.iter().enumerate() {
            let of = OutputSource::Measure(curve.measure);
            let dimension = self.model().dimension(of);
            let shown = |x: f64| self.units().from_si(dimension, x);
            let drawn = self.found.sampled.as_ref().map(|s| &s.curves[c]);
            for (k, band) in curve.bands.iter().enumerate() {
                let [mean, sigma] = curve.moments(k);
                let mut row = vec![
                    self.model().measures[curve.measure].name.clone(),
                    self.case(curve.motion).unwrap_or_default(),
                    unit(self.units(), dimension),
                    curve.times[k].to_string(),
                ];
                let numbers = [band.nominal, band.sigma, mean, sigma, band.worst[0], band.worst[1]];
                row.extend(numbers.map(|x| shown(x).to_string()));
                let of = |list: Option<&Vec<f64>>| list.map_or(String::new(), |l| shown(l[k]).to_string());
                row.extend([
                    of(drawn.map(|d| &d.mean)),
                    of(drawn.map(|d| &d.sigma)),
                    of(drawn.map(|d| &d.least)),
                    of(drawn.map(|d| &d.greatest)),
                ]);
                csv.row(row)?;
            }
        }
        csv.end()?;
        Ok(())
    }

    /// Writes `samples.csv`: a row for each sampled design, with its deviations and its metrics; empty without samples.
    pub fn write_samples(&self, deviations: impl Fn(usize) -> Vec<f64>, out: impl Write) -> csv::Result<()> {
        let Some(sampled) = &self.found.sampled else { return Ok(()) };
        let mut csv = CsvWriter::new(out);
        let variables = self.found.variables.iter().map(|v| &self.model().variables[v.variable.0]);
        let mut header = vec!["number".to_owned()];
        header.extend(
            variables
                .clone()
                .map(|v| format!("{} [{}]", v.name, variable_unit(self.model(), self.units(), v))),
        );
        header.extend(self.found.metrics.iter().map(|m| self.column(m)));
        csv.row(&header)?;
        for k in 0..sampled.samples {
            let mut row = vec![k.to_string()];
            let of = variables.clone().zip(deviations(k));
            row.extend(of.map(|(v, d)| self.units().from_si(v.quantity, d).to_string()));
            for (m, drawn) in self.found.metrics.iter().zip(&sampled.metrics) {
                let value = Some(drawn.values[k]).filter(|x| x.is_finite());
                let shown = |x: f64| self.units().from_si(self.dimension(m), x).to_string();
                row.push(value.map_or(String::new(), shown));
            }
            csv.row(&row)?;
        }
        csv.end()?;
        Ok(())
    }

    /// Turns the page of a motion into that of the study: its bands are shown along the curves, and the result comes
    /// first among the checks.
    pub fn page(
        &self,
        facts: &ToleranceFacts,
        motion: usize,
        mut page: Payload,
        outputs: &[Output],
    ) -> Payload {
        let place = |of: OutputSource| outputs.iter().position(|o| o.source == of);
        let of_limit = self.found.limits.iter().map(|l| l.spread).chain(0..self.found.metrics.len());
        let first = of_limit.map(|s| &self.found.metrics[s]).find(|m| m.motion == motion);
        if let Some(metric) = first.map(|m| &self.model().metrics[m.metric]) {
            page.first = place(metric.of).or(page.first);
            page.over = metric.over.and_then(place);
        }
        let designs: Vec<Design> = [(-BAND, "mean - 3 sigma"), (BAND, "mean + 3 sigma")]
            .map(|(by, name)| self.band(motion, by, name, &page, outputs))
            .into_iter()
            .collect();
        page.designs.extend(designs.into_iter().filter(|d| d.quantities.iter().any(Option::is_some)));
        if page.designs.iter().any(|d| d.kind == DesignKind::Band) {
            // Bands are computed at fixed times, so the abscissa is time.
            page.over = None;
        }
        let cards = facts.rows().into_iter().filter(|(what, _)| ["yield", "failed"].contains(what));
        page.summary.splice(0..0, cards.map(|(what, is)| Fact { label: what.into(), value: is }));
        let rows = facts.rows().into_iter().map(|(what, is)| vec![what.into(), is]).collect();
        let result =
            Table { title: "Tolerances".into(), note: String::new(), header: header(&["", "is"]), rows };
        let mut checks = vec![result];
        checks.extend(facts.tables());
        checks.extend(self.histograms(motion));
        checks.append(&mut page.checks);
        Payload { checks, ..page }
    }

    /// Edge of the bands of a motion, as the curves of a design.
    fn band(&self, motion: usize, by: f64, name: &str, page: &Payload, outputs: &[Output]) -> Design {
        let mut quantities: Vec<Option<DesignCurves>> = page.quantities.iter().map(|_| None).collect();
        for curve in self.found.curves.iter().filter(|c| c.motion == motion) {
            let source = OutputSource::Measure(curve.measure);
            let Some(q) = outputs.iter().position(|o| o.source == source).filter(|q| *q < quantities.len())
            else {
                continue;
            };
            let dimension = self.model().dimension(source);
            // The page may have fewer output times.
            let nearest = |t: f32| {
                let off = |k: &usize| (curve.times[*k] as f32 - t).abs();
                (0..curve.times.len()).min_by(|a, b| off(a).total_cmp(&off(b)))
            };
            let edge = |t: &f32| {
                let [mean, sigma] = nearest(*t).map_or([f64::NAN; 2], |k| curve.moments(k));
                self.units().from_si(dimension, mean + by * sigma)
            };
            let value: Curve = page.times.values().iter().map(edge).collect();
            quantities[q] = Some(DesignCurves { value, rate: Curve::default(), accel: Curve::default() });
        }
        Design {
            name: name.into(),
            kind: DesignKind::Band,
            change: vec![0.0; page.variables.len()],
            note: "Range of 99.73 % of all products, if they are normally distributed: from first and second derivatives."
                .into(),
            poses: Vec::new(),
            skeletons: Vec::new(),
            loads: Vec::new(),
            quantities,
            values: vec![None; page.values.len()],
            margin: None,
        }
    }

    /// Histograms of the metrics of a motion over the Monte Carlo designs.
    fn histograms(&self, motion: usize) -> Vec<Table> {
        let Some(sampled) = &self.found.sampled else { return Vec::new() };
        let of_motion = self.found.metrics.iter().zip(&sampled.metrics).filter(|(m, _)| m.motion == motion);
        of_motion.filter_map(|(m, drawn)| self.histogram(m, drawn)).collect()
    }

    fn histogram(&self, of: &MetricSpread, drawn: &SampledMetric) -> Option<Table> {
        let [least, .., greatest] = drawn.quantiles;
        let width = (greatest - least) / BARS as f64;
        if !(width > 0.0) {
            return None;
        }
        let mut counts = [0_usize; BARS];
        for x in drawn.values.iter().filter(|x| x.is_finite()) {
            counts[usize::min(((x - least) / width) as usize, BARS - 1)] += 1;
        }
        let most = counts.iter().copied().max().unwrap_or(1) as f64;
        let (units, dimension) = (self.units(), self.dimension(of));
        let row = |(k, n): (usize, &usize)| {
            let middle = units.from_si(dimension, least + (k as f64 + 0.5) * width);
            vec![with_unit(middle, &unit(units, dimension)), n.to_string(), bar(*n as f64 / most)]
        };
        Some(Table {
            title: format!("Histogram of {}", self.model().metrics[of.metric].name),
            note: format!("Of {} designs sampled from the tolerances.", drawn.known),
            header: header(&["about", "designs", ""]),
            rows: counts.iter().enumerate().map(row).collect(),
        })
    }
}

pub(crate) fn header(names: &[&str]) -> Vec<String> {
    names.iter().map(|n| (*n).to_owned()).collect()
}

/// Bar of a table as text, with a length proportional to a fraction.
pub(crate) fn bar(part: f64) -> String {
    "▇".repeat((BAR * part.clamp(0.0, 1.0)).round() as usize)
}

/// Fraction as a percentage.
pub(crate) fn percent(part: f64) -> String {
    format!("{} %", rounded(100.0 * part, 4))
}

/// Yield with its standard error.
fn yield_text(part: f64, error: f64) -> String {
    format!("{} ± {}", percent(part), percent(error))
}

impl ToleranceFacts {
    /// Collects the facts of a tolerance study.
    pub fn of(studied: &ToleranceInputs<'_>) -> Self {
        let ToleranceInputs { file, asked, found, .. } = *studied;
        let part = |of: &MonteCarlo| of.all.map(Yield::part);
        let loose = found.allocation.as_ref().and_then(|a| a.sampled.as_ref());
        let mut facts = Self {
            generator: crate::GENERATOR.into(),
            study: "tolerance",
            model: file.model.name.clone(),
            file: file.file_name().into(),
            status: "complete",
            message: String::new(),
            objective: BeforeAfter {
                before: found.sampled.as_ref().and_then(part),
                after: loose.or(found.sampled.as_ref()).and_then(part),
            },
            evaluations: Evaluations {
                designs: found.cost.designs,
                motions: found.cost.motions,
                steps: found.cost.steps,
            },
            samples: found.sampled.as_ref().map_or(0, |s| s.samples),
            seed: asked.seed,
            variables: (0..found.variables.len()).map(|k| tolerated(studied, k)).collect(),
            left_out: found.left_out.iter().map(|v| file.model.variables[v.0].name.clone()).collect(),
            metrics: (0..found.metrics.len()).map(|k| spread(studied, k)).collect(),
            unknown: found.unknown.iter().map(|(m, _)| file.model.metrics[*m].name.clone()).collect(),
            limits: (0..found.limits.len()).map(|k| limit(studied, k)).collect(),
            failed: found.sampled.as_ref().map_or(0, |s| s.failed),
            failures: found.sampled.as_ref().map_or(Vec::new(), |s| failures(studied, s)),
            allocation: found.allocation.as_ref().map(|a| allocation(studied, a)),
            files: Vec::new(),
            seconds: 0.0,
        };
        let nonlinear: Vec<String> = facts
            .metrics
            .iter()
            .filter_map(|m| Some(format!("`{}` ({})", m.titled(), m.nonlinear.as_ref()?)))
            .collect();
        let instead =
            if facts.samples > 0 { "use the sampled designs" } else { "sample designs with `samples`" };
        facts.message = if nonlinear.is_empty() {
            format!("the linear result is accurate: second derivatives add less than {}", percent(NONLINEAR))
        } else {
            format!("the linear result is inaccurate for {}: {instead}", some_of(&nonlinear, ", "))
        };
        if !nonlinear.is_empty() {
            facts.status = "nonlinear";
        }
        if found.interrupted {
            facts.status = "interrupted";
            facts.message = format!(
                "interrupted after {} of {} designs; {}",
                facts.samples, asked.samples, facts.message
            );
        }
        facts
    }

    /// Facts of the result, line by line.
    pub fn rows(&self) -> Vec<(&'static str, String)> {
        let mut rows = vec![("result", self.message.clone())];
        if let Some(part) = self.objective.before {
            let error = standard_error(part, self.samples);
            rows.push(("yield", format!("{} keep all limits", yield_text(part, error))));
        }
        if self.samples > 0 {
            rows.push(("sampled", format!("{}, seed {}", count(self.samples, "design"), self.seed)));
        }
        if self.failed > 0 {
            let part = percent(self.failed as f64 / self.samples as f64);
            rows.push(("failed", format!("{} do not reach the end of the motion ({part})", self.failed)));
        }
        let ends = |m: &SpreadFact| {
            [("least", &m.least), ("greatest", &m.greatest)]
                .into_iter()
                .filter_map(|(end, e)| Some(format!("{end} `{}`: {}", m.titled(), e.why.as_ref()?)))
                .collect::<Vec<_>>()
        };
        let stopped: Vec<String> = self.metrics.iter().flat_map(ends).collect();
        if !stopped.is_empty() {
            rows.push(("worst case", format!("does not move: {}", some_of(&stopped, "; "))));
        }
        if !self.left_out.is_empty() {
            let names = some_of(&self.left_out, ", ");
            rows.push(("left out", format!("{names}: the mechanism cannot follow")));
        }
        if !self.unknown.is_empty() {
            rows.push((
                "no value",
                format!("{}: not reached in the design configuration", some_of(&self.unknown, ", ")),
            ));
        }
        if let Some(a) = &self.allocation {
            let kept = a.sampled.zip(a.error).map_or(String::new(), |(p, e)| {
                format!("; {} of designs sampled from them keep all limits", yield_text(p, e))
            });
            let cost = match (a.cost.before, a.cost.after) {
                (Some(before), Some(after)) => {
                    format!(", at {} of the cost", percent(after / before))
                }
                _ => String::new(),
            };
            rows.push(("loosest", format!("{}{cost}{kept}", a.status)));
        }
        let Evaluations { designs, motions, .. } = self.evaluations;
        rows.push(("evaluated", format!("{}, {}", count(designs, "design"), count(motions, "motion"))));
        rows
    }

    /// Further tables: metrics, contributions, limits, tolerances, failures.
    pub fn tables(&self) -> Vec<Table> {
        let optional = |x: Option<f64>, unit: &str| x.map_or("-".into(), |x| with_unit(x, unit));
        let metric = |m: &SpreadFact| {
            let off = m.sampled.as_ref().and_then(|s| s.rss_off).map_or("-".into(), percent);
            let worst = |e: &ExtremeFact| match &e.why {
                Some(_) => "does not move".into(),
                None => optional(e.exact.or(e.second).or(Some(e.first)), &m.unit),
            };
            let [mean, sigma] = m.best_moments();
            vec![
                m.titled(),
                with_unit(m.nominal, &m.unit),
                optional(mean, &m.unit),
                optional(sigma, &m.unit),
                word_of(m.told_by).replace('_', " "),
                with_unit(m.rss, &m.unit),
                optional(m.sigma, &m.unit),
                off,
                m.nonlinearity.map_or("not known".into(), percent),
                worst(&m.least),
                worst(&m.greatest),
            ]
        };
        let mut tables = vec![Table {
            title: "Metrics".into(),
            note: "Mean and standard deviation (sigma) are of the sampled designs where the linear result is inaccurate. RSS is the root sum \
                square. Worst case: with every deviation at its most unfavourable value."
                .into(),
            header: header(&[
                "metric", "nominal", "mean", "sigma", "from", "RSS", "2nd order", "RSS error", "nonlinearity", "minimum", "maximum",
            ]),
            rows: self.metrics.iter().map(metric).collect(),
        }];
        let drawn = |m: &SpreadFact| {
            let s = m.sampled.as_ref()?;
            let mut row = vec![m.titled(), with_unit(s.mean, &m.unit), with_unit(s.sigma, &m.unit)];
            row.extend([rounded(s.skewness, 3), rounded(s.kurtosis, 3)]);
            row.extend(s.quantiles.map(|x| with_unit(x, &m.unit)));
            Some(row)
        };
        let rows: Vec<Vec<String>> = self.metrics.iter().filter_map(drawn).collect();
        if !rows.is_empty() {
            let few = if self.failed > 0 { " Failed designs are not included." } else { "" };
            tables.push(Table {
                title: "Sampled designs".into(),
                note: format!(
                    "Skewness is 0 and kurtosis 3 of a normal distribution; 99.73 % of the designs are between the quantiles 0.135 % and \
                     99.865 %.{few}"
                ),
                header: header(&[
                    "metric", "mean", "sigma", "skewness", "kurtosis", "minimum", "0.135 %", "median", "99.865 %", "maximum",
                ]),
                rows,
            });
        }
        for m in &self.metrics {
            let listed = m.contributions.iter().filter(|c| c.share.abs() >= SLIGHT);
            let mut rows: Vec<Vec<String>> =
                listed.map(|c| vec![c.variable.clone(), percent(c.share), bar(c.share)]).collect();
            if let Some(part) = m.together.filter(|part| *part >= SLIGHT) {
                rows.push(vec!["interactions".into(), percent(part), bar(part)]);
            }
            if !rows.is_empty() {
                let note = match m.told_by {
                    SpreadModel::Linear => "",
                    SpreadModel::SecondOrder => "From first and second derivatives.",
                    SpreadModel::Sampled => {
                        "From the sampled designs: the variance of the mean at given deviations of each variable."
                    }
                };
                tables.push(Table {
                    title: format!("Contributions to {}", m.titled()),
                    note: note.into(),
                    header: header(&["variable", "of the variance", ""]),
                    rows,
                });
            }
        }
        if !self.limits.is_empty() {
            let row = |l: &YieldFact| {
                vec![
                    l.titled(),
                    optional(l.min, &l.unit),
                    optional(l.max, &l.unit),
                    l.sampled.zip(l.error).map_or("-".into(), |(p, e)| yield_text(p, e)),
                    percent(l.by_moments),
                ]
            };
            tables.push(Table {
                title: "Limits".into(),
                note:
                    "Yield: fraction of the sampled designs, and of a normal distribution with the moments."
                        .into(),
                header: header(&["limit", "at least", "at most", "sampled", "by moments"]),
                rows: self.limits.iter().map(row).collect(),
            });
        }
        let row = |v: &ToleratedFact| {
            let end = if self.allocation.is_some() {
                v.end.map_or("any".into(), |x| format!("±{}", with_unit(x, &v.unit)))
            } else {
                String::new()
            };
            vec![
                v.name.clone(),
                if v.tolerance == v.name { String::new() } else { v.tolerance.clone() },
                format!("±{}", with_unit(v.start, &v.unit)),
                v.distribution.to_owned(),
                with_unit(v.sigma, &v.unit),
                v.cost.map_or(String::new(), number),
                end,
            ]
        };
        let tolerances = Table {
            title: "Variables".into(),
            note: String::new(),
            header: header(&["variable", "point", "tolerance", "distribution", "sigma", "cost", "loosest"]),
            rows: self.variables.iter().map(row).collect(),
        };
        tables.push(tolerances.without_empty_columns());
        if !self.failures.is_empty() {
            let row = |f: &FailureFact| {
                vec![
                    f.case.clone().unwrap_or_default(),
                    f.why.clone(),
                    f.count.to_string(),
                    f.first.to_string(),
                ]
            };
            let failures = Table {
                title: "Failed designs".into(),
                note: String::new(),
                header: header(&["case", "first failure", "designs", "first"]),
                rows: self.failures.iter().map(row).collect(),
            };
            tables.push(failures.without_empty_columns());
        }
        tables
    }

    /// Line about the duration.
    pub fn time_line(&self) -> String {
        seconds(self.seconds)
    }
}

/// Word for a model of the spread, in JSON and tables.
fn word_of(model: SpreadModel) -> &'static str {
    match model {
        SpreadModel::Linear => "linear",
        SpreadModel::SecondOrder => "second_order",
        SpreadModel::Sampled => "drawn",
    }
}

fn as_word<S: Serializer>(model: &SpreadModel, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(word_of(*model))
}

impl SpreadFact {
    /// Mean and standard deviation by the model of the spread.
    fn best_moments(&self) -> [Option<f64>; 2] {
        match (self.told_by, &self.sampled) {
            (SpreadModel::Sampled, Some(s)) => [Some(s.mean), Some(s.sigma)],
            (SpreadModel::SecondOrder, _) => [self.mean, self.sigma],
            (SpreadModel::Linear | SpreadModel::Sampled, _) => {
                [self.mean.or(Some(self.nominal)), Some(self.rss)]
            }
        }
    }

    fn titled(&self) -> String {
        titled(&self.name, &self.case)
    }
}

impl YieldFact {
    fn titled(&self) -> String {
        titled(&self.name, &self.case)
    }
}

pub(crate) fn titled(name: &str, case: &Option<String>) -> String {
    case.as_ref().map_or(name.to_owned(), |case| format!("{name} ({case})"))
}

/// Standard error of a fraction of a number of designs.
fn standard_error(part: f64, of: usize) -> f64 {
    Yield { kept: (part * of as f64).round() as usize, of }.error()
}

fn tolerated(studied: &ToleranceInputs<'_>, k: usize) -> ToleratedFact {
    let (model, of) = (studied.model(), studied.found.variables[k]);
    let (variable, tolerance) = (&model.variables[of.variable.0], &studied.asked.tolerances[of.tolerance]);
    let shown = |x: f64| studied.units().from_si(variable.quantity, x);
    let found = studied.found.allocation.as_ref().filter(|a| a.error.is_none());
    let sought = found.and_then(|a| a.tolerances.iter().find(|t| t.tolerance == of.tolerance));
    ToleratedFact {
        name: variable.name.clone(),
        tolerance: tolerance.name.clone(),
        unit: variable_unit(model, studied.units(), variable),
        distribution: tolerance.scatter.name(),
        start: shown(tolerance.reach),
        end: sought.map_or(Some(tolerance.reach), |t| t.after).map(shown),
        sigma: shown(of.sigma),
        cost: tolerance.cost,
    }
}

fn spread(studied: &ToleranceInputs<'_>, k: usize) -> SpreadFact {
    let (of, dimension) = (&studied.found.metrics[k], studied.dimension(&studied.found.metrics[k]));
    let units = studied.units();
    let shown = |x: f64| units.from_si(dimension, x);
    let extreme = |e: &Extreme| ExtremeFact {
        first: shown(e.first),
        second: e.second.map(shown),
        exact: e.exact.map(shown),
        why: e.why.clone(),
    };
    let found = studied.found;
    let model_shares = &found.contributions[k];
    let mut why = Vec::new();
    if found.is_nonlinear(k) {
        match of.nonlinearity().filter(|x| x.is_finite()) {
            None => why.push("second derivatives are unknown".to_owned()),
            Some(part) if part > NONLINEAR => {
                why.push(format!("the second-order part is {} of sigma", percent(part)))
            }
            Some(_) => (),
        }
        if found.differs_from_samples(k) {
            why.push("sigma of the sampled designs differs".into());
        }
        if found.fails_often() {
            why.push("some designs do not reach the end".into());
        }
    }
    let contribution = |v: usize| {
        let quantity = studied.model().variables[studied.found.variables[v].variable.0].quantity;
        Contribution {
            variable: studied.variable_name(v).to_owned(),
            share: model_shares.shares[v],
            d: shown(of.d[v]) / units.from_si(quantity, 1.0),
        }
    };
    let mut contributions: Vec<Contribution> = (0..of.d.len()).map(contribution).collect();
    contributions.sort_by(|a, b| b.share.abs().total_cmp(&a.share.abs()));
    let sampled = |s: &MonteCarlo| {
        let drawn = &s.metrics[k];
        let off = of.sigma - drawn.sigma[0];
        let differs = off.abs() > ERRORS * drawn.sigma[1];
        (drawn.known > 1).then(|| SampledFact {
            known: drawn.known,
            mean: shown(drawn.mean[0]),
            mean_error: shown(drawn.mean[1]),
            sigma: shown(drawn.sigma[0]),
            sigma_error: shown(drawn.sigma[1]),
            skewness: drawn.skewness,
            kurtosis: drawn.kurtosis,
            quantiles: drawn.quantiles.map(shown),
            rss_off: differs.then(|| off / drawn.sigma[0]),
        })
    };
    SpreadFact {
        name: studied.model().metrics[of.metric].name.clone(),
        case: studied.case(of.motion),
        unit: unit(units, dimension),
        nominal: shown(of.nominal),
        mean: of.second.map(|_| shown(of.mean())),
        rss: shown(of.sigma),
        sigma: of.second.map(|s| shown(s.sigma)),
        nonlinearity: of.nonlinearity().filter(|x| x.is_finite()),
        least: extreme(&of.worst[0]),
        greatest: extreme(&of.worst[1]),
        told_by: model_shares.model,
        nonlinear: (!why.is_empty()).then(|| why.join(", ")),
        contributions,
        together: model_shares.together,
        sampled: studied.found.sampled.as_ref().and_then(sampled),
    }
}

fn limit(studied: &ToleranceInputs<'_>, k: usize) -> YieldFact {
    let found = &studied.found.limits[k];
    let limit = &studied.asked.limits[found.limit];
    let of = &studied.found.metrics[found.spread];
    assert_eq!(limit.of, LimitTarget::Metric(of.metric));
    let (units, dimension) = (studied.units(), studied.dimension(of));
    let shown = |x: f64| units.from_si(dimension, x);
    let worth = studied.found.allocation.as_ref().filter(|a| a.error.is_none()).map(|a| a.worth[k]);
    YieldFact {
        name: limit.name.clone(),
        metric: studied.model().metrics[of.metric].name.clone(),
        case: studied.case(of.motion),
        unit: unit(units, dimension),
        min: limit.least.map(shown),
        max: limit.most.map(shown),
        by_moments: found.by_moments,
        sampled: found.sampled.map(Yield::part),
        error: found.sampled.map(Yield::error),
        worth: worth.map(|w| w / shown(1.0)),
    }
}

fn failures(studied: &ToleranceInputs<'_>, sampled: &MonteCarlo) -> Vec<FailureFact> {
    let fact = |f: &hardpoint_study::tolerance::FailureGroup| FailureFact {
        case: studied.case(f.motion),
        why: f.why.clone(),
        first: f.first,
        count: f.count,
    };
    sampled.failures.iter().map(fact).collect()
}

fn allocation(studied: &ToleranceInputs<'_>, found: &Allocation) -> AllocationFact {
    let name = |k: usize| {
        let limit = &studied.asked.limits[studied.found.limits[k].limit];
        titled(&limit.name, &studied.case(studied.found.metrics[studied.found.limits[k].spread].motion))
    };
    let status = match found.error {
        None => "found".to_owned(),
        Some(AllocationError::NoCosts) => "none of the variables that can be followed has a cost".into(),
        Some(AllocationError::NoLimits) => "there is no limit to keep".into(),
        Some(AllocationError::NominalExceeds(k)) => {
            format!("limit `{}` is violated by the nominal design: change the design first", name(k))
        }
        Some(AllocationError::Fixed(k)) => {
            format!("tolerances without a cost exhaust the room of limit `{}`: give them one", name(k))
        }
    };
    let (rule, sigmas) = match found.rule {
        AllocationRule::Rss { sigmas } => (AllocationRule::NAMES[0], Some(sigmas)),
        AllocationRule::Worst => (AllocationRule::NAMES[1], None),
    };
    let all = found.sampled.as_ref().and_then(|s| s.all);
    AllocationFact {
        rule,
        sigmas,
        status,
        cost: BeforeAfter {
            before: Some(found.cost[0]),
            after: found.error.is_none().then_some(found.cost[1]),
        },
        kkt: Some(found.residual).filter(|r| r.is_finite()),
        sampled: all.map(Yield::part),
        error: all.map(Yield::error),
    }
}
