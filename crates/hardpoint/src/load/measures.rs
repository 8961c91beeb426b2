//! Evaluation of load measures, for any number type.

use crate::model::{Axes, BodyId, ElementId, JointId, MeasureKind, ReactionPart, of_bodies};
use crate::space::{Real, Vec3, Wrench};

use super::acting::AppliedLoads;
use super::transmitted::TransmittedLoads;

/// All loads at one time.
pub(super) struct LoadMeasures<'a, T> {
    applied: &'a AppliedLoads<'a, T>,
    transmitted: &'a TransmittedLoads<T>,
    /// True if the applied loads act; false for a self-stress, which is there without them.
    is_loaded: bool,
}

impl<'a, T: Real> LoadMeasures<'a, T> {
    /// Loads that the applied loads cause: `transmitted` is what rigid directions of joints transmit.
    pub fn new(applied: &'a AppliedLoads<'a, T>, transmitted: &'a TransmittedLoads<T>) -> Self {
        Self { applied, transmitted, is_loaded: true }
    }

    /// Loads of a self-stress at the position of these loads.
    pub fn of_stress(applied: &'a AppliedLoads<'a, T>, transmitted: &'a TransmittedLoads<T>) -> Self {
        Self { applied, transmitted, is_loaded: false }
    }
}

impl<T: Real> LoadMeasures<'_, T> {
    /// Value of a measure; for formulas and signs see `docs/loads.md`.
    pub fn measure(&self, kind: &MeasureKind) -> T {
        let TransmittedLoads { drivers, speeds, shaking, .. } = self.transmitted;
        match kind {
            MeasureKind::DriverForce { driver } => drivers[driver.0],
            // nu f.
            MeasureKind::DriverPower { driver } => drivers[driver.0] * speeds[driver.0],
            MeasureKind::Reaction { joint, part, on, axes } => {
                self.reaction(*joint, *part, *on, axes.unwrap_or_default())
            }
            MeasureKind::SpringForce { force } => self.applied.size(*force),
            MeasureKind::KineticEnergy { body } => self.applied.kinetic_energy(*body),
            MeasureKind::ShakingForce { along } => component(shaking.f, *along),
            MeasureKind::ShakingMoment { about, along } => {
                let p = self.applied.point(*about);
                component(shaking.m - p.cross(shaking.f), *along)
            }
            MeasureKind::Slope { .. }
            | MeasureKind::Dexterity { .. }
            | MeasureKind::Compliance { .. }
            | MeasureKind::Wheel { .. }
            | MeasureKind::Axle { .. }
            | of_bodies!() => T::constant(f64::NAN),
        }
    }

    /// Location of a joint on its body j, and the force and the moment about that point that it applies to body j.
    pub fn wrench(&self, joint: JointId) -> [Vec3<T>; 3] {
        let AppliedLoads { model, geometry, bodies, .. } = *self.applied;
        let body = model.joints[joint.0].bodies[1];
        let place = bodies[body.0].pose.point(geometry.markers[joint.0][1].r);
        let Wrench { m, f } = self.joint_wrench(joint);
        [place, f, m - place.cross(f)]
    }

    /// Reaction wrench of a joint on its body j, about the world origin: what its rigid directions transmit, and its
    /// elastic forces.
    fn joint_wrench(&self, joint: JointId) -> Wrench<T> {
        let rigid = self.transmitted.joints[joint.0];
        if self.is_loaded { self.applied.elastic_wrench_of(joint, rigid) } else { rigid }
    }

    /// Reaction of a joint on one of its bodies.
    fn reaction(&self, joint: JointId, part: ReactionPart, on: Option<BodyId>, axes: Axes) -> T {
        let AppliedLoads { model, geometry, bodies, .. } = *self.applied;
        let [i, j] = model.joints[joint.0].bodies;
        let end = usize::from(on.is_none_or(|on| on == j));
        let wrench = self.joint_wrench(joint);
        let Wrench { m, f } = if end == 1 { wrench } else { Wrench::zero() - wrench };
        let body = [i, j][end];
        let pose = bodies[body.0].pose;
        let marker = geometry.markers[joint.0][end];
        let is_rod = model.joints[joint.0].kind.is_rod();
        let place = |end: usize| bodies[[i, j][end].0].pose.point(geometry.markers[joint.0][end].r);
        // A rod or leg has the line from its first place to its second.
        let z = || match is_rod {
            true => {
                let line = place(1) - place(0);
                line * (T::one() / line.norm())
            }
            false => pose.rot * marker.rot.cols[2],
        };
        let along = |k: usize, v: Vec3<T>| match axes {
            Axes::Global => v[k],
            Axes::Body => self.applied.turned(body.0).cols[k].dot(v),
            Axes::Joint => (pose.rot * marker.rot.cols[k]).dot(v),
        };
        let across = |v: Vec3<T>| {
            let z = z();
            (v - z * z.dot(v)).norm()
        };
        // About the joint's location on that body.
        let moment = || m - pose.point(marker.r).cross(f);
        match part {
            ReactionPart::Force => f.norm(),
            ReactionPart::ForceAlong(k) => along(k, f),
            ReactionPart::Axial => z().dot(f),
            // It carries nothing across its line.
            ReactionPart::Radial if is_rod => T::zero(),
            ReactionPart::Radial => across(f),
            ReactionPart::Moment => moment().norm(),
            ReactionPart::MomentAbout(k) => along(k, moment()),
            ReactionPart::Torque => z().dot(moment()),
            ReactionPart::Bending => across(moment()),
        }
    }
}

/// A reaction is determined if the self-stress of every redundant constraint contributes less than this fraction of its
/// largest reaction.
const KNOWN: f64 = 1e-8;

impl<T: Real> LoadMeasures<'_, T> {
    /// Contribution to that reaction of the self-stress of a redundant constraint, whose largest reaction is `largest`;
    /// not above zero if it is only round-off.
    pub fn excess(&self, kind: &MeasureKind, largest: T) -> T {
        let size = self.applied.model.size();
        let is_moment = matches!(kind, MeasureKind::Reaction { part, .. } if part.is_moment());
        let scale = if is_moment { largest * size } else { largest };
        self.measure(kind).abs() - scale * KNOWN
    }

    /// Largest joint reaction; moments are divided by the size of the mechanism.
    pub fn largest_reaction(&self) -> T {
        let size = self.applied.model.size();
        let joints = (0..self.applied.model.joints.len()).map(JointId);
        joints.fold(T::zero(), |most, joint| {
            let [_, force, moment] = self.wrench(joint);
            most.larger(force.norm()).larger(moment.norm() * (1.0 / size))
        })
    }
}

impl LoadMeasures<'_, f64> {
    /// True if a friction element has no normal force.
    pub fn has_no_normal_force(&self, e: ElementId, joint: JointId, largest: f64) -> bool {
        let (forces, count) = self.applied.normal_forces(e, self.transmitted.joints[joint.0]);
        forces.iter().take(count).all(|force| force.norm() <= KNOWN * largest)
    }
}

/// Component of a vector along a unit vector, or its magnitude.
fn component<T: Real>(v: Vec3<T>, along: Option<Vec3>) -> T {
    along.map_or_else(|| v.norm(), |along| along.spread().dot(v))
}
