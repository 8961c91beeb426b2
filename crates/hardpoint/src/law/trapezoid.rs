//! Law that goes from one value to another with constant acceleration, constant speed and constant deceleration.

use std::fmt;

use crate::expression::Stretch;
use crate::number::{Interval, Jet, Real};

use super::Law;
use super::breaks::Break;
use super::error::{LawError, check_finite};
use super::kind::{LawKind, in_pieces, is_after, is_before, one_way, parameters};
use super::parameter::{Parameter, ParameterKind, Seed, parameter, seeded};

/// A law that is `from` until `start` and `to` after `end`. Between them the speed is a trapezoid: it rises linearly
/// for `ramp` seconds, is constant, and falls linearly for `ramp` seconds. The acceleration jumps at the four corners.
///
/// Parameters, in this order: `from`, `to`, `start`, `end`, `ramp`. If they are changed so that both ramps do not fit,
/// the law has no finite value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trapezoid {
    /// Initial value, in the driver's unit.
    pub from: f64,
    /// Final value, in the driver's unit.
    pub to: f64,
    /// Start time, s.
    pub start: f64,
    /// End time, s; after `start`.
    pub end: f64,
    /// Duration of the acceleration and of the deceleration, s; positive, at most half of the time from start to end.
    pub ramp: f64,
}

/// Relative tolerance for two ramps in the available time, for halves of decimal numbers.
const ROUNDING: f64 = 1e-12;

impl Trapezoid {
    pub(super) fn check(&self) -> Result<(), LawError> {
        let Self { start, end, ramp, .. } = *self;
        check_finite(self)?;
        if !self.has_room() {
            let message = format!(
                "a trapezoid needs a ramp that fits twice between start and end, but ramp = {ramp} s, start = {start} s, \
                 end = {end} s"
            );
            return Err(LawError::new(message, "give a ramp above 0 s and of at most half that time"));
        }
        Ok(())
    }

    /// True if both ramps fit.
    fn has_room(&self) -> bool {
        self.ramp > 0.0 && 2.0 * self.ramp <= (self.end - self.start) * (1.0 + ROUNDING)
    }
}

impl Law {
    /// Creates a law that goes from one value to another with a trapezoidal speed; see [`Trapezoid`].
    ///
    /// ```
    /// use hardpoint::law::{Law, Trapezoid};
    ///
    /// let law = Law::trapezoid(Trapezoid { from: 0.0, to: 6.0, start: 1.0, end: 5.0, ramp: 1.0 })?;
    /// assert_eq!([1.0, 2.0, 3.0, 4.0, 5.0].map(|t| law.at(t).value()), [0.0, 1.0, 3.0, 5.0, 6.0]);
    /// assert_eq!([1.5, 3.0, 4.5].map(|t| law.at(t).d()), [1.0, 2.0, 1.0]);
    /// # Ok::<(), hardpoint::law::LawError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if a number is not finite, or the ramps do not fit.
    pub fn trapezoid(law: Trapezoid) -> Result<Self, LawError> {
        law.check()?;
        Ok(Self::of(law))
    }
}

impl LawKind for Trapezoid {
    #[inline(always)]
    fn at<T: Real, const N: usize>(&self, time: Jet<T, N>, seed: Option<Seed<T>>) -> Jet<T, N> {
        let number = |value: f64, parameter: usize| seeded(value, parameter, seed);
        let ([from, to], ramp) = ([number(self.from, 0), number(self.to, 1)], number(self.ramp, 4));
        let [start, end] = [number(self.start, 2), number(self.end, 3)];
        if !self.has_room() {
            return Jet::undefined();
        }
        // The area of the trapezoid is the displacement: v (end - start - ramp) = to - from; then a = v / ramp.
        let speed = (to - from) / (end - start - ramp);
        let half = speed / (ramp + ramp);
        // NaN is neither before nor after, and propagates through the last branch.
        if is_before(&time, self.start) {
            Jet::constant(from)
        } else if is_after(&time, self.end) {
            Jet::constant(to)
        } else if is_before(&time, self.start + self.ramp) {
            // from + a/2 (t - start)^2
            time.plus(-start).powi(2).times(half).plus(from)
        } else if is_before(&time, self.end - self.ramp) {
            // from + v (t - start - ramp/2)
            time.plus(-start - ramp * T::constant(0.5)).times(speed).plus(from)
        } else {
            // to - a/2 (end - t)^2
            time.plus(-end).powi(2).times(-half).plus(to)
        }
    }

    fn over(&self, from: f64, to: f64) -> Stretch {
        one_way(self, 0.5 * (self.start + self.end), from, to)
    }

    fn enclosure(&self, over: Interval) -> Jet<Interval, 4> {
        let [from, to, start, end, ramp] =
            [self.from, self.to, self.start, self.end, self.ramp].map(Interval::constant);
        if !self.has_room() {
            return Jet([Interval::ENTIRE; 4]);
        }
        // As in `at`.
        let speed = (to - from) / (end - start - ramp);
        let half = speed / (ramp + ramp);
        let corners = [self.start, self.start + self.ramp, self.end - self.ramp, self.end];
        in_pieces(over, &corners, |k, part| match k {
            0 => Jet::constant(from),
            1 => Jet::time(part).plus(-start).powi(2).times(half).plus(from),
            2 => Jet::time(part).plus(-start - ramp * 0.5).times(speed).plus(from),
            3 => Jet::time(part).plus(-end).powi(2).times(-half).plus(to),
            _ => Jet::constant(to),
        })
    }

    parameters! {
        from: ParameterKind::Value,
        to: ParameterKind::Value,
        start: ParameterKind::Time,
        end: ParameterKind::Time,
        ramp: ParameterKind::Time,
    }

    fn find_breaks(&self, from: f64, to: f64, breaks: &mut Vec<Break>) {
        let corners = [self.start, self.start + self.ramp, self.end - self.ramp, self.end];
        breaks.extend(corners.into_iter().filter(|t| (from..=to).contains(t)).map(Break::exactly));
    }
}

impl fmt::Display for Trapezoid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { from, to, start, end, ramp } = self;
        write!(f, "trapezoid of speed from {from} at {start} s to {to} at {end} s, ramps of {ramp} s")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ramps_must_fit_between_start_and_end() {
        let good = Trapezoid { from: 1.0, to: 0.0, start: 0.1, end: 0.7, ramp: 0.3 };
        assert_eq!(good.check(), Ok(()));
        for bad in [
            Trapezoid { ramp: 0.31, ..good },
            Trapezoid { ramp: 0.0, ..good },
            Trapezoid { end: 0.0, ..good },
        ] {
            assert!(bad.check().unwrap_err().message.starts_with("a trapezoid needs a ramp that fits twice"));
        }
        assert!(Trapezoid { to: f64::NAN, ..good }.check().is_err());
    }

    #[test]
    fn value_and_speed_are_continuous_at_the_corners_and_the_acceleration_jumps() {
        let law = Trapezoid { from: -1.0, to: 3.0, start: 0.5, end: 2.5, ramp: 0.4 };
        let acceleration = 4.0 / 1.6 / 0.4;
        for (t, jump) in
            [(0.5, acceleration), (0.9, -acceleration), (2.1, -acceleration), (2.5, acceleration)]
        {
            // In reversed time, speeds change their sign.
            let [after, before] = [law.at(Jet::<f64>::time(t), None), law.at(-Jet::<f64>::time(-t), None)]
                .map(|x| x.derivatives());
            assert!((after[0] - before[0]).abs() < 1e-14, "{after:?} {before:?}");
            assert!((after[1] + before[1]).abs() < 1e-14, "{after:?} {before:?}");
            assert!((after[2] - before[2] - jump).abs() < 1e-12, "{after:?} {before:?}");
        }
    }
}
