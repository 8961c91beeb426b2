//! Distances of pairs of shapes at the times that were solved so far, and times at which they must be solved as well.

use crate::model::{BodyId, Model, ShapeId};
use crate::motion::Motion;
use crate::number;
use crate::run::Analysis;

use super::posed_motion::{PosedMotion, Reach, turning_times};
use super::{CONSTANT, ShapeDistance, index_of};

/// Pieces into which an interval is divided where its ends do not indicate a place within.
const PIECES: usize = 4;
/// Distances that differ by less than this fraction of the mechanism's size are the same: round-off of positions.
pub(super) const FLAT: f64 = 4e-12;
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
/// The same in search of the deepest overlap: depths may be level over a large part of the motion.
const NARROW_DEPTH: f64 = 1e-3;

/// Distances of all pairs at the times of a motion that were solved so far.
pub(super) struct Curves<'m> {
    pub pairs: &'m [[ShapeId; 2]],
    /// Size of the mechanism, m.
    pub size: f64,
    /// True at an equilibrium, where nothing has a rate.
    pub at_rest: bool,
    pub times: Vec<f64>,
    /// Per pair and time.
    pub samples: Vec<Vec<ShapeDistance>>,
    /// The same; `None` for pairs whose distance has a continuous rate.
    pub reaches: Vec<Vec<Option<Reach>>>,
    /// The same: angular speed of the bodies relative to each other, rad/s.
    pub turning: Vec<Vec<f64>>,
}

/// Part of a motion in which the distance of a pair does not change.
#[derive(Clone, Copy)]
pub(super) struct Plateau {
    /// Times around it, between which it begins and ends.
    pub within: [f64; 2],
    /// The first time that is known to be in it.
    pub from: f64,
    /// The distance, m.
    pub value: f64,
    /// True if the distance is greater on both sides, or the shapes overlap at a depth that is not known.
    pub is_lowest: bool,
    /// True if it begins and ends within the motion.
    pub is_inside: bool,
}

impl<'m> Curves<'m> {
    pub fn new(model: &'m Model, pairs: &'m [[ShapeId; 2]]) -> Self {
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
    pub fn add(&mut self, analysis: &Analysis<'_>, design: &[f64], motion: &Motion) {
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
    pub fn turning(&self, p: usize) -> Vec<f64> {
        turning_times(&self.times, &self.turning[p])
    }

    /// Times within intervals in which a pair may be nearer, or deeper in each other, than at any time so far, or touch
    /// unseen, since other parts of its shapes may pass each other there.
    pub fn unseen(&self, p: usize, is_left_out: &dyn Fn(usize) -> bool) -> Vec<f64> {
        let (times, samples, reaches) = (&self.times, &self.samples[p], &self.reaches[p]);
        let Some(last) = samples.len().checked_sub(1) else { return Vec::new() };
        let span = times[last] - times[0];
        let least = samples.iter().map(|s| s.distance[0]).fold(f64::INFINITY, f64::min);
        let is_unseen = |k: &usize| {
            let (Some(before), Some(after)) = (reaches[*k], reaches[k + 1]) else { return false };
            let ends = &samples[*k..k + 2];
            let are_apart = ends.iter().all(|s| s.distance[0] > 0.0);
            let is_excluded = match are_apart {
                true => is_left_out(*k),
                false => self.at_rest || ends.iter().any(ShapeDistance::is_deep),
            };
            if is_excluded {
                return false;
            }
            let (least, narrow) = if are_apart { (least.max(0.0), NARROW) } else { (least, NARROW_DEPTH) };
            let h = times[k + 1] - times[*k];
            let way = SPEEDS * before.speed.max(after.speed) * h;
            let [from, to] = number::both([0, 1], |n| ends[n].distance);
            // The distance changes by no more than the shapes move.
            let is_possible = h > narrow * span && 0.5 * (from[0] + to[0] - way) < least;
            is_possible && (way > PASSING * after.radius || !(cubic_error([from, to], h) <= SMOOTH * way))
        };
        (0..last).filter(is_unseen).flat_map(|k| pieces(times[k], times[k + 1])).collect()
    }

    /// Index of the time at which the least distance of all pairs is greatest (sign 1) or least (-1) in a window.
    pub fn extremum(&self, sign: f64, window: Option<[f64; 2]>) -> Option<usize> {
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
    pub fn hidden(&self, sign: f64, window: Option<[f64; 2]>) -> Vec<f64> {
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
    pub fn plateaus(&self, p: usize) -> Vec<Plateau> {
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
    pub fn is_same(&self, p: usize) -> bool {
        let known = || self.samples[p].iter().map(|s| s.distance[0]);
        let [low, high] = [known().fold(f64::INFINITY, f64::min), known().fold(f64::NEG_INFINITY, f64::max)];
        high - low <= CONSTANT * self.size
    }

    /// Parts of the motion in which shapes overlap at a depth that is not known, by pair, as far as they are known: a
    /// short one may be seen at one time only.
    pub fn overlaps(&self) -> Vec<Vec<Plateau>> {
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
    pub fn equal<'s>(
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
}

/// Difference of a distance in an interval of this length from the cubic polynomial through distances and rates at its
/// ends.
fn cubic_error([from, to]: [[f64; 3]; 2], h: f64) -> f64 {
    // Accelerations of the polynomial at both ends.
    let rise = 6.0 * (to[0] - from[0]) / h;
    let bends = [(rise - 4.0 * from[1] - 2.0 * to[1]) / h, (4.0 * to[1] + 2.0 * from[1] - rise) / h];
    (bends[0] - from[2]).abs().max((bends[1] - to[2]).abs()) * h * h
}

/// Times that divide an interval into [`PIECES`].
pub(super) fn pieces(from: f64, to: f64) -> impl Iterator<Item = f64> {
    (1..PIECES).map(move |n| from + (to - from) * n as f64 / PIECES as f64)
}
