//! How far from a singular position: the conditioning of the Jacobian over time.

use crate::joint::Freedom;
use crate::space::{Elimination, Twist, Wrench};
use crate::topology::Topology;

use super::kinematics::State;

/// Blocks with more unknowns than this are judged by their pivots alone.
const MOST_UNKNOWNS: usize = 200;

/// How far from singular the Jacobian is.
///
/// Every constraint is measured by the most that it could resist in any coordinate of its loop if that coordinate's axis
/// pointed as it should: a force by its lever arm, a moment by itself, a slide by the force. The margin is the least change
/// of the Jacobian, as a part of that, which makes it singular: `1 / |J^-1|` in the largest-row-sum norm, lengths in sizes of
/// the mechanism. For one unknown it is the sine of the transmission angle. 1 is best, 0 is a singular position, and about
/// log10(1 / margin) digits of a velocity are lost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Margin {
    /// The least of all blocks.
    pub value: f64,
    /// The block that has it.
    pub block: usize,
}

/// Works out margins; keeps its room from step to step.
pub(crate) struct Margins {
    blocks: Vec<Elimination<f64>>,
    row: Vec<f64>,
    row_sums: Vec<f64>,
}

impl Margins {
    pub fn new(topology: &Topology) -> Self {
        let widths = topology.blocks.iter().map(|b| b.unknowns.len());
        let dense = |n: usize| if n <= MOST_UNKNOWNS { n } else { 0 };
        let widest = widths.clone().max().unwrap_or(0);
        Self {
            blocks: widths.map(|n| Elimination::new(dense(n), 0.0)).collect(),
            row: vec![0.0; widest],
            row_sums: vec![0.0; widest],
        }
    }

    /// The margin where `state` stands.
    pub fn at(&mut self, topology: &Topology, state: &State<f64>) -> Margin {
        let mut least = Margin { value: 1.0, block: 0 };
        for (b, block) in topology.blocks.iter().enumerate() {
            let n = block.unknowns.len();
            let value =
                if n <= MOST_UNKNOWNS { self.of_block(topology, state, b) } else { state.pivots[b].0 };
            // Written so that NaN is the least of all.
            if !(value >= least.value) {
                least = Margin { value: if value.is_nan() { 0.0 } else { value }, block: b };
            }
        }
        least
    }

    /// 1 / |J^-1|, the inverse column by column.
    fn of_block(&mut self, topology: &Topology, state: &State<f64>, b: usize) -> f64 {
        let block = &topology.blocks[b];
        let n = block.unknowns.len();
        let factors = &mut self.blocks[b];
        let (row, sums) = (&mut self.row[..n], &mut self.row_sums[..n]);
        for (k, &r) in block.selected.iter().enumerate() {
            state.scaled_row(topology, r, 0, row);
            let most = most_resistance(topology, state, r);
            for (to, x) in factors.row_mut(k).iter_mut().zip(row.iter()) {
                *to = x / most;
            }
        }
        if !(factors.factor().pivot_ratio > 0.0) {
            return 0.0;
        }
        sums.fill(0.0);
        for k in 0..n {
            row.fill(0.0);
            row[k] = 1.0;
            factors.solve(row);
            for (sum, x) in sums.iter_mut().zip(row.iter()) {
                *sum += x.abs();
            }
        }
        1.0 / sums.iter().copied().fold(0.0, f64::max)
    }
}

/// The most that constraint row r could resist in any coordinate of its loop, scaled like its row of the Jacobian.
fn most_resistance(topology: &Topology, state: &State<f64>, r: usize) -> f64 {
    let place = &topology.rows[r];
    let first = topology.closures[place.closure].rows[place.index];
    let scale = if first.is_length() { 1.0 / state.size } else { 1.0 };
    let mut most = f64::MIN_POSITIVE;
    for (k, factor) in topology.parts_of_row(r) {
        for &(link, _) in &topology.closures[topology.rows[k].closure].links {
            for step in &topology.links[link].steps {
                let resistance = match step.freedom {
                    Freedom::Slide(_) => state.size * state.l[k].f.norm(),
                    Freedom::Turn(_) | Freedom::Ball => moment_about(&state.l[k], &state.x[step.first]),
                };
                most = f64::max(most, scale * factor.abs() * resistance);
            }
        }
    }
    most
}

/// The most that a wrench could turn about an axis that stays where it is but may point along the moment: force times lever
/// arm, and the moment along the force.
fn moment_about(l: &Wrench, turn: &Twist) -> f64 {
    let force = l.f.norm();
    if force <= f64::MIN_POSITIVE {
        return l.m.norm();
    }
    let along = l.f * (1.0 / force);
    // The points of the two lines next to the origin; the arm is seen along the axis, where its place does not matter.
    let on_force = along.cross(l.m) * (1.0 / force);
    let on_axis = turn.w.cross(turn.v);
    let between = on_force - on_axis;
    let arm = between - turn.w * turn.w.dot(between);
    (force * arm.norm()).hypot(l.m.dot(along))
}
