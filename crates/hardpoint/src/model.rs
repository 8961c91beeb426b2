//! The mechanism as the user means it: named, checked, in SI units and radians.
//!
//! [`Model::from_draft`] makes it of a [`Draft`](crate::draft::Draft). A model never changes; a changed design is a
//! [`Geometry`](crate::design::Geometry) made from it.

mod body;
mod calibrating;
mod case;
pub mod change;
mod change_point;
mod coupler;
mod curve;
mod dimension;
mod driver;
pub mod element;
mod element_number;
mod extent;
mod formula;
mod id;
mod joint;
mod joint_limit;
mod measure;
mod measured;
mod metric;
mod optimization;
mod page;
mod placement;
mod shape;
mod shared;
mod solid;
mod spring_table;
mod sweeping;
mod tolerancing;
mod variable;
mod wheel;

pub use body::{Body, BodyPoint, Hardpoint, IdleRotation};
pub use calibrating::{CalibrationSettings, Offset, OffsetSource, PriorGroup, VariablePrior};
pub use case::{Case, Grid, LoadMode};
pub use change::{Change, ChangeText, End};
pub use change_point::ChangePointPolicy;
pub use coupler::{Coupler, CouplerTerm, Transmission};
pub(crate) use curve::Contact;
pub use curve::{CURVE_PIECE, Curve, CurvePiece, CurvePoint};
pub use dimension::Dimension;
pub use driver::{Driver, Equilibrium};
pub use element::{
    Angle, Axes, CoupledStiffness, Coupling, CubicStiffness, CubicTorsionalStiffness, Damping, Density,
    ENDS_MEET, Element, ElementId, ElementKind, ElementUnit, Force, Inertia, Length, Mass, Moment, Plain,
    Stiffness, TorsionalDamping, TorsionalStiffness, WheelPoint,
};
pub(crate) use element::{each_number, elements, if_mass};
pub use element_number::{ElementNumber, NumberId};
pub(crate) use extent::Extent;
pub use formula::{Formula, NamedNumber, Source, Target};
pub use id::{
    AxleId, BodyId, CaseId, ClearanceId, DriverId, GROUND, HardpointId, JointId, MeasureId, ParameterId,
    PointId, ShapeId, VariableId, WheelId,
};
pub use joint::{Direction, Joint};
pub use joint_limit::{JointLimit, LimitEnd};
pub use measure::{
    Combination, ElasticDirection, ElasticId, JacobianValue, KnownOrders, Measure, MeasureKind,
    OrientationAngle, OutputSource, Ray, ReactionPart,
};
pub(crate) use measure::{UnitForce, loads, measures, of_bodies, of_bodies_but_joints};
pub use measured::{Measurements, Reading};
pub(crate) use metric::on_target;
pub use metric::{
    CurvePart, Metric, PathIntegral, Reduction, ReductionArguments, ReductionKeys, ReductionType,
    ReductionUnit,
};
pub use optimization::{Goal, Limit, LimitTarget, OptimizationSettings};
pub use page::{NamedDesign, Plot};
pub use placement::StartPlacement;
pub(crate) use shape::with_core;
pub use shape::{Clearance, Shape, ShapeKind, ShapePair};
pub use shared::SharedModel;
pub(crate) use solid::about_centre;
pub use solid::{OpenSurface, Solid};
pub use spring_table::{MomentTable, SpringTable};
pub use sweeping::{SweepMethod, SweepRange, SweepSettings};
pub use tolerancing::{
    AllocationRule, AllocationSettings, Correlation, Scatter, Tolerance, ToleranceSettings,
};
pub use variable::DesignVariable;
pub use wheel::{
    ArmPlane, Axle, AxleMeasure, AxleMotion, Side, TorqueReaction, Vehicle, VehicleEnd, Wheel, WheelMeasure,
    WheelRequirement,
};

use crate::constraint::MarkerPair;
use crate::joint::CoordinateType;
use crate::space::{Mat3, Pose, Vec3};
use extent::ONE_PLACE;

/// A checked mechanism: every reference is an id, every axis a direction, every name unique.
#[derive(Clone, Debug)]
pub struct Model {
    /// Name.
    pub name: String,
    /// Named numbers for formulas, in the order of the file.
    pub parameters: Vec<NamedNumber>,
    /// Formulas over the design variables, each after those whose results it uses.
    pub formulas: Vec<Formula>,
    /// Named points of the design configuration, then the unnamed ones that joints and points gave.
    pub hardpoints: Vec<Hardpoint>,
    /// Ground, then the bodies.
    pub bodies: Vec<Body>,
    /// Joints, in the order of the file, then the unnamed ones that carry a driver.
    pub joints: Vec<Joint>,
    /// Couplers, in the order of the file, then those of the screws.
    pub couplers: Vec<Coupler>,
    /// Drivers, in the order of the file.
    pub drivers: Vec<Driver>,
    /// Placements at which the assembly starts, of bodies that do not start in the design configuration.
    pub start: Vec<StartPlacement>,
    /// Design variables, in the order of the file.
    pub variables: Vec<DesignVariable>,
    /// Body-fixed points to follow; those that only a driver, wheel or measure names come last, unnamed.
    pub points: Vec<BodyPoint>,
    /// The vehicle that the wheels belong to, as far as it is known.
    pub vehicle: Vehicle,
    /// Road wheels, in the order of the file.
    pub wheels: Vec<Wheel>,
    /// Pairs of them, in the order of the file.
    pub axles: Vec<Axle>,
    /// Shapes of bodies, in the order of the file.
    pub shapes: Vec<Shape>,
    /// Clearances between them, in the order of the file.
    pub clearances: Vec<Clearance>,
    /// Masses, then forces, in the order of the file.
    pub elements: Vec<Element>,
    /// The numbers that shapes, masses and forces are given.
    pub numbers: Vec<ElementNumber>,
    /// Acceleration of gravity, m/s^2, global.
    pub gravity: Vec3,
    /// Loads with or without inertia.
    pub load_mode: LoadMode,
    /// Equilibrium of elastic joints and released drivers, if they open under load.
    pub equilibrium: Option<Equilibrium>,
    /// Measures, in the order of the file.
    pub measures: Vec<Measure>,
    /// Limits of joints, in the order of the file.
    pub joint_limits: Vec<JointLimit>,
    /// Metrics, in the order of the file.
    pub metrics: Vec<Metric>,
    /// Idle spins, which are held at rest.
    pub idle: Vec<IdleRotation>,
    /// Output times, s, increasing.
    pub times: Vec<f64>,
    /// Behaviour at change points.
    pub at_change_points: ChangePointPolicy,
    /// Motions, in the order of the file; where there are none, that of the drivers' own laws at `times` is the only
    /// one.
    pub cases: Vec<Case>,
    /// Cases that sweep two drivers over a grid, in the order of the file.
    pub grids: Vec<Grid>,
    /// Settings of the optimisation, if the file has them.
    pub optimization: Option<OptimizationSettings>,
    /// Settings of the tolerance study, if the file has more than the tolerances of its variables.
    pub tolerancing: Option<ToleranceSettings>,
    /// Settings of the sweep, if the file has them.
    pub sweeping: Option<SweepSettings>,
    /// Settings of the calibration, if the file has them.
    pub calibrating: Option<CalibrationSettings>,
    /// Plots that a page opens with, in the order of the file; by default those that suit the mechanism.
    pub plots: Vec<Plot>,
    /// Named designs, in the order of the file.
    pub designs: Vec<NamedDesign>,
}

impl Model {
    /// Position of a hardpoint in the nominal design, m.
    pub(crate) fn position(&self, h: HardpointId) -> Vec3 {
        self.hardpoints[h.0].position
    }

    /// The joint coordinate that a driver prescribes.
    pub fn driven(&self, driver: &Driver) -> &'static CoordinateType {
        &self.joints[driver.joint.0].kind.coordinates[driver.coordinate]
    }

    /// The joint coordinate of a coupler's term.
    pub fn coupled(&self, term: &CouplerTerm) -> &'static CoordinateType {
        &self.joints[term.joint.0].kind.coordinates[term.coordinate]
    }

    /// Marker e (0 for i, 1 for j) of a joint in the world, in the design configuration.
    pub(crate) fn marker(&self, joint: JointId, e: usize) -> Pose {
        let j = &self.joints[joint.0];
        Pose { rot: j.frames[e], r: self.position(j.at[e]) }
    }

    /// The markers of a joint in the world, in the design configuration; on a curve next to the point that follows it.
    pub(crate) fn ends(&self, joint: JointId) -> MarkerPair<f64> {
        let [mut i, j] = [0, 1].map(|e| self.marker(joint, e));
        if let Some(curve) = &self.joints[joint.0].curve {
            i = i.compose(Contact::at(curve, curve.start()).frame());
        }
        MarkerPair { i, j, axes: Mat3::IDENTITY }
    }

    /// Joints that a person wrote.
    pub fn named_joints(&self) -> impl Iterator<Item = (JointId, &Joint)> {
        self.joints.iter().enumerate().filter(|(_, j)| !j.unnamed).map(|(k, j)| (JointId(k), j))
    }

    /// The size of the mechanism, m: the diagonal of the box around its joints, and in an equilibrium the points of
    /// application of its forces; around all hardpoints if that is 0, and 1 if that is 0 as well.
    ///
    /// Lengths are compared with it wherever a tolerance must not depend on the units of the model, nor on places that
    /// have nothing to do with its motion; within a loop the loop's own size counts.
    pub fn size(&self) -> f64 {
        let joints = self.joints.iter().flat_map(|j| j.at.map(|m| self.position(m)));
        // Springs and bushings hold a mechanism in equilibrium, as joints do.
        let forces = self.elements.iter().filter(|_| self.equilibrium.is_some());
        let points = forces.filter_map(|e| e.kind.force(self)).flat_map(|force| force.acts_on.points(self));
        let points = points.flatten().map(|p| self.position(self.points[p.0].at));
        let size = Extent::of(joints.chain(points)).size_or_zero();
        if size > 0.0 { size } else { Extent::of(self.hardpoints.iter().map(|h| h.position)).size() }
    }

    /// Returns whether a joint is drawn open: its two places lie apart, or its rod is given another length than that
    /// between them.
    pub fn is_drawn_open(&self) -> bool {
        let near = ONE_PLACE * self.size();
        self.joints.iter().filter(|joint| joint.curve.is_none()).any(|joint| {
            let [p, q] = joint.at.map(|h| self.position(h));
            let apart = (q - p).norm();
            match joint.length {
                Some(length) => (length - apart).abs() > near,
                None => !joint.kind.is_rod() && apart > near,
            }
        })
    }

    /// The shortest distance between two joints of a body, m: what must be exact for the motion to be that of the
    /// mechanism. Places that are one but for round-off have none. The mechanism's size where there is no such
    /// distance.
    pub fn shortest(&self) -> f64 {
        let size = self.size();
        let mut shortest = size;
        for body in 0..self.bodies.len() {
            let of_body = |joint: &&Joint| joint.bodies.iter().any(|b| b.0 == body);
            let places: Vec<Vec3> = self
                .joints
                .iter()
                .filter(of_body)
                .map(|joint| self.position(joint.at[usize::from(joint.bodies[0].0 != body)]))
                .collect();
            for (k, p) in places.iter().enumerate() {
                for q in &places[..k] {
                    let apart = (*p - *q).norm();
                    if apart > ONE_PLACE * size && apart < shortest {
                        shortest = apart;
                    }
                }
            }
        }
        shortest
    }

    /// Distance of the nearest joint from the global origin, m; 0 without joints.
    pub fn distance_from_origin(&self) -> f64 {
        let joints = self.joints.iter().flat_map(|j| j.at.map(|m| self.position(m).norm()));
        let nearest = joints.fold(f64::INFINITY, f64::min);
        if nearest.is_finite() { nearest } else { 0.0 }
    }

    /// The variable of that name.
    pub fn variable(&self, name: &str) -> Option<VariableId> {
        self.variables.iter().position(|v| v.name == name).map(VariableId)
    }

    /// The body of that name.
    pub fn body(&self, name: &str) -> Option<BodyId> {
        self.bodies.iter().position(|b| b.name == name).map(BodyId)
    }

    /// The measure of that name.
    pub fn measure(&self, name: &str) -> Option<MeasureId> {
        self.measures.iter().position(|m| m.name == name).map(MeasureId)
    }

    /// The point of that name.
    pub fn point(&self, name: &str) -> Option<PointId> {
        self.points.iter().position(|p| !p.unnamed && p.name == name).map(PointId)
    }
}
