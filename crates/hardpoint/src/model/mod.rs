//! The mechanism as the user means it: named, checked, in SI units and radians.
//!
//! [`Model::from_draft`] makes it of a [`Draft`](crate::draft::Draft). A model never changes; a changed design is a
//! [`Geometry`](crate::design::Geometry) made from it.

mod calibrating;
mod case;
pub mod change;
mod coupler;
mod curve;
pub mod element;
mod formula;
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
mod wheel;

pub use calibrating::{CalibrationSettings, Offset, OffsetSource, PriorGroup, VariablePrior};
pub use case::{Case, Grid, LoadMode};
pub use change::{Change, ChangeText, End};
pub use coupler::{Coupler, CouplerTerm, Transmission};
pub(crate) use curve::Contact;
pub use curve::{CURVE_PIECE, Curve, CurvePiece, CurvePoint};
pub use element::{
    Angle, Axes, CoupledStiffness, Coupling, CubicStiffness, CubicTorsionalStiffness, Damping, Density,
    ENDS_MEET, Element, ElementId, ElementKind, ElementNumber, ElementUnit, Force, Inertia, Length, Mass,
    Moment, NumberId, Plain, Stiffness, TorsionalDamping, TorsionalStiffness, WheelPoint,
};
pub(crate) use element::{each_number, elements, if_mass};
pub use formula::{Formula, NamedNumber, Source, Target};
pub use joint_limit::{JointLimit, LimitEnd};
pub use measure::{
    Combination, Dimension, ElasticDirection, ElasticId, JacobianValue, KnownOrders, Measure, MeasureKind,
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
pub use wheel::{
    ArmPlane, Axle, AxleMeasure, AxleMotion, Side, TorqueReaction, Vehicle, VehicleEnd, Wheel, WheelMeasure,
    WheelRequirement,
};

use crate::constraint::MarkerPair;
use crate::joint::{CoordinateType, JointType, Need, Quantity};
use crate::law::Law;
use crate::space::{Mat3, Pose, Real, Vec3};

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub usize);
    )*};
}

ids! {
    /// A hardpoint's place in [`Model::hardpoints`].
    HardpointId
    /// A parameter's place in [`Model::parameters`].
    ParameterId
    /// A body's place in [`Model::bodies`]; 0 is ground.
    BodyId
    /// A joint's place in [`Model::joints`].
    JointId
    /// A driver's place in [`Model::drivers`].
    DriverId
    /// A design variable's place in [`Model::variables`].
    VariableId
    /// A body point's place in [`Model::points`].
    PointId
    /// A wheel's place in [`Model::wheels`].
    WheelId
    /// An axle's place in [`Model::axles`].
    AxleId
    /// A shape's place in [`Model::shapes`].
    ShapeId
    /// A clearance's place in [`Model::clearances`].
    ClearanceId
    /// A measure's place in [`Model::measures`].
    MeasureId
    /// A case's place in [`Model::cases`].
    CaseId
}

/// The body that does not move.
pub const GROUND: BodyId = BodyId(0);

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

/// A named point of the design configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Hardpoint {
    /// Name, or that of the joint or point that gave its coordinates.
    pub name: String,
    /// Global position in the design configuration, m.
    pub position: Vec3,
    /// True if coordinates were written where a hardpoint's name could stand.
    pub unnamed: bool,
}

/// A rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Name.
    pub name: String,
    /// Reference frame x'-y'-z' in the design configuration; a design change leaves it there.
    pub frame: Pose,
}

/// Direction of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Direction {
    /// A fixed direction, unit length.
    Along(Vec3),
    /// From one hardpoint to another; follows them when the design moves them.
    Through(HardpointId, HardpointId),
}

/// A joint between two bodies.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Name.
    pub name: String,
    /// Type.
    pub kind: &'static JointType,
    /// The bodies i and j; coordinates are those of j relative to i.
    pub bodies: [BodyId; 2],
    /// The hardpoints of marker i and marker j (the same one unless the joint has two places).
    pub at: [HardpointId; 2],
    /// Direction of the markers' z axis, if the joint has one.
    pub axis: Option<Direction>,
    /// Direction of the markers' x axis, if the joint has one.
    pub axis2: Option<Direction>,
    /// Orientation of marker i and marker j in the world, in the design configuration; the same unless the joint type
    /// has its second axis on body j.
    pub frames: [Mat3; 2],
    /// Length of a rod, or a follower's distance from its curve, that is given by itself rather than by the hardpoints,
    /// m.
    pub length: Option<f64>,
    /// The curve that a point follows, in the frame of marker i.
    pub curve: Option<Curve>,
    /// True if the user asks for it to be cut.
    pub cut: bool,
    /// True if it only carries a driver on something that is no joint's coordinate; it has the driver's name.
    pub unnamed: bool,
}

/// A prescribed motion of one joint coordinate, measured from the design configuration.
#[derive(Clone, Debug)]
pub struct Driver {
    /// Name.
    pub name: String,
    /// The joint that it drives.
    pub joint: JointId,
    /// Index of the coordinate in the joint's type.
    pub coordinate: usize,
    /// The driver's value over time, m or rad: the coordinate, or its opposite if the driver is reversed.
    pub law: Law,
    /// True if the coordinate moves in the opposite sense of the driver's values.
    pub is_reversed: bool,
}

impl Driver {
    /// Turns a change of the coordinate into that of the driver's value, and back: both count from the design
    /// configuration, and are opposite if the driver is reversed.
    pub fn with_sense<T: Real>(&self, change: T) -> T {
        if self.is_reversed { -change } else { change }
    }

    /// Law of the coordinate, m or rad; that of the driver's values is [`law`](Self::law).
    pub fn coordinate_law(&self) -> Law {
        if self.is_reversed { self.law.clone().reversed() } else { self.law.clone() }
    }
}

/// One scalar b (the paper's tau) that the design depends on; nominal value 0.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignVariable {
    /// Name.
    pub name: String,
    /// Quantity of b: m, rad, or a plain number.
    pub quantity: Quantity,
    /// Changes of the design per unit of b.
    pub changes: Vec<Change>,
    /// True if rods keep their lengths while it moves their ends.
    pub fixed_length: bool,
    /// Between which values b may lie, in the unit of b; 0 lies between them.
    pub bounds: Option<[f64; 2]>,
    /// Typical size of a change of b, in its unit; positive.
    pub typical: Option<f64>,
    /// Symmetric manufacturing tolerance of b, in its unit; positive.
    pub tolerance: Option<f64>,
}

/// A body, or two that slide on each other, that can spin about a line without moving anything else. The spin is held
/// at rest: one of its balls is treated as a universal joint.
#[derive(Clone, Debug, PartialEq)]
pub struct IdleRotation {
    /// The bodies that spin together.
    pub bodies: Vec<BodyId>,
    /// The spherical joint that holds the spin.
    pub joint: JointId,
    /// The line's direction in the design configuration.
    pub axis: Vec3,
}

/// Static equilibrium at every output time: elastic joints open and some drivers move, until no force remains.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Equilibrium {
    /// Drivers that are not held: the forces on the mechanism determine their values.
    pub released: Vec<DriverId>,
}

/// A point fixed in a body.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyPoint {
    /// Name, or that of the driver, wheel or measure that it serves.
    pub name: String,
    /// The body that carries it.
    pub body: BodyId,
    /// Location in the design configuration; the point follows a named hardpoint.
    pub at: HardpointId,
    /// True if it was only written inside one of those.
    pub unnamed: bool,
}

/// Joints nearer to each other than this part of the mechanism's size are at one place.
const ONE_PLACE: f64 = 1e-12;

/// Behaviour at a change point, where two motions of a mechanism meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ChangePointPolicy {
    /// The motion ends there (HP0402).
    #[default]
    Stop,
    /// It goes on as the one of the two motions that continues it smoothly; where neither does, it ends.
    Continue,
}

impl ChangePointPolicy {
    /// All of them, with the words of model files.
    pub const WORDS: [(&'static str, Self); 2] = [("stop", Self::Stop), ("continue", Self::Continue)];
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

impl Direction {
    /// The hardpoints that it follows, from one to the other.
    pub fn hardpoints(self) -> Option<[HardpointId; 2]> {
        match self {
            Self::Along(_) => None,
            Self::Through(a, b) => Some([a, b]),
        }
    }
}

impl Joint {
    /// The hardpoints that it follows: those that it is at, and those that its axes pass through.
    pub(crate) fn hardpoints(&self) -> impl Iterator<Item = HardpointId> {
        let axes = [self.axis, self.axis2].into_iter().flatten();
        self.at.into_iter().chain(axes.flat_map(|axis| axis.hardpoints().into_iter().flatten()))
    }

    /// The directions of z and x of marker e, as far as they are given.
    pub(crate) fn axes_of_marker(&self, e: usize) -> [Option<Direction>; 2] {
        match (self.kind.axis2, e) {
            (Need::OnBodyJ, 0) => [self.axis, None],
            (Need::OnBodyJ, _) => [self.axis2, None],
            _ => [self.axis, self.axis2],
        }
    }
}

/// The box around some points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    low: Vec3,
    high: Vec3,
}

impl Extent {
    pub fn of(points: impl Iterator<Item = Vec3>) -> Self {
        let low = Vec3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY);
        let mut extent = Self { low, high: -low };
        points.for_each(|p| extent.include(p));
        extent
    }

    pub fn include(&mut self, p: Vec3) {
        let (low, high) = (self.low, self.high);
        self.low = Vec3::new(low.x.min(p.x), low.y.min(p.y), low.z.min(p.z));
        self.high = Vec3::new(high.x.max(p.x), high.y.max(p.y), high.z.max(p.z));
    }

    /// Diagonal; 1 where that is no length to compare with.
    pub fn size(&self) -> f64 {
        let size = self.size_or_zero();
        if size > 0.0 { size } else { 1.0 }
    }

    /// Diagonal; 0 where there is no point, or none that is finite, or where they coincide up to round-off: their
    /// differences have no significant digits then.
    pub fn size_or_zero(&self) -> f64 {
        let size = (self.high - self.low).norm();
        let far = f64::max(self.low.norm(), self.high.norm());
        if size.is_finite() && self.low.x <= self.high.x && size > ONE_PLACE * far { size } else { 0.0 }
    }
}
