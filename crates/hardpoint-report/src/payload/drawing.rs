//! Drawing of the mechanism: bodies with their hardpoints, joints, couplers, drivers and wheels, all derived from the
//! model and not from names.

use hardpoint::constraint::Row;
use hardpoint::joint::{Freedom, Need, Quantity as Kind, Slide};
use hardpoint::measure::Output;
use hardpoint::model::{
    BodyId, Change, Coupler, Curve as PlanarCurve, Direction, Driver, DriverId, HardpointId, Joint, JointId,
    Measure, MeasureKind, PointId, Transmission, VariableId, Wheel,
};
use hardpoint::run::DriverRates;
use hardpoint::space::{Pose, Vec3};
use hardpoint::topology::JointRole;
use hardpoint_file::MeshFrame;

use crate::facts::{fixed_spins, written_kind};
use crate::figures::symbol;
use crate::page::{
    Arrow, BodyPlace, BodyTrack, CouplerKind, CouplerMark, CouplerTerm, Curve, DistanceMark, DriverMark,
    JointCurve, JointMark, Mesh, PointRole, SlideMark, VehicleAxes, WheelMark,
};

use super::Compose;

/// Number of points of a curve: enough to make it look smooth.
const CURVE_POINTS: usize = 240;
/// Hardpoints of a body coincide if their distance is less than this fraction of the mechanism's size.
const SAME_PLACE: f64 = 1e-9;
/// Distance from a wheel's ground contact, as a fraction of its radius, within which a point is taken as the contact
/// point.
const NEAR_CONTACT: f64 = 0.02;
/// Vehicle axes as in ISO 8855: x forward, z up.
const VEHICLE: VehicleAxes = VehicleAxes { forward: [1.0, 0.0, 0.0], up: [0.0, 0.0, 1.0] };

/// Hardpoint of a body's skeleton.
struct SkeletonPoint {
    at: Vec3,
    labels: Vec<String>,
    role: PointRole,
}

/// True if a joint is drawn. A driven distance is drawn like a leg; a driven point or orientation has nothing to draw.
pub(super) fn is_drawn(joint: &Joint) -> bool {
    !joint.unnamed || joint.kind.places == 2
}

impl Compose<'_> {
    /// All bodies with their hardpoints and motion.
    pub(super) fn bodies(&self) -> Vec<BodyTrack> {
        let states = &self.solution.motion;
        let track = |(b, points): (usize, Vec<SkeletonPoint>)| {
            let poses = self.steps.iter().flat_map(|&k| {
                let s = &states.at(k).body(b);
                let [x, y, z] = self.length(s.r);
                let [qw, qx, qy, qz] = s.quaternion();
                [x, y, z, qw, qx, qy, qz]
            });
            BodyTrack {
                name: self.model.bodies[b].name.clone(),
                poses: poses.collect(),
                skeleton: points.iter().map(|p| self.length(p.at)).collect(),
                labels: points.iter().map(|p| p.labels.join(", ")).collect(),
                roles: points.iter().map(|p| p.role).collect(),
                mesh: self.mesh(b),
            }
        };
        self.skeletons().into_iter().enumerate().map(track).collect()
    }

    /// Mesh of the body, in its frame.
    fn mesh(&self, body: usize) -> Option<Mesh> {
        let mesh = self.looks.bodies.get(&body)?;
        let body_from_file = match mesh.frame {
            MeshFrame::World => self.model.bodies[body].frame.inverse(),
            MeshFrame::Body => Pose::IDENTITY,
        };
        let vertices = mesh.vertices.iter();
        Some(Mesh {
            file: mesh.file.clone(),
            positions: vertices.flat_map(|&v| self.length(body_from_file.point(v))).collect(),
            triangles: mesh.triangles.iter().flatten().map(|&vertex| f64::from(vertex)).collect(),
        })
    }

    /// Hardpoints of every body, each location once.
    fn skeletons(&self) -> Vec<Vec<SkeletonPoint>> {
        let geometry = self.model.geometry(&[]);
        let mut skeletons: Vec<Vec<SkeletonPoint>> = Vec::new();
        skeletons.resize_with(self.model.bodies.len(), Vec::new);
        let same = SAME_PLACE * self.model.size();
        let mut add = |body: BodyId, at: Vec3, label: &str, role: PointRole| {
            let list = &mut skeletons[body.0];
            match list.iter_mut().find(|p| (p.at - at).norm() <= same) {
                Some(point) => {
                    point.role = point.role.min(role);
                    if !point.labels.iter().any(|l| l == label) {
                        point.labels.push(label.into());
                    }
                }
                None => list.push(SkeletonPoint { at, labels: vec![label.into()], role }),
            }
        };
        for (j, joint) in self.model.joints.iter().enumerate() {
            // A driven point does not belong to the body of its direction.
            let (ends, role) =
                if is_drawn(joint) { (0..2, PointRole::Joint) } else { (1..2, PointRole::Measured) };
            for end in ends {
                let body = joint.bodies[end];
                add(body, geometry.markers[j][end].r, self.label(joint.at[end], &joint.name), role);
                for at in self.hinge_points(joint).into_iter().flatten() {
                    let name = &self.model.hardpoints[at.0].name;
                    add(body, self.in_body(body, at), name, PointRole::Hinge);
                }
            }
        }
        for (p, point) in self.model.points.iter().enumerate().filter(|(_, p)| !p.unnamed) {
            add(point.body, geometry.points[p], &point.name, PointRole::Measured);
        }
        for wheel in &self.model.wheels {
            let [centre, contact] = self.wheel_places(wheel);
            for point in &mut skeletons[wheel.body.0] {
                let near = |place: Vec3, distance: f64| (point.at - place).norm() <= distance;
                if near(centre, same) || near(contact, NEAR_CONTACT * wheel.radius) {
                    point.role = point.role.min(PointRole::Wheel);
                }
            }
        }
        skeletons
    }

    /// Hardpoints that define the axis of a hinge: both are on both of its bodies.
    pub(super) fn hinge_points(&self, joint: &Joint) -> Option<[HardpointId; 2]> {
        let turns = joint.kind.freedoms.is_some_and(|f| f.iter().all(|f| matches!(f, Freedom::Turn(_))));
        let is_pin = joint.kind.axis != Need::Orienting;
        let has_one_axis = joint.axis2.is_none() || joint.kind.axis2 == Need::Orienting;
        joint.axis.filter(|_| turns && is_pin && has_one_axis)?.hardpoints()
    }

    /// Position of a hardpoint in the design configuration, in a body's frame.
    pub(super) fn in_body(&self, body: BodyId, at: HardpointId) -> Vec3 {
        self.model.bodies[body.0].frame.inverse().point(self.model.hardpoints[at.0].position)
    }

    /// Name of the hardpoint, or of the joint if the model file has coordinates instead.
    fn label<'m>(&'m self, at: HardpointId, joint: &'m str) -> &'m str {
        let hardpoint = &self.model.hardpoints[at.0];
        if hardpoint.unnamed { joint } else { &hardpoint.name }
    }

    /// Drawn joints, with their indices in the model.
    fn drawn_joints(&self) -> impl Iterator<Item = (usize, &Joint)> {
        self.model.joints.iter().enumerate().filter(|(_, joint)| is_drawn(joint))
    }

    /// Index among the drawn joints.
    pub(super) fn drawn(&self, joint: JointId) -> Option<usize> {
        self.drawn_joints().position(|(j, _)| j == joint.0)
    }

    /// Marks of all drawn joints.
    pub(super) fn joints(&self) -> Vec<JointMark> {
        let geometry = self.model.geometry(&[]);
        let roles = &self.analysis.topology().roles;
        let spins = fixed_spins(self.model);
        let mark = |(j, joint): (usize, &Joint)| {
            let [i, k] = &geometry.markers[j];
            // The second pin of a cross is the x axis of body j: z_i . x_j = 0.
            let crosses = joint.kind.rows.contains(&Row::Dot1(2, 0));
            // Axes that orient the markers alone are not those of a motion.
            let moving = |axis: Option<Direction>, need: Need| axis.filter(|_| need != Need::Orienting);
            let axis = moving(joint.axis, joint.kind.axis);
            let axis2 = moving(joint.axis2, joint.kind.axis2).map(|_| match joint.kind.axis2 {
                Need::OnBodyJ => k.rot.cols[2],
                _ if crosses => k.rot.cols[0],
                _ => i.rot.cols[0],
            });
            let ends = axis.and_then(Direction::hardpoints);
            JointMark {
                name: joint.name.clone(),
                kind: written_kind(joint, spins.contains(&JointId(j))),
                body_i: joint.bodies[0].0,
                body_j: joint.bodies[1].0,
                at_i: self.length(i.r),
                at_j: self.length(k.r),
                axis: axis.map(|_| i.rot.cols[2].to_array()),
                axis_j: axis.map(|_| k.rot.cols[2].to_array()),
                axis2: axis2.map(Vec3::to_array),
                slide: match joint.kind.slide {
                    Slide::None => None,
                    Slide::Block => Some(SlideMark { along: Some(i.rot.cols[2].to_array()), either: true }),
                    Slide::Line(k) => {
                        Some(SlideMark { along: Some(i.rot.cols[k].to_array()), either: false })
                    }
                    Slide::Plane => Some(SlideMark { along: None, either: false }),
                },
                hinge: ends.map(|ends| ends.map(|h| self.length(self.in_body(joint.bodies[0], h)))),
                lead: self.lead(JointId(j)),
                curve: joint.curve.as_ref().map(|curve| self.joint_curve(curve, *i)),
                draw: self.looks.joints.get(&j).map(|form| form.name().into()),
                cut: matches!(roles[j], JointRole::Cut(_)),
            }
        };
        self.drawn_joints().map(mark).collect()
    }

    /// Travel per revolution of a screw, in the length unit.
    fn lead(&self, joint: JointId) -> Option<f64> {
        let of_joint = |c: &&Coupler| c.terms.iter().all(|t| t.joint == joint);
        let couplers = self.model.couplers.iter().filter(of_joint);
        couplers.filter_map(|c| c.transmission).find_map(|by| match by {
            Transmission::Screw { lead } => Some(self.units.from_si(Kind::Length, lead)),
            _ => None,
        })
    }

    /// Curve in the x-y plane of a marker, in the frame of its body.
    fn joint_curve(&self, curve: &PlanarCurve, body_from_marker: Pose) -> JointCurve {
        let closed = curve.is_closed();
        let parts = if closed { CURVE_POINTS } else { CURVE_POINTS - 1 };
        let point = |k: usize| {
            // The last point of an open curve is exactly its end, since the curve is undefined beyond.
            let u = if k == parts { curve.length() } else { curve.length() * k as f64 / parts as f64 };
            let [[x, y], ..] = curve.at(u);
            self.length(body_from_marker.point(Vec3::new(x, y, 0.0)))
        };
        JointCurve {
            closed,
            points: (0..CURVE_POINTS).map(point).collect(),
            normal: body_from_marker.rot.cols[2].to_array(),
        }
    }

    /// Marks of gears, racks, belts, screws and other couplers.
    pub(super) fn couplers(&self) -> Vec<CouplerMark> {
        let length = |x: f64| self.units.from_si(Kind::Length, x);
        let mark = |coupler: &Coupler| {
            let terms = coupler.terms.iter().filter_map(|term| {
                let quantity = self.model.coupled(term).quantity;
                let (turns, unit) = match quantity {
                    Kind::Angle => (true, 1.0),
                    _ => (false, self.units.to_si(quantity, 1.0)),
                };
                let joint = self.drawn(term.joint)?;
                Some(CouplerTerm { joint, turns, coefficient: term.coefficient * unit })
            });
            let (kind, sizes) = match coupler.transmission {
                None => (CouplerKind::Linear, Vec::new()),
                Some(Transmission::Gears { teeth, bevel, .. }) => {
                    (if bevel { CouplerKind::Bevel } else { CouplerKind::Gear }, teeth.into())
                }
                Some(Transmission::Rack { radius }) => (CouplerKind::Rack, vec![length(radius)]),
                Some(Transmission::Belt { radii, .. }) => (CouplerKind::Belt, radii.map(length).into()),
                Some(Transmission::Screw { lead }) => (CouplerKind::Screw, vec![length(lead)]),
            };
            CouplerMark { name: coupler.name.clone(), kind, terms: terms.collect(), sizes }
        };
        self.model.couplers.iter().map(mark).collect()
    }

    /// Driven coordinates with their curves.
    pub(super) fn drivers(&self) -> Vec<DriverMark> {
        let geometry = self.model.geometry(&[]);
        let mark = |(d, driver): (usize, &Driver)| {
            let JointId(j) = driver.joint;
            let joint = &self.model.joints[j];
            let coordinate = self.model.driven(driver);
            let turns = coordinate.quantity == Kind::Angle;
            let [i, k] = &geometry.markers[j];
            let drawn = self.drawn(driver.joint);
            let in_world = || self.model.bodies[joint.bodies[0].0].frame.rot * i.rot.cols[2];
            let law = driver.coordinate_law();
            let travel = |step: usize| {
                let at = law.at(self.solution.motion.times[step]).value();
                if turns { at } else { self.units.from_si(coordinate.quantity, at) }
            };
            DriverMark {
                name: driver.name.clone(),
                law: format!("{law} {}", symbol(self.units, coordinate.quantity)),
                joint: drawn,
                turns,
                point: drawn.is_none().then(|| BodyPlace { body: joint.bodies[1].0, at: self.length(k.r) }),
                along: drawn.is_none().then(|| in_world().to_array()),
                travel: self.curve(travel),
                alone: self.alone.map_or_else(Vec::new, |rates| self.by_driver(rates, d)),
            }
        };
        self.model.drivers.iter().enumerate().map(mark).collect()
    }

    /// Rates of outputs by one driver alone, per length unit or radian.
    fn by_driver(&self, rates: &DriverRates, driver: usize) -> Vec<Curve> {
        let DriverId(of) = rates.drivers[driver];
        let driven = self.model.driven(&self.model.drivers[of]).quantity;
        let unit = if driven == Kind::Angle { 1.0 } else { self.units.from_si(driven, 1.0) };
        let curve = |(m, output): (usize, &Output)| {
            let rate =
                |k: usize| if k < rates.times.len() { rates.value(k, driver, m) } else { Some(f64::NAN) };
            let known = rates.outputs[m].known.by_position;
            let of_unit = |k: usize| self.units.from_si(output.dimension, rate(k).unwrap_or(f64::NAN)) / unit;
            if known { self.curve(of_unit) } else { Curve::default() }
        };
        rates.outputs.iter().enumerate().map(curve).collect()
    }

    /// Location of a point of the model.
    pub(super) fn place(&self, point: PointId) -> BodyPlace {
        let of = &self.model.points[point.0];
        BodyPlace { body: of.body.0, at: self.length(self.in_body(of.body, of.at)) }
    }

    /// Unit vector of a direction in the design configuration, in a body's frame.
    fn direction_in_body(&self, body: BodyId, direction: Direction) -> Vec3 {
        let along = match direction {
            Direction::Along(u) => u,
            Direction::Through(a, b) => {
                let [a, b] = [a, b].map(|h| self.model.hardpoints[h.0].position);
                (b - a) * (1.0 / (b - a).norm())
            }
        };
        self.model.bodies[body.0].frame.rot.transpose_mul(along)
    }

    /// Centre and ground contact of a wheel in the design configuration, in the frame of its body.
    fn wheel_places(&self, wheel: &Wheel) -> [Vec3; 2] {
        let axis = self.direction_in_body(wheel.body, wheel.spin_axis);
        let up = self.model.bodies[wheel.body.0].frame.rot.transpose_mul(Vec3::new(0.0, 0.0, 1.0));
        // Downward direction in the wheel plane.
        let down = axis * axis.dot(up) - up;
        let centre = self.in_body(wheel.body, self.model.points[wheel.centre.0].at);
        [centre, centre + down * (wheel.radius / down.norm())]
    }

    /// Marks of road wheels.
    pub(super) fn wheels(&self) -> Vec<WheelMark> {
        let mark = |wheel: &Wheel| WheelMark {
            name: wheel.name.clone(),
            centre: self.place(wheel.centre),
            axis: self.direction_in_body(wheel.body, wheel.spin_axis).to_array(),
            radius: self.units.from_si(Kind::Length, wheel.radius),
            kingpin: wheel.kingpin.map(|ends| ends.map(|p| self.place(p))),
        };
        self.model.wheels.iter().map(mark).collect()
    }

    /// Vehicle axes, if the mechanism has road wheels.
    pub(super) fn vehicle(&self) -> Option<VehicleAxes> {
        (!self.model.wheels.is_empty()).then_some(VEHICLE)
    }

    /// Marks of measured distances.
    pub(super) fn distances(&self) -> Vec<DistanceMark> {
        let mark = |(m, measure): (usize, &Measure)| {
            let MeasureKind::Distance { from, to } = measure.kind else { return None };
            Some(DistanceMark {
                name: measure.name.clone(),
                from: self.place(from),
                to: self.place(to),
                draw: self.looks.measures.get(&m).map(|form| form.name().into()),
            })
        };
        self.model.measures.iter().enumerate().filter_map(mark).collect()
    }

    /// Design velocity of every marker and named point that the variable moves, in the frame of its body.
    pub(super) fn arrows(&self, variable: VariableId) -> Vec<Arrow> {
        let geometry = self.model.geometry(&[]);
        let field = self.model.field(variable);
        let by = self.model.variables[variable.0].quantity;
        let speed = |v: Vec3| v.to_array().map(|x| self.units.derivative_from_si(Kind::Length, by, x));
        let markers = field.markers.iter().map(|m| {
            let JointId(j) = m.joint;
            let s = geometry.markers[j][m.end].r;
            Arrow {
                body: self.model.joints[j].bodies[m.end].0,
                at: self.length(s),
                v: speed(m.twist.at(s)),
                turn: m.twist.w.to_array().map(|x| self.units.derivative_from_si(Kind::Angle, by, x)),
            }
        });
        let points = field.points.iter().map(|(p, v)| Arrow {
            body: self.model.points[p.0].body.0,
            at: self.length(geometry.points[p.0]),
            v: speed(*v),
            turn: [0.0; 3],
        });
        // The marker of a hinge is at one end of its axis; the velocity is also shown at the other end.
        let far_ends = self.model.variables[variable.0].changes.iter().filter_map(Change::hardpoint);
        let far_ends = far_ends.flat_map(|(at, velocity)| {
            let hinges = self.model.joints.iter().filter(move |j| j.at[0] != at);
            let hinges = hinges.filter(move |j| self.hinge_points(j).is_some_and(|ends| ends.contains(&at)));
            hinges.flat_map(|j| j.bodies).map(move |body| Arrow {
                body: body.0,
                at: self.length(self.in_body(body, at)),
                v: speed(self.model.bodies[body.0].frame.rot.transpose_mul(velocity)),
                turn: [0.0; 3],
            })
        });
        markers.chain(points).chain(far_ends).collect()
    }
}
