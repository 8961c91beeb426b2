//! The form in which a law is evaluated: operations in postfix order on a small stack.
//!
//! Being flat, a sum of ten thousand terms needs no deep recursion, neither to be evaluated nor to be dropped; and
//! nothing is allocated per call.

use super::jet::TimeJet;

/// The most operands that may wait for their operation.
pub(super) const MAX_WAITING: usize = 256;

/// What suffices for nearly every law; clearing the full stack would cost more than evaluating most of them.
const USUALLY_WAITING: usize = 12;

/// One operation: takes its operands from the stack, the last on top, and leaves one result.
#[derive(Clone, Copy)]
pub(super) enum Operation {
    Constant(f64),
    Time,
    One(fn(TimeJet) -> TimeJet),
    Two(fn(TimeJet, TimeJet) -> TimeJet),
    Powi(i32),
    Powf(f64),
    /// x, x0, h0, x1, h1
    Step,
    /// Of a, b, x, y: x where the comparison of a with b holds, else y.
    Select(fn(&f64, &f64) -> bool),
}

impl Operation {
    fn operands(self) -> usize {
        match self {
            Self::Constant(_) | Self::Time => 0,
            Self::One(_) | Self::Powi(_) | Self::Powf(_) => 1,
            Self::Two(_) => 2,
            Self::Select(_) => 4,
            Self::Step => 5,
        }
    }
}

/// The operations of a law.
#[derive(Clone, Default)]
pub(super) struct Program {
    operations: Vec<Operation>,
    waiting: usize,
    most_waiting: usize,
}

impl Program {
    /// The number of operations so far; an operand begins at the length before it was emitted.
    pub(super) fn len(&self) -> usize {
        self.operations.len()
    }

    /// Whether one more operand would exceed [`MAX_WAITING`].
    pub(super) fn is_full(&self) -> bool {
        self.waiting == MAX_WAITING
    }

    /// The number that is the operation at `index`, if it is one.
    pub(super) fn constant_at(&self, index: usize) -> Option<f64> {
        match self.operations.get(index) {
            Some(&Operation::Constant(value)) => Some(value),
            _ => None,
        }
    }

    /// Appends an operation whose operands are there already.
    pub(super) fn emit(&mut self, operation: Operation) {
        self.waiting = self.waiting + 1 - operation.operands();
        self.most_waiting = self.most_waiting.max(self.waiting);
        let start = self.len() - operation.operands().min(self.len());
        self.operations.push(operation);
        // What does not depend on t has no derivatives, also where its jet's are infinite times zero: sqrt(0). An
        // operand that is a number is one operation, so the operands are all numbers if that many operations are.
        if operation.operands() > 0 && (start..self.len() - 1).all(|index| self.constant_at(index).is_some())
        {
            let value = evaluate::<USUALLY_WAITING>(&self.operations[start..], f64::NAN).value();
            self.operations.truncate(start);
            self.operations.push(Operation::Constant(value));
        }
    }

    /// Appends the power of the last two operands; with the faster rules if the exponent is a number.
    pub(super) fn emit_power(&mut self) {
        let exponent = self.constant_at(self.len() - 1);
        let Some(exponent) = exponent else {
            return self.emit(Operation::Two(TimeJet::pow));
        };
        self.operations.pop();
        self.waiting -= 1;
        // Longer products of the base would cost digits.
        let is_small_integer = exponent.fract() == 0.0 && exponent.abs() <= 16.0;
        self.emit(if is_small_integer {
            Operation::Powi(exponent as i32)
        } else {
            Operation::Powf(exponent)
        });
    }

    /// Drops the last operand, which began at `start`.
    pub(super) fn drop_operand(&mut self, start: usize) {
        self.operations.truncate(start);
        self.waiting -= 1;
    }

    /// The program's result at time `t`.
    pub(super) fn evaluate(&self, t: f64) -> TimeJet {
        if self.most_waiting <= USUALLY_WAITING {
            evaluate::<USUALLY_WAITING>(&self.operations, t)
        } else {
            evaluate::<MAX_WAITING>(&self.operations, t)
        }
    }
}

fn evaluate<const N: usize>(operations: &[Operation], t: f64) -> TimeJet {
    let mut stack = [TimeJet::constant(0.0); N];
    let mut len = 0;
    for &operation in operations {
        len -= operation.operands();
        stack[len] = match operation {
            Operation::Constant(value) => TimeJet::constant(value),
            Operation::Time => TimeJet::time(t),
            Operation::One(function) => function(stack[len]),
            Operation::Two(function) => function(stack[len], stack[len + 1]),
            Operation::Powi(exponent) => stack[len].powi(exponent),
            Operation::Powf(exponent) => stack[len].powf(exponent),
            Operation::Step => {
                stack[len].step(stack[len + 1], stack[len + 2], stack[len + 3], stack[len + 4])
            }
            Operation::Select(holds) => {
                let (a, b) = (stack[len].value(), stack[len + 1].value());
                if a.is_nan() || b.is_nan() {
                    TimeJet::constant(f64::NAN)
                } else if holds(&a, &b) {
                    stack[len + 2]
                } else {
                    stack[len + 3]
                }
            }
        };
        len += 1;
    }
    stack[0]
}
