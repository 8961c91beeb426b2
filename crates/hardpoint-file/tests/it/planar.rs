//! Planar mechanisms in their shorthand form.

use hardpoint::Analysis;
use hardpoint::draft::{ElementType, MeasureType};
use hardpoint::joint::{self, Need};
use hardpoint::model::Model;
use hardpoint::space::Vec3;
use hardpoint_file::{ModelFile, parse, read};

use crate::diagnostics::snapshot;
use crate::sides::{CoordinateEntries, Leg, declared};

/// Tolerance of two equivalent models, which solve the same equations in another order.
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

/// Positions of a point at all output times, in m.
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
fn a_variable_in_both_axes_does_not_replace_one_of_the_same_name() {
    let clash = "design.cx = { move = \"C\", along = \"xy\" }\n";
    for other in
        ["design.cx_x = { move = \"D\", along = \"x\" }\n", "design.cx_y = { move = \"D\", along = \"y\" }\n"]
    {
        for text in [format!("{}{clash}{other}", six_lines()), format!("{}{other}{clash}", six_lines())] {
            let Err(errors) = parse(&text, "planar.toml") else { panic!("accepted:\n{text}") };
            let shown = errors.to_string();
            let name = &other["design.".len()..][..4];
            assert!(shown.contains(&format!("there are two design variables named `{name}`")), "{shown}");
            assert!(shown.contains("HP0201") && shown.contains("NAME_x and NAME_y"), "{shown}");
        }
    }
}

#[test]
fn a_misspelt_key_of_a_variable_in_both_axes_is_reported_once() {
    let text = format!("{}design.cx = {{ moov = \"C\", along = \"xy\" }}\n", six_lines());
    let Err(errors) = parse(&text, "planar.toml") else { panic!("accepted:\n{text}") };
    let messages: Vec<&str> = errors.list().iter().map(|d| d.message.as_str()).collect();
    assert_eq!(
        messages,
        ["design variable `cx` has no `move`", "unknown key `moov` in design variable `cx`"]
    );
}

#[test]
fn cases_without_a_time_last_one_second_as_the_model_does() {
    let with_cases = file(&format!("{}[cases.slow]\nlaws.motor = \"20*t\"\n", six_lines()));
    let alone = file(&six_lines());
    let motions = with_cases.model.motions();
    assert_eq!(motions.len(), 1);
    assert_eq!(motions[0].times, alone.model.times);
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
fn variables_along_the_plane_are_saved_in_two_coordinates() {
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
fn keys_written_for_a_pin_take_precedence_and_three_bodies_may_share_it() {
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
    // From B down to C: sin(lean) = -20 / |BC| in the design configuration.
    let expected = -(20_f64 / 150.0).atan();
    assert!((solution.measured.value(0, m)[0] - expected).abs() < SAME);
}

/// A toggle whose sides meet on a slider, and a pair of scissors whose sides meet each other: where a hardpoint lies in
/// the mirror, the hinges on it are made for both sides.
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
        (
            "planar_variable_along_another_plane",
            with("\"xy\"", "\"xz\"") + "design.b = { move = \"B\", along = \"xy\" }\n",
        ),
    ] {
        snapshot(name, &text);
    }
}

/// The planes, with the axes that they are written in, and their normals.
const PLANES: [(&str, [usize; 2], &str, [f64; 3]); 4] = [
    ("xy", [0, 1], "z", [0.0, 0.0, 1.0]),
    ("yz", [1, 2], "x", [1.0, 0.0, 0.0]),
    ("zx", [2, 0], "y", [0.0, 1.0, 0.0]),
    ("xz", [0, 2], "-y", [0.0, -1.0, 0.0]),
];

/// A text in which `<1 2>` is a point or direction of the plane, `<1 2 3>` one off it, and `<axis>`, `<about>`,
/// `<along>` and `<ignored_direction>` are keys whose value is the normal of the plane: as a planar model writes it, or
/// with all that its shorthand leaves out.
fn written(template: &str, plane: usize, is_short: bool) -> String {
    let (word, axes, name, normal) = PLANES[plane];
    let mut parts = template.split('<');
    let mut text = match is_short {
        true => format!("planar = \"{word}\"\n"),
        false => String::new(),
    };
    text += parts.next().unwrap();
    for part in parts {
        let (token, rest) = part.split_once('>').unwrap();
        let numbers: Vec<f64> = token.split(' ').filter_map(|x| x.parse().ok()).collect();
        text += &match numbers.as_slice() {
            [] if is_short => String::new(),
            [] => format!(", {token} = \"{name}\""),
            [a, b] if is_short => format!("[{a}, {b}]"),
            [a, b, off @ ..] => {
                let mut place = normal.map(|x| x * off.first().copied().unwrap_or(0.0));
                place[axes[0]] += a;
                place[axes[1]] += b;
                format!("{place:?}")
            }
            [_] => panic!("{token}"),
        };
        text += rest;
    }
    text
}

/// Holds the shorthand in every plane to what it represents: states of all bodies, and all measures.
fn hold_to_spatial(what: &str, template: &str) {
    for (plane, (word, ..)) in PLANES.iter().enumerate() {
        let [short, spatial] = [true, false].map(|is_short| {
            let text = written(template, plane, is_short);
            let model = parse(&text, "plane.toml").unwrap_or_else(|e| panic!("{what}: {e}\n{text}")).model;
            let analysis = Analysis::new(&model).unwrap_or_else(|e| panic!("{what}: {e:?}\n{text}"));
            let solution = analysis.run();
            assert!(solution.stop.is_none(), "{what}: {:?}\n{text}", solution.stop);
            (model, solution)
        });
        let what = format!("{what} in {word}");
        let mut moves = 0.0_f64;
        let apart = |a: Vec3, b: Vec3, of: &str| {
            let size = 1.0 + a.norm();
            assert!((a - b).norm() <= SAME * size, "{what}: {of} {a:?} {b:?}\n{template}");
        };
        assert_eq!(short.1.motion.len(), spatial.1.motion.len(), "{what}");
        for body in 1..short.0.bodies.len() {
            for k in 0..short.1.motion.len() {
                let [a, b] = [&short, &spatial].map(|s| s.1.motion.at(k).body(body));
                moves = moves.max(a.v.norm() + a.omega.norm());
                apart(a.r, b.r, "place");
                (0..3).for_each(|c| apart(a.rotation.cols[c], b.rotation.cols[c], "orientation"));
                apart(a.v, b.v, "velocity");
                apart(a.omega, b.omega, "angular velocity");
                apart(a.a, b.a, "acceleration");
                apart(a.alpha, b.alpha, "angular acceleration");
            }
        }
        assert!(moves > 1e-3, "{what}: nothing moves");
        let [a, b] = [&short, &spatial].map(|s| &s.1.measured);
        assert_eq!(a.outputs.len(), b.outputs.len(), "{what}");
        for (m, output) in a.outputs.iter().enumerate() {
            for k in 0..a.len() {
                let [x, y] = [a, b].map(|s| s.value(k, m)[0]);
                let same = (x - y).abs() <= 1e-10 * (1.0 + x.abs()) || x.is_nan() && y.is_nan();
                assert!(same, "{what}: `{}` is {x}, not {y}, at step {k}\n{template}", output.name);
            }
        }
    }
}

const HEADER: &str =
    "name = \"plane\"\nunits = { length = \"mm\", angle = \"deg\" }\ntime = { end = 1.0, steps = 5 }\n";

/// Legs from ground to the body `b`, of lengths that drivers change.
fn legs(count: usize) -> String {
    let leg = |k: usize| {
        let Leg { base, on, law } = Leg::of(k);
        let [base, on] = [base, on].map(|[a, b, c]| format!("<{a} {b} {c}>"));
        format!(
            "leg{k} = {{ from = {{ body = \"ground\", at = {base} }}, to = {{ body = \"b\", at = {on} }}, law = \"{law}\" }}\n"
        )
    };
    (0..count).map(leg).collect()
}

#[test]
fn the_planar_shorthand_of_every_joint_type_equals_its_long_form() {
    for kind in joint::ALL {
        let mut keys = format!("type = \"{}\", bodies = [\"a\", \"b\"]", kind.name);
        keys += match kind.places {
            0 => "",
            1 => ", at = <10 400>",
            _ => ", at = [<10 400>, <50 430>]",
        };
        if ![Need::Unused, Need::Orienting].contains(&kind.axis) {
            keys += if kind.normal_in_plane { "<axis>" } else { ", axis = <0.9 0.4>" };
        }
        keys += match kind.axis2 {
            Need::Unused | Need::Optional | Need::Orienting => "",
            Need::Required => ", axis2 = <-0.4 0.9>",
            Need::OnBodyJ => ", axis2 = <0.4 0.8 0.5>",
        };
        if kind.has_lead() {
            keys += ", lead = 35";
        }
        if kind.follows_curve() {
            keys += ", curve = { points = [<-70 415>, <-10 400>, <70 395>, <150 402>] }";
        }
        let CoordinateEntries { drivers, measures, free } = CoordinateEntries::of(kind, "");
        hold_to_spatial(
            kind.name,
            &format!(
                "{HEADER}[bodies]\na = {{}}\nb = {{}}\n[joints]\nhinge = {{ type = \"revolute\", bodies = [\"ground\", \"a\"], at = <-200 300><axis> }}\n\
                 j = {{ {keys} }}\n[drivers]\nturn = {{ joint = \"hinge\", law = \"3*t\" }}\n{drivers}{}[measures]\n{measures}",
                legs(free)
            ),
        );
    }
}

/// A body that swings, one that slides on it, and one that turns on that, with a spring and masses, and more tables.
fn swinging(drivers: &str, measures: &str, forces: &str) -> String {
    format!(
        "{HEADER}gravity = {{ along = <0.1 -1> }}\n[bodies]\na = {{}}\nb = {{}}\nc = {{}}\n[joints]\n\
         hinge = {{ type = \"revolute\", bodies = [\"ground\", \"a\"], at = <-200 300><axis>, axis2 = <0.8 0.6> }}\n\
         slide = {{ type = \"translational\", bodies = [\"a\", \"b\"], at = <10 400>, axis = <0.9 0.4> }}\n\
         pin = {{ type = \"revolute\", bodies = [\"b\", \"c\"], at = <60 430><axis>, axis2 = <1 0> }}\n\
         [points]\np = {{ body = \"c\", at = <90 450> }}\n[drivers]\nswing = {{ joint = \"hinge\", law = \"14*t - 3*t^2\" }}\n\
         way = {{ joint = \"slide\", law = \"25*t + 9*t^2\" }}\n{drivers}\n[masses]\n\
         mass_b = {{ type = \"rigid\", centre = {{ body = \"b\", at = <20 410> }}, mass = 4, ixx = 0.02, iyy = 0.03, izz = 0.04 }}\n\
         mass_c = {{ type = \"rigid\", centre = {{ body = \"c\", at = <80 440> }}, mass = 2, ixx = 0.02, iyy = 0.03, izz = 0.04 }}\n\
         [forces]\nspring = {{ type = \"spring\", from = {{ body = \"ground\", at = <0 200> }}, to = \"p\", stiffness = 20 }}\n\
         soft = {{ type = \"elastic_joint\", joint = \"hinge\", x = 1000, y = 3000, z = 2000 }}\n\
         bush = {{ type = \"bushing\", from = {{ body = \"a\", at = <40 400> }}, to = {{ body = \"c\", at = <40 400> }}, x = 2, y = 3, z = 4 }}\n{forces}\n\
         [measures]\nbase = {{ type = \"position\", point = \"p\", along = <0.2 0.7> }}\n\
         far = {{ type = \"distance\", from = \"p\", to = {{ body = \"ground\", at = <0 200> }} }}\n\
         moment = {{ type = \"driver_force\", driver = \"swing\" }}\npush = {{ type = \"driver_force\", driver = \"way\" }}\n{measures}"
    )
}

const TURN: &str = "turn = { joint = \"pin\", law = \"20*t + 4*t^2\" }";

#[test]
fn the_planar_shorthand_of_every_measure_equals_its_long_form() {
    for kind in MeasureType::ALL {
        // The knee is planar there, and is compared with its long form (`clearance.rs`).
        if kind.name == "clearance" {
            continue;
        }
        let cases: &[&str] = match kind.name {
            "coordinate" => &["joint = \"pin\""],
            "distance" => &["from = \"p\", to = { body = \"ground\", at = <30 10> }"],
            "position" | "velocity" | "acceleration" => &["point = \"p\", along = <0.3 0.9>"],
            "angle" => &[
                "from = <0.2 1>, to = [\"p\", { body = \"a\", at = <-200 300> }]<about>",
                "from = [\"p\", { body = \"a\", at = <-200 300> }], to = { body = \"b\", axis = <1 0.3> }<about>",
            ],
            "articulation" => &["joint = \"pin\", axis = <1 0.3>"],
            "orientation" => &["body = \"b\", angle = \"yaw\"", "body = \"b\", angle = \"cardan_3\""],
            "transmission_angle" => {
                &["from = [\"p\", { body = \"a\", at = <-200 300> }], to = { body = \"b\", axis = <1 0.3> }"]
            }
            "angular_velocity" => &["body = \"c\"<along>"],
            "curvature" => &["point = \"p\""],
            "rate" => &["of = \"base\""],
            "slope" => &["of = \"base\", over = \"far\", driver = \"swing\""],
            "dexterity" => {
                &["points = [\"p\", { body = \"c\", at = <-20 300> }], drivers = [\"swing\", \"turn\"]"]
            }
            "expression" => &["expression = \"2*base + far^2/100\""],
            "toe" | "camber" => &["body = \"c\", spin_axis = <0.4 1>"],
            "driver_force" | "driver_power" => &["driver = \"turn\""],
            "reaction" => &["joint = \"pin\", part = \"force\"", "joint = \"slide\", part = \"torque\""],
            "spring_force" => &["force = \"spring\""],
            "deflection" => {
                &["force = \"soft\", direction = \"about_z\"", "force = \"bush\", direction = \"x\""]
            }
            "kinetic_energy" => &["body = \"c\""],
            "shaking_force" => &["along = <0.3 0.9>"],
            "shaking_moment" => &["about = { body = \"ground\", at = <10 30> }<along>"],
            "compliance" => &["of = \"base\", at = \"p\", along = <0.2 1>"],
            other => panic!("no planar mechanism for measure `{other}`"),
        };
        for keys in cases {
            let measure = format!("own = {{ type = \"{}\", {keys} }}\n", kind.name);
            hold_to_spatial(&format!("{} {keys}", kind.name), &swinging(TURN, &measure, ""));
        }
    }
}

#[test]
fn the_planar_shorthand_of_every_driver_equals_its_long_form() {
    for form in declared("Driver") {
        let cases: &[(&str, &str)] = match form.as_str() {
            "DrivenCoordinate" => &[("joint = \"pin\"", "")],
            "DrivenPosition" => &[("point = \"p\", along = <0.3 -0.9>", "")],
            "DrivenDistance" => &[("from = \"p\", to = { body = \"ground\", at = <-30 600> }", "")],
            "DrivenOrientation" => {
                &[("body = \"c\"<about>", ""), ("body = \"c\"<about>, axis2 = <1 0.5>", "")]
            }
            "DrivenMeasure" => &[
                ("measure = \"own\"", "own = { type = \"coordinate\", joint = \"pin\" }\n"),
                (
                    "measure = \"own\"",
                    "own = { type = \"angle\", from = { body = \"ground\", axis = <1 0> }, to = { body = \"c\", axis = <1 0> }<about> }\n",
                ),
            ],
            "DrivenContact" => continue, // wheels are in space
            other => panic!("no planar mechanism for `{other}`"),
        };
        for (keys, measure) in cases {
            let driver = format!("turn = {{ {keys}, law = \"4*t + t^2\" }}");
            // So little that the driven point is reached.
            let text =
                swinging(&driver, measure, "").replace("14*t - 3*t^2", "2*t").replace("25*t + 9*t^2", "3*t");
            hold_to_spatial(&format!("{form} {keys} {measure}"), &text);
        }
    }
}

#[test]
fn the_planar_shorthand_of_every_coupler_equals_its_long_form() {
    for name in declared("Coupler") {
        let keys = match name.as_str() {
            "gear" => "joints = [\"hinge\", \"pin\"], teeth = [20, 30]",
            "bevel" => continue,                    // its axes meet at an angle
            "rack" | "rack_and_pinion" => continue, // coupled below, by the slide that a driver would move
            "belt" => "joints = [\"hinge\", \"pin\"], radii = [20, 30], crossed = true",
            "linear" => {
                "terms = [{ joint = \"hinge\", coefficient = 1 }, { joint = \"pin\", coefficient = 2 }]"
            }
            other => panic!("no planar mechanism for coupler `{other}`"),
        };
        let text = swinging("", "", "")
            .replace("[points]", &format!("[couplers]\nown = {{ type = \"{name}\", {keys} }}\n[points]"));
        hold_to_spatial(&format!("{name} {keys}"), &text);
    }
    let rack = "rack = \"slide\", pinion = \"pin\", radius = 30";
    for name in declared("Coupler").iter().filter(|n| n.starts_with("rack")) {
        let text = swinging("", "", "")
            .replace("[points]", &format!("[couplers]\nown = {{ type = \"{name}\", {rack} }}\n[points]"));
        hold_to_spatial(name, &text);
    }
}

#[test]
fn the_planar_shorthand_of_every_mass_and_force_equals_its_long_form() {
    for element in ElementType::ALL {
        let point = |body: &str, at: &str| format!("{{ body = \"{body}\", at = {at} }}");
        let keys = match element.name {
            "rigid" => {
                format!("centre = {}, mass = 3, ixx = 0.02, iyy = 0.03, izz = 0.04", point("b", "<30 400>"))
            }
            "bar" => format!(
                "from = {}, to = {}, diameter = 30, density = 7850",
                point("b", "<10 400>"),
                point("b", "<60 430>")
            ),
            "block" => format!("centre = {}, x = 30, y = 40, z = 70, density = 2700", point("b", "<30 400>")),
            "mesh" => continue, // a file of corners in space, with nothing of a plane
            "spring" => format!(
                "from = {}, to = {}, stiffness = 20, preload = 30, damping = 0.4",
                point("a", "<0 500>"),
                point("c", "<90 450>")
            ),
            "joint_spring" => "joint = \"slide\", stiffness = 12, equilibrium = 5, damping = 0.3".into(),
            "torsion_spring" => "joint = \"pin\", stiffness = 0.3, equilibrium = 4, damping = 0.02".into(),
            "friction" => "joint = \"pin\", coefficient = 0.1, radius = 12, length = 40".into(),
            "slide_friction" => "joint = \"slide\", coefficient = 0.1<ignored_direction>".into(),
            "force" => format!(
                "at = {}, force = 50, along = <0.4 0.8>, axes = \"body\", law = \"1 + t\"",
                point("c", "<90 450>")
            ),
            "wheel_force" | "tyre" => continue, // wheels are in space
            "moment" => "body = \"c\", moment = 5, law = \"1 + t\"<about>".into(),
            "bushing" => format!(
                "from = {}, to = {}, x = 100, y = 200, z = 300, about_x = 0.5, about_y = 0.7, about_z = 0.9",
                point("a", "<60 420>"),
                point("c", "<60 420>")
            ),
            "elastic_joint" => "joint = \"pin\", x = 1000, y = 3000, z = 2000".into(),
            other => panic!("no planar mechanism for `{other}`"),
        };
        let own = format!("own = {{ type = \"{}\", {keys} }}\n", element.name);
        let text = match element.table {
            "masses" => swinging(TURN, "", "").replace("[forces]\n", &format!("{own}[forces]\n")),
            _ => swinging(
                TURN,
                "give = { type = \"compliance\", of = \"base\", at = \"p\", along = <0.2 1> }\n",
                &own,
            ),
        };
        hold_to_spatial(&format!("{} {keys}", element.name), &text);
    }
}
