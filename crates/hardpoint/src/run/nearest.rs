//! Nearest admissible change: the requested change plus the smallest further change that keeps the joints closed.

use std::ops::ControlFlow;

use super::sink::NullSink;
use super::walk::{PerPlan, SolvedSteps};
use super::{Analysis, Walk};
use crate::linalg::{FullPivot, least_squares};
use crate::model::{Change, End, Model, VariableId};
use crate::sensitivity::{DirectDifferentiation, PlanVelocity, conditions_at_design};
use crate::space::Vec3;

/// Maximum number of output times, evenly spaced, at which conditions of the motion are taken.
const TIMES: usize = 24;
/// A condition is met if its defect is below this fraction of the defect of the strongest condition under the largest
/// change: about a hundred times the round-off of typed coordinates.
const MET: f64 = 1e-7;
/// Weight of a requested variable relative to the others: its value is kept as long as other variables can compensate.
const REQUESTED_WEIGHT: f64 = 1e-9;

/// Admissible change near a requested one.
#[derive(Clone, Debug, PartialEq)]
pub struct NearestAdmissible {
    /// Change of every variable, m, rad, or plain.
    pub change: Vec<f64>,
    /// Number of independent conditions.
    pub conditions: usize,
    /// Largest defects of the requested change and of this one, in units of the mechanism's size or rad.
    pub defects: [f64; 2],
}

/// Returns the change nearest to `change` that keeps all joints closed with all bodies fixed (section 4 of the paper)
/// and satisfies the conditions of redundant constraints over the motion, to first order.
///
/// It is the least-squares projection onto the null space of these conditions. The projection uses the requested
/// variables and all others of the model that move one coordinate of a hardpoint or tilt one joint
/// (`add_coordinates` and `add_tilts` of `hardpoint-study`), each scaled by its
/// [natural step](crate::model::Model::natural_step). Requested values are kept as long as other variables can
/// compensate.
pub fn nearest_admissible(analysis: &Analysis<'_>, change: &[f64]) -> NearestAdmissible {
    let model = analysis.model();
    let change = model.whole(change);
    let scales: Vec<f64> = (0..change.len()).map(|v| model.natural_step(VariableId(v))).collect();
    let requested: Vec<f64> = change.iter().zip(&scales).map(|(x, scale)| x / scale).collect();
    let weight: Vec<f64> = (0..requested.len()).map(|v| weight(model, &requested, v)).collect();
    let mut rows = conditions(analysis, &scales);
    // Variables that do not move open no joint.
    // A_kv = d(defect k)/d(b_v) natural_v / unit_k, 0 for fixed variables
    rows.iter_mut()
        .for_each(|row| row.iter_mut().zip(&weight).filter(|x| *x.1 == 0.0).for_each(|x| *x.0 = 0.0));
    rows.retain(|row| row.iter().any(|x| x.abs() > MET));
    let defect = |x: &[f64]| rows.iter().map(|r| dot(r, x).abs()).fold(0.0, f64::max);
    let independent = FullPivot::of(rows.clone(), change.len(), MET).rows;
    let a: Vec<&Vec<f64>> = independent.iter().map(|&r| &rows[r]).collect();
    let mut found = requested.clone();
    if !a.is_empty() {
        // d = x - B (A B)^+ A x    with W = B B: smallest correction in the metric W^-1
        // min (d - x)^T W^-1 (d - x)  with  A d = 0,  x the requested change                                 (35)
        let b: Vec<f64> = weight.iter().map(|w| w.sqrt()).collect();
        let right = a.iter().map(|row| dot(row, &requested)).collect();
        let least = least_squares([a.len(), b.len()], |i, v| a[i][v] * b[v], &[right]).remove(0);
        for ((x, b), y) in found.iter_mut().zip(&b).zip(least) {
            *x -= b * y;
        }
        if !found.iter().all(|x| x.is_finite()) {
            found.clone_from(&requested);
        }
    }
    let largest = found.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let cleaned = |(x, scale): (&f64, &f64)| if x.abs() > MET * largest { x * scale } else { 0.0 };
    NearestAdmissible {
        change: found.iter().zip(&scales).map(cleaned).collect(),
        conditions: a.len(),
        defects: [defect(&requested), defect(&found)],
    }
}

/// Mobility of a variable: its entry of W in (35).
fn weight(model: &Model, requested: &[f64], v: usize) -> f64 {
    if requested[v] != 0.0 {
        return REQUESTED_WEIGHT;
    }
    let variable = &model.variables[v];
    let is_axis = |u: Vec3| Vec3::AXES.contains(&u);
    let is_simple = match variable.changes.as_slice() {
        [Change::Move(change)] => is_axis(change.velocity),
        [Change::Marker(change)] => {
            change.end == End::Both && change.position == Vec3::ZERO && is_axis(change.rotation)
        }
        _ => false,
    };
    // Of two variables with the same effect, one would undo the requested change of the other.
    let same = |k: &usize| model.variables[*k].changes == variable.changes;
    let is_double = (0..requested.len()).filter(same).any(|k| k < v || requested[k] != 0.0);
    if is_simple && !variable.fixed_length && !is_double { 1.0 } else { 0.0 }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// One row per condition: its defect per natural step of every variable; lengths relative to the size of the mechanism.
fn conditions(analysis: &Analysis<'_>, scales: &[f64]) -> Vec<Vec<f64>> {
    let model = analysis.model();
    let (variables, size) = (scales.len(), model.size());
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let fields = model.fields(&[]);
    // Identified by joint, constraint and repetition within the joint: a coupler may have the same constraint more than
    // once.
    let mut keys = Vec::new();
    for (v, field) in fields.iter().enumerate() {
        let mut seen = Vec::new();
        for c in conditions_at_design(model, field) {
            let repeat = seen.iter().filter(|k| **k == (c.joint, c.row)).count();
            seen.push((c.joint, c.row));
            let key = (c.joint, c.row, repeat);
            let at = keys.iter().position(|k| *k == key).unwrap_or_else(|| {
                keys.push(key);
                rows.push(vec![0.0; variables]);
                keys.len() - 1
            });
            let unit = if c.row.is_length() { size } else { 1.0 };
            // l . (z_j - z_i) - L' in the design configuration                                                 (32)
            rows[at][v] = c.value * scales[v] / unit;
        }
    }
    let design = analysis.design(&[]);
    let mut walk = Walk::new(analysis, &design, vec![false; model.bodies.len()]);
    let mut done = 0;
    let every = model.times.len().div_ceil(TIMES).max(1);
    let topology = analysis.topology();
    let mut workspaces = PerPlan::new(analysis, &design, |plan| {
        let topology = plan.analysis.topology();
        let parts: Vec<_> = fields.iter().map(|f| PlanVelocity::new(topology, f)).collect();
        (DirectDifferentiation::new(model, topology), parts)
    });
    if topology.redundant().next().is_some() {
        // A motion that stops early contributes fewer conditions.
        let _ = walk.all(&mut NullSink, &mut |_| ControlFlow::Continue(()), |_, solved, _, _| {
            let SolvedSteps::One(plan, one, ..) = solved else { return };
            let mechanism = &mut one.mechanism;
            let (direct, parts) = workspaces.on(plan);
            if done % every == 0 {
                mechanism.state.finish_wrenches(&mechanism.topology);
                let first = rows.len();
                let mut numbers = Vec::new();
                for (v, field) in parts.iter_mut().enumerate() {
                    field.set_time(|d| mechanism.parts.law_of(d.0), model.times[done]);
                    direct.solve_position(&mechanism.topology, &mut mechanism.state, field);
                    for (r, value) in direct.defects(&mechanism.topology, &mechanism.state, field) {
                        let at = numbers.iter().position(|n| *n == r).unwrap_or_else(|| {
                            numbers.push(r);
                            rows.push(vec![0.0; variables]);
                            numbers.len() - 1
                        });
                        let unit = if topology.constraint(r).is_length() { size } else { 1.0 };
                        // l . (D_j - D_i) - L' of a left-out row at this output time                               (11)
                        rows[first + at][v] = value * scales[v] / unit;
                    }
                }
            }
            done += 1;
        });
    }
    rows
}
