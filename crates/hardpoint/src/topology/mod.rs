//! Plan of solution: tree joints, cut joints, order of the blocks.
//!
//! Worked out once per model, at its design configuration. A spanning tree of joints places the bodies;
//! every other joint is cut into elementary constraints. Unknown coordinates and constraint rows fall
//! into *blocks* (in classical linkages: the Assur groups) that are solved one after another, so that
//! the cost grows linearly with the number of independent loops (`docs/theory.md`, section 3).

mod blocks;
mod error;
mod ids;
mod matching;
mod mobility;
mod redundancy;
mod size;
mod tree;

pub use error::TopologyError;
pub use ids::{BlockId, ClosureId, CoordinateId, Ids, LinkId, RowId};
pub use redundancy::Redundancy;

use std::ops::Range;

use crate::constraint::Row;
use crate::joint::Freedom;
use crate::model::{BodyId, DriverId, GROUND, JointId, Model};
use crate::space::{Mat3, Pose, Twist};

/// Coordinates that describe the mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Formulation {
    /// Joint coordinates of a spanning tree that leaves the fewest unknowns (paper, section 6.2).
    #[default]
    Relative,
    /// Six coordinates for every body; every joint is cut (paper, section 5).
    Absolute,
}

/// The plan of solution. All references are ids, by which the plan is indexed; the hot path only walks these lists.
#[derive(Clone, Debug)]
pub struct Topology {
    /// The formulation that it was made for.
    pub formulation: Formulation,
    /// Tree joints in the order of solution: parents before children, earlier stages first.
    pub links: Vec<Link>,
    /// Coordinates of all links, each link's in a row.
    pub coordinates: Vec<Coordinate>,
    /// Cut joints, and drivers that act across cut joints.
    pub closures: Vec<Closure>,
    /// Groups of unknowns that are solved together, in order.
    pub blocks: Vec<Block>,
    /// For every row of every closure (numbered through): where it is.
    pub rows: Vec<RowPlace>,
    /// The rows that are couplers.
    pub coupled_rows: Vec<RowId>,
    /// Degrees of freedom without drivers, at the design configuration.
    pub mobility: usize,
    /// Role of each joint, tree or cut, with the reason.
    pub roles: Vec<JointRole>,
}

/// A joint's part in the solution.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum JointRole {
    /// It places a body.
    Tree {
        /// The body that it places.
        child: BodyId,
        /// Number of unknown coordinates that remain.
        unknowns: usize,
    },
    /// It is cut into constraint rows.
    Cut(CutReason),
}

/// Reason why a joint is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CutReason {
    /// Type has no tree form: a rod or a leg.
    AlwaysCut,
    /// Both of its bodies are placed by other joints, which leave fewer unknowns.
    ClosesLoop,
    /// The model asks for it.
    Asked,
    /// In absolute coordinates every joint is cut.
    Absolute,
}

/// A joint of the tree (or the free motion of a body), seen from parent to child.
#[derive(Clone, Debug)]
pub struct Link {
    /// The joint; `None` for a body that moves freely from ground.
    pub joint: Option<JointId>,
    /// The body that carries it.
    pub parent: BodyId,
    /// The body that it places.
    pub child: BodyId,
    /// End of the joint that is on the parent: 0 (i) or 1 (j).
    pub parent_end: usize,
    /// Chain of freedoms from parent to child.
    pub steps: Vec<LinkStep>,
    /// 0 if drivers alone place the child, k + 1 if block k does.
    pub stage: usize,
}

/// One freedom of a link.
#[derive(Clone, Copy, Debug)]
pub struct LinkStep {
    /// Kind of motion.
    pub freedom: Freedom,
    /// -1 where the link runs from body j to body i, so that coordinates stay those of j relative to i.
    pub sign: f64,
    /// First coordinate.
    pub first: CoordinateId,
    /// True if a driver prescribes it.
    pub is_driven: bool,
}

/// A coordinate of the tree.
#[derive(Clone, Copy, Debug)]
pub struct Coordinate {
    /// Link.
    pub link: LinkId,
    /// Source of the coordinate's value.
    pub set_by: SetBy,
    /// True if it is a length (else an angle).
    pub is_length: bool,
    /// Reference length for comparison: the size of the largest loop that it moves, m, for a length; 1 rad otherwise.
    pub unit: f64,
    /// 1 / unit.
    pub per_unit: f64,
}

/// Source of a coordinate's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SetBy {
    /// A driver prescribes it.
    Driver(DriverId),
    /// It is unknown: a block is solved for it.
    Block {
        /// Block that solves it.
        block: BlockId,
        /// Index among the unknowns of the block.
        column: usize,
    },
}

/// Constraint rows between the two markers of one joint.
#[derive(Clone, Debug)]
pub struct Closure {
    /// The joint whose markers they stand between.
    pub joint: JointId,
    /// The driver, if these rows prescribe a coordinate of a cut joint.
    pub driver: Option<DriverId>,
    /// The coupler, if its row is a term of one: an index into [`Model::couplers`].
    pub coupler: Option<usize>,
    /// Bodies i and j.
    pub bodies: [BodyId; 2],
    /// The body on which its loop is: where the ways from its two bodies to ground meet. Points are held together along
    /// its axes, so that the loop knows nothing of where its base goes.
    pub base: BodyId,
    /// The link that places the base, if that is done by the block that solves the closure.
    pub base_link: Option<LinkId>,
    /// The elementary constraints.
    pub rows: Vec<Row>,
    /// The first of its rows; the others follow.
    pub first_row: RowId,
    /// If a point follows a curve: which of all curves, counted over the closures.
    pub contact: Option<usize>,
    /// True if any of its rows asks for the markers' axes, rather than for their points only.
    pub has_axes: bool,
    /// True if the rows that it is solved with ask for points only.
    pub solved_by_points: bool,
    /// The block that solves it; `None` if no unknown moves it.
    pub block: Option<BlockId>,
    /// Columns of that block in which the rows have entries.
    pub entries: Vec<ClosureColumn>,
    /// All links around the loop that it closes.
    pub links: Vec<LoopLink>,
    /// Extent of the joints of that loop in the design configuration, m: what its gaps are compared with.
    pub size: f64,
}

/// A column of a block in which the rows of a closure stand.
#[derive(Clone, Copy, Debug)]
pub struct ClosureColumn {
    /// The column.
    pub column: usize,
    /// Coordinate.
    pub coordinate: CoordinateId,
    /// +1 or -1: whether it moves body j of the closure, or body i.
    pub side: f64,
}

/// A link on the way around a loop.
#[derive(Clone, Copy, Debug)]
pub struct LoopLink {
    /// The link.
    pub link: LinkId,
    /// +1 or -1: whether it is on the way to body j, or to body i.
    pub side: f64,
}

impl Closure {
    /// Rows' places in [`Topology::rows`].
    #[inline(always)]
    fn range(&self) -> Range<usize> {
        self.first_row.0..self.first_row.0 + self.rows.len()
    }

    /// Rows.
    #[inline(always)]
    pub fn row_ids(&self) -> impl Ids<RowId> + use<> {
        RowId::all(self.range())
    }

    /// Rows, with the constraint of each.
    #[inline(always)]
    pub fn numbered_rows(&self) -> impl Iterator<Item = (RowId, Row)> + Clone {
        self.row_ids().zip(self.rows.iter().copied())
    }
}

/// Position of a constraint row in the plan.
#[derive(Clone, Debug)]
pub struct RowPlace {
    /// Closure.
    pub closure: ClosureId,
    /// Index of the row in its closure.
    pub index: usize,
    /// True if it is one of the independent rows that are solved with; else it is redundant and watched.
    pub selected: bool,
    /// The further terms of a coupler, which this row is the first of.
    pub terms: Vec<RowTerm>,
    /// For a coupler: the columns of its block in which its terms have entries.
    pub columns: Vec<CoupledColumn>,
    /// True if it is a further term of a coupler, and no constraint by itself.
    pub is_term: bool,
    /// Value of the sum of a coupler, per coefficient of its first term, at this term; zero elsewhere.
    pub constant: f64,
    /// Reference size of the residual: the size of its loop, m, for a length; 1 otherwise.
    pub unit: f64,
}

/// A row that is a part of a constraint, times its factor.
#[derive(Clone, Copy, Debug)]
pub struct RowTerm {
    /// The row.
    pub row: RowId,
    /// Factor.
    pub factor: f64,
}

/// Column of a block in which terms of a coupler have entries.
#[derive(Clone, Debug)]
pub struct CoupledColumn {
    /// The column.
    pub column: usize,
    /// The coordinate of the column.
    pub coordinate: CoordinateId,
    /// The terms' rows, with their factors and the sides of their loops.
    pub parts: Vec<RowTerm>,
}

/// Unknowns and rows that are solved together.
#[derive(Clone, Debug)]
pub struct Block {
    /// Coordinates, by column.
    pub unknowns: Vec<CoordinateId>,
    /// The closures whose rows belong to it.
    pub closures: Vec<ClosureId>,
    /// Those of its rows that are couplers.
    pub coupled: Vec<RowId>,
    /// The independent rows that it is solved with, as many as unknowns.
    pub selected: Vec<RowId>,
    /// The range of [`Topology::links`] that it places.
    links: Range<usize>,
    /// Number of multiplications of the block's factorisation in the design configuration, if it is sparse.
    pub multiplications: usize,
}

impl Block {
    /// The links that it places.
    #[inline(always)]
    pub fn link_ids(&self) -> impl Ids<LinkId> + use<> {
        LinkId::all(self.links.clone())
    }
}

impl Topology {
    /// Plans the solution of a model.
    ///
    /// # Errors
    /// A [`TopologyError`] where the drivers leave motions free, prescribe more than can move, or stand at
    /// a dead point of the design configuration.
    pub fn of(model: &Model, formulation: Formulation) -> Result<Self, TopologyError> {
        let mut topology = tree::grow(model, formulation);
        size::measure(model, &mut topology);
        blocks::split(model, &mut topology)?;
        mobility::examine(model, &mut topology)?;
        Ok(topology)
    }

    /// Links placed by drivers alone.
    #[inline(always)]
    pub fn driven_links(&self) -> impl Ids<LinkId> + use<> {
        LinkId::all(0..self.blocks.first().map_or(self.links.len(), |b| b.links.start))
    }

    /// All links.
    #[inline(always)]
    pub fn link_ids(&self) -> impl Ids<LinkId> + use<> {
        LinkId::all(0..self.links.len())
    }

    /// All closures.
    #[inline(always)]
    pub fn closure_ids(&self) -> impl Ids<ClosureId> + use<> {
        ClosureId::all(0..self.closures.len())
    }

    /// All blocks.
    #[inline(always)]
    pub fn block_ids(&self) -> impl Ids<BlockId> + use<> {
        BlockId::all(0..self.blocks.len())
    }

    /// The coordinates that drivers prescribe.
    #[inline(always)]
    pub fn driven_coordinates(&self) -> impl Iterator<Item = (CoordinateId, DriverId)> {
        CoordinateId::each(&self.coordinates).filter_map(|(c, coordinate)| match coordinate.set_by {
            SetBy::Driver(d) => Some((c, d)),
            SetBy::Block { .. } => None,
        })
    }

    /// The coordinates that are unknown.
    #[inline(always)]
    pub fn unknown_coordinates(&self) -> impl Iterator<Item = CoordinateId> {
        CoordinateId::each(&self.coordinates).filter(|(_, c)| c.is_unknown()).map(|(c, _)| c)
    }

    /// The closure of a row.
    #[inline(always)]
    pub fn closure_of(&self, r: RowId) -> &Closure {
        &self[self[r].closure]
    }

    /// The elementary constraint of a row.
    #[inline(always)]
    pub fn constraint(&self, r: RowId) -> Row {
        let place = &self[r];
        self[place.closure].rows[place.index]
    }

    /// Number of unknown coordinates.
    pub fn unknowns(&self) -> usize {
        self.blocks.iter().map(|b| b.unknowns.len()).sum()
    }

    /// The rows that are left out because the others imply them.
    pub fn redundant(&self) -> impl Iterator<Item = RowId> {
        RowId::each(&self.rows).filter(|(_, place)| place.is_redundant()).map(|(r, _)| r)
    }

    /// All constraint rows of a block's closures, the redundant ones included.
    pub fn rows_of_block(&self, block: BlockId) -> Vec<RowId> {
        let rows = self[block].closures.iter().flat_map(|&c| self[c].row_ids());
        rows.filter(|&r| !self[r].is_term).collect()
    }

    /// The rows whose sum, each times its factor, is constraint row r: itself, and a coupler's further terms.
    pub fn parts_of_row(&self, r: RowId) -> impl Iterator<Item = RowTerm> + '_ {
        std::iter::once(RowTerm { row: r, factor: 1.0 }).chain(self[r].terms.iter().copied())
    }

    /// The closures that follow curves, with the number of the curve.
    pub fn contacts(&self) -> impl Iterator<Item = (ClosureId, usize)> + '_ {
        ClosureId::each(&self.closures).filter_map(|(c, closure)| Some((c, closure.contact?)))
    }

    /// The rows that are terms of couplers, the first ones included.
    pub fn coupler_terms(&self) -> impl Iterator<Item = RowId> + '_ {
        self.coupled_rows.iter().flat_map(|&r| self.parts_of_row(r)).map(|term| term.row)
    }

    /// Name of a row in messages: the joint with its constraint, the driver, or the coupler.
    pub fn row_name(&self, model: &Model, r: RowId) -> String {
        let closure = self.closure_of(r);
        let row = match self.constraint(r) {
            Row::PointOnBase(k) => {
                let base = &model.bodies[closure.base.0].name;
                format!("points coincide along {} of `{base}`", ["x", "y", "z"][k])
            }
            row => row.describe(),
        };
        match (closure.driver, closure.coupler) {
            (Some(d), _) => format!("driver `{}` ({row})", model.drivers[d.0].name),
            (None, Some(c)) => format!("coupler `{}`", model.couplers[c].name),
            (None, None) => format!("`{}` ({row})", model.joints[closure.joint.0].name),
        }
    }

    /// Selects these independent rows, in ascending order, for the solution of a block.
    pub(crate) fn select(&mut self, block: BlockId, selected: Vec<RowId>) {
        for r in self.rows_of_block(block) {
            self[r].selected = selected.binary_search(&r).is_ok();
        }
        for k in 0..self[block].closures.len() {
            let c = self[block].closures[k];
            let points_only = |(r, row): (RowId, Row)| !(self[r].drives() && row.has_axes());
            let by_points = self[c].numbered_rows().all(points_only);
            self[c].solved_by_points = by_points;
        }
        self[block].selected = selected;
    }

    /// Joints whose motion or closing a block decides.
    pub fn joints_of_block(&self, block: BlockId) -> Vec<JointId> {
        let tree = self[block].unknowns.iter().filter_map(|&c| self[self[c].link].joint);
        let cut = self[block].closures.iter().map(|&c| self[c].joint);
        let mut joints: Vec<JointId> = tree.chain(cut).collect();
        joints.sort_unstable();
        joints.dedup();
        joints
    }
}

impl RowPlace {
    /// True if the motion needs its wrench: it is solved with, or a term of a coupler.
    pub fn drives(&self) -> bool {
        self.selected || self.is_term || !self.terms.is_empty()
    }

    /// True if it is left out of the solution because other rows imply it.
    pub fn is_redundant(&self) -> bool {
        !self.selected && !self.is_term
    }
}

impl Coordinate {
    /// True if a block is solved for it.
    pub fn is_unknown(&self) -> bool {
        matches!(self.set_by, SetBy::Block { .. })
    }
}

impl Link {
    /// The coordinate of this freedom of its joint, which counts from body i: a link that begins at body j has its
    /// steps the other way round.
    pub fn coordinate_of(&self, freedom: usize) -> CoordinateId {
        let step = if self.parent_end == 0 { freedom } else { self.steps.len() - 1 - freedom };
        self.steps[step].first
    }

    /// Coordinates.
    pub fn coordinates(&self) -> impl Iterator<Item = CoordinateId> + '_ {
        self.steps.iter().flat_map(LinkStep::coordinates)
    }

    /// True if its unit twists never change: a single freedom that starts on ground.
    #[inline(always)]
    pub fn keeps_its_twist(&self) -> bool {
        self.parent == GROUND && self.steps.len() == 1
    }

    /// The frame in which its freedoms start, at the design configuration, in the world.
    fn frame_at_design(&self, model: &Model) -> Pose {
        match self.joint {
            Some(j) => model.marker(j, self.parent_end),
            None => model.bodies[self.child.0].frame,
        }
    }
}

impl LinkStep {
    /// Coordinates: one, or three of a ball.
    #[inline(always)]
    pub fn coordinates(&self) -> impl Ids<CoordinateId> + use<> {
        CoordinateId::all(self.first.0..self.first.0 + self.freedom.coordinates())
    }

    /// World unit twist of its coordinate k (0, or 0 to 2 for a ball) where its frame is `frame`.
    #[inline(always)]
    pub fn twist<T: crate::space::Real>(
        &self,
        k: usize,
        rot: &Mat3<T>,
        r: crate::space::Vec3<T>,
    ) -> Twist<T> {
        match self.freedom {
            // x = [h; c x h] of a turn about h through c, [0; h] of a slide; backwards, from j to i, with its sign
            // turned (4)
            Freedom::Turn(axis) => Twist::turn(rot.cols[axis] * T::constant(self.sign), r),
            Freedom::Slide(axis) => Twist::slide(rot.cols[axis] * T::constant(self.sign)),
            Freedom::Ball => Twist::turn(rot.cols[k], r),
        }
    }
}
