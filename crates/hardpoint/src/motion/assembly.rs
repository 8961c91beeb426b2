//! Closing a mechanism whose joints are open in the drawing.
//!
//! Lengths and places that don't fit leave gaps in the configuration as drawn. The gaps are closed along a path: the part
//! of them that is still open runs from 1 to 0 while every driver stays at zero, in steps that watch for limits and
//! branches like those of any motion. So the mechanism closes on the branch that was drawn, and an assembled one stays as
//! it is. Where the path ends before the gaps are closed, least squares say how near the joints can come.

use crate::joint::Quantity;
use crate::linalg::Elimination;
use crate::model::{BodyId, DriverId, JointId};
use crate::topology::{BlockId, CoordinateId, LoopLink, RowId, Term, Topology};

use super::kinematics::State;
use super::stepper::Stepper;
use super::walk::Path;
use super::{Stop, StopKind};

/// A gap below this part of the mechanism's size (or, for a cosine, below this) is round-off of the drawing.
const CLOSED: f64 = 1e-12;
/// A gap that is worth telling: typed coordinates agree to about this part of the size.
const WORTH_TELLING: f64 = 1e-7;
/// The least-squares search ends when a step improves its sum of squares by less than this part.
const NO_BETTER: f64 = 1e-12;
/// ... or after so many steps.
const MAX_SEARCH: usize = 200;

/// How a mechanism that did not close as drawn was closed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Assembly {
    /// What was open in the drawing, largest gaps first.
    pub gaps: Vec<Gap>,
    /// The bodies that moved, as far as they did.
    pub moved: Vec<AssemblyShift>,
}

/// A constraint that is open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// What is open.
    pub of: Closing,
    /// By how much, m or as a cosine.
    pub size: f64,
    /// What that is.
    pub quantity: Quantity,
}

/// What keeps a mechanism together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Closing {
    /// A joint.
    Joint(JointId),
    /// A driver across a cut joint.
    Driver(DriverId),
    /// A coupler, by its place in the model.
    Coupler(usize),
}

/// How far the assembly moved a body from where it was drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AssemblyShift {
    /// Which body.
    pub body: BodyId,
    /// By how much its frame's origin moved, m.
    pub distance: f64,
    /// By how much it turned, rad.
    pub angle: f64,
}

impl State<f64> {
    /// The largest gap of the drawing, in sizes or as a cosine.
    pub(super) fn largest_gap(&self, topology: &Topology) -> f64 {
        // max over the rows of abs(phi_0) / unit
        let scaled = self.gap.iter().zip(&topology.rows).map(|(gap, place)| gap.abs() / place.unit);
        scaled.fold(0.0, f64::max)
    }
}

impl Stepper<'_> {
    /// Closes the mechanism as drawn, all drivers at zero, and stands on its branch.
    pub(super) fn assemble(&mut self) -> Result<(), Box<Stop>> {
        // phi_0 at q = 0; what is round-off of the drawing counts as closed.
        self.measure_gaps();
        if !(self.state.largest_gap(&self.topology) > CLOSED) {
            self.state.gap.fill(0.0);
        }
        self.time = 0.0;
        // s = 0: phi - phi_0 = 0 holds where it is drawn, and the signs of the determinants there say which branch this is.
        let drawn = self.drive(Path::Assembly, 0.0).and_then(|()| {
            self.restore();
            self.solve_within(f64::INFINITY)
        });
        self.settle_branch();
        drawn.and_then(|()| self.examine_position()).map_err(|r| self.stop(Path::Assembly, 0.0, r, false))?;
        self.save(0.0, 0.0);
        if self.state.largest_gap(&self.topology) == 0.0 {
            return Ok(());
        }
        // phi - (1 - s) phi_0 = 0 from s = 0 to 1
        if let Err(stop) = self.walk(Path::Assembly, 1.0) {
            if matches!(stop.kind, StopKind::Locked { .. }) {
                return Err(stop);
            }
            return Err(Box::new(Stop { kind: StopKind::DoesNotAssemble, ..*stop }));
        }
        let told = WORTH_TELLING;
        let gaps = self.gaps(|s, r| s.state.gap[r.0], told);
        if !gaps.is_empty() {
            self.assembly = Some(Assembly { gaps, moved: self.moved(told) });
        }
        self.state.gap.fill(0.0);
        self.state.gap_left = [0.0; 2];
        Ok(())
    }

    /// By how much every row fails where the tree's joints are closed as drawn.
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

    /// The gaps that a value per row gives, summed up per joint, driver or coupler; small ones left out.
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
                // Of a joint with several open rows the length of all of them together.
                Some((gap, _)) => gap.size = gap.size.hypot(size),
                None => gaps.push((Gap { of, size: size.abs(), quantity }, place.unit)),
            }
        }
        gaps.sort_by(|(a, unit_a), (b, unit_b)| (b.size / unit_b).total_cmp(&(a.size / unit_a)));
        gaps.into_iter().map(|(gap, _)| gap).collect()
    }

    /// How far the bodies are from where they were drawn.
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
    /// How near the joints can come: least squares over the residuals of all rows of the block that
    /// could not be closed, from where the path ended.
    ///
    /// Levenberg's and Marquardt's method on the scaled rows; it need not be fast.
    pub fn least_gaps(&mut self, block: BlockId) -> Vec<Gap> {
        self.state.gap_left = [0.0; 2];
        self.restore();
        let (unknowns, rows) = (self.topology[block].unknowns.clone(), self.topology.rows_of_block(block));
        let n = unknowns.len();
        let mut damping = 1e-3;
        let (mut residuals, mut jacobian) = self.scaled_rows(&rows, &unknowns);
        let squares = |r: &[f64]| r.iter().map(|x| x * x).sum::<f64>();
        for _ in 0..MAX_SEARCH {
            let mut normal = Elimination::new(n);
            let mut step = vec![0.0; n];
            for k in 0..n {
                for c in 0..n {
                    let dot: f64 = jacobian.iter().map(|row| row[k] * row[c]).sum();
                    // (J^T J + damping I) step = -J^T phi,  in units of rows and coordinates                            (36)
                    normal.row_mut(k)[c] = dot + if k == c { damping } else { 0.0 };
                }
                step[k] = -jacobian.iter().zip(&residuals).map(|(row, r)| row[k] * r).sum::<f64>();
            }
            normal.factor();
            normal.solve(&mut step);
            let before = (self.state.q.clone(), self.state.balls.clone());
            for (k, &c) in unknowns.iter().enumerate() {
                self.state.q[c.0] += step[k] * self.topology[c].unit;
            }
            self.state.turn_balls(&self.topology, self.topology.link_ids());
            let (now, jacobian_now) = self.scaled_rows(&rows, &unknowns);
            let (old, new) = (squares(&residuals), squares(&now));
            // A step that helps makes the next one more like Newton's, one that does not more like a short one downhill.
            if new < old {
                (residuals, jacobian) = (now, jacobian_now);
                damping *= 0.3;
                if old - new <= NO_BETTER * old {
                    break;
                }
            } else {
                (self.state.q, self.state.balls) = before;
                damping *= 4.0;
                if damping > 1e12 {
                    break;
                }
            }
        }
        self.scaled_rows(&rows, &unknowns);
        self.gaps(|s, r| s.state.residual_of(&s.topology, &s.parts, &s.drivers, r), WORTH_TELLING)
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
            for Term { row, factor } in self.topology.parts_of_row(r) {
                let wrench = s.wrench_of(&self.topology, row);
                for &LoopLink { link, side } in &self.topology.closure_of(row).links {
                    for c in self.topology[link].coordinates() {
                        let unit = self.topology[c].unit;
                        // J_ra = +- c_k l_k . x_a                                                                             (6)
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
