//! The spanning tree that leaves the fewest unknowns.

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
        mobility: 0,
        roles: Vec::new(),
    };
    // Prim's algorithm from ground: the joint with the fewest unknowns first, and among equals the one
    // nearest to ground, then the first in the file. Shallow trees keep loops small and independent.
    let mut depth: Vec<Option<usize>> = vec![None; model.bodies.len()];
    depth[0] = Some(0);
    while let Some(orphan) = depth.iter().position(Option::is_none) {
        let next = model
            .joints
            .iter()
            .enumerate()
            .filter(|_| formulation == Formulation::Relative)
            .filter_map(|(k, j)| {
                let parent_end = match j.bodies.map(|b| depth[b.0]) {
                    [Some(_), None] => 0,
                    [None, Some(_)] => 1,
                    _ => return None,
                };
                let free = j.kind.freedom_count()? - driven_coordinates(model, JointId(k)).count();
                let unknowns = if j.cut { ASKED_CUT } else { free };
                (unknowns < 6).then(|| ((unknowns, depth[j.bodies[parent_end].0], k), parent_end))
            })
            .min();
        match next {
            Some(((unknowns, parent_depth, k), parent_end)) => {
                let joint = &model.joints[k];
                let (parent, child) = (joint.bodies[parent_end], joint.bodies[1 - parent_end]);
                depth[child.0] = parent_depth.map(|d| d + 1);
                roles[k] = Role::Tree { child, unknowns };
                add_joint_link(model, &mut topology, JointId(k), parent, child, parent_end);
            }
            None => {
                depth[orphan] = Some(1);
                add_free_link(&mut topology, BodyId(orphan));
            }
        }
    }
    for (k, joint) in model.joints.iter().enumerate() {
        let cut = matches!(roles[k], Role::Cut(_));
        if cut && !joint.kind.rows.is_empty() {
            add_closure(&mut topology, JointId(k), None, joint.bodies, joint.kind.rows.to_vec());
        }
        for (d, driver) in model.drivers.iter().enumerate().filter(|(_, d)| d.joint.0 == k) {
            if cut {
                add_closure(
                    &mut topology,
                    JointId(k),
                    Some(DriverId(d)),
                    joint.bodies,
                    vec![model.driven(driver).row],
                );
            }
        }
    }
    topology.roles = roles;
    topology
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

fn add_closure(
    topology: &mut Topology,
    joint: JointId,
    driver: Option<DriverId>,
    bodies: [BodyId; 2],
    rows: Vec<Row>,
) {
    let first_row = topology.rows.len();
    let closure = topology.closures.len();
    for index in 0..rows.len() {
        topology.rows.push(RowPlace { closure, index, selected: false });
    }
    let links = loop_links(topology, bodies);
    topology.closures.push(Closure {
        joint,
        driver,
        bodies,
        rows,
        first_row,
        block: None,
        entries: Vec::new(),
        links,
    });
}

/// Links from j (+1) and from i (-1) down to where their ways to ground meet.
fn loop_links(topology: &Topology, [i, j]: [BodyId; 2]) -> Vec<(usize, f64)> {
    let to_ground = |body: BodyId| {
        let mut way = Vec::new();
        let mut at = body;
        while let Some(k) = topology.links.iter().position(|l| l.child == at) {
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
