//! `motion.glb` as other programs read it.

use std::collections::HashMap;

use gltf::animation::util::ReadOutputs;

use crate::bench::Bench;

/// Relative tolerance: the file has single precision.
const SINGLE: f64 = 1e-6;

struct Animated {
    document: gltf::Document,
    data: Vec<u8>,
}

/// Path of a node: its times with translations, rotations (x, y, z, w), and scales; one value if it does not move.
#[derive(Default)]
struct Path {
    times: Vec<f32>,
    places: Vec<[f32; 3]>,
    turns: Vec<[f32; 4]>,
    scales: Vec<[f32; 3]>,
}

impl Animated {
    /// Reads and validates it.
    fn open(bench: &Bench, name: &str) -> Self {
        let gltf = gltf::Gltf::from_slice(&std::fs::read(bench.path(name)).unwrap()).unwrap();
        Self { document: gltf.document, data: gltf.blob.unwrap() }
    }

    fn node(&self, name: &str) -> gltf::Node<'_> {
        self.document.nodes().find(|n| n.name() == Some(name)).unwrap_or_else(|| panic!("no node {name}"))
    }

    fn paths(&self) -> HashMap<String, Path> {
        let still = |n: gltf::Node<'_>| {
            let (place, turn, scale) = n.transform().decomposed();
            let path = Path { times: vec![0.0], places: vec![place], turns: vec![turn], scales: vec![scale] };
            (n.name().unwrap().to_owned(), path)
        };
        let mut paths: HashMap<String, Path> = self.document.nodes().map(still).collect();
        for channel in self.document.animations().flat_map(|a| a.channels().collect::<Vec<_>>()) {
            let path = paths.get_mut(channel.target().node().name().unwrap()).unwrap();
            let reader = channel.reader(|_| Some(&self.data));
            path.times = reader.read_inputs().unwrap().collect();
            match reader.read_outputs().unwrap() {
                ReadOutputs::Translations(list) => path.places = list.collect(),
                ReadOutputs::Rotations(list) => path.turns = list.into_f32().collect(),
                ReadOutputs::Scales(list) => path.scales = list.collect(),
                ReadOutputs::MorphTargetWeights(_) => panic!("nothing is morphed"),
            }
        }
        paths
    }

    /// The corners of a node's mesh.
    fn corners(&self, name: &str) -> Vec<[f32; 3]> {
        let mesh = self.node(name).mesh().unwrap();
        let primitive = mesh.primitives().next().unwrap();
        let reader = primitive.reader(|_| Some(&self.data));
        let places: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
        reader.read_indices().unwrap().into_u32().map(|k| places[k as usize]).collect()
    }
}

/// Item of a list that may have one value for all times.
fn at<T: Copy>(list: &[T], k: usize) -> T {
    list[usize::min(k, list.len() - 1)]
}

fn turned([x, y, z, w]: [f32; 4], v: [f64; 3]) -> [f64; 3] {
    let [x, y, z, w] = [x, y, z, w].map(f64::from);
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let u = [x, y, z];
    let (a, b) = (cross(u, v), cross(u, cross(u, v)));
    std::array::from_fn(|c| v[c] + 2.0 * (w * a[c] + b[c]))
}

/// Compares every body with the table of the motion.
fn same_as_table(bench: &Bench, folder: &str, bodies: &[&str]) {
    let glb = Animated::open(bench, &format!("{folder}/motion.glb"));
    let paths = glb.paths();
    let text = bench.text(&format!("{folder}/motion.csv"));
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let headers = reader.headers().unwrap().clone();
    let column = |name: String| {
        headers
            .iter()
            .position(|h| h == name || h == format!("{name} [mm]"))
            .unwrap_or_else(|| panic!("{name}"))
    };
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    for body in bodies {
        let path = &paths[*body];
        assert_eq!(path.times.len(), rows.len(), "{body}");
        for (k, row) in rows.iter().enumerate() {
            let number = |name: String| row[column(name)].parse::<f64>().unwrap();
            let t: f64 = row[0].parse().unwrap();
            assert!((f64::from(path.times[k]) - t).abs() <= SINGLE);
            for (c, axis) in ["x", "y", "z"].iter().enumerate() {
                let metres = number(format!("{body}.{axis}")) / 1000.0;
                assert!((f64::from(at(&path.places, k)[c]) - metres).abs() <= SINGLE, "{body} at {t}");
            }
            // A quaternion and its negative are the same rotation.
            let turn = ["qx", "qy", "qz", "qw"].map(|q| number(format!("{body}.{q}")));
            let dot: f64 = at(&path.turns, k).iter().zip(turn).map(|(a, b)| f64::from(*a) * b).sum();
            assert!((dot.abs() - 1.0).abs() <= SINGLE, "{body} at {t}: {dot}");
        }
        let steps = path.turns.windows(2);
        let near = |w: &[[f32; 4]]| w[0].iter().zip(w[1]).map(|(a, b)| a * b).sum::<f32>() > 0.0;
        assert!(steps.clone().all(near), "{body}: between two output times it turns the short way");
    }
}

#[test]
fn an_animation_has_the_poses_of_the_motion() {
    let bench = Bench::with(&["slider.toml"]);
    let output = bench.run(&["run", "slider.toml", "-o", "out", "--gltf", "--json"]);
    assert!(output.status.success());
    same_as_table(&bench, "out", &["crank", "rod", "slider"]);
    let glb = Animated::open(&bench, "out/motion.glb");
    // z up becomes y up.
    let root = glb.document.default_scene().unwrap().nodes().next().unwrap();
    assert_eq!(root.name(), Some("slider-crank for tests"));
    assert_eq!(root.children().count(), 4);
    let (_, turn, scale) = root.transform().decomposed();
    assert_eq!(scale, [1.0; 3]);
    for (ours, theirs) in [([0.0, 0.0, 1.0], [0.0, 1.0, 0.0]), ([1.0, 0.0, 0.0], [1.0, 0.0, 0.0])] {
        let got = turned(turn, ours);
        assert!(got.iter().zip(theirs).all(|(a, b)| (a - b).abs() <= SINGLE), "{got:?}");
    }
    // The slider only translates: it has no rotation track.
    let of = |name: &str| {
        let channels = glb.document.animations().flat_map(|a| a.channels().collect::<Vec<_>>());
        channels.filter(|c| c.target().node().name() == Some(name)).count()
    };
    assert_eq!(["ground", "slider", "rod"].map(of), [0, 1, 2]);
    let files = bench.json("out/summary.json")["files"].to_string();
    assert!(files.contains("motion.glb"), "{files}");
    assert!(bench.run(&["run", "slider.toml", "-o", "out"]).status.success());
    assert!(!bench.list("out").contains(&"motion.glb".into()), "what the next run does not write is removed");
}

#[test]
fn a_motion_that_stops_has_an_animation_of_its_part() {
    let bench = Bench::with(&["short_rod.toml"]);
    assert_eq!(bench.run(&["run", "short_rod.toml", "-o", "out", "--gltf"]).status.code(), Some(5));
    same_as_table(&bench, "out", &["crank", "rod", "rocker"]);
}

#[test]
fn a_body_with_a_mesh_is_shown_in_it() {
    let bench = Bench::with(&["slider.toml"]);
    let text = bench.text("slider.toml").replace("crank = {}", "crank = { mesh = \"crank.stl\" }");
    bench.put("shown.toml", &text);
    bench.put(
        "crank.stl",
        "solid crank\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 30 0 0\nvertex 30 40 0\nendloop\nendfacet\nendsolid\n",
    );
    let output = bench.run(&["run", "shown.toml", "-o", "out", "--gltf"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let glb = Animated::open(&bench, "out/motion.glb");
    let corners = glb.corners("crank");
    assert_eq!(corners.len(), 3);
    // In the design configuration, at t = 0, the corners are at their positions in the file.
    let path = &glb.paths()["crank"];
    let placed = |c: [f32; 3]| {
        let v = turned(path.turns[0], c.map(f64::from));
        let place = path.places[0].map(f64::from);
        [v[0] + place[0], v[1] + place[1], v[2] + place[2]]
    };
    for (corner, file) in corners.iter().zip([[0.0, 0.0, 0.0], [0.03, 0.0, 0.0], [0.03, 0.04, 0.0]]) {
        assert!(placed(*corner).iter().zip(file).all(|(a, b)| (a - b).abs() <= SINGLE));
    }
    assert!(glb.corners("rod").len() > 3, "others are links");
}

#[test]
fn rods_that_are_joints_are_stretched_between_their_ends() {
    let bench = Bench::with(&["slider.toml"]);
    let leg =
        "spring = { type = \"leg\", bodies = [\"ground\", \"slider\"], at = [\"A\", \"C\"] }\n\n[drivers]";
    bench.put("leg.toml", &bench.text("slider.toml").replace("[drivers]", leg));
    let output = bench.run(&["run", "leg.toml", "-o", "out", "--gltf"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let paths = Animated::open(&bench, "out/motion.glb").paths();
    let (spring, slider) = (&paths["spring"], &paths["slider"]);
    assert_eq!(spring.scales.len(), 41);
    for k in 0..41 {
        // From A, at the origin, to C, the origin of the slider in the design configuration.
        let end = turned(at(&spring.turns, k), [0.0, 0.0, f64::from(spring.scales[k][2])]);
        let start = at(&spring.places, k);
        let moved = f64::from(slider.places[k][0]) - f64::from(slider.places[0][0]);
        assert!(start.iter().all(|x| x.abs() <= 1e-9));
        assert!((end[0] - 0.15 - moved).abs() <= SINGLE && end[1].abs() <= SINGLE, "{end:?} {moved}");
    }
}
