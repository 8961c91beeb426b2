//! Plan of the solution of a model: its tree, its loop closures, and the blocks of equations.

use std::ops::{Index, IndexMut, Range};
use std::sync::Arc;

use crate::constraint::Row;
use crate::joint::Freedom;
use crate::model::{BodyId, DriverId, GROUND, JointId, Model};
use crate::space::{Mat3, Pose, Twist};

use super::ids::{BlockId, ClosureId, CoordinateId, Ids, LinkId, RowId};
use super::start::StartCoordinates;

/// Coordinates that describe the mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Formulation {
    /// Joint coordinates of a spanning tree that leaves the fewest unknowns (paper, section 6.2).
    #[default]
    Relative,
    /// Six coordinates for every body; every joint is cut (paper, section 5).
    Absolute,
}

/// Solution plan. All references are ids, by which the plan is indexed; the solver only iterates over these lists.
#[derive(Clone, Debug)]
pub struct Topology {
    /// Formulation of the plan.
    pub formulation: Formulation,
    /// Tree joints in the order of solution: parents before children, earlier stages first.
    pub links: Vec<Link>,
    /// Coordinates of all links; those of a link are consecutive.
    pub coordinates: Vec<Coordinate>,
    /// Cut joints, and drivers that act across cut joints.
    pub closures: Vec<Closure>,
    /// Groups of unknowns that are solved together, in order.
    pub blocks: Vec<Block>,
    /// Rows of all closures, numbered consecutively.
    pub rows: Vec<RowPlace>,
    /// Rows that are couplers.
    pub coupled_rows: Vec<RowId>,
    /// Rows that are terms of couplers, including the first ones.
    pub coupler_terms: Vec<RowId>,
    /// Degrees of freedom without drivers, at the design configuration.
    pub mobility: usize,
    /// Role of each joint, tree or cut, with the reason.
    pub roles: Vec<JointRole>,
    /// Coordinates at which the assembly starts, if that is not the design configuration.
    pub start: Option<Arc<StartCoordinates>>,
}

/// Role of a joint in the solution.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum JointRole {
    /// Tree joint: places a body.
    Tree {
        /// Body that it places.
        child: BodyId,
        /// Number of unknown coordinates that remain.
        unknowns: usize,
    },
    /// Cut joint: replaced by constraint rows.
    Cut(CutReason),
}

/// Reason why a joint is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CutReason {
    /// Joint type without a tree form: a rod or a leg.
    AlwaysCut,
    /// Joint whose bodies are placed by other joints, with fewer unknowns.
    ClosesLoop,
    /// Cut joint by request of the model.
    Requested,
    /// Absolute coordinates, in which every joint is cut.
    Absolute,
}

/// Joint of the tree, or the free motion of a body, from parent to child.
#[derive(Clone, Debug)]
pub struct Link {
    /// Joint; `None` for a body that moves freely relative to ground.
    pub joint: Option<JointId>,
    /// Parent body.
    pub parent: BodyId,
    /// Body that it places.
    pub child: BodyId,
    /// End of the joint on the parent: 0 (i) or 1 (j).
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
    /// -1 if the link runs from body j to body i, so that coordinates remain those of j relative to i; +1 otherwise.
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
    /// True for a length, false for an angle.
    pub is_length: bool,
    /// Reference length for comparison: the size of the largest loop that it moves, m, for a length; 1 rad otherwise.
    pub unit: f64,
    /// 1 / unit.
    pub per_unit: f64,
}

/// Source of a coordinate's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SetBy {
    /// Prescribed by a driver.
    Driver(DriverId),
    /// Unknown of a block.
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
    /// Joint with the two markers.
    pub joint: JointId,
    /// Driver, if these rows prescribe a coordinate of a cut joint.
    pub driver: Option<DriverId>,
    /// Coupler, if its row is a term of one: an index into [`Model::couplers`].
    pub coupler: Option<usize>,
    /// Bodies i and j.
    pub bodies: [BodyId; 2],
    /// Base body of its loop: where the paths of its two bodies to ground meet. Point constraints are resolved along
    /// the axes of the base, so that the loop is independent of the motion of its base.
    pub base: BodyId,
    /// Link that places the base, if the block of the closure solves for it.
    pub base_link: Option<LinkId>,
    /// The elementary constraints.
    pub rows: Vec<Row>,
    /// First row; the others follow.
    pub first_row: RowId,
    /// Number of the curve that a point follows, counted over all closures.
    pub contact: Option<usize>,
    /// True if any row uses the axes of the markers, not only their origins.
    pub has_axes: bool,
    /// True if the selected rows use only the origins of the markers.
    pub solved_by_points: bool,
    /// Block that solves it; `None` if no unknown moves it.
    pub block: Option<BlockId>,
    /// Columns of that block in which the rows have entries.
    pub entries: Vec<ClosureColumn>,
    /// Links around the loop that it closes.
    pub links: Vec<LoopLink>,
    /// Joints whose extent is its size.
    pub extent: Vec<JointId>,
    /// Extent of the joints of the loop in the nominal design, m; reference length for gaps.
    pub size: f64,
}

/// Column of a block in which the rows of a closure have entries.
#[derive(Clone, Copy, Debug)]
pub struct ClosureColumn {
    /// The column.
    pub column: usize,
    /// Coordinate.
    pub coordinate: CoordinateId,
    /// +1 if it moves body j of the closure, -1 for body i.
    pub side: f64,
}

/// Link of a loop.
#[derive(Clone, Copy, Debug)]
pub struct LoopLink {
    /// The link.
    pub link: LinkId,
    /// +1 on the path to body j, -1 on the path to body i.
    pub side: f64,
}

impl Closure {
    /// Indices of the rows in [`Topology::rows`].
    #[inline(always)]
    pub(super) fn range(&self) -> Range<usize> {
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
        let first = self.first_row.0;
        (0..self.rows.len()).map(move |k| (RowId(first + k), self.rows[k]))
    }
}

/// Position of a constraint row in the plan.
#[derive(Clone, Debug)]
pub struct RowPlace {
    /// Closure.
    pub closure: ClosureId,
    /// Index of the row in its closure.
    pub index: usize,
    /// True if it is one of the independent rows that are solved; false if it is redundant and monitored.
    pub selected: bool,
    /// Further terms of a coupler whose first term is this row.
    pub terms: Vec<RowTerm>,
    /// Columns of the block in which the terms of a coupler have entries.
    pub columns: Vec<CoupledColumn>,
    /// True if it is a further term of a coupler, not a constraint by itself.
    pub is_term: bool,
    /// Constant of a coupler, divided by the coefficient of its first term; zero for other rows.
    pub constant: f64,
    /// Reference size of the residual: the size of its loop, m, for a length; 1 otherwise.
    pub unit: f64,
}

/// Sparse row of the Jacobian in the design configuration: (coordinate, entry). Lengths are relative to the sizes of
/// their loops.
pub(super) type SparseRow = Vec<(CoordinateId, f64)>;

/// Term of a constraint: a row times a factor.
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
    /// Rows of the terms, with their factors and the sides (+1 or -1) of their loops.
    pub parts: Vec<RowTerm>,
}

/// Group of unknowns and rows that are solved together.
#[derive(Clone, Debug)]
pub struct Block {
    /// Coordinates, by column.
    pub unknowns: Vec<CoordinateId>,
    /// Closures of the block.
    pub closures: Vec<ClosureId>,
    /// Rows of the block that are couplers.
    pub coupled: Vec<RowId>,
    /// Selected independent rows, the same number as unknowns.
    pub selected: Vec<RowId>,
    /// Range of [`Topology::links`] that it places.
    pub(super) links: Range<usize>,
    /// Number of multiplications of the factorisation in the design configuration, if it is sparse.
    pub multiplications: usize,
}

impl Block {
    /// Links that it places.
    #[inline(always)]
    pub fn link_ids(&self) -> impl Ids<LinkId> + use<> {
        LinkId::all(self.links.clone())
    }
}

impl Topology {
    /// Returns the links that are placed by drivers alone.
    #[inline(always)]
    pub fn driven_links(&self) -> impl Ids<LinkId> + use<> {
        LinkId::all(0..self.blocks.first().map_or(self.links.len(), |b| b.links.start))
    }

    /// Returns all links.
    #[inline(always)]
    pub fn link_ids(&self) -> impl Ids<LinkId> + use<> {
        LinkId::all(0..self.links.len())
    }

    /// Returns all closures.
    #[inline(always)]
    pub fn closure_ids(&self) -> impl Ids<ClosureId> + use<> {
        ClosureId::all(0..self.closures.len())
    }

    /// Returns all blocks.
    #[inline(always)]
    pub fn block_ids(&self) -> impl Ids<BlockId> + use<> {
        BlockId::all(0..self.blocks.len())
    }

    /// Returns the coordinates that drivers prescribe.
    #[inline(always)]
    pub fn driven_coordinates(&self) -> impl Iterator<Item = (CoordinateId, DriverId)> {
        CoordinateId::each(&self.coordinates).filter_map(|(c, coordinate)| match coordinate.set_by {
            SetBy::Driver(d) => Some((c, d)),
            SetBy::Block { .. } => None,
        })
    }

    /// Returns per coordinate of another plan of the same tree the one here that is the same.
    pub(crate) fn places<'t>(
        &'t self,
        other: &'t Topology,
    ) -> impl Iterator<Item = Option<CoordinateId>> + 't {
        CoordinateId::each(&other.coordinates).map(|(c, coordinate)| {
            let link = &other[coordinate.link];
            let k = link.coordinates().position(|own| own == c)?;
            self.links.iter().find(|own| own.child == link.child)?.coordinates().nth(k)
        })
    }

    /// Returns the unknown coordinates.
    #[inline(always)]
    pub fn unknown_coordinates(&self) -> impl Iterator<Item = CoordinateId> {
        CoordinateId::each(&self.coordinates).filter(|(_, c)| c.is_unknown()).map(|(c, _)| c)
    }

    /// Returns the closure of a row.
    #[inline(always)]
    pub fn closure_of(&self, r: RowId) -> &Closure {
        &self[self[r].closure]
    }

    /// Returns the elementary constraint of a row.
    #[inline(always)]
    pub fn constraint(&self, r: RowId) -> Row {
        let place = &self[r];
        self[place.closure].rows[place.index]
    }

    /// Number of unknown coordinates.
    pub fn unknowns(&self) -> usize {
        self.blocks.iter().map(|b| b.unknowns.len()).sum()
    }

    /// Returns the redundant rows, which the others imply.
    pub fn redundant(&self) -> impl Iterator<Item = RowId> {
        RowId::each(&self.rows).filter(|(_, place)| place.is_redundant()).map(|(r, _)| r)
    }

    /// Returns all constraint rows of a block's closures, including the redundant ones.
    pub fn rows_of_block(&self, block: BlockId) -> Vec<RowId> {
        let rows = self[block].closures.iter().flat_map(|&c| self[c].row_ids());
        rows.filter(|&r| !self[r].is_term).collect()
    }

    /// Returns the terms of constraint row r: the row itself, and the further terms of a coupler.
    #[inline]
    pub fn parts_of_row(&self, r: RowId) -> impl Iterator<Item = RowTerm> + '_ {
        std::iter::once(RowTerm { row: r, factor: 1.0 }).chain(self[r].terms.iter().copied())
    }

    /// Returns the closures with curves, with the number of the curve.
    pub fn contacts(&self) -> impl Iterator<Item = (ClosureId, usize)> + '_ {
        ClosureId::each(&self.closures).filter_map(|(c, closure)| Some((c, closure.contact?)))
    }

    /// Returns the name of a row in messages: the joint with its constraint, the driver, or the coupler.
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

    /// Selects the independent rows of a block, in ascending order.
    pub(crate) fn select(&mut self, block: BlockId, selected: Vec<RowId>) {
        for r in self.rows_of_block(block) {
            self[r].selected = selected.binary_search(&r).is_ok();
        }
        for k in 0..self[block].closures.len() {
            let c = self[block].closures[k];
            let points_only = |(r, row): (RowId, Row)| !(self[r].has_wrench() && row.has_axes());
            let by_points = self[c].numbered_rows().all(points_only);
            self[c].solved_by_points = by_points;
        }
        self[block].selected = selected;
    }

    /// Returns the joints whose motion or closure a block solves.
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
    /// True if the row has a wrench in the solution: it is selected, or a term of a coupler.
    pub fn has_wrench(&self) -> bool {
        self.selected || self.is_term || !self.terms.is_empty()
    }

    /// True if the row is redundant: other rows imply it.
    pub fn is_redundant(&self) -> bool {
        !self.selected && !self.is_term
    }
}

impl Coordinate {
    /// True if a block solves for the coordinate.
    pub fn is_unknown(&self) -> bool {
        matches!(self.set_by, SetBy::Block { .. })
    }
}

impl Link {
    /// Returns the coordinate of a freedom of the joint, counted from body i. A link that begins at body j has its
    /// steps in reverse order.
    pub fn coordinate_of(&self, freedom: usize) -> CoordinateId {
        let step = if self.parent_end == 0 { freedom } else { self.steps.len() - 1 - freedom };
        self.steps[step].first
    }

    /// Coordinates.
    pub fn coordinates(&self) -> impl Iterator<Item = CoordinateId> + '_ {
        self.steps.iter().flat_map(LinkStep::coordinates)
    }

    /// True if the unit twist is constant: a single freedom relative to ground.
    #[inline(always)]
    pub fn has_constant_twist(&self) -> bool {
        self.parent == GROUND && self.steps.len() == 1
    }

    /// Returns the frame of its first freedom in the design configuration, global.
    pub(super) fn frame_at_design(&self, model: &Model) -> Pose {
        match self.joint {
            Some(j) => model.marker(j, self.parent_end),
            None => model.bodies[self.child.0].frame,
        }
    }
}

impl LinkStep {
    /// Returns the coordinates: one, or three for a ball.
    #[inline(always)]
    pub fn coordinates(&self) -> impl Ids<CoordinateId> + use<> {
        CoordinateId::all(self.first.0..self.first.0 + self.freedom.coordinates())
    }

    /// Returns the global unit twist of coordinate k (0, or 0 to 2 for a ball) if the frame of the step is `frame`.
    #[inline(always)]
    pub fn twist<T: crate::space::Real>(
        &self,
        k: usize,
        rot: &Mat3<T>,
        r: crate::space::Vec3<T>,
    ) -> Twist<T> {
        match self.freedom {
            // x = [h; c x h] of a rotation about h through c, [0; h] of a translation; negative from j to i (4)
            Freedom::Turn(axis) => Twist::turn(rot.cols[axis] * T::constant(self.sign), r),
            Freedom::Slide(axis) => Twist::slide(rot.cols[axis] * T::constant(self.sign)),
            Freedom::Ball => Twist::turn(rot.cols[k], r),
        }
    }
}

/// Entries of a plan by their ids: `topology[link]` is the link.
macro_rules! entries {
    ($($id:ident: $list:ident of $what:ident;)*) => {$(
        impl Index<$id> for Topology {
            type Output = $what;
            #[inline(always)]
            fn index(&self, id: $id) -> &$what {
                &self.$list[id.0]
            }
        }

        impl IndexMut<$id> for Topology {
            #[inline(always)]
            fn index_mut(&mut self, id: $id) -> &mut $what {
                &mut self.$list[id.0]
            }
        }
    )*};
}

entries! {
    LinkId: links of Link;
    CoordinateId: coordinates of Coordinate;
    ClosureId: closures of Closure;
    RowId: rows of RowPlace;
    BlockId: blocks of Block;
}
