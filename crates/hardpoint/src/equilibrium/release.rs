//! The mechanism with its elastic joints open.

use std::collections::BTreeSet;

use crate::joint::{self, DIRECTIONS, elastic, free_directions, with_turns};
use crate::law::Law;
use crate::model::element::Compliance;
use crate::model::{BodyId, Driver, DriverId, GROUND, HardpointId, Joint, JointId, LoadMode, Model};
use crate::space::Mat3;
use crate::topology::{
    CutReason, Dependence, Formulation, JointRole, OpenTree, Topology, TopologyError, TreeRow, dependence,
    open_tree,
};

/// Least pivot of the constraints, as a fraction of that in the design configuration, below which a motion that ends
/// has reached a limit of the mechanism. It goes with the root of the distance from there, which is a billionth of a
/// step.
const NEARLY_SINGULAR: f64 = 1e-3;

/// A mechanism whose elastic joints are open: drivers prescribe the openings.
#[derive(Clone, Debug)]
pub(crate) struct Released {
    /// The model. Its drivers are those of the user, then the openings; released drivers may drive other coordinates
    /// than the user's. Its last joints may be ones without a name that place bodies held by springs alone.
    pub model: Model,
    /// Drivers whose forces are zero in equilibrium: the user's that are released, then the openings.
    pub openings: Vec<DriverId>,
    /// The model with every opening driven, of which the constraints determine some.
    pub every_opening: Model,
}

/// Opens the elastic joints of a model with equilibrium, and plans its solution.
///
/// In absolute coordinates every joint is cut, and the coordinates of every body are openings as far as the constraints
/// do not determine them.
///
/// # Errors
/// See [`Topology::of`].
pub(crate) fn release(
    model: &Model,
    formulation: Formulation,
) -> Result<(Released, Topology), TopologyError> {
    let mut open = Model { load_mode: LoadMode::Static, ..model.clone() };
    let own = DriverId(model.drivers.len());
    let mut elastic_joints = Vec::new();
    for joint in (0..model.joints.len()).map(JointId) {
        let directions = elastic_directions(model, joint);
        let kind = model.joints[joint.0].kind;
        if directions.contains(&true)
            && let Some(elastic) = elastic(kind, directions)
        {
            open.joints[joint.0].kind = elastic.kind;
            elastic_joints.push((joint, kind.coordinates.len(), elastic.can_be_cut));
        }
    }
    if formulation == Formulation::Absolute {
        open.joints.iter_mut().for_each(|joint| joint.cut = true);
        (1..model.bodies.len()).for_each(|b| float(&mut open, BodyId(b)));
    }
    let drive_all = |open: &mut Model, joints: &[(JointId, usize, bool)]| {
        open.drivers.truncate(own.0);
        for &(joint, rigid, _) in joints {
            drive_openings(open, joint, rigid);
        }
        for joint in (model.joints.len()..open.joints.len()).map(JointId) {
            drive_openings(open, joint, 0);
        }
    };
    drive_all(&mut open, &elastic_joints);
    // The rows of some joints do not belong to single directions, so that they are no cut ones.
    let uncut: Vec<JointId> = elastic_joints.iter().filter(|j| !j.2).map(|j| j.0).collect();
    let all: Vec<JointId> = elastic_joints.iter().map(|j| j.0).collect();
    // Bodies that springs alone hold are placed by openings from ground.
    let OpenTree { floating, .. } = open_tree(&open, &uncut, &all);
    for body in floating {
        float(&mut open, body);
    }
    drive_all(&mut open, &elastic_joints);
    // A joint that closes a loop of elastic joints leaves its directions to its force.
    let OpenTree { cut, .. } = open_tree(&open, &uncut, &all);
    if let Some(joint) = uncut.iter().copied().find(|joint| cut[joint.0]) {
        return Err(elastic_loop(model, formulation, joint));
    }
    // The tree stays the same whatever openings turn out to be determined.
    for (joint, cut) in open.joints.iter_mut().zip(&cut) {
        joint.cut |= cut;
    }
    elastic_joints.retain(|(joint, ..)| !cut[joint.0]);
    drive_all(&mut open, &elastic_joints);
    let mut depends = dependence(&open, own, None);
    while !depends.free_balls.is_empty() {
        // A free rotation of a ball is an opening about one of three axes.
        for joint in &depends.free_balls {
            let kind = &mut open.joints[joint.0].kind;
            *kind = with_turns(kind);
        }
        depends = dependence(&open, own, None);
    }
    choose(model, open, depends, formulation)
}

/// A position of a mechanism whose elastic joints are open, as its constraints show it.
pub(crate) struct OpenPosition {
    /// True if the constraints can hardly follow the drivers that are held, whatever the others do.
    pub is_singular: bool,
    /// The same if elastic joints could not open.
    pub is_singular_if_rigid: bool,
    /// The mechanism with the openings that the constraints leave there; `None` if they are the same as before, or if
    /// there is no plan with them.
    pub other: Option<(Released, Topology)>,
}

/// Examines a position with these rows, of a model that was opened before.
pub(crate) fn release_at(
    model: &Model,
    (every_opening, open): (&Model, &Model),
    rows: &[TreeRow],
    formulation: Formulation,
) -> OpenPosition {
    let own = DriverId(model.drivers.len());
    let depends = dependence(every_opening, own, Some(rows));
    let design = dependence(every_opening, own, None);
    // Redundant constraints are small pivots everywhere.
    let loses_rank = |here: &[f64], design: &[f64]| {
        let least = NEARLY_SINGULAR * design.iter().copied().fold(f64::INFINITY, f64::min);
        here.iter().filter(|size| **size > least).count() < design.len()
    };
    let is_singular = loses_rank(&depends.pivots, &design.pivots);
    let is_singular_if_rigid = loses_rank(&depends.rigid_pivots, &design.rigid_pivots);
    let driven = |model: &Model| -> BTreeSet<(usize, usize)> {
        model.drivers.iter().map(|driver| (driver.joint.0, driver.coordinate)).collect()
    };
    let other = (depends.free_balls.is_empty())
        .then(|| choose(model, every_opening.clone(), depends, formulation).ok())
        .flatten()
        .filter(|(released, _)| driven(&released.model) != driven(open));
    OpenPosition { is_singular, is_singular_if_rigid, other }
}

/// Drives the openings that the constraints do not determine, and plans the solution.
fn choose(
    model: &Model,
    mut open: Model,
    depends: Dependence,
    formulation: Formulation,
) -> Result<(Released, Topology), TopologyError> {
    let own = DriverId(model.drivers.len());
    let every_opening = open.clone();
    for (joint, freedom) in depends.free {
        let coordinates = open.joints[joint.0].kind.coordinates;
        if let Some(coordinate) = coordinates.iter().position(|c| c.freedom == Some(freedom)) {
            let name = open.joints[joint.0].name.clone();
            let (law, is_reversed) = (Law::constant(0.0), false);
            open.drivers.push(Driver { name, joint, coordinate, law, is_reversed });
        }
    }
    let (determined_own, determined): (Vec<DriverId>, Vec<DriverId>) =
        depends.determined.into_iter().partition(|d| *d < own);
    let mut numbered: Vec<(usize, Driver)> =
        std::mem::take(&mut open.drivers).into_iter().enumerate().collect();
    numbered.retain(|(d, _)| !determined.contains(&DriverId(*d)));
    open.drivers = numbered.into_iter().map(|(_, driver)| driver).collect();
    // A released driver that others determine has the place of one of these: those of the user keep their numbers.
    for d in determined_own {
        if open.drivers.len() > own.0
            && let Some(Driver { joint, coordinate, .. }) = open.drivers.pop()
        {
            let released = &mut open.drivers[d.0];
            (released.joint, released.coordinate) = (joint, coordinate);
        }
    }
    let mut topology =
        Topology::of_openings(&open, formulation).map_err(|error| error.without_openings(own))?;
    for (role, joint) in topology.roles.iter_mut().zip(&model.joints) {
        if *role == JointRole::Cut(CutReason::Requested) && !joint.cut {
            *role = JointRole::Cut(match formulation {
                Formulation::Relative => CutReason::ClosesLoop,
                Formulation::Absolute => CutReason::Absolute,
            });
        }
    }
    let released = model.equilibrium.iter().flat_map(|e| e.released.iter().copied());
    let openings = released.chain((own.0..open.drivers.len()).map(DriverId)).collect();
    Ok((Released { model: open, openings, every_opening }, topology))
}

/// Error of a joint that is cut and cannot be. If it closes a loop, it would be cut in relative coordinates too, and
/// without the request of the model.
fn elastic_loop(model: &Model, formulation: Formulation, joint: JointId) -> TopologyError {
    let mut uncut = model.clone();
    uncut.joints[joint.0].cut = false;
    let (cut, otherwise) = match formulation {
        Formulation::Absolute => (CutReason::Absolute, release(model, Formulation::Relative).err()),
        Formulation::Relative if model.joints[joint.0].cut => {
            (CutReason::Requested, release(&uncut, formulation).err())
        }
        Formulation::Relative => (CutReason::ClosesLoop, None),
    };
    match otherwise {
        Some(error @ TopologyError::ElasticLoop { .. }) => error,
        Some(
            TopologyError::UnderDriven { .. }
            | TopologyError::Singular { .. }
            | TopologyError::OverDriven { .. }
            | TopologyError::Immovable { .. },
        )
        | None => {
            let joint_name = model.joints[joint.0].name.clone();
            TopologyError::ElasticLoop { joint, joint_name, cut }
        }
    }
}

/// Directions in which a joint gives and is not free.
fn elastic_directions(model: &Model, joint: JointId) -> [bool; DIRECTIONS] {
    let free = free_directions(model.joints[joint.0].kind);
    let mut gives = [false; DIRECTIONS];
    for element in &model.elements {
        if let Some(Compliance::Joint(of)) = element.kind.force(model).map(|force| force.compliance)
            && of.joint == joint
        {
            let own = of.law().gives();
            (0..DIRECTIONS).for_each(|k| gives[k] |= own[k] && !free[k]);
        }
    }
    gives
}

/// Adds a driver per opening of a joint, whose rigid type has this number of coordinates.
fn drive_openings(open: &mut Model, joint: JointId, rigid: usize) {
    let Joint { kind, name, .. } = &open.joints[joint.0];
    let openings = kind.coordinates.iter().enumerate().skip(rigid).map(|(coordinate, of)| Driver {
        name: format!("{name}.{}", of.name),
        joint,
        coordinate,
        law: Law::constant(0.0),
        is_reversed: false,
    });
    let openings: Vec<Driver> = openings.collect();
    open.drivers.extend(openings);
}

/// Adds a joint without a name that places a body relative to ground by six openings.
fn float(open: &mut Model, body: BodyId) {
    let on_body = |joint: &&Joint| joint.bodies.contains(&body);
    let of_joint =
        open.joints.iter().find(on_body).map(|joint| joint.at[usize::from(joint.bodies[1] == body)]);
    let of_point = || open.points.iter().find(|p| p.body == body).map(|p| p.at);
    let at = of_joint.or_else(of_point).unwrap_or(HardpointId(0));
    let all = elastic(&joint::FIXED, [true; DIRECTIONS]).map_or(&joint::FIXED, |of| of.kind);
    open.joints.push(Joint {
        name: open.bodies[body.0].name.clone(),
        kind: all,
        bodies: [GROUND, body],
        at: [at; 2],
        axis: None,
        axis2: None,
        frames: [Mat3::IDENTITY; 2],
        length: None,
        curve: None,
        cut: false,
        unnamed: true,
    });
}
