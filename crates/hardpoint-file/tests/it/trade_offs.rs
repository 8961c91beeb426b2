//! Trade-offs: fronts with closed forms, and the first-order condition of every point.

use std::num::NonZero;
use std::ops::ControlFlow;

use hardpoint::topology::Formulation;
use hardpoint_file::{ModelFile, parse};
use hardpoint_study::trade_off::{ON_FRONT, Outcome, Overrides, Request, TradeOff, trade_off};
use hardpoint_study::{Control, Motions};

/// A point on a plate that turns, moved in the plane by two variables, at distances from points above the plane.
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

fn file(text: &str) -> ModelFile {
    parse(text, "plate.toml").unwrap_or_else(|e| panic!("{e}"))
}

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

#[test]
fn two_distances() {
    let file = file(&(PLATE.to_owned() + "[optimize]\ngoals = { to_a = {}, to_b = {} }\n"));
    show(&traded(&file, None));
}

#[test]
fn circle() {
    let file = file(&(PLATE.to_owned() + "[optimize]\ngoals = { x = {}, y = {} }\nlimits.far = { between = [\"O\", \"P\"], min = 50 }\nlimits.right = { hardpoint = \"P\", x = [0, 100], y = [0, 100] }\n"));
    show(&traded(&file, None));
}

#[test]
fn three_distances() {
    let file = file(&(PLATE.to_owned() + "[optimize]\ngoals = { to_a = {}, to_b = {}, to_c = {} }\n"));
    show(&traded(&file, None));
}

#[test]
fn wishbone() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../hardpoint-cli/templates/double-wishbone.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let k = text.find("[optimize]").unwrap();
    let text = text[..k].to_owned() + "[metrics.recession]\ncase = \"bump\"\nof = \"wheel.half_track_change\"\ntake = \"rms\"\n[optimize]\ngoals = { bump_steer = {}, recession = {}, camber_gain = { target = -0.03 } }\nlimits.rod = { length = \"tie_rod\", min = 300 }\ntrade_off=[\"bump_steer\",\"recession\"]";
    show(&traded(&file(&text), std::env::var("POINTS").ok().map(|n| n.parse().unwrap())));
    let text = text.replace("trade_off=[\"bump_steer\",\"recession\"]", "trade_off=[\"bump_steer\",\"recession\", \"camber_gain\"]");
    show(&traded(&file(&text), None));
}
