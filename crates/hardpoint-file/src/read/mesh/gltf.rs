//! glTF 2.0: the meshes of the scene that is shown, with the transforms of its nodes. Lengths and places in the file
//! are checked here: what a damaged file says need not be so.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::Source;
use gltf::mesh::Mode;
use gltf::{Accessor, Gltf, Node, Primitive, Semantic};
use hardpoint::space::{Mat3, Vec3};

use super::{MOST_TRIANGLES, Triangles};

/// A transform, columns first.
type Matrix = [[f64; 4]; 4];

/// No scene is as deep; one that is returns to itself.
const DEEPEST: usize = 256;

pub(super) fn load(bytes: &[u8], into: &mut Triangles) -> Result<(), String> {
    if bytes.starts_with(b"glTF") && !is_whole(bytes) {
        return Err("the file ends early".into());
    }
    let Gltf { document, mut blob } = Gltf::from_slice(bytes).map_err(|e| e.to_string())?;
    let mut buffers = Vec::new();
    for buffer in document.buffers() {
        buffers.push(match buffer.source() {
            Source::Bin => blob.take().ok_or("its binary part is missing")?,
            Source::Uri(uri) => {
                let Some((_, data)) = uri.split_once(";base64,").filter(|_| uri.starts_with("data:")) else {
                    return Err("its data is in another file; a `.glb` file has all in one".into());
                };
                STANDARD.decode(data).map_err(|e| e.to_string())?
            }
        });
    }
    let scene = document.default_scene().or(document.scenes().next()).ok_or("it has no scene")?;
    let mut open: Vec<(Node<'_>, Matrix, usize)> = scene
        .nodes()
        .map(|node| {
            let own = matrix(&node);
            (node, own, 0)
        })
        .collect();
    let mut left = document.nodes().len();
    while let Some((node, world_from_node, depth)) = open.pop() {
        // Every node has one parent.
        if left == 0 || depth > DEEPEST {
            return Err("a node is below itself, or below two others".into());
        }
        left -= 1;
        for primitive in node.mesh().iter().flat_map(|mesh| mesh.primitives()) {
            add(&primitive, &buffers, &world_from_node, into)?;
        }
        open.extend(node.children().map(|child| {
            let world_from_child = product(&world_from_node, &matrix(&child));
            (child, world_from_child, depth + 1)
        }));
    }
    Ok(())
}

/// True if a binary file is as long as it and its parts say.
fn is_whole(bytes: &[u8]) -> bool {
    let word = |at: usize| {
        let word = bytes.get(at..at + 4)?.try_into().ok()?;
        Some(u32::from_le_bytes(word) as usize)
    };
    let Some(length) = word(8).filter(|n| *n <= bytes.len()) else { return false };
    let mut at = 12;
    while at < length {
        match word(at).and_then(|part| (at + 8).checked_add(part)).filter(|end| *end <= length) {
            Some(end) => at = end,
            None => return false,
        }
    }
    at > 12
}

fn matrix(node: &Node<'_>) -> Matrix {
    node.transform().matrix().map(|column| column.map(f64::from))
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    b.map(|column| [0, 1, 2, 3].map(|row| (0..4).map(|k| a[k][row] * column[k]).sum()))
}

/// The triangles of a primitive.
fn add(
    primitive: &Primitive<'_>,
    buffers: &[Vec<u8>],
    world_from_node: &Matrix,
    into: &mut Triangles,
) -> Result<(), String> {
    match primitive.mode() {
        Mode::Triangles => {}
        Mode::TriangleStrip | Mode::TriangleFan => {
            return Err("it has strips or fans of triangles in place of single ones".into());
        }
        // What has no extent is no shape.
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => return Ok(()),
    }
    let positions = primitive.get(&Semantic::Positions).ok_or("a mesh has no positions")?;
    if (positions.data_type(), positions.dimensions()) != (DataType::F32, Dimensions::Vec3) {
        return Err("positions are not three 32-bit numbers each".into());
    }
    let places = items::<12>(&positions, buffers)?;
    let order: Vec<usize> = match primitive.indices() {
        None => (0..places.len()).collect(),
        Some(of) => match of.data_type() {
            DataType::U8 => items::<1>(&of, buffers)?.into_iter().map(|b| b[0].into()).collect(),
            DataType::U16 => {
                items::<2>(&of, buffers)?.into_iter().map(|b| u16::from_le_bytes(b).into()).collect()
            }
            DataType::U32 => {
                items::<4>(&of, buffers)?.into_iter().map(|b| u32::from_le_bytes(b) as usize).collect()
            }
            _ => return Err("indices are not whole numbers".into()),
        },
    };
    if into.count > MOST_TRIANGLES {
        // A mesh may be shown by many nodes.
        into.count += order.len() / 3;
        return Ok(());
    }
    let at = |vertex: &usize| {
        let bytes = places.get(*vertex)?;
        let local = [0, 4, 8]
            .map(|k| f64::from(f32::from_le_bytes([bytes[k], bytes[k + 1], bytes[k + 2], bytes[k + 3]])));
        let m = world_from_node;
        Some([0, 1, 2].map(|row| m[3][row] + (0..3).map(|k| m[k][row] * local[k]).sum::<f64>()))
    };
    let [x, y, z, _] = world_from_node.map(|[x, y, z, _]| Vec3::new(x, y, z));
    let is_mirrored = Mat3 { cols: [x, y, z] }.is_mirror();
    for triangle in order.chunks_exact(3) {
        let [Some(a), Some(b), Some(c)] = [&triangle[0], &triangle[1], &triangle[2]].map(at) else {
            return Err("a triangle has a vertex that is not there".into());
        };
        into.push(if is_mirrored { [a, c, b] } else { [a, b, c] })?;
    }
    Ok(())
}

/// The items of an accessor, that many bytes each.
fn items<const SIZE: usize>(of: &Accessor<'_>, buffers: &[Vec<u8>]) -> Result<Vec<[u8; SIZE]>, String> {
    if of.sparse().is_some() {
        return Err("it has sparse data".into());
    }
    let view = of.view().ok_or("an accessor has no data")?;
    let data = buffers.get(view.buffer().index()).and_then(|buffer| {
        let end = view.offset().checked_add(view.length())?;
        buffer.get(view.offset()..end)?.get(of.offset()..)
    });
    let data = data.ok_or("the file ends early")?;
    let stride = view.stride().unwrap_or(SIZE).max(SIZE);
    let items: Vec<[u8; SIZE]> =
        data.chunks(stride).take(of.count()).filter_map(|item| item.first_chunk().copied()).collect();
    if items.len() < of.count() {
        return Err("the file ends early".into());
    }
    Ok(items)
}
