//! Common parts of the robot formats: welds of separated frames, mimic joints, masses, springs, plugins. Vehicles use
//! the masses and gravity.

use hardpoint::space::{Mat3, Pose, Vec3};
use roxmltree::Node;

use crate::markers::{ElementSource, Marker};
use crate::mechanism::{
    Coordinate, Drives, Force, ForceOn, GROUND, Joint, Law, Mass, Mechanism, Spring, TurnedFrame,
};
use crate::report::{ImportLog, SourceSpan};
use crate::xml::{self, Vocabulary, child};

/// Elements of Drake's ball constraint in URDF and SDFormat.
pub const BALL_CONSTRAINT: Vocabulary = Vocabulary {
    attributes: &[],
    read: &[
        "ball_constraint_body_A",
        "ball_constraint_p_AP",
        "ball_constraint_body_B",
        "ball_constraint_p_BQ",
    ],
    irrelevant: &[],
};
/// For each end of a ball constraint, the elements that name its body and its point.
pub const BALL_ENDS: [(&str, &str); 2] =
    [("ball_constraint_body_A", "ball_constraint_p_AP"), ("ball_constraint_body_B", "ball_constraint_p_BQ")];

/// Angle below which frames are parallel, rad: exporters write six digits.
const PARALLEL: f64 = 1e-5;
/// Distance below which frames coincide, as a fraction of the mechanism size, for the same reason.
const SAME_PLACE: f64 = 1e-5;
/// Tolerated excess of a principal moment of inertia over the sum of the other two, as a fraction of the largest: files
/// have few digits.
const FLAT: f64 = 5e-4;
/// Maximum number of links, joints and bodies of a source.
pub const MOST_PARTS: usize = 5000;
/// Words in the names of plugins that measure, control or draw, without constraining bodies.
const IRRELEVANT_PLUGINS: &[&str] = &[
    "ros_control",
    "ros2_control",
    "gz_ros",
    "ign_ros",
    "diff_drive",
    "diffdrive",
    "skid_steer",
    "ackermann",
    "tricycle",
    "camera",
    "laser",
    "lidar",
    "ray_sensor",
    "imu",
    "gps",
    "navsat",
    "magnet",
    "sonar",
    "sensor",
    "bumper",
    "contact",
    "ft_sensor",
    "force_torque",
    "forcetorque",
    "joint_state",
    "jointstate",
    "joint-state",
    "joint_pose",
    "pose_publish",
    "pose-publish",
    "posepublisher",
    "p3d",
    "odom",
    "joint_position_controller",
    "joint-position-controller",
    "jointposition",
    "joint-controller",
    "jointcontroller",
    "joint_trajectory",
    "joint-trajectory",
    "jointtrajectory",
    "jointvelocity",
    "velocity-control",
    "battery",
    "physics",
    "user-commands",
    "scene-broadcaster",
    "scenebroadcaster",
    "air_pressure",
    "altimeter",
    "logical",
    "vacuum",
    "gripper",
    "grasp",
    "planar_move",
    "hand_of_god",
    "video",
    "prosilica",
    "openni",
    "kinect",
    "realsense",
    "template",
];

/// Words in the names of plugins that apply forces.
const FORCE_PLUGINS: [&str; 7] =
    ["thruster", "buoyancy", "hydrodynamics", "lift_drag", "lift-drag", "windeffects", "wind_plugin"];
/// Reason for inertia of rotors that is not imported.
pub const ROTOR: &str = "rotor inertia has no equivalent: motions that drivers prescribe are the same without it, but not driver forces";

/// Gravity for formats that do not define it, m/s^2.
const STANDARD_GRAVITY: f64 = 9.80665;

/// Mimic joint: `own = factor master + offset`.
pub struct Follower<'a, 'i> {
    /// Element that defines the relation.
    pub node: Node<'a, 'i>,
    /// Name of the dependent joint.
    pub own: String,
    /// Name of the independent joint.
    pub master: String,
    /// Factor.
    pub factor: f64,
    /// Offset, rad or m.
    pub offset: f64,
}

/// Elements of a mimic plugin that name the dependent joint.
const FOLLOWS: [&str; 3] = ["mimicJoint", "mimic_joint", "mimicJointName"];

/// Returns true for a Gazebo plugin that defines a mimic joint.
pub fn is_mimic_plugin(node: Node<'_, '_>) -> bool {
    FOLLOWS.iter().any(|key| child(node, key).is_some())
}

/// Reads a Gazebo plugin that defines a mimic joint; `None` for other plugins. `mimicJoint` names the dependent joint.
pub fn mimic_plugin<'a, 'i>(
    text: usize,
    node: Node<'a, 'i>,
    notes: &mut ImportLog,
) -> Option<Follower<'a, 'i>> {
    let words = |keys: &[&'static str]| {
        let found = keys.iter().find_map(|key| child(node, key))?;
        Some(found.text().unwrap_or_default().trim().to_owned())
    };
    let own = words(&FOLLOWS)?;
    let master = words(&["joint", "jointName", "joint_name"]).unwrap_or_default();
    let mut number = |key: &'static str, default: f64| {
        let Some(element) = child(node, key) else { return default };
        let value = element.text().unwrap_or_default();
        let [x] =
            xml::exactly::<1>(value, &format!("`{key}`"), xml::at(text, element), notes).unwrap_or([default]);
        x
    };
    let (factor, offset) = (number("multiplier", 1.0), number("offset", 0.0));
    const MIMIC: Vocabulary = Vocabulary {
        attributes: &["name", "filename"],
        read: &[
            "mimicJoint",
            "mimic_joint",
            "mimicJointName",
            "joint",
            "jointName",
            "joint_name",
            "multiplier",
            "offset",
        ],
        // Parameters of its controller, since the constraint is exact here.
        irrelevant: &[
            "hasPID",
            "maxEffort",
            "sensitiveness",
            "robotNamespace",
            "namespace",
            "pid",
            "p",
            "i",
            "d",
            "updateRate",
        ],
    };
    xml::unknown(text, node, &own, MIMIC, notes);
    Some(Follower { node, own, master, factor, offset })
}

/// Reads the mimic joints of `ros2_control`.
pub fn followers_of_control<'a, 'i>(
    text: usize,
    node: Node<'a, 'i>,
    notes: &mut ImportLog,
) -> Vec<Follower<'a, 'i>> {
    let mut out = Vec::new();
    for joint in xml::named(node, "joint") {
        let value = |name: &str| {
            let found = xml::named(joint, "param").find(|p| p.attribute("name") == Some(name))?;
            Some((found, found.text().unwrap_or_default().trim()))
        };
        let Some((element, master)) = value("mimic").filter(|(_, m)| !["", "true", "false"].contains(m))
        else {
            continue;
        };
        let mut number = |name: &str, default: f64| {
            let Some((element, words)) = value(name) else { return default };
            let [x] = xml::exactly::<1>(words, &format!("`{name}`"), xml::at(text, element), notes)
                .unwrap_or([default]);
            x
        };
        let (factor, offset) = (number("multiplier", 1.0), number("offset", 0.0));
        let own = joint.attribute("name").unwrap_or_default().trim().to_owned();
        out.push(Follower { node: element, own, master: master.to_owned(), factor, offset });
    }
    out
}

/// Reports a plugin that is not read.
pub fn plugin(text: usize, node: Node<'_, '_>, notes: &mut ImportLog) {
    let [name, file] = ["name", "filename"].map(|key| node.attribute(key).unwrap_or_default());
    let words = format!("{name} {file}").to_ascii_lowercase();
    let at = xml::at(text, node);
    if FORCE_PLUGINS.iter().any(|known| words.contains(known)) {
        let why = "its forces have no equivalent: motions that drivers prescribe are the same without them, but not loads";
        notes.refused("plugin", name, at, why);
    } else if IRRELEVANT_PLUGINS.iter().any(|known| words.contains(known)) {
        notes.ignored("plugin", at);
    } else {
        notes.not_understood("plugin", name, at, format!("unknown plugin `{file}`"));
    }
}

/// Adds the coupler of a mimic joint: `own - factor master = constant`.
pub fn follow(
    m: &mut Mechanism,
    notes: &mut ImportLog,
    [name, other]: [&str; 2],
    at: Option<SourceSpan>,
    [own, master]: [Coordinate; 2],
    [factor, constant]: [f64; 2],
) {
    let note = ElementSource { kind: "mimic of", name: other, at }.note(notes);
    m.coupler_to(&format!("{name}_mimic"), note, vec![(own, 1.0), (master, -factor)], constant);
    notes.taken("mimic", name, at);
}

/// Welds two frames on two bodies by a joint of type `fixed`, or `orientation` without their positions. Returns the
/// index of the joint. Frames that are apart or misaligned in the design configuration are assembled.
pub fn weld(
    m: &mut Mechanism,
    notes: &mut ImportLog,
    source: ElementSource<'_>,
    kind: &'static str,
    [i, j]: [Marker; 2],
) -> Option<usize> {
    if i.body == j.body {
        notes.refused(source.kind, source.name, source.at, "its frames are on the same body");
        return None;
    }
    let note = source.note(notes);
    let angle = j.pose.rot.angle_to(i.pose.rot);
    let apart = kind == "fixed" && (i.pose.r - j.pose.r).norm() > SAME_PLACE * m.size();
    let turned = angle > PARALLEL;
    let mut body = i.body;
    if turned {
        // From the drawn to the assembled orientation of body j: R = A_i A_j^T
        let nominal = Pose { rot: j.pose.rot, r: i.pose.r };
        body =
            turned_frame(m, source.name, note.clone(), i.body, nominal, i.pose.rot * j.pose.rot.transpose());
    }
    let held = Joint::new(source.name, note, kind, [body, j.body], j.pose.r);
    let number = m.joint(if apart { held.between(i.pose.r, j.pose.r) } else { held });
    if apart || turned {
        let why = "its frames do not coincide in the design configuration: the mechanism is assembled before it moves";
        notes.approximated(source.kind, source.name, source.at, why);
    } else {
        notes.taken(source.kind, source.name, source.at);
    }
    Some(number)
}

/// Adds a frame on a body that rotates about its origin from its drawn to its assembled orientation before the
/// mechanism moves. Returns its body.
pub fn turned_frame(
    m: &mut Mechanism,
    name: &str,
    note: String,
    body: usize,
    nominal: Pose,
    turn: Mat3,
) -> usize {
    let angle = turn.angle_to(Mat3::IDENTITY);
    let frame = m.body(&format!("{name}_frame"), note.clone(), Some(nominal));
    let name = format!("{name}_turn");
    let hinge = Joint::new(&name, note.clone(), "revolute", [body, frame], nominal.r);
    let joint = m.joint(hinge.along(turn_of(turn, angle)));
    let drives = Drives::Coordinate(Coordinate { joint, name: "angle" });
    m.driver(&name, note, drives, Law::Constant(angle));
    m.turned.push(TurnedFrame { joint, driver: m.drivers.len() - 1, angle });
    frame
}

/// Returns the axis of a rotation with this angle.
fn turn_of(turn: Mat3, angle: f64) -> Vec3 {
    let c = |row: usize, col: usize| turn.cols[col][row];
    let skew = Vec3::from([c(2, 1) - c(1, 2), c(0, 2) - c(2, 0), c(1, 0) - c(0, 1)]);
    // Near half a turn the skew part vanishes; the columns of (R + 1) are then parallel to the axis.
    let half = std::f64::consts::PI - angle;
    if half > 1e-3 {
        return skew.unit().unwrap_or_else(|| [0.0, 0.0, 1.0].into());
    }
    let mut best = Vec3::from([0.0; 3]);
    for k in 0..3 {
        let mut e = [0.0; 3];
        e[k] = 1.0;
        let column = turn.cols[k] + Vec3::from(e);
        if column.norm() > best.norm() {
            best = column;
        }
    }
    let axis = best.unit().unwrap_or_else(|| [0.0, 0.0, 1.0].into());
    if axis.dot(skew) < 0.0 { -axis } else { axis }
}

/// Adds the mass of a body; `frame` has its origin at the centre of mass and the axes of the inertia matrix.
pub fn mass(
    m: &mut Mechanism,
    notes: &mut ImportLog,
    source: ElementSource<'_>,
    body: usize,
    frame: Pose,
    mass: f64,
    inertia: Option<Mat3>,
) {
    if body == GROUND || mass == 0.0 {
        notes.ignored(source.kind, source.at);
        return;
    }
    if !(mass > 0.0 && mass.is_finite()) {
        notes.refused(source.kind, source.name, source.at, format!("invalid mass of {mass} kg"));
        return;
    }
    let matrix = inertia.map(|i| frame.rot * i * frame.rot.transpose());
    let matrix = matrix.filter(|i| i.cols.iter().any(|c| c.norm() > 0.0));
    let possible = matrix.is_none_or(is_possible);
    m.mass(Mass {
        name: source.name.to_owned(),
        body,
        centre: frame.r,
        mass,
        inertia: matrix.filter(|_| possible),
    });
    if possible {
        notes.taken(source.kind, source.name, source.at);
    } else {
        let why = "its moments of inertia are impossible, since one exceeds the sum of the other two: it is imported as a point mass";
        notes.approximated(source.kind, source.name, source.at, why);
    }
}

/// Returns the inertia matrix of several masses about their common centre, from their masses, their positions relative
/// to it and their own inertia matrices.
pub fn combined(parts: impl Iterator<Item = (f64, Vec3, Mat3)>) -> Mat3 {
    let mut matrix = [[0.0; 3]; 3];
    for (mass, d, own) in parts {
        // I = sum of I_k + m_k (d^2 1 - d d^T)
        for (c, column) in matrix.iter_mut().enumerate() {
            for (r, x) in column.iter_mut().enumerate() {
                let one = if r == c { d.dot(d) } else { 0.0 };
                *x += own.cols[c][r] + mass * (one - d[r] * d[c]);
            }
        }
    }
    Mat3 { cols: matrix.map(Vec3::from) }
}

/// Returns true if a body can have this inertia matrix about its centre: half its trace times 1, minus the matrix, has
/// no negative eigenvalue.
fn is_possible(i: Mat3) -> bool {
    let m = |r: usize, c: usize| i.cols[c][r];
    let half = 0.5 * (m(0, 0) + m(1, 1) + m(2, 2));
    let most = m(0, 0).max(m(1, 1)).max(m(2, 2));
    let slack = FLAT * most;
    let [x, y, z] = [0, 1, 2].map(|k| half - m(k, k) + slack);
    let [d, e, f] = [-m(0, 1), -m(1, 2), -m(2, 0)];
    let minors = [x, y, z, x * y - d * d, y * z - e * e, z * x - f * f];
    let determinant = x * (y * z - e * e) - d * (d * z - e * f) + f * (d * e - y * f);
    let above = [0, 1, 2].iter().all(|k| m(*k, *k) >= 0.0);
    above && minors.iter().all(|x| *x >= 0.0) && determinant >= 0.0
}

/// Adds a force on a body that compensates this fraction of its weight.
pub fn compensate_gravity(
    m: &mut Mechanism,
    notes: &mut ImportLog,
    source: ElementSource<'_>,
    body: usize,
    fraction: f64,
) {
    let Some(gravity) = m.gravity else {
        notes.ignored(source.kind, source.at);
        return;
    };
    let Some(mass) = m.masses.iter().find(|mass| mass.body == body) else {
        notes.refused(source.kind, source.name, source.at, "the mass of the body is not known");
        return;
    };
    let on = ForceOn::Constant((body, mass.centre), gravity * (-fraction * mass.mass));
    let name = format!("{}_without_weight", source.name);
    m.force(Force { name, note: source.note(notes), on, spring: Spring::default() });
    notes.taken(source.kind, source.name, source.at);
}

/// Adds standard gravity along -z if there are masses, for formats without gravity.
pub fn standard_gravity(m: &mut Mechanism, notes: &mut ImportLog, format: &str) {
    if !m.masses.is_empty() {
        m.gravity = Some([0.0, 0.0, -STANDARD_GRAVITY].into());
        let why = format!("{format} defines no gravity: {STANDARD_GRAVITY} m/s^2 along -z is used");
        notes.approximated("gravity", "", None, why);
    }
}

/// Adds a spring with a damper on a joint coordinate; `free` is relative to the design configuration.
pub fn joint_spring(
    m: &mut Mechanism,
    notes: &mut ImportLog,
    source: ElementSource<'_>,
    coordinate: Option<Coordinate>,
    [stiffness, damping, free]: [f64; 3],
) {
    if stiffness == 0.0 && damping == 0.0 {
        return;
    }
    let Some(coordinate) = coordinate else {
        let why = "springs and dampers require a joint with a single coordinate";
        notes.refused(source.kind, source.name, source.at, why);
        return;
    };
    if !(stiffness >= 0.0
        && damping >= 0.0
        && stiffness.is_finite()
        && damping.is_finite()
        && free.is_finite())
    {
        let why = format!("invalid stiffness {stiffness} or damping {damping}");
        notes.refused(source.kind, source.name, source.at, why);
        return;
    }
    m.force(Force {
        name: source.name.to_owned(),
        note: source.note(notes),
        on: ForceOn::Coordinate(coordinate),
        spring: Spring { stiffness, damping, free: (stiffness != 0.0).then_some(free), ..Spring::default() },
    });
    notes.taken(source.kind, source.name, source.at);
}

/// Reports a constant friction of a joint, which the model does not support.
pub fn friction(notes: &mut ImportLog, name: &str, at: Option<SourceSpan>, friction: f64) {
    if friction != 0.0 {
        let why = format!(
            "constant friction of {friction} is not supported: friction of the model depends on the normal force, see docs/loads.md"
        );
        notes.refused("friction", name, at, why);
    }
}
