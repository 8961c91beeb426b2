//! Linkages through poses of a body: pairs of the dyads of the displacements.

use sobol_burley::sample;

use hardpoint_planar::defects::{Defect, Passage};
use hardpoint_planar::dyads::{self, Dyad};
use hardpoint_planar::linkage::{Guide, Linkage};
use hardpoint_planar::plane::{Complex, Displacement, Pose};

use super::driven::{ALIKE, Driven, SAME, driven, is_alike};
use super::frame::{COINCIDE, Frame, extent};
use super::result::{Answer, Rejection, Synthesis, Tally};
use super::task::{Region, Task, TaskError};

/// Fixed pivots of three poses, and lines of fixed pivots of four.
const PIVOTS: u32 = 160;
const LINES: usize = 48;
/// Half of the width of the field of fixed pivots around the poses, in sizes.
const FIELD: f64 = 2.0;
/// Sliders of a family.
const SLIDERS: usize = 24;
/// Pins and pivots of a family farther away, in sizes of the task, are left out, unless a region asks for them.
const PRACTICAL: f64 = 5.0;

pub(super) fn through_poses(
    task: &Task,
    poses: &[Pose],
    more: &(dyn Fn() -> bool + Sync),
) -> Result<Synthesis, TaskError> {
    let origins: Vec<Complex> = poses.iter().map(|p| p.at).collect();
    let size = extent(&origins);
    check_poses(task, poses, size)?;
    let middle = origins.iter().fold(Complex::ZERO, |sum, p| sum + *p).times(1.0 / poses.len() as f64);
    let frame = Frame { middle, size, x: Complex::unit(poses[0].angle) };
    let own: Vec<Pose> =
        poses.iter().map(|p| Pose { at: frame.inward(p.at), angle: p.angle - poses[0].angle }).collect();
    let moves: Vec<Displacement> = own.iter().map(|p| Displacement::between(own[0], *p)).collect();
    let (cranks, sliders) = dyads_of(task, &moves, &frame);
    let mut found = Synthesis { size, ..Synthesis::default() };
    let mut good = Vec::new();
    let mut rejected: Vec<(Defect, f64, Linkage)> = Vec::new();
    let mut pair = |one: &Dyad, other: &Dyad, tally: &mut Tally| {
        let linkages = [Linkage::of(one, other, own[0].at), Linkage::of(other, one, own[0].at)];
        tally.made += 1;
        match driven(linkages, &moves, task.any_order, task.full_turn) {
            Driven::Well((_, linkage, _)) if !task.has_inside(&frame.linkage_outward(&linkage)) => {
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
    found.answers = answers_of(good, task, poses, &moves, &frame);
    rejected.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let rejections = rejected.into_iter().take(task.answers);
    found.rejections =
        rejections.map(|(defect, _, l)| Rejection { linkage: frame.linkage_outward(&l), defect }).collect();
    let outward = |dyad: &Dyad| dyad.moved(|p| frame.outward(p), |n| n * frame.x);
    found.cranks = cranks.iter().map(outward).collect();
    found.sliders = sliders.iter().map(outward).collect();
    Ok(found)
}

/// Checks the number of poses, and that they determine linkages.
fn check_poses(task: &Task, poses: &[Pose], size: f64) -> Result<(), TaskError> {
    if !(3..=5).contains(&poses.len()) {
        return Err(TaskError::Count(poses.len()));
    }
    if !task.fixed_pivots.is_empty() && poses.len() != 3 {
        return Err(TaskError::FixedPivots);
    }
    for (j, pivot) in task.fixed_pivots.iter().enumerate() {
        let is_same = |other: &Complex| (*other - *pivot).norm() <= COINCIDE * size;
        if let Some(i) = task.fixed_pivots[..j].iter().position(is_same) {
            return Err(TaskError::SamePivots([i, j]));
        }
    }
    let turned = |a: &Pose, b: &Pose| (0.5 * (a.angle - b.angle)).sin().abs();
    for j in 0..poses.len() {
        for i in 0..j {
            let apart = (poses[i].at - poses[j].at).norm();
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
    Ok(())
}

/// Best of the linkages that are not alike, up to the number of answers; `good` have their scores in coordinates of the
/// frame.
fn answers_of(
    mut good: Vec<(f64, Linkage, Passage)>,
    task: &Task,
    poses: &[Pose],
    moves: &[Displacement],
    frame: &Frame,
) -> Vec<Answer> {
    good.sort_by(|a, b| b.0.total_cmp(&a.0));
    let is_family = poses.len() < 5 && task.fixed_pivots.is_empty();
    let alike = if is_family { ALIKE } else { SAME } * frame.size;
    let mut answers: Vec<Answer> = Vec::new();
    for (score, linkage, passage) in good {
        if answers.len() == task.answers {
            break;
        }
        let outward = frame.linkage_outward(&linkage);
        if answers.iter().any(|a| is_alike(&a.linkage, &outward, alike)) {
            continue;
        }
        let misfit = |dyad: Option<Dyad>| dyad.map_or(0.0, |d| d.misfit(moves));
        let (first, second) = dyads_in(&linkage);
        answers.push(Answer {
            linkage: Linkage { p: poses[0].at, ..outward },
            moves: poses.iter().map(|p| Displacement::between(poses[0], *p)).collect(),
            passage,
            kind: linkage.kind(),
            rms: 0.0,
            largest: misfit(first).max(misfit(second)) * frame.size,
            score,
        });
    }
    answers
}

/// The two dyads of a linkage.
fn dyads_in(of: &Linkage) -> (Option<Dyad>, Option<Dyad>) {
    let second = match of.guide {
        Guide::Rocker(d) => Dyad::Crank { pivot: d, pin: of.c },
        Guide::Slider(along) => Dyad::Slider { pin: of.c, along },
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
            let cranks = given.filter_map(|p| dyads::crank_about(moves, p)).collect();
            return (cranks, sliders.into_iter().filter(near).collect());
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
