//! Proven bounds of all positions over a box of driver values, with their partial derivatives by the drivers.
//!
//! Over a box D of the drivers' values the equations of a block are those of [`super::tube`] over an interval of time:
//! with d the middle of D, m the position there, and X a box of the unknowns,
//!
//! ```text
//! K(X) = m - Y (phi(m, d) + phi_d(m, D) (D - d)) + (I - Y J(X)) (X - m)
//! ```
//!
//! inside of X proves that exactly one position in X belongs to each point of D. The Taylor coefficients of the
//! unknowns in the drivers follow degree by degree: `J q_e = -r_e`, with r_e the coefficient of the rows as if q_e were
//! zero.
//! Bounds at the middle narrow those over the box ([`Taylor::narrowed`]), and these narrow all of higher degree.
//!
//! Boxes with a corner in common belong to the same branch if the position there is in both of their boxes X. Over a
//! face in common both are continuous solutions that do not meet a singular position, so they agree on all of it.

use std::collections::HashMap;
use std::rc::Rc;

use crate::model::JointId;
use crate::number::{Dual, Interval, Taylor};
use crate::space::{Pose, Quat, Real};
use crate::topology::{BlockId, Topology};

use super::Stop;
use super::advance::{accept_at_rest, start_at_rest};
use super::kinematics::State;
use super::mechanism::{AcceptedPosition, Mechanism};
use super::parts::PlanGeometry;
use super::path::Path;
use super::stepper::Stepper;
use super::tube::{
    CONTRACTION, Contraction, LARGEST_BOX, LEAST_BOX, MOST_BOXES, SLACK, inverse_of, is_within, rows, set,
};
use super::walk::walk;
use crate::linalg::LARGEST_DENSE;

/// Number of passes that narrow the derivatives over a box with those at its middle.
const PASSES: usize = 2;

/// Number of times that the solution of a linear system over a box is narrowed with its own bounds: with a contraction
/// of 1/2, the excess of the first bounds is then below a thousandth.
const SHARPENINGS: usize = 5;

/// Reason why nothing is proved over a box of driver values.
#[derive(Clone, Debug, PartialEq)]
pub enum BoxFailure {
    /// The joint follows a curve, which is not a formula over intervals.
    FollowsCurve {
        /// The joint.
        joint: JointId,
    },
    /// The block has too many unknowns for dense matrices of intervals.
    TooLarge {
        /// The block.
        block: BlockId,
    },
    /// No box contracts: the box of driver values is too large, or a singular position is too near.
    NoContraction {
        /// The block.
        block: BlockId,
    },
    /// The mechanism does not reach a position of the box.
    NotReached(Box<Stop>),
    /// A position at a corner of the box belongs to another branch than that at the middle.
    OtherBranch,
}

impl BoxFailure {
    /// True if a smaller box may succeed.
    pub fn may_be_halved(&self) -> bool {
        match self {
            Self::FollowsCurve { .. } | Self::TooLarge { .. } => false,
            Self::NoContraction { .. } | Self::NotReached(_) | Self::OtherBranch => true,
        }
    }
}

/// Bounds over a box of driver values, or at a point.
pub(crate) struct BoxEnclosure<const N: usize> {
    /// Per body: bounds of its pose, with its Taylor coefficients in the drivers.
    pub poses: Vec<Pose<Taylor<Interval, N>>>,
    /// Per coordinate that begins a ball: its rotation at the middle, nearly.
    centres: Rc<Vec<Quat>>,
    /// Per coordinate: box in which exactly one position belongs to each point.
    unique: Vec<Interval>,
    /// Per block: its residuals at the middle of its coordinates.
    residuals: Vec<Vec<Interval>>,
    /// Per coordinate.
    coordinates: Vec<Taylor<Interval, N>>,
}

/// One point of the drivers' range.
pub(crate) struct BoxPoint<const N: usize> {
    at: AcceptedPosition,
    /// Narrow bounds.
    pub enclosure: BoxEnclosure<N>,
}

/// Box of driver values with what is known at its middle.
struct Wanted<'w, const N: usize> {
    /// Value of every driver of the mechanism.
    drivers: Vec<Taylor<Interval, N>>,
    /// Distance of every variable from the middle.
    since: Vec<Interval>,
    at: &'w AcceptedPosition,
    narrow: Option<&'w BoxEnclosure<N>>,
}

/// Computes enclosures of one mechanism.
struct BoxSolver<const N: usize> {
    /// The same state over intervals, over duals of them, and over Taylor numbers of them.
    values: State<Interval>,
    columns: State<Dual<Interval>>,
    series: State<Taylor<Interval, N>>,
    parts: PlanGeometry<Interval>,
    parts_of_columns: PlanGeometry<Dual<Interval>>,
    parts_of_series: PlanGeometry<Taylor<Interval, N>>,
    drivers: Vec<[Interval; 3]>,
    drivers_of_columns: Vec<[Dual<Interval>; 3]>,
    drivers_of_series: Vec<[Taylor<Interval, N>; 3]>,
}

impl<const N: usize> BoxSolver<N> {
    fn new(mechanism: &Mechanism<'_>) -> Self {
        let Mechanism { model, topology, parts, .. } = mechanism;
        let drivers = model.drivers.len();
        Self {
            values: State::new(model, topology),
            columns: State::new(model, topology),
            series: State::new(model, topology),
            parts: parts.spread(),
            parts_of_columns: parts.spread(),
            parts_of_series: parts.spread(),
            drivers: vec![[Interval::zero(); 3]; drivers],
            drivers_of_columns: vec![[Dual::zero(); 3]; drivers],
            drivers_of_series: vec![[Taylor::zero(); 3]; drivers],
        }
    }

    fn enclose(
        &mut self,
        topology: &Topology,
        wanted: &Wanted<'_, N>,
    ) -> Result<BoxEnclosure<N>, BoxFailure> {
        if let Some((c, _)) = topology.contacts().next() {
            return Err(BoxFailure::FollowsCurve { joint: topology[c].joint });
        }
        for (d, law) in wanted.drivers.iter().enumerate() {
            self.drivers[d][0] = law.value();
            self.drivers_of_columns[d][0] = Dual::constant(law.value());
            self.drivers_of_series[d][0] = *law;
        }
        for r in topology.coupler_terms() {
            let near = wanted.at.coupled[r.0][0];
            self.values.near[r.0] = Real::constant(near);
            self.columns.near[r.0] = Real::constant(near);
            self.series.near[r.0] = Real::constant(near);
        }
        let centres =
            wanted.narrow.map_or_else(|| Rc::new(wanted.at.balls.clone()), |narrow| narrow.centres.clone());
        let o = topology.coordinates.len();
        let mut found = BoxEnclosure {
            poses: Vec::new(),
            centres,
            unique: vec![Interval::zero(); o],
            residuals: Vec::new(),
            coordinates: vec![Taylor::zero(); o],
        };
        for (c, d) in topology.driven_coordinates() {
            let law = wanted.drivers[d.0];
            (found.coordinates[c.0], found.unique[c.0]) = (law, law.value());
            self.values.q[c.0] = law.value();
            self.columns.q[c.0] = Dual::constant(law.value());
            self.series.q[c.0] = law;
        }
        self.values.place(topology, &self.parts, topology.driven_links());
        self.values.place_bodies(topology, &self.parts, topology.driven_links());
        self.columns.place(topology, &self.parts_of_columns, topology.driven_links());
        self.columns.place_bodies(topology, &self.parts_of_columns, topology.driven_links());
        self.series.place(topology, &self.parts_of_series, topology.driven_links());
        self.series.place_bodies(topology, &self.parts_of_series, topology.driven_links());
        for b in topology.block_ids() {
            self.enclose_block(topology, b, wanted, &mut found)?;
        }
        found.poses = self.series.pose.clone();
        if let Some(narrow) = wanted.narrow {
            let since = &wanted.since;
            for (pose, at) in found.poses.iter_mut().zip(&narrow.poses) {
                let narrowed = |x: Taylor<Interval, N>, at: &Taylor<Interval, N>| x.narrowed(at, since);
                for (col, at) in
                    pose.rot.cols.iter_mut().chain([&mut pose.r]).zip(at.rot.cols.iter().chain([&at.r]))
                {
                    (col.x, col.y, col.z) =
                        (narrowed(col.x, &at.x), narrowed(col.y, &at.y), narrowed(col.z, &at.z));
                }
            }
        }
        Ok(found)
    }

    /// Finds the box of one block, and the bounds of its derivatives.
    fn enclose_block(
        &mut self,
        topology: &Topology,
        b: BlockId,
        wanted: &Wanted<'_, N>,
        found: &mut BoxEnclosure<N>,
    ) -> Result<(), BoxFailure> {
        let unknowns = &topology[b].unknowns;
        let n = unknowns.len();
        if n > LARGEST_DENSE {
            return Err(BoxFailure::TooLarge { block: b });
        }
        let failed = || BoxFailure::NoContraction { block: b };
        let unit = |k: usize| topology[unknowns[k]].unit;
        let points: Vec<Interval> = unknowns.iter().map(|c| Interval::constant(wanted.at.q[c.0])).collect();
        // phi(m, D), and phi(m, d) + phi_d(m, D) (D - d)
        set(&mut self.values, topology, b, |k| points[k], &found.centres);
        let mut residual = rows(&mut self.values, topology, &self.parts, &self.drivers, b);
        if let Some(narrow) = wanted.narrow {
            set(&mut self.series, topology, b, |k| Taylor::constant(points[k]), &found.centres);
            let moved = rows(&mut self.series, topology, &self.parts_of_series, &self.drivers_of_series, b);
            // One term for each variable, to be preconditioned before it is added.
            let start = narrow.residuals[b.0].clone();
            let terms: Vec<Vec<Interval>> = (0..wanted.since.len())
                .map(|v| moved.iter().map(|row| row.coefficients()[1 + v]).collect())
                .collect();
            return self.contract(topology, b, wanted, found, &points, (&start, &terms), &unit, failed);
        }
        found.residuals.push(std::mem::take(&mut residual));
        let start = found.residuals[b.0].clone();
        self.contract(topology, b, wanted, found, &points, (&start, &[]), &unit, failed)
    }

    #[expect(clippy::too_many_arguments, reason = "the parts of one contraction")]
    fn contract(
        &mut self,
        topology: &Topology,
        b: BlockId,
        wanted: &Wanted<'_, N>,
        found: &mut BoxEnclosure<N>,
        points: &[Interval],
        (start, terms): (&[Interval], &[Vec<Interval>]),
        unit: &dyn Fn(usize) -> f64,
        failed: impl Fn() -> BoxFailure,
    ) -> Result<(), BoxFailure> {
        let unknowns = &topology[b].unknowns;
        let n = unknowns.len();
        let mut radius: Vec<f64> = (0..n).map(|k| LEAST_BOX * unit(k)).collect();
        let (mut contraction, mut first): (Option<Contraction>, Option<Vec<f64>>) = (None, None);
        for _ in 0..MOST_BOXES {
            let boxed: Vec<Interval> =
                points.iter().zip(&radius).map(|(m, r)| *m + Interval::symmetric(*r)).collect();
            let jacobian = self.jacobian(topology, b, &boxed, &found.centres);
            let inverse = match &first {
                Some(inverse) => inverse.clone(),
                None => inverse_of(&jacobian, n).ok_or_else(&failed)?,
            };
            first = Some(inverse.clone());
            let step = Contraction::of(inverse, &jacobian, n);
            let away: Vec<Interval> = boxed.iter().zip(points).map(|(x, m)| *x - *m).collect();
            let mut newton = step.precondition(start);
            for (term, since) in terms.iter().zip(&wanted.since) {
                for (x, rate) in newton.iter_mut().zip(step.precondition(term)) {
                    *x += rate * *since;
                }
            }
            let rest = step.remainder(&away);
            let image: Vec<Interval> = newton.iter().zip(&rest).map(|(p, q)| *q - *p).collect();
            if away.iter().zip(&image).all(|(x, k)| x.strictly_encloses(*k)) {
                for (k, c) in unknowns.iter().enumerate() {
                    found.unique[c.0] = boxed[k];
                    // The derivatives are not known yet.
                    found.coordinates[c.0] = Taylor::constant(points[k] + image[k]);
                    found.coordinates[c.0].coefficients_mut()[1..].fill(Interval::ENTIRE);
                }
                contraction = Some(step);
                break;
            }
            for k in 0..n {
                let reached = image[k].magnitude();
                if !(reached <= LARGEST_BOX * unit(k)) {
                    return Err(failed());
                }
                radius[k] = SLACK * reached + LEAST_BOX * unit(k);
            }
        }
        contraction.filter(|step| step.norm() <= CONTRACTION).ok_or_else(&failed)?;
        let mut inverse = None;
        for _ in 0..if wanted.narrow.is_some() { PASSES } else { 1 } {
            let boxed: Vec<Interval> = unknowns.iter().map(|c| found.coordinates[c.0].value()).collect();
            let jacobian = self.jacobian(topology, b, &boxed, &found.centres);
            if inverse.is_none() {
                inverse = Some(inverse_of(&jacobian, n).ok_or_else(&failed)?);
            }
            let step = Contraction::of(inverse.clone().unwrap_or_default(), &jacobian, n);
            if !(step.norm() <= CONTRACTION) {
                return Err(failed());
            }
            self.derivatives(topology, b, &step, found);
            if let Some(narrow) = wanted.narrow {
                for c in unknowns {
                    let x = &mut found.coordinates[c.0];
                    *x = x.narrowed(&narrow.coordinates[c.0], &wanted.since);
                }
            }
        }
        // The bodies of the block, for those that depend on it, and as results.
        let all: Vec<Taylor<Interval, N>> = unknowns.iter().map(|c| found.coordinates[c.0]).collect();
        let links = topology[b].link_ids();
        set(&mut self.values, topology, b, |k| all[k].value(), &found.centres);
        self.values.place(topology, &self.parts, links.clone());
        self.values.place_bodies(topology, &self.parts, links.clone());
        set(&mut self.columns, topology, b, |k| Dual::constant(all[k].value()), &found.centres);
        self.columns.place(topology, &self.parts_of_columns, links.clone());
        self.columns.place_bodies(topology, &self.parts_of_columns, links.clone());
        set(&mut self.series, topology, b, |k| all[k], &found.centres);
        self.series.place(topology, &self.parts_of_series, links.clone());
        self.series.place_bodies(topology, &self.parts_of_series, links);
        Ok(())
    }

    /// Coefficients of the unknowns, degree by degree: those of one degree are linear in the rows' coefficients of the
    /// same degree, with the Jacobian as the matrix.
    fn derivatives(
        &mut self,
        topology: &Topology,
        b: BlockId,
        step: &Contraction,
        found: &mut BoxEnclosure<N>,
    ) {
        let unknowns = &topology[b].unknowns;
        let degrees = Taylor::<Interval, N>::degrees();
        let mut begin = 1;
        while begin < N {
            let end = begin + degrees[begin..].iter().take_while(|d| **d == degrees[begin]).count();
            let lower = |k: usize| {
                let mut x = found.coordinates[unknowns[k].0];
                x.coefficients_mut()[begin..].fill(Interval::zero());
                x
            };
            set(&mut self.series, topology, b, lower, &found.centres);
            let demand = rows(&mut self.series, topology, &self.parts_of_series, &self.drivers_of_series, b);
            for e in begin..end {
                let demand: Vec<Interval> = demand.iter().map(|row| -row.coefficients()[e]).collect();
                let mut x: Vec<Interval> =
                    unknowns.iter().map(|c| found.coordinates[c.0].coefficients()[e]).collect();
                // The first bounds are those of the largest unknown, whatever its unit, for all of them.
                for _ in 0..SHARPENINGS {
                    x = step.solve(&demand, &x);
                }
                for (c, x) in unknowns.iter().zip(x) {
                    found.coordinates[c.0].coefficients_mut()[e] = x;
                }
            }
            begin = end;
        }
    }

    /// Jacobian of the selected rows by the unknowns of a block, row by row.
    fn jacobian(
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
            set(&mut self.columns, topology, b, of, centres);
            let found =
                rows(&mut self.columns, topology, &self.parts_of_columns, &self.drivers_of_columns, b);
            for (row, x) in found.into_iter().enumerate() {
                jacobian[row * n + column] = x.d;
            }
        }
        jacobian
    }
}

/// Values of drivers, bit by bit.
type Key = Vec<u64>;

/// All positions of a mechanism over ranges of its drivers, with proven bounds.
///
/// Drivers that are not variables remain in the design configuration.
pub(crate) struct DriverBoxes<'m, const N: usize> {
    one: Stepper<'m>,
    solver: BoxSolver<N>,
    /// Per variable: index of its driver.
    drivers: Vec<usize>,
    points: HashMap<Key, Result<Rc<BoxPoint<N>>, BoxFailure>>,
    /// Per box that was proved: what is unique in it, with the rotations from which the coordinates of balls count.
    unique: HashMap<Key, (Rc<Vec<Quat>>, Vec<Interval>)>,
    /// Number of boxes, points not counted, of which bounds were computed.
    pub computed: usize,
}

impl<'m, const N: usize> DriverBoxes<'m, N> {
    /// From a mechanism in its design configuration.
    pub fn new(mut one: Stepper<'m>, drivers: Vec<usize>) -> Result<Self, Box<Stop>> {
        start_at_rest(&mut one, 0.0)?;
        let solver = BoxSolver::new(&one.mechanism);
        let mut all =
            Self { one, solver, drivers, points: HashMap::new(), unique: HashMap::new(), computed: 0 };
        // The point at which all positions begin.
        let at = all.one.mechanism.saved.clone();
        let values = vec![0.0; all.drivers.len()];
        let point = all.enclose_point(&values, at);
        all.points.insert(key(&values), point);
        Ok(all)
    }

    /// Narrow bounds at a point.
    pub fn point(&mut self, values: &[f64]) -> Result<Rc<BoxPoint<N>>, BoxFailure> {
        let key = key(values);
        if let Some(known) = self.points.get(&key) {
            return known.clone();
        }
        let found = self.position(values).and_then(|at| self.enclose_point(values, at));
        self.points.insert(key, found.clone());
        found
    }

    fn enclose_point(&mut self, values: &[f64], at: AcceptedPosition) -> Result<Rc<BoxPoint<N>>, BoxFailure> {
        let boxed: Vec<Interval> = values.iter().map(|x| Interval::constant(*x)).collect();
        let wanted = Wanted { drivers: self.drivers_over(&boxed), since: Vec::new(), at: &at, narrow: None };
        let enclosure = self.solver.enclose(&self.one.mechanism.topology, &wanted)?;
        Ok(Rc::new(BoxPoint { at, enclosure }))
    }

    fn drivers_over(&self, boxed: &[Interval]) -> Vec<Taylor<Interval, N>> {
        let mut drivers = vec![Taylor::zero(); self.one.mechanism.model.drivers.len()];
        for (k, (d, over)) in self.drivers.iter().zip(boxed).enumerate() {
            drivers[*d] = Taylor::variable(*over, k);
        }
        drivers
    }

    /// Position at a point, by a straight path from the nearest one that is known.
    fn position(&mut self, values: &[f64]) -> Result<AcceptedPosition, BoxFailure> {
        let units = &self.one.mechanism.driver_units;
        let away = |at: &AcceptedPosition| {
            let part = |(d, x): (&usize, &f64)| ((at.drivers[*d][0] - x) / units[*d]).powi(2);
            self.drivers.iter().zip(values).map(part).sum::<f64>()
        };
        let known = self.points.iter().filter_map(|(key, known)| Some((key, &known.as_ref().ok()?.at)));
        // Ties are broken by the values, so that nothing depends on the order of the map.
        let near = known.min_by(|a, b| away(a.1).total_cmp(&away(b.1)).then_with(|| a.0.cmp(b.0)));
        let near = near.map(|(_, at)| at.clone());
        let one = &mut self.one;
        if let Some(near) = near {
            one.mechanism.saved = near;
        }
        let Mechanism { line, saved, .. } = &mut one.mechanism;
        for (line, now) in line.iter_mut().zip(&saved.drivers) {
            *line = [now[0]; 2];
        }
        for (d, x) in self.drivers.iter().zip(values) {
            line[*d][1] = *x;
        }
        let path = Path::Line { at: 0.0 };
        one.start_on(path, 0.0, true).map_err(BoxFailure::NotReached)?;
        walk(one, path, 1.0).map_err(BoxFailure::NotReached)?;
        accept_at_rest(one, 0.0);
        Ok(one.mechanism.saved.clone())
    }

    /// Bounds over a box, and those at its middle.
    pub fn over(&mut self, boxed: &[Interval]) -> Result<(BoxEnclosure<N>, Rc<BoxPoint<N>>), BoxFailure> {
        self.computed += 1;
        let values: Vec<f64> = boxed.iter().map(|over| over.middle()).collect();
        let middle = self.point(&values)?;
        let since = boxed.iter().zip(&values).map(|(over, x)| *over - Interval::constant(*x)).collect();
        let wanted = Wanted {
            drivers: self.drivers_over(boxed),
            since,
            at: &middle.at,
            narrow: Some(&middle.enclosure),
        };
        let found = self.solver.enclose(&self.one.mechanism.topology, &wanted)?;
        let unique = (found.centres.clone(), found.unique.clone());
        for corner in corners(boxed) {
            self.is_in(&unique, &corner)?;
        }
        self.unique.insert(key_of(boxed), unique);
        Ok((found, middle))
    }

    /// Proves that the position at a point of a box is the one of its enclosure.
    pub fn connect(&mut self, boxed: &[Interval], values: &[f64]) -> Result<(), BoxFailure> {
        let key = key_of(boxed);
        if !self.unique.contains_key(&key) {
            self.over(boxed)?;
        }
        let unique = self.unique[&key].clone();
        self.is_in(&unique, values)
    }

    fn is_in(&mut self, unique: &(Rc<Vec<Quat>>, Vec<Interval>), values: &[f64]) -> Result<(), BoxFailure> {
        let point = self.point(values)?;
        let narrow = &point.enclosure;
        let at = (&narrow.centres[..], |k: usize| narrow.coordinates[k].value());
        let same = is_within(&self.one.mechanism.topology, at, (&unique.0, &unique.1));
        if same { Ok(()) } else { Err(BoxFailure::OtherBranch) }
    }
}

fn key_of(boxed: &[Interval]) -> Key {
    key(&boxed.iter().flat_map(|over| [over.low, over.high]).collect::<Vec<f64>>())
}

fn key(values: &[f64]) -> Key {
    // Zero has one sign.
    values.iter().map(|x| (x + 0.0).to_bits()).collect()
}

/// Corners of a box.
fn corners(boxed: &[Interval]) -> impl Iterator<Item = Vec<f64>> {
    (0..1_usize << boxed.len()).map(|corner| {
        let end = |(k, over): (usize, &Interval)| if corner >> k & 1 == 0 { over.low } else { over.high };
        boxed.iter().enumerate().map(end).collect()
    })
}
