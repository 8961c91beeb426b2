//! Shapes on the page, and the distances between them.

use std::path::Path;

use hardpoint::Analysis;
use hardpoint::run::Run;
use hardpoint::space::{Mat3, Quat, Vec3};
use hardpoint_file::ModelFile;
use hardpoint_report::clearance::{self, ClearanceFact};
use hardpoint_report::course::Course;
use hardpoint_report::page::{BodyTrack, PairTrack, Payload, ShapeMark};
use hardpoint_report::payload::{ChangedDesign, Request, payload};
use hardpoint_report::summary::Summary;

/// Error of a length of the page, mm: curves are single precision, of lengths up to 100 mm.
const DRAWN: f64 = 5e-5;
/// Error of a located time, s, and distance, mm: motions are solved to 1e-12 of the size.
const LOCATED: f64 = 1e-9;
/// Published results of the knee: the coupler against both screws.
const CONTACT: [f64; 2] = [0.321025628612, 0.448678530833];
const DEEPEST: f64 = -0.206427556366784;

fn model(name: &str) -> ModelFile {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name);
    hardpoint_file::read(&path).unwrap()
}

fn page_of(file: &ModelFile) -> Payload {
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.run();
    let course = Course::of(&file.model, &solution);
    let summary = Summary::new(file, &analysis, &course);
    payload(&Request::of(file, &analysis, &course, &summary))
}

/// A point of a body in the world at a step.
fn world(body: &BodyTrack, step: usize, at: [f64; 3]) -> Vec3 {
    let pose: Vec<f64> = body.poses.values()[7 * step..7 * step + 7].iter().map(|x| f64::from(*x)).collect();
    let turn: Mat3 = Quat::from_array([pose[3], pose[4], pose[5], pose[6]]).unwrap().rotation();
    Vec3::new(pose[0], pose[1], pose[2]) + turn * Vec3::new(at[0], at[1], at[2])
}

/// Distance of a point from the axis of a capsule.
fn from_axis(page: &Payload, shape: &ShapeMark, step: usize, p: Vec3) -> f64 {
    let [a, b] = [0, 1].map(|end: usize| {
        let place = shape.places[end];
        world(&page.bodies[place.body], step, place.at)
    });
    let along = b - a;
    let s = ((p - a).dot(along) / along.dot(along)).clamp(0.0, 1.0);
    (p - a - along * s).norm()
}

#[test]
fn shapes_are_in_the_frames_of_their_bodies_with_their_nearest_points_on_them() {
    let page = page_of(&model("studies/knee.toml"));
    let marks = page.clearance.as_ref().unwrap();
    let shape = |name: &str| marks.shapes.iter().find(|s| s.name == name).unwrap();
    let rod = shape("coupler_rod");
    assert_eq!((rod.kind, page.bodies[rod.body].name.as_str(), rod.radius), ("capsule", "coupler", 4.0));
    assert_eq!(shape("screw1").radius, 3.5);
    let [foot, head] = [0, 1].map(|end: usize| shape("screw1").places[end].at[2]);
    assert!((head - foot - 9.0).abs() < LOCATED, "{foot} {head}");
    assert!(!marks.pairs.is_empty());
    for pair in &marks.pairs {
        let (distance, points) = (pair.distance.values(), pair.points.values());
        assert_eq!((distance.len(), points.len()), (page.times.values().len(), 6 * distance.len()));
        for (k, d) in distance.iter().enumerate() {
            let at: Vec<f64> = points[6 * k..6 * k + 6].iter().map(|x| f64::from(*x)).collect();
            let [p, q] = [0, 3].map(|first: usize| Vec3::new(at[first], at[first + 1], at[first + 2]));
            assert!(((q - p).norm() - f64::from(d.abs())).abs() < DRAWN, "{k}: {d}, {p:?}, {q:?}");
            for (shape, point) in pair.shapes.iter().zip([p, q]) {
                let shape = &marks.shapes[*shape];
                let off = from_axis(&page, shape, k, point) - shape.radius;
                assert!(off.abs() < DRAWN, "{}: {off} at {k}", shape.name);
            }
        }
    }
}

#[test]
fn contacts_and_minima_are_located_between_the_steps_of_the_page() {
    let page = page_of(&model("studies/knee.toml"));
    let marks = page.clearance.as_ref().unwrap();
    let [clearance] = &marks.clearances[..] else { panic!("{:?}", marks.clearances) };
    assert_eq!((clearance.name.as_str(), clearance.min), ("rods_to_screws", Some(1.5)));
    let index = |name: &str| marks.shapes.iter().position(|s| s.name == name).unwrap();
    let hit = [index("coupler_rod"), index("screw1")];
    let pair = marks.pairs.iter().find(|pair| pair.shapes == hit).unwrap();
    assert_eq!(pair.clearances, [0]);
    let [[from, to]] = pair.touching.as_deref().unwrap() else { panic!("{:?}", pair.touching) };
    assert!((from - CONTACT[0]).abs() < LOCATED && (to - CONTACT[1]).abs() < LOCATED, "{from} {to}");
    let deepest = pair.minima.iter().map(|[_, d]| *d).fold(f64::INFINITY, f64::min);
    assert!((deepest - DEEPEST).abs() < LOCATED, "{deepest}");
    let table = page.checks.iter().find(|table| table.title == "Clearances").unwrap();
    assert!(table.rows.iter().any(|row| row[1] == "coupler_rod - screw1" && row[5] == "NO"), "{table:?}");
    // Measures of the clearance have the least distance of all pairs.
    let [measure] = clearance.quantities[..] else { panic!("{:?}", clearance.quantities) };
    let curve = page.quantities[measure].value.values();
    for (k, value) in curve.iter().enumerate() {
        let least = marks.pairs.iter().map(|p| p.distance.values()[k]).fold(f32::INFINITY, f32::min);
        assert!(f64::from((least - value).abs()) < DRAWN, "{least} {value} at {k}");
    }
}

#[test]
fn a_changed_design_has_its_own_shapes_and_distances() {
    let file = model("studies/knee.toml");
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.run();
    let course = Course::of(&file.model, &solution);
    let summary = Summary::new(&file, &analysis, &course);
    let moved = file.model.variables.iter().position(|v| v.name == "screw1_y").unwrap();
    let mut change = vec![0.0; file.model.variables.len()];
    // 3 mm away from the rod: it is missed.
    change[moved] = 0.003;
    let exact = analysis.solve(Run::new().at(&change));
    let changed = ChangedDesign {
        name: "changed".into(),
        note: String::new(),
        change: &change,
        today: &solution,
        exact: &exact,
        prediction: None,
    };
    let request = Request { changed: Some(changed), ..Request::of(&file, &analysis, &course, &summary) };
    let page = payload(&request);
    let marks = page.clearance.as_ref().unwrap();
    let other = page.designs[0].clearance.as_ref().unwrap();
    let least = |pairs: &[PairTrack]| {
        pairs.iter().flat_map(|p| p.distance.values()).fold(f32::INFINITY, |a, b| a.min(*b))
    };
    assert!(least(&marks.pairs) < 0.0 && least(&other.pairs) > 0.0, "{}", least(&other.pairs));
    assert!(other.pairs.iter().all(|pair| pair.touching.is_none()));
    for (a, b) in marks.shapes.iter().zip(&other.shapes) {
        let by = if a.name == "screw1" { 3.0 } else { 0.0 };
        for (p, q) in a.places.iter().zip(&b.places) {
            assert!((q.at[1] - p.at[1] - by).abs() < LOCATED, "{}", a.name);
        }
    }
}

#[test]
fn a_long_motion_is_shown_without_located_contacts() {
    let mut file = model("studies/knee.toml");
    file.model.times = (0..=5000).map(|k| f64::from(k) / 5000.0).collect();
    let page = page_of(&file);
    let marks = page.clearance.as_ref().unwrap();
    assert!(marks.pairs.iter().all(|pair| pair.touching.is_none() && pair.minima.is_empty()));
    assert!(page.notes.iter().any(|note| note.contains("more than 5000 output times")), "{:?}", page.notes);
    assert!(page.checks.iter().all(|table| table.title != "Clearances"));
}

#[test]
fn a_model_without_shapes_carries_nothing_of_them() {
    let page = page_of(&model("macpherson.toml"));
    assert!(page.clearance.is_none());
    assert!(!page.notes.iter().any(|note| note.contains("clearance")));
}

#[test]
fn a_distance_that_is_not_known_is_not_kept() {
    let file = model("studies/knee.toml");
    let mut found = Analysis::new(&file.model).unwrap().clearances(&[]);
    let unknown = found.pairs.iter_mut().find(|pair| pair.least().is_some_and(|m| m.at.distance[0] > 0.0));
    let unknown = unknown.expect("a pair that is apart");
    let shapes = unknown.shapes.map(|s| file.model.shapes[s.0].name.clone());
    unknown.curve[3].distance = [f64::NAN; 3];
    let time = unknown.curve[3].time;
    let facts = ClearanceFact::all(&file.model, file.units, &found);
    let k = facts.iter().position(|fact| fact.shapes == shapes).unwrap();
    assert!(!facts[k].kept, "{:?}", facts[k].min);
    let sentences = ClearanceFact::sentences(&facts[k..=k]).join("\n");
    let expected = format!("the distance of {} and {} is not known at t = {time} s", shapes[0], shapes[1]);
    assert!(sentences.contains(&expected), "{sentences}");
}

#[test]
fn a_requirement_that_the_proof_refutes_is_not_kept() {
    let mut file = model("studies/knee.toml");
    let mut found = Analysis::new(&file.model).unwrap().clearances(&[]);
    let apart = found.pairs.iter_mut().find(|pair| pair.least().is_some_and(|m| m.at.distance[0] > 0.0));
    let apart = apart.expect("a pair that is apart");
    let (shapes, least) = (apart.shapes, apart.least().unwrap().at.distance[0]);
    // A search that misses the least distance.
    apart.minima.iter_mut().for_each(|minimum| minimum.at.distance[0] += 0.1);
    for (min, kept) in [(least + 1e-4, false), (least - 1e-4, true)] {
        let pairs = file.model.clearances.iter_mut().flat_map(|clearance| &mut clearance.pairs);
        pairs.filter(|pair| pair.shapes == shapes).for_each(|pair| pair.min = Some(min));
        let analysis = Analysis::new(&file.model).unwrap();
        let mut prover = analysis.clearance_prover(&[]).unwrap();
        let facts = ClearanceFact::proved(&file.model, file.units, &found, &mut |pair| {
            (pair.shapes == shapes)
                .then(|| clearance::proof(&file.model, file.units, &mut prover, pair))
                .flatten()
        });
        let fact = facts.iter().find(|fact| fact.proof.is_some()).unwrap();
        assert!(fact.kept == kept && !fact.proof.as_ref().unwrap().proved, "{min} {least}");
        let sentences = ClearanceFact::sentences(std::slice::from_ref(fact)).join("\n");
        assert!(sentences.contains("the shapes are nearer at t ="), "{sentences}");
        assert_eq!(sentences.contains("NEARER than the required"), !kept, "{sentences}");
    }
}
