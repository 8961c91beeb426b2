//! Bodies: frames and shapes.

use hardpoint::draft::{BodyDraft, FrameDraft, LocationDraft, Section};
use hardpoint::space::{Angles, Pose, Quat, Vec3};

use crate::values::{
    ANGLE, EntryPlace, Field, Fields, HARDPOINT, Kinds, NUMBER, PLACE, Reader, Shape, Table, table,
};

use super::mesh;
use super::mesh::BodyMesh;
use super::raw::Raw;

pub(super) const BODY_SHAPE: Shape = Shape::Any(
    "BodyOrPoints",
    "A body; in a planar model also a list of its hardpoints.",
    &[Shape::Table(&BODY), Shape::list(&HARDPOINT)],
);
const BODY: Table = table! {
    /// A body; `{}` is enough.
    "Body":
    /// Reference frame in the design configuration. Default: origin at the mean of the body's joint places, axes
    /// parallel to the global ones. Only results expressed in the frame depend on it.
    may "frame": Shape::Kinds(&FRAME), "{ position = [0, 0, 0] }";
    /// Shape for drawings, and for masses of `type = "mesh"`: a file of triangles in the model's folder or below it
    /// (STL, OBJ or glTF).
    may "mesh": mesh::MESH, "\"knuckle.stl\"";
};
pub(super) const FRAME: Kinds = Kinds {
    name: "Frame",
    doc: "A reference frame.",
    typed: false,
    tables: || vec![&FRAME_BY_POSITION, &FRAME_BY_POINTS],
};
const FRAME_BY_POSITION: Table = table! {
    /// By position and orientation.
    "Pose":
    /// Origin: coordinates or a hardpoint's name.
    must "position": PLACE, "[0, 0, 0]";
    /// 3-1-3 Euler angles, in the angle unit: turn about z, then the new x, then the new z. Default: zero.
    may "euler": Shape::exactly(3, &ANGLE), "[0, 0, 0]";
    /// Cardan angles instead: turn about x, then the new y, then the new z.
    may "cardan": Shape::exactly(3, &ANGLE), "[0, 0, 0]";
    /// Roll, pitch and yaw instead: turn by the last about z, then by pitch about the new y, then by roll about the new
    /// x.
    may "roll_pitch_yaw": Shape::exactly(3, &ANGLE), "[0, 0, 0]";
    /// Quaternion `[w, x, y, z]` instead, of any length.
    may "quaternion": Shape::exactly(4, &NUMBER), "[1, 0, 0, 0]";
};
/// Keys of orientations as angles, with their meanings and expected values.
const ANGLES: [(&str, Angles, &str); 3] = [
    ("euler", Angles::Euler, "three Euler angles (3-1-3)"),
    ("cardan", Angles::Cardan, "three Cardan angles (about x, y and z)"),
    ("roll_pitch_yaw", Angles::RollPitchYaw, "three angles: roll, pitch and yaw"),
];
const FRAME_BY_POINTS: Table = table! {
    /// By three points.
    "FramePoints":
    /// The origin.
    must "origin": PLACE, "\"A\"";
    /// A point on the x axis.
    must "x": PLACE, "\"B\"";
    /// A point in the xy plane, on the side of +y.
    must "xy": PLACE, "\"C\"";
};
pub(super) fn bodies(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    for entry in r.entries(model, "bodies", "body") {
        let fields = r.entry("body", &entry, BODY.keys());
        let mut place = EntryPlace::of(&fields);
        let frame = r.given(&fields, "frame", |r, f| frame(r, &fields, f, &mut place, raw));
        let mut mesh = BodyMesh::None;
        if fields.get("mesh").is_some() {
            let said = r.given(&fields, "mesh", |r, f| mesh::mesh(r, &fields, f));
            if let Some(drawn) = said.as_ref().and_then(|said| mesh::drawn(r, said)) {
                // Ground comes first in the model.
                raw.drawing.bodies.insert(raw.draft.bodies.len() + 1, drawn);
            }
            mesh = said.map_or(BodyMesh::Faulty, BodyMesh::Said);
        }
        raw.meshes.insert(entry.0.clone(), mesh);
        raw.push(r, Section::Bodies, place);
        raw.draft.bodies.push(BodyDraft { name: entry.0, frame: frame.unwrap_or_default() });
    }
}

pub(super) fn frame<'a>(
    r: &mut Reader<'_>,
    body: &Fields<'a>,
    f: Field<'a>,
    place: &mut EntryPlace,
    raw: &Raw,
) -> Option<FrameDraft> {
    let subject = body.subject("frame");
    let table = r.table(f.value, &subject, "a table with a position or three points")?;
    let fields = r.fields(format!("the frame of {}", body.what), f.value.span(), table, FRAME.keys());
    if ["origin", "x", "xy"].iter().any(|k| fields.get(k).is_some()) {
        let angles = ANGLES.map(|(key, ..)| key);
        for key in ["position"].into_iter().chain(angles).chain(["quaternion"]) {
            r.out_of_place(&fields, key, "a frame is given either by points or by position and orientation");
        }
        let points = ["origin", "x", "xy"].map(|key| r.need(&fields, key));
        place.items("frame", points.iter().flatten().map(|f| f.value.span()).collect());
        let [origin, x, xy] = points.map(|f| f.and_then(|f| r.fixed_place(f.value, &fields.subject(f.key))));
        return Some(FrameDraft::Points(origin?, x?, xy?));
    }
    let position = r.need(&fields, "position");
    let origin = position.and_then(|f| match r.fixed_place(f.value, &fields.subject("position"))? {
        LocationDraft::At(origin) => Some(origin),
        LocationDraft::Hardpoint(name) => hardpoint_position(r, &name, f, raw),
        LocationDraft::Formula(_) => None,
    });
    let angles = ANGLES.into_iter().find(|(key, ..)| fields.get(key).is_some());
    let rot = match (angles, fields.get("quaternion")) {
        (Some((given, angles, expected)), _) => {
            let why = format!("the orientation is given by `{given}` already");
            let others = ANGLES.map(|(key, ..)| key).into_iter().chain(["quaternion"]);
            for other in others.filter(|key| *key != given) {
                r.out_of_place(&fields, other, &why);
            }
            r.list_of::<3>(&fields, given, expected).map(|list| angles.rotation(list))
        }
        (None, Some(f)) => {
            let subject = fields.subject("quaternion");
            let q = r.numbers::<4>(f.value, &subject, "a quaternion `[w, x, y, z]`")?;
            let unit = Quat::from_array(q);
            if unit.is_none() {
                r.senseless(f.value.span(), format!("{} has no direction", subject.name)).help =
                    Some("write `[1, 0, 0, 0]` for no rotation".into());
            }
            unit.map(Quat::rotation)
        }
        (None, None) => Some(Pose::IDENTITY.rot),
    };
    Some(FrameDraft::Pose(Pose { r: origin?, rot: rot? }))
}

/// Reads the position of a frame, which is needed at once, so that its hardpoint is looked up here.
fn hardpoint_position(r: &mut Reader<'_>, name: &str, f: Field<'_>, raw: &Raw) -> Option<Vec3> {
    let hardpoints = &raw.draft.hardpoints;
    let found = raw.hardpoint_numbers.get(name).map(|k| &hardpoints[*k]);
    if found.is_none() && !raw.draft.unread.has(Section::Model, 0, "hardpoints") {
        let close = r.guess(name, hardpoints.iter().map(|h| h.name.as_str()));
        r.report("HP0204", f.value.span(), format!("there is no hardpoint named `{name}`")).help =
            close.map(|c| format!("did you mean `{c}`?"));
    }
    Some(found?.position)
}
