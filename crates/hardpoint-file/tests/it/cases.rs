//! Cases have the same motions as separate files.

use hardpoint::model::{CaseId, Model};
use hardpoint::run::metrics;
use hardpoint::{Analysis, Solution};
use hardpoint_file::{parse, read};

/// A crank on a slide, each with a driver.
const MODEL: &str = r#"
name = "slide and crank"
units = { length = "mm", angle = "deg" }
parameters = { a = { value = 100, unit = "length", bounds = [80, 120] }, k = { value = 30, unit = "number" } }
hardpoints = { O = [0, 0, 0], A = ["a", 0, 0] }
bodies = { sled = {}, crank = {} }
joints.slide = { type = "translational", bodies = ["ground", "sled"], at = "O", axis = "x" }
joints.pivot = { type = "revolute", bodies = ["sled", "crank"], at = "O", axis = "z" }
drivers.travel = { joint = "slide", law = "20*t" }
drivers.motor = { joint = "pivot", law = { type = "expression", law = "w*t", parameters = { w = "2*k" } } }
design.faster = { driver = "motor", parameter = "w" }
points.A = { body = "crank", at = "A" }
metrics.reach = { of = "A.x", take = "max" }
metrics.lift = { of = "A.y", take = "max", case = "turn" }
time = { end = 1.0, steps = 10 }

[cases.turn]
laws = { motor = "k*t^2" }

[cases.both]
laws = { motor = { type = "expression", law = "p*t", parameters = { p = "k + 15" } } }
other_drivers = "as_in_model"
time = { end = 2.0, steps = 8 }

[cases.own]
other_drivers = "as_in_model"

[cases.table]
laws = { travel = { type = "table", points = [[0, 0], [1, 5], [2, 0]] }, motor = 12 }
time = { at = [0, 0.5, 1.5] }
"#;

fn solved(model: &Model) -> Solution {
    let solution = Analysis::new(model).unwrap().run();
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    solution
}

/// The same motion, written without cases.
fn alone(laws: [&str; 2], time: &str) -> Model {
    let (above, _) = MODEL.split_once("[cases.turn]").unwrap();
    let text = above
        .replace("law = \"20*t\"", &format!("law = {}", laws[0]))
        .replace(
            "law = { type = \"expression\", law = \"w*t\", parameters = { w = \"2*k\" } }",
            &format!("law = {}", laws[1]),
        )
        .replace(", case = \"turn\"", "")
        .replace("end = 1.0, steps = 10", time);
    // The law that it changes may be another.
    let text = match laws[1].contains("w*t") {
        true => text,
        false => text.replace("design.faster = { driver = \"motor\", parameter = \"w\" }", ""),
    };
    parse(&text, "alone.toml").unwrap_or_else(|e| panic!("{e}")).model
}

#[test]
fn names_of_cases_differ_in_more_than_capital_letters() {
    let text = MODEL.replace("[cases.both]", "[cases.Turn]");
    let Err(errors) = parse(&text, "cases.toml") else { panic!("two cases of one folder") };
    let [error] = errors.list() else { panic!("{errors}") };
    assert_eq!(error.code, "HP0201");
    assert_eq!(error.message, "cases `turn` and `Turn` differ in capital letters only");
}

#[test]
fn a_case_is_the_motion_of_its_laws_at_its_times() {
    let file = parse(MODEL, "cases.toml").unwrap_or_else(|e| panic!("{e}"));
    let model = &file.model;
    assert_eq!(model.motions().len(), 4);
    let own = "{ type = \"expression\", law = \"w*t\", parameters = { w = \"2*k\" } }";
    let table = "{ type = \"table\", points = [[0, 0], [1, 5], [2, 0]] }";
    for (name, laws, time) in [
        ("turn", ["0", "\"k*t^2\""], "end = 1.0, steps = 10"),
        (
            "both",
            ["\"20*t\"", "{ type = \"expression\", law = \"p*t\", parameters = { p = \"k + 15\" } }"],
            "end = 2.0, steps = 8",
        ),
        ("own", ["\"20*t\"", own], "end = 1.0, steps = 10"),
        ("table", [table, "12"], "at = [0, 0.5, 1.5]"),
    ] {
        let case = model.case(name).unwrap();
        let (here, alone) = (model.in_case(case), alone(laws, time));
        let (a, b) = (solved(&here), solved(&alone));
        assert_eq!(a.motion.times, b.motion.times, "{name}");
        let reach = |model: &Model, solution: &Solution| {
            let k = model.metrics.iter().position(|m| m.name == "reach").unwrap();
            metrics(model, solution).swap_remove(k)
        };
        let (found, expected) = (reach(&here, &a), reach(&alone, &b));
        assert_eq!(found.value, expected.value, "{name}");
        for v in &alone.variables {
            let [here, there] = [&here, &alone].map(|m| m.variable(&v.name).unwrap().0);
            assert_eq!(found.d[here], expected.d[there], "{name} by {}", v.name);
        }
        // A law of the case's own leaves nothing for a variable of the driver's own law.
        let faster = here.variable("faster").unwrap().0;
        assert_eq!(here.variables[faster].changes.is_empty(), name != "own", "{name}");
        assert_eq!(here.metrics.len(), if name == "turn" { 2 } else { 1 }, "{name}");
    }
    // The parameter k is felt wherever a law uses it: x = 100 cos(k t^2), most at the start.
    let turn = model.in_case(CaseId(0));
    let found = metrics(&turn, &solved(&turn));
    let (lift, k) = (&found[1], model.variable("k").unwrap().0);
    let angle = 30_f64.to_radians();
    assert!((lift.value.unwrap() - 0.1 * angle.sin()).abs() < 1e-12, "{lift:?}");
    assert!((lift.d[k] - 0.1 * angle.cos() * 1_f64.to_radians()).abs() < 1e-12, "{lift:?}");
}

#[test]
fn a_case_may_take_its_laws_from_files_and_be_the_only_one_that_has_them() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("way.csv"), "time,way\n0,0\n1,10\n2,0\n").unwrap();
    let text = MODEL
        .replace(
            "drivers.travel = { joint = \"slide\", law = \"20*t\" }",
            "drivers.travel = { joint = \"slide\" }",
        )
        .replace("time = { end = 1.0, steps = 10 }\n", "");
    let (above, _) = text.split_once("[cases.turn]").unwrap();
    let case = "[cases.turn]\nlaws = { travel = { type = \"table\", file = \"way.csv\" } }\ntime = { end = 2.0, steps = 4 }\n";
    let path = folder.path().join("model.toml");
    std::fs::write(&path, format!("{above}{case}")).unwrap();
    let file = read(&path).unwrap_or_else(|e| panic!("{e}"));
    let turn = file.model.in_case(CaseId(0));
    assert_eq!(turn.times, [0.0, 0.5, 1.0, 1.5, 2.0]);
    assert_eq!(turn.drivers[0].law.at(1.0).value(), 0.01);
    assert_eq!(turn.drivers[1].law.at(1.0).value(), 0.0);
    assert_eq!(file.model.times, turn.times);
    // Without its own law the driver needs one in each case.
    std::fs::write(&path, format!("{above}{case}[cases.more]\nlaws = {{ motor = \"t\" }}\nother_drivers = \"as_in_model\"\ntime = {{ at = [0, 1] }}\n")).unwrap();
    let error = read(&path).unwrap_err();
    assert!(error.to_string().contains("case `more` leaves driver `travel` without a `law`"), "{error}");
}

#[test]
fn laws_of_forces_do_not_follow_parameters() {
    let text = |parameters: &str, own: &str, law: &str| {
        format!(
            r#"
name = "pushed"
units = {{ length = "mm", angle = "deg" }}
parameters = {{ {parameters} }}
bodies = {{ b = {{}} }}
[joints]
j = {{ type = "translational", bodies = ["ground", "b"], at = [0, 0, 0], axis = "x" }}
[forces]
s = {{ type = "joint_spring", joint = "j", stiffness = 5 }}
F = {{ type = "force", at = {{ body = "b", at = [0, 0, 0] }}, force = 50, along = "x", law = {own} }}
[equilibrium]
[measures]
q = {{ type = "coordinate", joint = "j" }}
[cases.a]
laws = {{ F = {law} }}
[time]
at = [0, 1]
"#
        )
    };
    let expression = r#"{ type = "expression", law = "w*t", parameters = { w = "c + 1" } }"#;
    for (own, law, subject) in [
        ("\"0\"", "\"c*t\"", "the law of force `F` in case `a` cannot follow parameter `c`"),
        ("\"0\"", expression, "the law of force `F` in case `a` cannot follow parameter `c`"),
        ("\"c*t\"", "\"t\"", "cannot follow parameter `c`"),
        (expression, "\"t\"", "cannot follow parameter `c`"),
    ] {
        let Err(faults) = parse(&text("c = 3", own, law), "pushed.toml") else { panic!("{own} {law}") };
        let [fault] = faults.list() else { panic!("{faults}") };
        assert_eq!(fault.code, "HP0230", "{faults}");
        assert!(fault.message.contains(subject), "{faults}");
        assert!(fault.help.as_ref().is_some_and(|help| help.contains("force = \"50*c\"")), "{faults}");
        // A parameter that nothing changes is a number.
        let fixed = text("c = { value = 3, design = false }", own, law);
        let file = parse(&fixed, "pushed.toml").unwrap_or_else(|e| panic!("{e}"));
        let solution = solved(&file.model.in_case(CaseId(0)));
        let q = solution.measured.index("q").unwrap();
        // 50 N over 5 N/mm times the law
        let factor = if law == "\"t\"" {
            1.0
        } else if law == expression {
            4.0
        } else {
            3.0
        };
        assert!((solution.measured.value(1, q)[0] - 0.01 * factor).abs() < 1e-12, "{law}");
    }
}
