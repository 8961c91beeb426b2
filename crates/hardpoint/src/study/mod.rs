//! Studies: questions that take many solutions.

mod alone;
mod calibrate;
mod comparison;
mod difference;
mod evaluation;
mod gradient;
mod grid;
mod jerk;
mod loads;
mod magnitude;
mod nearest;
mod optimize;
mod random;
mod samples;
mod second;
mod sweep;
mod tolerance;
mod trust_region;
mod validity;
mod verify;
mod whatif;

pub(crate) use crate::run::metric;

pub use alone::DriverRates;
pub use calibrate::{
    Calibrating, Calibration, CannotCalibrate, Certainty, FitStatus, Fitted, Improvement, Loss, Measurements,
    Next, NotReached, Reading, Untold, calibrate, values_in_postures,
};
pub use comparison::{Comparison, StepError};
pub use difference::{Difference, Scheme, finite_differences, finite_differences_each};
pub use evaluation::{Cost, Evaluated, Motions, Rejection};
pub use gradient::{Gradients, Method};
pub use grid::{GridMap, GridStop};
pub use jerk::Jerks;
pub use loads::{DriverLoad, JointLoad, Loads};
pub use magnitude::Magnitude;
pub use metric::{MetricParts, MetricValue, metric_numbers, metrics, metrics_beside, misfits, peaks};
pub use nearest::{NearestAdmissible, nearest_admissible};
pub use optimize::{
    Binding, Iteration, Judged, LIMIT_KEPT, Optimality, Optimized, Progress, Refused, Search, Searching,
    Status, judge, optimize,
};
pub use random::{Moments, design_stream, draw, moments};
pub use samples::{BLOCK, Gathered, SampleRun};
pub use second::SecondDerivatives;
pub use sweep::{
    Distribution, NoPlan, SobolIndex, Sweep, SweepPlan, SweptBlock, SweptCurves, SweptFailure, SweptMetric,
    rank_correlation, sobol_indices,
};
pub use tolerance::{
    Allocated, Allocation, Band, Contributions, CurveBands, Examination, Extreme, Failure, Impossible,
    LimitYield, MetricSpread, MonteCarlo, NONLINEAR, SampledCurve, SampledMetric, SecondOrder, SpreadModel,
    Stage, ToleranceFailure, Tolerated, Yield, tolerance, toleranced_designs,
};
pub use validity::{Validity, validity};
pub use verify::{CheckOutcome, PASS, PASS_ONE_SIDED, Verification, VerifiedValue, VerifyOptions, verify};
pub use whatif::{
    Foresight, WhatIf, add_coordinates, add_tilts, coordinate, repeats_coordinate, value_beside,
    variable_named, variable_names, what_if,
};
