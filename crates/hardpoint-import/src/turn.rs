//! Orientations as other programs write them.

use hardpoint::space::{Mat3, Pose, Quat, Vec3};

/// The global axes.
pub const X: [f64; 3] = [1.0, 0.0, 0.0];
/// See [`X`].
pub const Y: [f64; 3] = [0.0, 1.0, 0.0];
/// See [`X`].
pub const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// No turn.
pub fn none() -> Mat3 {
    Mat3 { cols: [X.into(), Y.into(), Z.into()] }
}

/// A frame where the outer one is.
pub fn home() -> Pose {
    Pose { rot: none(), r: Vec3::from([0.0; 3]) }
}

/// Turns about the axes of the frame as it turns, one after the other: letters of axes and angles in rad.
pub fn sequence(axes: &str, angles: [f64; 3]) -> Mat3 {
    let turns = axes.chars().zip(angles);
    turns.fold(none(), |done, (axis, angle)| {
        // Capital letters are axes that stay, small ones those that turn along.
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

/// Roll, pitch and yaw about the fixed x, y and z.
pub fn roll_pitch_yaw(angles: [f64; 3]) -> Mat3 {
    sequence("XYZ", angles)
}

/// Rotation of a quaternion `[w, x, y, z]`; `None` if it is null.
pub fn quaternion(q: [f64; 4]) -> Option<Mat3> {
    Some(Quat::from_array(q)?.rotation())
}

/// The frame with this z axis and x as near as can be to the one wanted; none where z is null or both are parallel.
pub fn from_z_and_x(z: Vec3, x: Vec3) -> Option<Mat3> {
    let z = z.unit()?;
    let x = (x - z * z.dot(x)).unit()?;
    Some(Mat3 { cols: [x, z.cross(x), z] })
}

/// The angle by which `x` has turned from `reference`, seen along `axis`.
pub fn angle_about(axis: Vec3, reference: Vec3, x: Vec3) -> f64 {
    axis.dot(reference.cross(x)).atan2(reference.dot(x) - axis.dot(reference) * axis.dot(x))
}
