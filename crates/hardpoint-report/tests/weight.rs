//! How heavy a page is: light enough to be sent about and to open at once, for a suspension and for a large model.

use std::cell::RefCell;
use std::fmt::Write;
use std::path::Path;

use hardpoint::model::{BodyId, VariableId};
use hardpoint::space::Vec3;
use hardpoint::study::{Difference, Scheme, finite_differences};
use hardpoint::{Analysis, Solution};
use hardpoint_file::ModelFile;
use hardpoint_report::course::Course;
use hardpoint_report::page::{Payload, html};
use hardpoint_report::payload::{Request, report};
use hardpoint_report::summary::Summary;

/// The payload of a run's page and the page itself; it compares with differences where `compared`.
fn page(file: &ModelFile, compared: bool) -> (Payload, String) {
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.run();
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    let course = Course::of(&file.model, &solution);
    let summary = Summary::new(file, analysis.topology(), &course);
    let differences = if compared { differences(file, &analysis, &solution) } else { Vec::new() };
    let request = Request { differences: &differences, ..Request::of(file, &analysis, &course, &summary) };
    let shown = RefCell::new(None);
    let finish = |payload: Payload| {
        shown.replace(Some(payload.clone()));
        payload
    };
    let report = report(&request, &finish).unwrap();
    (shown.into_inner().unwrap(), report)
}

fn differences(file: &ModelFile, analysis: &Analysis<'_>, solution: &Solution) -> Vec<Option<Difference>> {
    let variables = (0..file.model.variables.len()).map(VariableId);
    let steps: Vec<_> = variables.map(|b| (b, 1e-4 * file.model.natural_step(b))).collect();
    finite_differences(analysis, solution, Scheme::Central, &steps).into_iter().map(Result::ok).collect()
}

#[test]
fn a_struts_page_weighs_two_megabytes_at_most_and_leaves_nothing_out() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/macpherson.toml");
    let file = hardpoint_file::read(&path).unwrap();
    let (payload, report) = page(&file, true);
    let weight = report.len();
    assert!(weight <= 2_200_000, "{weight}");
    assert_eq!(payload.times.values().len(), file.model.times.len());
    for variable in payload.variables.iter().filter(|v| !v.sensitivities.is_empty()) {
        assert_eq!(variable.shifts.len(), payload.bodies.len());
        assert!(variable.sensitivities.iter().all(|s| s.fd.is_some()));
    }
}

/// Rockers in a row on pivots 100 mm apart, each coupled to the next one: two bodies and six design variables a stage.
fn rockers(stages: usize) -> String {
    let mut text = String::from(
        "name = \"rockers in a row\"\nunits = { length = \"mm\", angle = \"deg\" }\n[time]\nend = 2\nsteps = 200\n",
    );
    let mut points = String::from("[hardpoints]\npivot_0 = [0, 0, 0]\n");
    let mut bodies = String::from("[bodies]\nrocker_0 = {}\n");
    let joint = |name: &str, bodies: [&str; 2], at: &str| {
        let [i, j] = bodies;
        format!(
            "{name} = {{ type = \"revolute\", bodies = [\"{i}\", \"{j}\"], at = \"{at}\", axis = \"z\" }}\n"
        )
    };
    let mut joints = String::from("[joints]\n") + &joint("pivot_0", ["ground", "rocker_0"], "pivot_0");
    let (mut design, mut measures) = (String::from("[design]\n"), String::from("[measures]\n"));
    for k in 1..=stages {
        let (x, lean) = (100 * k, k % 3);
        let (rocker, coupler, before) =
            (format!("rocker_{k}"), format!("coupler_{k}"), format!("rocker_{}", k - 1));
        let (near, far, pivot) = (format!("near_{k}"), format!("far_{k}"), format!("pivot_{k}"));
        writeln!(
            points,
            "{pivot} = [{x}, 0, 0]\n{near} = [{}, 80, 0]\n{far} = [{}, {}, 0]",
            x - 90,
            x - lean,
            80 + lean
        )
        .unwrap();
        writeln!(bodies, "{coupler} = {{}}\n{rocker} = {{}}").unwrap();
        joints += &joint(&near, [&before, &coupler], &near);
        joints += &joint(&pivot, ["ground", &rocker], &pivot);
        joints += &joint(&far, [&coupler, &rocker], &far);
        for point in [&near, &far, &pivot] {
            for axis in ["x", "y"] {
                writeln!(design, "{point}_{axis} = {{ move = \"{point}\", along = \"{axis}\" }}").unwrap();
            }
        }
        writeln!(measures, "angle_{k} = {{ type = \"coordinate\", joint = \"{pivot}\" }}").unwrap();
    }
    text += &[points, bodies, joints, design, measures].concat();
    text + "[drivers]\nmotor = { joint = \"pivot_0\", law = \"0.2*sin(pi*t)\" }\n"
}

#[test]
fn a_large_models_page_weighs_ten_megabytes_at_most() {
    let file =
        hardpoint_file::parse(&rockers(40), "rockers.toml").unwrap_or_else(|e| panic!("{}", e.render(false)));
    assert_eq!((file.model.bodies.len() - 1, file.model.variables.len()), (81, 240));
    let (payload, report) = page(&file, false);
    let weight = report.len();
    // It was packed to be weighed; that is what stands in the page.
    assert!(report == html(&payload).unwrap());
    assert!(weight <= 10_000_000, "{weight}");
    assert!(payload.times.values().len() >= 100);
    assert!(payload.variables.iter().all(|v| v.sensitivities.len() >= 40));
    println!("{weight} bytes, {} steps", payload.times.values().len());

    // A changed design is drawn by how the bodies move with the variables.
    let solution = Analysis::new(&file.model).unwrap().run();
    let stride = solution.motion.len().div_ceil(payload.times.values().len());
    for (b, variable) in payload.variables.iter().enumerate() {
        assert_eq!(variable.shifts.len(), payload.bodies.len());
        for (body, shifts) in variable.shifts.iter().enumerate() {
            let moves = solution.sensitivities.moves(VariableId(b), BodyId(body));
            for (k, numbers) in shifts.values().chunks(6).enumerate().step_by(25) {
                let exact = solution.sensitivities.at(k * stride, b).unwrap().body(body);
                // mm and rad per mm.
                let [place, turn] = [exact.dr, exact.dpi * 1e-3].map(Vec3::to_array);
                for (shown, exact) in numbers.iter().zip([place, turn].as_flattened()) {
                    let off = (f64::from(*shown) - exact).abs();
                    assert!(
                        off <= 1e-6 * exact.abs().max(1e-3),
                        "{} {body} {k}: {shown} {exact}",
                        variable.name
                    );
                }
            }
            assert!(moves || shifts.values().iter().all(|x| *x == 0.0));
        }
    }
    let all = payload.variables.iter().flat_map(|v| &v.shifts);
    let moved = all.filter(|shifts| shifts.values().iter().any(|x| x.abs() > 1e-3)).count();
    assert!(moved > payload.variables.len(), "{moved}");
}
