//! Loss functions of residuals.

use crate::request::{RequestError, named};

/// Loss function of residuals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Loss {
    /// Square of the residual.
    #[default]
    Squares,
    /// Square up to 1.345 standard deviations, linear beyond.
    Huber,
    /// Logarithm of the square: residuals of many standard deviations have next to no influence.
    Cauchy,
}

impl Loss {
    /// Names of all of them.
    pub const NAMES: [&str; 3] = ["squares", "huber", "cauchy"];

    /// Loss function of a name.
    ///
    /// # Errors
    /// A [`RequestError`] if there is none.
    pub fn named(name: &str) -> Result<Self, RequestError> {
        Ok([Self::Squares, Self::Huber, Self::Cauchy][named("loss function", name, Self::NAMES)?])
    }

    /// Weight of a residual relative to least squares, from 0 to 1.
    pub fn weight(self, r: f64) -> f64 {
        // 95 % efficiency for normal residuals (Holland and Welsch 1977)
        const HUBER: f64 = 1.345;
        const CAUCHY: f64 = 2.385;
        match self {
            Self::Squares => 1.0,
            Self::Huber => HUBER / r.abs().max(HUBER),
            Self::Cauchy => 1.0 / (1.0 + (r / CAUCHY).powi(2)),
        }
    }
}
