//! Independent coordinates of a mechanism with elastic joints: which of its openings the constraints determine, and
//! which free motions they leave.

use std::collections::BTreeMap;

use crate::model::{BodyId, DriverId, JointId, Model};

use super::blocks::{RANK_TOLERANCE, design_jacobian};
use super::plan::SparseRow;
use super::tree::choose_tree;
use super::{CoordinateId, Formulation, JointRole, RowId, SetBy, Topology, size};

/// Lever arm of an unknown coordinate, beside that of an opening, below which the opening is determined instead: the
/// rubber at a joint gives by much less than joints move, so that it keeps its leverage.
const POOR_LEVERAGE: f64 = 0.1;

/// Tree of a mechanism whose elastic joints are open.
pub(crate) struct OpenTree {
    /// Per joint: true if it is cut.
    pub cut: Vec<bool>,
    /// Bodies that no joint places.
    pub floating: Vec<BodyId>,
}

/// Coordinates that are not as the drivers of a model have them.
#[derive(Debug, Default)]
pub(crate) struct Dependence {
    /// Openings and released drivers that the constraints determine from the others.
    pub determined: Vec<DriverId>,
    /// Freedoms of joints that neither constraints nor drivers determine.
    pub free: Vec<(JointId, usize)>,
    /// Joints with such a freedom that is part of the rotation of a ball, which no driver prescribes.
    pub free_balls: Vec<JointId>,
    /// Sizes of the pivots, without dimension: those of different positions can be compared.
    pub pivots: Vec<f64>,
    /// The same without openings: those of the mechanism whose elastic joints are rigid.
    pub rigid_pivots: Vec<f64>,
}

/// Row of a constraint at a position: per coordinate of the tree the body that its link places, the index among the
/// coordinates of the link, and the entry without dimension.
pub(crate) type TreeRow = Vec<(BodyId, usize, f64)>;

/// Returns the tree of a mechanism in relative coordinates, with these joints in it if there is room for them. Of
/// joints with the same number of unknowns, elastic ones come first: their openings are then coordinates of their own,
/// and not differences of large ones, in which a soft motion would be a bend along a stiff direction.
pub(crate) fn open_tree(model: &Model, preferred: &[JointId], elastic: &[JointId]) -> OpenTree {
    let topology = choose_tree(model, Formulation::Relative, preferred, elastic);
    OpenTree {
        cut: topology.roles.iter().map(|role| matches!(role, JointRole::Cut(_))).collect(),
        floating: topology.links.iter().filter(|l| l.joint.is_none()).map(|l| l.child).collect(),
    }
}

/// Finds the openings among the drivers, those from `first` on, and the released drivers that the constraints determine
/// at a position, and the free motions that remain; in the design configuration if there are no rows of a position.
///
/// The rows are eliminated by the largest pivot. An opening is determined where the unknown coordinates of its rows
/// have next to no leverage: a rod that lies nearly in line with a hinge holds the rubber of the hinge, not its angle,
/// which it would stop following where all is in line. A released driver is an unknown coordinate like the others, or
/// at a cut joint nothing at all: which one the user released does not matter.
pub(crate) fn dependence(model: &Model, first: DriverId, at: Option<&[TreeRow]>) -> Dependence {
    let mut topology = choose_tree(model, Formulation::Relative, &[], &[]);
    size::measure(model, &mut topology);
    let released = model.equilibrium.as_ref().map_or(&[][..], |equilibrium| &equilibrium.released);
    // Those of cut joints have rows, which hold nothing.
    let at_cut_joints: Vec<DriverId> =
        topology.closures.iter().filter_map(|c| c.driver.filter(|d| released.contains(d))).collect();
    let mut rows: Vec<BTreeMap<CoordinateId, f64>> = Vec::new();
    let jacobian: Vec<SparseRow> = match at {
        Some(rows) => rows.iter().map(|row| on_tree(&topology, row)).collect(),
        None => {
            let all = RowId::each(&topology.rows).zip(design_jacobian(model, &topology));
            let holds = all.filter(|((_, place), _)| {
                topology[place.closure].driver.is_none_or(|d| !at_cut_joints.contains(&d))
            });
            holds.map(|(_, row)| row).collect()
        }
    };
    for row in jacobian {
        let mut entries = BTreeMap::new();
        for (c, x) in row {
            *entries.entry(c).or_insert(0.0) += x;
        }
        rows.push(entries);
    }
    // Entries are of size one; those that are small beside the largest of all are round-off, even if no larger ones of
    // their columns remain.
    let largest = rows.iter().flat_map(BTreeMap::values).fold(0.0, |most, x| f64::max(most, x.abs()));
    let unknown: Vec<CoordinateId> = topology.unknown_coordinates().collect();
    let weight = |c: CoordinateId| match topology[c].set_by {
        SetBy::Block { .. } => Some(1.0),
        SetBy::Driver(d) if d >= first => Some(POOR_LEVERAGE),
        SetBy::Driver(d) => released.contains(&d).then_some(1.0),
    };
    let is_rigid = |c: CoordinateId| !matches!(topology[c].set_by, SetBy::Driver(d) if d >= first);
    let rigid_pivots = eliminate(rows.clone(), largest, |c| weight(c).filter(|_| is_rigid(c)));
    let pivots = eliminate(rows, largest, weight);
    let sizes = |pivots: &[(CoordinateId, f64)]| pivots.iter().map(|(_, x)| x.abs()).collect();
    let (sizes, rigid_pivots) = (sizes(&pivots), sizes(&rigid_pivots));
    let pivots: Vec<CoordinateId> = pivots.into_iter().map(|(c, _)| c).collect();
    let others = unknown.into_iter().filter(|c| !pivots.contains(c));
    let (free, free_balls) = freedoms(&topology, others);
    let determined = pivots.into_iter().filter_map(|c| match topology[c].set_by {
        SetBy::Driver(d) => Some(d),
        SetBy::Block { .. } => None,
    });
    Dependence {
        determined: determined.chain(at_cut_joints).collect(),
        free,
        free_balls,
        pivots: sizes,
        rigid_pivots,
    }
}

/// Freedoms of joints with these coordinates, and joints of which they are a part of the rotation of a ball.
fn freedoms(
    topology: &Topology,
    coordinates: impl Iterator<Item = CoordinateId>,
) -> (Vec<(JointId, usize)>, Vec<JointId>) {
    let (mut free, mut free_balls) = (Vec::new(), Vec::new());
    for c in coordinates {
        let link = &topology[topology[c].link];
        let Some(joint) = link.joint else { continue };
        let step = link.steps.iter().position(|step| step.first == c && step.freedom.coordinates() == 1);
        match step {
            Some(step) => {
                let freedom = if link.parent_end == 0 { step } else { link.steps.len() - 1 - step };
                free.push((joint, freedom));
            }
            None => free_balls.push(joint),
        }
    }
    (free, free_balls)
}

/// A row of a position by the coordinates of a tree.
fn on_tree(topology: &Topology, row: &TreeRow) -> SparseRow {
    let of = |(body, k, x): &(BodyId, usize, f64)| {
        let link = topology.links.iter().find(|link| link.child == *body)?;
        Some((link.coordinates().nth(*k)?, *x))
    };
    row.iter().filter_map(of).collect()
}

/// Eliminates rows over the columns that have a weight, by the largest weighted pivot. Returns the pivots with their
/// columns, none of which is small beside `largest`.
fn eliminate(
    mut rows: Vec<BTreeMap<CoordinateId, f64>>,
    largest: f64,
    weight: impl Fn(CoordinateId) -> Option<f64>,
) -> Vec<(CoordinateId, f64)> {
    let mut pivots = Vec::new();
    loop {
        let entries = rows.iter().enumerate().flat_map(|(r, row)| row.iter().map(move |(c, x)| (r, *c, *x)));
        let candidates = entries.filter(|(.., x)| x.abs() > RANK_TOLERANCE * largest);
        let weighted = candidates.filter_map(|(r, c, x)| Some((r, c, x, x.abs() * weight(c)?)));
        // Among equals the first one, so that the choice does not depend on round-off alone.
        let best = weighted.reduce(|best, next| if next.3 > best.3 { next } else { best });
        let Some((r, column, pivot, _)) = best else { break };
        let row = rows.swap_remove(r);
        for other in rows.iter_mut() {
            let Some(x) = other.remove(&column) else { continue };
            for (c, y) in row.iter().filter(|(c, _)| **c != column) {
                *other.entry(*c).or_insert(0.0) -= x / pivot * y;
            }
        }
        pivots.push((column, pivot));
    }
    pivots
}

impl Topology {
    /// Plan of a model whose openings are drivers.
    pub(crate) fn of_openings(model: &Model, formulation: Formulation) -> Result<Self, super::TopologyError> {
        let topology = Self::of(model, Formulation::Relative)?;
        Ok(Self { formulation, ..topology })
    }
}
