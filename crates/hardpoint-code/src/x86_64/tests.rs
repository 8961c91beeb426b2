//! Memory accesses of the code of random programs, read back by a decoder.

#[path = "../../tests/it/random.rs"]
mod random;

use std::collections::HashSet;

use iced_x86::{Decoder, DecoderOptions, InstructionInfoFactory, Mnemonic, OpAccess, Register};

use super::check;
use super::machine::emit;
use crate::{PARTS, Width};
use hardpoint_tape::{Lanes, Program};
use random::{Random, Shape};

/// Bytes that an instruction may access, relative to the register.
struct Region {
    base: Register,
    bytes: i64,
    written: bool,
}

/// Every operand in memory is in an array whose length `run` has checked, and only outputs and scratch memory are
/// written. Slots and outputs are written before they are read. Addresses of empty parts are not read.
fn holds(program: &Program, ends: [usize; PARTS - 1], width: Width) {
    let outputs = check::parts(program, ends);
    let (bytes, frame, counts) = emit(program, outputs, width);
    let region = |base, bytes: usize, written| Region { base, bytes: bytes as i64, written };
    let vectors = |n: usize| n * size_of::<Lanes>();
    // What AVX2 sees of a group begins at its first or its fifth lane: the last half is four lanes shorter.
    let half = if width == Width::Avx2 { 32 } else { 0 };
    let regions = [
        region(Register::RDI, vectors(program.inputs).saturating_sub(half), false),
        region(Register::RSI, 8 * program.uniforms, false),
        region(Register::RCX, frame.scratch_bytes(counts.slots), true),
        region(Register::R8, (program.constants.len() + 2) * frame.constant_bytes() as usize, false),
        region(Register::RDX, vectors(outputs[0]).saturating_sub(half), true),
        region(Register::R10, vectors(outputs[1]).saturating_sub(half), true),
        region(Register::R11, vectors(outputs[2]).saturating_sub(half), true),
    ];
    let used: Vec<usize> = (0..PARTS).filter(|p| outputs[*p] > 0).collect();
    // The entry finds the parts, the first one last, and moves every base ahead.
    let mut found = used.iter().rev();
    let mut moved = (0..4).chain(used.iter().map(|p| 4 + p));
    let mut ahead = [0; 7];
    let mut factory = InstructionInfoFactory::new();
    let mut known = HashSet::new();
    let mut touched = 0;
    for i in &mut Decoder::with_ip(64, &bytes, 0, DecoderOptions::NONE) {
        assert!(!i.is_invalid());
        if let Some(p) = found.next() {
            assert_eq!((i.mnemonic(), i.op0_register()), (Mnemonic::Mov, regions[4 + p].base));
            assert_eq!((i.memory_base(), i.memory_index()), (Register::RDX, Register::None));
            assert_eq!((i.memory_displacement64(), i.memory_size().size()), (8 * *p as u64, 8));
            continue;
        }
        if let Some(k) = moved.next() {
            assert_eq!((i.mnemonic(), i.op0_register()), (Mnemonic::Add, regions[k].base));
            ahead[k] = i.immediate32to64();
            continue;
        }
        for memory in factory.info(&i).used_memory() {
            let stack =
                matches!(i.mnemonic(), Mnemonic::Push | Mnemonic::Pop | Mnemonic::Call | Mnemonic::Ret);
            if stack {
                assert_eq!(memory.base(), Register::RSP);
                continue;
            }
            let (k, region) =
                regions.iter().enumerate().find(|(_, r)| r.base == memory.base()).expect("a base of ours");
            let from = memory.displacement() as i64 + ahead[k];
            let to = from + memory.memory_size().size() as i64;
            assert!(0 <= from && to <= region.bytes, "{i} touches {from}..{to} of {}", region.bytes);
            assert_eq!(memory.index(), Register::None);
            let written = memory.access() == OpAccess::Write;
            assert!(region.written || !written, "{i} writes to what it may only read");
            if written {
                known.insert((k, from));
            } else if region.written && i.mnemonic() != Mnemonic::Lea {
                assert!(known.contains(&(k, from)), "{i} reads what nobody has written");
            }
            touched += 1;
        }
    }
    for (p, outputs) in outputs.into_iter().enumerate() {
        let all = (0..outputs).all(|j| known.contains(&(4 + p, 64 * j as i64)));
        assert!(all, "every output is written");
    }
    assert!(touched >= program.outputs.len());
}

#[test]
fn code_touches_only_what_it_is_given() {
    let mut random = Random(1);
    for instructions in [0, 1, 2, 5, 20, 100, 400, 3000] {
        for (near, calls) in [(3, 0), (30, 0), (3000, 0), (300, 20)] {
            for width in Width::ALL {
                let shape = Shape {
                    inputs: 1 + random.below(400),
                    uniforms: random.below(400),
                    constants: random.below(400),
                    instructions,
                    outputs: random.below(100),
                    near,
                    calls,
                    wild: true,
                };
                let program = random::program(&mut random, shape);
                holds(&program, [shape.outputs; PARTS - 1], width);
                holds(&program, random::ends(&mut random, shape.outputs), width);
            }
        }
    }
}
