//! Singular values of the Jacobian between drivers and points of a body.

use hardpoint::Analysis;
use hardpoint::model::Model;

use crate::equilibrium::verify_all;

/// Round-off of solved positions and of their derivatives along drivers, relative.
const EXACT: f64 = 1e-10;
/// Arm of two links in a plane: of lengths sqrt(2) and 1 it is isotropic where the elbow is bent by 135 deg
/// (J. K. Salisbury, J. J. Craig, *Articulated hands: force control and kinematic issues*, IJRR 1 (1982) 4).
const ARM: &str = r#"
name = "arm"
units = { length = "mm", angle = "deg" }
planar = "xy"
hardpoints = { O = [0, 0], E = [141.4213562373095, 0], T = [241.4213562373095, 0] }
bodies = { upper = {}, fore = {} }
joints.shoulder = { type = "revolute", bodies = ["ground", "upper"], at = "O" }
joints.elbow = { type = "revolute", bodies = ["upper", "fore"], at = "E" }
drivers.shoulder = { joint = "shoulder", law = "30 + 20*t" }
drivers.elbow = { joint = "elbow", law = "15*t + 5" }
points.tip = { body = "fore", at = "T" }
measures.dexterity = { type = "dexterity", points = ["tip"] }
measures.least = { type = "dexterity", points = ["tip"], value = "least_gain" }
measures.greatest = { type = "dexterity", points = ["tip"], drivers = ["elbow", "shoulder"], value = "greatest_gain" }
design.E_x = { move = "E", along = "x" }
design.T_y = { move = "T", along = "y" }
design.O = { move = "O", along = "y" }
time = { end = 10, steps = 60 }
"#;

fn model_of(text: &str) -> Model {
    hardpoint_file::parse(text, "arm.toml").unwrap_or_else(|e| panic!("{e}")).model
}

#[test]
fn a_two_link_arm_has_the_singular_values_of_its_formula() {
    let model = model_of(ARM);
    let run = Analysis::new(&model).unwrap().run();
    let [dexterity, least, greatest] =
        ["dexterity", "least", "greatest"].map(|name| run.measured.index(name).unwrap());
    let (a, b) = (0.02_f64.sqrt(), 0.1);
    for (k, t) in run.motion.times.iter().enumerate() {
        let elbow = (15.0 * t + 5.0).to_radians();
        // Sum and product of the squares of both singular values.
        let sum = a * a + 2.0 * a * b * elbow.cos() + 2.0 * b * b;
        let product = (a * b * elbow.sin()).powi(2);
        let root = (0.25 * sum * sum - product).max(0.0).sqrt();
        let expected = [0.5 * sum + root, product / (0.5 * sum + root)].map(f64::sqrt);
        let value = |m: usize| run.measured.value(k, m)[0];
        // Near equal values the root loses half of the digits.
        let exact = if root < 1e-4 * sum { EXACT.sqrt() } else { EXACT };
        for (found, expected) in [(value(greatest), expected[0]), (value(least), expected[1])] {
            assert!((found - expected).abs() < exact * a, "t = {t}: {found} instead of {expected}");
        }
        let ratio = expected[1] / expected[0];
        assert!((value(dexterity) - ratio).abs() < 10.0 * exact, "t = {t}: {} {ratio}", value(dexterity));
    }
    // At 135 deg the arm is isotropic.
    let model = model_of(&ARM.replace("end = 10, steps = 60", "end = 8.666666666666666, steps = 1"));
    let run = Analysis::new(&model).unwrap().run();
    let value = run.measured.value(1, dexterity)[0];
    assert!((value - 1.0).abs() < 1e-7, "{value}");
}

#[test]
fn derivatives_are_those_of_designs_solved_anew() {
    // Away from where both singular values are equal, and derivatives of each are not unique.
    verify_all(&model_of(&ARM.replace("end = 10, steps = 60", "end = 6, steps = 20")));
}

/// Speeds of points of a platform per speed of its legs are between the least and the greatest.
#[test]
fn the_motion_of_a_hexapod_is_between_the_singular_values() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../models/stewart.toml");
    let text = std::fs::read_to_string(path).unwrap()
        + r#"
[measures.least]
type = "dexterity"
points = ["centre", "nose", "side"]
value = "least_gain"
[measures.greatest]
type = "dexterity"
points = ["side", "centre", "nose"]
drivers = ["leg_6", "leg_2", "leg_3", "leg_4", "leg_5", "leg_1"]
value = "greatest_gain"
[measures.inverse_condition]
type = "dexterity"
points = ["nose", "side", "centre"]
"#;
    let speeds: String = ["centre", "nose", "side"]
        .map(|p| format!("[measures.speed_{p}]\ntype = \"velocity\"\npoint = \"{p}\"\n"))
        .concat();
    let legs: String = (1..=6)
        .map(|k| {
            format!(
                "[measures.length_{k}]\ntype = \"coordinate\"\njoint = \"leg_{k}\"\n\
                 [measures.rate_{k}]\ntype = \"rate\"\nof = \"length_{k}\"\n"
            )
        })
        .collect();
    let model = model_of(&(text + &speeds + &legs));
    let run = Analysis::new(&model).unwrap().run();
    let value = |k: usize, name: &str| run.measured.value(k, run.measured.index(name).unwrap())[0];
    let mut spread = [f64::INFINITY, 0.0_f64];
    for k in 0..run.motion.len() {
        let points = ["centre", "nose", "side"].map(|p| value(k, &format!("speed_{p}")).powi(2));
        let legs: f64 = (1..=6).map(|leg| value(k, &format!("rate_{leg}")).powi(2)).sum();
        let gain = (points.iter().sum::<f64>() / 3.0 / legs).sqrt();
        let (least, greatest) = (value(k, "least"), value(k, "greatest"));
        assert!(
            least * (1.0 - EXACT) <= gain && gain <= greatest * (1.0 + EXACT),
            "{least} {gain} {greatest}"
        );
        assert!((value(k, "inverse_condition") - least / greatest).abs() < EXACT);
        spread = [spread[0].min(gain / greatest), spread[1].max(gain / greatest)];
    }
    assert!(spread[1] > 2.0 * spread[0], "the motion takes several directions: {spread:?}");
}

/// Messages name what does not make one Jacobian.
#[test]
fn what_is_no_jacobian_is_refused() {
    let of = |from: &str, to: &str| {
        let text = ARM.replace(from, to);
        assert_ne!(text, ARM);
        let error = hardpoint_file::parse(&text, "arm.toml").unwrap_err();
        error.to_string()
    };
    let two_bodies = "points = [\"tip\", { body = \"upper\", at = \"E\" }] }\nmeasures.least";
    let message = of("points = [\"tip\"] }\nmeasures.least", two_bodies);
    assert!(
        message.contains("HP0274") && message.contains("`dexterity` has points of several bodies"),
        "{message}"
    );
    let message = of("drivers = [\"elbow\", \"shoulder\"]", "drivers = [\"elbow\", \"elbow\"]");
    assert!(message.contains("`greatest` has a driver twice"), "{message}");
    let message = of("drivers = [\"elbow\", \"shoulder\"]", "drivers = [\"elbow\", \"sholder\"]");
    assert!(message.contains("did you mean `shoulder`"), "{message}");
    let message = of("drivers = [\"elbow\", \"shoulder\"]", "drivers = []");
    assert!(message.contains("has 0 drivers"), "{message}");
    let message = of("points = [\"tip\"] }\nmeasures.least", "points = [] }\nmeasures.least");
    assert!(message.contains("has no point"), "{message}");
}
