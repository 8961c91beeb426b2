//! Machine code of a program, in executable memory.

use super::allocate::Allocator;
use super::check;
use super::frame::Frame;
use super::lower::LoweredProgram;
use super::memory::Executable;
use crate::{Counts, Line, PARTS, UnsupportedProgram, Width};
use hardpoint_tape::{LANES, Lanes, Program};
use std::ffi::c_void;

/// Machine code as a function of inputs, uniforms, addresses of the output parts, scratch, constants, and number of
/// groups.
///
/// Reads `groups` times the program's inputs, its uniforms and constants, and the addresses of parts that are not
/// empty; writes and reads `groups` times the outputs of each such part there, and the scratch.
type Entry = unsafe extern "sysv64" fn(
    *const Lanes,
    *const f64,
    *const [*mut Lanes; PARTS],
    *mut Line,
    *const Line,
    usize,
);

/// Executable code.
#[derive(Debug)]
pub struct Machine {
    executable: Executable,
    /// Constants, replicated to the width of the code, followed by the sign masks.
    constants: Vec<Line>,
    /// Scratch memory of a run.
    scratch: usize,
    inputs: usize,
    uniforms: usize,
    /// Sizes of the parts.
    outputs: [usize; PARTS],
}

/// Returns the widest available width.
pub fn widest() -> Result<Width, UnsupportedProgram> {
    Width::ALL.into_iter().rev().find(|w| has(*w)).ok_or(UnsupportedProgram::Cpu)
}

/// Returns true if the CPU and the system support a width.
pub fn has(width: Width) -> bool {
    match width {
        Width::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"),
        // DQ has the bitwise operations on doubles.
        Width::Avx512 => is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq"),
    }
}

impl Machine {
    pub fn new(
        program: &Program,
        ends: [usize; PARTS - 1],
        width: Width,
    ) -> Result<(Self, Counts), UnsupportedProgram> {
        if !has(width) {
            return Err(UnsupportedProgram::Width(width));
        }
        check::size(program)?;
        check::operands(program);
        let outputs = check::parts(program, ends);
        let (bytes, frame, counts) = emit(program, outputs, width);
        let executable =
            Executable::new(&bytes).map_err(|e| UnsupportedProgram::Memory { error: e.raw_os_error() })?;
        let machine = Self {
            executable,
            constants: spread(&program.constants, frame.constant_bytes() as usize / size_of::<f64>()),
            scratch: frame.scratch_bytes(counts.slots).div_ceil(size_of::<Line>()),
            inputs: program.inputs,
            uniforms: program.uniforms,
            outputs,
        };
        Ok((machine, counts))
    }

    pub fn run(
        &self,
        scratch: &mut Vec<Line>,
        inputs: &[Lanes],
        uniforms: &[f64],
        outputs: [&mut [Lanes]; PARTS],
    ) {
        assert_eq!(uniforms.len(), self.uniforms, "the number of uniforms differs from that of the program");
        let Some(groups) = self.groups(outputs.each_ref().map(|part| part.len())) else { return };
        assert_eq!(
            Some(inputs.len()),
            groups.checked_mul(self.inputs),
            "inputs and outputs have different numbers of groups"
        );
        if groups == 0 {
            return;
        }
        if scratch.len() < self.scratch {
            scratch.resize(self.scratch, Line::default());
        }
        let parts = outputs.map(<[Lanes]>::as_mut_ptr);
        let start = self.executable.start();
        // SAFETY: the pages hold, from their first byte on, a function of this type, and live as long as `self`.
        let entry = unsafe { std::mem::transmute::<*const c_void, Entry>(start) };
        // SAFETY: the code reads and writes only the arrays of `Entry`: the operands were checked when it was made. All
        // arrays are long enough: the lengths of inputs and of every part of the outputs were checked above; constants
        // and scratch were made with theirs. The parts are borrowed mutably, and outlive their addresses. The CPU has
        // the instructions, which was checked when the code was made. There is at least one group.
        unsafe {
            entry(
                inputs.as_ptr(),
                uniforms.as_ptr(),
                &raw const parts,
                scratch.as_mut_ptr(),
                self.constants.as_ptr(),
                groups,
            );
        }
    }

    /// Returns the number of groups in parts of these lengths; `None` if the program has no outputs.
    fn groups(&self, lengths: [usize; PARTS]) -> Option<usize> {
        let mut groups = None;
        for (length, outputs) in lengths.into_iter().zip(self.outputs) {
            let Some(whole) = length.checked_div(outputs) else {
                assert_eq!(length, 0, "outputs are given for a part without outputs");
                continue;
            };
            assert_eq!(
                length,
                whole * outputs,
                "the number of outputs is not a multiple of that of the program"
            );
            assert_eq!(
                whole,
                *groups.get_or_insert(whole),
                "parts of the outputs have different numbers of groups"
            );
        }
        groups
    }
}

/// Returns the constants, `times` times each, followed by the sign masks, in the order of `lower::Names`.
fn spread(constants: &[f64], times: usize) -> Vec<Line> {
    let masks = [f64::from_bits(1 << 63), f64::from_bits(!(1 << 63))];
    let all: Vec<f64> = constants.iter().chain(&masks).flat_map(|c| std::iter::repeat_n(*c, times)).collect();
    let mut lines = vec![Line::default(); all.len().div_ceil(LANES)];
    for (line, numbers) in lines.iter_mut().zip(all.chunks(LANES)) {
        line.0[..numbers.len()].copy_from_slice(numbers);
    }
    lines
}

/// Returns the bytes of the code for these numbers of outputs in each part.
pub(super) fn emit(program: &Program, outputs: [usize; PARTS], width: Width) -> (Vec<u8>, Frame, Counts) {
    let lowered = LoweredProgram::new(program);
    let frame = Frame::new(program, outputs, lowered.names, width);
    let (assembler, counts) =
        frame.around(&lowered, |assembler| Allocator::new(&lowered, frame, assembler).run());
    let counts = Counts { instructions: assembler.count, bytes: assembler.bytes.len(), ..counts };
    (assembler.bytes, frame, counts)
}
