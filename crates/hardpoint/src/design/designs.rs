//! Designs of a model: their geometry, and the effect of each variable.

use crate::law::Law;
use crate::model::{Joint, Model, VariableId};
use crate::space::{Mat3, Vec3, euler_313_from_rotation, rotation_from_euler_313};

use super::{DesignMap, DesignVelocity, Geometry, MarkerVelocity};

impl Model {
    /// Returns the geometry of the design with variable k at `design[k]` (missing entries are 0).
    ///
    /// Body frames are fixed in the design configuration; markers move on their bodies.
    pub fn geometry(&self, design: &[f64]) -> Geometry {
        DesignMap::of(self).geometry(&self.whole(design))
    }

    /// Returns the global positions of the hardpoints of such a design, m.
    pub fn hardpoint_places(&self, design: &[f64]) -> Vec<Vec3> {
        DesignMap::of(self).places(&self.whole(design))
    }

    /// Returns the first-order change of the nominal design per unit of one variable.
    pub fn field(&self, variable: VariableId) -> DesignVelocity {
        DesignMap::of(self).field(variable, &self.whole(&[]))
    }

    /// Returns the first-order changes of a design per unit of each variable.
    pub fn fields(&self, design: &[f64]) -> Vec<DesignVelocity> {
        DesignMap::of(self).fields(&self.whole(design))
    }

    /// Returns the natural step of a variable: the change that moves the farthest marker by the size of the mechanism,
    /// or rotates it by 1 rad. If the variable moves no marker, the size itself.
    ///
    /// Steps and tolerances are relative to it, so that they are comparable for all variables and models.
    pub fn natural_step(&self, variable: VariableId) -> f64 {
        let size = self.size();
        let geometry = self.geometry(&[]);
        let speed = |m: &MarkerVelocity| {
            let s = geometry.markers[m.joint.0][m.end].r;
            // max(abs(R U), abs(V) / size),  V = e_v + e_w x s
            m.twist.w.norm().max(m.twist.at(s).norm() / size)
        };
        let fastest = self.field(variable).markers.iter().map(speed).fold(0.0, f64::max);
        if fastest > 0.0 { 1.0 / fastest } else { size }
    }

    /// Returns the variables without an effect on the motion or its results.
    pub fn without_effect(&self) -> Vec<VariableId> {
        let design_map = DesignMap::of(self);
        let directions = self.measures.iter().flat_map(|m| self.directions(m)).flatten();
        let of_forces =
            self.elements.iter().filter_map(|e| e.kind.force(self)).flat_map(|f| f.axes).flatten();
        let followed = directions.map(|(_, axis)| axis).chain(of_forces).filter_map(|axis| axis.hardpoints());
        let seen: Vec<usize> = followed.flatten().map(|h| h.0).collect();
        let is_idle = |v: &VariableId| {
            let affected = design_map.affected(&[(*v, 1.0)]);
            let felt = [&affected.joints, &affected.points, &affected.law_formulas];
            felt.iter().all(|list| list.is_empty())
                && affected.laws.is_empty()
                && affected.numbers.is_empty()
                && !affected.hardpoints.iter().any(|h| seen.contains(h))
        };
        (0..self.variables.len()).map(VariableId).filter(is_idle).collect()
    }

    /// Returns a value for every variable: 0 except for one.
    pub fn alone(&self, variable: VariableId, value: f64) -> Vec<f64> {
        let mut design = self.whole(&[]);
        design[variable.0] = value;
        design
    }

    /// Returns a value for every variable: the given ones, then 0.
    pub fn whole(&self, design: &[f64]) -> Vec<f64> {
        let given = design.iter().copied().chain(std::iter::repeat(0.0));
        given.take(self.variables.len()).collect()
    }

    /// Returns the drivers' laws in the design with variable k at `design[k]` (missing entries are 0).
    pub fn laws(&self, design: &[f64]) -> Vec<Law> {
        DesignMap::of(self).laws(&self.whole(design))
    }

    /// Returns the 3-1-3 Euler angles of a marker in its body's frame, rad, and their rotation C(theta).
    pub(super) fn euler_of(&self, joint: &Joint, e: usize) -> ([f64; 3], Mat3) {
        // C = A^T (A C), theta of C = Rz(theta1) Rx(theta2) Rz(theta3)                                      (paper 2.2)
        let in_body = self.bodies[joint.bodies[e].0].frame.rot.transpose() * joint.frames[e];
        let theta = euler_313_from_rotation(in_body);
        (theta, rotation_from_euler_313(theta))
    }
}
