//! OBJ: all groups and objects of a file.

use tobj::{LoadError, LoadOptions, load_obj_buf};

use super::Triangles;

pub(super) fn load(mut bytes: &[u8], into: &mut Triangles) -> Result<(), String> {
    let options =
        LoadOptions { triangulate: true, ignore_points: true, ignore_lines: true, ..LoadOptions::default() };
    // No file of materials is opened.
    let read = load_obj_buf(&mut bytes, &options, |_| Err(LoadError::OpenFileFailed));
    let (models, _) = read.map_err(|e| e.to_string())?;
    for model in models {
        let at = |vertex: u32| {
            let first = 3 * vertex as usize;
            let at = model.mesh.positions.get(first..first + 3)?;
            Some([at[0], at[1], at[2]].map(f64::from))
        };
        for triangle in model.mesh.indices.chunks_exact(3) {
            let [Some(a), Some(b), Some(c)] = [triangle[0], triangle[1], triangle[2]].map(at) else {
                return Err(format!("`{}` has a face without vertices", model.name));
            };
            into.push([a, b, c])?;
        }
    }
    Ok(())
}
