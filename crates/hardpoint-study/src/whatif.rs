//! What-if study: changed designs, predicted from the derivatives of the nominal design and solved exactly.
//!
//! Input: a change of every variable, m, rad or plain. Output: a [`WhatIf`] with the curves
//! `y + y_b d + d y_bb d / 2` and the exact ones, SI (`docs/theory.md`, section 7).

use hardpoint::joint::Quantity;
use hardpoint::model::{DesignVariable, Dimension, End, HardpointId, JointId, Model, VariableId, change};
use hardpoint::run::{Analysis, Run, Solution};
use hardpoint::sensitivity::{Admissibility, JointDefect};
use hardpoint::space::Vec3;

use super::validity::linear_up_to;
use hardpoint::run::SecondDerivatives;
use hardpoint_difference::Magnitude;

/// Changed design: nominal, predicted and exact curves.
#[derive(Clone, Debug)]
pub struct WhatIf {
    /// Change of every variable, m, rad, or plain.
    pub change: Vec<f64>,
    /// Solution of the nominal design, with its sensitivities.
    pub today: Solution,
    /// The changed design, re-solved.
    pub exact: Solution,
    /// Second derivatives of the curves along the change.
    bend: SecondDerivatives,
    /// Change divided by a natural step, for the variable with the largest such ratio.
    part: f64,
    /// Magnitude of the nominal motion.
    magnitude: Magnitude,
    /// Joints that the change opens in the design configuration, so that the mechanism has to be re-assembled; empty if
    /// the change as a whole is admissible.
    pub opens: Vec<JointDefect>,
    /// Changed variables that the mechanism cannot follow, not even in combination. Nothing is predicted if there are
    /// any.
    pub cannot_follow: Vec<VariableId>,
}

/// Quality of the prediction of one output.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PredictionQuality {
    /// Largest exact change over the motion, and the index of its output time.
    pub change: (f64, usize),
    /// Largest errors of the first-order and of the second-order prediction, of the output times that have one; `None`
    /// if there is none. Outputs that depend on positions alone have the latter
    /// ([`KnownOrders::by_position`](hardpoint::model::KnownOrders::by_position)).
    pub errors: [Option<f64>; 2],
    /// Number of output times at which the change is known and a prediction is not, since there are no derivatives.
    pub unpredicted: usize,
    /// Factor by which the change can be scaled before its second-order part reaches 5 % of its first-order part;
    /// infinite if it is exactly linear, `None` if the first-order part is round-off or the second-order part is
    /// unknown.
    pub linear_up_to: Option<f64>,
}

/// Predicts and solves a changed design. `today` is the solution of the nominal design.
pub fn what_if(analysis: &Analysis<'_>, today: Solution, change: &[f64]) -> WhatIf {
    let model = analysis.model();
    let change = model.whole(change);
    let variables = (0..change.len()).map(VariableId).filter(|v| change[v.0] != 0.0);
    let direction: Vec<(VariableId, f64)> = variables.clone().map(|v| (v, change[v.0])).collect();
    let alone = |v: &VariableId| {
        let known = today.sensitivities.admissibility.get(v.0);
        matches!(known, Some(Admissibility::CannotFollow { .. }))
    };
    let resists = analysis.admissibility_of(&change);
    let cannot_follow = match resists {
        Admissibility::CannotFollow { .. } if variables.clone().any(|v| alone(&v)) => {
            variables.filter(alone).collect()
        }
        Admissibility::CannotFollow { .. } => variables.collect(),
        Admissibility::Admissible | Admissibility::Reassembled { .. } | Admissibility::Unknown => Vec::new(),
    };
    let field = analysis.design_map().field_along(&direction, &model.whole(&[]));
    let part = |(v, by): (usize, &f64)| by.abs() / model.natural_step(VariableId(v));
    WhatIf {
        part: change.iter().enumerate().map(part).fold(0.0, f64::max),
        exact: analysis.solve(Run::new().at(&change).without_sensitivities()),
        bend: analysis.second(&[], std::slice::from_ref(&change), &[[0, 0]]),
        magnitude: Magnitude::of_motion(model, &today.motion),
        opens: analysis.opens_along(&field),
        cannot_follow,
        change,
        today,
    }
}

impl WhatIf {
    /// Number of output times at which both designs were solved.
    pub fn len(&self) -> usize {
        self.today.measured.len().min(self.exact.measured.len())
    }

    /// True if there are no common output times.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// First-order change of the value of output m at time k.
    pub fn first(&self, k: usize, m: usize) -> f64 {
        if self.today.measured.outputs[m].known.by_position {
            return self.bend.first(k, 0, m);
        }
        let changed = self.change.iter().enumerate().filter(|(_, d)| **d != 0.0);
        changed.map(|(v, d)| d * self.today.measured.d(k, VariableId(v), m)[0]).sum()
    }

    /// Second-order part of the change of the value of output m at time k.
    pub fn second(&self, k: usize, m: usize) -> f64 {
        0.5 * self.bend.value(k, 0, m)
    }

    /// Value of output m at time k, predicted to first and to second order.
    pub fn predicted(&self, k: usize, m: usize) -> [f64; 2] {
        // y + y_b . d,    y + y_b . d + d . y_bb d / 2
        let linear = self.today.measured.value(k, m)[0] + self.first(k, m);
        [linear, linear + self.second(k, m)]
    }

    /// Exact value of output m at time k. An angle over several turns is counted through the same turns as in the
    /// nominal design.
    pub fn exact(&self, k: usize, m: usize) -> f64 {
        unwrapped_value(&self.today, &self.exact, k, m)
    }

    /// Exact change of the value of output m at time k; 0 if it is round-off.
    pub fn exact_change(&self, k: usize, m: usize) -> f64 {
        self.settled(self.exact(k, m) - self.today.measured.value(k, m)[0], k, m)
    }

    /// Difference of two values of output m at time k; 0 if it is round-off.
    fn settled(&self, by: f64, k: usize, m: usize) -> f64 {
        let measured = &self.today.measured;
        let dimension = measured.outputs[m].dimension;
        let round_off = self.magnitude.value_round_off(dimension, measured.value(k, m)[0]);
        if by.abs() <= round_off { 0.0 } else { by }
    }

    /// Quality of the prediction of output m over the motion; `None` if nothing was predicted or solved.
    pub fn prediction_quality(&self, m: usize) -> Option<PredictionQuality> {
        if self.is_empty() || !self.cannot_follow.is_empty() {
            return None;
        }
        let bends = self.today.measured.outputs[m].known.by_position;
        let orders = if bends { 2 } else { 1 };
        let (mut errors, mut unpredicted) = ([None::<f64>; 2], 0);
        let (mut change, mut first, mut second) = ((0.0_f64, 0), 0.0_f64, 0.0_f64);
        for k in 0..self.len() {
            let exact = self.exact(k, m);
            let now = self.exact_change(k, m);
            if now.is_nan() {
                continue;
            }
            if now.abs() > change.0.abs() {
                change = (now, k);
            }
            let off = self.predicted(k, m).map(|predicted| self.settled(predicted - exact, k, m).abs());
            if off[..orders].iter().any(|off| off.is_nan()) {
                unpredicted += 1;
                continue;
            }
            for (most, off) in errors.iter_mut().zip(&off[..orders]) {
                *most = Some(most.map_or(*off, |most| most.max(*off)));
            }
            (first, second) = (first.max(self.first(k, m).abs()), second.max(self.second(k, m).abs()));
        }
        let natural = |first: f64, second: f64| {
            // The first-order part scales with the change, the second-order part with its square.
            linear_up_to(first / self.part, second / (self.part * self.part)) / self.part
        };
        let round_off = self.magnitude.round_off(self.today.measured.outputs[m].dimension, 0) * self.part;
        let linear_up_to = (bends && first > round_off).then(|| natural(first, second));
        Some(PredictionQuality { change, errors, unpredicted, linear_up_to })
    }
}

/// Value of output m at time k of another design. An angle over several turns is counted through the same turns as in
/// the nominal design.
pub fn unwrapped_value(today: &Solution, other: &Solution, k: usize, m: usize) -> f64 {
    const TURN: f64 = 2.0 * std::f64::consts::PI;
    let [x, now] = [other, today].map(|s| s.measured.value(k, m)[0]);
    match today.measured.outputs[m].dimension {
        Dimension::ANGLE => x - TURN * ((x - now) / TURN).round(),
        _ => x,
    }
}

/// Variable with a name: one of the model's, or else `HARDPOINT.x`, `.y`, `.z`, or `JOINT.tilt_x`, `.tilt_y`, `.tilt_z`
/// (about a global axis through the joint's point), which is added to the model. If a variable of the model is already
/// that coordinate, it is returned instead.
pub fn variable_named(model: &mut Model, name: &str) -> Option<VariableId> {
    if let Some(known) = model.variable(name) {
        return Some(known);
    }
    let (what, part) = name.rsplit_once('.')?;
    let axis = |letter: &str| ["x", "y", "z"].iter().position(|l| *l == letter);
    let (quantity, change) = if let Some(axis) = axis(part) {
        let hardpoint = HardpointId(model.hardpoints.iter().position(|h| !h.unnamed && h.name == what)?);
        let same = |v: &DesignVariable| coordinate_of(v) == Some((hardpoint, axis, 1.0));
        if let Some(known) = model.variables.iter().position(same) {
            return Some(VariableId(known));
        }
        (Quantity::Length, change::Move { hardpoint, velocity: Vec3::AXES[axis] }.into())
    } else {
        let axis = axis(part.strip_prefix("tilt_")?)?;
        let joint = model.joints.iter().position(|j| !j.unnamed && j.name == what)?;
        let rotation = Vec3::AXES[axis];
        let (joint, position) = (JointId(joint), Vec3::ZERO);
        (Quantity::Angle, change::Marker { joint, end: End::Both, position, rotation }.into())
    };
    model.variables.push(DesignVariable {
        name: name.into(),
        quantity,
        changes: vec![change],
        fixed_length: false,
        bounds: None,
        typical: None,
        tolerance: None,
    });
    Some(VariableId(model.variables.len() - 1))
}

/// Coordinate of a variable that moves one hardpoint along one global axis and nothing else, with the change of the
/// coordinate per unit of the variable; -1 if the variable points against the axis.
fn coordinate_of(variable: &DesignVariable) -> Option<(HardpointId, usize, f64)> {
    let (hardpoint, _) = variable.changes.first()?.hardpoint()?;
    let mut velocity = Vec3::ZERO;
    for change in &variable.changes {
        velocity += change.hardpoint().filter(|(moved, _)| *moved == hardpoint)?.1;
    }
    let part = |axis: usize| velocity.dot(Vec3::AXES[axis]);
    let mut along = (0..3).filter(|axis| part(*axis) != 0.0);
    let axis = along.next().filter(|_| along.next().is_none() && !variable.fixed_length)?;
    Some((hardpoint, axis, part(axis)))
}

/// Variable that is a coordinate of a hardpoint, with the change of the coordinate per unit of the variable: 1 or -1
/// for a variable that is exactly that coordinate.
pub fn coordinate(model: &Model, hardpoint: HardpointId, axis: usize) -> Option<(VariableId, f64)> {
    let of = |(k, v): (usize, &DesignVariable)| {
        coordinate_of(v)
            .filter(|(h, a, _)| (*h, *a) == (hardpoint, axis))
            .map(|(_, _, by)| (VariableId(k), by))
    };
    model.variables.iter().enumerate().find_map(of)
}

/// True if a variable is a coordinate of a hardpoint, named after the hardpoint, and an earlier variable is the same
/// coordinate up to sign and unit.
pub fn repeats_coordinate(model: &Model, variable: VariableId) -> bool {
    let own = &model.variables[variable.0];
    let Some((hardpoint, axis, _)) = coordinate_of(own) else { return false };
    let same = |v: &DesignVariable| coordinate_of(v).is_some_and(|(h, a, _)| (h, a) == (hardpoint, axis));
    let name = format!("{}.{}", model.hardpoints[hardpoint.0].name, ["x", "y", "z"][axis]);
    own.name == name && model.variables[..variable.0].iter().any(same)
}

/// Adds a variable to the model for every coordinate of its hardpoints that has none.
pub fn add_coordinates(model: &mut Model) {
    for h in (0..model.hardpoints.len()).filter(|h| !model.hardpoints[*h].unnamed).collect::<Vec<_>>() {
        for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
            let known =
                |v: &DesignVariable| coordinate_of(v).is_some_and(|(of, a, _)| (of.0, a) == (h, axis));
            if !model.variables.iter().any(known) {
                variable_named(model, &format!("{}.{letter}", model.hardpoints[h].name));
            }
        }
    }
}

/// Adds variables to the model that tilt each joint with an axis, unless variables of these names exist.
pub fn add_tilts(model: &mut Model) {
    let tilts: Vec<String> = model
        .joints
        .iter()
        .filter(|j| !j.unnamed && j.axis.is_some())
        .flat_map(|j| ["x", "y", "z"].map(|axis| format!("{}.tilt_{axis}", j.name)))
        .collect();
    for name in &tilts {
        variable_named(model, name);
    }
}

/// All names that [`variable_named`] accepts for a model.
pub fn variable_names(model: &Model) -> Vec<String> {
    let mut names: Vec<String> = model.variables.iter().map(|v| v.name.clone()).collect();
    for h in model.hardpoints.iter().filter(|h| !h.unnamed) {
        names.extend(["x", "y", "z"].map(|axis| format!("{}.{axis}", h.name)));
    }
    for j in model.joints.iter().filter(|j| !j.unnamed) {
        names.extend(["x", "y", "z"].map(|axis| format!("{}.tilt_{axis}", j.name)));
    }
    names
}
