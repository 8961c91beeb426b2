//! `verify.json`: exact sensitivities compared with re-solved designs.

use hardpoint::Analysis;
use hardpoint_file::{ModelFile, Units};
use hardpoint_study::StepError;
use hardpoint_study::difference::DifferenceScheme;
use hardpoint_study::verify::{CheckOutcome, Verification};
use serde::Serialize;

use crate::figures::{error, number, rounded, variable_unit};
use crate::page::Table;

/// Contents of `verify.json`. Steps are in the variable's unit, times in s.
#[derive(Clone, Debug, Serialize)]
pub struct Verdict {
    /// Program and version.
    pub generator: &'static str,
    /// Name of the mechanism.
    pub name: String,
    /// Name of the model file, as given.
    pub file: String,
    /// Units of the values.
    pub units: Units,
    /// True if every variable that has sensitivities passed.
    pub passed: bool,
    /// True if the verification was ended early.
    pub interrupted: bool,
    /// Scheme of the differences.
    pub differences: Differences,
    /// Tolerance that every quantity must satisfy at some step.
    pub tolerance: f64,
    /// Variable and quantity with the largest error.
    pub worst: Option<WorstQuantity>,
    /// Checks of the variables.
    pub checks: Vec<CheckFact>,
    /// Duration, s.
    pub seconds: f64,
}

/// Scheme of a difference quotient.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Differences {
    /// Designs at +h and -h.
    Central,
    /// Designs at +h and 0.
    Forward,
    /// Designs at 0 and -h.
    Backward,
}

/// Variable and quantity with the largest error.
#[derive(Clone, Debug, Serialize)]
pub struct WorstQuantity {
    /// Name of the variable.
    pub variable: String,
    /// Name of the quantity.
    pub quantity: String,
    /// Largest relative deviation at the step of best agreement.
    pub error: f64,
}

/// Check of one variable.
#[derive(Clone, Debug, Serialize)]
pub struct CheckFact {
    /// Name of the variable.
    pub variable: String,
    /// Unit; `1` for a plain number.
    pub unit: String,
    /// Outcome of the check.
    pub outcome: Outcome,
    /// Note on the check, in a sentence.
    pub note: Option<&'static str>,
    /// Quantity with the largest error, each at its step of best agreement; with that step.
    pub worst: Option<StepFact>,
    /// Quantity with the largest error at each solved step, from coarse to fine.
    pub sweep: Vec<StepFact>,
}

/// Outcome of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Every quantity agrees at some step.
    Passed,
    /// Some quantity agrees at no step.
    Failed,
    /// The mechanism cannot follow the variable, so there is nothing to compare.
    CannotFollow,
    /// No moved design could be solved to the end.
    NotSolved,
}

/// Deviation of the analytic derivative from the finite difference at one step.
#[derive(Clone, Debug, Serialize)]
pub struct StepFact {
    /// Step as a fraction of the change that moves the farthest marker by the mechanism's size, or by 1 rad.
    pub part: f64,
    /// Step, in the variable's unit.
    pub step: f64,
    /// Largest relative deviation over all times.
    pub error: f64,
    /// Name of the quantity.
    pub quantity: String,
    /// Time of the largest deviation, s.
    pub time: f64,
}

impl Verdict {
    /// Facts of a finished verification.
    pub fn new(file: &ModelFile, analysis: &Analysis<'_>, verification: &Verification, seconds: f64) -> Self {
        let (model, units) = (analysis.model(), file.units);
        // One-sided differences always have an error proportional to the step.
        let parts_later = verification.scheme == DifferenceScheme::Central
            && analysis.topology().redundant().next().is_some();
        let check = |c: &hardpoint_study::verify::VariableCheck| {
            let variable = &model.variables[c.variable.0];
            let natural = model.natural_step(c.variable);
            let step = |s: &StepError| StepFact {
                part: s.step / natural,
                step: units.from_si(variable.quantity, s.step),
                error: s.error,
                quantity: s.quantity.clone(),
                time: s.time,
            };
            CheckFact {
                variable: variable.name.clone(),
                unit: variable_unit(model, units, variable),
                outcome: match c.outcome {
                    CheckOutcome::Passed => Outcome::Passed,
                    CheckOutcome::Failed => Outcome::Failed,
                    CheckOutcome::CannotFollow => Outcome::CannotFollow,
                    CheckOutcome::NotSolved => Outcome::NotSolved,
                },
                note: (c.outcome == CheckOutcome::Failed && parts_later && falls_in_proportion(&c.sweep))
                    .then_some(FIRST_ORDER),
                worst: c.worst().map(step),
                sweep: c.sweep.iter().map(step).collect(),
            }
        };
        let checks: Vec<CheckFact> = verification.checks.iter().map(check).collect();
        let worst = checks
            .iter()
            .filter_map(|c| c.worst.as_ref().map(|b| (c, b)))
            .max_by(|a, b| a.1.error.total_cmp(&b.1.error))
            .map(|(c, b)| WorstQuantity {
                variable: c.variable.clone(),
                quantity: b.quantity.clone(),
                error: b.error,
            });
        Self {
            generator: crate::GENERATOR,
            name: model.name.clone(),
            file: file.file_name().into(),
            units,
            passed: verification.passed(),
            interrupted: verification.interrupted,
            differences: match verification.scheme {
                DifferenceScheme::Central => Differences::Central,
                DifferenceScheme::Forward => Differences::Forward,
                DifferenceScheme::Backward => Differences::Backward,
            },
            tolerance: verification.scheme.tolerance(),
            worst,
            checks,
            seconds,
        }
    }

    /// Table of the variables, each with the quantity of the largest error at its step of best agreement.
    pub fn table(&self) -> Table {
        let outcome = |c: &CheckFact| match c.outcome {
            Outcome::Passed => "passed",
            Outcome::Failed => "FAILED",
            Outcome::CannotFollow => "cannot follow",
            Outcome::NotSolved => "NOT SOLVED",
        };
        let worst =
            |c: &CheckFact, of: &dyn Fn(&StepFact) -> String| c.worst.as_ref().map_or(String::new(), of);
        Table::of(
            "Worst quantity of each variable, at its own best step",
            "",
            &[
                ("variable", &|c: &&CheckFact| c.variable.clone()),
                ("outcome", &|c| outcome(c).to_owned()),
                ("agrees to", &|c| worst(c, &|s| error(s.error))),
                ("at step", &|c| worst(c, &|s| step_text(s.step, &c.unit))),
                ("worst quantity", &|c| worst(c, &|s| s.quantity.clone())),
                ("at t", &|c| worst(c, &|s| format!("{} s", number(s.time)))),
            ],
            &self.checks,
        )
    }

    /// Table of the error against the step, one row per variable; steps as fractions of the natural step.
    pub fn sweep_table(&self) -> Table {
        let mut parts: Vec<f64> = Vec::new();
        for s in self.checks.iter().flat_map(|c| &c.sweep) {
            if !parts.iter().any(|p| same(*p, s.part)) {
                parts.push(s.part);
            }
        }
        parts.sort_by(|a, b| b.total_cmp(a));
        let row = |c: &CheckFact| {
            let at =
                |p: &f64| c.sweep.iter().find(|s| same(s.part, *p)).map_or("–".into(), |s| error(s.error));
            std::iter::once(c.variable.clone()).chain(parts.iter().map(at)).collect()
        };
        Table {
            title: "Largest relative deviation against step".into(),
            note: "A step of 1 moves the farthest marker by the mechanism's size, or turns it by 1 rad."
                .into(),
            header: std::iter::once("variable".to_owned()).chain(parts.iter().map(|p| error(*p))).collect(),
            rows: self.checks.iter().filter(|c| !c.sweep.is_empty()).map(row).collect(),
        }
    }
}

/// Explanation of a deviation that is proportional to the step itself, not to its square, in a mechanism with redundant
/// constraints.
const FIRST_ORDER: &str = "the mechanism cannot follow a finite step exactly, because its redundant constraints part at \
    second order; the difference falls in proportion to the step, as it must";

/// True if error and step keep their ratio over at least a decade of steps, down to the best one.
fn falls_in_proportion(sweep: &[StepError]) -> bool {
    const DECADE: f64 = 10.0;
    let mut first = 0;
    for k in 1..sweep.len() {
        let [a, b] = [&sweep[k - 1], &sweep[k]];
        let ratio = (a.error / b.error) / (a.step / b.step);
        if !(0.7..1.4).contains(&ratio) {
            first = k;
        } else if sweep[first].step >= 0.99 * DECADE * b.step && sweep.iter().all(|s| s.error >= b.error) {
            return true;
        }
    }
    false
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-6 * a.abs()
}

fn step_text(step: f64, unit: &str) -> String {
    let step = rounded(step, 2);
    if unit == "1" { step } else { format!("{step} {unit}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sweep(error: impl Fn(f64) -> f64) -> Vec<StepError> {
        let steps = (4..=12).map(|k| 10.0_f64.powf(-0.5 * f64::from(k)));
        let quantity = String::from("rod position");
        let at = |step| StepError { step, error: error(step), quantity: quantity.clone(), time: 0.0 };
        steps.map(at).collect()
    }

    #[test]
    fn a_difference_that_decreases_with_the_step_is_distinguished() {
        assert!(falls_in_proportion(&sweep(|h| 3.0 * h)));
        // Higher-order terms dominate at large steps.
        assert!(falls_in_proportion(&sweep(|h| 3.0 * h + 4e3 * h * h)));
        assert!(!falls_in_proportion(&sweep(|h| h * h)), "a wrong design has no such excuse");
        assert!(!falls_in_proportion(&sweep(|_| 0.1)), "nor has a wrong sensitivity");
        assert!(!falls_in_proportion(&sweep(|h| 3.0 * h + 0.01)));
        assert!(!falls_in_proportion(&sweep(|h| 3.0 * h)[..2]), "half a decade is too little to say");
        assert!(!falls_in_proportion(&[]));
    }
}
