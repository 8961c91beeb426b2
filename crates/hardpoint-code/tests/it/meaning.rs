//! Comparison bit for bit with a plain evaluation, one scalar at a time.

use hardpoint_code::{Code, Counts, Scratch, Width};
use hardpoint_tape::{Instruction, Interpreter, LANES, Lanes, Operand, Program};

use crate::plain;
use crate::random::{self, CALLS, Random, Shape};

/// Inputs and uniforms for a number of groups.
fn data(random: &mut Random, program: &Program, groups: usize, wild: bool) -> (Vec<Lanes>, Vec<f64>) {
    let mut number = || if wild { random.wild() } else { random.tame() };
    let inputs = (0..groups * program.inputs).map(|_| [(); LANES].map(|()| number())).collect();
    (inputs, (0..program.uniforms).map(|_| number()).collect())
}

/// Bits of a number, with all NaNs equal.
fn bits(x: f64) -> u64 {
    if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() }
}

/// Checks the code of this program for every available width, with outputs in one part and in several: all outputs must
/// be those of `plain::evaluate`. Returns the number of finite outputs, and the statistics of the widest code.
fn holds(program: &Program, groups: usize, inputs: &[Lanes], uniforms: &[f64]) -> (usize, Counts) {
    let expected = plain::evaluate(program, groups, inputs, uniforms);
    let seed = inputs.first().map_or(program.outputs.len() as u64, |x| x[0].to_bits());
    let ends = random::ends(&mut Random(seed), program.outputs.len());
    let expected_in_parts = plain::parts(program, ends, &expected);
    let mut counts = Counts::default();
    let mut scratch = Scratch::default();
    for width in Width::ALL.into_iter().filter(|w| w.is_available()) {
        let code = Code::with(program, width).expect("the width is here");
        let mut outputs = vec![[1234.5; LANES]; expected.len()];
        code.run(&mut scratch, inputs, uniforms, &mut outputs);
        for (k, (y, e)) in outputs.iter().zip(&expected).enumerate() {
            assert_eq!(
                y.map(bits),
                e.map(bits),
                "{width}, output {k} of {}: {y:?} for {e:?}",
                program.outputs.len()
            );
        }
        counts = code.counts();

        let code = Code::in_parts_with(program, ends, width).expect("the width is here");
        let mut outputs = expected_in_parts.each_ref().map(|part| vec![[1234.5; LANES]; part.len()]);
        code.run_in_parts(&mut scratch, inputs, uniforms, outputs.each_mut().map(Vec::as_mut_slice));
        for (p, (outputs, expected)) in outputs.iter().zip(&expected_in_parts).enumerate() {
            for (k, (y, e)) in outputs.iter().zip(expected).enumerate() {
                assert_eq!(
                    y.map(bits),
                    e.map(bits),
                    "{width}, output {k} of part {p}, ends {ends:?}: {y:?} for {e:?}"
                );
            }
        }
    }
    (expected.as_flattened().iter().filter(|x| x.is_finite()).count(), counts)
}

/// True if there is anything to test.
fn is_available() -> bool {
    Width::ALL.into_iter().any(Width::is_available)
}

#[test]
fn random_programs_compute_their_operations() {
    let mut random = Random(0);
    let (mut finite, mut all) = (0, 0);
    for (instructions, programs) in [
        (1, 200),
        (2, 200),
        (3, 200),
        (5, 200),
        (10, 200),
        (30, 100),
        (100, 60),
        (300, 30),
        (1000, 12),
        (5000, 4),
    ] {
        for p in 0..programs {
            let shape = Shape {
                inputs: random.below(12),
                uniforms: random.below(12),
                constants: 1 + random.below(12),
                instructions,
                outputs: 1 + random.below(20.max(instructions / 10)),
                near: [2, 8, 40, 400, 5000][random.below(5)],
                calls: [0, 0, 0, 40][random.below(4)],
                wild: p % 4 == 0,
            };
            let program = random::program(&mut random, shape);
            let groups = 1 + random.below(3);
            let (inputs, uniforms) = data(&mut random, &program, groups, p % 4 == 0);
            finite += holds(&program, groups, &inputs, &uniforms).0;
            all += groups * LANES * program.outputs.len();
        }
    }
    assert!(finite > all / 2, "{finite} of {all} are finite: too few to show anything");
}

#[test]
fn every_instruction_takes_every_kind_of_operand_in_every_place() {
    let mut random = Random(1);
    // Two of each kind; the values are in registers when they are read.
    let kinds = [Operand::Value, Operand::Input, Operand::Uniform, Operand::Constant];
    let operands: Vec<Operand> = kinds.iter().flat_map(|k| [k(0), k(1)]).collect();
    for a in &operands {
        for b in &operands {
            for c in &operands {
                let numbers = || [1.5, -2.25];
                let program = Program {
                    inputs: 2,
                    uniforms: 2,
                    constants: numbers().to_vec(),
                    instructions: [
                        Instruction::Add(Operand::Input(0), Operand::Constant(0)),
                        Instruction::Sub(Operand::Uniform(0), Operand::Input(1)),
                    ]
                    .into_iter()
                    .chain(random::plain(*a, *b, *c))
                    .chain(CALLS.map(|call| Instruction::Call(call, *a, *b)))
                    .collect(),
                    outputs: (0..26).map(Operand::Value).collect(),
                };
                let (inputs, uniforms) = data(&mut random, &program, 1, false);
                holds(&program, 1, &inputs, &uniforms);
                // Alone, so that both operands are read for the last time.
                for instruction in random::plain(*a, *b, *c) {
                    let mut alone = program.clone();
                    alone.instructions.truncate(2);
                    alone.instructions.push(instruction);
                    alone.outputs = vec![Operand::Value(2)];
                    holds(&alone, 1, &inputs, &uniforms);
                }
            }
        }
    }
}

#[test]
fn special_numbers_meet_in_every_instruction() {
    let mut random = Random(2);
    let [a, b, c] = [0, 1, 2].map(Operand::Input);
    let mut instructions = random::plain(a, b, c).to_vec();
    instructions.extend(CALLS.map(|call| Instruction::Call(call, a, b)));
    let outputs = (0..instructions.len() as u32).map(Operand::Value).collect();
    let program = Program { inputs: 3, instructions, outputs, ..Program::default() };
    let (inputs, _) = data(&mut random, &program, 3000, true);
    holds(&program, 3000, &inputs, &[]);
}

/// The larger of zeros of different signs may be either, and its inverse either infinity: programs with `Larger` are
/// compared by that result alone.
#[test]
fn code_and_interpreter_agree() {
    let mut random = Random(9);
    for turn in 0..120 {
        let shape = Shape {
            inputs: 1 + random.below(12),
            uniforms: random.below(12),
            constants: random.below(12),
            instructions: [1, 3, 10, 40, 200, 2000][turn % 6],
            outputs: 1 + random.below(60),
            near: [2, 8, 40, 400][random.below(4)],
            calls: [0, 0, 0, 40][random.below(4)],
            wild: turn % 3 == 0,
        };
        let mut program = random::program(&mut random, shape);
        let last = program.instructions.len() as u32 - 1;
        for instruction in &mut program.instructions {
            if let Instruction::Larger(a, b) = *instruction {
                *instruction = Instruction::Sub(a, b);
            }
        }
        program.instructions.push(Instruction::Larger(Operand::Value(last), Operand::Input(0)));
        program.outputs.push(Operand::Value(last + 1));
        let groups = 1 + random.below(9);
        let (inputs, uniforms) = data(&mut random, &program, groups, turn % 3 == 0);
        let mut expected = vec![[0.0; LANES]; groups * program.outputs.len()];
        Interpreter::new(&program).run(&inputs, &uniforms, &mut expected);
        for width in Width::ALL.into_iter().filter(|w| w.is_available()) {
            let mut outputs = vec![[0.0; LANES]; expected.len()];
            Code::with(&program, width).expect("the width is here").run(
                &mut Scratch::default(),
                &inputs,
                &uniforms,
                &mut outputs,
            );
            for (k, (y, e)) in outputs.as_flattened().iter().zip(expected.as_flattened()).enumerate() {
                let larger = k / LANES % program.outputs.len() == program.outputs.len() - 1;
                assert!(bits(*y) == bits(*e) || larger && *y == 0.0 && *e == 0.0, "{width}: {y} for {e}");
            }

            let ends = random::ends(&mut random, program.outputs.len());
            let whole = plain::parts(&program, ends, &outputs);
            let mut outputs = whole.each_ref().map(|part| vec![[0.0; LANES]; part.len()]);
            Code::in_parts_with(&program, ends, width).expect("the width is here").run_in_parts(
                &mut Scratch::default(),
                &inputs,
                &uniforms,
                outputs.each_mut().map(Vec::as_mut_slice),
            );
            for (y, e) in outputs.iter().flatten().zip(whole.iter().flatten()) {
                assert_eq!(y.map(bits), e.map(bits), "{width}, ends {ends:?}");
            }
        }
    }
}

#[test]
fn hundreds_of_numbers_live_at_once() {
    let mut random = Random(3);
    for count in [10u32, 14, 15, 16, 17, 29, 30, 31, 32, 33, 100, 700] {
        for calls in [false, true] {
            let (x, y) = (Operand::Input(0), Operand::Input(1));
            let mut instructions = Vec::new();
            for k in 0..count {
                let last = if k == 0 { x } else { Operand::Value(k - 1) };
                instructions.push(Instruction::MulAdd(last, y, Operand::Constant(0)));
            }
            if calls {
                instructions.push(Instruction::Call(CALLS[9], Operand::Value(0), Operand::Value(count - 1)));
            }
            // All are read twice, in another order each time.
            let mut sum = Operand::Constant(0);
            for turn in 0..2 {
                let mut order: Vec<u32> = (0..count).collect();
                for k in 0..order.len() {
                    order.swap(k, random.below(count as usize));
                }
                for (k, v) in order.into_iter().enumerate() {
                    let v = Operand::Value(v);
                    let fused = match (k + turn) % 4 {
                        0 => Instruction::MulAdd(sum, y, v),
                        1 => Instruction::NegMulAdd(v, x, sum),
                        2 => Instruction::Sub(v, sum),
                        _ => Instruction::Larger(sum, v),
                    };
                    sum = Operand::Value(instructions.len() as u32);
                    instructions.push(fused);
                }
            }
            let program = Program {
                inputs: 2,
                constants: vec![0.25],
                instructions,
                outputs: vec![sum],
                ..Program::default()
            };
            let (inputs, _) = data(&mut random, &program, 2, false);
            let (_, counts) = holds(&program, 2, &inputs, &[]);
            let most = if calls { count } else { count.saturating_sub(10) };
            assert!(counts.slots <= count as usize && (count < 100 || counts.slots > most as usize / 2));
        }
    }
}

#[test]
fn outputs_may_be_anything_and_again() {
    let mut random = Random(4);
    let outputs: Vec<Operand> = [
        Operand::Input(1),
        Operand::Value(1),
        Operand::Constant(0),
        Operand::Uniform(1),
        Operand::Value(1),
        Operand::Input(1),
        Operand::Value(0),
        Operand::Uniform(1),
        Operand::Value(1),
    ]
    .into();
    let program = Program {
        inputs: 2,
        uniforms: 2,
        constants: vec![-0.0, f64::NAN],
        instructions: vec![
            Instruction::Neg(Operand::Input(0)),
            Instruction::Mul(Operand::Value(0), Operand::Value(0)),
            // No output depends on it.
            Instruction::Call(CALLS[0], Operand::Value(1), Operand::Value(1)),
        ],
        outputs,
    };
    let (inputs, uniforms) = data(&mut random, &program, 3, false);
    holds(&program, 3, &inputs, &uniforms);

    let copies = Program { instructions: Vec::new(), outputs: vec![Operand::Uniform(0)], ..program.clone() };
    holds(&copies, 3, &inputs, &uniforms);
    let constants = Program {
        inputs: 0,
        uniforms: 0,
        instructions: vec![Instruction::Sqrt(Operand::Constant(0))],
        outputs: vec![Operand::Value(0), Operand::Constant(1)],
        ..program
    };
    holds(&constants, 7, &[], &[]);
}

#[test]
fn inputs_uniforms_constants_and_outputs_beyond_short_offsets_are_found() {
    let mut random = Random(5);
    let count = 700;
    let mut instructions = Vec::new();
    for k in 0..count {
        let last = if k == 0 { Operand::Input(count - 1) } else { Operand::Value(k - 1) };
        instructions.push(match k % 3 {
            0 => Instruction::MulAdd(Operand::Uniform(k), Operand::Input(k), Operand::Constant(k)),
            1 => Instruction::Add(last, Operand::Uniform(count - k)),
            _ => Instruction::Sub(Operand::Constant(count - k), last),
        });
    }
    let program = Program {
        inputs: count as usize,
        uniforms: count as usize,
        constants: (0..count).map(|_| random.tame()).collect(),
        instructions,
        outputs: (0..count).rev().map(Operand::Value).collect(),
    };
    let (inputs, uniforms) = data(&mut random, &program, 3, false);
    let (finite, _) = holds(&program, 3, &inputs, &uniforms);
    assert_eq!(finite, 3 * LANES * count as usize);
}

#[test]
fn any_number_of_groups() {
    let mut random = Random(6);
    let shape = Shape {
        inputs: 3,
        uniforms: 2,
        constants: 2,
        instructions: 60,
        outputs: 5,
        near: 20,
        calls: 30,
        wild: false,
    };
    let program = random::program(&mut random, shape);
    for groups in [0, 1, 2, 3, 1001] {
        let (inputs, uniforms) = data(&mut random, &program, groups, false);
        holds(&program, groups, &inputs, &uniforms);
    }
    // No outputs: nothing to do.
    let none = Program { outputs: Vec::new(), ..program };
    let (inputs, uniforms) = data(&mut random, &none, 2, false);
    holds(&none, 2, &inputs, &uniforms);
}

#[test]
fn calls_leave_all_other_numbers_as_they_were() {
    let mut random = Random(7);
    for calls in [1, 2, 5] {
        let shape = Shape {
            inputs: 5,
            uniforms: 5,
            constants: 5,
            instructions: 400,
            outputs: 60,
            near: 60,
            calls,
            wild: false,
        };
        let program = random::program(&mut random, shape);
        let (inputs, uniforms) = data(&mut random, &program, 2, false);
        holds(&program, 2, &inputs, &uniforms);
    }
}

#[test]
fn code_is_shared_by_threads_and_scratch_by_codes() {
    if !is_available() {
        return;
    }
    let mut random = Random(8);
    let shape = Shape {
        inputs: 4,
        uniforms: 4,
        constants: 4,
        instructions: 800,
        outputs: 30,
        near: 300,
        calls: 100,
        wild: false,
    };
    let programs: Vec<Program> = (0..3).map(|_| random::program(&mut random, shape)).collect();
    let codes: Vec<Code> = programs.iter().map(|p| Code::new(p).expect("a width is here")).collect();
    std::thread::scope(|scope| {
        for t in 0..4 {
            let (programs, codes) = (&programs, &codes);
            scope.spawn(move || {
                let mut random = Random(100 + t);
                let mut scratch = Scratch::default();
                for turn in 0..30 {
                    let (program, code) = (&programs[turn % 3], &codes[turn % 3]);
                    let (inputs, uniforms) = data(&mut random, program, 2, false);
                    let mut outputs = vec![[0.0; LANES]; 60];
                    code.run(&mut scratch, &inputs, &uniforms, &mut outputs);
                    let expected = plain::evaluate(program, 2, &inputs, &uniforms);
                    let all = outputs.as_flattened().iter().map(|x| bits(*x));
                    assert!(all.eq(expected.as_flattened().iter().map(|x| bits(*x))));
                }
            });
        }
    });
}
