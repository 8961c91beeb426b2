//! Result of a synthesis.

use hardpoint_planar::defects::{Defect, Passage};
use hardpoint_planar::dyads::Dyad;
use hardpoint_planar::linkage::{Linkage, LinkageType};
use hardpoint_planar::plane::Displacement;

/// Result of a synthesis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Synthesis {
    /// The best answers, best first.
    pub answers: Vec<Answer>,
    /// Cranks through the poses; none for a path.
    pub cranks: Vec<Dyad>,
    /// Sliders through the poses; none for a path.
    pub sliders: Vec<Dyad>,
    /// Numbers of four-bars.
    pub four_bars: Tally,
    /// Numbers of slider-cranks.
    pub slider_cranks: Tally,
    /// Linkages with defects, the least first, at most the number of answers; of a path those that meet all points.
    pub rejections: Vec<Rejection>,
    /// Size of the task: the largest distance between two poses or points, m.
    pub size: f64,
    /// True if the caller ended the study: the answers are those found so far.
    pub is_interrupted: bool,
}

/// A linkage that fulfils the task.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The linkage in the configuration of the first pose or point.
    pub linkage: Linkage,
    /// Displacements of the coupler since then.
    pub moves: Vec<Displacement>,
    /// Passage through them.
    pub passage: Passage,
    /// Type.
    pub kind: LinkageType,
    /// Root mean square of the distances from the points, m; of poses zero.
    pub rms: f64,
    /// Largest distance from a point, m; of poses the largest misfit of a dyad.
    pub largest: f64,
    /// Rank: the sine of the least transmission angle, less for large linkages.
    pub score: f64,
}

/// A linkage with all poses that does not pass them.
#[derive(Clone, Debug, PartialEq)]
pub struct Rejection {
    /// The linkage in the configuration of the first pose.
    pub linkage: Linkage,
    /// The defect.
    pub defect: Defect,
}

/// Numbers of linkages of one type by their outcome.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// All that were made.
    pub made: usize,
    /// Those with each defect, in the order of [`Defect::ALL`].
    pub defects: [usize; 4],
    /// Those without defect whose pivots or pins are outside the regions.
    pub outside: usize,
    /// Those without defect whose crank does not turn fully, if it must.
    pub rocking: usize,
    /// All others.
    pub good: usize,
}
