//! Numerical solvers that the studies use; none of them knows of mechanisms.
//!
//! - [`LeastSquares`]: nonlinear least squares within bounds, by a trust region.
//! - [`Sequential`]: a smooth objective with equalities and inequalities, by sequential quadratic programming.
//! - [`bounded_least_squares`]: linear least squares within bounds, by an active set.
//! - [`quadratic`]: convex quadratic programs, and non-negative least squares.
//! - [`singular`]: singular values of small matrices, the small ones with the relative accuracy of the large ones.
//! - [`surface`]: the closed surface where a function is zero, as triangles.
//!
//! The iterative solvers advance one iteration per call, so that a caller can show progress and stop. Points are
//! slices, matrices are lists of rows. A problem says that a point cannot be evaluated by NaN or an infinite
//! objective; the solver then steps back.
//!
//! This is a crate of its own because these loops are optimised in every build, and the studies are not
//! (`[profile.release.package]`).

mod bounded;
mod least_squares;
pub mod quadratic;
mod sequential;
mod singular;
mod stepping;
mod surface;
mod vector;

pub use bounded::{FreeDirections, bounded_least_squares};
pub use least_squares::{Derivatives, LeastSquares, Residuals};
pub use sequential::{Program, Sequential};
pub use singular::{Singular, singular};
pub use surface::{LeastOf, Triangles, surface};
pub use vector::{dot, independent, norm};
