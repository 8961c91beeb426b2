//! The spanning tree that leaves the fewest unknowns.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::*;

/// Cost of a joint in the tree: a body without any tree joint has six unknowns, so six is never chosen.
const ASKED_CUT: usize = 6;

/// Chooses the tree and lists links, coordinates and closures; blocks come later.
pub(super) fn grow(model: &Model, formulation: Formulation) -> Topology {
    let mut roles: Vec<Role> = model
        .joints
        .iter()
        .map(|j| {
            Role::Cut(match (formulation, j.kind.freedoms, j.cut) {
                (Formulation::Absolute, ..) => CutReason::Absolute,
                (_, None, _) => CutReason::AlwaysCut,
                (_, _, true) => CutReason::Asked,
                _ => CutReason::ClosesLoop,
            })
        })
        .collect();
    let mut topology = Topology {
        formulation,
        links: Vec::new(),
        coordinates: Vec::new(),
        closures: Vec::new(),
        blocks: Vec::new(),
        rows: Vec::new(),
        coupled_rows: Vec::new(),
        mobility: 0,
        roles: Vec::new(),
    };
    // Prim's algorithm from ground: the joint with the fewest unknowns first, and among equals the one
    // nearest to ground, then the first in the file. Shallow trees keep loops small and independent.
    let mut depth: Vec<Option<usize>> = vec![None; model.bodies.len()];
    let mut reachable = Reachable::new(model, formulation);
    reachable.place(&mut depth, crate::model::GROUND, 0);
    loop {
        match reachable.next(&depth) {
            Some(Candidate { unknowns, depth: parent_depth, joint, parent_end }) => {
                let bodies = model.joints[joint].bodies;
                let (parent, child) = (bodies[parent_end], bodies[1 - parent_end]);
                roles[joint] = Role::Tree { child, unknowns };
                add_joint_link(model, &mut topology, JointId(joint), parent, child, parent_end);
                reachable.place(&mut depth, child, parent_depth + 1);
            }
            None => {
                let Some(orphan) = depth.iter().position(Option::is_none).map(BodyId) else { break };
                add_free_link(&mut topology, orphan);
                reachable.place(&mut depth, orphan, 1);
            }
        }
    }
    let mut link_of = vec![None; model.bodies.len()];
    for (k, link) in topology.links.iter().enumerate() {
        link_of[link.child.0] = Some(k);
    }
    let mut add = |joint: usize, driver: Option<usize>, coupler: Option<usize>, rows: Vec<Row>| {
        let owner = Owner { joint: JointId(joint), driver: driver.map(DriverId), coupler };
        add_closure(&mut topology, &link_of, owner, model.joints[joint].bodies, rows);
    };
    for (k, joint) in model.joints.iter().enumerate() {
        let cut = matches!(roles[k], Role::Cut(_));
        let rows = if cut { joint.kind.rows } else { joint.kind.tree_rows };
        if !rows.is_empty() {
            add(k, None, None, rows.to_vec());
        }
        for (d, driver) in model.drivers.iter().enumerate().filter(|(_, d)| d.joint.0 == k) {
            if cut {
                add(k, Some(d), None, vec![model.driven(driver).row]);
            }
        }
    }
    for (c, coupler) in model.couplers.iter().enumerate() {
        for term in &coupler.terms {
            add(term.joint.0, None, Some(c), vec![model.coupled(term).row]);
        }
    }
    let mut first = topology.rows.len() - model.couplers.iter().map(|c| c.terms.len()).sum::<usize>();
    for coupler in &model.couplers {
        // Every other row has the factor 1, so a coupler is divided by its first coefficient.
        let others = coupler.terms.iter().enumerate().skip(1);
        let factors = others.map(|(k, t)| (first + k, t.coefficient / coupler.terms[0].coefficient));
        topology.rows[first].terms = factors.collect();
        topology.coupled_rows.push(first);
        for k in 1..coupler.terms.len() {
            topology.rows[first + k].is_term = true;
        }
        first += coupler.terms.len();
    }
    topology.roles = roles;
    topology
}

/// A joint that could carry the tree on; the least is taken first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Candidate {
    unknowns: usize,
    /// Of the body that is placed already.
    depth: usize,
    joint: usize,
    parent_end: usize,
}

/// The joints between bodies that are placed and bodies that are not.
struct Reachable<'m> {
    model: &'m Model,
    /// Per body: its joints with a tree form, how many unknowns each would leave, and the body's end.
    joints_of: Vec<Vec<(usize, usize, usize)>>,
    candidates: BinaryHeap<Reverse<Candidate>>,
}

impl<'m> Reachable<'m> {
    fn new(model: &'m Model, formulation: Formulation) -> Self {
        let mut joints_of = vec![Vec::new(); model.bodies.len()];
        if formulation == Formulation::Relative {
            for (k, j) in model.joints.iter().enumerate() {
                let Some(freedoms) = j.kind.freedom_count() else { continue };
                let driven = driven_coordinates(model, JointId(k)).count();
                let unknowns = if j.cut { ASKED_CUT } else { freedoms - driven };
                if unknowns < ASKED_CUT {
                    for (end, body) in j.bodies.iter().enumerate() {
                        joints_of[body.0].push((k, unknowns, end));
                    }
                }
            }
        }
        Self { model, joints_of, candidates: BinaryHeap::new() }
    }

    /// Notes that a body is placed, and what can be reached from it.
    fn place(&mut self, depth: &mut [Option<usize>], body: BodyId, at: usize) {
        depth[body.0] = Some(at);
        for &(joint, unknowns, parent_end) in &self.joints_of[body.0] {
            self.candidates.push(Reverse(Candidate { unknowns, depth: at, joint, parent_end }));
        }
    }

    /// The best joint to a body that is not placed yet.
    fn next(&mut self, depth: &[Option<usize>]) -> Option<Candidate> {
        while let Some(Reverse(c)) = self.candidates.pop() {
            if depth[self.model.joints[c.joint].bodies[1 - c.parent_end].0].is_none() {
                return Some(c);
            }
        }
        None
    }
}

/// Drivers of a joint, and the freedom that each prescribes.
fn driven_coordinates(model: &Model, joint: JointId) -> impl Iterator<Item = (DriverId, usize)> + '_ {
    model.drivers.iter().enumerate().filter(move |(_, d)| d.joint == joint).filter_map(|(k, d)| {
        let freedom = model.driven(d).freedom?;
        Some((DriverId(k), freedom))
    })
}

fn add_joint_link(
    model: &Model,
    topology: &mut Topology,
    joint: JointId,
    parent: BodyId,
    child: BodyId,
    parent_end: usize,
) {
    let freedoms = model.joints[joint.0].kind.freedoms.expect("only joints with freedoms are in the tree");
    // From j to i the chain runs backwards with every motion reversed.
    let order: Vec<usize> =
        if parent_end == 0 { (0..freedoms.len()).collect() } else { (0..freedoms.len()).rev().collect() };
    let sign = if parent_end == 0 { 1.0 } else { -1.0 };
    let steps: Vec<(Freedom, Option<DriverId>)> = order
        .into_iter()
        .map(|k| {
            let driver = driven_coordinates(model, joint).find(|(_, f)| *f == k).map(|(d, _)| d);
            (freedoms[k], driver)
        })
        .collect();
    add_link(topology, Some(joint), parent, child, parent_end, sign, &steps);
}

fn add_free_link(topology: &mut Topology, child: BodyId) {
    let steps = [Freedom::Slide(0), Freedom::Slide(1), Freedom::Slide(2), Freedom::Ball].map(|f| (f, None));
    add_link(topology, None, crate::model::GROUND, child, 0, 1.0, &steps);
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
    let link = topology.links.len();
    let mut steps = Vec::new();
    for &(freedom, driver) in freedoms {
        steps.push(Step { freedom, sign, first: topology.coordinates.len() });
        for _ in 0..freedom.coordinates() {
            topology.coordinates.push(Coordinate {
                link,
                // The block of an unknown is found later.
                source: driver.map_or(Source::Unknown { block: usize::MAX, column: 0 }, Source::Driven),
                is_length: matches!(freedom, Freedom::Slide(_)),
            });
        }
    }
    topology.links.push(Link { joint, parent, child, parent_end, steps, stage: 0 });
}

/// What the rows of a closure belong to.
struct Owner {
    joint: JointId,
    driver: Option<DriverId>,
    coupler: Option<usize>,
}

fn add_closure(
    topology: &mut Topology,
    link_of: &[Option<usize>],
    Owner { joint, driver, coupler }: Owner,
    bodies: [BodyId; 2],
    rows: Vec<Row>,
) {
    let first_row = topology.rows.len();
    let closure = topology.closures.len();
    for index in 0..rows.len() {
        topology.rows.push(RowPlace { closure, index, selected: false, terms: Vec::new(), is_term: false });
    }
    let links = loop_links(topology, link_of, bodies);
    let follows = rows.contains(&Row::Contact);
    let contact = follows.then(|| topology.closures.iter().filter(|c| c.contact.is_some()).count());
    topology.closures.push(Closure {
        joint,
        driver,
        coupler,
        bodies,
        rows,
        first_row,
        contact,
        block: None,
        entries: Vec::new(),
        links,
    });
}

/// Links from j (+1) and from i (-1) down to where their ways to ground meet.
fn loop_links(topology: &Topology, link_of: &[Option<usize>], [i, j]: [BodyId; 2]) -> Vec<(usize, f64)> {
    let to_ground = |body: BodyId| {
        let mut way = Vec::new();
        let mut at = body;
        while let Some(k) = link_of[at.0] {
            way.push(k);
            at = topology.links[k].parent;
        }
        way
    };
    let (mut a, mut b) = (to_ground(i), to_ground(j));
    while let (Some(x), Some(y)) = (a.last(), b.last()) {
        if x != y {
            break;
        }
        a.pop();
        b.pop();
    }
    b.into_iter().map(|k| (k, 1.0)).chain(a.into_iter().map(|k| (k, -1.0))).collect()
}
