//! Names of joints.

use hardpoint::model::{JointId, Model};

pub(super) fn joint_name(model: &Model, joint: JointId) -> String {
    model.joints[joint.0].name.clone()
}

/// Name of a joint of the solved mechanism; `None` if it places a body of an elastic mechanism, and is not in its
/// model.
pub(super) fn name_in_file(model: &Model, joint: JointId) -> Option<String> {
    model.joints.get(joint.0).map(|j| j.name.clone())
}
