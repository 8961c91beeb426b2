//! Spanning tree with the fewest unknowns.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::constraint::Row;
use crate::joint::Freedom;
use crate::model::{BodyId, DriverId, GROUND, Joint, JointId, Model};

use super::{
    BlockId, Closure, ClosureId, Coordinate, CoordinateId, CutReason, Formulation, JointRole, Link, LinkId,
    LinkStep, LoopLink, RowId, RowPlace, RowTerm, SetBy, Topology,
};

/// Cost of a joint that the model requests to cut. A body without any tree joint has six unknowns, so a joint with a
/// cost of six is never chosen.
const REQUESTED_CUT: usize = 6;

/// Drivers of each joint, with the freedom of the joint that each prescribes.
type DriversOf = Vec<Vec<(DriverId, Option<usize>)>>;

/// Chooses the tree and lists links, coordinates and closures. Blocks are assigned later. `preferred` are joints that
/// are in the tree if a tree has room for them; of joints with the same number of unknowns, `favoured` ones come first.
pub(super) fn choose_tree(
    model: &Model,
    formulation: Formulation,
    preferred: &[JointId],
    favoured: &[JointId],
) -> Topology {
    let mut topology = Topology {
        formulation,
        links: Vec::new(),
        coordinates: Vec::new(),
        closures: Vec::new(),
        blocks: Vec::new(),
        rows: Vec::new(),
        coupled_rows: Vec::new(),
        coupler_terms: Vec::new(),
        mobility: 0,
        roles: roles_outside_tree(model, formulation),
        start: None,
    };
    let mut drivers_of: DriversOf = vec![Vec::new(); model.joints.len()];
    for (k, d) in model.drivers.iter().enumerate() {
        drivers_of[d.joint.0].push((DriverId(k), model.driven(d).freedom));
    }
    let paths = add_links(model, &drivers_of, [preferred, favoured], &mut topology);
    add_closures(model, &drivers_of, &paths, &mut topology);
    couple_rows(model, &mut topology);
    topology
}

/// Roles of the joints as long as none is in the tree.
fn roles_outside_tree(model: &Model, formulation: Formulation) -> Vec<JointRole> {
    let reason = |j: &Joint| match (formulation, j.kind.freedoms, j.cut) {
        (Formulation::Absolute, ..) => CutReason::Absolute,
        (Formulation::Relative, None, _) => CutReason::AlwaysCut,
        (Formulation::Relative, Some(_), true) => CutReason::Requested,
        (Formulation::Relative, Some(_), false) => CutReason::ClosesLoop,
    };
    model.joints.iter().map(|j| JointRole::Cut(reason(j))).collect()
}

/// Adds the links of the tree. Returns the path of each body to ground.
///
/// This is Prim's algorithm from ground: the joint with the fewest unknowns first, and among equals the one nearest to
/// ground, then the first in the file. Shallow trees keep loops small and independent.
fn add_links(
    model: &Model,
    drivers_of: &DriversOf,
    [preferred, favoured]: [&[JointId]; 2],
    topology: &mut Topology,
) -> Vec<PathToGround> {
    let mut depth: Vec<Option<usize>> = vec![None; model.bodies.len()];
    let mut reachable = Reachable::new(model, drivers_of, topology.formulation, [preferred, favoured]);
    let mut first_orphan = 0;
    reachable.place(&mut depth, GROUND, 0);
    loop {
        match reachable.next(&depth) {
            Some(Candidate { unknowns, depth: parent_depth, joint, parent_end, .. }) => {
                let bodies = model.joints[joint].bodies;
                let (parent, child) = (bodies[parent_end], bodies[1 - parent_end]);
                topology.roles[joint] = JointRole::Tree { child, unknowns };
                add_joint_link(
                    model,
                    &drivers_of[joint],
                    topology,
                    JointId(joint),
                    parent,
                    child,
                    parent_end,
                );
                reachable.place(&mut depth, child, parent_depth + 1);
            }
            None => {
                let orphan = depth[first_orphan..].iter().position(Option::is_none);
                let Some(orphan) = orphan.map(|k| BodyId(first_orphan + k)) else { break };
                first_orphan = orphan.0 + 1;
                add_free_link(topology, orphan);
                reachable.place(&mut depth, orphan, 1);
            }
        }
    }
    // Ground has no link, and depth 0.
    let mut paths = vec![PathToGround { link: LinkId(0), depth: 0 }; model.bodies.len()];
    for (k, link) in LinkId::each(&topology.links) {
        let depth = depth[link.child.0].expect("every body is placed by now");
        paths[link.child.0] = PathToGround { link: k, depth };
    }
    paths
}

/// Adds the closures of joints outside the tree with their drivers, of rows that tree joints have, and of the terms of
/// couplers, which come last.
fn add_closures(model: &Model, drivers_of: &DriversOf, paths: &[PathToGround], topology: &mut Topology) {
    for (k, joint) in model.joints.iter().enumerate() {
        let cut = matches!(topology.roles[k], JointRole::Cut(_));
        let mut add = |driver: Option<DriverId>, rows: Vec<Row>| {
            let owner = Owner { joint: JointId(k), driver, coupler: None };
            add_closure(topology, paths, owner, joint.bodies, rows);
        };
        let rows = if cut { joint.kind.rows } else { joint.kind.tree_rows };
        if !rows.is_empty() {
            add(None, rows.to_vec());
        }
        for &(d, _) in drivers_of[k].iter().filter(|_| cut) {
            add(Some(d), vec![model.driven(&model.drivers[d.0]).row]);
        }
    }
    for (c, coupler) in model.couplers.iter().enumerate() {
        for term in &coupler.terms {
            let owner = Owner { joint: term.joint, driver: None, coupler: Some(c) };
            let bodies = model.joints[term.joint.0].bodies;
            add_closure(topology, paths, owner, bodies, vec![model.coupled(term).row]);
        }
    }
}

/// Makes the rows of each coupler's terms, which are the last ones, one constraint.
fn couple_rows(model: &Model, topology: &mut Topology) {
    let mut first = topology.rows.len() - model.couplers.iter().map(|c| c.terms.len()).sum::<usize>();
    for coupler in &model.couplers {
        // Every other row has the factor 1, so a coupler is divided by its first coefficient.
        let others = coupler.terms.iter().enumerate().skip(1);
        let factors = others.map(|(k, t)| RowTerm {
            row: RowId(first + k),
            factor: t.coefficient / coupler.terms[0].coefficient,
        });
        topology.rows[first].terms = factors.collect();
        topology.rows[first].constant = coupler.constant / coupler.terms[0].coefficient;
        topology.coupled_rows.push(RowId(first));
        topology.coupler_terms.extend((first..first + coupler.terms.len()).map(RowId));
        for k in 1..coupler.terms.len() {
            topology.rows[first + k].is_term = true;
        }
        first += coupler.terms.len();
    }
}

/// Candidate for the next tree joint; the minimum is taken first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Candidate {
    unknowns: usize,
    /// False comes first.
    is_ordinary: bool,
    /// Depth of the body that is already placed.
    depth: usize,
    joint: usize,
    parent_end: usize,
}

/// Joints between placed bodies and other bodies.
struct Reachable<'m> {
    model: &'m Model,
    /// Joints with a tree form of each body, with the number of unknowns that each would leave, and the end on the
    /// body.
    joints_of: Vec<Vec<(usize, usize, usize)>>,
    favoured: &'m [JointId],
    candidates: BinaryHeap<Reverse<Candidate>>,
}

impl<'m> Reachable<'m> {
    fn new(
        model: &'m Model,
        drivers_of: &DriversOf,
        formulation: Formulation,
        [preferred, favoured]: [&'m [JointId]; 2],
    ) -> Self {
        let mut joints_of = vec![Vec::new(); model.bodies.len()];
        if formulation == Formulation::Relative {
            for (k, j) in model.joints.iter().enumerate() {
                let Some(freedoms) = j.kind.freedom_count() else { continue };
                let driven = drivers_of[k].iter().filter(|d| d.1.is_some()).count();
                let unknowns = match j.cut {
                    true => REQUESTED_CUT,
                    false if preferred.contains(&JointId(k)) => 0,
                    false => freedoms - driven,
                };
                if unknowns < REQUESTED_CUT {
                    for (end, body) in j.bodies.iter().enumerate() {
                        joints_of[body.0].push((k, unknowns, end));
                    }
                }
            }
        }
        Self { model, joints_of, favoured, candidates: BinaryHeap::new() }
    }

    /// Marks a body as placed, and adds the joints to its neighbours.
    fn place(&mut self, depth: &mut [Option<usize>], body: BodyId, at: usize) {
        depth[body.0] = Some(at);
        for &(joint, unknowns, parent_end) in &self.joints_of[body.0] {
            let is_ordinary = !self.favoured.contains(&JointId(joint));
            self.candidates.push(Reverse(Candidate { unknowns, is_ordinary, depth: at, joint, parent_end }));
        }
    }

    /// Returns the best joint to a body that is not placed yet.
    fn next(&mut self, depth: &[Option<usize>]) -> Option<Candidate> {
        while let Some(Reverse(c)) = self.candidates.pop() {
            if depth[self.model.joints[c.joint].bodies[1 - c.parent_end].0].is_none() {
                return Some(c);
            }
        }
        None
    }
}

fn add_joint_link(
    model: &Model,
    drivers: &[(DriverId, Option<usize>)],
    topology: &mut Topology,
    joint: JointId,
    parent: BodyId,
    child: BodyId,
    parent_end: usize,
) {
    let freedoms = model.joints[joint.0].kind.freedoms.expect("only joints with freedoms are in the tree");
    // From j to i the chain is reversed, and so is every motion.
    let order: Vec<usize> =
        if parent_end == 0 { (0..freedoms.len()).collect() } else { (0..freedoms.len()).rev().collect() };
    let sign = if parent_end == 0 { 1.0 } else { -1.0 };
    let steps: Vec<(Freedom, Option<DriverId>)> = order
        .into_iter()
        .map(|k| {
            let driver = drivers.iter().find(|(_, f)| *f == Some(k)).map(|(d, _)| *d);
            (freedoms[k], driver)
        })
        .collect();
    add_link(topology, Some(joint), parent, child, parent_end, sign, &steps);
}

fn add_free_link(topology: &mut Topology, child: BodyId) {
    let steps = [Freedom::Slide(0), Freedom::Slide(1), Freedom::Slide(2), Freedom::Ball].map(|f| (f, None));
    add_link(topology, None, GROUND, child, 0, 1.0, &steps);
}

fn add_link(
    topology: &mut Topology,
    joint: Option<JointId>,
    parent: BodyId,
    child: BodyId,
    parent_end: usize,
    sign: f64,
    freedoms: &[(Freedom, Option<DriverId>)],
) {
    let link = LinkId(topology.links.len());
    let mut steps = Vec::new();
    for &(freedom, driver) in freedoms {
        steps.push(LinkStep {
            freedom,
            sign,
            first: CoordinateId(topology.coordinates.len()),
            is_driven: false,
        });
        for _ in 0..freedom.coordinates() {
            topology.coordinates.push(Coordinate {
                link,
                // The block of an unknown is set later.
                set_by: driver.map_or(SetBy::Block { block: BlockId(usize::MAX), column: 0 }, SetBy::Driver),
                is_length: matches!(freedom, Freedom::Slide(_)),
                unit: 1.0,
                per_unit: 1.0,
            });
        }
    }
    topology.links.push(Link { joint, parent, child, parent_end, steps, stage: 0 });
}

/// Owner of the rows of a closure.
struct Owner {
    joint: JointId,
    driver: Option<DriverId>,
    coupler: Option<usize>,
}

/// Link that places a body, and number of links to ground.
#[derive(Clone, Copy)]
struct PathToGround {
    link: LinkId,
    depth: usize,
}

fn add_closure(
    topology: &mut Topology,
    paths: &[PathToGround],
    Owner { joint, driver, coupler }: Owner,
    bodies: [BodyId; 2],
    rows: Vec<Row>,
) {
    let first_row = RowId(topology.rows.len());
    let closure = ClosureId(topology.closures.len());
    for index in 0..rows.len() {
        topology.rows.push(RowPlace {
            closure,
            index,
            selected: false,
            terms: Vec::new(),
            columns: Vec::new(),
            is_term: false,
            constant: 0.0,
            unit: 1.0,
        });
    }
    let (links, base) = loop_links(topology, paths, bodies);
    let on_base = |row: &Row| if base == GROUND { *row } else { row.on_base() };
    let rows: Vec<Row> = rows.iter().map(on_base).collect();
    let follows = rows.contains(&Row::Contact);
    let contact = follows.then(|| topology.closures.iter().filter(|c| c.contact.is_some()).count());
    topology.closures.push(Closure {
        joint,
        driver,
        coupler,
        bodies,
        base,
        base_link: None,
        has_axes: rows.iter().any(|r| r.has_axes()),
        rows,
        first_row,
        contact,
        solved_by_points: false,
        block: None,
        entries: Vec::new(),
        links,
        extent: Vec::new(),
        size: 1.0,
    });
}

/// Returns the links from j (+1) and from i (-1) down to the body where their paths to ground meet, and that body.
///
/// No path is followed further: in a long chain of loops, the last one is far from ground.
fn loop_links(
    topology: &Topology,
    paths: &[PathToGround],
    [mut i, mut j]: [BodyId; 2],
) -> (Vec<LoopLink>, BodyId) {
    let (mut from_i, mut from_j) = (Vec::new(), Vec::new());
    while i != j {
        let (PathToGround { link: a, depth: depth_i }, PathToGround { link: b, depth: depth_j }) =
            (paths[i.0], paths[j.0]);
        if depth_i >= depth_j {
            from_i.push(LoopLink { link: a, side: -1.0 });
            i = topology[a].parent;
        }
        if depth_j >= depth_i {
            from_j.push(LoopLink { link: b, side: 1.0 });
            j = topology[b].parent;
        }
    }
    from_j.extend(from_i);
    (from_j, i)
}
