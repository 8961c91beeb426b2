//! Records arithmetic and runs it again as a straight-line program.

pub mod program;

pub use program::{Call, Instruction, LANES, Lanes, Operand, Program};
