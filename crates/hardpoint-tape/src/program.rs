//! Straight-line programs.
//!
//! Every number is a vector of [`LANES`] scalars; constants and uniforms are the same in all lanes.

use fearless_simd::{Level, SimdBase, SimdFloat, dispatch, f64x8};

/// Number of scalars in a vector.
pub const LANES: usize = 8;

/// Scalars of one number, lane by lane.
pub type Lanes = [f64; LANES];

/// Source of an operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Operand {
    /// Result of an earlier instruction.
    Value(u32),
    /// Input, lane by lane.
    Input(u32),
    /// Uniform: a number that is the same in all lanes, given with every run.
    Uniform(u32),
    /// Constant of the program, by its index in [`Program::constants`].
    Constant(u32),
}

/// Declares the functions that are not arithmetic: number of arguments, name, and definition.
macro_rules! calls {
    ($($(#[$doc:meta])* $Call:ident $name:literal of $operands:literal |$a:pat_param, $b:pat_param| $value:expr;)*) => {
        /// Function that is not arithmetic: the standard library evaluates it lane by lane.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Call {
            $($(#[$doc])* $Call,)*
        }

        impl Call {
            /// All functions.
            pub const ALL: &[Self] = &[$(Self::$Call),*];

            /// Returns the mathematical name.
            pub fn name(self) -> &'static str {
                match self { $(Self::$Call => $name),* }
            }

            /// Returns the function of one scalar, or of two; functions of one ignore `b`.
            pub fn of(self, a: f64, b: f64) -> f64 {
                match self { $(Self::$Call => { let ($a, $b) = (a, b); $value })* }
            }

            /// True if it is a function of two numbers.
            pub fn is_of_two(self) -> bool {
                match self { $(Self::$Call => $operands == 2),* }
            }
        }
    };
}

calls! {
    /// Tangent.
    Tan "tan" of 1 |a, _| a.tan();
    /// Arc sine.
    Asin "asin" of 1 |a, _| a.asin();
    /// Arc cosine.
    Acos "acos" of 1 |a, _| a.acos();
    /// Arc tangent.
    Atan "atan" of 1 |a, _| a.atan();
    /// Hyperbolic sine.
    Sinh "sinh" of 1 |a, _| a.sinh();
    /// Hyperbolic cosine.
    Cosh "cosh" of 1 |a, _| a.cosh();
    /// Hyperbolic tangent.
    Tanh "tanh" of 1 |a, _| a.tanh();
    /// Exponential function.
    Exp "exp" of 1 |a, _| a.exp();
    /// Natural logarithm.
    Ln "ln" of 1 |a, _| a.ln();
    /// `a.atan2(b)`, the angle of the point (b, a).
    Atan2 "atan2" of 2 |a, b| a.atan2(b);
    /// `a.powf(b)`.
    Pow "pow" of 2 |a, b| a.powf(b);
}

/// Returns the larger of two numbers; NaN if either is NaN.
#[inline(always)]
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if b <= a || a.is_nan() { a } else { b }
}

/// Instruction; its result is the value with its own index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Instruction {
    /// `a + b`.
    Add(Operand, Operand),
    /// `a - b`.
    Sub(Operand, Operand),
    /// `a b`.
    Mul(Operand, Operand),
    /// `a / b`.
    Div(Operand, Operand),
    /// `a b + c`, rounded once.
    MulAdd(Operand, Operand, Operand),
    /// `a b - c`, rounded once.
    MulSub(Operand, Operand, Operand),
    /// `c - a b`, rounded once.
    NegMulAdd(Operand, Operand, Operand),
    /// `-(a b) - c`, rounded once.
    NegMulSub(Operand, Operand, Operand),
    /// `-a`.
    Neg(Operand),
    /// Magnitude of `a`.
    Abs(Operand),
    /// Square root of `a`.
    Sqrt(Operand),
    /// Nearest integer, ties to even.
    Round(Operand),
    /// Larger of two numbers; NaN if either is NaN.
    Larger(Operand, Operand),
    /// Function; functions of one number ignore the second operand.
    Call(Call, Operand, Operand),
}

/// Straight-line program.
///
/// Instruction `k` computes [`Operand::Value`]`(k)` and reads values below `k` only.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    /// Number of inputs of a run for each group of [`LANES`].
    pub inputs: usize,
    /// Number of uniforms of a run.
    pub uniforms: usize,
    /// Constants of the program.
    pub constants: Vec<f64>,
    /// Instructions, in order.
    pub instructions: Vec<Instruction>,
    /// Outputs, in order.
    pub outputs: Vec<Operand>,
}

impl Instruction {
    /// Returns the operands that it reads, in order.
    pub fn operands(self) -> impl Iterator<Item = Operand> {
        use Instruction::*;
        let read = match self {
            Neg(a) | Abs(a) | Sqrt(a) | Round(a) => [Some(a), None, None],
            Call(function, a, b) => [Some(a), function.is_of_two().then_some(b), None],
            Add(a, b) | Sub(a, b) | Mul(a, b) | Div(a, b) | Larger(a, b) => [Some(a), Some(b), None],
            MulAdd(a, b, c) | MulSub(a, b, c) | NegMulAdd(a, b, c) | NegMulSub(a, b, c) => {
                [Some(a), Some(b), Some(c)]
            }
        };
        read.into_iter().flatten()
    }

    /// Returns the same instruction with other operands.
    pub fn map(self, mut f: impl FnMut(Operand) -> Operand) -> Self {
        use Instruction::*;
        match self {
            Add(a, b) => Add(f(a), f(b)),
            Sub(a, b) => Sub(f(a), f(b)),
            Mul(a, b) => Mul(f(a), f(b)),
            Div(a, b) => Div(f(a), f(b)),
            MulAdd(a, b, c) => MulAdd(f(a), f(b), f(c)),
            MulSub(a, b, c) => MulSub(f(a), f(b), f(c)),
            NegMulAdd(a, b, c) => NegMulAdd(f(a), f(b), f(c)),
            NegMulSub(a, b, c) => NegMulSub(f(a), f(b), f(c)),
            Neg(a) => Neg(f(a)),
            Abs(a) => Abs(f(a)),
            Sqrt(a) => Sqrt(f(a)),
            Round(a) => Round(f(a)),
            Larger(a, b) => Larger(f(a), f(b)),
            Call(function, a, b) if function.is_of_two() => Call(function, f(a), f(b)),
            Call(function, a, _) => {
                let a = f(a);
                Call(function, a, a)
            }
        }
    }

    /// Returns the result for scalar operands; if `fused`, products are fused with sums ([`fuses`]).
    pub fn of(self, mut x: impl FnMut(Operand) -> f64, fused: bool) -> f64 {
        use Instruction::*;
        let product_plus = |a: f64, b: f64, c: f64| if fused { a.mul_add(b, c) } else { a * b + c };
        match self {
            Add(a, b) => x(a) + x(b),
            Sub(a, b) => x(a) - x(b),
            Mul(a, b) => x(a) * x(b),
            Div(a, b) => x(a) / x(b),
            MulAdd(a, b, c) => product_plus(x(a), x(b), x(c)),
            MulSub(a, b, c) => product_plus(x(a), x(b), -x(c)),
            NegMulAdd(a, b, c) => product_plus(-x(a), x(b), x(c)),
            NegMulSub(a, b, c) => product_plus(-x(a), x(b), -x(c)),
            Neg(a) => -x(a),
            Abs(a) => x(a).abs(),
            Sqrt(a) => x(a).sqrt(),
            Round(a) => x(a).round_ties_even(),
            Larger(a, b) => larger(x(a), x(b)),
            Call(function, a, b) if function.is_of_two() => function.of(x(a), x(b)),
            Call(function, a, _) => {
                let a = x(a);
                function.of(a, a)
            }
        }
    }
}

impl Program {
    /// Runs the program once for scalars, instruction by instruction; `values` is working memory of the caller.
    ///
    /// Use it for values that are computed once for many runs ([`Program::hoisted`]). It agrees with the lanes of the
    /// [`Interpreter`](crate::Interpreter) bit for bit.
    ///
    /// # Panics
    ///
    /// If there are fewer `inputs`, `uniforms` or `outputs` than in the program.
    pub fn evaluate(&self, inputs: &[f64], uniforms: &[f64], values: &mut Vec<f64>, outputs: &mut [f64]) {
        let fused = fuses();
        values.clear();
        values.reserve(self.instructions.len());
        let find = |operand: Operand, values: &[f64]| match operand {
            Operand::Value(k) => values[k as usize],
            Operand::Input(k) => inputs[k as usize],
            Operand::Uniform(k) => uniforms[k as usize],
            Operand::Constant(k) => self.constants[k as usize],
        };
        for instruction in &self.instructions {
            let value = instruction.of(|operand| find(operand, values), fused);
            values.push(value);
        }
        for (j, operand) in self.outputs.iter().enumerate() {
            outputs[j] = find(*operand, values);
        }
    }

    /// Returns the maximum number of live values: computed, and still to be read. Values that are only outputs are
    /// written immediately and do not count.
    pub fn live(&self) -> usize {
        let mut last = vec![0; self.instructions.len()];
        for (k, instruction) in self.instructions.iter().enumerate() {
            for operand in instruction.operands() {
                if let Operand::Value(v) = operand {
                    last[v as usize] = k;
                }
            }
        }
        let (mut now, mut most) = (0, 0);
        for (k, instruction) in self.instructions.iter().enumerate() {
            for operand in instruction.operands() {
                if let Operand::Value(v) = operand
                    && last[v as usize] == k
                {
                    // Counted once, even if an instruction reads the same value twice.
                    last[v as usize] = usize::MAX;
                    now -= 1;
                }
            }
            if last[k] > k {
                now += 1;
                most = most.max(now);
            }
        }
        most
    }
}

/// Returns true if lanes of this CPU fuse a product with a sum and round once. Otherwise both operations round.
pub fn fuses() -> bool {
    // (1 + h)^2 - (1 + 2 h) is h^2, or 0 if the square is rounded first.
    const H: f64 = 1.0 / (1u64 << 30) as f64;
    dispatch!(Level::new(), simd => {
        let lanes = |x: f64| f64x8::splat(simd, x);
        std::hint::black_box(lanes(1.0 + H)).mul_sub(lanes(1.0 + H), lanes(1.0 + 2.0 * H)).as_slice()[0] != 0.0
    })
}
