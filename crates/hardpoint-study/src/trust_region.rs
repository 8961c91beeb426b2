//! Bounded least squares by basin's trust-region solver, for problems with residuals and their derivatives, and a cache
//! of recent results for solvers that step back.

use std::cell::RefCell;
use std::convert::Infallible;

use basin::{
    CostFunction, DenseMatrix, Executor, Jacobian, PointState, Residual, State, StepOutcome, Stepper,
    TrustRegionReflective,
};

/// A point is stationary if its gradient is below this fraction of the gradient at the start.
const STATIONARY: f64 = 1e-13;
/// Number of cached points: a line search may return to one of the last few.
const CACHED_POINTS: usize = 16;

/// Results at the most recent points.
pub(super) struct Recent<T>(RefCell<Vec<(Vec<f64>, T)>>);

impl<T> Default for Recent<T> {
    fn default() -> Self {
        Self(RefCell::default())
    }
}

impl<T> Recent<T> {
    /// Calls `show` with the result at a point, cached or newly computed.
    pub fn at<X>(&self, x: &[f64], find: impl FnOnce() -> T, show: impl FnOnce(&T) -> X) -> X {
        let known = self.0.borrow().iter().any(|(at, _)| at == x);
        if !known {
            let found = find();
            let mut recent = self.0.borrow_mut();
            if recent.len() == CACHED_POINTS {
                drop(recent.remove(0));
            }
            recent.push((x.to_vec(), found));
        }
        let recent = self.0.borrow();
        show(&recent.iter().find(|(at, _)| at == x).expect("it was just put there").1)
    }
}

/// Residuals at a point, of order one at the start; NaN if the point cannot be evaluated, so that the solver steps
/// back.
pub(super) type Residuals<'p> = Box<dyn Fn(&[f64]) -> Vec<f64> + 'p>;
/// Derivatives of the residuals, one row per residual.
pub(super) type Derivatives<'p> = Box<dyn Fn(&[f64]) -> DenseMatrix + 'p>;

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
        Ok((self.derivatives)(x))
    }
}

/// Trust-region solver between iterations.
pub(super) struct TrustRegion<'p>(
    Stepper<Bounded<'p>, PointState<Vec<f64>, f64>, TrustRegionReflective<f64>>,
);

impl<'p> TrustRegion<'p> {
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

/// Performs one iteration of any of basin's solvers; internal steps that do not end an iteration are skipped.
pub(super) fn next<P, S, So>(stepper: &mut Stepper<P, S, So>) -> Option<Vec<f64>>
where
    S: State<Param = Vec<f64>, Float = f64> + basin::CountsMirror,
    So: basin::Solver<P, S>,
{
    let before = stepper.iter();
    loop {
        match stepper.step() {
            Ok(StepOutcome::Continue) if stepper.iter() == before => (),
            Ok(StepOutcome::Continue) => return Some(stepper.state().param().clone()),
            Ok(StepOutcome::Stopped(_)) if stepper.iter() > before => {
                return Some(stepper.state().param().clone());
            }
            _ => return None,
        }
    }
}
