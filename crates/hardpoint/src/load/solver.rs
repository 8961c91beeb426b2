//! Loads of one design, step after step.

use crate::design::{DesignMap, Geometry};
use crate::measure::StepValues;
use crate::model::element::ForceCurve;
use crate::model::{Axes, ElementId, JointId, MeasureKind, Model, PointId, ReactionPart};
use crate::motion::stepper::Stepper;
use crate::number::{Dual, Real};
use crate::sensitivity::Differentiated;
use crate::space::{Vec3, Wrench};
use crate::topology::Topology;

use super::derivatives::LoadDerivatives;
use super::equilibrium::Equilibrium;
use super::measures::LoadMeasures;
use super::results::Deflection;
use super::transmitted::{SelfStress, TransmittedLoads};
use super::turns::Turns;

/// Evaluates loads at the position of a stepper, for one design.
pub(crate) struct LoadSolver<'a> {
    /// Requested measures of loads.
    pub(super) measures: Vec<usize>,
    turns: Vec<Turns>,
    pub(super) equilibrium: Equilibrium<'a, f64>,
    /// `None` if no sensitivities are requested.
    pub(super) derivatives: Option<LoadDerivatives<'a, f64>>,
    /// True if reactions are checked against self-stress: with redundant constraints some are not determined.
    checks_reactions: bool,
    /// Per requested measure.
    pub(super) values: Vec<f64>,
    /// Derivatives per variable and requested measure.
    slopes: Vec<f64>,
    /// Elements and directions whose deflections are differentiated, and the derivatives per variable and direction.
    elastic: Vec<(ElementId, usize)>,
    deflection_slopes: Vec<f64>,
}

impl<'a> LoadSolver<'a> {
    /// Solver of these measures for the design with these values, with derivatives by the variables if requested.
    pub fn new(
        design_map: &'a DesignMap<'a>,
        topology: &Topology,
        values: &[f64],
        measures: Vec<usize>,
        sensitivities: bool,
    ) -> Self {
        let model = design_map.model();
        let equilibrium = Equilibrium::new(model, topology, design_map.geometry(values));
        let derivatives = sensitivities.then(|| {
            let kinds = measures.iter().map(|m| &model.measures[*m].kind);
            let along = |v: Option<usize>| geometry_along(design_map, values, v);
            let by_variables = (0..model.variables.len()).map(|v| along(Some(v)));
            LoadDerivatives::new(&equilibrium, topology, kinds, by_variables, along(None))
        });
        let variables = if sensitivities { model.variables.len() } else { 0 };
        Self {
            turns: Turns::of_all(model, topology),
            equilibrium,
            derivatives,
            checks_reactions: asks_for_reactions(model),
            values: vec![f64::NAN; measures.len()],
            slopes: vec![f64::NAN; measures.len() * variables],
            measures,
            elastic: Vec::new(),
            deflection_slopes: Vec::new(),
        }
    }

    /// Differentiates the deflections in these directions too.
    pub fn with_deflections(self, elastic: Vec<(ElementId, usize)>) -> Self {
        let variables = self.derivatives.as_ref().map_or(0, |derivatives| derivatives.changed.len());
        Self { deflection_slopes: vec![f64::NAN; elastic.len() * variables], elastic, ..self }
    }

    /// Checks all reactions against self-stress, requested or not.
    pub fn checking_reactions(self) -> Self {
        Self { checks_reactions: true, ..self }
    }

    /// Loads of joints and drivers at the output time.
    pub fn transmitted(&self) -> &TransmittedLoads<f64> {
        &self.equilibrium.transmitted
    }

    /// Per element: approximate value of the coordinate that it acts on.
    pub fn near(&self) -> &[f64] {
        &self.equilibrium.position.near
    }

    /// Evaluates the loads at the position of a stepper at time t, from velocity and acceleration. Their derivatives
    /// follow if `differentiates`, and are unknown otherwise.
    pub fn step(&mut self, one: &mut Stepper<'_>, t: f64, differentiates: bool) {
        let Self { measures, turns, equilibrium, derivatives, checks_reactions, values, .. } = self;
        let derivatives = derivatives.as_mut().filter(|_| differentiates);
        if !differentiates {
            self.slopes.fill(f64::NAN);
            self.deflection_slopes.fill(f64::NAN);
        }
        let Stepper { mechanism, turns: counted, .. } = one;
        let (topology, state, model) = (&mechanism.topology, &mut mechanism.state, equilibrium.model);
        equilibrium.set_motion(state, |d| mechanism.parts.law_of(d).at(t).d());
        let position = &mut equilibrium.position;
        for (e, element) in model.elements.iter().enumerate() {
            position.laws[e] = element.kind.law(model).map_or(1.0, |law| law.at(t).value());
        }
        let counted = counted.as_ref().map(|turns| &turns.values[..]);
        Turns::write(turns, state, counted, &mut position.near);
        position.friction.fill(0.0);
        equilibrium.solve(topology, state);
        let has_friction = !equilibrium.friction.is_empty();
        if *checks_reactions || has_friction {
            equilibrium.solve_stresses(topology, state);
        }
        if has_friction {
            equilibrium.solve_friction(topology, state);
        }
        if let Some(derivatives) = derivatives {
            let friction = &equilibrium.friction;
            derivatives.set_equilibrium(equilibrium, topology, state, |y| friction.solve_multipliers(y));
        }
        let applied = equilibrium.applied();
        for (n, &m) in measures.iter().enumerate() {
            let kind = &model.measures[m].kind;
            let is_known = equilibrium.is_determined(kind);
            values[n] = if is_known { equilibrium.measures(&applied).measure(kind) } else { f64::NAN };
        }
    }

    /// Location of a joint on its body j.
    pub fn place(&self, joint: JointId) -> Vec3 {
        let [place, ..] = self.equilibrium.measures(&self.equilibrium.applied()).wrench(joint);
        place
    }

    /// Force and moment of a joint on its body j, along these axes, the moment about the joint's location there; each
    /// component with true if it is determined: with redundant constraints some depend on stiffness.
    pub fn reaction(&self, joint: JointId, axes: Axes) -> [(Vec3, [bool; 3]); 2] {
        let applied = self.equilibrium.applied();
        let measures = self.equilibrium.measures(&applied);
        [ReactionPart::ForceAlong as fn(usize) -> _, ReactionPart::MomentAbout].map(|part| {
            let kinds =
                [0, 1, 2].map(|k| MeasureKind::Reaction { joint, part: part(k), on: None, axes: Some(axes) });
            let [x, y, z] = kinds.each_ref().map(|kind| measures.measure(kind));
            (Vec3::new(x, y, z), kinds.each_ref().map(|kind| self.equilibrium.is_determined(kind)))
        })
    }

    /// Determined part of the reaction force on body j, global, and the number of its directions. The part that
    /// self-stresses can change is left out.
    pub fn known_force(&self, joint: JointId) -> (Vec3, usize) {
        let applied = self.equilibrium.applied();
        // Orthogonal basis of the forces that self-stresses change.
        let mut open: Vec<Vec3> = Vec::new();
        for SelfStress { loads, largest } in &self.equilibrium.stresses {
            let kind = MeasureKind::Reaction { joint, part: ReactionPart::Force, on: None, axes: None };
            let stress = LoadMeasures::of_stress(&applied, loads);
            if stress.excess(&kind, *largest) <= 0.0 {
                continue;
            }
            let [_, force, _] = stress.wrench(joint);
            let rest = across(force, &open);
            if rest.norm() > PARALLEL * force.norm() {
                open.push(rest * (1.0 / rest.norm()));
            }
        }
        let [_, force, _] = LoadMeasures::new(&applied, self.transmitted()).wrench(joint);
        (across(force, &open), 3 - open.len())
    }

    /// Force on the body of one of its points, global: of a spring, a bushing or a given force.
    pub fn push(&self, element: ElementId, at: PointId) -> Vec3 {
        let model = self.equilibrium.model;
        let mut required = vec![Wrench::zero(); model.bodies.len()];
        self.equilibrium.applied().add(element, &mut required);
        -required[model.points[at.0].body.0].f
    }

    /// Deflection of an elastic joint or a bushing in one of its six directions.
    pub fn deflection(&self, (element, direction): (ElementId, usize)) -> Deflection {
        let (model, applied) = (self.equilibrium.model, self.equilibrium.applied());
        let unknown = Deflection { displacement: f64::NAN, force: f64::NAN };
        let kind = &model.elements[element.0].kind;
        let (Some(opening), Some(law)) = (applied.opening_at(element), kind.elastic_law()) else {
            return unknown;
        };
        Deflection {
            displacement: opening.coordinates[direction],
            force: applied.elastic_forces(&opening, &law)[direction],
        }
    }

    /// Deflection that the force of a curve depends on; NaN where it is not known.
    pub fn curve_deflection(&self, curve: &ForceCurve<'_>) -> f64 {
        match curve.direction {
            Some(k) => self.deflection((curve.element, k)).displacement,
            None => self.equilibrium.applied().table_deflection(curve.element).unwrap_or(f64::NAN),
        }
    }

    /// Derivatives by every variable of the deflection in direction i of those that are differentiated.
    pub fn deflection_derivatives(&self, i: usize) -> impl Iterator<Item = f64> {
        self.deflection_slopes.iter().skip(i).step_by(self.elastic.len().max(1)).copied()
    }

    /// Value of a given force or moment, positive along its own direction.
    pub fn given(&self, element: ElementId) -> f64 {
        self.equilibrium.applied().size(element)
    }

    /// True if the friction of all elements is determined at this step.
    pub fn is_friction_known(&self) -> bool {
        self.equilibrium.friction.is_known()
    }

    /// Elements whose friction is not determined at this step, because redundant constraints share the normal force.
    pub fn shared_friction(&self) -> impl Iterator<Item = ElementId> {
        self.equilibrium.friction.shared()
    }

    /// Elements whose friction has more than one solution at this step.
    pub fn ambiguous_friction(&self) -> impl Iterator<Item = ElementId> {
        self.equilibrium.friction.ambiguous()
    }

    /// Writes the loads to the measures of the output time.
    pub fn enter(&self, out: &mut StepValues) {
        for (n, &m) in self.measures.iter().enumerate() {
            out.set(m, self.values[n]);
            for v in 0..self.slopes.len() / self.measures.len() {
                out.set_d(v, m, self.slopes[v * self.measures.len() + n]);
            }
        }
    }

    /// Computes the derivatives by a variable, whose sensitivities have been solved.
    pub fn differentiate(&mut self, by: &Differentiated<'_>) {
        let Self { equilibrium, derivatives: Some(derivatives), values, slopes, measures, .. } = self else {
            return;
        };
        let slopes = &mut slopes[by.variable.0 * measures.len()..];
        derivatives.differentiate(equilibrium, by, |n, slope| {
            slopes[n] = if values[n].is_nan() { f64::NAN } else { slope };
        });
        let elastic = &self.elastic[..];
        let slopes = self.deflection_slopes.iter_mut().skip(by.variable.0 * elastic.len());
        slopes.zip(derivatives.deflections(by.variable, elastic)).for_each(|(to, slope)| *to = slope);
    }
}

/// All measures of loads of a model.
pub(crate) fn load_measures(model: &Model) -> Vec<usize> {
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
