//! What a design variable does to the markers: exactly for a finite change, and to first order.

use super::*;
use crate::space::{Twist, euler_313_from_rotation, euler_rates, rotation_from_euler_313};

/// The body-fixed data of one design: everything that the analysis needs and that a design may change.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry {
    /// Per joint, marker i in body i and marker j in body j.
    pub markers: Vec<[Pose; 2]>,
    /// Per joint, the distance between its markers in the design configuration, m.
    pub lengths: Vec<f64>,
    /// Per point of the model, its position in its body's frame, m.
    pub points: Vec<Vec3>,
    /// Per measure with a spin axis, that unit vector in its body's frame; null for the others.
    pub spin_axes: Vec<Vec3>,
}

/// The first-order change of a [`Geometry`] per unit of one design variable: the paper's design
/// velocity, with V and R(theta) U of a marker combined into a body-fixed twist (`docs/theory.md` (8)).
///
/// Every list is in the order of its ids.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Field {
    /// The markers that move or turn.
    pub markers: Vec<MarkerField>,
    /// The rods and legs whose design length changes, and its rate.
    pub lengths: Vec<(JointId, f64)>,
    /// The points that move, and their velocity in the body's frame.
    pub points: Vec<(PointId, Vec3)>,
    /// The spin axes that turn, and their rate in the body's frame.
    pub spin_axes: Vec<(MeasureId, Vec3)>,
}

/// The design velocity of one marker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarkerField {
    /// Which joint.
    pub joint: JointId,
    /// 0 for the marker on body i, 1 for that on body j.
    pub end: usize,
    /// Body-fixed twist `[R U; V - (R U) x s]` in the body's frame.
    pub twist: Twist,
}

impl Field {
    /// The twist of a joint's marker, if it moves.
    pub fn twist_of(&self, joint: JointId, end: usize) -> Option<Twist> {
        let found = self.markers.binary_search_by_key(&(joint, end), |m| (m.joint, m.end));
        found.ok().map(|k| self.markers[k].twist)
    }

    /// Rate of a joint's design length.
    pub fn length_rate(&self, joint: JointId) -> f64 {
        let found = self.lengths.binary_search_by_key(&joint, |l| l.0);
        found.map_or(0.0, |k| self.lengths[k].1)
    }
}

impl Model {
    /// The geometry of the design with variable k at `design[k]` (missing entries are 0).
    ///
    /// Body frames stay where they are in the design configuration; markers move on their bodies.
    pub fn geometry(&self, design: &[f64]) -> Geometry {
        let value = |k: usize| design.get(k).copied().unwrap_or(0.0);
        let places = self.places(&value);
        let all = || self.variables.iter().enumerate();
        let changes = self.marker_changes(all().map(|(k, v)| (value(k), v)));
        // Lengths are measured between the hardpoints as moved by all variables that do not keep them.
        let follows = |k: usize| if self.variables[k].fixed_length { 0.0 } else { value(k) };
        let for_lengths = self.places(&follows);
        let changes_of_length = self.marker_changes(all().map(|(k, v)| (follows(k), v)));
        let markers = (0..self.joints.len())
            .map(|j| {
                std::array::from_fn(|e| {
                    let frame = self.bodies[self.joints[j].bodies[e].0].frame;
                    frame.inverse().compose(self.marker_in_world(j, e, &places, &changes[j]))
                })
            })
            .collect();
        let lengths = (0..self.joints.len())
            .map(|j| {
                let [i, k] =
                    [0, 1].map(|e| self.marker_in_world(j, e, &for_lengths, &changes_of_length[j]).r);
                (k - i).norm()
            })
            .collect();
        let points =
            self.points.iter().map(|p| self.bodies[p.body.0].frame.inverse().point(places[p.at.0])).collect();
        let spin_axes = self
            .measures
            .iter()
            .map(|m| match &m.kind {
                MeasureKind::Toe { body, spin_axis } | MeasureKind::Camber { body, spin_axis } => {
                    self.bodies[body.0].frame.rot.transpose_mul(direction(*spin_axis, &places))
                }
                _ => Vec3::ZERO,
            })
            .collect();
        Geometry { markers, lengths, points, spin_axes }
    }

    /// Global positions of all hardpoints.
    fn places(&self, value: &dyn Fn(usize) -> f64) -> Vec<Vec3> {
        let mut places: Vec<Vec3> = self.hardpoints.iter().map(|h| h.position).collect();
        for (k, v) in self.variables.iter().enumerate() {
            for change in &v.changes {
                if let Change::Move { hardpoint, velocity } = change {
                    places[hardpoint.0] += *velocity * value(k);
                }
            }
        }
        places
    }

    /// Per joint: what these variables do to its markers themselves, with the variable's value, in order.
    fn marker_changes<'v>(
        &self,
        variables: impl Iterator<Item = (f64, &'v DesignVariable)>,
    ) -> Vec<Vec<(f64, &'v Change)>> {
        let mut changes = vec![Vec::new(); self.joints.len()];
        for (b, v) in variables.filter(|(b, _)| *b != 0.0) {
            for change in &v.changes {
                if let Some(joint) = change.joint() {
                    changes[joint.0].push((b, change));
                }
            }
        }
        changes
    }

    /// Marker e of joint j in the design configuration of a changed design.
    fn marker_in_world(&self, j: usize, e: usize, places: &[Vec3], changes: &[(f64, &Change)]) -> Pose {
        let joint = &self.joints[j];
        let mut rot = self.followed_frame(joint, places);
        let mut r = places[joint.at[e].0];
        for &(b, change) in changes {
            match change {
                Change::Marker { end, position, rotation, .. } if end.covers(e) => {
                    r += *position * b;
                    rot = Mat3::from_rotation_vector(*rotation * b) * rot;
                }
                Change::Field { end, v, u, .. } if *end == e => {
                    let body = self.bodies[joint.bodies[e].0].frame.rot;
                    r += body * *v * b;
                    let (theta, c) = self.euler_of(joint, e);
                    let turned = rotation_from_euler_313([0, 1, 2].map(|n| theta[n] + b * u[n]));
                    rot = body * turned * c.transpose() * body.transpose() * rot;
                }
                _ => {}
            }
        }
        Pose { rot, r }
    }

    /// 3-1-3 Euler angles of a marker in its body's frame, and their rotation C(theta).
    fn euler_of(&self, joint: &Joint, e: usize) -> ([f64; 3], Mat3) {
        let in_body = self.bodies[joint.bodies[e].0].frame.rot.transpose() * joint.frame;
        let theta = euler_313_from_rotation(in_body);
        (theta, rotation_from_euler_313(theta))
    }

    /// The marker frame of a joint whose axes follow the hardpoints they pass through.
    ///
    /// z turns by the smallest rotation to its new direction; x then turns about z with `axis2`.
    fn followed_frame(&self, joint: &Joint, places: &[Vec3]) -> Mat3 {
        let mut rot = joint.frame;
        if let Some(axis @ Direction::Through(..)) = joint.axis {
            rot = Mat3::between(rot.cols[2], direction(axis, places)) * rot;
        }
        if let Some(axis2 @ Direction::Through(..)) = joint.axis2 {
            let (d, z) = (direction(axis2, places), rot.cols[2]);
            if let Some(x) = (d - z * z.dot(d)).unit() {
                rot = Mat3 { cols: [x, z.cross(x), z] };
            }
        }
        rot
    }

    /// The first-order change of the geometry per unit of one variable.
    ///
    /// Paper Eqs. 3.1 to 3.10 and 5.5; `docs/theory.md` (8).
    pub fn field(&self, variable: VariableId) -> Field {
        let v = &self.variables[variable.0];
        let mut speeds = vec![Vec3::ZERO; self.hardpoints.len()];
        for change in &v.changes {
            if let Change::Move { hardpoint, velocity } = change {
                speeds[hardpoint.0] += *velocity;
            }
        }
        let changes = self.marker_changes(std::iter::once((1.0, v)));
        let mut field = Field::default();
        for (j, joint) in self.joints.iter().enumerate() {
            let rates = [0, 1].map(|e| self.marker_rates(&changes[j], j, e, &speeds));
            for (end, (p, w)) in rates.into_iter().enumerate() {
                if p != Vec3::ZERO || w != Vec3::ZERO {
                    let frame = self.bodies[joint.bodies[end].0].frame;
                    let s = frame.inverse().point(self.position(joint.at[end]));
                    let (p, w) = (frame.rot.transpose_mul(p), frame.rot.transpose_mul(w));
                    field.markers.push(MarkerField {
                        joint: JointId(j),
                        end,
                        twist: Twist { w, v: p - w.cross(s) },
                    });
                }
            }
            if !v.fixed_length {
                let d = self.position(joint.at[1]) - self.position(joint.at[0]);
                if let Some(u) = d.unit() {
                    let rate = u.dot(rates[1].0 - rates[0].0);
                    if rate != 0.0 {
                        field.lengths.push((JointId(j), rate));
                    }
                }
            }
        }
        for (k, p) in self.points.iter().enumerate() {
            if speeds[p.at.0] != Vec3::ZERO {
                let rot = self.bodies[p.body.0].frame.rot;
                field.points.push((PointId(k), rot.transpose_mul(speeds[p.at.0])));
            }
        }
        for (k, m) in self.measures.iter().enumerate() {
            if let MeasureKind::Toe { body, spin_axis } | MeasureKind::Camber { body, spin_axis } = &m.kind {
                let rate = self.direction_rate(*spin_axis, &speeds);
                if rate != Vec3::ZERO {
                    field.spin_axes.push((MeasureId(k), self.bodies[body.0].frame.rot.transpose_mul(rate)));
                }
            }
        }
        field
    }

    /// Velocity of a marker's origin and rotation rate of its axes per unit of a variable, global.
    fn marker_rates(&self, changes: &[(f64, &Change)], j: usize, e: usize, speeds: &[Vec3]) -> (Vec3, Vec3) {
        let joint = &self.joints[j];
        let mut p = speeds[joint.at[e].0];
        let mut w = Vec3::ZERO;
        if let Some(axis) = joint.axis {
            let z = joint.frame.cols[2];
            w += z.cross(self.direction_rate(axis, speeds));
        }
        if let Some(axis2) = joint.axis2 {
            let [_, y, z] = joint.frame.cols;
            w += z * y.dot(self.direction_rate(axis2, speeds));
        }
        for (_, change) in changes {
            match change {
                Change::Marker { end, position, rotation, .. } if end.covers(e) => {
                    p += *position;
                    w += *rotation;
                }
                Change::Field { end, v, u, .. } if *end == e => {
                    let body = self.bodies[joint.bodies[e].0].frame.rot;
                    p += body * *v;
                    w += body * euler_rates(self.euler_of(joint, e).0, *u);
                }
                _ => {}
            }
        }
        (p, w)
    }

    /// Rate of a unit direction while its hardpoints move.
    fn direction_rate(&self, d: Direction, speeds: &[Vec3]) -> Vec3 {
        match d {
            Direction::Along(_) => Vec3::ZERO,
            Direction::Through(a, b) => {
                let d = self.position(b) - self.position(a);
                let u = d * (1.0 / d.norm());
                let rate = (speeds[b.0] - speeds[a.0]) * (1.0 / d.norm());
                rate - u * u.dot(rate)
            }
        }
    }

    pub(crate) fn position(&self, h: HardpointId) -> Vec3 {
        self.hardpoints[h.0].position
    }
}

impl Change {
    /// The joint whose markers it changes; none for a hardpoint.
    fn joint(&self) -> Option<JointId> {
        match self {
            Self::Move { .. } => None,
            Self::Marker { joint, .. } | Self::Field { joint, .. } => Some(*joint),
        }
    }
}

/// The unit vector of a direction, its hardpoints being at `places`.
fn direction(d: Direction, places: &[Vec3]) -> Vec3 {
    match d {
        Direction::Along(u) => u,
        Direction::Through(a, b) => {
            let d = places[b.0] - places[a.0];
            d * (1.0 / d.norm())
        }
    }
}
