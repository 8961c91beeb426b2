//! Frames of welds, constants of relations, extensions, loops closed by the user, masses and springs: comparison of
//! values.

use std::f64::consts::PI;

use hardpoint::model::BodyId;
use hardpoint::space::{Mat3, Pose, Quat};
use hardpoint::{Analysis, Run};
use hardpoint_file::ModelFile;
use hardpoint_import::{Closing, ElementOutcome, ImportedModel, Options};

/// Residual of a solved position, m or rad.
const SAME: f64 = 1e-9;

fn read_with(name: &str, text: &str, closings: &[&str]) -> (ImportedModel, ModelFile) {
    let closings: Vec<Closing> = closings.iter().map(|c| c.parse().unwrap()).collect();
    let options = Options { closings, ..Options::default() };
    let imported = hardpoint_import::import_with(&options, text.as_bytes(), name, &|_| None)
        .unwrap_or_else(|e| panic!("{name}:\n{e}"));
    assert!(imported.fault.is_none(), "{name}: {}\n{}", imported.fault.unwrap(), imported.text);
    let file = crate::model(&imported);
    (imported, file)
}

fn read(name: &str, text: &str) -> (ImportedModel, ModelFile) {
    read_with(name, text, &[])
}

/// Poses of bodies at all output times.
fn poses(file: &ModelFile, names: &[&str]) -> Vec<Vec<Pose>> {
    let solution = Analysis::new(&file.model).unwrap().solve(Run::new().without_sensitivities());
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    let of = |k: usize, name: &&str| {
        let body = BodyId(file.model.bodies.iter().position(|b| b.name == **name).unwrap());
        solution.body(k, body).pose()
    };
    (0..solution.motion.len()).map(|k| names.iter().map(|n| of(k, n)).collect()).collect()
}

/// Returns the largest distance of a frame of one body from a frame of the other.
fn off(poses: &[Vec<Pose>], [a, b]: [Pose; 2]) -> f64 {
    let apart = |p: &Vec<Pose>| {
        let [a, b] = [p[0].compose(a), p[1].compose(b)];
        (a.r - b.r).norm().max(a.rot.angle_to(b.rot))
    };
    poses.iter().map(apart).fold(0.0, f64::max)
}

fn pose(r: [f64; 3], q: [f64; 4]) -> Pose {
    Pose { rot: Quat::from_array(q).unwrap().rotation(), r: r.into() }
}

fn at(r: [f64; 3]) -> Pose {
    pose(r, [1.0, 0.0, 0.0, 0.0])
}

/// Angle of one body relative to another about y, rad.
fn about_y([a, b]: [&Pose; 2]) -> f64 {
    let r = a.rot.transpose() * b.rot;
    r.cols[2].x.atan2(r.cols[2].z)
}

/// Four-bar that `equality` closes, with another body.
fn linkage(tool: &str, equality: &str) -> String {
    format!(
        r#"<mujoco model="m"><worldbody>
<body name="crank"><joint name="A" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 0 0 1" size=".02"/>
 <body name="coupler" pos="0 0 1"><joint name="B" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 2 0 0" size=".02"/><site name="s1" pos="2 0 0" euler="0 20 10"/></body></body>
<body name="rocker" pos="2 0 0"><joint name="D" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 0 0 1" size=".02"/><site name="s2" pos="0 0 1"/></body>
{tool}
</worldbody>
<equality>{equality}</equality></mujoco>"#
    )
}

/// Body with six joints that a weld constrains.
const CARRIED: &str = r#"<body name="tool" pos="0 0 3"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/><joint type="slide"/>
 <joint axis="1 0 0"/><joint axis="0 1 0"/><joint/><geom size=".1"/><site name="s3" pos="0 0 0.1" euler="30 0 0"/></body>"#;
const FREE: &str = r#"<body name="tool" pos="0 0 3"><freejoint/><geom size=".1"/><site name="s3" pos="0 0 0.1" euler="30 0 0"/></body>"#;

#[test]
fn a_weld_holds_the_frames_that_it_names() {
    let site_1 = Pose {
        rot: Mat3::about([0.0, 1.0, 0.0].into(), PI / 9.0) * Mat3::about([0.0, 0.0, 1.0].into(), PI / 18.0),
        r: [2.0, 0.0, 0.0].into(),
    };
    // `euler` is x, y', z'': of 0, 20 and 10 degrees that is a turn about y and then z.
    let site_3 = Pose { rot: Mat3::about([1.0, 0.0, 0.0].into(), PI / 6.0), r: [0.0, 0.0, 0.1].into() };
    let connect = r#"<connect body1="rocker" body2="coupler" anchor="0 0 1"/>"#;
    let turned = [0.9, 0.1, -0.2, 0.3];
    let welds: [(&str, &str, [Pose; 2]); 5] = [
        ("coupler", r#"<weld site1="s1" site2="s3"/>"#, [site_1, site_3]),
        (
            "rocker",
            r#"<weld body1="rocker" body2="tool" relpose="0 0 1 1 0 0 0"/>"#,
            [at([0.0, 0.0, 1.0]), at([0.0; 3])],
        ),
        (
            "rocker",
            r#"<weld body1="rocker" body2="tool" relpose="0.1 0.2 1 0.9 0.1 -0.2 0.3"/>"#,
            [pose([0.1, 0.2, 1.0], turned), at([0.0; 3])],
        ),
        // Half a turn, without a unique smallest rotation.
        (
            "rocker",
            r#"<weld body1="rocker" body2="tool" relpose="0 0 1 0 1 0 0"/>"#,
            [pose([0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0]), at([0.0; 3])],
        ),
        // Without an orientation it is the pose in the design configuration, wherever the first three numbers are.
        (
            "rocker",
            r#"<weld body1="rocker" body2="tool" relpose="0 1 0 0 0 0 0"/>"#,
            [at([-2.0, 0.0, 3.0]), at([0.0; 3])],
        ),
    ];
    for (on, weld, frames) in welds {
        for tool in [FREE, CARRIED] {
            for order in [format!("{connect}{weld}"), format!("{weld}{connect}")] {
                let (imported, file) = read("m.xml", &linkage(tool, &order));
                let poses = poses(&file, &[on, "tool"]);
                let off = off(&poses, frames);
                assert!(off < SAME, "{weld} is off by {off}\n{}", imported.report);
                // The linkage moves.
                let first = poses
                    .iter()
                    .map(|p| (p[0].r - poses[0][0].r).norm() + p[0].rot.angle_to(poses[0][0].rot));
                assert!(first.fold(0.0, f64::max) > 0.1, "{weld}");
            }
        }
    }
}

#[test]
fn points_that_lie_apart_are_brought_together() {
    let text = linkage("", r#"<connect site1="s1" site2="s2"/>"#)
        .replace(r#"name="s2" pos="0 0 1""#, r#"name="s2" pos="0 0 1.2""#);
    let (_, file) = read("m.xml", &text);
    let poses = poses(&file, &["coupler", "rocker"]);
    for p in poses {
        let [a, b] = [p[0].point([2.0, 0.0, 0.0].into()), p[1].point([0.0, 0.0, 1.2].into())];
        assert!((a - b).norm() < SAME, "{a:?} {b:?}");
    }
}

#[test]
fn constants_of_relations_count() {
    // Constant of a single joint relative to ground.
    let (_, file) = read("m.xml", &linkage("", r#"<joint joint1="D" polycoef="0.3 0 0 0 0"/>"#));
    for p in poses(&file, &["crank", "rocker"]) {
        let upright = at([0.0; 3]);
        assert!((about_y([&upright, &p[1]]) - 0.3).abs() < SAME);
    }
    // Constants of two joints and of tendons, with a factor: D = 0.25 - 0.5 A.
    let relations = [
        r#"<joint joint1="D" joint2="A" polycoef="0.25 -0.5 0 0 0"/>"#,
        r#"<tendon tendon1="d" tendon2="a" polycoef="0.25 -0.5 0 0 0"/>"#,
        // 2 D + A = 0.5
        r#"<tendon tendon1="both" polycoef="0.5 0 0 0 0"/>"#,
    ];
    let tendons = r#"<tendon><fixed name="a"><joint joint="A" coef="1"/></fixed><fixed name="d"><joint joint="D" coef="1"/></fixed>
        <fixed name="both"><joint joint="D" coef="2"/><joint joint="A" coef="1"/></fixed></tendon></mujoco>"#;
    for relation in relations {
        let (imported, file) = read("m.xml", &linkage("", relation).replace("</mujoco>", tendons));
        assert_eq!(
            imported
                .report
                .of(ElementOutcome::Approximated)
                .filter(|e| ["joint", "tendon"].contains(&e.kind.as_str()))
                .count(),
            0
        );
        for p in poses(&file, &["crank", "rocker"]) {
            let upright = at([0.0; 3]);
            let [a, d] = [0, 1].map(|k| about_y([&upright, &p[k]]));
            assert!((d - (0.25 - 0.5 * a)).abs() < SAME, "{relation}: {a} {d}");
        }
    }
    // The constant of a rod between two sites is added to its length.
    let rod = r#"<spatial name="rod"><site site="s1"/><site site="s2"/></spatial>"#;
    let text = linkage("", r#"<tendon tendon1="rod" polycoef="0.3 0 0 0 0"/>"#)
        .replace("</mujoco>", &format!("<tendon>{rod}</tendon></mujoco>"))
        .replace(r#"name="s2" pos="0 0 1""#, r#"name="s2" pos="0 0 1.5""#);
    let (_, file) = read("m.xml", &text);
    for p in poses(&file, &["coupler", "rocker"]) {
        let [a, b] = [p[0].point([2.0, 0.0, 0.0].into()), p[1].point([0.0, 0.0, 1.5].into())];
        assert!(((a - b).norm() - 0.8).abs() < SAME, "{}", (a - b).norm());
    }
}

#[test]
fn equalities_are_inactive_by_the_default_of_equalities() {
    let model = |defaults: &str, equality: &str| {
        format!(
            r#"<mujoco><default><joint axis="0 1 0" active="false"/>{defaults}</default><worldbody><body name="a"><joint name="j"/>
            <inertial pos="0.5 0 0" mass="2"/></body><body name="b" pos="0 1 0"><joint name="k"/><inertial pos="0.5 0 0" mass="2"/></body></worldbody>
            <tendon><fixed name="s"><joint joint="j" coef="1"/></fixed><fixed name="t"><joint joint="k" coef="1"/></fixed></tendon>
            <equality>{equality}</equality></mujoco>"#
        )
    };
    // The default of joints is another one.
    let inactive = r#"<equality active="false"/>"#;
    for relation in
        [r#"<joint name="e" joint1="k" joint2="j"/>"#, r#"<tendon name="e" tendon1="s" tendon2="t"/>"#]
    {
        let own = relation.replace("name", r#"active="true" name"#);
        for (defaults, equality, is_active) in
            [(inactive, relation, false), (inactive, &own, true), ("", relation, true)]
        {
            let text = model(defaults, equality);
            let imported = hardpoint_import::import(text.as_bytes(), "m.xml", &|_| None).unwrap();
            let refused = imported.report.of(ElementOutcome::Refused);
            let refused = refused.filter(|e| e.name == "e" && e.why == "it is not active").count();
            assert_eq!(refused, usize::from(!is_active), "{text}\n{}", imported.report);
            assert_eq!(imported.text.contains("[couplers"), is_active, "{text}\n{}", imported.text);
        }
    }
}

/// Two hinges about y, one of which is a mimic joint.
const SDF: &str = r#"<sdf version="1.11"><model name="m">
<link name="a"/><link name="b"><pose>1 0 0 0 0 0</pose></link>PLUGIN
<joint name="g" type="revolute"><parent>world</parent><child>a</child><axis><xyz>0 1 0</xyz></axis></joint>
<joint name="j" type="revolute"><parent>a</parent><child>b</child><axis><xyz>0 1 0</xyz>MIMIC</axis></joint>
</model></sdf>"#;
const URDF: &str = r#"<robot name="m"><link name="world"/><link name="a"/><link name="b"/>PLUGIN
<joint name="g" type="continuous"><parent link="world"/><child link="a"/><axis xyz="0 1 0"/></joint>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/><origin xyz="1 0 0"/><axis xyz="0 1 0"/>MIMIC</joint></robot>"#;

#[test]
fn joints_follow_others_however_that_is_written() {
    let plugin = r#"<plugin name="p" filename="libroboticsgroup_gazebo_mimic_joint_plugin.so"><joint>g</joint><mimicJoint>j</mimicJoint>
        <multiplier>-2</multiplier><offset>0.1</offset></plugin>"#;
    let control = r#"<ros2_control name="c" type="system"><joint name="j"><param name="mimic">g</param><param name="multiplier">-2</param>
        <param name="offset">0.1</param></joint></ros2_control>"#;
    let block =
        r#"<mujoco><equality><joint joint1="j" joint2="g" polycoef="0.1 -2 0 0 0"/></equality></mujoco>"#;
    let gazebo = format!("<gazebo>{plugin}</gazebo>");
    let ways = [
        // (leader - reference) multiplier + offset
        (
            "m.sdf",
            SDF,
            "",
            r#"<mimic joint="g"><multiplier>-2</multiplier><offset>0.1</offset><reference>0</reference></mimic>"#,
        ),
        (
            "m.sdf",
            SDF,
            "",
            r#"<mimic joint="g"><multiplier>-2</multiplier><offset>0.5</offset><reference>-0.2</reference></mimic>"#,
        ),
        ("m.sdf", SDF, plugin, ""),
        ("m.sdf", SDF, block, ""),
        ("m.urdf", URDF, "", r#"<mimic joint="g" multiplier="-2" offset="0.1"/>"#),
        ("m.urdf", URDF, &gazebo, ""),
        ("m.urdf", URDF, control, ""),
        ("m.urdf", URDF, block, ""),
    ];
    for (name, text, plugin, mimic) in ways {
        let text = text.replace("PLUGIN", plugin).replace("MIMIC", mimic);
        let (imported, file) = read(name, &text);
        assert_eq!(file.model.couplers.len(), 1, "{text}");
        assert_eq!(imported.report.of(ElementOutcome::NotUnderstood).count(), 0, "{}", imported.report);
        let poses = poses(&file, &["a", "b"]);
        let upright = at([0.0; 3]);
        let mut most: f64 = 0.0;
        for p in &poses {
            let [g, j] = [about_y([&upright, &p[0]]), about_y([&p[0], &p[1]])];
            // 0.5 - 2 (g + 0.2) is the same.
            assert!((j - (0.1 - 2.0 * g)).abs() < SAME, "{text}: {g} {j}");
            most = most.max(g.abs());
        }
        assert!(most > 0.05, "{text}");
    }
}

const FOUR_BAR: &str = r#"<robot name="fourbar"><link name="base"/><link name="crank"/><link name="coupler"/><link name="rocker"/>FRAMES
<joint name="A" type="continuous"><parent link="base"/><child link="crank"/><axis xyz="0 0 1"/></joint>
<joint name="B" type="continuous"><origin xyz="0 1 0"/><parent link="crank"/><child link="coupler"/><axis xyz="0 0 1"/></joint>
<joint name="D" type="continuous"><origin xyz="2 0 0"/><parent link="base"/><child link="rocker"/><axis xyz="0 0 1"/></joint>
CLOSED</robot>"#;

fn meets(file: &ModelFile) {
    for p in poses(file, &["coupler", "rocker"]) {
        let [a, b] = [p[0].point([2.0, 0.0, 0.0].into()), p[1].point([0.0, 1.0, 0.0].into())];
        assert!((a - b).norm() < SAME, "{a:?} {b:?}");
    }
}

#[test]
fn loops_of_other_conventions_are_closed_or_named() {
    // Equalities of MuJoCo in a URDF file.
    let block = r#"<mujoco><compiler meshdir="."/><equality><connect body1="coupler" body2="rocker" anchor="2 0 0"/></equality></mujoco>"#;
    let (_, file) = read("r.urdf", &FOUR_BAR.replace("FRAMES", "").replace("CLOSED", block));
    meets(&file);
    // An unknown element that names two links.
    let unknown = "<loop><frame1>coupler</frame1><frame2>rocker</frame2></loop>";
    let text = FOUR_BAR.replace("FRAMES", "").replace("CLOSED", unknown);
    let (imported, _) = read("r.urdf", &text);
    let report = imported.report.to_string();
    let above: Vec<&str> = report.lines().take(3).collect();
    assert!(above[1].contains("`--close coupler=rocker`"), "{report}");
    assert!(
        above[2].contains("all of its 3 motions are fixed in the design configuration")
            && above[2].contains("tree"),
        "{report}"
    );
    for closing in [
        "coupler@2,0,0=rocker@0,1,0",
        "rocker@0,1,0=coupler@2,0,0:revolute",
        "coupler@2,0,0=rocker@0,1,0:revolute:z",
    ] {
        let (imported, file) = read_with("r.urdf", &text, &[closing]);
        meets(&file);
        assert!(
            !imported.report.to_string().contains("fixed in the design configuration"),
            "{}",
            imported.report
        );
    }
    // Frames for a loop: coincident, or with matching names.
    let leaf = |name: &str, on: &str, at: &str| {
        format!(
            r#"<link name="{name}"/><joint name="{name}_fixed" type="fixed"><parent link="{on}"/><child link="{name}"/><origin xyz="{at}"/></joint>"#
        )
    };
    for (first, second, at) in [("tip", "end", "0 1 0"), ("loop_a", "loop_b", "0 1.1 0")] {
        let frames = leaf(first, "coupler", "2 0 0") + &leaf(second, "rocker", at);
        let text = FOUR_BAR.replace("FRAMES", &frames).replace("CLOSED", "");
        let (imported, _) = read("r.urdf", &text);
        let mut pair = [first, second];
        pair.sort_unstable();
        let command = format!("`--close {}={}`", pair[0], pair[1]);
        assert!(imported.report.remarks[0].contains(&command), "{}", imported.report);
        let (_, file) = read_with("r.urdf", &text, &[&format!("{first}={second}")]);
        for p in poses(&file, &[first, second]) {
            assert!((p[0].r - p[1].r).norm() < SAME);
        }
    }
    // A closed loop is not reported.
    let frames = leaf("tip", "coupler", "2 0 0") + &leaf("end", "rocker", "0 1 0");
    let (imported, _) = read("r.urdf", &FOUR_BAR.replace("FRAMES", &frames).replace("CLOSED", block));
    assert!(imported.report.remarks.is_empty(), "{}", imported.report);
    // Likewise sites of MJCF and frames of SDFormat.
    let (imported, _) = read("m.xml", &linkage("", ""));
    assert!(imported.report.remarks[0].contains("`--close s1=s2`"), "{}", imported.report);
    let (_, file) = read_with("m.xml", &linkage("", ""), &["s1=s2"]);
    assert_eq!(file.model.named_joints().filter(|(_, j)| j.kind.name == "spherical").count(), 1);
    let sdf = r#"<sdf version="1.9"><model name="m"><link name="a"/><link name="b"><pose>2 0 0 0 0 0</pose></link>
        <frame name="p" attached_to="a"><pose>0 0 1 0 0 0</pose></frame><frame name="q" attached_to="b"><pose relative_to="p"/></frame>
        <joint name="g" type="revolute"><parent>world</parent><child>a</child><axis><xyz>0 1 0</xyz></axis></joint>
        <joint name="h" type="revolute"><parent>world</parent><child>b</child><axis><xyz>0 1 0</xyz></axis></joint></model></sdf>"#;
    let (imported, _) = read("m.sdf", sdf);
    assert!(imported.report.remarks[0].contains("`--close p=q`"), "{}", imported.report);
}

#[test]
fn closings_are_parsed() {
    let closing = |text: &str| text.parse::<Closing>();
    let read = closing("model::a@0,1,-2.5=b:revolute:x").unwrap();
    assert_eq!(read.frames, ["model::a", "b"].map(String::from));
    assert_eq!((read.places, read.kind, read.axis), ([[0.0, 1.0, -2.5], [0.0; 3]], "revolute", 0));
    assert_eq!(closing("a=b").unwrap().kind, "spherical");
    assert_eq!(closing("m::a=m::b").unwrap().frames[1], "m::b");
    assert_eq!(closing("a=m::fixed::b").unwrap().frames[1], "m::fixed::b");
    for wrong in [
        "a",
        "=b",
        "a=",
        "a=b:x",
        "a=b:hinge:x",
        "a=b:revolute:q",
        "a=b:fixed:",
        "a@1,2=b",
        "a@1,2,inf=b",
        "",
    ] {
        assert!(closing(wrong).unwrap_err().contains("A=B"), "{wrong}");
    }
    let options = Options { closings: vec!["tip=nowhere".parse().unwrap()], ..Options::default() };
    let text = FOUR_BAR.replace("FRAMES", "").replace("CLOSED", "");
    let problems = hardpoint_import::import_with(&options, text.as_bytes(), "r.urdf", &|_| None).unwrap_err();
    assert!(
        problems.to_string().contains("the frame `nowhere` for closing a loop does not exist"),
        "{problems}"
    );
}

/// Single mass of a model: centre and moments of inertia as written.
fn mass_of(text: &str) -> Vec<(String, f64)> {
    let table: toml_edit::DocumentMut = text.parse().unwrap();
    let entry =
        table["masses"].as_table().unwrap().iter().next().unwrap().1.as_inline_table().unwrap().clone();
    let mut out = Vec::new();
    for (key, value) in &entry {
        if let Some(x) = value.as_float() {
            out.push((key.to_owned(), x));
        }
    }
    let centre = entry["centre"].as_inline_table().unwrap()["at"].as_array().unwrap();
    out.extend(centre.iter().zip(["x", "y", "z"]).map(|(v, k)| (k.to_owned(), v.as_float().unwrap())));
    out
}

fn is(found: &[(String, f64)], wanted: &[(&str, f64)]) {
    for (key, wanted) in wanted {
        let x = found.iter().find(|(k, _)| k == key).map_or(0.0, |(_, x)| *x);
        assert!((x - wanted).abs() < 1e-12, "{key} is {x}, not {wanted}: {found:?}");
    }
}

#[test]
fn masses_come_along_in_the_global_axes() {
    // A link rotated by 90 degrees about z, with its inertia rotated by another 90 degrees about x.
    let inertia =
        r#"<mass value="2"/><inertia ixx="0.3" iyy="0.4" izz="0.5" ixy="0.01" ixz="0.02" iyz="0.03"/>"#;
    let urdf = format!(
        r#"<robot name="r"><link name="world"/><link name="a"><inertial><origin xyz="0.1 0.2 0.3" rpy="1.5707963267948966 0 0"/>{inertia}</inertial></link>
        <joint name="j" type="continuous"><parent link="world"/><child link="a"/><origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/><axis xyz="0 1 0"/></joint></robot>"#
    );
    // Columns of the inertia's frame in the world: Rz(90) Rx(90) e = y, z, x. So I_yy = 0.3, I_zz = 0.4, I_xx = 0.5,
    // and of the products ixy -> yz, ixz -> yx, iyz -> zx; in the model they have the opposite sign.
    let wanted = [
        ("mass", 2.0),
        ("x", 0.8),
        ("y", 0.1),
        ("z", 0.3),
        ("ixx", 0.5),
        ("iyy", 0.3),
        ("izz", 0.4),
        ("iyz", -0.01),
        ("ixy", -0.02),
        ("izx", -0.03),
    ];
    let (imported, _) = read("r.urdf", &urdf);
    is(&mass_of(&imported.text), &wanted);
    let sdf = r#"<sdf version="1.9"><model name="m"><link name="a"><pose>1 0 0 0 0 1.5707963267948966</pose>
        <inertial><pose>0.1 0.2 0.3 1.5707963267948966 0 0</pose><mass>2</mass><inertia><ixx>0.3</ixx><iyy>0.4</iyy><izz>0.5</izz>
        <ixy>0.01</ixy><ixz>0.02</ixz><iyz>0.03</iyz></inertia></inertial></link>
        <joint name="j" type="revolute"><parent>world</parent><child>a</child><axis><xyz>0 1 0</xyz></axis></joint></model></sdf>"#;
    let (imported, _) = read("m.sdf", sdf);
    is(&mass_of(&imported.text), &wanted);
    // MJCF has no orientation beside the matrix, which is turned here: Rx(90) e = x, z, -y.
    let mjcf = r#"<mujoco><compiler angle="radian"/><worldbody><body name="a" pos="1 0 0" euler="0 0 1.5707963267948966"><joint axis="0 1 0"/>
        <inertial pos="0.1 0.2 0.3" mass="2" fullinertia="0.3 0.5 0.4 -0.02 0.01 -0.03"/><geom size="9"/></body></worldbody></mujoco>"#;
    let (imported, _) = read("m.xml", mjcf);
    is(&mass_of(&imported.text), &wanted);
    // Masses of geoms: a ball of 0.1 m at x = 0.5 and one of half the density at x = -0.25.
    let balls = r#"<mujoco><worldbody><body name="a"><joint axis="0 1 0"/><geom size="0.1" pos="0.5 0 0"/>
        <geom size="0.1" pos="-0.25 0 0" density="500" group="4"/></body></worldbody></mujoco>"#;
    let (imported, _) = read("m.xml", balls);
    let [m, n] = [1000.0, 500.0].map(|rho| rho * 4.0 / 3.0 * PI * 1e-3);
    let own = 0.4 * (m + n) * 0.01;
    // m d^2 about the centre at 0.25
    let moved = m * 0.0625 + n * 0.25;
    is(
        &mass_of(&imported.text),
        &[("mass", m + n), ("x", 0.25), ("ixx", own), ("iyy", own + moved), ("izz", own + moved)],
    );
    // A capsule along x, compared with the integral over its slices.
    let capsule = r#"<mujoco><worldbody><body name="a"><joint axis="0 1 0"/><geom type="capsule" fromto="0 0 0 1 0 0" size="0.2"/></body></worldbody></mujoco>"#;
    let (imported, _) = read("m.xml", capsule);
    let steps = 200_000;
    let h = 1.4 / f64::from(steps);
    let (mut mass, mut about_axis, mut across) = (0.0, 0.0, 0.0);
    for k in 0..steps {
        let x: f64 = -0.7 + (f64::from(k) + 0.5) * h;
        let beyond = (x.abs() - 0.5).max(0.0);
        let r2 = 0.04 - beyond * beyond;
        let dm = 1000.0 * PI * r2 * h;
        mass += dm;
        about_axis += dm * r2 / 2.0;
        across += dm * (r2 / 4.0 + x * x);
    }
    let found = mass_of(&imported.text);
    for (key, wanted) in [("mass", mass), ("ixx", about_axis), ("iyy", across), ("izz", across), ("x", 0.5)] {
        let x = found.iter().find(|(k, _)| k == key).unwrap().1;
        // Error of the integration.
        assert!((x - wanted).abs() < 1e-6 * wanted, "{key}: {x} {wanted}");
    }
    // Impossible inertia is reported, and the mass is preserved.
    let flat = urdf.replace("izz=\"0.5\"", "izz=\"5\"");
    let (imported, _) = read("r.urdf", &flat);
    assert!(
        imported.report.of(ElementOutcome::Approximated).any(|e| e.kind == "inertial"),
        "{}",
        imported.report
    );
    is(&mass_of(&imported.text), &[("mass", 2.0), ("ixx", 0.0)]);
    let negative = urdf.replace("<mass value=\"2\"/>", "<mass value=\"-2\"/>");
    let (imported, _) = read("r.urdf", &negative);
    assert!(imported.report.of(ElementOutcome::Refused).any(|e| e.kind == "inertial"), "{}", imported.report);
}

/// Torque of the only driver at the first output time, with the driver moving at 0.4 per second, and the text of the
/// model.
fn driver_torque(text: &str) -> (f64, String) {
    let driver = text.lines().find_map(|l| l.strip_prefix("[drivers.")).unwrap().trim_end_matches(']');
    let start = text.find("law = \"").unwrap();
    let end = start + text[start..].find('\n').unwrap();
    let measure = format!("[measures.torque]\ntype = \"driver_force\"\ndriver = \"{driver}\"");
    let measured = format!("{}law = \"0.4*t\"{}\n{measure}\n", &text[..start], &text[end..]);
    let file = hardpoint_file::parse(&measured, "m.toml").unwrap_or_else(|e| panic!("{e}\n{measured}"));
    let run = Analysis::new(&file.model).unwrap().run();
    let torque = run.measured.outputs.iter().position(|o| o.name == "torque").unwrap();
    (run.measured.value(0, torque)[0], measured)
}

#[test]
fn springs_and_dampers_of_joints_have_the_forces_of_the_source() {
    // A pendulum of 2 kg at 0.5 m along x, with a spring of 7 N m/rad (no force at 0.3 rad) and a damper, fixed at
    // zero.
    let urdf = r#"<robot name="r"><link name="world"/><link name="a"><inertial><origin xyz="0.5 0 0"/><mass value="2"/></inertial></link>
        <joint name="j" type="continuous"><parent link="world"/><child link="a"/><axis xyz="0 1 0"/><dynamics damping="0.6"/></joint>
        <gazebo reference="j"><springStiffness>7</springStiffness><springReference>0.3</springReference></gazebo></robot>"#;
    let sdf = r#"<sdf version="1.9"><world name="w"><gravity>0 0 -9.80665</gravity><model name="m"><link name="a"><inertial><pose>0.5 0 0 0 0 0</pose><mass>2</mass></inertial></link>
        <joint name="j" type="revolute"><parent>world</parent><child>a</child><axis><xyz>0 1 0</xyz><dynamics><damping>0.6</damping>
        <spring_stiffness>7</spring_stiffness><spring_reference>0.3</spring_reference></dynamics></axis></joint></model></world></sdf>"#;
    let mjcf = r#"<mujoco><compiler angle="radian"/><option gravity="0 0 -9.80665"/><worldbody><body name="a">
        <joint name="j" axis="0 1 0" damping="0.6" stiffness="7" springref="0.5" ref="0.2"/><inertial pos="0.5 0 0" mass="2"/></body></worldbody></mujoco>"#;
    for (name, text) in [("r.urdf", urdf), ("m.sdf", sdf), ("m.xml", mjcf)] {
        let (found, measured) = driver_torque(&read(name, text).0.text);
        // At t = 0: about y the weight turns the pendulum with +m g l, the spring with -k (0 - 0.3); the damper with -c
        // 0.4. SDFormat has an inertia of 1 kg m^2 by default, which constant speed does not feel.
        let wanted = -2.0 * 9.80665 * 0.5 - 7.0 * 0.3 + 0.6 * 0.4;
        assert!((found - wanted).abs() < 1e-9, "{name}: {found} instead of {wanted}\n{measured}");
    }
}

#[test]
fn springs_of_tendons_pull() {
    // From (0.5, 0, 0) on the pendulum to (0.5, 0, 1) on the ground: 40 N/m over 0.25 m beyond its length, straight up.
    let text = r#"<mujoco><option gravity="0 0 0"/><worldbody><site name="top" pos="0.5 0 1"/><body name="a"><joint name="j" axis="0 1 0"/>
        <inertial pos="0.5 0 0" mass="2"/><site name="end" pos="0.5 0 0"/></body></worldbody>
        <tendon><spatial name="s" stiffness="40" damping="3" springlength="0.75"><site site="end"/><site site="top"/></spatial></tendon></mujoco>"#;
    let (found, measured) = driver_torque(&read("m.xml", text).0.text);
    // Its end moves down at 0.4 x 0.5 m/s, which extends the spring.
    let wanted = 0.5 * (40.0 * 0.25 + 3.0 * 0.4 * 0.5);
    assert!((found - wanted).abs() < 1e-9, "{found} instead of {wanted}\n{measured}");
}

#[test]
fn tendons_of_constant_further_parts_or_with_slack_are_springs() {
    let model = |defaults: &str, joint: &str, tendon: &str| {
        format!(
            r#"<mujoco><option gravity="0 0 0"/><default>{defaults}</default><worldbody><site name="top" pos="0.5 0 1"/><site name="far" pos="0.5 0 3"/>
            <geom name="drum" type="sphere" size="0.1"/><body name="a"><joint name="j" axis="0 1 0" {joint}/><inertial pos="0.5 0 0" mass="2"/>
            <site name="end" pos="0.5 0 0"/><site name="middle" pos="0.25 0 0"/><body name="b" pos="0 1 0"><site name="other"/></body></body></worldbody>
            <tendon>{tendon}</tendon></mujoco>"#
        )
    };
    let path = r#"<site site="end"/><site site="top"/>"#;
    let spatial = |law: &str, path: &str| format!(r#"<spatial name="s" {law}>{path}</spatial>"#);
    let long = r#"<site site="middle"/><site site="end"/><site site="top"/><site site="far"/>"#;
    let fixed = |law: &str| format!(r#"<fixed name="s" {law}><joint joint="j" coef="0.5"/></fixed>"#);
    let lowered = {
        let (sin, cos) = f64::sin_cos(0.3);
        -0.5 * 40.0 * (1.0 - f64::hypot(0.5 - 0.5 * cos, 1.0 + 0.5 * sin))
    };
    // At t = 0 the end is 1 m below the top and at rest; the moment about y is minus the force upwards times 0.5 m.
    for (defaults, joint, tendon, moment, is_exact) in [
        // From a class: 40 N/m over 0.25 m
        (r#"<tendon stiffness="40"/>"#, "", spatial(r#"springlength="0.75""#, path), -0.5 * 10.0, true),
        // 0.25 m and 2 m of it are constant.
        ("", "", spatial(r#"stiffness="40" springlength="3""#, long), -0.5 * 10.0, true),
        // Longer than its constant parts alone: without a positive free length
        ("", "", spatial(r#"stiffness="40" springlength="2""#, long), -0.5 * 50.0, true),
        ("", "", spatial(r#"stiffness="40" springlength="-0.25""#, path), -0.5 * 50.0, true),
        // Slack between 0.5 and 0.9 m, and between 1.2 and 1.5 m
        ("", "", spatial(r#"stiffness="40" springlength="0.5 0.9""#, path), -0.5 * 4.0, false),
        ("", "", spatial(r#"stiffness="40" springlength="1.2 1.5""#, path), 0.5 * 8.0, false),
        ("", "", spatial(r#"stiffness="40" springlength="0.8 1.2""#, path), 0.0, false),
        // A multiple of the angle: 40 x 0.25 N m/rad over 0.3 / 0.5 rad, or over the reference of the spring
        ("", "", fixed(r#"stiffness="40" springlength="0.3""#), 10.0 * 0.6, true),
        ("", r#"ref="0.2" springref="0.5""#, fixed(r#"stiffness="40" springlength="0.3""#), 10.0 * 0.4, true),
        ("", r#"ref="0.2" springref="0.5""#, fixed(r#"stiffness="40""#), 10.0 * 0.3, true),
        // The end is 0.5 sin 0.3 lower, and nearer to the axis, where springs have no force; it also is with -1.
        ("", r#"ref="0.2" springref="0.5""#, spatial(r#"stiffness="40""#, path), lowered, true),
        (
            "",
            r#"ref="0.2" springref="0.5""#,
            spatial(r#"stiffness="40" springlength="-1""#, long),
            lowered,
            true,
        ),
        // Lengths of fixed tendons may be negative; only -1 is that at the reference.
        ("", "", fixed(r#"stiffness="40" springlength="-0.2""#), -10.0 * 0.4, true),
        ("", "", fixed(r#"stiffness="40" springlength="-1.5 -1.5""#), -10.0 * 3.0, true),
        ("", r#"ref="0.2" springref="0.5""#, fixed(r#"stiffness="40" springlength="-1""#), 10.0 * 0.3, true),
        (
            "",
            r#"ref="0.2" springref="0.5""#,
            fixed(r#"stiffness="40" springlength="-1 -1""#),
            10.0 * 0.3,
            true,
        ),
    ] {
        let text =
            model(defaults, joint, &tendon).replace("<mujoco>", r#"<mujoco><compiler angle="radian"/>"#);
        let (imported, _) = read("m.xml", &text);
        let approximated =
            imported.report.of(ElementOutcome::Approximated).filter(|e| e.kind == "spatial").count();
        assert_eq!(approximated, usize::from(!is_exact), "{tendon}: {}", imported.report);
        let refused: Vec<_> = imported.report.of(ElementOutcome::Refused).collect();
        assert!(refused.is_empty(), "{tendon}: {}", imported.report);
        let (found, measured) = driver_torque(&imported.text);
        let accepted = if is_exact { 1e-9 } else { 1e-3 * (f64::abs(moment) + 0.5) };
        assert!((found + moment).abs() < accepted, "{tendon}: {found} instead of {}\n{measured}", -moment);
    }
    for (tendon, reason) in [
        (spatial(r#"stiffness="40""#, &format!(r#"{path}<site site="other"/>"#)), "more than two bodies"),
        (spatial(r#"stiffness="40""#, r#"<site site="end"/><geom geom="drum"/><site site="top"/>"#), "wrap"),
        (
            spatial(r#"stiffness="40""#, r#"<site site="end"/><pulley divisor="2"/><site site="top"/>"#),
            "pulley",
        ),
        (spatial(r#"stiffness="40""#, r#"<site site="end"/><site site="middle"/>"#), "same body"),
        (spatial(r#"stiffness="-40""#, path), "negative"),
        (spatial(r#"stiffness="40 3""#, path), "depends on the length"),
        (fixed(r#"stiffness="40" springlength="0.1 0.2""#), "between two lengths"),
        (fixed(r#"stiffness="40" springlength="-0.3 0.1""#), "between two lengths"),
        (spatial(r#"stiffness="40" springlength="0.5 0.2""#, path), "below the first"),
        (
            r#"<fixed name="s" stiffness="4"><joint joint="j" coef="1"/><joint joint="j" coef="2"/></fixed>"#
                .to_owned(),
            "several joints",
        ),
    ] {
        let (imported, _) = read("m.xml", &model("", "", &tendon));
        let refused: Vec<_> = imported.report.of(ElementOutcome::Refused).collect();
        assert!(refused.len() == 1 && refused[0].why.contains(reason), "{tendon}: {}", imported.report);
    }
}

#[test]
fn datasets_of_adams_bring_bushings() {
    // Marker 1 has its z axis along the global y axis; the bushing is 100 mm from the hinge, and its second marker
    // moves by 100 mm times the sine of the angle.
    let text = "arm\nUNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=MILLIMETER, TIME=SECOND\nPART/1, GROUND\nMARKER/1, PART=1, REULER=0D,-90D,0D\n\
        MARKER/11, PART=1, QP=100,0,0, REULER=0D,-90D,0D\nPART/2\nMARKER/20, PART=2, QP=100,0,0, REULER=0D,-90D,0D\n\
        MARKER/23, PART=2, REULER=0D,-90D,0D\nJOINT/1, REVOLUTE, I=23, J=1\nMOTION/1, ROTATIONAL, JOINT=1, FUNCTION=0.3\n\
        BUSHING/7, I=20, J=11, K=30,40,50, KT=2E3,3E3,4E3, FORCE=1,2,3, TORQUE=0,0,100\nEND\n";
    let (imported, _) = read("arm.adm", text);
    assert_eq!(imported.report.of(ElementOutcome::Ignored).count(), 0, "{}", imported.report);
    assert_eq!(imported.report.of(ElementOutcome::Approximated).count(), 0, "{}", imported.report);
    let measured =
        format!("{}\n[measures.torque]\ntype = \"driver_force\"\ndriver = \"MOTION_1\"\n", imported.text);
    let file = hardpoint_file::parse(&measured, "m.toml").unwrap_or_else(|e| panic!("{e}\n{measured}"));
    let run = Analysis::new(&file.model).unwrap().run();
    let found = run.measured.value(0, run.measured.index("torque").unwrap())[0];
    // In the axes of marker 11 the second marker moves by 0.1 (cos - 1) and 0.1 sin along x and y, and turns about z.
    let turn = 0.3_f64;
    let (s, c) = turn.sin_cos();
    let (along, across) = (1.0 - 30.0 * 100.0 * (c - 1.0), 2.0 - 40.0 * 100.0 * s);
    let moment = 0.1 - 4.0 * turn + 0.1 * (c * across - s * along);
    assert!((found + moment).abs() < 1e-9, "{found} instead of {}\n{measured}", -moment);
    // Markers that are not aligned, and damping that differs along the axes, are reported.
    let other = text.replace("QP=100,0,0, REULER=0D,-90D,0D\nMARKER/23", "QP=100,0,0\nMARKER/23");
    let other = other.replace("KT=", "C=1,2,3, KT=");
    let (imported, _) = read("arm.adm", &other);
    assert_eq!(imported.report.of(ElementOutcome::Approximated).count(), 1, "{}", imported.report);
}

#[test]
fn datasets_of_adams_bring_masses_gravity_and_springs() {
    let text = "pendulum\nUNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=MILLIMETER, TIME=SECOND\nPART/1, GROUND\nMARKER/1, PART=1, REULER=0D,-90D,0D\n\
        MARKER/10, PART=1, QP=0,0,400\nPART/2, MASS=2, CM=21, IM=20, IP=6E5,7E5,8E5,1E4,2E4,3E4\nMARKER/20, PART=2\n\
        MARKER/21, PART=2, QP=100,50,0, REULER=30D,20D,0D\nMARKER/22, PART=2, QP=200,0,0\nMARKER/23, PART=2, REULER=0D,-90D,0D\n\
        JOINT/1, REVOLUTE, I=23, J=1\nMOTION/1, ROTATIONAL, JOINT=1, FUNCTION=0.4*TIME\nACCGRAV/KGRAV=-9806.65\n\
        SPRINGDAMPER/1, I=22, J=10, TRANSLATION, K=3, C=0.2, LENGTH=300, FORCE=12\nEND\n";
    let (imported, _) = read("pendulum.adm", text);
    assert_eq!(imported.report.of(ElementOutcome::NotUnderstood).count(), 0, "{}", imported.report);
    assert_eq!(imported.report.of(ElementOutcome::Ignored).count(), 0, "{}", imported.report);
    // I_c = I_P - m (d^2 1 - d d^T) with d = (0.1, 0.05, 0) m; products are integrals on both sides.
    is(
        &mass_of(&imported.text),
        &[
            ("mass", 2.0),
            ("x", 100.0),
            ("y", 50.0),
            ("ixx", 0.595),
            ("iyy", 0.68),
            ("izz", 0.775),
            ("ixy", 0.0),
            ("izx", 0.02),
            ("iyz", 0.03),
        ],
    );
    let torque = |text: &str| {
        let (imported, _) = read("pendulum.adm", text);
        let measured =
            format!("{}\n[measures.torque]\ntype = \"driver_force\"\ndriver = \"MOTION_1\"\n", imported.text);
        let file = hardpoint_file::parse(&measured, "m.toml").unwrap_or_else(|e| panic!("{e}\n{measured}"));
        let run = Analysis::new(&file.model).unwrap().run();
        let torque = run.measured.outputs.iter().position(|o| o.name == "torque").unwrap();
        run.measured.value(0, torque)[0]
    };
    // About y: the weight turns with m g 0.1; the spring pulls its end at (0.2, 0, 0) towards (0, 0, 0.4), which comes
    // nearer or goes farther with the component of 0.4 rad/s x 0.2 m along it.
    let length = 0.2_f64.hypot(0.4);
    let up = 0.4 / length;
    let tension = 3.0 * (1e3 * length - 300.0) - 12.0 + 0.2 * 1e3 * (0.4 * 0.2 * up);
    let wanted = -(2.0 * 9.80665 * 0.1 - 0.2 * up * tension);
    let found = torque(text);
    assert!((found - wanted).abs() < 1e-9, "{found} instead of {wanted}");
    // The same dataset in other units of mass, force, length and time.
    let other = text
        .replace(
            "FORCE=NEWTON, MASS=KILOGRAM, LENGTH=MILLIMETER, TIME=SECOND",
            "FORCE=KNEWTON, MASS=GRAM, LENGTH=METER, TIME=MILLISECOND",
        )
        .replace("QP=0,0,400", "QP=0,0,0.4")
        .replace("QP=100,50,0", "QP=0.1,0.05,0")
        .replace("QP=200,0,0", "QP=0.2,0,0")
        .replace("MASS=2,", "MASS=2000,")
        .replace("IP=6E5,7E5,8E5,1E4,2E4,3E4", "IP=600,700,800,10,20,30")
        .replace("0.4*TIME", "0.4E-3*TIME")
        .replace("KGRAV=-9806.65", "KGRAV=-9.80665E-6")
        .replace("K=3, C=0.2, LENGTH=300, FORCE=12", "K=3, C=200, LENGTH=0.3, FORCE=0.012");
    assert_ne!(other, text);
    let found = torque(&other);
    assert!((found - wanted).abs() < 1e-9, "{found} instead of {wanted}");
}

#[test]
fn fixed_joints_assemble_separated_frames_in_every_format() {
    // A hinge carries a, which carries b with a frame that is displaced and rotated in the design configuration.
    let frame = |place: &str| format!("MARKER/22, PART=2, QP=100,0,0\nMARKER/30, PART=3, {place}\n");
    let adams = |place: &str| {
        format!(
            "fixed\nUNITS/LENGTH=MILLIMETER\nPART/1, GROUND\nMARKER/1, PART=1, REULER=0D,-90D,0D\nPART/2\nMARKER/23, PART=2, REULER=0D,-90D,0D\n\
             PART/3, QG=400,50,0\n{}JOINT/1, REVOLUTE, I=23, J=1\nJOINT/2, FIXED, I=30, J=22\nEND\n",
            frame(place)
        )
    };
    for (place, wanted) in [
        ("QP=0,0,20", pose([0.0, 0.0, 0.02], [1.0, 0.0, 0.0, 0.0])),
        (
            "QP=0,0,20, REULER=40D,0D,0D",
            pose([0.0, 0.0, 0.02], [20.0_f64.to_radians().cos(), 0.0, 0.0, 20.0_f64.to_radians().sin()]),
        ),
        ("QP=-300,-50,0", pose([-0.3, -0.05, 0.0], [1.0, 0.0, 0.0, 0.0])),
    ] {
        let (_, file) = read("fixed.adm", &adams(place));
        let poses = poses(&file, &["PART_2", "PART_3"]);
        let off = off(&poses, [at([0.1, 0.0, 0.0]), wanted]);
        assert!(off < SAME, "{place}: {off}");
        assert!(poses[0][0].rot.angle_to(poses[25][0].rot) > 0.1);
    }
    let urdf = r#"<robot name="m"><link name="world"/><link name="a"/><link name="b"/>
        <joint name="g" type="continuous"><parent link="world"/><child link="a"/><axis xyz="0 1 0"/></joint>
        <joint name="f" type="floating"><parent link="world"/><child link="b"/><origin xyz="0.4 0.05 0"/></joint>
        <loop_joint name="j" type="fixed"><link1 link="a" xyz="0.1 0 0" rpy="0 0 0"/><link2 link="b" xyz="0 0 0.02" rpy="0.3 0 0"/></loop_joint></robot>"#;
    let (_, file) = read("m.urdf", urdf);
    let turned = Pose { rot: Mat3::about([1.0, 0.0, 0.0].into(), 0.3), r: [0.0, 0.0, 0.02].into() };
    assert!(off(&poses(&file, &["a", "b"]), [at([0.1, 0.0, 0.0]), turned]) < SAME);
}

/// Dataset of a block of 2 kg that slides along x, with further statements; its displacement is prescribed.
fn slider(further: &str, x: &str) -> String {
    format!(
        "slider\nUNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=MILLIMETER, TIME=SECOND\nPART/1, GROUND\n\
         MARKER/1, PART=1, REULER=90D,90D,0D\nPART/2\nMARKER/2, PART=2, QP=200,0,0, REULER=90D,90D,0D\n\
         JOINT/1, TRANSLATIONAL, I=2, J=1\nMOTION/1, TRANSLATIONAL, JOINT=1, FUNCTION=200+{x}\n{further}END\n"
    )
}

/// Imported model and the driver forces at all output times.
fn driver_forces(text: &str) -> (ImportedModel, Vec<[f64; 2]>) {
    let (imported, _) = read("m.adm", text);
    let measured =
        format!("{}\n[measures.force]\ntype = \"driver_force\"\ndriver = \"MOTION_1\"\n", imported.text);
    let file = hardpoint_file::parse(&measured, "m.toml").unwrap_or_else(|e| panic!("{e}\n{measured}"));
    let run = Analysis::new(&file.model).unwrap().run();
    let force = run.measured.index("force").unwrap();
    let times = run.motion.times.iter().enumerate();
    let values = times.map(|(k, t)| [*t, run.measured.value(k, force)[0]]).collect();
    (imported, values)
}

#[test]
fn datasets_of_adams_bring_stops() {
    // A stop below 160 mm and one above 230 mm; the block moves 80 mm to both sides.
    let stop = |exponent: f64, (at, rate): (&str, &str), damping: f64| {
        format!(
            "SFORCE/4, TRANSLATIONAL, I=2, J=1, FUNCTION=BISTOP({at}, {rate},\n, 160, 230, 30, {exponent}, {damping}, 0.1)\n"
        )
    };
    let x = |t: f64| 200.0 + 80.0 * (6.0 * t).sin();
    for (exponent, measured, damping) in [
        (1.0, ("DM(2,1)", "VR(2,1)"), 0.0),
        (1.5, ("DM(1,2)", "VR(1,2)"), 0.0),
        (2.2, ("DZ(2,1,1)", "VZ(2,1,1,1)"), 5.0),
    ] {
        let text = slider(&stop(exponent, measured, damping), "80*SIN(6*TIME)");
        let (imported, forces) = driver_forces(&text);
        assert_eq!(imported.report.of(ElementOutcome::Ignored).count(), 0, "{}", imported.report);
        assert_eq!(imported.report.of(ElementOutcome::Refused).count(), 0, "{}", imported.report);
        let entries: Vec<_> = imported.report.of(ElementOutcome::Approximated).collect();
        assert_eq!(entries.len(), 1, "{}", imported.report);
        assert!(entries[0].why.contains("deviates by up to"), "{}", entries[0].why);
        assert_eq!(entries[0].why.contains("damping"), damping > 0.0, "{}", entries[0].why);
        let [mut below, mut above] = [0; 2];
        for [t, force] in forces {
            let x = x(t);
            // The driver holds the block against the stop.
            let wanted = 30.0 * ((x - 230.0).max(0.0).powf(exponent) - (160.0 - x).max(0.0).powf(exponent));
            // A thousandth of the force, and of that 1 % of the range beyond the stop.
            let accepted = 1.5e-3 * (wanted.abs() + 30.0 * 4.6_f64.powf(exponent));
            assert!((force - wanted).abs() < accepted, "{exponent} at {x}: {force} instead of {wanted}");
            below += u32::from(x < 159.0);
            above += u32::from(x > 231.0);
        }
        assert!(below > 3 && above > 3);
    }
}

#[test]
fn forces_by_linear_functions_are_springs() {
    // 7 N/mm without force at 150 mm, and 0.2 N s/mm.
    let force = "SFORCE/4, TRANSLATION, I=2, J=1, FUNCTION=-7*(DM(2,1)-150) - 0.2*VR(2,1)\n";
    let (imported, forces) = driver_forces(&slider(force, "40*TIME"));
    assert_eq!(imported.report.of(ElementOutcome::Approximated).count(), 0, "{}", imported.report);
    for [t, force] in forces {
        let wanted = 7.0 * (50.0 + 40.0 * t) + 0.2 * 40.0;
        assert!((force - wanted).abs() < 1e-9 * wanted, "{force} instead of {wanted}");
    }
    // A constant force of 25 N that separates them; the markers in reverse order.
    let (_, forces) = driver_forces(&slider("SFORCE/4, TRANSLATION, I=1, J=2, FUNCTION=25\n", "40*TIME"));
    assert!(forces.iter().all(|[_, force]| (force + 25.0).abs() < 1e-9), "{forces:?}");
    // About the axis of a hinge, as a SPRINGDAMPER and as a function.
    let hinge = |further: &str| {
        format!(
            "hinge\nUNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=MILLIMETER, TIME=SECOND\nPART/1, GROUND\nMARKER/1, PART=1, REULER=0D,-90D,0D\n\
             PART/2\nMARKER/23, PART=2, REULER=0D,-90D,20D\nJOINT/1, REVOLUTE, I=23, J=1\nMOTION/1, ROTATIONAL, JOINT=1, FUNCTION=0.4*TIME+20D\n\
             {further}END\n"
        )
    };
    for (further, nominal) in [
        ("SPRINGDAMPER/4, I=23, J=1, ROTATION, KT=7E3, CT=600, ANGLE=10D, TORQUE=50\n", -1.0),
        ("SFORCE/4, ROTATIONAL, I=23, J=1, FUNCTION=-7E3*(AZ(23,1)-10D) - 600*WZ(23,1,1) + 50\n", -1.0),
        ("SFORCE/4, ROTATIONAL, I=1, J=23, FUNCTION=7E3*(AZ(23,1)-10D) + 600*WZ(23,1,1) - 50\n", -1.0),
    ] {
        let (imported, forces) = driver_forces(&hinge(further));
        assert_eq!(imported.report.of(ElementOutcome::Refused).count(), 0, "{}", imported.report);
        for [t, force] in forces {
            let angle = 10_f64.to_radians() + 0.4 * t;
            let wanted = nominal * (-7.0 * angle - 0.6 * 0.4 + 0.05);
            assert!((force - wanted).abs() < 1e-9, "{further}{t}: {force} instead of {wanted}");
        }
    }
}

#[test]
fn forces_without_equivalent_are_refused_with_their_reason() {
    for (force, reason) in [
        ("I=2, J=1, FUNCTION=USER(1,2)", "user"),
        ("I=2, J=1, FUNCTION=5*TIME", "time"),
        ("I=2, J=1, FUNCTION=7*DM(2,1)", "negative"),
        ("I=2, J=1, FUNCTION=-7*DX(2,1,1)", "no translational joint"),
        ("I=2, J=1, FUNCTION=-7*DM(2,5)", "its own markers"),
        ("I=2, J=1, ACTIONONLY, FUNCTION=-7*DM(2,1)", "one part alone"),
        ("I=2, J=1, FUNCTION=IMPACT(DM(2,1), VR(2,1), -3, 10, 1.5, 0, 1)", "no force"),
        ("I=2, J=1, FUNCTION=1/(DM(2,1)-100)", "no value"),
        ("I=2, J=3, FUNCTION=-7*DM(2,3)", "coincide"),
    ] {
        let force =
            format!("MARKER/3, PART=1, QP=200,0,0\nMARKER/5, PART=1\nSFORCE/4, TRANSLATIONAL, {force}\n");
        let (imported, _) = read("m.adm", &slider(&force, "40*TIME"));
        let refused: Vec<_> = imported.report.of(ElementOutcome::Refused).collect();
        assert!(refused.len() == 1 && refused[0].why.contains(reason), "{reason}: {}", imported.report);
    }
    let without = slider("SFORCE/4, TRANSLATIONAL, I=2, J=1, FUNCTION=-7*DM(2,1)\n", "40*TIME");
    let (imported, _) = read("m.adm", &without.replace("FORCE=NEWTON, ", ""));
    let refused: Vec<_> = imported.report.of(ElementOutcome::Refused).collect();
    assert!(refused.len() == 1 && refused[0].why.contains("unit of force"), "{}", imported.report);
}
