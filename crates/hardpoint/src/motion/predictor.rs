//! Prediction of the next positions from the previous ones.
//!
//! The last three accepted positions, each with its speeds and accelerations, are nine conditions on a polynomial of
//! degree eight per coordinate (Hermite interpolation, in Newton's form). Newton's method then starts so near to the
//! solution that one correction is enough, even eight output times ahead.
//!
//! With the nodes `t_0 t_0 t_0 t_1 t_1 t_1 t_2 t_2 t_2`, the newest first (`docs/theory.md` (27)),
//!
//! ```text
//! p(t) = d_0 + (t - z_0) (d_1 + (t - z_1) (d_2 + ...)),        d_k = [z_0 ... z_k]
//! [z_i ... z_i+k] = ([z_i+1 ... z_i+k] - [z_i ... z_i+k-1]) / (z_i+k - z_i),   or q(k) / k!  where z_i = z_i+k
//! ```

use hardpoint_tape::{LANES, Lanes};

use crate::joint::Freedom;
use crate::number::{array, each};
use crate::space::{Quat, Real, Vec3};
use crate::topology::{CoordinateId, Topology};

use super::kinematics::State;

/// Number of stored positions.
pub(super) const NODES: usize = 3;
/// Conditions per position: value, first and second derivative.
pub(super) const ORDERS: usize = 3;
/// Maximum prediction distance, in distances between two positions; round-off is magnified beyond it.
const FARTHEST: f64 = 8.5;

/// Polynomials through the last accepted positions.
#[derive(Clone)]
pub(super) struct Predictor {
    /// Predicted quantities: unknown coordinates, and quaternions of unknown ball joints.
    channels: Vec<Channel>,
    /// Times of the positions, the newest first; how many there are.
    times: [f64; NODES],
    count: usize,
    /// Per position and channel: value and derivatives.
    values: [Vec<[f64; ORDERS]>; NODES],
    /// Per channel: divided differences.
    /// d_0 ... d_8.
    differences: Vec<[f64; NODES * ORDERS]>,
}

/// A predicted quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Channel {
    Coordinate(CoordinateId),
    /// One of the four components of the quaternion of the ball that begins at a coordinate.
    Ball(CoordinateId, usize),
}

impl Channel {
    /// All of a plan, those of a ball one after the other.
    pub fn all(topology: &Topology) -> Vec<Self> {
        let mut channels = Vec::new();
        for step in topology.links.iter().flat_map(|l| &l.steps) {
            if !topology[step.first].is_unknown() {
                continue;
            }
            match step.freedom {
                Freedom::Ball => channels.extend((0..4).map(|k| Self::Ball(step.first, k))),
                _ => channels.push(Self::Coordinate(step.first)),
            }
        }
        channels
    }

    /// Value, first and second derivative of the channel in a state.
    #[inline(always)]
    pub fn of<T: Real>(self, state: &State<T>) -> [T; ORDERS] {
        let [speeds, accelerations, _] = &state.motion.speeds;
        match self {
            Self::Coordinate(c) => [state.q[c.0], speeds[c.0], accelerations[c.0]],
            Self::Ball(CoordinateId(first), k) => {
                let of = |x: &[T]| Vec3::new(x[first], x[first + 1], x[first + 2]);
                // q. = (0, w) q / 2,    q.. = (0, w.) q / 2 + (0, w) q. / 2,  with w and its rate in axes of the
                // parent's marker
                let (q, w) = (state.balls[first], of(speeds));
                let rate = q.rate(w);
                let second = q.rate(of(accelerations)).plus(rate.rate(w));
                [q.component(k), rate.component(k), second.component(k)]
            }
        }
    }

    /// Writes the predicted value into a state; balls with their last component.
    #[inline(always)]
    pub fn put<T: Real>(self, x: T, state: &mut State<T>) {
        self.save(x, &mut state.q, &mut state.balls);
        if let Self::Ball(CoordinateId(first), 3) = self {
            state.balls[first] = state.balls[first].normalised();
            state.q[first..first + 3].fill(T::zero());
        }
    }

    /// Value of the channel in a saved position.
    pub fn saved(self, q: &[f64], balls: &[Quat<f64>]) -> f64 {
        match self {
            Self::Coordinate(c) => q[c.0],
            Self::Ball(first, k) => balls[first.0].component(k),
        }
    }

    /// Writes the predicted value into a state whose quaternions are already normalised.
    #[inline(always)]
    pub fn save<T: Real>(self, x: T, q: &mut [T], balls: &mut [Quat<T>]) {
        match self {
            Self::Coordinate(c) => q[c.0] = x,
            Self::Ball(first, 0) => balls[first.0].w = x,
            Self::Ball(first, 1) => balls[first.0].v.x = x,
            Self::Ball(first, 2) => balls[first.0].v.y = x,
            Self::Ball(first, _) => balls[first.0].v.z = x,
        }
    }
}

impl Predictor {
    pub fn new(topology: &Topology) -> Self {
        let channels = Channel::all(topology);
        let n = channels.len();
        Self {
            channels,
            times: [0.0; NODES],
            count: 0,
            values: std::array::from_fn(|_| vec![[0.0; ORDERS]; n]),
            differences: vec![[0.0; NODES * ORDERS]; n],
        }
    }

    /// Clears all positions at the start of another path.
    pub fn forget(&mut self) {
        self.count = 0;
    }

    /// Number of channels.
    pub fn len(&self) -> usize {
        self.channels.len()
    }

    /// Value and derivatives of every channel at the position added last.
    pub fn newest(&self) -> impl Iterator<Item = [f64; ORDERS]> {
        self.values[0].iter().copied()
    }

    /// Number of positions that the prediction uses.
    pub fn known(&self) -> usize {
        self.count
    }

    /// Adds the position of the mechanism at time t.
    #[inline(always)]
    pub fn learn(&mut self, t: f64, state: &State<f64>) {
        self.remember(t);
        for (n, channel) in self.channels.iter().enumerate() {
            self.values[0][n] = channel.of(state);
        }
    }

    /// Adds a position from value and derivatives of every channel.
    #[inline(always)]
    pub fn learn_values(&mut self, t: f64, values: impl Iterator<Item = [f64; ORDERS]>) {
        self.remember(t);
        for (n, value) in values.enumerate() {
            self.values[0][n] = value;
        }
    }

    #[inline(always)]
    fn remember(&mut self, t: f64) {
        for n in (1..NODES).rev() {
            self.values.swap(n - 1, n);
            self.times[n] = self.times[n - 1];
        }
        self.times[0] = t;
        self.count = usize::min(self.count + 1, NODES);
    }

    /// Times of the nodes before the newest position, for a prediction `h` beyond it.
    #[inline(always)]
    pub fn nodes(&self, h: f64) -> ([f64; NODES], usize) {
        (each(&self.times, |t| t - self.times[0]), self.counting(h))
    }

    /// Values of a channel at the nodes, the newest first.
    #[inline(always)]
    pub fn known_of(&self, channel: usize) -> [[f64; ORDERS]; NODES] {
        array(|n| self.values[n][channel])
    }

    /// Number of positions to use; older ones are dropped beyond the maximum prediction distance.
    #[inline(always)]
    fn counting(&self, h: f64) -> usize {
        let apart = |n: usize| self.times[n - 1] - self.times[n];
        (1..self.count).take_while(|&n| h <= FARTHEST * apart(n)).count() + 1
    }

    /// Computes divided differences over the newest positions; returns the number of conditions. If `h` beyond the
    /// newest is too far, only that one is used.
    #[inline(always)]
    fn divide(&mut self, h: f64) -> usize {
        let n = ORDERS * self.counting(h);
        let time = |k: usize| self.times[k / ORDERS];
        // 1 / (t_(i+k) - t_i), where those are different positions.
        let mut inverse = [[0.0; NODES * ORDERS]; NODES * ORDERS];
        for k in 1..n {
            for i in 0..n - k {
                if i / ORDERS != (i + k) / ORDERS {
                    inverse[k][i] = 1.0 / (time(i + k) - time(i));
                }
            }
        }
        for (c, d) in self.differences.iter_mut().enumerate() {
            let mut column = [self.values[0][c][0]; NODES * ORDERS];
            for (i, x) in column[..n].iter_mut().enumerate() {
                *x = self.values[i / ORDERS][c][0];
            }
            d[0] = column[0];
            for k in 1..n {
                for i in 0..n - k {
                    column[i] = if i / ORDERS == (i + k) / ORDERS {
                        let x = self.values[i / ORDERS][c][k];
                        // q(k) / k!
                        if k == 2 { x * 0.5 } else { x }
                    } else {
                        (column[i + 1] - column[i]) * inverse[k][i]
                    };
                }
                d[k] = column[0];
            }
        }
        n
    }

    /// Sets the unknowns of a state to their prediction at time t, h beyond the newest position.
    #[inline(always)]
    pub fn set(&mut self, state: &mut State<f64>, t: f64, h: f64) {
        let n = self.divide(h);
        let ahead: [f64; NODES] = array(|k| t - self.times[k]);
        for (channel, d) in self.channels.iter().zip(&self.differences) {
            // Horner's rule, from the innermost factor
            let mut x = d[n - 1];
            for i in (0..n - 1).rev() {
                x = x.times_plus(ahead[i / ORDERS], d[i]);
            }
            channel.put(x, state);
        }
    }
}

/// Relative tolerance of equal steps: the prediction is corrected anyway.
const AS_FAR: f64 = 1e-9;

/// Weights of the nodes at eight times ahead: constant for equal steps.
#[derive(Clone, Debug, Default)]
pub(super) struct Weights {
    nodes: [f64; NODES],
    count: usize,
    ahead: Lanes,
    /// By position, the newest first, and order of its derivative.
    pub of: [Lanes; NODES * ORDERS],
}

impl Weights {
    /// Updates the weights for positions at these times before the newest one, and eight times ahead of it. Returns
    /// true if they changed.
    #[inline(always)]
    pub fn set(&mut self, (nodes, count): ([f64; NODES], usize), ahead: &Lanes) -> bool {
        // p(t) is linear in what is known: p = sum_j weight_j(t) known_j, and the weights are those of last time if
        // steps are equal.
        let near = AS_FAR * ahead.iter().fold(0.0, |most: f64, h| most.max(h.abs()));
        let mut same = self.count == count;
        for n in 0..count {
            same &= (nodes[n] - self.nodes[n]).abs() <= near;
        }
        for lane in 0..LANES {
            same &= (ahead[lane] - self.ahead[lane]).abs() <= near;
        }
        if !same {
            (self.nodes, self.count, self.ahead) = (nodes, count, *ahead);
            self.work_out();
        }
        !same
    }

    /// Computes the Hermite basis polynomials.
    #[inline(never)]
    fn work_out(&mut self) {
        // Relative to the farthest time, so that no power is very large or small.
        let unit = self.ahead.iter().fold(f64::MIN_POSITIVE, |most, h| most.max(h.abs()));
        let n = ORDERS * self.count;
        let node = |i: usize| self.nodes[i / ORDERS] / unit;
        self.of = [[0.0; LANES]; NODES * ORDERS];
        for j in 0..n {
            let (mut column, mut d) = ([0.0; NODES * ORDERS], [0.0; NODES * ORDERS]);
            for (i, x) in column[..n].iter_mut().enumerate() {
                *x = f64::from(u8::from(j == ORDERS * (i / ORDERS)));
            }
            d[0] = column[0];
            for k in 1..n {
                for i in 0..n - k {
                    column[i] = if i / ORDERS == (i + k) / ORDERS {
                        // Known j is 1, all others are 0: the same table of divided differences.
                        let given = f64::from(u8::from(j == ORDERS * (i / ORDERS) + k));
                        if k == 2 { 0.5 * given } else { given }
                    } else {
                        (column[i + 1] - column[i]) / (node(i + k) - node(i))
                    };
                }
                d[k] = column[0];
            }
            // In s = t / unit a rate is known as unit q., an acceleration as unit^2 q..
            let scale = [1.0, unit, unit * unit][j % ORDERS];
            for lane in 0..LANES {
                let s = self.ahead[lane] / unit;
                let x = (0..n - 1).rev().fold(d[n - 1], |x, i| x * (s - node(i)) + d[i]);
                self.of[j][lane] = x * scale;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_reproduce_polynomials_of_as_many_conditions() {
        for count in 1..=NODES {
            let nodes = [0.0, -0.02, -0.05];
            let ahead = std::array::from_fn(|k| 0.005 * (k + 1) as f64);
            let mut weights = Weights::default();
            assert!(weights.set((nodes, count), &ahead));
            assert!(!weights.set((nodes.map(|t| t * (1.0 + 1e-12)), count), &ahead));
            for degree in 0..ORDERS * count {
                // ((t + 0.1) / 0.1)^degree with its derivatives.
                let power = |t: f64, order: usize| {
                    let factor: f64 = (0..order).map(|k| (degree as f64 - k as f64) / 0.1).product();
                    factor * (1.0 + t / 0.1).powi(i32::try_from(degree).unwrap() - order as i32)
                };
                for (lane, &t) in ahead.iter().enumerate() {
                    let all =
                        (0..ORDERS * count).map(|j| (nodes[j / ORDERS], j % ORDERS, weights.of[j][lane]));
                    let found: f64 = all.map(|(t, order, w)| w * power(t, order)).sum();
                    assert!((found - power(t, 0)).abs() < 1e-10, "{count} {degree} {t}: {found}");
                }
            }
        }
    }
}
