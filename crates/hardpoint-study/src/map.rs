//! Tables of outputs as functions of one to three drivers, with a proved error of their interpolation.
//!
//! Input: ranges of drivers, outputs, and the permitted error of each. Output: a [`MapTable`] in SI, the values and
//! mixed first derivatives at the knots of a rectilinear grid. The intervals of the grid are halved where the
//! proved bound of a cell is above the permitted error, along the driver that contributes most to it
//! (`docs/theory.md`, section 20).

mod cells;
mod interpolation;
mod request;

use hardpoint::model::{DriverId, OutputSource};
use hardpoint::motion::{BoxFailure, Stop};
use hardpoint::number::Exponents;
use hardpoint::topology::TopologyError;

pub use cells::solve;
pub use interpolation::Interpolation;
pub use request::{Axis, ErrorScope, MappedOutput, Overrides, Request};

/// Maximum number of positions of a table times outputs: a file of some 100 MB.
pub const MOST_VALUES: usize = 4_000_000;

/// Reason why there is no table.
#[derive(Clone, Debug)]
pub enum MapError {
    /// The mechanism cannot be driven.
    Topology(TopologyError),
    /// The model has elastic joints, which open as the forces require.
    Equilibrium,
    /// The design configuration cannot be solved.
    Start(Box<Stop>),
    /// A position of the ranges is not reached.
    NotReached {
        /// The drivers' values there, m or rad, measured like the values of their laws.
        drivers: Vec<f64>,
        /// The drivers' values at the last position on the way, likewise.
        last: Vec<f64>,
        /// Reason.
        stop: Box<Stop>,
    },
    /// Nothing is proved in a part of the ranges.
    NotProved {
        /// Lower and upper values of the drivers there, m or rad.
        part: Vec<[f64; 2]>,
        /// Reason.
        reason: ProofError,
    },
    /// The table would have too many values.
    TooLarge {
        /// Number of positions when the study ended.
        positions: usize,
        /// Per output: the error that was proved with them, in SI.
        proved: Vec<f64>,
    },
    /// The caller ended the study.
    Interrupted,
}

/// Reason why nothing is proved in a part of the ranges.
#[derive(Clone, Debug)]
pub enum ProofError {
    /// The positions of the mechanism have no bounds.
    Motion(BoxFailure),
    /// An output, by its index in the request, is undefined, or jumps or has a kink.
    Output(usize),
}

/// Output of a table.
#[derive(Clone, Debug)]
pub struct MapColumn {
    /// The output.
    pub output: OutputSource,
    /// Proved bound of the error of the interpolation everywhere in the ranges, in SI.
    pub proved: f64,
    /// Values and derivatives, position by position; the last driver varies fastest. Those of one position are the
    /// derivatives of [`MapTable::orders`].
    pub numbers: Vec<f64>,
}

/// Outputs over a grid of drivers.
#[derive(Clone, Debug)]
pub struct MapTable {
    /// The drivers.
    pub drivers: Vec<DriverId>,
    /// Per driver: the knots, ascending, m or rad, measured like the values of its laws.
    pub knots: Vec<Vec<f64>>,
    /// Interpolation for which the error is proved.
    pub interpolation: Interpolation,
    /// The outputs.
    pub columns: Vec<MapColumn>,
    /// Number of boxes of the drivers' ranges of which bounds were computed.
    pub boxes: usize,
}

impl MapTable {
    /// Number of positions.
    pub fn positions(&self) -> usize {
        self.knots.iter().map(Vec::len).product()
    }

    /// Number of cells between the knots.
    pub fn cells(&self) -> usize {
        self.knots.iter().map(|knots| knots.len() - 1).product()
    }

    /// Orders of the derivatives at each position: the value, and for cubic Hermite interpolation all mixed first
    /// derivatives.
    pub fn orders(&self) -> Vec<Exponents> {
        self.interpolation.orders(self.drivers.len())
    }

    /// Interpolated value of a column, in SI; outside of the ranges that at their nearest point.
    pub fn value(&self, column: usize, at: &[f64]) -> f64 {
        let orders = self.orders();
        let numbers = &self.columns[column].numbers;
        // Per driver: the interval, and the weights of values and derivatives at both ends.
        let places: Vec<(usize, [[f64; 2]; 2])> = self
            .knots
            .iter()
            .zip(at)
            .map(|(knots, x)| {
                let k = knots.partition_point(|knot| knot <= x).clamp(1, knots.len() - 1) - 1;
                let h = knots[k + 1] - knots[k];
                (k, self.interpolation.weights(((x - knots[k]) / h).clamp(0.0, 1.0), h))
            })
            .collect();
        let mut sum = 0.0;
        for corner in 0..1_usize << places.len() {
            let end = |n: usize| corner >> n & 1;
            let position = places
                .iter()
                .enumerate()
                .fold(0, |place, (n, (k, _))| place * self.knots[n].len() + k + end(n));
            for (o, order) in orders.iter().enumerate() {
                let weight = places.iter().enumerate().map(|(n, (_, w))| w[end(n)][usize::from(order[n])]);
                sum += weight.product::<f64>() * numbers[position * orders.len() + o];
            }
        }
        sum
    }
}
