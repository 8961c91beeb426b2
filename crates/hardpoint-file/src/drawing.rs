//! Appearance of the mechanism in drawings, which the model does not need.

use std::collections::BTreeMap;

use hardpoint::space::Vec3;

/// Appearance of a mechanism, by indices in the lists of the [`Model`](hardpoint::model::Model).
#[derive(Clone, Debug, Default)]
pub struct Appearance {
    /// The shapes of bodies.
    pub bodies: BTreeMap<usize, Mesh>,
    /// The forms of joints.
    pub joints: BTreeMap<usize, Form>,
    /// The forms of distances that are measured.
    pub measures: BTreeMap<usize, Form>,
}

/// The shape of a body as triangles, each place once.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// The file that it was read from, as the model names it.
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
    /// The origin and axes of the hardpoints, in the design configuration.
    World,
    /// The frame of its body.
    Body,
}

impl MeshFrame {
    /// Both, in the order of [`MESH_FRAMES`].
    pub(crate) const ALL: [Self; 2] = [Self::World, Self::Body];
}

/// Names in model files, with descriptions.
pub(crate) const MESH_FRAMES: &[(&str, &str)] = &[
    ("world", "The origin and axes of the hardpoints, in the design configuration."),
    ("body", "The frame of its body."),
];

/// Shape that a joint with a length is drawn as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A damper with a spring round it.
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

    /// As model files write it.
    pub fn name(self) -> &'static str {
        FORMS[self as usize].0
    }
}

/// Names in model files, with descriptions.
pub(crate) const FORMS: &[(&str, &str)] = &[
    ("coilover", "A damper with a spring round it."),
    ("spring", "A coil spring."),
    ("damper", "A damper."),
    ("cylinder", "A hydraulic or pneumatic cylinder."),
    ("rod", "A plain rod."),
];
