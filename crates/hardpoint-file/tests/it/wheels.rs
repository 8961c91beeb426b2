//! Wheels: every measure against re-solved designs and against differences over time, on several suspensions; right
//! wheels are left ones in a mirror; angles make a spin axis. Published values are those of `gallery_models.rs`.

use std::ops::ControlFlow;
use std::path::Path;

use hardpoint::model::{Model, VariableId, VehicleEnd, WheelMeasure, WheelRequirement};
use hardpoint::space::Vec3;
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run, Solution};
use hardpoint_file::{ModelFile, parse};
use hardpoint_study::verify::{self, verify};

/// The knuckle's top mount is on the chassis.
const STRUT: &str = r#"
[wheels.w]
body = "knuckle"
centre = [0, 750.062, 0]
spin_axis = [0.0035, 1, 0.0175]
radius = 310
kingpin = [{ body = "knuckle", at = "ball_joint" }, { body = "ground", at = "strut_top" }]
bump = "strut_drive"
steer = "rack_drive"
arm_planes = [{ body = "lca", at = ["lca_rear", "lca_front", "ball_joint"] }, { body = "strut", at = ["strut_top", "strut_lower"] }]
spring = [{ body = "ground", at = "strut_top" }, { body = "knuckle", at = "strut_lower" }]
measures = "all"
"#;

/// Both kingpin points on the arms rather than the knuckle.
const WISHBONES: &str = r#"
[points.kingpin_lower]
body = "lca"
at = "lower_ball"

[wheels.w]
body = "knuckle"
centre = [0, 600, 232.41]
toe = -0.3
camber = -1.1
radius = 230
kingpin = ["kingpin_lower", { body = "uca", at = "upper_ball" }]
bump = "spring_drive"
steer = "rack_drive"
arm_planes = [{ body = "lca", at = ["lca_rear", "lca_front", "lower_ball"] }, { body = "uca", at = ["uca_rear", "uca_front", "upper_ball"] }]
spring = [{ body = "ground", at = [40, 300, 400] }, { body = "lca", at = "pushrod_outer" }]
measures = "all"
"#;

/// Planes, spring and steering of the arms that `side` names begin with, by that rack.
fn arms(side: &str, rack: &str) -> String {
    let at = |arm: &str, ball: &str| {
        let points = [format!("{arm}_front"), format!("{arm}_rear"), ball.to_owned()];
        let points = points.map(|p| format!("\"{side}{p}\"")).join(", ");
        format!("{{ body = \"{side}{arm}\", at = [{points}] }}")
    };
    format!(
        "steer = \"{rack}\"\narm_planes = [{}, {}]\n\
         spring = [{{ body = \"ground\", at = [10, 330, 330] }}, {{ body = \"{side}lca\", at = [10, 450, -20] }}]\n",
        at("lca", "lower_ball"),
        at("uca", "upper_ball")
    )
}

const AXLE: &str = r#"
[wheels.w]
body = "left_knuckle"
centre = [0, 750, 310]
spin_axis = [0.002, 1, 0.01]
radius = 300
kingpin = [{ body = "left_knuckle", at = "left_kingpin_lower" }, { body = "left_knuckle", at = "left_kingpin_upper" }]
measures = "all"

[wheels.r]
body = "right_knuckle"
centre = [0, -750, 310]
spin_axis = [0.002, -1, 0.01]
radius = 300
kingpin = [{ body = "right_knuckle", at = "right_kingpin_lower" }, { body = "right_knuckle", at = "right_kingpin_upper" }]
measures = "all"

[vehicle]
wheelbase = 2700

[axles.axle]
left = "w"
right = "r"
measures = ["track", "total_toe", "ackermann_error"]
"#;

fn text(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../models/{name}.toml"));
    std::fs::read_to_string(path).unwrap()
}

fn parsed(text: &str) -> ModelFile {
    parse(text, "wheels.toml").unwrap_or_else(|e| panic!("{e}"))
}

fn solved(file: &ModelFile) -> Solution {
    let solution = Analysis::new(&file.model).unwrap().run();
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    solution
}

/// The models of this test: suspensions with what they carry.
fn suspensions() -> [(&'static str, String); 5] {
    [
        ("front_axle", with_all(include_str!("../models/front_axle_by_hand.toml"))),
        ("macpherson", text("macpherson") + STRUT),
        ("double_wishbone", text("double_wishbone") + WISHBONES),
        ("rack_steering", text("rack_steering") + &of_a_rack(AXLE)),
        // Steered while it travels, with static toe and camber.
        ("double_wishbone_4x4", steered(&text("double_wishbone_4x4"))),
    ]
}

/// All but what depends on a driver that moves the wheel up and down: the rack, the only driver there is, hardly does.
fn of_a_rack(text: &str) -> String {
    let needs_no_driver =
        |m: &&WheelMeasure| matches!(m.needs(), WheelRequirement::Nothing | WheelRequirement::Kingpin);
    let names = WheelMeasure::ALL.iter().filter(needs_no_driver).map(|m| format!("\"{}\"", m.name()));
    text.replace("\"all\"", &format!("[{}]", names.collect::<Vec<_>>().join(", ")))
}

/// The kingpins of the steered axle are on the chassis.
fn is_at_rest(name: &str, what: WheelMeasure) -> bool {
    name == "rack_steering" && matches!(what, WheelMeasure::Caster | WheelMeasure::KingpinInclination)
}

/// The left wheel named w, with all measures; steered so little that no instant centre passes infinity.
fn with_all(text: &str) -> String {
    let list = text.split("measures = [").nth(1).and_then(|rest| rest.split(']').next()).unwrap();
    let metrics = text.split("# What a change").nth(1).and_then(|rest| rest.split("[time]").next()).unwrap();
    let text = text.replace(metrics, "\n");
    // Steered so little, parts of Ackermann's angles are near their poles; the gallery's test measures them.
    text.replace("right = \"right\"\nmeasures = \"all\"", "right = \"right\"")
        .replace(&format!("[{list}]"), "\"all\"")
        .replace("15*sin", "2*sin")
        .replace("bump = \"left_bump\"\n", &format!("bump = \"left_bump\"\n{}", arms("left_", "steering")))
        .replace("[wheels.left]", "[wheels.w]")
        .replace("left.", "w.")
        .replace("left = \"left\"", "left = \"w\"")
}

/// Only wheels that a driver moves up and down have slopes, and only those of a vehicle that is known stand up to
/// braking.
fn is_left_out(name: &str, what: WheelMeasure) -> bool {
    match what.needs() {
        WheelRequirement::Bump
        | WheelRequirement::Steer
        | WheelRequirement::Planes
        | WheelRequirement::Spring => name == "rack_steering",
        WheelRequirement::Braking(end) | WheelRequirement::Driving(end) => {
            name != "front_axle" || end == VehicleEnd::Rear
        }
        WheelRequirement::Nothing | WheelRequirement::Kingpin => false,
    }
}

fn steered(text: &str) -> String {
    let law = "law = \"0\"";
    assert!(text.contains(law));
    text.replace(law, "law = \"25*sin(3*t + 0.4)\"")
        .replace("spindle = [0, 551.87, 0]", "spindle = [-0.3, 551.87, -1.5]")
        .replace("bump = \"bump\"\n", &format!("bump = \"bump\"\n{}", arms("", "rack_drive")))
        .replace("front_left", "w")
}

/// The same model in the mirror of the plane y = 0: hardpoints change the sign of y, and so does the rack's axis.
fn mirrored(text: &str) -> String {
    let mut inside = false;
    let mut lines = Vec::new();
    let text = text.replace("axis = \"y\"", "axis = \"-y\"");
    for line in
        text.replace("[10, 330, 330]", "[10, -330, 330]").replace("[10, 450, -20]", "[10, -450, -20]").lines()
    {
        if line.starts_with('[') {
            inside = line == "[hardpoints]";
        }
        match line.split_once(", ").filter(|_| inside && line.contains(" = [")) {
            Some((x, rest)) => lines.push(format!("{x}, -{rest}").replace("-0,", "0,")),
            None => lines.push(line.to_owned()),
        }
    }
    lines.join("\n")
}

#[test]
fn every_measure_agrees_with_resolved_designs_on_every_suspension() {
    for (name, text) in suspensions() {
        let mut file = parsed(&text);
        // A few times are enough here; the gallery's own test runs its models whole.
        let (first, last) = (file.model.times[0], *file.model.times.last().unwrap());
        file.model.times = (0..=16).map(|k| first + (last - first) * f64::from(k) / 16.0).collect();
        let analysis = Analysis::new(&file.model).unwrap();
        let solution = analysis.run();
        assert!(solution.stop.is_none(), "{name}: {:?}", solution.stop);
        let report = verify(&analysis, &solution, &verify::Options::default(), |_| ControlFlow::Continue(()));
        assert!(report.passed(), "{name}: {:#?}", report.checks);
        let worst = report.checks.iter().filter_map(|c| c.worst()).map(|s| s.error).fold(0.0, f64::max);
        println!("{name}: {} variables, worst {worst:.1e}", report.checks.len());
        // The comparison was not of zeros: each measure depends on the design in each order of the motion.
        for what in WheelMeasure::ALL {
            let Some(m) = solution.measured.index(&format!("w.{}", what.name())) else {
                assert!(is_left_out(name, *what), "{name}: {}", what.name());
                continue;
            };
            for order in 0..solution.measured.outputs[m].known.orders {
                let felt = (0..file.model.variables.len()).any(|b| {
                    let d = |k| solution.measured.d(k, VariableId(b), m)[order];
                    (0..solution.motion.len()).any(|k| d(k).abs() > 1e-4)
                });
                let driven = matches!(name, "double_wishbone_4x4" | "front_axle")
                    && *what == WheelMeasure::WheelTravel;
                // That model's design moves its kingpins in side view only.
                let leans = order == 0 && *what == WheelMeasure::Caster;
                let expected = !driven && (leans || !is_at_rest(name, *what));
                assert_eq!(felt, expected, "{name}: {} in order {order}", what.name());
            }
        }
    }
}

/// Central differences over 2 h have an error of h^2 / 6 times the third derivative.
#[test]
fn rates_and_accelerations_agree_with_differences_over_time() {
    const H: f64 = 1e-4;
    for (name, text) in suspensions() {
        let mut file = parsed(&text);
        let last = *file.model.times.last().unwrap();
        let at: Vec<f64> = (1..12).map(|k| last * f64::from(k) / 12.0 + 0.0123).collect();
        file.model.times = at.iter().flat_map(|t| [t - H, *t, t + H]).collect();
        let solution = solved(&file);
        for what in
            WheelMeasure::ALL.iter().filter(|m| !m.needs().depends_on_driver() && !is_left_out(name, **m))
        {
            let m = solution.measured.index(&format!("w.{}", what.name())).unwrap();
            let value = |k: usize| solution.measured.value(k, m);
            for order in 1..3 {
                let largest = (0..at.len()).map(|n| value(3 * n + 1)[order].abs()).fold(0.0, f64::max);
                if is_at_rest(name, *what) {
                    assert!(largest < 1e-9, "{name}: {}: {largest:e}", what.name());
                    continue;
                }
                assert!(largest > 1e-4, "{name}: {} has no rate of order {order}", what.name());
                // What is nearly at infinity has no number.
                let is_there = |n: &usize| (3 * n..3 * n + 3).all(|k| value(k)[0].is_finite());
                let there: Vec<usize> = (0..at.len()).filter(is_there).collect();
                let least = if what.needs() == WheelRequirement::Planes { 8 } else { at.len() };
                assert!(there.len() >= least, "{name}: {} has too few numbers", what.name());
                for n in there {
                    let difference = (value(3 * n + 2)[order - 1] - value(3 * n)[order - 1]) / (2.0 * H);
                    let apart = (difference - value(3 * n + 1)[order]).abs() / largest;
                    assert!(apart < 1e-5, "{name}: {} order {order} at {}: {apart:e}", what.name(), at[n]);
                }
            }
        }
    }
}

#[test]
fn a_right_wheel_has_the_measures_of_its_mirror_image() {
    let left = steered(&text("double_wishbone_4x4"));
    let [left, right] = [left.clone(), mirrored(&left)].map(|text| parsed(&text));
    assert_eq!(left.model.wheels[0].side.name(), "left");
    assert_eq!(right.model.wheels[0].side.name(), "right");
    let [a, b] = [&left, &right].map(solved);
    for what in WheelMeasure::ALL {
        let Some(m) = a.measured.index(&format!("w.{}", what.name())) else { continue };
        // These are signed in the vehicle's axes.
        let sign = match what {
            WheelMeasure::SteerAngle
            | WheelMeasure::ContactY
            | WheelMeasure::FrontCentreY
            | WheelMeasure::PlaneCentreFrontY
            | WheelMeasure::InstantAxisY => -1.0,
            _ => 1.0,
        };
        for k in 0..a.motion.len() {
            for order in 0..a.measured.outputs[m].known.orders {
                let (x, y) = (a.measured.value(k, m)[order], sign * b.measured.value(k, m)[order]);
                assert!((x - y).abs() < 1e-11 * (1.0 + x.abs()), "{} order {order}: {x} {y}", what.name());
            }
            for (v, variable) in left.model.variables.iter().enumerate() {
                let turned = if variable.name.ends_with("_y") { -sign } else { sign };
                let [x, y] = [&a, &b].map(|s| s.measured.d(k, VariableId(v), m)[0]);
                let apart = (x - turned * y).abs();
                assert!(apart < 1e-10 * (1.0 + x.abs()), "{} by {}: {x} {y}", what.name(), variable.name);
            }
        }
    }
}

/// From lock to lock the two wheels of an axle change their parts; both steer to the same side.
#[test]
fn the_wheels_of_an_axle_are_each_others_mirror_images_half_a_period_later() {
    let file = parsed(&(text("rack_steering") + AXLE));
    let solution = solved(&file);
    let half = (solution.motion.len() - 1) / 2;
    let is_there = |m: &&WheelMeasure| !m.needs().depends_on_driver() && !is_left_out("rack_steering", **m);
    for what in WheelMeasure::ALL.iter().filter(is_there) {
        let sign = match what {
            WheelMeasure::SteerAngle | WheelMeasure::ContactY => -1.0,
            _ => 1.0,
        };
        let [l, r] = ["w", "r"].map(|w| solution.measured.index(&format!("{w}.{}", what.name())).unwrap());
        for k in 0..=half {
            let [x] = [solution.measured.value(k, l)[0]];
            let y = sign * solution.measured.value(k + half, r)[0];
            assert!((x - y).abs() < 1e-11, "{}: {x} {y}", what.name());
        }
    }
    let steer = |w: &str, k: usize| {
        solution.measured.value(k, solution.measured.index(&format!("{w}.steer_angle")).unwrap())[0]
    };
    let lock = half / 2;
    assert!(steer("w", lock) < -0.3 && steer("r", lock) < -0.3, "the rack behind the axle went to the left");
    assert!(steer("w", lock).abs() < steer("r", lock).abs(), "the inner wheel turns more");
}

#[test]
fn toe_and_camber_are_those_that_the_file_states_on_either_side() {
    for (side, y) in [("left", 700.0), ("right", -700.0)] {
        let text = format!(
            r#"
            name = "wheel"
            units = {{ length = "mm", angle = "deg" }}
            bodies = {{ slide = {{}} }}
            joints.rail = {{ type = "translational", bodies = ["ground", "slide"], at = [0, {y}, 0], axis = "z" }}
            drivers.rail = {{ joint = "rail", law = "10*t" }}
            wheels.w = {{ body = "slide", centre = [0, {y}, 0], toe = 0.7, camber = -2.5, radius = 300, measures = "all" }}
            time = {{ at = [0, 1] }}
            "#
        );
        let file = parsed(&text);
        assert_eq!(file.model.wheels[0].side.name(), side);
        let solution = solved(&file);
        let value = |k, name: &str| {
            solution.measured.value(k, solution.measured.index(&format!("w.{name}")).unwrap())[0]
        };
        for k in 0..2 {
            assert!((value(k, "toe").to_degrees() - 0.7).abs() < 1e-12);
            assert!((value(k, "camber").to_degrees() + 2.5).abs() < 1e-12);
            assert!(value(k, "steer_angle").abs() < 1e-15);
            // Its top leans inboard, so it is further out.
            let (sin, cos) = 2.5_f64.to_radians().sin_cos();
            let out = 0.3 * sin * 0.7_f64.to_radians().cos();
            assert!((value(k, "half_track") - (0.7 + out)).abs() < 1e-12);
            assert!((value(k, "contact_z") - (0.01 * k as f64 - 0.3 * cos)).abs() < 1e-12);
        }
        assert!((value(1, "wheel_travel") - 0.01).abs() < 1e-15);
        // What needs a kingpin is not among all that is possible; the only driver is the one that moves the wheel up
        // and down.
        let possible =
            |m: &&WheelMeasure| matches!(m.needs(), WheelRequirement::Nothing | WheelRequirement::Bump);
        assert_eq!(file.model.measures.len(), WheelMeasure::ALL.iter().filter(possible).count());
    }
}

#[test]
fn a_left_wheel_has_the_toe_and_camber_of_its_spin_axis() {
    let file = parsed(&(text("macpherson") + STRUT));
    let solution = solved(&file);
    let index = |name: &str| solution.measured.index(name).unwrap();
    for (own, of_wheel) in [("toe", "w.toe"), ("camber", "w.camber"), ("wheel_travel", "w.wheel_travel")] {
        for k in 0..solution.motion.len() {
            let [a, b] = [own, of_wheel].map(|n| solution.measured.value(k, index(n)));
            for order in 0..3 {
                assert!((a[order] - b[order]).abs() < 1e-13, "{own} at step {k}: {a:?} {b:?}");
            }
        }
    }
}

/// The measures of a wheel come behind those of the model, and are placed where the list names them.
#[test]
fn listed_measures_have_the_wheels_name_and_their_own_place() {
    use hardpoint::draft::Section;
    let text = text("macpherson") + &STRUT.replace("\"all\"", "[\"caster\", \"toe\"]");
    let file = parsed(&text);
    let names: Vec<&str> = file.model.measures.iter().rev().take(2).map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["w.toe", "w.caster"]);
    let line = 1 + text.lines().position(|l| l.starts_with("measures = ")).unwrap();
    let last = file.model.measures.len() - 1;
    assert_eq!(file.place(Section::Measures, last - 1), Some((line, 13)));
    assert_eq!(file.place(Section::Measures, last), Some((line, 23)));
}

/// While one driver is shifted and the others keep to their laws, everything changes along that driver alone.
#[test]
fn slopes_are_those_of_runs_whose_driver_is_shifted() {
    const H: f64 = 1e-2; // mm; the error is its square
    let text = with_all(include_str!("../models/front_axle_by_hand.toml")).replace("2*sin", "10*sin");
    let law = "law = \"60*sin(4*pi*t)\"";
    assert!(text.contains(law));
    let shifted = |by: f64| solved(&parsed(&text.replace(law, &format!("law = \"60*sin(4*pi*t) + {by}\""))));
    let (now, ahead, behind) = (solved(&parsed(&text)), shifted(H), shifted(-H));
    let index = |name: &str| now.measured.index(name).unwrap_or_else(|| panic!("{name}"));
    let knuckle = parsed(&text).model.body("left_knuckle").unwrap();
    for k in (0..now.motion.len()).step_by(7) {
        let value = |name: &str| now.measured.value(k, index(name))[0];
        let difference =
            |name: &str| ahead.measured.value(k, index(name))[0] - behind.measured.value(k, index(name))[0];
        let rise = difference("w.wheel_travel");
        assert!((rise - 2e-3 * H).abs() < 1e-12);
        let close = |name: &str, expected: f64| {
            let (found, scale) = (value(name), 1.0 + expected.abs());
            assert!((found - expected).abs() < 2e-6 * scale, "{name} at step {k}: {found} {expected}");
        };
        close("w.bump_steer", difference("w.toe") / rise);
        close("w.bump_camber", difference("w.camber") / rise);
        close("w.bump_recession", difference("w.wheel_recession") / rise);
        close("w.bump_scrub", difference("w.half_track_change") / rise);
        close("left_motion_ratio", difference("left_damper") / rise);
        let slope = difference("w.contact_y") / difference("w.contact_z");
        close("w.roll_centre_height", value("w.contact_y") * slope);
        // The carrier's own motion, from where it is in both runs.
        let [a, b] = [&ahead, &behind].map(|s| s.motion.at(k).body(knuckle.0));
        let middle = |c: usize| (a.rotation.cols[c] + b.rotation.cols[c]) * 0.5;
        let turned = |c: usize| middle(c).cross(a.rotation.cols[c] - b.rotation.cols[c]);
        let w = (turned(0) + turned(1) + turned(2)) * (0.5 / rise);
        let contact = Vec3::new(value("w.contact_x"), value("w.contact_y"), value("w.contact_z"));
        let v = (a.r - b.r) * (1.0 / rise) + w.cross(contact - now.motion.at(k).body(knuckle.0).r);
        close("w.roll_centre_height_geometric", contact.y * v.y / v.z);
        let at = |y: f64, z: f64| v + w.cross(Vec3::new(0.0, y - contact.y, z - contact.z));
        let still = at(value("w.instant_centre_front_y"), value("w.instant_centre_front_z"));
        assert!(still.y.abs().max(still.z.abs()) < 1e-5, "step {k}: {still:?}");
        let at = |x: f64, z: f64| v + w.cross(Vec3::new(x - contact.x, 0.0, z - contact.z));
        let still = at(value("w.instant_centre_side_x"), value("w.instant_centre_side_z"));
        let at_infinity = w.y.abs() < 1e-2 * w.norm();
        assert!(at_infinity || still.x.abs().max(still.z.abs()) < 1e-4, "step {k}: {still:?}");
        let axis = ["x", "y", "z"].map(|c| value(&format!("w.instant_axis_{c}")));
        // A left wheel, w per unit of its rise.
        let along = w * (1.0 / w.norm());
        assert!((Vec3::from(axis) - along).norm() < 1e-6, "step {k}");
        close("w.swing_arm_front", contact.y - value("w.instant_centre_front_y"));
        close("w.swing_arm_side", value("w.instant_centre_side_x") - contact.x);
        close("w.motion_ratio", -value("left_motion_ratio"));
        close("w.anti_dive", 0.68 * 2.7 / 0.62 * v.x / v.z);
        close("w.anti_rise", -0.5 * 2.7 / 0.62 * difference("w.wheel_recession") / rise);
    }
}

/// Both wheels of a live rear axle, which its two springs move: what only rear wheels have, and an axle's measures
/// again.
const REAR: &str = r#"
[vehicle]
wheelbase = 2700
cg_height = 620
front_brake_share = 0.68
front_drive_share = 0.25

[wheels.l]
body = "axle"
centre = [0, 740, 310]
spin_axis = [0, 1, 0.01]
radius = 310
bump = "left_spring"
end = "rear"
drive = "inboard"
measures = [
    "toe", "camber", "half_track", "bump_steer", "bump_camber", "bump_recession", "bump_scrub", "roll_centre_height",
    "roll_centre_height_geometric", "instant_centre_front_y", "instant_centre_front_z", "anti_lift", "anti_squat",
]

[wheels.r]
body = "axle"
centre = [0, -740, 310]
spin_axis = [0, -1, 0.01]
radius = 310
bump = "right_spring"
end = "rear"

[axles.rear]
left = "l"
right = "r"
measures = ["track", "total_toe", "ackermann_error", "axle_roll_centre_y", "axle_roll_centre_height"]
"#;

/// The whole motion of a model, with sensitivities that are those of designs solved anew.
fn verified(file: &ModelFile) -> Solution {
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.run();
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    let report = verify(&analysis, &solution, &verify::Options::default(), |_| ControlFlow::Continue(()));
    assert!(report.passed(), "{:#?}", report.checks);
    solution
}

#[test]
fn a_live_axle_has_the_measures_of_rear_wheels() {
    let file = parsed(&(text("solid_axle") + REAR));
    let solution = verified(&file);
    let index = |name: &str| solution.measured.index(name).unwrap();
    let felt = |name: &str| {
        let d = |k, v| solution.measured.d(k, VariableId(v), index(name))[0].abs();
        let steps = 0..solution.motion.len();
        steps.flat_map(|k| (0..file.model.variables.len()).map(move |v| d(k, v))).any(|d| d > 1e-4)
    };
    for name in ["l.anti_lift", "l.anti_squat", "l.roll_centre_height", "rear.axle_roll_centre_height"] {
        assert!(felt(name), "{name}");
    }
    // The axle is one body: its track is that of its wheels, and what both lean and head is opposite.
    let value = |k: usize, name: &str| solution.measured.value(k, index(name))[0];
    let lift = 0.32 * 2.7 / 0.62;
    for k in (0..solution.motion.len()).step_by(10) {
        assert!((value(k, "rear.total_toe")).abs() < 0.01);
        assert!((value(k, "rear.track") - 1.48).abs() < 0.01);
        assert!((value(k, "l.anti_lift") / lift).abs() < 1.0);
    }
}

/// A live axle on three links and a Panhard rod, on pads: in side view the links meet at x = 1200, z = 500, and the rod
/// crosses the plane of symmetry at z = 330.
const PANHARD: &str = r#"
name = "live axle"
units = { length = "mm", angle = "deg" }
loads = "static"

[vehicle]
wheelbase = 2800
cg_height = 560
front_drive_share = 0

[hardpoints]
left_body = [600, 450, 350]
left_axle = [0, 450, 200]
right_body = [600, -450, 350]
right_axle = [0, -450, 200]
upper_body = [600, 0, 475]
upper_axle = [0, 0, 450]
panhard_body = [-100, 500, 330]
panhard_axle = [-100, -500, 330]

[bodies]
axle = {}

[joints]
left_link = { type = "distance", bodies = ["ground", "axle"], at = ["left_body", "left_axle"] }
right_link = { type = "distance", bodies = ["ground", "axle"], at = ["right_body", "right_axle"] }
upper_link = { type = "distance", bodies = ["ground", "axle"], at = ["upper_body", "upper_axle"] }
panhard = { type = "distance", bodies = ["ground", "axle"], at = ["panhard_body", "panhard_axle"] }

[wheels.left]
body = "axle"
centre = [0, 730, 300]
spin_axis = "y"
radius = 300
bump = "left_pad"
end = "rear"
measures = [
    "contact_y", "contact_z", "wheel_travel", "wheel_recession", "roll_centre_height", "anti_squat",
    "instant_centre_side_x", "instant_centre_side_z", "bump_recession",
]

[wheels.right]
body = "axle"
centre = [0, -730, 300]
spin_axis = "-y"
radius = 300
bump = "right_pad"
end = "rear"
measures = ["roll_centre_height", "anti_squat"]

[axles.rear]
left = "left"
right = "right"
measures = ["axle_roll_centre_y", "axle_roll_centre_height"]

[drivers]
left_pad = { wheel = "left", law = "40*t" }
right_pad = { wheel = "right", law = "-15*t" }

[forces]
left_tyre = { type = "wheel_force", wheel = "left", outboard = -1000 }
right_tyre = { type = "wheel_force", wheel = "right", outboard = 1000 }

[measures]
left_load = { type = "driver_force", driver = "left_pad" }
right_load = { type = "driver_force", driver = "right_pad" }
in_roll = { type = "slope", of = "left.contact_y", over = "left.contact_z", driver = "left_pad", opposed = ["right_pad"] }
in_heave = { type = "slope", of = "left.wheel_recession", over = "left.wheel_travel", driver = "left_pad", together = ["right_pad"] }

[design]
panhard_z = { move = "panhard_axle", along = "z" }
left_z = { move = "left_body", along = "z" }

[time]
end = 1
steps = 10
"#;

#[test]
fn an_axle_rolls_and_rises_with_both_wheels() {
    // Values of a model at all output times.
    let values = |text: &str, names: &[&str]| -> Vec<Vec<f64>> {
        let solution = verified(&parsed(text));
        let index = |name: &str| solution.measured.index(name).unwrap();
        let at = |k: usize| names.iter().map(|name| solution.measured.value(k, index(name))[0]).collect();
        (0..solution.motion.len()).map(at).collect()
    };
    let close = |found: f64, expected: f64| {
        assert!((found - expected).abs() <= 1e-9 * expected.abs().max(1.0), "{found} {expected}");
    };
    let sides = ["left.roll_centre_height", "right.roll_centre_height", "rear.axle_roll_centre_height"];
    let names = [&sides[..], &["left.contact_y", "in_roll", "left_load", "right_load"]].concat();
    // In side view level links meet at infinity.
    let no_centre = ("\"instant_centre_side_x\", \"instant_centre_side_z\", ", "");
    let level = [("450, 350]", "450, 200]"), ("0, 475]", "0, 450]"), no_centre];
    let level = level.iter().fold(PANHARD.to_owned(), |text, (from, to)| text.replace(from, to));
    let rolled = values(&level, &names);
    // All rods are level: what the pads carry under forces at both contact points is the moment about where it crosses.
    let by_forces = 0.73 * (rolled[0][5] - rolled[0][6]) / 2000.0;
    close(by_forces, 0.33);
    (0..3).for_each(|k| close(rolled[0][k], by_forces));
    // Both pads are held by heights of the contact points, which rise and fall alike.
    rolled.iter().for_each(|at| close(at[0], at[3] * at[4]));
    // On one body the wheels belong together without an axle.
    let (before, axle) = level.split_once("[axles.rear]").unwrap();
    let without = before.to_owned() + &axle[axle.find("[drivers]").unwrap()..];
    assert_eq!(values(&without, &sides[..2])[7], rolled[7][..2]);

    // Driving forces instead, at the contact points: a live axle carries its differential.
    let driven =
        PANHARD.replace("outboard = -1000", "forward = 1000").replace("outboard = 1000", "forward = 1000");
    let names = ["left.anti_squat", "right.anti_squat", "left_load", "right_load"];
    let centre = ["left.instant_centre_side_x", "left.instant_centre_side_z"];
    let start = &values(&driven, &[&names[..], &centre].concat())[0];
    close((start[2] + start[3]) / 2000.0, 500.0 / 1200.0);
    (0..2).for_each(|k| close(start[k], 500.0 / 1200.0 * 2.8 / 0.56));
    close(start[4], 1.2);
    close(start[5], 0.5);
    // On a De Dion axle driving acts at the wheel centre.
    let de_dion = driven.replace("end = \"rear\"", "end = \"rear\"\ndrive = \"inboard\"");
    for at in values(&de_dion, &["left.anti_squat", "in_heave", "left.bump_recession"]) {
        close(at[0], at[1] * 2.8 / 0.56);
        assert!((at[2] - at[1]).abs() > 1e-3, "one wheel alone turns the axle: {} {}", at[2], at[1]);
    }
}

/// A front view in which all is plane: arms and knuckle turn about axes along x, the wheel is at x = 0.
const FRONT_VIEW: &str = r#"
name = "front view"
units = { length = "mm", angle = "deg" }

[hardpoints]
lca_inner = [0, 300, 200]
lower_ball = [0, 700, 160]
uca_inner = [0, 400, 430]
upper_ball = [0, 660, 450]
spring_top = [0, 450, 700]
spring_foot = [0, 500, 180]

[bodies]
lca = {}
uca = {}
knuckle = {}

[joints]
lca_pivot = { type = "revolute", bodies = ["ground", "lca"], at = "lca_inner", axis = "x" }
uca_pivot = { type = "revolute", bodies = ["ground", "uca"], at = "uca_inner", axis = "x" }
lower_ball = { type = "revolute", bodies = ["lca", "knuckle"], at = "lower_ball", axis = "x" }
upper_ball = { type = "revolute", bodies = ["uca", "knuckle"], at = "upper_ball", axis = "x" }

[drivers]
bump = { joint = "lca_pivot", law = "-8 + 16*t" }

[wheels.w]
body = "knuckle"
centre = [0, 750, 310]
toe = 0
camber = -1.5
radius = 310
arm_planes = [
    { body = "lca", at = ["lca_inner", [50, 300, 200], "lower_ball"] },
    { body = "uca", at = ["uca_inner", [50, 400, 430], "upper_ball"] },
]
spring = [{ body = "ground", at = "spring_top" }, { body = "lca", at = "spring_foot" }]
measures = "all"

[time]
end = 1
steps = 8
"#;

/// Round-off of a small linkage whose loop has redundant constraints.
const PLANE: f64 = 1e-9;

#[test]
fn textbook_constructions_are_exact_where_all_is_plane() {
    let file = parsed(FRONT_VIEW);
    let solution = solved(&file);
    let value = |k: usize, name: &str| {
        solution.measured.value(k, solution.measured.index(&format!("w.{name}")).unwrap())[0]
    };
    let place = |k: usize, body: &str, [y, z]: [f64; 2]| {
        let body = file.model.body(body).unwrap();
        let drawn = file.model.bodies[body.0].frame.r;
        let state = solution.motion.at(k).body(body.0);
        let p = state.rotation * (Vec3::new(0.0, y, z) - drawn) + state.r;
        [p.y, p.z]
    };
    for k in 0..solution.motion.len() {
        // Where the lines along both arms meet: p + a u = q + b v.
        let (p, q) = ([0.3, 0.2], [0.4, 0.43]);
        let (l, m) = (place(k, "lca", [0.7, 0.16]), place(k, "uca", [0.66, 0.45]));
        let (u, v) = ([l[0] - p[0], l[1] - p[1]], [m[0] - q[0], m[1] - q[1]]);
        let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
        let way = cross([q[0] - p[0], q[1] - p[1]], v) / cross(u, v);
        let meet = [p[0] + way * u[0], p[1] + way * u[1]];
        let contact = [value(k, "contact_y"), value(k, "contact_z")];
        let close = |name: &str, expected: f64| {
            let found = value(k, name);
            assert!((found - expected).abs() < PLANE * (1.0 + expected.abs()), "{name}: {found} {expected}");
        };
        for (ours, other) in [("plane_centre_front_y", meet[0]), ("plane_centre_front_z", meet[1])] {
            close(ours, other);
            close(&ours.replace("plane_centre", "instant_centre"), other);
        }
        let rise = (meet[1] - contact[1]) / (contact[0] - meet[0]) * contact[0];
        close("roll_centre_height_planes", rise);
        close("roll_centre_height_geometric", rise);
        close("swing_arm_front", contact[0] - meet[0]);
        close("camber_front", value(k, "camber"));
        // The camber changes by one over the swing arm's length, seen from the wheel centre's height.
        let rises = value(k, "half_track") - (-value(k, "camber")).sin() * 0.31 - meet[0];
        close("bump_camber", -1.0 / rises);
        // l' of the spring: the foot goes perpendicular to the arm.
        let foot = place(k, "lca", [0.5, 0.18]);
        let (along, arm) = ([foot[0] - 0.45, foot[1] - 0.7], [foot[0] - 0.3, foot[1] - 0.2]);
        let length = along[0].hypot(along[1]);
        let grows = (along[0] * -arm[1] + along[1] * arm[0]) / length;
        // The ball joint goes about the pivot and about the instant centre; so does the wheel centre about the latter.
        let turn = (l[0] - 0.3).hypot(l[1] - 0.2) / (l[0] - meet[0]).hypot(l[1] - meet[1]);
        let centre = contact[0] + value(k, "camber").sin() * 0.31;
        let expected = (grows / (turn * (centre - meet[0]))).abs();
        // The spring is on the arm: in bump it gets shorter.
        let found = value(k, "motion_ratio");
        assert!((found - expected).abs() < PLANE, "{found} {expected}");
    }
}

const VIRTUAL: [(&str, &str); 7] = [
    ("virtual_caster", "caster"),
    ("virtual_kingpin_inclination", "kingpin_inclination"),
    ("virtual_scrub_radius", "scrub_radius"),
    ("virtual_spindle_offset", "spindle_offset"),
    ("virtual_caster_trail", "caster_trail"),
    ("virtual_mechanical_trail", "mechanical_trail"),
    ("virtual_hub_trail", "hub_trail"),
];

/// A knuckle that turns about two ball joints, or a pin, has no other steering axis than the line through them.
#[test]
fn a_knuckle_on_a_kingpin_steers_about_it() {
    let of_rack = of_a_rack(AXLE)
        .replace("body = \"left_knuckle\"\ncentre", "steer = \"rack\"\nbody = \"left_knuckle\"\ncentre");
    let names = VIRTUAL.map(|(name, _)| format!("\"{name}\"")).join(", ");
    let of_rack = of_rack.replacen("measures = [", &format!("measures = [{names}, "), 1);
    // With the lower arm held, the other one is as well.
    let held = steered(&text("double_wishbone_4x4")).replace(
        "point = \"wheel_centre\"\nalong = \"z\"\nlaw = \"80*sin(2*pi*t)\"",
        "joint = \"lca_pivot\"\nlaw = \"8*sin(2*pi*t)\"",
    );
    for text in [text("rack_steering") + &of_rack, held] {
        let file = parsed(&text);
        let solution = solved(&file);
        let index =
            |name: &str| solution.measured.index(&format!("w.{name}")).unwrap_or_else(|| panic!("{name}"));
        for (virtual_one, real) in VIRTUAL {
            let (a, b) = (index(virtual_one), index(real));
            for k in 0..solution.motion.len() {
                let close =
                    |x: f64, y: f64| assert!((x - y).abs() < 1e-9 * (1.0 + y.abs()), "{real}: {x} {y}");
                close(solution.measured.value(k, a)[0], solution.measured.value(k, b)[0]);
            }
        }
    }
}

/// If the lines of two pairs of rods meet, in A and B, and that of a leg passes through B, the knuckle turns about AB
/// while the fifth rod moves: the virtual kingpin of textbooks.
#[test]
fn five_links_whose_lines_meet_have_the_steering_axis_of_textbooks() {
    let (a, b) = ([-20.0, 690.0, 520.0], [10.0, 740.0, 170.0]);
    // A rod whose line passes through a place: its ends are a part of the way from there to its inner end.
    let rod = |name: &str, meet: [f64; 3], inner: [f64; 3], part: f64| {
        let outer: Vec<String> =
            (0..3).map(|k| (meet[k] + part * (inner[k] - meet[k])).to_string()).collect();
        format!(
            "{name} = {{ type = \"rod\", bodies = [\"ground\", \"knuckle\"], at = [[{}, {}, {}], [{}]] }}\n",
            inner[0],
            inner[1],
            inner[2],
            outer.join(", ")
        )
    };
    let text = format!(
        r#"
name = "virtual kingpin"
units = {{ length = "mm", angle = "deg" }}
bodies = {{ knuckle = {{}}, rack = {{}} }}
[joints]
{}{}{}{}
tie_rod = {{ type = "rod", bodies = ["rack", "knuckle"], at = [[-150, 350, 280], [-140, 690, 270]] }}
rack = {{ type = "translational", bodies = ["ground", "rack"], at = [-150, 350, 280], axis = "y" }}
spring = {{ type = "leg", bodies = ["ground", "knuckle"], at = [[-30, 560, 800], [{}, {}, {}]] }}
[drivers]
bump = {{ joint = "spring", law = "0" }}
rack = {{ joint = "rack", law = "20*t" }}
[wheels.w]
body = "knuckle"
centre = [0, 760, 310]
spin_axis = [0.01, 1, 0.02]
radius = 310
bump = "bump"
steer = "rack"
kingpin = [{{ body = "knuckle", at = {b:?} }}, {{ body = "knuckle", at = {a:?} }}]
measures = "all"
[time]
end = 1
steps = 4
"#,
        rod("upper_front", a, [150.0, 420.0, 470.0], 0.2),
        rod("upper_rear", a, [-190.0, 430.0, 460.0], 0.3),
        rod("lower_front", b, [220.0, 380.0, 190.0], 0.15),
        rod("lower_rear", b, [-100.0, 360.0, 180.0], 0.1),
        b[0] + 0.3 * (-30.0 - b[0]),
        b[1] + 0.3 * (560.0 - b[1]),
        b[2] + 0.3 * (800.0 - b[2]),
    );
    let file = parsed(&text);
    let solution = solved(&file);
    let value = |k: usize, name: &str| {
        solution.measured.value(k, solution.measured.index(&format!("w.{name}")).unwrap())[0]
    };
    for (virtual_one, real) in VIRTUAL {
        let (x, y) = (value(0, virtual_one), value(0, real));
        assert!((x - y).abs() < 1e-9 * (1.0 + y.abs()), "{real}: {x} {y}");
        // Steered, the lines meet no longer.
        let (x, y) = (value(4, virtual_one), value(4, real));
        assert!((x - y).abs() > 1e-6, "{real}: {x} {y}");
    }
}

/// Planes, spring and steering of a wheel have their mirror images, by names and by coordinates.
#[test]
fn the_other_wheel_in_a_mirror_has_the_same_planes_spring_and_steering_axis() {
    const NAMES: [&str; 6] = [
        "motion_ratio",
        "swing_arm_front",
        "plane_centre_front_z",
        "plane_centre_side_x",
        "roll_centre_height_planes",
        "virtual_caster",
    ];
    let listed = NAMES.map(|name| format!("\"{name}\"")).join(", ");
    let text = text("front_axle")
        .replace("bump = \"left_bump\"\n", &format!("bump = \"left_bump\"\n{}", arms("left_", "steering")))
        .replacen("measures = [\n", &format!("measures = [\n{listed},\n"), 1)
        .replacen("measures = [\"toe\", ", &format!("measures = [{listed}, \"toe\", "), 1)
        .replace("60*sin(6*pi*t)", "60*sin(4*pi*t)")
        .replace("15*sin(2*pi*t)", "0");
    let solution = solved(&parsed(&text));
    for name in NAMES {
        let [l, r] = ["left", "right"].map(|w| solution.measured.index(&format!("{w}.{name}")).unwrap());
        for k in 0..solution.motion.len() {
            let [x, y] = [l, r].map(|m| solution.measured.value(k, m)[0]);
            assert!((x - y).abs() < 1e-9 * (1.0 + x.abs()), "{name}: {x} {y}");
        }
    }
}

/// The front axle on the pads of a test rig, with a wheel load.
fn on_pads() -> String {
    let text = text("front_axle");
    let pad = text.replace(
        "left_bump = { point = \"left_wheel_centre\", along = \"z\",",
        "left_bump = { wheel = \"left\",",
    );
    assert_ne!(pad, text);
    pad.replace("[measures]", "[measures]\nleft_load = { type = \"driver_force\", driver = \"left_bump\" }\nright_load = { type = \"driver_force\", driver = \"right_bump\" }")
        + "\n[forces]\nleft_up = { type = \"wheel_force\", wheel = \"left\", up = 3000 }\n"
}

#[test]
fn a_pad_prescribes_the_height_of_the_contact_point() {
    const SAME: f64 = 1e-11;
    let model = parsed(&on_pads()).model;
    let [relative, absolute] = [Formulation::Relative, Formulation::Absolute].map(|formulation| {
        let solution = Analysis::with(&model, formulation).unwrap().run();
        assert!(solution.stop.is_none(), "{:?}", solution.stop);
        solution
    });
    let of = |s: &Solution, k: usize, name: &str| s.measured.value(k, s.measured.index(name).unwrap());
    let (amplitude, speed) = (0.06, 4.0 * std::f64::consts::PI);
    let start = of(&relative, 0, "left.contact_z")[0];
    for k in 0..relative.motion.len() {
        let t = relative.motion.times[k];
        let (s, c) = (speed * t).sin_cos();
        // The law, its rate and its acceleration.
        let law = [start + amplitude * s, amplitude * speed * c, -amplitude * speed * speed * s];
        let found = of(&relative, k, "left.contact_z");
        for (n, (found, law)) in found.iter().zip(law).enumerate() {
            assert!((found - law).abs() <= SAME * speed.powi(n as i32), "{n} at {t}: {found} {law}");
        }
        // The wheel centre does not move as far.
        let travel = of(&relative, k, "left.wheel_travel")[0];
        assert!((travel - (law[0] - start)).abs() < 3e-3);
        // A vertical force at the contact is that of the pad; the mirror has given the right wheel the same.
        let [left, right] = ["left_load", "right_load"].map(|name| of(&relative, k, name)[0]);
        assert!((left + 3000.0).abs() < 1e-7 && (right + 3000.0).abs() < 1e-7, "{left} {right} at {t}");
        for name in ["left.toe", "left.camber", "right.toe", "right.wheel_travel", "left.bump_steer"] {
            let (a, b) = (of(&relative, k, name)[0], of(&absolute, k, name)[0]);
            assert!((a - b).abs() <= 1e-9 * (1.0 + a.abs()), "{name} {a} {b}");
        }
    }
    let farthest = (0..relative.motion.len())
        .map(|k| of(&relative, k, "left.wheel_travel")[0] - of(&relative, k, "left.contact_z")[0] + start)
        .fold(0.0_f64, |most, x| most.max(x.abs()));
    assert!(farthest > 1e-5, "pad and wheel centre move alike: {farthest}");
}

#[test]
fn sensitivities_on_a_pad_are_those_of_solved_designs() {
    let model = parsed(&on_pads()).model;
    let analysis = Analysis::new(&model).unwrap();
    let found =
        verify(&analysis, &analysis.run(), &verify::Options::default(), |_| ControlFlow::Continue(()));
    let worst: Vec<_> = found.checks.iter().map(|check| check.worst().cloned()).collect();
    assert!(found.passed(), "{worst:?}");
}

/// The front axle in equilibrium on tyres: springs hold the arms, and roads lift the wheels.
fn on_tyres() -> String {
    let forces = "\n[forces]\nleft_tyre = { type = \"tyre\", wheel = \"left\", stiffness = \"k_tyre\", preload = 3000, height = 30, law = \"sin(2*pi*t)\" }\n\
        left_spring = { type = \"spring\", from = { body = \"ground\", at = \"left_damper_top\" }, to = { body = \"left_lca\", at = \"left_damper_foot\" }, stiffness = 60, preload = -5000 }\n\
        [equilibrium]\nreleased = [\"left_bump\", \"right_bump\"]\n";
    let text = text("front_axle");
    // Rates are not known at rest, and the mirror brings the other side.
    let rates = ["left_hop", "left_motion_ratio", "bump_steer = ", "roll_centre_travel = "];
    let lines = text.lines().filter(|l| !rates.iter().any(|start| l.starts_with(start)));
    let text = lines.collect::<Vec<_>>().join("\n");
    // Released drivers do not move alone: no measures by wheel travel.
    let (before, rest) = text.split_once("measures = [\n").unwrap();
    let (_, after) = rest.split_once("\n]").unwrap();
    let text = format!("{before}measures = [\"toe\", \"camber\", \"wheel_travel\", \"contact_z\"]{after}")
        .replace("\"wheel_travel\", \"roll_centre_height\"]", "\"wheel_travel\"]")
        .replace("measures = \"all\" }", "measures = [\"track\", \"total_toe\", \"ackermann_error\"] }");
    let measures = "[measures]\nleft_load = { type = \"spring_force\", force = \"left_tyre\" }\nright_load = { type = \"spring_force\", force = \"right_tyre\" }";
    text.replacen("[measures]", measures, 1).replacen("[design]", "[parameters]\nk_tyre = 250\n[design]", 1)
        + forces
}

#[test]
fn a_wheel_on_its_tyre_is_in_equilibrium_with_its_spring() {
    let model = parsed(&on_tyres()).model;
    let analysis = Analysis::new(&model).unwrap();
    let solution = analysis.run();
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    let of = |k: usize, name: &str| solution.measured.value(k, solution.measured.index(name).unwrap())[0];
    for k in 0..solution.motion.len() {
        let road = 0.03 * (2.0 * std::f64::consts::PI * solution.motion.times[k]).sin();
        let [contact, load] = ["left.contact_z", "left_load"].map(|name| of(k, name));
        // C_z - C_z0 = road - (F - F_0) / k, so that C_z0 is the same at all times.
        let drawn = contact - (load - 3000.0) / -250e3 - road;
        let first = of(0, "left.contact_z") - (of(0, "left_load") - 3000.0) / -250e3;
        assert!((drawn - first).abs() < 1e-12, "{drawn} {first}");
        assert!(load > 1000.0 && load < 6000.0, "{load}");
    }
    let found = verify(&analysis, &solution, &verify::Options::default(), |_| ControlFlow::Continue(()));
    let worst: Vec<_> = found.checks.iter().map(|check| check.worst().cloned()).collect();
    assert!(found.passed(), "{worst:?}");
}

#[test]
fn a_pad_requires_a_wheel_with_a_contact_point() {
    let text = on_pads();
    let faults = [
        text.replace("left_bump = { wheel = \"left\",", "left_bump = { wheel = \"lefft\","),
        text.replace(
            "spin_axis = { through = [\"left_spindle\", \"left_wheel_centre\"] }",
            "spin_axis = [0, 0, 1]",
        ),
        text.replace(
            "left_bump = { wheel = \"left\",",
            "left_bump = { wheel = \"left\", counted_from = \"zero\",",
        ),
    ];
    let codes = faults.map(|text| parse(&text, "pad.toml").unwrap_err().list()[0].code);
    assert_eq!(codes, ["HP0204", "HP0231", "HP0213"]);
}

#[test]
fn a_run_for_some_outputs_has_the_same_numbers_for_these_and_leaves_out_other_slopes() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/front_axle.toml");
    let model = hardpoint_file::read(&path).unwrap().model;
    let asked = ["left.toe", "left.bump_steer", "toe_difference", "left_wheel_centre.z"];
    // The kernel, and programs.
    for steps in [3, model.times.len()] {
        let few = Model { times: model.times[..steps].to_vec(), ..model.clone() };
        let analysis = Analysis::new(&few).unwrap();
        let all = analysis.run();
        let column = |name: &str| all.measured.index(name).unwrap();
        let sources: Vec<_> =
            asked[..2].iter().map(|name| all.measured.outputs[column(name)].source).collect();
        let some = analysis.solve(Run::new().for_outputs(&sources));
        let last = steps - 1;
        for name in asked {
            let m = column(name);
            let [a, b] = [&all, &some].map(|run| run.measured.value(last, m));
            // Programs of other results are other arithmetic.
            assert!((a[0] - b[0]).abs() <= 1e-12 * a[0].abs().max(1.0), "{name}: {a:?} {b:?}");
            for v in (0..few.variables.len()).map(VariableId) {
                let [a, b] = [&all, &some].map(|run| run.measured.d(last, v, m)[0]);
                assert!((a - b).abs() <= 1e-10 * a.abs().max(1.0), "{name}: {a} {b}");
            }
        }
        let other = column("left.anti_dive");
        assert!(all.measured.value(last, other)[0].is_finite());
        // A program may have it none the less, but nothing is zero.
        let left_out = some.measured.value(last, other)[0];
        assert!(left_out.is_nan() || left_out == all.measured.value(last, other)[0], "{left_out}");
        let plain: Vec<_> = sources[..1].to_vec();
        let none = analysis.solve(Run::new().for_outputs(&plain));
        for k in 0..steps {
            assert!(none.measured.value(k, column("left.bump_steer"))[0].is_nan());
            assert!(none.measured.d(k, VariableId(0), column("left.bump_steer"))[0].is_nan());
        }
    }
}

/// Values of the measures of a wheel `w`, or an axle `ax`, over its motion.
fn columns<'s>(file: &ModelFile, solution: &'s Solution) -> impl Fn(&str) -> Vec<f64> + use<'s> {
    let names: Vec<String> = file.model.measures.iter().map(|m| m.name.clone()).collect();
    move |name| {
        let m = names.iter().position(|other| other == name).unwrap_or_else(|| panic!("{name}"));
        (0..solution.motion.len()).map(|k| solution.measured.value(k, m)[0]).collect()
    }
}

#[test]
fn a_carrier_that_does_not_turn_has_no_instant_centres_and_no_axes() {
    // Parallel trailing arms of equal length; both wheels on one axle, as they lie in space.
    let text = |tilt: f64| {
        let wheel = |name: &str, y: f64| {
            format!(
                "wheels.{name} = {{ body = \"axle\", centre = [-2450, {y}, 0], toe = 0, camber = 0, radius = 310, \
                 bump = \"q\", steer = \"q\", measures = [\"instant_centre_side_x\", \"instant_centre_side_z\", \
                 \"instant_centre_front_y\", \"instant_centre_front_z\", \"swing_arm_side\", \"swing_arm_front\", \
                 \"instant_axis_x\", \"instant_axis_y\", \"instant_axis_z\", \"virtual_caster\", \
                 \"virtual_kingpin_inclination\", \"virtual_scrub_radius\", \"bump_recession\", \"roll_centre_height\"] }}\n"
            )
        };
        // Both arms go from the same place to the same place, apart.
        let joints =
            [(["ground", "lo"], 0.0), (["lo", "axle"], 1.0), (["ground", "up"], 0.0), (["up", "axle"], 1.0)];
        let joints = joints.into_iter().enumerate().map(|(k, (bodies, end))| {
            let up = if k < 2 { 0.0 } else { 180.0 };
            let at = [-2000.0 - 399.0 * end + up / 9.0, 100.0 + 18.7 * end, 20.0 + 60.4 * end + up];
            format!(
                "joints.j{k} = {{ type = \"revolute\", bodies = {bodies:?}, at = {at:?}, axis = [{tilt}, 1, 0.02] }}\n"
            )
        });
        format!(
            "name = \"trailing\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\ntime = {{ end = 1, steps = 8 }}\n\
             bodies = {{ lo = {{}}, up = {{}}, axle = {{}} }}\ndrivers.q = {{ joint = \"j0\", law = \"15*sin(2*pi*t)\" }}\n\
             {}{}{}axles.ax = {{ left = \"l\", right = \"r\", measures = [\"axle_roll_centre_y\", \
             \"axle_roll_centre_height\"] }}\n",
            joints.collect::<String>(),
            wheel("l", 700.0),
            wheel("r", -700.0)
        )
    };
    for tilt in [0.0, 0.05] {
        let file = parsed(&text(tilt));
        let solution = solved(&file);
        let of = columns(&file, &solution);
        for measure in &file.model.measures {
            let known = of(&measure.name);
            let short = measure.name.split('.').nth(1).unwrap();
            // What is per rise has a value.
            let expected = ["bump_recession", "roll_centre_height"].contains(&short);
            assert!(known.iter().all(|x| x.is_finite() == expected), "{} {tilt}: {known:?}", measure.name);
        }
    }
}

#[test]
fn wheels_lie_down_and_kingpins_do_without_values_there() {
    // A knuckle turns about the direction of travel until its wheel lies on its side.
    let text = |kingpin: &str, last: f64| {
        format!(
            r#"
name = "lying"
units = {{ length = "mm", angle = "deg" }}
time = {{ at = [0, 0.5, 1] }}
bodies = {{ knuckle = {{}} }}
joints.hinge = {{ type = "revolute", bodies = ["ground", "knuckle"], at = [0, 550, 400], axis = [1, 0, 0] }}
drivers.turn = {{ joint = "hinge", law = "{last}*t" }}
points = {{ low = {{ body = "knuckle", at = [0, 560, 300] }}, top = {{ body = "knuckle", at = [10, 555, 500] }} }}
wheels.w = {{ body = "knuckle", centre = [0, 600, 400], radius = 300, toe = 10, camber = 0, kingpin = {kingpin}, measures = ["toe", "camber_front", "steer_angle", "contact_x", "contact_z", "half_track", "scrub_radius", "spindle_offset", "caster_trail", "mechanical_trail", "caster", "kingpin_inclination"] }}
"#
        )
        .replace("toe = 10", if last == 90.0 { "toe = 0" } else { "toe = 10" })
    };
    let file = parsed(&text("[\"low\", \"top\"]", 90.0));
    let solution = solved(&file);
    let of = columns(&file, &solution);
    for name in ["toe", "steer_angle", "contact_x", "contact_z", "half_track", "scrub_radius", "caster_trail"]
    {
        let [.., half, end] = of(&format!("w.{name}"))[..] else { unreachable!() };
        assert!(half.is_finite() && end.is_nan(), "{name}: {half} {end}");
    }
    // The spin axis is in the front view, upright.
    assert!((of("w.camber_front")[2].to_degrees() + 90.0).abs() < 1e-9);
    // A kingpin in the plane across that turns until it is horizontal.
    let upright = "[{ body = \"knuckle\", at = [0, 560, 300] }, { body = \"knuckle\", at = [0, 560, 500] }]";
    let file = parsed(&text(upright, -90.0));
    let solution = solved(&file);
    let of = columns(&file, &solution);
    for name in ["scrub_radius", "spindle_offset", "caster_trail", "mechanical_trail"] {
        let [.., half, end] = of(&format!("w.{name}"))[..] else { unreachable!() };
        assert!(half.is_finite() && end.is_nan(), "{name}: {half} {end}");
    }
    let [.., caster] = of("w.caster")[..] else { unreachable!() };
    assert!(caster.is_nan(), "seen from the side the kingpin is a point: {caster}");
    assert!((of("w.kingpin_inclination")[2].to_degrees().abs() - 90.0).abs() < 1e-9);
}
