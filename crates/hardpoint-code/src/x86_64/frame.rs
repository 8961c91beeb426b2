//! Layout of numbers in memory, and the code around the instructions: entry, loop over groups, calls.
//!
//! The code is a function by the System V convention,
//!
//! ```text
//! fn(inputs: rdi, uniforms: rsi, parts: rdx, scratch: rcx, constants: r8, groups: r9)
//! ```
//!
//! The parts are three addresses in memory. The entry loads the addresses of parts that are not empty into rdx, r10 and
//! r11; the others are not read.
//!
//! The code changes all vector registers, these general registers, rax and the flags. Address registers point some
//! bytes into their memory, so that short offsets reach in both directions.
//!
//! AVX-512 runs the program once for each group, AVX2 twice: for the first four lanes and for the others. AVX2 has no
//! broadcast operands, so constants are stored four times, and uniforms are spread in the scratch memory before the
//! first group.

use hardpoint_tape::Program;

use super::encoder::{Assembler, Condition, Gpr, Memory};
use super::lower::{LoweredProgram, NEVER, Name, Names};
use crate::{PARTS, Width};

/// Registers with the addresses of the parts of the outputs.
const OUTPUTS: [Gpr; PARTS] = [Gpr::Rdx, Gpr::R10, Gpr::R11];

const SAVED: [Gpr; 8] = [Gpr::Rdi, Gpr::Rsi, Gpr::Rdx, Gpr::Rcx, Gpr::R8, Gpr::R9, Gpr::R10, Gpr::R11];

/// Layout of numbers in memory.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    width: Width,
    names: Names,
    inputs: i32,
    uniforms: i32,
    /// Offsets of each part.
    outputs: [i32; PARTS],
}

impl Frame {
    pub fn new(program: &Program, outputs: [usize; PARTS], names: Names, width: Width) -> Self {
        Self {
            width,
            names,
            inputs: program.inputs as i32,
            uniforms: program.uniforms as i32,
            outputs: outputs.map(|n| n as i32),
        }
    }

    pub fn width(&self) -> Width {
        self.width
    }

    /// Returns the number of vector registers.
    pub fn registers(&self) -> usize {
        match self.width {
            Width::Avx2 => 16,
            Width::Avx512 => 32,
        }
    }

    /// Returns the size of a vector, bytes.
    pub fn vector_bytes(&self) -> i32 {
        match self.width {
            Width::Avx2 => 32,
            Width::Avx512 => 64,
        }
    }

    /// Returns the initial location of a number; `None` for a value.
    pub fn home(&self, name: Name) -> Option<Memory> {
        let n = self.names;
        let scalar = self.width == Width::Avx512;
        Some(match name {
            _ if n.is_value(name) => return None,
            _ if name < n.uniforms => self.at(Gpr::Rdi, 64 * (name - n.inputs) as i32, false),
            _ if name < n.constants && scalar => self.at(Gpr::Rsi, 8 * (name - n.uniforms) as i32, true),
            _ if name < n.constants => self.scratch(self.uniform((name - n.uniforms) as i32)),
            _ => self.at(Gpr::R8, self.constant_bytes() * (name - n.constants) as i32, scalar),
        })
    }

    /// Returns the size of a constant, bytes.
    pub fn constant_bytes(&self) -> i32 {
        match self.width {
            Width::Avx2 => 32,
            Width::Avx512 => 8,
        }
    }

    pub fn output(&self, j: u32) -> Memory {
        let mut rest = j as i32;
        for (base, outputs) in OUTPUTS.into_iter().zip(self.outputs) {
            if rest < outputs {
                return self.at(base, 64 * rest, false);
            }
            rest -= outputs;
        }
        unreachable!("the parts are all the outputs")
    }

    /// Returns the parts that are not empty: index, register, and number of outputs.
    fn parts(&self) -> impl DoubleEndedIterator<Item = (i32, Gpr, i32)> {
        let all: [_; PARTS] = std::array::from_fn(|p| (p as i32, OUTPUTS[p], self.outputs[p]));
        all.into_iter().filter(|(_, _, outputs)| *outputs > 0)
    }

    /// Returns the scratch memory at an offset: two cells for calls, then spread uniforms, then slots.
    pub fn scratch(&self, offset: i32) -> Memory {
        self.at(Gpr::Rcx, offset, false)
    }

    fn uniform(&self, k: i32) -> i32 {
        self.vector_bytes() * (2 + k)
    }

    pub fn slot(&self, k: usize) -> Memory {
        self.scratch(self.slots_at() + self.vector_bytes() * k as i32)
    }

    fn slots_at(&self) -> i32 {
        match self.width {
            Width::Avx2 => self.uniform(self.uniforms),
            Width::Avx512 => self.uniform(0),
        }
    }

    /// Returns the size of the scratch memory of a run, bytes.
    pub fn scratch_bytes(&self, slots: usize) -> usize {
        self.slots_at() as usize + self.vector_bytes() as usize * slots
    }

    fn at(&self, base: Gpr, offset: i32, broadcast: bool) -> Memory {
        Memory { base, offset: offset - self.ahead(base), broadcast }
    }

    /// Returns the offset of a register into its memory: 128 short offsets.
    fn ahead(&self, base: Gpr) -> i32 {
        match (self.width, base) {
            (Width::Avx512, Gpr::Rsi | Gpr::R8) => 128 * 8,
            (Width::Avx512, _) => 128 * 64,
            (Width::Avx2, _) => 128,
        }
    }

    /// Emits all code; `body` adds the instructions for one vector of each number.
    pub fn around<T>(
        &self,
        lowered: &LoweredProgram,
        body: impl FnOnce(Assembler) -> (Assembler, T),
    ) -> (Assembler, T) {
        let mut a = Assembler::new(self.width);
        // The first part comes last: its register holds the addresses of the others before.
        for (p, base, _) in self.parts().rev() {
            a.read(base, Gpr::Rdx, 8 * p);
        }
        let outputs = self.parts().map(|(_, base, _)| base);
        for base in [Gpr::Rdi, Gpr::Rsi, Gpr::Rcx, Gpr::R8].into_iter().chain(outputs) {
            a.add(base, self.ahead(base));
        }
        if self.width == Width::Avx2 {
            self.spread_uniforms(&mut a, lowered);
            a.double(Gpr::R9);
        }
        let again = a.here();
        let (mut a, result) = body(a);
        let strides: Vec<(Gpr, i32)> = std::iter::once((Gpr::Rdi, 64 * self.inputs))
            .chain(self.parts().map(|(_, base, outputs)| (base, 64 * outputs)))
            .collect();
        match self.width {
            Width::Avx512 => {
                for (base, stride) in strides {
                    a.add(base, stride);
                }
            }
            Width::Avx2 => {
                // An even number of halves remains: this was the first half.
                a.test_odd(Gpr::R9);
                let first = a.jump(Condition::Zero);
                for (base, stride) in &strides {
                    a.add(*base, stride - 64);
                }
                a.bind(first);
                for (base, _) in strides {
                    a.add(base, 32);
                }
            }
        }
        a.decrement(Gpr::R9);
        a.jump_back(Condition::NotZero, again);
        a.zero_upper();
        a.ret();
        (a, result)
    }

    fn spread_uniforms(&self, a: &mut Assembler, lowered: &LoweredProgram) {
        for k in 0..self.uniforms {
            let name = self.names.uniforms + k as Name;
            if lowered.first[name as usize] != NEVER || lowered.outputs.contains(&name) {
                a.load(0, self.at(Gpr::Rsi, 8 * k, true));
                a.store(self.scratch(self.uniform(k)), 0);
            }
        }
    }
}

/// Emits a call of `function(cell, argument)`, which can change all vector registers.
pub fn call(a: &mut Assembler, cell: Memory, argument: u64, function: u64) {
    a.zero_upper();
    for r in SAVED {
        a.push(r);
    }
    // With the return address these are nine words; one more aligns the stack to 16 bytes.
    a.add(Gpr::Rsp, -8);
    a.address(Gpr::Rdi, cell.base, cell.offset);
    a.set(Gpr::Rsi, argument);
    a.set(Gpr::Rax, function);
    a.call(Gpr::Rax);
    a.add(Gpr::Rsp, 8);
    for r in SAVED.into_iter().rev() {
        a.pop(r);
    }
}
