//! Facts of a mechanism that is analysed and, as far as possible, solved.
//!
//! They are collected once and shown as text by `hardpoint check`, as JSON, and as tables of the page.

mod change;
mod model;
mod names;
mod notes;
mod redundancy;
mod text;

pub(crate) use change::change_text;
pub use model::{
    BlockFact, BodyFact, ConditionFact, Counts, CouplerFact, DefectFact, DriverFact, Facts, JointFact,
    MeasureFact, OpenFact, RedundantFact, TermFact, VariableAdmissibility, VariableFact,
};
pub(crate) use model::{couplers, drivers, fixed_spins, joints_on, measures, written_kind};
pub use redundancy::{JointReplacement, RedundancyFact};
pub use text::outline;
pub(crate) use text::table;
