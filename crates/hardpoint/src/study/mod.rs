//! Studies: analyses that solve a mechanism many times.

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
    Calibration, CalibrationError, CalibrationRequest, Certainty, FitStatus, FittedReading, Improvement,
    Loss, Measurements, NextReading, Reading, UnidentifiableChange, UnreachedPosture, calibrate,
    values_in_postures,
};
pub use comparison::{Comparison, StepError};
pub use difference::{Difference, DifferenceScheme, finite_differences, finite_differences_each};
pub use evaluation::{DesignEvaluation, EvaluationError, Motions, StudyCost};
pub use gradient::{GradientMethod, Gradients};
pub use grid::{GridMap, GridStop};
pub use jerk::Jerks;
pub use loads::{DriverLoad, JointLoad, Loads};
pub use magnitude::Magnitude;
pub use metric::{MetricParts, MetricValue, metric_numbers, metrics, metrics_beside, misfits, peaks};
pub use nearest::{NearestAdmissible, nearest_admissible};
pub use optimize::{
    ActiveConstraint, DesignAssessment, FailedDesign, Iteration, LIMIT_KEPT, Optimality, OptimizationRequest,
    OptimizationResult, OptimizationStatus, SearchProgress, SearchResult, judge, optimize,
};
pub use random::{Moments, design_stream, draw, moments};
pub use samples::{BLOCK, SampleBlock, SampleRun};
pub use second::SecondDerivatives;
pub use sweep::{
    Distribution, SobolIndex, Sweep, SweepPlan, SweepPlanError, SweptBlock, SweptCurves, SweptFailure,
    SweptMetric, rank_correlation, sobol_indices,
};
pub use tolerance::{
    AllocatedTolerance, Allocation, AllocationError, BandPoint, Contributions, CurveBands, Extreme,
    FailureGroup, LimitYield, MetricSpread, MonteCarlo, NONLINEAR, SampledCurve, SampledMetric, SecondOrder,
    SpreadModel, ToleranceError, ToleranceResult, ToleranceStage, TolerancedVariable, Yield, tolerance,
    toleranced_designs,
};
pub use validity::{Validity, validity};
pub use verify::{CheckOutcome, PASS, PASS_ONE_SIDED, VariableCheck, Verification, VerifyOptions, verify};
pub use whatif::{
    PredictionQuality, WhatIf, add_coordinates, add_tilts, coordinate, repeats_coordinate, unwrapped_value,
    variable_named, variable_names, what_if,
};

#[cfg(test)]
mod test_models {
    use crate::draft::{Draft, JointDraft};
    use crate::law::Law;

    /// Planar crank-rocker in the plane z = 0. The coupler is a distance joint; a point is measured on the rocker.
    pub fn crank_rocker() -> Draft {
        let rod = JointDraft::new("rod", "distance", ["crank", "rocker"]).at("B").at("C");
        Draft::new("four-bar")
            .hardpoint("A", [0.0, 0.0, 0.0])
            .hardpoint("B", [0.04, 0.2, 0.0])
            .hardpoint("C", [0.36, 0.6, 0.0])
            .hardpoint("D", [0.5, 0.0, 0.0])
            .bodies(["crank", "rocker"])
            .revolute("bearing", ["ground", "crank"], "A", [0.0, 0.0, 1.0])
            .revolute("pivot", ["ground", "rocker"], "D", [0.0, 0.0, 1.0])
            .joint(rod)
            .driver("motor", "bearing", Law::parse("2*t").unwrap())
            .point("tip", "rocker", [0.3, 0.5, 0.0])
    }
}
