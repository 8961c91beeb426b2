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
