//! Clearances of random struts and random meshes, against samples, refined samples and brute force.

use std::collections::BTreeMap;

use hardpoint::Analysis;
use hardpoint::model::{Model, ShapeId, ShapeKind};
use hardpoint::motion::Motion;
use hardpoint::run::{ClearanceProof, Clearances, PairClearance, ProofFailure, Run, ShapeDistance};
use hardpoint::space::Vec3;
use hardpoint_file::parse;

use crate::proof::numbers;

/// Allowance for round-off, as a fraction of the mechanism's size.
const ROUND_OFF: f64 = 1e-12;
/// The same for the proof of a distance that does not change: no interval is so short that a bound has no slack.
const OF_CONSTANT: f64 = 1e-5;
/// Excess of a claim that must be refused, m: 1e-6 mm.
const EXCESS: f64 = 1e-9;
/// Deviation of a least distance from that of refined samples, m: 1e-9 mm.
const LOCATED: f64 = 1e-12;
/// Deviation of a distance of meshes from brute force, m: 1e-10 mm.
const BRUTE: f64 = 1e-13;
/// Deviation of a time of contact, s: its overlap is an interval of round-off of the positions.
const TOUCH: f64 = 1e-9;
/// Samples of the distance of meshes over the motion.
const DENSE: usize = 500;
/// Bounds of the proof of one pair, at most, and of one with a mesh.
const MOST_BOUNDS: usize = 200;
const MOST_BOUNDS_OF_MESH: usize = 4_000;
/// Points of one refinement of a sampled minimum, and the number of refinements: each is narrower by half of them. At a
/// kink the deviation of the last samples is of first order in their spacing.
const REFINED: usize = 24;
const REFINEMENTS: usize = 9;
/// Sampled minima that are refined: the lowest ones.
const LOWEST: usize = 3;

/// Number of random models: from this environment variable, with 100,000 samples each, or a few.
fn number_of(variable: &str, few: usize) -> (usize, usize) {
    let more = std::env::var(variable).ok().map(|n| n.parse().expect("a number"));
    more.map_or((few, 400), |n| (n, 100_000))
}

/// The seed of this environment variable, or this one.
fn seed_or(usual: u64) -> u64 {
    std::env::var("HARDPOINT_SEED").map_or(usual, |seed| seed.parse().expect("a number"))
}

/// Distances of a pair at some times, of which the motion is solved anew.
fn distances_at(model: &Model, shapes: [ShapeId; 2], times: Vec<f64>) -> Vec<ShapeDistance> {
    let dense = Model { times, metrics: Vec::new(), clearances: Vec::new(), ..model.clone() };
    let analysis = Analysis::new(&dense).unwrap();
    let solution = analysis.solve(Run::new().without_measures().without_sensitivities());
    assert!(solution.stop.is_none());
    analysis.distances(&[], &solution.motion, &[shapes], 0..solution.motion.len()).remove(0)
}

fn evenly(from: f64, to: f64, pieces: usize) -> Vec<f64> {
    (0..=pieces).map(|k| from + (to - from) * k as f64 / pieces as f64).collect()
}

/// The sampled minima of curves: values, and places.
fn lowest_of(samples: &[ShapeDistance]) -> Vec<usize> {
    let value = |k: usize| samples[k].distance[0];
    let last = samples.len() - 1;
    let is_low =
        |k: &usize| (*k == 0 || value(*k) <= value(*k - 1)) && (*k == last || value(*k) <= value(*k + 1));
    let mut lows: Vec<usize> = (0..=last).filter(is_low).collect();
    lows.sort_by(|a, b| value(*a).total_cmp(&value(*b)));
    lows.truncate(LOWEST);
    lows
}

/// Least distance of a pair by samples, and around the lowest ones of them by further samples.
fn refined(model: &Model, shapes: [ShapeId; 2], samples: &[ShapeDistance]) -> f64 {
    let mut least = f64::INFINITY;
    for k in lowest_of(samples) {
        let mut around = [samples[k.saturating_sub(1)].time, samples[(k + 1).min(samples.len() - 1)].time];
        for _ in 0..REFINEMENTS {
            let finer = distances_at(model, shapes, evenly(around[0], around[1], REFINED));
            let n = (0..finer.len()).min_by(|a, b| finer[*a].distance[0].total_cmp(&finer[*b].distance[0]));
            let n = n.unwrap();
            least = least.min(finer[n].distance[0]);
            around = [finer[n.saturating_sub(1)].time, finer[(n + 1).min(finer.len() - 1)].time];
        }
    }
    least
}

/// A MacPherson strut of about the size of the gallery's, with rods, balls, drums and a tyre; all of it at random.
fn strut(next: &mut impl FnMut() -> f64) -> String {
    let mut about = |[x, y, z]: [f64; 3], within: f64| [x, y, z].map(|at| at + within * (2.0 * next() - 1.0));
    let front = about([270.0, 345.0, -60.0], 20.0);
    let rear = about([-43.0, 373.0, -125.0], 20.0);
    let ball = about([28.0, 663.0, -104.0], 15.0);
    let lower = about([-5.0, 620.0, -1.0], 15.0);
    let top = about([-84.0, 541.0, 469.0], 30.0);
    let outer = about([-200.0, 575.0, -1.0], 20.0);
    let inner = about([-200.0, 200.0, -50.0], 20.0);
    // Beside the lower arm and the tie rod.
    let post = [about([-20.0, 450.0, -60.0], 90.0), about([-20.0, 450.0, -60.0], 130.0)];
    let drum = [about([-140.0, 480.0, -60.0], 70.0), about([-140.0, 480.0, -60.0], 90.0)];
    // Around the tyre.
    let arch = about([0.0, 600.0, 330.0], 120.0);
    let tower = [about([-60.0, 560.0, 200.0], 60.0), about([-60.0, 540.0, 420.0], 40.0)];
    // A box beside the tie rod, and the hull of points on the knuckle.
    let (block, turned) = (about([-120.0, 460.0, 40.0], 80.0), about([0.0; 3], 60.0));
    let bracket: [[f64; 3]; 6] = std::array::from_fn(|_| about([-60.0, 640.0, 60.0], 40.0));
    let [spin_x, _, spin_z] = about([0.0, 0.0, 0.0], 0.03);
    let mut between = |low: f64, high: f64| low + (high - low) * next();
    let [travel, steer] = [between(20.0, 70.0), between(-40.0, 40.0)];
    let [ride, turn] = [between(0.3, 1.2), between(0.3, 1.2)];
    let [width, round, lip] = [between(150.0, 230.0), between(0.0, 40.0), between(150.0, 200.0)];
    let radii: [f64; 7] = std::array::from_fn(|_| between(5.0, 25.0));
    let [rod, arm, bolt, hub, stop, mount, coil] = radii;
    format!(
        r#"
name = "random strut"
units = {{ length = "mm", angle = "deg" }}
bodies = {{ lca = {{}}, knuckle = {{}}, strut = {{}}, rack = {{}} }}
[hardpoints]
lca_front = {front:?}
lca_rear = {rear:?}
ball_joint = {ball:?}
strut_lower = {lower:?}
strut_top = {top:?}
tie_rod_outer = {outer:?}
tie_rod_inner = {inner:?}
rack_centre = [-200, 0, -50]
[joints]
ball_B = {{ type = "spherical", bodies = ["lca", "knuckle"], at = "ball_joint" }}
top_E = {{ type = "spherical", bodies = ["ground", "strut"], at = "strut_top", cut = true }}
tie_rod = {{ type = "distance", bodies = ["knuckle", "rack"], at = ["tie_rod_outer", "tie_rod_inner"] }}
rack_slide = {{ type = "translational", bodies = ["ground", "rack"], at = "rack_centre", axis = "y" }}
[joints.lca_pivot]
type = "revolute"
bodies = ["ground", "lca"]
axis = {{ through = ["lca_rear", "lca_front"] }}
[joints.strut_slide]
type = "translational"
bodies = ["knuckle", "strut"]
axis = {{ through = ["strut_lower", "strut_top"] }}
[drivers]
rack_drive = {{ joint = "rack_slide", law = "{steer}*sin(2*pi*{turn}*t)" }}
strut_drive = {{ joint = "strut_slide", law = "{travel}*sin(2*pi*{ride}*t)" }}
[wheels.front_left]
body = "knuckle"
centre = [0, 750, 0]
spin_axis = [{spin_x}, 1, {spin_z}]
radius = 310
[shapes]
rod = {{ capsule = "tie_rod", radius = {rod} }}
front_arm = {{ body = "lca", capsule = ["lca_front", "ball_joint"], radius = {arm} }}
rear_arm = {{ body = "lca", capsule = ["lca_rear", "ball_joint"], radius = {arm} }}
coil = {{ body = "strut", capsule = ["strut_top", {lower:?}], radius = {coil} }}
post = {{ body = "ground", capsule = {post:?}, radius = {bolt} }}
drum = {{ body = "ground", cylinder = {drum:?}, radius = {hub}, round = 3 }}
arch = {{ body = "ground", sphere = {arch:?}, radius = {stop} }}
tower = {{ body = "ground", cylinder = {tower:?}, radius = 50, round = {mount} }}
end = {{ body = "knuckle", sphere = "tie_rod_outer", radius = {bolt} }}
tyre = {{ wheel = "front_left", width = {width}, round = {round} }}
lip = {{ body = "knuckle", ring = [0, 700, 0], axis = [{spin_x}, 1, {spin_z}], radius = {lip}, round = 5 }}
block = {{ body = "ground", box = [40, 60, 30], frame = {{ position = {block:?}, cardan = {turned:?} }}, round = 2 }}
bracket = {{ body = "knuckle", hull = {bracket:?}, round = {mount} }}
[clearances]
blocks = {{ between = ["block", ["rod", "front_arm", "end", "tyre", "bracket"]] }}
rods = {{ between = ["rod", ["front_arm", "rear_arm", "post"]] }}
arms = {{ between = [["front_arm", "rear_arm"], ["post", "drum"]] }}
wheel = {{ between = ["tyre", ["arch", "tower", "rod", "coil", "rear_arm", "post"]] }}
ends = {{ between = ["end", ["drum", "post", "rear_arm"]] }}
rim = {{ between = ["lip", ["rod", "arch", "rear_arm"]] }}
[time]
end = 1.0
steps = 12
"#
    )
}

/// Numbers of pairs of which the least distance is proved, and is not with the reason.
#[derive(Default)]
struct Tally {
    proved: usize,
    meeting: usize,
    unresolved: usize,
    within_ring: usize,
    of_motion: usize,
    bounds: Vec<usize>,
}

impl Tally {
    fn print(&mut self, of: &str) {
        self.bounds.sort_unstable();
        let bounds = &self.bounds;
        println!(
            "{of}; proved {}, cores meet {}, unresolved {}, within a ring {}, motion {}; \
             bounds {} in the median, {} at 90 %, {} at most",
            self.proved,
            self.meeting,
            self.unresolved,
            self.within_ring,
            self.of_motion,
            bounds[bounds.len() / 2],
            bounds[bounds.len() * 9 / 10],
            bounds[bounds.len() - 1]
        );
    }
}

#[test]
fn least_distances_of_random_struts_are_proved_and_greater_claims_are_refused() {
    // `HARDPOINT_STRUTS=1000` sets their number, each against 100,000 samples; `HARDPOINT_SEED` draws others.
    let (most, samples) = number_of("HARDPOINT_STRUTS", 8);
    let mut next = numbers(seed_or(38));
    let mut tally = Tally::default();
    let mut failures: Vec<String> = Vec::new();
    let (mut tried, mut solved) = (0, 0);
    while solved < most {
        tried += 1;
        assert!(tried < 4 * most, "most struts must run to their end");
        let text = strut(&mut next);
        let model = parse(&text, "strut.toml").unwrap_or_else(|e| panic!("{e}\n{text}")).model;
        let analysis = Analysis::new(&model).unwrap();
        let found = analysis.clearances(&[]);
        if found.stop.is_some() {
            continue;
        }
        solved += 1;
        let mut prover = analysis.clearance_prover(&[]).unwrap();
        for pair in &found.pairs {
            let names = pair.shapes.map(|s| model.shapes[s.0].name.as_str());
            let what = format!("strut {tried}, {} against {}", names[0], names[1]);
            let mut fail = |text: String| {
                println!("{what}: {text}");
                failures.push(format!("{what}: {text}"));
            };
            examine(&model, pair, (samples, MOST_BOUNDS), &mut prover, &mut tally, &mut fail);
        }
    }
    tally.print(&format!("{tried} tried, {solved} solved"));
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
}

/// Compares the least distance of a pair with samples, and with what is proved.
fn examine(
    model: &Model,
    pair: &PairClearance,
    (samples, most_bounds): (usize, usize),
    prover: &mut hardpoint::run::ClearanceProver<'_>,
    tally: &mut Tally,
    fail: &mut impl FnMut(String),
) {
    let lowest = pair.least().unwrap();
    let least = lowest.at.distance[0];
    let round_off = ROUND_OFF * model.size();
    let (first, last) = (model.times[0], *model.times.last().unwrap());
    let coarse = distances_at(model, pair.shapes, evenly(first, last, samples.min(2000)));
    // The dense samples lie around the lowest of the coarse ones: no others can be the least.
    let mut sampled = coarse.iter().map(|at| at.distance[0]).fold(f64::INFINITY, f64::min);
    if samples > coarse.len() {
        for k in lowest_of(&coarse) {
            let around = [coarse[k.saturating_sub(1)].time, coarse[(k + 1).min(coarse.len() - 1)].time];
            let pieces = 2 * samples / (coarse.len() - 1);
            let finer = distances_at(model, pair.shapes, evenly(around[0], around[1], pieces));
            sampled = finer.iter().map(|at| at.distance[0]).fold(sampled, f64::min);
        }
    }
    if !(least <= sampled + round_off) {
        fail(format!("least {least} at {}, sampled {sampled}", lowest.at.time));
    }
    let refused = prover.prove(pair.shapes, least + EXCESS);
    if !matches!(refused, ClearanceProof::NotProved { .. }) {
        fail(format!("a claim above the least {least} is not refused: {refused:?}"));
    }
    let allowance = if pair.is_constant { OF_CONSTANT * model.size() } else { round_off };
    let proof = prover.prove(pair.shapes, least - allowance);
    match proof {
        ClearanceProof::Proved { bounds, .. } => {
            tally.proved += 1;
            tally.bounds.push(bounds);
            if bounds > most_bounds {
                fail(format!("{bounds} bounds"));
            }
            return;
        }
        // Nothing is proved of the depth of an overlap.
        ClearanceProof::NotProved { .. }
            if pair.curve.iter().any(|at| at.cores_meet) || lowest.at.cores_meet =>
        {
            tally.meeting += 1;
            return;
        }
        ClearanceProof::NotProved { reason: ProofFailure::Unresolved | ProofFailure::CoresMeet, .. } => {
            tally.unresolved += 1;
        }
        ClearanceProof::NotProved { reason: ProofFailure::WithinRing, .. } => tally.within_ring += 1,
        ClearanceProof::NotProved { reason: ProofFailure::Motion(_), .. } => tally.of_motion += 1,
        ClearanceProof::NotProved {
            reason: ProofFailure::Nearer { .. } | ProofFailure::Meshes | ProofFailure::Interrupted,
            ..
        } => fail(format!("least {least} at {}: {proof:?}", lowest.at.time)),
    }
    let reference = refined(model, pair.shapes, &coarse);
    if !((least - reference).abs() <= LOCATED) {
        fail(format!("least {least} at {}, refined samples {reference}; {proof:?}", lowest.at.time));
    }
}

/// A triangle by its corners, m.
type Triangle = [Vec3; 3];

/// A closed surface like a ball of about this radius, mm, with bumps and dents: triangles of an icosahedron, some of
/// them divided in four.
fn lump(next: &mut impl FnMut() -> f64, radius: f64, divisions: usize) -> (Vec<Vec3>, Vec<[usize; 3]>) {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut points = Vec::new();
    for [a, b] in [[-1.0, -golden], [-1.0, golden], [1.0, -golden], [1.0, golden]] {
        points.extend([Vec3::new(0.0, a, b), Vec3::new(a, b, 0.0), Vec3::new(b, 0.0, a)]);
    }
    // The triangles of an icosahedron are those of neighbours, two units apart.
    let are_near = |a: usize, b: usize| ((points[a] - points[b]).norm() - 2.0).abs() < 1e-9;
    let mut triangles = Vec::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if are_near(i, j) && are_near(j, k) && are_near(i, k) {
                    let outward = (points[j] - points[i]).cross(points[k] - points[i]).dot(points[i]) > 0.0;
                    triangles.push(if outward { [i, j, k] } else { [i, k, j] });
                }
            }
        }
    }
    assert_eq!(triangles.len(), 20);
    for _ in 0..divisions {
        let mut middles: BTreeMap<[usize; 2], usize> = BTreeMap::new();
        let mut divided = Vec::new();
        for [a, b, c] in triangles {
            let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[p, q]| {
                *middles.entry([p.min(q), p.max(q)]).or_insert_with(|| {
                    points.push(points[p] + points[q]);
                    points.len() - 1
                })
            });
            divided.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        triangles = divided;
        points.iter_mut().for_each(|p| *p = *p * (1.0 / p.norm()));
    }
    let points = points.into_iter().map(|p| p * (radius * (0.75 + 0.5 * next()) / p.norm())).collect();
    (points, triangles)
}

fn object_file((points, triangles): &(Vec<Vec3>, Vec<[usize; 3]>)) -> String {
    let mut text: String = points.iter().map(|p| format!("v {:?} {:?} {:?}\n", p.x, p.y, p.z)).collect();
    text.extend(triangles.iter().map(|t| format!("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1)));
    text
}

/// Two lumps: one turns about a fixed axis, the other one moves past it or through it and turns.
fn lumps(next: &mut impl FnMut() -> f64) -> String {
    let mut between = |low: f64, high: f64| low + (high - low) * next();
    let [aside, above] = [between(-45.0, 45.0), between(-45.0, 45.0)];
    let [turn, spin, way] = [between(-200.0, 200.0), between(-200.0, 200.0), between(60.0, 160.0)];
    let mut axis = || [between(-1.0, 1.0), between(-1.0, 1.0), between(1.1, 2.0)];
    let (first, second) = (axis(), axis());
    format!(
        r#"
name = "lumps"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ A = [0, 0, 0], B = [-70, {aside}, {above}] }}
[bodies]
still = {{ frame = {{ position = [0, 0, 0] }} }}
carrier = {{}}
moving = {{ frame = {{ position = "B" }} }}
[joints]
turn = {{ type = "revolute", bodies = ["ground", "still"], at = "A", axis = {first:?} }}
slide = {{ type = "translational", bodies = ["ground", "carrier"], at = "B", axis = "x" }}
spin = {{ type = "revolute", bodies = ["carrier", "moving"], at = "B", axis = {second:?} }}
[drivers]
turn = {{ joint = "turn", law = "{turn}*t" }}
slide = {{ joint = "slide", law = "{way}*t" }}
spin = {{ joint = "spin", law = "{spin}*t" }}
[shapes]
a = {{ body = "still", mesh = {{ file = "a.obj", frame = "body" }} }}
b = {{ body = "moving", mesh = {{ file = "b.obj", frame = "body" }} }}
[clearances]
gap = {{ between = ["a", "b"] }}
[time]
end = 1.0
steps = 16
"#
    )
}

/// Shapes that move past a lump, or into it.
const BESIDE_LUMP: [&str; 6] = [
    "sphere = \"B\", radius = 6",
    "capsule = [\"B\", [-90, 15, 25]], radius = 2",
    "cylinder = [\"B\", [-85, 5, 10]], radius = 9, round = 1",
    "box = [12, 14, 9], frame = { position = \"B\" }, round = 1",
    "plane = \"B\", normal = [1, 0.2, 0.1]",
    "ring = \"B\", axis = [1, 1, 0.3], radius = 12, round = 1",
];

#[test]
fn least_distances_of_random_meshes_are_proved_and_greater_claims_are_refused() {
    let mut tally = Tally::default();
    let many = examine_meshes(seed_or(382), 18, &mut tally);
    // A cylinder that is deepest in a mesh between two output times, where its rates do not lead.
    let all = many + examine_meshes(seed_or(8), 3, &mut tally);
    // Rings around a mesh have no bounds. Nothing is proved of the depth of an overlap.
    assert!(2 * tally.proved > all - tally.meeting, "{} of {all}", tally.proved);
}

/// Compares the least distances of shapes and random meshes with samples; `HARDPOINT_LUMPS=1000` sets their number,
/// each against 100,000 samples. Returns the number.
fn examine_meshes(seed: u64, usual: usize, tally: &mut Tally) -> usize {
    let (most, samples) = number_of("HARDPOINT_LUMPS", usual);
    let mut next = numbers(seed);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lumps.toml");
    let mut failures = Vec::new();
    for n in 0..most {
        let (points, mut triangles) = lump(&mut next, 20.0, 1 + n % 3);
        // Every fourth one is open.
        triangles.truncate(triangles.len() - usize::from(n % 4 == 3));
        std::fs::write(folder.path().join("a.obj"), object_file(&(points, triangles))).unwrap();
        let shape = BESIDE_LUMP[n % BESIDE_LUMP.len()];
        let between = if n % 2 == 0 { "[\"a\", \"b\"]" } else { "[\"b\", \"a\"]" };
        let text = lumps(&mut next)
            .replace("mesh = { file = \"b.obj\", frame = \"body\" }", shape)
            .replace("[\"a\", \"b\"]", between);
        std::fs::write(&path, &text).unwrap();
        let model = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}\n{text}")).model;
        let analysis = Analysis::new(&model).unwrap();
        let mut prover = analysis.clearance_prover(&[]).unwrap();
        let found = analysis.clearances(&[]);
        let (bounds, mut fail) =
            (MOST_BOUNDS_OF_MESH, |text: String| failures.push(format!("{n}, {shape}: {text}")));
        examine(&model, &found.pairs[0], (samples, bounds), &mut prover, tally, &mut fail);
    }
    tally.print(&format!("{most} meshes"));
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
    most
}

/// The nearest distance of two segments: with the clamped parameters of both, by Ericson's algorithm.
fn of_segments([a, b]: [Vec3; 2], [c, d]: [Vec3; 2]) -> f64 {
    let (u, v, r) = (b - a, d - c, a - c);
    let (uu, vv, uv, vr, ur) = (u.dot(u), v.dot(v), u.dot(v), v.dot(r), u.dot(r));
    let det = uu * vv - uv * uv;
    let s = if det > 1e-14 * uu * vv { ((uv * vr - ur * vv) / det).clamp(0.0, 1.0) } else { 0.0 };
    let t = ((uv * s + vr) / vv).clamp(0.0, 1.0);
    let s = ((uv * t - ur) / uu).clamp(0.0, 1.0);
    (a + u * s - c - v * t).norm()
}

/// Distance of a point above a triangle from it; infinite beside it.
fn above(p: Vec3, [a, b, c]: Triangle) -> f64 {
    let (u, v, w) = (b - a, c - a, p - a);
    let (uu, uv, vv, wu, wv) = (u.dot(u), u.dot(v), v.dot(v), w.dot(u), w.dot(v));
    let det = uu * vv - uv * uv;
    let (s, t) = ((vv * wu - uv * wv) / det, (uu * wv - uv * wu) / det);
    if s < 0.0 || t < 0.0 || s + t > 1.0 { f64::INFINITY } else { (w - u * s - v * t).norm() }
}

/// True if a segment goes through a triangle (Moeller and Trumbore).
fn goes_through([p, q]: [Vec3; 2], [a, b, c]: Triangle) -> bool {
    let (way, u, v) = (q - p, b - a, c - a);
    let h = way.cross(v);
    let det = u.dot(h);
    let s = (p - a).dot(h) / det;
    let k = (p - a).cross(u);
    let (t, at) = (way.dot(k) / det, v.dot(k) / det);
    s >= 0.0 && t >= 0.0 && s + t <= 1.0 && (0.0..=1.0).contains(&at)
}

/// Distance of two closed surfaces over all of their triangles; `None` if they overlap.
fn by_brute_force(first: &[Triangle], second: &[Triangle]) -> Option<f64> {
    let edges = |t: &Triangle| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    let ball = |t: &Triangle| {
        let centre = (t[0] + t[1] + t[2]) * (1.0 / 3.0);
        (centre, t.iter().map(|p| (*p - centre).norm()).fold(0.0, f64::max))
    };
    let others: Vec<_> = second.iter().map(|t| (t, ball(t))).collect();
    let mut least = f64::INFINITY;
    for a in first {
        let (p, r) = ball(a);
        for (b, (q, s)) in &others {
            // Triangles whose balls are farther apart than others are not the nearest.
            if (p - *q).norm() - r - s > least {
                continue;
            }
            for e in edges(a) {
                for f in edges(b) {
                    least = least.min(of_segments(e, f));
                }
                if goes_through(e, **b) {
                    return None;
                }
            }
            for f in edges(b) {
                if goes_through(f, *a) {
                    return None;
                }
            }
            for k in 0..3 {
                least = least.min(above(a[k], **b)).min(above(b[k], *a));
            }
        }
    }
    // One within the other: a ray from a corner leaves it an odd number of times.
    let far = Vec3::new(10.0, 0.123, 0.456);
    let is_within = |p: Vec3, surface: &[Triangle]| {
        surface.iter().filter(|t| goes_through([p, p + far], **t)).count() % 2 == 1
    };
    (!is_within(first[0][0], second) && !is_within(second[0][0], first)).then_some(least)
}

/// Triangles of a lump at each time of a motion.
fn triangles_at(model: &Model, shape: &str, motion: &Motion, k: usize) -> Vec<Triangle> {
    let shape = model.shapes.iter().find(|s| s.name == shape).unwrap();
    let ShapeKind::Mesh { body, surface } = &shape.kind else { panic!("a mesh") };
    let state = motion.at(k).body(body.0);
    (0..surface.triangles().len()).map(|t| surface.corners(t).map(|p| state.r + state.rotation * p)).collect()
}

#[test]
fn distances_of_random_meshes_are_those_of_brute_force() {
    // `HARDPOINT_MESHES=100` sets the number of pairs.
    let (most, _) = number_of("HARDPOINT_MESHES", 6);
    let mut next = numbers(seed_or(381));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lumps.toml");
    let mut failures: Vec<String> = Vec::new();
    let [mut apart, mut overlapping] = [0; 2];
    for n in 0..most {
        for name in ["a.obj", "b.obj"] {
            let lump = lump(&mut next, 20.0, n % 3);
            std::fs::write(folder.path().join(name), object_file(&lump)).unwrap();
        }
        let text = lumps(&mut next);
        let found: Vec<(Model, Clearances)> = [16, 5, 23]
            .into_iter()
            .map(|steps| {
                std::fs::write(&path, text.replace("steps = 16", &format!("steps = {steps}"))).unwrap();
                let model = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}")).model;
                let found = Analysis::new(&model).unwrap().clearances(&[]);
                (model, found)
            })
            .collect();
        let mut fail = |text: String| failures.push(format!("pair {n}: {text}"));
        let (model, clearances) = &found[0];
        let pair = &clearances.pairs[0];
        // Against brute force at the output times.
        let solution = Analysis::new(model).unwrap().solve(Run::new().without_measures());
        for (k, at) in pair.curve.iter().enumerate() {
            let [a, b] = ["a", "b"].map(|name| triangles_at(model, name, &solution.motion, k));
            match by_brute_force(&a, &b) {
                Some(distance) => {
                    apart += 1;
                    if !((at.distance[0] - distance).abs() < BRUTE) {
                        fail(format!(
                            "distance {} at {}, by brute force {distance}",
                            at.distance[0], at.time
                        ));
                    }
                }
                None => {
                    overlapping += 1;
                    if at.distance[0] > 0.0 {
                        fail(format!("distance {} at {}, but they overlap", at.distance[0], at.time));
                    }
                }
            }
        }
        // Any output times.
        let Some(least) = pair.least().map(|m| m.at) else {
            fail("no minimum".into());
            continue;
        };
        for (model, clearances) in &found[1..] {
            let (other, steps) = (&clearances.pairs[0], model.times.len() - 1);
            let Some(at) = other.least().map(|m| m.at) else {
                fail(format!("{steps} steps: no minimum"));
                continue;
            };
            if !((at.distance[0] - least.distance[0]).abs() <= LOCATED) {
                fail(format!("{steps} steps: least {} at {}, {least:?}", at.distance[0], at.time));
            }
            let [times, others] =
                [pair, other].map(|of| of.contacts.iter().map(|c| (c.begins, c.at.time)).collect::<Vec<_>>());
            let near = |((begins, t), (other, u)): (&(bool, f64), &(bool, f64))| {
                begins == other && (t - u).abs() < TOUCH
            };
            if times.len() != others.len() || !times.iter().zip(&others).all(near) {
                fail(format!("{steps} steps: contacts {others:?}, {times:?}"));
            }
        }
        // Samples between the output times.
        for at in distances_at(model, pair.shapes, evenly(0.0, 1.0, DENSE)) {
            if !(at.distance[0] >= least.distance[0] - LOCATED) {
                fail(format!("distance {} at {}, least {}", at.distance[0], at.time, least.distance[0]));
            }
        }
    }
    println!("{most} pairs; {apart} times apart, {overlapping} overlapping");
    assert!(apart > most && overlapping > 0);
    failures.dedup_by_key(|text| text.split(':').next().map(str::to_owned));
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
}
