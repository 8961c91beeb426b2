//! Recording scalar.

use std::cell::RefCell;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};
use std::sync::atomic::{AtomicU32, Ordering};

use crate::program::{Call, larger};

/// Recorded computation: steps and outputs.
///
/// Created by [`record`]; [`Recording::program`](Recording::program) converts it to a program.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    pub(crate) steps: Vec<Step>,
    pub(crate) inputs: u32,
    pub(crate) uniforms: u32,
    pub(crate) outputs: Vec<u32>,
    /// Number of operations that were folded while recording.
    pub(crate) folded: usize,
}

/// Step of a recording; operands are indices of earlier steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    Constant(f64),
    Input(u32),
    Uniform(u32),
    Add(u32, u32),
    Sub(u32, u32),
    Mul(u32, u32),
    Div(u32, u32),
    MulAdd(u32, u32, u32),
    Neg(u32),
    Abs(u32),
    Sqrt(u32),
    Round(u32),
    Larger(u32, u32),
    Call(Call, u32, u32),
}

/// Active recording of the thread; session 0 means none.
struct Session {
    id: u32,
    recording: Recording,
}

thread_local! {
    static SESSION: RefCell<Session> = const {
        RefCell::new(Session {
            id: 0,
            recording: Recording { steps: Vec::new(), inputs: 0, uniforms: 0, outputs: Vec::new(), folded: 0 },
        })
    };
}

/// Number of the next session: one counter for all threads, so that numbers sent to another thread are detected.
static NEXT: AtomicU32 = AtomicU32::new(1);

/// Records the operations of `f` on [`Number`]s, on this thread. The returned numbers are the outputs, in order.
///
/// # Panics
///
/// If a recording is active on this thread, or if an output is not a number of this recording. A panic of `f`
/// propagates and ends the recording.
pub fn record<O: IntoIterator<Item = Number>>(f: impl FnOnce() -> O) -> Recording {
    /// Ends the session, even if `f` panics.
    struct Running;
    impl Drop for Running {
        fn drop(&mut self) {
            SESSION.with_borrow_mut(|s| *s = Session { id: 0, recording: Recording::default() });
        }
    }
    SESSION.with_borrow_mut(|s| {
        assert!(s.id == 0, "a recording is active on this thread: recordings do not nest");
        // Session 0 is never used, not even after overflow of the counter.
        s.id =
            std::iter::repeat_with(|| NEXT.fetch_add(1, Ordering::Relaxed)).find(|id| *id != 0).unwrap_or(1);
    });
    let running = Running;
    let outputs = f();
    let mut recording = Recording::default();
    for number in outputs {
        recording.outputs.push(SESSION.with_borrow(|s| s.place(number)));
    }
    SESSION.with_borrow_mut(|s| {
        recording.steps = std::mem::take(&mut s.recording.steps);
        recording.inputs = s.recording.inputs;
        recording.folded = s.recording.folded;
        recording.uniforms = s.recording.uniforms;
    });
    drop(running);
    recording
}

impl Session {
    /// Returns the index of `number` in this session.
    #[inline(always)]
    fn place(&self, number: Number) -> u32 {
        if number.session != self.id {
            panic_on_foreign_number(self.id);
        }
        number.id
    }

    #[inline(always)]
    fn push(&mut self, step: Step, value: f64) -> Number {
        let id = self.recording.steps.len() as u32;
        self.recording.steps.push(step);
        Number { value, id, session: self.id }
    }

    #[inline(always)]
    fn constant(&self, id: u32) -> Option<f64> {
        match self.recording.steps[id as usize] {
            Step::Constant(x) => Some(x),
            _ => None,
        }
    }

    /// Returns the index of a step. Constants are folded while recording.
    #[inline(always)]
    fn push_folded(&mut self, step: Step, value: f64) -> Number {
        /// Returns the result of a step.
        enum Fold {
            Same(u32),
            Constant(f64),
            None,
        }
        use Fold::{Constant, Same};
        let (zero, one) = (|id| self.constant(id) == Some(0.0), |id| self.constant(id) == Some(1.0));
        let known = |ids: &[u32]| match ids.iter().all(|id| self.constant(*id).is_some()) {
            true => Constant(value),
            false => Fold::None,
        };
        let fold = match step {
            Step::Add(a, b) if zero(a) => Same(b),
            Step::Add(a, b) | Step::Sub(a, b) if zero(b) => Same(a),
            Step::Sub(a, b) if a == b => Constant(0.0),
            Step::Mul(a, b) if zero(a) || zero(b) => Constant(0.0),
            Step::Mul(a, b) if one(a) => Same(b),
            Step::Mul(a, b) | Step::Div(a, b) if one(b) => Same(a),
            Step::Div(a, b) if zero(a) && !zero(b) => Constant(0.0),
            Step::MulAdd(a, b, c) if zero(a) || zero(b) => Same(c),
            Step::MulAdd(a, b, c) => known(&[a, b, c]),
            Step::Add(a, b)
            | Step::Sub(a, b)
            | Step::Mul(a, b)
            | Step::Div(a, b)
            | Step::Larger(a, b)
            | Step::Call(_, a, b) => known(&[a, b]),
            Step::Neg(a) | Step::Abs(a) | Step::Sqrt(a) | Step::Round(a) => known(&[a]),
            Step::Constant(_) | Step::Input(_) | Step::Uniform(_) => Fold::None,
        };
        let operations = if matches!(step, Step::MulAdd(..)) { 2 } else { 1 };
        self.recording.folded += if matches!(fold, Fold::None) { 0 } else { operations };
        match fold {
            Same(id) => Number { value, id, session: self.id },
            Constant(x) => self.push(Step::Constant(x), x),
            Fold::None => self.push(step, value),
        }
    }
}

#[cold]
#[inline(never)]
fn panic_on_foreign_number(session: u32) -> ! {
    if session == 0 {
        panic!("a recorded number was used outside of a recording: call `record`");
    }
    panic!("a number of another recording was used: pass it as an input or a constant");
}

#[inline(always)]
fn leaf(step: impl FnOnce(&mut Recording) -> Step, value: f64) -> Number {
    SESSION.with_borrow_mut(|s| {
        assert!(s.id != 0, "a number was created outside of a recording: call `record`");
        let step = step(&mut s.recording);
        s.push(step, value)
    })
}

/// Scalar that records all operations on it.
///
/// It has a value, that of the recorded run, which the recorded code can use for decisions: which pivot, which of two
/// formulas. Decisions are not recorded, and there are no comparison operators that would hide one: use
/// [`value`](Number::value), and make the tested number an output, to be checked after every run.
///
/// Numbers belong to the call of [`record`] in which they were created. Elsewhere every operation on them panics.
#[derive(Clone, Copy, Debug)]
pub struct Number {
    value: f64,
    id: u32,
    session: u32,
}

impl Number {
    /// Returns a number that is the same in every run.
    ///
    /// # Panics
    ///
    /// Outside of a recording, like all functions that create numbers.
    #[inline(never)]
    pub fn constant(x: f64) -> Self {
        leaf(|_| Step::Constant(x), x)
    }

    /// Returns the next input: a number that is given lane by lane, and is `x` in the recorded run.
    #[inline(never)]
    pub fn input(x: f64) -> Self {
        leaf(
            |r| {
                r.inputs += 1;
                Step::Input(r.inputs - 1)
            },
            x,
        )
    }

    /// Returns the next uniform: a number that is the same in all lanes of a run, and is `x` in the recorded run.
    #[inline(never)]
    pub fn uniform(x: f64) -> Self {
        leaf(
            |r| {
                r.uniforms += 1;
                Step::Uniform(r.uniforms - 1)
            },
            x,
        )
    }

    /// Returns the value in the recorded run, computed in `f64`: every operation rounds.
    #[inline(always)]
    pub fn value(self) -> f64 {
        self.value
    }

    /// Returns the value in every run, for a [`constant`](Number::constant) and for results of constants alone.
    pub fn known(self) -> Option<f64> {
        SESSION.with_borrow(|s| match s.recording.steps[s.place(self) as usize] {
            Step::Constant(x) => Some(x),
            _ => None,
        })
    }

    /// Returns `self * factor + addend`, which may be rounded once.
    #[inline(never)]
    pub fn times_plus(self, factor: Self, addend: Self) -> Self {
        SESSION.with_borrow_mut(|s| {
            let step = Step::MulAdd(s.place(self), s.place(factor), s.place(addend));
            s.push_folded(step, self.value * factor.value + addend.value)
        })
    }

    /// Returns the square root.
    #[inline(never)]
    pub fn sqrt(self) -> Self {
        self.unary(Step::Sqrt, self.value.sqrt())
    }

    /// Returns the magnitude.
    #[inline(never)]
    pub fn abs(self) -> Self {
        self.unary(Step::Abs, self.value.abs())
    }

    /// Returns the nearest integer, ties to even.
    #[inline(never)]
    pub fn round(self) -> Self {
        self.unary(Step::Round, self.value.round_ties_even())
    }

    /// Returns the larger of two numbers; NaN if either is NaN.
    #[inline(never)]
    pub fn larger(self, o: Self) -> Self {
        self.binary(o, Step::Larger, larger(self.value, o.value))
    }

    /// Returns a function of this number.
    ///
    /// # Panics
    ///
    /// If it is a function of two numbers.
    pub fn call(self, function: Call) -> Self {
        assert!(!function.is_of_two(), "{function:?} is a function of two numbers");
        self.unary(|a| Step::Call(function, a, a), function.of(self.value, self.value))
    }

    /// Returns the angle of the point (x, self) from the x axis, rad in [-pi, pi].
    pub fn atan2(self, x: Self) -> Self {
        self.binary(x, |a, b| Step::Call(Call::Atan2, a, b), self.value.atan2(x.value))
    }

    /// Returns this number to a power.
    pub fn powf(self, exponent: Self) -> Self {
        self.binary(exponent, |a, b| Step::Call(Call::Pow, a, b), self.value.powf(exponent.value))
    }

    #[inline(always)]
    fn unary(self, step: impl FnOnce(u32) -> Step, value: f64) -> Self {
        SESSION.with_borrow_mut(|s| {
            let step = step(s.place(self));
            s.push_folded(step, value)
        })
    }

    #[inline(always)]
    fn binary(self, o: Self, step: impl FnOnce(u32, u32) -> Step, value: f64) -> Self {
        SESSION.with_borrow_mut(|s| {
            let step = step(s.place(self), s.place(o));
            s.push_folded(step, value)
        })
    }
}

impl Add for Number {
    type Output = Self;
    #[inline(never)]
    fn add(self, o: Self) -> Self {
        self.binary(o, Step::Add, self.value + o.value)
    }
}

impl Sub for Number {
    type Output = Self;
    #[inline(never)]
    fn sub(self, o: Self) -> Self {
        self.binary(o, Step::Sub, self.value - o.value)
    }
}

impl Mul for Number {
    type Output = Self;
    #[inline(never)]
    fn mul(self, o: Self) -> Self {
        self.binary(o, Step::Mul, self.value * o.value)
    }
}

impl Div for Number {
    type Output = Self;
    #[inline(never)]
    fn div(self, o: Self) -> Self {
        self.binary(o, Step::Div, self.value / o.value)
    }
}

impl Neg for Number {
    type Output = Self;
    #[inline(never)]
    fn neg(self) -> Self {
        self.unary(Step::Neg, -self.value)
    }
}

impl Add<f64> for Number {
    type Output = Self;
    fn add(self, o: f64) -> Self {
        self + Self::constant(o)
    }
}

impl Mul<f64> for Number {
    type Output = Self;
    fn mul(self, o: f64) -> Self {
        self * Self::constant(o)
    }
}

impl AddAssign for Number {
    #[inline(never)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl SubAssign for Number {
    #[inline(never)]
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}
