//! Construction of drafts in code: constructors, and builder methods for the most common entries.
//!
//! All other entries are fields: `draft.wheels.push(...)`.

use crate::draft::{
    BodyDraft, ChangeDraft, CurveDraft, DirectionDraft, Draft, DrivenDraft, DriverDraft, ElementDraft,
    ElementKindDraft, FrameDraft, HardpointDraft, JointDraft, LocationDraft, MeasureDraft, MeasureKindDraft,
    NumberDraft, PointDraft, PointRef, VariableDraft,
};
use crate::law::Law;
use crate::model::Solid;
use crate::space::Vec3;

/// An element with no elastic laws besides its stiffnesses along x, y and z.
macro_rules! linear {
    ($kind:ident { $($field:ident),* }) => {
        ElementKindDraft::$kind {
            $($field,)*
            about_x: None,
            about_y: None,
            about_z: None,
            matrix: None,
            cubic_x: None,
            cubic_y: None,
            cubic_z: None,
            cubic_about_x: None,
            cubic_about_y: None,
            cubic_about_z: None,
            curve_x: None,
            curve_y: None,
            curve_z: None,
            curve_about_x: None,
            curve_about_y: None,
            curve_about_z: None,
            scale_x: None,
            scale_y: None,
            scale_z: None,
            scale_about_x: None,
            scale_about_y: None,
            scale_about_z: None,
            preload_x: None,
            preload_y: None,
            preload_z: None,
            preload_about_x: None,
            preload_about_y: None,
            preload_about_z: None,
        }
    };
}

/// Builder methods, one per kind of entry. Names may be used before they are declared;
/// [`Model::from_draft`](crate::model::Model::from_draft) checks all of them.
impl Draft {
    /// Returns an empty draft with this name.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), ..Self::default() }
    }

    /// Adds a named point at a global position, m.
    pub fn hardpoint(mut self, name: impl Into<String>, position: impl Into<Vec3>) -> Self {
        self.hardpoints.push(HardpointDraft::new(name, position));
        self
    }

    /// Adds a body. A name alone represents one with the default frame.
    pub fn body(mut self, body: impl Into<BodyDraft>) -> Self {
        self.bodies.push(body.into());
        self
    }

    /// Adds several bodies.
    pub fn bodies(mut self, bodies: impl IntoIterator<Item = impl Into<BodyDraft>>) -> Self {
        self.bodies.extend(bodies.into_iter().map(Into::into));
        self
    }

    /// Adds a joint of any type; see [`JointDraft::new`].
    pub fn joint(mut self, joint: JointDraft) -> Self {
        self.joints.push(joint);
        self
    }

    /// Adds a revolute joint: body j rotates on body i about an axis through a location.
    pub fn revolute(
        self,
        name: impl Into<String>,
        bodies: [impl Into<String>; 2],
        at: impl Into<LocationDraft>,
        axis: impl Into<DirectionDraft>,
    ) -> Self {
        self.joint(JointDraft::new(name, "revolute", bodies).at(at).axis(axis))
    }

    /// Adds a translational joint: body j slides on body i along an axis.
    pub fn translational(
        self,
        name: impl Into<String>,
        bodies: [impl Into<String>; 2],
        at: impl Into<LocationDraft>,
        axis: impl Into<DirectionDraft>,
    ) -> Self {
        self.joint(JointDraft::new(name, "translational", bodies).at(at).axis(axis))
    }

    /// Adds a spherical joint: body j rotates on body i about a location.
    pub fn spherical(
        self,
        name: impl Into<String>,
        bodies: [impl Into<String>; 2],
        at: impl Into<LocationDraft>,
    ) -> Self {
        self.joint(JointDraft::new(name, "spherical", bodies).at(at))
    }

    /// Adds a rod between a location on body i and one on body j: a constraint of constant distance, not a body.
    pub fn distance(
        self,
        name: impl Into<String>,
        bodies: [impl Into<String>; 2],
        between: [impl Into<LocationDraft>; 2],
    ) -> Self {
        let [from, to] = between;
        self.joint(JointDraft::new(name, "distance", bodies).at(from).at(to))
    }

    /// Adds a driver. A joint's name represents its only coordinate, `["joint", "coordinate"]` for one of several. The
    /// law is in m or rad over s, from 0 in the design configuration.
    pub fn driver(mut self, name: impl Into<String>, drives: impl Into<DrivenDraft>, law: Law) -> Self {
        self.drivers.push(DriverDraft::new(name, drives, law));
        self
    }

    /// Adds a design variable; see [`VariableDraft::new`].
    pub fn variable(mut self, variable: VariableDraft) -> Self {
        self.design.push(variable);
        self
    }

    /// Adds a design variable, m, that moves a hardpoint with this global velocity, m per m.
    pub fn variable_moving(
        self,
        name: impl Into<String>,
        hardpoint: impl Into<String>,
        velocity: impl Into<Vec3>,
    ) -> Self {
        self.variable(VariableDraft::moving(name, hardpoint, velocity))
    }

    /// Adds a point of a body.
    pub fn point(
        mut self,
        name: impl Into<String>,
        body: impl Into<String>,
        at: impl Into<LocationDraft>,
    ) -> Self {
        self.points.push(PointDraft::new(name, body, at));
        self
    }

    /// Adds a measure. A joint's name represents its only coordinate, `["joint", "coordinate"]` for one of several.
    pub fn measure(mut self, name: impl Into<String>, kind: impl Into<MeasureKindDraft>) -> Self {
        self.measures.push(MeasureDraft::new(name, kind));
        self
    }

    /// Adds a mass or force of any type, with all its options.
    pub fn element(mut self, name: impl Into<String>, kind: ElementKindDraft) -> Self {
        let list = if kind.has_mass() { &mut self.masses } else { &mut self.forces };
        list.push(ElementDraft::new(name, kind));
        self
    }

    /// Adds a point mass, kg, at a location on a body.
    pub fn point_mass(
        self,
        name: impl Into<String>,
        body: impl Into<String>,
        at: impl Into<LocationDraft>,
        mass: impl Into<NumberDraft>,
    ) -> Self {
        self.element(name, rigid(PointRef::on(body, at), mass.into(), [None, None, None]))
    }

    /// Adds a rigid mass, kg, with its centre at a location on a body, and its moments of inertia, kg m^2, about the
    /// global axes through the centre.
    pub fn rigid(
        self,
        name: impl Into<String>,
        body: impl Into<String>,
        centre: impl Into<LocationDraft>,
        mass: impl Into<NumberDraft>,
        inertia: [impl Into<NumberDraft>; 3],
    ) -> Self {
        let inertia = inertia.map(|i| Some(i.into()));
        self.element(name, rigid(PointRef::on(body, centre), mass.into(), inertia))
    }

    /// Adds a round bar between two locations on a body, with its diameter, m, and density, kg/m^3.
    pub fn bar(
        self,
        name: impl Into<String>,
        body: &str,
        between: [impl Into<LocationDraft>; 2],
        diameter: impl Into<NumberDraft>,
        density: impl Into<NumberDraft>,
    ) -> Self {
        let [from, to] = between.map(|at| PointRef::on(body, at));
        let (diameter, density) = (diameter.into(), density.into());
        self.element(name, ElementKindDraft::Bar { from, to, diameter, bore: None, density })
    }

    /// Adds a block with its centre at a location on a body, with its edges along the global axes, m, and its density,
    /// kg/m^3.
    pub fn block(
        self,
        name: impl Into<String>,
        body: impl Into<String>,
        centre: impl Into<LocationDraft>,
        edges: [impl Into<NumberDraft>; 3],
        density: impl Into<NumberDraft>,
    ) -> Self {
        let ([x, y, z], density) = (edges.map(Into::into), density.into());
        self.element(name, ElementKindDraft::Block { centre: PointRef::on(body, centre), x, y, z, density })
    }

    /// Adds the mass of a solid on a body, with its density, kg/m^3.
    pub fn mesh(
        self,
        name: impl Into<String>,
        body: impl Into<String>,
        mesh: Solid,
        density: impl Into<NumberDraft>,
    ) -> Self {
        self.element(name, ElementKindDraft::Mesh { body: body.into(), mesh, density: density.into() })
    }

    /// Sets the acceleration of gravity, m/s^2, global.
    pub fn gravity(mut self, acceleration: impl Into<Vec3>) -> Self {
        self.gravity = acceleration.into();
        self
    }

    /// Adds a linear spring between locations on two bodies, with its stiffness in N/m. The spring has no force in the
    /// design configuration.
    pub fn spring(
        self,
        name: impl Into<String>,
        bodies: [impl Into<String>; 2],
        between: [impl Into<LocationDraft>; 2],
        stiffness: impl Into<NumberDraft>,
    ) -> Self {
        let ([i, j], [from, to]) = (bodies, between);
        let kind = ElementKindDraft::Spring {
            from: PointRef::on(i, from),
            to: PointRef::on(j, to),
            stiffness: Some(stiffness.into()),
            cubic: None,
            compression: None,
            extension: None,
            scale: None,
            free_length: None,
            preload: None,
            damping: None,
        };
        self.element(name, kind)
    }

    /// Adds a spring along the only sliding coordinate of a joint, with its stiffness in N/m. The spring has no force
    /// in the design configuration.
    pub fn joint_spring(
        self,
        name: impl Into<String>,
        joint: impl Into<String>,
        stiffness: impl Into<NumberDraft>,
    ) -> Self {
        let kind = ElementKindDraft::JointSpring {
            joint: joint.into(),
            coordinate: None,
            stiffness: stiffness.into(),
            equilibrium: None,
            curve: None,
            scale: None,
            damping: None,
        };
        self.element(name, kind)
    }

    /// Adds a spring about the axis of a joint with a single angle, with its stiffness in N m/rad. The spring has no
    /// moment in the design configuration.
    pub fn torsion_spring(
        self,
        name: impl Into<String>,
        joint: impl Into<String>,
        stiffness: impl Into<NumberDraft>,
    ) -> Self {
        let kind = ElementKindDraft::TorsionSpring {
            joint: joint.into(),
            coordinate: None,
            stiffness: stiffness.into(),
            equilibrium: None,
            curve: None,
            scale: None,
            damping: None,
        };
        self.element(name, kind)
    }

    /// Adds Coulomb friction in a hinge or ball joint, with the coefficient of friction and the radius of the pin or
    /// ball, m.
    pub fn friction(
        self,
        name: impl Into<String>,
        joint: impl Into<String>,
        coefficient: impl Into<NumberDraft>,
        radius: impl Into<NumberDraft>,
    ) -> Self {
        let kind = ElementKindDraft::Friction {
            joint: joint.into(),
            coefficient: coefficient.into(),
            radius: radius.into(),
            length: None,
            viscous: None,
            transition_velocity: None,
        };
        self.element(name, kind)
    }

    /// Adds Coulomb friction in a slide, with the coefficient of friction.
    pub fn slide_friction(
        self,
        name: impl Into<String>,
        joint: impl Into<String>,
        coefficient: impl Into<NumberDraft>,
    ) -> Self {
        let kind = ElementKindDraft::SlideFriction {
            joint: joint.into(),
            coefficient: coefficient.into(),
            length: None,
            ignored_direction: None,
            viscous: None,
            transition_velocity: None,
        };
        self.element(name, kind)
    }

    /// Adds a constant force at a location on a body: N, along a global direction of any length.
    pub fn force(
        self,
        name: impl Into<String>,
        body: impl Into<String>,
        at: impl Into<LocationDraft>,
        force: impl Into<NumberDraft>,
        along: impl Into<Vec3>,
    ) -> Self {
        let (at, force, along) = (PointRef::on(body, at), force.into(), along.into());
        self.element(name, ElementKindDraft::PointForce { at, force, along, axes: None, law: None })
    }

    /// Adds a constant moment on a body: N m, about a global direction of any length.
    pub fn moment(
        self,
        name: impl Into<String>,
        body: impl Into<String>,
        moment: impl Into<NumberDraft>,
        about: impl Into<Vec3>,
    ) -> Self {
        let (body, moment, about) = (body.into(), moment.into(), about.into());
        self.element(name, ElementKindDraft::BodyMoment { body, moment, about, axes: None, law: None })
    }

    /// Adds a constant force of the road on a wheel, N: outboard, forward and up.
    pub fn wheel_force(
        self,
        name: impl Into<String>,
        wheel: impl Into<String>,
        force: [impl Into<NumberDraft>; 3],
    ) -> Self {
        let (wheel, [outboard, forward, up]) = (wheel.into(), force.map(|f| Some(f.into())));
        let (at, about_up, law) = (None, None, None);
        self.element(name, ElementKindDraft::WheelForce { wheel, at, outboard, forward, up, about_up, law })
    }

    /// Adds a tyre under a wheel, with its vertical stiffness, N/m. It has no load in the design configuration.
    pub fn tyre(
        self,
        name: impl Into<String>,
        wheel: impl Into<String>,
        stiffness: impl Into<NumberDraft>,
    ) -> Self {
        let (wheel, stiffness) = (wheel.into(), stiffness.into());
        let (preload, height, law) = (None, None, None);
        self.element(name, ElementKindDraft::Tyre { wheel, stiffness, preload, height, law })
    }

    /// Adds a bushing between locations on two bodies, with its stiffnesses along the global axes, N/m.
    pub fn bushing(
        self,
        name: impl Into<String>,
        bodies: [impl Into<String>; 2],
        between: [impl Into<LocationDraft>; 2],
        stiffness: [impl Into<NumberDraft>; 3],
    ) -> Self {
        let ([i, j], [from, to], [x, y, z]) = (bodies, between, stiffness.map(Into::into));
        let (from, to, damping) = (PointRef::on(i, from), PointRef::on(j, to), None);
        let (axis, axis2) = (None, None);
        self.element(name, linear!(Bushing { from, to, axis, axis2, x, y, z, damping }))
    }

    /// Adds the compliance of a joint, with its stiffnesses along the joint's axes, N/m, z along its axis.
    pub fn elastic_joint(
        self,
        name: impl Into<String>,
        joint: impl Into<String>,
        stiffness: [impl Into<NumberDraft>; 3],
    ) -> Self {
        let [x, y, z] = stiffness.map(|k| Some(k.into()));
        let joint = joint.into();
        self.element(name, linear!(ElasticJoint { joint, x, y, z }))
    }

    /// Adds output times, s.
    pub fn times(mut self, times: impl IntoIterator<Item = f64>) -> Self {
        self.times.extend(times);
        self
    }
}

/// Rigid mass with these moments of inertia.
fn rigid(centre: PointRef, mass: NumberDraft, [ixx, iyy, izz]: [Option<NumberDraft>; 3]) -> ElementKindDraft {
    let [ixy, iyz, izx] = [None, None, None];
    ElementKindDraft::Rigid { centre, mass, ixx, iyy, izz, ixy, iyz, izx, about: None }
}

impl PointRef {
    /// Returns a reference to the point of a body at a location.
    pub fn on(body: impl Into<String>, at: impl Into<LocationDraft>) -> Self {
        Self::On { body: body.into(), at: at.into() }
    }
}

/// Builder methods of a joint.
///
/// ```
/// # use hardpoint::draft::*;
/// // A screw that advances by 20 mm per turn, on the line between two hardpoints, as a cut joint.
/// let screw = JointDraft::new("screw", "screw", ["shaft", "nut"]).at("A").axis(["A", "B"]).lead(0.02).cut();
/// assert_eq!(screw.axis, Some(DirectionDraft::Through("A".into(), "B".into())));
/// ```
impl JointDraft {
    /// Returns a joint between bodies i and j (`ground` is one); `kind` is the name of a type of
    /// [`ALL`](crate::joint::ALL).
    pub fn new(name: impl Into<String>, kind: &str, bodies: [impl Into<String>; 2]) -> Self {
        Self { name: name.into(), kind: kind.into(), bodies: bodies.map(Into::into), ..Self::default() }
    }

    /// Adds a location: the only one, or the next of two.
    pub fn at(mut self, place: impl Into<LocationDraft>) -> Self {
        self.at.push(place.into());
        self
    }

    /// Sets the direction of the markers' z axis.
    pub fn axis(self, axis: impl Into<DirectionDraft>) -> Self {
        Self { axis: Some(axis.into()), ..self }
    }

    /// Sets the direction of the markers' x axis.
    pub fn axis2(self, axis: impl Into<DirectionDraft>) -> Self {
        Self { axis2: Some(axis.into()), ..self }
    }

    /// Sets the length of a rod, or the distance of a follower from its curve, m.
    pub fn length(self, length: f64) -> Self {
        Self { length: Some(length), ..self }
    }

    /// Sets the advance of a screw, m per turn.
    pub fn lead(self, lead: f64) -> Self {
        Self { lead: Some(lead), ..self }
    }

    /// Sets the curve on body i that a point of body j follows.
    pub fn curve(self, points: impl IntoIterator<Item = impl Into<LocationDraft>>, closed: bool) -> Self {
        let points = points.into_iter().map(Into::into).collect();
        Self { curve: Some(CurveDraft { points, closed }), ..self }
    }

    /// Makes the joint a cut joint instead of a tree joint.
    pub fn cut(self) -> Self {
        Self { cut: true, ..self }
    }
}

impl HardpointDraft {
    /// Returns a named point at a global position, m.
    pub fn new(name: impl Into<String>, position: impl Into<Vec3>) -> Self {
        Self { name: name.into(), position: position.into() }
    }
}

impl BodyDraft {
    /// Returns a body with the default frame.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), frame: FrameDraft::Default }
    }
}

impl DriverDraft {
    /// Returns a driver. A joint's name represents its only coordinate, `["joint", "coordinate"]` for one of several.
    pub fn new(name: impl Into<String>, drives: impl Into<DrivenDraft>, law: Law) -> Self {
        let (from_zero, reversed, unit) = (false, false, "");
        Self { name: name.into(), drives: drives.into(), from_zero, reversed, law, unit }
    }
}

impl PointDraft {
    /// Returns a point of a body.
    pub fn new(name: impl Into<String>, body: impl Into<String>, at: impl Into<LocationDraft>) -> Self {
        Self { name: name.into(), body: body.into(), at: at.into() }
    }
}

impl MeasureDraft {
    /// Returns a measure. A joint's name represents its only coordinate, `["joint", "coordinate"]` for one of several.
    pub fn new(name: impl Into<String>, kind: impl Into<MeasureKindDraft>) -> Self {
        Self { name: name.into(), kind: kind.into() }
    }
}

impl VariableDraft {
    /// Returns a design variable with its changes.
    pub fn new(name: impl Into<String>, changes: impl Into<Vec<ChangeDraft>>) -> Self {
        Self { name: name.into(), changes: changes.into(), ..Self::default() }
    }

    /// Returns a design variable, m, that moves a hardpoint with this global velocity, m per m.
    pub fn moving(name: impl Into<String>, hardpoint: impl Into<String>, velocity: impl Into<Vec3>) -> Self {
        Self::new(name, [ChangeDraft::Move { hardpoint: hardpoint.into(), velocity: velocity.into() }])
    }
}

/// Body with the default frame.
impl From<&str> for BodyDraft {
    fn from(name: &str) -> Self {
        Self::new(name)
    }
}

/// Hardpoint, by name.
impl From<&str> for LocationDraft {
    fn from(hardpoint: &str) -> Self {
        Self::Hardpoint(hardpoint.into())
    }
}

/// Global coordinates, m.
impl From<[f64; 3]> for LocationDraft {
    fn from(position: [f64; 3]) -> Self {
        Self::At(position.into())
    }
}

/// Global coordinates, m.
impl From<Vec3> for LocationDraft {
    fn from(position: Vec3) -> Self {
        Self::At(position)
    }
}

/// Direction along a global vector of any length.
impl From<[f64; 3]> for DirectionDraft {
    fn from(direction: [f64; 3]) -> Self {
        Self::Along(direction.into())
    }
}

/// Direction along a global vector of any length.
impl From<Vec3> for DirectionDraft {
    fn from(direction: Vec3) -> Self {
        Self::Along(direction)
    }
}

/// Direction from one named hardpoint to another.
impl From<[&str; 2]> for DirectionDraft {
    fn from([from, to]: [&str; 2]) -> Self {
        Self::Through(from.into(), to.into())
    }
}

/// Only coordinate of a joint.
impl From<&str> for DrivenDraft {
    fn from(joint: &str) -> Self {
        Self::Coordinate { joint: joint.into(), coordinate: None }
    }
}

/// Joint and one of its coordinates.
impl From<[&str; 2]> for DrivenDraft {
    fn from([joint, coordinate]: [&str; 2]) -> Self {
        Self::Coordinate { joint: joint.into(), coordinate: Some(coordinate.into()) }
    }
}

/// Only coordinate of a joint.
impl From<&str> for MeasureKindDraft {
    fn from(joint: &str) -> Self {
        Self::Coordinate { joint: joint.into(), coordinate: None }
    }
}

/// Joint and one of its coordinates.
impl From<[&str; 2]> for MeasureKindDraft {
    fn from([joint, coordinate]: [&str; 2]) -> Self {
        Self::Coordinate { joint: joint.into(), coordinate: Some(coordinate.into()) }
    }
}
