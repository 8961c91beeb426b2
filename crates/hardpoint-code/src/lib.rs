//! Straight-line programs as machine code.
//!
//! A [`Program`] becomes code for x86-64: eight lanes in one register of AVX-512, or twice four in registers of AVX2.
//! It gives bit for bit what its instructions say in IEEE arithmetic: nothing is re-associated, nothing fused that was
//! not. A NaN is a NaN: its bits are not reported. Of zeros of either sign,
//! [`Instruction::Larger`](hardpoint_tape::Instruction::Larger) gives any.
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
//!     // The interpreter serves.
//!     Err(reason) => println!("{reason}"),
//! }
//! ```
//!
//! Outputs may go to up to three areas of memory in one run: [`Code::in_parts`] and [`Code::run_in_parts`].
//!
//! This is the only crate of Hardpoint that holds `unsafe`; `docs/machine-code.md` says where, and why it is sound.
//!
//! Not supported: other machines than x86-64, Windows, and systems that do not let memory become executable.
//! [`UnsupportedProgram`] says which it is.

#[cfg_attr(not(all(target_arch = "x86_64", unix)), path = "elsewhere.rs")]
mod x86_64;

use std::fmt;

use hardpoint_tape::{Lanes, Program};

/// The size of the registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Width {
    /// Sixteen registers of four lanes, and fused multiplication and addition.
    Avx2,
    /// Thirty-two registers of eight lanes.
    Avx512,
}

impl Width {
    /// All there are, the narrowest first.
    pub const ALL: [Self; 2] = [Self::Avx2, Self::Avx512];

    /// True if this CPU and this system have it, and code can be made for it.
    pub fn is_here(self) -> bool {
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

/// In how many areas of memory the outputs of one run may be.
pub const PARTS: usize = 3;

/// The most inputs, instructions and so on: 64 bytes of each are an eighth of what offsets of 32 bits reach, and code
/// for as many instructions is below 2 GB.
const MOST: usize = 1 << 22;

/// Reason why there is no machine code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum UnsupportedProgram {
    /// Another kind of machine or system.
    #[error("machine code is made for x86-64 on Unix systems only")]
    Target,
    /// The CPU is too old, or the system hides what it has.
    #[error("the CPU has neither AVX2 with fused multiplication nor AVX-512")]
    Cpu,
    /// The width that was requested is not there.
    #[error("the CPU has no {0}")]
    Width(Width),
    /// The system gives no memory, or does not let it be made executable.
    #[error("the system does not let memory be made executable ({})", std::io::Error::from_raw_os_error(*error))]
    Memory {
        /// The system's number of the error.
        error: i32,
    },
    /// Offsets would not fit into an instruction.
    #[error("the program has {count} {what}, more than machine code is made for ({})", MOST)]
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
    /// Their bytes.
    pub bytes: usize,
    /// Instructions that only bring a number from memory into a register.
    pub loads: usize,
    /// Instructions that only bring a number from one register into another.
    pub copies: usize,
    /// Instructions that put a number aside because registers ran out.
    pub spills: usize,
    /// Number of numbers that are put aside at the same time, at the most.
    pub slots: usize,
}

/// Lines of memory as the machine has them.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
struct Line(#[allow(dead_code, reason = "where there is no machine code, nobody reads it")] [f64; 8]);

/// Memory for numbers while code runs. It serves any code, and grows with the first run that needs more.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    lines: Vec<Line>,
}

/// A program as machine code.
#[derive(Debug)]
pub struct Code {
    machine: x86_64::Machine,
    width: Width,
    counts: Counts,
}

impl Code {
    /// For the widest registers of this CPU.
    ///
    /// # Panics
    ///
    /// If an operand does not exist, or a value is read before it is computed.
    pub fn new(program: &Program) -> Result<Self, UnsupportedProgram> {
        Self::with(program, x86_64::widest()?)
    }

    /// For registers of this width.
    ///
    /// # Panics
    ///
    /// As [`new`](Self::new).
    pub fn with(program: &Program, width: Width) -> Result<Self, UnsupportedProgram> {
        Self::in_parts_with(program, [program.outputs.len(); PARTS - 1], width)
    }

    /// For the widest registers of this CPU, and outputs in up to three areas of memory: part 0 is those before
    /// `ends[0]`, part 1 those from there to `ends[1]`, part 2 the others. Parts may be empty.
    ///
    /// # Panics
    ///
    /// As [`new`](Self::new), and if the ends do not ascend or lie beyond the outputs.
    pub fn in_parts(program: &Program, ends: [usize; PARTS - 1]) -> Result<Self, UnsupportedProgram> {
        Self::in_parts_with(program, ends, x86_64::widest()?)
    }

    /// For registers of this width, and outputs in parts.
    ///
    /// # Panics
    ///
    /// As [`in_parts`](Self::in_parts).
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
    /// Nothing is allocated, but for scratch when it has to grow. Arrays that begin at a multiple of 64 bytes are read
    /// and written faster.
    ///
    /// # Panics
    ///
    /// If a length is another, or the code was made for outputs in other parts than the first. Inputs of a program
    /// without outputs are not looked at.
    pub fn run(&self, scratch: &mut Scratch, inputs: &[Lanes], uniforms: &[f64], outputs: &mut [Lanes]) {
        self.run_in_parts(scratch, inputs, uniforms, [outputs, &mut [], &mut []]);
    }

    /// As [`run`](Self::run), with outputs in parts.
    ///
    /// | array | length | where |
    /// |---|---|---|
    /// | `outputs[p]` | groups x outputs of part `p` | output `j` of part `p` of group `g` at `g * outputs of part p + j` |
    ///
    /// # Panics
    ///
    /// As [`run`](Self::run), and if parts that are not empty say different numbers of groups.
    pub fn run_in_parts(
        &self,
        scratch: &mut Scratch,
        inputs: &[Lanes],
        uniforms: &[f64],
        outputs: [&mut [Lanes]; PARTS],
    ) {
        self.machine.run(&mut scratch.lines, inputs, uniforms, outputs);
    }

    /// The registers that it uses.
    pub fn width(&self) -> Width {
        self.width
    }

    /// Statistics of the code.
    pub fn counts(&self) -> Counts {
        self.counts
    }
}
