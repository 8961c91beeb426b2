//! Shows results to people: the self-contained HTML report.
//!
//! Nothing here computes: a caller hands over finished curves and facts in the user's units.

pub mod page;
