//! Surfaces of triangles as binary STL files.

use std::io::{self, Write};

use hardpoint::space::Vec3;
use stl_io::{Normal, Triangle, Vector};

/// Writes triangles, whose corners turn to the left seen from outside, in the unit of the numbers given.
///
/// # Errors
/// If `out` cannot be written.
pub fn write_stl(
    triangles: impl ExactSizeIterator<Item = [Vec3; 3]>,
    out: &mut impl Write,
) -> io::Result<()> {
    let single = |v: Vec3| v.to_array().map(|x| x as f32);
    let triangle = |corners: [Vec3; 3]| {
        let [a, b, c] = corners;
        let across = (b - a).cross(c - a);
        let length = across.norm();
        let normal = if length > 0.0 { across * (1.0 / length) } else { Vec3::ZERO };
        Triangle { normal: Normal::new(single(normal)), vertices: corners.map(|v| Vector::new(single(v))) }
    };
    stl_io::write_stl(out, triangles.map(triangle))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_closed_surface_is_read_back_as_one() {
        let [a, b, c, d] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 4.0]]
            .map(|[x, y, z]| Vec3::new(x, y, z));
        let faces = [[a, c, b], [a, b, d], [b, c, d], [c, a, d]];
        let mut bytes = Vec::new();
        write_stl(faces.into_iter(), &mut bytes).unwrap();
        let mesh = stl_io::read_stl(&mut io::Cursor::new(bytes)).unwrap();
        assert_eq!((mesh.faces.len(), mesh.vertices.len()), (4, 4));
        mesh.validate().unwrap();
    }
}
