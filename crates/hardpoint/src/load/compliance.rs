//! Compliance of the mechanism: small deflections about the kinematic position, (47) of `docs/theory.md`.
//!
//! Every compliant direction of an elastic joint is a direction like a change of the design: a twist of its marker.
//! The twists of the bodies along it solve (11) with the factors at hand; their derivatives by the design are the
//! second derivative along both (15). The stiffness matrix has one row per direction, independent of the size of the
//! mechanism.

use crate::design::{BodyFixed, DesignMap, Geometry};
use crate::joint::sprung_directions;
use crate::linalg::Elimination;
use crate::measure::{Instant, StepValues, bodies_asked_for};
use crate::model::element::Compliance;
use crate::model::{DriverId, ElementId, GROUND, MeasureKind, Model, UnitForce, WheelId};
use crate::motion::mechanism::Mechanism;
use crate::number::{self, Dual, Real};
use crate::sensitivity::{PairDirection, Seconds, pair_with_variables, values_along_variable};
use crate::space::{Mat3, Pose, Twist, Vec3};
use crate::topology::{RowId, Topology};

use super::acting::{AppliedLoads, MovingBody};
use super::equilibrium::LoadedPosition;

/// A number with its derivatives along a direction (outer) and by a variable (inner).
type Number = Dual<Dual>;

/// A direction of deflection.
#[derive(Clone, Debug)]
enum Deflection {
    /// An elastic joint opens along a direction of this element.
    Opening(ElementId, usize),
    /// A driver is released: its load is zero.
    Released(DriverId),
}

/// Quantities that depend on a variable, or on none.
struct ChangedDesign {
    fixed: BodyFixed<Number>,
    geometry: Geometry<Number>,
}

/// Evaluates compliances at the position of a mechanism, for one design.
pub(crate) struct Compliances<'a> {
    model: &'a Model,
    asked: Vec<usize>,
    ways: Vec<Deflection>,
    variables: usize,
    seconds: Seconds,
    /// Per variable; the last entry has no derivative.
    changed: Vec<ChangedDesign>,
    bodies: Vec<usize>,
    /// Per direction: resistance of the redundant constraints; empty if the mechanism follows.
    resistance: Vec<Vec<(RowId, f64)>>,
    /// Poses per direction and body.
    poses: Vec<Vec<Pose<Number>>>,
    position: LoadedPosition<Number>,
}

impl<'a> Compliances<'a> {
    /// Compliances of the design with these values, with derivatives by the variables if requested; `None` if the model
    /// has no measure of compliance.
    pub fn new(
        design_map: &'a DesignMap<'a>,
        topology: &Topology,
        values: &[f64],
        sensitivities: bool,
    ) -> Option<Self> {
        let model = design_map.model();
        let is_asked = |m: &usize| matches!(model.measures[*m].kind, MeasureKind::Compliance { .. });
        let asked: Vec<usize> = (0..model.measures.len()).filter(is_asked).collect();
        if asked.is_empty() {
            return None;
        }
        let (mut ways, mut directions) = elastic_directions(model);
        let mut released: Vec<DriverId> = asked.iter().filter_map(|m| released_by(model, *m)).collect();
        released.sort_unstable();
        released.dedup();
        for driver in released {
            ways.push(Deflection::Released(driver));
            directions.push(PairDirection::Driver(driver));
        }
        let variables = if sensitivities { model.variables.len() } else { 0 };
        let pairs = pair_with_variables(model, &mut directions, variables);
        let changed = |by: usize| {
            let values = values_along_variable(values, by);
            ChangedDesign { fixed: design_map.fixed(&values), geometry: design_map.geometry(&values) }
        };
        let mut bodies = bodies_asked_for(model);
        let forces = model.elements.iter().filter_map(|e| e.kind.force(model));
        bodies.extend(forces.flat_map(|force| force.acts_on.bodies(model)).map(|b| b.0));
        bodies.sort_unstable();
        bodies.dedup();
        bodies.retain(|b| *b != GROUND.0);
        Some(Self {
            model,
            asked,
            seconds: Seconds::new(design_map, topology, values, (&directions, &[]), &pairs),
            changed: (0..variables).chain([usize::MAX]).map(changed).collect(),
            poses: vec![vec![Pose::IDENTITY.spread(); model.bodies.len()]; ways.len()],
            position: LoadedPosition::new(model),
            resistance: vec![Vec::new(); ways.len()],
            ways,
            variables,
            bodies,
        })
    }

    /// Adds the results at time t; `near` are approximate coordinates of the elements, for counting turns.
    pub fn add(&mut self, mechanism: &mut Mechanism<'_>, t: f64, near: &[f64], out: &mut StepValues) {
        self.seconds.solve(mechanism, t);
        // Includes the redundant rows, which the motion is not solved with.
        mechanism.state.finish_wrenches(&mechanism.topology);
        for (way, resistance) in self.resistance.iter_mut().enumerate() {
            *resistance = self.seconds.resistance(mechanism, way);
        }
        let constants = near.iter().map(|x| Number::constant(Dual::constant(*x)));
        self.position.near.iter_mut().zip(constants).for_each(|(to, near)| *to = near);
        for by in 0..=self.variables {
            self.seconds.set_poses(&mechanism.state, by, &self.bodies, &mut self.poses);
            self.enter(by, out);
        }
    }

    /// Writes values, or derivatives by a variable.
    fn enter(&mut self, by: usize, out: &mut StepValues) {
        let deflections = self.deflections(by);
        for &m in &self.asked {
            let x = self.compliance(m, by, &deflections);
            if by < self.variables { out.set_d(by, m, x.d) } else { out.set(m, x.v) }
        }
    }

    /// Returns per direction the deflections of springs and bushings, each with its stiffness.
    fn deflections(&mut self, by: usize) -> Vec<Vec<(Dual, Dual)>> {
        let Self { model, changed, poses, bodies, position, .. } = self;
        let of_direction = |poses: &Vec<Pose<Number>>| {
            for &b in &*bodies {
                position.bodies[b].pose = poses[b];
            }
            let applied = position.loads(model, &changed[by].geometry);
            let mut list = Vec::new();
            for e in (0..model.elements.len()).map(ElementId) {
                applied.deflections(e, |deflection, stiffness| list.push((deflection.d, stiffness.v)));
            }
            list
        };
        poses.iter().map(of_direction).collect()
    }

    /// Returns the compliance of measure m with its derivative by a variable; NaN if it is not determined.
    fn compliance(&self, m: usize, by: usize, deflections: &[Vec<(Dual, Dual)>]) -> Dual {
        let unknown = Dual { v: f64::NAN, d: f64::NAN };
        let (model, ChangedDesign { fixed, geometry }) = (self.model, &self.changed[by]);
        let Some((of, force)) = model.measures[m].kind.compliance() else { return unknown };
        let released = released_by(model, m);
        let counts = |way: &Deflection| match way {
            Deflection::Opening(..) => true,
            Deflection::Released(driver) => Some(*driver) == released,
        };
        let chosen = (0..self.ways.len()).filter(|w| counts(&self.ways[*w]));
        let (chosen, resisted): (Vec<usize>, Vec<usize>) =
            chosen.partition(|w| self.resistance[*w].is_empty());
        // Sum over the directions y_a r_a = 0, with r_a the resistance of the redundant constraints. If all r_a are
        // independent, none of these joints opens, since the others are rigid. Otherwise some may open together, and
        // the forces are not determined.
        if !are_independent(resisted.iter().map(|w| &self.resistance[*w][..])) {
            return unknown;
        }
        if chosen.is_empty() {
            return Dual::zero();
        }
        // L . Y of the output, and the work of a unit force
        let [mut outputs, mut works] = [const { Vec::new() }; 2];
        for &w in &chosen {
            let poses = &self.poses[w];
            outputs.push(Instant::new(model, fixed, poses).output(of).d);
            let (p, along) = match force {
                UnitForce::Point(at, along) => {
                    (poses[model.points[at.0].body.0].point(fixed.points[at.0]), along)
                }
                UnitForce::Wheel(wheel, along) => (self.contact(poses, geometry, wheel), along),
                // A force that grows is one of an equilibrium, which another solver finds.
                UnitForce::Element(_) => return unknown,
            };
            works.push(along.spread::<Number>().dot(p).d);
        }
        let mut stiffness = self.stiffness(&chosen, geometry, deflections);
        // Without stiffness against a released driver the compliance is infinite.
        if !(stiffness.factor().pivot_ratio > SINGULAR) {
            return unknown;
        }
        stiffness.solve(&mut works);
        outputs.iter().zip(&works).fold(Dual::zero(), |sum, (l, p)| sum + *l * *p)
    }

    /// Stiffness matrix of these directions.
    fn stiffness(
        &self,
        chosen: &[usize],
        geometry: &Geometry<Number>,
        deflections: &[Vec<(Dual, Dual)>],
    ) -> Elimination<Dual> {
        let mut stiffness = Elimination::new(chosen.len());
        for (r, &a) in chosen.iter().enumerate() {
            for (c, &b) in chosen.iter().enumerate() {
                // K_ab = K_a for a = b, + the entry of the matrix, + sum over springs k y_a y_b
                let mut sum = Dual::zero();
                if let (Deflection::Opening(e, row), Deflection::Opening(other, column)) =
                    (&self.ways[a], &self.ways[b])
                    && e == other
                    && let Some(law) = self.model.elements[e.0].kind.elastic_law()
                {
                    law.stiffnesses(*row, *column).for_each(|n| sum += geometry.numbers[n.0].v);
                }
                for ((y_a, k), (y_b, _)) in deflections[a].iter().zip(&deflections[b]) {
                    sum += *k * *y_a * *y_b;
                }
                stiffness.row_mut(r)[c] = sum;
            }
        }
        stiffness
    }

    /// Body point at the contact of a wheel, moved along a deflection. The road acts on this material point, while the
    /// contact point itself moves over the wheel.
    fn contact(&self, poses: &[Pose<Number>], geometry: &Geometry<Number>, wheel: WheelId) -> Vec3<Number> {
        let body = self.model.wheels[wheel.0].body.0;
        let now = |x: Number| Dual::constant(x.v);
        let held = |p: &Pose<Number>| Pose {
            rot: Mat3 { cols: number::each(&p.rot.cols, |c| c.map(now)) },
            r: p.r.map(now),
        };
        let mut bodies = vec![MovingBody::at_rest(); poses.len()];
        bodies[body].pose = held(&poses[body]);
        let acting = AppliedLoads { bodies: &bodies, ..self.position.loads(self.model, geometry) };
        let contact = acting.wheel(wheel).contact();
        poses[body].point(bodies[body].pose.inverse().point(contact))
    }
}

/// Directions in which elastic joints open, with their stiffnesses.
fn elastic_directions(model: &Model) -> (Vec<Deflection>, Vec<PairDirection>) {
    let (mut ways, mut directions) = (Vec::new(), Vec::new());
    for (e, element) in model.elements.iter().enumerate() {
        let (joint, law) = match element.kind.force(model).map(|force| force.compliance) {
            Some(Compliance::Joint(elastic)) => (elastic.joint, elastic.law()),
            Some(Compliance::None | Compliance::Element) | None => continue,
        };
        // Where the joint moves by itself it does not open: its stiffness there is that of a spring.
        let sprung = sprung_directions(model.joints[joint.0].kind);
        for (k, axis) in Vec3::AXES.into_iter().enumerate() {
            let twists = [Twist { w: Vec3::ZERO, v: axis }, Twist { w: axis, v: Vec3::ZERO }];
            for (direction, twist) in [k, 3 + k].into_iter().zip(twists) {
                if !sprung[direction] && law.stiffnesses(direction, direction).next().is_some() {
                    ways.push(Deflection::Opening(ElementId(e), direction));
                    directions.push(PairDirection::Opening(joint, twist));
                }
            }
        }
    }
    (ways, directions)
}

/// Returns true if these vectors are linearly independent; each is given by its nonzero entries, in the order of rows.
fn are_independent<'a>(vectors: impl Iterator<Item = &'a [(RowId, f64)]>) -> bool {
    let norm = |v: &[(RowId, f64)]| v.iter().map(|(_, x)| x * x).sum::<f64>().sqrt();
    let mut basis: Vec<Vec<(RowId, f64)>> = Vec::new();
    for vector in vectors {
        let (mut rest, whole) = (vector.to_vec(), norm(vector));
        // Twice, so that the basis stays orthogonal to round-off.
        for unit in basis.iter().chain(&basis) {
            let entry =
                |v: &[(RowId, f64)], row: RowId| v.iter().find(|(r, _)| *r == row).map_or(0.0, |x| x.1);
            let along: f64 = unit.iter().map(|(row, x)| x * entry(&rest, *row)).sum();
            for (row, x) in unit {
                match rest.iter_mut().find(|(r, _)| r == row) {
                    Some((_, y)) => *y -= along * x,
                    None => rest.push((*row, -along * x)),
                }
            }
        }
        let left = norm(&rest);
        if !(left > DEPENDENT * whole) {
            return false;
        }
        rest.iter_mut().for_each(|(_, x)| *x /= left);
        basis.push(rest);
    }
    true
}

/// Relative tolerance of linear dependence: resistances are found to about 1e-9, and coordinates typed into a file are
/// off by 1e-6.
const DEPENDENT: f64 = 1e-5;

/// Pivot ratio below which the stiffness matrix is singular: no stiffness acts in some direction.
const SINGULAR: f64 = 1e-14;

fn released_by(model: &Model, measure: usize) -> Option<DriverId> {
    if let MeasureKind::Compliance { released, .. } = model.measures[measure].kind { released } else { None }
}
