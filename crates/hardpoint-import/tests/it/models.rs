use hardpoint::sensitivity::Admissibility;
use hardpoint::{Analysis, Run};

use crate::{folder, import, model, sources};

#[test]
fn every_format_has_three_files_and_is_recognised_by_them() {
    for format in hardpoint_import::FORMATS {
        let own: Vec<_> = sources().into_iter().filter(|(name, _)| name == format.name).collect();
        assert!(own.len() >= 3, "{} has {} files", format.name, own.len());
        for (_, path) in own {
            let found = hardpoint_import::Format::of(&crate::bytes(&path), &path.to_string_lossy());
            assert_eq!(found.map(|f| f.name), Some(format.name), "{}", path.display());
            // Recognised from its content alone.
            let found = hardpoint_import::Format::of(&crate::bytes(&path), "file");
            assert_eq!(found.map(|f| f.name), Some(format.name), "{}", path.display());
        }
    }
}

#[test]
fn every_file_becomes_a_model_that_moves_from_end_to_end_and_follows_its_variables() {
    for (_, path) in sources() {
        let imported = import(&path).unwrap_or_else(|e| panic!("{}:\n{e}", path.display()));
        assert!(imported.fault.is_none(), "{}: {}", path.display(), imported.fault.unwrap());
        let file = model(&imported);
        let analysis = Analysis::new(&file.model).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let solution = analysis.solve(Run::new());
        assert!(solution.stop.is_none(), "{}: {:?}", path.display(), solution.stop);
        assert_eq!(solution.motion.len(), file.model.times.len(), "{}", path.display());
        for (variable, is) in file.model.variables.iter().zip(&solution.sensitivities.admissibility) {
            let follows = !matches!(is, Admissibility::CannotFollow { .. });
            assert!(follows, "{}: `{}` cannot be followed", path.display(), variable.name);
        }
        // Redundant loops and bodies without mass are reported.
        let noted = |code: &str| ["HP0503", "HP0253"].contains(&code);
        assert!(file.remarks.iter().all(|r| noted(r.code)), "{}: {:?}", path.display(), file.remarks);
    }
}

#[test]
fn reports_account_for_every_element() {
    for (format, path) in sources() {
        let imported = import(&path).unwrap_or_else(|e| panic!("{}:\n{e}", path.display()));
        let name = path.file_name().unwrap().to_string_lossy().replace('.', "_");
        insta::assert_snapshot!(format!("{format}__{name}"), imported.report.to_string());
    }
}

#[test]
fn shapes_are_drawn_in_the_frames_of_their_bodies() {
    let imported = import(&folder().join("urdf/gripper.urdf")).unwrap();
    let file = model(&imported);
    let body = |name: &str| file.model.bodies.iter().position(|b| b.name == name).unwrap();
    // A mesh in mm, 50 mm high, beginning 30 mm above the origin of its link.
    let finger = &file.drawing.bodies[&body("finger_left")];
    let heights: Vec<f64> = finger.vertices.iter().map(|v| v.z).collect();
    let [low, high] = [f64::min, f64::max].map(|f| heights.iter().copied().reduce(f).unwrap());
    // Files of triangles have single precision.
    assert!((low - 0.03).abs() < 1e-8 && (high - 0.08).abs() < 1e-8, "{low} to {high}");
    let palm = &file.drawing.bodies[&body("palm")];
    let half: Vec<f64> =
        (0..3).map(|k| palm.vertices.iter().map(|v| v[k].abs()).fold(0.0, f64::max)).collect();
    assert!(half.iter().zip([0.04, 0.02, 0.01]).all(|(a, b)| (a - b).abs() < 1e-8), "{half:?}");
    assert_eq!(palm.triangles.len(), 12);
}

#[test]
fn a_stored_motion_is_reproduced() {
    /// Tolerance for fourteen digits, and for angles near their jump.
    const SAME: f64 = 1e-10;
    let imported = import(&folder().join("asmt/four_bar.asmt")).unwrap();
    let series = imported.series.as_ref().unwrap();
    let file = model(&imported);
    let solution = Analysis::new(&file.model).unwrap().solve(Run::new().without_sensitivities());
    let d = series.compare(&file, &solution);
    assert_eq!(d.times, 51);
    assert_eq!(series.bodies.len(), 3);
    assert!(d.place < SAME && d.turn < SAME, "{d:?}");
    for (by, of) in d.rates.iter().zip(d.largest) {
        assert!(of > 0.1 && *by < SAME * of, "{d:?}");
    }
    // A modified stored value is detected.
    let mut off = series.clone();
    off.bodies[1].1[20].pose.r.x += 1e-6;
    assert!((off.compare(&file, &solution).place - 1e-6).abs() < SAME);
}

#[test]
fn robots_have_a_point_that_moves() {
    for (file, point) in [("mjcf/four_bar.xml", "coupler_end"), ("sdf/four_bar.sdf", "coupler_end")] {
        let path = folder().join(file);
        let imported = hardpoint_import::import(&std::fs::read(&path).unwrap(), file, &|_| None)
            .unwrap_or_else(|e| panic!("{e}"));
        // Shapes are in separate files.
        let bare = |line: &str| match (line.find(", mesh = {"), line.rfind(" }")) {
            (Some(k), Some(_)) => format!("{} }}\n", &line[..k]),
            _ => format!("{line}\n"),
        };
        let text: String = imported.text.lines().map(bare).collect();
        let read = hardpoint_file::parse(&text, "model.toml").unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(read.model.points[0].name, point);
        let run = Analysis::new(&read.model).unwrap().run();
        let at = |k: usize, axis: usize| {
            let name = format!("{point}.{}", ["x", "y", "z"][axis]);
            let m = run.measured.outputs.iter().position(|o| o.name == name).unwrap();
            run.measured.value(k, m)[0]
        };
        let moves = |axis| (0..run.motion.len()).any(|k| (at(k, axis) - at(0, axis)).abs() > 1e-3);
        assert!((0..3).any(moves), "{file}");
    }
}
