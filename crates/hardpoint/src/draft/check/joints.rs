//! Checks of joints: bodies, locations, axes, lengths, leads and curves.

use crate::constraint::Row;
use crate::draft::{DirectionDraft, JointDraft, Section};
use crate::joint;
use crate::joint::{JointType, Need};
use crate::model::{BodyId, Curve, Direction, GROUND, Hardpoint, HardpointId, Joint, JointId};
use crate::space::{Mat3, Pose, Vec3};

use super::{
    Checker, Here, ON_CURVE, PERPENDICULAR_TOLERANCE, SAME_POINT, UNPLACED, degrees_between, frame_along,
};

/// Returns the default direction of the markers' x axis. For a mirror image across a global axis: the image of the
/// original's default.
fn default_x(z: Vec3, mirror: Option<usize>) -> Vec3 {
    let reflected = |v: Vec3| mirror.map_or(v, |k| v - Vec3::AXES[k] * (2.0 * v.dot(Vec3::AXES[k])));
    reflected(reflected(z).any_perpendicular())
}

impl Checker<'_> {
    pub(super) fn add_joints(&mut self) {
        let draft = self.draft;
        for (index, j) in draft.joints.iter().enumerate() {
            let before = self.faults.len();
            let joint = self.one_joint(j, Here { section: Section::Joints, index });
            let id = match joint {
                Some(joint) if self.faults.len() == before && !draft.unread.any(Section::Joints, index) => {
                    self.model.joints.push(joint);
                    Some(JointId(self.model.joints.len() - 1))
                }
                _ => None,
            };
            self.joint_ids.push(id);
        }
    }

    fn one_joint(&mut self, j: &JointDraft, here: Here) -> Option<Joint> {
        let kind = self.joint_type(&j.kind, here);
        let bodies = self.joint_bodies(j, here);
        let kind = kind?;
        let [axis, axis2] = self.joint_axes(j, kind, here);
        let at = self.joint_places(j, kind, axis.map(|a| a.0), here);
        let frames = self.joint_frames(j, kind, [axis, axis2].map(|a| a.map(|(_, u)| u)), here)?;
        let length = self.rod_length(j, kind, here);
        self.check_lead(j, kind, here);
        let (axis, axis2) = (axis.map(|a| a.0), axis2.map(|a| a.0));
        let (bodies, at) = (bodies?, at?);
        let curve = self.curve(j, kind, at, frames[0], here);
        if let (Some(curve), Some(_)) = (&curve, length) {
            self.check_side(j, curve, at, frames[0], here);
        }
        if j.axis.is_some() && axis.is_none() || j.axis2.is_some() && axis2.is_none() {
            return None;
        }
        let (name, cut) = (j.name.clone(), j.cut);
        Some(Joint { name, kind, bodies, at, axis, axis2, frames, length, curve, cut, unnamed: false })
    }

    /// Returns the joint type of this name or alias.
    fn joint_type(&mut self, written: &str, here: Here) -> Option<&'static JointType> {
        joint::named(written).or_else(|| {
            let names =
                joint::ALL.iter().flat_map(|t| std::iter::once(t.name).chain(t.aliases.iter().copied()));
            self.find("joint type", written, here.key("type"), names);
            None
        })
    }

    /// HP0207: a joint that connects a body with itself.
    fn joint_bodies(&mut self, j: &JointDraft, here: Here) -> Option<[BodyId; 2]> {
        let body_i = self.body(&j.bodies[0], here.item("bodies", 0));
        let body_j = self.body(&j.bodies[1], here.item("bodies", 1));
        if body_i.is_some() && body_i == body_j {
            let message = format!("joint `{}` connects body `{}` with itself", j.name, j.bodies[0]);
            self.fault("HP0207", here.key("bodies"), message)
                .help("name two different bodies, or `ground` for one");
        }
        Some([body_i?, body_j?])
    }

    /// Returns the axes with their unit vectors. HP0208: an axis that is missing or does not apply to the joint type.
    fn joint_axes(
        &mut self,
        j: &JointDraft,
        kind: &'static JointType,
        here: Here,
    ) -> [Option<(Direction, Vec3)>; 2] {
        let name = &j.name;
        [(&j.axis, kind.axis, "axis"), (&j.axis2, kind.axis2, "axis2")].map(|(line, need, key)| {
            match (line, need) {
                (Some(line), Need::Required | Need::Optional | Need::OnBodyJ | Need::Orienting) => {
                    self.line(line, name, here, key)
                }
                (None, Need::Optional | Need::Orienting | Need::Unused) => None,
                (None, _) if self.unread(here, key) => None,
                (None, Need::Required | Need::OnBodyJ) => {
                    let message = format!("joint `{name}` has no `{key}`");
                    self.fault("HP0208", here.key("type"), message)
                        .note(format!("{}: {}", kind.name, kind.summary))
                        .help(format!(
                            "add a direction, like `{key} = [0, 0, 1]`, or let it pass through two hardpoints"
                        ));
                    None
                }
                (Some(_), Need::Unused) => {
                    let message = format!("`{key}` does not apply to {} joints", kind.name);
                    self.fault("HP0208", here.key(key), message)
                        .help(format!("remove `{key}` from `{name}`"));
                    None
                }
            }
        })
    }

    /// Returns the frames of both markers. HP0209: axes that are parallel or not perpendicular. HP0208: a second axis
    /// without the first.
    fn joint_frames(
        &mut self,
        j: &JointDraft,
        kind: &'static JointType,
        [axis, axis2]: [Option<Vec3>; 2],
        here: Here,
    ) -> Option<[Mat3; 2]> {
        let name = &j.name;
        Some(match (axis, axis2) {
            (Some(z), Some(z_j)) if kind.axis2 == Need::OnBodyJ => {
                let cosine = z.dot(z_j);
                if kind.rows.contains(&Row::Cosine) && cosine.abs() > 1.0 - PERPENDICULAR_TOLERANCE {
                    let message = format!(
                        "the axes of joint `{name}` are parallel, where the angle between them is singular"
                    );
                    self.fault("HP0209", here.key("axis2"), message).help("use a `parallel` joint");
                }
                if kind.rows.contains(&Row::ConstantVelocity) && cosine < PERPENDICULAR_TOLERANCE {
                    let message = format!("the shafts of joint `{name}` are at an angle of 90 deg or more");
                    self.fault("HP0209", here.key("axis2"), message)
                        .note(format!(
                            "the angle between `axis` and `axis2` is {:.4} deg",
                            degrees_between(z, z_j)
                        ))
                        .help("point both axes along the train, less than 90 deg apart");
                }
                let i = frame_along(z, default_x(z, j.mirror));
                [i, Mat3::between(z, z_j) * i]
            }
            (Some(z), Some(x)) => {
                let is_orienting = kind.axis2 == Need::Orienting;
                if is_orienting && z.cross(x).norm() <= PERPENDICULAR_TOLERANCE {
                    let message = format!("the axes of joint `{name}` are parallel to each other");
                    self.fault("HP0209", here.key("axis2"), message).help("give two different directions");
                }
                if !is_orienting && z.dot(x).abs() > PERPENDICULAR_TOLERANCE {
                    let angle = degrees_between(z, x);
                    let message = format!("the axes of joint `{name}` are not perpendicular to each other");
                    self.fault("HP0209", here.key("axis2"), message)
                        .note(format!("the angle between `axis` and `axis2` is {angle:.4} deg"))
                        .help("rotate one of them until they are perpendicular");
                }
                [frame_along(z, (x - z * z.dot(x)).unit()?); 2]
            }
            (Some(z), None) => [frame_along(z, default_x(z, j.mirror)); 2],
            (None, _) => {
                let is_missing = j.axis.is_none() && !self.unread(here, "axis");
                if is_missing && j.axis2.is_some() && kind.axis == Need::Orienting {
                    let message = format!("joint `{name}` has `axis2`, but no `axis`");
                    self.fault("HP0208", here.key("axis2"), message)
                        .help("add `axis`, the direction of its z axis");
                }
                [Mat3::IDENTITY; 2]
            }
        })
    }

    /// HP0226: a curve that is missing, does not apply to the joint type, or is invalid in the plane perpendicular to
    /// the joint's axis.
    fn curve(
        &mut self,
        j: &JointDraft,
        kind: &'static JointType,
        at: [HardpointId; 2],
        frame: Mat3,
        here: Here,
    ) -> Option<Curve> {
        let name = &j.name;
        if self.unread(here, "curve") {
            return None;
        }
        let draft = match (&j.curve, kind.follows_curve()) {
            (None, false) => return None,
            (Some(_), false) => {
                self.fault(
                    "HP0226",
                    here.key("curve"),
                    format!("`curve` does not apply to {} joints", kind.name),
                )
                .help(format!("remove `curve` from `{name}`, or make it a `point_on_curve`"));
                return None;
            }
            (None, true) => {
                self.fault("HP0226", here.key("type"), format!("joint `{name}` has no `curve`"))
                    .help("give the points of the cam or slot, like `curve = { points = [[0, 0, 0], ...], closed = true }`");
                return None;
            }
            (Some(curve), true) => curve,
        };
        let places = draft.points.iter().enumerate();
        let ids: Vec<_> = places.map(|(k, p)| self.place(p, name, here.item("curve", k))).collect();
        let ids: Vec<_> = ids.into_iter().collect::<Option<_>>()?;
        j.axis.as_ref()?;
        let m_i = Pose { rot: frame, r: self.position(at[0])? };
        let local = ids.iter().map(|h| Some(m_i.inverse().point(self.position(*h)?)));
        let local: Vec<Vec3> = local.collect::<Option<_>>()?;
        let size = self.extent.size();
        let least = if draft.closed { 4 } else { 3 };
        if local.len() < least {
            let message = format!("the curve of `{name}` has {} points", local.len());
            self.fault("HP0226", here.key("curve"), message).help(format!("give at least {least}"));
            return None;
        }
        let off_plane =
            local.iter().enumerate().find(|(_, p)| (p.z - local[0].z).abs() > PERPENDICULAR_TOLERANCE * size);
        if let Some((k, p)) = off_plane {
            let message = format!("the curve of `{name}` does not lie in a plane perpendicular to its axis");
            self.fault("HP0226", here.key("curve"), message)
                .note(format!("point {k} is {:e} m from the plane of point 0", (p.z - local[0].z).abs()))
                .help("give all points the same coordinate along `axis`");
            return None;
        }
        let next = |k: usize| local[(k + 1) % local.len()];
        let last = if draft.closed { local.len() } else { local.len() - 1 };
        if let Some(k) = (0..last).find(|&k| (next(k) - local[k]).norm() <= SAME_POINT * size) {
            let message = format!(
                "points {} and {} of the curve of `{name}` coincide",
                k + 1,
                (k + 1) % local.len() + 1
            );
            self.fault("HP0226", here.key("curve"), message)
                .help("remove one of them; a closed curve does not repeat its first point");
            return None;
        }
        let points: Vec<[f64; 2]> = local.iter().map(|p| [p.x, p.y]).collect();
        let follower = m_i.inverse().point(self.position(at[1])?);
        self.curve_points.extend(ids);
        match Curve::through(&points, draft.closed, [follower.x, follower.y]) {
            Ok(curve) if curve.at(curve.start())[0][0].is_finite() => Some(curve),
            Ok(_) => {
                let message = format!("the point of `{name}` is beyond the ends of its curve");
                self.fault("HP0226", here.key("at"), message)
                    .help("move the point next to the curve, or extend the curve");
                None
            }
            Err(error) => {
                self.fault("HP0226", here.key("curve"), format!("invalid curve of `{name}`: {error}"));
                None
            }
        }
    }

    /// HP0223: a distance from a curve on which the point is drawn. The sign of round-off must not choose its side.
    fn check_side(&mut self, j: &JointDraft, curve: &Curve, at: [HardpointId; 2], frame: Mat3, here: Here) {
        let [carrier, follower] = at.map(|h| self.position(h));
        let (Some(r), Some(follower)) = (carrier, follower) else { return };
        let distance = curve.distance(Pose { rot: frame, r }.inverse().point(follower));
        if distance.abs() > ON_CURVE * self.extent.size() {
            return;
        }
        let name = &j.name;
        let message = format!("the `length` of `{name}` has no side: its point is drawn on the curve");
        self.fault("HP0223", here.key("length"), message)
            .note("the point keeps this distance from the curve on the side on which it is drawn")
            .help(
                "draw the point on that side of the curve, or remove `length` if it is to stay on the curve",
            );
    }

    /// HP0223: a length of a joint that is not a rod or follower, or a length that is not positive.
    fn rod_length(&mut self, j: &JointDraft, kind: &'static JointType, here: Here) -> Option<f64> {
        let length = match self.formula_length(&j.name, here.key("length")) {
            Some(given) => given?,
            None => j.length?,
        };
        if !kind.is_rod() && !kind.follows_curve() {
            self.fault(
                "HP0223",
                here.key("length"),
                format!("`length` does not apply to {} joints", kind.name),
            )
            .help(format!("remove `length` from `{}`", j.name));
        } else if !(length > 0.0 && length.is_finite()) {
            self.fault("HP0223", here.key("length"), format!("the length of `{}` is not positive", j.name))
                .help(
                    "give the distance between its two ends, or remove `length` to use the distance in the design configuration",
                );
        } else {
            self.check_lengths(
                &format!("the length of `{}`", j.name),
                [length, 0.0, 0.0],
                here.key("length"),
            );
        }
        Some(length)
    }

    /// HP0223: a screw without a lead, or a lead without a screw.
    fn check_lead(&mut self, j: &JointDraft, kind: &'static JointType, here: Here) {
        let has_lead = kind.has_lead();
        if self.unread(here, "lead") {
            return;
        }
        match j.lead {
            Some(_) if !has_lead => {
                self.fault(
                    "HP0223",
                    here.key("lead"),
                    format!("`lead` does not apply to {} joints", kind.name),
                )
                .help(format!("remove `lead` from `{}`, or make it a `screw`", j.name));
            }
            Some(lead) if !(lead != 0.0 && lead.is_finite()) => {
                let message = format!("the lead of screw `{}` is zero or not finite", j.name);
                self.fault("HP0223", here.key("lead"), message)
                    .help("give the advance per turn, negative for a left-hand thread");
            }
            None if has_lead => {
                self.fault("HP0223", here.key("type"), format!("screw `{}` has no `lead`", j.name))
                    .help("give the advance per turn, like `lead = 5`, negative for a left-hand thread");
            }
            _ => {}
        }
    }

    /// Returns the hardpoints of the two markers: one shared, or one on each body. HP0210 if their number is wrong.
    fn joint_places(
        &mut self,
        j: &JointDraft,
        kind: &'static JointType,
        axis: Option<Direction>,
        here: Here,
    ) -> Option<[HardpointId; 2]> {
        let name = &j.name;
        if let (true, Some(Direction::Through(a, _))) = (j.at.is_empty() && kind.places == 1, axis) {
            return Some([a, a]);
        }
        // The locations, or the axis that defines them, could not be read.
        let by_axis = matches!(j.axis, Some(DirectionDraft::Through(..))) || self.unread(here, "axis");
        if self.unread(here, "at") || j.at.is_empty() && kind.places == 1 && by_axis {
            return None;
        }
        let fits = match kind.places {
            0 => j.at.len() <= 1,
            1 => (1..=2).contains(&j.at.len()),
            _ => j.at.len() == 2,
        };
        if fits && j.at.is_empty() {
            return Some([UNPLACED; 2]);
        }
        if !fits {
            let message = match kind.places {
                0 => format!("joint `{name}` takes at most one hardpoint in `at`, not {}", j.at.len()),
                1 => format!("joint `{name}` needs one hardpoint in `at`, not {}", j.at.len()),
                _ => format!(
                    "joint `{name}` needs two hardpoints in `at`, one on each body, not {}",
                    j.at.len()
                ),
            };
            let at = if j.at.is_empty() { here.key("type") } else { here.key("at") };
            let fault = self.fault("HP0210", at, message);
            fault.note(format!("{}: {}", kind.name, kind.summary));
            fault.help(match (kind.places, j.at.len()) {
                (0, _) => "remove `at`: only directions matter for this type".to_string(),
                (1, _) => "name the hardpoint at which the bodies are connected".into(),
                _ => {
                    format!("name the point on `{}` first, then the point on `{}`", j.bodies[0], j.bodies[1])
                }
            });
            return None;
        }
        let places: Vec<_> =
            j.at.iter().enumerate().map(|(k, p)| self.place(p, name, here.item("at", k))).collect();
        let (first, last) = (places[0]?, places[places.len() - 1]?);
        if kind.is_rod() && self.separation(first, last) == Some(None) {
            self.fault("HP0211", here.key("at"), format!("the two ends of `{name}` coincide"))
                .help("a rod needs two different points");
        }
        Some([first, last])
    }

    /// Gives joints without a location one for their markers: the mean of the locations of their bodies' other joints.
    pub(super) fn place_unplaced_joints(&mut self) {
        let mut joints_on = vec![Vec::new(); self.model.bodies.len()];
        for (k, j) in self.model.joints.iter().enumerate() {
            for body in j.bodies.iter().filter(|body| **body != GROUND) {
                joints_on[body.0].push(k);
            }
        }
        for k in 0..self.model.joints.len() {
            if self.model.joints[k].at[0] != UNPLACED {
                continue;
            }
            let bodies = self.model.joints[k].bodies;
            let mut near: Vec<usize> = bodies.iter().flat_map(|b| &joints_on[b.0]).copied().collect();
            near.sort_unstable();
            near.dedup();
            let (mut sum, mut count) = (Vec3::ZERO, 0.0);
            for j in near.iter().map(|&j| &self.model.joints[j]).filter(|j| j.at[0] != UNPLACED) {
                for (body, at) in j.bodies.iter().zip(j.at) {
                    if *body != GROUND && bodies.contains(body) {
                        sum += self.model.hardpoints[at.0].position;
                        count += 1.0;
                    }
                }
            }
            let position = if count > 0.0 { sum * (1.0 / count) } else { Vec3::ZERO };
            let name = self.model.joints[k].name.clone();
            self.model.hardpoints.push(Hardpoint { name, position, unnamed: true });
            self.model.joints[k].at = [HardpointId(self.model.hardpoints.len() - 1); 2];
        }
    }
}
