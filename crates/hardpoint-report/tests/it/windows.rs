//! A run in windows gives the same numbers as a run in one piece, to the last bit.

use hardpoint::model::VariableId;
use hardpoint::{Analysis, Run, SampledResults, Sampling, Solution};

fn bits(x: [f64; 3]) -> [u64; 3] {
    x.map(f64::to_bits)
}

/// Asserts that the output times of `part` are those of `whole` from `first` on, each `stride`-th.
fn assert_same(name: &str, whole: &Solution, part: &Solution, first: usize, stride: usize) {
    for k in 0..part.motion.len() {
        let n = first + k * stride;
        assert_eq!(part.motion.times[k], whole.motion.times[n], "{name}");
        assert!(part.motion.at(k).iter().eq(whole.motion.at(n).iter()), "{name}");
        assert_eq!(part.motion.margins[k], whole.motion.margins[n], "{name}");
        for m in 0..whole.measured.outputs.len() {
            let (a, b) = (part.measured.value(k, m), whole.measured.value(n, m));
            assert_eq!(bits(a), bits(b), "{name}: {} at {n}", whole.measured.outputs[m].name);
        }
        for b in 0..whole.sensitivities.variables {
            // Only the end of a run shows which variables the mechanism cannot follow.
            let Some(bodies) = whole.sensitivities.at(n, b) else { continue };
            let same = part.sensitivities.at(k, b).is_some_and(|part| part.iter().eq(bodies.iter()));
            assert!(same, "{name}");
            for m in 0..whole.measured.outputs.len() {
                let [a, b] = [(part, k), (whole, n)].map(|(s, k)| s.measured.d(k, VariableId(b), m));
                assert_eq!(bits(a), bits(b), "{name}: {} at {n}", whole.measured.outputs[m].name);
            }
        }
    }
}

#[test]
fn windows_of_a_run_are_parts_of_the_whole() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../models");
    let mut seen = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        let name = path.display().to_string();
        let mut file = hardpoint_file::read(&path).unwrap();
        file.model.times.truncate(83);
        let analysis = Analysis::new(&file.model).unwrap();
        let whole = analysis.run();
        let steps = whole.motion.len();
        let mut kept =
            SampledResults::new(Sampling { rows: 11, motion: true, sensitivities: true, outputs: None });
        let (mut next, mut windows) = (0, 0);
        // Smallest window: one batch of lanes.
        let end = analysis.solve_in_windows(Run::new(), 1, |first, window| {
            assert_eq!(first, next, "{name}");
            assert_same(&name, &whole, window, first, 1);
            next += window.motion.len();
            windows += 1;
            kept.add(first, window);
        });
        assert_eq!(next, steps, "{name}");
        assert!(windows * 8 >= steps, "{name}: {windows} windows of {steps}");
        assert_eq!(end.sensitivities.admissibility, whole.sensitivities.admissibility, "{name}");
        assert_eq!(end.motion.effort, whole.motion.effort, "{name}");
        assert_eq!(end.motion.assembly, whole.motion.assembly, "{name}");
        let stride = kept.stride();
        let kept = kept.end(&end);
        assert!(kept.motion.len() <= 11 && 2 * kept.motion.len() * stride > steps, "{name}");
        assert_same(&name, &whole, &kept, 0, stride);
        seen += 1;
    }
    assert!(seen > 10, "only {seen} models");
}

/// A crank with a cut joint, whose revolutions follow from rates only.
#[test]
fn turns_are_counted_through_windows() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../models/slider_crank.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let text = text.replace("sin(2*pi*t)", "8*pi*t");
    for cut in ["J1", "J2"] {
        let text = text.replace(&format!("{cut} = {{ type"), &format!("{cut} = {{ cut = true, type"));
        let file = hardpoint_file::parse(&text, path).unwrap();
        let analysis = Analysis::new(&file.model).unwrap();
        let whole = analysis.run();
        let turned =
            file.model.measures.iter().enumerate().map(|(m, _)| whole.measured.value(400, m)[0].abs());
        assert!(turned.fold(0.0, f64::max) > 8.0 * std::f64::consts::PI, "it turns several times");
        let each = |first: usize, window: &Solution| assert_same(cut, &whole, window, first, 1);
        analysis.solve_in_windows(Run::new(), 1, each);
    }
}
