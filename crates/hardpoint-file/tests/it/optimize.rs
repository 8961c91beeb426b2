//! Designs found for goals, against designs that are known.

use std::num::NonZero;
use std::ops::ControlFlow;

use hardpoint::Analysis;
use hardpoint::model::{Goal, Optimization, VariableId};
use hardpoint::study::{Iteration, Motions, Optimized, Searching, optimize};
use hardpoint::topology::Formulation;
use hardpoint_file::ModelFile;

pub fn optimized(file: &ModelFile, asked: &Optimization) -> Optimized {
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let mut progress = |k: usize, i: &Iteration| {
        if std::env::var("SHOW").is_ok() {
            println!(
                "{k} {:3} f {:.6e} v {:.1e} step {:.1e} designs {}",
                i.number, i.objective, i.violation, i.step, i.designs
            );
        }
        ControlFlow::Continue(())
    };
    let searching = Searching { progress: &mut progress, more: &|| true, threads: NonZero::<usize>::MIN };
    optimize(&file.model, &motions, asked, searching)
}

#[test]
fn four_bar_inverse() {
    let text = std::fs::read_to_string("../../models/four_bar.toml").unwrap();
    let known = hardpoint_file::parse(&text, "four_bar.toml").unwrap();
    let solution = Analysis::new(&known.model).unwrap().run();
    let target = |name: &str| {
        let m = solution.measured.index(name).unwrap();
        let points: Vec<String> = (0..solution.measured.len())
            .map(|k| format!("[{:?}, {:?}]", solution.motion.times[k], 1e3 * solution.measured.value(k, m)[0]))
            .collect();
        points.join(", ")
    };
    let text = text
        .replace("A = [0, 0, 0]", "A = [-45, 45, 0]")
        .replace("B = [40, 200, 0]", "B = [65, 260, 0]")
        .replace("C = [360, 600, 0]", "C = [300, 500, 0]")
        .replace("D = [400, 0, 0]", "D = [515, -85, 0]")
        .replace("at = [200, 400, 0]", "at = [\"(B.x + C.x)/2\", \"(B.y + C.y)/2\", 0]");
    let bounds = [[-50, 50], [-50, 50], [20, 80], [180, 280], [240, 380], [400, 620], [180, 520], [-100, 20]];
    let start = [-45, 45, 65, 260, 300, 500, 515, -85];
    let names = ["A_x", "A_y", "B_x", "B_y", "C_x", "C_y", "D_x", "D_y"];
    let mut text = text;
    for k in 0..8 {
        let b = bounds[k].map(|b| b - start[k]);
        let (p, a) = names[k].split_once('_').unwrap();
        text = text.replace(
            &format!("{} = {{ move = \"{p}\", along = \"{a}\" }}", names[k]),
            &format!("{} = {{ move = \"{p}\", along = \"{a}\", bounds = [{}, {}] }}", names[k], b[0], b[1]),
        );
    }
    text += &format!(
        "\n[metrics]\nx = {{ of = \"midpoint_x\", take = \"rms\", target = [{}] }}\ny = {{ of = \"midpoint_y\", take = \"rms\", target = [{}] }}\n",
        target("midpoint_x"),
        target("midpoint_y")
    );
    let file = hardpoint_file::parse(&text, "inverse.toml").unwrap_or_else(|e| panic!("{e}"));
    let goal = |metric: usize| Goal { name: String::new(), metric, target: None, weight: 1.0 };
    let asked = Optimization {
        variables: (0..8).map(VariableId).collect(),
        goals: vec![goal(0), goal(1)],
        limits: vec![],
        margin: None,
        starts: std::env::var("STARTS").map_or(1, |s| s.parse().unwrap()),
        iterations: 100,
    };
    let found = optimized(&file, &asked);
    for (k, s) in found.searches.iter().enumerate() {
        let d = s.found.as_ref().map(|f| (0..8).map(|v| 1e3 * f.design[v] + f64::from(start[v])).collect::<Vec<_>>());
        println!("{k} {:?} {:?} kkt {:.1e} designs {} refused {} {:.3?} {:?}", s.status, s.found.as_ref().map(|f| f.objective), s.optimality.residual, s.cost.designs, s.refused.len(), d, s.refused.first().map(|r| &r.why));
    }
}
