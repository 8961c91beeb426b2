//! Solver of one design on its path: the mechanism, and what decides and records its steps.

use crate::model::{DriverId, JointId, Model};
use crate::topology::{BlockId, ClosureId, Topology};

use super::crossing::Crossing;
use super::gap::Assembly;
use super::guard::StepGuard;
use super::kinematics::PositionFailure;
use super::lookahead::Lookahead;
use super::mechanism::{Mechanism, StepRejection};
use super::parts::PlanGeometry;
use super::path::Path;
use super::predictor::Predictor;
use super::turns::TurnCounter;
use super::{SingularPosition, SingularityKind, SolverStatistics, Stop, StopKind};

/// Power of the response below which a singular position is a limit: it is 1/2 at a limit, and 1 where two motions
/// meet.
const LIMIT: f64 = 0.75;
/// Maximum deviation of the power from 1/2 or 1 for which the kind of a singular position ahead is clear.
const CLEAR_POWER: f64 = 0.1;
/// Distance from the end of a curve, relative to its length, below which a path ends there: steps beyond it are
/// rejected, and shortened until they are shorter than this.
const CURVE_END: f64 = 1e-6;
/// Relative difference below which two times are equal; a law that changes between them jumps.
pub(super) const ONE_TIME: f64 = 1e-14;

/// Solver of one design.
pub(crate) struct Stepper<'m> {
    pub mechanism: Mechanism<'m>,
    /// Prediction from one output time to the next.
    pub(super) predictor: Predictor,
    /// Trust in steps from one output time to the next.
    pub(super) guard: StepGuard<1>,
    /// Knowledge of the path between output times.
    pub(super) lookahead: Lookahead,
    /// Counter of the angles whose turns are counted along the path; `None` if there are none.
    pub turns: Option<TurnCounter<'m>>,
    /// The change point that was crossed last.
    pub(super) crossing: Option<Box<Crossing>>,
    /// True at a change point, where J is singular and cannot be used.
    pub at_change_point: bool,
    pub effort: SolverStatistics,
    /// Assembly of the mechanism, if it was open in the design configuration.
    pub assembly: Option<Assembly>,
}

impl<'m> Stepper<'m> {
    pub fn new(model: &'m Model, topology: &Topology, parts: PlanGeometry<f64>) -> Self {
        let mechanism = Mechanism::new(model, topology, parts);
        Self {
            predictor: Predictor::new(topology),
            guard: StepGuard::new(topology.blocks.len(), model.drivers.len()),
            lookahead: Lookahead::new(&mechanism),
            turns: None,
            crossing: None,
            at_change_point: false,
            effort: SolverStatistics { least_pivot_ratio: f64::INFINITY, ..SolverStatistics::default() },
            assembly: None,
            mechanism,
        }
    }

    /// Accepts the position of the state, at t on the path, as the start of a path. Nothing ahead is known then.
    pub(super) fn start_at(&mut self, t: f64) {
        self.predictor.forget();
        self.save(t);
    }

    /// Accepts the position of the state, at t on the path. Nothing ahead is known then.
    pub(super) fn save(&mut self, t: f64) {
        self.predictor.learn(t, &self.mechanism.state);
        self.mechanism.save(t);
        let determinants = &self.mechanism.state.determinants;
        self.guard.start_at((0..determinants.len()).map(|b| determinants[b]));
        self.lookahead.is_known = false;
    }

    /// Value and derivatives of every predicted quantity at the accepted position.
    pub fn channels(&self) -> impl Iterator<Item = f64> {
        self.predictor.newest().flatten()
    }

    /// True if something is known of the path ahead.
    #[inline(always)]
    pub(super) fn knows_the_path(&self) -> bool {
        self.guard.knows_a_step() || self.lookahead.is_known
    }

    /// Forgets how the accepted position was reached, and the path ahead.
    pub(super) fn forget(&mut self) {
        self.predictor.forget();
        self.guard.forget();
        self.lookahead.is_known = false;
    }

    /// Starts on the path of the laws at t, from a position there that was reached on another path.
    pub(super) fn start_on_laws(&mut self, t: f64, moved: bool) -> Result<(), Box<Stop>> {
        // The rates left by the other path are per unit of its parameter; solve once more with the laws' own.
        self.start_on(Path::Laws, t, moved)?;
        self.renew_turns();
        self.examine(Path::Laws);
        Ok(())
    }

    /// Starts on a path at t, from the saved position, which is there.
    pub(super) fn start_on(&mut self, path: Path, t: f64, moved: bool) -> Result<(), Box<Stop>> {
        let Self { mechanism, .. } = self;
        mechanism.saved.time = t;
        let solved = mechanism.solve_at(path, t).and_then(|()| mechanism.examine_position());
        solved.map_err(|r| self.stop(path, t, r, moved))?;
        self.start_at(t);
        Ok(())
    }

    /// Solves the saved position again, so that factors and rates are available.
    pub(super) fn stand(&mut self, path: Path) -> Result<(), StepRejection> {
        self.mechanism.solve_at(path, self.mechanism.saved.time)
    }

    /// Examines the distance of singular positions from the saved position, the position of the state.
    pub(super) fn examine(&mut self, path: Path) {
        self.lookahead.examine(&mut self.mechanism, path, self.turns.as_mut());
        self.lookahead.accept();
    }

    /// Continues counting angles from the accepted position, at which the state has the rates of another path.
    pub(super) fn renew_turns(&mut self) {
        if let Some(turns) = &mut self.turns {
            turns.renew(&self.mechanism.state);
        }
    }

    /// Largest travel of a driver over the step considered, rad or sizes.
    pub(super) fn travelled(&self, path: Path) -> f64 {
        self.lookahead.travelled(&self.mechanism, path)
    }

    /// Singular position that the motion would reach if it continued as at the last output time; `None` if none is near
    /// enough to be predicted.
    pub fn beyond(&mut self) -> Option<SingularPosition> {
        self.stand(Path::Laws).ok()?;
        let Self { mechanism, lookahead, .. } = self;
        let ahead = lookahead.singularity(mechanism, Path::Laws, None)?;
        // m of (23): 1/2 at a limit, 1 where two motions meet
        let limit = (ahead.power - 0.5).abs() < CLEAR_POWER;
        let meets = (ahead.power - 1.0).abs() < CLEAR_POWER;
        if !(ahead.distance > 0.0 && (limit || meets)) {
            return None;
        }
        let travel = mechanism.drivers.iter().enumerate().map(|(d, [now, speed, _])| {
            // f(t*) - f(t), t* = t + distance of (23)
            let then = mechanism.parts.law_of(d).at(mechanism.saved.time + ahead.distance).value();
            // A law that is undefined there is extrapolated at its present speed.
            if then.is_finite() { then - now } else { speed * ahead.distance }
        });
        Some(SingularPosition {
            after: ahead.distance,
            travel: travel.collect(),
            kind: if limit { SingularityKind::Limit } else { SingularityKind::TwoMotions },
            joints: mechanism.topology.joints_of_block(ahead.block),
        })
    }

    /// Reason why the path ends at the saved position; the step to t was rejected.
    pub(super) fn stop(&mut self, path: Path, t: f64, rejection: StepRejection, moved: bool) -> Box<Stop> {
        let (now, mut failed) = (self.mechanism.saved.time, t);
        let (kind, block) = match rejection {
            StepRejection::Position(
                PositionFailure::Singular { block } | PositionFailure::NoConvergence { block },
            ) if !moved => (StopKind::Limit, Some(block)),
            StepRejection::Position(_) | StepRejection::Branch { .. } | StepRejection::TooNear => {
                let ahead = self.lookahead.singularity(&mut self.mechanism, path, None);
                // The rejected step is short compared with the path.
                // (23) predicts a position only if its distance is comparable to the rejected step.
                let near = 1e3 * (t - now).abs().max(ONE_TIME * t.abs());
                match ahead.filter(|a| a.distance > 0.0 && a.distance <= near) {
                    Some(a) => {
                        // t* = t + m / (s'/s) of (23), m < 3/4 a limit
                        failed = now + a.distance;
                        let limit = a.power < LIMIT;
                        (if limit { StopKind::Limit } else { StopKind::BranchChange }, Some(a.block))
                    }
                    None => match rejection {
                        StepRejection::Position(
                            PositionFailure::Singular { block } | PositionFailure::NoConvergence { block },
                        ) => (StopKind::Limit, Some(block)),
                        StepRejection::Branch { block } => (StopKind::BranchChange, Some(block)),
                        _ => (StopKind::BranchChange, ahead.map(|a| a.block)),
                    },
                }
            }
            // Residual of a redundant row: the constraints agreed in the design configuration and do not agree here.
            StepRejection::Locked { row, residual } => {
                let topology = &self.mechanism.topology;
                let closure = topology.closure_of(row);
                let quantity = topology.constraint(row).into();
                (StopKind::Locked { joint: closure.joint, residual, quantity }, closure.block)
            }
            StepRejection::Law { driver } => (StopKind::LawNotFinite { driver: DriverId(driver) }, None),
            StepRejection::TooFar { driver } => (StopKind::TooFar { driver: DriverId(driver) }, None),
        };
        let kind = match (kind, self.curve_that_ends(block)) {
            (StopKind::Limit | StopKind::BranchChange, Some(joint)) => StopKind::CurveEnd { joint },
            (kind, _) => kind,
        };
        let (last_time, failed_time) = match path {
            Path::Assembly => (None, 0.0),
            Path::Line { at } => (None, at),
            Path::Laws => (moved.then_some(now), failed),
        };
        let Mechanism { model, topology, saved, .. } = &self.mechanism;
        Box::new(Stop {
            kind,
            last_time,
            failed_time,
            drivers: model.drivers.iter().zip(&saved.drivers).map(|(d, f)| d.with_sense(f[0])).collect(),
            block,
            pivot_ratio: block.map_or(1.0, |b| saved.pivots[b.0].0),
            joints: block.map_or_else(Vec::new, |b| topology.joints_of_block(b)),
            remains: Vec::new(),
            closed: (path == Path::Assembly).then_some(now),
            snaps_through: false,
        })
    }

    /// Joint of a block whose point is at an end of an open curve at the accepted position. There is no contact beyond.
    fn curve_that_ends(&self, block: Option<BlockId>) -> Option<JointId> {
        let Mechanism { topology, parts, saved, .. } = &self.mechanism;
        let is_at_end = |(c, k): &(ClosureId, usize)| {
            let (curve, u) = (&parts.curves[*k], saved.contacts[*k].u);
            let left = u.min(curve.length() - u);
            topology[*c].block == block && !curve.is_closed() && left <= CURVE_END * curve.length()
        };
        topology.contacts().find(is_at_end).map(|(c, _)| topology[c].joint)
    }

    /// Takes over the accepted position at rest of another stepper, whose mechanism is the same but for its unknown
    /// coordinates, with all that it knows of the path up to there.
    pub fn continue_from(&mut self, other: &Stepper<'_>) -> Result<(), StepRejection> {
        self.mechanism.stand_at(&other.mechanism)?;
        self.save(other.mechanism.saved.time);
        if let (Some(turns), Some(before)) = (&mut self.turns, &other.turns) {
            turns.ahead.copy_from_slice(&before.values);
            turns.accept_at_rest(&self.mechanism.state);
        }
        self.effort = other.effort;
        Ok(())
    }

    /// Least pivot ratio of all blocks at the accepted position.
    pub fn least_pivot_ratio(&self) -> f64 {
        self.mechanism.saved.pivots.iter().fold(1.0, |least, (ratio, _)| f64::min(least, *ratio))
    }

    /// Joints of the block whose position was accepted nearest to a singular one.
    pub fn joints_nearest_to_singular(&self) -> Vec<JointId> {
        let Mechanism { topology, saved, .. } = &self.mechanism;
        let blocks = topology.block_ids();
        let least = blocks.min_by(|a, b| saved.pivots[a.0].0.total_cmp(&saved.pivots[b.0].0));
        least.map_or_else(Vec::new, |b| topology.joints_of_block(b))
    }

    /// Writes the values of the released drivers of a user's model at the accepted position.
    pub fn write_released(&self, model: &Model, values: &mut [f64]) {
        let Mechanism { model: solved, topology, saved, state, .. } = &self.mechanism;
        for d in model.equilibrium.iter().flat_map(|equilibrium| &equilibrium.released) {
            let driver = &model.drivers[d.0];
            // Its coordinate, which another driver may determine in the model that is solved.
            let freedom = solved.joints[driver.joint.0].kind.coordinates[driver.coordinate].freedom;
            let link = topology.links.iter().find(|link| link.joint == Some(driver.joint));
            let closure = ClosureId::each(&topology.closures)
                .find(|(_, c)| c.joint == driver.joint && c.coupler.is_none() && c.driver.is_none());
            let change = match (freedom, link, closure) {
                (Some(freedom), Some(link), _) => saved.q[link.coordinate_of(freedom).0],
                (_, _, Some((c, _))) => {
                    // That of a cut joint, within a turn.
                    let row = model.driven(driver).row;
                    let [now, at_first] =
                        [state.ends[c.0], model.ends(driver.joint)].map(|ends| row.value(&ends, 0.0));
                    now - at_first
                }
                (_, _, None) => saved.drivers[d.0][0],
            };
            values[d.0] = driver.with_sense(change);
        }
    }
}
