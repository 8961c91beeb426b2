//! Limits of code, and programs that it rejects.

use hardpoint_code::{Code, PARTS, Scratch, UnsupportedProgram, Width};
use hardpoint_tape::{Call, Instruction, LANES, Lanes, Operand, Program};

use crate::plain;
use crate::random::{self, Random, Shape};

fn two_inputs_one_uniform_two_outputs() -> Program {
    Program {
        inputs: 2,
        uniforms: 1,
        instructions: vec![Instruction::MulAdd(Operand::Input(0), Operand::Input(1), Operand::Uniform(0))],
        outputs: vec![Operand::Value(0), Operand::Input(0)],
        ..Program::default()
    }
}

/// Panic message of `run` for these numbers of inputs, uniforms and outputs; `None` if it runs.
fn panic_message(inputs: usize, uniforms: usize, outputs: usize) -> Option<String> {
    let code = Code::new(&two_inputs_one_uniform_two_outputs()).expect("machine code is here");
    let run = || {
        let mut outputs = vec![[0.0; LANES]; outputs];
        code.run(&mut Scratch::default(), &vec![[0.0; LANES]; inputs], &vec![0.0; uniforms], &mut outputs);
    };
    let caught = std::panic::catch_unwind(run).err()?;
    Some(caught.downcast_ref::<String>().expect("a message").lines().next().unwrap().to_string())
}

fn is_available() -> bool {
    Width::ALL.into_iter().any(Width::is_available)
}

#[test]
fn arrays_of_wrong_lengths_panic() {
    if !is_available() {
        return;
    }
    assert_eq!([panic_message(0, 1, 0), panic_message(2, 1, 2), panic_message(6, 1, 6)], [None, None, None]);
    const UNIFORMS: &str = "the number of uniforms differs from that of the program";
    const INPUTS: &str = "inputs and outputs have different numbers of groups";
    const OUTPUTS: &str = "the number of outputs is not a multiple of that of the program";
    for (inputs, uniforms, outputs, about) in [
        (2, 0, 2, UNIFORMS),
        (2, 2, 2, UNIFORMS),
        (0, 0, 0, UNIFORMS),
        (1, 1, 2, INPUTS),
        (3, 1, 2, INPUTS),
        (2, 1, 4, INPUTS),
        (2, 1, 0, INPUTS),
        (2, 1, 1, OUTPUTS),
        (0, 1, 1, OUTPUTS),
        (2, 1, 3, OUTPUTS),
        (4, 1, 3, OUTPUTS),
    ] {
        let panic_message = panic_message(inputs, uniforms, outputs);
        assert!(
            panic_message.as_ref().is_some_and(|s| s.contains(about)),
            "{inputs}, {uniforms}, {outputs}: {panic_message:?}"
        );
    }
}

/// Panic message of `run_in_parts` for code with these ends of parts and arrays of these lengths; `None` if it runs.
fn panic_message_in_parts(
    ends: [usize; PARTS - 1],
    inputs: usize,
    lengths: [usize; PARTS],
) -> Option<String> {
    let program = two_inputs_one_uniform_two_outputs();
    let code = Code::in_parts(&program, ends).expect("machine code is here");
    let run = || {
        let mut outputs = lengths.map(|n| vec![[0.0; LANES]; n]);
        code.run_in_parts(
            &mut Scratch::default(),
            &vec![[0.0; LANES]; inputs],
            &[0.0],
            outputs.each_mut().map(Vec::as_mut_slice),
        );
    };
    let caught = std::panic::catch_unwind(run).err()?;
    Some(caught.downcast_ref::<String>().expect("a message").lines().next().unwrap().to_string())
}

#[test]
fn parts_of_wrong_lengths_panic() {
    if !is_available() {
        return;
    }
    for (ends, inputs, lengths) in [
        ([1, 2], 0, [0, 0, 0]),
        ([1, 2], 6, [3, 3, 0]),
        ([0, 1], 4, [0, 2, 2]),
        ([1, 1], 2, [1, 0, 1]),
        ([0, 0], 4, [0, 0, 4]),
        ([2, 2], 4, [4, 0, 0]),
    ] {
        assert_eq!(panic_message_in_parts(ends, inputs, lengths), None, "{ends:?}, {inputs}, {lengths:?}");
    }
    const EMPTY: &str = "outputs are given for a part without outputs";
    const WHOLE: &str = "the number of outputs is not a multiple of that of the program";
    const DIFFERENT: &str = "parts of the outputs have different numbers of groups";
    const INPUTS: &str = "inputs and outputs have different numbers of groups";
    for (ends, inputs, lengths, about) in [
        ([1, 2], 2, [1, 1, 1], EMPTY),
        ([0, 1], 2, [1, 1, 1], EMPTY),
        ([2, 2], 0, [0, 0, 2], EMPTY),
        ([0, 2], 2, [0, 3, 0], WHOLE),
        ([0, 0], 0, [0, 0, 1], WHOLE),
        ([1, 2], 2, [1, 2, 0], DIFFERENT),
        ([1, 2], 4, [2, 1, 0], DIFFERENT),
        ([1, 2], 2, [1, 0, 0], DIFFERENT),
        ([1, 1], 2, [0, 0, 1], DIFFERENT),
        ([1, 2], 2, [2, 2, 0], INPUTS),
        ([0, 1], 2, [0, 0, 0], INPUTS),
    ] {
        let panic_message = panic_message_in_parts(ends, inputs, lengths);
        assert!(
            panic_message.as_ref().is_some_and(|s| s.contains(about)),
            "{ends:?}, {inputs}, {lengths:?}: {panic_message:?}"
        );
    }
}

#[test]
fn code_for_several_parts_does_not_run_in_one() {
    if !is_available() {
        return;
    }
    let program = two_inputs_one_uniform_two_outputs();
    for ends in [[1, 2], [1, 1], [0, 2], [0, 0]] {
        let code = Code::in_parts(&program, ends).expect("machine code is here");
        let run = || {
            let mut outputs = [[0.0; LANES]; 2];
            code.run(&mut Scratch::default(), &[[0.0; LANES]; 2], &[0.0], &mut outputs);
        };
        assert!(std::panic::catch_unwind(run).is_err(), "{ends:?}");
    }
}

#[test]
fn parts_that_end_nowhere_are_refused() {
    if !is_available() {
        return;
    }
    let program = two_inputs_one_uniform_two_outputs();
    for [first, second] in [[2, 1], [1, 3], [3, 3], [0, usize::MAX], [usize::MAX, 2]] {
        let caught = std::panic::catch_unwind(|| Code::in_parts(&program, [first, second]))
            .expect_err("it is refused");
        let panic_message = caught.downcast_ref::<String>().expect("a message");
        assert!(
            panic_message.starts_with(&format!("parts of 2 outputs end at {first} and {second}: ")),
            "{panic_message}"
        );
    }
}

#[test]
fn operands_that_do_not_exist_are_refused() {
    let Some(width) = Width::ALL.into_iter().find(|w| w.is_available()) else { return };
    let one = |o| Instruction::Neg(o);
    let good = two_inputs_one_uniform_two_outputs();
    for wrong in [
        // Its own result, and a later one.
        one(Operand::Value(1)),
        one(Operand::Value(7)),
        one(Operand::Input(2)),
        one(Operand::Uniform(1)),
        one(Operand::Constant(0)),
        Instruction::MulAdd(Operand::Value(0), Operand::Value(0), Operand::Value(1)),
        Instruction::Larger(Operand::Value(0), Operand::Input(u32::MAX)),
        Instruction::Call(Call::Pow, Operand::Value(0), Operand::Value(1)),
    ] {
        let mut program = good.clone();
        program.instructions.push(wrong);
        let caught = std::panic::catch_unwind(|| Code::with(&program, width)).expect_err("it is refused");
        let panic_message = caught.downcast_ref::<String>().expect("a message");
        assert!(panic_message.starts_with("instruction 1 reads "), "{panic_message}");
    }
    let mut program = good.clone();
    program.outputs.push(Operand::Value(1));
    let caught = std::panic::catch_unwind(|| Code::with(&program, width)).expect_err("it is refused");
    assert!(caught.downcast_ref::<String>().expect("a message").starts_with("output 2 reads "));

    // Ignored operands need not exist.
    let mut program = good;
    program.instructions.push(Instruction::Call(Call::Tan, Operand::Value(0), Operand::Value(9)));
    assert!(Code::with(&program, width).is_ok());
}

#[test]
fn programs_too_large_for_offsets_are_refused_in_words() {
    let Some(width) = Width::ALL.into_iter().find(|w| w.is_available()) else { return };
    let program = Program { inputs: usize::MAX, ..Program::default() };
    let refused = Code::with(&program, width).expect_err("it is refused");
    assert_eq!(refused, UnsupportedProgram::Size { what: "inputs", count: usize::MAX });
    assert_eq!(
        refused.to_string(),
        "the program has 18446744073709551615 inputs, more than machine code supports (4194304)"
    );
}

#[test]
fn every_reason_is_a_sentence() {
    for (reason, text) in [
        (UnsupportedProgram::Target, "machine code requires x86-64 and a Unix system"),
        (UnsupportedProgram::Cpu, "the CPU has neither AVX2 with fused multiplication nor AVX-512"),
        (UnsupportedProgram::Width(Width::Avx512), "the CPU has no AVX-512"),
    ] {
        assert_eq!(reason.to_string(), text);
    }
    let text = UnsupportedProgram::Memory { error: 13 }.to_string();
    assert!(text.starts_with("the system does not allow executable memory ("), "{text}");
}

/// A missing width has the right reason.
#[test]
fn code_is_made_where_it_can_be() {
    let program = two_inputs_one_uniform_two_outputs();
    let made = Code::new(&program).map(|c| c.width());
    let target = cfg!(all(target_arch = "x86_64", unix));
    match Width::ALL.into_iter().rev().find(|w| w.is_available()) {
        Some(widest) => assert_eq!(made, Ok(widest)),
        None => {
            assert_eq!(made, Err(if target { UnsupportedProgram::Cpu } else { UnsupportedProgram::Target }))
        }
    }
    for width in Width::ALL.into_iter().filter(|w| !w.is_available()) {
        let reason = if target { UnsupportedProgram::Width(width) } else { UnsupportedProgram::Target };
        assert_eq!(Code::with(&program, width).err(), Some(reason));
    }
}

#[test]
fn nothing_beside_the_outputs_is_written_wherever_they_begin() {
    let mut random = Random(20);
    for turn in 0..60 {
        let shape = Shape {
            inputs: 1 + random.below(5),
            uniforms: random.below(5),
            constants: random.below(5),
            instructions: [5, 100, 600][turn % 3],
            outputs: 1 + random.below(9),
            near: 200,
            calls: [0, 30][turn % 2],
            wild: false,
        };
        let program = random::program(&mut random, shape);
        let groups = 1 + random.below(3);
        let uniforms: Vec<f64> = (0..program.uniforms).map(|_| random.tame()).collect();
        // Groups of lanes need not be aligned to vectors: eight offsets, one scalar apart.
        let shift = turn % LANES;
        let inputs: Vec<f64> = (0..shift + LANES * groups * program.inputs).map(|_| random.tame()).collect();
        let inputs = inputs[shift..].as_chunks().0;
        let expected = plain::evaluate(&program, groups, inputs, &uniforms);
        for width in Width::ALL.into_iter().filter(|w| w.is_available()) {
            const MARK: f64 = 987.654;
            const MARGIN: usize = 100;
            let mut all = vec![MARK; 2 * MARGIN + shift + LANES * expected.len()];
            let inside = MARGIN + shift..MARGIN + shift + LANES * expected.len();
            let code = Code::with(&program, width).expect("the width is here");
            let outputs = all[inside.clone()].as_chunks_mut().0;
            code.run(&mut Scratch::default(), inputs, &uniforms, outputs);
            let same = |(y, e): (&f64, &f64)| y.to_bits() == e.to_bits() || y.is_nan() && e.is_nan();
            assert!(all[inside.clone()].iter().zip(expected.as_flattened()).all(same), "{width}");
            assert!(all[..inside.start].iter().chain(&all[inside.end..]).all(|x| *x == MARK), "{width}");

            // Outputs in parts, with margins between them, the last one first.
            let ends = random::ends(&mut random, program.outputs.len());
            let expected = plain::parts(&program, ends, &expected);
            let code = Code::in_parts_with(&program, ends, width).expect("the width is here");
            let mut all =
                vec![
                    MARK;
                    shift + (PARTS + 1) * MARGIN + LANES * expected.iter().map(Vec::len).sum::<usize>()
                ];
            let mut rest = &mut all[shift..];
            let mut outputs: [&mut [Lanes]; PARTS] = Default::default();
            for (part, expected) in outputs.iter_mut().zip(&expected).rev() {
                let (inside, behind) = rest[MARGIN..].split_at_mut(LANES * expected.len());
                *part = inside.as_chunks_mut().0;
                rest = behind;
            }
            code.run_in_parts(&mut Scratch::default(), inputs, &uniforms, outputs);
            let mut from = shift;
            for expected in expected.iter().rev() {
                let inside = from + MARGIN..from + MARGIN + LANES * expected.len();
                assert!(all[from..inside.start].iter().all(|x| *x == MARK), "{width}, ends {ends:?}");
                assert!(
                    all[inside.clone()].iter().zip(expected.as_flattened()).all(same),
                    "{width}, ends {ends:?}"
                );
                from = inside.end;
            }
            assert!(all[from..].iter().all(|x| *x == MARK), "{width}, ends {ends:?}");
        }
    }
}

/// Number of executable bytes of anonymous mappings, from Linux.
#[cfg(target_os = "linux")]
fn executable_bytes() -> usize {
    let maps = std::fs::read_to_string("/proc/self/maps").expect("Linux has it");
    let of_no_file = maps.lines().filter(|l| l.contains("r-xp 00000000 00:00 0") && !l.contains('['));
    let size = |line: &str| {
        let (from, to) = line.split_once(' ')?.0.split_once('-')?;
        Some(usize::from_str_radix(to, 16).ok()? - usize::from_str_radix(from, 16).ok()?)
    };
    of_no_file.map(|l| size(l).expect("two addresses")).sum()
}

#[test]
#[cfg(target_os = "linux")]
fn dropped_code_gives_its_pages_back() {
    let Some(width) = Width::ALL.into_iter().find(|w| w.is_available()) else { return };
    let program = two_inputs_one_uniform_two_outputs();
    let before = executable_bytes();
    for _ in 0..5000 {
        let again = Code::with(&program, width).expect("the width is here");
        let mut outputs = [[0.0; LANES]; 2];
        again.run(&mut Scratch::default(), &[[3.0; LANES], [2.0; LANES]], &[1.0], &mut outputs);
        assert_eq!(outputs, [[7.0; LANES], [3.0; LANES]]);
    }
    // 5000 pages are 20 MB; the code of other tests at the same time is a few programs of 0.2 MB at the most.
    let after = executable_bytes();
    assert!(after < before + (8 << 20), "{before} bytes before, {after} after");
}

/// Pages are never writable and executable at once.
#[test]
#[cfg(target_os = "linux")]
fn no_page_is_writable_and_executable() {
    let Some(width) = Width::ALL.into_iter().find(|w| w.is_available()) else { return };
    let code = Code::with(&two_inputs_one_uniform_two_outputs(), width).expect("the width is here");
    let maps = std::fs::read_to_string("/proc/self/maps").expect("Linux has it");
    assert!(executable_bytes() >= code.counts().bytes, "the code is among them:\n{maps}");
    assert!(maps.lines().all(|l| !l.contains("wx")), "{maps}");
}
