//! Mirrored models: the images are those that one would write by hand, and move as mirror images.

use std::path::Path;

use hardpoint::model::{Model, VariableId};
use hardpoint::{Analysis, Solution};
use hardpoint_file::{ModelFile, parse};

use crate::diagnostics::snapshot;

/// Tolerance of two equivalent models: the same numbers up to signs, so round-off only, relative to the maximum value.
const SAME: f64 = 1e-11;
/// The same of sensitivities, which have the gain of the mechanism once more.
const SAME_RATES: f64 = 1e-9;

fn file(text: &str) -> ModelFile {
    parse(text, "mirror.toml").unwrap_or_else(|e| panic!("{e}"))
}

/// All values of a measure over the time, and by every variable.
fn curves(model: &Model, name: &str) -> (Vec<f64>, Vec<Vec<f64>>) {
    let solution = solved(model);
    let m = model.measures.iter().position(|m| m.name == name).unwrap_or_else(|| panic!("{name}"));
    let steps = 0..model.times.len();
    let values = steps.clone().map(|k| solution.measured.value(k, m)[0]).collect();
    let by = |v| steps.clone().map(|k| solution.measured.d(k, VariableId(v), m)[0]).collect();
    (values, (0..model.variables.len()).map(by).collect())
}

fn solved(model: &Model) -> Solution {
    let solution = Analysis::new(model).unwrap().run();
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    solution
}

fn close(what: &str, a: &[f64], b: &[f64], tolerance: f64) {
    let size = a.iter().filter(|x| x.is_finite()).fold(1e-3_f64, |s, x| s.max(x.abs()));
    assert_eq!(a.len(), b.len(), "{what}");
    for (a, b) in a.iter().zip(b) {
        // What is parallel has no finite instant centre on either side.
        assert!((a - b).abs() <= tolerance * size || a.is_nan() && b.is_nan(), "{what}: {a} {b}");
    }
}

#[test]
fn the_front_axle_has_the_numbers_that_it_has_with_both_sides_written_by_hand() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let short = std::fs::read_to_string(root.join("../../models/front_axle.toml")).unwrap();
    let long = std::fs::read_to_string(root.join("tests/models/front_axle_by_hand.toml")).unwrap();
    assert!(short.lines().count() * 2 < long.lines().count());
    let [mut made, mut by_hand] = [&short, &long].map(|text| file(text).model);
    for model in [&mut made, &mut by_hand] {
        model.times = (0..=40).map(|k| f64::from(k) / 40.0).collect();
    }
    let names = |m: &Model| m.variables.iter().map(|v| v.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&made), names(&by_hand));
    for joint in &by_hand.joints {
        assert!(made.joints.iter().any(|j| j.name == joint.name), "{}", joint.name);
    }
    let [a, b] = [&made, &by_hand].map(solved);
    for (n, measure) in by_hand.measures.iter().enumerate() {
        let m = made.measures.iter().position(|m| m.name == measure.name).unwrap();
        let of = |s: &Solution, m: usize| (0..=40).map(|k| s.measured.value(k, m)[0]).collect::<Vec<_>>();
        close(&measure.name, &of(&b, n), &of(&a, m), SAME);
        for v in (0..made.variables.len()).map(VariableId) {
            let by = |s: &Solution, m: usize| (0..=40).map(|k| s.measured.d(k, v, m)[0]).collect::<Vec<_>>();
            close(&measure.name, &by(&b, n), &by(&a, m), SAME_RATES);
        }
    }
    assert_eq!(made.metrics.len(), by_hand.metrics.len());
}

/// One of nearly everything on the left side: a wishbone that is driven by its angle, a screw and a cylindrical joint
/// with couplers, a rod of a length by an expression, a frame, curves of laws, a shared rack.
const ALL: &str = r#"
name = "everything"
units = { length = "mm", angle = "deg" }
mirror = {}

[parameters]
droop = { value = 5, unit = "length" }
left_arm = { value = 300, unit = "length" }

[hardpoints]
left_front = [100, 200, 20]
left_rear = [-120, 210, -5]
left_ball = [0, "left_rear.y + left_arm", "-droop"]
left_rod_in = [30, 100, 80]
left_nut = [200, 300, 0]
left_pin = [-300, 250, 40]
rack = [30, 0, 80]

[bodies]
left_arm = { frame = { position = [10, 20, 30], euler = [20, 30, 40] } }
left_nut = { frame = { position = [0, 0, 10], cardan = [20, 30, 40] } }
left_pin = { frame = { origin = "left_pin", x = [-200, 250, 50], xy = [-300, 300, 40] } }
left_slide = { frame = { position = [5, 0, 0], roll_pitch_yaw = [-25, 15, 35] } }
rack = {}

[joints]
left_hinge = { type = "revolute", bodies = ["ground", "left_arm"], axis = { through = ["left_rear", "left_front"] } }
left_screw = { type = "screw", bodies = ["ground", "left_nut"], at = "left_nut", axis = [0.2, 1, 0.4], lead = 25 }
left_tube = { type = "cylindrical", bodies = ["ground", "left_pin"], at = "left_pin", axis = [1, 0.5, 0.3] }
left_flat = { type = "planar", bodies = ["ground", "left_slide"], at = [0, 400, 300], axis = [0.1, 0.2, 1], axis2 = [1, 0, -0.1] }
rack_slide = { type = "translational", bodies = ["ground", "rack"], at = "rack", axis = "y" }

[couplers]
left_gears = { type = "gear", joints = ["left_hinge", "left_screw"], teeth = [20, 30] }
left_lever = { type = "linear", terms = [{ joint = "left_tube", coordinate = "displacement", coefficient = 1 }, { joint = "left_tube", coordinate = "angle", coefficient = 0.5 }] }
left_pusher = { type = "linear", terms = [{ joint = "left_flat", coordinate = "y", coefficient = 1 }, { joint = "left_hinge", coefficient = 2 }] }

[drivers]
left_lift = { joint = "left_hinge", law = { type = "harmonic", amplitude = 20, frequency = 1, offset = 2 } }
left_turn = { joint = "left_tube", coordinate = "angle", law = { type = "polynomial", coefficients = [0, 10, 5] } }
left_x = { joint = "left_flat", coordinate = "x", law = "10*t" }
left_yaw = { joint = "left_flat", coordinate = "angle", law = "12*sin(t)" }
steer = { joint = "rack_slide", law = "0" }

[design]
front = { move = "left_front", along = "xyz" }
tilted = { tilt = "left_tube", about = "y" }
longer = { shape = "left_arm", field = { scale = "left_rear", along = "y" } }
turned = { markers = [{ joint = "left_screw", on = "both", turn = [0.2, 0.3, 1], move = [0, 1, 0] }] }

[points]
left_ball = { body = "left_arm", at = "left_ball" }
left_end = { body = "left_pin", at = [-280, 330, 90] }
left_tip = { body = "left_nut", at = [180, 330, 50] }
left_corner = { body = "left_slide", at = [40, 420, 330] }

[measures]
left_height = { type = "position", point = "left_ball", along = "z" }
left_out = { type = "position", point = "left_ball", along = "y" }
left_way = { type = "position", point = "left_end", along = [0.3, 0.8, 0.1] }
left_tip_out = { type = "velocity", point = "left_tip", along = "y" }
left_spin = { type = "angular_velocity", body = "left_nut", along = "y" }
left_corner_out = { type = "position", point = "left_corner", along = "y" }
left_angle = { type = "coordinate", joint = "left_hinge" }
left_advance = { type = "coordinate", joint = "left_screw", coordinate = "displacement" }
left_seen = { type = "angle", from = ["left_ball", "left_tip"], to = [0, 1, 0], about = "x" }
left_sum = { type = "expression", expression = "2*left_ball.y + left_out*3 - left_height" }
left_span = { type = "distance", from = "left_ball", to = "left_end" }

[time]
end = 1.0
steps = 20
"#;

#[test]
fn in_a_motion_that_is_its_own_mirror_image_both_sides_measure_the_same() {
    for (variables, count) in [("symmetric", 7), ("independent", 7)] {
        let text = ALL.replace("mirror = {}", &format!("mirror = {{ variables = \"{variables}\" }}"));
        let model = file(&text).model;
        let mut felt = 0;
        let own = model.variables.iter().filter(|v| !v.name.starts_with("right")).count();
        assert!(own >= count, "{own}");
        let pairs: Vec<_> = model.measures.iter().filter(|m| m.name.starts_with("left")).collect();
        assert_eq!(pairs.len(), 11);
        for left in pairs {
            let right = left.name.replace("left", "right");
            let ((a, da), (b, db)) = (curves(&model, &left.name), curves(&model, &right));
            close(&right, &a, &b, SAME);
            felt += usize::from(da.iter().flatten().any(|x| x.abs() > 1e-6));
            if variables == "symmetric" {
                da.iter().zip(&db).for_each(|(a, b)| close(&right, a, b, SAME_RATES));
            }
        }
        assert!(felt >= 7, "{felt}");
    }
}

#[test]
fn each_side_may_have_its_own_variables_with_mirrored_effects() {
    let named = ALL.replace("front = {", "left_front = {").replace("tilted =", "left_tilted =");
    let text = named.replace("mirror = {}", "mirror = { variables = \"independent\" }");
    let model = file(&text).model;
    let at =
        |name: &str| model.variables.iter().position(|v| v.name == name).unwrap_or_else(|| panic!("{name}"));
    for (left, right, of) in [
        ("left_front_y", "right_front_y", ["left_out", "right_out"]),
        ("left_front_z", "right_front_z", ["left_height", "right_height"]),
        ("left_tilted", "right_tilted", ["left_way", "right_way"]),
        ("left_arm", "right_arm", ["left_out", "right_out"]),
    ] {
        let [(_, a), (_, b)] = of.map(|name| curves(&model, name));
        close(right, &a[at(left)], &b[at(right)], SAME_RATES);
        assert!(a[at(left)].iter().any(|x| x.abs() > 1e-6), "{left} is felt");
        assert!(a[at(right)].iter().all(|x| *x == 0.0), "{right} does nothing on the left");
    }
}

#[test]
fn keys_written_for_the_other_side_take_precedence() {
    let text =
        ALL.replace("mirror = {}", "mirror = { except = [\"left_spin\"], antisymmetric = [\"left_yaw\"] }");
    let text = text
        .replace("left_x = {", "right_lift = { law = 0 }\nleft_x = {")
        .replace("rack = [30, 0, 80]", "rack = [30, 0, 80]\nright_rod_in = [35, -110, 80]");
    let model = file(&text).model;
    let hardpoint = |name: &str| model.hardpoints.iter().find(|h| h.name == name).unwrap().position;
    assert_eq!(hardpoint("right_rod_in").y, -0.11);
    assert_eq!(hardpoint("right_nut").y, -0.3);
    assert!(model.measures.iter().all(|m| m.name != "right_spin"));
    let still = curves(&model, "right_angle").0;
    assert!(still.iter().all(|x| x.abs() < 1e-15), "{still:?}");
    // What does the opposite turns alike, seen from above.
    let [left, right] = ["left_yaw", "right_yaw"].map(|name| {
        let driver = model.drivers.iter().find(|d| d.name == name).unwrap();
        driver.law.at(0.5).value()
    });
    assert!(left > 0.05 && right == -left);
}

#[test]
fn cases_are_those_of_both_sides() {
    let cases = r#"
[cases.bump]
laws = { left_lift = "20*t", left_yaw = "3*t" }

[cases.left_only]
laws = { left_lift = "20*t", steer = "5*t" }
"#;
    let text = ALL.replace("mirror = {}", "mirror = { antisymmetric = [\"left_yaw\", \"steer\"] }") + cases;
    let model = file(&text).model;
    let names: Vec<_> = model.cases.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["bump", "left_only", "right_only"]);
    let law = |case: usize, driver: &str| {
        let d = model.drivers.iter().position(|d| d.name == driver).unwrap();
        model.cases[case].laws[d].as_ref().map_or(0.0, |law| law.at(1.0).value())
    };
    let deg = std::f64::consts::PI / 180.0;
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-14, "{a} {b}");
    close(law(0, "right_lift"), 20.0 * deg);
    close(law(0, "right_yaw"), -3.0 * deg);
    close(law(1, "right_lift"), 0.0);
    close(law(2, "right_lift"), 20.0 * deg);
    close(law(2, "left_lift"), 0.0);
    close(law(2, "steer"), -0.005);
}

#[test]
fn a_changed_design_is_written_at_the_original_or_rejected() {
    let text = ALL.replace("front = {", "left_front = {");
    let both = file(&text);
    let mut design = vec![0.0; both.model.variables.len()];
    design[both.model.variable("left_front_y").unwrap().0] = 0.0025;
    let saved = both.edit(&design).unwrap();
    assert_eq!(saved, text.replace("left_front = [100, 200, 20]", "left_front = [100, 202.5, 20]"));

    let each = file(&text.replace("mirror = {}", "mirror = { variables = \"independent\" }"));
    let mut design = vec![0.0; each.model.variables.len()];
    for (name, others) in [("right_front_y", 0), ("left_front_y", 1)] {
        let mut design = design.clone();
        design[each.model.variable(name).unwrap().0] = 0.0025;
        let refused = each.edit(&design).unwrap_err().to_string();
        assert!(refused.contains("`right_front` is the mirror image of `left_front`"), "{others}: {refused}");
    }
    for name in ["left_front_y", "right_front_y"] {
        design[each.model.variable(name).unwrap().0] = 0.0025;
    }
    let alike = each.edit(&design).unwrap();
    assert!(alike.contains("left_front = [100, 202.5, 20]"));
}

#[test]
fn broken_mirrors() {
    let with = |from: &str, to: &str| {
        assert!(ALL.contains(from), "{from}");
        ALL.replace(from, to)
    };
    for (name, text) in [
        ("mirror_of_nothing", with("mirror = {}", "mirror = { names = { l = \"r\" } }")),
        ("mirror_of_half_words", with("mirror = {}", "mirror = { names = { \"_l\" = \"_r\" } }")),
        ("mirror_that_is_a_word", with("mirror = {}", "mirror = \"y\"")),
        ("mirror_with_misspelt_key", with("mirror = {}", "mirror = { acros = \"y\" }")),
        ("mirror_except_what_is_not_there", with("mirror = {}", "mirror = { except = [\"left_ngle\"] }")),
        ("mirror_opposite_to_no_driver", with("mirror = {}", "mirror = { antisymmetric = [\"left_yow\"] }")),
        // An error on the left is reported for the left, once.
        ("mirrored_joint_with_misspelt_key", with("lead = 25", "leed = 25")),
        ("mirrored_joint_of_no_body", with("\"left_nut\"], at", "\"left_nat\"], at")),
        (
            "mirrored_override_of_two_forms",
            with("left_x = {", "right_lift = { measure = \"right_angle\", along = \"z\" }\nleft_x = {"),
        ),
        (
            "mirrored_coupler_of_an_oblique_joint",
            with(
                "axis = \"y\" }\n\n[couplers]",
                "axis = [1, 1, 0] }\n\n[couplers]\nleft_rack = { type = \"rack\", rack = \"rack_slide\", pinion = \"left_hinge\", radius = 5 }",
            ),
        ),
        ("mirrored_right_alone_is_wrong", with("left_x = {", "right_lift = { law = \"20*s\" }\nleft_x = {")),
    ] {
        snapshot(name, &text);
    }
}

/// The direction whose angle a driver prescribes is mirrored as an arrow, the direction of the view as an axis.
#[test]
fn the_angle_of_an_image_seen_along_a_direction_is_that_of_its_original() {
    let text = r#"
name = "two heads"
units = { length = "m", angle = "deg" }
hardpoints = { left_O = [0, 1, 0] }
bodies = { left = {} }
time = { at = [0, 0.3, 0.7, 1.2] }
[mirror]
across = "y"
names = { left = "right" }
[joints]
left_u = { type = "universal", bodies = ["ground", "left"], at = "left_O", axis = [1, 0.2, 0], axis2 = [0.2, -1, -0.32] }
[drivers]
left_a = { joint = "left_u", coordinate = "angle", law = "30*sin(t)" }
left_h = { body = "left", about = [0.3, -0.1, 1], axis2 = [1, 2, 0], law = "20*sin(2*t) + 5*t" }
[measures]
left_a2 = { type = "coordinate", joint = "left_u", coordinate = "angle2" }
"#;
    let file = parse(text, "heads.toml").unwrap_or_else(|e| panic!("{e}"));
    let solution = Analysis::new(&file.model).unwrap().run();
    let value = |k: usize, name: &str| solution.measured.value(k, solution.measured.index(name).unwrap())[0];
    for k in 0..4 {
        let [left, right] = ["left_a2", "right_a2"].map(|name| value(k, name));
        assert!((left - right).abs() < 1e-12 && (k == 0 || left.abs() > 1e-3), "{left} {right}");
    }
}
