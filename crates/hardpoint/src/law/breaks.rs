//! Times at which a law may jump, as its kind finds them.

use crate::order::sort_by_number;

/// Breaks closer together than this, relative to the requested times, are merged.
pub(super) const SAME_TIME: f64 = 1e-12;

/// A time at which a law may jump, bracketed by two times between which the law is not evaluated.
#[derive(Clone, Copy, Debug)]
pub(super) struct Break {
    pub time: f64,
    pub before: f64,
    pub after: f64,
}

impl Break {
    /// A break at an exactly known time.
    pub fn exactly(time: f64) -> Self {
        Self { time, before: time, after: time }
    }

    /// The time, with the two times that bracket it.
    pub fn bracket(self) -> [f64; 3] {
        [self.before, self.time, self.after]
    }

    /// The last time before it, and the first after it.
    pub fn sides(self) -> [f64; 2] {
        let [before, after] = [self.before.min(self.time), self.after.max(self.time)];
        [
            if before < self.time { before } else { before.next_down() },
            if after > self.time { after } else { after.next_up() },
        ]
    }

    /// True if the break is inside a law that begins at `start` and ends at `end`.
    pub fn is_between(self, start: f64, end: f64) -> bool {
        let room = SAME_TIME * self.time.abs().max(1.0);
        self.time > start + room && self.time < end - room
    }

    /// This break in a law that starts later, with tolerance for the rounding of the difference of times.
    pub fn delayed(self, by: f64) -> Self {
        let room = 4.0 * f64::EPSILON * self.time.abs().max(by.abs());
        Self { time: self.time + by, before: self.before + by - room, after: self.after + by + room }
    }
}

/// Breaks in order of time; those at the same time are merged.
pub(super) fn merged(mut breaks: Vec<Break>, same_time: f64) -> Vec<Break> {
    sort_by_number(&mut breaks, |at| at.time);
    let mut merged: Vec<Break> = Vec::new();
    for at in breaks {
        match merged.last_mut() {
            Some(last) if at.time - last.time <= same_time => {
                last.before = last.before.min(at.before);
                last.after = last.after.max(at.after);
            }
            _ => merged.push(at),
        }
    }
    merged
}
