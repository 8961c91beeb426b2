//! Evaluation of designs for searches and sweeps: the metrics of a design in all motions of the mechanism, with exact
//! derivatives.

use std::fmt;
use std::ops::ControlFlow;

use hardpoint::model::{Model, SharedModel};
use hardpoint::motion::{Stop, StopKind};
use hardpoint::run::{Analysis, MetricUse, MetricValue, Run, Solution, metrics};
use hardpoint::topology::{Formulation, TopologyError};

/// Motions of a mechanism, ready to be solved for any design.
#[derive(Clone, Debug)]
pub struct Motions<'m> {
    analyses: Vec<Analysis<'m>>,
}

/// Evaluated design.
#[derive(Clone, Debug, Default)]
pub struct DesignEvaluation {
    /// Solution of each motion, with sensitivities.
    pub solutions: Vec<Solution>,
    /// Metrics of each motion.
    pub metrics: Vec<Vec<MetricValue>>,
}

/// Reason why a design has no values: in one of its motions it does not assemble, locks, or reaches a singular
/// position.
#[derive(Clone, Debug)]
pub struct EvaluationError {
    /// Number of the motion, in the order of [`Model::motions`].
    pub motion: usize,
    /// Stop of that motion.
    pub stop: Box<Stop>,
    /// One-line description of the stop.
    pub why: String,
}

impl fmt::Display for EvaluationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.why)
    }
}

/// Cost of a study.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StudyCost {
    /// Number of evaluated designs.
    pub designs: usize,
    /// Number of solved motions.
    pub motions: usize,
    /// Number of solved output times, each with its sensitivities.
    pub steps: usize,
}

impl std::ops::AddAssign for StudyCost {
    fn add_assign(&mut self, other: Self) {
        self.designs += other.designs;
        self.motions += other.motions;
        self.steps += other.steps;
    }
}

impl<'m> Motions<'m> {
    /// Prepares the motions of a mechanism, one model each ([`Model::motions`]).
    ///
    /// # Errors
    /// Number of the motion that cannot be driven, and the reason.
    pub fn of<M: Into<SharedModel<'m>>>(
        motions: impl IntoIterator<Item = M>,
        formulation: Formulation,
    ) -> Result<Self, (usize, TopologyError)> {
        let plan = |(k, model)| Analysis::with(model, formulation).map_err(|fault| (k, fault));
        Ok(Self { analyses: motions.into_iter().enumerate().map(plan).collect::<Result<_, _>>()? })
    }

    /// Analyses of the motions, in order.
    pub fn analyses(&self) -> &[Analysis<'m>] {
        &self.analyses
    }

    /// Model of one motion.
    pub fn model(&self, motion: usize) -> &Model {
        self.analyses[motion].model()
    }

    /// Number of motions.
    pub fn len(&self) -> usize {
        self.analyses.len()
    }

    /// True if there are no motions.
    pub fn is_empty(&self) -> bool {
        self.analyses.is_empty()
    }

    /// Evaluates the design with variable k at `design[k]` in all motions. `more` is called at every output time; if it
    /// returns false, the evaluation ends.
    ///
    /// # Errors
    /// An [`EvaluationError`] with the first motion that does not reach its end.
    pub fn evaluate(
        &self,
        design: &[f64],
        cost: &mut StudyCost,
        more: &(dyn Fn() -> bool + Sync),
    ) -> Result<DesignEvaluation, EvaluationError> {
        self.evaluate_by(&|_| Run::new(), design, cost, more)
    }

    /// Evaluates the metrics of each motion with these uses ([`Run::for_metrics`]).
    ///
    /// # Errors
    /// See [`Motions::evaluate`].
    pub fn evaluate_metrics(
        &self,
        design: &[f64],
        uses: &[Vec<MetricUse>],
        cost: &mut StudyCost,
        more: &(dyn Fn() -> bool + Sync),
    ) -> Result<DesignEvaluation, EvaluationError> {
        self.evaluate_by(&|motion| Run::new().for_metrics(&uses[motion]), design, cost, more)
    }

    fn evaluate_by<'r>(
        &self,
        run: &dyn Fn(usize) -> Run<'r>,
        design: &'r [f64],
        cost: &mut StudyCost,
        more: &'r (dyn Fn() -> bool + Sync),
    ) -> Result<DesignEvaluation, EvaluationError> {
        cost.designs += 1;
        let mut found = DesignEvaluation::default();
        for (motion, analysis) in self.analyses.iter().enumerate() {
            let go_on = |_| if more() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) };
            let solution = analysis.solve(run(motion).at(design).progress(go_on));
            cost.motions += 1;
            cost.steps += solution.motion.len();
            if let Some(stop) = &solution.stop {
                let why = stop.headline(analysis.model());
                return Err(EvaluationError { motion, stop: Box::new(stop.clone()), why });
            }
            found.metrics.push(metrics(analysis.model(), &solution));
            found.solutions.push(solution);
        }
        Ok(found)
    }
}

impl<'m> From<Vec<Analysis<'m>>> for Motions<'m> {
    fn from(analyses: Vec<Analysis<'m>>) -> Self {
        Self { analyses }
    }
}

impl EvaluationError {
    /// True if the caller ended the evaluation.
    pub fn interrupted(&self) -> bool {
        matches!(self.stop.kind, StopKind::Interrupted)
    }
}
