//! Points of a front, and where to look for the next.

use super::result::{FrontPoint, ON_FRONT, TradeOff};
use crate::optimize::{
    Criticality, Curvatures, LIMIT_KEPT, Memory, Reference, SHARP, SHARP_BETWEEN, STEPS, Scalarization,
    Scale, Solved, State, assess, limit_scales,
};

/// Range of a goal, relative to its change from the nominal design, below which it does not conflict with the others.
const NO_CONFLICT: f64 = 1e-7;
/// Losses in all goals, as fractions of their ranges, below which a design is the optimum of all of them.
const COMMON: f64 = 1e-3;
/// An optimum is not at the end of the front if the other goal gains more than this fraction of its range for the last
/// of [`END_LOSSES`].
const GAIN: f64 = 0.25;
/// A point of a front lies within this fraction of a gap from the line of its reference.
const NEAR: f64 = 0.1;
/// A point nearer to a neighbour than this fraction of the gap is that neighbour.
const SAME: f64 = 1e-2;
/// Positions in a gap at which a point is sought; where none is between its neighbours, the front has a jump. The last
/// ones lengthen the pieces on both sides of it.
const POSITIONS: [f64; 7] = [0.5, 0.2, 0.8, 0.07, 0.93, 0.025, 0.975];
/// Weight of a goal below which a point is at an end of the front.
const NO_WEIGHT: f64 = 1e-6;
/// Losses in a goal, as fractions of its range, that lead to an end of the front where the design with its optimum is
/// not unique; the last one is accepted there. The rate of exchange is finite with it.
const END_LOSSES: [f64; 3] = [1e-1, 1e-2, 1e-3];
/// A goal of squares with a misfit below this fraction of its range is met. In general many designs meet it.
const MET: f64 = 1e-4;
/// Maximum number of times that the ends of a front are sought: their losses are fractions of the ranges between
/// them ...
const MOST_ENDS: usize = 4;
/// ... until these change by less than this fraction.
const SETTLED: f64 = 0.5;
/// Differences of goals, as fractions of their ranges, that are round-off of the searches.
const ROUND_OFF: f64 = 1e-9;
/// A neighbour takes part in an interpolation if its gap is at most this much wider.
const ALIKE: f64 = 4.0;

/// Optimum of a goal alone, as fractions of the bounds, with the secants that were learnt on the way.
pub(super) struct Anchor {
    pub x: Vec<f64>,
    pub curvatures: Curvatures,
}

/// A found point.
#[derive(Clone)]
struct Node {
    solved: Solved,
    anchor: Option<usize>,
    /// True if it is the optimum of this goal alone.
    is_alone: bool,
    /// True if it meets a goal that many designs meet: others may be better in all others.
    is_arbitrary: bool,
    designs: usize,
}

/// Gap between two neighbours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Gap {
    /// Points may be in it; the number of positions at which none was found.
    Open(usize),
    /// The front has a jump here.
    Jump,
    /// No point was found.
    Failed,
}

/// Reason why a front ends.
pub(super) enum End {
    Filled,
    SinglePoint,
}

/// Reason why a side ends.
enum SideEnd {
    Filled,
    /// The goals of the side do not conflict at this design.
    Common(Box<Node>),
}

/// Points of a front of two goals, from the optimum of one to that of the other.
#[derive(Clone)]
struct Side {
    /// The two goals.
    goals: [usize; 2],
    nodes: Vec<Node>,
    /// Gap after each node but the last.
    gaps: Vec<Gap>,
}

impl Side {
    /// Node at the end of a goal.
    fn end(&self, goal: usize) -> &Node {
        &self.nodes[self.place_of_end(usize::from(goal != self.goals[0]))]
    }

    /// Place of the first node or the last one.
    fn place_of_end(&self, which: usize) -> usize {
        if which == 0 { 0 } else { self.nodes.len() - 1 }
    }

    /// Ends the side at a design that has nearly the optimum of a goal.
    fn replace_end(&mut self, which: usize, solved: Solved, designs: usize) {
        let (at, anchor) = (self.place_of_end(which), Some(self.goals[which]));
        self.nodes[at] = Node { solved, anchor, is_alone: false, is_arbitrary: false, designs };
        let gap = if which == 0 { 0 } else { self.gaps.len() - 1 };
        self.gaps[gap] = Gap::Open(0);
    }
}

/// Points of a front.
pub(super) struct Front<'p> {
    memory: &'p Memory<'p>,
    limit_scales: Vec<f64>,
    scale: Scale,
    anchors: Vec<Node>,
    sides: Vec<Side>,
    inside: Vec<Node>,
    /// The optimum of all goals, if they do not conflict.
    common: Option<Node>,
    failed: usize,
    dominated: usize,
}

impl<'p> Front<'p> {
    /// Front between the optima of the goals, given as fractions of the bounds. The derivatives at the nominal design
    /// say by how much the goals change over the bounds, or else those at the optima.
    ///
    /// # Errors
    /// Returns the goal at whose optimum not all goals and limits can be evaluated.
    pub fn new(memory: &'p Memory<'p>, anchors: Vec<Anchor>, nominal: Option<&State>) -> Result<Self, usize> {
        let problem = memory.problem;
        let found = |x: &Vec<f64>| memory.at(x, |found| found.as_ref().ok().cloned());
        let points = anchors.iter().enumerate().map(|(goal, anchor)| found(&anchor.x).ok_or(goal));
        let points: Vec<_> = points.collect::<Result<_, _>>()?;
        let limit_scales = limit_scales(problem, nominal.map_or(&points[0], |state| &state.point));
        let (states, secants): (Vec<State>, Vec<Curvatures>) = anchors
            .into_iter()
            .zip(points)
            .map(|(Anchor { x, curvatures }, point)| {
                (State::new(problem, &limit_scales, x, point), curvatures)
            })
            .unzip();
        let count = states.len();
        // Another search may have found a better optimum of a goal.
        let best = |goal: usize| {
            let others = (0..count).filter(|k| *k != goal);
            others.fold(goal, |best, k| {
                let [a, b] = [k, best].map(|k| states[k].goals[goal]);
                if a < b - ROUND_OFF * b.abs() { k } else { best }
            })
        };
        let states: Vec<State> = (0..count).map(|goal| states[best(goal)].clone()).collect();
        // Those at an end of the front may be infinite, like that of a root at the end of its domain.
        let steepest = |k: usize| {
            let nominal = nominal.map_or(0.0, |state| state.steepest()[k]);
            if nominal > 0.0 { nominal } else { states.iter().map(|s| s.steepest()[k]).fold(0.0, f64::max) }
        };
        let steepest: Vec<f64> = (0..count).map(steepest).collect();
        let scale = scale_of(&states, &steepest);
        let node = |(goal, state): (usize, State)| {
            let mut weights = vec![0.0; count];
            weights[goal] = 1.0;
            let criticality = state.criticality(&scale, &[goal], &[]);
            let curvatures = Curvatures::of_weights(&state, &scale, &weights, secants[goal].clone());
            Node {
                solved: Solved { state, criticality, curvatures },
                anchor: Some(goal),
                is_alone: true,
                is_arbitrary: false,
                designs: 0,
            }
        };
        let anchors = states.into_iter().enumerate().map(node).collect();
        let (sides, inside) = (Vec::new(), Vec::new());
        Ok(Self {
            memory,
            limit_scales,
            scale,
            anchors,
            sides,
            inside,
            common: None,
            failed: 0,
            dominated: 0,
        })
    }

    /// Finds points until there are `points`, with the anchors.
    pub fn fill(&mut self, points: usize, report: &mut dyn FnMut()) -> End {
        self.anchors.iter().for_each(|_| report());
        if let Some(common) = self.common_anchor() {
            self.common = Some(common);
            return End::SinglePoint;
        }
        if self.anchors.len() == 2 {
            let mut side = self.side([0, 1]);
            let end = self.fill_side(&mut side, points, report);
            self.sides.push(side);
            return match end {
                SideEnd::Filled => End::Filled,
                SideEnd::Common(node) => {
                    self.common = Some(*node);
                    End::SinglePoint
                }
            };
        }
        // (m + 1)(m + 2) / 2 points on a triangle
        let m = (1..).take_while(|m| (m + 1) * (m + 2) / 2 <= points).last().unwrap_or(1);
        for goals in [[0, 1], [1, 2], [0, 2]] {
            let mut side = self.side(goals);
            let mut is_single = self.is_degenerate(&side);
            if !is_single && let SideEnd::Common(_) = self.fill_side(&mut side, m + 1, report) {
                is_single = true;
            }
            // A pair with a common optimum has no front of its own.
            if is_single {
                side.nodes.drain(1..side.nodes.len() - 1);
                side.gaps = vec![Gap::Open(0)];
                if self.end_at_corner(&mut side) {
                    let corner = &side.nodes[0];
                    if self.is_common(corner) {
                        self.common = Some(corner.clone());
                        return End::SinglePoint;
                    }
                }
            }
            self.sides.push(side);
        }
        self.join_sides();
        self.fill_inside(m, report);
        End::Filled
    }

    /// Replaces both ends of a side of three goals, whose goals do not conflict, by the design that minimises the third
    /// goal with a slight loss in these. Returns false if no goal is met at the ends, so that they are unique, or the
    /// design is not found.
    fn end_at_corner(&mut self, side: &mut Side) -> bool {
        let met = |node: &Node, goal: &usize| self.is_met(&node.solved.state, *goal);
        let is_unique = !side.nodes.iter().any(|node| side.goals.iter().any(|goal| met(node, goal)));
        let Some(third) = (0..self.scale.zero.len()).find(|goal| !side.goals.contains(goal)) else {
            return false;
        };
        if is_unique {
            return false;
        }
        let starts = [&side.nodes[0].solved, &side.nodes[1].solved];
        let Some(corner) = self.end_of(&side.goals, third, &starts, &END_LOSSES) else {
            side.nodes.iter_mut().for_each(|node| node.is_arbitrary = true);
            return false;
        };
        let anchor = None;
        let corner = Node { solved: corner, anchor, is_alone: false, is_arbitrary: false, designs: 0 };
        side.nodes = vec![corner.clone(), corner];
        true
    }

    /// Extends sides of three goals that end at different designs where a goal has its optimum: the later one to the
    /// end of the former.
    fn join_sides(&mut self) {
        for goal in 0..self.anchors.len() {
            let with_goal: Vec<usize> =
                (0..self.sides.len()).filter(|k| self.sides[*k].goals.contains(&goal)).collect();
            let [former, later] = with_goal[..] else { continue };
            let end = self.sides[former].end(goal).clone();
            let [a, b] = [&end, self.sides[later].end(goal)].map(|n| n.solved.state.scaled(&self.scale));
            if a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= ROUND_OFF) {
                continue;
            }
            let side = &mut self.sides[later];
            let at = if side.goals[0] == goal { 0 } else { side.nodes.len() };
            side.nodes.insert(at, end);
            side.gaps.push(Gap::Open(0));
        }
    }

    /// The anchor that is the optimum of all goals, if there is one.
    fn common_anchor(&self) -> Option<Node> {
        self.anchors.iter().find(|node| self.is_common(node)).cloned()
    }

    /// True if a design is the optimum of all goals.
    fn is_common(&self, node: &Node) -> bool {
        node.solved.state.scaled(&self.scale).iter().all(|f| *f <= COMMON + 2.0 * LIMIT_KEPT)
    }

    /// True if a goal of squares is met.
    fn is_met(&self, state: &State, goal: usize) -> bool {
        state.squares[goal] && state.goals[goal] <= MET * self.scale.range[goal]
    }

    fn side(&self, goals: [usize; 2]) -> Side {
        let nodes = goals.map(|k| self.anchors[k].clone()).into();
        Side { goals, nodes, gaps: vec![Gap::Open(0)] }
    }

    fn is_degenerate(&self, side: &Side) -> bool {
        let ends = [&side.nodes[0], &side.nodes[side.nodes.len() - 1]];
        side.goals.iter().any(|goal| {
            let [a, b] = ends.map(|n| n.solved.state.goals[*goal]);
            (a - b).abs() <= COMMON * self.scale.range[*goal]
        })
    }

    /// The two goals of a side, as fractions of their ranges.
    fn pair(&self, side: &Side, node: &Node) -> [f64; 2] {
        let all = node.solved.state.scaled(&self.scale);
        side.goals.map(|goal| all[goal])
    }

    /// Position along a side: the difference of its goals.
    fn along(&self, side: &Side, node: &Node) -> f64 {
        let [a, b] = self.pair(side, node);
        a - b
    }

    /// Distance of two neighbours.
    fn width(&self, side: &Side, k: usize) -> f64 {
        let [a, b] = [k, k + 1].map(|k| self.pair(side, &side.nodes[k]));
        (a[0] - b[0]).hypot(a[1] - b[1])
    }

    /// Finds points in the widest gaps first.
    fn fill_side(&mut self, side: &mut Side, points: usize, report: &mut dyn FnMut()) -> SideEnd {
        let has_many = |which: usize| {
            let Solved { state, criticality, .. } = &side.end(side.goals[which]).solved;
            criticality.residual > ON_FRONT || self.is_met(state, side.goals[which])
        };
        let ends: Vec<usize> = [0, 1].into_iter().filter(|which| has_many(*which)).collect();
        for _ in 0..MOST_ENDS {
            let ranges = self.scale.range.clone();
            let replaced = ends.iter().filter(|which| self.replace_optimum(side, **which)).count();
            if let Some(common) = self.common_end(side) {
                return SideEnd::Common(Box::new(common));
            }
            self.rescale(side);
            let mut changes =
                side.goals.iter().map(|goal| (self.scale.range[*goal] / ranges[*goal] - 1.0).abs());
            if replaced == 0 || changes.all(|change| change <= SETTLED) {
                break;
            }
        }
        for which in [0, 1] {
            if self.shorten_end(side, which) {
                self.rescale(side);
            }
        }
        if let Some(common) = self.common_end(side) {
            return SideEnd::Common(Box::new(common));
        }
        while side.nodes.len() < points && !self.memory.interrupted() {
            let open = (0..side.gaps.len()).filter(|k| matches!(side.gaps[*k], Gap::Open(_)));
            let open = open.map(|k| (k, self.width(side, k))).filter(|(_, width)| *width > ROUND_OFF);
            // The first of equal gaps.
            let widest = open.reduce(|a, b| if b.1 > a.1 * (1.0 + ROUND_OFF) { b } else { a });
            let Some((k, width)) = widest else { break };
            let Some(mut node) = self.between(side, k, width) else {
                let alone = [0, 1].into_iter().find(|which| self.is_optimum(side, k, *which));
                if alone.is_some_and(|which| self.replace_optimum(side, which)) {
                    self.rescale(side);
                    continue;
                }
                if !self.memory.interrupted() {
                    side.gaps[k] = Gap::Failed;
                    self.failed += 1;
                }
                continue;
            };
            let is_found = node.solved.criticality.residual <= ON_FRONT;
            if is_found && side.nodes.len() == 2 && self.pair(side, &node).iter().all(|f| *f <= COMMON) {
                return SideEnd::Common(Box::new(node));
            }
            if let Some(which) = self.is_slack(side, &node, k) {
                if self.replace_optimum(side, which) {
                    self.rescale(side);
                    continue;
                }
                // A better design with the same optimum.
                (node.anchor, node.is_alone) = (Some(side.goals[which]), true);
            }
            let [low, high] = [k, k + 1].map(|k| self.along(side, &side.nodes[k]));
            let at = self.along(side, &node);
            let is_inside = at > low + SAME * (high - low) && at < high - SAME * (high - low);
            if !is_inside || side.nodes.iter().any(|other| self.dominates(side, other, &node)) {
                side.gaps[k] = match side.gaps[k] {
                    Gap::Open(tries) if tries + 1 < POSITIONS.len() => Gap::Open(tries + 1),
                    Gap::Open(_) | Gap::Jump | Gap::Failed => Gap::Jump,
                };
                self.dominated += usize::from(is_inside);
                continue;
            }
            side.nodes.insert(k + 1, node);
            side.gaps[k] = Gap::Open(0);
            side.gaps.insert(k + 1, Gap::Open(0));
            self.remove_dominated(side, k + 1);
            report();
        }
        SideEnd::Filled
    }

    /// An end of a side that is the optimum of both of its goals, if there is one.
    fn common_end(&self, side: &Side) -> Option<Node> {
        let is_common = |node: &&Node| self.pair(side, node).iter().all(|f| *f <= COMMON + 2.0 * LIMIT_KEPT);
        side.goals
            .iter()
            .map(|goal| side.end(*goal))
            .filter(|node| !node.is_arbitrary)
            .find(is_common)
            .cloned()
    }

    /// Takes the ranges of two goals over the points of their front.
    fn rescale(&mut self, side: &Side) {
        if self.anchors.len() == 2 {
            let states: Vec<State> = side.nodes.iter().map(|n| n.solved.state.clone()).collect();
            let Scale { zero, range, steepest } = &self.scale;
            let steepest: Vec<f64> = steepest.iter().zip(range).map(|(s, r)| s * r).collect();
            self.scale = Scale { zero: zero.clone(), ..scale_of(&states, &steepest) };
        }
    }

    /// True if one node is better than another in a goal of a side and not worse in the other.
    fn dominates(&self, side: &Side, one: &Node, other: &Node) -> bool {
        let [a, b] = [one, other].map(|n| self.pair(side, n));
        a.iter().zip(b).all(|(a, b)| *a <= b + ROUND_OFF) && a.iter().zip(b).any(|(a, b)| *a < b - ROUND_OFF)
    }

    /// Removes nodes that the node k dominates.
    fn remove_dominated(&mut self, side: &mut Side, k: usize) {
        let new = side.nodes[k].clone();
        let mut at = 0;
        while at < side.nodes.len() {
            if self.dominates(side, &new, &side.nodes[at]) {
                side.nodes.remove(at);
                side.gaps.remove(at.min(side.gaps.len() - 1));
                if at > 0 && at <= side.gaps.len() {
                    side.gaps[at - 1] = Gap::Open(0);
                }
                self.dominated += 1;
            } else {
                at += 1;
            }
        }
    }

    /// True if a point next to an end shows that the optimum of a goal is not unique there: its weight is all on this
    /// goal. Returns which end.
    fn is_slack(&self, side: &Side, node: &Node, k: usize) -> Option<usize> {
        let weights = side.goals.map(|goal| node.solved.criticality.weights[goal]);
        [0, 1].into_iter().find(|which| self.is_optimum(side, k, *which) && weights[1 - which] < NO_WEIGHT)
    }

    /// True if a gap ends at the optimum of one of the two goals alone.
    fn is_optimum(&self, side: &Side, k: usize, which: usize) -> bool {
        let (node, is_end) = match which {
            0 => (&side.nodes[0], k == 0),
            _ => (&side.nodes[side.nodes.len() - 1], k + 2 == side.nodes.len()),
        };
        is_end && node.is_alone
    }

    /// Replaces the optimum of a goal, where the design with this optimum is not unique or has no gradient, by the end
    /// of the front: the design that minimises the other goal with a slight loss in the first, sought from both ends of
    /// the side. Returns false if it is not found.
    fn replace_optimum(&mut self, side: &mut Side, which: usize) -> bool {
        let [kept, other] = [side.goals[which], side.goals[1 - which]];
        let before = self.memory.cost.borrow().designs;
        let starts = [kept, other].map(|goal| &side.end(goal).solved);
        let found = self.end_of(&[kept], other, &starts, &END_LOSSES);
        let at = side.place_of_end(which);
        let Some(solved) = found else {
            side.nodes[at].is_arbitrary |= self.is_met(&side.nodes[at].solved.state, kept);
            return false;
        };
        let known = if side.nodes[at].is_alone { 0 } else { side.nodes[at].designs };
        let designs = self.memory.cost.borrow().designs - before + known;
        side.replace_end(which, solved, designs);
        true
    }

    /// Replaces the optimum of a goal alone by the design with the last of [`END_LOSSES`] if the other goal gains much
    /// for it. This comes before any point is sought, so that the ends of a front do not depend on their number.
    fn shorten_end(&mut self, side: &mut Side, which: usize) -> bool {
        let [kept, other] = [side.goals[which], side.goals[1 - which]];
        let at = side.place_of_end(which);
        if !side.nodes[at].is_alone || self.is_degenerate(side) {
            return false;
        }
        let before = self.memory.cost.borrow().designs;
        let optimum = side.nodes[at].solved.clone();
        let gain = |end: &Solved| {
            let [from, to] = [&optimum, end].map(|s| s.state.scaled(&self.scale)[other]);
            from - to
        };
        // From the optimum the last loss is often within reach; otherwise it is reduced step by step.
        let last = END_LOSSES[END_LOSSES.len() - 1];
        let (mut end, mut is_found) = self.with_loss(&[kept], other, optimum.clone(), last);
        if !is_found {
            end = optimum.clone();
            for loss in END_LOSSES {
                (end, is_found) = self.with_loss(&[kept], other, end, loss);
                // With less loss it gains less.
                if is_found && gain(&end) <= GAIN {
                    break;
                }
            }
        }
        let designs = self.memory.cost.borrow().designs - before;
        if is_found && gain(&end) > GAIN {
            side.replace_end(which, end, designs);
            return true;
        }
        // Its neighbours start with the second derivatives that were learnt.
        side.nodes[at].solved.curvatures = end.curvatures;
        side.nodes[at].designs += designs;
        false
    }

    /// Design that minimises a goal with a slight loss in others, the best one from several starts. The loss is reduced
    /// step by step, since designs with little of it are in a narrow curved valley.
    fn end_of(&self, kept: &[usize], other: usize, starts: &[&Solved], losses: &[f64]) -> Option<Solved> {
        let from = |start: &&Solved| -> Option<Solved> {
            let first = ((*start).clone(), false);
            let next = |(end, _): (Solved, bool), loss: &f64| self.with_loss(kept, other, end, *loss);
            let (end, is_found) = losses.iter().fold(first, next);
            is_found.then_some(end)
        };
        let value = |solved: &Solved| solved.state.goals[other];
        starts.iter().filter_map(from).min_by(|a, b| value(a).total_cmp(&value(b)))
    }

    /// Design that minimises a goal with a loss in others, sought from a start; the start and false if none is better.
    fn with_loss(&self, kept: &[usize], other: usize, start: Solved, loss: f64) -> (Solved, bool) {
        let mut reference: Reference = vec![None; self.scale.zero.len()];
        kept.iter().for_each(|goal| reference[*goal] = Some([loss, 0.0]));
        reference[other] = Some([start.state.scaled(&self.scale)[other], 1.0]);
        let solved =
            self.scalarization(reference, 1.0, SHARP).solve(start.state.clone(), start.curvatures.clone());
        let is_found = solved.as_ref().is_some_and(|s| s.criticality.residual <= ON_FRONT);
        (solved.unwrap_or(start), is_found)
    }

    fn scalarization(&self, reference: Reference, near: f64, sharp: f64) -> Scalarization<'p> {
        Scalarization {
            memory: self.memory,
            limit_scales: self.limit_scales.clone(),
            scale: self.scale.clone(),
            state: State::new,
            reference,
            near,
            sharp,
            steps: STEPS,
        }
    }

    /// Point in a gap: in its middle, or else nearer to one of its ends.
    fn between(&self, side: &Side, k: usize, width: f64) -> Option<Node> {
        let [a, b] = [k, k + 1].map(|k| &side.nodes[k]);
        let position = match side.gaps[k] {
            Gap::Open(tries) => POSITIONS[tries],
            Gap::Jump | Gap::Failed => POSITIONS[0],
        };
        let middle = (1.0 - position) * self.along(side, a) + position * self.along(side, b);
        let mut reference: Reference = vec![None; self.scale.zero.len()];
        reference[side.goals[0]] = Some([0.5 * middle, 1.0]);
        reference[side.goals[1]] = Some([-0.5 * middle, 1.0]);
        let curvatures = Curvatures::between(&a.solved.curvatures, &b.solved.curvatures);
        let ends = [a, b].map(|n| &n.solved.state.x);
        let start = self.interpolated(side, k, middle);
        self.solve(&self.scalarization(reference, NEAR * width, SHARP_BETWEEN), &start, ends, curvatures)
    }

    /// Solves a scalar problem from a start, or else nearer to a known design.
    fn solve(
        &self,
        scalarization: &Scalarization<'_>,
        start: &[f64],
        ends: [&Vec<f64>; 2],
        curvatures: Curvatures,
    ) -> Option<Node> {
        let before = self.memory.cost.borrow().designs;
        let mix = |end: &Vec<f64>, part: f64| -> Vec<f64> {
            start.iter().zip(end).map(|(s, e)| s + part * (e - s)).collect()
        };
        let starts = [start.to_vec(), mix(ends[0], 0.5), mix(ends[1], 0.5), ends[0].clone(), ends[1].clone()];
        for start in starts {
            if self.memory.interrupted() {
                return None;
            }
            let Some(state) = scalarization.evaluate(&start) else { continue };
            let solved = scalarization.solve(state, curvatures.clone());
            let is_found = |s: &Solved| s.criticality.residual <= ON_FRONT;
            if let Some(solved) = solved.filter(is_found) {
                let designs = self.memory.cost.borrow().designs - before;
                return Some(Node { solved, anchor: None, is_alone: false, is_arbitrary: false, designs });
            }
        }
        None
    }

    /// Design at a position in a gap, interpolated through up to four neighbours.
    fn interpolated(&self, side: &Side, k: usize, middle: f64) -> Vec<f64> {
        let width = self.width(side, k);
        let is_alike =
            |k: usize| matches!(side.gaps[k], Gap::Open(_)) && self.width(side, k) <= ALIKE * width;
        let first = if k > 0 && is_alike(k - 1) { k - 1 } else { k };
        let last = if k + 1 < side.gaps.len() && is_alike(k + 1) { k + 2 } else { k + 1 };
        let knots: Vec<f64> = (first..=last).map(|k| self.along(side, &side.nodes[k])).collect();
        let [a, b] = [k, k + 1].map(|k| &side.nodes[k].solved.state.x);
        let is_ascending = knots.windows(2).all(|w| w[1] > w[0]);
        let value = |v: usize| {
            // A variable at the same bound on both sides is at that bound between them.
            if a[v] == b[v] {
                return a[v];
            }
            if !is_ascending {
                return 0.5 * (a[v] + b[v]);
            }
            let term = |i: usize| {
                let others = (0..knots.len()).filter(|j| *j != i);
                others.map(|j| (middle - knots[j]) / (knots[i] - knots[j])).product::<f64>()
            };
            let nodes = side.nodes[first..=last].iter().enumerate();
            nodes.map(|(i, node)| term(i) * node.solved.state.x[v]).sum::<f64>().clamp(0.0, 1.0)
        };
        (0..a.len()).map(value).collect()
    }

    /// Points inside a front of three goals, by references and starts from a surface that its sides span.
    fn fill_inside(&mut self, m: usize, report: &mut dyn FnMut()) {
        for i in 1..m {
            for j in 1..m - i {
                if self.memory.interrupted() {
                    return;
                }
                let part = [i, j, m - i - j].map(|k| k as f64 / m as f64);
                let reference = self.spanned(part, |s| s.scaled(&self.scale));
                let start = self.spanned(part, |s| s.x.clone());
                let start: Vec<f64> = start.into_iter().map(|x| x.clamp(0.0, 1.0)).collect();
                let all = self.sides.iter().flat_map(|s| &s.nodes).chain(&self.inside);
                let distance = |node: &&Node| {
                    let f = node.solved.state.scaled(&self.scale);
                    f.iter().zip(&reference).map(|(a, b)| (a - b).powi(2)).sum::<f64>()
                };
                let nearest = all.min_by(|a, b| distance(a).total_cmp(&distance(b)));
                let Some(nearest) = nearest.cloned() else { return };
                let reference = reference.iter().map(|a| Some([*a, 1.0])).collect();
                let found = self.solve(
                    &self.scalarization(reference, NEAR / m as f64, SHARP_BETWEEN),
                    &start,
                    [&nearest.solved.state.x; 2],
                    nearest.solved.curvatures.clone(),
                );
                match found {
                    Some(node) => {
                        self.inside.push(node);
                        report();
                    }
                    None if self.memory.interrupted() => return,
                    None => self.failed += 1,
                }
            }
        }
    }

    /// Values on the surface spanned between the sides, at barycentric coordinates (a Coons patch on a triangle):
    ///
    /// ```text
    /// P = (P_0 + P_1 + P_2 - L) / 2     P_k: linear along the lines parallel to side k,  L: linear between corners
    /// ```
    fn spanned(&self, part: [f64; 3], of: impl Fn(&State) -> Vec<f64>) -> Vec<f64> {
        // Value on the side between two corners, at a part of the way.
        let on_side = |a: usize, b: usize, way: f64| -> Vec<f64> {
            let side = self.sides.iter().find(|s| s.goals == [a, b] || s.goals == [b, a]);
            let side = side.expect("every pair of goals has a side");
            let way = if side.goals == [a, b] { way } else { 1.0 - way };
            let mut lengths = vec![0.0];
            for k in 0..side.gaps.len() {
                lengths.push(lengths[k] + self.width(side, k));
            }
            let at = way * lengths[side.gaps.len()];
            let k = (0..side.gaps.len()).find(|k| at <= lengths[k + 1]).unwrap_or(side.gaps.len() - 1);
            let rest = (at - lengths[k]) / (lengths[k + 1] - lengths[k]).max(f64::MIN_POSITIVE);
            let [low, high] = [k, k + 1].map(|k| of(&side.nodes[k].solved.state));
            low.iter().zip(&high).map(|(a, b)| a + rest.clamp(0.0, 1.0) * (b - a)).collect()
        };
        let corner = |k: usize| self.sides.iter().find(|s| s.goals.contains(&k)).map(|s| s.end(k));
        let corners = [0, 1, 2].map(|k| of(&corner(k).unwrap_or(&self.anchors[k]).solved.state));
        let mut sum = vec![0.0; corners[0].len()];
        let mut add = |by: f64, values: &[f64]| sum.iter_mut().zip(values).for_each(|(s, v)| *s += by * v);
        for k in 0..3 {
            let [a, b] = [(k + 1) % 3, (k + 2) % 3];
            // The line with coordinate k fixed, from the side (k, a) to the side (k, b).
            let rest = (1.0 - part[k]).max(f64::MIN_POSITIVE);
            add(0.5 * part[a] / rest, &on_side(k, a, 1.0 - part[k]));
            add(0.5 * part[b] / rest, &on_side(k, b, 1.0 - part[k]));
            add(-0.5 * part[k], &corners[k]);
        }
        sum
    }

    /// Enters the points that no other dominates.
    pub fn into_result(self, result: &mut TradeOff) {
        let Self { memory, limit_scales, scale, anchors, sides, inside, common, mut failed, mut dominated } =
            self;
        let mut nodes: Vec<(Node, Vec<f64>)> = Vec::new();
        let mut jumps = Vec::new();
        if let Some(common) = common {
            nodes.push((common.clone(), common.solved.state.scaled(&scale)));
        } else {
            for side in &sides {
                for (k, gap) in side.gaps.iter().enumerate() {
                    if *gap == Gap::Jump && anchors.len() == 2 {
                        jumps.push([k, k + 1].map(|k| side.nodes[k].solved.state.goals.clone()));
                    }
                }
            }
            let ends = anchors.iter().filter(|_| sides.is_empty());
            for node in sides.iter().flat_map(|s| &s.nodes).chain(&inside).chain(ends) {
                if node.is_arbitrary {
                    failed += 1;
                    continue;
                }
                let values = node.solved.state.scaled(&scale);
                let is_known = |known: &(Node, Vec<f64>)| {
                    known.1.iter().zip(&values).all(|(a, b)| (a - b).abs() <= ROUND_OFF)
                };
                if !nodes.iter().any(is_known) {
                    nodes.push((node.clone(), values));
                }
            }
            let all: Vec<Vec<f64>> = nodes.iter().map(|n| n.1.clone()).collect();
            let is_dominated = |values: &[f64]| {
                all.iter().any(|other| {
                    let pairs = || other.iter().zip(values);
                    pairs().all(|(a, b)| *a <= b + ROUND_OFF) && pairs().any(|(a, b)| *a < b - ROUND_OFF)
                })
            };
            let before = nodes.len();
            nodes.retain(|(_, values)| !is_dominated(values));
            dominated += before - nodes.len();
        }
        // The optimum of a goal that is not smooth there does not satisfy the condition.
        let every: Vec<usize> = (0..scale.zero.len()).collect();
        let before = nodes.len();
        nodes.retain(|(node, _)| node.solved.state.criticality(&scale, &every, &[]).residual <= ON_FRONT);
        failed += before - nodes.len();
        nodes.sort_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let place = |goals: &Vec<f64>| nodes.iter().position(|(n, _)| n.solved.state.goals == *goals);
        result.jumps = jumps.iter().filter_map(|[a, b]| Some([place(a)?, place(b)?])).collect();
        let point = |(node, _): &(Node, Vec<f64>)| {
            let state = &node.solved.state;
            // A point of a side has no weight on the third goal.
            let Criticality { residual, weights } = state.criticality(&scale, &every, &[]);
            let per_unit: Vec<f64> = weights.iter().zip(&scale.range).map(|(w, range)| w / range).collect();
            let has_weight = |k: usize| weights[k] > NO_WEIGHT;
            let rate = |k: usize| (has_weight(0) && has_weight(k)).then(|| -per_unit[0] / per_unit[k]);
            FrontPoint {
                assessment: assess(memory.problem, &state.point, &limit_scales),
                values: state.goals.clone(),
                rates: (0..weights.len()).map(rate).collect(),
                weights,
                residual,
                anchor: node.anchor,
                designs: node.designs,
            }
        };
        result.points = nodes.iter().map(point).collect();
        result.failed = failed;
        result.dominated = dominated;
    }
}

/// Ranges of the goals over designs, with the steepest derivatives of the goals in SI.
fn scale_of(states: &[State], steepest: &[f64]) -> Scale {
    let goals = 0..steepest.len();
    let values = |goal: usize| states.iter().map(move |s| s.goals[goal]);
    let zero: Vec<f64> = goals.clone().map(|k| values(k).fold(f64::INFINITY, f64::min)).collect();
    let range = |k: usize| {
        let range = values(k).fold(f64::NEG_INFINITY, f64::max) - zero[k];
        // A goal without conflict is measured by its change over the bounds.
        let over_bounds = steepest[k].max(f64::MIN_POSITIVE);
        if range > NO_CONFLICT * over_bounds { range } else { over_bounds }
    };
    let range: Vec<f64> = goals.map(range).collect();
    let steepest = steepest.iter().zip(&range).map(|(s, r)| s / r).collect();
    Scale { zero, range, steepest }
}
