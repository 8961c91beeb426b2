//! Derivative of a program in a direction: its tangent.

use crate::graph::Options;
use crate::number::{Number, record};
use crate::program::{Call, Instruction, Operand, Program};

/// Number of a program and its derivative in the direction; `None` if it does not depend on it.
#[derive(Clone, Copy)]
struct Tangent {
    value: Number,
    derivative: Option<Number>,
}

impl Program {
    /// Returns the program of the derivatives of all outputs in a direction of the space of its inputs.
    ///
    /// The inputs are those of this program, then one component of the direction for each of them. Components of inputs
    /// for which `moves` returns false are not read; they and the uniforms are constant. The derivative is undefined
    /// (NaN) where a magnitude is zero, or where the larger of two equal numbers is taken.
    ///
    /// ```
    /// use hardpoint_tape::{Number, Options, record};
    ///
    /// let recording = record(|| {
    ///     let [x, y] = [3.0, 4.0].map(Number::input);
    ///     [(x * x + y * y).sqrt()]
    /// });
    /// let (program, _) = recording.program(Options::default());
    /// let mut derivative = [0.0];
    /// // At (3, 4), along (1, 2): (3 + 8) / 5
    /// program.tangent(|_| true).evaluate(&[3.0, 4.0, 1.0, 2.0], &[], &mut Vec::new(), &mut derivative);
    /// assert_eq!(derivative, [2.2]);
    /// ```
    pub fn tangent(&self, moves: impl Fn(usize) -> bool) -> Self {
        let recording = record(|| {
            let inputs: Vec<Number> = (0..self.inputs).map(|_| Number::input(0.0)).collect();
            let direction: Vec<Number> = (0..self.inputs).map(|_| Number::input(0.0)).collect();
            let uniforms: Vec<Number> = (0..self.uniforms).map(|_| Number::uniform(0.0)).collect();
            let still = |value| Tangent { value, derivative: None };
            let mut values: Vec<Tangent> = Vec::with_capacity(self.instructions.len());
            let read = |operand: Operand, values: &[Tangent]| match operand {
                Operand::Value(k) => values[k as usize],
                Operand::Input(k) => Tangent {
                    value: inputs[k as usize],
                    derivative: moves(k as usize).then(|| direction[k as usize]),
                },
                Operand::Uniform(k) => still(uniforms[k as usize]),
                Operand::Constant(k) => still(Number::constant(self.constants[k as usize])),
            };
            for instruction in &self.instructions {
                let found = instruction.tangent(|operand| read(operand, &values));
                values.push(found);
            }
            let derivative = |operand: &Operand| read(*operand, &values).derivative;
            let zero = Number::constant(0.0);
            let outputs = self.outputs.iter().map(|operand| derivative(operand).unwrap_or(zero));
            outputs.collect::<Vec<_>>()
        });
        recording.program(Options::default()).0
    }
}

impl Instruction {
    /// Result and its derivative for these operands.
    fn tangent(self, x: impl Fn(Operand) -> Tangent) -> Tangent {
        use Instruction::*;
        match self {
            Add(a, b) => x(a).plus(x(b)),
            Sub(a, b) => x(a).plus(x(b).negative()),
            Mul(a, b) => x(a).times(x(b)),
            Div(a, b) => x(a).over(x(b)),
            MulAdd(a, b, c) => x(a).times(x(b)).plus(x(c)),
            MulSub(a, b, c) => x(a).times(x(b)).plus(x(c).negative()),
            NegMulAdd(a, b, c) => x(c).plus(x(a).times(x(b)).negative()),
            NegMulSub(a, b, c) => x(a).times(x(b)).negative().plus(x(c).negative()),
            Neg(a) => x(a).negative(),
            Abs(a) => {
                let a = x(a);
                let size = a.value.abs();
                a.composed(size, |d| d * (size / a.value))
            }
            Sqrt(a) => {
                let a = x(a);
                let root = a.value.sqrt();
                a.composed(root, |d| d / (root * 2.0))
            }
            Round(a) => Tangent { value: x(a).value.round(), derivative: None },
            Larger(a, b) => x(a).larger(x(b)),
            Call(function, a, b) => x(a).call(function, || x(b)),
        }
    }
}

impl Tangent {
    /// A function of this number, with its derivative along the derivative of this one.
    fn composed(self, value: Number, derivative: impl FnOnce(Number) -> Number) -> Self {
        Self { value, derivative: self.derivative.map(derivative) }
    }

    fn negative(self) -> Self {
        self.composed(-self.value, |d| -d)
    }

    fn plus(self, o: Self) -> Self {
        Self { value: self.value + o.value, derivative: sum(self.derivative, o.derivative) }
    }

    fn times(self, o: Self) -> Self {
        let terms = [self.derivative.map(|d| d * o.value), o.derivative.map(|d| self.value * d)];
        Self { value: self.value * o.value, derivative: sum(terms[0], terms[1]) }
    }

    /// (a / b)' = (a' - (a / b) b') / b
    fn over(self, o: Self) -> Self {
        let value = self.value / o.value;
        let rise = sum(self.derivative, o.derivative.map(|d| -(value * d)));
        Self { value, derivative: rise.map(|d| d / o.value) }
    }

    /// (a + b) / 2 + abs(a - b) / 2, with the derivative of that.
    fn larger(self, o: Self) -> Self {
        let apart = self.value - o.value;
        let side = || apart.abs() / apart;
        let first = self.derivative.map(|d| d * ((side() + 1.0) * 0.5));
        let second = o.derivative.map(|d| d * ((-side() + 1.0) * 0.5));
        Self { value: self.value.larger(o.value), derivative: sum(first, second) }
    }

    /// A function of one number, or of two.
    fn call(self, function: Call, other: impl FnOnce() -> Self) -> Self {
        let a = self.value;
        let one = |derivative: fn(Number, Number, Number) -> Number| {
            let value = a.call(function);
            self.composed(value, |d| derivative(a, value, d))
        };
        match function {
            Call::Atan2 => {
                let (y, x) = (self, other());
                // (x y' - y x') / (x^2 + y^2)
                let square = x.value * x.value + a * a;
                let terms = [y.derivative.map(|d| x.value * d), x.derivative.map(|d| -(a * d))];
                let turn = sum(terms[0], terms[1]).map(|d| d / square);
                Self { value: a.atan2(x.value), derivative: turn }
            }
            Call::Pow => {
                let exponent = other();
                let value = a.powf(exponent.value);
                // b a^(b - 1) a' + a^b ln(a) b'
                let base = |d| exponent.value * a.powf(exponent.value + -1.0) * d;
                let terms =
                    [self.derivative.map(base), exponent.derivative.map(|d| value * a.call(Call::Ln) * d)];
                Self { value, derivative: sum(terms[0], terms[1]) }
            }
            Call::Tan => one(|_, y, d| d * (y * y + 1.0)),
            Call::Asin => one(|a, _, d| d / slope(a)),
            Call::Acos => one(|a, _, d| -(d / slope(a))),
            Call::Atan => one(|a, _, d| d / (a * a + 1.0)),
            Call::Sinh => one(|a, _, d| d * a.call(Call::Cosh)),
            Call::Cosh => one(|a, _, d| d * a.call(Call::Sinh)),
            Call::Tanh => one(|_, y, d| d * (-(y * y) + 1.0)),
            Call::Exp => one(|_, y, d| d * y),
            Call::Ln => one(|a, _, d| d / a),
        }
    }
}

/// sqrt(1 - a^2)
fn slope(a: Number) -> Number {
    (-(a * a) + 1.0).sqrt()
}

/// Sum of two derivatives, each of which may be zero.
fn sum(a: Option<Number>, b: Option<Number>) -> Option<Number> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a + b),
        (one, None) | (None, one) => one,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Step of the central differences.
    const STEP: f64 = 1e-5;
    /// Relative error of central differences of this step: its square times third derivatives, and round-off over it.
    const NEAR: f64 = 1e-8;

    /// Compares the tangent with a central difference of the program.
    fn check(name: &str, at: [f64; 3], f: impl FnOnce([Number; 3]) -> Number) {
        let program = record(|| [f(at.map(Number::input))]).program(Options::default()).0;
        let direction = [0.3, -0.7, 0.5];
        let value = |step: f64| {
            let x: [f64; 3] = std::array::from_fn(|k| at[k] + step * direction[k]);
            let mut out = [0.0];
            program.evaluate(&x, &[], &mut Vec::new(), &mut out);
            out[0]
        };
        let expected = (value(STEP) - value(-STEP)) / (2.0 * STEP);
        let mut found = [0.0];
        let inputs = [at, direction].concat();
        program.tangent(|_| true).evaluate(&inputs, &[], &mut Vec::new(), &mut found);
        assert!(expected != 0.0, "{name} does not change");
        assert!(
            (found[0] - expected).abs() < NEAR * expected.abs().max(1.0),
            "{name}: {} instead of {expected}",
            found[0]
        );
    }

    #[test]
    fn every_operation_has_its_derivative() {
        let at = [0.6, 0.4, -0.3];
        check("sum", at, |[x, y, z]| x + y - z);
        check("product", at, |[x, y, z]| x * y * z);
        check("quotient", at, |[x, y, z]| x / y / z);
        check("a b + c", at, |[x, y, z]| x.times_plus(y, z));
        check("a b - c", at, |[x, y, z]| x.times_plus(y, -z));
        check("c - a b", at, |[x, y, z]| (-x).times_plus(y, z));
        check("-(a b) - c", at, |[x, y, z]| (-x).times_plus(y, -z));
        check("magnitude", at, |[.., z]| (z * z * z).abs());
        check("root", at, |[x, ..]| x.sqrt());
        check("larger", at, |[x, y, z]| x.larger(y) * y.larger(x) * z.larger(x));
        check("arc tangent", at, |[x, y, z]| (x * z).atan2(y));
        check("power", at, |[x, y, z]| x.powf(y * z));
        for &function in Call::ALL.iter().filter(|f| !f.is_of_two()) {
            check(function.name(), at, |[x, y, _]| (x * y).call(function));
        }
    }

    #[test]
    fn constant_inputs_are_not_read() {
        let program = record(|| {
            let [x, y] = [2.0, 3.0].map(Number::input);
            [x * y, y * y, x.round()]
        });
        let tangent = program.program(Options::default()).0.tangent(|k| k == 0);
        let mut out = [0.0; 3];
        tangent.evaluate(&[2.0, 3.0, 1.0, f64::NAN], &[], &mut Vec::new(), &mut out);
        assert_eq!(out, [3.0, 0.0, 0.0]);
    }
}
