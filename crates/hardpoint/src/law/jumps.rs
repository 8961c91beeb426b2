//! Times at which a law is not smooth.

use crate::expression::Program;
use crate::number::Jet;

use super::Law;
use super::breaks::{Break, SAME_TIME, merged};
use super::kind::LawKind;
use super::sequence::backwards;

/// Jump of the value, speed or acceleration of a law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// Time of the jump, s.
    pub time: f64,
    /// Lowest order that jumps: 0 for the value, 1 for the speed, 2 for the acceleration.
    pub order: usize,
    /// Value after the jump minus value before, in the driver's unit per s to the order.
    pub size: f64,
}

/// Number of subintervals of the time in which an expression is searched for switches. A branch that switches there and
/// back within one subinterval is missed.
const CUTS: u32 = 4096;

/// Branches that change more often than this within a subinterval change by rounding.
const MOST_CHANGES: usize = 4;

/// A jump is reported if it exceeds this fraction of the largest magnitude of the same derivative ...
const RELATIVE: f64 = 1e-9;

/// ... and this estimate of rounding, relative to the largest value of the law, per second to the order.
const ROUNDING: f64 = 1e-12;

/// Appends the breaks between `from` and `to` at which an operation of the program changes its branch.
pub(super) fn find_switches(program: &Program, from: f64, to: f64, breaks: &mut Vec<Break>) {
    if !program.has_sides() {
        return;
    }
    // Extended, so that a switch at either end is inside a subinterval.
    let margin = 1e-9 * (to - from) + SAME_TIME * from.abs().max(to.abs());
    let cut = |k: u32| (from - margin) + (to - from + 2.0 * margin) * f64::from(k) / f64::from(CUTS);
    let (mut before, mut after, mut middle) = (Vec::new(), Vec::new(), Vec::new());
    program.sides(cut(0), &mut before);
    for k in 1..=CUTS {
        program.sides(cut(k), &mut after);
        for operation in 0..before.len() {
            let (mut low, mut side) = (cut(k - 1), before[operation]);
            for _ in 0..MOST_CHANGES {
                if side == after[operation] {
                    break;
                }
                let mut high = cut(k);
                loop {
                    let t = low + 0.5 * (high - low);
                    if t <= low || t >= high {
                        break;
                    }
                    program.sides(t, &mut middle);
                    *if middle[operation] == side { &mut low } else { &mut high } = t;
                }
                breaks.push(Break { time: high.clamp(from, to), before: low, after: high });
                program.sides(high, &mut middle);
                (low, side) = (high, middle[operation]);
            }
        }
        std::mem::swap(&mut before, &mut after);
    }
}

/// Jumps of a law between two times.
pub(super) fn jumps(law: &Law, from: f64, to: f64) -> Vec<Jump> {
    let mut breaks = Vec::new();
    if !(from <= to && (to - from).is_finite()) {
        return Vec::new();
    }
    law.kind.find_breaks(from, to, &mut breaks);
    let breaks = merged(breaks, SAME_TIME * from.abs().max(to.abs()));
    if breaks.is_empty() {
        return Vec::new();
    }

    let sides: Vec<_> = breaks.iter().map(|at| (just_before(law, at.before), law.at(at.after))).collect();
    let samples = (0..=256).map(|k| law.at(from + (to - from) * f64::from(k) / 256.0));
    let mut largest = [0.0_f64; 3];
    for jet in samples.chain(sides.iter().flat_map(|&(before, after)| [before, after])) {
        for (largest, derivative) in largest.iter_mut().zip(jet.derivatives()) {
            *largest = largest.max(if derivative.is_finite() { derivative.abs() } else { 0.0 });
        }
    }

    let mut jumps = Vec::new();
    for (at, (before, after)) in breaks.iter().zip(sides) {
        let (before, after) = (before.derivatives(), after.derivatives());
        // Change of a smooth law between the two times, including their rounding.
        let room = (at.after - at.before) + 4.0 * f64::EPSILON * at.time.abs();
        let order = (0..3).find(|&n| {
            let smooth = 2.0 * room * before[n + 1].abs().max(after[n + 1].abs());
            let size = (after[n] - before[n]).abs();
            size > RELATIVE * largest[n]
                + ROUNDING * largest[0]
                + if smooth.is_finite() { smooth } else { 0.0 }
        });
        jumps.extend(order.map(|order| Jump { time: at.time, order, size: after[order] - before[order] }));
    }
    jumps
}

/// The law just before `t`, by one-sided continuation.
fn just_before(law: &Law, t: f64) -> Jet {
    let [f, d, dd, ddd] = law.evaluate(backwards(t), None).derivatives();
    // In s = -t: d/dt = -d/ds
    Jet([f, -d, dd, -ddd])
}

#[cfg(test)]
mod tests {
    use crate::law::*;

    fn step(start: f64, end: f64, degree: u32) -> Law {
        Law::smooth_step(SmoothStep { from: 0.5, to: 3.0, start, end, degree }).unwrap()
    }

    #[test]
    fn jumps_are_found_where_they_are() {
        let expression = |text: &str| Law::parse(text).unwrap();
        let interrupted = vec![
            Piece::lasting(0.3, expression("5*t")),
            Piece::lasting(0.4, expression("abs(t - 0.1)")),
            Piece::open_ended(Law::constant(9.0)).not_continued(),
        ];
        type Case = (Law, &'static [(f64, usize, f64)]);
        let cases: [Case; 12] = [
            (expression("if(t < 0.503, 1, 3)"), &[(0.503, 0, 2.0)]),
            (expression("if(t <= 1, t, 2 - t)"), &[(1.0, 1, -2.0)]),
            (expression("abs(t - 0.1)*(t - 0.1)"), &[(0.1, 2, 4.0)]),
            (expression("min(t, 1, 3 - t)"), &[(1.0, 1, -1.0), (2.0, 1, -1.0)]),
            (expression("step(t, 0.5, 0, 0.5001, 1)"), &[(0.5, 2, 6e8), (0.5001, 2, 6e8)]),
            (expression("atan2(sin(t), cos(t))"), &[(std::f64::consts::PI, 0, -std::f64::consts::TAU)]),
            (expression("max(0, t) + max(0, t - 4)"), &[(0.0, 1, 1.0), (4.0, 1, 1.0)]),
            (step(0.5, 1.5, 3), &[(0.5, 2, 15.0), (1.5, 2, 15.0)]),
            (step(0.5, 1.5, 3).scaled(-2.0), &[(0.5, 2, -30.0), (1.5, 2, -30.0)]),
            (Law::sequence(interrupted).unwrap(), &[(0.3, 1, -6.0), (0.4, 1, 2.0), (0.7, 0, 7.3)]),
            (
                Law::sequence(vec![
                    Piece::lasting(
                        0.1,
                        Law::smooth_step(SmoothStep { from: 0.0, to: 1.0, start: 0.0, end: 0.1, degree: 3 })
                            .unwrap(),
                    ),
                    Piece::open_ended(Law::constant(0.0)),
                ])
                .unwrap(),
                &[(0.1, 2, 600.0)],
            ),
            (
                Law::sequence(vec![
                    Piece::lasting(1.0, expression("t^2")),
                    Piece::open_ended(expression("2*t")),
                ])
                .unwrap(),
                &[(1.0, 2, -2.0)],
            ),
        ];
        for (law, expected) in cases {
            let found = law.jumps(0.0, 4.0);
            assert_eq!(found.len(), expected.len(), "{law}: {found:?}");
            for (jump, &(time, order, size)) in found.iter().zip(expected) {
                assert!((jump.time - time).abs() <= 1e-12, "{law}: {jump:?}");
                assert_eq!(jump.order, order, "{law}: {jump:?}");
                assert!((jump.size - size).abs() <= 1e-6 * size.abs(), "{law}: {jump:?} is not {size}");
            }
        }
    }

    #[test]
    fn smooth_laws_have_no_jumps() {
        let smooth = [
            "abs(t - 1)^3",
            "max(sin(3*t)^2 + cos(3*t)^2, 1)",
            "if(t < 1, t^3, 1 + 3*(t - 1) + 3*(t - 1)^2 + (t - 1)^3)",
            "abs(2 + t)",
            "if(t > 9, 1, 2)",
            "atan2(t - 1, 1 + t)",
            "sqrt(t - 1)",
        ];
        let mut laws: Vec<Law> = smooth.iter().map(|text| Law::parse(text).unwrap()).collect();
        laws.extend([step(0.5, 1.5, 5), step(0.5, 1.5, 7), step(7.0, 8.0, 3)]);
        let points = |degree, ends| {
            let (times, values) = (vec![0.0, 0.4, 1.0, 3.0], vec![1.0, 3.0, -2.0, 1.0]);
            Law::table(&Table { times, values, degree, ends }).unwrap()
        };
        laws.extend([
            points(SplineDegree::Cubic, SplineEnds::Periodic),
            points(SplineDegree::Quintic, SplineEnds::Natural),
        ]);
        let cosine = Law::parse("cos(t)").unwrap();
        laws.push(
            Law::sequence(vec![
                Piece::lasting(0.3, cosine.clone()),
                Piece::open_ended(Law::parse("cos(t + 0.3)").unwrap()),
            ])
            .unwrap(),
        );
        for law in laws {
            assert_eq!(law.jumps(0.0, 4.0), [], "{law}");
        }
        assert_eq!(Law::parse("abs(t)").unwrap().jumps(1.0, -1.0), [], "no time between");
        assert_eq!(Law::parse("abs(t)").unwrap().jumps(0.0, f64::INFINITY), [], "no such time");
    }
}
