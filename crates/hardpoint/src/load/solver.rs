//! Loads of one design, step after step.

use crate::design::{DesignMap, Geometry};
use crate::measure::StepValues;
use crate::model::{Axes, ElementId, JointId, MeasureKind, Model, PointId, ReactionPart, VariableId};
use crate::motion::kinematics::State;
use crate::motion::stepper::Stepper;
use crate::number::{Dual, Real};
use crate::sensitivity::Differentiated;
use crate::space::{Vec3, Wrench};
use crate::topology::Topology;

use super::acting::AppliedLoads;
use super::carry::{Carried, Equilibrium, Stress, is_known};
use super::friction::Friction;
use super::inertia::Changed;
use super::measures::Instant;
use super::turns::Turns;

/// Evaluates loads at the position of a stepper, for one design.
pub(crate) struct LoadSolver<'a> {
    pub(super) model: &'a Model,
    /// Measures of loads.
    asked: Vec<usize>,
    geometry: Geometry,
    /// Geometry with the derivative by each variable.
    pub(super) changed: Vec<Changed<f64>>,
    /// Geometry with derivative zero.
    pub(super) constant: Geometry<Dual>,
    turns: Vec<Turns>,
    pub(super) friction: Friction,
    pub(super) bodies: Equilibrium<f64>,
    /// True if reactions are checked against self-stress: with redundant constraints some are not determined.
    judges: bool,
    /// Self-stresses, one per redundant row.
    stresses: Vec<Stress<f64>>,
    /// Per measure: its value; NaN if it is not a load. Derivatives per variable and measure.
    pub(super) values: Vec<f64>,
    derivatives: Vec<f64>,
}

impl<'a> LoadSolver<'a> {
    /// Solver for the design with these values, with derivatives by the variables if requested.
    pub fn new(
        design_map: &'a DesignMap<'a>,
        topology: &Topology,
        values: &[f64],
        sensitivities: bool,
    ) -> Self {
        let model = design_map.model();
        let variables = if sensitivities { model.variables.len() } else { 0 };
        let measures = model.measures.len();
        Self {
            model,
            asked: asked(model),
            geometry: design_map.geometry(values),
            changed: (0..variables)
                .map(|v| Changed::new(model, geometry_along(design_map, values, Some(v))))
                .collect(),
            constant: geometry_along(design_map, values, None),
            turns: Turns::of_all(model, topology),
            friction: Friction::new(model),
            bodies: Equilibrium::new(model, topology),
            judges: asks_for_reactions(model),
            stresses: Vec::new(),
            values: vec![f64::NAN; measures],
            derivatives: vec![f64::NAN; measures * variables],
        }
    }

    /// Checks all reactions against self-stress, requested or not.
    pub fn judging(self) -> Self {
        Self { judges: true, ..self }
    }

    /// Loads of joints and drivers at the output time.
    pub fn found(&self) -> &Carried<f64> {
        &self.bodies.now.found
    }

    /// Per element: approximate value of the coordinate that it acts on.
    pub fn near(&self) -> &[f64] {
        &self.bodies.now.near
    }

    /// Evaluates the loads at the position of a stepper at time t, from velocity and acceleration.
    pub fn step(&mut self, one: &mut Stepper<'_>, t: f64) {
        let Stepper { mechanism, turns, .. } = one;
        let (topology, state) = (&mechanism.topology, &mut mechanism.state);
        let model = self.model;
        self.bodies.stand(state, |d| mechanism.parts.law_of(d).at(t).d());
        for (law, element) in self.bodies.now.laws.iter_mut().zip(&model.elements) {
            *law = element.kind.law(model).map_or(1.0, |law| law.at(t).value());
        }
        self.follow_turns(&state.q, turns.as_ref().map_or(&[], |turns| &turns.values));
        self.bodies.now.friction.fill(0.0);
        self.bodies.carry(topology, state, (model, &self.geometry));
        if self.judges || !self.friction.is_empty() {
            self.stresses = self.bodies.stresses(topology, state, (model, &self.geometry));
        }
        if !self.friction.is_empty() {
            self.rub(topology, state);
        }
        if !self.changed.is_empty() {
            self.bodies.begin_changes((model, &self.geometry));
        }
        let mut values = std::mem::take(&mut self.values);
        let acting = self.acting();
        let instant = Instant { acting: &acting, carried: &self.bodies.now.found };
        for &m in &self.asked {
            let kind = &model.measures[m].kind;
            let known = is_known(kind, &acting, &self.stresses);
            values[m] = if known { instant.measure(kind) } else { f64::NAN };
        }
        self.values = values;
    }

    fn acting(&self) -> AppliedLoads<'_, f64> {
        self.bodies.now.acting(self.model, &self.geometry)
    }

    /// Solves for friction, whose normal forces depend on the friction itself.
    fn rub(&mut self, topology: &Topology, state: &mut State<f64>) {
        let Self { model, geometry, bodies, friction, stresses, .. } = self;
        let acting = bodies.now.acting(model, geometry);
        let units: Vec<_> = friction.elements().map(|e| acting.friction_unit(e)).collect();
        let response = |unit: Option<(JointId, Wrench)>| {
            let Some((joint, l)) = unit else { return Vec::new() };
            let [i, j] = model.joints[joint.0].bodies;
            bodies.response(topology, state, [(j.0, l), (i.0, Wrench::zero() - l)])
        };
        let responses: Vec<_> = units.into_iter().map(response).collect();
        let acting = bodies.now.acting(model, geometry);
        friction.set(&acting, &bodies.now.found, &responses);
        // If redundant constraints share the force across a pin, its friction is not determined.
        friction.solve(&acting, stresses);
        friction.enter(&mut bodies.now.friction);
        bodies.carry(topology, state, (model, geometry));
    }

    /// Location of a joint on its body j.
    pub fn place(&self, joint: JointId) -> Vec3 {
        let [place, ..] = Instant { acting: &self.acting(), carried: self.found() }.wrench(joint);
        place
    }

    /// The force and the moment that a joint puts on its body j, along these axes, the moment about its place there;
    /// and whether each component is known: where constraints say the same, some of what joints carry depends on how
    /// stiff they are.
    pub fn reaction(&self, joint: JointId, axes: Axes) -> [(Vec3, [bool; 3]); 2] {
        let acting = self.acting();
        let instant = Instant { acting: &acting, carried: self.found() };
        [ReactionPart::ForceAlong as fn(usize) -> _, ReactionPart::MomentAbout].map(|part| {
            let kinds =
                [0, 1, 2].map(|k| MeasureKind::Reaction { joint, part: part(k), on: None, axes: Some(axes) });
            let [x, y, z] = kinds.each_ref().map(|kind| instant.measure(kind));
            (Vec3::new(x, y, z), kinds.each_ref().map(|kind| is_known(kind, &acting, &self.stresses)))
        })
    }

    /// Determined part of the reaction force on body j, global, and the number of its directions. The part that
    /// self-stresses can change is left out.
    pub fn known_force(&self, joint: JointId) -> (Vec3, usize) {
        let acting = self.acting();
        let force_of = |carried| Instant { acting: &acting, carried }.wrench(joint)[1];
        // Orthogonal basis of the forces that self-stresses change.
        let mut open: Vec<Vec3> = Vec::new();
        for Stress { carried, most } in &self.stresses {
            let kind = MeasureKind::Reaction { joint, part: ReactionPart::Force, on: None, axes: None };
            if (Instant { acting: &acting, carried }).excess(&kind, *most) <= 0.0 {
                continue;
            }
            let force = force_of(carried);
            let rest = across(force, &open);
            if rest.norm() > PARALLEL * force.norm() {
                open.push(rest * (1.0 / rest.norm()));
            }
        }
        (across(force_of(self.found()), &open), 3 - open.len())
    }

    /// Force on the body of one of its points, global: of a spring, a bushing or a given force.
    pub fn push(&self, element: ElementId, at: PointId) -> Vec3 {
        let mut needed = vec![Wrench::zero(); self.model.bodies.len()];
        self.acting().add(element, &mut needed);
        -needed[self.model.points[at.0].body.0].f
    }

    /// Updates the turns of the coordinates that elements act on, from the tree or from the count along the path.
    fn follow_turns(&mut self, q: &[f64], counted: &[f64]) {
        for (near, turns) in self.bodies.now.near.iter_mut().zip(&self.turns) {
            match *turns {
                Turns::None | Turns::Length => {}
                Turns::Coordinate(c) => *near = q[c.0],
                Turns::Path(place) => *near = counted[place],
            }
        }
    }

    /// Writes the loads to the measures of the output time.
    pub fn enter(&self, out: &mut StepValues) {
        let measures = self.values.len();
        for &m in &self.asked {
            out.set(m, self.values[m]);
            for (v, d) in self.derivatives.chunks_exact(measures).enumerate() {
                out.set_d(v, m, d[m]);
            }
        }
    }

    /// Computes the derivatives by a variable, whose sensitivities have been solved.
    pub fn differentiate(&mut self, by: Differentiated<'_>) {
        let Differentiated { variable: VariableId(v), topology, state, field, flow } = by;
        let Self { model, changed, bodies, friction, .. } = self;
        let changed = (*model, &changed[v]);
        let variable = VariableId(v);
        bodies.change(model, Differentiated { variable, topology, state: &mut *state, field, flow });
        bodies.carry_changed(topology, state, changed);
        if !friction.is_empty() {
            friction.differentiate(&bodies.along.acting(model, &changed.1.geometry), &bodies.along.found);
            friction.enter_changed(&mut bodies.along.friction);
            bodies.carry_changed(topology, state, changed);
        }
        let acting = bodies.along.acting(model, &changed.1.geometry);
        let instant = Instant { acting: &acting, carried: &bodies.along.found };
        let measures = self.values.len();
        for &m in &self.asked {
            let d = instant.measure(&model.measures[m].kind).d;
            self.derivatives[v * measures + m] = if self.values[m].is_nan() { f64::NAN } else { d };
        }
    }
}

/// Measures of loads.
pub(super) fn asked(model: &Model) -> Vec<usize> {
    (0..model.measures.len()).filter(|m| model.measures[*m].kind.is_load()).collect()
}

/// True if the model has a measure of reactions: with redundant constraints some are not determined.
pub(super) fn asks_for_reactions(model: &Model) -> bool {
    model.measures.iter().any(|m| matches!(m.kind, MeasureKind::Reaction { .. }))
}

/// Body-fixed data with the derivative by a variable, or by none.
pub(super) fn geometry_along<T: Real>(
    design_map: &DesignMap<'_>,
    values: &[T],
    variable: Option<usize>,
) -> Geometry<Dual<T>> {
    let mut duals: Vec<Dual<T>> = values.iter().map(|x| Dual::constant(*x)).collect();
    variable.iter().for_each(|v| duals[*v] = Dual::variable(values[*v]));
    design_map.geometry(&duals)
}

/// Sine of the angle below which two directions are parallel.
const PARALLEL: f64 = 1e-7;

/// Component of a vector perpendicular to these unit vectors, which are perpendicular to each other.
fn across(v: Vec3, directions: &[Vec3]) -> Vec3 {
    directions.iter().fold(v, |v, u| v - *u * u.dot(v))
}
