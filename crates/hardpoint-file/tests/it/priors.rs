//! Prior knowledge in calibrations: Bayesian least squares in closed form, coverage over hidden designs, limits of wide
//! and narrow priors, groups, bounds, offsets, stiffnesses and validation data.

use std::path::Path;

use hardpoint::Analysis;
use hardpoint::model::{
    ElementId, Measurements, Model, Offset, OffsetSource, PriorGroup, Reading, VariableId, VariablePrior,
};
use hardpoint::topology::Formulation;
use hardpoint_file::parse;
use hardpoint_study::calibrate::{
    BoundSide, Calibration, Loss, Overrides, Prior, Request, Status, values_in_postures,
};

use crate::calibrations::{CRANK, assert_covered, calibrated, mahalanobis, noise, readings};

/// Round-off of a linear problem, relative.
const LINEAR: f64 = 1e-10;
/// A fit ends when an iteration lowers its objective by less than 1e-12 of it: its design is known to the root of that,
/// in standard deviations.
const ENDED: f64 = 1e-6;

fn model_of(text: &str) -> Model {
    parse(text, "priors.toml").unwrap_or_else(|e| panic!("{e}\n{text}")).model
}

fn request<'a>(model: &Model, measured: &'a Measurements) -> Request<'a> {
    Request::of(model, measured, &Overrides::default()).unwrap_or_else(|e| panic!("{e}"))
}

fn fit(model: &Model, measured: &Measurements) -> Calibration {
    calibrated(model, &request(model, measured)).unwrap_or_else(|e| panic!("{e:?}"))
}

fn close(a: f64, b: f64, relative: f64, scale: f64) -> bool {
    (a - b).abs() <= relative * scale
}

/// A slider whose points depend linearly on three lengths: x = a + 2 b - c + s, y = b + c, z = a - b.
fn linear(unit: &str, scale: f64, order: [&str; 3], calibrate: &str) -> Model {
    let nominal = |name: &str| scale * if name == "a" { 100.0 } else { 20.0 };
    let parameters: String = order
        .iter()
        .map(|name| format!("{name} = {{ value = {}, unit = \"length\", design = true }}\n", nominal(name)))
        .collect();
    model_of(&format!(
        r#"
name = "linear"
units = {{ length = "{unit}", angle = "deg" }}
hardpoints = {{ O = [0, 0, 0], P = ["a + 2*b - c", "b + c", "a - b"] }}
bodies = {{ slider = {{}} }}
joints.slide = {{ type = "translational", bodies = ["ground", "slider"], at = "O", axis = "x" }}
drivers.motor = {{ joint = "slide", law = "{scale}*t" }}
points.P = {{ body = "slider", at = "P" }}
time = {{ end = 1.0, steps = 4 }}
[parameters]
{parameters}
{calibrate}
"#
    ))
}

/// Solves A x = B for several right-hand sides by Gauss elimination with pivots.
fn solve(mut a: Vec<Vec<f64>>, mut b: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let n = a.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|i, j| a[*i][k].abs().total_cmp(&a[*j][k].abs())).unwrap();
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in (0..n).filter(|i| *i != k) {
            let by = a[i][k] / a[k][k];
            for j in 0..n {
                a[i][j] -= by * a[k][j];
            }
            for j in 0..b[i].len() {
                b[i][j] -= by * b[k][j];
            }
        }
    }
    (0..n).map(|k| b[k].iter().map(|x| x / a[k][k]).collect()).collect()
}

/// Priors of the linear slider in a unit of which a millimetre has `scale`: a 100.2 +- 0.3 mm, c +- 0.5 mm, and b and c
/// within 0.1 mm.
fn linear_priors(scale: f64) -> String {
    format!(
        r#"
[calibrate.variables]
a = {{ sigma = {}, mean = {} }}
c = {}
[calibrate.groups.pair]
variables = ["b", "c"]
within = {}
"#,
        0.3 * scale,
        100.2 * scale,
        0.5 * scale,
        0.1 * scale
    )
}

/// Readings of x and y of the point in two postures; the third coordinate is not read.
fn linear_readings(model: &Model) -> Measurements {
    let mut noise = noise(4);
    let hidden: Vec<f64> =
        model.variables.iter().map(|v| if v.name == "a" { 4e-4 } else { -1.5e-4 }).collect();
    readings(model, &hidden, &[vec![0.0], vec![0.05]], &[0, 1], 1e-4, &mut noise)
}

#[test]
fn a_linear_mechanism_is_bayesian_least_squares() {
    let model = linear("mm", 1.0, ["a", "b", "c"], &linear_priors(1.0));
    let measured = linear_readings(&model);
    let found = fit(&model, &measured);
    // H = J' J / s^2 + priors,  g = J' (m - y0) / s^2 + means;  x = H^-1 g,  C = H^-1
    let rows = [[1.0, 2.0, -1.0], [0.0, 1.0, 1.0]];
    let [a, b, c] = [0.1_f64, 0.02, 0.02];
    let nominal = [a + 2.0 * b - c, b + c];
    let mut h = vec![vec![0.0; 3]; 3];
    let mut g = vec![vec![0.0]; 3];
    let mut add = |row: [f64; 3], right: f64, sigma: f64| {
        for i in 0..3 {
            g[i][0] += row[i] * right / sigma.powi(2);
            for j in 0..3 {
                h[i][j] += row[i] * row[j] / sigma.powi(2);
            }
        }
    };
    for r in &measured.readings {
        let at = nominal[r.output] + if r.output == 0 { measured.postures[r.posture][0] } else { 0.0 };
        add(rows[r.output], r.value - at, 1e-4);
    }
    add([1.0, 0.0, 0.0], 2e-4, 3e-4);
    add([0.0, 0.0, 1.0], 0.0, 5e-4);
    // Of a pair both deviate from their mean by half of their difference.
    add([0.0, 0.5, -0.5], 0.0, 1e-4);
    add([0.0, -0.5, 0.5], 0.0, 1e-4);
    let unit = (0..3).map(|i| (0..3).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    let (x, covariance) = (solve(h.clone(), g), solve(h, unit));
    for i in 0..3 {
        assert!(close(found.design[i], x[i][0], LINEAR, 1e-3), "{:?} {x:?}", found.design);
        for j in 0..3 {
            let scale = (covariance[i][i] * covariance[j][j]).sqrt();
            let ours = found.certainty.covariance[i][j];
            assert!(close(ours, covariance[i][j], LINEAR, scale), "{i} {j}: {ours} {}", covariance[i][j]);
        }
    }
    assert_eq!((found.status, found.certainty.unidentifiable.len()), (Status::Found, 0));
    // Two of the readings differ by nothing but noise, so that two directions are theirs and one is that of the priors.
    assert_eq!(found.certainty.by_prior.len(), 1, "{:?}", found.certainty.by_prior);
    let direction = &found.certainty.by_prior[0].direction;
    let change = rows.map(|row| row.iter().zip(direction).map(|(r, d)| r * d).sum::<f64>());
    // The readings are ten times as accurate as the priors are narrow, so that it changes them slightly.
    let size = direction.iter().map(|d| d.abs()).fold(0.0, f64::max);
    assert!(change.iter().all(|x| x.abs() < 0.3 * size), "{change:?} {direction:?}");
    // Prior standard deviations: a by itself; c by itself, and b by c and the group: sqrt(0.5^2 + 2 * 0.1^2) mm.
    let prior: Vec<f64> = found.certainty.prior_sigmas.iter().map(|s| s.unwrap()).collect();
    let expected = [3e-4, (2.5e-7_f64 + 2e-8).sqrt(), 5e-4];
    assert!(prior.iter().zip(expected).all(|(p, e)| close(*p, e, LINEAR, e)), "{prior:?}");
}

#[test]
fn order_and_units_of_priors_do_not_matter() {
    let one = linear("mm", 1.0, ["a", "b", "c"], &linear_priors(1.0));
    let other = linear("m", 1e-3, ["c", "a", "b"], &linear_priors(1e-3));
    let measured = linear_readings(&one);
    let (one_fit, other_fit) = (fit(&one, &measured), fit(&other, &measured));
    for (k, variable) in one.variables.iter().enumerate() {
        let j = other.variable(&variable.name).unwrap().0;
        assert!(close(one_fit.design[k], other_fit.design[j], LINEAR, 1e-3));
        let [a, b] = [one_fit.certainty.sigmas[k].unwrap(), other_fit.certainty.sigmas[j].unwrap()];
        assert!(close(a, b, LINEAR, a), "{}: {a} {b}", variable.name);
    }
}

/// A delta robot with rods of 217 mm, one length per pair, on a mount of unknown height, in mm. `more` has the
/// calibration.
fn delta(more: &str) -> Model {
    let mut text = r#"
name = "delta"
units = { length = "mm", angle = "deg" }
[parameters]
mount = { value = 0, unit = "length", design = true }
rod_1 = { value = 217, unit = "length", design = true }
rod_2 = { value = 217, unit = "length", design = true }
rod_3 = { value = 217, unit = "length", design = true }
[bodies]
arm_1 = {}
arm_2 = {}
arm_3 = {}
platform = {}
[points]
tool = { body = "platform", at = "tool" }
[time]
end = 1.0
steps = 4
"#
    .to_owned();
    // Height of the rods' ends: from 140 to 30 mm off the axis
    let low = -50.0 - (217.0_f64.powi(2) - 110.0_f64.powi(2)).sqrt();
    let (mut hardpoints, mut joints, mut drivers) =
        (format!("tool = [0, 0, {low}]\n"), String::new(), String::new());
    for k in 1..=3 {
        let (sin, cos) = (f64::from(k - 1) * 120.0).to_radians().sin_cos();
        let at = |radius: f64, side: f64| [radius * cos - side * sin, radius * sin + side * cos];
        let [x, y] = at(80.0, 0.0);
        hardpoints += &format!("shoulder_{k} = [{x}, {y}, \"mount\"]\n");
        for (side, by) in [("left", 20.0), ("right", -20.0)] {
            let ([x, y], [u, v]) = (at(140.0, by), at(30.0, by));
            hardpoints += &format!("elbow_{k}_{side} = [{x}, {y}, \"mount - 50\"]\n");
            hardpoints += &format!("wrist_{k}_{side} = [{u}, {v}, {low}]\n");
            joints += &format!(
                "rod_{k}_{side} = {{ type = \"distance\", bodies = [\"arm_{k}\", \"platform\"], at = [\"elbow_{k}_{side}\", \"wrist_{k}_{side}\"], length = \"rod_{k}\" }}\n"
            );
        }
        let axis = [-sin, cos, 0.0];
        joints += &format!(
            "motor_{k} = {{ type = \"revolute\", bodies = [\"ground\", \"arm_{k}\"], at = \"shoulder_{k}\", axis = {axis:?} }}\n"
        );
        drivers += &format!("motor_{k} = {{ joint = \"motor_{k}\", law = \"t\" }}\n");
    }
    text += &format!("[hardpoints]\n{hardpoints}[joints]\n{joints}[drivers]\n{drivers}{more}");
    model_of(&text)
}

#[test]
fn rods_that_the_readings_hardly_determine_stay_as_they_are_known() {
    // Heights of the tool over small motions: a longer rod is nearly a higher mount.
    let free = delta("");
    let hidden: Vec<f64> =
        free.variables.iter().map(|v| if v.name == "mount" { 0.0 } else { 17e-3 }).collect();
    let postures: Vec<Vec<f64>> = [[0.0, 0.0, 0.0], [0.05, 0.0, 0.0], [0.0, 0.05, 0.0], [0.0, 0.0, 0.05]]
        .iter()
        .chain(&[[-0.05, -0.05, -0.05], [0.05, 0.05, 0.05]])
        .map(|p| p.to_vec())
        .collect();
    let measured = readings(&free, &hidden, &postures, &[0, 1, 2], 5e-4, &mut || 0.0);
    let length = |model: &Model, found: &Calibration, k: usize| {
        1e3 * (0.217 + found.design[model.variable(&format!("rod_{k}")).unwrap().0])
    };
    let without = fit(&free, &measured);
    assert_eq!(without.status, Status::Found);
    let known = delta("[calibrate.variables]\nrod_1 = 1\nrod_2 = 1\nrod_3 = 1\n");
    let with = fit(&known, &measured);
    assert_eq!((with.status, with.certainty.unidentifiable.len()), (Status::Found, 0));
    for k in 1..=3 {
        let (before, after) = (length(&free, &without, k), length(&known, &with, k));
        let [sigma, kept] = [(&free, &without), (&known, &with)].map(|(model, found)| {
            1e3 * found.certainty.sigmas[model.variable(&format!("rod_{k}")).unwrap().0].unwrap()
        });
        println!(
            "rod {k}: without prior {before:.3} +- {sigma:.3} mm, with 217 +- 1 mm {after:.3} +- {kept:.3} mm"
        );
        assert!((before - 234.0).abs() < 0.01, "{before}");
        assert!(after < 218.0 && after > 216.0, "{after}");
        assert!(sigma > 5.0 && kept < 1.0, "{sigma} {kept}");
    }
    assert!(!with.certainty.by_prior.is_empty());
    // In a group of rods of one batch they are equal, and the sum of all is as known as before.
    let batch = delta(
        "[calibrate.variables]\nrod_1 = 1\n[calibrate.groups.batch]\nvariables = [\"rod_1\", \"rod_2\", \"rod_3\"]\nwithin = 0.05\n",
    );
    let grouped = fit(&batch, &measured);
    let lengths: Vec<f64> = (1..=3).map(|k| length(&batch, &grouped, k)).collect();
    assert!(lengths.iter().all(|l| (l - lengths[0]).abs() < 0.05 && *l < 218.5), "{lengths:?}");
}

/// Wide and narrow priors of the slider-crank: its rod, offset and radius.
fn crank_with(priors: &[(usize, f64)]) -> (Model, Measurements, Prior) {
    let model = model_of(CRANK);
    let postures: Vec<Vec<f64>> = (0..12).map(|k| vec![f64::from(k) * 0.5]).collect();
    let measured = readings(&model, &[1e-3, -5e-4, 3e-4], &postures, &[0], 2e-5, &mut noise(6));
    let of = |(k, sigma): &(usize, f64)| VariablePrior { variable: VariableId(*k), mean: 0.0, sigma: *sigma };
    let prior = Prior { variables: priors.iter().map(of).collect(), ..Prior::default() };
    (model, measured, prior)
}

fn fit_with(model: &Model, measured: &Measurements, prior: Prior) -> Calibration {
    let request = Request { prior, ..request(model, measured) };
    calibrated(model, &request).unwrap_or_else(|e| panic!("{e:?}"))
}

#[test]
fn a_prior_without_weight_is_no_prior() {
    let (model, measured, wide) = crank_with(&[(0, 1e6), (1, 1e9), (2, 1e3)]);
    let (none, wide) = (fit(&model, &measured), fit_with(&model, &measured, wide));
    for k in 0..3 {
        let [a, b] = [&none, &wide].map(|c| c.certainty.sigmas[k].unwrap());
        assert!(close(a, b, ENDED, a), "{a} {b}");
        assert!(close(none.design[k], wide.design[k], ENDED, a), "{:?} {:?}", none.design, wide.design);
    }
    // Readings that determine no variable stay as undetermined as they are.
    let few = Measurements { readings: measured.readings[..1].to_vec(), ..measured };
    let (_, _, prior) = crank_with(&[(0, 1e6), (1, 1e9), (2, 1e3)]);
    assert_eq!(fit_with(&model, &few, prior).certainty.unidentifiable.len(), 2);
}

#[test]
fn a_prior_of_no_width_fixes_the_variable() {
    // Narrower than round-off of the mechanism's size.
    for sigma in [1e-9, 1e-13] {
        let (model, measured, narrow) = crank_with(&[(0, sigma)]);
        let narrow = fit_with(&model, &measured, narrow);
        let variables = vec![VariableId(1), VariableId(2)];
        let fixed = Request { variables, ..request(&model, &measured) };
        let fixed = calibrated(&model, &fixed).unwrap();
        // The readings pull it by less than its standard deviation.
        assert!(narrow.design[0].abs() < sigma, "{}", narrow.design[0]);
        /// The prior of 1e-9 m moves the variable by 1e-4 of the others' standard deviations.
        const FIXED: f64 = 1e-3;
        for k in 1..3 {
            let [a, b] = [narrow.certainty.sigmas[k].unwrap(), fixed.certainty.sigmas[k - 1].unwrap()];
            assert!(close(a, b, FIXED, a), "{a} {b}");
            assert!(close(narrow.design[k], fixed.design[k], FIXED, a));
        }
    }
}

#[test]
fn estimated_standard_deviations_weigh_readings_against_priors() {
    let (model, mut measured, prior) = crank_with(&[(0, 1e-3), (1, 1e-3)]);
    let given = fit_with(&model, &measured, prior.clone());
    measured.readings.iter_mut().for_each(|r| r.sigma = None);
    let estimated = fit_with(&model, &measured, prior.clone());
    let scatter = estimated.certainty.scatter.unwrap();
    // Twelve readings: within four standard deviations of its own.
    assert!((scatter / 2e-5 - 1.0).abs() < 4.0 / 18_f64.sqrt(), "{scatter}");
    // With that standard deviation the fit is the same.
    measured.readings.iter_mut().for_each(|r| r.sigma = Some(scatter));
    let again = fit_with(&model, &measured, prior);
    for k in 0..3 {
        let [a, b] = [&estimated, &again].map(|c| c.certainty.sigmas[k].unwrap());
        assert!(close(a, b, 1e-4, a) && close(estimated.design[k], again.design[k], 1e-3, a), "{a} {b}");
        assert!(given.certainty.sigmas[k].is_some());
    }
}

#[test]
fn a_variable_that_would_leave_its_bounds_stays_on_one() {
    let bounded = CRANK.replace(
        "rod = { value = 300, unit = \"length\", design = true }",
        "rod = { value = 300, unit = \"length\", design = true, bounds = [299.5, 300.5] }",
    );
    let model = model_of(&format!("{bounded}\n[calibrate]\n"));
    let postures: Vec<Vec<f64>> = (0..12).map(|k| vec![f64::from(k) * 0.5]).collect();
    let measured = readings(&model, &[1e-3, -5e-4, 3e-4], &postures, &[0], 2e-5, &mut noise(6));
    let found = fit(&model, &measured);
    assert_eq!(found.status, Status::Found);
    assert_eq!(found.certainty.bounds, [Some(BoundSide::Upper), None, None]);
    assert!(found.certainty.sigmas[0].is_none() && close(found.design[0], 5e-4, LINEAR, 1e-3));
    // The others are those of a rod of 300.5 mm.
    let longer = model_of(&CRANK.replace("value = 300, unit", "value = 300.5, unit"));
    let variables = vec![VariableId(1), VariableId(2)];
    let fixed = calibrated(&longer, &Request { variables, ..request(&longer, &measured) }).unwrap();
    for k in 1..3 {
        let [a, b] = [found.certainty.sigmas[k].unwrap(), fixed.certainty.sigmas[k - 1].unwrap()];
        assert!(close(a, b, ENDED, a), "{a} {b}");
        assert!(close(found.design[k], fixed.design[k], 1e-3, a), "{:?} {:?}", found.design, fixed.design);
    }
    // Without `[calibrate]` bounds are not kept, and the fit is that without bounds to the last bit.
    let ranges = model_of(&bounded);
    assert_eq!(fit(&ranges, &measured).design, fit(&model_of(CRANK), &measured).design);
    // Bounds that the fit does not meet change nothing but round-off.
    let wide = model_of(&format!("{}\n[calibrate]\n", bounded.replace("[299.5, 300.5]", "[290, 310]")));
    let (wide, free) = (fit(&wide, &measured), fit(&model_of(CRANK), &measured));
    for k in 0..3 {
        assert!(close(wide.design[k], free.design[k], ENDED, free.certainty.sigmas[k].unwrap()));
    }
    assert_eq!(wide.certainty.bounds, [None; 3]);
}

#[test]
fn a_table_without_priors_changes_nothing() {
    let (model, measured, _) = crank_with(&[]);
    let empty = model_of(&format!("{CRANK}\n[calibrate]\n"));
    let (one, other) = (fit(&model, &measured), fit(&empty, &measured));
    assert_eq!(
        (one.design, one.certainty, one.iterations),
        (other.design, other.certainty, other.iterations)
    );
}

#[test]
fn offsets_of_a_driver_and_a_gauge_are_found_by_their_names() {
    let plain = model_of(CRANK);
    let model = model_of(&format!(
        "{CRANK}\n[calibrate]\nfit = [\"rod\", \"radius\"]\noffsets = [\"motor\", \"place\"]\n"
    ));
    let (motor, gauge) = (3e-3, -4e-4);
    let shown: Vec<f64> = (0..24).map(|k| f64::from(k) * 0.25).collect();
    let real: Vec<Vec<f64>> = shown.iter().map(|x| vec![x + motor]).collect();
    let mut measured = readings(&plain, &[1e-3, 0.0, 3e-4], &real, &[0], 1e-5, &mut || 0.0);
    measured.postures = shown.iter().map(|x| vec![*x]).collect();
    measured.readings.iter_mut().for_each(|r| r.value += gauge);
    let found = fit(&model, &measured);
    assert_eq!((found.status, found.certainty.unidentifiable.len()), (Status::Found, 0));
    for (k, hidden) in [1e-3, 3e-4, motor, gauge].into_iter().enumerate() {
        let sigma = found.certainty.sigmas[k].unwrap();
        assert!(close(found.estimates[k], hidden, 1e-4, sigma), "{:?}", found.estimates);
    }
    // A prior of the gauge that is narrow keeps it, and the rod takes its place.
    let output = model.calibrating.as_ref().unwrap().offsets[1].of;
    assert!(matches!(output, OffsetSource::Output(_)));
    let mut narrow = request(&model, &measured);
    narrow.prior.offsets[1] = Offset { of: output, sigma: Some(1e-9) };
    let narrow = calibrated(&model, &narrow).unwrap();
    assert!(narrow.estimates[3].abs() < 1e-7 && (narrow.estimates[0] - 1e-3).abs() > 1e-5);
}

#[test]
fn an_offset_of_a_driver_that_counts_from_zero_follows_the_design() {
    // A leg between ground and a slider: its driven length is the distance.
    let text = r#"
name = "leg"
units = { length = "mm", angle = "deg" }
hardpoints = { O = [0, 0, 0], A = ["foot", 0, 0], B = [300, 0, 0] }
parameters.foot = { value = 20, unit = "length", design = true }
bodies = { slider = {} }
joints.slide = { type = "translational", bodies = ["ground", "slider"], at = "O", axis = "x" }
joints.leg = { type = "leg", bodies = ["ground", "slider"], at = ["A", "B"] }
drivers.motor = { joint = "leg", law = "280 + 20*t", counted_from = "zero" }
points.B = { body = "slider", at = "B" }
time = { end = 1.0, steps = 4 }
[calibrate]
offsets = ["motor"]
variables = { foot = 1 }
"#;
    let model = model_of(text);
    // x = foot + length + offset: the prior shares the deviation of 3 mm by the variances 1 and 4 mm^2.
    let mut measured = Measurements::default();
    for (posture, length) in [0.28, 0.3, 0.32].into_iter().enumerate() {
        measured.postures.push(vec![length]);
        measured.readings.push(Reading {
            posture,
            output: 0,
            value: 0.02 + length + 3e-3,
            sigma: Some(1e-6),
        });
    }
    let mut request = request(&model, &measured);
    request.prior.offsets[0].sigma = Some(2e-3);
    let found = calibrated(&model, &request).unwrap();
    for (estimate, expected) in found.estimates.iter().zip([0.6e-3, 2.4e-3]) {
        assert!(close(*estimate, expected, 1e-5, 1e-3), "{:?}", found.estimates);
    }
}

#[test]
fn stiffnesses_are_found_from_toe_and_camber_under_load() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../hardpoint-cli/templates/k-and-c.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let model = model_of(&text);
    let names = ["lca_rear_radial", "lca_rear_axial", "bar"];
    let fitted = names.map(|name| model.variable(name).unwrap());
    // N/mm and N m/deg, as in the file
    let hidden_by = [-700.0, 60.0, 3.0];
    let mut hidden = vec![0.0; model.variables.len()];
    fitted.iter().zip(hidden_by).for_each(|(v, by)| hidden[v.0] = by);
    let outputs = ["left.toe", "left.camber", "right.toe", "left_wheel_load"]
        .map(|name| model.measure(name).unwrap().0);
    // Readings come from the motions of the cases, not from postures.
    let mut measured = Measurements::default();
    let mut measure = |case: &str| {
        let laws = &model.cases[model.case(case).unwrap().0].force_laws;
        let moved = model.in_case(model.case(case).unwrap());
        let solution =
            Analysis::with(&moved, Formulation::Relative).unwrap().solve(hardpoint::Run::new().at(&hidden));
        assert!(solution.stop.is_none());
        let last = solution.motion.len() - 1;
        let posture = measured.postures.len();
        let at = |d: usize| moved.drivers[d].law.at(*moved.times.last().unwrap()).value();
        measured.postures.push((0..moved.drivers.len()).map(at).collect());
        let end = *moved.times.last().unwrap();
        measured.forces.push(laws.iter().map(|(e, law)| (*e, law.at(end).value())).collect());
        for output in outputs {
            let value = solution.measured.value(last, output)[0];
            let sigma = if output == outputs[3] { 1.0 } else { 1e-6 };
            measured.readings.push(Reading { posture, output, value, sigma: Some(sigma) });
        }
    };
    for case in ["lateral_in_phase", "aligning_out_of_phase", "braking", "opposite_travel"] {
        measure(case);
    }
    let request = Request { variables: fitted.to_vec(), ..request(&model, &measured) };
    let found = calibrated(&model, &request).unwrap_or_else(|e| panic!("{e:?}"));
    assert_eq!(
        (found.status, found.certainty.unidentifiable.len()),
        (Status::Found, 0),
        "{:?}",
        found.not_reached
    );
    for k in 0..3 {
        let sigma = found.certainty.sigmas[k].expect("stiffnesses are determined");
        println!("{}: {} +- {sigma}, hidden {}", names[k], found.estimates[k], hidden_by[k]);
        assert!(close(found.estimates[k], hidden_by[k], 1e-2, sigma), "{:?}", found.estimates);
        assert!(sigma < 0.1 * model.nominal_value(fitted[k]));
    }
}

#[test]
fn columns_of_forces_are_the_values_of_their_laws() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../hardpoint-cli/templates/k-and-c.toml");
    let file = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}"));
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("measured.csv");
    let read = |text: &str| {
        std::fs::write(&table, text).unwrap();
        file.measured(&table, &[])
    };
    let found = read("left_side,left.toe\n1000,0.1\n-500,0.2\n").unwrap_or_else(|e| panic!("{e}"));
    let element = |name: &str| ElementId(file.model.elements.iter().position(|e| e.name == name).unwrap());
    let forces = |value: f64| vec![(element("left_side"), value)];
    assert_eq!(found.measurements.forces, [forces(1000.0), forces(-500.0)]);
    for (name, title, cell, law) in [
        ("left_side", "left_side [N]", "-500", -500.0),
        ("left_side", "left_side [kN]", "-0.5", -500.0),
        ("left_side", "left_side [1]", "-500", -500.0),
        ("left_align", "left_align [N*mm]", "2000", 2.0),
        ("left_align", "left_align [kN m]", "0.002", 2.0),
    ] {
        let found = read(&format!("{title},left.toe\n{cell},0.1\n")).unwrap_or_else(|e| panic!("{e}"));
        let [(force, value)] = found.measurements.forces[0][..] else { panic!("{title}") };
        assert!(force == element(name) && (value - law).abs() < 1e-12, "{title}: {value}");
    }
    for (text, words) in [
        ("left_side [kPa],left.toe\n1,0.1\n", "`left_side` is in `kPa`, and the model file has N"),
        ("left_align [kN],left.toe\n1,0.1\n", "`left_align` is in `kN`, and the model file has N*m"),
        ("left_side,left.toe\n,0.1\n", "line 2, column 1 (`left_side`) is missing"),
        ("left_sid,left.toe\n1,0.1\n", "did you mean `left_side`?"),
        ("left_spring,left.toe\n1,0.1\n", "neither a driver, a force nor an output"),
    ] {
        let shown = read(text).unwrap_err().render(false);
        assert!(shown.contains(words), "{shown}");
    }
}

#[test]
fn forces_of_measurements_do_not_depend_on_the_magnitude_in_the_file() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../hardpoint-cli/templates/k-and-c.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("measured.csv");
    let read = |magnitude: &str, title: &str| {
        let text = text.replace("outboard = 1,", &format!("outboard = {magnitude},"));
        let file = parse(&text, "axle.toml").unwrap_or_else(|e| panic!("{e}"));
        std::fs::write(&table, format!("{title},left.toe\n1.5,0.1\n")).unwrap();
        file.measured(&table, &[]).map(|found| found.measurements.forces[0][0].1)
    };
    for (magnitude, title, law) in [
        ("1", "left_side [kN]", 1500.0),
        ("1000", "left_side [kN]", 1.5),
        ("1000", "left_side [N]", 0.0015),
        ("1000", "left_side [1]", 1.5),
        ("1", "left_side", 1.5),
    ] {
        let found = read(magnitude, title).unwrap_or_else(|e| panic!("{e}"));
        assert!((found - law).abs() < 1e-12 * law, "{magnitude} {title}: {found}");
    }
    // Newtons, or values of the law that multiplies 1 kN.
    for (magnitude, words) in [
        ("1000", "`left_side` has no unit, and its law multiplies 1000 N"),
        ("0", "`left_side` is zero in the model file"),
    ] {
        let shown = read(magnitude, "left_side").unwrap_err().render(false);
        assert!(shown.contains(words), "{shown}");
    }
}

#[test]
fn validation_data_agree_with_their_predicted_deviations() {
    let (model, measured, prior) = crank_with(&[(0, 1e-3), (1, 1e-3), (2, 1e-3)]);
    let postures: Vec<Vec<f64>> = (0..200).map(|k| vec![0.01 + f64::from(k) * 0.03]).collect();
    let other = readings(&model, &[1e-3, -5e-4, 3e-4], &postures, &[0], 2e-5, &mut noise(16));
    let overrides = Overrides { validation: Some(&other), ..Overrides::default() };
    let request = Request { prior, ..Request::of(&model, &measured, &overrides).unwrap() };
    let found = calibrated(&model, &request).unwrap();
    let validation = found.validation.unwrap();
    assert!(validation.not_reached.is_empty());
    let standard: Vec<f64> = validation
        .readings
        .iter()
        .zip(&other.readings)
        .map(|(v, r)| {
            let v = v.unwrap();
            let sigma = v.sigma.expect("all variables are determined");
            assert!(sigma >= 2e-5);
            (v.value - r.value) / sigma
        })
        .collect();
    let mean_square = standard.iter().map(|z| z * z).sum::<f64>() / 200.0;
    // Four standard deviations of 200 readings; those of the fit are common to all.
    assert!((mean_square - 1.0).abs() < 4.0 * (2.0_f64 / 200.0).sqrt(), "{mean_square}");
    let values = values_in_postures(&model, &found.design, &postures[..1], Formulation::Relative).unwrap();
    assert_eq!(validation.readings[0].unwrap().value, values[0].as_ref().unwrap()[0]);
    let same = Overrides { validation: Some(&measured), ..Overrides::default() };
    let error = Request::of(&model, &measured, &same).unwrap_err();
    assert_eq!(error.message, "the validation data are the fitted data");
}

#[test]
fn requests_check_their_priors() {
    let (model, measured, _) = crank_with(&[]);
    let of = |overrides: Overrides<'_>| Request::of(&model, &measured, &overrides).map(|r| r.prior);
    let prior = |sigma: f64| vec![(VariableId(0), sigma)];
    for sigma in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = of(Overrides { priors: prior(sigma), ..Overrides::default() }).unwrap_err();
        assert_eq!(error.message, "the standard deviation of the prior of `rod` is not positive");
    }
    let other = Overrides { priors: prior(1e-3), variables: vec!["radius".into()], ..Overrides::default() };
    assert_eq!(of(other).unwrap_err().message, "`rod` has a prior but is not fitted");
    let group = |members: &[usize], within: f64| Overrides {
        groups: vec![PriorGroup {
            name: "pair".into(),
            variables: members.iter().map(|v| VariableId(*v)).collect(),
            within,
        }],
        ..Overrides::default()
    };
    for (members, within, words) in [
        (&[0][..], 1e-4, "fewer than two different members"),
        (&[0, 0], 1e-4, "fewer than two different members"),
        (&[0, 2], 0.0, "is not positive"),
    ] {
        assert!(of(group(members, within)).unwrap_err().message.contains(words), "{words}");
    }
    let not_fitted = Overrides { variables: vec!["rod".into()], ..group(&[0, 2], 1e-4) };
    assert_eq!(of(not_fitted).unwrap_err().message, "`radius` of group `pair` is not fitted");
    assert_eq!(of(group(&[0, 2], 1e-4)).unwrap().groups.len(), 1);
    let offset = Overrides { offsets: vec!["moter".into()], ..Overrides::default() };
    assert_eq!(of(offset).unwrap_err().help, "did you mean `motor`?");
    let tolerances = Overrides { priors_from: Some("tolerances".into()), ..Overrides::default() };
    assert_eq!(
        of(tolerances.clone()).unwrap_err().message,
        "no fitted variable has a tolerance to make a prior of"
    );
    // A tolerance of three standard deviations; the prior of the file precedes it, and that of the caller both.
    let text = CRANK
        .replace("value = 300, unit = \"length\"", "value = 300, unit = \"length\", tolerance = 0.3")
        .replace("value = 100, unit = \"length\"", "value = 100, unit = \"length\", tolerance = 0.6");
    let model =
        model_of(&format!("{text}\n[calibrate]\nvariables = {{ radius = 0.5 }}\npriors = \"tolerances\"\n"));
    let found = Request::of(&model, &measured, &Overrides::default()).unwrap().prior.variables;
    let sigma = |v: usize| found.iter().find(|p| p.variable == VariableId(v)).map(|p| p.sigma);
    assert!(close(sigma(0).unwrap(), 1e-4, LINEAR, 1e-4) && close(sigma(2).unwrap(), 5e-4, LINEAR, 1e-4));
    assert_eq!(sigma(1), None);
    let own = Overrides { priors: vec![(VariableId(2), 7e-4)], ..Overrides::default() };
    let found = Request::of(&model, &measured, &own).unwrap().prior.variables;
    assert!(found.iter().any(|p| p.variable == VariableId(2) && p.sigma == 7e-4));
}

/// Number of hidden designs.
const SEEDS: u64 = 500;

#[test]
fn posterior_intervals_cover_hidden_stewart_platforms() {
    // Four joints of a Stewart platform anywhere within 1 mm, with the legs as they were: twelve coordinates. Six
    // readings in one posture determine five directions, and the other seven have priors only.
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/stewart.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let (start, end) = (text.find("# A leg whose end moves").unwrap(), text.find("[points]").unwrap());
    let joints = ["base_1", "top_1", "base_4", "top_5"];
    let joint = |of: &str| format!("{of} = {{ move = \"{of}\", along = \"xyz\", fixed_length = true }}\n");
    let design: String = joints.map(joint).concat();
    // The motion matters for proposed readings only.
    let text =
        format!("{}[design]\n{design}\n{}", &text[..start], &text[end..]).replace("steps = 120", "steps = 1");
    let model = model_of(&text);
    let n = model.variables.len();
    assert_eq!(n, 12);
    let postures = [vec![0.02, -0.03, 0.01, 0.04, 0.0, -0.02]];
    let measures = model.measures.len();
    let outputs: Vec<usize> = (measures..measures + 6).collect();
    let (sigma, prior_sigma) = (2e-5, 1e-3);
    let of = |k: usize| VariablePrior { variable: VariableId(k), mean: 0.0, sigma: prior_sigma };
    let prior = Prior { variables: (0..n).map(of).collect(), ..Prior::default() };
    let (mut errors, mut chis) = (Vec::new(), Vec::new());
    for seed in 0..SEEDS {
        let mut noise = noise(seed);
        let hidden: Vec<f64> = (0..n).map(|_| prior_sigma * noise()).collect();
        let measured = readings(&model, &hidden, &postures, &outputs, sigma, &mut noise);
        let request = Request { prior: prior.clone(), loss: Loss::Squares, ..request(&model, &measured) };
        let found = calibrated(&model, &request).unwrap_or_else(|e| panic!("{e:?}"));
        let certainty = &found.certainty;
        assert_eq!((found.status, certainty.unidentifiable.len()), (Status::Found, 0));
        assert!(certainty.by_prior.len() >= 7, "seed {seed}");
        let off: Vec<f64> = found.design.iter().zip(&hidden).map(|(a, b)| a - b).collect();
        errors.extend(off.iter().zip(&certainty.sigmas).map(|(e, s)| e / s.unwrap()));
        chis.push(mahalanobis(&certainty.covariance, &off));
    }
    assert_covered("stewart with priors", n, (errors, chis));
}

#[test]
fn a_group_of_variables_with_own_priors_adds_no_degrees_of_freedom() {
    let own = linear_priors(1.0).replace("[calibrate.groups.pair]", "b = 0.5\n[calibrate.groups.pair]");
    for (priors, independent) in [(linear_priors(1.0), 3), (own, 3)] {
        let model = linear("mm", 1.0, ["a", "b", "c"], &priors);
        let measured = linear_readings(&model);
        let found = fit(&model, &measured);
        // n readings and p independent priors determine three variables.
        assert_eq!(found.certainty.freedom, measured.readings.len() + independent - 3, "{priors}");
    }
}

#[test]
fn the_standard_deviation_along_an_oblique_direction_is_that_of_the_prior() {
    // x = a + 2 b - c and y = b + c are read, and a is known before: with a, b follows by -1/3 and c by 1/3.
    const PRIOR: f64 = 1e-6;
    let model = linear("mm", 1.0, ["a", "b", "c"], "[calibrate.variables]\na = 1e-3");
    let postures: Vec<Vec<f64>> = (0..4).map(|k| vec![f64::from(k) * 1e-3]).collect();
    let measured = readings(&model, &[0.0; 3], &postures, &[0, 1], 1e-4, &mut || 0.0);
    let found = fit(&model, &measured);
    let [change] = &found.certainty.by_prior[..] else { panic!("{:?}", found.certainty.by_prior) };
    let [a, b, c] = change.direction[..] else { panic!("{change:?}") };
    assert!(close(b, -a / 3.0, ENDED, a.abs()) && close(c, a / 3.0, ENDED, a.abs()), "{change:?}");
    assert!(close(change.sigma.unwrap() * a.abs(), PRIOR, ENDED, PRIOR), "{change:?}");
}

#[test]
fn readings_that_depend_on_undetermined_changes_have_no_prediction() {
    // One reading does not determine the three lengths.
    let model = model_of(CRANK);
    let at = |angle: f64, noise: f64| {
        readings(&model, &[1e-3, 0.0, 0.0], &[vec![angle]], &[0], 1e-5, &mut || noise)
    };
    let measured = at(0.3, 0.0);
    for (angle, predicted) in [(0.3, Some(2.0_f64.sqrt() * 1e-5)), (0.9, None)] {
        let other = at(angle, 0.1);
        let overrides = Overrides { validation: Some(&other), ..Overrides::default() };
        let found = calibrated(&model, &Request::of(&model, &measured, &overrides).unwrap()).unwrap();
        assert_eq!(found.certainty.unidentifiable.len(), 2);
        let sigma = found.validation.unwrap().readings[0].unwrap().sigma;
        assert_eq!(sigma.is_some(), predicted.is_some(), "{angle}: {sigma:?}");
        assert!(sigma.zip(predicted).is_none_or(|(a, b)| close(a, b, ENDED, b)), "{angle}: {sigma:?}");
    }
}
