//! Machine code for straight-line programs.
//!
//! Compiles a [`Program`] to code for x86-64: eight lanes in one register of AVX-512, or twice four in registers of
//! AVX2. Results are bit for bit those of its instructions in IEEE arithmetic: operations are neither re-associated nor
//! fused. Exceptions: the bits of a NaN are unspecified, and
//! [`Instruction::Larger`](hardpoint_tape::Instruction::Larger) of zeros of different signs returns either.
//!
//! ```
//! use hardpoint_code::{Code, Scratch};
//! use hardpoint_tape::{Instruction, Operand, Program};
//!
//! // x x - 2
//! let (x, two) = (Operand::Input(0), Operand::Constant(0));
//! let program = Program {
//!     inputs: 1,
//!     constants: vec![2.0],
//!     instructions: vec![Instruction::MulSub(x, x, two)],
//!     outputs: vec![Operand::Value(0)],
//!     ..Program::default()
//! };
//! match Code::new(&program) {
//!     Ok(code) => {
//!         let mut outputs = [[0.0; 8]];
//!         code.run(&mut Scratch::default(), &[[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]], &[], &mut outputs);
//!         assert_eq!(outputs, [[-2.0, -1.0, 2.0, 7.0, 14.0, 23.0, 34.0, 47.0]]);
//!     }
//!     // Use the interpreter.
//!     Err(reason) => println!("{reason}"),
//! }
//! ```
//!
//! Outputs may go to up to three areas of memory in one run: [`Code::in_parts`] and [`Code::run_in_parts`].
//!
//! This is the only crate of Hardpoint with `unsafe` code; `docs/machine-code.md` lists it and explains why it is
//! sound.
//!
//! Unsupported: machines other than x86-64, Windows, and systems that do not allow executable memory.
//! [`UnsupportedProgram`] is the reason.

#[cfg_attr(not(all(target_arch = "x86_64", unix)), path = "unsupported.rs")]
mod x86_64;

use std::fmt;

use hardpoint_tape::{Lanes, Program};

/// Width of the vector registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Width {
    /// Sixteen registers of four lanes, and fused multiplication and addition.
    Avx2,
    /// Thirty-two registers of eight lanes.
    Avx512,
}

impl Width {
    /// All widths, the narrowest first.
    pub const ALL: [Self; 2] = [Self::Avx2, Self::Avx512];

    /// True if this CPU and this system support it.
    pub fn is_available(self) -> bool {
        x86_64::has(self)
    }
}

impl fmt::Display for Width {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Avx2 => "AVX2",
            Self::Avx512 => "AVX-512",
        })
    }
}

/// Maximum number of memory areas (parts) of the outputs of one run.
pub const PARTS: usize = 3;

/// Maximum number of inputs, instructions and so on: 64 bytes of each are an eighth of the reach of 32-bit offsets, and
/// code of this number of instructions is below 2 GB.
const MOST: usize = 1 << 22;

/// Reason why there is no machine code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum UnsupportedProgram {
    /// Other machine or system.
    #[error("machine code requires x86-64 and a Unix system")]
    Target,
    /// The CPU is too old, or the system disables its vector registers.
    #[error("the CPU has neither AVX2 with fused multiplication nor AVX-512")]
    Cpu,
    /// The requested width is not available.
    #[error("the CPU has no {0}")]
    Width(Width),
    /// The system has no memory, or does not allow executable memory.
    #[error("the system does not allow executable memory ({})", std::io::Error::from_raw_os_error(*error))]
    Memory {
        /// Error number of the system.
        error: i32,
    },
    /// The program is too large: offsets do not fit into an instruction.
    #[error("the program has {count} {what}, more than machine code supports ({})", MOST)]
    Size {
        /// Name of the quantity that is too large.
        what: &'static str,
        /// Total number.
        count: usize,
    },
}

/// Statistics of the code.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Machine instructions.
    pub instructions: usize,
    /// Size of the code, bytes.
    pub bytes: usize,
    /// Instructions that only load a number from memory into a register.
    pub loads: usize,
    /// Instructions that only copy a number from one register to another.
    pub copies: usize,
    /// Instructions that spill a number because no register is free.
    pub spills: usize,
    /// Maximum number of numbers that are spilled at the same time.
    pub slots: usize,
}

/// Cache line of memory.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
struct Line(#[allow(dead_code, reason = "where there is no machine code, nobody reads it")] [f64; 8]);

/// Scratch memory of a run. It can be used with any code, and grows if a run needs more.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    lines: Vec<Line>,
}

/// Program as machine code.
#[derive(Debug)]
pub struct Code {
    machine: x86_64::Machine,
    width: Width,
    counts: Counts,
}

impl Code {
    /// Compiles for the widest registers of this CPU.
    ///
    /// # Panics
    ///
    /// If an operand does not exist, or a value is read before it is computed.
    pub fn new(program: &Program) -> Result<Self, UnsupportedProgram> {
        Self::with(program, x86_64::widest()?)
    }

    /// Compiles for registers of this width.
    ///
    /// # Panics
    ///
    /// If [`new`](Self::new) would panic.
    pub fn with(program: &Program, width: Width) -> Result<Self, UnsupportedProgram> {
        Self::in_parts_with(program, [program.outputs.len(); PARTS - 1], width)
    }

    /// Compiles for the widest registers of this CPU, with outputs in up to three areas of memory: part 0 has the
    /// outputs before `ends[0]`, part 1 those from there to `ends[1]`, part 2 the others. Parts can be empty.
    ///
    /// # Panics
    ///
    /// If [`new`](Self::new) would panic, or if the ends are not ascending or are beyond the outputs.
    pub fn in_parts(program: &Program, ends: [usize; PARTS - 1]) -> Result<Self, UnsupportedProgram> {
        Self::in_parts_with(program, ends, x86_64::widest()?)
    }

    /// Compiles for registers of this width, with outputs in parts.
    ///
    /// # Panics
    ///
    /// If [`in_parts`](Self::in_parts) would panic.
    pub fn in_parts_with(
        program: &Program,
        ends: [usize; PARTS - 1],
        width: Width,
    ) -> Result<Self, UnsupportedProgram> {
        let (machine, counts) = x86_64::Machine::new(program, ends, width)?;
        Ok(Self { machine, width, counts })
    }

    /// Runs the program for any number of groups of eight lanes.
    ///
    /// | array | length | where |
    /// |---|---|---|
    /// | `inputs` | groups x inputs | input `k` of group `g` at `g * inputs + k` |
    /// | `uniforms` | uniforms | |
    /// | `outputs` | groups x outputs | output `j` of group `g` at `g * outputs + j` |
    ///
    /// Allocates nothing, except scratch memory if it must grow. Arrays that begin at a multiple of 64 bytes are read
    /// and written faster.
    ///
    /// # Panics
    ///
    /// If a length is wrong, or the code was compiled for outputs in other parts than the first. Inputs of a program
    /// without outputs are not checked.
    pub fn run(&self, scratch: &mut Scratch, inputs: &[Lanes], uniforms: &[f64], outputs: &mut [Lanes]) {
        self.run_in_parts(scratch, inputs, uniforms, [outputs, &mut [], &mut []]);
    }

    /// Runs the program like [`run`](Self::run), with outputs in parts.
    ///
    /// | array | length | position |
    /// |---|---|---|
    /// | `outputs[p]` | groups x outputs of part `p` | output `j` of group `g` at `g * outputs of part p + j` |
    ///
    /// # Panics
    ///
    /// If [`run`](Self::run) would panic, or if parts that are not empty have different numbers of groups.
    pub fn run_in_parts(
        &self,
        scratch: &mut Scratch,
        inputs: &[Lanes],
        uniforms: &[f64],
        outputs: [&mut [Lanes]; PARTS],
    ) {
        self.machine.run(&mut scratch.lines, inputs, uniforms, outputs);
    }

    /// Returns the width of its registers.
    pub fn width(&self) -> Width {
        self.width
    }

    /// Statistics of the code.
    pub fn counts(&self) -> Counts {
        self.counts
    }
}
