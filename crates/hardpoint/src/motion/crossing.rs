//! Stretch around a change point that was crossed: the motion within it, by polynomials through both ends.
//!
//! At the change point itself position, velocity and acceleration are those of the polynomials, and everything that is
//! solved with J is NaN.

use crate::linalg::{hermite, segment_at};
use crate::number;
use crate::topology::BlockId;

use super::mechanism::{AcceptedPosition, Mechanism, StepRejection};
use super::path::Path;
use super::predictor::Channel;

/// Output times nearer to the change point than this fraction of the stretch use the polynomials, because solutions
/// lose more digits there.
const AT_IT: f64 = 0.2;

/// A stretch around a change point.
#[derive(Clone)]
pub(super) struct Crossing {
    /// Time of the change point.
    pub at: f64,
    /// Path on which it was crossed.
    pub path: Path,
    /// The blocks that are singular there.
    pub blocks: Vec<BlockId>,
    /// Both ends.
    pub ends: [End; 2],
}

/// End of a stretch: its position, and values and derivatives of all channels.
#[derive(Clone)]
pub(super) struct End {
    pub position: AcceptedPosition,
    values: Vec<[f64; 3]>,
}

impl End {
    /// End at the accepted position, the position of the state.
    pub fn of(mechanism: &Mechanism<'_>) -> Self {
        let channels = Channel::all(&mechanism.topology);
        let values = channels.iter().map(|c| c.of(&mechanism.state)).collect();
        Self { position: mechanism.saved.clone(), values }
    }
}

impl Crossing {
    /// Last time of the stretch.
    pub fn to(&self) -> f64 {
        self.ends[1].position.time
    }

    /// Moves the state of a mechanism to time t within the stretch; returns true if that is at the change point, where
    /// J is singular.
    pub fn stand(&self, mechanism: &mut Mechanism<'_>, t: f64) -> Result<bool, StepRejection> {
        let [a, b] = number::both(self.ends.each_ref(), |end| &end.position);
        mechanism.drive(self.path, t)?;
        let h = b.time - a.time;
        let s = (t - a.time) / h;
        let Mechanism { topology, state, .. } = &mut *mechanism;
        state.contacts.copy_from_slice(&if s > 0.5 { b } else { a }.contacts);
        let channels = Channel::all(topology);
        let moved = |k: usize| between(number::both(self.ends.each_ref(), |end| end.values[k]), h, s);
        for (k, channel) in channels.iter().enumerate() {
            channel.put(moved(k)[0], state);
        }
        for &r in &topology.coupler_terms {
            state.near[r.0] = between([a.coupled[r.0], b.coupled[r.0]], h, s)[0];
        }
        if (t - self.at).abs() > AT_IT * h {
            mechanism.solve_within(f64::INFINITY)?;
            mechanism.polish()?;
            mechanism.measure_residuals();
            return Ok(false);
        }
        let [speeds, accelerations, _] = &mut state.motion.speeds;
        for c in topology.unknown_coordinates() {
            let of = |end: &AcceptedPosition| [end.qd[c.0], end.qdd[c.0]];
            [speeds[c.0], accelerations[c.0], _] = between([of(a), of(b)], h, s);
        }
        for (k, channel) in channels.iter().enumerate() {
            // Polynomials of degree five are more accurate; ball joints have none, since their speeds are not rates of
            // components.
            if let Channel::Coordinate(c) = channel {
                [_, speeds[c.0], accelerations[c.0]] = moved(k);
            }
        }
        mechanism.stand_with_rates(&self.blocks);
        Ok(true)
    }
}

/// Value and first two derivatives, at the fraction s of a stretch h, of the polynomial through the value and N - 1
/// derivatives at both ends.
fn between<const N: usize>(ends: [[f64; N]; 2], h: f64, s: f64) -> [f64; 3] {
    segment_at(&hermite(h, N - 1, |end, order| ends[end][order]), s * h)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_their_degree_are_reproduced() {
        let p = |t: f64| [t.powi(5) - 2.0 * t * t, 5.0 * t.powi(4) - 4.0 * t, 20.0 * t.powi(3) - 4.0];
        let q = |t: f64| [t.powi(3) - t, 3.0 * t * t - 1.0, 6.0 * t];
        for s in [0.0, 0.3, 0.5, 1.0] {
            let t = 0.4 + 0.7 * s;
            let found = between([p(0.4), p(1.1)], 0.7, s);
            assert!((0..3).all(|n| (found[n] - p(t)[n]).abs() < 1e-12), "{found:?}");
            let found = between([q(0.4), q(1.1)].map(|[value, first, _]| [value, first]), 0.7, s);
            assert!((found[0] - q(t)[0]).abs() < 1e-14 && (found[1] - q(t)[1]).abs() < 1e-13);
        }
    }
}
