//! `summary.json`: what was run, the outcome, and the largest sensitivities.

use hardpoint::joint::Quantity;
use hardpoint::model::{Model, OutputSource};
use hardpoint::motion::{SolverStatistics, StepMethod, Stop, StopKind};
use hardpoint::{Analysis, Solution};
use hardpoint_file::{Diagnostic, ModelFile, Units};
use serde::Serialize;

use crate::assembly::{AssemblyFact, GapFact};
use crate::course::Course;
use crate::facts::Facts;
use crate::figures::{order_unit, per, some_of, symbol, variable_unit, with_unit};
use crate::joint_limits::JointLimitFact;
use crate::maps::MapLine;
use crate::margin::{MarginFact, named};
use crate::metric::MetricFact;
use crate::page::Table;
use crate::rigid;
use crate::validity::ValidityFact;

/// Contents of `summary.json`. Values are in the model's units, times in s.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Program and version.
    pub generator: &'static str,
    /// Case of a run of all cases, each of which has a folder of its own.
    pub case: Option<String>,
    /// Status at the end of the run.
    pub status: RunStatus,
    /// Facts of the mechanism.
    pub model: Facts,
    /// Output times.
    pub steps: Steps,
    /// Computational effort.
    pub effort: EffortFact,
    /// Margin to singular positions, if anything was solved for.
    pub margin: Option<MarginFact>,
    /// Assembly before the motion, if the mechanism was open in the design configuration.
    pub assembly: Option<AssemblyFact>,
    /// Reason of an early end.
    pub stop: Option<StopFact>,
    /// Linear range of the sensitivities, variable by variable; empty if it was not examined.
    pub validity: Vec<ValidityFact>,
    /// Values of the metrics.
    pub metrics: Vec<MetricFact>,
    /// Limits of joints: ranges over the motion, margins, and the times at which they are reached.
    pub joint_limits: Vec<JointLimitFact>,
    /// Maps: drivers, number of positions reached, and reasons for unreached ones.
    pub maps: Vec<MapLine>,
    /// The largest sensitivities of every measure.
    pub sensitivities: Vec<Ranking>,
    /// Durations of the phases.
    pub timings: Timings,
    /// Written files.
    pub files: Vec<String>,
    /// Results that were not computed or not written, with instructions to obtain them.
    pub left_out: Vec<String>,
    /// Warnings and errors, including those shown on the terminal.
    pub diagnostics: Vec<Diagnostic>,
    /// Rigid mechanism at the stored output times, for the page.
    #[serde(skip)]
    pub(crate) rigid: Option<Result<Solution, String>>,
}

/// Status at the end of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RunStatus {
    /// The last output time was reached.
    Complete,
    /// The mechanism stopped; the part before the stop was solved.
    Stopped,
    /// The user ended the run; the part before was solved.
    Interrupted,
}

/// Numbers of output times, and times in s.
#[derive(Clone, Debug, Serialize)]
pub struct Steps {
    /// Number of solved output times.
    pub solved: usize,
    /// Number of requested output times.
    pub asked: usize,
    /// First output time.
    pub start: f64,
    /// Last requested output time.
    pub end: f64,
    /// Last solved output time.
    pub last_solved: Option<f64>,
    /// Stride of the output times stored for the page, the series of the margin and comparisons; 1 for all. The result
    /// files contain all output times.
    pub kept_every: usize,
    /// Stride of the output times that metrics use.
    pub metrics_every: usize,
}

/// Computational effort of a solution.
#[derive(Clone, Debug, Serialize)]
pub struct EffortFact {
    /// Solver of smooth steps: machine code, an interpreted program or the kernel; with the reason if it is not machine
    /// code.
    pub solved_by: Option<String>,
    /// Number of output times solved by a program; the kernel solved the others.
    pub steps_by_program: usize,
    /// Number of Newton iterations over all steps.
    pub iterations: usize,
    /// Number of additional interior steps.
    pub substeps: usize,
    /// Largest residual of any constraint, m or rad (SI even if the model's units differ).
    pub worst_residual_si: f64,
    /// Minimum ratio of smallest to largest pivot; 0 at a limit position.
    pub least_pivot_ratio: f64,
    /// Time of the minimum pivot ratio, s.
    pub least_pivot_time: f64,
    /// First output time whose equilibrium is not certainly stable, s.
    pub uncertain_stability: Option<f64>,
}

/// Reason why a run ended early.
#[derive(Clone, Debug, Serialize)]
pub struct StopFact {
    /// Diagnostic code.
    pub code: &'static str,
    /// Sentence with the driver positions at the stop.
    pub message: String,
    /// Last solved time, s.
    pub last_time: Option<f64>,
    /// Earliest time known to fail, s.
    pub failed_time: f64,
    /// Drivers at the last solved position.
    pub drivers: Vec<DriverValue>,
    /// Ratio of smallest to largest pivot of the loop there.
    pub pivot_ratio: f64,
    /// Joints of that loop.
    pub joints: Vec<String>,
    /// Smallest gaps that remain if the mechanism does not assemble, the largest first.
    pub remains: Vec<GapFact>,
    /// Fraction of the gaps that the assembly could close together, 0 to 1.
    pub closed: Option<f64>,
}

impl StopFact {
    /// Facts of a solution that stopped early.
    pub(crate) fn of(file: &ModelFile, solution: &Solution) -> Option<Self> {
        let (model, units) = (&file.model, file.units);
        let stop = solution.stop.as_ref()?;
        let drivers = model.drivers.iter().zip(&stop.drivers).map(|(driver, value)| {
            let quantity = model.driven(driver).quantity;
            DriverValue {
                name: driver.name.clone(),
                value: units.from_si(quantity, *value),
                unit: symbol(units, quantity),
            }
        });
        Some(Self {
            code: stop.code(),
            message: if stop.kind == StopKind::DoesNotAssemble {
                stop.headline(model)
            } else {
                format!("{}{}", stop.headline(model), driver_values(file, stop))
            },
            last_time: stop.last_time,
            failed_time: stop.failed_time,
            drivers: drivers.collect(),
            pivot_ratio: stop.pivot_ratio,
            joints: named(model, &stop.joints),
            remains: stop.remains.iter().map(|g| GapFact::new(model, units, g)).collect(),
            closed: stop.closed,
        })
    }
}

/// Value of a driver.
#[derive(Clone, Debug, Serialize)]
pub struct DriverValue {
    /// Name.
    pub name: String,
    /// Value.
    pub value: f64,
    /// Unit.
    pub unit: &'static str,
}

/// Most influential design variables of a measure, the largest sensitivity first within each unit of variables.
#[derive(Clone, Debug, Serialize)]
pub struct Ranking {
    /// Name of the measure.
    pub measure: String,
    /// `value`, `rate` or `acceleration`.
    pub order: &'static str,
    /// Sensitivities above round-off.
    pub largest: Vec<RankedVariable>,
    /// Variables by which it has no derivative at any output time.
    pub unknown: Vec<String>,
}

/// Largest sensitivity of a measure to one variable over the motion.
#[derive(Clone, Debug, Serialize)]
pub struct RankedVariable {
    /// Name of the variable.
    pub variable: String,
    /// Unit of the variable; only sensitivities per the same unit are comparable.
    pub per: String,
    /// Sensitivity of largest magnitude, with its sign.
    pub value: f64,
    /// Unit.
    pub unit: String,
    /// Time, s.
    pub time: f64,
}

/// Durations of the phases, s.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Timings {
    /// Reading and checking the file, and analysing the mechanism.
    pub read: f64,
    /// Motion and sensitivities.
    pub solve: f64,
    /// Re-solving moved designs for comparison.
    pub compare: f64,
    /// Writing the files, except this one.
    pub write: f64,
    /// Total duration.
    pub total: f64,
}

/// The first output time, and at most two last ones that are no eight, are always solved by the kernel.
const ENDS: usize = 3;

/// Solver of this number of steps, and how many of them programs left to the kernel: those that are long, and
/// sensitivities by parameters of laws.
fn method(by: &StepMethod, effort: SolverStatistics, solved: usize) -> String {
    let left = solved.saturating_sub(effort.by_program);
    match by {
        StepMethod::Kernel(_) => by.to_string(),
        StepMethod::Code(_) | StepMethod::Interpreter(_) if left <= ENDS => by.to_string(),
        StepMethod::Code(_) | StepMethod::Interpreter(_) => {
            format!("{by}; {left} of {solved} output times by the kernel, one by one")
        }
    }
}

impl Summary {
    /// Table of the linear ranges, with the numerical quality of the motion.
    pub fn validity_table(&self) -> Option<Table> {
        ValidityFact::table(&self.validity, self.margin.as_ref(), self.effort.least_pivot_ratio)
    }

    /// Summary of a run, without files.
    pub fn new(file: &ModelFile, analysis: &Analysis<'_>, course: &Course) -> Self {
        let (model, topology, solution) = (&file.model, analysis.topology(), &course.kept);
        let rigid = rigid::solve(file, topology.formulation, &solution.motion.times);
        let rigid_metrics = rigid::metrics(model, rigid.as_ref().and_then(|solved| solved.as_ref().ok()));
        let effort = solution.motion.effort;
        Self {
            generator: crate::GENERATOR,
            case: None,
            status: match &solution.stop {
                None => RunStatus::Complete,
                Some(s) if s.kind == StopKind::Interrupted => RunStatus::Interrupted,
                Some(_) => RunStatus::Stopped,
            },
            model: Facts::new(file, analysis, Some(solution)),
            steps: Steps {
                solved: course.steps,
                asked: model.times.len(),
                start: model.times.first().copied().unwrap_or_default(),
                end: model.times.last().copied().unwrap_or_default(),
                last_solved: course.last_time,
                kept_every: course.stride,
                metrics_every: course.metric_stride,
            },
            effort: EffortFact {
                solved_by: course.kept.motion.solved_by.as_ref().map(|by| method(by, effort, course.steps)),
                steps_by_program: effort.by_program,
                iterations: effort.iterations,
                substeps: effort.substeps,
                worst_residual_si: effort.worst_residual,
                least_pivot_ratio: effort.least_pivot_ratio,
                least_pivot_time: effort.least_pivot_time,
                uncertain_stability: effort.uncertain_stability,
            },
            margin: MarginFact::new(model, file.units, topology, &course.margins, &solution.motion),
            assembly: solution.motion.assembly.as_ref().map(|a| AssemblyFact::new(model, file.units, a)),
            stop: StopFact::of(file, solution),
            validity: Vec::new(),
            joint_limits: match course.steps {
                0 => Vec::new(),
                _ => JointLimitFact::all(file, topology.formulation),
            },
            maps: Vec::new(),
            metrics: MetricFact::all(model, file.units, course.curves(), &rigid_metrics),
            rigid,
            sensitivities: rankings(model, file.units, course),
            timings: Timings::default(),
            files: Vec::new(),
            left_out: Vec::new(),
            diagnostics: Vec::new(),
        }
    }
}

fn rankings(model: &Model, units: Units, course: &Course) -> Vec<Ranking> {
    let mut rankings = Vec::new();
    if course.kept.sensitivities.variables == 0 {
        return rankings;
    }
    let round_off = course.round_off(model);
    for (m, output) in course.kept.measured.outputs.iter().enumerate() {
        if !matches!(output.source, OutputSource::Measure(_)) {
            continue;
        }
        for (order, name) in
            ["value", "rate", "acceleration"].into_iter().enumerate().take(output.known.orders)
        {
            let (mut largest, mut unknown) = (Vec::new(), Vec::new());
            for (b, variable) in model.variables.iter().enumerate().filter(|(b, _)| course.follows(*b)) {
                let unit = variable_unit(model, units, variable);
                let Some((most, time)) = course.largest(m, order, b) else {
                    unknown.push(variable.name.clone());
                    continue;
                };
                if most.abs() <= round_off.of(b, output.dimension, order) {
                    continue;
                }
                largest.push(RankedVariable {
                    variable: variable.name.clone(),
                    value: units.derivative_from_si(output.dimension, variable.quantity, most),
                    unit: per(&order_unit(units, output.dimension, order), &unit),
                    per: unit,
                    time,
                });
            }
            let kinds = [Quantity::Length, Quantity::Angle, Quantity::Number].map(|q| symbol(units, q));
            // Units of law parameters come last.
            let kind = |r: &RankedVariable| {
                (kinds.iter().position(|unit| *unit == r.per).unwrap_or(kinds.len()), r.per.clone())
            };
            largest.sort_by(|a, b| kind(a).cmp(&kind(b)).then(b.value.abs().total_cmp(&a.value.abs())));
            rankings.push(Ranking { measure: output.name.clone(), order: name, largest, unknown });
        }
    }
    rankings
}

impl Ranking {
    /// Remark on a measure without influential variables.
    pub fn without_influence(&self) -> String {
        match self.unknown.is_empty() {
            true => "no variable moves it".into(),
            false => format!("no derivative by {}", some_of(&self.unknown, ", ")),
        }
    }
}

/// Driver positions at a stop: `, with \`rack\` at 12.3 mm and ...`.
pub(crate) fn driver_values(file: &ModelFile, stop: &Stop) -> String {
    let (model, units) = (&file.model, file.units);
    let values: Vec<String> = model
        .drivers
        .iter()
        .zip(&stop.drivers)
        .map(|(driver, value)| {
            let quantity = model.driven(driver).quantity;
            let value = with_unit(units.from_si(quantity, *value), symbol(units, quantity));
            format!("`{}` at {value}", driver.name)
        })
        .collect();
    if values.is_empty() { String::new() } else { format!(", with {}", some_of(&values, ", ")) }
}
