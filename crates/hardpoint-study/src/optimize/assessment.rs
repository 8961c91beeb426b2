//! Goals and limits of one design.

use hardpoint::model::{Model, OptimizationSettings};

use super::problem::{Limited, Point, Problem, Refusal};
use crate::evaluation::{Motions, StudyCost};

/// A limit is satisfied if it is exceeded by less than this fraction of its scale: the rest is round-off of the search.
pub const LIMIT_KEPT: f64 = 1e-8;
/// Relative difference of objectives below which the search with the smallest optimality residual is the best one.
pub(super) const AS_GOOD: f64 = 1e-9;
/// Objectives with a relative difference below this are equal to round-off; the design with the smaller optimality
/// residual is then the better one.
pub(super) const THE_SAME: f64 = 1e-12;

/// Evaluated design with its goals and limits.
#[derive(Clone, Debug, Default)]
pub struct DesignAssessment {
    /// Values of all variables of the model, m, rad or plain.
    pub design: Vec<f64>,
    /// Objective: weighted sum of all goals, dimensionless.
    pub objective: f64,
    /// Largest violation of a limit, as a fraction of its scale; 0 if all are satisfied.
    pub violation: f64,
    /// Minimum margin to a singular position over all motions, 0 to 1, if known.
    pub margin: Option<f64>,
    /// Value of each goal in each of its motions: index of the goal, motion, SI value.
    pub goals: Vec<(usize, usize, f64)>,
    /// Value of each limit: index of the limit, motion if it is on a metric, SI value.
    pub limits: Vec<(usize, Option<usize>, f64)>,
}

/// Design that could not be evaluated.
#[derive(Clone, Debug)]
pub struct FailedDesign {
    /// Values of all variables, m, rad or plain.
    pub design: Vec<f64>,
    /// Index of the motion, if one failed.
    pub motion: Option<usize>,
    /// Reason.
    pub why: String,
}

/// Evaluates the goals and limits of one design, given by the values of all variables of the model.
///
/// # Errors
/// A [`FailedDesign`] if a motion stops or comes closer to a singular position than the limit on its margin, or if a
/// goal has no value.
pub fn judge(
    model: &Model,
    motions: &Motions<'_>,
    settings: &OptimizationSettings,
    design: &[f64],
) -> Result<DesignAssessment, FailedDesign> {
    let problem = Problem::new(model, motions, settings);
    let design = design.iter().copied().chain(std::iter::repeat(0.0)).take(model.variables.len()).collect();
    let point = problem.at(design, &mut StudyCost::default(), &|| true);
    let point = point.map_err(|refusal| failed_design(Vec::new(), refusal))?;
    for ((limit, of), value) in problem.limits.iter().zip(&point.limit_values) {
        if let (Limited::Margin(motion), Some(least)) = (of, settings.limits[*limit].least)
            && *value < least - LIMIT_KEPT
        {
            let why = format!("its margin to a singular position falls to {value:.3}, less than {least}");
            return Err(FailedDesign { design: Vec::new(), motion: Some(*motion), why });
        }
    }
    Ok(assess(&problem, &point, &limit_scales(&problem, &point)))
}

pub(crate) fn failed_design(design: Vec<f64>, Refusal { motion, why, .. }: Refusal) -> FailedDesign {
    FailedDesign { design, motion, why }
}

pub(crate) fn assess(problem: &Problem<'_>, point: &Point, scales: &[f64]) -> DesignAssessment {
    let goals = problem.goals.iter().zip(&point.goal_values).map(|(t, v)| (t.of, t.motion, *v));
    let limits = problem.limits.iter().zip(&point.limit_values);
    DesignAssessment {
        design: point.design.clone(),
        objective: point.objective(),
        violation: point.violation(|k| scales[k]),
        margin: point.margin,
        goals: goals.collect(),
        limits: limits.map(|((limit, of), v)| (*limit, of.motion(), *v)).collect(),
    }
}

/// Scale of every limit: the initial change by the most influential variable over its whole bounds.
pub(crate) fn limit_scales(problem: &Problem<'_>, point: &Point) -> Vec<f64> {
    let mut scales = vec![0.0_f64; problem.limits.len()];
    for row in &point.limits {
        for (d, [low, high]) in row.d.iter().zip(&problem.bounds) {
            scales[row.of] = scales[row.of].max((d * (high - low)).abs());
        }
    }
    scales.into_iter().map(|s| if s > 0.0 { s } else { 1.0 }).collect()
}
