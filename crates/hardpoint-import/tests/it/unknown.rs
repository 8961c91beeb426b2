//! Unknown elements and attributes are reported as such, not as irrelevant to the motion.

use hardpoint_import::{ElementOutcome, Format};

use crate::folder;

const URDF: &str = r#"<robot name="r" xmlns:drake="http://drake.mit.edu">
  <link name="base"/><link name="a"/><link name="b"/><link name="c"/>
  <joint name="one" type="revolute"><parent link="base"/><child link="a"/><origin xyz="0 0 1"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="two" type="revolute"><parent link="a"/><child link="b"/><origin xyz="1 0 0"/><axis xyz="0 1 0"/><mimic joint="one" multiplier="2"/></joint>
  <joint name="three" type="revolute"><parent link="base"/><child link="c"/><origin xyz="3 0 1"/><axis xyz="0 1 0"/><dynamics damping="1"/></joint>
  <loop_joint name="loop" type="continuous"><link1 link="b" xyz="1 0 0"/><link2 link="c" xyz="-1 0 0"/><axis xyz="0 1 0"/></loop_joint>
  <gazebo><plugin name="p" filename="libgazebo_ros_control.so"/></gazebo>
</robot>"#;

const SDF: &str = r#"<sdf version="1.9"><world name="w"><model name="m">
  <link name="a"/><link name="b"><pose>1 0 0 0 0 0</pose></link>
  <joint name="g" type="revolute"><parent>world</parent><child>a</child><axis><xyz>0 1 0</xyz><limit><lower>-1</lower><upper>1</upper></limit><dynamics><damping>1</damping></dynamics></axis></joint>
  <joint name="j" type="revolute"><pose>0 0 0 0 0 0</pose><parent>a</parent><child>b</child><axis><xyz>0 1 0</xyz><mimic joint="g"><multiplier>2</multiplier></mimic></axis></joint>
  <plugin name="p" filename="libJointStatePublisher.so"/>
</model></world></sdf>"#;

const MJCF: &str = r#"<mujoco><default><joint damping="1"/><equality solref="0.01 1"/></default><worldbody>
  <body name="a"><joint name="one" axis="0 1 0"/><geom size="0.1"/>
    <body name="b" pos="1 0 0"><joint name="two" axis="0 1 0"/><geom size="0.1"/></body></body>
  <body name="c" pos="3 0 0"><joint name="three" axis="0 1 0"/><geom size="0.1"/></body>
  <body name="d" pos="3 1 0"><freejoint/><geom size="0.1"/></body>
  </worldbody><tendon><fixed name="sum"><joint joint="one" coef="1"/></fixed></tendon>
  <equality><connect body1="b" body2="c" anchor="1 0 0"/><weld body1="c" body2="d"/><joint joint1="one" joint2="two"/></equality>
</mujoco>"#;

/// Text of a source, its replacement, and the name that is reported.
type Change = (&'static str, &'static str, &'static str);

fn named_in(format: &str, bytes: &[u8], what: &str) {
    let format = Format::named(format).unwrap();
    let imported = hardpoint_import::import_as(format, bytes, "source", &|_| None)
        .unwrap_or_else(|e| panic!("{what}: {e}"));
    let report = &imported.report;
    let named: Vec<&str> = report.of(ElementOutcome::NotUnderstood).map(|e| e.kind.as_str()).collect();
    assert_eq!(named, [what], "{report}");
    let place = &report.of(ElementOutcome::NotUnderstood).next().unwrap().place;
    assert!(report.of(ElementOutcome::Ignored).all(|e| e.place != *place), "{report}");
    // It comes first in the report, after the remarks.
    let text = report.to_string();
    let lines = text.lines().skip(1).find(|l| !l.starts_with("  note:"));
    assert!(lines.unwrap().starts_with("  not understood"), "{text}");
    assert!(report.of(ElementOutcome::NotUnderstood).all(|e| e.place.is_some()), "{report}");
}

fn all_named(format: &str, text: &str, changes: &[Change]) {
    let known =
        hardpoint_import::import(text.as_bytes(), "source", &|_| None).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(known.report.of(ElementOutcome::NotUnderstood).count(), 0, "{}", known.report);
    for (from, to, what) in changes {
        let changed = text.replacen(from, to, 1);
        assert_ne!(changed, text, "`{from}` is not in the source");
        named_in(format, changed.as_bytes(), what);
    }
}

#[test]
fn in_urdf() {
    all_named(
        "urdf",
        URDF,
        &[
            (
                r#"<axis xyz="0 1 0"/><limit"#,
                r#"<axis xyz="0 1 0"/><child_pose xyz="0 0 1"/><limit"#,
                "child_pose",
            ),
            (r#"type="revolute""#, r#"type="revolute" zero="0.5""#, "zero"),
            (r#"<origin xyz="0 0 1""#, r#"<origin xyz="0 0 1" about="z""#, "about"),
            (r#"<axis xyz="0 1 0""#, r#"<axis xyz="0 1 0" zero_at="0.5""#, "zero_at"),
            (r#"<axis xyz="0 1 0""#, r#"<axis xyz="0 1 0" pitch="0.5""#, "pitch"),
            (r#"<limit lower="-1""#, r#"<limit lower="-1" stop="0.5""#, "stop"),
            (r#"multiplier="2""#, r#"multiplier="2" square="1""#, "square"),
            (r#"damping="1""#, r#"damping="1" rest="0.5""#, "rest"),
            (r#"<parent link="base""#, r#"<parent link="base" frame="x""#, "frame"),
            (r#"<loop_joint name="loop""#, r#"<loop_joint name="loop" offset="1""#, "offset"),
            (r#"</loop_joint>"#, r#"<angle>0.1</angle></loop_joint>"#, "angle"),
            (r#"<gazebo>"#, r#"<gazebo><constraint a="x"/>"#, "constraint"),
            (r#"<gazebo>"#, r#"<gazebo><plugin name="fourbar" filename="libclose.so"/>"#, "plugin"),
            (r#"<gazebo>"#, r#"<closed_loop/><gazebo>"#, "closed_loop"),
            (r#"<link name="c"/>"#, r#"<link name="c"><attached to="b"/></link>"#, "attached"),
            (
                r#"<link name="c"/>"#,
                r#"<link name="c"><inertial><mass value="1" scale="2"/></inertial></link>"#,
                "scale",
            ),
            (
                r#"<link name="c"/>"#,
                r#"<link name="c"><inertial><mass value="1"/><density value="2"/></inertial></link>"#,
                "density",
            ),
            (
                r#"<gazebo>"#,
                r#"<gazebo><joint name="g" type="ball"><parent>b</parent><child>c</child><angle>1</angle></joint>"#,
                "angle",
            ),
            (
                r#"<gazebo>"#,
                r#"<drake:ball_constraint><drake:ball_constraint_body_A name="b"/><drake:ball_constraint_body_B name="c"/><drake:stiff/></drake:ball_constraint><gazebo>"#,
                "stiff",
            ),
            (
                r#"<gazebo>"#,
                r#"<mujoco><equality><weld body1="a" body2="b" twist="1"/></equality></mujoco><gazebo>"#,
                "twist",
            ),
            (r#"<gazebo>"#, r#"<mujoco><deformable/></mujoco><gazebo>"#, "deformable"),
        ],
    );
}

#[test]
fn in_sdformat() {
    all_named(
        "sdf",
        SDF,
        &[
            ("<child>b</child>", "<child>b</child><child_pose>0 0 1 0 0 0</child_pose>", "child_pose"),
            ("<xyz>0 1 0</xyz>", "<xyz>0 1 0</xyz><zero_at>0.5</zero_at>", "zero_at"),
            (
                "<xyz>0 1 0</xyz>",
                "<xyz>0 1 0</xyz><initial_position>0.5</initial_position>",
                "initial_position",
            ),
            (
                "<link name=\"a\"/>",
                "<link name=\"a\"><inertial><mass>1</mass><foo>1</foo></inertial></link>",
                "foo",
            ),
            (
                "<link name=\"a\"/>",
                "<link name=\"a\"><inertial><inertia><iww>1</iww></inertia></inertial></link>",
                "iww",
            ),
            ("<xyz>", "<xyz about='z'>", "about"),
            ("<lower>", "<stop>1</stop><lower>", "stop"),
            ("<damping>", "<rest>1</rest><damping>", "rest"),
            ("<multiplier>", "<square>1</square><multiplier>", "square"),
            ("<pose>0 0 0", "<pose mirror='x'>0 0 0", "mirror"),
            ("<pose>1 0 0", "<pose mirror='x'>1 0 0", "mirror"),
            ("type=\"revolute\"", "type=\"revolute\" zero=\"1\"", "zero"),
            ("<plugin", "<closed_loop/><plugin", "closed_loop"),
            ("<model", "<population/><model", "population"),
            ("<plugin", "<plugin name='fourbar' filename='libclose.so'/><plugin", "plugin"),
            ("<link name=\"a\"/>", "<link name=\"a\"><kinematic>1</kinematic></link>", "kinematic"),
            (
                "<plugin",
                "<plugin name='m' filename='libmimic.so'><joint>g</joint><mimicJoint>j</mimicJoint><square>1</square></plugin><plugin",
                "square",
            ),
            (
                "<plugin",
                "<drake:ball_constraint><drake:ball_constraint_body_A>a</drake:ball_constraint_body_A><drake:ball_constraint_body_B>b</drake:ball_constraint_body_B><stiff/></drake:ball_constraint><plugin",
                "stiff",
            ),
            (
                "<plugin",
                "<mujoco><equality><weld body1='a' body2='b' twist='1'/></equality></mujoco><plugin",
                "twist",
            ),
        ],
    );
}

#[test]
fn in_mjcf() {
    all_named(
        "mjcf",
        MJCF,
        &[
            (r#"name="one" axis"#, r#"name="one" zero="0.5" axis"#, "zero"),
            (r#"<joint damping="1""#, r#"<joint damping="1" zero="0.5""#, "zero"),
            (r#"<equality solref"#, r#"<equality gap="1" solref"#, "gap"),
            (r#"<connect "#, r#"<connect gap="1" "#, "gap"),
            (r#"<weld "#, r#"<weld gap="1" "#, "gap"),
            (r#"<joint joint1"#, r#"<joint gap="1" joint1"#, "gap"),
            (r#"<geom size="0.1"/>"#, r#"<geom size="0.1"/><hinge_frame/>"#, "hinge_frame"),
            (r#"<body name="d""#, r#"<body sag="1" name="d""#, "sag"),
            (r#"<mujoco>"#, r#"<mujoco><compiler foo="bar"/>"#, "foo"),
            (r#"<mujoco>"#, r#"<mujoco><option bar="3"/>"#, "bar"),
            (r#"<mujoco>"#, r#"<mujoco><option><flag weight="disable"/></option>"#, "weight"),
            (r#"<geom size="0.1"/>"#, r#"<geom size="0.1" hollow="true"/>"#, "hollow"),
            (r#"<geom size="0.1"/>"#, r#"<geom size="0.1"><plugin plugin="x"/></geom>"#, "plugin"),
            (r#"<default>"#, r#"<default><geom hollow="true"/>"#, "hollow"),
            (
                r#"<geom size="0.1"/>"#,
                r#"<geom size="0.1"/><inertial pos="0 0 0" mass="1" scale="2"/>"#,
                "scale",
            ),
            (r#"<geom size="0.1"/>"#, r#"<geom size="0.1"/><frame sag="1"/>"#, "sag"),
            (r#"<geom size="0.1"/>"#, r#"<geom size="0.1"/><site name="s" sag="1"/>"#, "sag"),
            (r#"<fixed name="sum""#, r#"<fixed name="sum" slack="1""#, "slack"),
            (r#"<tendon>"#, r#"<deformable/><tendon>"#, "deformable"),
            (r#"<tendon>"#, r#"<extension><plugin plugin="x"/></extension><tendon>"#, "extension"),
        ],
    );
}

#[test]
fn in_adams() {
    let text = std::fs::read_to_string(folder().join("adams/geared.adm")).unwrap();
    all_named(
        "adams",
        &text,
        &[
            ("JOINT/1, REVOLUTE", "JOINT/1, REVOLUTE, ZERO = 0.5", "ZERO"),
            ("JOINT/4, SCREW", "JOINT/4, SCREW, SLACK", "SLACK"),
            ("GEAR/1,", "GEAR/1, PHASE = 3,", "PHASE"),
            ("COUPLER/1,", "COUPLER/1, PHASE = 3,", "PHASE"),
            ("GEAR/1,", "LINKAGE/1, I = 1, J = 2\nGEAR/1,", "LINKAGE"),
            ("GEAR/1,", "GEAR 2, JOINTS = 1, 2\nGEAR/1,", "line"),
            ("GEAR/1,", "GEAR=2/JOINTS = 1, 2\nGEAR/1,", "line"),
        ],
    );
    let press = std::fs::read_to_string(folder().join("adams/press.adm")).unwrap();
    all_named(
        "adams",
        &press,
        &[
            ("JPRIM/4,INLINE", "JPRIM/4,INLINE,OFFSET=2", "OFFSET"),
            ("MOTION/8,TRANSLATIONAL", "MOTION/8,TRANSLATIONAL,PHASE=3", "PHASE"),
        ],
    );
    let loads = "loads\nUNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND\nPART/1, GROUND\nMARKER/1, PART=1\n\
        MARKER/6, PART=1, QP=1,0,0\nPART/2, QG=1,0,0, MASS=3, CM=2, VX=3\nMARKER/2, PART=2\nJOINT/1, REVOLUTE, I=2, J=6\n\
        SPRINGDAMPER/1, I=2, J=1, TRANSLATION, K=3, LENGTH=1\nBUSHING/1, I=2, J=6, K=1,1,1\n\
        SFORCE/1, I=2, J=1, TRANSLATION, FUNCTION=-3*DM(2,1)\nACCGRAV/KGRAV=-9.8\nSPLINE/1, X=1,2,3, Y=1,2,3\nVARIABLE/1, FUNCTION=1\nEND\n";
    all_named(
        "adams",
        loads,
        &[
            ("TRANSLATION, K=3", "TRANSLATION, HHH=1, K=3", "HHH"),
            ("BUSHING/1, I=2", "BUSHING/1, III=1, I=2", "III"),
            ("BUSHING/1, I=2", "BUSHING/1, I=2, I=1", "I"),
            ("QP=1,0,0\n", "QP=1,0,0, QP=2,0,0\n", "QP"),
            ("QP=1,0,0\n", "QP=1,0,0, REULER=0,0,0, ZP=1,0,1\n", "ZP"),
            ("QG=1,0,0", "QG=1,0,0, REULER=0,0,0, EULER=0,0,1", "EULER"),
            ("ACCGRAV/", "MOTION/1, JOINT=1, ROTATIONAL, I=2, FUNCTION=TIME\nACCGRAV/", "I"),
            ("SFORCE/1, I=2", "SFORCE/1, JJJ=1, I=2", "JJJ"),
            ("ACCGRAV/", "ACCGRAV/KKK=1, ", "KKK"),
            ("SPLINE/1, X", "SPLINE/1, FILE=f, X", "FILE"),
            ("VARIABLE/1, F", "VARIABLE/1, NNN=1, F", "NNN"),
            ("UNITS/F", "UNITS/UCF=32, F", "UCF"),
        ],
    );
    // Initial conditions of joints are reported.
    let starts = text.replace("JOINT/1, REVOLUTE", "JOINT/1, REVOLUTE, ICROT = 0.5, 0");
    let imported = hardpoint_import::import(starts.as_bytes(), "geared.adm", &|_| None).unwrap();
    assert_eq!(
        imported.report.of(ElementOutcome::Refused).filter(|e| e.kind == "ICROT").count(),
        1,
        "{}",
        imported.report
    );
}

#[test]
fn in_ondsel() {
    let text = std::fs::read_to_string(folder().join("asmt/slider_crank.asmt")).unwrap();
    let marker = text.lines().find(|l| l.starts_with("\t\t\t\tMarkerI")).unwrap().to_owned();
    let changed = text.replacen(&marker, &format!("\t\t\t\tzeroAt\n\t\t\t\t\t0.5\n{marker}"), 1);
    named_in("asmt", changed.as_bytes(), "zeroAt");
    let changed = text.replacen("\t\tMotions", "\t\tRelations\n\t\t\tRelation\n\t\tMotions", 1);
    named_in("asmt", changed.as_bytes(), "Relations");
}

#[test]
fn in_freecad() {
    let text = std::fs::read_to_string(folder().join("freecad/four_bar/Document.xml")).unwrap();
    let jointed = text.find("name=\"JointType\"").unwrap();
    let at = text[..jointed].rfind("<Property ").unwrap();
    let changed = format!(
        "{}<Property name=\"Zero\" type=\"App::PropertyFloat\"><Float value=\"0.5\"/></Property>{}",
        &text[..at],
        &text[at..]
    );
    named_in("freecad", &crate::document(changed.as_bytes()), "property");
}

#[test]
fn in_suspension_explorer() {
    let text = std::fs::read_to_string(folder().join("suspension-explorer/axle.yaml")).unwrap();
    for (from, to, what) in [
        ("    offset: 0\n", "    offset: 0\n    camber: 2\n", "camber"),
        ("      rim_diameter: 13\n", "      rim_diameter: 13\n      stiffness: 2\n", "stiffness"),
        ("    mount: lower_wishbone\n", "    mount: lower_wishbone\n    ratio: 2\n", "ratio"),
    ] {
        let changed = text.replacen(from, to, 1);
        assert_ne!(changed, text, "{from}");
        named_in("suspension-explorer", changed.as_bytes(), what);
    }
}
