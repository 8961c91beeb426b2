//! Records arithmetic and replays it as a straight-line program, for many numbers in a batch.
//!
//! A kernel that traverses a mechanism, link by link and row by row, spends most of its time on the traversal, and most
//! of its arithmetic on exact zeros and ones. Its operations are the same for every output time and every design. It is
//! therefore run once with [`Number`]s, which record all operations. After constant folding and removal of common and
//! dead operations, a [`Program`] remains, which the [`Interpreter`] runs for 32 numbers at a time.
//!
//! ```
//! use hardpoint_tape::{Interpreter, Number, Options, record};
//!
//! // Distance of a point of a crank from the axis, by a spatial formula in a planar mechanism: z is zero.
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
//! # From kernel to results
//!
//! | step | by |
//! |---|---|
//! | run the kernel with numbers that record | [`record`], [`Number`] |
//! | fold constants, merge common operations, remove dead ones, fuse, order | [`Recording::program`] |
//! | split off operations of uniforms or of the first inputs alone | [`Program::hoisted`], [`Program::staged`] |
//! | differentiate in a direction | [`Program::tangent`] |
//! | split a long program into pieces that share their code | [`Program::in_pieces`] |
//! | run, in lanes or as scalars | [`Interpreter`], [`Program::evaluate`] |
//!
//! # Limitations
//!
//! Decisions are not recorded: a program has no branches. If the kernel decides by a number, make the number an output,
//! and check after every run that the decision would be the same. Sums are not rearranged, and divisions not replaced
//! by multiplications, unless the result has the same bits.

mod counts;
mod graph;
mod interpreter;
mod number;
mod pieces;
pub mod program;
mod stage;
mod tangent;

pub use counts::{Counts, Kinds};
pub use graph::Options;
pub use interpreter::{Interpreter, WIDE};
pub use number::{Number, Recording, record};
pub use pieces::{AREAS, Piece, Pieces, PiecesRoom, Shape};
pub use program::{Call, Instruction, LANES, Lanes, Operand, Program, fuses};
