//! Joints between two markers, each a frame on a body, as in Adams, Ondsel and FreeCAD.

use std::collections::BTreeSet;

use hardpoint::joint::ALL;
use hardpoint::space::{Mat3, Pose, Vec3};

use crate::mechanism::{Coordinate, Joint, Mechanism};
use crate::report::{ImportLog, SourceSpan};
use crate::straighten::MEANT;
use crate::turn::{angle_about, from_z_and_x, none};

/// Distance below which markers coincide, as a fraction of the mechanism size: files have about seven digits.
const APART: f64 = 1e-7;
/// Angle below which axes are parallel, rad: files have about six digits.
const AWRY: f64 = 1e-5;

/// Frame on a body in the design configuration.
#[derive(Clone, Copy, Debug)]
pub struct Marker {
    /// Body.
    pub body: usize,
    /// Pose of the frame, global.
    pub pose: Pose,
}

impl Marker {
    /// Z axis, global.
    pub fn z(&self) -> Vec3 {
        self.pose.rot.cols[2]
    }

    /// X axis, global.
    pub fn x(&self) -> Vec3 {
        self.pose.rot.cols[0]
    }

    /// Y axis, global.
    pub fn y(&self) -> Vec3 {
        self.pose.rot.cols[1]
    }
}

/// Joint coordinates of the second marker relative to the first.
pub struct Offset {
    /// Rotation about z of the first marker, rad.
    pub angle: f64,
    /// Displacement along z of the first marker.
    pub displacement: f64,
}

/// Returns the offset of marker j from marker i.
pub fn offset(i: &Marker, j: &Marker) -> Offset {
    Offset { angle: angle_about(i.z(), i.x(), j.x()), displacement: i.z().dot(j.pose.r - i.pose.r) }
}

/// Name and position of a joint in the source.
#[derive(Clone, Copy, Debug)]
pub struct ElementSource<'s> {
    /// Kind in the source.
    pub kind: &'s str,
    /// Name.
    pub name: &'s str,
    /// Position in the source.
    pub at: Option<SourceSpan>,
}

impl ElementSource<'_> {
    /// Returns a comment for the model file.
    pub fn note(&self, notes: &ImportLog) -> String {
        match self.at.and_then(|at| notes.place(at)) {
            Some(place) => format!("{} {}, {place}", self.kind, self.name),
            None => format!("{} {}", self.kind, self.name),
        }
    }
}

/// Adds a joint between two markers, of body i and body j, and returns its index. Gaps and misalignments are reported.
pub fn join(
    m: &mut Mechanism,
    notes: &mut ImportLog,
    source: ElementSource<'_>,
    kind: &'static str,
    [i, j]: [Marker; 2],
) -> Option<usize> {
    if i.body == j.body {
        notes.refused(source.kind, source.name, source.at, "its markers are on the same body");
        return None;
    }
    if ["fixed", "orientation"].contains(&kind) {
        return crate::robot::weld(m, notes, source, kind, [i, j]);
    }
    let joint = Joint::new(source.name, source.note(notes), kind, [i.body, j.body], j.pose.r);
    let reach = [i, j].iter().map(|k| k.pose.r.norm()).fold(m.size(), f64::max);
    let Some(JointFit { mut joint, on_i, open, awry }) = JointFit::of(joint, kind, [i, j], APART * reach)
    else {
        let why = "its two axes are parallel, but must be perpendicular";
        notes.refused(source.kind, source.name, source.at, why);
        return None;
    };
    // A misalignment beyond missing digits is assembled: a frame on body i rotates, and carries the geometry of the
    // joint there.
    let turn = if awry { turn_between(kind, [&i, &j]) } else { None };
    if let Some(turn) = turn {
        // Without a common point the frame may turn about any one.
        let r = if ["parallel", "dot1"].contains(&kind) { j.pose.r } else { on_i };
        let nominal = Pose { rot: j.pose.rot, r };
        let note = source.note(notes);
        joint.bodies[0] = crate::robot::turned_frame(m, source.name, note, i.body, nominal, turn);
        let back = turn.transpose();
        joint.axis = joint.axis.map(|axis| back * axis);
        joint.axis2 = joint.axis2.map(|axis| back * axis);
    }
    if open {
        joint = joint.between(on_i, j.pose.r);
        let why =
            "its markers are apart in the design configuration: the mechanism is assembled before it moves";
        notes.approximated(source.kind, source.name, source.at, why);
    } else if turn.is_some() {
        let why =
            "the axes of its markers are misaligned in the file: the mechanism is assembled before it moves";
        notes.approximated(source.kind, source.name, source.at, why);
    } else if awry {
        let why = "the axes of its markers are misaligned in the file: the axis of the first marker is used for both";
        notes.approximated(source.kind, source.name, source.at, why);
    } else {
        notes.taken(source.kind, source.name, source.at);
    }
    Some(m.joint(joint))
}

/// A joint between two markers, and how well these fit it.
struct JointFit {
    /// The joint, at marker j.
    joint: Joint,
    /// Point of body i at which the joint is assembled: displacements that the joint allows are zero in the design
    /// configuration.
    on_i: Vec3,
    /// True if the markers are apart in directions in which the joint does not move.
    open: bool,
    /// True if the axes of the markers are misaligned.
    awry: bool,
}

impl JointFit {
    /// Gives a joint the axes of its markers; `apart` is the distance from which these are apart. `None` if axes that
    /// must be perpendicular are parallel.
    fn of(joint: Joint, kind: &str, [i, j]: [Marker; 2], apart: f64) -> Option<Self> {
        let gap = j.pose.r - i.pose.r;
        let across = gap - i.z() * i.z().dot(gap);
        let is_turned = !(i.z().cross(j.z()).norm() <= AWRY);
        let fit = Self { joint, on_i: i.pose.r, open: false, awry: false };
        Some(match kind {
            "spherical" => Self { open: gap.norm() > apart, ..fit },
            "revolute" => {
                let joint = fit.joint.along(i.z());
                Self { joint, open: gap.norm() > apart, awry: is_turned, ..fit }
            }
            "translational" | "cylindrical" | "screw" | "inline" => Self {
                joint: fit.joint.along(i.z()),
                on_i: j.pose.r - across,
                open: across.norm() > apart,
                awry: kind != "inline" && is_turned,
            },
            "planar" | "inplane" => Self {
                joint: fit.joint.with_axes(i.z(), i.x()),
                on_i: i.pose.r + across,
                open: (gap - across).norm() > apart,
                awry: kind == "planar" && is_turned,
            },
            "parallel" => Self { joint: fit.joint.along(i.z()), awry: is_turned, ..fit },
            "universal" | "dot1" => {
                let (a, b) = (i.z(), j.z());
                // Axes that are parallel but for round-off leave the direction of the cross open.
                let square = (b - a * a.dot(b)).unit().filter(|_| is_turned)?;
                Self {
                    joint: fit.joint.with_axes(a, square),
                    open: kind == "universal" && gap.norm() > apart,
                    awry: !has_perpendicular_axes([i, j]),
                    ..fit
                }
            }
            "constant_velocity" => {
                let b = if i.z().dot(j.z()) < 0.0 { -j.z() } else { j.z() };
                Self { joint: fit.joint.with_axes(i.z(), b), open: gap.norm() > apart, ..fit }
            }
            _ => fit,
        })
    }
}

/// Returns the rotation of body j that aligns the axes of a joint and preserves the angle about them; `None` if there
/// is zero, or within the missing digits.
fn turn_between(kind: &str, [i, j]: [&Marker; 2]) -> Option<Mat3> {
    let turn = if ["universal", "dot1"].contains(&kind) {
        let (a, b) = (i.z(), j.z());
        // Rotation about the common normal of both pins that makes them perpendicular
        let normal = a.cross(b).unit()?;
        let square = normal.cross(a);
        from_z_and_x(square, normal)? * from_z_and_x(b, normal)?.transpose()
    } else {
        let z = if i.z().dot(j.z()) < 0.0 { -i.z() } else { i.z() };
        let angle = angle_about(i.z(), i.x(), j.x());
        let x = i.x() * angle.cos() + i.y() * angle.sin();
        from_z_and_x(z, x)? * from_z_and_x(j.z(), j.x())?.transpose()
    };
    (turn.angle_to(none()) > MEANT).then_some(turn)
}

/// Relative tolerance for a specified length that equals the nominal one, as a fraction of the mechanism size.
const SAID: f64 = 1e-6;

/// Returns true if a specified length equals that in the design configuration.
pub fn equals_nominal(m: &Mechanism, specified: f64, nominal: f64) -> bool {
    (specified - nominal).abs() <= SAID * m.size().max(specified.abs())
}

/// Returns true if the z axes of two markers are perpendicular but for missing digits.
pub fn has_perpendicular_axes([i, j]: [Marker; 2]) -> bool {
    i.z().dot(j.z()).abs() <= AWRY
}

/// Adds two hinges in series with a body of their own between them: about z of the marker on body i, then about z of
/// the marker on body j, both through the origin of the second marker. Returns the indices of the hinges.
pub fn join_by_hinges(
    m: &mut Mechanism,
    notes: &mut ImportLog,
    source: ElementSource<'_>,
    [i, j]: [Marker; 2],
) -> Option<[usize; 2]> {
    if i.body == j.body {
        notes.refused(source.kind, source.name, source.at, "its markers are on the same body");
        return None;
    }
    let link = m.body(&format!("{}_link", source.name), source.note(notes), Some(j.pose));
    let mut hinge = |end: &str, bodies, axis| {
        let name = format!("{}_{end}", source.name);
        m.joint(Joint::new(&name, source.note(notes), "revolute", bodies, j.pose.r).along(axis))
    };
    let hinges = [hinge("i", [i.body, link], i.z()), hinge("j", [link, j.body], j.z())];
    notes.taken(source.kind, source.name, source.at);
    Some(hinges)
}

/// Adds two joints with a link between them that has its own body: the parts keep a distance between two axes, or
/// between an axis and a point. The first joint, between body i and the link, is about z of the first marker; the type
/// of the second joint is given.
pub fn join_by_link(
    m: &mut Mechanism,
    notes: &mut ImportLog,
    source: ElementSource<'_>,
    kinds: [&'static str; 2],
    [i, j]: [Marker; 2],
    distance: Option<f64>,
) {
    let axis = i.z();
    let foot = i.pose.r + axis * axis.dot(j.pose.r - i.pose.r);
    let across = j.pose.r - foot;
    let nominal = across.norm();
    let distance = distance.map_or(nominal, f64::abs);
    if distance == 0.0 {
        let kind = match kinds {
            ["revolute", "revolute"] => "revolute",
            [.., "spherical"] => "inline",
            _ => "cylindrical",
        };
        join(m, notes, source, kind, [i, j]);
        return;
    }
    if i.body == j.body {
        notes.refused(source.kind, source.name, source.at, "its markers are on the same body");
        return;
    }
    let along = across.unit().unwrap_or_else(|| axis.any_perpendicular());
    let end = foot + along * distance;
    let same = equals_nominal(m, distance, nominal);
    let rot = from_z_and_x(axis, along).unwrap_or_else(none);
    let link = m.body(&format!("{}_link", source.name), source.note(notes), Some(Pose { rot, r: foot }));
    let first = Joint::new(&format!("{}_i", source.name), source.note(notes), kinds[0], [i.body, link], foot);
    let skew = kinds[1] != "spherical" && axis.cross(j.z()).norm() > AWRY;
    let there = Marker { body: link, pose: Pose { rot: from_z_and_x(axis, j.x()).unwrap_or(rot), r: end } };
    let turn = if skew { turn_between(kinds[1], [&there, &j]) } else { None };
    m.joint(first.along(axis));
    let (mut carrier, mut second_axis) = (link, axis);
    if let Some(turn) = turn {
        let nominal = Pose { rot: j.pose.rot, r: if same { j.pose.r } else { end } };
        let name = format!("{}_j", source.name);
        carrier = crate::robot::turned_frame(m, &name, source.note(notes), link, nominal, turn);
        second_axis = turn.transpose() * axis;
    }
    let second =
        Joint::new(&format!("{}_j", source.name), source.note(notes), kinds[1], [carrier, j.body], j.pose.r);
    let second = if kinds[1] == "spherical" { second } else { second.along(second_axis) };
    m.joint(if same { second } else { second.between(end, j.pose.r) });
    if skew || !same {
        let how = if turn.is_some() {
            "its axes are misaligned in the file: the mechanism is assembled before it moves"
        } else if skew {
            "its axes are misaligned in the file: the first axis is used for both"
        } else {
            "its distance differs in the design configuration: the mechanism is assembled to the specified distance"
        };
        notes.approximated(source.kind, source.name, source.at, how);
    } else {
        notes.taken(source.kind, source.name, source.at);
    }
}

/// Returns the displacement along an axis and the rotation about it of body j relative to body i, as sums of joint
/// coordinates with factors. The coordinates are those of one joint between both bodies, or of joints that carry both
/// on a third body.
pub fn relative(
    joints: &[MarkerJoint],
    [i, j]: [usize; 2],
    axis: Vec3,
) -> Option<[Vec<(Coordinate, f64)>; 2]> {
    let bases = joints.iter().flat_map(|k| k.markers.map(|m| m.body));
    let bases: BTreeSet<usize> = bases.chain([i, j]).collect();
    // A joint between both bodies is found with body i as the base.
    [i, j].into_iter().chain(bases).find_map(|base| {
        let [mut slides, mut turns] = [Vec::new(), Vec::new()];
        for (body, sign) in [(i, -1.0), (j, 1.0)].into_iter().filter(|(body, _)| *body != base) {
            let mut is_carried = false;
            for joint in joints {
                let bodies = joint.markers.map(|m| m.body);
                let is_along = joint.markers[0].z().cross(axis).norm() <= AWRY;
                if !is_along || !bodies.contains(&body) || !bodies.contains(&base) {
                    continue;
                }
                let factor = sign * coordinate_sign(joint, body, axis);
                for (name, list) in [("displacement", &mut slides), ("angle", &mut turns)] {
                    let has = ALL
                        .iter()
                        .any(|k| k.name == joint.kind && k.coordinates.iter().any(|c| c.name == name));
                    if has && ["revolute", "translational", "cylindrical"].contains(&joint.kind) {
                        is_carried = true;
                        list.push((Coordinate { joint: joint.number, name }, factor));
                    }
                }
            }
            if !is_carried {
                return None;
            }
        }
        (!slides.is_empty() && !turns.is_empty()).then_some([slides, turns])
    })
}

/// Adds the coupler of a screw whose parts are guided by other joints; `None` if no joints define the sliding and
/// rotation.
pub fn couple_screw(
    m: &mut Mechanism,
    notes: &mut ImportLog,
    source: ElementSource<'_>,
    joints: &[MarkerJoint],
    [i, j]: [Marker; 2],
    pitch: f64,
) -> Option<()> {
    let [slides, turns] = relative(joints, [i.body, j.body], i.z())?;
    // z - pitch/(2 pi) angle = 0
    let per_rad = pitch / std::f64::consts::TAU;
    let turns = turns.into_iter().map(|(c, factor)| (c, -per_rad * factor));
    m.coupler(source.name, source.note(notes), slides.into_iter().chain(turns).collect());
    notes.taken(source.kind, source.name, source.at);
    Some(())
}

/// Joint between two markers.
#[derive(Clone, Copy, Debug)]
pub struct MarkerJoint {
    /// Index of the joint.
    pub number: usize,
    /// Joint type.
    pub kind: &'static str,
    /// Markers on body i and body j.
    pub markers: [Marker; 2],
}

/// Returns a joint of one of these types that carries a body and has a parallel axis.
pub fn carrying_joint<'j>(
    mut joints: impl Iterator<Item = &'j MarkerJoint>,
    body: usize,
    kinds: &[&str],
    axis: Vec3,
) -> Option<&'j MarkerJoint> {
    joints.find(|k| {
        let is_on = k.markers.iter().any(|m| m.body == body);
        is_on && kinds.contains(&k.kind) && k.markers[0].z().cross(axis).norm() <= AWRY
    })
}

/// Sign of a joint's coordinate for the motion of a body along or about an axis.
pub fn coordinate_sign(joint: &MarkerJoint, body: usize, axis: Vec3) -> f64 {
    let sign = if joint.markers[1].body == body { 1.0 } else { -1.0 };
    sign * joint.markers[0].z().dot(axis).signum()
}

/// Converts a law of the source to one that is zero in the design configuration, where the source's coordinate is
/// `nominal`. Angles are reduced by whole turns.
pub fn relative_to_nominal(text: &str, nominal: f64, turns: bool) -> String {
    use std::f64::consts::TAU;
    let begins = hardpoint::law::Law::parse(text).map_or(0.0_f64, |law| law.at(0.0).0[0]);
    let rounds = if turns && begins.is_finite() { ((begins - nominal) / TAU).round() } else { 0.0 };
    let nominal = if nominal.abs() < 1e-12 { 0.0 } else { nominal };
    match nominal + rounds * TAU {
        0.0 => text.to_owned(),
        d if d > 0.0 => format!("{text} - {d}"),
        d => format!("{text} + {}", -d),
    }
}

impl Marker {
    /// Returns a marker with z along an axis; `None` if the axis is null.
    pub fn along(body: usize, at: Vec3, axis: Vec3) -> Option<Self> {
        let rot = from_z_and_x(axis, axis.any_perpendicular())?;
        Some(Self { body, pose: Pose { rot, r: at } })
    }
}
