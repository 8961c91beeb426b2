//! The form in which an expression is evaluated: operations in postfix order on a small stack.
//!
//! Being flat, a sum of ten thousand terms needs no deep recursion, neither to be evaluated nor to be dropped; and
//! nothing is allocated per call.

use std::cmp::Ordering;

use super::function::{Binary, Comparison, Unary};
use super::jet::TimeJet;
use super::lanes::{Lanes, lane_by_lane};
use super::range::Stretch;
use super::scalar::{Arithmetic, Scalar};
use crate::space::Real;

/// The most operands that may wait for their operation.
pub(super) const MAX_WAITING: usize = 256;

/// What suffices for nearly every law; clearing the full stack would cost more than evaluating most of them.
const USUALLY_WAITING: usize = 12;

/// As much for many times at once, where clearing the stack costs more.
const FEW_WAITING: usize = 4;

/// One operation: takes its operands from the stack, the last on top, and leaves one result.
#[derive(Clone, Copy, Debug)]
pub(super) enum Operation {
    Constant(f64),
    /// A named parameter, by its place in the list.
    Parameter(usize),
    Time,
    One(Unary),
    Two(Binary),
    Powi(i32),
    Powf(f64),
    /// x, x0, h0, x1, h1
    Step,
    /// Of a, b, x, y: x where the comparison of a with b holds, else y.
    Select(Comparison),
    /// The value alone, of what depends on parameters only.
    Settle,
}

/// The most operands that an operation has.
const MOST_OPERANDS: usize = 5;

impl Operation {
    fn operands(self) -> usize {
        match self {
            Self::Constant(_) | Self::Parameter(_) | Self::Time => 0,
            Self::One(_) | Self::Powi(_) | Self::Powf(_) | Self::Settle => 1,
            Self::Two(_) => 2,
            Self::Select(_) => 4,
            Self::Step => 5,
        }
    }

    /// The result for these operands; of an operation that has any.
    fn apply<S: Scalar>(self, operands: &[TimeJet<S>]) -> TimeJet<S> {
        match (self, operands) {
            (Self::One(function), &[x]) => function.apply(x),
            (Self::Two(function), &[x, y]) => function.apply(x, y),
            (Self::Powi(exponent), &[x]) => x.powi(exponent),
            (Self::Powf(exponent), &[x]) => x.powf(S::fixed(exponent)),
            (Self::Step, &[x, x0, h0, x1, h1]) => x.step(x0, h0, x1, h1),
            (Self::Select(comparison), &[a, b, x, y]) => {
                match comparison.holds(a.value().value(), b.value().value()) {
                    Some(true) => x,
                    Some(false) => y,
                    None => TimeJet::undefined(),
                }
            }
            (Self::Settle, &[x]) => TimeJet::constant(x.value()),
            _ => unreachable!("an operation has as many operands as it says"),
        }
    }

    /// The result for operands that are several numbers side by side: what is arithmetic side by side, all else lane by
    /// lane, so that every lane takes its own side.
    #[inline(always)]
    fn apply_to_lanes<R: Real>(self, operands: &[TimeJet<Lanes<R>>]) -> TimeJet<Lanes<R>> {
        match (self, operands) {
            (Self::One(Unary::Neg), &[x]) => -x,
            (Self::One(Unary::Sin), &[x]) => x.sin(),
            (Self::One(Unary::Cos), &[x]) => x.cos(),
            (Self::One(Unary::Sqrt), &[x]) => x.sqrt(),
            (Self::Two(Binary::Add), &[x, y]) => x + y,
            (Self::Two(Binary::Sub), &[x, y]) => x - y,
            (Self::Two(Binary::Mul), &[x, y]) => x * y,
            (Self::Two(Binary::Div), &[x, y]) => x / y,
            (Self::Powi(exponent), &[x]) => x.powi(exponent),
            (Self::Settle, &[x]) => TimeJet::constant(x.value()),
            _ => {
                let mut single = [TimeJet::constant(0.0); MOST_OPERANDS];
                lane_by_lane(operands[0].value(), |lane| {
                    for (single, operand) in single.iter_mut().zip(operands) {
                        *single = operand.lane(lane);
                    }
                    self.apply(&single[..operands.len()])
                })
            }
        }
    }

    /// The result for operands over a stretch of time.
    fn over_stretch(self, operands: &[Stretch]) -> Stretch {
        match (self, operands) {
            (Self::One(function), &[x]) => function.over_stretch(x),
            (Self::Two(function), &[x, y]) => function.over_stretch(x, y),
            (Self::Powi(exponent), &[x]) => x.powi(exponent),
            (Self::Powf(exponent), &[x]) => x.powf(exponent),
            (Self::Step, &[x, x0, h0, x1, h1]) => x.step(x0, h0, x1, h1),
            (Self::Select(comparison), &[a, b, x, y]) => {
                Stretch::choose(comparison.holds_between(a.value, b.value), x, y)
            }
            // What depends on parameters only does not change.
            (Self::Settle, &[x]) => x,
            _ => unreachable!("an operation has as many operands as it says"),
        }
    }

    /// The result for operands over any scalar.
    fn over<R: Real>(self, operands: &[R]) -> R {
        match (self, operands) {
            (Self::One(function), &[x]) => function.over(x),
            (Self::Two(function), &[x, y]) => function.over(x, y),
            (Self::Powi(exponent), &[x]) => powi(x, exponent),
            (Self::Powf(exponent), &[x]) => x.powf(exponent),
            (Self::Step, &[x, x0, h0, x1, h1]) => {
                // h0 + (h1 - h0) (3 u² - 2 u³)
                let u = (x - x0) / (x1 - x0);
                let between = h0 + (h1 - h0) * (u * u * (x.like(3.0) - u * x.like(2.0)));
                let up = h1.select(between, |k| x.lane(k) >= x1.lane(k));
                let up = h0.select(up, |k| x.lane(k) < x0.lane(k));
                up.select(x.like(f64::NAN), |k| x0.lane(k) < x1.lane(k))
            }
            (Self::Select(comparison), &[a, b, x, y]) => {
                let holds = |k: usize| comparison.holds(a.lane(k), b.lane(k));
                let chosen = x.select(y, |k| holds(k) == Some(true));
                chosen.select(x.like(f64::NAN), |k| holds(k).is_some())
            }
            (Self::Settle, &[x]) => x,
            _ => unreachable!("an operation has as many operands as it says"),
        }
    }

    /// Which of its sides an operation with sides takes for these operands. Sides that join smoothly may be told apart.
    fn side(self, operands: &[TimeJet]) -> Option<u8> {
        let sign = |order: Option<Ordering>| order.map_or(9, |order| order as u8);
        let zero = TimeJet::constant(0.0);
        Some(match self {
            Self::One(Unary::Abs) => {
                u8::from(sign(operands[0].cmp_just_after(zero)) == sign(Some(Ordering::Less)))
            }
            Self::Two(Binary::Min | Binary::Max) => sign(operands[0].cmp_just_after(operands[1])),
            // The angle jumps by 2π where the point crosses the negative x axis.
            Self::Two(Binary::Atan2) if operands[1].value() >= 0.0 => 7,
            Self::Two(Binary::Atan2) => u8::from(operands[0].value() >= 0.0),
            Self::Step => {
                let is_before =
                    |end: usize| operands[0].cmp_just_after(operands[end]) == Some(Ordering::Less);
                u8::from(is_before(1)) + u8::from(is_before(3))
            }
            Self::Select(comparison) => {
                comparison.holds(operands[0].value(), operands[1].value()).map_or(9, u8::from)
            }
            _ => return None,
        })
    }
}

/// By repeated squaring, in the order in which `f64::powi` multiplies.
fn powi<R: Real>(x: R, exponent: i32) -> R {
    let (mut power, mut square, mut left) = (x.like(1.0), x, exponent.unsigned_abs());
    while left > 0 {
        if left & 1 == 1 {
            power = power * square;
        }
        left >>= 1;
        if left > 0 {
            square = square * square;
        }
    }
    if exponent < 0 { x.like(1.0) / power } else { power }
}

/// The operations of an expression.
#[derive(Clone, Debug, Default)]
pub(super) struct Program {
    operations: Vec<Operation>,
    /// For every operand that waits, whether it depends on the time.
    waiting: Vec<bool>,
    most_waiting: usize,
}

impl Program {
    /// The program that is a number.
    pub(super) fn constant(value: f64) -> Self {
        let mut program = Self::default();
        program.emit(Operation::Constant(value));
        program
    }

    /// The number of operations so far; an operand begins at the length before it was emitted.
    pub(super) fn len(&self) -> usize {
        self.operations.len()
    }

    /// Whether one more operand would exceed [`MAX_WAITING`].
    pub(super) fn is_full(&self) -> bool {
        self.waiting.len() == MAX_WAITING
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
        // What does not depend on t has no derivatives, also where its jet's are infinite times zero: sqrt(0). An
        // operand that is a number is one operation, so the operands are all numbers if that many operations are.
        if (start..self.len() - 1).all(|index| self.constant_at(index).is_some()) {
            let t = TimeJet::constant(f64::NAN);
            let value =
                evaluate::<f64, USUALLY_WAITING>(&self.operations[start..], t, fixed, |_, _| ()).value();
            self.operations.truncate(start);
            self.operations.push(Operation::Constant(value));
        } else {
            self.operations.push(Operation::Settle);
        }
    }

    /// Appends the power of the last two operands; with the faster rules if the exponent is a number.
    pub(super) fn emit_power(&mut self) {
        let exponent = self.constant_at(self.len() - 1);
        let Some(exponent) = exponent else {
            return self.emit(Operation::Two(Binary::Pow));
        };
        self.operations.pop();
        self.waiting.pop();
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
        self.waiting.pop();
    }

    /// The program with numbers for its parameters: the one that the text with these numbers in it would have given.
    pub(super) fn with_values(&self, values: &[f64]) -> Self {
        self.with_leaves(|parameter| Operation::Constant(values[parameter]))
    }

    /// The program with a number, or another parameter, for each of its parameters.
    pub(super) fn with_leaves(&self, leaf: impl Fn(usize) -> Operation) -> Self {
        let mut program = Self::default();
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

    /// The program's result at a time, for the given parameters.
    pub(super) fn evaluate<S: Scalar>(&self, time: TimeJet<S>, parameter: impl Fn(usize) -> S) -> TimeJet<S> {
        if self.most_waiting <= USUALLY_WAITING {
            evaluate::<S, USUALLY_WAITING>(&self.operations, time, parameter, |_, _| ())
        } else {
            evaluate::<S, MAX_WAITING>(&self.operations, time, parameter, |_, _| ())
        }
    }

    /// The program's result at several times, which run forwards; without parameters.
    #[inline(always)]
    pub(super) fn at_lanes<R: Real>(&self, times: Lanes<R>) -> TimeJet<Lanes<R>> {
        if self.most_waiting <= FEW_WAITING {
            evaluate_lanes::<R, FEW_WAITING>(&self.operations, times)
        } else if self.most_waiting <= USUALLY_WAITING {
            evaluate_lanes::<R, USUALLY_WAITING>(&self.operations, times)
        } else {
            self.at_lanes_with_full_stack(times)
        }
    }

    /// Apart, so that no other program pays for room on the stack that only this one needs.
    #[cold]
    #[inline(never)]
    fn at_lanes_with_full_stack<R: Real>(&self, times: Lanes<R>) -> TimeJet<Lanes<R>> {
        times.0.within(
            #[inline(always)]
            || evaluate_lanes::<R, MAX_WAITING>(&self.operations, times),
        )
    }

    /// Bounds of the program's result, and of its rate, from one time to another; without parameters.
    pub(super) fn over_stretch(&self, from: f64, to: f64) -> Stretch {
        if self.most_waiting <= USUALLY_WAITING {
            over_stretch::<USUALLY_WAITING>(&self.operations, from, to)
        } else {
            over_stretch::<MAX_WAITING>(&self.operations, from, to)
        }
    }

    /// The program's result over any scalar, for the given parameters; of a program that does not know the time.
    pub(super) fn over<R: Real>(&self, witness: R, parameter: impl Fn(usize) -> R) -> R {
        let mut stack: Vec<R> = Vec::with_capacity(self.most_waiting);
        for &operation in &self.operations {
            let left = stack.len() - operation.operands();
            let result = match operation {
                Operation::Constant(value) => witness.like(value),
                Operation::Parameter(index) => parameter(index),
                Operation::Time => witness.like(f64::NAN),
                _ => operation.over(&stack[left..]),
            };
            stack.truncate(left);
            stack.push(result);
        }
        stack.pop().unwrap_or(witness)
    }

    /// Whether any operation has sides that it could switch between.
    pub(super) fn has_sides(&self) -> bool {
        self.operations.iter().any(|operation| {
            use Operation::{One, Select, Step, Two};
            matches!(
                operation,
                One(Unary::Abs) | Two(Binary::Min | Binary::Max | Binary::Atan2) | Step | Select(_)
            )
        })
    }

    /// The sides that the operations with sides take at time `t`, in the order of the operations; without parameters.
    pub(super) fn sides(&self, t: f64, sides: &mut Vec<u8>) {
        sides.clear();
        evaluate::<f64, MAX_WAITING>(&self.operations, TimeJet::time(t), fixed, |operation, operands| {
            sides.extend(operation.side(operands));
        });
    }
}

/// The parameters of a program that has none.
pub(super) fn fixed<S: Scalar>(_: usize) -> S {
    S::fixed(f64::NAN)
}

/// Runs the operations; `watch` sees each with its operands first.
fn evaluate<S: Scalar, const N: usize>(
    operations: &[Operation],
    time: TimeJet<S>,
    parameter: impl Fn(usize) -> S,
    mut watch: impl FnMut(Operation, &[TimeJet<S>]),
) -> TimeJet<S> {
    let mut stack = [TimeJet::constant(S::ZERO); N];
    let mut len = 0;
    for &operation in operations {
        let operands = operation.operands();
        len -= operands;
        watch(operation, &stack[len..len + operands]);
        stack[len] = match operation {
            Operation::Constant(value) => TimeJet::constant(S::fixed(value)),
            Operation::Parameter(index) => TimeJet::constant(parameter(index)),
            Operation::Time => time,
            _ => operation.apply(&stack[len..len + operands]),
        };
        len += 1;
    }
    stack[0]
}

/// Runs the operations over a stretch of time.
fn over_stretch<const N: usize>(operations: &[Operation], from: f64, to: f64) -> Stretch {
    let mut stack = [Stretch::constant(0.0); N];
    let mut len = 0;
    for &operation in operations {
        len -= operation.operands();
        stack[len] = match operation {
            Operation::Constant(value) => Stretch::constant(value),
            Operation::Parameter(_) => Stretch::UNBOUNDED,
            Operation::Time => Stretch::time(from, to),
            _ => operation.over_stretch(&stack[len..len + operation.operands()]),
        };
        len += 1;
    }
    stack[0]
}

/// Runs the operations at several times side by side.
#[inline(always)]
fn evaluate_lanes<R: Real, const N: usize>(operations: &[Operation], times: Lanes<R>) -> TimeJet<Lanes<R>> {
    let mut stack = [TimeJet::constant(times.like(0.0)); N];
    let mut len = 0;
    for &operation in operations {
        let operands = operation.operands();
        len -= operands;
        stack[len] = match operation {
            Operation::Constant(value) => TimeJet::constant(times.like(value)),
            Operation::Parameter(_) => TimeJet::constant(times.like(f64::NAN)),
            Operation::Time => TimeJet::time(times),
            _ => operation.apply_to_lanes(&stack[len..len + operands]),
        };
        len += 1;
    }
    stack[0]
}
