//! Meshes of MJCF: files, or vertices in the text with their triangles or with their convex hull.

use hardpoint::space::{Mat3, Pose, Quat, Vec3, hull};

use super::vocabulary::MESH;
use super::{Element, Reader};
use crate::report::{ImportLog, SourceSpan};
use crate::shapes::{self, Triangle};
use crate::turn::{diagonal, none};
use crate::{Input, xml};

/// Maximum number of vertices of a convex hull: every three of them are compared with all others.
const MOST_HULL: usize = 100;

/// Mesh of a model.
pub(super) struct MeshAsset {
    /// Triangles, or the reason why there are none.
    content: Result<MeshContent, String>,
    /// Map from its coordinates to the frame of a geom: a linear part, and a translation.
    linear: Mat3,
    translation: Vec3,
}

/// Geom with a mesh.
pub(super) struct MeshGeom<'a> {
    pub body: usize,
    /// Pose in the body frame.
    pub place: Pose,
    pub link: &'a str,
    pub at: Option<SourceSpan>,
}

/// Source of the triangles of a mesh.
enum MeshContent {
    /// A file, by its path.
    File(String),
    /// The text.
    Triangles(Vec<Triangle>),
}

impl<'d> Reader<'d, '_> {
    /// Reads a mesh and its name.
    pub(super) fn mesh(&mut self, element: Element<'d>) -> (String, MeshAsset) {
        let (text, node) = element;
        let file = node.attribute("file").unwrap_or_default();
        let stem = file.rsplit('/').next().and_then(|f| f.rsplit_once('.')).map_or(file, |(stem, _)| stem);
        let name = node.attribute("name").unwrap_or(stem).to_owned();
        xml::unknown(text, node, &name, MESH, self.notes);
        let content = if !file.is_empty() {
            Ok(MeshContent::File(format!("{}{file}", self.compiler.mesh_folder)))
        } else if let Some(vertices) = node.attribute("vertex") {
            let triangles = triangles(vertices, node.attribute("face"));
            triangles.map(MeshContent::Triangles).map_err(|why| format!("`{name}`: {why}"))
        } else {
            let why = "it has neither a file nor vertices: save a mesh that MuJoCo generates to a file";
            Err(format!("`{name}`: {why}"))
        };
        let class = node.attribute("class");
        let scale = self.numbers::<3>(element, "scale", class).unwrap_or([1.0; 3]);
        let origin = self.numbers::<3>(element, "refpos", class).unwrap_or_default();
        let turn = self.numbers::<4>(element, "refquat", class).and_then(Quat::from_array);
        // Vertices are moved, then rotated, then scaled: x' = S R^T (x - x_0)
        let linear = diagonal(scale) * turn.map_or_else(none, Quat::rotation).transpose();
        let translation = -(linear * Vec3::from(origin));
        (name, MeshAsset { content, linear, translation })
    }
}

impl MeshAsset {
    /// Adds the mesh to a body at the pose of its geom, or reports why it is missing.
    pub(super) fn add(&self, input: &mut Input<'_>, notes: &mut ImportLog, geom: MeshGeom<'_>) {
        let MeshGeom { body, place, link, at } = geom;
        let place = Pose { rot: place.rot, r: place.point(self.translation) };
        match &self.content {
            Ok(MeshContent::File(path)) => input.mesh(body, place, self.linear, path, link, at, notes),
            Ok(MeshContent::Triangles(triangles)) => {
                input.shapes.triangles(body, place, self.linear, triangles.iter().copied());
                notes.taken("mesh", link, at);
            }
            Err(why) => shapes::report_missing_shape(notes, "mesh", link, at, why),
        }
    }
}

/// Returns the triangles of vertices in the text: those of `face`, or otherwise of their convex hull.
fn triangles(vertices: &str, faces: Option<&str>) -> Result<Vec<Triangle>, String> {
    let list = xml::numbers(vertices).filter(|list| list.len().is_multiple_of(3) && list.len() >= 12);
    let list = list.ok_or("`vertex` must be at least four points of three numbers each")?;
    let points: Vec<Vec3> = list.chunks_exact(3).map(|p| Vec3::from([p[0], p[1], p[2]])).collect();
    let corners: Vec<u32> = match faces {
        Some(faces) => {
            let list: Option<Vec<u32>> = faces.split_whitespace().map(|word| word.parse().ok()).collect();
            let is_valid = |list: &Vec<u32>| {
                list.len().is_multiple_of(3) && list.iter().all(|k| (*k as usize) < points.len())
            };
            list.filter(is_valid).ok_or("`face` must be numbers of vertices from 0 on, three per triangle")?
        }
        None if points.len() > MOST_HULL => {
            let why = "the convex hull of more than";
            return Err(format!("{why} {MOST_HULL} vertices is not computed: list its triangles in `face`"));
        }
        None => hull(&points).ok_or("its vertices lie in one plane")?.concat(),
    };
    Ok(corners.chunks_exact(3).map(|t| [t[0], t[1], t[2]].map(|k| points[k as usize])).collect())
}
