//! Sweeps: positions of the designs, metrics compared with single designs, and errors in files.

use std::num::NonZero;
use std::ops::ControlFlow;

use hardpoint::Run;
use hardpoint::model::{Model, SweepMethod, SweepSettings};
use hardpoint::run::metrics;
use hardpoint::topology::Formulation;
use hardpoint_file::{ModelFile, parse};
use hardpoint_study::sweep::{self, Distribution, Request, Sweep, rank_correlation, sobol_indices};
use hardpoint_study::{BLOCK, Motions};

/// A slider-crank: the slider's place over the crank's angle is `x = r cos a + sqrt(l^2 - (r sin a - e)^2)`.
const CRANK: &str = r#"
name = "slider-crank"
units = { length = "mm", angle = "deg" }
parameters.rod = { value = 300, unit = "length", bounds = [250, 350] }
parameters.offset = { value = 20, unit = "length", bounds = [0, 40] }
parameters.radius = { value = 100, unit = "length" }
hardpoints = { O = [0, 0, 0], A = ["radius*cos(40*pi/180)", "radius*sin(40*pi/180)", 0], B = [300, "offset", 0] }
bodies = { crank = {}, slider = {} }
joints.pivot = { type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "z" }
joints.slide = { type = "translational", bodies = ["ground", "slider"], at = "B", axis = "x" }
joints.rod = { type = "distance", bodies = ["crank", "slider"], at = ["A", "B"], length = "rod" }
drivers.motor = { joint = "pivot", law = "20*t" }
measures.place = { type = "position", point = "B", along = "x" }
points.B = { body = "slider", at = "B" }
metrics.first = { of = "place", take = "value", at = 0 }
metrics.range = { of = "place", take = "range" }
time = { end = 1.0, steps = 10 }
"#;

fn file(text: &str) -> ModelFile {
    parse(text, "sweeps.toml").unwrap_or_else(|e| panic!("{e}"))
}

fn swept_from(model: &Model, asked: &SweepSettings, from: usize, threads: usize) -> Vec<sweep::Block> {
    let models = model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let numbers: Vec<usize> = (0..models.len()).collect();
    let request = Request { settings: asked.clone() };
    let sweep = Sweep::new(model, &motions, &numbers, &request).unwrap();
    let mut found = Vec::new();
    let mut done = |block| {
        found.push(block);
        ControlFlow::Continue(())
    };
    sweep.run(from, NonZero::new(threads).unwrap(), &|| true, &mut done);
    found
}

/// The slider's place in mm in the design configuration, for crank, rod and offset in mm.
fn place([radius, rod, offset]: [f64; 3]) -> f64 {
    let (sin, cos) = 40.0_f64.to_radians().sin_cos();
    radius * cos + (rod * rod - (radius * sin - offset).powi(2)).sqrt()
}

#[test]
fn a_factorial_has_every_combination_and_parameters_are_their_values() {
    let text = format!(
        "{CRANK}\n[sweep]\nmethod = \"factorial\"\n[sweep.variables]\nradius = [80, 120]\nrod = {{ levels = 2 }}\n"
    );
    let model = file(&text).model;
    let asked = model.sweeping.clone().unwrap();
    let blocks = swept_from(&model, &asked, 0, 1);
    let first = &blocks[0].metrics[0];
    let mut expected = Vec::new();
    for radius in [80.0, 100.0, 120.0] {
        for rod in [250.0, 350.0] {
            expected.push(place([radius, rod, 20.0]));
        }
    }
    assert_eq!(first.len(), expected.len());
    for (x, e) in first.iter().zip(&expected) {
        assert!((x * 1e3 - e).abs() < 1e-9, "{x} {e}");
    }
}

#[test]
fn metrics_are_those_of_each_design_by_itself_on_any_threads_and_from_anywhere() {
    // Lanes and single runs agree to round-off.
    const ROUND_OFF: f64 = 1e-12;
    let model = file(CRANK).model;
    for method in SweepMethod::NAMED {
        let asked =
            SweepSettings { method, samples: 1400, curves: vec![0], ..SweepSettings::of_bounds(&model) };
        let blocks = swept_from(&model, &asked, 0, 1);
        assert_eq!(blocks, swept_from(&model, &asked, 0, 3), "{method:?}");
        if blocks.len() > 1 {
            assert_eq!(blocks[1..], swept_from(&model, &asked, BLOCK, 2), "{method:?}");
        }
        let models = model.motions();
        let motions = Motions::of(&models, Formulation::Relative).unwrap();
        let request = Request { settings: asked };
        let sweep = Sweep::new(&model, &motions, &[0], &request).unwrap();
        for block in &blocks {
            for k in (0..block.numbers.len()).step_by(97) {
                let design = sweep.plan().design(block.numbers.start + k);
                let solution = motions.analyses()[0].solve(Run::new().at(&design).without_sensitivities());
                for (column, alone) in block.metrics.iter().zip(metrics(&model, &solution)) {
                    assert!((column[k] - alone.value.unwrap()).abs() < ROUND_OFF);
                }
                assert_eq!(block.curves[0].steps[k], 11);
                let last = solution.measured.value(10, 0)[0];
                assert!((block.curves[0].values[k * 11 + 10] - last).abs() < ROUND_OFF);
            }
        }
    }
}

#[test]
fn a_latin_hypercube_has_a_design_in_every_slice() {
    let model = file(CRANK).model;
    const N: usize = 1000;
    let asked =
        SweepSettings { method: SweepMethod::LatinHypercube, samples: N, ..SweepSettings::of_bounds(&model) };
    let models = model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let request = Request { settings: asked.clone() };
    let sweep = Sweep::new(&model, &motions, &[0], &request).unwrap();
    for (d, range) in asked.ranges.iter().enumerate() {
        let slice =
            |n| ((sweep.plan().swept(n)[d] - range.low) / (range.high - range.low) * N as f64) as usize;
        let mut slices: Vec<usize> = (0..N).map(slice).collect();
        slices.sort_unstable();
        assert!(slices.into_iter().eq(0..N));
    }
    // Both variables are ordered independently: their correlation is within four of its standard errors of 0.
    let product = |n: usize| -> f64 {
        let x = sweep.plan().swept(n);
        asked.ranges.iter().zip(x).map(|(r, x)| (x - 0.5 * (r.low + r.high)) / (r.high - r.low)).product()
    };
    let correlation = 12.0 * (0..N).map(product).sum::<f64>() / N as f64;
    assert!(correlation.abs() < 4.0 / (N as f64).sqrt(), "{correlation}");
}

#[test]
fn indices_of_a_mechanism_are_those_of_its_closed_form() {
    // `first` is r cos a + sqrt(l^2 - (r sin a - e)^2): nearly a sum in r, l and e, whose indices come from quadrature
    // of the closed form.
    let text = CRANK.replace(
        "parameters.radius = { value = 100, unit = \"length\" }",
        "parameters.radius = { value = 100, unit = \"length\", bounds = [60, 140] }",
    );
    let model = file(&text).model;
    let asked =
        SweepSettings { method: SweepMethod::Indices, samples: 1024, ..SweepSettings::of_bounds(&model) };
    let values: Vec<f64> =
        swept_from(&model, &asked, 0, 2).into_iter().flat_map(|b| b.metrics[0].clone()).collect();
    let found = sobol_indices(&values, 3, 0.0);
    // Midpoints of that many slices of every range: the error of a variance falls with their square, here to 1e-3 of
    // it.
    const SLICES: usize = 40;
    let ranges = [[60.0, 140.0], [250.0, 350.0], [0.0, 40.0]];
    let at =
        |d: usize, k: usize| ranges[d][0] + (ranges[d][1] - ranges[d][0]) * (k as f64 + 0.5) / SLICES as f64;
    let mut sums = [[0.0; SLICES]; 3];
    let (mut all, mut squares) = (0.0, 0.0);
    let n = SLICES as f64;
    for i in 0..SLICES {
        for j in 0..SLICES {
            for k in 0..SLICES {
                let x = place([at(0, i), at(1, j), at(2, k)]);
                for (d, slice) in [i, j, k].into_iter().enumerate() {
                    sums[d][slice] += x / (n * n);
                }
                all += x / n.powi(3);
                squares += x * x / n.powi(3);
            }
        }
    }
    let variance = squares - all * all;
    // In the order of the file: rod, offset, radius.
    for (index, d) in found.iter().zip([1, 2, 0]) {
        let exact = sums[d].iter().map(|x| (x - all).powi(2)).sum::<f64>() / n / variance;
        let [first, error] = index.unwrap().first;
        assert!((first - exact).abs() < f64::max(4.0 * error, 2e-3), "{d}: {first} +- {error}, {exact}");
        assert!(error < 0.05, "{error}");
    }
}

#[test]
fn broken_sweeps() {
    const SWEEP: &str = "\n[metrics.top]\nof = \"height\"\ntake = \"max\"\n\n[sweep]\nmethod = \"factorial\"\nsamples = 100\n[sweep.variables]\nB_x = [-1, 1]\nlean = { from = -2, to = 2, levels = 4 }\n";
    let whole = |text: &str| format!("{}{text}", crate::diagnostics::VALID);
    parse(&whole(SWEEP), "four-bar.toml").unwrap_or_else(|e| panic!("{e}"));
    let broken = |name: &str, old: &str, new: &str| {
        assert!(SWEEP.contains(old), "{old}");
        crate::diagnostics::snapshot(name, &whole(&SWEEP.replacen(old, new, 1)));
    };
    broken("sweep_of_unknown_variable", "B_x", "B_w");
    broken("sweep_of_a_point", "B_x", "B");
    broken("sweep_that_does_not_rise", "[-1, 1]", "[1, -1]");
    broken("sweep_from_three_values", "[-1, 1]", "[-1, 0, 1]");
    broken("sweep_without_an_end", "to = 2, ", "");
    broken("sweep_of_one_level", "levels = 4", "levels = 1");
    broken("sweep_by_unknown_method", "factorial", "grid");
    broken("sweep_of_no_samples", "samples = 100", "samples = 0");
    broken(
        "sweep_of_too_many",
        "samples = 100\n[sweep.variables]\nB_x = [-1, 1]",
        "levels = 1000000\n[sweep.variables]\nB_x = [-1, 1]\nB_y = [-1, 1]",
    );
    broken("sweep_of_unknown_curve", "samples = 100", "curves = [\"hight\"]");
    broken("sweep_of_unknown_metric", "samples = 100", "metrics = [\"height\"]");
    broken("sweep_with_misspelt_key", "samples = 100", "sample = 100");
    broken("sweep_of_a_list_and_ranges", "samples = 100", "designs = \"designs.csv\"");
    crate::diagnostics::snapshot("sweep_of_nothing", &whole("\n[sweep]\nsamples = 100\n"));
    crate::diagnostics::snapshot("sweep_as_a_number", &format!("sweep = 100\n{}", crate::diagnostics::VALID));
}

#[test]
fn broken_lists_of_designs() {
    let folder = tempfile::tempdir().unwrap();
    let text = format!("{}\n[sweep]\ndesigns = \"designs.csv\"\n", crate::diagnostics::VALID);
    let path = folder.path().join("four-bar.toml");
    std::fs::write(&path, text).unwrap();
    let read = |list: &str| {
        std::fs::write(folder.path().join("designs.csv"), list).unwrap();
        hardpoint_file::read(&path)
    };
    let model = read("B_x [mm]; lean\n# in the design configuration\n0; 0\n1.5; -2\n")
        .unwrap_or_else(|e| panic!("{e}"))
        .model;
    let sweeping = model.sweeping.unwrap();
    assert_eq!((sweeping.method, sweeping.listed.len()), (SweepMethod::Listed, 2));
    assert_eq!(sweeping.listed[1], [0.0015, -2.0_f64.to_radians()]);
    for list in ["B_x [cm]; lean [rad]\n0; 0\n0.15; -0.0349\n", "lean [deg],B_x [m]\n0,0\n-1.9996,0.0015\n"] {
        let listed = read(list).unwrap_or_else(|e| panic!("{e}")).model.sweeping.unwrap().listed;
        let alone = read("B_x\n0\n").unwrap_or_else(|e| panic!("{e}"));
        let given = alone.designs(&folder.path().join("other.csv"));
        assert!(given.is_err());
        std::fs::write(folder.path().join("other.csv"), list).unwrap();
        let (ranges, given) =
            alone.designs(&folder.path().join("other.csv")).unwrap_or_else(|e| panic!("{e}"));
        std::fs::remove_file(folder.path().join("other.csv")).unwrap();
        for rows in [listed, given] {
            let of =
                |name: &str| ranges.iter().position(|r| alone.model.variables[r.variable.0].name == name);
            let [x, lean] = ["B_x", "lean"].map(|name| rows[1][of(name).unwrap()]);
            assert!((x - 0.0015).abs() < 1e-15 && (lean + 0.0349).abs() < 1e-5, "{list:?} {rows:?}");
        }
    }
    for (unit, words) in [("banana", "`B_x` is in `banana`, and it is a length"), ("deg", "it is a length")] {
        let list = format!("lean,B_x [{unit}]\n0,1\n");
        std::fs::write(folder.path().join("other.csv"), &list).unwrap();
        let alone = read("B_x\n0\n").unwrap_or_else(|e| panic!("{e}"));
        let given = alone.designs(&folder.path().join("other.csv")).unwrap_err();
        for error in [given.to_string(), read(&list).unwrap_err().to_string()] {
            assert!(
                error.contains("HP0247") && error.contains(words) && error.contains("column 2"),
                "{error}"
            );
        }
    }
    let mut texts = String::new();
    for list in [
        "",
        "B_x,lean\n",
        "1,2\n3,4\n",
        "B_x,leen\n1,2\n",
        "B_x,B_x\n1,2\n",
        "B,lean\n1,2\n",
        "B_x,lean\n1\n",
        "B_x,lean\n1,2\n1,2,3\n",
        "B_x,lean\n1,inf\n",
        "B_x,lean\n1,two\n",
        "B_x,lean\n1,\n",
    ] {
        let error =
            read(list).expect_err(list).to_string().replace(&folder.path().display().to_string(), "FOLDER");
        texts.push_str(&format!("{list:?}\n{error}\n"));
    }
    insta::with_settings!({ snapshot_path => "../snapshots", prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!("broken_lists_of_designs", texts);
    });
}

#[test]
fn a_metric_that_does_not_vary_has_no_rank_correlations() {
    // A tracer point varies, and with it nothing of the rocker.
    let model = file(
        r#"
name = "tracer"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { A = [0, 0], B = [30, 10], C = [95, 58], D = [110, -5], P = [60, 60] }
bodies = { ground = ["A", "D"], crank = ["A", "B"], coupler = ["B", "C", "P"], rocker = ["C", "D"] }
drivers.motor = { joint = "A", law = "360*t" }
design.P = { move = "P", along = "x", bounds = [-5, 5] }
measures.psi = { type = "coordinate", joint = "D" }
metrics.height = { of = "P.y", take = "max" }
metrics.greatest = { of = "psi", take = "max" }
time = { end = 1, steps = 12 }
"#,
    )
    .model;
    let asked = SweepSettings { samples: 100, ..SweepSettings::of_bounds(&model) };
    let blocks = swept_from(&model, &asked, 0, 1);
    let models = model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let request = Request { settings: asked };
    let sweep = Sweep::new(&model, &motions, &[0], &request).unwrap();
    let (_, round_off) = sweep.nominal();
    let variable: Vec<f64> = (0..sweep.plan().count()).map(|k| sweep.plan().swept(k)[0]).collect();
    for (k, varies) in [true, false].into_iter().enumerate() {
        let values: Vec<f64> = blocks.iter().flat_map(|b| b.metrics[k].clone()).collect();
        let rank = rank_correlation(&variable, &values, round_off[k]);
        let sigma = Distribution::of(&values, round_off[k]).unwrap().sigma;
        assert_eq!((rank.is_some(), sigma > 0.0), (varies, varies), "{rank:?} {sigma}");
    }
}
