//! Designs found for goals, against designs that are known.

use std::num::NonZero;
use std::ops::ControlFlow;

use hardpoint::Analysis;
use hardpoint::model::{Goal, Optimization, VariableId};
use hardpoint::study::{Motions, Optimized, Progress, Searching, optimize};
use hardpoint::topology::Formulation;
use hardpoint_file::ModelFile;

pub fn optimized(file: &ModelFile, asked: &Optimization) -> Optimized {
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let mut progress = |k: usize, told: Progress<'_>| {
        if let Progress::Iteration(i) = told
            && std::env::var("SHOW").is_ok()
        {
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
            .map(|k| {
                format!("[{:?}, {:?}]", solution.motion.times[k], 1e3 * solution.measured.value(k, m)[0])
            })
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
        let d = s
            .found
            .as_ref()
            .map(|f| (0..8).map(|v| 1e3 * f.design[v] + f64::from(start[v])).collect::<Vec<_>>());
        println!(
            "{k} {:?} {:?} kkt {:.1e} designs {} refused {} {:.3?} {:?}",
            s.status,
            s.found.as_ref().map(|f| f.objective),
            s.optimality.residual,
            s.cost.designs,
            s.refused.len(),
            d,
            s.refused.first().map(|r| &r.why)
        );
    }
}

#[test]
fn strut_trial() {
    use hardpoint::law::Law;
    use hardpoint::model::{Case, CaseId, Limit, Limited};
    let text = std::fs::read_to_string("../../models/macpherson.toml").unwrap();
    let mut text = text.replace(
        "[wheels.front_left]",
        "[measures.rack]\ntype = \"coordinate\"\njoint = \"rack_slide\"\n[wheels.front_left]",
    );
    for v in ["tie_rod_outer_y", "tie_rod_outer_z", "tie_rod_inner_y", "tie_rod_inner_z"] {
        text = text.replace(&format!("[design.{v}]\n"), &format!("[design.{v}]\nbounds = [-15, 15]\n"));
    }
    text += "
[metrics.toe_error]
of = \"toe\"
over = \"wheel_travel\"
take = \"rms\"
target = [[-40, 0.3], [0, 0.2], [40, 0.0]]
[metrics.ackermann]
of = \"toe\"
over = \"rack\"
take = \"mean\"
[metrics.most]
of = \"toe\"
take = \"max\"
[metrics.spread]
of = \"toe\"
take = \"range\"
";
    let mut file = hardpoint_file::parse(&text, "strut.toml").unwrap_or_else(|e| panic!("{e}"));
    let times: Vec<f64> = (0..=100).map(|k| 0.01 * f64::from(k)).collect();
    let case = |name: &str, laws: [&str; 2]| Case {
        name: name.into(),
        laws: laws.map(|l| Some(Law::parse(l).unwrap())).to_vec(),
        formulas: Vec::new(),
        times: times.clone(),
    };
    file.model.cases = vec![case("bump", ["0", "0.04*(2*t-1)"]), case("steer", ["0.03*(2*t-1)", "0"])];
    file.model.metrics[0].case = Some(CaseId(0));
    file.model.metrics[1].case = Some(CaseId(1));
    file.model.metrics[2].case = Some(CaseId(0));
    file.model.metrics[3].case = Some(CaseId(0));
    let v = |n: &str| file.model.variable(n).unwrap();
    let variables =
        vec![v("tie_rod_outer_y"), v("tie_rod_outer_z"), v("tie_rod_inner_y"), v("tie_rod_inner_z")];
    let deg = 180.0 / std::f64::consts::PI;
    let goal = |metric: usize| Goal { name: String::new(), metric, target: None, weight: deg };
    let drawn = {
        let models = file.model.motions();
        let m = Motions::of(&models, Formulation::Relative).unwrap();
        let e = m.evaluate(&[], &mut Default::default(), &|| true).unwrap();
        println!("{:?}", e.metrics.iter().flatten().map(|m| m.value.map(|v| v * deg)).collect::<Vec<_>>());
        e.metrics[1][0].value.unwrap()
    };
    let limit =
        |of: Limited, least: Option<f64>, most: Option<f64>| Limit { name: String::new(), of, least, most };
    let base = Optimization {
        variables,
        goals: vec![goal(0)],
        limits: vec![],
        margin: None,
        starts: 1,
        iterations: 100,
    };
    let h = |n: &str| {
        hardpoint::model::HardpointId(file.model.hardpoints.iter().position(|h| h.name == n).unwrap())
    };
    for (what, goals, limits) in [
        ("free", vec![goal(0)], vec![]),
        ("ackermann", vec![goal(0)], vec![limit(Limited::Metric(1), Some(drawn), None)]),
        ("ackermann better", vec![goal(0)], vec![limit(Limited::Metric(1), Some(drawn + 0.3 / deg), None)]),
        (
            "equal",
            vec![goal(0)],
            vec![limit(Limited::Metric(1), Some(drawn + 0.3 / deg), Some(drawn + 0.3 / deg))],
        ),
        ("max", vec![goal(2)], vec![]),
        ("range", vec![goal(3)], vec![]),
        (
            "range, limited",
            vec![goal(3)],
            vec![
                limit(Limited::Metric(1), Some(drawn + 0.1 / deg), None),
                limit(Limited::Distance(h("tie_rod_inner"), h("tie_rod_outer")), None, Some(0.36)),
            ],
        ),
        (
            "plain",
            vec![Goal { weight: -deg, ..goal(1) }],
            vec![limit(Limited::Metric(3), None, Some(0.1 / deg))],
        ),
        ("impossible", vec![goal(0)], vec![limit(Limited::Metric(1), Some(drawn + 9.0 / deg), None)]),
    ] {
        println!("== {what}");
        let asked = Optimization { goals, limits, ..base.clone() };
        let o = optimized(&file, &asked);
        for s in &o.searches {
            println!(
                "{:?} {:#?} {:?} designs {} {:?}",
                s.status,
                s.found,
                s.optimality,
                s.cost.designs,
                s.refused.first()
            );
        }
    }
}
