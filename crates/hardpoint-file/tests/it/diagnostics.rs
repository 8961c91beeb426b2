//! Diagnostics for each kind of mistake: the full texts are in `tests/snapshots`.

use hardpoint_file::{Diagnostics, parse, read};

pub(crate) const VALID: &str = r#"name = "four-bar"
units = { length = "mm", angle = "deg" }

[hardpoints]
A = [0, 0, 0]
B = [100, 50, 0]
C = [300, 200, 0]
D = [400, 0, 0]

[bodies]
crank = {}
coupler = {}
rocker = {}

[joints.J1]
type = "revolute"
bodies = ["ground", "crank"]
at = "A"
axis = "z"

[joints.J2]
type = "spherical"
bodies = ["crank", "coupler"]
at = "B"

[joints.J3]
type = "universal"
bodies = ["coupler", "rocker"]
at = "C"
axis = "z"
axis2 = "x"

[joints.J4]
type = "cylindrical"
bodies = ["ground", "rocker"]
at = "D"
axis = "z"

[drivers.turn]
joint = "J1"
law = "360*t"

[design.B]
move = "B"
along = "xyz"

[design.lean]
tilt = "J4"
about = "x"

[points.P]
body = "coupler"
at = [200, 150, 20]

[measures.height]
type = "position"
point = "P"
along = "y"

[time]
end = 1.0
steps = 100
"#;

pub(crate) fn snapshot(name: &str, text: &str) {
    let error = parse(text, "four-bar.toml").expect_err(name);
    diagnosed(name, &error, error.to_string());
}

/// Takes a snapshot of the rendered text; every diagnostic must have a suggested fix.
pub(crate) fn diagnosed(name: &str, error: &Diagnostics, shown: String) {
    assert!(!error.list().is_empty(), "{name}");
    for d in error.list() {
        let help = d.help.as_deref().unwrap_or_default();
        assert!(!help.trim().is_empty(), "{name}: {} has no help: {}", d.code, d.message);
    }
    insta::with_settings!({ snapshot_path => "../snapshots", prepend_module_to_snapshot => false, omit_expression => true, description => name }, {
        insta::assert_snapshot!(name, shown);
    });
}

/// The valid model with some of its text replaced.
fn broken(name: &str, replacements: &[(&str, &str)]) {
    let mut text = VALID.to_owned();
    for (old, new) in replacements {
        assert!(text.contains(old), "{name}: {old}");
        text = text.replacen(old, new, 1);
    }
    snapshot(name, &text);
}

#[test]
fn the_valid_model_is_valid() {
    parse(VALID, "four-bar.toml").unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn keys() {
    broken("unknown_key", &[("at = \"A\"", "at = \"A\"\ncolour = \"red\"")]);
    broken("misspelt_key", &[("at = \"A\"", "att = \"A\"")]);
    broken("misspelt_table", &[("[hardpoints]", "[hardpoint]")]);
    broken("missing_key", &[("law = \"360*t\"\n", "")]);
    broken("missing_name", &[("name = \"four-bar\"\n", "")]);
    broken("missing_units", &[("units = { length = \"mm\", angle = \"deg\" }\n", "")]);
    broken(
        "key_below_a_table",
        &[
            ("units = { length = \"mm\", angle = \"deg\" }\n", ""),
            ("[hardpoints]\n", "[hardpoints]\nunits = { length = \"mm\", angle = \"deg\" }\n"),
            ("steps = 100", "steps = 100\ndescription = \"?\""),
        ],
    );
    broken("missing_bodies_of_joint", &[("bodies = [\"ground\", \"crank\"]\n", "")]);
    broken("missing_time", &[("[time]\nend = 1.0\nsteps = 100\n", "")]);
    broken("missing_axis", &[("axis = \"z\"\n\n[joints.J2]", "\n[joints.J2]")]);
    let rod = [
        ("type = \"spherical\"", "type = \"distance\""),
        ("at = \"B\"", "at = [\"B\", \"C\"]\naxis = \"z\""),
    ];
    broken("axis_not_wanted", &rod);
    broken("two_kinds_of_change", &[("along = \"xyz\"", "along = \"xyz\"\ntilt = \"J1\"")]);
    broken("no_kind_of_change", &[("move = \"B\"\nalong = \"xyz\"\n", "fixed_length = true\n")]);
    broken("measure_without_type", &[("type = \"position\"\n", "")]);
    broken("key_of_another_measure", &[("along = \"y\"", "along = \"y\"\nspin_axis = \"y\"")]);
    broken("time_given_twice", &[("end = 1.0", "at = [0, 1]\nend = 1.0")]);
}

#[test]
fn types() {
    broken("wrong_type_of_key", &[("at = \"B\"", "at = \"B\"\ncut = \"yes\"")]);
    broken("wrong_type_of_entry", &[("crank = {}", "crank = 3")]);
    broken(
        "wrong_type_of_table",
        &[("[bodies]\ncrank = {}\ncoupler = {}\nrocker = {}", "[[bodies]]\nname = \"crank\"")],
    );
    broken("two_coordinates", &[("B = [100, 50, 0]", "B = [100, 50]")]);
    broken("coordinate_with_unit", &[("B = [100, 50, 0]", "B = [\"100 mm\", 50, 0]")]);
    broken("coordinate_not_finite", &[("B = [100, 50, 0]", "B = [100, nan, 1e400]")]);
    broken("one_body", &[("bodies = [\"ground\", \"crank\"]", "bodies = \"crank\"")]);
    broken("steps_not_whole", &[("steps = 100", "steps = 0.1")]);
    broken("end_before_start", &[("end = 1.0", "start = 2.0\nend = 1.0")]);
    broken("times_fall", &[("end = 1.0\nsteps = 100", "at = [0, 0.5, 0.25]")]);
}

#[test]
fn words() {
    broken("unknown_unit", &[("\"mm\"", "\"milimeter\"")]);
    broken("unknown_angle_unit", &[("\"deg\"", "\"degrees\"")]);
    broken("unknown_joint_type", &[("\"revolute\"", "\"revolut\"")]);
    broken("unknown_measure_type", &[("\"position\"", "\"positon\"")]);
    broken("unknown_direction", &[("along = \"xyz\"", "along = \"up\"")]);
    broken("unknown_body", &[("[\"crank\", \"coupler\"]", "[\"crank\", \"copler\"]")]);
    broken("unknown_hardpoint", &[("move = \"B\"", "move = \"Bee\"")]);
    broken("unknown_point", &[("point = \"P\"", "point = \"wheel\"")]);
    broken("unknown_joint", &[("joint = \"J1\"", "joint = \"pivot\"")]);
}

#[test]
fn laws() {
    broken("bad_law", &[("360*t", "360*sinn(2*pi*t)")]);
    broken("law_cut_short", &[("360*t", "30*(1 + t")]);
    broken("empty_law", &[("360*t", "")]);
    broken("law_not_finite", &[("360*t", "1/t")]);
    broken("law_with_escapes", &[("\"360*t\"", "\"\\u0033 + q\"")]);
}

#[test]
fn mechanism() {
    broken("zero_axis", &[("axis = \"z\"", "axis = [0, 0, 0]")]);
    broken("axis_through_one_point", &[("axis = \"z\"", "axis = { through = [\"A\", \"A\"] }")]);
    broken("axes_not_square", &[("axis2 = \"x\"", "axis2 = [1, 0, 0.5]")]);
    broken("three_places_for_one", &[("at = \"B\"", "at = [\"B\", \"C\", \"D\"]")]);
    broken("one_place_for_two", &[("type = \"spherical\"", "type = \"distance\"")]);
    broken("joint_of_one_body", &[("[\"crank\", \"coupler\"]", "[\"crank\", \"crank\"]")]);
    broken("loose_body", &[("rocker = {}", "rocker = {}\nspare = {}")]);
    broken("declared_ground", &[("crank = {}", "crank = {}\nground = {}")]);
    broken("no_such_coordinate", &[("joint = \"J1\"", "joint = \"J1\"\ncoordinate = \"length\"")]);
    broken("coordinate_not_said", &[("joint = \"J1\"", "joint = \"J4\"")]);
    broken("driver_on_ball", &[("joint = \"J1\"", "joint = \"J2\"")]);
    broken("names_collide", &[("[design.lean]", "[design.B_x]")]);
    broken("null_move", &[("along = \"xyz\"", "along = [0, 0, 0]")]);
    broken(
        "frame_turned_in_three_ways",
        &[(
            "crank = {}",
            "crank = { frame = { position = \"A\", euler = [0, 1, 2], cardan = [3, 4], quaternion = [1, 0, 0, 0] } }",
        )],
    );
    broken(
        "frame_points_on_a_line",
        &[("crank = {}", "crank = { frame = { origin = \"A\", x = [1, 0, 0], xy = [2, 0, 0] } }")],
    );
    broken(
        "field_on_foreign_body",
        &[(
            "[design.lean]\ntilt = \"J4\"\nabout = \"x\"",
            "[design.tau]\nfields = [{ joint = \"J1\", body = \"rocker\", V = [1, 0, 0] }]",
        )],
    );
}

/// A wheel to append to the valid model.
const WHEEL: &str = r#"
[wheels.front_left]
body = "coupler"
centre = [0, 700, 0]
spin_axis = [0, 1, 0]
radius = 300
kingpin = [{ body = "coupler", at = [0, 600, -100] }, { body = "coupler", at = [0, 580, 100] }]
measures = ["toe", "caster"]

[measures.trail]
type = "mechanical_trail"
wheel = "front_left"
"#;
const KINGPIN: &str =
    "[{ body = \"coupler\", at = [0, 600, -100] }, { body = \"coupler\", at = [0, 580, 100] }]";

fn with_wheel(old: &str, new: &str) -> String {
    assert!(WHEEL.contains(old), "{old}");
    VALID.to_owned() + &WHEEL.replacen(old, new, 1)
}

#[test]
fn wheels() {
    parse(&with_wheel("", ""), "four-bar.toml").unwrap_or_else(|e| panic!("{e}"));
    let broken = |name: &str, old: &str, new: &str| snapshot(name, &with_wheel(old, new));
    let kingpin = format!("kingpin = {KINGPIN}\n");
    let upright = "at = [0, 580, 100]";
    broken("wheel_on_unknown_body", "body = \"coupler\"\ncentre", "body = \"copler\"\ncentre");
    broken("wheel_without_kingpin", &kingpin, "");
    broken("kingpin_at_one_place", upright, "at = [0, 600, -100]");
    broken("kingpin_level", upright, "at = [0, 580, -100]");
    broken("kingpin_upside_down", upright, "at = [0, 580, -300]");
    broken("kingpin_of_three", KINGPIN, "[\"P\", \"P\", \"P\"]");
    broken("kingpin_at_unknown_point", KINGPIN, "[\"P\", \"top\"]");
    let with = |name: &str, more: &str| broken(name, "radius = 300", &format!("radius = 300\n{more}"));
    let plane = |at: &str| {
        format!(
            "arm_planes = [{{ body = \"coupler\", at = [\"B\", \"C\", [0, 0, 9]] }}, {{ body = \"rocker\", at = {at} }}]"
        )
    };
    with("planes_on_a_line", &plane("[\"C\", \"D\", \"C\"]"));
    with("plane_of_a_strut_at_one_place", &plane("[\"C\", \"C\"]"));
    with("plane_of_one_point", &plane("[\"C\"]"));
    with("planes_of_one_arm", "arm_planes = [{ body = \"coupler\", at = [\"B\", \"C\"] }]");
    with(
        "plane_without_body",
        "arm_planes = [{ at = [\"B\", \"C\"] }, { body = \"rocer\", at = [\"B\", \"C\"] }]",
    );
    with("spring_at_one_place", "spring = [\"P\", \"P\"]");
    with("spring_of_one_point", "spring = \"P\"");
    with("steered_by_nothing", "steer = \"turm\"");
    for (name, measure) in [
        ("without_planes", "plane_centre_front_y"),
        ("without_spring", "motion_ratio"),
        ("without_steer", "virtual_caster"),
    ] {
        broken(&format!("wheel_{name}"), "mechanical_trail", measure);
    }
    broken("wheel_of_no_radius", "radius = 300", "radius = 0");
    broken("wheel_axis_vertical", "[0, 1, 0]", "\"z\"");
    broken("wheel_axis_inboard", "[0, 1, 0]", "[0, -1, 0.02]");
    broken("wheel_axis_null", "[0, 1, 0]", "[0, 0, 0]");
    broken("wheel_on_neither_side", "[0, 700, 0]", "[0, 0, 0]");
    broken("wheel_side_misspelt", "radius = 300", "radius = 300\nside = \"lefft\"");
    broken("wheel_without_axis", "spin_axis = [0, 1, 0]\n", "");
    broken("wheel_with_axis_and_angles", "radius = 300", "radius = 300\ntoe = 0.5");
    broken("wheel_with_half_its_angles", "spin_axis = [0, 1, 0]", "toe = 0.5");
    broken("wheel_lying_flat", "spin_axis = [0, 1, 0]", "toe = 0\ncamber = -90");
    broken("wheel_measure_misspelt", "\"caster\"]", "\"castor\"]");
    broken("wheel_measures_of_a_word", "[\"toe\", \"caster\"]", "\"toe\"");
    broken("wheel_measured_twice", "[\"toe\", \"caster\"]", "[\"toe\", \"toe\"]");
    broken("unknown_wheel", "wheel = \"front_left\"", "wheel = \"front_lefft\"");
    broken("measure_without_wheel", "wheel = \"front_left\"\n", "");
    broken(
        "measure_of_wheel_and_body",
        "type = \"mechanical_trail\"",
        "type = \"toe\"\nbody = \"rocker\"\nspin_axis = \"y\"",
    );
    broken("kingpin_of_a_measure", "wheel = \"front_left\"", "wheel = \"front_left\"\nbody = \"rocker\"");
}

#[test]
fn measures_of_measures_metrics_and_shapes() {
    let with = |name: &str, more: &str| snapshot(name, &format!("{VALID}\n{more}\n"));
    with(
        "measure_of_itself",
        "[measures.a]\ntype = \"rate\"\nof = \"b\"\n[measures.b]\ntype = \"rate\"\nof = \"a\"",
    );
    with(
        "rate_of_an_acceleration",
        "[measures.a]\ntype = \"acceleration\"\npoint = \"P\"\n[measures.b]\ntype = \"rate\"\nof = \"a\"",
    );
    with(
        "slope_of_a_velocity",
        "[measures.v]\ntype = \"velocity\"\npoint = \"P\"\n[measures.s]\ntype = \"slope\"\nof = \"v\"\nover = \"height\"",
    );
    with("unknown_name_in_a_formula", "[measures.f]\ntype = \"expression\"\nexpression = \"2*heigth + P.x\"");
    with("angle_of_no_direction", "[measures.g]\ntype = \"angle\"\nfrom = [\"P\", \"P\"]\nto = \"z\"");
    with("metric_without_place", "[metrics.m]\nof = \"height\"\ntake = \"value\"");
    with("metric_window_falls", "[metrics.m]\nof = \"height\"\ntake = \"max\"\nwindow = [3, 1]");
    with("metric_target_out_of_place", "[metrics.m]\nof = \"height\"\ntake = \"mean\"\ntarget = [[0, 1]]");
    with("metric_of_no_measure", "[metrics.m]\nof = \"hight\"\ntake = \"largest\"");
    with("shape_without_field", "[design.s]\nshape = \"rocker\"");
    with("shape_in_two_ways", "[design.s]\nshape = \"rocker\"\nfield = { translate = \"z\", scale = \"A\" }");
    with(
        "shape_that_moves_nothing",
        "[design.s]\nshape = \"rocker\"\nfield = { through = [{ at = \"C\" }, { at = \"D\" }] }",
    );
    with(
        "bend_of_no_beam",
        "[design.s]\nshape = \"rocker\"\nfield = { bend = [\"C\", \"C\"], towards = \"z\" }",
    );
    with(
        "orientation_misspelt",
        "[measures.a]\ntype = \"orientation\"\nbody = \"crank\"\nangle = \"jaw\"\nrelative_to = \"roker\"",
    );
    with("vehicle_of_no_length", "[vehicle]\nwheelbase = -1\nfront_brake_share = 2");
    with("axle_of_no_wheel", "[axles.a]\nleft = \"l\"\nright = \"r\"");
}

/// Consequences of an error in a wheel are not reported.
#[test]
fn consequences_at_wheels_are_not_reported() {
    for (old, new) in [
        ("radius = 300", "radius = \"300\""),
        ("radius = 300", "radius = -1"),
        ("[0, 700, 0]", "[0, \"700\", 0]"),
        ("[0, 700, 0]", "\"hub\""),
        ("[0, 1, 0]", "3"),
        (KINGPIN, "3"),
        (KINGPIN, "[\"P\", 3]"),
        ("radius = 300", "radius = 300\nside = 1"),
        ("body = \"coupler\"\ncentre", "body = 1\ncentre"),
        ("[wheels.front_left]", "[wheels]\nfront_left = 3\n[points.Q]\n#"),
    ] {
        let error = parse(&with_wheel(old, new), "x.toml").unwrap_err();
        if old.starts_with("[wheels") {
            assert!(error.to_string().contains("wheel `front_left` must be a table"), "{error}");
        } else {
            assert_eq!(error.list().len(), 1, "{new}: {error}");
        }
    }
}

/// Errors of a point are not reported again by entries that refer to it.
#[test]
fn measures_of_faulty_points_do_not_matter() {
    let text = r#"
name = "nothing"
units = { length = "mm", angle = "deg" }
bodies = { a = {} }
points = { P = { body = "a", at = "X" }, Q = { body = "a", at = "Y" } }
measures = { d = { type = "distance", from = "P", to = "Q" } }
time = { at = [0] }
"#;
    let error = parse(text, "x.toml").unwrap_err();
    let codes: Vec<&str> = error.list().iter().map(|d| d.code).collect();
    assert_eq!(codes, ["HP0212", "HP0204", "HP0204"], "{error}");
}

#[test]
fn syntax() {
    broken("duplicate_key", &[("at = \"A\"", "at = \"A\"\nat = \"B\"")]);
    broken("duplicate_table", &[("[joints.J2]", "[joints.J1]")]);
    broken("open_text", &[("at = \"A\"", "at = \"A")]);
    broken("open_list", &[("A = [0, 0, 0]", "A = [0, 0, 0")]);
    broken("comma_decimal", &[("B = [100, 50, 0]", "B = [100,5; 50; 0]")]);
    broken("no_quotes", &[("at = \"A\"", "at = A")]);
    snapshot("empty_file", "");
    snapshot("binary_garbage", "\u{0}\u{1}\u{7f}ELF\u{2}\u{1b}[31m\n\u{fffd}\u{fffd} = \u{8}");
    snapshot("deep_nesting", &format!("name = {}", "[".repeat(100_000)));
}

/// Squares and cubes of such lengths overflow.
#[test]
fn lengths_beyond_the_universe_are_reported_where_they_are_written() {
    for (old, new, what) in [
        ("B = [100, 50, 0]", "B = [1e160, 50, 0]", "a coordinate of hardpoint `B`"),
        ("B = [100, 50, 0]", "B = [\"1e200 + 1\", 50, 0]", "`B.x`"),
        ("at = \"A\"", "at = [0, -1e308, 0]", "a coordinate of `J1`"),
    ] {
        let text = VALID.replacen(old, new, 1);
        let error = parse(&text, "x.toml").unwrap_err();
        let [found] = error.list() else { panic!("{new}: {error}") };
        assert_eq!(found.code, "HP0202");
        assert_eq!(found.message, format!("{what} is larger than 1e30 m"));
        assert!(error.to_string().contains(new.split_once(" = ").unwrap().1), "{error}");
    }
    let text = VALID.replacen("B = [100, 50, 0]", "B = [1e30, 50, 0]", 1);
    parse(&text, "x.toml").unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn the_values_of_a_law_are_reported_in_the_unit_of_the_file() {
    let error = parse(&VALID.replace("360*t", "1e308*t"), "x.toml").unwrap_err();
    let [found] = error.list() else { panic!("{error}") };
    assert_eq!(found.code, "HP0214");
    assert!(found.message.contains("changes too fast"), "{error}");
    assert_eq!(found.notes, ["value 0 deg, first derivative 1e308 deg/s, second derivative 0 deg/s^2 there"]);
    let error = parse(&VALID.replace("360*t", "0.25 + sqrt(t)"), "x.toml").unwrap_err();
    assert!(error.to_string().contains("value 0.25 deg, first derivative inf deg/s"), "{error}");
}

#[test]
fn many_signs_are_no_number_in_quotes() {
    let signs = "-".repeat(100_001);
    let text = VALID.replace("B = [100, 50, 0]", &format!("B = [100, \"{signs}1\", 0]"));
    let file = parse(&text, "x.toml").unwrap_or_else(|e| panic!("{}", e.list()[0].message));
    assert_eq!(file.model.hardpoints[1].position.y, -1e-3);
}

#[test]
fn several_problems_at_once() {
    broken(
        "several_problems",
        &[
            ("\"mm\"", "\"milimetre\""),
            ("C = [300, 200, 0]", "C = [300, 200]"),
            ("type = \"revolute\"", "typ = \"revolute\""),
            ("at = \"B\"", "at = \"BB\""),
            ("\"rocker\"]", "\"roker\"]"),
            ("360*t", "360*u"),
            ("point = \"P\"", "point = \"Q\""),
            ("steps = 100", "steps = -5"),
        ],
    );
}

/// Consequences of another problem are not reported.
#[test]
fn consequences_are_not_reported() {
    let long = "x".repeat(101);
    for (old, new) in [
        (
            "[hardpoints]\nA = [0, 0, 0]\nB = [100, 50, 0]\nC = [300, 200, 0]\nD = [400, 0, 0]",
            "[[hardpoints]]",
        ),
        ("[bodies]\ncrank = {}\ncoupler = {}\nrocker = {}", "[[bodies]]"),
        ("A = [0, 0, 0]", "A = [0, \"0\", 0]"),
        ("crank = {}", "crank = { frame = 3 }"),
        ("bodies = [\"ground\", \"crank\"]", "bodies = [\"ground\", 3]"),
        ("type = \"revolute\"", "type = 3"),
        ("type = \"revolute\"", "type = \"hinge\""),
        ("axis = \"z\"", "axis = \"w\""),
        ("at = \"A\"", "at = 3"),
        ("joint = \"J1\"", "joint = 3"),
        ("law = \"360*t\"", "law = true"),
        ("move = \"B\"", "move = [1, 2]"),
        ("along = \"xyz\"", "along = 3"),
        ("tilt = \"J4\"", "titl = \"J4\""),
        ("body = \"coupler\"", "body = 3"),
        ("type = \"position\"", "type = \"height\""),
        ("steps = 100", "steps = \"many\""),
        ("end = 1.0", "ende = 1.0"),
        ("move = \"B\"", &format!("move = \"{long}\"")),
    ] {
        let text = VALID.replacen(old, new, 1);
        let error = parse(&text, "x.toml").unwrap_err();
        let expected = if new.contains("[1, 2]") { 2 } else { 1 };
        assert_eq!(error.list().len(), expected, "{new}: {error}");
    }
}

#[test]
fn line_ends_and_byte_order_mark_do_not_matter() {
    let bad = VALID.replacen("at = \"A\"", "at = \"ä\", colour = 1", 1);
    let place = |text: &str| {
        let e = parse(text, "x.toml").unwrap_err();
        (e.list()[0].line, e.list()[0].column)
    };
    assert_eq!(place(&bad), place(&bad.replace('\n', "\r\n")));
    assert!(parse(&format!("\u{feff}{VALID}"), "x.toml").is_ok());
    assert!(parse(&VALID.replace('\n', "\r\n"), "x.toml").is_ok());
}

#[test]
fn color_only_adds_escapes() {
    let error = parse(&VALID.replace("at = \"A\"", "att = \"A\""), "four-bar.toml").unwrap_err();
    let colored = error.render(true);
    assert!(colored.contains("\u{1b}["));
    let mut plain = String::new();
    let mut rest = colored.as_str();
    while let Some((before, after)) = rest.split_once("\u{1b}[") {
        plain.push_str(before);
        rest = after.split_once('m').unwrap().1;
    }
    plain.push_str(rest);
    assert_eq!(plain, error.render(false));
}

#[test]
fn json_has_the_place() {
    let error = parse(&VALID.replace("at = \"A\"", "att = \"A\""), "four-bar.toml").unwrap_err();
    let json = serde_json::to_value(&error).unwrap();
    let first = &json[0];
    assert_eq!(first["severity"], "error");
    assert_eq!(first["code"], "HP0103");
    assert_eq!((first["line"].as_u64(), first["column"].as_u64()), (Some(18), Some(1)));
    assert_eq!(first["file"], "four-bar.toml");
}

#[test]
fn unreadable_files() {
    let dir = tempfile::tempdir().unwrap();
    let path = |name: &str| dir.path().join(name);
    std::fs::write(path("strut.toml"), VALID).unwrap();
    std::fs::write(path("latin1.toml"), b"name = \"Lenker\"\n# vorn \xfcber\n").unwrap();
    let folder = dir.path().display().to_string();
    let shown = |name: &str| read(&path(name)).unwrap_err().to_string().replace(&folder, "DIR");
    let all = ["strutt.toml", "nowhere/x.toml", "", "latin1.toml"].map(shown).join("\n\n");
    insta::with_settings!({ snapshot_path => "../snapshots", prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!("unreadable_files", all);
    });
    let huge = std::fs::File::create(path("huge.toml")).unwrap();
    huge.set_len(65 << 20).unwrap();
    assert!(shown("huge.toml").contains("it has 65 MiB; at most 64 MiB are read"));
    assert!(read(&path("strut.toml")).is_ok());
}

#[test]
fn many_problems_are_cut_short() {
    let mut text = VALID.to_owned();
    for k in 0..3000 {
        text.push_str(&format!("[points.X{k}]\nbody = \"nobody{k}\"\nat = \"nowhere{k}\"\n"));
    }
    let error = parse(&text, "many.toml").unwrap_err();
    assert_eq!(error.list().len(), 6000);
    let shown = error.to_string();
    assert!(shown.contains("... and 5950 more like these"));
    assert!(shown.len() < 100_000, "{}", shown.len());
}

/// The valid model with parameters, and with some of its text replaced.
fn broken_parameters(name: &str, replacements: &[(&str, &str)]) {
    let parameters = "[parameters]\nL = { value = 100, unit = \"length\" }\nphi = { value = 30, unit = \"angle\" }\n\
                      k = 2\nfixed = { value = 3, design = false }\n\n[hardpoints]";
    let all: Vec<_> =
        [("[hardpoints]", parameters)].into_iter().chain(replacements.iter().copied()).collect();
    broken(name, &all);
}

#[test]
fn parameters() {
    let cases: [(&str, &str, &str); 12] = [
        ("parameter_named_like_a_function", "k = 2", "sin = 2"),
        ("parameter_with_a_hyphen", "k = 2", "k-1 = 2"),
        ("parameter_with_unknown_unit", "value = 100, unit = \"length\"", "value = 100, unit = \"mm\""),
        ("parameter_without_value", "value = 100, unit", "unit"),
        ("parameter_of_a_list", "k = 2", "k = [1, 2]"),
        ("parameters_in_a_circle", "k = 2", "k = \"m - 1\"\nm = \"n*2\"\nn = \"k/3\""),
        ("parameter_of_itself", "k = 2", "k = \"k + 1\""),
        ("parameter_out_of_bounds", "k = 2", "k = { value = 2, bounds = [3, 4] }"),
        ("parameter_with_falling_bounds", "k = 2", "k = { value = 2, bounds = [4, 1] }"),
        ("parameter_of_negative_size", "k = 2", "k = { value = 2, typical = -1 }"),
        ("derived_parameter_with_bounds", "k = 2", "k = { value = \"2*L\", bounds = [1, 2] }"),
        (
            "parameter_and_variable_of_one_name",
            "[design.B]",
            "[design.k]\nmove = \"A\"\nalong = \"x\"\n\n[design.B]",
        ),
    ];
    for (name, old, new) in cases {
        broken_parameters(name, &[(old, new)]);
    }
}

#[test]
fn expressions() {
    let at_b = [
        ("expression_with_unknown_parameter", "\"2*M\""),
        ("expression_not_closed", "\"2*(L + 1\""),
        ("expression_of_the_time", "\"L*t\""),
        ("expression_of_unknown_hardpoint", "\"E.x\""),
        ("expression_of_unknown_coordinate", "\"C.u\""),
        ("expression_of_a_hardpoint_without_coordinate", "\"C + 1\""),
        ("expression_not_finite", "\"L/(k - 2)\""),
        ("expression_without_derivative", "\"100 + sqrt(k - 2)\""),
        ("expression_of_itself", "\"B.x + L\""),
    ];
    for (name, text) in at_b {
        broken_parameters(name, &[("B = [100, 50, 0]", &format!("B = [{text}, 50, 0]"))]);
    }
    broken_parameters(
        "hardpoints_in_a_circle",
        &[
            ("B = [100, 50, 0]", "B = [\"C.x - 200\", 50, 0]"),
            ("C = [300, 200, 0]", "C = [\"B.x + 200\", 200, 0]"),
        ],
    );
    broken_parameters("point_with_unknown_parameter", &[("at = [200, 150, 20]", "at = [\"2*M\", 150, 20]")]);
    let fixed: [(&str, &str, &str); 7] = [
        ("axis_that_cannot_follow", "axis = \"z\"\naxis2", "axis = [0, 0, \"k\"]\naxis2"),
        ("axis_of_a_coordinate", "axis = \"z\"\naxis2", "axis = [0, 0, \"B.x\"]\naxis2"),
        ("frame_that_cannot_follow", "crank = {}", "crank = { frame = { position = [\"L\", 0, 0] } }"),
        ("law_that_cannot_follow", "\"360*t\"", "{ type = \"harmonic\", amplitude = \"k\", frequency = 1 }"),
        ("law_with_an_angle", "\"360*t\"", "\"phi*t\""),
        ("law_with_a_misspelt_parameter", "\"360*t\"", "\"360*t*fixxed\""),
        ("derived_parameter_that_cannot_follow", "end = 1.0", "end = \"late\""),
    ];
    for (name, old, new) in fixed {
        broken_parameters(name, &[("k = 2", "k = 2\nlate = \"k + fixed\""), (old, new)]);
    }
    broken("expression_without_parameters", &[("B = [100, 50, 0]", "B = [\"L\", 50, 0]")]);
}

#[test]
fn mirrors() {
    broken("mirror_without_mirrored", &[("along = \"xyz\"", "along = \"xyz\"\nmirror = \"y\"")]);
    broken("mirrored_without_mirror", &[("along = \"xyz\"", "along = \"xyz\"\nmirrored = \"C\"")]);
    broken("mirror_of_no_axis", &[("along = \"xyz\"", "along = \"xyz\"\nmirror = \"-y\"\nmirrored = \"C\"")]);
    broken(
        "mirrored_unknown_hardpoint",
        &[("along = \"xyz\"", "along = \"x\"\nmirror = \"y\"\nmirrored = \"Z\"")],
    );
    broken("bounds_of_a_variable", &[("along = \"xyz\"", "along = \"x\"\nbounds = [1, 5]")]);
}

/// The remarks of the valid model with some of its text replaced: code, headline, notes and help.
fn remarks(old: &str, new: &str) -> Vec<(String, String)> {
    assert!(VALID.contains(old), "{old}");
    let file = parse(&VALID.replacen(old, new, 1), "four-bar.toml").unwrap_or_else(|e| panic!("{e}"));
    let text = |d: &hardpoint_file::Diagnostic| file.render(d, false);
    file.remarks.iter().map(|d| (d.code.to_owned(), text(d))).collect()
}

#[test]
fn degrees_in_functions_are_reported_and_radians_are_not() {
    for (law, right) in [
        ("sin(360*t)", "sin(2*pi*t)"),
        ("20 + 10*cos( 90 * t )", "cos(pi/2*t)"),
        ("sin(90)", "sin(pi/2)"),
        ("5*tan(-30*t)", "tan(-pi/6*t)"),
        ("10*sin(t*720/2)", "sin(2*pi*t)"),
        ("10*sin(360*t + 90)", "sin(2*pi*t + pi/2)"),
        ("10*sin(4*t - 180)", "sin(4*t - pi)"),
        ("if(t < 1, (sin(60*(t + 0))), 2)", "sin(pi/3*t)"),
    ] {
        let found = remarks("360*t", law);
        assert_eq!(found.len(), 1, "{law}: {found:?}");
        let (code, text) = &found[0];
        assert!(code == "HP0114" && text.contains(&format!("write `{right}`")), "{law}: {text}");
        assert!(text.contains("^"), "{text}");
    }
    for law in [
        "360*t",
        "10*sin(2*pi*t)",
        "10*sin(2*pi*60*t)",
        "10*sin(360*pi/180*t)",
        "10*sin(6.283*t)",
        "10*sin(20*t)",
        "10*sin(45*t)",
        "10*sin(30*t^2)",
        "asin(0.5*sin(t)) + 360",
        "10*sin(sin(t) + 1)",
        "90",
    ] {
        assert_eq!(remarks("360*t", law), [], "{law}");
    }
    // In a file in rad nobody expects degrees.
    let rad = VALID.replacen("angle = \"deg\"", "angle = \"rad\"", 1).replacen("360*t", "sin(360*t)", 1);
    assert_eq!(parse(&rad, "four-bar.toml").unwrap().remarks, []);
}

#[test]
fn models_of_the_gallery_give_no_rise_to_warnings() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../models");
    let mut models = 0;
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        if entry.path().extension().is_some_and(|e| e == "toml") {
            let file = read(&entry.path()).unwrap_or_else(|e| panic!("{e}"));
            let shown: Vec<_> = file.remarks.iter().map(|d| file.render(d, false)).collect();
            let warnings = file.remarks.iter().filter(|d| d.severity != hardpoint_file::Severity::Note);
            assert_eq!(warnings.count(), 0, "{shown:?}");
            models += 1;
        }
    }
    assert!(models > 30);
}

#[test]
fn measures_that_all_leaves_out_are_named_with_the_reason() {
    let wheel = "[wheels.w]\nbody = \"rocker\"\ncentre = \"C\"\nspin_axis = \"y\"\nradius = 50\nside = \"left\"\nmeasures = \"all\"\n\n[time]";
    let with = |more: &str| {
        let text = VALID.replacen("[time]", wheel, 1).replacen("spin_axis = \"y\"", more, 1);
        parse(&text, "four-bar.toml").unwrap_or_else(|e| panic!("{e}"))
    };
    // The only driver moves the wheel up and down.
    let file = with("spin_axis = \"y\"");
    assert!(file.model.measure("w.bump_steer").is_some());
    assert!(file.model.measure("w.caster").is_none());
    let [note] = &file.remarks[..] else { panic!("{:?}", file.remarks) };
    assert_eq!((note.code, note.severity), ("HP0503", hardpoint_file::Severity::Note));
    assert!(note.notes[0].starts_with("the wheel has no `kingpin`, so there is no `caster`, "), "{note:?}");
    assert!(file.render(note, false).starts_with("note[HP0503]"));
    // Measures that are listed by name are chosen on purpose.
    let listed = VALID.replacen("[time]", &wheel.replace("\"all\"", "[\"toe\"]"), 1);
    assert_eq!(parse(&listed, "four-bar.toml").unwrap().remarks, []);
    // Of two drivers it takes neither, and says so.
    let two = "[bodies]\nspare = {}\n";
    let more = "[joints.J5]\ntype = \"revolute\"\nbodies = [\"ground\", \"spare\"]\nat = \"A\"\naxis = \"z\"\n\n\
                [drivers.other]\njoint = \"J5\"\nlaw = \"t\"\n\n[time]";
    let text = VALID.replacen("[time]", wheel, 1).replacen("[bodies]\n", two, 1).replacen("[time]", more, 1);
    let file = parse(&text, "four-bar.toml").unwrap_or_else(|e| panic!("{e}"));
    assert!(file.model.measure("w.bump_steer").is_none());
    let text = file.render(&file.remarks[0], false);
    assert!(text.contains("`bump` is missing: 2 drivers") && text.contains("`bump_steer`"), "{text}");
    assert!(text.contains("= help: "), "{text}");
}

/// A four-bar with two lengths and a plain number, and a calibration of them.
fn calibration(name: &str, table: &str) {
    let variables = "[design.lean]\ntilt = \"J4\"\nabout = \"x\"\n";
    assert!(VALID.contains(variables));
    broken(name, &[(variables, &format!("{variables}\n{table}\n"))]);
}

#[test]
fn invalid_priors_are_reported_with_their_places() {
    calibration("calibrate_sigma_of_zero", "[calibrate.variables]\nB_x = 0\n");
    calibration("calibrate_negative_sigma", "[calibrate.variables]\nB_x = { sigma = -1, mean = 2 }\n");
    calibration("calibrate_without_sigma", "[calibrate.variables]\nB_x = { mean = 2 }\n");
    calibration("calibrate_unknown_variable", "[calibrate.variables]\nB_w = 1\n");
    calibration(
        "calibrate_prior_of_a_variable_that_is_not_fitted",
        "[calibrate]\nfit = [\"B_x\", \"B_y\"]\nvariables = { B_z = 1 }\n",
    );
    calibration("calibrate_fit_twice", "[calibrate]\nfit = [\"B_x\", \"B_x\"]\n");
    calibration("calibrate_without_tolerances", "[calibrate]\npriors = \"tolerances\"\n");
    calibration("calibrate_misspelt_source", "[calibrate]\npriors = \"tolerance\"\n");
    calibration("calibrate_group_of_one", "[calibrate.groups.g]\nvariables = [\"B_x\"]\nwithin = 0.1\n");
    calibration(
        "calibrate_group_of_two_units",
        "[calibrate.groups.g]\nvariables = [\"B_x\", \"lean\"]\nwithin = 0.1\n",
    );
    calibration(
        "calibrate_group_twice_the_same",
        "[calibrate.groups.g]\nvariables = [\"B_x\", \"B_x\"]\nwithin = 0.1\n",
    );
    calibration(
        "calibrate_group_within_zero",
        "[calibrate.groups.g]\nvariables = [\"B_x\", \"B_y\"]\nwithin = 0\n",
    );
    calibration(
        "calibrate_group_of_a_variable_that_is_not_fitted",
        "[calibrate]\nfit = [\"B_x\"]\n[calibrate.groups.g]\nvariables = [\"B_x\", \"B_y\"]\nwithin = 1\n",
    );
    calibration("calibrate_offset_unknown", "[calibrate]\noffsets = [\"trun\"]\n");
    calibration(
        "calibrate_offset_twice",
        "[calibrate]\noffsets = [\"turn\", { of = \"turn\", sigma = 1 }]\n",
    );
    calibration(
        "calibrate_offset_of_negative_sigma",
        "[calibrate]\noffsets = [{ of = \"turn\", sigma = -1 }]\n",
    );
    calibration("calibrate_offset_of_no_name", "[calibrate]\noffsets = [3]\n");
}

#[test]
fn two_coordinates_of_a_point_are_all_three_in_a_model_without_a_plane() {
    for word in ["xy", "zx"] {
        let text = VALID.replace("along = \"xyz\"", &format!("along = \"{word}\""));
        let found = parse(&text, "four_bar.toml").unwrap_err();
        let diagnostic = found.list().iter().find(|d| d.code == "HP0106").unwrap();
        let help = diagnostic.help.as_deref().unwrap();
        assert!(help.starts_with("did you mean `xyz`?"), "{help}");
    }
}

/// A misspelt table beside the one that is meant is reported once, and its entries are read.
#[test]
fn a_misspelt_table_beside_the_right_one_has_no_consequences() {
    for (right, wrong, help) in [
        ("[joints.J1]", "[joint.J1]", "move its entries to `joints`"),
        ("[measures.", "[measure.", "move its entries to `measures`"),
    ] {
        let other = "\n[measures.again]\ntype = \"position\"\npoint = \"P\"\nalong = \"x\"\n";
        let text = VALID.to_owned() + other;
        parse(&text, "x.toml").unwrap_or_else(|e| panic!("{e}"));
        assert!(text.matches(right.split('.').next().unwrap()).count() > 1, "{right}");
        let error = parse(&text.replacen(right, wrong, 1), "x.toml").unwrap_err();
        let [only] = error.list() else { panic!("{error}") };
        assert_eq!((only.code, only.help.as_deref()), ("HP0103", Some(help)), "{error}");
        let meant = help.trim_start_matches("move its entries to ");
        assert!(only.message.ends_with(&format!("did you mean {meant}?")), "{error}");
    }
    // Of a value there is nothing to move.
    let error = parse(&VALID.replacen("steps = 100", "steps = 100\nstep = 3", 1), "x.toml").unwrap_err();
    let [only] = error.list() else { panic!("{error}") };
    assert_eq!(only.help.as_deref(), Some("`steps` is given already: remove `step`"));
}
