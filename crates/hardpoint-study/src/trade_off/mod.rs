//! Trade-off between goals: which designs are the best compromises, and what does one goal cost in the others?
//!
//! Input: a [`Request`] with two or three goals, bounds and limits. Output: a [`TradeOff`] with designs spread over the
//! front, none better than another in all goals, each with its residual of the first-order condition (theory (76)).
//!
//! ```text
//! optimum of each goal alone  ->  points between neighbours, in the widest gaps first  ->  points not dominated
//! ```
//!
//! Each point is the solution of a scalar problem ([`Scalarization`](crate::optimize::Scalarization)) that starts at a
//! design interpolated between its neighbours, with their multipliers and curvatures, and ends after a few steps. Goals
//! are fractions of their ranges over the anchors, so that results do not depend on units and weights. A front of three
//! goals has the fronts of their pairs as its sides, and its inside starts from a surface spanned between them.

mod front;
mod request;
mod result;
mod study;

pub use request::{Overrides, Request};
pub use result::{FrontPoint, ON_FRONT, Outcome, TradeOff};
pub use study::trade_off;
