//! Limits of joints as a user sees them.

use crate::bench::Bench;

/// A slider-crank whose ram leaves its limits; `MORE` follows the maximum.
const PRESS: &str = "name = \"press\"\nplanar = \"xy\"\nunits = { length = \"mm\", angle = \"deg\" }\n\
    [hardpoints]\nO = [0, 0]\nA = [0, 40]\nB = [91.6515138991168, 0]\n[bodies]\ncrank = {}\nrod = {}\nram = {}\n\
    [joints]\ncrank = { type = \"revolute\", bodies = [\"ground\", \"crank\"], at = \"O\" }\n\
    pin = { type = \"revolute\", bodies = [\"crank\", \"rod\"], at = \"A\" }\n\
    wrist = { type = \"revolute\", bodies = [\"rod\", \"ram\"], at = \"B\" }\n\
    [joints.slide]\ntype = \"translational\"\nbodies = [\"ground\", \"ram\"]\nat = \"B\"\naxis = \"x\"\n\
    limits.displacement = { min = -40, max = 30MORE }\n\
    [drivers]\ncrank = { joint = \"crank\", law = \"-180*t\" }\n[design]\nradius = { move = \"A\", along = \"y\" }\n\
    [time]\nend = 2.0\nsteps = 20\n";

#[test]
fn a_limit_that_is_exceeded_is_a_warning_with_its_exact_time() {
    let bench = Bench::with(&[]);
    bench.put("press.toml", &PRESS.replace("MORE", ""));
    let output = bench.run(&["run", "press.toml"]);
    assert_eq!(output.status.code(), Some(0));
    let [out, err] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned());
    let sentence = "warning[HP0269]: slide.displacement reaches its maximum of 30 mm at t = 0.2283956 s (crank -41.111 deg)";
    assert!(err.contains(sentence), "{err}");
    assert!(err.contains("it exceeds its maximum by up to 18.348 mm, at t = 0.5 s"), "{err}");
    assert!(out.contains("Limits of joints") && out.contains("-31.652 to 48.348 mm"), "{out}");
    let summary = bench.json("results/press/summary.json");
    let limit = &summary["joint_limits"][0];
    assert_eq!((&limit["name"], &limit["kept"]), (&"slide.displacement".into(), &false.into()));
    assert_eq!(limit["crossings"].as_array().unwrap().len(), 2);
    assert_eq!(limit["crossings"][0]["sensitivities"][0]["unit"], "s/mm");
    let margin = limit["least"]["margin"].as_f64().unwrap();
    // 40 - (91.65... - 60)
    assert!((margin - (40.0 - (91.6515138991168 - 60.0))).abs() < 1e-9, "{margin}");
    let page = bench.page("results/press/report.html");
    let mut tables = page["checks"].as_array().unwrap().iter();
    assert!(tables.any(|table| table["title"] == "Limits of joints"));
}

#[test]
fn an_end_stop_ends_the_run_with_5_and_keeps_what_was_solved() {
    let bench = Bench::with(&[]);
    bench.put("press.toml", &PRESS.replace("MORE", ", stop = true"));
    let output = bench.run(&["run", "press.toml"]);
    assert_eq!(output.status.code(), Some(5));
    let err = String::from_utf8_lossy(&output.stderr).into_owned();
    let sentence =
        "warning[HP0268]: `slide.displacement` reaches its maximum at t = 0.2283956 s, which ends the motion";
    assert!(err.contains(sentence), "{err}");
    assert!(
        err.contains("its maximum is 30 mm; it is reached at t = 0.2283956 s, with crank -41.111 deg"),
        "{err}"
    );
    assert!(err.contains("curves and metrics cover the output times up to there"), "{err}");
    assert_eq!(bench.text("results/press/motion.csv").lines().count(), 1 + 3);

    bench.put("press.toml", &PRESS.replace("MORE", ", stop = true").replace("-40", "5"));
    let output = bench.run(&["run", "press.toml"]);
    assert_eq!(output.status.code(), Some(5));
    let err = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(err.contains("error[HP0267]: `slide.displacement` is beyond its minimum at t = 0 s"), "{err}");
}
