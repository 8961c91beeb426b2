//! Checks of limits of joints.

use crate::draft::{JointLimitDraft, Section, did_you_mean};
use crate::model::JointLimit;

use super::{Checker, Here};

impl Checker<'_> {
    pub(super) fn add_joint_limits(&mut self) {
        let draft = self.draft;
        for (index, limit) in draft.joint_limits.iter().enumerate() {
            let here = Here { section: Section::JointLimits, index };
            if !self.unread(here, "") {
                let limit = self.one_joint_limit(limit, here);
                self.model.joint_limits.extend(limit);
            }
        }
    }

    /// Resolves a limit. HP0265 if the joint has no such coordinate, HP0266 if the limit has no range.
    fn one_joint_limit(&mut self, written: &JointLimitDraft, here: Here) -> Option<JointLimit> {
        let JointLimitDraft { min, max, stop, .. } = *written;
        let name = written.name();
        let joint = self.joint(&written.joint, here.key("name"))?;
        let kind = self.model.joints[joint.0].kind;
        if written.of != JointLimitDraft::ARTICULATION && kind.coordinate(&written.of).is_none() {
            let articulation = kind.articulates().then_some(JointLimitDraft::ARTICULATION);
            let known: Vec<&str> = kind.coordinates.iter().map(|c| c.name).chain(articulation).collect();
            let close =
                did_you_mean(&written.of, known.iter().copied()).map(|c| format!("did you mean `{c}`?"));
            let listed = known.iter().map(|c| format!("`{c}`")).collect::<Vec<_>>().join(", ");
            let help = match known.is_empty() {
                true => "remove the limit: bodies at this joint have no coordinate to limit".into(),
                false => close.unwrap_or(format!("limit {listed}")),
            };
            let message = format!("joint `{}` has no coordinate `{}` to limit", written.joint, written.of);
            self.fault("HP0265", here.key("name"), message)
                .note(format!("type of `{}`: {} ({})", written.joint, kind.name, kind.summary))
                .help(help);
            return None;
        }
        for (key, bound) in [("min", min), ("max", max)] {
            if bound.is_some_and(|x| !x.is_finite()) {
                let message = format!("the `{key}` of limit `{name}` is not a finite number");
                self.fault("HP0202", here.key(key), message).help("give a finite number, or remove the key");
                return None;
            }
        }
        if let Some((key, why, help)) = no_range(written) {
            let message = format!("limit `{name}` has {why}");
            self.fault("HP0266", here.key(key), message).help(help);
            return None;
        }
        if self.model.measures.len() < self.draft.measures.len() {
            // A measure is faulty, and has its own error.
            return None;
        }
        let measure = self.number_of("measure", &name);
        let Some(measure) = measure.filter(|k| self.model.measures[*k].kind.joint_value() == Some(joint))
        else {
            let message =
                format!("limit `{name}` has no measure of this name, of its coordinate or articulation");
            self.fault("HP0204", here.key("name"), message).help("add the measure, or rename the other one");
            return None;
        };
        let coordinate = kind.coordinate(&written.of).map(|(k, _)| k);
        Some(JointLimit { name, joint, coordinate, measure, min, max, stop })
    }
}

/// Key, reason and remedy of a limit that no position keeps, or every one.
fn no_range(limit: &JointLimitDraft) -> Option<(&'static str, &'static str, &'static str)> {
    match (limit.min, limit.max) {
        (None, None) => Some(("name", "no end", "give `min`, `max` or both")),
        (Some(min), Some(max)) if min >= max => Some((
            "min",
            "no range: its minimum is not below its maximum",
            "give the lower end as `min`, the upper one as `max`; a driver can fix a coordinate",
        )),
        (_, Some(max)) if max < 0.0 && limit.of == JointLimitDraft::ARTICULATION => Some((
            "max",
            "no range: an articulation is never below zero",
            "give the greatest permitted angle",
        )),
        (_, Some(_)) | (Some(_), None) => None,
    }
}
