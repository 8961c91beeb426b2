//! Size of a page: small enough to be sent and to open at once, for a suspension and for a large model.

use std::cell::RefCell;
use std::path::Path;

use hardpoint::model::{BodyId, VariableId};
use hardpoint::space::Vec3;
use hardpoint::{Analysis, Solution};
use hardpoint_file::ModelFile;
use hardpoint_report::course::Course;
use hardpoint_report::page::{Payload, html};
use hardpoint_report::payload::{Request, report};
use hardpoint_report::summary::Summary;
use hardpoint_study::difference::{Difference, DifferenceScheme, finite_differences};

use crate::rockers::rockers;

/// The payload of a run's page and the page itself; it compares with differences where `compared`.
fn page(file: &ModelFile, compared: bool) -> (Payload, String) {
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.run();
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    let course = Course::of(&file.model, &solution);
    let summary = Summary::new(file, &analysis, &course);
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
    finite_differences(analysis, solution, DifferenceScheme::Central, &steps)
        .into_iter()
        .map(Result::ok)
        .collect()
}

/// Budget of the strut's page, in bytes: a mail or a slow connection takes it. The engine is most of it; distances of
/// shapes are in it since the page computes clearances.
const STRUT: usize = 3_400_000;

#[test]
fn a_struts_page_weighs_three_megabytes_with_its_engine_and_leaves_nothing_out() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/macpherson.toml");
    let file = hardpoint_file::read(&path).unwrap();
    let (payload, report) = page(&file, true);
    let weight = report.len();
    assert!(weight <= STRUT, "{weight}");
    assert_eq!(payload.times.values().len(), file.model.times.len());
    for variable in payload.variables.iter().filter(|v| !v.sensitivities.is_empty()) {
        assert_eq!(variable.shifts.len(), payload.bodies.len());
        assert!(variable.sensitivities.iter().all(|s| s.fd.is_some()));
    }
}

#[test]
fn a_large_models_page_weighs_ten_megabytes_at_most() {
    let file =
        hardpoint_file::parse(&rockers(40), "rockers.toml").unwrap_or_else(|e| panic!("{}", e.render(false)));
    assert_eq!((file.model.bodies.len() - 1, file.model.variables.len()), (81, 240));
    let (payload, report) = page(&file, false);
    let weight = report.len();
    // It was packed to measure its size; the page contains that block.
    assert!(report == html(&payload).unwrap());
    assert!(weight <= 10_000_000, "{weight}");
    assert!(payload.times.values().len() >= 100);
    assert!(payload.variables.iter().all(|v| v.sensitivities.len() >= 40));
    println!("{weight} bytes, {} steps", payload.times.values().len());

    // A changed design is drawn from the motion of the bodies by the variables.
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
