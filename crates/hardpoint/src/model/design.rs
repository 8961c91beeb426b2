//! What a design variable does to the markers: exactly for a finite change, and to first order.

use super::*;
use crate::constraint::Row;
use crate::joint::Need;
use crate::law::Law;
use crate::space::{Twist, euler_313_from_rotation, euler_rates, rotation_from_euler_313};

/// The body-fixed data of one design: everything that the analysis needs and that a design may change.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry {
    /// Per joint, marker i in body i and marker j in body j.
    pub markers: Vec<[Pose; 2]>,
    /// Per joint, what its constraints may keep of the design configuration.
    pub kept: Vec<Kept>,
    /// Per point of the model, its position in its body's frame, m.
    pub points: Vec<Vec3>,
    /// Per measure with a spin axis, that unit vector in its body's frame; null for the others.
    pub spin_axes: Vec<Vec3>,
    /// Per driver, its law.
    pub laws: Vec<Law>,
}

/// What a joint can keep of its design configuration, or the rate at which a design variable changes it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Kept {
    /// Distance between its markers, m: the length of a rod.
    pub distance: f64,
    /// Displacement of marker j along z_i, m.
    pub offset: f64,
    /// Cosine of the angle between z_i and z_j.
    pub cosine: f64,
    /// Distance of marker j from the curve of marker i, positive on its left, m.
    pub contact: f64,
}

impl Kept {
    /// What this constraint keeps; 0 for those that keep nothing.
    pub fn by(&self, row: Row) -> f64 {
        match row {
            Row::Distance => self.distance,
            Row::Offset => self.offset,
            Row::Cosine => self.cosine,
            Row::Contact => self.contact,
            _ => 0.0,
        }
    }
}

/// The first-order change of a [`Geometry`] per unit of one design variable: the paper's design
/// velocity, with V and R(theta) U of a marker combined into a body-fixed twist (`docs/theory.md` (8)).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Field {
    /// The markers that move or turn.
    pub markers: Vec<MarkerField>,
    /// The joints whose kept values change, and their rates.
    pub kept: Vec<(JointId, Kept)>,
    /// The points that move, and their velocity in the body's frame.
    pub points: Vec<(PointId, Vec3)>,
    /// The spin axes that turn, and their rate in the body's frame.
    pub spin_axes: Vec<(MeasureId, Vec3)>,
    /// The drivers whose laws change: the parameter, and its rate.
    pub laws: Vec<(DriverId, usize, f64)>,
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

impl Model {
    /// The geometry of the design with variable k at `design[k]` (missing entries are 0).
    ///
    /// Body frames stay where they are in the design configuration; markers move on their bodies.
    pub fn geometry(&self, design: &[f64]) -> Geometry {
        let value = |k: usize| design.get(k).copied().unwrap_or(0.0);
        let places = self.places(&value);
        // Lengths are measured between the hardpoints as moved by all variables that do not keep them.
        let follows = |k: usize| if self.variables[k].fixed_length { 0.0 } else { value(k) };
        let for_lengths = self.places(&follows);
        let markers = (0..self.joints.len())
            .map(|j| {
                std::array::from_fn(|e| {
                    let frame = self.bodies[self.joints[j].bodies[e].0].frame;
                    frame.inverse().compose(self.marker_in_world(j, e, &places, &value))
                })
            })
            .collect();
        let kept = (0..self.joints.len())
            .map(|j| {
                let [m_i, m_j] = [0, 1].map(|e| self.marker_in_world(j, e, &for_lengths, &follows));
                let (d, z_i, z_j) = (m_j.r - m_i.r, m_i.rot.cols[2], m_j.rot.cols[2]);
                let given = self.joints[j].length.map(|length| length + self.length_change(j, &value));
                let contact = self.joints[j].curve.as_ref().map_or(0.0, |curve| {
                    let (drawn, _) = curve.distance(m_i.rot.transpose_mul(d));
                    given.map_or(drawn, |length| length.copysign(drawn))
                });
                Kept {
                    distance: given.unwrap_or(d.norm()),
                    offset: z_i.dot(d),
                    cosine: z_i.dot(z_j),
                    contact,
                }
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
        let laws = self.drivers.iter().enumerate().map(|(k, d)| self.changed_law(k, d, &value)).collect();
        Geometry { markers, kept, points, spin_axes, laws }
    }

    /// The law of a driver in a changed design.
    fn changed_law(&self, k: usize, driver: &Driver, value: &dyn Fn(usize) -> f64) -> Law {
        let mut law = driver.law.clone();
        for (n, variable) in self.variables.iter().enumerate().filter(|(n, _)| value(*n) != 0.0) {
            for change in &variable.changes {
                if let Change::Law { driver, parameter, rate } = change
                    && driver.0 == k
                {
                    let now = law.parameters()[*parameter].value;
                    law = law.with_parameter(*parameter, now + rate * value(n));
                }
            }
        }
        law
    }

    /// By how much a design has changed the given length of a rod.
    fn length_change(&self, j: usize, value: &dyn Fn(usize) -> f64) -> f64 {
        let rates =
            self.variables.iter().enumerate().flat_map(|(k, v)| v.changes.iter().map(move |c| (k, c)));
        rates
            .map(|(k, change)| match change {
                Change::Length { joint, rate } if joint.0 == j => rate * value(k),
                _ => 0.0,
            })
            .sum()
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

    /// Marker e of joint j in the design configuration of a changed design.
    fn marker_in_world(&self, j: usize, e: usize, places: &[Vec3], value: &dyn Fn(usize) -> f64) -> Pose {
        let joint = &self.joints[j];
        let mut rot = self.followed_frame(joint, e, places);
        let mut r = places[joint.at[e].0];
        for (k, v) in self.variables.iter().enumerate() {
            let b = value(k);
            if b == 0.0 {
                continue;
            }
            for change in &v.changes {
                match change {
                    Change::Marker { joint, end, position, rotation } if joint.0 == j && end.covers(e) => {
                        r += *position * b;
                        rot = Mat3::from_rotation_vector(*rotation * b) * rot;
                    }
                    Change::Field { joint: id, end, v, u } if id.0 == j && *end == e => {
                        let body = self.bodies[joint.bodies[e].0].frame.rot;
                        r += body * *v * b;
                        let (theta, c) = self.euler_of(joint, e);
                        let turned = rotation_from_euler_313([0, 1, 2].map(|n| theta[n] + b * u[n]));
                        rot = body * turned * c.transpose() * body.transpose() * rot;
                    }
                    _ => {}
                }
            }
        }
        Pose { rot, r }
    }

    /// 3-1-3 Euler angles of a marker in its body's frame, and their rotation C(theta).
    fn euler_of(&self, joint: &Joint, e: usize) -> ([f64; 3], Mat3) {
        let in_body = self.bodies[joint.bodies[e].0].frame.rot.transpose() * joint.frames[e];
        let theta = euler_313_from_rotation(in_body);
        (theta, rotation_from_euler_313(theta))
    }

    /// The frame of marker e of a joint whose axes follow the hardpoints they pass through.
    ///
    /// z turns by the smallest rotation to its new direction; x then turns about z with `axis2`.
    fn followed_frame(&self, joint: &Joint, e: usize, places: &[Vec3]) -> Mat3 {
        let mut rot = joint.frames[e];
        let [axis, axis2] = joint.axes_of_marker(e);
        if let Some(axis @ Direction::Through(..)) = axis {
            rot = Mat3::between(rot.cols[2], direction(axis, places)) * rot;
        }
        if let Some(axis2 @ Direction::Through(..)) = axis2 {
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
        let mut field = Field::default();
        for (j, joint) in self.joints.iter().enumerate() {
            let rates = [0, 1].map(|e| self.marker_rates(v, j, e, &speeds));
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
            let kept = self.kept_rate(v, j, rates);
            if kept != Kept::default() {
                field.kept.push((JointId(j), kept));
            }
        }
        for change in &v.changes {
            if let Change::Law { driver, parameter, rate } = change {
                field.laws.push((*driver, *parameter, *rate));
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

    /// Rates of what a joint keeps, its markers moving and turning at these rates.
    fn kept_rate(&self, v: &DesignVariable, j: usize, [(p_i, w_i), (p_j, w_j)]: [(Vec3, Vec3); 2]) -> Kept {
        let (m_i, m_j) = (self.marker(JointId(j), 0), self.marker(JointId(j), 1));
        let (d, z_i, z_j) = (m_j.r - m_i.r, m_i.rot.cols[2], m_j.rot.cols[2]);
        let mut kept = Kept::default();
        if !v.fixed_length {
            kept.offset = w_i.cross(z_i).dot(d) + z_i.dot(p_j - p_i);
            kept.cosine = w_i.cross(z_i).dot(z_j) + z_i.dot(w_j.cross(z_j));
            if let (None, Some(u)) = (self.joints[j].length, d.unit()) {
                kept.distance = u.dot(p_j - p_i);
            }
            if let (None, Some(curve)) = (self.joints[j].length, &self.joints[j].curve) {
                let (_, normal) = curve.distance(m_i.rot.transpose_mul(d));
                kept.contact = (m_i.rot * normal).dot(p_j - p_i - w_i.cross(d));
            }
        }
        for change in &v.changes {
            if let Change::Length { joint, rate } = change
                && joint.0 == j
            {
                kept.distance += rate;
                if let Some(curve) = &self.joints[j].curve {
                    kept.contact += rate.copysign(rate * curve.distance(m_i.rot.transpose_mul(d)).0);
                }
            }
        }
        kept
    }

    /// Velocity of a marker's origin and rotation rate of its axes per unit of a variable, global.
    fn marker_rates(&self, v: &DesignVariable, j: usize, e: usize, speeds: &[Vec3]) -> (Vec3, Vec3) {
        let joint = &self.joints[j];
        let mut p = speeds[joint.at[e].0];
        let mut w = Vec3::ZERO;
        let [axis, axis2] = joint.axes_of_marker(e);
        if let Some(axis) = axis {
            let z = joint.frames[e].cols[2];
            w += z.cross(self.direction_rate(axis, speeds));
        }
        if let Some(axis2) = axis2 {
            let [_, y, z] = joint.frames[e].cols;
            w += z * y.dot(self.direction_rate(axis2, speeds));
        }
        for change in &v.changes {
            match change {
                Change::Marker { joint, end, position, rotation } if joint.0 == j && end.covers(e) => {
                    p += *position;
                    w += *rotation;
                }
                Change::Field { joint: id, end, v, u } if id.0 == j && *end == e => {
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

impl Joint {
    /// The directions of z and x of marker e, as far as they are given.
    fn axes_of_marker(&self, e: usize) -> [Option<Direction>; 2] {
        match (self.kind.axis2, e) {
            (Need::OnBodyJ, 0) => [self.axis, None],
            (Need::OnBodyJ, _) => [self.axis2, None],
            _ => [self.axis, self.axis2],
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
