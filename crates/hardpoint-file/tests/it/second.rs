//! Second derivatives of models from files: where first ones are zero, and of laws with formulas.

use hardpoint::{Analysis, Run};
use hardpoint_file::parse;

/// Differences of exact first derivatives: the square of the step, and round-off over it.
const AGREE: f64 = 1e-7;

#[test]
fn a_rod_moved_across_itself_and_a_law_by_a_formula_have_them() {
    // The rod is horizontal in the design configuration: its length has no first derivative by the height of its end.
    let text = r#"
name = "crank and slider"
units = { length = "m", angle = "rad" }

[parameters]
lift = { value = 0.4, typical = 0.1 }

[hardpoints]
O = [0.0, 0.0, 0.0]
A = [0.3, 0.4, 0.0]
C = [1.3, 0.4, 0.0]

[bodies]
crank = {}
slider = {}

[joints]
pivot = { type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "z" }
rod = { type = "distance", bodies = ["crank", "slider"], at = ["A", "C"] }
guide = { type = "translational", bodies = ["ground", "slider"], at = "C", axis = "x" }

[drivers]
motor = { joint = "pivot", law = "sin(lift*lift)*t" }

[design]
height = { move = "C", along = "y" }

[measures]
x = { type = "coordinate", joint = "guide" }

[time]
end = 1.0
steps = 4
"#;
    let model = parse(text, "slider.toml").unwrap_or_else(|e| panic!("{e}")).model;
    let analysis = Analysis::new(&model).unwrap();
    let directions = [vec![1.0, 0.0], vec![0.0, 1.0]];
    let pairs = [[0, 0], [0, 1], [1, 0], [1, 1]];
    let second = analysis.second(&[], &directions, &pairs);
    let x = second.outputs.iter().position(|o| o.name == "x").unwrap();
    let step = 1e-4;
    for (p, [u, w]) in pairs.into_iter().enumerate() {
        let [a, b] = [step, -step].map(|h| {
            let design: Vec<f64> = directions[w].iter().map(|d| h * d).collect();
            analysis.solve(Run::new().at(&design))
        });
        for k in 0..model.times.len() {
            let first = |run: &hardpoint::Solution| run.measured.d(k, hardpoint::model::VariableId(u), x)[0];
            let (found, expected) = (second.value(k, p, x), (first(&a) - first(&b)) / (2.0 * step));
            assert!((found - expected).abs() < AGREE, "{u} {w} at {k}: {found} instead of {expected}");
        }
    }
}
