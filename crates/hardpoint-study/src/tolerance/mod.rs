//! Tolerance study: effects of the tolerances of design variables on every metric and along whole curves.
//!
//! Input: a [`Request`] with tolerances (half widths in m, rad or plain), their distributions, and limits of metrics in
//! SI. Output: a [`ToleranceResult`] in SI, with yields from 0 to 1.
//!
//! Derivatives give, without sampling: worst case, root sum square, second-order mean (37) and variance (38),
//! contributions of the variables, and yield (`docs/theory.md`, section 12; Seber and Lee, *Linear Regression
//! Analysis*, theorems 1.5 and 1.6). Sampled designs that are solved exactly give the
//! same statistics and show the error of the derivatives. Allocation gives the loosest tolerances that satisfy the
//! limits.

mod allocation;
mod contributions;
mod curves;
mod data;
mod deviations;
mod monte_carlo;
mod pins;
mod request;
mod result;
mod spread;
mod study;
mod worst;
mod yields;

pub use allocation::{AllocatedTolerance, Allocation, AllocationError};
pub use contributions::{Contributions, SpreadModel};
pub use curves::{BandPoint, CurveBands};
pub use deviations::{SecondOrder, TolerancedVariable};
pub use monte_carlo::{FailureGroup, MonteCarlo, SampledCurve, SampledMetric};
pub use pins::SideChange;
pub use request::{Overrides, Request, allocation_rule};
pub use result::{Error, ToleranceResult, toleranced_designs};
pub use spread::{MetricSpread, NONLINEAR};
pub use study::tolerance;
pub use worst::Extreme;
pub use yields::{LimitYield, Yield};
