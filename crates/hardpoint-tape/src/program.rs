//! A straight-line program: what is left of a recording, in the order in which it is computed.
//!
//! Every number is a vector of [`LANES`] scalars side by side; constants and uniforms are the same in all lanes.

/// How many scalars sit side by side.
pub const LANES: usize = 8;

/// The scalars of one number, lane by lane.
pub type Lanes = [f64; LANES];

/// Where an instruction finds a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Operand {
    /// The result of an earlier instruction.
    Value(u32),
    /// An input, lane by lane.
    Input(u32),
    /// A number that is the same in all lanes, given with every run.
    Uniform(u32),
    /// A number of the program itself, by its place in [`Program::constants`].
    Constant(u32),
}

/// A function that is not arithmetic: the standard library evaluates it lane by lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Call {
    /// Tangent.
    Tan,
    /// Arc sine.
    Asin,
    /// Arc cosine.
    Acos,
    /// Arc tangent.
    Atan,
    /// Hyperbolic sine.
    Sinh,
    /// Hyperbolic cosine.
    Cosh,
    /// Hyperbolic tangent.
    Tanh,
    /// Exponential function.
    Exp,
    /// Natural logarithm.
    Ln,
    /// Of two: `a.atan2(b)`, the angle of the point (b, a).
    Atan2,
    /// Of two: `a.powf(b)`.
    Pow,
}

impl Call {
    /// The function of one scalar, or of two; `b` is ignored by functions of one.
    pub fn of(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Tan => a.tan(),
            Self::Asin => a.asin(),
            Self::Acos => a.acos(),
            Self::Atan => a.atan(),
            Self::Sinh => a.sinh(),
            Self::Cosh => a.cosh(),
            Self::Tanh => a.tanh(),
            Self::Exp => a.exp(),
            Self::Ln => a.ln(),
            Self::Atan2 => a.atan2(b),
            Self::Pow => a.powf(b),
        }
    }

    /// Whether it is a function of two numbers.
    pub fn is_of_two(self) -> bool {
        matches!(self, Self::Atan2 | Self::Pow)
    }
}

/// One instruction; its result is the value of its own number.
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
    /// The magnitude of `a`.
    Abs(Operand),
    /// The square root of `a`.
    Sqrt(Operand),
    /// The nearest integer, ties to even.
    Round(Operand),
    /// The larger of two; NaN where either is NaN.
    Larger(Operand, Operand),
    /// The second operand is ignored by functions of one number.
    Call(Call, Operand, Operand),
}

/// A straight-line program.
///
/// Instruction `k` computes [`Operand::Value`]`(k)` and reads values below `k` only.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    /// How many inputs a run is given for each group of [`LANES`].
    pub inputs: usize,
    /// How many uniforms a run is given.
    pub uniforms: usize,
    /// The numbers of the program itself.
    pub constants: Vec<f64>,
    /// What is computed, in this order.
    pub instructions: Vec<Instruction>,
    /// What is given back, in this order.
    pub outputs: Vec<Operand>,
}
