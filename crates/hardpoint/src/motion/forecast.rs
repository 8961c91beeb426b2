//! Where the mechanism will be next, from where it has been.
//!
//! The last three accepted positions, each with its speeds and accelerations, are nine conditions on a polynomial of degree
//! eight per coordinate (Hermite's interpolation, in Newton's form). Newton's method then starts so near to the solution that
//! one correction is enough, also eight output times ahead.

use crate::joint::Freedom;
use crate::space::{Quat, Real, Vec3};
use crate::topology::{Source, Topology};

use super::kinematics::State;

/// Positions that are kept.
const NODES: usize = 3;
/// Conditions per position: value, first and second derivative.
const ORDERS: usize = 3;
/// Farther ahead than this many times the distance between two positions, their round-off would be magnified.
const FARTHEST: f64 = 8.5;

/// Polynomials through the last accepted positions.
#[derive(Clone)]
pub(super) struct Forecast<T> {
    /// What is foreseen: unknown coordinates, and quaternions of unknown balls.
    channels: Vec<Channel>,
    /// Times of the positions, the newest first; how many there are.
    times: [f64; NODES],
    count: usize,
    /// Per position and channel: value and derivatives.
    values: [Vec<[T; ORDERS]>; NODES],
    /// Per channel: divided differences.
    differences: Vec<[T; NODES * ORDERS]>,
}

#[derive(Clone, Copy)]
enum Channel {
    Coordinate(usize),
    /// One of the four components of the quaternion of the ball that begins at a coordinate.
    Ball(usize, usize),
}

impl<T: Real> Forecast<T> {
    pub fn new(topology: &Topology, witness: T) -> Self {
        let mut channels = Vec::new();
        for step in topology.links.iter().flat_map(|l| &l.steps) {
            if matches!(topology.coordinates[step.first].source, Source::Driven(_)) {
                continue;
            }
            match step.freedom {
                Freedom::Ball => channels.extend((0..4).map(|k| Channel::Ball(step.first, k))),
                _ => channels.push(Channel::Coordinate(step.first)),
            }
        }
        let n = channels.len();
        let o = witness.zero();
        Self {
            channels,
            times: [0.0; NODES],
            count: 0,
            values: std::array::from_fn(|_| vec![[o; ORDERS]; n]),
            differences: vec![[o; NODES * ORDERS]; n],
        }
    }

    /// Forgets the past: another path begins.
    pub fn forget(&mut self) {
        self.count = 0;
    }

    /// How many positions it goes by.
    pub fn known(&self) -> usize {
        self.count
    }

    /// Learns where the mechanism stands at time t, in all lanes; `pick` takes them from another state's.
    #[inline(always)]
    pub fn learn<U: Real>(&mut self, t: f64, state: &State<U>, pick: impl Fn(U) -> T) {
        self.values.rotate_right(1);
        self.times.rotate_right(1);
        self.times[0] = t;
        self.count = usize::min(self.count + 1, NODES);
        for (channel, to) in self.channels.iter().zip(&mut self.values[0]) {
            *to = match *channel {
                Channel::Coordinate(c) => [pick(state.q[c]), pick(state.qd[c]), pick(state.qdd[c])],
                Channel::Ball(first, k) => {
                    let of = |x: &[U]| Vec3::new(pick(x[first]), pick(x[first + 1]), pick(x[first + 2]));
                    let (ball, w) = (&state.balls[first], of(&state.qd));
                    let q = Quat {
                        w: pick(ball.w),
                        v: Vec3::new(pick(ball.v.x), pick(ball.v.y), pick(ball.v.z)),
                    };
                    let first = q.rate(w);
                    let second = q.rate(of(&state.qdd)).plus(first.rate(w));
                    [q.component(k), first.component(k), second.component(k)]
                }
            };
        }
    }

    /// Divided differences over the newest positions; returns how many conditions they are. Far ahead, `h` beyond
    /// the newest, only that one counts.
    #[inline(always)]
    fn divide(&mut self, h: f64) -> usize {
        let apart = |n: usize| self.times[n - 1] - self.times[n];
        let nodes = (1..self.count).take_while(|&n| h <= FARTHEST * apart(n)).count() + 1;
        let n = ORDERS * nodes;
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
                        if k == 2 { x * x.like(0.5) } else { x }
                    } else {
                        (column[i + 1] - column[i]) * column[i].like(inverse[k][i])
                    };
                }
                d[k] = column[0];
            }
        }
        n
    }

    /// Sets the unknowns of a state to what is foreseen at the times t, the last of them h beyond the newest position.
    #[inline(always)]
    pub fn set<U: Real>(&mut self, state: &mut State<U>, t: U, h: f64, spread: impl Fn(T) -> U) {
        let n = self.divide(h);
        let ahead: [U; NODES] = std::array::from_fn(|k| t - t.like(self.times[k]));
        for (channel, d) in self.channels.iter().zip(&self.differences) {
            let mut x = spread(d[n - 1]);
            for i in (0..n - 1).rev() {
                x = x.times_plus(ahead[i / ORDERS], spread(d[i]));
            }
            match *channel {
                Channel::Coordinate(c) => state.q[c] = x,
                Channel::Ball(first, k) => {
                    let ball: &mut Quat<U> = &mut state.balls[first];
                    match k {
                        0 => ball.w = x,
                        1 => ball.v.x = x,
                        2 => ball.v.y = x,
                        _ => {
                            ball.v.z = x;
                            *ball = ball.normalised();
                            state.q[first..first + 3].fill(x.zero());
                        }
                    }
                }
            }
        }
    }
}
