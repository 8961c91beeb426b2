//! Proven bounds of the motion of a design, and of its clearances between the output times.
//!
//! The motion is divided at its output times, where rates of laws jump, and where other rows are selected. A part
//! passes if a proven lower bound of the distance over it is not below the claim (`clearance/separation.rs`), else it
//! is halved. The bounds have no slack where the distance falls, rises or is convex over a part: the least distance
//! itself can be proved, but for round-off.

use std::collections::HashMap;
use std::rc::Rc;

use crate::clearance::{
    Core, Direction, EnclosedSolid, Nearest, PlaceOnSegment, PlacedShapes, lower_bound, ring_bound,
    separations,
};
use crate::design::BodyFixed;
use crate::law::TimeJet;
use crate::model::{Model, ShapeId, ShapeKind};
use crate::motion::parts::PlanGeometry;
use crate::motion::stepper::Stepper;
use crate::motion::tube::{Instant, Slab, SolvedPosition};
use crate::motion::{ProvenMotion, Stop, StopKind, TubeFailure, advance};
use crate::number::{self, Interval, Jet, Rates};
use crate::space::{Mat3, Pose, Real, Vec3};

use super::analysis::Analysis;
use super::walk::PreparedDesign;

impl Analysis<'_> {
    /// Motion of a design (variable k at `design[k]`), of which bounds between the output times are proved, and the
    /// reason why it ends before the last one, if it does. `None` with equilibrium: its elastic joints open as the
    /// forces ask for, not by laws.
    ///
    /// ```
    /// # use hardpoint::{Analysis, draft::Draft, law::Law, model::Model};
    /// # let draft = Draft::new("pendulum").hardpoint("O", [0.0; 3]).hardpoint("tip", [2.0, 0.0, 0.0]).bodies(["arm"])
    /// #     .revolute("O", ["ground", "arm"], "O", [0.0, 0.0, 1.0]).driver("motor", "O", Law::parse("t").unwrap())
    /// #     .times([0.0, 0.5]);
    /// let model = Model::from_draft(&draft).unwrap();
    /// let analysis = Analysis::new(&model).unwrap();
    /// let (mut motion, _) = analysis.proven_motion(&[]).unwrap();
    /// let arm = motion.over(0.0, 0.1).unwrap()[1];
    /// let sine = arm.rot.cols[0].y; // of every angle from 0 to 0.1 rad, and its rates
    /// assert!(sine.value().contains(0.05_f64.sin()) && sine.value().width() < 0.101);
    /// assert!(sine.d().contains(0.05_f64.cos()) && sine.dd().contains(-(0.05_f64.sin())));
    /// ```
    pub fn proven_motion(&self, design: &[f64]) -> Option<(ProvenMotion<'_>, Option<Stop>)> {
        if self.openings().is_some() {
            return None;
        }
        let (model, prepared) = (self.solved_model(), self.design(design));
        let at_limit = self.stop_at_limit(&prepared);
        let PreparedDesign { geometry, laws, .. } = prepared;
        let parts = PlanGeometry::same(model, self.topology(), &geometry, &laws);
        let mut one = Stepper::new(model, self.topology(), parts);
        let (mut positions, mut plans, mut selections) = (Vec::new(), Vec::new(), None);
        let mut stop = None;
        // A motion that ends at the limit of a joint is proved up to there.
        let last_time = at_limit.as_ref().map_or(Some(f64::INFINITY), |stop| stop.last_time);
        let is_before = |t: &f64| last_time.is_some_and(|last| *t < last);
        let of_limit = last_time.filter(|last| last.is_finite());
        // Between output times, too: every position of the motion is near one of these.
        let within = self.times_within().into_iter();
        let times: Vec<f64> = within.take_while(is_before).chain(of_limit).collect();
        for (k, &t) in times.iter().enumerate() {
            if self.is_ended() {
                stop = Some(self.stopped(StopKind::Interrupted, 0));
                break;
            }
            let moved = if k == 0 { advance::start(&mut one, t) } else { advance::advance(&mut one, t) };
            if let Err(reason) = moved {
                // The last time that was reached is an output of the proof.
                let end = reason.last_time.filter(|end| k > 0 && times[k - 1] < *end);
                stop = Some(*reason);
                if end.is_none_or(|end| advance::advance(&mut one, end).is_err()) {
                    break;
                }
            }
            if selections != Some(one.mechanism.selections) {
                selections = Some(one.mechanism.selections);
                plans.push(one.mechanism.topology.clone());
            }
            let is_of_model = model.times.binary_search_by(|time| time.total_cmp(&t)).is_ok();
            let is_output = stop.is_some() || k + 1 == times.len() || is_of_model;
            let at = one.mechanism.saved.clone();
            positions.push(SolvedPosition { at, plan: plans.len() - 1, is_output });
            if stop.is_some() {
                break;
            }
        }
        Some((ProvenMotion::new(one.mechanism, positions, plans), stop.or(at_limit)))
    }
}

/// Length of a part of the motion, as a fraction of it, that is not halved again.
const SHORTEST: f64 = 1e-9;
/// Bounds of one proof, at most, or twice the number of parts between output times if that is more. A least distance
/// that is isolated needs a few tens; one over a part of the motion, as between points of one body, would need
/// thousands.
const MOST_BOUNDS: usize = 200;
/// Bounds of one proof of a mesh, at most: each is one of all of it over a part of the motion, or one of a triangle.
const MOST_BOUNDS_OF_MESH: usize = 4_000;
/// Triangles of a mesh that are bounded one by one over a part of the motion; with more of them it is halved.
const MOST_TRIANGLES: usize = 32;
/// A distance below the claim by more than this fraction of the mechanism's size refutes it: far above round-off.
const BELOW: f64 = 1e-10;
/// Steps of Newton's method to the time at which a distance is stationary.
const STEPS: usize = 6;
/// A step of Newton's method below this part of the interval leaves an error of its square.
const STATIONARY: f64 = 1e-7;

/// Result of the proof that a distance is never below a claim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClearanceProof {
    /// It never is, over all of the motion that was solved.
    Proved {
        /// Parts of the motion that passed.
        slabs: usize,
        /// Bounds that were computed: parts that passed, and those that were halved.
        bounds: usize,
    },
    /// Nothing is proved over a part of the motion.
    NotProved {
        /// Start of that part, s.
        from: f64,
        /// The end, s.
        to: f64,
        /// Proven lower bound of the distance over it, m; minus infinity if there is none.
        bound: f64,
        /// Reason.
        reason: ProofFailure,
    },
}

/// Reason why a distance is not proved to be at least a claim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ProofFailure {
    /// The distance at a time is less.
    Nearer {
        /// The time, s.
        time: f64,
        /// The distance, m.
        distance: f64,
    },
    /// No bound reaches the claim, in however short a part: the claim is the least distance itself up to round-off, or
    /// the rates of a law jump where the distance is least, or the distance is the least over a part of the motion.
    Unresolved,
    /// The cores of the shapes meet, where the distance does not say how deep the shapes are in each other.
    CoresMeet,
    /// A ring is nearest from the inside, where only points and segments have a bound.
    WithinRing,
    /// Both shapes are meshes, which have no bounds by separation.
    Meshes,
    /// The motion has no proven bounds there.
    Motion(TubeFailure),
    /// The caller [ended](Analysis::ended_by) the proof.
    Interrupted,
}

/// Proves clearances of one motion: the bounds of the motion are computed once for all pairs of shapes.
pub struct ClearanceProver<'a> {
    analysis: &'a Analysis<'a>,
    model: &'a Model,
    motion: ProvenMotion<'a>,
    /// Size of the mechanism, m.
    size: f64,
    moving: BodyFixed<Rates>,
    constants: BodyFixed<TimeJet<Interval>>,
    /// Reason why the motion ends before its last output time, if it does: proofs are for the part before.
    pub stop: Option<Stop>,
}

impl Analysis<'_> {
    /// Prover of the clearances of a design; `None` with equilibrium, as for [`proven_motion`](Self::proven_motion).
    pub fn clearance_prover(&self, design: &[f64]) -> Option<ClearanceProver<'_>> {
        let (motion, stop) = self.proven_motion(design)?;
        let model = self.model();
        let fixed: BodyFixed<f64> = self.design_map().fixed(&model.whole(design));
        let constants = fixed.map(|x| Jet::constant(Interval::constant(x)));
        let moving = fixed.map(Jet::constant);
        Some(ClearanceProver { analysis: self, model, motion, size: fixed.size, moving, constants, stop })
    }
}

/// Two shapes at one time.
struct Place {
    instant: Rc<Instant>,
    solids: [EnclosedSolid; 2],
    /// Unit vector along the nearest points of the cores, with its first two rates, for plain numbers; `None` where
    /// they meet.
    direction: Option<[Vec3; 3]>,
    distance: Distance,
    of_features: Option<Direction>,
    /// Place on a segment that is nearest to a circle.
    on_segment: Option<PlaceOnSegment>,
}

/// A part of the motion with two shapes.
struct Part<'p> {
    slab: &'p Slab,
    triangles: Triangles,
    solids: [EnclosedSolid; 2],
    /// Start, middle and end.
    places: [Rc<Place>; 3],
    length: Interval,
}

impl Part<'_> {
    /// Bound by a direction, with a time inside at which the parabola is anchored. Also: true if the functions that are
    /// below the claim are convex.
    fn bound(&self, direction: Direction, anchor: &Place, claim: f64) -> Option<(f64, bool)> {
        let over = self.slab.over;
        let all = separations(self.solids.each_ref(), direction, over)?;
        let at =
            |place: &Place| separations(place.solids.each_ref(), direction, place.instant.enclosure.over);
        let (start, inside, end) = (at(&self.places[0])?, at(anchor)?, at(&self.places[2])?);
        let since = over - anchor.instant.enclosure.over;
        let (mut least, mut convex) = (f64::INFINITY, true);
        for (k, gap) in all.iter().enumerate() {
            let gap = gap.narrowed(inside[k], since);
            let ends = [start[k].value(), end[k].value()];
            let bound = lower_bound(gap, ends, (inside[k], since), self.length);
            convex &= bound >= claim || gap.dd().low > 0.0;
            least = least.min(bound);
        }
        Some((least, convex))
    }
}

impl<'a> ClearanceProver<'a> {
    /// Number of enclosures of the motion over intervals that were computed so far.
    pub fn enclosures(&self) -> usize {
        self.motion.computed()
    }

    /// Proves that two shapes are never nearer than the claim, m, over the whole motion.
    ///
    /// The least distance of [`clearances`](Analysis::clearances) less an allowance for round-off, 1e-12 of the
    /// mechanism's size, is proved wherever it is isolated; a greater claim never is. Parts after the first one that is
    /// not proved are not tried.
    pub fn prove(&mut self, shapes: [ShapeId; 2], claim: f64) -> ClearanceProof {
        let times: Vec<f64> = self.motion.times().collect();
        let (Some(&start), Some(&end)) = (times.first(), times.last()) else {
            return ClearanceProof::Proved { slabs: 0, bounds: 0 };
        };
        self.prove_between(shapes, claim, [start, end])
    }

    /// Proves that two shapes are never nearer than the claim, m, between two times.
    pub fn prove_between(
        &mut self,
        shapes: [ShapeId; 2],
        claim: f64,
        [start, end]: [f64; 2],
    ) -> ClearanceProof {
        let is_mesh = |s: ShapeId| matches!(self.model.shapes[s.0].kind, ShapeKind::Mesh { .. });
        let mesh = match shapes.map(is_mesh) {
            [false, false] => None,
            [true, false] => Some(0),
            [false, true] => Some(1),
            [true, true] => {
                let (bound, reason) = (f64::NEG_INFINITY, ProofFailure::Meshes);
                return ClearanceProof::NotProved { from: start, to: end, bound, reason };
            }
        };
        let mut ends: Vec<f64> = self.motion.times().filter(|t| start < *t && *t < end).collect();
        ends.extend(self.motion.cuts(start, end));
        ends.extend([start, end]);
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        let (places, distances) = (HashMap::new(), HashMap::new());
        let mut pair = PairProof { prover: self, shapes, mesh, claim: 0.0, bounds: 0, places, distances };
        // Distance of the cores, rounded up.
        pair.claim = (Interval::constant(claim) + pair.rounds()).high;
        let mut slabs = 0;
        // The next part is the last one.
        let mut parts: Vec<[f64; 2]> = ends.windows(2).rev().map(|pair| [pair[0], pair[1]]).collect();
        if parts.is_empty() {
            parts.push([start, end]);
        }
        let most = if mesh.is_some() { MOST_BOUNDS_OF_MESH } else { MOST_BOUNDS }.max(2 * parts.len());
        while let Some([from, to]) = parts.pop() {
            if pair.prover.analysis.is_ended() {
                let (bound, reason) = (f64::NEG_INFINITY, ProofFailure::Interrupted);
                return ClearanceProof::NotProved { from, to, bound, reason };
            }
            let failed = match pair.bound([from, to]) {
                Ok(bound) if bound >= pair.claim => {
                    slabs += 1;
                    continue;
                }
                Ok(bound) => (bound, ProofFailure::Unresolved),
                Err(reason) => (f64::NEG_INFINITY, reason),
            };
            let middle = Interval::between(from, to).middle();
            // All parts that are left, and both halves of this one, are still bounded.
            let halves = from < middle
                && middle < to
                && to - from > SHORTEST * (end - start)
                && pair.bounds + parts.len() + 2 <= most;
            let may_pass = match failed.1 {
                ProofFailure::Nearer { .. }
                | ProofFailure::CoresMeet
                | ProofFailure::WithinRing
                | ProofFailure::Meshes
                | ProofFailure::Interrupted => false,
                ProofFailure::Unresolved => true,
                ProofFailure::Motion(reason) => reason.may_be_halved(),
            };
            if !(halves && may_pass) {
                let (bound, reason) = failed;
                let within =
                    bound == f64::NEG_INFINITY && reason == ProofFailure::Unresolved && pair.has_ring();
                // Cores that do not meet are proved to be apart in a part that is short enough.
                let meet = reason == ProofFailure::Unresolved && pair.claim <= 0.0 && !pair.has_plane();
                let reason = match (within, meet) {
                    (true, _) => ProofFailure::WithinRing,
                    (false, true) => ProofFailure::CoresMeet,
                    (false, false) => reason,
                };
                let bound = (Interval::constant(bound) - pair.rounds()).low;
                return ClearanceProof::NotProved { from, to, bound, reason };
            }
            parts.extend([[middle, to], [from, middle]]);
        }
        ClearanceProof::Proved { slabs, bounds: pair.bounds }
    }
}

/// Triangles of meshes in place of two shapes, by their numbers; `None` for the shape itself.
type Triangles = [Option<usize>; 2];

/// Proof of one claim.
struct PairProof<'p, 'a> {
    prover: &'p mut ClearanceProver<'a>,
    shapes: [ShapeId; 2],
    /// The one that is a mesh.
    mesh: Option<usize>,
    /// Least distance of the cores, m.
    claim: f64,
    /// Bounds that were computed.
    bounds: usize,
    places: HashMap<(*const Instant, Triangles), Rc<Place>>,
    /// Distances of a mesh and the other core.
    distances: HashMap<*const Instant, Distance>,
}

/// Distance of the cores of two shapes at one time, for plain numbers.
#[derive(Clone, Copy)]
struct Distance {
    value: f64,
    /// True if the cores are segments that cross, and the distance is the way out of each other within their plane.
    cross: bool,
}

impl Distance {
    fn of(near: &Nearest) -> Self {
        Self { value: near.distance, cross: near.is_way_out_in_plane() }
    }
}

impl PairProof<'_, '_> {
    /// Sum of the radii around both cores.
    fn rounds(&self) -> Interval {
        let ClearanceProver { model, constants, .. } = &*self.prover;
        let poses: &[Pose<TimeJet<Interval>>] = &[];
        PlacedShapes { model, fixed: constants, bodies: poses }.rounds(self.shapes).value()
    }

    fn solids(&self, poses: &[Pose<TimeJet<Interval>>], triangles: Triangles) -> [EnclosedSolid; 2] {
        number::both([0, 1], |k| self.solid(poses, self.shapes[k], triangles[k]))
    }

    fn solid(
        &self,
        poses: &[Pose<TimeJet<Interval>>],
        shape: ShapeId,
        triangle: Option<usize>,
    ) -> EnclosedSolid {
        let ClearanceProver { model, constants, .. } = &*self.prover;
        let placed = PlacedShapes { model, fixed: constants, bodies: poses };
        match placed.core(shape) {
            Some(core) => EnclosedSolid::Core(core),
            None => EnclosedSolid::Hull(placed.corners(shape, triangle)),
        }
    }

    /// Calls a function with the shapes at one time in plain numbers.
    fn placed<R>(&self, instant: &Instant, with: impl FnOnce(&PlacedShapes<'_, Rates>) -> R) -> R {
        let middle = |x: TimeJet<Interval>| Jet([x.0[0], x.0[1], x.0[2]].map(Interval::middle));
        let plain: Vec<Pose<Rates>> = instant
            .enclosure
            .poses
            .iter()
            .map(|pose| Pose {
                rot: Mat3 { cols: pose.rot.cols.map(|c| c.map(middle)) },
                r: pose.r.map(middle),
            })
            .collect();
        let ClearanceProver { model, moving, .. } = &*self.prover;
        with(&PlacedShapes { model, fixed: moving, bodies: &plain[..] })
    }

    /// Distance of the cores at one time.
    fn distance(&mut self, instant: &Rc<Instant>) -> Distance {
        if self.mesh.is_none() {
            return self.place(instant, [None; 2]).distance;
        }
        if let Some(known) = self.distances.get(&Rc::as_ptr(instant)) {
            return *known;
        }
        let found = Distance::of(&self.placed(instant, |placed| placed.nearest_of_cores(self.shapes)));
        self.distances.insert(Rc::as_ptr(instant), found);
        found
    }

    /// The shapes at one time.
    fn place(&mut self, instant: &Rc<Instant>, triangles: Triangles) -> Rc<Place> {
        let key = (Rc::as_ptr(instant), triangles);
        if let Some(place) = self.places.get(&key) {
            return place.clone();
        }
        let solids = self.solids(&instant.enclosure.poses, triangles);
        let (near, direction, on_segment) = self.placed(instant, |placed| {
            let near = placed.nearest_of_parts(self.shapes, triangles);
            let direction = placed.direction(self.shapes, &near);
            (near, direction, placed.place_on_segment(self.shapes, &near))
        });
        let rates = |n: Vec3<Rates>| [0, 1, 2].map(|order| n.map(|x| x.0[order]));
        let place = Rc::new(Place {
            instant: instant.clone(),
            of_features: Direction::of_features(solids.each_ref(), &near),
            solids,
            direction: direction.map(rates),
            distance: Distance::of(&near),
            on_segment,
        });
        self.places.insert(key, place.clone());
        place
    }

    /// Proven lower bound of the distance of the cores over a part of the motion.
    fn bound(&mut self, [from, to]: [f64; 2]) -> Result<f64, ProofFailure> {
        self.bounds += 1;
        let slab = self.prover.motion.slab(from, to).map_err(ProofFailure::Motion)?;
        let distances = slab.instants.each_ref().map(|instant| self.distance(instant));
        for (instant, distance) in slab.instants.iter().zip(distances) {
            if distance.value < self.claim - BELOW * self.prover.size {
                // Cores that only pass through each other have no depth: there is no way out within a plane that they
                // leave.
                let is_passing = distance.cross && !distances.iter().all(|distance| distance.cross);
                if is_passing && self.claim <= 0.0 {
                    return Err(ProofFailure::CoresMeet);
                }
                let distance = distance.value - self.rounds().middle();
                return Err(ProofFailure::Nearer { time: instant.time(), distance });
            }
        }
        let Some(mesh) = self.mesh else {
            return Ok(self.bound_of_parts(&slab, [None; 2]));
        };
        // A core that is outside of a closed surface, and meets no triangle, stays there.
        if !self.has_plane() && distances.iter().any(|distance| !(distance.value > 0.0)) {
            return Err(ProofFailure::CoresMeet);
        }
        let reach = self.claim + self.displacement(&slab, mesh) + BELOW * self.prover.size;
        let near = self.placed(&slab.instants[1], |placed| {
            placed.triangles_within(self.shapes, mesh, reach, MOST_TRIANGLES)
        });
        let Some(near) = near else { return Ok(f64::NEG_INFINITY) };
        let mut least = f64::INFINITY;
        for triangle in near {
            self.bounds += 1;
            let mut triangles = [None; 2];
            triangles[mesh] = Some(triangle);
            least = least.min(self.bound_of_parts(&slab, triangles));
            if least < self.claim {
                break;
            }
        }
        Ok(least)
    }

    /// Greatest distance of a point of the other core, over a part of the motion, from its place in the middle of it,
    /// in the frame of mesh `of`.
    fn displacement(&self, slab: &Slab, of: usize) -> f64 {
        let model = self.prover.model;
        let [mesh, other] = [self.shapes[of], self.shapes[1 - of]];
        let ShapeKind::Mesh { body, surface } = &model.shapes[mesh.0].kind else { return f64::INFINITY };
        let middle = &slab.instants[1].enclosure;
        let seen =
            |poses: &[Pose<TimeJet<Interval>>]| self.solid(poses, other, None).moved(poses[body.0].inverse());
        let (over, narrow) = (seen(&slab.poses), seen(&middle.poses));
        // The plane is used as far as the mesh reaches.
        let farthest = match &narrow {
            EnclosedSolid::Core(Core::HalfSpace { point, .. }) => {
                let (centre, radius) = surface.ball();
                (point.map(|x| x.value().middle()) - centre).norm() + 2.0 * radius
            }
            EnclosedSolid::Core(_) | EnclosedSolid::Hull(_) => 0.0,
        };
        over.displacement(&narrow, slab.over - middle.over, farthest)
    }

    /// Proven lower bound of the distance of both cores, or of triangles of theirs, over a part of the motion.
    fn bound_of_parts(&mut self, slab: &Slab, triangles: Triangles) -> f64 {
        let places = slab.instants.each_ref().map(|instant| self.place(instant, triangles));
        let Interval { low: from, high: to } = slab.over;
        let length = Interval::constant(to) - Interval::constant(from);
        let part = Part { solids: self.solids(&slab.poses, triangles), slab, triangles, places, length };
        let [start, middle, end] = part.places.each_ref();
        let mut best = f64::NEG_INFINITY;
        if let Some(direction) = middle.of_features {
            let found = part.bound(direction, middle, self.claim);
            // A plane has a distance on both sides; otherwise cores that meet have none.
            best = self.better(best, found, true);
        }
        if best >= self.claim {
            return best;
        }
        if let Some([n, ..]) = middle.direction {
            let found = part.bound(Direction::fixed(n), middle, self.claim);
            best = self.better(best, found, false);
        }
        if best >= self.claim {
            return best;
        }
        if let (Some(at_start), Some(at_end)) = (start.direction, end.direction) {
            // Along the nearest points at both ends, so that nothing is lost where the distance falls or rises.
            let direction = Direction::between([at_start, at_end], [from, to]);
            let found = part.bound(direction, middle, self.claim);
            best = self.better(best, found, false);
            if best < self.claim && found.is_some_and(|(_, convex)| convex) {
                let along = |place: &Place| Some(Direction::through(place.direction?, place.instant.time()));
                let found = self.least_of_convex(&part, &along);
                best = self.better(best, found, false);
            }
        }
        if best < self.claim {
            let found = self.through_ring(&part, [from, to]);
            best = self.better(best, found, false);
        }
        best
    }

    /// Bound of a segment and a circle around it.
    fn through_ring(&mut self, part: &Part<'_>, times: [f64; 2]) -> Option<(f64, bool)> {
        let [start, middle, end] = part.places.each_ref();
        let bound = ring_bound(part.solids.each_ref(), middle.on_segment?)?;
        // Through the nearest places at both ends, so that nothing is lost where the distance falls or rises.
        let direction = Direction::ThroughRing(bound.between([start.on_segment?, end.on_segment?], times));
        let found = part.bound(direction, middle, self.claim)?;
        if found.0 >= self.claim || !found.1 {
            return Some(found);
        }
        let along = |place: &Place| {
            Some(Direction::ThroughRing(bound.through(place.on_segment?, place.instant.time())))
        };
        self.least_of_convex(part, &along)
    }

    /// The greater of two bounds. Cores that meet have no distance: a bound by separation is positive.
    fn better(&self, best: f64, found: Option<(f64, bool)>, any_sign: bool) -> f64 {
        match found {
            Some((bound, _)) if bound > 0.0 || any_sign && self.has_plane() => best.max(bound),
            Some(_) | None => best,
        }
    }

    fn has_plane(&self) -> bool {
        self.shapes.iter().any(|s| matches!(self.prover.model.shapes[s.0].kind, ShapeKind::Plane { .. }))
    }

    fn has_ring(&self) -> bool {
        self.shapes.iter().any(|s| matches!(self.prover.model.shapes[s.0].kind, ShapeKind::Ring { .. }))
    }

    /// Bound by the parabola at the time at which a convex distance is stationary; `along` is the direction of a place.
    fn least_of_convex(
        &mut self,
        part: &Part<'_>,
        along: &dyn Fn(&Place) -> Option<Direction>,
    ) -> Option<(f64, bool)> {
        let Interval { low: from, high: to } = part.slab.over;
        let mut place = part.places[1].clone();
        for _ in 0..STEPS {
            // Along the nearest points there, so that nothing is lost.
            let time = place.instant.time();
            let direction = along(&place)?;
            let gaps = separations(place.solids.each_ref(), direction, place.instant.enclosure.over)?;
            let nearest = gaps.iter().min_by(|a, b| a.value().low.total_cmp(&b.value().low))?;
            let step = -nearest.d().middle() / nearest.dd().middle();
            let next = (time + step).clamp(from, to);
            if !((next - time).abs() > STATIONARY * (to - from)) {
                return part.bound(direction, &place, self.claim);
            }
            let instant = self.prover.motion.instant_within(from, next).ok()?;
            place = self.place(&instant, part.triangles);
        }
        None
    }
}
