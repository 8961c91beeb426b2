//! Assembly of a mechanism whose joints are open in the design configuration.
//!
//! Lengths and points that do not fit leave gaps in the design configuration. The gaps are closed along a path: their
//! open fraction runs from 1 to 0 while every driver stays at zero, in steps that check for limits and branches like
//! those of any motion. So the mechanism closes on the branch of the design configuration, and an assembled one stays
//! unchanged. The path may end before the gaps are closed, as from a singular design configuration (bars in line). Then
//! the nominal design is also assembled from positions around it, by least squares, and the nearest assembly is taken.
//! If there is none, least squares give the smallest gaps.

use crate::joint::Quantity;
use crate::linalg::Elimination;
use crate::model::{BodyId, Contact, DriverId, JointId};
use crate::space::{Quat, Vec3};
use crate::topology::{BlockId, CoordinateId, LoopLink, RowId, RowTerm, Topology};

use super::kinematics::State;
use super::parts::PlanGeometry;
use super::stepper::{AcceptedPosition, Stepper};
use super::walk::Path;
use super::{Stop, StopKind};

/// Gaps below this fraction of the mechanism's size (or, for a cosine, below this) are round-off.
const CLOSED: f64 = 1e-12;
/// Smallest reported gap: coordinates typed into a file agree to about this fraction of the size.
const REPORTED_GAP: f64 = 1e-7;
/// The least-squares search ends when a step reduces its sum of squares by less than this fraction.
const NO_BETTER: f64 = 1e-12;
/// Maximum number of steps of the search.
const MAX_SEARCH: usize = 200;
/// A design configuration is singular if its path ends before this fraction of the gaps is closed. A path that ends
/// later ends at a limit of the mechanism; starting from nearby positions does not help then.
pub(super) const SINGULAR_DRAWING: f64 = 0.05;
/// Scaled residual below which a search has found an assembly; Newton's method closes the rest.
const FOUND: f64 = 1e-7;
/// Assemblies, and distances from the design configuration, are equal if they differ by less than this, rad or sizes.
const ONE_ASSEMBLY: f64 = 1e-5;
/// Deviations from the design configuration at which searches start, rad or sizes; each is tried in [`DIRECTIONS`]
/// directions and their opposites.
const DEVIATIONS: [f64; 3] = [0.03, 0.2, 0.8];
const DIRECTIONS: usize = 3;
/// Largest dense system of a search, so that a failure is reported within seconds.
const LARGEST_SEARCH: usize = 150;

/// Assembly of a mechanism that was open in the design configuration.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Assembly {
    /// Open constraints of the design configuration, largest gaps first.
    pub gaps: Vec<Gap>,
    /// Bodies that moved, with their displacements.
    pub moved: Vec<AssemblyShift>,
    /// Number of assemblies found around the design configuration if the path from it leads to none; the nearest was
    /// chosen. 0 if the path closed the mechanism.
    pub found_nearby: usize,
}

/// Gap of an open constraint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Open constraint.
    pub of: Closing,
    /// Size, m or as a cosine.
    pub size: f64,
    /// Quantity of the gap.
    pub quantity: Quantity,
}

/// A constraint that closes a mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Closing {
    /// A joint.
    Joint(JointId),
    /// A driver across a cut joint.
    Driver(DriverId),
    /// A coupler, by its index in the model.
    Coupler(usize),
}

/// Displacement of a body by the assembly, relative to the design configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AssemblyShift {
    /// The body.
    pub body: BodyId,
    /// Displacement of the origin of its frame, m.
    pub distance: f64,
    /// Angle of its rotation, rad.
    pub angle: f64,
}

/// An assembly that was found around the design configuration.
struct FoundAssembly {
    /// Distance of the bodies from the design configuration, in sizes and rad.
    distance: f64,
    /// Side to which they moved; it decides between assemblies at the same distance.
    side: f64,
    q: Vec<f64>,
    balls: Vec<Quat<f64>>,
    contacts: Vec<Contact<f64>>,
}

impl FoundAssembly {
    /// Returns true if distance and side are the same.
    fn is_same(&self, other: &Self) -> bool {
        (self.distance - other.distance).abs() <= ONE_ASSEMBLY
            && (self.side - other.side).abs() <= ONE_ASSEMBLY
    }
}

impl State<f64> {
    /// Largest gap of the design configuration, in sizes or as a cosine.
    pub(super) fn largest_gap(&self, topology: &Topology) -> f64 {
        // max over the rows of abs(phi_0) / unit
        let scaled = self.gap.iter().zip(&topology.rows).map(|(gap, place)| gap.abs() / place.unit);
        scaled.fold(0.0, f64::max)
    }
}

impl Stepper<'_> {
    /// Assembles the mechanism in the design configuration, with all drivers at zero, on its branch.
    pub(super) fn assemble(&mut self) -> Result<(), Box<Stop>> {
        // phi_0 at q = 0; round-off counts as closed.
        self.measure_gaps();
        if !(self.state.largest_gap(&self.topology) > CLOSED) {
            self.state.gap.fill(0.0);
            return self.assemble_along_path();
        }
        let drawn = (self.saved.clone(), self.topology.clone());
        let gaps = self.gaps(|s, r| s.state.gap[r.0], REPORTED_GAP);
        let mut found_nearby = 0;
        if let Err(stop) = self.assemble_along_path() {
            found_nearby = match self.is_searched(&stop) {
                true => self.assemble_nearby(&drawn),
                false => 0,
            };
            if found_nearby == 0 {
                return Err(stop);
            }
        }
        if !gaps.is_empty() {
            self.assembly = Some(Assembly { gaps, moved: self.moved(REPORTED_GAP), found_nearby });
        }
        self.state.gap.fill(0.0);
        self.state.gap_left = [0.0; 2];
        Ok(())
    }

    /// Closes the gaps along the path from the design configuration.
    fn assemble_along_path(&mut self) -> Result<(), Box<Stop>> {
        self.time = 0.0;
        // s = 0: phi - phi_0 = 0 holds in the design configuration; the signs of the determinants there define the
        // branch.
        let drawn = self.drive(Path::Assembly, 0.0).and_then(|()| {
            self.restore();
            self.solve_within(f64::INFINITY)
        });
        self.settle_branch();
        let is_open = self.state.largest_gap(&self.topology) > 0.0;
        // If the design configuration is singular, none of its gaps can be closed along the path.
        let of_assembly = |mut stop: Box<Stop>| {
            if is_open && !matches!(stop.kind, StopKind::Locked { .. }) {
                stop.kind = StopKind::DoesNotAssemble;
            }
            stop
        };
        let drawn = drawn.and_then(|()| self.examine_position());
        drawn.map_err(|r| of_assembly(self.stop(Path::Assembly, 0.0, r, false)))?;
        self.save(0.0, 0.0);
        if !is_open {
            return Ok(());
        }
        // phi - (1 - s) phi_0 = 0 from s = 0 to 1
        self.walk(Path::Assembly, 1.0).map_err(of_assembly)
    }

    /// Returns true if an assembly is searched for around the design configuration: if that is singular, and the path
    /// does not close the nominal design either. A changed design is on the branch of the nominal one, or does not
    /// assemble.
    fn is_searched(&self, stop: &Stop) -> bool {
        if matches!(
            stop.kind,
            StopKind::LawNotFinite { .. } | StopKind::TooFar { .. } | StopKind::Interrupted
        ) || self.time > SINGULAR_DRAWING
        {
            return false;
        }
        let (design, laws) = (self.model.geometry(&[]), self.model.laws(&[]));
        let parts = PlanGeometry::same(self.model, &self.topology, &design, &laws);
        let mut nominal = Stepper::new(self.model, &self.topology, parts);
        nominal.measure_gaps();
        // With the same gaps it is the nominal design itself.
        nominal.state.gap == self.state.gap || nominal.assemble_along_path().is_err()
    }

    /// Assembles the mechanism from positions around the design configuration, and moves to the nearest assembly.
    /// Returns the number of assemblies found, or 0.
    fn assemble_nearby(&mut self, drawn: &(AcceptedPosition, Topology)) -> usize {
        let unknowns: Vec<CoordinateId> = self.topology.unknown_coordinates().collect();
        if unknowns.len() > LARGEST_SEARCH {
            return 0;
        }
        let blocks = self.topology.block_ids();
        let rows: Vec<RowId> = blocks.flat_map(|b| self.topology.rows_of_block(b)).collect();
        let mut found: Vec<FoundAssembly> = Vec::new();
        for start in 0..DEVIATIONS.len() * DIRECTIONS * 2 {
            self.deviate(drawn, &unknowns, start);
            if !(self.search(&rows, &unknowns) <= FOUND) || !self.stand_assembled() {
                continue;
            }
            let assembly = self.found_assembly();
            if found.iter().all(|other| !other.is_same(&assembly)) {
                found.push(assembly);
            }
        }
        // The nearest assembly; on equal distance that on the positive side.
        let nearest = found.iter().map(|a| a.distance).fold(f64::INFINITY, f64::min) + ONE_ASSEMBLY;
        let near = found.iter().filter(|a| a.distance <= nearest);
        let Some(taken) = near.max_by(|a, b| a.side.total_cmp(&b.side)) else {
            self.set_drawn(drawn);
            return 0;
        };
        self.state.q.copy_from_slice(&taken.q);
        self.state.balls.copy_from_slice(&taken.balls);
        self.state.contacts.copy_from_slice(&taken.contacts);
        if self.stand_assembled() { found.len() } else { 0 }
    }

    /// Returns to the design configuration, with its selected rows.
    fn set_drawn(&mut self, (drawn, topology): &(AcceptedPosition, Topology)) {
        let blocks: Vec<BlockId> = self.topology.block_ids().collect();
        let changed = blocks.into_iter().filter(|b| self.topology[*b].selected != topology[*b].selected);
        let changed: Vec<BlockId> = changed.collect();
        self.topology.clone_from(topology);
        changed.into_iter().for_each(|b| self.renew_factors(b));
        self.saved.clone_from(drawn);
        self.restore();
    }

    /// Deviates from the design configuration, in one of several directions without symmetry.
    fn deviate(&mut self, drawn: &(AcceptedPosition, Topology), unknowns: &[CoordinateId], start: usize) {
        self.set_drawn(drawn);
        let deviation =
            DEVIATIONS[start / (2 * DIRECTIONS)] * if start.is_multiple_of(2) { 1.0 } else { -1.0 };
        let direction = start / 2 % DIRECTIONS;
        for (k, &c) in unknowns.iter().enumerate() {
            // Multiples of the golden ratio are spread evenly and never repeat.
            let part = ((1 + k + direction * unknowns.len()) as f64 * 0.618_033_988_749_895).fract();
            // The first direction moves all coordinates alike, the others each to its own side.
            let part = if direction == 0 { 0.5 + 0.5 * part } else { 2.0 * part - 1.0 };
            self.state.q[c.0] += deviation * part * self.topology[c].unit;
        }
        self.state.turn_balls(&self.topology, self.topology.link_ids());
    }

    /// Closes the mechanism at the end of a search, with rows that are independent there; returns true if the position
    /// is regular.
    fn stand_assembled(&mut self) -> bool {
        self.time = 1.0;
        if self.drive(Path::Assembly, 1.0).is_err() {
            return false;
        }
        self.state.stand(&self.topology, &self.parts);
        for (r, _) in RowId::each(&self.topology.rows) {
            self.state.l[0][r.0] = self.state.wrench_of(&self.topology, r);
        }
        self.try_others.fill(f64::INFINITY);
        // The signs of the determinants define this branch, before and after the selection of rows.
        if self.reselect().is_err() || self.solve_within(f64::INFINITY).is_err() {
            return false;
        }
        self.settle_branch();
        for r in self.topology.coupler_terms() {
            self.state.near[r.0] = self.state.coordinate_of_row(&self.topology, r)[0];
        }
        // A pivot that is zero within round-off of the search means bars in line: no motion is defined there.
        let regular = self.state.pivots.iter().all(|(ratio, _)| *ratio > FOUND);
        if !regular || self.examine_position().is_err() {
            return false;
        }
        self.save(1.0, 0.0);
        true
    }

    /// Assembly at the current position, with its distance from the design configuration.
    fn found_assembly(&self) -> FoundAssembly {
        let size = self.model.size();
        let (mut distance, mut side) = (0.0, 0.0);
        for (body, pose) in self.model.bodies.iter().zip(&self.state.pose).skip(1) {
            for at in Vec3::AXES {
                // Three points of each body, one size from its origin, with different weights for different sides.
                let moved = (pose.point(at * size) - body.frame.point(at * size)) * (1.0 / size);
                distance += moved.dot(moved);
                side += moved.x + 0.618_033_988_749_895 * moved.y + 0.381_966_011_250_105 * moved.z;
            }
        }
        FoundAssembly {
            distance: f64::sqrt(distance),
            side,
            q: self.state.q.clone(),
            balls: self.state.balls.clone(),
            contacts: self.state.contacts.clone(),
        }
    }

    /// Computes the residual of every row in the design configuration, with closed tree joints.
    fn measure_gaps(&mut self) {
        let zero = 0.0;
        self.drivers.fill([zero; 3]);
        self.state.gap_left = [0.0; 2];
        self.state.stand(&self.topology, &self.parts);
        for (r, place) in RowId::each(&self.topology.rows) {
            self.state.gap[r.0] = if place.is_term {
                zero
            } else {
                // phi_0, with q = 0 and all drivers at 0
                self.state.residual_of(&self.topology, &self.parts, &self.drivers, r)
            };
        }
    }

    /// Gaps per joint, driver or coupler, from a value per row; those below `least` are left out.
    fn gaps(&self, of_row: impl Fn(&Self, RowId) -> f64, least: f64) -> Vec<Gap> {
        let mut gaps: Vec<(Gap, f64)> = Vec::new();
        for (r, place) in RowId::each(&self.topology.rows).filter(|(_, p)| !p.is_term) {
            let closure = &self.topology[place.closure];
            let of = match (closure.driver, closure.coupler) {
                (Some(d), _) => Closing::Driver(d),
                (None, Some(c)) => Closing::Coupler(c),
                (None, None) => Closing::Joint(closure.joint),
            };
            let size = of_row(self, r);
            if !(size.abs() > least * place.unit) {
                continue;
            }
            let quantity = closure.rows[place.index].into();
            match gaps.iter_mut().find(|(g, _)| g.of == of && g.quantity == quantity) {
                // The norm over several open rows of a joint.
                Some((gap, _)) => gap.size = gap.size.hypot(size),
                None => gaps.push((Gap { of, size: size.abs(), quantity }, place.unit)),
            }
        }
        gaps.sort_by(|(a, unit_a), (b, unit_b)| (b.size / unit_b).total_cmp(&(a.size / unit_a)));
        gaps.into_iter().map(|(gap, _)| gap).collect()
    }

    /// Displacements of the bodies relative to the design configuration.
    fn moved(&self, least: f64) -> Vec<AssemblyShift> {
        let bodies = self.model.bodies.iter().enumerate().skip(1);
        let moved = bodies.map(|(b, body)| {
            let pose = &self.state.pose[b];
            AssemblyShift {
                body: BodyId(b),
                distance: (pose.r - body.frame.r).norm(),
                angle: pose.rot.angle_to(body.frame.rot),
            }
        });
        let size = self.model.size();
        moved.filter(|m| m.distance > least * size || m.angle > least).collect()
    }
}

impl Stepper<'_> {
    /// Smallest gaps that the joints can reach: least squares over the residuals of all rows of the block that could
    /// not be closed, from the end of the path; for a singular design configuration also from positions around it.
    pub fn least_gaps(&mut self, block: BlockId) -> Vec<Gap> {
        self.state.gap_left = [0.0; 2];
        self.restore();
        let (unknowns, rows) = (self.topology[block].unknowns.clone(), self.topology.rows_of_block(block));
        let is_singular = self.time <= SINGULAR_DRAWING && unknowns.len() <= LARGEST_SEARCH;
        let starts = if is_singular { DEVIATIONS.len() * DIRECTIONS * 2 } else { 0 };
        let ended = (self.saved.clone(), self.topology.clone());
        let mut best: Option<(f64, Vec<Gap>)> = None;
        for start in [None].into_iter().chain((0..starts).map(Some)) {
            if let Some(start) = start {
                self.deviate(&ended, &unknowns, start);
            }
            self.search(&rows, &unknowns);
            let (residuals, _) = self.scaled_rows(&rows, &unknowns);
            let squares = residuals.iter().map(|r| r * r).sum::<f64>();
            // An improvement within round-off is ignored.
            if best.as_ref().is_none_or(|(least, _)| squares < (1.0 - ONE_ASSEMBLY) * least) {
                let of_row = |s: &Self, r: RowId| s.state.residual_of(&s.topology, &s.parts, &s.drivers, r);
                best = Some((squares, self.gaps(of_row, REPORTED_GAP)));
            }
        }
        best.map_or_else(Vec::new, |(_, gaps)| gaps)
    }

    /// Moves these unknowns to where the residuals of these rows are smallest, by least squares; returns the largest
    /// scaled residual.
    ///
    /// This is the Levenberg-Marquardt method for the scaled rows; it need not be fast.
    fn search(&mut self, rows: &[RowId], unknowns: &[CoordinateId]) -> f64 {
        self.state.gap_left = [0.0; 2];
        let n = unknowns.len();
        let mut damping = 1e-3;
        let (mut residuals, mut jacobian) = self.scaled_rows(rows, unknowns);
        let squares = |r: &[f64]| r.iter().map(|x| x * x).sum::<f64>();
        for _ in 0..MAX_SEARCH {
            let mut normal = Elimination::new(n);
            let mut step = vec![0.0; n];
            for k in 0..n {
                for c in 0..n {
                    let dot: f64 = jacobian.iter().map(|row| row[k] * row[c]).sum();
                    // (J^T J + damping I) step = -J^T phi,  in units of rows and coordinates                       (36)
                    normal.row_mut(k)[c] = dot + if k == c { damping } else { 0.0 };
                }
                step[k] = -jacobian.iter().zip(&residuals).map(|(row, r)| row[k] * r).sum::<f64>();
            }
            normal.factor();
            normal.solve(&mut step);
            let before = (self.state.q.clone(), self.state.balls.clone(), self.state.contacts.clone());
            for (k, &c) in unknowns.iter().enumerate() {
                self.state.q[c.0] += step[k] * self.topology[c].unit;
            }
            self.state.turn_balls(&self.topology, self.topology.link_ids());
            let (now, jacobian_now) = self.scaled_rows(rows, unknowns);
            let (old, new) = (squares(&residuals), squares(&now));
            // A successful step reduces the damping (Gauss-Newton), another one increases it (gradient descent).
            if new < old {
                (residuals, jacobian) = (now, jacobian_now);
                damping *= 0.3;
                if old - new <= NO_BETTER * old {
                    break;
                }
            } else {
                (self.state.q, self.state.balls, self.state.contacts) = before;
                damping *= 4.0;
                if damping > 1e12 {
                    break;
                }
            }
        }
        residuals.iter().fold(0.0, |most: f64, r| if r.abs() <= most { most } else { r.abs() })
    }

    /// Scaled residuals of constraint rows, and their derivatives by these coordinates.
    fn scaled_rows(&mut self, rows: &[RowId], unknowns: &[CoordinateId]) -> (Vec<f64>, Vec<Vec<f64>>) {
        self.state.stand(&self.topology, &self.parts);
        let mut residuals = Vec::new();
        let mut jacobian = Vec::new();
        for &r in rows {
            let s = &self.state;
            let scale = 1.0 / self.topology[r].unit;
            residuals.push(scale * s.residual_of(&self.topology, &self.parts, &self.drivers, r));
            let mut by_coordinate = std::collections::BTreeMap::new();
            for RowTerm { row, factor } in self.topology.parts_of_row(r) {
                let wrench = s.wrench_of(&self.topology, row);
                for &LoopLink { link, side } in &self.topology.closure_of(row).links {
                    for c in self.topology[link].coordinates() {
                        let unit = self.topology[c].unit;
                        // J_ra = +- c_k l_k . x_a                                                                   (6)
                        *by_coordinate.entry(c).or_insert(0.0) +=
                            scale * unit * side * factor * wrench.on(s.x[0][c.0]);
                    }
                }
            }
            jacobian.push(unknowns.iter().map(|c| by_coordinate.get(c).copied().unwrap_or(0.0)).collect());
        }
        (residuals, jacobian)
    }
}
