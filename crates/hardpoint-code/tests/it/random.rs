//! Random programs and numbers, with a plain evaluation, one scalar at a time.

use hardpoint_tape::{Call, Instruction, Operand, Program};

/// Reproducible pseudo-random numbers (splitmix64).
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    pub fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    /// Between -2 and 2.
    pub fn tame(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * 2f64.powi(-51) - 2.0
    }

    /// Any kind of double, each with a similar frequency.
    pub fn wild(&mut self) -> f64 {
        const KINDS: [f64; 16] = [
            0.0,
            -0.0,
            1.0,
            -1.0,
            0.5,
            -2.5,
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::MAX,
            f64::MIN,
            f64::MIN_POSITIVE,
            f64::EPSILON,
            5e-324,
            -3e-310,
            4503599627370495.5,
        ];
        match self.below(4) {
            0 => f64::from_bits(self.bits()),
            1 => KINDS[self.below(KINDS.len())],
            _ => self.tame(),
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

/// Shape of a random program.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    pub inputs: usize,
    pub uniforms: usize,
    pub constants: usize,
    pub instructions: usize,
    pub outputs: usize,
    /// Distance back of most values that an instruction reads.
    pub near: usize,
    /// Mean number of instructions per call; no calls if zero.
    pub calls: usize,
    /// True if constants may be anything.
    pub wild: bool,
}

/// Instructions mostly read numbers that are finite for one sample, so that not all ends as NaN.
pub fn program(random: &mut Random, shape: Shape) -> Program {
    let number = |r: &mut Random| if shape.wild { r.wild() } else { r.tame() };
    let mut program = Program {
        inputs: shape.inputs,
        uniforms: shape.uniforms,
        constants: (0..shape.constants).map(|_| number(random)).collect(),
        ..Program::default()
    };
    let inputs: Vec<f64> = (0..shape.inputs).map(|_| random.tame()).collect();
    let uniforms: Vec<f64> = (0..shape.uniforms).map(|_| random.tame()).collect();
    let mut sample: Vec<f64> = Vec::new();
    for _ in 0..shape.instructions {
        let [a, b, c] = [(); 3].map(|()| {
            let mut tries = 0;
            loop {
                let operand = any(random, &program, shape.near);
                let x = at(operand, &sample, &inputs, &uniforms, &program.constants);
                tries += 1;
                if x.abs() < 1e50 || tries > 5 {
                    return operand;
                }
            }
        });
        let b = if random.one_in(12) { a } else { b };
        let c = if random.one_in(12) { a } else { c };
        let instruction = if shape.calls > 0 && random.one_in(shape.calls) {
            Instruction::Call(CALLS[random.below(CALLS.len())], a, b)
        } else {
            let all = plain(a, b, c);
            // The first four more often than the others.
            all[if random.one_in(2) { random.below(4) } else { random.below(all.len()) }]
        };
        sample.push(compute(instruction, |o| at(o, &sample, &inputs, &uniforms, &program.constants)));
        program.instructions.push(instruction);
    }
    for j in 0..shape.outputs {
        let last = program.instructions.len().wrapping_sub(1 + j / 2);
        let output = match j % 2 == 0 && last < program.instructions.len() {
            true => Operand::Value(last as u32),
            false => any(random, &program, usize::MAX),
        };
        program.outputs.push(output);
    }
    program
}

/// Ends of the parts of the outputs; often some parts are empty.
pub fn ends(random: &mut Random, outputs: usize) -> [usize; 2] {
    let [a, b] = [(); 2].map(|()| random.below(outputs + 1));
    match random.below(6) {
        0 => [0, a],
        1 => [a, a],
        2 => [a, outputs],
        3 => [[0, 0], [0, outputs], [outputs, outputs]][random.below(3)],
        _ => [a.min(b), a.max(b)],
    }
}

/// All instructions but calls.
pub fn plain(a: Operand, b: Operand, c: Operand) -> [Instruction; 13] {
    use Instruction as I;
    [
        I::Add(a, b),
        I::Sub(a, b),
        I::Mul(a, b),
        I::Div(a, b),
        I::MulAdd(a, b, c),
        I::MulSub(a, b, c),
        I::NegMulAdd(a, b, c),
        I::NegMulSub(a, b, c),
        I::Neg(a),
        I::Abs(a),
        I::Sqrt(a),
        I::Round(a),
        I::Larger(a, b),
    ]
}

/// Any existing number, more often one of the last.
fn any(random: &mut Random, program: &Program, near: usize) -> Operand {
    let values = program.instructions.len();
    loop {
        let (count, make): (usize, fn(u32) -> Operand) = match random.below(10) {
            0 => (program.inputs, Operand::Input),
            1 => (program.uniforms, Operand::Uniform),
            2 => (program.constants.len(), Operand::Constant),
            3 => (values, Operand::Value),
            _ if values > 0 => {
                let back = 1 + random.below(values.min(near));
                return Operand::Value((values - back) as u32);
            }
            _ => continue,
        };
        if count > 0 {
            return make(random.below(count) as u32);
        }
    }
}

/// The number that an operand represents.
pub fn at(operand: Operand, values: &[f64], inputs: &[f64], uniforms: &[f64], constants: &[f64]) -> f64 {
    match operand {
        Operand::Value(k) => values[k as usize],
        Operand::Input(k) => inputs[k as usize],
        Operand::Uniform(k) => uniforms[k as usize],
        Operand::Constant(k) => constants[k as usize],
    }
}

/// One instruction. The larger of zeros of different signs is -0, as in the code.
pub fn compute(instruction: Instruction, x: impl Fn(Operand) -> f64) -> f64 {
    use Instruction as I;
    match instruction {
        I::Add(a, b) => x(a) + x(b),
        I::Sub(a, b) => x(a) - x(b),
        I::Mul(a, b) => x(a) * x(b),
        I::Div(a, b) => x(a) / x(b),
        I::MulAdd(a, b, c) => x(a).mul_add(x(b), x(c)),
        I::MulSub(a, b, c) => x(a).mul_add(x(b), -x(c)),
        I::NegMulAdd(a, b, c) => (-x(a)).mul_add(x(b), x(c)),
        I::NegMulSub(a, b, c) => (-x(a)).mul_add(x(b), -x(c)),
        I::Neg(a) => -x(a),
        I::Abs(a) => x(a).abs(),
        I::Sqrt(a) => x(a).sqrt(),
        I::Round(a) => x(a).round_ties_even(),
        I::Larger(a, b) => match (x(a), x(b)) {
            (a, b) if a.is_nan() || b.is_nan() => f64::NAN,
            (a, b) if a == b => f64::from_bits(a.to_bits() | b.to_bits()),
            (a, b) => a.max(b),
        },
        I::Call(call, a, b) => match call.is_of_two() {
            true => call.of(x(a), x(b)),
            false => call.of(x(a), f64::NAN),
        },
    }
}
