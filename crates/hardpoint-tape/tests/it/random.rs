//! Random formulas: the optimised program has the same results.

use hardpoint_tape::{
    Call, Instruction, Interpreter, Lanes, Number, Operand, Options, Program, Recording, record,
};

use crate::real::{BoundedNumber, Real};

/// Sebastiano Vigna's splitmix64.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    /// Below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    /// In -2 to 2, and sometimes just a simple number.
    pub fn number(&mut self) -> f64 {
        match self.below(8) {
            0 => [0.0, 1.0, -1.0, 2.0, -0.5, 3.0][self.below(6)],
            _ => (self.bits() >> 11) as f64 / (1u64 << 51) as f64 - 2.0,
        }
    }
}

pub const CALLS: [Call; 11] = [
    Call::Tan,
    Call::Asin,
    Call::Acos,
    Call::Atan,
    Call::Sinh,
    Call::Cosh,
    Call::Tanh,
    Call::Exp,
    Call::Ln,
    Call::Atan2,
    Call::Pow,
];

/// A formula: steps, each of two or three earlier numbers.
pub struct Formula {
    pub inputs: usize,
    pub uniforms: usize,
    constants: Vec<f64>,
    steps: Vec<(usize, [usize; 3], Call)>,
    outputs: Vec<usize>,
}

impl Formula {
    pub fn random(seed: u64) -> Self {
        let mut random = Random(seed);
        let [inputs, uniforms] = [random.below(5), random.below(4)];
        let constants: Vec<f64> =
            [0.0, 1.0, -1.0, 0.25].into_iter().chain((0..3).map(|_| random.number())).collect();
        let mut many = inputs + uniforms + constants.len();
        let leaves = many;
        let steps: Vec<_> = (0..1 + random.below(60))
            .map(|_| {
                // Near ones rather than far ones, so that formulas are deep.
                let mut one = || {
                    if random.below(2) == 0 {
                        random.below(many)
                    } else {
                        many - 1 - random.below(many.min(6))
                    }
                };
                let operands = [one(), one(), one()];
                many += 1;
                (random.below(40), operands, CALLS[random.below(11)])
            })
            .collect();
        let outputs = (0..1 + random.below(6)).map(|_| many - 1 - random.below(many - leaves / 2)).collect();
        Self { inputs, uniforms, constants, steps, outputs }
    }

    /// All its numbers, in order.
    pub fn evaluate<T: Real>(&self, inputs: &[T], uniforms: &[T]) -> Vec<T> {
        let mut x: Vec<T> = inputs.iter().chain(uniforms).copied().collect();
        x.extend(self.constants.iter().map(|c| T::constant(*c)));
        for (kind, [a, b, c], function) in &self.steps {
            let (a, b, c) = (x[*a], x[*b], x[*c]);
            x.push(match kind {
                0..8 => a + b,
                8..15 => a - b,
                15..25 => a * b,
                25..30 => a.times_plus(b, c),
                30 => a / b,
                31 => a / (b.abs() + T::constant(0.5)),
                32 => -a,
                33 => a.abs(),
                34 => a.abs().sqrt(),
                35 => a.round(),
                36 | 37 => a.larger(b),
                _ => a.call(*function, b),
            });
        }
        x
    }

    /// True if results must agree for these numbers: all finite, and no angle depends on the sign of a zero.
    fn is_plain(&self, numbers: &[f64]) -> bool {
        let first = numbers.len() - self.steps.len();
        numbers.iter().all(|x| x.is_finite())
            && self.steps.iter().enumerate().all(|(k, (kind, [a, ..], function))| {
                let on_the_cut = *kind > 37 && *function == Call::Atan2 && numbers[*a] == 0.0;
                k + first >= numbers.len() || !on_the_cut
            })
    }

    pub fn outputs<T: Real>(&self, numbers: &[T]) -> Vec<T> {
        self.outputs.iter().map(|k| numbers[*k]).collect()
    }

    pub fn record(&self, random: &mut Random) -> Recording {
        record(|| {
            let inputs: Vec<_> = (0..self.inputs).map(|_| Number::input(random.number())).collect();
            let uniforms: Vec<_> = (0..self.uniforms).map(|_| Number::uniform(random.number())).collect();
            self.outputs(&self.evaluate(&inputs, &uniforms))
        })
    }
}

/// Numbers for all lanes of some groups.
fn lanes(random: &mut Random, groups: usize) -> Vec<Lanes> {
    (0..groups).map(|_| std::array::from_fn(|_| random.number())).collect()
}

/// True if equal except for the sign of zeros.
pub fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || a == b
}

#[test]
fn programs_without_fusing_give_the_bits_of_plain_arithmetic() {
    let (mut compared, mut left_out) = (0, 0);
    for seed in 0..3000 {
        let formula = Formula::random(seed);
        let mut random = Random(!seed);
        let (program, counts) = formula.record(&mut random).program(Options { fuse: false });
        let ends = counts.folded + counts.common + counts.dead + counts.fused + counts.left;
        assert_eq!(counts.recorded + counts.negations, ends, "seed {seed}: {counts:?}");
        assert_eq!((counts.fused, counts.left), (0, program.kinds().total()));
        let groups = 1 + random.below(6);
        let inputs = lanes(&mut random, groups * formula.inputs);
        let uniforms: Vec<f64> = (0..formula.uniforms).map(|_| random.number()).collect();
        let mut outputs = vec![[0.0; 8]; groups * program.outputs.len()];
        Interpreter::new(&program).run(&inputs, &uniforms, &mut outputs);
        for (group, outputs) in outputs.chunks(program.outputs.len()).enumerate() {
            for lane in 0..8 {
                let inputs: Vec<f64> =
                    (0..formula.inputs).map(|k| inputs[group * formula.inputs + k][lane]).collect();
                let numbers = formula.evaluate(&inputs, &uniforms);
                if !formula.is_plain(&numbers) {
                    left_out += 1;
                    continue;
                }
                for (j, expected) in formula.outputs(&numbers).into_iter().enumerate() {
                    let found = outputs[j][lane];
                    assert!(
                        same(found, expected),
                        "seed {seed}, output {j}: {found:e} for {expected:e}\n{program:?}"
                    );
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 100_000 && left_out < compared, "{compared} compared, {left_out} runs left out");
}

#[test]
fn fusing_changes_results_by_rounding_only() {
    let (mut compared, mut fused) = (0, 0);
    for seed in 0..3000 {
        let formula = Formula::random(seed);
        let mut random = Random(!seed);
        let (program, counts) = formula.record(&mut random).program(Options::default());
        let ends = counts.folded + counts.common + counts.dead + counts.fused + counts.left;
        assert_eq!(counts.recorded + counts.negations, ends, "seed {seed}: {counts:?}");
        fused += counts.fused;
        let mut values = Vec::new();
        let mut outputs = vec![0.0; program.outputs.len()];
        for _ in 0..8 {
            let [inputs, uniforms]: [Vec<f64>; 2] =
                [formula.inputs, formula.uniforms].map(|n| (0..n).map(|_| random.number()).collect());
            program.evaluate(&inputs, &uniforms, &mut values, &mut outputs);
            let bounded = |x: &[f64]| x.iter().map(|x| BoundedNumber::constant(*x)).collect::<Vec<_>>();
            let numbers = formula.evaluate(&bounded(&inputs), &bounded(&uniforms));
            if !formula.is_plain(&numbers.iter().map(|n| n.x).collect::<Vec<_>>()) {
                continue;
            }
            for (j, expected) in formula.outputs(&numbers).into_iter().enumerate() {
                // Both may be off, the one that was computed and the one that is compared with.
                let off = (outputs[j] - expected.x).abs();
                assert!(
                    off <= 2.0 * expected.error || expected.error.is_infinite(),
                    "seed {seed}, output {j}: off by {off:e}\n{program:?}"
                );
                compared += usize::from(expected.error < 1e-9);
            }
        }
    }
    assert!(compared > 10_000 && fused > 2_000, "{compared} compared, {fused} products fused");
}

/// A random program with instructions that a recording would not produce: two scalars, the same operand twice, unused
/// numbers.
fn random_program(random: &mut Random) -> Program {
    use Instruction::*;
    let mut program = Program {
        inputs: 1 + random.below(6),
        uniforms: 1 + random.below(4),
        constants: (0..1 + random.below(5)).map(|_| random.number()).collect(),
        ..Program::default()
    };
    let size = random.below(120);
    for k in 0..=size {
        let operand = |random: &mut Random, k: usize| match random.below(10) {
            0 | 1 => Operand::Input(random.below(program.inputs) as u32),
            2 => Operand::Uniform(random.below(program.uniforms) as u32),
            3 => Operand::Constant(random.below(program.constants.len()) as u32),
            _ if k == 0 => Operand::Input(0),
            4..7 => Operand::Value((k - 1 - random.below(k.min(4))) as u32),
            _ => Operand::Value(random.below(k) as u32),
        };
        if k == size {
            program.outputs = (0..random.below(20)).map(|_| operand(random, k)).collect();
            break;
        }
        let [a, b, c] = [operand(random, k), operand(random, k), operand(random, k)];
        program.instructions.push(match random.below(20) {
            0 | 1 => Add(a, b),
            2 | 3 => Sub(a, b),
            4 | 5 => Mul(a, b),
            6 => Div(a, b),
            7 | 8 => MulAdd(a, b, c),
            9 | 10 => MulSub(a, b, c),
            11 | 12 => NegMulAdd(a, b, c),
            13 => NegMulSub(a, b, c),
            14 => Neg(a),
            15 => Abs(a),
            16 => Sqrt(a),
            17 => Round(a),
            18 => Larger(a, b),
            _ => Call(CALLS[random.below(11)], a, b),
        });
    }
    program
}

#[test]
fn shared_slots_give_what_one_place_for_each_value_gives() {
    let mut shared = 0;
    for seed in 0..3000 {
        let mut random = Random(seed);
        let program = random_program(&mut random);
        let groups = random.below(10);
        let inputs = lanes(&mut random, groups * program.inputs);
        let uniforms: Vec<f64> = (0..program.uniforms).map(|_| random.number()).collect();
        let mut interpreter = Interpreter::new(&program);
        shared += (program.instructions.len() + program.inputs).saturating_sub(interpreter.slots());
        let mut outputs = vec![[f64::NAN; 8]; groups * program.outputs.len()];
        // Twice: the first run must not affect the second.
        let others = lanes(&mut random, inputs.len());
        if !program.outputs.is_empty() {
            interpreter.run(&others, &uniforms, &mut outputs);
        }
        outputs.fill([-7.0; 8]);
        interpreter.run(&inputs, &uniforms, &mut outputs);
        let (mut values, mut expected) = (Vec::new(), vec![0.0; program.outputs.len()]);
        for group in 0..groups {
            for lane in 0..8 {
                let inputs: Vec<f64> =
                    (0..program.inputs).map(|k| inputs[group * program.inputs + k][lane]).collect();
                program.evaluate(&inputs, &uniforms, &mut values, &mut expected);
                for (j, expected) in expected.iter().enumerate() {
                    let found = outputs[group * program.outputs.len() + j][lane];
                    let same = found.to_bits() == expected.to_bits() || (found.is_nan() && expected.is_nan());
                    assert!(
                        same,
                        "seed {seed}, group {group}, output {j}: {found:e} for {expected:e}\n{program:?}"
                    );
                }
            }
        }
    }
    assert!(shared > 50_000, "only {shared} slots were saved: nothing was tested");
}

#[test]
fn what_is_not_a_number_spoils_the_larger_of_two() {
    let recording = record(|| {
        let [a, b] = [Number::input(1.0), Number::input(2.0)];
        [a.larger(b), b.larger(a)]
    });
    let (program, _) = recording.program(Options::default());
    let a = [1.0, f64::NAN, 1.0, f64::NAN, f64::INFINITY, 2.0, -3.0, 0.5];
    let b = [2.0, 2.0, f64::NAN, f64::NAN, 1.0, 1.0, f64::NEG_INFINITY, f64::NAN];
    let mut outputs = [[0.0; 8]; 2];
    Interpreter::new(&program).run(&[a, b], &[], &mut outputs);
    for lane in 0..8 {
        let expected = Real::larger(a[lane], b[lane]);
        for output in outputs {
            assert_eq!(output[lane].is_nan(), expected.is_nan(), "lane {lane}");
            assert!(expected.is_nan() || output[lane] == expected, "lane {lane}: {}", output[lane]);
        }
    }
}
