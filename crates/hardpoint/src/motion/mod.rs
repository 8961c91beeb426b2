//! Position, velocity and acceleration of every body over time.
//!
//! Every step is taken in the same order (`step`): drive, predict, correct, check, accept. The correction is Newton's
//! method for each block in turn, then velocity and acceleration from the same factors (`kinematics`). Closely spaced
//! output times are steps themselves (`advance`, `time_batch`, `design_batch`); elsewhere the solver chooses its own
//! steps along the path (`walk`).

pub(crate) mod advance;
pub(crate) mod assembly;
mod change_point;
mod contraction;
mod crossing;
pub(crate) mod design_batch;
mod driven_step;
pub(crate) mod driver_box;
pub(crate) mod execution;
mod gap;
mod guard;
pub(crate) mod inner_step;
pub(crate) mod jerk;
pub(crate) mod kinematics;
pub(crate) mod level;
mod lookahead;
pub(crate) mod margin;
pub(crate) mod mechanism;
pub(crate) mod parts;
mod path;
mod path_step;
mod predictor;
mod singularity;
pub(crate) mod start;
pub(crate) mod state_along;
mod states;
mod step;
pub(crate) mod step_program;
pub(crate) mod stepper;
mod stop;
pub(crate) mod tape;
pub(crate) mod time_batch;
pub(crate) mod tube;
pub(crate) mod turns;
mod walk;

pub use driven_step::{DrivenCoordinate, DrivenCurve, DrivenStep, DrivenVariable, MotionCheck};
pub use driver_box::BoxFailure;
pub use execution::{Execution, StepMethod};
pub use gap::{Assembly, AssemblyShift, Closing, Gap};
pub use jerk::BodyJerk;
pub use margin::Margin;
pub use states::{BodyState, Motion, SingularPosition, SingularityKind, SolverStatistics, States};
pub use stop::{AxisMotion, GivingDirection, Stop, StopKind};
pub use tube::{ProvenMotion, TubeFailure};
