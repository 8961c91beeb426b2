//! Idle rotations: the free spin of a rod between two spherical joints, which moves nothing else.

use crate::constraint::Row;
use crate::linalg::FullPivot;
use crate::model::element::ActsOn;
use crate::model::{BodyId, Element, GROUND, IdleRotation, Joint, JointId, Model, PointId};
use crate::space::{Mat3, Twist, Vec3};

/// Pivot, relative to the largest, below which a constraint is ignored.
const RANK_TOLERANCE: f64 = 1e-8;
/// Distance of a point from an axis, in sizes of the mechanism, up to which it is on the axis; typed coordinates agree
/// to about this.
const ON_AXIS: f64 = 1e-6;

impl Model {
    /// Finds idle rotations and fixes each by making one spherical joint a universal joint.
    pub(super) fn fix_idle_rotations(&mut self) {
        let size = self.size();
        let mut joints_of = vec![Vec::new(); self.bodies.len()];
        for (k, j) in self.joints.iter().enumerate() {
            for b in j.bodies {
                joints_of[b.0].push(JointId(k));
            }
        }
        let alone = (1..self.bodies.len()).map(|b| vec![BodyId(b)]);
        let slides = self.joints.iter().filter(|j| j.kind.turns_as_one() && !j.bodies.contains(&GROUND));
        let groups: Vec<Vec<BodyId>> = alone.chain(slides.map(|j| j.bodies.to_vec())).collect();
        let mut prescribed = vec![Vec::new(); self.joints.len()];
        for d in &self.drivers {
            prescribed[d.joint.0].push(self.driven(d).row);
        }
        for t in self.couplers.iter().flat_map(|c| &c.terms) {
            prescribed[t.joint.0].push(self.coupled(t).row);
        }
        for bodies in groups {
            // Without a spherical joint there is nothing to fix. This excludes most bodies of a linkage early.
            let mut joints: Vec<JointId> =
                bodies.iter().flat_map(|b| joints_of[b.0].iter().copied()).collect();
            joints.sort_unstable();
            joints.dedup();
            joints.retain(|j| !self.joints[j.0].bodies.iter().all(|b| bodies.contains(b)));
            // A universal joint has other axes, along which an elastic joint must not give.
            let balls = joints.iter().copied().filter(|j| self.joints[j.0].kind.is_ball());
            let Some(ball) = balls.min_by_key(|j| self.has_own_axes(*j)) else { continue };
            let Some(axis) = self.spin(&bodies, &joints, ball, &prescribed, size) else { continue };
            if self.equilibrium.is_some() && self.is_turned_by_forces(&bodies, ball, axis, size) {
                continue;
            }
            let z = axis.any_perpendicular();
            let frame = Mat3 { cols: [axis.cross(z), z.cross(axis.cross(z)), z] };
            let fixed = &mut self.joints[ball.0];
            (fixed.kind, fixed.frames) = (&crate::joint::UNIVERSAL, [frame; 2]);
            self.idle.push(IdleRotation { bodies, joint: ball, axis });
        }
    }

    /// Returns true if the axes of a joint may have an effect: those that the user gives, or of an elastic joint.
    fn has_own_axes(&self, joint: JointId) -> bool {
        let acts_on_it = |element: &Element| {
            let acts_on = element.kind.force(self).map(|force| force.acts_on);
            matches!(acts_on, Some(ActsOn::Joint(of)) if of == joint)
        };
        let Joint { axis, axis2, .. } = &self.joints[joint.0];
        axis.is_some() || axis2.is_some() || self.elements.iter().any(acts_on_it)
    }

    /// Returns true if a force may turn these bodies about an axis through this joint, so that their rotation is one of
    /// equilibrium. Weights are left out: a rod whose centre of mass is beside its axis need not hang down.
    fn is_turned_by_forces(&self, bodies: &[BodyId], ball: JointId, axis: Vec3, size: f64) -> bool {
        let centre = self.position(self.joints[ball.0].at[0]);
        let is_beside = |p: PointId| {
            let point = &self.points[p.0];
            let lever = (self.position(point.at) - centre).cross(axis).norm();
            bodies.contains(&point.body) && lever > ON_AXIS * size
        };
        let on_bodies = |acts_on: ActsOn| acts_on.bodies(self).into_iter().any(|b| bodies.contains(&b));
        let forces = self.elements.iter().filter_map(|e| Some((e, e.kind.force(self)?.acts_on)));
        forces.filter(|(_, acts_on)| on_bodies(*acts_on)).any(|(element, acts_on)| match acts_on {
            ActsOn::Line(points) => points.into_iter().any(is_beside),
            ActsOn::Points(points) => {
                let turns = element.kind.elastic_law().is_some_and(|law| law.gives()[3..].contains(&true));
                turns || points.into_iter().any(is_beside)
            }
            ActsOn::Point(point) => is_beside(point),
            ActsOn::Wheel(_) | ActsOn::Body(_) => true,
            // What holds a ball, or a hinge about its axis, against a body that does not turn with them.
            ActsOn::Joint(joint) => element.kind.elastic_law().is_some_and(|law| {
                let (about, joint) = (&law.gives()[3..], &self.joints[joint.0]);
                let turns = if joint.kind.is_ball() { about.contains(&true) } else { about[2] };
                turns && !joint.bodies.iter().all(|b| bodies.contains(b))
            }),
            // Along the other joints the bodies slide, or turn about the same axis as all that they are connected to.
            ActsOn::Coordinate(..) => false,
        })
    }

    /// Returns the axis through the spherical joint about which these bodies can rotate while all others are fixed, if
    /// that is their only freedom.
    ///
    /// `prescribed` lists, for each joint, the rows that drivers and couplers add.
    fn spin(
        &self,
        bodies: &[BodyId],
        joints: &[JointId],
        ball: JointId,
        prescribed: &[Vec<Row>],
        size: f64,
    ) -> Option<Vec3> {
        let end = |j: JointId| usize::from(bodies.contains(&self.joints[j.0].bodies[1]));
        let place = |j: JointId| self.position(self.joints[j.0].at[end(j)]);
        let centre = place(ball);
        let mut rows = Vec::new();
        for &j in joints {
            let joint = &self.joints[j.0];
            let mut ends = self.ends(j);
            if joint.kind.places == 1 {
                // A joint that is open in the design configuration closes at its location on these bodies.
                (ends.i.r, ends.j.r) = (place(j), place(j));
            }
            let side = if end(j) == 1 { 1.0 } else { -1.0 };
            for &row in joint.kind.rows.iter().chain(&prescribed[j.0]) {
                let wrench = row.wrench(&ends);
                let scale = if row.is_length() { side / size } else { side };
                // Rotations about the spherical joint, then translations in units of the size.
                let turns = Vec3::AXES.map(|e| scale * wrench.on(Twist::turn(e, centre)));
                let slides = Vec3::AXES.map(|e| scale * size * wrench.on(Twist::slide(e)));
                rows.push(turns.into_iter().chain(slides).collect());
            }
        }
        let pivots = FullPivot::of(rows, 6, RANK_TOLERANCE);
        let [motion] = &pivots.free[..] else { return None };
        let mut free = [0.0; 6];
        for &(c, x) in motion {
            free[c] = x;
        }
        let slide = Vec3::new(free[3], free[4], free[5]);
        let axis = Vec3::new(free[0], free[1], free[2]).unit()?;
        // A rotation that is possible only in this position is not idle: every other joint must stay on the axis.
        let on_axis = |p: Vec3| (p - centre).cross(axis).norm() <= ON_AXIS * size;
        let permanent = joints.iter().all(|&j| {
            let joint = &self.joints[j.0];
            let along = joint.axis.is_none() || joint.frames[end(j)].cols[2].cross(axis).norm() <= ON_AXIS;
            on_axis(place(j)) && along
        });
        (slide.norm() <= ON_AXIS && permanent).then_some(axis)
    }
}
