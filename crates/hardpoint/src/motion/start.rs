//! Start of the assembly elsewhere than in the design configuration, and the other assemblies of a mechanism.
//!
//! A mechanism can be put together in several ways: a dyad on either side of the line through its ends, a coupler
//! turned over. Each is a solution of the position equations with all drivers at zero. They are found by least squares
//! from positions scattered over the travel of all joints. A model names one by the placements of its bodies; their
//! joint coordinates are where the assembly of every design starts.

use std::sync::Arc;

use crate::joint::Freedom;
use crate::linalg::Elimination;
use crate::model::{Model, StartPlacement};
use crate::number;
use crate::space::{Pose, Quat, Vec3};
use crate::topology::{CoordinateId, LinkId, SetBy, StartCoordinates, Topology};

use super::assembly::{self, assemble, placements};
use super::kinematics::State;
use super::mechanism::LOCKED;
use super::parts::PlanGeometry;
use super::path::Path;
use super::stepper::Stepper;

/// Error of a link's pose, rad and sizes, at which its coordinates are found: round-off of numbers in a file.
const REACHED: f64 = 1e-9;
/// Maximum number of corrections of a link's coordinates; near the solution they converge quadratically.
const MOST_CORRECTIONS: usize = 60;
/// Damping of these corrections, relative to coordinates of one unit: links in line have dependent coordinates.
const DAMPING: f64 = 1e-12;
/// Maximum correction, rad or sizes.
const LONGEST: f64 = 1.0;
/// Angles from which each turn of a link is tried, rad: thirds of a turn, of which one is near every angle.
const THIRDS: [f64; 3] = [0.0, 2.094_395_102_393_195_5, -2.094_395_102_393_195_5];
/// Placements are the same if no point of a body is further apart than this, sizes.
const SAME: f64 = 1e-6;

/// Coordinates at which the assembly of a model starts; `None` if that is the design configuration.
pub(crate) fn start_coordinates(model: &Model, topology: &Topology) -> Option<Arc<StartCoordinates>> {
    if model.start.is_empty() {
        return None;
    }
    let (design, laws) = (model.geometry(&[]), model.laws(&[]));
    let parts = PlanGeometry::same(model, topology, &design, &laws);
    let mut state = State::new(model, topology);
    for k in topology.link_ids() {
        // X_c = F_c M_c^-1, so that the marker that places the body is at  F_c = X_c M_c
        let target = model.start_pose(topology[k].child).compose(parts.child_from_marker[k.0].inverse());
        reach(&mut state, topology, &parts, k, (target, model.size()));
    }
    // A curve is touched there at another place than in the design configuration.
    state.find_contacts(topology, &parts, LOCKED);
    let contacts = state.contacts.iter().map(|contact| contact.u).collect();
    let mut topology = topology.clone();
    let mut start = StartCoordinates { q: state.q, balls: state.balls, contacts, signs: Vec::new() };
    topology.start = Some(Arc::new(start.clone()));
    let mut one = Stepper::new(model, &topology, parts).mechanism;
    one.measure_gaps();
    if one.solve_at(Path::Assembly, 0.0).is_ok() {
        start.signs = one.state.pivots.iter().map(|(_, positive)| *positive).collect();
    }
    Some(Arc::new(start))
}

/// Sets the coordinates of a link, whose parent is placed, so that its child is at the target or nearest to it.
fn reach(
    state: &mut State<f64>,
    topology: &Topology,
    parts: &PlanGeometry<f64>,
    k: LinkId,
    target: (Pose, f64),
) {
    let free: Vec<CoordinateId> =
        topology[k].coordinates().filter(|c| !matches!(topology[*c].set_by, SetBy::Driver(_))).collect();
    let turns: Vec<CoordinateId> = (topology[k].steps.iter())
        .filter(|step| matches!(step.freedom, Freedom::Turn(_)) && free.contains(&step.first))
        .map(|step| step.first)
        .collect();
    let mut best: Option<(f64, Vec<f64>, Vec<Quat<f64>>)> = None;
    for start in 0..THIRDS.len().pow(turns.len() as u32) {
        for c in topology[k].coordinates() {
            (state.q[c.0], state.balls[c.0]) = (0.0, Quat::IDENTITY);
        }
        let mut digits = start;
        for c in &turns {
            state.q[c.0] = THIRDS[digits % THIRDS.len()];
            digits /= THIRDS.len();
        }
        let error = approach(state, topology, parts, (k, &free), target);
        if best.as_ref().is_none_or(|(least, ..)| error < *least) {
            best = Some((error, state.q.clone(), state.balls.clone()));
        }
        if error <= REACHED {
            break;
        }
    }
    if let Some((_, q, balls)) = best {
        (state.q, state.balls) = (q, balls);
    }
    for c in &turns {
        // The same angle within half a turn of the design configuration.
        let turn = std::f64::consts::TAU;
        state.q[c.0] -= turn * (state.q[c.0] / turn).round();
    }
    state.place(topology, parts, std::iter::once(k));
}

/// Corrects the coordinates of a link by Gauss-Newton steps; returns the remaining error, rad and sizes.
fn approach(
    state: &mut State<f64>,
    topology: &Topology,
    parts: &PlanGeometry<f64>,
    (k, free): (LinkId, &[CoordinateId]),
    (target, size): (Pose, f64),
) -> f64 {
    let link = &topology[k];
    let mut error = f64::INFINITY;
    for _ in 0..MOST_CORRECTIONS {
        state.place(topology, parts, std::iter::once(k));
        let frame = state.frame[link.child.0];
        // e = (log R* R^T, r* - r),  lengths in sizes
        let turn = Quat::from_rotation(target.rot * frame.rot.transpose()).rotation_vector();
        let way = (target.r - frame.r) * (1.0 / size);
        let now = (turn.dot(turn) + way.dot(way)).sqrt();
        // The best that these freedoms reach, or round-off.
        if !(now < error * (1.0 - DAMPING)) && error < f64::INFINITY && now <= REACHED {
            return now;
        }
        error = now;
        let n = free.len();
        if n == 0 {
            return error;
        }
        let columns: Vec<[Vec3; 2]> = (free.iter())
            .map(|c| {
                let (x, unit) = (state.x[0][c.0], if topology[*c].is_length { size } else { 1.0 });
                [x.w * unit, x.at(frame.r) * (unit / size)]
            })
            .collect();
        let mut normal = Elimination::new(n);
        let mut step = vec![0.0; n];
        for (i, a) in columns.iter().enumerate() {
            for (j, b) in columns.iter().enumerate() {
                // (J^T J + damping I) dq = J^T e
                normal.row_mut(i)[j] = a[0].dot(b[0]) + a[1].dot(b[1]) + if i == j { DAMPING } else { 0.0 };
            }
            step[i] = a[0].dot(turn) + a[1].dot(way);
        }
        normal.factor();
        normal.solve(&mut step);
        let longest = step.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let shorter = if longest > LONGEST { LONGEST / longest } else { 1.0 };
        for (c, step) in free.iter().zip(&step) {
            state.q[c.0] += shorter * step * if topology[*c].is_length { size } else { 1.0 };
        }
        state.turn_balls(topology, std::iter::once(k));
    }
    error
}

/// Placements of all bodies in the assembly of a design; `None` if it does not assemble.
pub(crate) fn placements_of(one: &mut Stepper<'_>) -> Option<Vec<StartPlacement>> {
    assemble(one).ok()?;
    Some(placements(&one.mechanism))
}

/// Placements in the other assemblies of the nominal design, the nearest first. Those that a model does not reach from
/// its own placements again are left out.
pub(crate) fn other_assemblies(
    model: &Model,
    topology: &Topology,
    more: &dyn Fn() -> bool,
) -> Vec<Vec<StartPlacement>> {
    let (design, laws) = (model.geometry(&[]), model.laws(&[]));
    let parts = || PlanGeometry::same(model, topology, &design, &laws);
    let mut one = Stepper::new(model, topology, parts());
    if assemble(&mut one).is_err() {
        return Vec::new();
    }
    let mut found = assembly::other_assemblies(&mut one.mechanism, more);
    found.retain(|placements| {
        let model = model.starting_at(placements);
        let topology = Topology { start: start_coordinates(&model, topology), ..topology.clone() };
        let again = placements_of(&mut Stepper::new(&model, &topology, parts()));
        again.is_some_and(|again| is_same(&model, placements, &again))
    });
    found
}

/// True if bodies are placed alike.
fn is_same(model: &Model, a: &[StartPlacement], b: &[StartPlacement]) -> bool {
    let (near, size) = (SAME * model.size(), model.size());
    a.len() == b.len()
        && a.iter().zip(b).all(|(a, b)| {
            let frame = model.bodies[a.body.0].frame;
            let points = [Vec3::ZERO].into_iter().chain(number::each(&Vec3::AXES, |axis| axis * size));
            let apart = |s: Vec3| {
                let p = frame.point(s);
                (a.displacement.point(p) - b.displacement.point(p)).norm()
            };
            a.body == b.body && points.map(apart).all(|apart| apart <= near)
        })
}
