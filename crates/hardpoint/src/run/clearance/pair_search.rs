//! Search for the minima and contacts of a pair of shapes, from its distances at the times that were solved so far.

use crate::run::curve::SampledCurve;

use super::curves::{Curves, FLAT, Plateau, pieces};
use super::{MinimumPlace, SAME_TIME, ShapeDistance, index_of};

/// A minimum or contact is located if a step of Newton's method is below this fraction of the motion: positions are
/// solved to 1e-12 of the mechanism's size.
const LOCATED: f64 = 1e-11;
/// Interval, as a fraction of the motion, in which a distance with a smooth minimum is the same up to round-off: if it
/// is shorter, the minimum is a kink, and nearer to one side of it.
const OF_KINK: f64 = 3e-8;
/// Rise of a distance without rates between two minima, as a fraction of the mechanism's size, below which the higher
/// one is a dip: searches along both cores find the deepest point of solids in each other to less than this.
const SEARCHED: f64 = 1e-6;

/// Events of a motion, and times at which it must be solved to locate others.
#[derive(Default)]
pub(super) struct Located {
    pub events: Vec<Event>,
    pub add: Vec<f64>,
    /// Per pair: true if its distance does not change.
    pub constant: Vec<bool>,
}

pub(super) struct Event {
    pub pair: usize,
    pub time: f64,
    /// At a kink, the time on its other side.
    pub kink: Option<f64>,
    pub kind: EventKind,
}

#[derive(Clone, Copy)]
pub(super) enum EventKind {
    Minimum(MinimumPlace),
    /// True if the shapes touch from there on.
    Contact(bool),
}

impl Curves<'_> {
    /// The minima and contacts that are located, and the times at which the motion must be solved for the others. After
    /// the last pass (`is_last`), contacts are at the nearest times that were solved.
    pub fn locate(&self, plateaus: &[Vec<Plateau>], overlaps: &[Vec<Plateau>], is_last: bool) -> Located {
        let mut located = Located { constant: vec![false; plateaus.len()], ..Located::default() };
        for (p, (plateaus, overlaps)) in plateaus.iter().zip(overlaps).enumerate() {
            self.locate_pair(p, &[&plateaus[..], overlaps].concat(), is_last, &mut located);
        }
        located
    }

    fn locate_pair(&self, p: usize, plateaus: &[Plateau], is_last: bool, located: &mut Located) {
        let Some(mut search) = PairSearch::new(self, p, plateaus) else { return };
        search.divide_fast_intervals();
        if self.is_same(p) {
            located.constant[p] = true;
            search.note_minimum(self.times[0], MinimumPlace::Start);
        } else {
            search.find_minima_at_ends();
            search.find_minima_of_plateaus();
            search.find_minima_by_rates();
            search.find_minima_by_values();
            search.find_contacts(is_last);
            search.find_jump();
        }
        located.events.extend(search.kinks.into_iter().chain(search.events));
        located.add.extend(search.add);
    }
}

/// Search for the minima and contacts of one pair.
struct PairSearch<'c> {
    curves: &'c Curves<'c>,
    pair: usize,
    times: &'c [f64],
    samples: &'c [ShapeDistance],
    /// Parts of the motion in which the distance does not change.
    plateaus: &'c [Plateau],
    /// Index of the last time.
    last: usize,
    /// Index of the time at which the distance is least.
    lowest: usize,
    /// Duration of the motion, s.
    span: f64,
    curve: SampledCurve<'c, f64>,
    /// Minima at which the rate jumps.
    kinks: Vec<Event>,
    /// All other events.
    events: Vec<Event>,
    /// Times at which the motion must be solved.
    add: Vec<f64>,
}

impl<'c> PairSearch<'c> {
    /// `None` if no distance is known. One that is not known has no place in any order: no times are added to look for
    /// its minimum.
    fn new(curves: &'c Curves<'c>, pair: usize, plateaus: &'c [Plateau]) -> Option<Self> {
        let (times, samples) = (&curves.times[..], &curves.samples[pair][..]);
        let last = samples.len().checked_sub(1)?;
        let value = |k: usize| samples[k].distance[0];
        let known = (0..=last).filter(|k| value(*k).is_finite());
        let lowest = known.reduce(|a, b| if value(b) < value(a) { b } else { a })?;
        let curve = SampledCurve {
            times,
            orders: 3,
            // Those where features change are located.
            kinks: &[],
            is_located: false,
            values: samples.iter().map(|s| s.distance).collect(),
        };
        let span = times[last] - times[0];
        let (kinks, events, add) = (Vec::new(), Vec::new(), Vec::new());
        Some(Self { curves, pair, times, samples, plateaus, last, lowest, span, curve, kinks, events, add })
    }

    fn value(&self, k: usize) -> f64 {
        self.samples[k].distance[0]
    }

    /// True if both ends of interval k have rates.
    fn has_rates(&self, k: usize) -> bool {
        self.samples[k..k + 2].iter().all(|sample| sample.distance[1].is_finite())
    }

    /// The plateau that interval k is part of.
    fn level(&self, k: usize) -> Option<&'c Plateau> {
        let same = |x: f64, plateau: &Plateau| (x - plateau.value).abs() <= FLAT * self.curves.size;
        self.plateaus.iter().find(|plateau| {
            plateau.within[0] <= self.times[k]
                && self.times[k + 1] <= plateau.within[1]
                && same(self.value(k), plateau)
                && same(self.value(k + 1), plateau)
        })
    }

    fn is_level(&self, k: usize) -> bool {
        self.level(k).is_some()
    }

    /// True if interval k is so short that further times in it gain nothing.
    fn is_narrow(&self, k: usize) -> bool {
        self.times[k + 1] - self.times[k] <= LOCATED * self.span
    }

    fn middle(&self, k: usize) -> f64 {
        0.5 * (self.times[k] + self.times[k + 1])
    }

    fn note(&mut self, time: f64, kind: EventKind) {
        self.events.push(Event { pair: self.pair, time, kink: None, kind });
    }

    fn note_minimum(&mut self, time: f64, place: MinimumPlace) {
        self.note(time, EventKind::Minimum(place));
    }

    /// Adds times in intervals in which the bodies turn far, or other parts of the shapes may pass each other.
    fn divide_fast_intervals(&mut self) {
        self.add.extend(self.curves.turning(self.pair));
        self.add.extend(self.curves.unseen(self.pair, &|k| !self.has_rates(k)));
    }

    /// Minima at the first and the last time.
    fn find_minima_at_ends(&mut self) {
        let last = self.last;
        if last == 0 {
            return;
        }
        // Where there is no rate, or it is zero, the next distance decides.
        let leads_down = |end: usize, next: usize, sense: f64| {
            let rate = sense * self.samples[end].distance[1];
            if rate.is_finite() && rate != 0.0 { rate < 0.0 } else { self.value(next) < self.value(end) }
        };
        let is_lowest = |k: usize, or: bool| self.level(k).map_or(or, |plateau| plateau.is_lowest);
        let at_start = self.value(0).is_finite() && is_lowest(0, !leads_down(0, 1, 1.0));
        let at_end = self.value(last).is_finite() && is_lowest(last - 1, !leads_down(last, last - 1, -1.0));
        if at_start {
            self.note_minimum(self.times[0], MinimumPlace::Start);
        }
        if at_end {
            self.note_minimum(self.times[last], MinimumPlace::End);
        }
    }

    fn find_minima_of_plateaus(&mut self) {
        for plateau in self.plateaus.iter().filter(|plateau| plateau.is_lowest && plateau.is_inside) {
            self.note_minimum(plateau.from, MinimumPlace::Inside);
        }
    }

    /// Minima between times with rates: those at which the motion was solved, and times near to the others.
    fn find_minima_by_rates(&mut self) {
        let mut found: Vec<f64> = Vec::new();
        for k in (1..self.last).filter(|k| self.is_minimum(*k)) {
            if found.last().is_none_or(|t| self.times[k] - t > SAME_TIME * self.span) {
                found.push(self.times[k]);
            }
        }
        for k in 0..self.last {
            if self.has_rates(k) && !self.is_level(k) {
                self.approach_minima(k, &found);
            }
        }
        found.into_iter().for_each(|t| self.note_minimum(t, MinimumPlace::Inside));
    }

    /// True if time k is within a step of Newton's method from a minimum.
    fn is_minimum(&self, k: usize) -> bool {
        let [_, rate, acceleration] = self.samples[k].distance;
        // Where the distance does not change over a part of the motion, the sign of both is that of round-off.
        let is_curved = acceleration * self.span * self.span > FLAT * self.curves.size;
        let is_beside_level = self.is_level(k - 1) || self.is_level(k);
        is_curved && !is_beside_level && rate.abs() <= LOCATED * self.span * acceleration
    }

    /// Adds the times of the minima of the polynomial in interval k, except for those that are found already. Where the
    /// interval is narrow, the rate jumps.
    fn approach_minima(&mut self, k: usize, found: &[f64]) {
        let h = SAME_TIME * self.span;
        let at = |t: f64| self.curve.at(k, t)[0];
        let mut candidates = self.curve.turns(k);
        candidates.retain(|t| at(t - h) >= at(*t) && at(t + h) >= at(*t));
        let rates = [k, k + 1].map(|k| self.samples[k].distance[1]);
        let changes = rates[0] < 0.0 && rates[1] > 0.0;
        if changes && candidates.is_empty() {
            candidates.push(self.middle(k));
        }
        candidates.retain(|t| found.iter().all(|f| (f - t).abs() > h));
        for t in candidates {
            if self.is_narrow(k) {
                self.note_kink(k, rates);
                continue;
            }
            self.add.push(t);
            if changes {
                self.add.push(self.middle(k));
            }
        }
    }

    /// Adds a kink within interval k, unless the rates are round-off on both sides: then the distance is constant.
    fn note_kink(&mut self, k: usize, [from, to]: [f64; 2]) {
        if f64::max(from.abs(), to.abs()) * self.span <= FLAT * self.curves.size {
            return;
        }
        let [near, far] = if self.value(k) <= self.value(k + 1) { [k, k + 1] } else { [k + 1, k] };
        let kind = EventKind::Minimum(MinimumPlace::Inside);
        let [time, other] = [near, far].map(|k| self.times[k]);
        self.kinks.push(Event { pair: self.pair, time, kink: Some(other), kind });
    }

    /// Minima by values alone, where a rate is missing.
    fn find_minima_by_values(&mut self) {
        if (0..self.last).all(|k| self.has_rates(k)) {
            return;
        }
        let steps: Vec<usize> = (0..=self.last).collect();
        for run in self.curves.equal(self.samples, &steps) {
            if let Some(lowest) = self.minimum_of_values(run) {
                self.approach_minimum_of_values(run, lowest);
            }
        }
    }

    /// Lowest time of a run of equal distances, if it is a minimum that has no rates.
    fn minimum_of_values(&self, run: &[usize]) -> Option<usize> {
        let (last, value) = (self.last, |k: usize| self.value(k));
        let (first, end) = (run[0], run[run.len() - 1]);
        // A minimum over a part of the motion is that of its plateau.
        if first == 0 || end == last || (first - 1..=end).any(|k| self.is_level(k)) {
            return None;
        }
        // Rates lead to the minimum unless one is missing on its side of the lowest time.
        let lower = |a: usize, b: usize| if value(b) < value(a) { b } else { a };
        let lowest = (first..=end).reduce(lower).unwrap_or(first);
        let side = if self.samples[lowest].distance[1] > 0.0 { lowest - 1 } else { lowest };
        if self.has_rates(side) || self.is_minimum(lowest) {
            return None;
        }
        if !(value(first - 1) >= value(first) && value(end + 1) >= value(end)) {
            return None;
        }
        // Searches for the deepest point leave small dips.
        let is_dip = |beside: &mut dyn Iterator<Item = usize>| {
            rise_to_lower(beside.map(value), value(first)) <= SEARCHED * self.curves.size
        };
        let is_noise =
            !self.curves.at_rest && (is_dip(&mut (0..first).rev()) || is_dip(&mut (end + 1..=last)));
        (!is_noise).then_some(lowest)
    }

    /// Adds times beside a minimum of values, or the minimum itself if it is located.
    fn approach_minimum_of_values(&mut self, run: &[usize], lowest: usize) {
        let (times, located) = (self.times, LOCATED * self.span);
        let (first, end) = (run[0], run[run.len() - 1]);
        let (before, after) = (times[first - 1], times[end + 1]);
        let is_narrow = after - before <= located;
        match run.len() {
            1 if !is_narrow => {
                self.add.extend(pieces(before, times[first]));
                self.add.extend(pieces(times[first], after));
            }
            // On both sides of a minimum, or at the ends of a part in which the distance does not change: a smooth
            // minimum ends like this long before its interval is narrow, one at a kink does not.
            2 if !is_narrow => self.add.push(0.5 * (times[first] + times[end])),
            _ => {
                let [left, right] = [lowest - 1, lowest + 1].map(|k| times[k]);
                let is_kink = times[end] - times[first] < OF_KINK * self.span;
                if is_kink && right - left > located {
                    self.add.extend([left, right].map(|t| 0.5 * (t + times[lowest])));
                } else {
                    self.note_minimum(times[lowest], MinimumPlace::Inside);
                }
            }
        }
    }

    /// Contacts: intervals in which the sign changes.
    fn find_contacts(&mut self, is_last: bool) {
        for k in 0..self.last {
            let [a, b] = [k, k + 1].map(|k| self.value(k));
            if (a > 0.0) == (b > 0.0) || a.is_nan() || b.is_nan() {
                continue;
            }
            // Overlaps of unknown depth have neither a distance nor a rate: only the other side leads to the contact.
            let is_deep = [k, k + 1].map(|k| self.samples[k].is_deep());
            let other_is_nearer = if is_deep == [false; 2] { a.abs() > b.abs() } else { is_deep[0] };
            let near = k + usize::from(other_is_nearer);
            if is_last || self.is_contact(near) || self.is_narrow(k) {
                self.note(self.times[near], EventKind::Contact(b <= 0.0));
            } else if is_deep != [false; 2] {
                self.approach_overlap(k, near);
            } else {
                self.approach_contact(k);
            }
        }
    }

    /// True if time k is within a step of Newton's method from a contact.
    fn is_contact(&self, k: usize) -> bool {
        let [d, rate, _] = self.samples[k].distance;
        d.abs() <= LOCATED * self.span * rate.abs() || d.abs() <= f64::EPSILON * self.curves.size
    }

    /// Adds times in interval k, of which one end is in an overlap of unknown depth: Newton's method from the other
    /// end, `near`, to just before the contact.
    fn approach_overlap(&mut self, k: usize, near: usize) {
        let times = self.times;
        let [d, rate, _] = self.samples[near].distance;
        let step = -d / rate;
        let t = times[near] + step - 0.5 * LOCATED * self.span * step.signum();
        self.add.extend(Some(t).filter(|t| times[k] < *t && *t < times[k + 1]));
        self.add.extend(pieces(times[k], times[k + 1]));
    }

    /// Adds the time in interval k at which the polynomial is zero.
    fn approach_contact(&mut self, k: usize) {
        let touches_later = self.value(k) > 0.0;
        let [mut low, mut high] = [self.times[k], self.times[k + 1]];
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if (self.curve.at(k, middle)[0] > 0.0) == touches_later { low = middle } else { high = middle }
        }
        self.add.push(0.5 * (low + high));
        // Without rates, the line through two distances meets zero on one side of a contact only.
        if self.times[k + 1] - self.times[k] > SAME_TIME * self.span || !self.has_rates(k) {
            self.add.push(self.middle(k));
        }
    }

    /// A distance may jump to its least value, which then is that of a solved time.
    fn find_jump(&mut self) {
        let (lowest, last) = (self.lowest, self.last);
        let found = self.events.iter().chain(&self.kinks);
        let minima = found.filter(|event| matches!(event.kind, EventKind::Minimum(_)));
        let at_minimum =
            |event: &Event| index_of(self.times, event.time).map_or(f64::INFINITY, |k| self.value(k));
        let least = minima.map(at_minimum).fold(f64::INFINITY, f64::min);
        if self.value(lowest) < least - FLAT * self.curves.size {
            let place = match lowest {
                0 => MinimumPlace::Start,
                k if k == last => MinimumPlace::End,
                _ => MinimumPlace::Inside,
            };
            self.note_minimum(self.times[lowest], place);
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::ShapeId;
    use crate::space::Vec3;

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
