//! Measures and components of points that are written.

use hardpoint::measure::{MeasureFormulas, Output, outputs};
use hardpoint::model::{Model, OutputSource};
use hardpoint::motion::DrivenStep;
use hardpoint::{Analysis, Run};
use hardpoint_tape::Operand;

use crate::ExportedModel;

/// A measure or component of a point that is written.
pub struct Measure {
    pub output: Output,
    pub(super) from: MeasureSource,
}

impl Measure {
    /// Number of known time derivatives, the value included.
    pub fn orders(&self) -> usize {
        match self.from {
            MeasureSource::Formulas(_) => self.output.known.orders,
            MeasureSource::Step(_) => 1,
        }
    }
}

/// Program that computes a measure.
#[derive(Clone, Copy)]
pub enum MeasureSource {
    /// The formulas, by the index of the output.
    Formulas(usize),
    /// The step, by the index among the measures of the step.
    Step(usize),
}

/// The measures of a source.
pub struct Measures {
    pub list: Vec<Measure>,
    /// Per measure that counts whole turns: place in the list, and value at the start.
    pub counted: Vec<(usize, f64)>,
}

impl Measures {
    /// The measures that can be written; the others are reported.
    pub fn of(
        analysis: &Analysis<'_>,
        step: &DrivenStep,
        formulas: Option<&MeasureFormulas>,
        out: &mut ExportedModel,
    ) -> Self {
        let model = analysis.model();
        let all = outputs(model);
        let first: Vec<f64> = model.times.first().copied().into_iter().collect();
        let start = analysis.without_metrics(first).solve(Run::new());
        let mut found = Self { list: Vec::new(), counted: Vec::new() };
        for (k, output) in all.into_iter().enumerate() {
            let of_step = match output.source {
                OutputSource::Measure(m) => step.step_measures.iter().position(|n| *n == m),
                OutputSource::Point(..) => None,
            };
            let is_formula = || formulas.is_some_and(|f| is_arithmetic(f, k));
            let from = match of_step {
                Some(n) => MeasureSource::Step(n),
                None if is_formula() => MeasureSource::Formulas(k),
                None => {
                    out.report_unsupported("measure", &output.name, why_not(model, output.source));
                    continue;
                }
            };
            if output.known.counted {
                found.counted.push((found.list.len(), start.measured.value(0, k)[0]));
            }
            found.list.push(Measure { output, from });
        }
        found
    }
}

/// True if the formulas compute an output: its guard is not the constant one.
fn is_arithmetic(formulas: &MeasureFormulas, output: usize) -> bool {
    match formulas.program.outputs[output] {
        Operand::Constant(k) => formulas.program.constants[k as usize] <= 0.0,
        Operand::Value(_) | Operand::Input(_) | Operand::Uniform(_) => true,
    }
}

/// Reason why a measure is not written.
fn why_not(model: &Model, source: OutputSource) -> &'static str {
    match source {
        OutputSource::Measure(m) if model.measures[m].kind.is_load() => {
            "not written: loads are not part of the motion"
        }
        OutputSource::Measure(_) | OutputSource::Point(..) => {
            "not written: it is found by iterations or decisions, not by a formula"
        }
    }
}
