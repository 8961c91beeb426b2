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
use crate::number::{Interval, Taylor, degrees};
use crate::space::{Pose, Quat, Real};
use crate::topology::{BlockId, Topology};

use super::Stop;
use super::advance::{accept_at_rest, start_at_rest};
use super::contraction::{
    BlockSolver, CONTRACTION, Contracted, Contraction, LEAST_BOX, inverse_of, is_within,
};
use super::mechanism::{AcceptedPosition, Mechanism};
use super::path::Path;
use super::stepper::Stepper;
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
pub(crate) struct BoxEnclosure {
    /// Per body: bounds of its pose, with its Taylor coefficients in the drivers.
    pub poses: Vec<Pose<Taylor<Interval>>>,
    /// Per coordinate that begins a ball: its rotation at the middle, nearly.
    centres: Rc<Vec<Quat>>,
    /// Per coordinate: box in which exactly one position belongs to each point.
    unique: Vec<Interval>,
    /// Per block: its residuals at the middle of its coordinates.
    residuals: Vec<Vec<Interval>>,
    /// Per coordinate.
    coordinates: Vec<Taylor<Interval>>,
}

/// One point of the drivers' range.
pub(crate) struct BoxPoint {
    at: AcceptedPosition,
    /// Narrow bounds.
    pub enclosure: BoxEnclosure,
}

/// Box of driver values with what is known at its middle.
struct Wanted<'w> {
    /// Coordinate of every driver of the mechanism.
    drivers: Vec<Taylor<Interval>>,
    /// Distance of every variable from the middle.
    since: Vec<Interval>,
    at: &'w AcceptedPosition,
    narrow: Option<&'w BoxEnclosure>,
    /// Number of variables.
    variables: usize,
}

/// Computes enclosures of one mechanism.
struct BoxSolver(BlockSolver<Taylor<Interval>>);

impl BoxSolver {
    fn new(mechanism: &Mechanism<'_>) -> Self {
        let Mechanism { model, topology, parts, .. } = mechanism;
        Self(BlockSolver::new(model, topology, parts, Taylor::value))
    }

    fn enclose(&mut self, topology: &Topology, wanted: &Wanted<'_>) -> Result<BoxEnclosure, BoxFailure> {
        if let Some((c, _)) = topology.contacts().next() {
            return Err(BoxFailure::FollowsCurve { joint: topology[c].joint });
        }
        self.0.drive(topology, &wanted.drivers, wanted.at);
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
        }
        for b in topology.block_ids() {
            self.enclose_block(topology, b, wanted, &mut found)?;
        }
        found.poses = self.0.series.state.pose.clone();
        if let Some(narrow) = wanted.narrow {
            let since = &wanted.since;
            for (pose, at) in found.poses.iter_mut().zip(&narrow.poses) {
                let narrowed = |x: Taylor<Interval>, at: &Taylor<Interval>| x.narrowed(at, since);
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
        wanted: &Wanted<'_>,
        found: &mut BoxEnclosure,
    ) -> Result<(), BoxFailure> {
        let unknowns = &topology[b].unknowns;
        let n = unknowns.len();
        if n > LARGEST_DENSE {
            return Err(BoxFailure::TooLarge { block: b });
        }
        let failed = || BoxFailure::NoContraction { block: b };
        let points: Vec<Interval> = unknowns.iter().map(|c| Interval::constant(wanted.at.q[c.0])).collect();
        // phi(m, d) + phi_d(m, D) (D - d): one term for each variable, to be preconditioned before it is added.
        let (start, terms) = match wanted.narrow {
            Some(narrow) => {
                let fixed = |k: usize| Taylor::constant(points[k]).to_degree(1);
                let moved = self.0.series.rows(topology, b, &fixed, &found.centres);
                let term = |v: usize| moved.iter().map(|row| row.coefficients()[1 + v]).collect::<Vec<_>>();
                (narrow.residuals[b.0].clone(), (0..wanted.since.len()).map(term).collect())
            }
            None => {
                let residual = self.0.values.rows(topology, b, &|k| points[k], &found.centres);
                found.residuals.push(residual.clone());
                (residual, Vec::new())
            }
        };
        let newton = |step: &Contraction| {
            let mut newton = step.precondition(&start);
            for (term, since) in terms.iter().zip(&wanted.since) {
                for (x, rate) in newton.iter_mut().zip(step.precondition(term)) {
                    *x += rate * *since;
                }
            }
            newton
        };
        let radius = unknowns.iter().map(|c| LEAST_BOX * topology[*c].unit).collect();
        let Contracted { unique, bounds } =
            self.0.contract(topology, b, (&points, radius), &found.centres, &newton).ok_or_else(failed)?;
        for (k, c) in unknowns.iter().enumerate() {
            found.unique[c.0] = unique[k];
            // The derivatives are not known yet.
            found.coordinates[c.0] = Taylor::of_value(bounds[k], wanted.variables, Interval::ENTIRE);
        }
        let mut inverse = None;
        for _ in 0..if wanted.narrow.is_some() { PASSES } else { 1 } {
            let boxed: Vec<Interval> = unknowns.iter().map(|c| found.coordinates[c.0].value()).collect();
            let jacobian = self.0.jacobian(topology, b, &boxed, &found.centres);
            if inverse.is_none() {
                inverse = Some(inverse_of(&jacobian, n).ok_or_else(failed)?);
            }
            let step = Contraction::of(inverse.clone().unwrap_or_default(), &jacobian, n);
            if !(step.norm() <= CONTRACTION) {
                return Err(failed());
            }
            self.derivatives(topology, b, &step, wanted.variables, found);
            if let Some(narrow) = wanted.narrow {
                for c in unknowns {
                    let x = &mut found.coordinates[c.0];
                    *x = x.narrowed(&narrow.coordinates[c.0], &wanted.since);
                }
            }
        }
        let all: Vec<Taylor<Interval>> = unknowns.iter().map(|c| found.coordinates[c.0]).collect();
        self.0.place(topology, b, &all, &found.centres);
        Ok(())
    }

    /// Coefficients of the unknowns, degree by degree: those of one degree are linear in the rows' coefficients of the
    /// same degree, with the Jacobian as the matrix.
    fn derivatives(
        &mut self,
        topology: &Topology,
        b: BlockId,
        step: &Contraction,
        variables: usize,
        found: &mut BoxEnclosure,
    ) {
        let unknowns = &topology[b].unknowns;
        let degrees = degrees(variables);
        let mut begin = 1;
        while begin < degrees.len() {
            let end = begin + degrees[begin..].iter().take_while(|d| **d == degrees[begin]).count();
            let lower = |k: usize| {
                let mut x = found.coordinates[unknowns[k].0];
                x.coefficients_mut()[begin..].fill(Interval::zero());
                x.to_degree(degrees[begin])
            };
            let demand = self.0.series.rows(topology, b, &lower, &found.centres);
            for e in begin..end {
                let demand: Vec<Interval> = demand.iter().map(|row| -row.coefficients()[e]).collect();
                let mut x: Vec<Interval> =
                    unknowns.iter().map(|c| found.coordinates[c.0].coefficients()[e]).collect();
                // The first bounds are those of the largest unknown in the weights of the norm, for all of them.
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
}

/// Values of drivers, bit by bit.
type Key = Vec<u64>;

/// All positions of a mechanism over ranges of its drivers, with proven bounds.
///
/// Drivers that are not variables remain in the design configuration.
pub(crate) struct DriverBoxes<'m> {
    one: Stepper<'m>,
    solver: BoxSolver,
    /// Per variable: index of its driver.
    drivers: Vec<usize>,
    /// Positions without derivatives, which connect boxes at their corners.
    positions: HashMap<Key, Result<Rc<BoxPoint>, BoxFailure>>,
    /// The same with derivatives.
    points: HashMap<Key, Result<Rc<BoxPoint>, BoxFailure>>,
    /// Per box that was proved: what is unique in it, with the rotations from which the coordinates of balls count.
    unique: HashMap<Key, (Rc<Vec<Quat>>, Vec<Interval>)>,
    /// Number of boxes, points not counted, of which bounds were computed.
    pub computed: usize,
}

impl<'m> DriverBoxes<'m> {
    /// From a mechanism in its design configuration.
    pub fn new(mut one: Stepper<'m>, drivers: Vec<usize>) -> Result<Self, Box<Stop>> {
        start_at_rest(&mut one, 0.0)?;
        let solver = BoxSolver::new(&one.mechanism);
        let (positions, points) = (HashMap::new(), HashMap::new());
        let mut all = Self { one, solver, drivers, positions, points, unique: HashMap::new(), computed: 0 };
        // The point at which all positions begin.
        let at = all.one.mechanism.saved.clone();
        let values = vec![0.0; all.drivers.len()];
        let point = all.enclose_point(&values, at, false);
        all.positions.insert(key(&values), point);
        Ok(all)
    }

    /// Narrow bounds at a point.
    pub fn point(&mut self, values: &[f64]) -> Result<Rc<BoxPoint>, BoxFailure> {
        let key = key(values);
        if let Some(known) = self.points.get(&key) {
            return known.clone();
        }
        let found = self.position(values);
        let found = found.and_then(|position| self.enclose_point(values, position.at.clone(), true));
        self.points.insert(key, found.clone());
        found
    }

    /// Narrow bounds of the position at a point, without derivatives.
    fn position(&mut self, values: &[f64]) -> Result<Rc<BoxPoint>, BoxFailure> {
        let key = key(values);
        if let Some(known) = self.positions.get(&key) {
            return known.clone();
        }
        let found = self.reach(values).and_then(|at| self.enclose_point(values, at, false));
        self.positions.insert(key, found.clone());
        found
    }

    fn enclose_point(
        &mut self,
        values: &[f64],
        at: AcceptedPosition,
        derivatives: bool,
    ) -> Result<Rc<BoxPoint>, BoxFailure> {
        let boxed: Vec<Interval> = values.iter().map(|x| Interval::constant(*x)).collect();
        let variables = if derivatives { values.len() } else { 0 };
        let drivers = self.drivers_over(&boxed, variables);
        let wanted = Wanted { drivers, since: Vec::new(), at: &at, narrow: None, variables };
        let enclosure = self.solver.enclose(&self.one.mechanism.topology, &wanted)?;
        Ok(Rc::new(BoxPoint { at, enclosure }))
    }

    /// Coordinate of every driver over a box of driver values, as variables or as constants.
    fn drivers_over(&self, boxed: &[Interval], variables: usize) -> Vec<Taylor<Interval>> {
        let drivers = &self.one.mechanism.model.drivers;
        let mut coordinates = vec![Taylor::zero(); drivers.len()];
        for (k, (d, over)) in self.drivers.iter().zip(boxed).enumerate() {
            let value = match variables {
                0 => Taylor::constant(*over),
                _ => Taylor::variable(*over, k, variables),
            };
            coordinates[*d] = drivers[*d].with_sense(value);
        }
        coordinates
    }

    /// Position at a point, by a straight path from the nearest one that is known.
    fn reach(&mut self, values: &[f64]) -> Result<AcceptedPosition, BoxFailure> {
        let Mechanism { model, driver_units: units, .. } = &self.one.mechanism;
        let coordinates: Vec<f64> =
            self.drivers.iter().zip(values).map(|(d, x)| model.drivers[*d].with_sense(*x)).collect();
        let away = |at: &AcceptedPosition| {
            let part = |(d, x): (&usize, &f64)| ((at.drivers[*d][0] - x) / units[*d]).powi(2);
            self.drivers.iter().zip(&coordinates).map(part).sum::<f64>()
        };
        let known = self.positions.iter().filter_map(|(key, known)| Some((key, &known.as_ref().ok()?.at)));
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
        for (d, x) in self.drivers.iter().zip(&coordinates) {
            line[*d][1] = *x;
        }
        let path = Path::Line { at: 0.0 };
        one.start_on(path, 0.0, true).map_err(BoxFailure::NotReached)?;
        walk(one, path, 1.0).map_err(BoxFailure::NotReached)?;
        accept_at_rest(one, 0.0);
        Ok(one.mechanism.saved.clone())
    }

    /// Bounds over a box, and those at its middle.
    pub fn over(&mut self, boxed: &[Interval]) -> Result<(BoxEnclosure, Rc<BoxPoint>), BoxFailure> {
        self.computed += 1;
        let values: Vec<f64> = boxed.iter().map(|over| over.middle()).collect();
        let middle = self.point(&values)?;
        let since = boxed.iter().zip(&values).map(|(over, x)| *over - Interval::constant(*x)).collect();
        let wanted = Wanted {
            drivers: self.drivers_over(boxed, boxed.len()),
            since,
            at: &middle.at,
            narrow: Some(&middle.enclosure),
            variables: self.drivers.len(),
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
        let point = self.position(values)?;
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
