//! A curve over time between its axes.

use hardpoint_report::figures::rounded;

use super::paper::{BLACK, BLUE, Face, GREY, PALE, Paper, SMALL, STRONG};

/// Width and height with labels.
pub const SIZE: (f32, f32) = (240.0, 146.0);
/// Room left of, below, right of and above the curve.
const AROUND: [f32; 4] = [46.0, 26.0, 8.0, 16.0];
/// Minimum number of round values with a mark on an axis.
const MARKS: f64 = 4.0;
/// Maximum number of intervals of a curve, each drawn with its lowest and its highest point: more cannot be
/// distinguished on paper.
const STRETCHES: usize = 600;
/// Space above and below a curve, as a fraction of its height.
const ROOM: f64 = 0.05;
/// A curve whose relative deviation from its mean is below this is drawn as a line: the rest is round-off.
const FLAT: f64 = 1e-9;

/// A curve with its name and unit.
pub struct Plot<'a> {
    pub name: &'a str,
    pub unit: &'a str,
    pub times: &'a [f64],
    pub values: &'a [f64],
}

impl Plot<'_> {
    /// Draws the plot with its lower left corner here.
    pub fn draw(&self, paper: &mut Paper, [left, bottom]: [f32; 2]) {
        let (x, y) = (left + AROUND[0], bottom + AROUND[1]);
        let (width, height) = (SIZE.0 - AROUND[0] - AROUND[2], SIZE.1 - AROUND[1] - AROUND[3]);
        let title = fitting(STRONG, self.name, SIZE.0 - AROUND[2]);
        paper.text(STRONG, BLACK, [left, y + height + 5.0], false, &title);
        let over = |at: [f64; 2], length: f32, v: f64| ((v - at[0]) / (at[1] - at[0])) as f32 * length;
        let time = range(self.times);
        let values = range(self.values).map(|[low, high]| {
            let room = ROOM * (high - low);
            [low - room, high + room]
        });
        let (Some(time), Some(values)) = (time, values) else {
            paper.text(SMALL, GREY, [x, y + height / 2.0], false, "no value at any time");
            return;
        };
        for (mark, label) in labelled(values) {
            let at = y + over(values, height, mark);
            paper.lines(PALE, 0.5, [[x, at], [x + width, at]]);
            paper.text(SMALL, GREY, [x - 4.0 - SMALL.width(&label), at - 2.4], false, &label);
        }
        for (mark, label) in labelled(time) {
            let at = x + over(time, width, mark);
            paper.lines(PALE, 0.5, [[at, y], [at, y + height]]);
            paper.text(SMALL, GREY, [at - SMALL.width(&label) / 2.0, y - 9.0], false, &label);
        }
        paper.lines(GREY, 0.7, [[x, y + height], [x, y], [x + width, y]]);
        let below = "t [s]";
        paper.text(SMALL, BLACK, [x + (width - SMALL.width(below)) / 2.0, y - 19.0], false, below);
        let beside = if self.unit == "1" { "plain number".into() } else { format!("[{}]", self.unit) };
        let middle = y + (height - SMALL.width(&beside)) / 2.0;
        paper.text(SMALL, BLACK, [left + 7.0, middle], true, &beside);
        let place =
            |k: usize| [x + over(time, width, self.times[k]), y + over(values, height, self.values[k])];
        paper.lines(BLUE, 1.1, self.shown().into_iter().map(place));
    }

    /// Indices of the points that are drawn.
    fn shown(&self) -> Vec<usize> {
        let all = self.values.len();
        if all <= 2 * STRETCHES {
            return (0..all).collect();
        }
        let stretch = |s: usize| {
            let points = s * all / STRETCHES..(s + 1) * all / STRETCHES;
            // Gaps remain.
            let gap = points.clone().find(|k| !self.values[*k].is_finite());
            let by = |a: &usize, b: &usize| self.values[*a].total_cmp(&self.values[*b]);
            let known = || points.clone().filter(|k| self.values[*k].is_finite());
            let mut list: Vec<usize> =
                known().min_by(by).into_iter().chain(known().max_by(by)).chain(gap).collect();
            list.sort_unstable();
            list.dedup();
            list
        };
        (0..STRETCHES).flat_map(stretch).collect()
    }
}

/// Truncates a text to this width.
fn fitting(face: Face, text: &str, width: f32) -> String {
    if face.width(text) <= width {
        return text.to_owned();
    }
    let mut shown = String::new();
    for letter in text.chars() {
        if face.width(&format!("{shown}{letter}\u{2026}")) > width {
            break;
        }
        shown.push(letter);
    }
    shown + "\u{2026}"
}

/// Range of the numbers, widened if they are equal; `None` if there is no number.
fn range(values: &[f64]) -> Option<[f64; 2]> {
    let known = || values.iter().copied().filter(|v| v.is_finite());
    let (low, high) = (known().reduce(f64::min)?, known().reduce(f64::max)?);
    let size = low.abs().max(high.abs());
    if high - low > FLAT * size {
        return Some([low, high]);
    }
    let room = if size > 0.0 { 0.5 * size } else { 1.0 };
    Some([low - room, high + room])
}

/// Round numbers between two: multiples of 1, 2 or 5 of a power of ten.
fn marks([low, high]: [f64; 2]) -> Vec<f64> {
    let rough = (high - low) / MARKS;
    let power = 10f64.powf(rough.log10().floor());
    let step = [5.0, 2.0, 1.0].into_iter().map(|k| k * power).find(|step| *step <= rough).unwrap_or(power);
    let (first, last) = ((low / step).ceil(), (high / step).floor());
    // Multiples of the step instead of a running sum, and no -0.
    (0..=(last - first) as usize).map(|k| (first + k as f64) * step + 0.0).collect()
}

/// Marks with their numbers, with enough digits to distinguish them.
fn labelled(range: [f64; 2]) -> Vec<(f64, String)> {
    let marks = marks(range);
    let greatest = marks.iter().fold(0f64, |all, m| all.max(m.abs()));
    let step = marks.get(1).map_or(greatest, |second| second - marks[0]);
    let digits = if greatest > 0.0 { (greatest / step).log10().ceil() as usize + 1 } else { 1 };
    marks.into_iter().map(|mark| (mark, rounded(mark, digits.max(2)))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_round_and_within_the_curve() {
        assert_eq!(marks([0.0, 1.0]), [0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0]);
        assert_eq!(marks([-37.0, 81.0]), [-20.0, 0.0, 20.0, 40.0, 60.0, 80.0]);
        for scale in [1e-7, 3.0, 4.2e5] {
            let found = marks([-1.7 * scale, 2.3 * scale]);
            assert!((4..=10).contains(&found.len()), "{found:?}");
            assert!(found.iter().all(|m| (-1.7 * scale..=2.3 * scale).contains(m)), "{found:?}");
        }
    }

    #[test]
    fn numbers_at_marks_tell_them_apart() {
        let labels = |range| labelled(range).into_iter().map(|(_, label)| label).collect::<Vec<_>>();
        assert_eq!(labels([0.0, 1.0]), ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
        assert_eq!(
            labels([486.9001, 486.9012]),
            ["486.9002", "486.9004", "486.9006", "486.9008", "486.901", "486.9012"]
        );
    }

    #[test]
    fn a_constant_has_room_around_it_and_no_number_has_none() {
        assert_eq!(range(&[2.0, 2.0, f64::NAN]), Some([1.0, 3.0]));
        assert_eq!(range(&[0.0]), Some([-1.0, 1.0]));
        assert_eq!(range(&[f64::NAN]), None);
    }

    #[test]
    fn of_a_long_curve_peaks_and_gaps_are_drawn() {
        let mut values: Vec<f64> = (0..10_000).map(|k| (f64::from(k) * 0.37).sin() * 0.1).collect();
        (values[5_003], values[7_001]) = (9.0, f64::NAN);
        let times: Vec<f64> = (0..10_000).map(f64::from).collect();
        let shown = Plot { name: "x", unit: "mm", times: &times, values: &values }.shown();
        assert!(shown.len() <= 2 * STRETCHES + 1 && shown.contains(&5_003) && shown.contains(&7_001));
        assert!(shown.is_sorted());
    }
}
