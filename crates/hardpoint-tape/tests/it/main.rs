//! Programs against the plain arithmetic that they were recorded from.

mod folding;
mod pieces;
mod random;
mod real;
mod recording;
mod samples;
mod stages;
