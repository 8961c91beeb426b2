//! Sequential quadratic programming by basin's SLSQP.

use std::convert::Infallible;

use basin::{
    ConstraintSolveError, CostFunction, DenseMatrix, Executor, Gradient, SelectedFirstOrderState, Slsqp,
    Stepper,
};

use crate::stepping::next;

/// Convergence threshold on changes of objective and constraints, with curvatures scaled to order one: the square of
/// the required distance from stationarity. The caller detects round-off.
const SETTLED: f64 = 1e-30;

/// A smooth problem `min f(y)` so that `e(y) = 0` and `c(y) <= 0`.
pub trait Program {
    /// Number of equalities.
    fn equal(&self) -> usize;
    /// Number of inequalities.
    fn inequal(&self) -> usize;
    /// `f`; infinite where the point cannot be evaluated.
    fn objective(&self, y: &[f64]) -> f64;
    /// Gradient of `f`.
    fn gradient(&self, y: &[f64]) -> Vec<f64>;
    /// The values `e`.
    fn equalities(&self, y: &[f64]) -> Vec<f64>;
    /// The values `c`.
    fn inequalities(&self, y: &[f64]) -> Vec<f64>;
    /// Derivatives of `e`, then of `c`, one row each.
    fn jacobian(&self, y: &[f64]) -> Vec<Vec<f64>>;
}

/// Solver between iterations.
pub struct Sequential<'p>(Stepper<Problem<'p>, SelectedFirstOrderState<Vec<f64>, f64>, Slsqp<f64>>);

impl<'p> Sequential<'p> {
    /// Solver from a start; `None` if the solver cannot start.
    pub fn new(program: Box<dyn Program + 'p>, start: Vec<f64>) -> Option<Self> {
        let solver = Slsqp::new().with_absolute_accuracy_tolerance(SETTLED);
        let run = Executor::new(Problem(program), solver, SelectedFirstOrderState::new(start));
        run.into_stepper().ok().map(Self)
    }

    /// Performs one iteration and returns the new point; `None` at the end.
    pub fn step(&mut self) -> Option<Vec<f64>> {
        next(&mut self.0)
    }
}

/// A program as basin sees it.
struct Problem<'p>(Box<dyn Program + 'p>);

impl basin::Constraints for Problem<'_> {
    type Set = basin::ConstraintSet<
        basin::NoBounds,
        basin::NoLinearConstraints,
        basin::NonlinearBlocks<basin::NonlinearBlock, basin::NonlinearBlock>,
    >;
    fn constraints(&self) -> <Self::Set as basin::ConstraintDescription>::Borrowed<'_> {
        basin::ConstraintSet::new()
            .with_nonlinear_equalities(self.0.equal())
            .with_nonlinear_inequalities(self.0.inequal())
    }
}

impl CostFunction for Problem<'_> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Infallible;
    fn cost(&self, y: &Vec<f64>) -> Result<f64, Infallible> {
        Ok(self.0.objective(y))
    }
}

impl Gradient for Problem<'_> {
    type Gradient = Vec<f64>;
    fn gradient(&self, y: &Vec<f64>) -> Result<Vec<f64>, Infallible> {
        Ok(self.0.gradient(y))
    }
}

impl basin::NonlinearInequalityValues for Problem<'_> {
    type Param = Vec<f64>;
    type Values = Vec<f64>;
    type Error = Infallible;
    fn nonlinear_inequalities(&self, y: &Vec<f64>) -> Result<Vec<f64>, ConstraintSolveError<Infallible>> {
        Ok(self.0.inequalities(y))
    }
}

impl basin::NonlinearEqualityValues for Problem<'_> {
    type Param = Vec<f64>;
    type Values = Vec<f64>;
    type Error = Infallible;
    fn nonlinear_equalities(&self, y: &Vec<f64>) -> Result<Vec<f64>, ConstraintSolveError<Infallible>> {
        Ok(self.0.equalities(y))
    }
}

impl basin::ConstraintJacobian for Problem<'_> {
    type Param = Vec<f64>;
    type Jacobian = DenseMatrix;
    type Error = Infallible;
    fn constraint_jacobian(&self, y: &Vec<f64>) -> Result<DenseMatrix, ConstraintSolveError<Infallible>> {
        let rows = self.0.jacobian(y);
        Ok(DenseMatrix::from_fn(rows.len(), y.len(), |row, v| rows[row][v]))
    }
}
