//! Orientations in the notations of other programs.

use hardpoint::space::{Mat3, Pose, Quat, Vec3};

/// Global x axis.
pub const X: [f64; 3] = [1.0, 0.0, 0.0];
/// Global y axis.
pub const Y: [f64; 3] = [0.0, 1.0, 0.0];
/// Global z axis.
pub const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// Identity rotation.
pub fn none() -> Mat3 {
    Mat3 { cols: [X.into(), Y.into(), Z.into()] }
}

/// Diagonal matrix.
pub fn diagonal([x, y, z]: [f64; 3]) -> Mat3 {
    Mat3 { cols: [[x, 0.0, 0.0].into(), [0.0, y, 0.0].into(), [0.0, 0.0, z].into()] }
}

/// Identity pose.
pub fn home() -> Pose {
    Pose { rot: none(), r: Vec3::from([0.0; 3]) }
}

/// Sequence of rotations: names of axes, and angles in rad. Lower-case letters are axes of the rotating frame, capitals
/// are fixed axes.
pub fn sequence(axes: &str, angles: [f64; 3]) -> Mat3 {
    let turns = axes.chars().zip(angles);
    turns.fold(none(), |done, (axis, angle)| {
        let turn = Mat3::about(letter(axis), angle);
        if axis.is_ascii_uppercase() { turn * done } else { done * turn }
    })
}

fn letter(axis: char) -> Vec3 {
    match axis.to_ascii_lowercase() {
        'x' => X.into(),
        'y' => Y.into(),
        _ => Z.into(),
    }
}

/// Rotation by roll, pitch and yaw, rad, about the fixed x, y and z axes.
pub fn roll_pitch_yaw(angles: [f64; 3]) -> Mat3 {
    sequence("XYZ", angles)
}

/// Rotation of a quaternion `[w, x, y, z]`; `None` if it is null.
pub fn quaternion(q: [f64; 4]) -> Option<Mat3> {
    Some(Quat::from_array(q)?.rotation())
}

/// Returns the rotation matrix with a given z axis and x as near as possible to a given vector; `None` if z is null or
/// both are parallel.
pub fn from_z_and_x(z: Vec3, x: Vec3) -> Option<Mat3> {
    let z = z.unit()?;
    let x = (x - z * z.dot(x)).unit()?;
    Some(Mat3 { cols: [x, z.cross(x), z] })
}

/// Angle of `x` from `reference` about `axis`, rad.
pub fn angle_about(axis: Vec3, reference: Vec3, x: Vec3) -> f64 {
    axis.dot(reference.cross(x)).atan2(reference.dot(x) - axis.dot(reference) * axis.dot(x))
}
