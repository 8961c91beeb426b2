//! Calibration: compared with the normal equations, with known designs over many seeds, and with fits that include the
//! proposed readings.

use std::num::NonZero;
use std::ops::ControlFlow;
use std::path::Path;

use hardpoint::measure::outputs;
use hardpoint::model::{CaseId, Measurements, Reading};
use hardpoint::model::{Model, Scatter, VariableId};
use hardpoint::run::{Analysis, Run};
use hardpoint::topology::Formulation;
use hardpoint_file::parse;
use hardpoint_study::calibrate::{
    Calibration, Certainty, Error, Loss, Prior, Request, Status, calibrate, values_in_postures,
};
use hardpoint_study::{Control, design_stream, draw};

/// A slider-crank: `x = r cos a + sqrt(l^2 - (r sin a - e)^2)`.
pub(crate) const CRANK: &str = r#"
name = "slider-crank"
units = { length = "mm", angle = "deg" }
parameters.rod = { value = 300, unit = "length", design = true }
parameters.offset = { value = 20, unit = "length", design = true }
parameters.radius = { value = 100, unit = "length", design = true }
hardpoints = { O = [0, 0, 0], A = ["radius*cos(40*pi/180)", "radius*sin(40*pi/180)", 0], B = [300, "offset", 0] }
bodies = { crank = {}, slider = {} }
joints.pivot = { type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "z" }
joints.slide = { type = "translational", bodies = ["ground", "slider"], at = "B", axis = "x" }
joints.rod = { type = "distance", bodies = ["crank", "slider"], at = ["A", "B"], length = "rod" }
drivers.motor = { joint = "pivot", law = "20*t" }
measures.place = { type = "position", point = "B", along = "x" }
points.B = { body = "slider", at = "B" }
time = { end = 1.0, steps = 10 }
"#;

/// The closed form, m, with the crank so far from the drawing, rad.
fn place([rod, offset, radius]: [f64; 3], crank: f64) -> f64 {
    let a = crank + 40_f64.to_radians();
    radius * a.cos() + (rod * rod - (radius * a.sin() - offset).powi(2)).sqrt()
}

fn gallery(name: &str) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../models/{name}.toml"));
    hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}")).model
}

pub(crate) fn crank() -> Model {
    parse(CRANK, "crank.toml").unwrap_or_else(|e| panic!("{e}")).model
}

fn all(model: &Model) -> Vec<VariableId> {
    (0..model.variables.len()).map(VariableId).collect()
}

fn fitted_by(
    model: &Model,
    measured: &Measurements,
    variables: &[VariableId],
    loss: Loss,
) -> Result<Calibration, Error> {
    let variables = variables.to_vec();
    let request = Request {
        measured,
        validation: None,
        variables,
        prior: Prior::default(),
        keep_bounds: false,
        loss,
        formulation: Formulation::Relative,
        iterations: 50,
    };
    calibrated(model, &request)
}

pub(crate) fn calibrated(model: &Model, request: &Request<'_>) -> Result<Calibration, Error> {
    let control = Control {
        threads: NonZero::<usize>::MIN,
        progress: &mut |_| ControlFlow::Continue(()),
        more: &|| true,
    };
    calibrate(model, request, control)
}

fn fitted(model: &Model, measured: &Measurements) -> Calibration {
    fitted_by(model, measured, &all(model), Loss::Squares).unwrap_or_else(|e| panic!("{e:?}"))
}

/// Numbers of the standard normal distribution.
pub(crate) fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut stream = design_stream(seed, 1);
    move || {
        let mut one = [0.0];
        draw(Scatter::Normal { sigmas: 1.0 }, 1.0, &mut stream, &mut one);
        one[0]
    }
}

/// Readings of some outputs of a hidden design, with noise of standard deviation `sigma`, m or rad.
pub(crate) fn readings(
    model: &Model,
    hidden: &[f64],
    postures: &[Vec<f64>],
    outputs: &[usize],
    sigma: f64,
    noise: &mut impl FnMut() -> f64,
) -> Measurements {
    let values = values_in_postures(model, hidden, postures, Formulation::Relative).unwrap();
    let mut measured = Measurements { postures: postures.to_vec(), ..Measurements::default() };
    for (posture, values) in values.iter().enumerate() {
        let values = values.as_ref().unwrap_or_else(|why| panic!("{why}"));
        for &output in outputs {
            let value = values[output] + sigma * noise();
            measured.readings.push(Reading { posture, output, value, sigma: Some(sigma) });
        }
    }
    measured
}

#[test]
fn the_fit_of_a_slider_crank_is_that_of_its_closed_form() {
    let model = crank();
    let hidden = [0.301, 0.0195, 0.1004];
    let sigma = 2e-5;
    let mut noise = noise(3);
    let cranks: Vec<f64> = (0..24).map(|k| f64::from(k) * 0.25).collect();
    let mut measured = Measurements::default();
    for (posture, crank) in cranks.iter().enumerate() {
        measured.postures.push(vec![*crank]);
        let value = place(hidden, *crank) + sigma * noise();
        measured.readings.push(Reading { posture, output: 0, value, sigma: Some(sigma) });
    }
    let found = fitted(&model, &measured);
    assert_eq!(found.status, Status::Found);
    let drawn = [0.3, 0.02, 0.1];
    let values: Vec<f64> = (0..3).map(|k| drawn[k] + found.design[k]).collect();
    // The gradient of the sum of squares of the closed form is nothing there, and the covariance is that of its normal
    // equations.
    let at = |b: [f64; 3]| cranks.iter().map(|a| place(b, *a)).collect::<Vec<_>>();
    let b = [values[0], values[1], values[2]];
    let step = 1e-6;
    let columns: Vec<Vec<f64>> = (0..3)
        .map(|k| {
            let moved = |by: f64| at(std::array::from_fn(|i| b[i] + if i == k { by } else { 0.0 }));
            moved(step).iter().zip(moved(-step)).map(|(p, m)| (p - m) / (2.0 * step * sigma)).collect()
        })
        .collect();
    let residuals: Vec<f64> =
        at(b).iter().zip(&measured.readings).map(|(x, r)| (x - r.value) / sigma).collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    for column in &columns {
        let cosine = dot(column, &residuals) / (dot(column, column) * dot(&residuals, &residuals)).sqrt();
        /// Differences of the closed form are as exact as this.
        const STATIONARY: f64 = 1e-7;
        assert!(cosine.abs() < STATIONARY, "{cosine}");
    }
    for i in 0..3 {
        for j in 0..3 {
            // (J' J) C = 1
            let product: f64 =
                (0..3).map(|k| dot(&columns[i], &columns[k]) * found.certainty.covariance[k][j]).sum();
            assert!((product - f64::from(u8::from(i == j))).abs() < 1e-5, "{i} {j}: {product}");
        }
    }
    assert_eq!(found.certainty.freedom, 21);
    let chi: f64 = residuals.iter().map(|r| r * r).sum();
    assert!((found.certainty.chi_square - chi).abs() < 1e-6 * chi);
    for k in 0..3 {
        let off = (values[k] - hidden[k]).abs() / found.certainty.sigmas[k].unwrap();
        assert!(off < 3.5, "variable {k}: {off} standard deviations");
    }
}

#[test]
fn nothing_depends_on_the_order_of_postures_and_readings() {
    let model = crank();
    let postures: Vec<Vec<f64>> = (0..9).map(|k| vec![f64::from(k) * 0.6]).collect();
    let mut noise = noise(5);
    let measured = readings(&model, &[1e-3, -5e-4, 3e-4], &postures, &[0], 1e-5, &mut noise);
    let one = fitted(&model, &measured);
    let mut other = measured.clone();
    other.postures.reverse();
    other.readings.reverse();
    other.readings.iter_mut().for_each(|r| r.posture = 8 - r.posture);
    other.readings.rotate_left(4);
    let other = fitted(&model, &other);
    for k in 0..3 {
        assert!((one.design[k] - other.design[k]).abs() < 1e-9, "{:?} {:?}", one.design, other.design);
        let [a, b] = [&one, &other].map(|c| c.certainty.sigmas[k].unwrap());
        assert!((a - b).abs() < 1e-7 * a);
    }
}

#[test]
fn undetermined_changes_are_listed_and_stay_nominal() {
    // In one posture nothing but one sum of the three is reported; of a rod between two points that both move along it,
    // their difference.
    let model = crank();
    let measured = readings(&model, &[1e-3, 0.0, 0.0], &[vec![0.3]], &[0], 1e-5, &mut || 0.0);
    let found = fitted(&model, &measured);
    assert_eq!((found.certainty.unidentifiable.len(), found.status), (2, Status::Found));
    assert!(found.certainty.sigmas.iter().all(Option::is_none));
    assert!(found.objective[1] < 1e-12, "{:?}", found.objective);
    // To first order no untold direction changes what was read.
    for untold in &found.certainty.unidentifiable {
        let change =
            |by: f64| -> Vec<f64> { (0..3).map(|k| found.design[k] + by * untold.direction[k]).collect() };
        let value = |by: f64| {
            values_in_postures(&model, &change(by), &[vec![0.3]], Formulation::Relative).unwrap()[0]
                .as_ref()
                .unwrap()[0]
        };
        let slope = (value(1e-6) - value(-1e-6)) / 2e-6;
        let size = untold.direction.iter().map(|x| x.abs()).fold(0.0, f64::max);
        assert!(slope.abs() < 1e-6 * size, "{slope}");
    }
    // And a reading that indicates them comes first among those proposed.
    assert!(found.next[0].determines.is_some(), "{:?}", found.next);
}

/// A trailing arm on one bushing.
const ARM: &str = r#"
name = "trailing arm"
units = { length = "mm", angle = "deg" }
parameters.kx = { value = 4200, design = true }
parameters.kz = { value = 1200, design = true }
parameters.kc = { value = 1.4, design = true }
hardpoints = { pv = [400, 600, 50], w = [0, 740, 0] }
bodies.arm = {}
equilibrium = {}
time = { end = 1, steps = 2 }
[forces]
bush = { type = "bushing", from = { body = "ground", at = "pv" }, to = { body = "arm", at = "pv" }, axis = "y", axis2 = "x", x = "kx", y = 3000, z = "kz", about_x = 200, about_y = 300, about_z = "kc", cubic_x = 100, curve_z = [[-2, -900], [-1, -200], [0, 0], [1, 200], [2, 900]] }
sp = { type = "spring", from = { body = "ground", at = [50, 650, 400] }, to = { body = "arm", at = [60, 660, 30] }, stiffness = 40, preload = -3000 }
road = { type = "wheel_force", wheel = "W", outboard = 1, law = "0" }
brk = { type = "wheel_force", wheel = "W", forward = -1, law = "0" }
[wheels.W]
body = "arm"
centre = "w"
toe = 0
camber = -1
radius = 300
measures = ["toe", "half_track"]
"#;
/// Readings of it with kx = 5000 N/mm, kz = 900 N/mm and kc = 2 N m/deg, with noise of 0.01 deg and 0.05 mm.
const ARM_READINGS: &str = "\
road [kN],brk [N],W.toe [mrad],W.half_track [mm]
0,0,-3.48459,745.0403
0.2,0,0.69063,750.0769
0.4,0,4.86572,755.2574
0.6,0,9.24223,760.3161
0.8,0,13.80484,765.5164
1,0,18.19815,770.5745
0,0,-3.70855,744.9646
0,300,-5.81785,743.3283
0,600,-7.38823,741.8058
0,900,-9.33747,740.1093
0,1200,-11.12272,738.5967
0,1500,-13.17796,737.0745
0,0,-3.67135,745.0190
-0.16,300,-8.97675,739.2855
-0.32,600,-14.76891,733.8450
-0.48,900,-20.12771,728.6105
-0.64,1200,-25.73310,723.5691
-0.8,1500,-31.46940,718.6378
";

#[test]
fn the_fit_does_not_follow_changes_that_are_not_determined() {
    let file = parse(ARM, "arm.toml").unwrap_or_else(|e| panic!("{e}"));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arm.csv");
    std::fs::write(&path, ARM_READINGS).unwrap();
    let sigmas = [("W.toe".into(), 0.01), ("W.half_track".into(), 0.05)];
    let measured = file.measured(&path, &sigmas).unwrap_or_else(|e| panic!("{e}")).measurements;
    let [kx, kz, kc] = ["kx", "kz", "kc"].map(|name| file.model.variable(name).unwrap());
    let found = fitted_by(&file.model, &measured, &[kx, kz, kc], Loss::Squares).unwrap();
    let fixed = fitted_by(&file.model, &measured, &[kz, kc], Loss::Squares).unwrap();
    assert_eq!((found.status, found.certainty.unidentifiable.len()), (Status::Found, 1));
    assert!(found.cost.designs <= MOST_DESIGNS, "{:?}", found.cost);
    // The stiffness without effect remains nominal; the fit is that of the two others.
    let nominal = file.model.nominal_value(kx);
    assert!(found.estimates[0].abs() < 1e-2 * nominal, "{:?}", found.estimates);
    assert!((found.objective[1] - fixed.objective[1]).abs() < 0.01, "{:?}", found.objective);
    assert_eq!(found.certainty.sigmas[0], None);
    for k in 0..2 {
        let [sigma, of_fixed] =
            [found.certainty.sigmas[k + 1], fixed.certainty.sigmas[k]].map(Option::unwrap);
        assert!(sigma > 0.99 * of_fixed && sigma < 1.5 * of_fixed, "{sigma} {of_fixed}");
        assert!((found.estimates[k + 1] - fixed.estimates[k]).abs() < 0.5 * of_fixed);
    }
}

#[test]
fn readings_that_contradict_the_nominal_design_are_followed() {
    // At its nominal stiffness the joint hardly moves, so that readings determine the stiffness by no more than itself.
    let stiff = parse(&LEVER.replace("kx = { value = 300", "kx = { value = 9000"), "stiff.toml");
    let model = stiff.unwrap_or_else(|e| panic!("{e}")).model;
    let (soft, sigma) = (parse(LEVER, "lever.toml").unwrap_or_else(|e| panic!("{e}")).model, 1e-5);
    let tip = outputs(&model).iter().position(|output| output.name == "tip.x").unwrap();
    let moved = soft.in_case(CaseId(0));
    let solution = Analysis::with(&moved, Formulation::Relative).unwrap().run();
    let mut measured = Measurements::default();
    for (k, t) in moved.times.iter().enumerate() {
        measured.postures.push(Vec::new());
        let laws = &soft.cases[0].force_laws;
        measured.forces.push(laws.iter().map(|(e, law)| (*e, law.at(*t).value())).collect());
        let value = solution.measured.value(k, tip)[0];
        measured.readings.push(Reading { posture: k, output: tip, value, sigma: Some(sigma) });
    }
    let found = fitted_by(&model, &measured, &[model.variable("kx").unwrap()], Loss::Squares).unwrap();
    assert_eq!((found.status, found.certainty.unidentifiable.len()), (Status::Found, 0));
    let [nominal, hidden] = [&model, &soft].map(|m| m.nominal_value(m.variable("kx").unwrap()));
    assert!((nominal + found.estimates[0] - hidden).abs() < 1e-6 * hidden, "{:?}", found.estimates);
}

#[test]
fn a_robust_loss_resists_outliers() {
    let model = crank();
    let postures: Vec<Vec<f64>> = (0..30).map(|k| vec![f64::from(k) * 0.2]).collect();
    let hidden = [1e-3, -5e-4, 3e-4];
    let mut noise = noise(7);
    let mut measured = readings(&model, &hidden, &postures, &[0], 1e-5, &mut noise);
    for k in [3, 11, 20, 26] {
        measured.readings[k].value += 2e-3;
    }
    let worst = |c: &Calibration| (0..3).map(|k| (c.design[k] - hidden[k]).abs()).fold(0.0, f64::max);
    let squares = fitted(&model, &measured);
    let [huber, cauchy] = [Loss::Huber, Loss::Cauchy]
        .map(|loss| fitted_by(&model, &measured, &all(&model), loss).unwrap_or_else(|e| panic!("{e:?}")));
    assert!(worst(&squares) > 2e-4, "{}", worst(&squares));
    assert!(worst(&huber) < 4e-5, "{}", worst(&huber));
    assert!(worst(&cauchy) < 4e-5, "{}", worst(&cauchy));
    // Those far off are known by what they count.
    let light: Vec<usize> = (0..30).filter(|k| cauchy.fitted[*k].unwrap().weight < 0.01).collect();
    assert_eq!(light, [3, 11, 20, 26]);
    assert_eq!((huber.status, cauchy.status), (Status::Found, Status::Found));
}

/// Carriage that is read at a point whose place along the slide is unknown.
const SLIDE: &str = r#"
name = "slide"
units = { length = "mm", angle = "deg" }
hardpoints = { O = [0, 0, 0], P = [10, 0, 0] }
bodies = { carriage = {} }
joints.s = { type = "translational", bodies = ["ground", "carriage"], at = "O", axis = "x" }
drivers.d = { joint = "s", law = "t" }
points.P = { body = "carriage", at = "P" }
design.off = { move = "P", along = "x" }
time = { end = 1, steps = 2 }
"#;

#[test]
fn a_robust_loss_scales_by_the_median_of_an_even_number_of_residuals() {
    let file = parse(SLIDE, "slide.toml").unwrap_or_else(|e| panic!("{e}"));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("four.csv");
    std::fs::write(&path, "d,P.x\n0,10.0\n1,11.1\n2,12.2\n3,14.0\n").unwrap();
    let measured = file.measured(&path, &[]).unwrap_or_else(|e| panic!("{e}")).measurements;
    let found = fitted_by(&file.model, &measured, &all(&file.model), Loss::Huber).unwrap();
    // Weighted means of 0, 0.1, 0.2 and 1 mm, iterated elsewhere with s = median |r| / 0.6745; sigma = s / sqrt(sum w).
    assert!((found.estimates[0] - 0.199_115_696e-3).abs() < 1e-9, "{:?}", found.estimates);
    assert!(
        (found.certainty.sigmas[0].unwrap() - 0.120_404_971e-3).abs() < 1e-9,
        "{:?}",
        found.certainty.sigmas
    );
}

#[test]
fn units_of_titles_are_converted_or_rejected() {
    let file = parse(SLIDE, "slide.toml").unwrap_or_else(|e| panic!("{e}"));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("read.csv");
    let read = |text: &str| {
        std::fs::write(&path, text).unwrap();
        file.measured(&path, &[]).map(|data| data.measurements)
    };
    let own = read("d,P.x,sigma P.x\n20,30.5,0.1\n").unwrap();
    for text in [
        "d [cm],P.x [m],sigma P.x\n2,0.0305,0.0001\n",
        "d [cm],P.x [m],sigma P.x [mm]\n2,0.0305,0.1\n",
        "d,P.x,sigma P.x\ncm,m,-\n2,0.0305,0.0001\n",
    ] {
        let other = read(text).unwrap_or_else(|e| panic!("{e}"));
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-15, "{text}: {a} {b}");
        near(other.postures[0][0], own.postures[0][0]);
        near(other.readings[0].value, own.readings[0].value);
        near(other.readings[0].sigma.unwrap(), own.readings[0].sigma.unwrap());
    }
    for (text, words) in [
        ("d [deg],P.x\n2,30\n", "`d` is in `deg`, and it is a length"),
        ("d,P.x [banana]\n2,30\n", "`P.x` is in `banana`, and it is a length"),
    ] {
        let error = read(text).expect_err(text);
        assert_eq!(error.list()[0].code, "HP0248");
        assert!(error.render(false).contains(words), "{error}");
    }
}

#[test]
fn a_proposed_reading_has_the_predicted_effect() {
    let model = crank();
    let postures: Vec<Vec<f64>> = (0..6).map(|k| vec![f64::from(k) * 0.1]).collect();
    let hidden = [1e-3, -5e-4, 3e-4];
    let measured = readings(&model, &hidden, &postures, &[0], 1e-5, &mut || 0.0);
    let found = fitted(&model, &measured);
    let next = &found.next[0];
    let improves = next.improves.expect("all three are reported");
    let mut more = measured.clone();
    more.postures.push(next.drivers.clone());
    let value =
        values_in_postures(&model, &hidden, std::slice::from_ref(&next.drivers), Formulation::Relative)
            .unwrap();
    let value = value[0].as_ref().unwrap()[next.output];
    more.readings.push(Reading { posture: 6, output: next.output, value, sigma: Some(next.sigma) });
    let with = fitted(&model, &more);
    let [before, after] = [&found, &with].map(|c| c.certainty.sigmas[improves.variable].unwrap());
    assert!((before - improves.before).abs() < 1e-6 * before);
    assert!((after - improves.after).abs() < 1e-4 * after, "{after} instead of {}", improves.after);
    assert!(after < 0.9 * before);
}

#[test]
fn without_standard_deviations_they_come_from_the_residuals() {
    let model = crank();
    let postures: Vec<Vec<f64>> = (0..40).map(|k| vec![f64::from(k) * 0.15]).collect();
    let mut noise = noise(9);
    let mut measured = readings(&model, &[1e-3, 0.0, 0.0], &postures, &[0], 2e-5, &mut noise);
    let given = fitted(&model, &measured);
    measured.readings.iter_mut().for_each(|r| r.sigma = None);
    let found = fitted(&model, &measured);
    let scatter = found.certainty.scatter.unwrap();
    // Of 37 degrees of freedom, within four standard deviations of its own.
    assert!((scatter / 2e-5 - 1.0).abs() < 4.0 / (2.0 * 37.0_f64).sqrt(), "{scatter}");
    for k in 0..3 {
        assert!((found.design[k] - given.design[k]).abs() < 1e-9);
        let [a, b] = [&found, &given].map(|c| c.certainty.sigmas[k].unwrap());
        assert!((a / b - scatter / 2e-5).abs() < 1e-6);
    }
    measured.readings.truncate(3);
    let few = fitted_by(&model, &measured, &all(&model), Loss::Squares);
    let Err(Error::Request(error)) = few else { panic!("{few:?}") };
    let message = "3 readings without standard deviations do not determine 3 variables and their accuracy";
    assert_eq!(error.message, message);
}

/// Three readings of `a + b`, `a - b` and `b`, of which a is at its bound of 1 mm: as with a fixed there, b is the mean
/// of 2.1, 1.2 and 1.9 mm, and the two degrees of freedom leave `sqrt(F / 2 / 3)` as its standard deviation.
#[test]
fn a_parameter_at_its_bound_takes_no_reading() {
    let text = |value: &str| {
        format!(
            r#"
name = "bound"
units = {{ length = "mm", angle = "deg" }}
parameters.a = {{ value = {value}, unit = "length", bounds = [-1, 1], design = true }}
parameters.b = {{ value = 0, unit = "length", design = true }}
hardpoints = {{ h1 = ["a + b", 0, 10], h2 = ["a - b", 0, 20], h3 = ["b", 0, 30] }}
bodies.s = {{}}
joints.g = {{ type = "translational", bodies = ["ground", "s"], at = [0, 0, 0], axis = "x" }}
drivers.d = {{ joint = "g", law = "t" }}
measures.y1 = {{ type = "position", point = {{ body = "s", at = "h1" }}, along = "x" }}
measures.y2 = {{ type = "position", point = {{ body = "s", at = "h2" }}, along = "x" }}
measures.y3 = {{ type = "position", point = {{ body = "s", at = "h3" }}, along = "x" }}
time = {{ end = 1, steps = 1 }}
"#
        )
    };
    let values = [3.1e-3, -0.2e-3, 1.9e-3];
    let readings = values.iter().enumerate();
    let readings = readings.map(|(output, value)| Reading { posture: 0, output, value: *value, sigma: None });
    let measured =
        Measurements { postures: vec![vec![0.0]], readings: readings.collect(), ..Measurements::default() };
    let scatter = (0.446_666_666_666_666_7_f64 / 2.0).sqrt() * 1e-3;
    // From the bound as well as from within.
    for value in ["0", "1"] {
        let model = parse(&text(value), "bound.toml").unwrap_or_else(|e| panic!("{e}")).model;
        let request = Request {
            measured: &measured,
            validation: None,
            variables: all(&model),
            prior: Prior::default(),
            keep_bounds: true,
            loss: Loss::Squares,
            formulation: Formulation::Relative,
            iterations: 50,
        };
        let found = calibrated(&model, &request).unwrap_or_else(|e| panic!("{e:?}"));
        let near = |x: f64, expected: f64| assert!((x - expected).abs() < 1e-9 * expected, "{x} {expected}");
        near(found.estimates[1], 5.2e-3 / 3.0);
        let Certainty { sigmas, freedom, scatter: residual, .. } = &found.certainty;
        assert_eq!((*freedom, sigmas[0]), (2, None));
        near(residual.unwrap(), scatter);
        near(sigmas[1].unwrap(), scatter / 3.0_f64.sqrt());
        // Residuals are in estimated standard deviations, and so is the objective: F / sigma^2.
        near(found.objective[1], 2.0);
    }
}

#[test]
fn readings_without_noise_take_no_more_designs() {
    let model = gallery("five_link");
    let variables = ["tie_rod_inner_z", "camber_rod_inner_z"].map(|name| model.variable(name).unwrap());
    let postures: Vec<Vec<f64>> = (-5..=5).map(|k| vec![f64::from(k) * 0.01]).collect();
    let outputs = ["toe", "camber"].map(|name| model.measure(name).unwrap().0);
    let mut hidden = vec![0.0; model.variables.len()];
    hidden[variables[0].0] = 2e-3;
    for sigma in [1e-5, 1e-2] {
        let measured = readings(&model, &hidden, &postures, &outputs, sigma, &mut || 0.0);
        let found = fitted_by(&model, &measured, &variables, Loss::Squares).unwrap();
        assert_eq!(found.status, Status::Found);
        assert!(found.cost.designs <= MOST_DESIGNS, "{:?}", found.cost);
        for v in variables {
            // Round-off of the solved readings.
            assert!((found.design[v.0] - hidden[v.0]).abs() < 1e-10, "{:?}", found.design);
        }
    }
}

/// A lever on an elastic joint, held by a spring, under two forces: an equilibrium.
const LEVER: &str = r#"
name = "lever"
units = { length = "mm", angle = "deg" }
hardpoints = { A = [0, 0, 0], B = [300, 20, 0], S = [150, 200, 30] }
bodies.arm = {}
points.tip = { body = "arm", at = "B" }
joints.j = { type = "spherical", bodies = ["ground", "arm"], at = "A", axis = "z", axis2 = "x" }
equilibrium = {}
[parameters]
kx = { value = 300, design = true }
ky = { value = 250, design = true }
kt = { value = 4, design = true }
pre = { value = 0, design = true }
[forces]
e = { type = "elastic_joint", joint = "j", x = "kx", y = "ky", z = 700, about_x = 9, about_y = 8, about_z = "kt" }
s = { type = "spring", from = { body = "ground", at = "S" }, to = { body = "arm", at = [150, 10, 0] }, stiffness = 6, preload = "pre" }
side = { type = "force", at = "tip", force = 1, along = [0.2, -1, 0.1], law = "0" }
up = { type = "force", at = "tip", force = 300, along = "z", law = "0" }
[cases.a]
laws = { side = "200*t" }
time = { end = 1, steps = 4 }
[cases.b]
laws = { side = "-150*t", up = "t" }
time = { end = 1, steps = 4 }
"#;

#[test]
fn a_lever_whose_preload_is_zero_is_found_in_few_designs() {
    let model = parse(LEVER, "lever.toml").unwrap_or_else(|e| panic!("{e}")).model;
    let mut hidden = vec![0.0; model.variables.len()];
    // N/mm, N m/deg and N, as in the file: relative to the nominal values.
    for (name, by) in [("kx", 60.0), ("ky", -28.0), ("kt", 0.6), ("pre", 60.0)] {
        hidden[model.variable(name).unwrap().0] = by;
    }
    let tip: Vec<usize> = outputs(&model)
        .iter()
        .enumerate()
        .filter(|(_, output)| output.name.starts_with("tip."))
        .map(|(column, _)| column)
        .collect();
    assert_eq!(tip.len(), 3);
    // Readings with all digits, and with those of a table in nanometres: both are far below any measurement. They come
    // from the motions of the cases, not from postures.
    for digit in [None, Some(1e-9)] {
        let mut measured = Measurements::default();
        for case in 0..model.cases.len() {
            let moved = model.in_case(CaseId(case));
            let solution =
                Analysis::with(&moved, Formulation::Relative).unwrap().solve(Run::new().at(&hidden));
            assert!(solution.stop.is_none());
            for (k, t) in moved.times.iter().enumerate() {
                let posture = measured.postures.len();
                measured.postures.push(Vec::new());
                let laws = &model.cases[case].force_laws;
                measured.forces.push(laws.iter().map(|(e, law)| (*e, law.at(*t).value())).collect());
                for &output in &tip {
                    let value = solution.measured.value(k, output)[0];
                    let value = digit.map_or(value, |digit: f64| (value / digit).round() * digit);
                    measured.readings.push(Reading { posture, output, value, sigma: None });
                }
            }
        }
        let found = fitted(&model, &measured);
        assert_eq!(found.status, Status::Found);
        // Steps of the preload are those that move the readings, since it has no nominal value.
        assert!(found.cost.designs <= 25, "{digit:?}: {:?}", found.cost);
        let allowed = digit.map_or(1e-7, |digit| 1e6 * digit);
        for v in all(&model) {
            let (found, hidden) = (found.design[v.0], hidden[v.0]);
            assert!((found - hidden).abs() < allowed * hidden.abs(), "{digit:?}: {found} {hidden}");
        }
    }
}

#[test]
fn a_posture_out_of_reach_is_left_out_and_reported() {
    let model = crank();
    let text = CRANK
        .replace("value = 300, unit", "value = 70, unit")
        .replace("[300, \"offset\"", "[150, \"offset\"");
    let short = parse(&text, "short.toml").unwrap_or_else(|e| panic!("{e}")).model;
    let postures = [vec![0.1], vec![0.2], vec![1.2], vec![0.05]];
    let mut measured = Measurements { postures: postures.to_vec(), ..Measurements::default() };
    for posture in 0..4 {
        measured.readings.push(Reading { posture, output: 0, value: 0.15, sigma: Some(1e-3) });
    }
    let found = fitted_by(&short, &measured, &all(&short)[..1], Loss::Squares).unwrap();
    assert_eq!(found.not_reached.len(), 1);
    assert!(
        found.not_reached[0].posture == 2
            && found.not_reached[0].why == "the mechanism reaches a limit position",
        "{:?}",
        found.not_reached
    );
    // The path ends where the rod is perpendicular to the slide: r sin a = e + l. The crank is drawn at 40 deg.
    let last = found.not_reached[0].last.as_ref().unwrap()[0];
    assert!((last - (0.9_f64.asin() - 40.0_f64.to_radians())).abs() < 1e-3, "{last}");
    assert!(found.fitted[2].is_none() && found.fitted[3].is_some());
    assert!(fitted_by(&model, &measured, &[], Loss::Squares).is_err());
}

/// Number of seeds.
const SEEDS: u64 = 100;
/// The same of fits with many variables, which take long.
const SEEDS_OF_MANY: u64 = 30;
/// Designs of a fit whose start is so near that undamped steps lead to it: each is a thousandth of the one before.
const MOST_DESIGNS: usize = 10;

/// A hidden design, drawn anew for every seed: fits over all seeds, as errors in standard deviations and as chi squares
/// of the error.
fn recovered(
    model: &Model,
    variables: &[VariableId],
    postures: &[Vec<f64>],
    outputs: &[usize],
    [sigma, hidden_by]: [f64; 2],
    seeds: u64,
) -> (Vec<f64>, Vec<f64>) {
    let (mut errors, mut chis) = (Vec::new(), Vec::new());
    for seed in 0..seeds {
        let mut noise = noise(seed);
        let mut hidden = vec![0.0; model.variables.len()];
        variables.iter().for_each(|v| hidden[v.0] = hidden_by * noise());
        let measured = readings(model, &hidden, postures, outputs, sigma, &mut noise);
        let found = fitted_by(model, &measured, variables, Loss::Squares).unwrap_or_else(|e| panic!("{e:?}"));
        assert_eq!((found.status, found.certainty.unidentifiable.len()), (Status::Found, 0), "seed {seed}");
        assert!(found.cost.designs <= MOST_DESIGNS, "seed {seed}: {:?}", found.cost);
        let off: Vec<f64> = variables.iter().map(|v| found.design[v.0] - hidden[v.0]).collect();
        errors.extend(off.iter().zip(&found.certainty.sigmas).map(|(e, s)| e / s.unwrap()));
        chis.push(mahalanobis(&found.certainty.covariance, &off));
    }
    (errors, chis)
}

/// `e' C^-1 e` by Cholesky's factors of C with its diagonal scaled to ones.
pub(crate) fn mahalanobis(c: &[Vec<f64>], e: &[f64]) -> f64 {
    let n = e.len();
    let s: Vec<f64> = (0..n).map(|k| c[k][k].sqrt()).collect();
    let mut l = vec![vec![0.0; n]; n];
    let mut y = vec![0.0; n];
    for i in 0..n {
        for j in 0..=i {
            let left = c[i][j] / (s[i] * s[j]) - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
            l[i][j] = if i == j { left.sqrt() } else { left / l[j][j] };
        }
        y[i] = (e[i] / s[i] - (0..i).map(|k| l[i][k] * y[k]).sum::<f64>()) / l[i][i];
    }
    y.iter().map(|y| y * y).sum()
}

/// Errors are those that the covariance states: chi squares have their mean and variance, and intervals cover what they
/// should.
pub(crate) fn assert_covered(name: &str, variables: usize, (errors, chis): (Vec<f64>, Vec<f64>)) {
    let (n, v) = (chis.len() as f64, variables as f64);
    let mean = chis.iter().sum::<f64>() / n;
    // Four standard deviations of the mean of n chi squares of v degrees of freedom.
    assert!((mean - v).abs() < 4.0 * (2.0 * v / n).sqrt(), "{name}: mean chi square {mean} of {v}");
    for (within, part) in [(1.0, 0.6827), (2.0, 0.9545), (3.0, 0.9973)] {
        let covered = errors.iter().filter(|e| e.abs() <= within).count() as f64 / errors.len() as f64;
        // Of one seed all errors may go together: seeds are what is independent, four standard deviations of them.
        let slack = 4.0 * (part * (1.0 - part) / n).sqrt();
        println!("{name}: within {within} standard deviations {covered:.4}, expected {part}");
        assert!((covered - part).abs() < slack, "{name}: {covered} within {within} standard deviations");
    }
}

#[test]
fn a_hidden_stewart_platform_is_recovered_within_its_covariance() {
    // Every joint may be anywhere, with the legs as they were: 36 coordinates.
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/stewart.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let (start, end) = (text.find("# A leg whose end moves").unwrap(), text.find("[points]").unwrap());
    let joint = |of: &str, k: usize| {
        format!("{of}_{k} = {{ move = \"{of}_{k}\", along = \"xyz\", fixed_length = true }}\n")
    };
    let design: String = (1..=6).flat_map(|k| [joint("base", k), joint("top", k)]).collect();
    let text = format!("{}[design]\n{design}\n{}", &text[..start], &text[end..]);
    let model = parse(&text, "hidden.toml").unwrap_or_else(|e| panic!("{e}")).model;
    assert_eq!(model.variables.len(), 36);
    // Legs anywhere within 70 mm of the drawing; three points of the platform are measured in all coordinates.
    let mut noise = noise(1000);
    let mut place = || 0.07 * (2.0 * (0.5 + 0.5 * (noise() / 2.0).tanh()) - 1.0);
    let postures: Vec<Vec<f64>> = (0..9).map(|_| (0..6).map(|_| place()).collect()).collect();
    let measures = model.measures.len();
    let outputs: Vec<usize> = (measures..measures + 9).collect();
    let found = recovered(&model, &all(&model), &postures, &outputs, [2e-5, 1e-3], SEEDS_OF_MANY);
    assert_covered("stewart", 36, found);
}

#[test]
fn a_hidden_five_link_is_recovered_within_its_covariance() {
    let model = gallery("five_link");
    let named = |name: &str| model.variable(name).unwrap();
    let variables =
        ["tie_rod_inner_z", "camber_rod_inner_z", "camber_rod_inner_y", "tie_rod_longer"].map(named);
    let postures: Vec<Vec<f64>> = (-5..=5).map(|k| vec![f64::from(k) * 0.01]).collect();
    // Toe and camber to 0.002 deg over the strut's travel.
    let outputs = ["toe", "camber"].map(|name| model.measure(name).unwrap().0);
    let found = recovered(&model, &variables, &postures, &outputs, [0.002_f64.to_radians(), 1e-3], SEEDS);
    assert_covered("five-link", 4, found);
}

const BROKEN: &[(&str, &str, &str, &[&str])] = &[
    ("empty", "", "HP0112", &["is empty", "write names"]),
    ("no names", "1,2\n3,4\n", "HP0112", &["line 1: there are numbers in place of names"]),
    ("no rows", "spring_strut,toe\n", "HP0112", &["has no readings"]),
    ("words", "spring_strut,toe\n0,much\n", "HP0112", &["line 2, column 2 (`toe`)", "much"]),
    ("comma", "spring_strut;toe\n0;0,5\n", "HP0112", &["line 2, column 2 (`toe`)", "decimal point"]),
    ("too many cells", "spring_strut,toe\n0,1,2\n", "HP0112", &["line 2 has 3 cells for 2 columns"]),
    ("too few cells", "spring_strut,toe\n0,1\n5\n", "HP0112", &["line 3 has 1 cell for 2 columns"]),
    ("empty cells", "spring_strut,toe\n0,\n5,\n", "HP0112", &["has no readings"]),
    (
        "misspelt",
        "spring_strut,tow\n0,1\n",
        "HP0248",
        &["`tow` is neither", "column 2", "did you mean `toe`?"],
    ),
    ("unknown", "spring_strut,temperature\n0,1\n", "HP0248", &["`temperature`", "`#` leaves its column out"]),
    ("twice", "spring_strut,toe,toe\n0,1,1\n", "HP0248", &["`toe` is the title of two columns"]),
    ("unit", "spring_strut,toe [mm]\n0,1\n", "HP0248", &["`toe` is in `mm`, and it is an angle", "deg, rad"]),
    ("nothing measured", "spring_strut\n0\n", "HP0248", &["has no column of readings", "wheel_centre.z"]),
    (
        "sigma of nothing",
        "spring_strut,toe,sigma camber\n0,1,1\n",
        "HP0248",
        &["`sigma camber` has no column of readings"],
    ),
    ("no place", "spring_strut,toe\n,1\n", "HP0112", &["line 2, column 1 (`spring_strut`) is missing"]),
    ("sigma of zero", "spring_strut,toe,sigma toe\n0,1,0\n", "HP0249", &["line 2, column 3", "cannot be 0"]),
    (
        "one sigma",
        "spring_strut,toe,sigma toe\n0,1,0.1\n5,1,\n",
        "HP0249",
        &["line 3: `toe` has no standard"],
    ),
    (
        "too large",
        "spring_strut,toe,sigma toe\n0,1,0.1\n5,1e300,0.1\n",
        "HP0249",
        &["line 3: the reading of `toe` is too large", "leave its cell empty"],
    ),
    (
        "units without",
        "spring_strut,toe,half_track\n0,1,2\n",
        "HP0249",
        &["`toe` and `half_track` cannot be weighed"],
    ),
];

#[test]
fn invalid_tables_are_reported_with_line_and_column() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/five_link.toml");
    let file = hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}"));
    let folder = tempfile::tempdir().unwrap();
    for (name, text, code, words) in BROKEN {
        let path = folder.path().join("measured.csv");
        std::fs::write(&path, text).unwrap();
        let error = file.measured(&path, &[]).expect_err(name);
        let shown = error.render(false);
        assert_eq!(error.list()[0].code, *code, "{name}: {shown}");
        assert!(words.iter().all(|w| shown.contains(w)), "{name}: {shown}");
    }
    let path = folder.path().join("good.csv");
    std::fs::write(
        &path,
        "# bench 3\nspring_strut [mm];toe [deg];#note;sigma toe\n10;0.5;first, cold;\n-10;;8;\n",
    )
    .unwrap();
    let sigma = |name: &str, x: f64| file.measured(&path, &[(name.into(), x)]);
    let good = sigma("toe", 0.01).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((good.lines.clone(), good.measurements.readings.len()), (vec![3, 4], 1));
    assert!((good.measurements.postures[1][0] + 0.01).abs() < 1e-15);
    let reading = good.measurements.readings[0];
    assert!((reading.sigma.unwrap() - 0.01_f64.to_radians()).abs() < 1e-15 && reading.posture == 0);
    for (name, x, words) in [("tow", 0.1, "did you mean `toe`?"), ("toe", -1.0, "cannot be -1")] {
        assert!(sigma(name, x).unwrap_err().render(false).contains(words), "{name}");
    }
    assert!(
        file.measured(Path::new("nowhere.csv"), &[]).unwrap_err().render(false).contains("cannot be read")
    );
}
