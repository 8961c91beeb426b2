//! Blocks: groups of unknowns that are solved together, their order, and their independent rows.

use std::collections::BTreeMap;

use petgraph::algo::kosaraju_scc;
use petgraph::graph::{DiGraph, NodeIndex};

use crate::linalg::FullPivot;
use crate::model::{BodyId, JointId, Model};
use crate::order::sort_by_index;

use super::error::TopologyError;
use super::matching::match_columns;
use super::plan::SparseRow;
use super::{
    Block, BlockId, ClosureColumn, ClosureId, CoordinateId, CoupledColumn, Formulation, LinkId, LoopLink,
    RowId, RowTerm, SetBy, Topology, error,
};

/// Relative size of a pivot below which it is zero in rank decisions.
///
/// Rounded input perturbs the redundancy of a planar mechanism by its last typed digit: at best 1e-16, often 1e-9 of
/// its size. A real constraint that is this weak could not be solved anyway.
pub(super) const RANK_TOLERANCE: f64 = 1e-8;

/// Largest number of unknowns that redundant rows join to one block: a grid of scissors would be one of hundreds.
const LARGEST_TIED: usize = 40;

/// Returns the Jacobian of all rows of all closures in the design configuration. Rows of further terms of a coupler are
/// empty; the first row of the coupler has their sum.
pub(super) fn design_jacobian(model: &Model, topology: &Topology) -> Vec<SparseRow> {
    let parts = jacobian_of_parts(model, topology);
    let sum = |r: RowId| -> SparseRow {
        if topology[r].is_term {
            return Vec::new();
        }
        if topology[r].terms.is_empty() {
            return parts[r.0].clone();
        }
        let mut sum = BTreeMap::new();
        for RowTerm { row, factor } in topology.parts_of_row(r) {
            for &(c, x) in &parts[row.0] {
                // l = sum c_k l_k
                *sum.entry(c).or_insert(0.0) += x * factor;
            }
        }
        sum.into_iter().collect()
    };
    RowId::all(0..topology.rows.len()).map(sum).collect()
}

/// Returns the Jacobian of all rows, without sums of coupler terms.
///
/// Rows of lengths are scaled by the size of their loop. The row of a coupler is scaled as a whole, like its first
/// term, so that the ratio of its lengths and angles is unchanged.
fn jacobian_of_parts(model: &Model, topology: &Topology) -> Vec<SparseRow> {
    let mut rows = Vec::with_capacity(topology.rows.len());
    for closure in &topology.closures {
        let mut ends = model.ends(closure.joint);
        ends.axes = model.bodies[closure.base.0].frame.rot;
        for (r, row) in closure.numbered_rows() {
            let wrench = row.wrench(&ends);
            let scale = 1.0 / topology[r].unit;
            let mut entries = Vec::new();
            for &LoopLink { link, side } in &closure.links {
                let link = &topology[link];
                let frame = link.frame_at_design(model);
                for step in &link.steps {
                    for (k, c) in step.coordinates().enumerate() {
                        let unit = topology[c].unit;
                        // J_ra = +- l_r . x_a, per unit of the row and times that of the coordinate: dimensionless (6)
                        let entry = side * scale * unit * wrench.on(step.twist(k, &frame.rot, frame.r));
                        entries.push((c, entry));
                    }
                }
            }
            rows.push(entries);
        }
    }
    rows
}

/// Splits unknowns and rows into blocks, and orders the links by them.
pub(super) fn split(model: &Model, topology: &mut Topology) -> Result<(), TopologyError> {
    let jacobian = design_jacobian(model, topology);
    let groups = match groups_of(topology, &jacobian) {
        Ok(groups) => groups,
        Err(free) => {
            let nearby = count_free_motions_nearby(model, topology);
            // A design configuration that is open and happens to be singular, like aligned bars, is assembled in
            // another position. The plan of a nearby position is valid there.
            let elsewhere = (model.is_drawn_open() && nearby < free.len())
                .then(|| design_jacobian(&shifted(model), topology))
                .and_then(|jacobian| groups_of(topology, &jacobian).ok());
            elsewhere.ok_or_else(|| error::free_motions(model, topology, &free, nearby))?
        }
    };
    order_links(topology, groups.len());
    Ok(())
}

/// Splits the unknowns into groups, makes blocks of these, and selects their rows. Fails like [`assign`].
fn groups_of(
    topology: &mut Topology,
    jacobian: &[SparseRow],
) -> Result<Vec<Vec<CoordinateId>>, Vec<SparseRow>> {
    if let Some(groups) = independent_groups(topology, jacobian, &[])
        && assign(topology, jacobian, &groups).is_ok()
    {
        let tied = tied_by_redundant_rows(topology, jacobian);
        if tied.is_empty() {
            return Ok(groups);
        }
        let joined = independent_groups(topology, jacobian, &tied)
            .filter(|groups| groups.iter().all(|group| group.len() <= LARGEST_TIED));
        if let Some(joined) = joined
            && assign(topology, jacobian, &joined).is_ok()
        {
            return Ok(joined);
        }
        if assign(topology, jacobian, &groups).is_ok() {
            return Ok(groups);
        }
    }
    // The dependence between loops is not visible in single loops: solve all unknowns together.
    let all: Vec<CoordinateId> = topology.unknown_coordinates().collect();
    let groups = if all.is_empty() { Vec::new() } else { vec![all] };
    assign(topology, jacobian, &groups)?;
    Ok(groups)
}

/// Returns the unknowns of every redundant row that has unknowns of several blocks. Where the rows of a block become
/// dependent, such a row of a later one may hold its unknowns: a third crank beside a parallelogram. With every joint
/// cut, the rows that keep a planar mechanism in its plane would make one block of all bodies.
fn tied_by_redundant_rows(topology: &Topology, jacobian: &[SparseRow]) -> Vec<Vec<CoordinateId>> {
    if topology.formulation == Formulation::Absolute {
        return Vec::new();
    }
    let unknowns = |r: RowId| -> Vec<CoordinateId> {
        let present = jacobian[r.0].iter().filter(|(_, x)| x.abs() > RANK_TOLERANCE);
        present.map(|(c, _)| *c).filter(|c| topology[*c].is_unknown()).collect()
    };
    let block = |c: &CoordinateId| match topology[*c].set_by {
        SetBy::Block { block, .. } => Some(block),
        SetBy::Driver(_) => None,
    };
    let rows = topology.redundant().map(unknowns);
    rows.filter(|tied| tied.iter().any(|c| block(c) != block(&tied[0]))).collect()
}

/// Returns the strongly connected groups of unknowns, in order of solution, with each set of tied unknowns in one
/// group; `None` if the rows of single loops do not determine all unknowns.
fn independent_groups(
    topology: &Topology,
    jacobian: &[SparseRow],
    tied: &[Vec<CoordinateId>],
) -> Option<Vec<Vec<CoordinateId>>> {
    // Rows that are independent within their own closure, with the closure's unknowns as pattern.
    let coordinates: Vec<CoordinateId> = topology.unknown_coordinates().collect();
    let column_of = columns(topology, &coordinates);
    let column_of = |c: CoordinateId| column_of[c.0];
    let mut patterns: Vec<Vec<usize>> = Vec::new();
    // Links that place the base bodies of the loops of these rows.
    let placed_by = last_unknown_links(topology);
    let mut bases: Vec<Vec<LinkId>> = Vec::new();
    for closure in topology.closures.iter().filter(|c| !topology[c.first_row].is_term) {
        let dense: Vec<Vec<f64>> = jacobian[closure.range()]
            .iter()
            .map(|row| row.iter().filter(|(c, _)| topology[*c].is_unknown()).map(|(_, x)| *x).collect())
            .collect();
        let n = dense.first().map_or(0, Vec::len);
        for k in FullPivot::of(dense, n, RANK_TOLERANCE).rows {
            let r = RowId(closure.first_row.0 + k);
            patterns.push(jacobian[r.0].iter().filter_map(|(c, _)| column_of(*c)).collect());
            let closures = topology.parts_of_row(r).map(|part| topology.closure_of(part.row));
            bases.push(closures.filter_map(|c| placed_by[c.base.0]).collect());
        }
    }
    // An unknown depends on every other unknown of the row that it is matched with. A loop could be solved before its
    // base body is placed. Poses of all bodies are computed, however, so it also depends on the unknowns of its base.
    let mut depends: DiGraph<(), ()> = DiGraph::default();
    for _ in &coordinates {
        depends.add_node(());
    }
    for (column, row) in match_columns(&patterns, coordinates.len()).into_iter().enumerate() {
        for &other in patterns[row?].iter().filter(|&&other| other != column) {
            // Unknown `column` is solved from its row once all other unknowns in that row are known.
            depends.add_edge(NodeIndex::new(column), NodeIndex::new(other), ());
        }
        for &link in &bases[row?] {
            for other in topology[link].coordinates().filter_map(column_of).filter(|&other| other != column) {
                depends.add_edge(NodeIndex::new(column), NodeIndex::new(other), ());
            }
        }
    }
    for unknowns in tied {
        let nodes = unknowns.iter().filter_map(|c| column_of(*c)).map(NodeIndex::new);
        for (a, b) in nodes.clone().zip(nodes.cycle().skip(1)) {
            depends.add_edge(a, b, ());
        }
    }
    // Kosaraju's algorithm is not recursive, so that a chain of loops can have any length.
    let groups = kosaraju_scc(&depends).into_iter();
    let mut groups: Vec<Vec<CoordinateId>> =
        groups.map(|g| g.into_iter().map(|n| coordinates[n.index()]).collect()).collect();
    for g in &mut groups {
        g.sort_unstable();
    }
    Some(groups)
}

/// Returns the number of free motions of a perturbed mechanism without accidental alignment: every point is shifted by
/// up to 3 % of the size, and directions of axes are constant.
///
/// Fewer free motions than in the design configuration mean that it is singular, not under-driven. Planar mechanisms
/// remain redundant under such a shift.
fn count_free_motions_nearby(model: &Model, topology: &Topology) -> usize {
    let unknowns: Vec<CoordinateId> = topology.unknown_coordinates().collect();
    let column_of = columns(topology, &unknowns);
    let rows = design_jacobian(&shifted(model), topology).into_iter();
    let rows = rows.map(|row| row.into_iter().filter_map(|(c, x)| Some((column_of[c.0]?, x))).collect());
    FullPivot::of_sparse(rows.collect(), unknowns.len(), RANK_TOLERANCE).free.len()
}

/// Returns the model with every hardpoint shifted by up to 3 % of its size.
fn shifted(model: &Model) -> Model {
    const SHIFT: f64 = 0.03;
    let mut shifted = model.clone();
    let size = model.size();
    // Multiples of the golden ratio are evenly distributed and never repeat.
    let mut parts = (1..).map(|k| 2.0 * (f64::from(k) * 0.618_033_988_749_895).fract() - 1.0);
    for hardpoint in &mut shifted.hardpoints {
        let mut next = || SHIFT * size * parts.next().expect("there is always another");
        hardpoint.position += crate::space::Vec3::new(next(), next(), next());
    }
    // A point touches its curve elsewhere then, where the tangent has another direction.
    for j in 0..shifted.joints.len() {
        let [carrier, follower] = [0, 1].map(|end| shifted.marker(JointId(j), end));
        if let Some(curve) = &mut shifted.joints[j].curve {
            let p = carrier.inverse().point(follower.r);
            *curve = curve.followed_at([p.x, p.y]);
        }
    }
    shifted
}

/// Returns the column of each coordinate, or `None` for coordinates that are not in the list.
fn columns(topology: &Topology, coordinates: &[CoordinateId]) -> Vec<Option<usize>> {
    let mut column_of = vec![None; topology.coordinates.len()];
    for (column, c) in coordinates.iter().enumerate() {
        column_of[c.0] = Some(column);
    }
    column_of
}

/// Returns, for each body, the nearest link with unknowns on its path to ground.
fn last_unknown_links(topology: &Topology) -> Vec<Option<LinkId>> {
    let bodies = topology.links.iter().map(|l| l.child.0).max().unwrap_or(0) + 1;
    let mut placed_by = vec![None; bodies];
    for (k, link) in LinkId::each(&topology.links) {
        let own = link.coordinates().any(|c| topology[c].is_unknown());
        placed_by[link.child.0] = if own { Some(k) } else { placed_by[link.parent.0] };
    }
    placed_by
}

/// Makes blocks of the groups and selects their rows. Fails with a basis of the free motions, each given by its
/// coordinates and their speeds.
fn assign(
    topology: &mut Topology,
    jacobian: &[SparseRow],
    groups: &[Vec<CoordinateId>],
) -> Result<(), Vec<SparseRow>> {
    for (block, group) in BlockId::each(groups) {
        for (column, &c) in group.iter().enumerate() {
            topology[c].set_by = SetBy::Block { block, column };
        }
    }
    for step in topology.links.iter_mut().flat_map(|l| &mut l.steps) {
        step.is_driven = !topology.coordinates[step.first.0].is_unknown();
    }
    for row in &mut topology.rows {
        row.selected = false; // also rows without a block
    }
    let mut blocks: Vec<Block> = groups
        .iter()
        .map(|g| Block {
            unknowns: g.clone(),
            closures: Vec::new(),
            coupled: Vec::new(),
            selected: Vec::new(),
            links: 0..0,
            multiplications: 0,
        })
        .collect();
    let place = |c: CoordinateId| match topology[c].set_by {
        SetBy::Block { block, column } => Some((block, column)),
        SetBy::Driver(_) => None,
    };
    // A closure belongs to the last block that moves it, and the terms of a coupler to the last block that moves any of
    // them. J is block lower triangular: a row has entries in its own and earlier blocks only.
    let block_of: Vec<Option<BlockId>> =
        jacobian.iter().map(|row| row.iter().filter_map(|(c, _)| place(*c)).map(|(b, _)| b).max()).collect();
    let mut block_of_row = block_of.clone();
    for (r, row) in RowId::each(&topology.rows) {
        for term in &row.terms {
            block_of_row[term.row.0] = block_of[r.0];
        }
    }
    let mut entries_of = Vec::with_capacity(topology.closures.len());
    for (k, closure) in ClosureId::each(&topology.closures) {
        let block = block_of_row[closure.first_row.0];
        let mut entries = Vec::new();
        for &LoopLink { link, side } in &closure.links {
            for coordinate in topology[link].coordinates() {
                if let Some((b, column)) = place(coordinate)
                    && Some(b) == block
                {
                    entries.push(ClosureColumn { column, coordinate, side });
                }
            }
        }
        entries_of.push(entries);
        if let Some(b) = block {
            blocks[b.0].closures.push(k);
        }
    }
    for (closure, entries) in topology.closures.iter_mut().zip(entries_of) {
        closure.block = block_of_row[closure.first_row.0];
        closure.entries = entries;
    }
    for k in 0..topology.coupled_rows.len() {
        let r = topology.coupled_rows[k];
        let mut columns: BTreeMap<usize, CoupledColumn> = BTreeMap::new();
        for RowTerm { row, factor } in topology.parts_of_row(r) {
            for &ClosureColumn { column, coordinate, side } in &topology.closure_of(row).entries {
                let new = || CoupledColumn { column, coordinate, parts: Vec::new() };
                columns.entry(column).or_insert_with(new).parts.push(RowTerm { row, factor: side * factor });
            }
        }
        topology[r].columns = columns.into_values().collect();
        if let Some(b) = block_of_row[r.0] {
            blocks[b.0].coupled.push(r);
        }
    }
    let mut free = Vec::new();
    topology.blocks = blocks;
    for b in topology.block_ids() {
        let rows = topology.rows_of_block(b);
        let width = topology[b].unknowns.len();
        let in_block = rows.iter().map(|r| columns_in_block(topology, &jacobian[r.0], b).collect()).collect();
        // A block needs rank = number of its unknowns. Otherwise the null vectors are free motions.
        let pivots = FullPivot::of_sparse(in_block, width, RANK_TOLERANCE);
        let mut selected: Vec<RowId> = pivots.rows.iter().map(|&k| rows[k]).collect();
        selected.sort_unstable();
        topology.select(b, selected);
        for v in pivots.free {
            free.push(v.into_iter().map(|(column, x)| (topology[b].unknowns[column], x)).collect());
        }
    }
    if free.is_empty() { Ok(()) } else { Err(free) }
}

/// Returns the entries of a row of the Jacobian in one block, by column of the block.
pub(super) fn columns_in_block(
    topology: &Topology,
    row: &SparseRow,
    block: BlockId,
) -> impl Iterator<Item = (usize, f64)> {
    row.iter().filter_map(move |&(c, x)| match topology[c].set_by {
        SetBy::Block { block: b, column } if b == block => Some((column, x)),
        _ => None,
    })
}

/// Sorts links by the stage at which their child's pose is known, and renumbers references to links.
fn order_links(topology: &mut Topology, blocks: usize) {
    let mut stage_of_body = BTreeMap::new();
    for k in topology.link_ids() {
        let link = &topology[k];
        let own = link
            .coordinates()
            .filter_map(|c| match topology[c].set_by {
                SetBy::Block { block, .. } => Some(block.0 + 1),
                SetBy::Driver(_) => None,
            })
            .max()
            .unwrap_or(0);
        let parent = stage_of_body.get(&link.parent).copied().unwrap_or(0);
        let stage = usize::max(own, parent);
        stage_of_body.insert(link.child, stage);
        topology[k].stage = stage;
    }
    let mut order: Vec<LinkId> = topology.link_ids().collect();
    sort_by_index(&mut order, |k| topology[*k].stage);
    let mut new_place = vec![LinkId(0); order.len()];
    for (new, old) in LinkId::each(&order) {
        new_place[old.0] = new;
    }
    topology.links = order.iter().map(|&k| topology[k].clone()).collect();
    for c in &mut topology.coordinates {
        c.link = new_place[c.link.0];
    }
    for around in topology.closures.iter_mut().flat_map(|c| &mut c.links) {
        around.link = new_place[around.link.0];
    }
    for b in 0..blocks {
        let start = topology.links.partition_point(|l| l.stage < b + 1);
        let end = topology.links.partition_point(|l| l.stage < b + 2);
        topology.blocks[b].links = start..end;
    }
    let placed_by: BTreeMap<BodyId, LinkId> =
        LinkId::each(&topology.links).map(|(k, link)| (link.child, k)).collect();
    for closure in &mut topology.closures {
        let own = closure.block.map_or(0..0, |b| topology.blocks[b.0].links.clone());
        closure.base_link = placed_by.get(&closure.base).copied().filter(|k| own.contains(&k.0));
    }
}
