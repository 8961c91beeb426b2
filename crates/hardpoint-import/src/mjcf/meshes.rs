//! Meshes of MJCF: files, or vertices in the text with their triangles or with their convex hull; their masses.

use std::cell::OnceCell;
use std::collections::BTreeSet;

use hardpoint::space::{Mat3, Pose, Quat, Vec3, hull};

use super::vocabulary::MESH;
use super::{Element, Reader};
use crate::report::{ImportLog, SourceSpan};
use crate::shapes::{self, Triangle};
use crate::turn::{diagonal, none};
use crate::{Input, robot, xml};

/// Maximum number of vertices of a convex hull: every three of them are compared with all others.
const MOST_HULL: usize = 100;
/// Distance from the plane of a facet, as a fraction of the extent of points, below which they lie in it.
const FLAT: f64 = 1e-9;

/// Mesh of a model.
pub(super) struct MeshAsset {
    /// Triangles, or the reason why there are none.
    content: Result<MeshContent, String>,
    /// Map from its coordinates to the frame of a geom: a linear part, and a translation.
    linear: Mat3,
    translation: Vec3,
    /// Method of MuJoCo for its mass, `inertia`.
    method: String,
    /// Mass properties, once they are known.
    moments: OnceCell<Result<MeshMoments, String>>,
}

/// Mass properties of a mesh in the frame of a geom.
#[derive(Clone, Copy)]
pub(super) struct MeshMoments {
    /// Volume, m^3.
    pub volume: f64,
    pub centre: Vec3,
    /// Inertia matrix about the centre per unit of mass, m^2.
    pub per_mass: Mat3,
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
        let method = self.attribute(element, "inertia", class);
        let method = method.map_or(self.compiler.mesh_inertia.to_owned(), |(method, _)| method);
        (name, MeshAsset { content, linear, translation, method, moments: OnceCell::new() })
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

    /// Returns its mass properties as MuJoCo computes them.
    ///
    /// # Errors
    /// Returns the reason why they are not known.
    pub(super) fn moments(&self, input: &Input<'_>) -> Result<MeshMoments, String> {
        self.moments.get_or_init(|| self.compute_moments(input)).clone()
    }

    fn compute_moments(&self, input: &Input<'_>) -> Result<MeshMoments, String> {
        let triangles = match &self.content {
            Ok(MeshContent::File(path)) => {
                let found = input.file_or_why(path).and_then(|bytes| shapes::in_file(path, &bytes));
                found.map_err(|why| format!("`{path}`: {why}"))?
            }
            Ok(MeshContent::Triangles(triangles)) => triangles.clone(),
            Err(why) => return Err(why.clone()),
        };
        let put = |t: Triangle| shapes::mapped(self.linear, t).map(|p| p + self.translation);
        let triangles: Vec<Triangle> = triangles.into_iter().map(put).collect();
        let found = match self.method.as_str() {
            "legacy" => moments(&triangles, f64::abs),
            "exact" => moments(&triangles, |volume| volume),
            "convex" => moments(&convex(&triangles)?, |volume| volume),
            other => return Err(format!("masses of meshes with `inertia=\"{other}\"` are not computed")),
        };
        found.ok_or_else(|| "its mesh encloses no volume".into())
    }
}

/// Returns the mass properties of a surface: the sum of pyramids whose bases are the triangles, with the mean of the
/// surface, and then their centre, as apex. MuJoCo's older method counts all of them as positive.
fn moments(triangles: &[Triangle], counted: fn(f64) -> f64) -> Option<MeshMoments> {
    let mean = |[a, b, c]: &Triangle| (*a + *b + *c) * (1.0 / 3.0);
    let area = |[a, b, c]: &Triangle| 0.5 * (*b - *a).cross(*c - *a).norm();
    let pyramid = |t: &Triangle, apex: Vec3| {
        let [a, b, c] = t.map(|p| p - apex);
        counted(a.dot(b.cross(c)) / 6.0)
    };
    let surface: f64 = triangles.iter().map(area).sum();
    let apex = triangles.iter().fold(Vec3::zero(), |sum, t| sum + mean(t) * (area(t) / surface));
    let volume: f64 = triangles.iter().map(|t| pyramid(t, apex)).sum();
    if !(volume > 0.0 && volume.is_finite()) {
        return None;
    }
    let centre = triangles
        .iter()
        .fold(Vec3::zero(), |sum, t| sum + (mean(t) * 0.75 + apex * 0.25) * (pyramid(t, apex) / volume));
    // The integral of x x^T over a pyramid with its apex at 0: V/20 (a a^T + b b^T + c c^T + s s^T),  s = a + b + c
    let points = triangles.iter().flat_map(|t| {
        let part = pyramid(t, centre) / (20.0 * volume);
        let [a, b, c] = t.map(|p| p - centre);
        [a, b, c, a + b + c].map(|p| (part, p, diagonal([0.0; 3])))
    });
    Some(MeshMoments { volume, centre, per_mass: robot::combined(points) })
}

/// Returns the convex hull of a surface.
fn convex(triangles: &[Triangle]) -> Result<Vec<Triangle>, String> {
    let mut known = BTreeSet::new();
    let corners = triangles.as_flattened().iter();
    let points: Vec<Vec3> =
        corners.filter(|p| known.insert(p.to_array().map(f64::to_bits))).copied().collect();
    Ok(facets(&points)?.into_iter().map(|t| t.map(|k| points[k as usize])).collect())
}

/// Returns triangles that cover every facet of the convex hull of points once.
fn facets(points: &[Vec3]) -> Result<Vec<[u32; 3]>, String> {
    if points.len() > MOST_HULL {
        let why = "the convex hull of more than";
        return Err(format!("{why} {MOST_HULL} vertices is not computed: list its triangles in `face`"));
    }
    let size = points.iter().map(|p| (*p - points[0]).norm()).fold(0.0, f64::max);
    let (mut known, mut out) = (BTreeSet::new(), Vec::new());
    for triangle in hull(points).ok_or("its vertices lie in one plane")? {
        let [a, b, c] = triangle.map(|k| points[k as usize]);
        let Some(normal) = (b - a).cross(c - a).unit() else { continue };
        let is_in_plane = |k: &u32| normal.dot(points[*k as usize] - a).abs() <= FLAT * size;
        let facet: Vec<u32> = (0..points.len() as u32).filter(is_in_plane).collect();
        if known.insert(facet.clone()) {
            let outline = outline(facet, points, normal);
            out.extend(outline.windows(2).skip(1).map(|pair| [outline[0], pair[0], pair[1]]));
        }
    }
    Ok(out)
}

/// Returns the corners of the convex outline of points in a plane, counter-clockwise about its normal.
fn outline(mut facet: Vec<u32>, points: &[Vec3], normal: Vec3) -> Vec<u32> {
    let at = |k: u32| points[k as usize];
    let Some(along) = facet.iter().find_map(|k| (at(*k) - at(facet[0])).unit()) else { return facet };
    let across = normal.cross(along);
    facet.sort_by(|a, b| {
        let [a, b] = [at(*a), at(*b)].map(|p| [along.dot(p), across.dot(p)]);
        a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
    });
    let chain = |list: &mut dyn Iterator<Item = &u32>| {
        let mut chain: Vec<u32> = Vec::new();
        for &k in list {
            while let [.., a, b] = chain[..]
                && (at(b) - at(a)).cross(at(k) - at(b)).dot(normal) <= 0.0
            {
                chain.pop();
            }
            chain.push(k);
        }
        chain.pop();
        chain
    };
    let mut out = chain(&mut facet.iter());
    out.extend(chain(&mut facet.iter().rev()));
    out
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
        None => facets(&points)?.concat(),
    };
    Ok(corners.chunks_exact(3).map(|t| [t[0], t[1], t[2]].map(|k| points[k as usize])).collect())
}
