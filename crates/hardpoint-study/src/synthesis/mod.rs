//! Synthesis from nothing: four-bars and slider-cranks that guide a body through poses, or a point along a path.
//!
//! The geometry of the linkages is in `hardpoint-planar`: [`dyads`], [`linkage`], [`defects`], coupler curves.
//!
//! [`synthesize`] returns [`Answer`]s, best first. An answer is geometry; its model is written and followed by the
//! engine elsewhere (`hardpoint-report`), and [`deviation_of_engine`] compares that motion with the answer.

mod follow;

use std::f64::consts::TAU;
use std::sync::atomic::{AtomicBool, Ordering};

use sobol_burley::sample;

use defects::{Defect, Passage, passage};
use dyads::Dyad;
use hardpoint_planar::atlas::{self, AtlasType, Target, Trace};
use hardpoint_planar::path::{FittedLinkage, LARGEST, Search};
use linkage::{Linkage, LinkageType};
use plane::{Complex, Displacement, Pose};

pub use hardpoint_planar::{defects, dyads, linkage, plane};

pub use follow::{EngineDeviation, deviation_of_engine};

/// Aim of a synthesis.
#[derive(Clone, Debug, PartialEq)]
pub enum Aim {
    /// Three to five poses of a body.
    Poses(Vec<Pose>),
    /// Points of a path of a point.
    Path {
        /// The points in order, m.
        points: Vec<Complex>,
        /// True if the path returns to its first point.
        is_closed: bool,
        /// Turns of the crank since the first point, rad, if they are prescribed.
        turns: Option<Vec<f64>>,
    },
}

/// A rectangle, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// Range of x.
    pub x: [f64; 2],
    /// Range of y.
    pub y: [f64; 2],
}

impl Region {
    fn has(&self, p: Complex) -> bool {
        let within = |[low, high]: [f64; 2], x: f64| low <= x && x <= high;
        within(self.x, p.x) && within(self.y, p.y)
    }

    fn corners(&self) -> [Complex; 4] {
        let [[left, right], [low, high]] = [self.x, self.y];
        [(left, low), (right, low), (right, high), (left, high)].map(|(x, y)| Complex::new(x, y))
    }

    fn middle(&self) -> Complex {
        let [x, y] = [self.x, self.y].map(|[low, high]| 0.5 * (low + high));
        Complex::new(x, y)
    }
}

/// A task of synthesis.
#[derive(Clone, Debug, PartialEq)]
pub struct Task {
    /// Poses or path.
    pub aim: Aim,
    /// True if four-bars are looked for.
    pub four_bars: bool,
    /// True if slider-cranks are looked for.
    pub slider_cranks: bool,
    /// Region of the fixed pivots.
    pub fixed_region: Option<Region>,
    /// Region of the pins on the body, in its first pose.
    pub moving_region: Option<Region>,
    /// Fixed pivots of cranks, if they are given: for three poses.
    pub fixed_pivots: Vec<Complex>,
    /// True if the crank must turn fully.
    pub full_turn: bool,
    /// True if the poses may be passed in any order.
    pub any_order: bool,
    /// Distance up to which a point of a path counts as met, m: linkages that come nearer are not better.
    pub tolerance: f64,
    /// Maximum number of answers.
    pub answers: usize,
}

impl Task {
    /// Task without restrictions.
    pub fn new(aim: Aim) -> Self {
        Self {
            aim,
            four_bars: true,
            slider_cranks: true,
            fixed_region: None,
            moving_region: None,
            fixed_pivots: Vec::new(),
            full_turn: false,
            any_order: false,
            tolerance: 0.0,
            answers: 10,
        }
    }
}

/// Reason why a task has no synthesis.
#[derive(Clone, Debug, PartialEq)]
pub enum TaskError {
    /// Fewer than three poses or points, or more than five poses.
    Count(usize),
    /// Two poses or neighbouring points coincide, by their numbers from 0.
    Coincide([usize; 2]),
    /// The orientation is the same in all poses.
    Translation,
    /// All poses turn about this one point.
    OnePole(Complex),
    /// All points of the path lie on a line.
    Line,
    /// A number of prescribed turns other than that of the points.
    Turns(usize),
    /// Prescribed turns do not go on in one direction within a turn, by the number from 0.
    TurnOrder(usize),
    /// Fixed pivots for a number of poses other than three.
    FixedPivots,
    /// No type of linkage is selected.
    NoType,
}

/// Numbers of linkages of one type by their outcome.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// All that were made.
    pub made: usize,
    /// Those with each defect, in the order of [`Defect::ALL`].
    pub defects: [usize; 4],
    /// Those without defect whose pivots or pins are outside the regions.
    pub outside: usize,
    /// Those without defect whose crank does not turn fully, if it must.
    pub rocking: usize,
    /// All others.
    pub good: usize,
}

/// A linkage that fulfils the task.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The linkage in the configuration of the first pose or point.
    pub linkage: Linkage,
    /// Displacements of the coupler since then.
    pub moves: Vec<Displacement>,
    /// Passage through them.
    pub passage: Passage,
    /// Type.
    pub kind: LinkageType,
    /// Root mean square of the distances from the points, m; of poses zero.
    pub rms: f64,
    /// Largest distance from a point, m; of poses the largest misfit of a dyad.
    pub largest: f64,
    /// Rank: the sine of the least transmission angle, less for large linkages.
    pub score: f64,
}

/// A linkage with all poses that does not pass them.
#[derive(Clone, Debug, PartialEq)]
pub struct Rejection {
    /// The linkage in the configuration of the first pose.
    pub linkage: Linkage,
    /// The defect.
    pub defect: Defect,
}

/// Result of a synthesis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Synthesis {
    /// The best answers, best first.
    pub answers: Vec<Answer>,
    /// Cranks through the poses; none for a path.
    pub cranks: Vec<Dyad>,
    /// Sliders through the poses; none for a path.
    pub sliders: Vec<Dyad>,
    /// Numbers of four-bars.
    pub four_bars: Tally,
    /// Numbers of slider-cranks.
    pub slider_cranks: Tally,
    /// Linkages with defects, the least first, at most the number of answers; of a path those that meet all points.
    pub rejections: Vec<Rejection>,
    /// Size of the task: the largest distance between two poses or points, m.
    pub size: f64,
    /// True if the caller ended the study: the answers are those found so far.
    pub is_interrupted: bool,
}

/// Poses whose origins are nearer than this part of the size, and whose angles than this, rad, coincide.
const COINCIDE: f64 = 1e-9;
/// Width of a path below which it is a line, in sizes.
const FLAT: f64 = 1e-9;
/// Fixed pivots of three poses, and lines of fixed pivots of four.
const PIVOTS: u32 = 160;
const LINES: usize = 48;
/// Half of the width of the field of fixed pivots around the poses, in sizes.
const FIELD: f64 = 2.0;
/// Sliders of a family.
const SLIDERS: usize = 24;
/// Pins and pivots of a family farther away, in sizes of the task, are left out, unless a region asks for them.
const PRACTICAL: f64 = 5.0;
/// Starts of each type from the atlas, and steps of each.
const STARTS: usize = 120;
const TRIAL: usize = 20;
/// Searches of each type that are completed, and their steps.
const COMPLETED: usize = 24;
const MOST_STEPS: usize = 300;
/// Searches of each type that are followed along a curve.
const FOLLOWED: usize = 8;
/// Searches whose joints are nearer than this, in sizes, end at the same linkage.
const MERGED: f64 = 0.02;
/// Answers of a family whose joints are nearer than this, in sizes, are alike; only the best of them is kept.
const ALIKE: f64 = 0.08;
/// Answers nearer than this, in sizes, are the same.
const SAME: f64 = 1e-6;
/// Distances below this part of the size are all the same: exact.
const EXACT: f64 = 1e-9;

/// Score of a linkage: `sin mu / (1 + extent / (4 size))`.
fn score(linkage: &Linkage, passage: &Passage, size: f64) -> f64 {
    passage.transmission.sin() / (1.0 + 0.25 * linkage.extent() / size)
}

/// Outcome of driving a linkage at one side or the other.
enum Driven {
    /// It passes the poses: its score, the linkage driven at the better side, and the passage.
    Well((f64, Linkage, Passage)),
    /// It passes them only with a crank that does not turn fully, as it must.
    Rocking,
    /// It has a defect, the least of both sides.
    Not(Defect),
}

/// Drives a linkage at each of the given sides.
fn driven(sides: [Option<Linkage>; 2], moves: &[Displacement], any_order: bool, full_turn: bool) -> Driven {
    let (mut best, mut least, mut rocks) = (None::<(f64, Linkage, Passage)>, Defect::Singular, false);
    for linkage in sides.into_iter().flatten() {
        match passage(&linkage, moves, any_order) {
            Ok(passage) if full_turn && !passage.is_full => rocks = true,
            Ok(passage) => {
                let score = score(&linkage, &passage, 1.0);
                if best.as_ref().is_none_or(|b| score > b.0) {
                    best = Some((score, linkage, passage));
                }
            }
            Err(defect) => least = least.min(defect),
        }
    }
    match best {
        Some(best) => Driven::Well(best),
        None if rocks => Driven::Rocking,
        None => Driven::Not(least),
    }
}

/// Finds the linkages of a task. `more` is called regularly; if it returns false, the study ends with those found so
/// far.
///
/// # Errors
/// A [`TaskError`].
pub fn synthesize(task: &Task, more: &(dyn Fn() -> bool + Sync)) -> Result<Synthesis, TaskError> {
    if !(task.four_bars || task.slider_cranks) {
        return Err(TaskError::NoType);
    }
    let ended = AtomicBool::new(false);
    let more = || {
        let goes_on = more();
        ended.fetch_or(!goes_on, Ordering::Relaxed);
        goes_on
    };
    let found = match &task.aim {
        Aim::Poses(poses) => through_poses(task, poses, &more),
        Aim::Path { points, is_closed, turns } => {
            along_path(task, points, *is_closed, turns.as_deref(), &more)
        }
    };
    found.map(|found| Synthesis { is_interrupted: ended.into_inner(), ..found })
}

/// Largest distance between two points.
fn extent(points: &[Complex]) -> f64 {
    let from = |p: &Complex| points.iter().map(|q| (*p - *q).norm()).fold(0.0, f64::max);
    points.iter().map(from).fold(0.0, f64::max)
}

/// A similarity between the task and its own coordinates, in which it has size 1 and its middle at 0.
struct Frame {
    middle: Complex,
    size: f64,
    /// Direction of x of its own coordinates.
    x: Complex,
}

impl Frame {
    fn inward(&self, p: Complex) -> Complex {
        ((p - self.middle) * self.x.conjugate()).times(1.0 / self.size)
    }

    fn outward(&self, p: Complex) -> Complex {
        (p * self.x).times(self.size) + self.middle
    }

    /// The same displacement in coordinates of the task.
    fn displacement_outward(&self, of: Displacement) -> Displacement {
        let middle = self.inward(Complex::ZERO);
        Displacement { turn: of.turn, shift: self.outward(of.of(middle)) }
    }

    fn linkage_outward(&self, linkage: &Linkage) -> Linkage {
        linkage.moved(|p| self.outward(p), |n| n * self.x)
    }
}

fn through_poses(
    task: &Task,
    poses: &[Pose],
    more: &(dyn Fn() -> bool + Sync),
) -> Result<Synthesis, TaskError> {
    if !(3..=5).contains(&poses.len()) {
        return Err(TaskError::Count(poses.len()));
    }
    if !task.fixed_pivots.is_empty() && poses.len() != 3 {
        return Err(TaskError::FixedPivots);
    }
    let origins: Vec<Complex> = poses.iter().map(|p| p.at).collect();
    let size = extent(&origins);
    let turned = |a: &Pose, b: &Pose| (0.5 * (a.angle - b.angle)).sin().abs();
    for j in 0..poses.len() {
        for i in 0..j {
            let apart = (origins[i] - origins[j]).norm();
            if apart <= COINCIDE * size && turned(&poses[i], &poses[j]) <= COINCIDE {
                return Err(TaskError::Coincide([i, j]));
            }
        }
    }
    if poses.iter().all(|p| turned(p, &poses[0]) <= COINCIDE) {
        return Err(TaskError::Translation);
    }
    if let Some(pole) = one_pole(poses, size) {
        return Err(TaskError::OnePole(pole));
    }
    let middle = origins.iter().fold(Complex::ZERO, |sum, p| sum + *p).times(1.0 / poses.len() as f64);
    let frame = Frame { middle, size, x: Complex::unit(poses[0].angle) };
    let own: Vec<Pose> =
        poses.iter().map(|p| Pose { at: frame.inward(p.at), angle: p.angle - poses[0].angle }).collect();
    let moves: Vec<Displacement> = own.iter().map(|p| Displacement::between(own[0], *p)).collect();
    let (cranks, sliders) = dyads_of(task, &moves, &frame);
    let is_family = poses.len() < 5 && task.fixed_pivots.is_empty();

    let mut found = Synthesis { size, ..Synthesis::default() };
    let mut good = Vec::new();
    let mut rejected: Vec<(Defect, f64, Linkage)> = Vec::new();
    let mut pair = |one: &Dyad, other: &Dyad, tally: &mut Tally| {
        let linkages = [Linkage::of(one, other, own[0].at), Linkage::of(other, one, own[0].at)];
        tally.made += 1;
        match driven(linkages, &moves, task.any_order, task.full_turn) {
            Driven::Well((_, linkage, _)) if !in_regions(task, &frame.linkage_outward(&linkage)) => {
                tally.outside += 1;
            }
            Driven::Well(best) => {
                tally.good += 1;
                good.push(best);
            }
            Driven::Rocking => tally.rocking += 1,
            Driven::Not(defect) => {
                tally.defects[defect as usize] += 1;
                rejected.extend(linkages.into_iter().flatten().next().map(|l| (defect, l.extent(), l)));
            }
        }
    };
    for j in 0..cranks.len() {
        if !more() {
            break;
        }
        for i in (0..j).filter(|_| task.four_bars) {
            pair(&cranks[i], &cranks[j], &mut found.four_bars);
        }
        for slider in sliders.iter().filter(|_| task.slider_cranks) {
            pair(&cranks[j], slider, &mut found.slider_cranks);
        }
    }
    good.sort_by(|a, b| b.0.total_cmp(&a.0));
    let alike = if is_family { ALIKE } else { SAME };
    for (score, linkage, passage) in good {
        if found.answers.len() == task.answers {
            break;
        }
        let outward = frame.linkage_outward(&linkage);
        if found.answers.iter().any(|a| is_alike(&a.linkage, &outward, alike * size)) {
            continue;
        }
        let misfit = |dyad: Option<Dyad>| dyad.map_or(0.0, |d| d.misfit(&moves));
        let (first, second) = dyads_in(&linkage);
        found.answers.push(Answer {
            linkage: Linkage { p: poses[0].at, ..outward },
            moves: poses.iter().map(|p| Displacement::between(poses[0], *p)).collect(),
            passage,
            kind: linkage.kind(),
            rms: 0.0,
            largest: misfit(first).max(misfit(second)) * size,
            score,
        });
    }
    rejected.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let rejections = rejected.into_iter().take(task.answers);
    found.rejections =
        rejections.map(|(defect, _, l)| Rejection { linkage: frame.linkage_outward(&l), defect }).collect();
    let outward = |dyad: &Dyad| dyad.moved(|p| frame.outward(p), |n| n * frame.x);
    found.cranks = cranks.iter().map(outward).collect();
    found.sliders = sliders.iter().map(outward).collect();
    Ok(found)
}

/// The two dyads of a linkage.
fn dyads_in(of: &Linkage) -> (Option<Dyad>, Option<Dyad>) {
    let second = match of.guide {
        linkage::Guide::Rocker(d) => Dyad::Crank { pivot: d, pin: of.c },
        linkage::Guide::Slider(along) => Dyad::Slider { pin: of.c, along },
    };
    (Some(Dyad::Crank { pivot: of.a, pin: of.b }), Some(second))
}

/// The point about which all poses turn, if there is one.
fn one_pole(poses: &[Pose], size: f64) -> Option<Complex> {
    let moves: Vec<Displacement> = poses[1..].iter().map(|p| Displacement::between(poses[0], *p)).collect();
    let pole = moves[0].pole();
    let reach = size.max((pole - poses[0].at).norm());
    let is_fixed = pole.is_finite() && moves.iter().all(|m| (m.of(pole) - pole).norm() <= COINCIDE * reach);
    // Round-off of a pole at the origin
    let rounded = |x: f64| if x.abs() <= f64::EPSILON * 16.0 * reach { 0.0 } else { x };
    (is_fixed && reach < size.max(f64::MIN_POSITIVE) / COINCIDE || size == 0.0)
        .then(|| Complex::new(rounded(pole.x), rounded(pole.y)))
}

/// All dyads of the displacements, or samples of their families.
fn dyads_of(task: &Task, moves: &[Displacement], frame: &Frame) -> (Vec<Dyad>, Vec<Dyad>) {
    let sliders = if task.slider_cranks { dyads::sliders(moves, SLIDERS) } else { Vec::new() };
    // The regions are the limits of what they are for; a crank may reach from a far region to the body.
    let reach = |region: Option<Region>| match region {
        Some(region) => {
            PRACTICAL + region.corners().map(|p| frame.inward(p).norm()).into_iter().fold(0.0, f64::max)
        }
        None => PRACTICAL,
    };
    let pivots = reach(task.fixed_region);
    let pins = reach(task.moving_region).max(pivots);
    let near = |d: &Dyad| match d {
        Dyad::Crank { pivot, pin } => pivot.norm() < pivots && pin.norm() < pins,
        Dyad::Slider { pin, .. } => pin.norm() < reach(task.moving_region),
    };
    let mut cranks: Vec<Dyad> = match moves.len() {
        5 => return (dyads::cranks(moves, &[]), sliders),
        4 => {
            // Through the middle of the region, or of the poses.
            let middle = task.fixed_region.map_or(Complex::ZERO, |r| frame.inward(r.middle()));
            let line = |k: usize| {
                let normal = Complex::<f64>::unit(std::f64::consts::PI * (k as f64 + 0.5) / LINES as f64);
                dyads::cranks(moves, &[(normal, normal.dot(middle))])
            };
            (0..LINES).flat_map(line).collect()
        }
        _ if !task.fixed_pivots.is_empty() => {
            let given = task.fixed_pivots.iter().map(|p| frame.inward(*p));
            return (given.filter_map(|p| dyads::crank_about(moves, p)).collect(), sliders);
        }
        _ => {
            let field = |k: u32| match task.fixed_region {
                Some(Region { x, y }) => {
                    let at = |d: u32, [low, high]: [f64; 2]| low + (high - low) * f64::from(sample(k, d, 3));
                    frame.inward(Complex::new(at(0, x), at(1, y)))
                }
                None => {
                    let at = |d: u32| FIELD * (2.0 * f64::from(sample(k, d, 3)) - 1.0);
                    Complex::new(at(0), at(1))
                }
            };
            (0..PIVOTS).filter_map(|k| dyads::crank_about(moves, field(k))).collect()
        }
    };
    // Of a family only those that are inside are paired.
    let inside = |d: &Dyad| match d {
        Dyad::Crank { pivot, pin } => {
            task.fixed_region.is_none_or(|r| r.has(frame.outward(*pivot)))
                && task.moving_region.is_none_or(|r| r.has(frame.outward(*pin)))
        }
        Dyad::Slider { pin, .. } => task.moving_region.is_none_or(|r| r.has(frame.outward(*pin))),
    };
    cranks.retain(|d| near(d) && inside(d));
    (cranks, sliders.into_iter().filter(|d| near(d) && inside(d)).collect())
}

fn in_regions(task: &Task, linkage: &Linkage) -> bool {
    let fixed = |p: Complex| task.fixed_region.is_none_or(|r| r.has(p));
    let moving = |p: Complex| task.moving_region.is_none_or(|r| r.has(p));
    let other = match linkage.guide {
        linkage::Guide::Rocker(d) => fixed(d),
        linkage::Guide::Slider(_) => true,
    };
    fixed(linkage.a) && other && moving(linkage.b) && moving(linkage.c)
}

/// True if the joints of two linkages are near one another, whichever side drives.
fn is_alike(one: &Linkage, other: &Linkage, distance: f64) -> bool {
    let (a, b) = (one.joints(), other.joints());
    let near = |order: &[usize]| order.iter().zip(&b).all(|(k, q)| (a[*k] - *q).norm() < distance);
    a.len() == b.len()
        && if a.len() == 4 { near(&[0, 1, 2, 3]) || near(&[3, 2, 1, 0]) } else { near(&[0, 1, 2]) }
}

fn along_path(
    task: &Task,
    points: &[Complex],
    is_closed: bool,
    turns: Option<&[f64]>,
    more: &(dyn Fn() -> bool + Sync),
) -> Result<Synthesis, TaskError> {
    if points.len() < 3 {
        return Err(TaskError::Count(points.len()));
    }
    let size = extent(points);
    let follows = |k: usize| if k + 1 < points.len() { Some(k + 1) } else { is_closed.then_some(0) };
    for k in 0..points.len() {
        if let Some(next) = follows(k)
            && (points[next] - points[k]).norm() <= COINCIDE * size
        {
            return Err(TaskError::Coincide([k, next]));
        }
    }
    if let Some(turns) = turns {
        check_turns(turns, points.len())?;
    }
    let middle = points.iter().fold(Complex::ZERO, |sum, p| sum + *p).times(1.0 / points.len() as f64);
    let (first, last) = farthest(points);
    let across = (points[last] - points[first]).times(1.0 / size);
    if points.iter().all(|p| across.cross(*p - points[first]).abs() <= FLAT * size) {
        return Err(TaskError::Line);
    }
    let frame = Frame { middle, size, x: across };
    let own: Vec<Complex> = points.iter().map(|p| frame.inward(*p)).collect();
    let (curve, places) = atlas::smooth(&own, is_closed);
    let trace = Trace::of(curve);
    let parts = places.iter().map(|k| trace.part(*k)).collect();
    let target = Target { points: &own, trace, parts, is_closed, turns };
    let mut types = Vec::new();
    types.extend(task.four_bars.then_some(AtlasType::FourBar));
    types.extend(task.slider_cranks.then_some(AtlasType::SliderCrank));

    let mut judge = PathJudge {
        task,
        frame: &frame,
        own: &own,
        is_timed: turns.is_some(),
        full_turn: task.full_turn || is_closed,
        found: Synthesis { size, ..Synthesis::default() },
        good: Vec::new(),
    };
    for mut fit in fits(&target, &types, more) {
        // The nearest linkage is of no use where an exact one is good.
        let is_met = fit.exact().is_some_and(|exact| judge.with_cognates(exact));
        if !is_met {
            if more() {
                fit.advance(&own, MOST_STEPS, true);
            }
            judge.with_cognates(fit.nearest());
        }
    }
    let PathJudge { mut found, mut good, .. } = judge;
    // Answers that meet the points are ranked by their score, all others by their distance over their score: a linkage
    // that jams is of no use, however near it comes.
    let is_met = |a: &Answer| a.largest <= task.tolerance || a.rms <= EXACT * size;
    let level = |a: &Answer| if is_met(a) { 0.0 } else { a.rms / a.score };
    good.sort_by(|a, b| level(a).total_cmp(&level(b)).then(b.score.total_cmp(&a.score)));
    // Fewer than nine points are met by families.
    let is_family = points.len() < 9 && turns.is_none();
    for answer in good {
        let alike = match () {
            () if is_family => ALIKE,
            () if answer.rms > EXACT * size => MERGED,
            () => SAME,
        };
        let is_known = found.answers.iter().any(|a| is_alike(&a.linkage, &answer.linkage, alike * size));
        if found.answers.len() < task.answers && !is_known {
            found.answers.push(answer);
        }
    }
    Ok(found)
}

/// Linkages that follow a path, and the numbers of those that do not.
struct PathJudge<'a> {
    task: &'a Task,
    frame: &'a Frame,
    /// Points in the coordinates of the frame.
    own: &'a [Complex],
    is_timed: bool,
    full_turn: bool,
    found: Synthesis,
    good: Vec<Answer>,
}

impl PathJudge<'_> {
    /// Judges a linkage and its cognates, which have the same path; with prescribed turns their cranks are others. True
    /// if one of them is good.
    fn with_cognates(&mut self, (linkage, moves, rms): FittedLinkage) -> bool {
        let cognates = if self.is_timed { Vec::new() } else { linkage.cognates(&moves) };
        let all = std::iter::once((linkage, moves)).chain(cognates);
        all.fold(false, |is_good, (linkage, moves)| self.one(linkage, &moves, rms) || is_good)
    }

    fn one(&mut self, linkage: Linkage, moves: &[Displacement], rms: f64) -> bool {
        let (task, frame, size) = (self.task, self.frame, self.found.size);
        if !(linkage.extent() < LARGEST) {
            return false;
        }
        let tally = match linkage.guide {
            linkage::Guide::Rocker(_) => &mut self.found.four_bars,
            linkage::Guide::Slider(_) => &mut self.found.slider_cranks,
        };
        tally.made += 1;
        // With free timing either side may drive.
        let other = linkage.swapped().filter(|_| !self.is_timed);
        let (score, linkage, passage) =
            match driven([Some(linkage), other], moves, task.any_order, self.full_turn) {
                Driven::Well(best) => best,
                Driven::Rocking => {
                    tally.rocking += 1;
                    return false;
                }
                Driven::Not(defect) => {
                    tally.defects[defect as usize] += 1;
                    let outward = frame.linkage_outward(&linkage);
                    let rejections = &mut self.found.rejections;
                    let is_known = rejections.iter().any(|r| is_alike(&r.linkage, &outward, MERGED * size));
                    if rms <= EXACT && rejections.len() < task.answers && !is_known {
                        rejections.push(Rejection { linkage: outward, defect });
                    }
                    return false;
                }
            };
        let outward = frame.linkage_outward(&linkage);
        if !in_regions(task, &outward) {
            tally.outside += 1;
            return false;
        }
        tally.good += 1;
        let far = moves.iter().zip(self.own).map(|(m, p)| (m.of(linkage.p) - *p).norm()).fold(0.0, f64::max);
        self.good.push(Answer {
            linkage: outward,
            moves: moves.iter().map(|m| frame.displacement_outward(*m)).collect(),
            score,
            passage,
            kind: linkage.kind(),
            rms: rms * size,
            largest: far * size,
        });
        true
    }
}

/// Searches from the starts of each type in the atlas; those that come nearest are completed, unless the caller ends
/// the study.
fn fits(target: &Target<'_>, types: &[AtlasType], more: &(dyn Fn() -> bool + Sync)) -> Vec<Search> {
    let mut found: Vec<Search> = Vec::new();
    for of in types {
        let mut searches: Vec<Search> = Vec::new();
        for start in atlas::resembling(target, *of, STARTS, more) {
            if !more() {
                break;
            }
            let search = Search::new(&start.linkage, &start.turns, target.points, target.turns.is_some());
            if let Some(mut search) = search {
                search.advance(target.points, TRIAL, false);
                searches.push(search);
            }
        }
        searches.sort_by(|a, b| a.rms().total_cmp(&b.rms()));
        let mut kept: Vec<Search> = Vec::new();
        for search in searches {
            let is_known = kept.iter().any(|k| is_alike(&k.linkage(), &search.linkage(), MERGED));
            if kept.len() < COMPLETED && !is_known {
                kept.push(search);
            }
        }
        for search in &mut kept {
            if !more() {
                break;
            }
            search.approach(target.points);
            if !search.is_exact() {
                search.advance(target.points, MOST_STEPS, true);
                search.approach(target.points);
            }
        }
        kept.sort_by(|a, b| a.rms().total_cmp(&b.rms()));
        for search in kept.iter_mut().filter(|s| !s.is_exact()).take(FOLLOWED) {
            search.follow(target.points, more);
        }
        found.extend(kept);
    }
    found
}

/// Two points with the largest distance.
fn farthest(points: &[Complex]) -> (usize, usize) {
    let pairs = (0..points.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
    let apart = |(i, j): &(usize, usize)| (points[*i] - points[*j]).norm();
    pairs.max_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap_or((0, 0))
}

/// Prescribed turns begin at zero and go on in one direction, within one turn.
fn check_turns(turns: &[f64], points: usize) -> Result<(), TaskError> {
    if turns.len() != points {
        return Err(TaskError::Turns(turns.len()));
    }
    let direction = (turns[1] - turns[0]).signum();
    let goes_on =
        |k: usize| direction * (turns[k] - turns[k - 1]) > 0.0 && (turns[k] - turns[0]).abs() <= TAU;
    match (1..turns.len()).find(|k| !goes_on(*k)) {
        Some(k) => Err(TaskError::TurnOrder(k)),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests;
