//! Results of a sweep, block by block.

use std::ops::Range;

use crate::evaluation::StudyCost;

/// Results of consecutive designs. SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Block {
    /// Numbers of the designs.
    pub numbers: Range<usize>,
    /// Values of each metric in each design; NaN if it has none.
    pub metrics: Vec<Vec<f64>>,
    /// Curves of each motion; empty if not requested.
    pub curves: Vec<Curves>,
    /// Designs that do not reach the end of a motion, motion by motion.
    pub failures: Vec<Failure>,
    /// Cost of the designs.
    pub cost: StudyCost,
}

/// Curves of a block of designs in one motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curves {
    /// Number of solved output times of each design.
    pub steps: Vec<u32>,
    /// Values by design, output time and curve.
    pub values: Vec<f64>,
}

/// A design that does not reach the end of a motion.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// Number of the design.
    pub number: usize,
    /// Index of the motion among those studied.
    pub motion: usize,
    /// Reason without the numbers of this design: failures with the same one are counted together.
    pub reason: String,
    /// Description of the failure.
    pub why: String,
}
