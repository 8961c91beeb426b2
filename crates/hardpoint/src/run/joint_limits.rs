//! Limits of joints over a motion: ranges of their values, and the times at which they are reached, located exactly.
//!
//! Times are found on motions that are solved anew at them, like those of clearances; the polynomials between solved
//! times only predict them.

use crate::measure::Output;
use crate::model::{JointLimit, LimitEnd, Model, OutputSource, VariableId};
use crate::motion::{Stop, StopKind};
use crate::order::sort_by_number;

use super::curve::{SampledCurve, crossing};
use super::request::Scope;
use super::{Analysis, PreparedDesign, Run, Solution, Walk};

/// A crossing is located if a step of Newton's method is below this fraction of the motion: positions are solved to
/// 1e-12 of the mechanism's size.
const LOCATED: f64 = 1e-11;
/// An extremum is located if the motion is solved nearer to its time than this fraction of the motion: its value is
/// then known to round-off. Crossings nearer to each other are the same one.
const SAME_TIME: f64 = 1e-8;
/// Time by which an interval of a motion without rates is narrowed around an extremum, as a fraction of the motion.
const AT_REST: f64 = 1e-6;
/// Rate below which a crossing is grazing, as a fraction of the largest rate: its time has no derivative.
const GRAZING: f64 = 1e-6;
/// Maximum number of times that the motion is solved again; each pass is nearer to the times by several digits, or
/// halves an interval.
const MOST_PASSES: usize = 40;
/// Rise of a motion without rates above three times in a row that counts, in rises of the parabola through them.
const VERTEX_ERROR: f64 = 4.0;
/// Pieces of an interval of a motion without rates, in which an extremum is looked for.
const PIECES: usize = 4;

/// Least or greatest value over a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitExtremum {
    /// Time, s.
    pub time: f64,
    /// Value, m or rad.
    pub value: f64,
    /// Derivative of the value by every design variable; NaN for those that are not admissible, and where the motion
    /// ends early at a time that changes by an unknown amount.
    pub d: Vec<f64>,
}

/// Time at which a value leaves its range, or returns to it.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitCrossing {
    /// Time, s.
    pub time: f64,
    /// End of the range.
    pub end: LimitEnd,
    /// True if the value leaves the range there, false if it returns.
    pub leaves: bool,
    /// Derivative of the time by every design variable, s per m, rad or plain; NaN where the crossing is grazing, and
    /// for variables that are not admissible.
    pub d: Vec<f64>,
}

/// Value of a limited coordinate or articulation over a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitRange {
    /// The least value.
    pub least: LimitExtremum,
    /// The greatest value.
    pub greatest: LimitExtremum,
    /// End of the range that the value is beyond at the first output time.
    pub begins_beyond: Option<LimitEnd>,
    /// All crossings of both ends, in order of time.
    pub crossings: Vec<LimitCrossing>,
}

impl LimitRange {
    /// Value that is nearest to an end of the range, or farthest beyond it.
    pub fn extremum(&self, end: LimitEnd) -> &LimitExtremum {
        match end {
            LimitEnd::Min => &self.least,
            LimitEnd::Max => &self.greatest,
        }
    }
}

/// Crossing that is located.
#[derive(Clone, Copy, Debug)]
struct Located {
    limit: usize,
    time: f64,
    end: LimitEnd,
    leaves: bool,
}

/// Crossings of a motion, with the motion that was solved at them.
struct Crossings {
    solution: Solution,
    /// Per limit, the end that it is beyond at the first output time.
    begins_beyond: Vec<Option<LimitEnd>>,
    /// In order of time.
    located: Vec<Located>,
}

impl Crossings {
    /// Returns the first time at which a limit ends the motion.
    fn stop(&self, model: &Model) -> Option<(f64, StopKind)> {
        let stops = |k: &usize| model.joint_limits[*k].stop;
        let begins = (0..self.begins_beyond.len()).filter(stops).find_map(|limit| {
            let kind = StopKind::JointLimit { limit, end: self.begins_beyond[limit]?, begins_beyond: true };
            Some((self.solution.motion.times[0], kind))
        });
        begins.or_else(|| {
            let first = self.located.iter().find(|c| c.leaves && model.joint_limits[c.limit].stop)?;
            let kind = StopKind::JointLimit { limit: first.limit, end: first.end, begins_beyond: false };
            Some((first.time, kind))
        })
    }
}

/// End of a motion before its last output time, which moves with the design.
pub(super) struct MovingEnd {
    /// Time, s.
    time: f64,
    /// The limit that ends the motion, as an index in [`Model::joint_limits`], if one does.
    limit: Option<usize>,
    /// Derivative of the time by every design variable; NaN where it is not known.
    d: Vec<f64>,
}

impl MovingEnd {
    /// The end of a motion that takes these times, from its solution there with measures and sensitivities; `None` if
    /// the end is fixed. `stop` is the time and the kind of the stop at a limit.
    pub fn of(
        model: &Model,
        solution: &Solution,
        [first, time]: [f64; 2],
        stop: Option<(f64, StopKind)>,
    ) -> Option<Self> {
        let mut limit = None;
        if let Some((reached, StopKind::JointLimit { limit: by, begins_beyond, .. })) = stop {
            if begins_beyond {
                return None;
            }
            limit = Some(by).filter(|_| reached == time);
        } else if model.times.last().is_none_or(|last| *last <= time) {
            return None;
        }
        let place = || solution.motion.times.iter().position(|t| *t == time);
        let known =
            limit.and_then(|limit| time_derivatives(model, solution, (limit, place()?), time - first));
        Some(Self { time, limit, d: known.unwrap_or_else(|| vec![f64::NAN; model.variables.len()]) })
    }

    /// Makes derivatives at constant time, of a value with this rate at the end, those of the value at the moving end.
    pub fn follow(&self, rate: f64, d: &mut [f64]) {
        // y_b + y. T_b                                                                          docs/theory.md (62)
        d.iter_mut().zip(&self.d).for_each(|(d, by)| *d += rate * by);
    }
}

impl Analysis<'_> {
    /// Solves the motion of a design up to its stop, and locates the ranges of all limits of joints and the times at
    /// which they are reached, with their derivatives by the design variables. Empty if no output time is solved.
    pub fn joint_limits(&self, design: &[f64]) -> Vec<LimitRange> {
        let model = self.model();
        if model.joint_limits.is_empty() {
            return Vec::new();
        }
        let Some(mut found) = self.crossings(design, |_| true) else { return Vec::new() };
        let mut times = found.solution.motion.times.clone();
        let stop = found.stop(model);
        if let Some((end, _)) = stop {
            // The motion ends there.
            found.located.retain(|c| c.time <= end);
            times.retain(|t| *t < end);
            times.push(end);
            found.solution = self.beyond_stops(&times, design, false);
        }
        let mut extrema = Vec::new();
        for _ in 0..MOST_PASSES {
            let (at, add) = extrema_of(model, &times, &found.solution);
            extrema = at;
            if add.is_empty() {
                break;
            }
            times.extend(add);
            times.sort_by(f64::total_cmp);
            times.dedup();
            found.solution = self.beyond_stops(&times, design, false);
        }
        let of_extrema = extrema.iter().flatten().copied();
        let of_crossings = found.located.iter().map(|c| c.time);
        let mut events: Vec<f64> = of_extrema.chain(of_crossings).chain(times.first().copied()).collect();
        events.sort_by(f64::total_cmp);
        events.dedup();
        let solution = self.beyond_stops(&events, design, true);
        if solution.motion.len() < events.len() {
            return Vec::new();
        }
        let end = times.last().and_then(|last| MovingEnd::of(model, &solution, [times[0], *last], stop));
        results(model, &extrema, (&found, end.as_ref()), &solution)
    }

    /// Returns the stop of a design at the limit of a joint, if there is one.
    pub(super) fn stop_at_limit(&self, design: &PreparedDesign) -> Option<Stop> {
        let model = self.model();
        if !model.stops_at_limits() {
            return None;
        }
        let (failed_time, kind) = self.crossings(&design.values, |limit| limit.stop)?.stop(model)?;
        let begins_beyond = matches!(kind, StopKind::JointLimit { begins_beyond: true, .. });
        let span = model.times.last().zip(model.times.first()).map_or(0.0, |(last, first)| last - first);
        // The motion is that up to the limit; an output time at which it is reached belongs to it.
        let reached = |t: &&f64| **t <= failed_time + LOCATED * span;
        let last_output = model.times.iter().take_while(reached).last().copied();
        let last_time = last_output.filter(|_| !begins_beyond).map(|t| t.max(failed_time));
        let at = last_time.unwrap_or(failed_time);
        Some(Stop {
            kind,
            last_time,
            failed_time,
            drivers: self.drivers_at(design, at),
            block: None,
            pivot_ratio: 1.0,
            joints: Vec::new(),
            remains: Vec::new(),
            closed: None,
            snaps_through: false,
        })
    }

    /// Values of all drivers at a time of the motion: those of their laws, of released ones those at equilibrium.
    fn drivers_at(&self, design: &PreparedDesign, t: f64) -> Vec<f64> {
        let model = self.model();
        let by_law = model.drivers.iter().zip(&design.laws);
        let mut values: Vec<f64> = by_law.map(|(driver, law)| driver.with_sense(law.at(t).value())).collect();
        if model.equilibrium.as_ref().is_some_and(|equilibrium| !equilibrium.released.is_empty()) {
            let before = model.times.iter().copied().take_while(|before| *before < t);
            let analysis = self.without_stops(before.chain([t]).collect());
            let design = analysis.prepare(&design.values, Scope::of_one(false, false));
            let mut walk = Walk::new(&analysis, &design, vec![false; model.bodies.len()]);
            walk.each(|one| one.write_released(model, &mut values));
        }
        values
    }

    /// Solution at other times of the motion that no limit ends, with measures.
    pub(super) fn beyond_stops(&self, times: &[f64], design: &[f64], sensitivities: bool) -> Solution {
        let run = Run::new().at(design);
        let run = if sensitivities { run } else { run.without_sensitivities() };
        self.without_stops(times.to_vec()).solve(run)
    }

    /// Locates all crossings of some limits; `None` if no output time is solved.
    fn crossings(&self, design: &[f64], counts: impl Fn(&JointLimit) -> bool) -> Option<Crossings> {
        let model = self.model();
        let mut times = self.times_within();
        let mut solution = Solution::default();
        let mut located = Vec::new();
        for pass in 1..=MOST_PASSES {
            solution = self.beyond_stops(&times, design, false);
            let mut add = Vec::new();
            located.clear();
            for (k, limit) in model.joint_limits.iter().enumerate().filter(|(_, limit)| counts(limit)) {
                let Some(curve) = curve_of(limit, &solution) else { continue };
                for end in LimitEnd::ALL {
                    if let Some(bound) = limit.end(end) {
                        let tolerance = limit.tolerance(model);
                        if pass < MOST_PASSES {
                            look_between(&curve, bound, end, tolerance, &mut add);
                        }
                        let mut found =
                            locate(&curve, bound, end, tolerance, (pass == MOST_PASSES, &mut add));
                        located.extend(found.drain(..).map(|(time, leaves)| Located {
                            limit: k,
                            time,
                            end,
                            leaves,
                        }));
                    }
                }
            }
            if add.is_empty() {
                break;
            }
            times.truncate(solution.motion.len());
            times.extend(add);
            times.sort_by(f64::total_cmp);
            times.dedup();
        }
        if solution.motion.is_empty() {
            return None;
        }
        sort_by_number(&mut located, |found| found.time);
        let at_start = |limit: &JointLimit| limit.exceeded(model, curve_of(limit, &solution)?.values[0][0]);
        let begins_beyond = model.joint_limits.iter().map(at_start).collect();
        Some(Crossings { solution, begins_beyond, located })
    }
}

/// Curve of a limited value at the times of a solution.
fn curve_of<'s>(limit: &JointLimit, solution: &'s Solution) -> Option<SampledCurve<'s, f64>> {
    let (measured, m) = (&solution.measured, column(limit, solution)?);
    let values: Vec<[f64; 3]> = (0..measured.len()).map(|k| measured.value(k, m)).collect();
    let Output { known, kinks, .. } = measured.outputs[m];
    let curve = SampledCurve {
        times: &solution.motion.times,
        orders: known.orders,
        kinks,
        is_located: false,
        values,
    };
    (!curve.values.is_empty()).then_some(curve)
}

/// Adds times at which a motion without rates must be solved, since its value may reach an end of its range, or return
/// from beyond, between three times in a row: the vertex of the parabola through them is near the end.
fn look_between(
    curve: &SampledCurve<'_, f64>,
    bound: f64,
    end: LimitEnd,
    tolerance: f64,
    add: &mut Vec<f64>,
) {
    let times = &curve.times[..curve.values.len()];
    let span = times.last().zip(times.first()).map_or(0.0, |(last, first)| last - first);
    for (k, three) in times.windows(3).enumerate() {
        if curve.known(k) != 1 || three[2] - three[0] <= AT_REST * span {
            continue;
        }
        let [a, b, c] = [k, k + 1, k + 2].map(|k| end.sign() * (curve.values[k][0] - bound));
        let side = if a.max(b).max(c) <= tolerance {
            1.0
        } else if a.min(b).min(c) > tolerance {
            -1.0
        } else {
            continue;
        };
        // Newton's form: y = b + s (t - t_1) + q (t - t_1) (t - t_0)
        let [first, second] = [(b - a) / (three[1] - three[0]), (c - b) / (three[2] - three[1])];
        let bend = (second - first) / (three[2] - three[0]);
        let slope = first + bend * (three[1] - three[0]);
        let vertex = three[1] - 0.5 * slope / bend;
        if !(side * bend < 0.0 && three[0] < vertex && vertex < three[2]) {
            continue;
        }
        let height = side * (b - 0.25 * slope * slope / bend);
        let most = [a, b, c].into_iter().map(|y| side * y).fold(f64::NEG_INFINITY, f64::max);
        let rise = height - most;
        if most + VERTEX_ERROR * rise > side * tolerance {
            add.extend([0.5 * (three[0] + three[1]), vertex, 0.5 * (three[1] + three[2])]);
        }
    }
}

/// Crossings of an end of a range that are located, each with true if the value leaves the range there; times at which
/// the motion must be solved to locate the others are added. The last time all of them are as located as they are.
fn locate(
    curve: &SampledCurve<'_, f64>,
    bound: f64,
    end: LimitEnd,
    tolerance: f64,
    (is_last, add): (bool, &mut Vec<f64>),
) -> Vec<(f64, bool)> {
    let (times, last) = (curve.times, curve.values.len() - 1);
    let span = times[last] - times[0];
    // Positive beyond the end.
    let beyond = |k: usize| end.sign() * (curve.values[k][0] - bound);
    let rate = |k: usize| if curve.known(k) > 1 { end.sign() * curve.values[k][1] } else { f64::NAN };
    let mut nodes: Vec<usize> = Vec::new();
    let first = add.len();
    for k in 0..last {
        let width = times[k + 1] - times[k];
        for part in SampledCurve::monotone(times, Some(curve), k) {
            let Some(t) = crossing(Some(curve), k, part, bound) else { continue };
            let t = if part[0] <= t && t <= part[1] { t } else { 0.5 * (part[0] + part[1]) };
            let near = if t - times[k] <= times[k + 1] - t { k } else { k + 1 };
            let step = beyond(near).abs() <= LOCATED * span * rate(near).abs();
            if step || beyond(near) == 0.0 || width <= LOCATED * span || is_last {
                if nodes.last().is_none_or(|n| times[near] - times[*n] > SAME_TIME * span) {
                    nodes.push(near);
                }
            } else {
                add.push(t);
                if !rate(near).is_finite() {
                    add.push(0.5 * (times[k] + times[k + 1]));
                }
            }
        }
    }
    if add.len() > first {
        return Vec::new();
    }
    // Value farthest beyond the end between two times.
    let farthest = |from: f64, to: f64| {
        let within = |t: &f64| from <= *t && *t <= to;
        let solved = (0..=last).filter(|k| within(&times[*k])).map(beyond);
        let between = (0..last).filter(|k| times[*k] <= to && from <= times[k + 1]);
        let turns = between.flat_map(|k| curve.turns(k).into_iter().filter(within).map(move |t| (k, t)));
        let turns = turns.map(|(k, t)| end.sign() * (curve.number(k, t) - bound));
        solved.chain(turns).fold(f64::NEG_INFINITY, f64::max)
    };
    // Parts between crossings, each within the range or beyond it by more than round-off.
    let ends: Vec<f64> =
        std::iter::once(times[0]).chain(nodes.iter().map(|k| times[*k])).chain([times[last]]).collect();
    let is_beyond: Vec<bool> = ends.windows(2).map(|part| farthest(part[0], part[1]) > tolerance).collect();
    let changes = nodes.iter().zip(is_beyond.windows(2)).filter(|(_, sides)| sides[0] != sides[1]);
    // A last step of Newton's method; the motion is solved again at these times.
    let exact =
        |k: usize| times[k] - Some(beyond(k) / rate(k)).filter(|step| step.is_finite()).unwrap_or(0.0);
    changes.map(|(k, sides)| (exact(*k).clamp(times[0], times[last]), sides[1])).collect()
}

/// Times of the least and the greatest value of each limit up to the last of some times, which are the first ones of
/// the solution; and times at which the motion must be solved to locate them.
fn extrema_of(model: &Model, times: &[f64], solution: &Solution) -> (Vec<[f64; 2]>, Vec<f64>) {
    let mut add = Vec::new();
    let mut of_limit = |limit: &JointLimit| {
        let Some(mut curve) = curve_of(limit, solution) else { return [times[0]; 2] };
        curve.values.truncate(times.len());
        [-1.0, 1.0].map(|sign| extremum(&curve, sign, &mut add))
    };
    let found = model.joint_limits.iter().map(&mut of_limit).collect();
    (found, add)
}

/// Solved time of the greatest value (sign 1) or the least one (-1); times are added at which the motion must be solved
/// to locate it.
fn extremum(curve: &SampledCurve<'_, f64>, sign: f64, add: &mut Vec<f64>) -> f64 {
    let (times, last) = (curve.times, curve.values.len() - 1);
    let span = times[last] - times[0];
    let value = |k: usize| sign * curve.values[k][0];
    let finite = (0..=last).filter(|k| value(*k).is_finite());
    let Some(best) = finite.reduce(|a, b| if value(b) > value(a) { b } else { a }) else { return times[0] };
    if curve.known(best) == 1 {
        // Without rates, the intervals on both sides are divided.
        for [a, b] in [[best.saturating_sub(1), best], [best, (best + 1).min(last)]] {
            let [from, to] = [times[a], times[b]];
            if to - from > AT_REST * span {
                add.extend((1..PIECES).map(|n| from + (to - from) * n as f64 / PIECES as f64));
            }
        }
        return times[best];
    }
    let turns = (0..last).flat_map(|k| curve.turns(k).into_iter().map(move |t| (k, t)));
    let turns = turns.map(|(k, t)| (k, t, sign * curve.number(k, t)));
    let higher = turns.filter(|turn| turn.2 > value(best)).max_by(|a, b| a.2.total_cmp(&b.2));
    if let Some((k, t, _)) = higher {
        let near = [k, k + 1].into_iter().find(|end| (t - times[*end]).abs() <= SAME_TIME * span);
        match near {
            Some(near) => return times[near],
            None => add.push(t),
        }
    }
    times[best]
}

/// Derivatives of output m at time k of a solution by all design variables; NaN for those that are not admissible.
fn derivatives(model: &Model, solution: &Solution, k: usize, m: usize) -> Vec<f64> {
    let Solution { measured, sensitivities, .. } = solution;
    let variables = (0..model.variables.len()).map(VariableId);
    let d = variables.map(|b| match sensitivities.at(k, b.0).is_some() {
        true => measured.derivative(k, b, m, 0),
        false => f64::NAN,
    });
    d.collect()
}

/// Column of the measure of a limit.
fn column(limit: &JointLimit, solution: &Solution) -> Option<usize> {
    solution.measured.outputs.iter().position(|o| o.source == OutputSource::Measure(limit.measure))
}

/// Derivatives of the time at which a limit is reached, time k of a solution that has its extrema, in a motion of this
/// duration; NaN where the crossing is grazing.
fn time_derivatives(
    model: &Model,
    solution: &Solution,
    (limit, k): (usize, usize),
    span: f64,
) -> Option<Vec<f64>> {
    let m = column(&model.joint_limits[limit], solution)?;
    let measured = &solution.measured;
    let rate = measured.value(k, m)[1];
    // Scale of the rate: the range of the value over the time of the motion.
    let values = || (0..measured.len()).map(|k| measured.value(k, m)[0]);
    let range = values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min);
    let rate = if rate.abs() * span > GRAZING * range { rate } else { f64::NAN };
    // t_b = -x_b / x.                                                                       docs/theory.md (62)
    Some(derivatives(model, solution, k, m).iter().map(|d| -d / rate).collect())
}

/// Results at the located times, of a motion that is solved at them.
fn results(
    model: &Model,
    extrema: &[[f64; 2]],
    (found, end): (&Crossings, Option<&MovingEnd>),
    solution: &Solution,
) -> Vec<LimitRange> {
    let Solution { motion, measured, .. } = solution;
    let span = found.solution.motion.times.last().map_or(0.0, |last| last - motion.times[0]);
    let of_limit = |(number, limit): (usize, &JointLimit)| {
        let m = column(limit, solution)?;
        let place = |time: f64| motion.times.iter().position(|t| *t == time);
        let extremum = |time: f64| {
            let k = place(time)?;
            let [value, rate, _] = measured.value(k, m);
            let mut d = derivatives(model, solution, k, m);
            match end.filter(|end| end.time == time) {
                // The value at which the motion ends is the same for all designs.
                Some(end) if end.limit == Some(number) => d.iter_mut().for_each(|d| *d = 0.0 * d.abs()),
                Some(end) => end.follow(rate, &mut d),
                None => (),
            }
            Some(LimitExtremum { time, value, d })
        };
        let [least, greatest] = extrema[number].map(extremum);
        let crossings = found.located.iter().filter(|c| c.limit == number).filter_map(|c| {
            let d = time_derivatives(model, solution, (number, place(c.time)?), span)?;
            Some(LimitCrossing { time: c.time, end: c.end, leaves: c.leaves, d })
        });
        let crossings = crossings.collect();
        let begins_beyond = found.begins_beyond[number];
        Some(LimitRange { least: least?, greatest: greatest?, begins_beyond, crossings })
    };
    model.joint_limits.iter().enumerate().map(of_limit).collect::<Option<_>>().unwrap_or_default()
}
