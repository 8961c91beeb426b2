//! Writes a report of a slider-crank whose motion and sensitivities come from its closed form, so that
//! the page can be tried without the solver: `cargo run --example sample_page -- sample.html`.
//!
//! With `--partial` the motion stops at 60 % of its steps, as when a mechanism fails to assemble.

use hardpoint_report::page::*;
use num_dual::{Dual2, Dual64, DualNum};
use std::{env, error::Error, f64::consts::TAU, fs};

const STEPS: usize = 241;
/// Stride of the steps with differences.
const MARKED: usize = 7;
const DURATION: f64 = 2.0;
const CRANK: f64 = 50.0;
const ROD: f64 = 150.0;
const FD_STEP: f64 = 1e-3;

/// Two time derivatives, each with its derivative by one design variable.
type Jet = Dual2<Dual64>;

/// The design: crank radius, rod length (mm), angle of the crank pin on its body (deg).
#[derive(Clone, Copy)]
struct Design<T> {
    crank: T,
    rod: T,
    phase: T,
}

/// A named figure of the mechanism at a time.
type Formula = fn(Jet, Design<Jet>) -> Jet;

fn angle(time: Jet, design: Design<Jet>) -> Jet {
    time * (TAU / DURATION) + design.phase * (TAU / 360.0)
}

fn rod_angle(time: Jet, design: Design<Jet>) -> Jet {
    (angle(time, design).sin() * design.crank / design.rod).asin() * -(360.0 / TAU)
}

fn slider_x(time: Jet, design: Design<Jet>) -> Jet {
    let height = angle(time, design).sin() * design.crank;
    angle(time, design).cos() * design.crank + (design.rod * design.rod - height * height).sqrt()
}

fn pin_y(time: Jet, design: Design<Jet>) -> Jet {
    angle(time, design).sin() * design.crank
}

/// The design with one of its three numbers changed by `change` and seeded with `slope`.
fn design(seeded: usize, change: f64, slope: f64) -> Design<Jet> {
    let number = |index: usize, value: f64| {
        let (change, slope) = if index == seeded { (change, slope) } else { (0.0, 0.0) };
        Jet::from_re(Dual64::new(value + change, slope))
    };
    Design { crank: number(0, CRANK), rod: number(1, ROD), phase: number(2, 0.0) }
}

fn at(formula: Formula, time: f64, design: Design<Jet>) -> [Dual64; 3] {
    let jet = formula(Jet::new(time.into(), Dual64::from(1.0), Dual64::from(0.0)), design);
    [jet.re, jet.v1, jet.v2]
}

fn curves(times: &[f64], number: impl Fn(f64, usize) -> f64) -> [Curve; 3] {
    [0, 1, 2].map(|order| times.iter().map(|&time| number(time, order)).collect())
}

fn sensitivity(times: &[f64], quantity: usize, formula: Formula, variable: usize) -> Sensitivity {
    let exact = |time, order: usize| at(formula, time, design(variable, 0.0, 1.0))[order].eps;
    let difference = |time, order: usize| {
        let moved = |change| at(formula, time, design(variable, change, 0.0))[order].re;
        (moved(FD_STEP) - moved(-FD_STEP)) / (2.0 * FD_STEP)
    };
    let worst = [0, 1, 2].map(|order| {
        let largest = |f: &dyn Fn(f64) -> f64| times.iter().map(|&time| f(time).abs()).fold(0.0, f64::max);
        let size = largest(&|time| exact(time, order));
        let gap = largest(&|time| exact(time, order) - difference(time, order));
        if size > 0.0 { gap / size } else { gap }
    });
    let [value, rate, accel] = curves(times, exact);
    let marked: Vec<f64> = times.iter().copied().step_by(MARKED).collect();
    let [fd_value, fd_rate, fd_accel] = curves(&marked, difference);
    let step_unit = if variable == 2 { "deg" } else { "mm" }.into();
    let fd = FiniteDifference {
        stride: MARKED,
        value: fd_value,
        rate: fd_rate,
        accel: fd_accel,
        step: FD_STEP,
        step_unit,
        worst,
    };
    Sensitivity { quantity, value, rate, accel, fd: Some(fd) }
}

fn track(
    name: &str,
    times: &[f64],
    points: &[(&str, [f64; 3])],
    place: impl Fn(f64) -> (f64, f64, f64),
) -> BodyTrack {
    let poses = times.iter().flat_map(|&time| {
        let (x, y, turn) = place(time);
        [x, y, 0.0, (turn / 2.0).cos(), 0.0, 0.0, (turn / 2.0).sin()]
    });
    BodyTrack {
        name: name.into(),
        poses: poses.collect(),
        skeleton: points.iter().map(|&(_, point)| point).collect(),
        labels: points.iter().map(|&(label, _)| label.into()).collect(),
        roles: vec![PointRole::Joint; points.len()],
        mesh: None,
    }
}

fn bodies(times: &[f64]) -> Vec<BodyTrack> {
    let now = |formula: Formula, time| at(formula, time, design(0, 0.0, 0.0))[0].re;
    let pin = |time| {
        let turn = now(angle, time);
        (CRANK * turn.cos(), CRANK * turn.sin())
    };
    vec![
        track("ground", times, &[("main bearing", [0.0; 3])], |_| (0.0, 0.0, 0.0)),
        track("crank", times, &[("main bearing", [0.0; 3]), ("crank pin", [CRANK, 0.0, 0.0])], |time| {
            (0.0, 0.0, now(angle, time))
        }),
        track("rod", times, &[("crank pin", [0.0; 3]), ("wrist pin", [ROD, 0.0, 0.0])], |time| {
            let (x, y) = pin(time);
            (x, y, now(rod_angle, time).to_radians())
        }),
        track("slider", times, &[("wrist pin", [0.0; 3])], |time| (now(slider_x, time), 0.0, 0.0)),
    ]
}

fn joints() -> Vec<JointMark> {
    let joint =
        |name: &str, kind: &'static str, [body_i, body_j]: [usize; 2], at_i, at_j, axis, cut| JointMark {
            name: name.into(),
            kind,
            body_i,
            body_j,
            at_i,
            at_j,
            axis: Some(axis),
            axis_j: Some(axis),
            axis2: None,
            slide: (kind == "translational").then_some(SlideMark { along: Some(axis), either: true }),
            hinge: None,
            lead: None,
            curve: None,
            draw: None,
            cut,
        };
    let (z, x) = ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
    let pin = [CRANK, 0.0, 0.0];
    vec![
        joint("main_bearing", "revolute", [0, 1], [0.0; 3], [0.0; 3], z, false),
        joint("crank_pin", "revolute", [1, 2], pin, [0.0; 3], z, false),
        joint("wrist_pin", "revolute", [2, 3], [ROD, 0.0, 0.0], [0.0; 3], z, true),
        joint("guide", "translational", [3, 0], [0.0; 3], [0.0; 3], x, false),
    ]
}

const QUANTITIES: [(&str, &str, &str, Formula); 3] = [
    ("slider_x", "mm", "measure", slider_x),
    ("rod_angle", "deg", "measure", rod_angle),
    ("crank_pin.y", "mm", "point", pin_y),
];

fn quantities(times: &[f64]) -> Vec<Quantity> {
    let quantity = |&(name, unit, group, formula): &(&str, &str, &str, Formula)| {
        let [value, rate, accel] =
            curves(times, |time, order| at(formula, time, design(0, 0.0, 0.0))[order].re);
        Quantity {
            name: name.into(),
            unit: unit.into(),
            rate_unit: format!("{unit}/s"),
            accel_unit: format!("{unit}/s^2"),
            group: group.into(),
            kind: if group == "point" { "position" } else { "coordinate" }.into(),
            value,
            rate,
            accel,
            wanted: Curve::default(),
        }
    };
    QUANTITIES.iter().map(quantity).collect()
}

fn variables(times: &[f64]) -> Vec<Variable> {
    let variable = |index: usize, name: &str, description: &str, unit: &str, body, at, v, turn| Variable {
        name: name.into(),
        description: description.into(),
        unit: unit.into(),
        admissibility: Admissibility::Admissible,
        note: String::new(),
        arrows: vec![Arrow { body, at, v, turn }],
        typical: None,
        tolerance: None,
        bounds: None,
        shifts: vec![],
        sensitivities: (QUANTITIES.iter().enumerate())
            .map(|(quantity, &(.., formula))| sensitivity(times, quantity, formula, index))
            .collect(),
    };
    let still = [0.0; 3];
    let crank = variable(
        0,
        "crank_radius",
        "crank pin, outwards",
        "mm",
        1,
        [CRANK, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        still,
    );
    let rod = Variable {
        admissibility: Admissibility::Reassembled,
        note: "The joint `wrist_pin` would open by 1 mm per mm; the slider moves to close it.".into(),
        ..variable(
            1,
            "rod_length",
            "wrist pin, away from the crank",
            "mm",
            2,
            [ROD, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            still,
        )
    };
    let phase = variable(2, "crank_phase", "crank on its shaft", "deg", 1, still, still, [0.0, 0.0, 1.0]);
    let tilt = Variable {
        admissibility: Admissibility::CannotFollow,
        note: "No motion closes `crank_pin`: its axes would part by 1 deg per deg.".into(),
        arrows: vec![Arrow { body: 1, at: [CRANK, 0.0, 0.0], v: still, turn: [1.0, 0.0, 0.0] }],
        shifts: vec![],
        sensitivities: vec![],
        ..variable(0, "crank_pin_tilt", "axis of the crank pin", "deg", 1, still, still, still)
    };
    vec![crank, rod, phase, tilt]
}

fn checks() -> Vec<Table> {
    let words = |row: &[&str]| row.iter().map(|&cell| cell.to_owned()).collect::<Vec<_>>();
    vec![
        Table {
            title: "Joints".into(),
            note: "A cut joint closes a loop; all others carry their second body.".into(),
            header: words(&["joint", "kind", "bodies", "role", "why"]),
            rows: vec![
                words(&["main_bearing", "revolute", "ground – crank", "tree", "driven"]),
                words(&["crank_pin", "revolute", "crank – rod", "tree", ""]),
                words(&["guide", "translational", "ground – slider", "tree", ""]),
                words(&[
                    "wrist_pin",
                    "revolute",
                    "rod – slider",
                    "cut",
                    "closes the loop with the fewest unknowns",
                ]),
            ],
        },
        Table {
            title: "Redundancy".into(),
            note: "A planar loop in space: three constraints repeat what the others say.".into(),
            header: words(&["joint", "constraint", "left out"]),
            rows: vec![
                words(&["wrist_pin", "z of the point", "yes"]),
                words(&["wrist_pin", "both tilts", "yes"]),
            ],
        },
    ]
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let partial = arguments.iter().any(|argument| argument == "--partial");
    let path =
        arguments.iter().find(|argument| !argument.starts_with("--")).ok_or("name the file to write")?;
    let solved = if partial { STEPS * 3 / 5 } else { STEPS };
    let times: Vec<f64> = (0..solved).map(|k| DURATION * k as f64 / (STEPS - 1) as f64).collect();
    let fact = |label: &str, value: &str| Fact { label: label.into(), value: value.into() };
    let payload = Payload {
        title: "Slider-crank".into(),
        description: "A crank turns once in two seconds and moves a slider by its rod".into(),
        file: "slider_crank.toml".into(),
        generator: concat!("hardpoint ", env!("CARGO_PKG_VERSION")).into(),
        units: Units { length: "mm".into(), angle: "deg".into(), time: "s".into() },
        status: Status {
            complete: !partial,
            message: if partial {
                "It stops at t = 1.2 s of 2 s: the mechanism does not assemble beyond.".into()
            } else {
                "All 241 steps were solved.".into()
            },
        },
        summary: vec![
            fact("degrees of freedom", "0 (1 driven)"),
            fact("loops", "1"),
            fact("steps", &solved.to_string()),
            fact("worst residual", "closed form"),
            fact("design variables", "4"),
        ],
        notes: vec!["3 redundant constraints among `crank_pin`, `guide` and `wrist_pin`".into()],
        bodies: bodies(&times),
        joints: joints(),
        couplers: vec![],
        drivers: vec![DriverMark {
            name: "motor".into(),
            law: "pi*t".into(),
            joint: Some(0),
            turns: true,
            point: None,
            along: None,
            travel: times.iter().map(|t| TAU * t / DURATION).collect(),
            alone: vec![],
        }],
        wheels: vec![],
        distances: vec![],
        loads: vec![],
        vehicle: None,
        quantities: quantities(&times),
        values: vec![],
        metrics: None,
        first: Some(0),
        over: None,
        plots: vec![],
        designs: vec![],
        named_designs: vec![],
        maps: vec![],
        sweep: None,
        margin: Some(Margin {
            value: times.iter().map(|t| 0.2 - 0.15 * (TAU * t / DURATION).cos()).collect(),
            note: "The least margin is 0.05 at t = 0 s: about one of 16 digits is lost there.".into(),
        }),
        variables: variables(&times),
        covariance_root: None,
        study: None,
        checks: checks(),
        clearance: None,
        model: None,
        times: times.into_iter().collect(),
    };
    fs::write(path, html(&payload)?)?;
    Ok(())
}
