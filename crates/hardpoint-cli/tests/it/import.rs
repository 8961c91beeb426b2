//! `hardpoint import`, from the command line.

use assert_cmd::Command;

const ROBOT: &str = r#"<robot name="door">
  <link name="frame"/><link name="leaf"><visual><geometry><box size="0.8 0.04 2"/></geometry></visual></link>
  <joint name="hinge" type="revolute">
    <parent link="frame"/><child link="leaf"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="1.5" effort="1" velocity="1"/>
  </joint>
</robot>"#;

fn hardpoint(folder: &std::path::Path) -> Command {
    let mut command = Command::cargo_bin("hardpoint").unwrap();
    command.current_dir(folder);
    command
}

fn with(name: &str, text: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(name), text).unwrap();
    folder
}

#[test]
fn an_imported_model_passes_check_and_has_its_shapes_next_to_it() {
    let folder = with("door.urdf", ROBOT);
    let out =
        hardpoint(folder.path()).args(["import", "door.urdf", "-o", "models/door.toml"]).assert().success();
    insta::with_settings!({ prepend_module_to_snapshot => false, snapshot_path => "../snapshots" }, {
        insta::assert_snapshot!("import", String::from_utf8_lossy(&out.get_output().stdout));
    });
    assert!(folder.path().join("models/door_meshes/leaf.stl").exists());
    hardpoint(folder.path()).args(["check", "models/door.toml"]).assert().success();
}

#[test]
fn as_json_an_import_is_one_document() {
    let folder = with("door.urdf", ROBOT);
    let out = hardpoint(folder.path())
        .args(["import", "door.urdf", "-o", "door.toml", "--json"])
        .assert()
        .success();
    let document: serde_json::Value = serde_json::from_slice(&out.get_output().stdout).unwrap();
    assert_eq!(document["status"], "complete");
    assert_eq!(document["files"][0], "door_meshes/leaf.stl");
    let entries = document["report"]["entries"].as_array().unwrap();
    let hinge = entries.iter().find(|e| e["kind"] == "joint").unwrap();
    assert_eq!(
        (&hinge["fate"], &hinge["name"], &hinge["place"]["line"]),
        (&"taken".into(), &"hinge".into(), &3.into())
    );
}

#[test]
fn a_broken_source_is_reported_with_its_position_and_writes_nothing() {
    let folder = with("door.urdf", &ROBOT.replace("child link=\"leaf\"", "child link=\"leef\""));
    let out = hardpoint(folder.path()).args(["import", "door.urdf", "-o", "door.toml"]).assert().code(3);
    let output = String::from_utf8_lossy(&out.get_output().stderr).into_owned();
    assert!(
        output.contains("HP0803") && output.contains("door.urdf:4:40") && output.contains("`leaf`"),
        "{output}"
    );
    assert!(!folder.path().join("door.toml").exists());
    let out = hardpoint(folder.path()).args(["import", "none.urdf", "-o", "door.toml"]).assert().code(3);
    assert!(String::from_utf8_lossy(&out.get_output().stderr).contains("HP0809"));
}

#[test]
fn the_formats_are_listed_and_an_unknown_one_is_named() {
    let folder = with("door.urdf", ROBOT);
    let out = hardpoint(folder.path()).args(["import", "--list"]).assert().success();
    let list = String::from_utf8_lossy(&out.get_output().stdout).into_owned();
    assert!(["asmt", "adams", "urdf", "sdf", "mjcf", "lotus"].iter().all(|f| list.contains(f)), "{list}");
    let args = ["import", "door.urdf", "-o", "door.toml", "--format", "urd"];
    let out = hardpoint(folder.path()).args(args).assert().code(2);
    assert!(String::from_utf8_lossy(&out.get_output().stderr).contains("there are asmt, adams"));
    hardpoint(folder.path()).args(["import", "door.urdf"]).assert().code(2);
}

#[test]
fn an_exported_model_is_imported_again_and_unsupported_features_are_listed() {
    let folder = with("door.urdf", ROBOT);
    hardpoint(folder.path()).args(["import", "door.urdf", "-o", "door.toml"]).assert().success();
    let out = hardpoint(folder.path()).args(["export", "door.toml", "-o", "again.urdf"]).assert().success();
    let output = String::from_utf8_lossy(&out.get_output().stdout).into_owned();
    assert!(output.contains("driver `hinge_input`: URDF does not support motions"), "{output}");
    hardpoint(folder.path()).args(["import", "again.urdf", "-o", "again.toml"]).assert().success();
    let out = hardpoint(folder.path()).args(["export", "door.toml", "-o", "door.step"]).assert().code(2);
    assert!(String::from_utf8_lossy(&out.get_output().stderr).contains("csv, teimorbit, urdf, mjcf"));
}

/// A four-bar whose loop an element of another program closes.
const OPEN: &str = r#"<robot name="fourbar"><link name="base"/><link name="crank"/><link name="coupler"/><link name="rocker"/>
<joint name="A" type="continuous"><parent link="base"/><child link="crank"/><axis xyz="0 0 1"/></joint>
<joint name="B" type="continuous"><origin xyz="0 1 0"/><parent link="crank"/><child link="coupler"/><axis xyz="0 0 1"/></joint>
<joint name="D" type="continuous"><origin xyz="2 0 0"/><parent link="base"/><child link="rocker"/><axis xyz="0 0 1"/></joint>
<loop><frame1>coupler</frame1><frame2>rocker</frame2></loop></robot>"#;

#[test]
fn an_open_loop_is_reported_first_and_closed_on_request() {
    let folder = with("open.urdf", OPEN);
    let run = |arguments: &[&str]| {
        let arguments = [&["import", "open.urdf", "-o", "open.toml"], arguments].concat();
        hardpoint(folder.path()).args(arguments).assert()
    };
    let out = run(&[]).success();
    let output = String::from_utf8_lossy(&out.get_output().stdout).into_owned();
    let first: Vec<&str> = output.lines().take(4).collect();
    assert!(
        first[1].contains("`--close coupler=rocker`")
            && first[2].contains("fixed in the design configuration"),
        "{output}"
    );
    assert!(first[3].contains("not understood"), "{output}");
    let out = run(&["--json"]).success();
    let document: serde_json::Value = serde_json::from_slice(&out.get_output().stdout).unwrap();
    assert_eq!(document["report"]["remarks"].as_array().unwrap().len(), 2);
    let entries = document["report"]["entries"].as_array().unwrap();
    assert!(entries.iter().any(|e| e["fate"] == "not_understood" && e["kind"] == "loop"), "{document}");
    let out = run(&["--close", "coupler@2,0,0=rocker@0,1,0"]).success();
    let output = String::from_utf8_lossy(&out.get_output().stdout).into_owned();
    assert!(output.contains("1, prescribed by 1 driver") && output.contains("101 of 101 steps"), "{output}");
    // Frames that cannot meet are an error: the minimum distance to the crank's end is one metre.
    let out = run(&["--close", "coupler=rocker"]).code(5);
    let output = String::from_utf8_lossy(&out.get_output().stderr).into_owned();
    assert!(output.contains("HP0406") && output.contains("`coupler_rocker`"), "{output}");
    run(&["--close", "coupler"]).code(2);
    run(&["--close", "coupler=nowhere"]).code(3);
}

#[test]
fn shapes_of_other_models_and_of_the_source_are_kept() {
    let folder = with("door.urdf", ROBOT);
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    let run = |source: &str, output: &str| {
        hardpoint(folder.path()).args(["import", source, "-o", output]).assert().success();
    };
    run("door.urdf", "one.toml");
    let first = read("one_meshes/leaf.stl");
    // Another robot of the same name, in its own folder.
    std::fs::create_dir(folder.path().join("other")).unwrap();
    std::fs::write(folder.path().join("other/door.urdf"), ROBOT.replace("0.8 0.04 2", "1 2 3")).unwrap();
    run("other/door.urdf", "two.toml");
    assert_eq!(read("one_meshes/leaf.stl"), first);
    assert_ne!(read("two_meshes/leaf.stl"), first);
    // Files of the same model are replaced.
    run("other/door.urdf", "one.toml");
    assert_eq!(read("one_meshes/leaf.stl"), read("two_meshes/leaf.stl"));
    // A mesh of the source is kept, also by the next import.
    std::fs::create_dir(folder.path().join("arm_meshes")).unwrap();
    std::fs::write(folder.path().join("arm_meshes/leaf.stl"), &first).unwrap();
    let shape = r#"<mesh filename="arm_meshes/leaf.stl" scale="2 2 2"/>"#;
    let text = ROBOT.replace(r#"<box size="0.8 0.04 2"/>"#, shape);
    std::fs::write(folder.path().join("arm.urdf"), text).unwrap();
    for _ in 0..2 {
        run("arm.urdf", "arm.toml");
        assert_eq!(read("arm_meshes/leaf.stl"), first);
        assert!(String::from_utf8_lossy(&read("arm.toml")).contains("\"arm_meshes_2/leaf.stl\""));
        assert!(!folder.path().join("arm_meshes_3").exists());
    }
}

#[test]
fn a_model_that_needs_corrections_ends_with_the_exit_code_of_its_check() {
    let points = "hardpoints:\n  left:\n    lower_wishbone_outboard: {x: 5, y: 760, z: 170}\n\
                  \x20   upper_wishbone_outboard: {x: -15, y: 720, z: 440}\nunits: millimeters\ntype: double_wishbone\n";
    // A triangle of two parts on ground, of which both are driven.
    let driven = "over\nUNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=MILLIMETER, TIME=SECOND\nPART/1, GROUND\nMARKER/1, PART=1\n\
                  PART/2\nMARKER/2, PART=2\nMARKER/3, PART=2, QP=100,0,0\nPART/3, QG=100,0,0\nMARKER/4, PART=3\n\
                  MARKER/5, PART=1, QP=200,0,0\nMARKER/6, PART=3, QP=100,0,0\nJOINT/1, REVOLUTE, I=2, J=1\n\
                  JOINT/2, REVOLUTE, I=4, J=3\nJOINT/3, REVOLUTE, I=6, J=5\nMOTION/1, JOINT=1, ROTATIONAL, FUNCTION=TIME\n\
                  MOTION/2, JOINT=3, ROTATIONAL, FUNCTION=TIME\nEND\n";
    for (name, text, code, exit) in [("points.yaml", points, "HP0807", 3), ("over.adm", driven, "HP03", 4)] {
        let folder = with(name, text);
        let out = hardpoint(folder.path()).args(["import", name, "-o", "m.toml"]).assert().code(exit);
        let output = String::from_utf8_lossy(&out.get_output().stderr).into_owned();
        assert!(output.contains(code) && output.contains("written anyway"), "{output}");
        hardpoint(folder.path()).args(["check", "m.toml"]).assert().code(exit);
    }
}
