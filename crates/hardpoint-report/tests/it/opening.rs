//! Opening of the page: plots and named designs of the model file, and the types of quantities.

use hardpoint::model::CaseId;
use hardpoint_report::page::{Admissibility, Gate, NamedChange, NamedDesign, Payload, Plot};

use crate::drawing::page_of;

fn page(text: &str) -> Payload {
    page_of(&hardpoint_file::parse(text, "models.toml").unwrap_or_else(|e| panic!("{e}")))
}

const STRUT: &str = include_str!("../../../../models/macpherson.toml");
const AXLE: &str = include_str!("../../../../models/front_axle.toml");

#[test]
fn plots_of_the_file_are_those_of_the_page() {
    let plots = "\n[page]\nplots = [{ y = [\"camber\", \"toe\"], over = \"wheel_travel\" }, { y = [\"contact_point.y\"] }]\n";
    let page = page(&format!("{STRUT}{plots}"));
    let of = |name: &str| page.quantities.iter().position(|q| q.name == name).unwrap();
    let expected = [
        Plot { y: vec![of("camber"), of("toe")], over: Some(of("wheel_travel")) },
        Plot { y: vec![of("contact_point.y")], over: None },
    ];
    assert_eq!(page.plots, expected);
    assert_eq!(self::page(STRUT).plots, []);
}

#[test]
fn named_designs_have_changes_in_the_units_of_the_file() {
    let page = page(&format!("{STRUT}\n[designs.higher]\ntie_rod_outer_z = 2.5\nlca_tilt = -0.5\n"));
    let by = |design: &NamedDesign, name: &str| {
        design.changes.iter().find(|c: &&NamedChange| c.name == name).map(|c| c.by).unwrap()
    };
    let [higher] = &page.named_designs[..] else { panic!("{:?}", page.named_designs) };
    assert_eq!(higher.name, "higher");
    assert!((by(higher, "tie_rod_outer_z") - 2.5).abs() < 1e-12);
    assert!((by(higher, "lca_tilt") + 0.5).abs() < 1e-12);
}

#[test]
fn quantities_have_the_types_of_their_measures() {
    let page = page(AXLE);
    let kind = |name: &str| page.quantities.iter().find(|q| q.name == name).unwrap().kind.as_str();
    for (name, expected) in [
        ("left.toe", "toe"),
        ("left.wheel_travel", "wheel_travel"),
        ("front.ackermann_error", "ackermann_error"),
        ("left_motion_ratio", "slope"),
        ("left_hop", "acceleration"),
        ("left_wheel_centre.x", "position"),
        ("left_knuckle.z", "position"),
    ] {
        assert_eq!(kind(name), expected, "{name}");
    }
}

#[test]
fn a_variable_that_opens_a_joint_by_rounded_coordinates_is_not_called_a_reassembly() {
    let admissibility =
        |text: &str, name: &str| page(text).variables.iter().find(|v| v.name == name).unwrap().admissibility;
    // 2.8e-7 mm per mm.
    let cam = include_str!("../../../../models/cam.toml");
    assert_eq!(admissibility(cam, "camshaft_x"), Admissibility::Admissible);
    // 0.99 mm per mm.
    let rack = include_str!("../../../../models/double_wishbone.toml");
    assert_eq!(admissibility(rack, "tie_rod_outer_y_fixed_length"), Admissibility::Reassembled);
}

#[test]
fn limits_of_metrics_are_targets_of_cards_and_limits_of_curves_in_every_case() {
    let limits = r#"
[metrics]
highest_camber = { of = "camber", take = "max" }
toe_at_ride = { of = "toe", over = "wheel_travel", take = "value", at = 0 }
toe_range = { of = "toe", take = "range" }
free = { of = "toe", take = "max" }
[tolerance]
variables = { tie_rod_outer_z = 0.5 }
[tolerance.limits]
camber = { metric = "highest_camber", min = -9, max = 2 }
camber_of_tyre = { metric = "highest_camber", max = 3 }
ride = { metric = "toe_at_ride", min = -1, max = 1 }
range = { metric = "toe_range", max = 20 }
[cases.bump]
laws = { strut_drive = "40 - 80*t" }
time = { end = 1, steps = 20 }
"#;
    let file =
        hardpoint_file::parse(&format!("{STRUT}{limits}"), "models.toml").unwrap_or_else(|e| panic!("{e}"));
    for page in [page_of(&file), page_of(&file.in_case(CaseId(0)))] {
        let value = |name: &str| page.values.iter().find(|v| v.name == name).unwrap();
        let rounded = |ends: [Option<f64>; 2]| ends.map(|end| end.map(|x| (x * 1e9).round() / 1e9));
        let camber = value("highest_camber");
        assert_eq!(camber.target.map(rounded), Some([Some(-9.0), Some(2.0)]));
        // A maximum says nothing of how low the curve may be.
        let gate = camber.gate.unwrap();
        assert_eq!((rounded([gate.low, gate.high]), gate.at), ([None, Some(2.0)], None));
        let ride = value("toe_at_ride");
        let Gate { low, high, at } = ride.gate.unwrap();
        assert_eq!((rounded([low, high]), at), ([Some(-1.0), Some(1.0)], ride.time));
        assert!(at.is_some());
        assert_eq!(value("toe_range").target.map(rounded), Some([None, Some(20.0)]));
        assert_eq!([value("toe_range").gate, value("free").gate, value("toe").gate], [None; 3]);
        assert_eq!(value("free").target, None);
    }
}
