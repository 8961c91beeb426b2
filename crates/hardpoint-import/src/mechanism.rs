//! Common form of all formats: bodies, joints, couplers, drivers in the design configuration. Importers fill it; one
//! writer makes a model file of it.

use std::collections::{HashMap, HashSet};

use hardpoint::model::{Vehicle, VehicleEnd};
use hardpoint::space::{Mat3, Pose, Vec3};

/// The body that does not move: the first of every mechanism.
pub const GROUND: usize = 0;

/// A mechanism between two formats. Coordinates are global, in the units that it names.
#[derive(Clone, Debug)]
pub struct Mechanism {
    /// Name, for headings.
    pub name: String,
    /// Unit of every length, as model files name it.
    pub length: &'static str,
    /// Unit of every angle, as model files name it.
    pub angle: &'static str,
    /// Places that the source names, whether anything is there or not.
    pub hardpoints: Vec<(String, Vec3)>,
    /// The bodies; the first is ground.
    pub bodies: Vec<Body>,
    /// The joints.
    pub joints: Vec<Joint>,
    /// Linear relations of joint coordinates.
    pub couplers: Vec<Coupler>,
    /// Drivers.
    pub drivers: Vec<Driver>,
    /// Points whose motion is wanted.
    pub points: Vec<Point>,
    /// Road wheels.
    pub wheels: Vec<Wheel>,
    /// Figures of the vehicle; lengths are in the mechanism's unit.
    pub vehicle: Vehicle,
    /// The driver that steers the wheels.
    pub steering: Option<usize>,
    /// Motions of its own, each by some drivers while the others are held.
    pub cases: Vec<Case>,
    /// Hardpoints of the source that no member is at, where its topology is not recognised and these are known.
    pub unplaced: Option<Vec<String>>,
    /// Design variables that it cannot follow, by the names that the writer would give them.
    pub unfollowed: Vec<String>,
    /// The output times: when they end, and how many intervals there are.
    pub times: Option<Times>,
    /// Masses of the bodies.
    pub masses: Vec<Mass>,
    /// Springs and dampers.
    pub forces: Vec<Force>,
    /// Acceleration of gravity, m/s^2.
    pub gravity: Option<Vec3>,
    /// Frames that the source names, each on a body: the ends of loops that it does not close.
    pub frames: Vec<NamedFrame>,
    /// Frames that turn from where they are drawn to where they belong, before the mechanism moves.
    pub turned: Vec<TurnedFrame>,
    /// Names that are taken, by what they are of.
    names: HashMap<&'static str, Names>,
}

/// A frame between two bodies whose markers are turned against each other in the design configuration.
#[derive(Clone, Copy, Debug)]
pub struct TurnedFrame {
    /// The hinge about which it turns.
    pub joint: usize,
    /// The driver that turns it.
    pub driver: usize,
    /// By how much, rad.
    pub angle: f64,
}

/// Names of things of one kind.
#[derive(Clone, Debug, Default)]
struct Names {
    taken: HashSet<String>,
    /// The last number behind a name that is wanted more than once.
    numbers: HashMap<String, usize>,
}

/// Mass of a body: about its centre, along the global axes in the design configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Mass {
    /// Name in the model file.
    pub name: String,
    /// The body.
    pub body: usize,
    /// Centre.
    pub centre: Vec3,
    /// In kg.
    pub mass: f64,
    /// Inertia matrix, kg m^2; none of a point mass.
    pub inertia: Option<Mat3>,
}

/// A motion of some drivers while all others are held.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Name in the model file.
    pub name: &'static str,
    /// Drivers and their laws, as expressions of model files.
    pub laws: Vec<(usize, String)>,
}

/// A spring with a damper.
#[derive(Clone, Debug, PartialEq)]
pub struct Force {
    /// Name in the model file.
    pub name: String,
    /// Name in the source.
    pub note: String,
    /// On what it acts.
    pub on: ForceOn,
    /// Characteristic.
    pub spring: Spring,
}

/// Characteristic of a spring with a damper, per unit of length or angle of the mechanism, in N or N m.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spring {
    /// Stiffness.
    pub stiffness: f64,
    /// Damping, per speed.
    pub damping: f64,
    /// The coordinate, counted from the drawing, or the length at which it has no force.
    pub free: Option<f64>,
    /// Tension in the design configuration, N, where the source gives that instead.
    pub preload: Option<f64>,
    /// Points of extension beyond the free length and tension, N, beside the stiffness.
    pub extension: Vec<[f64; 2]>,
}

/// Object that a spring acts on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ForceOn {
    /// A joint's coordinate.
    Coordinate(Coordinate),
    /// Two points, each of a body.
    Points([(usize, Vec3); 2]),
}

/// A frame that the source names.
#[derive(Clone, Debug)]
pub struct NamedFrame {
    /// Name in the source.
    pub name: String,
    /// The body that it is on.
    pub body: usize,
    /// The frame, global.
    pub pose: Pose,
    /// True for a frame and nothing else, which may be the end of a loop.
    pub bare: bool,
}

/// Output times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Times {
    /// The first.
    pub start: f64,
    /// The last.
    pub end: f64,
    /// Number of intervals.
    pub steps: usize,
}

/// A body.
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

/// The shape of a body.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// The file, from the model's folder; its coordinates are those of the body's frame, in the mechanism's unit.
    pub file: String,
}

/// A joint.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Name in the model file.
    pub name: String,
    /// Name in the source.
    pub note: String,
    /// The joint type, as model files name it.
    pub kind: &'static str,
    /// Bodies i and j.
    pub bodies: [usize; 2],
    /// Place, or one on each body.
    pub at: Vec<Vec3>,
    /// Axis.
    pub axis: Option<Vec3>,
    /// Two places that its axis goes through, where the source has it so: it follows them.
    pub through: Option<[Vec3; 2]>,
    /// Second axis.
    pub axis2: Option<Vec3>,
    /// Advance of a screw per turn.
    pub lead: Option<f64>,
    /// Length of a rod, where the source says another than the drawn one.
    pub length: Option<f64>,
    /// Between which values the source lets its coordinate go.
    pub limits: Option<[f64; 2]>,
    /// Shape in drawings.
    pub draw: Option<&'static str>,
}

/// A coordinate of a joint, by the joint's number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinate {
    /// Index of the joint.
    pub joint: usize,
    /// Name of its coordinate.
    pub name: &'static str,
}

/// A linear relation of joint coordinates: the sum of the terms is the constant.
#[derive(Clone, Debug)]
pub struct Coupler {
    /// Name in the model file.
    pub name: String,
    /// Name in the source.
    pub note: String,
    /// Coordinates and their coefficients, per unit of the mechanism.
    pub terms: Vec<(Coordinate, f64)>,
    /// In the mechanism's units.
    pub constant: f64,
}

/// A prescribed number.
#[derive(Clone, Debug)]
pub struct Driver {
    /// Name in the model file.
    pub name: String,
    /// Name in the source.
    pub note: String,
    /// Prescribed quantity.
    pub drives: Drives,
    /// Over time, counted from the drawing.
    pub law: Law,
}

/// Quantity that a driver prescribes.
#[derive(Clone, Copy, Debug)]
pub enum Drives {
    /// A joint's coordinate.
    Coordinate(Coordinate),
    /// The way of a point of a body along a direction.
    Way {
        /// The body.
        body: usize,
        /// The point in the design configuration.
        at: Vec3,
        /// The direction.
        along: Vec3,
    },
    /// The angle by which a body has turned against another, seen along a direction.
    Heading {
        /// The body.
        body: usize,
        /// The direction.
        about: Vec3,
        /// The other body.
        relative_to: usize,
    },
}

/// Law of a driver.
#[derive(Clone, Debug, PartialEq)]
pub enum Law {
    /// It stays in the design configuration.
    Held,
    /// It stays at this value.
    Set(f64),
    /// By an expression of model files.
    Text(String),
    /// Through points of time and value.
    Table(Vec<[f64; 2]>),
}

/// A point.
#[derive(Clone, Debug)]
pub struct Point {
    /// Name in the model file.
    pub name: String,
    /// The body.
    pub body: usize,
    /// Position in the design configuration.
    pub at: Vec3,
}

/// A road wheel.
#[derive(Clone, Debug)]
pub struct Wheel {
    /// Name in the model file.
    pub name: String,
    /// The body that it turns on.
    pub body: usize,
    /// Centre.
    pub centre: Vec3,
    /// Spin axis, outboard.
    pub spin_axis: Vec3,
    /// True if that comes from this place to the centre.
    pub spindle: Option<Vec3>,
    /// From the centre to the ground.
    pub radius: f64,
    /// Two points of its steering axis, lower and upper, each on a body.
    pub kingpin: Option<[(usize, Vec3); 2]>,
    /// The driver that moves it up and down.
    pub bump: usize,
    /// True if the steering turns it.
    pub is_steered: bool,
    /// The ends of its spring.
    pub spring: Option<[(usize, Vec3); 2]>,
    /// The end of the vehicle that it is at.
    pub end: Option<VehicleEnd>,
}

/// The end of the vehicle that a word names, whatever its case.
pub fn end_named(word: &str) -> Option<VehicleEnd> {
    VehicleEnd::ALL.into_iter().find(|end| word.trim().eq_ignore_ascii_case(end.name()))
}

impl Mechanism {
    /// One with ground alone.
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
            unfollowed: Vec::new(),
            times: None,
            masses: Vec::new(),
            forces: Vec::new(),
            gravity: None,
            frames: Vec::new(),
            turned: Vec::new(),
            names: HashMap::new(),
        }
    }

    /// The name that comes nearest to the one that is wanted, and is not taken by another of this kind.
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

    /// A further body; its number.
    pub fn body(&mut self, name: &str, note: String, pose: Option<Pose>) -> usize {
        let name = self.name(name, "body");
        self.bodies.push(Body { name, note, pose, mesh: None });
        self.bodies.len() - 1
    }

    /// A further joint; its number.
    pub fn joint(&mut self, joint: Joint) -> usize {
        let name = self.name(&joint.name, "joint");
        self.joints.push(Joint { name, ..joint });
        self.joints.len() - 1
    }

    /// A further coupler, whose terms sum up to zero.
    pub fn coupler(&mut self, name: &str, note: String, terms: Vec<(Coordinate, f64)>) {
        self.coupler_to(name, note, terms, 0.0);
    }

    /// A further coupler, whose terms sum up to a constant.
    pub fn coupler_to(&mut self, name: &str, note: String, terms: Vec<(Coordinate, f64)>, constant: f64) {
        let name = self.name(name, "coupler");
        self.couplers.push(Coupler { name, note, terms, constant });
    }

    /// A further driver; its number.
    pub fn driver(&mut self, name: &str, note: String, drives: Drives, law: Law) -> usize {
        let name = self.name(name, "driver");
        self.drivers.push(Driver { name, note, drives, law });
        self.drivers.len() - 1
    }

    /// A further point.
    pub fn point(&mut self, name: &str, body: usize, at: Vec3) {
        let name = self.name(name, "point");
        self.points.push(Point { name, body, at });
    }

    /// A further mass.
    pub fn mass(&mut self, mass: Mass) {
        let name = self.name(&mass.name, "mass");
        self.masses.push(Mass { name, ..mass });
    }

    /// A further spring or damper.
    pub fn force(&mut self, force: Force) {
        let name = self.name(&force.name, "force");
        self.forces.push(Force { name, ..force });
    }

    /// A further frame that the source names.
    pub fn frame(&mut self, name: &str, body: usize, pose: Pose, bare: bool) {
        self.frames.push(NamedFrame { name: name.to_owned(), body, pose, bare });
    }

    /// True if something prescribes this coordinate.
    pub fn is_driven(&self, coordinate: Coordinate) -> bool {
        self.drivers.iter().any(|d| matches!(d.drives, Drives::Coordinate(c) if c == coordinate))
    }

    /// True if joints connect two bodies, by way of others or not.
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

    /// Millimetres in its unit of length.
    pub fn per_mm(&self) -> f64 {
        match self.length {
            "m" => 1e-3,
            "cm" => 0.1,
            "in" => 1.0 / 25.4,
            _ => 1.0,
        }
    }

    /// Size of the mechanism: the largest distance of two of its points along an axis, above zero.
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
    /// A joint at one place.
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
            limits: None,
            draw: None,
        }
    }

    /// With an axis.
    #[must_use]
    pub fn along(mut self, axis: Vec3) -> Self {
        self.axis = Some(axis);
        self
    }

    /// With an axis through two places.
    #[must_use]
    pub fn through(mut self, from: Vec3, to: Vec3) -> Self {
        (self.axis, self.through) = (Some(to - from), Some([from, to]));
        self
    }

    /// With two axes.
    #[must_use]
    pub fn with_axes(mut self, axis: Vec3, axis2: Vec3) -> Self {
        (self.axis, self.axis2) = (Some(axis), Some(axis2));
        self
    }

    /// With a place on each body.
    #[must_use]
    pub fn between(mut self, i: Vec3, j: Vec3) -> Self {
        self.at = vec![i, j];
        self
    }
}

/// Names of model files have at most that many characters.
const LONGEST_NAME: usize = 100;

/// Returns a name without the characters that no name may hold.
fn clean_name(wanted: &str, kind: &str) -> String {
    let clean: String = wanted.trim().chars().filter(|c| !c.is_control()).take(LONGEST_NAME - 8).collect();
    if clean.is_empty() { kind.to_owned() } else { clean }
}

/// The name that comes nearest to the one that is wanted: without what no name may hold, and not taken.
pub fn valid_name(wanted: &str, kind: &str, taken: &HashSet<&str>) -> String {
    let clean = clean_name(wanted, kind);
    let free = |name: &str| !taken.contains(name) && name != "ground";
    if free(&clean) {
        return clean;
    }
    let numbered = (2..).map(|k| format!("{clean}_{k}"));
    numbered.into_iter().find(|name| free(name)).unwrap_or(clean)
}
