//! Third time derivatives: one more level with the factors that the acceleration leaves.

use crate::model::Model;
use crate::space::{Twist, Vec3};
use crate::topology::{Source, Topology};

use super::kinematics::{carry, level, sum_couplers};
use super::stepper::Stepper;

/// Third time derivatives of one body's motion, global components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyJerk {
    /// Jerk of its frame's origin, the rate of its acceleration, m/s^3.
    pub jerk: Vec3,
    /// Angular jerk, the rate of its angular acceleration, rad/s^3.
    pub angular: Vec3,
}

/// Scratch of the third level; nothing is allocated per step.
pub(crate) struct Jerk {
    /// Per coordinate and per body: third derivatives.
    qddd: Vec<f64>,
    b: Vec<Twist<f64>>,
    /// Per link, row and driver: what the level adds besides the unknowns.
    bias: Vec<Twist<f64>>,
    row_rhs: Vec<f64>,
    demands: Vec<f64>,
}

impl Jerk {
    pub fn new(model: &Model, topology: &Topology) -> Self {
        let (none, zero) = (Twist::zero(), 0.0);
        Self {
            qddd: vec![zero; topology.coordinates.len()],
            b: vec![none; model.bodies.len()],
            bias: vec![none; topology.links.len()],
            row_rhs: vec![zero; topology.rows.len()],
            demands: vec![zero; model.drivers.len()],
        }
    }

    /// All bodies where a stepper stands with velocity and acceleration, at time t (`docs/theory.md` (21)).
    pub fn solve(&mut self, stepper: &mut Stepper<'_>, t: f64) {
        let (topology, state, parts) = (&stepper.topology, &mut stepper.state, &stepper.parts);
        state.finish_rates(topology);
        for (d, demand) in self.demands.iter_mut().enumerate() {
            *demand = parts.law_of(d).at(t).ddd();
        }
        let Self { qddd, b: out, bias, row_rhs, demands } = self;
        for (c, coordinate) in topology.coordinates.iter().enumerate() {
            if let Source::Driven(d) = coordinate.source {
                qddd[c] = demands[d.0];
            }
        }
        for (bias, link) in bias.iter_mut().zip(&topology.links) {
            *bias = Twist::ZERO;
            for c in link.coordinates().filter(|_| !link.keeps_its_twist()) {
                *bias = state.xdd[c].times_plus(state.qd[c], *bias);
                *bias = state.xd[c].times_plus(state.qdd[c] * 2.0, *bias);
            }
        }
        for closure in &topology.closures {
            let demand = closure.driver.map_or(0.0, |d| demands[d.0]);
            let [i, j] = closure.bodies.map(|body| body.0);
            let (v, a) = (state.v[j] - state.v[i], state.a[j] - state.a[i]);
            for r in closure.first_row..closure.first_row + closure.rows.len() {
                if topology.rows[r].drives() {
                    row_rhs[r] = demand - state.ldd[r].on(v) - state.ld[r].on(a) * 2.0;
                }
            }
        }
        let (x, bias) = (&state.x, Some(&bias[..]));
        carry(topology, topology.driven_links(), x, bias, qddd, out, |_| true);
        for b in 0..topology.blocks.len() {
            sum_couplers(topology, b, row_rhs);
            let (factors, rhs) = (&mut state.factors, &mut state.rhs);
            level(topology, b, factors, x, &state.l, bias, row_rhs, qddd, out, rhs);
        }
    }

    /// A body's jerk: `r... = B at r + 2 alpha x r. + omega x r..`.
    pub fn of_body(&self, stepper: &Stepper<'_>, body: usize) -> BodyJerk {
        let state = &stepper.state;
        let [v, a, b] = [state.v[body], state.a[body], self.b[body]];
        let r = state.pose[body].r;
        let velocity = v.at(r);
        let acceleration = a.at(r) + v.w.cross(velocity);
        let jerk = b.at(r) + a.w.cross(velocity) * 2.0 + v.w.cross(acceleration);
        BodyJerk { jerk, angular: b.w }
    }
}
