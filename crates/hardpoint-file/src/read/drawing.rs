//! Appearance of the mechanism in drawings, without influence on the model.

use std::collections::BTreeMap;

use hardpoint::space::Vec3;

use crate::values::{Fields, Reader, Shape};

/// Appearance of a mechanism, by indices in the lists of the [`Model`](hardpoint::model::Model).
#[derive(Clone, Debug, Default)]
pub struct Appearance {
    /// Shapes of bodies.
    pub bodies: BTreeMap<usize, Mesh>,
    /// Forms of joints.
    pub joints: BTreeMap<usize, Form>,
    /// Forms of measured distances.
    pub measures: BTreeMap<usize, Form>,
}

/// Shape of a body as triangles with shared vertices.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// File name, as in the model.
    pub file: String,
    /// Frame of the vertices.
    pub frame: MeshFrame,
    /// Vertices, m.
    pub vertices: Vec<Vec3>,
    /// Three vertices each.
    pub triangles: Vec<[u32; 3]>,
}

/// Frame of a mesh's coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFrame {
    /// Origin and axes of the hardpoints, in the design configuration.
    World,
    /// Frame of its body.
    Body,
}

impl MeshFrame {
    /// Both, in the order of [`MESH_FRAMES`].
    pub(crate) const ALL: [Self; 2] = [Self::World, Self::Body];
}

/// Names in model files, with descriptions.
pub(crate) const MESH_FRAMES: &[(&str, &str)] = &[
    ("world", "Origin and axes of the hardpoints, in the design configuration."),
    ("body", "Frame of its body."),
];

/// Shape of a joint with a length in drawings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A damper with a coaxial spring.
    Coilover,
    /// A coil spring.
    Spring,
    /// A damper.
    Damper,
    /// A hydraulic or pneumatic cylinder.
    Cylinder,
    /// A plain rod.
    Rod,
}

impl Form {
    /// All of them, in the order of `FORMS`.
    pub const ALL: [Self; 5] = [Self::Coilover, Self::Spring, Self::Damper, Self::Cylinder, Self::Rod];

    /// Name in model files.
    pub fn name(self) -> &'static str {
        FORMS[self as usize].0
    }
}

/// Names in model files, with descriptions.
pub(crate) const FORMS: &[(&str, &str)] = &[
    ("coilover", "A damper with a coaxial spring."),
    ("spring", "A coil spring."),
    ("damper", "A damper."),
    ("cylinder", "A hydraulic or pneumatic cylinder."),
    ("rod", "A plain rod."),
];

/// Shape of a joint with a length in drawings.
pub(crate) const DRAW: Shape = Shape::Any("Draw", "", &[Shape::Words(FORMS)]);
/// Shape in drawings.
pub(super) fn form_of(r: &mut Reader<'_>, fields: &Fields<'_>) -> Option<Form> {
    r.word_of(fields, "draw").map(|k| Form::ALL[k])
}
