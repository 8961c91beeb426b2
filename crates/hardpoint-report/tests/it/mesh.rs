//! The shape of a body on the page: in its frame, in the page's unit.

use hardpoint::Analysis;
use hardpoint_report::course::Course;
use hardpoint_report::page::Payload;
use hardpoint_report::payload::{Request, payload};
use hardpoint_report::summary::Summary;

const MODEL: &str = r#"
name = "pendulum"
units = { length = "mm", angle = "deg" }
hardpoints = { pivot = [0, 0, 500] }
joints.hinge = { type = "revolute", bodies = ["ground", "arm"], at = "pivot", axis = "y" }
drivers.turn = { joint = "hinge", law = "t" }
time = { end = 1.0, steps = 2 }
[bodies.arm]
frame = { position = [100, 0, 500], euler = [90, 0, 0] }
"#;

fn page_of(mesh: &str) -> Payload {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("arm.obj"), "v 100 0 500\nv 110 0 500\nv 100 0 530\nf 1 2 3\n")
        .unwrap();
    let path = folder.path().join("pendulum.toml");
    std::fs::write(&path, format!("{MODEL}mesh = {mesh}\n")).unwrap();
    let file = hardpoint_file::read(&path).unwrap();
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.run();
    let course = Course::of(&file.model, &solution);
    let summary = Summary::new(&file, &analysis, &course);
    payload(&Request::of(&file, &analysis, &course, &summary))
}

#[test]
fn a_mesh_is_in_the_frame_of_its_body_and_in_the_unit_of_the_page() {
    for (mesh, expected) in [
        ("\"arm.obj\"", [0.0, 0.0, 0.0, 0.0, -10.0, 0.0, 0.0, 0.0, 30.0]),
        (
            "{ file = \"arm.obj\", frame = \"body\", scale = 0.5 }",
            [50.0, 0.0, 250.0, 55.0, 0.0, 250.0, 50.0, 0.0, 265.0],
        ),
    ] {
        let page = page_of(mesh);
        assert!(page.bodies[0].mesh.is_none());
        let mesh = page.bodies[1].mesh.as_ref().unwrap();
        assert_eq!((mesh.file.as_str(), mesh.triangles.values()), ("arm.obj", &[0.0, 1.0, 2.0][..]));
        let found = mesh.positions.values();
        let off = found.iter().zip(expected).map(|(x, e): (&f32, f64)| (f64::from(*x) - e).abs());
        assert!(found.len() == 9 && off.fold(0.0, f64::max) < 1e-4, "{found:?}");
    }
}
