//! A mechanism on its path: the position accepted last, and the correction of a prediction to the next one.
//!
//! The correction is Newton's method ([`State::solve`]). A position counts only on the branch of the motion: with the
//! signs of the determinants, in the expected turn of every coupler's angle, and with all constraints closed.

use crate::joint::{Freedom, Quantity};
use crate::linalg::{FullPivot, LARGEST_DENSE};
use crate::model::{Contact, Driver, DriverId, Model};
use crate::space::{Angles, Quat};
use crate::topology::{
    BlockId, CoordinateId, Link, LinkId, LoopLink, RowId, RowTerm, SetBy, Topology, TreeRow,
};

use super::kinematics::{PositionFailure, Residuals, State, factors_of};
use super::parts::PlanGeometry;
use super::path::Path;

/// Maximum difference between coordinates of a coupler and their prediction, rad; otherwise the turn of an angle is
/// ambiguous.
const TURN_TRUST: f64 = 1.0;
/// Residual of a redundant constraint, as a fraction of its loop's size (or, for a cosine, as it is), above which the
/// mechanism locks. Coordinates typed into a file have about six digits, and an axis through two of them is tilted by
/// some times that.
pub(crate) const LOCKED: f64 = 1e-5;
/// Other rows are tried when the pivot ratio has fallen to this fraction of its first value: redundant rows agree only
/// to the digits of the model file, and a weak selection magnifies the difference.
const RESELECT: f64 = 0.1;
/// If no other rows were better, they are tried again when the ratio has fallen by this factor once more.
const LOOK_AGAIN: f64 = 0.3;

/// A mechanism on its path.
pub(crate) struct Mechanism<'m> {
    pub model: &'m Model,
    /// Own copy, because the selection of independent rows may change along the path.
    pub topology: Topology,
    pub parts: PlanGeometry<f64>,
    pub state: State<f64>,
    /// Per driver: f, f., f.. by the parameter of the path; rad or m.
    pub drivers: Vec<[f64; 3]>,
    /// Per driver: 1 rad, or the size of its loop.
    pub driver_units: Vec<f64>,
    /// Start and end of each driver on a straight path.
    pub line: Vec<[f64; 2]>,
    /// The last accepted position.
    pub saved: AcceptedPosition,
    /// Per block: the branch that its positions must be on.
    pub branch: Vec<Branch>,
    /// Largest residuals at the position tried last.
    pub residuals: Residuals,
    /// Number of times that other rows were selected.
    pub selections: usize,
}

/// Branch of a block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Branch {
    /// sign(det J): it keeps it as long as no singular position is passed.
    pub positive: bool,
    /// The pivot ratio below which other rows are tried.
    pub try_others: f64,
}

/// A position that was accepted.
#[derive(Clone)]
pub(crate) struct AcceptedPosition {
    /// Parameter of the path: the time on the path of the laws.
    pub time: f64,
    /// q, q., q.. of the tree, balls' quaternions apart.
    pub q: Vec<f64>,
    pub qd: Vec<f64>,
    pub qdd: Vec<f64>,
    pub balls: Vec<Quat<f64>>,
    pub pivots: Vec<(f64, bool)>,
    pub drivers: Vec<[f64; 3]>,
    /// Per row that is a term of a coupler: its coordinate, with speed and acceleration.
    pub coupled: Vec<[f64; 3]>,
    /// Per curve: its contact.
    pub contacts: Vec<Contact<f64>>,
    /// Largest residual there, sizes or rad.
    pub residual: f64,
}

/// Reason why a step was rejected.
pub(crate) enum StepRejection {
    Position(PositionFailure),
    /// The determinant changed its sign, or a turn is ambiguous.
    Branch {
        block: BlockId,
    },
    Locked {
        row: RowId,
        residual: f64,
    },
    Law {
        driver: usize,
    },
    /// A driver goes too far between two output times.
    TooFar {
        driver: usize,
    },
    /// Seen from the far end, a singular position is too near for a step of this length.
    TooNear,
}

impl<'m> Mechanism<'m> {
    /// A mechanism in its design configuration, or where its assembly starts.
    pub fn new(model: &'m Model, topology: &Topology, parts: PlanGeometry<f64>) -> Self {
        let mut state = State::new(model, topology);
        if let Some(start) = &topology.start {
            state.q.copy_from_slice(&start.q);
            state.balls.copy_from_slice(&start.balls);
        }
        state.contacts = match &topology.start {
            Some(start) => {
                parts.curves.iter().zip(&start.contacts).map(|(c, u)| Contact::at(c, *u)).collect()
            }
            None => parts.curves.iter().map(|c| Contact::at(c, c.start())).collect(),
        };
        let saved = AcceptedPosition {
            time: 0.0,
            q: state.q.clone(),
            qd: state.motion.speeds[0].clone(),
            qdd: state.motion.speeds[1].clone(),
            balls: state.balls.clone(),
            pivots: state.pivots.clone(),
            drivers: vec![[0.0; 3]; model.drivers.len()],
            coupled: vec![[0.0; 3]; topology.rows.len()],
            contacts: state.contacts.clone(),
            residual: 0.0,
        };
        Self {
            model,
            topology: topology.clone(),
            parts,
            state,
            drivers: saved.drivers.clone(),
            driver_units: driver_units(model, topology),
            line: vec![[0.0; 2]; model.drivers.len()],
            saved,
            branch: vec![Branch { positive: true, try_others: 0.0 }; topology.blocks.len()],
            residuals: Residuals::default(),
            selections: 0,
        }
    }

    /// Sets the drivers for the path at t.
    #[inline(always)]
    pub fn drive(&mut self, path: Path, t: f64) -> Result<(), StepRejection> {
        // phi = (1 - s) phi_0: the remaining fraction of every gap, and its rate by s
        self.state.gap_left = if path == Path::Assembly { [1.0 - t, -1.0] } else { [0.0; 2] };
        for k in 0..self.drivers.len() {
            let law = match path {
                Path::Assembly => [0.0; 3],
                Path::Laws => self.parts.law(k, t),
                Path::Line { .. } => {
                    let [from, to] = self.line[k];
                    // At the end exactly there.
                    let here = if t == 1.0 { to } else { from + (to - from) * t };
                    // f = f_0 + (f_1 - f_0) s,    df/ds = f_1 - f_0,    d2f/ds2 = 0
                    [here, to - from, 0.0]
                }
            };
            // An overflow of the sum is not finite either.
            if !(law[0].abs() + law[1].abs() + law[2].abs()).is_finite() {
                return Err(StepRejection::Law { driver: k });
            }
            self.drivers[k] = law;
        }
        Ok(())
    }

    /// Speed of driver d by the parameter of direction k of a path.
    pub fn speed_along(&self, path: Path, k: usize, d: usize) -> f64 {
        // df_d/du: 1 for the driver of the direction; f(1) - f(0) for all drivers on a line; 0 in an assembly, where
        // the gaps change
        match path {
            Path::Assembly => 0.0,
            Path::Line { .. } => self.line[d][1] - self.line[d][0],
            Path::Laws => f64::from(u8::from(k == d)),
        }
    }

    /// Travel of one unit of the parameter of a path, rad or sizes; 1 on the path of the laws.
    pub fn unit_of(&self, path: Path) -> f64 {
        match path {
            Path::Assembly => self.largest_gap(),
            Path::Line { .. } => {
                let of_driver = self.line.iter().zip(&self.driver_units);
                of_driver.map(|([from, to], unit)| (*to - *from).abs() / unit).fold(0.0, f64::max)
            }
            Path::Laws => 1.0,
        }
    }

    /// Solves the position at t on a path, from the saved one, which is near.
    pub fn solve_at(&mut self, path: Path, t: f64) -> Result<(), StepRejection> {
        self.drive(path, t)?;
        self.restore();
        self.solve_within(f64::INFINITY)
    }

    /// Solves from the prediction at hand; the first correction must be within `trust`.
    pub fn solve_within(&mut self, trust: f64) -> Result<(), StepRejection> {
        self.state.solve(&self.topology, &self.parts, &self.drivers, trust).map_err(StepRejection::Position)
    }

    /// Solves the current position again: near a singular position the remainder of Newton's method, a square, is
    /// magnified.
    pub fn polish(&mut self) -> Result<(), StepRejection> {
        self.solve_within(f64::INFINITY)
    }

    /// Sets the branch from the first position.
    pub fn settle_branch(&mut self) {
        for (b, &(ratio, positive)) in self.state.pivots.iter().enumerate() {
            let branch = &mut self.branch[b];
            *branch = Branch { positive, try_others: RESELECT * ratio };
        }
    }

    /// True if the position just solved is on the branch, in the turn that was expected, and closed.
    pub fn examine_position(&mut self) -> Result<(), StepRejection> {
        for (b, &(_, positive)) in BlockId::each(&self.state.pivots) {
            // sign(det J) is that of the branch: between two positions of opposite sign lies a singular one.
            if positive != self.branch[b.0].positive {
                return Err(StepRejection::Branch { block: b });
            }
        }
        if let Some(block) = self.uncertain_turn() {
            return Err(StepRejection::Branch { block });
        }
        self.measure_residuals();
        // During assembly, redundant constraints need not agree yet.
        let half_open = self.state.gap_left[0] > 0.0;
        // abs(phi) <= 1e-5 of the loop's size, redundant rows included: otherwise the constraints contradict each
        // other.
        if !half_open && !(self.residuals.scaled <= LOCKED) {
            let (row, residual) = self.state.worst_row(&self.topology, &self.parts, &self.drivers);
            return Err(StepRejection::Locked { row, residual });
        }
        self.reselect()
    }

    /// Computes the residuals of the position of the state.
    pub fn measure_residuals(&mut self) {
        self.residuals = self.state.residuals(&self.topology, &self.parts, &self.drivers);
    }

    /// Sets the state at a change point from its coordinates, speeds and accelerations.
    pub fn stand_with_rates(&mut self, singular: &[BlockId]) {
        self.state.stand_with_rates(&self.topology, &self.parts, &self.drivers, singular);
    }

    /// Computes the residual of every row where the assembly starts, with closed tree joints.
    pub fn measure_gaps(&mut self) {
        let zero = 0.0;
        self.drivers.fill([zero; 3]);
        self.state.gap_left = [0.0; 2];
        self.state.stand(&self.topology, &self.parts);
        if self.topology.start.is_some() {
            // The whole turns of couplers' angles are counted from there.
            for &r in &self.topology.coupler_terms {
                let there = self.state.coordinate_of_row(&self.topology, r);
                (self.state.near[r.0], self.saved.coupled[r.0]) = (there[0], there);
            }
        }
        for (r, place) in RowId::each(&self.topology.rows) {
            self.state.gap[r.0] = if place.is_term {
                zero
            } else {
                // phi_0, at the coordinates of the start and with all drivers at 0
                self.state.residual_of(&self.topology, &self.parts, &self.drivers, r)
            };
        }
    }

    /// Largest gap of the design configuration, in sizes or as a cosine.
    pub fn largest_gap(&self) -> f64 {
        // max over the rows of abs(phi_0) / unit
        let scaled = self.state.gap.iter().zip(&self.topology.rows).map(|(gap, row)| gap.abs() / row.unit);
        scaled.fold(0.0, f64::max)
    }

    /// Predicts the coordinates of couplers, a step h beyond the saved position.
    #[inline(always)]
    pub fn expect_turns(&mut self, h: f64) {
        let half = 0.5 * h;
        for &r in &self.topology.coupler_terms {
            let [x, v, a] = self.saved.coupled[r.0];
            // chi + chi. h + chi.. h^2 / 2
            self.state.near[r.0] = x + (v + a * half) * h;
        }
    }

    /// Block of a coupler with an angle whose turn is ambiguous.
    #[inline(always)]
    fn uncertain_turn(&self) -> Option<BlockId> {
        let (topology, s) = (&self.topology, &self.state);
        let uncertain = |r: &RowId| {
            let [value, ..] = s.coordinate_of_row(topology, *r);
            // NaN is uncertain.
            !topology.constraint(*r).is_length() && !((value - s.near[r.0]).abs() <= TURN_TRUST)
        };
        // All terms of a coupler are of its block.
        topology.coupler_terms.iter().find(|r| uncertain(r)).and_then(|r| topology.closure_of(*r).block)
    }

    /// Accepts the position of the state, at t on the path.
    pub fn save(&mut self, t: f64) {
        let (s, saved) = (&self.state, &mut self.saved);
        saved.time = t;
        saved.q.copy_from_slice(&s.q);
        saved.qd.copy_from_slice(&s.motion.speeds[0]);
        saved.qdd.copy_from_slice(&s.motion.speeds[1]);
        saved.balls.copy_from_slice(&s.balls);
        saved.pivots.copy_from_slice(&s.pivots);
        saved.drivers.copy_from_slice(&self.drivers);
        saved.contacts.copy_from_slice(&s.contacts);
        saved.residual = self.residuals.scaled;
        for &r in &self.topology.coupler_terms {
            saved.coupled[r.0] = s.coordinate_of_row(&self.topology, r);
        }
    }

    /// Restores the coordinates of the saved position.
    pub fn restore(&mut self) {
        let (s, saved) = (&mut self.state, &self.saved);
        s.q.copy_from_slice(&saved.q);
        s.balls.copy_from_slice(&saved.balls);
        s.contacts.copy_from_slice(&saved.contacts);
        for &r in &self.topology.coupler_terms {
            s.near[r.0] = saved.coupled[r.0][0];
        }
    }

    /// Selects other independent rows for blocks whose present ones have become nearly dependent.
    pub fn reselect(&mut self) -> Result<(), StepRejection> {
        for b in self.topology.block_ids() {
            let ratio = self.state.pivots[b.0].0;
            // min / max of the pivots, compared with a tenth of its value when these rows were selected
            if ratio >= self.branch[b.0].try_others {
                continue;
            }
            self.branch[b.0].try_others = LOOK_AGAIN * ratio;
            let rows = self.topology.rows_of_block(b);
            if rows.len() == self.topology[b].unknowns.len() {
                continue;
            }
            self.state.finish_wrenches(&self.topology);
            let (block, s) = (&self.topology[b], &self.state);
            let matrix = rows
                .iter()
                .map(|&r| {
                    let mut row = vec![0.0; block.unknowns.len()];
                    s.scaled_row(&self.topology, r, &mut row);
                    let entries = row.into_iter().enumerate();
                    entries.filter(|(_, x)| *x != 0.0).collect()
                })
                .collect();
            // From all rows of the block, redundant ones included, select those with the largest pivots.
            let pivots = FullPivot::of_sparse(matrix, block.unknowns.len(), f64::MIN_POSITIVE);
            let mut selected: Vec<RowId> = pivots.rows.iter().map(|&r| rows[r]).collect();
            selected.sort_unstable();
            if selected.len() < block.unknowns.len() || selected == block.selected {
                continue;
            }
            self.topology.select(b, selected);
            self.selections += 1;
            self.renew_factors(b);
            // Other rows at the same position: new factors, and a new sign of the determinant.
            self.solve_within(f64::INFINITY)?;
            let (ratio, positive) = self.state.pivots[b.0];
            self.branch[b.0] = Branch { positive, try_others: RESELECT * ratio };
        }
        Ok(())
    }

    /// Rows of all constraints at the accepted position, with the entries of every coordinate of the tree.
    pub fn accepted_rows(&mut self) -> Vec<TreeRow> {
        self.restore();
        self.state.gap_left = [0.0; 2];
        self.state.stand_with_factors(&self.topology, &self.parts, &self.saved.drivers);
        let (topology, s) = (&self.topology, &self.state);
        let entry = |scale: f64, LoopLink { link, side }: LoopLink, row: RowId| {
            let link = &topology[link];
            link.coordinates().enumerate().map(move |(k, c)| {
                // (6), dimensionless: row and coordinate divided by their units
                let entry = s.l[0][row.0].on(s.x[0][c.0]) * side * scale * topology[c].unit;
                (link.child, k, entry)
            })
        };
        let rows = RowId::each(&topology.rows).filter(|(_, place)| !place.is_term);
        rows.map(|(r, place)| {
            let terms = topology.parts_of_row(r);
            let of_term = |RowTerm { row, factor }: RowTerm| {
                let scale = factor / place.unit;
                topology.closure_of(row).links.iter().flat_map(move |around| entry(scale, *around, row))
            };
            terms.flat_map(of_term).collect()
        })
        .collect()
    }

    /// Takes over the accepted position of the same mechanism with other unknown coordinates, where its state is, and
    /// solves it.
    pub fn stand_at(&mut self, other: &Mechanism<'_>) -> Result<(), StepRejection> {
        let (topology, parts, saved) = (&self.topology, &self.parts, &other.saved);
        for (k, link) in LinkId::each(&topology.links) {
            let before = other.topology.links.iter().find(|before| before.child == link.child);
            let freedoms = |link: &Link| link.steps.iter().map(|step| step.freedom).collect::<Vec<_>>();
            match before.filter(|before| freedoms(before) == freedoms(link)) {
                Some(before) => {
                    for (c, from) in link.coordinates().zip(before.coordinates()) {
                        (self.state.q[c.0], self.state.balls[c.0]) = (saved.q[from.0], saved.balls[from.0]);
                    }
                }
                // A body that one plan places by a ball and the other by three turns, from ground.
                None => {
                    // J(q) = (X_p M_p)^-1 X_c M_c                                                               (4)
                    let marker = parts.child_from_marker[k.0].inverse();
                    let place = parts.parent_marker[k.0].inverse().compose(other.state.pose[link.child.0]);
                    let place = place.compose(marker);
                    let (turns, slides) = (Angles::Cardan.of(place.rot), place.r.to_array());
                    for step in &link.steps {
                        let c = step.first.0;
                        match step.freedom {
                            Freedom::Slide(axis) => self.state.q[c] = step.sign * slides[axis],
                            Freedom::Turn(axis) => self.state.q[c] = step.sign * turns[axis],
                            Freedom::Ball => self.state.balls[c] = Quat::from_rotation(place.rot),
                        }
                    }
                }
            }
        }
        self.state.contacts.clone_from(&saved.contacts);
        for &r in &topology.coupler_terms {
            self.state.near[r.0] = saved.coupled[r.0][0];
        }
        // Drivers of cut joints are the same ones in both.
        for (to, from) in self.drivers.iter_mut().zip(&saved.drivers) {
            *to = [from[0], 0.0, 0.0];
        }
        for (c, d) in topology.driven_coordinates() {
            self.drivers[d.0] = [self.state.q[c.0], 0.0, 0.0];
        }
        self.state.gap_left = [0.0; 2];
        self.solve_within(f64::INFINITY)?;
        self.settle_branch();
        self.examine_position()
    }

    /// Replaces the factors of a block after a change of its rows, whose entries are elsewhere.
    pub fn renew_factors(&mut self, b: BlockId) {
        let block = &self.topology[b];
        self.state.factors[b.0] = factors_of(&self.topology, block, LARGEST_DENSE);
    }

    /// Values of these coordinates of the tree; 0 for those of balls.
    pub fn coordinates(&self, of: &[CoordinateId]) -> impl Iterator<Item = f64> {
        for step in self.topology.links.iter().flat_map(|l| &l.steps) {
            assert!(step.freedom != Freedom::Ball || self.state.q[step.first.0] == 0.0);
        }
        of.iter().map(|c| self.state.q[c.0])
    }
}

/// Unit of travel per driver: 1 rad, or the size of the largest loop that it moves.
pub(crate) fn driver_units(model: &Model, topology: &Topology) -> Vec<f64> {
    let whole = model.size();
    // Du_d / unit is a number without dimension: rad, or a part of the loop.
    let unit = |(k, driver): (usize, &Driver)| {
        if model.driven(driver).quantity != Quantity::Length {
            return 1.0;
        }
        let d = DriverId(k);
        let coordinate = topology.coordinates.iter().find(|c| c.set_by == SetBy::Driver(d));
        let closure = topology.closures.iter().find(|c| c.driver == Some(d));
        coordinate.map(|c| c.unit).or(closure.map(|c| c.size)).unwrap_or(whole)
    };
    model.drivers.iter().enumerate().map(unit).collect()
}
