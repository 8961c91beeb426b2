//! Clearances over a motion: curves of all pairs of shapes, their minima and contacts, located exactly.
//!
//! Times are found on motions that are solved anew at them, never on polynomials between output times: a distance may
//! change its features there, where its acceleration jumps.

use crate::clearance::{ChangingBodies, MovingBodies, PlacedShapes};
use crate::design::{BodyFixed, DesignMap, ShapeGeometry};
use crate::measure::{clearance_of, clearances_of};
use crate::model::{
    BodyId, Clearance, ClearanceId, Metric, Model, OutputSource, PointId, Reduction, Shape, ShapeId,
    ShapeKind, ShapePair,
};
use crate::motion::{BodyState, Motion, Stop, StopKind};
use crate::number::{Dual, Jet, Rates};
use crate::space::Vec3;

use super::curve::SampledCurve;
use super::joint_limits::MovingEnd;
use super::metric::reaches;
use super::{Analysis, Run, Solution};

/// A minimum or contact is located if a step of Newton's method is below this fraction of the motion: positions are
/// solved to 1e-12 of the mechanism's size.
const LOCATED: f64 = 1e-11;
/// Candidates nearer to a located time than this fraction of the motion are the same one.
const SAME_TIME: f64 = 1e-8;
/// Maximum number of times that the motion is solved again; each pass is nearer to the times by several digits, or
/// divides an interval in which features change. A contact that is found late takes the same number of passes as any
/// other.
const MOST_PASSES: usize = 100;
/// Rate of a distance below which a contact is grazing, as a fraction of the largest rate: its time has no derivative.
const GRAZING: f64 = 1e-6;
/// Pieces into which an interval is divided where its ends do not indicate a place within.
const PIECES: usize = 4;

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
            minima.sort_by(|a, b| a.at.time.total_cmp(&b.at.time));
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
    let fixed = DesignMap::of(model).fixed(&model.whole(&[])).map(Jet::constant);
    let mut tied = Vec::new();
    PosedMotion { model, motion, fixed }.each(0..motion.len(), |_, placed| {
        let is_tied = |c: usize| {
            let nearest = placed.nearest_pair(ClearanceId(c));
            let shapes = |n: usize| model.clearances[c].pairs[n].shapes;
            nearest.is_some_and(|(n, near)| near.is_tied || placed.is_without_direction(shapes(n), &near))
        };
        tied.extend((0..model.clearances.len()).map(is_tied));
    });
    tied
}

/// Shapes of a design over its motion.
struct PosedMotion<'m> {
    model: &'m Model,
    motion: &'m Motion,
    fixed: BodyFixed<Rates>,
}

impl<'m> PosedMotion<'m> {
    fn of(analysis: &'m Analysis<'_>, design: &[f64], motion: &'m Motion) -> Self {
        let model = analysis.model();
        let fixed = analysis.design_map().fixed(&model.whole(design)).map(Jet::constant);
        Self { model, motion, fixed }
    }

    /// Calls `visit` with the shapes at each of these times.
    fn each(
        &self,
        steps: impl Iterator<Item = usize>,
        mut visit: impl FnMut(usize, PlacedShapes<'_, Rates, MovingBodies>),
    ) {
        let mut bodies = MovingBodies::of(self.model);
        for k in steps {
            bodies.set(self.motion.at(k));
            visit(k, PlacedShapes { model: self.model, fixed: &self.fixed, bodies: &bodies });
        }
    }

    /// Distances of pairs at these times.
    fn distances(
        &self,
        pairs: &[[ShapeId; 2]],
        steps: impl Iterator<Item = usize>,
    ) -> Vec<Vec<ShapeDistance>> {
        let mut samples: Vec<Vec<ShapeDistance>> = vec![Vec::new(); pairs.len()];
        self.each(steps, |k, placed| {
            for (p, shapes) in pairs.iter().enumerate() {
                let near = placed.nearest(*shapes);
                let Jet([value, rate, acceleration]) = placed.distance(*shapes, &near);
                // An equilibrium is at rest at each time, so that nothing has a rate.
                let at_rest = self.model.equilibrium.is_some();
                let rates = if at_rest { [f64::NAN; 2] } else { [rate, acceleration] };
                samples[p].push(ShapeDistance {
                    time: self.motion.times[k],
                    distance: [value, rates[0], rates[1]],
                    points: near.points,
                    is_parallel: near.is_parallel,
                    cores_meet: near.cores_meet(CONSTANT * self.model.size()),
                });
            }
        });
        samples
    }

    /// Relative motion of two shapes at time k; `None` for other than surfaces, since the distance of two convex cores
    /// has one pair of features at a time, and its rate is continuous.
    fn reach(&self, shapes: [ShapeId; 2], k: usize) -> Option<Reach> {
        let Self { model, motion, fixed } = self;
        if !has_surface(model, shapes) {
            return None;
        }
        let carried = |s: ShapeId| {
            let bodies = model.shapes[s.0].bodies(model);
            bodies.into_iter().map(|body| motion.at(k).body(body.0)).collect::<Vec<BodyState>>()
        };
        let mut bodies = MovingBodies::of(model);
        bodies.set(motion.at(k));
        let placed = PlacedShapes { model, fixed, bodies: &bodies };
        let balls = shapes.map(|s| placed.ball(s));
        let (centre, radius) = if balls[0].1 <= balls[1].1 { balls[0] } else { balls[1] };
        let at = |body: &BodyState, p: Vec3| body.v + body.omega.cross(p - body.r);
        let [first, second] = shapes.map(carried);
        let speed = match (&first[..], &second[..]) {
            ([first], [second]) => {
                let turning = (second.omega - first.omega).norm();
                (at(second, centre) - at(first, centre)).norm() + turning * radius
            }
            ([rigid], _) | (_, [rigid]) => {
                // A rod between two bodies: each of its points goes with the same fractions of its ends.
                let between = if first.len() == 1 { shapes[1] } else { shapes[0] };
                let (ShapeKind::Capsule { ends } | ShapeKind::Cylinder { ends, .. }) =
                    &model.shapes[between.0].kind
                else {
                    return None;
                };
                let [p, q] = ends.map(|p| {
                    let body = motion.at(k).body(model.points[p.0].body.0);
                    let place = body.r + body.rotation * fixed.points[p.0].value();
                    (place, at(&body, place) - at(rigid, place))
                });
                // Rims of a cylinder turn with its axis.
                let turning = (q.1 - p.1).norm() / (q.0 - p.0).norm();
                let rim = fixed.shapes[between.0].size.value().abs();
                p.1.norm().max(q.1.norm()) + if rim > 0.0 { turning * rim } else { 0.0 }
            }
            (_, _) => return None,
        };
        Some(Reach { speed, radius })
    }

    /// Times between those of the motion, between which the bodies of two shapes do not turn far.
    fn turning_times(&self, shapes: [ShapeId; 2]) -> Vec<f64> {
        let bodies = self.carriers(shapes);
        let longest = self.motion.times.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        // Relative to the first one each turns by no more than both.
        let fastest = |body: &BodyId| self.motion.fastest(*body);
        let relative = bodies.first().map_or(0.0, |first| {
            bodies[1..].iter().map(|other| fastest(other) + fastest(first)).sum::<f64>()
        });
        if longest * relative <= FAR {
            return Vec::new();
        }
        let speeds: Vec<f64> = (0..self.motion.len()).map(|k| self.turning(&bodies, k)).collect();
        turning_times(&self.motion.times, &speeds)
    }

    /// Sum of the radii around the cores of two shapes, m.
    fn round(&self, shapes: [ShapeId; 2]) -> f64 {
        shapes.iter().map(|s| self.fixed.shapes[s.0].round.value()).sum()
    }

    /// Bodies that carry two shapes.
    fn carriers(&self, [a, b]: [ShapeId; 2]) -> Vec<BodyId> {
        let of = |s: ShapeId| self.model.shapes[s.0].bodies(self.model);
        of(a).into_iter().chain(of(b)).collect()
    }

    /// Angular speed of bodies relative to each other at time k, rad/s.
    fn turning(&self, bodies: &[BodyId], k: usize) -> f64 {
        let Some((first, others)) = bodies.split_first() else { return 0.0 };
        let states = self.motion.at(k);
        let spin = |body: &BodyId| states.omega(body.0);
        let first = spin(first);
        // Of two others at most the sum.
        others.iter().map(|other| (spin(other) - first).norm()).sum()
    }
}

/// True if a metric of a clearance is its least value over the whole motion.
fn is_locatable(metric: &Metric) -> bool {
    metric.take == Reduction::Least && metric.window.is_none()
}

/// True if one of two shapes is a surface or a ring, which may have several parts that are near the other shape.
fn has_surface(model: &Model, shapes: [ShapeId; 2]) -> bool {
    let is_concave =
        |s: ShapeId| matches!(model.shapes[s.0].kind, ShapeKind::Mesh { .. } | ShapeKind::Ring { .. });
    shapes.into_iter().any(is_concave)
}

/// Distances of all pairs at the times of a motion that were solved so far.
struct Curves<'m> {
    pairs: &'m [[ShapeId; 2]],
    /// Size of the mechanism, m.
    size: f64,
    /// True at an equilibrium, where nothing has a rate.
    at_rest: bool,
    times: Vec<f64>,
    /// Per pair and time.
    samples: Vec<Vec<ShapeDistance>>,
    /// The same; `None` for pairs whose distance has a continuous rate.
    reaches: Vec<Vec<Option<Reach>>>,
    /// The same: angular speed of the bodies relative to each other, rad/s.
    turning: Vec<Vec<f64>>,
}

/// Motion of two surfaces relative to each other at one time.
#[derive(Clone, Copy)]
struct Reach {
    /// Greatest rate of the distance between any of their points, m/s.
    speed: f64,
    /// Radius of the smaller ball around one of them, m.
    radius: f64,
}

impl<'m> Curves<'m> {
    fn new(model: &'m Model, pairs: &'m [[ShapeId; 2]]) -> Self {
        Self {
            pairs,
            size: model.size(),
            at_rest: model.equilibrium.is_some(),
            times: Vec::new(),
            samples: vec![Vec::new(); pairs.len()],
            reaches: vec![Vec::new(); pairs.len()],
            turning: vec![Vec::new(); pairs.len()],
        }
    }

    /// Adds the times of a motion of the design that are not known yet.
    fn add(&mut self, analysis: &Analysis<'_>, design: &[f64], motion: &Motion) {
        let new: Vec<usize> =
            (0..motion.len()).filter(|k| index_of(&self.times, motion.times[*k]).is_none()).collect();
        let posed = PosedMotion::of(analysis, design, motion);
        let mut known = 0;
        let until_ended = new.iter().take_while(|_| !analysis.is_ended()).inspect(|_| known += 1);
        let found = posed.distances(self.pairs, until_ended.copied());
        let carriers: Vec<Vec<BodyId>> = self.pairs.iter().map(|shapes| posed.carriers(*shapes)).collect();
        for (n, k) in new.into_iter().take(known).enumerate() {
            let time = motion.times[k];
            let place = self.times.partition_point(|t| *t < time);
            self.times.insert(place, time);
            for (p, shapes) in self.pairs.iter().enumerate() {
                self.samples[p].insert(place, found[p][n]);
                self.reaches[p].insert(place, posed.reach(*shapes, k));
                self.turning[p].insert(place, posed.turning(&carriers[p], k));
            }
        }
    }

    /// Times within intervals in which the bodies of a pair turn far relative to each other, however little the drivers
    /// move there: a screw turns many times over a short way, and a gear faster than its driver.
    fn turning(&self, p: usize) -> Vec<f64> {
        turning_times(&self.times, &self.turning[p])
    }

    /// Times within intervals in which a pair may be nearer than at any time so far, or touch unseen, since other parts
    /// of its shapes may pass each other there.
    fn unseen(&self, p: usize, is_left_out: &dyn Fn(usize) -> bool) -> Vec<f64> {
        let (times, samples, reaches) = (&self.times, &self.samples[p], &self.reaches[p]);
        let Some(last) = samples.len().checked_sub(1) else { return Vec::new() };
        let span = times[last] - times[0];
        let least = samples.iter().map(|s| s.distance[0]).fold(f64::INFINITY, f64::min).max(0.0);
        let mut add = Vec::new();
        for k in 0..last {
            let (Some(before), Some(after)) = (reaches[k], reaches[k + 1]) else { continue };
            let (speed, radius) = (SPEEDS * before.speed.max(after.speed), after.radius);
            let h = times[k + 1] - times[k];
            let [from, to] = [samples[k].distance, samples[k + 1].distance];
            // The distance changes by no more than the shapes move.
            let at_least = 0.5 * (from[0] + to[0] - speed * h);
            if h <= NARROW * span || at_least >= least || !(from[0] > 0.0 && to[0] > 0.0) || is_left_out(k) {
                continue;
            }
            let error = cubic_error([from, to], h);
            if speed * h > PASSING * radius || !(error <= SMOOTH * speed * h) {
                add.extend(pieces(times[k], times[k + 1]));
            }
        }
        add
    }

    /// Index of the time at which the least distance of all pairs is greatest (sign 1) or least (-1) in a window.
    fn extremum(&self, sign: f64, window: Option<[f64; 2]>) -> Option<usize> {
        let inside = |k: &usize| window.is_none_or(|[from, to]| (from..=to).contains(&self.times[*k]));
        let value = |k: usize| sign * self.least(k)[0];
        let known = (0..self.times.len()).filter(inside).filter(|k| value(*k).is_finite());
        known.reduce(|a, b| if value(b) > value(a) { b } else { a })
    }

    /// The least distance of all pairs at time k.
    fn least(&self, k: usize) -> [f64; 3] {
        let distances = self.samples.iter().map(|samples| samples[k].distance);
        distances.reduce(|a, b| if b[0] < a[0] { b } else { a }).unwrap_or([f64::NAN; 3])
    }

    /// Times within intervals in which the least distance of all pairs may be greater (sign 1) or less (-1) than at any
    /// time so far in a window, since other parts of surfaces may pass each other there.
    fn hidden(&self, sign: f64, window: Option<[f64; 2]>) -> Vec<f64> {
        let (times, Some(extremum)) = (&self.times, self.extremum(sign, window)) else { return Vec::new() };
        let most = sign * self.least(extremum)[0];
        let span = times[times.len() - 1] - times[0];
        let is_hidden = |k: &usize| {
            let k = *k;
            let h = times[k + 1] - times[k];
            let is_outside = window.is_some_and(|[from, to]| times[k + 1] < from || to < times[k]);
            if h <= NARROW * span || is_outside {
                return false;
            }
            let reach =
                |p: usize| Some((self.samples[p].as_slice(), self.reaches[p][k]?, self.reaches[p][k + 1]?));
            // The distance of each pair changes by no more than its shapes move; the least is none of those above.
            let bounds = (0..self.pairs.len()).filter_map(reach).map(|(samples, before, after)| {
                let way = SPEEDS * h * before.speed.max(after.speed);
                let ends = samples[k].distance[0] + samples[k + 1].distance[0];
                (0.5 * (ends + sign * way), way, after.radius)
            });
            let Some((bound, way, radius)) = bounds.reduce(|a, b| if b.0 < a.0 { b } else { a }) else {
                return false;
            };
            let error = cubic_error([self.least(k), self.least(k + 1)], h);
            sign * bound > most && (way > PASSING * radius || !(error <= SMOOTH * way))
        };
        let hidden = (0..times.len() - 1).filter(is_hidden);
        hidden.flat_map(|k| pieces(times[k], times[k + 1])).collect()
    }

    /// Parts of the motion in which the distance of a pair does not change: of a rod through a plate for example, which
    /// is equally deep all the time. Rates there are those of either way out, and indicate nothing.
    fn plateaus(&self, p: usize) -> Vec<Plateau> {
        let samples = &self.samples[p];
        // Two equal distances may be those on both sides of a minimum, unless their rates are zero.
        let is_still = |k: &usize| samples[*k].distance[1..] == [0.0; 2];
        let is_long = |run: &[usize]| run.len() > 2 || run.len() == 2 && run.iter().all(is_still);
        let is_deep = |run: &[usize]| run.iter().any(|k| samples[*k].is_deep());
        let steps: Vec<usize> = (0..samples.len()).collect();
        let runs = self.equal(samples, &steps).filter(|run| is_long(run) && !is_deep(run));
        runs.map(|run| self.plateau(samples, run, None)).collect()
    }

    /// True if a pair has the same distance at all times so far.
    fn is_same(&self, p: usize) -> bool {
        let known = || self.samples[p].iter().map(|s| s.distance[0]);
        let [low, high] = [known().fold(f64::INFINITY, f64::min), known().fold(f64::NEG_INFINITY, f64::max)];
        high - low <= CONSTANT * self.size
    }

    /// Parts of the motion in which shapes overlap at a depth that is not known, by pair, as far as they are known: a
    /// short one may be seen at one time only.
    fn overlaps(&self) -> Vec<Vec<Plateau>> {
        let of_pair = |samples: &Vec<ShapeDistance>| {
            // Beside the time of contact there may be times at which the same distance is one of shapes that touch.
            let steps: Vec<usize> = (0..samples.len()).collect();
            let runs = self.equal(samples, &steps);
            let deep = |run: &[usize]| run.iter().copied().find(|k| samples[*k].is_deep());
            runs.filter_map(|run| Some(self.plateau(samples, run, Some(deep(run)?)))).collect()
        };
        self.samples.iter().map(of_pair).collect()
    }

    /// Runs of consecutive samples with the same distance.
    fn equal<'s>(
        &self,
        samples: &'s [ShapeDistance],
        steps: &'s [usize],
    ) -> impl Iterator<Item = &'s [usize]> {
        let flat = FLAT * self.size;
        steps.chunk_by(move |a, b| (samples[*a].distance[0] - samples[*b].distance[0]).abs() <= flat)
    }

    /// The part of the motion of a run of samples; `deep` is one that overlaps at a depth that is not known.
    fn plateau(&self, samples: &[ShapeDistance], run: &[usize], deep: Option<usize>) -> Plateau {
        let times = &self.times;
        let (first, last) = (run[0], run[run.len() - 1]);
        let around = [first.saturating_sub(1), (last + 1).min(samples.len() - 1)];
        let value = samples[first].distance[0];
        let is_higher = |k: &usize| samples[*k].distance[0] >= value - FLAT * self.size;
        let is_lowest = deep.is_some() || around.iter().all(is_higher);
        let is_inside = 0 < first && last + 1 < samples.len();
        let within = around.map(|k| times[k]);
        Plateau { within, from: times[deep.unwrap_or(first)], value, is_lowest, is_inside }
    }

    /// The minima and contacts that are located, and the times at which the motion must be solved for the others. After
    /// the last pass (`is_last`), contacts are at the nearest times that were solved.
    fn locate(&self, plateaus: &[Vec<Plateau>], overlaps: &[Vec<Plateau>], is_last: bool) -> Located {
        let mut located = Located { constant: vec![false; plateaus.len()], ..Located::default() };
        for (p, (plateaus, overlaps)) in plateaus.iter().zip(overlaps).enumerate() {
            self.locate_pair(p, &[&plateaus[..], overlaps].concat(), is_last, &mut located);
        }
        located
    }

    fn locate_pair(&self, p: usize, plateaus: &[Plateau], is_last: bool, located: &mut Located) {
        let (times, samples) = (&self.times, &self.samples[p]);
        let Some(last) = samples.len().checked_sub(1) else { return };
        let span = times[last] - times[0];
        let value = |k: usize| samples[k].distance[0];
        // A distance that is not known has no place in any order: no times are added to look for its minimum.
        let known = (0..=last).filter(|k| value(*k).is_finite());
        let Some(lowest) = known.reduce(|a, b| if value(b) < value(a) { b } else { a }) else { return };
        let mut events: Vec<Event> = Vec::new();
        let mut event = |time: f64, kind: EventKind| events.push(Event { pair: p, time, kink: None, kind });
        let is_known = |k: usize| samples[k].distance[1].is_finite();
        // Per interval: both of its ends have rates.
        let has_rates = |k: usize| is_known(k) && is_known(k + 1);
        let mut add = self.turning(p);
        add.extend(self.unseen(p, &|k| !has_rates(k)));
        if self.is_same(p) {
            located.constant[p] = true;
            event(times[0], EventKind::Minimum(MinimumPlace::Start));
            located.events.extend(events);
            located.add.extend(add);
            return;
        }
        let level = |k: usize| {
            let same = |x: f64, plateau: &Plateau| (x - plateau.value).abs() <= FLAT * self.size;
            plateaus.iter().find(|plateau| {
                plateau.within[0] <= times[k]
                    && times[k + 1] <= plateau.within[1]
                    && same(value(k), plateau)
                    && same(value(k + 1), plateau)
            })
        };
        let is_level = |k: usize| level(k).is_some();
        // Ends.
        let is_lowest = |k: usize, or: bool| level(k).map_or(or, |plateau| plateau.is_lowest);
        // Where there is no rate, or it is zero, the next distance decides.
        let leads_down = |end: usize, next: usize, sense: f64| {
            let rate = sense * samples[end].distance[1];
            if rate.is_finite() && rate != 0.0 { rate < 0.0 } else { value(next) < value(end) }
        };
        if last > 0 && value(0).is_finite() && is_lowest(0, !leads_down(0, 1, 1.0)) {
            event(times[0], EventKind::Minimum(MinimumPlace::Start));
        }
        if last > 0 && value(last).is_finite() && is_lowest(last - 1, !leads_down(last, last - 1, -1.0)) {
            event(times[last], EventKind::Minimum(MinimumPlace::End));
        }
        for plateau in plateaus.iter().filter(|plateau| plateau.is_lowest && plateau.is_inside) {
            event(plateau.from, EventKind::Minimum(MinimumPlace::Inside));
        }
        let curve = SampledCurve {
            times,
            orders: 3,
            // Those where features change are located.
            kinks: &[],
            is_located: false,
            values: samples.iter().map(|s| s.distance).collect(),
        };
        // Per time: the step of Newton's method to the nearest stationary time.
        let is_minimum = |k: usize| {
            let [_, rate, acceleration] = samples[k].distance;
            // Where the distance does not change over a part of the motion, the sign of both is that of round-off.
            let is_curved = acceleration * span * span > FLAT * self.size;
            let is_beside_level = is_level(k - 1) || is_level(k);
            is_curved && !is_beside_level && rate.abs() <= LOCATED * span * acceleration
        };
        let (mut found, mut kinks): (Vec<f64>, Vec<[f64; 2]>) = (Vec::new(), Vec::new());
        for k in (1..last).filter(|k| is_minimum(*k)) {
            if found.last().is_none_or(|t| times[k] - t > SAME_TIME * span) {
                found.push(times[k]);
            }
        }
        for k in (0..last).filter(|k| has_rates(*k) && !is_level(*k)) {
            let [from, to] = [k, k + 1].map(|k| samples[k].distance[1]);
            let changes = from < 0.0 && to > 0.0;
            let at = |t: f64| curve.at(k, t)[0];
            let inner = curve.turns(k).into_iter().filter(|t| {
                let h = SAME_TIME * span;
                at(t - h) >= at(*t) && at(t + h) >= at(*t)
            });
            let mut candidates: Vec<f64> = inner.collect();
            if changes && candidates.is_empty() {
                candidates.push(0.5 * (times[k] + times[k + 1]));
            }
            for t in candidates {
                let is_found = found.iter().any(|f| (f - t).abs() <= SAME_TIME * span);
                let narrow = times[k + 1] - times[k] <= LOCATED * span;
                if is_found {
                    continue;
                }
                if narrow {
                    // The rate jumps there: nothing is gained by further times. If it is round-off on both sides, the
                    // distance is constant.
                    if f64::max(from.abs(), to.abs()) * span <= FLAT * self.size {
                        continue;
                    }
                    let [near, far] = if value(k) <= value(k + 1) { [k, k + 1] } else { [k + 1, k] };
                    kinks.push([times[near], times[far]]);
                    continue;
                }
                add.push(t);
                if changes {
                    add.push(0.5 * (times[k] + times[k + 1]));
                }
            }
        }
        found.into_iter().for_each(|t| event(t, EventKind::Minimum(MinimumPlace::Inside)));
        let kind = EventKind::Minimum(MinimumPlace::Inside);
        let of_kink = |[time, other]: [f64; 2]| Event { pair: p, time, kink: Some(other), kind };
        located.events.extend(kinks.into_iter().map(of_kink));
        // By values alone, where a rate is missing.
        if !(0..last).all(has_rates) {
            let steps: Vec<usize> = (0..=last).collect();
            for run in self.equal(samples, &steps) {
                let (first, end) = (run[0], run[run.len() - 1]);
                // A minimum over a part of the motion is that of its plateau.
                if first == 0 || end == last || (first - 1..=end).any(is_level) {
                    continue;
                }
                let (before, after) = (first - 1, end + 1);
                // Rates lead to the minimum unless one is missing on its side of the lowest time.
                let lower = |a: usize, b: usize| if value(b) < value(a) { b } else { a };
                let lowest = (first..=end).reduce(lower).unwrap_or(first);
                let side = if samples[lowest].distance[1] > 0.0 { lowest - 1 } else { lowest };
                if has_rates(side) || is_minimum(lowest) {
                    continue;
                }
                if !(value(before) >= value(first) && value(after) >= value(end)) {
                    continue;
                }
                // Searches for the deepest point leave small dips.
                let is_dip = |beside: &mut dyn Iterator<Item = usize>| {
                    rise_to_lower(beside.map(value), value(first)) <= SEARCHED * self.size
                };
                if !self.at_rest && (is_dip(&mut (0..first).rev()) || is_dip(&mut (after..=last))) {
                    continue;
                }
                let is_narrow = times[after] - times[before] <= LOCATED * span;
                match run.len() {
                    1 if !is_narrow => {
                        add.extend(pieces(times[before], times[first]));
                        add.extend(pieces(times[first], times[after]));
                    }
                    // On both sides of a minimum, or at the ends of a part in which the distance does not change: a
                    // smooth minimum ends like this long before its interval is narrow, one at a kink does not.
                    2 if !is_narrow => add.push(0.5 * (times[first] + times[end])),
                    _ => {
                        let [left, right] = [lowest - 1, lowest + 1].map(|k| times[k]);
                        let is_kink = times[end] - times[first] < OF_KINK * span;
                        if is_kink && right - left > LOCATED * span {
                            add.extend([left, right].map(|t| 0.5 * (t + times[lowest])));
                        } else {
                            event(times[lowest], EventKind::Minimum(MinimumPlace::Inside));
                        }
                    }
                }
            }
        }
        // Contacts: from a time at which the sign changes, Newton's method or the polynomial.
        for k in 0..last {
            let [a, b] = [value(k), value(k + 1)];
            if (a > 0.0) == (b > 0.0) || a.is_nan() || b.is_nan() {
                continue;
            }
            let begins = b <= 0.0;
            // Overlaps of unknown depth have neither a distance nor a rate: only the other side leads to the contact.
            let is_deep = [k, k + 1].map(|k| samples[k].is_deep());
            let other_is_nearer = if is_deep == [false; 2] { a.abs() > b.abs() } else { is_deep[0] };
            let near = k + usize::from(other_is_nearer);
            let [d, rate, _] = samples[near].distance;
            let is_there =
                is_last || d.abs() <= LOCATED * span * rate.abs() || d.abs() <= f64::EPSILON * self.size;
            if is_there || times[k + 1] - times[k] <= LOCATED * span {
                event(times[near], EventKind::Contact(begins));
                continue;
            }
            if is_deep != [false; 2] {
                // Newton's method, to just before the contact.
                let step = -d / rate;
                let t = times[near] + step - 0.5 * LOCATED * span * step.signum();
                add.extend(Some(t).filter(|t| times[k] < *t && *t < times[k + 1]));
                add.extend(pieces(times[k], times[k + 1]));
                continue;
            }
            let polynomial = |t: f64| curve.at(k, t)[0];
            let [mut low, mut high] = [times[k], times[k + 1]];
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if (polynomial(middle) > 0.0) == (a > 0.0) { low = middle } else { high = middle }
            }
            add.push(0.5 * (low + high));
            // Without rates, the line through two distances meets zero on one side of a contact only.
            if times[k + 1] - times[k] > SAME_TIME * span || !has_rates(k) {
                add.push(0.5 * (times[k] + times[k + 1]));
            }
        }
        // A distance may jump to its least value, which then is that of a solved time.
        let found = events.iter().chain(located.events.iter().filter(|event| event.pair == p));
        let minima = found.filter(|event| matches!(event.kind, EventKind::Minimum(_)));
        let at_minimum = |event: &Event| index_of(times, event.time).map_or(f64::INFINITY, value);
        let least = minima.map(at_minimum).fold(f64::INFINITY, f64::min);
        if value(lowest) < least - FLAT * self.size {
            let place = if lowest == 0 {
                MinimumPlace::Start
            } else if lowest == last {
                MinimumPlace::End
            } else {
                MinimumPlace::Inside
            };
            events.push(Event { pair: p, time: times[lowest], kink: None, kind: EventKind::Minimum(place) });
        }
        located.events.extend(events);
        located.add.extend(add);
    }
}

/// Difference of a distance in an interval of this length from the cubic polynomial through distances and rates at its
/// ends.
fn cubic_error([from, to]: [[f64; 3]; 2], h: f64) -> f64 {
    // Accelerations of the polynomial at both ends.
    let rise = 6.0 * (to[0] - from[0]) / h;
    let bends = [(rise - 4.0 * from[1] - 2.0 * to[1]) / h, (4.0 * to[1] + 2.0 * from[1] - rise) / h];
    (bends[0] - from[2]).abs().max((bends[1] - to[2]).abs()) * h * h
}

/// Times within intervals in which a body with these speeds at their ends, rad/s, turns far.
fn turning_times(times: &[f64], speeds: &[f64]) -> Vec<f64> {
    let angle = |k: usize| (times[k + 1] - times[k]) * speeds[k].max(speeds[k + 1]);
    let intervals = 0..times.len().saturating_sub(1);
    let most = FAR.max(intervals.clone().map(angle).sum::<f64>() / MOST_TURNING);
    let far = intervals.filter(|k| angle(*k) > most);
    let within = |k: usize| {
        let parts = (angle(k) / most).ceil();
        let at = move |n: u32| times[k] + (times[k + 1] - times[k]) * f64::from(n) / parts;
        (1..parts as u32).map(at)
    };
    far.flat_map(within).collect()
}

/// Rise of values above a first one until one of them is lower; infinite if none is.
fn rise_to_lower(values: impl Iterator<Item = f64>, from: f64) -> f64 {
    let mut most = from;
    for value in values {
        if value < from {
            return most - from;
        }
        most = most.max(value);
    }
    f64::INFINITY
}

fn sort_times(times: &mut Vec<f64>) {
    times.sort_by(f64::total_cmp);
    times.dedup();
}

/// Index of a time among sorted ones.
fn index_of(times: &[f64], time: f64) -> Option<usize> {
    times.binary_search_by(|t| t.total_cmp(&time)).ok()
}

/// Times that divide an interval into [`PIECES`].
fn pieces(from: f64, to: f64) -> impl Iterator<Item = f64> {
    (1..PIECES).map(move |n| from + (to - from) * n as f64 / PIECES as f64)
}

/// A distance that changes less than this fraction of the mechanism's size over a motion is constant: round-off of
/// solved positions.
const CONSTANT: f64 = 1e-10;
/// Distances that differ by less than this fraction of the mechanism's size are the same: round-off of positions.
const FLAT: f64 = 4e-12;

/// Angle by which two bodies may turn relative to each other between two times, rad: the error of a polynomial of
/// degree five for a sine is `0.5^6 / 46080 = 3e-7`, which hides no minimum.
const FAR: f64 = 0.5;
/// Maximum number of times that are added for bodies that turn far.
const MOST_TURNING: f64 = 20_000.0;
/// Allowance for speeds between two times that are above those at both.
const SPEEDS: f64 = 1.1;
/// Way of two surfaces between two times, as a part of the smaller one, in which no other parts of them pass each other
/// unless the distance has the mark of it.
const PASSING: f64 = 0.05;
/// Difference of a distance from a cubic polynomial, as a part of the way between two times, below which the same
/// features are nearest.
const SMOOTH: f64 = 1e-3;
/// Interval that is not divided further in search of other features, as a fraction of the motion.
const NARROW: f64 = 1e-5;

/// Part of a motion in which the distance of a pair does not change.
#[derive(Clone, Copy)]
struct Plateau {
    /// Times around it, between which it begins and ends.
    within: [f64; 2],
    /// The first time that is known to be in it.
    from: f64,
    /// The distance, m.
    value: f64,
    /// True if the distance is greater on both sides, or the shapes overlap at a depth that is not known.
    is_lowest: bool,
    /// True if it begins and ends within the motion.
    is_inside: bool,
}

/// Interval, as a fraction of the motion, in which a distance with a smooth minimum is the same up to round-off: if it
/// is shorter, the minimum is a kink, and nearer to one side of it.
const OF_KINK: f64 = 3e-8;
/// Rise of a distance without rates between two minima, as a fraction of the mechanism's size, below which the higher
/// one is a dip: searches along both cores find the deepest point of solids in each other to less than this.
const SEARCHED: f64 = 1e-6;

/// Events of a motion, and times at which it must be solved to locate others.
#[derive(Default)]
struct Located {
    events: Vec<Event>,
    add: Vec<f64>,
    /// Per pair: true if its distance does not change.
    constant: Vec<bool>,
}

struct Event {
    pair: usize,
    time: f64,
    /// At a kink, the time on its other side.
    kink: Option<f64>,
    kind: EventKind,
}

#[derive(Clone, Copy)]
enum EventKind {
    Minimum(MinimumPlace),
    /// True if the shapes touch from there on.
    Contact(bool),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_times_are_added_where_the_distance_is_not_known() {
        let pairs = [[ShapeId(0), ShapeId(1)]];
        let at = |k: usize| {
            let x = (k as f64 - 7.0) / 10.0;
            let distance = if (2..5).contains(&k) { [f64::NAN; 3] } else { [1.0 + x * x, 2.0 * x, 2.0] };
            let points = [Vec3::ZERO; 2];
            ShapeDistance { time: k as f64 / 10.0, distance, points, is_parallel: false, cores_meet: false }
        };
        let samples: Vec<ShapeDistance> = (0..11).map(at).collect();
        let curves = Curves {
            pairs: &pairs,
            size: 1.0,
            at_rest: false,
            times: samples.iter().map(|at| at.time).collect(),
            reaches: vec![vec![None; samples.len()]],
            turning: vec![vec![0.0; samples.len()]],
            samples: vec![samples],
        };
        let located = curves.locate(&[curves.plateaus(0)], &curves.overlaps(), false);
        assert_eq!(located.add, Vec::<f64>::new());
        let minima: Vec<f64> = located.events.iter().map(|event| event.time).collect();
        assert_eq!(minima, [0.7]);
    }
}
