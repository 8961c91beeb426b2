//! Distance from singular positions: the conditioning of the Jacobian over time.

use crate::constraint::{MarkerPair, Row};
use crate::design::Geometry;
use crate::joint::Freedom;
use crate::linalg::{Elimination, MOST_GROWTH};
use crate::model::Model;
use crate::number::Dual;
use crate::space::{Real, Twist, Vec3, Wrench};
use crate::topology::{BlockId, ClosureColumn, LoopLink, RowId, RowTerm, Topology, units_of};

use super::kinematics::State;

/// Maximum number of unknowns of a block with a margin; larger blocks have pivot ratios only.
const MOST_UNKNOWNS: usize = 200;

/// Distance of the Jacobian from singularity.
///
/// Every constraint is scaled by the maximum resistance that it could have in any coordinate of its loop, for the best
/// direction of that coordinate's axis: force times lever arm for a force, the moment itself, or the force for a slide.
/// The margin is the smallest relative change of the Jacobian that makes it singular: `1 / |J^-1|` in the maximum
/// row-sum norm, lengths in sizes of their loops (`docs/theory.md` (29)). For one unknown it is the sine of the
/// transmission angle. 1 is best, 0 is a singular position, and about log10(1 / margin) digits of a velocity are lost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Margin {
    /// Minimum over all blocks.
    pub value: f64,
    /// Block with the minimum.
    pub block: BlockId,
}

/// Computes margins; keeps its memory from step to step.
pub(crate) struct Margins<T> {
    blocks: Vec<Elimination<T>>,
    /// Per block: all of its rows; true if some are redundant.
    rows: Vec<Vec<RowId>>,
    redundant: Vec<bool>,
    /// Per coordinate: 1 rad, or the size that its loop has in the design.
    units: Vec<T>,
    row: Vec<T>,
    row_sums: Vec<T>,
}

impl<T: Real> Margins<T> {
    /// Margins of the design with this geometry.
    pub fn new(model: &Model, topology: &Topology, geometry: &Geometry<T>) -> Self {
        let widths = topology.blocks.iter().map(|b| b.unknowns.len());
        let dense = |n: usize| if n <= MOST_UNKNOWNS { n } else { 0 };
        let widest = widths.clone().max().unwrap_or(0);
        let rows: Vec<Vec<RowId>> = topology.block_ids().map(|b| topology.rows_of_block(b)).collect();
        let redundant = rows.iter().zip(&topology.blocks).map(|(r, b)| r.len() > b.unknowns.len()).collect();
        Self {
            rows,
            redundant,
            units: units_of(model, topology, geometry),
            blocks: widths.map(|n| Elimination::new(dense(n))).collect(),
            row: vec![T::zero(); widest],
            row_sums: vec![T::zero(); widest],
        }
    }

    /// Margin at the position of `state`.
    pub fn at(&mut self, topology: &Topology, state: &State<T>) -> Margin {
        let values = topology.block_ids().map(|b| {
            let small = topology[b].unknowns.len() <= MOST_UNKNOWNS;
            if small { self.of_block(topology, state, b, &mut |_| ()).value() } else { state.pivots[b.0].0 }
        });
        Margin::least(values)
    }

    /// Margin of every block, and the limits that must not be positive for it to be valid.
    pub fn record(&mut self, topology: &Topology, state: &State<T>) -> (Vec<T>, Vec<T>) {
        let mut limits = Vec::new();
        let of_block = |b| self.of_block(topology, state, b, &mut |x| limits.push(x));
        let margins = topology.block_ids().map(of_block).collect();
        (margins, limits)
    }

    /// 1 / |J^-1|, the inverse column by column. With redundant constraints it is 1 / |J^+| of all rows, so that the
    /// margin does not depend on the selection of rows.
    #[inline(always)]
    fn of_block(
        &mut self,
        topology: &Topology,
        state: &State<T>,
        b: BlockId,
        limit: &mut impl FnMut(T),
    ) -> T {
        let squared = T::constant(SQUARED);
        if self.redundant[b.0] {
            let all = self.of_all_rows(topology, state, b, limit);
            if all.decisive() > SQUARED {
                limit(squared - all);
                return all;
            }
            limit(all - squared);
        }
        let block = &topology[b];
        let n = block.unknowns.len();
        let (zero, one) = (T::zero(), T::one());
        let factors = &mut self.blocks[b.0];
        let (row, sums, units) = (&mut self.row[..n], &mut self.row_sums[..n], &self.units[..]);
        for (k, &r) in block.selected.iter().enumerate() {
            relative_row(topology, units, state, r, row);
            // R: each row of J divided by its unit and its maximum resistance (29)
            let to = &mut factors.row_mut(k)[..n];
            for c in 0..n {
                to[c] = row[c];
            }
        }
        if !(judged(factors, limit) > 0.0) {
            return zero;
        }
        clear(sums);
        for k in 0..n {
            clear(row);
            // |R^-1| = the largest sum over a row of the sizes of its entries; column k of R^-1 is R^-1 e_k
            row[k] = one;
            factors.solve(row);
            for c in 0..n {
                sums[c] += row[c].abs();
            }
        }
        one / sums.iter().fold(zero, |most, x| most.larger(*x))
    }

    /// 1 / |J^+| over all rows of a block, `J^+ = (J^T J)^-1 J^T` column by column; 0 if round-off may dominate.
    #[inline(always)]
    fn of_all_rows(
        &mut self,
        topology: &Topology,
        state: &State<T>,
        b: BlockId,
        limit: &mut impl FnMut(T),
    ) -> T {
        let block = &topology[b];
        let n = block.unknowns.len();
        let (zero, one) = (T::zero(), T::one());
        let factors = &mut self.blocks[b.0];
        let (row, sums, units) = (&mut self.row[..n], &mut self.row_sums[..n], &self.units[..]);
        (0..n).for_each(|k| clear(factors.row_mut(k)));
        for &r in &self.rows[b.0] {
            relative_row(topology, units, state, r, row);
            for k in 0..n {
                let to = &mut factors.row_mut(k)[..n];
                for c in 0..n {
                    // N = R^T R, summed over all rows of the block: N_kc += R_rk R_rc
                    to[c] = row[k].times_plus(row[c], to[c]);
                }
            }
        }
        if !(judged(factors, limit) > SQUARED * SQUARED) {
            return zero;
        }
        clear(sums);
        for &r in &self.rows[b.0] {
            relative_row(topology, units, state, r, row);
            // Column r of R^+ = N^-1 R^T is N^-1 (row r of R)
            factors.solve(row);
            for c in 0..n {
                sums[c] += row[c].abs();
            }
        }
        one / sums.iter().fold(zero, |most, x| most.larger(*x))
    }
}

impl Margins<Dual> {
    /// Derivative of the margin of a block along the direction of a state; `None` for the pivot ratio of a large block,
    /// which has none, and where it is not known.
    pub fn derivative(&mut self, topology: &Topology, state: &State<Dual>, b: BlockId) -> Option<f64> {
        let small = topology[b].unknowns.len() <= MOST_UNKNOWNS;
        let found = small.then(|| self.of_block(topology, state, b, &mut |_| ()).d);
        found.filter(|d| d.is_finite())
    }
}

/// Sets all numbers to zero.
#[inline(always)]
fn clear<T: Real>(row: &mut [T]) {
    for x in row {
        *x = T::zero();
    }
}

/// Factors the matrix and returns the pivot ratio; the recorded order of the pivots must remain stable.
#[inline(always)]
fn judged<T: Real>(factors: &mut Elimination<T>, limit: &mut impl FnMut(T)) -> f64 {
    // An order of pivots is stable while its factors are below 4, or below twice the recorded ones.
    let found = factors.factor();
    let growth = found.watched.growth;
    limit(growth - T::constant(f64::max(MOST_GROWTH, 2.0 * growth.decisive())));
    found.pivot_ratio
}

impl Margin {
    /// Minimum over all blocks; NaN counts as the minimum.
    pub(crate) fn least(blocks: impl Iterator<Item = f64>) -> Self {
        let least = Self { value: 1.0, block: BlockId(0) };
        blocks.enumerate().fold(least, |least, (block, value)| match value >= least.value {
            true => least,
            false => Self { value: if value.is_nan() { 0.0 } else { value }, block: BlockId(block) },
        })
    }
}

/// Margins below this are computed without the normal matrix, which would lose half of the digits.
const SQUARED: f64 = 1e-6;

/// Constraint row r of the Jacobian, by column of its block, divided by its maximum resistance.
#[inline(always)]
fn relative_row<T: Real>(topology: &Topology, units: &[T], state: &State<T>, r: RowId, row: &mut [T]) {
    let scale = 1.0 / topology[r].unit;
    clear(row);
    for RowTerm { row: part, factor } in topology.parts_of_row(r) {
        let l = wrench(topology, state, part);
        for &ClosureColumn { column, coordinate: c, side } in &topology.closure_of(part).entries {
            // +- c_k l_k . x_c, in the units of row and coordinate                                                (6)
            row[column] += l.on(state.x[0][c.0]) * units[c.0] * T::constant(scale * side * factor);
        }
    }
    let per_most = T::one() / most_resistance(topology, units, state, r);
    row.iter_mut().for_each(|x| *x = *x * per_most);
}

/// The wrench of a row, whether or not the motion needs it.
#[inline(always)]
fn wrench<T: Real>(topology: &Topology, state: &State<T>, r: RowId) -> Wrench<T> {
    if topology[r].has_wrench() { state.l[0][r.0] } else { state.wrench_of(topology, r) }
}

/// Maximum resistance of constraint row r in any coordinate of its loop, scaled like its row of the Jacobian.
#[inline(always)]
fn most_resistance<T: Real>(topology: &Topology, units: &[T], state: &State<T>, r: RowId) -> T {
    let scale = 1.0 / topology[r].unit;
    let mut most = T::constant(f64::MIN_POSITIVE);
    for RowTerm { row, factor } in topology.parts_of_row(r) {
        let MarkerPair { i, j, .. } = &state.ends[topology[row].closure.0];
        let l = wrench(topology, state, row);
        for &LoopLink { link, side } in &topology.closure_of(row).links {
            // The force of a rod acts at its ends; any other force acts at P_j.
            let at_i = side < 0.0 && topology.constraint(row) == Row::Distance;
            let point = if at_i { i.r } else { j.r };
            for step in &topology[link].steps {
                // a slide: abs(f); a turn: sqrt((abs(f) arm)^2 + couple^2), the arm seen along the axis
                let resistance = match step.freedom {
                    Freedom::Slide(_) => l.f.norm() * units[step.first.0],
                    Freedom::Turn(_) | Freedom::Ball => most_moment(&l, point, &state.x[0][step.first.0]),
                };
                most = most.larger(resistance * T::constant(scale * factor.abs()));
            }
        }
    }
    most
}

/// Maximum moment about an axis of a force at a point, with its couple, over all directions of the axis.
#[inline(always)]
fn most_moment<T: Real>(l: &Wrench<T>, point: Vec3<T>, turn: &Twist<T>) -> T {
    // x = [w; c x w]: w x v = w x (c x w) = c - w (w . c), the axis' point next to the origin; the arm is seen along
    // the axis
    let between = point - turn.w.cross(turn.v);
    let arm = between - turn.w * turn.w.dot(between);
    // l = [P x f + couple; f];  most = sqrt((abs(f) abs(arm))^2 + abs(couple)^2); the norms alone have no derivative at
    // zero
    let couple = l.m - point.cross(l.f);
    (l.f.dot(l.f) * arm.dot(arm) + couple.dot(couple)).sqrt()
}
