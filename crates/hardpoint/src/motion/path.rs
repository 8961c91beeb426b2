//! Paths of the drivers: the assembly, a straight line, and the laws over time.

/// Path of the drivers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Path {
    /// From the design configuration, whose joints may be open, to the closed one, with all drivers at zero; the
    /// parameter runs from 0 to 1 and is the closed fraction of every gap.
    Assembly,
    /// All drivers straight from one value to another, [`line`](super::mechanism::Mechanism::line), at one time; the
    /// parameter runs from 0 to 1. It is used from the design configuration to the first output time, and over jumps of
    /// laws.
    Line {
        /// That time.
        at: f64,
    },
    /// Their laws, over time.
    Laws,
}

impl Path {
    /// Rate of the remaining fraction of every gap along the path.
    pub fn gap_rate(self) -> f64 {
        if self == Self::Assembly { -1.0 } else { 0.0 }
    }

    /// Number of directions of the path: one per driver, or one in which all drivers move together.
    pub fn directions(self, drivers: usize) -> usize {
        if self == Self::Laws { drivers } else { 1 }
    }

    /// Travel of a direction over a step h, from the values of the drivers `before` to those `now`: that of the driver
    /// for a law, the step itself for a straight path.
    pub fn travel_of(self, direction: usize, h: f64, [before, now]: [&[[f64; 3]]; 2]) -> f64 {
        match self {
            Self::Laws => now[direction][0] - before[direction][0],
            Self::Assembly | Self::Line { .. } => h,
        }
    }
}
