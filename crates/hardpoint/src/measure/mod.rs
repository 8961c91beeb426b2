//! Measures and followed points: numbers that a person asks for, with rates and sensitivities.
//!
//! A measure is written once, over any [`Real`]; its rate, acceleration and the design derivatives of all three follow by
//! the product and chain rules where it runs on [`Jet`]s.

mod bodies;
mod wheel;

use std::collections::BTreeMap;

use bodies::{with_rates, with_sensitivity};
use wheel::{WheelAt, camber, toe};

use crate::constraint::Row;
use crate::joint::Quantity;
use crate::law::Law;
use crate::model::{
    BodyId, DriverId, Effects, Fixed, JointId, Measure, MeasureKind, Model, PointId, Side, VariableId,
    WheelId,
};
use crate::motion::Motion;
use crate::sensitivity::Sensitivities;
use crate::space::{Dual, Jet, Pose, Rates, Real, Vec3};
use crate::topology::Topology;

/// A column of [`Measured`].
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// `toe` for a measure, `wheel_centre.z` for a point's component.
    pub name: String,
    /// What its value measures.
    pub quantity: Quantity,
    /// Where it comes from.
    pub source: OutputSource,
}

/// Where an output comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputSource {
    /// A measure of the model.
    Measure(usize),
    /// Component 0, 1 or 2 of a point of the model.
    Point(PointId, usize),
}

/// Measures and point components over a motion, with their sensitivities.
#[derive(Clone, Debug, Default)]
pub struct Measured {
    /// The columns: all measures, then x, y, z of all named points.
    pub outputs: Vec<Output>,
    /// How many design variables there are.
    pub variables: usize,
    /// `values[k * outputs + m]`: value, rate and acceleration; m or rad, per s, per s^2.
    values: Vec<[f64; 3]>,
    /// `d[(k * variables + b) * outputs + m]`: derivatives of those by variable b at fixed t.
    d: Vec<[f64; 3]>,
}

impl Measured {
    /// The column of that name.
    pub fn index(&self, name: &str) -> Option<usize> {
        self.outputs.iter().position(|o| o.name == name)
    }

    /// Value, rate and acceleration of output m at time k.
    pub fn value(&self, k: usize, m: usize) -> [f64; 3] {
        self.values[k * self.outputs.len() + m]
    }

    /// Their derivatives by variable b; those of a variable that the mechanism cannot follow are NaN and
    /// mean nothing: ask [`Sensitivities::admissibility`] first.
    pub fn d(&self, k: usize, b: VariableId, m: usize) -> [f64; 3] {
        self.d[(k * self.variables + b.0) * self.outputs.len() + m]
    }

    /// How many output times there are.
    pub fn len(&self) -> usize {
        if self.outputs.is_empty() { 0 } else { self.values.len() / self.outputs.len() }
    }

    /// Whether there is nothing.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// The columns that a model's measures and points give.
pub fn outputs(model: &Model) -> Vec<Output> {
    let measures = model.measures.iter().enumerate().map(|(k, m)| Output {
        name: m.name.clone(),
        quantity: model.measured(m),
        source: OutputSource::Measure(k),
    });
    let points = model.points.iter().enumerate().filter(|(_, p)| !p.unnamed).flat_map(|(k, p)| {
        ["x", "y", "z"].into_iter().enumerate().map(move |(axis, letter)| Output {
            name: format!("{}.{letter}", p.name),
            quantity: Quantity::Length,
            source: OutputSource::Point(PointId(k), axis),
        })
    });
    measures.chain(points).collect()
}

/// The design whose motion is measured.
pub(crate) struct At<'a> {
    pub model: &'a Model,
    pub effects: &'a Effects<'a>,
    /// The variables' values.
    pub values: &'a [f64],
    /// The drivers' laws.
    pub laws: &'a [Law],
}

/// Evaluates all outputs over a motion, and their derivatives by the variables that it has sensitivities for.
pub(crate) fn evaluate(
    design: &At<'_>,
    topology: &Topology,
    motion: &Motion,
    sensitivities: &Sensitivities,
) -> Measured {
    let &At { model, effects, values, laws } = design;
    let outputs = outputs(model);
    let mut measured = Measured { variables: sensitivities.variables, ..Measured::default() };
    let turns = turns(model, topology, &outputs);
    let bodies = bodies_asked_for(model);

    let zero = Rates([0.0; 3]);
    let lifted: Vec<Rates> = values.iter().map(|v| zero.like(*v)).collect();
    let fixed = effects.fixed(&lifted, zero);
    let mut poses = vec![Pose::IDENTITY.spread(zero); model.bodies.len()];
    for k in 0..motion.len() {
        let first = measured.values.len();
        let states = motion.at(k);
        bodies.iter().for_each(|&b| poses[b] = with_rates(&states[b]));
        Moment { model, fixed: &fixed, poses: &poses }.all(|x| measured.values.push(x.0));
        unwrap_angles(laws, topology, motion, k, &turns, &mut measured.values, first);
    }

    measured.d = derivatives(design, &outputs, motion, sensitivities);
    measured.outputs = outputs;
    measured
}

/// Derivatives of some outputs by the variables, `[(k * variables + b) * outputs + m]`.
///
/// Variable by variable, so that what is fixed in the bodies is worked out once for each.
pub(crate) fn derivatives(
    design: &At<'_>,
    outputs: &[Output],
    motion: &Motion,
    sensitivities: &Sensitivities,
) -> Vec<[f64; 3]> {
    let &At { model, effects, values, .. } = design;
    let (bodies, zero) = (bodies_asked_for(model), Rates([0.0; 3]));
    let (steps, variables, columns) = (motion.len(), sensitivities.variables, outputs.len());
    let mut found = vec![[f64::NAN; 3]; steps * variables * columns];
    let mut poses = vec![Pose::IDENTITY.spread(Dual::constant(zero)); model.bodies.len()];
    let mut lifted: Vec<Jet> = values.iter().map(|v| Dual::constant(zero.like(*v))).collect();
    for b in 0..variables {
        lifted[b] = Dual::variable(lifted[b].v);
        let fixed = effects.fixed(&lifted, Dual::constant(zero));
        lifted[b] = Dual::constant(lifted[b].v);
        for k in 0..steps {
            let Some(d) = sensitivities.at(k, b) else { break };
            let states = motion.at(k);
            bodies.iter().for_each(|&b| poses[b] = with_sensitivity(&states[b], &d[b]));
            let moment = Moment { model, fixed: &fixed, poses: &poses };
            let first = (k * variables + b) * columns;
            for (found, output) in found[first..first + columns].iter_mut().zip(outputs) {
                *found = moment.output(output).d.0;
            }
        }
    }
    found
}

/// What tells how many whole turns a joint's angle has made.
enum Turns {
    /// The driver's law.
    Driver(DriverId),
    /// The tree coordinate, which is the angle itself.
    Coordinate(usize),
    /// For a cut joint: the turn before and the rates since.
    Rates,
}

/// The outputs that are joint angles, and what tells their turns.
fn turns(model: &Model, topology: &Topology, outputs: &[Output]) -> Vec<Option<Turns>> {
    let mut link_of = vec![None; model.joints.len()];
    for link in &topology.links {
        if let Some(j) = link.joint {
            link_of[j.0] = Some(link);
        }
    }
    let driver_of: BTreeMap<_, _> =
        model.drivers.iter().enumerate().map(|(k, d)| ((d.joint, d.coordinate), DriverId(k))).collect();
    let of_joint = |joint: JointId, coordinate: usize| {
        if let Some(&d) = driver_of.get(&(joint, coordinate)) {
            return Turns::Driver(d);
        }
        let freedom = model.joints[joint.0].kind.coordinates[coordinate].freedom;
        let Some((link, freedom)) = link_of[joint.0].zip(freedom) else { return Turns::Rates };
        let step = if link.parent_end == 0 { freedom } else { link.steps.len() - 1 - freedom };
        Turns::Coordinate(link.steps[step].first)
    };
    let of_output = |output: &Output| {
        let OutputSource::Measure(index) = output.source else { return None };
        let MeasureKind::Coordinate { joint, coordinate } = model.measures[index].kind else { return None };
        (output.quantity == Quantity::Angle).then(|| of_joint(joint, coordinate))
    };
    outputs.iter().map(of_output).collect()
}

/// Counts joint angles through whole turns.
fn unwrap_angles(
    laws: &[Law],
    topology: &Topology,
    motion: &Motion,
    k: usize,
    turns: &[Option<Turns>],
    values: &mut [[f64; 3]],
    first: usize,
) {
    const TURN: f64 = 2.0 * std::f64::consts::PI;
    for (m, turns_of) in turns.iter().enumerate() {
        let near = match turns_of {
            None => continue,
            Some(Turns::Driver(d)) => laws[d.0].at(motion.times[k]).value(),
            Some(Turns::Coordinate(q)) => motion.coordinates[k * topology.coordinates.len() + q],
            Some(Turns::Rates) if k > 0 => {
                let before = values[first - turns.len() + m];
                let h = motion.times[k] - motion.times[k - 1];
                before[0] + 0.5 * h * (before[1] + values[first + m][1])
            }
            Some(Turns::Rates) => 0.0,
        };
        let value = &mut values[first + m][0];
        *value += TURN * ((near - *value) / TURN).round();
    }
}

/// Everything that a measure can ask for at one time, as numbers that carry whatever derivatives are wanted.
pub(crate) struct Moment<'a, T> {
    pub model: &'a Model,
    pub fixed: &'a Fixed<T>,
    /// Per body: where it is. Only those that measures name count.
    pub poses: &'a [Pose<T>],
}

impl<T: Real> Moment<'_, T> {
    /// All outputs, in the order of [`outputs`].
    pub fn all(&self, mut out: impl FnMut(T)) {
        for (k, measure) in self.model.measures.iter().enumerate() {
            out(self.measure(k, measure));
        }
        for (k, _) in self.model.points.iter().enumerate().filter(|(_, p)| !p.unnamed) {
            let p = self.point(PointId(k));
            out(p.x);
            out(p.y);
            out(p.z);
        }
    }

    /// One output.
    #[inline(never)]
    pub fn output(&self, output: &Output) -> T {
        self.poses[0].r.x.within(
            #[inline(always)]
            || match output.source {
                OutputSource::Measure(k) => self.measure(k, &self.model.measures[k]),
                OutputSource::Point(p, axis) => self.point(p)[axis],
            },
        )
    }

    #[inline(always)]
    fn point(&self, p: PointId) -> Vec3<T> {
        self.poses[self.model.points[p.0].body.0].point(self.fixed.points[p.0])
    }

    /// Formulas and signs: `docs/measures.md`.
    #[inline(always)]
    fn measure(&self, k: usize, measure: &Measure) -> T {
        match measure.kind {
            MeasureKind::Coordinate { joint, coordinate } => self.coordinate(k, joint, coordinate),
            MeasureKind::Distance { from, to } => (self.point(to) - self.point(from)).norm(),
            MeasureKind::Coordinates { point, along } => {
                let p = self.point(point);
                along.spread(p.x).dot(p)
            }
            MeasureKind::Toe { body, .. } => {
                let e = self.spin_axis(k, body);
                toe(e, e.x.like(Side::Left.sign()))
            }
            MeasureKind::Camber { body, .. } => camber(self.spin_axis(k, body)),
            MeasureKind::Wheel { wheel, what } => {
                let now = self.wheel(k, wheel, |b| self.poses[b.0]);
                now.measure(what, || {
                    self.wheel(k, wheel, |b| self.model.bodies[b.0].frame.spread(now.radius))
                })
            }
        }
    }

    /// The wheel of measure k, with its bodies at these poses.
    fn wheel(&self, k: usize, wheel: WheelId, pose: impl Fn(BodyId) -> Pose<T>) -> WheelAt<T> {
        let wheel = &self.model.wheels[wheel.0];
        let point = |p: PointId| pose(self.model.points[p.0].body).point(self.fixed.points[p.0]);
        let centre = point(wheel.centre);
        WheelAt {
            centre,
            spin_axis: pose(wheel.body).rot * self.fixed.spin_axes[k].expect("a wheel has a spin axis"),
            radius: centre.x.like(wheel.radius),
            side: centre.x.like(wheel.side.sign()),
            kingpin: wheel.kingpin.map(|points| points.map(point)),
        }
    }

    #[inline(always)]
    fn spin_axis(&self, k: usize, body: BodyId) -> Vec3<T> {
        self.poses[body.0].rot * self.fixed.spin_axes[k].expect("a measure with a spin axis")
    }

    /// A joint's coordinate between its two markers, whether the joint is cut or not.
    #[inline(always)]
    fn coordinate(&self, k: usize, joint: JointId, coordinate: usize) -> T {
        let j = &self.model.joints[joint.0];
        let markers = self.fixed.markers[k].expect("a measure of a joint's coordinate");
        let axis = |end: usize, k: usize| self.poses[j.bodies[end].0].rot * markers[end].rot.cols[k];
        let origin = |end: usize| self.poses[j.bodies[end].0].point(markers[end].r);
        match j.kind.coordinates[coordinate].row {
            Row::Angle | Row::Heading => axis(0, 1).dot(axis(1, 0)).atan2(axis(0, 0).dot(axis(1, 0))),
            Row::AngleOnJ => axis(0, 2).dot(axis(1, 1)).atan2(axis(0, 2).dot(axis(1, 2))),
            Row::Dot2(k) => axis(0, k).dot(origin(1) - origin(0)),
            _ => (origin(1) - origin(0)).norm(),
        }
    }
}

/// The bodies that measures and named points are fixed in.
pub(crate) fn bodies_asked_for(model: &Model) -> Vec<usize> {
    let mut bodies: Vec<usize> = model.points.iter().map(|p| p.body.0).collect();
    for measure in &model.measures {
        match measure.kind {
            MeasureKind::Coordinate { joint, .. } => {
                bodies.extend(model.joints[joint.0].bodies.map(|b| b.0));
            }
            MeasureKind::Toe { body, .. } | MeasureKind::Camber { body, .. } => bodies.push(body.0),
            // Their bodies are those of points.
            MeasureKind::Distance { .. } | MeasureKind::Coordinates { .. } | MeasureKind::Wheel { .. } => {}
        }
    }
    bodies.sort_unstable();
    bodies.dedup();
    bodies
}
