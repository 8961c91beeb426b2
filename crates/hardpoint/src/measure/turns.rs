//! Angles whose whole turns only the path indicates.

use std::collections::BTreeMap;

use crate::constraint::{MarkerPair, Row};
use crate::design::{BodyFixed, DesignMap, Geometry};
use crate::joint::{Freedom, Quantity};
use crate::law::Law;
use crate::model::element::ActsOn;
use crate::model::{DriverId, ElementId, JointId, MeasureKind, Model, OutputSource};
use crate::motion::turns::{CountedAngles, turned};
use crate::motion::{BodyState, Motion};
use crate::number::{self, Jet, Rates};
use crate::space::{Mat3, Pose, Vec3};
use crate::topology::{CoordinateId, Topology};

use super::formulas::Instant;
use super::storage::{MeasureResults, Output, outputs};
use super::with_rates;

/// Source of the number of whole turns of a joint's angle.
pub(super) enum Turns {
    /// The driver's law.
    Driver(DriverId),
    /// The tree coordinate, which is the angle itself.
    Coordinate(CoordinateId),
    /// The path alone, for a cut joint or an angle between two directions about an axis.
    Path(PathTurns),
}

/// An angle whose turns are counted along the path.
#[derive(Clone, Copy)]
pub(super) struct PathTurns {
    /// Place among the angles that were counted, where the path was followed.
    angle: Option<CountedPlace>,
    /// Value where the path begins; as it is measured, without a whole turn, where that is `None`.
    origin: Option<f64>,
}

/// A place among all counted angles.
#[derive(Clone, Copy)]
struct CountedPlace {
    place: usize,
    of: usize,
}

/// The outputs that are counted angles, and what indicates their turns.
fn turns(model: &Model, topology: &Topology, outputs: &[Output]) -> Vec<Option<Turns>> {
    let mut link_of = vec![None; model.joints.len()];
    for link in &topology.links {
        if let Some(j) = link.joint {
            link_of[j.0] = Some(link);
        }
    }
    // In equilibrium some drivers are released, and openings have no laws.
    let drivers = model.drivers.iter().enumerate().filter(|_| model.equilibrium.is_none());
    let driver_of: BTreeMap<_, _> = drivers.map(|(k, d)| ((d.joint, d.coordinate), DriverId(k))).collect();
    let path = |origin| Turns::Path(PathTurns { angle: None, origin });
    let of_joint = |joint: JointId, coordinate: usize| {
        if let Some(&d) = driver_of.get(&(joint, coordinate)) {
            return Turns::Driver(d);
        }
        let freedom = model.joints[joint.0].kind.coordinates[coordinate].freedom;
        let Some((link, freedom)) = link_of[joint.0].zip(freedom) else { return path(Some(0.0)) };
        Turns::Coordinate(link.coordinate_of(freedom))
    };
    let of_output = |output: &Output| {
        let OutputSource::Measure(m) = output.source else { return None };
        output.known.counted.then(|| {
            let MeasureKind::Coordinate { joint, coordinate } = model.measures[m].kind else {
                return path(None);
            };
            of_joint(joint, coordinate)
        })
    };
    outputs.iter().map(of_output).collect()
}

/// The same, with the places of what was counted along the path of this motion.
pub(super) fn placed_turns(
    model: &Model,
    topology: &Topology,
    motion: &Motion,
    outputs: &[Output],
) -> Vec<Option<Turns>> {
    let mut turns = turns(model, topology, outputs);
    if !motion.counted.is_empty() {
        let angles = path_angles(model, topology, true);
        for (place, angle) in angles.iter().enumerate() {
            if let PathAngle::Measure(m) = *angle
                && let Some(Turns::Path(path)) = &mut turns[m]
            {
                path.angle = Some(CountedPlace { place, of: angles.len() });
            }
        }
    }
    turns
}

/// Counts whole turns of angles.
pub(super) fn unwrap_angles(
    laws: &[Law],
    motion: &Motion,
    k: usize,
    turns: &[Option<Turns>],
    measured: &mut MeasureResults,
    mut counted: impl FnMut(usize, f64),
) {
    for (m, turns_of) in turns.iter().enumerate() {
        let Some(turns_of) = turns_of else { continue };
        let [now, rate, acceleration] = measured.value(k, m);
        let near = match *turns_of {
            // Near f(t), q of the tree, or the angle that was counted along the path
            Turns::Driver(d) => laws[d.0].at(motion.times[k]).value(),
            Turns::Coordinate(q) => motion.coordinates.row(k).get(q.0),
            Turns::Path(PathTurns { angle: Some(at), .. }) => motion.counted[k * at.of + at.place],
            Turns::Path(PathTurns { angle: None, origin }) => match k {
                // Designs side by side begin in the design configuration.
                0 => origin.unwrap_or(now),
                _ => {
                    let [before, rate_before, _] = measured.value(k - 1, m);
                    // x + h (x. before + x. now) / 2: wrong by h^3 x... / 12, where anything below half a turn is right
                    before + 0.5 * (motion.times[k] - motion.times[k - 1]) * (rate_before + rate)
                }
            },
        };
        let value = turned(now, near);
        measured.set(k, m, [value, rate, acceleration]);
        counted(m, value - now);
    }
}

/// An angle that is counted along the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum PathAngle {
    /// The coordinate of an element.
    Element(ElementId),
    /// A measure.
    Measure(usize),
}

/// Angles in the order in which they are counted: those of elements, then those of measures, if requested.
pub(crate) fn path_angles(model: &Model, topology: &Topology, measures: bool) -> Vec<PathAngle> {
    let mut angles: Vec<PathAngle> = (0..model.elements.len())
        .map(ElementId)
        .filter(|e| ElementCoordinate::of(model, *e).is_some_and(|c| c.is_counted(topology)))
        .map(PathAngle::Element)
        .collect();
    if measures {
        let of_measures = turns(model, topology, &outputs(model));
        let counted =
            of_measures.iter().enumerate().filter(|(_, turns)| matches!(turns, Some(Turns::Path(_))));
        angles.extend(counted.map(|(m, _)| PathAngle::Measure(m)));
    }
    angles
}

/// The coordinate that the force of an element depends on, whose turns are counted if it is an angle.
#[derive(Clone, Copy)]
pub(crate) struct ElementCoordinate {
    /// Joint of the coordinate; `None` for the turn about z between the two points of a bushing.
    joint: Option<JointId>,
    /// Freedom of the joint that is this coordinate, if there is one.
    freedom: Option<usize>,
    row: Row,
    is_angle: bool,
}

impl ElementCoordinate {
    /// Coordinate of an element: that of the joint that it acts on, or the turn about z that it resists.
    pub fn of(model: &Model, e: ElementId) -> Option<Self> {
        let kind = &model.elements[e.0].kind;
        match kind.force(model)?.acts_on {
            ActsOn::Coordinate(joint, coordinate) => {
                let of = &model.joints[joint.0].kind.coordinates[coordinate];
                let is_angle = of.quantity == Quantity::Angle;
                Some(Self { joint: Some(joint), freedom: of.freedom, row: of.row, is_angle })
            }
            ActsOn::Joint(joint) => {
                // Without equilibrium its joint is rigid.
                let elastic = kind.elastic_law().filter(|law| law.resists_turns_about_z());
                elastic.filter(|_| model.equilibrium.is_some())?;
                let kind = model.joints[joint.0].kind;
                let freedoms = kind.freedoms.unwrap_or_default();
                let turn = freedoms.iter().rposition(|freedom| *freedom == Freedom::Turn(2));
                let (freedom, row) = match kind.is_cross() {
                    // The angle about the first pin.
                    true => (turn, Row::Heading),
                    // The last turn of the chain is the last Cardan angle.
                    false => (turn.filter(|k| k + 1 == freedoms.len()), Row::CardanAngle),
                };
                Some(Self { joint: Some(joint), freedom, row, is_angle: true })
            }
            ActsOn::Points(_) => {
                kind.elastic_law().filter(|law| law.resists_turns_about_z())?;
                Some(Self { joint: None, freedom: None, row: Row::CardanAngle, is_angle: true })
            }
            ActsOn::Line(_) | ActsOn::Point(_) | ActsOn::Wheel(_) | ActsOn::Body(_) => None,
        }
    }

    /// The generalised coordinate of the tree that equals it, if there is one.
    pub fn in_tree(&self, topology: &Topology) -> Option<CoordinateId> {
        let link = topology.links.iter().find(|link| link.joint.is_some() && link.joint == self.joint)?;
        Some(link.coordinate_of(self.freedom?))
    }

    /// True if it is an angle that the tree does not carry.
    pub fn is_counted(&self, topology: &Topology) -> bool {
        self.is_angle && self.in_tree(topology).is_none()
    }
}

/// The angles of a design that are counted along the path.
pub(crate) struct PathAngles<'m> {
    model: &'m Model,
    angles: Vec<PathAngle>,
    origins: Vec<Option<f64>>,
    bodies: Vec<usize>,
    fixed: BodyFixed<Rates>,
    geometry: Geometry<Rates>,
    poses: Vec<Pose<Rates>>,
}

impl<'m> PathAngles<'m> {
    /// Those of a design with these values; `None` where there is none.
    pub fn of(
        design_map: &'m DesignMap<'_>,
        topology: &Topology,
        values: &[f64],
        measures: bool,
    ) -> Option<Self> {
        let model = design_map.model();
        let angles = path_angles(model, topology, measures);
        if angles.is_empty() {
            return None;
        }
        let mut bodies = Vec::new();
        let mut origins = Vec::new();
        for angle in &angles {
            let (on, origin) = match *angle {
                PathAngle::Element(e) => {
                    let force = model.elements[e.0].kind.force(model);
                    (force.map_or_else(Vec::new, |force| force.acts_on.bodies(model).to_vec()), Some(0.0))
                }
                PathAngle::Measure(m) => {
                    let measure = &model.measures[m];
                    // That of a joint is zero in the design configuration.
                    let of_joint = matches!(measure.kind, MeasureKind::Coordinate { .. });
                    (model.bodies_of(measure), of_joint.then_some(0.0))
                }
            };
            bodies.extend(on.into_iter().map(|b| b.0).filter(|b| *b > 0));
            origins.push(origin);
        }
        bodies.sort_unstable();
        bodies.dedup();
        let rates: Vec<Rates> = values.iter().map(|v| Rates::constant(*v)).collect();
        Some(Self {
            model,
            angles,
            origins,
            bodies,
            fixed: design_map.fixed(values).map(Jet::constant),
            geometry: design_map.geometry(&rates),
            poses: vec![Pose::IDENTITY.spread(); model.bodies.len()],
        })
    }

    /// The coordinate of an element, within a turn, counted from the design configuration.
    fn of_element(&self, e: ElementId) -> Rates {
        let unknown = Rates::constant(f64::NAN);
        let Some(ElementCoordinate { joint, row, .. }) = ElementCoordinate::of(self.model, e) else {
            return unknown;
        };
        let Some(force) = self.model.elements[e.0].kind.force(self.model) else { return unknown };
        let [i, j] = force.acts_on.bodies(self.model);
        let [i, j] = number::both([i, j], |b| (self.poses[b.0], self.model.bodies[b.0].frame.rot));
        let ([m_i, m_j], kept) = match joint {
            Some(joint) if matches!(force.acts_on, ActsOn::Joint(_)) => {
                (self.geometry.elastic_markers(self.model, joint), Rates::constant(0.0))
            }
            Some(joint) => (self.geometry.markers[joint.0], self.geometry.kept[joint.0].by(row)),
            // Angles do not depend on the points. Without axes of its own a bushing has the global ones.
            None => {
                let global = || number::both([i.1, j.1], |rot| rot.transpose().spread());
                let axes = self.geometry.axes[e.0].unwrap_or_else(global);
                (number::both(axes, |rot| Pose { rot, r: Vec3::zero() }), Rates::constant(0.0))
            }
        };
        let (i, j) = (i.0.compose(m_i), j.0.compose(m_j));
        row.value(&MarkerPair { i, j, axes: Mat3::IDENTITY.spread() }, kept) - kept
    }
}

impl CountedAngles for PathAngles<'_> {
    fn bodies(&self) -> &[usize] {
        &self.bodies
    }

    fn origins(&self) -> &[Option<f64>] {
        &self.origins
    }

    fn measure(&mut self, state: &dyn Fn(usize) -> BodyState, found: &mut [[f64; 3]]) {
        for &b in &self.bodies {
            self.poses[b] = with_rates(&state(b));
        }
        let instant = Instant::new(self.model, &self.fixed, &self.poses);
        for (angle, found) in self.angles.iter().zip(found) {
            let Jet(numbers) = match *angle {
                PathAngle::Element(e) => self.of_element(e),
                PathAngle::Measure(m) => instant.measure(m),
            };
            *found = numbers;
        }
    }
}
