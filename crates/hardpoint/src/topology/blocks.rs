//! Blocks: which unknowns are solved together, in what order, with which independent rows.

use petgraph::algo::{maximum_matching, tarjan_scc};
use petgraph::graph::{DiGraph, NodeIndex, UnGraph};

use super::*;
use crate::space::FullPivot;

/// A pivot below this part of the largest is zero when constraints are counted.
///
/// Rounded input breaks a planar mechanism's redundancy at the size of its last typed digit, at best
/// 1e-16 and often 1e-9 of its size; a real constraint that is this weak could not be solved with anyway.
pub(super) const RANK_TOLERANCE: f64 = 1e-8;

/// A sparse row of the Jacobian at the design configuration: (coordinate, entry), lengths in units of
/// the mechanism's size.
pub(super) type SparseRow = Vec<(usize, f64)>;

/// The Jacobian of all rows of all closures at the design configuration; empty for the further terms of a coupler, which
/// are summed in its row.
pub(super) fn design_jacobian(model: &Model, topology: &Topology) -> Vec<SparseRow> {
    let parts = jacobian_of_parts(model, topology);
    let sum = |(r, place): (usize, &RowPlace)| -> SparseRow {
        if place.is_term {
            return Vec::new();
        }
        let terms = topology.parts_of_row(r);
        terms.flat_map(|(k, factor)| parts[k].iter().map(move |&(c, x)| (c, x * factor))).collect()
    };
    topology.rows.iter().enumerate().map(sum).collect()
}

/// The Jacobian of all rows, each by itself.
///
/// Scaled so that a row of a length is per size. A coupler between lengths and angles keeps its own proportions: its
/// row as a whole is scaled like its first term.
fn jacobian_of_parts(model: &Model, topology: &Topology) -> Vec<SparseRow> {
    let size = model.size();
    let mut rows = Vec::with_capacity(topology.rows.len());
    for closure in &topology.closures {
        let ends = model.ends(closure.joint);
        let first =
            closure.coupler.map_or(&closure.rows[0], |c| &model.coupled(&model.couplers[c].terms[0]).row);
        for row in &closure.rows {
            let wrench = row.wrench(&ends);
            let row = if closure.coupler.is_some() { first } else { row };
            let scale = if row.is_length() { 1.0 / size } else { 1.0 };
            let mut entries = Vec::new();
            for &(k, side) in &closure.links {
                let link = &topology.links[k];
                let frame = link.frame_at_design(model);
                for step in &link.steps {
                    for c in 0..step.freedom.coordinates() {
                        let unit = if topology.coordinates[step.first + c].is_length { size } else { 1.0 };
                        let entry = side * scale * unit * wrench.on(step.twist(c, &frame.rot, frame.r));
                        entries.push((step.first + c, entry));
                    }
                }
            }
            rows.push(entries);
        }
    }
    rows
}

/// Splits unknowns and rows into blocks, and orders the links by them.
pub(super) fn split(model: &Model, topology: &mut Topology) -> Result<(), TopologyFault> {
    let jacobian = design_jacobian(model, topology);
    let unknown: Vec<bool> =
        topology.coordinates.iter().map(|c| matches!(c.source, Source::Unknown { .. })).collect();
    let groups = match independent_groups(topology, &jacobian, &unknown) {
        Some(groups) if assign(topology, &jacobian, &groups).is_ok() => groups,
        // Loops that depend on each other in a way that no single loop shows: solve all together.
        _ => {
            let all: Vec<usize> = (0..unknown.len()).filter(|&c| unknown[c]).collect();
            let groups = if all.is_empty() { Vec::new() } else { vec![all] };
            assign(topology, &jacobian, &groups)
                .map_err(|free| fault::under_driven(model, topology, &free))?;
            groups
        }
    };
    order_links(topology, groups.len());
    Ok(())
}

/// Strongly connected groups of unknowns, in order of solution; `None` where loops alone do not decide.
fn independent_groups(
    topology: &Topology,
    jacobian: &[SparseRow],
    unknown: &[bool],
) -> Option<Vec<Vec<usize>>> {
    // Rows that are independent within their own closure, with the closure's unknowns as pattern.
    let mut graph: UnGraph<(), ()> = UnGraph::default();
    let columns: Vec<usize> = (0..unknown.len()).filter(|&c| unknown[c]).collect();
    let mut node_of = vec![NodeIndex::end(); unknown.len()];
    for &c in &columns {
        node_of[c] = graph.add_node(());
    }
    let mut patterns: Vec<(NodeIndex, &SparseRow)> = Vec::new();
    for closure in topology.closures.iter().filter(|c| !topology.rows[c.first_row].is_term) {
        let range = closure.first_row..closure.first_row + closure.rows.len();
        let dense: Vec<Vec<f64>> = jacobian[range.clone()]
            .iter()
            .map(|row| row.iter().filter(|(c, _)| unknown[*c]).map(|(_, x)| *x).collect())
            .collect();
        let n = dense.first().map_or(0, Vec::len);
        for r in FullPivot::of(dense, n, RANK_TOLERANCE).rows {
            let row = &jacobian[range.start + r];
            let node = graph.add_node(());
            for (c, _) in row.iter().filter(|(c, _)| unknown[*c]) {
                graph.add_edge(node, node_of[*c], ());
            }
            patterns.push((node, row));
        }
    }
    let matching = maximum_matching(&graph);
    // An unknown depends on every other unknown of the row that it is matched with.
    let mut depends: DiGraph<usize, ()> = DiGraph::default();
    let mut at = vec![NodeIndex::end(); unknown.len()];
    for &c in &columns {
        at[c] = depends.add_node(c);
    }
    let mut matched = 0;
    for (node, row) in patterns {
        let Some(mate) = matching.mate(node) else { continue };
        let c = columns[mate.index()];
        matched += 1;
        for (other, _) in row.iter().filter(|(o, _)| unknown[*o] && *o != c) {
            depends.add_edge(at[c], at[*other], ());
        }
    }
    // A loop among bodies that ride on others is solved where those stand: after them, or together with them where they
    // depend on the loop in turn.
    let carriers = carriers(topology, unknown);
    for link in &topology.links {
        for c in link.coordinates().filter(|&c| unknown[c]) {
            for &carrier in &carriers[link.parent.0] {
                depends.add_edge(at[c], at[carrier], ());
            }
        }
    }
    (matched == columns.len()).then(|| {
        let mut groups: Vec<Vec<usize>> =
            tarjan_scc(&depends).into_iter().map(|g| g.into_iter().map(|n| depends[n]).collect()).collect();
        for g in &mut groups {
            g.sort_unstable();
        }
        groups
    })
}

/// Per body, the unknowns that place it next: those of its own link or, where that has none, of its parent.
fn carriers(topology: &Topology, unknown: &[bool]) -> Vec<Vec<usize>> {
    let bodies = 1 + topology.links.iter().map(|l| l.child.0).max().unwrap_or(0);
    let mut carriers = vec![Vec::new(); bodies];
    for link in &topology.links {
        let own: Vec<usize> = link.coordinates().filter(|&c| unknown[c]).collect();
        carriers[link.child.0] = if own.is_empty() { carriers[link.parent.0].clone() } else { own };
    }
    carriers
}

/// Makes blocks of the groups and selects their rows. The error is a basis of motions left free, each a
/// value per coordinate.
fn assign(
    topology: &mut Topology,
    jacobian: &[SparseRow],
    groups: &[Vec<usize>],
) -> Result<(), Vec<Vec<f64>>> {
    let n = topology.coordinates.len();
    for (block, group) in groups.iter().enumerate() {
        for (column, &c) in group.iter().enumerate() {
            topology.coordinates[c].source = Source::Unknown { block, column };
        }
    }
    for row in &mut topology.rows {
        row.selected = false; // also the rows that no block has
    }
    let mut blocks: Vec<Block> = groups
        .iter()
        .map(|g| Block { unknowns: g.clone(), closures: Vec::new(), selected: Vec::new(), links: 0..0 })
        .collect();
    let place = |c: usize| match topology.coordinates[c].source {
        Source::Unknown { block, column } => Some((block, column)),
        Source::Driven(_) => None,
    };
    // A closure belongs to the last block that moves it; the terms of a coupler to the last that moves any of them.
    let block_of: Vec<Option<usize>> =
        jacobian.iter().map(|row| row.iter().filter_map(|(c, _)| place(*c)).map(|(b, _)| b).max()).collect();
    let mut block_of_row = block_of.clone();
    for r in 0..topology.rows.len() {
        for &(term, _) in &topology.rows[r].terms {
            block_of_row[term] = block_of[r];
        }
    }
    let mut entries_of = Vec::with_capacity(topology.closures.len());
    for (k, closure) in topology.closures.iter().enumerate() {
        let block = block_of_row[closure.first_row];
        let mut entries = Vec::new();
        for &(link, side) in &closure.links {
            for step in &topology.links[link].steps {
                for c in step.first..step.first + step.freedom.coordinates() {
                    if let Some((b, column)) = place(c)
                        && Some(b) == block
                    {
                        entries.push((column, c, side));
                    }
                }
            }
        }
        entries_of.push(entries);
        if let Some(b) = block {
            blocks[b].closures.push(k);
        }
    }
    for (closure, entries) in topology.closures.iter_mut().zip(entries_of) {
        closure.block = block_of_row[closure.first_row];
        closure.entries = entries;
    }
    let mut free = Vec::new();
    topology.blocks = blocks;
    for b in 0..groups.len() {
        let rows = topology.rows_of_block(b);
        let width = topology.blocks[b].unknowns.len();
        let dense = rows
            .iter()
            .map(|&r| {
                let mut row = vec![0.0; width];
                for &(c, x) in &jacobian[r] {
                    if let Source::Unknown { block, column } = topology.coordinates[c].source
                        && block == b
                    {
                        row[column] += x;
                    }
                }
                row
            })
            .collect();
        let pivots = FullPivot::of(dense, width, RANK_TOLERANCE);
        let mut selected: Vec<usize> = pivots.rows.iter().map(|&r| rows[r]).collect();
        selected.sort_unstable();
        topology.select(b, selected);
        for v in pivots.free {
            let mut motion = vec![0.0; n];
            for (column, &c) in topology.blocks[b].unknowns.iter().enumerate() {
                motion[c] = v[column];
            }
            free.push(motion);
        }
    }
    if free.is_empty() { Ok(()) } else { Err(free) }
}

/// Sorts links by the stage at which their child's pose is known, and renumbers what refers to them.
fn order_links(topology: &mut Topology, blocks: usize) {
    let mut stage_of_body = std::collections::BTreeMap::new();
    for k in 0..topology.links.len() {
        let link = &topology.links[k];
        let own = link
            .steps
            .iter()
            .flat_map(|s| s.first..s.first + s.freedom.coordinates())
            .filter_map(|c| match topology.coordinates[c].source {
                Source::Unknown { block, .. } => Some(block + 1),
                Source::Driven(_) => None,
            })
            .max()
            .unwrap_or(0);
        let parent = stage_of_body.get(&link.parent).copied().unwrap_or(0);
        let stage = usize::max(own, parent);
        stage_of_body.insert(link.child, stage);
        topology.links[k].stage = stage;
    }
    let mut order: Vec<usize> = (0..topology.links.len()).collect();
    order.sort_by_key(|&k| topology.links[k].stage);
    let mut new_place = vec![0; order.len()];
    for (new, &old) in order.iter().enumerate() {
        new_place[old] = new;
    }
    topology.links = order.iter().map(|&k| topology.links[k].clone()).collect();
    for c in &mut topology.coordinates {
        c.link = new_place[c.link];
    }
    for closure in &mut topology.closures {
        for (k, _) in &mut closure.links {
            *k = new_place[*k];
        }
    }
    for b in 0..blocks {
        let start = topology.links.partition_point(|l| l.stage < b + 1);
        let end = topology.links.partition_point(|l| l.stage < b + 2);
        topology.blocks[b].links = start..end;
    }
}
