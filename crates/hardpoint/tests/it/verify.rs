//! Sensitivities against re-solved designs, on every reference mechanism.

use hardpoint::Analysis;
use hardpoint::model::Model;
use hardpoint::study::{CheckOutcome, VerifyOptions, verify};
use std::ops::ControlFlow;

#[test]
fn sensitivities_match_resolved_designs_and_the_error_falls_with_the_square_of_the_step() {
    let mut falling = 0;
    for name in ["slider_crank", "macpherson", "rssr", "hooke", "double_wishbone", "jansen"] {
        let file = format!("{}/tests/reference/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let case = crate::reference_case::Case::read(file.as_ref()).unwrap();
        let model = Model::from_draft(&case.draft).unwrap();
        let analysis = Analysis::new(&model).unwrap();
        let solution = analysis.run();
        let report = verify(&analysis, &solution, &VerifyOptions::default(), |_| ControlFlow::Continue(()));
        for check in &report.checks {
            let variable = &model.variables[check.variable.0].name;
            if check.outcome == CheckOutcome::CannotFollow {
                continue;
            }
            assert_eq!(check.outcome, CheckOutcome::Passed, "{name} {variable}: {:?}", check.sweep);
            // Where truncation rules, well above the best agreement, a step 10 times finer errs 100 times less.
            let best = check.best().unwrap();
            let coarse =
                check.sweep.iter().take_while(|s| s.step > best.step && s.error > 100.0 * best.error);
            let coarse: Vec<_> = coarse.filter(|s| s.error < 1e-2).collect();
            for pair in coarse.windows(3) {
                let ratio = pair[0].error / pair[2].error;
                assert!((50.0..200.0).contains(&ratio), "{name} {variable}: {pair:?}");
                falling += 1;
            }
        }
        assert!(report.passed());
    }
    assert!(falling > 100, "only {falling} places where the error could be seen to fall");
}
