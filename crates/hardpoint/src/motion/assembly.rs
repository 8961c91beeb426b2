//! Assembly of a mechanism whose joints are open in the design configuration.
//!
//! Lengths and points that do not fit leave gaps in the design configuration. The gaps are closed along a path: their
//! open fraction runs from 1 to 0 while every driver stays at zero, in steps that check for limits and branches like
//! those of any motion. So the mechanism closes on the branch of the design configuration, and an assembled one stays
//! unchanged. The path may end before the gaps are closed, as from a singular design configuration (bars in line). Then
//! the nominal design is also assembled from positions around it, by least squares, and the nearest assembly is taken.
//! If there is none, least squares give the smallest gaps.

use crate::joint::Freedom;
use crate::linalg::Elimination;
use crate::model::{BodyId, Contact, StartPlacement};
use crate::order::sort_by_number;
use crate::space::{Quat, Vec3};
use crate::topology::{BlockId, CoordinateId, LoopLink, RowId, RowTerm, Topology};

use super::gap::{Assembly, AssemblyShift, Closing, Gap, SINGULAR_DRAWING};
use super::mechanism::{AcceptedPosition, LOCKED, Mechanism, StepRejection};
use super::parts::PlanGeometry;
use super::path::Path;
use super::stepper::Stepper;
use super::walk::walk;
use super::{Stop, StopKind};

/// Gaps below this fraction of the mechanism's size (or, for a cosine, below this) are round-off.
const CLOSED: f64 = 1e-12;
/// Smallest reported gap: coordinates typed into a file agree to about this fraction of the size.
const REPORTED_GAP: f64 = 1e-7;
/// The least-squares search ends when a step reduces its sum of squares by less than this fraction.
const NO_BETTER: f64 = 1e-12;
/// Maximum number of steps of the search.
const MAX_SEARCH: usize = 200;
/// Scaled residual below which a search has found an assembly; Newton's method closes the rest.
const FOUND: f64 = 1e-7;
/// Assemblies, and distances from the design configuration, are equal if they differ by less than this, rad or sizes.
const ONE_ASSEMBLY: f64 = 1e-5;
/// Deviations from the design configuration at which searches start, rad or sizes; each is tried in [`DIRECTIONS`]
/// directions and their opposites.
const DEVIATIONS: [f64; 3] = [0.03, 0.2, 0.8];
const DIRECTIONS: usize = 3;
/// Largest dense system of a search, so that a failure is reported within seconds.
const LARGEST_SEARCH: usize = 150;

/// Number of positions from which other assemblies are searched for: this number divided by the square of the number of
/// unknowns, since a search solves that many equations ...
const SCATTERED_WORK: usize = 20_000;
/// ... and its limits. A dyad is found on its other side from half of them.
const SCATTERED: [usize; 2] = [24, 200];
/// Half the range of each quasi-coordinate of a ball: Cayley's increment of this size turns it by 152 deg.
const TURNED_OVER: f64 = 8.0;

/// Displacements of bodies from the design configuration below this, sizes or rad, are round-off of the solver.
const UNMOVED: f64 = 1e-10;

/// An assembly that was found around the design configuration.
struct FoundAssembly {
    /// Distance of the bodies from the design configuration, in sizes and rad.
    distance: f64,
    /// Side to which they moved; it decides between assemblies at the same distance.
    side: f64,
    q: Vec<f64>,
    balls: Vec<Quat<f64>>,
    contacts: Vec<Contact<f64>>,
}

impl FoundAssembly {
    /// Returns true if distance and side are the same.
    fn is_same(&self, other: &Self) -> bool {
        (self.distance - other.distance).abs() <= ONE_ASSEMBLY
            && (self.side - other.side).abs() <= ONE_ASSEMBLY
    }
}

/// Assembles a mechanism in its design configuration, with all drivers at zero, on its branch.
pub(super) fn assemble(one: &mut Stepper<'_>) -> Result<(), Box<Stop>> {
    // phi_0 at q = 0; round-off counts as closed.
    one.mechanism.measure_gaps();
    if !(one.mechanism.largest_gap() > CLOSED) {
        one.mechanism.state.gap.fill(0.0);
        return assemble_along_path(one);
    }
    let m = &one.mechanism;
    let drawn = (m.saved.clone(), m.topology.clone());
    // Gaps of the design configuration; those of a changed design at the start of another assembly are none of these.
    let reported = if m.topology.start.is_some() { f64::INFINITY } else { REPORTED_GAP };
    let gaps = gaps(m, |r| m.state.gap[r.0], reported);
    let [mut found_nearby, mut equally_near] = [0; 2];
    if let Err(stop) = assemble_along_path(one) {
        [found_nearby, equally_near] = match is_searched(&one.mechanism, &stop) {
            true => assemble_nearby(&mut one.mechanism, &drawn),
            false => [0; 2],
        };
        if found_nearby == 0 {
            return Err(stop);
        }
    }
    let m = &mut one.mechanism;
    if !gaps.is_empty() {
        one.assembly = Some(Assembly { gaps, moved: moved(m, REPORTED_GAP), found_nearby, equally_near });
    }
    m.state.gap.fill(0.0);
    m.state.gap_left = [0.0; 2];
    Ok(())
}

/// Closes the gaps along the path from the design configuration.
fn assemble_along_path(one: &mut Stepper<'_>) -> Result<(), Box<Stop>> {
    let m = &mut one.mechanism;
    m.saved.time = 0.0;
    // s = 0: phi - phi_0 = 0 holds in the design configuration; the signs of the determinants there define the branch.
    let drawn = m.solve_at(Path::Assembly, 0.0).and_then(|()| is_side_of_start(m));
    m.settle_branch();
    let is_open = m.largest_gap() > 0.0;
    // If the design configuration is singular, none of its gaps can be closed along the path.
    let of_assembly = |mut stop: Box<Stop>| {
        if is_open && !matches!(stop.kind, StopKind::Locked { .. }) {
            stop.kind = StopKind::DoesNotAssemble;
        }
        stop
    };
    let drawn = drawn.and_then(|()| m.examine_position());
    drawn.map_err(|r| of_assembly(one.stop(Path::Assembly, 0.0, r, false)))?;
    one.start_at(0.0);
    if !is_open {
        return Ok(());
    }
    // phi - (1 - s) phi_0 = 0 from s = 0 to 1
    walk(one, Path::Assembly, 1.0).map_err(of_assembly)
}

/// Rejects a changed design that is on the other side of a singular position where its assembly starts.
fn is_side_of_start(m: &Mechanism<'_>) -> Result<(), StepRejection> {
    let Some(start) = &m.topology.start else { return Ok(()) };
    let signs = BlockId::each(&m.state.pivots).zip(&start.signs);
    match signs.into_iter().find(|((_, (_, positive)), wanted)| positive != *wanted) {
        Some(((block, _), _)) => Err(StepRejection::Branch { block }),
        None => Ok(()),
    }
}

/// Returns true if an assembly is searched for around the design configuration: if that is singular, and the path
/// does not close the nominal design either. A changed design is on the branch of the nominal one, or does not
/// assemble.
fn is_searched(m: &Mechanism<'_>, stop: &Stop) -> bool {
    if matches!(
        stop.kind,
        StopKind::LawNotFinite { .. }
            | StopKind::LoadNotFinite { .. }
            | StopKind::FormulaNotFinite { .. }
            | StopKind::TooFar { .. }
            | StopKind::Interrupted
    ) || m.saved.time > SINGULAR_DRAWING
    {
        return false;
    }
    let (design, laws) = (m.model.geometry(&[]), m.model.laws(&[]));
    let parts = PlanGeometry::same(m.model, &m.topology, &design, &laws);
    let mut nominal = Stepper::new(m.model, &m.topology, parts);
    nominal.mechanism.measure_gaps();
    // With the same gaps it is the nominal design itself.
    nominal.mechanism.state.gap == m.state.gap || assemble_along_path(&mut nominal).is_err()
}

/// Assembles the mechanism from positions around the design configuration, and moves to the nearest assembly.
/// Returns the number of assemblies found, or 0, and the number of those that are as near as that one.
fn assemble_nearby(m: &mut Mechanism<'_>, drawn: &(AcceptedPosition, Topology)) -> [usize; 2] {
    let unknowns: Vec<CoordinateId> = m.topology.unknown_coordinates().collect();
    if unknowns.len() > LARGEST_SEARCH {
        return [0; 2];
    }
    let blocks = m.topology.block_ids();
    let rows: Vec<RowId> = blocks.flat_map(|b| m.topology.rows_of_block(b)).collect();
    let mut found: Vec<FoundAssembly> = Vec::new();
    for start in 0..DEVIATIONS.len() * DIRECTIONS * 2 {
        deviate(m, drawn, &unknowns, start);
        if !(search(m, &rows, &unknowns) <= FOUND) || !stand_assembled(m) {
            continue;
        }
        let assembly = found_assembly(m);
        if found.iter().all(|other| !other.is_same(&assembly)) {
            found.push(assembly);
        }
    }
    // The nearest assembly; on equal distance that on the positive side.
    let nearest = found.iter().map(|a| a.distance).fold(f64::INFINITY, f64::min) + ONE_ASSEMBLY;
    let near = || found.iter().filter(|a| a.distance <= nearest);
    let Some(taken) = near().max_by(|a, b| a.side.total_cmp(&b.side)) else {
        set_drawn(m, drawn);
        return [0; 2];
    };
    m.state.q.copy_from_slice(&taken.q);
    m.state.balls.copy_from_slice(&taken.balls);
    m.state.contacts.copy_from_slice(&taken.contacts);
    if stand_assembled(m) { [found.len(), near().count()] } else { [0; 2] }
}

/// Other assemblies of the mechanism at the position of the state, with all drivers at zero, the nearest first.
///
/// Least squares start from coordinates scattered over their whole range: angles over a turn, lengths over the size of
/// their loop to either side. Two assemblies of the same distance to the same side count as one.
pub(super) fn other_assemblies(m: &mut Mechanism<'_>, more: &dyn Fn() -> bool) -> Vec<Vec<StartPlacement>> {
    let unknowns: Vec<CoordinateId> = m.topology.unknown_coordinates().collect();
    if unknowns.is_empty() || unknowns.len() > LARGEST_SEARCH {
        return Vec::new();
    }
    let drawn = (m.saved.clone(), m.topology.clone());
    let blocks = m.topology.block_ids();
    let rows: Vec<RowId> = blocks.flat_map(|b| m.topology.rows_of_block(b)).collect();
    let mut found = vec![(found_assembly(m), Vec::new())];
    let starts = SCATTERED_WORK / (unknowns.len() * unknowns.len());
    for start in 0..starts.clamp(SCATTERED[0], SCATTERED[1]) {
        if !more() {
            break;
        }
        scatter(m, &drawn, &unknowns, start);
        if !(search(m, &rows, &unknowns) <= FOUND) || !stand_assembled(m) {
            continue;
        }
        let assembly = found_assembly(m);
        if found.iter().all(|(other, _)| !other.is_same(&assembly)) {
            found.push((assembly, placements(m)));
        }
    }
    set_drawn(m, &drawn);
    let mut others = found.split_off(1);
    let from = found[0].0.distance;
    sort_by_number(&mut others, |(found, _)| (found.distance - from).abs());
    others.into_iter().map(|(_, placements)| placements).collect()
}

/// Moves to coordinates anywhere in their range, the same for the same number.
fn scatter(
    m: &mut Mechanism<'_>,
    drawn: &(AcceptedPosition, Topology),
    unknowns: &[CoordinateId],
    start: usize,
) {
    set_drawn(m, drawn);
    for (k, &c) in unknowns.iter().enumerate() {
        // -1 to 1
        let part = 2.0 * unit_number((start * unknowns.len() + k) as u64) - 1.0;
        let is_ball = m.topology[m.topology[c].link]
            .steps
            .iter()
            .any(|step| step.freedom == Freedom::Ball && (step.first.0..step.first.0 + 3).contains(&c.0));
        let range = match (m.topology[c].is_length, is_ball) {
            (true, _) => m.topology[c].unit,
            (false, false) => std::f64::consts::PI,
            (false, true) => TURNED_OVER,
        };
        m.state.q[c.0] += range * part;
    }
    m.state.turn_balls(&m.topology, m.topology.link_ids());
    m.state.find_contacts(&m.topology, &m.parts, LOCKED);
}

/// Number between 0 and 1 for every index, without pattern (the mixing function of SplitMix64).
fn unit_number(index: u64) -> f64 {
    let mut z = (index + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// Returns to the design configuration, with its selected rows.
fn set_drawn(m: &mut Mechanism<'_>, (drawn, topology): &(AcceptedPosition, Topology)) {
    let blocks: Vec<BlockId> = m.topology.block_ids().collect();
    let changed = blocks.into_iter().filter(|b| m.topology[*b].selected != topology[*b].selected);
    let changed: Vec<BlockId> = changed.collect();
    m.topology.clone_from(topology);
    changed.into_iter().for_each(|b| m.renew_factors(b));
    let time = m.saved.time;
    m.saved.clone_from(drawn);
    // The path still ends where it ended.
    m.saved.time = time;
    m.restore();
}

/// Deviates from the design configuration, in one of several directions without symmetry.
fn deviate(
    m: &mut Mechanism<'_>,
    drawn: &(AcceptedPosition, Topology),
    unknowns: &[CoordinateId],
    start: usize,
) {
    set_drawn(m, drawn);
    let deviation = DEVIATIONS[start / (2 * DIRECTIONS)] * if start.is_multiple_of(2) { 1.0 } else { -1.0 };
    let direction = start / 2 % DIRECTIONS;
    for (k, &c) in unknowns.iter().enumerate() {
        // Multiples of the golden ratio are spread evenly and never repeat.
        let part = ((1 + k + direction * unknowns.len()) as f64 * 0.618_033_988_749_895).fract();
        // The first direction moves all coordinates alike, the others each to its own side.
        let part = if direction == 0 { 0.5 + 0.5 * part } else { 2.0 * part - 1.0 };
        m.state.q[c.0] += deviation * part * m.topology[c].unit;
    }
    m.state.turn_balls(&m.topology, m.topology.link_ids());
}

/// Closes the mechanism at the end of a search, with rows that are independent there; returns true if the position
/// is regular.
fn stand_assembled(m: &mut Mechanism<'_>) -> bool {
    m.saved.time = 1.0;
    if m.drive(Path::Assembly, 1.0).is_err() {
        return false;
    }
    m.state.stand(&m.topology, &m.parts);
    for (r, _) in RowId::each(&m.topology.rows) {
        m.state.l[0][r.0] = m.state.wrench_of(&m.topology, r);
    }
    m.branch.iter_mut().for_each(|branch| branch.try_others = f64::INFINITY);
    // The signs of the determinants define this branch, before and after the selection of rows.
    if m.reselect().is_err() || m.solve_within(f64::INFINITY).is_err() {
        return false;
    }
    m.settle_branch();
    for &r in &m.topology.coupler_terms {
        m.state.near[r.0] = m.state.coordinate_of_row(&m.topology, r)[0];
    }
    // A pivot that is zero within round-off of the search means bars in line: no motion is defined there.
    let regular = m.state.pivots.iter().all(|(ratio, _)| *ratio > FOUND);
    if !regular || m.examine_position().is_err() {
        return false;
    }
    m.save(1.0);
    true
}

/// Assembly at the current position, with its distance from the design configuration.
fn found_assembly(m: &Mechanism<'_>) -> FoundAssembly {
    let size = m.model.size();
    let (mut distance, mut side) = (0.0, 0.0);
    for (body, pose) in m.model.bodies.iter().zip(&m.state.pose).skip(1) {
        for at in Vec3::AXES {
            // Three points of each body, one size from its origin, with different weights for different sides.
            let moved = (pose.point(at * size) - body.frame.point(at * size)) * (1.0 / size);
            distance += moved.dot(moved);
            side += moved.x + 0.618_033_988_749_895 * moved.y + 0.381_966_011_250_105 * moved.z;
        }
    }
    FoundAssembly {
        distance: f64::sqrt(distance),
        side,
        q: m.state.q.clone(),
        balls: m.state.balls.clone(),
        contacts: m.state.contacts.clone(),
    }
}

/// Displacements of all bodies from the design configuration at the current position; those that have not moved are
/// left out.
pub(super) fn placements(m: &Mechanism<'_>) -> Vec<StartPlacement> {
    let size = m.model.size();
    let bodies = m.model.bodies.iter().enumerate().skip(1);
    let all = bodies.map(|(b, body)| StartPlacement::between(BodyId(b), body.frame, m.state.pose[b]));
    all.filter(|start| {
        let frame = m.model.bodies[start.body.0].frame;
        let moved = start.displacement.point(frame.r) - frame.r;
        moved.norm() > UNMOVED * size || start.turn().norm() > UNMOVED
    })
    .collect()
}

/// Gaps per joint, driver or coupler, from a value per row; those below `least` are left out.
fn gaps(m: &Mechanism<'_>, of_row: impl Fn(RowId) -> f64, least: f64) -> Vec<Gap> {
    let mut gaps: Vec<(Gap, f64)> = Vec::new();
    for (r, place) in RowId::each(&m.topology.rows).filter(|(_, p)| !p.is_term) {
        let closure = &m.topology[place.closure];
        let of = match (closure.driver, closure.coupler) {
            (Some(d), _) => Closing::Driver(d),
            (None, Some(c)) => Closing::Coupler(c),
            (None, None) => Closing::Joint(closure.joint),
        };
        let size = of_row(r);
        if !(size.abs() > least * place.unit) {
            continue;
        }
        let quantity = closure.rows[place.index].into();
        match gaps.iter_mut().find(|(g, _)| g.of == of && g.quantity == quantity) {
            // The norm over several open rows of a joint.
            Some((gap, _)) => gap.size = gap.size.hypot(size),
            None => gaps.push((Gap { of, size: size.abs(), quantity }, place.unit)),
        }
    }
    sort_by_number(&mut gaps, |(gap, unit)| -gap.size / unit);
    gaps.into_iter().map(|(gap, _)| gap).collect()
}

/// Displacements of the bodies relative to the design configuration.
fn moved(m: &Mechanism<'_>, least: f64) -> Vec<AssemblyShift> {
    let bodies = m.model.bodies.iter().enumerate().skip(1);
    let moved = bodies.map(|(b, body)| {
        let pose = &m.state.pose[b];
        AssemblyShift {
            body: BodyId(b),
            distance: (pose.r - body.frame.r).norm(),
            angle: pose.rot.angle_to(body.frame.rot),
        }
    });
    let size = m.model.size();
    moved.filter(|m| m.distance > least * size || m.angle > least).collect()
}

/// Smallest gaps that the joints can reach: least squares over the residuals of all rows of the block that could
/// not be closed, from the end of the path; for a singular design configuration also from positions around it.
pub(crate) fn least_gaps(m: &mut Mechanism<'_>, block: BlockId) -> Vec<Gap> {
    m.state.gap_left = [0.0; 2];
    m.restore();
    let (unknowns, rows) = (m.topology[block].unknowns.clone(), m.topology.rows_of_block(block));
    let is_singular = m.saved.time <= SINGULAR_DRAWING && unknowns.len() <= LARGEST_SEARCH;
    let starts = if is_singular { DEVIATIONS.len() * DIRECTIONS * 2 } else { 0 };
    let ended = (m.saved.clone(), m.topology.clone());
    let mut best: Option<(f64, Vec<Gap>)> = None;
    for start in [None].into_iter().chain((0..starts).map(Some)) {
        if let Some(start) = start {
            deviate(m, &ended, &unknowns, start);
        }
        search(m, &rows, &unknowns);
        let (residuals, _) = scaled_rows(m, &rows, &unknowns);
        let squares = residuals.iter().map(|r| r * r).sum::<f64>();
        // An improvement within round-off is ignored.
        if best.as_ref().is_none_or(|(least, _)| squares < (1.0 - ONE_ASSEMBLY) * least) {
            let of_row = |r: RowId| m.state.residual_of(&m.topology, &m.parts, &m.drivers, r);
            best = Some((squares, gaps(m, of_row, REPORTED_GAP)));
        }
    }
    best.map_or_else(Vec::new, |(_, gaps)| gaps)
}

/// Moves these unknowns to where the residuals of these rows are smallest, by least squares; returns the largest
/// scaled residual.
///
/// This is the Levenberg-Marquardt method for the scaled rows; it need not be fast.
fn search(m: &mut Mechanism<'_>, rows: &[RowId], unknowns: &[CoordinateId]) -> f64 {
    m.state.gap_left = [0.0; 2];
    let n = unknowns.len();
    let mut damping = 1e-3;
    let (mut residuals, mut jacobian) = scaled_rows(m, rows, unknowns);
    let squares = |r: &[f64]| r.iter().map(|x| x * x).sum::<f64>();
    for _ in 0..MAX_SEARCH {
        let mut normal = Elimination::new(n);
        let mut step = vec![0.0; n];
        for k in 0..n {
            for c in 0..n {
                let dot: f64 = jacobian.iter().map(|row| row[k] * row[c]).sum();
                // (J^T J + damping I) step = -J^T phi,  in units of rows and coordinates                       (36)
                normal.row_mut(k)[c] = dot + if k == c { damping } else { 0.0 };
            }
            step[k] = -jacobian.iter().zip(&residuals).map(|(row, r)| row[k] * r).sum::<f64>();
        }
        normal.factor();
        normal.solve(&mut step);
        let before = (m.state.q.clone(), m.state.balls.clone(), m.state.contacts.clone());
        for (k, &c) in unknowns.iter().enumerate() {
            m.state.q[c.0] += step[k] * m.topology[c].unit;
        }
        m.state.turn_balls(&m.topology, m.topology.link_ids());
        let (now, jacobian_now) = scaled_rows(m, rows, unknowns);
        let (old, new) = (squares(&residuals), squares(&now));
        // A successful step reduces the damping (Gauss-Newton), another one increases it (gradient descent).
        if new < old {
            (residuals, jacobian) = (now, jacobian_now);
            damping *= 0.3;
            if old - new <= NO_BETTER * old {
                break;
            }
        } else {
            (m.state.q, m.state.balls, m.state.contacts) = before;
            damping *= 4.0;
            if damping > 1e12 {
                break;
            }
        }
    }
    residuals.iter().fold(0.0, |most: f64, r| if r.abs() <= most { most } else { r.abs() })
}

/// Scaled residuals of constraint rows, and their derivatives by these coordinates.
fn scaled_rows(
    m: &mut Mechanism<'_>,
    rows: &[RowId],
    unknowns: &[CoordinateId],
) -> (Vec<f64>, Vec<Vec<f64>>) {
    m.state.stand(&m.topology, &m.parts);
    let mut residuals = Vec::new();
    let mut jacobian = Vec::new();
    for &r in rows {
        let s = &m.state;
        let scale = 1.0 / m.topology[r].unit;
        residuals.push(scale * s.residual_of(&m.topology, &m.parts, &m.drivers, r));
        let mut by_coordinate = std::collections::BTreeMap::new();
        for RowTerm { row, factor } in m.topology.parts_of_row(r) {
            let wrench = s.wrench_of(&m.topology, row);
            for &LoopLink { link, side } in &m.topology.closure_of(row).links {
                for c in m.topology[link].coordinates() {
                    let unit = m.topology[c].unit;
                    // J_ra = +- c_k l_k . x_a                                                                   (6)
                    *by_coordinate.entry(c).or_insert(0.0) +=
                        scale * unit * side * factor * wrench.on(s.x[0][c.0]);
                }
            }
        }
        jacobian.push(unknowns.iter().map(|c| by_coordinate.get(c).copied().unwrap_or(0.0)).collect());
    }
    (residuals, jacobian)
}
