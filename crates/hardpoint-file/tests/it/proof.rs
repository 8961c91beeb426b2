//! Proofs that clearances are kept between the output times.

use hardpoint::Analysis;
use hardpoint::model::{Model, ShapeId};
use hardpoint::run::{ClearanceProof, ClearanceProver, ProofFailure, Run};
use hardpoint_file::parse;

/// Allowance for round-off, as a fraction of the mechanism's size.
const ROUND_OFF: f64 = 1e-12;

fn model_of(text: &str) -> Model {
    parse(text, "proof.toml").unwrap_or_else(|e| panic!("{e}\n{text}")).model
}

#[test]
fn the_least_distances_of_the_knee_are_proved_and_greater_ones_are_not() {
    let model = model_of(include_str!("knee.toml"));
    let analysis = Analysis::new(&model).unwrap();
    let found = analysis.clearances(&[]);
    let mut prover = analysis.clearance_prover(&[]).unwrap();
    for pair in &found.pairs {
        assert_exact(&mut prover, pair.shapes, pair.least().unwrap().at.distance[0], model.size(), 60);
    }
    // The bounds of the motion are computed once.
    assert!(prover.enclosures() < 100, "{}", prover.enclosures());
}

/// The least distance, m, is proved but for round-off with at most this number of bounds, and one that is 1e-6 mm
/// greater is not.
fn assert_exact(prover: &mut ClearanceProver<'_>, shapes: [ShapeId; 2], least: f64, size: f64, most: usize) {
    let proof = prover.prove(shapes, least - ROUND_OFF * size);
    let ClearanceProof::Proved { slabs, bounds } = proof else { panic!("{shapes:?}, {least}: {proof:?}") };
    assert!(0 < slabs && slabs <= bounds && bounds <= most, "{shapes:?}: {proof:?}");
    let refused = prover.prove(shapes, least + 1e-9);
    assert!(matches!(refused, ClearanceProof::NotProved { .. }), "{shapes:?}, {least}: {refused:?}");
}

/// Shapes on the bodies of two suspensions: capsules, spheres, cylinders, planes.
const SUSPENSIONS: [(&str, &str); 2] = [
    (
        include_str!("../../../../models/double_wishbone.toml"),
        r#"
[shapes]
arm = { body = "uca", capsule = ["uca_rear", "upper_ball"], radius = 12 }
lower = { body = "lca", capsule = ["lca_front", "lower_ball"], radius = 12 }
end = { body = "knuckle", sphere = "tie_rod_outer", radius = 15 }
drum = { body = "ground", cylinder = [[-60, 380, 60], [-60, 420, 60]], radius = 30, round = 2 }
post = { body = "ground", capsule = [[-40, 430, 380], [-40, 470, 390]], radius = 10 }
road = { body = "ground", plane = [0, 0, 0], normal = "z" }
[clearances.upper]
between = [["arm"], ["drum", "post"]]
[clearances.others]
between = [["lower", "end"], ["drum", "post", "road"]]
"#,
    ),
    (
        include_str!("../../../../models/macpherson.toml"),
        r#"
[shapes]
arm = { body = "lca", capsule = ["lca_front", "ball_joint"], radius = 15 }
rod_end = { body = "knuckle", sphere = "tie_rod_outer", radius = 12 }
tube = { body = "knuckle", capsule = ["strut_lower", "ball_joint"], radius = 20 }
beam = { body = "ground", capsule = [[100, 420, 60], [200, 500, 60]], radius = 20 }
drum = { body = "ground", cylinder = [[-120, 560, 150], [-120, 600, 150]], radius = 40, round = 3 }
floor = { body = "ground", plane = [0, 0, -260], normal = "z" }
[clearances.all]
between = [["arm", "rod_end", "tube"], ["beam", "drum", "floor"]]
"#,
    ),
];

#[test]
fn clearances_of_suspensions_are_proved() {
    for (text, shapes) in SUSPENSIONS {
        let model = model_of(&format!("{text}\n{shapes}"));
        let analysis = Analysis::new(&model).unwrap();
        let found = analysis.clearances(&[]);
        assert!(found.pairs.len() >= 8);
        let mut prover = analysis.clearance_prover(&[]).unwrap();
        for pair in &found.pairs {
            let least = pair.least().unwrap().at.distance[0];
            // Little more than one bound for each output step.
            assert_exact(&mut prover, pair.shapes, least, model.size(), model.times.len() + 20);
        }
    }
}

/// Deterministic generator of numbers in (0, 1).
pub fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A four-bar of about 60 mm whose crank turns by 160 deg, with a screw near the way of its coupler; `None` if it does
/// not assemble over the turn with a transmission angle above 8.6 deg.
fn four_bar(next: &mut impl FnMut() -> f64) -> Option<(Model, f64)> {
    let mut between = |low: f64, high: f64| low + (high - low) * next();
    let crank = [between(-30.0, 30.0), between(-30.0, 30.0)];
    let coupler = [between(30.0, 90.0), between(10.0, 70.0)];
    let pivot = [between(40.0, 80.0), between(-30.0, 10.0)];
    let screw = [between(-20.0, 90.0), between(-30.0, 80.0)];
    let (rod, head) = (between(1.0, 5.0), between(1.0, 5.0));
    let length = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let [l1, l2, l3] = [length([0.0; 2], crank), length(crank, coupler), length(coupler, pivot)];
    if l1 < 10.0 {
        return None;
    }
    let start = crank[1].atan2(crank[0]);
    for k in 0..=400 {
        let angle = start + f64::from(k) / 400.0 * 160f64.to_radians();
        let d = length([l1 * angle.cos(), l1 * angle.sin()], pivot);
        let cosine = (l2 * l2 + l3 * l3 - d * d) / (2.0 * l2 * l3);
        if !(cosine.abs() < 8.6f64.to_radians().cos()) {
            return None;
        }
    }
    let model = model_of(&format!(
        r#"
name = "four-bar"
units = {{ length = "mm", angle = "deg" }}
planar = "xy"
bodies = {{ ground = ["A", "D"], crank = ["A", "B"], coupler = ["B", "C"], rocker = ["C", "D"] }}
drivers.motor = {{ joint = "A", law = "160*t" }}
time = {{ end = 1.0, steps = 8 }}
[hardpoints]
A = [0, 0]
B = {crank:?}
C = {coupler:?}
D = {pivot:?}
[shapes]
rod = {{ body = "coupler", capsule = ["B", "C"], radius = {rod} }}
screw = {{ body = "ground", capsule = [[{x}, {y}, -2], [{x}, {y}, 7]], radius = {head} }}
[clearances.c]
between = ["rod", "screw"]
"#,
        x = screw[0],
        y = screw[1],
    ));
    Some((model, 1e-3 * (rod + head)))
}

/// Least distance of a pair at this number of times.
fn sampled(model: &Model, shapes: [ShapeId; 2], samples: usize) -> f64 {
    let (first, last) = (model.times[0], *model.times.last().unwrap());
    let times = (0..=samples).map(|k| first + (last - first) * k as f64 / samples as f64).collect();
    let dense = Model { times, metrics: Vec::new(), ..model.clone() };
    let analysis = Analysis::new(&dense).unwrap();
    let solution = analysis.solve(Run::new().without_measures().without_sensitivities());
    let distances = analysis.distances(&[], &solution.motion, &[shapes], 0..solution.motion.len());
    assert_eq!(distances[0].len(), samples + 1);
    distances[0].iter().map(|at| at.distance[0]).fold(f64::INFINITY, f64::min)
}

#[test]
fn two_hundred_four_bars_are_proved_and_greater_claims_are_refused() {
    // `HARDPOINT_FOUR_BARS=1000` sets their number, each against 100,000 samples.
    let more = std::env::var("HARDPOINT_FOUR_BARS").ok().map(|n| n.parse::<usize>().expect("a number"));
    let (most, samples) = more.map_or((200, 500), |n| (n, 100_000));
    let mut next = numbers(5);
    let (mut counts, mut tried) = (Vec::new(), 0);
    while counts.len() < most {
        tried += 1;
        let Some((model, rounds)) = four_bar(&mut next) else { continue };
        let analysis = Analysis::new(&model).unwrap();
        let found = analysis.clearances(&[]);
        let pair = &found.pairs[0];
        let least = pair.least().unwrap();
        // Where the cores meet there is no distance.
        if found.stop.is_some() || least.at.cores_meet || pair.curve.iter().any(|s| s.cores_meet) {
            continue;
        }
        let least = least.at.distance[0];
        if least + rounds < 1e-5 {
            continue;
        }
        assert!(least <= sampled(&model, pair.shapes, samples) + ROUND_OFF * model.size());
        let mut prover = analysis.clearance_prover(&[]).unwrap();
        let proof = prover.prove(pair.shapes, least - ROUND_OFF * model.size());
        let ClearanceProof::Proved { bounds, slabs } = proof else {
            panic!("four-bar {} of {tried}, least {least}: {proof:?}", counts.len());
        };
        assert!(slabs <= bounds);
        counts.push(bounds);
        // 1e-6 mm above the least.
        let refused = prover.prove(pair.shapes, least + 1e-9);
        assert!(matches!(refused, ClearanceProof::NotProved { .. }), "{refused:?}");
    }
    counts.sort_unstable();
    println!(
        "{tried} tried; bounds {} in the median, {} at 90 %, {} at most",
        counts[most / 2],
        counts[most * 9 / 10],
        counts[most - 1]
    );
    assert!(counts[most - 1] <= 200, "{counts:?}");
}

/// A spatial four-bar with two output times, between which its crank turns there and back.
const FEW: &str = r#"
name = "few"
units={length="mm",angle="deg"}
time={end=0.3,steps=1}
[hardpoints]
A=[-185.9053351578918, 326.09864224899655, 77.92621685936294]
B=[-177.63380259858425, 320.74501937448406, 164.28453907933232]
C=[-182.67072196325253, 279.17032476371037, 123.90930392316115]
D=[-178.14324828872395, 229.12722423017829, 184.0108992338451]
[bodies]
crank={}
coupler={}
rocker={}
[joints]
A={type="revolute",bodies=["ground","crank"],at="A",axis=[-0.9949405551565824, 0.026403368842365826, 0.09693375995227671]}
B={type="spherical",bodies=["crank","coupler"],at="B"}
C={type="cylindrical",bodies=["coupler","rocker"],at="C",axis=[-0.9949405551565824, 0.026403368842365826, 0.09693375995227671]}
D={type="revolute",bodies=["ground","rocker"],at="D",axis=[-0.9949405551565824, 0.026403368842365826, 0.09693375995227671]}
[drivers]
m={joint="A",law="-89.91209713436075*sin(8.901179185171081*t)^2"}
[shapes]
s0={body="ground",sphere=[-173.13557231124628, 305.7517209731764, 137.8407196091054],radius=4.760652742080526}
s1={body="crank",sphere=[-186.9413137071664, 292.78308134545745, 116.38975311924541],radius=0.9239609467529631}
s2={body="coupler",sphere=[-179.45807042223572, 337.24730094877333, 143.5677427002547],radius=3.3909623773923974}
s3={body="rocker",capsule=[[-172.4129845859307, 242.5930262923182, 198.5690693417746],[-162.83803016064368, 242.34691286677912, 182.5372249086176]],radius=4.534747535905368}
s4={body="ground",capsule=[[-195.67366652681267, 300.07885630877934, 125.55895781772512],[-184.67448379119546, 253.62823709949646, 161.9892528958281]],radius=4.314925590866034}
[clearances]
c0={between=["s0","s1"]}
c1={between=["s0","s2"]}
c2={between=["s0","s3"]}
c3={between=["s1","s2"]}
c4={between=["s1","s3"]}
c5={between=["s1","s4"]}
c6={between=["s2","s3"]}
c7={between=["s2","s4"]}
c8={between=["s3","s4"]}
"#;

#[test]
fn positions_far_from_all_output_times_are_found() {
    let model = model_of(FEW);
    let analysis = Analysis::new(&model).unwrap();
    let found = analysis.clearances(&[]);
    let mut prover = analysis.clearance_prover(&[]).unwrap();
    for pair in &found.pairs {
        let least = pair.least().unwrap().at.distance[0];
        let proof = prover.prove(pair.shapes, least - 1e-5 * model.size());
        assert!(matches!(proof, ClearanceProof::Proved { .. }), "{:?}: {proof:?}", pair.shapes);
    }
}

/// Four-bars whose crank turns by more than a turn between two output times: start of the motion, law, and shapes.
fn turning_four_bar([b, c, d]: [[f64; 2]; 3], (law, steps): (&str, usize), shapes: &str) -> Model {
    model_of(&format!(
        "name = \"four-bar\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\nplanar = \"xy\"\n\
         time = {{ end = 1.0, steps = {steps} }}\n\
         hardpoints = {{ A = [0, 0], B = {b:?}, C = {c:?}, D = {d:?} }}\n\
         bodies = {{ ground = [\"A\", \"D\"], crank = [\"A\", \"B\"], coupler = [\"B\", \"C\"], rocker = [\"C\", \"D\"] }}\n\
         drivers.m = {{ joint = \"A\", law = \"{law}\" }}\n[shapes]\n{shapes}"
    ))
}

#[test]
fn a_motion_of_two_turns_between_two_output_times_is_proved_every_time() {
    let places = [
        [32.61370540980185, 18.084006308436173],
        [118.24955404121644, -21.44618317609833],
        [54.631083053087366, 21.675303282769917],
    ];
    let shapes = r#"
cp = { body = "coupler", capsule = [[32.61370540980185, 18.084006308436173, -3], [118.24955404121644, -21.44618317609833, 6]], radius = 1.4 }
rk = { body = "rocker", capsule = [[118.24955404121644, -21.44618317609833, 3], [54.631083053087366, 21.675303282769917, 7]], radius = 5.8 }
sc = { body = "ground", capsule = [[144.6, -29.5, -3.3], [169, -19.3, 11.4]], radius = 3.8 }
ck = { body = "crank", capsule = [[-20.8, 4.4, 12.5], [-19, 24.1, 29.6]], radius = 1 }
[clearances]
c = { between = ["cp", "sc"] }
r = { between = ["rk", "sc"] }
k = { between = ["ck", "rk"] }
"#;
    let model = turning_four_bar(places, ("-650.9504831987459*t", 1), shapes);
    let analysis = Analysis::new(&model).unwrap();
    let found = analysis.clearances(&[]);
    let mut first = None;
    for _ in 0..4 {
        let mut prover = analysis.clearance_prover(&[]).unwrap();
        let proofs: Vec<ClearanceProof> = (found.pairs.iter())
            .map(|pair| {
                prover.prove(pair.shapes, pair.least().unwrap().at.distance[0] - 1e-12 * model.size())
            })
            .collect();
        assert!(proofs.iter().all(|proof| matches!(proof, ClearanceProof::Proved { .. })), "{proofs:?}");
        assert_eq!(first.get_or_insert_with(|| proofs.clone()), &proofs);
    }
}

#[test]
fn nothing_is_proved_where_cores_meet_and_that_is_the_reason() {
    let places = [
        [-24.02804015987379, -7.849589353101685],
        [-6.894766014263439, 39.38538858555558],
        [62.56108547814786, 27.575348503598057],
    ];
    let shapes = r#"
rk = { body = "rocker", capsule = [[-6.894766014263439, 39.38538858555558, -3.039843153273056], [62.56108547814786, 27.575348503598057, 3.862164132585818]], radius = 4.40591749210539 }
sc = { body = "ground", capsule = [[19.35837533289236, 59.561268077942614, 0.9296177216416623], [21.291308914830108, 41.74992900868929, -4.966734458377626]], radius = 4.317616690504298 }
[clearances]
r = { between = ["rk", "sc"] }
"#;
    let model = turning_four_bar(places, ("-536.9504780485019*t", 3), shapes);
    let analysis = Analysis::new(&model).unwrap();
    let found = analysis.clearances(&[]);
    let least = found.pairs[0].least().unwrap();
    assert!(least.at.cores_meet);
    let mut prover = analysis.clearance_prover(&[]).unwrap();
    for allowance in [1e-12, 1e-5] {
        let claim = least.at.distance[0] - allowance * model.size();
        let proof = prover.prove(found.pairs[0].shapes, claim);
        let is_meeting = matches!(proof, ClearanceProof::NotProved { reason: ProofFailure::CoresMeet, .. });
        assert!(is_meeting, "{allowance}: {proof:?}");
    }
}
