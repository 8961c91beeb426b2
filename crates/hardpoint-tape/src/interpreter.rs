//! Interpreter of programs: portable and safe, without machine code.
//!
//! Each instruction is decoded once for four groups of lanes, that is, 32 numbers. Slots of values are reused after
//! their last read, so that the working memory of a kernel with thousands of instructions stays in the L1 cache.

use fearless_simd::{Level, Select, Simd, SimdBase, SimdFloat, dispatch, f64x8};

use crate::program::{Call, Instruction, LANES, Lanes, Operand, Program};

/// Number of scalars that an instruction processes at a time.
pub const WIDE: usize = GROUPS * LANES;

/// Number of groups of lanes in a batch.
const GROUPS: usize = 4;

/// Decoded program with its working memory.
///
/// Arithmetic is that of `f64`, lane by lane. `MulAdd` and its variants round once on CPUs with such an instruction,
/// twice on others ([`fuses`](crate::fuses)).
#[derive(Clone, Debug)]
pub struct Interpreter {
    code: Vec<Code>,
    /// Destinations of results that are outputs, in the order of the code.
    stores: Vec<u32>,
    /// Constants of the program, then uniforms.
    scalars: Vec<f64>,
    constants: usize,
    inputs: usize,
    uniforms: usize,
    outputs: usize,
    slots: Vec<Row>,
}

/// Lanes of one group, aligned to a cache line: access across two lines takes twice the time.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Row(Lanes);

/// Decoded instruction.
#[derive(Clone, Copy, Debug)]
struct Code {
    op: Op,
    /// Number of outputs to which the result is written.
    stores: u32,
    /// Slot of the result.
    to: u32,
    /// Slots or scalars, depending on the operation.
    a: u32,
    b: u32,
    c: u32,
}

/// Operation on slots and scalars: the letters are the operands, `s` slot and `c` scalar.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Op {
    /// Loads input `a` into its slot.
    Load,
    /// Loads scalar `a` into a slot.
    Splat,
    AddSs,
    AddSc,
    SubSs,
    SubSc,
    SubCs,
    MulSs,
    MulSc,
    DivSs,
    DivSc,
    DivCs,
    MulAddSss,
    MulAddSsc,
    MulAddScs,
    MulAddScc,
    MulSubSss,
    MulSubSsc,
    MulSubScs,
    MulSubScc,
    NegMulAddSss,
    NegMulAddSsc,
    NegMulAddScs,
    NegMulAddScc,
    NegMulSubSss,
    NegMulSubSsc,
    NegMulSubScs,
    NegMulSubScc,
    Neg,
    Abs,
    Sqrt,
    Round,
    Larger,
    Call(Call),
}

impl Interpreter {
    /// Decodes a program.
    ///
    /// # Panics
    ///
    /// If an instruction reads a value that is not computed before, or an input, uniform or constant that does not
    /// exist.
    pub fn new(program: &Program) -> Self {
        let (code, stores, slots) = Assembler::new(program).assemble();
        let mut scalars = program.constants.clone();
        scalars.resize(program.constants.len() + program.uniforms, f64::NAN);
        Self {
            code,
            stores,
            scalars,
            constants: program.constants.len(),
            inputs: program.inputs,
            uniforms: program.uniforms,
            outputs: program.outputs.len(),
            slots: vec![Row([0.0; LANES]); slots * GROUPS],
        }
    }

    /// Returns the number of slots of its values.
    pub fn slots(&self) -> usize {
        self.slots.len() / GROUPS
    }

    /// Runs the program for any number of groups of lanes, without allocation.
    ///
    /// | what | where |
    /// |---|---|
    /// | input `k` of group `g` | `inputs[g * program.inputs + k]` |
    /// | uniform `k` of all groups | `uniforms[k]` |
    /// | output `j` of group `g` | `outputs[g * program.outputs.len() + j]` |
    ///
    /// # Panics
    ///
    /// If the lengths do not match the program, or result in different numbers of groups.
    pub fn run(&mut self, inputs: &[Lanes], uniforms: &[f64], outputs: &mut [Lanes]) {
        self.run_at(Level::new(), inputs, uniforms, outputs);
    }

    /// Runs with the instructions of this level, which can be below that of the CPU.
    fn run_at(&mut self, level: Level, inputs: &[Lanes], uniforms: &[f64], outputs: &mut [Lanes]) {
        assert_eq!(uniforms.len(), self.uniforms, "the program has {} uniforms", self.uniforms);
        let groups = outputs.len().checked_div(self.outputs).unwrap_or(0);
        assert_eq!(
            outputs.len(),
            groups * self.outputs,
            "the program has {} outputs per group",
            self.outputs
        );
        assert!(
            self.outputs == 0 || inputs.len() == groups * self.inputs,
            "expected {groups} groups of {} inputs, found {} inputs",
            self.inputs,
            inputs.len()
        );
        self.scalars[self.constants..].copy_from_slice(uniforms);
        dispatch!(level, simd => self.run_in(simd, groups, inputs, outputs));
    }

    #[inline(always)]
    fn run_in<S: Simd>(&mut self, simd: S, groups: usize, inputs: &[Lanes], outputs: &mut [Lanes]) {
        let whole = groups - groups % GROUPS;
        for group in (0..whole).step_by(GROUPS) {
            let (given, asked) = (&inputs[group * self.inputs..], &mut outputs[group * self.outputs..]);
            simd.vectorize(
                #[inline(always)]
                || self.block::<S, GROUPS>(simd, given, asked),
            );
        }
        for group in whole..groups {
            let (given, asked) = (&inputs[group * self.inputs..], &mut outputs[group * self.outputs..]);
            simd.vectorize(
                #[inline(always)]
                || self.block::<S, 1>(simd, given, asked),
            );
        }
    }

    /// Runs all instructions for `N` groups.
    #[inline(always)]
    fn block<S: Simd, const N: usize>(&mut self, simd: S, inputs: &[Lanes], outputs: &mut [Lanes]) {
        use Op::*;
        // The slots of a single group are contiguous.
        let slots = self.slots.as_chunks_mut::<N>().0;
        let scalars = &self.scalars[..];
        let mut stores = self.stores.iter();
        for code in &self.code {
            // Lanes of group `g` of an operand: `s` for a slot, `c` for a scalar.
            macro_rules! at {
                ($k:ident s $g:ident) => {
                    f64x8::load_array_ref(simd, &slots[code.$k as usize][$g].0)
                };
                ($k:ident c $g:ident) => {
                    f64x8::splat(simd, scalars[code.$k as usize])
                };
            }
            macro_rules! all {
                ($g:ident => $f:expr) => {{
                    let mut result = [f64x8::splat(simd, 0.0); N];
                    for $g in 0..N {
                        result[$g] = $f;
                    }
                    result
                }};
            }
            macro_rules! unary {
                ($x:ident => $f:expr) => {
                    all!(g => { let $x = at!(a s g); $f })
                };
            }
            macro_rules! binary {
                ($a:ident $b:ident, $x:ident $y:ident => $f:expr) => {
                    all!(g => { let ($x, $y) = (at!(a $a g), at!(b $b g)); $f })
                };
            }
            macro_rules! ternary {
                ($b:ident $c:ident, $x:ident $y:ident $z:ident => $f:expr) => {
                    all!(g => { let ($x, $y, $z) = (at!(a s g), at!(b $b g), at!(c $c g)); $f })
                };
            }
            let result: [f64x8<S>; N] = match code.op {
                Load => all!(g => f64x8::load_array_ref(simd, &inputs[g * self.inputs + code.a as usize])),
                Splat => [f64x8::splat(simd, scalars[code.a as usize]); N],
                AddSs => binary!(s s, x y => x + y),
                AddSc => binary!(s c, x y => x + y),
                SubSs => binary!(s s, x y => x - y),
                SubSc => binary!(s c, x y => x - y),
                SubCs => binary!(c s, x y => x - y),
                MulSs => binary!(s s, x y => x * y),
                MulSc => binary!(s c, x y => x * y),
                DivSs => binary!(s s, x y => x / y),
                DivSc => binary!(s c, x y => x / y),
                DivCs => binary!(c s, x y => x / y),
                MulAddSss => ternary!(s s, x y z => x.mul_add(y, z)),
                MulAddSsc => ternary!(s c, x y z => x.mul_add(y, z)),
                MulAddScs => ternary!(c s, x y z => x.mul_add(y, z)),
                MulAddScc => ternary!(c c, x y z => x.mul_add(y, z)),
                MulSubSss => ternary!(s s, x y z => x.mul_sub(y, z)),
                MulSubSsc => ternary!(s c, x y z => x.mul_sub(y, z)),
                MulSubScs => ternary!(c s, x y z => x.mul_sub(y, z)),
                MulSubScc => ternary!(c c, x y z => x.mul_sub(y, z)),
                NegMulAddSss => ternary!(s s, x y z => (-x).mul_add(y, z)),
                NegMulAddSsc => ternary!(s c, x y z => (-x).mul_add(y, z)),
                NegMulAddScs => ternary!(c s, x y z => (-x).mul_add(y, z)),
                NegMulAddScc => ternary!(c c, x y z => (-x).mul_add(y, z)),
                NegMulSubSss => ternary!(s s, x y z => (-x).mul_sub(y, z)),
                NegMulSubSsc => ternary!(s c, x y z => (-x).mul_sub(y, z)),
                NegMulSubScs => ternary!(c s, x y z => (-x).mul_sub(y, z)),
                NegMulSubScc => ternary!(c c, x y z => (-x).mul_sub(y, z)),
                Neg => unary!(x => -x),
                Abs => unary!(x => x.abs()),
                Sqrt => unary!(x => x.sqrt()),
                Round => unary!(x => x.round_ties_even()),
                Larger => binary!(s s, x y => (y.simd_le(x) | !x.simd_eq(x)).select(x, y)),
                Call(function) => {
                    let (a, b) = (&slots[code.a as usize], &slots[code.b as usize]);
                    let mut result = [Row([0.0; LANES]); N];
                    call(function, a, b, &mut result);
                    all!(g => f64x8::load_array_ref(simd, &result[g].0))
                }
            };
            let to = &mut slots[code.to as usize];
            for g in 0..N {
                result[g].store_array(&mut to[g].0);
            }
            for output in stores.by_ref().take(code.stores as usize) {
                for g in 0..N {
                    result[g].store_array(&mut outputs[g * self.outputs + *output as usize]);
                }
            }
        }
    }
}

/// Evaluates a function of the standard library, lane by lane.
#[inline(never)]
fn call(function: Call, a: &[Row], b: &[Row], result: &mut [Row]) {
    for ((r, a), b) in result.iter_mut().zip(a).zip(b) {
        for lane in 0..LANES {
            r.0[lane] = function.of(a.0[lane], b.0[lane]);
        }
    }
}

/// Decoder of a program, which assigns slots to values.
struct Assembler<'a> {
    program: &'a Program,
    code: Vec<Code>,
    stores: Vec<u32>,
    /// Last instruction that reads a value or an input; outputs count as read where they are computed.
    last_of_value: Vec<u32>,
    last_of_input: Vec<u32>,
    slot_of_value: Vec<u32>,
    slot_of_input: Vec<u32>,
    /// Free slots; the last used one is on top, because it is most likely in the cache.
    free: Vec<u32>,
    slots: u32,
}

/// Null index: no slot, no reader.
const NONE: u32 = u32::MAX;

/// Decoded operand.
#[derive(Clone, Copy)]
enum Place {
    Slot(u32),
    Scalar(u32),
}

impl<'a> Assembler<'a> {
    fn new(program: &'a Program) -> Self {
        let values = program.instructions.len();
        let mut last_of_value = vec![NONE; values];
        let mut last_of_input = vec![NONE; program.inputs];
        for (k, instruction) in program.instructions.iter().enumerate() {
            for operand in instruction.operands() {
                match operand {
                    Operand::Value(v) => {
                        assert!(
                            (v as usize) < k,
                            "instruction {k} reads value {v}, which is not computed before"
                        );
                        last_of_value[v as usize] = k as u32;
                    }
                    Operand::Input(i) => last_of_input[i as usize] = k as u32,
                    Operand::Uniform(_) | Operand::Constant(_) => {}
                }
            }
        }
        Self {
            program,
            code: Vec::with_capacity(values + program.inputs),
            stores: Vec::with_capacity(program.outputs.len()),
            last_of_value,
            last_of_input,
            slot_of_value: vec![NONE; values],
            slot_of_input: vec![NONE; program.inputs],
            free: Vec::new(),
            slots: 0,
        }
    }

    fn assemble(mut self) -> (Vec<Code>, Vec<u32>, usize) {
        // Outputs by source: values first, in their order.
        let mut given: Vec<(Operand, u32)> = self.program.outputs.iter().copied().zip(0..).collect();
        given.sort_unstable();
        let mut given = given.chunk_by(|a, b| a.0 == b.0).peekable();
        for (k, instruction) in self.program.instructions.iter().enumerate() {
            self.instruction(k, *instruction);
            if let Some(asked) = given.next_if(|asked| asked[0].0 == Operand::Value(k as u32)) {
                self.store(asked);
            }
            if self.last_of_value[k] == NONE {
                self.free.push(self.slot_of_value[k]);
            }
        }
        for asked in given {
            let slot = match asked[0].0 {
                Operand::Value(v) => panic!("an output is value {v}, which is not computed"),
                Operand::Input(k) => self.bring(Op::Load, k),
                leaf => {
                    let Place::Scalar(k) = self.place(leaf) else {
                        unreachable!("uniforms and constants are scalars")
                    };
                    self.bring(Op::Splat, k)
                }
            };
            self.store(asked);
            self.free.push(slot);
        }
        (self.code, self.stores, self.slots as usize)
    }

    /// Writes the result of the last instruction to outputs.
    fn store(&mut self, asked: &[(Operand, u32)]) {
        self.code.last_mut().expect("an instruction comes before").stores = asked.len() as u32;
        self.stores.extend(asked.iter().map(|(_, output)| *output));
    }

    /// Returns a free slot.
    fn slot(&mut self) -> u32 {
        self.free.pop().unwrap_or_else(|| {
            self.slots += 1;
            self.slots - 1
        })
    }

    fn push(&mut self, op: Op, [a, b, c]: [u32; 3]) -> u32 {
        let to = self.slot();
        self.code.push(Code { op, stores: 0, to, a, b, c });
        to
    }

    /// Loads an input or a scalar into a slot.
    fn bring(&mut self, op: Op, from: u32) -> u32 {
        self.push(op, [from, 0, 0])
    }

    /// Returns the location of an operand; inputs are loaded at their first read.
    fn place(&mut self, operand: Operand) -> Place {
        match operand {
            Operand::Value(k) => Place::Slot(self.slot_of_value[k as usize]),
            Operand::Input(k) => {
                if self.slot_of_input[k as usize] == NONE {
                    self.slot_of_input[k as usize] = self.bring(Op::Load, k);
                }
                Place::Slot(self.slot_of_input[k as usize])
            }
            Operand::Uniform(k) => {
                assert!((k as usize) < self.program.uniforms, "uniform {k} does not exist");
                Place::Scalar(self.program.constants.len() as u32 + k)
            }
            Operand::Constant(k) => {
                assert!((k as usize) < self.program.constants.len(), "constant {k} does not exist");
                Place::Scalar(k)
            }
        }
    }

    /// Decodes instruction `k`.
    fn instruction(&mut self, k: usize, instruction: Instruction) {
        use Place::{Scalar, Slot};
        // Temporary slots of scalars for this instruction.
        let mut lent = [NONE; 2];
        let mut operands = [Slot(0); 3];
        for (place, operand) in operands.iter_mut().zip(instruction.operands()) {
            *place = self.place(operand);
        }
        let mut in_slot = |this: &mut Self, which: usize, place: Place| match place {
            Slot(slot) => slot,
            Scalar(scalar) => {
                lent[which] = this.bring(Op::Splat, scalar);
                lent[which]
            }
        };
        let [a, b, _] = operands;
        let (op, read) = match instruction {
            Instruction::Add(..) => self.commuting([Op::AddSs, Op::AddSc], a, b, &mut in_slot),
            Instruction::Mul(..) => self.commuting([Op::MulSs, Op::MulSc], a, b, &mut in_slot),
            Instruction::Sub(..) => self.ordered([Op::SubSs, Op::SubSc, Op::SubCs], a, b, &mut in_slot),
            Instruction::Div(..) => self.ordered([Op::DivSs, Op::DivSc, Op::DivCs], a, b, &mut in_slot),
            Instruction::MulAdd(..) => self.fused(
                [Op::MulAddSss, Op::MulAddSsc, Op::MulAddScs, Op::MulAddScc],
                operands,
                &mut in_slot,
            ),
            Instruction::MulSub(..) => self.fused(
                [Op::MulSubSss, Op::MulSubSsc, Op::MulSubScs, Op::MulSubScc],
                operands,
                &mut in_slot,
            ),
            Instruction::NegMulAdd(..) => self.fused(
                [Op::NegMulAddSss, Op::NegMulAddSsc, Op::NegMulAddScs, Op::NegMulAddScc],
                operands,
                &mut in_slot,
            ),
            Instruction::NegMulSub(..) => self.fused(
                [Op::NegMulSubSss, Op::NegMulSubSsc, Op::NegMulSubScs, Op::NegMulSubScc],
                operands,
                &mut in_slot,
            ),
            Instruction::Neg(_) => (Op::Neg, [in_slot(self, 0, a), 0, 0]),
            Instruction::Abs(_) => (Op::Abs, [in_slot(self, 0, a), 0, 0]),
            Instruction::Sqrt(_) => (Op::Sqrt, [in_slot(self, 0, a), 0, 0]),
            Instruction::Round(_) => (Op::Round, [in_slot(self, 0, a), 0, 0]),
            Instruction::Larger(..) => (Op::Larger, [in_slot(self, 0, a), in_slot(self, 1, b), 0]),
            Instruction::Call(function, ..) => {
                let a = in_slot(self, 0, a);
                let b = if function.is_of_two() { in_slot(self, 1, b) } else { a };
                (Op::Call(function), [a, b, 0])
            }
        };
        // The result may reuse the slot of an operand that is read for the last time: all lanes are read before any is
        // written.
        self.free.extend(lent.iter().filter(|slot| **slot != NONE));
        for operand in instruction.operands() {
            let (last, slot) = match operand {
                Operand::Value(v) => (&mut self.last_of_value[v as usize], self.slot_of_value[v as usize]),
                Operand::Input(i) => (&mut self.last_of_input[i as usize], self.slot_of_input[i as usize]),
                _ => continue,
            };
            if *last == k as u32 {
                // Freed once, even if it is read twice; no instruction has this number.
                *last = NONE - 1;
                self.free.push(slot);
            }
        }
        self.slot_of_value[k] = self.push(op, read);
    }

    fn commuting(
        &mut self,
        [ss, sc]: [Op; 2],
        a: Place,
        b: Place,
        in_slot: &mut impl FnMut(&mut Self, usize, Place) -> u32,
    ) -> (Op, [u32; 3]) {
        match (a, b) {
            (Place::Slot(a), Place::Slot(b)) => (ss, [a, b, 0]),
            (Place::Scalar(a), Place::Slot(b)) => (sc, [b, a, 0]),
            (a, Place::Scalar(b)) => (sc, [in_slot(self, 0, a), b, 0]),
        }
    }

    fn ordered(
        &mut self,
        [ss, sc, cs]: [Op; 3],
        a: Place,
        b: Place,
        in_slot: &mut impl FnMut(&mut Self, usize, Place) -> u32,
    ) -> (Op, [u32; 3]) {
        match (a, b) {
            (Place::Slot(a), Place::Slot(b)) => (ss, [a, b, 0]),
            (Place::Scalar(a), Place::Slot(b)) => (cs, [a, b, 0]),
            (a, Place::Scalar(b)) => (sc, [in_slot(self, 0, a), b, 0]),
        }
    }

    fn fused(
        &mut self,
        [sss, ssc, scs, scc]: [Op; 4],
        [a, b, c]: [Place; 3],
        in_slot: &mut impl FnMut(&mut Self, usize, Place) -> u32,
    ) -> (Op, [u32; 3]) {
        let (a, b) = if let Place::Scalar(_) = a { (b, a) } else { (a, b) };
        let a = in_slot(self, 0, a);
        match (b, c) {
            (Place::Slot(b), Place::Slot(c)) => (sss, [a, b, c]),
            (Place::Slot(b), Place::Scalar(c)) => (ssc, [a, b, c]),
            (Place::Scalar(b), Place::Slot(c)) => (scs, [a, b, c]),
            (Place::Scalar(b), Place::Scalar(c)) => (scc, [a, b, c]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::Call::{Atan2, Exp};

    /// Every instruction with operands of all kinds; each result is an output.
    fn all_instructions() -> Program {
        use Instruction::*;
        let operands = [
            Operand::Input(0),
            Operand::Input(1),
            Operand::Uniform(0),
            Operand::Uniform(1),
            Operand::Constant(0),
            Operand::Constant(1),
        ];
        let mut program =
            Program { inputs: 2, uniforms: 2, constants: vec![0.3, -1.7], ..Program::default() };
        program.instructions = vec![Add(operands[0], operands[3]), Sub(operands[1], operands[4])];
        let values = [Operand::Value(0), Operand::Value(1)];
        let all: Vec<Operand> = operands.into_iter().chain(values).collect();
        for &a in &all {
            program.instructions.extend([Neg(a), Abs(a), Sqrt(a), Round(a)]);
            program.instructions.push(Call(Exp, a, Operand::Value(u32::MAX)));
            for &b in &all {
                program.instructions.extend([Add(a, b), Sub(a, b), Mul(a, b), Div(a, b), Larger(a, b)]);
                program.instructions.push(Call(Atan2, a, b));
                for &c in &all {
                    let fused = [MulAdd(a, b, c), MulSub(a, b, c), NegMulAdd(a, b, c), NegMulSub(a, b, c)];
                    program.instructions.extend(fused);
                }
            }
        }
        program.outputs = (0..program.instructions.len() as u32).map(Operand::Value).collect();
        program.outputs.extend(operands);
        program
    }

    fn check(level: Level, fused: bool) {
        let program = all_instructions();
        let mut interpreter = Interpreter::new(&program);
        // A batch of four groups, and a single one.
        let groups = GROUPS + 1;
        let lane = |k: usize, lane: usize| (k * LANES + lane) as f64 * 0.37 - 6.1;
        let inputs: Vec<Lanes> = (0..2 * groups).map(|k| std::array::from_fn(|l| lane(k, l))).collect();
        let uniforms = [0.9, -2.3];
        let many = program.outputs.len();
        let mut outputs = vec![[0.0; LANES]; groups * many];
        interpreter.run_at(level, &inputs, &uniforms, &mut outputs);
        for k in 0..groups * LANES {
            let (group, lane) = (k / LANES, k % LANES);
            let mut values: Vec<f64> = Vec::new();
            let find = |operand: Operand, values: &[f64]| match operand {
                Operand::Value(v) => values[v as usize],
                Operand::Input(i) => inputs[2 * group + i as usize][lane],
                Operand::Uniform(u) => uniforms[u as usize],
                Operand::Constant(c) => program.constants[c as usize],
            };
            for instruction in &program.instructions {
                let value = instruction.of(|operand| find(operand, &values), fused);
                values.push(value);
            }
            for (j, operand) in program.outputs.iter().enumerate() {
                let (found, expected) = (outputs[group * many + j][lane], find(*operand, &values));
                let same = found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan();
                assert!(same, "{level:?}, {:?}: {found} for {expected}", program.instructions.get(j));
            }
        }
    }

    #[test]
    fn all_instructions_of_all_operands_give_the_bits_of_scalars_at_every_level() {
        check(Level::new(), crate::fuses());
        #[cfg(target_arch = "x86_64")]
        {
            let level = Level::new();
            if let Some(avx2) = level.as_avx2() {
                check(Level::Avx2(avx2), true);
            }
            if let Some(sse4_2) = level.as_sse4_2() {
                check(Level::Sse4_2(sse4_2), false);
            }
            if let Some(sse2) = level.as_sse2() {
                check(Level::Sse2(sse2), false);
            }
        }
    }
}
