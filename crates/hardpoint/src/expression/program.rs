//! Compiled form of an expression: operations in postfix order on a small stack.
//!
//! The form is flat: a sum of ten thousand terms is evaluated and dropped without deep recursion. No call allocates.

use std::cmp::Ordering;

use crate::number::{Function, Jet, Real};

use super::term::{Binary, ExpressionValue, Relation};

/// Maximum number of operands on the stack.
pub(crate) const MAX_WAITING: usize = 256;

/// Stack size sufficient for most expressions; clearing a larger one would cost more than the evaluation.
const FEW_WAITING: usize = 4;

/// Stack size sufficient for nearly all expressions.
const USUALLY_WAITING: usize = 12;

/// One operation: takes its operands from the stack (the last one on top) and leaves one result.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Operation {
    Constant(f64),
    /// Named parameter, by its index in the list.
    Parameter(usize),
    Time,
    Neg,
    One(Function),
    Two(Binary),
    Powi(i32),
    Powf(f64),
    /// x, x0, h0, x1, h1
    Step,
    /// For a, b, x, y: x if the comparison of a with b is true, else y.
    Select(Relation),
    /// Drops the time derivatives of an operand that depends on parameters only.
    Settle,
}

impl Operation {
    fn operands(self) -> usize {
        match self {
            Self::Constant(_) | Self::Parameter(_) | Self::Time => 0,
            Self::Neg | Self::One(_) | Self::Powi(_) | Self::Powf(_) | Self::Settle => 1,
            Self::Two(_) => 2,
            Self::Select(_) => 4,
            Self::Step => 5,
        }
    }

    /// Result for these operands; only for operations with operands.
    #[inline(always)]
    fn of<V: ExpressionValue>(self, operands: &[V]) -> V {
        match (self, operands) {
            (Self::Neg, &[x]) => -x,
            (Self::One(function), &[x]) => x.function(function),
            (Self::Two(function), &[x, y]) => function.of(x, y),
            (Self::Powi(exponent), &[x]) => x.to_whole(exponent),
            (Self::Powf(exponent), &[x]) => x.to_constant(exponent),
            (Self::Step, &[x, x0, h0, x1, h1]) => x.step(x0, h0, x1, h1),
            (Self::Select(comparison), &[a, b, x, y]) => a.choose(comparison, b, x, y),
            (Self::Settle, &[x]) => x.settled(),
            _ => unreachable!("an operation has as many operands as it says"),
        }
    }

    /// Branch of a piecewise operation for these operands. Branches that join smoothly may be distinguished.
    fn side(self, operands: &[Jet]) -> Option<u8> {
        let sign = |order: Option<Ordering>| order.map_or(9, |order| order as u8);
        let zero = Jet::constant(0.0);
        Some(match self {
            Self::One(Function::Abs) => u8::from(operands[0].order(zero) == Some(Ordering::Less)),
            Self::Two(Binary::Min | Binary::Max) => sign(operands[0].order(operands[1])),
            // The angle jumps by 2π if the point crosses the negative x axis.
            Self::Two(Binary::Atan2) if operands[1].value() >= 0.0 => 7,
            Self::Two(Binary::Atan2) => u8::from(operands[0].value() >= 0.0),
            Self::Step => {
                let is_before = |end: usize| operands[0].order(operands[end]) == Some(Ordering::Less);
                u8::from(is_before(1)) + u8::from(is_before(3))
            }
            Self::Select(comparison) => {
                comparison.holds(operands[0].value(), operands[1].value()).map_or(9, u8::from)
            }
            _ => return None,
        })
    }
}

/// Operations of an expression.
#[derive(Clone, Debug, Default)]
pub(crate) struct Program {
    operations: Vec<Operation>,
    /// For every operand on the stack: true if it depends on the time.
    waiting: Vec<bool>,
    most_waiting: usize,
    /// True if its parameters are constant in time, so that subexpressions of them have no time derivatives.
    is_of_time: bool,
}

impl Program {
    /// Empty program for a function of time, with parameters that do not depend on it.
    pub(crate) fn of_time() -> Self {
        Self { is_of_time: true, ..Self::default() }
    }

    /// Program with a constant result.
    pub(crate) fn constant(value: f64) -> Self {
        let mut program = Self::default();
        program.emit(Operation::Constant(value));
        program
    }

    /// Number of operations so far. An operand starts at the length before it was emitted.
    pub(crate) fn len(&self) -> usize {
        self.operations.len()
    }

    /// True if one more operand would exceed [`MAX_WAITING`].
    pub(crate) fn is_full(&self) -> bool {
        self.waiting.len() == MAX_WAITING
    }

    /// True if the result is a magnitude: a root of a sum of squares, or an absolute value.
    pub(crate) fn is_magnitude(&self) -> bool {
        match self.operations.last() {
            Some(Operation::Two(function)) => matches!(function, Binary::Hypot),
            Some(Operation::One(function)) => matches!(function, Function::Abs | Function::Sqrt),
            Some(Operation::Powf(exponent)) => *exponent == 0.5,
            Some(
                Operation::Constant(_)
                | Operation::Parameter(_)
                | Operation::Time
                | Operation::Neg
                | Operation::Powi(_)
                | Operation::Step
                | Operation::Select(_)
                | Operation::Settle,
            )
            | None => false,
        }
    }

    /// Value of the operation at `index` if it is a number.
    pub(crate) fn constant_at(&self, index: usize) -> Option<f64> {
        match self.operations.get(index) {
            Some(&Operation::Constant(value)) => Some(value),
            _ => None,
        }
    }

    /// Appends an operation whose operands have been emitted.
    pub(crate) fn emit(&mut self, operation: Operation) {
        let operands = operation.operands();
        let left = self.waiting.len() - operands;
        let is_timed = matches!(operation, Operation::Time) || self.waiting[left..].contains(&true);
        self.waiting.truncate(left);
        self.waiting.push(is_timed);
        self.most_waiting = self.most_waiting.max(self.waiting.len());

        let start = self.len() - operands.min(self.len());
        self.operations.push(operation);
        if operands == 0 || is_timed {
            return;
        }
        // A subexpression that does not depend on t has no derivatives, even if its jet would have infinity times zero,
        // as for sqrt(0). An operand that is a number is one operation, so all operands are numbers if all operations
        // since `start` are.
        if (start..self.len() - 1).all(|index| self.constant_at(index).is_some()) {
            let mut stack = [f64::NAN; USUALLY_WAITING];
            let operations = &self.operations[start..];
            let value = run(operations, f64::NAN, |_| f64::NAN, |_, _| (), &mut stack);
            self.operations.truncate(start);
            self.operations.push(Operation::Constant(value));
        } else if self.is_of_time {
            self.operations.push(Operation::Settle);
        }
    }

    /// Appends the power of the last two operands; with faster rules if the exponent is a number.
    pub(crate) fn emit_power(&mut self) {
        let exponent = self.constant_at(self.len() - 1);
        let Some(exponent) = exponent else {
            return self.emit(Operation::Two(Binary::Pow));
        };
        self.operations.pop();
        self.waiting.pop();
        // Longer products of the base would lose accuracy.
        let is_small_integer = exponent.fract() == 0.0 && exponent.abs() <= 16.0;
        self.emit(if is_small_integer {
            Operation::Powi(exponent as i32)
        } else {
            Operation::Powf(exponent)
        });
    }

    /// Removes the last operand, which starts at `start`.
    pub(crate) fn drop_operand(&mut self, start: usize) {
        self.operations.truncate(start);
        self.waiting.pop();
    }

    /// This program with numbers for its parameters, identical to that of the text with these numbers.
    pub(crate) fn with_values(&self, values: &[f64]) -> Self {
        self.with_leaves(|parameter| Operation::Constant(values[parameter]))
    }

    /// This program with each parameter replaced by a number or by another parameter.
    pub(crate) fn with_leaves(&self, leaf: impl Fn(usize) -> Operation) -> Self {
        let mut program = Self { is_of_time: self.is_of_time, ..Self::default() };
        for &operation in &self.operations {
            match operation {
                Operation::Parameter(parameter) => program.emit(leaf(parameter)),
                Operation::Two(Binary::Pow) => program.emit_power(),
                Operation::Settle => {}
                _ => program.emit(operation),
            }
        }
        program
    }

    /// Result at a time for the given parameters, in the scalar type of the time.
    #[inline(always)]
    pub(crate) fn at<V: ExpressionValue>(&self, time: V, parameter: impl Fn(usize) -> V) -> V {
        self.watched(time, parameter, |_, _| ())
    }

    /// Result like [`at`](Self::at); `watch` is called before each operation, with its operands.
    #[inline(always)]
    fn watched<V: ExpressionValue>(
        &self,
        time: V,
        parameter: impl Fn(usize) -> V,
        watch: impl FnMut(Operation, &[V]),
    ) -> V {
        let (mut few, mut usual);
        let stack: &mut [V] = if self.most_waiting <= FEW_WAITING {
            few = [time; FEW_WAITING];
            &mut few
        } else if self.most_waiting <= USUALLY_WAITING {
            usual = [time; USUALLY_WAITING];
            &mut usual
        } else {
            return self.with_full_stack(time, parameter, watch);
        };
        run(&self.operations, time, parameter, watch, stack)
    }

    /// A separate function, so that other programs do not pay for the large stack.
    #[cold]
    #[inline(never)]
    fn with_full_stack<V: ExpressionValue>(
        &self,
        time: V,
        parameter: impl Fn(usize) -> V,
        watch: impl FnMut(Operation, &[V]),
    ) -> V {
        run(&self.operations, time, parameter, watch, &mut [time; MAX_WAITING])
    }

    /// True if any operation has several branches.
    pub(crate) fn has_sides(&self) -> bool {
        self.operations.iter().any(|operation| {
            use Operation::{One, Select, Step, Two};
            matches!(
                operation,
                One(Function::Abs) | Two(Binary::Min | Binary::Max | Binary::Atan2) | Step | Select(_)
            )
        })
    }

    /// Branches of the piecewise operations at time `t`, in the order of the operations; for programs without
    /// parameters.
    pub(crate) fn sides(&self, t: f64, sides: &mut Vec<u8>) {
        sides.clear();
        let watch = |operation: Operation, operands: &[Jet]| sides.extend(operation.side(operands));
        self.watched(Jet::time(t), |_| Jet::constant(f64::NAN), watch);
    }
}

/// Runs the operations on an empty stack.
#[inline(always)]
fn run<V: ExpressionValue>(
    operations: &[Operation],
    time: V,
    parameter: impl Fn(usize) -> V,
    mut watch: impl FnMut(Operation, &[V]),
    stack: &mut [V],
) -> V {
    let mut len = 0;
    for &operation in operations {
        len -= operation.operands();
        let operands = &stack[len..len + operation.operands()];
        watch(operation, operands);
        stack[len] = match operation {
            Operation::Constant(value) => V::number(value),
            Operation::Parameter(index) => parameter(index),
            Operation::Time => time,
            _ => operation.of(operands),
        };
        len += 1;
    }
    stack[0]
}
