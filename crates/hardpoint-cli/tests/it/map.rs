//! `hardpoint map`: ranges with units, and outputs without one.

use crate::bench::Bench;

const CRANK: &str = r#"
name = "crank"
units = { length = "mm", angle = "rad" }
planar = "xy"
hardpoints = { O = [0, 0], A = [20, 5] }
bodies = { ground = ["O"], crank = ["O", "A"] }
drivers.motor = { joint = "O", law = "0.5*t" }
points.A = { body = "crank", at = "A" }
measures.ratio = { type = "expression", expression = "A.x / 20" }
time = { end = 1, steps = 4 }
"#;

#[test]
fn a_unit_after_a_range_is_that_of_both_ends() {
    let bench = Bench::with(&[]);
    bench.put("crank.toml", CRANK);
    let ends = |over: &str| {
        let output = bench.run(&[
            "map",
            "crank.toml",
            "--over",
            over,
            "--of",
            "A.x",
            "--error",
            "1e-3mm",
            "-o",
            "x.json",
        ]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let knots = bench.json("x.json")["drivers"][0]["knots"].clone();
        let knots: Vec<f64> = knots.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
        [knots[0], *knots.last().unwrap()]
    };
    let near = |[a, b]: [f64; 2], [c, d]: [f64; 2]| (a - c).abs().max((b - d).abs()) < 1e-12;
    let degrees = [-3.0, 6.0].map(f64::to_radians);
    assert!(near(ends("motor=-3..6deg"), degrees), "{:?}", ends("motor=-3..6deg"));
    assert!(near(ends("motor=-3deg..6deg"), degrees));
    assert!(near(ends("motor=-0.3..0.6"), [-0.3, 0.6]));
    assert!(near(ends("motor=-0.3rad..6deg"), [-0.3, degrees[1]]));
}

#[test]
fn the_error_of_a_plain_number_has_no_unit() {
    let bench = Bench::with(&[]);
    bench.put("crank.toml", CRANK);
    let arguments = [
        "map",
        "crank.toml",
        "--over",
        "motor=0..30deg",
        "--of",
        "ratio",
        "--error",
        "0.001",
        "-o",
        "x.json",
    ];
    let output = bench.run(&arguments);
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{text}{}", String::from_utf8_lossy(&output.stderr));
    let line = text.lines().find(|line| line.contains("error at most")).unwrap();
    assert!(line.contains(" everywhere") && !line.contains(" 1 everywhere"), "{line}");
}

#[test]
fn a_negative_error_is_not_taken_for_an_option() {
    let bench = Bench::with(&[]);
    bench.put("crank.toml", CRANK);
    let output = bench.run(&[
        "map",
        "crank.toml",
        "--over",
        "motor=0..30deg",
        "--of",
        "ratio",
        "--error",
        "-0.1",
        "-o",
        "x.json",
    ]);
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(text.contains("the permitted error of `ratio` is not far above round-off"), "{text}");
}

#[test]
fn one_number_is_the_permitted_error_of_several_outputs_of_one_unit() {
    let bench = Bench::with(&[]);
    bench.put("crank.toml", CRANK);
    let over = ["map", "crank.toml", "--over", "motor=0..30deg", "--of", "A.x,A.y,ratio", "--error", "0.001"];
    let output = bench.run(&[&over[..], &["-o", "x.json"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let json = bench.json("x.json");
    for output in json["outputs"].as_array().unwrap() {
        assert!(output["proved_error"].as_f64().unwrap() <= 0.001, "{output}");
    }
}

#[test]
fn the_ends_of_a_table_are_the_numbers_of_the_request() {
    let bench = Bench::with(&[]);
    bench.put("crank.toml", &CRANK.replace("angle = \"rad\"", "angle = \"deg\""));
    // -30 deg is -0.5235987755982988 rad, and that times 180/pi is -29.999999999999996.
    for (over, ends) in [("motor=-30..30", [-30.0, 30.0]), ("motor=-0.1..12.3", [-0.1, 12.3])] {
        let arguments =
            ["map", "crank.toml", "--over", over, "--of", "A.x", "--error", "1e-3mm", "-o", "x.json"];
        let output = bench.run(&arguments);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let json = bench.json("x.json");
        let knots = json["drivers"][0]["knots"].as_array().unwrap();
        assert_eq!([&knots[0], &knots[knots.len() - 1]].map(|x| x.as_f64().unwrap()), ends);
    }
}

#[test]
fn tables_of_modelica_have_different_names() {
    let bench = Bench::with(&[]);
    let model = r#"
name = "two cranks"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { O = [0, 0], A = [20, 5], Q = [100, 0], B = [100, 30] }
bodies = { ground = ["O", "Q"], crank = ["O", "A"], arm = ["Q", "B"] }
drivers = { one = { joint = "O", law = "t" }, two = { joint = "Q", law = "t" } }
points = { A = { body = "crank", at = "A" }, B = { body = "arm", at = "B" } }
measures."a b" = { type = "position", point = "A", along = "x" }
measures.a_b = { type = "position", point = "B", along = "x" }
time = { end = 1, steps = 4 }
"#;
    bench.put("cranks.toml", model);
    let over = ["--over", "one=0..10", "--over", "two=0..10"];
    let rest = ["--of", "a b,a_b", "--error", "0.1mm", "-o", "x.txt"];
    let output = bench.run(&[&["map", "cranks.toml"][..], &over, &rest].concat());
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let text = bench.text("x.txt");
    let tables: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("double ")).collect();
    let names: Vec<&str> = tables.iter().filter_map(|line| Some(line.split_once('(')?.0)).collect();
    // As in C and FMUs: a name without other characters remains.
    assert_eq!(names, ["a_b_2", "a_b"]);
    let heading = text.lines().find(|line| line.starts_with("# a b in ")).unwrap();
    assert!(heading.ends_with("(proved), table a_b_2"), "{heading}");
}

/// Splines of a dataset of Adams Solver by their identifiers: x, and the curves, with z first if there are several.
fn splines(text: &str) -> Vec<(usize, Vec<f64>, Vec<Vec<f64>>)> {
    let mut statements: Vec<String> = Vec::new();
    for line in text.lines() {
        assert!(line.len() <= 80, "{line}");
        match line.chars().next() {
            Some('!') => {}
            Some(',') => statements.last_mut().unwrap().push_str(line),
            _ => statements.push(line.to_owned()),
        }
    }
    let spline = |statement: &String| {
        let (head, arguments) = statement.split_once(',').unwrap();
        let id = head.strip_prefix("SPLINE/").unwrap().parse().unwrap();
        let mut lists: Vec<(&str, Vec<f64>)> = Vec::new();
        for part in arguments.split(',') {
            let number = match part.split_once('=') {
                Some((name, number)) => {
                    lists.push((name.trim(), Vec::new()));
                    number
                }
                None => part,
            };
            assert!(number.contains('.'), "{number}");
            lists.last_mut().unwrap().1.push(number.trim().parse().unwrap());
        }
        assert!(lists[0].0 == "X" && lists[1..].iter().all(|(name, _)| *name == "Y"), "{statement}");
        let mut lists = lists.into_iter().map(|(_, numbers)| numbers);
        (id, lists.next().unwrap(), lists.collect())
    };
    statements.iter().map(spline).collect()
}

#[test]
fn splines_of_adams_are_curves_and_families_with_the_proved_error() {
    let bench = Bench::with(&[]);
    let model = r#"
name = "two cranks"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { O = [0, 0], A = [20, 5], Q = [100, 0], B = [100, 30] }
bodies = { ground = ["O", "Q"], crank = ["O", "A"], arm = ["Q", "B"] }
drivers = { one = { joint = "O", law = "t" }, two = { joint = "Q", law = "t" } }
points = { A = { body = "crank", at = "A" }, B = { body = "arm", at = "B" } }
measures.sum = { type = "expression", expression = "A.x + B.y" }
measures.turn = { type = "coordinate", joint = "O" }
time = { end = 1, steps = 4 }
"#;
    bench.put("cranks.toml", model);
    let over = ["--over", "one=-20..40", "--over", "two=-30..30"];
    let map = |over: &[&str], more: &[&str]| {
        let rest = ["--of", "sum,turn", "--error", "sum=0.1mm,turn=0.01deg", "-o", "x.adm"];
        bench.run(&[&["map", "cranks.toml"][..], over, &rest, more].concat())
    };
    let text = |output: std::process::Output| {
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        bench.text("x.adm")
    };
    let exact = |one: f64, two: f64| 20.0 * one.cos() - 5.0 * one.sin() + 30.0 * two.cos();
    let radians = |from: f64, to: f64, part: f64| (from + (to - from) * part).to_radians();
    let cell = |knots: &[f64], at: f64| {
        let k = knots.partition_point(|knot| *knot <= at).clamp(1, knots.len() - 1) - 1;
        (k, (at - knots[k]) / (knots[k + 1] - knots[k]))
    };
    let between = |y: &[f64], (k, part): (usize, f64)| y[k] + (y[k + 1] - y[k]) * part;

    let curves = splines(&text(map(&over[..2], &[])));
    assert_eq!(curves.iter().map(|c| c.0).collect::<Vec<_>>(), [1, 2]);
    for n in 0..=100 {
        let at = radians(-20.0, 40.0, f64::from(n) / 100.0);
        let [sum, turn] = [0, 1].map(|k| between(&curves[k].2[0], cell(&curves[k].1, at)));
        assert!((sum - exact(at, 0.0)).abs() <= 0.1 && (turn - at).abs() <= 2e-4, "{at}: {sum}, {turn}");
    }
    // Also of a line there are at least four points.
    assert!(curves[1].1.len() >= 4 && curves[1].2[0].len() == curves[1].1.len());

    let families = splines(&text(map(&over, &[])));
    let (_, x, family) = &families[0];
    let z: Vec<f64> = family.iter().map(|curve| curve[0]).collect();
    assert!(z.len() >= 4 && z.is_sorted() && family.iter().all(|curve| curve.len() == 1 + x.len()));
    for n in 0..=100 {
        let part = f64::from(n) / 100.0;
        let (one, two) = (radians(-20.0, 40.0, part), radians(-30.0, 30.0, (7.0 * part).fract()));
        let (j, beside) = cell(&z, two);
        let [near, far] = [j, j + 1].map(|j| between(&family[j][1..], cell(x, one)));
        let found = near + (far - near) * beside;
        assert!((found - exact(one, two)).abs() <= 0.1, "{one}, {two}: {found}");
    }

    let refused = map(&over, &["--interpolation", "hermite"]);
    assert_eq!(refused.status.code(), Some(2));
    let why = String::from_utf8(refused.stderr).unwrap();
    assert!(why.contains("splines of Adams have no given derivatives"), "{why}");
}
