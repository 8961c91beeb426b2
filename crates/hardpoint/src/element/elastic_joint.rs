//! Joint that gives along its own axes.

use crate::draft::{CheckElement, ElementCheck, StiffnessRule};
use crate::joint::{DIRECTION_NAMES, DIRECTIONS, Need, free_directions, sprung_directions};
use crate::load::{AppliedLoads, ForceFormula};
use crate::model::element::{ActsOn, CURVES, Compliance, ElasticJoint, ForceProperties, Properties};
use crate::model::{Dimension, ElementId, Joint, Model};
use crate::number;
use crate::space::{Real, Wrench};

impl ForceProperties for ElasticJoint {
    #[inline]
    fn properties(&self, _: &Model) -> Properties<'_> {
        Properties {
            acts_on: ActsOn::Joint(self.joint),
            axes: [None; 2],
            dimension: Dimension::FORCE,
            given: number::each(&[self.preload_x, self.preload_y, self.preload_z], |n| n.map(|n| n.0)),
            table: None,
            law: None,
            is_arithmetic: self.law().is_arithmetic(),
            compliance: Compliance::Joint(self),
            friction: None,
        }
    }
}

/// Keys of the cubic stiffnesses.
const CUBIC: [&str; DIRECTIONS] =
    ["cubic_x", "cubic_y", "cubic_z", "cubic_about_x", "cubic_about_y", "cubic_about_z"];
/// Keys of the preloads.
const PRELOADS: [&str; DIRECTIONS] =
    ["preload_x", "preload_y", "preload_z", "preload_about_x", "preload_about_y", "preload_about_z"];

impl ElasticJoint {
    /// HP0252: forces along directions in which the joint is rigid, and so has no displacement.
    fn check_rigid(&self, c: &mut ElementCheck<'_, '_>) {
        let law = self.law();
        let (gives, kind) = (law.gives(), c.model().joints[self.joint.0].kind);
        let free = free_directions(kind);
        let rigid = |k: usize| !gives[k] && !free[k] && kind.freedoms.is_some();
        for k in (0..DIRECTIONS).filter(|k| rigid(*k)) {
            let (of, name) = (&law.directions[k], DIRECTION_NAMES[k]);
            let cubic = of.cubic.map(|_| CUBIC[k]);
            for key in cubic.into_iter().chain(of.preload.map(|_| PRELOADS[k])) {
                let message = format!(
                    "`{key}` of `{}` has no effect: the joint is rigid in direction `{name}`",
                    c.name
                );
                let fault = c.fault("HP0252", key, message);
                if cubic == Some(key) {
                    fault.note(
                        "a cubic stiffness alone resists nothing in the design configuration without load",
                    );
                }
                fault.help(format!("add the stiffness `{name}`, or a `{}`; or remove `{key}`", CURVES[k]));
            }
        }
        let entries = law.coupled.iter().flat_map(|matrix| &matrix.entries);
        let idle = entries.flat_map(|e| [e.row, e.column]).find(|k| rigid(*k));
        if let Some(k) = idle {
            let name = DIRECTION_NAMES[k];
            let message = format!(
                "entries of the matrix of `{}` have no effect: the joint is rigid in direction `{name}`",
                c.name
            );
            c.fault("HP0252", "matrix", message).help(format!(
                "add the stiffness `{name}` or a diagonal entry of it, or set its row and column to zero"
            ));
        }
    }

    /// HP0251: x and y axes that differ, but are any directions perpendicular to the axis of the joint.
    fn check_across(&self, c: &mut ElementCheck<'_, '_>) {
        let Joint { name, kind, axis, axis2, .. } = &c.model().joints[self.joint.0];
        let is_open = match kind.axis2 {
            Need::OnBodyJ => true,
            Need::Required | Need::Optional | Need::Orienting | Need::Unused => axis2.is_none(),
        };
        let Some(axis) = axis.filter(|_| is_open && kind.freedoms.is_some()) else { return };
        if c.is_even_across(&self.law()) {
            return;
        }
        let message = format!(
            "the x and y axes of `{}` differ, and joint `{name}` does not give their directions",
            c.name
        );
        let help = match kind.axis2 {
            Need::OnBodyJ => format!(
                "`axis2` of a `{}` is on its second body: give `{}` the same stiffness along and about x and y",
                kind.name, c.name
            ),
            Need::Required | Need::Optional | Need::Orienting | Need::Unused => {
                let example = c.example_of_axis2(axis);
                format!("add the direction of the x axis to joint `{name}`, like {example}")
            }
        };
        c.fault("HP0251", "joint", message).help(help);
    }
}

impl CheckElement for ElasticJoint {
    fn check(&self, c: &mut ElementCheck<'_, '_>) {
        if !self.law().gives().contains(&true) {
            let message = format!("`{}` is rigid in all directions", c.name);
            c.fault("HP0251", "type", message)
                .help("give it a stiffness along or about one of its axes, or remove it");
        } else {
            c.check_stiffness(&self.law(), StiffnessRule::Positive);
            self.check_rigid(c);
        }
        self.check_across(c);
        c.check_curves(&self.law());
        let joint = &c.model().joints[self.joint.0];
        if joint.kind.places == 0 {
            let message = format!("joint `{}` has no location at which it could deflect", joint.name);
            c.fault("HP0251", "joint", message).help("name a joint with a location");
        }
    }
}

impl ForceFormula for ElasticJoint {
    fn apply<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId, out: &mut [Wrench<T>]) {
        let Some(opening) = at.opening(e, self.joint) else { return };
        at.apply_between(self.joint, at.elastic_wrench(&opening, &self.law()), T::one(), out);
    }

    fn size<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId) -> T {
        at.opening(e, self.joint)
            .map_or(T::zero(), |opening| at.elastic_wrench(&opening, &self.law()).f.norm())
    }

    /// Those of the directions in which the joint moves by itself; in the others it opens (`load/compliance.rs`).
    fn deflections<T: Real>(&self, at: &AppliedLoads<'_, T>, e: ElementId, mut each: impl FnMut(T, T)) {
        let (law, sprung) = (self.law(), sprung_directions(at.model.joints[self.joint.0].kind));
        let gives = law.gives();
        if !(0..DIRECTIONS).any(|k| gives[k] && sprung[k]) {
            return;
        }
        let coordinates = at.motion_of(e, self.joint).coordinates;
        for k in (0..DIRECTIONS).filter(|k| sprung[*k]) {
            let [_, slope] = at.elastic_resistance(coordinates[k], &law.directions[k]);
            each(coordinates[k], slope);
        }
        for entry in law.coupled.iter().flat_map(|matrix| &matrix.entries) {
            let (stiffness, [a, b]) = (at.number(entry.value), [entry.row, entry.column]);
            if a == b && sprung[a] {
                each(coordinates[a], stiffness);
            } else if a != b && (sprung[a] || sprung[b]) {
                // 2 k a b = k/2 (a + b)^2 - k/2 (a - b)^2
                let half = stiffness * 0.5;
                each(coordinates[a] + coordinates[b], half);
                each(coordinates[a] - coordinates[b], -half);
            }
        }
    }
}
