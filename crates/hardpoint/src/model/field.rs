//! Design velocity fields of markers, kept values, points and laws: what one variable, or one driver, changes to first order.

use super::*;
use crate::space::{Real, Twist};

/// The first-order change of a design per unit of one variable: the paper's design
/// velocity, with V and R(theta) U of a marker combined into a body-fixed twist (`docs/theory.md` (8)).
///
/// Every list is in the order of its ids.
#[derive(Clone, Debug, PartialEq)]
pub struct Field<T = f64> {
    /// The markers that move or turn.
    pub markers: Vec<MarkerField<T>>,
    /// The joints whose kept values change, and their rates.
    pub kept: Vec<(JointId, Kept<T>)>,
    /// The points that move, and their velocity in the body's frame.
    pub points: Vec<(PointId, Vec3<T>)>,
    /// The drivers whose laws change: the parameter, and its rate.
    pub laws: Vec<(DriverId, usize, T)>,
    /// The drivers whose values shift at all times, and how fast, m or rad.
    pub shifts: Vec<(DriverId, T)>,
}

/// The design velocity of one marker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarkerField<T = f64> {
    /// Which joint.
    pub joint: JointId,
    /// 0 for the marker on body i, 1 for that on body j.
    pub end: usize,
    /// Body-fixed twist `[R U; V - (R U) x s]` in the body's frame.
    pub twist: Twist<T>,
}

/// Nothing changes.
impl<T> Default for Field<T> {
    fn default() -> Self {
        let (markers, kept, points) = (Vec::new(), Vec::new(), Vec::new());
        Self { markers, kept, points, laws: Vec::new(), shifts: Vec::new() }
    }
}

impl<T: Copy> Field<T> {
    /// The twist of a joint's marker, if it moves.
    pub fn twist_of(&self, joint: JointId, end: usize) -> Option<Twist<T>> {
        let found = self.markers.binary_search_by_key(&(joint, end), |m| (m.joint, m.end));
        found.ok().map(|k| self.markers[k].twist)
    }

    /// Rates of what a joint keeps, if any of it changes.
    pub fn kept_rate(&self, joint: JointId) -> Option<Kept<T>> {
        let found = self.kept.binary_search_by_key(&joint, |k| k.0);
        found.ok().map(|k| self.kept[k].1)
    }
}

impl<T: Real> Field<T> {
    /// That of a driver which moves by itself: its value shifts by one unit per unit.
    pub(crate) fn of_driver(driver: DriverId, witness: T) -> Self {
        Self { shifts: vec![(driver, witness.like(1.0))], ..Self::default() }
    }
}

impl Field {
    /// The fields of several variables, one per lane; lanes without one are at rest. Points are left out.
    pub(crate) fn gather<T: Real>(fields: &[Field], witness: T) -> Field<T> {
        Self::in_lanes(fields, |k| fields.get(k), witness)
    }

    /// The same field in every lane. Points are left out.
    pub(crate) fn spread<T: Real>(&self, witness: T) -> Field<T> {
        Self::in_lanes(std::slice::from_ref(self), |_| Some(self), witness)
    }

    fn in_lanes<'f, T: Real>(
        fields: &'f [Field],
        of: impl Fn(usize) -> Option<&'f Field>,
        witness: T,
    ) -> Field<T> {
        Field {
            markers: union(fields, |f| f.markers.iter().map(|m| (m.joint, m.end)))
                .map(|(joint, end)| {
                    let twist = |k| of(k).and_then(|f| f.twist_of(joint, end)).unwrap_or(Twist::ZERO);
                    MarkerField { joint, end, twist: Twist::gather(witness, twist) }
                })
                .collect(),
            kept: union(fields, |f| f.kept.iter().map(|k| k.0))
                .map(|joint| {
                    let kept = |k| of(k).and_then(|f| f.kept_rate(joint)).unwrap_or_default();
                    (joint, Kept::gather(witness, kept))
                })
                .collect(),
            points: Vec::new(),
            laws: union(fields, |f| f.laws.iter().map(|(d, p, _)| (*d, *p)))
                .map(|(driver, parameter)| {
                    let same = |l: &&(DriverId, usize, f64)| (l.0, l.1) == (driver, parameter);
                    let rate = |k| of(k).map_or(0.0, |f| f.laws.iter().filter(same).map(|l| l.2).sum());
                    (driver, parameter, witness.like_lanes(rate))
                })
                .collect(),
            shifts: union(fields, |f| f.shifts.iter().map(|(d, _)| *d))
                .map(|driver| {
                    let same = |s: &&(DriverId, f64)| s.0 == driver;
                    let rate = |k| of(k).map_or(0.0, |f| f.shifts.iter().filter(same).map(|s| s.1).sum());
                    (driver, witness.like_lanes(rate))
                })
                .collect(),
        }
    }
}

/// The keys of all fields, each once, in order.
fn union<'f, K: Ord + 'f, I: Iterator<Item = K> + 'f>(
    fields: &'f [Field],
    keys: impl Fn(&'f Field) -> I,
) -> impl Iterator<Item = K> {
    fields.iter().flat_map(keys).collect::<std::collections::BTreeSet<K>>().into_iter()
}
