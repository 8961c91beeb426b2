//! Linkages whose point follows a path: searches from the atlas.

use std::f64::consts::TAU;

use hardpoint_planar::atlas::{self, AtlasType, Target, Trace};
use hardpoint_planar::linkage::{Guide, Linkage};
use hardpoint_planar::path::{FittedLinkage, LARGEST, Search};
use hardpoint_planar::plane::{Complex, Displacement};

use super::driven::{ALIKE, Driven, MERGED, SAME, driven, is_alike};
use super::frame::{COINCIDE, Frame, extent};
use super::result::{Answer, Rejection, Synthesis};
use super::task::{Task, TaskError};

/// Width of a path below which it is a line, in sizes.
const FLAT: f64 = 1e-9;
/// Starts of each type from the atlas, and steps of each.
const STARTS: usize = 120;
const TRIAL: usize = 20;
/// Searches of each type that are completed, and their steps.
const COMPLETED: usize = 24;
const MOST_STEPS: usize = 300;
/// Searches of each type that are followed along a curve.
const FOLLOWED: usize = 8;
/// Distances below this part of the size are all the same: exact.
const EXACT: f64 = 1e-9;

pub(super) fn along_path(
    task: &Task,
    points: &[Complex],
    is_closed: bool,
    turns: Option<&[f64]>,
    more: &(dyn Fn() -> bool + Sync),
) -> Result<Synthesis, TaskError> {
    let size = extent(points);
    check_points(points, is_closed, size)?;
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
    let PathJudge { found, good, .. } = judge;
    // Fewer than nine points are met by families.
    let is_family = points.len() < 9 && turns.is_none();
    Ok(Synthesis { answers: answers_of(good, task, size, is_family), ..found })
}

/// Checks the number of points, and that none coincides with the next one.
fn check_points(points: &[Complex], is_closed: bool, size: f64) -> Result<(), TaskError> {
    if points.len() < 3 {
        return Err(TaskError::Count(points.len()));
    }
    let follows = |k: usize| if k + 1 < points.len() { Some(k + 1) } else { is_closed.then_some(0) };
    for k in 0..points.len() {
        if let Some(next) = follows(k)
            && (points[next] - points[k]).norm() <= COINCIDE * size
        {
            return Err(TaskError::Coincide([k, next]));
        }
    }
    Ok(())
}

/// Best of the linkages that are not alike, up to the number of answers.
fn answers_of(mut good: Vec<Answer>, task: &Task, size: f64, is_family: bool) -> Vec<Answer> {
    // Answers that meet the points are ranked by their score, all others by their distance over their score: a linkage
    // that jams is of no use, however near it comes.
    let is_met = |a: &Answer| a.largest <= task.tolerance || a.rms <= EXACT * size;
    let level = |a: &Answer| if is_met(a) { 0.0 } else { a.rms / a.score };
    good.sort_by(|a, b| level(a).total_cmp(&level(b)).then(b.score.total_cmp(&a.score)));
    let mut answers: Vec<Answer> = Vec::new();
    for answer in good {
        let alike = match () {
            () if is_family => ALIKE,
            () if answer.rms > EXACT * size => MERGED,
            () => SAME,
        };
        let is_known = answers.iter().any(|a| is_alike(&a.linkage, &answer.linkage, alike * size));
        if answers.len() < task.answers && !is_known {
            answers.push(answer);
        }
    }
    answers
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
            Guide::Rocker(_) => &mut self.found.four_bars,
            Guide::Slider(_) => &mut self.found.slider_cranks,
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
        if !task.has_inside(&outward) {
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
