//! Lowered programs: live instructions, with the next reader of each number.

use hardpoint_tape::{Call, Instruction, Operand, Program};

use super::encoder::{Opcode, Sign};

/// Next reader of a number without further readers.
pub const NEVER: u32 = u32::MAX;

/// Index of a number: values by their instruction, then inputs, uniforms, constants, and the two sign masks.
pub type Name = u32;

/// Operation of an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Operation on one number.
    Unary(Opcode),
    /// Operation on two numbers.
    Binary(Opcode),
    /// Commutative operation on two numbers.
    Commuting(Opcode),
    /// Operation on three numbers.
    Fused(Sign),
    Larger,
    Call(Call),
}

/// Lowered instruction.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    pub action: Action,
    operands: [Name; 3],
    next: [u32; 3],
    count: u8,
    /// True if an output depends on it.
    pub needed: bool,
}

impl Step {
    /// Operands.
    pub fn operands(&self) -> &[Name] {
        &self.operands[..usize::from(self.count)]
    }

    /// For each operand, the next instruction that reads the same number.
    pub fn next(&self) -> &[u32] {
        &self.next[..usize::from(self.count)]
    }
}

/// Names of numbers.
#[derive(Clone, Copy, Debug)]
pub struct Names {
    pub inputs: Name,
    pub uniforms: Name,
    pub constants: Name,
    /// Mask of the sign bit.
    pub sign: Name,
    /// Mask of all other bits.
    pub magnitude: Name,
}

impl Names {
    fn new(program: &Program) -> Self {
        let inputs = program.instructions.len() as u32;
        let uniforms = inputs + program.inputs as u32;
        let constants = uniforms + program.uniforms as u32;
        let sign = constants + program.constants.len() as u32;
        Self { inputs, uniforms, constants, sign, magnitude: sign + 1 }
    }

    /// Number of names.
    pub fn len(&self) -> usize {
        self.magnitude as usize + 1
    }

    pub fn of(&self, operand: Operand) -> Name {
        match operand {
            Operand::Value(k) => k,
            Operand::Input(k) => self.inputs + k,
            Operand::Uniform(k) => self.uniforms + k,
            Operand::Constant(k) => self.constants + k,
        }
    }

    pub fn is_value(&self, name: Name) -> bool {
        name < self.inputs
    }
}

/// Program that is ready for code generation from front to back.
#[derive(Debug)]
pub struct LoweredProgram {
    pub names: Names,
    pub steps: Vec<Step>,
    /// First instruction that reads each name.
    pub first: Vec<u32>,
    /// Name of each output.
    pub outputs: Vec<Name>,
    /// Outputs that are values, in the order of these.
    by_value: Vec<(Name, u32)>,
}

impl LoweredProgram {
    /// Lowers a program. All of its operands must exist.
    pub fn new(program: &Program) -> Self {
        let names = Names::new(program);
        let mut steps: Vec<Step> = program.instructions.iter().map(|&i| step(&names, i)).collect();
        let outputs: Vec<Name> = program.outputs.iter().map(|&o| names.of(o)).collect();
        let mut by_value: Vec<(Name, u32)> =
            outputs.iter().copied().zip(0..).filter(|(n, _)| names.is_value(*n)).collect();
        by_value.sort_unstable();

        for (name, _) in &by_value {
            steps[*name as usize].needed = true;
        }
        let mut first = vec![NEVER; names.len()];
        for (i, step) in steps.iter_mut().enumerate().rev() {
            step.needed |= first[i] != NEVER;
            if step.needed {
                for k in 0..usize::from(step.count) {
                    step.next[k] = first[step.operands[k] as usize];
                }
                for name in step.operands() {
                    first[*name as usize] = i as u32;
                }
            }
        }
        Self { names, steps, first, outputs, by_value }
    }

    /// Returns the outputs from index `from` on that are this value; call it with values in their order.
    pub fn outputs_of(&self, value: Name, from: &mut usize) -> &[(Name, u32)] {
        let rest = &self.by_value[*from..];
        let count = rest.iter().take_while(|(n, _)| *n == value).count();
        *from += count;
        &rest[..count]
    }
}

fn step(names: &Names, instruction: Instruction) -> Step {
    use Instruction as I;
    let make = |action, operands: &[Name]| {
        let mut all = [0; 3];
        all[..operands.len()].copy_from_slice(operands);
        Step { action, operands: all, next: [NEVER; 3], count: operands.len() as u8, needed: false }
    };
    let n = |operand| names.of(operand);
    let fused = |sign, a, b, c| make(Action::Fused(sign), &[n(a), n(b), n(c)]);
    match instruction {
        I::Add(a, b) => make(Action::Commuting(Opcode::ADD), &[n(a), n(b)]),
        I::Sub(a, b) => make(Action::Binary(Opcode::SUB), &[n(a), n(b)]),
        I::Mul(a, b) => make(Action::Commuting(Opcode::MUL), &[n(a), n(b)]),
        I::Div(a, b) => make(Action::Binary(Opcode::DIV), &[n(a), n(b)]),
        I::MulAdd(a, b, c) => fused(Sign::MulAdd, a, b, c),
        I::MulSub(a, b, c) => fused(Sign::MulSub, a, b, c),
        I::NegMulAdd(a, b, c) => fused(Sign::NegMulAdd, a, b, c),
        I::NegMulSub(a, b, c) => fused(Sign::NegMulSub, a, b, c),
        I::Neg(a) => make(Action::Commuting(Opcode::XOR), &[n(a), names.sign]),
        I::Abs(a) => make(Action::Commuting(Opcode::AND), &[n(a), names.magnitude]),
        I::Sqrt(a) => make(Action::Unary(Opcode::SQRT), &[n(a)]),
        I::Round(a) => make(Action::Unary(Opcode::ROUND), &[n(a)]),
        I::Larger(a, b) => make(Action::Larger, &[n(a), n(b)]),
        I::Call(call, a, b) if call.is_of_two() => make(Action::Call(call), &[n(a), n(b)]),
        I::Call(call, a, _) => make(Action::Call(call), &[n(a)]),
    }
}
