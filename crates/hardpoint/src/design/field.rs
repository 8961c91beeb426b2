//! Design velocities of markers, joint constants, points and laws: the first-order change by one variable or one
//! driver.

use crate::design::JointConstants;
use crate::model::{DriverId, JointId, PointId};
use crate::order::sort_by_index;
use crate::space::{Real, Twist, Vec3};

/// First-order change of a design per unit of one variable: the paper's design velocity, with V and R(theta) U of a
/// marker combined into a body-fixed twist (`docs/theory.md` (8)).
///
/// Every list is in the order of its ids.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignVelocity<T = f64> {
    /// Markers that translate or rotate.
    pub markers: Vec<MarkerVelocity<T>>,
    /// Joints whose constants change, and their rates.
    pub kept: Vec<(JointId, JointConstants<T>)>,
    /// Points that move, and their velocities in the frames of their bodies, m per unit.
    pub points: Vec<(PointId, Vec3<T>)>,
    /// Drivers whose laws change: index of the parameter, and its rate.
    pub laws: Vec<(DriverId, usize, T)>,
    /// Drivers whose values shift by the same amount at all times, and their rates, m or rad per unit.
    pub shifts: Vec<(DriverId, T)>,
}

/// Design velocity of one marker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarkerVelocity<T = f64> {
    /// Joint of the marker.
    pub joint: JointId,
    /// 0 for the marker on body i, 1 for that on body j.
    pub end: usize,
    /// Body-fixed twist `[R U; V - (R U) x s]` in the body's frame.
    ///
    /// Angular part `d(xi)/dtau` of the paper's (3.10), rad per unit; linear part the velocity of the marker's point
    /// that passes the origin of the body's frame, m per unit, so that the marker itself has V = e_v + e_w x s.
    pub twist: Twist<T>,
}

/// Zero design velocity.
impl<T> Default for DesignVelocity<T> {
    fn default() -> Self {
        let (markers, kept, points) = (Vec::new(), Vec::new(), Vec::new());
        Self { markers, kept, points, laws: Vec::new(), shifts: Vec::new() }
    }
}

impl<T: Copy> DesignVelocity<T> {
    /// Returns the twist of a joint's marker; `None` if it does not move.
    pub fn twist_of(&self, joint: JointId, end: usize) -> Option<Twist<T>> {
        // e of (8); null if it is not listed
        let found = self.markers.binary_search_by_key(&(joint, end), |m| (m.joint, m.end));
        found.ok().map(|k| self.markers[k].twist)
    }

    /// Returns the rates of a joint's constants, if any of them changes.
    pub fn kept_rate(&self, joint: JointId) -> Option<JointConstants<T>> {
        let found = self.kept.binary_search_by_key(&joint, |k| k.0);
        found.ok().map(|k| self.kept[k].1)
    }
}

impl<T: Real> DesignVelocity<T> {
    /// Returns the velocity of a single driver whose value shifts by one unit per unit.
    pub(crate) fn of_driver(driver: DriverId) -> Self {
        // L_u = 1 in the driver's row, or S_u = 1 of its coordinate; z = 0 (theory, "One driver alone")
        Self { shifts: vec![(driver, T::one())], ..Self::default() }
    }
}

impl DesignVelocity {
    /// This velocity with openings that follow it, as its last shifts: an equilibrium sets their rates.
    pub(crate) fn with_openings(mut self, openings: &[DriverId]) -> Self {
        self.shifts.extend(openings.iter().map(|d| (*d, 1.0)));
        self
    }

    /// Merges equal parameters of laws, and sorts them by driver and parameter.
    pub(crate) fn with_laws_in_order(mut self) -> Self {
        sort_by_index(&mut self.laws, |(_, parameter, _)| *parameter);
        sort_by_index(&mut self.laws, |(driver, ..)| driver.0);
        self.laws.dedup_by(|next, known| {
            let same = (next.0, next.1) == (known.0, known.1);
            if same {
                known.2 += next.2;
            }
            same
        });
        self
    }
}
