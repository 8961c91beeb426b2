//! Measures and followed points, with rates and sensitivities.
//!
//! A measure is written once, over any [`Real`](crate::number::Real); its rate, acceleration and the design derivatives
//! of all three follow by the product and chain rules where it runs on [`Rates`](crate::number::Rates).
//!
//! Formulas, symbols and signs are those of `docs/measures.md`; a number represents value, rate and acceleration, and
//! for the derivative by a design variable of all three (`docs/theory.md`, section 9).

mod bodies;
mod dexterity;
mod evaluate;
mod formulas;
mod program;
mod slope;
mod step_values;
mod storage;
mod turns;
mod wheel;

pub(crate) use bodies::with_rates;
pub(crate) use evaluate::{Context, MeasuredDesign, derivatives, evaluate};
pub use formulas::clearances_of;
pub(crate) use formulas::{Instant, bodies_asked_for, clearance_of, is_formula};
pub use program::MeasureFormulas;
pub(crate) use program::{MeasureProgram, ProgramKey, dependences};
pub(crate) use slope::{DriverPoses, Slopes, hindrance};
pub(crate) use step_values::{RecordedValue, RecordedValues, StepValues};
pub(crate) use storage::finite;
pub use storage::{MeasureResults, Output, outputs};
pub(crate) use turns::{ElementCoordinate, PathAngles};
pub(crate) use wheel::WheelAt;
