//! Common representation of all formats: bodies, joints, couplers and drivers in the design configuration. Importers
//! fill it; one writer creates the model file.

use std::collections::{HashMap, HashSet};

use hardpoint::joint;
use hardpoint::joint::JointType;
use hardpoint::model::{Vehicle, VehicleEnd};
use hardpoint::space::{Mat3, Pose, Vec3};

/// Index of the ground body, the first body of every mechanism.
pub const GROUND: usize = 0;

/// Imported mechanism. Coordinates are global, in the units that it names.
#[derive(Clone, Debug)]
pub struct Mechanism {
    /// Name, for headings.
    pub name: String,
    /// Unit of every length, as model files name it.
    pub length: &'static str,
    /// Unit of every angle, as model files name it.
    pub angle: &'static str,
    /// Named points of the source, whether a joint is there or not.
    pub hardpoints: Vec<(String, Vec3)>,
    /// Bodies; the first is ground.
    pub bodies: Vec<Body>,
    /// Joints.
    pub joints: Vec<Joint>,
    /// Couplers: linear relations of joint coordinates.
    pub couplers: Vec<Coupler>,
    /// Drivers.
    pub drivers: Vec<Driver>,
    /// Points whose motion is measured.
    pub points: Vec<Point>,
    /// Road wheels.
    pub wheels: Vec<Wheel>,
    /// Parameters of the vehicle; lengths are in the unit of the mechanism.
    pub vehicle: Vehicle,
    /// Index of the driver that steers the wheels.
    pub steering: Option<usize>,
    /// Cases: motions of some drivers while the others are fixed.
    pub cases: Vec<Case>,
    /// Hardpoints of the source without a member, if the topology is not recognised and these are known.
    pub unplaced: Option<Vec<String>>,
    /// Names of the inadmissible design variables, as the writer would name them.
    pub inadmissible: Vec<String>,
    /// Number of motions of the source that are not imported.
    pub lost_motions: usize,
    /// Output times.
    pub times: Option<Times>,
    /// Masses of the bodies.
    pub masses: Vec<Mass>,
    /// Springs and dampers.
    pub forces: Vec<Force>,
    /// Acceleration of gravity, m/s^2.
    pub gravity: Option<Vec3>,
    /// Named frames of the source, each on a body: possible ends of open loops.
    pub frames: Vec<NamedFrame>,
    /// Frames that rotate from their drawn to their assembled orientation before the mechanism moves.
    pub turned: Vec<TurnedFrame>,
    /// Names in use, by the kind of object.
    names: HashMap<&'static str, Names>,
}

/// Frame between two bodies whose markers are misaligned in the design configuration.
#[derive(Clone, Copy, Debug)]
pub struct TurnedFrame {
    /// Index of the hinge about which it rotates.
    pub joint: usize,
    /// Index of the driver that rotates it.
    pub driver: usize,
    /// Angle of rotation, rad.
    pub angle: f64,
}

/// Names in use of one kind of object.
#[derive(Clone, Debug, Default)]
struct Names {
    taken: HashSet<String>,
    /// Last suffix of a name that is used more than once.
    numbers: HashMap<String, usize>,
}

/// Mass of a body; the inertia is about its centre of mass, along the global axes in the design configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Mass {
    /// Name in the model file.
    pub name: String,
    /// The body.
    pub body: usize,
    /// Centre.
    pub centre: Vec3,
    /// Mass, kg.
    pub mass: f64,
    /// Inertia matrix, kg m^2; `None` for a point mass.
    pub inertia: Option<Mat3>,
}

/// Motion of some drivers while all others are fixed.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Name in the model file.
    pub name: &'static str,
    /// Drivers and their laws, as expressions of model files.
    pub laws: Vec<(usize, String)>,
}

/// Spring with a damper.
#[derive(Clone, Debug, PartialEq)]
pub struct Force {
    /// Name in the model file.
    pub name: String,
    /// Name in the source.
    pub note: String,
    /// Point of application.
    pub on: ForceOn,
    /// Characteristic.
    pub spring: Spring,
}

/// Characteristic of a spring with a damper, per unit of length or angle of the mechanism, in N or N m.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spring {
    /// Stiffness.
    pub stiffness: f64,
    /// Damping coefficient.
    pub damping: f64,
    /// Coordinate, relative to the design configuration, or length at which the spring has no force.
    pub free: Option<f64>,
    /// Tension in the design configuration, N, if the source defines it instead.
    pub preload: Option<f64>,
    /// Points `[extension, tension]` of a nonlinear spring: extension beyond the free length, tension in N, in addition
    /// to the stiffness.
    pub extension: Vec<[f64; 2]>,
}

/// Object that a spring acts on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ForceOn {
    /// A joint coordinate.
    Coordinate(Coordinate),
    /// Two points, each on a body.
    Points([(usize, Vec3); 2]),
    /// Two points, along and about axes that are fixed in the first body.
    Bushing([(usize, Vec3); 2], Bushing),
    /// A joint, by its index, along and about its axes.
    Joint(usize, JointElasticity),
    /// A constant force on a point of a body, in N, that does not turn with the body.
    Constant((usize, Vec3), Vec3),
}

/// Stiffness of an elastic joint, per unit of length or angle of the mechanism, in N or N m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointElasticity {
    /// Stiffnesses along and about the axes of the joint: x, y, z.
    pub stiffness: [f64; 6],
    /// Distance along z from the joint's location to the point at which they are defined.
    pub offset: f64,
}

impl JointElasticity {
    /// Further stiffness matrix at the joint's location; `None` if the stiffnesses are defined there. `per_angle` is
    /// the angle unit of the mechanism in rad.
    pub fn matrix(&self, per_angle: f64) -> Option<[[f64; 6]; 6]> {
        let (a, [x, y, ..]) = (self.offset, self.stiffness.map(|k| k * per_angle));
        // Displacements at the point: x + a about_y and y - a about_x
        let mut matrix = [[0.0; 6]; 6];
        let couples = [(0, 4, a * x, a * a * x), (1, 3, -a * y, a * a * y)];
        for (slide, turn, coupled, own) in couples {
            (matrix[slide][turn], matrix[turn][slide], matrix[turn][turn]) = (coupled, coupled, own);
        }
        (a != 0.0).then_some(matrix)
    }
}

/// Characteristic of a bushing besides its damping, along x, y, z and about them, per unit of length or angle of the
/// mechanism, in N or N m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bushing {
    /// Axes in the design configuration.
    pub axes: Mat3,
    /// Stiffnesses.
    pub stiffness: [f64; 6],
    /// Forces and moments on the second body in the design configuration.
    pub preload: [f64; 6],
}

/// Named frame of the source.
#[derive(Clone, Debug)]
pub struct NamedFrame {
    /// Name in the source.
    pub name: String,
    /// Body that carries it.
    pub body: usize,
    /// The frame, global.
    pub pose: Pose,
    /// True for a frame without mass or shape, which may be the end of a loop.
    pub bare: bool,
}

/// Output times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Times {
    /// First output time, s.
    pub start: f64,
    /// Last output time, s.
    pub end: f64,
    /// Number of intervals.
    pub steps: usize,
}

/// Body.
#[derive(Clone, Debug)]
pub struct Body {
    /// Name in the model file.
    pub name: String,
    /// Name in the source.
    pub note: String,
    /// Reference frame in the design configuration.
    pub pose: Option<Pose>,
    /// Shape.
    pub mesh: Option<Mesh>,
}

/// Shape of a body.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// Path of the file from the folder of the model; its coordinates are in the body frame, in the unit of the
    /// mechanism.
    pub file: String,
}

/// Joint.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Name in the model file.
    pub name: String,
    /// Name in the source.
    pub note: String,
    /// Joint type, as in model files.
    pub kind: &'static str,
    /// Bodies i and j.
    pub bodies: [usize; 2],
    /// Location, or one location on each body.
    pub at: Vec<Vec3>,
    /// Axis.
    pub axis: Option<Vec3>,
    /// Two points that define its axis, if the source does so: the axis follows them.
    pub through: Option<[Vec3; 2]>,
    /// Second axis.
    pub axis2: Option<Vec3>,
    /// Advance of a screw per turn.
    pub lead: Option<f64>,
    /// Length of a rod, if the source specifies another one than in the design configuration.
    pub length: Option<f64>,
    /// Limits of its coordinates in the source.
    pub limits: Vec<JointLimit>,
    /// Shape in drawings.
    pub draw: Option<&'static str>,
}

/// Limit of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointLimit {
    /// Name of the coordinate, or `articulation`.
    pub of: &'static str,
    /// Both ends, relative to the design configuration; infinite where the range is open.
    pub range: [f64; 2],
}

/// Coordinate of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinate {
    /// Index of the joint.
    pub joint: usize,
    /// Name of its coordinate.
    pub name: &'static str,
}

/// Linear relation of joint coordinates: the sum of the terms equals the constant.
#[derive(Clone, Debug)]
pub struct Coupler {
    /// Name in the model file.
    pub name: String,
    /// Name in the source.
    pub note: String,
    /// Coordinates and their coefficients, in the units of the mechanism.
    pub terms: Vec<(Coordinate, f64)>,
    /// Constant, in the units of the mechanism.
    pub constant: f64,
}

/// Prescribed quantity with its law.
#[derive(Clone, Debug)]
pub struct Driver {
    /// Name in the model file.
    pub name: String,
    /// Name in the source.
    pub note: String,
    /// Prescribed quantity.
    pub drives: Drives,
    /// Function of time, relative to the design configuration.
    pub law: Law,
}

/// Quantity that a driver prescribes.
#[derive(Clone, Copy, Debug)]
pub enum Drives {
    /// A joint coordinate.
    Coordinate(Coordinate),
    /// The displacement of a point of a body along a direction.
    Translation {
        /// The body.
        body: usize,
        /// Point in the design configuration.
        at: Vec3,
        /// Direction.
        along: Vec3,
    },
    /// The rotation of a body relative to another one about a direction.
    Rotation {
        /// The body.
        body: usize,
        /// Direction.
        about: Vec3,
        /// Other body.
        relative_to: usize,
    },
}

/// Law of a driver.
#[derive(Clone, Debug, PartialEq)]
pub enum Law {
    /// Zero: the design configuration.
    Fixed,
    /// A constant value.
    Constant(f64),
    /// An expression of model files.
    Text(String),
    /// A smooth curve through points `[time, value]`.
    Table(Vec<[f64; 2]>),
}

/// Point on a body.
#[derive(Clone, Debug)]
pub struct Point {
    /// Name in the model file.
    pub name: String,
    /// The body.
    pub body: usize,
    /// Position in the design configuration.
    pub at: Vec3,
}

/// Road wheel.
#[derive(Clone, Debug)]
pub struct Wheel {
    /// Name in the model file.
    pub name: String,
    /// Body that carries the wheel.
    pub body: usize,
    /// Centre.
    pub centre: Vec3,
    /// Spin axis, pointing outboard.
    pub spin_axis: Vec3,
    /// Point on the spin axis, if the axis is defined from it to the centre.
    pub spindle: Option<Vec3>,
    /// Radius, from the centre to the road.
    pub radius: f64,
    /// Two points on its steering axis, lower and upper, each on a body.
    pub kingpin: Option<[(usize, Vec3); 2]>,
    /// Index of the driver that moves it vertically.
    pub bump: usize,
    /// True if the wheel is steered.
    pub is_steered: bool,
    /// Ends of its spring.
    pub spring: Option<[(usize, Vec3); 2]>,
    /// End of the vehicle.
    pub end: Option<VehicleEnd>,
}

/// Returns the end of the vehicle that a word names, ignoring case.
pub fn end_named(word: &str) -> Option<VehicleEnd> {
    VehicleEnd::ALL.into_iter().find(|end| word.trim().eq_ignore_ascii_case(end.name()))
}

impl Mechanism {
    /// Creates a mechanism with ground only.
    pub fn new(name: &str, length: &'static str, angle: &'static str) -> Self {
        let ground = Body { name: "ground".into(), note: String::new(), pose: None, mesh: None };
        Self {
            name: name.into(),
            length,
            angle,
            hardpoints: Vec::new(),
            bodies: vec![ground],
            joints: Vec::new(),
            couplers: Vec::new(),
            drivers: Vec::new(),
            points: Vec::new(),
            wheels: Vec::new(),
            vehicle: Vehicle::default(),
            steering: None,
            cases: Vec::new(),
            unplaced: None,
            inadmissible: Vec::new(),
            lost_motions: 0,
            times: None,
            masses: Vec::new(),
            forces: Vec::new(),
            gravity: None,
            frames: Vec::new(),
            turned: Vec::new(),
            names: HashMap::new(),
        }
    }

    /// Returns a valid name of a kind of object that is as near as possible to the requested one and not in use.
    fn name(&mut self, wanted: &str, kind: &'static str) -> String {
        let names = self.names.entry(kind).or_default();
        let clean = clean_name(wanted, kind);
        let mut name = clean.clone();
        let number = names.numbers.entry(clean.clone()).or_insert(1);
        while names.taken.contains(&name) || name == "ground" {
            *number += 1;
            name = format!("{clean}_{number}");
        }
        names.taken.insert(name.clone());
        name
    }

    /// Adds a body and returns its index.
    pub fn body(&mut self, name: &str, note: String, pose: Option<Pose>) -> usize {
        let name = self.name(name, "body");
        self.bodies.push(Body { name, note, pose, mesh: None });
        self.bodies.len() - 1
    }

    /// Adds a joint and returns its index.
    pub fn joint(&mut self, joint: Joint) -> usize {
        let name = self.name(&joint.name, "joint");
        self.joints.push(Joint { name, ..joint });
        self.joints.len() - 1
    }

    /// Adds a coupler whose terms sum to zero.
    pub fn coupler(&mut self, name: &str, note: String, terms: Vec<(Coordinate, f64)>) {
        self.coupler_to(name, note, terms, 0.0);
    }

    /// Adds a coupler whose terms sum to a constant.
    pub fn coupler_to(&mut self, name: &str, note: String, terms: Vec<(Coordinate, f64)>, constant: f64) {
        let name = self.name(name, "coupler");
        self.couplers.push(Coupler { name, note, terms, constant });
    }

    /// Adds a driver and returns its index.
    pub fn driver(&mut self, name: &str, note: String, drives: Drives, law: Law) -> usize {
        let name = self.name(name, "driver");
        self.drivers.push(Driver { name, note, drives, law });
        self.drivers.len() - 1
    }

    /// Adds a point.
    pub fn point(&mut self, name: &str, body: usize, at: Vec3) {
        let name = self.name(name, "point");
        self.points.push(Point { name, body, at });
    }

    /// Adds a mass.
    pub fn mass(&mut self, mass: Mass) {
        let name = self.name(&mass.name, "mass");
        self.masses.push(Mass { name, ..mass });
    }

    /// Adds a spring or damper.
    pub fn force(&mut self, force: Force) {
        let name = self.name(&force.name, "force");
        self.forces.push(Force { name, ..force });
    }

    /// Adds a named frame of the source.
    pub fn frame(&mut self, name: &str, body: usize, pose: Pose, bare: bool) {
        self.frames.push(NamedFrame { name: name.to_owned(), body, pose, bare });
    }

    /// Returns true if a driver prescribes this coordinate.
    pub fn is_driven(&self, coordinate: Coordinate) -> bool {
        self.drivers.iter().any(|d| matches!(d.drives, Drives::Coordinate(c) if c == coordinate))
    }

    /// Returns true if joints connect two bodies, directly or through other bodies.
    pub fn are_connected(&self, [from, to]: [usize; 2]) -> bool {
        let mut reached = vec![false; self.bodies.len()];
        let mut waiting = vec![from];
        while let Some(b) = waiting.pop() {
            if !std::mem::replace(&mut reached[b], true) {
                let beyond = self.joints.iter().filter(|j| j.bodies.contains(&b)).flat_map(|j| j.bodies);
                waiting.extend(beyond.filter(|b| !reached[*b]));
            }
        }
        reached[to]
    }

    /// Returns the angle unit of the mechanism, rad.
    pub fn per_angle(&self) -> f64 {
        if self.angle == "deg" { 1_f64.to_radians() } else { 1.0 }
    }

    /// Returns 1 mm in the length unit of the mechanism.
    pub fn per_mm(&self) -> f64 {
        match self.length {
            "m" => 1e-3,
            "cm" => 0.1,
            "in" => 1.0 / 25.4,
            _ => 1.0,
        }
    }

    /// Size of the mechanism: the largest extent of its points along a global axis, positive.
    pub fn size(&self) -> f64 {
        let places = self.joints.iter().flat_map(|j| j.at.iter().copied());
        let places: Vec<Vec3> = places.chain(self.hardpoints.iter().map(|h| h.1)).collect();
        let spread = |k: usize| {
            let along = places.iter().map(|p| p[k]);
            along.clone().fold(f64::NEG_INFINITY, f64::max) - along.fold(f64::INFINITY, f64::min)
        };
        let size = (0..3).map(spread).fold(0.0, f64::max);
        if size > 0.0 { size } else { 1.0 }
    }
}

impl Joint {
    /// Type of the joint; `None` if there is no such type.
    pub fn joint_type(&self) -> Option<&'static JointType> {
        joint::named(self.kind)
    }

    /// True if this holds for the type of the joint.
    pub fn is(&self, property: fn(&JointType) -> bool) -> bool {
        self.joint_type().is_some_and(property)
    }

    /// Creates a joint at one location.
    pub fn new(name: &str, note: String, kind: &'static str, bodies: [usize; 2], at: Vec3) -> Self {
        Self {
            name: name.into(),
            note,
            kind,
            bodies,
            at: vec![at],
            axis: None,
            through: None,
            axis2: None,
            lead: None,
            length: None,
            limits: Vec::new(),
            draw: None,
        }
    }

    /// Returns the range of a coordinate, if it has limits.
    pub fn range_of(&self, coordinate: &str) -> Option<[f64; 2]> {
        self.limits.iter().find(|limit| limit.of == coordinate).map(|limit| limit.range)
    }

    /// Adds a limit, unless the range is open at both ends.
    ///
    /// # Errors
    /// Returns the reason why the range is not that of a joint that moves.
    pub fn limit(&mut self, of: &'static str, range: [f64; 2]) -> Result<(), &'static str> {
        if range[0] >= range[1] {
            return Err("its lower end is not below its upper end: the joint gets no limit");
        }
        if range.iter().any(|x| x.is_finite()) {
            self.limits.push(JointLimit { of, range });
        }
        Ok(())
    }

    /// Sets the axis.
    #[must_use]
    pub fn along(mut self, axis: Vec3) -> Self {
        self.axis = Some(axis);
        self
    }

    /// Sets an axis through two points.
    #[must_use]
    pub fn through(mut self, from: Vec3, to: Vec3) -> Self {
        (self.axis, self.through) = (Some(to - from), Some([from, to]));
        self
    }

    /// Sets both axes.
    #[must_use]
    pub fn with_axes(mut self, axis: Vec3, axis2: Vec3) -> Self {
        (self.axis, self.axis2) = (Some(axis), Some(axis2));
        self
    }

    /// Sets a location on each body.
    #[must_use]
    pub fn between(mut self, i: Vec3, j: Vec3) -> Self {
        self.at = vec![i, j];
        self
    }
}

/// Maximum number of characters of a name in a model file.
const LONGEST_NAME: usize = 100;

/// Returns a name without invalid characters.
fn clean_name(wanted: &str, kind: &str) -> String {
    let clean: String = wanted.trim().chars().filter(|c| !c.is_control()).take(LONGEST_NAME - 8).collect();
    if clean.is_empty() { kind.to_owned() } else { clean }
}

/// Returns a valid name that is as near as possible to the requested one and not in use.
pub fn valid_name(wanted: &str, kind: &str, taken: &HashSet<&str>) -> String {
    let clean = clean_name(wanted, kind);
    let free = |name: &str| !taken.contains(name) && name != "ground";
    if free(&clean) {
        return clean;
    }
    let numbered = (2..).map(|k| format!("{clean}_{k}"));
    numbered.into_iter().find(|name| free(name)).unwrap_or(clean)
}
