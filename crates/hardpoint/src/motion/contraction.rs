//! Krawczyk's test of the equations of a block over a box of its unknowns, in interval arithmetic.
//!
//! Positions over an interval of time ([`super::tube`]) and over a box of driver values ([`super::driver_box`]) are
//! bounded alike: they differ in how the residual depends on what is given, and in the numbers that have the
//! derivatives.

use crate::joint::Freedom;
use crate::linalg::{Factors, LARGEST_DENSE};
use crate::model::Model;
use crate::number::{Dual, Interval};
use crate::space::{Quat, Real, Vec3};
use crate::topology::{BlockId, LinkId, Topology};

use super::kinematics::State;
use super::mechanism::AcceptedPosition;
use super::parts::PlanGeometry;

/// Number of boxes that are tried before an interval of time or a box of driver values is considered too large.
const MOST_BOXES: usize = 8;
/// Factor by which a box is larger than its prediction or the last image, so that the next image is inside of it.
pub(super) const SLACK: f64 = 1.1;
/// Size that a box has at least, in units of its coordinate: far above the error of a solved position, which is
/// round-off, and far below any motion of interest.
pub(super) const LEAST_BOX: f64 = 1e-11;
/// Size of a box, rad or sizes, above which the equations of a position are not nearly linear in it.
const LARGEST_BOX: f64 = 1.0;
/// Largest `|I - Y J(X)|` for which bounds of rates are useful.
pub(super) const CONTRACTION: f64 = 0.9;
/// Number of passes of a linear system over its bounds.
const PASSES: usize = 2;
/// Number of passes that improve the weights of the norm: unknowns in m and rad differ by a factor of a hundred or so.
const WEIGHINGS: usize = 8;

/// The formulas of a mechanism over one kind of number. What is given to them is a `dyn Fn`, which makes
/// one copy of them for each.
pub(super) struct Formulas<T> {
    pub state: State<T>,
    parts: PlanGeometry<T>,
    drivers: Vec<[T; 3]>,
}

impl<T: Real> Formulas<T> {
    fn new(model: &Model, topology: &Topology, parts: &PlanGeometry<f64>) -> Self {
        Self {
            state: State::new(model, topology),
            parts: parts.spread(),
            drivers: vec![[T::zero(); 3]; model.drivers.len()],
        }
    }

    /// Sets the motion of the drivers, and places what they move.
    fn drive(&mut self, topology: &Topology, law: &dyn Fn(usize) -> T, at: &AcceptedPosition) {
        for (d, driver) in self.drivers.iter_mut().enumerate() {
            *driver = [law(d), T::zero(), T::zero()];
        }
        for &r in &topology.coupler_terms {
            self.state.near[r.0] = T::constant(at.coupled[r.0][0]);
        }
        for (c, d) in topology.driven_coordinates() {
            self.state.q[c.0] = law(d.0);
        }
        self.place_bodies(topology, &topology.driven_links().collect::<Vec<_>>());
    }

    /// Sets the unknowns of a block.
    fn set(&mut self, topology: &Topology, b: BlockId, q: &dyn Fn(usize) -> T, centres: &[Quat]) {
        let state = &mut self.state;
        for (k, c) in topology[b].unknowns.iter().enumerate() {
            state.q[c.0] = q(k);
        }
        for step in topology[b].link_ids().flat_map(|link| &topology[link].steps) {
            if step.freedom == Freedom::Ball {
                let k = step.first.0;
                let by = Vec3::new(state.q[k], state.q[k + 1], state.q[k + 2]);
                state.balls[k] = centres[k].spread().nudged(by);
            }
        }
    }

    /// Residuals of the selected rows of a block at these coordinates.
    pub fn rows(
        &mut self,
        topology: &Topology,
        b: BlockId,
        q: &dyn Fn(usize) -> T,
        centres: &[Quat],
    ) -> Vec<T> {
        self.set(topology, b, q, centres);
        let Self { state, parts, drivers } = self;
        state.place(topology, parts, topology[b].link_ids());
        for &c in &topology[b].closures {
            state.place_ends(topology, parts, c);
        }
        topology[b].selected.iter().map(|&r| state.residual_of(topology, parts, drivers, r)).collect()
    }

    fn place_bodies(&mut self, topology: &Topology, links: &[LinkId]) {
        self.state.place(topology, &self.parts, links.iter().copied());
        self.state.place_bodies(topology, &self.parts, links.iter().copied());
    }
}

/// The formulas of a mechanism over intervals, over duals of them (a column of the Jacobian), and over the numbers that
/// have the derivatives.
pub(super) struct BlockSolver<S> {
    pub values: Formulas<Interval>,
    columns: Formulas<Dual<Interval>>,
    pub series: Formulas<S>,
    value: fn(S) -> Interval,
}

/// Box of the unknowns of a block that was proved.
pub(super) struct Contracted {
    /// Exactly one position is in it.
    pub unique: Vec<Interval>,
    /// That position is here.
    pub bounds: Vec<Interval>,
}

impl<S: Real> BlockSolver<S> {
    pub fn new(
        model: &Model,
        topology: &Topology,
        parts: &PlanGeometry<f64>,
        value: fn(S) -> Interval,
    ) -> Self {
        Self {
            values: Formulas::new(model, topology, parts),
            columns: Formulas::new(model, topology, parts),
            series: Formulas::new(model, topology, parts),
            value,
        }
    }

    /// Sets the motion of the drivers near a position, and places what they move.
    pub fn drive(&mut self, topology: &Topology, laws: &[S], at: &AcceptedPosition) {
        let value = |d: usize| (self.value)(laws[d]);
        self.values.drive(topology, &value, at);
        self.columns.drive(topology, &|d| Dual::constant(value(d)), at);
        self.series.drive(topology, &|d| laws[d], at);
    }

    /// Sets the unknowns of a block, and places its bodies, for blocks that depend on it and as results.
    pub fn place(&mut self, topology: &Topology, b: BlockId, q: &[S], centres: &[Quat]) {
        let value = |k: usize| (self.value)(q[k]);
        let links: Vec<LinkId> = topology[b].link_ids().collect();
        self.values.set(topology, b, &value, centres);
        self.values.place_bodies(topology, &links);
        self.columns.set(topology, b, &|k| Dual::constant(value(k)), centres);
        self.columns.place_bodies(topology, &links);
        self.series.set(topology, b, &|k| q[k], centres);
        self.series.place_bodies(topology, &links);
    }

    /// Jacobian of the selected rows by the unknowns of a block, row by row.
    pub fn jacobian(
        &mut self,
        topology: &Topology,
        b: BlockId,
        q: &[Interval],
        centres: &[Quat],
    ) -> Vec<Interval> {
        let n = q.len();
        let mut jacobian = vec![Interval::zero(); n * n];
        for column in 0..n {
            let of = |k: usize| if k == column { Dual::variable(q[k]) } else { Dual::constant(q[k]) };
            for (row, x) in self.columns.rows(topology, b, &of, centres).into_iter().enumerate() {
                jacobian[row * n + column] = x.d;
            }
        }
        jacobian
    }

    /// Widens boxes around a position of a block until one contains its image; `None` if none does, or if derivatives
    /// could not be bounded in it. The image is `m - newton + (I - Y J(X)) (X - m)`, `newton` Y times the residual.
    pub fn contract(
        &mut self,
        topology: &Topology,
        b: BlockId,
        (middle, mut radius): (&[Interval], Vec<f64>),
        centres: &[Quat],
        newton: &dyn Fn(&Contraction) -> Vec<Interval>,
    ) -> Option<Contracted> {
        let n = middle.len();
        let unit = |k: usize| topology[topology[b].unknowns[k]].unit;
        let mut inverse: Option<Vec<f64>> = None;
        for _ in 0..MOST_BOXES {
            let boxed: Vec<Interval> =
                middle.iter().zip(&radius).map(|(m, r)| *m + Interval::symmetric(*r)).collect();
            let jacobian = self.jacobian(topology, b, &boxed, centres);
            let of_first = match inverse.take() {
                Some(inverse) => inverse,
                None => inverse_of(&jacobian, n)?,
            };
            let step = Contraction::of(of_first, &jacobian, n);
            let away: Vec<Interval> = boxed.iter().zip(middle).map(|(x, m)| *x - *m).collect();
            let newton = newton(&step);
            let rest = step.remainder(&away);
            let image: Vec<Interval> = newton.iter().zip(&rest).map(|(p, q)| *q - *p).collect();
            if away.iter().zip(&image).all(|(x, k)| x.strictly_encloses(*k)) {
                let bounds = middle.iter().zip(&image).map(|(m, k)| *m + *k).collect();
                return (step.norm() <= CONTRACTION).then_some(Contracted { unique: boxed, bounds });
            }
            for k in 0..n {
                let reached = image[k].magnitude();
                if !(reached <= LARGEST_BOX * unit(k)) {
                    return None;
                }
                radius[k] = SLACK * reached + LEAST_BOX * unit(k);
            }
            inverse = Some(step.inverse);
        }
        None
    }
}

/// Preconditioned equations of a block over a box.
pub(super) struct Contraction {
    /// Y, row by row.
    inverse: Vec<f64>,
    /// I - Y J(X), row by row.
    rest: Vec<Interval>,
    n: usize,
    /// Per unknown: its weight in the norm, positive.
    weights: Vec<f64>,
    norm: f64,
}

impl Contraction {
    /// From Y and J(X), row by row.
    pub fn of(inverse: Vec<f64>, jacobian: &[Interval], n: usize) -> Self {
        let mut rest = vec![Interval::zero(); n * n];
        for row in 0..n {
            for column in 0..n {
                let mut sum = Interval::constant(f64::from(u8::from(row == column)));
                for k in 0..n {
                    sum -= Interval::constant(inverse[row * n + k]) * jacobian[k * n + column];
                }
                rest[row * n + column] = sum;
            }
        }
        let (weights, norm) = weighted(&rest, n);
        Self { inverse, rest, n, weights, norm }
    }

    /// `Y b`.
    pub fn precondition(&self, b: &[Interval]) -> Vec<Interval> {
        self.inverse
            .chunks_exact(self.n)
            .map(|y| product(y.iter().map(|y| Interval::constant(*y)), b))
            .collect()
    }

    /// `(I - Y J) x`.
    pub fn remainder(&self, x: &[Interval]) -> Vec<Interval> {
        self.rest.chunks_exact(self.n).map(|row| product(row.iter().copied(), x)).collect()
    }

    /// `|I - Y J|`, in the norm of the largest weighted row sum.
    pub fn norm(&self) -> f64 {
        self.norm
    }

    /// Bounds of x with `J x = b`, within those that are known.
    pub fn solve(&self, b: &[Interval], known: &[Interval]) -> Vec<Interval> {
        let y = self.precondition(b);
        let weights = || self.weights.iter().map(|w| Interval::constant(*w));
        let in_weights = y.iter().zip(weights()).map(|(y, w)| (Interval::constant(y.magnitude()) / w).high);
        let size = Interval::constant(in_weights.fold(0.0, f64::max));
        let most = size / (Interval::one() - Interval::constant(self.norm));
        let bounds = weights().map(|w| Interval::symmetric((most * w).high));
        let mut x: Vec<Interval> = known.iter().zip(bounds).map(|(known, most)| known.and(most)).collect();
        for _ in 0..PASSES {
            let rest = self.remainder(&x);
            for ((x, y), rest) in x.iter_mut().zip(&y).zip(rest) {
                *x = x.and(*y + rest);
            }
        }
        x
    }
}

/// Weights of the unknowns, and `|R|` in the norm `max_i sum_j |R_ij| w_j / w_i`, which is small if w is near to the
/// eigenvector of the magnitudes that belongs to their largest eigenvalue.
fn weighted(rest: &[Interval], n: usize) -> (Vec<f64>, f64) {
    let norm = |w: &[f64]| {
        let sum = |row: &[Interval]| {
            let terms =
                row.iter().zip(w).map(|(x, w)| Interval::constant(x.magnitude()) * Interval::constant(*w));
            terms.fold(Interval::zero(), |sum, x| sum + x)
        };
        let rows = rest.chunks_exact(n).zip(w).map(|(row, w)| (sum(row) / Interval::constant(*w)).high);
        rows.fold(0.0, f64::max)
    };
    let mut weights = vec![1.0; n];
    let mut least = norm(&weights);
    for _ in 0..WEIGHINGS {
        // (|R| + |R|_w I) w: positive, and the norm never grows.
        let image = rest.chunks_exact(n).zip(&weights).map(|(row, own)| {
            least * own + row.iter().zip(&weights).map(|(x, w)| x.magnitude() * w).sum::<f64>()
        });
        let image: Vec<f64> = image.collect();
        let largest = image.iter().copied().fold(0.0, f64::max);
        let next: Vec<f64> = image.iter().map(|w| w / largest).collect();
        if !next.iter().all(|w| w.is_normal()) {
            break;
        }
        let found = norm(&next);
        if !(found < least) {
            break;
        }
        (weights, least) = (next, found);
    }
    (weights, least)
}

fn product(row: impl Iterator<Item = Interval>, x: &[Interval]) -> Interval {
    row.zip(x).fold(Interval::zero(), |sum, (a, x)| sum + a * *x)
}

/// Inverse of the middle of a matrix, nearly; `None` if it is singular or unbounded.
pub(super) fn inverse_of(matrix: &[Interval], n: usize) -> Option<Vec<f64>> {
    let mut factors = Factors::<f64>::new(n, |_| (0..n).collect(), LARGEST_DENSE);
    for row in 0..n {
        let entries = (0..n).map(|column| (column, matrix[row * n + column].middle()));
        factors.set_row(row, entries, 0.0);
    }
    factors.factor();
    let mut inverse = vec![0.0; n * n];
    for column in 0..n {
        let mut unit = vec![0.0; n];
        unit[column] = 1.0;
        factors.solve(&mut unit);
        for row in 0..n {
            inverse[row * n + column] = unit[row];
        }
    }
    inverse.iter().all(|x| x.is_finite()).then_some(inverse)
}

/// True if the unknowns of a narrow enclosure are in the box in which those of another one are unique. Both are given
/// by the rotations from which the coordinates of balls count, and by their bounds.
pub(super) fn is_within(
    topology: &Topology,
    (from, narrow): (&[Quat], impl Fn(usize) -> Interval),
    (centres, unique): (&[Quat], &[Interval]),
) -> bool {
    topology.links.iter().flat_map(|link| &link.steps).all(|step| {
        let k = step.first.0;
        if step.is_driven {
            return true;
        }
        if step.freedom != Freedom::Ball {
            return unique[k].encloses(narrow(k));
        }
        // The same rotation, counted from the centre of the other enclosure: (1, d/2) of it up to a factor.
        let by = Vec3::new(0, 1, 2).map(|n| narrow(k + n));
        let rotation: Quat<Interval> = from[k].spread().nudged(by);
        let centre: Quat<Interval> = centres[k].spread();
        let w = rotation.w * centre.w + rotation.v.dot(centre.v);
        let v = centre.v * -rotation.w + rotation.v * centre.w - rotation.v.cross(centre.v);
        (0..3).all(|n| unique[k + n].encloses(v[n] / w * 2.0))
    })
}
