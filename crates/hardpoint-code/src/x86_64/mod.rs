//! Code for x86-64, on systems that map memory as Unix does.

mod allocate;
mod calls;
mod encoder;
mod frame;
mod lower;
mod memory;

use std::ffi::c_void;

use hardpoint_tape::{Lanes, Program};

use crate::{Counts, Line, Unsupported, Width};
use allocate::Allocator;
use frame::Frame;
use lower::Lowered;
use memory::Executable;

/// Machine code as a function: inputs, uniforms, outputs, scratch, constants, groups.
///
/// Reads `groups` times the program's inputs, its uniforms and constants; writes `groups` times its outputs and the scratch.
type Entry = unsafe extern "sysv64" fn(*const Lanes, *const f64, *mut Lanes, *mut Line, *const Line, usize);

/// Code that can be run.
#[derive(Debug)]
pub struct Machine {
    executable: Executable,
    /// As wide as the code wants them, with the masks for signs.
    constants: Vec<Line>,
    /// How much scratch a run needs.
    scratch: usize,
}

/// The widest that this CPU has.
pub fn widest() -> Option<Width> {
    Width::ALL.into_iter().rev().find(|w| has(*w))
}

/// Whether CPU and system have it.
pub fn has(width: Width) -> bool {
    match width {
        Width::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"),
        // The bits of doubles are combined by DQ.
        Width::Avx512 => is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq"),
    }
}

impl Machine {
    /// Expects a program that has been checked, and a width that the CPU has.
    pub fn new(program: &Program, width: Width) -> Result<(Self, Counts), Unsupported> {
        let (bytes, frame, counts) = emit(program, width);
        let executable =
            Executable::new(&bytes).map_err(|e| Unsupported::Memory { error: e.raw_os_error() })?;
        let masks = [f64::from_bits(1 << 63), f64::from_bits(!(1 << 63))];
        let all = program.constants.iter().chain(&masks);
        let each = frame.constant_bytes() as usize / size_of::<f64>();
        let wide: Vec<f64> = all.flat_map(|c| std::iter::repeat_n(*c, each)).collect();
        let constants = wide
            .chunks(8)
            .map(|c| {
                let mut line = Line::default();
                line.0[..c.len()].copy_from_slice(c);
                line
            })
            .collect();
        let scratch = frame.scratch_bytes(counts.slots).div_ceil(size_of::<Line>());
        Ok((Self { executable, constants, scratch }, counts))
    }

    /// How much scratch a run needs.
    pub fn scratch(&self) -> usize {
        self.scratch
    }

    /// Expects lengths that have been checked, and at least one group.
    pub fn run(
        &self,
        groups: usize,
        inputs: &[Lanes],
        uniforms: &[f64],
        outputs: &mut [Lanes],
        scratch: &mut [Line],
    ) {
        assert!(groups > 0 && scratch.len() >= self.scratch, "there is something to do, and room for it");
        let start = self.executable.start();
        // SAFETY: the pages hold, from their first byte on, a function of this type, and live as long as `self`.
        let entry = unsafe { std::mem::transmute::<*const c_void, Entry>(start) };
        // SAFETY: the code reads and writes what `Entry` says: the operands were checked when it was made, the lengths
        // by the caller and above. The CPU has the instructions, also checked when it was made.
        unsafe {
            entry(
                inputs.as_ptr(),
                uniforms.as_ptr(),
                outputs.as_mut_ptr(),
                scratch.as_mut_ptr(),
                self.constants.as_ptr(),
                groups,
            );
        }
    }
}

/// The bytes of the code.
fn emit(program: &Program, width: Width) -> (Vec<u8>, Frame, Counts) {
    let lowered = Lowered::new(program);
    let frame = Frame::new(program, lowered.names, width);
    let (assembler, counts) =
        frame.around(&lowered, |assembler| Allocator::new(&lowered, frame, assembler).run());
    let counts = Counts { instructions: assembler.count, bytes: assembler.bytes.len(), ..counts };
    (assembler.bytes, frame, counts)
}

#[cfg(test)]
mod tests;
