//! Result of a sweep: a table of its designs, and distributions and influences of the metrics, in the model's units.

use std::io;

use hardpoint::measure::Output;
use hardpoint::model::{Dimension, Model, OutputSource, SweepMethod, SweepRange, SweepSettings};
use hardpoint_file::{ModelFile, Units};
use hardpoint_study::sweep::{self, Distribution, SobolIndex, Sweep, rank_correlation, sobol_indices};
use hardpoint_study::{Motions, StudyCost};

use crate::cells::Cells;
use crate::figures::{count, number, unit, variable_unit, with_unit};
use crate::page::{Payload, SweepAxis, SweepIndex, SweepPlot, Table};
use crate::record::{Column, record};
use crate::study::{BeforeAfter, Evaluations, FailureFact, bar, case_name, percent, titled, with_brackets};

/// Maximum number of designs that are plotted and ranked.
pub const MAX_PLOTTED: usize = 5000;

record! {
    /// Result of a sweep, in the model's units. Serialised as `summary.json` of `hardpoint sweep`.
    SweepFacts::of(swept: &SweepInputs<'_>, tally: &Tally, metrics: Vec<SweptFact>) {
        let (file, asked) = (swept.file, swept.asked);
        let first = metrics.first().and_then(|m| m.distribution.as_ref());
        let best = |k: usize| first.map(|d| d.least.variables[k]);
        let count_asked = swept.sweep.plan().count();
        let (status, message) = if tally.designs < count_asked {
            ("interrupted", format!("interrupted after {} of {count_asked} designs", tally.designs))
        } else if tally.failed == tally.designs {
            // The nominal design is solved besides.
            let message = match metrics.iter().all(|m| m.drawn.is_none()) {
                true => {
                    "no design reaches the end of its motion, not even the nominal one: end `[time]` earlier, or correct \
                     the reasons listed below"
                }
                false => "no design reaches the end of its motion: narrow the ranges; the reasons are listed below",
            };
            ("no_design", message.to_owned())
        } else if tally.failed > 0 {
            let solved = tally.designs - tally.failed;
            ("complete", format!("{solved} of {} were solved", count(tally.designs, "design")))
        } else {
            ("complete", format!("all {} were solved", count(tally.designs, "design")))
        };
    }
    /// Program and version.
    generator: String = crate::GENERATOR.into();
    /// Kind of study.
    study: &'static str = "sweep";
    /// Name of the model.
    model: String = file.model.name.clone();
    /// Name of the model file.
    file: String = file.file_name().into();
    /// Status: `complete`, `interrupted`, or `no_design` if no design reaches the end of its motion.
    status: &'static str = status;
    /// Status in words, with an instruction.
    message: String = message;
    /// First metric: nominal value and minimum over the designs.
    objective: BeforeAfter = BeforeAfter {
        before: metrics.first().and_then(|m| m.drawn),
        after: first.map(|d| d.least.value),
    };
    /// Cost of the designs.
    evaluations: Evaluations = Evaluations::of(tally.cost);
    /// Number of solved designs.
    designs: usize = tally.designs;
    /// Number of requested designs.
    asked: usize = count_asked;
    /// Method that chose the designs.
    method: &'static str = asked.method.name();
    /// Random seed; `null` if the method is deterministic.
    seed: Option<u64> = (!matches!(asked.method, SweepMethod::Factorial | SweepMethod::Listed)).then_some(asked.seed);
    /// Swept variables.
    variables: Vec<SweptVariable> = (0..asked.ranges.len()).map(|k| SweptVariable::of(swept, k, best(k))).collect();
    /// Results per metric and case.
    metrics: Vec<SweptFact> = metrics;
    /// Number of designs that do not reach the end of a motion.
    failed: usize = tally.failed;
    /// Failed designs, grouped by cause.
    failures: Vec<FailureFact> = tally.failures.iter().map(|(_, _, fact)| fact.clone()).collect();
    /// Written files.
    files: Vec<String> = Vec::new();
    /// Duration, s.
    seconds: f64 = 0.0;
}

record! {
    /// Swept variable.
    SweptVariable::of(swept: &SweepInputs<'_>, k: usize, best: Option<f64>) {
        let (file, range) = (swept.file, &swept.asked.ranges[k]);
        let variable = &file.model.variables[range.variable.0];
    }
    /// Name.
    name: String = variable.name.clone();
    /// Unit.
    unit: String = variable_unit(&file.model, file.units, variable);
    /// Lower end of the range: the value of a parameter, the change of any other variable.
    from: f64 = file.value_of(range.variable, range.low);
    /// Upper end of the range.
    to: f64 = file.value_of(range.variable, range.high);
    /// Number of levels in a factorial.
    levels: Option<usize> = (swept.asked.method == SweepMethod::Factorial).then_some(range.levels);
    /// Nominal value.
    start: f64 = file.value_of(range.variable, 0.0);
    /// Value in the design with the minimum of the first metric.
    end: Option<f64> = best;
}

record! {
    /// Metric in one motion.
    SweptFact::of(
        swept: &SweepInputs<'_>,
        k: usize,
        nominal: f64,
        known: Option<&Distribution>,
        influences: Vec<InfluenceFact>,
    ) {
        let of = swept.sweep.metrics()[k];
        let dimension = swept.dimension(of);
        let nominal = swept.units().from_si(dimension, nominal);
    }
    /// Name.
    name: String = swept.model().metrics[of.metric].name.clone();
    /// Name of the case; `null` if the model has no cases.
    case: Option<String> = swept.case(of.motion);
    /// Unit.
    unit: String = unit(swept.units(), dimension);
    /// Nominal value.
    drawn: Option<f64> = Some(nominal).filter(|x| x.is_finite());
    /// Number of designs with a value.
    known: usize = known.map_or(0, |d| d.known);
    /// Distribution over these designs.
    distribution: Option<DistributionFact> = known.map(|d| DistributionFact::of(swept, dimension, d));
    /// Influence of each variable.
    influences: Vec<InfluenceFact> = influences;
}

record! {
    /// Distribution of a metric over the designs with a value.
    DistributionFact::of(swept: &SweepInputs<'_>, dimension: Dimension, d: &Distribution) {
        let shown = |x: f64| swept.units().from_si(dimension, x);
    }
    /// Mean value.
    mean: f64 = shown(d.mean);
    /// Standard deviation.
    sigma: f64 = shown(d.sigma);
    /// Quantiles at 5 %, 25 %, 50 %, 75 % and 95 %.
    quantiles: [f64; 5] = d.quantiles.map(shown);
    /// Design with the minimum.
    least: ExtremeDesign = ExtremeDesign::of(swept, d.least.0, shown(d.least.1));
    /// Design with the maximum.
    greatest: ExtremeDesign = ExtremeDesign::of(swept, d.greatest.0, shown(d.greatest.1));
}

record! {
    /// Design with an extreme value of a metric.
    ExtremeDesign::of(swept: &SweepInputs<'_>, design: usize, value: f64) {}
    /// Number of the design.
    design: usize = design;
    /// Value of the metric.
    value: f64 = value;
    /// Values of the variables, in the order of [`SweepFacts::variables`].
    variables: Vec<f64> = swept.variables_of(design);
}

record! {
    /// Influence of a variable on a metric.
    InfluenceFact::of(variable: &str, rank: Option<f64>, index: Option<&SobolIndex>) {}
    /// Name of the variable.
    variable: String = variable.to_owned();
    /// Spearman's rank correlation over the plotted designs: 1 or -1 if the metric always rises or falls with the
    /// variable.
    rank_correlation: Option<f64> = rank;
    /// First-order Sobol index: the part of the variance that vanishes if the variable is known. For
    /// `method = "sobol_indices"`.
    first: Option<f64> = index.map(|i| i.first[0]);
    /// Standard error of `first`.
    first_error: Option<f64> = index.map(|i| i.first[1]);
    /// Total Sobol index: the part of the variance that remains if all other variables are known.
    total: Option<f64> = index.map(|i| i.total[0]);
    /// Standard error of `total`.
    total_error: Option<f64> = index.map(|i| i.total[1]);
    /// Number of pairs of designs used for both.
    pairs: Option<usize> = index.map(|i| i.pairs);
}

/// Inputs of [`SweepFacts`].
#[derive(Clone, Copy)]
pub struct SweepInputs<'a> {
    /// Model file.
    pub file: &'a ModelFile,
    /// Number of each motion among those of the model.
    pub numbers: &'a [usize],
    /// Settings of the sweep.
    pub asked: &'a SweepSettings,
    /// Motions of the sweep.
    pub motions: &'a Motions<'a>,
    /// Designs and columns of the sweep.
    pub sweep: &'a Sweep<'a>,
}

/// Running totals over blocks of designs.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Number of designs so far.
    pub designs: usize,
    /// Number of designs so far that do not reach the end of a motion.
    pub failed: usize,
    cost: StudyCost,
    /// Failures with their reason and motion.
    failures: Vec<(String, usize, FailureFact)>,
}

/// Plotted designs with their variables and metrics.
#[derive(Clone, Debug, Default)]
struct PlottedDesigns {
    numbers: Vec<usize>,
    /// Values of each variable in each design, in the file's units.
    variables: Vec<Vec<f64>>,
    /// Values of each metric in each design.
    metrics: Vec<Vec<f64>>,
}

impl SweepInputs<'_> {
    fn model(&self) -> &Model {
        &self.file.model
    }

    fn units(&self) -> Units {
        self.file.units
    }

    fn case(&self, motion: usize) -> Option<String> {
        case_name(self.model(), self.numbers[motion])
    }

    fn dimension(&self, of: sweep::Metric) -> Dimension {
        self.model().metric_dimension(&self.model().metrics[of.metric])
    }

    /// Swept variables of a design, in the file's units.
    fn variables_of(&self, number: usize) -> Vec<f64> {
        let swept = self.sweep.plan().swept(number);
        self.asked.ranges.iter().zip(swept).map(|(range, x)| self.file.value_of(range.variable, x)).collect()
    }

    fn title(&self, of: sweep::Metric) -> String {
        let name = &self.model().metrics[of.metric].name;
        self.case(of.motion).map_or(name.clone(), |case| format!("{case}.{name}"))
    }

    /// Columns of the table of designs: number, variables, metrics, and the reason of a failure.
    pub fn columns(&self) -> Vec<(String, Cells)> {
        let variable = |range: &SweepRange| {
            let variable = &self.model().variables[range.variable.0];
            with_brackets(&variable.name, &variable_unit(self.model(), self.units(), variable))
        };
        let metric =
            |of: &sweep::Metric| with_brackets(&self.title(*of), &unit(self.units(), self.dimension(*of)));
        let numbers = self.asked.ranges.iter().map(variable).chain(self.sweep.metrics().iter().map(metric));
        let mut columns = vec![("design".to_owned(), Cells::Whole(Vec::new()))];
        columns.extend(numbers.map(|name| (name, Cells::Numbers(Vec::new()))));
        columns.push(("failed".to_owned(), Cells::Texts(Vec::new())));
        columns
    }

    /// Rows of a block of designs.
    pub fn rows(&self, block: &sweep::Block) -> Vec<Cells> {
        let mut variables = vec![Vec::new(); self.asked.ranges.len()];
        for number in block.numbers.clone() {
            variables.iter_mut().zip(self.variables_of(number)).for_each(|(column, x)| column.push(x));
        }
        let metric = |(of, values): (&sweep::Metric, &Vec<f64>)| {
            let dimension = self.dimension(*of);
            values.iter().map(|x| self.units().from_si(dimension, *x)).collect()
        };
        let metrics = self.sweep.metrics().iter().zip(&block.metrics).map(metric);
        let mut failed = vec![String::new(); block.numbers.len()];
        for failure in &block.failures {
            let text = &mut failed[failure.number - block.numbers.start];
            if !text.is_empty() {
                text.push_str("; ");
            }
            if let Some(case) = self.case(failure.motion) {
                text.push_str(&case);
                text.push_str(": ");
            }
            text.push_str(&failure.why);
        }
        let mut rows = vec![Cells::Whole(block.numbers.clone().map(|n| n as i64).collect())];
        rows.extend(variables.into_iter().chain(metrics).map(Cells::Numbers));
        rows.push(Cells::Texts(failed));
        rows
    }

    /// Columns of the table of curves: a row for each design, motion and solved output time.
    pub fn curve_columns(&self) -> Vec<(String, Cells)> {
        let mut columns = vec![("design".to_owned(), Cells::Whole(Vec::new()))];
        if self.case(0).is_some() {
            columns.push(("case".to_owned(), Cells::Texts(Vec::new())));
        }
        columns.push(("time [s]".to_owned(), Cells::Numbers(Vec::new())));
        let curve = |m: &usize| {
            let dimension = self.model().dimension(OutputSource::Measure(*m));
            with_brackets(&self.model().measures[*m].name, &unit(self.units(), dimension))
        };
        columns.extend(self.asked.curves.iter().map(|m| (curve(m), Cells::Numbers(Vec::new()))));
        columns
    }

    /// Rows of the curves of a block of designs.
    pub fn curve_rows(&self, block: &sweep::Block) -> Vec<Cells> {
        let (mut designs, mut cases, mut times) = (Vec::new(), Vec::new(), Vec::new());
        let mut values = vec![Vec::new(); self.asked.curves.len()];
        let of = |m: &usize| self.model().dimension(OutputSource::Measure(*m));
        let dimensions: Vec<Dimension> = self.asked.curves.iter().map(of).collect();
        let mut read = vec![0; block.curves.len()];
        for (k, number) in block.numbers.clone().enumerate() {
            for (motion, curves) in block.curves.iter().enumerate() {
                let case = self.case(motion);
                for step in 0..curves.steps[k] as usize {
                    designs.push(number as i64);
                    cases.extend(case.clone());
                    times.push(self.motions.model(motion).times[step]);
                    for (column, dimension) in values.iter_mut().zip(&dimensions) {
                        column.push(self.units().from_si(*dimension, curves.values[read[motion]]));
                        read[motion] += 1;
                    }
                }
            }
        }
        let mut rows = vec![Cells::Whole(designs)];
        if self.case(0).is_some() {
            rows.push(Cells::Texts(cases));
        }
        rows.push(Cells::Numbers(times));
        rows.extend(values.into_iter().map(Cells::Numbers));
        rows
    }

    /// Adds a block to the totals.
    pub fn tally(&self, tally: &mut Tally, block: &sweep::Block) {
        tally.designs = block.numbers.end;
        tally.cost += block.cost;
        let mut last = None;
        for failure in &block.failures {
            let known = tally.failures.iter_mut();
            match known.into_iter().find(|(reason, m, _)| *reason == failure.reason && *m == failure.motion) {
                Some((_, _, fact)) => {
                    fact.count += 1;
                    // Failures within a block are in the order of motions.
                    fact.first = fact.first.min(failure.number);
                }
                None => {
                    let fact = FailureFact::of(self.case(failure.motion), &failure.why, failure.number, 1);
                    tally.failures.push((failure.reason.clone(), failure.motion, fact));
                }
            }
            last = Some(failure.number);
        }
        if last.is_some() {
            let mut failed: Vec<usize> = block.failures.iter().map(|f| f.number).collect();
            failed.sort_unstable();
            failed.dedup();
            tally.failed += failed.len();
        }
    }

    /// Numbers of the plotted designs: all, or some with a stride that does not coincide with the period of any level
    /// of a factorial.
    fn drawn_numbers(&self, designs: usize) -> Vec<usize> {
        let mut step = designs.div_ceil(MAX_PLOTTED).max(1);
        let repeats = |step: usize| {
            let levels = self
                .asked
                .ranges
                .iter()
                .map(|r| r.levels)
                .filter(|_| self.asked.method == SweepMethod::Factorial);
            let width = (self.asked.method == SweepMethod::Indices).then_some(self.asked.ranges.len() + 2);
            levels.chain(width).any(|n| common_divisor(step, n) > 1)
        };
        while step > 1 && repeats(step) {
            step += 1;
        }
        (0..designs).step_by(step).collect()
    }

    /// Facts of the solved designs; `column` returns the values of a metric in all of them.
    ///
    /// # Errors
    /// Errors of `column`.
    pub fn facts(
        &self,
        tally: &Tally,
        mut column: impl FnMut(usize) -> io::Result<Vec<f64>>,
    ) -> io::Result<(SweepFacts, SweepPlot)> {
        let (file, asked) = (self.file, self.asked);
        let mut drawn =
            PlottedDesigns { numbers: self.drawn_numbers(tally.designs), ..PlottedDesigns::default() };
        drawn.variables = vec![Vec::new(); asked.ranges.len()];
        for number in &drawn.numbers {
            drawn.variables.iter_mut().zip(self.variables_of(*number)).for_each(|(c, x)| c.push(x));
        }
        let (nominal, round_off) = self.sweep.nominal();
        let mut metrics = Vec::new();
        for (k, of) in self.sweep.metrics().iter().enumerate() {
            let values = column(k)?;
            let dimension = self.dimension(*of);
            let shown = |x: f64| self.units().from_si(dimension, x);
            let some: Vec<f64> = drawn.numbers.iter().map(|n| shown(values[*n])).collect();
            let indices = match asked.method {
                SweepMethod::Indices => sobol_indices(&values, asked.ranges.len(), round_off[k]),
                _ => vec![None; asked.ranges.len()],
            };
            let influence = |(v, index): (usize, &Option<SobolIndex>)| {
                let rank = rank_correlation(&drawn.variables[v], &some, shown(round_off[k]));
                InfluenceFact::of(
                    &file.model.variables[asked.ranges[v].variable.0].name,
                    rank,
                    index.as_ref(),
                )
            };
            let influences = indices.iter().enumerate().map(influence).collect();
            let known = Distribution::of(&values, round_off[k]);
            metrics.push(SweptFact::of(self, k, nominal.metrics[k][0], known.as_ref(), influences));
            drawn.metrics.push(some);
        }
        let facts = SweepFacts::of(self, tally, metrics);
        let plot = plot(&facts, drawn);
        Ok((facts, plot))
    }
}

/// Plot on the page.
fn plot(facts: &SweepFacts, drawn: PlottedDesigns) -> SweepPlot {
    let variable = |(v, values): (&SweptVariable, Vec<f64>)| SweepAxis {
        name: v.name.clone(),
        unit: v.unit.clone(),
        metric: false,
        nominal: Some(v.start),
        target: None,
        values: values.into_iter().collect(),
    };
    let metric = |(m, values): (&SweptFact, Vec<f64>)| SweepAxis {
        name: titled(&m.name, &m.case),
        unit: m.unit.clone(),
        metric: true,
        nominal: None,
        target: None,
        values: values.into_iter().collect(),
    };
    let first = facts.variables.len();
    let index = |(m, (variable, i)): (usize, (usize, &InfluenceFact))| {
        let (first_order, total) = (i.first.zip(i.first_error)?, i.total.zip(i.total_error)?);
        let pair = |(x, error)| [x, error];
        Some(SweepIndex { metric: first + m, variable, first: pair(first_order), total: pair(total) })
    };
    let influences = facts.metrics.iter().enumerate();
    let influences = influences.flat_map(|(m, fact)| fact.influences.iter().enumerate().map(move |i| (m, i)));
    let axes = facts.variables.iter().zip(drawn.variables).map(variable);
    SweepPlot {
        what: "design".into(),
        designs: facts.designs,
        step: drawn.numbers.get(1).copied().unwrap_or(1),
        axes: axes.chain(facts.metrics.iter().zip(drawn.metrics).map(metric)).collect(),
        indices: influences.filter_map(index).collect(),
    }
}

fn common_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

impl SweepFacts {
    /// Facts of the result, line by line.
    pub fn rows(&self) -> Vec<(&'static str, String)> {
        let mut rows = vec![("result", self.message.clone())];
        let seed = self.seed.map_or(String::new(), |seed| format!(", seed {seed}"));
        rows.push((
            "designs",
            format!(
                "{} over {}{seed}",
                self.method.replace('_', " "),
                count(self.variables.len(), "variable")
            ),
        ));
        if self.failed > 0 {
            let part = percent(self.failed as f64 / self.designs as f64);
            rows.push(("failed", format!("{} do not reach the end of the motion ({part})", self.failed)));
        }
        let Evaluations { designs, motions, steps } = self.evaluations;
        rows.push((
            "evaluated",
            format!(
                "{}, {}, {}",
                count(designs, "design"),
                count(motions, "motion"),
                count(steps, "position")
            ),
        ));
        rows
    }

    /// Further tables: metrics, variables, influences, failures.
    pub fn tables(&self) -> Vec<Table> {
        let optional = |x: Option<f64>, unit: &str| x.map_or("-".into(), |x| with_unit(x, unit));
        let of = |m: &SweptFact, f: &dyn Fn(&DistributionFact) -> f64| {
            optional(m.distribution.as_ref().map(f), &m.unit)
        };
        let design = |m: &SweptFact, f: &dyn Fn(&DistributionFact) -> usize| {
            m.distribution.as_ref().map_or("-".into(), |d| f(d).to_string())
        };
        let metrics = Table::of(
            "Metrics",
            "Over all designs with a value: the designs with the minimum and the maximum, and the quantiles at 5, 50 and 95 %.",
            &[
                ("metric", &|m: &&SweptFact| titled(&m.name, &m.case)),
                ("nominal", &|m| optional(m.drawn, &m.unit)),
                ("minimum", &|m| of(m, &|d| d.least.value)),
                ("in design", &|m| design(m, &|d| d.least.design)),
                ("5 %", &|m| of(m, &|d| d.quantiles[0])),
                ("median", &|m| of(m, &|d| d.quantiles[2])),
                ("95 %", &|m| of(m, &|d| d.quantiles[4])),
                ("maximum", &|m| of(m, &|d| d.greatest.value)),
                ("in design ", &|m| design(m, &|d| d.greatest.design)),
                ("mean", &|m| of(m, &|d| d.mean)),
                ("sigma", &|m| of(m, &|d| d.sigma)),
                ("known", &|m| if m.known < self.designs { m.known.to_string() } else { String::new() }),
            ],
            &self.metrics,
        );
        let best = self.metrics.first().map_or("-".into(), |m| format!("least {}", titled(&m.name, &m.case)));
        let variables = Table::of(
            "Variables",
            "Values of parameters; for all other variables changes from the nominal design.",
            &[
                ("variable", &|v: &&SweptVariable| v.name.clone()),
                ("range", &|v| format!("{} to {}", number(v.from), with_unit(v.to, &v.unit))),
                ("levels", &|v| v.levels.map_or(String::new(), |n| n.to_string())),
                ("nominal", &|v| with_unit(v.start, &v.unit)),
                (&best, &|v| optional(v.end, &v.unit)),
            ],
            &self.variables,
        );
        let mut tables = vec![metrics.without_empty_columns()];
        tables.extend(self.influence_tables());
        tables.push(variables.without_empty_columns());
        tables.extend(FailureFact::table(&self.failures, "The tables contain their rows, with the reason."));
        tables
    }

    /// Influences of the variables on the metrics: Sobol indices if they were requested, otherwise rank correlations.
    fn influence_tables(&self) -> Vec<Table> {
        let indices = self.method == SweepMethod::Indices.name();
        let known = self.metrics.iter().filter(|m| m.distribution.as_ref().is_some_and(|d| d.sigma > 0.0));
        if !indices {
            let titles: Vec<String> = known.clone().map(|m| titled(&m.name, &m.case)).collect();
            let cell = |m: &SweptFact, k: usize| {
                m.influences[k].rank_correlation.map_or("-".into(), |r| format!("{r:+.2}"))
            };
            let cells: Vec<_> = known.map(|m| move |r: &(usize, &SweptVariable)| cell(m, r.0)).collect();
            let name = |r: &(usize, &SweptVariable)| r.1.name.clone();
            let mut columns: Vec<Column<'_, (usize, &SweptVariable)>> = vec![("variable", &name)];
            columns.extend(titles.iter().zip(&cells).map(|(title, cell)| (title.as_str(), cell as _)));
            let correlations = Table::of(
                "Rank correlations",
                "1 where a metric always rises with a variable, -1 where it always falls, near 0 where it does neither.",
                &columns,
                self.variables.iter().enumerate(),
            );
            return Some(correlations).filter(|t| t.header.len() > 1).into_iter().collect();
        }
        let table = |m: &SweptFact| {
            let mut by_total: Vec<&InfluenceFact> = m.influences.iter().collect();
            by_total.sort_by(|a, b| b.total.unwrap_or(-1.0).total_cmp(&a.total.unwrap_or(-1.0)));
            let with_error = |x: Option<f64>, e: Option<f64>| {
                x.zip(e).map_or("-".into(), |(x, e)| format!("{x:.3} ± {e:.3}"))
            };
            let pairs = m.influences.iter().filter_map(|i| i.pairs).min().unwrap_or(0);
            let all = self.designs / (self.variables.len() + 2);
            let missing = if pairs < all {
                " Pairs with a failed design are left out: the indices describe the part of the ranges where the mechanism moves."
            } else {
                ""
            };
            Table::of(
                format!("Sobol indices of {}", titled(&m.name, &m.case)),
                format!(
                    "Part of the variance due to the variable alone, and including interactions with others; from {pairs} pairs of designs.{missing}"
                ),
                &[
                    ("variable", &|i: &&InfluenceFact| i.variable.clone()),
                    ("first order", &|i| with_error(i.first, i.first_error)),
                    ("total", &|i| with_error(i.total, i.total_error)),
                    ("", &|i| bar(i.total.unwrap_or(0.0))),
                ],
                by_total,
            )
        };
        known.map(table).collect()
    }

    /// Turns the page of a motion of the nominal design into that of the sweep: the result comes first among the
    /// checks.
    pub fn page(
        &self,
        swept: &SweepInputs<'_>,
        plot: &SweepPlot,
        motion: usize,
        mut page: Payload,
        outputs: &[Output],
    ) -> Payload {
        let first = swept.sweep.metrics().iter().find(|m| m.motion == motion);
        page.open_on(first.map(|m| &swept.model().metrics[m.metric]), outputs);
        page.put_study("Sweep", self.rows(), &["result", "failed"], self.tables());
        Payload { sweep: Some(plot.clone()), ..page }
    }
}
