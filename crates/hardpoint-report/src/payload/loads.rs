//! Forces on bodies, for drawing; deflections of elastic joints and bushings, as curves.

use hardpoint::Analysis;
use hardpoint::load::Loads;
use hardpoint::model::{Dimension, Model};
use hardpoint::space::Vec3;
use hardpoint_table::series::settled;

use crate::deflection;
use crate::page::{BodyPlace, Curve, LoadMark};

use super::Compose;
use super::drawing::is_drawn;

/// A component below this fraction of the largest force is round-off.
const ROUND_OFF: f64 = 1e-11;

/// Number of forces on the page of a model.
pub(super) fn count(model: &Model) -> usize {
    if model.has_loads() { joints(model).len() + model.points_of_application().len() } else { 0 }
}

/// Indices of the joints whose forces are shown.
fn joints(model: &Model) -> Vec<usize> {
    let all = model.joints.iter().enumerate();
    all.filter(|(_, joint)| is_drawn(joint) && !joint.unnamed).map(|(j, _)| j).collect()
}

/// Load over the shown output times, as a quantity.
pub(super) struct LoadCurve {
    pub name: String,
    pub group: &'static str,
    pub dimension: Dimension,
    pub curve: Curve,
}

impl Compose<'_> {
    /// Forces of the nominal design.
    pub(super) fn loads(&self, loads: &Loads) -> Vec<LoadMark> {
        if count(self.model) == 0 {
            return Vec::new();
        }
        let shown = joints(self.model);
        let part_of = |j: usize| (0..loads.times.len()).any(|k| loads.joints_at(k)[j].known_directions < 3);
        let of_joints = shown.iter().map(|&j| {
            let joint = &self.model.joints[j];
            let body = joint.bodies[1];
            let at = BodyPlace { body: body.0, at: self.length(self.in_body(body, joint.at[1])) };
            let drawn = self.drawn(hardpoint::model::JointId(j));
            (joint.name.clone(), drawn, at, part_of(j))
        });
        let pushed = self.model.points_of_application();
        let of_points = pushed
            .iter()
            .map(|&(e, point)| (self.model.elements[e.0].name.clone(), None, self.place(point), false));
        let marks = of_joints.chain(of_points).zip(self.curves_of(loads));
        marks
            .map(|((name, joint, at, is_part), force)| LoadMark { name, joint, at, force, is_part })
            .collect()
    }

    /// Forces of another design, in the same order.
    pub(super) fn forces(&self, loads: &Loads) -> Vec<Curve> {
        if count(self.model) == 0 { Vec::new() } else { self.curves_of(loads) }
    }

    /// Curves of loads: deflections of elastic joints and bushings, and given forces that vary.
    pub(super) fn load_curves(&self, loads: &Loads) -> Vec<LoadCurve> {
        let model = self.model;
        let curve = |dimension: Dimension, value: &dyn Fn(usize) -> f64| {
            let value = |k: usize| if k < loads.times.len() { value(k) } else { f64::NAN };
            (0..self.steps.len()).map(|k| self.units.from_si(dimension, value(k))).collect()
        };
        let deflection = |(i, at): (usize, _)| {
            let (name, dimension) = deflection::curve_name(model, at);
            let round_off = self.round_off.value(dimension, 0);
            let value = |k: usize| settled(loads.deflections_at(k)[i].displacement, round_off);
            LoadCurve { name, group: "deflection", dimension, curve: curve(dimension, &value) }
        };
        let deflections = model.elastic_directions().into_iter().enumerate().map(deflection);
        let given = model.given_forces().into_iter().enumerate().filter(|(_, e)| model.varies(*e));
        let forces = given.map(|(i, e)| {
            let dimension = model.force_dimension(e);
            let value = |k: usize| loads.given_at(k)[i];
            let name = model.elements[e.0].name.clone();
            LoadCurve { name, group: "force", dimension, curve: curve(dimension, &value) }
        });
        deflections.chain(forces).collect()
    }

    /// Loads of a design at the shown output times.
    pub(super) fn solved_loads(&self, change: &[f64]) -> Loads {
        if !self.model.has_loads() {
            return Loads::default();
        }
        let times = self.steps.iter().map(|&k| self.solution.motion.times[k]).collect();
        // The analysed model has the variables of the change; the shown one may have none.
        let model = Model { times, ..self.analysis.model().clone() };
        let plan = Analysis::with(&model, self.analysis.topology().formulation);
        plan.map_or_else(|_| Loads::default(), |analysis| analysis.loads(change))
    }

    /// Three numbers per step of each force; NaN where the motion was not solved.
    fn curves_of(&self, loads: &Loads) -> Vec<Curve> {
        let (shown, solved) = (joints(self.model), loads.times.len());
        let known = |k: usize, j: usize| {
            let load = &loads.joints_at(k)[j];
            if load.known_directions == 0 { UNKNOWN } else { load.known_force }
        };
        let at = |k: usize| {
            let of_joints = shown.iter().map(move |&j| known(k, j));
            of_joints.chain(loads.pushes_at(k).iter().copied())
        };
        let forces: Vec<Vec<Vec3>> = (0..solved).map(|k| at(k).collect()).collect();
        let sizes = forces.iter().flatten().map(|f| f.norm()).filter(|size| size.is_finite());
        let round_off = ROUND_OFF * sizes.fold(0.0, f64::max);
        let curve = |i: usize| {
            let at = |k: usize| forces.get(k).map_or(UNKNOWN, |at| at[i]).to_array();
            (0..self.steps.len()).flat_map(|k| at(k).map(|x| settled(x, round_off))).collect()
        };
        (0..count(self.model)).map(curve).collect()
    }
}

const UNKNOWN: Vec3 = Vec3::new(f64::NAN, f64::NAN, f64::NAN);
