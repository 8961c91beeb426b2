//! Calibration: fit of the geometry to measured data, with the accuracy of the result, unidentifiable changes, and
//! proposed further readings.
//!
//! Input: a [`Request`] with readings of outputs in postures of the drivers, SI. Output: a [`Calibration`] with the
//! fitted design and its covariance, m, rad or plain.
//!
//! A reading i of an output y in a posture, with standard deviation s_i, has the residual `r_i = (y(b) - m_i) / s_i`.
//! The fit minimises the sum of their squares or of a robust loss. With the exact Jacobian `J = dr/db` of the readings,
//!
//! ```text
//! covariance = (J' W J)^-1,    W = the weights of the loss
//! ```
//!
//! over the directions that the readings determine. Gaussian priors and groups of variables are further rows, so that
//! the same formula is the covariance of the posterior (Tarantola, Inverse Problem Theory, 2005, section 3.2). All
//! other directions are reported and keep their design values (`docs/theory.md`, section 13).

mod certainty;
mod fit;
mod loss;
mod next;
mod parameter;
mod posture;
mod prior;
mod request;
mod result;
mod study;
mod validate;

pub use certainty::{Certainty, UnidentifiableChange};
pub use fit::Status;
pub use loss::Loss;
pub use next::{Improvement, NextReading};
pub use parameter::{BoundSide, FittedParameter};
pub(crate) use posture::posture_model;
pub use posture::{UnreachedPosture, values_in_postures};
pub use prior::Prior;
pub use request::{Overrides, Request};
pub use result::{Calibration, Error, FittedReading};
pub use study::calibrate;
pub use validate::{ValidatedReading, Validation};
