//! Compliance of the mechanism: small deflections about the kinematic position, (47) of `docs/theory.md`.
//!
//! Every direction in which an elastic joint opens is a way to go like a change of the design: a twist of its marker.
//! What bodies do along it solves (11) with the factors at hand, and how that changes with the design is the second
//! derivative along both (15). Stiffnesses meet in a matrix as large as the number of ways, whatever the size of the
//! mechanism.

use crate::design::{BodyFixed, DesignMap, Geometry};
use crate::linalg::Elimination;
use crate::measure::{Instant, StepValues, bodies_asked_for};
use crate::model::{
    DriverId, ElementId, ElementKind, GROUND, MeasureKind, Model, NumberId, VariableId, WheelId,
};
use crate::motion::stepper::Stepper;
use crate::number::{Dual, Real};
use crate::sensitivity::{PairDirection, Seconds};
use crate::space::{Mat3, Pose, Twist, Vec3};
use crate::topology::{RowId, Topology};

use super::acting::{AppliedLoads, MovingBody};

/// A number with its derivative along a way (the outer one) and by a variable (the inner one).
type Number = Dual<Dual>;

/// A way to deflect.
#[derive(Clone, Debug)]
enum Way {
    /// An elastic joint opens, against this stiffness.
    Opening(NumberId),
    /// A driver is released: it holds nothing.
    Released(DriverId),
}

/// Quantities that depend on a variable, or on none.
struct Changed {
    fixed: BodyFixed<Number>,
    geometry: Geometry<Number>,
}

/// Evaluates compliances where a stepper is, in one design.
pub(crate) struct Compliances<'a> {
    model: &'a Model,
    asked: Vec<usize>,
    ways: Vec<Way>,
    variables: usize,
    seconds: Seconds,
    /// Per variable; the last is that of no change.
    changed: Vec<Changed>,
    bodies: Vec<usize>,
    /// Per way: how redundant constraints resist it; none where the mechanism follows.
    resistance: Vec<Vec<(RowId, f64)>>,
    /// Per way.
    poses: Vec<Vec<Pose<Number>>>,
    moving: Vec<MovingBody<Number>>,
    laws: Vec<Number>,
    near: Vec<Number>,
    friction: Vec<Number>,
}

impl<'a> Compliances<'a> {
    /// For the design with these values, with derivatives by the variables if they are wanted; `None` for a model
    /// without such measures.
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
        let (mut ways, mut directions) = (Vec::new(), Vec::new());
        for element in &model.elements {
            let ElementKind::ElasticJoint { joint, x, y, z, about_x, about_y, about_z } = element.kind else {
                continue;
            };
            let slides = [x, y, z].map(|n| n.map(|n| n.0));
            let turns = [about_x, about_y, about_z].map(|n| n.map(|n| n.0));
            for (axis, (slide, turn)) in Vec3::AXES.into_iter().zip(slides.into_iter().zip(turns)) {
                let twists = [Twist { w: Vec3::ZERO, v: axis }, Twist { w: axis, v: Vec3::ZERO }];
                for (stiffness, twist) in [slide, turn].into_iter().zip(twists) {
                    if let Some(stiffness) = stiffness {
                        ways.push(Way::Opening(stiffness));
                        directions.push(PairDirection::Opening(joint, twist));
                    }
                }
            }
        }
        let mut released: Vec<DriverId> = asked.iter().filter_map(|m| released_by(model, *m)).collect();
        released.sort_unstable();
        released.dedup();
        for driver in released {
            ways.push(Way::Released(driver));
            directions.push(PairDirection::Driver(driver));
        }
        let variables = if sensitivities { model.variables.len() } else { 0 };
        let ways_to_go = ways.len();
        directions.extend((0..variables).map(|v| PairDirection::Design(model.alone(VariableId(v), 1.0))));
        let pairs: Vec<[usize; 2]> =
            (0..variables).flat_map(|v| (0..ways_to_go).map(move |d| [d, ways_to_go + v])).collect();
        let changed = |by: usize| {
            let value = |k: usize| Dual::constant(Dual { v: values[k], d: f64::from(u8::from(k == by)) });
            let values: Vec<Number> = (0..values.len()).map(value).collect();
            Changed { fixed: design_map.fixed(&values), geometry: design_map.geometry(&values) }
        };
        let mut bodies = bodies_asked_for(model);
        bodies.extend(model.elements.iter().flat_map(|e| e.kind.bodies(model)).map(|b| b.0));
        bodies.sort_unstable();
        bodies.dedup();
        bodies.retain(|b| *b != GROUND.0);
        Some(Self {
            model,
            asked,
            seconds: Seconds::new(design_map, topology, values, &directions, &pairs),
            changed: (0..variables).chain([usize::MAX]).map(changed).collect(),
            poses: vec![vec![Pose::IDENTITY.spread(); model.bodies.len()]; ways.len()],
            moving: vec![MovingBody::still(); model.bodies.len()],
            laws: vec![Dual::one(); model.elements.len()],
            near: Vec::new(),
            friction: vec![Dual::zero(); model.elements.len()],
            resistance: vec![Vec::new(); ways.len()],
            ways,
            variables,
            bodies,
        })
    }

    /// Enters what is found at time t; `near` is about what the coordinates are that elements act on.
    pub fn add(&mut self, stepper: &mut Stepper<'_>, t: f64, near: &[f64], out: &mut StepValues) {
        self.seconds.solve(stepper, t);
        // Of the rows as well that the motion is not solved with.
        stepper.state.finish_wrenches(&stepper.topology);
        for (way, resistance) in self.resistance.iter_mut().enumerate() {
            *resistance = self.seconds.resistance(stepper, way);
        }
        self.near.clear();
        self.near.extend(near.iter().map(|x| Number::constant(Dual::constant(*x))));
        for by in 0..=self.variables {
            for (way, poses) in self.poses.iter_mut().enumerate() {
                for &body in &self.bodies {
                    poses[body] = if by < self.variables {
                        self.seconds.pose(&stepper.state, by * self.ways.len() + way, body)
                    } else {
                        self.seconds.pose_along(&stepper.state, way, body)
                    };
                }
            }
            self.enter(by, out);
        }
    }

    /// Enters values, or derivatives by a variable.
    fn enter(&mut self, by: usize, out: &mut StepValues) {
        let Changed { fixed, geometry } = &self.changed[by];
        let model = self.model;
        // Per way: how far everything elastic besides the joints gives, each with its stiffness.
        let mut given: Vec<Vec<(Dual, Dual)>> = Vec::new();
        for poses in &self.poses {
            for &b in &self.bodies {
                self.moving[b] = MovingBody { pose: poses[b], v: Twist::zero(), a: Twist::zero() };
            }
            let (bodies, laws, near, friction) = (&self.moving, &self.laws, &self.near, &self.friction);
            let acting = AppliedLoads { model, geometry, bodies, laws, near, friction };
            let mut list = Vec::new();
            for e in (0..model.elements.len()).map(ElementId) {
                acting.deflections(e, |way, stiffness| list.push((way.d, stiffness.v)));
            }
            given.push(list);
        }
        for &m in &self.asked {
            let MeasureKind::Compliance { of, at, wheel, along, .. } = &model.measures[m].kind else {
                continue;
            };
            let released = released_by(model, m);
            let counts = |way: &Way| match way {
                Way::Opening(_) => true,
                Way::Released(driver) => Some(*driver) == released,
            };
            let chosen = (0..self.ways.len()).filter(|w| counts(&self.ways[*w]));
            let (chosen, resisted): (Vec<usize>, Vec<usize>) =
                chosen.partition(|w| self.resistance[*w].is_empty());
            // Sum over the ways y_a r_a = 0, r_a how the redundant constraints resist: where all r_a are independent, no such joint
            // opens at all, for the others are rigid. Else some may open together, by forces that nobody knows.
            let is_known = are_independent(resisted.iter().map(|w| &self.resistance[*w][..]));
            // L . Y of the output, and what a unit of force works
            let mut gives: Vec<Dual> = Vec::new();
            let mut works: Vec<Dual> = Vec::new();
            for &w in &chosen {
                let poses = &self.poses[w];
                gives.push(Instant::new(model, fixed, poses).output(*of).d);
                let p = match (at, wheel) {
                    (Some(at), _) => poses[model.points[at.0].body.0].point(fixed.points[at.0]),
                    (None, Some(wheel)) => self.contact(poses, geometry, *wheel),
                    (None, None) => Vec3::zero(),
                };
                works.push(along.spread::<Number>().dot(p).d);
            }
            let mut stiffness = Elimination::<Dual>::new(chosen.len());
            for (r, &a) in chosen.iter().enumerate() {
                for (c, &b) in chosen.iter().enumerate() {
                    // K_ab = K_a for a = b, + sum over springs k y_a y_b
                    let mut sum = match self.ways[a] {
                        Way::Opening(n) if a == b => geometry.numbers[n.0].v,
                        _ => Dual::zero(),
                    };
                    for ((y_a, k), (y_b, _)) in given[a].iter().zip(&given[b]) {
                        sum += *k * *y_a * *y_b;
                    }
                    stiffness.row_mut(r)[c] = sum;
                }
            }
            // Without any stiffness against a released driver there is no end to it.
            let x = if !is_known {
                Dual::constant(f64::NAN)
            } else if chosen.is_empty() {
                Dual::zero()
            } else if stiffness.factor().pivot_ratio > SINGULAR {
                stiffness.solve(&mut works);
                gives.iter().zip(&works).fold(Dual::zero(), |sum, (l, p)| sum + *l * *p)
            } else {
                Dual::constant(f64::NAN)
            };
            if by < self.variables { out.set_d(by, m, x.d) } else { out.set(m, x.v) }
        }
    }
}

impl Compliances<'_> {
    /// Contact point of a wheel as the body point that is there now, moved along a deflection: the road acts on this
    /// point, while the contact point itself moves over the wheel.
    fn contact(&self, poses: &[Pose<Number>], geometry: &Geometry<Number>, wheel: WheelId) -> Vec3<Number> {
        let body = self.model.wheels[wheel.0].body.0;
        let now = |x: Number| Dual::constant(x.v);
        let held =
            |p: &Pose<Number>| Pose { rot: Mat3 { cols: p.rot.cols.map(|c| c.map(now)) }, r: p.r.map(now) };
        let mut bodies = vec![MovingBody::still(); poses.len()];
        bodies[body].pose = held(&poses[body]);
        let (laws, near, friction) = (&self.laws, &self.near, &self.friction);
        let acting = AppliedLoads { model: self.model, geometry, bodies: &bodies, laws, near, friction };
        let contact = acting.wheel(wheel).contact();
        poses[body].point(bodies[body].pose.inverse().point(contact))
    }
}

/// Returns whether no sum of these vectors, each by its own factor, is zero; of each its entries that are not zero, in
/// the order of the rows.
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

/// Ways that differ by less than this part from a sum of others depend on them: what a mechanism's redundant
/// constraints resist is found to some 1e-9, and typed coordinates are off by 1e-6.
const DEPENDENT: f64 = 1e-5;

/// Stiffnesses whose pivots differ by more hold some way by nothing.
const SINGULAR: f64 = 1e-14;

fn released_by(model: &Model, measure: usize) -> Option<DriverId> {
    match model.measures[measure].kind {
        MeasureKind::Compliance { released, .. } => released,
        _ => None,
    }
}
