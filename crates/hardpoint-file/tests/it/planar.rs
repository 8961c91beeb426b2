//! Mechanisms in a plane, with all left out that the plane says.

use hardpoint::Analysis;
use hardpoint::model::Model;
use hardpoint_file::{ModelFile, parse, read};

use crate::diagnostics::snapshot;

/// Two ways to say the same mechanism solve the same equations in other orders.
const SAME: f64 = 1e-12;

fn file(text: &str) -> ModelFile {
    parse(text, "planar.toml").unwrap_or_else(|e| panic!("{e}"))
}

/// The four-bar of the document.
fn six_lines() -> String {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(root.join("../../docs/file-format.md")).unwrap();
    let block = text.split("## `planar`").nth(1).and_then(|rest| rest.split("```text\n").nth(1));
    block.and_then(|rest| rest.split("```").next()).unwrap().to_owned()
}

/// Where a point is at each output time, in m.
fn path(model: &Model, name: &str) -> Vec<[f64; 3]> {
    let solution = Analysis::new(model).unwrap().run();
    assert!(solution.stop.is_none());
    let of = |axis: &str| {
        let all = hardpoint::measure::outputs(model);
        let m = all.iter().position(|o| o.name == format!("{name}.{axis}")).unwrap();
        (0..model.times.len()).map(|k| solution.measured.value(k, m)[0]).collect::<Vec<_>>()
    };
    let [x, y, z] = ["x", "y", "z"].map(of);
    (0..x.len()).map(|k| [x[k], y[k], z[k]]).collect()
}

#[test]
fn a_four_bar_in_six_lines_moves_as_the_published_one() {
    let text = six_lines();
    assert_eq!(text.lines().count(), 6);
    let file = file(&text);
    assert!(file.remarks.is_empty());
    let names = |list: Vec<&str>| list.join(" ");
    assert_eq!(names(file.model.joints.iter().map(|j| j.name.as_str()).collect()), "A D B C");
    assert_eq!(names(file.model.points.iter().map(|p| p.name.as_str()).collect()), "P");
    assert_eq!(file.model.times.len(), 101);

    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut published = read(&root.join("../../models/four_bar.toml")).unwrap().model;
    published.times = file.model.times.clone();
    for (a, b) in path(&file.model, "P").iter().zip(path(&published, "midpoint")) {
        assert!((0..3).all(|k| (a[k] - b[k]).abs() < SAME), "{a:?} {b:?}");
    }
}

#[test]
fn every_plane_has_the_same_motion() {
    let text = six_lines();
    let xy = path(&file(&text).model, "P");
    for (plane, axes) in [("yz", [1, 2, 0]), ("zx", [2, 0, 1]), ("xz", [0, 2, 1])] {
        let other = file(&text.replace("\"xy\"", &format!("\"{plane}\"")));
        assert_eq!(other.plane.map(|p| p.axes), Some([axes[0], axes[1]]));
        for (a, b) in path(&other.model, "P").iter().zip(&xy) {
            let turned = axes.map(|k| a[k]);
            assert!((0..3).all(|k| (turned[k] - b[k]).abs() < SAME), "{plane}: {a:?} {b:?}");
        }
    }
}

#[test]
fn variables_along_the_plane_are_saved_where_two_coordinates_stand() {
    for (plane, first, second) in [("xy", "x", "y"), ("yz", "y", "z"), ("zx", "z", "x"), ("xz", "x", "z")] {
        let text = six_lines().replace("\"xy\"", &format!("\"{plane}\""));
        let text = format!("{text}design.B = {{ move = \"B\", along = \"{plane}\" }}\n");
        let file = file(&text);
        let mut design = vec![0.0; 2];
        for (axis, by) in [(first, 0.001), (second, -0.0025)] {
            design[file.model.variable(&format!("B_{axis}")).unwrap().0] = by;
        }
        let saved = file.edit(&design).unwrap();
        assert_eq!(saved, text.replace("B = [40, 200]", "B = [41, 197.5]"), "{plane}");
    }
}

#[test]
fn what_is_written_of_a_pin_counts_more_and_three_bodies_may_meet_there() {
    let text = r#"
name = "crank and two sliders"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { A = [0, 0], B = [50, 20], C = [200, 0], D = [60, 180], M = ["(B.x + C.x)/2", "(B.y + C.y)/2"] }
bodies = { ground = ["A", "C", "D"], crank = ["A", "B"], rod = ["B", "M"], slider = ["C"], tall = ["B"], riser = ["D"] }
drivers.motor = { joint = "A", law = "360*t" }
joints.C = { type = "translational", axis = [1, 0] }
joints.D = { type = "translational", axis = [0, 1] }
joints.rod_end = { type = "revolute", bodies = ["rod", "slider"], at = "C" }
joints.tall_end = { type = "revolute", bodies = ["tall", "riser"], at = "D" }
measures.lean = { type = "angle", from = [1, 0], to = ["B", "M"] }
points.B = { body = "rod", at = "B" }
"#;
    let model = file(text).model;
    let joints: Vec<_> = model.joints.iter().map(|j| (j.name.as_str(), j.kind.name)).collect();
    for expected in [
        ("A", "revolute"),
        ("B", "revolute"),
        ("B_tall", "revolute"),
        ("C", "translational"),
        ("D", "translational"),
    ] {
        assert!(joints.contains(&expected), "{joints:?}");
    }
    let solution = Analysis::new(&model).unwrap().run();
    let m = model.measures.iter().position(|m| m.name == "lean").unwrap();
    // From B down to C: sin(lean) = -20 / |BC| as drawn.
    let expected = -(20_f64 / 150.0).atan();
    assert!((solution.measured.value(0, m)[0] - expected).abs() < SAME);
}

/// A toggle whose sides meet on a slider, and a pair of scissors whose sides meet each other: where a hardpoint lies in the mirror, the
/// hinges on it are made for both sides.
#[test]
fn bodies_by_points_are_mirrored_with_the_hinges_where_both_sides_meet() {
    let toggle = r#"
name = "toggle"
units = { length = "mm", angle = "deg" }
planar = "xy"
mirror = { across = "x" }
hardpoints = { left_A = [-40, 0], left_B = [-60, 50], S = [0, 130] }
bodies = { ground = ["left_A"], left_crank = ["left_A", "left_B"], left_link = ["left_B", "S"], slider = ["S"] }
joints.guide = { type = "translational", bodies = ["ground", "slider"], at = "S", axis = [0, 1] }
drivers.up = { joint = "guide", law = "15*sin(2*pi*t)" }
measures.left_angle = { type = "coordinate", joint = "left_A" }
"#;
    let model = file(toggle).model;
    let bodies_of = |model: &Model, name: &str| {
        let joint = model.joints.iter().find(|j| j.name == name).unwrap_or_else(|| panic!("{name}"));
        joint.bodies.map(|b| model.bodies[b.0].name.clone())
    };
    assert_eq!(bodies_of(&model, "S_left_link"), ["slider", "left_link"]);
    assert_eq!(bodies_of(&model, "S_right_link"), ["slider", "right_link"]);
    let solution = Analysis::new(&model).unwrap().run();
    assert!(solution.stop.is_none());
    let angle = |side: &str| solution.measured.index(&format!("{side}_angle")).unwrap();
    for k in 0..=100 {
        let [left, right] = ["left", "right"].map(|side| solution.measured.value(k, angle(side))[0]);
        assert!((left - right).abs() < SAME && (k != 25 || left.abs() > 0.1), "{k}: {left} {right}");
    }

    let scissors = r#"
name = "scissors"
units = { length = "mm", angle = "deg" }
planar = "xy"
mirror = { across = "x" }
hardpoints = { left_foot = [-50, 0], P = [0, 80] }
bodies = { left_slide = ["left_foot"], left_arm = ["left_foot", "P"] }
joints.left_rail = { type = "translational", bodies = ["ground", "left_slide"], at = "left_foot", axis = [1, 0] }
drivers.left_rail = { joint = "left_rail", law = "20*t" }
points.top = { body = "left_arm", at = "P" }
"#;
    let model = file(scissors).model;
    assert_eq!(bodies_of(&model, "P"), ["left_arm", "right_arm"]);
    for (k, [x, y, _]) in path(&model, "top").into_iter().enumerate() {
        let foot = 0.05 - 0.02 * k as f64 / 100.0;
        let expected = (0.05_f64.powi(2) + 0.08_f64.powi(2) - foot * foot).sqrt();
        assert!(x.abs() < SAME && (y - expected).abs() < SAME, "{k}: {x} {y} {expected}");
    }
}

#[test]
fn broken_planar_models() {
    let with = |from: &str, to: &str| {
        let text = six_lines();
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    };
    for (name, text) in [
        ("planar_in_no_plane", with("\"xy\"", "\"zy\"")),
        ("planar_point_of_one_coordinate", with("[40, 200]", "[40]")),
        ("planar_body_of_numbers", with("[\"A\", \"B\"]", "[\"A\", 5]")),
        ("planar_body_at_no_hardpoint", with("[\"C\", \"D\"]", "[\"C\", \"E\"]")),
        ("planar_body_with_a_point_twice", with("[\"A\", \"B\"]", "[\"A\", \"B\", \"A\"]")),
        (
            "planar_measure_of_a_hardpoint",
            six_lines() + "measures.height = { type = \"position\", point = \"C\", along = \"y\" }\n",
        ),
        ("body_of_points_in_space", with("planar = \"xy\"\n", "")),
    ] {
        snapshot(name, &text);
    }
}
