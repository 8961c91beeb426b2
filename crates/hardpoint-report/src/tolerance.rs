//! Result of a tolerance study: spread, yield, contributions and allocated tolerances, in the model's units.

use std::io::Write;

use hardpoint::measure::Output;
use hardpoint::model::{AllocationRule, Dimension, LimitTarget, Model, OutputSource, ToleranceSettings};
use hardpoint_file::{Diagnostic, ModelFile, Units};
use hardpoint_study::tolerance::{
    Allocation, AllocationError, BandPoint, CurveBands, Extreme, MetricSpread, MonteCarlo, NONLINEAR,
    SampledCurve, SampledMetric, SideChange, SpreadModel, ToleranceResult, Yield,
};
use hardpoint_study::{EvaluationError, Motions};
use hardpoint_table::csv::CsvWriter;
use serde::Serializer;

use crate::diagnose;
use crate::figures::{count, number, rounded, some_of, unit, variable_unit, with_unit};
use crate::page::{Curve, Design, DesignCurves, DesignKind, Payload, Table};
use crate::record::{Column, record, write_rows};
use crate::study::{BeforeAfter, Evaluations, FailureFact, bar, case_name, percent, titled};

/// Half width of a band in standard deviations: 99.73 % of a normal distribution.
const BAND: f64 = 3.0;

/// Edge of the bands on the page, or a curve between edges.
struct Edge {
    name: &'static str,
    note: &'static str,
    /// Value at an output time, SI; NaN where there is none.
    of: fn(&CurveBands, usize) -> f64,
}

const MOST_PRODUCTS: &str =
    "Range of 99.73 % of all products, if they are normally distributed: from first and second derivatives.";
const WORST_CASE: &str = "Extreme over all products within the tolerances.";
/// Curves of a band, those of the standard deviation first.
const EDGES: [Edge; 5] = [
    Edge { name: "mean - 3 sigma", note: MOST_PRODUCTS, of: |c, k| deviated(c, k, -BAND) },
    Edge { name: "mean + 3 sigma", note: MOST_PRODUCTS, of: |c, k| deviated(c, k, BAND) },
    Edge { name: "worst-case minimum", note: WORST_CASE, of: |c, k| c.bands[k].worst[0] },
    Edge { name: "worst-case maximum", note: WORST_CASE, of: |c, k| c.bands[k].worst[1] },
    Edge {
        name: "loaded",
        note: "Every pin with play is on the side to which the loads press it, to first order.",
        of: |c, k| c.bands[k].loaded.unwrap_or(f64::NAN),
    },
];

/// Mean plus a multiple of the standard deviation.
fn deviated(curve: &CurveBands, k: usize, by: f64) -> f64 {
    let [mean, sigma] = curve.moments(k);
    mean + by * sigma
}

/// Contributions below this fraction are not listed.
const SLIGHT: f64 = 1e-3;
/// Bands below this fraction of the curve's largest value are round-off.
const NO_BAND: f64 = 1e-13;
/// Number of bars in a histogram.
const BARS: usize = 24;

record! {
    /// Result of a tolerance study, in the model's units. Serialised as `summary.json` of `hardpoint tolerance`.
    pub ToleranceFacts::of(studied: &ToleranceInputs<'_>) {
        let ToleranceInputs { file, asked, found, .. } = *studied;
        let part = |of: &MonteCarlo| of.all.map(Yield::part);
        let loose = found.allocation.as_ref().and_then(|a| a.sampled.as_ref());
        let failures = found.sampled.iter().flat_map(|s| &s.failures);
        let failures = failures.map(|f| FailureFact::of(studied.case(f.motion), &f.why, f.first, f.count));
        let samples = found.sampled.as_ref().map_or(0, |s| s.samples);
        let metrics: Vec<SpreadFact> = (0..found.metrics.len()).map(|k| SpreadFact::of(studied, k)).collect();
        let inaccurate = metrics.iter().filter_map(|m| Some(format!("`{}` ({})", m.titled(), m.nonlinear.as_ref()?)));
        let inaccurate: Vec<String> = inaccurate.collect();
        let instead = match samples >= SampledMetric::FEWEST {
            true => "use the sampled designs",
            false => "sample designs with `samples`",
        };
        let (linear, accuracy) = match inaccurate.is_empty() {
            true => {
                let less = percent(NONLINEAR);
                ("complete", format!("the linear result is accurate: second derivatives add less than {less}"))
            }
            false => {
                let which = some_of(&inaccurate, ", ");
                ("nonlinear", format!("the linear result is inaccurate for {which}: {instead}"))
            }
        };
        let (status, message) = match found.interrupted {
            true => ("interrupted", format!("interrupted after {samples} of {} designs; {accuracy}", asked.samples)),
            false => (linear, accuracy),
        };
    }
    /// Program and version.
    generator: String = crate::GENERATOR.into();
    /// Kind of study.
    study: &'static str = "tolerance";
    /// Name of the model.
    model: String = file.model.name.clone();
    /// Name of the model file.
    file: String = file.file_name().into();
    /// Status: `complete`, `interrupted`, or `nonlinear` if second derivatives show that the linear result is
    /// inaccurate.
    status: &'static str = status;
    /// Status in words, with an instruction.
    message: String = message;
    /// Yield of all limits, 0 to 1: with the original and with the allocated tolerances.
    objective: BeforeAfter = BeforeAfter {
        before: found.sampled.as_ref().and_then(part),
        after: loose.or(found.sampled.as_ref()).and_then(part),
    };
    /// Cost of the study.
    evaluations: Evaluations = Evaluations::of(found.cost);
    /// Number of sampled designs.
    samples: usize = samples;
    /// Random seed.
    seed: u64 = asked.seed;
    /// Toleranced variables.
    variables: Vec<ToleratedFact> = (0..found.variables.len()).map(|k| ToleratedFact::of(studied, k)).collect();
    /// Toleranced variables that the mechanism cannot follow.
    left_out: Vec<String> = found.left_out.iter().map(|v| file.model.variables[v.0].name.clone()).collect();
    /// Spread per metric and case.
    metrics: Vec<SpreadFact> = metrics;
    /// Metrics without a nominal value.
    unknown: Vec<String> = found.unknown.iter().map(|(m, _)| file.model.metrics[*m].name.clone()).collect();
    /// Widest bands along the curves.
    bands: Vec<BandFact> = found.curves.iter().filter_map(|c| BandFact::of_curve(studied, c)).collect();
    /// Pins with play that change sides under the loads of the nominal motions.
    side_changes: Vec<SideChangeFact> =
        found.side_changes.iter().map(|of| SideChangeFact::of(studied, of)).collect();
    /// Yield per limit and case.
    limits: Vec<YieldFact> = (0..found.limits.len()).map(|k| YieldFact::of(studied, k)).collect();
    /// Number of sampled designs that do not reach the end of a motion.
    failed: usize = found.sampled.as_ref().map_or(0, |s| s.failed);
    /// Failed designs, grouped by cause.
    failures: Vec<FailureFact> = failures.collect();
    /// Allocated tolerances, if requested.
    allocation: Option<AllocationFact> = found.allocation.as_ref().map(|a| AllocationFact::of(studied, a));
    /// Written files.
    files: Vec<String> = Vec::new();
    /// Duration, s.
    seconds: f64 = 0.0;
}

/// Source of the worst case of a band.
fn worst_case(band: &BandPoint) -> &'static str {
    match (band.solved, band.second) {
        (true, _) => "solved",
        (false, Some(_)) => "second order",
        (false, None) => "first order",
    }
}

record! {
    /// Widest band of a measure in one motion.
    BandFact::of(studied: &ToleranceInputs<'_>, curve: &CurveBands, k: usize, by_sigma: usize) {
        let (model, units) = (studied.model(), studied.units());
        let dimension = model.dimension(OutputSource::Measure(curve.measure));
        let largest = curve.bands.iter().map(|b| b.nominal.abs()).fold(0.0, f64::max);
        let shown = |x: f64| if x <= NO_BAND * largest { 0.0 } else { units.from_si(dimension, x) };
    }
    /// Name of the measure.
    measure: String = model.measures[curve.measure].name.clone();
    /// Name of the case; `null` if the model has no cases.
    case: Option<String> = studied.case(curve.motion);
    /// Unit.
    unit: String = unit(units, dimension);
    /// Greatest half width of the worst case.
    worst: f64 = shown(0.5 * (curve.bands[k].worst[1] - curve.bands[k].worst[0]));
    /// Time of it, s.
    at: f64 = curve.times[k];
    /// Greatest standard deviation.
    sigma: f64 = shown(curve.bands[by_sigma].sigma);
    /// Time of it, s.
    sigma_at: f64 = curve.times[by_sigma];
}

impl BandFact {
    /// Table of the widest bands along curves, if there are any.
    fn table(bands: &[Self]) -> Option<Table> {
        let columns: [Column<'_, &Self>; 5] = [
            ("measure", &|b| titled(&b.measure, &b.case)),
            ("worst case", &|b| format!("±{}", with_unit(b.worst, &b.unit))),
            ("at t", &|b| format!("{} s", number(b.at))),
            ("RSS", &|b| with_unit(b.sigma, &b.unit)),
            ("at t", &|b| format!("{} s", number(b.sigma_at))),
        ];
        let note = "The widest of each curve, to first order; all are in bands.csv.";
        Table::of("Bands along curves", note, &columns, bands).if_any()
    }

    fn of_curve(studied: &ToleranceInputs<'_>, curve: &CurveBands) -> Option<Self> {
        let widest = |width: &dyn Fn(usize) -> f64| {
            let known = (0..curve.bands.len()).filter(|k| width(*k).is_finite());
            known.max_by(|a, b| width(*a).total_cmp(&width(*b)))
        };
        let worst = widest(&|k| curve.bands[k].worst[1] - curve.bands[k].worst[0])?;
        let sigma = widest(&|k| curve.bands[k].sigma)?;
        Some(Self::of(studied, curve, worst, sigma))
    }
}

record! {
    /// Pin with play that changes sides under load.
    SideChangeFact::of(studied: &ToleranceInputs<'_>, of: &SideChange) {}
    /// Name of the joint.
    joint: String = studied.model().joints[of.joint.0].name.clone();
    /// Name of the case; `null` if the model has no cases.
    case: Option<String> = studied.case(of.motion);
    /// Times at which the force reverses, s.
    times: Vec<f64> = of.times.clone();
}

record! {
    /// Toleranced variable.
    ToleratedFact::of(studied: &ToleranceInputs<'_>, k: usize) {
        let (model, of) = (studied.model(), studied.found.variables[k]);
        let (variable, tolerance) = (&model.variables[of.variable.0], &studied.asked.tolerances[of.tolerance]);
        let shown = |x: f64| studied.units().from_si(variable.quantity, x);
        let found = studied.found.allocation.as_ref().filter(|a| a.error.is_none());
        let sought = found.and_then(|a| a.tolerances.iter().find(|t| t.tolerance == of.tolerance));
    }
    /// Name.
    name: String = variable.name.clone();
    /// Tolerance that it belongs to: its own name, or that of a point.
    tolerance: String = tolerance.name.clone();
    /// Unit.
    unit: String = variable_unit(model, studied.units(), variable);
    /// Distribution: `uniform`, `normal` or `truncated`.
    distribution: &'static str = tolerance.scatter.name();
    /// Original tolerance (reach of the deviation).
    start: f64 = shown(tolerance.reach);
    /// Allocated tolerance; the original one if none were allocated; `null` if no limit constrains it.
    end: Option<f64> = sought.map_or(Some(tolerance.reach), |t| t.after).map(shown);
    /// Standard deviation of the deviation.
    sigma: f64 = shown(of.sigma);
    /// Relative cost of its tolerance: `cost` over the tolerance in this unit.
    cost: Option<f64> = tolerance.cost.map(shown);
}

record! {
    /// Metric in one motion.
    SpreadFact::of(studied: &ToleranceInputs<'_>, k: usize) {
        let (of, dimension) = (&studied.found.metrics[k], studied.dimension(&studied.found.metrics[k]));
        let units = studied.units();
        let shown = |x: f64| units.from_si(dimension, x);
        let found = studied.found;
        let drawn = found.sampled.as_ref().map(|s| &s.metrics[k]).filter(|drawn| drawn.known > 1);
        let model_shares = &found.contributions[k];
        let mut why = Vec::new();
        if found.is_nonlinear(k) {
            match of.nonlinearity() {
                _ if of.sigma.is_nan() => why.push("it has no derivatives".to_owned()),
                None => why.push("second derivatives are unknown".into()),
                Some(part) if part.is_infinite() => why.push("sigma has no first-order part".into()),
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
        let mut contributions: Vec<Contribution> = (0..of.d.len()).map(|v| Contribution::of(studied, k, v)).collect();
        contributions.sort_by(|a, b| b.share.abs().total_cmp(&a.share.abs()));
    }
    /// Name.
    name: String = studied.model().metrics[of.metric].name.clone();
    /// Name of the case; `null` if the model has no cases.
    case: Option<String> = studied.case(of.motion);
    /// Unit.
    unit: String = unit(units, dimension);
    /// Nominal value.
    nominal: f64 = shown(of.nominal);
    /// Second-order mean.
    mean: Option<f64> = of.second.map(|_| shown(of.mean()));
    /// First-order standard deviation: root sum square.
    rss: f64 = shown(of.sigma);
    /// Second-order standard deviation.
    sigma: Option<f64> = of.second.map(|s| shown(s.sigma));
    /// Second-order part relative to the first-order standard deviation; `null` if it is unknown, or that is zero.
    nonlinearity: Option<f64> = of.nonlinearity().filter(|x| x.is_finite());
    /// Worst-case minimum.
    least: ExtremeFact = ExtremeFact::of(&of.worst[0], &shown);
    /// Worst-case maximum.
    greatest: ExtremeFact = ExtremeFact::of(&of.worst[1], &shown);
    /// Model of the spread and the contributions: `linear`, `second_order` or `drawn`.
    #[serde(serialize_with = "as_word")]
    told_by: SpreadModel = model_shares.model;
    /// Reason why linear statistics are inaccurate; `null` if they are valid.
    nonlinear: Option<String> = (!why.is_empty()).then(|| why.join(", "));
    /// Contributions of the variables to the variance, the largest first.
    contributions: Vec<Contribution> = contributions;
    /// Fraction due to interactions of several variables; `null` if it is distributed among them.
    together: Option<f64> = model_shares.together;
    /// Monte Carlo statistics.
    sampled: Option<SampledFact> = drawn.map(|drawn| SampledFact::of(of, drawn, &shown));
}

record! {
    /// Worst-case minimum or maximum.
    ExtremeFact::of(e: &Extreme, shown: &dyn Fn(f64) -> f64) {}
    /// First-order value.
    first: f64 = shown(e.first);
    /// Second-order value.
    second: Option<f64> = e.second.map(shown);
    /// Exact value, with the deviations of the second-order worst case.
    exact: Option<f64> = e.exact.map(shown);
    /// Reason why the exact value is missing.
    why: Option<String> = e.why.clone();
}

record! {
    /// Contribution of a variable to a variance.
    Contribution::of(studied: &ToleranceInputs<'_>, k: usize, v: usize) {
        let (of, model_shares) = (&studied.found.metrics[k], &studied.found.contributions[k]);
        let (units, dimension) = (studied.units(), studied.dimension(of));
        let quantity = studied.model().variables[studied.found.variables[v].variable.0].quantity;
    }
    /// Name.
    variable: String = studied.variable_name(v).to_owned();
    /// Fraction of the variance; may be negative for correlated variables.
    share: f64 = model_shares.shares[v];
    /// Derivative of the metric by the variable, in its unit per the variable's.
    d: f64 = units.from_si(dimension, of.d[v]) / units.from_si(quantity, 1.0);
}

record! {
    /// Statistics of a metric over the sampled designs.
    SampledFact::of(of: &MetricSpread, drawn: &SampledMetric, shown: &dyn Fn(f64) -> f64) {
        let off = of.sigma - drawn.sigma[0];
        let differs = drawn.differs_from(of.sigma);
    }
    /// Number of designs with a value.
    known: usize = drawn.known;
    /// Mean value.
    mean: f64 = shown(drawn.mean[0]);
    /// Standard error of the mean.
    mean_error: f64 = shown(drawn.mean[1]);
    /// Standard deviation.
    sigma: f64 = shown(drawn.sigma[0]);
    /// Standard error of `sigma`.
    sigma_error: f64 = shown(drawn.sigma[1]);
    /// Skewness: 0 for a normal distribution.
    skewness: f64 = drawn.skewness;
    /// Kurtosis: 3 for a normal distribution.
    kurtosis: f64 = drawn.kurtosis;
    /// Minimum, 0.135 % quantile, median, 99.865 % quantile, maximum.
    quantiles: [f64; 5] = drawn.quantiles.map(shown);
    /// Relative error of the first-order standard deviation; `null` if it is less than three standard errors.
    rss_off: Option<f64> = differs.then(|| off / drawn.sigma[0]);
}

record! {
    /// Limit in one motion.
    YieldFact::of(studied: &ToleranceInputs<'_>, k: usize) {
        let found = &studied.found.limits[k];
        let limit = &studied.asked.limits[found.limit];
        let of = &studied.found.metrics[found.spread];
        assert_eq!(limit.of, LimitTarget::Metric(of.metric));
        let (units, dimension) = (studied.units(), studied.dimension(of));
        let shown = |x: f64| units.from_si(dimension, x);
        let worth = studied.found.allocation.as_ref().filter(|a| a.error.is_none()).map(|a| a.worth[k]);
    }
    /// Name.
    name: String = limit.name.clone();
    /// Metric of the limit.
    metric: String = studied.model().metrics[of.metric].name.clone();
    /// Name of the case; `null` if the model has no cases.
    case: Option<String> = studied.case(of.motion);
    /// Unit.
    unit: String = unit(units, dimension);
    /// Lower end.
    min: Option<f64> = limit.least.map(shown);
    /// Upper end.
    max: Option<f64> = limit.most.map(shown);
    /// Yield of a normal distribution with the moments from derivatives, 0 to 1; `null` if there are no derivatives.
    by_moments: Option<f64> = found.by_moments;
    /// Yield of the sampled designs, 0 to 1.
    sampled: Option<f64> = found.sampled.map(Yield::part);
    /// Standard error of `sampled`.
    error: Option<f64> = found.sampled.map(Yield::error);
    /// Lagrange multiplier in an allocation: the cost saved if the limit were relaxed by one unit.
    worth: Option<f64> = worth.map(|w| w / shown(1.0));
}

record! {
    /// Allocated tolerances.
    AllocationFact::of(studied: &ToleranceInputs<'_>, found: &Allocation) {
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
            Some(AllocationError::NoDerivatives(k)) => {
                format!("the metric of limit `{}` has no derivatives: leave out the limit", name(k))
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
    }
    /// Rule: `rss` or `worst_case`.
    rule: &'static str = rule;
    /// Number of standard deviations that have to fit between the limits.
    sigmas: Option<f64> = sigmas;
    /// Status: `found`, or the reason why there are none.
    status: String = status;
    /// Sum of `cost / tolerance` over all tolerances with a cost, in the file's units.
    cost: BeforeAfter = BeforeAfter {
        before: Some(found.cost[0]),
        after: found.error.is_none().then_some(found.cost[1]),
    };
    /// Residual of the optimality (KKT) conditions.
    kkt: Option<f64> = Some(found.residual).filter(|r| r.is_finite());
    /// Yield of designs sampled from these tolerances, 0 to 1.
    sampled: Option<f64> = all.map(Yield::part);
    /// Standard error of `sampled`.
    error: Option<f64> = all.map(Yield::error);
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
    let mut diagnostic = diagnose::stop_of_nominal(&of_motion, &stopped.stop);
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
        let text = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
        let columns: [Column<'_, SpreadFact>; 14] = [
            ("metric", &|m| m.name.clone()),
            ("case", &|m| m.case.clone().unwrap_or_default()),
            ("unit", &|m| m.unit.clone()),
            ("nominal", &|m| m.nominal.to_string()),
            ("rss", &|m| m.rss.to_string()),
            ("mean", &|m| text(m.mean)),
            ("sigma", &|m| text(m.sigma)),
            ("nonlinearity", &|m| text(m.nonlinearity)),
            ("least", &|m| m.least.best_derived().to_string()),
            ("greatest", &|m| m.greatest.best_derived().to_string()),
            ("least_exact", &|m| text(m.least.exact)),
            ("greatest_exact", &|m| text(m.greatest.exact)),
            ("drawn_mean", &|m| text(m.sampled.as_ref().map(|s| s.mean))),
            ("drawn_sigma", &|m| text(m.sampled.as_ref().map(|s| s.sigma))),
        ];
        write_rows(out, &columns, ToleranceFacts::of(self).metrics)
    }

    /// Writes `contributions.csv`: a row for each metric, motion and variable.
    pub fn write_contributions(&self, out: impl Write) -> csv::Result<()> {
        let facts = ToleranceFacts::of(self);
        let rows = facts.metrics.iter().flat_map(|m| m.contributions.iter().map(move |c| (m, c)));
        let columns: [Column<'_, (&SpreadFact, &Contribution)>; 5] = [
            ("metric", &|(m, _)| m.name.clone()),
            ("case", &|(m, _)| m.case.clone().unwrap_or_default()),
            ("variable", &|(_, c)| c.variable.clone()),
            ("share", &|(_, c)| c.share.to_string()),
            ("derivative", &|(_, c)| c.d.to_string()),
        ];
        write_rows(out, &columns, rows)
    }

    /// Writes `bands.csv`: a row for each measure, motion and output time.
    pub fn write_bands(&self, out: impl Write) -> csv::Result<()> {
        /// A band, with its curve, their numbers, and the scale of the measure's values.
        struct Row<'a> {
            curve: &'a CurveBands,
            c: usize,
            k: usize,
            dimension: Dimension,
        }
        let shown = |r: &Row<'_>, x: f64| {
            if x.is_nan() { String::new() } else { self.units().from_si(r.dimension, x).to_string() }
        };
        let moment = |r: &Row<'_>, k: usize| shown(r, r.curve.moments(r.k)[k]);
        let drawn = |r: &Row<'_>, list: fn(&SampledCurve) -> &Vec<f64>| {
            let sampled = self.found.sampled.as_ref();
            sampled.map_or(String::new(), |s| shown(r, list(&s.curves[r.c])[r.k]))
        };
        let loaded = |r: &Row<'_>| r.curve.bands[r.k].loaded.map_or(String::new(), |x| shown(r, x));
        let columns: [Column<'_, Row<'_>>; 16] = [
            ("measure", &|r| self.model().measures[r.curve.measure].name.clone()),
            ("case", &|r| self.case(r.curve.motion).unwrap_or_default()),
            ("unit", &|r| unit(self.units(), r.dimension)),
            ("time", &|r| r.curve.times[r.k].to_string()),
            ("nominal", &|r| shown(r, r.curve.bands[r.k].nominal)),
            ("rss", &|r| shown(r, r.curve.bands[r.k].sigma)),
            ("mean", &|r| moment(r, 0)),
            ("sigma", &|r| moment(r, 1)),
            ("least", &|r| shown(r, r.curve.bands[r.k].worst[0])),
            ("greatest", &|r| shown(r, r.curve.bands[r.k].worst[1])),
            ("worst_case", &|r| worst_case(&r.curve.bands[r.k]).to_owned()),
            ("loaded", &loaded),
            ("drawn_mean", &|r| drawn(r, |c| &c.mean)),
            ("drawn_sigma", &|r| drawn(r, |c| &c.sigma)),
            ("drawn_least", &|r| drawn(r, |c| &c.least)),
            ("drawn_greatest", &|r| drawn(r, |c| &c.greatest)),
        ];
        let rows = self.found.curves.iter().enumerate().flat_map(|(c, curve)| {
            let dimension = self.model().dimension(OutputSource::Measure(curve.measure));
            (0..curve.bands.len()).map(move |k| Row { curve, c, k, dimension })
        });
        write_rows(out, &columns, rows)
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

    /// Turns the page of a motion into that of the study: with bands along the curves, and a tab for the result.
    pub fn page(
        &self,
        facts: &ToleranceFacts,
        motion: usize,
        mut page: Payload,
        outputs: &[Output],
    ) -> Payload {
        let of_limit = self.found.limits.iter().map(|l| l.spread).chain(0..self.found.metrics.len());
        let first = of_limit.map(|s| &self.found.metrics[s]).find(|m| m.motion == motion);
        page.open_on(first.map(|m| &self.model().metrics[m.metric]), outputs);
        let designs: Vec<Design> = EDGES.iter().map(|edge| self.band(motion, edge, &page, outputs)).collect();
        page.designs.extend(designs.into_iter().filter(|d| d.quantities.iter().any(Option::is_some)));
        page.covariance_root = Some(self.covariance_root());
        let tables = facts.tables().into_iter().chain(self.histograms(motion));
        page.put_study("Tolerances", facts.rows(), &["result", "yield", "failed"], tables);
        page
    }

    /// Square root of the covariance matrix of all variables, in their units.
    fn covariance_root(&self) -> Vec<Vec<f64>> {
        let variables = &self.model().variables;
        let mut root = vec![vec![0.0; self.found.variables.len()]; variables.len()];
        for (toleranced, row) in
            self.found.variables.iter().zip(self.found.covariance_root(self.model(), self.asked))
        {
            let of = toleranced.variable.0;
            root[of] = row.iter().map(|x| self.units().from_si(variables[of].quantity, *x)).collect();
        }
        root
    }

    /// Edge of the bands of a motion, as the curves of a design.
    fn band(&self, motion: usize, edge: &Edge, page: &Payload, outputs: &[Output]) -> Design {
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
            let value = |t: &f32| {
                let si = nearest(*t).map_or(f64::NAN, |k| (edge.of)(curve, k));
                self.units().from_si(dimension, si)
            };
            let value: Curve = page.times.values().iter().map(value).collect();
            if value.values().iter().all(|x| x.is_nan()) {
                continue;
            }
            quantities[q] = Some(DesignCurves { value, rate: Curve::default(), accel: Curve::default() });
        }
        Design {
            name: edge.name.into(),
            kind: DesignKind::Band,
            change: vec![0.0; page.variables.len()],
            note: edge.note.into(),
            poses: Vec::new(),
            skeletons: Vec::new(),
            loads: Vec::new(),
            quantities,
            values: vec![None; page.values.len()],
            margin: None,
            clearance: None,
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
        let middle = |k: usize| units.from_si(dimension, least + (k as f64 + 0.5) * width);
        let histogram = Table::of(
            format!("Histogram of {}", self.model().metrics[of.metric].name),
            format!("Of {} designs sampled from the tolerances.", drawn.known),
            &[
                ("about", &|r: &(usize, &usize)| with_unit(middle(r.0), &unit(units, dimension))),
                ("designs", &|r| r.1.to_string()),
                ("", &|r| bar(*r.1 as f64 / most)),
            ],
            counts.iter().enumerate(),
        );
        Some(histogram)
    }
}

/// Yield with its standard error.
fn yield_text(part: f64, error: f64) -> String {
    format!("{} ± {}", percent(part), percent(error))
}

impl ToleranceFacts {
    /// Facts of the result, line by line.
    pub fn rows(&self) -> Vec<(&'static str, String)> {
        let mut rows = vec![("result", self.message.clone())];
        if let Some(part) = self.objective.before {
            let error = standard_error(part, self.samples);
            rows.push(("yield", format!("{} keep all limits", yield_text(part, error))));
        }
        if self.samples > 0 {
            let fewest = SampledMetric::FEWEST;
            let remark = match self.samples < fewest {
                true => format!("; too few to check sigma, which takes at least {fewest}"),
                false => String::new(),
            };
            rows.push(("sampled", format!("{}, seed {}{remark}", count(self.samples, "design"), self.seed)));
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
        for pin in &self.side_changes {
            let times = pin.times.iter().map(|t| number(*t)).collect::<Vec<_>>();
            let case = pin.case.as_ref().map_or(String::new(), |case| format!(" in `{case}`"));
            rows.push((
                "pin",
                format!("`{}`{case} changes sides at t = {} s", pin.joint, some_of(&times, ", ")),
            ));
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
        let spread = [
            SpreadFact::table(&self.metrics),
            BandFact::table(&self.bands),
            SampledFact::table(&self.metrics, self.failed > 0),
        ];
        let contributions = self.metrics.iter().map(SpreadFact::contributions_table);
        let limits = YieldFact::table(&self.limits);
        let mut tables: Vec<Table> =
            spread.into_iter().chain(contributions).chain([limits]).flatten().collect();
        tables.push(ToleratedFact::table(&self.variables, self.allocation.is_some()));
        tables.extend(FailureFact::table(&self.failures, ""));
        tables
    }
}

/// Value with its unit, or a dash if it is not known.
fn optional(x: Option<f64>, unit: &str) -> String {
    x.map_or("-".into(), |x| with_unit(x, unit))
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
    /// Table of the spread of metrics, if there are any.
    fn table(metrics: &[Self]) -> Option<Table> {
        let columns: [Column<'_, &Self>; 11] = [
            ("metric", &|m| m.titled()),
            ("nominal", &|m| with_unit(m.nominal, &m.unit)),
            ("mean", &|m| optional(m.best_moments()[0], &m.unit)),
            ("sigma", &|m| optional(m.best_moments()[1], &m.unit)),
            ("from", &|m| word_of(m.told_by).replace('_', " ")),
            ("RSS", &|m| with_unit(m.rss, &m.unit)),
            ("2nd order", &|m| optional(m.sigma, &m.unit)),
            ("RSS error", &|m| m.sampled.as_ref().and_then(|s| s.rss_off).map_or("-".into(), percent)),
            ("nonlinearity", &|m| match (m.nonlinearity, m.sigma) {
                (Some(part), _) => percent(part),
                (None, Some(_)) => "no RSS".into(),
                (None, None) => "not known".into(),
            }),
            ("minimum", &|m| m.least.cell(&m.unit)),
            ("maximum", &|m| m.greatest.cell(&m.unit)),
        ];
        let note = "Mean and standard deviation (sigma) are of the sampled designs where the linear result is \
                    inaccurate. RSS is the root sum square. Worst case: with every deviation at its most unfavourable \
                    value.";
        Table::of("Metrics", note, &columns, metrics).if_any()
    }

    /// Table of the contributions of variables to the variance, if there are any.
    fn contributions_table(&self) -> Option<Table> {
        let listed = self.contributions.iter().filter(|c| c.share.abs() >= SLIGHT);
        let together = self.together.filter(|part| *part >= SLIGHT).map(|part| ("interactions", part));
        let note = match self.told_by {
            SpreadModel::Linear => "",
            SpreadModel::SecondOrder => "From first and second derivatives.",
            SpreadModel::Sampled => {
                "From the sampled designs: the variance of the mean at given deviations of each variable."
            }
        };
        let columns: [Column<'_, (&str, f64)>; 3] =
            [("variable", &|c| c.0.to_owned()), ("of the variance", &|c| percent(c.1)), ("", &|c| bar(c.1))];
        let rows = listed.map(|c| (c.variable.as_str(), c.share)).chain(together);
        Table::of(format!("Contributions to {}", self.titled()), note, &columns, rows).if_any()
    }

    /// Mean and standard deviation by the model of the spread.
    fn best_moments(&self) -> [Option<f64>; 2] {
        match (self.told_by, &self.sampled) {
            (SpreadModel::Sampled, Some(s)) => [Some(s.mean), Some(s.sigma)],
            (SpreadModel::SecondOrder, _) => [self.mean, self.sigma],
            // Without derivatives neither is known.
            (SpreadModel::Linear | SpreadModel::Sampled, _) if self.rss.is_nan() => [None; 2],
            (SpreadModel::Linear | SpreadModel::Sampled, _) => {
                [self.mean.or(Some(self.nominal)), Some(self.rss)]
            }
        }
    }

    fn titled(&self) -> String {
        titled(&self.name, &self.case)
    }
}

impl SampledFact {
    /// Table of the moments and quantiles of the sampled metrics, if there are any.
    fn table(metrics: &[SpreadFact], has_failures: bool) -> Option<Table> {
        let quantile = |(m, s): &(&SpreadFact, &Self), k: usize| with_unit(s.quantiles[k], &m.unit);
        let columns: [Column<'_, (&SpreadFact, &Self)>; 10] = [
            ("metric", &|(m, _)| m.titled()),
            ("mean", &|(m, s)| with_unit(s.mean, &m.unit)),
            ("sigma", &|(m, s)| with_unit(s.sigma, &m.unit)),
            ("skewness", &|(_, s)| rounded(s.skewness, 3)),
            ("kurtosis", &|(_, s)| rounded(s.kurtosis, 3)),
            ("minimum", &|r| quantile(r, 0)),
            ("0.135 %", &|r| quantile(r, 1)),
            ("median", &|r| quantile(r, 2)),
            ("99.865 %", &|r| quantile(r, 3)),
            ("maximum", &|r| quantile(r, 4)),
        ];
        let few = if has_failures { " Failed designs are not included." } else { "" };
        let note = format!(
            "Skewness is 0 and kurtosis 3 of a normal distribution; 99.73 % of the designs are between the quantiles \
             0.135 % and 99.865 %.{few}"
        );
        let sampled = metrics.iter().filter_map(|m| Some((m, m.sampled.as_ref()?)));
        Table::of("Sampled designs", note, &columns, sampled).if_any()
    }
}

impl ToleratedFact {
    /// Table of the variables with their tolerances, and the loosest ones if they are allocated.
    fn table(variables: &[Self], is_allocated: bool) -> Table {
        let columns: [Column<'_, &Self>; 7] = [
            ("variable", &|v| v.name.clone()),
            ("point", &|v| if v.tolerance == v.name { String::new() } else { v.tolerance.clone() }),
            ("tolerance", &|v| format!("±{}", with_unit(v.start, &v.unit))),
            ("distribution", &|v| v.distribution.to_owned()),
            ("sigma", &|v| with_unit(v.sigma, &v.unit)),
            ("cost", &|v| v.cost.map_or(String::new(), number)),
            ("loosest", &|v| match v.end {
                _ if !is_allocated => String::new(),
                None => "any".into(),
                Some(end) => format!("±{}", with_unit(end, &v.unit)),
            }),
        ];
        Table::of("Variables", "", &columns, variables).without_empty_columns()
    }
}

impl ExtremeFact {
    /// Value in a cell of a table.
    fn cell(&self, unit: &str) -> String {
        match &self.why {
            Some(_) => "does not move".into(),
            None => with_unit(self.exact.unwrap_or(self.best_derived()), unit),
        }
    }

    /// Value from derivatives: second-order if it is known.
    fn best_derived(&self) -> f64 {
        self.second.unwrap_or(self.first)
    }
}

impl YieldFact {
    /// Table of the yields of limits, if there are any.
    fn table(limits: &[Self]) -> Option<Table> {
        let columns: [Column<'_, &Self>; 5] = [
            ("limit", &|l| l.titled()),
            ("at least", &|l| optional(l.min, &l.unit)),
            ("at most", &|l| optional(l.max, &l.unit)),
            ("sampled", &|l| l.sampled.zip(l.error).map_or("-".into(), |(p, e)| yield_text(p, e))),
            ("by moments", &|l| l.by_moments.map_or("-".into(), percent)),
        ];
        let note = "Yield: fraction of the sampled designs, and of a normal distribution with the moments.";
        Table::of("Limits", note, &columns, limits).if_any()
    }

    fn titled(&self) -> String {
        titled(&self.name, &self.case)
    }
}

/// Standard error of a fraction of a number of designs.
fn standard_error(part: f64, of: usize) -> f64 {
    Yield { kept: (part * of as f64).round() as usize, of }.error()
}
