//! Law composed of other laws, one after the other.

use std::fmt;

use crate::expression::{Range, Stretch};
use crate::number::{Interval, Jet, Real};

use super::Law;
use super::breaks::Break;
use super::error::LawError;
use super::kind::LawKind;
use super::parameter::{Parameter, ParameterKind, Seed, parameter, seeded};
use super::table::ROUNDING_OF_TIME;

/// A piece of a [sequence](Law::sequence).
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Duration, s; `None` for a last piece without end.
    pub duration: Option<f64>,
    /// Law of the piece, with its time starting at 0 with the piece.
    pub law: Law,
    /// True if the piece continues from the final value of the preceding one, so that the value does not jump. Ignored
    /// for the first piece, whose values are always those of its law.
    pub continued: bool,
}

impl Piece {
    /// A continued piece with this duration, s.
    pub fn lasting(duration: f64, law: Law) -> Self {
        Self { duration: Some(duration), law, continued: true }
    }

    /// A continued last piece without end.
    pub fn open_ended(law: Law) -> Self {
        Self { duration: None, law, continued: true }
    }

    /// This piece with the values of its law, not continued from the preceding piece.
    #[must_use]
    pub fn not_continued(mut self) -> Self {
        self.continued = false;
        self
    }
}

/// Law of a sequence.
#[derive(Clone, PartialEq)]
pub(super) struct Sequence {
    pieces: Vec<Piece>,
    /// Start time of each piece, s, and the end of the last.
    starts: Vec<f64>,
    /// Offsets added to the laws of the pieces.
    offsets: Vec<f64>,
    /// Index of the first parameter of each piece (its duration, if it has one, then those of its law), and the total
    /// number.
    first_parameters: Vec<usize>,
}

impl Sequence {
    pub(super) fn new(pieces: Vec<Piece>) -> Result<Self, LawError> {
        if pieces.is_empty() {
            return Err(LawError::new("a sequence has no pieces", "give at least one"));
        }
        for (k, piece) in pieces.iter().enumerate() {
            match piece.duration {
                None if k + 1 < pieces.len() => {
                    let message = format!("piece {k} of a sequence has no duration, but is not the last");
                    return Err(LawError::new(message, "only the last piece may be without end"));
                }
                Some(duration) if !(duration > 0.0 && duration.is_finite()) => {
                    let message = format!("piece {k} of a sequence lasts {duration} s");
                    return Err(LawError::new(message, "a duration is a finite number greater than zero"));
                }
                _ => {}
            }
            let ends = [("start", Jet::time(0.0)), ("end", backwards(piece.duration.unwrap_or(0.0)))];
            for (end, time) in ends {
                if !piece.law.evaluate::<f64, 4>(time, None).value().is_finite() {
                    let message = format!(
                        "the law of piece {k} of a sequence has no finite value at the piece's {end}"
                    );
                    let help =
                        "the time of a piece's law starts at 0 with the piece, and ends with its duration";
                    return Err(LawError::new(message, help));
                }
            }
        }
        let mut sequence =
            Self { pieces, starts: Vec::new(), offsets: Vec::new(), first_parameters: Vec::new() };
        let mut parameters = 0;
        for piece in &sequence.pieces {
            sequence.first_parameters.push(parameters);
            parameters += usize::from(piece.duration.is_some()) + piece.law.kind.parameter_count();
        }
        sequence.first_parameters.push(parameters);
        sequence.lay_out();
        Ok(sequence)
    }

    /// Computes the start time and the offset of every piece.
    fn lay_out(&mut self) {
        let places: Vec<(f64, f64)> =
            (0..=self.pieces.len()).map(|k| self.place::<f64, 4>(k, None)).collect();
        (self.starts, self.offsets) = places.into_iter().unzip();
    }

    /// Start time of piece k, and the offset added to its law; for k beyond the last piece, its end.
    fn place<T: Real, const N: usize>(&self, k: usize, seed: Option<Seed<T>>) -> (T, T) {
        let zero = T::zero();
        let (mut start, mut offset) = (zero, zero);
        for j in 0..k {
            // start_j+1 = start_j + duration_j,    offset_j+1 = offset_j + f_j(duration_j) - f_j+1(0) if piece j + 1 is
            // continued
            let duration = self.duration(j, seed);
            let at_end: Jet<T, N> = backwards(duration);
            let end = self.pieces[j].law.evaluate(at_end, self.seed_in(j, seed)).value();
            start += duration;
            offset = match self.pieces.get(j + 1) {
                Some(next) if next.continued => {
                    let at_start: Jet<T, N> = Jet::time(zero);
                    let next_start = next.law.evaluate(at_start, self.seed_in(j + 1, seed));
                    offset + end - next_start.value()
                }
                _ => zero,
            };
        }
        (start, offset)
    }

    /// Piece that is active at time `t`, if any.
    fn piece_at(&self, t: f64, is_backwards: bool) -> Option<usize> {
        let end = self.starts[self.pieces.len()];
        let slack = ROUNDING_OF_TIME * t.abs().max(1.0);
        // Durations that were changed to invalid values leave the pieces without an order.
        let is_ordered = self.starts.windows(2).all(|pair| pair[0] < pair[1]);
        if !(t >= -slack && t <= end + slack && is_ordered) {
            return None;
        }
        let begun = &self.starts[..self.pieces.len()];
        let begun = begun.partition_point(|&start| if is_backwards { start < t } else { start <= t });
        Some(begun.saturating_sub(1))
    }

    fn duration<T: Real>(&self, k: usize, seed: Option<Seed<T>>) -> T {
        match self.pieces[k].duration {
            Some(duration) => seeded(duration, self.first_parameters[k], seed),
            None => T::constant(f64::INFINITY),
        }
    }

    /// Seed with the parameter's index in the law of piece k, if the parameter belongs to that law.
    fn seed_in<T: Real>(&self, k: usize, seed: Option<Seed<T>>) -> Option<Seed<T>> {
        let Seed { parameter, size } = seed?;
        match self.owner(parameter) {
            (owner, Some(parameter)) if owner == k => Some(Seed { parameter, size }),
            _ => None,
        }
    }

    /// Piece that a parameter belongs to, and its index in that piece's law; `None` for the duration of the piece.
    fn owner(&self, parameter: usize) -> (usize, Option<usize>) {
        let k = self.first_parameters.partition_point(|&first| first <= parameter) - 1;
        let within = parameter - self.first_parameters[k];
        (k, if self.pieces[k].duration.is_some() { within.checked_sub(1) } else { Some(within) })
    }
}

impl Law {
    /// Creates a sequence of laws, starting at t = 0. Before that, and after the end of a limited last piece, the law
    /// has no finite value.
    ///
    /// ```
    /// use hardpoint::law::{Law, Piece};
    ///
    /// let speed_up = Piece::lasting(2.0, Law::polynomial(&[0.0, 0.0, 1.5])?);
    /// let keep_going = Piece::open_ended(Law::polynomial(&[0.0, 6.0])?);
    /// let law = Law::sequence(vec![speed_up, keep_going])?;
    /// assert_eq!(law.at(1.0).value(), 1.5);
    /// assert_eq!(law.at(3.0).value(), 12.0); // 6 at the end of the first piece, and 6 more
    /// assert_eq!(law.to_string(), "1.5*t^2 for 2 s, then 6*t");
    /// # Ok::<(), hardpoint::law::LawError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if there is no piece, a duration is not a finite number greater than zero, a piece other than
    /// the last has none, or the law of a piece has no finite value at the start or end of the piece.
    pub fn sequence(pieces: Vec<Piece>) -> Result<Self, LawError> {
        Sequence::new(pieces).map(Self::of)
    }
}

impl LawKind for Sequence {
    #[inline(always)]
    fn at<T: Real, const N: usize>(&self, time: Jet<T, N>, seed: Option<Seed<T>>) -> Jet<T, N> {
        let like = time.value();
        let Some(k) = self.piece_at(like.value(), time.d().value() < 0.0) else {
            return Jet::undefined();
        };
        let (start, offset) = match seed {
            None => (T::constant(self.starts[k]), T::constant(self.offsets[k])),
            Some(_) => self.place::<T, N>(k, seed),
        };
        self.pieces[k].law.evaluate(time.plus(-start), self.seed_in(k, seed)).plus(offset)
    }

    fn over(&self, from: f64, to: f64) -> Stretch {
        let (Some(first), Some(last)) = (self.piece_at(from, false), self.piece_at(to, false)) else {
            return Stretch::UNBOUNDED;
        };
        let piece = |k: usize| {
            let (start, end) = (self.starts[k], self.starts[k + 1]);
            let of_law = self.pieces[k].law.over(from.max(start) - start, to.min(end) - start);
            of_law + Stretch::constant(self.offsets[k])
        };
        (first + 1..=last).fold(piece(first), |all, k| {
            // A piece that is not continued may begin with a jump.
            let rate = if self.pieces[k].continued { piece(k).rate } else { Range::UNBOUNDED };
            all.or(Stretch { rate, ..piece(k) })
        })
    }

    fn enclosure(&self, over: Interval) -> Jet<Interval, 4> {
        // At a start, the piece before and the one after have different rates; an interval has the one inside of it.
        let (first, last) = (self.piece_at(over.low, false), self.piece_at(over.high, !over.is_point()));
        let (Some(first), Some(last)) = (first, last) else { return Jet([Interval::ENTIRE; 4]) };
        let value = |k: usize| {
            let start = self.starts[k];
            let end = self.pieces[k].duration.map_or(f64::INFINITY, |_| self.starts[k + 1]);
            let part = Interval { low: over.low.max(start), high: over.high.min(end) };
            let of_law = self.pieces[k].law.enclosure(part - Interval::constant(start));
            of_law.plus(Interval::constant(self.offsets[k]))
        };
        let bounds = value(first);
        if first == last {
            return bounds;
        }
        // Rates may jump from one piece to the next.
        let values = (first + 1..=last).fold(bounds.value(), |all, k| all.or(value(k).value()));
        Jet([values, Interval::ENTIRE, Interval::ENTIRE, Interval::ENTIRE])
    }

    fn parameters(&self) -> Vec<Parameter> {
        let mut parameters = Vec::new();
        for (k, piece) in self.pieces.iter().enumerate() {
            let duration =
                piece.duration.map(|duration| parameter("duration", duration, ParameterKind::Time));
            for parameter in duration.into_iter().chain(piece.law.parameters()) {
                let name = format!("piece[{k}].{}", parameter.name);
                parameters.push(Parameter { name, ..parameter });
            }
        }
        parameters
    }

    fn parameter_count(&self) -> usize {
        self.first_parameters[self.pieces.len()]
    }

    fn parameter_kind(&self, parameter: usize) -> ParameterKind {
        match self.owner(parameter) {
            (k, Some(of_law)) => self.pieces[k].law.kind.parameter_kind(of_law),
            (_, None) => ParameterKind::Time,
        }
    }

    fn set(&mut self, parameter: usize, value: f64) {
        let (k, of_law) = self.owner(parameter);
        let piece = &mut self.pieces[k];
        match of_law {
            Some(of_law) => piece.law = piece.law.with_parameter(of_law, value),
            None => piece.duration = Some(value),
        }
        self.lay_out();
    }

    fn find_breaks(&self, from: f64, to: f64, breaks: &mut Vec<Break>) {
        let mut found = Vec::new();
        for (k, piece) in self.pieces.iter().enumerate() {
            let (start, end) = (self.starts[k], self.starts[k + 1]);
            if k > 0 && (from..=to).contains(&start) {
                breaks.push(Break::exactly(start));
            }
            let (from, to) = (from.max(start), to.min(end));
            if from <= to {
                piece.law.kind.find_breaks(from - start, to - start, &mut found);
                let found = found.drain(..).map(|found| found.delayed(start));
                // At the ends of the sequence only one side exists.
                breaks.extend(found.filter(|found| found.is_between(0.0, self.starts[self.pieces.len()])));
            }
        }
    }
}

/// The time `t` running backwards: laws evaluated at it return their values just before `t`.
pub(super) fn backwards<T: Real, const N: usize>(t: T) -> Jet<T, N> {
    -Jet::time(-t)
}

impl fmt::Display for Sequence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, piece) in self.pieces.iter().enumerate() {
            f.write_str(if k == 0 { "" } else { ", then " })?;
            write!(f, "{}", piece.law)?;
            if let Some(duration) = piece.duration {
                write!(f, " for {duration} s")?;
            }
            if k > 0 && !piece.continued {
                f.write_str(" (not continued)")?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::law::*;

    #[test]
    fn a_later_piece_follows_what_the_earlier_ones_become() {
        let speed = |speed| Law::constant_speed(ConstantSpeed { speed, offset: 4.0 }).unwrap();
        let law =
            Law::sequence(vec![Piece::lasting(2.0, speed(3.0)), Piece::open_ended(speed(5.0))]).unwrap();
        let names: Vec<String> = law.parameters().into_iter().map(|parameter| parameter.name).collect();
        assert_eq!(
            names,
            ["piece[0].duration", "piece[0].speed", "piece[0].offset", "piece[1].speed", "piece[1].offset"]
        );
        assert_eq!(law.at(3.0).value(), 15.0); // 4 + 2 s at 3 + 1 s at 5
        // With respect to the durations 3 - 5, with respect to the speeds the durations; the first offset matters and
        // the second does not.
        assert_eq!([0, 1, 2, 3, 4].map(|k| law.derivative(k, 3.0).value()), [-2.0, 2.0, 1.0, 1.0, 0.0]);
        assert!(law.with_parameter(0, -1.0).at(3.0).value().is_nan());
    }

    #[test]
    fn sequences_are_refused_with_the_reason() {
        let speed = || Law::parse("t").unwrap();
        let late = Law::parse("sqrt(t - 1)").unwrap();
        let sequences = [
            (vec![], "a sequence has no pieces", "give at least one"),
            (
                vec![Piece::open_ended(speed()), Piece::open_ended(speed())],
                "piece 0 of a sequence has no duration, but is not the last",
                "only the last piece may be without end",
            ),
            (
                vec![Piece::lasting(0.0, speed())],
                "piece 0 of a sequence lasts 0 s",
                "a duration is a finite number greater than zero",
            ),
            (
                vec![Piece::lasting(1.0, speed()), Piece::lasting(2.0, late)],
                "the law of piece 1 of a sequence has no finite value at the piece's start",
                "the time of a piece's law starts at 0 with the piece, and ends with its duration",
            ),
        ];
        for (pieces, message, help) in sequences {
            let error = Law::sequence(pieces).unwrap_err();
            assert_eq!((error.message.as_str(), error.help.as_deref()), (message, Some(help)));
        }
    }
}
