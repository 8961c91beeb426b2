use std::num::NonZero;
use std::ops::ControlFlow;
use hardpoint::topology::Formulation;
use hardpoint_file::{ModelFile, parse};
use hardpoint_study::trade_off::{Overrides, Request, TradeOff, trade_off};
use hardpoint_study::{Control, Motions};
const PLATE: &str = r#"
name = "plate"
units = { length = "mm", angle = "deg" }
hardpoints = { O = [0, 0, 0], P = [30, 40, 0], A = [0, 0, 20], B = [100, 0, 20], C = [0, 80, 20] }
bodies = { plate = {} }
joints.pivot = { type = "revolute", bodies = ["ground", "plate"], at = "O", axis = "z" }
drivers.motor = { joint = "pivot", law = "10*t" }
design.P_x = { move = "P", along = "x", bounds = [-200, 200] }
design.P_y = { move = "P", along = "y", bounds = [-200, 200] }
points.P = { body = "plate", at = "P" }
points.A = { body = "ground", at = "A" }
points.B = { body = "ground", at = "B" }
points.C = { body = "ground", at = "C" }
measures.a = { type = "distance", from = "A", to = "P" }
measures.b = { type = "distance", from = "B", to = "P" }
measures.c = { type = "distance", from = "C", to = "P" }
metrics.to_a = { of = "a", take = "value", at = 0 }
metrics.to_b = { of = "b", take = "value", at = 0 }
metrics.to_c = { of = "c", take = "value", at = 0 }
metrics.x = { of = "P.x", take = "value", at = 0 }
metrics.y = { of = "P.y", take = "value", at = 0 }
time = { end = 1, steps = 2 }
"#;

fn traded(file: &ModelFile, points: Option<usize>) -> TradeOff {
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let request = Request::of(&file.model, Overrides { points, ..Overrides::default() }).unwrap();
    let control = Control {
        threads: NonZero::<usize>::MIN,
        progress: &mut |_| ControlFlow::Continue(()),
        more: &|| true,
    };
    trade_off(&file.model, &motions, &request, control)
}

fn show(found: &TradeOff) {
    println!("{:?} failed {} dominated {} jumps {:?} anchors {} cost {:?}", found.outcome, found.failed, found.dominated, found.jumps, found.anchor_designs, found.cost);
    for p in &found.points {
        println!("{:?} {:?} w {:?} r {:e} n {} {:?}", p.values, p.assessment.design, p.weights, p.residual, p.designs, p.anchor);
    }
}


fn main() {
    let which = std::env::args().nth(1).unwrap();
    let points = std::env::args().nth(2).map(|n| n.parse().unwrap());
    let text = match which.as_str() {
        "two" => PLATE.to_owned() + "[optimize]\ngoals = { to_a = {}, to_b = {} }\n",
        "circle" => PLATE.to_owned() + "[optimize]\ngoals = { x = {}, y = {} }\nlimits.far = { between = [\"O\", \"P\"], min = 50 }\nlimits.right = { hardpoint = \"P\", x = [0, 100], y = [0, 100] }\n",
        "three" => PLATE.to_owned() + "[optimize]\ngoals = { to_a = {}, to_b = {}, to_c = {} }\n",
        "loose" => PLATE.replace("design.P_x", "design.B = { move = \"B\", along = \"xyz\", bounds = [-30, 30] }\ndesign.P_x") + "[optimize]\ngoals = { to_a = {}, to_b = {} }\n",
        "w2" | "w3" => {
            let text = std::fs::read_to_string("crates/hardpoint-cli/templates/double-wishbone.toml").unwrap();
            let k = text.find("[optimize]").unwrap();
            text[..k].to_owned() + "[metrics.recession]\ncase = \"bump\"\nof = \"wheel.half_track_change\"\ntake = \"rms\"\n[optimize]\ngoals = { bump_steer = {}, recession = {}, camber_gain = { target = -0.03 } }\nlimits.rod = { length = \"tie_rod\", min = 300 }\n" + if which == "w2" { "trade_off = [\"bump_steer\", \"recession\"]\n" } else { "" }
        }
        path => std::fs::read_to_string(path).unwrap(),
    };
    let start = std::time::Instant::now();
    let found = traded(&parse(&text, "model.toml").unwrap_or_else(|e| panic!("{e}")), points);
    show(&found);
    println!("{:?}", start.elapsed());
}
