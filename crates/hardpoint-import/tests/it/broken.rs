//! Errors of sources are reported in the terms of the source, with their positions.

use std::fmt::Write;

use crate::folder;

/// Modification of a source: description, original text, replacement.
type Broken = (&'static str, &'static str, &'static str);

fn reported(format: &str, file: &str, changes: &[Broken]) -> String {
    let path = folder().join(file);
    let is_folder = path.is_dir();
    let original = if is_folder { path.join("Document.xml") } else { path.clone() };
    let original = std::fs::read_to_string(original).unwrap();
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    let beside = path.parent().unwrap().to_owned();
    let format = hardpoint_import::Format::named(format).unwrap();
    let mut out = String::new();
    for (what, from, to) in changes {
        let text = if from.is_empty() { (*to).to_owned() } else { original.replacen(from, to, 1) };
        assert_ne!(text, original, "{name}: `{what}` changes nothing");
        let bytes = if is_folder { crate::document(text.as_bytes()) } else { text.into_bytes() };
        let result =
            hardpoint_import::import_as(format, &bytes, &name, &|p| std::fs::read(beside.join(p)).ok());
        writeln!(out, "## {what}").unwrap();
        match result {
            Ok(imported) => match imported.fault {
                Some(fault) => writeln!(out, "{fault}\n").unwrap(),
                None => writeln!(out, "taken:\n{}", imported.report).unwrap(),
            },
            Err(problems) => writeln!(out, "{problems}\n").unwrap(),
        }
    }
    out
}

macro_rules! broken {
    ($($test:ident $format:literal $file:literal: $(($what:literal, $from:literal, $to:literal))*)*) => {
        $(
            #[test]
            fn $test() {
                insta::assert_snapshot!(reported($format, $file, &[$(($what, $from, $to)),*]));
            }
        )*
    };
}

broken! {
    broken_asmt "asmt" "asmt/slider_crank.asmt":
        ("empty", "", " \n")
        ("another file", "", "hello\n")
        ("no assembly", "\nAssembly\n", "\nAssembli\n")
        ("a line too deep", "\tName\n\t\tOndselAssembly", "\tName\n\t\t\t\tOndselAssembly")
        ("a word for a number", "30 \t0 \t0 ", "thirty \t0 \t0 ")
        ("two numbers for three", "30 \t0 \t0 ", "30 \t0 ")
        ("no rotation", "\t1.0 \t0.0 \t0.0 \n", "\t5.0 \t0.0 \t0.0 \n")
        ("a marker that is not there", "/OndselAssembly/Rod/m0", "/OndselAssembly/Rod/m7")
        ("no marker", "\t\t\t\tMarkerI\n\t\t\t\t\t/OndselAssembly/Base/m0\n", "")
        ("an unknown joint", "SphericalJoint", "MagicJoint")
        ("two parts of one name", "\t\t\t\tPiston\n", "\t\t\t\tRod\n")
        ("a joint on one part", "/OndselAssembly/Rod/m1", "/OndselAssembly/Piston/m1")
        ("times that do not divide", "0.02", "0.03")
        ("cut short", "\tSimulationParameters\n", "\tSimul\n")
    broken_adams "adams" "adams/four_bar.adm":
        ("empty", "", " \n")
        ("another file", "", "hello\n")
        ("a word for a number", "QP = 0.4, 0, 0", "QP = far, 0, 0")
        ("two numbers for three", "QP = 0.4, 0, 0", "QP = 0.4, 0")
        ("an unknown unit", "LENGTH = METER", "LENGTH = CUBIT")
        ("a marker that is not there", "I = 6, J = 4", "I = 66, J = 4")
        ("no marker", "I = 6, J = 4", "I = 6")
        ("a marker on no part", "MARKER/7, PART = 3", "MARKER/7, PART = 33")
        ("a part twice", "PART/4, QG", "PART/3, QG")
        ("a marker twice", "MARKER/7, PART", "MARKER/6, PART")
        ("a joint twice", "JOINT/2, REVOLUTE", "JOINT/1, REVOLUTE")
        ("a joint without an identifier", "JOINT/2, REVOLUTE", "JOINT/, REVOLUTE")
        ("two types of a joint", "JOINT/2, REVOLUTE", "JOINT/2, REVOLUTE, SPHERICAL")
        ("a motion twice", "END\n", "MOTION/1, JOINT = 4, ROTATIONAL, FUNCTION = TIME\nEND\n")
        ("a variable twice", "END\n", "VARIABLE/3, FUNCTION = 1\nVARIABLE/3, FUNCTION = 2\nEND\n")
        ("a spline twice", "END\n", "SPLINE/3, X = 0, 1, 2, Y = 0, 1, 2\nSPLINE/3, X = 0, 1, 2, Y = 0, 3, 3\nEND\n")
        ("units twice", "END\n", "UNITS/LENGTH = METER\nEND\n")
        ("a coupler with three scales", "END\n", "COUPLER/1, JOINTS = 1, 4, SCALES = 1, 2, 3\nEND\n")
        ("a gear of three joints", "END\n", "GEAR/1, JOINTS = 1, 4, 99, CV = 1\nEND\n")
        ("an unknown joint", "JOINT/2, REVOLUTE", "JOINT/2, MAGIC")
        ("a motion of a joint that is not there", "JOINT = 1, FUNCTION", "JOINT = 11, FUNCTION")
        ("a function that has no equivalent", "360.0D*time", "VARVAL(3)")
        ("a bracket that is not closed", "360.0D*time", "SIN(time")
        ("a velocity", "ROTATIONAL, JOINT", "ROTATIONAL, VELOCITY, JOINT")
        ("both ends on a part", "I = 6, J = 4", "I = 6, J = 7")
        ("a marker on an elastic part", "MARKER/6, PART = 3", "MARKER/6, FE_PART = 3")
        ("a motion of a joint that is not supported", "JOINT/1, REVOLUTE", "JOINT/1, MAGIC")
        ("a velocity that is constant", "JOINT = 1, FUNCTION = 60D\n, + 360.0D*time", "JOINT = 1, VELOCITY, FUNCTION = 360.0D")
        ("no end", "\nEND\n", "\n")
    broken_urdf "urdf" "urdf/four_bar.urdf":
        ("empty", "", " \n")
        ("another file", "", "<robo/>")
        ("a tag that is not closed", "<link name=\"coupler\"/>", "<link name=\"coupler\">")
        ("a link that is not there", "<child link=\"coupler\"/>", "<child link=\"couple\"/>")
        ("no child", "<child link=\"coupler\"/>", "")
        ("no name", "<link name=\"coupler\"/>", "<link/>")
        ("a name twice", "<link name=\"coupler\"/>", "<link name=\"base\"/>")
        ("a word for a number", "xyz=\"0.4 0 0\"", "xyz=\"0.4 0 zero\"")
        ("a decimal comma", "xyz=\"0.4 0 0\"", "xyz=\"0,4 0 0\"")
        ("no direction", "<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 0\"/>")
        ("an unknown joint", "type=\"continuous\"", "type=\"magic\"")
        ("two orientations", "xyz=\"0.4 0 0\"", "xyz=\"0.4 0 0\" quat_xyzw=\"0 0 0 1\"")
        ("a circle", "<parent link=\"base\"/><child link=\"crank\"/>", "<parent link=\"coupler\"/><child link=\"crank\"/>")
        ("a mimic of nothing", "<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 1\"/><mimic joint=\"other\"/>")
        ("macros", "<robot name=\"four_bar\">", "<robot name=\"four_bar\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\"><xacro:property name=\"a\" value=\"1\"/>")
    broken_sdf "sdf" "sdf/crane.sdf":
        ("empty", "", " \n")
        ("another file", "", "<sd/>")
        ("a tag that is not closed", "<parent>mast</parent>", "<parent>mast")
        ("a link that is not there", "<parent>mast</parent>", "<parent>mest</parent>")
        ("no child", "<child>boom</child>", "")
        ("no name", "<link name=\"wheel\">", "<link>")
        ("a name twice", "<link name=\"wheel\">", "<link name=\"boom\">")
        ("a word for a number", "0.1 0 0 0 0 0", "0.1 0 0 0 0 zero")
        ("no direction", "0 0 1</xyz>", "0 0 0</xyz>")
        ("an unknown joint", "type=\"prismatic\"", "type=\"magic\"")
        ("frames in a circle", "<frame name=\"top\" attached_to=\"mast\"><pose>", "<frame name=\"top\" attached_to=\"mast\"><pose relative_to=\"boom\">")
        ("an axis in no frame", "expressed_in=\"boom\"", "expressed_in=\"bom\"")
        ("a null quaternion", "0 1 0 0 0 0 1", "0 1 0 0 0 0 0")
        ("a mimic of nothing", "<mimic joint=\"travel\">", "<mimic joint=\"other\">")
        ("an included model that is not there", "model://hook", "model://hock")
    broken_mjcf "mjcf" "mjcf/hand.xml":
        ("empty", "", " \n")
        ("another file", "", "<mujo/>")
        ("a tag that is not closed", "</frame>", "")
        ("an included file that is not there", "finger.xml", "fingers.xml")
        ("a word for a number", "pos=\"0 0 0.2\"", "pos=\"0 0 up\"")
        ("two numbers for three", "pos=\"0 0 0.2\"", "pos=\"0 0\"")
        ("no direction", "<joint axis=\"0 1 0\"", "<joint axis=\"0 0 0\"")
        ("two orientations", "pos=\"0 0 0.2\"", "pos=\"0 0 0.2\" euler=\"0.1 0.2 0.3\" quat=\"1 0 0 0\"")
        ("two masses of a body", "childclass=\"hand\">", "childclass=\"hand\"><inertial pos=\"0 0 0\" mass=\"1\"/><inertial pos=\"0 0 0\" mass=\"2\"/>")
        ("two matrices of inertia", "childclass=\"hand\">", "childclass=\"hand\"><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 1\" fullinertia=\"1 1 1 0 0 0\"/>")
        ("an orientation of a matrix of inertia", "childclass=\"hand\">", "childclass=\"hand\"><inertial pos=\"0 0 0\" euler=\"0 0 1\" mass=\"1\" fullinertia=\"1 1 1 0 0 0\"/>")
        ("joints of a class twice", "<compiler ", "<default><joint damping=\"1\"/><joint damping=\"2\"/></default><compiler ")
        ("an unknown joint", "<joint name=\"thumb_joint\"", "<joint type=\"magic\" name=\"thumb_joint\"")
        ("a joint that is not there", "joint2=\"finger_joint\" polycoef", "joint2=\"finger_join\" polycoef")
        ("a relation that is not linear", "0 0.8 0 0 0", "0 0.8 1 0 0")
        ("a constant", "0 0.8 0 0 0", "0.1 0.8 0 0 0")
        ("a weld of a body that is not there", "<joint joint1=\"thumb_joint\" joint2=\"finger_joint\"/>", "<weld body1=\"thum\"/>")
        ("global coordinates", "<compiler ", "<compiler coordinate=\"global\" ")
        ("no sequence", "<compiler ", "<compiler eulerseq=\"abc\" ")
        ("a mesh that is not there", "file=\"phalanx.stl\"", "name=\"phalanx\" file=\"phalan.stl\"")
    broken_suspension_explorer "suspension-explorer" "suspension-explorer/wishbone.yaml":
        ("empty", "", " \n")
        ("another file", "", "hello\n")
        ("no hardpoints", "hardpoints:", "points:")
        ("a bracket that is not closed", "{x: 5, y: 760, z: 170}", "{x: 5, y: 760, z: 170")
        ("a word for a number", "{x: 5, y: 760, z: 170}", "{x: five, y: 760, z: 170}")
        ("two numbers for three", "{x: 5, y: 760, z: 170}", "{x: 5, y: 760}")
        ("a name twice", "upper_wishbone_outboard", "lower_wishbone_outboard")
        ("an unknown unit", "millimeters", "cubits")
        ("an alias", "{x: 5, y: 760, z: 170}", "*point")
        ("pivots at one place", "{x: -210, y: 400, z: 185}", "{x: 200, y: 380, z: 180}")
        ("a rocker without an axis", "rocker_axis_b", "rocker_axis_c")
        ("a rod on nothing known", "mount: lower_wishbone", "mount: moon")
        ("an unknown topology", "  lower_wishbone_outboard", "  lower_wishbone_middle")
    broken_chrono "chrono" "chrono/double_wishbone.json":
        ("empty", "", " \n")
        ("another file", "", "[1, 2]")
        ("a bracket that is not closed", "[0.01, 0.77, -0.13]", "[0.01, 0.77, -0.13")
        ("a comma that is missing", "[0.0, 0.81, 0.0],", "[0.0, 0.81, 0.0]")
        ("a steering", "\"Suspension\"", "\"Steering\"")
        ("an unknown template", "\"DoubleWishbone\"", "\"TripleWishbone\"")
        ("an arm that is missing", "\"Lower Control Arm\"", "\"Lower Arm\"")
        ("a location that is missing", "\"Location Upright\":         [-0.02", "\"Location\":         [-0.02")
        ("a word for a number", "[0.01, 0.77, -0.13]", "[0.01, \"0.77\", -0.13]")
        ("two numbers for three", "[0.01, 0.77, -0.13]", "[0.01, 0.77]")
        ("a key twice", "\"Axle\"", "\"Spring\"")
        ("pivots at one place", "[-0.22, 0.33, -0.10]", "[0.20, 0.33, -0.10]")
        ("no spring", "\"Spring\"", "\"Sprung\"")
    broken_lotus "lotus" "lotus/wishbone.shk":
        ("empty", "", " \n")
        ("another file", "", "hello\n")
        ("no settings", "TEMP_SETTINGS", "SETTINGS")
        ("no numbers of parts and points", "  4  15  0  0  1", "  four parts")
        ("too many points", "  4  15  0  0  1", "  4  16  0  0  1")
        ("far too many points", "  4  15  0  0  1", "  4  1e9  0  0  1")
        ("no block", "FRONT SUSPENSION", "FRONT")
        ("a place too few", "    1248.00000    590.00000    145.00000\n", "")
        ("a word for a number", "    1248.00000    590.00000    145.00000\n", "    1248.00000    590.00000    low\n")
        ("a line too many", "description 1 of lower wishbone front pivot\n", "description\ndescription\n")
        ("an unknown topology", "Upper wishbone outer ball joint\n", "Something else\n")
        ("pivots at one place", "    1415.00000    270.00000    165.00000", "    1105.00000    285.00000    160.00000")
        ("both ends", "REAR END", "REAR SUSPENSION")
    broken_teimorbit "teimorbit" "teimorbit/wishbone.sub":
        ("empty", "", " \n")
        ("another file", "", "hello\n")
        ("no block", "[HARDPOINT]", "[HARDPOINTS]")
        ("a word for a number", "-738.0000     148.0000", "-738.0000     low")
        ("two numbers for three", "-738.0000     148.0000", "-738.0000")
        ("an unknown unit", "'mm'", "'cubit'")
        ("no unit", " LENGTH  =  'mm'\n", "")
        ("other columns", "x_value      y_value     z_value", "u_value      v_value     w_value")
        ("columns in another order", "x_value      y_value     z_value", "z_value      y_value     x_value")
        ("a quote that is not closed", "'lca_outer'", "'lca_outer")
        ("an unknown topology", "'lca_outer'", "'somewhere'")
        ("pivots at one place", "214.0000    -388.0000     170.0000", "-185.0000    -372.0000     162.0000")
    broken_freecad "freecad" "freecad/vise":
        ("empty", "", " ")
        ("another file", "", "<Document/>")
        ("a tag that is not closed", "</Objects>", "")
        ("no assembly", "type=\"Assembly::AssemblyObject\"", "type=\"App::Part\"")
        ("a placement that is none", "Px=\"50.0000000000000000\"", "Px=\"fifty\"")
        ("an unknown joint", "<Enum value=\"Screw\"/>", "<Enum value=\"Magic\"/>")
        ("a part that is not there", "<Sub value=\"Handle.Face1\"/>", "<Sub value=\"Handel.Face1\"/>")
        ("no reference", "name=\"Reference1\"", "name=\"Referenz1\"")
        ("a screw without pitch", "<Float value=\"4.0000000000000000\"/>", "<Float value=\"0\"/>")
        ("nothing grounded", "<Link value=\"Bed\"/>\n                </Property>\n                <Property name=\"Placement\"", "<Link value=\"Nothing\"/>\n                </Property>\n                <Property name=\"Placement\"")
        ("a joint that is not active", "<Bool value=\"true\"/>", "<Bool value=\"false\"/>")
        ("both ends on a part", "<Sub value=\"Handle.Face1\"/>", "<Sub value=\"Jaw.Face1\"/>")
}

#[test]
fn unrecognised_formats_are_reported() {
    let problems = hardpoint_import::import(b"hello", "hello.abc", &|_| None).unwrap_err();
    insta::assert_snapshot!(problems.to_string());
    let zip = crate::document(b"<Document/>");
    let problems = hardpoint_import::import(&zip[..40], "cut.FCStd", &|_| None).unwrap_err();
    insta::assert_snapshot!(problems.to_string());
}

#[test]
fn encodings_and_line_ends_of_other_systems_are_read() {
    for file in [
        "adams/shaper.adm",
        "asmt/contacts.asmt",
        "chrono/three_link.json",
        "lotus/strut.shk",
        "teimorbit/strut.sub",
    ] {
        let text = std::fs::read_to_string(folder().join(file)).unwrap();
        let model = |bytes: &[u8]| {
            let imported = hardpoint_import::import(bytes, file, &|_| None);
            imported.unwrap_or_else(|e| panic!("{file}: {e}")).text
        };
        let wide = |order: fn(u16) -> [u8; 2]| -> Vec<u8> {
            std::iter::once(0xFEFF).chain(text.encode_utf16()).flat_map(order).collect()
        };
        let same = model(text.as_bytes());
        let others = [
            ("a byte order mark", format!("\u{feff}{text}").into_bytes()),
            ("UTF-16, little end first", wide(u16::to_le_bytes)),
            ("UTF-16, big end first", wide(u16::to_be_bytes)),
            ("two characters at ends of lines", text.replace('\n', "\r\n").into_bytes()),
            ("carriage returns alone", text.replace('\n', "\r").into_bytes()),
        ];
        for (what, bytes) in others {
            assert_eq!(model(&bytes), same, "{file}: {what}");
        }
    }
}

#[test]
fn tables_of_hardpoints_are_sent_to_new() {
    let zip = crate::document(b"<Document/>");
    for (bytes, name) in
        [(&b"A,1,2,3\n"[..], "points.csv"), (&zip[..], "points.xlsx"), (&b"hello"[..], "x.abc")]
    {
        let reported = hardpoint_import::import(bytes, name, &|_| None).unwrap_err().to_string();
        assert!(reported.contains("HP0801"), "{reported}");
        assert_eq!(reported.contains("--hardpoints"), name != "x.abc", "{reported}");
    }
}
