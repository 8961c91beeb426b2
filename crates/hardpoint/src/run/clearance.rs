//! Clearances over a motion: curves of all pairs of shapes, their minima and contacts, located exactly.
//!
//! Times are found on motions that are solved anew at them, never on polynomials between output times: a distance may
//! change its features there, where its acceleration jumps.

mod curves;
mod pair_search;
mod posed_motion;

use crate::clearance::{ChangingBodies, Feature, MovingBodies, Nearest, PlacedShapes};
use crate::design::{BodyFixed, DesignMap, ShapeGeometry};
use crate::measure::{clearance_of, clearances_of};
use crate::model::{
    BodyId, Clearance, ClearanceId, Metric, Model, OutputSource, PointId, Reduction, Shape, ShapeId,
    ShapeKind, ShapePair,
};
use crate::motion::{Motion, Stop, StopKind};
use crate::number::{Dual, Jet, Rates};
use crate::order::sort_by_number;
use crate::space::Vec3;

use self::curves::Curves;
use self::pair_search::{EventKind, Located};
use self::posed_motion::{PosedMotion, has_surface};
use super::joint_limits::MovingEnd;
use super::metric::reaches;
use super::{Analysis, Run, Solution};

/// Candidates nearer to a located time than this fraction of the motion are the same one.
const SAME_TIME: f64 = 1e-8;
/// Maximum number of times that the motion is solved again; each pass is nearer to the times by several digits, or
/// divides an interval in which features change. A contact that is found late takes the same number of passes as any
/// other.
const MOST_PASSES: usize = 100;
/// Rate of a distance below which a contact is grazing, as a fraction of the largest rate: its time has no derivative.
const GRAZING: f64 = 1e-6;
/// Difference of rates along a stretch, as a fraction of them, that is round-off.
const JUMP: f64 = 1e-9;
/// A distance that changes less than this fraction of the mechanism's size over a motion is constant: round-off of
/// solved positions.
const CONSTANT: f64 = 1e-10;

/// Distance of two shapes at one time.
#[derive(Clone, Copy, Debug)]
pub struct ShapeDistance {
    /// Time, s.
    pub time: f64,
    /// Distance, its rate and acceleration: m, m/s, m/s^2; negative where the shapes overlap.
    pub distance: [f64; 3],
    /// The nearest points of the shapes' cores, global, m.
    pub points: [Vec3; 2],
    /// True if more than one pair of points is nearest, since lines or faces are parallel.
    pub is_parallel: bool,
    /// True if the cores of the shapes meet: the distance does not say how deep the shapes are in each other.
    pub cores_meet: bool,
}

impl ShapeDistance {
    /// True in an overlap of unknown depth, whose distance and rates are zero at all times.
    fn is_deep(&self) -> bool {
        self.cores_meet && self.distance[..2] == [0.0; 2]
    }
}

/// Place of a minimum in the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MinimumPlace {
    /// At the first output time.
    Start,
    /// Between two times, where the rate is zero.
    Inside,
    /// At the last output time that was solved.
    End,
}

/// A least distance of two shapes.
#[derive(Clone, Debug)]
pub struct ClearanceMinimum {
    /// Distance and nearest points there.
    pub at: ShapeDistance,
    /// Place in the motion.
    pub place: MinimumPlace,
    /// True if the rate jumps there from negative to positive, since two features are equally near.
    pub is_kink: bool,
    /// Derivative of the distance by every design variable; NaN for those that are not admissible, where the cores
    /// meet, and where the motion ends early at a time that changes by an unknown amount.
    pub d: Vec<f64>,
}

/// A time at which two shapes touch or part.
#[derive(Clone, Debug)]
pub struct Contact {
    /// Distance and nearest points there.
    pub at: ShapeDistance,
    /// True if they touch there, false if they part.
    pub begins: bool,
    /// Derivative of the time by every design variable, s per m, rad or plain; NaN where the contact is grazing, and
    /// for variables that are not admissible.
    pub d: Vec<f64>,
}

/// Distance of two shapes over a motion.
#[derive(Clone, Debug)]
pub struct PairClearance {
    /// The shapes.
    pub shapes: [ShapeId; 2],
    /// At the output times that were solved.
    pub curve: Vec<ShapeDistance>,
    /// All local minima, in order of time.
    pub minima: Vec<ClearanceMinimum>,
    /// All contacts, in order of time.
    pub contacts: Vec<Contact>,
    /// True if the distance is the same at all times.
    pub is_constant: bool,
    /// The last time that was solved, s: the end of the motion, or where it stops.
    pub end: f64,
}

impl PairClearance {
    /// First time at which the distance is not known, s: that of the shapes has no number there.
    pub fn unknown_at(&self) -> Option<f64> {
        self.curve.iter().find(|at| at.distance[0].is_nan()).map(|at| at.time)
    }

    /// The least of the minima: one where the cores meet, if there is any, since no other is known to be deeper.
    pub fn least(&self) -> Option<&ClearanceMinimum> {
        let by_depth = |a: &ClearanceMinimum, b: &ClearanceMinimum| {
            b.at.cores_meet.cmp(&a.at.cores_meet).then(a.at.distance[0].total_cmp(&b.at.distance[0]))
        };
        self.minima.iter().min_by(|a, b| by_depth(a, b))
    }

    /// Intervals in which the shapes touch, s; one that begins before the motion or ends after it has its first or last
    /// time.
    pub fn intervals(&self) -> Vec<[f64; 2]> {
        let Some(first) = self.curve.first() else { return Vec::new() };
        let mut from = (first.distance[0] <= 0.0).then_some(first.time);
        let mut found = Vec::new();
        for contact in &self.contacts {
            if contact.begins {
                from = Some(contact.at.time);
            } else if let Some(from) = from.take() {
                found.push([from, contact.at.time]);
            }
        }
        found.extend(from.map(|from| [from, self.end]));
        found
    }
}

/// Clearances over a motion.
#[derive(Clone, Debug)]
pub struct Clearances {
    /// All pairs of all clearances, each once.
    pub pairs: Vec<PairClearance>,
    /// Reason why the motion ended before its last output time, if it did.
    pub stop: Option<Stop>,
}

impl Clearances {
    /// The results of the pairs of a clearance, in its order.
    pub fn of<'a>(
        &'a self,
        clearance: &'a Clearance,
    ) -> impl Iterator<Item = (&'a ShapePair, &'a PairClearance)> {
        clearance.pairs.iter().filter_map(|pair| {
            self.pairs.iter().find(|found| found.shapes == pair.shapes).map(|found| (pair, found))
        })
    }
}

/// Distance of two shapes at some times of a motion that is solved already.
#[derive(Clone, Debug)]
pub struct PairCurve {
    /// The shapes.
    pub shapes: [ShapeId; 2],
    /// At the times, in their order.
    pub curve: Vec<ShapeDistance>,
}

/// A shape of a design, in the frames of the bodies that carry it.
#[derive(Clone, Debug)]
pub struct ShapeOnBodies {
    /// Points with their bodies, m: the centre, the ends or the corners; none of a mesh.
    pub points: Vec<(BodyId, Vec3)>,
    /// Axis or normal, a unit vector in the frame of the first of its bodies, if it has one that points do not give.
    pub axis: Option<Vec3>,
    /// Radius, to the outside, m: of a ring that of the circle in the middle of its bar; 0 where there is none.
    pub radius: f64,
    /// Half of a tyre's width, m; otherwise 0.
    pub half_width: f64,
    /// Radius around the core, m.
    pub round: f64,
}

impl Analysis<'_> {
    /// All shapes of a design.
    pub fn shapes_on_bodies(&self, design: &[f64]) -> Vec<ShapeOnBodies> {
        let model = self.model();
        let fixed: BodyFixed<f64> = self.design_map().fixed(&model.whole(design));
        let at = |p: &PointId| (model.points[p.0].body, fixed.points[p.0]);
        let of_shape = |(shape, numbers): (&Shape, &ShapeGeometry<f64>)| {
            let &ShapeGeometry { axis, size, round } = numbers;
            let (points, radius, half_width) = match &shape.kind {
                ShapeKind::Sphere { centre } => (vec![at(centre)], round, 0.0),
                ShapeKind::Capsule { ends } => (ends.iter().map(at).collect(), round, 0.0),
                ShapeKind::Ring { centre, .. } => (vec![at(centre)], size, 0.0),
                ShapeKind::Cylinder { ends, .. } => (ends.iter().map(at).collect(), size, 0.0),
                ShapeKind::Tyre { wheel, .. } => {
                    let wheel = &model.wheels[wheel.0];
                    (vec![at(&wheel.centre)], wheel.radius, 0.5 * size)
                }
                ShapeKind::Plane { point, .. } => (vec![at(point)], 0.0, 0.0),
                ShapeKind::Hull { points, .. } => (points.iter().map(at).collect(), 0.0, 0.0),
                ShapeKind::Mesh { .. } => (Vec::new(), 0.0, 0.0),
            };
            ShapeOnBodies { points, axis, radius, half_width, round }
        };
        model.shapes.iter().zip(&fixed.shapes).map(of_shape).collect()
    }

    /// Distances at these times of a solved motion of a design, of the pairs that are the nearest of their clearance at
    /// any of them. Those of the others are never the value of a clearance.
    pub fn nearest_pairs(&self, design: &[f64], motion: &Motion, steps: &[usize]) -> Vec<PairCurve> {
        let model = self.model();
        let posed = PosedMotion::of(self, design, motion);
        let mut active: Vec<[ShapeId; 2]> = Vec::new();
        posed.each(steps.iter().copied(), |_, placed| {
            for (c, clearance) in model.clearances.iter().enumerate() {
                let Some((k, _)) = placed.nearest_pair(ClearanceId(c)) else { continue };
                let shapes = clearance.pairs[k].shapes;
                if !active.contains(&shapes) {
                    active.push(shapes);
                }
            }
        });
        let mut pairs = model.shape_pairs();
        pairs.retain(|shapes| active.contains(shapes));
        let samples = posed.distances(&pairs, steps.iter().copied());
        pairs.iter().zip(samples).map(|(shapes, curve)| PairCurve { shapes: *shapes, curve }).collect()
    }

    /// Solves the motion of a design, and locates all minima and contacts of the pairs of all clearances, with their
    /// derivatives by the design variables.
    ///
    /// If the caller [ends](Analysis::ended_by) the search, its stop is [`Interrupted`](StopKind::Interrupted): minima
    /// and contacts that were not located yet are those of the times that were solved, without derivatives.
    pub fn clearances(&self, design: &[f64]) -> Clearances {
        let model = self.model();
        let pairs = model.shape_pairs();
        let mut curves = Curves::new(model, &pairs);
        let (located, first_stop) =
            self.locate_events(design, self.motion_at(&self.times_within(), design, false), &mut curves);
        let of_events = located.events.iter().flat_map(|e| [e.time].into_iter().chain(e.kink));
        let mut events: Vec<f64> = of_events.chain(model.times.iter().copied()).collect();
        sort_times(&mut events);
        if first_stop.is_some() {
            // Between output times, a motion may end where those alone do not show it: nothing is known beyond.
            let last = curves.times.last().copied().unwrap_or(f64::NEG_INFINITY);
            events.retain(|t| *t <= last);
        }
        // The derivatives of the time at which a limit is reached are those of its measure.
        let is_at_limit = first_stop.as_ref().is_some_and(|s| matches!(s.kind, StopKind::JointLimit { .. }));
        let mut solution = match is_at_limit {
            true => self.beyond_stops(&events, design, true),
            false => self.motion_at(&events, design, true),
        };
        curves.add(self, design, &solution.motion);
        solution.stop = solution.stop.or(first_stop);
        if solution.stop.as_ref().is_some_and(|stop| stop.kind == StopKind::Interrupted) {
            let is_solved = |t: &&f64| index_of(&curves.times, **t).is_some();
            let solved = model.times.iter().take_while(is_solved).count();
            solution.stop = Some(self.stopped(StopKind::Interrupted, solved));
        }
        self.results(design, &curves, &located, &solution)
    }

    /// Locates the minima and contacts of pairs from a first solution of the motion of a design on. Also returns the
    /// reason why the first one ended early, if it did.
    fn locate_events(
        &self,
        design: &[f64],
        first: Solution,
        curves: &mut Curves<'_>,
    ) -> (Located, Option<Stop>) {
        let first_stop = first.stop.clone();
        let mut end = first_stop.as_ref().and_then(|stop| stop.last_time);
        let mut follows_all = self.model().equilibrium.is_some();
        let mut plateaus = Vec::new();
        let mut motion = first.motion;
        let mut passes = 0;
        loop {
            passes += 1;
            let was_same: Vec<bool> = (0..curves.pairs.len()).map(|p| curves.is_same(p)).collect();
            curves.add(self, design, &motion);
            plateaus.resize_with(curves.pairs.len(), Vec::new);
            // Later times are denser beside minima, where equal distances are those on both sides.
            let first_seen = was_same.iter().zip(&mut plateaus).enumerate().filter(|(_, (same, _))| **same);
            first_seen.for_each(|(p, (_, plateaus))| *plateaus = curves.plateaus(p));
            let is_last = self.is_ended() || passes == MOST_PASSES;
            let mut located = curves.locate(&plateaus, &curves.overlaps(), is_last);
            // A motion that ends early is followed up to its end.
            let end = end.take().filter(|end| curves.times.last().is_some_and(|last| last < end));
            located.add.extend(end);
            if located.add.is_empty() || is_last {
                return (located, first_stop);
            }
            // Further times are solved by themselves from the first one on; beside all others only at equilibria, which
            // follow the times, and after a motion that did not get there.
            let followed = if follows_all { curves.times.len() } else { 1 };
            let mut times: Vec<f64> =
                curves.times.iter().take(followed).chain(&located.add).copied().collect();
            sort_times(&mut times);
            motion = self.motion_at(&times, design, false).motion;
            follows_all |= motion.len() < times.len();
        }
    }

    /// Locates the minima of clearances whose least value is a metric, from a solution of a design on, unless its
    /// distances and rates show all of them. Returns these measures with the times of their minima, and with times
    /// between which their bodies do not turn far.
    pub(super) fn locate_minima(&self, design: &[f64], solution: &Solution) -> (Vec<OutputSource>, Vec<f64>) {
        let model = self.model();
        let posed = PosedMotion::of(self, design, &solution.motion);
        let (mut measures, mut pairs, mut times) = (Vec::new(), Vec::new(), Vec::new());
        for metric in &model.metrics {
            let Some(of) = clearance_of(model, metric.of).filter(|_| is_locatable(metric)) else { continue };
            if measures.contains(&metric.of) {
                continue;
            }
            let own = || model.clearances[of.0].pairs.iter().map(|pair| pair.shapes);
            let turns: Vec<f64> = own().flat_map(|shapes| posed.turning_times(shapes)).collect();
            // Where cores meet, the distance may have no rates, or minima at which they jump.
            let is_hidden = |shapes: [ShapeId; 2]| {
                has_surface(model, shapes) || reaches(metric, solution, -posed.round(shapes))
            };
            if model.equilibrium.is_some() || !turns.is_empty() || own().any(is_hidden) {
                measures.push(metric.of);
                times.extend(turns);
                pairs.extend(own());
            }
        }
        if pairs.is_empty() {
            return (measures, times);
        }
        let mut curves = Curves::new(model, &pairs);
        let first = Solution { motion: solution.motion.clone(), ..Solution::default() };
        let (located, _) = self.locate_events(design, first, &mut curves);
        let minima = || located.events.iter().filter(|event| matches!(event.kind, EventKind::Minimum(_)));
        times.extend(minima().map(|event| event.time));
        sort_times(&mut times);
        let known = &solution.motion.times;
        let same = SAME_TIME * known.last().zip(known.first()).map_or(0.0, |(last, first)| last - first);
        times.dedup_by(|a, b| *a - *b <= same);
        times.retain(|t| !known.iter().any(|other| (t - other).abs() <= same));
        // The derivative at a kink is that of both of its sides.
        times.extend(minima().filter_map(|event| Some([event.time, event.kink?])).flatten());
        (measures, times)
    }

    /// Times between those of a solution at which clearances of surfaces have a greatest or least value that its times
    /// do not show, since other parts of them pass each other: for metrics other than the least values that
    /// [`locate_minima`](Self::locate_minima) locates. Of an expression over clearances they are those of the
    /// clearances themselves.
    pub(super) fn hidden_extrema(&self, design: &[f64], solution: &Solution) -> Vec<f64> {
        let model = self.model();
        let mut found = Vec::new();
        for metric in &model.metrics {
            let direct = clearance_of(model, metric.of);
            let signs: &[f64] = match metric.take.extrema() {
                [] => continue,
                [-1.0] if direct.is_some() && is_locatable(metric) => continue,
                signs if direct.is_some() => signs,
                _ => &[1.0, -1.0],
            };
            let window = metric.window.filter(|_| metric.over.is_none());
            for clearance in clearances_of(model, metric.of) {
                let pairs: Vec<_> = model.clearances[clearance.0].pairs.iter().map(|p| p.shapes).collect();
                if pairs.iter().any(|shapes| has_surface(model, *shapes)) {
                    let mut curves = Curves::new(model, &pairs);
                    curves.add(self, design, &solution.motion);
                    for sign in signs {
                        found.extend(self.hidden_extremum(design, solution, &mut curves, *sign, window));
                    }
                }
            }
        }
        sort_times(&mut found);
        found
    }

    /// Times about the greatest (sign 1) or least (-1) value of the least distance of all pairs within a window, if it
    /// is beyond those at the times of a solution. The curves have these times, and are given further ones.
    fn hidden_extremum(
        &self,
        design: &[f64],
        solution: &Solution,
        curves: &mut Curves<'_>,
        sign: f64,
        window: Option<[f64; 2]>,
    ) -> Vec<f64> {
        let known = &solution.motion.times;
        for _ in 0..MOST_PASSES {
            let add = curves.hidden(sign, window);
            if add.is_empty() || self.is_ended() {
                break;
            }
            let mut times: Vec<f64> = curves.times.iter().take(1).chain(&add).copied().collect();
            sort_times(&mut times);
            curves.add(self, design, &self.motion_at(&times, design, false).motion);
        }
        // All times of the interval of the solution that has it.
        let Some(extremum) = curves.extremum(sign, window) else { return Vec::new() };
        let time = curves.times[extremum];
        let after = known.partition_point(|t| *t <= time);
        let [from, to] = [known[after.saturating_sub(1)], known[usize::min(after, known.len() - 1)]];
        curves.times.iter().copied().filter(|t| from < *t && *t < to).collect()
    }

    fn motion_at(&self, times: &[f64], design: &[f64], sensitivities: bool) -> Solution {
        let run = Run::new().at(design).without_measures();
        let run = if sensitivities { run } else { run.without_sensitivities() };
        self.at_times(times.to_vec()).solve(run)
    }

    /// Results at the located times, of a motion that is solved at them.
    fn results(
        &self,
        design: &[f64],
        curves: &Curves<'_>,
        located: &Located,
        solution: &Solution,
    ) -> Clearances {
        let of_stop =
            solution.stop.as_ref().map(|stop| (stop.last_time.unwrap_or(stop.failed_time), stop.kind));
        let ends = curves.times.first().zip(curves.times.last());
        let end =
            ends.and_then(|(first, last)| MovingEnd::of(self.model(), solution, [*first, *last], of_stop));
        let is_output = |time: f64| index_of(&self.model().times, time).is_some();
        let pair_of = |(p, shapes): (usize, &[ShapeId; 2])| {
            let samples = &curves.samples[p];
            let fastest = samples.iter().map(|s| s.distance[1].abs()).fold(0.0, f64::max);
            let derivatives = |time: f64| match index_of(&solution.motion.times, time) {
                Some(k) => Some(self.distance_derivatives(design, *shapes, solution, k)),
                None => self.is_ended().then(|| vec![f64::NAN; self.model().variables.len()]),
            };
            let at = |time: f64| Some(samples[index_of(&curves.times, time)?]);
            let (mut minima, mut contacts) = (Vec::new(), Vec::new());
            for event in located.events.iter().filter(|e| e.pair == p) {
                let (Some(at_event), Some(mut d)) = (at(event.time), derivatives(event.time)) else {
                    continue;
                };
                // At a kink both sides change, and their intersection moves in time: the part of each is that with
                // which the rate is zero.
                let other = event.kink.and_then(|time| at(time).zip(derivatives(time)));
                if let Some((other, beside)) = &other {
                    let rates = [at_event.distance[1], other.distance[1]];
                    let part = rates[1] / (rates[1] - rates[0]);
                    d.iter_mut().zip(beside).for_each(|(d, other)| *d = part * *d + (1.0 - part) * other);
                }
                match event.kind {
                    EventKind::Minimum(place) => {
                        if let Some(end) = end.as_ref().filter(|_| place == MinimumPlace::End) {
                            end.follow(at_event.distance[1], &mut d);
                        }
                        if at_event.cores_meet {
                            // The nearest points coincide: no direction leads from one to the other.
                            d.fill(f64::NAN);
                        }
                        minima.push(ClearanceMinimum { at: at_event, place, is_kink: other.is_some(), d });
                    }
                    EventKind::Contact(begins) => {
                        let rate = at_event.distance[1];
                        let rate = if rate.abs() > GRAZING * fastest { rate } else { f64::NAN };
                        // dt/db = -d_b / d.                                                              (C13)
                        let d = d.iter().map(|d| -d / rate).collect();
                        contacts.push(Contact { at: at_event, begins, d });
                    }
                }
            }
            sort_by_number(&mut minima, |found| found.at.time);
            PairClearance {
                shapes: *shapes,
                curve: samples.iter().filter(|s| is_output(s.time)).copied().collect(),
                minima,
                contacts,
                is_constant: located.constant[p],
                end: curves.times.last().copied().unwrap_or(f64::NAN),
            }
        };
        let pairs = curves.pairs.iter().enumerate().map(pair_of).collect();
        Clearances { pairs, stop: solution.stop.clone() }
    }

    /// Distances of pairs of shapes at these times of a solved motion of a design, in the order of the pairs.
    pub fn distances(
        &self,
        design: &[f64],
        motion: &Motion,
        pairs: &[[ShapeId; 2]],
        steps: impl Iterator<Item = usize>,
    ) -> Vec<Vec<ShapeDistance>> {
        PosedMotion::of(self, design, motion).distances(pairs, steps)
    }

    /// Derivatives of a distance at time k of a solved motion by all design variables; NaN for those that are not
    /// admissible.
    pub fn distance_derivatives(
        &self,
        design: &[f64],
        shapes: [ShapeId; 2],
        solution: &Solution,
        k: usize,
    ) -> Vec<f64> {
        let (model, map) = (self.model(), self.design_map());
        let values = model.whole(design);
        let states = solution.motion.at(k);
        let mut carriers = ChangingBodies::of(model);
        (0..model.variables.len())
            .map(|b| {
                let Some(d) =
                    solution.sensitivities.at(k, b).filter(|_| b < solution.sensitivities.variables)
                else {
                    return f64::NAN;
                };
                let mut duals: Vec<Dual> = values.iter().map(|v| Dual::constant(*v)).collect();
                duals[b] = Dual::variable(values[b]);
                let fixed = map.fixed(&duals).map(|x| Dual { v: Jet::constant(x.v), d: Jet::constant(x.d) });
                carriers.set(states, d);
                let placed = PlacedShapes { model, fixed: &fixed, bodies: &carriers };
                let near = placed.nearest(shapes);
                let distance: Dual<Rates> = placed.distance(shapes, &near);
                distance.d.0[0]
            })
            .collect()
    }
}

/// Per output time and clearance of a motion of the nominal design, time by time: true where other features of the
/// nearest shapes are as deep in each other, or their cores meet. The distance has no derivatives there, unless the
/// shapes do not move relative to each other.
pub fn tied_clearances(model: &Model, motion: &Motion) -> Vec<bool> {
    of_nearest(model, motion, |placed, shapes, near| {
        near.is_tied || placed.is_without_direction(shapes, near)
    })
}

/// The same: true where the nearest shapes are parallel and do not stay so. The rate of the distance jumps there from
/// that of one end of their common stretch to that of the other.
pub fn jumping_clearances(model: &Model, motion: &Motion) -> Vec<bool> {
    let at_rest = model.equilibrium.is_some();
    of_nearest(model, motion, |placed, shapes, near| {
        let rate = |near: &Nearest| placed.distance(shapes, near).0[1];
        let differs = |k: usize| {
            let Feature::Point(at) = near.features[k] else { return false };
            let mut other = *near;
            other.features[k] = Feature::Point(0.5 * at);
            let [here, there] = [rate(near), rate(&other)];
            (here - there).abs() > JUMP * here.abs().max(there.abs())
        };
        near.is_parallel && !at_rest && (differs(0) || differs(1))
    })
}

/// A property of the nearest shapes of each clearance over the motion of the nominal design, time by time.
fn of_nearest(
    model: &Model,
    motion: &Motion,
    is: impl Fn(&PlacedShapes<'_, Rates, MovingBodies>, [ShapeId; 2], &Nearest) -> bool,
) -> Vec<bool> {
    let fixed = DesignMap::of(model).fixed(&model.whole(&[])).map(Jet::constant);
    let mut found = Vec::new();
    PosedMotion { model, motion, fixed }.each(0..motion.len(), |_, placed| {
        let of = |c: usize| {
            let (n, near) = placed.nearest_pair(ClearanceId(c))?;
            Some(is(&placed, model.clearances[c].pairs[n].shapes, &near))
        };
        found.extend((0..model.clearances.len()).map(|c| of(c) == Some(true)));
    });
    found
}

/// True if a metric of a clearance is its least value over the whole motion.
fn is_locatable(metric: &Metric) -> bool {
    metric.take == Reduction::Least && metric.window.is_none()
}

fn sort_times(times: &mut Vec<f64>) {
    times.sort_by(f64::total_cmp);
    times.dedup();
}

/// Index of a time among sorted ones.
fn index_of(times: &[f64], time: f64) -> Option<usize> {
    times.binary_search_by(|t| t.total_cmp(&time)).ok()
}
