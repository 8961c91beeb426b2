//! Shapes of bodies: files of triangles next to the model file, for drawings and masses. Materials, colours and normals
//! are not read.

mod gltf;
mod obj;
mod stl;

use std::collections::{BTreeMap, HashMap};
use std::ops::Range;
use std::path::Path;

use hardpoint::model::{OpenSurface, Solid};
use hardpoint::space::{Vec3, open_edges, overlap_of_parts};

use crate::values::{
    DataError, Field, Fields, Folder, NUMBER, Reader, Severity, Shape, Table, Wanted, bytes_of, closest,
    shown, table,
};

use super::drawing::{MESH_FRAMES, Mesh, MeshFrame};

/// Maximum number of triangles: more make a page slow without a visible difference.
const MOST_TRIANGLES: usize = 200_000;

pub(super) const MESH: Shape = Shape::Any("Mesh", "", &[Shape::File, Shape::Table(&MESH_TABLE)]);
pub(super) const MESH_TABLE: Table = table! {
    /// Shape of a body.
    "MeshFile":
    /// A file of triangles in the model's folder or below it: `.stl`, `.obj`, `.glb` or `.gltf` (with transforms of
    /// nodes, unchanged axes and embedded data).
    must "file": Shape::File, "\"knuckle.stl\"";
    /// Frame of its coordinates.
    or("\"world\"") "frame": Shape::Words(MESH_FRAMES), "\"body\"";
    /// The unit of its coordinates, in the model's length unit: 0.001 for a file in mm and a model in m.
    or("1.0") "scale": NUMBER, "0.001";
    /// The axis of these coordinates across which the shape is mirrored. Default: not mirrored.
    may "mirror": Shape::Words(&[("x", ""), ("y", ""), ("z", "")]), "\"y\"";
};

/// Reads the triangles of a file.
type Load = fn(&[u8], &mut Triangles) -> Result<(), String>;

/// Ends the name of the triangles of a shape's file among the texts of a model.
pub(crate) const SURFACE: &str = " as a surface";

/// Kinds of files, by the endings of their names.
const KINDS: [(&str, &str, Load); 4] = [
    ("stl", "an STL file", stl::load),
    ("obj", "an OBJ file", obj::load),
    ("glb", "a glTF file", gltf::load),
    ("gltf", "a glTF file", gltf::load),
];

/// Collected triangles; equal points become one vertex.
#[derive(Default)]
struct Triangles {
    places: HashMap<[u64; 3], u32>,
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    /// Total number, stored or not.
    count: usize,
}

impl Triangles {
    /// Vertices and triangles as text: their number, then the coordinates, then the corners.
    fn text(&self) -> String {
        let number = std::iter::once(self.vertices.len().to_string());
        // The shortest text that is read back as the same number
        let vertices = self.vertices.iter().flatten().map(|x| format!("{x:e}"));
        let corners = self.triangles.iter().flatten().map(u32::to_string);
        number.chain(vertices).chain(corners).collect::<Vec<_>>().join(" ")
    }

    /// Reads such a text; `None` if it is not valid.
    fn of_text(text: &str) -> Option<Self> {
        let mut words = text.split_ascii_whitespace();
        let number: usize = words.next()?.parse().ok()?;
        let places: Option<Vec<f64>> = words.by_ref().take(3 * number).map(|x| x.parse().ok()).collect();
        let (vertices, rest) = places.as_ref()?.as_chunks();
        let corner = |k: &str| k.parse().ok().filter(|k| (*k as usize) < vertices.len());
        let corners: Option<Vec<u32>> = words.map(corner).collect();
        let (triangles, left) = corners.as_ref()?.as_chunks();
        let is_whole =
            rest.is_empty() && left.is_empty() && vertices.len() == number && !triangles.is_empty();
        let is_finite = vertices.iter().flatten().all(|x: &f64| x.is_finite());
        let (vertices, triangles) = (vertices.to_vec(), triangles.to_vec());
        (is_whole && is_finite).then(|| Self {
            count: triangles.len(),
            vertices,
            triangles,
            ..Self::default()
        })
    }

    /// Adds a triangle. Beyond the maximum number it is only counted; a degenerate one is left out.
    fn push(&mut self, corners: [[f64; 3]; 3]) -> Result<(), String> {
        self.count += 1;
        if let Some(corner) = corners.iter().find(|c| c.iter().any(|x| !x.is_finite())) {
            return Err(format!("triangle {} has a corner at {corner:?}, which is not finite", self.count));
        }
        if self.count > MOST_TRIANGLES {
            return Ok(());
        }
        let triangle = corners.map(|at| {
            // Zeros of both signs are equal.
            let at = at.map(|x| x + 0.0);
            let next = self.vertices.len() as u32;
            let vertex = *self.places.entry(at.map(f64::to_bits)).or_insert(next);
            if vertex == next {
                self.vertices.push(at);
            }
            vertex
        });
        let [a, b, c] = triangle;
        if a != b && b != c && c != a {
            self.triangles.push(triangle);
        }
        Ok(())
    }
}

/// HP0115: the file has no usable shape.
fn unfit(message: String, help: &str) -> DataError {
    DataError::new("HP0115", message, help)
}

/// Triangles of a file in the model's folder or below it.
fn triangles_of(folder: Folder<'_>, name: &str) -> Result<Triangles, DataError> {
    let ending = Path::new(name).extension().and_then(|e| e.to_str()).unwrap_or_default();
    let kind = KINDS.iter().find(|kind| kind.0.eq_ignore_ascii_case(ending));
    let wanted = Wanted {
        purpose: "mesh",
        kind: kind.map_or("an STL, OBJ or glTF file", |kind| kind.1),
        ending: kind.map_or("stl", |kind| kind.0),
        example: "shapes/knuckle.stl",
        without_folder: "leave `mesh` out, or read the model from a file",
        too_large: "reduce the number of its triangles (decimate it) before it is exported",
    };
    let bytes = bytes_of(folder, name, &wanted)?;
    let name = shown(name);
    let Some((_, kind, load)) = kind else {
        let message = format!("the format of `{name}` is not supported");
        return Err(unfit(message, "name a `.stl`, `.obj`, `.glb` or `.gltf` file"));
    };
    let mut triangles = Triangles::default();
    if let Err(why) = load(&bytes, &mut triangles) {
        let message = format!("`{name}` cannot be read as {kind}");
        return Err(unfit(message, "export the body again, as triangles").note(why));
    }
    let count = triangles.count;
    if count > MOST_TRIANGLES {
        let message = format!("`{name}` has {count} triangles; at most {MOST_TRIANGLES} are drawn");
        return Err(unfit(message, "reduce their number (decimate the mesh) before it is exported"));
    }
    if triangles.triangles.is_empty() {
        let message = format!("`{name}` has no triangles");
        return Err(unfit(message, "export the body as triangles"));
    }
    Ok(triangles)
}

/// Triangles in the bytes of a mesh file, whose kind follows from the ending of its name: three corners each, as
/// written.
///
/// # Errors
/// Returns the reason as a sentence.
pub fn triangles(name: &str, bytes: &[u8]) -> Result<Vec<[[f64; 3]; 3]>, String> {
    let ending = Path::new(name).extension().and_then(|e| e.to_str()).unwrap_or_default();
    let Some((_, kind, load)) = KINDS.iter().find(|kind| kind.0.eq_ignore_ascii_case(ending)) else {
        return Err("it must be `.stl`, `.obj`, `.glb` or `.gltf`".into());
    };
    let mut read = Triangles::default();
    load(bytes, &mut read).map_err(|why| format!("it cannot be read as {kind}: {why}"))?;
    match read.count {
        0 => Err("it has no triangles".into()),
        n if n > MOST_TRIANGLES => Err(format!("it has {n} triangles; at most {MOST_TRIANGLES} are drawn")),
        _ => Ok(read.triangles.iter().map(|t| t.map(|k| read.vertices[k as usize])).collect()),
    }
}

/// Entry of a mesh in a model.
#[derive(Clone)]
pub(crate) struct MeshDraft {
    /// Name of its file, with the position in the text.
    file: (String, Range<usize>),
    frame: MeshFrame,
    /// Unit of its coordinates, in the model's length unit.
    scale: f64,
    /// Axis across which it is mirrored.
    mirror: Option<usize>,
}

/// Shape of a body, as far as it is known.
#[derive(Clone)]
pub(crate) enum BodyMesh {
    /// The body has no shape.
    None,
    /// Entry of the mesh, not read yet.
    Said(MeshDraft),
    /// The entry could not be read.
    Faulty,
}

/// Entries of the bodies' shapes, by name.
pub(crate) type Meshes = BTreeMap<String, BodyMesh>;

/// Reads the shape of a body: a file name, or a table with it.
pub(super) fn mesh(r: &mut Reader<'_>, body: &Fields<'_>, f: Field<'_>) -> Option<MeshDraft> {
    if f.value.get_ref().is_str() {
        let file = (r.text(body, f)?, f.value.span());
        return Some(MeshDraft { file, frame: MeshFrame::World, scale: 1.0, mirror: None });
    }
    let subject = body.subject(f.key);
    let table = r.table(f.value, &subject, "the name of a file, or a table with it")?;
    let what = format!("the mesh of {}", body.what);
    let fields = r.fields(what, f.value.span(), table, MESH_TABLE.keys());
    let frame = r.word_of(&fields, "frame").map(|k| MeshFrame::ALL[k]);
    let scale = r.number_of(&fields, "scale");
    let mirror = r.word_of(&fields, "mirror");
    let file = r.need(&fields, "file");
    let name = file.and_then(|file| r.text(&fields, file));
    if let (Some(x), Some(f)) = (scale.filter(|x| !(*x > 0.0)), fields.get("scale")) {
        let message = format!("{} cannot be {x}", fields.subject("scale").name);
        r.senseless(f.value.span(), message).help =
            Some("give the size of one unit of the file in the model's length unit, like `0.001`".into());
        return None;
    }
    Some(MeshDraft { file: (name?, file?.value.span()), frame: frame?, scale: scale?, mirror })
}

/// Reads a mesh for drawings.
pub(super) fn drawn(r: &mut Reader<'_>, said: &MeshDraft) -> Option<Mesh> {
    // Drawings do not affect results, and the page has the shapes already: its engine needs no readers of meshes.
    if cfg!(target_family = "wasm") || matches!(r.folder, Folder::Given(_)) {
        return None;
    }
    let found = triangles_of(r.folder, &said.file.0);
    placed(r, said, found)
}

/// Places the triangles of a file in the model, or reports why there are none.
fn placed(r: &mut Reader<'_>, said: &MeshDraft, found: Result<Triangles, DataError>) -> Option<Mesh> {
    let (name, at) = &said.file;
    let found = match found {
        Ok(found) => found,
        Err(e) => {
            r.data_error(at.clone(), e);
            return None;
        }
    };
    let metres = |x: f64| r.units.length.metres(x * said.scale);
    let vertex = |&[x, y, z]: &[f64; 3]| {
        let at = Vec3::new(x, y, z).map(metres);
        said.mirror.map_or(at, |axis| at.mirrored(Vec3::AXES[axis]))
    };
    let vertices = found.vertices.iter().map(vertex).collect();
    // A mirror reverses the orientation of the corners.
    let corners = |[a, b, c]: [u32; 3]| if said.mirror.is_some() { [a, c, b] } else { [a, b, c] };
    let triangles = found.triangles.into_iter().map(corners).collect();
    Some(Mesh { file: name.clone(), frame: said.frame, vertices, triangles })
}

/// Corners in m and triangles of a surface, and whether they are given in the body's frame.
type CornersAndTriangles = (Vec<Vec3>, Vec<[u32; 3]>, bool);

/// The surface of a shape: a file, or with `true` that of its body. Without files, on the page, it has no triangles.
pub(super) fn surface(
    r: &mut Reader<'_>,
    meshes: &Meshes,
    shape: &Fields<'_>,
    f: Field<'_>,
    body: &str,
) -> Option<CornersAndTriangles> {
    let said = match f.value.get_ref().as_bool() {
        Some(true) => match meshes.get(body).cloned() {
            Some(BodyMesh::Said(said)) => said,
            // An error of the body is reported at its own entry, an unknown body by the core.
            Some(BodyMesh::Faulty) => return None,
            None if body != "ground" => return Some((Vec::new(), Vec::new(), true)),
            None | Some(BodyMesh::None) => {
                let message =
                    format!("{} is the `mesh` of body `{}`, which has none", shape.what, shown(body));
                r.report("HP0104", f.value.span(), message).help =
                    Some("name a file, for example `mesh = \"arch.stl\"`".into());
                return None;
            }
        },
        Some(false) => {
            r.wrong(f.value, &shape.subject(f.key), "the name of a file, or `true`");
            return None;
        }
        None => mesh(r, shape, f)?,
    };
    if cfg!(target_family = "wasm") {
        return Some((Vec::new(), Vec::new(), true));
    }
    let found = surface_in_file(r, &said.file.0);
    let Mesh { vertices, triangles, frame, file } = placed(r, &said, found)?;
    remark_on_surface(r, shape, f, (&vertices, &triangles), &file);
    Some((vertices, triangles, frame == MeshFrame::Body))
}

/// HP0119: an open surface. HP0120: closed parts that overlap.
fn remark_on_surface(
    r: &mut Reader<'_>,
    shape: &Fields<'_>,
    f: Field<'_>,
    (vertices, triangles): (&[Vec3], &[[u32; 3]]),
    file: &str,
) {
    let open = open_edges(triangles);
    let metres = r.units.length.metres(1.0);
    // Six decimals of the model's unit: corners of STL files have no more digits.
    let place = |p: Vec3| {
        let [x, y, z] = p.map(|x| (1e6 * x / metres).round() / 1e6).to_array();
        format!("({x}, {y}, {z})")
    };
    if let Some([a, b]) = open.first().map(|edge| edge.map(|k| vertices[k as usize])) {
        let edges = if open.len() == 1 { "1 edge".into() } else { format!("{} edges", open.len()) };
        let note = format!(
            "at {edges} of `{}` triangles have no neighbour with the same orientation; one runs from {} to {}",
            shown(file),
            place(a),
            place(b)
        );
        let message = format!("{} is an open surface", shape.what);
        let d = r.remark(Severity::Note, "HP0119", f.value.span(), message);
        d.notes.push(note);
        d.notes.push(
            "it has no inside: a shape within it is as far from it as from its nearest triangle".into(),
        );
        d.help = Some("if it should be a solid, export it again with all edges closed".into());
    } else if let Some(at) = overlap_of_parts(vertices, triangles) {
        let message = format!("closed parts of {} overlap or touch", shape.what);
        let d = r.remark(Severity::Note, "HP0120", f.value.span(), message);
        d.notes.push(format!("two parts of `{}` meet at {}", shown(file), place(at)));
        d.notes.push("faces of one part within another count as surface: depths there are too small".into());
        d.help = Some("unite the parts in the program that exports them".into());
    }
}

/// Triangles of a shape's file, in the file's own unit and axes. The text of a model is passed with these triangles,
/// not with the file.
fn surface_in_file(r: &mut Reader<'_>, name: &str) -> Result<Triangles, DataError> {
    let known = format!("{name}{SURFACE}");
    let found = match (r.folder.given(&known), r.folder) {
        (Some(text), _) => Triangles::of_text(text).ok_or_else(|| not_passed(name)),
        (None, Folder::Given(_)) => Err(not_passed(name)),
        (None, Folder::None | Folder::On(_) | Folder::Over(..)) => triangles_of(r.folder, name),
    }?;
    r.texts.insert(known, found.text());
    Ok(found)
}

/// A mesh that a text of a model without a folder does not have.
fn not_passed(name: &str) -> DataError {
    let message = format!("the mesh `{}` is not part of this model", shown(name));
    DataError::unreadable(message, "read the model from its folder, where the mesh is")
}

/// Solid enclosed by the surface of a mass: the mesh under this key, or else that of its body.
pub(super) fn solid(
    r: &mut Reader<'_>,
    meshes: &Meshes,
    mass: &Fields<'_>,
    key: &'static str,
) -> Option<Solid> {
    let said = match mass.get(key) {
        Some(f) => mesh(r, mass, f)?,
        None => {
            // Errors of the body are reported at its own entry.
            let f = mass.get("body")?;
            let body = f.value.get_ref().as_str()?;
            match meshes.get(body).cloned() {
                Some(BodyMesh::Said(said)) => said,
                Some(BodyMesh::Faulty) => return None,
                None if body == "ground" => {
                    let message = format!("{} is on ground, where it has no effect", mass.what);
                    r.report("HP0251", f.value.span(), message).help =
                        Some("put it on the body that it belongs to, or remove it".into());
                    return None;
                }
                None => {
                    let close = closest(body, meshes.keys().map(String::as_str)).map(str::to_owned);
                    let message = format!("there is no body named `{}`", shown(body));
                    r.report("HP0204", f.value.span(), message).help =
                        close.map(|c| format!("did you mean `{c}`?"));
                    return None;
                }
                Some(BodyMesh::None) => {
                    let message =
                        format!("{} has no `{key}`, and neither has body `{}`", mass.what, shown(body));
                    r.report("HP0104", mass.at.clone(), message).help =
                        Some(format!("add it, for example {}", mass.example(key)));
                    return None;
                }
            }
        }
    };
    let place = mass.get(key).map_or_else(|| mass.at.clone(), |f| f.value.span());
    match solid_in_file(r, &said) {
        Ok(solid) => {
            let solid = solid.scaled(r.units.length.metres(said.scale));
            let solid = said.mirror.map_or(solid, |axis| solid.mirrored(axis));
            Some(Solid { in_body: said.frame == MeshFrame::Body, ..solid })
        }
        Err(e) => {
            r.data_error(place, e);
            None
        }
    }
}

/// Solid enclosed by the surface in a file, in the file's own unit and axes.
fn solid_in_file(r: &mut Reader<'_>, said: &MeshDraft) -> Result<Solid, DataError> {
    let (name, _) = &said.file;
    // The text of a model is passed with the mass properties of its meshes, not with the meshes.
    let known = format!("{name} as a solid");
    let given = r.folder.given(&known);
    // The engine of the page has no readers of meshes.
    if given.is_some() || matches!(r.folder, Folder::Given(_)) || cfg!(target_family = "wasm") {
        let found = given.and_then(|text| {
            r.texts.insert(known.clone(), text.clone());
            let numbers: Option<Vec<f64>> = text.split_whitespace().map(|x| x.parse().ok()).collect();
            <[f64; 10]>::try_from(numbers?).ok()
        });
        let [volume, x, y, z, second @ ..] = found.ok_or_else(|| not_passed(name))?;
        return Ok(Solid { volume, centre: Vec3::new(x, y, z), second, in_body: false });
    }
    let Triangles { vertices, triangles, .. } = triangles_of(r.folder, name)?;
    let vertices: Vec<Vec3> = vertices.into_iter().map(Vec3::from).collect();
    let solid = Solid::of(&vertices, &triangles).map_err(|open| bounds_nothing(name, open))?;
    let Solid { volume, centre, second, .. } = solid;
    let numbers = [volume].into_iter().chain(centre.to_array()).chain(second);
    // The shortest text that is read back as the same number
    let numbers: Vec<String> = numbers.map(|x| format!("{x:e}")).collect();
    r.texts.insert(known, numbers.join(" "));
    Ok(solid)
}

/// HP0118: a surface that encloses no volume.
fn bounds_nothing(name: &str, open: OpenSurface) -> DataError {
    let (message, note) = match open {
        OpenSurface::Edges(count, [a, b]) => {
            let edges = if count == 1 { "1 edge".into() } else { format!("{count} edges") };
            let [a, b] = [a, b].map(|p| format!("({}, {}, {})", p.x, p.y, p.z));
            let note = format!(
                "at {edges} it is open: triangles there have no neighbour with the same orientation; one edge runs from {a} to {b} in the file's coordinates"
            );
            (format!("the surface in `{}` is not closed, so that it bounds no volume", shown(name)), note)
        }
        OpenSurface::Flat => (
            format!("the surface in `{}` encloses no volume", shown(name)),
            "its triangles lie in a plane, or one side is as far out as the other".into(),
        ),
    };
    let help = "export the body as a watertight solid, in full precision (binary STL, OBJ or glTF), or give its mass as `rigid`";
    DataError::new("HP0118", message, help).note(note)
}
