//! How the mechanism is solved: which joints carry the tree, which are cut, in what order.
//!
//! Worked out once per model, at its design configuration. A spanning tree of joints places the bodies;
//! every other joint is cut into elementary constraints. Unknown coordinates and constraint rows fall
//! into *blocks* (in classical linkages: the Assur groups) that are solved one after another, so that
//! the cost grows linearly with the number of independent loops (`docs/theory.md`, section 3).

mod blocks;
mod fault;
mod matching;
mod mobility;
mod redundancy;
mod size;
mod tree;

pub use fault::TopologyFault;
pub use redundancy::Redundancy;

use crate::constraint::Row;
use crate::joint::Freedom;
use crate::model::{BodyId, DriverId, GROUND, JointId, Model};
use crate::space::{Mat3, Pose, Twist};

/// Which coordinates describe the mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Formulation {
    /// Joint coordinates of a spanning tree that leaves the fewest unknowns (paper, section 6.2).
    #[default]
    Relative,
    /// Six coordinates for every body; every joint is cut (paper, section 5).
    Absolute,
}

/// The plan of solution. All indices are resolved; the hot path only walks these lists.
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
    /// For every row of every closure (numbered through): where it stands.
    pub rows: Vec<RowPlace>,
    /// The rows that are couplers.
    pub coupled_rows: Vec<usize>,
    /// Degrees of freedom without drivers, at the design configuration.
    pub mobility: usize,
    /// Why each joint is in the tree or cut, by joint.
    pub roles: Vec<Role>,
}

/// A joint's part in the solution.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Role {
    /// It places a body.
    Tree {
        /// The body that it places.
        child: BodyId,
        /// How many unknown coordinates that leaves.
        unknowns: usize,
    },
    /// It is cut into constraint rows.
    Cut(CutReason),
}

/// Why a joint is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CutReason {
    /// Its type has no tree form: a rod or a leg.
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
    /// Which end of the joint is on the parent: 0 (i) or 1 (j).
    pub parent_end: usize,
    /// Its chain of freedoms from parent to child.
    pub steps: Vec<Step>,
    /// 0 if drivers alone place the child, k + 1 if block k does.
    pub stage: usize,
}

/// One freedom of a link.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// Which motion.
    pub freedom: Freedom,
    /// -1 where the link runs from body j to body i, so that coordinates stay those of j relative to i.
    pub sign: f64,
    /// Its first coordinate in [`Topology::coordinates`].
    pub first: usize,
    /// Whether a driver prescribes it.
    pub is_driven: bool,
}

/// A coordinate of the tree.
#[derive(Clone, Copy, Debug)]
pub struct Coordinate {
    /// Its link.
    pub link: usize,
    /// Where its value comes from.
    pub source: Source,
    /// Whether it is a length (else an angle).
    pub is_length: bool,
    /// What it is compared with: the size of the largest loop that it moves, m, if it is a length; else 1 rad.
    pub unit: f64,
    /// 1 / unit.
    pub per_unit: f64,
}

/// Where a coordinate's value comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// A driver prescribes it.
    Driven(DriverId),
    /// Column `column` of block `block`.
    Unknown {
        /// Which block.
        block: usize,
        /// Which of the block's unknowns.
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
    /// The body on which its loop stands: where the ways from its two bodies to ground meet. Points are held together along
    /// its axes, so that the loop knows nothing of where its base goes.
    pub base: BodyId,
    /// The link that places the base, if that is done by the block that solves the closure.
    pub base_link: Option<usize>,
    /// The elementary constraints.
    pub rows: Vec<Row>,
    /// Number of the first row in [`Topology::rows`].
    pub first_row: usize,
    /// If a point follows a curve: which of all curves, counted over the closures.
    pub contact: Option<usize>,
    /// Whether any of its rows asks for the markers' axes, rather than for their points only.
    pub has_axes: bool,
    /// Whether the rows that it is solved with ask for points only.
    pub solved_by_points: bool,
    /// The block that solves it; `None` if no unknown moves it.
    pub block: Option<usize>,
    /// Its columns in that block: column, coordinate, and +1 or -1 for the side of j or i.
    pub entries: Vec<(usize, usize, f64)>,
    /// All links around the loop that it closes.
    pub links: Vec<(usize, f64)>,
    /// Extent of the joints of that loop in the design configuration, m: what its gaps are compared with.
    pub size: f64,
}

impl Closure {
    /// The numbers of its rows in [`Topology::rows`].
    #[inline(always)]
    pub fn numbers(&self) -> std::ops::Range<usize> {
        self.first_row..self.first_row + self.rows.len()
    }
}

/// Where a constraint row stands.
#[derive(Clone, Debug)]
pub struct RowPlace {
    /// Its closure.
    pub closure: usize,
    /// Which of the closure's rows.
    pub index: usize,
    /// Whether it is one of the independent rows that are solved with; else it is redundant and watched.
    pub selected: bool,
    /// The further terms of a coupler, which this row is the first of: their rows, and their factors.
    pub terms: Vec<(usize, f64)>,
    /// Of a coupler: the columns of its block where its terms stand.
    pub columns: Vec<CoupledColumn>,
    /// Whether it is a further term of a coupler, and no constraint by itself.
    pub is_term: bool,
    /// What its residual is compared with: the size of its loop, m, if that is a length; else 1.
    pub unit: f64,
}

/// Where the terms of a coupler meet in a column of its block.
#[derive(Clone, Debug)]
pub struct CoupledColumn {
    /// The column.
    pub column: usize,
    /// The terms' rows, the coordinate of the column, and the factor with the side of its loop.
    pub parts: Vec<(usize, usize, f64)>,
}

/// Unknowns and rows that are solved together.
#[derive(Clone, Debug)]
pub struct Block {
    /// Coordinates, by column.
    pub unknowns: Vec<usize>,
    /// The closures whose rows belong to it.
    pub closures: Vec<usize>,
    /// Those of its rows that are couplers.
    pub coupled: Vec<usize>,
    /// The independent rows that it is solved with, as many as unknowns.
    pub selected: Vec<usize>,
    /// Range of [`Topology::links`] that it places.
    pub links: std::ops::Range<usize>,
    /// How many multiplications its factors take in the design configuration, if they are sparse.
    pub multiplications: usize,
}

impl Topology {
    /// Plans the solution of a model.
    ///
    /// # Errors
    /// A [`TopologyFault`] where the drivers leave motions free, prescribe more than can move, or stand at
    /// a dead point of the design configuration.
    pub fn of(model: &Model, formulation: Formulation) -> Result<Self, TopologyFault> {
        let mut topology = tree::grow(model, formulation);
        size::measure(model, &mut topology);
        blocks::split(model, &mut topology)?;
        mobility::examine(model, &mut topology)?;
        Ok(topology)
    }

    /// Links placed by drivers alone.
    pub fn driven_links(&self) -> std::ops::Range<usize> {
        0..self.blocks.first().map_or(self.links.len(), |b| b.links.start)
    }

    /// How many coordinates are unknown.
    pub fn unknowns(&self) -> usize {
        self.blocks.iter().map(|b| b.unknowns.len()).sum()
    }

    /// The rows that are left out because the others imply them, with their joints.
    pub fn redundant(&self) -> impl Iterator<Item = (&Closure, Row)> {
        self.rows.iter().filter(|r| !r.selected && !r.is_term).map(|r| {
            let c = &self.closures[r.closure];
            (c, c.rows[r.index])
        })
    }

    /// All constraint rows of a block's closures, the redundant ones included.
    pub fn rows_of_block(&self, block: usize) -> Vec<usize> {
        let closures = self.blocks[block].closures.iter().map(|&c| &self.closures[c]);
        let rows = closures.flat_map(|c| c.first_row..c.first_row + c.rows.len());
        rows.filter(|&r| !self.rows[r].is_term).collect()
    }

    /// The rows whose sum, each times its factor, is constraint row r: itself, and a coupler's further terms.
    pub fn parts_of_row(&self, r: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        std::iter::once((r, 1.0)).chain(self.rows[r].terms.iter().copied())
    }

    /// What a closure's rows are called in messages: the joint with its constraint, the driver, or the coupler.
    pub(crate) fn row_name(&self, model: &Model, r: usize) -> String {
        let place = &self.rows[r];
        let closure = &self.closures[place.closure];
        let row = self.describe(model, closure, closure.rows[place.index]);
        match (closure.driver, closure.coupler) {
            (Some(d), _) => format!("driver `{}` ({row})", model.drivers[d.0].name),
            (None, Some(c)) => format!("coupler `{}`", model.couplers[c].name),
            (None, None) => format!("`{}` ({row})", model.joints[closure.joint.0].name),
        }
    }

    /// What a closure's row asks for, in words.
    pub fn describe(&self, model: &Model, closure: &Closure, row: Row) -> String {
        match row {
            Row::PointOnBase(k) => {
                format!(
                    "points coincide along {} of `{}`",
                    ["x", "y", "z"][k],
                    model.bodies[closure.base.0].name
                )
            }
            _ => row.describe(),
        }
    }

    /// Solves a block with these independent rows, in ascending order, from now on.
    pub(crate) fn select(&mut self, block: usize, selected: Vec<usize>) {
        for r in self.rows_of_block(block) {
            self.rows[r].selected = selected.binary_search(&r).is_ok();
        }
        for &c in &self.blocks[block].closures {
            let closure = &mut self.closures[c];
            let rows = closure.rows.iter().zip(&self.rows[closure.first_row..]);
            closure.solved_by_points = rows.filter(|(_, p)| p.drives()).all(|(row, _)| !row.has_axes());
        }
        self.blocks[block].selected = selected;
    }

    /// Joints whose motion or closing a block decides.
    pub fn joints_of_block(&self, block: usize) -> Vec<JointId> {
        let block = &self.blocks[block];
        let tree = block.unknowns.iter().filter_map(|&c| self.links[self.coordinates[c].link].joint);
        let cut = block.closures.iter().map(|&c| self.closures[c].joint);
        let mut joints: Vec<JointId> = tree.chain(cut).collect();
        joints.sort_unstable();
        joints.dedup();
        joints
    }
}

impl RowPlace {
    /// Whether the motion needs its wrench: it is solved with, or a term of a coupler.
    pub fn drives(&self) -> bool {
        self.selected || self.is_term || !self.terms.is_empty()
    }
}

impl Link {
    /// Its coordinates in [`Topology::coordinates`].
    pub fn coordinates(&self) -> impl Iterator<Item = usize> + '_ {
        self.steps.iter().flat_map(|s| s.first..s.first + s.freedom.coordinates())
    }

    /// Whether its unit twists never change: a single freedom that starts on ground.
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

impl Step {
    /// World unit twist of its coordinate k (0, or 0 to 2 for a ball) where its frame is `frame`.
    #[inline(always)]
    pub fn twist<T: crate::space::Real>(
        &self,
        k: usize,
        rot: &Mat3<T>,
        r: crate::space::Vec3<T>,
    ) -> Twist<T> {
        match self.freedom {
            // x = [h; c x h] of a turn about h through c, [0; h] of a slide; backwards, from j to i, with its sign turned (4)
            Freedom::Turn(axis) => Twist::turn(rot.cols[axis] * T::constant(self.sign), r),
            Freedom::Slide(axis) => Twist::slide(rot.cols[axis] * T::constant(self.sign)),
            Freedom::Ball => Twist::turn(rot.cols[k], r),
        }
    }
}
