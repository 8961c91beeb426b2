//! Output of real exporters of URDF, SDFormat and MJCF, beyond the examples of their documents.

use hardpoint::model::{BodyId, Joint};
use hardpoint::space::{Mat3, Vec3};
use hardpoint::{Analysis, Run};
use hardpoint_file::ModelFile;
use hardpoint_import::{ElementOutcome, ImportedModel};

use crate::{folder, model};

/// Tolerance of sums of sixteen digits.
const SAME: f64 = 1e-12;

fn read_with(name: &str, bytes: &[u8], beside: &[(&str, &str)]) -> (ImportedModel, ModelFile) {
    let resolve =
        |path: &str| beside.iter().find(|(p, _)| *p == path).map(|(_, text)| text.as_bytes().to_vec());
    let imported = hardpoint_import::import(bytes, name, &resolve).unwrap_or_else(|e| panic!("{name}:\n{e}"));
    assert!(imported.fault.is_none(), "{name}: {}\n{}", imported.fault.unwrap(), imported.text);
    let file = model(&imported);
    (imported, file)
}

fn read(name: &str, text: &str) -> (ImportedModel, ModelFile) {
    read_with(name, text.as_bytes(), &[])
}

fn refused(name: &str, text: &str) -> String {
    hardpoint_import::import(text.as_bytes(), name, &|_| None).unwrap_err().to_string()
}

fn joint<'m>(file: &'m ModelFile, name: &str) -> &'m Joint {
    let named = file.model.named_joints().find(|(_, j)| j.name == name);
    named.unwrap_or_else(|| panic!("there is no joint `{name}`")).1
}

fn place(file: &ModelFile, name: &str) -> Vec3 {
    file.model.hardpoints[joint(file, name).at[0].0].position
}

fn is_at(at: Vec3, wanted: [f64; 3]) {
    assert!((at - Vec3::from(wanted)).norm() < SAME, "{at:?} instead of {wanted:?}");
}

fn kinds(file: &ModelFile) -> Vec<(&str, &str)> {
    file.model.named_joints().map(|(_, j)| (j.name.as_str(), j.kind.name)).collect()
}

fn reported(imported: &ImportedModel, fate: ElementOutcome, kind: &str) -> Vec<String> {
    imported.report.of(fate).filter(|e| e.kind == kind).map(|e| format!("{}: {}", e.name, e.why)).collect()
}

/// Maximum rotation of a body while the mechanism moves; it has to move to the end.
fn turns(file: &ModelFile, body: &str) -> f64 {
    let body = BodyId(file.model.bodies.iter().position(|b| b.name == body).unwrap());
    let solution = Analysis::new(&file.model).unwrap().solve(Run::new().without_sensitivities());
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    let x = |k: usize| solution.body(k, body).rotation.cols;
    let off = |k: usize| (0..3).map(|c| x(k)[c].cross(x(0)[c]).norm()).fold(0.0, f64::max);
    (0..solution.motion.len()).map(off).fold(0.0, f64::max)
}

const ARM: &str = r#"<robot name="arm">
  <link name="base"/><link name="upper"/><link name="tool"/>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="upper"/><origin xyz="0 0 1"/><axis xyz="0 1 0"/>
    <limit lower="-inf" upper="inf" effort="1" velocity="1"/><dynamics damping="1"/>
  </joint>
  <joint name="flange" type="fixed">
    <parent link="upper"/><child link="tool"/><origin xyz="0 0 0.5" rpy="0 0 0"/><axis xyz="0 0 0"/>
  </joint>
</robot>"#;

#[test]
fn texts_are_read_however_exporters_write_them() {
    let (plain, file) = read("arm.urdf", ARM);
    is_at(place(&file, "flange"), [0.0, 0.0, 1.5]);
    assert_eq!(reported(&plain, ElementOutcome::Taken, "spring").len(), 1);
    let remark = "<!-- ==== -- an arm -- ==== -->";
    let utf16: Vec<u8> = format!("\u{feff}{ARM}").encode_utf16().flat_map(u16::to_le_bytes).collect();
    let ways: [(&str, Vec<u8>); 7] = [
        ("a blank line before the declaration", format!("\n<?xml version=\"1.0\"?>\n{ARM}").into_bytes()),
        (
            "a remark before it",
            format!("{remark}<?xml version=\"1.0\" encoding=\"utf-8\"?>{ARM}").into_bytes(),
        ),
        (
            "a remark with dashes",
            ARM.replace("<link name=\"upper\"/>", &format!("<link name=\"upper\"/>{remark}")).into(),
        ),
        (
            "a prefix that nothing declares",
            ARM.replace("</robot>", "<gazebo><controller:motor rate:hz=\"3\"/></gazebo></robot>").into(),
        ),
        ("lines that end as on Windows", ARM.replace('\n', "\r\n").into()),
        ("a byte order mark", format!("\u{feff}{ARM}").into()),
        ("two bytes for each letter", utf16),
    ];
    for (what, bytes) in ways {
        let (_, other) = read_with("arm.urdf", &bytes, &[]);
        assert_eq!(kinds(&file), kinds(&other), "{what}");
        is_at(place(&other, "flange"), [0.0, 0.0, 1.5]);
    }
    // Undeclared macros are detected, and positions refer to the text as written.
    let macros = ARM.replace("<link name=\"tool\"/>", "<xacro:leg side=\"left\"/>");
    assert!(refused("arm.urdf", &macros).contains("HP0805"));
    let wrong = ARM.replace("xyz=\"0 0 1\"", "xyz=\"0 0 one\"");
    assert!(refused("arm.urdf", &format!("{remark}\n{wrong}")).contains("arm.urdf:5:"), "{wrong}");
    // Invalid numbers remain errors.
    assert!(refused("arm.urdf", &ARM.replace("xyz=\"0 0 1\"", "xyz=\"0 0 nan\"")).contains("HP0804"));
    assert!(
        refused("arm.urdf", &ARM.replace("name=\"flange\"", "name=\"shoulder\""))
            .contains("is defined twice")
    );
}

/// Plate of 2 by 1 mm as two triangles, and a second one as a square, rotated upright and shifted by 3 mm; the file is
/// in mm.
const PLATES: &str = r##"<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit name="millimeter" meter="0.001"/><up_axis>Y_UP</up_axis></asset>
  <library_geometries><geometry id="plate"><mesh>
    <source id="at"><float_array id="a" count="12">0 0 0 2 0 0 2 1 0 0 1 0</float_array>
      <technique_common><accessor source="#a" count="4" stride="3"/></technique_common></source>
    <vertices id="corners"><input semantic="POSITION" source="#at"/></vertices>
    <triangles count="2"><input semantic="VERTEX" source="#corners" offset="0"/><input semantic="NORMAL" source="#n" offset="1"/><p>0 0 1 0 2 0 0 0 2 0 3 0</p></triangles>
  </mesh></geometry>
  <geometry id="square"><mesh>
    <source id="at2"><float_array id="a2" count="12">0 0 0 2 0 0 2 1 0 0 1 0</float_array></source>
    <vertices id="corners2"><input semantic="POSITION" source="#at2"/></vertices>
    <polylist count="1"><input semantic="VERTEX" source="#corners2" offset="0"/><vcount>4</vcount><p>0 1 2 3</p></polylist>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="s">
    <node><instance_geometry url="#plate"/></node>
    <node><matrix>1 0 0 0  0 0 -1 0  0 1 0 3  0 0 0 1</matrix><instance_geometry url="#square"/></node>
  </visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#s"/></scene></COLLADA>"##;

#[test]
fn meshes_in_collada_are_shown_in_metres_in_the_frame_of_the_link() {
    let shape = r#"<link name="upper"><visual><geometry><mesh filename="package://arm/meshes/plates.dae" scale="2 2 2"/></geometry></visual></link>"#;
    let text = ARM.replace("<link name=\"upper\"/>", shape);
    let (imported, file) = read_with("arm.urdf", text.as_bytes(), &[("meshes/plates.dae", PLATES)]);
    assert_eq!(reported(&imported, ElementOutcome::Taken, "mesh").len(), 1);
    let upper = file.model.bodies.iter().position(|b| b.name == "upper").unwrap();
    let drawing = &file.drawing.bodies[&upper];
    assert_eq!(drawing.triangles.len(), 4);
    let most = |k: usize| drawing.vertices.iter().map(|v| v[k]).fold(f64::NEG_INFINITY, f64::max);
    // Files of triangles have single precision.
    for (k, wanted) in [0.004, 0.002, 0.008].into_iter().enumerate() {
        assert!((most(k) - wanted).abs() < 1e-8, "{k}: {}", most(k));
    }
    let (imported, _) = read_with("arm.urdf", text.as_bytes(), &[("meshes/plates.dae", "<COLLADA/>")]);
    let why = reported(&imported, ElementOutcome::Refused, "mesh");
    assert!(why.len() == 1 && why[0].contains("it has no triangles"), "{why:?}");
}

/// Four-bar with an open last joint: a crank of 0.1, a coupler of 0.3, a rocker of 0.2 upright at x = 0.3.
const OPEN: &str = r#"<robot name="loop">
  <link name="base"/><link name="crank"/><link name="coupler"/><link name="rocker"/>
  <joint name="A" type="continuous"><parent link="base"/><child link="crank"/><axis xyz="0 1 0"/></joint>
  <joint name="B" type="continuous"><parent link="crank"/><child link="coupler"/><origin xyz="0 0 0.1"/><axis xyz="0 1 0"/></joint>
  <joint name="D" type="continuous"><parent link="base"/><child link="rocker"/><origin xyz="0.3 0 0"/><axis xyz="0 1 0"/></joint>
  LOOP
</robot>"#;

#[test]
fn loops_of_every_program_close() {
    let loops = [
        r#"<loop_joint name="C" type="continuous"><link1 link="coupler" xyz="0.3 0 0.1"/><link2 link="rocker" xyz="0 0 0.2"/><axis xyz="0 1 0"/></loop_joint>"#,
        // Notation of Isaac Sim.
        r#"<loop_joint name="C" type="spherical"><link1 link="coupler" rpy="0 0 0" xyz="0.3 0 0.1"/><link1 link="rocker" rpy="0 0 0" xyz="0 0 0.2"/></loop_joint>"#,
        r#"<loop_joint name="C" type="revolute"><parent link="coupler"/><child link="rocker"/><parent_origin xyz="0.3 0 0.1"/><child_origin xyz="0 0 0.2"/><axis xyz="0 1 0" frame="parent"/></loop_joint>"#,
        r#"<loop_joint name="C" type="revolute"><link1 link="coupler"/><link2 link="rocker"/><parent_origin xyz="0.3 0 0.1"/><child_origin xyz="0 0 0.2"/><axis xyz="0 1 0"/></loop_joint>"#,
        // An end without an origin is at its link.
        r#"<loop_joint name="C" type="revolute"><link1 link="coupler"/><link2 link="rocker" xyz="0 0 0.2"/><parent_origin xyz="0.3 0 0.1"/><axis xyz="0 1 0"/></loop_joint>"#,
        r#"<drake:ball_constraint xmlns:drake="http://drake.mit.edu"><drake:ball_constraint_body_A name="coupler"/><drake:ball_constraint_body_B name="rocker"/><drake:ball_constraint_p_AP value="0.3 0 0.1"/><drake:ball_constraint_p_BQ value="0 0 0.2"/></drake:ball_constraint>"#,
        r#"<gazebo><joint name="C" type="revolute"><pose>0 0 0.2 0 0 0</pose><parent>coupler</parent><child>rocker</child><axis><xyz>0 1 0</xyz></axis></joint></gazebo>"#,
        // Frames of onshape-to-robot.
        r#"<link name="closing_C_1"/><link name="closing_C_2"/>
           <joint name="C_1" type="fixed"><parent link="coupler"/><child link="closing_C_1"/><origin xyz="0.3 0 0.1"/></joint>
           <joint name="C_2" type="fixed"><parent link="rocker"/><child link="closing_C_2"/><origin xyz="0 0 0.2"/></joint>"#,
    ];
    for text in loops {
        let (imported, file) = read("loop.urdf", &OPEN.replace("LOOP", text));
        assert_eq!(file.model.drivers.len(), 1, "{text}\n{}", imported.report);
        assert!(turns(&file, "rocker") > 0.01, "{text}");
    }
    let none = OPEN.replace("LOOP", &loops[4].replace("0 1 0", "0 0 0"));
    assert!(refused("loop.urdf", &none).contains("the axis has no direction"));
    let bushing = "<drake:linear_bushing_rpy xmlns:drake=\"http://drake.mit.edu\"/>";
    let (imported, _) = read("loop.urdf", &OPEN.replace("LOOP", bushing));
    assert_eq!(reported(&imported, ElementOutcome::Refused, "linear_bushing_rpy").len(), 1);
}

#[test]
fn floating_links_are_constrained_by_loops_or_fixed() {
    let floats = r#"<link name="lid"/><joint name="free" type="floating"><parent link="base"/><child link="lid"/><origin xyz="0 0 0.1"/></joint>"#;
    let (imported, file) = read("loop.urdf", &OPEN.replace("LOOP", floats));
    assert_eq!(joint(&file, "free").kind.name, "fixed", "{}", imported.report);
    let held = format!(
        "{floats}<loop_joint name=\"E\" type=\"revolute\"><link1 link=\"crank\" xyz=\"0 0 0.1\"/><link2 link=\"lid\"/><axis xyz=\"0 1 0\"/></loop_joint>"
    );
    let (_, file) = read("loop.urdf", &OPEN.replace("LOOP", &held));
    assert!(file.model.named_joints().all(|(_, j)| j.name != "free"));
    assert_eq!(joint(&file, "E").kind.name, "revolute");
}

#[test]
fn plugins_define_mimic_joints_and_limits_are_relative_to_the_design_configuration() {
    let plugin = r#"<gazebo><plugin filename="libgazebo_mimic_joint_plugin.so" name="m">
        <joint>A</joint><mimicJoint>D</mimicJoint><multiplier>-2</multiplier><offset>0.25</offset></plugin></gazebo>"#;
    let (imported, file) = read("loop.urdf", &OPEN.replace("LOOP", plugin));
    assert_eq!(file.model.couplers.len(), 1);
    assert_eq!(reported(&imported, ElementOutcome::Taken, "mimic").len(), 1);
    // The offset is part of the design configuration.
    let rocker = file.model.bodies.iter().find(|b| b.name == "rocker").unwrap();
    assert!((rocker.frame.rot.cols[0] - Vec3::new(0.25_f64.cos(), 0.0, -(0.25_f64.sin()))).norm() < SAME);
    // A fixed joint cannot be a mimic joint.
    let fixed = r#"<link name="lid"/><joint name="F" type="fixed"><parent link="base"/><child link="lid"/><mimic joint="A"/></joint>"#;
    let (imported, _) = read("loop.urdf", &OPEN.replace("LOOP", fixed));
    assert_eq!(reported(&imported, ElementOutcome::Refused, "mimic").len(), 1);
}

/// A right angle with five digits, a frequent approximation.
const ROUNDED: &str = r#"<?xml version="1.0"?>
<sdf version="1.6"><model name="four_bar">
  <link name="base"/>
  <link name="crank"><pose>0 0 0 1.5708 0.3 0</pose></link>
  <link name="coupler"><pose>0.1 0 0.2 1.5708 0 0.00001</pose></link>
  <link name="rocker"><pose>0.5 0 0 -1.5708 0 0</pose></link>
  <joint name="foot" type="fixed"><parent>world</parent><child>base</child></joint>
  <joint name="A" type="revolute"><parent>base</parent><child>crank</child><axis><xyz>0 0 1</xyz></axis></joint>
  <joint name="B" type="revolute"><parent>crank</parent><child>coupler</child><axis><xyz>0 0 1</xyz></axis></joint>
  <joint name="C" type="revolute"><pose>0.3 0.1 0 0 0 0</pose><parent>coupler</parent><child>rocker</child>
    <axis><xyz>0 1 0</xyz><use_parent_model_frame>1</use_parent_model_frame></axis></joint>
  <joint name="D" type="revolute"><parent>base</parent><child>rocker</child><axis><xyz>0 0 1</xyz></axis></joint>
</model></sdf>"#;

#[test]
fn a_loop_whose_axes_are_rounded_moves_all_the_same() {
    let (imported, file) = read("four_bar.sdf", ROUNDED);
    assert_eq!(file.model.drivers.len(), 1);
    assert!(turns(&file, "rocker") > 0.01);
    let axes = reported(&imported, ElementOutcome::Approximated, "axes");
    assert!(
        axes.len() == 1 && axes[0].contains("1.1e-5 rad") && axes[0].contains("`A`, `B`, `D`"),
        "{axes:?}"
    );
    // A chain is not modified.
    let chain = ROUNDED
        .replace("<joint name=\"D\"", "<joint name=\"E\"")
        .replace("<parent>base</parent><child>rocker", "<parent>world</parent><child>base");
    let (imported, _) = read("chain.sdf", &chain);
    assert!(reported(&imported, ElementOutcome::Approximated, "axes").is_empty());
}

#[test]
fn axes_of_sdf_count_from_the_joint_since_version_1_5_whatever_the_digits() {
    let text = |version: &str| {
        format!(
            r#"<sdf version="{version}"><model name="m"><link name="a"><pose>0 0 0 0 0 0</pose></link>
            <link name="b"><pose>0 0 1 0 1.5707963267948966 0</pose></link>
            <joint name="j" type="prismatic"><parent>a</parent><child>b</child><axis><xyz>1 0 0</xyz></axis></joint></model></sdf>"#
        )
    };
    for (version, axis) in [("1.4", [1.0, 0.0, 0.0]), ("1.5", [0.0, 0.0, -1.0]), ("1.10", [0.0, 0.0, -1.0])] {
        let (_, file) = read("m.sdf", &text(version));
        is_at(joint(&file, "j").frames[0].cols[2], axis);
    }
}

const NESTED: &str = r#"<sdf version="1.10" xmlns:drake="http://drake.mit.edu"><world name="w">
  <frame name="bench"><pose>0 0 1 0 0 0</pose></frame>
  <model name="stand"><static>true</static><pose relative_to="bench">1 0 0 0 0 0</pose>
    <link name="post"/>
    <model name="arm"><pose relative_to="top">0 0 0.5 0 0 0</pose><link name="rod"/></model>
    <frame name="top" attached_to="post"><pose>0 0 2 0 0 0</pose></frame>
  </model>
  <model name="cart" placement_frame="hitch"><pose relative_to="bench">5 0 0 0 0 0</pose>
    <link name="frame"/><link name="wheel"><pose>0 1 0 0 0 0</pose>
      <visual name="v"><pose rotation_format="quat_xyzw">0 0 0.25 0 0 0 1</pose><geometry><box><size>0.5 0.5 0.5</size></box></geometry></visual></link>
    <frame name="hitch"><pose>2 0 0 0 0 0</pose></frame>
    <joint name="axle" type="revolute"><parent>frame</parent><child>wheel</child><axis><xyz>0 1 0</xyz></axis></joint>
    <joint name="slide" type="prismatic"><parent>world</parent><child>frame</child><axis><xyz>1 0 0</xyz>
      <drake:mimic joint="axle" multiplier="0.3" offset="0"/></axis></joint>
  </model>
  <model name="cart"><link name="frame"/></model>
  <include merge="true"><uri>model://lamp</uri><pose>7 0 0 0 0 0</pose></include>
  <joint name="bolt" type="fixed"><parent>stand::arm</parent><child>bulb</child></joint>
</world></sdf>"#;
const LAMP: &str = r#"<sdf version="1.9"><model name="lamp"><link name="bulb"><pose>0 0 0.5 0 0 0</pose></link></model></sdf>"#;

#[test]
fn sdf_frames_have_the_poses_of_gazebo() {
    let config = "<model><sdf version=\"1.4\">old.sdf</sdf><sdf version=\"1.9\">lamp.sdf</sdf></model>";
    let beside = [("lamp/model.config", config), ("lamp/lamp.sdf", LAMP)];
    let (imported, file) = read_with("w.sdf", NESTED.as_bytes(), &beside);
    let assert_at = |name: &str, at: [f64; 3]| {
        is_at(
            file.model.bodies.iter().find(|b| b.name == name).unwrap_or_else(|| panic!("no {name}")).frame.r,
            at,
        );
    };
    assert_at("stand::post", [1.0, 0.0, 1.0]);
    assert_at("stand::arm::rod", [1.0, 0.0, 3.5]);
    assert_at("cart::frame", [3.0, 0.0, 1.0]);
    assert_at("cart::wheel", [3.0, 1.0, 1.0]);
    // Names are made unique.
    assert_at("cart_2::frame", [0.0, 0.0, 0.0]);
    assert_at("bulb", [7.0, 0.0, 0.5]);
    // A joint of the world on the body that carries the frame of a model.
    let bolted = joint(&file, "bolt").bodies.map(|b| file.model.bodies[b.0].name.as_str());
    assert_eq!(bolted, ["stand::arm::rod", "bulb"]);
    let mimic = &file.model.couplers[0].terms;
    assert_eq!([mimic[0].coefficient, mimic[1].coefficient], [1.0, -0.3]);
    let wheel = file.model.bodies.iter().position(|b| b.name == "cart::wheel").unwrap();
    let low = file.drawing.bodies[&wheel].vertices.iter().map(|v| v.z).fold(f64::INFINITY, f64::min);
    assert!(low.abs() < 1e-8, "{low}");
    assert_eq!(reported(&imported, ElementOutcome::Taken, "frame").len(), 3);
    assert!(imported.report.of(ElementOutcome::Refused).next().is_none(), "{}", imported.report);
}

/// Model of a base and a tool at y = 0.2 that a hinge connects.
fn hinged(parent: &str, axis: &str) -> String {
    format!(
        r#"<link name="base"/><link name="tool"><pose>0 0.2 0 0 0 0</pose></link>
        <joint name="j" type="revolute"><parent>{parent}</parent><child>tool</child><axis>{axis}</axis></joint>"#
    )
}

fn names_of<'m>(file: &'m ModelFile, joint_name: &str) -> [&'m str; 2] {
    joint(file, joint_name).bodies.map(|b| file.model.bodies[b.0].name.as_str())
}

#[test]
fn the_model_frame_of_sdf_is_that_of_the_model_around_the_reference() {
    let turned = "<pose>10 0 0 1.5707963267948966 0 0</pose>";
    let axis = r#"<xyz expressed_in="__model__">0 0 1</xyz>"#;
    let content = hinged("__model__", axis);
    let foot = r#"<joint name="foot" type="fixed"><parent>world</parent><child>base</child></joint>"#;
    // The only model of a file, in a world or not.
    let model = format!(r#"<model name="arm">{turned}{content}{foot}</model>"#);
    for text in [model.clone(), format!(r#"<world name="w">{model}</world>"#)] {
        let (_, file) = read("m.sdf", &format!(r#"<sdf version="1.9">{text}</sdf>"#));
        is_at(joint(&file, "j").frames[0].cols[2], [0.0, -1.0, 0.0]);
        assert_eq!(names_of(&file, "j"), ["base", "tool"]);
    }
    // The frame of a merged model is one of the model that includes it, under another name.
    let part = format!(r#"<sdf version="1.9"><model name="arm">{content}</model></sdf>"#);
    let include = format!(r#"<include merge="true"><uri>part</uri>{turned}</include>"#);
    let rod = r#"<link name="rod"><pose relative_to="_merged__arm__model__">0 0 1 0 0 0</pose></link>"#;
    let held =
        r#"<joint name="f" type="fixed"><parent>_merged__arm__model__</parent><child>rod</child></joint>"#;
    let text = format!(r#"<sdf version="1.11"><model name="m">{include}{rod}{held}{foot}</model></sdf>"#);
    let (_, file) = read_with("m.sdf", text.as_bytes(), &[("part/model.sdf", &part)]);
    is_at(joint(&file, "j").frames[0].cols[2], [0.0, -1.0, 0.0]);
    assert_eq!((names_of(&file, "j"), names_of(&file, "f")), (["base", "tool"], ["base", "rod"]));
    is_at(file.model.bodies.iter().find(|b| b.name == "rod").unwrap().frame.r, [10.0, -1.0, 0.0]);
    // Frames of the world are on ground.
    let world = format!(
        r#"<sdf version="1.10"><world name="w"><frame name="mount"><pose>1 0 2 0 0 0</pose></frame>
        <model name="arm"><pose>1 0 2 0 0 0</pose>{}<frame name="mount" attached_to="tool"/></model>
        <joint name="turn" type="revolute"><parent>mount</parent><child>arm::base</child><axis><xyz>0 0 1</xyz></axis></joint></world></sdf>"#,
        hinged("base", "<xyz>0 0 1</xyz>")
    );
    let (_, file) = read("w.sdf", &world);
    assert_eq!(names_of(&file, "turn"), ["ground", "arm::base"]);
}

#[test]
fn frames_of_sdf_that_place_their_model_do_so_in_any_order() {
    let joint = r#"<joint name="j" type="revolute"><pose relative_to="base">0.5 0 0 0 0 0</pose><parent>base</parent><child>tool</child>
        <axis><xyz>0 0 1</xyz></axis></joint>"#;
    let tool = r#"<link name="tool"><pose relative_to="j">0 0.2 0 0 0 0</pose></link>"#;
    for content in [format!("{joint}{tool}"), format!("{tool}{joint}")] {
        let text = format!(
            r#"<sdf version="1.9"><model name="arm" placement_frame="grip"><pose>10 0 0 0 0 0</pose><link name="base"/>{content}
            <frame name="grip" attached_to="base"><pose>0 0 1 0 0 0</pose></frame></model></sdf>"#
        );
        let (_, file) = read("m.sdf", &text);
        is_at(place(&file, "j"), [10.5, 0.0, -1.0]);
        is_at(file.model.bodies.iter().find(|b| b.name == "tool").unwrap().frame.r, [10.5, 0.2, -1.0]);
    }
}

#[test]
fn meshes_of_mjcf_may_be_in_the_text() {
    let model = |mesh: &str| {
        format!(
            r#"<mujoco><compiler angle="radian"/><asset><mesh name="m" {mesh}/></asset><worldbody><body name="p" pos="0 0 1"><joint axis="0 1 1"/>
            <geom type="mesh" mesh="m" pos="0.1 0.2 0.3" euler="0.3 0.2 0.1"/></body></worldbody></mujoco>"#
        )
    };
    let corners = "0 0 0 1 0 0 0 1 0 0 0 1";
    let tetrahedron = format!(r#"vertex="{corners}""#);
    let inside = format!(r#"vertex="{corners} 0.1 0.1 0.1""#);
    let open = format!(r#"vertex="{corners}" face="0 2 1 0 1 3 0 3 2""#);
    let moved = format!(r#"vertex="{corners}" scale="0.1 0.1 0.2" refpos="0.1 0 0" refquat="0.7 0.7 0 0""#);
    // MuJoCo 4.0.0, printed with eight digits
    let plain = [
        [0.1, 0.2, 0.3],
        [1.075_170_33, 0.353_791_98, 0.140_654_93],
        [0.002_156_59, 1.144_702_51, 0.612_991_82],
        [0.298_669_34, -0.089_629_49, 1.236_293_35],
    ];
    let scaled = [
        [0.090_248_30, 0.198_462_08, 0.301_593_45],
        [0.187_765_33, 0.213_841_28, 0.285_658_94],
        [0.050_514_43, 0.256_387_98, 0.114_334_78],
        [0.080_463_95, 0.292_932_33, 0.332_892_63],
    ];
    for (mesh, points, triangles) in
        [(&tetrahedron, plain, 4), (&inside, plain, 4), (&open, plain, 3), (&moved, scaled, 4)]
    {
        let (imported, file) = read("m.xml", &model(mesh));
        assert_eq!(reported(&imported, ElementOutcome::Taken, "mesh").len(), 1, "{}", imported.report);
        let number = file.model.bodies.iter().position(|b| b.name == "p").unwrap();
        let shape = &file.drawing.bodies[&number];
        assert_eq!(shape.triangles.len(), triangles, "{mesh}");
        for wanted in points {
            // STL has seven digits.
            let nearest = |v: &Vec3| (*v - Vec3::from(wanted)).norm();
            let off = shape.vertices.iter().map(nearest).fold(f64::INFINITY, f64::min);
            assert!(off < 2e-7, "{mesh}: {wanted:?} is off by {off}: {:?}", shape.vertices);
        }
    }
    let many: String = (0..101).map(|k| format!("{k} {} {} ", k * k, k * k * k)).collect();
    for (mesh, why) in [
        (r#"vertex="0 0 0 1 0 0 0 1 0""#.to_owned(), "at least four points"),
        (r#"vertex="0 0 0 1 0 0 0 1 0 1 1 0""#.to_owned(), "in one plane"),
        (format!(r#"vertex="{corners}" face="0 1 4""#), "numbers of vertices"),
        (format!(r#"vertex="{many}""#), "list its triangles in `face`"),
        (r#"builtin="sphere""#.to_owned(), "neither a file nor vertices"),
    ] {
        let (imported, _) = read("m.xml", &model(&mesh));
        let found = reported(&imported, ElementOutcome::Refused, "mesh");
        assert!(found.len() == 1 && found[0].contains(why) && found[0].contains("`m`"), "{found:?}");
    }
}

#[test]
fn joints_of_mjcf_in_frames_and_classes_and_includes_are_found() {
    let text = r#"<mujoco><compiler angle="radian"/><include file="parts/all.xml"/>
      <default><default class="slider"><joint type="slide" axis="1 0 0" range="-inf inf"/></default></default>
      <worldbody><body name="b"><frame pos="0 0 2" euler="0 0 1.5707963267948966" childclass="slider"><joint name="j"/></frame>
        <body name="c" childclass="slider"><joint type="ball"/><body name="d" pos="0 0 1"><joint type="ball" name="k"/><geom size="1"/></body></body>
      </body></worldbody></mujoco>"#;
    let beside = [
        ("parts/all.xml", "<mujocoinclude><include file=\"more.xml\"/></mujocoinclude>"),
        ("parts/more.xml", "<mujocoinclude><worldbody><body name=\"e\"/></worldbody></mujocoinclude>"),
    ];
    let (imported, file) = read_with("m.xml", text.as_bytes(), &beside);
    is_at(joint(&file, "j").frames[0].cols[2], [0.0, 1.0, 0.0]);
    assert_eq!(joint(&file, "j").kind.name, "translational");
    assert_eq!(reported(&imported, ElementOutcome::Taken, "include").len(), 2);
    assert!(file.model.bodies.iter().any(|b| b.name == "e"));
    // Both ball joints are fixed in all angles, including the spin of the body between them.
    assert_eq!(reported(&imported, ElementOutcome::Approximated, "motion").len(), 7, "{}", imported.report);
    assert!(
        refused(
            "m.xml",
            &text
                .replace("childclass=\"slider\"><joint type", "childclass=\"slide\"><joint type")
                .replace("<include file=\"parts/all.xml\"/>", "")
        )
        .contains("did you mean `slider`?")
    );
    let twice = text.replace("name=\"k\"", "name=\"j\"").replace("<include file=\"parts/all.xml\"/>", "");
    assert!(refused("m.xml", &twice).contains("the joint `j` is defined twice"));
}

#[test]
fn equalities_of_mjcf_hold_free_bodies_make_hinges_and_rods() {
    let text = r#"<mujoco><worldbody>
        <site name="p" pos="0 0 1"/>
        <body name="plate"><freejoint/><geom type="box" size="1 1 1"/><site name="q" pos="0.5 0 0"/></body>
        <body name="box" pos="9 0 0"><freejoint name="loose"/><geom type="sphere" size="1"/></body>
      </worldbody>
      <tendon><spatial name="rope"><site site="p"/><site site="q"/></spatial></tendon>
      <equality><connect name="a" body1="plate" anchor="0 0 0"/><connect name="b" body1="plate" anchor="0 0.5 0"/>
        <tendon name="rod" tendon1="rope"/></equality></mujoco>"#;
    let (imported, file) = read("m.xml", text);
    assert_eq!(
        kinds(&file),
        [("rod", "distance"), ("a", "revolute"), ("loose", "fixed")],
        "{}",
        imported.report
    );
    is_at(joint(&file, "a").frames[0].cols[2], [0.0, 1.0, 0.0]);
    // Without the rod, the plate oscillates.
    let (_, file) = read("m.xml", &text.replace("<tendon name=\"rod\" tendon1=\"rope\"/>", ""));
    assert!(turns(&file, "plate") > 0.1);
    // A single connect is a ball joint.
    let (_, file) =
        read("m.xml", &text.replace("<connect name=\"b\" body1=\"plate\" anchor=\"0 0.5 0\"/>", ""));
    assert_eq!(joint(&file, "a").kind.name, "spherical");
}

/// Limits of a model: name, minimum and maximum, SI.
type Limits = Vec<(String, Option<f64>, Option<f64>)>;

fn limits(file: &ModelFile) -> Limits {
    file.model.joint_limits.iter().map(|limit| (limit.name.clone(), limit.min, limit.max)).collect()
}

fn assert_limits(found: &Limits, expected: &[(&str, Option<f64>, Option<f64>)]) {
    let names: Vec<&str> = found.iter().map(|limit| limit.0.as_str()).collect();
    assert_eq!(names, expected.iter().map(|limit| limit.0).collect::<Vec<_>>());
    let is_same = |a: Option<f64>, b: Option<f64>| match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() <= SAME,
        (a, b) => a == b,
    };
    for (found, expected) in found.iter().zip(expected) {
        assert!(is_same(found.1, expected.1) && is_same(found.2, expected.2), "{found:?} {expected:?}");
    }
}

#[test]
fn limits_of_joints_are_relative_to_the_design_configuration_in_every_format() {
    let urdf = r#"<robot name="arm"><link name="base"/><link name="upper"/><link name="lower"/><link name="tip"/><link name="wheel"/>
        <joint name="A" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/>
          <limit lower="-0.5" upper="1.25" effort="1" velocity="1"/></joint>
        <joint name="B" type="prismatic"><parent link="upper"/><child link="lower"/><origin xyz="0.2 0 0"/><axis xyz="1 0 0"/>
          <limit upper="0.3" effort="1" velocity="1"/></joint>
        <joint name="C" type="revolute"><parent link="lower"/><child link="tip"/><origin xyz="0.2 0 0"/><axis xyz="0 1 0"/>
          <limit lower="-1" upper="2" effort="1" velocity="1"/><mimic joint="A" multiplier="2" offset="0.25"/></joint>
        <joint name="D" type="continuous"><parent link="tip"/><child link="wheel"/><origin xyz="0.1 0 0"/><axis xyz="0 1 0"/>
          <limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"#;
    let (imported, file) = read("arm.urdf", urdf);
    let expected = [
        ("A.angle", Some(-0.5), Some(1.25)),
        ("B.displacement", Some(0.0), Some(0.3)),
        ("C.angle", Some(-1.25), Some(1.75)),
    ];
    assert_limits(&limits(&file), &expected);
    assert!(imported.text.contains("limits = { angle = { min = -0.5, max = 1.25 } }"), "{}", imported.text);

    let sdf = r#"<sdf version="1.9"><model name="arm"><link name="a"/><link name="b"/><link name="c"/>
        <joint name="foot" type="fixed"><parent>world</parent><child>a</child></joint>
        <joint name="A" type="revolute"><parent>a</parent><child>b</child><axis><xyz>0 1 0</xyz>
          <limit><lower>-0.5</lower><upper>1e16</upper></limit></axis></joint>
        <joint name="U" type="universal"><parent>b</parent><child>c</child>
          <axis><xyz>1 0 0</xyz><limit><lower>-0.3</lower><upper>0.4</upper></limit></axis>
          <axis2><xyz>0 1 0</xyz><limit><upper>0.6</upper></limit></axis2></joint></model></sdf>"#;
    let (_, file) = read("arm.sdf", sdf);
    let expected =
        [("A.angle", Some(-0.5), None), ("U.angle", Some(-0.3), Some(0.4)), ("U.angle2", None, Some(0.6))];
    assert_limits(&limits(&file), &expected);

    let mjcf = r#"<mujoco><compiler angle="degree" autolimits="true"/><worldbody><body name="a">
        <joint name="A" type="hinge" axis="0 1 0" range="-30 60" ref="10"/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
        <body name="b" pos="0 0 1"><joint name="B" type="slide" axis="0 0 1" range="-0.1 0.2"/>
          <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
          <body name="c" pos="0 0 1"><joint name="C" type="ball" range="0 45"/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
            <body name="d" pos="0 0 1"><joint name="D" type="hinge" axis="0 1 0" limited="false" range="-1 1"/>
              <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body></body></body></body></worldbody></mujoco>"#;
    let (_, file) = read("arm.xml", mjcf);
    let expected = [
        ("A.angle", Some(-40_f64.to_radians()), Some(50_f64.to_radians())),
        ("B.displacement", Some(-0.1), Some(0.2)),
        ("C.articulation", None, Some(45_f64.to_radians())),
    ];
    assert_limits(&limits(&file), &expected);
}

#[test]
fn a_range_whose_lower_end_is_not_below_its_upper_one_is_reported() {
    let link = |name: &str| format!(r#"<link name="{name}"/>"#);
    let joint = |k: usize, limit: &str| {
        format!(
            r#"<joint name="j{k}" type="revolute"><parent link="l{k}"/><child link="l{}"/><axis xyz="0 1 0"/>
            <limit {limit} effort="1" velocity="1"/></joint>"#,
            k + 1
        )
    };
    // A missing end is 0 in URDF, and a limit with neither has none.
    let of_urdf =
        [r#"lower="1" upper="-1""#, r#"lower="0.3" upper="0.3""#, r#"lower="0.1""#, r#"upper="-0.1""#, ""];
    let links: String = (0..6).map(|k| link(&format!("l{k}"))).collect();
    let joints: String = of_urdf.iter().enumerate().map(|(k, limit)| joint(k, limit)).collect();
    let urdf = format!(r#"<robot name="r">{links}{joints}</robot>"#);
    let sdf = r#"<sdf version="1.9"><model name="m"><link name="a"/><link name="b"/><link name="c"/>
        <joint name="w" type="fixed"><parent>world</parent><child>a</child></joint>
        <joint name="j" type="revolute"><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz>
          <limit><lower>1</lower><upper>-1</upper></limit></axis></joint>
        <joint name="u" type="universal"><parent>b</parent><child>c</child><axis><xyz>1 0 0</xyz></axis>
          <axis2><xyz>0 1 0</xyz><limit><lower>0.2</lower><upper>0.2</upper></limit></axis2></joint></model></sdf>"#;
    let body = |name: &str, joint: &str, inner: &str| {
        format!(
            r#"<body name="{name}"><joint name="{name}" {joint}/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>{inner}</body>"#
        )
    };
    let inner = body("d", r#"type="ball" range="0 0""#, "");
    let inner = body("c", r#"type="ball" limited="true" range="0 0""#, &inner);
    let inner = body("b", r#"range="0 0""#, &inner);
    let mjcf = format!("<mujoco><worldbody>{}</worldbody></mujoco>", body("a", r#"range="2 -1""#, &inner));
    let cases: [(&str, &str, &str, &[&str]); 3] = [
        ("r.urdf", &urdf, "limit", &["j0", "j1", "j2", "j3"]),
        ("m.sdf", sdf, "limit", &["j", "u"]),
        ("m.xml", &mjcf, "range", &["a", "c"]),
    ];
    for (name, text, kind, expected) in cases {
        let (imported, file) = read(name, text);
        let reported = reported(&imported, ElementOutcome::Refused, kind);
        let expected: Vec<String> = expected
            .iter()
            .map(|joint| {
                format!("{joint}: its lower end is not below its upper end: the joint gets no limit")
            })
            .collect();
        assert_eq!(reported, expected, "{name}: {}", imported.report);
        assert_eq!(limits(&file), [], "{name}");
    }

    let document = std::fs::read_to_string(folder().join("freecad/vise/Document.xml")).unwrap();
    let imported = |document: &str| {
        hardpoint_import::import(&crate::document(document.as_bytes()), "vise.FCStd", &|_| None).unwrap()
    };
    let of_limits = |imported: &ImportedModel, fate| reported(imported, fate, "limits").len();
    let own = imported(&document);
    assert_eq!([ElementOutcome::Taken, ElementOutcome::Refused].map(|fate| of_limits(&own, fate)), [1, 0]);
    let least = r#"<Property name="EnableLengthMin" type="x"><Bool value="true"/></Property>
        <Property name="LengthMin" type="x"><Float value="1000"/></Property>"#;
    let property = r#"<Property name="EnableLengthMax""#;
    let reversed = imported(&document.replace(property, &format!("{least}{property}")));
    assert_eq!(
        [ElementOutcome::Taken, ElementOutcome::Refused].map(|fate| of_limits(&reversed, fate)),
        [0, 1],
        "{}",
        reversed.report
    );
}

#[test]
fn axes_of_revolute2_are_those_of_two_hinges_in_series() {
    let text = |kind: &str, second: &str| {
        format!(
            r#"<sdf version="1.9"><model name="m"><link name="a"/><link name="b"><pose>1 0 0 0 0 0</pose></link>
            <joint name="w" type="fixed"><parent>world</parent><child>a</child></joint>
            <joint name="j" type="{kind}"><parent>a</parent><child>b</child>
            <axis><xyz>0 0 1</xyz><limit><lower>-0.5</lower><upper>0.6</upper></limit></axis>
            <axis2><xyz>{second}</xyz><limit><upper>0.7</upper></limit>
            <dynamics><damping>2</damping></dynamics></axis2></joint></model></sdf>"#
        )
    };
    let (imported, _) = read("m.sdf", &text("revolute2", "0 1 0"));
    assert!(imported.text.contains("universal"), "{}", imported.text);
    for second in ["0 1 0.3", "0 0 1"] {
        let (imported, file) = read("m.sdf", &text("revolute2", second));
        let hinges = kinds(&file).into_iter().filter(|(name, _)| name.starts_with("j_"));
        assert_eq!(
            hinges.collect::<Vec<_>>(),
            [("j_i", "revolute"), ("j_j", "revolute")],
            "{}",
            imported.text
        );
        for fate in [ElementOutcome::Approximated, ElementOutcome::Refused] {
            assert_eq!(reported(&imported, fate, "joint").len(), 0, "{}", imported.report);
        }
        let expected = [("j_i.angle", Some(-0.5), Some(0.6)), ("j_j.angle", None, Some(0.7))];
        assert_limits(&limits(&file), &expected);
        assert_eq!(reported(&imported, ElementOutcome::Taken, "spring"), ["j: "], "{}", imported.report);
        // A = A(axis, q1) A(axis2, q2); at q1 = q2 = 0 the link has its pose in the file.
        let axis: Vec<f64> = second.split(' ').map(|x| x.parse().unwrap()).collect();
        let axis2 = Vec3::from([axis[0], axis[1], axis[2]]).unit().unwrap();
        for turns in [[0.0, 0.0], [0.3, 0.2]] {
            let expected = Mat3::about([0.0, 0.0, 1.0].into(), turns[0]) * Mat3::about(axis2, turns[1]);
            let text = driven(&imported.text, turns);
            let file = hardpoint_file::parse(&text, "m.toml").unwrap_or_else(|e| panic!("{e}\n{text}"));
            let solution = Analysis::new(&file.model).unwrap().solve(Run::new().without_sensitivities());
            let body = BodyId(file.model.bodies.iter().position(|b| b.name == "b").unwrap());
            let state = solution.body(0, body);
            assert!(state.rotation.angle_to(expected) < SAME, "{second}, {turns:?}: {state:?}");
            assert!((state.r - Vec3::from([1.0, 0.0, 0.0])).norm() < SAME, "{second}, {turns:?}: {state:?}");
        }
    }
}

/// Text of an imported model whose two drivers have constant laws.
fn driven(text: &str, laws: [f64; 2]) -> String {
    let mut document: toml_edit::DocumentMut = text.parse().unwrap();
    let drivers = document["drivers"].as_table_like_mut().unwrap();
    for (joint, law) in ["j_i", "j_j"].into_iter().zip(laws) {
        let mut of_joint = drivers.iter_mut().filter(|(_, driver)| driver["joint"].as_str() == Some(joint));
        of_joint.next().unwrap().1["law"] = toml_edit::value(law);
    }
    document.to_string()
}

/// A tetrahedron of edges 1 along the axes, whose triangles are seen from outside.
const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// The volume that the shape of a body encloses, m^3: positive if its triangles are seen from outside.
fn volume(file: &ModelFile, body: &str) -> f64 {
    let body = file.model.bodies.iter().position(|b| b.name == body).unwrap();
    let shape = &file.drawing.bodies[&body];
    let corners = |t: &[u32; 3]| t.map(|k| shape.vertices[k as usize]);
    shape.triangles.iter().map(corners).map(|[a, b, c]| a.cross(b).dot(c) / 6.0).sum()
}

#[test]
fn mirrored_meshes_are_seen_from_outside_in_every_format() {
    let urdf = |uri: &str, scale: &str| {
        let shape = format!(
            r#"<link name="upper"><visual><geometry><mesh filename="{uri}" {scale}/></geometry></visual></link>"#
        );
        ARM.replace("<link name=\"upper\"/>", &shape)
    };
    let sdf = r#"<sdf version="1.9"><model name="m"><link name="upper"><visual name="v"><geometry><mesh><uri>t.obj</uri><scale>1 1 -1</scale></mesh></geometry></visual></link>
        <joint name="j" type="revolute"><parent>world</parent><child>upper</child><axis><xyz>0 1 0</xyz></axis></joint></model></sdf>"#;
    let mjcf = |mesh: &str| {
        format!(
            r#"<mujoco><asset><mesh name="t" {mesh}/></asset><worldbody><body name="upper"><joint axis="0 1 0"/><geom type="mesh" mesh="t"/></body></worldbody></mujoco>"#
        )
    };
    let dae = r##"<COLLADA><library_geometries><geometry id="t"><mesh><source id="at"><float_array>0 0 0 1 0 0 0 1 0 0 0 1</float_array></source>
        <vertices id="corners"><input semantic="POSITION" source="#at"/></vertices>
        <triangles><input semantic="VERTEX" source="#corners" offset="0"/><p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles></mesh></geometry></library_geometries>
        <library_visual_scenes><visual_scene><node><scale>-1 1 1</scale><instance_geometry url="#t"/></node></visual_scene></library_visual_scenes></COLLADA>"##;
    for (name, text) in [
        ("arm.urdf", urdf("t.obj", "")),
        ("arm.urdf", urdf("t.obj", r#"scale="1 -1 1""#)),
        ("arm.urdf", urdf("t.obj", r#"scale="-1 -1 -1""#)),
        ("arm.urdf", urdf("t.dae", "")),
        ("arm.urdf", urdf("t.dae", r#"scale="1 1 -1""#)),
        ("m.sdf", sdf.to_owned()),
        ("m.xml", mjcf(r#"file="t.obj" scale="-1 1 1""#)),
        ("m.xml", mjcf(r#"vertex="0 0 0 1 0 0 0 1 0 0 0 1" scale="1 1 -1""#)),
    ] {
        let (_, file) = read_with(name, text.as_bytes(), &[("t.obj", TETRAHEDRON), ("t.dae", dae)]);
        let found = volume(&file, "upper");
        assert!((found - 1.0 / 6.0).abs() < 1e-7, "{found}: {text}");
    }
}

#[test]
fn a_screw_of_sdf_without_a_pitch_has_that_of_sdformat() {
    let screw = |pitch: &str| {
        format!(
            r#"<sdf version="1.10"><model name="m"><link name="a"/><link name="b"/><joint name="j" type="screw"><parent>a</parent><child>b</child>{pitch}<axis><xyz>0 0 1</xyz></axis></joint></model></sdf>"#
        )
    };
    let (imported, _) = read("m.sdf", &screw(""));
    let listed = reported(&imported, ElementOutcome::Approximated, "screw_thread_pitch");
    assert!(listed.len() == 1 && listed[0].contains("1 m per turn"), "{listed:?}");
    let (same, _) = read("m.sdf", &screw("<screw_thread_pitch>1</screw_thread_pitch>"));
    assert!(same.text.contains("lead = ") && imported.text == same.text, "{}", imported.text);
    assert!(
        refused("m.sdf", &screw("<thread_pitch>0</thread_pitch>"))
            .contains("the pitch of the screw `j` is zero")
    );
}

#[test]
fn a_joint_cannot_follow_itself() {
    let urdf = ARM.replace("</joint>\n</robot>", "</joint></robot>");
    let urdf = urdf.replacen("</joint>", r#"<mimic joint="shoulder"/></joint>"#, 1);
    let sdf = r#"<sdf version="1.11"><model name="m"><link name="a"/><joint name="shoulder" type="revolute"><parent>world</parent><child>a</child>
        <axis><xyz>0 0 1</xyz><mimic joint="shoulder"><multiplier>2</multiplier></mimic></axis></joint></model></sdf>"#;
    for (name, text) in [("arm.urdf", urdf.as_str()), ("m.sdf", sdf)] {
        let message = refused(name, text);
        assert!(
            message.contains("`shoulder` follows itself") && message.contains("use another joint"),
            "{message}"
        );
    }
}

#[test]
fn more_undriven_motions_than_are_fixed_are_reported_with_their_limit() {
    let joints: String = (0..401)
        .map(|k| {
            format!(
                r#"<link name="l{k}"/><joint name="j{k}" type="continuous"><parent link="base"/><child link="l{k}"/><origin xyz="{k} 0 0"/><axis xyz="0 1 0"/></joint>"#
            )
        })
        .collect();
    let text = format!(r#"<robot name="r"><link name="base"/>{joints}</robot>"#);
    let imported = hardpoint_import::import(text.as_bytes(), "r.urdf", &|_| None).unwrap();
    let fault = imported.fault.unwrap().to_string();
    assert!(fault.contains("401 motions are undriven; at most 400 are fixed"), "{fault}");
}
