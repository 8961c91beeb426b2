//! Settings of an optimisation in a file, SI.

use hardpoint::model::{Goal, Limit, LimitTarget, Reduction};
use hardpoint_file::{parse, read};

/// A slider-crank with a rod, a target to follow, and two strokes.
const MODEL: &str = r#"
name = "slider-crank"
units = { length = "mm", angle = "deg" }
parameters.reach = { value = 300, unit = "length", bounds = [250, 320] }
parameters.high = { value = "reach/10", unit = "length" }
hardpoints = { O = [0, 0, 0], A = [100, 0, 0], B = ["reach", 0, "high"] }
bodies = { crank = {}, slider = {} }
joints.pivot = { type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "z" }
joints.slide = { type = "translational", bodies = ["ground", "slider"], at = "B", axis = "x" }
joints.rod = { type = "distance", bodies = ["crank", "slider"], at = ["A", "B"] }
drivers.motor = { joint = "pivot" }
design.A = { move = "A", along = "xyz", bounds = [-5, 10] }
design.O_x = { move = "O", along = "x" }
points.B = { body = "slider", at = "B" }
measures.turn = { type = "coordinate", joint = "pivot" }
metrics.path = { of = "B.x", over = "turn", take = "rms", target = [[0, 300], [90, 250]] }
metrics.steepest = { of = "B.x", over = "turn", take = "slope", at = 45, case = "slow" }
metrics.angle = { of = "turn", take = "range" }
time = { end = 1.0, steps = 20 }
cases.slow = { laws = { motor = "45*t" } }
cases.fast = { laws = { motor = "90*t" } }

[optimize]
starts = 5
min_margin = 0.03
[optimize.goals]
path = { weight = 10 }
steep = { metric = "steepest", target = 2, weight = 3 }
[optimize.limits]
angle = { metric = "angle", equal = 45 }
room = { hardpoint = "A", x = [95, 105], z = { max = 5 } }
apart = { between = ["O", "A"], min = 80, max = 120 }
rod = { length = "rod", min = 150 }
top = { hardpoint = "B", z = [20, 40] }
"#;

#[test]
fn goals_and_limits_are_read_in_si() {
    let file = parse(MODEL, "optimize.toml").unwrap_or_else(|e| panic!("{e}"));
    let model = &file.model;
    let o = model.optimization.as_ref().unwrap();
    let names: Vec<&str> = o.variables.iter().map(|v| model.variables[v.0].name.as_str()).collect();
    // All that have bounds, in the order of the file's variables.
    assert_eq!(names, ["reach", "A_x", "A_y", "A_z"]);
    assert_eq!((o.starts, o.iterations), (5, 1000));
    let degree = 1_f64.to_radians();
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * b.abs();
    // 10 per mm is 10000 per m; 2 mm per deg is 2e-3/degree m per rad, and 3 per (mm per deg) 3e3*degree.
    let [Goal { name, metric: 0, target: None, weight }, steep] = &o.goals[..] else {
        panic!("{:?}", o.goals)
    };
    assert!(name == "path" && near(*weight, 1e4), "{weight}");
    assert!(steep.name == "steep" && steep.metric == 1);
    assert!(near(steep.target.unwrap(), 2e-3 / degree) && near(steep.weight, 3e3 * degree), "{steep:?}");
    let id = |name: &str| {
        hardpoint::model::HardpointId(model.hardpoints.iter().position(|h| h.name == name).unwrap())
    };
    let expected: [(&str, LimitTarget, Option<f64>, Option<f64>); 7] = [
        ("angle", LimitTarget::Metric(2), Some(45.0 * degree), Some(45.0 * degree)),
        ("room.x", LimitTarget::Coordinate(id("A"), 0), Some(0.095), Some(0.105)),
        ("room.z", LimitTarget::Coordinate(id("A"), 2), None, Some(0.005)),
        ("apart", LimitTarget::Distance(id("O"), id("A")), Some(0.08), Some(0.12)),
        ("rod", LimitTarget::Length(hardpoint::model::JointId(2)), Some(0.15), None),
        ("top.z", LimitTarget::Coordinate(id("B"), 2), Some(0.02), Some(0.04)),
        ("min_margin", LimitTarget::Margin, Some(0.03), None),
    ];
    assert_eq!(o.limits.len(), expected.len());
    for (Limit { name, of, least, most }, (named, put_on, low, high)) in o.limits.iter().zip(expected) {
        assert_eq!((name.as_str(), *of), (named, put_on));
        for (found, expected) in [(least, low), (most, high)] {
            let alike = match (found, expected) {
                (Some(a), Some(b)) => near(*a, b),
                (a, b) => a.is_none() && b.is_none(),
            };
            assert!(alike, "{name}: {found:?} {expected:?}");
        }
    }
    // A case has no optimisation of its own: it is the model's.
    assert!(model.motions().iter().all(|m| m.optimization.is_none()));
}

/// A target in a file is the one that is written in the model.
#[test]
fn a_target_may_lie_in_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.toml");
    std::fs::create_dir(folder.path().join("data")).unwrap();
    std::fs::write(folder.path().join("data/path.csv"), "# of a drawing\nx;turn;wanted\n7;0;300\n7;90;250\n")
        .unwrap();
    std::fs::write(folder.path().join("path.csv"), "0, 300\n90, 250\n").unwrap();
    let inline = "[[0, 300], [90, 250]]";
    let target = |text: &str| {
        std::fs::write(&path, text).unwrap();
        let file = read(&path).unwrap_or_else(|e| panic!("{e}"));
        match &file.model.metrics[0].take {
            Reduction::Rms(points) => points.clone(),
            other => panic!("{other:?}"),
        }
    };
    let expected = target(MODEL);
    assert_eq!(expected.len(), 2);
    for written in [
        "\"path.csv\"",
        "{ file = \"path.csv\" }",
        "{ file = \"data/path.csv\", columns = [\"turn\", \"wanted\"] }",
        "{ file = \"data/path.csv\", columns = [2, 3] }",
    ] {
        assert_eq!(target(&MODEL.replacen(inline, written, 1)), expected, "{written}");
    }
}

/// The variables that are named, in their order.
#[test]
fn a_key_without_its_first_word_is_reported_with_the_whole() {
    for (key, whole) in [("iterations = 5", "max_iterations"), ("margin = 0.1", "min_margin")] {
        let text = MODEL.replace("min_margin = 0.03", key);
        let message = parse(&text, "optimize.toml").unwrap_err().to_string();
        assert!(
            message.contains("HP0103") && message.contains(&format!("did you mean `{whole}`?")),
            "{message}"
        );
        assert_eq!(message.matches("error[").count(), 1, "{message}");
    }
}

#[test]
fn variables_may_be_chosen() {
    let text = MODEL.replacen("starts = 5", "variables = [\"A_z\", \"reach\", \"A_x\"]", 1);
    let model = parse(&text, "optimize.toml").unwrap_or_else(|e| panic!("{e}")).model;
    let o = model.optimization.as_ref().unwrap();
    let names: Vec<&str> = o.variables.iter().map(|v| model.variables[v.0].name.as_str()).collect();
    assert_eq!((names, o.starts), (vec!["A_z", "reach", "A_x"], 1));
}
