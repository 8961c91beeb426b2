//! Records arithmetic and runs it again as a straight-line program, for many numbers side by side.
//!
//! A kernel that walks a mechanism, link by link and row by row, spends most of its time on walking, and most of its
//! arithmetic on exact zeros and ones. What it computes is the same for every output time and every design. So it is
//! run once with [`Number`]s, which record what is done with them; what is left of that, once constants are folded and
//! nothing is computed twice or for nothing, is a [`Program`], which the [`Interpreter`] runs for 32 numbers at a time.
//!
//! ```
//! use hardpoint_tape::{Interpreter, Number, Options, record};
//!
//! // The height of a point of a crank, with a general formula for a plane mechanism: z is nothing.
//! let recording = record(|| {
//!     let [x, y] = [Number::input(0.3), Number::input(0.4)];
//!     let z = Number::constant(0.0);
//!     [(x * x + y * y + z * z).sqrt(), Number::constant(2.0) * y + z]
//! });
//! let (program, counts) = recording.program(Options::default());
//! assert_eq!((counts.recorded, counts.folded, counts.fused, counts.left), (8, 3, 1, 4));
//!
//! // One group of eight: inputs 0 and 1, outputs 0 and 1.
//! let mut outputs = [[0.0; 8]; 2];
//! Interpreter::new(&program).run(&[[3.0; 8], [4.0; 8]], &[], &mut outputs);
//! assert_eq!((outputs[0][7], outputs[1][7]), (5.0, 8.0));
//! ```
//!
//! # The way of a program
//!
//! | step | by |
//! |---|---|
//! | run the kernel with numbers that record | [`record`], [`Number`] |
//! | fold, find what is common, leave out what nobody reads, fuse, put in order | [`Recording::program`] |
//! | split off what depends on uniforms alone, or on the first inputs alone | [`Program::hoisted`], [`Program::staged`] |
//! | take a long one apart into pieces that share their code | [`Program::in_pieces`] |
//! | run, in lanes or as scalars | [`Interpreter`], [`Program::evaluate`] |
//!
//! # What it does not do
//!
//! It does not record decisions: a program has no branches. What was decided while recording must be requested again
//! after every run, by outputs that are compared with what they may be. It does not re-arrange sums, or replace a
//! division by a multiplication, unless that gives the same bits.

mod counts;
mod graph;
mod interpreter;
mod number;
mod pieces;
pub mod program;
mod stage;

pub use counts::{Counts, Kinds};
pub use graph::Options;
pub use interpreter::{Interpreter, WIDE};
pub use number::{Number, Recording, record};
pub use pieces::{AREAS, Piece, Pieces, PiecesRoom, Shape};
pub use program::{Call, Instruction, LANES, Lanes, Operand, Program, fuses};
