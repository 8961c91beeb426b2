//! Times between two output times to which equilibria are followed one after another, since laws turn round there.
//!
//! A step takes all loads and drivers straight from their values at its beginning to those at its end. That is their
//! way if each law stays between these values, and if laws that change together do so in proportion.

use std::collections::VecDeque;

use crate::law::Law;
use crate::order::sort_by_number;

/// Part of its size by which a law may leave the range of its values at the ends of a step within the step: far below
/// the part of a load to which a limit load is known.
const OVERSHOOT: f64 = 1e-9;
/// Maximum number of intervals that are divided in search of the times at which a law turns: a single turn takes about
/// 50, and a law without bounds is sampled.
const MOST_DIVIDED: usize = 1024;
/// Length of the shortest interval, as a fraction of that between the output times, at which a law jumps or has a kink.
const SHORTEST: f64 = 1e-12;
/// Part of its size by which a law may leave the straight line between its values at the ends of a step, if several
/// laws change in it: their sum may turn although none of them does. Output times that resolve a curve, such as 41 over
/// a sine, leave it by 0.6 %.
const BEND: f64 = 0.01;
/// Length of the shortest step, as a fraction of that between the output times, for that reason alone.
const SHORTEST_BEND: f64 = 1.0 / 64.0;

/// Time between two times, nearly, at which a law first has no value: that of a pole, or the end of its domain.
pub(super) fn first_undefined(law: &Law, [from, to]: [f64; 2]) -> Option<f64> {
    let mut open = vec![[from, to]];
    for _ in 0..MOST_DIVIDED {
        let [a, b] = open.pop()?;
        if law.over(a, b).value.is_bounded() {
            continue;
        }
        let middle = 0.5 * (a + b);
        if b - a <= SHORTEST * (to - from) || middle <= a || b <= middle {
            return Some(b);
        }
        open.extend([[middle, b], [a, middle]]);
    }
    None
}

/// A law over an interval of time, with the size of its values there.
struct ChangingLaw<'l> {
    law: &'l Law,
    size: f64,
}

/// Times between two output times (both excluded), in order, between which no law leaves the range of its values at
/// both ends; if several laws change, each is nearly straight there.
pub(super) fn waypoints<'l>(laws: impl Iterator<Item = &'l Law>, [from, to]: [f64; 2]) -> Vec<f64> {
    let mut changing: Vec<ChangingLaw<'l>> = Vec::new();
    for law in laws {
        let over = law.over(from, to);
        let rests = over.rate.low == 0.0 && over.rate.high == 0.0;
        // Laws that are equal change in proportion.
        if !rests && changing.iter().all(|other| other.law != law) {
            let ends = f64::max(law.at(from).value().abs(), law.at(to).value().abs());
            let size = if over.value.is_bounded() { over.value.reach_from(0.0) } else { ends };
            changing.push(ChangingLaw { law, size });
        }
    }
    let mut times: Vec<f64> = changing.iter().flat_map(|law| law.turns([from, to])).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    if changing.len() > 1 {
        let ends: Vec<f64> = std::iter::once(from).chain(times).chain([to]).collect();
        let shortest = SHORTEST_BEND * (to - from);
        let mut found = Vec::new();
        for pair in ends.windows(2) {
            let mut parts = vec![[pair[0], pair[1]]];
            while let Some([a, b]) = parts.pop() {
                if b - a <= shortest || changing.iter().all(|law| law.is_straight([a, b])) {
                    found.push(b);
                } else {
                    let middle = 0.5 * (a + b);
                    parts.extend([[middle, b], [a, middle]]);
                }
            }
        }
        times = found;
    }
    times.retain(|t| from < *t && *t < to);
    times
}

impl ChangingLaw<'_> {
    fn value(&self, t: f64) -> f64 {
        self.law.at(t).value()
    }

    /// Times at which the law turns, in order.
    fn turns(&self, [from, to]: [f64; 2]) -> Vec<f64> {
        // Intervals in which the law is monotone, or too short to matter.
        let mut parts = Vec::new();
        let (mut open, mut divided) = (VecDeque::from([[from, to]]), 0);
        while let Some([a, b]) = open.pop_front() {
            let over = self.law.over(a, b);
            let is_monotone = over.rate.low >= 0.0 || over.rate.high <= 0.0;
            let [low, high] = {
                let [first, last] = [self.value(a), self.value(b)];
                [first.min(last), first.max(last)]
            };
            let overshoot = f64::max(over.value.high - high, low - over.value.low);
            let is_short = b - a <= SHORTEST * (to - from);
            if is_monotone || overshoot <= OVERSHOOT * self.size || is_short || divided == MOST_DIVIDED {
                parts.push([a, b]);
            } else {
                divided += 1;
                let middle = 0.5 * (a + b);
                open.extend([[a, middle], [middle, b]]);
            }
        }
        sort_by_number(&mut parts, |part| part[0]);
        // The extrema of the values at their ends; smaller changes than these are no turns.
        let least = OVERSHOOT * self.size;
        let mut turns = Vec::new();
        let mut extreme = (from, self.value(from));
        let mut rises = None;
        for [_, t] in parts {
            let (change, now) = (self.value(t) - extreme.1, (t, self.value(t)));
            match rises {
                None if change.abs() > least => (rises, extreme) = (Some(change > 0.0), now),
                None => {}
                Some(up) if (change >= 0.0) == up || change == 0.0 => extreme = now,
                Some(up) if change.abs() > least => {
                    turns.push(extreme.0);
                    (rises, extreme) = (Some(!up), now);
                }
                Some(_) => {}
            }
        }
        turns
    }

    /// True if the law is nearly straight over an interval.
    fn is_straight(&self, [from, to]: [f64; 2]) -> bool {
        let half = 0.5 * (to - from);
        let slope = (self.value(to) - self.value(from)) / (to - from);
        // The difference vanishes at both ends.
        self.law.over(from, to).rate.reach_from(slope) * half <= BEND * self.size
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(texts: &[&str], ends: [f64; 2]) -> Vec<f64> {
        let laws: Vec<Law> = texts.iter().map(|text| Law::parse(text).unwrap()).collect();
        waypoints(laws.iter(), ends)
    }

    #[test]
    fn laws_turn_at_their_extrema() {
        for (text, expected) in [
            ("3", vec![]),
            ("7*t", vec![]),
            ("200*sin(pi*t)", vec![0.5]),
            ("1e-6*sin(3*pi*t)", vec![1.0 / 6.0, 0.5, 5.0 / 6.0]),
            ("abs(t - 0.3)", vec![0.3]),
            ("if(t < 0.4, t, -t)", vec![0.4]),
            ("min(t, 0.25)", vec![]),
            // It rests from 0.4 to 0.6: any time there will do.
            ("step(t, 0.2, 0, 0.4, 1) - step(t, 0.6, 0, 0.8, 1)", vec![0.5]),
            ("t*(2 - t)", vec![]),
        ] {
            let found = of(&[text], [0.0, 1.0]);
            assert_eq!(found.len(), expected.len(), "{text}: {found:?}");
            for (found, expected) in found.iter().zip(expected) {
                // An error of the time of 1e-4 is one of 1e-8 / 2 of the curvature.
                assert!((found - expected).abs() < 1e-4, "{text}: {found}");
            }
        }
    }

    #[test]
    fn poles_and_ends_of_domains_are_found() {
        for (text, expected) in [
            ("1/(t - 0.3)", Some(0.3)),
            ("1/(t - 0.3)^2 + 1/(t - 0.7)", Some(0.3)),
            ("tan(pi*t/0.7)", Some(0.35)),
            ("sqrt(0.6 - t)", Some(0.6)),
            // Their bounds over the whole interval are infinite, but none of their values is.
            ("1/(t^2 - t + 0.3)", None),
            ("1/(t + 1)", None),
            ("sin(20*t)", None),
        ] {
            let found = first_undefined(&Law::parse(text).unwrap(), [0.0, 1.0]);
            assert_eq!(found.is_some(), expected.is_some(), "{text}: {found:?}");
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-11, "{text}: {found}");
            }
        }
    }

    #[test]
    fn steps_over_a_resolved_sine_are_divided_where_it_turns_alone() {
        let divided = |texts: &[&str]| {
            let ends: Vec<f64> = (0..=40).map(|k| f64::from(k) / 40.0).collect();
            ends.windows(2).map(|pair| of(texts, [pair[0], pair[1]]).len()).sum::<usize>()
        };
        assert_eq!(divided(&["sin(2*pi*t)"]), 0, "it turns at output times");
        assert_eq!(divided(&["sin(2*pi*t + 0.1)"]), 2);
        assert_eq!(divided(&["sin(2*pi*t)", "50*t", "3*cos(2*pi*t)"]), 0);
    }

    #[test]
    fn laws_that_change_together_are_straight_between() {
        assert_eq!(of(&["300*t", "-5*t"], [0.0, 1.0]), []);
        assert_eq!(of(&["t^2", "t^2"], [0.0, 1.0]), [], "they are equal");
        // Their difference turns at 0.5.
        let found = of(&["300*t", "300*t^2"], [0.0, 1.0]);
        assert!(found.contains(&0.5) && found.len() >= 4, "{found:?}");
    }
}
