//! Solution plan: tree joints, cut joints, and the order of the blocks.
//!
//! The plan is made once per model, in its design configuration. A spanning tree of joints places the bodies; every
//! other joint is cut into elementary constraints. Unknown coordinates and constraint rows fall into *blocks* (in
//! classical linkages: the Assur groups) that are solved one after another, so that the cost grows linearly with the
//! number of independent loops (`docs/theory.md`, section 3).

mod blocks;
mod error;
mod ids;
mod matching;
mod mobility;
mod openings;
mod plan;
mod planner;
mod redundancy;
mod size;
mod start;
mod tree;

pub use error::TopologyError;
pub use ids::{BlockId, ClosureId, CoordinateId, Ids, LinkId, RowId};
pub(crate) use openings::{Dependence, OpenTree, TreeRow, dependence, open_tree};
pub use plan::{
    Block, Closure, ClosureColumn, Coordinate, CoupledColumn, CutReason, Formulation, JointRole, Link,
    LinkStep, LoopLink, RowPlace, RowTerm, SetBy, Topology,
};
pub use redundancy::Redundancy;
pub(crate) use size::units_of;
pub use start::StartCoordinates;
