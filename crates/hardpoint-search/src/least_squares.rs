//! Bounded least squares by basin's trust-region solver, for problems with residuals and their derivatives.

use std::convert::Infallible;

use basin::{
    CostFunction, DenseMatrix, Executor, Jacobian, PointState, Residual, Stepper, TrustRegionReflective,
};

use crate::stepping::next;

/// A point is stationary if its gradient is below this fraction of the gradient at the start.
const STATIONARY: f64 = 1e-13;

/// Residuals at a point, of order one at the start; NaN if the point cannot be evaluated, so that the solver steps
/// back.
pub type Residuals<'p> = Box<dyn Fn(&[f64]) -> Vec<f64> + 'p>;
/// Derivatives of the residuals, one row per residual.
pub type Derivatives<'p> = Box<dyn Fn(&[f64]) -> Vec<Vec<f64>> + 'p>;

/// Least squares within bounds.
struct Bounded<'p> {
    low: Vec<f64>,
    high: Vec<f64>,
    residuals: Residuals<'p>,
    derivatives: Derivatives<'p>,
}

impl basin::Constraints for Bounded<'_> {
    type Set = basin::ConstraintSet<basin::BoxBounds<Vec<f64>>>;
    fn constraints(&self) -> <Self::Set as basin::ConstraintDescription>::Borrowed<'_> {
        basin::ConstraintSet::new().with_bounds(basin::BoxBounds::new(Some(&self.low), Some(&self.high)))
    }
}

impl CostFunction for Bounded<'_> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Infallible;
    fn cost(&self, x: &Vec<f64>) -> Result<f64, Infallible> {
        self.residual(x).map(|r| 0.5 * r.iter().map(|r| r * r).sum::<f64>())
    }
}

impl Residual for Bounded<'_> {
    type Param = Vec<f64>;
    type Output = Vec<f64>;
    type Error = Infallible;
    fn residual(&self, x: &Vec<f64>) -> Result<Vec<f64>, Infallible> {
        Ok((self.residuals)(x))
    }
}

impl Jacobian for Bounded<'_> {
    type Jacobian = DenseMatrix;
    fn jacobian(&self, x: &Vec<f64>) -> Result<DenseMatrix, Infallible> {
        let rows = (self.derivatives)(x);
        Ok(DenseMatrix::from_fn(rows.len(), x.len(), |row, v| rows[row][v]))
    }
}

/// Solver between iterations.
pub struct LeastSquares<'p>(Stepper<Bounded<'p>, PointState<Vec<f64>, f64>, TrustRegionReflective<f64>>);

impl<'p> LeastSquares<'p> {
    /// Solver from a start, with the same bounds for every coordinate; `None` if the solver cannot start.
    pub fn new(
        start: Vec<f64>,
        [low, high]: [f64; 2],
        residuals: Residuals<'p>,
        derivatives: Derivatives<'p>,
    ) -> Option<Self> {
        let [low, high] = [low, high].map(|bound| vec![bound; start.len()]);
        let solver = TrustRegionReflective::new().with_absolute_scaled_gradient_tolerance(STATIONARY);
        let run =
            Executor::new(Bounded { low, high, residuals, derivatives }, solver, PointState::new(start));
        run.into_stepper().ok().map(Self)
    }

    /// Performs one iteration and returns the new point; `None` at the end.
    pub fn step(&mut self) -> Option<Vec<f64>> {
        next(&mut self.0)
    }
}
