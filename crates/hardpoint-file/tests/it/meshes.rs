//! Shapes of bodies: all kinds of files have the same result, and errors are reported.

use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use hardpoint_file::{Mesh, ModelFile, ReadError, read};

/// The corners of a tetrahedron, and its faces.
const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [0.0, 20.0, 0.0], [0.0, 0.0, 30.5]];
const FACES: [[u8; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

fn model(mesh: &str) -> String {
    format!(
        r#"
name = "pendulum"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ pivot = [0, 0, 500] }}
bodies.arm = {{ mesh = {mesh} }}
joints.hinge = {{ type = "revolute", bodies = ["ground", "arm"], at = "pivot", axis = "y" }}
drivers.turn = {{ joint = "hinge", law = "t" }}
time = {{ end = 1.0, steps = 2 }}
"#
    )
}

fn read_in(folder: &Path, mesh: &str) -> Result<ModelFile, ReadError> {
    let path = folder.join("pendulum.toml");
    std::fs::write(&path, model(mesh)).unwrap();
    read(&path)
}

/// The mesh of a model whose folder has that file.
fn mesh_of(name: &str, bytes: &[u8], mesh: &str) -> Mesh {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(name), bytes).unwrap();
    let file = read_in(folder.path(), mesh).unwrap();
    assert_eq!(file.model.bodies[1].name, "arm");
    file.drawing.bodies[&1].clone()
}

/// The code of the first problem of a model whose folder has that file, and all that is said.
fn refused(name: &str, bytes: &[u8], mesh: &str) -> (&'static str, String) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(name), bytes).unwrap();
    let error = read_in(folder.path(), mesh).unwrap_err();
    let list = error.diagnostics().list();
    assert_eq!(list.len(), 1, "{error}");
    assert!(list[0].line == Some(5) && list[0].help.is_some(), "{error}");
    (list[0].code, error.to_string())
}

fn text_stl(solid: &str) -> Vec<u8> {
    let mut text = format!("{solid}\n");
    for face in FACES {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in face.map(|k| CORNERS[k as usize]) {
            text += &format!("vertex {x} {y} {z}\n");
        }
        text += "endloop\nendfacet\n";
    }
    (text + "endsolid\n").into_bytes()
}

fn binary_stl(remark: &[u8], faces: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = remark.to_vec();
    bytes.resize(80, b' ');
    bytes.extend((faces.len() as u32).to_le_bytes());
    for face in faces {
        bytes.extend([0; 12]);
        bytes.extend(face.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn faces() -> [[[f32; 3]; 3]; 4] {
    FACES.map(|face| face.map(|k| CORNERS[k as usize]))
}

fn obj() -> Vec<u8> {
    let corners = CORNERS.map(|[x, y, z]| format!("v {x} {y} {z}\n")).concat();
    let faces = FACES.map(|f| format!("usemtl paint\nf {}\n", f.map(|k| (k + 1).to_string()).join(" ")));
    format!("mtllib paint.mtl\no arm\n{corners}{}", faces.concat()).into_bytes()
}

/// The corners and faces of a glTF file: the corners half as large and moved, which its nodes undo.
fn gltf_data() -> Vec<u8> {
    let corners = CORNERS.map(|[x, y, z]| [(x - 4.0) / 2.0, y / 2.0, z / 2.0]);
    let places = corners.as_flattened().iter().flat_map(|x| x.to_le_bytes());
    places.chain(FACES.as_flattened().iter().copied()).collect()
}

fn gltf_text(uri: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
"nodes":[{{"children":[1],"translation":[4,0,0]}},{{"mesh":0,"scale":[2,2,2]}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[-2,0,0],"max":[3,10,15.25]}},
{{"bufferView":1,"componentType":5121,"count":12,"type":"SCALAR"}}],
"bufferViews":[{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":12}}],
"buffers":[{{"byteLength":60{uri}}}]}}"#
    )
}

fn glb(text: &str) -> Vec<u8> {
    let mut text = text.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let data = gltf_data();
    let mut bytes = b"glTF".to_vec();
    bytes.extend([2, (28 + text.len() + data.len()) as u32].map(u32::to_le_bytes).as_flattened());
    for (part, kind) in [(&text, b"JSON"), (&data, b"BIN\0")] {
        bytes.extend((part.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(part);
    }
    bytes
}

/// The corners of all triangles in mm, in their order.
fn corners(mesh: &Mesh) -> Vec<[f64; 3]> {
    let at = |k: &u32| mesh.vertices[*k as usize].to_array().map(|x| (x * 1e9).round() / 1e6);
    mesh.triangles.as_flattened().iter().map(at).collect()
}

#[test]
fn every_kind_of_file_gives_the_same_triangles() {
    let expected: Vec<[f64; 3]> = faces().as_flattened().iter().map(|at| at.map(f64::from)).collect();
    let data = STANDARD.encode(gltf_data());
    let embedded = gltf_text(&format!(",\"uri\":\"data:application/octet-stream;base64,{data}\""));
    for (name, bytes) in [
        ("named.stl", text_stl("solid arm")),
        ("unnamed.stl", text_stl("solid")),
        ("binary.stl", binary_stl(b"made by hand", &faces())),
        ("solid.stl", binary_stl(b"solid arm", &faces())),
        ("arm.obj", obj()),
        ("arm.glb", glb(&gltf_text(""))),
        ("arm.gltf", embedded.into_bytes()),
        ("ARM.GLB", glb(&gltf_text(""))),
    ] {
        let mesh = mesh_of(name, &bytes, &format!("\"{name}\""));
        assert_eq!((mesh.file.as_str(), mesh.vertices.len()), (name, 4));
        assert_eq!(corners(&mesh), expected, "{name}");
    }
    // A node that mirrors reverses the orientation of its triangles.
    let mirrored = gltf_text("").replace("\"scale\":[2,2,2]", "\"scale\":[2,-2,2]");
    let reversed: Vec<[f64; 3]> = faces()
        .map(|[a, b, c]| [a, c, b])
        .as_flattened()
        .iter()
        .map(|at| at.map(f64::from))
        .map(|[x, y, z]| [x, 0.0 - y, z])
        .collect();
    assert_eq!(corners(&mesh_of("arm.glb", &glb(&mirrored), "\"arm.glb\"")), reversed);
    // Metres of the file beside millimetres of the model.
    let mesh = mesh_of("arm.obj", &obj(), "{ file = \"arm.obj\", scale = 1000, frame = \"body\" }");
    assert_eq!(mesh.vertices[1].to_array(), [0.0, 20.0, 0.0]);
}

#[test]
fn files_without_a_shape_are_rejected() {
    let stl = |faces: &[[[f32; 3]; 3]]| binary_stl(b"", faces);
    let cases: [(&str, Vec<u8>, &str, &str); 17] = [
        ("else.stl", stl(&faces()), "HP0111", "there is no file `arm.stl`"),
        ("arm.step", b"ISO-10303-21;".to_vec(), "HP0115", "`.stl`, `.obj`, `.glb` or `.gltf`"),
        ("arm", b"".to_vec(), "HP0115", "is not supported"),
        ("arm.stl", b"".to_vec(), "HP0115", "cannot be read as an STL file"),
        ("arm.stl", b"solid arm\nfacet normal 0 0".to_vec(), "HP0115", "cannot be read as an STL file"),
        ("arm.stl", stl(&[]), "HP0115", "has no triangles"),
        ("arm.stl", stl(&[[CORNERS[0]; 3]]), "HP0115", "has no triangles"),
        ("arm.stl", stl(&[[[f32::NAN; 3]; 3]]), "HP0115", "which is not finite"),
        ("arm.stl", stl(&vec![faces()[0]; 200_001]), "HP0115", "has 200001 triangles"),
        ("arm.obj", b"v 0 0 0\nv 1 0 0\nf 1 2 9\n".to_vec(), "HP0115", "cannot be read as an OBJ file"),
        ("arm.obj", b"v 0 0 0\nv 1 0 0\n".to_vec(), "HP0115", "has no triangles"),
        ("arm.glb", b"glTF".to_vec(), "HP0115", "the file ends early"),
        ("arm.glb", glb(&gltf_text(""))[..200].to_vec(), "HP0115", "the file ends early"),
        (
            "arm.glb",
            glb(&gltf_text("").replace("\"count\":4", "\"count\":5")),
            "HP0115",
            "the file ends early",
        ),
        (
            "arm.glb",
            glb(&gltf_text("").replace("\"mesh\":0", "\"children\":[0],\"mesh\":0")),
            "HP0115",
            "below",
        ),
        ("arm.gltf", gltf_text(",\"uri\":\"arm.bin\"").into_bytes(), "HP0115", "its data is in another file"),
        ("arm.gltf", b"{}".to_vec(), "HP0115", "cannot be read as a glTF file"),
    ];
    for (name, bytes, code, says) in cases {
        let named = name.replace("else", "arm");
        let (found, text) = refused(name, &bytes, &format!("\"{named}\""));
        assert!(found == code && text.contains(says), "{name}: {says}\n{text}");
    }
    let refused = |mesh: &str| refused("arm.stl", &stl(&faces()), mesh);
    assert_eq!(refused("\"../arm.stl\"").0, "HP0111");
    assert_eq!(refused("{ file = \"arm.stl\", scale = 0 }").0, "HP0109");
    assert_eq!(refused("{ file = \"arm.stl\", frame = \"car\" }").0, "HP0106");
    assert_eq!(refused("{ scale = 2 }").0, "HP0104");
    assert_eq!(refused("12").0, "HP0105");
    let of_text = hardpoint_file::parse(&model("\"arm.stl\""), "pendulum.toml").unwrap_err();
    assert_eq!(of_text.list()[0].code, "HP0111");
}

#[test]
fn a_damaged_file_is_refused_and_does_no_harm() {
    for (name, whole) in
        [("arm.glb", glb(&gltf_text(""))), ("arm.obj", obj()), ("arm.stl", text_stl("solid"))]
    {
        let folder = tempfile::tempdir().unwrap();
        for k in (0..whole.len()).step_by(3) {
            let mut bytes = whole.clone();
            bytes[k] = bytes[k].wrapping_add(97);
            std::fs::write(folder.path().join(name), &bytes).unwrap();
            let _ = read_in(folder.path(), &format!("\"{name}\""));
            std::fs::write(folder.path().join(name), &whole[..k]).unwrap();
            let _ = read_in(folder.path(), &format!("\"{name}\""));
        }
    }
}
